"""The film through life: how thick against a flooded one, what oil is left, and when a unit starves.

What each run tells stands in `layer`, the law over ages and units in `depletion_law`.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray, one_thread
from hersey.errors import InsufficientDataError, ParameterError
from hersey.life.film.depletion_law import Depletion, fit_depletion
from hersey.life.film.filled_dwells import FilledDwells, filled_dwells
from hersey.life.film.layer import Layers, layers
from hersey.life.film.starved_drag import Flooded, cubic, film_of, flooded
from hersey.life.growth.limit_ages import (
    AgesAtLimit,
    Interval,
    age_at_limit,
    quantiles,
    share_of_units,
)
from hersey.life.indicator import Indicator, Indicators, OwnAges, Runs
from hersey.life.oil_layer import USUAL_SHARPNESS, log_film_share
from hersey.result import Result, json_record
from hersey.units import celsius, rpm, takes_si

if TYPE_CHECKING:
    import polars as pl

    from hersey.life.campaign import Campaign
    from hersey.machine.machine import Machine

#: Film over flooded below which it is starved: the layer is then thinner than the flooded film.
STARVED = 2.0 ** (-1.0 / USUAL_SHARPNESS)
#: Ages looked at, over the greatest of the data; past the last it counts as never.
_AGES = np.concatenate([[0.0], np.geomspace(3e-3, 10.0, 110)])
#: Ages of the curves, over the greatest of the data.
_CURVES = np.linspace(0.0, 2.5, 51)
#: Standard errors in half of a 90 % interval; those in the 95 % at which uncertainties are stated.
_TO_90, _TO_95 = 1.645, 1.96
#: How far the law of film and starvation may be off, ln of layer over film, in common to all units: what
#: films by other laws showed (`benchmarks/life.py`).
_LAW = 0.06
#: Dwells of a run, and kelvin between its coldest and hottest, from which it tells a film.
_FEWEST, _WARMTH = 6, 10.0
#: New units drawn for B10 and B50, of each draw of what units share.
_NEW = 40
#: Scatter over the stated errors from which the law does not describe a run.
_BAD = 2.0
_NAMED = 4


@dataclass(frozen=True)
class FilmPoint:
    """A state at which the film is told: speed of the roll (rad/s) and temperature (K)."""

    name: str
    speed: float
    temperature: float

    def __str__(self) -> str:
        """Return name, speed and temperature."""
        return f"{self.name} ({rpm(self.speed):.4g} rpm, {celsius(self.temperature):.4g} degC)"


@dataclass(frozen=True)
class Told:
    """Something that runs or units tell, with 90 % intervals; an end is infinite where it is not told."""

    value: FloatArray
    low: FloatArray
    high: FloatArray


@dataclass(frozen=True)
class OilLeft:
    """The oil in the layer of a unit, m^3: new, when last seen, and what the film then needs."""

    unit: str
    new: Interval
    last: Interval
    needed: Interval


@dataclass(frozen=True, repr=False)
class FilmLife(Result):
    """The film through life.

    ``points`` are the fastest operating point and the cold corner. Of each run, (points, runs): ``film`` over
    that of a flooded inlet at the same viscosity and speed, and its ``thickness`` (m); and the ``layer`` of
    oil on the inlet side (m), and ``viscosity`` over that of the lubricant. Lengths are right but for
    ``systematic``, a factor common to all runs; NaN where a run has no dwells. Of each unit at ``ages``:
    ``curves`` of the film over flooded, ``layers``, and what a layer ``needs`` to be; ``starves`` at each
    point.
    """

    runs: Runs
    points: tuple[FilmPoint, ...]
    film: tuple[Told, ...]
    thickness: tuple[Told, ...]
    layer: Told
    viscosity: Told
    systematic: float
    scatter: FloatArray  #: of the dwells of each run about the law, over their errors
    ages: FloatArray
    curves: tuple[Told, ...]
    layers: Told
    needs: tuple[FloatArray, ...]
    starves: tuple[AgesAtLimit, ...]
    law: dict[str, Interval]  #: of the median unit: K (1/(m^2 age)), e and g (1/age)
    oil: tuple[OilLeft, ...]
    track: float
    notes: tuple[str, ...]
    _starvation: Indicator = field(repr=False)

    def starved(self, point: int = 0) -> BoolArray:
        """Return which runs are starved at a point, their whole interval below the limit."""
        return np.asarray(self.film[point].high < STARVED)

    def headline(self) -> str:
        """Return how many units starve at the fastest operating point, and when the next ones do."""
        last = _last_runs(self.runs)
        starved = [self.runs.unit[i] for i in last if self.starved()[i]]
        text = f"{len(starved)} of {len(last)} units starve of oil at {self.points[0].name}"
        b50 = self.starves[0].b50.age
        return f"{text}; half of new units at {b50} {self.runs.age_unit}"

    def summary(self) -> str:
        """Return film, layer and ages of each unit as text."""
        unit = self.runs.age_unit
        lines = [self.headline()]
        lines += [
            "film over that of a flooded inlet, same viscosity and speed, when last seen; starved below "
            f"{STARVED:.2f}"
        ]
        for i in _last_runs(self.runs):
            films = ", ".join(
                f"{_told(each, i, 1.0, 1.0)} at {point.name} ({1e6 * float(film.value[i]):.3g} um)"
                for each, film, point in zip(self.film, self.thickness, self.points, strict=True)
            )
            name, age = self.runs.unit[i], self.runs.age[i]
            lines.append(f"  {name} at {age:.6g}: {films}; layer {_told(self.layer, i, 1e6)} um")
        lines += [f"  {point}" for point in self.points]
        for point, ages in zip(self.points, self.starves, strict=True):
            lines.append(f"age ({unit}) at which the layer is thinner than the flooded film, {point.name}")
            if all(each.age.value == 0.0 for each in ages.units):
                lines.append("  all units: from the new unit on")
            else:
                lines += [f"  {each}" for each in (*ages.units, ages.b10, ages.b50)]
        lines.append(
            f"oil of the layer, mm^3, on a track of {1e3 * self.track:.4g} mm: new, when last seen, and what "
            f"the film then needs at {self.points[0].name}"
        )
        lines += [f"  {_volumes(each)}" for each in self.oil]
        lines.append(
            f"law dh/dt = -K h^3/2 - e h, viscosity exp(g t); median unit, per {unit}: "
            + ", ".join(f"{name} {each}" for name, each in self.law.items())
        )
        return "\n".join([*lines, *(f"- {note}" for note in self.notes)])

    def with_starvation(self, indicators: Indicators) -> Indicators:
        """Return indicators of the same runs with starvation among them.

        Raises
        ------
        ParameterError
            If they are of other runs.
        """
        if indicators.runs.run != self.runs.run:
            raise ParameterError("the indicators are of other runs than the film")
        return replace(indicators, each=(*indicators.each, self._starvation))

    def to_dict(self) -> dict[str, Any]:
        """Return all of it, in SI; ages in the unit of the campaign; None for what is not told."""
        told = {name: value for name, value in vars(self).items() if not name.startswith("_")}
        starves = [each.to_dict() for each in self.starves]
        return json_record({**told, "starves": starves, "starved": self.starved()})

    def to_frame(self) -> pl.DataFrame:
        """Return one row per run; infinite where an end is not told."""
        import polars as pl

        columns: dict[str, Any] = {
            "run": list(self.runs.run),
            "unit": list(self.runs.unit),
            f"age ({self.runs.age_unit or '1'})": self.runs.age,
        }
        of = [(f"film over flooded, {p.name} (1)", f) for p, f in zip(self.points, self.film, strict=True)]
        of += [(f"film, {p.name} (m)", f) for p, f in zip(self.points, self.thickness, strict=True)]
        for name, told in (*of, ("layer (m)", self.layer), ("viscosity over new oil (1)", self.viscosity)):
            word, _, unit = name.rpartition(" ")
            columns |= {name: told.value, f"{word} low {unit}": told.low, f"{word} high {unit}": told.high}
        return pl.DataFrame(columns)


@takes_si(cold="temperature", track="length")
@one_thread()
def film_life(
    campaign: Campaign,
    machine: Machine,
    *,
    cold: float | None = None,
    track: float | None = None,
    side_flow: float | None = None,
    evaporation: float | None = None,
    seed: int = 0,
) -> FilmLife:
    """Return the film of the units of a campaign through their life.

    Each run is fitted by the torque of film, asperities and rest of the drive, with viscosity, layer of oil,
    rest, roughness and boundary friction free (`layer`); layer and viscosity of all runs then follow the law
    of `depletion_law`, units differing.

    Parameters
    ----------
    campaign
        Dwells at several speeds and temperatures tell most: cold and fast ones see the layer, hot ones the
        level.
    machine
        Contact and lubricant; asperities and boundary friction if stated; operating points.
    cold
        Temperature of the cold corner, K; else that of ``[life]``, or the coldest that all units recorded.
    track
        Length of the track that carries the layer, m, by which it becomes an amount; the roll's circumference
        if left out.
    side_flow, evaporation
        K in 1/(m^2 age) and e in 1/age, in the campaign's unit of age, where they are known; fitted if left
        out.
    seed
        Of the draws behind the law.

    Raises
    ------
    ParameterError
        If the machine lacks contact or lubricant, or a value is impossible.
    InsufficientDataError
        If no dwell has a temperature.
    """
    for name, value in (("side_flow", side_flow), ("evaporation", evaporation)):
        if value is not None and not 0.0 <= value < np.inf:
            raise ParameterError(f"{name} is {value:g}: it must not be negative")
    if track is not None and not 0.0 < track < np.inf:
        raise ParameterError(f"track is {track:g} m: it must be positive")
    read = _read(campaign, machine, machine.life.coldest if cold is None else cold)
    runs = read.runs
    names = list(dict.fromkeys(runs.unit[i] for i in read.told))
    unit = np.array([names.index(runs.unit[i]) for i in read.told])
    age = runs.age[read.told]
    if max(np.unique(age[unit == k]).size for k in range(len(names))) < 2:
        raise InsufficientDataError(
            "no unit was seen at two ages, so nothing tells how its oil thins: add runs at another age"
        )
    found = fit_depletion(read.layers, unit, age, side_flow=side_flow, evaporation=evaporation, seed=seed)
    ages = _CURVES * found.greatest_age
    last = np.array([age[unit == k].max() for k in range(len(names))])
    length = machine.roll_radius * 2.0 * np.pi if track is None else track
    area = length * film_of(machine)[0].length
    starving = [_starving(found, point, len(names)) for point in read.flooded]
    curves = [_curves(found, point, ages, len(names)) for point in read.flooded]
    notes = (*read.notes, *_law_notes(age, unit, machine))
    return FilmLife(
        runs=runs,
        points=read.points,
        film=tuple(read.film(point) for point in read.flooded),
        thickness=tuple(
            read.spread(*(np.exp(each) for each in read.layers.film(point))) for point in read.flooded
        ),
        layer=read.spread(*(np.exp(each) for each in read.layers.thickness())),
        viscosity=read.viscosity(),
        systematic=_systematic(machine, read),
        scatter=read.of_all(read.layers.scatter),
        ages=ages,
        curves=tuple(film for film, _ in curves),
        layers=_of_units(found, lambda own: found.layer(own, ages)),
        needs=tuple(need for _, need in curves),
        starves=tuple(
            _starves(own, state, names, last, runs.age_unit, notes)
            for own, state in zip(starving, read.points, strict=True)
        ),
        law=_law(found),
        oil=tuple(
            _oil(found, k, name, float(last[k]), read.flooded[0], area) for k, name in enumerate(names)
        ),
        track=length,
        notes=notes,
        _starvation=replace(read.indicator(), own_ages=_of_all(starving[0], runs.units, names)),
    )


@one_thread()
def starvation_indicator(campaign: Campaign, machine: Machine) -> Indicator:
    """Return starvation as a failure mode: flooded film over layer at the fastest operating point, limit 1.

    It needs a machine with contact and lubricant, and dwells at several speeds and temperatures: the layer is
    seen where it is thinner than a flooded film or near it, cold and fast. A run all of whose dwells are
    flooded tells a lower bound of the layer alone, which a number with an error cannot hold: there the value
    is NaN, as for a run without dwells. `film_life` uses those, too.

    Raises
    ------
    ParameterError, InsufficientDataError
        As `film_life`.
    """
    return _read(campaign, machine, None).indicator()


@dataclass(frozen=True)
class _Read:
    """What the runs of a campaign tell; ``told`` are the places of those that have dwells."""

    runs: Runs
    told: IntArray
    layers: Layers
    points: tuple[FilmPoint, ...]
    flooded: tuple[Flooded, ...]
    notes: tuple[str, ...]

    def of_all(self, values: FloatArray) -> FloatArray:
        """Values of all runs, NaN where one has no dwells."""
        every = np.full(len(self.runs.run), np.nan)
        every[self.told] = values
        return every

    def spread(self, *ends: FloatArray) -> Told:
        return Told(*(self.of_all(each) for each in ends))

    def film(self, point: Flooded) -> Told:
        sharpness = USUAL_SHARPNESS * float(np.exp(self.layers.common[1]))
        return self.spread(
            *(np.exp(log_film_share(each, sharpness)[0]) for each in self.layers.interval(point))
        )

    def viscosity(self) -> Told:
        """Factor on viscosity at the middle temperature, with the error that the layer gives it."""
        found = self.layers
        value, error = np.empty(len(found.best)), np.empty(len(found.best))
        for i, place in enumerate(found.place):
            weight = np.exp(-0.5 * found.deviance[i]) * np.gradient(place)
            weight /= weight.sum()
            value[i] = np.interp(found.best[i], place, found.viscosity[i])
            away = found.viscosity[i] - value[i]
            error[i] = np.sqrt(weight @ (away**2 + found.viscosity_error[i] ** 2))
        return self.spread(*(np.exp(value + reach * error) for reach in (0.0, -_TO_90, _TO_90)))

    def indicator(self) -> Indicator:
        best, low, high = self.layers.interval(self.flooded[0])
        seen = np.isfinite(low) & np.isfinite(high)
        value = np.where(seen, np.exp(-best), np.nan)
        error = np.where(seen, np.where(seen, high - low, 0.0) / (2.0 * _TO_90), np.nan)
        return Indicator(
            name=f"starvation, {self.points[0].name}",
            kind="starvation",
            si="1",
            limit=1.0,
            value=self.of_all(value),
            error=self.of_all(error),
            notes=(
                f"the film starves where the layer of oil is thinner than a flooded film at {self.points[0]}",
                *self.notes,
            ),
        )


def _read(campaign: Campaign, machine: Machine, cold: float | None) -> _Read:
    contact, lubricant = film_of(machine)
    runs = Runs.of(campaign)
    if not runs.run:
        raise InsufficientDataError(f"{campaign.path.name} holds no run: add logs first")
    dwells, told = filled_dwells(campaign, runs)
    heats = np.where(dwells.given, dwells.kelvin, np.nan)
    telling = dwells.given.sum(axis=1) >= _FEWEST
    telling &= np.nanmax(heats, axis=1) - np.nanmin(heats, axis=1) >= _WARMTH
    if not telling.any():
        raise InsufficientDataError(
            f"no run has {_FEWEST} dwells over {_WARMTH:g} K or more: one temperature cannot tell a thin "
            "layer of oil from a thick oil, so record cold and hot ones"
        )
    dwells, told = dwells.rows(np.flatnonzero(telling)), told[telling]
    points = _points(machine, dwells, [runs.unit[i] for i in told], cold)
    found = layers(dwells, machine, speed=points[1].speed, kelvin=points[1].temperature)
    films = tuple(
        flooded(contact, lubricant, np.array([point.speed]), np.array([point.temperature]))
        for point in points
    )
    if np.median(found.scatter) > _BAD:
        raise InsufficientDataError(
            f"the dwells of most runs scatter about the law of the film by more than {_BAD:g} times their "
            f"errors ({np.median(found.scatter):.3g} in the middle): nip, lubricant or load are not those of "
            "the machine's file"
        )
    notes = _notes(runs, told, found)
    if not telling.all():
        left = f"{np.count_nonzero(~telling)} of {telling.size} runs have too few dwells or one temperature"
        notes = (f"{left}: they tell no film", *notes)
    return _Read(runs, told, found, points, films, notes)


def _points(
    machine: Machine, dwells: FilledDwells, units: list[str], cold: float | None
) -> tuple[FilmPoint, FilmPoint]:
    """The fastest operating point, and its speed at the coldest temperature that all units recorded."""
    coldest: dict[str, float] = {}
    for unit, kelvin in zip(units, dwells.kelvin.min(axis=1).tolist(), strict=True):
        coldest[unit] = min(kelvin, coldest.get(unit, kelvin))
    if machine.points:
        fastest = max(machine.points, key=lambda point: point.speed)
        state = FilmPoint(fastest.name, fastest.speed / machine.roll_radius, fastest.temperature)
    else:
        state = FilmPoint("fastest and hottest dwells", float(dwells.speed.max()), float(dwells.kelvin.max()))
    return state, FilmPoint("the cold corner", state.speed, max(coldest.values()) if cold is None else cold)


def _notes(runs: Runs, told: IntArray, found: Layers) -> tuple[str, ...]:
    _, _, high = found.interval()
    notes = []
    unseen = int(np.count_nonzero(~np.isfinite(high)))
    if unseen:
        notes.append(
            f"{unseen} of {len(told)} runs show no starvation at all: of their layer they tell a lower bound"
        )
    bad = [f"{runs.unit[told[i]]} at {runs.age[told[i]]:.6g}" for i in np.flatnonzero(found.scatter > _BAD)]
    if bad:
        more = " and others" if len(bad) > _NAMED else ""
        notes.append(
            f"dwells of {', '.join(bad[:_NAMED])}{more} scatter about the law by more than {_BAD:g} times "
            "their errors: nip, lubricant or load are not those of the machine's file"
        )
    return tuple(notes)


def _law_notes(age: FloatArray, unit: IntArray, machine: Machine) -> list[str]:
    notes = []
    if max(len(np.unique(age[unit == k])) for k in np.unique(unit)) < 3:
        notes.append("no unit was seen at three ages: side flow and evaporation cannot be told apart")
    if machine.asperities is None:
        notes.append(
            "the machine's file states no asperities: dwells with a film below four times the roughness are "
            "left out"
        )
    notes.append(
        "thicker oil moves torque at all dwells, a thin layer at cold and fast ones: a nip that widens with "
        "age would be read as thicker oil"
    )
    return notes


def _systematic(machine: Machine, read: _Read) -> float:
    """Factor (90 %) by which all layers may be off: the nip's width is taken for viscosity."""
    contact, _ = film_of(machine)
    if contact.nip_uncertainty is None:
        return 1.0
    point = read.flooded[0]
    level = cubic(point.shear, np.zeros(()))[1].item()
    film = cubic(point.film, np.zeros(()))[1].item()
    return float(np.exp(_TO_90 / _TO_95 * np.log1p(contact.nip_uncertainty) * film / max(level, 0.1)))


