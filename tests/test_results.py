"""Every result answers alike: in words, as JSON, as a table, in one line, and with a chart in a notebook."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import altair as alt
import numpy as np
import polars as pl
import pytest
from benchmarks.drift import other, table

import hersey
from hersey import testbench
from hersey.charts.render import picture
from hersey.damping.compare import LogComparison
from hersey.damping.friction_curve.result import FrictionCurve
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.document.parts.cycles import CyclesPart
from hersey.document.parts.drift import DriftPart
from hersey.document.parts.fit import FitPart
from hersey.document.parts.life_test import LifeTestPart
from hersey.document.parts.log import LogPart, PointsPart
from hersey.document.parts.models import ModelsPart
from hersey.document.parts.motion import StickSlipPart
from hersey.document.parts.posterior import PosteriorPart
from hersey.document.parts.stability import BandPart
from hersey.document.parts.study import StudyPart
from hersey.errors import MissingFileError
from hersey.identification.identified_drive import IdentifiedDrive
from hersey.inspection.inspecting import Inspection
from hersey.motion.trajectory import Trajectory
from hersey.result import LINE, Result, json_value, table_of
from hersey.schema.record import part_of
from hersey.stability.operating_map.result import OperatingMap
from hersey.stability.plan.result import Plan
from hersey.stability.warm_up_result import WarmUp
from hersey.study.first_screen.result import DesignPart
from hersey.study.nip_film import FilmPart, MeasuredFilmPart, MixedPart, VerdictPart
from hersey.verdict.contact_verdict import verdict
from hersey.verdict.regime import Regime
from tests.conftest import ROOT
from tests.damping.moving_logs import sine
from tests.life import shipped, test_ageing_maps, test_other_uses
from tests.machines import machine_of, map_of

BENCH = ROOT / "examples" / "bench.csv"
COASTS = ROOT / "examples" / "coast-down.csv"
TRAIN = hersey.Drivetrain(1000, 1)
DRAG = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)


@cache
def log() -> hersey.TorqueLog:
    return hersey.read(BENCH)


@cache
def points() -> hersey.SteadyPoints:
    return log().steady(tare="standing")


@cache
def surface() -> hersey.DampingSurface:
    return hersey.fit(points())


@cache
def machine() -> hersey.Machine:
    return hersey.read_machine(ROOT / "tests" / "stand" / "machine.toml")


@cache
def moving() -> hersey.MovingFit:
    return sine().moving()


@cache
def models() -> hersey.ModelComparison:
    return hersey.compare_models(points(), bootstrap=0, cross_validate=False)


@cache
def run() -> hersey.Trajectory:
    return hersey.simulate(TRAIN, DRAG, drive_speed=1.0, duration=10.0, samples=10001)


@cache
def record() -> hersey.CycleRecord:
    return hersey.cycles(run().time, run().spring_force, drive_speed=1.0)


@cache
def measured() -> hersey.MeasuredFilm:
    contact, lubricant = machine().contact, machine().lubricant
    assert contact is not None
    assert lubricant is not None
    return hersey.measured_film(points(), surface(), contact, lubricant)


def film() -> hersey.Film:
    contact, lubricant = machine().contact, machine().lubricant
    assert contact is not None
    assert lubricant is not None
    return hersey.film_thickness(contact, lubricant, speed=[2.0, 8.0], temperature=400.0)


def mixed() -> hersey.MixedFilm:
    contact, lubricant = machine().contact, machine().lubricant
    assert contact is not None
    assert lubricant is not None
    law = hersey.mixed_contact(
        contact, lubricant, hersey.Asperities(modulus=5e10), 0.1, speed=8.0, temperature=400.0
    )
    return law.at(speed=[2.0, 80.0], temperature=400.0)


def map_() -> hersey.OperatingMap:
    m = machine()
    return map_of(
        surface(),
        m.train,
        roll_radius=m.roll_radius,
        stick_speed=m.stick_speed,
        points=m.points,
        temperatures=[380.0, 420.0],
        speeds=[0.01, 0.1],
        draws=2,
    )


def plan() -> hersey.Plan:
    limits = hersey.Limits(speed=4, acceleration=10)
    return hersey.plan_profile(machine_of(TRAIN, limits=limits), DRAG, target_speed=1.2)


def warm_up() -> hersey.WarmUp:
    heat = machine().heat
    assert heat is not None
    drag = surface().drag(**machine().belt)
    return hersey.warm_up(machine().train, drag, heat, target_speed=0.05, force_limit=180.0, acceleration=0.5)


def judged() -> Any:
    contact, lubricant = machine().contact, machine().lubricant
    assert contact is not None
    assert lubricant is not None
    return verdict(measured(), surface(), contact, lubricant, hersey.regime(points(), surface()))


@cache
def growth() -> hersey.Growth:
    return hersey.fit_growth(
        ["A"] * 3 + ["B"] * 3, [0, 1, 2] * 2, [1, 1.2, 1.4, 1, 1.3, 1.6], laws=["linear"]
    )


@cache
def ends() -> hersey.TimeToFailure:
    runs = hersey.Runs(tuple(range(6)), ("A",) * 3 + ("B",) * 3, np.array([0.0, 1.0, 2.0] * 2), "h")
    torque = np.array([1, 1.2, 1.4, 1, 1.3, 1.6])
    indicator = hersey.Indicator("torque", "motor torque", "N m", 2.0, torque, np.full(6, 0.01))
    return hersey.time_to_failure(hersey.Indicators(runs, (indicator,)))


def failures() -> hersey.FailureLaw:
    return hersey.weibull([4.0, 6.0, 7.0, 9.0], [True, True, False, True], unit="h")


#: How each result is made, and the part of the document that holds it.
RESULTS: dict[str, tuple[Callable[[], Any], type]] = {
    "TorqueLog": (log, LogPart),
    "SteadyPoints": (points, PointsPart),
    "DampingSurface": (surface, FitPart),
    "NoLoadTorque": (lambda: hersey.NoLoadTorque.stated(constant=0.02, uncertainty=0.1), NoLoadTorque),
    "MovingFit": (moving, hersey.MovingFit),
    "Regime": (lambda: hersey.regime(points(), surface()), Regime),
    "Film": (film, FilmPart),
    "MixedFilm": (mixed, MixedPart),
    "MeasuredFilm": (measured, MeasuredFilmPart),
    "Verdict": (judged, VerdictPart),
    "Trajectory": (run, Trajectory),
    "StickSlipCycle": (lambda: hersey.stick_slip(TRAIN, DRAG, drive_speed=1.0), StickSlipPart),
    "HysteresisBand": (lambda: hersey.hysteresis(TRAIN, DRAG), BandPart),
    "OperatingMap": (map_, OperatingMap),
    "Plan": (plan, Plan),
    "Study": (lambda: hersey.study(points()), StudyPart),
    "Posterior": (lambda: hersey.posterior(points(), machine(), draws=200), PosteriorPart),
    "WarmUp": (warm_up, WarmUp),
    "FilmLife": (lambda: shipped.film(1), hersey.FilmLife),
    "OtherUses": (test_other_uses.by_hand, hersey.OtherUses),
    "AgeingMaps": (test_ageing_maps.maps, hersey.AgeingMaps),
    "LifeTest": (lambda: shipped.followed(2), LifeTestPart),
    "FailureLaw": (failures, hersey.FailureLaw),
    "RemainingLife": (lambda: hersey.remaining_life(failures(), 5.0), hersey.RemainingLife),
    "FleetForecast": (lambda: hersey.fleet_forecast(failures(), [0.0, 5.0], 3.0), hersey.FleetForecast),
    "Replacement": (lambda: hersey.replacement_age(failures(), 5.0), hersey.Replacement),
    "LifeTestPlan": (lambda: hersey.life_test_plan(3.0, shape=2.0, unit="h"), hersey.LifeTestPlan),
    "Drift": (lambda: hersey.fit_drift(table(other("lubricant", 1, units=2, logs=3))), DriftPart),
    "Growth": (growth, hersey.Growth),
    "FrictionTrend": (lambda: hersey.trend(log(), at="60 rpm"), hersey.FrictionTrend),
    "AgesAtLimit": (lambda: growth().reaches(2.0), hersey.AgesAtLimit),
    "TimeToFailure": (ends, hersey.TimeToFailure),
    "ModelComparison": (models, ModelsPart),
    "FrictionCurve": (lambda: hersey.fit_friction(points()), FrictionCurve),
    "LogComparison": (lambda: hersey.compare(points(), points()), LogComparison),
    "CoastDown": (lambda: hersey.coast_down(COASTS, inertia="0.012 kg*m^2 ± 2 %"), hersey.CoastDown),
    "TestDesign": (lambda: hersey.design(models(), count=1), DesignPart),
    "Inspection": (lambda: hersey.inspect(BENCH), Inspection),
    "CycleRecord": (record, CyclesPart),
    "IdentifiedDrive": (
        lambda: hersey.identify(record(), known={"mass": 1.0}, closures=("retained",)),
        IdentifiedDrive,
    ),
}


#: Results that are words and numbers alone.
WITHOUT_CHART = {"Posterior", "Verdict"}


@pytest.fixture(autouse=True)
def drawn_simply(monkeypatch: pytest.MonkeyPatch) -> None:
    """A picture of one point for every chart: what a chart shows is the concern of the charts."""
    dot = alt.Chart(pl.DataFrame({"x": [1.0]})).mark_point().encode(x="x")
    monkeypatch.setattr("hersey.charts.render.picture", lambda _, kind: picture(dot, kind))


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_answers(name: str) -> None:
    make, kind = RESULTS[name]
    part = part_of(kind)
    result = make()
    assert isinstance(result, Result)
    assert type(result).__name__ == name
    assert result.summary().strip()
    line = repr(result)
    assert line.startswith(f"<{name}: ")
    assert "\n" not in line
    assert len(line) < 160
    plain = result.to_dict()
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    document: Any = part.model_validate(plain)
    assert part.model_validate_json(document.model_dump_json()) == document
    assert set(plain) <= set(document.model_dump())
    check_units(result.to_frame())
    check_pandas(result)
    page = result._repr_html_()
    assert page.startswith("<pre>")
    assert ("<svg" in page) is (name not in WITHOUT_CHART)
    assert "<script" not in page
    assert "src=" not in page


def check_units(table: pl.DataFrame) -> None:
    assert table.height > 0
    if "unit" in table.columns and "value" in table.columns:
        assert table["unit"].null_count() == 0
        return
    for name, kind in table.schema.items():
        assert not kind.is_float() or name.endswith(")") or name == "effective_rows", name


def check_pandas(result: Result) -> None:
    """The same columns, rows and numbers in pandas."""
    table, frame = result.to_frame(), result.to_pandas()
    assert list(frame.columns) == table.columns
    assert len(frame) == table.height
    for name, kind in table.schema.items():
        if kind.is_float():
            np.testing.assert_array_equal(frame[name].to_numpy(), table[name].to_numpy(), name)


def test_a_table_for_pandas_holds_the_same() -> None:
    frame = hersey.NoLoadTorque.stated(constant=0.02, uncertainty=0.1).to_pandas()
    assert type(frame).__module__.split(".")[0] == "pandas"
    assert frame.loc[frame["name"] == "constant", "value"].tolist() == [0.02]
    dwells = points().to_pandas()
    assert dwells["torque (N m)"].tolist() == points().column("torque").tolist()


def test_plot_is_the_chart() -> None:
    dwells = points()
    assert dwells.plot().to_dict() == dwells.chart().to_dict()


def test_without_pandas_the_way_out_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(MissingFileError) as caught:
        points().to_pandas()
    assert str(caught.value) == (
        "to_pandas needs pandas, which is not installed. Run pip install pandas, "
        "or use to_frame() for a polars frame"
    )


def test_every_public_result_is_looked_at() -> None:
    kinds = {name for name in hersey.__all__ if isinstance(getattr(hersey, name), type)}
    results = {name for name in kinds if issubclass(getattr(hersey, name), Result)}
    assert results == set(RESULTS) - {"Verdict"}


def test_a_table_carries_the_numbers() -> None:
    """Values of the frames are those of the results, in the unit of the column."""
    assert log().to_frame().height == log().rows
    assert log().to_frame()["speed (rad/s)"].to_numpy() == pytest.approx(log().runs[0].speed)
    assert points().to_frame()["torque (N m)"].to_numpy() == pytest.approx(points().column("torque"))
    edges = map_().to_frame()
    assert edges["upper (m/s)"].to_list() == map_().upper.tolist()
    assert edges["temperature (K)"].to_list() == [380.0, 420.0]
    c = surface().to_frame().filter(pl.col("name") == "c")
    assert c["value"].item() == surface().c.value
    steps = plan().to_frame()
    assert list(steps.iter_rows()) == plan().rows()
    assert film().to_frame()["torque (N m)"].to_numpy() == pytest.approx(film().torque)


def test_text_of_others_is_escaped_in_a_notebook(tmp_path: Path) -> None:
    path = tmp_path / "<b>log.csv"
    testbench.run(seed=3).write(path)
    page = hersey.read(path)._repr_html_()
    assert "<b>" not in page
    assert "&lt;b&gt;log" in page


def test_a_long_headline_is_cut() -> None:
    class Long(Result):
        def summary(self) -> str:
            return "word " * 100 + "\nmore"

    assert len(repr(Long())) == LINE + 2
    assert repr(Long()).endswith("…>")


def test_json_values_hold_no_number_that_is_none() -> None:
    event = hersey.SafeStep(2.5, 1.2, True, 0.01, float("inf"))
    assert json_value(event)["ramp_time"] is None
    assert json_value({"a": (np.float64(1.0), np.nan, np.array([1, 2]))}) == {"a": [1.0, None, [1, 2]]}


def test_a_table_of_facts_leaves_out_what_is_missing() -> None:
    table = table_of([("length", 2.0, "m"), ("mass", None, "kg")])
    assert table.rows() == [("length", 2.0, "m")]
