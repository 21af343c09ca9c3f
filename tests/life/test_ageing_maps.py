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
from hersey.life.indicators.torque_surface import RunDwells
from hersey.life.map_edges import edges_of, measured_at
from hersey.machine.limits import OperatingPoint
from hersey.testbench import population
from hersey.testbench.drive import example_drive
from hersey.units import ZERO_CELSIUS
from tests.conftest import made_once
from tests.life import shipped


def failing(unit: str, age: float, passed: float = 0.0) -> Any:
    """What `TimeToFailure` says of one specimen, no growth of its torque among it."""
    end = SimpleNamespace(
        unit=unit, age=AgeAtLimit(unit, Interval(age, 0.9 * age, 1.1 * age), 0.0, 170e3, passed)
    )
    return SimpleNamespace(units=(end,), modes=(), age_unit="pages")


@cache
def maps() -> AgeingMaps:
    return made_once(
        "ageing-maps", lambda: ageing_maps(shipped.opened(1), shipped.machine(), failing("U1", 230e3))
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
        assert found.measured[index].mean() > 0.9
    for index, age in enumerate(found.ages.tolist()):
        exact = unit.at(age).transition_speed(found.temperature - ZERO_CELSIUS) * found.roll_radius
        seen = found.transition[index] > 0.0
        assert found.transition[index, -3:] == pytest.approx(exact[-3:], rel=0.16)
        assert found.transition[index, seen] == pytest.approx(exact[seen], rel=0.25)
        assert exact[~seen].max() < 1.3 * found.speed[0]  # below the speeds measured
    assert not found.measured[2].any()
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
        measured=np.ones((1, 2, 4), dtype=bool),
        ages=np.array([0.0]),
        when=("new",),
    )
    states = [own.state(0, OperatingPoint("p", v, 420.0)) for v in (0.012, 0.02, 0.04, 0.075)]
    assert states == ["stick-slip", "depends on start", "smooth", "motor stops"]
    assert replace(own, torque_limit=None).state(0, OperatingPoint("p", 0.075, 420.0)) == "smooth"


def test_no_map_is_inverted() -> None:
    """The transition rises with temperature at every age, as that of the truth does."""
    found = ageing_maps(shipped.opened(8), shipped.machine(), failing("U8", 250e3), unit=" U8 ")
    truth = population(*example_drive(), units=8, seed=3)[7]
    for index, age in enumerate(found.ages.tolist()):
        assert (np.diff(found.transition[index]) >= 0.0).all()
        assert (found.upper[index] >= found.transition[index]).all()
        exact = truth.at(age).transition_speed(found.temperature - ZERO_CELSIUS) * found.roll_radius
        seen = found.transition[index] > 0.0
        assert np.abs(np.log(found.transition[index, seen] / exact[seen])).max() < 0.25


def test_a_transition_that_falls_with_temperature_is_drawn_level() -> None:
    machine, speed = shipped.machine(), np.geomspace(0.01, 0.2, 31)
    hot = np.array([400.0, 410.0, 420.0])
    least = np.array([[0.06], [0.02], [0.03]])
    belt = np.log(0.3 + 0.1 * np.log(speed / least) ** 2)
    found = edges_of(machine, belt, None, hot, speed)
    assert found.falls
    level = (0.06 * 0.02 * 0.03) ** (1 / 3)
    assert found.transition == pytest.approx([level] * 3, rel=0.1)
    rising = edges_of(machine, belt[[1, 2, 0]], None, hot, speed)
    assert not rising.falls
    assert rising.transition == pytest.approx([0.02, 0.03, 0.06], rel=0.1)


def test_what_no_dwell_encloses_is_not_measured() -> None:
    """Dwells up to half of the speed when cold: the corner beyond is hatched."""
    speed, kelvin = (each.ravel() for each in np.meshgrid([1.0, 2.0, 4.0, 8.0], [330.0, 380.0, 430.0]))
    kept = ~((kelvin < 340.0) & (speed > 3.0))
    ones = np.ones(kept.sum())
    dwells = RunDwells(speed[kept], kelvin[kept], ones, ones, ones)
    measured = measured_at(dwells, np.array([330.0, 380.0, 430.0]), np.array([1.0, 2.0, 7.9]))
    assert measured.tolist() == [[True, True, False], [True, True, True], [True, True, True]]
    line = RunDwells(speed[:4], np.full(4, 330.0), *[np.ones(4)] * 3)
    assert not measured_at(line, np.array([330.0]), np.array([2.0])).any()


def test_far_ahead_there_is_no_map() -> None:
    found = ageing_maps(shipped.opened(1), shipped.machine(), failing("U1", 300e3))
    assert found.when == ("new", "now")
    (far,) = (each for each in found.warnings if each.kind == "end beyond the map")
    assert str(far).startswith("there is no map at the end, 300000 pages: that is more than 1.5 times")


def test_a_unit_that_has_ended_has_no_end_ahead() -> None:
    found = ageing_maps(shipped.opened(1), shipped.machine(), failing("U1", 150e3, passed=1.0))
    assert found.when == ("new", "now")


def test_what_cannot_be_drawn_is_told() -> None:
    with pytest.raises(ParameterError, match=r"no specimen 'U11'. Did you mean 'U1'"):
        ageing_maps(shipped.opened(1), shipped.machine(), failing("U1", 230e3), unit="U11")
    with pytest.raises(InsufficientDataError, match="runs of U7 do not show how torque"):
        ageing_maps(shipped.opened(1), shipped.machine(), failing("U7", 230e3))


def test_it_says_what_the_points_meet() -> None:
    text = maps().summary()
    assert "thick paper, 45 mm/s at 180 degC: new " in text
    frame = maps().to_frame()
    assert frame.height == 3 * maps().temperature.size
    assert isinstance(hersey.AgeingMaps, type)
