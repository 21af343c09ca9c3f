"""What is not known of the film through life."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hersey.arrays import FloatArray, IntArray
from hersey.life.film.of_runs import FilmOfRuns
from hersey.life.film.shares import OtherDrag
from hersey.life.indicator import most_ages
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    from hersey.machine.machine import Machine


def of_other_drag(other: OtherDrag, read: FilmOfRuns) -> Warning:
    """Return how the ages depend on the drag that does not follow the film."""
    few, many = other.starves[0], other.starves[-1]
    return Warning(
        "other drag",
        "{low:.0f %} to {high:.0f %} of the drag at {point} may not follow the film (rolling, seals, gears). "
        "With more such drag specimens starve {direction}: the median one at {few} {age_unit} if it is "
        "{least:.0f %}, at {many} {age_unit} if it is {most:.0f %}. To determine it, log a specimen flooded "
        "with fresh lubricant, the drive without the nip, or a lubricant of another viscosity",
        severity="note" if other.determined else "watch",
        low=other.low,
        high=other.high,
        point=read.points[0].name,
        age_unit=read.runs.age_unit,
        least=few.share,
        few=few.shown,
        most=many.share,
        many=many.shown,
        direction="sooner" if other.sooner else "later",
    )


def of_the_law(age: FloatArray, place: IntArray, machine: Machine) -> list[Warning]:
    """Return what the law of the layer takes as known, of runs at ages of the specimens ``place``."""
    warnings = []
    if most_ages(place, age) < 3:
        warnings.append(
            Warning(
                "two ages at most",
                "no specimen was measured at three ages, so side flow and evaporation cannot be "
                "distinguished",
                severity="watch",
            )
        )
    if machine.asperities is None:
        warnings.append(
            Warning(
                "no asperities",
                "the machine file has no asperities, so dwells with a film below four times the "
                "roughness are excluded",
                severity="watch",
            )
        )
    warnings.append(
        Warning(
            "nip taken as constant",
            "the nip is assumed constant. Thicker oil changes torque at all dwells, a thin layer only "
            "at cold and fast ones; a nip that widens with age would look like thicker oil",
        )
    )
    return warnings
