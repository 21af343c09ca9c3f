"""Recordings for ``--trace``: what one lacks, a force in the place of a torque, a trace in that of a log."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from hersey.cli.mistyped import retyped
from hersey.cli.several import mapping_of_log
from hersey.errors import ChannelError, HerseyError, Setting, UnstatedRoleError, followed_by

if TYPE_CHECKING:
    from hersey.damping.recipe import Recipe
    from hersey.machine.machine import Machine


def of_a_force(error: HerseyError, path: Path, machine: Machine) -> HerseyError:
    """Let an error say how the force of a recording becomes a torque, for this file alone.

    It stays as it is if another thing is missing, or if one of several forces could be meant. An option would
    hold for the log too, so none is proposed.
    """
    from hersey.files.toml import quoted
    from hersey.log.reading import list_channels
    from hersey.log.roles import is_of_kind

    lacking = isinstance(error, UnstatedRoleError) and error.role == "radius"
    absent = (
        isinstance(error, ChannelError) and error.absent and error.setting == Setting("torque", "channel")
    )
    if not (lacking or absent):
        return error
    columns = list_channels(path)
    forces = [name for name, unit in columns if is_of_kind("force", unit)]
    if len(forces) != 1 or not any(is_of_kind("speed", unit) for _, unit in columns):
        return error
    radius = f"{1e3 * machine.roll_radius:.6g} mm"
    return ChannelError(
        f"{path.name}: '{forces[0]}' is a force, but a trace needs the torque",
        remedy=f"if it acts at the radius of the machine file, write two lines into {mapping_of_log(path)}: "
        f'torque.channel = {quoted(forces[0])} and radius.value = "{radius}"',
        setting=Setting("torque", "channel"),
    )


def lacking_columns(error: HerseyError, path: Path, recipe: Recipe) -> HerseyError:
    """Let an error of a recording that lacks a column name all that it lacks, and how to read it alone.

    Any other error stays as it is. No option is proposed, as it would hold for the log too.
    """
    from hersey.log.channels import ChannelChoice, find_channel
    from hersey.log.reading import list_channels
    from hersey.log.roles import ROLES
    from hersey.log.text.column import Column

    if not (isinstance(error, ChannelError) and error.absent):
        return error
    columns = tuple(Column(i, name, unit) for i, (name, unit) in enumerate(list_channels(path)))
    stated = recipe.chosen.channels | recipe.channels

    def is_there(role: str) -> bool:
        try:
            return find_channel(role, columns, ChannelChoice(stated.get(role, "")), path.name) is not None
        except HerseyError:  # which comes near it
            return True

    without = {"temperature": recipe.isothermal, "time": recipe.every is not None}
    needed = [role for role in ROLES if not without.get(role)]
    lacked = [role for role in needed if not is_there(role)]
    if not lacked:
        return error
    where = mapping_of_log(path)
    named = f'if a column is one of these, name it in {where}, e.g. {lacked[0]}.channel = "NAME"'
    listed = ", ".join(f"'{column}'" for column in columns)
    return ChannelError(
        f"{path.name}: no {' or '.join(lacked)} column found. A trace is a recording of this machine with "
        f"{', '.join(needed[:-1])} and {needed[-1]}. Columns: {listed}",
        remedy=followed_by(named, of_a_trace([path])),
        setting=error.setting,
    )


def of_a_trace(paths: list[Path]) -> str:
    """Return what to type for a stick-slip trace in the place of a log; nothing if the file is no trace."""
    from hersey.identification.trace_file import read_trace_runs

    if len(paths) != 1:
        return ""
    try:
        read_trace_runs(paths[0])
    except HerseyError:
        return ""
    return f"If it is a stick-slip trace, type: {retyped('cycles', str(paths[0]))}"
