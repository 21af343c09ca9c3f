"""Figs. 10 to 12: what stiffness, damping and drive speed do to stick-slip."""

from __future__ import annotations

import math
from dataclasses import replace

import altair as alt

from hersey.arrays import FloatArray
from hersey.charts.style import WIDTH
from paper import judges
from paper.figure import ABOUT, Claim, PaperFigure, Verdict, shown
from paper.judges import FREQUENCY, SLIP_SPEED, Quantity
from paper.panels import COLORS, trace, trend_panel
from paper.sweep import DAMPING, DRIVE_SPEED, STIFFNESS, Case, Sweep, sweep_over

#: Time simulated from rest, long after the motion has settled, and time shown of that (s).
_SIMULATED, _SHOWN = 5.0, 1.2
#: Where drive speed is what varies, the value of the sweep is that speed.
_EXCESS = Quantity(
    "excess_speed", "belt speed less drive speed", "in/s", lambda sweep: sweep.slip_speed - sweep.value
)


def figure_10() -> PaperFigure:
    """Draw stick-slip against stiffness, and judge what is said of it."""
    sweep, at = sweep_over(STIFFNESS), "Fig. 10"
    claims = (
        judges.sticks_throughout(at, sweep),
        judges.rises(at, "A stiffer spring raises the stick-slip frequency.", sweep, FREQUENCY),
        judges.proportional(at, "Frequency is about proportional to stiffness.", sweep, FREQUENCY),
        judges.straight(at, "Frequency against stiffness is about a straight line.", sweep, FREQUENCY),
        judges.falls(at, "A stiffer spring lowers the speed of the slip.", sweep, SLIP_SPEED),
    )
    return _figure(10, "Effect of the spring's stiffness", sweep, claims, ("in proportion", 1.0))


def figure_11() -> PaperFigure:
    """Draw stick-slip against the damping constant B0, and judge what is said of it."""
    sweep, at = sweep_over(DAMPING), "Fig. 11"
    claims = (
        judges.sticks_throughout(at, sweep),
        judges.changes(at, "B0 affects the speed of the slip.", sweep, SLIP_SPEED),
        judges.changes(at, "B0 affects the stick-slip frequency.", sweep, FREQUENCY),
        through_a(at, sweep),
    )
    return _figure(11, "Effect of the damping constant", sweep, claims)


def figure_12() -> PaperFigure:
    """Draw stick-slip against drive speed, and judge what is said of it."""
    sweep, stiffness, at = sweep_over(DRIVE_SPEED), sweep_over(STIFFNESS), "Fig. 12"
    likewise = "Drive speed acts on frequency much as stiffness does."
    contrary = "On the speed of the slip, drive speed and stiffness act opposite ways."
    amplitude = "It also raises the amplitude read as the greatest belt speed less the drive speed."
    claims = (
        judges.sticks_throughout(at, sweep),
        judges.rises(at, "A faster drive raises the stick-slip frequency.", sweep, FREQUENCY),
        judges.similar(at, likewise, sweep, stiffness, FREQUENCY),
        judges.rises(at, "A faster drive raises the speed of the slip.", sweep, SLIP_SPEED),
        judges.rises(at, amplitude, sweep, _EXCESS),
        judges.opposite(at, contrary, sweep, stiffness, SLIP_SPEED),
    )
    exponent = FREQUENCY.trend(stiffness).exponent
    return _figure(
        12, "Effect of the drive speed", sweep, claims, (f"as with stiffness: v2^{exponent:.2f}", exponent)
    )


