"""Friction curves of virtual joints: intervals, laws and directions; writes docs/validation/joints.md.

The generator below shares no code with the fit. Each joint is a staircase in both directions, written as CSV
and read as a user's log would be: `hersey.Recipe(...).points()`, then `hersey.fit_friction`. The screw drives
measured by others are read in place where they are there.

Usage: python -m benchmarks.joints [--joints 30] [--seed 1] [--folder ../shared/data]
"""

from __future__ import annotations

import argparse
import math
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import hersey
from hersey.verdict.friction import leading_friction

Array = NDArray[np.float64]

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "validation" / "joints.md"
RPM = 2.0 * math.pi / 60.0
#: Hz; s of a standstill, of a dwell, of a change of speed.
RATE, STANDING, DWELL, RAMP = 50.0, 3.0, 8.0, 0.4
#: Shares of the Coulomb torque: white noise of a sample, slow noise, offset of the sensor.
WHITE, SLOW, OFFSET = 0.02, 0.004, 0.02
#: Time of the slow noise, s.
TAU = 0.4
#: Scatter from dwell to dwell, share of torque: none in every other joint.
SCATTER = 0.004
#: Joints of each setting whose whole verdict is asked for.
WHOLE = 5
#: Temperature of k_v, degC, and those of a joint that warms up, each visited twice.
REFERENCE, WARM = 40.0, (25.0, 40.0, 60.0)
NAMES = ("T_C", "T_S", "w_S", "k_v", "s")


@dataclass(frozen=True)
class Side:
    """One direction: N m, N m, rad/s, N m s/rad; static friction is None without a Stribeck rise."""

    coulomb: float
    viscous: float
    static: float | None = None
    stribeck: float = 1.0

    def torque(self, speed: float, thinned: float) -> float:
        """Return the torque at a speed > 0."""
        rise = 0.0 if self.static is None else self.static - self.coulomb
        return (
            self.coulomb + rise * math.exp(-((speed / self.stribeck) ** 2)) + self.viscous * thinned * speed
        )


@dataclass(frozen=True)
class Joint:
    """The truth: both directions, speeds (rpm), temperatures (degC) in their order, fall of ln k_v per K."""

    forward: Side
    reverse: Side
    speeds: tuple[float, ...]
    temperatures: tuple[float, ...] = ()
    thinning: float = 0.0
    scatter: float = 0.0

    def truth(self, name: str, direction: str) -> float:
        """Return the true parameter."""
        side = self.reverse if direction == "reverse" else self.forward
        return {
            "T_C": side.coulomb,
            "T_S": side.static or math.nan,
            "w_S": side.stribeck,
            "k_v": side.viscous,
            "s": self.thinning,
        }[name]


#: The last one has no dwell slow enough to show its Stribeck rise.
SETTINGS = (
    "viscous",
    "viscous, apart",
    "Stribeck",
    "Stribeck, apart",
    "viscous, warming up",
    "Stribeck, all dwells too fast",
)


def drawn(setting: str, rng: np.random.Generator) -> Joint:
    """Draw a joint of a setting."""
    coulomb = float(np.exp(rng.uniform(np.log(0.02), np.log(20.0))))
    fastest = float(rng.uniform(60.0, 600.0))
    viscous = coulomb * float(rng.uniform(0.2, 1.2)) / (fastest * RPM)
    stribeck = setting.startswith("Stribeck")
    static = coulomb * float(rng.uniform(1.2, 1.8)) if stribeck else None
    at = fastest * RPM * float(rng.uniform(0.05, 0.15))
    forward = Side(coulomb, viscous, static, at)
    reverse = forward
    if "apart" in setting:
        ratio = [float(rng.choice([1.0, -1.0]) * rng.uniform(0.06, 0.3)) for _ in range(2)]
        reverse = Side(
            coulomb * (1.0 + ratio[0]),
            viscous * (1.0 + ratio[1]),
            None if static is None else static * (1.0 + ratio[0]),
            at * (1.0 + 0.5 * ratio[1]),
        )
    slowest = at / RPM * float(rng.uniform(0.1, 0.25)) if stribeck else fastest / 40.0
    if "too fast" in setting:
        slowest = at / RPM * float(rng.uniform(2.5, 3.5))
    speeds = tuple(np.geomspace(slowest, fastest, int(rng.integers(9, 13))).tolist())
    hot = (*WARM, *WARM[::-1]) if "warming" in setting else ()
    thinning = float(rng.uniform(0.01, 0.04)) if hot else 0.0
    return Joint(forward, reverse, speeds, hot, thinning, SCATTER * float(rng.integers(0, 2)))


