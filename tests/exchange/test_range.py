"""A unit warns where it leaves the range in which its drag is known: once each time, by the tool's logger."""

from __future__ import annotations

import ctypes
from dataclasses import replace
from pathlib import Path

import pytest

import hersey
from tests.conftest import ROOT
from tests.exchange.instances import Instance, instance
from tests.exchange.test_against_core import VERSIONS, WARM, mixed_drag

#: Status and category of a warning, the same in both versions.
WARNING = (1, "logStatusWarning")


@pytest.fixture
def unit(surface: hersey.DampingSurface, tmp_path: Path, request: pytest.FixtureRequest) -> Path:
    """A fitted unit that slides, in the middle of the temperatures that were measured."""
    machine = hersey.read_machine(ROOT / "tests" / "stand" / "machine.toml")
    return hersey.export_fmu(
        tmp_path / "drive.fmu",
        replace(machine.train, grip=None),
        replace(surface.drag(**machine.belt), closure="stiction"),
        temperature=middle(surface),
        drive_speed=speeds(surface, machine)[0] * 1.5,
        start="steady",
        roll_radius=machine.roll_radius,
        fitted=surface,
        fmi=request.param,
    ).path


def middle(surface: hersey.DampingSurface) -> float:
    assert surface.temperature_range is not None
    return sum(surface.temperature_range) / 2


def speeds(surface: hersey.DampingSurface, machine: hersey.Machine) -> tuple[float, float]:
    low, high = surface.speed_range
    return low * machine.roll_radius, high * machine.roll_radius


def run(opened: Instance, count: int = 3) -> list[str]:
    """Go on by some steps; what was said in them, of warnings alone."""
    before = len(opened.said)
    for _ in range(count):
        opened.to(opened.time + 1e-3)
    said = opened.said[before:]
    assert all(told[:2] == WARNING for told in said), said
    return [told[2] for told in said]


@pytest.mark.parametrize("unit", VERSIONS, indirect=True)
def test_a_temperature_is_reported_each_time_that_it_leaves_its_range(
    unit: Path, surface: hersey.DampingSurface
) -> None:
    assert surface.temperature_range is not None
    cold, hot = surface.temperature_range
    with instance(unit) as opened:
        assert run(opened) == []
        found = []
        for kelvin in (hot + 1, hot + 2, hot - 0.001, hot + 1, middle(surface), cold - 1, middle(surface)):
            opened.set(temperature=kelvin)
            found.append(run(opened))
        assert [len(said) for said in found] == [1, 0, 0, 0, 0, 1, 0]
    assert f"the temperature is {float(f'{hot + 1:.6g}'):g} K at 0.003 s" in found[0][0]
    assert f"drag is known from {float(f'{cold:.6g}'):g} to {float(f'{hot:.6g}'):g} K" in found[0][0]


@pytest.mark.parametrize("unit", VERSIONS, indirect=True)
def test_a_speed_is_reported_and_a_drive_that_stands_is_not(
    unit: Path, surface: hersey.DampingSurface
) -> None:
    machine = hersey.read_machine(ROOT / "tests" / "stand" / "machine.toml")
    low, high = speeds(surface, machine)
    with instance(unit) as opened:
        found = []
        for speed in (0.0, 0.5 * low, 2 * low, -1.1 * high, 2 * low, 1.1 * high):
            opened.set(drive_speed=speed)
            found.append([said for said in run(opened) if "speed of the drive" in said])
    assert [len(said) for said in found] == [0, 1, 0, 1, 0, 1]


@pytest.mark.parametrize("unit", VERSIONS, indirect=True)
def test_a_belt_faster_than_was_measured_is_reported_once(unit: Path, surface: hersey.DampingSurface) -> None:
    machine = hersey.read_machine(ROOT / "tests" / "stand" / "machine.toml")
    _, high = speeds(surface, machine)
    with instance(unit) as opened:
        opened.set(drive_speed=2 * high)
        first = run(opened, 400)
        opened.set(drive_speed=0.1 * high)
        run(opened, 400)
        opened.set(drive_speed=2 * high)
        second = run(opened, 400)
        assert opened.get("belt_speed")[0] > high
    assert [("belt" in said, "of the drive" in said) for said in first] == [(False, True), (True, False)]
    assert ["of the drive" in said for said in second] == [True]


