"""Why a log has no dwell at all, in a sentence that ends in what to type or to record."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from hersey.damping.dwells.few_rows import (
    LASTS,
    changes_in_steps,
    held_for_few_rows,
    rows_held,
    rows_of_means,
)
from hersey.damping.dwells.groups import MIN_DWELL, MIN_SAMPLES, distinct_speeds
from hersey.damping.dwells.judging import Asked
from hersey.damping.dwells.one_speed import is_one_speed, of_one_speed
from hersey.damping.dwells.reasons import CAUSES, Reason, opposite_signs, remedies, sizes
from hersey.damping.dwells.rejection import Rejection
from hersey.errors import MOVING, ROTATION, InsufficientDataError, Setting, followed_by, turned, way_in
from hersey.log.roles import EVERY
from hersey.log.torque_log import NO_CLOCK, Run, TorqueLog

#: Dwells that a shorter --min-dwell must give to be proposed.
WORTH_IT = 3
#: A speed whose correlation with time is beyond this over a stretch runs up or down all the time.
RUNNING = 0.7
#: Blocks into which a run is cut to count its ramps, at the most, and share of its span that is a turn.
_BLOCKS, _TURN = 60, 0.1
#: Share of the rows of a drive that turns, beyond which it holds a speed throughout.
_HELD = 0.9
#: A log shorter than so many dwells has a clock in another unit, or rows less often: so many times, say.
_TOO_BRIEF, _RARER = 1.0, 50
#: Share of the rows in which speed holds for a moment, as on the crests of sines, of a log that moves.
_CRESTS = 0.3
#: Parts of a least dwell over which speed is averaged, change between two of them, as a share of the greatest
#: speed, that is motion, and share of such changes of a log that moves.
_PARTS, _CHANGE, _MOST_CHANGE = 8, 0.02, 0.5
#: Rows from which a log may be fitted as it moves.
ROWS_TO_FIT = 300
#: A log of so many dwells of the usual duration is long enough: the duration asked for is the mistake.
_ENOUGH = 20.0


def nothing_steady(
    log: TorqueLog,
    rejected: tuple[Rejection, ...],
    asked: Asked,
    dwells_with: Callable[[float], int],
    other_clock: Callable[[], str],
) -> InsufficientDataError:
    """Return the error.

    Parameters
    ----------
    dwells_with
        Counts the dwells that another least duration, s, would give.
    other_clock
        Says which unit of time would give dwells, or nothing.
    """
    if means := rows_of_means(log):
        return means
    one = is_one_speed(log)
    if (few := held_for_few_rows(log)) and not one:
        return InsufficientDataError(few)
    name = log.files[0].name + (f" and {len(log.files) - 1} more" if len(log.files) > 1 else "")
    held = [r for r in rejected if r.is_dwell]
    against = [r for r in held if r.why.kind == "opposite signs"]
    if against and 2 * len(against) >= len(held):
        return opposite_signs(f"{name}, {len(against)} of {len(held)} dwells")
    reasons: dict[str, list[Reason]] = {}
    for r in rejected:
        reasons.setdefault(r.why.label, []).append(r.why)
    listed = ", ".join(f"{len(alike)} x {_in_short(alike)}" for alike in reasons.values())
    way_out = _way_out(log, rejected, asked, dwells_with, other_clock)
    said = f"{name}: no dwell found ({listed})"
    for way in (*(_remedy(alike) for alike in reasons.values()), way_out):
        said = followed_by(said, way)
    over = bool(too_brief(log, asked.min_dwell))
    if one and not over:
        return of_one_speed(said, log)
    brief = sum(r.rows for r in held) < _CRESTS * log.rows
    moves = not over and (brief or _runs_up_and_down(log, rejected) or _moves_on(log, asked.min_dwell))
    return InsufficientDataError(said, setting=MOVING if moves else None)


def _moves_on(log: TorqueLog, min_dwell: float) -> bool:
    """Whether the speed changes from moment to moment, as in sines, and not in steps."""
    changes = []
    for run in log.runs:
        rows = max(int(min_dwell / _PARTS / run.sampling_interval), 1)
        whole = run.speed[: run.speed.size // rows * rows].reshape(-1, rows).mean(axis=1)
        changes.append(np.abs(np.diff(whole)) > _CHANGE * float(np.max(np.abs(run.speed))))
    return bool(np.mean(np.concatenate(changes)) > _MOST_CHANGE)


def _in_short(alike: list[Reason]) -> str:
    """Reasons of one kind in words, without what to do."""
    return alike[0].label + (sizes(alike) if alike[0].kind in CAUSES else "")


def _remedy(alike: list[Reason]) -> str:
    """What to do about reasons of one kind, or nothing."""
    if alike[0].kind == "opposite signs":
        return f"Flip {alike[0].domain.quantity} or speed with {turned('torque')}"
    if alike[0].kind == "zero torque":
        return f"Check that the sensor of the {alike[0].domain.quantity} is connected"
    return remedies(alike) if alike[0].kind in CAUSES else ""


def too_brief(log: TorqueLog, min_dwell: float) -> str:
    """Return that a log is over before a dwell, and what to do about its clock; or an empty text."""
    lasted = sum(float(run.time[-1] - run.time[0]) for run in log.runs)
    if lasted >= _TOO_BRIEF * min_dwell:
        return ""
    brief = f"{_held(min_dwell)}, but the whole log lasts only {lasted:.3g} s"
    if lasted >= _ENOUGH * MIN_DWELL:
        usual = Setting("min_dwell").to(f"{MIN_DWELL:g} s", python=f"{MIN_DWELL:g}")
        return f"{brief}. Use {usual}, the usual duration"
    return f"{brief}. {_other_clock(log)}"


def _held(min_dwell: float) -> str:
    return f"A dwell must hold one speed for at least {min_dwell:g} s"


def _way_out(
    log: TorqueLog,
    rejected: tuple[Rejection, ...],
    asked: Asked,
    dwells_with: Callable[[float], int],
    other_clock: Callable[[], str],
) -> str:
    if brief := too_brief(log, asked.min_dwell):
        return brief
    held = _held(asked.min_dwell)
    if any(r.why.kind == "other rotation" for r in rejected):
        other = "reverse" if asked.rotation == "forward" else "forward"
        return f"The drive turns in the {other} direction. Use {ROTATION.to(other)}"
    short = [(r.why.lasts, r.why.rows) for r in rejected if r.why.kind == "too short"]
    if _runs_up_and_down(log, rejected):
        slow, fast = (float(f([f(np.abs(run.speed)) for run in log.runs])) for f in (np.min, np.max))
        unit, factor = log.domain.shown_speed
        span = f"between {slow * factor:.3g} and {fast * factor:.3g} {unit}"
        if steps := _short_steps(log, asked.min_dwell, span):
            return followed_by(steps, other_clock())
        count = sum(map(_ramps, log.runs))
        ramps = f"{count} ramp{'s' if count > 1 else ''} {span}"
        moving = ""
        if log.rows >= ROWS_TO_FIT:
            moving = f"To fit friction to every sample while the speed changes, use {MOVING.to()}"
        said = followed_by(f"The speed never holds: {ramps}. {held}", other_clock())
        return said if way_in() == "page" else followed_by(said, moving)
    enough = sorted({math.floor(10 * s - 0.5) / 10 for s, rows in short if rows >= MIN_SAMPLES and s > 0.2})
    for shorter in enough:
        if (count := dwells_with(shorter)) >= WORTH_IT:
            how = Setting("min_dwell").to(f"{shorter:g} s", python=f"{shorter:g}")
            return f"{held}. {count} dwells are found with {how}"
    if (speed := _only_speed(rejected)) is not None:
        return (
            f"The speed is always {log.domain.at(speed)}. Record dwells at three or more speeds, or "
            f"name another column with {Setting('speed', 'channel').to()}"
        )
    return followed_by(held, other_clock())


def _only_speed(rejected: tuple[Rejection, ...]) -> float | None:
    """The speed, rad/s without sign, that the drive holds whenever it turns, or None."""
    held = [r for r in rejected if r.is_dwell]
    turning = sum(r.rows for r in rejected if r.why.kind != "standing")
    speeds = np.abs([r.speed for r in held])
    if sum(r.rows for r in held) < _HELD * turning or not held or distinct_speeds(speeds) > 1:
        return None
    return float(np.mean(speeds))


def in_seconds(log: TorqueLog) -> bool:
    """Return whether the time of a log was read in seconds."""
    clocks = [channel for file in log.files for channel in file.channels if channel.role == "time"]
    return all(clock.unit == "s" and clock.name != NO_CLOCK for clock in clocks)


def _other_clock(log: TorqueLog) -> str:
    """What to say of the clock of a log that is over before a dwell."""
    if any(c.name == NO_CLOCK for file in log.files for c in file.channels):
        rarer = _RARER * log.runs[0].sampling_interval
        how = EVERY.to(f"{rarer:.3g} s", python=f"{rarer:.3g}")
        return f"If rows come less often, give the time between them, e.g. {how}"
    unit = Setting("time", "unit")
    if in_seconds(log):
        longer = f"{unit.to('min')}, {unit.to('h')} or {unit.to('d')}"
        return f"If the clock counts minutes, hours or days, use {longer}"
    return f"If the clock counts seconds, use {unit.to('s')}"


def _runs_up_and_down(log: TorqueLog, rejected: tuple[Rejection, ...]) -> bool:
    """Whether the speed changes all the time: in what is too short for a dwell, too."""
    short = [r for r in rejected if r.why.kind == "too short"]
    if not short:
        return bool(rejected) and all(r.why.kind == "changing" for r in rejected)
    return float(np.median([abs(_trend(log.runs[r.run], r)) for r in short])) > RUNNING


def _trend(run: Run, stretch: Rejection) -> float:
    """Correlation of the speed with time over a stretch."""
    here = (run.time >= stretch.start) & (run.time <= stretch.end)
    time, speed = run.time[here], run.speed[here]
    if time.size < 3 or not np.ptp(speed) or not np.ptp(time):
        return 0.0
    return float(np.corrcoef(time, speed)[0, 1])


def _short_steps(log: TorqueLog, min_dwell: float, span: str) -> str:
    """What to say of steps too short to be found, whatever the least duration; nothing of other logs."""
    lasting = [rows * run.sampling_interval for run in log.runs for rows in rows_held(run)]
    if not lasting or not all(map(changes_in_steps, log.runs)):
        return ""
    shortest = max(LASTS, MIN_SAMPLES * float(np.median([run.sampling_interval for run in log.runs])))
    return (
        f"The speed changes in {len(lasting)} steps {span}, of which the longest lasts {max(lasting):.2g} s. "
        f"At this rate a dwell must last more than {shortest:.2g} s to be found. "
        f"Hold each speed for at least {2.0 * max(shortest, 0.75 * min_dwell):.2g} s"
    )


def _ramps(run: Run) -> int:
    """How many times the speed of a run sets out up or down."""
    blocks = [float(np.mean(part)) for part in np.array_split(run.speed, min(_BLOCKS, run.speed.size))]
    least = _TURN * (max(blocks) - min(blocks))
    ways: list[int] = []
    end = blocks[0]
    for level in blocks[1:]:
        way = 1 if level - end > 0 else -1
        if ways and way == ways[-1]:
            end = level
        elif abs(level - end) > least:
            ways.append(way)
            end = level
    return max(1, len(ways))
