"""A start-up profile through changing temperature that works on nearly all draws of the posterior."""

from __future__ import annotations

from dataclasses import replace

from hersey.damping.surface import FIXED, WITH_TRANSITION
from hersey.errors import ParameterError
from hersey.motion.heat import HeatBalance
from hersey.motion.schedule import Schedule
from hersey.posterior import Posterior
from hersey.posterior.drags import drags_through
from hersey.posterior.typical import typical_draw
from hersey.stability.plan.planner import plan_profile
from hersey.stability.plan.result import Plan
from hersey.stability.plan.search import Progress
from hersey.stability.plan.trial import TemperatureProfile


def plan_warm_start(
    found: Posterior,
    target_speed: float,
    *,
    temperature: Schedule | None = None,
    heat: HeatBalance | None = None,
    confidence: float = 0.95,
    seed: int = 1,
    progress: Progress | None = None,
) -> Plan:
    """Return the quickest start-up to a target speed (m/s) while temperature changes.

    Every other draw serves the search, the rest prove what it finds. The drag of each draw is exact at the
    last temperature; powers of temperature lead there.

    Parameters
    ----------
    temperature
        K against time, s.
    heat
        Instead of it: what makes the temperature.
    confidence
        Share of the fresh draws that must slide.
    seed
        Of the search.
    progress
        Called with (done, all) of a stage.

    Raises
    ------
    ParameterError
        If a value is out of range, the log is isothermal, or neither or both of temperature and heat are
        given.
    """
    if (temperature is None) == (heat is None):
        raise ParameterError("give either temperature, as a profile, or heat, which makes it")
    model, machine = found.model, found.model.machine
    if machine.stick_speed_rule == FIXED:
        raise ParameterError(
            f"a stick speed that is '{FIXED}' at all temperatures cannot be followed while temperature "
            f"changes: give one temperature, or stick_speed_rule '{WITH_TRANSITION}'"
        )
    course = TemperatureProfile(temperature)
    last = course.at(course.end) if heat is None else heat.setpoint
    kelvin = last or found.temperature or model.surface.reference_temperature
    if kelvin is None:
        raise ParameterError("the log is isothermal: its drag does not vary with temperature")
    coldest = _coldest(course, heat)
    [(train, drag)] = drags_through(model, typical_draw(found, kelvin), kelvin, coldest)
    if drag.closure == "stribeck":  # what is drawn of a plan needs a stuck phase
        drag = replace(drag, closure="retained")
    return plan_profile(
        train,
        drag,
        target_speed=target_speed,
        temperature=temperature,
        heat=heat,
        limits=machine.limits,
        roll_radius=machine.roll_radius,
        machines=drags_through(model, found.drives, kelvin, coldest),
        confidence=confidence,
        seed=seed,
        progress=progress,
    )


def _coldest(course: TemperatureProfile, heat: HeatBalance | None) -> float:
    if heat is None:
        return min(value for _, value in course.levels)
    return min(float(heat.film_temperature), float(heat.roll_temperature))
