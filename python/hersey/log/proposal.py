"""A mapping proposed for the channels of a log, to be looked at, mended and kept."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from hersey.errors import HerseyError, Setting, printable
from hersey.files.toml import quoted
from hersey.log.channels import ChannelChoice, called, find_channel, is_dead
from hersey.log.columns import open_columns
from hersey.log.derived.direction import called_direction
from hersey.log.elsewhere import elsewhere
from hersey.log.layouts.current import reading_by
from hersey.log.layouts.proposing import proposed_layout
from hersey.log.reading import list_channels
from hersey.log.roles import role_conversion
from hersey.log.signals import may_be_current
from hersey.log.stating import proposed
from hersey.log.text.column import Column
from hersey.units import Conversion


def propose_mapping(
    path: str | Path,
    *,
    channels: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
    names: Sequence[str] = (),
    said: Mapping[str, Any] | None = None,
) -> str:
    """Return a mapping for the channels of a log as TOML, to be looked at, mended and kept.

    What is not known is left out, with a line that says why; what could be corrected is a comment.
    ``channels`` and ``units`` by role are taken as for `hersey.read`. ``names`` are those of all files that
    are read together, and ``said`` is what else is known, by its name in `hersey.read_with_mapping`, SI.

    Raises
    ------
    HerseyError
        If the file cannot be read.

    Examples
    --------
    >>> print(propose_mapping("examples/bench.csv").splitlines()[1])
    [torque]
    """
    path = Path(path)
    known = _Known(path, channels or {}, units or {}, tuple(names) or (path.name,), said or {})
    proposal = proposed_layout(path, channels, units)
    if proposal is None:
        return "\n".join(_roles(known))
    with reading_by(proposal.layout):
        lines = _roles(replace(known, channels={**proposal.channels, **known.channels}))
    return "\n".join([lines[0], proposal.layout.toml(), "", *lines[1:]])


@dataclass(frozen=True)
class _Known:
    """A log, and what a person says of it."""

    path: Path
    channels: Mapping[str, str]
    units: Mapping[str, str]
    names: tuple[str, ...]
    said: Mapping[str, Any]

    def choice(self, role: str) -> ChannelChoice:
        """The choice for a role."""
        return ChannelChoice(self.channels.get(role, ""), self.units.get(role, ""))


def _roles(known: _Known) -> list[str]:
    """The lines of a mapping that say which channel plays which role."""
    path = known.path
    columns = tuple(Column(index, name, unit) for index, (name, unit) in enumerate(list_channels(path)))
    lines = [f"# Channels of {printable(path.name)}, proposed by hersey inspect. Check and correct them."]
    lines += [*_with_said(_torque(columns, known), known), ""]
    if speed := _with_said(_speed(columns, known), known):
        lines += [*speed, ""]
    named = _names(columns, known)
    if not any("{temperature" in line for line in named):
        lines += [*_proposed("temperature", columns, known), ""]
    every = known.said.get("every")
    clock = _proposed("time", columns, known) if every is None else ["[time]", f'every = "{every:.12g} s"']
    lines += [*clock, "", *named]
    return [*lines, *_others(known), *_direction(known)]


def _torque(columns: tuple[Column, ...], known: _Known) -> list[str]:
    """The table of the torque, or of a current in its place; one that nobody named is a comment."""
    named = known.channels.get("torque", "")
    constant = known.said.get("torque_constant")
    lines = _proposed("torque", columns, known)
    current = next(iter(called(named, columns) if named else []), None)
    if constant is None and lines[0] == "[torque]":
        return lines
    current = current or next((c for c in columns if may_be_current(c.name, c.unit)), None)
    if current is None:
        return lines
    unit = known.units.get("torque") or current.unit or "A"
    table = ["[torque]", f"channel = {quoted(current.path)}", f"unit = {quoted(unit)}"]
    if constant is not None:
        others = (line for line in _EXAMPLES["torque"] if "motor_constant" not in line)
        return [*table, f'motor_constant = "{constant:.12g} N*m/A"', *others]
    what = f"'{printable(current.path)}' may be the motor current. Fill in the torque per ampere"
    return [f"# {what}", *(f"# {line}" for line in table), '# motor_constant = "35 mN*m/A"']


def _speed(columns: tuple[Column, ...], known: _Known) -> list[str]:
    """The table of the speed, or of a position in its place; nothing if file names state it."""
    position = known.channels.get("position", "")
    window = known.said.get("position_window")
    lines = [f'window = "{window:.12g} s"'] if window is not None else ['# window = "0.2 s"']
    if position:
        of = next(iter(called(position, columns)), None)
        unit = known.units.get("position") or (of.unit if of else "")
        return ["[position]", f"channel = {quoted(position)}", f"unit = {quoted(unit)}", *lines]
    table = _proposed("speed", columns, known)
    if table[0] == "[speed]" or known.said.get("schedule") is not None:
        return table
    found = dict(elsewhere(columns, known.path.name, known.names))
    if not (channel := found.get(Setting("position", "channel"))):
        return [] if found else table
    of = called(channel, columns)[0]
    unit = found.get(Setting("position", "unit"), "")
    filled = [f"channel = {quoted(channel)}", f"unit = {quoted(unit or of.unit)}"]
    if unit:
        said = "counts, or degrees, of one turn: fill in the unit"
        return [f"# [position]  # {said}", *(f"# {line}" for line in filled)]
    return ["[position]", *filled, *lines]


def _with_said(table: list[str], known: _Known) -> list[str]:
    """A table of torque or speed with what a person says of signs, gears and inertia."""
    role = table[0].strip("[]") if table and table[0].startswith("[") else ""
    ratio = {"torque": "gear_ratio", "speed": "speed_gear_ratio"}.get(role, "")
    stated = {"sign": (known.said.get("signs") or {}).get(role), "gear_ratio": known.said.get(ratio)}
    written = [f"{key} = {value:.12g}" for key, value in stated.items() if value is not None]
    if role == "torque" and (inertia := known.said.get("inertia")) is not None:
        written.append(f'inertia = "{inertia:.12g} kg*m^2"')
    keys = tuple(f"# {line.partition(' = ')[0]} = " for line in written)
    at = next((i for i, line in enumerate(table) if line.startswith("# ")), len(table))
    rest = [line for line in table[at:] if not (keys and line.startswith(keys))]
    return [*table[:at], *written, *rest]


def _names(columns: tuple[Column, ...], known: _Known) -> list[str]:
    """The table ``[names]``: a pattern that a person states, or one that gives the speed."""
    pattern, decimal = known.said.get("name_pattern"), known.said.get("name_decimal")
    if not pattern:
        if known.channels.get("position") or _proposed("speed", columns, known)[0] == "[speed]":
            return []
        found = {of.name: value for of, value in elsewhere((), known.path.name, known.names)}
        pattern, decimal = found.get("name_pattern"), found.get("name_decimal")
    if not pattern:
        return []
    mark = [f"decimal = {quoted(decimal)}"] if decimal else []
    return ["[names]", f"pattern = {quoted(pattern)}", *mark, ""]


def _others(known: _Known) -> list[str]:
    """The tables of run, radius and load, where a person states them."""
    lines: list[str] = []
    for role, unit in (("run", ""), ("radius", "m"), ("load", "N")):
        amount = known.said.get(role)
        if channel := known.channels.get(role):
            stated = [f"channel = {quoted(channel)}"]
            stated += [f"unit = {quoted(of)}"] if (of := known.units.get(role)) else []
        elif amount is None:
            continue
        elif isinstance(amount, int | float):
            stated = [f'value = "{amount:.12g} {unit}"']
        else:
            stated = [f"values = [{', '.join(quoted(f'{each:.12g} {unit}') for each in amount)}]"]
        lines += [f"[{role}]", *stated, ""]
    return lines


def _direction(known: _Known) -> list[str]:
    """The table of the direction; a column that is only called so is a comment."""
    if named := known.channels.get("direction"):
        return ["[direction]", f"channel = {quoted(named)}", ""]
    with open_columns(known.path) as opened:
        names = [column.name for column in opened.columns]
    if not (name := called_direction(names)):
        return []
    said = "gives the sign of a speed that has none"
    return [f"# [direction]  # {said}", f"# channel = {quoted(name)}", ""]


_EXAMPLES: dict[str, tuple[str, ...]] = {
    "torque": (
        "# sign = -1                     # flips the sign",
        '# tare = "4 mN*m"               # sensor reading without load',
        '# no_load = "4 mN*m"            # torque without the lubricated contact, or a log of it: "free.csv"',
        "# gear_ratio = 12.5             # turns of the sensor shaft per turn of the output shaft",
        "# efficiency = 0.9              # of the gears",
        (
            '# inertia = "2e-4 kg*m^2"       # between sensor and contact, referred to the output; matters '
            "in ramps"
        ),
        '# motor_constant = "35 mN*m/A"  # if the channel is the motor current',
        '# gain_error = "1 %"            # sensor error, at 95 %',
        '# zero_error = "2 mN*m"',
    ),
    "speed": (
        "# sign = -1",
        "# gear_ratio = 12.5             # turns of the sensor shaft per turn of the output shaft",
        '# gain_error = "0.1 %"          # sensor error, at 95 %',
    ),
    "temperature": (
        '# offset = "-1.5 K"             # film temperature minus reading',
        '# time_constant = "4 s"         # sensor lag',
        '# zero_error = "2 K"            # largest difference between film and reading, at 95 %',
        '# film_heating = "3 K"          # largest frictional heating of the film',
    ),
    "time": (),
}
#: What a friction force needs beside it: meaning and an amount of each role.
_BESIDE = {
    "radius": ("radius at which the friction force acts", "25 mm"),
    "load": ("normal load, needed with a friction coefficient", "50 N"),
}


def _proposed(role: str, columns: tuple[Column, ...], known: _Known) -> list[str]:
    choice, path = known.choice(role), known.path
    channel: tuple[Column, Conversion] | None = None
    try:
        channel = find_channel(role, columns, choice, path.name, lambda column: _says_nothing(path, column))
        said = "no channel of the log has such a name or unit"
    except HerseyError as error:
        said = str(error).removeprefix(f"{path.name}: ")
    if channel is not None and not choice.name and _says_nothing(path, channel[0], zero=True):
        said = f"'{channel[0]}' is zero throughout or empty"
        channel = None
    if channel is None:
        return [f"# [{role}]", f"# {printable(said)}", '# channel = ""', '# unit = ""']
    column, unit = channel
    stated = [f"channel = {quoted(column.path)}", f"unit = {quoted(unit.unit)}"]
    kind = role_conversion(role, unit.unit)[0]
    others = _beside(columns, needed=kind in ("force", "friction coefficient")) if role == "torque" else []
    return [f"[{role}]", *stated, *_EXAMPLES[role], *others]


def _beside(columns: tuple[Column, ...], *, needed: bool) -> list[str]:
    """Radius and load, commented out: where a friction force needs them, or a column is called like one."""
    lines: list[str] = []
    for role, (meaning, amount_of) in _BESIDE.items():
        named = proposed(role, columns)
        if not (needed or named):
            continue
        lines += ["", f"# [{role}]".ljust(32) + f"# {meaning}", f'# value = "{amount_of}"']
        if named:
            said = f"column {printable(str(named[0]))} may hold it. To use it, replace value by"
            lines += [
                f"# # {said}",
                f"# channel = {quoted(named[0].path)}",
                f"# unit = {quoted(named[0].unit)}",
            ]
    return lines


def _says_nothing(path: Path, column: Column, *, zero: bool = False) -> bool:
    """Whether a channel of a log holds one value throughout, or none; ``zero``: only whether that is zero."""
    try:
        with open_columns(path) as opened:
            (values,) = opened.numbers(called(column.name, opened.columns)[0])
    except (HerseyError, IndexError):
        return False
    return is_dead(values) and not (zero and np.any(values[np.isfinite(values)]))
