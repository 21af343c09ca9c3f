"""A schedule: what was asked for between two times of a log that has no channel of it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import ParameterError, Setting, WrongKindError
from hersey.units import KINDS as UNITS
from hersey.units import si

#: Kinds of units of each column of a schedule; from and to are times, or distances slid.
KINDS = {
    "from": ("time", "length"),
    "to": ("time", "length"),
    "speed": ("speed", "belt speed"),
    "temperature": ("temperature",),
    "load": ("force",),
}
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
    kinds: Mapping[str, str] = field(default_factory=dict)  #: of units, where not the first of `KINDS`
    slid: tuple[float, ...] = ()  #: distance at the end of each step, m, if that is how they are stated

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

        The speed may be one of sliding; then from and to may be distances, each step after the one before.

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
        kinds = dict[str, str]()
        for number, row in enumerate(rows, start=1):
            place = f"step {number} of the schedule"
            if unknown := [key for key in row if key not in KINDS]:
                raise ParameterError(f"{place}: unknown key '{unknown[0]}'. Known: {', '.join(KINDS)}")
            if list(row) != keys and set(row) != set(keys):
                raise ParameterError(
                    f"{place} has other keys ({', '.join(row)}) than the first ({', '.join(keys)})"
                )
            for key in keys:
                value, kind = _in_si(key, row[key])
                if kinds.setdefault(key, kind) != kind:
                    raise ParameterError(
                        f"{place} has {key} as a {kind}, but an earlier one as a {kinds[key]}. Write "
                        "one kind of unit throughout"
                    )
                table[key].append(value)
        if lacking := [key for key in ("from", "to") if key not in table]:
            raise ParameterError(
                f"the schedule lacks '{lacking[0]}': each step needs from, to, and e.g. speed"
            )
        values = {role: tuple(table[role]) for role in ROLES if role in table}
        begin, end = tuple(table["from"]), tuple(table["to"])
        slid = end if "length" in (kinds["from"], kinds["to"]) else ()
        if slid:
            begin, end = _times(begin, end, values.get("speed", ()), kinds)
        others = {key: kind for key, kind in kinds.items() if key in values and kind != KINDS[key][0]}
        return cls(begin, end, values, others, slid)

    def unit(self, role: str) -> str:
        """Return the SI unit of the values of a role."""
        return str(UNITS[self.kinds.get(role, KINDS[role][0])][0])

    def reached(self, distance: FloatArray) -> FloatArray:
        """Return when distances were reached, s, of steps that are stated by distance; NaN beyond them."""
        return np.interp(distance, [0.0, *self.slid], [0.0, *self.end], left=np.nan, right=np.nan)

    def at(self, role: str, time: FloatArray) -> FloatArray:
        """Return what was asked for at times of the log, s; NaN outside every step."""
        begin, end = np.array(self.begin), np.array(self.end)
        step = np.clip(np.searchsorted(begin, time, side="right") - 1, 0, begin.size - 1)
        inside = (time >= begin[step]) & (time < end[step]) | (time == end[-1])
        return np.where(inside, np.array(self.values[role])[step], np.nan)


def _in_si(key: str, value: Any) -> tuple[float, str]:
    """A value in SI, and its kind of unit: the first that it can have."""
    first, *others = KINDS[key]
    try:
        return float(si(first, value)), first
    except WrongKindError:
        for kind in others:
            with suppress(WrongKindError):
                return float(si(kind, value)), kind
        raise


def _times(
    begin: tuple[float, ...], end: tuple[float, ...], speed: tuple[float, ...], kinds: Mapping[str, str]
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """When steps begin and end, s, that are stated by the distance slid.

    Raises
    ------
    ParameterError
        If their times do not follow from their distances.
    """
    if kinds["from"] != kinds["to"] or kinds.get("speed") != "belt speed":
        raise ParameterError(
            "the schedule has steps by distance: write both from and to as distances, and the speed of each "
            'step as a sliding speed, e.g. from = "0 m", to = "20 m", speed = "0.1 m/s"'
        )
    last, now, out = 0.0, 0.0, []
    for i, (start, stop, v) in enumerate(zip(begin, end, speed, strict=True), start=1):
        if not (abs(start - last) <= 1e-9 * stop and stop > start and v != 0.0):
            raise ParameterError(
                f"step {i} of the schedule slides from {start:g} to {stop:g} m at {v:g} m/s. Steps by "
                f"distance must begin where the one before ends ({last:g} m) and move, or state times instead"
            )
        out.append((now, now + (stop - start) / abs(v)))
        last, now = stop, out[-1][1]
    return tuple(first for first, _ in out), tuple(then for _, then in out)
