"""Friction from coast-downs: closed form, known friction, what the log holds besides, what is told of it."""

from __future__ import annotations

import shlex
from itertools import pairwise
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from scipy.integrate import solve_ivp

import hersey
from hersey.arrays import FloatArray
from hersey.damping.coast_down import CoastDown
from hersey.damping.coast_down.closed_form import speeds
from hersey.damping.coast_down.coasts import noise_of_rows
from hersey.damping.coast_down.steps import steps_in
from hersey.damping.inertia import inertia_of
from hersey.damping.recipe import Recipe
from hersey.errors import ChannelError, InsufficientDataError, ParameterError, UnitError
from tests.cli.command import run
from tests.conftest import ROOT

LOG = ROOT / "examples" / "coast-down.csv"
#: Of the example: kg m^2, N m, N m s/rad, N m s^2/rad^2.
INERTIA, TERMS = 0.012, (0.008, 2e-4, 4e-6)


def falling(law: tuple[float, float, float], first: float, until: float, every: float) -> FloatArray:
    """Speeds by a solver of its own."""

    def rate(_: float, w: FloatArray) -> FloatArray:
        return -(law[0] + law[1] * w + law[2] * w * w)

    time = np.arange(0.0, until, every)
    return np.asarray(solve_ivp(rate, (0.0, until), [first], t_eval=time, rtol=1e-10, atol=1e-10).y[0])


def frame(speed: FloatArray, every: float = 0.05, noise: float = 0.05, **more: FloatArray) -> pl.DataFrame:
    seen = speed + noise * np.random.default_rng(4).standard_normal(speed.size)
    return pl.DataFrame({"time [s]": every * np.arange(speed.size), "speed [rad/s]": seen} | more)


def kinds(found: CoastDown) -> set[str]:
    return {each.kind for each in found.warnings}


LAWS = [(1.0, 0.05, 1e-3), (0.0, 0.05, 1e-3), (1.0, 0.0, 0.0), (0.0, 0.0, 0.01), (0.0, 0.1, 0.0)]


@pytest.mark.parametrize("law", [*LAWS, (1.0, 0.0, 1e-4)])
def test_the_closed_form_solves_the_equation(law: tuple[float, float, float]) -> None:
    time = np.arange(0.0, 20.0, 0.1)
    speed, derivatives = speeds(np.array(law), 100.0, time)
    assert np.allclose(speed, falling(law, 100.0, 20.0, 0.1), rtol=1e-7)
    for column, step in enumerate((1e-5, 1e-7, 1e-9, 1e-5)):
        moved = []
        for way in (step, -step):
            other = np.array([*law, 100.0])
            other[column] += way
            moved.append(speeds(other[:3], float(other[3]), time)[0])
        expected = (moved[0] - moved[1]) / (2.0 * step)
        assert np.allclose(derivatives[:, column], expected, rtol=1e-5, atol=1e-5 * np.abs(expected).max())


def test_a_wheel_that_stands_stays_so() -> None:
    speed, derivatives = speeds(np.array([10.0, 0.0, 0.0]), 10.0, np.linspace(0.0, 3.0, 31))
    assert speed[9] == pytest.approx(1.0)
    assert not speed[11:].any()
    assert not derivatives[11:].any()


def test_the_terms_of_the_example_are_found() -> None:
    found = hersey.coast_down(LOG, inertia="0.012 kg*m^2 ± 2 %")
    for term, truth in zip((found.coulomb, found.viscous, found.windage), TERMS, strict=True):
        assert term.low < truth < term.high
        assert term.value == pytest.approx(truth, rel=0.03)
    assert found.terms_shown == ("Coulomb", "viscous", "windage")
    assert [each.stops for each in found.coasts] == [True, False]
    assert found.coasts[1].slowest == pytest.approx(60.0, rel=0.05)
    assert {"standing", "rising", "ends"} <= {each.why for each in found.left_out}
    assert kinds(found) == {"temperature not known"}
    value, low, high = found.torque_at("1000 rpm")
    speed = 1000.0 * np.pi / 30.0
    truth = TERMS[0] + TERMS[1] * speed + TERMS[2] * speed**2
    assert low[0] < truth < high[0]
    assert (high[0] - low[0]) / 2.0 / value[0] == pytest.approx(0.02, rel=0.05)


