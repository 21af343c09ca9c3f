"""Logs and dwells in the document."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from hersey.damping.no_load_torque import NoLoadTorque
from hersey.log.torque_log import Channel, TorqueLog
from hersey.schema.part import Part
from hersey.schema.record import part_of
from hersey.schema.warning import Warning


class MachineFilePart(Part):
    """The file that states the machine."""

    name: str
    sha256: str


class RecipePart(Part):
    """How the logs became dwells, as far as it is not the default; files by name."""

    settings: dict[str, Any] = Field(description="fields of `hersey.Recipe`, in SI")
    toml: str = Field(description="the same as a file for `hersey.Recipe.from_file`")


class InputFile(Part):
    """A file that went in; the sampling interval is the median, in s."""

    name: str
    sha256: str
    bytes: int
    rows: int
    missing_rows: int
    duration: float = Field(description="s")
    sampling_interval: float = Field(description="s")
    gaps: int = Field(description="how often rows are missing")
    channels: list[Channel]
    comments: list[str] = Field(description="comment lines above the header")


class DwellPart(Part):
    """A dwell: times in s, speed in rad/s, torque in N m, temperature in K; errors are standard errors."""

    run: int
    start: float
    end: float
    speed: float
    speed_error: float
    torque: float
    torque_error: float
    temperature: float | None
    temperature_error: float | None
    rows: int
    effective_rows: float = Field(description="independent samples")
    settling_rows: int = Field(description="rows cut at the ends")
    approach: Literal["from below", "from above", "start"]
    load: float | None = Field(description="N, null if not known")
    tare: float = Field(description="N m, subtracted")


class Point(DwellPart):
    """A dwell beside the fit: damping in N m s/rad."""

    group_temperature: float | None = Field(description="K, mean of the dwells at about this temperature")
    damping: float
    damping_fitted: float
    residual: float = Field(description="ln(measured/fitted)")


class RejectedStretch(Part):
    """A stretch that is not used; times in s."""

    run: int
    start: float
    end: float
    rows: int
    kind: str = Field(description="what is wrong")
    label: str = Field(description="kind in words, without numbers")
    reason: str
    speed: float | None = Field(default=None, description="rad/s, mean")


class Quality(Part):
    """How the rows of the log were used; torques in N m."""

    rows: int
    rows_used: int
    rows_settling: int
    rows_rejected: int
    standing_torque: float | None
    tare: float
    rejected: list[RejectedStretch]


class PointsPart(Part):
    """The dwells of a log; torques in N m."""

    points: list[DwellPart]
    rejected: list[RejectedStretch]
    tare: float
    tare_error: float
    tare_errors: list[list[float]] = Field(description="N m, shape (points, disturbances)")
    warnings: list[Warning]
    standing_torque: float | None
    rest: NoLoadTorque | None = Field(
        default=None, description="no-load torque, subtracted so that torque is that of the film"
    )
    rest_errors: list[list[float]] = Field(default=[], description="N m, shape (points, errors)")


class RunPart(Part):
    """What a file recorded: least and greatest time (s), torque (N m), speed (rad/s) and more where known."""

    name: str
    rows: int
    sampling_interval: float = Field(description="s")
    gaps: int = Field(description="how often rows are missing")
    time: tuple[float, float]
    torque: tuple[float, float]
    speed: tuple[float, float]
    temperature: tuple[float, float] | None = Field(description="K")
    load: tuple[float, float] | None = Field(description="N")


class Series(Part):
    """Samples for display: time in s, values in the unit of the chart."""

    time: list[float]
    value: list[float]


class Timeline(Part):
    """The log thinned for display, runs one after another: rad/s, N m, K."""

    speed: Series
    torque: Series
    temperature: Series | None
    starts: list[float] = Field(description="s, start of each run")


class LogPart(part_of(TorqueLog)):  # type: ignore[misc]  # made as it runs
    """Logs read as one: files, runs and corrections; the rows themselves are in the files."""

    runs: list[RunPart]
