"""A log of drive torque, speed and temperature, in SI, with where every number came from."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from hersey.arguments.door import Words
from hersey.arrays import FloatArray
from hersey.log.clock import Clock, clock_of
from hersey.log.impossible import Impossible
from hersey.log.long_arrays import passed
from hersey.log.middle import median_step
from hersey.log.sensors import Sensors
from hersey.result import Means, Record, Result
from hersey.schema.domain import TORQUE, Domain
from hersey.schema.warning import Warning
from hersey.units import celsius, takes_si

if TYPE_CHECKING:
    import polars as pl

    from hersey.damping.dwells import SteadyPoints
    from hersey.damping.moving.result import MovingFit

#: SI unit of each channel that can be corrected.
CHANNEL_UNITS = {"torque": "N m", "speed": "rad/s", "temperature": "K"}
#: Name of the clock of a log without one: rows are counted.
NO_CLOCK = "number of the row"
#: No quantity of a drive comes near this, in SI.
LARGEST = 1e12
#: Slower than this, rad/s, the drive stands.
STANDING = TORQUE.standing
#: What is subtracted from torque, and the directions whose dwells are used.
TARES, ROTATIONS = Words(("none", "standing")), Words(("both", "forward", "reverse"))


@dataclass(frozen=True)
class Channel(Record):
    """One column that was used: its role, its name and unit as written."""

    role: str
    name: str
    unit: str


@dataclass(frozen=True)
class LogFile(Record):
    """One file that was read."""

    name: str
    sha256: str
    bytes: int
    rows: int
    missing_rows: int  #: left out: a number is missing, or cannot be right
    channels: tuple[Channel, ...]
    comments: Annotated[tuple[str, ...], Means("comment lines above the header")]
    cut_off: Annotated[bool, Means("whether the file ends before its time")] = False
    warnings: Annotated[
        tuple[Warning, ...], Means("how the file was read: clocks aligned, time stamps, lines skipped")
    ] = ()
    impossible: Annotated[tuple[Impossible, ...], Means("impossible readings")] = ()

    @property
    def synthetic(self) -> bool:
        """Whether the file says in a comment that it is no measurement."""
        return any("synthetic" in comment.lower() for comment in self.comments)


@dataclass(frozen=True)
class Run(Record):
    """What was recorded in one go: arrays of shape (rows,) in s, N m, rad/s, K and N."""

    name: str
    time: FloatArray
    torque: FloatArray
    speed: FloatArray
    temperature: FloatArray | None
    load: FloatArray | None = None  #: normal load, N, where it is known
    domain: Domain = TORQUE  #: what ``torque`` and ``speed`` hold: friction and sliding speed, if it says so
    position: FloatArray | None = None  #: angle, rad, whose slope the speed is, if one was recorded

    def to_dict(self) -> dict[str, Any]:
        """Return the size of the run and the range of each channel, in SI."""
        channels = {name: getattr(self, name) for name in _COLUMNS}
        return {
            "name": self.name,
            "rows": self.time.size,
            "sampling_interval": self.sampling_interval,
            "gaps": self.clock.gaps,
            **{name: None if values is None else list(_ends(values)) for name, values in channels.items()},
        }

    def passed(self, start: int, end: int) -> None:
        """Note that these rows were seen: of a long run no more is held in memory than was seen lately."""
        passed(start, end, *(values for name in _COLUMNS if (values := getattr(self, name)) is not None))

    @cached_property
    def sampling_interval(self) -> float:
        """Median time between rows in s; where clocks are coarse and stamps repeat, the mean."""
        return median_step(self.time) or float(self.time[-1] - self.time[0]) / (self.time.size - 1)

    @cached_property
    def clock(self) -> Clock:
        """What the times show of the clock: its interval, and where rows are missing."""
        return clock_of(self.name, self.time)


@dataclass(frozen=True)
class Effect(Record):
    """How far a correction moved a role: its largest and root mean square change, SI, and the latter's share.

    ``share`` is of the median of the absolute values before, or None where that is zero.
    """

    role: Annotated[str, Means("channel that was moved: torque, speed or temperature")]
    largest: Annotated[float, Means("largest change, in SI")]
    typical: Annotated[float, Means("root mean square change, in SI")]
    share: Annotated[float | None, Means("typical over the median before; null where that is 0")]

    def __str__(self) -> str:
        """Return it in words."""
        unit = CHANNEL_UNITS[self.role]
        share = (
            ""
            if self.share is None or self.role == "temperature"
            else f", {100.0 * self.share:.2g} % of its median"
        )
        return f"{self.role} by at most {self.largest:.3g} {unit}, {self.typical:.3g} {unit} rms{share}"


@dataclass(frozen=True)
class Correction(Record):
    """Record of one correction: its parameters as written with units, its effects, and what stayed."""

    name: str
    parameters: Annotated[tuple[tuple[str, str], ...], Means("name and value with unit of each")]
    effects: Annotated[tuple[Effect, ...], Means("one for each role that it moved")]
    warnings: tuple[Warning, ...] = ()

    def __str__(self) -> str:
        """Return it as one line."""
        stated = ", ".join(f"{key} {value}" for key, value in self.parameters)
        changed = "; ".join(str(effect) for effect in self.effects)
        moved = f": changed {changed}" if changed else ""
        return "; ".join([f"{self.name} ({stated}){moved}", *map(str, self.warnings)])


@dataclass(frozen=True, repr=False)
class TorqueLog(Result):
    """One or more runs on the same machine, as returned by `hersey.read`."""

    also_stated = ("rows",)
    not_stated = ("sensors",)

    runs: tuple[Run, ...]
    files: tuple[LogFile, ...]
    corrections: tuple[Correction, ...] = ()  #: what was corrected, in this order
    sensors: Sensors = field(default_factory=Sensors)

    @property
    def rows(self) -> int:
        """Rows used, over all runs."""
        return sum(run.time.size for run in self.runs)

    @property
    def title(self) -> str:
        """Name of the first file, and the number of others."""
        return title_of(self.files)

    @property
    def domain(self) -> Domain:
        """What was measured: a torque, or a friction force or coefficient, against which speed."""
        return self.runs[0].domain

    @property
    def has_temperature(self) -> bool:
        """Whether every run has a temperature."""
        return all(run.temperature is not None for run in self.runs)

    def summary(self) -> str:
        """Return files, ranges and corrections as text."""
        lines = [f"{self.rows} rows in {len(self.runs)} run{'s' if len(self.runs) > 1 else ''}"]
        for file, run in zip(self.files, self.runs, strict=True):
            lines.append(f"{file.name}: {_ranges(run)}")
        return "\n".join([*lines, *(f"corrected: {correction}" for correction in self.corrections)])

    def to_frame(self) -> pl.DataFrame:
        """Return every row: index of the run, time, torque, speed and, if recorded, temperature."""
        import polars as pl

        return pl.concat([_run_frame(index, run) for index, run in enumerate(self.runs)], how="diagonal")

    @takes_si(min_dwell="time", tare=TARES, rotation=ROTATIONS)
    def steady(self, *, min_dwell: float = 2.0, tare: str = "none", rotation: str = "both") -> SteadyPoints:
        """Reduce the log to its steady points: see `hersey.damping.dwells.steady_points`."""
        from hersey.damping.dwells import steady_points

        return steady_points(self, min_dwell=min_dwell, tare=tare, rotation=rotation)

    @takes_si()
    def moving(self, *, inertia: Any = None) -> MovingFit:
        """Fit friction, inertia and offset to every sample: see `hersey.fit_moving`."""
        from hersey.damping.moving.fit import fit_moving

        return fit_moving(self, inertia=inertia)


def title_of(files: tuple[LogFile, ...]) -> str:
    """Return the name of the first file, and how many more there are."""
    first = files[0].name
    return first if len(files) == 1 else f"{first} and {len(files) - 1} more"


#: Channels of a run and their columns in a table.
_COLUMNS = {
    "time": "time (s)",
    "torque": "torque (N m)",
    "speed": "speed (rad/s)",
    "temperature": "temperature (K)",
    "load": "load (N)",
}


def _ends(values: FloatArray) -> tuple[float, float]:
    return float(np.min(values)), float(np.max(values))


def _ranges(run: Run) -> str:
    """What a run spans, for people."""
    of, (least, most) = run.domain, _ends(run.torque)
    duration = float(run.time[-1] - run.time[0])
    text = (
        f"{run.time.size} rows, {duration:.5g} s; {of.between(*_ends(run.speed), '.4g')}, "
        f"{'' if of.is_torque else f'{of.quantity} '}{least:.4g} to {of.amount(most, '.4g')}"
    )
    if run.temperature is None:
        return text
    cold, hot = (celsius(end) for end in _ends(run.temperature))
    return f"{text}, {cold:.4g} to {hot:.4g} degC"


def _run_frame(index: int, run: Run) -> pl.DataFrame:
    import polars as pl

    channels = {title: getattr(run, name) for name, title in _COLUMNS.items()}
    columns = {title: values for title, values in channels.items() if values is not None}
    of = run.domain
    if not of.is_torque:
        named = {
            "torque (N m)": f"{of.quantity} ({of.unit or 1})",
            "speed (rad/s)": f"{of.speed} ({of.speed_unit})",
        }
        columns = {named.get(title, title): values for title, values in columns.items()}
    return pl.DataFrame(columns).insert_column(0, pl.Series("run", np.full(run.time.size, index)))
