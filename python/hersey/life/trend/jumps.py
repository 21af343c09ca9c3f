"""Sudden changes of friction that no course explains: a film that breaks down, a seizure, a new contact."""

from __future__ import annotations

import numpy as np

from hersey.damping.candidates.likelihood import EVIDENCE
from hersey.life.trend.comparing import Data, Fitted, fitted, jump_gains, with_jump
from hersey.life.trend.shapes import Shape

#: By how much twice the log-likelihood must rise for a jump that may be anywhere.
_JUMP = 25.0
#: Jumps that are looked for, and blocks at either end that are no side of one.
_MOST, _AT_BEGIN, _AT_END = 4, 3, 2


def all_fitted(shapes: tuple[Shape, ...], data: Data, warm: tuple[bool, ...]) -> list[Fitted]:
    """Return every course fitted, without and with temperature as a cause."""
    return [fitted(shape, data, warm=each) for each in warm for shape in shapes]


def likeliest(fits: list[Fitted]) -> Fitted:
    """Return the course that ranks first."""
    return min(fits, key=lambda each: each.rank)


def with_jumps(shapes: tuple[Shape, ...], data: Data, warm: tuple[bool, ...]) -> list[Fitted]:
    """Return every course fitted, beside as many jumps as the record shows."""
    fits = all_fitted(shapes, data, warm)
    for _ in range(_MOST):
        best = likeliest(fits)
        places = [
            first
            for first in range(_AT_BEGIN, best.data.age.size - _AT_END)
            if all(abs(first - other) > 1 for other in best.data.jumps)
        ]
        gains = jump_gains(best, places)
        if not places or gains.max() < _JUMP:
            break
        more = all_fitted(shapes, with_jump(best.data, places[int(np.argmax(gains))]), warm)
        if likeliest(more).rank > best.rank - EVIDENCE:
            break
        fits = more
    return fits
