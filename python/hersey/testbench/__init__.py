"""The virtual test stand: synthetic logs whose truth is known.

======  ==========================================================
truth   the damping surface behind a log, and how it varies
stand   the stand, its sensors and disturbances; the log it writes
======  ==========================================================
"""

from hersey.testbench.stand import COLUMNS, Stand, VirtualLog, long_log, run
from hersey.testbench.truth import RPM, StribeckTruth, ThermalTruth, Truth

__all__ = [
    "COLUMNS",
    "RPM",
    "Stand",
    "StribeckTruth",
    "ThermalTruth",
    "Truth",
    "VirtualLog",
    "long_log",
    "run",
]
