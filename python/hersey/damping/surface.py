"""The damping surface B = a T^b w^c (Eq. 4 of the paper), with a falling branch where the data show one.

It is the paper's candidate in the likelihood of all candidate laws (`candidates`), about the same reference
values, where the coefficients are well conditioned. The same law is fitted in torque space, where errors are
absolute, for comparison.

Where torque falls with speed (c < -1) below a transition speed, a second branch with an exponent of its own
meets the first there. The transition sits at a fixed Hersey number, so that it moves with temperature.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from hersey.arguments.door import Words
from hersey.arrays import FloatArray, refuse_unknown
from hersey.damping.candidates.branched import LEAST_POWER, transition_exponent
from hersey.damping.distributions import square_quantile
from hersey.damping.estimate import Estimate, quantile
from hersey.damping.fitted_law import FittedLaw
from hersey.damping.no_load_torque import NoLoadTorque, with_rest
from hersey.damping.surface_words import headline_of, record_of, summary_of, table_of
from hersey.errors import InsufficientDataError, ParameterError, UntoldWarning
from hersey.motion.drag import Drag, MeasuredRange
from hersey.units import takes_si

if TYPE_CHECKING:
    import polars as pl

#: How a stick speed goes with temperature: as the transition speed does, or not at all.
WITH_TRANSITION, FIXED = "with transition", "fixed"
STICK_SPEED_RULES = Words((WITH_TRANSITION, FIXED))
#: Numbers of a law with temperature whose transition is at one Hersey number.
_HELD = 5


@dataclass(frozen=True, repr=False)
class DampingSurface(FittedLaw):
    """A `FittedLaw` with its transition, and the drag on a belt that follows from both."""

    @property
    def _closure(self) -> tuple[FloatArray, FloatArray]:
        """Values and covariance of the law with a corner at the transition.

        The likelihood of a corner is less sharp than its curvature, which the covariance is: it is widened to
        what the intervals of the corner and of the exponent below it have.
        """
        t = self.transition
        assert t is not None
        values, covariance = self.values, self.covariance
        if t.closure is not None:
            values, covariance = t.closure.values, t.closure.covariance
        errors = np.array([t.mixed_exponent.error, t.speed.error / t.speed.value])
        wider, of = np.ones(values.size), [self._law.index(name) for name in ("c_mixed", "at")]
        wider[of] = np.maximum(errors / np.sqrt(np.maximum(np.diag(covariance)[of], 1e-300)), 1.0)
        return values, covariance * np.outer(wider, wider)

    @takes_si(temperature="temperature")
    def transition_speed(self, temperature: float | None = None) -> float:
        """Return the transition speed (rad/s) at a temperature (K); NaN if the data show none.

        Torque is lowest there: at the corner, or at the minimum of a gradual bend. Warns with
        `ExtrapolationWarning` outside the range of the data, as all methods do.
        """
        self._warn_of(temperature)
        return self._transition_at(temperature)

    def _warn_of(self, *temperatures: float | None) -> None:
        """Warn of a temperature outside the data, where the law varies with it."""
        for kelvin in temperatures:
            if kelvin is not None and self.b is not None:
                self._warn_outside("temperature", np.asarray(kelvin, dtype=float), self.temperature_range)

    def _transition_at(self, temperature: float | None) -> float:
        if self.transition is None:
            return float("nan")
        if temperature is None or self.reference_temperature is None:
            return self.transition.speed.value
        moved = self.transition.temperature_exponent * self._checked_temperature(temperature)
        return float(self.transition.speed.value * np.exp(moved))

    @takes_si(temperature="temperature")
    def transition_estimate(self, temperature: float | None = None) -> Estimate:
        """Return the transition speed (rad/s) at a temperature (K) with its interval, unbounded if unknown.

        Raises
        ------
        InsufficientDataError
            If the data show no transition.
        """
        if self.transition is None:
            raise InsufficientDataError(f"the data show no falling branch: {self.rejected_transition}")
        if temperature is None or self.b is None or self.reference_temperature is None:
            return self.transition.speed
        self._warn_of(temperature)
        x = self._checked_temperature(temperature)
        values, covariance = self._closure
        _, b, c, *_ = values
        away = np.zeros(values.size)
        away[self._law.index("at")] = 1.0
        if self.transition.freed is not None:
            away[self._law.index("d")] = x
        else:
            away[1] = x * transition_exponent(1.0, c)
            away[2] = x * b / (1.0 + c) ** 2 if 1.0 + c > LEAST_POWER else 0.0
        error = float(np.sqrt(away @ covariance @ away))
        speed, freedom = self._transition_at(temperature), self.freedoms.of(away)
        reach = np.exp(quantile(freedom) * error)
        estimable = self.transition.speed.estimable and self.b.estimable
        low, high = (speed / reach, speed * reach) if estimable else (-np.inf, np.inf)
        return Estimate(speed, speed * error, low, high, freedom)

    @takes_si(temperature="temperature")
    def transition_torque(self, temperature: float | None = None) -> float:
        """Return the torque (N m) at the transition, at a temperature (K); NaN if the data show none.

        At a gradual bend, a smooth curve through the dwells gives it.
        """
        self._warn_of(temperature)
        return self._torque_at(temperature)

    def _torque_at(self, temperature: float | None) -> float:
        if self.transition is None:
            return float("nan")
        values, _ = self._closure
        at = self.reference_temperature if temperature is None else temperature
        inputs = self._inputs(
            np.array([self._transition_at(temperature)]), None if at is None else np.array([at])
        )
        return float(np.exp(self._law.predict(self._with_torque(values), inputs))[0])

    @takes_si(
        temperature="temperature",
        stick_speed_temperature="temperature",
        stick_speed="belt speed",
        stick_speed_rule=STICK_SPEED_RULES,
    )
    def stick_speed_at(
        self,
        temperature: float | None,
        *,
        stick_speed: float,
        stick_speed_temperature: float | None = None,
        stick_speed_rule: str = WITH_TRANSITION,
    ) -> float:
        """Return the stick speed (m/s) at a temperature (K), from the one stated at another temperature.

        It moves with the transition speed, or is fixed. Without ``stick_speed_temperature`` it holds at the
        reference temperature of the fit; an isothermal fit has only one temperature.

        Raises
        ------
        ParameterError
            If the rule is unknown, or the law does not hold at a temperature.
        """
        self._warn_of(temperature, stick_speed_temperature)
        return self._stick_speed_at(temperature, stick_speed, stick_speed_temperature, stick_speed_rule)

    def _stick_speed_at(
        self,
        temperature: float | None,
        stick_speed: float,
        stick_speed_temperature: float | None = None,
        stick_speed_rule: str = WITH_TRANSITION,
    ) -> float:
        if stick_speed_rule not in STICK_SPEED_RULES:
            raise ParameterError(
                f"stick_speed_rule '{stick_speed_rule}' is not known. Use '{WITH_TRANSITION}' or '{FIXED}'"
            )
        if stick_speed_rule == FIXED or self.b is None or self.transition is None:
            return stick_speed
        stated = self._transition_at(stick_speed_temperature)
        return float(stick_speed * self._transition_at(temperature) / stated)

    @takes_si(
        roll_radius="length",
        stick_speed="belt speed",
        temperature="temperature",
        stick_speed_temperature="temperature",
        stick_speed_rule=STICK_SPEED_RULES,
    )
    def drag(
        self,
        *,
        roll_radius: float,
        stick_speed: float,
        temperature: float | None = None,
        stick_speed_temperature: float | None = None,
        stick_speed_rule: str = WITH_TRANSITION,
        rest: NoLoadTorque | None = None,
    ) -> Drag:
        """Return the drag on the belt surface, at one temperature or varying with it.

        Both branches start from the torque at the transition, where it is least, with their exponents.

        Parameters
        ----------
        roll_radius
            Radius at which torque acts on the belt, m.
        stick_speed
            Belt speed below which the belt sticks, m/s; steady dwells do not show it.
        temperature
            K; without it the drag of a thermal law keeps its dependence on temperature: forces vary as
            T^(b + (1 + c) d) and speeds, the stick speed among them, as T^d, which is the fitted law.
        stick_speed_temperature, stick_speed_rule
            Temperature at which the stick speed holds (K; default: reference temperature of the fit), and how
            it depends on temperature: ``with transition``, or ``fixed``, which needs a temperature.
        rest
            No-load torque that the machine states; the drag has that which was subtracted before the fit.

        Raises
        ------
        InsufficientDataError
            If the data show no transition: without a falling branch there is no stick-slip to compute.
        ParameterError
            If a no-load torque is stated, but the fit is of the whole torque.
        """
        self.domain.require_torque("the drag")
        self.refuse_whole_torque(rest)
        self._warn_of(temperature, stick_speed_temperature)
        sticking: dict[str, Any] = {
            "stick_speed": stick_speed,
            "stick_speed_temperature": stick_speed_temperature,
            "stick_speed_rule": stick_speed_rule,
        }
        return self._belt_drag(roll_radius, temperature, sticking)

    def _belt_drag(self, roll_radius: float, temperature: float | None, sticking: dict[str, Any]) -> Drag:
        if self.transition is None:
            raise InsufficientDataError(
                f"the data show no falling branch: {self.rejected_transition}. {what_to_record(self)}"
            )
        if temperature is None and self.b is not None and self.reference_temperature is not None:
            return self._varying_drag(roll_radius, self.reference_temperature, self.b.value, sticking)
        film = Drag(
            transition_force=self._torque_at(temperature) / roll_radius,
            transition_speed=self._transition_at(temperature) * roll_radius,
            ehl_exponent=self.c.value,
            mixed_exponent=self.transition.mixed_exponent.value,
            stick_speed=self._stick_speed_at(temperature, **sticking),
            measured=self._measured(roll_radius),
        )
        return film if self.rest is None else with_rest(film, self.rest, roll_radius, temperature)

    def _measured(self, roll_radius: float) -> MeasuredRange:
        low, high = self.speed_range
        speeds = low * roll_radius, high * roll_radius
        return MeasuredRange(speeds, self.temperature_range, self._is_whole)

    def _varying_drag(
        self, roll_radius: float, reference: float, exponent: float, sticking: dict[str, Any]
    ) -> Drag:
        """The drag that varies with temperature, from that at a reference temperature (K)."""
        assert self.transition is not None
        if sticking.get("stick_speed_rule") == FIXED:
            raise ParameterError(
                f"stick_speed_rule '{FIXED}' cannot be used while temperature varies. Give one "
                f"temperature, or use stick_speed_rule '{WITH_TRANSITION}'"
            )
        moved = self.transition.temperature_exponent
        return replace(
            self._belt_drag(roll_radius, reference, sticking),
            reference_temperature=reference,
            force_temperature_exponent=exponent + (1.0 + self.c.value) * moved,
            speed_temperature_exponent=moved,
            temperature_zero=self.temperature_zero,
        )

    @takes_si(
        roll_radius="length",
        temperature="temperature",
        stick_speed="belt speed",
        stick_speed_temperature="temperature",
    )
    def drag_samples(
        self, count: int, seed: int, *, roll_radius: float, temperature: float | None = None, **sticking: Any
    ) -> dict[str, FloatArray]:
        """Return draws of the drag from the covariance of the fit, e.g. for `hysteresis`.

        They follow Student's t with the degrees of freedom of the fit, as its intervals do: the normal
        distribution of the values, widened where few points measure it. The same seed gives draws that
        go together across temperatures.

        Parameters
        ----------
        count
            Draws, at least 1.
        seed
            Random seed, at least 0.
        roll_radius
            m, as in `drag`.
        temperature
            K; needed if the law depends on it.
        sticking
            ``stick_speed`` and what else `drag` takes; a transition speed below the stick speed leaves no
            falling branch.

        Returns
        -------
        dict
            Arrays of shape (count,): ``transition_force`` (N), ``transition_speed`` (m/s), ``ehl_exponent``
            and ``mixed_exponent``. Draws without a falling and a rising branch are drawn again, with a
            warning that counts them.

        Raises
        ------
        InsufficientDataError
            If the data show no transition, or if more than half of the draws have none.
        ParameterError
            If a value is out of range, with its name.
        """
        known = ("stick_speed", "stick_speed_temperature", "stick_speed_rule", "rest")
        refuse_unknown("drag_samples", sticking, known)
        if "stick_speed" not in sticking:
            raise ParameterError("drag_samples needs stick_speed, e.g. stick_speed='0.3 mm/s'")
        self._warn_of(temperature)
        drawn, said = self.drawn_drag(
            count, seed, roll_radius=roll_radius, temperature=temperature, **sticking
        )
        for warning in said:
            warnings.warn(warning, stacklevel=3)
        return drawn

    def drawn_drag(
        self, count: int, seed: int, *, roll_radius: float, temperature: float | None = None, **sticking: Any
    ) -> tuple[dict[str, FloatArray], tuple[Warning, ...]]:
        """Return the draws of `drag_samples` and its warnings; for threads, which share warnings."""
        self.domain.require_torque("the drag")
        self.refuse_whole_torque(sticking.pop("rest", None))
        if self.transition is None:
            raise InsufficientDataError(
                f"the data show no falling branch: {self.rejected_transition}. {what_to_record(self)}"
            )
        if count < 1 or seed < 0:
            name, value, least = ("count", count, 1) if count < 1 else ("seed", seed, 0)
            raise ParameterError(f"{name} is {value}: it must be at least {least}")
        if (temperature is None) != (self.b is None):
            reason = "this law depends on temperature. Give the temperature in K"
            other = "this law does not depend on temperature. Omit temperature"
            raise ParameterError(reason if self.b is not None else other)
        at = self._belt_drag(roll_radius, temperature, sticking)
        x = 0.0
        if temperature is not None and self.reference_temperature is not None:
            x = self._checked_temperature(temperature)
        slowest = np.log(at.stick_speed / roll_radius / self.reference_speed)
        said: list[Warning] = [UntoldWarning()] if self.b is not None and not self.b.estimable else []
        kept, total, failed = self._draws(count, seed, x, slowest)
        if failed:
            again = (
                f"{failed} of {total} draws of the fit had no falling branch and were replaced: "
                "intervals hold only if there is one"
            )
            said.append(UserWarning(again))
        level, b, c, mixed, corner, move = kept.T
        z = corner + move * x
        speed = self.reference_speed * np.exp(z)
        torque = np.exp(level + b * x + c * z) * speed
        drawn = {
            "transition_force": torque / roll_radius,
            "transition_speed": speed * roll_radius,
            "ehl_exponent": c,
            "mixed_exponent": mixed,
        }
        return drawn, tuple(said)

    def _draws(self, count: int, seed: int, x: float, slowest: float) -> tuple[FloatArray, int, int]:
        """Draws of `_round` that have both branches; how many were drawn, and refused."""
        kept, total = np.empty((0, 6)), 0
        while len(kept) < count:
            values = self._round(count, seed, total // count)
            _, _, c, mixed, at, move = values.T
            falls = (c > -1.0) & (mixed < -1.0) & (at + move * x > slowest)
            kept, total = np.concatenate([kept, values[falls]]), total + count
            if 2 * len(kept) < total:
                raise InsufficientDataError(
                    f"{total - len(kept)} of {total} draws of the fit have no falling branch, so the "
                    "data do not prove one. Record more dwells below the transition"
                )
        return kept[:count], total, total - len(kept)

    def _round(self, count: int, seed: int, number: int) -> FloatArray:
        """So many draws of level, b, c, c_mixed, at and how it moves with temperature, the same at any."""
        if number >= len(self._rounds.get((count, seed), ())):
            self._rounds[count, seed] = self._drawn_rounds(count, seed, number + 1)
        return self._rounds[count, seed][number]

    @cached_property
    def _rounds(self) -> dict[tuple[int, int], list[FloatArray]]:
        """Rounds of draws that are kept, by their number and seed."""
        return {}

    def _drawn_rounds(self, count: int, seed: int, rounds: int) -> list[FloatArray]:
        assert self.transition is not None
        centre, covariance = self._closure
        freedoms = [self.freedoms.of(row) for row in np.eye(self.values.size)]
        rng = np.random.default_rng(seed)
        out = []
        for _ in range(rounds):
            values = rng.multivariate_normal(np.zeros(centre.size), covariance, size=count)
            share = rng.random(count)  # one quantile of chi-square for all values of a draw
            by_freedom = {f: np.sqrt(f / square_quantile(share, f)) for f in set(freedoms)}
            values = centre + values * np.column_stack([by_freedom[f] for f in freedoms])
            if self.b is None:
                values = np.insert(values, 1, 0.0, axis=1)
            if values.shape[1] == _HELD:
                b, c = values[:, 1], values[:, 2]
                values = np.column_stack([values, -b / np.maximum(1.0 + c, LEAST_POWER)])
            out.append(values)
        return out

    def check_temperature(self, temperature: float | None) -> None:
        """Raise `ParameterError` for a temperature (K) at which the law is not defined."""
        if self.b is None:
            return
        if temperature is None or not (np.isfinite(temperature) and temperature > self.temperature_zero):
            given = "missing" if temperature is None else f"{temperature:g} K"
            scale = self.temperature_scale
            raise ParameterError(f"temperature is {given}, but a law in {scale} holds only above 0 {scale}")

    def _checked_temperature(self, temperature: float) -> float:
        """The same for one temperature where the powers of the law have a meaning."""
        self.check_temperature(temperature)
        return float(self.log_temperature(np.asarray(temperature, dtype=float)))

    def summary(self) -> str:
        """Return the fit as text, in the layout that users of lmfit know."""
        return summary_of(self)

    def headline(self) -> str:
        """Return the law and its exponents."""
        return headline_of(self)

    def to_dict(self) -> dict[str, Any]:
        """Return the fit in SI; T of the law in its scale."""
        return record_of(self)

    def to_frame(self) -> pl.DataFrame:
        """Return the coefficients with error and 95 % interval; T of the law in its scale, w in rad/s."""
        return table_of(self)


def what_to_record(surface: FittedLaw) -> str:
    """Return what to record where the data show no transition, as a sentence without its full stop."""
    if surface.c.high < -1.0:
        return "Record faster dwells, until torque rises with speed"
    if surface.c.low > -1.0:
        return "Record slower dwells, until torque rises as the drive slows"
    return "Record slower and faster dwells, until torque falls and then rises with speed"
