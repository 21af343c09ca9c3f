"""Which dwells to record next: those that make a fitted law known best.

D-optimal points make the volume of the joint confidence region of all parameters least; c-optimal points make
the variance of one quantity least. Points are added one at a time, each the best given those before it
(Fedorov's exchange, additions only). As a law with a corner is not smooth in where it bends, the gain is
averaged over draws of the fit. No dwell more takes away what those measured share: each further one is taken
as a visit of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.candidates.fitting import LawFit
from hersey.damping.candidates.intervals import Quantity, of_one_dwell, quantities
from hersey.damping.candidates.model_comparison import ModelComparison
from hersey.damping.candidates.observations import Inputs
from hersey.errors import InsufficientDataError, ParameterError
from hersey.result import Means, Record, Result
from hersey.units import convert, rpm, takes_si

if TYPE_CHECKING:
    import polars as pl

#: Speeds of the candidate grid.
SPEEDS = 25
#: Draws of the fit over which the gain is averaged.
DRAWS = 40


@dataclass(frozen=True)
class DesignPoint(Record):
    """A dwell to record, and the precision reached after it and the dwells before it."""

    speed: Annotated[float, Means(unit="rad/s")]
    kelvin: Annotated[float | None, Means(unit="K")]
    error: Annotated[float | None, Means("of the quantity after this dwell, in its unit")]
    volume: Annotated[float, Means("volume of the confidence region, relative to the present one", open=True)]


@dataclass(frozen=True, repr=False)
class TestDesign(Result):
    """The next dwells to record, the most useful first."""

    __test__ = False  # no test of pytest's

    quantity: str  #: what is to be known better; empty for all parameters
    unit: str
    error_now: float | None
    points: tuple[DesignPoint, ...]
    law: str
    seed: int

    def summary(self) -> str:
        """Return the dwells as text."""
        what = f"to determine the {self.quantity}" if self.quantity else "to determine all parameters"
        lines = [f"Next dwells {what} (model: {self.law}; seed {self.seed}):"]
        if self.error_now is not None:
            lines.append(f"  present standard error: {self._shown(self.error_now)}")
        for number, point in enumerate(self.points, 1):
            hot = "" if point.kelvin is None else f" at {convert(point.kelvin, 'K', 'degC'):.0f} degC"
            then = (
                f"confidence region of all parameters shrinks to {100 * point.volume:.0f} %"
                if point.error is None
                else f"standard error {self._shown(point.error)}"
            )
            lines.append(f"  {number}. {rpm(point.speed):.3g} rpm{hot}: {then}")
        return "\n".join(lines)

    def to_frame(self) -> pl.DataFrame:
        """Return one row per dwell, in order."""
        import polars as pl

        unit = self.unit or "1"
        rows = [(p.speed, p.kelvin, p.error, p.volume) for p in self.points]
        names = ("speed (rad/s)", "temperature (K)", f"standard error ({unit})", "volume (1)")
        return pl.DataFrame(rows, schema=dict.fromkeys(names, pl.Float64), orient="row")

    def _shown(self, error: float) -> str:
        if self.unit == "rad/s":
            return f"{rpm(error):.3g} rpm"
        return f"{error:.3g} {self.unit}".rstrip()


@takes_si(speeds="speed", temperatures="temperature")
def design(
    comparison: ModelComparison,
    *,
    count: int = 6,
    quantity: str = "",
    speeds: tuple[float, float] | None = None,
    temperatures: tuple[float, float] | None = None,
    seed: int = 1,
) -> TestDesign:
    """Return the next dwells to record, for the model that a comparison chose.

    Parameters
    ----------
    count
        Number of dwells.
    quantity
        Parameter to determine best, by name or its beginning, e.g. ``transition speed``; default: all.
    speeds, temperatures
        Ranges that can be run, rad/s and K, or with units, e.g. ``("2 rpm", "200 rpm")``; default: the
        measured ranges.
    seed
        Random seed of the draws of the fit.

    Raises
    ------
    ParameterError
        If no parameter has that name, or a range is not ascending.
    InsufficientDataError
        If the data do not determine the model.
    """
    if count < 1:
        raise ParameterError(f"count is {count}: it must be at least 1")
    fit, data = comparison.chosen.fit, comparison.data
    wanted = _wanted(comparison, quantity)
    candidates = _dwells_to_try(comparison, speeds, temperatures)
    rows, information, scale = _information(comparison, candidates, seed)
    start = np.linalg.slogdet(information)[1]
    picked: list[DesignPoint] = []
    for _ in range(count):
        inverse = np.linalg.pinv(information, hermitian=True)
        leverage = np.einsum("kni,kij,knj->kn", rows, inverse, rows)
        if wanted is None:
            gain = np.median(np.log1p(leverage), axis=0)
        else:
            variance = inverse[:, wanted.parameter, wanted.parameter][:, None]
            moved = np.einsum("kni,ki->kn", rows, inverse[:, :, wanted.parameter])
            gain = np.mean(moved**2 / (1.0 + leverage) / variance, axis=0)
        best = int(np.argmax(gain))
        information = information + np.einsum("ki,kj->kij", rows[:, best], rows[:, best])
        volume = float(np.exp(-0.5 * np.median(np.linalg.slogdet(information)[1] - start)))
        error = None if wanted is None else _error(comparison, wanted, information, scale)
        kelvin = None if candidates.kelvin is None else float(candidates.kelvin[best])
        speed = float(data.reference_speed * np.exp(candidates.log_speed[best]))
        picked.append(DesignPoint(speed, kelvin, error, volume))
    now = None
    if wanted is not None:
        now = fit.error(fit.law.names[wanted.parameter]) * _slope(comparison, wanted)
    name, unit = (wanted.name, wanted.unit) if wanted else ("", "")
    return TestDesign(name, unit, now, tuple(picked), comparison.chosen.candidate.name, seed)


def _information(
    comparison: ModelComparison, candidates: Inputs, seed: int
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """What each draw of the fit learns of the values, in today's standard errors, and these.

    From each candidate, shape (draws, candidates, parameters), and from the log, shape (draws, parameters,
    parameters).
    """
    fit = comparison.chosen.fit
    values = _draws(comparison, seed)
    # each further dwell is a visit of its own; of exact data it has no error
    sigma = max(of_one_dwell(fit.scatter, float(np.median(fit.errors)), fit.shared), 1e-10)
    rows = np.stack([fit.law.jacobian(v, candidates) / sigma for v in values])
    measured = np.stack([_beside_shared(fit, fit.law.jacobian(v, comparison.data.inputs)) for v in values])
    information = np.einsum("kni,knj->kij", measured, measured)
    scale = np.sqrt(np.diag(fit.covariance))
    if not np.all(np.isfinite(scale)) or np.any(scale <= 0):
        raise InsufficientDataError("these data do not determine the model. Record more dwells first")
    return rows * scale, information * np.outer(scale, scale), scale


def _beside_shared(fit: LawFit, slopes: FloatArray) -> FloatArray:
    """Derivatives (points, parameters) in standard errors, what shared errors explain subtracted."""
    modes = fit.disturbances.shape[1]
    own = np.vstack([slopes / fit.sigma[:, None], np.zeros((modes, slopes.shape[1]))])
    common = np.linalg.qr(np.vstack([fit.disturbances / fit.sigma[:, None], np.eye(modes)]))[0]
    return np.asarray(own - common @ (common.T @ own))


def _wanted(comparison: ModelComparison, quantity: str) -> Quantity | None:
    if not quantity:
        return None
    known = quantities(comparison.chosen.fit, comparison.data)
    exact = [q for q in known if q.name == quantity]
    matches = exact or [q for q in known if q.name.lower().startswith(quantity.lower())]
    if len(matches) != 1:
        listed = ", ".join(f"'{q.name}'" for q in known)
        raise ParameterError(
            f"'{quantity}' matches {len(matches) or 'no'} parameters of this model. Use one of {listed}"
        )
    return matches[0]


def _dwells_to_try(
    comparison: ModelComparison, speeds: tuple[float, float] | None, temperatures: tuple[float, float] | None
) -> Inputs:
    data = comparison.data
    slow, fast = (data.speed.min(), data.speed.max()) if speeds is None else speeds
    if not 0 < slow < fast:
        raise ParameterError(
            f"speeds are {slow:g} to {fast:g} rad/s: both must be above 0, the lower one first"
        )
    grid = np.geomspace(slow, fast, SPEEDS)
    if data.inputs.kelvin is None or comparison.chosen.fit.law.thermal is None:
        return data.at(grid, None if data.inputs.kelvin is None else data.temperatures[0])
    hots = data.temperatures
    if temperatures is not None:
        cold, hot = temperatures
        if not 0 < cold < hot:
            raise ParameterError(
                f"temperatures are {cold:g} to {hot:g} K: both must be above 0, the lower one first"
            )
        hots = np.linspace(cold, hot, 7)
    both = np.meshgrid(grid, hots)
    return data.at(both[0].ravel(), both[1].ravel())


def _draws(comparison: ModelComparison, seed: int) -> FloatArray:
    """The fit, and draws of it where the law has a corner."""
    fit = comparison.chosen.fit
    if not fit.law.broken:
        return fit.values[None, :]
    random = np.random.default_rng(seed)
    return np.vstack([fit.values, random.multivariate_normal(fit.values, fit.covariance, DRAWS)])


def _error(
    comparison: ModelComparison, wanted: Quantity, information: FloatArray, scale: FloatArray
) -> float:
    """Standard error of a quantity, from today's and the share of its variance that is left."""
    inverse = np.linalg.pinv(information, hermitian=True)
    variance = float(np.median(inverse[:, wanted.parameter, wanted.parameter]))
    return float(np.sqrt(variance)) * float(scale[wanted.parameter]) * _slope(comparison, wanted)


def _slope(comparison: ModelComparison, wanted: Quantity) -> float:
    """How much a quantity changes with its parameter."""
    value = float(comparison.chosen.fit.values[wanted.parameter])
    step = 1e-6 * max(abs(value), 1e-3)
    return abs(wanted.of(value + step) - wanted.of(value - step)) / (2 * step)
