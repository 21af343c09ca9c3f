"""What a moving log gives: the law of friction in the field's parameters, inertia and offset."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.estimate import Estimate, estimate
from hersey.damping.moving.fitting import Fitting, MovingLawFit
from hersey.damping.moving.gravity import AMPLITUDE
from hersey.damping.moving.misfit import Misfit
from hersey.damping.moving.windows import windows
from hersey.log.torque_log import ROTATIONS, TorqueLog
from hersey.result import Means, Record, Result
from hersey.schema.warning import Warning
from hersey.units import rpm, takes_si

if TYPE_CHECKING:
    import polars as pl

    from hersey.damping.dwells import SteadyPoints


@dataclass(frozen=True)
class MovingParameter(Record):
    """A number of the law; the names of one direction end in + (forward) or - (reverse)."""

    name: Annotated[str, Means("T_C, T_S, w_S, k_v, s, J, offset, G, q_0 or delay")]
    unit: Annotated[str, Means("SI")]
    estimate: Annotated[Estimate, Means("with its interval at 95 %")]


@dataclass(frozen=True)
class LawTried(Record):
    """A law that was fitted."""

    name: str
    numbers: Annotated[int, Means("how many are fitted")]
    delta_aicc: Annotated[float, Means("AICc above the least")]
    determined: Annotated[bool, Means("whether all of its numbers can be determined")]


@dataclass(frozen=True, repr=False)
class MovingFit(Result):
    """Friction, inertia, gravity and offset of a log that moves all the time: see `hersey.fit_moving`."""

    not_stated = ("log", "fitted", "fitting")

    law: Annotated[str, Means("law of friction that was chosen")]
    parameters: Annotated[
        tuple[MovingParameter, ...], Means("friction first, then inertia, offset, gravity, delay")
    ]
    inertia_given: Annotated[float | None, Means("moment of inertia if it was given", "kg m^2")]
    laws: Annotated[tuple[LawTried, ...], Means("all laws, the simplest first")]
    bandwidth: Annotated[float, Means("frequency above which the low-pass halves power", "Hz")]
    used: Annotated[float, Means("share of the log that is used")]
    near_standstill: Annotated[float, Means("share of the log that is slower than least_speed")]
    least_speed: Annotated[float, Means("slower rows are not used: presliding, or sign unsure", "rad/s")]
    speed_range: Annotated[tuple[float, float], Means("least and greatest speed used", "rad/s")]
    temperature_range: Annotated[tuple[float, float] | None, Means("least and greatest", "K")]
    scatter: Annotated[float, Means("standard deviation of what the law leaves, within bandwidth", "N m")]
    explained: Annotated[
        float, Means("share of the mean square of the torque, without inertia, that the law explains")
    ]
    misfit: Annotated[Misfit | None, Means("how friction departs from the law; null if it does not")]
    effective_rows: Annotated[float, Means("independent moments")]
    warnings: tuple[Warning, ...]
    log: TorqueLog
    fitted: MovingLawFit
    fitting: Fitting

    def __getitem__(self, name: str) -> Estimate:
        """Return a number by its name, e.g. ``fit["T_C"]``; `KeyError` if the law has none."""
        return {each.name: each.estimate for each in self.parameters}[name]

    def __contains__(self, name: str) -> bool:
        """Return whether the law has a number of this name."""
        return any(each.name == name for each in self.parameters)

    def friction(self, speed: FloatArray, kelvin: FloatArray | None = None) -> FloatArray:
        """Return the torque of friction alone (N m) at speeds (rad/s), shape (points,)."""
        law = self.fitted.law.friction
        own = self.fitted.values[: len(law.names)]
        if law.reference_kelvin is not None and kelvin is None:
            kelvin = np.full(np.shape(speed), law.reference_kelvin)
        return law.torque(own, speed, kelvin)

    @property
    def named(self) -> str:
        """The law in words, or that none fits."""
        if self.misfit is None:
            return self.law
        share, at = 100.0 * abs(self.misfit.share), rpm(abs(self.misfit.speed))
        return f"No law of friction fits. The nearest is off by {share:.2g} % near {at:.2g} rpm: {self.law}"

    @property
    def gravity_in_words(self) -> str:
        """What G and q_0 are."""
        recorded = self.log.runs[0].position is not None
        angle = "the position in the log" if recorded else "counted from the start of the log"
        return f"Gravity takes G sin(q - q_0): the load hangs at rest at q_0; the angle q is {angle}."

    @property
    def middle_speed(self) -> float:
        """Speed in the middle of those used, by its logarithm, rad/s."""
        return float(np.sqrt(self.speed_range[0] * self.speed_range[1]))

    def friction_at(self, speed: float) -> Estimate:
        """Return friction (N m) at a speed (rad/s), at the mean temperature of the log, with its interval.

        It may be known where the numbers of the law are not, because speeds are alike.
        """
        law, size = self.fitted.law.friction, len(self.fitted.law.friction.names)
        own, at = self.fitted.values[:size], np.array([speed])
        kelvin = None if law.reference_kelvin is None else np.array([law.reference_kelvin])
        gradient = law.jacobian(own, at, kelvin)[0]
        error = float(np.sqrt(gradient @ self.fitted.covariance[:size, :size] @ gradient))
        return estimate(float(law.torque(own, at, kelvin)[0]), error, self.parameters[0].estimate.freedom)

    @takes_si(rotation=ROTATIONS)
    def points(self, *, rotation: str = "both") -> SteadyPoints:
        """Return windows of speed and temperature as steady points, for `hersey.fit` and all after it.

        Errors that windows share, by inertia, offset and delay, are in ``window_errors``.

        Parameters
        ----------
        rotation
            ``both``, or only ``forward`` (positive speed) or ``reverse`` windows.

        Raises
        ------
        InsufficientDataError
            If no window holds enough independent moments.
        """
        return windows(self, rotation)

    def headline(self) -> str:
        """Return law and range of speed."""
        slow, fast = (rpm(each) for each in self.speed_range)
        return f"{self.named}, {slow:.3g} to {fast:.3g} rpm"

    def summary(self) -> str:
        """Return law, numbers and what was not used, as text."""
        lines = [self.headline()]
        lines += [f"  {each.name} = {each.estimate} {each.unit}" for each in self.parameters]
        if self.inertia_given is not None:
            lines.append(f"  J = {self.inertia_given:.4g} kg m^2, given")
        if AMPLITUDE in self:
            lines.append(self.gravity_in_words)
        lines.append(self.cost())
        return "\n".join([*lines, *(warning.sentence for warning in self.warnings)])

    def cost(self) -> str:
        """Return a sentence on what the filter and standstill cost."""
        return (
            f"{100 * self.used:.0f} % of the log used, below {self.bandwidth:.2g} Hz; "
            f"{100 * self.near_standstill:.0f} % is slower than {rpm(self.least_speed):.2g} rpm, where "
            "friction before sliding and the sign of speed are unsure."
        )

    def to_frame(self) -> pl.DataFrame:
        """Return one row per number: name, unit, value, standard error and the ends of its interval."""
        import polars as pl

        return pl.DataFrame(
            {
                "name": [each.name for each in self.parameters],
                "unit": [each.unit for each in self.parameters],
                "value": [each.estimate.value for each in self.parameters],
                "error": [each.estimate.error for each in self.parameters],
                "low": [each.estimate.low for each in self.parameters],
                "high": [each.estimate.high for each in self.parameters],
            }
        )
