"""Ways to age. Age is relative: at 1 the limit that leads is reached by the middle specimen.

A mechanism draws the medians and spreads of its parameters once for a campaign; each specimen has values of
its own, lognormal about them. None is a law of one line: two or three causes work together in most.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from benchmarks.life_tests.states import State

Array = NDArray[np.float64]
#: Median and spread of the logarithm, by parameter.
Medians = dict[str, tuple[float, float]]
Parameters = dict[str, Array]

#: Most shocks that a specimen gets.
SHOCKS = 40
#: What differs among new specimens.
DIFFERING = ("roughness", "friction", "viscosity", "width", "layer")


@dataclass(frozen=True)
class Mechanism:
    """One way to age."""

    name: str
    medians: Callable[[Generator], Medians]
    law: Callable[[Parameters, Array], State]
    #: Limits that the middle specimen may reach first.
    leads: tuple[str, ...]
    films: tuple[str, ...] = ("flooded", "tanh", "reynolds")
    rolling: tuple[float, float] = (0.0, 0.4)

    def specimens(self, rng: Generator, medians: Medians, count: int) -> Parameters:
        """Return the parameters of ``count`` specimens, each of shape (count, 1)."""
        drawn = {name: m * np.exp(s * rng.normal(size=(count, 1))) for name, (m, s) in medians.items()}
        if "shock" in medians:
            gaps = rng.exponential(size=(count, SHOCKS)) / medians["rate"][0]
            drawn["times"] = np.cumsum(gaps, axis=1)
            drawn["sizes"] = drawn["shock"] * rng.gamma(0.7, 1 / 0.7, size=(count, SHOCKS))
        return drawn

    def state(self, parameters: Parameters, s: Array) -> State:
        """Return the state of specimens at relative ages: what has aged, times what each was when new."""
        aged = self.law(parameters, s)
        return replace(aged, **{name: getattr(aged, name) * parameters[f"own {name}"] for name in DIFFERING})

    def middle(self, medians: Medians) -> Parameters:
        """Return the parameters of the middle specimen."""
        values = {name: np.full((1, 1), m) for name, (m, _) in medians.items()}
        if "shock" in medians:
            values["times"] = (np.arange(SHOCKS)[None] + 0.5) / medians["rate"][0]
            values["sizes"] = np.full((1, SHOCKS), medians["shock"][0])
        return values


def differences(rng: Generator) -> Medians:
    """Return how new specimens differ."""
    return {f"own {name}": (1.0, rng.uniform(0.01, 0.04)) for name in DIFFERING}


def _new(s: Array, rows: Array, **changed: Array) -> State:
    shape = np.broadcast_shapes(np.shape(s), rows.shape)
    return State.new(shape, **{name: np.broadcast_to(value, shape) for name, value in changed.items()})


def _run_in_medians(rng: Generator) -> Medians:
    return {
        "smoothed": (rng.uniform(0.2, 0.5), 0.15),
        "run_in": (rng.uniform(0.03, 0.15), 0.3),
        "rubbed": (rng.uniform(0.05, 0.3), 0.2),
        "induction": (rng.uniform(0.25, 0.6), rng.uniform(0.1, 0.25)),
        "width": (rng.uniform(0.2, 0.45), 0.1),
        "thickening": (rng.uniform(1.2, 2.6), 0.12),
    }


def _run_in_thickening(p: Parameters, s: Array) -> State:
    """Asperities wear in as 1/(1 + s); grease oxidises once its antioxidant is used up (sigmoid)."""
    worn = 1 - 1 / (1 + s / p["run_in"])
    at = np.tanh((s - p["induction"]) / p["width"]) - np.tanh(-p["induction"] / p["width"])
    return _new(
        s,
        worn,
        roughness=1 - p["smoothed"] * worn,
        friction=1 - p["rubbed"] * worn,
        viscosity=np.exp(p["thickening"] * at / 2),
    )


def _bleed_medians(rng: Generator) -> Medians:
    return {
        "kept": (rng.uniform(0.04, 0.12), 0.15),
        "bleed": (rng.uniform(0.3, 0.9), rng.uniform(0.15, 0.35)),
        "evaporation": (rng.uniform(0.01, 0.05), 0.3),
        "light": (rng.uniform(0.02, 0.25), 0.3),
    }


def _bleed(p: Parameters, s: Array) -> State:
    """Oil bleeds from the thickener, which keeps a share, and evaporates steadily; what is left thickens."""
    layer = p["kept"] + (1 - p["kept"]) * np.exp(-s / p["bleed"]) - p["evaporation"] * s
    return _new(s, layer, layer=np.clip(layer, 0.01, None), viscosity=np.exp(p["light"] * s))


def _side_medians(rng: Generator) -> Medians:
    return {
        "flow": (rng.uniform(6, 25), rng.uniform(0.2, 0.4)),
        "power": (float(rng.choice([1.4, 2.0, 3.8])), 0.0),
        "light": (rng.uniform(0.1, 0.45), rng.uniform(0.15, 0.35)),
    }


def _side_flow(p: Parameters, s: Array) -> State:
    """Oil flows sidewards as h' = -h^n, n not 3; a solvent leaves, and the rest thickens ever faster."""
    n = p["power"]
    layer = (1 + (n - 1) * p["flow"] * s) ** (-1 / (n - 1))
    left = np.clip(1 - p["light"] * s, 0.03, None)
    return _new(s, layer, layer=layer, viscosity=left**-1.5)


