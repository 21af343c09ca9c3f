"""Units that age in truth: a generator of life tests of its own, for `benchmarks.life`.

It shares no code with hersey: its own drive, oil, film, asperities and ageing, its own motion for the speed
from which stick-slip cannot last, and its own look-up of the age at which each limit is first reached.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

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
            return np.asarray(np.exp(a + b / (t - c)))
        a, b = self.numbers
        return np.asarray(self.density * 1e-6 * (10 ** (10 ** (a - b * np.log10(t))) - 0.7))


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
        return np.asarray(self.film_factor * 0.93 * 3.1 * self.radius * speed**0.6 * load**-0.2)


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
        return np.asarray((k * stretch - below - (at - i) * (flat[offset + i + 1] - below)) / m)

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
        return np.asarray(np.exp(np.minimum(np.log(final) * x, 5.0)))
    if shape == "saturating":
        whole = (final - 1) / -np.expm1(-1 / tau)
        return np.asarray(1 + whole * pace[:, None] * -np.expm1(-AGES / tau))
    return np.asarray(1 + (final - 1) * x)


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
    """A lubricant and its table in the machine file."""
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
        return np.asarray(first(deviation)[:, None] * _grown(shape, final, pace(), random.uniform(0.5, 1.5)))

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
    assert motor is not None  # only one of its own can be refused
    limits["cold"] = limits["hot"] = motor
    for name in ("grip", "continuous", "energy"):
        if (level := limit(values[name][MEDIAN], aim == name)) is None:
            return None
        limits[name] = level
    over = 1.0 if aim == "gear" else 1.05 * np.exp(abs(random.normal(0.0, 0.5)))
    limits["gear"] = float(np.interp(end * over, AGES, values["gear"][MEDIAN]))
    if aim == "stick" and not 0.9 < float(_crossing(values[aim][[MEDIAN]], limits[aim])[0]) < 1.1:
        return None
    ages = {name: _crossing(values[name], limits[name]) for name in values}
    return World(aim, drive, duty, states, values, limits, ages, said, oil)
