"""Laws with one branch or two: torque in speed and temperature, each with its derivatives.

With z = ln(w/w_ref) and e s(T) from `thermal`, one branch is

    ln torque = level + e s(T) + (1 + c) z

and two branches add (c_mixed - c) min(z - z_t(T), 0), or what `Bend` puts in the place of that corner. The
transition z_t sits at one Hersey number, z_t = at - e s(T)/(1 + c) because torque varies as
viscosity^(1 + c), or moves freely, z_t = at + d s(T).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.damping.candidates.named import Named, stacked
from hersey.damping.candidates.observations import Inputs
from hersey.damping.candidates.thermal import Thermal

#: Least 1 + c by which a transition at one Hersey number is computed; nearer 0 torque tells no viscosity.
LEAST_POWER = 0.05
#: In the place of derivatives that nobody asked for.
_NONE = np.empty((0, 0))

# Branches of a law, as they are called in words.
NO_SPEED = "no speed"
ONE = "one branch"
HELD = "two branches, one Hersey number"
FREE = "two branches, free"
CONSTANT_PLUS = "constant torque plus power of speed"
COULOMB_VISCOUS = "Coulomb plus viscous"
REST_PLUS = "constant and viscous torque plus power of speed"
SHARED = "film and asperities plus constant torque"


def transition_exponent(e: float, c: float) -> float:
    """Return d of a transition at one Hersey number, ln w_t = at + d s(T).

    Torque varies as viscosity^(1 + c), so viscosity as exp(e s/(1 + c)) and the transition speed as its
    inverse. Near c = -1 torque tells nothing of viscosity, and the denominator is bounded.
    """
    return float(_held(e, c))


def _held(e: FloatArray | float, c: FloatArray | float) -> FloatArray:
    return np.asarray(-e / np.maximum(1.0 + c, LEAST_POWER))


@dataclass(frozen=True)
class Bend:
    """How two branches part: in a corner, gradually, or with each point held to its branch."""

    width: float = 0.0  #: of a gradual bend, in ln w; 0 is a corner
    below: BoolArray | None = None  #: points held to the lower branch wherever it ends, shape (points,)

    def reach(self, away: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the way below the transition, and its derivative, at distances from it in ln w."""
        if self.below is not None:
            return np.asarray(away * self.below), self.below.astype(np.float64)
        if not self.width:
            return np.minimum(away, 0.0), np.asarray(away < 0.0, dtype=np.float64)
        steps = away / self.width
        return -self.width * np.logaddexp(0.0, -steps), np.exp(-np.logaddexp(0.0, steps))


