"""Whether a life test of virtual units is read rightly: which end comes first, and when.

The generator stands in this file and shares no code with hersey: its own drive, oil, film, asperities and
ageing, its own motion for the speed from which stick-slip cannot last, and its own look-up of the age at
which each limit is first reached. hersey sees tables of means of 8 units with some 10 logs each, followed to
60 % of the median life, and the file of the machine.

Usage: python -m benchmarks.life [--campaigns 200] [--seed 1] [--processes 1]
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

ZERO = 273.15

# --- the drive, by laws of its own -----------------------------------------------------------------------

#: Nip over thickness of the rubber against w R/(E* h^2), for Poisson's ratios 0.45 and 0.49.
_NIP = np.array([0.4, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 10.0])
_LOADS = {
    0.45: np.array([0.032556, 0.2389, 0.64467, 1.3821, 4.3697, 10.349, 36.585, 187.6]),
    0.49: np.array([0.032668, 0.24358, 0.67011, 1.468, 4.8606, 12.086, 47.287, 295.52]),
}


def _summits() -> tuple[np.ndarray, np.ndarray]:
    """How many summits carry at a film over roughness: Gaussian heights, power 5/2, 1 at none."""
    ratio = np.linspace(0.0, 8.0, 400)
    s = np.linspace(0.0, 10.0, 2001)
    heights = np.exp(-((ratio[:, None] + s) ** 2) / 2)
    carried = np.sum(s**2.5 * heights, axis=1)
    return ratio, np.log(carried / carried[0])


_RATIO, _CARRIED = _summits()


@dataclass(frozen=True)
class Oil:
    """Kinematic viscosity of two points (ASTM D341) or ln eta = a + b/(T - c); Pa s from K."""

    kind: str
    numbers: tuple[float, ...]
    density: float

    def viscosity(self, kelvin: np.ndarray | float) -> np.ndarray:
        """Return viscosity, Pa s."""
        t = np.asarray(kelvin, dtype=float)
        if self.kind == "vogel":
            a, b, c = self.numbers
            return np.exp(a + b / (t - c))
        a, b = self.numbers
        return self.density * 1e-6 * (10 ** (10 ** (a - b * np.log10(t))) - 0.7)


@dataclass(frozen=True)
class Drive:
    """All that does not age, in SI."""

    radius: float
    length: float
    load: float
    modulus: float
    poisson: float
    rubber: float
    stiffness: float
    mass: float
    stick: float
    oil: Oil
    film_factor: float
    sharpness: float
    summits: float
    friction: float
    roughness: float
    rest: float
    rest_per_speed: float
    rest_slope: float
    reference: float
    rolling: float

    @property
    def width(self) -> float:
        """Width of the nip, m."""
        stiff = self.modulus / (1 - self.poisson**2)
        w = np.log(self.load / self.length * self.radius / (stiff * self.rubber**2))
        at = [np.interp(w, np.log(table), _NIP) for table in _LOADS.values()]
        share = np.clip((self.poisson - 0.45) / 0.04, 0.0, 1.0)
        return float(self.rubber * (at[0] * (1 - share) + at[1] * share))

    def flooded(self, product: np.ndarray) -> np.ndarray:
        """Film of a soft nip from eta U (U of the belt), m."""
        two = 2 * self.modulus / (1 - self.poisson**2)
        speed = 0.5 * product / (two * self.radius)
        load = self.load / self.length / (two * self.radius)
        return self.film_factor * 0.93 * 3.1 * self.radius * speed**0.6 * load**-0.2


@dataclass(frozen=True)
class State:
    """What has aged, as arrays of one shape."""

    thicker: np.ndarray
    layer: np.ndarray
    rougher: np.ndarray
    friction: np.ndarray
    rest: np.ndarray

    def __getitem__(self, key: object) -> State:
        """Return a part of the units or ages."""
        return State(*(getattr(self, name)[key] for name in STATES))

    def spread(self) -> State:
        """Return it with one more axis, for speeds."""
        return State(*(getattr(self, name)[..., None] for name in STATES))


STATES = ("thicker", "layer", "rougher", "friction", "rest")
#: A flooded inlet, and nothing aged.
NEW = State(np.ones(()), np.ones(()), np.ones(()), np.ones(()), np.ones(()))


def torque(
    drive: Drive, state: State, speed: np.ndarray, kelvin: np.ndarray | float
) -> tuple[np.ndarray, ...]:
    """Whole torque, and flooded film over layer, at belt speeds in m/s."""
    eta = state.thicker * drive.oil.viscosity(kelvin)
    flooded = drive.flooded(eta * speed)
    over = state.layer / flooded
    thin = over / (1 + over**drive.sharpness) ** (1 / drive.sharpness)
    film = flooded * thin
    ratio = film / (drive.roughness * state.rougher)
    share = -np.expm1(-drive.summits * np.exp(np.interp(ratio, _RATIO, _CARRIED)))
    share = np.where(ratio > 8.0, 0.0, share)
    sheared = (1 - share) * eta * speed / film * drive.width * drive.length
    rolled = drive.rolling * thin**3 * eta * speed / flooded * drive.width * drive.length
    rubbed = share * state.friction * drive.friction * drive.load
    rest = state.rest * (drive.rest + drive.rest_per_speed * speed / drive.radius)
    rest = rest * (1 + drive.rest_slope * (kelvin - drive.reference))
    return drive.radius * (sheared + rubbed + rolled) + rest, 1 / over


# --- motion: the drive speed from which a lap of stick-slip does not come back ---------------------------


#: Drive speeds tried at once, turns of the search, and the fold at most over the speed of least drag.
_TRIED, _TURNS, _FARTHEST = 16, 2, 20.0


def fold_speed(drive: Drive, state: State, kelvin: float) -> tuple[np.ndarray, np.ndarray]:
    """Fold V* and speed of least drag, m/s, for each state (one axis); both 0 where drag falls nowhere.

    A lap starts where the belt leaves the stick speed; the cycle lives if it comes back to that speed.
    """
    v = drive.stick * np.geomspace(1.0, 1000.0, 320)
    force = torque(drive, state.spread(), v, kelvin)[0] / drive.radius
    least = np.argmin(force, axis=1)
    falls = force[:, 0] > force.min(axis=1) * (1 + 1e-6)
    n = force.shape[0]
    low = np.log(v[least])
    high = low + np.log(_FARTHEST)
    if falls.any():
        some = np.flatnonzero(falls)
        for _ in range(_TURNS):
            tried = low[some, None] + np.linspace(0.0, 1.0, _TRIED) * (high - low)[some, None]
            lives = _comes_back(drive, v, force[some], np.exp(tried))
            # The first that does not come back; the speed of least drag bounds it from below.
            i = np.where(lives.all(axis=1), _TRIED - 1, np.argmin(lives, axis=1))
            row = np.arange(some.size)
            low[some], high[some] = tried[row, np.maximum(i - 1, 0)], tried[row, i]
    fold = np.exp(0.5 * (low + high))
    return np.where(falls, fold, 0.0), np.where(falls, v[least], 0.0) + np.zeros(n)


def _comes_back(drive: Drive, v: np.ndarray, force: np.ndarray, speeds: np.ndarray) -> np.ndarray:
    """Whether a lap comes back to the stick speed: forces by state and v, drive speeds by state."""
    step = np.log(v[1] / v[0])
    flat, offset = force.ravel(), np.arange(force.shape[0])[:, None] * v.size
    k, m = drive.stiffness, drive.mass
    dt = 2 * np.pi * np.sqrt(m / k) / 160

    def push(stretch: np.ndarray, speed: np.ndarray) -> np.ndarray:
        at = np.clip(np.log(np.maximum(speed, drive.stick) / drive.stick) / step, 0.0, v.size - 1.001)
        i = at.astype(int)
        below = flat[offset + i]
        return (k * stretch - below - (at - i) * (flat[offset + i + 1] - below)) / m

    stretch = np.broadcast_to(force[:, :1] / k, speeds.shape).copy()
    speed = np.full(speeds.shape, drive.stick * (1 + 1e-9))
    over, back, done = (np.zeros(speeds.shape, dtype=bool) for _ in range(3))
    for _ in range(600):
        s1, v1 = speeds - speed, push(stretch, speed)
        s2, v2 = speeds - speed - dt / 2 * v1, push(stretch + dt / 2 * s1, speed + dt / 2 * v1)
        s3, v3 = speeds - speed - dt / 2 * v2, push(stretch + dt / 2 * s2, speed + dt / 2 * v2)
        s4, v4 = speeds - speed - dt * v3, push(stretch + dt * s3, speed + dt * v3)
        stretch = stretch + dt / 6 * (s1 + 2 * s2 + 2 * s3 + s4)
        new = speed + dt / 6 * (v1 + 2 * v2 + 2 * v3 + v4)
        over |= new > speeds
        back |= ~done & over & (new <= drive.stick)
        # Past its least speed above the stick threshold the lap has missed it.
        done |= back | (over & (new > speed) & (new < speeds) & (new > drive.stick))
        speed = np.maximum(new, 0.5 * drive.stick)
        if done.all():
            break
    return back


# --- ageing ----------------------------------------------------------------------------------------------

#: Ages on which truth is looked up, over the life aimed at.
AGES = np.linspace(0.0, 6.0, 601)
#: Units that are followed, the place of the median unit behind them, and more of the population behind that.
UNITS, MORE = 8, 64
MEDIAN, ALL = UNITS, UNITS + 1 + MORE


def _grown(shape: str, final: float, pace: np.ndarray, tau: float) -> np.ndarray:
    """A factor from 1 to about ``final`` at age 1 of a unit of pace 1; (units, ages)."""
    x = pace[:, None] * AGES
    if shape == "exponential":
        return np.exp(np.minimum(np.log(final) * x, 5.0))
    if shape == "saturating":
        whole = (final - 1) / -np.expm1(-1 / tau)
        return 1 + whole * pace[:, None] * -np.expm1(-AGES / tau)
    return 1 + (final - 1) * x


def _thinned(first: np.ndarray, flow: np.ndarray, gone: np.ndarray, back: float) -> np.ndarray:
    """Layer over that of the median new unit: side flow, evaporation, and oil that comes back; stepped."""
    h = np.empty((first.size, AGES.size))
    at = first.copy()
    parts = 20
    dt = (AGES[1] - AGES[0]) / parts
    for i in range(AGES.size):
        h[:, i] = at
        for _ in range(parts):
            at = np.maximum(at + dt * (-flow * at**3 / 2 - gone * at + back), 0.02 * first)
    return h


@dataclass(frozen=True)
class Duty:
    """How the machine is used: belt speeds (m/s) and temperatures (K), and its limits."""

    fast: float
    cold: float
    slow: float
    hot: float
    usual: float
    share: float  # of the running time at full speed
    travel: float  # of the belt in a page, m
    starts: float  # of the drive in a page
    cold_starts: float  # share of them
    ratio: float  # torque at the gear over that at the roll
    slope: float  # of its S-N curve


@dataclass(frozen=True)
class World:
    """One campaign as it truly is."""

    aim: str
    drive: Drive
    duty: Duty
    states: State  # (units + the median one, ages)
    indicators: dict[str, np.ndarray]
    limits: dict[str, float]
    ages: dict[str, np.ndarray]  # of the units
    processes: dict[str, str]
    oil: str


#: What ends a unit. Stick-slip: drag falls with speed at a used point, so that none can run there smoothly.
AIMS = ("cold", "hot", "grip", "stick", "starve", "gear", "continuous", "energy")
_COARSE = np.linspace(0.0, 3.0, 11)


def _oil(random: np.random.Generator) -> tuple[Oil, str]:
    """A lubricant and its table in the machine's file."""
    density = random.uniform(850.0, 1950.0)
    low, high = 40.0 + ZERO, 200.0 + ZERO
    thin = random.uniform(4.0, 15.0)  # mm^2/s at 200 degC
    thick = thin * np.exp(random.uniform(3.2, 4.6))
    if random.uniform() < 0.6:
        y = [np.log10(np.log10(each + 0.7)) for each in (thick, thin)]
        b = (y[0] - y[1]) / np.log10(high / low)
        oil = Oil("walther", (y[0] + b * np.log10(low), b), density)
        text = f'viscosities = [["40 degC", "{thick:.9g} mm^2/s"], ["200 degC", "{thin:.9g} mm^2/s"]]'
        return oil, f'model = "walther"\n{text}\ndensity = "{density:.9g} kg/m^3"'
    c = random.uniform(140.0, 200.0)
    cold, hot = np.log(np.array([thick, thin]) * 1e-6 * density)
    b = (cold - hot) / (1 / (low - c) - 1 / (high - c))
    oil = Oil("vogel", (cold - b / (low - c), b, c), density)
    points = ", ".join(f'["{t:g} degC", "{float(oil.viscosity(t + ZERO)):.9g} Pa*s"]' for t in (40, 100, 200))
    return oil, f'model = "vogel"\nviscosities = [{points}]\ndensity = "{density:.9g} kg/m^3"'


