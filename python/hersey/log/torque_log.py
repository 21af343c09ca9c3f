"""A log of drive torque, speed and temperature, in SI, with where every number came from."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from hersey.corrections import Correction
    from hersey.steady import SteadyPoints

FloatArray = NDArray[np.float64]
#: No quantity of a drive comes near this, in SI.
LARGEST = 1e12


@dataclass(frozen=True)
class Channel:
    """One column that was used: its role, its name and unit as written."""

    role: str
    name: str
    unit: str


@dataclass(frozen=True)
class LogFile:
    """One file that was read."""

    name: str
    sha256: str
    bytes: int
    rows: int
    missing_rows: int
    channels: tuple[Channel, ...]
    comments: tuple[str, ...]  #: comment lines above the header
    cut_off: bool = False  #: the file ends before its time
    notes: tuple[str, ...] = ()  #: what was done to read it: clocks aligned, time stamps, lines left out


@dataclass(frozen=True)
class Run:
    """What one file recorded: arrays of shape (rows,) in s, N m, rad/s and K."""

    name: str
    time: FloatArray
    torque: FloatArray
    speed: FloatArray
    temperature: FloatArray | None

    @cached_property
    def sampling_interval(self) -> float:
        """Median time between rows in s; where clocks are coarse and stamps repeat, the mean."""
        median = float(np.median(np.diff(self.time)))
        return median or float(self.time[-1] - self.time[0]) / (self.time.size - 1)

    def gaps(self) -> int:
        """Return how many times rows are missing: intervals over 1.5 times the usual one."""
        return int(np.count_nonzero(np.diff(self.time) > 1.5 * self.sampling_interval))


@dataclass(frozen=True)
class TorqueLog:
    """One or more runs on the same machine; `hersey.read` makes it."""

    runs: tuple[Run, ...]
    files: tuple[LogFile, ...]
    corrections: tuple[Correction, ...] = ()  #: what was corrected, in this order

    @property
    def rows(self) -> int:
        """Rows used, over all runs."""
        return sum(run.time.size for run in self.runs)

    @property
    def has_temperature(self) -> bool:
        """Whether every run carries a temperature."""
        return all(run.temperature is not None for run in self.runs)

    def steady(self, *, min_dwell: float = 2.0, tare: str = "none", rotation: str = "both") -> SteadyPoints:
        """Reduce the log to its steady points: see `hersey.steady.steady_points`."""
        from hersey.steady import steady_points

        return steady_points(self, min_dwell=min_dwell, tare=tare, rotation=rotation)
