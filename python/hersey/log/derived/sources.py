"""What is said of channels that no column holds, and what it gives for one file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from hersey.errors import ParameterError, Setting
from hersey.log.channels import ChannelChoice, Stated
from hersey.log.derived.file_names import NamePattern
from hersey.log.derived.given import Derived, Given
from hersey.log.derived.schedule_file import read_schedule
from hersey.log.derived.set_points import SetPoints
from hersey.units import parse


@dataclass(frozen=True)
class Sources:
    """What a person says of channels that no column holds; None where nothing is said."""

    pattern: NamePattern | None = None
    schedule: SetPoints | None = None
    window: float | None = None

    @classmethod
    def of(
        cls,
        name_pattern: str | None,
        name_decimal: str | None,
        schedule: str | Path | SetPoints | Iterable[Mapping[str, Any]] | None,
        position_window: float | None,
    ) -> Sources:
        """Return it from arguments as `hersey.read` takes them.

        Raises
        ------
        HerseyError
            If one of them is wrong, or two give the same.
        """
        pattern = NamePattern(name_pattern, name_decimal or ".") if name_pattern else None
        if name_decimal and pattern is None:
            decimal, of = Setting("name_decimal").to(), Setting("name_pattern").to("{speed} rpm.csv")
            raise ParameterError(f"{decimal} is the decimal mark of {of}, which is not given")
        if position_window is not None and not 0 < position_window < np.inf:
            raise ParameterError(f"position_window is {position_window:g} s: it must be greater than 0")
        steps = read_schedule(schedule) if isinstance(schedule, str | Path) else schedule
        known = steps if isinstance(steps, SetPoints) or steps is None else SetPoints.of(steps)
        if both := sorted(set(known.values if known else ()) & set(pattern.units if pattern else ())):
            raise ParameterError(f"the schedule and the file names both give the {both[0]}: omit one of them")
        return cls(pattern, known, position_window)

    @property
    def roles(self) -> frozenset[str]:
        """The roles that it gives."""
        return frozenset(self.schedule.values if self.schedule else ()) | frozenset(
            self.pattern.units if self.pattern else ()
        )

    def refuse_twice(self, choices: Mapping[str, ChannelChoice], stated: Stated) -> None:
        """Raise if a role has a column, or a value, and is given here too.

        Raises
        ------
        ParameterError
            It names both.
        """
        of = {role: Setting("schedule") for role in (self.schedule.values if self.schedule else ())}
        of |= {role: Setting("name_pattern") for role in (self.pattern.units if self.pattern else ())}
        for role, setting in of.items():
            if choices[role].name or getattr(stated, role, None) is not None:
                named = Setting(role, "channel").to(choices[role].name)
                raise ParameterError(f"{named} and {setting.to()} both give the {role}: omit one of them")
        if choices["position"].name and (choices["speed"].name or "speed" in of):
            other = of.get("speed", Setting("speed", "channel")).to()
            position = Setting("position", "channel").to(choices["position"].name)
            raise ParameterError(f"{position} and {other} both give the speed: omit one of them")

    def stated(self, stated: Stated, files: Sequence[Any]) -> Stated:
        """Return what is stated of loads and radii, with those in the names of the files.

        Raises
        ------
        ParameterError
            If a name does not match.
        """
        for role in ("load", "radius"):
            if self.pattern and role in self.pattern.units:
                kind = {"load": "force", "radius": "length"}[role]
                found = tuple(parse(kind, self._named(file)[role]) for file in files)
                value: Any = found[0] if len(set(found)) == 1 else found
                stated = replace(stated, **{role: value})
        return stated

    def of_file(self, file: Any) -> Derived:
        """Return what is said of one file."""
        given = {
            role: Given(role, schedule=self.schedule)
            for role in (self.schedule.values if self.schedule else ())
        }
        if self.pattern:
            named = self._named(file)
            given |= {role: Given(role, named[role]) for role in ("speed", "temperature") if role in named}
        return Derived(given, self.window)

    def _named(self, file: Any) -> dict[str, str]:
        assert self.pattern is not None
        if not isinstance(file, str | Path):
            raise ParameterError(f"{Setting('name_pattern').to()} needs files; a table in memory has no name")
        return self.pattern.values(Path(file).name)
