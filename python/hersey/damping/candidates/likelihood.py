"""Robust likelihood of relative residuals, and its least-squares solution.

A residual u, in standard errors, has Huber's least favourable density: normal up to `HUBER`, exponential
beyond (Huber, Ann. Math. Stat. 35 (1964) 73). It is a likelihood, so that laws fitted with it can be compared
by AICc, and yet no single dwell can pull the fit without limit. Solved by MINPACK's Levenberg-Marquardt, on
residuals whose squares are twice the negative logarithm of that density.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy import optimize

from hersey.arrays import FloatArray
from hersey.damping.distributions import normal_above, normal_density
from hersey.errors import InsufficientDataError

#: Standard errors up to which a residual counts as normal; 99 % efficient if all are.
HUBER = 2.5
#: AICc by which a larger law must beat a smaller one before it is announced.
EVIDENCE = 6.0
#: First step of a search over the size of the parameters: a bold one can leave the basin.
FIRST_STEP = 1.0
#: Relative scatter below which data count as exact.
EXACT = 1e-9

Residual = Callable[[FloatArray], FloatArray]
Jacobian = Callable[[FloatArray], FloatArray]
#: Of residuals and their variances: by how much the likeliest effects of what points share move them, these
#: effects, and the logarithm by which they inflate the determinant.
Integration = Callable[[FloatArray, FloatArray], tuple[FloatArray, FloatArray, float]]


@dataclass(frozen=True)
class Minimum:
    """Where the cost is least."""

    values: FloatArray  #: shape (parameters,)
    cost: float  #: twice the negative log-likelihood, without its constants
    jacobian: FloatArray  #: of the residuals in standard errors, weighted, shape (residuals, parameters)


def influence(u: FloatArray, limit: float) -> FloatArray:
    """Return Huber's psi: the residual itself up to a limit, the limit beyond."""
    return np.minimum(np.maximum(u, -limit), limit)


def loss(u: FloatArray, limit: float) -> FloatArray:
    """Return twice Huber's rho: the square up to a limit, linear beyond."""
    size = np.abs(u)
    core = np.minimum(size, limit)
    return np.asarray(core**2 + 2.0 * core * (size - core))


def share(u: FloatArray, limit: float) -> FloatArray:
    """Return the derivative of residuals whose squares are `loss` by the residuals themselves."""
    size = np.abs(u)
    return np.where(size <= limit, 1.0, limit / np.maximum(np.sqrt(loss(u, limit)), 1e-300))


def log_normalisation(limit: float) -> float:
    """Return the logarithm of the integral of exp(-rho)."""
    core = np.sqrt(2 * np.pi) * (1.0 - 2.0 * normal_above(limit))
    tails = 2.0 * np.exp(-0.5 * limit**2) / limit if np.isfinite(limit) else 0.0
    return float(np.log(core + tails))


def minimise(
    residual: Residual,
    jacobian: Jacobian | None,
    start: FloatArray,
    *,
    limit: float = HUBER,
    precision: float = 1e-10,
    calls: int = 40,
) -> Minimum:
    """Return the parameters that make the sum of `loss` least, from ``start``.

    Parameters
    ----------
    residual
        Residuals in standard errors, shape (residuals,), of parameters of shape (parameters,).
    jacobian
        Their derivatives, shape (residuals, parameters); None takes central differences.
    limit
        Of `loss`; infinite for ordinary least squares.
    precision
        Relative change of cost and parameters at which to stop.
    calls
        Most evaluations per parameter.

    Raises
    ------
    InsufficientDataError
        If there are fewer residuals than parameters.
    """
    slopes = jacobian or central_differences(residual)
    remembered, sloping = _remembered(residual), _remembered(slopes)

    def shrunk(values: FloatArray) -> FloatArray:
        u = remembered(values)
        if np.abs(u).max() <= limit:
            return u
        return np.asarray(np.where(np.abs(u) <= limit, u, np.sign(u) * np.sqrt(loss(u, limit))))

    def weighted(values: FloatArray) -> FloatArray:
        u, by = remembered(values), sloping(values)
        if np.abs(u).max() <= limit:
            return by
        return np.asarray(share(u, limit)[:, None] * by)

    # slopes are asked for where residuals have just been, and twice where the search begins
    if (count := remembered(start).size) < start.size:
        raise InsufficientDataError(f"{count} points are too few for {start.size} parameters")
    with np.errstate(over="ignore", invalid="ignore"):  # of a covariance that is not used
        solution, *_ = optimize.leastsq(
            shrunk,
            start,
            Dfun=weighted,
            full_output=True,
            xtol=precision,
            ftol=precision,
            gtol=0.0,
            factor=FIRST_STEP,
            maxfev=calls * (start.size + 1),
        )
    values = np.asarray(solution, dtype=np.float64)
    u = remembered(values)
    kept = np.sqrt(np.clip(limit / np.maximum(np.abs(u), 1e-300), 0.0, 1.0))
    return Minimum(values, float(np.sum(loss(u, limit))), np.asarray(kept[:, None] * sloping(values)))


