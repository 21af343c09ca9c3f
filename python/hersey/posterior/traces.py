"""Evidence found in a recording: starts from rest, and stretches that stick and slip at one drive speed."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import median
from typing import TYPE_CHECKING

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.curves import CurveMixture
from hersey.damping.dwells import SteadyPoints
from hersey.errors import HerseyError
from hersey.log import TorqueLog
from hersey.log.torque_log import Run
from hersey.machine.machine import Machine
from hersey.posterior.evidence import CycleFigures, Evidence, Start, StickSlip
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    from hersey.identification import CycleRecord, Scatter

#: A stretch of one drive speed: its blocks (s) differ by less than this share, and it lasts as long (s).
BLOCK, SAME, LEAST = 0.25, 0.05, 3.0
#: Blocks back from which a speed is compared.
_RECENT = 40
#: Standing: less than this share of the speed that follows, for as long (s), ending no more than this before
#: it. A drive that creeps is faster.
STANDING, STOOD, RAMP = 0.01, 1.0, 3.0
#: Torque that swings by more than this share of its mean (standard deviation) may be stick-slip.
SWINGS = 0.06
#: Share of a stretch, from its end, whose motion is judged.
SETTLED = 0.6
#: Relative error of the slope of the force of a held belt, however finely it is sampled.
_SLOPE = 0.1
#: A fall of less than this share of the mean force is no slip of the whole belt.
SLIPS = 0.1
#: Share of the first slips that the last must have in stick-slip that goes on.
SUSTAINED = 0.85
#: Samples per free period from which a peak is resolved, and a cycle.
PEAK_RESOLVED, CYCLE_RESOLVED = 8.0, 3.0
#: Share of its speed at which a drive counts as there.
_REACHED = 0.97
#: Error of a mean cycle that no scatter shows.
_FLOOR = 0.005
#: Share of the speed of least torque below which dwells slide only on a drive stiffer than the machine,
#: and the probability of such a dwell from which the log's drive counts as stiffer.
_STIFFER, _SURELY_NOT = 0.8, 0.05
#: Factor by which a loading slope may exceed the stiffness of the machine before it is that of another drive.
_OTHER_DRIVE = 1.5


@dataclass(frozen=True)
class Found:
    """Evidence, and why other recordings are none."""

    evidence: tuple[Evidence, ...] = ()
    warnings: tuple[Warning, ...] = ()

    def __add__(self, other: Found) -> Found:
        """Return both together."""
        return Found(self.evidence + other.evidence, self.warnings + other.warnings)


def evidence_of_log(points: SteadyPoints, curves: CurveMixture, machine: Machine) -> Found:
    """Return the stick-slip and the starts of the log that the dwells are from.

    Starts count only where the log's drive is that of the machine: one that may have held dwells steady well
    below the speed of least torque, where the machine would stick, may be stiffer.
    """
    if not isinstance(points.log, TorqueLog):
        return Found()
    found = evidence_of_trace(points.log, machine, zero=points.tare)
    if curves.falls_among_dwells(_STIFFER) < _SURELY_NOT:
        return found
    kept = tuple(e for e in found.evidence if isinstance(e, StickSlip))
    return Found(kept, found.warnings)


def evidence_of_trace(log: TorqueLog, machine: Machine, *, zero: float = 0.0) -> Found:
    """Return what a recording of the machine shows of starts and stick-slip.

    Parameters
    ----------
    zero
        Torque (N m) that the sensor shows without load.
    """
    found = Found()
    for run in log.runs:
        for stretch in _stretches(run):
            found = found + _of_stretch(run, stretch, machine, zero)
    return found


@dataclass(frozen=True)
class _Stretch:
    """Rows of one drive speed (rad/s, without sign), and where the drive left standstill, if it did."""

    first: int
    last: int
    speed: float
    started: int | None


def _stretches(run: Run) -> list[_Stretch]:
    """Stretches of one drive speed."""
    step = max(round(BLOCK / run.sampling_interval), 1)
    blocks = np.add.reduceat(np.abs(run.speed), np.arange(0, run.speed.size, step))
    sizes = np.diff(np.append(np.arange(0, run.speed.size, step), run.speed.size))
    means, out, first = blocks / sizes, [], 0
    each = means.tolist()  # of so few numbers Python finds the median sooner than NumPy
    while first < means.size:
        last = first + 1
        while (
            last < means.size
            and abs(each[last] - median(each[max(last - _RECENT, first) : last])) <= SAME * each[first]
        ):
            last += 1
        rows = first * step, min(last * step, run.speed.size)
        speed = float(np.mean(np.abs(run.speed[slice(*rows)])))
        if (
            speed > 0.0
            and run.time[rows[1] - 1] - run.time[rows[0]] >= LEAST
            and not _standing(means, first, speed)
        ):
            out.append(_Stretch(*rows, speed, _standstill_before(run, rows[0], speed)))
        first = last if last - first > 1 else first + 1
    return out


def _standing(means: FloatArray, first: int, speed: float) -> bool:
    """Whether a stretch is noise about standstill."""
    return bool(speed < 1e-3 * float(np.max(means)) or means[first] <= 0.0)


def _standstill_before(run: Run, row: int, speed: float) -> int | None:
    """The last row of a standstill that ends shortly before a row."""
    begin = int(np.searchsorted(run.time, run.time[row] - RAMP - STOOD))
    still = np.abs(run.speed[begin:row]) < STANDING * speed
    if not still.any():
        return None
    end = begin + int(np.flatnonzero(still)[-1])
    longest = run.time[end] - run.time[max(end - int(np.argmin(still[: end - begin + 1][::-1])), begin)]
    stood = still[: end - begin + 1].all() or longest >= STOOD
    return end if stood else None


def _of_stretch(run: Run, stretch: _Stretch, machine: Machine, zero: float) -> Found:
    """What one stretch shows."""
    sign = 1.0 if float(np.mean(run.speed[stretch.first : stretch.last])) >= 0.0 else -1.0
    force = sign * (run.torque - zero) / machine.roll_radius
    rows = slice(stretch.first, stretch.last)
    kelvin = None if run.temperature is None else float(np.nanmean(run.temperature[rows]))
    drive_speed = stretch.speed * machine.roll_radius
    settled = slice(stretch.last - int(SETTLED * (stretch.last - stretch.first)), stretch.last)
    mean = float(np.mean(force[settled]))
    swings = float(np.std(force[settled])) > SWINGS * abs(mean)
    record = (
        _record(run, force, rows if stretch.started is None else settled, drive_speed) if swings else None
    )
    sticks = record is not None and _sticks(record, mean)
    where = (
        f"{run.name} at {run.time[stretch.first]:.0f} s" if run.name else f"{run.time[stretch.first]:.0f} s"
    )
    peak, rise = None, 0.0
    if stretch.started is not None:
        peak, rise = _peak(run, force, stretch, machine), _rise(run, stretch)
    if not sticks:
        if stretch.started is None:
            return Found()
        return Found((Start(kelvin, drive_speed, True, rise, peak, where),))
    assert record is not None
    slope = record.loading_slope
    if np.isfinite(slope) and slope > _OTHER_DRIVE * machine.stiffness * drive_speed:
        return Found(warnings=(_of_another_drive(where, slope / drive_speed / machine.stiffness),))
    figures = _figures(record, run, machine, drive_speed)
    lasts = float(run.time[rows][-1] - run.time[rows][0])
    out: tuple[Evidence, ...] = (StickSlip(kelvin, drive_speed, lasts, figures, where),)
    if stretch.started is not None and peak is not None:
        out = (*out, Start(kelvin, drive_speed, False, rise, peak, where))
    return Found(out)


def _of_another_drive(where: str, times: float) -> Warning:
    return Warning(
        "stick-slip of another drive",
        "its force rises {times:.1f} times as fast as the machine's stiffness allows, so another "
        "drive was recorded",
        severity="watch",
        where=where,
        times=times,
    )


def _record(run: Run, force: FloatArray, rows: slice, drive_speed: float) -> CycleRecord | None:
    from hersey.identification import cycles  # loads much of SciPy, and few logs swing

    try:
        return cycles(run.time[rows], force[rows], drive_speed=drive_speed)
    except HerseyError:  # too short, or nothing but gaps: it shows no cycle
        return None


def _sticks(record: CycleRecord, mean: float) -> bool:
    """Whether a record is of stick-slip: slips of the whole belt, one after the other."""
    if record.kind == "steady_sliding" or record.slips < 3:
        return False
    return float(np.median(record.drop)) > SLIPS * abs(mean) and not _dies_out(record)


def _dies_out(record: CycleRecord) -> bool:
    """Whether the slips become smaller: a belt that slides swings for a while after its start."""
    third = max(record.slips // 3, 1)
    first, last = float(np.median(record.drop[:third])), float(np.median(record.drop[-third:]))
    return last < SUSTAINED * first


def _figures(record: CycleRecord, run: Run, machine: Machine, drive_speed: float) -> CycleFigures | None:
    """Figures of the cycles with their errors; None where too few samples fall on one."""
    from hersey.identification import Scatter

    period = Scatter.of(record.period)
    if not period.median > CYCLE_RESOLVED * run.sampling_interval:
        return None
    top, drop = Scatter.of(record.force_max), Scatter.of(record.drop)
    # between two samples the force rises by as much as this
    rise = machine.stiffness * drive_speed * run.sampling_interval
    free = machine.train.free_period
    coarse = 0.1 * min(1.0, (PEAK_RESOLVED * run.sampling_interval / free) ** 2)
    noise = record.samples.noise
    held = record.kind == "stick_slip" and record.stuck_fraction > 0.0 and np.isfinite(record.loading_slope)
    # a row more or less at either end of the rise
    row = run.sampling_interval / (record.stuck_fraction * period.median) if held else 0.0
    return CycleFigures(
        period=(period.median, _error(period, run.sampling_interval / np.sqrt(max(record.slips, 1)))),
        pull_max=(top.median, _error(top, 0.5 * rise + noise)),
        drop=(drop.median, float(np.hypot(_error(drop, rise + noise), coarse))),
        slope=(record.loading_slope, float(np.hypot(_SLOPE, np.sqrt(2.0) * row))) if held else None,
    )


def _error(figure: Scatter, absolute: float) -> float:
    """Relative standard error of a figure: of its scatter, and one that all cycles share."""
    scatter = figure.error if np.isfinite(figure.error) else 0.0
    return float(np.hypot(_FLOOR, np.hypot(scatter, absolute) / abs(figure.median)))


def _rise(run: Run, stretch: _Stretch) -> float:
    """Time in which the drive came up to its speed, s; of a sudden start none."""
    assert stretch.started is not None
    rows = slice(stretch.started, stretch.last)
    reached = int(np.argmax(np.abs(run.speed[rows]) >= _REACHED * stretch.speed))
    rise = float(run.time[stretch.started + reached] - run.time[stretch.started])
    # from the last row of standstill to the first at its speed: the middle part of the ramp
    return rise / (_REACHED - STANDING) if rise > 1.5 * run.sampling_interval else 0.0


def _peak(run: Run, force: FloatArray, stretch: _Stretch, machine: Machine) -> tuple[float, float] | None:
    """The greatest force of a start with its relative error, over a small part of the free period."""
    free = machine.train.free_period
    if free < PEAK_RESOLVED * run.sampling_interval:
        return None
    assert stretch.started is not None
    rows = force[stretch.started : stretch.last]
    width = max(int(free / (2.0 * PEAK_RESOLVED) / run.sampling_interval), 1)
    smooth = np.convolve(rows, np.ones(width) / width, mode="valid") if rows.size > width else rows
    peak, end = float(np.max(smooth)), smooth[int(0.7 * smooth.size) :]
    if peak < 1.1 * float(np.mean(end)):
        return None  # no peak stands out of what sliding takes
    noise = float(np.median(np.abs(np.diff(rows)))) / 0.954
    return peak, float(np.hypot(0.01, 1.5 * noise / np.sqrt(width) / peak))
