"""Figs. 13 and 14, the band and the chart: reference values, verdicts that follow them, unstable cycles."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from hersey import (
    CyclesWithoutSticking,
    Drag,
    DragTable,
    Drivetrain,
    cycles_without_sticking,
    hysteresis,
    stick_slip,
)
from hersey.charts.render import specification_of
from hersey.errors import ParameterError, UnitError
from hersey.motion.schedule import Schedule
from paper import (
    Claim,
    Figure,
    OwnFigure,
    PaperFigure,
    Verdict,
    as_json,
    band,
    band_figure,
    chart,
    chart_figure,
    figure_13,
    figure_14,
    markdown,
)
from paper import hysteresis as approach
from paper.sweep import Case
from tests.charts.test_charts import titles

TRAIN = Drivetrain(1000.0, 1.0)
DRAG = Drag(50.0, 1.0, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
FOLD, LOWER = 2.173493, 0.981793
HOLDS, IN_DIRECTION, FAILS = Verdict.HOLDS, Verdict.IN_DIRECTION, Verdict.FAILS


@pytest.fixture(scope="module")
def paper() -> tuple[PaperFigure, PaperFigure]:
    return figure_13(), figure_14()


@pytest.fixture(scope="module")
def own() -> tuple[OwnFigure, OwnFigure]:
    return band_figure(), chart_figure()


@pytest.fixture(scope="module")
def motions() -> band.Motions:
    return band.motions_of(Case())


def claim(figure: Figure, words: str) -> Claim:
    """The one claim of a figure whose statement has these words."""
    (found,) = [c for c in figure.claims if words in c.statement]
    return found


# Figs. 13 and 14


def test_from_below_it_sticks_at_1_9(paper: tuple[PaperFigure, PaperFigure]) -> None:
    found = claim(paper[0], "reached from below")
    assert found.verdict is HOLDS
    assert found.numbers["frequency"] == pytest.approx(4.751533, abs=6e-7)
    assert found.numbers["speed_max"] == pytest.approx(4.343123, abs=6e-7)
    assert found.numbers["stuck_fraction"] == pytest.approx(0.219621, abs=6e-7)
    assert found.numbers["fold_speed"] == pytest.approx(FOLD, abs=6e-7)


def test_the_past_decides(paper: tuple[PaperFigure, PaperFigure]) -> None:
    found = claim(paper[0], "the past decides")
    assert found.verdict is HOLDS
    assert found.numbers["lower"] == pytest.approx(LOWER, abs=6e-7)


def test_from_above_it_slides_if_it_comes_down_gently(paper: tuple[PaperFigure, PaperFigure]) -> None:
    found = claim(paper[1], "overshoot to 2.5")
    assert found.verdict is HOLDS
    # -10 in/s2 reaches 1.0 safely, a step does not
    assert 10.0 < found.numbers["steepest_rate"] < 10.6
    assert found.numbers["one_step_slides"] == 0.0


def test_an_overshoot_pays_only_beyond_the_fold(paper: tuple[PaperFigure, PaperFigure]) -> None:
    found = claim(paper[1], "pays")
    assert (found.verdict, found.numbers["helped"], found.numbers["helped_by_too_little"]) == (HOLDS, 12, 0)


def test_every_slower_change_is_safe_and_every_faster_one_is_not() -> None:
    steepest = approach.steepest_safe(Case(drive_speed=1.0))
    for rate in np.geomspace(0.2, 500.0, 41):
        assert approach.sliding(Case(), float(rate)) == (rate < steepest), rate


def test_the_stick_speeds_of_both_figures_are_where_the_fold_is_said_to_be() -> None:
    for speed in (approach.BELOW, approach.OVERSHOOT):
        stick_speed = approach.stick_speed_for(Case(), speed)
        fold = hysteresis(TRAIN, replace(DRAG, stick_speed=stick_speed), sensitivity=False).upper
        assert fold == pytest.approx(speed, rel=1e-3)
    assert math.isnan(approach.stick_speed_for(Case(), 9.0))


@pytest.mark.parametrize(("stick_speed", "below", "above"), [(0.05, FAILS, HOLDS), (0.001, HOLDS, FAILS)])
def test_another_stick_speed_another_verdict(stick_speed: float, below: Verdict, above: Verdict) -> None:
    case = Case(stick_speed=stick_speed)
    found = hysteresis(case.train, case.drag)
    ends = [approach.settled(case, Schedule.of(approach.BELOW))] * 2
    assert approach.sticks_from_below(case, found, ends).verdict is below
    drives = [approach.change(2.5, 1.0), approach.change(2.5, 1.0, math.inf), approach.change(2.0, 1.0)]
    cycles = [approach.settled(case, drive) for drive in drives]
    assert approach.slides_from_above(case, found, cycles).verdict is above


def test_verdicts_follow_the_motions() -> None:
    case, found = Case(), hysteresis(TRAIN, DRAG)
    sticks = stick_slip(TRAIN, DRAG, drive_speed=1.9)
    slides = stick_slip(TRAIN, DRAG, drive_speed=1.9, start="steady")
    assert approach.sticks_from_below(case, found, [sticks, slides]).verdict is IN_DIRECTION
    assert approach.sticks_from_below(case, found, [slides, slides]).verdict is FAILS
    assert approach.past_decides(found, [sticks, sticks, sticks]).verdict is IN_DIRECTION
    assert approach.past_decides(replace(found, upper=0.99), [sticks, slides, slides]).verdict is FAILS
    assert approach.slides_from_above(case, found, [sticks, sticks, sticks]).verdict is IN_DIRECTION
    assert approach.slides_from_above(case, found, [slides, slides, sticks]).numbers["one_step_slides"] == 1.0


def test_the_drive_changes_as_it_says() -> None:
    drive = approach.change(2.5, 1.0, 3.0)
    assert [drive.at(t) for t in (0.0, 2.0, 2.25, 2.5, 9.0)] == pytest.approx([2.5, 2.5, 1.75, 1.0, 1.0])
    step = approach.change(2.5, 1.0, math.inf)
    assert [step.at(1.9), step.at(2.1)] == [2.5, 1.0]


# The band


def test_the_band_closes_at_its_ends(own: tuple[OwnFigure, OwnFigure]) -> None:
    figure = own[0]
    assert [c.verdict for c in figure.claims] == [HOLDS] * 3
    data = {name: np.array(column) for name, column in figure.data.items()}
    assert data["drive speed, without sticking (in/s)"][0] == pytest.approx(FOLD, abs=6e-7)
    assert data["drive speed, without sticking (in/s)"].min() == pytest.approx(LOWER, abs=1e-5)
    assert data["greatest belt speed, without sticking (in/s)"][0] == pytest.approx(
        data["greatest belt speed, stick-slip (in/s)"][-1], rel=1e-5
    )
    # of the stick-slip cycle the table of the model has three drive speeds
    drive = data["drive speed, stick-slip (in/s)"]
    top = np.interp([1.0, 1.6, 1.9], drive, data["greatest belt speed, stick-slip (in/s)"])
    assert top == pytest.approx([3.152923, 3.923558, 4.343123], rel=1e-5)


def test_stable_cycles_are_those_that_a_belt_settles_to(motions: band.Motions) -> None:
    cycles = motions.cycles
    assert np.all(np.diff(cycles.stable.astype(int)) >= 0)
    for drive in (0.985, 0.99, 0.999):
        settled = stick_slip(TRAIN, DRAG, drive_speed=drive, start="steady")
        x = cycles.drive_speed[cycles.stable]
        assert settled.speed_min == pytest.approx(
            np.interp(drive, x, cycles.slowest[cycles.stable]), rel=1e-3
        )
        assert settled.speed_max == pytest.approx(
            np.interp(drive, x, cycles.fastest[cycles.stable]), rel=1e-3
        )


def test_a_curve_in_the_wrong_place_is_seen(motions: band.Motions) -> None:
    case, cycles = Case(), motions.cycles
    assert band.parts(case, cycles).verdict is HOLDS
    moved = replace(cycles, slowest=np.where(cycles.stable, 1.0, 1.01) * cycles.slowest)
    assert band.parts(case, moved).verdict is FAILS
    apart = replace(motions, cycles=replace(cycles, fastest=1.005 * cycles.fastest))
    assert band.ends_at_fold(case, apart).verdict is IN_DIRECTION
    shifted = replace(motions, band=replace(motions.band, upper=2.2))
    assert band.ends_at_fold(case, shifted).verdict is FAILS
    lifted = replace(motions, band=replace(motions.band, lower=0.985))
    assert band.small_swing(case, lifted).verdict is FAILS
    wide = replace(motions, cycles=replace(cycles, slowest=1.005 * cycles.slowest))
    assert band.small_swing(case, wide).verdict is IN_DIRECTION


def test_cycles_do_not_depend_on_units() -> None:
    inches = cycles_without_sticking(TRAIN, DRAG, slowest=[0.01, 0.5, 0.9])
    drag = replace(DRAG, transition_force=50e3, transition_speed=25.4, stick_speed=0.254)
    other = cycles_without_sticking(Drivetrain(1000e3 / 25.4, 1e3 / 25.4), drag, slowest=[0.254, 12.7, 22.86])
    assert other.drive_speed / 25.4 == pytest.approx(inches.drive_speed, rel=1e-9)
    assert other.fastest / 25.4 == pytest.approx(inches.fastest, rel=1e-9)
    assert other.stable.tolist() == inches.stable.tolist() == [False, False, True]


def test_cycles_take_any_shape_and_a_temperature() -> None:
    grid = cycles_without_sticking(TRAIN, DRAG, slowest=[[0.01, 0.1], [0.5, 0.9]])
    assert grid.slowest.shape == grid.fastest.shape == grid.drive_speed.shape == grid.stable.shape == (2, 2)
    assert cycles_without_sticking(TRAIN, DRAG, slowest=0.1).drive_speed == grid.drive_speed[0, 1]
    warm = replace(DRAG, reference_temperature=300.0, force_temperature_exponent=-1.0)
    hot = cycles_without_sticking(TRAIN, warm, slowest=0.01, temperature=600.0)
    assert hot.drive_speed == pytest.approx(2.056026, abs=6e-7)


def test_where_drag_falls_steeply_there_may_be_no_cycle() -> None:
    steep = replace(DRAG, transition_force=12.0 * np.sqrt(1000.0))
    none = cycles_without_sticking(TRAIN, steep)
    assert np.isnan(none.drive_speed).all()
    assert np.isnan(none.fastest).all()
    assert not none.stable.any()
    # above the transition some remain up to a damping number of 11
    some = cycles_without_sticking(TRAIN, replace(DRAG, transition_force=10.5 * np.sqrt(1000.0)))
    assert some.drive_speed[0] == pytest.approx(1.0728455, abs=1e-6)
    assert np.isnan(some.drive_speed[-1])


@pytest.mark.parametrize(
    ("change", "slowest", "words"),
    [
        (
            {"closure": "lugre", "bristle_stiffness": 1e4, "bristle_damping": 1.0},
            0.1,
            "must not be 'lugre'",
        ),
        ({"mixed_exponent": -0.9}, 0.1, "the drag must fall below the transition speed"),
        ({}, 0.009, "slowest"),
        ({}, 1.0, "slowest"),
        ({}, math.nan, "slowest"),
        ({}, "fast", "slowest: 'fast' is not a number with a unit"),
    ],
)
def test_what_has_no_cycles_is_refused(change: dict[str, float], slowest: float, words: str) -> None:
    with pytest.raises((ParameterError, UnitError), match=words):
        cycles_without_sticking(TRAIN, replace(DRAG, **change), slowest=slowest)


def test_a_table_or_a_train_without_mass_is_refused() -> None:
    table = DragTable((0.01, 1.0, 3.0), (120.0, 50.0, 70.0), stick_speed=0.01)
    with pytest.raises(ParameterError, match="drag is a DragTable"):
        cycles_without_sticking(TRAIN, table)  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match="mass is 0"):
        cycles_without_sticking(Drivetrain(1000.0, 0.0), DRAG)


def test_cycles_go_from_the_stick_speed_to_the_transition() -> None:
    found = cycles_without_sticking(TRAIN, DRAG)
    assert isinstance(found, CyclesWithoutSticking)
    assert (found.slowest[0], found.slowest[-1]) == pytest.approx((0.01, 0.999))
    assert (found.drive_speed[0], found.drive_speed.min()) == pytest.approx((FOLD, LOWER), abs=1e-4)


# The chart


def test_the_chart_gives_the_baseline_and_scales(own: tuple[OwnFigure, OwnFigure]) -> None:
    read, scaled = own[1].claims
    assert (read.verdict, scaled.verdict) == (HOLDS, HOLDS)
    assert read.numbers["fold_speed"] == pytest.approx(FOLD, abs=6e-7)
    assert read.numbers["miss"] < read.numbers["resolution"] < 1e-3
    assert max(scaled.numbers["apart_retained"], scaled.numbers["apart_stiction"]) < 1e-9
    assert scaled.numbers["confirmed"] == scaled.numbers["drives"] == 400


@pytest.mark.parametrize("closure", chart.CLOSURES)
def test_the_chart_is_that_of_single_bands(own: tuple[OwnFigure, OwnFigure], closure: str) -> None:
    data = own[1].data
    damping = data["damping number F_t / (v_t sqrt(k m))"]
    for i, speed in ((30, 0.01), (60, 0.1), (70, 0.0001)):
        drag = replace(DRAG, transition_force=3.0 * damping[i], stick_speed=speed, closure=closure)
        found = hysteresis(Drivetrain(0.9, 10.0), drag, sensitivity=False).upper
        assert data[f"V*/v_t, {closure}, v_s/v_t = {speed:g}"][i] == pytest.approx(found, rel=1e-8)


def test_deeper_stick_slip_never_ends_sooner(own: tuple[OwnFigure, OwnFigure]) -> None:
    for speed in chart.STICK_SPEEDS:
        fold = np.array(own[1].data[f"V*/v_t, retained, v_s/v_t = {speed:g}"])
        released = np.array(own[1].data[f"V*/v_t of laps released at v_s, v_s/v_t = {speed:g}"])
        known = np.isfinite(released)
        assert np.all(fold[known] >= released[known] * (1.0 - 1e-8))
        assert np.any(fold[known] > released[known] * 1.001)


def test_reading_the_chart_knows_its_own_error() -> None:
    damping = np.geomspace(0.01, 10.0, 31)
    curves = {"retained": np.array([np.exp(0.3 * np.log(damping) ** 2)] * len(chart.STICK_SPEEDS))}
    made = chart.BandChart(damping, curves, curves["retained"])
    for at in np.geomspace(0.05, 5.0, 17):
        read, resolution = made.at("retained", 0.01, float(at))
        assert abs(read / np.exp(0.3 * np.log(at) ** 2) - 1.0) <= 1.01 * resolution < 5e-3
    wrong = replace(made, fold={"retained": 1.1 * curves["retained"]})
    assert chart.reads_baseline(wrong).verdict is FAILS


# What is drawn and written


def test_axes_carry_units_and_names(
    paper: tuple[PaperFigure, PaperFigure], own: tuple[OwnFigure, OwnFigure]
) -> None:
    for figure in (*paper, *own):
        found = titles(specification_of(figure.chart))
        assert len(found) >= 2
        for title in found:
            assert "(in/s)" in title or "(s)" in title or "v_t = 1 in/s" in title or "(no unit)" in title, (
                title
            )


def test_own_figures_are_written_beside_the_papers(
    paper: tuple[PaperFigure, PaperFigure], own: tuple[OwnFigure, OwnFigure]
) -> None:
    figures = (*paper, *own)
    written = json.loads(as_json(figures))["figures"]
    assert [f["name"] for f in written] == ["figure-13", "figure-14", "band", "chart"]
    assert [f["number"] for f in written] == [13, 14, None, None]
    # a fold beyond all speeds looked at is no finite number
    assert None in written[3]["data"]["V*/v_t, stiction, v_s/v_t = 0.3"]
    text = markdown(figures)
    assert "## Fig. 13: Hysteresis" in text
    assert "## Beyond the paper: V* of any drive" in text
    assert "(band.svg)" in text
