"""What ends specimens: truths in closed form, which way is first, what cannot be determined."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from hersey.errors import InsufficientDataError, ParameterError, UnitError
from hersey.life.growth import fit as growth_module
from hersey.life.growth import limit_ages, marginal
from hersey.life.growth.fit import fit_growth
from hersey.life.growth.limit_ages import age_at_limit, percent, rounded
from hersey.life.indicator import NOT_JUDGED, Indicator, Indicators, OwnAges, Runs
from hersey.life.maintenance import Followed
from hersey.life.time_to_failure import ageing, joined, next_run
from hersey.life.time_to_failure.estimate import TimeToFailure, time_to_failure
from hersey.life.time_to_failure.first import ends_of_specimens
from hersey.schema.warning import Warning
from tests.life.shipped import fewer

UNITS, AGES = 6, np.linspace(0.0, 600.0, 7)
RATE = np.array([0.0008, 0.0009, 0.0010, 0.0011, 0.0012, 0.0030])
AGE = np.tile(AGES, UNITS)
NAMES = tuple(f"F{i + 1}" for i in range(UNITS) for _ in AGES)


def indicator(name: str, value: np.ndarray, limit: float, seed: int = 1, **more: Any) -> Indicator:
    """With 1 % of noise."""
    noise = np.random.default_rng(seed).normal(0.0, 0.01, value.shape)
    return Indicator(name, name, "1", limit, value * np.exp(noise), np.full(value.shape, 0.003), **more)


def linear(rate: np.ndarray, ages: np.ndarray = AGES) -> np.ndarray:
    return np.asarray(1.0 + rate[:, None] * ages).ravel()


def of(*each: Indicator, names: tuple[str, ...] = NAMES, age: np.ndarray = AGE, **more: Any) -> Indicators:
    return Indicators(Runs(tuple(range(1, len(names) + 1)), names, age, "pages"), each, **more)


@pytest.fixture(autouse=True)
def fewer_draws(monkeypatch: pytest.MonkeyPatch) -> None:
    fewer(monkeypatch)


def warned(found: TimeToFailure) -> dict[str, Warning]:
    """The warnings that concern all failure modes, by kind."""
    return {each.kind: each for each in found.warnings if not each.where}


@cache
def six_specimens() -> TimeToFailure:
    """Torque reaches 2 at 1 / rate, film 3 at 2.2 / rate, in F1 at 1 / rate too; a sign at 0.3 / rate."""
    film = RATE / 1.1
    film[0] = 2.0 * RATE[0]
    torque = indicator("torque", linear(RATE), 2.0)
    other = indicator("film", linear(film), 3.0, seed=2)
    early = indicator("noise", linear(RATE), 1.3, seed=3)
    grip = indicator("grip", np.where(AGE == 0.0, 1.0, np.nan), 2.0)
    object.__setattr__(early, "sign", True)
    return time_to_failure(
        of(torque, other, early, grip, warnings=(Warning(NOT_JUDGED, "no table [motor]", where="heat"),))
    )


def test_the_first_end_is_found_with_its_way() -> None:
    for end, rate in zip(six_specimens().units[1:], RATE[1:], strict=True):
        assert end.named == ("torque",)
        assert end.age.age.low <= 1.02 / rate
        assert end.age.age.high >= 0.98 / rate
        assert end.age.age.value == pytest.approx(1.0 / rate, rel=0.1)
    assert six_specimens().b50.age.value == pytest.approx(1.0 / np.median(RATE), rel=0.35)


def test_where_two_ways_are_near_both_are_named() -> None:
    first = six_specimens().units[0]
    assert set(first.named) == {"torque", "film"}
    assert sum(first.first.values()) == pytest.approx(1.0)
    assert set(first.likely) == {"torque", "film"}
    assert [each.likely for each in six_specimens().units[1:]] == [("torque",)] * 5


def test_an_early_sign_ends_no_unit() -> None:
    assert [mode.name for mode in six_specimens().modes] == ["torque", "film", "noise"]
    assert [mode.name for mode in six_specimens().ending] == ["torque", "film"]
    assert all("noise" not in end.first for end in six_specimens().units)
    assert "noise (a precursor, not a failure)" in six_specimens().summary()


def test_a_specimen_has_failed_only_if_that_is_nearly_certain() -> None:
    assert six_specimens().units[5].age.passed > 0.99
    assert [each.state for each in six_specimens().units] == ["running"] * 5 + ["failed"]
    assert "already passed (last seen at 600)" in str(six_specimens().units[5])
    ages = np.where(np.arange(100) < 83, 500.0, 700.0)
    doubtful = age_at_limit("F7", ages, 600.0)
    assert (doubtful.state, doubtful.passed) == ("unclear", 0.83)
    assert "passed with a probability of 83 % (last seen at 600)" in str(doubtful)
    states = [age_at_limit("", np.arange(100.0), last).state for last in (4.0, 5.0, 93.0, 94.0)]
    assert states == ["running", "unclear", "unclear", "failed"]


def test_the_headline_says_who_needs_attention_and_what_the_others_reach() -> None:
    attention = six_specimens().attention
    assert (attention.failed, attention.unclear) == (("F6",), ())
    assert attention.running == ("F5", "F4", "F3", "F2", "F1") or attention.running[-1] == "F2"
    least = min(each.age.age.low for each in six_specimens().units[:5])
    assert attention.look_again == least
    assert six_specimens().headline() == (
        "One specimen needs attention: F6 has probably failed. "
        f"The other five should reach at least {rounded(least)} pages."
    )
    half = six_specimens().b50.age
    assert six_specimens().of_new() == (
        f"Half of new specimens fail by {rounded(half.value)} pages (90 %: "
        f"{rounded(half.low)} to {rounded(half.high)} pages), mostly by torque."
    )
    doubtful = replace(attention, failed=(), unclear=("F6", "F2"), running=("F1",))
    assert doubtful.words("pages")[0] == "Two specimens need attention: F6 and F2 may have failed."
    fine = replace(attention, failed=(), running=("F1", "F2"))
    assert fine.words("")[0] == "No specimen needs attention."
    assert fine.words("")[1].startswith("All two should reach at least ")


@cache
def few() -> TimeToFailure:
    """Three specimens of those above."""
    return time_to_failure(of(indicator("torque", linear(RATE[:3]), 2.0), names=NAMES[:21], age=AGE[:21]))


def test_fewer_than_four_specimens_are_no_population() -> None:
    found = few()
    assert (found.b10, found.b50, found.shares, found.curve, found.of_new()) == (None,) * 4 + ("",)
    plain = found.to_dict()
    assert [plain[name] for name in ("b10", "b50", "shares", "curve")] == [None] * 4
    assert [plain["modes"][0]["ages"][name] for name in ("b10", "b50")] == [None] * 2
    assert warned(found)["few specimens"].values == {"specimens": 3}
    assert "B10 and B50 are not given. Follow four specimens or more" in found.summary()
    assert "B50" not in found.summary().replace("B10 and B50 are not given", "")
    assert found.to_frame().height == 3 * 2


def test_what_cannot_be_judged_keeps_its_reason() -> None:
    stated, grip = (each for each in six_specimens().warnings if each.kind == NOT_JUDGED)
    assert str(stated) == "heat: no table [motor]"
    assert grip.where == "grip"
    assert str(grip.values["reason"]).startswith("no specimen was measured at two ages")
    assert "\nheat is not judged. No table [motor].\n" in six_specimens().summary()
    with pytest.raises(InsufficientDataError, match="Grip: No run shows it"):
        time_to_failure(of(indicator("grip", np.full(AGE.size, np.nan), 2.0)))


def test_where_nothing_can_be_judged_the_reason_of_most_modes_comes_first() -> None:
    once = np.where(AGE == 0.0, 1.0, np.nan)
    each = [indicator(name, once, 2.0) for name in ("torque", "film", "grip")]
    stated = Warning(NOT_JUDGED, "no table [motor]", where="heat", remedy="add [motor]")
    with pytest.raises(InsufficientDataError) as refused:
        time_to_failure(of(*each, warnings=(stated,)))
    assert str(refused.value) == (
        "no failure mode can be judged. 3 failure modes: No specimen was measured at two ages, so its growth "
        "is unknown. Add runs at another age. Heat: No table [motor]. Add [motor]."
    )


def test_the_result_is_whole_and_the_same_again() -> None:
    plain = six_specimens().to_dict()
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    frame = six_specimens().to_frame()
    assert frame.height == UNITS * 4 + 2
    assert frame["age (pages)"][0] == six_specimens().modes[0].ages.units[0].age.value
    curve = six_specimens().curve
    assert (np.diff(curve.median) >= 0.0).all()
    assert (curve.low <= curve.median).all()
    assert (curve.median <= curve.high).all()
    assert np.interp(six_specimens().b50.age.value, curve.age, curve.median) == pytest.approx(0.5, abs=0.05)


def test_the_same_data_and_seed_give_the_same_ends() -> None:
    few = of(indicator("torque", linear(RATE[:2]), 2.0), names=NAMES[:14], age=AGE[:14])
    calls: list[tuple[int, int]] = []
    once = time_to_failure(few, seed=4, progress=lambda done, every: calls.append((done, every)))
    assert once.to_dict() == time_to_failure(few, seed=4).to_dict()
    assert calls == [(1, 1)]
    assert warned(once)["few specimens"].values == {"specimens": 2}
    assert "2 specimens show too little of how specimens differ" in once.summary()


@cache
def flat(by: float = 1.0) -> TimeToFailure:
    """Two modes of which none grows, followed to 600 pages, times a factor."""
    steady = np.ones(AGE.size)
    return time_to_failure(
        of(indicator("torque", steady, 1.5), indicator("grip", steady, 2.0, seed=2), age=by * AGE), until=1e4
    )


def test_where_nothing_grows_it_is_said_and_before_which_age_none_fails() -> None:
    found = flat().ageing
    assert (found.shown, found.unchanged, found.followed) == ("none", ("torque", "grip"), 600.0)
    assert found.none_before is not None
    assert found.none_before == 1050.0  # 1.75 times the age followed: more, no run shows
    assert not flat().modes[0].grows
    assert flat().modes[0].none_before >= found.none_before
    assert all(math.isinf(each.age.age.value) and each.age.age.low > 600.0 for each in flat().units)
    assert flat().headline().startswith("No specimen shows growth. At 90 % confidence none fails before ")
    text = flat().summary()
    assert "never" not in text
    assert "F1: later than" in text
    assert "next: follow the specimens to" in text


def test_the_test_goes_on_as_far_as_it_is_told_to() -> None:
    """As many runs up to the age that the advice states, again without growth, show the goal."""
    found = flat().ageing
    assert found.goal == 1e4
    assert found.enough is False
    assert found.until is not None
    assert flat().advice == (
        f"follow the specimens to {ageing.after(found.until, 'pages')}. If nothing grows by then, none "
        "fails before 10,000 pages",
    )
    longer = flat(1.0001 * found.until / 600.0)
    assert longer.ageing.enough
    assert longer.advice == ("stop the test: none fails before 10,000 pages",)


def test_a_mode_that_does_not_grow_says_so_beside_one_that_does() -> None:
    steady = indicator("grip", np.ones(AGE.size), 2.0, seed=2)
    found = time_to_failure(of(indicator("torque", linear(RATE), 2.0), steady))
    assert (found.ageing.shown, found.ageing.unchanged) == ("some", ("grip",))
    assert found.ageing.doubled is None
    row = next(line for line in found.summary().split("\n") if line.startswith("  grip"))
    assert row.startswith("  grip: B50: later than ")
    assert row.endswith(", no growth shown")


def test_a_unit_that_tells_nothing_is_one_of_the_others() -> None:
    value = linear(RATE[:4])
    value[-7:] = np.nan
    found = time_to_failure(of(indicator("torque", value, 2.0), names=NAMES[:28], age=AGE[:28]))
    (of_torque,) = (each for each in found.warnings if each.kind == "specimens without a value")
    assert (of_torque.where, of_torque.values) == ("torque", {"specimens": "F4"})
    assert "- torque: no run of F4 shows it. Such specimens are treated like any new one" in found.summary()
    wide, narrow = (found.units[i].age.age for i in (3, 0))
    assert wide.high / wide.low > 1.4 * narrow.high / narrow.low


def test_far_and_wide_ends_are_said() -> None:
    """Two specimens that have hardly begun to grow: neither law nor spread nor age is known."""
    names, age = ("A",) * 4 + ("B",) * 4, np.tile([0.0, 10.0, 20.0, 30.0], 2)
    value = linear(np.array([0.002, 0.003]), age[:4])
    ends = time_to_failure(of(indicator("torque", value, 2.0), names=names, age=age))
    found = warned(ends)
    assert found["law of growth unknown"].values == {"modes": "torque"}
    assert [(each.age.age.low <= 90.0, each.age.age.high) for each in ends.units] == [(True, math.inf)] * 2
    assert "age uncertain" not in found  # beyond three times the age followed that goes without saying
    assert found["end far off"].values["factor"] == 3.0
    assert "beyond 3 times the age followed" in str(found["end far off"])


@pytest.fixture
def laws_hold_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if a law held beyond the last run as it did up to there."""
    monkeypatch.setattr(limit_ages, "BEYOND", 0.0)
    monkeypatch.setattr(limit_ages, "OWN_BEYOND", 0.0)


