"""One chart per public result: valid by the schema, drawn to a file, its numbers those of the result."""

from __future__ import annotations

import functools
import itertools
import json
import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from typing import Any

import altair as alt
import numpy as np
import pytest
from altair.utils import schemapi
from benchmarks.drift import other, table

import hersey
from hersey import Drag, Drivetrain
from hersey.charts import CHARTS, chart_of
from hersey.charts.render import picture
from hersey.damping.candidates.observations import Observations
from hersey.errors import ParameterError
from hersey.machine.machine import read_machine
from hersey.motion.drag import Drag as AnyDrag
from tests import test_results
from tests.charts.test_charts import titles
from tests.conftest import ROOT
from tests.damping.moving_logs import sine
from tests.life import shipped, test_ageing_maps, test_other_uses
from tests.machines import machine_of, map_of

RPM = 2 * np.pi / 60
EXAMPLES = ROOT / "examples"


@cache
def log() -> hersey.TorqueLog:
    return hersey.read(EXAMPLES / "bench.csv")


@cache
def points() -> hersey.SteadyPoints:
    return log().steady(tare="standing").without(machine().rest)


@cache
def surface() -> hersey.DampingSurface:
    return hersey.fit(points())


@cache
def machine() -> Any:
    return read_machine(EXAMPLES / "machine.toml")


@cache
def models() -> hersey.ModelComparison:
    return hersey.compare_models(points(), bootstrap=0)


@cache
def belt() -> tuple[Drivetrain, AnyDrag]:
    drag = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    return Drivetrain(1000, 1), drag


@cache
def trace() -> np.ndarray:
    return np.loadtxt(EXAMPLES / "stick-slip.csv", delimiter=",", comments="#", skiprows=3)


@cache
def record() -> hersey.CycleRecord:
    time, force = trace().T[:2, :6000]
    return hersey.cycles(time, force, drive_speed=0.02)


def measured() -> hersey.MeasuredFilm:
    return hersey.measured_film(points(), surface(), machine().contact, machine().lubricant, grip=0.3)


def film() -> hersey.Film:
    return hersey.film_thickness(
        machine().contact, machine().lubricant, speed=np.array([1.0, 5.0]), temperature=420.0
    )


def mixed() -> hersey.MixedFilm:
    law = hersey.mixed_contact(
        machine().contact,
        machine().lubricant,
        hersey.Asperities(modulus=5e10),
        0.1,
        speed=8.0,
        temperature=420.0,
    )
    return law.at(speed=[[0.0], [2.0], [80.0]], temperature=[400.0, 420.0])


def plan() -> hersey.Plan:
    drag = surface().drag(
        roll_radius=machine().roll_radius, stick_speed=machine().stick_speed, temperature=423.15
    )
    return hersey.plan_profile(
        machine_of(machine().train, limits=machine().limits, roll_radius=machine().roll_radius),
        drag,
        target_speed=0.1,
    )


def warm_up() -> hersey.WarmUp:
    drag = surface().drag(**machine().belt)
    return hersey.warm_up(
        machine().train, drag, machine().heat, target_speed=0.05, force_limit=180.0, acceleration=0.5
    )


def belt_map() -> hersey.OperatingMap:
    return map_of(
        surface(),
        machine().train,
        roll_radius=machine().roll_radius,
        stick_speed=machine().stick_speed,
        limits=machine().limits,
        points=machine().points,
        temperatures=[390.0, 410.0, 430.0],
        speeds=np.geomspace(0.005, 0.5, 9),
        draws=2,
    )


def coasts() -> hersey.CoastDown:
    return hersey.coast_down(EXAMPLES / "coast-down.csv", inertia="0.012 kg*m^2 ± 2 %")


def logs() -> hersey.LogComparison:
    data = Observations.of(points())
    return hersey.compare(data, data, names=("new", "worn"))


@functools.cache
def failures() -> hersey.FailureLaw:
    """Two failure modes, of which each has a line."""
    ages = np.array([4.0, 6.0, 7.0, 9.0, 10.0])
    high = np.array([4.0, 6.0, np.inf, 9.0, 10.0])
    modes = ("wear", "seizure", "", "seizure", "wear")
    return hersey.weibull(hersey.Failures(ages, high, np.ones(5, dtype=int), "h", modes))


