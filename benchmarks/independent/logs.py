"""From a law, a plan of the test and the errors of the bench to a log in a CSV file.

The drive starts from a standstill at every temperature, holds each speed for 5 to 7 s (up, or up and down)
and stops again; heating goes on while it stands, and is shorter than in life, as in a log that was paused.
The torque relaxes for about a second after each change of speed. What each dwell truly was is kept beside it.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from benchmarks.independent.laws import RPM, Array, TorqueLaw

Counts = NDArray[np.intp]

#: s: of a change of speed; of the relaxation of torque after it; of its time constant.
RAMP, SETTLING = 0.4, 0.35
#: Share by which torque is too high just after a change of speed.
OVERSHOOT = 0.04
#: Standard deviations of single samples: of speed (share), temperature (K), torque at rest (share of level).
SPEED_NOISE, TEMPERATURE_NOISE, REST_NOISE = 0.002, 0.1, 0.003
#: Standard deviation of the true temperature of a dwell about what was set, K.
WANDER = 0.4


@dataclass(frozen=True)
class Plan:
    """Speeds (rpm) run through at each temperature (degC)."""

    speeds: tuple[float, ...]
    temperatures: tuple[float, ...]
    up_down: bool = True
    standing: float = 1.5  #: s before, between and after the visits
    rate: float = 50.0  #: Hz

    @property
    def middle(self) -> float:
        """Geometric mean of the speeds, rad/s."""
        return float(np.exp(np.mean(np.log(self.speeds)))) * RPM


@dataclass(frozen=True)
class Errors:
    """What the bench gets wrong. Shares are of the torque, unless said."""

    noise: float = 0.02  #: white, of one sample
    slow_noise: float = 0.0  #: standard deviation of noise with the time ``tau`` (s), AR(1)
    tau: float = 0.5
    scatter: float = 0.0  #: from dwell to dwell
    visit: float = 0.0  #: shared by all dwells of one stay at a temperature
    zero: float = 0.0  #: offset of the torque sensor, share of the level of the log
    drift: float = 0.0  #: change of that offset over the log: of a line its rise, of a walk its deviation
    walk: bool = False
    heating: float = 0.0  #: bound, K, on how much hotter than its sensor the film runs at the greatest power


@dataclass(frozen=True)
class Log:
    """A log as the bench wrote it, and what the dwells truly were (arrays of one entry per dwell)."""

    time: Array
    speed: Array  #: rpm, as read
    torque: Array
    temperature: Array  #: degC, as read
    dwell_speed: Array  #: rad/s
    dwell_celsius: Array  #: of the film
    dwell_read: Array  #: degC, as its sensor has it
    heated: Array  #: share of the greatest power, 0 to 1
    dwell_torque: Array  #: by the law
    visit: Array
    middle: Array  #: time of its middle, s
    samples: Array
    standing: tuple[tuple[float, float], ...]  #: middle (s) and samples of each stretch
    level: float  #: geometric mean of the torques

    def write(self, path: Path) -> Path:
        """Write it as CSV with units in the header."""
        columns = np.column_stack([self.time, self.speed, self.torque, self.temperature])
        head = "time (s),speed (rpm),torque (N*m),temperature (degC)"
        np.savetxt(
            path, columns, fmt=["%.3f", "%.3f", "%.6f", "%.3f"], delimiter=",", header=head, comments=""
        )
        return path


@dataclass(frozen=True)
class _Stretches:
    """One entry per stretch: the standstills and the dwells, in the order of the log."""

    rpm: Array
    celsius: Array
    visit: Array
    samples: Counts


def record(law: TorqueLaw, plan: Plan, errors: Errors, rng: np.random.Generator) -> Log:
    """Return the log of one test."""
    stretches = _stretches(plan, rng)
    moving = np.flatnonzero(stretches.rpm > 0)
    speed, read = stretches.rpm[moving] * RPM, stretches.celsius[moving]
    cool = law.torque(speed, read)
    heated = cool * speed / np.max(cool * speed)
    film = read + heated * errors.heating * rng.uniform()
    torque = law.torque(speed, film)
    level = float(np.exp(np.mean(np.log(torque))))
    time = np.arange(stretches.samples.sum()) / plan.rate
    ends = np.cumsum(stretches.samples) / plan.rate
    middles = ends - 0.5 * stretches.samples / plan.rate
    true_torque, true_rpm = _traces(stretches, moving, torque * _disturbance(errors, stretches, rng), plan)
    rest = np.flatnonzero(stretches.rpm == 0)
    return Log(
        time=time,
        speed=true_rpm * (1.0 + SPEED_NOISE * rng.standard_normal(time.size)),
        torque=true_torque + _noise(errors, true_torque, level, plan, rng) + _zero(errors, level, time, rng),
        temperature=_temperature_trace(stretches, plan) + TEMPERATURE_NOISE * rng.standard_normal(time.size),
        dwell_speed=speed,
        dwell_celsius=film,
        dwell_read=read,
        heated=heated,
        dwell_torque=torque,
        visit=stretches.visit[moving],
        middle=middles[moving],
        samples=stretches.samples[moving].astype(float),
        standing=tuple((float(middles[i]), float(stretches.samples[i])) for i in rest),
        level=level,
    )


def _stretches(plan: Plan, rng: np.random.Generator) -> _Stretches:
    climb = list(plan.speeds)
    course = climb + climb[::-1] if plan.up_down else climb
    rows: list[tuple[float, float, int, float]] = []
    for visit, celsius in enumerate(plan.temperatures):
        rows.append((0.0, celsius, visit, plan.standing))
        rows += [(s, celsius + WANDER * rng.standard_normal(), visit, rng.uniform(5.0, 7.0)) for s in course]
    rows.append((0.0, plan.temperatures[-1], len(plan.temperatures) - 1, plan.standing))
    rpm, celsius_of, visits, seconds = np.array(rows).T
    return _Stretches(rpm, celsius_of, visits, np.round(seconds * plan.rate).astype(np.intp))


def _disturbance(errors: Errors, stretches: _Stretches, rng: np.random.Generator) -> Array:
    """Factor of the torque of each dwell: its own, and that of its visit."""
    visits = errors.visit * rng.standard_normal(int(stretches.visit.max()) + 1)
    moving = stretches.rpm > 0
    own = errors.scatter * rng.standard_normal(np.count_nonzero(moving))
    return np.asarray(np.exp(own + visits[stretches.visit[moving].astype(int)]))


def _traces(stretches: _Stretches, moving: Counts, torque: Array, plan: Plan) -> tuple[Array, Array]:
    """True torque and speed (rpm) of every sample: each change of speed is a ramp and a relaxation."""
    held = np.zeros(stretches.rpm.size)
    held[moving] = torque
    since = np.concatenate([np.arange(n) for n in stretches.samples]) / plan.rate
    part = np.clip(since / RAMP, 0.0, 1.0)
    changed = np.append(True, np.diff(stretches.rpm) != 0)  # the fastest speed of up and down is one dwell
    over = 1.0 + OVERSHOOT * np.exp(-since / SETTLING) * np.repeat(changed, stretches.samples)
    return _ramped(held, stretches, part) * over, _ramped(stretches.rpm, stretches, part)


def _ramped(values: Array, stretches: _Stretches, part: Array) -> Array:
    before = np.concatenate([values[:1], values[:-1]])
    first, then = np.repeat(before, stretches.samples), np.repeat(values, stretches.samples)
    return np.asarray(first + (then - first) * part)


def _temperature_trace(stretches: _Stretches, plan: Plan) -> Array:
    """Temperature of every sample, degC: changed evenly over a standstill, quickly between dwells."""
    since = np.concatenate([np.arange(n) for n in stretches.samples]) / plan.rate
    seconds = np.where(stretches.rpm > 0, 2 * RAMP, plan.standing)
    return _ramped(stretches.celsius, stretches, np.clip(since / np.repeat(seconds, stretches.samples), 0, 1))


def _noise(errors: Errors, torque: Array, level: float, plan: Plan, rng: np.random.Generator) -> Array:
    fast = errors.noise * torque * rng.standard_normal(torque.size)
    rest = REST_NOISE * level * rng.standard_normal(torque.size)
    if not errors.slow_noise:
        return np.asarray(fast + rest)
    keep = float(np.exp(-1.0 / (plan.rate * errors.tau)))
    kicks = np.sqrt(1.0 - keep**2) * rng.standard_normal(torque.size)
    kicks[0] = rng.standard_normal()
    return np.asarray(fast + rest + errors.slow_noise * torque * lfilter([1.0], [1.0, -keep], kicks))


def _zero(errors: Errors, level: float, time: Array, rng: np.random.Generator) -> Array:
    """Offset of the torque sensor at every sample, N m."""
    offset = np.full(time.size, errors.zero * level)
    if errors.walk:
        steps = rng.standard_normal(time.size) / np.sqrt(time.size)
        return np.asarray(offset + errors.drift * level * np.cumsum(steps))
    return np.asarray(offset + errors.drift * level * rng.choice([-1.0, 1.0]) * time / time[-1])
