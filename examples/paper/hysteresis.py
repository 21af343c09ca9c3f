"""Figs. 13 and 14: at one drive speed the past decides whether the belt sticks."""

from __future__ import annotations

import math
from collections.abc import Callable

import altair as alt
import numpy as np

from hersey.charts.style import WIDTH, Chart
from hersey.motion.schedule import Schedule
from hersey.motion.simulation import StickSlipCycle, simulate, stick_slip
from hersey.motion.trajectory import Trajectory
from hersey.stability.hysteresis import HysteresisBand, hysteresis
from hersey.stability.hysteresis_sweep import hysteresis_sweep
from paper.figure import Claim, PaperFigure, Verdict, shown
from paper.panels import driven
from paper.sweep import Case

#: Drive speeds that the paper names (in/s): approached from below, overshoot, approached from above.
BELOW, OVERSHOOT, ABOVE = 1.9, 2.5, 1.0
#: How drive speed changes, which the paper does not say: at this rate (in/s2), after so long (s).
GENTLE, HELD = 1.0, 2.0
#: An overshoot that stays below V* (in/s).
TOO_LITTLE = 2.0
#: Drive speeds tried from below and from above (in/s).
_TRIED = tuple(round(0.1 * i, 1) for i in range(10, 22))
#: Stick speeds between which the fold passes both of the paper's speeds (in/s).
_STICK_SPEEDS = np.geomspace(0.002, 0.05, 41)
#: Samples of a trace per second: three long traces to a figure make it slow to draw.
_RATE = 500
#: Time shown in each figure (s).
_SHOWN_BELOW, _SHOWN_ABOVE = 4.0, 6.0


def figure_13() -> PaperFigure:
    """Draw the approach to 1.9 v_t from below, and judge what is said of it."""
    case = Case(drive_speed=BELOW)
    rise, fall = change(ABOVE, BELOW), change(OVERSHOOT, BELOW)
    pasts = (
        ("from rest", Schedule.of(BELOW), "rest"),
        (f"up from {ABOVE:g} in/s at {GENTLE:g} in/s²", rise, "rest"),
        (f"down from steady sliding at {OVERSHOOT:g} in/s", fall, "steady"),
    )
    runs = [follow(case, drive, _SHOWN_BELOW, start) for _, drive, start in pasts]
    cycles = [settled(case, drive, start) for _, drive, start in pasts]
    headings = [f"{past}: {outcome(cycle)}" for (past, _, _), cycle in zip(pasts, cycles, strict=True)]
    band = hysteresis(case.train, case.drag)
    claims = (
        sticks_from_below(case, band, cycles[:2]),
        past_decides(band, cycles),
    )
    title = "Hysteresis: from below, stick-slip well above the transition"
    subtitle = f"drive at {BELOW:g} v_t in the end, v_t = 1 in/s; solid: belt speed, dashed: drive speed"
    drives = [drive for _, drive, _ in pasts]
    chart = _stack(13, title, subtitle, runs, drives, headings)
    return PaperFigure(13, title, chart, claims, _data(runs, drives))


def figure_14() -> PaperFigure:
    """Draw the approach to v_t from above, and judge what is said of it."""
    case = Case(drive_speed=ABOVE)
    pasts = (
        (f"over {OVERSHOOT:g} in/s, down at {GENTLE:g} in/s²", change(OVERSHOOT, ABOVE)),
        (f"over {OVERSHOOT:g} in/s, down in one step", change(OVERSHOOT, ABOVE, math.inf)),
        (f"over {TOO_LITTLE:g} in/s only, down at {GENTLE:g} in/s²", change(TOO_LITTLE, ABOVE)),
    )
    drives = [drive for _, drive in pasts]
    runs = [follow(case, drive, _SHOWN_ABOVE) for drive in drives]
    cycles = [settled(case, drive) for drive in drives]
    headings = [f"{past}: {outcome(cycle)}" for (past, _), cycle in zip(pasts, cycles, strict=True)]
    band = hysteresis(case.train, case.drag)
    claims = (slides_from_above(case, band, cycles), overshoot_helps(case, band))
    title = "Hysteresis: from above, no stick-slip at the transition"
    subtitle = f"from rest; drive at v_t = {ABOVE:g} in/s in the end; solid: belt speed, dashed: drive speed"
    chart = _stack(14, title, subtitle, runs, drives, headings)
    return PaperFigure(14, title, chart, claims, _data(runs, drives))


def change(first: float, last: float, rate: float = GENTLE) -> Schedule:
    """Return a drive speed held for a while, then changed at a rate (in/s2), in one step if infinite."""
    return Schedule([0.0, HELD, HELD + abs(last - first) / rate], [first, first, last])