def _drawn_drive(random: np.random.Generator, aim: str) -> tuple[Drive, Duty, str]:
    oil, text = _oil(random)
    radius, length = random.uniform(0.010, 0.025), random.uniform(0.2, 0.33)
    load = random.uniform(150.0, 450.0)
    fast = random.uniform(0.15, 0.4)
    cold, hot = random.uniform(50.0, 100.0) + ZERO, random.uniform(150.0, 200.0) + ZERO
    slow = fast * random.uniform(0.12, 0.5)
    made = {
        "radius": radius,
        "length": length,
        "load": load,
        "modulus": random.uniform(0.4e6, 1.2e6),
        "poisson": random.uniform(0.46, 0.49),
        "rubber": random.uniform(2.5e-3, 0.4 * radius),
        "stiffness": 10 ** random.uniform(3.7, 4.7),
        "mass": random.uniform(3.0, 20.0),
        "stick": 10 ** random.uniform(-3.0, -2.2),
        "oil": Oil(oil.kind, oil.numbers, oil.density),
        "film_factor": np.exp(random.normal(0.0, 0.1)),
        "sharpness": random.uniform(2.5, 5.0),
        "summits": random.uniform(1.5, 4.0),
        "friction": random.uniform(0.03, 0.1),
        "roughness": 1e-6,
        "rest": 0.0,
        "rest_per_speed": 0.0,
        "rest_slope": 0.0,
        "reference": hot,
        "rolling": random.uniform(0.0, 0.2),
    }
    drive = Drive(**made)
    film = float(drive.flooded(oil.viscosity(hot) * slow))
    plain = float(torque(drive, NEW, np.array(fast), cold)[0])
    rest = plain * random.uniform(0.15, 0.8)
    slope = -random.uniform(0.0, 0.002)
    if aim == "hot":  # gears that bind as they warm: the only way to more torque there, and no falling branch
        rest, slope = plain * random.uniform(2.0, 5.0), random.uniform(0.003, 0.006)
    ready = made | {
        "roughness": film / random.uniform(5.0, 16.0),
        "rest": rest,
        "rest_slope": slope,
        "rest_per_speed": rest * random.uniform(0.0, 0.3) * radius / fast,
    }
    use = [
        random.uniform(*ends)
        for ends in ((0.5, 0.9), (0.25, 0.5), (0.01, 0.2), (0.02, 0.5), (1.0, 4.0), (4.0, 9.0))
    ]
    return Drive(**ready), Duty(fast, cold, slow, hot, hot, *use), text


