"""A recording of a force in the place of one of a torque: what to write beside it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from hersey.cli.several import mapping_of_log
from hersey.errors import ChannelError, HerseyError, Setting, UnstatedRoleError

if TYPE_CHECKING:
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
        remedy=f"if it acts at the roll radius, write two lines into {mapping_of_log(path)}: "
        f'torque.channel = {quoted(forces[0])} and radius.value = "{radius}"',
        setting=Setting("torque", "channel"),
    )
