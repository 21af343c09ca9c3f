"""Fig. 1: the cross-section of the user's own machine, to scale, and its nip."""

from __future__ import annotations

import math

import altair as alt
import numpy as np

from hersey.charts.style import Chart
from hersey.errors import ParameterError
from hersey.lubrication.contact import RULES, Contact, nip_width
from hersey.lubrication.film import film_thickness
from hersey.lubrication.film_result import Film
from hersey.lubrication.film_temperature import film_temperature
from hersey.machine.limits import OperatingPoint
from hersey.machine.machine import Machine
from hersey.units import celsius
from paper.drawing import (
    CORE,
    FILM,
    HEATER,
    RUBBER,
    UNSTATED,
    Drawing,
    Place,
    arc,
    round_number,
)
from paper.figure import ABOUT, Claim, PaperFigure, Verdict

#: Height of the sheet of the whole machine, pixels.
_HEIGHT = 470
#: Height of that sheet over the radius of the roll.
_TALL = 4.8
#: Width of the enlarged nip, pixels; nips shown to either side of the axis; film drawn, share of the nip.
_NIP_WIDTH, _NIPS, _DRAWN = 330, 0.85, 0.05
#: Width of the heater over that of the nip, and thickness over the radius: no file states them.
_HEATER = (1.5, 0.16)


def figure_1(machine: Machine) -> PaperFigure:
    """Draw roll, belt, heater and nip of a machine to scale.

    Raises
    ------
    ParameterError
        If its file states no contact.
    """
    contact = contact_of(machine)
    title = "Cross-section of the machine"
    subtitle = "full lines: to scale, from the machine file; dashed: not stated there, drawn for orientation"
    panels = alt.hconcat(_whole(machine, contact), _enlarged(machine, contact), spacing=10)
    chart = panels.properties(title=alt.Title(f"Fig. 1: {title}", subtitle=subtitle))
    data = {f"nip_width_{rule} (m)": (float(nip_width(contact, rule=rule)),) for rule in RULES}
    return PaperFigure(1, title, chart, (has_nip(contact),), data)


def contact_of(machine: Machine) -> Contact:
    """Return the contact of a machine.

    Raises
    ------
    ParameterError
        If its file states none.
    """
    if machine.contact is None:
        raise ParameterError("the machine file states no [contact]")
    return machine.contact


def film_at(machine: Machine, point: OperatingPoint) -> Film:
    """Return the film of a machine at an operating point.

    Raises
    ------
    ParameterError
        If its file states no lubricant.
    """
    contact = contact_of(machine)
    if machine.lubricant is None:
        raise ParameterError("the machine file states no [lubricant]")
    speed = point.speed / contact.roll_radius
    inside = film_temperature(contact, machine.lubricant, speed=speed, temperature=point.temperature)
    return film_thickness(contact, machine.lubricant, speed=speed, temperature=inside)


def told(point: OperatingPoint) -> str:
    """Return an operating point in words."""
    return f"{point.name}: {1e3 * point.speed:.3g} mm/s, {celsius(point.temperature):.0f} °C"


def has_nip(contact: Contact) -> Claim:
    """Judge whether Eq. 8 gives the width of the nip."""
    layer, paper = float(nip_width(contact)), float(nip_width(contact, rule="paper"))
    ratio = paper / layer
    return Claim(
        "Fig. 1",
        "Eq. 8 gives the width of the nip.",
        f"holds if it is within {ABOUT:.0%} of that of a rigid heater on the bonded rubber, solved "
        "numerically; in direction if within a factor 2.",
        Verdict.of(abs(ratio - 1.0) <= ABOUT, 0.5 <= ratio <= 2.0),
        f"Eq. 8 has {1e3 * paper:.2f} mm, the layer {1e3 * layer:.2f} mm; Eq. 8 is "
        f"{'inside' if contact.nip.paper_in_range else 'outside'} its range here.",
        {"nip_width_paper": paper, "nip_width_layer": layer},
    )