@dataclass(frozen=True)
class Law(Named):
    """A candidate about reference values; values are those of `Named`.

    ``branches`` is one of the constants above; ``groups`` is how many temperatures have an exponent of
    their own, 1 if it is common.
    """

    thermal: Thermal | None
    branches: str
    groups: int = 1
    bend: Bend = Bend()

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, in order."""
        exponents = [f"c{i + 1}" for i in range(self.groups)] if self.groups > 1 else ["c"]
        return (
            "level",
            *(self.thermal.names if self.thermal else ()),
            *(exponents if self.branches != NO_SPEED else ()),
            *(("c_mixed", "at") if self.broken else ()),
            *(("d",) if self.branches == FREE and self.thermal else ()),
        )

    @property
    def broken(self) -> bool:
        """Whether there are two branches."""
        return self.branches in (HELD, FREE)

    def predict(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Return ln torque."""
        return self._evaluate(values, inputs)[0]

    def jacobian(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Return its derivatives with respect to the parameters, shape (..., points, parameters)."""
        return self._evaluate(values, inputs, derivatives=True)[1]

    def slopes(self, values: FloatArray, inputs: Inputs) -> tuple[FloatArray, FloatArray]:
        """Return its derivatives with respect to ln w and to T (1/K)."""
        _, _, speed, temperature = self._evaluate(values, inputs, derivatives=True)
        return speed, temperature

    def transition(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Return ln(w_t/w_ref) at the temperatures of the inputs."""
        e, s, _, _ = self._thermal_term(values, inputs)
        return self._transition(values, e, s)

    def starts(self, inputs: Inputs, log_torque: FloatArray, weights: FloatArray) -> list[FloatArray]:
        """Return where to search from, the most promising first: linear fits at fixed transitions."""
        z, root = inputs.log_speed, np.sqrt(weights)
        e_row, q = [], []
        if self.thermal:
            q = self.thermal.start()[1:]
            shape, _, _ = self._shape(inputs, *q)
            e_row = [shape]
        speeds = [] if self.branches == NO_SPEED else list(self._members(inputs) * z)
        plain = [np.ones_like(z), *e_row, *speeds]
        one, *_ = np.linalg.lstsq(np.column_stack(plain) * root[:, None], log_torque * root, rcond=None)
        if not self.broken:
            return [self._assembled(one, q, [])]
        ranked: list[tuple[float, FloatArray]] = []
        for _ in range(2):  # where the points part depends on how the transition moves
            tried = ranked[0][1] if ranked else None
            for d in self._moves(one if tried is None else tried, first=tried is None):
                reach = z - d * e_row[0] if e_row else z
                for at in _corners(reach):
                    below = np.minimum(reach - at, 0.0)
                    design = np.column_stack([*plain, below])
                    linear, *_ = np.linalg.lstsq(design * root[:, None], log_torque * root, rcond=None)
                    cost = float(np.sum(weights * (log_torque - design @ linear) ** 2))
                    ranked.append((cost, self._broken_start(linear, q, at, d)))
            ranked.sort(key=lambda f: f[0])
        return [values for _, values in ranked[:3]]

    def _moves(self, values: FloatArray, *, first: bool) -> list[float]:
        """Exponents of the transition in s(T) that a search begins with."""
        if not self.thermal:
            return [0.0]
        e = float(values[1])
        c = float(np.mean(values[2 : 2 + self.groups] - 1.0)) if first else float(self._mean_exponent(values))
        held = transition_exponent(e, c)
        return [held, 3.3 * -e] if first else [held]

    def _assembled(self, linear: FloatArray, q: list[float], rest: list[float]) -> FloatArray:
        thermal = [float(linear[1]), *q] if self.thermal else []
        first = 2 if self.thermal else 1
        exponents = [float(v) - 1.0 for v in linear[first : first + self.groups]]
        return np.array(
            [float(linear[0]), *thermal, *([] if self.branches == NO_SPEED else exponents), *rest]
        )

    def _broken_start(self, linear: FloatArray, q: list[float], at: float, d: float) -> FloatArray:
        one = self._assembled(linear[:-1], q, [])
        mixed = float(self._mean_exponent(one)) + float(linear[-1])
        free = [d] if self.branches == FREE and self.thermal else []
        return np.append(one, [mixed, at, *free])

    def _mean_exponent(self, values: FloatArray) -> FloatArray:
        first = 1 + (len(self.thermal.names) if self.thermal else 0)
        if self.groups == 1:
            return np.asarray(values[first])
        return np.asarray(values[first : first + self.groups].mean(axis=0))

    def _members(self, inputs: Inputs) -> FloatArray:
        """Whether a point has each exponent, 1 or 0, shape (groups, points) or (1, 1)."""
        if self.groups == 1:
            return np.ones((1, 1))
        return np.asarray(inputs.group == np.arange(self.groups)[:, None], dtype=np.float64)

    def _shape(
        self, inputs: Inputs, q: FloatArray | float = 0.0
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        if self.thermal is None or inputs.kelvin is None:
            nothing = np.zeros_like(inputs.log_speed)
            return nothing, nothing, nothing
        return self.thermal.shape(inputs.kelvin, q)

    def _thermal_term(
        self, values: FloatArray, inputs: Inputs
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        if self.thermal is None:
            return np.zeros(()), *self._shape(inputs)
        return values[1], *self._shape(inputs, values[2] if "q" in self.thermal.names else 0.0)

    def _transition(self, values: FloatArray, e: FloatArray, s: FloatArray) -> FloatArray:
        at = values[self.index("at")]
        if self.branches == FREE:
            return np.asarray(at + (values[-1] * s if self.thermal else 0.0 * s))
        return np.asarray(at + _held(e, self._mean_exponent(values)) * s)

    def _exponents(self, values: FloatArray, group: IntArray) -> FloatArray:
        """The exponent above the transition, or of the only branch, at each point."""
        if self.groups == 1:
            return np.asarray(values[self.index("c")])
        first = self.index("c1")
        each = values[first : first + self.groups]
        return np.asarray(each[group] if each.ndim == 1 else each[group, ..., 0].T)

    def _evaluate(
        self, values: FloatArray, inputs: Inputs, *, derivatives: bool = False
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return ln torque and its derivatives: parameters, ln w, T."""
        z = inputs.log_speed
        e, s, ds_dt, ds_dq = self._thermal_term(values, inputs)
        if self.branches == NO_SPEED:
            law, c = values[0] + e * s, np.zeros_like(z)
        else:
            c = self._exponents(values, inputs.group) + 0.0 * z
            law = values[0] + e * s + (1.0 + c) * z
        if not self.broken:
            if not derivatives:
                return law, _NONE, z, z
            columns: list[FloatArray | float] = [1.0, *([s] if self.thermal else [])]
            if self.thermal and "q" in self.thermal.names:
                columns.append(e * ds_dq)
            if self.branches == NO_SPEED:
                return law, stacked(columns, law.shape), z * 0.0, e * ds_dt
            columns += [member * z for member in self._members(inputs)]
            return law, stacked(columns, law.shape), 1.0 + c, e * ds_dt
        return self._evaluate_broken(values, inputs, law, c, (e, s, ds_dt, ds_dq), derivatives=derivatives)

    def _evaluate_broken(
        self,
        values: FloatArray,
        inputs: Inputs,
        law: FloatArray,
        c: FloatArray,
        thermal: tuple[FloatArray, FloatArray, FloatArray, FloatArray],
        *,
        derivatives: bool,
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        z = inputs.log_speed
        e, s, ds_dt, ds_dq = thermal
        at = self._transition(values, e, s)
        reach, share = self.bend.reach(np.asarray(z - at))
        change = values[self.index("c_mixed")] - c
        law = law + change * reach
        if not derivatives:
            return law, _NONE, z, z
        drop = change * share  # times minus the derivative of the transition
        power = 1.0 + self._mean_exponent(values)
        # one Hersey number: d = -e/(1 + c), as long as that is not bounded
        nothing = np.zeros(())
        d, moved_by_e, moved_by_c = values[-1] if self.thermal else nothing, nothing, nothing
        if self.branches == HELD:
            d, moved_by_e = _held(e, power - 1.0), -1.0 / np.maximum(power, LEAST_POWER)
            moved_by_c = np.where(power > LEAST_POWER, e / power**2 / self.groups, 0.0)
        columns: list[FloatArray | float] = [1.0]
        if self.thermal:
            columns.append(s - drop * moved_by_e * s)
            if "q" in self.thermal.names:
                columns.append(e * ds_dq - drop * d * ds_dq)
        above, moved = z - reach, drop * moved_by_c * s
        columns += [*(member * above - moved for member in self._members(inputs)), reach, -drop]
        if self.branches == FREE and self.thermal:
            columns.append(-drop * s)
        temperature = e * ds_dt - drop * d * ds_dt
        return law, stacked(columns, law.shape), 1.0 + c + drop, temperature


def _corners(reach: FloatArray, count: int = 14) -> FloatArray:
    """Return transitions to try: within the speeds, two points or more on either side."""
    ordered = np.sort(reach)
    margin = min(2, (ordered.size - 1) // 2)
    return np.linspace(ordered[margin], ordered[-1 - margin], count)