def _drawn_states(
    random: np.random.Generator, drive: Drive, duty: Duty, aim: str
) -> tuple[State, dict[str, str]]:
    """How the units of the population age; every process has one shape in a campaign."""
    said: dict[str, str] = {}

    def spread(deviation: float) -> np.ndarray:
        values = np.exp(random.normal(0.0, deviation, ALL))
        values[MEDIAN] = 1.0
        return values

    def pace() -> np.ndarray:
        return spread(random.uniform(0.1, 0.35))

    def first(deviation: float) -> np.ndarray:
        return spread(deviation)

    def factor(name: str, likely: float, most: float, deviation: float) -> np.ndarray:
        final, shape = 1.0, "none"
        if random.uniform() < likely:
            final = 1 + (most - 1) * random.uniform(0.2, 1.0)
            shape = str(random.choice(["linear", "exponential", "saturating"]))
        said[name] = shape if shape == "none" else f"{shape} {final:.2f}"
        return first(deviation)[:, None] * _grown(shape, final, pace(), random.uniform(0.5, 1.5))

    rub = aim == "stick"
    thicker = factor("thicker", 0.25 if rub else 0.7, 2.2, 0.03)
    rougher = factor("rougher", 0.9 if rub else 0.3, 1.7, 0.07)
    friction = factor("friction", 0.9 if rub else 0.4, 2.2, 0.05)
    rest = factor("rest", 1.0 if aim == "hot" else 0.4, 1.8, 0.06)
    shape = (ALL, AGES.size)
    said["layer"] = "flooded"
    layer = np.full(shape, 1e-2)
    if aim == "starve" or random.uniform() < 0.35:
        film = float(drive.flooded(drive.oil.viscosity(duty.usual) * duty.fast))
        begin = film * random.uniform(1.4, 3.0)
        # The layer that starves the film, and the age at which the median unit has it.
        end, at = film, 1.0 if aim == "starve" else random.uniform(0.9, 3.0)
        share, back = random.uniform(0.0, 1.0), random.choice([0.0, 0.0, 0.1])
        ratio = begin / end
        gone = share * np.log(ratio) / at
        grown = np.exp(2 * gone * at)
        flow = (ratio**2 - grown) / (at if gone == 0 else (grown - 1) / (2 * gone))
        layer = begin * _thinned(first(0.1), flow * pace(), gone * pace(), back * gone)
        said["layer"] = f"starved near {at:.2f}, {share:.0%} evaporation"
    return State(thicker, layer, rougher, friction, rest), said