def follow(case: Case, drive: Schedule, duration: float, start: str = "rest") -> Trajectory:
    """Return the motion under a changing drive speed."""
    samples = round(duration * _RATE) + 1
    return simulate(case.train, case.drag, drive_speed=drive, duration=duration, samples=samples, start=start)


def settled(case: Case, drive: Schedule, start: str = "rest") -> StickSlipCycle:
    """Return what the motion settles to once the drive speed has come to its end."""
    end = float(np.asarray(drive.times)[-1])
    state: str | tuple[float, float] = start
    if end > 0.0:
        run = simulate(case.train, case.drag, drive_speed=drive, duration=end, samples=2, start=start)
        state = float(run.belt_speed[-1]), float(run.stretch[-1])
    last = float(np.asarray(drive.values)[-1])
    return stick_slip(case.train, case.drag, drive_speed=last, start=state)


def outcome(cycle: StickSlipCycle) -> str:
    """Tell in a few words what a motion settles to."""
    if cycle.kind == "stick_slip":
        return f"sticks and slips at {shown(cycle.frequency)} Hz"
    return "slides" if cycle.kind == "steady_sliding" else cycle.kind.replace("_", " ")


def sticks_from_below(case: Case, band: HysteresisBand, from_below: list[StickSlipCycle]) -> Claim:
    """Judge whether stick-slip lasts at 1.9 v_t, from rest and after a rise."""
    rest = from_below[0]
    sticking = [cycle.kind == "stick_slip" for cycle in from_below]
    limit = stick_speed_for(case, BELOW)
    return Claim(
        "Fig. 13",
        f"A drive at {BELOW:g} v_t, reached from below, keeps the belt sticking and slipping for good.",
        f"holds if the belt settles to stick-slip both from rest and up from {ABOVE:g} in/s at {GENTLE:g} "
        "in/s²; in direction if on one of the two ways.",
        Verdict.of(all(sticking), any(sticking)),
        f"It does so on {sum(sticking)} of {len(sticking)} ways: {shown(rest.frequency)} Hz from rest, stuck "
        f"{rest.stuck_fraction:.1%} of the time, up to {shown(rest.speed_max)} in/s. Stick-slip lasts up to "
        f"V* = {band.upper:.7g} in/s, and V* is above {BELOW:g} in/s for every stick speed below "
        f"{shown(limit)} in/s.",
        {
            "frequency": rest.frequency,
            "speed_max": rest.speed_max,
            "stuck_fraction": rest.stuck_fraction,
            "ways_that_stick": sum(sticking),
            "fold_speed": band.upper,
            "greatest_stick_speed": limit,
        },
    )


def past_decides(band: HysteresisBand, cycles: list[StickSlipCycle]) -> Claim:
    """Judge whether both motions last at one drive speed."""
    below, above = cycles[0].kind == "stick_slip", cycles[-1].kind == "steady_sliding"
    inside = band.transition < BELOW < band.upper
    share = band.sensitivity["stick_speed"]
    return Claim(
        "Figs. 13-14",
        "The model has hysteresis: at one drive speed the past decides whether the belt sticks.",
        f"holds if at {BELOW:g} in/s the belt sticks from rest and slides down from {OVERSHOOT:g} in/s, and "
        "that speed is between v_t and V*; in direction if V* is above v_t.",
        Verdict.of(below and above and inside, band.bistable),
        f"From {band.transition:g} to {band.upper:.7g} in/s both last. Below {band.lower:.6g} in/s all "
        "ends in stick-slip; from there to v_t a small oscillation lasts without sticking. One per cent more "
        f"stick speed, which nobody measures, moves V* by {share:.2f} %.",
        {
            "lower": band.lower,
            "transition": band.transition,
            "fold_speed": band.upper,
            "fold_accuracy": band.upper_accuracy,
            "fold_change_per_stick_speed": share,
        },
    )


