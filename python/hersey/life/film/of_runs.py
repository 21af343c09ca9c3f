"""What the runs of a campaign show of their film: the layer of oil, viscosity, and the film at two states."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray, one_thread
from hersey.errors import InsufficientDataError
from hersey.life.film.filled_dwells import FilledDwells, filled_dwells
from hersey.life.film.layer import LEAST_LAMBDA, LayerFit, Layers, interpolated
from hersey.life.film.shares import ByShare, by_share
from hersey.life.film.starved_drag import Flooded, cubic, film_of, flooded
from hersey.life.growth.limit_ages import DEVIATIONS
from hersey.life.indicator import Indicator, Runs
from hersey.life.maintenance import OF_FRICTION
from hersey.life.oil_layer import STARVED
from hersey.machine.sharing import NEEDED
from hersey.result import Means, Record
from hersey.schema.warning import Warning
from hersey.units import celsius, rpm

if TYPE_CHECKING:
    from hersey.life.campaign import Campaign
    from hersey.machine.machine import Machine

#: What is most likely, and both ends of its interval.
Ends = tuple[FloatArray, ...]
#: Ages over the greatest until which lubricant counts as new.
_YOUNG = 0.05
#: How likely a share of other drag is for whose sake an interval is widened.
_LIKELY = 0.1
#: Dwells of a run from which it shows a film.
_FEWEST = 6
#: Kelvin between the coldest and the hottest dwell of a run from which it shows a film.
_TEMPERATURE_RANGE = 10.0
#: Scatter over the stated errors from which the law does not describe a run.
_BAD = 2.0
#: Runs that a warning names.
_NAMED = 4
#: Standard errors in the 95 % at which uncertainties are stated.
_TO_95 = 1.96


@dataclass(frozen=True)
class FilmPoint(Record):
    """A state at which the film is estimated: speed of the roll (rad/s) and temperature (K)."""

    name: str
    speed: float
    temperature: float

    def __str__(self) -> str:
        """Return name, speed and temperature."""
        return f"{self.name} ({rpm(self.speed):.4g} rpm, {celsius(self.temperature):.4g} degC)"


@dataclass(frozen=True)
class Estimates(Record):
    """Estimates of runs or specimens, with 90 % intervals; an end is infinite where it is not known."""

    value: Annotated[FloatArray, Means(shape="(n,) or (n, m)", open=True)]
    low: Annotated[FloatArray, Means(shape="(n,) or (n, m)", open=True)]
    high: Annotated[FloatArray, Means(shape="(n,) or (n, m)", open=True)]


@dataclass(frozen=True)
class FilmOfRuns:
    """What the runs of a campaign show; ``places`` are those of the runs that have dwells."""

    runs: Runs
    places: IntArray
    by_share: ByShare
    points: tuple[FilmPoint, ...]
    flooded: tuple[Flooded, ...]
    warnings: tuple[Warning, ...]

    @property
    def layers(self) -> Layers:
        """The layers at the likeliest share of other drag."""
        return self.by_share.likeliest

    def of_all(self, values: FloatArray) -> FloatArray:
        """Return values of all runs, NaN where one has no dwells."""
        every = np.full(len(self.runs.run), np.nan)
        every[self.places] = values
        return every

    def spread(self, of: Callable[[Layers], Ends]) -> Estimates:
        """Return a value and the ends of its interval of all runs, whatever the share of other drag."""
        return Estimates(*(self.of_all(np.exp(each)) for each in self._ends(of)))

    def _ends(self, of: Callable[[Layers], Ends]) -> Ends:
        """Value at the likeliest share, and the widest ends at any that is likely enough."""
        if not self.by_share.is_of_all:
            return of(self.layers)
        pairs = zip(self.by_share.layers, self.by_share.weight, strict=True)
        ends = [of(each)[1:] for each, weight in pairs if weight > _LIKELY]
        low, high = (np.array(each) for each in zip(*ends, strict=True))
        return of(self.layers)[0], low.min(axis=0), high.max(axis=0)

    def film(self, point: Flooded) -> Estimates:
        """Return the film over the flooded one at a point."""
        return self.spread(lambda found: tuple(found.log_share(each) for each in found.interval(point)))

    def thickness(self, point: Flooded) -> Estimates:
        """Return the film at a point, m."""
        return self.spread(lambda found: found.film(point))

    def layer(self) -> Estimates:
        """Return the layer of oil, m."""
        return self.spread(Layers.thickness)

    def viscosity(self) -> Estimates:
        """Return the factor on viscosity at the middle temperature; its error includes that of the layer."""
        return self.spread(_viscosity)

    def indicator(self, more: tuple[Warning, ...] = ()) -> Indicator:
        """Return starvation as a failure mode, with more warnings: layer needed over layer, limit 1."""
        best, low, high = self._ends(
            lambda found: tuple(each - found.starved_at for each in found.interval(self.flooded[0]))
        )
        seen = np.isfinite(low) & np.isfinite(high)
        value = np.where(seen, np.exp(-best), np.nan)
        error = np.where(seen, np.where(seen, high - low, 0.0) / (2.0 * DEVIATIONS), np.nan)
        return Indicator(
            name=f"starvation, {self.points[0].name}",
            kind="starvation",
            si="1",
            limit=1.0,
            value=self.of_all(value),
            error=self.of_all(error),
            warnings=(
                Warning(
                    "starvation defined",
                    "the film is starved where it is below {share:.2f} of a flooded film at {point} "
                    "({speed:.4g rpm}, {temperature:.4g degC})",
                    share=STARVED,
                    point=self.points[0].name,
                    speed=self.points[0].speed,
                    temperature=self.points[0].temperature,
                ),
                *self.warnings,
                *more,
            ),
        )


def _viscosity(found: Layers) -> Ends:
    """Most likely ln of the factor on viscosity, and its interval."""
    weight = np.exp(-0.5 * found.deviance) * np.gradient(found.place, axis=1)
    weight /= weight.sum(axis=1, keepdims=True)
    value = interpolated(found.best, found.place, found.viscosity)
    away = found.viscosity - value[:, None]
    error = np.sqrt((weight * (away**2 + found.viscosity_error**2)).sum(axis=1))
    return value, value - DEVIATIONS * error, value + DEVIATIONS * error


def film_of_runs(
    campaign: Campaign, machine: Machine, cold: float | None, excluded: Sequence[int] = ()
) -> FilmOfRuns:
    """Return what runs show of their film, at a cold corner of ``cold`` (K; None: what all recorded).

    ``excluded`` are the places of runs that are not asked.

    Raises
    ------
    ParameterError, InsufficientDataError
        As `film_life`.
    """
    runs = Runs.of(campaign)
    if not runs.run:
        raise InsufficientDataError(f"{campaign.path.name} has no runs. Add logs first")
    dwells, places = filled_dwells(campaign, runs)
    asked = ~np.isin(places, excluded)
    dwells, places = dwells.rows(np.flatnonzero(asked)), places[asked]
    usable = _shows_film(dwells)
    if not usable.any():
        raise InsufficientDataError(
            f"no run has {_FEWEST} dwells over {_TEMPERATURE_RANGE:g} K or more. At one temperature, a "
            "thin oil layer looks like a thick oil. Record cold and hot dwells"
        )
    dwells, places = dwells.rows(np.flatnonzero(usable)), places[usable]
    points = _points(machine, dwells, [runs.unit[i] for i in places], cold)
    fast, cold_corner = ((each.speed, each.temperature) for each in points)
    fit = LayerFit.of(dwells, machine, speed=cold_corner[0], kelvin=cold_corner[1], other=fast)
    _refuse_touching(fit, points[0])
    age = runs.segments(OF_FRICTION).age[places]
    by = by_share(fit, [runs.unit[i] for i in places], age <= _YOUNG * age.max())
    found = by.likeliest
    if (scatter := float(np.median(found.scatter))) > _BAD:
        raise InsufficientDataError(
            f"dwells of most runs scatter about the fit of the film by more than {_BAD:g} times their "
            f"errors (median {scatter:.3g}). Nip, lubricant or load differ from the machine file"
        )
    films = tuple(
        flooded(*film_of(machine), np.array([point.speed]), np.array([point.temperature])) for point in points
    )
    warnings = _warnings(runs, places, found)
    if not usable.all():
        few = Warning(
            "runs without a film",
            "{count} of {runs} runs have too few dwells or only one temperature, so their film cannot "
            "be determined",
            severity="watch",
            count=int(np.count_nonzero(~usable)),
            runs=usable.size,
        )
        warnings = (few, *warnings)
    return FilmOfRuns(runs, places, by, points, films, warnings)


def _refuse_touching(fit: LayerFit, point: FilmPoint) -> None:
    """Refuse faces that may touch before the film starves, and of which the machine says nothing."""
    if fit.asperities is not None or fit.roughness is None:
        return
    over = float(np.exp(cubic(fit.other.film, np.zeros(()))[0].item())) / fit.roughness
    if over < LEAST_LAMBDA:
        raise InsufficientDataError(
            f"the flooded film at {point.name} is {over:.2g} times the roughness. Below {LEAST_LAMBDA:g} "
            "times, faces that touch raise the torque as a film does that starves. Add [asperities] "
            f"{NEEDED['asperities']} and [boundary] {NEEDED['boundary']} to the machine file"
        )


def _shows_film(dwells: FilledDwells) -> BoolArray:
    """Which runs have dwells enough, over temperatures enough."""
    temperatures = np.where(dwells.given, dwells.kelvin, np.nan)
    temperature_range = np.nanmax(temperatures, axis=1) - np.nanmin(temperatures, axis=1)
    return np.asarray((dwells.given.sum(axis=1) >= _FEWEST) & (temperature_range >= _TEMPERATURE_RANGE))


def _points(
    machine: Machine, dwells: FilledDwells, units: list[str], cold: float | None
) -> tuple[FilmPoint, FilmPoint]:
    """The fastest operating point, and its speed at the coldest temperature that all specimens recorded."""
    coldest: dict[str, float] = {}
    for unit, kelvin in zip(units, dwells.kelvin.min(axis=1).tolist(), strict=True):
        coldest[unit] = min(kelvin, coldest.get(unit, kelvin))
    if machine.points:
        fastest = max(machine.points, key=lambda point: point.speed)
        state = FilmPoint(fastest.name, fastest.speed / machine.roll_radius, fastest.temperature)
    else:
        state = FilmPoint("fastest and hottest dwells", float(dwells.speed.max()), float(dwells.kelvin.max()))
    return state, FilmPoint("the cold corner", state.speed, max(coldest.values()) if cold is None else cold)


def _warnings(runs: Runs, places: IntArray, found: Layers) -> tuple[Warning, ...]:
    _, _, high = found.interval()
    warnings = []
    unseen = int(np.count_nonzero(~np.isfinite(high)))
    if unseen:
        warnings.append(
            Warning(
                "runs without starvation",
                "{count} of {runs} runs show no starvation, so only a lower bound of their oil layer "
                "is known",
                count=unseen,
                runs=len(places),
            )
        )
    bad = [
        f"{runs.unit[places[i]]} at {runs.age[places[i]]:.6g}" for i in np.flatnonzero(found.scatter > _BAD)
    ]
    if bad:
        more = " and others" if len(bad) > _NAMED else ""
        warnings.append(
            Warning(
                "dwells scatter",
                "dwells of {which} scatter about the fit by more than {factor:g} times their errors. "
                "Nip, lubricant or load differ from the machine file",
                severity="act",
                which=", ".join(bad[:_NAMED]) + more,
                factor=_BAD,
            )
        )
    return tuple(warnings)


def systematic_factor(machine: Machine, read: FilmOfRuns) -> float:
    """Factor (90 %) by which all layers may be off: the nip's width is taken for viscosity."""
    contact, _ = film_of(machine)
    if contact.nip_uncertainty is None:
        return 1.0
    point = read.flooded[0]
    level = cubic(point.shear, np.zeros(()))[1].item()
    film = cubic(point.film, np.zeros(()))[1].item()
    return float(np.exp(DEVIATIONS / _TO_95 * np.log1p(contact.nip_uncertainty) * film / max(level, 0.1)))


@one_thread()
def starvation_indicator(campaign: Campaign, machine: Machine) -> Indicator:
    """Return starvation as a failure mode: layer needed over layer at the fastest operating point, limit 1.

    It needs a machine with contact and lubricant, and dwells at several speeds and temperatures: the layer is
    seen where it is thinner than a flooded film or near it, cold and fast. A run all of whose dwells are
    flooded shows only a lower bound of the layer, which a number with an error cannot hold: there the value
    is NaN, as for a run without dwells. `film_life` uses those, too.

    Raises
    ------
    ParameterError, InsufficientDataError
        As `film_life`.
    """
    return film_of_runs(campaign, machine, None).indicator()
