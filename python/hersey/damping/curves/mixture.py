"""All laws that the dwells do not reject, by weight, and drag curves drawn from them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.damping.candidates.shared_load import SharedLoad
from hersey.damping.curves.beyond import BEYOND, log_torque_beyond
from hersey.damping.curves.dwells import Dwells, dwells_of
from hersey.damping.curves.fitting import FittedLaw, fit_shape
from hersey.damping.curves.shapes import SHAPES, Shape
from hersey.damping.curves.shared_load import least, shared_load_shape
from hersey.damping.distributions import square_above
from hersey.damping.dwells import SteadyPoints
from hersey.damping.surface import DampingSurface
from hersey.errors import ParameterError
from hersey.result import Means, Record

#: A law whose misfit is as large by chance in fewer logs than this is rejected. The chances are a little too
#: small: of 40 logs of true laws two had less than a hundred times this.
REJECTED = 1e-5
#: A law that weighs less is excluded.
LEAST_WEIGHT = 0.002
#: Temperature (K) of the boundary friction of a contact where the dwells have none.
_WARM = 400.0
#: Draws of which it is asked whether torque falls among the dwells.
_LOOKED_AT = 400
#: Exponent of viscosity in temperature where a search begins that knows of none: usual, and at the most.
_USUAL, _STEEPEST = 2.0, 6.0


@dataclass(frozen=True)
class LawWeight(Record):
    """A law: its weight, the AICc behind it, and the probability of so large a misfit by chance."""

    name: str
    words: str
    weight: float
    delta_aicc: float
    p_value: Annotated[float, Means("probability that chance alone makes so large a deviation")]
    rejected: bool


@dataclass(frozen=True)
class CurveMixture:
    """Drag curves that the dwells allow; torque is that of the film.

    ``laws`` are those with weight, ``table`` tells of all that were tried.
    """

    laws: tuple[FittedLaw, ...]
    weights: FloatArray
    table: tuple[LawWeight, ...]
    dwells: Dwells

    @cached_property
    def size(self) -> int:
        """How many latents describe a curve: `BEYOND`, and the numbers of the largest law."""
        return max(law.size for law in self.laws) + BEYOND

    @property
    def scatter(self) -> float:
        """Relative scatter of dwells about the law of most weight."""
        law = self.laws[int(np.argmax(self.weights))]
        return float(np.exp(law.log_scatter))

    def falls_among_dwells(self, share: float) -> float:
        """Return the probability that a dwell is slower than a share of the speed of least torque."""
        law, count = self.shares(_LOOKED_AT), _LOOKED_AT
        latent = np.random.default_rng(count).standard_normal((count, self.size))
        below = self._of_each(law, latent, lambda one, numbers: one.slowest_below_least(numbers))
        return float(np.mean(below < np.log(share)))

    def shares(self, count: int) -> IntArray:
        """Return the law of each of so many draws, in proportion to the weights."""
        edges = np.cumsum(self.weights) * count
        return np.minimum(np.searchsorted(edges, np.arange(count) + 0.5), len(self.laws) - 1).astype(np.intp)

    def log_weight(self, law: IntArray, latent: FloatArray) -> FloatArray:
        """Return by how much draws are likelier than their latents, shape (draws,)."""
        out = np.zeros(law.size)
        for one, mine in self._draws(law):
            out[mine] = one.log_weight(latent[mine][:, BEYOND : BEYOND + one.size])
        return out

    def _draws(self, law: IntArray) -> Iterator[tuple[FittedLaw, BoolArray]]:
        """Each law that has draws, and which they are."""
        for index, one in enumerate(self.laws):
            if (mine := law == index).any():
                yield one, mine

    def log_torque(
        self, law: IntArray, latent: FloatArray, speed: FloatArray, kelvin: float | None
    ) -> FloatArray:
        """Return ln torque (N m) of draws at speeds (rad/s, ascending) and one temperature (K).

        Shape (draws, speeds). Beyond the dwells speeds should be no more than a tenth apart in logarithms.
        """
        z, s = np.log(speed / self.dwells.reference_speed), self.dwells.shape_of(kelvin)
        out = np.empty((law.size, z.size))
        for one, mine in self._draws(law):
            numbers = one.at(latent[mine][:, BEYOND : BEYOND + one.size])
            out[mine] = log_torque_beyond(one, numbers, latent[mine][:, :BEYOND], z, s)
        return out

    def torque(self, speed: FloatArray, kelvin: float | None) -> FloatArray:
        """Return the torque (N m) of all laws by weight at speeds (rad/s) and one temperature (K), (speeds,).

        Each law has its likeliest numbers; means are of ln torque.
        """
        z, s = np.log(speed / self.dwells.reference_speed), self.dwells.shape_of(kelvin)
        each = [law.log_torque(law.numbers[None], z, s)[0] for law in self.laws]
        return np.asarray(np.exp(np.average(each, axis=0, weights=self.weights)))

    def shift(self, law: IntArray, latent: FloatArray, kelvin: float | None) -> FloatArray:
        """Return ln of viscosity over that at the reference temperature of each draw, shape (draws,)."""
        s = self.dwells.shape_of(kelvin)
        at = np.zeros(1)
        return self._of_each(law, latent, lambda one, numbers: one.scaled_speed(numbers, at, s)[:, 0])

    def fastest(self, law: IntArray, latent: FloatArray, kelvin: float | None) -> FloatArray:
        """Return the speed (rad/s) at a temperature (K) of the greatest Hersey number measured, (draws,)."""
        s, reference = self.dwells.shape_of(kelvin), self.dwells.reference_speed
        return self._of_each(law, latent, lambda one, numbers: reference * np.exp(one.fastest(numbers, s)))

    def level(self, law: IntArray, latent: FloatArray, kelvin: float | None) -> FloatArray:
        """Return ln of torque over that at the reference temperature and the same Hersey number, (draws,)."""
        s = self.dwells.shape_of(kelvin)
        return self._of_each(law, latent, lambda one, numbers: one.log_level(numbers, s))

    def _of_each(
        self, law: IntArray, latent: FloatArray, figure: Callable[[FittedLaw, FloatArray], FloatArray]
    ) -> FloatArray:
        """A figure of each draw by its law and the law's numbers, shape (draws,)."""
        out = np.zeros(law.size)
        for one, mine in self._draws(law):
            out[mine] = figure(one, one.at(latent[mine][:, BEYOND : BEYOND + one.size]))
        return out


