"""What the first screen says: the user's points first, and signals that agree with the posterior."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hersey
from hersey.damping.fit import fit
from hersey.damping.surface import DampingSurface
from hersey.decision import behaviour
from hersey.decision.behaviour import Behaviour, PointBehaviour, Working, ranges
from hersey.decision.judge import judge
from hersey.decision.start_up import plan_start_up
from hersey.document.analysis import Analysis
from hersey.document.assembly import document_of, load
from hersey.errors import HerseyError, ParameterError, UnfinishedError
from hersey.log.means import read_means
from hersey.machine.limits import Limits, OperatingPoint
from hersey.machine.machine import Machine, read_machine
from hersey.schema.warning import Warning
from hersey.stability.operating_map import OperatingMap
from hersey.study import study
from hersey.study.findings import Findings
from hersey.study.first_screen.reasons import in_words
from hersey.study.first_screen.words import figures, within
from hersey.verdict.regime import Regime
from tests.conftest import ROOT
from tests.document.conftest import BETWEEN, HOT, POINTS, ROOMY, Decide, with_draws


def test_the_first_sentence_is_about_the_users_points(decide: Decide, found: Behaviour) -> None:
    said = decide(found)
    assert said.instruction == (
        "20 mm/s sticks from any start. 45 mm/s needs the start-up profile. "
        "100 mm/s and 360 mm/s run smoothly."
    )
    _, low, high = found.posterior.fold_interval(HOT)
    ends = f"[{figures(1e3 * low, up=False)}, {figures(1e3 * high, up=True)}]"
    assert said.interval.startswith("V*, above which stick-slip cannot last at 180 °C, is ")
    assert said.interval.endswith(f"{ends} (95 %).")
    safe = figures(1e3 * found.posterior.safe_speed(HOT), up=True)
    assert said.otherwise.startswith(f"The belt slides from any start above {safe} mm/s.")
    below, turn, above = np.quantile(found.posterior.edges(HOT).transition, (0.025, 0.5, 0.975))
    turns = f"{figures(1e3 * turn)} mm/s {within(below, above, 1e3)}"
    assert said.otherwise.endswith(f" Below the transition (lowest torque), {turns}, it sticks.")
    assert said.safe_speed == found.posterior.safe_speed(HOT)
    assert said.fold is not None
    assert (said.fold.low, said.fold.high) == (low, high)
    assert said.temperature == HOT
    assert said.next.endswith(".")
    assert sum(said.closures.values()) == pytest.approx(1.0)


def test_each_point_has_the_signal_of_its_verdict(decide: Decide, found: Behaviour) -> None:
    said = decide(found)
    signals = {
        p.name: (p.signal, p.verdict, re.split(r"[:;] (?!extra|under)| \(over", p.words)[0])
        for p in said.points
    }
    assert signals == {
        "crawl": ("act", "sticks", "sticks from any start"),
        "thick paper": ("watch", "depends", "needs the start-up profile"),
        "near": ("good", "smooth", "smooth from any start (sticks: under 1 %)"),
        "full speed": ("watch", "smooth", "smooth from any start (sticks: under 1 %); extrapolated"),
    }
    assert said.signal == "act"
    motion = next(point.motion for point in said.points if point.name == "thick paper")
    assert motion is not None
    assert motion.belt_speed[-1] == pytest.approx(BETWEEN, rel=0.05)


@settings(deadline=None, max_examples=40)
@given(st.floats(0.01, 0.39))
def test_signals_agree_with_the_intervals(decide: Decide, found: Behaviour, speed: float) -> None:
    """Good is said only above the safe speed; act only where nearly all draws stick."""
    point = PointBehaviour(OperatingPoint("any", speed, HOT), judge(found.posterior, HOT, speed))
    [said] = decide(replace(found, points=(point,))).points
    edges = found.posterior.edges(HOT)
    if said.signal == "good":
        assert np.mean(edges.fold < speed) >= 0.975
    assert (said.signal == "act") == (np.mean(speed < edges.transition) >= 0.975)
    assert said.smooth + said.from_above + said.sticks == pytest.approx(1.0)  # type: ignore[operator]


def test_list_map_text_and_document_give_one_verdict(decide: Decide, found: Behaviour) -> None:
    said = decide(found)
    for point, of in zip(said.points, found.points, strict=True):
        assert point.verdict == of.verdict.kind
        sentence = next(s for s in said.instruction.split(". ") if f"{1e3 * point.speed:.0f} mm/s" in s)
        word = {"smooth": "smooth", "depends": "profile", "sticks": "stick"}[point.verdict]
        assert word in sentence
        assert word in point.words


def test_a_plan_that_is_impossible_is_something_to_act_on(decide: Decide, found: Behaviour) -> None:
    slow = replace(found.posterior.model.machine, limits=Limits(speed=0.0455, acceleration=0.5))
    bound = replace(found.posterior, model=replace(found.posterior.model, machine=slow))
    none = plan_start_up(bound, HOT, BETWEEN)
    assert not none.found
    point = replace(found.points[1], plan=none)
    said = decide(replace(found, points=(point,)))
    assert said.signal == said.points[0].signal == "act"
    assert (
        said.points[0].words == "sticks from rest (99 %), smooth once it slides: "
        "no start-up profile within the limits works"
    )
    assert said.instruction == "45 mm/s sticks from rest, and is smooth once it slides."
    assert said.flags[0].title == "No start for thick paper"
    assert said.flags[0].where == "plan"


def test_a_point_that_may_lie_below_the_transition_is_not_blamed_on_a_limit(
    decide: Decide, found: Behaviour
) -> None:
    edges = found.posterior.edges(HOT)
    half = np.where(np.arange(edges.fold.size) % 2 == 0, 0.04, 0.05)
    moved = with_draws(found, transition=half, fold=np.maximum(edges.fold, half))
    below = plan_start_up(moved.posterior, HOT, BETWEEN)
    assert [each.limit for each in below.obstacles] == ["target_speed"]
    point = replace(moved.points[1], plan=below)
    said = decide(replace(moved, points=(point,)))
    assert said.points[0].verdict == "unknown"
    assert said.points[0].words == "may stick: with 50 % probability it is below the transition"
    assert said.instruction == "45 mm/s may stick."
    assert said.flags[0].title == "No start-up profile for thick paper"


def test_v_star_without_an_upper_end_gives_no_speed(decide: Decide, found: Behaviour) -> None:
    far = with_draws(found, fold=1e3)
    said = decide(replace(far, points=()))
    assert said.instruction.startswith("At 180 °C do not rely on a start from rest")
    assert said.interval.endswith("no upper end can be determined.")
    assert said.safe_speed is said.fold is None


def test_beyond_the_drive_nothing_is_good(decide: Decide, found: Behaviour) -> None:
    machine = replace(found.posterior.model.machine, limits=replace(ROOMY, speed=0.06))
    drawn = replace(found.posterior, model=replace(found.posterior.model, machine=machine))
    points = tuple(replace(p, verdict=judge(drawn, HOT, p.point.speed)) for p in found.points)
    assert found.map is not None
    slow = replace(found, posterior=drawn, points=points, map=replace(found.map, speed_limit=0.06))
    said = decide(slow)
    assert said.points[-1].words.startswith("exceeds the maximum speed of the drive, 60 mm/s")
    assert "100 mm/s and 360 mm/s are faster than the drive" in said.instruction
    bare = decide(replace(slow, points=()))
    assert bare.signal == "act"
    assert "exceeds the maximum speed of the drive, 60 mm/s" in bare.instruction


def _with_motor(found: Behaviour, share: float) -> Behaviour:
    """The same with a motor that gives a share of the way from the least to the most that a start takes."""
    low, high = np.quantile(found.posterior.edges(HOT).holding, [0.02, 0.98])
    model = found.posterior.model
    torque = float(low + share * (high - low)) * model.machine.roll_radius
    machine = replace(model.machine, limits=replace(ROOMY, motor_torque=torque))
    drawn = replace(found.posterior, model=replace(model, machine=machine))
    points = tuple(replace(p, verdict=judge(drawn, HOT, p.point.speed)) for p in found.points)
    assert found.map is not None
    limited = replace(found.map, torque_limit=torque, limited_by="motor torque")
    return replace(found, posterior=drawn, points=points, map=limited)


@pytest.mark.parametrize(
    ("share", "kind", "signal"),
    [(-0.1, "not started", "act"), (0.5, "unknown", "watch"), (1.1, "smooth", "good")],
)
def test_a_start_is_as_sure_as_the_force_that_it_takes(
    decide: Decide, found: Behaviour, share: float, kind: str, signal: str
) -> None:
    near = replace(found, points=found.points[2:3])
    said = decide(_with_motor(near, share))
    assert (said.points[0].verdict, said.points[0].signal) == (kind, signal)
    if kind == "unknown":
        assert said.points[0].words.startswith("may not start (38 %) or may stick (under 1 %): starting")
        assert said.instruction.endswith(" may not start.")
        assert said.flags[0].title == "The motor may not start the belt"


def test_a_motor_that_is_too_weak_is_named(decide: Decide, found: Behaviour) -> None:
    said = decide(_with_motor(found, -0.1))
    assert said.signal == "act"
    assert "give the roll more than" in said.instruction
    assert said.flags[0].title == "The motor does not start the belt"


@pytest.mark.usefixtures("few_laws")
def test_without_a_machine_it_speaks_of_the_roll(log: hersey.TorqueLog, tmp_path: Path) -> None:
    points = log.steady(tare="standing")
    document = document_of(study(points))
    said = document.decision
    assert said is not None
    assert document.simulation is document.map is None
    assert not any("paper" in str(warning) for warning in document.warnings)
    high = fit(points).transition_estimate(fit(points).temperature_range[1]).high  # type: ignore[index]
    assert f"Keep the speed above {figures(high * 60 / math.tau, up=True)} rpm" in said.otherwise
    assert said.instruction.endswith("The safe speed is not yet known.")
    file = tmp_path / "machine.toml"
    file.write_text("\n".join(part.lines for part in said.missing if part.file == "machine.toml"))
    assert read_machine(file).points  # the lines are ready to copy
    assert {part.file for part in said.missing} == {"machine.toml"}


def test_lines_for_a_file_that_is_there_do_not_repeat_its_tables(
    decide: Decide, found: Behaviour, tmp_path: Path
) -> None:
    said = decide(found, points=(), uncertainty={}, limits=Limits(motor_torque=8.0), contact=None)
    lines = "".join(part.lines for part in said.missing)
    assert "[limits]\n" not in lines
    assert "roll_friction" in lines
    assert "[uncertainty]\nstick_speed" in lines
    stated = (ROOT / "tests" / "stand" / "machine.toml").read_text().split("[limits]")[0]
    file = tmp_path / "machine.toml"
    within_limits = next(
        part.lines for part in said.missing if part.lines.startswith("# add to the existing table [limits]")
    )
    others = "".join(part.lines for part in said.missing if not part.lines.startswith(("# add", "[rest]")))
    file.write_text(f'{stated}\n[limits]\nmotor_torque = "8 N*m"\n{within_limits}\n{others}')
    assert read_machine(file).limits.grip is not None


@pytest.mark.usefixtures("few_laws")
def test_no_falling_branch_says_how_far_down() -> None:
    rng = np.random.default_rng(2)
    speeds = np.repeat(np.geomspace(1.0, 30.0, 12), 2)
    rising = _table(speeds, 0.2 * speeds**0.3 * np.exp(0.005 * rng.standard_normal(speeds.size)))
    said = rising.decision
    assert said is not None
    assert said.signal == "watch"  # from rest the belt passes speeds that nobody measured
    assert said.instruction.startswith(
        "Measure dwells slower than 9.5 rpm: torque rises with speed down to there"
    )
    assert "keeps sliding down to 9.5 rpm. From rest it may stick" in said.otherwise
    falling = _table(speeds, 0.2 * speeds**-0.3 * np.exp(0.005 * rng.standard_normal(speeds.size)))
    assert falling.decision is not None
    assert falling.decision.signal == "watch"
    assert falling.decision.instruction.startswith("Measure faster dwells: torque falls")
    assert any(part.file == "hersey.toml" for part in falling.decision.missing)


def test_a_law_that_does_not_hold_is_never_called_safe(machine: Machine) -> None:
    """Dwells of several temperatures fitted without: scatter hides the falling branches of each."""
    speeds = np.geomspace(1.0, 30.0, 12)
    levels = [speeds**0.3 + (turn / speeds) ** 1.5 for turn in (0.5, 1.0, 2.0, 4.0)]
    heights = (4.0, 2.0, 1.0, 0.5)
    torques = np.concatenate([0.2 * h * level for h, level in zip(heights, levels, strict=True)])
    document = _table(np.tile(speeds, 4), torques, replace(machine, uncertainty={}, rest=None))
    said = document.decision
    assert said is not None
    assert document.fit.transition is None
    assert said.signal == "watch"
    assert "nothing sticks" not in said.instruction
    assert [point.name for point in said.points] == list(POINTS)
    assert {point.signal for point in said.points} == {"watch"}


@pytest.mark.usefixtures("few_laws")
def test_one_temperature_is_not_named(points: hersey.SteadyPoints, machine: Machine) -> None:
    """An isothermal fit with a machine: the sentence begins with what to do."""
    hot = points.column("temperature") > points.column("temperature").max() - 5.0
    speeds, torques = points.column("speed")[hot], points.column("torque")[hot]
    alone = replace(machine, points=machine.points[-1:], uncertainty={}, rest=None)
    document = _table(speeds, torques, alone)
    assert document.decision is not None
    assert document.decision.instruction.startswith("360 mm/s ")
    assert document.decision.interval.startswith("V*, above which stick-slip cannot last, is ")
    assert document.map is not None
    assert document.map.temperature is None


@pytest.mark.usefixtures("few_laws")
def test_what_cannot_be_computed_is_said(
    points: hersey.SteadyPoints,
    surface: DampingSurface,
    machine: Machine,
    decide: Decide,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A report does not fail for a map: the reason stands in its place."""

    def refuse(*_: object, **__: object) -> None:
        raise ParameterError("the bands cannot be computed: set 3")

    monkeypatch.setattr(behaviour, "map_of", refuse)
    monkeypatch.setattr(behaviour, "plan_start_up", refuse)
    steps: list[str] = []
    found = Working(points, surface, machine, draws=80).result(steps.append)
    assert steps[:2] == ["drawing from the posterior", "computing V* and the bands"]
    assert "planning thick paper" in steps
    said = decide(found)
    assert "rpm" in said.instruction
    assert {point.words for point in said.points[:3]} == {"not judged: there is no map"}
    assert any("the bands cannot be computed: set 3" in flag.text.lower() for flag in said.flags)
    assert [str(error) for error in found.points[1].errors] == ["the bands cannot be computed: set 3"]
    assert found.stick_speeds is not None
    assert found.stick_speeds.upper[0] > found.stick_speeds.upper[-1]


