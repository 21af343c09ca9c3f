"""One rule for the stick speed against temperature: map, band, plan, report and simulation agree."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import hersey
from hersey.damping.surface import FIXED, WITH_TRANSITION
from hersey.errors import ParameterError
from hersey.stability.plan.of_log import _uncertainty, drag_and_draws
from tests.conftest import ROOT
from tests.damping.test_surface import points_of
from tests.machines import map_of

HOT = 180.0 + 273.15
RULES = (WITH_TRANSITION, FIXED)


def surface() -> hersey.DampingSurface:
    """An exact law with a transition, about 150 degC."""
    w, t = (a.ravel() for a in np.meshgrid(np.geomspace(0.1, 15, 10), [100.0, 120.0, 150.0, 180.0]))
    corner = 1.0 * (t / 150.0) ** 3.0
    level = 62.0 * t**-0.9 * corner**0.3
    torque = level * (w / corner) ** np.where(w >= corner, 0.3, -0.2)
    return hersey.fit(points_of(w, torque, t, error=1e-3))


@pytest.fixture(scope="module")
def fitted() -> hersey.DampingSurface:
    return surface()


def machine(rule: str = WITH_TRANSITION, at: float | None = None) -> hersey.Machine:
    known = hersey.read_machine(ROOT / "tests" / "stand" / "machine.toml")
    gripping = replace(known.limits, roll_friction=None)
    return replace(known, stick_speed_rule=rule, stick_speed_temperature=at, uncertainty={}, limits=gripping)


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("at", [None, 420.0])
def test_map_band_and_plan_agree(fitted: hersey.DampingSurface, rule: str, at: float | None) -> None:
    """At one temperature and drive speed, to the ninth digit, whichever way the drag is asked for."""
    m = machine(rule, at)
    by_itself = fitted.drag(**m.belt, temperature=HOT)
    planned, _ = drag_and_draws(fitted, m, HOT, 1, varies=False)
    map_ = map_of(fitted, m.train, **m.belt, temperatures=[430.0, HOT], draws=2)
    state = map_.state_at(temperature=HOT, speed=0.03)
    laws = [by_itself, planned]
    if rule == WITH_TRANSITION:
        laws.append(fitted.drag(**m.belt).at(HOT))
    assert [law.stick_speed for law in laws] == pytest.approx([state.stick_speed] * len(laws), rel=1e-9)
    drive = 0.8 * by_itself.transition_speed
    cycles = [hersey.stick_slip(m.train, law, drive_speed=drive).frequency for law in laws]
    if rule == WITH_TRANSITION:
        varying = fitted.drag(**m.belt)
        cycles.append(hersey.stick_slip(m.train, varying, drive_speed=drive, temperature=HOT).frequency)
    assert cycles == pytest.approx([cycles[0]] * len(cycles), rel=1e-9)
    bands = [hersey.hysteresis(m.train, law, sensitivity=False).upper for law in laws]
    assert bands == pytest.approx([state.upper] * len(bands), rel=1e-9)
    assert map_.upper[-1] == pytest.approx(state.upper, rel=1e-9)


def test_the_rule_is_that_of_the_transition_or_none(fitted: hersey.DampingSurface) -> None:
    given = {"stick_speed": 3e-4, "stick_speed_temperature": 420.0}
    moved = fitted.stick_speed_at(HOT, **given)
    ratio = fitted.transition_speed(HOT) / fitted.transition_speed(420.0)
    assert moved == pytest.approx(3e-4 * ratio, rel=1e-12)
    assert moved > 4e-4
    assert fitted.stick_speed_at(420.0, **given) == pytest.approx(3e-4, rel=1e-12)
    assert fitted.stick_speed_at(HOT, **given, stick_speed_rule=FIXED) == 3e-4
    with pytest.raises(
        ParameterError, match=r"stick_speed_rule 'still' is not known. Use 'with transition' or 'fixed'"
    ):
        fitted.stick_speed_at(HOT, **given, stick_speed_rule="still")


def test_a_fixed_stick_speed_needs_one_temperature(fitted: hersey.DampingSurface) -> None:
    with pytest.raises(
        ParameterError, match="Give one temperature, or use stick_speed_rule 'with transition'"
    ):
        fitted.drag(**machine(FIXED).belt)
    with pytest.raises(ParameterError, match="Give one temperature"):
        drag_and_draws(fitted, machine(FIXED), None, 1, varies=True)


def test_a_range_of_the_stick_speed_moves_with_it(fitted: hersey.DampingSurface) -> None:
    """Map and plan draw from the range as it is at their temperature; a share stays one."""
    known = hersey.Uncertainty(limits=(1e-4, 1e-3))
    m = replace(machine(at=420.0), uncertainty={"stick_speed": known})
    drag = fitted.drag(**m.belt, temperature=HOT)
    ratio = drag.stick_speed / 3e-4
    assert _uncertainty(m, drag)["stick_speed"].limits == pytest.approx(
        (1e-4 * ratio, 1e-3 * ratio), rel=1e-12
    )
    share = {"stick_speed": hersey.Uncertainty(share=0.3)}
    assert _uncertainty(replace(m, uncertainty=share), drag) == share
    given: dict[str, Any] = {"temperatures": [420.0, HOT], "draws": 4, "seed": 3}
    sticking = {name: value for name, value in m.belt.items() if name not in ("roll_radius", "rest")}
    first = fitted.stick_speed_at(fitted.reference_temperature, **sticking)
    stated = map_of(fitted, m.train, **m.belt, uncertainty=m.uncertainty, **given)
    moved = {"stick_speed": known.times(first / 3e-4)}
    at_reference = map_of(
        fitted, m.train, roll_radius=m.roll_radius, stick_speed=first, uncertainty=moved, **given
    )
    assert stated.upper_interval == pytest.approx(at_reference.upper_interval, rel=1e-9)


def test_map_and_plan_say_which_stick_speed_they_took(fitted: hersey.DampingSurface) -> None:
    m = machine()
    said = map_of(fitted, m.train, **m.belt, temperatures=[430.0, HOT], draws=2).warnings[0]
    assert said.values["stick_speed"] == 3e-4
    assert "0.3 mm/s at" in str(said)
    assert "it moves with the transition speed, from" in str(said)
    fixed = map_of(fitted, m.train, **machine(FIXED).belt, temperatures=[430.0, HOT], draws=2).warnings[0]
    assert "0.3 mm/s at all temperatures" in str(fixed)
    plan = hersey.plan_profile(m.train, fitted.drag(**m.belt, temperature=HOT), target_speed=0.2)
    assert f"stick speed {1e3 * plan.stick_speed:.4g} mm/s" in plan.summary()
    assert plan.stick_speed == fitted.drag(**m.belt, temperature=HOT).stick_speed
