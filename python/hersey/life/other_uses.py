"""How the ages move where the limit of the torque, the coldest start or the duty is another one."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from itertools import product
from typing import TYPE_CHECKING, Annotated

import numpy as np

from hersey.arrays import one_thread, side_by_side
from hersey.errors import HerseyError, ParameterError
from hersey.life.growth.limit_ages import Earliest, Interval, of_population
from hersey.life.indicators.of_campaign import AskedRuns, asked_of
from hersey.life.time_to_failure.first import ages_of_new, ends_of_specimens, joint_order
from hersey.life.time_to_failure.joined import correlations
from hersey.life.time_to_failure.way import FittedWay, fitted_way
from hersey.result import Means, Record, Result
from hersey.units import celsius, takes_si

if TYPE_CHECKING:
    import polars as pl

    from hersey.life.campaign import Campaign
    from hersey.life.growth.fit import Growth
    from hersey.life.indicator import Indicator, Indicators
    from hersey.life.time_to_failure.estimate import TimeToFailure
    from hersey.machine.machine import Machine

#: Limits of the torque that are tried, over the one stated.
_LIMITS = (0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5, 1.8)
#: The duty as the machine file states it.
AS_STATED = "as stated"
#: Ways whose limit is that of the motor's torque.
_MOTOR = "motor torque"


@dataclass(frozen=True)
class UseEnd(Record):
    """The first end of a specimen in another use, with the ways in words."""

    name: str
    age: Interval
    ways: Annotated[str, Means("failure mode that comes first, in words")]


@dataclass(frozen=True)
class Use(Record):
    """One use: limit of the motor's torque (N m), coldest start (K), duty, and the first ends in it."""

    torque_limit: Annotated[float | None, Means(unit="N m")]
    coldest: Annotated[float | None, Means("coldest start", "K")]
    duty: Annotated[str, Means("as stated, or the one operating point at which the drive then runs")]
    stated: Annotated[
        bool, Means("whether this is the operating condition of the machine file")
    ]  #: the use that the machine file states
    ends: Annotated[tuple[UseEnd, ...], Means("of the specimens; empty if nothing can be followed")]
    b10: Annotated[
        Interval | None,
        Means("age by which a tenth of new specimens has failed; null for fewer than four specimens"),
    ]
    b50: Annotated[Interval | None, Means("the same of half of new specimens")]

    @property
    def half(self) -> Interval | None:
        """Age by which half of new specimens fail; of the first specimen where there is no population."""
        if self.b50 is not None:
            return self.b50
        return min((each.age for each in self.ends), key=lambda age: age.value, default=None)


@dataclass(frozen=True, repr=False)
class OtherUses(Result):
    """First failures of specimens and population for each combination of limit, coldest start and duty."""

    age_unit: str
    torque_limits: Annotated[tuple[float, ...], Means(unit="N m")]
    coldest: Annotated[tuple[float, ...], Means(unit="K")]
    duties: tuple[str, ...]
    uses: tuple[Use, ...]

    def headline(self) -> str:
        """Return the range of ages by which half of new specimens fail, or the first specimen of a few."""
        halves = [use.half for use in self.uses]
        ages = [age.value for age in halves if age is not None]
        what = (
            "half of new specimens fail" if any(use.b50 for use in self.uses) else "the first specimen fails"
        )
        unit = f" {self.age_unit}" if self.age_unit else ""
        low, high = (f"{float(f'{age:.3g}'):.10g}" for age in (min(ages), max(ages)))
        return (
            f"{what} between {low} and {high}{unit}, depending on the operating "
            f"conditions ({len(ages)} compared)"
        )

    def summary(self) -> str:
        """Return one line per operating condition, with the age by which half of new specimens fail."""
        return "\n".join([self.headline(), *(f"  {_words(use)}" for use in self.uses)])

    def to_frame(self) -> pl.DataFrame:
        """Return one row per condition and specimen, the population last; infinite if never reached."""
        import polars as pl

        rows = [(use, end) for use in self.uses for end in (*use.ends, *_shares(use))]
        unit = self.age_unit or "1"
        return pl.DataFrame(
            {
                "torque limit (N m)": [use.torque_limit for use, _ in rows],
                "coldest (K)": [use.coldest for use, _ in rows],
                "duty": [use.duty for use, _ in rows],
                "unit": [end.name for _, end in rows],
                f"age ({unit})": [end.age.value for _, end in rows],
                f"age low ({unit})": [end.age.low for _, end in rows],
                f"age high ({unit})": [end.age.high for _, end in rows],
                "ways": [end.ways for _, end in rows],
            }
        )


