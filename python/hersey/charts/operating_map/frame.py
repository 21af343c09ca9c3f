"""The window of an operating map: its pixels and its axes."""

from __future__ import annotations

from dataclasses import dataclass

import altair as alt
import numpy as np

from hersey.arrays import FloatArray
from hersey.charts.style import TEMPERATURE, logarithmic_axis
from hersey.stability.operating_map import OperatingMap
from hersey.units import celsius

WIDTH, HEIGHT = 680, 450


@dataclass(frozen=True)
class Frame:
    """Window of the chart and its pixels: ``x`` in degC (0 to 1 if isothermal), speeds in m/s."""

    x: FloatArray
    low: float
    high: float
    thermal: bool

    @classmethod
    def of(cls, result: OperatingMap) -> Frame:
        """Return the window of a map."""
        hot = result.temperature
        x = np.array([0.0, 1.0]) if hot is None else celsius(hot)
        return cls(x, float(result.speed[0]), float(result.speed[-1]), hot is not None)

    def across(self, x: float) -> float:
        """Pixels from the left."""
        return WIDTH * (x - float(self.x[0])) / float(self.x[-1] - self.x[0])

    def up(self, speed: float) -> float:
        """Pixels from the bottom."""
        return HEIGHT * float(np.log(speed / self.low) / np.log(self.high / self.low))

    def at(self, across: float, up: float) -> tuple[float, float]:
        """What pixels stand for."""
        x = float(self.x[0]) + across / WIDTH * float(self.x[-1] - self.x[0])
        return x, self.low * float((self.high / self.low) ** (up / HEIGHT))

    def line(self, speeds: FloatArray) -> list[tuple[float, float]]:
        """Pixels of a line, as far as it lies within the window."""
        columns = zip(self.x.tolist(), speeds.tolist(), strict=True)
        return [(self.across(x), self.up(v)) for x, v in columns if self.low < v < self.high]

    def clipped(self, speeds: FloatArray) -> FloatArray:
        """Speeds within the window."""
        return np.clip(speeds, self.low, self.high)


def side_to_side(result: OperatingMap, edge: FloatArray) -> FloatArray:
    """Return one value per column; the one column of an isothermal map is drawn from side to side."""
    return np.repeat(edge, 2, axis=-1) if result.temperature is None else edge


def temperature_axis(frame: Frame, field: str = "x:Q") -> alt.X:
    """Return the axis across; an isothermal map has none."""
    domain = [float(frame.x[0]), float(frame.x[-1])]
    return alt.X(
        field,
        title=TEMPERATURE if frame.thermal else None,
        scale=alt.Scale(domain=domain, nice=False),
        axis=alt.Axis(grid=False, tickCount=8) if frame.thermal else None,
    )


def speed_axis(frame: Frame, field: str = "y:Q") -> alt.Y:
    """Return the axis up, in mm/s where it slides."""
    domain = logarithmic_axis((1e3 * frame.low, 1e3 * frame.high), grid=False)
    return alt.Y(field, title="Drive speed (mm/s)", **domain)
