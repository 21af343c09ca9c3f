"""A machine on the stand's log, its map with few draws, and what is decided of both."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

import hersey
from hersey.damping.rest import RestOfDrive
from hersey.damping.surface import DampingSurface
from hersey.document.decision import decision
from hersey.document.decision.behaviour import Behaviour, PointBehaviour
from hersey.document.parts import CarriedPart, DecisionPart, FilmPart, RegimePart
from hersey.machine.limits import Limits, OperatingPoint
from hersey.machine.machine import Machine, read_machine
from hersey.stability.hysteresis import hysteresis
from hersey.stability.operating_map import OperatingMap, operating_map
from hersey.stability.plan import plan_profile
from hersey.verdict.regime import regime
from tests.conftest import ROOT

HOT = 453.15
ROOMY = Limits(motor_torque=8.0, acceleration=0.5, speed=0.4)
SLOW, BETWEEN, FAST = 0.02, 0.045, 0.12


@pytest.fixture(scope="module")
def seen(points: hersey.SteadyPoints, surface: DampingSurface) -> RegimePart:
    return RegimePart.model_validate(regime(points, surface).to_dict())


@pytest.fixture(scope="module")
def machine() -> Machine:
    states = [OperatingPoint(name, speed, HOT) for name, speed in POINTS.items()]
    stated = read_machine(ROOT / "tests" / "stand" / "machine.toml")
    return replace(stated, limits=ROOMY, points=tuple(states))


POINTS = {"crawl": SLOW, "thick paper": BETWEEN, "near": 0.07, "full speed": FAST}


@pytest.fixture(scope="module")
def map_(surface: DampingSurface, machine: Machine) -> OperatingMap:
    return operating_map(
        surface,
        machine.train,
        **machine.belt,
        limits=machine.limits,
        points=machine.points,
        uncertainty=machine.uncertainty,
        temperatures=[HOT - 10.0, HOT],
        draws=40,
    )


@pytest.fixture(scope="module")
def found(surface: DampingSurface, machine: Machine, map_: OperatingMap) -> Behaviour:
    """What the machine does, its plan that of the nominal parameters."""
    drag = surface.drag(**machine.belt, temperature=HOT)
    plan = plan_profile(
        machine.train, drag, target_speed=BETWEEN, limits=machine.limits, roll_radius=machine.roll_radius
    )
    planned = {"plan": plan, "straight": plan.response}
    of_points = [PointBehaviour(p, **(planned if p.speed == BETWEEN else {})) for p in machine.points]
    band = hysteresis(machine.train, drag)
    return Behaviour(HOT, band, None, map_, tuple(of_points), ())


Decide = Callable[..., DecisionPart]


@pytest.fixture(scope="module")
def decide(
    points: hersey.SteadyPoints, surface: DampingSurface, seen: RegimePart, machine: Machine
) -> Decide:
    known = replace(points, rest=RestOfDrive.stated(constant=1e-9))

    def decided(
        found: Behaviour,
        film: FilmPart | None = None,
        unit: str = "N·m",
        dwells: hersey.SteadyPoints = known,
        surface: DampingSurface = surface,
        carried: CarriedPart | None = None,
        **changed: object,
    ) -> DecisionPart:
        of = replace(machine, **changed)  # type: ignore[arg-type]
        return decision(dwells, surface, of, seen=seen, film=film, carried=carried, found=found, unit=unit)

    return decided
