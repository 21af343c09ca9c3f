"""What a life test decides of new specimens: a share, an age of replacement, and the runs that would help."""

from __future__ import annotations

import json
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.stats import binom

from hersey.errors import ParameterError
from hersey.life.growth.limit_ages import age_at_limit
from hersey.life.time_to_failure.decided import _replacement
from hersey.life.time_to_failure.deciding_run import DecidingRun, loss_after, loss_after_new
from hersey.life.time_to_failure.estimate import TimeToFailure, time_to_failure
from hersey.life.time_to_failure.failing_before import failing_of_followed, failing_share
from tests.bare_numbers import bare
from tests.life.shipped import fewer
from tests.life.test_time_to_failure import AGE, NAMES, RATE, indicator, linear, of, warned


@pytest.fixture(autouse=True)
def fewer_draws(monkeypatch: pytest.MonkeyPatch) -> None:
    fewer(monkeypatch)


def found(count: int = 6, ages: np.ndarray = AGE[:7], **asked: Any) -> TimeToFailure:
    """Of specimens whose torque reaches its limit at 1 / rate: 333 for F6, else 830 to 1250."""
    names = tuple(f"F{i + 1}" for i in range(count) for _ in ages)
    torque = indicator("torque", linear(RATE[:count], ages), 2.0)
    return time_to_failure(of(torque, names=names, age=np.tile(ages, count)), **asked)


def test_a_share_is_counted_in_each_draw() -> None:
    """Draw i of 100 has i in 200 of its specimens fail at 400, the others at 800."""
    first = np.where(np.arange(200) < np.arange(100)[:, None], 400.0, 800.0)
    at = failing_share(first, 500.0, 0.25, followed=300.0)
    assert (at.share.low, at.share.value, at.share.high) == pytest.approx((0.02, 0.245, 0.47), abs=0.006)
    assert at.answer == "not yet decided"
    assert at.words("pages").startswith("Whether at most 25 % fail is not yet decided: 24 % of new specimens")
    many = failing_share(first, 500.0, 0.48, followed=300.0)
    assert (many.answer, many.words("pages")[:30]) == ("yes", "Yes, at most 48 % fail: 24 % o")
    few = failing_share(first, 500.0, 0.01, followed=300.0)
    assert (few.answer, few.words("")[:33]) == ("no", "No, more than 1 % fail: 24 % of n")
    assert few.words("").endswith("fail before 500 (90 %: 2 % to 47 %).")


def test_far_beyond_the_age_followed_no_share_is_small() -> None:
    first = np.where(np.arange(200) < 20, 400.0, 800.0) * np.ones((100, 1))
    late = failing_share(first, 700.0, 0.2, followed=200.0)
    assert (late.answer, late.share.low, late.share.high) == ("not yet decided", 0.1, 1.0)
    assert "10 % or more of new specimens fail before 700 pages (95 %)" in late.words("pages")
    since = late.advice("pages", 300.0)  # re-greased at 200
    assert since.startswith("follow the specimens to 400 pages without maintenance to decide whether at most")
    assert late.advice("pages", 200.0).startswith(
        "follow the specimens to 400 pages to decide whether at most 20 %"
    )
    assert failing_share(first, 700.0, 0.05, followed=200.0).answer == "no"
    assert failing_share(first, 360.0, 0.05, followed=200.0).answer == "not yet decided"
    assert failing_share(first, 340.0, 0.05, followed=200.0).answer == "yes"


def test_a_run_leaves_the_risk_of_the_normal_law() -> None:
    """Of an age known to 100, read with an error of 100: arctan(sd after / sd of the mean) / pi is left."""
    random = np.random.default_rng(0)
    age = 1000.0 + 100.0 * random.standard_normal(4000)
    early = age <= 1000.0
    loss = np.stack([early, ~early], axis=1).astype(float)
    run = (age - 1000.0) / 100.0 + random.standard_normal(age.size)
    assert loss_after(loss, run[:, None]) == pytest.approx(0.25, abs=0.02)
    assert loss_after(loss, random.standard_normal((4000, 6))) == pytest.approx(
        0.5, abs=0.02
    )  # nothing learnt


