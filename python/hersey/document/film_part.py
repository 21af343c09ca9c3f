"""The film of the user's nip, for the document."""

from __future__ import annotations

from collections.abc import Sequence

from hersey.damping.dwells import SteadyPoints
from hersey.damping.surface import DampingSurface
from hersey.document.parts import FilmPart, FilmPoint
from hersey.lubrication.film import REGIMES, Film, film_thickness
from hersey.lubrication.film_temperature import film_temperature
from hersey.machine.machine import Machine
from hersey.verdict.checks import check_film
from hersey.verdict.evidence import MeasuredFilm, Verdict, measured_film, verdict
from hersey.verdict.regime import Regime


def film_part(
    points: SteadyPoints, surface: DampingSurface, machine: Machine | None, seen: Regime
) -> FilmPart | None:
    """Return what theory says of the nip, beside what the log alone says (``seen``).

    None if nip, lubricant or temperatures are not known.
    """
    if machine is None or machine.contact is None or machine.lubricant is None or surface.b is None:
        return None
    contact, lubricant = machine.contact, machine.lubricant
    measured = measured_film(points, surface, contact, lubricant, grip=machine.limits.roll_friction)
    film = measured.predicted
    if machine.points:
        speed = [point.speed / contact.roll_radius for point in machine.points]
        read = [point.temperature for point in machine.points]
        inside = film_temperature(contact, lubricant, speed=speed, temperature=read)
        film = film_thickness(contact, lubricant, speed=speed, temperature=inside)
    return film_document(
        film,
        [point.name for point in machine.points],
        measured,
        verdict(measured, surface, contact, lubricant, seen),
        check_film(machine, film, measured),
    )


def film_document(
    film: Film,
    names: list[str],
    measured: MeasuredFilm | None = None,
    says: Verdict | None = None,
    notes: Sequence[str] = (),
) -> FilmPart:
    """Return a film at named points, and what a log says of it if there is one."""
    document = film.to_dict()
    document["film"]["names"] = names
    return FilmPart.model_validate(
        document
        | {
            "measured": None if measured is None else measured.to_dict(),
            "exponents": None if says is None else says.to_dict(),
            "verdict": "" if says is None else says.text,
            "notes": list(notes),
            "points": film_points(film, names),
            "dwells": [] if measured is None else film_points(measured.predicted, [""] * measured.speed.size),
        }
    )


def film_points(film: Film, names: list[str]) -> list[FilmPoint]:
    """Return the states of a film on the regime chart; names of shape (points,)."""
    return [
        FilmPoint(
            name=name,
            viscosity_parameter=float(film.g_v.ravel()[i]),
            elasticity_parameter=float(film.g_e.ravel()[i]),
            regime=REGIMES[int(film.regime.ravel()[i])],
            minimum_thickness=float(film.minimum.ravel()[i]),
        )
        for i, name in enumerate(names)
    ]
