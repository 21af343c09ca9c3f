"""What a machine does, as parts of the document."""

from __future__ import annotations

from typing import Any

from hersey.decision.behaviour import Behaviour
from hersey.parts import BandPart, MapPart, PosteriorPart, StickSpeedPart
from hersey.result import json_record


def behaviour_parts(found: Behaviour | None) -> dict[str, Any]:
    """Return map, band and V* against the stick speed by the names of their fields."""
    if found is None:
        return {}
    map_, stick = found.map, found.stick_speeds
    return {
        "map": None if map_ is None else MapPart.model_validate(map_.to_dict()),
        "band": None if found.band is None else BandPart.model_validate(found.band.to_dict()),
        "posterior": PosteriorPart.model_validate(found.posterior.to_dict()),
        "stick_speed_sweep": None
        if stick is None
        else StickSpeedPart(**json_record({"temperature": found.temperature, **vars(stick)})),
    }
