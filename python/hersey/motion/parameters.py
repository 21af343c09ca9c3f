"""The parameters of a motion: names in the order of the core, kinds of units, and how many of all may be."""

from __future__ import annotations

from collections.abc import Iterable
from math import prod

import numpy as np

from hersey import _core
from hersey.arrays import FloatArray
from hersey.errors import ParameterError

#: Work that a motion may take, in steps of a microsecond or so; a stiff one, or with bristles, counts for 40.
MOST_STEPS: int = _core.MOST_STEPS
#: Most parameter sets of one sweep, which fit in some gigabytes.
MOST_SETS = 20_000_000
#: More than the core takes, so that it says so itself.
_MANY = 10**15
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


def whole(name: str, value: float, least: int = 1) -> int:
    """Return a number of steps, samples or threads as the core takes it; refuse fewer than ``least``."""
    if not value >= least:
        raise ParameterError(f"{name} is {value}: it must be at least {least}", quantity=name)
    return int(min(value, _MANY))


def refuse_too_many(given: Iterable[FloatArray], *, zip: bool) -> None:  # noqa: A002 - the word of `sweep`
    """Refuse arrays that span more parameter sets than fit in memory, before they are laid out."""
    shapes = [numbers.shape for numbers in given]
    try:
        sets = prod(np.broadcast_shapes(*shapes)) if zip else prod(prod(shape) for shape in shapes)
    except ValueError:
        return  # arrays that do not fit together are refused by their shapes
    if sets > MOST_SETS:
        raise ParameterError(
            f"{sets:.3g} parameter sets are more than the limit of {MOST_SETS:.0e}. Sweep them in parts"
        )
