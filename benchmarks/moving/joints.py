"""Virtual joints that move all the time: a generator that shares no code with hersey.

Position is integrated, read by a 12-bit encoder and differenced to speed over each interval, as a drive
does. Torque has inertia, Coulomb and viscous friction, for half of the joints Stribeck's rise near
standstill, a zero, and coloured noise. The same joint can be driven through a staircase of constant speeds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

Array = np.ndarray

#: Steps of the encoder per revolution (12 bit).
STEPS = 4096
#: Rows per second, length of a log in s, and finer steps in which the motion is integrated.
RATE, LENGTH, FINER = 200.0, 60.0, 10


@dataclass(frozen=True)
class Joint:
    """One joint: SI."""

    inertia: float
    coulomb: float
    static: float  #: equals coulomb without Stribeck
    stribeck_speed: float
    viscous: float
    offset: float
    fastest: float  #: rad/s
    noise: float  #: standard deviation of the coloured noise, N m
    memory: float  #: its correlation time, s

    @property
    def stribeck(self) -> bool:
        """Whether friction rises near standstill."""
        return self.static > self.coulomb

    def friction(self, speed: Array) -> Array:
        """Torque of friction."""
        rise = (self.static - self.coulomb) * np.exp(-((speed / self.stribeck_speed) ** 2))
        return np.sign(speed) * (self.coulomb + rise) + self.viscous * speed


def joint(seed: int) -> Joint:
    """A joint by chance; even ones have Stribeck's rise."""
    rng = np.random.default_rng([33, seed])
    coulomb = float(np.exp(rng.uniform(np.log(0.2), np.log(3.0))))
    fastest = float(rng.uniform(5.0, 20.0))
    viscous = coulomb * float(rng.uniform(0.3, 1.5)) / fastest
    static = coulomb * (float(rng.uniform(1.3, 1.8)) if seed % 2 == 0 else 1.0)
    return Joint(
        inertia=coulomb * float(rng.uniform(0.2, 1.0)) / (3.0 * fastest),
        coulomb=coulomb,
        static=static,
        stribeck_speed=fastest * float(rng.uniform(0.04, 0.1)),
        viscous=viscous,
        offset=coulomb * float(rng.normal(0.0, 0.03)),
        fastest=fastest,
        noise=coulomb * float(rng.uniform(0.01, 0.04)),
        memory=float(np.exp(rng.uniform(np.log(0.01), np.log(0.1)))),
    )


def moving(of: Joint, seed: int) -> dict[str, Array]:
    """A log of ramps, then of sines: columns with their units."""
    rng = np.random.default_rng([34, seed])
    fine = 1.0 / (RATE * FINER)
    time = np.arange(int(LENGTH * RATE * FINER) + 1) * fine
    middle = LENGTH / 2
    speed = np.where(time < middle, _ramps(time, of, rng), _sines(time - middle, of, rng))
    speed *= np.clip(np.abs(time - middle), 0.0, 1.0)  # no motor changes its speed at once
    return _read(of, time, speed, rng)


def staircase(of: Joint, seed: int) -> dict[str, Array]:
    """A log of the same length and noise: six speeds each way."""
    rng = np.random.default_rng([35, seed])
    fine = 1.0 / (RATE * FINER)
    time = np.arange(int(LENGTH * RATE * FINER) + 1) * fine
    levels = np.geomspace(0.03, 1.0, 6) * of.fastest
    levels = np.concatenate([levels, -levels])
    held = LENGTH / levels.size
    index = np.minimum((time / held).astype(int), levels.size - 1)
    into = time - index * held
    before = np.concatenate([[0.0], levels])[index]
    share = np.clip(into / 0.3, 0.0, 1.0)
    speed = before + (levels[index] - before) * 0.5 * (1.0 - np.cos(np.pi * share))
    return _read(of, time, speed, rng)


def _ramps(time: Array, of: Joint, rng: np.random.Generator) -> Array:
    """Triangles up and down, slow ones and fast ones in turn."""
    knots, speeds, way = [0.0], [0.0], 1.0
    while knots[-1] < LENGTH:
        top = of.fastest * float(rng.uniform(0.2, 1.0))
        last = float(rng.uniform(0.5, 4.0))
        knots += [knots[-1] + last, knots[-1] + 2.0 * last]
        speeds += [way * top, 0.0]
        way = -way
    return np.interp(time, knots, speeds)


def _sines(time: Array, of: Joint, rng: np.random.Generator) -> Array:
    """Three sines of other frequencies."""
    hertz = rng.uniform(0.1, 1.2, 3)
    sizes = rng.uniform(0.3, 1.0, 3) / hertz**0.5
    phases = rng.uniform(0.0, 2.0 * np.pi, 3)
    waves = sum(
        size * np.sin(2.0 * np.pi * each * time + phase)
        for size, each, phase in zip(sizes, hertz, phases, strict=True)
    )
    return np.asarray(of.fastest * waves / sizes.sum())


def _read(of: Joint, time: Array, speed: Array, rng: np.random.Generator) -> dict[str, Array]:
    """What the sensors read of a motion."""
    fine = float(time[1] - time[0])
    position = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * fine)])
    position += float(rng.uniform(0.0, 2.0 * np.pi))
    rate = np.gradient(speed, fine)
    torque = of.inertia * rate + of.offset + of.friction(speed)
    rows = slice(None, None, FINER)
    step = 2.0 * np.pi / STEPS
    counted = np.floor(position[rows] / step) * step
    read = np.diff(counted) * RATE
    clean = torque[rows][1:]
    noise = _coloured(of, clean.size, rng) + rng.normal(0.0, 0.5 * of.noise, clean.size)
    return {"time (s)": time[rows][1:], "torque (N m)": clean + noise, "speed (rad/s)": read}


def _coloured(of: Joint, count: int, rng: np.random.Generator) -> Array:
    """Noise that forgets within its memory."""
    keep = float(np.exp(-1.0 / (RATE * of.memory)))
    kicks = rng.normal(0.0, of.noise * np.sqrt(1.0 - keep**2), count)
    out = np.empty(count)
    last = float(rng.normal(0.0, of.noise))
    for i, kick in enumerate(kicks):
        last = keep * last + kick
        out[i] = last
    return out
