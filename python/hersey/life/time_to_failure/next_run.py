"""What to measure next: how far a run would help to decide whether a specimen lasts until an age.

A new run is drawn from the posterior, all draws are weighed by how well they foretell it, and the question is
answered anew; the mean over such runs is what to expect (pre-posterior analysis; Raiffa, Schlaifer 1961).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.life.growth.limit_ages import percent, rounded
from hersey.life.time_to_failure.first import Picks, SpecimenEnd
from hersey.life.time_to_failure.way import FittedWay
from hersey.result import Means, Record

#: New runs drawn for each candidate.
_RUNS = 128
#: Candidates: shares of the way from the age last seen to that of the question; beyond the age last seen
#: if the question is about the present.
_WAY, _BEYOND = (0.25, 0.5, 0.75, 1.0), (0.05, 0.1, 0.2)
#: A run is worth it if it lowers the risk of a wrong answer by this share; of those that come near the best
#: one the earliest is chosen.
WORTH, NEAR = 0.15, 0.8
#: Specimens, of the most doubtful, for which a run is weighed, and risk up to which a question needs none.
_WEIGHED, _SURE = 24, 0.05


@dataclass(frozen=True)
class NextRun(Record):
    """A run that helps to decide whether a specimen lasts until an age."""

    unit: Annotated[str, Means("the specimen")]
    age: Annotated[float, Means("of the run")]
    until: Annotated[float, Means("age that the specimen may or may not reach")]
    present: Annotated[bool, Means("whether that is the age at which it was last seen")]
    mode: Annotated[str, Means("its most probable failure mode")]
    before: Annotated[float, Means("probability of a wrong answer without the run")]
    after: Annotated[float, Means("the same with the run, as expected")]

    def words(self, age_unit: str) -> str:
        """Return the advice as a sentence."""
        unit = f" {age_unit}" if age_unit else ""
        question = (
            f"has failed ({self.mode})" if self.present else f"lasts until {rounded(self.until, 6)}{unit}"
        )
        return (
            f"measure {self.unit} again at {rounded(self.age, 6)}{unit} to find out whether it {question}; "
            f"the risk of a wrong answer falls from {percent(self.before)} to about {percent(self.after)}"
        )


def candidate_ages(last: float, until: float) -> FloatArray:
    """Return the ages at which a specimen that was last seen at ``last`` could be measured again."""
    way = (last * (1.0 + share) for share in _BEYOND)
    if until > last:
        way = (last + share * (until - last) for share in _WAY)
    ages = {float(rounded(age, 2)) for age in way}
    return np.array([last, *sorted(age for age in ages if age > last and (age <= until or until <= last))])


def _wrong(event: BoolArray) -> float:
    """The probability that the likelier answer to a question is wrong."""
    share = float(event.mean())
    return min(share, 1.0 - share)


def wrong_after(
    event: BoolArray,
    values: Sequence[FloatArray],
    errors: Sequence[FloatArray],
    correlation: FloatArray,
    random: np.random.Generator,
) -> FloatArray:
    """Return the expected probability of a wrong answer after a run at each candidate.

    Parameters
    ----------
    event
        Whether the event holds in each joint draw, shape (draws,).
    values, errors
        For each indicator the logarithm of its value at the candidates, (draws, candidates), and the standard
        error of a run, (draws, 1), by the same draws.
    correlation
        Of the errors of the indicators in one run.
    """
    stack = np.stack(values)  # (indicators, draws, candidates)
    error = np.stack([each[:, 0] for each in errors])
    seen = random.integers(0, event.size, _RUNS)
    noise = random.standard_normal((_RUNS, len(values))) @ np.linalg.cholesky(correlation).T
    inverse = np.linalg.inv(correlation)
    constant = -np.log(error).sum(axis=0)
    found = np.empty(stack.shape[2])
    for c in range(found.size):
        run = stack[:, seen, c] + error[:, seen] * noise.T
        away = (run[:, :, None] - stack[:, None, :, c]) / error[:, None, :]
        logs = constant - 0.5 * np.einsum("ird,ij,jrd->rd", away, inverse, away, optimize=True)
        weights = np.exp(logs - logs.max(axis=1, keepdims=True))
        share = weights @ event / weights.sum(axis=1)
        found[c] = np.minimum(share, 1.0 - share).mean()
    return found


def _chosen(before: float, after: FloatArray) -> int | None:
    """Which candidate is worth a run: the earliest that comes near the best; None if none is."""
    gain = before - after
    if gain.max() < WORTH * before:
        return None
    return int(np.flatnonzero(gain >= NEAR * gain.max())[0])


def next_runs(
    ending: Sequence[FittedWay],
    units: Sequence[SpecimenEnd],
    picks: Picks,
    of_runs: FloatArray,
    asked: float | None,
    random: np.random.Generator,
) -> list[NextRun]:
    """Return the run of each doubtful specimen that best shows whether it reaches an age, or has failed.

    The one that helps most comes first. ``picks`` are as from `ends_of_specimens`; without an age ``asked``
    the question is whether a specimen has failed.
    """
    goals = [each.age.last if asked is None else max(asked, each.age.last) for each in units]
    events = (picks.first <= np.array(goals)).T
    doubtful = [i for i, each in enumerate(units) if each.state != "failed" and _wrong(events[i]) > _SURE]
    doubtful.sort(key=lambda i: -_wrong(events[i]))
    found = []
    for i in sorted(doubtful[:_WEIGHED]):
        name, last = units[i].unit, units[i].age.last
        ages = candidate_ages(last, goals[i])
        observed = [m for m, each in enumerate(ending) if name in each.row]
        if not observed or last <= 0.0:
            continue
        values, errors = [], []
        for m in observed:
            order, each = picks.order[m, :, i], ending[m]
            value, scatter = each.drawn_values(name, ages)
            values.append(value[order])
            errors.append(np.hypot(scatter, each.error)[order])
        among = of_runs[np.ix_(observed, observed)]
        before, after = _wrong(events[i]), wrong_after(events[i], values, errors, among, random)
        best = _chosen(before, after)
        if best is not None:
            mode = max(units[i].first, key=lambda name: units[i].first[name])
            age, risk = float(ages[best]), float(after[best])
            found.append(NextRun(name, age, goals[i], goals[i] == last, mode, before, risk))
    return sorted(found, key=lambda each: each.after - each.before)