def _whole(machine: Machine, contact: Contact) -> Chart:
    """The roll under heater and belt, millimetres, the heater's face at 0."""
    radius, rubber, half = (
        1e3 * each for each in (contact.roll_radius, contact.rubber_thickness, contact.nip.half_width)
    )
    loop = radius  # the belt's own radius is not stated
    low = -2.45 * radius
    top = low + _TALL * radius
    across = (-1.95 * radius, 1.95 * radius)
    sheet = Drawing(across, (low, top), _HEIGHT / (_TALL * radius))
    centre = _roll(sheet, contact)
    sheet.line(arc((0.0, loop), loop, -math.pi / 2, 1.5 * math.pi), stroke=UNSTATED, strokeDash=[5, 3])
    wide, thick = _HEATER[0] * half, _HEATER[1] * radius
    box = [(-wide, 0.05), (wide, 0.05), (wide, thick), (-wide, thick)]
    sheet.outline(box, HEATER, stroke=UNSTATED, strokeDash=[5, 3])
    sheet.text((0.0, 0.9 * loop), ["belt (its radius", "is not stated)"], align="center", color=UNSTATED)
    sheet.text((0.0, thick + 0.1 * radius), "heater", align="center", baseline="bottom")
    sheet.text((0.0, centre[1] - 0.35 * radius), "core", align="center")
    # Dimensions: radius to the right, rubber to the left, load from above, length below.
    rim = (centre[0] + radius * math.cos(-0.6), centre[1] + radius * math.sin(-0.6))
    sheet.arrow(centre, rim)
    sheet.text((rim[0] + 0.06 * radius, rim[1]), f"R = {radius:.3g} mm")
    inner, outer = (
        (centre[0] + r * math.cos(3.75), centre[1] + r * math.sin(3.75)) for r in (radius - rubber, radius)
    )
    sheet.arrow(inner, outer, both=True)
    beside = (outer[0] - 0.06 * radius, outer[1] - 0.05 * radius)
    sheet.text(beside, [f"h = {rubber:.3g} mm", "rubber"], align="right")
    sheet.arrow((-1.45 * radius, 0.75 * radius), (-1.45 * radius, 0.15 * radius))
    sheet.text(
        (-1.45 * radius, 0.85 * radius), f"N = {contact.load:.4g} N", align="center", baseline="bottom"
    )
    turn = arc(centre, 1.12 * radius, -0.75, -1.2, 20)  # as the belt goes: clockwise
    sheet.line(turn)
    sheet.arrow(turn[-2], turn[-1])
    bar = round_number(0.8 * radius)
    left = across[0] + 0.08 * radius
    sheet.line([(left, low + 0.2 * radius), (left + bar, low + 0.2 * radius)], strokeWidth=3)
    sheet.text(
        (left + bar + 0.1 * radius, low + 0.2 * radius),
        f"{bar:g} mm; the nip is {1e3 * contact.length:.4g} mm long, into the page",
    )
    if machine.points:
        sheet.text(
            (1.1 * radius, 0.35 * radius), f"{1e3 * machine.points[0].speed:.3g} mm/s", baseline="bottom"
        )
        sheet.arrow((1.05 * radius, 0.2 * radius), (1.75 * radius, 0.2 * radius))
    return sheet.chart(title=_named("the whole"))


