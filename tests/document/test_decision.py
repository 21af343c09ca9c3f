"""What the first screen says: the safe end, the plan's own overshoot, signals that agree with the map."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hersey
from hersey.damping.fit import fit
from hersey.damping.surface import DampingSurface
from hersey.document.assembly import analyse, load
from hersey.document.decision import behaviour
from hersey.document.decision.behaviour import Behaviour, PointBehaviour, StickSpeeds, Working, ranges
from hersey.document.decision.reasons import in_words
from hersey.document.decision.words import figures, within
from hersey.document.display_units import display_units
from hersey.document.parts import Analysis, MisfitPart
from hersey.errors import HerseyError, ParameterError, UnfinishedError
from hersey.log.means import read_means
from hersey.machine.limits import Limits, OperatingPoint
from hersey.machine.machine import Machine, read_machine
from hersey.machine.uncertainty import Uncertainty
from hersey.stability.hysteresis import hysteresis
from hersey.stability.operating_map import OperatingMap, operating_map
from hersey.stability.plan import plan_profile
from tests.conftest import ROOT
from tests.document.conftest import BETWEEN, FAST, HOT, POINTS, SLOW, Decide


def test_the_instruction_takes_the_safe_end_and_the_plans_overshoot(
    decide: Decide, found: Behaviour, map_: OperatingMap
) -> None:
    said = decide(found)
    safe = figures(1e3 * float(map_.upper_interval[1, -1]), up=True)
    assert said.instruction == f"At 180 °C run above {safe} mm/s"
    assert said.interval.startswith("V* is 53 [")
    assert said.interval.endswith(f", {safe}] mm/s")
    [plan] = [each.plan for each in found.points if each.plan is not None]
    assert plan.kind == "overshoot"
    rise = f"overshoot to {figures(1e3 * plan.peak_speed)} mm/s in {figures(plan.rise)} s first (plan)"
    assert f"for 45 mm/s {rise}" in said.otherwise
    slow = figures(1e3 * float(map_.transition_interval[0, -1]), up=False)
    assert said.otherwise.startswith(f"Between {slow} and {safe} mm/s it may depend")
    assert said.otherwise.endswith(f"Below {slow} mm/s it sticks.")


def test_each_point_has_the_signal_of_its_state(decide: Decide, found: Behaviour) -> None:
    said = decide(found)
    signals = {point.name: (point.signal, point.words.split(";")[0].split(":")[0]) for point in said.points}
    assert signals == {
        "crawl": ("act", "sticks from any start"),
        "thick paper": ("watch", "depends"),
        "near": ("watch", "smooth by the estimate"),
        "full speed": ("good", "smooth from any start"),
    }
    assert said.signal == "act"
    motion = next(point.motion for point in said.points if point.name == "thick paper")
    assert motion is not None
    assert motion.belt_speed[-1] == pytest.approx(BETWEEN, rel=0.05)


@settings(deadline=None, max_examples=40)  # each asks the core for a band
@given(st.floats(0.01, 0.39))
def test_signals_agree_with_the_map(
    decide: Decide, found: Behaviour, map_: OperatingMap, speed: float
) -> None:
    """Good is said only where the map is smooth up to the end of the interval; act wherever it sticks."""
    point = OperatingPoint("any", speed, HOT)
    [said] = decide(replace(found, points=(PointBehaviour(point),))).points
    state = map_.state_at(HOT, speed).state
    if said.signal == "good":
        assert state == "smooth"
        assert speed >= map_.upper_interval[1, -1]
    assert (said.signal == "act") == (state in ("stick_slip", "swing"))


def test_a_plan_that_is_impossible_is_something_to_act_on(
    decide: Decide, found: Behaviour, surface: DampingSurface, machine: Machine
) -> None:
    drag = surface.drag(**machine.belt, temperature=HOT)
    none = plan_profile(machine.train, drag, target_speed=BETWEEN, limits=Limits(speed=0.045))
    assert not none.found
    point = OperatingPoint("thick paper", BETWEEN, HOT)
    said = decide(replace(found, points=(PointBehaviour(point, plan=none),)))
    assert said.signal == said.points[0].signal == "act"
    assert "no start within the limits" in said.points[0].words
    assert "no start within the limits works" in said.otherwise
    assert said.flags[0].title == "No start for thick paper."
    assert said.flags[0].section == "plan"


def test_a_point_that_may_lie_below_the_transition_is_not_blamed_on_a_limit(
    decide: Decide, found: Behaviour, surface: DampingSurface, machine: Machine
) -> None:
    """And of many starts two are named in the sentence."""
    drag = surface.drag(**machine.belt, temperature=HOT)
    below = plan_profile(machine.train, drag, target_speed=SLOW, limits=machine.limits, roll_radius=0.015)
    points = [OperatingPoint(f"point {i}", BETWEEN + 1e-3 * i, HOT) for i in range(4)]
    said = decide(replace(found, points=tuple(PointBehaviour(point, plan=below) for point in points)))
    assert "for 45 mm/s" not in said.otherwise
    assert "45 mm/s may lie below the transition; 46 mm/s may lie below the transition; and 2 more" in (
        said.otherwise
    )
    assert said.points[0].words.startswith("may stick: no plan, for it may lie below the transition")
    assert said.flags[0].title.startswith("No plan for point")


def test_v_star_that_is_not_told_gives_no_speed(decide: Decide, found: Behaviour, map_: OperatingMap) -> None:
    wide = map_.upper_interval.copy()
    wide[1] = 1e4 * map_.transition
    said = decide(replace(found, map=replace(map_, upper_interval=wide)))
    assert "measure the stick speed" in said.instruction
    assert said.interval.endswith("its upper end is not told")
    assert said.otherwise.startswith("Above 31 mm/s it may depend")
    assert said.points[-1].signal == "watch"


def test_a_safe_speed_beyond_the_drive_is_not_asked_for(
    decide: Decide, found: Behaviour, map_: OperatingMap
) -> None:
    slow = replace(found, map=replace(map_, speed_limit=0.06))
    said = decide(slow)
    assert said.instruction.startswith("At 180 °C start as the plan says: no speed up to 60 mm/s")
    assert said.points[-1].words.startswith("faster than the drive")
    bare = decide(replace(slow, points=()))
    assert bare.signal == "act"
    safe = figures(1e3 * float(map_.upper_interval[1, -1]), up=True)
    assert f"give the drive {safe} mm/s: up to its 60 mm/s" in bare.instruction
    assert "[[points]]" in bare.otherwise


def _with_limit(map_: OperatingMap, share: float, by: str = "motor torque") -> OperatingMap:
    """The map of a drive that bears a share of the way from the least to the most that a belt may ask."""
    low, high = map_.holding_interval[:, -1]
    return replace(map_, torque_limit=float(low + share * (high - low)), limited_by=by)


@pytest.mark.parametrize(("share", "signal"), [(-0.1, "act"), (0.2, "watch"), (0.9, "watch"), (1.1, "good")])
def test_a_start_is_as_sure_as_the_drag_of_a_belt_at_rest(
    decide: Decide, found: Behaviour, map_: OperatingMap, share: float, signal: str
) -> None:
    """By the interval, whatever the estimate says: good above it, act below it, watch within."""
    fast = tuple(each for each in found.points if each.point.speed == FAST)
    said = decide(replace(found, points=fast, map=_with_limit(map_, share)))
    assert said.signal == said.points[0].signal == signal
    if signal == "watch":
        assert "make sure that it starts: a belt at rest needs" in said.instruction
        assert "but may not start: a belt at rest needs" in said.points[0].words
        assert said.flags[0].title == "The motor may not start the belt."


def test_a_wider_stick_speed_widens_what_a_belt_at_rest_bears(
    surface: DampingSurface, machine: Machine, map_: OperatingMap
) -> None:
    exact = operating_map(surface, machine.train, **machine.belt, temperatures=[HOT - 10, HOT], draws=40)
    (low, high), (least, most) = exact.holding_interval[:, -1], map_.holding_interval[:, -1]
    assert least < low <= float(exact.holding[-1]) <= high < most
    # A = e F(v_s): by the ends of the range of the stick speed, a factor of ten
    power = -1.0 - surface.transition.mixed_exponent.value  # type: ignore[union-attr]
    assert most / least == pytest.approx(10.0**power, rel=0.25)


def test_a_belt_that_is_not_started_comes_first(decide: Decide, found: Behaviour, map_: OperatingMap) -> None:
    said = decide(replace(found, map=_with_limit(map_, -0.2, "roll friction")))
    assert said.signal == "act"
    assert said.instruction.startswith("At 180 °C let the roll grip more than ")
    assert {point.signal for point in said.points} == {"act"}
    assert said.points[-1].words.startswith("not started: a belt at rest needs ")
    assert any(flag.title == "The roll slips at the start." for flag in said.flags)


def test_a_drive_that_does_not_bear_sliding_is_not_said_to_slide_on(
    decide: Decide, found: Behaviour, map_: OperatingMap
) -> None:
    said = decide(replace(found, map=replace(map_, torque_limit=1e-3, limited_by="motor torque")))
    assert said.otherwise.startswith("It does not slide on either: sliding takes ")


def test_a_motor_that_is_too_weak_is_named(decide: Decide, found: Behaviour, map_: OperatingMap) -> None:
    said = decide(replace(found, map=_with_limit(map_, -0.1)))
    assert "give the roll more than" in said.instruction
    assert said.flags[0].title == "The motor does not start the belt."


def test_without_a_machine_it_speaks_of_the_roll(log: hersey.TorqueLog, tmp_path: Path) -> None:
    points = log.steady(tare="standing")
    document = analyse(log, points)
    said = document.decision
    assert said is not None
    assert document.simulation is document.map is None
    assert not any("paper" in warning for warning in document.warnings)
    high = fit(points).transition_estimate(fit(points).temperature_range[1]).high  # type: ignore[index]
    assert f"keep the roll above {figures(high * 60 / math.tau, up=True)} rpm" in said.instruction
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
    within_limits = next(part.lines for part in said.missing if part.lines.startswith("# in [limits]"))
    others = "".join(part.lines for part in said.missing if not part.lines.startswith(("# in", "[rest]")))
    file.write_text(f'{stated}\n[limits]\nmotor_torque = "8 N*m"\n{within_limits}\n{others}')
    assert read_machine(file).limits.grip is not None


def test_a_stick_speed_whose_range_is_not_stated_makes_it_watch(
    decide: Decide, found: Behaviour, map_: OperatingMap
) -> None:
    fast = tuple(each for each in found.points if each.point.speed == FAST)
    assert decide(replace(found, points=fast)).signal == "good"
    unknown = replace(found, points=fast, map=replace(map_, uncertain=("stiffness",)))
    assert decide(unknown).signal == "watch"


def test_no_falling_branch_says_how_far_down() -> None:
    rng = np.random.default_rng(2)
    speeds = np.repeat(np.geomspace(1.0, 30.0, 12), 2)
    rising = _table(speeds, 0.2 * speeds**0.3 * np.exp(0.005 * rng.standard_normal(speeds.size)))
    said = rising.decision
    assert said is not None
    assert said.signal == "watch"  # from rest the belt passes speeds that nobody measured
    assert said.instruction.startswith("Measure dwells slower than 9.5 rpm: down to there torque rises")
    assert "goes on sliding down to 9.5 rpm. From rest it may stick" in said.otherwise
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


def test_one_temperature_is_not_named(points: hersey.SteadyPoints, machine: Machine) -> None:
    """An isothermal fit with a machine: the sentence begins with what to do."""
    hot = points.column("temperature") > points.column("temperature").max() - 5.0
    speeds, torques = points.column("speed")[hot], points.column("torque")[hot]
    alone = replace(machine, points=machine.points[-1:], uncertainty={}, rest=None)
    document = _table(speeds, torques, alone)
    assert document.decision is not None
    assert document.decision.instruction.startswith("Run above ")
    assert document.map is not None
    assert document.map.temperature is None


def test_what_cannot_be_computed_is_said(
    surface: DampingSurface, machine: Machine, decide: Decide, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A report does not fail for a map: the reason stands in its place."""

    def refuse(*_: object, **__: object) -> None:
        raise ParameterError("the bands cannot be computed: set 3")

    monkeypatch.setattr(behaviour, "operating_map", refuse)
    monkeypatch.setattr(behaviour, "plan_of_log", refuse)
    steps: list[str] = []
    found = Working(surface, machine).result(steps.append)
    assert steps[0] == "finding the bands"
    assert "planning thick paper" in steps
    said = decide(found)
    assert "rpm" in said.instruction
    assert {point.words for point in said.points} == {"not judged: there is no map"}
    assert any("the bands cannot be computed: set 3" in flag.text.lower() for flag in said.flags)
    assert found.points[1].reason.startswith("the bands cannot")
    assert found.stick_speeds is not None
    assert found.stick_speeds.upper[0] > found.stick_speeds.upper[-1]


