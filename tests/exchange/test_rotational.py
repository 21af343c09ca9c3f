"""A unit whose drive is a shaft: its speed in, its torque out; the same belt as by the translational port."""

from __future__ import annotations

from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu

import hersey
from hersey.errors import ParameterError
from tests.exchange.instances import instance
from tests.exchange.test_against_core import DRAG, TRAIN, VERSIONS

RADIUS = 0.015


def shaft(path: Path, fmi: str) -> Path:
    unit = hersey.export_fmu(
        path, TRAIN, DRAG, port="rotational", drive_speed="20 mm/s", roll_radius="15 mm", fmi=fmi
    )
    return unit.path


@pytest.mark.parametrize("fmi", VERSIONS)
def test_a_shaft_moves_the_belt_as_its_rim_does(fmi: str, tmp_path: Path) -> None:
    run = hersey.simulate(TRAIN, DRAG, drive_speed=0.02, duration=0.5, samples=26)
    rows = []
    with instance(shaft(tmp_path / "drive.fmu", fmi)) as opened:
        assert opened.get("roll_speed")[0] == pytest.approx(0.02 / RADIUS, rel=1e-15)
        for time in run.time[1:]:
            opened.to(float(time))
            rows.append(opened.get("belt_speed", "reaction_torque", "roll_angle"))
    got = np.array(rows)
    assert run.events
    assert got[:, 0] == pytest.approx(run.belt_speed[1:], rel=1e-9, abs=1e-12)
    assert got[:, 1] == pytest.approx(RADIUS * run.spring_force[1:], rel=1e-9)
    assert got[:, 2] == pytest.approx(0.02 / RADIUS * run.time[1:], rel=1e-12)


@pytest.mark.parametrize("fmi", VERSIONS)
def test_a_motor_that_drives_it_works_as_much_as_becomes_heat(fmi: str, tmp_path: Path) -> None:
    """Torque times angle is friction and what spring and mass hold: the sign is that of a brake."""
    with instance(shaft(tmp_path / "drive.fmu", fmi), start={"roll_speed": 8.0}) as opened:
        work, before = 0.0, 0.0
        for i in range(1, 4001):
            opened.to(i * 1e-4)
            (torque,) = opened.get("reaction_torque")
            work += 0.5 * (before + torque) * 8.0 * 1e-4
            before = torque
        heat, stretch, speed = opened.get("friction_energy", "stretch", "belt_speed")
    stored = 0.5 * (TRAIN.stiffness * stretch**2 + TRAIN.mass * speed**2)
    assert work == pytest.approx(heat + stored, rel=1e-5)


@pytest.mark.parametrize("fmi", VERSIONS)
def test_it_has_the_variables_of_its_port_alone(fmi: str, tmp_path: Path) -> None:
    about = {}
    for port in ("translational", "rotational"):
        unit = hersey.export_fmu(
            tmp_path / f"{port}.fmu", TRAIN, DRAG, port=port, roll_radius=RADIUS, fmi=fmi
        ).path
        assert validate_fmu(str(unit)) == []
        found = fmpy.read_model_description(str(unit)).modelVariables
        about[port] = {v.name: (v.causality, v.unit) for v in found}
    belt, roll = about["translational"], about["rotational"]
    assert belt["drive_speed"] == ("input", "m/s")
    assert belt["drive_position"] == ("output", "m")
    assert not {"roll_speed", "reaction_torque", "roll_angle", "roll_radius"} & set(belt)
    assert roll["roll_speed"] == ("input", "rad/s")
    assert roll["reaction_torque"] == ("output", "N.m")
    assert roll["roll_angle"] == ("output", "rad")
    assert roll["roll_radius"] == ("parameter", "m")
    assert not {"drive_speed", "drive_position"} & set(roll)


def test_the_radius_is_a_parameter(tmp_path: Path) -> None:
    run = hersey.simulate(TRAIN, DRAG, drive_speed=0.04, duration=0.3, samples=2)
    start = {"roll_radius": 0.02, "roll_speed": 2.0}
    with instance(shaft(tmp_path / "drive.fmu", "3.0"), start=start) as opened:
        opened.to(0.3)
        assert opened.get("reaction_torque")[0] == pytest.approx(0.02 * run.spring_force[-1], rel=1e-9)
    none = instance(tmp_path / "drive.fmu", start={"roll_radius": 0.0})
    with pytest.raises(fmpy.fmi1.FMICallException):
        none.__enter__()


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"port": "rotational"}, "a rotational port needs the roll_radius"),
        ({"port": "linear"}, "port is 'linear': it must be translational or rotational"),
        (
            {"port": "rotational", "drive": "torque", "roll_radius": RADIUS},
            "port 'rotational' needs drive 'speed', because a torque already acts on the shaft",
        ),
    ],
)
def test_what_does_not_go_together_is_refused(settings: dict[str, object], said: str, tmp_path: Path) -> None:
    with pytest.raises(ParameterError) as caught:
        hersey.export_fmu(tmp_path / "drive.fmu", TRAIN, DRAG, **settings)  # type: ignore[arg-type]
    assert str(caught.value) == said
