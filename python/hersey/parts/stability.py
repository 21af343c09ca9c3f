"""Bands, maps and plans in the document."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from hersey.parts.motion import DragPart, DragTablePart, TrainPart
from hersey.parts.part import Holed, Numbers, Part


class DisturbancePart(Part):
    """What a sliding belt bears; null where nothing is too large."""

    drive_speed: float
    kick: float | None = Field(description="sudden loss of belt speed, m/s")
    step: float | None = Field(description="sudden fall of the drive from so much faster to this speed, m/s")


class StepPart(Part):
    """A change of drive speed; the ramp time (s) is null where no ramp is slow enough."""

    from_speed: float
    to_speed: float
    sticks: bool
    slowest: float
    ramp_time: float | None


class BandPart(Part):
    """Drive speeds that divide the behaviour, m/s or the units of the arguments; null beyond the search."""

    lower: float | None
    transition: float
    upper: float | None = Field(description="zero, as lower, where no belt sticks and slips in turn")
    stalls: bool = Field(description="the roll's grip does not start a belt at rest")
    closure: str
    method: Literal["half laps", "simulation"]
    lower_accuracy: float | None = Field(description="relative")
    upper_accuracy: float | None = Field(description="relative")
    deeper: bool
    speed_max: float | None
    laps: int
    sensitivity: dict[str, float | None] = Field(description="relative change of upper per that of each")
    lower_sensitivity: dict[str, float | None]
    interval: tuple[float | None, float | None] | None = Field(description="of upper, 95 %")
    lower_interval: tuple[float | None, float | None] | None
    share_bistable: float | None
    bistable: bool
    verdict: str
    disturbance: DisturbancePart | None = None
    step: StepPart | None = None


class StatePart(Part):
    """What the belt does at one temperature and drive speed: speeds in m/s, torque in N m."""

    state: str
    moving: str = Field(description="state of a belt that moves already")
    torque: float
    holding: float = Field(description="what a belt at rest bears before it starts")
    starts: bool = Field(description="whether the drive starts a belt at rest")
    doubtful: bool = Field(default=False, description="whether the 95 % interval of holding says otherwise")
    lower: float | None
    transition: float
    upper: float | None
    stick_speed: float = Field(description="at this temperature")
    extrapolated: bool
    slipping: bool = Field(default=False, description="the roll may slip for a part of the laps")


class PlacedPart(Part):
    """An operating point: speed in m/s, temperature in K."""

    name: str
    speed: float
    temperature: float
    at: StatePart
    judged: str = Field(default="", description="verdict of the posterior that the edges are from")


class MapPart(Part):
    """Speeds (m/s) that divide the behaviour at each temperature (K), shape (n,); null beyond the search."""

    temperature: Numbers | None
    speed: Numbers = Field(description="m/s, shape (m,)")
    lower: Holed
    transition: Holed
    upper: Holed
    transition_interval: list[Holed] = Field(description="95 %, shape (2, n)")
    upper_interval: list[Holed] = Field(description="95 %, shape (2, n)")
    stall_below: Holed
    stall_above: Holed
    torque: list[Numbers] = Field(description="of steady sliding, N m, shape (n, m)")
    holding: Numbers = Field(description="what a belt at rest bears, N m, shape (n,)")
    holding_interval: list[Holed] = Field(default=[], description="95 %, N m, shape (2, n)")
    torque_limit: float | None = Field(description="N m")
    limited_by: str
    speed_limit: float | None = Field(description="m/s")
    measured_temperature: tuple[float, float] | None = Field(description="K")
    measured_speed: tuple[float, float] = Field(description="m/s")
    points: list[PlacedPart]
    uncertain: list[str]
    warnings: list[str]
    roll_radius: float = Field(description="m")
    train: TrainPart
    drag: DragTablePart | DragPart
    stick_speed_rule: Literal["with transition", "fixed"]
    given: bool = Field(default=False, description="whether the edges are those of a posterior of drives")


class StickSpeedPart(Part):
    """How V* moves with the stick speed at one temperature (K; null if isothermal): m/s, shape (n,)."""

    temperature: float | None
    stated: float = Field(description="stick speed of the machine's file, there")
    known: tuple[float, float] | None = Field(description="range that the file states, 95 %, there")
    stick_speed: Numbers
    transition: Numbers
    upper: Holed = Field(description="V*; null beyond the search")
    stiction: float | None = Field(
        default=None, description="V* at the stated stick speed of a belt that stops dead; null: not started"
    )


class WarmUpPart(Part):
    """Drive speed from a cold start: times in s, speeds in m/s, temperatures in K, forces in N."""

    verdict: str
    beside: list[str] = Field(description="what full speed at once, and standing until warm, would do")
    target_speed: float
    force_limit: float
    margin: float = Field(description="share of the limit kept to spare")
    acceleration: float = Field(description="m/s^2")
    time: Numbers = Field(description="shape (n,)")
    drive_speed: Numbers = Field(description="shape (n,), straight lines between")
    film_temperature: Numbers = Field(description="shape (n,)")
    roll_temperature: Numbers = Field(description="shape (n,)")
    drag: Holed = Field(description="of sliding steadily, shape (n,); null at standstill")
    start: float | None = Field(description="of the drive; null if it cannot start")
    full_speed: float | None = Field(description="from when on; null if not within the time looked at")
    slides_from: float | None = Field(description="from when on the belt slides for good; null if never")
    peak_force: float = Field(description="of the spring, in the motion")
    drag_at_once: float = Field(description="greatest, at full speed from the start on")
    within_at_once: float | None = Field(description="when that keeps the limit; null if not in time")
    full_speed_standing: float | None = Field(description="by standing until warm; null if not in time")
    rounds: int
    warnings: list[str]


class RowPart(Part):
    """A point of a drive profile."""

    time: float = Field(description="s")
    drive_speed: float = Field(description="m/s")


class LimitPart(Part):
    """A limit and what the profile takes of it, SI."""

    name: str
    limit: float
    used: float | None


class ObstaclePart(Part):
    """A limit that forbids every profile, SI; null where no value of it alone would do."""

    limit: str
    given: float | None
    needed: float | None
    text: str


class PlanPart(Part):
    """A profile of drive speed, or what forbids one: times in s, speeds in m/s, forces in N."""

    verdict: str
    rows: list[RowPart]
    kind: Literal["direct", "overshoot", "impossible"]
    target_speed: float
    confidence: float
    seed: int
    duration: float | None
    wait: float | None
    rise: float | None
    peak_speed: float | None
    hold: float | None
    fall: float | None
    share: float = Field(description="of fresh draws that are smooth")
    share_low: float = Field(description="exceeded by the true share with 95 %")
    draws: int
    failures: dict[str, int]
    uses: list[LimitPart]
    warnings: list[str]
    obstacles: list[ObstaclePart]
    fold_speed: float | None
    transition_speed: float
    stick_speed: float
    temperature: float | None = Field(description="K")
    greatest_speed: float | None
    peak_force: float | None
    tried: int
