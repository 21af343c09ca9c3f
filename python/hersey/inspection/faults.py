"""What a channel shows of its sensor by itself: step, noise, refresh, and faults to know before a fit.

Every detector works on the numbers as written, so that steps and plateaus are exact. What honest channels
show in passing is not called a fault: a held set point is no plateau, a drive that stands no stuck sensor.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from hersey.arrays import FloatArray
from hersey.log.counters import quantisation_step
from hersey.log.neighbours import runs_of_true
from hersey.log.white_noise import MEDIAN_MAGNITUDE
from hersey.result import OPEN, Means, Record

IndexArray = NDArray[np.intp]

#: A sensor that is alive shows noise of at least this many of its steps; below, equal values prove nothing.
DITHER = 0.5
#: A channel whose neighbours are equal more often than this elsewhere is quiet by nature: held or coarse.
QUIET = 0.7
#: A constant stretch is a stuck sensor if it has this many rows and chance makes it this rarely in a log,
#: unless its value is held more often than so; at most so many are looked at.
STUCK_ROWS, STUCK_CHANCE, RECURRING, MOST_STRETCHES = 20, 1e-6, 2, 200
#: Clipped: two plateaus or more of at least so many rows at the extreme, so many rows in all, the extreme so
#: much more frequent than any value within so many times the noise from it.
PLATEAU_ROWS, CLIPPED_ROWS, CLIPPED_EXCESS, CLIPPED_NEAR = 3, 10, 5.0, 3.0
#: And elsewhere noise of so many steps (rounding alone makes 0.3) in at least this share of the rows.
CLIPPED_NOISE, UNCLIPPED = 1.0, 0.2
#: What stands shows less than this share of its greatest value.
STANDS = 0.005
#: Neighbours elsewhere are equal in at most this share of a channel whose plateaus mean something.
PLATEAU_QUIET = 0.2
#: A spike lies beyond 96 % of the values by so many times their range (a breakaway, or noise with heavy
#: tails, reaches two), alone or with one other row between ordinary ones; a value so many times as large as
#: all of them is no reading however long it lasts.
SPIKE, ABSURD = 3.0, 20.0
#: A channel that hardly ever changes has spikes only if they are fewer than this share of its rows.
FLAT_SHARE = 0.005
#: Zeros are drop-outs if fewer than this share of the rows, and so many rows on either side all keep this
#: share of their median, and so many of their standard deviations, away from zero.
DROPOUT_SHARE, BESIDE, DROPOUT_VOID, DROPOUT_JUMP = 0.2, 5, 0.5, 5.0
#: A sensor is refreshed more slowly than logged if its values are held for at least so many rows.
REFRESH_ROWS = 3


@dataclass(frozen=True)
class Fault(Record):
    """One kind of fault: rows concerned, the first of them (from 0), the value it stands at, and places."""

    kind: str
    rows: int
    first: int
    value: Annotated[float, OPEN]
    places: int = 1


@dataclass(frozen=True)
class Traits(Record):
    """What a channel looks like, in its own unit."""

    rows: int
    missing: int
    low: Annotated[float, OPEN]
    high: Annotated[float, OPEN]
    median: Annotated[float, OPEN]
    step: Annotated[float | None, Means("smallest step between readings; null if none is seen")]
    noise: Annotated[
        float | None, Means("standard deviation from row to row; null if constant or fewer than 8 readings")
    ]
    refresh: Annotated[int, Means("rows for which a reading is usually held; 1 if it changes every row")]
    faults: tuple[Fault, ...]


def traits(values: FloatArray, *, stands: bool = False) -> Traits:
    """Return step, noise and faults of a channel, NaN where a value is missing.

    ``stands`` says that zero is a state in which the quantity may stay for long, as a speed does.
    """
    known = np.flatnonzero(np.isfinite(values))
    readings = values[known]
    missing = values.size - readings.size
    if readings.size < 2:
        level = float(readings[0]) if readings.size else float("nan")
        return Traits(values.size, missing, level, level, level, None, None, 1, ())
    low, high, median = float(readings.min()), float(readings.max()), float(np.median(readings))
    if low == high:
        fault = Fault("constant", readings.size, int(known[0]), low)
        return Traits(values.size, missing, low, high, median, None, None, 1, (fault,))
    starts, lengths = equal_runs(readings)
    refresh = _refresh(starts, lengths)
    alive = readings[starts] if refresh > 1 else readings
    step = quantisation_step(readings)
    noise = noise_of(alive)
    lost = dropouts(readings, stands=stands)
    among_known = [
        *lost,
        *spikes(np.where(readings == 0.0, median, readings) if lost else readings),
        *clipping(readings, step, stands=stands),
        *([] if refresh > 1 else stuck(readings, step, stands=stands)),
    ]
    faults = tuple(Fault(f.kind, f.rows, int(known[f.first]), f.value, f.places) for f in among_known)
    return Traits(values.size, missing, low, high, median, step, noise, refresh, faults)


def equal_runs(values: FloatArray) -> tuple[IndexArray, IndexArray]:
    """Return where each run of equal neighbours starts, and its length."""
    starts = np.concatenate([[0], np.flatnonzero(np.diff(values)) + 1])
    return starts, np.diff(starts, append=values.size)


def noise_of(values: FloatArray) -> float | None:
    """Return the standard deviation of what changes from row to row, robustly; None for fewer than 8 rows.

    Trends and slow waves cancel in second differences; noise that is correlated over several rows shows less
    of itself.
    """
    if values.size < 8:
        return None
    second = values[2:] - 2.0 * values[1:-1] + values[:-2]
    middle = float(np.median(np.abs(second - np.median(second))))
    return middle / MEDIAN_MAGNITUDE / float(np.sqrt(6.0))


def spikes(values: FloatArray) -> list[Fault]:
    """Return isolated values far outside the rest."""
    low, high = (float(v) for v in np.quantile(values, [0.02, 0.98]))
    span = high - low
    out = (values < low - SPIKE * span) | (values > high + SPIKE * span)
    if not out.any() or (span == 0.0 and np.mean(out) > FLAT_SHARE):
        return []
    inside = np.pad(~out, 2, constant_values=False)
    single = [
        np.arange(start, end)
        for start, end in runs_of_true(out)
        if end - start <= 2 and inside[[start, start + 1, end + 2, end + 3]].all()
    ]
    rows = np.concatenate([np.empty(0, dtype=np.intp), *single])
    far = ABSURD * max(span, abs(low), abs(high))
    absurd = np.flatnonzero(np.abs(values) > far) if far > 0 else rows
    rows = np.union1d(rows, absurd).astype(np.intp)
    if not rows.size:
        return []
    worst = int(rows[np.argmax(np.abs(values[rows] - np.median(values)))])
    places = 1 + int(np.count_nonzero(np.diff(rows) > 1))
    return [Fault("spikes", rows.size, int(rows[0]), float(values[worst]), places)]


def dropouts(values: FloatArray, *, stands: bool = False) -> list[Fault]:
    """Return zeros between values far from zero, or at an end of a channel that never comes near it."""
    zero = values == 0.0
    if not 0 < np.count_nonzero(zero) < DROPOUT_SHARE * values.size:
        return []
    others = np.abs(values[~zero])
    never = not stands and float(np.quantile(others, 0.002)) > DROPOUT_VOID * float(np.median(others))
    lost = []
    for first, end in runs_of_true(zero):
        rows = end - first
        before, after = values[max(0, first - BESIDE) : first], values[end : end + BESIDE]
        if not before.size or not after.size:
            abrupt = never and rows > 1  # one row alone is a sensor that was not read yet
        else:
            beside = np.concatenate([before, after])
            level = float(np.median(beside))
            kept = np.min(beside / level) if level else 0.0
            abrupt = kept > DROPOUT_VOID and abs(level) > DROPOUT_JUMP * float(np.std(beside))
            abrupt &= not stands or rows <= BESIDE
        if abrupt:
            lost.append((first, rows))
    if not lost:
        return []
    return [Fault("drop-outs", sum(rows for _, rows in lost), lost[0][0], 0.0, len(lost))]


def clipping(values: FloatArray, step: float | None, *, stands: bool = False) -> list[Fault]:
    """Return plateaus at the greatest and least value of a channel that is noisy elsewhere."""
    starts, lengths = equal_runs(values)
    levels, counts = np.unique(values, return_counts=True)
    plateaus = []
    standing = STANDS * float(np.max(np.abs(values)))
    for limit in (float(values.max()), float(values.min())):
        if stands and abs(limit) <= standing:
            continue
        flat = (values[starts] == limit) & (lengths >= PLATEAU_ROWS)
        rows = int(lengths[flat].sum())
        away = (values != values.max()) & (values != values.min())
        noise = noise_of(values[away]) or 0.0
        beside = (levels != limit) & (np.abs(levels - limit) <= CLIPPED_NEAR * noise)
        usual = int(counts[beside].max(initial=1))
        few = np.count_nonzero(flat) < 2 or rows < max(CLIPPED_ROWS, CLIPPED_EXCESS * usual)
        if few or np.mean(away) < UNCLIPPED:
            continue
        pairs = away[1:] & away[:-1]
        same = int(np.count_nonzero((values[1:] == values[:-1]) & pairs))
        equal = same / max(1, int(np.count_nonzero(pairs)))
        least = CLIPPED_NOISE * step if step else 1e-9 * float(np.ptp(values))
        if equal <= PLATEAU_QUIET and noise > least:
            kind = "clipped above" if limit == values.max() else "clipped below"
            plateaus.append(Fault(kind, rows, int(starts[flat][0]), limit, int(np.count_nonzero(flat))))
    return plateaus


def stuck(values: FloatArray, step: float | None, *, stands: bool = False) -> list[Fault]:
    """Return stretches in which a channel that is noisy beside them keeps one value too long for chance.

    A value that is held so again and again is a limit or a set point, no stuck sensor.
    """
    starts, lengths = equal_runs(values)
    held = values[starts]
    idle = stands & (np.abs(held) <= STANDS * float(np.max(np.abs(values))))
    candidates = np.flatnonzero((lengths >= STUCK_ROWS) & ~idle)
    clipped = {fault.value for fault in clipping(values, step, stands=stands)}
    stretches = []
    for run in candidates[np.argsort(-lengths[candidates])][:MOST_STRETCHES]:
        first, last = int(starts[run]), int(starts[run] + lengths[run])
        again = np.count_nonzero(held[candidates] == held[run])
        if again > RECURRING or float(held[run]) in clipped:
            continue
        rows_beside = max(10 * STUCK_ROWS, int(lengths[run]))
        beside = np.concatenate(
            [values[max(0, first - rows_beside) : first], values[last : last + rows_beside]]
        )
        noise = noise_of(beside)
        if noise is None or noise <= max(DITHER * (step or 0.0), 1e-9 * float(np.ptp(values))):
            continue
        same = float(np.mean(np.diff(beside) == 0.0))
        likely = max(same, 1.0 / values.size)
        if same <= QUIET and lengths[run] >= np.log(values.size / STUCK_CHANCE) / -np.log(likely):
            stretches.append((first, int(lengths[run])))
    if not stretches:
        return []
    first = min(stretches)[0]
    return [Fault("stuck", sum(rows for _, rows in stretches), first, float(values[first]), len(stretches))]


def _refresh(starts: IndexArray, lengths: IndexArray) -> int:
    """Rows for which a value is usually held before the sensor gives the next, 1 if it does so every row."""
    if starts.size < 20:
        return 1
    usual = int(np.median(lengths))
    regular = np.mean(np.abs(lengths - usual) <= max(1, 0.1 * usual))
    return usual if usual >= REFRESH_ROWS and regular > 0.8 else 1