def _roughening_medians(rng: Generator) -> Medians:
    return {
        "roughening": (rng.uniform(0.4, 1.2), rng.uniform(0.2, 0.4)),
        "power": (rng.uniform(0.6, 1.5), 0.05),
        "boundary": (rng.uniform(0.1, 0.8), 0.3),
        "thinning": (rng.uniform(0.0, 0.2), 0.2),
    }


def _roughening(p: Parameters, s: Array) -> State:
    """Faces get rougher as a power of distance, friction grows as the coating wears, oil shears down."""
    return _new(
        s,
        p["power"],
        roughness=1 + p["roughening"] * s ** p["power"],
        friction=1 + p["boundary"] * s**1.2,
        viscosity=np.exp(-p["thinning"] * s),
    )


def _debris_medians(rng: Generator) -> Medians:
    share = rng.uniform(0.15, 0.4)
    total, rate = rng.uniform(0.02, 0.06), rng.uniform(3, 8)
    return {
        "debris": (total * (1 - share), rng.uniform(0.2, 0.4)),
        "power": (rng.uniform(0.7, 1.8), 0.06),
        "shock": (total * share / rate, 0.2),
        "rate": (rate, 0.0),
        "bearing": (rng.uniform(0, 0.15) * rng.integers(2), 0.3),
    }


def _debris(p: Parameters, s: Array) -> State:
    """Debris drags as a power of distance and in shocks at random; the bearings of some drag more, too."""
    rows = np.broadcast_to(s, (len(p["power"]), np.shape(s)[-1]))
    shocks = np.array(
        [
            (size[:, None] * (time[:, None] < row)).sum(0)
            for time, size, row in zip(p["times"], p["sizes"], rows, strict=True)
        ]
    )
    return _new(s, p["power"], debris=p["debris"] * s ** p["power"] + shocks, rest=1 + p["bearing"] * s)


def _hardening_medians(rng: Generator) -> Medians:
    return {
        "cured": (rng.uniform(0.1, 0.4), 0.2),
        "cure": (rng.uniform(0.2, 0.6), 0.2),
        "oxidised": (rng.uniform(0.6, 1.8), rng.uniform(0.2, 0.4)),
        "roughening": (rng.uniform(0.1, 0.5), 0.3),
        "thickening": (rng.uniform(0.0, 0.3), 0.3),
    }


def _hardening(p: Parameters, s: Array) -> State:
    """Rubber hardens, at first by after-cure, then by oxidation: the nip narrows as its power -0.3."""
    hard = 1 + p["cured"] * (1 - np.exp(-s / p["cure"])) + p["oxidised"] * s**1.5
    return _new(
        s,
        hard,
        width=hard**-0.3,
        roughness=1 + p["roughening"] * np.sqrt(s),
        viscosity=np.exp(p["thickening"] * s),
    )


