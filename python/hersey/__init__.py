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
columns         calling the core over arrays
lubricant       viscosity against temperature, pressure and shear rate
paper           Eqs. 5-10 of the paper
contact         the nip: moduli, width, pressure
film            film thickness and drag by every law, and which holds
film_evidence   the film that a log measures, and what its exponents speak for
film_lint       what in the numbers of a nip cannot be
film_part       the film of a nip, for the analysis document
film_document   the film as text and JSON
film_chart      the regime chart and the Stribeck curve
film_tables     the tables of nip and lubricant in fuser.toml
fuser           what the log cannot tell: drivetrain, nip, limits, operating points, uncertainty
spread          how far a parameter is known
text_file       opening a text file
toml_file       opening a TOML file
toml_value      its values: strings with units
course_file     a course of temperature from a CSV file
json_value      results as JSON can hold them
operating_map   what the belt does at each temperature and drive speed
document        the analysis document: the contract with the page
analysis        from a log to the document
plan            the quickest drive profile that ends smooth, or what forbids it
fit_file        a fit read back from its JSON
charts          one chart per result
map_chart       the operating map as a chart
plan_chart      a drive profile and the motion as a chart
report          the page that shows both
figures         the paper's figures anew, each claim judged
trace           cycles of a stick-slip trace, and the drive behind them
reynolds        the line contact solved numerically: pressure, film, friction
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
from hersey.contact import Contact, nip_width
from hersey.drag import Drag, DragTable
from hersey.ensemble import sweep
from hersey.errors import HerseyError
from hersey.estimation import Estimate
from hersey.film import Film, drag_torque, film_thickness
from hersey.film_evidence import MeasuredFilm, measured_film
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
from hersey.lubricant import Lubricant, ShearThinning
from hersey.motion import Drivetrain, StickSlipCycle, Trajectory, simulate, stick_slip
from hersey.operating_map import OperatingMap, operating_map
from hersey.plan import Plan, plan_profile
from hersey.regime import Regime, regime
from hersey.reynolds import LineContactSolution, solve_line_contact
from hersey.schedule import Schedule
from hersey.steady import SteadyPoints
from hersey.surface import DampingSurface, fit
from hersey.trace import CycleRecord, IdentifiedDrive, cycles, identify

__all__ = [
    "Contact",
    "CycleRecord",
    "CyclesWithoutSticking",
    "DampingSurface",
    "Disturbance",
    "Drag",
    "DragTable",
    "Drivetrain",
    "Estimate",
    "Film",
    "HerseyError",
    "HysteresisBand",
    "IdentifiedDrive",
    "Inspection",
    "LineContactSolution",
    "Lubricant",
    "MeasuredFilm",
    "ModelComparison",
    "OperatingMap",
    "Plan",
    "Regime",
    "SafeStep",
    "Schedule",
    "ShearThinning",
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
    "drag_torque",
    "film_thickness",
    "fit",
    "hersey_collapse",
    "hysteresis",
    "hysteresis_sweep",
    "identify",
    "inspect",
    "measured_film",
    "nip_width",
    "operating_map",
    "plan_profile",
    "read",
    "read_with_mapping",
    "regime",
    "safe_step",
    "simulate",
    "solve_line_contact",
    "stick_slip",
    "sweep",
    "viscosity_laws",
]
