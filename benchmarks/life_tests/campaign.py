"""One campaign by its seed: machine, specimens, ages, limits, and what will really happen."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from benchmarks.life_tests import mechanisms as ways
from benchmarks.life_tests import modes
from benchmarks.life_tests.drive import COLD, FAST, HOT, Drive, draw_drive
from benchmarks.life_tests.mechanisms import MECHANISMS, Mechanism, Medians, Parameters
from benchmarks.life_tests.states import State

Array = NDArray[np.float64]

#: Relative ages until which failures are looked for; 1 is about the middle life.
HORIZON = 12.0
GRID = np.concatenate([np.linspace(0, 3, 61), np.geomspace(3.1, HORIZON, 24)])
FINE = np.concatenate([np.linspace(0, 3, 601), np.geomspace(3.01, HORIZON, 200)])
#: New specimens whose failures give B10 and B50.
POPULATION = 1500


@dataclass(frozen=True)
class Stand:
    """How runs are recorded."""

    speeds: Array
    temperatures: Array
    down: bool
    repeatability: float
    #: Stated error of the gain of the torque sensor, at 95 %, and the one that it has.
    stated_gain: float
    gain: float
    #: Scatter of the gain from run to run, as a specimen is mounted.
    mounting: float
    #: Scatter of viscosity from run to run, as temperature is set and oil is spread.
    spreading: float


@dataclass(frozen=True)
class Campaign:
    """Campaign of a seed. Relative ages times ``life`` are pages."""

    seed: int
    mechanism: Mechanism
    drive: Drive
    use: modes.Use
    stand: Stand
    medians: Medians
    specimens: Parameters
    lead: str
    life: float
    #: Ages of the runs of each specimen, pages.
    ages: tuple[Array, ...]
    #: Ages at failure of the specimens by mode, and of a population of new ones; pages.
    failures: dict[str, Array]
    population: dict[str, Array]

    @property
    def units(self) -> tuple[str, ...]:
        """Names of the specimens."""
        return tuple(f"U{number + 1}" for number in range(len(self.ages)))

    @property
    def regreased(self) -> float | None:
        """Age at which grease is renewed, pages."""
        return self.medians["renewed"][0] * self.life if "renewed" in self.medians else None

    def state(self, unit: int) -> State:
        """Return the state of a specimen at its runs."""
        one = {name: values[unit : unit + 1] for name, values in self.specimens.items()}
        return self.mechanism.state(one, self.ages[unit][None] / self.life)


def draw(seed: int) -> Campaign:
    """Return the campaign of a seed; its mechanism is the last digit."""
    mechanism = MECHANISMS[seed % len(MECHANISMS)]
    rng = np.random.default_rng([34, seed])
    for _ in range(200):
        found = _tried(seed, mechanism, rng)
        if found is not None:
            return found
    raise RuntimeError(f"no campaign for seed {seed}")


def first_failure(failures: dict[str, Array]) -> Array:
    """Return the age of the first failure of each specimen."""
    return np.min(list(failures.values()), axis=0)


def _tried(seed: int, mechanism: Mechanism, rng: Generator) -> Campaign | None:
    """Return a campaign, or None if the middle life is not near 1 or new specimens fail."""
    drive = draw_drive(rng, film=str(rng.choice(mechanism.films)), rolling=mechanism.rolling)
    wide = rng.uniform(0.8, 1.6)
    medians = {name: (middle, spread * wide) for name, (middle, spread) in mechanism.medians(rng).items()}
    medians |= ways.differences(rng)
    chosen = _use(mechanism, medians, drive, rng)
    if chosen is None:
        return None
    drive, use, lead = chosen
    new = mechanism.specimens(rng, medians, POPULATION)
    population = modes.failure_ages(drive, use, mechanism.state(new, GRID[None]), GRID)
    first = first_failure(population)
    middle = float(np.quantile(first, 0.5, method="higher"))
    ageless = not mechanism.leads
    if np.mean(first <= 0) > 0.005 or (not ageless and not 0.3 < middle < 3):
        return None
    life = float(np.exp(rng.uniform(np.log(3e4), np.log(1.5e6)))) / (1 if ageless else middle)
    specimens = mechanism.specimens(rng, medians, int(rng.choice([4, 5, 6, 8, 8, 8, 8, 10, 12])))
    horizon = 0.6 * (1 if ageless else middle) * rng.uniform(0.9, 1.1)
    count = len(specimens[next(iter(medians))])
    ages = _ages(rng, count, horizon * life)
    failures = modes.failure_ages(drive, use, mechanism.state(specimens, FINE[None]), FINE)
    return Campaign(
        seed,
        mechanism,
        drive,
        use,
        _stand(rng),
        medians,
        specimens,
        lead,
        life,
        ages,
        {name: at * life for name, at in failures.items()},
        {name: at * life for name, at in population.items()},
    )


def _ages(rng: Generator, count: int, horizon: float) -> tuple[Array, ...]:
    """Return uneven ages of the runs of each specimen; some specimens are removed early."""
    runs = int(rng.integers(4, 10))
    ages = []
    for _ in range(count):
        last = horizon * (rng.uniform(0.55, 0.8) if rng.random() < 0.15 else rng.uniform(0.85, 1.0))
        own = max(4, runs - int(rng.integers(0, 2)))
        apart = last / (own - 1)
        at = np.linspace(0, last, own) + np.r_[0, rng.uniform(-0.25, 0.25, own - 2), 0] * apart
        ages.append(np.round(at, -1))
    return tuple(ages)


def _stand(rng: Generator) -> Stand:
    count = int(rng.integers(7, 11))
    temperatures = np.linspace(60, 180, int(rng.integers(4, 6)))
    stated = float(rng.choice([0.01, 0.02, 0.03]))
    return Stand(
        speeds=np.round(np.geomspace(5, 140, count), 1),
        temperatures=temperatures,
        down=bool(rng.random() < 0.3),
        repeatability=float(rng.uniform(0.004, 0.015)),
        stated_gain=stated,
        gain=float(rng.normal(0, stated / 2)),
        mounting=float(rng.uniform(0.002, 0.008)),
        spreading=float(rng.uniform(0.005, 0.025)),
    )


def _use(
    mechanism: Mechanism, medians: Medians, drive: Drive, rng: Generator
) -> tuple[Drive, modes.Use, str] | None:
    """Return limits that the middle specimen reaches, the leading one at age 1, others later; or None."""
    lead = str(rng.choice(mechanism.leads)) if mechanism.leads else ""
    ages = {
        name: 1.0 if name == lead else float(rng.choice([rng.uniform(1.02, 1.15), rng.uniform(1.3, 2.5)]))
        for name in (ways.TORQUE, ways.ENERGY, ways.CONTINUOUS, ways.STICK, ways.STARVATION)
    }
    at = np.array(list(ages.values()))[None]
    middle = mechanism.middle(medians)
    state, new = mechanism.state(middle, at), mechanism.state(middle, np.zeros((1, 1)))
    drive = replace(drive, layer=_layer(drive, state, list(ages).index(ways.STARVATION), rng))
    share = float(rng.uniform(0.3, 0.8))
    least, least_new = (
        drive.transition(state, HOT)[0, list(ages).index(ways.STICK)],
        drive.transition(new, HOT)[0, 0],
    )
    grows = least > 1.15 * least_new
    if lead == ways.STICK and not (grows and 0.02 < least < 0.12):
        return None
    slow = least if grows else least_new * rng.uniform(1.4, 2)
    use = modes.Use(slow=float(np.clip(slow, 0.02, 0.12)), share=share, motor=1.0)
    then, before = modes.indicators(drive, use, state), modes.indicators(drive, use, new)
    limits = {}
    for key, names in (
        (ways.TORQUE, (modes.COLD_FAST, modes.HOT_SLOW)),
        (ways.CONTINUOUS, (modes.CONTINUOUS,)),
        (ways.ENERGY, (modes.ENERGY,)),
    ):
        start = max(before[name][0, 0] for name in names)
        end = max(then[name][0, list(ages).index(key)] for name in names)
        if key == lead and end < 1.2 * start:
            return None
        if key != lead and not 1.15 * start < end < 5 * start:
            end = start * rng.uniform(1.5, 3)
        limits[key] = float(end)
    stated = {
        key: limits[key] if key == lead or rng.random() < 0.6 else None
        for key in (ways.CONTINUOUS, ways.ENERGY)
    }
    return drive, replace(use, motor=limits[ways.TORQUE], **stated), lead


def _layer(drive: Drive, state: State, starved: int, rng: Generator) -> float:
    """Return the layer of a new specimen, m: as the hot, fast film needs when the middle specimen starves."""
    if drive.film == "flooded":
        return 1.0
    cold = drive.flooded(State.new((1, 1)), FAST, COLD)[0, 0]
    left = float(state.layer[0, starved])
    if left > 0.8:
        return float(cold * rng.uniform(1.2, 3))
    needed = drive.flooded(state, FAST, HOT)[0, starved]
    return float(needed / left)
