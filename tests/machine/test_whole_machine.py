"""A machine given whole: maps, bands, laps and plans take every part of its file."""

from __future__ import annotations

import shutil
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import hersey
from hersey.damping.dwells import SteadyPoints
from hersey.damping.no_load import no_load_torque
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.errors import ParameterError
from hersey.log.torque_log import Correction
from hersey.machine import no_load
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
    with pytest.raises(ParameterError, match="needs radius and stick speed"):
        hersey.hysteresis(machine.train, surface, temperature=AT)
    with pytest.raises(ParameterError, match=r"machine is a Drivetrain\. It must be a Machine"):
        hersey.operating_map(surface, machine.train)  # type: ignore[arg-type]


@cache
def whole() -> tuple[hersey.SteadyPoints, hersey.DampingSurface]:
    points = hersey.read(EXAMPLES / "bench.csv").steady(tare="standing")
    return points, hersey.fit(points)


#: Every way from a surface and its machine to a motion.
MOTIONS: dict[str, Any] = {
    "stick_slip": lambda m, s: hersey.stick_slip(m, s, drive_speed=0.06, temperature=AT),
    "simulate": lambda m, s: hersey.simulate(m, s, drive_speed=0.06, temperature=AT, duration=0.1),
    "hysteresis": lambda m, s: hersey.hysteresis(m, s, temperature=AT, sensitivity=False),
    "disturbance": lambda m, s: hersey.disturbance(m, s, drive_speed=0.3, temperature=AT),
    "safe_step": lambda m, s: hersey.safe_step(m, s, from_speed=0.2, to_speed=0.1, temperature=AT),
    "operating_map": lambda m, s: hersey.operating_map(s, m, temperatures=[AT, AT + 1], draws=2),
    "plan_profile": lambda m, s: hersey.plan_profile(
        replace(m, uncertainty={}), s, target_speed=0.2, temperature=AT
    ),
    "warm_up": lambda m, s: hersey.warm_up(
        m, s, m.heat, target_speed=0.1, force_limit=70.0, acceleration=0.5
    ),
    "drag": lambda m, s: s.drag(**m.belt),
    "drag_samples": lambda m, s: s.drag_samples(2, 1, temperature=AT, **m.belt),
    "drag of the surface": lambda m, s: hersey.stick_slip(
        m, s.drag(roll_radius=m.roll_radius, stick_speed=m.stick_speed), drive_speed=0.06, temperature=AT
    ),
}


@pytest.mark.filterwarnings("ignore::hersey.errors.ExtrapolationWarning")
@pytest.mark.parametrize("way", MOTIONS)
def test_the_whole_torque_is_refused_where_the_machine_states_a_no_load_torque(way: str) -> None:
    """The no-load torque, which grows with speed, counted as film: steady sliding where the belt sticks."""
    surface, machine = fitted()
    with pytest.raises(ParameterError) as caught:
        MOTIONS[way](machine, whole()[1])
    assert caught.value.quantity == "no-load torque"
    assert "hersey.fit(points.without(machine.rest))" in caught.value.remedy
    assert "machine = dataclasses.replace(machine, rest=None)" in caught.value.remedy
    MOTIONS[way](machine, surface)
    MOTIONS[way](replace(machine, rest=None), whole()[1])
    MOTIONS[way](machine, replace(whole()[1], data_sha256=()))  # of no log: nobody knows what its torque is
    MOTIONS[way](replace(machine, rest=None), surface)


def test_points_of_the_whole_torque_are_refused() -> None:
    points, surface = whole()
    _, machine = fitted()
    for write, call in {
        "write hersey.study(points.without(machine.rest), machine)": lambda: hersey.study(points, machine),
        "hersey.posterior(points.without(machine.rest), machine)": lambda: hersey.posterior(points, machine),
        "hersey.fit(points.without(machine.rest))": lambda: hersey.posterior(
            points.without(machine.rest), machine, surface=surface
        ),
    }.items():
        with pytest.raises(ParameterError) as caught:
            call()
        assert caught.value.quantity == "no-load torque"
        assert write in caught.value.remedy
    with pytest.raises(
        ParameterError, match=r"machine = hersey\.read_machine\('.*machine\.toml'\) and hersey"
    ):
        hersey.study(points, EXAMPLES / "machine.toml")
    mapped = replace(points.log, corrections=(Correction("no-load torque", (), ()),))
    with pytest.raises(ParameterError, match=r"already subtracted\. Remove no_load from the mapping"):
        hersey.study(replace(points, log=mapped), machine)


def test_the_no_load_log_is_fitted_once_until_it_is_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("machine.toml", "no-load.csv"):
        shutil.copy(EXAMPLES / name, tmp_path)
    fits: list[SteadyPoints] = []

    def counted(points: SteadyPoints) -> NoLoadTorque:
        fits.append(points)
        return no_load_torque(points)

    monkeypatch.setattr(no_load, "no_load_torque", counted)
    log = tmp_path / "no-load.csv"
    rests = [hersey.read_machine(tmp_path / "machine.toml").rest for _ in range(3)]
    assert len(fits) == 1
    assert rests[0] == rests[2]
    log.write_text("".join(log.read_text().splitlines(keepends=True)[:-2000]))
    assert hersey.read_machine(tmp_path / "machine.toml").rest != rests[0]
    (tmp_path / "no-load.hersey.toml").write_text("[sign]\ntorque = -1\n[tare]\n")
    with pytest.raises(ParameterError):
        hersey.read_machine(tmp_path / "machine.toml")
    assert len(fits) == 2
