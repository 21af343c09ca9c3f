"""Stick-slip in a measured trace: cycles, and the drive behind them.

================  ======================================================================
sampling          a trace on even times: gaps, spikes and noise
turning_points    where the force turns, by more than noise
detection         slips: falls beyond noise, and how long they last
slip_shape        the slip between two sticks as half a free oscillation
slip_figures      figures of each slip
motion_kind       what kind of motion the falls make
drive_speed       the speed of the drive behind a trace, and how far it may be off
cycle_warnings    what to know of the slips that were found
cycle_record      cycles of a trace, their figures and kind
waveform          the mean cycle of a trace, and of the model
independence      which parameters can be estimated from a trace, and which only together
drive_fit         the drive that makes the mean cycle, and others that do nearly as well
trace_units       units in which warnings show the numbers of a drive
drive_warnings    what to know of the drive that was identified
identified_drive  closure, parameters and intervals from the fits
trace_file        a trace read from a file of any format of a log
================  ======================================================================

A trace is the force of the spring (or the torque of a torsional spring) against time at one constant drive
speed, or the belt speed.
"""

from typing import TYPE_CHECKING, Any

from hersey.identification.cycle_record import CycleRecord, Scatter, cycles

if TYPE_CHECKING:
    from hersey.identification.identified_drive import IdentifiedDrive, identify

__all__ = ["CycleRecord", "IdentifiedDrive", "Scatter", "cycles", "identify"]


def __getattr__(name: str) -> Any:
    """Load what fits a drive once it is asked for: a posterior looks for cycles alone."""
    if name not in ("IdentifiedDrive", "identify"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from hersey.identification import identified_drive

    return getattr(identified_drive, name)
