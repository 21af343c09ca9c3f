"""Whether a law holds at all: what its residuals still say of speed and temperature.

Terms that the law has not are added to it in the logarithm, z^2 and z^3 in the speed, z t for an exponent
that varies with temperature and t^2 for the law of temperature (t where the law has none), each group tested
by F against what is left when they are there. The errors are those of the fit, shared ones among them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.candidates.fitting import LawFit
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.shared_errors import stated
from hersey.damping.candidates.visit_effects import VisitColumns
from hersey.damping.distributions import ratio_above
from hersey.damping.dwells import distinct_speeds
from hersey.result import Means, Record

#: Speeds and temperatures that a curvature needs.
SPEEDS_OF_CURVATURE, TEMPERATURES_OF_CURVATURE = 4, 3
#: p-value below which a law does not hold: one true law in some two hundred fails one of its tests.
DOES_NOT_HOLD = 0.002


@dataclass(frozen=True)
class LackOfFit(Record):
    """p-values of a law that holds, None where too few speeds or temperatures can say.

    ``local_exponents`` are those of damping at the slow and the fast end, ``by_temperature`` at the coldest
    and the hottest, with the added terms.
    """

    curvature: float | None
    exponent_with_temperature: float | None
    temperature: float | None
    local_exponents: Annotated[tuple[float, float], Means("of damping, at the slow and the fast end")]
    by_temperature: Annotated[tuple[float, float], Means("at the coldest and the hottest temperature")]

    @property
    def in_speed(self) -> bool:
        """Whether the law of speed fails."""
        return self.bent_by(0.0)

    def bent_by(self, least: float) -> bool:
        """Return whether the law of speed fails by more than a change of the exponent that does not count."""
        return any(
            p is not None and p < DOES_NOT_HOLD and abs(ends[1] - ends[0]) > least
            for p, ends in (
                (self.curvature, self.local_exponents),
                (self.exponent_with_temperature, self.by_temperature),
            )
        )

    @property
    def in_temperature(self) -> bool:
        """Whether the law of temperature fails."""
        return self.temperature is not None and self.temperature < DOES_NOT_HOLD

    @property
    def holds(self) -> bool:
        """Whether the law holds as far as these data tell."""
        return not (self.in_speed or self.in_temperature)

    def misses(self) -> list[str]:
        """Return what the law misses, in words."""
        slow, fast = self.local_exponents
        out = []
        if self.curvature is not None and self.curvature < DOES_NOT_HOLD:
            out.append(
                f"the local exponent of damping changes from {slow:.2f} at the slowest speeds to "
                f"{fast:.2f} at the fastest (p = {self.curvature:.1g})"
            )
        if self.exponent_with_temperature is not None and self.exponent_with_temperature < DOES_NOT_HOLD:
            cold, hot = self.by_temperature
            out.append(
                f"the exponent of damping changes from {cold:.2f} at the coldest temperature to "
                f"{hot:.2f} at the hottest (p = {self.exponent_with_temperature:.1g})"
            )
        if self.in_temperature:
            out.append(
                f"the model does not describe how torque varies with temperature (p = {self.temperature:.1g})"
            )
        return out

    @property
    def drift(self) -> float:
        """By how much the local exponent rises from the slow end to the fast one."""
        return self.local_exponents[1] - self.local_exponents[0]


def lack_of_fit(fit: LawFit, data: Observations) -> LackOfFit:
    """Return whether the residuals of a fit still depend on speed or temperature."""
    z = data.inputs.log_speed - float(np.mean(data.inputs.log_speed))
    speeds = distinct_speeds(data.speed)
    bent = [z**2, z**3] if speeds > SPEEDS_OF_CURVATURE else [z**2]
    curvature, added, values = None, np.zeros(len(bent)), fit.values
    if speeds >= SPEEDS_OF_CURVATURE:
        curvature, added, values = _tested(fit, data, bent)
    by_speed = fit.law.slopes(values, data.inputs)[0]
    local = by_speed - 1.0 + sum((k + 2) * b * z ** (k + 1) for k, b in enumerate(added))
    slow, fast = int(np.argmin(z)), int(np.argmax(z))
    ends = float(local[slow]), float(local[fast])
    kelvin = data.inputs.kelvin
    if kelvin is None or data.temperatures.size < 2:
        return LackOfFit(curvature, None, None, ends, (float(np.mean(local)),) * 2)
    warm = kelvin / float(np.mean(kelvin)) - 1.0
    if fit.law.thermal is None:
        return LackOfFit(curvature, None, _tested(fit, data, [warm])[0], ends, (float(np.mean(local)),) * 2)
    varying, tilt, values = _tested(fit, data, [z * warm])
    middle = float(np.mean(fit.law.slopes(values, data.inputs)[0])) - 1.0
    by_temperature = middle + float(tilt[0]) * float(warm.min()), middle + float(tilt[0]) * float(warm.max())
    hot = None
    if data.temperatures.size >= TEMPERATURES_OF_CURVATURE:
        hot = _tested(fit, data, [warm**2])[0]
    return LackOfFit(curvature, varying, hot, ends, by_temperature)


def _tested(
    fit: LawFit, data: Observations, terms: list[FloatArray]
) -> tuple[float | None, FloatArray, FloatArray]:
    """p-value of no such terms, their coefficients, and the values of the law beside them.

    There is no p-value if the law has such terms already, or no freedom is left.
    """
    rows, added, rest = _weighted(fit, data, terms)
    taken_up = np.linalg.lstsq(rows, added, rcond=None)[0]
    left = added - rows @ taken_up
    rest = rest - rows @ np.linalg.lstsq(rows, rest, rcond=None)[0]
    gone = np.linalg.norm(left, axis=0) < 1e-6 * np.linalg.norm(added, axis=0)
    freedom = fit.freedom - len(terms)
    if np.any(gone) or freedom < 1:
        return None, np.zeros(len(terms)), fit.values
    coefficients, *_ = np.linalg.lstsq(left, rest, rcond=None)
    after = float(np.sum((rest - left @ coefficients) ** 2))
    gain = float(rest @ rest) - after
    ratio = gain / len(terms) / max(after / freedom, 1e-300)
    values = fit.values - (taken_up @ coefficients)[: fit.values.size]
    return float(ratio_above(ratio, len(terms), freedom)), np.asarray(coefficients), values


def _weighted(
    fit: LawFit, data: Observations, terms: list[FloatArray]
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Slopes by the values and effects of a fit, terms, and residuals without effects, in standard errors."""
    known, columns = fit.law.jacobian(fit.values, data.inputs), fit.disturbances
    rest = fit.residuals + columns @ fit.effects
    own = VisitColumns.among(columns, data.visit, stated(data))
    others = columns if own is None else own.others(columns)
    modes = others.shape[1]
    weigh = (1.0 / fit.sigma)[:, None]
    every = [np.column_stack(each) * weigh for each in ([known, others], terms, [rest])]
    if own is not None:
        every = [own.freed(each, fit.sigma) for each in every]
    rows = np.vstack([every[0], np.eye(modes, every[0].shape[1], known.shape[1])])
    added = np.vstack([every[1], np.zeros((modes, len(terms)))])
    return rows, added, np.append(every[2][:, 0], np.zeros(modes))
