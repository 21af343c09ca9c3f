"""From a torque log to the lubrication state of a sliding drive.

==============  ==============================================================================
log             reading files into a `TorqueLog`
steady          dwells, reduced to steady points with honest errors
estimation      weighted least squares with an unknown scatter
law             B = a T^b w^c in logarithms, and the data it is fitted to
branches        two branches of the law: whether, and where they meet
surface         the fitted damping surface
regime          what the exponents say about lubrication
schedule        drive speed, torque or temperature against time
drag            drag laws: force against belt speed and temperature
motion          stick-slip motion of the belt
ensemble        thousands of motions in one call
axes            parameters given as arrays, and the axes they span
hysteresis      the band of drive speeds where the past decides
approach        steps, ramps and kicks: how one comes to a speed
fuser           what the log cannot tell: drivetrain, limits, operating points, uncertainty
spread          how far a parameter is known
toml_file       opening a TOML file
course_file     a course of temperature from a CSV file
json_value      results as JSON can hold them
operating_map   what the belt does at each temperature and drive speed
analysis        the analysis document
plan            the quickest drive profile that ends smooth, or what forbids it
fit_file        a fit read back from its JSON
charts          one chart per result
map_chart       the operating map as a chart
plan_chart      a drive profile and the motion as a chart
report          the page that shows both
figures         the paper's figures anew, each claim judged
scenario        a sweep described by a file
testbench       the virtual test stand
units, errors   the one unit registry; the closed table of errors
cli             the commands
==============  ==============================================================================

SI inside, always; units are read and written at the door. Every interval is at 95 %. Nothing flows
backwards: a log knows no fit, a fit knows no motion.
"""

from hersey._core import VERSION as __version__
from hersey.approach import Disturbance, SafeStep, disturbance, safe_step
from hersey.branches import Transition
from hersey.drag import Drag, DragTable
from hersey.ensemble import sweep
from hersey.errors import HerseyError
from hersey.estimation import Estimate
from hersey.hysteresis import (
    CyclesWithoutSticking,
    HysteresisBand,
    cycles_without_sticking,
    hysteresis,
    hysteresis_sweep,
)
from hersey.log import TorqueLog, read
from hersey.motion import Drivetrain, StickSlipCycle, Trajectory, simulate, stick_slip
from hersey.operating_map import OperatingMap, operating_map
from hersey.plan import Plan, plan_profile
from hersey.regime import Regime, regime
from hersey.schedule import Schedule
from hersey.steady import SteadyPoints
from hersey.surface import DampingSurface, fit

__all__ = [
    "CyclesWithoutSticking",
    "DampingSurface",
    "Disturbance",
    "Drag",
    "DragTable",
    "Drivetrain",
    "Estimate",
    "HerseyError",
    "HysteresisBand",
    "OperatingMap",
    "Plan",
    "Regime",
    "SafeStep",
    "Schedule",
    "SteadyPoints",
    "StickSlipCycle",
    "TorqueLog",
    "Trajectory",
    "Transition",
    "__version__",
    "cycles_without_sticking",
    "disturbance",
    "fit",
    "hysteresis",
    "hysteresis_sweep",
    "operating_map",
    "plan_profile",
    "read",
    "regime",
    "safe_step",
    "simulate",
    "stick_slip",
    "sweep",
]
