"""What the machine of a log does: its map, what its operating points bear, and how to get to them."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np

from hersey.damping.surface import DampingSurface
from hersey.document.decision.reasons import in_words
from hersey.errors import HerseyError
from hersey.machine.limits import OperatingPoint
from hersey.machine.machine import Machine
from hersey.motion.schedule import Schedule
from hersey.motion.simulation import Trajectory, simulate
from hersey.stability.disturbance import Disturbance, SafeStep, disturbance, safe_step
from hersey.stability.hysteresis import HysteresisBand, hysteresis
from hersey.stability.hysteresis_sweep import sweep_bands
from hersey.stability.operating_map import OperatingMap, operating_map
from hersey.stability.plan import Plan, plan_of_log

#: Stick speeds of the curve of V*, and how far it reaches where no range is stated.
_STICK_SPEEDS, _REACH = 17, 3.0
#: The curve goes to this share of the transition speed at the most.
_BELOW = 0.9
#: Temperatures that are alike, K: points at them can be stepped between.
_ALIKE = 1.0
#: Samples of a start that is drawn.
_SAMPLES = 601

_T = TypeVar("_T")
#: Called with the name of the step that is being worked on.
Step = Callable[[str], None]


@dataclass(frozen=True)
class PointBehaviour:
    """An operating point: what sliding there bears, how to come from other points, how to start."""

    point: OperatingPoint
    disturbance: Disturbance | None = None
    steps: tuple[SafeStep, ...] = ()
    plan: Plan | None = None
    straight: Trajectory | None = None  #: straight up to the point, beside the plan
    stiction: float | None = None  #: V* (m/s) there of a belt that stops dead, None where it does not start
    reason: str = ""  #: why something of it is missing


@dataclass(frozen=True)
class StickSpeeds:
    """V* against the stick speed at the temperature of a band: speeds in m/s.

    ``stiction`` is V* of a belt that stops dead, at the stick speed stated; None where it does not start.
    """

    stated: float
    known: tuple[float, float] | None
    stick_speed: list[float]
    transition: list[float]
    upper: list[float]
    stiction: float | None = None


@dataclass(frozen=True)
class Behaviour:
    """What a machine does; parts that cannot be computed are None, with the reason.

    ``temperature`` (K; None for an isothermal fit) is that of the decision: the one of the operating points,
    or of the ends of the log, at which stick-slip reaches to the greatest speed; ``band`` holds there.
    """

    temperature: float | None
    band: HysteresisBand
    stick_speeds: StickSpeeds | None
    map: OperatingMap | None
    points: tuple[PointBehaviour, ...]
    reasons: tuple[str, ...]


class Working:
    """The behaviour of a machine while it is worked out, beside whatever else the caller does."""

    def __init__(self, surface: DampingSurface, machine: Machine) -> None:
        """Begin, in threads: the core computes without Python's lock."""
        self._surface, self._machine = surface, machine
        self._kelvins = _kelvins(surface, machine)
        self._pool = ThreadPoolExecutor(max(2, os.cpu_count() or 1))
        self._plans = [self._begin(self._planned, point) for point in machine.points]
        self._map = self._begin(self._mapped)
        self._rest = self._begin(self._at_the_band)
        self._points = [self._begin(self._borne, point) for point in machine.points]

    def __enter__(self) -> Working:
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Begin nothing more: what has begun goes on in its thread, and is not waited for."""
        self._pool.shutdown(wait=False, cancel_futures=True)

    def result(self, step: Step = lambda _what: None) -> Behaviour:
        """Return it when it is done.

        Raises
        ------
        HerseyError
            If not even a band can be computed.
        """
        temperature, band, stick = self._rest.result()
        step("finding the bands")
        map_: OperatingMap | None
        map_, why = _done(self._map)
        points = []
        for point, borne, planned in zip(self._machine.points, self._points, self._plans, strict=True):
            step(f"planning {point.name}")
            of_plan, no_plan = _done(planned)
            plan, straight = of_plan if of_plan is not None else (None, None)
            of_point, no_figure = _done(borne)
            bears, steps, stiction = of_point if of_point is not None else (None, (), None)
            reason = "; ".join(filter(None, (no_plan, no_figure)))
            points.append(PointBehaviour(point, bears, steps, plan, straight, stiction, reason))
        return Behaviour(temperature, band, stick, map_, tuple(points), (f"no map: {why}",) if why else ())

    def _begin(self, work: Callable[..., _T], *given: object) -> Future[_T]:
        return self._pool.submit(work, *given)

    def _mapped(self) -> OperatingMap:
        machine = self._machine
        return operating_map(
            self._surface,
            machine.train,
            **machine.belt,
            limits=machine.limits,
            points=machine.points,
            uncertainty=machine.uncertainty,
            threads=os.cpu_count() or 1,
        )

    def _band(self, kelvin: float | None, *, sensitivity: bool | None = False) -> HysteresisBand:
        drag = self._surface.drag(**self._machine.belt, temperature=kelvin)
        return hysteresis(self._machine.train, drag, sensitivity=sensitivity)

    def _at_the_band(self) -> tuple[float | None, HysteresisBand, StickSpeeds]:
        bands = [(self._band(kelvin), kelvin) for kelvin in self._kelvins]
        _, kelvin = max(bands, key=lambda each: (each[0].upper, each[0].transition))
        return kelvin, self._band(kelvin, sensitivity=None), self._against_stick_speed(kelvin)

    def _against_stick_speed(self, kelvin: float | None) -> StickSpeeds:
        machine = self._machine
        drag = self._surface.drag(**machine.belt, temperature=kelvin)
        moved = drag.stick_speed / machine.stick_speed
        stated = ranges(machine).get("stick_speed")
        known = None if stated is None else (stated[0] * moved, stated[1] * moved)
        ends = known or (drag.stick_speed / _REACH, drag.stick_speed * _REACH)
        low = min(ends[0], 0.5 * drag.stick_speed)
        high = min(max(ends[1], 2.0 * drag.stick_speed), _BELOW * drag.transition_speed)
        grid = np.unique(np.append(np.geomspace(low, max(high, drag.stick_speed), _STICK_SPEEDS), ends))
        grid = grid[grid < drag.transition_speed]
        bands = sweep_bands(
            machine.train, drag, {"stick_speed": grid}, lower=False, threads=os.cpu_count() or 1
        )
        edges = [bands.columns[name] for name in ("transition", "upper")]
        # a belt that is not started has no V*
        upper = np.where(bands.columns["stalls"], np.nan, np.maximum(*edges))
        curve = grid.tolist(), edges[0].tolist(), upper.tolist()
        return StickSpeeds(drag.stick_speed, known, *curve, self._stopping(kelvin))

    def _stopping(self, kelvin: float | None) -> float | None:
        """V* of a belt that stops dead below the stick speed, where nobody knows how it comes to rest."""
        drag = self._surface.drag(**self._machine.belt, temperature=kelvin)
        band = hysteresis(self._machine.train, replace(drag, closure="stiction"), sensitivity=False)
        return None if band.stalls else max(band.upper, band.transition)

    def _at(self, point: OperatingPoint) -> float | None:
        return None if self._surface.b is None else point.temperature

    def _planned(self, point: OperatingPoint) -> tuple[Plan | None, Trajectory | None]:
        """The plan of a point at which the past decides, and the motion straight up beside it."""
        kelvin, machine = self._at(point), self._machine
        drag = self._surface.drag(**machine.belt, temperature=kelvin)
        band = hysteresis(machine.train, drag, sensitivity=False)
        if not (band.transition <= point.speed < band.upper and _starts(machine, drag.holding_force)):
            return None, None
        plan = plan_of_log(self._surface, machine, target_speed=point.speed, temperature=kelvin)
        if plan.response is None:
            return plan, None
        rise = point.speed / machine.limits.acceleration if machine.limits.acceleration else 0.0
        straight = simulate(
            machine.train,
            drag,
            drive_speed=Schedule([0.0, rise], [0.0, point.speed]) if rise else point.speed,
            duration=float(plan.response.time[-1]),
            samples=_SAMPLES,
        )
        return plan, straight

    def _borne(self, point: OperatingPoint) -> tuple[Disturbance | None, tuple[SafeStep, ...], float | None]:
        """What sliding at a point bears, how to come there from others, and V* of a belt that stops dead."""
        kelvin, machine = self._at(point), self._machine
        drag = self._surface.drag(**machine.belt, temperature=kelvin)
        turn = drag.transition_speed
        if point.speed < turn:
            return None, (), None
        others = [
            other.speed
            for other in machine.points
            if other.speed >= turn
            and other.speed != point.speed
            and (kelvin is None or abs(other.temperature - point.temperature) < _ALIKE)
        ]
        steps = [
            safe_step(machine.train, drag, from_speed=speed, to_speed=point.speed)
            for speed in dict.fromkeys(others)
        ]
        bears = disturbance(machine.train, drag, drive_speed=point.speed)
        return bears, tuple(steps), self._stopping(kelvin)


def ranges(machine: Machine) -> dict[str, tuple[float, float]]:
    """Return the 95 % ranges (SI) of stiffness, mass and stick speed that the machine's file states."""
    found = {}
    for name, known in machine.uncertainty.items():
        if name in ("stiffness", "mass", "stick_speed"):
            value = float(getattr(machine, name))
            factor = 1.0 + (known.share or 0.0)
            found[name] = known.limits or (value / factor, value * factor)
    return found


def _kelvins(surface: DampingSurface, machine: Machine) -> list[float | None]:
    """Temperatures (K) that the decision may be of."""
    if surface.b is None or surface.temperature_range is None:
        return [None]
    return list(
        dict.fromkeys(point.temperature for point in machine.points)
        or dict.fromkeys(surface.temperature_range)
    )


def _starts(machine: Machine, holding: float) -> bool:
    force = machine.limits.force(machine.roll_radius)
    return force is None or holding <= force[1]


def _done(work: Future[Any]) -> tuple[Any, str]:
    """What came of a piece of work, or why nothing did."""
    try:
        return work.result(), ""
    except HerseyError as error:
        return None, in_words(error)
