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
    temperature: Schedule | HeatBalance,
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
        K against time, s; or what makes it.
    confidence
        Share of the fresh draws that must slide.
    seed
        Of the search.
    progress
        Called with (done, all) of a stage.

    Raises
    ------
    ParameterError
        If a value is out of range, or the log is isothermal.
    """
    model, machine = found.model, found.model.machine
    if machine.stick_speed_rule == FIXED:
        raise ParameterError(
            f"stick_speed_rule '{FIXED}' cannot be used while temperature changes. Give one "
            f"temperature, or use stick_speed_rule '{WITH_TRANSITION}'"
        )
    if isinstance(temperature, HeatBalance):
        coldest = min(float(temperature.film_temperature), float(temperature.roll_temperature))
        last = temperature.setpoint
    else:
        course = TemperatureProfile(temperature)
        coldest = min(value for _, value in course.levels)
        last = course.at(course.end)
    kelvin = last or found.temperature or model.surface.reference_temperature
    if kelvin is None:
        raise ParameterError("the log is isothermal, so its drag does not depend on temperature")
    [(train, drag)] = drags_through(model, typical_draw(found, kelvin), kelvin, coldest)
    if drag.closure == "stribeck":  # what is drawn of a plan needs a stuck phase
        drag = replace(drag, closure="retained")
    return plan_profile(
        replace(machine, stiffness=train.stiffness, mass=train.mass),
        drag,
        target_speed=target_speed,
        temperature=temperature,
        samples=drags_through(model, found.drives, kelvin, coldest),
        confidence=confidence,
        seed=seed,
        progress=progress,
    )
