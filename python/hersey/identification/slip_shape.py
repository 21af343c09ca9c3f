"""The slip between two sticks as part of a free oscillation: for how long the belt sticks.

With constant drag in the slip the stretch runs on an ellipse at the free frequency w = sqrt(k/m). It falls
from its greatest to its least value in half a free period, pi/w, whatever the drive speed; it rises on the
ellipse up to the slope of a held belt, k v, goes straight while the belt sticks, and ends on the ellipse. A
single number is left, the angle b by which the belt sticks early: the force falls by 2 k v / (w cos b), the
belt slips for
2 (pi - b)/w, and b = 0 is an oscillation that just touches rest.
"""

from __future__ import annotations

import numpy as np
from scipy import optimize

#: The steepest share of a rise, of which the slope is taken.
SHARE = 0.45
#: Share of half a cosine that lies between 10 and 90 per cent of its fall.
TEN_TO_NINETY = 2.0 * float(np.arcsin(0.8)) / np.pi
_GREATEST = 0.5 * np.pi * (1.0 - 1e-9)


def stick_angle(drop: float, fall_duration: float, rise_slope: float) -> float:
    """Return the angle b by which the belt sticks early, 0 to pi/2.

    Parameters
    ----------
    drop
        Fall of the force from its maximum to its minimum.
    fall_duration
        Time between the two, s.
    rise_slope
        Slope of the steepest `SHARE` of the rise, per s.
    """
    scaled = 2.0 * rise_slope * fall_duration / (np.pi * drop)
    if scaled >= _scaled_slope(0.0):
        return 0.0
    return float(optimize.brentq(lambda b: _scaled_slope(b) - scaled, 0.0, _GREATEST))


def slip_duration(fall_duration: float, angle: float) -> float:
    """Return for how long the belt slips in each lap, s."""
    return fall_duration * (2.0 - 2.0 * angle / np.pi)


def held_slope(drop: float, fall_duration: float, angle: float) -> float:
    """Return the slope of the force while the belt is held, per s."""
    return float(0.5 * drop * np.pi / fall_duration * np.cos(angle))


def _scaled_slope(angle: float) -> float:
    """Mean slope over the steepest `SHARE` of a rise from -1 to 1, in time of 1/w."""
    held = float(np.tan(angle))
    half_rise = 0.5 * np.pi - angle + held
    half_range = SHARE * half_rise
    return float(np.cos(angle)) if half_range <= held else float(np.cos(half_rise - half_range)) / half_range
