"""A schedule: what was asked for between two times of a log that has no channel of it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import ParameterError, Setting
from hersey.units import si

#: Kind of unit of each column of a schedule; from and to are times.
KINDS = {"from": "time", "to": "time", "speed": "speed", "temperature": "temperature", "load": "force"}
ROLES = ("speed", "temperature", "load")
_SCHEDULE = Setting("schedule")
#: Steps at the most.
_MOST = 100_000


@dataclass(frozen=True)
class SetPoints:
    """Steps of a schedule, in SI: each from a time to the next, with what was asked for."""

    begin: tuple[float, ...]
    end: tuple[float, ...]
    values: Mapping[str, tuple[float, ...]]

    def __post_init__(self) -> None:
        """Refuse steps that overlap, or run backwards.

        Raises
        ------
        ParameterError
            It names the step.
        """
        if not self.begin or not self.values:
            raise ParameterError(f"{_SCHEDULE.to()} has no step. Each needs from, to, and e.g. speed")
        if len(self.begin) > _MOST:
            raise ParameterError(f"{_SCHEDULE.to()} has more than {_MOST} steps")
        for i, (begin, end) in enumerate(zip(self.begin, self.end, strict=True), start=1):
            if not begin < end:
                raise ParameterError(
                    f"step {i} of the schedule ends at {end:g} s, before it begins ({begin:g} s)"
                )
            if i > 1 and begin < self.end[i - 2]:
                raise ParameterError(
                    f"step {i} of the schedule begins at {begin:g} s, before the previous one ends "
                    f"({self.end[i - 2]:g} s). Correct the times, and keep the steps in order"
                )

    @classmethod
    def of(cls, steps: Iterable[Mapping[str, Any]]) -> SetPoints:
        """Return a schedule from its steps: ``from``, ``to`` and e.g. ``speed``, numbers in SI or with units.

        Raises
        ------
        ParameterError, UnitError
            It names the step and the key.
        """
        rows = [dict(step) for step in steps]
        if not rows:
            raise ParameterError(f"{_SCHEDULE.to()} has no step. Each needs from, to, and e.g. speed")
        keys = list(rows[0])
        table: dict[str, list[float]] = {key: [] for key in keys}
        for number, row in enumerate(rows, start=1):
            place = f"step {number} of the schedule"
            if unknown := [key for key in row if key not in KINDS]:
                raise ParameterError(f"{place}: unknown key '{unknown[0]}'. Known: {', '.join(KINDS)}")
            if list(row) != keys and set(row) != set(keys):
                raise ParameterError(
                    f"{place} has other keys ({', '.join(row)}) than the first ({', '.join(keys)})"
                )
            for key in keys:
                table[key].append(float(si(KINDS[key], row[key])))
        if lacking := [key for key in ("from", "to") if key not in table]:
            raise ParameterError(
                f"the schedule lacks '{lacking[0]}': each step needs from, to, and e.g. speed"
            )
        values = {role: tuple(table[role]) for role in ROLES if role in table}
        return cls(tuple(table["from"]), tuple(table["to"]), values)

    def at(self, role: str, time: FloatArray) -> FloatArray:
        """Return what was asked for at times of the log, s; NaN outside every step."""
        begin, end = np.array(self.begin), np.array(self.end)
        step = np.clip(np.searchsorted(begin, time, side="right") - 1, 0, begin.size - 1)
        inside = (time >= begin[step]) & (time < end[step]) | (time == end[-1])
        return np.where(inside, np.array(self.values[role])[step], np.nan)
