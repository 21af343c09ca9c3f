"""The speeds that a decision stands on: which end of which interval, and which way a comparison goes."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.damping.estimate import Estimate
from hersey.damping.surface import DampingSurface
from hersey.damping.trend import Trend
from hersey.decision.behaviour import Behaviour, PointBehaviour, Working
from hersey.decision.edges import Edge, Edges, edges_of
from hersey.decision.judge import judge
from hersey.machine.limits import Limits, OperatingPoint
from hersey.machine.machine import Machine
from hersey.schema.warning import Warning
from hersey.stability.operating_map import OperatingMap
from hersey.study.findings import Findings
from hersey.study.first_screen.flags import MOST, flags
from hersey.study.first_screen.instruction import of_log
from hersey.study.first_screen.points import points_of_log
from hersey.study.torque_budget import TorqueBudgetPart
from hersey.verdict.regime import Regime
from hersey.verdict.warnings import warnings_of
from tests.document.conftest import HOT, Decide


def test_a_drive_starts_by_the_ends_of_what_a_start_takes() -> None:
    held = Edge(1.0, 0.5, 2.0)
    edges = Edges(Edge(0.03, 0.02, 0.09), Edge(0.05, 0.04, 0.07), 0.09, 0.02, 1.0, held, 3.0)
    assert not edges.bistable
    assert replace(edges, transition=Edge(0.03, 0.02, 0.04)).bistable
    assert [replace(edges, limit=limit).starts for limit in (2.0, 1.9, 0.5, 0.4)] == [True, None, None, False]


def test_edges_are_quantiles_of_the_draws(found: Behaviour) -> None:
    edges = found.posterior.edges(HOT)
    said = edges_of(found.posterior, HOT)
    for edge, draws in ((said.fold, edges.fold), (said.transition, edges.transition)):
        assert edge.value == np.quantile(draws, 0.5, method="higher")
        assert edge.low == np.quantile(draws, 0.025, method="higher")
        assert edge.high == np.quantile(draws, 0.975, method="higher")
    assert said.safe == said.fold.high
    radius = found.posterior.model.machine.roll_radius
    assert said.holding.value == pytest.approx(radius * np.quantile(edges.holding, 0.5, method="higher"))
    assert said.greatest == 0.4


def test_what_the_drive_cannot_slide_at_stalls(decide: Decide, found: Behaviour, map_: OperatingMap) -> None:
    """So fast that sliding takes more than the start."""
    fast, model = 100.0, found.posterior.model
    limit = 1.05 * float(np.max(found.posterior.edges(HOT).holding)) * model.machine.roll_radius
    machine = replace(model.machine, limits=Limits(motor_torque=limit))
    drawn = replace(found.posterior, model=replace(model, machine=machine))
    point = PointBehaviour(OperatingPoint("fast", fast, HOT), judge(drawn, HOT, fast))
    weak = replace(map_, torque_limit=limit, limited_by="motor torque", speed_limit=None)
    [said] = decide(replace(found, posterior=drawn, points=(point,), map=weak)).points
    assert (said.signal, said.verdict) == ("act", "stalls")
    assert said.words.startswith("stalls: sliding takes ")
    assert "the motor gives" in said.words


def test_a_point_far_out_is_not_good(decide: Decide, found: Behaviour) -> None:
    """No dwell lies that fast: said at the point."""
    point = PointBehaviour(OperatingPoint("very fast", 0.38, HOT), judge(found.posterior, HOT, 0.38))
    said = decide(replace(found, points=(point,)))
    assert said.points[0].signal == "watch"
    assert said.points[0].words.endswith("; extrapolated")


def test_warnings_of_the_machine(decide: Decide, found: Behaviour, map_: OperatingMap) -> None:
    """Points that no dwell reaches, and a roll whose grip nobody stated."""
    bare = replace(map_, train=replace(map_.train, grip=None))
    far = tuple(replace(p, at=replace(p.at, extrapolated=p.name == "crawl")) for p in map_.points)
    titles = {f.title: f.text for f in decide(replace(found, points=(), map=replace(bare, points=far))).flags}
    assert titles["Operating points are extrapolated"].startswith(
        "The dwells do not reach crawl: they range from "
    )
    assert titles["The roll may slip at the start"].startswith("The grip of the roll is not stated")
    gripping = replace(map_, train=replace(map_.train, grip=1e6))
    assert "The roll may slip at the start" not in {
        flag.title for flag in decide(replace(found, points=(), map=gripping)).flags
    }


@pytest.mark.parametrize(
    ("rises", "falls", "said"),
    [
        (True, False, "Measure dwells slower than 9.5 rpm: torque rises with speed down to there"),
        (False, True, "Measure faster dwells: torque falls as speed rises, from 9.5 to "),
        (True, True, "Torque is lowest near 19 rpm, and below that rises as the drive slows"),
        (False, False, "Record dwells slower than 9.5 and faster than "),
    ],
)
def test_words_follow_what_the_dwells_show(
    points: hersey.SteadyPoints, surface: DampingSurface, seen: Regime, rises: bool, falls: bool, said: str
) -> None:
    straight = replace(surface, transition=None, speed_range=(1.0, 14.0))
    found = of_log(Findings(points=points, surface=straight, regime=seen), Trend(rises, falls, 2.0, 0.013))
    assert found.instruction.startswith(said)
    assert found.signal == "watch"
    if not rises and not falls:
        assert found.instruction.endswith("torque varies about its mean by up to 1.3 %")
        level = replace(straight, c=replace(straight.c, low=-1.2, high=-0.5))
        known = Findings(points=points, surface=level, regime=seen)
        assert of_log(known, Trend(False, False, 2.0, 0.013)).instruction.endswith(
            "torque is constant within 1.3 %"
        )


def test_an_interval_of_the_transition_that_is_not_told_gives_no_speed(
    points: hersey.SteadyPoints, surface: DampingSurface, seen: Regime, monkeypatch: pytest.MonkeyPatch
) -> None:
    open_ended = Estimate(1.0, 0.1, -math.inf, math.inf)
    monkeypatch.setattr(DampingSurface, "transition_estimate", lambda *_: open_ended)
    said = of_log(Findings(points=points, surface=surface, regime=seen), Trend(True, True, 1.0, 0.1))
    assert "torque is lowest at 9.5 rpm, interval not known" in said.instruction
    assert "Keep the speed well above 9.5 rpm" in said.otherwise


def test_warnings_of_the_log(points: hersey.SteadyPoints, surface: DampingSurface, seen: Regime) -> None:
    """Few dwells, loads that differ, scatter, a regime that is not told: each where it is, and only there."""

    def told(
        dwells: hersey.SteadyPoints = points, fit: DampingSurface = surface, **of: str
    ) -> dict[str, str]:
        log = replace(seen, **of)
        return {flag.title: flag.text for flag in flags(Findings(points=dwells, surface=fit, regime=log))}

    calm = told(named="soft EHL")
    titles = (
        "Few dwells support the falling branch",
        "The load varies",
        "The lubrication regime is not determined",
    )
    assert not {*titles, "Points scatter 6 % about the fit"} & calm.keys()
    noisy = replace(surface, statistics=replace(surface.statistics, scatter=0.06))
    shown = told(fit=noisy, named="soft EHL")
    assert shown["Points scatter 6 % about the fit"].startswith("More than sensor noise explains.")
    unnamed = replace(seen, named=None, why_unnamed="two explain it")
    known = Findings(points=points, surface=surface, regime=unnamed)
    [flag] = [f for f in flags(known) if f.where == "regime"]
    assert flag.title == "The lubrication regime is not determined"
    assert flag.text.startswith("Two explain it. A no-load torque brings the exponent closer to -1.")
    assert surface.transition is not None
    by_itself = replace(surface, transition=replace(surface.transition, freed=24.0))
    freed = "The transition is not at a fixed Hersey number"
    assert freed in told(fit=by_itself, named="soft EHL")
    assert freed not in calm
    loads = np.linspace(10.0, 20.0, len(points))
    loaded = replace(points, table=points.table.with_columns(load=pl.Series(loads)))
    assert (
        told(dwells=loaded, named="soft EHL")["The load varies"]
        == "It ranges from 10 to 20 N. Fit each load separately."
    )
    fast = points.table.filter(pl.col("speed").abs() > 1.2 * surface.transition_speed(HOT + 30.0))
    few = replace(points, table=pl.concat([points.table.filter(pl.col("speed").abs() < 0.6).head(2), fast]))
    text = told(dwells=few, named="soft EHL")["Few dwells support the falling branch"]
    assert text == f"Only 1 of {len(few)} dwells lie below the transition. Measure slower dwells."


@pytest.mark.parametrize(
    ("ratio", "told"),
    [((0.4, 0.8, 1.2), True), ((0.6, 1.0, 1.9), False), ((0.8, 1.5, 2.1), True)],
)
def test_torque_far_from_the_file_is_a_warning(
    decide: Decide, found: Behaviour, ratio: tuple[float, float, float], told: bool
) -> None:
    torque_budget = TorqueBudgetPart.model_construct(ratio=ratio)
    titles = {flag.title for flag in decide(replace(found, points=()), torque_budget=torque_budget).flags}
    assert ("Torque and machine file disagree" in titles) == told


def test_without_a_map_only_what_was_measured_is_judged(surface: DampingSurface, machine: Machine) -> None:
    """Speed and temperature of a point both within the log."""
    speed = 1.0 * machine.roll_radius
    states = {(speed, HOT): "keeps sliding", (speed, 600.0): "not judged", (99.0, HOT): "not judged"}
    points = tuple(OperatingPoint("any", *state) for state in states)
    said = points_of_log(surface, replace(machine, points=points), rises=True)
    assert [each.words.split(" once")[0].split(":")[0] for each in said] == list(states.values())
    assert {each.signal for each in said} == {"watch"}


def test_a_step_is_taken_between_points_of_one_temperature(
    points: hersey.SteadyPoints, surface: DampingSurface, machine: Machine
) -> None:
    states = (("slow", 0.06, HOT), ("fast", 0.12, HOT), ("cool", 0.12, HOT - 20.0))
    asked = tuple(OperatingPoint(*state) for state in states)
    found = Working(points, surface, replace(machine, points=asked), draws=80).result()
    stepped = [[step.from_speed for step in point.steps] for point in found.points]
    assert stepped == [[0.12], [0.06], []]


def test_the_gravest_warnings_come_first(
    points: hersey.SteadyPoints, surface: DampingSurface, seen: Regime
) -> None:
    fast = points.table.filter(pl.col("speed").abs() > 1.2 * surface.transition_speed(HOT + 30.0))
    few = pl.concat([points.table.filter(pl.col("speed").abs() < 0.6).head(2), fast])
    loaded = replace(points, table=few.with_columns(load=pl.Series(np.linspace(10.0, 20.0, few.height))))
    assert surface.transition is not None
    freed = replace(surface, transition=replace(surface.transition, freed=24.0))
    found = flags(Findings(points=loaded, surface=freed, regime=seen, why="no machine"))
    assert len(found) == MOST
    assert [each.severity for each in found] == ["act", "watch", "watch"]
    assert found[0].kind == "no band"


def test_what_is_said_of_a_file_names_it(points: hersey.SteadyPoints, surface: DampingSurface) -> None:
    file = replace(points.log.files[0], warnings=(Warning("noted", "something"),))
    log = replace(points.log, files=(file, *points.log.files[1:]))
    (noted,) = (w for w in warnings_of(replace(points, log=log), surface) if w.kind == "noted")
    assert noted.where == file.name
