"""One failure mode, followed: the growth of its indicator, and the ages at which it reaches its limit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

import numpy as np

from hersey.arrays import FloatArray, IntArray, side_by_side
from hersey.errors import HerseyError, InsufficientDataError
from hersey.life.growth.fit import Growth, fit_growth
from hersey.life.growth.limit_ages import AgesAtLimit, Earliest, ages_at_limit
from hersey.life.indicator import NOT_JUDGED, Indicator, Indicators, OwnAges
from hersey.life.maintenance import OF_DAMAGE, OF_FRICTION, Followed, Stretch
from hersey.result import Means, Record
from hersey.schema.warning import Warning

#: Share of draws of ages of its own that reach the limit, from which an indicator grows.
_REACHED = 0.5


@dataclass(frozen=True, repr=False)
class Mode(Record):
    """One failure mode: the growth of its indicator and the ages at its limit, of all specimens."""

    name: str
    kind: str
    si: str
    limit: float
    sign: Annotated[
        bool, Means("whether it is a precursor, which does not end a specimen")
    ]  #: a precursor, which ends no specimen
    grows: Annotated[bool, Means("whether its runs show growth")]
    none_before: Annotated[
        float, Means("age before which no specimen reaches the limit, at 90 % confidence", open=True)
    ]  #: if it grows as fast as the runs allow
    growth: Growth
    ages: AgesAtLimit
    warnings: tuple[Warning, ...]
    stretches: Annotated[
        tuple[Stretch, ...], Means("what the units of the growth are; empty if they are the specimens")
    ] = ()


@dataclass(frozen=True)
class FittedWay:
    """A mode with its draws: ages of all specimens and of new ones, and where its runs stand."""

    mode: Mode
    ages: FloatArray
    new: FloatArray  #: ascending in each draw
    residuals: FloatArray  #: per run of the campaign, NaN where it does not show it
    row: dict[str, int]  #: of each specimen that the growth knows
    error: float  #: of a run, typically
    followed: Followed
    earliest: Earliest  #: none where growth shows

    def drawn_values(self, unit: str, age: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return draws of the indicator of a specimen at ages, as `Growth.drawn_values`."""
        return self.mode.growth.drawn_values(self.row[unit], age - self.followed.begun[unit])

    @cached_property
    def order(self) -> IntArray:
        """Draws of each specimen in the order of their ages, (draws, specimens)."""
        return np.asarray(np.argsort(self.ages, axis=0, kind="stable"))

    @property
    def middle(self) -> FloatArray:
        """Age that half of the new specimens of each draw has reached, (draws,)."""
        half, odd = divmod(self.new.shape[1], 2)
        return np.asarray(0.5 * (self.new[:, half - 1 + odd] + self.new[:, half]))


def fitted_way(indicators: Indicators, each: Indicator, seed: int, known: Growth | None = None) -> FittedWay:
    """Return the growth of an indicator, which may be known already, and the ages at its limit.

    Raises
    ------
    InsufficientDataError
        If no run shows it.
    """
    runs = indicators.runs
    known_runs = np.flatnonzero(np.isfinite(each.value))
    if not known_runs.size:
        raise InsufficientDataError("no run shows it")
    of_runs = runs.segments(OF_DAMAGE if each.accumulates else OF_FRICTION)
    growth = known or fit_growth(
        [of_runs.name[i] for i in known_runs],
        of_runs.age[known_runs],
        each.value[known_runs],
        each.error[known_runs],
        quantity=each.name,
        age_unit=runs.age_unit,
        seed=seed,
    )
    row = {name: i for i, name in enumerate(growth.units)}
    last = runs.last
    drawn = _drawn_ages(each, growth, row, of_runs.begun, seed)
    own = OwnAges(drawn.known, np.sort(drawn.new, axis=1))
    grows = growth.shown if each.own_ages is None else bool(np.isfinite(own.known).mean() >= _REACHED)
    if_grown = own
    if each.own_ages is None and not grows:
        drawn = _drawn_ages(each, growth, row, of_runs.begun, seed, if_growing=True)
        if_grown = OwnAges(drawn.known, np.sort(drawn.new, axis=1))
    followed = Followed(last, of_runs.begun, float(of_runs.age.max()))
    earliest = Earliest.of(if_grown).within_reach(followed)
    warnings = [*each.warnings, *growth.warnings]
    missing = [name for name in last if name not in row]
    if missing and each.own_ages is None:
        warnings.append(_without_a_value(missing))
    at_limit = ages_at_limit(
        each.name,
        runs.age_unit,
        each.limit,
        followed,
        own,
        tuple(warnings),
        accumulates=each.accumulates,
        earliest=None if grows else earliest,
    )
    residuals = np.full(runs.age.size, np.nan)
    residuals[known_runs] = growth.residuals()
    mode = Mode(
        each.name,
        each.kind,
        each.si,
        each.limit,
        each.sign,
        grows,
        earliest.first,
        growth,
        at_limit,
        tuple(warnings),
        of_runs.stretches(runs.unit, runs.age),
    )
    error = float(np.median(each.error[known_runs]))
    least = Earliest.unknown(len(last)) if grows else earliest
    return FittedWay(mode, own.known, own.new, residuals, row, error, followed, least)


def fitted_ways(
    indicators: Indicators, seed: int, progress: Callable[[int, int], None] | None
) -> tuple[list[FittedWay], list[Warning]]:
    """Return the growth of each indicator, or a warning that says why there is none.

    ``progress`` is called with indicators done and their total.
    """

    def fitted(place: int) -> FittedWay | Warning:
        each = indicators.each[place]
        try:
            return fitted_way(indicators, each, seed + place)
        except HerseyError as error:
            return Warning(NOT_JUDGED, "{reason}", severity="act", where=each.name, reason=str(error))

    ways, warnings, count = [], [], len(indicators.each)
    for done, found in enumerate(side_by_side(fitted, range(count)), 1):
        if isinstance(found, Warning):
            warnings.append(found)
        else:
            ways.append(found)
        if progress:
            progress(done, count)
    return ways, warnings


def _without_a_value(specimens: Sequence[str]) -> Warning:
    return Warning(
        "specimens without a value",
        "no run of {specimens} shows it. Such specimens are treated like any new one",
        severity="watch",
        specimens=listed(specimens),
    )


def _drawn_ages(
    each: Indicator,
    growth: Growth,
    row: dict[str, int],
    begun: dict[str, float],
    seed: int,
    *,
    if_growing: bool = False,
) -> OwnAges:
    """Draws of the ages at the limit, of specimens, which grow from the age ``begun``, and of new ones."""
    known, new = growth.drawn_ages(
        each.limit, limit_error=each.limit_error, accumulates=each.accumulates, if_growing=if_growing
    )
    # A specimen of which no run shows this is one more of the population.
    random = np.random.default_rng([seed, 3])
    spare = iter(random.permutation(new.shape[1]).tolist() * len(begun))
    if each.own_ages is None:
        ages = [known[:, row[name]] if name in row else new[:, next(spare)] for name in begun]
        return OwnAges(np.stack(ages, axis=1) + np.array(list(begun.values())), new)
    columns = random.integers(each.own_ages.new.shape[1], size=new.shape[1])
    known, new = (_as_many(own, len(known)) for own in (each.own_ages.known, each.own_ages.new))
    return OwnAges(known, new[:, columns])


def _as_many(draws: FloatArray, count: int) -> FloatArray:
    """So many of equally probable draws, evenly."""
    return draws[np.linspace(0, len(draws) - 1, count).astype(np.intp)]


def listed(names: Sequence[str], most: int = 8) -> str:
    """Names in words, the rest of many counted."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more