def test_beyond_the_last_run_a_law_is_less_sure() -> None:
    """The logarithm of an age over that of the last run is known to a factor: two t4 of 0.12 each."""
    tails = 0.12 * np.random.default_rng(0).standard_t(4.0, (2, 200_000)).clip(-5.0, 5.0).sum(axis=0)
    factor = math.exp(np.quantile(tails, 0.95))
    growth = fit_growth(NAMES, AGE, linear(RATE), 1e-4, laws=["linear"])
    for each, r in zip(growth.reaches(2.0).units, RATE, strict=True):
        ahead = 1.0 / r / each.last
        if ahead > 1.0:
            middle = math.log(ahead)
            assert math.log(each.age.value / each.last) == pytest.approx(middle, rel=0.03)
            assert math.log(each.age.high / each.last) == pytest.approx(factor * middle, rel=0.06)
            assert math.log(each.age.low / each.last) == pytest.approx(middle / factor, rel=0.06)
        else:
            assert each.age.high - each.age.low < 0.01 / r
    curves = growth.at([1.5 * AGE.max()])
    assert (curves.high > 1.05 * curves.low).all()


@pytest.mark.usefixtures("laws_hold_on")
def test_what_accumulates_is_summed_over_age() -> None:
    """1e-3 (1 + r t) sums to 1e-3 (t + r t^2 / 2); the limit 2 is reached at the root of that."""
    growth = fit_growth(NAMES, AGE, 1e-3 * linear(RATE), 1e-3, laws=["linear"])
    for each, r in zip(growth.reaches(2.0, accumulates=True).units, RATE, strict=True):
        assert each.age.value == pytest.approx((math.sqrt(1.0 + 4000.0 * r) - 1.0) / r, rel=1e-3)
    steady = fit_growth(["A"] * 3, [0, 1, 2], [0.5] * 3, 1e-3, laws=["constant"])
    assert steady.reaches(3.0, accumulates=True).units[0].age.value == pytest.approx(6.0, rel=1e-3)


