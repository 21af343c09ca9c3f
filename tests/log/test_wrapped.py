"""Negative counts that were logged without a sign."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.log.wrapped import READ_AS_NEGATIVE, with_signs
from tests.cli import command

UNITS = {"torque": "4.79 mN*m", "speed": "0.229 rpm"}


def counts(bits: int, rows: int = 400) -> tuple[np.ndarray, np.ndarray]:
    """Torque and speed of both directions as written, and with their signs."""
    row = np.arange(rows)
    signs = np.where(row // 50 % 2, -1, 1)
    signed = signs * np.stack([20 + row % 3, 100 + 40 * (row // 100)])
    return np.where(signed < 0, signed + 2**bits, signed), signed


def warned(log: hersey.TorqueLog) -> dict[str, tuple[float, float]]:
    """Channel, count and bits of each warning."""
    found = [each.values for each in log.files[0].warnings if each.kind == READ_AS_NEGATIVE]
    return {each["channel"]: (each["count"], each["bits"]) for each in found}


@pytest.mark.parametrize("bits", [16, 32])
@pytest.mark.parametrize("text", [True, False])
def test_counts_of_registers_get_their_sign_back(bits: int, text: bool, tmp_path: Path) -> None:
    (torque, speed), signed = counts(bits)
    frame = pl.DataFrame({"time [s]": 0.1 * np.arange(400), "torque": torque, "speed": speed})
    frame.write_csv(tmp_path / "log.csv")
    read = hersey.read(tmp_path / "log.csv" if text else frame, units=UNITS, isothermal=True)
    run = read.runs[0]
    assert run.torque == pytest.approx(4.79e-3 * signed[0], rel=1e-6)
    assert run.speed == pytest.approx(0.229 * signed[1] * 2 * np.pi / 60, rel=1e-6)
    assert warned(read) == {"torque": (200, bits), "speed": (200, bits)}


def test_a_position_below_zero_makes_one_speed_with_that_above() -> None:
    position = (2048 - 8 * np.arange(600)) % 2**32
    frame = pl.DataFrame(
        {"time [s]": 0.01 * np.arange(600), "torque": 20 + np.arange(600) % 3, "pos": position}
    )
    units = {"torque": "4.79 mN*m", "position": "rev/4096"}
    read = hersey.read(frame, units=units, channels={"position": "pos"}, isothermal=True)
    assert read.runs[0].speed == pytest.approx(np.full(600, -800 / 4096 * 2 * np.pi), rel=1e-6)
    assert warned(read) == {"pos": (343, 32)}


@pytest.mark.parametrize(
    "written",
    [
        np.arange(0, 65_536, 64),  # runs through the whole range
        np.tile([10, 12, 65_535], 40),  # one code
        np.tile([10.0, 12.5, 65_530, 65_531, 65_532], 40),  # no counts
        np.tile([10, 12, 40_000, 65_530, 65_531, 65_532], 40),  # some between
        np.tile([10, -12, 65_530, 65_531, 65_532], 40),  # others have a sign
        np.tile([10, 12, 70_000, 80_000, 90_000], 40),  # beyond 16 bits, far below 32
        np.tile([10, 12, 200], 40),
        np.tile([0, 60_000, 61_500, 63_000], 40),  # a fast spindle
        np.tile([65_530, 65_531, 65_532], 40),  # a level that does not pass zero
    ],
)
def test_what_may_be_anything_else_stays_as_it_is(written: np.ndarray) -> None:
    for scale in (1.0, 4.79e-3):
        values = scale * written.astype(float)
        kept, warnings = with_signs(values, scale, "torque")
        assert kept is values
        assert not warnings


def test_missing_numbers_stay_missing_and_signs_of_units_count() -> None:
    written = np.array([np.nan, 3.0, 65_530.0, 65_531.0, 65_532.0])
    read, warnings = with_signs(-2.0 * written, -2.0, "torque")
    np.testing.assert_array_equal(read, [np.nan, -6.0, 12.0, 10.0, 8.0])
    assert str(warnings[0]) == (
        "3 numbers of 'torque' were logged without their sign, as counts of 16 bits, and are read as "
        "negative (65535 is -1)"
    )


def test_the_fit_says_so_and_what_one_count_is_can_be_asked_for(tmp_path: Path) -> None:
    (torque, speed), _ = counts(16, 2400)
    header = {"present_current": torque, "present_velocity": speed, "present_temperature": 29}
    frame = pl.DataFrame({"time [s]": 0.1 * np.arange(2400), **header})
    frame.write_csv(tmp_path / "log.csv")
    asked = command.run("fit", "log.csv", cwd=tmp_path)
    assert (
        "For counts of a register give what one count is, e.g. --torque-unit '4.79 mN*m' --speed-unit "
        "'0.229 rpm'"
    ) in asked.stderr
    units = ["--torque-unit", "4.79 mN*m", "--speed-unit", "0.229 rpm", "--isothermal"]
    done = command.run("inspect", "log.csv", "--torque", "present_current", *units, cwd=tmp_path)
    assert done.returncode == 0
    assert "numbers of 'present_current' were logged without their sign" in " ".join(done.stdout.split())
