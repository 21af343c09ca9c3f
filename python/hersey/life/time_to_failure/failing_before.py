"""What fails before a stated age: the share of new specimens, and how many of those followed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.life.growth.limit_ages import (
    FAILED,
    FAR,
    RUNNING,
    SURE,
    AgeAtLimit,
    Interval,
    interval,
    percent,
    rounded,
)
from hersey.life.time_to_failure.ageing import after
from hersey.life.time_to_failure.way import FittedWay
from hersey.result import Means, Record

#: Share that is worth naming as the least.
_SEEN = 0.01


@dataclass(frozen=True)
class ShareFailing(Record):
    """Whether at most a share of new specimens fails before an age.

    It is decided where the probability is 95 % or more, so that the interval lies on one side of the share.
    """

    age: Annotated[float, Means("the age that is asked for")]
    allowed: Annotated[float, Means("share that may fail before the age")]
    share: Annotated[Interval, Means("share of new specimens that fails before the age")]
    answer: Annotated[
        Literal["yes", "no", "not yet decided"], Means("whether at most the allowed share fails")
    ]
    shown: Annotated[
        float, Means(f"age before which runs can show that few fail: {SURE:g} times the age followed")
    ]

    def words(self, age_unit: str) -> str:
        """Return the answer as a sentence."""
        unit = f" {age_unit}" if age_unit else ""
        before, allowed = f"before {rounded(self.age, 6)}{unit}", f"{100.0 * self.allowed:.3g} %"
        low, value, high = map(percent, (self.share.low, self.share.value, self.share.high))
        ends = f"{value} of new specimens fail {before} (90 %: {low} to {high})"
        if self.age > self.shown:
            ends = f"{low} or more of new specimens fail {before} (95 %)"
            if self.share.low < _SEEN:
                ends = f"how many new specimens fail {before} is unknown"
        if self.answer == "yes":
            return f"Yes, at most {allowed} fail: {ends}."
        if self.answer == "no":
            return f"No, more than {allowed} fail: {ends}."
        return f"Whether at most {allowed} fail is not yet decided: {ends}."

    def question(self, age_unit: str) -> str:
        """Return what is to be decided."""
        unit = f" {age_unit}" if age_unit else ""
        share = f"{100.0 * self.allowed:.3g} %"
        return f"whether at most {share} of new specimens fail before {rounded(self.age, 6)}{unit}"

    def advice(self, age_unit: str, oldest: float) -> str:
        """Return how far to follow the specimens where the age is later than runs show; else empty.

        ``oldest`` is the greatest age of a specimen: where runs show less, maintenance began it anew.
        """
        if self.age <= self.shown or self.answer == "no":
            return ""
        least = after(self.age / SURE, age_unit)
        anew = " without maintenance" if self.shown < SURE * oldest else ""
        return (
            f"follow the specimens to {least}{anew} to decide {self.question(age_unit)}: runs show ages up "
            f"to {SURE:g} times that followed"
        )


@dataclass(frozen=True)
class FollowedFailing(Record):
    """How many of the specimens followed fail before an age, those that have failed included."""

    age: Annotated[float, Means("the age that is asked for")]
    specimens: Annotated[int, Means("number of specimens")]
    failed: Annotated[Interval, Means("number that has failed by that age")]

    def sentence(self, age_unit: str) -> str:
        """Return the number and its interval as a sentence."""
        of = "specimen" if self.specimens == 1 else "specimens"
        low, value, high = (f"{each:.0f}" for each in (self.failed.low, self.failed.value, self.failed.high))
        fail, age = "fails" if value == "1" else "fail", f"{rounded(self.age, 6)} {age_unit}".strip()
        ends = "" if low == high else f" (90 %: {low} to {high} specimens)"
        return f"{value} of {self.specimens} {of} {fail} before {age}{ends}."


def failing_share(first: FloatArray, age: float, allowed: float, followed: float) -> ShareFailing:
    """Return whether at most a share of new specimens fails before an age.

    Parameters
    ----------
    first
        Draws of the ages of first failure of new specimens, (draws, specimens).
    followed
        Greatest age of the runs: what fails beyond `SURE` times that may be more, beyond `FAR` times unknown.
    """
    shown = SURE * followed
    drawn = (first <= min(age, FAR * followed)).mean(axis=1)
    share, certain = interval(drawn), float((drawn <= allowed).mean())
    if age > shown:
        share, certain = Interval(share.value, share.low, 1.0), 0.0
    more = float((drawn > allowed).mean())
    answer: Literal["yes", "no", "not yet decided"] = "not yet decided"
    if certain >= FAILED or more >= 1.0 - RUNNING:
        answer = "yes" if certain >= FAILED else "no"
    return ShareFailing(age, allowed, share, answer, shown)


def failing_of_followed(
    ending: Sequence[FittedWay], order: IntArray, age: float | None, units: Sequence[AgeAtLimit]
) -> FollowedFailing | None:
    """Return how many of the specimens followed have failed by an age, by any mode; None without an age.

    ``order`` is as from `joint_order`: what all specimens share is common to a draw. ``units`` are the
    ages of first failure: a specimen may fail from `SURE` times the age followed on.
    """
    if age is None:
        return None
    first = np.min([each.ages[order[:, m]] for m, each in enumerate(ending)], axis=0)
    failed = first <= min(age, max(each.shown(FAR) for each in units))
    count = interval(failed.sum(axis=1).astype(float))
    unsure = np.array([each.shown(SURE) for each in units]) < age
    if unsure.any():
        most = interval(failed[:, ~unsure].sum(axis=1).astype(float)).high + unsure.sum()
        count = Interval(count.value, count.low, float(most))
    return FollowedFailing(age, first.shape[1], count)
