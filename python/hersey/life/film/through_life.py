"""The film through life: how thick against a flooded one, what oil is left, and when a specimen starves.

What the runs show is in `of_runs`, the law over ages and specimens in `depletion_law`, and what follows from
both in `starving`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray, one_thread, side_by_side
from hersey.errors import InsufficientDataError, ParameterError
from hersey.life.film.depletion_draws import fit_depletion, pooled
from hersey.life.film.depletion_law import Depletion
from hersey.life.film.of_runs import Estimates, FilmOfRuns, FilmPoint, film_of_runs, systematic_factor
from hersey.life.film.shares import SHARES, OtherDrag, other_drag, slower_by_share
from hersey.life.film.starved_drag import film_of
from hersey.life.film.starving import LayersOfSpecimens, OilLeft, starves_at
from hersey.life.film.warnings import of_other_drag, of_the_law
from hersey.life.growth.limit_ages import AgesAtLimit, Interval
from hersey.life.indicator import Indicator, Indicators, Runs, most_ages
from hersey.life.maintenance import OF_FRICTION
from hersey.life.oil_layer import BY_THEORY, STARVED
from hersey.result import Means, Result
from hersey.schema.warning import Warning
from hersey.units import takes_si

if TYPE_CHECKING:
    import polars as pl

    from hersey.life.campaign import Campaign
    from hersey.machine.machine import Machine

__all__ = ["STARVED", "Estimates", "FilmLife", "film_life"]

#: Ages of the curves, over the greatest of the data.
_CURVES = np.linspace(0.0, 2.5, 51)


@dataclass(frozen=True, repr=False)
class FilmLife(Result):
    """The film of each run and specimen through life.

    ``points`` are the fastest operating point and the cold corner. Of each run, (points, runs): ``film`` over
    that of a flooded inlet at the same viscosity and speed, and its ``thickness`` (m); and the ``layer`` of
    oil on the inlet side (m), and ``viscosity`` over that of the lubricant. Lengths are right but for
    ``systematic``, a factor common to all runs; NaN where a run has no dwells. Of each specimen at ``ages``:
    ``curves`` of the film over flooded, ``layers``, and what a layer ``needs`` to be, NaN before a layer was
    renewed; ``starves`` at each point.
    """

    also_stated = ("starved",)
    not_stated = ("_starvation",)

    runs: Runs
    points: Annotated[tuple[FilmPoint, ...], Means("fastest operating point, cold corner")]
    film: Annotated[
        tuple[Estimates, ...], Means("ratio to the film of a flooded inlet, at each point, shape (runs,)")
    ]
    thickness: Annotated[tuple[Estimates, ...], Means("of the film at each point, shape (runs,)", "m")]
    layer: Annotated[Estimates, Means("of oil on the inlet side, shape (runs,)", "m")]
    viscosity: Annotated[Estimates, Means("ratio to that of new lubricant, shape (runs,)")]
    systematic: Annotated[float, Means("factor by which all layers may be wrong together")]
    scatter: Annotated[
        FloatArray,
        Means("scatter of the dwells about the fit, in units of their errors", shape="(runs,)", open=True),
    ]  #: of the dwells of each run about the law, over their errors
    ages: FloatArray
    curves: Annotated[
        tuple[Estimates, ...], Means("ratio of film to flooded film at each point, shape (units, ages)")
    ]
    layers: Annotated[Estimates, Means("shape (units, ages)", "m")]
    needs: Annotated[
        tuple[FloatArray, ...],
        Means("layer below which the film starves", "m", shape="(units, ages)", open=True),
    ]
    starves: Annotated[tuple[AgesAtLimit, ...], Means("ages at which the film starves, at each point")]
    law: Annotated[
        dict[str, Interval], Means("K in 1/(m^2 age), e and g in 1/age, p in 1")
    ]  #: of the median specimen
    oil: Annotated[tuple[OilLeft, ...], Means("in the layer of each specimen, at the first point")]
    track: float
    other_drag: Annotated[OtherDrag, Means("what does not follow the film")]
    warnings: tuple[Warning, ...]
    _starvation: Indicator = field(repr=False)

    def starved(self, point: int = 0) -> BoolArray:
        """Return which runs are starved at a point, with their whole interval below the limit."""
        return np.asarray(self.film[point].high < STARVED)

    def headline(self) -> str:
        """Return how many specimens starve at the fastest operating point."""
        last = _last_runs(self.runs)
        starved = [self.runs.unit[i] for i in last if self.starved()[i]]
        return f"{len(starved)} of {len(last)} specimens starve of oil at {self.points[0].name}"

    def summary(self) -> str:
        """Return film, layer and ages of each specimen as text."""
        return "\n".join([self.headline(), *self.findings(), *(f"- {each}" for each in self.warnings)])

    def findings(self) -> list[str]:
        """Return film, layer and ages of each specimen; an indented line goes with that before."""
        unit = self.runs.age_unit
        lines = [
            "ratio of film to that of a flooded inlet at the same viscosity and speed, when last seen "
            f"(starved below {STARVED:.2f})"
        ]
        for i in _last_runs(self.runs):
            films = ", ".join(
                f"{_shown(each, i, 1.0, 1.0)} at {point.name} ({1e6 * float(film.value[i]):.3g} um)"
                for each, film, point in zip(self.film, self.thickness, self.points, strict=True)
            )
            name, age = self.runs.unit[i], self.runs.age[i]
            lines.append(f"  {name} at {age:.6g} {unit}: {films}; layer {_shown(self.layer, i, 1e6)} um")
        lines += [f"  {point}" for point in self.points]
        for point, ages in zip(self.points, self.starves, strict=True):
            lines.append(
                f"age ({unit}) at which the film falls below {STARVED:.2f} of a flooded film, {point.name}"
            )
            if all(each.age.value == 0.0 for each in ages.units):
                lines.append("  all specimens: starved from new")
            else:
                lines += [f"  {each}" for each in ages.units]
        lines += self.other_drag.lines(unit, self.points[0].name)
        lines.append(
            f"oil in the layer, mm^3, on a track of {1e3 * self.track:.4g} mm: when new, when last "
            f"seen, and needed at {self.points[0].name} so that the film does not starve"
        )
        lines += [f"  {_volumes(each)}" for each in self.oil]
        lines.append(
            f"fitted law dh/dt = -K h0^2 h (h/h0)^p/2 - e h with viscosity exp(g t), median specimen, K in "
            f"1/(m^2 {unit}), e and g in 1/{unit}, p by theory {BY_THEORY:g}: "
            + ", ".join(f"{name} {each}" for name, each in self.law.items())
        )
        return lines

    def with_starvation(self, indicators: Indicators) -> Indicators:
        """Return indicators of the same runs with starvation among them.

        Raises
        ------
        ParameterError
            If they come from other runs.
        """
        if indicators.runs.run != self.runs.run:
            raise ParameterError("the indicators and the film come from different runs")
        return replace(indicators, each=(*indicators.each, self._starvation))

    def to_frame(self) -> pl.DataFrame:
        """Return one row per run; infinite where a bound is unknown."""
        import polars as pl

        columns: dict[str, Any] = {
            "run": list(self.runs.run),
            "unit": list(self.runs.unit),
            f"age ({self.runs.age_unit or '1'})": self.runs.age,
        }
        of = [(f"film over flooded, {p.name} (1)", f) for p, f in zip(self.points, self.film, strict=True)]
        of += [(f"film, {p.name} (m)", f) for p, f in zip(self.points, self.thickness, strict=True)]
        for name, estimates in (
            *of,
            ("layer (m)", self.layer),
            ("viscosity over new oil (1)", self.viscosity),
        ):
            word, _, unit = name.rpartition(" ")
            columns |= {
                name: estimates.value,
                f"{word} low {unit}": estimates.low,
                f"{word} high {unit}": estimates.high,
            }
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
    excluded: Sequence[int] = (),
    seed: int = 0,
) -> FilmLife:
    """Return the film of the specimens of a campaign over their life.

    Each run is fitted by the torque of film, asperities and no-load torque, with viscosity, layer of oil,
    rest, roughness and boundary friction free (`layer`); layer and viscosity of all runs then follow the law
    of `depletion_law`, specimens differing.

    Parameters
    ----------
    campaign
        Campaign. Dwells at several speeds and temperatures are most informative: cold, fast ones show the
        layer, hot ones the level.
    machine
        Machine with contact, lubricant and operating points, and asperities and boundary friction if known.
    cold
        Temperature of the cold corner, K. Default: that of ``[life]``, or the lowest recorded by all
        specimens.
    track
        Length of the track that carries the layer, m, to compute the amount of oil. Default: the
        circumference of the roll.
    side_flow, evaporation
        K in 1/(m^2 age) and e in 1/age, in the campaign's unit of age. Default: fitted.
    excluded
        Places of runs that do not fit, which are left out.
    seed
        Random seed.

    Raises
    ------
    ParameterError
        If the machine lacks contact or lubricant, or a value is impossible.
    InsufficientDataError
        If no dwell has a temperature.
    """
    _refuse_impossible(side_flow, evaporation, track)
    read = film_of_runs(campaign, machine, machine.life.coldest if cold is None else cold, excluded)
    segments = read.runs.segments(OF_FRICTION)
    age = segments.age[read.places]
    of_run = [segments.name[i] for i in read.places]
    names = list(dict.fromkeys(of_run))
    place = np.array([names.index(name) for name in of_run])
    if most_ages(place, age) < 2:
        raise InsufficientDataError(
            "no specimen was measured at two ages, so how its oil layer thins is unknown. Add runs at "
            "another age"
        )
    drawing = partial(fit_depletion, side_flow=side_flow, evaporation=evaporation, seed=seed)
    last = np.array([age[place == k].max() for k in range(len(names))])
    layers, other = _followed(read, SpecimensOfRuns(names, place, age, last), machine, drawing, seed)
    layers = layers.of(read.runs.units, segments.begun)
    if not layers.names:
        raise InsufficientDataError("no specimen has a run since its last maintenance. Add one")
    oldest = {read.runs.unit[i]: float(read.runs.age[i]) for i in _last_runs(read.runs)}
    layers = replace(layers, last=np.array([oldest[name] for name in layers.names]))
    warnings = (*read.warnings, *of_the_law(age, place, machine), of_other_drag(other, read))
    return _film_life(read, layers, segments.begun, machine, track, other, warnings)


class SpecimensOfRuns(NamedTuple):
    """Specimens of runs: names, number and age of each run, and age when last seen."""

    names: list[str]
    place: IntArray
    age: FloatArray
    last: FloatArray

    def some(self, runs: IntArray) -> SpecimensOfRuns:
        """Return those of some runs."""
        numbers, place = np.unique(self.place[runs], return_inverse=True)
        names = [self.names[k] for k in numbers]
        return SpecimensOfRuns(names, place, self.age[runs], self.last[numbers])


def _followed(
    read: FilmOfRuns,
    runs: SpecimensOfRuns,
    machine: Machine,
    drawing: Callable[..., Depletion],
    seed: int,
) -> tuple[LayersOfSpecimens, OtherDrag]:
    """The layers of all specimens whatever the share of other drag, and ages at each share."""
    by, point = read.by_share, read.flooded[0]
    some = runs.some(by.some)
    each = list(side_by_side(lambda layers: drawing(layers, some.place, some.age), by.layers))
    starves = [
        starves_at(LayersOfSpecimens(drawn, some.names, some.last), point, share)
        for drawn, share in zip(each, SHARES.tolist(), strict=True)
    ]
    bounded = np.isfinite(read.layers.interval()[2])
    seen = np.bincount(runs.place, bounded, len(runs.names)) > 0.0
    roughness, slower = film_of(machine)[0].roughness, None
    if by.is_of_all:
        drawn = pooled(each, by.weight, seed)
    else:
        drawn = drawing(by.likeliest, runs.place, runs.age)
        slower = slower_by_share(starves, by.weight, len(drawn.mean), seed)
    layers = LayersOfSpecimens(drawn, runs.names, runs.last, roughness, slower, seen)
    return layers, other_drag(by, starves)


def _refuse_impossible(side_flow: float | None, evaporation: float | None, track: float | None) -> None:
    for name, value in (("side_flow", side_flow), ("evaporation", evaporation)):
        if value is not None and not 0.0 <= value < np.inf:
            raise ParameterError(f"{name} is {value:g}: it must not be negative")
    if track is not None and not 0.0 < track < np.inf:
        raise ParameterError(f"track is {track:g} m: it must be positive")


def _film_life(
    read: FilmOfRuns,
    layers: LayersOfSpecimens,
    begun: dict[str, float],
    machine: Machine,
    track: float | None,
    other_drag: OtherDrag,
    warnings: tuple[Warning, ...],
) -> FilmLife:
    ages = _CURVES * layers.drawn.greatest_age
    length = machine.roll_radius * 2.0 * np.pi if track is None else track
    starving = [layers.starving(point) for point in read.flooded]
    pairs = zip(starving, read.points, strict=True)
    return FilmLife(
        runs=read.runs,
        points=read.points,
        film=tuple(read.film(point) for point in read.flooded),
        thickness=tuple(read.thickness(point) for point in read.flooded),
        layer=read.layer(),
        viscosity=read.viscosity(),
        systematic=systematic_factor(machine, read),
        scatter=read.of_all(read.layers.scatter),
        ages=ages,
        curves=tuple(layers.film(point, ages) for point in read.flooded),
        layers=layers.thickness(ages),
        needs=tuple(layers.needs(point, ages) for point in read.flooded),
        starves=tuple(layers.starves(own, state, read.runs.age_unit, warnings) for own, state in pairs),
        law=layers.rates(),
        oil=layers.oil(read.flooded[0], length * film_of(machine)[0].length),
        track=length,
        other_drag=other_drag,
        warnings=warnings,
        _starvation=replace(read.indicator((warnings[-1],)), own_ages=layers.with_all(starving[0], begun)),
    )


def _last_runs(runs: Runs) -> list[int]:
    """The oldest run of each specimen."""
    last: dict[str, int] = {}
    for i, (unit, age) in enumerate(zip(runs.unit, runs.age, strict=True)):
        if unit not in last or age >= runs.age[last[unit]]:
            last[unit] = i
    return list(last.values())


def _shown(estimates: Estimates, i: int, factor: float, most: float = np.inf) -> str:
    value, low, high = (factor * float(each[i]) for each in (estimates.value, estimates.low, estimates.high))
    if np.isnan(value):
        return "unknown"
    if np.isinf(high) or (np.isfinite(most) and high >= most - 1e-3 and value > 0.99):
        return f"above {low:.3g}"
    return f"{value:.3g} [{low:.3g}, {high:.3g}]"


def _volumes(oil: OilLeft) -> str:
    new, last, needed = (
        f"{1e9 * each.value:.3g} [{1e9 * each.low:.3g}, {1e9 * each.high:.3g}]"
        for each in (oil.new, oil.last, oil.needed)
    )
    return f"{oil.unit}: {new}, {last}, {needed}"
