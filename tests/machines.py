"""Machines of which only a part matters to a test."""

from __future__ import annotations

from typing import Any

import hersey

#: What of a map is the machine's.
_STATED = set(hersey.Machine.__dataclass_fields__)


def machine_of(train: hersey.Drivetrain, **stated: Any) -> hersey.Machine:
    """The machine of a drivetrain, which grips as far as this says."""
    given = {"roll_radius": 0.02, "stick_speed": 1e-3, "part": train.part, **stated}
    if train.grip is not None:
        limits = given.get("limits", hersey.Limits())
        given["limits"] = hersey.Limits(**{**vars(limits), "roll_friction": 1.0, "nip_load": train.grip})
    return hersey.Machine(train.stiffness, train.mass, **given)


def map_of(surface: hersey.DampingSurface, train: hersey.Drivetrain, **given: Any) -> hersey.OperatingMap:
    """The map of such a machine; what is given is the machine's or the map's."""
    stated = {name: value for name, value in given.items() if name in _STATED}
    asked = {name: value for name, value in given.items() if name not in _STATED}
    return hersey.operating_map(surface, machine_of(train, **stated), **asked)
