"""The typical belt of the machine, simulated below its transition speed."""

from __future__ import annotations

from pydantic import Field

from hersey.decision.behaviour import Behaviour, typical
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import DragTable
from hersey.motion.simulation import simulate, stick_slip
from hersey.schema.part import Part
from hersey.study.thinning import kept
from hersey.units import celsius, rpm

#: Drive speed of the simulation, as a share of the transition speed.
SIMULATED_SPEED = 0.8


class SimulationPart(Part):
    """A simulation from rest at a low drive speed."""

    title: str
    units: str
    speed_unit: str
    force_unit: str
    parameters: dict[str, float | str]
    kind: str
    frequency: float = Field(description="Hz")
    stuck_fraction: float
    speed_max: float
    time: list[float]
    belt_speed: list[float]
    spring_force: list[float]
    transition_speed: float
    drive_speed: float


def simulation(found: Behaviour) -> SimulationPart:
    """Return the typical belt of this machine below its transition speed.

    Raises
    ------
    HerseyError
        If the motion cannot be computed.
    """
    kelvin = found.temperature
    train, drag = typical(found)
    at = "" if kelvin is None else f" at {celsius(kelvin):.0f} °C"
    turn = drag.law_at(None).transition_speed
    slow = max(SIMULATED_SPEED * turn, 1.05 * drag.stick_speed)
    roll = slow / found.posterior.model.machine.roll_radius
    title = (
        f"This machine{at}, driven at {rpm(roll):.3g} rpm ({100 * slow / turn:.0f} % of its transition speed)"
    )
    return _simulated(train, drag, slow, title)


def _simulated(
    train: Drivetrain,
    drag: DragTable,
    speed: float,
    title: str,
) -> SimulationPart:
    cycle = stick_slip(train, drag, drive_speed=speed)
    period = 1.0 / cycle.frequency if cycle.frequency else 10.0 * (train.mass / train.stiffness) ** 0.5
    first = drag.holding_force / train.stiffness / speed
    run = simulate(train, drag, drive_speed=speed, duration=first + 6.0 * period, samples=4001)
    samples = kept(run.belt_speed, 1500)
    if cycle.kind in ("stalled", "grip_slip"):
        title += "; the drive slips" + (" and does not move it" if cycle.kind == "stalled" else "")
    beside, law = {"rest_force": drag.rest_force, "rest_damping": drag.rest_damping}, drag.law_at(None)
    return SimulationPart(
        title=title,
        units="SI: N/m, kg, N, m/s",
        speed_unit="m/s",
        force_unit="N",
        parameters={
            "stiffness": train.stiffness,
            "mass": train.mass,
            "transition_force": law.transition_force,
            "transition_speed": law.transition_speed,
            "stick_speed": drag.stick_speed,
            "closure": drag.closure,
            **(beside if any(beside.values()) else {}),
        },
        kind=cycle.kind,
        frequency=cycle.frequency,
        stuck_fraction=cycle.stuck_fraction,
        speed_max=cycle.speed_max,
        time=run.time[samples].tolist(),
        belt_speed=run.belt_speed[samples].tolist(),
        spring_force=run.spring_force[samples].tolist(),
        transition_speed=law.transition_speed,
        drive_speed=speed,
    )