def through_a(source: str, both: Sweep) -> Claim:
    """Judge whether B0 acts by way of A, by moving A alone and B0 alone over the same ratio.

    A is e B0 v_s^(1+n), so the stick speed can move it with B0 kept, or keep it while B0 moves.
    """
    base = Case()
    inverse = 1.0 / (1.0 + base.drag.mixed_exponent)

    def stick_speed(ratio: float) -> float:
        return float(base.stick_speed * ratio**inverse)

    def a_alone(value: float) -> Case:
        return replace(base, stick_speed=stick_speed(value / base.damping))

    def damping_alone(value: float) -> Case:
        return replace(base, damping=value, stick_speed=stick_speed(base.damping / value))

    by_a, by_damping = sweep_over(DAMPING, a_alone), sweep_over(DAMPING, damping_alone)
    factor = {
        f"{quantity.name}_factor_{name}": quantity.trend(sweep).factor
        for quantity in (FREQUENCY, SLIP_SPEED)
        for name, sweep in (("both", both), ("a_alone", by_a), ("b0_alone", by_damping))
    }
    low, _, high = DAMPING.traced
    slow, fast = stick_speed(high / base.damping), stick_speed(low / base.damping)
    f_both, f_a, f_b0, v_both, v_a, v_b0 = factor.values()
    same_way = math.log(f_a) * math.log(f_both) > 0.0 and math.log(v_a) * math.log(v_both) > 0.0
    same_size = abs(f_a / f_both - 1.0) <= ABOUT and abs(v_a / v_both - 1.0) <= ABOUT
    return Claim(
        source,
        "B0 does so by way of A, the sticking friction.",
        "holds if A alone, moved through the stick speed with B0 kept, changes frequency and slip speed by "
        f"the same factors within {ABOUT:.0%}; in direction if the same way.",
        Verdict.of(same_way and same_size, same_way),
        f"From end to end B0 takes frequency and slip speed to {shown(f_both)} and {shown(v_both)} times, A "
        f"alone to {shown(f_a)} and {shown(v_a)} times, and B0 with A kept to {shown(f_b0)} and "
        f"{shown(v_b0)} times (v_s goes between {shown(slow)} and {shown(fast)} in/s for that).",
        factor,
    )


def _figure(
    number: int,
    title: str,
    sweep: Sweep,
    claims: tuple[Claim, ...],
    dashed: tuple[str, float] | None = None,
) -> PaperFigure:
    """Settled belt speed of three cases, and under it both trends; ``dashed`` as in `trend_panel`."""
    parameter = sweep.parameter
    cases = [parameter.case(value) for value in parameter.traced]
    cycles = [case.cycle() for case in cases]
    traces = [_settled(case) for case in cases]
    top = 1.08 * max(float(speed.max()) for _, speed in traces)
    panels = []
    for i, ((time, speed), value, cycle) in enumerate(zip(traces, parameter.traced, cycles, strict=True)):
        heading = f"{parameter.of(value)}: {shown(cycle.frequency)} Hz, up to {shown(cycle.speed_max)} in/s"
        line = trace(
            time,
            speed,
            title="Speed (in/s)",
            domain=(0.0, top),
            color=COLORS[i],
            timed=i == len(traces) - 1,
        )
        panels.append(
            line.properties(width=WIDTH, height=95, title=alt.Title(heading, fontSize=12, frame="group"))
        )
    frequencies, speeds = [c.frequency for c in cycles], [c.speed_max for c in cycles]
    pair = alt.hconcat(
        trend_panel(sweep, FREQUENCY, frequencies, title="Frequency (Hz)", dashed=dashed),
        trend_panel(sweep, SLIP_SPEED, speeds, title="Greatest belt speed (in/s)"),
        spacing=36,
    )
    subtitle = (
        "above: belt speed of the settled motion, timed from a release; below: trends on logarithmic axes"
    )
    chart = alt.vconcat(alt.vconcat(*panels, spacing=6), pair, spacing=18).properties(
        title=alt.Title(f"Fig. {number}: {title}", subtitle=subtitle, offset=14)
    )
    return PaperFigure(number, title, chart, claims, sweep.table())


def _settled(case: Case) -> tuple[FloatArray, FloatArray]:
    """Time since a late release, and belt speed."""
    run = case.run(_SIMULATED)
    latest = _SIMULATED - _SHOWN
    late = (e.time for e in run.events if e.from_mode == "stuck" and e.time <= latest)
    start = max(late, default=latest)
    inside = (run.time >= start) & (run.time <= start + _SHOWN)
    return run.time[inside] - start, run.belt_speed[inside]
