"""The virtual test stand: synthetic logs whose truth is known.

============  ===============================================================
truth         the damping surface behind a log, and how it varies
physical      the truth made of film, contact and the no-load torque
stand         the stand, its sensors and disturbances; the log it writes
full_contact  a full numerical solution of that contact, as a table
ageing        units whose oil goes and whose faces wear, with their truth
campaign      the runs of such units at some ages, as files
drive         the shipped example's drive, which ages if none is given
============  ===============================================================
"""

from hersey.testbench.ageing import AgedTruth, Ageing, Unit, population
from hersey.testbench.campaign import VirtualCampaign, ages_of
from hersey.testbench.physical import FullTruth, PhysicalTruth
from hersey.testbench.stand import COLUMNS, Stand, VirtualLog, long_log, run
from hersey.testbench.truth import RPM, StribeckTruth, ThermalTruth, Truth

__all__ = [
    "COLUMNS",
    "RPM",
    "AgedTruth",
    "Ageing",
    "FullTruth",
    "PhysicalTruth",
    "Stand",
    "StribeckTruth",
    "ThermalTruth",
    "Truth",
    "Unit",
    "VirtualCampaign",
    "VirtualLog",
    "ages_of",
    "long_log",
    "population",
    "run",
]
