"""Drive profiles: each ends smooth, keeps the limits, and says what forbids it where there is none."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from benchmarks.plan import brute_force, case, fresh_share, planned
from scipy.stats import binom

import hersey
from hersey.errors import ParameterError
from hersey.machine.limits import Limits
from hersey.machine.uncertainty import Uncertainty
from hersey.stability.plan.draws import lower_bound, most_failures, needed
from tests.cli.command import run
from tests.machines import machine_of

TRAIN = hersey.Drivetrain(1000, 1)
DRAG = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
WIDE = Limits(speed=4.0, acceleration=10.0)


def test_bounds_are_those_of_the_binomial() -> None:
    """Clopper and Pearson: at the bound, so few failures have just the probability left over."""
    for good, count, level in ((200, 220, 0.95), (972, 1000, 0.999)):
        bound = lower_bound(good, count, level)
        assert binom.sf(good - 1, count, bound) == pytest.approx(1 - level, rel=1e-9)
    least = needed(0.95, 0.999, 2)
    assert lower_bound(least - 2, least, 0.999) >= 0.95 > lower_bound(least - 3, least - 1, 0.999)
    most = most_failures(0.95, 0.999, 1000)
    assert lower_bound(1000 - most, 1000, 0.999) >= 0.95 > lower_bound(999 - most, 1000, 0.999)


def test_straight_up_where_the_past_does_not_matter() -> None:
    """Above V* every start ends smooth: the steepest ramp will do, for by its end the belt slides."""
    plan = hersey.plan_profile(
        machine_of(TRAIN, limits=Limits(speed=4.0, acceleration=3.0)), DRAG, target_speed=3.0
    )
    assert plan.kind == "direct"
    assert plan.duration == pytest.approx(1.0, rel=1e-5)
    assert plan.response is not None
    late = plan.response.time > plan.duration
    assert plan.response.belt_speed[late].min() > DRAG.stick_speed


def test_overshoot_in_the_band() -> None:
    """The paper's case: below V* = 2.17 it comes from above (it overshoots to 2.5 v_t; we need less time)."""
    plan = hersey.plan_profile(machine_of(TRAIN, limits=WIDE), DRAG, target_speed=1.9)
    assert plan.found
    by_hand = hersey.Schedule([0.0, 0.25, 1.25, 1.31], [0.0, 2.5, 2.5, 1.9])
    assert plan.duration < by_hand.times[-1]
    assert plan.schedule is not None
    end = hersey.simulate(TRAIN, DRAG, drive_speed=plan.schedule, duration=plan.duration, tolerance=1e-11)
    state = float(end.belt_speed[-1]), float(end.stretch[-1])
    settled = hersey.stick_slip(TRAIN, DRAG, drive_speed=1.9, start=state)
    assert settled.kind == "steady_sliding"


@pytest.mark.parametrize("number", [0, 1004, 6])
def test_random_drives_keep_their_confidence(number: int) -> None:
    """Fresh draws, tight tolerance; nothing of a brute-force grid is quicker (200 of them: benchmarks)."""
    given = case(number)
    plan = planned(given, seed=number + 1)
    assert plan.found
    assert fresh_share(given, plan, draws=300) >= 0.95
    assert brute_force(given, plan, seed=number + 1)[0] >= plan.duration


def test_the_same_seed_gives_the_same_plan() -> None:
    given = case(1004)
    plans = [planned(given, seed=3) for _ in range(2)]
    assert len(plans[0].rows()) > 2
    assert plans[0].rows() == plans[1].rows()
    assert plans[0].to_dict() == plans[1].to_dict()