@pytest.mark.parametrize("law", [law.name for law in growth_module.LAWS])
def test_the_integral_of_each_law_is_that_of_its_curve(law: str) -> None:
    """Summed anew by the trapezium rule, also where a layer dries out soon after."""
    found_law = next(each for each in growth_module.LAWS if each.name == law)
    shapes = np.array([[[-0.9], [-0.3], [0.1], [1.0]]] * len(found_law.shapes)).reshape(-1, 4, 1)
    units = marginal.Specimens(
        found_law, np.zeros((4, 3)), np.array([[-2.0, 0.0, 1.0]] * 4), shapes, np.ones((4, 1))
    )
    found = limit_ages.ages_of_sum(units, np.full((4, 1), math.log(1.7)))
    for i, j in np.ndindex(found.shape):
        t = np.linspace(0.0, found[i, j], 20_001)
        x, a = units.size[i, j], units.shape[:, i]
        path = np.exp(units.law.log_growth(np.array(x), t, a))
        # Within 2e-3 of the age, however steeply the sum rises there.
        assert np.trapezoid(path, t) == pytest.approx(1.7, abs=2e-3 * max(1.0, path[-1] * found[i, j]))


@pytest.mark.usefixtures("laws_hold_on")
def test_a_limit_that_is_known_badly_widens_the_age() -> None:
    growth = fit_growth(NAMES, AGE, linear(RATE), 1e-3, laws=["linear"])
    sharp, vague = (growth.reaches(2.0, limit_error=e).units[2].age for e in (0.0, 0.05))
    # d ln t / d ln limit is 2 / (2 - 1) on a line from 1: 10 % of 1000, times 2 x 1.645.
    assert vague.high - vague.low == pytest.approx(329.0, rel=0.1)
    assert sharp.high - sharp.low < 0.2 * (vague.high - vague.low)
    with pytest.raises(ParameterError, match="must not be negative"):
        growth.reaches(2.0, limit_error=-1.0)


