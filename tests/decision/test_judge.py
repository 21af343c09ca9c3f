"""The verdict follows from the draws by thresholds that are stated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import hersey
from hersey.decision import judge, next_measurement
from hersey.decision.judge import drive_limit
from hersey.decision.measurement import measurements
from hersey.decision.start_up import _Asked, plan_start_up
from hersey.machine.limits import Limits
from hersey.posterior import Posterior
from hersey.posterior.drives import Drives
from hersey.posterior.likelihood import break_away_force
from hersey.posterior.sampling import posterior
from hersey.stability.plan.trial import Shape
from hersey.study.first_screen.advice import design_part, ranking
from tests.conftest import ROOT

HOT = 453.15


@pytest.fixture(scope="module")
def found() -> Posterior:
    machine = hersey.read_machine(ROOT / "examples" / "machine.toml")
    points = hersey.read(ROOT / "examples" / "bench.csv").steady(tare="standing").without(machine.rest)
    return posterior(points, machine, evidence=(), draws=400)


def _with(found: Posterior, limits: Limits | None = None, **edges: np.ndarray) -> Posterior:
    """The same with other draws of the edges, or other limits."""
    machine = found.model.machine
    model = replace(found.model, machine=replace(machine, limits=limits or machine.limits))
    made = replace(found, model=model)
    made._edges[HOT, len(made.drives)] = replace(found.edges(HOT), **edges)
    return made


@pytest.mark.parametrize(
    ("above", "kind"), [(1.0, "smooth"), (0.98, "smooth"), (0.97, "depends"), (0.0, "depends")]
)
def test_smooth_takes_97_5_per_cent(found: Posterior, above: float, kind: str) -> None:
    size = len(found.drives)
    fold = np.where(np.arange(size) < round(above * size), 0.09, 0.11)
    made = _with(found, fold=fold, transition=np.full(size, 0.03), stalls=np.zeros(size, dtype=bool))
    verdict = judge(made, HOT, 0.1)
    assert verdict.kind == kind
    assert verdict.probability.smooth == pytest.approx(above, abs=1e-9)


@pytest.mark.parametrize(("below", "kind"), [(1.0, "sticks"), (0.97, "unknown"), (0.0, "depends")])
def test_below_the_transition_it_sticks(found: Posterior, below: float, kind: str) -> None:
    size = len(found.drives)
    turn = np.where(np.arange(size) < round(below * size), 0.06, 0.04)
    made = _with(found, fold=np.full(size, 0.2), transition=turn, stalls=np.zeros(size, dtype=bool))
    assert judge(made, HOT, 0.05).kind == kind


def test_limits_come_first(found: Posterior) -> None:
    assert judge(_with(found, Limits(speed=0.4)), HOT, 0.41).kind == "too fast"
    assert judge(_with(found, Limits(motor_torque=0.05)), HOT, 0.2).kind == "not started"
    assert judge(_with(found, Limits(motor_torque=50.0)), HOT, 0.39).kind == "smooth"
    assert drive_limit(Limits(motor_torque=0.3), 0.015, 15.0) == 15.0
    assert drive_limit(Limits(motor_torque=0.15), 0.015, 15.0) == pytest.approx(10.0)
    assert drive_limit(Limits(), 0.015, None) == np.inf


def test_the_next_measurement_narrows_v_star(found: Posterior) -> None:
    every = measurements(found)
    assert {each.kind for each in every} == {"starts", "break-away", "stick-slip", "dwell"}
    assert [each.left for each in every] == sorted(each.left for each in every)
    best = next_measurement(found)
    assert best is not None
    assert best.left < 0.6
    # three starts leave what lies between them: of V* alone, by hand
    [starts] = [each for each in every if each.kind == "starts"]
    fold = np.log(found.edges(HOT).fold)
    edges = np.log(np.array(starts.speeds))
    inside = [fold[(fold >= a) & (fold < b)] for a, b in zip([-9, *edges], [*edges, 9], strict=True)]
    width = sum(np.ptp(np.quantile(part, [0.025, 0.975])) * part.size for part in inside) / fold.size
    whole = np.ptp(np.quantile(fold, [0.025, 0.975]))
    assert starts.left == pytest.approx(width / whole, rel=0.15)


def test_a_known_v_star_needs_no_measurement(found: Posterior) -> None:
    size = len(found.drives)
    narrow = _with(found, fold=np.geomspace(0.1, 0.11, size))
    assert measurements(narrow) == ()
    assert next_measurement(narrow) is None


def test_a_start_up_works_on_draws_of_all_closures(found: Posterior) -> None:
    plan = plan_start_up(found, HOT, 0.04)
    assert plan.found
    assert plan.kind == "overshoot"
    assert plan.share >= 0.95
    corners = [(t, v) for t, v in plan.rows()]
    for closure in range(3):
        mine = found.drives.take(np.flatnonzero(found.drives.closure == closure))
        started = found.model.start_ups(mine, HOT, corners)
        assert np.mean(started.slides) >= 0.93
    speeds = [v for _, v in corners]
    assert max(speeds) <= 0.4
    assert plan.response is not None
    # a swing about 40 mm/s near the speed of least drag dies out slowly
    late = plan.response.belt_speed[-plan.response.belt_speed.size // 4 :]
    assert np.all((late > 0.5 * 0.04) & (late < 1.5 * 0.04))
    assert np.mean(late) == pytest.approx(0.04, rel=0.03)


def test_no_start_up_below_the_transition(found: Posterior) -> None:
    plan = plan_start_up(found, HOT, 0.02)
    assert not plan.found
    assert [each.limit for each in plan.obstacles] == ["target_speed"]


def test_no_profile_is_faster_than_the_drive(found: Posterior) -> None:
    """A plan goes to a motor controller: the drive's own limit comes first."""
    made = _with(found, Limits(speed=0.4, acceleration=0.5))
    [obstacle] = plan_start_up(made, HOT, 0.6).obstacles
    assert (obstacle.limit, obstacle.given, obstacle.needed) == ("speed", 0.4, 0.6)
    for confidence in (0.0, 2.0):
        with pytest.raises(hersey.HerseyError, match=r"from 0\.5 to 0\.999"):
            plan_start_up(made, HOT, 0.1, confidence=confidence)