def _roll(sheet: Drawing, contact: Contact) -> Place:
    """Draw roll and core, the roll pressed flat over the nip; return its centre, mm."""
    radius, rubber = 1e3 * contact.roll_radius, 1e3 * contact.rubber_thickness
    half = min(1e3 * contact.nip.half_width, 0.99 * radius)
    edge = _face(contact, half)
    centre = (0.0, edge - math.sqrt(radius**2 - half**2))
    start = math.asin(math.sqrt(1.0 - (half / radius) ** 2))
    rim = arc(centre, radius, math.pi - start, 2.0 * math.pi + start, 361)
    nip = [(float(x), _face(contact, float(x))) for x in np.linspace(half, -half, 41)]
    sheet.outline([*rim, *nip], RUBBER)
    core = radius - rubber
    if core > 0.0:
        sheet.outline(arc(centre, core, 0.0, 2.0 * math.pi, 181), CORE)
    sheet.line([(centre[0] - 0.05 * radius, centre[1]), (centre[0] + 0.05 * radius, centre[1])])
    sheet.line([(centre[0], centre[1] - 0.05 * radius), (centre[0], centre[1] + 0.05 * radius)])
    return centre


def _face(contact: Contact, x: float) -> float:
    """Height of the heater's face, mm, 0 on the axis: flat, or a parabola of its radius."""
    return x * x / (2e3 * contact.heater_radius)


def _enlarged(machine: Machine, contact: Contact) -> Chart:
    """The nip, with its film as thick as can be seen."""
    radius, width = 1e3 * contact.roll_radius, 1e3 * contact.nip.width
    half = 0.5 * width
    pixels = _NIP_WIDTH / (2.0 * _NIPS * width)
    top = _HEIGHT / (2.0 * pixels)
    across = (-_NIPS * width, _NIPS * width)
    sheet = Drawing(across, (-top, top), pixels)
    centre = _roll(sheet, contact)
    thick, lines = _DRAWN * width, ["The film (blue) is too thin to be seen:", "drawn so that it can be."]
    if machine.points and machine.lubricant is not None:
        film = film_at(machine, machine.points[0])
        central = 1e3 * float(film.central * film.factor)
        factor = round_number(thick / central)
        thick = factor * central
        lines = [f"film of {1e3 * central:.3g} µm, drawn {factor:g} times as thick", told(machine.points[0])]
    edge = [(x, _face(contact, x)) for x in np.linspace(-1.4 * half, 1.4 * half, 41).tolist()]
    over = [(x, y + thick) for x, y in reversed(edge)]
    # The belt runs along the roll and the film fills the gap to the heater.
    sheet.outline([*edge, *over], FILM, stroke=None)
    upper = [(x, y + thick) for x, y in edge]
    sheet.outline(
        [*upper, (1.4 * half, 0.55 * top), (-1.4 * half, 0.55 * top)],
        HEATER,
        stroke=UNSTATED,
        strokeDash=[5, 3],
    )
    sheet.line(edge, strokeWidth=3)
    level = -0.16 * top
    for x in (-half, half):
        sheet.line([(x, _face(contact, half)), (x, 1.25 * level)], strokeWidth=0.8)
    sheet.arrow((-half, level), (half, level), both=True)
    sheet.text((0.0, 1.2 * level), f"nip {width:.3g} mm", align="center", baseline="top", rim=True)
    pressure = f"mean pressure {1e-3 * contact.nip.pressure_mean:.3g} kPa"
    sheet.text((0.0, 1.2 * level - 16 / pixels), pressure, align="center", baseline="top", rim=True)
    beside, middle = -0.6 * width, radius - 0.5e3 * contact.rubber_thickness
    if abs(beside) < middle:
        height = centre[1] + math.sqrt(middle**2 - beside**2)
        sheet.text((beside, height), "rubber", align="center", rim=True)
    sheet.text((0.0, 0.45 * top), "heater, at rest", align="center")
    sheet.arrow((-0.45 * half, -0.05 * top), (0.45 * half, -0.05 * top))
    sheet.text((0.5 * half, -0.055 * top), "belt", rim=True)
    sheet.text((0.0, 0.93 * top), lines, align="center", baseline="top")
    large = pixels * _TALL * radius / _HEIGHT
    return sheet.chart(title=_named(f"the nip, {large:.2g} times as large"))


def _named(text: str) -> alt.Title:
    return alt.Title(text, fontSize=12, fontWeight="normal")