def _crossing(path: np.ndarray, limit: float) -> np.ndarray:
    """First age at which each row reaches the limit; infinite if it does not."""
    over = path >= limit
    i = np.argmax(over, axis=1)
    row = np.arange(path.shape[0])
    before, after = path[row, np.maximum(i - 1, 0)], path[row, i]
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.where(after > before, (limit - before) / (after - before), 1.0)
    age = AGES[np.maximum(i - 1, 0)] + share * (AGES[1] - AGES[0])
    return np.where(over.any(axis=1), np.where(i == 0, 0.0, age), np.inf)


def _folds(
    drive: Drive, states: State, kelvin: float, clock: np.ndarray = _COARSE
) -> tuple[np.ndarray, np.ndarray]:
    """Fold and speed of least drag of every unit over `AGES`, from a coarser clock."""
    at = np.searchsorted(AGES, clock)
    few = State(*(getattr(states, name)[:, at].ravel() for name in STATES))
    fold, least = (each.reshape(-1, at.size) for each in fold_speed(drive, few, kelvin))
    return tuple(np.stack([np.interp(AGES, clock, row) for row in each]) for each in (fold, least))  # type: ignore[return-value]


def draw(seed: int) -> World:
    """A campaign in which the median unit ends by the way aimed at, others by any."""
    random = np.random.default_rng([seed, 1414])
    aim = AIMS[seed % len(AIMS)]
    for _ in range(300):
        world = _tried(random, aim)
        if world is not None:
            return world
    raise RuntimeError(f"seed {seed}: no campaign ends by {aim}")


