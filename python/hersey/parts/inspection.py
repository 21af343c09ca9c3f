"""An inspection in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.parts.log import CorrectionPart
from hersey.parts.part import Part


class ClockPart(Part):
    """The times of a log's rows, in s."""

    name: str
    rows: int
    missing: int
    duration: float | None
    interval: float | None
    resolution: float | None
    uneven: float | None = Field(description="share of the intervals off the usual one")
    gaps: int
    longest_gap: float | None
    lost: float | None
    back: int
    first_back: int | None
    repeated: int
    findings: list[str]


class FaultPart(Part):
    """One kind of fault: rows concerned, the first of them (from 0), the value it stands at, and places."""

    kind: str
    rows: int
    first: int
    value: float | None
    places: int


class TraitsPart(Part):
    """What a channel looks like, in its own unit."""

    rows: int
    missing: int
    low: float | None
    high: float | None
    median: float | None
    step: float | None
    noise: float | None
    refresh: int
    faults: list[FaultPart]


class ChannelPart(Part):
    """A channel and the role it plays (empty if none)."""

    name: str
    unit: str
    role: str
    clock: str
    traits: TraitsPart
    findings: list[str]


class FileReportPart(Part):
    """A file: clocks, channels, and for each role without a channel the reason."""

    name: str
    format: str
    rows: int
    clocks: list[ClockPart]
    channels: list[ChannelPart]
    without: dict[str, str]
    notes: list[str]
    cut_off: bool


class SupportPart(Part):
    """Dwells and what they can tell; speeds in rad/s, temperatures in K."""

    dwells: int
    speeds: int
    speed_range: tuple[float, float] | None
    temperatures: list[float]
    rejected: dict[str, int]
    can: list[str]
    cannot: list[str]


class InspectionPart(Part):
    """Logs as they came, and what they support; null if they cannot be read as a log of torque."""

    files: list[FileReportPart]
    problem: str
    needed: list[str]
    dropped: dict[str, int] = Field(description="rows left out, by file")
    corrections: list[CorrectionPart]
    cautions: list[str] = Field(description="units, tare and order that are doubtful")
    support: SupportPart | None
