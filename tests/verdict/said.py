"""All that is said of a nip, in one list."""

from __future__ import annotations

from hersey.lubrication.film_result import Film
from hersey.machine.machine import Machine
from hersey.verdict.checks import nip_warnings
from hersey.verdict.evidence import MeasuredFilm


def check_film(machine: Machine, film: Film, measured: MeasuredFilm | None = None) -> tuple[str, ...]:
    """What does not fit, then what else is to be known."""
    return tuple(str(each) for each in nip_warnings(machine, film, measured))
