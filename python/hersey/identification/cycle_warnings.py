"""What to know of the slips that were found in a trace: gaps, noise, drift, a sign that may be turned."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from hersey.errors import Setting
from hersey.identification.detection import FEWEST_SLIPS
from hersey.identification.sampling import Samples
from hersey.identification.slip_figures import SlipFigures
from hersey.identification.turning_points import least_turn
from hersey.schema.warning import Warning

#: Kind of the warning that the slip is not resolved.
FALLS_OF_FEW_SAMPLES = "falls of few samples"
#: Kind of the warning that the number of slips depends on the smallest drop counted.
MANY_SMALL = "many small slips"
#: Samples that a fall must last for its duration to be trusted.
_FEW_SAMPLES = 6
#: Force below zero after each slip, as a share of the drop, from which its zero is doubted. A free slip ends
#: there if the belt breaks away at 3.5 times the friction of sliding: (1 - 2 x 0.3) / (2 - 2 x 0.3) of it.
_BELOW_ZERO = 0.3


def warnings_of(
    samples: Samples,
    figures: SlipFigures,
    least: float,
    least_drop: float | None,
    drift: float,
    *,
    cyclic: bool,
    zeroed: bool,
) -> tuple[Warning, ...]:
    """Return the warnings of slips of which the ``least`` was counted, where ``least_drop`` was asked for.

    ``drift`` is that of the level, per s; ``cyclic`` whether the falls make cycles, ``zeroed``
    whether they are slips of a force, which has a zero.
    """
    if figures.drop.size < FEWEST_SLIPS:
        return ()
    return (
        *_of_the_falls(samples, figures, least, least_drop),
        *_of_the_samples(samples),
        *_of_the_level(samples, figures, drift, cyclic=cyclic),
        *(_of_the_zero(figures) if zeroed else ()),
    )


def _of_the_falls(
    samples: Samples, figures: SlipFigures, least: float, least_drop: float | None
) -> Iterator[Warning]:
    """Yield what makes the duration or the number of falls uncertain."""
    drop, lasts = figures.drop, float(np.median(figures.steep / samples.interval))
    if lasts < _FEW_SAMPLES:
        yield Warning(
            FALLS_OF_FEW_SAMPLES,
            "a drop lasts only {samples:.1f} samples",
            severity="watch",
            remedy="sample faster to resolve the slip",
            samples=lasts,
        )
    if least_drop is not None and least > least_drop:
        yield Warning(
            "least drop within noise",
            "the smallest drop asked for, {least_drop:g}, is within the noise, so {taken:.3g} was used",
            severity="watch",
            least_drop=least_drop,
            taken=least,
        )
    small = int(np.sum(drop < 0.5 * np.median(drop)))
    if least_drop is None and small > 0.05 * drop.size:
        numbers = {"small": small, "slips": drop.size, "half": 0.5 * float(np.median(drop)), "least": least}
        yield _many_small(numbers | {"scatter": least_turn(samples.noise, samples.value.size, 1)})


def in_unit(warning: Warning, unit: str, *, chosen: bool) -> Warning:
    """Return a warning of a trace whose unit is known, as it is typed; ``1`` for a share of the weight.

    ``chosen`` says whether the smallest drop may be chosen with its unit: not for a trace of speed.
    """
    return _many_small(warning.values, unit, chosen=chosen) if warning.kind == MANY_SMALL else warning


def _many_small(numbers: Mapping[str, Any], unit: str = "", *, chosen: bool = True) -> Warning:
    plain = unit in ("", "1")
    remedy = "choose it, e.g. half the median with " + (
        "{option}={half:.3g}"
        if not unit
        else "{option:{half:.3g}}"
        if plain
        else "{option:{half:.3g} {unit}}"
    )
    return Warning(
        MANY_SMALL,
        "{small} of {slips} slips are smaller than half the median, so their number depends on the "
        + (
            "smallest drop counted ({least:.3g} here; samples scatter by {scatter:.3g})"
            if plain
            else "smallest drop counted ({least:.3g} {unit} here; samples scatter by {scatter:.3g} {unit})"
        ),
        severity="watch",
        remedy=remedy if chosen else "",
        **(dict(numbers) | {"option": Setting("least_drop")} | ({"unit": unit} if unit else {})),
    )


def _of_the_samples(samples: Samples) -> Iterator[Warning]:
    """Yield which samples are missing or removed."""
    if samples.missing:
        yield Warning(
            "samples missing",
            "{count} {count:sample is|samples are} missing; cycles that a gap hides in part are not used",
            count=samples.missing,
        )
    if samples.spikes:
        yield Warning(
            "spikes removed",
            "{count} {count:spike|spikes} of one or two samples {count:was|were} removed",
            count=samples.spikes,
        )


def _of_the_level(samples: Samples, figures: SlipFigures, drift: float, *, cyclic: bool) -> Iterator[Warning]:
    """Yield whether the sign may be turned, and how far the level drifts."""
    period, lasts = figures.period, float(np.median(figures.steep))
    shaped = cyclic or lasts >= _FEW_SAMPLES * samples.interval  # else rises and falls are made by sampling
    if shaped and period.size and float(np.median(period)) - lasts < 0.5 * lasts:
        yield Warning(
            "sign may be turned",
            "the trace rises faster than it falls. Is its sign flipped?",
            severity="watch",
        )
    swing = abs(drift) * samples.interval * samples.value.size
    if swing > 0.5 * float(np.median(figures.drop)):
        yield Warning(
            "level drifts", "the level drifts by {drift:.3g} over the trace", severity="watch", drift=swing
        )


def _of_the_zero(figures: SlipFigures) -> Iterator[Warning]:
    """Yield that the force changes sign in every cycle, as it does if its mean was removed."""
    low, high = float(np.median(figures.low)), float(np.median(figures.high))
    if low < -_BELOW_ZERO * (high - low):
        yield Warning(
            "force changes sign",
            "the force changes sign in every cycle ({low:.3g} to {high:.3g}). Either break-away takes more "
            "than 3 times the force of sliding, or the zero of the force is lost; identification needs it",
            severity="watch",
            remedy="record with DC coupling, and zero the sensor without load",
            low=low,
            high=high,
        )
