"""The virtual test stand: seeded, honest about itself, and with every disturbance it promises."""

from __future__ import annotations

import io
import json

import numpy as np
import pytest

import hersey
from hersey import testbench
from hersey.errors import ParameterError
from hersey.testbench import RPM, Stand, StribeckTruth, ThermalTruth, Truth

QUIET = {
    "torque_noise": 0.0,
    "repeatability": 0.0,
    "torque_offset": 0.0,
    "torque_step": 0.0,
    "speed_ripple": 0.0,
    "mesh_ripple": 0.0,
    "inertia": 0.0,
    "temperature_noise": 0.0,
    "dropped": 0.0,
    "stick_slip": False,
}


def text(**arguments: object) -> str:
    out = io.StringIO()
    testbench.run(**arguments).write(out)  # type: ignore[arg-type]
    return out.getvalue()


def test_the_same_seed_gives_the_same_log() -> None:
    assert text(seed=4) == text(seed=4)
    assert text(seed=4) != text(seed=5)


def test_it_says_that_it_is_synthetic() -> None:
    assert text(seed=1).startswith("# SYNTHETIC")
    document = testbench.run(seed=1).truth_document()
    assert document["synthetic"] is True
    assert json.loads(json.dumps(document))["truth"]["c"] == -0.7


def test_a_quiet_stand_shows_the_truth() -> None:
    truth = Truth()
    table = testbench.run(stand=Stand(**QUIET)).table  # type: ignore[arg-type]
    time, torque, rpm, celsius = (table[c].to_numpy() for c in testbench.COLUMNS)
    moving = rpm > 0
    expected = truth.torque(rpm * RPM, celsius)
    np.testing.assert_allclose(torque[moving], expected[moving], rtol=2e-3, atol=1e-4)
    np.testing.assert_allclose(np.diff(time), 0.05, atol=1e-9)


def test_torque_is_continuous_at_the_transition() -> None:
    truth = Truth()
    celsius = np.array([100.0, 180.0])
    at = truth.transition_speed(celsius)
    np.testing.assert_allclose(
        truth.torque(at * (1 - 1e-9), celsius), truth.torque(at * (1 + 1e-9), celsius), rtol=1e-6
    )
    # a fixed Hersey number: viscosity ~ T^(b/(1+c)) times speed does not change along it
    np.testing.assert_allclose(at * celsius ** (truth.b / (1 + truth.c)), at[0] * 100.0**-3.0, rtol=1e-9)


@pytest.mark.parametrize(
    "disturbance", ["torque_noise", "torque_offset", "speed_ripple", "mesh_ripple", "inertia", "dropped"]
)
def test_each_disturbance_does_something(disturbance: str) -> None:
    quiet = testbench.run(stand=Stand(**QUIET)).table  # type: ignore[arg-type]
    value = getattr(Stand(), disturbance)
    disturbed = testbench.run(stand=Stand(**(QUIET | {disturbance: value}))).table  # type: ignore[arg-type]
    assert not disturbed.equals(quiet)


def test_the_heater_overshoots() -> None:
    table = testbench.run(stand=Stand(**QUIET)).table  # type: ignore[arg-type]
    hottest = float(table["Heater temperature [degC]"].max())  # type: ignore[arg-type]
    assert hottest == pytest.approx(180 + 0.06 * 30, abs=0.1)


def test_impossible_stands_are_refused() -> None:
    with pytest.raises(ParameterError, match="dwell"):
        testbench.run(stand=Stand(dwell=0))


def columns(**stand: object) -> tuple[np.ndarray, ...]:
    """Time, torque, rpm and degC of a stand that is quiet but for what is given."""
    table = testbench.run(stand=Stand(**(QUIET | stand))).table  # type: ignore[arg-type]
    return tuple(table[c].to_numpy() for c in testbench.COLUMNS)


SMALL: dict[str, object] = {
    "temperatures_degC": (150.0,),
    "speeds_rpm": (20.0, 60.0),
    "sampling_interval": 0.1,
}


def test_the_staircase_goes_up_and_down() -> None:
    time, _, rpm, celsius = columns(**SMALL)
    warm = round(6 * 15.0 / 0.1)
    steps = [*np.zeros(200), *np.full(warm + 15, 20.0), *np.full(160, 20.0)]
    steps += [*(20 + 40 * np.arange(15) / 15), *np.full(160, 60.0)]
    steps += [*(60 - 40 * np.arange(15) / 15), *np.full(160, 20.0)]
    np.testing.assert_allclose(rpm, np.round(steps, 3), atol=1e-9)
    np.testing.assert_allclose(time, 0.1 * np.arange(time.size), atol=1e-9)
    assert celsius[:200].tolist() == [25.0] * 200
    decay = 0.1 * np.arange(time.size - 200) / 15.0
    swing = np.pi / -np.log(0.06)
    rise = 1 - np.exp(-decay) * (np.cos(swing * decay) + np.sin(swing * decay) / swing)
    np.testing.assert_allclose(celsius[200:], 25 + 125 * rise, atol=0.0051)
    _, _, _, slow = columns(**SMALL, overshoot=0.0)
    np.testing.assert_allclose(slow[200:], 25 + 125 * (1 - np.exp(-decay) * (1 + decay)), atol=0.0051)


