"""An indicator: one failure mode, as a positive number of each run that grows toward a limit."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Annotated

import numpy as np

from hersey.arguments.frozen import explained
from hersey.arrays import FloatArray, IntArray
from hersey.errors import ParameterError
from hersey.life.maintenance import Event, Segments, segments
from hersey.result import Means, Record
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    from hersey.life.campaign import Campaign

#: Kind of the warning that a failure mode, named by where, is not judged.
NOT_JUDGED = "mode not judged"


@dataclass(frozen=True, repr=False)
class Runs(Record):
    """Runs of a campaign by specimen and age: run numbers, names, and ages in ``age_unit``.

    ``events`` is the maintenance of the specimens.
    """

    run: tuple[int, ...]
    unit: tuple[str, ...]
    age: FloatArray
    age_unit: str
    events: Annotated[tuple[Event, ...], Means("maintenance of the specimens")] = ()

    @classmethod
    def of(cls, campaign: Campaign) -> Runs:
        """Return the runs of a campaign."""
        table = campaign.runs()
        age = table["age"].to_numpy().astype(float)
        run, unit = (tuple(table[name].to_list()) for name in ("run", "unit"))
        return cls(run, unit, age, campaign.age_unit, tuple(campaign.events()))

    def segments(self, kinds: Collection[str]) -> Segments:
        """Return the segments of the runs, which begin with each event of some kinds."""
        return segments(self.run, self.unit, self.age, self.events, kinds)

    @cached_property
    def last(self) -> dict[str, float]:
        """Age at which each specimen was last seen."""
        last: dict[str, float] = {}
        for unit, age in zip(self.unit, self.age.tolist(), strict=True):
            last[unit] = max(age, last.get(unit, 0.0))
        return last

    @property
    def units(self) -> tuple[str, ...]:
        """Names of the specimens, each once, in the order of the runs."""
        return tuple(dict.fromkeys(self.unit))


def most_ages(place: IntArray, age: FloatArray) -> int:
    """Return at how many ages the specimen was seen that was seen at most; both of each run."""
    seen = np.unique(np.stack([place, age]), axis=1)[0]
    return int(np.unique(seen, return_counts=True)[1].max())


@dataclass(frozen=True, repr=False)
class OwnAges:
    """Ages at the limit by a law of the indicator's own, equally probable draws.

    ``known`` are those of `Runs.units`, shape (draws, specimens), ``new`` of new specimens, (draws, new
    specimens); a row holds all under one draw of what they share.
    """

    known: FloatArray
    new: FloatArray


@explained
@dataclass(frozen=True, repr=False)
class Indicator:
    """One failure mode.

    ``value`` is positive, NaN where a run does not show it, and grows toward ``limit``, both in ``si``. If it
    ``accumulates``, it is a rate per age, and the limit applies to its integral from age 0. ``error`` is its
    relative standard error; ``limit_error`` that of limit and sensor, common to all runs. ``kind`` is the
    failure in two or three words; ``name`` distinguishes it from others of its kind. A ``sign`` is a
    precursor: a specimen that reaches its limit has not failed. ``own_ages``, if given, replace the ages from
    growth laws.
    """

    name: str
    kind: str
    si: str
    limit: float
    value: FloatArray
    error: FloatArray
    limit_error: float = 0.0
    accumulates: bool = False
    sign: bool = False
    own_ages: OwnAges | None = None
    warnings: tuple[Warning, ...] = ()

    def __post_init__(self) -> None:
        """Check the numbers."""
        known = np.isfinite(self.value)
        if not (np.isfinite(self.limit) and self.limit > 0.0):
            raise ParameterError(f"the limit of {self.name} is {self.limit:g}: it must be greater than 0")
        if self.value.shape != self.error.shape or np.any(self.value[known] <= 0.0):
            raise ParameterError(f"{self.name} must be positive and have an error for each run")
        if np.any(~(self.error[known] >= 0.0)):
            raise ParameterError(f"an error of {self.name} is negative or not a number")


@explained
@dataclass(frozen=True, repr=False)
class Indicators:
    """Runs and the failure modes that they show; ``warnings`` says which modes are not judged, and why."""

    runs: Runs
    each: tuple[Indicator, ...]
    warnings: tuple[Warning, ...] = ()

    def without_runs(self, places: Sequence[int]) -> Indicators:
        """Return the same, unknown at some runs."""
        if not places:
            return self
        known = ~np.isin(np.arange(self.runs.age.size), places)
        return replace(
            self,
            each=tuple(
                replace(
                    each,
                    value=np.where(known, each.value, np.nan),
                    error=np.where(known, each.error, np.nan),
                )
                for each in self.each
            ),
        )