def test_v_star_against_the_stick_speed_leaves_out_where_nothing_starts(
    surface: DampingSurface, machine: Machine, map_: OperatingMap
) -> None:
    """The least stick speeds ask for more than the grip: no V* there, rather than one at the transition."""
    grip = float(map_.holding[-1]) / machine.roll_radius
    limits = Limits(roll_friction=1.0, nip_load=grip * 1.01)
    found = Working(surface, replace(machine, limits=limits, points=machine.points[-1:])).result()
    assert found.stick_speeds is not None
    upper = np.array(found.stick_speeds.upper)
    assert np.isnan(upper[0])
    assert np.all(
        upper[np.isfinite(upper)] > 1.1 * np.array(found.stick_speeds.transition)[np.isfinite(upper)]
    )


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
        document = analyse(table, points, machine=machine)
    assert load(document.model_dump_json()) == document
    return document


def test_a_machine_that_does_not_fit_the_log_is_said(log: hersey.TorqueLog, machine: Machine) -> None:
    """A stick speed above the transition: the log is told in speed of the roll, and the reason beside it."""
    document = analyse(log, log.steady(tare="standing"), machine=replace(machine, stick_speed=0.5))
    assert document.map is document.band is document.simulation is None
    assert document.decision is not None
    assert document.decision.signal == "act"
    assert document.decision.flags[0].title == "No band."
    assert (
        "The stick speed, up to 1238 mm/s there, reaches the transition speed"
        in document.decision.flags[0].text
    )
    assert " mm/s" in document.decision.flags[0].text
    assert "rpm" in document.decision.instruction