#: How each result is made, quickly.
MADE: dict[str, Callable[[], Any]] = {
    "TorqueLog": log,
    "Inspection": lambda: hersey.inspect([EXAMPLES / "bench.csv"]),
    "SteadyPoints": points,
    "FrictionCurve": lambda: hersey.fit_friction(points()),
    "NoLoadTorque": lambda: hersey.NoLoadTorque.stated(constant=0.02, per_speed=0.001, uncertainty=0.1),
    "DampingSurface": surface,
    "ModelComparison": models,
    "LogComparison": logs,
    "CoastDown": coasts,
    "FrictionTrend": lambda: hersey.trend(log(), at="60 rpm"),
    "TestDesign": lambda: hersey.design(models(), count=4, quantity="transition speed"),
    "MovingFit": lambda: sine(hot=True).moving(),
    "Regime": lambda: hersey.regime(points(), surface()),
    "Film": film,
    "MixedFilm": mixed,
    "MeasuredFilm": measured,
    "Trajectory": lambda: hersey.simulate(*belt(), drive_speed=1.0, duration=5.0, samples=301),
    "StickSlipCycle": lambda: hersey.stick_slip(*belt(), drive_speed=0.8),
    "CycleRecord": record,
    "IdentifiedDrive": lambda: hersey.identify(record(), known={"mass": 0.5}, closures=("retained",)),
    "HysteresisBand": lambda: hersey.hysteresis(*belt()),
    "OperatingMap": belt_map,
    "Plan": plan,
    "WarmUp": warm_up,
    "FailureLaw": lambda: failures(),
    "RemainingLife": lambda: hersey.remaining_life(failures(), 5.0),
    "FleetForecast": lambda: hersey.fleet_forecast(failures(), [0.0, 5.0], 3.0),
    "Replacement": lambda: hersey.replacement_age(failures(), 5.0),
    "LifeTestPlan": lambda: hersey.life_test_plan(3.0, shape=2.0, unit="h"),
    "Drift": lambda: hersey.fit_drift(table(other("lubricant", 1, units=2, logs=3))),
    "FilmLife": lambda: shipped.film(1),
    "Growth": lambda: test_results.growth(),
    "AgesAtLimit": lambda: test_results.growth().reaches(2.0),
    "TimeToFailure": lambda: test_results.ends(),
    "OtherUses": test_other_uses.by_hand,
    "AgeingMaps": test_ageing_maps.maps,
    "LifeTest": lambda: shipped.followed(2),
}


@cache
def result_of(name: str) -> Any:
    return MADE[name]()


@cache
def specification(name: str) -> dict[str, Any]:
    """The chart of a result, made once."""
    found: dict[str, Any] = chart_of(result_of(name)).to_dict(validate=False)
    return found


def valid(part: Any) -> Any:
    """The same with three rows of each layer: the schema asks the same of every row."""
    if isinstance(part, dict):
        return {key: value[:3] if key == "values" else valid(value) for key, value in part.items()}
    return [valid(item) for item in part] if isinstance(part, list) else part


def layers(name: str) -> Iterator[list[dict[str, Any]]]:
    """The rows of each layer that has some."""

    def walk(part: Any) -> Iterator[list[dict[str, Any]]]:
        if isinstance(part, dict):
            values = part.get("data", {}).get("values", []) if isinstance(part.get("data"), dict) else []
            if values:
                yield values
            for key in ("layer", "vconcat", "hconcat"):
                for inner in part.get(key, []):
                    yield from walk(inner)

    yield from walk(specification(name))


def column(name: str, *fields: str) -> list[Any]:
    """The first layer whose rows hold all fields: the first of them."""
    rows = next(rows for rows in layers(name) if all(field in rows[0] for field in fields))
    return [row[fields[0]] for row in rows]


def test_every_kind_is_made_and_has_its_own_name() -> None:
    assert set(MADE) == set(CHARTS)
    assert set(CHARTS) <= set(hersey.__all__)


@pytest.mark.parametrize("name", list(MADE))
def test_it_is_valid_and_drawn(name: str) -> None:
    assert type(result_of(name)).__name__ == name
    shown = specification(name)
    alt.Chart.from_dict(valid(shown), validate=True)
    assert not re.search(r"\b(NaN|Infinity)\b", json.dumps(shown))
    svg = picture(chart_of(result_of(name)), ".svg").decode()
    assert svg.startswith("<svg")
    assert "NaN" not in svg
    assert svg.count("<path") > 10


