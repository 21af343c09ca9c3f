"""Ages in other uses: the stated one as in the report, and each change moves them the right way."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import hersey
from hersey.errors import ParameterError
from hersey.life import other_uses as module
from hersey.life.growth.limit_ages import Interval
from hersey.life.indicator import Indicator
from hersey.life.indicators import load_cases
from hersey.life.other_uses import AS_STATED, OtherUses, Use, UseEnd, other_uses
from hersey.machine.duty import LifeTable
from hersey.machine.machine import Machine
from tests.life import shipped


def machine() -> Machine:
    """One limit of the torque, and one that hangs on the duty."""
    limits = hersey.Limits(motor_torque=1.0)
    return replace(shipped.machine(), limits=limits, life=LifeTable(continuous_torque=0.3))


@pytest.fixture(scope="module")
def told() -> tuple[OtherUses, hersey.TimeToFailure]:
    with pytest.MonkeyPatch.context() as patch:
        shipped.fewer(patch)
        patch.setattr(module, "_LIMITS", (1.0, 1.25))
        patch.setattr(load_cases, "OTHER_STARTS", (-10.0,))
        found = hersey.indicators_of(shipped.opened(2), machine(), signs=False)
        return other_uses(shipped.opened(2), machine(), found), hersey.time_to_failure(found)


def by_hand() -> OtherUses:
    """Two limits and two starts, of one specimen."""
    uses = []
    for start in (323.15, 333.15):
        for limit in (1.0, 1.25):
            age = 1e5 * limit * (start - 273.15) / 60.0
            span = Interval(age, 0.8 * age, 1.3 * age)
            stated = limit == 1.0 and start == 333.15
            end = UseEnd("U1", span, "motor torque")
            uses.append(Use(limit, start, AS_STATED, stated, (end,), span, span))
    return OtherUses("pages", (1.0, 1.25), (323.15, 333.15), (AS_STATED,), tuple(uses))


def half(use: Use) -> float:
    assert use.half is not None
    return use.half.value


def test_the_stated_use_is_told_with_the_numbers_of_the_report(
    told: tuple[OtherUses, hersey.TimeToFailure],
) -> None:
    uses, found = told
    (stated,) = [use for use in uses.uses if use.stated]
    assert stated.torque_limit == 1.0
    assert stated.duty == AS_STATED
    assert [end.age for end in stated.ends] == [each.age.age for each in found.units]
    assert (stated.b10, stated.b50) == (None, None)  # two specimens are no population
    assert stated.half == min((each.age.age for each in found.units), key=lambda age: age.value)
    assert [end.ways for end in stated.ends[:2]] == [each.ways for each in found.units]


def test_more_torque_is_later_and_a_colder_start_sooner(told: tuple[OtherUses, hersey.TimeToFailure]) -> None:
    uses, _ = told
    assert len(uses.uses) == 2 * 2 * (1 + len(machine().points))
    at = {(use.torque_limit, use.coldest, use.duty): half(use) for use in uses.uses}
    cold, warm = uses.coldest
    assert warm - cold == pytest.approx(10.0)
    for duty in uses.duties:
        for start in uses.coldest:
            ages = [at[limit, start, duty] for limit in uses.torque_limits]
            assert all(less <= more for less, more in pairwise(ages))
        for limit in uses.torque_limits:
            assert at[limit, cold, duty] <= 1.01 * at[limit, warm, duty]  # one fit for each
    assert at[1.0, cold, AS_STATED] < 0.9 * at[1.25, warm, AS_STATED]


def test_a_duty_moves_what_sums_over_the_points(told: tuple[OtherUses, hersey.TimeToFailure]) -> None:
    uses, _ = told
    assert uses.duties == (AS_STATED, *(point.name for point in machine().points))
    at = {
        use.duty: half(use) for use in uses.uses if (use.torque_limit, use.coldest) == (1.25, uses.coldest[1])
    }
    one, other = (at[point.name] for point in machine().points)
    assert one != other
    assert min(one, other) <= at[AS_STATED] <= max(one, other)


def test_nothing_to_change_is_said() -> None:
    bare = replace(shipped.machine(), limits=hersey.Limits())
    found = hersey.Indicators(hersey.Runs((1,), ("U1",), np.zeros(1), "pages"), ())
    with pytest.raises(ParameterError, match=r"motor_torque in \[limits\]"):
        other_uses(shipped.opened(2), bare, found)


def test_each_limit_of_the_torque_has_an_age_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """Torque of 1 N m when new grows by 1 mN m a page: it is at 1.3 N m after 300 pages, at 1.6 after 600."""
    shipped.fewer(monkeypatch)
    ages = np.tile(np.linspace(0.0, 800.0, 9), 4)
    noise = np.random.default_rng(1).normal(0.0, 0.003, ages.size)
    runs = hersey.Runs(tuple(range(36)), tuple(f"F{i // 9}" for i in range(36)), ages, "pages")
    torque = (1.0 + 1e-3 * ages) * np.exp(noise)
    motor = Indicator("motor torque, cold", "motor torque", "N m", 1.0, torque, np.full(36, 0.003))
    ways = module._Ways({motor.name: 0}, 0)
    for limit, age in ((1.3, 300.0), (1.6, 600.0), (1.3, 300.0)):
        ends, b10, b50 = ways.ends(hersey.Indicators(runs, (motor,)), limit)
        assert [end.age.value for end in ends] == pytest.approx([age] * 4, rel=0.03)
        assert b10 is not None
        assert b50 is not None
        assert b10.value <= b50.value == pytest.approx(age, rel=0.05)
