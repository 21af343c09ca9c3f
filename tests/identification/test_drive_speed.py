"""The drive speed is never known exactly: what it leaves open is in every interval, or said in words."""

from __future__ import annotations

from collections import Counter
from functools import cache

import numpy as np
import pytest

from hersey.errors import ParameterError
from hersey.identification import CycleRecord, IdentifiedDrive, cycles, drive_warnings, identify
from hersey.identification.drive_fit import DriveFit
from hersey.identification.independence import NOT_ESTIMABLE
from hersey.identification.waveform import mean_waveform
from hersey.schema.warning import Warning
from tests.conftest import mostly_nightly
from tests.identification.two_states import Truth

TRUTH = Truth()


def record(seed: int, stated: float, uncertainty: float = 1e-3) -> CycleRecord:
    """A trace at a drive speed of 1 m/s which is stated as another."""
    times, force = TRUTH.trace(seed)
    return cycles(times, force, drive_speed=stated, drive_speed_uncertainty=uncertainty)


@cache
def drive(stated: float, uncertainty: float, *known: str, seed: int = 0) -> IdentifiedDrive:
    given = {name: float(getattr(TRUTH, name)) for name in known}
    return identify(record(seed, stated, uncertainty), known=given, closures=("retained",), unit="N")


@pytest.mark.parametrize("stated", mostly_nightly([1.02, 1 / 1.02], 1.02))  # the scale of speeds cancels
def test_a_speed_two_per_cent_off_is_in_the_intervals(stated: float) -> None:
    """20 seeds, the speed as far off as its stated uncertainty, the stick speed given."""
    held: Counter[str] = Counter()
    for seed in range(20):
        estimates = drive(stated, 0.02, "stick_speed", seed=seed).estimates
        for name in ("stiffness", "mass", "transition_speed"):
            held[name] += estimates[name].low <= getattr(TRUTH, name) <= estimates[name].high
    assert min(held.values()) >= 19, held


def test_what_the_speed_leaves_open_is_its_share() -> None:
    """With nothing known that has a speed, k and m go with the inverse of the drive speed; forces do not."""
    told = drive(1.0, 0.02, "stick_speed")
    for name, share in (("stiffness", 0.02), ("mass", 0.02), ("transition_speed", 0.021)):
        assert told.systematic[name] == pytest.approx(share * told.estimates[name].value, rel=0.06), name
    assert told.systematic["free_period"] < 1e-4 * told.derived["free_period"].value
    sharp = drive(1.0, 0.001, "stick_speed")
    for name, estimate in sharp.estimates.items():
        wider = told.estimates[name]
        added = told.systematic[name] - sharp.systematic[name]
        assert wider.high - wider.low == pytest.approx(estimate.high - estimate.low + 2 * added, rel=0.05), (
            name
        )
    assert "intervals assume a drive speed of 1 m/s within 2 %" in told.summary("N")


def test_the_scale_of_all_speeds_cancels() -> None:
    """Where nothing is known, a drive speed 2 % higher divides k and m by it, and multiplies v_t, exactly."""
    one, other = drive(1.0, 0.001, seed=3), drive(1.02, 0.001, seed=3)
    for name, power in (("stiffness", -1), ("mass", -1), ("transition_speed", 1), ("ehl_exponent", 0)):
        assert other.values[name] == pytest.approx(one.values[name] * 1.02**power, rel=2e-3), name


def test_a_known_stiffness_tells_the_drive_speed() -> None:
    told = drive(1.02, 0.02, "stiffness", "stick_speed")
    speed = told.derived["drive_speed"]
    assert speed.low <= 1.0 <= speed.high
    assert speed.high - speed.low < 0.01
    assert told.estimates["mass"].low <= 1.0 <= told.estimates["mass"].high
    assert "drive_speed" not in drive(1.02, 0.02, "stick_speed").derived


def notable(found: IdentifiedDrive) -> list[Warning]:
    """Warnings but for those of what the record leaves open."""
    return [each for each in found.warnings if each.kind != NOT_ESTIMABLE]


