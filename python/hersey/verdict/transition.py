"""Where drag is least: by the contact whose load film and asperities share, beside what a log shows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.estimate import rounded
from hersey.damping.surface import DampingSurface
from hersey.lubrication.film_temperature import film_temperature
from hersey.lubrication.mixed import MixedContact
from hersey.result import Means, Record
from hersey.schema.warning import Warning
from hersey.units import celsius, rpm


@dataclass(frozen=True)
class ContactTransition(Record):
    """Transition speed against temperature; arrays of shape (temperatures,), NaN where there is none."""

    also_stated = ("ratio",)

    temperature: Annotated[FloatArray, Means("as read", "K")]
    speed: Annotated[
        FloatArray, Means("from the contact model, rad/s; null if torque has no minimum", open=True)
    ]
    measured: Annotated[
        FloatArray, Means("from the fitted surface, rad/s; null if it has no transition", open=True)
    ]
    low: Annotated[FloatArray, Means("of measured, rad/s, 95 %", open=True)]
    high: Annotated[FloatArray, Means("of measured, rad/s, 95 %", open=True)]
    by_roughness: Annotated[FloatArray, Means("d ln speed/d ln roughness", open=True)]
    by_boundary: Annotated[
        FloatArray, Means("d ln speed/d ln boundary friction (-1 for viscosity)", open=True)
    ]

    @property
    def ratio(self) -> FloatArray:
        """Speed by the contact over that measured."""
        return np.asarray(self.speed / self.measured)

    def summary(self) -> str:
        """Return a row for each temperature."""
        lines = [
            "transition speed (lowest torque), rpm, and its sensitivity d ln speed/d ln input "
            "(viscosity: -1)",
            f"  {'degC':>6s} {'contact':>9s} {'measured':>26s} {'ratio':>7s} {'roughness':>10s} "
            f"{'boundary friction':>18s}",
        ]
        for i, kelvin in enumerate(self.temperature.tolist()):
            speed = "nowhere" if np.isnan(self.speed[i]) else f"{rpm(self.speed[i]):.3g}"
            seen, ratio = self._seen(i).replace(" rpm", ""), self.ratio[i]
            shown = "" if np.isnan(ratio) else f"{ratio:.3g}"
            shifts = (self.by_roughness[i], self.by_boundary[i])
            roughness, boundary = ("" if np.isnan(shift) else f"{shift:.2f}" for shift in shifts)
            lines.append(
                f"  {celsius(kelvin):6.1f} {speed:>9s} {seen:>26s} {shown:>7s} {roughness:>10s} "
                f"{boundary:>18s}"
            )
        return "\n".join(line.rstrip() for line in lines)

    def warnings(self) -> list[Warning]:
        """Return the same as warnings, for a page: the coldest and the hottest temperature."""
        ends = sorted({int(np.argmin(self.temperature)), int(np.argmax(self.temperature))})
        return [self._warning(i) for i in ends]

    def _warning(self, i: int) -> Warning:
        kelvin, speed = float(self.temperature[i]), float(self.speed[i])
        if np.isnan(speed):
            return Warning(
                "no transition of the contact",
                "in the contact model torque has no minimum at {temperature:.0f degC}, so there is "
                "no transition",
                temperature=kelvin,
            )
        return Warning(
            "transition of the contact",
            "at {temperature:.0f degC} torque is lowest at {speed:.3g rpm} in the contact model"
            + ("" if np.isnan(self.measured[i]) else ", {ratio:.2f} times the measured {shown}")
            + ". This speed varies as roughness^{by_roughness:.2f}, boundary "
            "friction^{by_boundary:.2f} and 1/viscosity",
            temperature=kelvin,
            speed=speed,
            shown=self._seen(i),
            ratio=float(self.ratio[i]),
            by_roughness=float(self.by_roughness[i]),
            by_boundary=float(self.by_boundary[i]),
        )

    def _seen(self, i: int) -> str:
        if np.isnan(self.measured[i]):
            return "none shown"
        value, low, high = (rpm(x[i]) for x in (self.measured, self.low, self.high))
        if np.isfinite(low) and np.isfinite(high):
            return rounded(value, low, high, "rpm")
        return f"{value:.3g} rpm (interval not known)"


def contact_transition(
    mixed: MixedContact, temperature: FloatArray, surface: DampingSurface | None = None
) -> ContactTransition:
    """Return the transition speed at temperatures (K, as read), beside that of a fitted surface.

    Heat that flows through the film counts as `film_temperature` has it, at the transition.
    """
    kelvin = np.atleast_1d(np.asarray(temperature, dtype=float))
    turn = mixed.transition(kelvin)
    if mixed.contact.heat_flow is not None:
        speed = np.where(np.isnan(turn.speed), 1.0, turn.speed)
        turn = mixed.transition(
            film_temperature(mixed.contact, mixed.lubricant, speed=speed, temperature=kelvin)
        )
    seen = np.full((3, kelvin.size), np.nan)
    if surface is not None and surface.transition is not None:
        for i, level in enumerate(kelvin.tolist()):
            found = surface.transition_estimate(None if surface.b is None else level)
            seen[:, i] = found.value, found.low, found.high
    return ContactTransition(
        temperature=kelvin,
        speed=turn.speed,
        measured=seen[0],
        low=seen[1],
        high=seen[2],
        by_roughness=turn.by_roughness,
        by_boundary=turn.sensitivity["boundary"],
    )
