"""The warm-up: times by hand where drag and heating are simple, limits kept, and nothing gained by less."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import hersey
from hersey.errors import HerseyError, ParameterError
from hersey.stability.warm_up import _ramped
from tests.lubrication.roll import DRAG as CONTACT_DRAG

_TRAIN = hersey.Drivetrain(11e3, 11.0)
_DRAG = hersey.Drag(
    50.0,
    0.01,
    ehl_exponent=-0.7,
    mixed_exponent=-1.2,
    stick_speed=3e-4,
    closure="stiction",
    reference_temperature=400.0,
    force_temperature_exponent=-4.0,
)
_HEAT = hersey.HeatBalance(
    film_capacity=150.0,
    roll_capacity=250.0,
    exchange=12.0,
    film_temperature=300.0,
    roll_temperature=300.0,
    surroundings=300.0,
    heater_power=900.0,
    setpoint=450.0,
)
#: A megawatt on a body so large that it warms by 10 K/s in a straight line, friction or not.
_LINEAR = replace(_HEAT, film_capacity=1e5, exchange=0.0, heater_power=1e6, setpoint=None)
_LIMITS = {"target_speed": 0.12, "force_limit": 180.0, "acceleration": 0.5}


def test_constant_drag_waits_until_it_is_below_the_limit() -> None:
    """Drag of 50 N (T/400 K)^-4 at all speeds above the transition: 90 N are kept from 345.3 K on."""
    flat = replace(_DRAG, ehl_exponent=-1.0)
    warm = hersey.warm_up(
        _TRAIN, flat, _LINEAR, target_speed=0.12, force_limit=100.0, acceleration=0.5, longest=60.0
    )
    start = (400.0 * (50.0 / 90.0) ** 0.25 - 300.0) / 10.0
    assert warm.start == pytest.approx(start, abs=0.1)
    assert warm.full_speed == pytest.approx(start + 0.12 / 0.5, abs=0.1)
    assert warm.full_speed_standing == pytest.approx(warm.full_speed, abs=0.1)
    assert warm.drag_at_once == pytest.approx(50.0 * 0.75**-4.0)
    assert warm.within_at_once == pytest.approx((400.0 * 0.5**0.25 - 300.0) / 10.0, abs=0.1)
    assert warm.film_temperature == pytest.approx(300.0 + 10.0 * warm.time, abs=1e-2)


def test_rising_drag_goes_as_fast_as_it_may() -> None:
    """50 N (T/400 K)^-4 (v/v_t)^0.3 = 162 N gives the speed at each temperature."""
    warm = hersey.warm_up(_TRAIN, _DRAG, _LINEAR, longest=60.0, **_LIMITS)
    allowed = 0.01 * (162.0 / 50.0 * (warm.film_temperature / 400.0) ** 4.0) ** (1 / 0.3)
    on_the_way = (allowed < 0.12) & (warm.time > 0.3)
    assert on_the_way.sum() > 100
    assert warm.drive_speed[on_the_way] == pytest.approx(allowed[on_the_way], rel=5e-3)
    assert warm.start == 0.0
    end = (400.0 * (50.0 / 162.0 * 12.0**0.3) ** 0.25 - 300.0) / 10.0
    assert warm.full_speed == pytest.approx(end, abs=0.05)
    assert warm.found
    assert warm.slides_from < warm.full_speed


def test_drag_keeps_the_limit_and_the_drive_its_acceleration() -> None:
    warm = hersey.warm_up(_TRAIN, _DRAG, _HEAT, **_LIMITS)
    sliding = warm.drive_speed > 0.01
    assert np.nanmax(warm.drag[sliding]) < 162.0 * 1.002
    assert np.max(np.abs(np.diff(warm.drive_speed))) <= 0.5 * warm.time[1] * (1 + 1e-9)
    # friction of the slow drive warms, too: sooner than standing, and the force of the motion is that drag
    assert warm.full_speed < warm.full_speed_standing
    again = hersey.simulate(
        _TRAIN, _DRAG, drive_speed=warm.schedule, temperature=_HEAT, duration=warm.time[-1]
    )
    assert again.film_temperature is not None
    assert np.interp(warm.time, again.time, again.film_temperature) == pytest.approx(
        warm.film_temperature, abs=0.1
    )
    late = again.time > warm.slides_from + 2.0
    assert np.max(again.spring_force[late]) < 180.0
    assert warm.profile.at(warm.time[-1]) == warm.film_temperature[-1]
    assert warm.table().count("\n") == warm.time.size + 1


def test_friction_alone_warms() -> None:
    """Speed and temperature make each other: the rounds go on until both agree."""
    heat = replace(_HEAT, film_capacity=3.0, exchange=0.01, heater_power=1.0, setpoint=None)
    warm = hersey.warm_up(_TRAIN, _DRAG, heat, longest=60.0, **_LIMITS)
    assert warm.found
    assert warm.rounds > 2
    assert warm.full_speed_standing == np.inf
    on_the_way = (warm.drive_speed > 0.01) & (warm.drive_speed < 0.119)
    assert warm.drag[on_the_way] == pytest.approx(162.0, rel=1e-3)


def test_more_motor_is_never_later() -> None:
    limits = (70.0, 100.0, 150.0, 300.0)
    each = [
        hersey.warm_up(_TRAIN, _DRAG, _HEAT, longest=100.0, **{**_LIMITS, "force_limit": limit})
        for limit in limits
    ]
    times = [warm.full_speed for warm in each]
    assert times == sorted(times, reverse=True)
    assert times[-1] < times[1] < np.inf
    assert all(warm.full_speed <= warm.full_speed_standing for warm in each)


def test_a_drive_slows_down_in_time() -> None:
    assert _ramped(np.array([5.0, 5.0, 5.0, 1.0, 0.0, 5.0]), 2.0).tolist() == [0.0, 2.0, 3.0, 1.0, 0.0, 2.0]


def test_a_warm_belt_comes_straight_up() -> None:
    hot = replace(_HEAT, film_temperature=440.0, roll_temperature=440.0)
    warm = hersey.warm_up(_TRAIN, _DRAG, hot, **_LIMITS)
    assert warm.start == 0.0
    assert warm.full_speed == pytest.approx(0.12 / 0.5, abs=2 * warm.time[1])
    assert "slow" not in warm.verdict()
    assert warm.within_at_once == 0.0


def test_what_is_not_reached_is_said() -> None:
    weak = hersey.warm_up(_TRAIN, _DRAG, replace(_HEAT, heater_power=20.0), longest=100.0, **_LIMITS)
    assert not weak.found
    assert "is not reached within 100 s" in weak.verdict()
    stiff = hersey.warm_up(
        _TRAIN, _DRAG, _HEAT, target_speed=0.12, force_limit=20.0, acceleration=0.5, longest=50.0
    )
    assert stiff.start == np.inf
    assert stiff.summary().startswith("The drive cannot start within 50 s")
    assert stiff.to_dict()["start"] is None


def test_a_transition_that_passes_the_target_is_warned_of() -> None:
    """Hot, the transition speed rises above a slow target, which slides while it is colder."""
    moving = replace(_DRAG, speed_temperature_exponent=12.0)
    warm = hersey.warm_up(
        _TRAIN, moving, _HEAT, target_speed=0.02, force_limit=300.0, acceleration=0.5, longest=600.0
    )
    assert warm.found
    (unstable,) = (each for each in warm.warnings if each.kind == "unstable once warmer")
    temperature = unstable.values["temperature"]
    assert isinstance(temperature, float)
    assert moving.at(temperature - 3.0).transition_speed < 0.02 <= moving.at(temperature).transition_speed
    assert "keeps warming" in str(unstable)
    hot = replace(_HEAT, film_temperature=450.0, roll_temperature=450.0)
    sticks = hersey.warm_up(
        _TRAIN, moving, hot, target_speed=0.02, force_limit=300.0, acceleration=0.5, longest=20.0
    )
    assert sticks.start == np.inf


def test_a_mixed_contact_warms_up_and_its_belt_is_watched() -> None:
    """Film drag keeps the limit; breaking the contact away takes more, and the belt goes on sticking."""
    warm = hersey.warm_up(
        _TRAIN, CONTACT_DRAG, _HEAT, target_speed=0.1, force_limit=5.0, acceleration=0.5, longest=60.0
    )
    sliding = warm.drive_speed > CONTACT_DRAG.transition_speed(310.0)
    assert np.nanmax(warm.drag[sliding]) < 4.5 * 1.002
    assert warm.drag_at_once == pytest.approx(float(CONTACT_DRAG.force(0.1, temperature=300.0)), rel=1e-6)
    assert warm.slides_from > warm.full_speed
    (late,) = (each for each in warm.warnings if each.kind == "slides late")
    assert late.values == {"slides_from": warm.slides_from}
    (peak,) = (each for each in warm.warnings if each.kind == "peak force above the limit")
    assert peak.values == {"peak_force": warm.peak_force, "force_limit": 5.0}
    assert warm.peak_force > 5.0


def test_bad_input() -> None:
    for name in ("target_speed", "force_limit", "acceleration"):
        for value in (0.0, -1.0, float("nan"), float("inf")):
            with pytest.raises(ParameterError, match=name):
                hersey.warm_up(_TRAIN, _DRAG, _HEAT, **{**_LIMITS, name: value})
    with pytest.raises(ParameterError, match="margin"):
        hersey.warm_up(_TRAIN, _DRAG, _HEAT, margin=1.0, **_LIMITS)
    with pytest.raises(ParameterError, match="longest"):
        hersey.warm_up(_TRAIN, _DRAG, _HEAT, longest=0.0, **_LIMITS)
    with pytest.raises(ParameterError, match="does not depend"):
        hersey.warm_up(_TRAIN, _DRAG.at(400.0), _HEAT, **_LIMITS)
    with pytest.raises(HerseyError, match="heat capacity"):
        hersey.warm_up(_TRAIN, _DRAG, replace(_HEAT, roll_capacity=-1.0), **_LIMITS)