def _energy(drive: Drive, duty: Duty, fast: np.ndarray, slow: np.ndarray) -> np.ndarray:
    """Work of the roll on a page: power over pages in time."""
    power = (duty.share * fast * duty.fast + (1 - duty.share) * slow * duty.slow) / drive.radius
    return power * duty.travel / (duty.share * duty.fast + (1 - duty.share) * duty.slow)


def _damage(duty: Duty, cold: np.ndarray, fast: np.ndarray, slow: np.ndarray) -> np.ndarray:
    """Damage of starts since new, but for a factor: cycles from none to the torque, by the slope alone."""
    warm = duty.share * fast**duty.slope + (1 - duty.share) * slow**duty.slope
    rate = duty.cold_starts * cold**duty.slope + (1 - duty.cold_starts) * warm
    steps = 0.5 * (rate[:, 1:] + rate[:, :-1]) * np.diff(AGES)
    return np.concatenate([np.zeros((rate.shape[0], 1)), np.cumsum(steps, axis=1)], axis=1)


def _tried(random: np.random.Generator, aim: str) -> World | None:
    drive, duty, oil = _drawn_drive(random, aim)
    states, said = _drawn_states(random, drive, duty, aim)

    def at(speed: float, kelvin: float) -> np.ndarray:
        return torque(drive, states, np.array(speed), kelvin)[0]

    median = State(*(getattr(states, name)[[MEDIAN]] for name in STATES))
    # Stick-slip is looked at where the machine is hot; the slow point is set where it stands or well above.
    least = _folds(drive, median, duty.hot, _COARSE[::2])[1][0]
    margin = {"stick": 1.0}.get(aim, 1.05 * np.exp(abs(random.normal(0.0, 0.5))))
    reached = float(np.interp(margin, AGES, least))
    slow = duty.slow
    grows = reached > 1.15 * least[0] > 0.0
    if aim == "stick" or grows:
        slow = reached
        if not (0.05 * duty.fast < slow < 0.7 * duty.fast and grows):
            return None
    elif least[: AGES.searchsorted(2.0)].max() > 0.8 * slow:
        return None
    duty = replace(duty, slow=slow)
    # Of the population behind the units a coarser clock is enough.
    parts = [_folds(drive, states[:UNITS], duty.hot), _folds(drive, states[UNITS:], duty.hot, _COARSE[::2])]
    folds, leasts = (np.concatenate(each) for each in zip(*parts, strict=True))
    dry = torque(drive, states, np.array(duty.fast), duty.usual)[1]
    # The age at which the median unit ends: near 1, where oil alone does not say when.
    end = 1.0
    if aim == "starve":
        end = float(_crossing(dry[[MEDIAN]], 1.0)[0])
        if not 0.5 < end < 2.5:
            return None
    values = {
        "cold": at(duty.fast, duty.cold),
        "hot": at(duty.slow, duty.hot),
        "grip": at(duty.fast, duty.cold) / drive.radius,
        "stick": leasts,
        "fold": folds,
        "starve": dry,
        "continuous": np.sqrt(
            duty.share * at(duty.fast, duty.hot) ** 2 + (1 - duty.share) * at(duty.slow, duty.hot) ** 2
        ),
        "energy": _energy(drive, duty, at(duty.fast, duty.hot), at(duty.slow, duty.hot)),
        "gear": _damage(duty, at(duty.fast, duty.cold), at(duty.fast, duty.hot), at(duty.slow, duty.hot)),
    }
    limits = {"stick": slow, "fold": slow, "starve": 1.0}

    def limit(path: np.ndarray, own: bool) -> float | None:
        age = end * (1.0 if own else 1.05 * np.exp(abs(random.normal(0.0, 0.5))))
        level = float(np.interp(age, AGES, path))
        if own:
            return level if level > 1.2 * path[0] else None
        return max(level, 1.15 * float(path[0]))

    worst = np.maximum(values["cold"], values["hot"])[MEDIAN]
    if aim in ("cold", "hot"):
        other = {"cold": "hot", "hot": "cold"}[aim]
        if (motor := limit(values[aim][MEDIAN], True)) is None:
            return None
        if values[other][MEDIAN, AGES <= 1.05].max() > 0.97 * motor:
            return None
    else:
        motor = limit(worst, False)
    limits["cold"] = limits["hot"] = motor
    for name in ("grip", "continuous", "energy"):
        if (found := limit(values[name][MEDIAN], aim == name)) is None:
            return None
        limits[name] = found
    over = 1.0 if aim == "gear" else 1.05 * np.exp(abs(random.normal(0.0, 0.5)))
    limits["gear"] = float(np.interp(end * over, AGES, values["gear"][MEDIAN]))
    if aim == "stick" and not 0.9 < float(_crossing(values[aim][[MEDIAN]], limits[aim])[0]) < 1.1:
        return None
    ages = {name: _crossing(values[name], limits[name]) for name in values}
    return World(aim, drive, duty, states, values, limits, ages, said, oil)


