"""The ladder of laws: every rung fitted to the same dwells in the same likelihood, and one chosen.

====================  ===============================================================================
observations          dwells in logarithms, with the errors of torque, speed and temperature
thermal               laws of temperature: power, Arrhenius, VFT
branched              laws of speed and temperature with one or two branches
stribeck              the Stribeck curve
rungs                 which laws there are, and which the data cannot carry
likelihood            robust likelihood and its least-squares solution
fitting               one law fitted; left-out and resampled fits; what is not identified
errors_in_variables   the same fit by orthogonal distance regression
intervals             each parameter's interval by covariance, clusters, profile and bootstrap
energy                activation energies of torque and viscosity, and whether they agree
collapse              whether curves fall onto one against the Hersey number
comparison            every rung, the choice and its reasons
viscosity             laws of viscosity for a table of a lubricant
words                 a comparison as text and as plain data
====================  ===============================================================================

Speeds rad/s, torque N m, temperature K. Residuals are logarithms: relative errors.
"""

from hersey.ladder.collapse import HerseyCollapse, hersey_collapse, temperature_collapse
from hersey.ladder.comparison import ModelComparison, RungFit, compare_models
from hersey.ladder.intervals import Band, ParameterEstimate
from hersey.ladder.observations import Observations
from hersey.ladder.rungs import Rung
from hersey.ladder.viscosity import ViscosityLaws, viscosity_laws

__all__ = [
    "Band",
    "HerseyCollapse",
    "ModelComparison",
    "Observations",
    "ParameterEstimate",
    "Rung",
    "RungFit",
    "ViscosityLaws",
    "compare_models",
    "hersey_collapse",
    "temperature_collapse",
    "viscosity_laws",
]
