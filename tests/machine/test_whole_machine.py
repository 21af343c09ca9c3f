"""A machine given whole: maps, bands, laps and plans take every part of its file."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest

import hersey
from hersey.errors import ParameterError
from hersey.machine.machine import Machine
from tests.conftest import ROOT
from tests.machines import machine_of

EXAMPLES = ROOT / "examples"
AT = 180 + 273.15


@cache
def fitted() -> tuple[hersey.DampingSurface, Machine]:
    machine = hersey.read_machine(EXAMPLES / "machine.toml")
    points = hersey.read(EXAMPLES / "bench.csv").steady(tare="standing").without(machine.rest)
    return hersey.fit(points), machine


def test_a_map_of_the_machine_holds_its_stick_speed_where_it_was_stated() -> None:
    """Without the temperature at which the stick speed holds V* was 64 mm/s, little more than half."""
    surface, machine = fitted()
    law = surface.drag(**machine.belt, temperature=AT)
    assert law.stick_speed == pytest.approx(3e-3, rel=1e-12)
    band = hersey.hysteresis(machine.train, law)
    map_ = hersey.operating_map(surface, machine, temperatures=[AT, AT + 1], draws=2)
    assert map_.state_at(temperature=AT, speed=0.05).upper == pytest.approx(band.upper, rel=1e-9)
    assert [point.name for point in map_.points] == ["full speed", "thick paper"]
    assert map_.stall_above is not None
    bare = hersey.operating_map(
        surface, replace(machine, stick_speed_rule="fixed", points=()), temperatures=[AT, AT + 1], draws=2
    )
    assert bare.points == ()
    assert (
        bare.state_at(temperature=AT + 1, speed=0.05).upper
        != map_.state_at(temperature=AT + 1, speed=0.05).upper
    )


def test_bands_laps_and_plans_take_the_machine() -> None:
    surface, machine = fitted()
    law = surface.drag(**machine.belt, temperature=AT)
    band = hersey.hysteresis(machine, surface, temperature=AT, sensitivity=False)
    assert band.upper == pytest.approx(hersey.hysteresis(machine.train, law).upper, rel=1e-9)
    lap = hersey.stick_slip(machine, surface, drive_speed=0.02, temperature=AT)
    assert lap.frequency == pytest.approx(
        hersey.stick_slip(machine.train, law, drive_speed=0.02).frequency, rel=1e-7
    )
    fixed = replace(machine, stick_speed_rule="fixed")
    colder = hersey.hysteresis(fixed, surface, temperature=AT - 40, sensitivity=False)
    held = surface.drag(**fixed.belt, temperature=AT - 40)
    assert held.stick_speed == 3e-3
    assert colder.upper == pytest.approx(hersey.hysteresis(machine.train, held).upper, rel=1e-12)
    certain = replace(machine, uncertainty={})
    plan = hersey.plan_profile(certain, surface, target_speed=0.2, temperature=AT)
    given = hersey.plan_profile(
        machine_of(machine.train, limits=machine.limits, roll_radius=machine.roll_radius),
        surface.drag(**machine.belt),
        target_speed=0.2,
        temperature=AT,
    )
    assert plan.to_dict() == given.to_dict()


def test_a_surface_needs_a_machine() -> None:
    surface, machine = fitted()
    with pytest.raises(ParameterError, match="needs roll radius and stick speed"):
        hersey.hysteresis(machine.train, surface, temperature=AT)
    with pytest.raises(ParameterError, match=r"machine is a Drivetrain\. It must be a Machine"):
        hersey.operating_map(surface, machine.train)  # type: ignore[arg-type]