def _of_units(found: Depletion, of: Any) -> Told:
    """Median and 90 % ends of exp of a function of what a unit has, (units, ages)."""
    each = [np.exp(quantiles(of(found.units[:, k]))) for k in range(found.units.shape[1])]
    low, middle, high = np.moveaxis(np.array(each), 1, 0)
    return Told(middle, low, high)


def _curves(found: Depletion, point: Flooded, ages: FloatArray, units: int) -> tuple[Told, FloatArray]:
    over = _of_units(
        found, lambda own: log_film_share(found.over_flooded(own, ages, point), USUAL_SHARPNESS)[0]
    )
    needs = np.empty((units, ages.size))
    for k in range(units):
        own = found.units[:, k]
        needs[k] = np.exp(np.median(found.layer(own, ages) - found.over_flooded(own, ages, point), axis=0))
    return over, needs


def _ages_below(found: Depletion, own: FloatArray, point: Flooded, off: FloatArray) -> FloatArray:
    """Ages at which layers of draws (..., 5) are first as thin as the flooded film; infinite where never.

    ``off`` is the error of ln of layer over film that all units have in common, of each draw.
    """
    ages = _AGES * found.greatest_age
    above = found.over_flooded(own, ages, point) + off[..., None]
    below = above <= 0.0
    first = np.argmax(below, axis=-1)
    before = np.maximum(first - 1, 0)
    high = np.take_along_axis(above, before[..., None], -1)[..., 0]
    low = np.take_along_axis(above, first[..., None], -1)[..., 0]
    share = np.where(first > 0, high / np.where(high > low, high - low, 1.0), 0.0)
    met = ages[before] + share * (ages[first] - ages[before])
    return np.asarray(np.where(below.any(axis=-1), met, np.inf))


