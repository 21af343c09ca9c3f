"""What is doubtful in dwells before anything is fitted: their tare, and what goes together with time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells.groups import groups_of_temperature
from hersey.damping.dwells.points import SteadyPoints
from hersey.errors import TARE

#: A tare beyond this share of the least torque is asked about.
LARGE_TARE = 0.1
#: Rank correlation with time beyond which a quantity goes together with it, for so many dwells at least.
IN_ORDER, FEWEST_IN_ORDER = 0.9, 5


def doubtful_tare(points: SteadyPoints) -> list[str]:
    """Return in a sentence what is doubtful of the zero of torque, with the option that mends it; or none."""
    standing = points.standing_torque
    if standing is None:
        return []
    least = float(np.min(np.abs(points.column("torque"))))
    if points.tare:
        if abs(points.tare) < LARGE_TARE * least:
            return []
        return [
            f"The tare, {points.tare * 1e3:.3g} mN m, is {abs(points.tare) / least:.0%} of the least dwell: "
            "is it the sensor's offset, and did the drive stand free?"
        ]
    if abs(standing) < 0.001 * least:
        return []
    return [
        f"While the drive stood, torque read {standing * 1e3:.3g} mN m, {abs(standing) / least:.1%} of the "
        f"least dwell. It is not subtracted; if it is the sensor's offset, use {TARE.to('standing')}."
    ]


@dataclass(frozen=True)
class Ordered:
    """A quantity that rose or fell with time, so that a drift of the drive would pass for its effect."""

    quantity: str  #: ``speed`` or ``temperature``
    exponent: str  #: the one that a drift would change

    @property
    def title(self) -> str:
        """What is doubtful."""
        return f"{self.quantity.capitalize()} and time go together"

    @property
    def advice(self) -> str:
        """What it may do, and the remedy."""
        return (
            f"wear-in or any other drift would pass for {self.quantity} in exponent {self.exponent}. "
            f"Go back to the first {self.quantity} at the end."
        )

    def __str__(self) -> str:
        """Return both in a sentence."""
        return f"{self.title}: {self.advice}"


def doubtful_order(points: SteadyPoints) -> list[Ordered]:
    """Return what rose or fell with time, so that its effect cannot be separated from a drift."""
    if len(points) < FEWEST_IN_ORDER or len(points.log.runs) != 1:
        return []
    named = {"speed": ("c", np.log(np.abs(points.column("speed"))))}
    if points.log.has_temperature and len(list(groups_of_temperature(points.column("temperature")))) > 1:
        named["temperature"] = ("b", points.column("temperature"))
    named = {what: each for what, each in named.items() if np.ptp(each[1]) > 0}
    order = np.arange(len(points))
    return [
        Ordered(what, exponent)
        for what, (exponent, values) in named.items()
        if abs(float(np.corrcoef(order, _ranks(values))[0, 1])) > IN_ORDER
    ]


def _ranks(values: FloatArray) -> FloatArray:
    """Ranks, the mean of them where values are the same."""
    _, place, alike = np.unique(values, return_inverse=True, return_counts=True)
    return np.asarray((np.cumsum(alike) - 0.5 * (alike - 1))[place])
