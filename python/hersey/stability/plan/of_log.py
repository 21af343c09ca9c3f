"""The plan of a machine whose drag is that of a log: what fit and machine file leave open is drawn."""

from __future__ import annotations

from dataclasses import replace

from hersey.arrays import FloatArray
from hersey.damping.surface import DampingSurface
from hersey.errors import ParameterError, Setting, way_in
from hersey.machine.machine import Machine
from hersey.machine.uncertainty import Uncertainty
from hersey.motion.drag import Drag
from hersey.motion.heat import HeatBalance
from hersey.motion.schedule import Schedule
from hersey.schema.warning import Warning
from hersey.stability.plan.planner import plan_profile
from hersey.stability.plan.result import Plan
from hersey.stability.plan.search import Progress
from hersey.units import takes_si

#: What no share of draws counts: how a part comes to rest.
_GRADUAL_STOP = Warning(
    "gradual stop assumed",
    "this assumes that it comes to rest gradually (retained); if it stops abruptly (stiction), it may keep "
    "sticking",
    severity="watch",
)
#: Draws of the fit from which those of the plan are taken.
_DRAWS = 4000
_HEAT = Setting("heat")


@takes_si(target_speed="belt speed", temperature="temperature")
def plan_of_log(
    surface: DampingSurface,
    machine: Machine,
    *,
    target_speed: float,
    temperature: float | Schedule | HeatBalance | None = None,
    confidence: float = 0.95,
    seed: int = 1,
    progress: Progress | None = None,
) -> Plan:
    """Return the quickest profile from rest after which the belt of a machine slides, as `plan_profile` does.

    Parameters
    ----------
    surface, machine
        The fit of the log, and what the machine file states.
    target_speed
        m/s.
    temperature
        K, its profile, or what makes it; None for the fit of an isothermal log.
    confidence, seed, progress
        As in `plan_profile`.

    Raises
    ------
    InsufficientDataError
        If the data show no falling branch.
    ParameterError
        If temperature and fit do not go together, or a value is out of range, with its name.
    """
    varies = isinstance(temperature, Schedule | HeatBalance)
    kelvin = None if isinstance(temperature, Schedule | HeatBalance) else temperature
    drag, samples = drag_and_draws(surface, machine, kelvin, seed, varies=varies)
    plan = plan_profile(
        replace(machine, uncertainty=_uncertainty(machine, drag)),
        drag,
        target_speed=target_speed,
        temperature=temperature if varies else None,
        samples=samples,
        confidence=confidence,
        seed=seed,
        progress=progress,
    )
    return replace(plan, warnings=(*plan.warnings, _GRADUAL_STOP)) if plan.found else plan


def _uncertainty(machine: Machine, drag: Drag) -> dict[str, Uncertainty]:
    """How far parameters are known; a range of the stick speed moves with it from where it was stated."""
    known = dict(machine.uncertainty)
    if "stick_speed" in known:
        known["stick_speed"] = known["stick_speed"].times(drag.stick_speed / machine.stick_speed)
    return known


def drag_and_draws(
    surface: DampingSurface, machine: Machine, kelvin: float | None, seed: int, *, varies: bool
) -> tuple[Drag, dict[str, FloatArray]]:
    """Return the fitted drag, at one temperature (K) or varying with it, and draws of what the fit leaves.

    Raises
    ------
    InsufficientDataError
        If the data show no falling branch.
    ParameterError
        If temperature and fit do not go together.
    """
    check_temperature(surface, kelvin, varies=varies)
    drag = surface.drag(**machine.belt, temperature=kelvin)
    at = drag.reference_temperature if varies else kelvin
    # the fit's own command says how many draws have no falling branch
    samples, _ = surface.drawn_drag(_DRAWS, seed, **machine.belt, temperature=at)
    if surface.rest is not None:
        samples |= surface.rest.samples(_DRAWS, seed, roll_radius=machine.roll_radius, temperature=at)
    return drag, samples


def check_temperature(surface: DampingSurface, kelvin: float | None, *, varies: bool = False) -> None:
    """Refuse a temperature (K) that the fit needs and lacks, or does not have."""
    if surface.b is not None and kelvin is None and not varies:
        raise ParameterError(
            f"the drag depends on temperature. Give {_temperature('150 degC')} or {_HEAT.to()}"
        )
    if surface.b is None and (kelvin is not None or varies):
        raise ParameterError(f"the log is isothermal. Do not give {_temperature()} or {_HEAT.to()}")


def _temperature(at: str = "") -> str:
    """How a temperature, or its course, is given."""
    if way_in() == "terminal":
        return f"{Setting('at').to(at)}, {Setting('temperature_profile').to()}"
    return Setting("temperature").to(at, python="423.15" if at else "")