#: Titles of axes of pure numbers.
WITHOUT_UNIT = {"exponent of damping in speed", "Failures", "Specimens to test"}


@pytest.mark.parametrize("name", list(MADE))
def test_axes_carry_units(name: str) -> None:
    for title in titles(specification(name)) - WITHOUT_UNIT:
        assert "(" in title, title


def test_a_log_keeps_its_extremes() -> None:
    run = log().runs[0]
    speed, torque, temperature = (
        [row["value"] for row in rows] for rows in layers("TorqueLog") if "value" in rows[0]
    )
    assert max(speed) == pytest.approx(run.speed.max() / RPM)
    unit = 1.0 if np.abs(run.torque).max() >= 1.0 else 1e3
    assert (min(torque), max(torque)) == pytest.approx((unit * run.torque.min(), unit * run.torque.max()))
    assert run.temperature is not None
    assert max(temperature) == pytest.approx(run.temperature.max() - 273.15)
    times = column("TorqueLog", "time", "value")
    assert times[0] == 0.0
    assert times == sorted(times)
    assert times[-1] == pytest.approx(run.time[-1] - run.time[0])


def test_dwells_and_their_errors() -> None:
    torque = np.abs(points().column("torque"))
    unit = 1.0 if torque.max() >= 1.0 else 1e3
    assert column("SteadyPoints", "y", "approach") == pytest.approx(unit * torque)
    assert column("SteadyPoints", "high") == pytest.approx(
        unit * (torque + 2 * points().column("torque_error"))
    )
    assert column("SteadyPoints", "speed") == pytest.approx(np.abs(points().column("speed")) / RPM)


