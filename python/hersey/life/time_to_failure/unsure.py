"""What is not known of the ends of specimens, and what depends on priors."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from hersey.life.growth.limit_ages import FAR, POPULATION, rounded
from hersey.life.time_to_failure.first import SpecimenEnd
from hersey.life.time_to_failure.questions import Questions
from hersey.life.time_to_failure.way import FittedWay, listed
from hersey.schema.warning import Warning

#: An interval whose ends differ by this factor shows the order of an age, no more.
_WIDE = 2.0


def unsure(ending: Sequence[FittedWay], units: Sequence[SpecimenEnd], asked: Questions) -> Iterator[Warning]:
    """Yield what is not known of all ends."""
    if len(units) < POPULATION:
        yield from _not_answered(len(units), asked, ending[0].mode.ages.age_unit)
    named = {name for each in units if math.isfinite(each.age.age.value) for name in each.named}
    unnamed = [e.mode.name for e in ending if e.mode.growth.law is None and e.mode.name in named]
    if unnamed:
        yield Warning(
            "law of growth unknown",
            "the growth law is unknown for {modes}. Ages beyond the last runs average over all laws that fit",
            severity="watch",
            modes=listed(unnamed),
        )
    if len(units) < POPULATION:
        yield _few_specimens(len(units))
    yield from _of_specimens(units)


def _not_answered(count: int, asked: Questions, age_unit: str) -> Iterator[Warning]:
    if asked.share is not None and asked.until is not None:
        yield Warning(
            "share unknown",
            "whether at most {share:.3g %} of new specimens fail before {age} cannot be determined from "
            "{specimens} {specimens:specimen|specimens}",
            remedy="follow four specimens or more",
            severity="act",
            share=asked.share,
            age=f"{rounded(asked.until, 6)} {age_unit}".strip(),
            specimens=count,
        )
    if asked.cost_of_failure is not None:
        yield Warning(
            "replacement age unknown",
            "when to replace specimens cannot be determined from {specimens} {specimens:specimen|specimens}",
            remedy="follow four specimens or more",
            severity="act",
            specimens=count,
        )


def _few_specimens(count: int) -> Warning:
    return Warning(
        "few specimens",
        "one specimen does not show how specimens differ, so B10 and B50 are not given"
        if count == 1
        else "{specimens} specimens show too little of how specimens differ, so B10 and B50 are not given",
        remedy="follow four specimens or more",
        severity="watch",
        specimens=count,
    )


def _of_specimens(units: Sequence[SpecimenEnd]) -> Iterator[Warning]:
    """What holds of the ends of some specimens, which each warning names."""
    running = [each for each in units if each.state == "running" and math.isfinite(each.age.age.value)]
    near = [each for each in running if not each.age.far]
    wide = [each.unit for each in near if each.age.age.high > _WIDE * max(each.age.age.low, 1e-300)]
    if wide:
        yield Warning(
            "age uncertain",
            "the end of {specimens} is uncertain by more than a factor of {factor:g}",
            severity="watch",
            specimens=listed(wide),
            factor=_WIDE,
        )
    far = [each.unit for each in running if each.age.far]
    if far:
        yield Warning(
            "end far off",
            "the end of {specimens} is beyond {factor:g} times the age followed. It is not soon; the "
            "number itself means little",
            severity="watch",
            specimens=listed(far),
            factor=FAR,
        )
