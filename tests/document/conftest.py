"""A machine on the stand's log, its map with few draws, and what is decided of both."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import hersey
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.damping.surface import DampingSurface
from hersey.decision.behaviour import Behaviour, Working
from hersey.decision.judge import judge
from hersey.machine.limits import Limits, OperatingPoint
from hersey.machine.machine import Machine, read_machine
from hersey.stability.operating_map import OperatingMap
from hersey.study.findings import Findings
from hersey.study.first_screen.decision import decision
from hersey.study.first_screen.result import DecisionPart
from hersey.study.nip_film import FilmPart
from hersey.study.torque_budget import TorqueBudgetPart
from hersey.verdict.regime import Regime, regime
from tests.conftest import ROOT

HOT = 453.15
ROOMY = Limits(motor_torque=8.0, acceleration=0.5, speed=0.4)
SLOW, BETWEEN, FAST = 0.02, 0.045, 0.36


@pytest.fixture(scope="module")
def seen(points: hersey.SteadyPoints, surface: DampingSurface) -> Regime:
    return regime(points, surface)


def _machine() -> Machine:
    states = [OperatingPoint(name, speed, HOT) for name, speed in POINTS.items()]
    stated = read_machine(ROOT / "tests" / "stand" / "machine.toml")
    return replace(stated, limits=ROOMY, points=tuple(states))


@pytest.fixture(scope="module")
def machine() -> Machine:
    return _machine()


POINTS = {"crawl": SLOW, "thick paper": BETWEEN, "near": 0.1, "full speed": FAST}


@pytest.fixture(scope="session")
def found(points: hersey.SteadyPoints, surface: DampingSurface) -> Behaviour:
    """What the machine of the stand does, of few draws."""
    known = replace(points, rest=NoLoadTorque.stated(constant=1e-9))
    return Working(known, replace(surface, rest=None), _machine(), draws=240).result()


@pytest.fixture(scope="session")
def map_(found: Behaviour) -> OperatingMap:
    assert found.map is not None
    return found.map


def with_draws(found: Behaviour, **draws: object) -> Behaviour:
    """The same with other draws of the edges at the temperature of the decision; a number is that of all."""
    edges = found.posterior.edges(HOT)
    size = edges.fold.size
    changed = replace(edges, **{name: np.broadcast_to(value, size) * 1 for name, value in draws.items()})  # type: ignore[arg-type]
    drawn = replace(found.posterior)
    drawn._edges[HOT, len(drawn.drives)] = changed
    points = tuple(replace(p, verdict=judge(drawn, HOT, p.point.speed)) for p in found.points)
    return replace(found, posterior=drawn, points=points)


Decide = Callable[..., DecisionPart]


@pytest.fixture(scope="module")
def decide(points: hersey.SteadyPoints, surface: DampingSurface, seen: Regime, machine: Machine) -> Decide:
    known = replace(points, rest=NoLoadTorque.stated(constant=1e-9))

    def decided(
        found: Behaviour,
        film: FilmPart | None = None,
        unit: str = "",
        dwells: hersey.SteadyPoints = known,
        surface: DampingSurface = surface,
        torque_budget: TorqueBudgetPart | None = None,
        **changed: object,
    ) -> DecisionPart:
        of = replace(machine, **changed)  # type: ignore[arg-type]
        findings = Findings(
            points=dwells,
            surface=surface,
            machine=of,
            regime=seen,
            nip=film,
            torque_budget=torque_budget,
            behaviour=found,
        )
        if unit:
            vars(findings)["units"] = findings.units | {"torque": unit}
        return decision(findings)

    return decided
