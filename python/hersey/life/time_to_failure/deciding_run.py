"""The run that helps most to decide a question about new specimens: a share, or the age of replacement.

One new run is simulated for each draw, the loss of each answer is regressed on the runs, and the answer of
the least loss foreseen is taken: its mean loss is what a run leaves (Strong, Oakley, Brennan and Breeze 2015,
Medical Decision Making 35:570).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Literal, NamedTuple

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.life.growth.limit_ages import percent, rounded
from hersey.life.time_to_failure.first import SpecimenEnd
from hersey.life.time_to_failure.next_run import NEAR, WORTH, candidate_ages
from hersey.life.time_to_failure.way import FittedWay, listed
from hersey.result import Means, Record

#: Specimens for which a run is weighed: the first to fail of those that run.
_WEIGHED = 24
#: Loss up to which a question needs no run: a risk of a wrong answer, a share of the cost.
_ENOUGH = {"share": 0.05, "replacement": 0.01}
#: New specimens that may be followed, and the part of the loss that they are to leave.
_SIZES, _HALF = (1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 40, 50), 0.5
#: Simulated tests of new specimens, and the least share that fails between two ages.
_TESTS, _LEAST = 500, 5e-4
#: Age, specimens, and what the runs show in each draw, (draws, values).
_Run = tuple[float, tuple[str, ...], FloatArray]


@dataclass(frozen=True)
class DecidingRun(Record):
    """A run, or one of each running specimen, that helps to decide a question about new specimens."""

    question: Annotated[
        Literal["share", "replacement"], Means("whether a share fails before an age, or when to replace")
    ]
    units: Annotated[tuple[str, ...], Means("specimens to measure; empty if no run of them helps much")]
    new: Annotated[int, Means("new specimens to follow instead; 0 with `units`, or if fifty are too few")]
    age: Annotated[
        float | None, Means("of the run, or up to which new specimens are followed; null: to failure")
    ]
    before: Annotated[
        float,
        Means(
            "without the run: probability of a wrong answer, or expected loss as a share of the cost of "
            "running to failure"
        ),
    ]
    after: Annotated[float, Means("the same with the run, as expected")]

    @property
    def helps(self) -> bool:
        """Whether any run, or so many new specimens, help much."""
        return bool(self.units or self.new)

    def words(self, age_unit: str, asked: str) -> str:
        """Return the advice as a sentence; ``asked`` is what the run decides, in words."""
        before, after = percent(self.before), percent(self.after)
        risk, of = ("risk of a wrong answer", "")
        if self.question == "replacement":
            risk, of = "expected loss from a wrong age", " of the cost"
        age = "failure" if self.age is None else f"{rounded(self.age, 6)} {age_unit}".strip()
        if not self.helps:
            more = f"follow more than {_SIZES[-1]} new specimens to {age} to decide {asked}"
            return f"{more}; the {risk} is {before}{of}"
        change = f"the {risk} falls from {before} to about {after}{of}"
        if self.units:
            return f"measure {listed(self.units)} again at {age} to decide {asked}; {change}"
        more = "one new specimen" if self.new == 1 else f"{self.new} new specimens"
        return f"follow {more} to {age} to decide {asked}; {change}"


class Question(NamedTuple):
    """A question about new specimens, and what each answer would lose."""

    kind: Literal["share", "replacement"]
    loss: FloatArray  #: of each answer in each draw, at least 0, (draws, answers)
    goal: float  #: age that it concerns
    failing: FloatArray  #: share that fails between ages at which new specimens are seen, (draws, ages)


def deciding_run(
    question: Question,
    ending: Sequence[FittedWay],
    units: Sequence[SpecimenEnd],
    order: IntArray,
    of_runs: FloatArray,
    random: np.random.Generator,
) -> DecidingRun | None:
    """Return the run that lowers the expected loss most, or None if the question is decided well enough.

    If no run of one specimen lowers it enough, it is one of each; and if that does not either, so many new
    specimens are followed that half of the loss is left. ``order`` is as from `joint_order`, ``of_runs`` the
    correlation of the modes within one run.
    """
    kind, loss, goal, failing = question
    before = float(loss.mean(axis=0).min())
    if before <= _ENOUGH[kind]:
        return None
    running = sorted((each for each in units if each.state != "failed"), key=lambda e: e.age.age.value)
    specimens = [each for each in running if each.age.last > 0.0][:_WEIGHED]
    together = candidate_ages(max((each.age.last for each in specimens), default=0.0), goal)
    seen = [_Seen.of(each, goal, together, ending, order, of_runs, random) for each in specimens]
    for runs in ([run for each in seen for run in each.alone()], _of_each(seen, together)):
        left = [loss_after(loss, values) for _, _, values in runs]
        most = before - min(left, default=before)
        if most >= WORTH * before:
            good = [i for i, after in enumerate(left) if before - after >= NEAR * most]
            best = min(good, key=lambda i: (runs[i][0], left[i]))
            return DecidingRun(kind, runs[best][1], 0, runs[best][0], before, left[best])
    until = goal if kind == "share" else None
    for size in _SIZES:
        after = loss_after_new(loss, failing, size, random)
        if after <= _HALF * before:
            return DecidingRun(kind, (), size, until, before, after)
    return DecidingRun(kind, (), 0, until, before, before)


@dataclass(frozen=True)
class _Seen:
    """What runs of a specimen would show of each mode that it shows, (draws, ages)."""

    unit: str
    alone_at: FloatArray  #: ages of runs of it alone, which the ages of runs of all follow
    modes: dict[int, FloatArray]

    @classmethod
    def of(
        cls,
        specimen: SpecimenEnd,
        goal: float,
        together: FloatArray,
        ending: Sequence[FittedWay],
        order: IntArray,
        of_runs: FloatArray,
        random: np.random.Generator,
    ) -> _Seen:
        own = candidate_ages(specimen.age.last, goal)
        ages = np.append(own, together)
        noise = random.standard_normal(order.shape) @ np.linalg.cholesky(of_runs).T
        found = {}
        for m, each in enumerate(ending):
            if specimen.unit in each.row:
                value, scatter = each.drawn_values(specimen.unit, ages)
                error = np.hypot(scatter, each.error)[order[:, m]]
                found[m] = _ranked(value[order[:, m]] + error * noise[:, m, None])
        return cls(specimen.unit, own, found)

    def alone(self) -> list[_Run]:
        """Return the runs of this specimen."""
        ages = self.alone_at.tolist() if self.modes else []
        return [
            (age, (self.unit,), np.stack([values[:, i] for values in self.modes.values()], axis=1))
            for i, age in enumerate(ages)
        ]


def _of_each(seen: Sequence[_Seen], ages: FloatArray) -> list[_Run]:
    """A run of each specimen at one age: mean and spread of the modes that all show."""
    modes = sorted(set.intersection(*(set(each.modes) for each in seen))) if len(seen) > 1 else []
    found = []
    for i, age in enumerate(ages.tolist() if modes else []):
        whole = np.array([[each.modes[m][:, each.alone_at.size + i] for m in modes] for each in seen])
        values = np.concatenate([whole.mean(axis=0), whole.std(axis=0)]).T
        found.append((age, tuple(each.unit for each in seen), values))
    return found


def _ranked(values: FloatArray) -> FloatArray:
    """Ranks of the draws, from -1 to 1: they have no tails that a regression would follow."""
    ranks = np.argsort(np.argsort(values, axis=0), axis=0)
    return np.asarray((2.0 * ranks + 1.0) / len(values) - 1.0)


def loss_after(loss: FloatArray, seen: FloatArray) -> float:
    """Return the expected loss once a run is known.

    Half of the draws show which answer to give in the other half, so that chance lowers no loss.

    Parameters
    ----------
    loss
        Of each answer in each draw, (draws, answers).
    seen
        What the run of each draw shows, (draws, values).
    """
    first, second = np.triu_indices(seen.shape[1])
    terms = np.column_stack([np.ones(len(seen)), seen, seen[:, first] * seen[:, second]])
    left = np.empty(len(loss))
    for half in (slice(0, None, 2), slice(1, None, 2)):
        other = slice(1 - (half.start or 0), None, 2)
        foreseen = terms[half] @ np.linalg.lstsq(terms[other], loss[other], rcond=None)[0]
        left[half] = loss[half][np.arange(len(foreseen)), foreseen.argmin(axis=1)]
    return float(left.mean())


def loss_after_new(loss: FloatArray, failing: FloatArray, size: int, random: np.random.Generator) -> float:
    """Return the expected loss once it is known between which ages so many new specimens failed.

    Numbers are multinomial: each simulated test weighs the draws by how well they foretell it. ``failing`` is
    the share that fails between ages, the rest included, (draws, ages).
    """
    # A share that no drawn specimen has is not impossible.
    share = (failing + _LEAST) / (1.0 + _LEAST * failing.shape[1])
    tests = random.multinomial(size, share[random.integers(0, len(loss), _TESTS)])
    logs = tests @ np.log(share).T
    weights = np.exp(logs - logs.max(axis=1, keepdims=True))
    return float((weights @ loss / weights.sum(axis=1, keepdims=True)).min(axis=1).mean())
