"""What the machine of a log does: its posterior, its map, and its operating points."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Annotated, Any, TypeVar

import numpy as np

from hersey.cache.kept import kept
from hersey.damping.curves import CurveMixture
from hersey.damping.dwells import SteadyPoints
from hersey.damping.surface import DampingSurface
from hersey.decision.judge import Unjudged, Verdict, judge, meaningless
from hersey.decision.mapping import map_of
from hersey.decision.measurement import Measurement, next_measurement
from hersey.decision.start_up import plan_start_up, response
from hersey.errors import HerseyError
from hersey.log import TorqueLog
from hersey.machine.limits import OperatingPoint
from hersey.machine.machine import Machine
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import DragTable
from hersey.motion.schedule import Schedule
from hersey.motion.trajectory import Trajectory
from hersey.posterior import Posterior, posterior
from hersey.posterior.drives import Drives
from hersey.posterior.priors import CLOSURES, NUMBERS
from hersey.posterior.result import SAFE
from hersey.posterior.sampling import DRAWS
from hersey.posterior.typical import typical_drag, typical_draw
from hersey.result import Means, Record
from hersey.stability.disturbance import Disturbance, SafeStep, disturbance_within, step_within
from hersey.stability.hysteresis import HysteresisBand, hysteresis
from hersey.stability.operating_map import OperatingMap
from hersey.stability.plan import Plan

#: Stick speeds of the curve of V*, and how far it reaches where no range is stated.
_STICK_SPEEDS = 17
#: The curve goes to this share of the transition speed at the most.
_BELOW = 0.9
#: Temperatures that are the same, K: points at them can be stepped between.
_ALIKE = 1.0
#: Factor by which a number is moved for the sensitivity of V*, and the accuracy of the folds then: V* is
#: known to 1e-4 at best, and a factor nearer to 1 would show its error.
_STEP, _FINE = 1.1, 1e-6

_T = TypeVar("_T")
#: Called with the name of the step that is being worked on.
Step = Callable[[str], None]


@dataclass(frozen=True)
class PointBehaviour:
    """An operating point: verdict, what sliding there withstands, steps from others, start-up."""

    point: OperatingPoint
    verdict: Verdict
    disturbance: Disturbance | None = None
    steps: tuple[SafeStep, ...] = ()
    plan: Plan | None = None
    straight: Trajectory | None = None  #: straight up to the point, beside the plan
    errors: tuple[HerseyError, ...] = ()  #: why something of it is missing


@dataclass(frozen=True)
class StickSpeeds(Record):
    """V* against the stick speed at the temperature of a band: speeds in m/s, other numbers typical.

    ``stiction`` is V* of a belt that stops abruptly, at the stick speed stated; None where it does not start.
    """

    temperature: Annotated[float | None, Means("null if isothermal", "K")]
    stated: Annotated[float, Means("stick speed in the machine file, at this temperature", "m/s")]
    known: Annotated[
        tuple[float, float] | None, Means("its 95 % range in the machine file, at this temperature", "m/s")
    ]
    stick_speed: Annotated[list[float], Means(unit="m/s")]
    transition: Annotated[list[float], Means(unit="m/s")]
    upper: Annotated[list[float], Means("V*; null outside the search range", "m/s", open=True)]
    stiction: Annotated[float | None, Means("V* at the stated stick speed if it stops abruptly", "m/s")] = (
        None
    )


@dataclass(frozen=True)
class Behaviour:
    """What a machine does; parts that cannot be computed are None, with the reason.

    ``temperature`` (K; None for an isothermal fit) is that of the decision; ``band`` holds there, of the
    typical draw of the posterior.
    """

    temperature: float | None
    posterior: Posterior
    band: HysteresisBand | None
    stick_speeds: StickSpeeds | None
    map: OperatingMap | None
    points: tuple[PointBehaviour, ...]
    measurement: Measurement | None
    no_band: tuple[HerseyError, ...]
    no_map: tuple[HerseyError, ...]
    unjudged: tuple[Unjudged, ...] = ()


class Working:
    """The behaviour of a machine while it is worked out, beside whatever else the caller does."""

    def __init__(
        self,
        points: SteadyPoints,
        surface: DampingSurface,
        machine: Machine,
        traces: Sequence[TorqueLog] = (),
        curves: CurveMixture | None = None,
        draws: int = DRAWS,
    ) -> None:
        """Begin, in threads: the core computes without Python's lock."""
        self._unjudged = meaningless(surface, machine)
        without = [each.point for each in self._unjudged]
        machine = replace(machine, points=tuple(p for p in machine.points if p not in without))
        self._points, self._surface, self._curves = points, surface, curves
        self._machine, self._traces, self._draws = machine, traces, draws
        # each piece waits for the posterior in its own thread
        self._pool = ThreadPoolExecutor(len(machine.points) + 5)
        self._posterior = self._begin(self._drawn)
        self._typical = self._begin(lambda: _typical_band(self._posterior.result()))
        self._judged = [self._begin(self._of_point, point) for point in machine.points]
        self._map = self._begin(self._mapped)
        self._band = self._begin(
            lambda: _at_the_band(self._posterior.result(), machine, self._typical.result)
        )
        self._next = self._begin(lambda: next_measurement(self._posterior.result()))

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
            If not even a posterior can be computed.
        """
        step("drawing from the posterior")
        found = self._posterior.result()
        step("computing V* and the bands")
        bands, no_band = _done(self._band)
        band, stick = bands or (None, None)
        map_, no_map = _done(self._map)
        points, unjudged = list[PointBehaviour](), list(self._unjudged)
        for point, future in zip(self._machine.points, self._judged, strict=True):
            step(f"planning {point.name}")
            behaviour, not_judged = _done(future)
            points += [behaviour] if behaviour is not None else []
            unjudged += [Unjudged(point, error) for error in not_judged]
        measurement, _ = _done(self._next)
        return Behaviour(
            found.temperature,
            found,
            band,
            stick,
            map_,
            tuple(points),
            measurement,
            no_band,
            no_map,
            tuple(unjudged),
        )

    def _begin(self, work: Callable[..., _T], *given: object) -> Future[_T]:
        return self._pool.submit(work, *given)

    def _drawn(self) -> Posterior:
        return posterior(
            self._points,
            self._machine,
            surface=self._surface,
            curves=self._curves,
            traces=self._traces,
            draws=self._draws,
            threads=os.cpu_count() or 1,
        )

    def _mapped(self) -> OperatingMap:
        found = [_done(each)[0] for each in self._judged]
        kinds = [each.verdict.kind if each is not None else None for each in found]
        return map_of(self._posterior.result(), judged=kinds, threads=os.cpu_count() or 1)

    def _at(self, point: OperatingPoint) -> float | None:
        return None if self._surface.b is None else point.temperature

    def _of_point(self, point: OperatingPoint) -> PointBehaviour:
        found, kelvin = self._posterior.result(), self._at(point)
        verdict = judge(found, kelvin, point.speed)
        plan, straight, errors = None, None, list[HerseyError]()
        try:
            known = verdict.probability.unknown <= 1.0 - SAFE
            if verdict.kind in ("depends", "unknown") and known:
                plan, straight = self._planned(found, kelvin, point.speed)
        except HerseyError as error:
            errors.append(error)
        try:
            same = self._typical.result if kelvin == found.temperature else None
            withstands, steps = _withstood(found, kelvin, point, self._machine.points, same)
        except HerseyError as error:
            withstands, steps = None, ()
            errors.append(error)
        return PointBehaviour(point, verdict, withstands, steps, plan, straight, tuple(errors))

    def _planned(
        self, found: Posterior, kelvin: float | None, speed: float
    ) -> tuple[Plan, Trajectory | None]:
        """The start-up profile to a point, and the motion straight up beside it."""
        plan = plan_start_up(found, kelvin, speed)
        if plan.response is None:
            return plan, None
        acceleration = self._machine.limits.acceleration
        rise = speed / acceleration if acceleration else 0.0
        drive: Schedule | float = Schedule([0.0, rise], [0.0, speed]) if rise else speed
        return plan, response(found, kelvin, drive, float(plan.response.time[-1]))


@kept(apart=("known",))
def _withstood(
    found: Posterior,
    kelvin: float | None,
    point: OperatingPoint,
    points: tuple[OperatingPoint, ...],
    known: Callable[[], HysteresisBand] | None = None,
) -> tuple[Disturbance | None, tuple[SafeStep, ...]]:
    """What sliding at a point withstands, and how to come there from others, of the typical draw.

    ``known`` tells its band where somebody computes it anyway.
    """
    train, drag = typical_drag(found, kelvin)
    turn = float(np.median(found.edges(kelvin).transition))
    if point.speed < turn:
        return None, ()
    others = [
        other.speed
        for other in points
        if other.speed >= turn
        and other.speed != point.speed
        and (kelvin is None or abs(other.temperature - point.temperature) < _ALIKE)
    ]
    band = hysteresis(train, drag, sensitivity=False) if known is None else known()
    steps = [
        step_within(band, train, drag, from_speed=speed, to_speed=point.speed)
        for speed in dict.fromkeys(others)
        if speed >= drag.law_at(None).transition_speed
    ]
    return disturbance_within(band, train, drag, drive_speed=point.speed), tuple(steps)


@kept()
def _typical_band(found: Posterior) -> HysteresisBand:
    train, drag = typical_drag(found, found.temperature)
    return hysteresis(train, drag, sensitivity=False)


@kept(apart=("known",))
def _at_the_band(
    found: Posterior, machine: Machine, known: Callable[[], HysteresisBand]
) -> tuple[HysteresisBand, StickSpeeds]:
    band = known()
    value, low, high = found.fold_interval(found.temperature)
    band = replace(band, upper=value, interval=(low, high), sensitivity=_sensitivity(found))
    return band, _against_stick_speed(found, machine)


def _typical(found: Posterior, kelvin: float | None, count: int) -> Drives:
    """The typical draw, so many times."""
    return typical_draw(found, kelvin).take(np.zeros(count, dtype=np.intp))


def _sensitivity(found: Posterior) -> dict[str, float]:
    """Relative change of V* per relative change of stiffness, mass and stick speed, of the typical draw."""
    names, kelvin = NUMBERS[:3], found.temperature
    factors = np.ones((2 * len(names), len(names)))
    for i in range(len(names)):
        factors[2 * i, i], factors[2 * i + 1, i] = _STEP, 1.0 / _STEP
    drives = _typical(found, kelvin, len(factors))
    fold = np.log(found.model.folds(drives, kelvin, accuracy=_FINE, factors=factors).upper)
    slopes = (fold[::2] - fold[1::2]) / (2.0 * np.log(_STEP))
    return {name: float(slope) for name, slope in zip(names, slopes, strict=True) if np.isfinite(slope)}


def _against_stick_speed(found: Posterior, machine: Machine) -> StickSpeeds:
    """V* of the typical draw over the range of the stick speed."""
    kelvin = found.temperature
    low, high = found.model.priors.range_of("stick_speed")
    drives = _typical(found, kelvin, _STICK_SPEEDS + 1)
    grid = np.geomspace(0.7 * low, 1.4 * high, _STICK_SPEEDS)
    # those of the grid at the temperature of the band; the last is as stated, for a belt that stops abruptly
    shift = found.model.stick_speed(drives, kelvin) / found.model.numbers(drives)[:, 0]
    speeds = np.append(grid, machine.stick_speed) * shift
    closure = np.append(drives.closure[:-1], list(CLOSURES).index("stiction")).astype(np.intp)
    folds = found.model.folds(Drives(drives.law, closure, drives.latent), kelvin, stick_speed=speeds)
    within = speeds[:-1] < _BELOW * folds.transition[:-1]
    if not within.any():  # drag rises from the stick speed on, wherever that is
        within[:] = True
    starts = ~folds.stalls.astype(bool)
    upper = np.where(starts, folds.upper, np.nan)
    stated = machine.uncertainty.get("stick_speed")
    return StickSpeeds(
        kelvin,
        float(speeds[-1]),
        None if stated is None else (low * float(shift[0]), high * float(shift[0])),
        speeds[:-1][within].tolist(),
        folds.transition[:-1][within].tolist(),
        upper[:-1][within].tolist(),
        float(folds.upper[-1]) if starts[-1] else None,
    )


def ranges(machine: Machine) -> dict[str, tuple[float, float]]:
    """Return the 95 % ranges (SI) of stiffness, mass and stick speed that the machine file states."""
    found = {}
    for name, known in machine.uncertainty.items():
        if name in ("stiffness", "mass", "stick_speed"):
            value = float(getattr(machine, name))
            factor = 1.0 + (known.share or 0.0)
            found[name] = known.limits or (value / factor, value * factor)
    return found


def _done(work: Future[Any]) -> tuple[Any, tuple[HerseyError, ...]]:
    """What came of a piece of work, or why nothing did."""
    try:
        return work.result(), ()
    except HerseyError as error:
        return None, (error,)


def typical(found: Behaviour) -> tuple[Drivetrain, DragTable]:
    """Return the typical drive at the temperature of the decision."""
    return typical_drag(found.posterior, found.temperature)
