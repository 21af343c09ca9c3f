"""What a plan is: the profile, its proof, or what forbids it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import numpy as np

from hersey.motion.schedule import Schedule
from hersey.motion.trajectory import Trajectory
from hersey.result import OPEN, Means, Record, Result
from hersey.schema.warning import Warning
from hersey.stability.plan.obstacles import Obstacle, speed_text
from hersey.units import celsius

if TYPE_CHECKING:
    import polars as pl

#: Shares of the draws that may be asked for.
CONFIDENCES = (0.5, 0.999)
#: What a plan without a profile has.
NOTHING: Mapping[str, Any] = {
    "kind": "impossible",
    "schedule": None,
    **dict.fromkeys(("duration", "wait", "rise", "peak_speed", "hold", "fall", "peak_force"), math.nan),
    "share": 0.0,
    "share_low": 0.0,
    "draws": 0,
    "failures": {},
    "uses": (),
    "response": None,
}


#: SI unit of each limit.
_UNITS = {
    "speed": "m/s",
    "acceleration": "m/s²",
    "motor_torque": "N·m",
    "spring_force": "N",
    "grip": "N",
}


class ProfileRow(NamedTuple):
    """A point of a drive profile."""

    time: Annotated[float, Means(unit="s")]
    drive_speed: Annotated[float, Means(unit="m/s")]


@dataclass(frozen=True)
class LimitUse(Record):
    """A limit and what the profile takes of it (SI): the most that a share ``confidence`` of draws takes."""

    name: str
    limit: float
    used: Annotated[float, OPEN]


@dataclass(frozen=True, repr=False)
class Plan(Result):
    """A profile of drive speed, or the reasons why there is none.

    ``kind`` is ``direct`` (straight to the target), ``overshoot`` (above the target and down) or
    ``impossible``; then ``schedule`` is None and ``obstacles`` says why. ``duration`` (s) is the time after
    which the drive is at the target and the belt slides steadily; ``wait`` (s) is the time at rest before the
    start, to warm up. ``share`` of ``draws`` new draws are smooth after that and keep all limits;
    ``failures`` counts the problems of the others; ``share_low`` is the lower 95 % bound of the true share. A
    share ``confidence`` of them stays below the spring force ``peak_force`` (N). ``response`` is the motion
    at the nominal parameters, its time counted from the end of the wait. ``fold_speed``, ``transition_speed``
    and ``stick_speed`` (m/s) are nominal, at ``temperature`` (K), that of the end. Peak speeds up to
    ``greatest_speed`` were considered, and ``tried`` profiles tested. ``warnings`` names what was not stated,
    or is not in the model. ``course`` is the film temperature (K) against time, for a plan with heating, from
    the moment at which the drive could start.
    """

    also_stated = ("verdict", "rows")
    not_stated = ("schedule", "response", "course")

    kind: str
    target_speed: float
    confidence: float
    seed: int
    schedule: Schedule | None
    duration: Annotated[float, OPEN]
    wait: Annotated[float, OPEN]
    rise: Annotated[float, OPEN]
    peak_speed: Annotated[float, OPEN]
    hold: Annotated[float, OPEN]
    fall: Annotated[float, OPEN]
    share: Annotated[float, Means("of new draws that are smooth")]
    share_low: Annotated[float, Means("lower 95 % bound of the true share")]
    draws: int
    failures: Mapping[str, int]
    uses: tuple[LimitUse, ...]
    warnings: tuple[Warning, ...]
    obstacles: tuple[Obstacle, ...]
    fold_speed: Annotated[float, OPEN]
    transition_speed: float
    stick_speed: float
    temperature: Annotated[float | None, Means(unit="K")]
    greatest_speed: Annotated[float, OPEN]
    peak_force: Annotated[float, OPEN]
    tried: int
    response: Trajectory | None
    course: Schedule | None = None

    @property
    def found(self) -> bool:
        """Whether there is a profile."""
        return self.schedule is not None

    def rows(self) -> list[ProfileRow]:
        """Return times (s) and drive speeds (m/s), joined by straight lines; equal times make a jump."""
        if self.schedule is None:
            return []
        times, speeds = np.asarray(self.schedule.times), np.asarray(self.schedule.values)
        return list(map(ProfileRow, times.tolist(), speeds.tolist()))

    def verdict(self) -> str:
        """Return the decision in a sentence or two."""
        if not self.found:
            return " ".join(["No profile ends in steady sliding.", *(o.text for o in self.obstacles)])
        up = f"in {self.rise:.4g} s" if self.rise > 0 else "at once"
        if self.kind == "direct":
            way = f"Accelerate directly to {speed_text(self.target_speed)} {up}"
        else:
            down = f"in {self.fall:.4g} s" if self.fall > 0 else "at once"
            held = f"hold for {self.hold:.4g} s, " if self.hold > 0 else ""
            way = f"Accelerate to {speed_text(self.peak_speed)} {up}, {held}"
            way += f"slow down to {speed_text(self.target_speed)} {down}"
        start = f"Wait {self.wait:.5g} s. " if self.wait > 0 else ""
        return f"{start}{way}. After {self.duration:.5g} s the drive runs at the target and slides steadily."

    def proof(self) -> str:
        """Return how the plan was verified, in a sentence."""
        if self.draws == 1:
            return "Checked at the nominal parameters only, which are assumed known within 0.1 %."
        return (
            f"Smooth and within the limits for {100 * self.share:.1f} % of {self.draws} new draws (95 % "
            f"lower bound {math.floor(1000 * self.share_low) / 10:.1f} %; {100 * self.confidence:g} % "
            "required)."
        )

    def temperature_words(self) -> str:
        """Return the film temperature during the plan, in a sentence; empty if it was given."""
        if self.course is None:
            return ""
        at = [f"{celsius(self.course.at(time)):.4g} degC" for time in (0.0, self.wait, self.duration)]
        return f"film: {at[0]} initially, {at[1]} when the drive starts, {at[2]} when it slides steadily"

    def table(self) -> str:
        """Return the profile as CSV for a motor controller, with straight lines between the rows."""
        lines = ["time [s],drive speed [m/s]"]
        return "\n".join([*lines, *(f"{t:.12g},{v:.12g}" for t, v in self.rows())]) + "\n"

    def summary(self) -> str:
        """Return verdict, proof, profile and use of the limits as text."""
        lines = [self.verdict()]
        if self.found:
            lines += [self.proof(), "", f"  {'time (s)':>12s}  {'drive speed (mm/s)':>18s}"]
            lines += [f"  {time:12.6g}  {1e3 * value:18.6g}" for time, value in self.rows()]
            lines.append("")
            lines += [
                f"{use.name.replace('_', ' ')}: {use.used:.4g} of {use.limit:.4g} {_UNITS.get(use.name, '')}"
                for use in self.uses
            ]
            lines += [self.temperature_words()] if self.course is not None else []
            lines += [f"- {warning}" for warning in self.warnings]
            lines += [f"- {number} of {self.draws} draws: {why}" for why, number in self.failures.items()]
        speeds = (self.transition_speed, self.fold_speed, self.stick_speed)
        bend, fold, stick = (f"{1e3 * speed:.4g} mm/s" for speed in speeds)
        at = "" if self.temperature is None else f" at {celsius(self.temperature):.0f} degC"
        lines.append(f"nominal transition speed {bend}, V* {fold}, stick speed {stick}{at}")
        return "\n".join([*lines, f"seed {self.seed}"])

    def headline(self) -> str:
        """Return kind, target and duration."""
        target = f"{self.kind}, target {speed_text(self.target_speed)}"
        return f"{target}, {self.duration:.4g} s" if self.found else target

    def to_frame(self) -> pl.DataFrame:
        """Return the profile; no rows if there is none."""
        import polars as pl

        schema = {"time (s)": pl.Float64, "drive speed (m/s)": pl.Float64}
        return pl.DataFrame(self.rows(), schema=schema, orient="row")
