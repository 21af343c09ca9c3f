"""Friction against speed as robotics writes it: the law that describes the dwells, with its parameters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from hersey.damping.friction_curve.fitted import FittedFriction
from hersey.damping.friction_curve.words import finding_of, formula_of, named, summary_of
from hersey.result import Result

if TYPE_CHECKING:
    import polars as pl


@dataclass(frozen=True, repr=False)
class FrictionCurve(FittedFriction, Result):
    """Coulomb, viscous and Stribeck friction fitted to steady points.

    ``directions`` is None where one direction was measured, or too few dwells of one; ``least`` is empty
    where torque has no minimum between the slowest and the fastest dwell. ``reference_temperature`` is that
    of k_v. Where it was fitted to every sample of a moving log, ``points`` are windows of speed.
    """

    not_stated = ("law", "values", "covariance", "freedom", "data")
    also_stated = ("kind", "apart", "headline", "formula", "finding", "summary", "lines", "residuals")

    def headline(self) -> str:
        """Return the law and its parameters."""
        return named(self)

    @property
    def formula(self) -> str:
        """The law as a formula."""
        return formula_of(self)

    @property
    def finding(self) -> str:
        """What torque does as the drive slows, and whether the directions differ, in words."""
        return finding_of(self)

    def summary(self) -> str:
        """Return law, parameters and laws tried, as text."""
        return summary_of(self)

    def to_frame(self) -> pl.DataFrame:
        """Return one row per parameter, in SI."""
        import polars as pl

        rows: list[dict[str, Any]] = [
            {
                "parameter": each.name,
                "direction": each.direction,
                "value": each.estimate.value,
                "low": each.estimate.low,
                "high": each.estimate.high,
                "unit": each.unit,
            }
            for each in self.parameters
        ]
        return pl.DataFrame(rows)