def test_how_the_belt_stops_is_told_where_it_moves_v_star(decide: Decide, found: Behaviour) -> None:
    """A belt that stops dead sticks up to greater speeds: smooth by the other closure alone is not good."""
    curve = [0.001, 0.002, 0.004]
    stick = StickSpeeds(0.002, (0.001, 0.004), curve, [0.03] * 3, [0.07, 0.06, 0.05], 0.2)
    fast = tuple(replace(each, stiction=0.2) for each in found.points if each.point.speed == FAST)
    said = decide(replace(found, points=fast, stick_speeds=stick))
    [flag] = [flag for flag in said.flags if flag.title.startswith("V*")]
    assert flag.title == "V* hangs on the stick speed and how the belt stops."
    assert (
        "over 1.0 to 4.0 mm/s at 180 °C V* is 50 to 70 mm/s, and 200 mm/s if the belt stops dead (stiction)"
        in flag.text
    )
    partly = decide(replace(found, points=fast, stick_speeds=replace(stick, upper=[math.nan, 0.06, 0.05])))
    assert "V* is 50 to 60 mm/s, where the belt starts (2 of 3)" in partly.flags[0].text
    assert said.signal == said.points[0].signal == "watch"
    assert said.points[0].words == "smooth unless the belt stops dead: V* is 200 mm/s then"
    plain = tuple(replace(each, stiction=None) for each in fast)
    assert decide(replace(found, points=plain, stick_speeds=stick)).signal == "watch"
    # where it stops does not matter up to there, or is not known
    for stiction in (0.06, None):
        points = tuple(replace(each, stiction=stiction) for each in fast)
        calm = decide(replace(found, points=points, stick_speeds=replace(stick, stiction=stiction)))
        assert calm.signal == calm.points[0].signal == "good"
        assert not any("stops dead" in flag.text for flag in calm.flags)


