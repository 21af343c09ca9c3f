"""From what is asked and known to a plan: search, proof on draws not seen before, or what forbids it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hersey.errors import ParameterError
from hersey.machine.limits import Limits
from hersey.machine.machine import Machine
from hersey.motion.belt import BeltDrag, Drivetrain, Train, belt_of
from hersey.motion.drag import AnyDrag
from hersey.motion.heat import HeatBalance
from hersey.motion.schedule import Schedule
from hersey.motion.simulation import simulate
from hersey.schema.warning import Warning
from hersey.stability.hysteresis import hysteresis
from hersey.stability.plan.draws import most_failures
from hersey.stability.plan.grid import Room
from hersey.stability.plan.obstacles import Obstacle, Reach, obstacles
from hersey.stability.plan.proof import LEAST_GIVEN, LEVEL, Proof, Unknown
from hersey.stability.plan.result import CONFIDENCES, NOTHING, LimitUse, Plan
from hersey.stability.plan.search import Progress, Search
from hersey.stability.plan.trial import FORCE, MachineSample, Shape, TemperatureProfile, rounded
from hersey.stability.plan.warming import ALIKE, ROUNDS, apart, course_of
from hersey.units import takes_si

#: Profiles verified before giving up; after each the search takes the draws it failed on.
_VERIFIED = 5
#: Share of the failures that a verification lets pass which the search allows after one, two...
_STRICTER = (0.8, 0.8, 0.7, 0.5)
#: Peak speeds are sought up to this many fold speeds if the drive has no limit.
_FOLDS = 3.0
#: And up to this many transition speeds.
_TRANSITIONS = 20.0
#: Samples of the response.
_SAMPLES = 2001
_CLOSURES = ("retained", "stiction")
#: What is known without draws.
NO_SAMPLES: Mapping[str, ArrayLike] = MappingProxyType({})


@takes_si(target_speed="belt speed", temperature="temperature")
def plan_profile(
    train: Train,
    drag: BeltDrag,
    *,
    target_speed: float,
    temperature: float | Schedule | HeatBalance | None = None,
    samples: Mapping[str, ArrayLike] | Sequence[tuple[Drivetrain, AnyDrag]] = NO_SAMPLES,
    confidence: float = 0.95,
    seed: int = 1,
    progress: Progress | None = None,
) -> Plan:
    """Return the fastest profile of drive speed from rest that ends in steady sliding at the target.

    Parameters
    ----------
    train, drag
        A machine (`hersey.read_machine`, `hersey.Machine`) and its drag, or the surface fitted to its log.
        Its ``limits`` hold over the whole profile and after it: ``speed`` and ``acceleration`` of the drive,
        and the spring force of the simulated motion against ``spring_force``, ``motor_torque`` over
        ``roll_radius`` (the inertia of the drive itself is not in the model) and the roll's grip,
        ``roll_friction * nip_load``. No plan lets the roll slip on the belt. Its ``uncertainty`` is that of
        the parameters; without it the plan uses nominal values. A drivetrain has no uncertainty, and no
        limits except its grip.
    target_speed
        Target speed, m/s.
    temperature
        Temperature, K, or its profile from the moment at which the drive could start; needed if the drag
        depends on it. Or a `HeatBalance`: plan and temperature are then found by iteration, and the
        verification computes the temperature of every motion.
    samples
        Draws as arrays of equal length by parameter (`DampingSurface.drag_samples`), at the reference
        temperature if the drag depends on temperature. They override the uncertainty of the machine. Or at
        least 40 whole machines drawn at random: the search uses every other one, and the rest verify the
        result.
    confidence
        Required share of draws that are smooth and keep the limits, 0.5 to 0.999.
    seed
        Random seed, at least 0.
    progress
        Called with (done, total) of a stage; an exception ends the planning.

    Raises
    ------
    ParameterError
        If a value is out of range, with its name.
    UnfinishedError
        If a motion cannot be finished.

    Examples
    --------
    >>> from hersey import Drag
    >>> drag = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    >>> limits = Limits(speed=4, acceleration=10)
    >>> machine = Machine(1000, 1, roll_radius=0.02, stick_speed=0.01, limits=limits)
    >>> plan = plan_profile(machine, drag, target_speed=1.2)
    >>> plan.kind, plan.share
    ('overshoot', 1.0)
    """
    machine = train if isinstance(train, Machine) else None
    limits = Limits() if machine is None else machine.limits
    train, drag, temperature = belt_of(train, drag, temperature, target_speed=target_speed)
    _check(drag, target_speed, limits, confidence, seed)
    reach = Reach.of(limits, None if machine is None else machine.roll_radius, train.grip)
    gripping, train = train, replace(train, grip=None)  # the grip is a limit of force here
    uncertainty = {} if machine is None else dict(machine.uncertainty)
    if isinstance(samples, Mapping):
        unknown = Unknown(train, drag, uncertainty, dict(samples), seed)
    elif len(samples) >= LEAST_GIVEN:
        machines = [MachineSample(replace(each, grip=None), of) for each, of in samples]
        unknown = Unknown(train, drag, {}, {}, seed, machines)
    else:
        raise ParameterError(f"samples has too few machines. Give at least {LEAST_GIVEN}")
    asked = _Asked(unknown, gripping, target_speed, limits, reach, confidence, progress)
    if not isinstance(temperature, HeatBalance):
        return asked.on(TemperatureProfile(temperature))[0]
    heat = temperature
    course = course_of(train, drag, heat)
    for _ in range(ROUNDS):
        thermal = TemperatureProfile(course)
        plan, shape = asked.on(thermal)
        if plan.schedule is None or shape is None:
            return replace(plan, course=course)
        before, course = course, course_of(gripping, drag, heat, plan.schedule)
        if (off := apart(before, course)) < ALIKE:
            return asked.proven(plan, shape, TemperatureProfile(course, heat))
    text = f"plan and temperature do not agree after {ROUNDS} iterations; they differ by {off:.2g} K"
    return asked.without(plan, Obstacle("temperature", off, None, text), course)


@dataclass(frozen=True)
class _Asked:
    """What is asked of a plan, and of which machine."""

    unknown: Unknown
    gripping: Drivetrain
    target_speed: float
    limits: Limits
    reach: Reach
    confidence: float
    progress: Progress | None

    def on(self, thermal: TemperatureProfile) -> tuple[Plan, Shape | None]:
        """Return the plan over a profile of temperature, and its shape."""
        unknown, limits, reach, target = self.unknown, self.limits, self.reach, self.target_speed
        end = thermal.at(thermal.end)
        nominal = MachineSample(unknown.train, unknown.drag)
        nominal.at(end, target)  # refuses a temperature missing or not wanted
        band = hysteresis(unknown.train, unknown.drag, temperature=end, sensitivity=False)
        wide = max(_FOLDS * min(band.upper, _TRANSITIONS * band.transition), 2.0 * target)
        greatest = limits.speed or wide
        trials = unknown.trials(self.confidence, thermal, reach.force)
        room = Room(greatest, reach.acceleration)
        search = Search(nominal, trials, thermal, target, room, seed=unknown.seed, progress=self.progress)
        facts: dict[str, Any] = {
            "target_speed": target,
            "confidence": self.confidence,
            "seed": unknown.seed,
            "fold_speed": band.upper,
            "transition_speed": band.transition,
            "stick_speed": unknown.drag.law_at(end).stick_speed,
            "temperature": end,
            "greatest_speed": greatest,
        }
        reasons = obstacles(search, limits, reach, wide, searched=False)
        if not reasons:
            if (proven := self._searched(search, facts)) is not None:
                return proven
            reasons = obstacles(search, limits, reach, wide, searched=True)
        return Plan(**facts, **NOTHING, warnings=(), obstacles=reasons, tried=search.count), None

    def _searched(self, search: Search, facts: Mapping[str, Any]) -> tuple[Plan, Shape | None] | None:
        """The plan that a search finds and fresh draws prove; None if no profile works."""
        unknown, reach, shape = self.unknown, self.reach, search.run()
        for number in range(1, _VERIFIED + 1):
            if shape is None:
                return None
            duration = max(rounded(search.time, up=True), shape.end)
            if search.time <= shape.end:
                duration = float(shape.points()[0][-1])
            proof = unknown.verify(shape, duration, search.thermal, reach.force, self.confidence, number)
            if proof.accepted:
                said = {"tried": search.count, "warnings": tuple(_warnings(reach, proof.impossible))}
                machine = MachineSample(self.gripping, unknown.drag)
                return _found(machine, shape, search.thermal, proof, reach, {**facts, **said}), shape
            if unknown.machines:  # given machines prove one profile: after that none of them is new
                return self._unproven(facts, search.count, proof.share), None
            if number < _VERIFIED:
                share = _STRICTER[number - 1] * most_failures(self.confidence, LEVEL, proof.draws)
                share /= proof.draws
                known = len(search.trials.machines) + proof.draws
                shape = search.again(proof.machines, math.floor(share * known))
        return None

    def _unproven(self, facts: Mapping[str, Any], tried: int, share: float) -> Plan:
        """The plan without the profile that the search found and fresh draws refuse."""
        text = (
            f"the best profile works for {100 * share:.4g} % of new draws, but "
            f"{100 * self.confidence:.4g} % are required; accept a lower confidence"
        )
        obstacle = Obstacle("confidence", self.confidence, share, text)
        return Plan(**facts, **NOTHING, warnings=(), obstacles=(obstacle,), tried=tried)

    def proven(self, plan: Plan, shape: Shape, thermal: TemperatureProfile) -> Plan:
        """Return the plan with a proof of its own: temperature is a state of every motion."""
        assert thermal.schedule is not None
        proof = self.unknown.verify(
            shape, plan.duration, thermal, self.reach.force, self.confidence, _VERIFIED + 1
        )
        if not proof.accepted:
            text = (
                "the plan works at the temperature that follows from the nominal parameters, but only "
                f"for {100 * proof.share:.4g} % of draws at their own temperatures; accept a lower "
                "confidence"
            )
            return self.without(plan, Obstacle("temperature", proof.share, None, text), thermal.schedule)
        facts = {name: getattr(plan, name) for name in _FACTS} | {"course": thermal.schedule}
        machine = MachineSample(self.gripping, self.unknown.drag)
        return _found(machine, shape, thermal, proof, self.reach, facts)

    def without(self, plan: Plan, obstacle: Obstacle, course: Schedule) -> Plan:
        """Return a plan without its profile, and why."""
        return replace(plan, **NOTHING, warnings=(), obstacles=(obstacle,), course=course)


#: What of a plan does not depend on its proof.
_FACTS = (
    *("target_speed", "confidence", "seed", "fold_speed", "transition_speed", "stick_speed", "temperature"),
    *("greatest_speed", "tried", "warnings"),
)


def _found(
    nominal: MachineSample,
    shape: Shape,
    thermal: TemperatureProfile,
    proof: Proof,
    reach: Reach,
    facts: Mapping[str, Any],
) -> Plan:
    ramps = shape.schedule()
    times, speeds = np.asarray(ramps.times), np.asarray(ramps.values)
    if proof.duration > times[-1]:
        times, speeds = np.append(times, proof.duration), np.append(speeds, shape.target)
    past = proof.duration - shape.wait
    response = simulate(
        nominal.train,
        nominal.drag,
        drive_speed=shape.schedule(waited=False),
        temperature=thermal.from_time(shape.wait),
        duration=1.15 * past + 2.0 * nominal.lap,
        samples=_SAMPLES,
    )
    return Plan(
        **facts,
        kind="direct" if shape.peak == shape.target else "overshoot",
        schedule=Schedule(times, speeds),
        duration=proof.duration,
        wait=shape.wait,
        rise=shape.rise,
        peak_speed=shape.peak,
        hold=shape.hold,
        fall=shape.fall,
        share=proof.share,
        share_low=proof.share_low,
        draws=proof.draws,
        failures={reach.broken if why == FORCE else why: number for why, number in proof.failures.items()},
        uses=tuple(LimitUse(*row) for row in reach.uses(shape, proof.peak_force)),
        obstacles=(),
        peak_force=proof.peak_force,
        response=response,
    )


def _warnings(reach: Reach, impossible: float) -> Iterator[Warning]:
    """Yield what was not stated, and draws that are no belt."""
    if "grip" not in reach.forces:
        yield Warning(
            "grip not in the plan",
            "the grip is not stated (roll_friction and nip_load), so the drive is assumed not to slip",
        )
    if impossible > 0:
        yield Warning(
            "impossible draws",
            "{share:.2g %} of the stated range was excluded, because its stick speed is not below the "
            "transition speed",
            share=impossible,
        )


def _check(drag: AnyDrag, target_speed: float, limits: Limits, confidence: float, seed: int) -> None:
    closure = getattr(drag, "closure", "retained")
    if closure not in _CLOSURES:
        raise ParameterError(
            f"closure '{closure}' has no stuck phase, which planning needs. Use {' or '.join(_CLOSURES)}"
        )
    for name, value in {"target_speed": target_speed, **vars(limits)}.items():
        if value is not None and not (math.isfinite(value) and value > 0):
            raise ParameterError(f"{name} is {value}: it must be greater than 0")
    if not CONFIDENCES[0] <= confidence <= CONFIDENCES[1]:
        low, high = CONFIDENCES
        raise ParameterError(
            f"confidence is {confidence:g}: it must be from {low} to {high}",
            remedy=f"write {confidence / 100:g}" if low <= confidence / 100 <= high else "",
        )
    if seed < 0:
        raise ParameterError(f"seed is {seed}: it must not be negative")