# --- the stand -------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Log:
    """A table of means, as the stand hands it over."""

    unit: str
    age: float  # over the life aimed at
    columns: dict[str, np.ndarray]


def logs_of(world: World, random: np.random.Generator, count: int = 10) -> tuple[list[Log], float]:
    """Some ``count`` logs of each unit up to 60 % of the median of the true ages, and that age."""
    ends = np.min([world.ages[name] for name in AIMS], axis=0)[:UNITS]
    stop = 0.6 * float(np.median(ends))
    drive, duty = world.drive, world.duty
    kelvins = np.linspace(duty.cold, duty.hot, random.integers(5, 9))
    # A stand that is stiff enough goes below the speed of least drag; not every laboratory does.
    least = float(world.indicators["stick"][MEDIAN, 0])
    slowest = min(duty.slow * random.uniform(0.25, 0.9), (least or np.inf) * random.uniform(0.3, 1.2))
    speeds = np.geomspace(slowest, duty.fast * random.uniform(1.0, 1.1), random.integers(8, 15))
    grid = [each.ravel() for each in np.meshgrid(speeds, kelvins)]
    gain = 1 + random.normal(0.0, 0.004)
    found = []
    for unit in range(UNITS):
        own = max(3, count - int(random.integers(0, 3)))
        at = np.sort(random.uniform(0.0, 1.0, own))
        at[0] *= random.choice([0.0, 1.0])
        for age in at * stop:
            now = State(
                *(np.array(np.interp(age, AGES, getattr(world.states, name)[unit])) for name in STATES)
            )
            true = torque(drive, now, *grid)[0]
            keep = true < world.limits["cold"]
            if random.uniform() < 0.1:
                keep &= random.uniform(size=keep.size) < 0.6
            read = true * gain * (1 + random.normal(0.0, 0.002)) + random.normal(0.0, 0.002 * true.max())
            read = read * (1 + random.normal(0.0, 0.01, true.size))
            if keep.sum() < 8:
                continue
            found.append(
                Log(
                    f"F{unit + 1}",
                    age,
                    {
                        "speed [rpm]": (grid[0] / drive.radius * 30 / np.pi)[keep],
                        "temperature [degC]": (grid[1] - ZERO + random.normal(0.0, 0.3))[keep],
                        "torque [N*m]": read[keep],
                        "torque error [N*m]": 0.01 * np.abs(read[keep]),
                    },
                )
            )
    return found, stop


def machine_file(world: World, scale: float) -> str:
    """What the engineer states of the machine; ``scale`` pages are the life aimed at."""
    d, u, limits = world.drive, world.duty, world.limits
    cycles = 2e6
    amplitude = 0.5 * u.ratio * (u.starts * scale * limits["gear"] / cycles) ** (1 / u.slope)
    return f"""
[drivetrain]
stiffness = "{d.stiffness:.9g} N/m"
mass = "{d.mass:.9g} kg"
roll_radius = "{d.radius:.9g} m"
stick_speed = "{d.stick:.9g} m/s"
stick_speed_temperature = "{u.hot - ZERO:.9g} degC"
stick_speed_rule = "fixed"

[limits]
motor_torque = "{limits["cold"]:.9g} N*m"
roll_friction = {limits["grip"] / d.load:.9g}
nip_load = "{d.load:.9g} N"
speed = "{u.fast:.9g} m/s"

[life]
coldest = "{u.cold - ZERO:.9g} degC"
travel = "{u.travel:.9g} m"
energy = "{limits["energy"]:.9g} J"
continuous_torque = "{limits["continuous"]:.9g} N*m"

[gear]
torque = "{amplitude:.9g} N*m"
cycles = {cycles:.9g}
slope = {u.slope:.9g}
ratio = {u.ratio:.9g}
starts = "{1000 * u.starts:.9g} per 1000 pages"
cold_starts = "{100 * u.cold_starts:.9g} %"

[contact]
rubber_thickness = "{d.rubber:.9g} m"
modulus = "{d.modulus:.9g} Pa"
poisson_ratio = {d.poisson:.9g}
length = "{d.length:.9g} m"
roughness = "{d.roughness:.9g} m"

[lubricant]
name = "oil"
{world.oil}
uncertainty = "15 %"

[[points]]
name = "full speed"
speed = "{u.fast:.9g} m/s"
temperature = "{u.hot - ZERO:.9g} degC"
share = "{100 * u.share:.9g} %"

[[points]]
name = "thick paper"
speed = "{u.slow:.9g} m/s"
temperature = "{u.hot - ZERO:.9g} degC"
share = "{100 * (1 - u.share):.9g} %"
"""


