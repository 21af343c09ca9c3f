"""From a torque log to the lubrication state of a sliding drive.

Rooms, in the order in which data passes through them; each says in its own header what it holds.

==============  ==============================================================================
errors          the closed table of what can go wrong, and what to do in the words of the way in
units           the one door for units
arrays          numbers or arrays as arguments
result          what every result can do
schema          the schema of what the document and every ``--json`` hold, from the fields of the results
files           text, TOML with units, writing whole or not at all
processes       processes of our own for libraries that may break down
scale           work cut into tasks: for threads, or for the workers of a cluster
log             a `TorqueLog` from any file
motion          drag against speed, schedules, the motion of the belt, sweeps
damping         dwells, the damping surface, candidate laws, comparison, design of tests
inspection      what a log holds, before a fit
lubrication     lubricant, contact, film, the paper's equations, the numerical line contact
machine         the machine's file: drivetrain, nip, limits, uncertainty, operating points
verdict         what exponents and film say together
identification  the cycles of a trace, and the drive behind them
stability       hysteresis, disturbances, the operating map, drive profiles, warm-ups
posterior       dwells, starts and stick-slip in one likelihood: draws of curve, closure and drive
decision        what to do: the verdict on a speed, the next measurement, the start-up
study           everything for one log and one machine, computed once; the decision in words
life            runs of many units at many ages, fatigue, populations: what ends a drive, and when
exchange        the drive as a unit that other tools of simulation run
document        the analysis document: the contract with the page
charts          one chart per result
report          the page
testbench       the virtual test stand
app             the local app: from dropped logs to the report
cli             one file per verb
==============  ==============================================================================

SI inside, always; units are read and written at the door. Intervals are at 95 %, those of lives at 90 %.
Nothing flows backwards: a log knows no fit, a fit knows no motion. Names are loaded when they are used.
"""

from __future__ import annotations

import importlib.metadata
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    __version__: str
    from hersey.damping.branches import Transition
    from hersey.damping.candidates import ModelComparison, compare_models, hersey_collapse, viscosity_laws
    from hersey.damping.compare import LogComparison, compare
    from hersey.damping.design import TestDesign, design
    from hersey.damping.dwells import SteadyPoints
    from hersey.damping.estimate import Estimate
    from hersey.damping.fit import fit
    from hersey.damping.no_load import rest_of_drive
    from hersey.damping.recipe import Recipe
    from hersey.damping.rest import RestOfDrive
    from hersey.damping.surface import DampingSurface
    from hersey.errors import HerseyError
    from hersey.exchange.unit import ExportedUnit, export_fmu
    from hersey.identification import CycleRecord, IdentifiedDrive, cycles, identify
    from hersey.inspection import Inspection, inspect
    from hersey.life.ageing_maps import AgeingMaps
    from hersey.life.campaign import Campaign
    from hersey.life.drift.result import Drift, fit_drift
    from hersey.life.fatigue import (
        RainflowCycles,
        SNCurve,
        damage_rate,
        life_of,
        miner_damage,
        rainflow_cycles,
        stick_slip_damage_rate,
    )
    from hersey.life.film.through_life import FilmLife, film_life
    from hersey.life.following import LifeTest, follow
    from hersey.life.growth.fit import Growth, fit_growth
    from hersey.life.growth.limit_ages import AgesAtLimit
    from hersey.life.indicator import Indicator, Indicators, Runs
    from hersey.life.indicators.of_campaign import indicators_of
    from hersey.life.other_uses import OtherUses, other_uses
    from hersey.life.population import BLife, Population, weibull
    from hersey.life.time_to_failure.estimate import TimeToFailure, time_to_failure
    from hersey.log import TorqueLog, memory_limit, read
    from hersey.log.many import ManyLogs, read_many
    from hersey.log.mapping import read_with_mapping
    from hersey.lubrication.asperities import Asperities, BoundaryFriction
    from hersey.lubrication.contact import Contact, nip_width
    from hersey.lubrication.film import drag_torque, film_thickness
    from hersey.lubrication.film_result import Film
    from hersey.lubrication.lubricant import Lubricant, ShearThinning
    from hersey.lubrication.mixed import MixedContact, MixedFilm, mixed_contact, mixed_torque
    from hersey.lubrication.mixed_drag import MixedDrag
    from hersey.lubrication.reynolds import (
        ElasticLayer,
        LineContactSolution,
        ThickeningFluid,
        solve_line_contact,
    )
    from hersey.machine import (
        Limits,
        Machine,
        OperatingPoint,
        Uncertainty,
        read_machine,
        read_temperature_profile,
    )
    from hersey.motion.belt import Drivetrain
    from hersey.motion.drag import Drag, DragTable
    from hersey.motion.heat import HeatBalance
    from hersey.motion.schedule import Schedule
    from hersey.motion.simulation import StickSlipCycle, simulate, stick_slip
    from hersey.motion.stepper import Stepper
    from hersey.motion.sweep import sweep
    from hersey.motion.trajectory import Trajectory
    from hersey.motion.work import Work
    from hersey.posterior.evidence import BreakAway, Start, StickSlip
    from hersey.posterior.result import Posterior
    from hersey.posterior.sampling import posterior
    from hersey.report.page import report
    from hersey.scale.store import SweepFolder
    from hersey.stability.disturbance import Disturbance, SafeStep, disturbance, safe_step
    from hersey.stability.hysteresis import (
        CyclesWithoutSticking,
        HysteresisBand,
        cycles_without_sticking,
        hysteresis,
    )
    from hersey.stability.hysteresis_sweep import hysteresis_sweep
    from hersey.stability.operating_map import OperatingMap, operating_map
    from hersey.stability.plan import Plan, plan_profile
    from hersey.stability.warm_up import warm_up
    from hersey.stability.warm_up_result import WarmUp
    from hersey.study.log_and_machine import Study, study
    from hersey.verdict.evidence import MeasuredFilm, measured_film
    from hersey.verdict.regime import Regime, regime

