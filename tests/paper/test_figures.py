"""The paper's figures: reference values, its claims as tests, verdicts that follow the numbers, files."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hersey import Drag, Drivetrain, StickSlipCycle, stick_slip
from hersey.charts.render import specification_of
from hersey.errors import OutputError
from paper import (
    Claim,
    PaperFigure,
    Verdict,
    as_json,
    figure_9,
    figure_10,
    figure_11,
    figure_12,
    files,
    markdown,
    own_figures,
    paper_figures,
    sweep,
    write,
)
from paper.baseline import given_a, keeps_speed, releases, sticks
from paper.figure import shown
from paper.panels import _ticks
from paper.sweep import DAMPING, STIFFNESS, Case, Parameter, sweep_over, trend_of
from paper.trends import _settled
from tests.charts.test_charts import titles

#: Settled motion of the exact hybrid solution: change to the baseline, frequency, greatest speed.
REFERENCE = [
    ({"drive_speed": 0.4}, 2.240799, 2.487271),
    ({}, 3.940314, 3.152923),
    ({"drive_speed": 1.6}, 4.606335, 3.923558),
    ({"stiffness": 500.0}, 2.460699, 3.701747),
    ({"stiffness": 2000.0}, 6.117362, 2.758212),
    ({"damping": 25.0}, 4.607448, 2.488249),
    ({"damping": 100.0}, 2.991863, 4.429915),
]
HOLDS, IN_DIRECTION, FAILS = Verdict.HOLDS, Verdict.IN_DIRECTION, Verdict.FAILS


@pytest.fixture(scope="module")
def figures() -> tuple[PaperFigure, ...]:
    return paper_figures()


def claim(figure: PaperFigure, words: str) -> Claim:
    """The one claim of a figure whose statement has these words."""
    (found,) = [c for c in figure.claims if words in c.statement]
    return found


@pytest.mark.parametrize(("change", "frequency", "speed_max"), REFERENCE)
def test_cases_are_those_of_the_reference(
    change: dict[str, float], frequency: float, speed_max: float
) -> None:
    cycle = replace(Case(), **change).cycle()
    assert cycle.frequency == pytest.approx(frequency, abs=6e-7)
    assert cycle.speed_max == pytest.approx(speed_max, abs=6e-7)


@pytest.mark.parametrize(
    ("number", "low", "high"),
    [
        (10, REFERENCE[3][1:], REFERENCE[4][1:]),
        (11, REFERENCE[5][1:], REFERENCE[6][1:]),
        (12, REFERENCE[0][1:], REFERENCE[2][1:]),
    ],
)
def test_sweeps_end_at_the_reference(
    figures: tuple[PaperFigure, ...], number: int, low: tuple[float, float], high: tuple[float, float]
) -> None:
    data = next(f for f in figures if f.number == number).data
    for i, (first, last) in ((0, low), (-1, high)):
        assert data["frequency (Hz)"][i] == pytest.approx(first, abs=6e-7)
        assert data["greatest belt speed (in/s)"][i] == pytest.approx(last, abs=6e-7)


# The paper's claims


def test_the_baseline_sticks_and_slips(figures: tuple[PaperFigure, ...]) -> None:
    found = claim(figures[0], "without end")
    assert found.verdict is HOLDS
    assert found.numbers["frequency"] == pytest.approx(3.940314, abs=6e-7)
    assert found.numbers["stuck_fraction"] == pytest.approx(0.474319, abs=6e-7)


def test_a_is_as_given_and_met_only_from_rest(figures: tuple[PaperFigure, ...]) -> None:
    assert claim(figures[0], "341.4").numbers["a"] == pytest.approx(np.e * 50 * 0.01**-0.2)
    found = claim(figures[0], "outdoes")
    assert found.numbers["first"] == pytest.approx(341.4007621, abs=1e-5)
    assert found.numbers["last"] == pytest.approx(125.5943216, abs=1e-5)
    assert found.numbers["last_over_a"] == pytest.approx(1 / np.e)


def test_a_stuck_belt_keeps_its_speed(figures: tuple[PaperFigure, ...]) -> None:
    found = claim(figures[0], "keeps a small speed")
    assert found.numbers["largest_change"] == 0.0
    assert found.numbers["first"] == pytest.approx(0.0074917018, abs=1e-9)
    assert found.numbers["last"] == pytest.approx(0.01)


def test_frequency_rises_with_stiffness_but_not_in_proportion(figures: tuple[PaperFigure, ...]) -> None:
    assert claim(figures[1], "raises the stick-slip frequency").verdict is HOLDS
    found = claim(figures[1], "proportional")
    assert found.verdict is IN_DIRECTION
    assert 0.6 < found.numbers["frequency_exponent"] < 0.72
    assert 0.6 < found.numbers["frequency_exponent_low"] < found.numbers["frequency_exponent_high"] < 0.72
    assert f"k^{found.numbers['frequency_exponent']:.2f}" in found.evidence


def test_frequency_against_stiffness_is_nearly_straight(figures: tuple[PaperFigure, ...]) -> None:
    found = claim(figures[1], "straight line")
    assert found.verdict is HOLDS
    assert 0.03 < found.numbers["largest_miss"] < 0.1
    assert found.numbers["intercept"] > 1.0


def test_slip_speed_falls_with_stiffness(figures: tuple[PaperFigure, ...]) -> None:
    found = claim(figures[1], "lowers")
    assert found.verdict is HOLDS
    assert found.numbers["slip_speed_factor"] == pytest.approx(2.758212 / 3.701747, rel=1e-6)


def test_damping_lowers_frequency_and_speeds_the_slip(figures: tuple[PaperFigure, ...]) -> None:
    frequency, slip = claim(figures[2], "frequency"), claim(figures[2], "speed of the slip")
    assert (frequency.verdict, slip.verdict) == (HOLDS, HOLDS)
    assert frequency.numbers["frequency_factor"] == pytest.approx(2.991863 / 4.607448, rel=1e-6)
    assert slip.numbers["slip_speed_factor"] == pytest.approx(4.429915 / 2.488249, rel=1e-6)


def test_damping_acts_through_a_which_drag_counters(figures: tuple[PaperFigure, ...]) -> None:
    found = claim(figures[2], "by way of A")
    n = found.numbers
    assert found.verdict is IN_DIRECTION
    assert n["frequency_factor_a_alone"] < n["frequency_factor_both"] < 1 < n["frequency_factor_b0_alone"]
    assert n["slip_speed_factor_b0_alone"] < 1 < n["slip_speed_factor_both"] < n["slip_speed_factor_a_alone"]


def test_a_alone_and_damping_alone_are_what_they_say(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[tuple[float, float]] = []

    def watched(train: Drivetrain, drag: Drag, *, drive_speed: float) -> StickSlipCycle:
        seen.append((drag.transition_force, drag.breakaway_force))
        return stick_slip(train, drag, drive_speed=drive_speed)

    monkeypatch.setattr(sweep, "stick_slip", watched)
    figure_11()
    both, a_alone, b0_alone = (seen[i * sweep.VALUES : (i + 1) * sweep.VALUES] for i in range(3))
    for (force, _), (_, breakaway) in zip(a_alone, b0_alone, strict=True):
        assert force == 50.0
        assert breakaway == pytest.approx(341.4007621)
    assert [a for _, a in a_alone] == pytest.approx([a for _, a in both])
    assert [force for force, _ in b0_alone] == pytest.approx([force for force, _ in both])


def test_drive_speed_raises_both_and_is_like_stiffness_in_direction(
    figures: tuple[PaperFigure, ...],
) -> None:
    found = {c.statement: c.verdict for c in figures[3].claims}
    assert list(found.values()) == [HOLDS, HOLDS, IN_DIRECTION, HOLDS, HOLDS, HOLDS]
    similar = claim(figures[3], "much as stiffness")
    assert similar.numbers["frequency_by_drive_speed_exponent"] == pytest.approx(0.525, abs=1e-3)
    assert similar.numbers["frequency_by_stiffness_exponent"] == pytest.approx(0.657, abs=1e-3)
    assert claim(figures[3], "less the drive speed").numbers["excess_speed_last"] == pytest.approx(
        2.323558, abs=6e-7
    )


# Verdicts follow the numbers


def fake(change: Callable[[float, StickSlipCycle], StickSlipCycle]) -> Callable[..., StickSlipCycle]:
    """A core whose cycles are changed, given the stiffness."""

    def cycle(train: Drivetrain, drag: Drag, *, drive_speed: float) -> StickSlipCycle:
        return change(train.stiffness, stick_slip(train, drag, drive_speed=drive_speed))

    return cycle


@pytest.mark.parametrize(
    ("exponent", "rising", "proportional", "straight"),
    [
        (1.0, HOLDS, HOLDS, HOLDS),
        (0.95, HOLDS, HOLDS, HOLDS),
        (0.85, HOLDS, IN_DIRECTION, HOLDS),
        (3.0, HOLDS, IN_DIRECTION, IN_DIRECTION),
        (-0.5, FAILS, FAILS, FAILS),
    ],
)
def test_other_frequencies_other_verdicts(
    monkeypatch: pytest.MonkeyPatch,
    exponent: float,
    rising: Verdict,
    proportional: Verdict,
    straight: Verdict,
) -> None:
    monkeypatch.setattr(sweep, "stick_slip", fake(lambda k, c: replace(c, frequency=1e-3 * k**exponent)))
    figure = figure_10()
    assert claim(figure, "raises").verdict is rising
    assert claim(figure, "proportional").verdict is proportional
    assert claim(figure, "straight").verdict is straight
    assert f"k^{exponent:.2f}" in claim(figure, "proportional").evidence


def test_a_dent_in_the_curve_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    dented = fake(lambda k, c: replace(c, frequency=c.frequency * (0.9 if 990 < k < 1010 else 1.0)))
    monkeypatch.setattr(sweep, "stick_slip", dented)
    found = claim(figure_10(), "raises")
    assert found.verdict is IN_DIRECTION
    assert "not monotone" in found.evidence


def test_values_without_stick_slip_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    some = fake(lambda k, c: replace(c, kind="steady_sliding") if 1100 < k < 1900 else c)
    monkeypatch.setattr(sweep, "stick_slip", some)
    found = claim(figure_10(), "whole range")
    assert found.verdict is IN_DIRECTION
    assert found.numbers["stick_slip"] < found.numbers["values"] == sweep.VALUES


def test_no_stick_slip_bears_out_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    from paper import judges, trends

    monkeypatch.setattr(sweep, "stick_slip", fake(lambda _, c: replace(c, kind="steady_sliding")))
    empty = sweep_over(DAMPING)
    quantity = judges.FREQUENCY
    claims = [
        judges.sticks_throughout("", empty),
        judges.rises("", "", empty, quantity),
        judges.falls("", "", empty, quantity),
        judges.changes("", "", empty, quantity),
        judges.proportional("", "", empty, quantity),
        judges.straight("", "", empty, quantity),
        judges.similar("", "", empty, empty, quantity),
        judges.opposite("", "", empty, empty, quantity),
        trends.through_a("", empty),
    ]
    assert {c.verdict for c in claims} == {FAILS}
    figure = replace(figure_9(), claims=tuple(claims))
    assert json.loads(as_json([figure]))["figures"][0]["claims"][1]["numbers"]["frequency_factor"] is None


def test_small_or_opposite_changes_are_judged() -> None:
    from paper import judges

    quantity = judges.FREQUENCY
    real = sweep_over(STIFFNESS)
    flat = replace(real, cycles=tuple(replace(c, frequency=3 + 1e-3 * c.frequency) for c in real.cycles))
    assert judges.changes("", "", real, quantity).verdict is HOLDS
    assert judges.changes("", "", flat, quantity).verdict is IN_DIRECTION
    assert judges.similar("", "", real, real, quantity).verdict is HOLDS
    assert judges.opposite("", "", real, real, quantity).verdict is FAILS


def test_the_baseline_is_judged_by_its_motion() -> None:
    case = Case()
    run, cycle = case.run(2.5), case.cycle()
    assert sticks(case, replace(cycle, kind="oscillation")).verdict is IN_DIRECTION
    assert sticks(case, replace(cycle, kind="steady_sliding")).verdict is FAILS
    assert given_a(replace(case, damping=52.0)).verdict is IN_DIRECTION
    assert given_a(replace(case, damping=60.0)).verdict is FAILS
    assert releases(replace(case, damping=52.0), run).verdict is IN_DIRECTION
    assert releases(replace(case, damping=60.0), run).verdict is FAILS
    assert keeps_speed(replace(case, stick_speed=0.009), run).verdict is FAILS
    drifting = replace(
        run, events=tuple(e._replace(belt_speed=e.belt_speed * (1 - 0.1 * e.time)) for e in run.events)
    )
    assert keeps_speed(case, drifting).verdict is IN_DIRECTION
    still = replace(run, events=())
    assert {releases(case, still).verdict, keeps_speed(case, still).verdict} == {FAILS}


def test_trend_of_a_power_law() -> None:
    x = np.geomspace(2.0, 32.0, 9)
    trend = trend_of(x, 5.0 * x**-0.4)
    assert (trend.rises, trend.falls) == (False, True)
    assert trend.factor == pytest.approx(16**-0.4)
    assert [trend.exponent, trend.exponent_low, trend.exponent_high] == pytest.approx([-0.4] * 3)


# What is drawn


def test_the_settled_trace_starts_at_a_release_and_repeats() -> None:
    case = Case(stiffness=2000.0)
    time, speed = _settled(case)
    period = 1.0 / case.cycle().frequency
    assert time[0] == pytest.approx(0.0, abs=1e-3)
    assert speed[0] < 0.1
    assert speed[(time > 0.5 * period) & (time < 0.6 * period)].max() > 0.1
    again = np.interp(time[:300] + period, time, speed)
    assert again == pytest.approx(speed[:300], abs=0.02)


@pytest.mark.parametrize("field", ["stiffness", "damping", "drive_speed"])
def test_traces_are_of_the_papers_range(field: str) -> None:
    ranges = {"stiffness": (500, 2000), "damping": (25, 100), "drive_speed": (0.4, 1.6)}
    (parameter,) = [p for p in vars(sweep).values() if isinstance(p, Parameter) and p.field == field]
    assert (parameter.traced[0], parameter.traced[-1]) == ranges[field]
    assert parameter.traced[1] == getattr(Case(), field)


def test_axes_carry_units(figures: tuple[PaperFigure, ...]) -> None:
    for figure in figures:
        found = titles(specification_of(figure.chart))
        assert len(found) >= 2
        for title in found:
            assert "(" in title, title


def test_the_mode_strip_shows_the_modes() -> None:
    text = json.dumps(specification_of(figure_9().chart))
    assert "EHL: drag rises with speed" in text
    assert '"values": ["stuck", "mixed: drag falls with speed", "EHL: drag rises with speed"]' in text


def test_ticks_are_round_and_few() -> None:
    assert _ticks(2.68, 3.81) == pytest.approx([2.8, 3.0, 3.2, 3.4, 3.6, 3.8])
    assert _ticks(1.8, 9.2) == pytest.approx([2, 3, 4, 5, 6, 7, 8, 9])
    for high in (1.1, 1.9, 3.0, 11.0, 99.0):
        assert 3 <= len(_ticks(1.0, high)) <= 8


def test_numbers_keep_their_digits() -> None:
    assert [shown(v) for v in (3.9403, 0.65, 2000.0, float("nan"))] == ["3.940", "0.6500", "2000", "nan"]


# Files


def test_the_page_has_every_claim_with_its_verdict(figures: tuple[PaperFigure, ...]) -> None:
    text = markdown(figures)
    for figure in figures:
        assert f"({figure.name}.svg)" in text
        for c in figure.claims:
            assert f"{c.statement} **{c.verdict.capitalize()}.**" in text
            assert c.evidence in text
            assert c.criterion in text


def test_the_docs_have_every_claim_with_its_verdict(figures: tuple[PaperFigure, ...], root: Path) -> None:
    text = (root / "docs" / "validation" / "paper.md").read_text()
    rows = [line.split(" | ")[:3] for line in text.splitlines() if line.startswith("| ") and "holds" in line]
    found = [c for figure in (*figures, *own_figures()) for c in figure.claims]
    assert rows == [[f"| {c.source}", c.statement, c.verdict.value] for c in found]
    for c in found:
        for name, value in c.numbers.items():
            if name.endswith("_exponent"):
                assert f"^{value:.2f}" in text or name.startswith("excess"), (c.statement, name)


def test_the_numbers_are_those_of_the_figures(figures: tuple[PaperFigure, ...]) -> None:
    content = json.loads(as_json(figures))
    assert [f["number"] for f in content["figures"]] == [9, 10, 11, 12, 13, 14]
    for figure, written in zip(figures, content["figures"], strict=True):
        assert written["data"] == {name: list(column) for name, column in figure.data.items()}
        for c, row in zip(figure.claims, written["claims"], strict=True):
            assert (row["verdict"], row["numbers"]) == (c.verdict.value, dict(c.numbers))


@pytest.mark.slow
def test_files_of_each_kind_are_written(tmp_path: Path) -> None:
    folder = tmp_path / "figures"
    written = write([figure_12()], folder)
    assert sorted(p.name for p in folder.iterdir()) == sorted(p.name for p in written)
    assert (folder / "figure-12.png").read_bytes().startswith(b"\x89PNG")
    assert (folder / "figure-12.pdf").read_bytes().startswith(b"%PDF")
    assert "Drive speed v2 (in/s)" in (folder / "figure-12.svg").read_text()
    assert json.loads((folder / "figures.json").read_text())["units"]["force"] == "ozf"


@pytest.fixture
def no_drawing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rendering takes seconds: the tests of how files are handled do without."""
    monkeypatch.setattr(files, "picture", lambda _, suffix: suffix.removeprefix(".").encode())