def fit_curves(
    points: SteadyPoints, surface: DampingSurface, contact: SharedLoad | None = None
) -> CurveMixture:
    """Fit every law of drag curves to steady points and weigh them.

    Parameters
    ----------
    points
        From `TorqueLog.steady`; torque that is not the film's is subtracted before.
    surface
        Their fit: the search begins at its branches. Without a transition the search begins with the least
        torque below, within and above the dwells.
    contact
        What shares the load, `Machine.mixed`: its curve is one more law, if its boundary friction holds at
        the reference temperature.
    """
    dwells = dwells_of(points, surface)
    own: tuple[Shape, ...] = ()
    if contact is not None:
        # boundary friction that is stated for other temperatures may not hold here: then the law is excluded
        with suppress(ParameterError):
            own = (shared_load_shape(contact, surface.reference_temperature or _WARM),)
    fits = [fit_shape(shape, dwells, _starts(shape, dwells, surface)) for shape in (*own, *SHAPES)]
    return _weighed(fits, dwells)


def _starts(shape: Shape, dwells: Dwells, surface: DampingSurface) -> list[FloatArray]:
    """Where the search for the numbers of a law begins: the branches of the surface, and beside them."""
    t = surface.transition
    if t is None:
        return [start for branches in _any_branches(dwells, surface) for start in _about(shape, *branches)]
    at = float(np.log(t.speed.value / dwells.reference_speed))
    level = float(np.log(surface.transition_torque()))
    move = -t.temperature_exponent if dwells.thermal is not None else 0.0
    up = float(np.log(max(1.0 + surface.c.value, 0.1)))
    down = float(np.log(max(-1.0 - t.mixed_exponent.value, 0.05)))
    return _about(shape, level, at, move, up, down)