def test_runs_that_scatter_together_move_together() -> None:
    random = np.random.default_rng(0)
    one, other = random.standard_normal((2, 400))
    third = 0.8 * one + 0.6 * other
    found = joined.correlations([one, other, np.where(np.arange(400) < 300, third, np.nan)])
    assert found[0, 1] == pytest.approx(0.0, abs=0.01)
    assert found[0, 2] == pytest.approx(0.8, abs=0.05)
    keys = random.exponential(size=(4000, 3))
    order = joined.order_by(keys, joined.ranks_of(4000, found, random))
    joint = np.take_along_axis(keys, order, axis=0)
    assert np.corrcoef(np.log(joint).T)[0, 2] == pytest.approx(0.75, abs=0.08)
    assert np.sort(joint, axis=0) == pytest.approx(np.sort(keys, axis=0))


def test_a_run_lowers_the_risk_of_a_wrong_answer_as_the_normal_law_says() -> None:
    """Of an age known to 100, read with an error of 100: arctan(sd after / sd of the mean) / pi is left."""
    random = np.random.default_rng(0)
    age = 1000.0 + 100.0 * random.standard_normal(2000)
    value, error = np.stack([age, 0.0 * age], axis=1), np.full((age.size, 1), 100.0)
    event = age <= 1000.0
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(next_run, "_RUNS", 500)
        once = next_run.wrong_after(event, [value], [error], np.eye(1), random)
        assert once == pytest.approx([0.25, 0.5], abs=0.03)
        twice = next_run.wrong_after(event, [value, value], [error, error], np.eye(2), random)
        assert twice[0] == pytest.approx(math.atan(math.sqrt(0.5)) / math.pi, abs=0.03)
        together = np.array([[1.0, 0.9999], [0.9999, 1.0]])
        same = next_run.wrong_after(event, [value, value], [error, error], together, random)
        assert same[0] == pytest.approx(0.25, abs=0.03)