def test_an_inertia_without_an_error_is_told() -> None:
    found = hersey.coast_down(LOG, inertia="0.012 kg*m^2")
    (exact,) = [each for each in found.warnings if each.kind == "inertia taken as exact"]
    assert exact.values == {"inertia": 0.012}
    assert "0.012 kg*m^2 ± 2 %" in exact.sentence
    assert (found.coulomb.high - found.coulomb.low) / found.coulomb.value < 0.02


def test_points_carry_their_own_errors_and_the_shared_one() -> None:
    points = hersey.coast_down(LOG, inertia="0.012 kg*m^2 ± 2 %").points()
    torque, speed, error = (points.column(name) for name in ("torque", "speed", "torque_error"))
    truth = TERMS[0] + speed * (TERMS[1] + speed * TERMS[2])
    assert np.mean(np.abs(torque - truth) < 2.0 * error) > 0.8
    assert points.window_errors[:, 0] == pytest.approx(0.02 / 1.96 * torque)
    assert np.isfinite(points.log.runs[0].torque).all()
    assert set(points.column("approach")) == {"from above"}


def test_points_and_what_is_excluded_are_all_rows() -> None:
    for log in (LOG, frame(falling((1.0, 0.05, 0.0), 100.0, 40.0, 0.001), 0.001)):
        points = hersey.coast_down(log, inertia=0.012).points()
        excluded = sum(each.rows for each in points.rejected)
        assert points.column("rows").sum() + excluded == points.log.rows
    kinds_of = {each.why.kind for each in hersey.coast_down(LOG, inertia=0.012).points().rejected}
    assert kinds_of == {"standing", "rising", "ends", "no window"}


def test_the_table_of_points_holds_the_shared_error_and_what_is_excluded(tmp_path: Path) -> None:
    found = hersey.coast_down(LOG, inertia="0.012 kg*m^2 ± 2 %")
    (tmp_path / "points.csv").write_text(found.table())
    again, points = hersey.SteadyPoints.from_table(tmp_path / "points.csv"), found.points()
    assert again.window_errors == pytest.approx(points.window_errors, rel=1e-5)
    assert again.column("torque_error") == pytest.approx(points.column("torque_error"), rel=1e-5)
    assert hersey.fit(again).c.error == pytest.approx(hersey.fit(points).c.error, rel=1e-3)
    assert "# excluded: 41 rows at 0 to 4 s, drive at standstill" in found.table()
    assert "shared" not in hersey.coast_down(LOG, inertia=0.012).table()


def test_points_are_fitted_like_dwells() -> None:
    """Torque as speed^0.6 is no law of three terms, and is found from the windows."""
    time = np.arange(0.0, 25.0, 0.02)
    speed = (100.0**0.4 - 0.4 * 0.5 * time) ** 2.5
    found = hersey.coast_down(frame(speed[speed > 3.0], 0.02), inertia=0.01)
    (told,) = [each for each in found.warnings if each.severity == "act"]
    assert told.kind == "negative friction term"
    surface = hersey.fit(found.points())
    assert surface.c.low < -0.4 < surface.c.high


def test_a_coast_of_high_speeds_alone_does_not_separate_its_terms() -> None:
    speed = falling((1.0, 0.05, 0.0), 100.0, 4.0, 0.01)
    found = hersey.coast_down(frame(speed, 0.01, 0.3), inertia="0.01 kg*m^2 ± 1 %")
    (told,) = [each for each in found.warnings if each.kind == "friction terms not separated"]
    assert told.number("slow") > 50.0
    assert "lower speeds" in told.sentence
    assert found.coulomb.high > 0.01
    assert found.viscous.high > 5e-4
    truth = 0.01 * (1.0 + 0.05 * found.speeds)
    assert ((found.low < truth) & (truth < found.high)).all()


def test_a_term_that_is_not_there_has_a_limit() -> None:
    speed = falling((0.0, 0.1, 0.0), 100.0, 30.0, 0.05)
    found = hersey.coast_down(frame(speed), inertia="0.01 kg*m^2 ± 1 %")
    assert found.terms_shown == ("viscous",)
    assert (found.coulomb.low, found.windage.low) == (0.0, 0.0)
    assert 0.0 < found.coulomb.high < 1e-3 * 0.1


