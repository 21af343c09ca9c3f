"""Gravity: a load that varies with the angle of the drive, where the angle is known.

torque = G sin(q - q_0), fitted as two linear terms, cos q and sin q; it hangs at rest at q_0.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.moving.stretches import Stretch

#: The two terms, N m; the amplitude (N m) and the angle (rad) that they make.
COSINE, SINE = "cos q", "sin q"
AMPLITUDE, HANGING = "G", "q_0"
#: Least arc, rad, over which gravity can show.
LEAST_ARC = 0.05
#: Longest gap over which the angle is followed, in intervals.
_BRIDGED = 10.0


def with_angles(stretches: Sequence[Stretch]) -> list[Stretch]:
    """Return stretches with their angles: recorded, or what the speed adds up to if gaps are short."""
    if stretches[0].angle is not None:
        return list(stretches)
    out: list[Stretch] = []
    for each in stretches:
        begins = 0.0
        if out:
            before = out[-1]
            gap = each.start - float(before.time[-1])
            if each.run != before.run or gap > _BRIDGED * each.interval or before.angle is None:
                return list(stretches)
            begins = float(before.angle[-1]) + 0.5 * (each.speed[0] + before.speed[-1]) * gap
        steps = 0.5 * (each.speed[1:] + each.speed[:-1]) * each.interval
        out.append(replace(each, angle=begins + np.concatenate([[0.0], np.cumsum(steps)])))
    return out


def arc_of(stretches: Sequence[Stretch]) -> float:
    """Return the arc that the angles span, rad; 0 where one is not known."""
    angles = [each.angle for each in stretches if each.angle is not None]
    if len(angles) < len(stretches):
        return 0.0
    return max(float(each.max()) for each in angles) - min(float(each.min()) for each in angles)


def gravity_of(terms: FloatArray, covariance: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return amplitude and angle at rest, from both terms, and their covariance."""
    cosine, sine = terms
    amplitude = float(np.hypot(cosine, sine))
    turn = np.array([[cosine, sine], [-sine / amplitude, cosine / amplitude]]) / amplitude
    return np.array([amplitude, np.arctan2(-cosine, sine)]), turn @ covariance @ turn.T
