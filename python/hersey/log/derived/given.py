"""Channels of one file that no column holds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from hersey.arrays import FloatArray
from hersey.log.derived.set_points import SetPoints
from hersey.log.roles import role_conversion
from hersey.log.text.column import Column
from hersey.schema.warning import Warning
from hersey.units import Conversion, parse


@dataclass(frozen=True)
class Given:
    """A channel of one file that no column holds: one value with its unit (``text``), or a schedule."""

    role: str
    text: str = ""
    schedule: SetPoints | None = None
    table: str = ""  #: name of the table of runs, if not the name of the file states it

    @property
    def unit(self) -> str:
        """The unit in which it is stated."""
        if self.schedule is not None:
            return self.schedule.unit(self.role)
        return self.text.partition(" ")[2]

    def column(self, group: str) -> tuple[Column, Conversion]:
        """Return what stands for its column, beside those of a group, and its unit."""
        name = "schedule" if self.schedule else self.table or "file name"
        return Column(-1, name, self.unit, group), role_conversion(self.role, self.unit)[1]

    def at(self, time: FloatArray) -> FloatArray:
        """Return its values at times of the file, SI; NaN outside a schedule."""
        if self.schedule is not None:
            return self.schedule.at(self.role, time - time[0])
        kind = role_conversion(self.role, self.unit)[0]
        return np.full(time.size, parse(kind, self.text))

    def warning(self) -> Warning:
        """Return that it was not measured."""
        if self.schedule is not None:
            return Warning(
                "set point",
                "{role} is the set point of the schedule; it was not measured",
                severity="watch",
                role=self.role,
            )
        if self.table:
            return Warning(
                "value of a run table",
                "{role} is {value}, from {table}; it was not measured",
                severity="watch",
                role=self.role,
                value=self.text,
                table=self.table,
            )
        return Warning(
            "value of a file name",
            "{role} is {value}, from the name of the file; it was not measured",
            severity="watch",
            role=self.role,
            value=self.text,
        )


@dataclass(frozen=True)
class Derived:
    """What is said of one file: channels by role, and the time over which a slope is taken, s."""

    channels: Mapping[str, Given] = field(default_factory=dict)
    window: float | None = None