def test_the_ranges_are_those_of_the_file(machine: Machine) -> None:
    known = ranges(machine)
    assert known["stick_speed"] == machine.uncertainty["stick_speed"].limits
    assert known["stiffness"] == pytest.approx((machine.stiffness / 1.1, machine.stiffness * 1.1))


@given(st.floats(1e-3, 1e4), st.floats(1.0, 3.0))
def test_intervals_are_rounded_outward(value: float, wider: float) -> None:
    low, high = (float(end) for end in within(value, value * wider, 1.0)[1:-1].split(","))
    assert low <= value * (1 + 1e-9)
    assert high >= value * wider * (1 - 1e-9)
    assert high <= 1.11 * value * wider + (0.5 if value * wider > 100 else 0)


def _table(speeds: np.ndarray, torques: np.ndarray, machine: Machine | None = None) -> Analysis:
    """The document of a table of means."""
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "means.csv"
        rows = [f"{w:.9g},{t:.9g}" for w, t in zip(speeds, torques, strict=True)]
        path.write_text("\n".join(["Speed [rad/s],Torque [N*m]", *rows]) + "\n")
        table = read_means([path], isothermal=True)
        points = hersey.SteadyPoints.from_table(table)
        document = document_of(study(points, machine))
    assert load(document.model_dump_json()).model_dump_json() == document.model_dump_json()
    return document


