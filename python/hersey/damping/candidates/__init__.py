"""Candidate laws: all fitted to the same dwells in the same likelihood, and one chosen.

====================  ===============================================================================
observations          dwells in logarithms, with the errors of torque, speed and temperature
thermal               laws of temperature: power, Arrhenius, VFT
named                 what every law has: parameters with names
branched              laws of speed and temperature with one or two branches
stribeck              the Stribeck curve
no_load_law           torque without a film
constant_plus         a constant torque beside a film or a viscous part
shared_load           a known contact whose load film and asperities share
candidate             which laws there are, and which the data cannot carry
shared_errors         errors that dwells share: of the zero, of visits and runs
likelihood            robust likelihood and its least-squares solution
clustered             the covariance whatever the points of a cluster have in common
visit_effects         effects of many visits: the likeliest, given everything else
bordered              the normal equations of a law beside many visits
reduced_search        a search without the effects of visits
searching             the least cost of a law at fixed standard errors
fitting               one law fitted
simultaneous          many least-squares problems of one kind at once
refits                a law fitted without some of its dwells in turn, or to clusters drawn anew
identifiability       which parameters the data do not determine, and what would
errors_in_variables   the same fit by orthogonal distance regression
lack_of_fit           whether a law holds at all
intervals             each parameter's interval by covariance, clusters, profile and bootstrap
energy                activation energies of torque and viscosity, and whether they agree
collapse              whether curves fall onto one against the Hersey number
model_comparison      all candidates of a log, the one chosen: the result and its words
comparison            fitting every candidate, the choice and its reasons
viscosity             laws of viscosity for a table of a lubricant
====================  ===============================================================================

Speeds rad/s, torque N m, temperature K. Residuals are logarithms: relative errors.
"""

from hersey.damping.candidates.candidate import Candidate
from hersey.damping.candidates.collapse import HerseyCollapse, hersey_collapse, temperature_collapse
from hersey.damping.candidates.comparison import compare_models
from hersey.damping.candidates.intervals import Band, ParameterEstimate
from hersey.damping.candidates.model_comparison import CandidateFit, ModelComparison
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.viscosity import ViscosityLaws, viscosity_laws

__all__ = [
    "Band",
    "Candidate",
    "CandidateFit",
    "HerseyCollapse",
    "ModelComparison",
    "Observations",
    "ParameterEstimate",
    "ViscosityLaws",
    "compare_models",
    "hersey_collapse",
    "temperature_collapse",
    "viscosity_laws",
]