@pytest.mark.parametrize("unit", VERSIONS, indirect=True)
def test_what_was_reported_is_part_of_a_saved_state(unit: Path) -> None:
    with instance(unit) as opened:
        opened.to(0.01)
        inside = opened.states()
        opened.set(temperature=900.0)
        assert len(run(opened)) == 1
        outside = opened.serialized(opened.states())
        opened.restore(inside)
        opened.time = 0.01
        opened.set(temperature=900.0)
        assert len(run(opened)) == 1
    with instance(unit) as other:
        other.restore(other.deserialized(outside))
        other.time = 0.013
        assert run(other) == []


@pytest.mark.parametrize("unit", VERSIONS, indirect=True)
def test_warnings_can_be_turned_off(unit: Path) -> None:
    with instance(unit) as opened:
        opened.fmu.setDebugLogging(False, ["logStatusWarning"])
        opened.set(temperature=900.0)
        assert run(opened) == []


@pytest.mark.parametrize("unit", VERSIONS, indirect=True)
def test_without_a_logger_it_goes_on(unit: Path) -> None:
    """A null pointer in place of the function is allowed."""
    with instance(unit, silent=True) as opened:
        opened.set(temperature=900.0)
        run(opened)
        assert opened.time == pytest.approx(0.003)
        assert opened.said == []


def test_a_mixed_contact_warns_beyond_the_viscosities_of_its_lubricant(tmp_path: Path) -> None:
    """Those of examples/machine.toml are of 40 to 200 degC."""
    unit = hersey.export_fmu(tmp_path / "drive.fmu", hersey.Drivetrain(11_000.0, 11.0), mixed_drag(),
                             temperature="150 degC")  # fmt: skip
    with instance(unit.path) as opened:
        opened.set(temperature=473.0)
        assert run(opened) == []
        opened.set(temperature=474.0)
        assert len(run(opened)) == 1


def test_without_a_fit_nothing_is_known_of_a_range(tmp_path: Path) -> None:
    train = hersey.Drivetrain(11_000.0, 11.0)
    unit = hersey.export_fmu(tmp_path / "drive.fmu", train, WARM, temperature=420.0)
    with instance(unit.path) as opened:
        opened.set(temperature=600.0, drive_speed=5.0)
        assert run(opened) == []


def test_plain_functions_keep_the_warning() -> None:
    """`hersey_warning` says of what the last steps warned, and is empty after steps that warn of nothing."""
    from tests.exchange.test_c import DRIVE, LIBRARY

    library = ctypes.CDLL(str(LIBRARY))
    library.hersey_drive_read.restype = ctypes.c_void_p
    library.hersey_warning.restype = ctypes.c_char_p
    text = (DRIVE + "measured_speeds = 0.5 2.0\n").encode()
    drive = ctypes.c_void_p(library.hersey_drive_read(text, None, ctypes.c_size_t(0)))
    assert library.hersey_warning(drive) == b""
    assert library.hersey_begin(drive, ctypes.c_double(0.0)) == 0
    assert library.hersey_warning(drive) == b""
    assert library.hersey_set(drive, b"drive_speed", ctypes.c_double(2.5)) == 0
    assert library.hersey_advance(drive, ctypes.c_double(0.1), 0) == 0
    assert library.hersey_warning(drive) == (
        b"hersey_advance: the speed of the drive is 2.5 m/s at 0 s; drag is known from 0.5 to 2 m/s, "
        b"and is extrapolated"
    )
    assert library.hersey_advance(drive, ctypes.c_double(0.11), 0) == 0
    assert library.hersey_warning(drive) == b""
    assert b"no drive" in library.hersey_warning(None)
    library.hersey_free(drive)