def test_starts_are_proposed_at_speeds_of_the_drive(found: Posterior) -> None:
    made = _with(found, Limits(speed=0.12))
    proposed = [each for each in measurements(made) if each.kind == "starts"]
    assert max(speed for each in proposed for speed in each.speeds) <= 0.12


def test_design_ranks_what_would_narrow_v_star(found: Posterior) -> None:
    """Lines and JSON name the same measurements, the most useful first."""
    ranked = measurements(found)
    lines = ranking(found, ranked)
    part = design_part(found, ranked)
    assert [each.kind for each in part.measurements] == [each.kind for each in ranked]
    assert [each.left for each in ranked] == sorted(each.left for each in ranked)
    assert {each.kind for each in ranked} == {"starts", "break-away", "dwell", "stick-slip"}
    assert lines[0].startswith("At 180 °C V* is ")
    assert len(lines) == 2 + len(ranked)
    assert part.fold is not None
    assert part.fold.low < part.fold.value < part.fold.high
    assert ranking(found, ())[-1] == "No measurement would make the interval much narrower."


def test_a_belt_let_go_later_than_two_laps_after_the_ramp_does_not_count(found: Posterior) -> None:
    """Of belts that stop abruptly by hand: the spring is pulled up at stiffness times drive speed."""
    drives = found.drives.take(np.flatnonzero(found.drives.closure == 1))
    light = replace(found.model, machine=replace(found.model.machine, mass=0.01))  # of a lap of 6 ms
    shape = Shape(0.12, 0.12, 1e-3)
    asked = _Asked(replace(found, model=light), HOT, 0.12, Limits(), np.inf)
    slides, _ = asked.tried(drives, shape)
    stiffness = found.model.numbers(drives)[:, 1]
    let_go = 0.5e-3 + break_away_force(found.model, drives, HOT) / (stiffness * 0.12)
    soon = let_go <= 1e-3 + 2.0 * 2.0 * np.pi * np.sqrt(0.01 / 11e3)
    ever = np.asarray(found.model.start_ups(drives, HOT, [(0.0, 0.0), (1e-3, 0.12)]).slides)
    assert np.count_nonzero(ever & ~soon) > 5
    np.testing.assert_array_equal(slides, ever & soon)


def test_a_plan_says_what_its_draws_take(found: Posterior, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every draw slides, the i-th with a peak of i newtons: 80 % take no more than 0.8 of the last."""

    def tried(_: _Asked, drives: Drives, _shape: object) -> tuple[np.ndarray, np.ndarray]:
        return np.full(len(drives), True), np.arange(float(len(drives)))

    monkeypatch.setattr(_Asked, "tried", tried)
    plan = plan_start_up(found, HOT, 0.045, confidence=0.8)
    assert plan.peak_force == pytest.approx(0.8 * (plan.draws - 1))
    turns = sorted(found.edges(HOT).transition.tolist())
    middle = len(turns) // 2
    typical = turns[middle] if len(turns) % 2 else 0.5 * (turns[middle - 1] + turns[middle])
    assert plan.transition_speed == pytest.approx(typical)
    assert turns[0] < 0.95 * typical
