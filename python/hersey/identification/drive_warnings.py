"""What to know of a drive that was identified: what the record leaves open, and what contradicts it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.estimate import Estimate, quantile
from hersey.identification.cycle_record import CycleRecord
from hersey.identification.drive_fit import DriveFit, HeldSlope
from hersey.identification.independence import ESTIMABLE, NOT_ESTIMABLE, not_estimable
from hersey.identification.motion_kind import LONGEST_OF_LAP, NO_FREE_PERIOD
from hersey.identification.trace_units import in_unit, kind_of
from hersey.schema.warning import Warning

#: A fit is called poor if its mean cycle is off by more than this share of the drop (root mean square).
POOR = 0.05
#: Either, if known, makes of the slope of the force a measure of the drive speed.
_SCALES = {"stiffness", "mass"}
#: Kind of the warning that a held belt loads the spring by another stiffness.
_OTHER_STIFFNESS = "slope contradicts stiffness"
#: Noise explains a chi-square per point of less than this; known parameters are doubted if without them the
#: misfit is smaller than with them by this factor or more.
_BY_NOISE, _MUCH_BETTER = 2.0, 2.0
#: A misfit below this share of the drop is that of a sensor, not of a known parameter.
_LEAST_MISFIT = 5e-3


def warnings_of(
    record: CycleRecord,
    near: list[DriveFit],
    covariance: FloatArray,
    intervals: Mapping[str, Estimate],
    unit: str,
) -> tuple[Warning, ...]:
    """Return the warnings of the drives that fit alike, the best first.

    Parameters
    ----------
    covariance
        Of the best fit.
    intervals
        Of what can be estimated, by name.
    unit
        Unit of the trace, or empty.
    """
    best = near[0]
    return (
        *not_estimable(best.names[:-1], covariance[:-1, :-1]),
        *_lost(best, covariance, intervals),
        *_implausible(record, best, intervals),
        *_poor(best),
        *_contradiction(record, best, intervals, unit),
        *_undecided(near),
    )


def doubted(fit: DriveFit, warnings: tuple[Warning, ...]) -> list[str]:
    """Return the known parameters that may be why a fit misses the mean cycle by more than noise.

    A stiffness that the slope of the force contradicts is not among them: a warning says so, and that the
    drive speed may be wrong instead.
    """
    if fit.chi_square <= _BY_NOISE * fit.wave.offset.size or fit.misfit < _LEAST_MISFIT:
        return []
    said = {"stiffness"} if any(each.kind == _OTHER_STIFFNESS for each in warnings) else set()
    return [name for name in fit.known if name not in said]


def forced(
    fit: DriveFit, names: list[str], misfit: float, estimates: Mapping[str, Estimate], unit: str
) -> tuple[Warning, ...]:
    """Return a warning if known parameters keep a fit from the mean cycle.

    ``misfit`` and ``estimates`` are those of a fit in which nothing is known. Of the doubted ``names`` those
    are meant that lie outside their interval there, or if none does all that are known.
    """
    if not fit.misfit > _MUCH_BETTER * misfit:
        return ()
    known = fit.known
    outside = [n for n in names if n in estimates and not estimates[n].low <= known[n] <= estimates[n].high]
    named: list[str] = outside or (names if len(names) == len(known) else [])
    if not named:
        return ()
    values: dict[str, Any] = {}
    given, found = [], []
    for name in named:
        values[name] = known[name]
        label, kind = name.replace("_", " "), kind_of(name)
        given.append(f"{label} {in_unit(known[name], kind, unit, digits=3)}")
        if name in outside:
            ends = estimates[name].low, estimates[name].high
            values[f"{name}_low"], values[f"{name}_high"] = ends
            low, high = (in_unit(end, kind, unit, digits=3) for end in ends)
            found.append((f"{label} " if len(named) > 1 else "") + f"{low} to {high}")
    labels = ["mass (which includes the motor)" if n == "mass" else n.replace("_", " ") for n in named]
    checked = [*labels, *["drive speed"] * bool(_SCALES.intersection(named))]
    warning = Warning(
        "known parameters misfit",
        "with {given} the fit misses the trace by {misfit:.2f %} of the drop; without {these} by "
        "{free_misfit:.2f %}{found}",
        severity="act" if misfit < _LEAST_MISFIT else "watch",  # else the model misses the trace anyway
        remedy="check the {checked}",
        given=" and ".join(given),
        these="it" if len(known) == 1 else "what is known",
        found=f", at {' and '.join(found)}" if found else "",
        checked=" and the ".join(checked),
        misfit=fit.misfit,
        free_misfit=misfit,
        **values,
    )
    return (warning,)


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
    record: CycleRecord, best: DriveFit, intervals: Mapping[str, Estimate], unit: str
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
        yield _other_stiffness(best, held, fitted, unit)
    elif creep_is_free and abs(by_slope / fitted - 1.0) > unsure:
        yield _taken_for_creep(best, held, fitted, unit)


def _other_stiffness(best: DriveFit, held: HeldSlope, fitted: float, unit: str) -> Warning:
    agreed = held.slope / held.followed / fitted
    return Warning(
        _OTHER_STIFFNESS,
        "while it is held, the spring force rises by {rise}. At the drive speed of {speed} this means "
        "a stiffness of {measured}, but {other} is {source}; they would agree at a drive speed of {needed}",
        severity="watch",
        remedy="check the drive speed and the parameters given as known",
        agreed=agreed,
        needed=in_unit(agreed, "speed", unit),
        **_by_slope(best, held, fitted, unit),
    )


def _taken_for_creep(best: DriveFit, held: HeldSlope, fitted: float, unit: str) -> Warning:
    agreed = held.slope / fitted
    return Warning(
        "difference taken for creep",
        "while it is held, the spring force rises by {rise}. At the drive speed of {speed} this means "
        "a stiffness of {measured}, but {other} is {source}. The fit explains the difference by creep of the "
        "held part, {creep:.1%} of the drive speed; a drive speed of {needed} would explain it too",
        severity="watch",
        creep=1 - held.followed,
        agreed=agreed,
        needed=in_unit(agreed, "speed", unit),
        **_by_slope(best, held, fitted, unit),
    )


def _by_slope(best: DriveFit, held: HeldSlope, fitted: float, unit: str) -> dict[str, Any]:
    """The stiffness that the slope means and the other one, in SI, and as words show them."""
    by_slope = held.slope / best.drive_speed
    return {
        "slope": held.slope,
        "drive_speed": best.drive_speed,
        "by_slope": by_slope,
        "stiffness": fitted,
        "rise": in_unit(held.slope, "slope", unit),
        "speed": in_unit(best.drive_speed, "speed", unit),
        "measured": in_unit(by_slope, "stiffness", unit),
        "other": in_unit(fitted, "stiffness", unit),
        "source": "given" if "stiffness" in best.known else "fitted",
    }


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
