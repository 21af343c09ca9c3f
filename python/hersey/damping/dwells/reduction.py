"""From a log to its dwells, and from each to a steady point."""

from __future__ import annotations

import numpy as np
import polars as pl

from hersey.damping.dwells.groups import MIN_SAMPLES
from hersey.damping.dwells.noise import mean_and_error
from hersey.damping.dwells.points import Rejection, SteadyPoints
from hersey.damping.dwells.segments import Segment, segments_of
from hersey.damping.dwells.settling import settled
from hersey.damping.dwells.steadiness import drift_over, unsteady
from hersey.errors import InsufficientDataError, ParameterError
from hersey.log.torque_log import Run, TorqueLog

#: Where a dwell that drifts is tried again, as shares of it cut from its start.
LATER_STARTS = (0.3, 0.5, 0.65, 0.8, 0.9)


def steady_points(
    log: TorqueLog, *, min_dwell: float = 2.0, tare: str = "none", rotation: str = "both"
) -> SteadyPoints:
    """Find the dwells of a log and reduce each to a steady point.

    Parameters
    ----------
    min_dwell
        Shortest dwell, s, after its settling is cut.
    tare
        ``none``, or ``standing`` to subtract the mean torque of the stretches where the drive stands.
    rotation
        ``both``, or only ``forward`` (positive speed) or ``reverse`` dwells.

    Raises
    ------
    InsufficientDataError
        If no dwell is found, or there is no standing stretch to tare with.
    """
    if tare not in ("none", "standing"):
        raise ParameterError(f"tare '{tare}' is not known: none or standing")
    if rotation not in ("both", "forward", "reverse"):
        raise ParameterError(f"rotation '{rotation}' is not known: both, forward or reverse")
    if not 0 < min_dwell < float("inf"):
        raise ParameterError(f"min_dwell is {min_dwell:g} s: it must be greater than 0")
    if log.rows < MIN_SAMPLES:
        raise InsufficientDataError(
            f"{log.files[0].name} has {log.rows} rows; one dwell alone needs {MIN_SAMPLES}"
        )
    segments = [segments_of(run) for run in log.runs]
    standing = _standing_torque(log, segments)
    if tare == "standing" and standing is None:
        raise InsufficientDataError("the drive never stands still for 2 s: there is no torque to tare with")
    offset, offset_error = standing if tare == "standing" and standing is not None else (0.0, 0.0)
    rows: list[dict[str, object]] = []
    rejected: list[Rejection] = []
    for index, (run, run_segments) in enumerate(zip(log.runs, segments, strict=True)):
        previous: float | None = None
        for segment in run_segments:
            result = _reduce(run, index, segment, previous, offset, min_dwell, rotation)
            if isinstance(result, Rejection):
                rejected.append(result)
            else:
                rows.append(result)
            if segment.steady:
                previous = abs(segment.speed)
    if not rows:
        raise InsufficientDataError(_nothing_steady(log, rejected, min_dwell))
    table = pl.DataFrame(rows, schema_overrides={"temperature": pl.Float64, "temperature_error": pl.Float64})
    standing_torque = None if standing is None else standing[0]
    return SteadyPoints(table, tuple(rejected), offset, standing_torque, log, offset_error)


def _standing_torque(log: TorqueLog, segments: list[list[Segment]]) -> tuple[float, float] | None:
    """Mean torque while the drive stands, and its standard error, N m."""
    parts = []
    for run, run_segments in zip(log.runs, segments, strict=True):
        for s in run_segments:
            if s.standing and s.steady:
                trim = (s.end - s.start) // 10
                parts.append(run.torque[s.start + trim : s.end - trim])
    if not parts:
        return None
    mean, error, _ = mean_and_error(np.concatenate(parts))
    return mean, error


def _reduce(
    run: Run,
    index: int,
    segment: Segment,
    previous: float | None,
    tare: float,
    min_dwell: float,
    rotation: str,
) -> dict[str, object] | Rejection:
    def reject(reason: str) -> Rejection:
        start, end = float(run.time[segment.start]), float(run.time[segment.end - 1])
        return Rejection(index, start, end, segment.end - segment.start, reason)

    if not segment.steady:
        few = segment.end - segment.start < MIN_SAMPLES
        return reject(
            f"speed changing, or held for fewer than {MIN_SAMPLES} rows" if few else "speed changing"
        )
    if segment.standing:
        return reject("drive standing")
    if rotation != "both" and (segment.speed > 0) != (rotation == "forward"):
        return reject(f"rotation not {rotation}, as asked")
    start, end = settled(run, segment)
    reason = unsteady(run, start, end, min_dwell, tare)
    for share in LATER_STARTS:  # a warm-up at the same speed may come before what is steady
        later = start + round(share * (end - start))
        if (
            reason
            and reason.startswith(("temperature drifts", "torque drifts"))
            and unsteady(run, later, end, min_dwell, tare) is None
        ):
            start, reason = later, None
    if reason:
        return reject(reason)
    speed, torque = run.speed[start:end], run.torque[start:end] - tare
    temperature = None if run.temperature is None else run.temperature[start:end]
    torque_mean, torque_error, independent = mean_and_error(torque)
    # a drift small enough to be kept is still one: its own deviation about the mean is added
    torque_error = float(np.hypot(torque_error, drift_over(run.time[start:end], torque)[0] / np.sqrt(12.0)))
    speed_mean, speed_error, _ = mean_and_error(speed)
    if torque_mean * speed_mean <= 0:
        return reject("torque and speed have opposite signs: turn one with --torque-unit '-1 N*m'")
    hot = mean_and_error(temperature) if temperature is not None else (None, None)
    approach = "start"
    if previous is not None:
        approach = "from below" if previous < abs(speed_mean) else "from above"
    return {
        "run": index,
        "start": float(run.time[start]),
        "end": float(run.time[end - 1]),
        "speed": speed_mean,
        "speed_error": speed_error,
        "torque": torque_mean,
        "torque_error": torque_error,
        "temperature": hot[0],
        "temperature_error": hot[1],
        "rows": end - start,
        "effective_rows": independent,
        "settling_rows": (segment.end - segment.start) - (end - start),
        "approach": approach,
    }


def _nothing_steady(log: TorqueLog, rejected: list[Rejection], min_dwell: float) -> str:
    reasons: dict[str, int] = {}
    for r in rejected:
        kind = r.reason if "opposite signs" in r.reason else r.reason.split(":")[0].split(" by ")[0]
        reasons[kind] = reasons.get(kind, 0) + 1
    listed = ", ".join(f"{count} x {reason}" for reason, count in reasons.items())
    name = log.files[0].name + (f" and {len(log.files) - 1} more" if len(log.files) > 1 else "")
    return f"{name}: no steady stretch ({listed}); a dwell holds one speed for at least {min_dwell:g} s"
