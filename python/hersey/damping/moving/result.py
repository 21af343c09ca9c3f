"""What a moving log gives: the law of friction in the field's parameters, inertia and offset."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.estimate import Estimate, estimate
from hersey.damping.moving.fitting import Fitting, MovingLawFit
from hersey.damping.moving.friction import MovingFriction, MovingPoints
from hersey.damping.moving.windows import windows
from hersey.log.torque_log import ROTATIONS, TorqueLog
from hersey.result import Result
from hersey.schema.warning import Warning
from hersey.units import rpm, takes_si

if TYPE_CHECKING:
    import polars as pl


@dataclass(frozen=True, repr=False)
class MovingFit(MovingFriction, Result):
    """Friction, inertia, gravity and offset of a log that moves all the time: see `hersey.fit_moving`."""

    not_stated: ClassVar[tuple[str, ...]] = (*MovingFriction.not_stated, "log", "fitted", "fitting")
    also_stated: ClassVar[tuple[str, ...]] = ()

    warnings: tuple[Warning, ...]
    log: TorqueLog
    fitted: MovingLawFit
    fitting: Fitting

    @property
    def numbers(self) -> MovingFriction:
        """The same without the log and what was made of it."""
        return MovingFriction(**{each.name: getattr(self, each.name) for each in fields(MovingFriction)})

    def __getitem__(self, name: str) -> Estimate:
        """Return a number by its name, e.g. ``fit["T_C"]``; `KeyError` if the law has none."""
        return {each.name: each.estimate for each in self.parameters}[name]

    def __contains__(self, name: str) -> bool:
        """Return whether the law has a number of this name."""
        return any(each.name == name for each in self.parameters)

    def friction(self, speed: FloatArray, kelvin: FloatArray | None = None) -> FloatArray:
        """Return the torque of friction alone (N m) at speeds (rad/s), shape (points,)."""
        law = self.friction_law
        if law.reference_kelvin is not None and kelvin is None:
            kelvin = np.full(np.shape(speed), law.reference_kelvin)
        return law.torque(self.values, speed, kelvin)

    @property
    def middle_speed(self) -> float:
        """Speed in the middle of those used, by its logarithm, rad/s."""
        return float(np.sqrt(self.speed_range[0] * self.speed_range[1]))

    def friction_at(self, speed: float) -> Estimate:
        """Return friction (N m) at a speed (rad/s), at the mean temperature of the log, with its interval.

        It may be known where the numbers of the law are not, because speeds are alike.
        """
        law, at = self.friction_law, np.array([speed])
        kelvin = None if law.reference_kelvin is None else np.array([law.reference_kelvin])
        gradient = law.jacobian(self.values, at, kelvin)[0]
        error = float(np.sqrt(gradient @ self.covariance @ gradient))
        return estimate(float(law.torque(self.values, at, kelvin)[0]), error, self.freedom)

    @takes_si(rotation=ROTATIONS)
    def points(self, *, rotation: str = "both") -> MovingPoints:
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
        if self.gravity_in_words():
            lines.append(self.gravity_in_words())
        lines.append(self.cost())
        return "\n".join([*lines, *(warning.sentence for warning in self.warnings)])

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