def test_new_specimens_leave_the_risk_of_the_binomial_law() -> None:
    """A share of 0.1 or 0.3, as probable: with k of n failed the likelier answer is wrong by Bayes' rule."""
    failing = np.repeat([0.1, 0.3], 500)
    loss = np.stack([failing > 0.2, failing <= 0.2], axis=1).astype(float)
    parts = np.stack([failing, 1.0 - failing], axis=1)
    for size in (1, 5, 20):
        seen = binom.pmf(np.arange(size + 1)[:, None], size, [0.1, 0.3])
        wrong = float(0.5 * seen.min(axis=1).sum())
        left = loss_after_new(loss, parts, size, np.random.default_rng(1))
        assert left == pytest.approx(wrong, abs=0.02)


def test_the_share_is_that_of_the_curve_and_what_would_decide_it_is_said() -> None:
    asked = found(until="1000 pages", share=0.5)
    share, curve = asked.share_failing, asked.curve
    assert share is not None
    assert curve is not None
    for end, of_curve in ((share.share.low, curve.low), (share.share.high, curve.high)):
        assert end == pytest.approx(np.interp(1000.0, curve.age, of_curve), abs=0.05)
    assert share.share.low < 4 / 6 < share.share.high  # F3, at 1000, to F6
    (run,) = asked.deciding_runs
    assert (run.question, run.units, run.age) == ("share", (), 1000.0)
    assert run.after <= 0.5 * run.before
    assert asked.advice[0].startswith(
        f"follow {run.new} new specimens to 1000 pages to decide whether at most 50 % of new specimens fail "
        "before 1000 pages; the risk of a wrong answer falls from "
    )
    assert asked.advice[1] == "inspect F6 for torque"
    assert asked.answers()[0] in asked.summary()


def test_what_fails_of_the_specimens_followed() -> None:
    asked = found(until="900 pages")
    count = asked.followed_failing
    assert count is not None
    assert (count.age, count.specimens) == (900.0, 6)
    assert count.failed.low <= 3 <= count.failed.high  # F6 at 333, F5 at 833, F4 at 909
    assert found(until="400 pages").of_followed() == "1 of 6 specimens fails before 400 pages."
    assert found().of_followed() == ""
    low, high = (f"{each:g}" for each in (count.failed.low, count.failed.high))
    assert f" of 6 specimens fail before 900 pages (90 %: {low} to {high} specimens)." in asked.of_followed()
    assert (
        bare(
            "\n".join(
                [asked.of_followed(), *found(until="900 pages", share=0.3, cost_of_failure=9).answers()]
            )
        )
        == []
    )


def test_a_replacement_is_that_of_the_ages_and_a_run_narrows_it() -> None:
    """Four specimens that last 1000 to 1250 and a cost of 20 leave little to gain late, much to lose."""
    asked = found(4, np.array([0.0, 150.0, 300.0]), cost_of_failure=10.0)
    best = asked.replacement
    assert best is not None
    assert (best.unit, best.until, best.pays) == ("pages", 525.0, "not yet decided")
    (run,) = asked.deciding_runs
    assert run.question == "replacement"
    assert run.units
    assert run.age is not None
    assert 300.0 <= run.age <= 900.0
    assert run.after < 0.85 * run.before
    assert asked.advice[0].startswith(
        f"measure {', '.join(run.units)} again at {run.age:g} pages to decide when"
    )
    assert asked.advice[0].endswith(" of the cost")
    assert asked.planning() == ""
    plain = asked.to_dict()
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    assert asked.to_dict() == found(4, np.array([0.0, 150.0, 300.0]), cost_of_failure=10.0).to_dict()