@dataclass
class _Rows:
    """Rows of the log as they are made."""

    speed: list[float] = field(default_factory=list)
    torque: list[float] = field(default_factory=list)
    celsius: list[float] = field(default_factory=list)

    def add(self, count: int, speed: Array | float, torque: Array | float, celsius: float) -> None:
        """Add so many rows."""
        for name, values in (("speed", speed), ("torque", torque), ("celsius", celsius)):
            getattr(self, name).extend(np.broadcast_to(values, count).tolist())


def written(joint: Joint, rng: np.random.Generator, path: Path) -> None:
    """Write the log of a joint."""
    rows, rest = _Rows(), int(STANDING * RATE)
    for celsius in joint.temperatures or (REFERENCE,):
        thinned = math.exp(-joint.thinning * (celsius - REFERENCE))
        for side, sign in ((joint.forward, 1.0), (joint.reverse, -1.0)):
            rows.add(rest, 0.0, 0.0, celsius)
            last = (0.0, 0.0)
            for rpm in joint.speeds:
                wander = 1.0 + joint.scatter * float(rng.standard_normal())
                now = sign * rpm, sign * side.torque(rpm * RPM, thinned) * wander
                ramp = int(RAMP * RATE)
                between = np.linspace(last, now, ramp)
                rows.add(ramp, between[:, 0], between[:, 1], celsius)
                rows.add(int(DWELL * RATE), now[0], now[1], celsius)
                last = now
    rows.add(rest, 0.0, 0.0, celsius)
    count, level = len(rows.speed), joint.forward.coulomb
    slow = np.empty(count)
    keep, state = math.exp(-1.0 / (RATE * TAU)), 0.0
    kicks = rng.standard_normal(count) * SLOW * level * math.sqrt(1.0 - keep**2)
    for i, kick in enumerate(kicks.tolist()):
        state = keep * state + kick
        slow[i] = state
    torque = np.array(rows.torque) + slow + WHITE * level * rng.standard_normal(count) + OFFSET * level
    speed = np.array(rows.speed) * (1.0 + 0.002 * rng.standard_normal(count))
    columns = {"time (s)": np.arange(count) / RATE, "speed (rpm)": speed, "torque (N*m)": torque}
    if joint.temperatures:
        columns["temperature (degC)"] = np.array(rows.celsius) + 0.1 * rng.standard_normal(count)
    table = np.column_stack(list(columns.values()))
    np.savetxt(path, table, delimiter=",", header=",".join(columns), comments="", fmt="%.6g")


@dataclass(frozen=True)
class Judged:
    """What the fit says of a joint beside the truth."""

    law: bool  #: the right one of both that the dwells can show
    leads: bool | None  #: the friction curve comes first in `hersey fit`; None if not asked
    directions: bool  #: rightly the same or apart
    held: dict[str, list[bool]]  #: by parameter, whether each interval holds the truth
    open: int  #: parameters that cannot be determined


def judged(setting: str, joint: Joint, path: Path, *, whole: bool) -> Judged:
    """Fit the log of a joint and compare; ``whole`` asks for the verdict of `hersey fit`, too."""
    points = hersey.Recipe(logs=str(path), tare="standing", isothermal=not joint.temperatures).points()
    curve = hersey.fit_friction(points)
    held: dict[str, list[bool]] = {}
    unknown = 0
    for each in curve.parameters:
        truth = joint.truth(each.name, each.direction)
        if each.name == "k_v" and curve.reference_temperature is not None:
            truth *= math.exp(-joint.thinning * (curve.reference_temperature - 273.15 - REFERENCE))
        if math.isnan(truth):
            continue
        unknown += not each.bounded
        held.setdefault(each.name, []).append(each.estimate.low <= truth <= each.estimate.high)
    shown = joint.forward.static is not None and "too fast" not in setting
    right = (curve.kind == "stribeck") == shown
    leads = None
    if whole:
        surface = hersey.fit(points)
        leads = leading_friction(points, surface, hersey.regime(points, surface)) is not None
    return Judged(right, leads, curve.apart == ("apart" in setting), held, unknown)