def test_brake_and_drive_are_left_out() -> None:
    first = falling((1.0, 0.05, 5e-4), 100.0, 8.0, 0.02)
    held = np.full(300, first[-1])
    rest = falling((1.0, 0.05, 5e-4), float(first[-1]), 8.0, 0.02)
    brake = np.linspace(rest[-1], 0.0, 120)
    whole = np.concatenate([np.full(200, 100.0), first, held, rest, brake, np.zeros(100)])
    found = hersey.coast_down(frame(whole, 0.02), inertia="0.01 kg*m^2 ± 1 %")
    told = {each.values["what"] for each in found.warnings if each.kind == "parts left out"}
    assert told == {"driven", "braked"}
    assert len(found.coasts) == 2
    for term, truth in zip((found.coulomb, found.viscous, found.windage), (0.01, 5e-4, 5e-6), strict=True):
        assert term.low < truth < term.high


def test_a_wheel_driven_through_standstill_does_not_coast() -> None:
    down = np.concatenate([np.full(200, 100.0), np.linspace(100.0, -100.0, 400), np.full(200, -100.0)])
    with pytest.raises(InsufficientDataError, match="speed falls freely nowhere") as error:
        hersey.coast_down(frame(down), inertia=0.01)
    assert "without drive and brake" in error.value.remedy


def test_coasts_that_differ_are_told_and_widen_the_intervals() -> None:
    parts = []
    for scale in (0.8, 1.0, 1.2):
        parts += [np.full(100, 100.0), falling((scale, 0.05 * scale, 0.0), 100.0, 20.0, 0.05)]
    found = hersey.coast_down(frame(np.concatenate(parts)), inertia="0.01 kg*m^2 ± 1 %")
    (told,) = [each for each in found.warnings if each.kind == "coasts differ"]
    assert told.number("share") == pytest.approx(0.2, abs=0.03)
    assert found.difference == pytest.approx(0.2, abs=0.03)
    truth = 0.01 * (1.0 + 0.05 * found.speeds)
    assert ((found.low < truth) & (truth < found.high)).all()
    points = found.points()  # Student's t of two freedoms beside the normal: 4.303 and 1.960
    shared = np.abs(points.window_errors[:, 0] / points.column("torque"))
    assert shared == pytest.approx(found.difference / np.sqrt(3.0) * 4.303 / 1.960, rel=2e-3)


def test_noise_of_rows_is_seen_beside_a_fall() -> None:
    seen = np.linspace(100.0, 20.0, 4000) + np.random.default_rng(3).normal(0.0, 0.3, 4000)
    assert noise_of_rows(seen) == pytest.approx(0.3, rel=0.05)


def test_counts_of_an_encoder_are_fitted_as_an_angle() -> None:
    time = np.arange(0.0, 20.0, 0.01)
    angle = np.cumsum(falling((1.0, 0.05, 0.0), 100.0, 20.0, 0.01)) * 0.01
    count = 2.0 * np.pi / 400
    seen = np.diff(np.floor(angle / count) * count, prepend=-1.0) / 0.01
    log = pl.DataFrame({"time [s]": time[1:], "speed [rad/s]": seen[1:]})
    found = hersey.coast_down(log, inertia="0.01 kg*m^2 ± 1 %")
    assert found.fit.of_angle
    assert found.viscous.value == pytest.approx(5e-4, rel=2e-3)


def test_a_temperature_that_changes_is_told() -> None:
    speed = falling((1.0, 0.05, 0.0), 100.0, 20.0, 0.05)
    hot = {"temperature [degC]": np.linspace(40.0, 50.0, speed.size)}
    found = hersey.coast_down(frame(speed, **hot), inertia="0.01 kg*m^2 ± 1 %")
    (told,) = found.warnings
    assert told.kind == "temperature changed"
    assert told.number("hot") - told.number("cold") == pytest.approx(10.0, abs=1.0)
    assert found.points().log.has_temperature


