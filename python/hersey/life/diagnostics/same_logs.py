"""Runs that hold the same torques: a log that was copied under another name."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import numpy as np

from hersey.arrays import FloatArray
from hersey.life.diagnostics.measured import MeasuredRuns
from hersey.life.diagnostics.slips import SAME, Slip

#: Digits to which dwells are the same; fewest dwells that are compared.
_DIGITS, _FEWEST = 8, 4
#: Part of the runs up to which copies are slips; more of them are made, not measured.
_SLIPS = 0.25


def same_logs(runs: MeasuredRuns) -> list[Slip]:
    """Return the pairs of runs whose dwells are the same to eight digits."""
    order = np.argsort(runs.of_run, kind="stable")
    ends = np.searchsorted(runs.of_run[order], np.arange(len(runs.number) + 1))
    rows = [order[begin:end] for begin, end in pairwise(ends) if end - begin >= _FEWEST]
    begun = [_text(runs.torque[own[:_FEWEST]]) for own in rows]
    often = Counter(begun)
    first: dict[bytes, int] = {}
    found = []
    for own, start in zip(rows, begun, strict=True):
        if often[start] == 1:
            continue
        place = int(runs.of_run[own[0]])
        text = _text(np.stack([runs.speed[own], runs.torque[own]]))
        if text in first:
            found.append(Slip(SAME, (first[text], place), np.inf))
        first.setdefault(text, place)
    concerned = {place for each in found for place in each.runs}
    return found if len(concerned) <= max(2.0, _SLIPS * len(runs.number)) else []


def _text(dwells: FloatArray) -> bytes:
    return np.array([f"{value:.{_DIGITS}g}" for value in dwells.ravel().tolist()]).tobytes()
