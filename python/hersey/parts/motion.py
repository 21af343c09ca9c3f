"""Motion in the document: in SI, or in the units of the arguments."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from hersey.parts.part import Numbers, Part


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


class TrainPart(Part):
    """Spring and mass of a drive."""

    stiffness: float = Field(description="N/m")
    mass: float = Field(description="kg")
    grip: float | None = Field(default=None, description="force up to which the roll grips the belt, N")


class ClosedDragPart(Part):
    """What laws of drag have beside their shape; temperatures in K."""

    stick_speed: float = Field(description="m/s")
    closure: str
    bristle_stiffness: float | None = Field(description="N/m")
    bristle_damping: float | None = Field(description="N s/m")
    reference_temperature: float | None
    force_temperature_exponent: float
    speed_temperature_exponent: float
    temperature_zero: float
    static_force: float | None = Field(default=None, description="what the contact bears at rest, N")
    rest_force: float = Field(default=0.0, description="of the rest of the drive, N")
    rest_damping: float = Field(default=0.0, description="of the rest of the drive, N s/m")
    rest_temperature_slope: float = Field(default=0.0, description="relative, 1/K")


class DragPart(ClosedDragPart):
    """A law of drag with two branches."""

    transition_force: float = Field(description="N")
    transition_speed: float = Field(description="m/s")
    ehl_exponent: float
    mixed_exponent: float
    static_growth: float = Field(default=0.0, description="of the static force, for each e-fold of time")
    static_growth_time: float | None = Field(default=None, description="s")


class DragTablePart(ClosedDragPart):
    """A drag curve through points, straight between them in logarithms; shapes (n,)."""

    speeds: Numbers = Field(description="m/s, ascending")
    forces: Numbers = Field(description="N")


class EnergyPart(Part):
    """Where the work of the drive went, J; the residual is a share of all energy turned over."""

    work: float
    dissipated: float
    slipped: float
    stored: float
    owed: float = Field(default=0.0, description="given by a contact that holds a belt, and not got back")
    residual: float


class CheckPart(Part):
    """The same run by another integrator; differences as shares of the greatest value."""

    integrator: str
    speed_difference: float | None
    stretch_difference: float | None
    same_events: bool
    note: str


class EventPart(Part):
    """A change of mode."""

    time: float = Field(description="s")
    from_mode: str
    to_mode: str
    guard: str
    stretch: float = Field(description="m")
    belt_speed: float = Field(description="m/s")


class TrajectoryPart(Part):
    """Motion at equally spaced times, arrays of shape (samples,)."""

    time: Numbers = Field(description="s")
    belt_speed: Numbers = Field(description="m/s")
    stretch: Numbers = Field(description="m")
    spring_force: Numbers = Field(description="N")
    mode: list[str]
    slipping: list[bool]
    events: list[EventPart]
    energy: EnergyPart
    steps: int
    check: CheckPart | None
    film_temperature: Numbers | None = Field(default=None, description="K, if it is a state")
    roll_temperature: Numbers | None = Field(default=None, description="K, if it is a state")


class MotorPart(Part):
    """What a motion asks of the motor, N m; ``exceeded_from`` in s, ``exceeded`` a share of the motion."""

    torque: float
    time: float = Field(description="s")
    limit: float
    exceeded_from: float | None
    exceeded: float


class StickSlipPart(Part):
    """What a motion settles to, with the energies of a run from the start if one was asked for."""

    kind: Literal["steady_sliding", "oscillation", "stick_slip", "unsettled", "stalled", "grip_slip"]
    frequency: float = Field(description="laps per unit of time, Hz")
    slip_duration: float = Field(description="s")
    stick_duration: float = Field(description="s")
    stuck_fraction: float
    speed_min: float = Field(description="m/s")
    speed_max: float = Field(description="m/s")
    stretch_min: float = Field(description="m")
    stretch_max: float = Field(description="m")
    grip_slip_duration: float = Field(description="s, a lap")
    drag_work: float = Field(description="a lap, J")
    laps_per_period: int
    laps: int
    energy: EnergyPart | None = None
    check: CheckPart | None = None
    motor: MotorPart | None = None
    warming: TrajectoryPart | None = Field(
        default=None, description="the run in which temperature was a state; the rest holds where it ends"
    )


class SweepPart(Part):
    """How many sets of a sweep have each outcome, and the range of numbers of those that stick and slip."""

    sets: int
    kinds: dict[str, int]
    stick_slip: dict[str, tuple[float, float]]
    failures: list[str]