@pytest.mark.parametrize(
    ("column", "mapped", "units", "why"),
    [
        ("", "", {}, None),
        ("", "", {"temperature": "degC"}, "no temperature column found"),
        ("", "oil", {}, "there is no column 'oil' (temperature)"),
        ("oil temp", "", {}, "column 'oil temp' has no unit, so no temperature is used"),
        ("oil temp", "", {"temperature": "degC"}, ""),
    ],
)
def test_a_temperature_is_used_if_it_is_there(
    column: str, mapped: str, units: dict[str, str], why: str | None, tmp_path: Path
) -> None:
    """A mapping that named one stopped the command, where none at all was no matter."""
    log = tmp_path / "coast.csv"
    head, *rows = [line for line in LOG.read_text().splitlines() if not line.startswith("#")]
    more = (f",{column}", ",20") if column else ("", "")
    log.write_text("\n".join([head + more[0], *(row + more[1] for row in rows)]))
    if mapped:
        (tmp_path / "hersey.toml").write_text(f"[temperature]\nchannel = '{mapped}'\n")
    found = hersey.coast_down(Recipe(logs=(log,), units=units).speeds(), inertia="0.012 kg*m^2 ± 2 %")
    of_temperature = {each.kind: each.sentence for each in found.warnings if "temperature" in each.kind}
    assert set(of_temperature) == (
        set() if why == "" else {"temperature not known"} | ({"temperature not read"} if why else set())
    )
    assert (why or "") in of_temperature.get("temperature not read", "")


def test_a_temperature_that_is_asked_for_must_be_there(tmp_path: Path) -> None:
    typed = ["coastdown", str(LOG), "--inertia", "0.012 kg*m^2", "--temperature", "oil"]
    done = run(*typed, cwd=tmp_path)
    assert done.returncode == 2
    assert "there is no column 'oil' (temperature)" in done.stderr


def test_a_log_of_dwells_does_not_coast() -> None:
    stairs = np.repeat([100.0, 80.0, 60.0, 40.0, 20.0, 10.0, 5.0], 200)
    with pytest.raises(InsufficientDataError, match="speed falls freely nowhere") as error:
        hersey.coast_down(frame(stairs, noise=0.2), inertia=0.01)
    assert "let the wheel coast to rest" in error.value.remedy


def stairs(levels: list[float], rows: int = 150, settling: float = 5.0) -> FloatArray:
    """A staircase of held speeds, each approached exponentially in so many rows."""
    parts = [np.full(rows, levels[0])]
    for before, level in pairwise(levels):
        parts.append(level + (before - level) * np.exp(-np.arange(1, rows) / settling))
    return np.concatenate(parts)


def test_a_staircase_that_settles_shortly_is_no_coast() -> None:
    """Its eight falls were taken for coasts, each with the speed that is held after it."""
    with pytest.raises(InsufficientDataError, match="steps between held speeds 3 %") as error:
        hersey.coast_down(ROOT / "examples" / "no-load.csv", inertia=0.01)
    assert "let the wheel coast to rest, or end the log where the drive takes hold" in error.value.remedy
    for noise in (0.02, 0.2):
        with pytest.raises(InsufficientDataError, match="steps between held speeds"):
            hersey.coast_down(frame(stairs([100.0, 60.0, 35.0, 20.0, 12.0]), 0.1, noise), inertia=0.01)


def test_a_coast_beside_a_staircase_is_found() -> None:
    coasting = falling((1.0, 0.05, 0.0), 100.0, 40.0, 0.1)
    up = np.concatenate([np.linspace(10.0, 100.0, 40), np.full(50, 100.0)])
    whole = np.concatenate([stairs([100.0, 60.0, 30.0, 10.0]), up, np.maximum(coasting, 0.0)])
    found = hersey.coast_down(frame(whole, 0.1), inertia="0.01 kg*m^2 ± 1 %")
    (coast,) = found.coasts
    assert coast.stops
    assert coast.start > 0.1 * (4 * 149)
    assert found.coulomb.low < 0.01 < found.coulomb.high
    (told,) = [each for each in found.warnings if each.kind == "parts left out"]
    assert (told.values["what"], told.values["count"]) == ("steps between held speeds", 3)


def test_a_coast_that_a_drive_ends_is_found_once_the_log_ends_there() -> None:
    coasting = falling((1.0, 0.05, 0.0), 100.0, 18.0, 0.1)
    whole = np.concatenate([np.full(50, 100.0), coasting, np.full(300, coasting[-1])])
    with pytest.raises(InsufficientDataError, match="steps between held speeds"):
        hersey.coast_down(frame(whole, 0.1), inertia=0.01)
    found = hersey.coast_down(frame(whole[:230], 0.1), inertia="0.01 kg*m^2 ± 1 %")
    assert found.viscous.low < 5e-4 < found.viscous.high


