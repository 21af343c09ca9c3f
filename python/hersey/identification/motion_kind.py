"""What kind of motion the falls of a trace make, whatever slips are counted of it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from hersey.arrays import FloatArray
from hersey.identification.detection import FEWEST_SLIPS
from hersey.identification.sampling import Samples
from hersey.identification.slip_figures import SlipFigures
from hersey.identification.slip_shape import held_slope, slip_duration, stick_angle
from hersey.schema.warning import Warning

#: A belt that sticks for a smaller share of the lap merely touches rest: the oscillation is inertial.
LEAST_STUCK = 0.15
#: An oscillation is more regular than this (deviation of the period over its mean); drift and wear are not.
_REGULAR = 0.25
#: Falls without a rhythm are slips if the typical one is this many times the least that noise does not make.
_CLEAR = 2.0
#: A free period is longer than a lap by no more than this: a belt that sticks only adds to it.
LONGEST_OF_LAP = 1.3
#: Kind of the warning that says why there is no free period.
NO_FREE_PERIOD = "no free period"
#: The duration of a fall that lasts fewer samples is not known.
_RESOLVED = 3.0


class Motion(NamedTuple):
    """The kind, with the figures that are the motion's own.

    ``kind`` is ``steady_sliding``, ``inertial`` or ``stick_slip``; ``falls`` the number of falls beyond the
    noise, ``greatest`` the greatest of them. ``loading_slope`` is the slope of the force of a held belt, per
    s, ``free_period`` 2 pi sqrt(m/k), s, and not a number where the trace gives none that is plausible.
    """

    kind: str
    falls: int
    greatest: float
    loading_slope: float
    free_period: float
    stuck_fraction: float
    warnings: tuple[Warning, ...]


def motion_of(samples: Samples, figures: SlipFigures, least: float) -> Motion:
    """Return the kind of motion of a trace from all its falls beyond the noise, which are of ``least``."""
    falls = figures.middle.size
    greatest = float(np.max(figures.drop)) if falls else float("nan")
    stuck = _stuck_fraction(figures) if figures.period.size >= FEWEST_SLIPS - 1 else 0.0
    kind, warnings = _kind(figures, stuck, least)
    nan = float("nan")
    if kind == "steady_sliding":
        return Motion(kind, falls, greatest, nan, nan, 0.0, warnings)
    implausible = tuple(_implausible_free_period(samples, figures))
    free = nan if implausible else 2.0 * _typical(figures.steep)[0]
    return Motion(kind, falls, greatest, _loading_slope(kind, figures), free, stuck, implausible)


def is_regular(period: FloatArray) -> bool:
    """Whether laps are as regular as those of an oscillation."""
    return bool(float(np.std(period)) <= _REGULAR * float(np.mean(period)))


def _kind(figures: SlipFigures, stuck: float, least: float) -> tuple[str, tuple[Warning, ...]]:
    """Return the kind of motion, and why falls are no cycle."""
    if figures.period.size < FEWEST_SLIPS - 1:
        words = Warning(
            "gaps part the falls",
            "gaps separate the drops, so no two are known to follow each other",
            severity="watch",
        )
        return "steady_sliding", (words,) if figures.middle.size >= FEWEST_SLIPS else ()
    regular = is_regular(figures.period)
    if stuck >= LEAST_STUCK and (regular or float(np.median(figures.drop)) > _CLEAR * least):
        return "stick_slip", ()
    if stuck >= LEAST_STUCK:
        words = Warning(
            "small falls without rhythm",
            "drops barely exceed the noise and have no rhythm, so there is no cycle",
        )
        return "steady_sliding", (words,)
    if not regular:
        words = Warning(
            "irregular force", "the trace varies irregularly without sticking, so there is no cycle"
        )
        return "steady_sliding", (words,)
    return "inertial", ()


def _stuck_fraction(figures: SlipFigures) -> float:
    drop, duration, slope, lap = _typical(figures.drop, figures.duration, figures.slope, figures.period)
    angle = stick_angle(drop, duration, slope)
    return max(0.0, 1.0 - slip_duration(duration, angle) / lap) if angle > 0 else 0.0


def _loading_slope(kind: str, figures: SlipFigures) -> float:
    drop, duration, slope = _typical(figures.drop, figures.duration, figures.slope)
    return held_slope(drop, duration, 0.0) if kind == "inertial" else slope


def _implausible_free_period(samples: Samples, figures: SlipFigures) -> Iterator[Warning]:
    """Yield why twice the typical fall, from its steep part, is no free period."""
    steep, lap = _typical(figures.steep, figures.period)
    free, lasts = 2.0 * steep, samples.interval * samples.value.size
    if steep < _RESOLVED * samples.interval:
        yield Warning(
            NO_FREE_PERIOD,
            "no free period is reported, because a drop lasts only {samples:.1f} samples",
            samples=steep / samples.interval,
        )
    elif free > LONGEST_OF_LAP * lap:
        yield Warning(
            NO_FREE_PERIOD,
            "no free period is reported: twice a drop is {free:.3g} s, longer than the cycle of "
            "{lap:.3g} s, so the drop is not free",
            free=free,
            lap=lap,
        )
    elif free * FEWEST_SLIPS > lasts:
        yield Warning(
            NO_FREE_PERIOD,
            "no free period is reported: twice a drop is {free:.3g} s, and a trace of {lasts:.3g} s is "
            "shorter than {times} of these",
            free=free,
            lasts=lasts,
            times=FEWEST_SLIPS,
        )


def _typical(*columns: FloatArray) -> tuple[float, ...]:
    return tuple(float(np.median(column)) for column in columns)