@pytest.mark.parametrize(
    ("limits", "target", "limit", "text"),
    [
        (
            Limits(speed=1.5),
            1.9,
            "speed",
            "The drive speed is limited to 1.5 m/s, but 1.9 m/s would be enough",
        ),
        (WIDE, 0.9, "target_speed", "not above the transition speed 1.001 m/s"),
        (
            Limits(speed=4.0, acceleration=10.0, spring_force=60.0),
            1.9,
            "spring_force",
            "spring force is limited",
        ),
    ],
)
def test_the_forbidding_limit_is_named(limits: Limits, target: float, limit: str, text: str) -> None:
    plan = hersey.plan_profile(machine_of(TRAIN, limits=limits), DRAG, target_speed=target)
    assert plan.kind == "impossible"
    assert not plan.found
    assert plan.rows() == []
    assert [obstacle.limit for obstacle in plan.obstacles] == [limit]
    assert text in plan.verdict()


def test_the_number_that_would_do_does() -> None:
    """A limit raised to what the plan asks for leaves a profile."""
    tight = Limits(speed=4.0, acceleration=10.0, spring_force=100.0)
    refused = hersey.plan_profile(machine_of(TRAIN, limits=tight), DRAG, target_speed=1.9)
    assert refused.kind == "impossible"
    enough = refused.obstacles[0].needed
    assert enough is not None
    wider = replace(tight, spring_force=enough)
    plan = hersey.plan_profile(machine_of(TRAIN, limits=wider), DRAG, target_speed=1.9)
    assert plan.found
    assert [each.kind for each in plan.warnings] == ["grip not in the plan"]
    assert str(plan.warnings[0]) == (
        "the grip is not stated (roll_friction and nip_load), so the drive is assumed not to slip"
    )


#: A fuser whose roll grips with 180 N, and whose belt 288 N hold at rest.
FUSER = hersey.Drivetrain(11e3, 11.0)
FUSER_DRAG = hersey.Drag(
    48.733, 0.032320, ehl_exponent=-0.70025, mixed_exponent=-1.20564, stick_speed=7.401e-4
)
FUSER_LIMITS = Limits(speed=0.4, acceleration=0.5, motor_torque=8.0, roll_friction=0.6, nip_load=300.0)


def test_a_roll_that_cannot_start_the_belt_has_no_plan() -> None:
    """Once a plan of 98.5 % with a remark: its motion needed 434 N, and the roll grips with 180 N."""
    refused = hersey.plan_profile(
        machine_of(FUSER, limits=FUSER_LIMITS, roll_radius=0.015), FUSER_DRAG, target_speed=0.045
    )
    assert [o.limit for o in refused.obstacles] == ["grip"]
    assert refused.obstacles[0].given == pytest.approx(180.0)
    enough = refused.obstacles[0].needed
    assert enough is not None
    assert enough > FUSER_DRAG.holding_force > 180.0
    assert f"The grip of 180 N cannot start it; {enough:g} N is needed" in refused.verdict()
    assert hersey.stick_slip(replace(FUSER, grip=180.0), FUSER_DRAG, drive_speed=0.045).kind == "stalled"


def test_a_plan_comes_up_more_slowly_where_the_grip_is_scarce() -> None:
    """Between what starts the belt and what the quickest profile takes: another, which keeps the grip."""
    grip = 1.02 * FUSER_DRAG.holding_force
    limits = replace(FUSER_LIMITS, nip_load=1000.0)
    free = hersey.plan_profile(
        machine_of(FUSER, limits=limits, roll_radius=0.015), FUSER_DRAG, target_speed=0.12
    )
    train = replace(FUSER, grip=grip)
    kept = hersey.plan_profile(
        machine_of(train, limits=limits, roll_radius=0.015), FUSER_DRAG, target_speed=0.12
    )
    assert free.peak_force > grip > kept.peak_force
    assert kept.duration > free.duration
    for plan, slips in ((free, True), (kept, False)):
        assert plan.schedule is not None
        run = hersey.simulate(
            train, FUSER_DRAG, drive_speed=plan.schedule, duration=2 * plan.duration, tolerance=1e-11
        )
        assert ("grip_lost" in [event.guard for event in run.events]) == slips


