"""Fig. 6: the user's own drive as mass, spring and drag, and the forces in it to scale."""

from __future__ import annotations

import math
import warnings

import altair as alt
import numpy as np

from hersey.charts.style import INK, WIDTH, Chart, Row, plot
from hersey.machine.machine import Machine
from paper.drawing import CORE, HEATER, Drawing
from paper.figure import Claim, PaperFigure, Verdict
from paper.measured import Measured

#: Size of the diagram, pixels, and height of a bar.
_ACROSS, _UP, _BAR = WIDTH, 170, 24


def figure_6(machine: Machine, measured: Measured | None = None) -> PaperFigure:
    """Draw mass, spring, drag and grip of a machine with their values, and the forces to scale."""
    forces = forces_of(machine, measured)
    title = "Mass, spring and drag"
    panels: list[Chart] = [_diagram(machine)]
    subtitle = "diagram with the numbers of the machine file"
    if forces:
        panels.append(_bars(machine, forces))
        subtitle += "; below: forces at the belt to scale, and how far each stretches the spring"
    chart = alt.vconcat(*panels, spacing=8).properties(title=alt.Title(f"Fig. 6: {title}", subtitle=subtitle))
    claims = () if measured is None or machine.limits.grip is None else (holds_on(machine, measured),)
    data = {f"{name} (N)": (force,) for name, force in forces}
    return PaperFigure(6, title, chart, claims, data)


def forces_of(machine: Machine, measured: Measured | None) -> list[tuple[str, float]]:
    """Return forces at the belt by name, N: drag of the log, breakaway, and what the drive can bear."""
    limits, radius = machine.limits, machine.roll_radius
    found: list[tuple[str, float]] = []
    if measured is not None:
        drag = measured.torque / radius
        found += [
            ("least drag of the log", float(drag.min())),
            ("greatest drag of the log", float(drag.max())),
        ]
        if (breakaway := _breakaway(machine, measured)) is not None:
            found.append(("to break a stuck belt away", breakaway))
    if limits.grip is not None:
        found.append(("grip of the roll, µ N", limits.grip))
    if limits.motor_torque is not None:
        left = motor_left(machine)
        found.append(("motor" if machine.rest is None else "motor, less the no-load torque", left / radius))
    if limits.spring_force is not None:
        found.append(("spring at most", limits.spring_force))
    return found


def motor_left(machine: Machine) -> float:
    """Return the torque of the motor that the no-load torque leaves, N m, at the first operating point."""
    assert machine.limits.motor_torque is not None
    if machine.rest is None or not machine.points:
        return machine.limits.motor_torque
    point = machine.points[0]
    taken = machine.rest.torque(point.speed / machine.roll_radius, temperature=point.temperature)
    return max(machine.limits.motor_torque - float(taken), 0.0)


def holds_on(machine: Machine, measured: Measured) -> Claim:
    """Judge whether the belt never slides on the roll, so that one degree of freedom is enough."""
    grip = machine.limits.grip
    assert grip is not None
    drag = float(measured.torque.max()) / machine.roll_radius
    breakaway = _breakaway(machine, measured)
    most = drag if breakaway is None else max(drag, breakaway)
    stuck = "" if breakaway is None else f" A stuck belt breaks away at {breakaway:.4g} N (Eq. 29, hottest)."
    return Claim(
        "Fig. 6",
        "One degree of freedom is enough: belt and roll do not slide on each other.",
        "holds if the grip of the roll exceeds every drag of the log and, where torque falls with speed, "
        "what breaks a stuck belt away; in direction if the former.",
        Verdict.of(most < grip, drag < grip),
        f"The drag of the log is at most {drag:.4g} N, the grip {grip:.4g} N.{stuck}",
        {"greatest_drag": drag, "grip": grip, "breakaway": math.nan if breakaway is None else breakaway},
    )


def _breakaway(machine: Machine, measured: Measured) -> float | None:
    """Sticking friction A of Eq. 29 at the hottest dwells, N; None where torque does not fall with speed."""
    if measured.surface.transition is None:
        return None
    kelvin = measured.groups[-1][0]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return float(measured.surface.drag(temperature=kelvin, **machine.belt).breakaway_force)


