"""A start-up profile that works on nearly all draws of the posterior, whatever the closure.

Profiles are a ramp up, a hold and a ramp down to the target. They are tried in the order of their duration,
on the draws that are hardest to start first; the quickest that works on 98 % of half of the draws is verified
on the other half, which the search has not seen.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.cache.kept import kept
from hersey.decision.judge import drive_limit
from hersey.errors import ParameterError
from hersey.machine.limits import Limits
from hersey.motion.schedule import Schedule
from hersey.motion.simulation import simulate
from hersey.motion.trajectory import Trajectory
from hersey.posterior import Posterior
from hersey.posterior.drives import Drives
from hersey.posterior.typical import typical_drag
from hersey.stability.plan.draws import lower_bound
from hersey.stability.plan.obstacles import Obstacle
from hersey.stability.plan.result import CONFIDENCES, NOTHING, LimitUse, Plan
from hersey.stability.plan.trial import Shape, rounded

#: Share of the draws that must slide, in the search and in the verification.
SEARCHED, VERIFIED = 0.98, 0.95
#: Durations of ramps and holds, in periods of spring and mass.
_RISES = (0.0, 1.0, 4.0, 16.0, 60.0)
_HOLDS = (1.0, 4.0, 12.0)
_FALLS = (0.0, 1.0, 3.0, 8.0, 20.0, 60.0)
#: Peak speeds, over the safe speed.
_PEAKS = (0.6, 0.8, 1.0, 1.25, 1.6)
#: Draws that are hardest to start, tried first, and all that the search takes.
_HARD, _MOST = 24, 200
#: Laps after the last ramp within which a belt must have been let go for good.
_LATE = 2.0
#: Level of the bound of the share that is stated, and accuracy of the motion.
_LEVEL, _ACCURACY = 0.95, 1e-3
#: Samples of the response that is shown.
_SAMPLES = 2001
#: Laps after the last ramp that a response shows at least and at most, and the share of the target speed
#: within which its oscillation has died out.
_LAPS, _DIED_OUT = (12.0, 60.0), 0.03


@dataclass(frozen=True)
class _Asked:
    """What is asked of a profile."""

    found: Posterior
    kelvin: float | None
    target: float
    limits: Limits
    limit: float  #: greatest force at the belt, N
    confidence: float = VERIFIED

    @property
    def lap(self) -> float:
        return self.found.model.machine.train.free_period

    def facts(self) -> dict[str, Any]:
        """Return what a plan says of the machine, whatever it finds."""
        found, kelvin = self.found, self.kelvin
        return {
            "target_speed": self.target,
            "confidence": self.confidence,
            "seed": found.seed,
            "fold_speed": found.fold_interval(kelvin)[0],
            "transition_speed": float(np.median(found.edges(kelvin).transition)),
            "stick_speed": float(np.median(found.model.stick_speed(found.drives, kelvin))),
            "temperature": kelvin,
            "greatest_speed": self.limits.speed or max(_PEAKS) * found.safe_speed(kelvin),
        }

    def tried(self, drives: Drives, shape: Shape) -> tuple[np.ndarray, FloatArray]:
        """Return which draws slide soon after the last ramp, within the force, and their peaks (N)."""
        corners = list(zip(*shape.points(), strict=True))
        started = self.found.model.start_ups(drives, self.kelvin, corners, accuracy=_ACCURACY)
        soon = started.released <= shape.end + _LATE * self.lap
        return started.slides & soon & (started.peak <= self.limit), np.asarray(started.peak)


@kept()
def plan_start_up(
    found: Posterior, kelvin: float | None, target_speed: float, *, confidence: float = VERIFIED
) -> Plan:
    """Return the quickest start-up to a target speed (m/s) that works on nearly all draws.

    ``obstacles`` of the plan say why there is none: the target lies below the transition in too many draws,
    or no profile within the limits works.
    ``confidence`` is the share of fresh draws that must slide.

    Raises
    ------
    ParameterError
        If target or confidence is out of range.
    """
    if not (math.isfinite(target_speed) and target_speed > 0.0):
        raise ParameterError(f"target_speed is {target_speed}: it must be greater than 0")
    low, high = CONFIDENCES
    if not low <= confidence <= high:
        raise ParameterError(
            f"confidence is {confidence:g}: it must be from {low} to {high}",
            remedy=f"write {confidence / 100:g}" if low <= confidence / 100 <= high else "",
        )
    machine = found.model.machine
    limit = drive_limit(machine.limits, machine.roll_radius, machine.train.grip)
    if machine.limits.spring_force is not None:
        limit = min(limit, machine.limits.spring_force)
    asked = _Asked(found, kelvin, target_speed, machine.limits, limit, confidence)
    if machine.limits.speed is not None and target_speed > machine.limits.speed * (1.0 + 1e-9):
        return _plan(asked, None, 0)
    below = float(np.mean(found.edges(kelvin).transition >= target_speed))
    if below > 1.0 - confidence:
        return _plan(asked, None, 0, below_transition=below)
    drives = found.drives
    order = np.arange(len(drives))
    half = order[::2]
    few = np.linspace(0, half.size - 1, min(_MOST, half.size)).astype(np.intp)
    seen, fresh = drives.take(half[few]), drives.take(order[1::2])
    shape, count = _searched(asked, _hardest_first(asked, seen))
    return _plan(asked, shape, count, fresh=fresh)


def _searched(asked: _Asked, seen: Drives) -> tuple[Shape | None, int]:
    hard = seen.take(np.arange(min(_HARD, len(seen))))
    searched = max(SEARCHED, 0.5 * (1.0 + asked.confidence))
    allowed = math.floor((1.0 - searched) * len(seen))
    shapes = _shapes(asked)
    for count, shape in enumerate(shapes, 1):
        slides, _ = asked.tried(hard, shape)
        if np.count_nonzero(~slides) > allowed:
            continue
        slides, _ = asked.tried(seen, shape)
        if np.count_nonzero(~slides) <= allowed:
            return shape, count
    return None, len(shapes)


def _hardest_first(asked: _Asked, drives: Drives) -> Drives:
    """Draws by V*, the greatest first: they are the hardest to bring to slide."""
    fold = asked.found.model.folds(drives, asked.kelvin, accuracy=1e-2).upper
    return drives.take(np.argsort(-fold, kind="stable").astype(np.intp))


def _shapes(asked: _Asked) -> list[Shape]:
    """Profiles within speed and acceleration of the drive, the quickest first."""
    limits, lap, target = asked.limits, asked.lap, asked.target
    acceleration = limits.acceleration or math.inf
    greatest = limits.speed or math.inf
    safe = asked.found.safe_speed(asked.kelvin)
    holding = float(np.quantile(asked.found.edges(asked.kelvin).holding, 0.975))
    loading = holding / asked.found.model.machine.stiffness  # way of the drive until the belt breaks away
    direct = [Shape(target, target, target / acceleration + lap * rise) for rise in _RISES]
    peaks = {min(peak * safe, greatest) for peak in _PEAKS if min(peak * safe, greatest) > target}
    over = [
        Shape(
            target,
            peak,
            peak / acceleration + lap * rise,
            lap * hold + loading / peak,
            (peak - target) / acceleration + lap * fall,
        )
        for peak in peaks
        for rise in _RISES[:3]
        for hold in _HOLDS
        for fall in _FALLS
    ]
    return sorted([*direct, *over], key=lambda shape: (shape.end, shape.peak))


def _plan(
    asked: _Asked,
    shape: Shape | None,
    tried: int,
    *,
    fresh: Drives | None = None,
    below_transition: float = 0.0,
) -> Plan:
    target = asked.target
    facts = {**asked.facts(), "tried": tried, "warnings": ()}
    if shape is None or fresh is None:
        return Plan(**facts, **NOTHING, obstacles=(_obstacle(asked, below_transition),))
    slides, peaks = asked.tried(fresh, shape)
    share = float(np.mean(slides))
    if share < asked.confidence:
        return Plan(**facts, **NOTHING, obstacles=(_obstacle(asked, below_transition),))
    good, peak_force = round(share * len(fresh)), float(np.quantile(peaks, asked.confidence))
    return Plan(
        **facts,
        kind="direct" if shape.peak <= target else "overshoot",
        schedule=shape.schedule(),
        duration=rounded(shape.end + _LATE * asked.lap, up=True),
        wait=0.0,
        rise=shape.rise,
        peak_speed=shape.peak,
        hold=shape.hold,
        fall=shape.fall,
        share=share,
        share_low=lower_bound(good, len(fresh), _LEVEL),
        draws=len(fresh),
        failures=_failures(len(fresh) - good),
        uses=_uses(asked, shape, peak_force),
        obstacles=(),
        peak_force=peak_force,
        response=_until_died_out(asked, shape),
    )


def _failures(count: int) -> dict[str, int]:
    return {"sticks, or needs more force than the drive gives": count} if count else {}


def _obstacle(asked: _Asked, below_transition: float) -> Obstacle:
    speed = f"{1e3 * asked.target:.3g} mm/s"
    if below_transition > 0.0:
        edges = asked.found.edges(asked.kelvin)
        value, low, high, needed = map(float, np.quantile(edges.transition, (0.5, 0.025, 0.975, SEARCHED)))
        safe = float(np.quantile(edges.fold, 0.975))
        text = (
            f"{speed} is below the speed of lowest drag, {1e3 * value:.3g} mm/s [{1e3 * low:.3g}, "
            f"{1e3 * high:.3g}], with {100 * below_transition:.0f} % probability, and steady sliding is "
            f"unstable there. Choose a target well above {1e3 * needed:.3g} mm/s: from {1e3 * safe:.3g} mm/s "
            "on it slides from any start"
        )
        return Obstacle("target_speed", asked.target, needed, text)
    if asked.limits.speed is not None and asked.target > asked.limits.speed:
        text = f"{speed} exceeds the maximum speed of the drive, {1e3 * asked.limits.speed:.3g} mm/s"
        return Obstacle("speed", asked.limits.speed, asked.target, text)
    searched = 100 * max(SEARCHED, 0.5 * (1.0 + asked.confidence))
    text = (
        f"no profile within the limits makes {searched:.3g} % of the draws slide at {speed} "
        f"({100 * asked.confidence:.3g} % confidence)"
    )
    return Obstacle("speed", asked.limits.speed or math.inf, None, text)


def _uses(asked: _Asked, shape: Shape, peak_force: float) -> tuple[LimitUse, ...]:
    limits, radius = asked.limits, asked.found.model.machine.roll_radius
    stated = {
        "speed": (limits.speed, shape.peak),
        "acceleration": (limits.acceleration, shape.acceleration),
        "motor_torque": (limits.motor_torque, peak_force * radius),
        "spring_force": (limits.spring_force, peak_force),
        "grip": (limits.grip, peak_force),
    }
    return tuple(LimitUse(name, limit, used) for name, (limit, used) in stated.items() if limit is not None)


def _until_died_out(asked: _Asked, shape: Shape) -> Trajectory:
    """Return the motion under a profile until its oscillation has died out."""
    least, most = (shape.end + laps * asked.lap for laps in _LAPS)
    whole = response(asked.found, asked.kelvin, shape.schedule(), most)
    oscillates = np.flatnonzero(np.abs(whole.belt_speed / asked.target - 1.0) > _DIED_OUT)
    last = float(whole.time[oscillates[-1]]) + asked.lap if oscillates.size else least
    return response(asked.found, asked.kelvin, shape.schedule(), min(max(last, least), most))


def response(
    found: Posterior, kelvin: float | None, schedule: Schedule | float, duration: float
) -> Trajectory:
    """Return the motion of the typical draw under a profile of drive speed."""
    train, drag = typical_drag(found, kelvin)
    return simulate(train, drag, drive_speed=schedule, duration=duration, samples=_SAMPLES, tolerance=1e-6)
