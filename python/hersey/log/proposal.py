"""A mapping proposed for the channels of a log, to be looked at, mended and kept."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from hersey.errors import HerseyError, printable
from hersey.files.toml import quoted
from hersey.log.channels import ChannelChoice, called, find_channel, is_dead
from hersey.log.columns import open_columns
from hersey.log.layouts.current import reading_by
from hersey.log.layouts.proposing import proposed_layout
from hersey.log.reading import list_channels
from hersey.log.roles import role_conversion
from hersey.log.stating import proposed
from hersey.log.text.column import Column
from hersey.units import Conversion


def propose_mapping(
    path: str | Path, *, channels: Mapping[str, str] | None = None, units: Mapping[str, str] | None = None
) -> str:
    """Return a mapping for the channels of a log as TOML, to be looked at, mended and kept.

    What is not known is left out, with a line that says why; what could be corrected is a comment.
    ``channels`` and ``units`` by role are taken as for `hersey.read`.

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
    proposal = proposed_layout(path, channels, units)
    if proposal is None:
        return "\n".join(_roles(path, channels or {}, units or {}))
    with reading_by(proposal.layout):
        lines = _roles(path, {**proposal.channels, **(channels or {})}, units or {})
    return "\n".join([lines[0], proposal.layout.toml(), "", *lines[1:]])


def _roles(path: Path, channels: Mapping[str, str], units: Mapping[str, str]) -> list[str]:
    """The lines of a mapping that say which channel plays which role."""
    columns = tuple(Column(index, name, unit) for index, (name, unit) in enumerate(list_channels(path)))
    lines = [f"# Channels of {printable(path.name)}, proposed by hersey inspect. Check and correct them."]
    for role in ("torque", "speed", "temperature", "time"):
        choice = ChannelChoice(channels.get(role, ""), units.get(role, ""))
        lines += [*_proposed(role, columns, choice, path), ""]
    if "run" in channels:
        lines += ["[run]", f"channel = {quoted(channels['run'])}", ""]
    return lines


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


def _proposed(role: str, columns: tuple[Column, ...], choice: ChannelChoice, path: Path) -> list[str]:
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