def test_ages_spread_evenly_over_a_life_are_replaced_at_a_third_of_it() -> None:
    """As in closed form at a cost of 13, which saves 8 of 26; all lives of a draw are longer by a factor."""
    lives = np.linspace(900.0, 1100.0, 101)
    first = lives[:, None] * (np.arange(512) + 0.5) / 512
    best, question = _replacement(first, 500.0, 13.0, "pages")
    assert best.age.value == pytest.approx(1000.0 / 3.0, rel=0.02)
    assert (best.age.low, best.age.high) == pytest.approx(
        (303.0, 363.0), rel=0.05
    )  # near it the cost is level
    assert best.saving.value == pytest.approx(8.0 / 26.0, abs=0.01)
    assert (best.pays, best.until) == ("yes", 875.0)
    assert question.loss.min(axis=1) == pytest.approx(0.0, abs=1e-12)
    assert question.failing.sum(axis=1) == pytest.approx(1.0)


def test_questions_change_nothing_else() -> None:
    plain, asked = found(until="900 pages"), found(until="900 pages", share=0.2, cost_of_failure=5.0)
    assert (plain.units, plain.b50, plain.next_runs) == (asked.units, asked.b50, asked.next_runs)
    assert plain.answers() == []


def test_fewer_than_four_specimens_answer_nothing_and_say_so() -> None:
    asked = time_to_failure(
        of(indicator("torque", linear(RATE[:3]), 2.0), names=NAMES[:21], age=AGE[:21]),
        until="900 pages",
        share=0.05,
        cost_of_failure=10.0,
    )
    assert (asked.share_failing, asked.replacement, asked.deciding_runs) == (None, None, ())
    assert warned(asked)["share unknown"].sentence == (
        "Whether at most 5 % of new specimens fail before 900 pages cannot be determined from 3 specimens. "
        "Follow four specimens or more."
    )
    assert warned(asked)["replacement age unknown"].values == {"specimens": 3}


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"share": 0.05}, "share needs the age: add until='200000 pages'"),
        ({"share": 5.0, "until": 900}, "share is 500 %: it must be at least 1 % and below 100 %"),
        (
            {"cost_of_failure": 1.0},
            "cost_of_failure is 1: it must be above 1 and at most 100. It is the cost",
        ),
        ({"cost_of_failure": 200.0}, "at most 100, as a life test does not show when the first hundredth"),
        (
            {"share": 0.001, "until": 900},
            "share is 0.1 %: it must be at least 1 % and below 100 %, as a life",
        ),
        ({"share": "5 %", "until": 900}, "share is "),
        ({"cost_of_failure": [2.0, 3.0]}, "cost_of_failure "),
        ({"cost_of_failure": math.nan}, "cost_of_failure is NaN: it must be a number"),
    ],
)
def test_what_cannot_be_asked_is_refused(asked: dict[str, Any], said: str) -> None:
    with pytest.raises(ParameterError, match=said.replace(".", r"\.")):
        found(**asked)


def test_of_specimens_followed_a_shorter_time_it_is_unknown_how_many_fail() -> None:
    """One of three was followed to 300, the others to 100: by 200 these two may have failed."""
    ages = np.tile([1000.0, 1000.0, 1000.0], (20, 1))
    ending: Any = [SimpleNamespace(ages=ages)]
    order = np.arange(20)[:, None]
    units = [age_at_limit("", ages[:, 0], last) for last in (300.0, 100.0, 100.0)]
    at = failing_of_followed(ending, order, 200.0, units)
    assert at is not None
    assert (at.failed.value, at.failed.low, at.failed.high) == (0.0, 0.0, 2.0)
    sooner = failing_of_followed(ending, order, 150.0, units)
    assert sooner is not None
    assert sooner.failed.high == 0.0
    # followed to 300, but re-greased at 250: it may fail from 250 + 1.75 * 50 = 337.5 on
    units[0] = age_at_limit("", ages[:, 0], 300.0, begun=250.0)
    of_greased = [failing_of_followed(ending, order, age, units) for age in (337.0, 338.0)]
    assert [each and each.failed.high for each in of_greased] == [2.0, 3.0]


def test_a_question_that_takes_too_many_says_so() -> None:
    run = DecidingRun("share", (), 0, 500.0, 0.3, 0.3)
    assert run.words("pages", "whether it holds") == (
        "follow more than 50 new specimens to 500 pages to decide whether it holds; the risk of a wrong "
        "answer is 30 %"
    )