def _starving(found: Depletion, point: Flooded, units: int) -> OwnAges:
    """Ages at which units and new units starve at a point, draws."""
    some = np.linspace(0, len(found.mean) - 1, min(len(found.mean), 400)).astype(np.intp)
    random = np.random.default_rng(0)
    normals = random.standard_normal((some.size, _NEW, found.mean.shape[1]))
    off = _LAW * random.standard_normal(len(found.mean))
    known = [_ages_below(found, found.units[:, k], point, off) for k in range(units)]
    new = found.mean[some, None] + found.spread[some, None] * normals
    return OwnAges(np.stack(known, axis=1), _ages_below(found, new, point, off[some, None]))


def _of_all(own: OwnAges, units: tuple[str, ...], names: list[str]) -> OwnAges:
    """The same of all units: one that no run tells is a new one."""
    spare = np.resize(own.new[:, 0], len(own.known))
    columns = [own.known[:, names.index(unit)] if unit in names else spare for unit in units]
    return OwnAges(np.stack(columns, axis=1), own.new)


def _starves(
    own: OwnAges,
    state: FilmPoint,
    names: list[str],
    last: FloatArray,
    age_unit: str,
    notes: tuple[str, ...],
) -> AgesAtLimit:
    told = tuple(age_at_limit(name, own.known[:, k], float(last[k])) for k, name in enumerate(names))
    new = np.sort(own.new, axis=1)
    quantity = f"the flooded film over the layer at {state.name}"
    b10, b50 = share_of_units(new, 0.1), share_of_units(new, 0.5)
    return AgesAtLimit(quantity, age_unit, 1.0, told, b10, b50, notes)