class _NoFit:
    """A run needs a fit to be added quickly; what is judged here does not ask for it."""

    def to_dict(self) -> dict[str, object]:
        return {"transition": None, "coefficients": {"c": {"value": -0.6}}}


def campaign_of(logs: list[Log], scale: float, folder: Path) -> object:
    """The file of a campaign with all logs, ages in pages."""
    from hersey.damping.dwells import SteadyPoints
    from hersey.life.age import Age
    from hersey.life.campaign import Campaign
    from hersey.life.campaign.kept import entry_of

    campaign = Campaign.create(folder / "life.hersey")
    rows = []
    for i, log in enumerate(logs):
        entry = entry_of(SteadyPoints.from_table(log.columns), folder / f"{i}.csv", fit=_NoFit())  # type: ignore[arg-type]
        rows.append((entry, log.unit, Age(log.age * scale, "pages")))
    campaign.add_entries(rows)
    return campaign


# --- the judgement ---------------------------------------------------------------------------------------

#: A second end so much later than the first leaves no doubt; one nearer is to be named with it.
CLEAR = 1.15
#: What a test of so many times its length may be asked: ends beyond are not judged by their age.
NEAR = 3.0


def way_of(name: str, point: str = "thick paper") -> str | None:
    """The way of this file that an indicator of hersey is; None where it is another (or another point)."""
    for word, corner in (("cold and fast", "cold"), ("hot and slow", "hot")):
        if "motor torque" in name and word in name:
            return corner
    if "stick-slip" in name:
        return None if point not in name else "fold" if "rest" in name or "fold" in name else "stick"
    if "grip" in name:
        return None if "rest" in name else "grip"
    words = {"layer": "starve", "gear": "gear", "continuous": "continuous", "energy": "energy"}
    return next((way for word, way in words.items() if word in name), None)


@dataclass(frozen=True)
class Told:
    """An age told: truth, ends of the interval, median, over the age at which the unit was last seen."""

    way: str
    true: float
    low: float
    middle: float
    high: float


@dataclass(frozen=True)
class First:
    """What ends a unit first: in truth with the two first ages, and as named."""

    way: str
    second: str
    ratio: float
    named: tuple[str, ...]
    far: bool  #: beyond `NEAR` times the age last seen


@dataclass(frozen=True)
class Outcome:
    """What one campaign tells."""

    seed: int
    aim: str
    ages: tuple[Told, ...]
    firsts: tuple[First, ...]
    first_ages: tuple[Told, ...]
    shares: tuple[Told, ...]  #: B10 and B50 of the first of all ends
    unsaid: tuple[str, ...]
    seconds: float
    wrong: str = ""


def campaign(seed: int, folder: Path) -> Outcome:
    """Draw a campaign, ask hersey what ends its units, and set it beside the truth."""
    from hersey.life.depletion import film_life
    from hersey.life.ending import endings
    from hersey.life.indicators import indicators_of

    from hersey.machine.machine import read_machine

    world, random = draw(seed), np.random.default_rng([seed, 77])
    logs, stop = logs_of(world, random)
    scale = 10 ** random.uniform(3, 6)
    (folder / "machine.toml").write_text(machine_file(world, scale))
    machine, kept = read_machine(folder / "machine.toml"), campaign_of(logs, scale, folder)
    begin = time.process_time()
    found = indicators_of(kept, machine)
    found = film_life(kept, machine).with_starvation(found)
    told = endings(found)
    seconds = time.process_time() - begin
    last = {name: max(log.age for log in logs if log.unit == name) for name in {log.unit for log in logs}}

    def aged(way: str, true: float, unit: object, by: float) -> Told:
        age = unit.age  # type: ignore[attr-defined]
        return Told(way, true / by, *(each / scale / by for each in (age.low, age.value, age.high)))

    ages = [
        aged(way, world.ages[way][int(each.unit[1:]) - 1], each, last[each.unit])
        for mode in told.modes
        if (way := way_of(mode.name)) is not None
        for each in mode.ages.units
    ]
    all_ages = np.min([world.ages[name] for name in AIMS], axis=0)
    firsts, first_ages = [], []
    for end in told.units:
        own = int(end.unit[1:]) - 1
        order = sorted(AIMS, key=lambda name: world.ages[name][own])
        one, two = (float(world.ages[name][own]) for name in order[:2])
        named = tuple(way_of(name) or name for name in end.named)
        far = one > NEAR * last[end.unit]
        firsts.append(First(order[0], order[1], two / max(one, 1e-9), named, far))
        first_ages.append(aged("first", one, end.age, last[end.unit]))
    population = np.delete(all_ages, MEDIAN)
    b10, b50 = np.quantile(population, [0.1, 0.5], method="inverted_cdf")
    shares = [aged("B10", b10, told.b10, stop), aged("B50", b50, told.b50, stop)]
    return Outcome(
        seed, world.aim, tuple(ages), tuple(firsts), tuple(first_ages), tuple(shares), told.unsaid, seconds
    )


