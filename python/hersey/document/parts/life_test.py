"""A life test followed, in the document."""

from __future__ import annotations

from hersey.document.parts.ageing_maps import AgeingMapsPart
from hersey.document.parts.drift import DriftPart
from hersey.document.parts.film_life import FilmLifePart
from hersey.document.parts.other_uses import OtherUsesPart
from hersey.document.parts.time_to_failure import TimeToFailurePart
from hersey.schema.part import Part


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