def test_each_disturbance_is_as_large_as_it_says() -> None:
    time, quiet, rpm, celsius = columns(**SMALL)
    speed, moving = rpm * RPM, rpm > 0
    truth = Truth().torque(speed, celsius)
    np.testing.assert_allclose(quiet, truth, atol=1e-3)  # temperatures are rounded
    assert columns(**SMALL, torque_offset=0.25)[1] - quiet == pytest.approx(
        np.full(time.size, 0.25), abs=2e-4
    )
    coarse = columns(**SMALL, torque_step=0.05)[1]
    assert np.abs(coarse / 0.05 - np.round(coarse / 0.05)).max() < 1e-9
    assert np.abs(coarse - quiet).max() <= 0.0251
    angle = np.cumsum(speed) * 0.1
    meshed = columns(**SMALL, mesh_ripple=0.1)[1]
    np.testing.assert_allclose(meshed[moving], (truth * (1 + 0.1 * np.sin(17 * angle)))[moving], atol=2e-3)
    turned = columns(**SMALL, speed_ripple=0.1)[2]
    np.testing.assert_allclose(turned, rpm * (1 + 0.1 * np.sin(angle)), atol=0.01)
    heavy = columns(**SMALL, inertia=0.1)[1]
    np.testing.assert_allclose(heavy, truth + 0.1 * np.gradient(speed, 0.1), atol=2e-3)
    warm = columns(**SMALL, temperature_noise=2.0)[3] - celsius
    assert (warm.std(), warm.mean()) == (pytest.approx(2.0, rel=0.06), pytest.approx(0.0, abs=0.2))


def test_noise_is_as_strong_and_as_slow_as_it_says() -> None:
    _, quiet, rpm, _ = columns(**SMALL)
    noisy = columns(**SMALL, torque_noise=0.05, noise_time=0.5)[1]
    moving = rpm > 0
    share = (noisy - quiet)[moving] / quiet[moving]
    assert share.std() == pytest.approx(0.05, rel=0.15)
    assert np.corrcoef(share[1:], share[:-1])[0, 1] == pytest.approx(np.exp(-0.1 / 0.5), abs=0.05)
    standing = (noisy - quiet)[~moving]
    assert standing.std() == pytest.approx(0.05 * 0.1 * quiet.max(), rel=0.5)
    white = columns(**SMALL, torque_noise=0.05, noise_time=0.0)[1]
    share = (white - quiet)[moving] / quiet[moving]
    assert abs(np.corrcoef(share[1:], share[:-1])[0, 1]) < 0.1


def test_dwells_repeat_as_well_as_they_say_and_rows_drop() -> None:
    speeds = tuple(float(v) for v in range(10, 60))
    given = SMALL | {"speeds_rpm": speeds, "dwell": 1.0, "ramp": 0.1}
    _, quiet, rpm, _ = columns(**given)
    _, shaken, _, _ = columns(**given, repeatability=0.05)
    ratio = (shaken / np.where(quiet == 0, 1, quiet))[rpm > 0]
    levels = np.unique(np.round(ratio[1000:], 3))
    assert levels.size > 60
    assert (ratio[-900:] - 1).std() == pytest.approx(0.05, rel=0.25)
    whole = columns(**SMALL)[0].size
    kept = columns(**SMALL, dropped=0.1)[0].size
    assert kept == pytest.approx(0.9 * whole, rel=0.03)


def test_seed_truth_and_stand_are_those_of_the_log() -> None:
    truth, stand = Truth(a=50.0), Stand(**(QUIET | SMALL | {"torque_noise": 0.02}))  # type: ignore[arg-type]
    one, two = (testbench.run(seed=seed, truth=truth, stand=stand) for seed in (1, 2))
    assert not one.table.equals(two.table)
    assert (one.seed, one.truth, one.stand) == (1, truth, stand)
    document = one.truth_document()
    assert (document["seed"], document["truth"]["a"], document["stand"]["torque_noise"]) == (1, 50.0, 0.02)  # type: ignore[index]
    out = io.StringIO()
    one.write(out)
    head = out.getvalue().splitlines()
    assert head[0] == "# SYNTHETIC log of the hersey virtual test stand (not a measurement), seed 1"
    assert head[1] == "Time [s],Drive torque [N*m],Drive speed [rpm],Heater temperature [degC]"
    ratio = testbench.run(truth=truth, stand=Stand(**(QUIET | SMALL))).table[1000, 1]  # type: ignore[arg-type]
    assert ratio == pytest.approx(50 / 62 * columns(**SMALL)[1][1000], rel=1e-3)