@pytest.mark.usefixtures("few_draws")
def test_a_stick_speed_above_the_transition_does_not_end_the_report(
    log: hersey.TorqueLog, machine: Machine
) -> None:
    """Faster than all but a few dwells: drag rises from it on, or falls only a little."""
    points = log.steady(tare="standing")
    document = document_of(study(points, replace(machine, stick_speed=0.04, uncertainty={})))
    assert document.decision is not None
    assert document.map is not None
    assert document.decision.fold is not None
    assert document.decision.fold.high > 0.04


def test_how_the_belt_stops_is_said_where_it_moves_v_star(decide: Decide, found: Behaviour) -> None:
    size = len(found.posterior.drives)
    closure = (np.arange(size) % 2).astype(np.intp)
    drives = replace(found.posterior.drives, closure=closure)
    apart = with_draws(found, fold=np.where(closure == 0, 0.06, 0.2))
    open_ = replace(apart, posterior=replace(apart.posterior, drives=drives))
    open_.posterior._edges.update(apart.posterior._edges)
    said = decide(replace(open_, points=()))
    [flag] = [flag for flag in said.flags if "comes to rest" in flag.title]
    assert flag.title == "The safe speed depends on how the belt comes to rest"
    assert flag.text.endswith("(50 %, V* 200 mm/s).")
    assert (flag.number("retained"), flag.number("stiction")) == (0.06, 0.2)
    # where the evidence decides, or both are nearly the same, nothing is said
    same = with_draws(open_, fold=np.where(closure == 0, 0.06, 0.065))
    assert not any("comes to rest" in flag.title for flag in decide(replace(same, points=())).flags)


