"""The parameters of a belt's motion: their names in the order of the core, and the kinds of their units."""

from __future__ import annotations

#: Kind of unit of each parameter; exponents have none.
KINDS: dict[str, str | None] = {
    "stiffness": "stiffness",
    "mass": "mass",
    "transition_force": "force",
    "transition_speed": "belt speed",
    "ehl_exponent": None,
    "mixed_exponent": None,
    "stick_speed": "belt speed",
    "drive_speed": "belt speed",
}
#: What a sweep varies.
PARAMETERS = tuple(KINDS)
#: What makes a belt, its spring and its drag.
OF_THE_BELT = PARAMETERS[:-1]