def test_a_slope_that_contradicts_the_stiffness_is_said_with_both_numbers() -> None:
    (other,) = notable(drive(1.02, 0.001, "stiffness", "stick_speed"))
    assert other.kind == "slope contradicts stiffness"
    assert other.values["stiffness"] == 1000.0
    assert "At the drive speed of 1020 mm/s this means a stiffness of 0.9704 N/mm" in str(other)
    assert "but 1 N/mm is given; they would agree at a drive speed of 99" in str(other)
    assert other.values["by_slope"] == other.values["slope"] / 1.02
    (creep,) = notable(drive(1.02, 0.001, "stiffness"))
    assert creep.kind == "difference taken for creep"
    assert "a stiffness of 0.9705 N/mm" in str(creep)
    assert creep.values["agreed"] == creep.values["slope"] / 1000.0
    for known in ((), ("stick_speed",), ("stiffness", "stick_speed")):
        assert notable(drive(1.0, 0.001, *known)) == []


@pytest.mark.parametrize(
    ("unit", "said"),
    [
        (
            "N m",
            "rises by 989.8 N m/s. At the drive speed of 1.02 rad/s this means a stiffness of 970.4 N m/rad",
        ),
        ("1", "rises by 989.8 of the weight per s. At the drive speed of 1020 mm/s"),
        ("", "rises by 989.8 (unit of the trace) per s. At the drive speed of 1.02 (SI)"),
    ],
)
def test_numbers_of_a_warning_have_the_units_of_the_trace(unit: str, said: str) -> None:
    given = {name: float(getattr(TRUTH, name)) for name in ("stiffness", "stick_speed")}
    found = identify(record(0, 1.02), known=given, closures=("retained",), unit=unit)
    assert said in str(notable(found)[0])


def test_an_uncertainty_is_a_share() -> None:
    assert record(0, 1.0).drive_speed_uncertainty == 1e-3
    for wrong in (0.0, -0.1, 2.0, float("nan")):
        with pytest.raises(ParameterError, match="drive_speed_uncertainty is"):
            record(0, 1.0, wrong)


def test_the_independent_lap_is_that_of_the_literature() -> None:
    """The baseline at a drive speed of 1: 3.940314 Hz (reference values of the paper's hybrid model)."""
    times, _ = TRUTH.lap()
    assert 1.0 / times[-1] == pytest.approx(3.940314, rel=1e-5)
    assert np.all(np.diff(times) > 0)


def test_a_channel_of_the_drive_speed_counts_by_its_mean() -> None:
    times, force = TRUTH.trace(0)
    steady = cycles(times, force, drive_speed=np.full(times.size, 1.02))
    assert steady.drive_speed == pytest.approx(1.02)
    assert steady.drive_speed_uncertainty == pytest.approx(1e-3)
    drifting = cycles(times, force, drive_speed=1.0 + 0.02 * times / times[-1])
    assert drifting.drive_speed == pytest.approx(1.01, rel=1e-4)
    # Means of tenths from 1.001 to 1.019: their deviation over sqrt(10), 9 degrees of freedom.
    error = 0.002 * np.std(np.arange(10), ddof=1) / np.sqrt(10)
    assert drifting.drive_speed_uncertainty == pytest.approx(1e-3 + 2.262 * error / 1.01, rel=1e-3)
    stated = cycles(times, force, drive_speed=1.0 + 0.02 * times / times[-1], drive_speed_uncertainty=0.05)
    assert stated.drive_speed_uncertainty == 0.05
    with pytest.raises(ParameterError, match="drive_speed has shape"):
        cycles(times, force, drive_speed=[1.0, 2.0])


def test_a_model_that_misses_the_laps_buys_no_better_fit_with_another_speed() -> None:
    """A wrong known mass and the wrong closure: the speed stays within a standard error of the stated one."""
    given = record(0, 1.0)
    fit = DriveFit(mean_waveform(given), given, {"mass": 1.3}, "stiction")
    assert fit.misfit > 0.01
    assert abs(np.log(fit.parameters(fit.values)["drive_speed"])) < fit.stated_error


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("value", "words"), [(0.0, "drive_speed is 0"), (np.nan, "drive_speed has 0 numbers")]
)
def test_a_channel_of_a_drive_that_stands_or_without_numbers_is_refused(value: float, words: str) -> None:
    times = np.linspace(0.0, 1.0, 100)
    with pytest.raises(ParameterError, match=words):
        cycles(times, np.sin(40.0 * times), drive_speed=np.full(times.size, value))


def test_a_poor_fit_is_warned_of(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(drive_warnings, "POOR", 0.01)
    found = identify(record(0, 1.0), known={"mass": 1.3}, closures=("stiction",))
    (poor,) = (each for each in found.warnings if each.kind == "poor fit")
    assert (poor.severity, poor.values) == ("watch", {"misfit": found.misfit})