def test_torque_of_the_whole_drive_is_never_good(
    decide: Decide, found: Behaviour, points: hersey.SteadyPoints
) -> None:
    """Bearings in the torque draw V* down."""
    near = replace(found, points=found.points[2:3])
    assert decide(near).points[0].signal == "good"
    whole = decide(near, dwells=points)
    assert whole.signal == whole.points[0].signal == "watch"
    assert (
        whole.points[0].words
        == "smooth from any start (sticks: under 1 %), if all torque comes from the film"
    )
    assert whole.flags[0].title == "Torque may hold more than the film"
    assert decide(replace(found, points=())).signal == "watch"  # good for what?


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (
            ParameterError(
                "stick_speed is 0.036: it must be less than 0.033",
                quantity="stick_speed",
                value=0.036,
                limit=0.033,
            ),
            (
                "the stick speed, up to 36 mm/s here, reaches the transition speed, 33 mm/s. State a "
                "lower stick speed"
            ),
        ),
        (
            ParameterError(
                "set 2: whatever is said here",
                quantity="stiffness",
                value=-3.0,
                limit=0.0,
                bound="above",
            ),
            "the stiffness is -3 N/m: it must be greater than 0 N/m",
        ),
        (
            ParameterError("drive_speed is 0", quantity="drive_speed", value=0.0, limit=0.0, bound="above"),
            "the drive speed is 0 mm/s: it must be greater than 0 mm/s",
        ),
        (
            ParameterError("mass is NaN: a finite number is needed", quantity="mass", value=math.nan),
            "the mass is nan: it must be finite",
        ),
        (
            UnfinishedError("no end after 7 steps, all that are allowed: allow more by most_steps", steps=7),
            "stick speed in the machine file",
        ),
        (ParameterError("the bands cannot be computed"), "the bands cannot be computed"),
    ],
)
def test_reasons_speak_without_names_of_code(error: HerseyError, said: str) -> None:
    assert in_words(error).endswith(said)
    assert "_" not in in_words(error)


