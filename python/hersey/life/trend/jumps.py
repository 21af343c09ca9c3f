"""Sudden changes of friction that no course explains: a film that breaks down, a seizure, a new contact."""

from __future__ import annotations

import numpy as np

from hersey.damping.candidates.likelihood import EVIDENCE
from hersey.life.trend.comparing import Data, Fitted, fitted, jump_gains
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
    """Return every course fitted, beside as many jumps as the record shows.

    A jump is looked for beside the likeliest course, and beside none: a course can follow a jump halfway.
    """
    fits = all_fitted(shapes, data, warm)
    for _ in range(_MOST):
        best = likeliest(fits)
        places = {_place(best)}
        still = likeliest([each for each in fits if not each.shape.law.grows])
        if still is not best:
            places.add(_place(still))
        tried = [_jumped(best, place, shapes, warm) for place in sorted(filter(None, places))]
        gain, more = max(tried, key=lambda each: each[0], default=(0.0, fits))
        if gain <= EVIDENCE:
            break
        fits = more
    return fits


def _place(found: Fitted) -> int:
    """The block before which a jump raises the likelihood of a course most; 0 if it hardly does."""
    places = [
        first
        for first in range(_AT_BEGIN, found.data.age.size - _AT_END)
        if all(abs(first - other) > 1 for other in found.data.jumps)
    ]
    gains = jump_gains(found, places) if places else np.zeros(1)
    return places[int(np.argmax(gains))] if gains.max() >= _JUMP else 0


def _jumped(
    best: Fitted, place: int, shapes: tuple[Shape, ...], warm: tuple[bool, ...]
) -> tuple[float, list[Fitted]]:
    """Courses fitted with one more jump, and by how much the likeliest is better than the one without.

    Both are fitted to the same blocks, one of which now ends where the jump is.
    """
    cut, row = best.data.cut_before(place)
    more = all_fitted(shapes, cut.with_jump(row), warm)
    return fitted(best.shape, cut, warm=best.warm).rank - likeliest(more).rank, more