def _any_branches(dwells: Dwells, surface: DampingSurface) -> list[tuple[float, float, float, float, float]]:
    """Branches that meet below, within and above the dwells, for a fit that has one branch."""
    power = 1.0 + surface.c.value
    slow, fast = float(dwells.log_speed.min()), float(dwells.log_speed.max())
    level, move = float(np.median(dwells.log_torque)), 0.0
    if surface.b is not None:  # torque that falls with temperature: a film that rises, or a branch that falls
        move = float(np.clip(surface.b.value / max(power, 0.2), -_STEEPEST, _STEEPEST)) or -_USUAL
    up, down = float(np.log(np.clip(power, 0.2, 1.0))), float(np.log(np.clip(-power, 0.2, 1.0)))
    return [(level, at, move, up, down) for at in (slow, 0.5 * (slow + fast), fast)]


def _about(shape: Shape, level: float, at: float, move: float, up: float, down: float) -> list[FloatArray]:
    """Starts of the search beside two branches: their torque and ln speed, and ln of their exponents."""
    common = [level, at, move, 0.0, 0.0]
    if shape.name in ("blend", "free"):
        return [np.array([*common, up, down, ln_p]) for ln_p in (0.3, 1.6)]
    if shape.name == "sharp":
        return [np.array([*common, up, down])]
    if shape.name == "mixed":
        place, drag = least(shape)
        return [np.array([level - drag, at - place, move, 0.0, 0.0, film]) for film in (-0.7, 0.0, 0.7)]
    if shape.name == "plus":
        return [np.array([*common, up, -1.0])]
    out = []
    for away, lower in ((0.3, 0.6), (1.2, 1.0)):
        own = [up, 0.3, -away, 0.0] if shape.name == "stribeck" else [up, max(down, -0.3), -1.0, -1.0]
        out.append(np.array([level - lower * 0.5, at - away, move, 0.0, 0.0, *own]))
    return out


def _weighed(fits: list[FittedLaw], dwells: Dwells) -> CurveMixture:
    """Weights by AICc of the laws that the curve without a formula does not reject."""
    free = min((fit for fit in fits if fit.shape.residual), key=lambda fit: fit.aicc)
    chances = [_chance(fit, free) for fit in fits]
    alive = np.array([chance >= REJECTED for chance in chances])
    aicc = np.array([fit.aicc for fit in fits])
    # two widths of the smooth curve are one law
    prior = np.array([0.5 if fit.shape.residual else 1.0 for fit in fits])
    weights = np.where(alive, prior * np.exp(-0.5 * (aicc - aicc[alive].min())), 0.0)
    weights /= weights.sum()
    kept = weights >= LEAST_WEIGHT
    table = tuple(
        LawWeight(
            fit.shape.name,
            fit.shape.words.format(quantity=dwells.quantity),
            float(w),
            float(fit.aicc - aicc.min()),
            chance,
            not lives,
        )
        for fit, w, chance, lives in zip(fits, weights, chances, alive.tolist(), strict=True)
    )
    laws = tuple(fit for fit, keep in zip(fits, kept.tolist(), strict=True) if keep)
    return CurveMixture(laws, weights[kept] / weights[kept].sum(), table, dwells)


def _chance(fit: FittedLaw, free: FittedLaw) -> float:
    """Probability of a misfit as large as that of a law, if it holds: likelihood ratio to the free curve."""
    if fit.shape.residual:
        return 1.0
    more = max(free.parameters - fit.parameters, 1.0)
    return float(square_above(max(fit.deviance - free.deviance, 0.0), more))
