"""Plans through changing temperature rest on the draws of the posterior."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.decision.warming import plan_warm_start
from hersey.errors import ParameterError
from hersey.motion.schedule import Schedule
from hersey.posterior import Posterior
from hersey.posterior.drags import drags_at, drags_through

EXAMPLES = Path(__file__).parents[2] / "examples"
HOT = 453.15
#: Half a minute of warming, then hot for good.
WARMING = Schedule([0.0, 30.0], [400.0, HOT])


def _drawn(seed: int) -> Posterior:
    """Draws of the dwells alone: closure, drag and stick speed stay open."""
    machine = hersey.read_machine(EXAMPLES / "machine.toml")
    assert machine.rest is not None
    points = hersey.read(EXAMPLES / "bench.csv").steady(tare="standing").without(machine.rest)
    return hersey.posterior(points, machine, evidence=(), draws=400, seed=seed)


@pytest.fixture(scope="module")
def drawn() -> Posterior:
    return _drawn(1)


def test_tables_move_as_the_curves_of_the_draws(drawn: Posterior) -> None:
    """At the temperature of a table, and at another, its forces are those of the draw's own curve."""
    few = drawn.drives.take(np.arange(0, 400, 40))
    tables = drags_through(drawn.model, few, HOT)
    for kelvin, within in ((HOT, 2e-3), (420.0, 0.03)):
        grid, curves = drawn.model.speeds(kelvin), np.exp(drawn.model.log_force(few, kelvin))
        among = (grid > 0.01) & (grid < 0.2)
        for (_, table), curve in zip(tables, curves, strict=True):
            constant, damping = drawn.model.no_load(kelvin)
            expected = curve[among] + constant + damping * grid[among]
            assert table.force(grid[among], temperature=kelvin) == pytest.approx(expected, rel=within)


def test_starts_of_tables_are_those_of_the_draws(drawn: Posterior) -> None:
    """Two integrators, tables event by event and draws in lanes, agree on which belts slide."""
    some = drawn.drives.take(np.arange(0, 400, 8))
    corners = [(0.0, 0.0), (0.001, 0.12)]
    lanes = np.asarray(drawn.model.start_ups(some, HOT, corners).slides)
    assert 5 < np.count_nonzero(lanes) < 45
    slides = []
    for train, drag in drags_at(drawn.model, some, HOT):
        run = hersey.simulate(
            train,
            drag,
            drive_speed=Schedule(*(list(each) for each in zip(*corners, strict=True))),
            duration=60.0 * train.free_period,
            most_steps=1e8,
        )
        late = run.belt_speed[run.time > run.time[-1] - 5.0 * train.free_period]
        slides.append(bool(np.min(late) > drag.stick_speed))
    assert np.count_nonzero(lanes != np.array(slides)) <= 1


def test_a_plan_works_on_draws_of_another_seed(drawn: Posterior) -> None:
    plan = plan_warm_start(drawn, 0.1, temperature=WARMING)
    assert plan.found
    assert plan.draws == 200
    assert plan.temperature == pytest.approx(HOT)
    assert plan.schedule is not None
    others = _drawn(2)
    worked, tried = 0, 60
    for train, drag in drags_through(others.model, others.drives.take(np.arange(tried) * 6), HOT):
        run = hersey.simulate(
            train,
            drag,
            drive_speed=plan.schedule,
            temperature=WARMING,
            duration=40.0,
            samples=40001,
            most_steps=1e8,
        )
        worked += bool(np.min(run.belt_speed[run.time > 35.0]) > 2.0 * drag.stick_speed)
    assert worked / tried > 0.9


def test_a_target_below_the_transition_is_refused(drawn: Posterior) -> None:
    plan = plan_warm_start(drawn, 0.015, temperature=WARMING)
    assert not plan.found
    assert plan.obstacles


def test_a_stick_speed_that_stays_is_refused(drawn: Posterior) -> None:
    """A table moves its stick speed with temperature: one that is fixed cannot be followed."""
    fixed = replace(drawn.model.machine, stick_speed_rule="fixed")
    found = replace(drawn, model=replace(drawn.model, machine=fixed))
    with pytest.raises(ParameterError, match="fixed"):
        plan_warm_start(found, 0.1, temperature=WARMING)


def test_the_cold_drag_is_as_open_as_the_draws_leave_it(drawn: Posterior) -> None:
    """At 20 degC, far below the dwells: spread and middle of the tables are those of the draws."""
    cold = 293.15
    few = drawn.drives.take(np.arange(0, 400, 4))
    tables = drags_through(drawn.model, few, HOT, cold)
    speed = 0.045
    constant, damping = drawn.model.no_load(cold)
    of_tables = [
        float(table.force(speed, temperature=cold)) - constant - damping * speed for _, table in tables
    ]
    of_draws = drawn.model.force_at(few, cold, speed)
    low, middle, high = np.quantile(of_tables, (0.05, 0.5, 0.95))
    expected = np.quantile(of_draws, (0.05, 0.5, 0.95))
    assert middle == pytest.approx(expected[1], rel=0.15)
    assert high / low == pytest.approx(expected[2] / expected[0], rel=0.35)


def test_a_profile_that_fresh_draws_refuse_is_said_to_be_so(
    drawn: Posterior, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A search that allows too many failures finds a profile that less than 99 % of fresh draws follow."""
    monkeypatch.setattr("hersey.stability.plan.proof._STRICTLY", 6.0)
    plan = plan_warm_start(drawn, 0.05, temperature=WARMING, confidence=0.99)
    [obstacle] = plan.obstacles
    assert obstacle.limit == "confidence"
    assert obstacle.needed is not None
    assert 0.9 < obstacle.needed < 0.99
