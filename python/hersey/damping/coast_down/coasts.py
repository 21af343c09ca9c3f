"""The coasts of a log: where speed falls freely, and what else the log holds.

A stretch in which speed falls from a high to a low is looked at in parts. Friction of the three terms never
slows a wheel more when it is slower, so a deceleration that rises as speed falls is a brake, or the end of a
part in which the drive still pulled.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Literal

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.coast_down.steps import steps_in
from hersey.log.counters import step_of_levels
from hersey.log.torque_log import STANDING, Run
from hersey.log.white_noise import BEND_OF_NOISE
from hersey.result import Means, Record

#: Why a stretch of a log is no coast.
Why = Literal["standing", "rising", "held", "stepped", "braking", "driven", "reversed", "ends", "short"]
#: Rows to which a run is averaged before coasts are looked for.
_LOOKED_AT = 20_000
#: Standard deviations of the noise that a fall must exceed, and share of the highest speed.
_FALL, _SHARE = 10.0, 0.05
#: Share of a fall, and standard deviations, that are left out where the drive lets go or takes hold.
_EDGE, _EDGE_NOISE = 0.02, 4.0
#: Rows of a coast at the least.
FEWEST_ROWS = 20
#: As many steps of a fall are a staircase, whose last step may be cut short.
_STAIRCASE = 2
#: Parts of a coast whose decelerations are compared, and rows of each at the least.
_PARTS, _FEWEST_PER_PART = 40, 12
#: A deceleration that is so many times that of a faster part, beyond so many of its errors, is no friction.
_RISES, _SURELY = 1.25, 6.0
#: A part below this share of the one before it begins suddenly.
_SUDDEN = 0.6
#: Neighbouring parts whose scatter counts: that of a ripple grows as the wheel slows.
_NEAR = 9


@dataclass(frozen=True)
class Coast(Record):
    """One coast: rows of a run in which speed falls freely, of shape (rows,); speed is without its sign."""

    not_stated = ("time", "speed")
    also_stated = ("rows", "fastest", "slowest")

    run: Annotated[int, Means("run of the log, from 0")]
    start: Annotated[float, Means("first time", "s")]
    end: Annotated[float, Means("last time", "s")]
    forward: Annotated[bool, Means("whether the wheel turned forward")]
    stops: Annotated[bool, Means("whether the wheel came to rest at the end")]
    time: FloatArray
    speed: FloatArray

    @property
    def rows(self) -> Annotated[int, Means("rows used")]:
        """Number of rows."""
        return int(self.time.size)

    @property
    def fastest(self) -> Annotated[float, Means("highest speed", "rad/s")]:
        """Speed at the beginning."""
        return float(self.speed[: max(1, self.rows // 50)].mean())

    @property
    def slowest(self) -> Annotated[float, Means("lowest speed", "rad/s")]:
        """Speed at the end."""
        return float(self.speed[-max(1, self.rows // 50) :].mean())


@dataclass(frozen=True)
class LeftOut(Record):
    """A stretch of the log that is no coast, and why: ``braking``, ``held`` and so on."""

    run: Annotated[int, Means("run of the log, from 0")]
    start: Annotated[float, Means("first time", "s")]
    end: Annotated[float, Means("last time", "s")]
    rows: Annotated[int, Means("rows")]
    why: Annotated[Why, Means("what the stretch is")]


def coasts_in(run: Run, index: int) -> tuple[list[Coast], list[LeftOut]]:
    """Return the coasts of a run, and the stretches between them, which together are all its rows."""
    size = rows_averaged(run)
    time, signed = (_means(values, size) for values in (run.time, run.speed))
    speed = np.abs(signed)
    noise = noise_of_rows(signed)
    found: list[tuple[int, int, bool]] = []
    why = np.full(speed.size, "held", dtype="<U8")
    why[speed <= max(STANDING, _EDGE_NOISE * noise)] = "standing"
    least = max(_FALL * noise, _SHARE * float(speed.max()))
    for top, bottom in _falls(speed, least):
        why[top:bottom] = "ends"
        if _turns(signed, top, bottom, noise):
            why[top:bottom] = "reversed"
            continue
        top = _below_steps(time, speed, top, bottom, noise, why)
        if top >= bottom:
            continue
        first, last, stops = _trimmed(speed, top, bottom, noise)
        for start, end in _free(time, speed, first, last, noise, why):
            if end - start < FEWEST_ROWS:
                why[start:end] = "short"
                continue
            if speed[start] - speed[end - 1] < least:
                why[start:end] = "held"
                continue
            found.append((start, end, stops and end == last))
            why[start:end] = ""
    rising = np.zeros(speed.size, dtype=bool)
    for low, high in _rises(speed, least):
        rising[low:high] = True
    why[rising & (why == "held")] = "rising"
    coasts = [
        Coast(
            index,
            float(time[start]),
            float(time[end - 1]),
            bool(np.median(signed[start:end]) > 0),
            stops,
            time[start:end] - time[start],
            speed[start:end],
        )
        for start, end, stops in found
    ]
    return coasts, list(_stretches(index, time, why, size))


def rows_averaged(run: Run) -> int:
    """Return how many rows of a run make one row of its coasts."""
    return max(1, -(-run.time.size // _LOOKED_AT))


def _means(values: FloatArray, size: int) -> FloatArray:
    """Means of so many rows each; those at the end that are fewer are left out."""
    return np.asarray(
        values if size == 1 else values[: values.size // size * size].reshape(-1, size).mean(axis=1)
    )


def noise_of_rows(speed: FloatArray) -> float:
    """Return the standard deviation of the noise of one row, that of rounding included."""
    bends = np.abs(np.diff(speed, 2))
    white = float(np.median(bends)) / BEND_OF_NOISE if bends.size else 0.0
    return max(white, float(step_of_levels(speed) / np.sqrt(12.0)))


def _falls(speed: FloatArray, least: float) -> Iterator[tuple[int, int]]:
    """Rows of each high and of the low that follows, where speed falls by at least so much."""
    high = low = 0
    falling = False
    for row, value in enumerate(speed.tolist()):
        if not falling:
            if value >= speed[high]:
                high = row
            elif speed[high] - value >= least:
                falling, low = True, row
        elif value < speed[low]:
            low = row
        elif value - speed[low] >= least:
            yield high, low + 1
            falling, high = False, row
    if falling:
        yield high, low + 1


def _rises(speed: FloatArray, least: float) -> Iterator[tuple[int, int]]:
    """Rows of each low and of the high that follows."""
    for top, bottom in _falls(speed[::-1], least):
        yield speed.size - bottom, speed.size - top


def _turns(signed: FloatArray, top: int, bottom: int, noise: float) -> bool:
    """Whether a wheel goes on in the other direction without a rest, as only a drive can make it."""
    after = signed[bottom : bottom + FEWEST_ROWS] * np.sign(signed[top])
    return bool(after.size and after[-1] < -_FALL * noise)


def _below_steps(
    time: FloatArray, speed: FloatArray, top: int, bottom: int, noise: float, why: np.ndarray
) -> int:
    """First row after the steps of a fall, which are marked in ``why``; ``bottom`` if it is all steps."""
    steps = steps_in(time, speed, top, bottom, noise)
    if steps:
        why[top : steps[0].top] = "held"
    for step in steps:
        why[step.top : step.start] = "stepped"
        why[step.start : step.end] = "held"
    after = steps[-1].end - 1 if steps else top
    rests = speed[bottom - 1] <= max(STANDING, _EDGE_NOISE * noise)
    if after >= bottom or (len(steps) >= _STAIRCASE and not rests):
        why[after:bottom] = "stepped"
        return bottom
    return after


def _trimmed(speed: FloatArray, top: int, bottom: int, noise: float) -> tuple[int, int, bool]:
    """First row, row after the last, and whether the wheel comes to rest."""
    part = speed[top:bottom]
    drop = float(part[0] - part[-1])
    edge = max(_EDGE * drop, _EDGE_NOISE * noise)
    first = top + int(np.flatnonzero(part >= part[0] - edge)[-1]) + 1
    rest = max(_EDGE * float(part[0]), _EDGE_NOISE * noise + STANDING)
    stops = bool(part[-1] <= rest)
    if stops:
        last = top + int(np.argmax(part <= rest))
    elif bottom >= speed.size - 1:  # the log ends while the wheel coasts
        last = bottom
    else:
        last = top + int(np.argmax(part <= part[-1] + edge))
    return first, max(first, last), stops


def _free(
    time: FloatArray, speed: FloatArray, first: int, last: int, noise: float, why: np.ndarray
) -> Iterator[tuple[int, int]]:
    """Parts of a fall without brake and drive; what is not free is marked in ``why``."""
    count = min(_PARTS, (last - first) // _FEWEST_PER_PART)
    if count < 4:
        yield first, last
        return
    edges = np.linspace(first, last, count + 1).astype(int)
    rates, errors = _rates(time, speed, edges, noise)
    state = _states(rates, errors)
    start = 0
    for part in range(1, count + 1):
        if part < count and state[part] == state[start]:
            continue
        rows = [int(edges[start]), int(edges[part])]
        if state[start] == "":  # a change lies somewhere in the parts next to it
            rows = [int(edges[start + (start > 0)]), int(edges[part - (part < count)])]
            if rows[1] > rows[0]:
                yield rows[0], rows[1]
        else:
            why[rows[0] : rows[1]] = state[start]
        start = part


def _rates(
    time: FloatArray, speed: FloatArray, edges: np.ndarray, noise: float
) -> tuple[FloatArray, FloatArray]:
    """Deceleration of each part, and its standard error, from noise and from the scatter of neighbours."""
    rates, errors = np.empty(edges.size - 1), np.empty(edges.size - 1)
    for i, (start, end) in enumerate(pairwise(edges)):
        t = time[start:end] - time[start:end].mean()
        rates[i] = -float(t @ speed[start:end]) / float(t @ t)
        errors[i] = noise / np.sqrt(float(t @ t))
    bends = np.abs(np.diff(rates, 2))
    around = np.pad(bends, 1 + _NEAR // 2, mode="edge")
    near = np.median(np.lib.stride_tricks.sliding_window_view(around, _NEAR), axis=1)[: rates.size]
    scatter = np.maximum(near, np.median(bends)) / BEND_OF_NOISE
    return rates, np.hypot(errors, scatter)


def _states(rates: FloatArray, errors: FloatArray) -> list[str]:
    """What each part is: free (empty), ``braking``, or ``driven`` (slowed less than by friction)."""
    state = [""] * rates.size
    kept = [0]
    for part in range(1, rates.size):
        smaller = [k for k in kept if _above(rates, errors, part, k)]
        if smaller and not _begins_suddenly(rates, kept, smaller):
            state[part] = "braking"
            continue
        for k in smaller:
            state[k] = "driven"
            kept.remove(k)
        kept.append(part)
    return state


def _begins_suddenly(rates: FloatArray, kept: list[int], smaller: list[int]) -> bool:
    """Whether parts with a small deceleration begin with a sudden fall of it, as where a drive takes hold."""
    before = [k for k in kept if k < smaller[0]]
    return bool(before) and bool(rates[smaller[:2]].min() < _SUDDEN * rates[before[-1]])


def _above(rates: FloatArray, errors: FloatArray, part: int, earlier: int) -> bool:
    """Whether a part is slowed more than an earlier one, surely."""
    by = rates[part] - rates[earlier]
    error = float(np.hypot(errors[part], errors[earlier]))
    return bool(by > _SURELY * error and rates[part] > _RISES * rates[earlier])


def _stretches(run: int, time: FloatArray, why: np.ndarray, size: int) -> Iterator[LeftOut]:
    """Stretches of one reason each."""
    edges = [0, *(np.flatnonzero(why[1:] != why[:-1]) + 1).tolist(), why.size]
    for start, end in pairwise(edges):
        if reason := str(why[start]):
            yield LeftOut(run, float(time[start]), float(time[end - 1]), size * (end - start), reason)  # type: ignore[arg-type]