def test_a_torque_that_does_not_change_asks_for_slower_and_faster_dwells() -> None:
    """No temperature is asked for where one law holds, and neither a rise nor a fall is proven."""
    rng = np.random.default_rng(4)
    speeds = np.repeat(np.geomspace(1.0, 30.0, 12), 2)
    flat = _table(speeds, 0.7 * np.exp(0.003 * rng.standard_normal(speeds.size)))
    assert flat.decision is not None
    assert flat.decision.instruction.startswith("Record dwells slower than 9.5 and faster than 286 rpm")
    assert flat.decision.signal == "watch"


def test_torque_has_one_unit(
    decide: Decide,
    found: Behaviour,
    points: hersey.SteadyPoints,
    surface: DampingSurface,
    seen: Regime,
) -> None:
    def unit_of(dwells: hersey.SteadyPoints, told: OperatingMap | None = None) -> str:
        behaviour = None if told is None else replace(found, map=told)
        return Findings(points=dwells, surface=surface, regime=seen, behaviour=behaviour).units["torque"]

    assert found.map is not None
    weak = _with_motor(found, -0.2)
    for unit, factor in (("N·m", 1.0), ("mN·m", 1e3)):
        said = decide(weak, unit=unit)
        gives = figures(factor * float(weak.map.torque_limit or 0.0))  # type: ignore[union-attr]
        assert f" {unit}: the motor's {gives} {unit} cannot start" in said.instruction
        assert f", the motor gives {gives} {unit}" in said.points[-1].words
    large = float(np.abs(points.column("torque")).max())
    assert large > 1.0
    assert unit_of(points) == "N·m"
    few = replace(points, table=points.table.with_columns(torque=points.table["torque"] * 0.9 / large))
    assert unit_of(few) == "mN·m"
    for holding, limit, unit in (
        (0.5, None, "mN·m"),
        (1.0, None, "N·m"),
        (0.5, 1.2, "N·m"),
        (0.5, 0.9, "mN·m"),
    ):
        told = replace(found.map, holding=np.array([holding]), torque_limit=limit)
        assert unit_of(few, told) == unit