@one_thread()
@takes_si()
def other_uses(
    campaign: Campaign,
    machine: Machine,
    indicators: Indicators,
    *,
    seed: int = 0,
    progress: Callable[[int, int], None] | None = None,
) -> OtherUses:
    """Return the times to failure under other operating conditions of the machine.

    Parameters
    ----------
    campaign, machine
        As for `follow`.
    indicators
        Indicators under the stated conditions; modes that depend on none of limit, cold and duty (the film)
        are taken from here.
    seed
        Random seed, that of `time_to_failure`: the stated conditions then have the same numbers.
    progress
        Called with conditions done and their total.

    Raises
    ------
    ParameterError
        If the machine states nothing that other conditions could change.
    """
    _refuse_unchangeable(machine)
    asked = asked_of(campaign, machine)
    return uses_beside(None, asked, machine, indicators, seed=seed, progress=progress)


def uses_beside(
    found: TimeToFailure | None,
    asked: AskedRuns,
    machine: Machine,
    indicators: Indicators,
    *,
    excluded: Sequence[int] = (),
    seed: int = 0,
    progress: Callable[[int, int], None] | None = None,
) -> OtherUses:
    """Return `other_uses` with the growths of a `time_to_failure` of these very indicators and this seed.

    ``asked`` is what their runs say; ``excluded`` are the places of runs at which the indicators are taken
    as unknown.
    """
    _refuse_unchangeable(machine)
    limit, cold = machine.limits.motor_torque, asked.coldest
    limits = () if limit is None else tuple(limit * factor for factor in _LIMITS)
    starts = () if limit is None else tuple(asked.starts)
    points = tuple(point.name for point in machine.points) if _depends_on_duty(machine) else ()
    duties = (AS_STATED, *points)
    ways = _Ways({each.name: i for i, each in enumerate(indicators.each)}, seed)
    if found is not None:
        ways.take(indicators, found)
    conditions = list(product(starts or (None,), duties))
    as_it_is = [coldest in (cold, None) and duty == AS_STATED for coldest, duty in conditions]
    every = [
        indicators if stated else _in_use(asked, machine, indicators, *each).without_runs(excluded)
        for each, stated in zip(conditions, as_it_is, strict=True)
    ]
    unknown = ways.unknown(every)
    uses: list[Use] = []
    total = len(unknown) + max(len(limits), 1) * len(conditions)
    for done, _ in enumerate(side_by_side(lambda pair: ways.followed(*pair), unknown), 1):
        if progress:
            progress(done, total)
    for (coldest, duty), stated, here in zip(conditions, as_it_is, every, strict=True):
        for torque in limits or (None,):
            ends = ways.ends(here, torque)
            uses.append(Use(torque, coldest, duty, stated and torque == limit, *ends))
            if progress:
                progress(len(unknown) + len(uses), total)
    return OtherUses(indicators.runs.age_unit, limits, starts, duties, tuple(uses))


