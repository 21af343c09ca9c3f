"""A roll whose load film and asperities share, and the drag of its belt."""

from __future__ import annotations

import hersey
from hersey.lubrication.lubricant import EXAMPLES

ROLL = hersey.Contact(
    roll_radius=15e-3,
    rubber_thickness=3.5e-3,
    modulus=0.6e6,
    poisson_ratio=0.48,
    length=0.22,
    load=300.0,
    roughness=0.4e-6,
)
OIL = EXAMPLES["cylinder oil"]
#: Of both below.
WARM = 373.15
MIXED = hersey.mixed_contact(ROLL, OIL, hersey.Asperities(modulus=50e9), 0.1, speed=4.0, temperature=WARM)
DRAG = hersey.MixedDrag(MIXED, temperature=WARM, stick_speed=3e-4, closure="stiction")
