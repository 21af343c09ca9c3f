"""Fig. 9: the baseline from rest."""

from __future__ import annotations

import math
from itertools import pairwise

import altair as alt

from hersey.charts.motion import mode_strip
from hersey.charts.style import WIDTH, Chart, level
from hersey.motion.simulation import StickSlipCycle
from hersey.motion.trajectory import Trajectory
from paper.figure import ABOUT, ROUNDING, Claim, PaperFigure, Verdict, shown
from paper.panels import trace
from paper.sweep import DAMPING, DRIVE_SPEED, STIFFNESS, Case

#: The sticking friction that the paper gives for its baseline (Eq. 29), and half of its last digit.
GIVEN_A, GIVEN_A_ROUNDING = 341.4, 0.05
#: Time shown (s).
_DURATION = 2.5


def figure_9() -> PaperFigure:
    """Draw belt speed, spring force and mode of the baseline, and judge what is said of it."""
    case = Case()
    run, cycle = case.run(_DURATION), case.cycle()
    title = "The baseline, from rest"
    subtitle = (
        f"{STIFFNESS.of(case.stiffness)}, {DAMPING.of(case.damping)} at 1 in/s, "
        f"m = {case.train.mass:g} ozf·s²/in, {DRIVE_SPEED.of(case.drive_speed)}; "
        f"settles to {shown(cycle.frequency)} Hz"
    )
    panels = _speed(case, run), _force(case, run), mode_strip(run)
    chart = alt.vconcat(*panels, spacing=8).properties(
        title=alt.Title(f"Fig. 9: {title}", subtitle=subtitle, offset=14)
    )
    claims = (sticks(case, cycle), given_a(case), releases(case, run), keeps_speed(case, run))
    data = {
        "time of a change of mode (s)": tuple(event.time for event in run.events),
        "spring force there (ozf)": tuple(case.stiffness * event.stretch for event in run.events),
        "belt speed there (in/s)": tuple(event.belt_speed for event in run.events),
    }
    return PaperFigure(9, title, chart, claims, data)


def sticks(case: Case, cycle: StickSlipCycle) -> Claim:
    """Judge whether the baseline settles to stick-slip."""
    return Claim(
        "Fig. 9",
        "The baseline sticks and slips without end.",
        "holds if the motion closes to a cycle with sticking; in direction if to one without.",
        Verdict.of(cycle.kind == "stick_slip", cycle.kind == "oscillation"),
        f"From rest it settles within {cycle.laps} laps to {shown(cycle.frequency)} Hz, stuck "
        f"{cycle.stuck_fraction:.1%} of the time, and slips at up to {shown(cycle.speed_max)} in/s, "
        f"{shown(cycle.speed_max / case.drive_speed)} times the drive speed.",
        {
            "frequency": cycle.frequency,
            "speed_max": cycle.speed_max,
            "stuck_fraction": cycle.stuck_fraction,
            "laps": cycle.laps,
        },
    )


def given_a(case: Case) -> Claim:
    """Judge the value of A."""
    a = case.drag.breakaway_force
    return Claim(
        "Eq. 29",
        f"The sticking friction A of the baseline is {GIVEN_A:g} ozf.",
        f"holds if A is within {GIVEN_A_ROUNDING:g} ozf, the rounding of that number; in direction if within "
        f"{ABOUT:.0%}.",
        Verdict.of(abs(a - GIVEN_A) <= GIVEN_A_ROUNDING, abs(a / GIVEN_A - 1.0) <= ABOUT),
        f"It is {a:.6g} ozf.",
        {"a": a, "given": GIVEN_A},
    )


def releases(case: Case, run: Trajectory) -> Claim:
    """Judge the force at which the spring frees the belt, against Eq. 25 at the speed that the belt kept."""
    freed = [event for event in run.events if event.from_mode == "stuck"]
    forces = [case.stiffness * abs(event.stretch) for event in freed]
    a = case.drag.breakaway_force
    rule = [a * math.exp(-abs(event.belt_speed) / case.stick_speed) for event in freed]
    miss = max((abs(f / r - 1.0) for f, r in zip(forces, rule, strict=True)), default=math.nan)
    first, last = (forces[0], forces[-1]) if forces else (math.nan, math.nan)
    return Claim(
        "Eq. 25",
        "A stuck belt slips once the spring outdoes the sticking friction at the speed that the belt kept.",
        f"holds if every release is at A exp(-v/v_s) to {ROUNDING:g}; in direction if within {ABOUT:.0%}.",
        Verdict.of(miss <= ROUNDING, miss <= ABOUT),
        f"{len(freed)} releases differ from it by {miss:.1g} at most; the first, from rest, is at "
        f"{shown(first)} ozf or {shown(first / a)} A, the last at {shown(last)} ozf or {shown(last / a)} A.",
        {"releases": len(freed), "largest_miss": miss, "first": first, "last": last, "last_over_a": last / a},
    )


def keeps_speed(case: Case, run: Trajectory) -> Claim:
    """Judge whether speed stays the same while stuck; the first phase, from rest, has none to keep."""
    phases = [(one, two) for one, two in pairwise(run.events) if one.to_mode == "stuck"]
    change = max((abs(two.belt_speed - one.belt_speed) for one, two in phases), default=math.nan)
    kept = [one.belt_speed for one, _ in phases]
    first, last = (kept[0], kept[-1]) if kept else (math.nan, math.nan)
    small = bool(kept) and max(map(abs, kept)) <= case.stick_speed * (1.0 + ROUNDING)
    return Claim(
        "Eqs. 26-27",
        "A belt that sticks keeps a small speed until the spring frees it (microslip).",
        "holds if that speed is at most v_s and does not change while stuck; in direction if at most v_s.",
        Verdict.of(small and change <= ROUNDING * case.stick_speed, small),
        f"In {len(phases)} stuck phases it changes by {change:.1g} in/s at most; it is {shown(first)} in/s "
        f"in the first and {shown(last)} in/s in the last, against v_s = {case.stick_speed:g} in/s.",
        {"phases": len(phases), "largest_change": change, "first": first, "last": last},
    )


def _speed(case: Case, run: Trajectory) -> Chart:
    domain = (0.0, 1.06 * float(run.belt_speed.max()))
    line = trace(run.time, run.belt_speed, title="Belt speed (in/s)", domain=domain)
    marks = level(case.drive_speed, f"drive: {case.drive_speed:g} in/s")
    return alt.layer(line, *marks).properties(width=WIDTH, height=190)


def _force(case: Case, run: Trajectory) -> Chart:
    a = case.drag.breakaway_force
    low, high = float(run.spring_force.min()), float(run.spring_force.max())
    margin = 0.08 * (high - low)
    line = trace(run.time, run.spring_force, title="Spring force (ozf)", domain=(low - margin, high + margin))
    marks = [*level(a, f"A: {a:.1f} ozf"), *level(a / math.e, f"A/e: {a / math.e:.1f} ozf")]
    return alt.layer(line, *marks).properties(width=WIDTH, height=190)
