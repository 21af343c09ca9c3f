"""A measurement that a log holds twice: its dwells would count double, and the intervals be too narrow."""

from __future__ import annotations

from collections.abc import Sequence
from hashlib import sha256

import numpy as np

from hersey.errors import ParameterError
from hersey.log.torque_log import Run

#: Fewer rows than these may be equal by chance.
_FEW = 20


def refuse_given_twice(runs: Sequence[Run]) -> None:
    """Refuse two runs whose torque, speed and temperature are the same in every row.

    Two measurements never agree so: the noise of the torque differs. Times may differ.

    Raises
    ------
    ParameterError
        Naming both runs.
    """
    seen: dict[bytes, Run] = {}
    for run in runs if len(runs) > 1 else ():
        if run.time.size < _FEW or np.ptp(run.torque) == 0.0:
            continue
        earlier = seen.setdefault(_rows(run), run)
        if earlier is not run:
            raise ParameterError(
                f"the {run.time.size} rows of {run.name} and of {earlier.name} are the same: "
                "one is a copy of the other",
                remedy="delete one of them",
            )


def _rows(run: Run) -> bytes:
    """Hash of the rows of a run without their times."""
    hashed = sha256()
    for channel in (run.torque, run.speed, run.temperature):
        hashed.update(b"" if channel is None else np.ascontiguousarray(channel).data)
    return hashed.digest()
