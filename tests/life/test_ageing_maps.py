"""Maps of a specimen through its life: against the truth of the shipped campaign, and what is carried on."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import hersey
from hersey.errors import InsufficientDataError, ParameterError
from hersey.life.ageing_maps import AgeingMaps, ageing_maps, carried_on
from hersey.life.growth.limit_ages import AgeAtLimit, Interval
from hersey.machine.limits import OperatingPoint
from hersey.testbench import population
from hersey.testbench.drive import example_drive
from hersey.units import ZERO_CELSIUS
from tests.conftest import made_once
from tests.life import shipped


def told(unit: str, age: float, passed: float = 0.0) -> Any:
    """What `TimeToFailure` says of one specimen, no growth of its torque among it."""
    end = SimpleNamespace(
        unit=unit, age=AgeAtLimit(unit, Interval(age, 0.9 * age, 1.1 * age), 0.0, 170e3, passed)
    )
    return SimpleNamespace(units=(end,), modes=(), age_unit="pages")


@cache
def maps() -> AgeingMaps:
    return made_once(
        "ageing-maps", lambda: ageing_maps(shipped.opened(1), shipped.machine(), told("U1", 230e3))
    )


def test_what_grows_with_the_clock_is_carried_on_with_it() -> None:
    clock = np.array([0.0, 0.3, 0.4, 1.0])
    rates = np.array([[0.5, 1.0], [2.0, -1.0]])
    log_torque = 0.7 + clock[:, None, None] * rates
    assert carried_on(log_torque, clock, 1.7) == pytest.approx(0.7 + 1.7 * rates)
    assert carried_on(log_torque, np.zeros(4), 1.7) == pytest.approx(log_torque[-1])


def test_the_maps_are_those_of_the_truth() -> None:
    """Torque within 1 % for the most part, 8 % at the corners; the transition within 16 %."""
    unit = population(*example_drive(), units=1, seed=3)[0]
    found = maps()
    assert found.when == ("new", "now", "end")
    assert found.ages.tolist() == [0.0, 170e3, 230e3]
    for index, age in enumerate(found.ages[:2].tolist()):
        truth = unit.at(age)
        kelvin, rolls = np.meshgrid(found.temperature, found.speed / found.roll_radius, indexing="ij")
        exact = truth.torque(rolls, kelvin - ZERO_CELSIUS)
        off = np.abs(found.torque[index] / exact - 1.0)
        assert np.median(off) < 0.01
        assert off.max() < 0.08
        hot = truth.transition_speed(found.temperature[-3:] - ZERO_CELSIUS) * found.roll_radius
        assert found.transition[index, -3:] == pytest.approx(hot, rel=0.16)
    end = unit.at(230e3).torque(np.array(40.0 / 3.0), np.array(60.0))
    assert found.torque[2, 0, -5:].max() == pytest.approx(float(end), rel=0.25)  # by age alone


def test_a_state_is_that_of_its_region() -> None:
    speeds = np.array([0.01, 0.02, 0.04, 0.08])
    own = replace(
        maps(),
        temperature=np.array([400.0, 450.0]),
        speed=speeds,
        torque=np.array([[[0.5, 0.4, 0.6, 1.2]] * 2]),
        transition=np.array([[0.015, 0.015]]),
        upper=np.array([[0.03, 0.03]]),
        ages=np.array([0.0]),
        when=("new",),
    )
    states = [own.state(0, OperatingPoint("p", v, 420.0)) for v in (0.012, 0.02, 0.04, 0.075)]
    assert states == ["stick-slip", "depends on start", "smooth", "motor stops"]
    assert replace(own, torque_limit=None).state(0, OperatingPoint("p", 0.075, 420.0)) == "smooth"


def test_a_unit_that_has_ended_has_no_end_ahead() -> None:
    found = ageing_maps(shipped.opened(1), shipped.machine(), told("U1", 150e3, passed=1.0))
    assert found.when == ("new", "now")


def test_what_cannot_be_drawn_is_told() -> None:
    with pytest.raises(ParameterError, match=r"no specimen 'U11'. Did you mean 'U1'"):
        ageing_maps(shipped.opened(1), shipped.machine(), told("U1", 230e3), unit="U11")
    with pytest.raises(InsufficientDataError, match="runs of U7 do not show how torque"):
        ageing_maps(shipped.opened(1), shipped.machine(), told("U7", 230e3))


def test_it_says_what_the_points_meet() -> None:
    text = maps().summary()
    assert "thick paper, 45 mm/s at 180 degC: new " in text
    frame = maps().to_frame()
    assert frame.height == 3 * maps().temperature.size
    assert isinstance(hersey.AgeingMaps, type)
