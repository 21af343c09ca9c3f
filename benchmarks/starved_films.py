"""Specimens whose film starves by laws that the product does not have, for `benchmarks.starvation`.

The generator shares no code with hersey. The share of the flooded film that a layer of oil leaves is one of

==========  =========================================================================================
tanh        tanh of layer over flooded film
fading      one minus an exponential of it, both to the power 1.5
reynolds    what the contact gets, up to the flooded flow, averaged over a layer that varies around the
            roll; shear and rolling then come from a table of `benchmarks.starved_inlet`
mixed       tanh, with faces so rough that summits carry a part of the load
==========  =========================================================================================

Part of the drag does not follow the film. It varies as a power of viscosity times speed, and either as a
power of the film that is left (rolling) or not at all with the state of the oil (seals, gears).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

ZERO = 273.15
LAWS = ("tanh", "fading", "reynolds", "mixed")
#: Shares of the drag, flooded, at full speed and hot, that do not follow the film.
SHARES = (0.0, 0.05, 0.15, 0.3, 0.4)
UNITS = 8
#: Film over flooded film below which a film is starved.
STARVED = 0.5 ** (1.0 / 3.0)
#: Ages on which truth is looked up, over the median age of starvation.
AGES = np.linspace(0.0, 6.0, 1201)

#: Flow, shear and rolling over those of a flooded contact: `python -m benchmarks.starved_inlet` at 1.4e-3.
FLOW = np.array([0.0, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98, 1.0])
SHEAR_BY_FLOW = np.array([0.978, 0.980, 0.980, 0.982, 0.983, 0.985, 0.986, 0.987, 0.988, 0.990, 1.0])
ROLLING = np.array([0.0, 0.009, 0.021, 0.039, 0.068, 0.110, 0.177, 0.295, 0.408, 0.543, 1.0])
#: Places around the roll, as its layer over the mean one.
AROUND = np.sin(2.0 * np.pi * (np.arange(16) + 0.5) / 16.0)


@dataclass(frozen=True)
class Drive:
    """All that does not age, in SI; speeds are those of the belt."""

    law: str
    share: float  #: of drag that does not follow the film, flooded, at `fast` and `hot`
    by_speed: float  #: power of viscosity times speed of that drag
    by_film: float | None  #: power of the film that is left; None: nothing of the oil's state counts
    varies: float  #: of the layer around the roll
    radius: float
    length: float
    width: float
    load: float
    modulus: float
    rubber: float
    film_factor: float
    roughness: float
    friction: float
    rest: float
    rest_per_speed: float
    rest_slope: float
    thick: float  #: mm^2/s at 40 degC
    thin: float  #: at 200 degC
    density: float
    fast: float
    cold: float
    hot: float

    def viscosity(self, kelvin: np.ndarray | float) -> np.ndarray:
        """Return Pa s, by ASTM D341."""
        y = np.log10(np.log10(np.array([self.thick, self.thin]) + 0.7))
        slope = (y[1] - y[0]) / np.log10((200.0 + ZERO) / (40.0 + ZERO))
        line = y[0] + slope * np.log10(np.asarray(kelvin) / (40.0 + ZERO))
        return np.asarray(self.density * 1e-6 * (10.0**10.0**line - 0.7))

    def flooded(self, product: np.ndarray) -> np.ndarray:
        """Return the film of a flooded inlet, m, at viscosity times speed."""
        two = 2.0 * self.modulus / (1.0 - 0.48**2)
        speed, load = 0.5 * product / (two * self.radius), self.load / self.length / (two * self.radius)
        return np.asarray(2.9 * self.film_factor * self.radius * speed**0.6 * load**-0.2)

    def left(self, ratio: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return film, shear and rolling over those flooded, at a layer over the flooded film."""
        if self.law == "reynolds":
            flow = np.clip(ratio[..., None] * (1.0 + self.varies * AROUND), 1e-3, 1.0)
            sheared = np.mean(np.interp(flow, FLOW, SHEAR_BY_FLOW) / flow, axis=-1)
            return flow.mean(axis=-1), sheared, np.mean(np.interp(flow, FLOW, ROLLING), axis=-1)
        film = (-np.expm1(-(ratio**1.5))) ** (1.0 / 1.5) if self.law == "fading" else np.tanh(ratio)
        return film, 1.0 / film, film ** (self.by_film or 0.0)


@dataclass(frozen=True)
class State:
    """What has aged: factors, and the layer in m."""

    thicker: np.ndarray | float
    layer: np.ndarray | float
    rougher: np.ndarray | float
    rest: np.ndarray | float


def torque(drive: Drive, state: State, speed: np.ndarray, kelvin: np.ndarray) -> np.ndarray:
    """Return the whole torque, N m."""
    new = drive.viscosity(kelvin) * speed
    product = state.thicker * new
    flooded = drive.flooded(product)
    film, sheared, rolled = drive.left(state.layer / flooded)
    area = drive.width * drive.length
    shear = product / flooded * area
    reference = drive.viscosity(drive.hot) * drive.fast
    other = drive.share / (1.0 - drive.share) * reference / drive.flooded(reference) * area
    if drive.by_film is None:
        other = other * (new / reference) ** drive.by_speed
    else:
        other = other * (product / reference) ** drive.by_speed * rolled
    touch = np.exp(-((film * flooded / (1.4 * drive.roughness * state.rougher)) ** 2))
    rest = state.rest * (drive.rest + drive.rest_per_speed * speed)
    rest = rest * (1.0 + drive.rest_slope * (kelvin - drive.hot))
    rubbed = touch * drive.friction * drive.load
    return np.asarray(drive.radius * (shear * sheared * (1.0 - touch) + rubbed + other) + rest)


