"""Friction of joints that move all the time: writes docs/validation/moving.md.

Virtual joints of a generator of its own (`joints`) are read as a user's log and fitted; intervals are
compared with the truth, values with those of a staircase of the same joint, length and noise, whose dwells
are fitted here. Then two screw drives measured by others.

Usage: python -m benchmarks.moving [--joints 100] [--folder ../shared/data]
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import polars as pl
from scipy.optimize import least_squares

import hersey
from benchmarks.moving import joints, swings
from hersey.errors import HerseyError

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "validation" / "moving.md"
NAMES = ("T_C", "T_S", "w_S", "k_v", "J", "offset")
#: Greatest difference from a staircase, and least and greatest coverage that is asked for.
NEAR, LEAST, MOST = 0.03, 0.92, 0.98
WORDS = """
`python -m benchmarks.moving` writes this page. A generator that shares no code with hersey drives virtual
joints through ramps and sines: inertia, Coulomb and viscous friction, for every second joint Stribeck's
rise near standstill, a torque zero, coloured torque noise of 1 to 4 % of the Coulomb friction, and a 12-bit
encoder whose differences are the speed. Each log lasts 60 s at 200 rows per second. The least evidence for a
larger law (10 in AICc), the tolerated noise of the acceleration (1e-4) and the slowest speed used (1 % of
the greatest) were chosen while looking at joints 0 to 99; joints from 1000 on were not looked at before.
The share that friction must explain (0.8) was chosen looking at the motor dynamometer below.
"""


@dataclass(frozen=True)
class Outcome:
    """One joint: truth, fit, and the staircase beside it."""

    right_law: bool
    truth: dict[str, float]
    moving: dict[str, hersey.Estimate]
    staircase: dict[str, float]
    seconds: float
    used: float


def outcome(seed: int) -> Outcome | None:
    """Fit one joint; None if it is refused."""
    of = joints.joint(seed)
    log = hersey.read(pl.DataFrame(joints.moving(of, seed)), isothermal=True)
    started = time.process_time()
    try:
        fit = log.moving()
    except HerseyError:
        return None
    seconds = time.process_time() - started
    truth = {
        "T_C": of.coulomb, "k_v": of.viscous, "J": of.inertia, "offset": of.offset,
        **({"T_S": of.static, "w_S": of.stribeck_speed} if of.stribeck else {}),
    }  # fmt: skip
    for sign in ("+", "-"):  # the zero of the torque counts as friction of each direction
        shift = of.offset if sign == "+" else -of.offset
        truth |= {f"T_C{sign}": of.coulomb + shift, f"T_S{sign}": of.static + shift}
        truth |= {f"k_v{sign}": of.viscous, f"w_S{sign}": of.stribeck_speed}
    found = {each.name: each.estimate for each in fit.parameters if each.name != "delay"}
    right = ("Stribeck" in fit.law) == of.stribeck and "apart" not in fit.law
    return Outcome(right, truth, found, _staircase(of, seed), seconds, fit.used)


def _staircase(of: joints.Joint, seed: int) -> dict[str, float]:
    """The same law fitted to the dwells of a staircase."""
    log = hersey.read(pl.DataFrame(joints.staircase(of, seed)), isothermal=True)
    points = log.steady()
    speed, torque, error = (points.column(name) for name in ("speed", "torque", "torque_error"))

    def left(p: np.ndarray) -> np.ndarray:
        rise = (p[3] - p[0]) * np.exp(-((speed / p[4]) ** 2)) if of.stribeck else 0.0
        return (np.sign(speed) * (p[0] + rise) + p[1] * speed + p[2] - torque) / error

    start = [of.coulomb, of.viscous, 0.0, *([of.static, of.stribeck_speed] if of.stribeck else [])]
    scale = np.maximum(np.abs(start), 0.01 * of.coulomb)
    best = least_squares(lambda p: left(p * scale), np.array(start) / scale).x * scale
    return dict(zip(("T_C", "k_v", "offset", "T_S", "w_S"), best.tolist(), strict=False))


def virtual(seeds: range) -> list[str]:
    """Return the table of the joints."""
    found = [outcome(seed) for seed in seeds]
    done = [each for each in found if each is not None]
    inside: dict[str, list[bool]] = {}
    off: dict[str, list[float]] = {}
    other: dict[str, list[float]] = {}
    apart: dict[str, list[float]] = {}
    signed: dict[str, list[float]] = {}
    for each in done:
        for name, known in each.moving.items():
            bare = name.rstrip("+-")
            if name not in each.truth:
                inside.setdefault(bare, []).append(False)  # a number that the joint does not have
                continue
            true = each.truth[name]
            inside.setdefault(bare, []).append(known.low <= true <= known.high)
            scale = each.truth["T_C"] if bare == "offset" else true
            off.setdefault(bare, []).append(abs(known.value - true) / scale)
            signed.setdefault(bare, []).append((known.value - true) / scale)
            if name in each.staircase and name in each.truth:
                scale = each.truth["T_C"] if bare == "offset" else each.staircase[name]
                apart.setdefault(bare, []).append(abs(known.value - each.staircase[name]) / abs(scale))
                other.setdefault(bare, []).append(abs(each.staircase[name] - true) / abs(scale))
    lines = [
        f"Joints {seeds.start} to {seeds.stop - 1}: {len(done)} of {len(found)} fitted, the law right in "
        f"{sum(each.right_law for each in done)}; {100 * np.mean([e.used for e in done]):.0f} % of the rows "
        f"used; {np.median([e.seconds for e in done]):.1f} s of processor time each.",
        "",
        "| number | 95 % intervals that hold the truth | off the truth, median (worst) | staircase off the "
        "truth, median (worst) | within 3 % of the staircase | apart, median (worst) |",
        "|---|---|---|---|---|---|",
    ]
    for name in NAMES:
        if name not in inside:
            continue
        cells = [f"{100 * np.mean(inside[name]):.0f} % of {len(inside[name])}", _spread(off.get(name))]
        cells += [_spread(other.get(name)), _near(apart.get(name)), _spread(apart.get(name))]
        lines.append(f"| `{name}` | {' | '.join(cells)} |")
    every = [hit for hits in inside.values() for hit in hits]
    near = [gap <= NEAR for name, gaps in apart.items() if name != "offset" for gap in gaps]
    lines += [
        "",
        f"All numbers: {100 * np.mean(every):.1f} % of {len(every)} intervals hold the truth (asked for: "
        f"{100 * LEAST:.0f} to {100 * MOST:.0f} %); {100 * np.mean(near):.0f} % of {len(near)} values "
        "(without the offset) lie within 3 % of the staircase's. The offset is compared as a share of `T_C`.",
        "",
        *_split(off, other, signed),
    ]
    return lines


def _spread(shares: list[float] | None) -> str:
    if not shares:
        return ""
    return f"{100 * np.median(shares):.2f} % ({100 * max(shares):.1f} %)"


def _split(
    off: dict[str, list[float]], other: dict[str, list[float]], signed: dict[str, list[float]]
) -> list[str]:
    """How much of what lies apart is the moving log, the staircase, and bias."""
    said = []
    for name in ("T_S", "w_S", "k_v"):
        error = np.std(signed[name], ddof=1) / np.sqrt(len(signed[name]))
        said.append(
            f"`{name}`: moving {_near(off[name])}, staircase {_near(other[name])}, mean of the moving "
            f"{100 * np.mean(signed[name]):+.2f} ± {100 * error:.2f} %"
        )
    return [f"Within 3 % of the truth: {'; '.join(said)}.", ""]


def _near(gaps: list[float] | None) -> str:
    return f"{100 * np.mean(np.array(gaps) <= NEAR):.0f} %" if gaps else ""


def screw_drives(folder: Path) -> list[str]:
    """Return the table of start-stop logs beside steady ones."""
    units = {"torque": "9.84 mN*m / 100"}
    lines = [
        "## Two screw drives (RViMLab/TRO2021, IEEE T-RO 37)",
        "",
        "Start-stop logs at 50 and 200 rpm, each direction for 4 to 5 s, are fitted together as a moving "
        "log. Beside them are the dwells of the folder `steady_state`, other logs of the same drives. "
        "Torque in mN m, with one standard error; the fitted offset is added.",
        "",
        "| drive | speed, rpm | start-stop | steady state | ratio |",
        "|---|---|---|---|---|",
    ]
    for drive in (1, 2):
        of = folder / "friction" / "tro2021_screw_drives" / f"driveNo{drive}"
        log = hersey.read([of / "start_stop" / f"{n}.csv" for n in (50, 200)], units=units, isothermal=True)
        fit = log.moving()
        offset = fit["offset"].value if "offset" in fit else 0.0
        moving = fit.points().table.sort("speed")
        names = ("n200", "n50", "50", "200")
        steady = hersey.read([of / "steady_state" / f"{n}.csv" for n in names], units=units, isothermal=True)
        beside = steady.steady().table.sort("speed")
        for one, two in zip(moving.iter_rows(named=True), beside.iter_rows(named=True), strict=True):
            torque = one["torque"] + offset
            other = f"{1e3 * two['torque']:.2f} ± {1e3 * two['torque_error']:.2f}"
            lines.append(
                f"| {drive} | {one['speed'] * 30 / np.pi:.0f} | {1e3 * torque:.2f} ± "
                f"{1e3 * one['torque_error']:.2f} | {other} | {torque / two['torque']:.3f} |"
            )
    return [*lines, ""]


def refusals(folder: Path) -> list[str]:
    """Return what is said of logs that are no friction."""
    dyno = folder / "friction" / "odrive_motor_dyno" / "odrive_data.csv"
    channels = {"torque": "Output Torque", "speed": "Output Speed"}
    lines = ["## Not friction", ""]
    try:
        log = hersey.read(dyno, channels=channels, units={"torque": "N*mm", "speed": "rad/s"}, every=0.01,
                          isothermal=True)  # fmt: skip
        said = log.moving().summary()
    except HerseyError as error:
        said = str(error)
    lines.append(f"- A motor dynamometer, of which every row is a load step: {said}")
    couette = folder / "friction" / "couette_rheometer_pi" / "empty_vsweep.csv"
    try:
        said = hersey.read(couette, isothermal=True).moving().summary()
    except HerseyError as error:
        said = str(error)
    lines.append(f"- A Couette cell without a torque channel: {said}")
    return [*lines, ""]


def main() -> None:
    """Write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--joints", type=int, default=100)
    parser.add_argument("--folder", type=Path, default=ROOT.parent / "shared" / "data")
    asked = parser.parse_args()
    lines = ["# Moving logs", "", *WORDS.strip().splitlines(), "", "## Virtual joints", ""]
    for start in (0, 1000):
        lines += virtual(range(start, start + asked.joints))
    lines += swings.lines(asked.joints // 2)
    if asked.folder.is_dir():
        lines += screw_drives(asked.folder) + refusals(asked.folder)
    PAGE.write_text("\n".join(lines).rstrip() + "\n")
    print(PAGE.read_text())


if __name__ == "__main__":
    main()