def test_torque_of_the_whole_drive_is_never_good(
    decide: Decide, found: Behaviour, points: hersey.SteadyPoints
) -> None:
    """Who states less is told less: bearings in the torque draw V* down."""
    fast = replace(found, points=tuple(each for each in found.points if each.point.speed == FAST))
    assert decide(fast).signal == "good"
    whole = decide(fast, dwells=points)
    assert whole.signal == whole.points[0].signal == "watch"
    assert whole.points[0].words == "smooth from any start, if the torque is of the film alone"
    assert whole.flags[0].title == "Torque may hold more than the film."
    assert decide(replace(found, points=())).signal == "watch"  # good for what?


def test_v_star_of_a_belt_that_stops_dead_is_that_of_stiction(
    surface: DampingSurface, machine: Machine
) -> None:
    found = Working(surface, replace(machine, points=machine.points[-1:], uncertainty={})).result()
    drag = replace(surface.drag(**machine.belt, temperature=HOT), closure="stiction")
    exact = hysteresis(machine.train, drag, sensitivity=False).upper
    assert found.stick_speeds is not None
    assert found.stick_speeds.stiction == found.points[0].stiction == pytest.approx(exact)
    assert exact > 1.5 * found.band.upper


def test_a_start_that_is_only_unsure_is_not_called_impossible(
    decide: Decide, found: Behaviour, surface: DampingSurface, machine: Machine, map_: OperatingMap
) -> None:
    """A plan for 95 % of the machines fails where some do not break loose: one warning, and no act."""
    drag = surface.drag(**machine.belt, temperature=HOT)
    none = plan_profile(machine.train, drag, target_speed=BETWEEN, limits=Limits(speed=0.045))
    point = PointBehaviour(OperatingPoint("thick paper", BETWEEN, HOT), plan=none)
    said = decide(replace(found, points=(point,), map=_with_limit(map_, 0.5)))
    assert "for 45 mm/s no start is sure: the belt may not break loose" in said.otherwise
    assert said.points[0].signal == said.signal == "watch"
    assert "The motor may not start the belt." in {flag.title for flag in said.flags}
    assert not any(flag.title.startswith("No start") for flag in said.flags)


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
            "the stick speed, up to 36 mm/s there, reaches the transition speed, 33 mm/s: state less",
        ),
        (
            ParameterError(
                "set 2: stiffness is -3: it must be greater than 0",
                quantity="stiffness",
                value=-3.0,
                limit=0.0,
            ),
            "the stiffness is -3 N/m: it must be greater than 0 N/m",
        ),
        (
            ParameterError(
                "drive_speed is 0: it must be greater than 0", quantity="drive_speed", value=0.0, limit=0.0
            ),
            "the drive speed is 0 mm/s: it must be greater than 0 mm/s",
        ),
        (
            ParameterError("mass is NaN: a finite number is needed", quantity="mass", value=math.nan),
            "the mass is NaN: a finite number is needed",
        ),
        (
            UnfinishedError("no end after 7 steps, all that are allowed: allow more by most_steps", steps=7),
            "look at their units",
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
    decide: Decide, found: Behaviour, map_: OperatingMap, points: hersey.SteadyPoints
) -> None:
    weak = _with_limit(map_, -0.1)
    for unit, factor in (("N·m", 1.0), ("mN·m", 1e3)):
        said = decide(replace(found, map=weak), unit=unit)
        needed = figures(factor * float(map_.holding_interval[1, -1]), up=True)
        gives = figures(factor * float(weak.torque_limit or 0.0))
        assert f"more than {needed} {unit}: the motor's {gives} {unit} do not start" in said.instruction
        assert f" {unit} to break loose, the motor gives {gives}" in said.points[-1].words
    large = float(np.abs(points.column("torque")).max())
    assert large > 1.0
    assert display_units(points, None)["torque"] == "N·m"
    few = replace(points, table=points.table.with_columns(torque=points.table["torque"] * 0.9 / large))
    assert display_units(few, None)["torque"] == "mN·m"
    for holding, limit, unit in (
        (0.5, None, "mN·m"),
        (1.0, None, "N·m"),
        (0.5, 1.2, "N·m"),
        (0.5, 0.9, "mN·m"),
    ):
        told = replace(map_, holding=np.array([holding]), torque_limit=limit)
        assert display_units(few, told)["torque"] == unit


