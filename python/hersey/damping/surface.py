"""The damping surface B = a T^b w^c (Eq. 4 of the paper), with a falling branch where the data show one.

It is the paper's candidate in the likelihood of all candidate laws (`candidates`), about the same reference
values, where the coefficients are well conditioned. The same law is fitted in torque space, where errors are
absolute, for comparison.

Where torque falls with speed (c < -1) below a transition speed, a second branch with an exponent of its own
meets the first there. The transition sits at a fixed Hersey number, so that it moves with temperature.
"""

from __future__ import annotations

import textwrap
import warnings
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from hersey import _core
from hersey.arrays import FloatArray
from hersey.damping.branches import Transition
from hersey.damping.candidates.branched import HELD, LEAST_POWER, ONE, Law, transition_exponent
from hersey.damping.candidates.intervals import Band, band_of, of_one_dwell
from hersey.damping.candidates.observations import Inputs
from hersey.damping.candidates.shared_errors import Freedom, SharedScatter
from hersey.damping.candidates.thermal import CELSIUS, KELVIN, Thermal, scaled_temperature
from hersey.damping.estimate import Estimate, quantile
from hersey.damping.rest import RestOfDrive, with_rest
from hersey.errors import ExtrapolationWarning, InsufficientDataError, ParameterError, UntoldWarning
from hersey.motion.drag import Drag
from hersey.result import Result, json_record
from hersey.units import ZERO_CELSIUS, celsius, takes_si

if TYPE_CHECKING:
    import polars as pl

#: How a stick speed goes with temperature: as the transition speed does, or not at all.
WITH_TRANSITION, FIXED = "with transition", "fixed"
#: Law of temperature by the scale of T in T^b.
SCALES = {"degC": CELSIUS, "K": KELVIN}


@dataclass(frozen=True)
class FitStatistics:
    """How well the law describes the points."""

    points: int
    variables: int
    chi_square: float
    reduced_chi_square: float
    scatter: float  #: relative, between dwells, beyond the standard errors of their means
    shared: tuple[SharedScatter, ...]  #: of visits to a temperature and of runs
    dwell_error: float  #: relative, median of the errors of the dwells
    aicc: float
    r_squared_damping: float
    r_squared_torque: float


