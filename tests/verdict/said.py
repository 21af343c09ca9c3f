"""All that is said of a nip, in one list."""

from __future__ import annotations

from hersey.lubrication.film_result import Film
from hersey.machine.machine import Machine
from hersey.verdict.checks import misfits, remarks
from hersey.verdict.evidence import MeasuredFilm


def check_film(machine: Machine, film: Film, measured: MeasuredFilm | None = None) -> tuple[str, ...]:
    """What does not fit, then what else is to be known."""
    return (*(each.text for each in misfits(machine, film, measured)), *remarks(machine, film))