def _remembered(of: Residual) -> Residual:
    """The same function, which knows what it returned last."""
    last: tuple[bytes, FloatArray] = (b"", np.empty(0))

    def called(values: FloatArray) -> FloatArray:
        nonlocal last
        if (at := values.tobytes()) != last[0]:
            last = at, of(values)
        return last[1]

    return called


def central_differences(residual: Residual) -> Jacobian:
    """Return derivatives by central differences, steps relative to each parameter."""

    def jacobian(values: FloatArray) -> FloatArray:
        columns = []
        for index, value in enumerate(values):
            step = 6e-6 * max(abs(value), 1e-8)
            ahead, behind = values.copy(), values.copy()
            ahead[index], behind[index] = value + step, value - step
            columns.append((residual(ahead) - residual(behind)) / (ahead[index] - behind[index]))
        return np.column_stack(columns)

    return jacobian


def scatter_beyond(residuals: FloatArray, errors: FloatArray, freedom: float, limit: float = HUBER) -> float:
    """Return the scatter beyond the errors at which the residuals are as large as chance has them.

    Paule and Mandel (J. Res. NBS 87 (1982) 377), with squares of Huber's psi in place of squares (his
    proposal 2), so that one bad dwell does not widen every interval.
    """
    outside = float(normal_above(limit))
    expected = 1.0 - 2.0 * outside
    if np.isfinite(limit):
        expected += 2.0 * limit**2 * outside - 2.0 * limit * float(normal_density(limit))

    variance = errors**2

    def excess(scatter: float) -> float:
        u = residuals / np.sqrt(variance + scatter**2)
        return float(np.sum(influence(u, limit) ** 2)) - freedom * expected

    top = 3.0 * float(np.sqrt(np.mean(residuals**2))) * float(np.sqrt(residuals.size / max(freedom, 1.0)))
    if top < EXACT:
        return 0.0
    low = 0.0 if np.all(errors > 0) else 1e-9 * top
    if excess(low) <= 0:
        return 0.0
    return float(optimize.brentq(excess, low, top)) if excess(top) < 0 else top


def deviance(
    residuals: FloatArray,
    errors: FloatArray,
    limit: float = HUBER,
    *,
    shared: FloatArray | Integration | None = None,
) -> tuple[float, float]:
    """Return twice the negative log-likelihood at the scatter that makes it least, and that scatter.

    Parameters
    ----------
    residuals, errors
        Of ln torque, shape (points,).
    shared
        By how much one standard error of each error that points share moves them, shape (points, errors): its
        effect, with the standard normal distribution as prior, is integrated out (Laplace). Or what does so.
    """
    integrated = partial(_integrated, shared) if isinstance(shared, np.ndarray) else shared
    constant = 2.0 * residuals.size * log_normalisation(limit)

    def cost(scatter: float) -> float:
        variance = errors**2 + scatter**2 + EXACT**2
        if integrated is None:
            return float(np.sum(loss(residuals / np.sqrt(variance), limit) + np.log(variance)))
        common, effects, inflation = integrated(residuals, variance)
        u = (residuals - common) / np.sqrt(variance)
        return float(np.sum(loss(u, limit) + np.log(variance)) + effects @ effects + inflation)

    top = 3.0 * float(np.sqrt(np.mean(residuals**2))) + EXACT
    minimum = optimize.minimize_scalar(
        cost, bounds=(0.0, top), method="bounded", options={"xatol": 1e-7 * top}
    )
    best = min((float(minimum.fun), float(minimum.x)), (cost(0.0), 0.0))
    return best[0] + constant, best[1]


def _integrated(
    shared: FloatArray, residuals: FloatArray, variance: FloatArray
) -> tuple[FloatArray, FloatArray, float]:
    weighted = shared / variance[:, None]
    normal = np.eye(shared.shape[1]) + shared.T @ weighted
    effects = np.asarray(np.linalg.solve(normal, weighted.T @ residuals), dtype=np.float64)
    return shared @ effects, effects, float(np.linalg.slogdet(normal)[1])


def aicc(deviance_: float, parameters: int, points: int) -> float:
    """Return Akaike's criterion, corrected for few points (Hurvich and Tsai, Biometrika 76 (1989) 297)."""
    few = parameters * (parameters + 1) / max(points - parameters - 1, 1)
    return deviance_ + 2 * parameters + 2 * few


def bic(deviance_: float, parameters: int, points: int) -> float:
    """Return Schwarz's criterion."""
    return deviance_ + parameters * float(np.log(points))
