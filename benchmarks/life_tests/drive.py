"""The machine of a campaign: oil, nip, asperities, what drags, and its machine file."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from benchmarks.life_tests import films
from benchmarks.life_tests.states import State

Array = NDArray[np.float64]

RADIUS, LENGTH, LOAD = 0.015, 0.22, 300.0
RUBBER, MODULUS, POISSON = 0.0035, 0.65e6, 0.48
FAST, HOT, COLD = 0.2, 453.15, 333.15
#: Nip over thickness against load number, by a spectral solution for Poisson's ratios of 0.45 and 0.49.
NIPS = np.array([0.4, 1, 1.5, 2, 3, 4, 6, 10])
LOADS = {
    0.45: np.array([0.032556, 0.2389, 0.64467, 1.3821, 4.3697, 10.349, 36.585, 187.6]),
    0.49: np.array([0.032668, 0.24358, 0.67011, 1.468, 4.8606, 12.086, 47.287, 295.52]),
}
SPEEDS = np.logspace(np.log10(2e-3), 0, 60)


def nip_width() -> float:
    """Return the width of the nip, m."""
    number = LOAD / LENGTH * RADIUS / (MODULUS / (1 - POISSON**2) * RUBBER**2)
    low, high = (np.interp(np.log(number), np.log(LOADS[nu]), np.log(NIPS)) for nu in (0.45, 0.49))
    return float(np.exp(low + (high - low) * (POISSON - 0.45) / 0.04) * RUBBER)


@dataclass(frozen=True)
class Drive:
    """Machine without age. Speeds in m/s at the belt, temperatures in K, torque in N m at the roll."""

    #: Viscosity A exp(B / (T - C)).
    oil: tuple[float, float, float]
    #: Viscosity of the data sheet over that in the nip.
    sheet: float
    film_gain: float
    roughness: float
    summits: float
    stiffness: float
    friction: float
    rest: tuple[float, float]
    #: Share of rolling in the drag of the belt, cold and fast.
    rolling: float
    #: Whether rolling is loss in the rubber, which no oil changes; else flow in the inlet.
    hysteresis: bool
    film: str
    #: Layer of oil of a new specimen, m.
    layer: float

    def viscosity(self, temperature: float | Array) -> Array:
        """Return the viscosity of new oil, Pa s."""
        a, b, c = self.oil
        return a * np.exp(b / (np.asarray(temperature, float) - c))

    def flooded(self, state: State, speed: float | Array, temperature: float | Array) -> Array:
        """Return the film of a flooded inlet in the middle of the nip, m."""
        half = nip_width() / 2 * state.width
        pressure = 1.5 * LOAD / LENGTH / (2 * half)
        flow = self.viscosity(temperature) * state.viscosity * np.asarray(speed) / 2
        number = 12 * flow * RADIUS**2 / (half**3 * pressure)
        return 0.45 * self.film_gain * number**0.6 * half**2 / RADIUS

    def starved(self, ratio: Array) -> Array:
        """Return film over flooded film where the layer is ``ratio`` times the flooded film."""
        if self.film == "flooded":
            return np.ones_like(ratio)
        return films.tanh(ratio) if self.film == "tanh" else films.reynolds(ratio)

    def belt(self, state: State, speed: float | Array, temperature: float | Array) -> Array:
        """Return the torque of the belt: film, asperities, rolling and debris."""
        flow = self.viscosity(temperature) * state.viscosity * np.asarray(speed)
        flooded = self.flooded(state, speed, temperature)
        film = flooded * self.starved(self.layer * state.layer / flooded)
        share, height = self._shared(film / (self.roughness * state.roughness))
        area = nip_width() * state.width * LENGTH
        shear = flow * area / (height * self.roughness * state.roughness)
        hot = 1 + state.hot * np.exp((np.asarray(temperature) - HOT) / 40)
        asperities = self.friction * state.friction * hot * LOAD * share
        return RADIUS * (shear + asperities + self._rolling(state, speed, temperature) + state.debris * LOAD)

    def whole(self, state: State, speed: float | Array, temperature: float | Array) -> Array:
        """Return the torque of the belt and the no-load torque."""
        constant, per_speed = self.rest
        no_load = (constant + per_speed * np.asarray(speed) / RADIUS) * state.rest
        return self.belt(state, speed, temperature) + no_load

    def transition(self, state: State, temperature: float) -> Array:
        """Return the speed of least torque of the belt, m/s."""
        shaped = SPEEDS.reshape(-1, *(1,) * state.viscosity.ndim)
        torque = self.belt(state, shaped, temperature)
        best = np.clip(torque.argmin(0), 1, len(SPEEDS) - 2)
        left, here, right = (np.take_along_axis(torque, (best + k)[None], 0)[0] for k in (-1, 0, 1))
        bend = np.where(left - 2 * here + right > 0, left - 2 * here + right, np.inf)
        step = np.clip((left - right) / (2 * bend), -1, 1)
        return np.exp(np.log(SPEEDS[best]) + step * np.log(SPEEDS[1] / SPEEDS[0]))

    def _rolling(self, state: State, speed: float | Array, temperature: float | Array) -> Array:
        """Return the force of rolling."""
        if not self.rolling:
            return np.zeros(())
        reference = float(self.viscosity(COLD)) * FAST
        new = State.new(())
        shear = reference * nip_width() * LENGTH / float(self.flooded(new, FAST, COLD))
        force = self.rolling / (1 - self.rolling) * shear
        if self.hysteresis:
            warm = np.exp(-(np.asarray(temperature) - COLD) / 150)
            return force * warm * (1 + 0.12 * np.log(np.asarray(speed) / FAST))
        return force * (self.viscosity(temperature) * state.viscosity * np.asarray(speed) / reference) ** 0.75

    def _shared(self, free: Array) -> tuple[Array, Array]:
        """Return the share of load on asperities and film over roughness, from the film that carries all.

        Summits of exponential height carry S exp(-b l) over what the film does; a film that carries less is
        thicker.
        """
        height = np.logspace(-3, 3, 1201)
        pressed = self.summits * np.exp(-self.stiffness * height)
        share = pressed / (1 + pressed)
        alone = height * (1 - share) ** 0.2
        at = np.log(free)
        return np.interp(at, np.log(alone), share), np.exp(np.interp(at, np.log(alone), np.log(height)))


def draw_drive(rng: Generator, *, film: str, rolling: tuple[float, float]) -> Drive:
    """Return a machine: its roughness is such that new, at 180 degC, torque is least at 14 to 28 mm/s."""
    cold, hot = rng.uniform(np.log(0.2), np.log(0.6)), rng.uniform(np.log(0.012), np.log(0.03))
    c = rng.uniform(150, 200)
    b = (cold - hot) / (1 / (COLD - c) - 1 / (HOT - c))
    drive = Drive(
        oil=(float(np.exp(cold - b / (COLD - c))), float(b), float(c)),
        sheet=float(np.exp(rng.normal(0, 0.1))),
        film_gain=float(np.exp(rng.normal(0, 0.1))),
        roughness=0.5e-6,
        summits=float(np.exp(rng.uniform(np.log(0.5), np.log(3)))),
        stiffness=float(rng.uniform(1.2, 2.0)),
        friction=float(rng.uniform(0.03, 0.09)),
        rest=(float(rng.uniform(0.08, 0.2)), float(rng.uniform(0.0005, 0.0015))),
        rolling=float(rng.uniform(*rolling)),
        hysteresis=bool(rng.random() < 0.5),
        film=film,
        layer=1.0,
    )
    wanted, new = rng.uniform(0.014, 0.028), State.new((1, 1))
    low, high = 0.02e-6, 10e-6
    for _ in range(40):
        middle = float(np.sqrt(low * high))
        found = replace(drive, roughness=middle).transition(new, HOT)[0, 0]
        low, high = (middle, high) if found < wanted else (low, middle)
    return replace(drive, roughness=float(np.sqrt(low * high)))