def _interval(draws: FloatArray) -> Interval:
    low, middle, high = quantiles(draws).tolist()
    return Interval(middle, low, high)


def _law(found: Depletion) -> dict[str, Interval]:
    return {name: _interval(draws) for name, draws in zip("Keg", found.rate(found.mean), strict=True)}


def _oil(found: Depletion, k: int, name: str, last: float, point: Flooded, area: float) -> OilLeft:
    own, ages = found.units[:, k], np.array([0.0, last])
    layer = found.layer(own, ages)
    needed = layer - found.over_flooded(own, ages, point)
    new, now, needs = (_interval(area * np.exp(each)) for each in (layer[:, 0], layer[:, 1], needed[:, 1]))
    return OilLeft(name, new, now, needs)


def _last_runs(runs: Runs) -> list[int]:
    """The oldest run of each unit."""
    last: dict[str, int] = {}
    for i, (unit, age) in enumerate(zip(runs.unit, runs.age, strict=True)):
        if unit not in last or age >= runs.age[last[unit]]:
            last[unit] = i
    return list(last.values())


def _told(told: Told, i: int, factor: float, most: float = np.inf) -> str:
    value, low, high = (factor * float(each[i]) for each in (told.value, told.low, told.high))
    if np.isnan(value):
        return "not told"
    if np.isinf(high) or (np.isfinite(most) and high >= most - 1e-3 and value > 0.99):
        return f"above {low:.3g}"
    return f"{value:.3g} [{low:.3g}, {high:.3g}]"


def _volumes(oil: OilLeft) -> str:
    new, last, needed = (
        f"{1e9 * each.value:.3g} [{1e9 * each.low:.3g}, {1e9 * each.high:.3g}]"
        for each in (oil.new, oil.last, oil.needed)
    )
    return f"{oil.unit}: {new}, {last}, {needed}"