class _Ways:
    """The failure modes of all uses, each growth fitted once, each limit reached once."""

    def __init__(self, places: dict[str, int], seed: int) -> None:
        self._places, self._seed = places, seed
        self._growth: dict[tuple[str, bytes], Growth] = {}
        self._known: dict[tuple[str, bytes, float], FittedWay | None] = {}

    def take(self, indicators: Indicators, found: TimeToFailure) -> None:
        """Take the growths of indicators from what was found of them with the same seed."""
        growth = {mode.name: mode.growth for mode in found.modes}
        self._growth |= {_key(each): growth[each.name] for each in indicators.each if each.name in growth}

    def unknown(self, uses: Sequence[Indicators]) -> list[tuple[Indicators, Indicator]]:
        """Return the indicators whose growth is not known yet, each once."""
        new = {_key(each): (here, each) for here in uses for each in _limited(here, None)}
        return [pair for key, pair in new.items() if key not in self._growth]

    def ends(
        self, indicators: Indicators, torque: float | None
    ) -> tuple[tuple[UseEnd, ...], Interval | None, Interval | None]:
        """The first ends, B10 and B50, drawn as `time_to_failure` does; none where no way can be followed."""
        chosen = sorted(_limited(indicators, torque), key=lambda each: self._place(each.name))
        ways = [way for each in chosen if (way := self.followed(indicators, each)) is not None]
        if not ways:
            return (), None, None
        random = np.random.default_rng([self._seed, 2])
        of_runs = correlations([way.residuals for way in ways])
        units, _ = ends_of_specimens(ways, of_runs, indicators.runs.units, indicators.runs.last, random)
        order = joint_order(ways, of_runs, random)
        first = np.sort(reduce(np.minimum, ages_of_new(ways, order, random)), axis=1)
        least = Earliest.of_first([way.earliest for way in ways])
        b10, b50 = of_population(first, len(units), least, min(way.followed.greatest for way in ways))
        ends = tuple(UseEnd(each.unit, each.age.age, each.ways) for each in units)
        if b10 is None or b50 is None:
            return ends, None, None
        return ends, b10.age, b50.age

    def _place(self, name: str) -> int:
        return self._places.get(name, len(self._places))

    def followed(self, indicators: Indicators, each: Indicator) -> FittedWay | None:
        grown = _key(each)
        key = *grown, each.limit
        if key not in self._known:
            self._known[key] = None
            with contextlib.suppress(HerseyError):  # as in the report, which says why
                seed = self._seed + self._place(each.name)
                way = fitted_way(indicators, each, seed, self._growth.get(grown))
                self._known[key], self._growth[grown] = way, way.mode.growth
        return self._known[key]


def _key(each: Indicator) -> tuple[str, bytes]:
    """What the growth of an indicator depends on; its name stands for its seed."""
    return each.name, each.value.tobytes() + each.error.tobytes()


def _refuse_unchangeable(machine: Machine) -> None:
    if machine.limits.motor_torque is None and not _depends_on_duty(machine):
        raise ParameterError(
            "there are no other operating conditions to compare. Set motor_torque in [limits]"
        )


def _shares(use: Use) -> list[UseEnd]:
    """B10 and B50 as rows of a table, where there is a population."""
    named = (("B10", use.b10), ("B50", use.b50))
    return [UseEnd(name, age, "") for name, age in named if age is not None]


def _words(use: Use) -> str:
    """One use, and when half of new specimens have ended in it."""
    parts = [] if use.torque_limit is None else [f"{use.torque_limit:.3g} N m"]
    parts += [] if use.coldest is None else [f"from {celsius(use.coldest):.3g} degC"]
    parts += [] if use.duty == AS_STATED else [f"only {use.duty}"]
    words = ", ".join([*parts, *(["as stated"] if use.stated else [])])
    return f"{words}: {use.half if use.ends else 'nothing can be followed'}"


def _depends_on_duty(machine: Machine) -> bool:
    """Whether a failure mode sums over the points, and there is more than one."""
    sums = machine.gear is not None or any(
        value is not None for value in (machine.life.continuous_torque, machine.life.energy)
    )
    return sums and len(machine.points) > 1


def _in_use(
    asked: AskedRuns, machine: Machine, stated: Indicators, coldest: float | None, duty: str
) -> Indicators:
    """The indicators in another use; those that do not depend on it as they are."""
    points = machine.points
    if duty != AS_STATED:
        points = tuple(replace(point, share=float(point.name == duty)) for point in points)
    other = asked.indicators(replace(machine, points=points), coldest=coldest, signs=False)
    names = {each.name for each in other.each}
    kept = tuple(each for each in stated.each if each.name not in names)
    return replace(other, each=(*other.each, *kept))


def _limited(indicators: Indicators, torque: float | None) -> list[Indicator]:
    """The indicators that end a specimen, that of the motor against another limit."""
    ending = [each for each in indicators.each if not each.sign]
    if torque is None:
        return ending
    return [replace(each, limit=torque) if each.kind == _MOTOR else each for each in ending]
