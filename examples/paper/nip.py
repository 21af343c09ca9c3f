"""Fig. 5: pressure and film in the user's own nip, solved numerically, and what the film hangs on."""

from __future__ import annotations

import math
from dataclasses import replace

import altair as alt
import numpy as np

from hersey.arrays import BoolArray
from hersey.charts.labels import apart
from hersey.charts.style import BLUE, INK, ORANGE, WIDTH, Chart, Row, plot, rows_of
from hersey.errors import ParameterError
from hersey.lubrication.contact import Contact
from hersey.lubrication.film import film_thickness
from hersey.lubrication.film_result import Film
from hersey.lubrication.reynolds import ElasticLayer, LineContactSolution, solve_line_contact
from hersey.machine.machine import Machine
from paper.cross_section import contact_of, film_at, told
from paper.drawing import HEATER, RUBBER
from paper.figure import ABOUT, Claim, PaperFigure, Verdict

#: Heights of the panels, pixels; half widths of the nip shown to either side of its axis.
_HEIGHTS, _SHOWN = (170, 240), 1.35
#: Films above the least one that are shown.
_TALL = 3.2
#: Exponents of Eq. 5 by what the film hangs on.
_EQUATION_5 = {"viscosity": 0.7, "speed": 0.7, "radius": 0.43, "load": -0.13, "modulus": 0.03}
#: Relative change over which an exponent is taken.
_CHANGE = 1e-3
#: An exponent below this is weak.
_WEAK = 0.15


def figure_5(machine: Machine) -> PaperFigure:
    """Draw pressure and film along the nip of a machine at its first operating point.

    Raises
    ------
    ParameterError
        If its file states no contact, lubricant or operating point.
    """
    contact = contact_of(machine)
    if not machine.points:
        raise ParameterError("the machine file states no [[points]] at which the film is drawn")
    point = machine.points[0]
    film = film_at(machine, point)
    solution = _solved(film)
    title = "Film and pressure in the nip"
    x = 1e3 * solution.x
    reach = _SHOWN * 1e3 * contact.nip.half_width
    seen = np.abs(x) <= reach
    axis = alt.Scale(domain=[-reach, reach], nice=False)
    pressure, gap = _pressure(solution, film, seen, axis), _gap(solution, film, seen, axis)
    tall = _TALL * 1e6 * solution.central_thickness
    exaggerated = (_HEIGHTS[1] / (1e-3 * tall)) / (WIDTH / (2.0 * reach))
    subtitle = (
        f"{told(point)}; solved for this nip, flooded, belt running to the right; the film is drawn "
        f"{float(f'{exaggerated:.2g}'):g} times too thick for its length"
    )
    chart = alt.vconcat(pressure, gap, spacing=8).properties(
        title=alt.Title(f"Fig. 5: {title}", subtitle=subtitle)
    )
    data = {
        "x (m)": tuple(solution.x.tolist()),
        "pressure (Pa)": tuple(solution.pressure.tolist()),
        "film (m)": tuple(solution.film_thickness.tolist()),
    }
    return PaperFigure(5, title, chart, (hangs_on(film), is_sheared(film)), data)


def exponents(film: Film) -> dict[str, float]:
    """Return the exponents of the central film in what it hangs on, by the law that holds."""
    contact, lubricant = film.contact, film.lubricant
    speed, kelvin = float(film.speed), float(film.temperature)
    law = film.regime_names()[0]
    span = math.log1p(_CHANGE) - math.log1p(-_CHANGE)

    def logarithm(changed_contact: Contact = contact, factor: float = 1.0) -> float:
        changed = film_thickness(changed_contact, lubricant, speed=speed * factor, temperature=kelvin)
        return float(np.log(changed.centres[law]))

    def by(name: str) -> float:
        up, down = (
            replace(contact, **{name: getattr(contact, name) * (1.0 + way * _CHANGE)}) for way in (1, -1)
        )
        return (logarithm(up) - logarithm(down)) / span

    ends = [logarithm(factor=1.0 + way * _CHANGE) for way in (1, -1)]
    by_speed = (ends[0] - ends[1]) / span
    # The roll's radius is also what makes the belt's speed of a speed of rotation.
    found = {"viscosity": by_speed, "speed": by_speed, "radius": by("roll_radius") - by_speed}
    return {
        name: float(value) for name, value in (found | {"load": by("load"), "modulus": by("modulus")}).items()
    }


def hangs_on(film: Film) -> Claim:
    """Judge whether the film hangs on what Eq. 5 says, and on load and modulus hardly."""
    found = exponents(film)
    weak = max(abs(found["load"]), abs(found["modulus"]))
    most = found["speed"] >= max(abs(found[name]) for name in ("radius", "load", "modulus"))
    listed = ", ".join(f"{name} {value:.2f} ({_EQUATION_5[name]:g})" for name, value in found.items())
    return Claim(
        "Fig. 5",
        "The film hangs mostly on viscosity and speed, and very weakly on load and modulus.",
        "holds if the exponents of viscosity and speed are the greatest, and those of load and modulus "
        f"below {_WEAK:g}; in direction if the former.",
        Verdict.of(bool(most and weak < _WEAK), bool(most)),
        f"Exponents of the film by the law that holds here, {film.regime_names()[0]} (in brackets those of "
        f"Eq. 5): {listed}.",
        found,
    )