def _boundary_medians(rng: Generator) -> Medians:
    return {
        "torn": (rng.uniform(0.5, 1.6), rng.uniform(0.15, 0.35)),
        "power": (rng.uniform(0.8, 1.6), 0.05),
        "sheared": (rng.uniform(0.15, 0.6), 0.25),
        "hold": (rng.uniform(0.3, 0.8), 0.1),
    }


def _boundary_film(p: Parameters, s: Array) -> State:
    """The transfer film fails, the more so the hotter; the polymer of the oil is sheared down."""
    sheared = p["sheared"] * (1 - np.exp(-s / p["hold"]))
    return _new(
        s, p["torn"], hot=p["torn"] * s ** p["power"], viscosity=np.exp(-sheared), roughness=1 + 0.3 * sheared
    )


def _thickening_medians(rng: Generator) -> Medians:
    return {
        "soot": (rng.uniform(0.3, 0.9), rng.uniform(0.15, 0.35)),
        "power": (rng.uniform(0.8, 2.0), 0.05),
        "flow": (rng.uniform(0.5, 3.0), 0.3),
    }


def _filled(p: Parameters, s: Array) -> State:
    """Particles fill the oil (Krieger and Dougherty), its layer thins; much of the drag is rolling."""
    solid = np.clip(0.35 * p["soot"] * s ** p["power"], 0, 0.57)
    return _new(s, solid, viscosity=(1 - solid / 0.6) ** -1.5, layer=1 / (1 + p["flow"] * s))


def _regreased_medians(rng: Generator) -> Medians:
    return {
        **_bleed_medians(rng),
        "renewed": (rng.uniform(0.25, 0.45), 0.0),
        "mixed": (rng.uniform(0.75, 0.95), 0.03),
    }


def _regreased(p: Parameters, s: Array) -> State:
    """Oil is lost as in ``_bleed``; grease is renewed once at an age that is known, and most is new then."""
    since = np.where(s < p["renewed"], s, s - p["renewed"] + (1 - np.clip(p["mixed"], 0, 1)) * p["renewed"])
    return _bleed(p, since)


def _nothing(p: Parameters, s: Array) -> State:
    """Nothing ages: specimens only differ."""
    return _new(s, p["own width"])


TORQUE, ENERGY, CONTINUOUS, STICK, STARVATION = "torque", "energy", "continuous", "stick-slip", "starvation"

STARVED = ("tanh", "reynolds")
LITTLE = (0.0, 0.2)

MECHANISMS = (
    Mechanism(
        "run-in, then thickening",
        _run_in_medians,
        _run_in_thickening,
        (TORQUE, ENERGY, CONTINUOUS),
        ("flooded",),
    ),
    Mechanism(
        "bleed and evaporation, tanh film",
        _bleed_medians,
        _bleed,
        (TORQUE, STARVATION),
        ("tanh",),
        LITTLE,
    ),
    Mechanism(
        "side flow, Reynolds table",
        _side_medians,
        _side_flow,
        (TORQUE, STARVATION, ENERGY),
        ("reynolds",),
        LITTLE,
    ),
    Mechanism("roughening, mixed regime", _roughening_medians, _roughening, (TORQUE, STICK, ENERGY)),
    Mechanism("debris with shocks", _debris_medians, _debris, (TORQUE, ENERGY, CONTINUOUS), ("flooded",)),
    Mechanism("rubber hardening", _hardening_medians, _hardening, (STICK,), ("flooded",)),
    Mechanism("boundary film, hot", _boundary_medians, _boundary_film, (STICK, CONTINUOUS), ("flooded",)),
    Mechanism(
        "filled oil, rolling 20 to 40 %",
        _thickening_medians,
        _filled,
        (TORQUE, STARVATION),
        STARVED,
        (0.2, 0.4),
    ),
    Mechanism(
        "re-greased at a known age",
        _regreased_medians,
        _regreased,
        (TORQUE, STARVATION),
        STARVED,
        LITTLE,
    ),
    Mechanism("nothing ages", lambda _rng: {}, _nothing, (), ("flooded", *STARVED)),
)
