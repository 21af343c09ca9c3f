"""A life test followed, in the document."""

from __future__ import annotations

from hersey.parts.ageing_maps import AgeingMapsPart
from hersey.parts.drift import DriftPart
from hersey.parts.film_life import FilmLifePart
from hersey.parts.other_uses import OtherUsesPart
from hersey.parts.part import Part
from hersey.parts.time_to_failure import TimeToFailurePart


class LifeTestPart(Part):
    """What ends the units of a campaign and when, what moved, film and maps; null where it cannot be told."""

    file: str
    time_to_failure: TimeToFailurePart
    drift: DriftPart | None
    film: FilmLifePart | None
    maps: AgeingMapsPart | None
    uses: OtherUsesPart | None = None
    unsaid: list[str]
    seed: int