def is_sheared(film: Film) -> Claim:
    """Judge whether plain shear, without a gradient of pressure, is the torque of the film."""
    whole, shear, rolling = (float(each) for each in (film.torque, film.shear, film.rolling))
    plain = whole / (shear / float(film.shear_factor)) - 1.0
    return Claim(
        "Eq. 6",
        "The film is sheared as between parallel plates: the gradient of pressure adds nothing.",
        f"holds if plain shear of the central film over the nip is within {ABOUT:.0%} of the film's torque; "
        "in direction if shear is over half of it.",
        Verdict.of(abs(plain) <= ABOUT, shear > 0.5 * whole),
        f"The torque is {plain:+.1%} of plain shear away from it; the gradient of pressure makes "
        f"{rolling / whole:.1%} of it.",
        {"torque": whole, "rolling_share": rolling / whole},
    )


def _solved(film: Film) -> LineContactSolution:
    contact = film.contact
    return solve_line_contact(
        contact.reduced_radius,
        contact.load_per_length,
        float(film.entrainment_speed),
        float(film.viscosity),
        effective_modulus=contact.effective_modulus,
        layer=ElasticLayer(contact.rubber_thickness, contact.poisson_ratio),
    )


def _pressure(solution: LineContactSolution, film: Film, seen: BoolArray, axis: alt.Scale) -> Chart:
    """Pressure along the nip, and its mean over the nip."""
    rows = rows_of(x=1e3 * solution.x[seen], y=1e-3 * solution.pressure[seen])
    nip, half = film.nip, 1e3 * film.nip.half_width
    mean = 1e-3 * nip.pressure_mean
    box: list[Row] = [
        {"x": x, "y": y, "order": i}
        for i, (x, y) in enumerate([(-half, 0.0), (-half, mean), (half, mean), (half, 0.0)])
    ]
    x = alt.X("x:Q", title=None, scale=axis, axis=alt.Axis(labels=False, ticks=False))
    domain = (0.0, 1.1e-3 * solution.greatest_pressure)
    scale = alt.Scale(domain=list(domain), nice=False)
    y = alt.Y("y:Q", title="Pressure (kPa)", scale=scale, axis=alt.Axis(minExtent=42))
    layers = [
        plot(box).mark_line(color=INK, strokeDash=[5, 3], strokeWidth=1.2).encode(x=x, y=y, order="order:Q"),
        plot(rows).mark_line(color=ORANGE, strokeWidth=2).encode(x=x, y=y, order="x:Q"),
        _right([(mean, f"mean {mean:.3g} kPa")], domain, _HEIGHTS[0]),
    ]
    return alt.layer(*layers, width=WIDTH, height=_HEIGHTS[0])


def _gap(solution: LineContactSolution, film: Film, seen: BoolArray, axis: alt.Scale) -> Chart:
    """The film between the heater above and the belt on its rubber below, the heater's face straight."""
    top = _TALL * 1e6 * solution.central_thickness
    rows = rows_of(x=1e3 * solution.x[seen], film=-1e6 * solution.film_thickness[seen])
    for row in rows:
        row["low"] = min(-top, row["film"])
    ends: list[Row] = [{"x": end, "high": 0.12 * top, "zero": 0.0} for end in axis.to_dict()["domain"]]
    scale = alt.Scale(domain=[-top, 0.12 * top], nice=False)
    x = alt.X("x:Q", title="Place along the belt (mm), inlet on the left", scale=axis)
    y = alt.Y("film:Q", title="Height (µm), heater at 0", scale=scale, axis=alt.Axis(minExtent=42))
    marks = [
        (-1e6 * solution.central_thickness, f"centre {1e6 * solution.central_thickness:.3g} µm"),
        (-1e6 * solution.minimum_thickness, f"least {1e6 * solution.minimum_thickness:.3g} µm"),
    ]
    if film.contact.roughness is not None:
        marks.append((-1e6 * film.contact.roughness, f"roughness {1e6 * film.contact.roughness:.3g} µm rms"))
    words = [
        {"x": 0.0, "y": -0.75 * top, "text": "belt on the rubber of the roll"},
        {"x": 0.0, "y": 0.06 * top, "text": "heater"},
        {
            "x": 0.5e3 * (solution.outlet + 1e-3 * axis.to_dict()["domain"][1]),
            "y": -0.75 * top,
            "text": "film broken",
        },
    ]
    rules = [{"film": at} for at, _ in marks]
    layers = [
        plot(rows).mark_area(color=RUBBER, clip=True).encode(x=x, y=y, y2="low:Q"),
        plot(ends).mark_area(color=HEATER).encode(x=x, y=alt.Y("high:Q", scale=scale), y2="zero:Q"),
        plot(rows).mark_line(color=BLUE, strokeWidth=2.5, clip=True).encode(x=x, y=y, order="x:Q"),
        plot(ends).mark_line(color=INK, strokeWidth=1.2).encode(x=x, y=alt.Y("zero:Q", scale=scale)),
        plot(rules).mark_rule(color=INK, strokeDash=[4, 3], strokeWidth=1).encode(y=y),
        plot(words).mark_text(color=INK, fontSize=12).encode(x=x, y=alt.Y("y:Q", scale=scale), text="text:N"),
        _right(marks, (-top, 0.12 * top), _HEIGHTS[1]),
    ]
    return alt.layer(*layers, width=WIDTH, height=_HEIGHTS[1])


def _right(marks: list[tuple[float, str]], domain: tuple[float, float], height: float) -> alt.Chart:
    """Names right of levels, none over another."""
    low, high = domain
    ups = apart([height * (value - low) / (high - low) for value, _ in marks])
    rows: list[Row] = [{"down": height - up, "text": text} for up, (_, text) in zip(ups, marks, strict=True)]
    chart: alt.Chart = (
        plot(rows)
        .mark_text(align="left", dx=6, color=INK, fontSize=12)
        .encode(x=alt.value(WIDTH), y=alt.Y("down:Q", scale=None, axis=None), text=alt.Text("text:N"))
    )
    return chart