def test_a_surface_with_its_limits() -> None:
    span = surface().temperature_range
    assert span is not None
    kelvin = np.linspace(span[0], span[1], 4)
    rows, _, corners, _ = layers("DampingSurface")
    speed = np.array([row["speed"] for row in rows]) * RPM
    torque = surface().torque(speed=speed, temperature=np.repeat(kelvin, speed.size // 4))
    unit = 1.0 if torque.max() >= 1.0 else 1e3
    assert [row["y"] for row in rows] == pytest.approx(unit * torque)
    assert all(row["low"] < row["y"] < row["high"] for row in rows)
    bends = [surface().transition_speed(t) for t in kelvin.tolist()]
    low, high = surface().speed_range
    assert [row["speed"] * RPM for row in corners] == pytest.approx([v for v in bends if low < v < high])


def test_a_mixed_contact_and_where_it_turns() -> None:
    _, part, corners, whole, marks = layers("MixedFilm")
    assert part[0]["y"] < 0.1 * whole[0]["y"]
    assert part[-1]["y"] == pytest.approx(whole[-1]["y"])
    turns = result_of("MixedFilm").transition
    assert [row["speed"] * RPM for row in corners] == pytest.approx(turns.speed[0])
    shown = result_of("MixedFilm").torque[1:].ravel()  # rest has no place on a logarithmic axis
    unit = marks[0]["y"] / shown[0]
    assert [row["y"] for row in marks] == pytest.approx(unit * shown)


def test_candidates_by_how_much_worse_they_are() -> None:
    assert column("ModelComparison", "worse") == [c.delta_aicc for c in models().candidates[:10]]
    texts = dict(
        zip(column("ModelComparison", "name"), column("ModelComparison", "text", "name"), strict=True)
    )
    assert [name for name, text in texts.items() if "chosen" in text] == [models().chosen.candidate.key]


def test_dwells_beside_the_chosen_law_have_two_standard_errors() -> None:
    comparison = models()
    rows = next(
        data
        for data in layers("ModelComparison")
        if {"y", "low", "high"} <= data[0].keys() and len(data) == len(comparison.data)
    )
    shares = [row["high"] / row["y"] - 1.0 for row in rows]
    assert shares == pytest.approx((2 * comparison.data.torque_error).tolist(), rel=1e-3)


def test_two_logs_that_are_the_same() -> None:
    assert column("LogComparison", "ratio") == pytest.approx(np.ones(result_of("LogComparison").ratio.size))
    assert column("LogComparison", "low") == pytest.approx(result_of("LogComparison").low.ravel())


def test_dwells_to_record_and_what_they_are_worth() -> None:
    result = result_of("TestDesign")
    assert column("TestDesign", "number") == ["1", "2", "3", "4"]
    assert column("TestDesign", "speed") == pytest.approx([p.speed / RPM for p in result.points])
    errors = [result.error_now, *(p.error for p in result.points)]
    assert column("TestDesign", "value") == pytest.approx([e / RPM for e in errors])


def test_exponents_and_names_that_do_not_overlap() -> None:
    result = result_of("Regime")
    assert column("Regime", "value", "branch") == [b.exponent.value for b in result.exponents]
    chart = specification("Regime")
    named = [part for part in chart["layer"] if isinstance(part["encoding"].get("y", {}).get("value"), int)]
    assert len(named) == len(result.hypotheses)
    low, high = named[0]["encoding"]["x"]["scale"]["domain"]
    rows: dict[int, list[tuple[float, float]]] = {}
    for part in named:
        ((row,),) = [part["data"]["values"]]
        at, width = chart["width"] * (row["low"] - low) / (high - low), 6.0 * len(row["text"])
        left = at - width * {"left": 0.0, "center": 0.5, "right": 1.0}[part["mark"]["align"]]
        rows.setdefault(part["encoding"]["y"]["value"], []).append((left, left + width))
    assert min(np.diff(sorted(rows)), default=15) >= 14
    for spans in rows.values():
        ordered = sorted(spans)
        assert all(one[1] < other[0] for one, other in itertools.pairwise(ordered))


def test_films_on_their_chart() -> None:
    assert column("Film", "g_v", "name") == pytest.approx(film().g_v.ravel())
    assert column("Film", "name") == [f"{v / RPM:.3g} rpm, 147 °C" for v in (1.0, 5.0)]
    assert column("MeasuredFilm", "friction", "level") == pytest.approx(measured().friction)


def test_a_motion_and_its_modes() -> None:
    run = result_of("Trajectory")
    assert column("Trajectory", "value") == pytest.approx(run.belt_speed)
    assert len(column("Trajectory", "mode")) == len(run.events) + 1
    assert column("Trajectory", "to")[-1] == pytest.approx(5.0)


def test_a_lap_of_sticking_and_slipping() -> None:
    cycle = result_of("StickSlipCycle")
    assert cycle.kind == "stick_slip"
    assert column("StickSlipCycle", "to", "part") == pytest.approx(
        [cycle.stick_duration, 1 / cycle.frequency]
    )
    spans = [(row["low"], row["high"]) for rows in layers("StickSlipCycle") for row in rows if "high" in row]
    assert spans == [(cycle.speed_min, cycle.speed_max), (cycle.stretch_min, cycle.stretch_max)]


def test_steady_sliding_has_no_lap() -> None:
    settled = hersey.stick_slip(*belt(), drive_speed=20.0)
    assert settled.frequency == 0
    text = json.dumps(chart_of(settled).to_dict(validate=True))
    assert "Time in one cycle" not in text
    assert "steady sliding" in text


def test_the_layers_of_a_map_are_not_copied(monkeypatch: pytest.MonkeyPatch) -> None:
    found, copied = belt_map(), []
    copies = schemapi._deep_copy

    def counted(*given: Any) -> Any:
        copied.append(given)
        return copies(*given)

    monkeypatch.setattr(schemapi, "_deep_copy", counted)
    chart_of(found)
    assert len(copied) < 100


def test_a_band_and_its_three_speeds() -> None:
    band = result_of("HysteresisBand")
    spans = next(iter(layers("HysteresisBand")))
    states = {row["state"]: (row["from"], row["to"]) for row in spans}
    assert states["depends on start"] == (band.transition, band.upper)
    assert states["sticks"][1] == band.lower
    assert column("HysteresisBand", "from", "text")[-1] == band.upper


def test_cycles_and_the_drive_behind_them() -> None:
    drive = result_of("IdentifiedDrive")
    rows = {row["line"]: [] for rows in layers("IdentifiedDrive") for row in rows}  # type: ignore[var-annotated]
    for layer in layers("IdentifiedDrive"):
        for row in layer:
            rows[row["line"]].append(row["force"])
    assert rows["fitted motion"] == pytest.approx(drive.fitted)
    assert rows["mean cycle"] == pytest.approx(drive.waveform.force)
    assert column("CycleRecord", "drop") == pytest.approx(record().drop)


def test_channels_and_where_their_faults_begin() -> None:
    (file,) = result_of("Inspection").files
    assert column("Inspection", "end") == [c.traits.rows for c in file.channels]
    faults = [f.first + 1 for c in file.channels for f in c.traits.faults]
    shown = [row["row"] for rows in layers("Inspection") for row in rows if "kind" in row]
    assert shown == faults


def test_choices_are_passed_on() -> None:
    text = json.dumps(chart_of(result_of("Trajectory"), units=("in", "ozf", "s")).to_dict(validate=False))
    assert "Sliding speed (in/s)" in text
    assert "Spring force (ozf)" in text


def test_what_has_no_chart_says_so() -> None:
    with pytest.raises(ParameterError, match="no chart of an object of type int"):
        chart_of(3)


def test_a_warm_up_shows_its_course_and_its_temperatures() -> None:
    warm = result_of("WarmUp")
    rows = [rows for rows in layers("WarmUp") if "value" in rows[0] and "time" in rows[0]]
    assert [row["value"] for row in rows[0]] == pytest.approx(1e3 * warm.drive_speed)
    assert [row["value"] for row in rows[-1] if row["body"] == "film"] == pytest.approx(
        warm.film_temperature - 273.15
    )


def test_the_film_of_a_unit_stands_over_its_layer() -> None:
    film = result_of("FilmLife")
    curve, _, _, points = [rows for rows in layers("FilmLife") if {"unit", "value", "low"} <= set(rows[0])][
        :4
    ]
    assert {row["unit"] for row in curve} == {row["unit"] for row in points} == set(film.runs.units)
    assert [row["age"] for row in points] == film.runs.age.tolist()
    layer = next(rows for rows in layers("FilmLife") if "need" in rows[0])
    assert layer[0]["need"] == pytest.approx(1e6 * film.needs[0][0, 0])
    assert layer[0]["value"] > layer[0]["need"]


def test_a_probability_plot_shows_modes_law_band_points_and_suspensions() -> None:
    modes, band, line, points, ticks = layers("FailureLaw")
    law = failures()
    assert {row["mode"] for row in modes} == {"wear", "seizure"}
    assert all(row["low"] <= row["age"] <= row["high"] for row in band)
    assert [row["age"] for row in line] == [row["age"] for row in band]
    assert [row["share"] for row in points] == pytest.approx(100 * law.positions[1])
    assert [row["age"] for row in ticks] == [7.0]


def test_failures_without_a_law_still_show_their_specimens() -> None:
    for failed in ([False, False], [True, False], [True, True]):
        law = hersey.weibull([10.0, 10.0], failed)
        shown = chart_of(law).to_dict(validate=False)
        alt.Chart.from_dict(valid(shown), validate=True)
        assert law.warnings[0].sentence in shown["title"]["subtitle"]


def test_a_motion_with_temperature_as_a_state_shows_it() -> None:
    drag = surface().drag(**machine().belt)
    run = hersey.simulate(
        machine().train, drag, drive_speed=0.03, temperature=machine().heat, duration=5.0, samples=51
    )
    shown = chart_of(run).to_dict(validate=False)
    assert "Temperature (°C)" in titles(shown)
    assert "Temperature (°C)" not in titles(specification("Trajectory"))
    alt.Chart.from_dict(valid(shown), validate=True)
    panel = shown["vconcat"][2]["data"]["values"]
    assert [row["value"] for row in panel if row["body"] == "counterbody"] == pytest.approx(
        run.roll_temperature - 273.15
    )


def test_drift_shows_each_unit_as_far_as_it_was_followed() -> None:
    drift = result_of("Drift")
    units = [rows for rows in layers("Drift") if "unit" in rows[0]]
    assert len(units) == len(drift.quantities)
    level = [row for row in units[0] if row["unit"] == drift.units[1]]
    assert level[-1]["age"] == drift.last_age[1]
    assert [row["value"] for row in level] == pytest.approx(1e3 * drift.quantities[0].curves[1])
    band = next(rows for rows in layers("Drift") if "low" in rows[0])
    assert all(row["low"] < row["value"] < row["high"] for row in band)


@pytest.mark.parametrize(("at_once", "shown"), [(185.0, False), (195.0, True), (205.0, True)])
def test_drag_at_once_has_a_level_where_it_is_beyond_what_the_warm_up_keeps(
    at_once: float, shown: bool
) -> None:
    warm = replace(result_of("WarmUp"), force_limit=200.0, margin=0.05, drag_at_once=at_once)
    assert warm.kept_below == pytest.approx(190.0)
    assert ('"at once"' in json.dumps(chart_of(warm).to_dict())) == shown
