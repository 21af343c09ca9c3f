"""A life test followed, in the document."""

from __future__ import annotations

from hersey.document.parts.drift import DriftPart
from hersey.life.following import LifeTest
from hersey.schema.record import part_of


class LifeTestPart(part_of(LifeTest)):  # type: ignore[misc]  # made as it runs
    """What ends the specimens of a campaign and when, what moved, film and maps; null where not known."""

    drift: DriftPart | None