def test_what_of_the_nip_cannot_be_is_a_warning(decide: Decide, found: Behaviour, document: Analysis) -> None:
    """The farthest off, where no exponent and no torque is flagged already; a formula's range is none."""
    assert document.film is not None
    off = MisfitPart(signal="act", text="friction coefficient 0.5 is not a fluid film", size=1.7)
    film = document.film.model_copy(update={"misfits": [off], "contradicted": False})
    shown = [flag for flag in decide(found, film=film).flags if flag.section == "regime"]
    assert [(flag.title, flag.text) for flag in shown] == [
        ("Nip and log disagree.", "Friction coefficient 0.5 is not a fluid film.")
    ]
    mild = film.model_copy(update={"misfits": [off.model_copy(update={"signal": "watch"})]})
    assert "Nip and log disagree." not in {flag.title for flag in decide(found, film=mild).flags}


def test_the_laws_tried_stand_in_their_order(document: Analysis) -> None:
    tried = document.regime.tried
    assert [law.aicc for law in tried] == sorted(law.aicc for law in tried)
    assert {law.verdict == "not excluded" for law in tried} == {True, False}
    assert all(law.parameters for law in tried)
    listed = {each.name for each in document.regime.explanations}
    kept = {law.name for law in tried if law.verdict == "not excluded"}
    assert kept - {"one power of speed"} <= listed


def test_a_range_of_the_stick_speed_above_the_transition_leaves_a_plan(
    surface: DampingSurface, machine: Machine
) -> None:
    """It is that of the draws that are belts, and says how many are none; of next to none is none."""
    reasons = []
    for limits in ((2e-3, 0.05), (0.032, 0.9)):
        spread = {"stick_speed": Uncertainty(limits=limits)}
        given = replace(machine, points=(machine.points[1],), uncertainty=spread)
        point = Working(surface, given).result().points[0]
        reasons.append((point.plan is not None, point.reason))
        if point.plan is not None and point.plan.found:
            assert any("% of what is stated is no belt" in said for said in point.plan.warnings)
    assert reasons[0] == (True, "")
    assert not reasons[1][0]
    assert "hardly a draw is possible: state less" in reasons[1][1]
