"""The questions answered that concern new specimens, and the runs that would decide them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.life.growth.limit_ages import FAR, SURE
from hersey.life.replacement import Replacement, best_replacement, costs, places
from hersey.life.time_to_failure.deciding_run import DecidingRun, Question, deciding_run
from hersey.life.time_to_failure.failing_before import ShareFailing, failing_share
from hersey.life.time_to_failure.first import SpecimenEnd
from hersey.life.time_to_failure.questions import Questions
from hersey.life.time_to_failure.way import FittedWay

#: Parts of the ages at failure in which new specimens are counted.
_PARTS = 8


@dataclass(frozen=True)
class Decided:
    """The answers; None to what was not asked."""

    share: ShareFailing | None = None
    replacement: Replacement | None = None
    runs: tuple[DecidingRun, ...] = ()


def decided(
    asked: Questions,
    first: FloatArray,
    followed: float,
    ending: Sequence[FittedWay],
    units: Sequence[SpecimenEnd],
    order: IntArray,
    of_runs: FloatArray,
    seed: int,
) -> Decided:
    """Return the answers from draws of the ages of first failure of new specimens, (draws, specimens).

    ``order`` is as from `joint_order`, ``followed`` the greatest age of the runs.
    """
    share, replacement, runs = None, None, []
    draws = (ending, units, order, of_runs, np.random.default_rng([seed, 5]))
    if asked.share is not None and asked.until is not None:
        share = failing_share(first, asked.until, asked.share, followed)
        if asked.until <= share.shown:
            runs.append(deciding_run(_of_share(first, asked.until, asked.share), *draws))
    if asked.cost_of_failure is not None:
        unit = ending[0].mode.ages.age_unit
        replacement, question = _replacement(first, followed, asked.cost_of_failure, unit)
        run = deciding_run(question, *draws)
        if replacement.pays == "not yet decided" or (run is not None and run.helps):
            runs.append(run)
    return Decided(share, replacement, tuple(run for run in runs if run is not None))


def _of_share(first: FloatArray, age: float, allowed: float) -> Question:
    failing = (first <= age).mean(axis=1)
    few = failing <= allowed
    loss = np.stack([~few, few], axis=1).astype(float)  # of yes, and of no
    return Question("share", loss, age, np.stack([failing, 1.0 - failing], axis=1))


def _replacement(
    first: FloatArray, followed: float, cost_of_failure: float, unit: str
) -> tuple[Replacement, Question]:
    """The age of least cost; in each draw an age loses what it costs more than the best of that draw."""
    end = FAR * followed
    ages = places(end)
    survived = 1.0 - _failed_by(first, ages)
    lived = np.stack([np.minimum(first, age).mean(axis=1) for age in ages], axis=1)
    cost = costs(survived, lived, cost_of_failure)
    relative = cost / cost[:, -1:]
    found = best_replacement(
        ages,
        relative,
        relative.mean(axis=0),
        cost_of_failure=cost_of_failure,
        unit=unit,
        until=SURE * followed,
        left=float(survived[:, -1].mean()),
    )
    loss = relative - relative.min(axis=1, keepdims=True)
    goal = min(found.age.value, end)
    return found, Question("replacement", loss, goal, _failing_between(first, end))


def _failing_between(first: FloatArray, until: float) -> FloatArray:
    """Share of new specimens that fails between ages, as many of them in each over all draws."""
    ages = np.quantile(np.minimum(first, until), np.arange(1, _PARTS) / _PARTS)
    return np.diff(_failed_by(first, ages), axis=1, prepend=0.0, append=1.0)


def _failed_by(first: FloatArray, ages: FloatArray) -> FloatArray:
    """Share of new specimens that has failed by ages, (draws, ages)."""
    return np.stack([(first <= age).mean(axis=1) for age in ages], axis=1)