#: Where each public name lives.
_HOMES = {
    "errors": "HerseyError",
    "log": "TorqueLog memory_limit read",
    "log.mapping": "read_with_mapping",
    "log.many": "ManyLogs read_many",
    "motion.schedule": "Schedule",
    "motion.drag": "Drag DragTable",
    "motion.heat": "HeatBalance",
    "motion.simulation": "Drivetrain StickSlipCycle simulate stick_slip",
    "motion.trajectory": "Trajectory",
    "motion.stepper": "Stepper",
    "motion.sweep": "sweep",
    "motion.work": "Work",
    "scale.store": "SweepFolder",
    "damping.dwells": "SteadyPoints",
    "damping.estimate": "Estimate",
    "damping.branches": "Transition",
    "damping.fit": "fit",
    "damping.surface": "DampingSurface",
    "damping.recipe": "Recipe",
    "damping.rest": "RestOfDrive",
    "damping.no_load": "rest_of_drive",
    "damping.candidates": "ModelComparison compare_models hersey_collapse viscosity_laws",
    "damping.compare": "LogComparison compare",
    "damping.design": "TestDesign design",
    "inspection": "Inspection inspect",
    "posterior.evidence": "BreakAway Start StickSlip",
    "posterior.result": "Posterior",
    "posterior.sampling": "posterior",
    "lubrication.lubricant": "Lubricant ShearThinning",
    "lubrication.contact": "Contact nip_width",
    "lubrication.film": "drag_torque film_thickness",
    "lubrication.film_result": "Film",
    "lubrication.asperities": "Asperities BoundaryFriction",
    "lubrication.mixed": "MixedContact MixedFilm mixed_contact mixed_torque",
    "lubrication.mixed_drag": "MixedDrag",
    "lubrication.reynolds": "ElasticLayer LineContactSolution ThickeningFluid solve_line_contact",
    "machine": "Limits Machine OperatingPoint Uncertainty read_machine read_temperature_profile",
    "verdict.regime": "Regime regime",
    "verdict.evidence": "MeasuredFilm measured_film",
    "identification": "CycleRecord IdentifiedDrive cycles identify",
    "stability.hysteresis": "CyclesWithoutSticking HysteresisBand cycles_without_sticking hysteresis",
    "stability.hysteresis_sweep": "hysteresis_sweep",
    "stability.disturbance": "Disturbance SafeStep disturbance safe_step",
    "stability.operating_map": "OperatingMap operating_map",
    "stability.plan": "Plan plan_profile",
    "stability.warm_up": "warm_up",
    "stability.warm_up_result": "WarmUp",
    "study.log_and_machine": "Study study",
    "report.page": "report",
    "life.fatigue": (
        "RainflowCycles SNCurve damage_rate life_of miner_damage rainflow_cycles stick_slip_damage_rate"
    ),
    "life.drift.result": "Drift fit_drift",
    "life.growth.fit": "Growth fit_growth",
    "life.growth.limit_ages": "AgesAtLimit",
    "life.indicator": "Indicator Indicators Runs",
    "life.time_to_failure.estimate": "TimeToFailure time_to_failure",
    "life.indicators.of_campaign": "indicators_of",
    "life.following": "LifeTest follow",
    "life.ageing_maps": "AgeingMaps",
    "life.other_uses": "OtherUses other_uses",
    "life.population": "BLife Population weibull",
    "life.campaign": "Campaign",
    "life.film.through_life": "FilmLife film_life",
    "exchange.unit": "ExportedUnit export_fmu",
}
_HOME_OF = {name: module for module, names in _HOMES.items() for name in names.split()}