def test_truth_by_hand() -> None:
    truth = Truth()
    assert truth.temperature_exponent == pytest.approx(3.0)
    speed = np.array([0.0, 0.1, 10.0, -10.0])
    at = 12.0 * RPM * (180 / 150) ** 3.0
    level = 62.0 * 180.0**-0.9 * at**0.3
    expected = [0.0, level * (0.1 / at) ** -0.2, 62.0 * 180.0**-0.9 * 10**0.3, -62.0 * 180.0**-0.9 * 10**0.3]
    np.testing.assert_allclose(truth.torque(speed, np.full(4, 180.0)), expected, rtol=1e-12)


@pytest.mark.parametrize("law", ["degC", "K", "Arrhenius", "VFT"])
def test_laws_of_temperature_by_hand(law: str) -> None:
    truth = ThermalTruth(law=law, transition_share=0.5, exponent_drift=1e-3)
    t, energy, reference = 110.0, 39_584.0, 423.15
    slope = energy / (8.31446261815324 * reference**2)
    ratios = {
        "degC": (t / 150.0) ** (-slope * 150.0),
        "K": ((t + 273.15) / reference) ** (-slope * reference),
        "Arrhenius": np.exp(energy / 8.31446261815324 * (1 / (t + 273.15) - 1 / reference)),
        "VFT": np.exp(slope * (reference - 200) ** 2 * (1 / (t + 73.15) - 1 / (reference - 200))),
    }
    assert np.exp(truth.log_torque_ratio(np.array(t))) == pytest.approx(ratios[law], rel=1e-9)
    bend = 12.0 * RPM * ratios[law] ** (-0.5 / 0.3)
    assert truth.transition_speed(np.array(t)) == pytest.approx(bend, rel=1e-9)
    pivot, c = 30.0 * RPM, -0.7 + 1e-3 * (t - 150.0)
    level = 62.0 * 150.0**-0.9 * pivot**0.3 * ratios[law]
    for w in (5.0, 0.05):
        rising = level * (w / pivot) ** (1 + c)
        expected = rising if w > bend else rising * (w / bend) ** (-1.2 - c)
        assert truth.torque(np.array(w), np.array(t)) == pytest.approx(expected, rel=1e-9)
        assert truth.torque(np.array(-w), np.array(t)) == pytest.approx(-expected, rel=1e-9)
    assert truth.torque(np.array(0.0), np.array(t)) == 0.0
    with pytest.raises(ParameterError, match="law 'Walther' is not known: degC, K, Arrhenius or VFT"):
        ThermalTruth(law="Walther").log_torque_ratio(np.array(t))


def test_a_stribeck_curve_by_hand() -> None:
    truth = StribeckTruth()
    t = 110.0
    ratio = np.exp(39_584.0 / 8.31446261815324 * (1 / (t + 273.15) - 1 / 423.15))
    at = 12.0 * RPM / ratio
    assert truth.transition_speed(np.array(t)) == pytest.approx(at, rel=1e-9)
    for w in (0.3 * at, 2.0 * at):
        h = w / at
        expected = 0.25 * (1 + 0.8 * np.exp(-(h**2)) + 0.12 * h)
        assert truth.torque(np.array(w), np.array(t)) == pytest.approx(expected, rel=1e-9)
        assert truth.torque(np.array(-w), np.array(t)) == pytest.approx(-expected, rel=1e-9)


def test_the_stretch_of_stick_slip_is_that_of_the_drive() -> None:
    given = (
        QUIET | SMALL | {"stick_slip": True, "speeds_rpm": (8.0, 60.0), "temperatures_degC": (120.0, 180.0)}
    )
    stand = Stand(**given)  # type: ignore[arg-type]
    table = testbench.run(stand=stand).table
    torque, rpm = (table[c].to_numpy() for c in testbench.COLUMNS[1:3])
    assert set(rpm[-320:]) == {4.0}
    truth = Truth()
    bend = float(truth.transition_speed(np.array(180.0)))
    drag = hersey.Drag.rotational(
        transition_torque=float(truth.torque(np.array(bend), np.array(180.0))),
        transition_speed=bend,
        roll_radius=0.015,
        ehl_exponent=-0.7,
        mixed_exponent=-1.2,
        stick_speed=3e-4,
    )
    motion = hersey.simulate(
        hersey.Drivetrain(11_000.0, 1.0),
        drag,
        drive_speed=4.0 * RPM * 0.015,
        duration=32.0,
        samples=320,
        tolerance=1e-8,
    )
    np.testing.assert_allclose(torque[-320:], 0.015 * motion.spring_force, atol=1e-4)
    assert rpm[-321] == 8.0


def test_a_long_log_has_one_heading_and_enough_bytes() -> None:
    told: list[int] = []
    parts = list(testbench.long_log(bytes_wanted=900_000, seed=7, progress=told.append))
    assert parts[0] == "# SYNTHETIC log of the hersey virtual test stand (not a measurement), seed 7\n"
    assert "".join(parts).count("Time [s]") == 1
    assert 900_000 <= sum(map(len, parts)) < 1_200_000
    assert told == [len(part) for part in parts[1:]]