@pytest.mark.usefixtures("no_drawing")
def test_nothing_is_overwritten_unless_told(tmp_path: Path, figures: tuple[PaperFigure, ...]) -> None:
    assert len(write(figures, tmp_path)) == 3 * len(figures) + 2
    (tmp_path / "figure-10.png").write_text("mine")
    with pytest.raises(OutputError, match="exists"):
        write(figures, tmp_path)
    assert (tmp_path / "figure-10.png").read_text() == "mine"
    write(figures, tmp_path, overwrite=True)
    assert (tmp_path / "figure-10.png").read_text() == "png"


@pytest.mark.usefixtures("no_drawing")
def test_a_failure_leaves_nothing_behind(
    tmp_path: Path, figures: tuple[PaperFigure, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "figure-09.svg").write_text("old")
    whole = Path.open

    def full(path: Path, *how: Any, **more: Any) -> Any:
        if path.name.startswith(".figure-11.png."):
            raise OSError(28, "No space left on device")
        return whole(path, *how, **more)

    monkeypatch.setattr(Path, "open", full)
    with pytest.raises(OutputError, match="No space left"):
        write(figures, tmp_path, overwrite=True)
    assert [p.name for p in tmp_path.iterdir()] == ["figure-09.svg"]
    assert (tmp_path / "figure-09.svg").read_text() == "old"


@pytest.mark.usefixtures("no_drawing")
def test_a_file_is_no_folder(tmp_path: Path, figures: tuple[PaperFigure, ...]) -> None:
    (tmp_path / "taken").write_text("")
    with pytest.raises(OutputError, match="cannot be written"):
        write(figures, tmp_path / "taken")
