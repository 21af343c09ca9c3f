"""What to know of a drive that was identified: what the record leaves open, and what contradicts it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.estimate import Estimate, quantile
from hersey.identification.cycle_record import CycleRecord
from hersey.identification.drive_fit import DriveFit, HeldSlope
from hersey.identification.independence import ESTIMABLE, NOT_ESTIMABLE, not_estimable
from hersey.identification.motion_kind import LONGEST_OF_LAP, NO_FREE_PERIOD
from hersey.schema.warning import Warning

#: A fit is called poor if its mean cycle is off by more than this share of the drop (root mean square).
POOR = 0.05
#: Either, if known, makes of the slope of the force a measure of the drive speed.
_SCALES = {"stiffness", "mass"}


def warnings_of(
    record: CycleRecord, near: list[DriveFit], covariance: FloatArray, intervals: Mapping[str, Estimate]
) -> tuple[Warning, ...]:
    """Return the warnings of the drives that fit alike, the best first.

    Parameters
    ----------
    covariance
        Of the best fit.
    intervals
        Of what can be estimated, by name.
    """
    best = near[0]
    return (
        *not_estimable(best.names[:-1], covariance[:-1, :-1]),
        *_lost(best, covariance, intervals),
        *_implausible(record, best, intervals),
        *_poor(best),
        *_contradiction(record, best, intervals),
        *_undecided(near),
    )


def _implausible(record: CycleRecord, best: DriveFit, intervals: Mapping[str, Estimate]) -> Iterator[Warning]:
    """Yield why a free period is one that no such record has."""
    free = intervals.get("free_period")
    ends = [name for i, name in enumerate(best.names) if name in ("stiffness", "mass") and best.at_bound(i)]
    if free is None:
        return
    if ends:
        yield Warning(
            NO_FREE_PERIOD,
            "no free period is reported, because the fit ended at the plausible limit of {parameters}",
            severity="watch",
            parameters=" and ".join(ends),
        )
    elif free.low > LONGEST_OF_LAP * best.period:
        yield Warning(
            NO_FREE_PERIOD,
            "no free period is reported, because {free:.3g} s is longer than the cycle of {lap:.3g} s",
            severity="watch",
            free=free.value,
            lap=best.period,
        )
    elif free.high < 2.0 * record.samples.interval:
        yield Warning(
            NO_FREE_PERIOD,
            "no free period is reported, because {free:.3g} s is shorter than two samples",
            severity="watch",
            free=free.value,
        )


def _poor(best: DriveFit) -> Iterator[Warning]:
    """Yield how far the model is off where it is much."""
    if best.misfit > POOR:
        yield Warning(
            "poor fit",
            "the model differs from the mean cycle by {misfit:.0%} of the drop",
            severity="watch",
            remedy="treat the parameters as rough estimates",
            misfit=best.misfit,
        )


def _undecided(near: list[DriveFit]) -> Iterator[Warning]:
    """Yield which closures fit equally well."""
    if len(near) > 1:
        yield Warning(
            "closure not decided",
            "the closures {closures} fit equally well, so this record cannot decide between them",
            severity="watch",
            closures=" and ".join(fit.closure for fit in near),
        )


def _contradiction(
    record: CycleRecord, best: DriveFit, intervals: Mapping[str, Estimate]
) -> Iterator[Warning]:
    """Yield where the slope of the force of a held belt over the drive speed is another stiffness.

    The slope, k times the drive speed less the creep, is a measurement of its own.
    """
    held, given = best.held_slope(), "stiffness" in best.known
    if held is None or (not given and "stiffness" not in intervals):
        return
    by_slope = held.slope / best.drive_speed
    fitted = best.parameters(best.values)["stiffness"]
    unsure = float(
        np.hypot(quantile(best.wave.number - 1) * held.error / held.slope, record.drive_speed_uncertainty)
    )
    if not given:
        unsure += max(intervals["stiffness"].high / fitted, fitted / intervals["stiffness"].low) - 1.0
    creep_is_free = best.known.keys() & _SCALES and "stick_speed" not in best.known
    if abs(by_slope / held.followed / fitted - 1.0) > unsure:
        yield _other_stiffness(best, held, fitted)
    elif creep_is_free and abs(by_slope / fitted - 1.0) > unsure:
        yield _taken_for_creep(best, held, fitted)


def _other_stiffness(best: DriveFit, held: HeldSlope, fitted: float) -> Warning:
    return Warning(
        "slope contradicts stiffness",
        (
            "while the belt is held, the spring force rises by {slope:.5g} per s. At the drive speed "
            "of {drive_speed:.5g} this means a stiffness of {by_slope:.5g}, but {stiffness:.5g} is "
        )
        + ("given" if "stiffness" in best.known else "fitted")
        + "; they would agree at a drive speed of {agreed:.5g}",
        severity="watch",
        remedy="check the drive speed and the parameters given as known",
        slope=held.slope,
        drive_speed=best.drive_speed,
        by_slope=held.slope / best.drive_speed,
        stiffness=fitted,
        agreed=held.slope / held.followed / fitted,
    )


def _taken_for_creep(best: DriveFit, held: HeldSlope, fitted: float) -> Warning:
    return Warning(
        "difference taken for creep",
        (
            "while the belt is held, the spring force rises by {slope:.5g} per s. At the drive speed "
            "of {drive_speed:.5g} this means a stiffness of {by_slope:.5g}, but {stiffness:.5g} is "
        )
        + ("given" if "stiffness" in best.known else "fitted")
        + (
            ". The fit explains the difference by creep of the held belt, {creep:.1%} of the drive speed; "
            "a drive speed of {agreed:.5g} would explain it too"
        ),
        severity="watch",
        slope=held.slope,
        drive_speed=best.drive_speed,
        by_slope=held.slope / best.drive_speed,
        stiffness=fitted,
        creep=1 - held.followed,
        agreed=held.slope / fitted,
    )


def _lost(best: DriveFit, covariance: FloatArray, intervals: Mapping[str, Estimate]) -> Iterator[Warning]:
    """Yield parameters that look estimable by the fit alone, but are not."""
    errors = best.errors(covariance)
    names = best.names[:-1]  # the drive speed was stated
    lost = [name for i, name in enumerate(names) if name not in intervals and errors[i] < ESTIMABLE]
    if lost:
        yield Warning(
            NOT_ESTIMABLE,
            "{parameters} cannot be estimated: drives that fit equally well differ too much in them",
            severity="watch",
            parameters=", ".join(name.replace("_", " ") for name in lost),
        )
