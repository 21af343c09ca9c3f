"""Pressures in the chambers of a cylinder, from which its friction force can be computed."""

from __future__ import annotations

from hersey.errors import Setting
from hersey.log.roles import is_of_kind
from hersey.log.text.column import Column

#: What the column of the force is to be called.
_FORCE = "Friction force [N]"


def force_of_pressures(columns: tuple[Column, ...]) -> str:
    """Return what to compute where a log without a torque has the pressures of two chambers, or nothing."""
    pressures = [c for c in columns if c.unit and is_of_kind("pressure", c.unit)]
    if len(pressures) != 2 or any(is_of_kind("force", c.unit) for c in columns):
        return ""
    a, b = (f"'{each.path}'" for each in pressures)
    torque = Setting("torque", "channel").to(_FORCE.partition(" [")[0])
    return (
        f". If {a} and {b} are the pressures in the chambers of a cylinder, add a column '{_FORCE}', {a} x "
        f"piston area A - {b} x piston area B, less mass x acceleration and the load, and use {torque}. Its "
        "seals rub more at a higher pressure, so compare speeds at one pressure"
    )