@dataclass(frozen=True)
class World:
    """A campaign as it truly is: states of its specimens at `AGES`, and when they starve.

    ``thin`` are the ages at which the layer is as thin as the flooded film.
    """

    drive: Drive
    states: State
    thin: np.ndarray
    starved: np.ndarray

    def at(self, unit: int, age: float) -> State:
        """Return the state of a specimen at an age."""
        of = (self.states.thicker, self.states.layer, self.states.rougher, self.states.rest)
        return State(*(float(np.interp(age, AGES, each[unit])) for each in of))  # type: ignore[index]


def draw(seed: int) -> World:
    """Return a campaign; laws and shares take turns."""
    random = np.random.default_rng([seed, 2718])
    law, share = LAWS[seed % len(LAWS)], SHARES[seed // len(LAWS) % len(SHARES)]
    while True:
        drive = _drive(random, law, share)
        states = _states(random, drive)
        product = states.thicker * drive.viscosity(drive.hot) * drive.fast
        over = states.layer / drive.flooded(product)
        # The median specimen starves near age 1, whatever its oil does.
        thin = np.array([np.interp(0.0, -np.log(row), AGES, right=np.inf) for row in over])
        if 0.6 < np.median(thin) < 2.0 and over[:, 0].min() > 1.2:
            lost, most = -np.log(drive.left(over)[0]), -np.log(STARVED)
            starved = np.array([np.interp(most, row, AGES, right=np.inf) for row in lost])
            return World(drive, states, thin, starved)


def _drive(random: np.random.Generator, law: str, share: float) -> Drive:
    fast, cold, hot = (
        random.uniform(*ends)
        for ends in ((0.15, 0.35), (50.0 + ZERO, 85.0 + ZERO), (150.0 + ZERO, 195.0 + ZERO))
    )
    thin = random.uniform(4.0, 12.0)
    radius, length = random.uniform(0.011, 0.022), random.uniform(0.2, 0.3)
    seals = random.uniform() < 0.3
    made = {
        "law": law,
        "share": share,
        "by_speed": random.uniform(0.35, 0.85),
        "by_film": None if seals else random.uniform(0.5, 4.0),
        "varies": random.uniform(0.1, 0.4),
        "radius": radius,
        "length": length,
        "width": 0.42 * radius * random.uniform(0.9, 1.1),
        "load": random.uniform(200.0, 400.0),
        "modulus": random.uniform(0.5e6, 1.0e6),
        "rubber": 0.24 * radius,
        "film_factor": float(np.exp(random.normal(0.0, 0.1))),
        "roughness": 1e-7,
        "friction": random.uniform(0.04, 0.1),
        "rest": 0.0,
        "rest_per_speed": 0.0,
        "rest_slope": -random.uniform(0.0, 0.001),
        "thick": thin * float(np.exp(random.uniform(3.3, 4.5))),
        "thin": thin,
        "density": random.uniform(900.0, 1900.0),
        "fast": fast,
        "cold": cold,
        "hot": hot,
    }
    drive = Drive(**made)
    film = float(drive.flooded(drive.viscosity(hot) * fast))
    plain = radius * float(drive.viscosity(hot)) * fast / film * drive.width * length
    rest = plain * random.uniform(0.3, 1.5)
    lift = random.uniform(2.5, 6.0) if law == "mixed" else random.uniform(8.0, 20.0)
    ready = {"roughness": film / lift, "rest": rest, "rest_per_speed": rest * random.uniform(0.0, 0.3) / fast}
    return Drive(**made | ready)


def _states(random: np.random.Generator, drive: Drive) -> State:
    def spread(deviation: float) -> np.ndarray:
        return np.exp(random.normal(0.0, deviation, UNITS))[:, None]

    pace = spread(random.uniform(0.1, 0.3))
    thicker = spread(0.03) * np.exp(np.minimum(random.uniform(0.0, 0.4) * pace * AGES, 1.5))
    rougher = spread(0.05) * (1.0 + random.uniform(0.0, 0.4) * pace * AGES)
    rest = spread(0.04) * (1.0 + random.uniform(0.0, 0.15) * AGES)
    film = float(drive.flooded(drive.viscosity(drive.hot) * drive.fast))
    begin, dried = film * random.uniform(1.6, 3.5), random.uniform(0.0, 1.0)
    new, cubic = begin / film, 2.0 * (1.0 - dried)
    # Side flow and evaporation so that the median layer is the flooded film near age 1.
    rate = random.uniform(0.7, 1.1) * np.log(new) * pace
    layer, step = np.empty((UNITS, AGES.size)), (AGES[1] - AGES[0]) / 8.0
    at = spread(0.1)[:, 0]
    for i in range(AGES.size):
        layer[:, i] = begin * at
        for _ in range(8):
            at = at * np.exp(-step * rate[:, 0] * (dried + cubic * at**2))
    return State(thicker, layer, rougher, rest)