def test_waiting_for_warmth() -> None:
    """Cold, the belt does not break away within the force allowed: the drive waits until it does."""
    drag = replace(
        DRAG,
        reference_temperature=400.0,
        force_temperature_exponent=-2.0,
        speed_temperature_exponent=0.5,
        temperature_zero=273.15,
    )
    course = hersey.Schedule([0.0, 20.0, 30.0], [320.0, 400.0, 400.0])
    limits = Limits(speed=4.0, acceleration=10.0, spring_force=1.5 * drag.at(400.0).breakaway_force)
    plan = hersey.plan_profile(machine_of(TRAIN, limits=limits), drag, target_speed=2.5, temperature=course)
    assert plan.found
    assert 1.0 < plan.wait < 20.0
    assert plan.verdict().startswith("Wait ")
    cold = drag.at(course.at(0.5 * plan.wait))
    assert cold.breakaway_force > 1.5 * drag.at(400.0).breakaway_force


def test_motor_torque_is_a_limit_at_the_roll() -> None:
    plan = hersey.plan_profile(
        machine_of(TRAIN, limits=replace(WIDE, motor_torque=8.0), roll_radius=0.02), DRAG, target_speed=1.9
    )
    use = {use.name: use for use in plan.uses}["motor_torque"]
    assert use.used == pytest.approx(0.02 * plan.peak_force)
    assert use.used <= 8.0
    flat = machine_of(TRAIN, limits=replace(WIDE, motor_torque=8.0), roll_radius=0.0)
    with pytest.raises(ParameterError, match="roll_radius"):
        hersey.plan_profile(flat, DRAG, target_speed=1.9)


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"target_speed": -1.0}, "target_speed is -1"),
        ({"target_speed": math.nan}, "target_speed is NaN"),
        ({"confidence": 1.0}, "confidence is 1: it must be from 0.5 to 0.999"),
        ({"seed": -1}, "seed is -1"),
        ({"uncertainty": {"colour": Uncertainty(share=0.1)}}, "unknown parameter 'colour'"),
        ({"samples": {"stiffness": [1.0, 2.0], "mass": [1.0]}}, "must have equal lengths"),
        ({"samples": [(TRAIN, DRAG)]}, "too few machines. Give at least 40"),
        ({"limits": Limits(speed=-1.0)}, "speed is -1"),
        ({"temperature": 300.0}, "temperature"),
    ],
)
def test_bad_arguments_are_named(changed: dict[str, object], words: str) -> None:
    given: dict[str, object] = {"target_speed": 1.9, "limits": WIDE, **changed}
    stated = {name: given.pop(name) for name in ("limits", "uncertainty") if name in given}
    with pytest.raises(ParameterError, match=words):
        hersey.plan_profile(machine_of(TRAIN, **stated), DRAG, **given)  # type: ignore[arg-type]


def test_smooth_closures_are_refused() -> None:
    with pytest.raises(ParameterError, match="stribeck"):
        hersey.plan_profile(TRAIN, replace(DRAG, closure="stribeck"), target_speed=1.9)


@pytest.mark.usefixtures("few_draws", "few_laws")
def test_the_command_writes_table_and_figure(examples_here: Path) -> None:
    text = (examples_here / "examples" / "machine.toml").read_text()
    strong = re.sub('motor_torque = "[0-9.]+', 'motor_torque = "1000', text)  # a grip that suffices
    (examples_here / "machine.toml").write_text(strong)
    (examples_here / "no-load.csv").symlink_to(examples_here / "examples" / "no-load.csv")
    command = ["plan", "machine.toml", "examples/bench.csv", "--tare", "standing"]
    asked = [*command, "--target", "45 mm/s", "--at", "180 degC", "--seed", "4"]
    result = run(*asked, "--out", "p.csv", "--figure", "p.svg", "--json", cwd=examples_here)
    assert result.returncode == 0, result.stderr
    document = json.loads(result.stdout)
    assert document["seed"] == 4
    assert document["share_low"] >= 0.95
    table = np.loadtxt(examples_here / "p.csv", delimiter=",", skiprows=1)
    assert (examples_here / "p.csv").read_text().startswith("time [s],drive speed [m/s]\n")
    assert table.tolist() == [[row["time"], row["drive_speed"]] for row in document["rows"]]
    assert table[-1, 1] == 0.045
    assert "slides steadily" in (examples_here / "p.svg").read_text()
    again = run(*asked, "--out", "p.csv", cwd=examples_here)
    assert (again.returncode, "exists" in again.stderr) == (2, True)


