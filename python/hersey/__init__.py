"""From a torque log to the lubrication state of a sliding drive.

==============  ==============================================================================
log             reading files into a `TorqueLog`
log_mapping     which channel plays which role, kept beside the data
corrections     what lies between sensor and film, taken off with a record
steady          dwells, reduced to steady points with honest errors
estimation      weighted least squares with an unknown scatter
law             B = a T^b w^c in logarithms, and the data it is fitted to
branches        two branches of the law: whether, and where they meet
surface         the fitted damping surface
inspection      what a log holds, before a fit
ladder          every law fitted to the same dwells, one chosen, with intervals and energies
compare         two logs against each other
design          which dwells to record next
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
trace           cycles of a stick-slip trace, and the drive behind them
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
from hersey.inspection import Inspection, inspect
from hersey.ladder import ModelComparison, compare_models, hersey_collapse, viscosity_laws
from hersey.log import TorqueLog, read
from hersey.log_mapping import read_with_mapping
from hersey.motion import Drivetrain, StickSlipCycle, Trajectory, simulate, stick_slip
from hersey.operating_map import OperatingMap, operating_map
from hersey.plan import Plan, plan_profile
from hersey.regime import Regime, regime
from hersey.schedule import Schedule
from hersey.steady import SteadyPoints
from hersey.surface import DampingSurface, fit
from hersey.trace import CycleRecord, IdentifiedDrive, cycles, identify

__all__ = [
    "CycleRecord",
    "CyclesWithoutSticking",
    "DampingSurface",
    "Disturbance",
    "Drag",
    "DragTable",
    "Drivetrain",
    "Estimate",
    "HerseyError",
    "HysteresisBand",
    "IdentifiedDrive",
    "Inspection",
    "ModelComparison",
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
    "compare_models",
    "cycles",
    "cycles_without_sticking",
    "disturbance",
    "fit",
    "hersey_collapse",
    "hysteresis",
    "hysteresis_sweep",
    "identify",
    "inspect",
    "operating_map",
    "plan_profile",
    "read",
    "read_with_mapping",
    "regime",
    "safe_step",
    "simulate",
    "stick_slip",
    "sweep",
    "viscosity_laws",
]