def test_what_of_the_nip_cannot_be_is_a_warning(decide: Decide, found: Behaviour, document: Analysis) -> None:
    """The farthest off, where no exponent and no torque is flagged already; a formula's range is none."""
    assert document.film is not None
    off = Warning("friction above a film", "friction coefficient 0.5 is no film", severity="act", off=1.7)
    film = document.film.model_copy(update={"warnings": [off], "contradicted": False})
    shown = [flag for flag in decide(found, film=film).flags if flag.where == "regime"]
    assert [(flag.title, flag.text) for flag in shown] == [
        ("Nip and log disagree", "Friction coefficient 0.5 is no film.")
    ]
    mild = film.model_copy(update={"warnings": [Warning("friction above a film", "", off=1.7)]})
    assert "Nip and log disagree" not in {flag.title for flag in decide(found, film=mild).flags}


def test_the_laws_tried_stand_in_their_order(document: Analysis) -> None:
    tried = document.regime.tried
    assert [law.aicc for law in tried] == sorted(law.aicc for law in tried)
    assert {law.verdict == "not excluded" for law in tried} == {True, False}
    assert all(law.parameters for law in tried)
    listed = {each.name for each in document.regime.explanations}
    kept = {law.name for law in tried if law.verdict == "not excluded"}
    assert kept - {"one power of speed"} <= listed


def test_map_and_headline_give_one_v_star(found: Behaviour) -> None:
    """The map is of fewer draws, but not at the temperature of the headline."""
    map_, drawn = found.map, found.posterior
    assert map_ is not None
    assert map_.temperature is not None
    near = int(np.argmin(np.abs(map_.temperature - HOT)))
    value, low, high = drawn.fold_interval(float(map_.temperature[near]))
    assert map_.upper[near] == pytest.approx(value, rel=0.005)
    assert map_.upper_interval[:, near] == pytest.approx([low, high], rel=0.005)