def test_what_to_measure_next_serves_what_was_asked() -> None:
    """F1 to F5 reach the limit at 1250 to 830: whether they last until 1000 is in doubt, for F6 it is not."""
    torque = indicator("torque", linear(RATE), 2.0)
    found = time_to_failure(of(torque), until="1000 pages")
    assert found.until == 1000.0
    assert {run.unit for run in found.next_runs} <= {"F1", "F2", "F3", "F4", "F5"}
    assert "F3" in {run.unit for run in found.next_runs}
    gains = [run.before - run.after for run in found.next_runs]
    assert gains == sorted(gains, reverse=True)
    assert all(600.0 <= run.age <= 1000.0 and run.after < 0.85 * run.before for run in found.next_runs)
    (of_f3,) = (run for run in found.next_runs if run.unit == "F3")
    assert of_f3.words("pages") == (
        f"measure F3 again at {of_f3.age:g} pages to find out whether it lasts until 1000 pages; "
        f"the risk of a wrong answer falls from {percent(of_f3.before)} to about {percent(of_f3.after)}"
    )
    assert found.advice[0] == found.next_runs[0].words("pages")  # what was asked comes first
    assert found.advice[-1] == "inspect F6 for torque"
    assert found.planning() == ""
    assert time_to_failure(of(torque), until=1000).next_runs == found.next_runs


