"""What to measure next: how far new runs would narrow what is asked, expected before they are made.

A new run is drawn from the posterior, all draws are weighed by how well they foretell it, and the interval is
taken anew; the mean over such runs is what to expect (pre-posterior analysis; Raiffa, Schlaifer 1961).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.life.growth.limit_ages import CONFIDENCE
from hersey.result import Means, Record

#: New runs drawn for each candidate.
_RUNS = 64
#: Candidates: shares of the way from the age last seen to the end, and how far at most, in that age.
_WAY, _FARTHEST = (0.25, 0.5, 0.75), 2.0
#: In an interval, "never" counts as so many times the greatest age.
HORIZON = 10.0


@dataclass(frozen=True)
class NextRun(Record):
    """What could be measured, and how far it is expected to narrow an interval (its widths, in age)."""

    also_stated = ("narrowing",)

    unit: Annotated[
        str | None, Means("null: one more specimen, followed to its end")
    ]  #: None: one more specimen, followed to its end
    age: float  #: of the run; of a new specimen, about where it ends
    before: Annotated[float, Means("width of the interval of this specimen's end, or of B10, in age")]
    after: float

    @property
    def narrowing(self) -> float:
        """Share of the interval that is expected to go."""
        return 1.0 - self.after / self.before if self.before > 0.0 else 0.0

    def words(self, age_unit: str) -> str:
        """Return the advice as a sentence."""
        what = (
            (
                f"measure {self.unit} again at {rounded(self.age)} {age_unit}; this narrows the interval of "
                "its end, in width,"
            )
            if self.unit is not None
            else (
                f"follow one more specimen to its end (about {rounded(self.age)} {age_unit}); this narrows "
                "the interval of B10, in width,"
            )
        )
        widths = f"{rounded(self.before)} to about {rounded(self.after)} {age_unit}"
        return f"{what} from {widths}".replace(" ;", ";").strip()


def rounded(age: float, digits: int = 2) -> str:
    """Return an age as one would plan it."""
    return f"{float(f'{age:.{digits}g}'):.10g}"


def candidate_ages(last: float, end: float) -> FloatArray:
    """Return the ages at which a specimen that was last seen at ``last`` could be measured again."""
    latest = min(end, _FARTHEST * last if last > 0.0 else end)
    if not (math.isfinite(latest) and latest > last):
        return np.empty(0)
    ages = {float(rounded(last + share * (latest - last))) for share in _WAY}
    return np.array(sorted(age for age in ages if age > last))


def widths_after(
    ages: FloatArray,
    values: Sequence[FloatArray],
    errors: Sequence[FloatArray],
    correlation: FloatArray,
    random: np.random.Generator,
) -> FloatArray:
    """Return the expected width of the interval of an age, after a run at each candidate.

    Parameters
    ----------
    ages
        Joint draws of the age asked, finite, shape (draws,).
    values, errors
        For each indicator the logarithm of its value at the candidates, (draws, candidates), and the standard
        error of a run, (draws, 1), by the same draws.
    correlation
        Of the errors of the indicators in one run.
    """
    order = np.argsort(ages)
    ordered = ages[order]
    stack = np.stack([each[order] for each in values])  # (indicators, draws, candidates)
    error = np.stack([each[order, 0] for each in errors])
    seen = random.integers(0, ages.size, _RUNS)
    noise = random.standard_normal((_RUNS, len(values))) @ np.linalg.cholesky(correlation).T
    inverse = np.linalg.inv(correlation)
    constant = -np.log(error).sum(axis=0)
    found = np.empty(stack.shape[2])
    for c in range(found.size):
        run = stack[:, seen, c] + error[:, seen] * noise.T
        away = (run[:, :, None] - stack[:, None, :, c]) / error[:, None, :]
        logs = constant - 0.5 * np.einsum("ird,ij,jrd->rd", away, inverse, away, optimize=True)
        found[c] = _mean_width(ordered, np.exp(logs - logs.max(axis=1, keepdims=True)))
    return found


def width_after_specimen(ages: FloatArray, new: FloatArray, random: np.random.Generator) -> float:
    """Return the expected width of the interval of an age once the end of one more specimen is known.

    ``new`` are ends of new specimens under each draw of ``ages``, (draws, specimens), all finite and
    positive: how probable an end is under a draw is taken from a lognormal law through them.
    """
    order = np.argsort(ages)
    logs = np.log(new[order])
    mean, spread = logs.mean(axis=1), np.maximum(logs.std(axis=1), 1e-6)
    seen = random.integers(0, ages.size, _RUNS)
    end = logs[seen, random.integers(0, logs.shape[1], _RUNS)]
    density = -np.log(spread) - 0.5 * ((end[:, None] - mean) / spread) ** 2
    return _mean_width(ages[order], np.exp(density - density.max(axis=1, keepdims=True)))


def width(ages: FloatArray) -> float:
    """Return the width of the interval of equally probable ages."""
    return _mean_width(np.sort(ages), np.ones((1, ages.size)))


def _mean_width(ordered: FloatArray, weights: FloatArray) -> float:
    """Mean over rows of weights of the interval of ages in ascending order."""
    steps = np.cumsum(weights, axis=1)
    ends = [
        ordered[np.minimum((steps < share * steps[:, -1:]).sum(axis=1), ordered.size - 1)]
        for share in (0.5 - CONFIDENCE / 2, 0.5 + CONFIDENCE / 2)
    ]
    return float((ends[1] - ends[0]).mean())
