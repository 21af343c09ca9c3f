"""A run compared with its specimen and the others, as it is stated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from hersey.result import Means, Record


@dataclass(frozen=True)
class RunCompared(Record):
    """A run compared with its specimen and the others; null where there are too few to compare it."""

    run: int
    unit: str
    age: Annotated[float, Means("in the unit of all ages")]
    distance: Annotated[
        float | None,
        Means("distance from what the other runs of its specimen show, studentised: 1 is the usual one"),
    ]
    influence: Annotated[
        float | None,
        Means("by how much the torque of its specimen at the last age moves without this run, by the trend"),
    ]
    slip: Annotated[str, Means("likeliest slip that it has a part in; empty if there is none")]