def _held(ages: list[Told]) -> list[str]:
    """Cells: how many, held, truth below, above, median width."""
    if not ages:
        return ["0", "", "", "", ""]
    true, low, high = (np.array([getattr(each, name) for each in ages]) for name in ("true", "low", "high"))
    inside = (low <= true) & (true <= high)
    with np.errstate(invalid="ignore"):
        width = np.median(np.where(np.isfinite(high), (high - low) / true, np.inf))
    return [
        str(len(ages)),
        f"{inside.mean():.0%}",
        f"{(true < low).mean():.0%}",
        f"{(true > high).mean():.0%}",
        f"{width:.2f}",
    ]


def table(outcomes: list[Outcome]) -> list[str]:
    """Return the lines of the tables: ages held by way, and which end is named first."""
    good = [each for each in outcomes if not each.wrong]
    ages = [age for each in good for age in each.ages]
    lines = [
        "| age of | intervals | hold the truth | truth below | truth above | width over age, median |",
        "|" + "---|" * 6,
    ]
    near = [age for age in ages if age.true <= NEAR]
    groups = {"torque limit (cold or hot corner)": ("cold", "hot")} | {way: (way,) for way in (*AIMS, "fold")}
    for name, ways in groups.items():
        lines.append("| " + " | ".join([name, *_held([age for age in near if age.way in ways])]) + " |")
    lines.append(
        "| first of all | "
        + " | ".join(_held([age for each in good for age in each.first_ages if age.true <= NEAR]))
        + " |"
    )
    for name in ("B10", "B50"):
        lines.append(
            f"| {name} | "
            + " | ".join(_held([age for each in good for age in each.shares if age.way == name]))
            + " |"
        )
    lines += [
        "",
        "| truly first | units | clear | named first | named at all | near | both named | sure, but wrong |",
        "|" + "---|" * 8,
    ]
    firsts = [first for each in good for first in each.firsts if not first.far]
    for way in (*AIMS, "all"):
        own = [first for first in firsts if way in (first.way, "all")]
        if not own:
            continue
        clear, both = [f for f in own if f.ratio > CLEAR], [f for f in own if f.ratio <= CLEAR]
        right = [f.named[:1] == (f.way,) for f in clear]
        among = [f.way in f.named for f in clear]
        two = [f.way in f.named and f.second in f.named for f in both]
        sure = [len(f.named) == 1 and f.named != (f.way,) for f in own]
        cells = [
            way,
            len(own),
            len(clear),
            _share(right),
            _share(among),
            len(both),
            _share(two),
            _share(sure),
        ]
        lines.append("| " + " | ".join(map(str, cells)) + " |")
    return lines


def _share(values: list[bool]) -> str:
    return f"{np.mean(values):.0%}" if values else ""


def _tried_campaign(seed: int) -> Outcome:
    with tempfile.TemporaryDirectory() as folder:
        try:
            return campaign(seed, Path(folder))
        except Exception as error:  # a fault is told, and does not end the others
            return Outcome(
                seed, AIMS[seed % len(AIMS)], (), (), (), (), (), 0.0, f"{type(error).__name__}: {error}"
            )


def main() -> None:
    """Run the campaigns and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--campaigns", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1001, help="first seed")
    parser.add_argument("--processes", type=int, default=1)
    given = parser.parse_args()
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    seeds = range(given.seed, given.seed + given.campaigns)
    outcomes: list[Outcome] = []
    with ProcessPoolExecutor(given.processes) as pool:
        for each in pool.map(_tried_campaign, seeds):
            outcomes.append(each)
            print(
                f"{len(outcomes)} of {given.campaigns}: seed {each.seed}, {each.seconds:.0f} s {each.wrong}",
                file=sys.stderr,
                flush=True,
            )
    print("\n".join(table(outcomes)))
    seconds = np.array([each.seconds for each in outcomes])
    print(
        f"\nprocessor: {np.median(seconds):.1f} s in the median, {seconds.max():.1f} s at the most"
    )
    for each in outcomes:
        if each.wrong:
            print(f"seed {each.seed}: {each.wrong}")


if __name__ == "__main__":
    main()
