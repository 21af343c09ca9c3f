"""Stick-slip in a measured trace: cycles, and the drive behind them.

==============  ==============================================================================
sampling        a trace on even times: gaps, spikes and noise
turning_points  where the force turns, by more than noise
detection       slips: falls beyond noise, and how long they last
slip_shape      the slip between two sticks as half a free oscillation
record          cycles of a trace, their figures and kind
waveform        the mean cycle of a trace, and of the model
independence    which parameters a trace tells apart, in words
drive_fit       the drive that makes the mean cycle, and others that do nearly as well
identification  closure, parameters and intervals from the fits
trace_file      a trace read from CSV or MAT
trace_chart     trace, cycles and fitted motion as a chart
==============  ==============================================================================

A trace is the force of the spring (or the torque of a torsional spring) against time at one constant drive
speed, or the belt speed.
"""

from hersey.trace.identification import IdentifiedDrive, identify
from hersey.trace.record import CycleRecord, Scatter, cycles

__all__ = ["CycleRecord", "IdentifiedDrive", "Scatter", "cycles", "identify"]
