"""Dwells whose speed ripples with the shaft: one speed held, revolution by revolution.

A slow shaft that runs unevenly within a turn looks like changing speed. Its mean over each whole turn does
not change: such dwells are put together again, cut to whole turns, and the ripple is subtracted before drift
and noise are judged.
"""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells.noise import thinned
from hersey.damping.dwells.segments import BLOCK_DURATION, Segment
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


def joined_over_turns(run: Run, segments: list[Segment]) -> list[Segment]:
    """Put together the pieces of dwells whose speed, averaged over revolutions, holds."""
    out: list[Segment] = []
    for chain in _chains(segments):
        out += _rejoined(run, chain) if len(chain) > 1 else chain
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
    angle = turned(run.time[start:end], run.speed[start:end])
    edges = np.searchsorted(angle, 2.0 * np.pi * np.arange(1 + int(angle[-1] / (2.0 * np.pi))))
    edges = np.unique(edges)
    if edges.size <= TURNS:
        return chain
    means = np.add.reduceat(run.speed[start:end], edges[:-1])[: edges.size - 1] / np.diff(edges)
    # the last sum runs on to the end of the chain: only whole revolutions count
    means[-1] = float(np.mean(run.speed[start + edges[-2] : start + edges[-1]]))
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
    before = [replace(s, end=min(s.end, rows[0])) for s in chain if s.start < rows[0]]
    after = [replace(s, start=max(s.start, rows[1])) for s in chain if s.end > rows[1]]
    cut = [replace(s, steady=s.steady and s in chain) for s in (*before, *after)]
    return [*cut[: len(before)], Segment(*rows, speed, True, False, ripple=True), *cut[len(before) :]]


def turned(time: FloatArray, speed: FloatArray) -> FloatArray:
    """Return the angle of the shaft from the first row on, rad, without its sign."""
    steps = np.diff(time) * (np.abs(speed[1:]) + np.abs(speed[:-1])) / 2.0
    return np.concatenate([[0.0], np.cumsum(steps)])


def without_ripple(angle: FloatArray, values: FloatArray) -> FloatArray:
    """Return values without what repeats with the revolution; their mean and their drift stay."""
    at, means = thinned(angle), thinned(values)
    waves = [wave(k * at) for k, wave in _WAVES]
    columns = np.column_stack([np.ones_like(at), at - at.mean(), *waves])
    sizes = np.linalg.lstsq(columns, means, rcond=None)[0][2:]
    ripple = np.zeros_like(values)
    for (k, wave), size in zip(_WAVES, sizes, strict=True):
        ripple += size * wave(k * angle)
    return np.asarray(values - ripple + ripple.mean())


_WAVES = tuple(itertools.product(range(1, HARMONICS + 1), (np.cos, np.sin)))
