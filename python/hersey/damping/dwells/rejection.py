"""A stretch of a log that is not used, and why."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hersey.damping.dwells.reasons import NO_DWELL, Reason
from hersey.schema.domain import TORQUE


@dataclass(frozen=True)
class Rejection:
    """A stretch of the log that is not used, and why; times in s, first row from 0 within the run."""

    run: int
    start: float
    end: float
    rows: int
    why: Reason
    speed: float = float("nan")  #: mean, rad/s

    @property
    def reason(self) -> str:
        """Why, in words."""
        return str(self.why)

    @property
    def is_dwell(self) -> bool:
        """Whether a speed was held that is asked for: neither standing nor between two speeds."""
        return bool(np.isfinite(self.speed)) and self.why.kind not in NO_DWELL


def turned_rejection(rejection: Rejection, per: float) -> Rejection:
    """Return a rejection of sliding as one of a rotation, which has ``per`` times its speed."""
    why = replace(rejection.why, slow=per * rejection.why.slow, fast=per * rejection.why.fast, domain=TORQUE)
    return replace(rejection, speed=per * rejection.speed, why=why)


def record_of(rejection: Rejection) -> dict[str, Any]:
    """Return a rejection with its kind, and its reason in words."""
    plain = {name: value for name, value in vars(rejection).items() if name != "why"}
    why = rejection.why
    return {**plain, "kind": why.kind, "label": why.label, "reason": rejection.reason}
