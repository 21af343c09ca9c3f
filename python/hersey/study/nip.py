"""The film of the machine's nip, and what the log says of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hersey.damping.dwells import SteadyPoints, groups_of_temperature
from hersey.damping.surface import DampingSurface
from hersey.lubrication.film import film_thickness
from hersey.lubrication.film_result import REGIMES, Film
from hersey.lubrication.film_temperature import film_temperature
from hersey.lubrication.mixed import MixedFilm
from hersey.machine.machine import Machine
from hersey.schema.warning import Warning
from hersey.study.nip_film import FilmPart, FilmPoint
from hersey.verdict.checks import nip_warnings
from hersey.verdict.contact_verdict import Verdict, verdict
from hersey.verdict.evidence import MeasuredFilm, measured_film
from hersey.verdict.regime import Regime
from hersey.verdict.transition import ContactTransition, contact_transition


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
    names = [point.name for point in machine.points]
    shared = shared_load(machine, film, measured, surface)
    says = verdict(measured, surface, contact, lubricant, seen)
    found = nip_warnings(machine, film, measured, says, None if shared is None else shared.transition)
    said = () if shared is None else shared.warnings(names)
    return film_document(film, names, measured, says, [*found, *said], shared)


@dataclass(frozen=True)
class SharedLoad:
    """Film and asperities at the points of interest, and where drag is least."""

    film: MixedFilm
    transition: ContactTransition

    def summary(self, names: Sequence[str]) -> str:
        """Return both as text; names of the points."""
        return f"{self.film.summary(names)}\n{self.transition.summary()}"

    def warnings(self, names: Sequence[str]) -> list[Warning]:
        """Return both as warnings, for a page; names of the points."""
        words = (
            "film thickness is {ratio:.3g} of the roughness (lambda), asperities carry {share:.2f %} "
            "of the load, and the torque of film and asperities is {torque:.3g mN m}"
        )
        columns = (self.film.lambda_ratio, self.film.share, self.film.torque)
        points = [
            Warning("load shared", words, where=name, ratio=ratio, share=share, torque=torque)
            for name, ratio, share, torque in zip(
                names, *(np.ravel(each).tolist() for each in columns), strict=False
            )
        ]
        return [*points, *self.transition.warnings()]


def shared_load(
    machine: Machine, film: Film, measured: MeasuredFilm | None, surface: DampingSurface | None = None
) -> SharedLoad | None:
    """Return who shares the load at the points of a film; None where the machine does not state it.

    The transition is that of the temperatures of the log, or else of the points.
    """
    mixed = machine.mixed
    if mixed is None:
        return None
    kelvin = np.unique(film.temperature)
    if measured is not None:
        groups = groups_of_temperature(measured.temperature)
        kelvin = np.array([measured.temperature[group].mean() for group in groups])
    elif machine.points and mixed.contact.heat_flow is not None:
        kelvin = np.unique([point.temperature for point in machine.points])
    return SharedLoad(
        mixed.at(speed=film.speed, temperature=film.temperature), contact_transition(mixed, kelvin, surface)
    )


def film_document(
    film: Film,
    names: list[str],
    measured: MeasuredFilm | None = None,
    says: Verdict | None = None,
    warnings: Sequence[Warning] = (),
    shared: SharedLoad | None = None,
) -> FilmPart:
    """Return a film at named points, what a log says of it if there is one, and what does not fit."""
    document = film.to_dict()
    document["film"]["names"] = names
    return FilmPart.model_validate(
        document
        | {
            "measured": None if measured is None else measured.to_dict(),
            "exponents": None if says is None else says.to_dict(),
            "verdict": "" if says is None else says.text,
            "contradicted": says is not None and says.contradicted,
            "mixed": None if shared is None else shared.film.to_dict(),
            "transition": None if shared is None else shared.transition,
            "warnings": list(warnings),
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
