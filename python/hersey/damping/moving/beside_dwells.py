"""Motion beside the dwells of a log, which no dwell uses."""

from __future__ import annotations

from collections.abc import Iterator

from hersey.cache.kept import kept
from hersey.damping.dwells.nothing_steady import ROWS_TO_FIT
from hersey.damping.dwells.points import SteadyPoints
from hersey.damping.moving.fit import fit_moving
from hersey.errors import MOVING, TARE, HerseyError, way_in
from hersey.log.torque_log import TorqueLog
from hersey.schema.warning import Warning

#: Share of the rows of a turning drive from which motion beside the dwells is spoken of: more than the ramps
#: of a usual staircase.
_MUCH = 0.25


def motion_beside(points: SteadyPoints) -> Iterator[Warning]:
    """Say how much of a log is motion that the dwells leave out, if it is much of it and can be fitted."""
    log = points.log
    if not isinstance(log, TorqueLog) or points.of_every_sample or not log.domain.is_torque:
        return
    moving = [each for each in points.rejected if each.why.kind in ("changing", "too short")]
    rows = sum(each.rows for each in moving)
    turning = log.rows - sum(each.rows for each in points.rejected if each.why.kind == "standing")
    if log.rows < ROWS_TO_FIT or rows < _MUCH * turning or not _can_be_fitted(log):
        return
    tared = points.tare_errors.shape[1] > 0
    remedy = "to fit every sample, dwells included, use {how}" + (" and omit {tare}" if tared else "")
    yield Warning(
        "motion not used",
        "{time:.3g} s of the log ({share:.0f %} of the time the drive turns) are in no dwell and not used: "
        "the speed changes, or holds too briefly",
        severity="watch",
        remedy="" if way_in() == "page" else remedy,
        time=sum(each.rows * log.runs[each.run].sampling_interval for each in moving),
        share=rows / turning,
        how=MOVING,
        tare=TARE,
    )


@kept()
def _can_be_fitted(log: TorqueLog) -> bool:
    """Whether the advice to fit every sample can be followed."""
    try:
        fit_moving(log)
    except HerseyError:
        return False
    return True
