"""From a log to its dwells, and from each to a steady point."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, TypeVar

import numpy as np
import polars as pl

from hersey.arrays import FloatArray
from hersey.damping.dwells.counted_speed import counting_error, with_counts_spread
from hersey.damping.dwells.groups import MIN_DWELL, MIN_SAMPLES
from hersey.damping.dwells.judging import Asked, Dwell, Stretch, judged
from hersey.damping.dwells.noise import mean_and_error
from hersey.damping.dwells.nothing_steady import WORTH_IT, in_seconds, nothing_steady, too_brief
from hersey.damping.dwells.points import SteadyPoints
from hersey.damping.dwells.rejection import Rejection
from hersey.damping.dwells.relaxation import Relaxation, Trend, relaxation
from hersey.damping.dwells.resolution import Resolution, repeats, rounding_error, step_of
from hersey.damping.dwells.ripple import joined_over_turns, turned, without_ripple
from hersey.damping.dwells.segments import Segment, segments_of
from hersey.damping.dwells.settling import common_settling
from hersey.damping.dwells.shared_noise import Powers, SharedNoise, shared_noise
from hersey.damping.dwells.steadiness import MAX_TEMPERATURE_DRIFT, drift_over, straightened, subtracted
from hersey.damping.dwells.zero import Zero, standing_stretches, starts_of
from hersey.errors import TARE, InsufficientDataError, ParameterError, Setting
from hersey.log.long_arrays import deviation, let_go, mean, variance
from hersey.log.roles import MEANS
from hersey.log.torque_log import ROTATIONS, TARES, Run, TorqueLog

T = TypeVar("T")
#: Rounds in which dwells are judged again by the noise of those kept, at the most.
ROUNDS = 3
#: Clocks that a log may have instead of one in seconds: seconds, unit and name of one count.
Clocks = tuple[tuple[float, str, str], ...]
LONGER_CLOCKS: Clocks = ((60.0, "min", "minutes"), (3600.0, "h", "hours"))
#: Share of the rows that dwells hold if the clock is such a one; the crests of a swing hold less.
NO_SWING = 0.3
#: A drive that turned slower than this share of the speed that follows counts as standing.
STANDS = 1e-3
#: Speed that swings by more than this share (standard deviation) is not judged as noise of the encoder alone.
NOTABLE_SWING = 0.2


def steady_points(
    log: TorqueLog, *, min_dwell: float = MIN_DWELL, tare: str = "none", rotation: str = "both"
) -> SteadyPoints:
    """Find the dwells of a log and reduce each to a steady point.

    Parameters
    ----------
    min_dwell
        Shortest dwell, s, after its settling is cut.
    tare
        ``none``, or ``standing`` to subtract what torque reads where the drive stands, at the time of each
        dwell.
    rotation
        ``both``, or only ``forward`` (positive speed) or ``reverse`` dwells.

    Raises
    ------
    InsufficientDataError
        If no dwell is found, or there is no standing stretch to tare with.
    """
    if tare not in TARES:
        value = f"{tare} N*m" if re.fullmatch(r"[-+]?[0-9.]+", tare.strip()) else tare
        known = f'write tare = "{value}" under [torque] in hersey.toml beside the log, with its unit'
        offset = f". To subtract a known offset, {known}" if any(map(str.isdigit, tare)) else ""
        raise ParameterError(f"tare '{tare}' is not known. Use none or standing{offset}")
    if rotation not in ROTATIONS:
        raise ParameterError(f"rotation '{rotation}' is not known. Use both, forward or reverse")
    if not 0 < min_dwell < float("inf"):
        raise ParameterError(f"min_dwell is {min_dwell:g} s: it must be greater than 0")
    if log.rows < MIN_SAMPLES:
        raise InsufficientDataError(
            f"{log.files[0].name} has {log.rows} rows, but one dwell needs at least {MIN_SAMPLES}",
            remedy=f"if each row is the mean of a dwell, use {MEANS.to()}",
        )
    return _Reduction(log, tare == "standing", Asked(min_dwell, rotation)).points()


class _Reduction:
    """A log cut into stretches, and what they share: the zero of the torque, and its noise.

    What is steady is judged first by each dwell's own noise, then by what all of them show.
    """

    def __init__(
        self, log: TorqueLog, subtracted: bool, asked: Asked, clocks: Clocks = LONGER_CLOCKS
    ) -> None:
        self.recorded, self.subtracted, self.asked, self.clocks = log, subtracted, asked, clocks
        counted = [with_counts_spread(run) for run in log.runs]
        self.counts = [step for _, step in counted]  # of encoders, rad/s
        self.log = replace(log, runs=tuple(run for run, _ in counted)) if any(self.counts) else log
        self.starts = starts_of(log.runs)
        self.segments = [joined_over_turns(run, segments_of(run)) for run in self.log.runs]
        self.stretches = [s for i in range(len(log.runs)) for s in _in_order(i, self.segments[i])]
        self.settling: dict[str, float] = {}
        self.steps = [self._steps(i) for i in range(len(log.runs))]
        self.zero = self._zero(None)
        if subtracted and self.zero is None:
            if brief := too_brief(log, asked.min_dwell):
                raise InsufficientDataError(f"{log.files[0].name}: {brief}")
            first = f"{other} Otherwise omit" if (other := self._other_clock()) else "Omit"
            raise InsufficientDataError(
                f"the drive never stands still for 2 s, so there is no tare. {first} {TARE.to()}, or set "
                'tare = "4 mN*m" under [torque] in hersey.toml'
            )

    def points(self) -> SteadyPoints:
        """Judge the stretches by the noise of those that are dwells, until both agree, and reduce."""
        noise: SharedNoise | None = None
        outcomes = self._judged(None)
        self.settling = self._settling([o for o in outcomes if isinstance(o, Dwell)])
        for _ in range(ROUNDS):
            noise = self._noise([o for o in outcomes if isinstance(o, Dwell)])
            if noise is None:
                break
            before, outcomes = outcomes, self._judged(noise)
            if outcomes == before:
                break
        self.zero = self._zero(noise)
        dwells = [o for o in outcomes if isinstance(o, Dwell)]
        rejected = tuple(_about(self.log, o) for o in outcomes if isinstance(o, Rejection))
        if not dwells:
            others = self._dwells_with, self._other_clock
            raise nothing_steady(self.log, rejected, self.asked, *others)
        return self._reduced(dwells, rejected, noise)

    def _other_clock(self) -> str:
        """What to say if dwells were found had the clock counted minutes or hours; else nothing."""
        if not in_seconds(self.log):
            return ""
        for seconds, unit, name in self.clocks:
            runs = tuple(replace(run, time=seconds * run.time) for run in self.log.runs)
            try:
                found = _Reduction(replace(self.log, runs=runs), self.subtracted, self.asked, ()).points()
            except InsufficientDataError:
                continue
            held = float(np.sum(found.column("rows") + found.column("settling_rows")))
            if len(found) >= WORTH_IT and held > NO_SWING * self.log.rows:
                how = Setting("time", "unit").to(unit)
                return f"If the clock counts {name}, use {how}: {len(found)} dwells are found then."
        return ""

    def _dwells_with(self, min_dwell: float) -> int:
        """How many dwells there were if they might be shorter."""
        asked = Asked(min_dwell, self.asked.rotation)
        return sum(isinstance(outcome, Dwell) for outcome in self._judged(None, asked))

    def _judged(self, noise: SharedNoise | None, asked: Asked | None = None) -> list[Dwell | Rejection]:
        tares = self._tares(self._middles([(s.run, s.segment.start, s.segment.end) for s in self.stretches]))

        def judge(run: Run, stretch: Stretch, tare: float) -> Dwell | Rejection:
            settling, step = self.settling.get(stretch.approach, 0.0), self.steps[stretch.run]["torque"]
            return judged(run, stretch, asked or self.asked, tare, noise, settling, step)

        return self._each(judge, self.stretches, tares.tolist())

    def _each(self, made: Callable[..., T], stretches: Sequence[Stretch], *given: Sequence[Any]) -> list[T]:
        """What a function makes of each stretch and its run, and of what is given with it.

        Of a long log no more is in memory than the stretch and a few before it.
        """
        out = []
        for stretch, *others in zip(stretches, *given, strict=True):
            run = self.log.runs[stretch.run]
            out.append(made(run, stretch, *others))
            run.passed(stretch.segment.start, stretch.segment.end)
        return out

    def _reduced(
        self, dwells: list[Dwell], rejected: tuple[Rejection, ...], noise: SharedNoise | None
    ) -> SteadyPoints:
        times = self._middles([(d.run, d.start, d.end) for d in dwells])
        tares = self._tares(times)
        rows = self._each(partial(_row, noise), dwells, tares.tolist())
        resolutions = self._resolutions(dwells)
        for resolution in resolutions:
            _widen(rows, resolution.quantity, resolution.errors)
        relaxing = self._relaxation(dwells, tares)
        if relaxing is not None:
            late = np.abs(relaxing.left)
            late = np.where(late > 0.0, late, late.max())  # from rest torque changes most
            _widen(rows, "torque", late * np.array([row["torque"] for row in rows], dtype=float))
        kinds = dict.fromkeys(("temperature", "temperature_error", "load"), pl.Float64)
        table = pl.DataFrame(rows, schema_overrides=kinds)
        disturbances = np.empty((len(dwells), 0))
        if self.subtracted and self.zero is not None:
            errors = table["torque_error"].to_numpy()
            disturbances, left = self.zero.disturbances(times, errors)
            table = table.with_columns(torque_error=np.hypot(errors, left))
        warnings = () if self.zero is None else self.zero.warnings(subtracted=self.subtracted, times=times)
        return SteadyPoints(
            table=table,
            rejected=rejected,
            tare=float(np.mean(tares)),
            standing_torque=None if self.zero is None else self.zero.mean,
            log=self.recorded,
            tare_errors=disturbances,
            warnings=warnings,
            resolutions=resolutions,
            relaxation=relaxing,
            relaxation_errors=_left(relaxing, table),
            temperature_rates=np.array(self._each(_temperature_rate, dwells)),
        )

    def _steps(self, index: int) -> dict[str, float]:
        """Steps in which the sensors of a run count while its speed holds, SI; 0 where they show none."""
        run = self.recorded.runs[index]
        rows = [slice(s.start, s.end) for s in self.segments[index] if s.steady]
        channels = {"torque": run.torque, "speed": run.speed, "temperature": run.temperature}
        return {
            name: 0.0 if values is None else step_of([values[each] for each in rows])
            for name, values in channels.items()
        }

    def _resolutions(self, dwells: list[Dwell]) -> tuple[Resolution, ...]:
        """The steps of the sensors, with the error that each leaves in each dwell."""
        alike = np.sqrt(self._repeats(dwells))
        out = []
        for name in ("torque", "speed", "temperature"):
            if step := max(steps[name] for steps in self.steps):
                steps = [self.steps[d.run][name] for d in dwells]
                errors = self._each(partial(self._rounding, name), dwells, steps)
                out.append(Resolution(name, step, np.array(errors) * alike))
        return tuple(out)

    def _rounding(self, name: str, _: Run, dwell: Dwell, step: float) -> float:
        """The error that the step of a sensor leaves in the mean of a dwell, SI."""
        values = _values(self.recorded.runs[dwell.run], name, dwell)
        counted = counting_error(values, self.counts[dwell.run]) if name == "speed" else None
        return rounding_error(values, step) if counted is None else counted

    def _repeats(self, dwells: list[Dwell]) -> FloatArray:
        """How many dwells have the speed and temperature of each."""
        speed = np.array([d.segment.speed for d in dwells])
        if not self.log.has_temperature:
            return repeats(speed, None)
        kelvin = self._each(lambda run, d: np.mean(_values(run, "temperature", d)), dwells)
        return repeats(speed, np.array(kelvin))

    def _relaxation(self, dwells: list[Dwell], tares: FloatArray) -> Relaxation | None:
        """The relaxation that the dwells show together after each change of speed."""
        return relaxation(self._each(_trend, dwells, tares.tolist(), self._each(self._isothermal, dwells)))

    def _isothermal(self, run: Run, dwell: Dwell) -> bool:
        """Whether a dwell has the temperature of the speed held before it."""
        kelvin = run.temperature
        before = [s for s in self.segments[dwell.run] if s.steady and s.end <= dwell.segment.start]
        if kelvin is None or not before:
            return True
        last = before[-1]
        change = mean(kelvin[dwell.start : dwell.end]) - mean(kelvin[last.start : last.end])
        run.passed(last.start, last.end)
        return bool(abs(change) <= MAX_TEMPERATURE_DRIFT)

    def _zero(self, noise: SharedNoise | None) -> Zero | None:
        stretches = standing_stretches(
            self.log.runs, self.segments, noise, [each["torque"] for each in self.steps]
        )
        last = self.log.runs[-1]
        duration = float(self.starts[-1]) + float(last.time[-1] - last.time[0])
        return Zero(tuple(stretches), duration) if stretches else None

    def _tares(self, times: FloatArray) -> FloatArray:
        """What is subtracted at times of the log, N m."""
        if not self.subtracted or self.zero is None:
            return np.zeros(times.size)
        return self.zero.at(times)

    def _middles(self, parts: list[tuple[int, int, int]]) -> FloatArray:
        """Middle of each part (run, first row, row after the last), s into the log."""
        middles = []
        for index, start, end in parts:
            time = self.log.runs[index].time
            middles.append(self.starts[index] + (time[start] + time[end - 1]) / 2.0 - time[0])
            let_go(time[start:end])  # two numbers bring whole pages into memory
        return np.array(middles)

    def _settling(self, dwells: list[Dwell]) -> dict[str, float]:
        """How long dwells take to settle, s, by the way in which their speed was come to."""
        calm = [d for d in dwells if not d.segment.ripple]
        tares = self._tares(self._middles([(d.run, d.start, d.end) for d in calm])).tolist()
        ways: dict[str, list[tuple[Run, int, int, float]]] = {}
        for d, tare in zip(calm, tares, strict=True):
            ways.setdefault(d.approach, []).append((self.log.runs[d.run], d.segment.start, d.end, tare))
        return {way: common_settling(held) for way, held in ways.items()}

    def _noise(self, dwells: list[Dwell]) -> SharedNoise | None:
        """The noise of the dwells, without the drifts that are more than it."""
        powers = self._each(_powers, dwells)
        noise = shared_noise(powers)
        if noise is None:
            return None
        straight = self._each(partial(_powers_if_drifting, noise), dwells)
        both = zip(straight, powers, strict=True)
        return shared_noise([new or old for new, old in both]) if any(straight) else noise


def _about(log: TorqueLog, rejection: Rejection) -> Rejection:
    """A stretch whose reason speaks of what the log measures."""
    of = log.domain
    return rejection if of.is_torque else replace(rejection, why=replace(rejection.why, domain=of))


def _in_order(index: int, segments: list[Segment]) -> list[Stretch]:
    """Stretches of a run, each with the speed held before it."""
    previous, stretches = None, []
    for segment in segments:
        stretches.append(Stretch(index, segment, previous))
        if segment.steady:
            previous = abs(segment.speed)
    return stretches


def _interval(time: FloatArray) -> float:
    """Mean sampling interval, s."""
    return float(time[-1] - time[0]) / (time.size - 1)


def _powers(run: Run, dwell: Dwell) -> Powers:
    """The torque of a dwell in cosines."""
    return Powers.of(_calm_torque(run, dwell), _interval(run.time[dwell.start : dwell.end]))


def _powers_if_drifting(noise: SharedNoise, run: Run, dwell: Dwell) -> Powers | None:
    """The torque of a dwell in cosines without its drift, or None if it is no more than noise."""
    time, torque = run.time[dwell.start : dwell.end], _calm_torque(run, dwell)
    if not drift_over(time, torque, noise)[0]:
        return None
    return Powers.of(straightened(time, torque), _interval(time))


def _row(noise: SharedNoise | None, run: Run, dwell: Dwell, tare: float) -> dict[str, object]:
    """One row of the table of steady points."""
    rows = slice(dwell.start, dwell.end)
    speed_mean, speed_error, _ = mean_and_error(run.speed[rows])
    torque_mean, torque_error, independent = _torque(
        run.time[rows], subtracted(_calm_torque(run, dwell), tare), noise
    )
    torque_error = float(np.hypot(torque_error, _curvature(run.speed[rows]) * torque_mean))
    hot = mean_and_error(run.temperature[rows]) if run.temperature is not None else (None, None)
    return {
        "run": dwell.run,
        "start": float(run.time[dwell.start]),
        "end": float(run.time[dwell.end - 1]),
        "speed": speed_mean,
        "speed_error": speed_error,
        "torque": torque_mean,
        "torque_error": torque_error,
        "temperature": hot[0],
        "temperature_error": hot[1],
        "rows": dwell.end - dwell.start,
        "effective_rows": independent,
        "settling_rows": dwell.segment.end - dwell.segment.start - (dwell.end - dwell.start),
        "approach": dwell.approach,
        "load": None if run.load is None else float(np.mean(run.load[rows])),
        "tare": tare,
    }


def _values(run: Run, name: str, dwell: Dwell) -> FloatArray:
    """Readings of a channel over a dwell; none if it was not recorded."""
    values: FloatArray | None = getattr(run, name)
    return np.empty(0) if values is None else values[dwell.start : dwell.end]


def _widen(rows: list[dict[str, object]], quantity: str, errors: FloatArray) -> None:
    """Add errors to the standard error of each dwell."""
    name = f"{quantity}_error"
    for row, error in zip(rows, errors, strict=True):
        row[name] = float(np.hypot(row[name], error))  # type: ignore[call-overload]


def _left(relaxing: Relaxation | None, table: pl.DataFrame) -> FloatArray:
    """What is left of a relaxation in the torque of each dwell, N m, shape (points, 0 or 1).

    It is common to all only as far as its course is the one assumed: each dwell has it as an error too.
    """
    if relaxing is None:
        return np.empty((table.height, 0))
    return np.asarray(relaxing.left * table["torque"].to_numpy())[:, None]


def _trend(run: Run, dwell: Dwell, tare: float, isothermal: bool) -> Trend:
    """How the torque of a dwell runs since the speed changed."""
    before, after = dwell.previous or 0.0, abs(dwell.segment.speed)
    step = float(np.log(after / before)) if before > STANDS * after else 0.0
    since = subtracted(run.time[dwell.start : dwell.end], float(run.time[dwell.segment.start]))
    return Trend.of(since, subtracted(_calm_torque(run, dwell), tare), step, isothermal=isothermal)


def _temperature_rate(run: Run, dwell: Dwell) -> float:
    """How fast the reading of temperature changes over a dwell, K/s; 0 within its noise."""
    if run.temperature is None:
        return 0.0
    time = run.time[dwell.start : dwell.end]
    return drift_over(time, run.temperature[dwell.start : dwell.end])[0] / float(time[-1] - time[0])


def _calm_torque(run: Run, dwell: Dwell) -> FloatArray:
    """Torque of a dwell, N m, without what repeats with the revolution if the speed ripples so."""
    rows = slice(dwell.start, dwell.end)
    if not dwell.segment.ripple:
        return run.torque[rows]
    return without_ripple(turned(run.time[rows], run.speed[rows]), run.torque[rows])


def _curvature(speed: FloatArray) -> float:
    """Error of taking the mean torque for that of the mean speed, relative.

    w^p over a swing of relative deviation s is p (p - 1)/2 s^2 more than at the mean: under s^2/2 for any p
    between -0.6 and 1.6. Small oscillations may be noise of the encoder: the mean is right.
    """
    swing = deviation(speed) / abs(mean(speed))
    return 0.5 * swing**2 if swing > NOTABLE_SWING else 0.0


def _torque(time: FloatArray, torque: FloatArray, noise: SharedNoise | None) -> tuple[float, float, float]:
    """Mean, standard error and independent samples.

    A drift small enough to be kept is still one: its own deviation about the mean is added.
    """
    mean, error, independent = mean_and_error(torque)
    rise = drift_over(time, torque, noise)[0]
    if noise is not None and error > 0.0:
        steady = straightened(time, torque) if rise else torque
        error = noise.mean_error(Powers.of(steady, _interval(time)))
        independent = float(np.clip(variance(steady) / error**2, 1.0, torque.size))
    return mean, float(np.hypot(error, rise / np.sqrt(12.0))), independent
