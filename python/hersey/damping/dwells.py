"""Dwells: stretches of constant speed, reduced to one steady point each, with honest standard errors.

The settling at the start of a dwell is cut by the marginal standard error rule (White, Simulation 69
(1997) 323): drop as many samples as makes the standard error of the rest least. Standard errors allow for
autocorrelation through the integrated autocorrelation time with Sokal's window.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray
from scipy.ndimage import percentile_filter

from hersey.arrays import FloatArray
from hersey.errors import InsufficientDataError, ParameterError
from hersey.log.torque_log import STANDING, Run, TorqueLog
from hersey.result import Result, json_record
from hersey.units import rpm

#: Length of the blocks in which speed is judged, s, and how many a run may have at most.
BLOCK_DURATION, MAX_BLOCKS = 0.2, 200_000
#: Speed may stray from the mean of a dwell by this share, or by this many standard deviations of a block.
SPEED_TOLERANCE, SPEED_NOISE = 0.05, 4.0
#: An excursion of the speed shorter than this, s, does not end a dwell.
MAX_EXCURSION = 1.0
#: Fewest samples of a dwell.
MIN_SAMPLES = 20
#: Largest drifts within a dwell: of temperature in K; of speed and torque as a share; of torque also in
#: standard deviations of what fluctuates about the drift (a turning shaft makes slow waves of its own).
MAX_TEMPERATURE_DRIFT, MAX_SPEED_DRIFT, MAX_TORQUE_DRIFT, MAX_DRIFT_TO_NOISE = 2.0, 0.01, 0.03, 2.0
#: Largest standard deviation within a dwell as a share of the mean, of torque and of speed.
MAX_TORQUE_SWING, MAX_SPEED_SWING = 0.35, 0.2
#: Stick-slip: torque swings by more than this, and its changes are this skewed (slow rises, sudden drops).
STICK_SLIP_SWING, STICK_SLIP_SKEWNESS = 0.05, -3.0
#: Where a dwell that drifts is tried again, as shares of it cut from its start.
LATER_STARTS = (0.3, 0.5, 0.65, 0.8, 0.9)
#: Samples to which a dwell is averaged before its drift and autocorrelation are computed.
THINNED = 10_000
#: Speeds closer than this share count as the same.
SAME_SPEED = 0.03
#: Drift counts as real beyond this many standard errors.
SIGNIFICANT = 3.0


@dataclass(frozen=True)
class Rejection:
    """A stretch of the log that is not used, and why; times in s, first row from 0 within the run."""

    run: int
    start: float
    end: float
    rows: int
    reason: str


@dataclass(frozen=True, repr=False)
class SteadyPoints(Result):
    """One row per dwell.

    Attributes
    ----------
    table
        Columns ``run`` (index), ``start``, ``end`` (s), ``speed``, ``speed_error`` (rad/s), ``torque``,
        ``torque_error`` (N m), ``temperature``, ``temperature_error`` (K, null if not recorded), ``rows``,
        ``effective_rows`` (independent samples), ``settling_rows`` (cut at the ends), ``approach``
        (``from below``, ``from above`` or ``start``). Errors are standard errors of the mean. Speed and
        torque carry the sign of the rotation.
    rejected
        Every other stretch, with the reason. Rows of the table and of this list add up to the log's.
    tare, tare_error
        Torque subtracted from every sample, and its standard error, N m.
    standing_torque
        Mean torque while the drive stood, N m, or None if it never did.
    log
        What was reduced.
    """

    table: pl.DataFrame
    rejected: tuple[Rejection, ...]
    tare: float
    standing_torque: float | None
    log: TorqueLog
    tare_error: float = 0.0

    @property
    def tare_errors(self) -> FloatArray:
        """What one standard error of each error of the zero does to torque, N m, shape (points, errors)."""
        return np.full((len(self), 1), self.tare_error) if self.tare_error else np.empty((len(self), 0))

    def __len__(self) -> int:
        """Return how many steady points there are."""
        return self.table.height

    def column(self, name: str) -> FloatArray:
        """Return a column as an array of shape (points,)."""
        return self.table[name].to_numpy()

    def summary(self) -> str:
        """Return how many dwells, their ranges, the tare, and what is not used, as text."""
        rows = f"{self.table['rows'].sum()} of {self.log.rows} rows used"
        lines = [f"{self.headline()}; {rows}", f"tare {self.tare:.4g} N m"]
        if self.standing_torque is not None:
            lines[-1] += f", standing torque {self.standing_torque:.4g} N m"
        lines += [f"  not used: {rows} rows, {why}" for why, rows in self._unused().items()]
        return "\n".join(lines)

    def headline(self) -> str:
        """Return how many dwells, and the ranges of speed and torque."""
        speed, torque = np.abs(self.column("speed")), np.abs(self.column("torque"))
        return (
            f"{len(self)} dwells, {rpm(float(speed.min())):.4g} to {rpm(float(speed.max())):.4g} rpm, "
            f"{torque.min():.4g} to {torque.max():.4g} N m"
        )

    def _unused(self) -> dict[str, int]:
        """Rows of every other stretch by its reason."""
        rows: dict[str, int] = {}
        for stretch in self.rejected:
            rows[stretch.reason] = rows.get(stretch.reason, 0) + stretch.rows
        return rows

    def to_dict(self) -> dict[str, Any]:
        """Return the dwells, what is not used, and the tare, in SI."""
        return json_record(
            {
                "points": self.table.to_dicts(),
                "rejected": self.rejected,
                "tare": self.tare,
                "tare_error": self.tare_error,
                "standing_torque": self.standing_torque,
            }
        )

    def to_frame(self) -> pl.DataFrame:
        """Return one row per dwell."""
        units = {"start": "s", "end": "s", "speed": "rad/s", "torque": "N m", "temperature": "K"}
        units |= {f"{name}_error": units[name] for name in ("speed", "torque", "temperature")}
        return self.table.rename({name: f"{name.replace('_', ' ')} ({unit})" for name, unit in units.items()})


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
    segments = [_segments(run) for run in log.runs]
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


@dataclass(frozen=True)
class _Segment:
    """Rows [start, end) of a run; ``steady`` if the speed holds, ``speed`` its mean."""

    start: int
    end: int
    speed: float
    steady: bool
    standing: bool


def _segments(run: Run) -> list[_Segment]:
    """Cut a run where the speed changes, judged on block means against the noise about them."""
    rows = run.time.size
    duration = float(run.time[-1] - run.time[0])
    per_second = rows / duration if duration > 0 else rows
    block = max(1, round(per_second * BLOCK_DURATION), -(-rows // MAX_BLOCKS))
    starts = np.arange(0, rows, block)
    counts = np.diff(starts, append=rows)
    means = np.add.reduceat(run.speed, starts) / counts
    noise = _local_noise(means)
    cuts = [0]
    total, count = means[0], 1
    for i in range(1, means.size):
        mean = total / count
        if abs(means[i] - mean) <= max(SPEED_TOLERANCE * abs(mean), SPEED_NOISE * noise[i], STANDING):
            total, count = total + means[i], count + 1
        else:
            cuts.append(i)
            total, count = means[i], 1
    segments = []
    for first, last in zip(cuts, [*cuts[1:], means.size], strict=True):
        start, end = int(starts[first]), int(starts[last - 1] + counts[last - 1])
        speed = float(np.mean(run.speed[start:end]))
        long = run.time[end - 1] - run.time[start] >= 5 * BLOCK_DURATION and end - start >= MIN_SAMPLES
        chance = 3.0 * float(np.median(noise[first:last])) / (last - first) ** 0.5
        still = abs(speed) <= max(STANDING, chance)
        segments.append(_Segment(start, end, speed, bool(long), still))
    return _joined(run, _surely_standing(segments))


def _local_noise(means: FloatArray) -> FloatArray:
    """Standard deviation of block means about the speed held, near each block.

    Three quarters of the changes between neighbours are noise: 1.627 turns that quantile into a deviation.
    """
    changes = np.abs(np.diff(means, prepend=means[:1]))
    return np.asarray(percentile_filter(changes, 75, size=min(25, changes.size)) / 1.627)


def _surely_standing(segments: list[_Segment]) -> list[_Segment]:
    """A drive stands only if it is far slower than wherever it surely moves."""
    moving = [abs(s.speed) for s in segments if s.steady and not s.standing]
    slowest = min(moving, default=np.inf)
    return [replace(s, standing=s.standing and abs(s.speed) <= 0.05 * slowest) for s in segments]


def _joined(run: Run, segments: list[_Segment]) -> list[_Segment]:
    """Join pieces of changing speed into one stretch, and dwells that only an excursion parts."""
    joined: list[_Segment] = []
    for segment in segments:
        joined.append(segment)
        while len(joined) > 1 and not joined[-1].steady and not joined[-2].steady:
            last = joined.pop()
            joined[-1] = replace(joined[-1], end=last.end)
        if not segment.steady:
            continue
        for apart in (2, 3):
            if len(joined) >= apart and _same_dwell(run, joined[-apart], segment):
                first = joined[-apart]
                speed = float(np.mean(run.speed[first.start : segment.end]))
                joined[-apart:] = [replace(first, end=segment.end, speed=speed)]
                break
    return joined


def _same_dwell(run: Run, before: _Segment, after: _Segment) -> bool:
    apart = run.time[after.start] - run.time[before.end - 1]
    strayed = abs(after.speed - before.speed)
    near = strayed <= SPEED_TOLERANCE * max(abs(before.speed), abs(after.speed))
    return before.steady and apart <= MAX_EXCURSION and (near or (before.standing and after.standing))


def _standing_torque(log: TorqueLog, segments: list[list[_Segment]]) -> tuple[float, float] | None:
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
    segment: _Segment,
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
    start, end = _settled(run, segment)
    reason = _unsteady(run, start, end, min_dwell, tare)
    for share in LATER_STARTS:  # a warm-up at the same speed may come before what is steady
        later = start + round(share * (end - start))
        if (
            reason
            and reason.startswith(("temperature drifts", "torque drifts"))
            and _unsteady(run, later, end, min_dwell, tare) is None
        ):
            start, reason = later, None
    if reason:
        return reject(reason)
    speed, torque = run.speed[start:end], run.torque[start:end] - tare
    temperature = None if run.temperature is None else run.temperature[start:end]
    torque_mean, torque_error, independent = mean_and_error(torque)
    # a drift small enough to be kept is still one: its own deviation about the mean is added
    torque_error = float(np.hypot(torque_error, _drift(run.time[start:end], torque)[0] / np.sqrt(12.0)))
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


def _settled(run: Run, segment: _Segment) -> tuple[int, int]:
    """Rows of the dwell without its edges and its settling."""
    rows = segment.end - segment.start
    size = max(1, rows // 200)
    count = rows // size
    blocks = slice(segment.start, segment.start + count * size)
    # the first and last block of a dwell may hold the end of a ramp, a slow ramp many more
    edge = -(-round(BLOCK_DURATION / run.sampling_interval) // size) if count > 20 else 0
    held = run.speed[blocks].reshape(count, size).mean(axis=1)
    noise = float(np.median(np.abs(np.diff(held)))) if count > 1 else 0.0
    away = np.abs(held - np.median(held))
    near = np.flatnonzero(away <= max(MAX_SPEED_DRIFT * abs(segment.speed), SPEED_NOISE * noise))
    first, last = (int(near[0]), count - 1 - int(near[-1])) if near.size else (0, 0)
    first, last = max(first, edge), max(last, edge)
    cut = first
    for channel in (run.torque, run.temperature):
        if channel is not None:
            means = channel[blocks].reshape(count, size).mean(axis=1)[first : count - last]
            cut = max(cut, first + _settling_blocks(means))
    return segment.start + cut * size, segment.end - last * size


def _settling_blocks(means: FloatArray) -> int:
    """Blocks to drop by the marginal standard error rule, at most half; none if that gains little."""
    count = means.size
    if count < 8:
        return 0
    left = np.arange(count, 0, -1)
    centred = means - means.mean()
    total = np.cumsum(centred[::-1])[::-1] / left
    square = np.cumsum(centred[::-1] ** 2)[::-1] / left
    error = np.sqrt(np.maximum(square - total**2, 0.0) / left)[: count // 2]
    best = int(np.argmin(error))
    return best if error[best] < 0.8 * error[0] else 0


def _unsteady(run: Run, start: int, end: int, min_dwell: float, tare: float) -> str | None:
    """Why rows [start, end) are not a steady dwell, or None."""
    time, speed, torque = run.time[start:end], run.speed[start:end], run.torque[start:end] - tare
    if end - start < MIN_SAMPLES or time[-1] - time[0] < min_dwell:
        lasted = float(time[-1] - time[0]) if end > start else 0.0
        return (
            f"dwell too short: {lasted:.1f} s or {end - start} rows are settled, "
            f"{min_dwell:g} s and {MIN_SAMPLES} rows are needed"
        )
    if np.mean(torque) == 0.0:
        return "torque is zero: is the sensor connected?"
    temperature = None if run.temperature is None else run.temperature[start:end]
    if np.std(speed) > MAX_SPEED_SWING * abs(np.mean(speed)):
        return f"speed not held: it varies by {np.std(speed) / abs(np.mean(speed)):.0%} (standard deviation)"
    swing = float(np.std(torque)) / abs(float(np.mean(torque)))
    if swing > STICK_SLIP_SWING and _skewness_of_changes(torque) < STICK_SLIP_SKEWNESS:
        return (
            f"stick-slip: torque swings by {swing:.0%} (standard deviation), rising slowly and dropping fast"
        )
    if swing > MAX_TORQUE_SWING:
        return f"torque swings by {swing:.0%} (standard deviation): no steady sliding"
    drift, _ = _drift(time, speed)
    if abs(drift) > MAX_SPEED_DRIFT * abs(float(np.mean(speed))):
        return f"speed drifts by {drift / float(np.mean(speed)):+.1%} over the dwell"
    drift, _ = _drift(time, temperature) if temperature is not None else (0.0, 0.0)
    if abs(drift) > MAX_TEMPERATURE_DRIFT:
        return f"temperature drifts by {drift:+.1f} K over the dwell"
    drift, noise = _drift(time, torque)
    if abs(drift) > max(MAX_TORQUE_DRIFT * abs(float(np.mean(torque))), MAX_DRIFT_TO_NOISE * noise):
        return f"torque drifts by {drift / float(np.mean(torque)):+.1%} over the dwell"
    return None


def _skewness_of_changes(torque: FloatArray) -> float:
    """Least skewness of the changes of torque (taken positive) from block to block, over block lengths."""
    load = torque * np.sign(torque.mean())
    least = 0.0
    for blocks in (100, 400, 1600):
        size = max(1, load.size // blocks)
        changes = np.diff(load[: load.size // size * size].reshape(-1, size).mean(axis=1))
        deviation = float(np.std(changes))
        if deviation > 0:
            least = min(least, float(np.mean((changes - changes.mean()) ** 3)) / deviation**3)
    return least


def _drift(time: FloatArray, values: FloatArray) -> tuple[float, float]:
    """Change along a straight line over the dwell, 0 if within chance, and the deviation about the line."""
    time, values = _thinned(time), _thinned(values)
    t = time - time.mean()
    spread = float(np.sum(t * t))
    if spread == 0.0:
        return 0.0, 0.0
    slope = float(np.sum(t * values)) / spread
    residual = values - values.mean() - slope * t
    error = mean_and_error(residual)[1] * np.sqrt(12.0)  # of a line's rise, uniform times
    rise = slope * float(time[-1] - time[0])
    return (rise if abs(rise) > SIGNIFICANT * error else 0.0), float(np.std(residual))


def _thinned(values: FloatArray) -> FloatArray:
    """Means over blocks, so many that a dwell has at most about `THINNED` of them."""
    size = max(1, values.size // THINNED)
    return np.asarray(values[: values.size // size * size].reshape(-1, size).mean(axis=1))


def mean_and_error(values: FloatArray) -> tuple[float, float, float]:
    """Return mean, standard error of the mean and number of independent samples of a stationary series.

    The integrated autocorrelation time is summed up to the first lag of five times itself (Sokal).
    """
    series = _thinned(values)
    count = series.size
    centred = series - series.mean()
    variance = float(np.sum(centred * centred)) / max(count - 1, 1)
    if variance <= 1e-30 * float(np.mean(values)) ** 2:
        return float(np.mean(values)), 0.0, float(count)
    length = 1 << (2 * count - 1).bit_length()
    spectrum = np.fft.rfft(centred, length)
    correlation = np.fft.irfft(np.abs(spectrum) ** 2, length)[:count]
    times = 2.0 * np.cumsum(correlation / correlation[0]) - 1.0
    window = int(np.argmax(np.arange(count) >= 5.0 * np.maximum(times, 1.0)))
    # a finite series underestimates: Wolff, Comput. Phys. Commun. 156 (2004) 143, and its variance too
    time = min(max(1.0, float(times[window])) * (1.0 + (2.0 * window + 1.0) / count), count / 2)
    error = float(np.sqrt(variance * time / (count - time)))
    return float(np.mean(values)), error, count / time


def _nothing_steady(log: TorqueLog, rejected: list[Rejection], min_dwell: float) -> str:
    reasons: dict[str, int] = {}
    for r in rejected:
        kind = r.reason if "opposite signs" in r.reason else r.reason.split(":")[0].split(" by ")[0]
        reasons[kind] = reasons.get(kind, 0) + 1
    listed = ", ".join(f"{count} x {reason}" for reason, count in reasons.items())
    name = log.files[0].name + (f" and {len(log.files) - 1} more" if len(log.files) > 1 else "")
    return f"{name}: no steady stretch ({listed}); a dwell holds one speed for at least {min_dwell:g} s"


def groups_of_temperature(temperature: FloatArray, width: float = 6.0) -> Iterator[NDArray[np.intp]]:
    """Yield the indices of points that share a temperature, coldest first.

    Neighbours in sorted order belong together while the whole group spans no more than ``width`` K.
    """
    order = np.argsort(temperature, kind="stable")
    start = 0
    for i in range(1, order.size + 1):
        if i == order.size or temperature[order[i]] - temperature[order[start]] > width:
            yield order[start:i]
            start = i


def distinct_speeds(speed: FloatArray) -> int:
    """Return how many different speeds there are, to `SAME_SPEED`."""
    ordered = np.sort(speed)
    return int(1 + np.count_nonzero(np.diff(np.log(ordered)) > SAME_SPEED)) if ordered.size else 0
