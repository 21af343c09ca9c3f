"""Dwells whose speed ripples with the shaft: one speed held, revolution by revolution.

A slow shaft that runs unevenly within a turn looks like changing speed. Its mean over each whole turn does
not change: such dwells are put together again, cut to whole turns, and the ripple is subtracted before drift
and noise are judged.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.damping.dwells.noise import thinned
from hersey.damping.dwells.segments import BLOCK_DURATION, Segment
from hersey.log.long_arrays import Filling, blocks, each_block, let_go, mean, passed
from hersey.log.torque_log import Run

#: Neighbouring pieces of one rippling dwell differ in speed by less than this share.
PIECES = 0.6
#: Means of revolutions differ by no more than this share, and drift by no more than that.
SAME_TURN, DRIFT = 0.02, 0.01
#: Fewest revolutions that show a ripple.
TURNS = 3
#: A piece that holds this share of them is a dwell by itself.
WHOLE = 0.9
#: Harmonics of the revolution that are subtracted.
HARMONICS = 4
#: Angle of a revolution, rad, and revolutions that are averaged at once.
_TURN, _AT_ONCE = 2.0 * np.pi, 64


def joined_over_turns(run: Run, segments: list[Segment]) -> list[Segment]:
    """Put together the pieces of dwells whose speed, averaged over revolutions, holds."""
    if run.domain.speed != "speed":  # how a sliding speed goes with revolutions is not known
        return segments
    out: list[Segment] = []
    for chain in _chains(segments):
        if len(chain) == 1:
            out += chain
            continue
        out += _rejoined(run, chain)
        for seen in (run.time, run.speed):  # the next chain may be far
            let_go(seen[chain[0].start : chain[-1].end])
    return out


def _chains(segments: list[Segment]) -> list[list[Segment]]:
    """Neighbours that may be pieces of one dwell, together; the others alone."""
    chains: list[list[Segment]] = []
    for segment in segments:
        if chains and _may_be_one(chains[-1][-1], segment):
            chains[-1].append(segment)
        else:
            chains.append([segment])
    return chains


def _may_be_one(before: Segment, after: Segment) -> bool:
    if before.standing or after.standing or before.speed * after.speed <= 0.0:
        return False
    slow, fast = sorted((abs(before.speed), abs(after.speed)))
    return fast - slow <= PIECES * fast and 2.0 * np.pi / fast > 2.0 * BLOCK_DURATION


def _rejoined(run: Run, chain: list[Segment]) -> list[Segment]:
    start, end = chain[0].start, chain[-1].end
    edges = np.unique(_turns(run.time[start:end], run.speed[start:end]))
    if edges.size <= TURNS:
        return chain
    means = _means_between(run.speed[start:end], edges)
    for first, last in _held(means):
        rows = (start + int(edges[first]), start + int(edges[last]))
        largest = max(min(s.end, rows[1]) - max(s.start, rows[0]) for s in chain)
        if largest < WHOLE * (rows[1] - rows[0]):
            chain = _replaced(run, chain, rows)
    return chain


def _held(means: FloatArray) -> list[tuple[int, int]]:
    """Stretches [first, last) of revolutions of one speed, the longest possible from left to right."""
    held, first = [], 0
    while first + TURNS <= means.size:
        last = first + 1
        while last < means.size and abs(means[last] / np.mean(means[first:last]) - 1.0) <= SAME_TURN:
            last += 1
        if last - first >= TURNS:
            rise = float(np.polyfit(np.arange(last - first), means[first:last], 1)[0]) * (last - first)
            if abs(rise) <= DRIFT * abs(float(np.mean(means[first:last]))):
                held.append((first, last))
        first = last if last - first >= TURNS else first + 1
    return held


def _replaced(run: Run, chain: list[Segment], rows: tuple[int, int]) -> list[Segment]:
    """Replace what lies in these rows by one dwell that ripples; what is left of its ends is no dwell."""
    speed = float(np.mean(run.speed[slice(*rows)]))
    run.passed(*rows)
    before = [replace(s, end=min(s.end, rows[0])) for s in chain if s.start < rows[0]]
    after = [replace(s, start=max(s.start, rows[1])) for s in chain if s.end > rows[1]]
    cut = [replace(s, steady=s.steady and s in chain) for s in (*before, *after)]
    return [*cut[: len(before)], Segment(*rows, speed, True, False, ripple=True), *cut[len(before) :]]


def _turns(time: FloatArray, speed: FloatArray) -> IntArray:
    """The first row of each revolution, the first of all among them."""
    found: list[IntArray] = []
    count, angle = 0, np.zeros(1)
    for block, angle in _angles(time, speed):
        ahead = _TURN * np.arange(count, 2 + max(count, int(angle[-1] / _TURN)))
        found.append(block.start + np.searchsorted(angle, ahead[ahead <= angle[-1]]))
        count += found[-1].size
    count = 1 + int(angle[-1] / _TURN)  # which, rounded, may be one more than were found
    return np.append(np.concatenate(found), time.size)[:count]


def _means_between(values: FloatArray, edges: IntArray) -> FloatArray:
    """Means of the rows from each edge to the next."""
    means = []
    for first in range(0, edges.size - 1, _AT_ONCE):
        some = edges[first : first + _AT_ONCE + 1]
        sums = np.add.reduceat(values[some[0] : some[-1]], some[:-1] - some[0])
        means.append(sums / np.diff(some))
        passed(int(some[0]), int(some[-1]), values)
    means[-1][-1] = float(np.mean(values[edges[-2] : edges[-1]]))
    return np.concatenate(means)


def turned(time: FloatArray, speed: FloatArray) -> FloatArray:
    """Return the angle of the shaft from the first row on, rad, without its sign."""
    angles = Filling()
    for block, angle in _angles(time, speed):
        angles.add(angle, block.stop / time.size)
    return angles.whole()


def _angles(time: FloatArray, speed: FloatArray) -> Iterator[tuple[slice, FloatArray]]:
    """The angle of the shaft in one block of rows after another."""
    before = 0.0
    for block in blocks(time.size, time, speed):
        rows = slice(max(block.start - 1, 0), block.stop)
        steps = np.diff(time[rows]) * (np.abs(speed[rows][1:]) + np.abs(speed[rows][:-1])) / 2.0
        angle = np.cumsum(np.append(before, steps))
        before = float(angle[-1])
        yield block, angle[block.start - rows.start :]


def without_ripple(angle: FloatArray, values: FloatArray) -> FloatArray:
    """Return values without what repeats with the revolution; their mean and their drift stay."""
    at, means = thinned(angle), thinned(values)
    waves = [wave(k * at) for k, wave in _WAVES]
    columns = np.column_stack([np.ones_like(at), at - at.mean(), *waves])
    sizes = np.linalg.lstsq(columns, means, rcond=None)[0][2:]

    def rippling(part: FloatArray) -> FloatArray:
        ripple = np.zeros_like(part)
        for (k, wave), size in zip(_WAVES, sizes, strict=True):
            ripple += size * wave(k * part)
        return ripple

    ripple = each_block(rippling, angle)
    middle = mean(ripple)
    return each_block(lambda value, part: value - part + middle, values, ripple)


_WAVES = tuple(itertools.product(range(1, HARMONICS + 1), (np.cos, np.sin)))
