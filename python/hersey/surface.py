"""The damping surface B = a T^b w^c (Eq. 4 of the paper), with a falling branch where the data show one.

The fit is weighted least squares in ln B about reference values, where the coefficients are well
conditioned. The variance of a dwell is that of its mean plus a scatter between dwells, which is found so
that chi-square equals the degrees of freedom (Paule and Mandel, J. Res. NBS 87 (1982) 377). The same law
is fitted in torque space, where errors are absolute, for comparison.

Where the torque falls with speed (c < -1) below a transition speed, a second branch with an exponent of its
own meets the first there. The points part where torque is least (isotonic regression, no law assumed), each
branch is a trend line through its own, and the transition is where the two meet. It sits at a fixed Hersey
number, so that with B ~ viscosity^(1+c) it moves with temperature as T^(-b/(1+c)).
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import optimize, stats

from hersey import _core
from hersey.errors import ExtrapolationWarning, InsufficientDataError, ParameterError
from hersey.log.torque_log import FloatArray
from hersey.motion import Drag
from hersey.steady import SteadyPoints, groups_of_temperature, rpm
from hersey.units import convert

BoolArray = NDArray[np.bool_]

#: Confidence of every interval.
CONFIDENCE = 0.95
#: AICc by which a second branch must beat a single power law before it is announced.
EVIDENCE = 6.0
#: Points and distinct speeds that each branch needs.
MIN_BRANCH_POINTS, MIN_BRANCH_SPEEDS = 4, 3
#: Residuals (of logarithms, or of torques in N m) below this are those of exact data.
ROUNDING = 1e-13
#: Speeds closer than this share count as the same.
SAME_SPEED = 0.03


@dataclass(frozen=True)
class Estimate:
    """A number with its standard error and its 95 % interval."""

    value: float
    error: float
    low: float
    high: float

    def __str__(self) -> str:
        """Return value and interval with sensible digits."""
        return f"{self.value:.4g} [{self.low:.4g}, {self.high:.4g}]"


@dataclass(frozen=True)
class Transition:
    """Where the falling (mixed) branch meets the rising (EHL) one."""

    speed: Estimate  #: rad/s, at the reference temperature of the surface, where the branches meet
    least_torque_speed: (
        float  #: rad/s, there too: between the slow and the fast points, where torque is least
    )
    mixed_exponent: Estimate  #: exponent of damping in speed below it
    temperature_exponent: float  #: transition speed varies as T to this power
    evidence: float  #: AICc of the single power law minus that of the two branches


@dataclass(frozen=True)
class FitStatistics:
    """How well the law describes the points."""

    points: int
    variables: int
    chi_square: float
    reduced_chi_square: float
    scatter: float  #: relative, between dwells, beyond the standard errors of their means
    aicc: float
    r_squared_damping: float
    r_squared_torque: float


@dataclass(frozen=True)
class DampingSurface:
    """A fitted law B = a T^b w^c; T in ``temperature_scale``, w in rad/s, B in N m s/rad.

    ``b`` is None for isothermal data. ``covariance`` is that of ``variables``, the numbers fitted, about
    ``reference_speed`` (rad/s) and ``reference_temperature`` (in the scale). ``torque_space`` holds a, b, c
    of the fit to torque. ``speed_range`` and ``temperature_range`` (SI) bound the data.
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
    torque_space: dict[str, Estimate]
    statistics: FitStatistics
    speed_range: tuple[float, float]
    temperature_range: tuple[float, float] | None
    residuals: FloatArray  #: ln(measured/fitted), shape (points,)
    rejected_transition: str  #: why a second branch is not announced, empty if it is
    data_sha256: tuple[str, ...]
    version: str = field(default=_core.VERSION)

    def damping(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> FloatArray:
        """Return damping in N m s/rad at speeds (rad/s) and temperatures (K), broadcast together.

        Warns with `ExtrapolationWarning` outside the range of the data.
        """
        speeds = np.abs(np.asarray(speed, dtype=float))
        self._warn_outside("speed", speeds, self.speed_range)
        z = np.log(speeds / self.reference_speed)
        if self.b is None or self.reference_temperature is None or temperature is None:
            if self.b is not None:
                raise ParameterError("this law depends on temperature: give it one, in K")
            x = np.zeros(())
        else:
            temperatures = np.asarray(temperature, dtype=float)
            self._warn_outside("temperature", temperatures, self.temperature_range)
            x = np.log(_scaled(temperatures, self.temperature_scale) / self.reference_temperature)
        return np.asarray(np.exp(_log_damping(self.values, x, z, self.b is not None)))

    def torque(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> FloatArray:
        """Return drag torque in N m, with the sign of the speed (rad/s); temperature in K."""
        return np.asarray(self.damping(speed, temperature) * np.asarray(speed, dtype=float))

    def transition_speed(self, temperature: float | None = None) -> float:
        """Return the transition speed in rad/s at a temperature (K); NaN where the data show none."""
        if self.transition is None:
            return float("nan")
        if temperature is None or self.reference_temperature is None:
            return self.transition.speed.value
        ratio = float(_scaled(np.asarray(temperature), self.temperature_scale)) / self.reference_temperature
        return float(self.transition.speed.value * ratio**self.transition.temperature_exponent)

    def drag(self, *, roll_radius: float, stick_speed: float, temperature: float | None = None) -> Drag:
        """Return the drag on the belt surface at one temperature.

        Parameters
        ----------
        roll_radius
            Radius at which torque acts on the belt, m.
        stick_speed
            Belt speed below which the belt sticks, m/s; no steady log can show it.
        temperature
            K; not needed for an isothermal law.

        Raises
        ------
        InsufficientDataError
            If the data show no transition: without a falling branch there is no stick-slip to compute.
        """
        if self.transition is None:
            raise InsufficientDataError(f"the data show no falling branch ({self.rejected_transition})")
        speed = self.transition_speed(temperature)
        with warnings.catch_warnings():  # the transition may lie below the slowest dwell at this temperature
            warnings.simplefilter("ignore", ExtrapolationWarning)
            torque = float(self.torque(speed, temperature))
        return Drag(
            transition_force=torque / roll_radius,
            transition_speed=speed * roll_radius,
            ehl_exponent=self.c.value,
            mixed_exponent=self.transition.mixed_exponent.value,
            stick_speed=stick_speed,
        )

    def summary(self) -> str:
        """Return the fit as text, in the layout that users of lmfit know."""
        return _summary(self)

    def _warn_outside(self, name: str, values: FloatArray, limits: tuple[float, float] | None) -> None:
        if limits and (np.any(values < limits[0] * 0.999) or np.any(values > limits[1] * 1.001)):
            unit = "rad/s" if name == "speed" else "K"
            warnings.warn(
                f"{name} outside the measured {limits[0]:.4g} to {limits[1]:.4g} {unit}: extrapolated",
                ExtrapolationWarning,
                stacklevel=3,
            )


def fit(points: SteadyPoints, *, temperature_scale: str = "degC") -> DampingSurface:
    """Fit the damping surface to steady points.

    Parameters
    ----------
    points
        From `TorqueLog.steady`.
    temperature_scale
        ``degC`` (as the paper) or ``K``: a and b depend on it.

    Raises
    ------
    InsufficientDataError
        If the points hold fewer than three speeds, or a temperature that does not vary.
    """
    data = _Data.of(points, temperature_scale)
    single = _fit_single(data)
    branched = _fit_branched(data, single)
    chosen, transition, refused = single, None, "too few points for a second branch"
    if branched is not None:
        refused = _why_no_transition(data, single, branched)
        if not refused:
            chosen, transition = branched, _transition(data, single, branched)
    return _surface(points, data, chosen, transition, refused)


@dataclass(frozen=True)
class _Data:
    """Logarithms about the reference point: y of damping, x of temperature (None: isothermal), z of speed."""

    y: FloatArray
    x: FloatArray | None
    z: FloatArray
    error: FloatArray
    torque: FloatArray
    torque_error: FloatArray
    speed: FloatArray
    scale: str
    reference_speed: float
    reference_temperature: float | None

    @classmethod
    def of(cls, points: SteadyPoints, scale: str) -> _Data:
        if scale not in ("degC", "K"):
            raise ParameterError(f"temperature scale '{scale}' is not known: degC or K")
        speed, torque = np.abs(points.column("speed")), np.abs(points.column("torque"))
        _require_speeds(speed)
        x, reference = None, None
        if points.log.has_temperature:
            kelvin = points.column("temperature")
            _require_temperatures(kelvin)
            temperature = _scaled(kelvin, scale)
            if np.any(temperature <= 0):
                raise InsufficientDataError(
                    "T^b has no meaning at or below 0 degC: fit with --temperature-scale K"
                )
            reference = float(np.exp(np.mean(np.log(temperature))))
            x = np.log(temperature / reference)
        count = speed.size
        needed = 3 + (x is not None)
        if count <= needed:
            raise InsufficientDataError(
                f"{count} steady points cannot determine {needed - 1} coefficients and their errors: "
                f"at least {needed + 1} are needed"
            )
        reference_speed = float(np.exp(np.mean(np.log(speed))))
        torque_error = points.column("torque_error")
        error = np.hypot(torque_error / torque, points.column("speed_error") / speed)
        return cls(
            np.log(torque / speed),
            x,
            np.log(speed / reference_speed),
            error,
            torque,
            torque_error,
            speed,
            scale,
            reference_speed,
            reference,
        )

    @property
    def thermal(self) -> bool:
        return self.x is not None

    @property
    def temperatures(self) -> FloatArray:
        return np.zeros_like(self.z) if self.x is None else self.x


def _require_speeds(speed: FloatArray) -> None:
    count = distinct_speeds(speed)
    if count < 3:
        held = " and ".join(f"{rpm(float(v)):.4g} rpm" for v in np.unique(np.round(speed, 2))[:2])
        raise InsufficientDataError(
            f"the steady points are all at {held}: no exponent of speed can be claimed; "
            "record dwells at three speeds or more"
        )


def _require_temperatures(kelvin: FloatArray) -> None:
    if sum(1 for _ in groups_of_temperature(kelvin)) < 2:
        low, high = (convert(float(t), "K", "degC") for t in (kelvin.min(), kelvin.max()))
        raise InsufficientDataError(
            f"all steady points are at one temperature ({low:.1f} to {high:.1f} degC): no exponent b can be "
            "claimed; record other temperatures, or say --isothermal to fit B = a w^c at this one"
        )


def distinct_speeds(speed: FloatArray) -> int:
    """Return how many different speeds there are, to `SAME_SPEED`."""
    ordered = np.sort(speed)
    return int(1 + np.count_nonzero(np.diff(np.log(ordered)) > SAME_SPEED)) if ordered.size else 0


def _scaled(kelvin: FloatArray, scale: str) -> FloatArray:
    return kelvin if scale == "K" else np.asarray(kelvin - 273.15)


def _log_damping(values: FloatArray, x: FloatArray, z: FloatArray, thermal: bool) -> FloatArray:
    """The law in logarithms; ``values`` are ln B_ref, [b], c and, with a second branch, c_mixed - c, z_t."""
    level, b, c = (values[0], values[1], values[2]) if thermal else (values[0], 0.0, values[1])
    law = level + b * x + c * z
    if values.size > 3 + thermal - 1:
        change, at = values[-2:]
        law = law + change * np.minimum(z - at - _hersey_exponent(b, c) * x, 0.0)
    return np.asarray(law)


def _hersey_exponent(b: float, c: float) -> float:
    """Exponent of the transition speed in temperature at a fixed Hersey number; 0 where B tells nothing."""
    return -b / (1.0 + c) if 1.0 + c > 0.1 else 0.0


@dataclass(frozen=True)
class _Solution:
    values: FloatArray
    covariance: FloatArray
    scatter: float
    residuals: FloatArray
    sigma: FloatArray
    last_interval: tuple[float, float] | None = None
    parted_at: float = float("nan")  # ln of the scaled speed between the branches' points

    def interval_of_last(self) -> tuple[float, float]:
        """The interval of the last value alone."""
        picked = np.zeros(self.values.size)
        picked[-1] = 1.0
        estimate = self.estimate(picked)
        return estimate.low, estimate.high

    @property
    def chi_square(self) -> float:
        return float(np.sum((self.residuals / self.sigma) ** 2))

    def aicc(self, errors: FloatArray) -> float:
        """Corrected Akaike criterion, with the scatter that makes the residuals likeliest."""

        def deviance(scatter: float) -> float:
            variance = errors**2 + scatter**2
            return float(np.sum(np.log(2 * np.pi * variance) + self.residuals**2 / variance))

        top = 3.0 * float(np.std(self.residuals)) + 1e-12
        best = min(
            deviance(float(optimize.minimize_scalar(deviance, bounds=(0.0, top), method="bounded").x)),
            deviance(0.0) if np.all(errors > 0) else np.inf,
        )
        # the scatter is a variable too; a split costs none of its own, as the branches meet nearby
        count, variables = self.residuals.size, self.values.size + 1
        return best + 2 * variables + 2 * variables * (variables + 1) / max(count - variables - 1, 1)

    def estimate(self, weights: FloatArray) -> Estimate:
        """A linear combination of the values."""
        value = float(weights @ self.values)
        error = float(np.sqrt(max(float(weights @ self.covariance @ weights), 0.0)))
        reach = _quantile(self.residuals.size - self.values.size) * error
        return Estimate(value, error, value - reach, value + reach)


def _quantile(freedom: int) -> float:
    return float(stats.t.ppf(0.5 + CONFIDENCE / 2, max(freedom, 1)))


def _solve(residual: Callable[[FloatArray], FloatArray], errors: FloatArray, start: FloatArray) -> _Solution:
    """Least squares with a scatter beyond the errors, found so that chi-square equals the freedom."""
    freedom = errors.size - start.size
    values, scatter = start, float(np.std(residual(start)))
    floor = 1e-9 * max(scatter, float(np.max(errors)), 1e-12)
    result = None
    for _ in range(12):
        sigma = np.sqrt(errors**2 + scatter**2 + floor**2)
        weighted = partial(_weighted, residual, sigma)
        result = optimize.least_squares(weighted, values, x_scale="jac", xtol=1e-14)
        values = result.x
        updated = _scatter(residual(values), errors, freedom)
        if abs(updated - scatter) <= 1e-6 * max(scatter, floor):
            break
        scatter = updated
    assert result is not None
    jacobian = np.asarray(result.jac)
    covariance = np.linalg.pinv(jacobian.T @ jacobian)
    return _Solution(values, covariance, scatter, residual(values), sigma)


def _weighted(
    residual: Callable[[FloatArray], FloatArray], sigma: FloatArray, values: FloatArray
) -> FloatArray:
    return np.asarray(residual(values) / sigma)


def _scatter(residuals: FloatArray, errors: FloatArray, freedom: int) -> float:
    def excess(scatter: float) -> float:
        return float(np.sum(residuals**2 / (errors**2 + scatter**2))) - freedom

    top = float(np.sqrt(np.sum(residuals**2) / freedom))
    if top < ROUNDING or (np.all(errors > 0) and excess(0.0) <= 0):
        return 0.0
    low = 0.0 if np.all(errors > 0) else 1e-9 * top
    return float(optimize.brentq(excess, low, top)) if excess(low) > 0 else 0.0


def _fit_single(data: _Data) -> _Solution:
    columns = [np.ones_like(data.z), *([data.x] if data.x is not None else []), data.z]
    start, *_ = np.linalg.lstsq(np.column_stack(columns), data.y, rcond=None)
    return _solve(_residual(data), data.error, np.asarray(start))


def _residual(data: _Data) -> Callable[[FloatArray], FloatArray]:
    return lambda values: data.y - _log_damping(values, data.temperatures, data.z, data.thermal)


def _branch_residual(data: _Data, below: BoolArray) -> Callable[[FloatArray], FloatArray]:
    """Residuals with each point held to its branch, as with trend lines drawn through either side."""
    thermal = data.thermal

    def residual(values: FloatArray) -> FloatArray:
        level, b, c = (values[0], values[1], values[2]) if thermal else (values[0], 0.0, values[1])
        change, at = values[-2:]
        reach = data.z - at - _hersey_exponent(b, c) * data.temperatures
        return np.asarray(data.y - level - b * data.temperatures - c * data.z - change * below * reach)

    return residual


def _fit_branched(data: _Data, single: _Solution) -> _Solution | None:
    """Two branches, parted where torque is least."""
    best, values = None, single.values
    for _ in range(4):  # which points are slow depends on b and c, which depend on it
        b, c = (values[1], values[2]) if data.thermal else (0.0, values[1])
        splits = _splits(data, _hersey_exponent(b, c))
        if not splits:
            return None
        limit = splits[0][0] + _quantile(data.y.size) ** 2
        solved = [(chi, below, _solve_split(data, below)) for chi, below in splits if chi <= limit]
        ends = [solution.interval_of_last() for _, _, solution in solved]
        likeliest = [s for s in solved if s[0] <= splits[0][0] + 1e-9]
        _, below, best = min(likeliest, key=lambda s: s[2].chi_square)
        scaled = data.z - _hersey_exponent(b, c) * data.temperatures
        best = replace(
            best,
            last_interval=(min(e[0] for e in ends), max(e[1] for e in ends)),
            parted_at=0.5 * float(scaled[below].max() + scaled[~below].min()),
        )
        if np.allclose(values, best.values[:-2], rtol=1e-9):
            break
        values = best.values[:-2]
    return best


def _solve_split(data: _Data, below: BoolArray) -> _Solution:
    columns = [np.ones_like(data.z), *([data.x] if data.x is not None else []), data.z]
    slow = [below * 1.0, below * data.z]
    start, *_ = np.linalg.lstsq(np.column_stack([*columns, *slow]), data.y, rcond=None)
    jump, change = float(start[-2]), float(start[-1])
    at = -jump / change if change else float(data.z[below].max())
    return _solve(_branch_residual(data, below), data.error, np.append(start[:-2], [change, at]))


def _splits(data: _Data, temperature_exponent: float) -> list[tuple[float, BoolArray]]:
    """Which points are slow, for every split with enough points on either side, the likeliest first.

    At a fixed Hersey number torque is a function of scaled speed alone. Its best falling curve below the
    split and best rising curve above it (isotonic regression, no law assumed) say how likely the split is.
    """
    scaled = data.z - temperature_exponent * data.temperatures
    torque = data.y + data.z
    order = np.argsort(scaled, kind="stable")
    scatter = _scatter(_unimodal_residuals(torque[order]), data.error[order], max(scaled.size // 2, 1))
    weights = 1.0 / (data.error[order] ** 2 + scatter**2 + 1e-18)
    found = []
    for i in np.nonzero(np.diff(scaled[order]) > 0.5 * SAME_SPEED)[0]:
        below = np.asarray(scaled <= 0.5 * (scaled[order][i] + scaled[order][i + 1]))
        if _enough(data, below) and _enough(data, ~below):
            sides = (slice(None, i + 1), False), (slice(i + 1, None), True)
            chi = 0.0
            for side, rising in sides:
                values = torque[order][side]
                curve = optimize.isotonic_regression(values, weights=weights[side], increasing=rising)
                chi += float(np.sum(weights[side] * (values - curve.x) ** 2))
            found.append((chi, below))
    return sorted(found, key=lambda f: f[0])


def _unimodal_residuals(torque: FloatArray) -> FloatArray:
    """Residuals of the best curve that falls, then rises."""
    best: FloatArray = np.asarray(torque - torque.mean())
    for i in range(1, torque.size):
        falling = optimize.isotonic_regression(torque[:i], increasing=False).x
        rising = optimize.isotonic_regression(torque[i:]).x
        residuals = torque - np.append(falling, rising)
        if residuals @ residuals < best @ best:
            best = np.asarray(residuals)
    return best


def _enough(data: _Data, side: BoolArray) -> bool:
    points, speeds = int(np.count_nonzero(side)), distinct_speeds(data.speed[side])
    return points >= MIN_BRANCH_POINTS and speeds >= MIN_BRANCH_SPEEDS


def _weights(data: _Data, solution: _Solution, **share: float) -> FloatArray:
    """Weights that pick a combination of the values by name."""
    names = _variables(data, solution)
    return np.array([share.get(name, 0.0) for name in names])


def _variables(data: _Data, solution: _Solution) -> tuple[str, ...]:
    names = ("level", *(("b",) if data.thermal else ()), "c", "change", "at")
    return names[: solution.values.size]


def _why_no_transition(data: _Data, single: _Solution, branched: _Solution) -> str:
    """Why a second branch is not announced; empty if the torque falls and rises beyond doubt."""
    below = branched.estimate(_weights(data, branched, c=1.0, change=1.0))
    above = branched.estimate(_weights(data, branched, c=1.0))
    gain = single.aicc(data.error) - branched.aicc(data.error)
    if gain < EVIDENCE:
        return f"a second branch does not pay: its AICc is better by {gain:.1f}, {EVIDENCE:g} are asked"
    if below.high >= -1.0:
        return (
            f"below {rpm(data.reference_speed * float(np.exp(branched.values[-1]))):.3g} rpm the exponent is "
            f"{below}: torque does not fall with speed beyond doubt"
        )
    if above.low <= -1.0:
        return f"above the bend the exponent is {above}: torque does not rise with speed beyond doubt"
    if not data.z.min() < branched.values[-1] < data.z.max():
        return "the falling and the rising branch do not meet within the speeds measured"
    return ""


def _transition(data: _Data, single: _Solution, branched: _Solution) -> Transition:
    mixed = branched.estimate(_weights(data, branched, c=1.0, change=1.0))
    b = float(branched.values[1]) if data.thermal else 0.0
    c = float(branched.values[2 if data.thermal else 1])
    low, high = branched.last_interval or branched.interval_of_last()
    low, high, best = (data.reference_speed * float(np.exp(v)) for v in (low, high, branched.values[-1]))
    reach = _quantile(data.y.size - branched.values.size)
    speed = Estimate(best, best * float(np.log(high / low)) / (2 * reach), low, high)
    gain = single.aicc(data.error) - branched.aicc(data.error)
    least = data.reference_speed * float(np.exp(branched.parted_at))
    return Transition(speed, least, mixed, _hersey_exponent(b, c), gain)


def _fit_torque(data: _Data, solution: _Solution) -> _Solution:
    """The same law fitted to torque, errors absolute; a transition stays where ln B put it."""
    tail = solution.values[-1:] if "at" in _variables(data, solution) else np.empty(0)

    def residual(values: FloatArray) -> FloatArray:
        law = _log_damping(np.append(values, tail), data.temperatures, data.z, data.thermal)
        return np.asarray(data.torque - data.speed * np.exp(law))

    return _solve(residual, data.torque_error, solution.values[: solution.values.size - tail.size])


def _coefficients(data: _Data, solution: _Solution) -> dict[str, Estimate]:
    """a, b and c as Eq. 4 has them, from values about the reference point."""
    speed, temperature = np.log(data.reference_speed), np.log(data.reference_temperature or 1.0)
    log_a = solution.estimate(_weights(data, solution, level=1.0, b=-float(temperature), c=-float(speed)))
    a = float(np.exp(log_a.value))
    out = {"a": Estimate(a, a * log_a.error, float(np.exp(log_a.low)), float(np.exp(log_a.high)))}
    if data.thermal:
        out["b"] = solution.estimate(_weights(data, solution, b=1.0))
    out["c"] = solution.estimate(_weights(data, solution, c=1.0))
    return out


def _surface(
    points: SteadyPoints, data: _Data, solution: _Solution, transition: Transition | None, refused: str
) -> DampingSurface:
    found = _coefficients(data, solution)
    fitted = np.exp(data.y - solution.residuals)
    count, variables = data.y.size, solution.values.size
    statistics = FitStatistics(
        points=count,
        variables=variables,
        chi_square=solution.chi_square,
        reduced_chi_square=solution.chi_square / (count - variables),
        scatter=solution.scatter,
        aicc=solution.aicc(data.error),
        r_squared_damping=_r_squared(np.exp(data.y), fitted),
        r_squared_torque=_r_squared(data.torque, fitted * data.speed),
    )
    labels = {"level": "ln B_ref", "change": "c_mixed - c", "at": "ln(w_t/w_ref)"}
    kelvin = points.column("temperature") if data.thermal else None
    return DampingSurface(
        a=found["a"],
        b=found.get("b"),
        c=found["c"],
        transition=transition,
        temperature_scale=data.scale,
        reference_speed=data.reference_speed,
        reference_temperature=data.reference_temperature,
        variables=tuple(labels.get(name, name) for name in _variables(data, solution)),
        values=solution.values,
        covariance=solution.covariance,
        torque_space=_coefficients(data, _fit_torque(data, solution)),
        statistics=statistics,
        speed_range=(float(data.speed.min()), float(data.speed.max())),
        temperature_range=None if kelvin is None else (float(kelvin.min()), float(kelvin.max())),
        residuals=solution.residuals,
        rejected_transition=refused,
        data_sha256=tuple(file.sha256 for file in points.log.files),
    )


def _r_squared(measured: FloatArray, fitted: FloatArray) -> float:
    return float(1.0 - np.sum((measured - fitted) ** 2) / np.sum((measured - measured.mean()) ** 2))


def _summary(s: DampingSurface) -> str:
    law = "B = a T^b w^c" if s.b else "B = a w^c"
    unit = f"T in {s.temperature_scale}, " if s.b else ""
    st = s.statistics
    lines = [
        "[[Model]]",
        f"    {law}    (B in N m s/rad, {unit}w in rad/s)",
        "[[Fit Statistics]]",
        "    # fitting method   = weighted least squares in ln B, absolute standard errors of the dwells",
        f"    # scatter added    = {st.scatter:.3%} between dwells, beyond the errors of their means",
        f"    # data points      = {st.points}",
        f"    # variables        = {st.variables}",
        f"    chi-square         = {st.chi_square:.6g}",
        f"    reduced chi-square = {st.reduced_chi_square:.6g}",
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
            else f" at {s.reference_temperature:.4g} {s.temperature_scale}"
        )
        lines += [
            _variable("c_mixed", s.transition.mixed_exponent),
            _variable("w_t", s.transition.speed) + f"  rad/s{at}",
            f"    w_t varies as T^{s.transition.temperature_exponent:.3g} (fixed Hersey number); "
            "below it the exponent is c_mixed",
        ]
    lines += ["[[Fitted in torque space, errors absolute]]"]
    lines += [_variable(name, estimate) for name, estimate in s.torque_space.items()]
    lines += ["[[Correlations]] (unreported are below 0.1)", *_correlations(s)]
    return "\n".join(lines)


def _variable(name: str, e: Estimate) -> str:
    share = f"({abs(e.error / e.value):.2%})" if e.value else ""
    return f"    {name:8s} {e.value: .7g} +/- {e.error:.3g} {share:10s} [{e.low:.6g}, {e.high:.6g}]"


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