def _diagram(machine: Machine) -> Chart:
    """Drive, spring, mass, drag against the ground, and grip, left to right; pixels."""
    sheet = Drawing((0.0, _ACROSS), (0.0, _UP), 1.0)
    middle = 95.0
    sheet.line([(150.0, 22.0), (640.0, 22.0)], strokeWidth=1.5)
    for x in range(150, 640, 14):
        sheet.line([(x, 22.0), (x - 7.0, 14.0)], strokeWidth=0.8)
    sheet.outline([(40, middle - 34), (64, middle - 34), (64, middle + 34), (40, middle + 34)], HEATER)
    sheet.arrow((40.0, middle + 52), (92.0, middle + 52))
    speed = (
        f"v2 = {1e3 * machine.points[0].speed:.4g} mm/s ({machine.points[0].name})"
        if machine.points
        else "v2"
    )
    sheet.text((98.0, middle + 52), f"drive: {speed}")
    turns = [(130.0 + 8.0 * i, middle + (13.0 if i % 2 else -13.0)) for i in range(16)]
    sheet.line([(64.0, middle), (120.0, middle), *turns, (262.0, middle), (330.0, middle)])
    sheet.text((190.0, middle - 30), f"k = {1e-3 * machine.stiffness:.4g} N/mm", align="center")
    sheet.outline([(330, 40), (430, 40), (430, 142), (330, 142)], CORE)
    sheet.text(
        (380.0, middle + 8), ["belt and what", "moves with it", f"m = {machine.mass:.4g} kg"], align="center"
    )
    for x in (346, 414):
        sheet.outline(
            [(x + 9 * math.cos(a), 31 + 9 * math.sin(a)) for a in np.linspace(0, 6.28, 30)], "white"
        )
    sheet.arrow((380.0, 152.0), (432.0, 152.0))
    sheet.text((438.0, 152.0), "x1, v1")
    # A dashpot to the ground on the right.
    sheet.line([(430.0, middle), (478.0, middle)])
    sheet.line([(478.0, middle - 15), (478.0, middle + 15)], strokeWidth=3)
    sheet.line([(462.0, middle + 20), (512.0, middle + 20), (512.0, middle - 20), (462.0, middle - 20)])
    sheet.line([(512.0, middle), (560.0, middle), (560.0, 22.0)])
    stick = f"stick speed {1e3 * machine.stick_speed:.3g} mm/s"
    sheet.text((487.0, middle - 34), "drag B(v1, T) v1", align="center")
    sheet.text((568.0, middle + 7), stick)
    frequency = math.sqrt(machine.stiffness / machine.mass) / (2.0 * math.pi)
    sheet.text((8.0, 42.0), [f"free: {frequency:.3g} Hz", f"R = {1e3 * machine.roll_radius:.4g} mm"])
    if machine.limits.grip is not None:
        text = f"grip µ N = {machine.limits.roll_friction:g} x {machine.limits.nip_load:.4g} N"
        sheet.text((190.0, middle - 48), text, align="center")
    return sheet.chart()


def _bars(machine: Machine, forces: list[tuple[str, float]]) -> Chart:
    """Forces as bars of one scale, each with its value and the stretch of the spring."""
    rows: list[Row] = [
        {
            "name": name,
            "force": force,
            "order": i,
            "bears": i >= len(forces) - _limits(machine),
            "text": f"{force:.3g} N, {1e3 * force / machine.stiffness:.3g} mm",
        }
        for i, (name, force) in enumerate(forces)
    ]
    top = 1.25 * max(force for _, force in forces)
    y = alt.Y("name:N", title=None, sort=[name for name, _ in forces], axis=alt.Axis(labelLimit=240))
    x = alt.X("force:Q", title="Force at the belt (N)", scale=alt.Scale(domain=[0.0, top], nice=False))
    color = alt.Color(
        "bears:N", scale=alt.Scale(domain=[False, True], range=["#5b7fb5", "#c9cdd3"]), legend=None
    )
    bars = plot(rows).mark_bar(stroke=INK, strokeWidth=0.8).encode(x=x, y=y, color=color)
    texts = plot(rows).mark_text(align="left", dx=5, color=INK, fontSize=12).encode(x=x, y=y, text="text:N")
    return alt.layer(bars, texts, width=WIDTH - 190, height=_BAR * len(forces))


def _limits(machine: Machine) -> int:
    """How many of the forces are what the machine can bear."""
    limits = machine.limits
    return sum(each is not None for each in (limits.grip, limits.motor_torque, limits.spring_force))