@dataclass(frozen=True, repr=False)
class DampingSurface(Result):
    """A fitted law B = a T^b w^c; T in ``temperature_scale``, w in rad/s, B in N m s/rad.

    ``b`` is None for isothermal data. ``covariance`` is that of ``variables``, the numbers fitted, about
    ``reference_speed`` (rad/s) and ``reference_temperature`` (K). ``torque_space`` holds a, b, c
    of the fit to torque. ``speed_range`` and ``temperature_range`` (SI) bound the data. Where a ``rest`` of
    the drive was taken off, all of this is of the film alone; `total_torque` is what the log shows.
    """

    a: Estimate
    b: Estimate | None
    c: Estimate
    transition: Transition | None
    temperature_scale: str
    reference_speed: float
    reference_temperature: float | None
    variables: tuple[str, ...]
    values: FloatArray
    covariance: FloatArray
    freedoms: Freedom
    torque_space: dict[str, Estimate]
    statistics: FitStatistics
    speed_range: tuple[float, float]
    temperature_range: tuple[float, float] | None
    residuals: FloatArray  #: ln(measured/fitted), shape (points,)
    rejected_transition: str  #: why a second branch is not announced, empty if it is
    data_sha256: tuple[str, ...]
    sensors: str = ""  #: their errors in words, which the systematic parts stand for
    rest: RestOfDrive | None = None  #: taken off the torque before the fit
    version: str = field(default=_core.VERSION)

    @takes_si(speed="speed", temperature="temperature")
    def damping(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> FloatArray:
        """Return damping in N m s/rad at speeds (rad/s) and temperatures (K), broadcast together.

        Warns with `ExtrapolationWarning` outside the range of the data. Around a gradual bend it is that of
        the trend lines on either side, as are `torque` and `predict`: they describe each branch, but meet
        below the torque measured, so that `drag` has the torque of the dwells at the transition instead.
        """
        speeds = np.abs(np.asarray(speed, dtype=float))
        self._warn_outside("speed", speeds, self.speed_range)
        if self.b is not None and temperature is None:
            raise ParameterError("this law depends on temperature: give it one, in K")
        kelvin = None
        if self.b is not None and temperature is not None:
            kelvin = np.asarray(temperature, dtype=float)
            self._warn_outside("temperature", kelvin, self.temperature_range)
            speeds, kelvin = np.broadcast_arrays(speeds, kelvin)
        inputs = self._inputs(speeds, kelvin)
        return np.asarray(np.exp(self._law.predict(self._law_values, inputs)).reshape(speeds.shape) / speeds)

    @cached_property
    def _law(self) -> Law:
        thermal = None
        if self.reference_temperature is not None:
            thermal = Thermal(SCALES[self.temperature_scale], self.reference_temperature)
        return Law(thermal, HELD if self.transition else ONE)

    @cached_property
    def _law_values(self) -> FloatArray:
        """The values as the law has them."""
        return self._with_torque(self.values)

    def _with_torque(self, values: FloatArray) -> FloatArray:
        """Values whose level is of torque, not of damping."""
        return np.append(values[0] + np.log(self.reference_speed), values[1:])

    @property
    def _closure(self) -> tuple[FloatArray, FloatArray]:
        """Values and covariance of the law with a corner at the transition."""
        assert self.transition is not None
        closure = self.transition.closure
        return (self.values, self.covariance) if closure is None else (closure.values, closure.covariance)

    def _inputs(self, speed: FloatArray, kelvin: FloatArray | None) -> Inputs:
        z = np.log(speed.ravel() / self.reference_speed)
        hot = None if kelvin is None else np.ravel(kelvin)
        return Inputs(z, hot, np.zeros(z.size, dtype=np.intp))

    @takes_si(speed="speed", temperature="temperature")
    def torque(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> FloatArray:
        """Return drag torque in N m, with the sign of the speed (rad/s); temperature in K."""
        return np.asarray(self.damping(speed, temperature) * np.asarray(speed, dtype=float))

    @takes_si(speed="speed", temperature="temperature")
    def total_torque(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> FloatArray:
        """Return the torque of the log in N m: that of the film and, if one was taken off, of the rest."""
        film = self.torque(speed, temperature)
        return film if self.rest is None else film + self.rest.torque(speed, temperature)

    @takes_si(temperature="temperature")
    def transition_speed(self, temperature: float | None = None) -> float:
        """Return the transition speed in rad/s at a temperature (K); NaN where the data show none.

        It is where torque is least: the corner, or the minimum of a gradual bend.
        """
        if self.transition is None:
            return float("nan")
        if temperature is None or self.reference_temperature is None:
            return self.transition.speed.value
        moved = self.transition.temperature_exponent * self._checked_temperature(temperature)
        return float(self.transition.speed.value * np.exp(moved))

    @takes_si(temperature="temperature")
    def transition_estimate(self, temperature: float | None = None) -> Estimate:
        """Return the transition speed (rad/s) at a temperature (K) with its interval, unbounded if not told.

        Raises
        ------
        InsufficientDataError
            If the data show no transition.
        """
        if self.transition is None:
            raise InsufficientDataError(f"the data show no falling branch ({self.rejected_transition})")
        if temperature is None or self.b is None or self.reference_temperature is None:
            return self.transition.speed
        x = self._checked_temperature(temperature)
        values, covariance = self._closure
        covariance = covariance.copy()
        covariance[-1, -1] = max(
            covariance[-1, -1], (self.transition.speed.error / self.transition.speed.value) ** 2
        )
        _, b, c, *_ = values
        away = np.zeros(values.size)
        away[-1] = 1.0
        away[1] = x * transition_exponent(1.0, c)
        away[2] = x * b / (1.0 + c) ** 2 if 1.0 + c > LEAST_POWER else 0.0
        error = float(np.sqrt(away @ covariance @ away))
        speed, freedom = self.transition_speed(temperature), self.freedoms.of(away)
        reach = np.exp(quantile(freedom) * error)
        told = self.transition.speed.told and self.b.told
        low, high = (speed / reach, speed * reach) if told else (-np.inf, np.inf)
        return Estimate(speed, speed * error, low, high, freedom)

    @takes_si(temperature="temperature")
    def transition_torque(self, temperature: float | None = None) -> float:
        """Return the torque in N m there, at a temperature (K); NaN where the data show no transition.

        In a gradual bend it is that of a smooth curve through the dwells.
        """
        if self.transition is None:
            return float("nan")
        values, _ = self._closure
        at = self.reference_temperature if temperature is None else temperature
        inputs = self._inputs(
            np.array([self.transition_speed(temperature)]), None if at is None else np.array([at])
        )
        return float(np.exp(self._law.predict(self._with_torque(values), inputs))[0])

    @takes_si(temperature="temperature", stick_speed_temperature="temperature", stick_speed="belt speed")
    def stick_speed_at(
        self,
        temperature: float | None,
        *,
        stick_speed: float,
        stick_speed_temperature: float | None = None,
        stick_speed_rule: str = WITH_TRANSITION,
    ) -> float:
        """Return the stick speed (m/s) at a temperature (K) of one stated at another: the one rule for it.

        It moves with the transition speed, or is fixed. Without ``stick_speed_temperature`` it is stated at
        the reference temperature of the fit; an isothermal fit has one temperature.

        Raises
        ------
        ParameterError
            If the rule is not known, or a temperature not one that the law allows.
        """
        if stick_speed_rule not in (WITH_TRANSITION, FIXED):
            raise ParameterError(
                f"stick_speed_rule '{stick_speed_rule}' is not known: '{WITH_TRANSITION}' or '{FIXED}'"
            )
        if stick_speed_rule == FIXED or self.b is None or self.transition is None:
            return stick_speed
        stated = self.transition_speed(stick_speed_temperature)
        return float(stick_speed * self.transition_speed(temperature) / stated)

    @takes_si(
        roll_radius="length",
        stick_speed="belt speed",
        temperature="temperature",
        stick_speed_temperature="temperature",
    )
    def drag(
        self,
        *,
        roll_radius: float,
        stick_speed: float,
        temperature: float | None = None,
        stick_speed_temperature: float | None = None,
        stick_speed_rule: str = WITH_TRANSITION,
    ) -> Drag:
        """Return the drag on the belt surface, at one temperature or varying with it.

        Both branches start from the torque at the transition, where it is least, with their exponents.

        Parameters
        ----------
        roll_radius
            Radius at which torque acts on the belt, m.
        stick_speed
            Belt speed below which the belt sticks, m/s; no steady log can show it.
        temperature
            K; without it the drag of a thermal law keeps its dependence on temperature: forces vary as
            T^(b + (1 + c) d) and speeds, the stick speed among them, as T^d, which is the fitted law.
        stick_speed_temperature, stick_speed_rule
            At which the stick speed holds (K; by default the reference temperature of the fit), and how it
            goes with temperature: ``with transition``, or ``fixed``, which needs a temperature.

        Raises
        ------
        InsufficientDataError
            If the data show no transition: without a falling branch there is no stick-slip to compute.
        """
        if self.transition is None:
            raise InsufficientDataError(
                f"the data show no falling branch ({self.rejected_transition}); "
                "record slower dwells, until torque rises as the drive slows"
            )
        sticking: dict[str, Any] = {
            "stick_speed": stick_speed,
            "stick_speed_temperature": stick_speed_temperature,
            "stick_speed_rule": stick_speed_rule,
        }
        if temperature is None and self.b is not None and self.reference_temperature is not None:
            if stick_speed_rule == FIXED:
                raise ParameterError(
                    f"a stick speed that is '{FIXED}' at all temperatures cannot be followed while it "
                    f"varies: give one temperature, or stick_speed_rule '{WITH_TRANSITION}'"
                )
            zero = 0.0 if self.temperature_scale == "K" else ZERO_CELSIUS
            reference = self.reference_temperature
            at_reference = self.drag(roll_radius=roll_radius, temperature=reference, **sticking)
            exponent = self.transition.temperature_exponent
            return replace(
                at_reference,
                reference_temperature=reference,
                force_temperature_exponent=self.b.value + (1.0 + self.c.value) * exponent,
                speed_temperature_exponent=exponent,
                temperature_zero=zero,
            )
        film = Drag(
            transition_force=self.transition_torque(temperature) / roll_radius,
            transition_speed=self.transition_speed(temperature) * roll_radius,
            ehl_exponent=self.c.value,
            mixed_exponent=self.transition.mixed_exponent.value,
            stick_speed=self.stick_speed_at(temperature, **sticking),
        )
        return film if self.rest is None else with_rest(film, self.rest, roll_radius, temperature)

    @takes_si(
        roll_radius="length",
        stick_speed="belt speed",
        temperature="temperature",
        stick_speed_temperature="temperature",
    )
    def drag_samples(
        self,
        count: int,
        seed: int,
        *,
        roll_radius: float,
        stick_speed: float,
        temperature: float | None = None,
        stick_speed_temperature: float | None = None,
        stick_speed_rule: str = WITH_TRANSITION,
    ) -> dict[str, FloatArray]:
        """Return draws of the drag that the fit's covariance allows, for `hysteresis` and the like.

        They follow Student's t with the degrees of freedom of the fit, as its intervals do: the normal
        distribution of the values, widened where few points measure it. The same seed gives draws that
        go together across temperatures.

        Parameters
        ----------
        count
            Draws, at least 1.
        seed
            Of the random draws, at least 0.
        roll_radius
            m, as in `drag`.
        stick_speed, stick_speed_temperature, stick_speed_rule
            As in `drag`; a transition speed below the stick speed leaves no falling branch.
        temperature
            K; needed if the law depends on it.

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
        if self.transition is None:
            raise InsufficientDataError(
                f"the data show no falling branch ({self.rejected_transition}); "
                "record slower dwells, until torque rises as the drive slows"
            )
        if count < 1 or seed < 0:
            name, value, least = ("count", count, 1) if count < 1 else ("seed", seed, 0)
            raise ParameterError(f"{name} is {value}: it must be at least {least}")
        if (temperature is None) != (self.b is None):
            reason = "this law depends on temperature: give it one, in K"
            other = "temperature is given, but this law does not depend on it"
            raise ParameterError(reason if self.b is not None else other)
        at = self.drag(
            roll_radius=roll_radius,
            stick_speed=stick_speed,
            temperature=temperature,
            stick_speed_temperature=stick_speed_temperature,
            stick_speed_rule=stick_speed_rule,
        )
        x = 0.0
        if temperature is not None and self.reference_temperature is not None:
            x = self._checked_temperature(temperature)
        slowest = np.log(at.stick_speed / roll_radius / self.reference_speed)
        self._warn_untold()
        kept, total, failed = self._draws(count, seed, x, slowest)
        if failed:
            warnings.warn(
                f"{failed} of {total} draws of the fit had no falling branch and were drawn again: "
                "the intervals hold for fits that have one",
                stacklevel=3,
            )
        level, b, c, mixed, corner = kept.T
        z = corner + _transition_exponents(b, c) * x
        speed = self.reference_speed * np.exp(z)
        torque = np.exp(level + b * x + c * z) * speed
        return {
            "transition_force": torque / roll_radius,
            "transition_speed": speed * roll_radius,
            "ehl_exponent": c,
            "mixed_exponent": mixed,
        }

    def _draws(self, count: int, seed: int, x: float, slowest: float) -> tuple[FloatArray, int, int]:
        """Draws of level, b, c, c_mixed and at that have both branches; how many were drawn, and refused."""
        assert self.transition is not None
        centre, covariance = self._closure
        covariance = covariance.copy()
        # The likelihood of a corner is less sharp than its curvature.
        error = self.transition.speed.error / self.transition.speed.value
        covariance[-1, -1] = max(covariance[-1, -1], error**2)
        freedoms = [self.freedoms.of(row) for row in np.eye(self.values.size)]
        rng = np.random.default_rng(seed)
        kept, total = np.empty((0, 5)), 0
        while len(kept) < count:
            values = rng.multivariate_normal(np.zeros(centre.size), covariance, size=count)
            share = rng.random(count)  # one quantile of chi-square for all values of a draw
            wider = [np.sqrt(f / stats.chi2.ppf(share, f)) for f in freedoms]
            values = centre + values * np.column_stack(wider)
            if self.b is None:
                values = np.insert(values, 1, 0.0, axis=1)
            _, b, c, mixed, at = values.T
            falls = (c > -1.0) & (mixed < -1.0) & (at + _transition_exponents(b, c) * x > slowest)
            kept, total = np.concatenate([kept, values[falls]]), total + count
            if 2 * len(kept) < total:
                raise InsufficientDataError(
                    f"{total - len(kept)} of {total} draws of the fit have no falling branch: "
                    "the data do not prove one; record more dwells below the transition"
                )
        return kept[:count], total, total - len(kept)

    @takes_si(speed="speed", temperature="temperature")
    def predict(self, speed: Any, temperature: Any = None) -> Band:
        """Return torque with its 95 % limits: of the law, and of one further dwell in a visit of its own.

        Parameters
        ----------
        speed
            rad/s, or strings such as ``"400 rpm"``, or pint quantities.
        temperature
            K, or strings such as ``"150 degC"``, or pint quantities; needed if the law depends on it. Both
            broadcast together.

        Examples
        --------
        >>> import hersey
        >>> surface = hersey.fit(hersey.read("examples/bench.csv").steady(tare="standing"))
        >>> surface.predict("25 rpm", "150 degC").torque.round(3)
        array([0.2])
        """
        speeds = np.abs(np.asarray(speed, dtype=float))
        self._warn_outside("speed", speeds, self.speed_range)
        kelvin = None
        if self.b is not None:
            if temperature is None:
                raise ParameterError("this law depends on temperature: give it one, in K")
            kelvin = np.asarray(temperature, dtype=float)
            self._warn_outside("temperature", kelvin, self.temperature_range)
            speeds, kelvin = np.broadcast_arrays(speeds, kelvin)
        of_points = self.statistics
        dwell = of_one_dwell(of_points.scatter, of_points.dwell_error, of_points.shared)
        inputs = self._inputs(speeds, kelvin)
        self._warn_untold()
        return band_of(self._law, self._law_values, self.freedoms, dwell, inputs)

    def _warn_untold(self) -> None:
        if self.b is not None and not self.b.told:
            warnings.warn(UntoldWarning(), stacklevel=4)

    @property
    def freedom(self) -> int:
        """Degrees of freedom of the fit."""
        return self.statistics.points - self.statistics.variables

    def summary(self) -> str:
        """Return the fit as text, in the layout that users of lmfit know."""
        return _summary(self)

    def headline(self) -> str:
        """Return the law and its exponents."""
        law = "B = a T^b w^c" if self.b else "B = a w^c"
        exponents = f"b = {self.b.value:.4g}, c = {self.c.value:.4g}" if self.b else f"c = {self.c.value:.4g}"
        where = "no transition"
        if self.transition is not None:
            where = f"transition at {self.transition.speed.value:.4g} rad/s"
        return f"{law}, {exponents}, {where}"

    def coefficients(self) -> dict[str, Estimate]:
        """Return a, b (where thermal) and c by name."""
        return {"a": self.a, **({"b": self.b} if self.b else {}), "c": self.c}

    def to_dict(self) -> dict[str, Any]:
        """Return the fit in SI; T of the law in its scale."""
        statistics = {name: value for name, value in vars(self.statistics).items() if name != "variables"}
        return json_record(
            {
                "law": "B = a T^b w^c" if self.b else "B = a w^c",
                "temperature_scale": self.temperature_scale,
                "reference_speed": self.reference_speed,
                "reference_temperature": self.reference_temperature,
                "coefficients": self.coefficients(),
                "torque_space": self.torque_space,
                "transition": self.transition,
                "no_transition": self.rejected_transition,
                "variables": self.variables,
                "values": self.values,
                "covariance": self.covariance,
                "variance_parts": self.freedoms.parts,
                "variance_uncertainty": self.freedoms.uncertainty,
                **statistics,
                "speed_range": self.speed_range,
                "temperature_range": self.temperature_range,
                "sensors": self.sensors,
                "rest": self.rest,
                "summary": self.summary(),
            }
        )

    def to_frame(self) -> pl.DataFrame:
        """Return the coefficients with error and 95 % interval; T of the law in its scale, w in rad/s."""
        import polars as pl

        named = [(name, estimate, "") for name, estimate in self.coefficients().items()]
        if self.transition is not None:
            named.append(("c_mixed", self.transition.mixed_exponent, ""))
            named.append(("w_t", self.transition.speed, "rad/s"))
        named[0] = ("a", self.a, "N m s/rad at T = 1, w = 1")
        rows = [(name, e.value, e.error, e.low, e.high, unit) for name, e, unit in named]
        numbers = dict.fromkeys(("value", "error", "low", "high"), pl.Float64)
        return pl.DataFrame(rows, schema={"name": pl.String, **numbers, "unit": pl.String}, orient="row")

    def log_temperature(self, kelvin: FloatArray) -> FloatArray:
        """Return the logarithm of temperatures (K) over the reference, in the scale of the law; any shape."""
        assert self._law.thermal is not None
        return self._law.thermal.shape(kelvin)[0]

    def _checked_temperature(self, temperature: float) -> float:
        """The same for one temperature where the powers of the law have a meaning."""
        scaled = float(scaled_temperature(np.asarray(temperature, dtype=float), self.temperature_scale))
        if not (np.isfinite(scaled) and scaled > 0):
            raise ParameterError(
                f"temperature is {temperature:g} K: a law in {self.temperature_scale} holds above 0 "
                f"{self.temperature_scale} only"
            )
        return float(self.log_temperature(np.asarray(temperature, dtype=float)))

    def _warn_outside(self, name: str, values: FloatArray, limits: tuple[float, float] | None) -> None:
        if limits and (np.any(values < limits[0] * 0.999) or np.any(values > limits[1] * 1.001)):
            unit = "rad/s" if name == "speed" else "K"
            warnings.warn(
                f"{name} outside the measured {limits[0]:.4g} to {limits[1]:.4g} {unit}: extrapolated",
                ExtrapolationWarning,
                stacklevel=4,
            )


def _transition_exponents(b: FloatArray, c: FloatArray) -> FloatArray:
    return np.array([transition_exponent(*pair) for pair in zip(b.tolist(), c.tolist(), strict=True)])


def _summary(s: DampingSurface) -> str:
    law = "B = a T^b w^c" if s.b else "B = a w^c"
    unit = f"T in {s.temperature_scale}, " if s.b else ""
    st = s.statistics
    lines = [
        "[[Model]]",
        f"    {law}    (B in N m s/rad, {unit}w in rad/s)",
        "[[Fit Statistics]]",
        "    # fitting method   = robust likelihood of ln torque, errors of torque, speed and temperature",
        f"    # scatter added    = {st.scatter:.3%} between dwells, beyond the errors of their means",
        *(f"    # scatter shared   = {_shared_text(shared)}" for shared in st.shared),
        *_sensors_text(s.sensors),
        *_rest_text(s.rest),
        f"    # data points      = {st.points}",
        f"    # variables        = {st.variables}",
        f"    chi-square         = {st.chi_square:.6g}  (against the errors of the dwells alone)",
        f"    reduced chi-square = {st.reduced_chi_square:.6g}  (1 if these errors explained it all)",
        f"    Akaike (AICc)      = {st.aicc:.6g}",
        f"    R-squared, torque  = {st.r_squared_torque:.6f}",
        f"    R-squared, damping = {st.r_squared_damping:.6f}  (division by speed spreads the values:",
        "                         nearer 1, yet it tells no more)",
        "[[Variables]]                                        95 % interval",
    ]
    lines += [_variable("a", s.a), *([_variable("b", s.b)] if s.b else []), _variable("c", s.c)]
    if s.transition:
        at = (
            ""
            if s.reference_temperature is None
            else f" at {temperature_text(s.reference_temperature, s.temperature_scale)}"
        )
        lines += [
            _variable("c_mixed", s.transition.mixed_exponent),
            _variable("w_t", s.transition.speed) + f"  rad/s{at}",
        ]
        if s.b:
            lines.append(f"    w_t varies as T^{s.transition.temperature_exponent:.3g} (fixed Hersey number)")
        lines.append("    below w_t the exponent is c_mixed")
        if s.transition.gradual:
            lines.append("    the bend is gradual: w_t is where a smooth curve through the dwells is least,")
            lines.append(f"    the trend lines on either side meet at {s.transition.meeting_speed:.4g} rad/s")
    lines += ["[[Fitted in torque space, errors absolute]]"]
    lines += [_variable(name, estimate) for name, estimate in s.torque_space.items()]
    lines += ["[[Correlations]] (unreported are below 0.1)", *_correlations(s)]
    return "\n".join(lines)


def _variable(name: str, e: Estimate) -> str:
    if not e.told:
        return f"    {name:8s} {e.value: .7g}, interval not told"
    share = f"({abs(e.error / e.value):.2%})" if e.value else ""
    ends = f"[{e.low:.6g}, {e.high:.6g}]"
    sensors = f"  sensors +/- {e.systematic:.2g}" if e.systematic else ""
    return f"    {name:8s} {e.value: .7g} +/- {e.error:.3g} {share:10s} {ends}{sensors}"


def _sensors_text(sensors: str) -> list[str]:
    """Errors of the sensors in lines that a page holds."""
    return (
        textwrap.wrap(f"    # sensors +/-      = {sensors}", 96, subsequent_indent=25 * " ")
        if sensors
        else []
    )


def _rest_text(rest: RestOfDrive | None) -> list[str]:
    """What was taken off before the fit, in lines that a page holds."""
    if rest is None:
        return []
    told = f"    # torque of film   = measured less the rest of the drive: {rest}"
    return textwrap.wrap(told, 96, subsequent_indent=25 * " ")


def _shared_text(shared: SharedScatter) -> str:
    if not shared.told:
        few = "too few, or the law takes up what they differ by"
        return f"by the dwells of a {shared.name}: not told, they are {few}"
    return f"{shared.deviation:.3%} by the dwells of a {shared.name} (p = {shared.p_value:.2g} for none)"


def _correlations(s: DampingSurface) -> list[str]:
    deviation = np.sqrt(np.diag(s.covariance))
    pairs = []
    for i, first in enumerate(s.variables):
        for j in range(i + 1, len(s.variables)):
            spread = deviation[i] * deviation[j]
            r = float(s.covariance[i, j] / spread) if spread else 0.0
            if abs(r) >= 0.1:
                pairs.append((-abs(r), f"    C({first}, {s.variables[j]}) = {r:+.4f}"))
    return [text for _, text in sorted(pairs)]


def temperature_text(kelvin: float, scale: str) -> str:
    """Return a temperature (K) in the scale of a law, for people."""
    return f"{kelvin:.4g} K" if scale == "K" else f"{celsius(kelvin):.4g} degC"
