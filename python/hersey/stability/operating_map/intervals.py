"""How far the transition speed and V* are known: from draws of the fit and of what is uncertain beside it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.surface import DampingSurface
from hersey.machine.uncertainty import Uncertainty
from hersey.motion.drag import Drag
from hersey.motion.simulation import Drivetrain
from hersey.stability.hysteresis import sweep_bands
from hersey.stability.operating_map.edges import law_at, laws_at, require_all

if TYPE_CHECKING:
    pass

#: Draws for the interval of the transition speed, and for that of V*, which costs a fold each.
DRAWS, FOLD_DRAWS = 1000, 200
#: Temperatures at which the interval of V* is computed; between them it is interpolated.
FOLD_TEMPERATURES = 13
#: Transition speeds at which the search for V* ends.
_FARTHEST = 1e4
#: Drawn stick speeds stay below this share of the transition speed drawn with them.
_BELOW = 0.999


def intervals(
    surface: DampingSurface,
    train: Drivetrain,
    drag: Drag,
    kelvin: FloatArray | None,
    uncertainty: Mapping[str, Uncertainty],
    roll_radius: float,
    rule: str,
    seed: int,
    draws: int,
    threads: int,
) -> tuple[FloatArray, FloatArray, tuple[str, ...], tuple[str, ...]]:
    """Intervals of the transition speed and of V*, shape (2, n) each, what was varied, and warnings."""
    said: dict[str, None] = {}

    def samples(t: float | None, count: int) -> dict[str, FloatArray]:
        drawn, warned = surface.drawn_drag(
            count,
            seed,
            roll_radius=roll_radius,
            stick_speed=drag.stick_speed,
            temperature=t,
            stick_speed_rule=rule,
        )
        said.update(dict.fromkeys(map(str, warned)))
        return drawn

    levels: list[float | None] = [None] if kelvin is None else kelvin.tolist()
    transition = np.array([_middle(samples(t, DRAWS)["transition_speed"]) for t in levels]).T
    known = {**asdict(train), "stick_speed": drag.stick_speed}
    rng = np.random.default_rng(seed)
    uncertainties = {
        name: spread.draw(rng, known[name], draws) for name, spread in uncertainty.items() if name in known
    }
    few = levels
    if kelvin is not None and kelvin.size > FOLD_TEMPERATURES:
        few = np.linspace(kelvin[0], kelvin[-1], FOLD_TEMPERATURES).tolist()
    ratios = []
    for t in few:
        law, map_ = law_at(drag, t, rule), samples(t, draws)
        stick = (
            uncertainties.get("stick_speed", np.array(drag.stick_speed)) * law.stick_speed / drag.stick_speed
        )
        band = sweep_bands(
            train,
            law,
            stiffness=uncertainties.get("stiffness"),
            mass=uncertainties.get("mass"),
            stick_speed=np.minimum(stick, _BELOW * map_["transition_speed"]),
            transition_force=map_["transition_force"],
            transition_speed=map_["transition_speed"],
            ehl_exponent=map_["ehl_exponent"],
            mixed_exponent=map_["mixed_exponent"],
            zip=True,
            lower=False,
            threads=threads,
        )
        require_all(band)
        # without stick-slip the belt slides from the transition speed up, if anything moves it
        upper = np.where(band.columns["upper"] > 0, band.columns["upper"], band.columns["transition"])
        low, high = _middle(upper / law.transition_speed)
        ratios.append((min(low, _FARTHEST), min(high, _FARTHEST)))
    upper = np.array(ratios).T
    if kelvin is not None:
        upper = np.array(
            [np.exp(np.interp(kelvin, np.array(few, dtype=float), np.log(edge))) for edge in upper]
        )
    bend = np.array([law.transition_speed for law in laws_at(drag, kelvin, rule)])
    return transition, upper * bend, tuple(uncertainties), tuple(said)


def _middle(values: FloatArray) -> tuple[float, float]:
    """The interval that leaves 2.5 % of the draws on either side."""
    low, high = np.quantile(values, [0.025, 0.975], method="inverted_cdf")
    return float(low), float(high)
