"""Bands, maps and plans in the document."""

from __future__ import annotations

from hersey.schema.record import part_of
from hersey.stability.disturbance import Disturbance, SafeStep
from hersey.stability.hysteresis import HysteresisBand


class BandPart(part_of(HysteresisBand)):  # type: ignore[misc]  # made as it runs
    """Drive speeds that divide the behaviour, m/s or the units of the arguments; null beyond the search."""

    disturbance: Disturbance | None = None
    step: SafeStep | None = None
