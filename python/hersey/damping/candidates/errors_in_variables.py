"""The chosen law fitted once more by orthogonal distance regression (ODRPACK), as a check.

Here true speeds and temperatures are unknowns of their own, each measured with its error; nothing is
linearised. If the parameters move by much less than their errors, the effective variance was good enough.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
import odrpack

from hersey.arrays import FloatArray
from hersey.damping.candidates.fitting import LawFit
from hersey.damping.candidates.observations import Inputs, Observations
from hersey.damping.candidates.shared_load import SharedLoadLaw
from hersey.result import OPEN, Record

#: Least relative error of an input: ODRPACK divides by it.
_LEAST = 1e-9
#: Shift, in standard errors, from which on the two methods differ.
_NOTICEABLE = 0.5


@dataclass(frozen=True)
class OrthogonalFit(Record):
    """The values by orthogonal distance regression, beside those by effective variance."""

    also_stated = ("verdict",)
    not_stated = ("values",)

    values: FloatArray
    largest_shift: Annotated[float, OPEN]  #: of any parameter, in its standard error
    share: Annotated[float, OPEN]  #: of the variance of a dwell that comes from speed and temperature
    converged: bool

    @property
    def verdict(self) -> str:
        """What to make of it."""
        part = f"Errors of speed and temperature make up {100 * self.share:.1f} % of the variance of a dwell"
        if not self.converged:
            return f"{part}. The check by orthogonal distance regression (ODRPACK) did not converge."
        moved = "Orthogonal distance regression (ODRPACK) moves no parameter by more than "
        moved += f"{self.largest_shift:.2g}"
        if self.largest_shift < _NOTICEABLE:
            return f"{part}. {moved} of its standard error, so the effective variance is accurate enough."
        return (
            f"{part}. Orthogonal distance regression (ODRPACK) moves a parameter by "
            f"{self.largest_shift:.2g} of its standard error, so the law bends within an error bar. "
            "Hold speed and temperature more constant."
        )


def orthogonal_fit(fit: LawFit, data: Observations) -> OrthogonalFit:
    """Return the fit by orthogonal distance regression, from the values of another."""
    varies = fit.law.thermal is not None or isinstance(fit.law, SharedLoadLaw)
    hot = data.inputs.kelvin if varies else None
    given = [data.inputs.log_speed, *([hot] if hot is not None else [])]
    errors = [data.speed_error, *([data.temperature_error] if hot is not None else [])]
    least = [_LEAST, *([_LEAST * float(np.mean(hot))] if hot is not None else [])]
    clipped = [np.maximum(e, floor) for e, floor in zip(errors, least, strict=True)]
    weights = 1.0 / np.vstack(clipped) ** 2
    corrected = data.log_torque - fit.disturbances @ fit.effects

    def law(x: FloatArray, values: FloatArray) -> FloatArray:
        return fit.law.predict(values, _inputs(data.inputs, x))

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        regression = odrpack.odr_fit(
            law,
            np.vstack(given),
            corrected,
            fit.values,
            weight_x=weights,
            weight_y=1.0 / (data.torque_error**2 + fit.scatter**2 + 1e-20),
            diff_scheme="central",
            maxit=100,
        )
    error = np.sqrt(np.maximum(np.diag(fit.covariance), 1e-300))
    share = float(np.mean((fit.errors**2 - data.torque_error**2) / fit.sigma**2))
    shift = float(np.max(np.abs(regression.beta - fit.values) / error))
    return OrthogonalFit(np.asarray(regression.beta), shift, max(share, 0.0), bool(regression.success))


def _inputs(inputs: Inputs, x: FloatArray) -> Inputs:
    rows = np.atleast_2d(x)
    return replace(inputs, log_speed=rows[0], kelvin=rows[1] if rows.shape[0] > 1 else inputs.kelvin)