def test_without_a_date_runs_settle_what_is_unclear() -> None:
    """At 1010 pages U3 may have reached the limit, the others have or have not."""
    rate = np.array([0.0006, 0.0007, 0.00100, 0.0018])
    ages = np.linspace(0.0, 1010.0, 7)
    values = indicator("torque", linear(rate, ages), 2.0)
    names = tuple(f"U{i + 1}" for i in range(4) for _ in ages)
    found = time_to_failure(of(values, names=names, age=np.tile(ages, 4)))
    assert [each.state for each in found.units] == ["running", "running", "unclear", "failed"]
    (run,) = found.next_runs
    assert (run.unit, run.present, run.until, run.mode) == ("U3", True, 1010.0, "torque")
    assert run.after < run.before
    assert found.advice[0] == "inspect U4 for torque"
    assert "to find out whether it has failed (torque)" in found.advice[1]
    assert found.planning().endswith("last until an age, add until='1500 pages'.")
    assert time_to_failure(of(values, names=names, age=np.tile(ages, 4)), until="1500 pages").until == 1500.0


@pytest.mark.parametrize(
    ("until", "said"),
    [("300 h", "until: an age is in h"), ("soon", "until: age 'soon'"), (0, "must be greater than 0")],
)
def test_an_age_that_cannot_be_asked_for_is_refused(until: Any, said: str) -> None:
    with pytest.raises((ParameterError, UnitError), match=said):
        time_to_failure(of(indicator("torque", linear(RATE), 2.0)), until=until)


def test_ages_by_a_law_of_its_own_stand_in_the_place_of_growth() -> None:
    own = OwnAges(np.full((50, len(RATE)), 123.0), np.full((50, 20), 456.0))
    found = time_to_failure(of(indicator("torque", linear(RATE), 2.0, own_ages=own)))
    assert {each.age.age.value for each in found.units} == {123.0}
    assert found.b50.age.value == 456.0


def test_of_a_specimen_seen_only_when_new_no_more_is_shown_than_of_the_others() -> None:
    names = (*("A",) * 4, *("B",) * 4, "N")
    age = np.append(np.tile([0.0, 10.0, 20.0, 30.0], 2), 0.0)
    value = np.append(linear(np.array([0.004, 0.005]), age[:4]), 1.0)
    found = time_to_failure(of(indicator("torque", value, 2.0), names=names, age=age))
    new, own = found.units[2], found.modes[0].ages.units[2]
    assert (new.unit, new.age.last) == ("N", 0.0)
    assert new.age.age.value > 90.0
    assert new.age.age.low <= 1.75 * 30.0
    assert (new.age.age.high, own.age.high) == (math.inf, math.inf)
    assert own.age.low <= 1.75 * 30.0


def test_where_most_draws_never_come_the_interval_begins_at_the_earliest_age() -> None:
    ages = np.where(np.arange(100) < 2, 900.0, np.inf)
    assert limit_ages.age_at_limit("U", ages, earliest=700.0).age.low == 700.0
    assert limit_ages.age_at_limit("U", ages, earliest=800.0, greatest=400.0).age.low == 1.75 * 400.0


@pytest.mark.parametrize(
    ("share", "later", "close"), [(25, 1.24, True), (15, 1.24, False), (25, 1.26, False)]
)
def test_a_mode_is_close_that_may_come_soon_after_the_first(share: int, later: float, close: bool) -> None:
    """From 20 % of the draws on in which it comes up to 25 % later."""
    first, second = np.full((100, 1), 100.0), np.full((100, 1), 1000.0)
    second[:share] = later * 100.0
    followed = Followed.from_new({"U": 80.0})
    ways: list[Any] = [
        SimpleNamespace(
            ages=ages,
            order=np.argsort(ages, axis=0, kind="stable"),
            earliest=limit_ages.Earliest.unknown(1),
            followed=followed,
            mode=SimpleNamespace(name=name),
        )
        for name, ages in (("torque", first), ("film", second))
    ]
    ends, _ = ends_of_specimens(ways, np.eye(2), ["U"], followed.last, np.random.default_rng(0))
    assert ends[0].near == (("torque", "film") if close else ("torque",))