__all__ = [
    "AgeingMaps",
    "AgesAtLimit",
    "Asperities",
    "BLife",
    "BoundaryFriction",
    "BreakAway",
    "Campaign",
    "Contact",
    "CycleRecord",
    "CyclesWithoutSticking",
    "DampingSurface",
    "Disturbance",
    "Drag",
    "DragTable",
    "Drift",
    "Drivetrain",
    "ElasticLayer",
    "Estimate",
    "ExportedUnit",
    "Film",
    "FilmLife",
    "Growth",
    "HeatBalance",
    "HerseyError",
    "HysteresisBand",
    "IdentifiedDrive",
    "Indicator",
    "Indicators",
    "Inspection",
    "LifeTest",
    "Limits",
    "LineContactSolution",
    "LogComparison",
    "Lubricant",
    "Machine",
    "ManyLogs",
    "MeasuredFilm",
    "MixedContact",
    "MixedDrag",
    "MixedFilm",
    "ModelComparison",
    "OperatingMap",
    "OperatingPoint",
    "OtherUses",
    "Plan",
    "Population",
    "Posterior",
    "RainflowCycles",
    "Recipe",
    "Regime",
    "RestOfDrive",
    "Runs",
    "SNCurve",
    "SafeStep",
    "Schedule",
    "ShearThinning",
    "Start",
    "SteadyPoints",
    "Stepper",
    "StickSlip",
    "StickSlipCycle",
    "Study",
    "SweepFolder",
    "TestDesign",
    "ThickeningFluid",
    "TimeToFailure",
    "TorqueLog",
    "Trajectory",
    "Transition",
    "Uncertainty",
    "WarmUp",
    "Work",
    "__version__",
    "compare",
    "compare_models",
    "cycles",
    "cycles_without_sticking",
    "damage_rate",
    "design",
    "disturbance",
    "drag_torque",
    "export_fmu",
    "film_life",
    "film_thickness",
    "fit",
    "fit_drift",
    "fit_growth",
    "follow",
    "hersey_collapse",
    "hysteresis",
    "hysteresis_sweep",
    "identify",
    "indicators_of",
    "inspect",
    "life_of",
    "measured_film",
    "memory_limit",
    "miner_damage",
    "mixed_contact",
    "mixed_torque",
    "nip_width",
    "operating_map",
    "other_uses",
    "plan_profile",
    "posterior",
    "rainflow_cycles",
    "read",
    "read_machine",
    "read_many",
    "read_temperature_profile",
    "read_with_mapping",
    "regime",
    "report",
    "rest_of_drive",
    "safe_step",
    "simulate",
    "solve_line_contact",
    "stick_slip",
    "stick_slip_damage_rate",
    "study",
    "sweep",
    "time_to_failure",
    "viscosity_laws",
    "warm_up",
    "weibull",
]


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used."""
    if name == "__version__":  # the core knows it, too, and loads NumPy
        return importlib.metadata.version("hersey")
    if name not in _HOME_OF:
        raise AttributeError(f"module 'hersey' has no attribute '{name}'")
    value = getattr(importlib.import_module(f"hersey.{_HOME_OF[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
