"""The film of the user's nip, for the document."""

from __future__ import annotations

from hersey.document import FilmPart, FilmPoint
from hersey.film import REGIMES, Film, film_thickness
from hersey.film_evidence import measured_film, verdict
from hersey.film_lint import lint
from hersey.fuser import Fuser
from hersey.steady import SteadyPoints
from hersey.surface import DampingSurface


def film_part(points: SteadyPoints, surface: DampingSurface, fuser: Fuser | None) -> FilmPart | None:
    """Return what theory says of the nip; None if nip, lubricant or temperatures are not known."""
    if fuser is None or fuser.contact is None or fuser.lubricant is None or surface.b is None:
        return None
    contact, lubricant = fuser.contact, fuser.lubricant
    measured = measured_film(points, surface, contact, lubricant, grip=fuser.limits.roll_friction)
    film = measured.predicted
    if fuser.points:
        film = film_thickness(
            contact,
            lubricant,
            speed=[point.speed / contact.roll_radius for point in fuser.points],
            temperature=[point.temperature for point in fuser.points],
        )
    return FilmPart(
        verdict=verdict(measured, surface, contact, lubricant).text,
        notes=list(lint(fuser, film, measured)),
        points=film_points(film, [point.name for point in fuser.points]),
        dwells=film_points(measured.predicted, [""] * measured.speed.size),
        layer_factor=film.nip.layer_factor,
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