@pytest.mark.parametrize(
    ("given", "half"),
    [
        ("0.012 kg*m^2", 0.0),
        ("0.012 kg*m^2 ± 2 %", 2.4e-4),
        ("120 kg*cm^2 +/- 1.2 kg*cm^2", 1.2e-4),
        (0.012, 0.0),
    ],
)
def test_an_inertia_is_read_with_its_error(given: object, half: float) -> None:
    known = inertia_of(given)
    assert known.value == pytest.approx(0.012)
    assert known.high - known.value == pytest.approx(half)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("0.012", "inertia: '0.012' is not a number with a unit"),
        ("-0.012 kg*m^2", "greater than 0"),
        ("0.012 kg*m^2 ± 2", "the error has no unit. Write e.g. '0.012 kg"),
        ("0.012 kg*m^2 ± 200 %", "smaller than the value"),
        ("0.012 kg*m^2 ± -2 %", "smaller than the value"),
        ("0.012 N*m", "N"),
    ],
)
def test_what_is_no_inertia_is_refused(given: str, said: str) -> None:
    with pytest.raises((ParameterError, UnitError), match=said.replace("*", r"\*")):
        inertia_of(given)


def test_the_command_prints_torque_and_terms(tmp_path: Path) -> None:
    done = run("coastdown", str(LOG), "--inertia", "0.012 kg*m^2 ± 2 %", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "2 coast-downs found." in done.stdout
    assert "Coulomb: 7.9" in done.stdout
    assert "[7.77, 8.10] mN m" in done.stdout


def followed(said: str, tmp_path: Path) -> str:
    """What the line that is proposed prints."""
    line = said.partition("its moment of inertia: ")[2].split("\n")[0]
    done = run(*shlex.split(line)[1:], cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_log_without_torque_that_coasts_is_sent_to_coastdown(tmp_path: Path) -> None:
    (tmp_path / "a coast.csv").write_text(LOG.read_text())
    done = run("fit", "a coast.csv", cwd=tmp_path)
    assert done.returncode == 2
    assert "hersey cycles" not in done.stderr
    assert "2 coast-downs found." in followed(done.stderr, tmp_path)
    shown = run("inspect", "a coast.csv", cwd=tmp_path).words
    assert "hersey coastdown 'a coast.csv' --inertia" in shown


def test_options_of_the_speed_are_kept_in_the_line_that_is_proposed(tmp_path: Path) -> None:
    text = LOG.read_text().replace("time [s],speed [rpm]", "t,n")
    (tmp_path / "coast.csv").write_text(text)
    units = ("--time-unit", "s", "--speed-unit", "rpm", "--speed-sign", "-1")
    done = run("fit", "coast.csv", *units, "--moving", "--inertia", "0.012 kg*m^2", cwd=tmp_path)
    assert "Coulomb: 7.9" in followed(done.stderr, tmp_path)
    bare = run("models", "coast.csv", cwd=tmp_path)
    assert "type, with its moment of inertia: hersey coastdown coast.csv --inertia" in bare.stderr


def test_a_staircase_without_torque_is_not_sent_to_coastdown(tmp_path: Path) -> None:
    frame(stairs([100.0, 60.0, 35.0, 20.0])).write_csv(tmp_path / "stairs.csv")
    assert "coastdown" not in run("fit", "stairs.csv", cwd=tmp_path).stderr


def test_python_is_sent_to_coast_down_too() -> None:
    with pytest.raises(ChannelError, match="no torque column") as error:
        hersey.read(LOG)
    assert "use hersey.coast_down('coast-down.csv', inertia='0.012 kg" in error.value.remedy


def test_a_missing_inertia_is_asked_for(tmp_path: Path) -> None:
    done = run("coastdown", str(LOG), cwd=tmp_path)
    assert done.returncode == 2
    assert "add --inertia '0.012 kg*m^2 ± 2 %'" in done.stderr
    again = run("coastdown", str(LOG), "--inertia", "0.012 kg*m^2 ± 2 %", "--json", cwd=tmp_path)
    assert again.returncode == 0


@pytest.mark.parametrize("sag", [0.0, 0.05])
def test_a_hold_that_sags_by_a_twentieth_of_the_fall_before_it_is_held(sag: float) -> None:
    time = np.arange(0.0, 40.0, 0.1)
    speed = np.where(
        time < 10.0, 100.0 - 5.0 * time, 50.0 - sag * 50.0 * np.minimum(time - 10.0, 20.0) / 20.0
    )
    (step,) = steps_in(time, speed, 0, time.size, 0.01)
    assert (step.top, step.end) == (0, 400)
    assert 9.5 < time[step.start] < 12.5
