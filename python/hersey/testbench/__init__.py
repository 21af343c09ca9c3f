"""The virtual test stand: synthetic logs whose truth is known.

========  ===============================================================
truth     the damping surface behind a log, and how it varies
physical  the truth made of film, contact and the rest of the drive
stand     the stand, its sensors and disturbances; the log it writes
========  ===============================================================
"""

from hersey.testbench.physical import PhysicalTruth
from hersey.testbench.stand import COLUMNS, Stand, VirtualLog, long_log, run
from hersey.testbench.truth import RPM, StribeckTruth, ThermalTruth, Truth

__all__ = [
    "COLUMNS",
    "RPM",
    "PhysicalTruth",
    "Stand",
    "StribeckTruth",
    "ThermalTruth",
    "Truth",
    "VirtualLog",
    "long_log",
    "run",
]