def table(results: dict[str, list[Judged]]) -> list[str]:
    """Return the table of all settings."""
    lines = [
        f"| joints | right law | directions right | first in `hersey fit` | {' | '.join(NAMES)} | all |",
        "|---|---|---|---|" + "---|" * (len(NAMES) + 1),
    ]
    counted = ("law", "directions", "leads")
    everything: list[bool] = []
    for setting, all_ in results.items():
        cells = [f"{len(all_)} {setting}"]
        for name in counted:
            asked = [one for each in all_ if (one := getattr(each, name)) is not None]
            cells.append(f"{sum(asked)} of {len(asked)}")
        own: list[bool] = []
        for name in NAMES:
            held = [one for each in all_ for one in each.held.get(name, [])]
            own += held
            cells.append(f"{100 * np.mean(held):.1f} % of {len(held)}" if held else "")
        everything += own
        lines.append("| " + " | ".join([*cells, f"{100 * np.mean(own):.1f} %"]) + " |")
    lines.append(f"\nOf all {len(everything)} intervals {100 * np.mean(everything):.1f} % hold the truth.")
    return lines


SOURCE = "RViMLab/TRO2021 (IEEE T-RO 37); published Stribeck speed of drive 1: 61 rpm.\n"
SCREWS = "friction/tro2021_screw_drives/{drive}/steady_state"


def measured(folder: Path) -> list[str]:
    """Return what is said of the screw drives."""
    lines = []
    for number in (1, 2):
        files = sorted((folder / SCREWS.format(drive=f"driveNo{number}")).glob("*.csv"))
        if not files:
            continue
        recipe = hersey.Recipe(
            logs=[str(file) for file in files], units={"torque": "9.84 mN*m / 100"}, isothermal=True
        )
        curve = hersey.fit_friction(recipe.points())
        lines += [f"**Drive {number}**, {curve.points} dwells:", "", "```text", curve.summary(), "```", ""]
    return lines


WORDS = """# Friction curves of joints

`python -m benchmarks.joints` writes this page.

## Virtual joints

A generator that shares no code with the fit makes staircases of joints in both directions: Coulomb torque
from 0.02 to 20 N·m, static friction 1.2 to 1.8 times that, nine to twelve speeds, noise, and a torque zero
that is off by 2 % and subtracted at standstill. Every other joint scatters 0.4 % from dwell to dwell.
Directions apart differ by 6 to 30 %. The last joints have a Stribeck rise below their slowest dwell, which no
dwell shows. Columns by parameter: how many of the 95 % intervals hold the truth. An interval counts whichever
law was chosen.
"""


def main() -> int:
    """Judge all joints and write the page."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--joints", type=int, default=30, help="of each setting")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=Path, default=ROOT.parent / "shared" / "data")
    given = parser.parse_args()
    results: dict[str, list[Judged]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for number, setting in enumerate(SETTINGS):
            for index in range(given.joints):
                rng = np.random.default_rng([given.seed, number, index])
                joint, path = drawn(setting, rng), Path(folder) / f"joint{number}-{index}.csv"
                written(joint, rng, path)
                results.setdefault(setting, []).append(judged(setting, joint, path, whole=index < WHOLE))
            print(setting, file=sys.stderr)
    lines = [WORDS, f"Seed {given.seed}.", "", *table(results)]
    if found := measured(given.folder):
        lines += ["\n## Screw drives measured by others\n", SOURCE, *found]
    text = "\n".join(lines).rstrip() + "\n"
    PAGE.write_text(text, encoding="utf-8")
    print(text)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
