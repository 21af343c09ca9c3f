"""What to know of the slips that were found in a trace: gaps, noise, drift, a sign that may be turned."""

from __future__ import annotations

import numpy as np

from hersey.identification.detection import FEWEST_SLIPS
from hersey.identification.sampling import Samples
from hersey.identification.slip_figures import SlipFigures
from hersey.identification.turning_points import least_turn

#: Samples that a fall must last for its duration to be trusted.
_FEW_SAMPLES = 6


def notes_on(
    samples: Samples, figures: SlipFigures, least: float, least_drop: float | None, drift: float
) -> list[str]:
    """Return the notes on slips of which the ``least`` was counted, where ``least_drop`` was asked for.

    ``drift`` is that of the level, per s.
    """
    drop, period, lasts = figures.drop, figures.period, figures.steep / samples.interval
    notes: list[str] = []
    if drop.size < FEWEST_SLIPS:
        return notes
    if float(np.median(lasts)) < _FEW_SAMPLES:
        notes.append(f"a fall lasts {np.median(lasts):.1f} samples: sample faster to see the slip")
    floor = least_turn(samples.noise, samples.value.size, 1)
    if least_drop is not None and least > least_drop:
        notes.append(f"least_drop {least_drop:g} is within the noise: {least:.3g} was taken")
    small = int(np.sum(drop < 0.5 * np.median(drop)))
    if least_drop is None and small > 0.05 * drop.size:
        notes.append(
            f"{small} of {drop.size} slips fall by less than half the median: their number depends "
            f"on the least fall counted, {least:.3g} here (samples scatter by {floor:.3g}); give least_drop"
        )
    if samples.missing:
        notes.append(
            f"{samples.missing} samples are missing; no cycle across a gap that hides part of it is used"
        )
    if samples.spikes:
        notes.append(f"{samples.spikes} spikes of one or two samples were removed")
    rise = float(np.median(period) if period.size else 0.0) - float(np.median(lasts)) * samples.interval
    if period.size and rise < 0.5 * float(np.median(lasts)) * samples.interval:
        notes.append("the force rises faster than it falls: is its sign turned?")
    swing = abs(drift) * samples.interval * samples.value.size
    if swing > 0.5 * float(np.median(drop)):
        notes.append(f"the level drifts by {swing:.3g} over the trace")
    return notes