def slides_from_above(case: Case, band: HysteresisBand, cycles: list[StickSlipCycle]) -> Claim:
    """Judge whether v_t is reached without stick-slip after an overshoot, and how fast one may come down."""
    gentle, step, _ = (cycle.kind != "stick_slip" for cycle in cycles)
    steepest = steepest_safe(case)
    limit = stick_speed_for(case, OVERSHOOT)
    jump = "as does one step" if step else "but one step does not"
    return Claim(
        "Fig. 14",
        f"After an overshoot to {OVERSHOOT:g} v_t the drive comes down to v_t without stick-slip.",
        f"holds if the belt, {HELD:g} s at {OVERSHOOT:g} in/s from rest and then slowed at {GENTLE:g} in/s², "
        "settles without sticking; in direction if only when slowed ten times more gently.",
        Verdict.of(gentle, sliding(case, GENTLE / 10.0)),
        f"Slowing at up to {shown(steepest)} in/s² does it, {jump}. The overshoot has to pass V*, which is "
        f"{band.upper:.7g} in/s here; {OVERSHOOT:g} in/s passes it for v_s above {shown(limit)} in/s.",
        {
            "steepest_rate": steepest,
            "one_step_slides": float(step),
            "fold_speed": band.upper,
            "least_stick_speed": limit,
        },
    )


def overshoot_helps(case: Case, band: HysteresisBand) -> Claim:
    """Judge whether an overshoot keeps the belt from sticking where a direct approach does not."""

    def helped(top: float) -> int:
        direct = [settled(case, Schedule.of(speed)).kind for speed in _TRIED]
        over = [settled(case, change(top, speed)).kind for speed in _TRIED]
        pairs = zip(direct, over, strict=True)
        return sum(one == "stick_slip" and other != "stick_slip" for one, other in pairs)

    enough, too_little = helped(OVERSHOOT), helped(TOO_LITTLE)
    return Claim(
        "Figs. 13-14",
        "Near the transition it pays to overshoot and come down from above.",
        f"holds if at every 0.1 in/s from {_TRIED[0]:g} to {_TRIED[-1]:g} in/s a belt driven there from rest "
        f"sticks, and one brought there over {OVERSHOOT:g} in/s does not; in direction if at some.",
        Verdict.of(enough == len(_TRIED), enough > 0),
        f"It pays at {enough} of {len(_TRIED)} speeds. An overshoot to {TOO_LITTLE:g} in/s, short of V* = "
        f"{band.upper:.4g} in/s, pays at {too_little}.",
        {"tried": len(_TRIED), "helped": enough, "helped_by_too_little": too_little},
    )


def sliding(case: Case, rate: float) -> bool:
    """Whether the belt comes down from the overshoot without sticking in the end."""
    return settled(case, change(OVERSHOOT, ABOVE, rate)).kind != "stick_slip"


def steepest_safe(case: Case) -> float:
    """Greatest rate (in/s2) at which the drive may come down from the overshoot; nan if none is safe."""
    low, high = 0.1 * GENTLE, 1000.0 * GENTLE
    if not sliding(case, low):
        return math.nan
    return _edge(lambda rate: sliding(case, rate), low, high)


def stick_speed_for(case: Case, fold: float) -> float:
    """Stick speed (in/s) whose V* is the given speed (in/s); nan if outside those looked at."""
    folds = hysteresis_sweep(case.train, case.drag, stick_speed=_STICK_SPEEDS).upper.values
    falling = np.log(folds)[::-1]
    return math.exp(
        float(np.interp(math.log(fold), falling, np.log(_STICK_SPEEDS)[::-1], left=math.nan, right=math.nan))
    )


def _edge(inside: Callable[[float], bool], low: float, high: float) -> float:
    """Where a condition that holds at ``low`` ceases to, to four digits."""
    while high > low * (1.0 + 1e-5):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if inside(middle) else (low, middle)
    return low


def _stack(
    number: int,
    title: str,
    subtitle: str,
    runs: list[Trajectory],
    drives: list[Schedule],
    headings: list[str],
) -> Chart:
    """Belt speed of each run, one above the other."""
    top = 1.08 * max(float(run.belt_speed.max()) for run in runs)
    panels = []
    for i, (run, drive, heading) in enumerate(zip(runs, drives, headings, strict=True)):
        panel = driven(run, drive, domain=(0.0, top), timed=i == len(runs) - 1)
        panels.append(
            panel.properties(width=WIDTH, height=120, title=alt.Title(heading, fontSize=12, frame="group"))
        )
    return alt.vconcat(*panels, spacing=8).properties(
        title=alt.Title(f"Fig. {number}: {title}", subtitle=subtitle, offset=14)
    )


def _data(runs: list[Trajectory], drives: list[Schedule]) -> dict[str, tuple[float, ...]]:
    """Every fifth sample, a hundred to the second."""
    data = {"time (s)": tuple(runs[0].time[::5].tolist())}
    for i, (run, drive) in enumerate(zip(runs, drives, strict=True), 1):
        data[f"drive speed, panel {i} (in/s)"] = tuple(drive.at(float(t)) for t in run.time[::5])
        data[f"belt speed, panel {i} (in/s)"] = tuple(run.belt_speed[::5].tolist())
    return data
