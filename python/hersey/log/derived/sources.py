"""What is said of channels that no column holds, and what it gives for one file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from hersey.errors import ParameterError, Setting
from hersey.log.channels import ChannelChoice, Stated
from hersey.log.derived.file_names import NamePattern, differing, proposed_pattern
from hersey.log.derived.given import Derived, Given
from hersey.log.derived.run_table import RunTable, read_run_table
from hersey.log.derived.schedule_file import read_schedule
from hersey.log.derived.set_points import SetPoints
from hersey.schema.warning import Warning
from hersey.units import parse


def _in_names(role: str, numbers: Sequence[str], template: str) -> Warning:
    """That names of files differ in a number that may be a load or a radius."""
    return Warning(
        "numbers in file names",
        "the file names differ in a number that may be the {meaning} ({numbers}); it is not used",
        remedy="if it is, use {how}",
        severity="watch",
        role=role,
        meaning={"load": "normal load", "radius": "radius"}[role],
        numbers=", ".join(dict.fromkeys(numbers)),
        how=Setting("name_pattern").to(template),
    )


@dataclass(frozen=True)
class Sources:
    """What a person says of channels that no column holds; None where nothing is said."""

    pattern: NamePattern | None = None
    table: RunTable | None = None
    schedule: SetPoints | None = None
    window: float | None = None

    @classmethod
    def of(
        cls,
        name_pattern: str | None,
        name_decimal: str | None,
        run_table: str | Path | None,
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
        table = read_run_table(run_table) if run_table else None
        return cls(pattern, table, known, position_window)._told_apart()

    def _told_apart(self) -> Sources:
        """The same, if no two of them give one role."""
        given = dict[str, str]()
        for what, roles in self._by_what().items():
            for role in roles:
                if role in given:
                    raise ParameterError(f"{given[role]} and {what} both give the {role}: omit one of them")
                given[role] = what
        return self

    def _by_what(self) -> dict[str, Iterable[str]]:
        """The roles that each gives."""
        return {
            "the schedule": self.schedule.values if self.schedule else (),
            "the table of runs": self.table.units if self.table else (),
            "the file names": self.pattern.units if self.pattern else (),
        }

    @property
    def roles(self) -> frozenset[str]:
        """The roles that it gives."""
        return frozenset(role for roles in self._by_what().values() for role in roles)

    def refuse_twice(self, choices: Mapping[str, ChannelChoice], stated: Stated) -> None:
        """Raise if a role has a column, or a value, and is given here too.

        Raises
        ------
        ParameterError
            It names both.
        """
        settings = (Setting("schedule"), Setting("run_table"), Setting("name_pattern"))
        of = {
            role: setting
            for setting, roles in zip(settings, self._by_what().values(), strict=True)
            for role in roles
        }
        for role, setting in of.items():
            if choices[role].name or getattr(stated, role, None) is not None:
                named = Setting(role, "channel").to(choices[role].name)
                raise ParameterError(f"{named} and {setting.to()} both give the {role}: omit one of them")
        if choices["position"].name and (choices["speed"].name or "speed" in of):
            other = of.get("speed", Setting("speed", "channel")).to()
            position = Setting("position", "channel").to(choices["position"].name)
            raise ParameterError(f"{position} and {other} both give the speed: omit one of them")

    def stated(self, stated: Stated, files: Sequence[Any]) -> Stated:
        """Return what is stated of loads and radii, with those of each file.

        Raises
        ------
        ParameterError
            If a name does not match, or a table does not list it.
        """
        for source, setting in ((self.pattern, "name_pattern"), (self.table, "run_table")):
            for role, kind in (("load", "force"), ("radius", "length")):
                if source and role in source.units:
                    found = tuple(parse(kind, source.values(_name(file, setting))[role]) for file in files)
                    value: Any = found[0] if len(set(found)) == 1 else found
                    stated = replace(stated, **{role: value})
        return stated

    def unused(
        self, names: Sequence[str], choices: Mapping[str, ChannelChoice], stated: Stated
    ) -> list[Warning]:
        """Return that the names of files differ in a load or a radius that nobody stated."""
        known = [
            role for role in ("load", "radius") if choices[role].name or getattr(stated, role) is not None
        ]
        known += ["speed", "temperature"]
        if self.pattern or len(names) < 2:
            return []
        found = proposed_pattern(names[0], names, needed=("load", "radius"), known=known)
        differ = {} if found is None else differing(found, names)
        return [_in_names(role, numbers, found[0]) for role, numbers in differ.items() if found]

    def of_file(self, file: Any) -> Derived:
        """Return what is said of one file."""
        given = {
            role: Given(role, schedule=self.schedule)
            for role in (self.schedule.values if self.schedule else ())
        }
        for source, setting in ((self.pattern, "name_pattern"), (self.table, "run_table")):
            named = source.values(_name(file, setting)) if source else {}
            table = source.name if isinstance(source, RunTable) else ""
            given |= {
                role: Given(role, named[role], table=table)
                for role in ("speed", "temperature")
                if role in named
            }
        return Derived(given, self.window)


def _name(file: Any, setting: str) -> str:
    if not isinstance(file, str | Path):
        raise ParameterError(f"{Setting(setting).to()} needs files; a table in memory has no name")
    return Path(file).name