@pytest.mark.usefixtures("few_draws", "few_laws")
def test_a_temperature_outside_the_log_is_warned_of(examples_here: Path) -> None:
    command = ["plan", "examples/machine.toml", "examples/bench.csv", "--tare", "standing"]
    hot = run(*command, "--target", "200 mm/s", "--at", "250 degC", cwd=examples_here)
    assert hot.returncode == 0
    assert "drag at 250 degC to 250 degC is extrapolated" in hot.words
    inside = run(*command, "--target", "200 mm/s", "--at", "150 degC", cwd=examples_here)
    assert "extrapolated" not in inside.words


@pytest.mark.usefixtures("few_draws", "few_laws")
def test_the_command_says_what_forbids_a_profile(examples_here: Path) -> None:
    command = ["plan", "examples/machine.toml", "examples/bench.csv", "--tare", "standing"]
    refused = run(*command, "--target", "25 mm/s", "--at", "180 degC", "--out", "p.csv", cwd=examples_here)
    assert refused.returncode == 1
    assert "is below the speed of lowest drag" in refused.words
    assert not (examples_here / "p.csv").exists()
    text = (examples_here / "examples" / "machine.toml").read_text()
    weak = re.sub('motor_torque = "[0-9.]+', 'motor_torque = "0.1', text)
    (examples_here / "weak.toml").write_text(weak)
    (examples_here / "no-load.csv").symlink_to(examples_here / "examples" / "no-load.csv")
    cold = ["--target", "45 mm/s", "--heat", "--from", "20 degC", "--out", "p.csv"]
    never = run("plan", "weak.toml", *command[2:], *cold, cwd=examples_here)
    assert never.returncode == 1
    assert "he motor torque of 0.1 N m cannot start it" in never.words
    assert not (examples_here / "p.csv").exists()
    for arguments, words in (
        (["--target", "45"], "45"),
        (["--at", "180 degC"], "--target"),
        (["--target", "45 mm/s"], "--at"),
        (
            ["--target", "45 mm/s", "--at", "180 degC", "--temperature-profile", "c.csv"],
            "--temperature-profile",
        ),
        (["--target", "45 mm/s", "--temperature-profile", "none.csv"], "none.csv"),
        (["--target", "45 mm/s", "--at", "180 degC", "--heat"], "--heat"),
        (["--target", "45 mm/s", "--at", "180 degC", "--from", "20 degC"], "--heat"),
    ):
        result = run(*command, *arguments, cwd=examples_here)
        assert result.returncode == 2
        assert words in result.stderr
        assert result.stderr.count("\n") == 1


def test_a_temperature_that_changes_within_laps_is_followed_to_its_end() -> None:
    """Cooling by 33 K in 45 laps brings the transition speed up to a swing that would have died out."""
    train, target = hersey.Drivetrain((111.83 / 0.04) ** 2, 1), 1.5784
    drag = hersey.Drag(
        111.8277,
        1,
        ehl_exponent=-0.70678,
        mixed_exponent=-1.38485,
        stick_speed=0.08497,
        rest_force=44.3455,
        reference_temperature=400,
        force_temperature_exponent=-1.89,
        speed_temperature_exponent=-0.6835,
    )
    cooling = hersey.Schedule([0, 0.08], [433.58, 400])
    plan = hersey.plan_profile(train, drag, target_speed=target, temperature=cooling)
    assert plan.found
    run = hersey.simulate(train, drag, drive_speed=plan.schedule, temperature=cooling, duration=0.3)
    late = [event for event in run.events if event.time > plan.duration * (1 + 1e-9)]
    assert not any(event.to_mode == "stuck" for event in late)
    swing = np.ptp(run.belt_speed[run.time > 0.28])
    assert swing < 0.8 * np.ptp(run.belt_speed[(run.time > 0.08) & (run.time < 0.1)])
