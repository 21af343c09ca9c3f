"""A drive fitted to a mean cycle by least squares, and the other drives that fit nearly as well."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy import optimize

from hersey.arrays import FloatArray
from hersey.errors import ParameterError
from hersey.identification.cycle_record import CycleRecord
from hersey.identification.independence import ESTIMABLE
from hersey.identification.waveform import FEWEST_LAPS, ModelLap, Waveform, model_lap
from hersey.log.neighbours import runs_of_true
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import Drag
from hersey.motion.parameters import OF_THE_BELT, PARAMETERS

#: Range that is believed: of exponents, and of speeds over the drive speed.
EXPONENTS = {"ehl_exponent": (-0.995, 0.3), "mixed_exponent": (-2.5, -1.005)}
_SPEEDS = {"transition_speed": (1e-2, 30.0), "stick_speed": (1e-5, 0.5)}
#: Others may be this many times more or less than a first estimate.
_REACH = 30.0
#: Farther than this, a logarithm, no drive speed is from the stated one.
_ASTRAY = 1.0
#: The belt is held where the force of the model rises at this share of its steepest, or faster.
_HELD = 0.9
_FEWEST_POINTS = 4
#: Residual where the model has no cycle: many times the error of any point.
_NO_CYCLE = 1e3
#: Step of the numerical derivatives, in logarithms.
_STEP = 1e-4
#: Badly known values are moved by these (logarithms, and exponents), to either side, until chi-square grows
#: by more than `ALIKE` (over the misfit of the best): what grows by less is alike at 95 %.
MOVES = (0.7, 2.3, 4.6, 6.9)
EXPONENT_MOVES = (0.15, 0.4, 0.8)
ALIKE = 3.84
_HALVINGS = 2
#: A value this near its bound is at it; a variance beyond this gives no direction.
_AT_BOUND = 1e-3
_STRAIGHT = 100.0
#: First estimates: transition speed over drive speed, stick speed over transition speed; tried in turn
_STARTS = ((1.0, 0.01), (0.6, 0.1), (2.0, 0.003))
#: until chi-square per point is below this; the best is started again until it gains less than `_SETTLED`.
_GOOD = 2.0
_POLISH = 4
_SETTLED = 0.05


#: Standard errors in the half width of a normal interval at 95 %: what is stated of the drive speed is one.
NORMAL_REACH = 1.959963984540054


class Alternative(NamedTuple):
    """Values that fit about as well as the best, and what share of `ALIKE` they cost."""

    values: FloatArray
    share: float


class HeldSlope(NamedTuple):
    """Slope of the force while the belt is held, per s: mean of the laps, and its standard error.

    ``followed`` is the slope of the model on the same points over its k times its drive speed: less than 1
    by the creep of the held belt.
    """

    slope: float
    error: float
    followed: float


class DriveFit:
    """Least squares with one closure; values are logarithms, exponents themselves, and last a time shift.

    The drive speed is fitted too, held to what is stated of it by a residual of its own. Where nothing that
    is known holds a speed or a scale of mass, the record leaves it there: k and m go with the inverse of the
    speed, v_t and v_s with it, and no lap changes. What is known can tell it better than the stated value.
    """

    def __init__(
        self,
        wave: Waveform,
        record: CycleRecord,
        known: Mapping[str, float],
        closure: str,
        start: FloatArray | None = None,
    ) -> None:
        self.wave, self.record, self.known, self.closure = wave, record, known, closure
        assert record.drive_speed is not None
        self.drive_speed = record.drive_speed
        self.stated_error = float(np.log1p(record.drive_speed_uncertainty)) / NORMAL_REACH
        self.prior = 1.0 / self.stated_error
        self.names = (*(name for name in OF_THE_BELT if name not in known), "drive_speed")
        self.fall = float(np.median(record.fall_duration))
        laps = wave.period[np.isfinite(wave.period)]
        self.period = float(np.mean(laps))
        timing = float(np.std(laps, ddof=1) / np.sqrt(laps.size))
        self.period_error = max(timing, 1e-7 * self.period)
        self.drop = float(np.ptp(wave.force))
        starts = [start] if start is not None else [self._start(*ratios) for ratios in _STARTS]
        self.low, self.high = self._bounds(self._start(*_STARTS[0]))
        self.values, self.chi_square = self._solved(starts[0])
        for other in starts[1:]:
            if self.chi_square < _GOOD * self.wave.offset.size:
                break
            values, chi_square = self._solved(other)
            if chi_square < self.chi_square:
                self.values, self.chi_square = values, chi_square
        self._polish()
        if (misfit := self.chi_square / wave.offset.size) > _GOOD:
            # A model that misses the laps may not buy a better fit with another speed: errors are as its own.
            self.prior *= float(np.sqrt(misfit))
            self.chi_square = float(np.sum(self.residuals(self.values) ** 2))
            self._polish()
        self.lap = self._lap(self.values)
        self.misfit = float(np.sqrt(np.mean((self.curve(self.values) - wave.force) ** 2))) / self.drop

    def _polish(self) -> None:
        for _ in range(_POLISH):
            values, chi_square = self._solved(self.values)
            gained = self.chi_square - chi_square
            if gained > 0:
                self.values, self.chi_square = values, chi_square
            if gained < _SETTLED:
                break

    def _start(self, transition: float, stick: float) -> FloatArray:
        """First estimates from the figures of the cycles, and two ratios of speeds."""
        record, speed = self.record, self.drive_speed
        stiffness = self.known.get("stiffness", record.loading_slope / speed)
        top, bottom = float(np.median(record.force_max)), float(np.median(record.force_min))
        first = {
            "stiffness": stiffness,
            "mass": stiffness * (float(np.median(record.steep_duration)) / np.pi) ** 2,
            "transition_force": max(0.5 * (top + bottom), 0.05 * top),
            "transition_speed": transition * speed,
            "ehl_exponent": -0.7,
            "mixed_exponent": -1.2,
            "stick_speed": stick * transition * speed,
            "drive_speed": speed,
        } | dict(self.known)
        excess = max(top / first["transition_force"] / (1.0 if self.closure == "retained" else np.e), 1.02)
        if "mixed_exponent" not in self.known:
            ratio = np.log(first["transition_speed"] / first["stick_speed"])
            first["mixed_exponent"] = float(np.clip(-1.0 - np.log(excess) / max(ratio, 0.1), -2.4, -1.02))
        return np.array([*(self._value(name, first[name]) for name in self.names), 0.0])

    @staticmethod
    def _value(name: str, number: float) -> float:
        return number if name in EXPONENTS else float(np.log(number))

    def _bounds(self, start: FloatArray) -> tuple[FloatArray, FloatArray]:
        low, high = [], []
        for name, value in zip(self.names, start[:-1].tolist(), strict=True):
            if name in EXPONENTS:
                pair = EXPONENTS[name]
            elif name == "drive_speed":
                pair = (value - _ASTRAY, value + _ASTRAY)
            elif name in _SPEEDS:
                least, most = _SPEEDS[name]
                pair = (np.log(self.drive_speed * least), np.log(self.drive_speed * most))
            else:
                pair = (value - np.log(_REACH), value + np.log(_REACH))
            low.append(pair[0])
            high.append(pair[1])
        return np.array([*low, -0.5]), np.array([*high, 0.5])

    def _solved(self, start: FloatArray, fixed: int | None = None) -> tuple[FloatArray, float]:
        """Values and chi-square from ``start``, with the value of index ``fixed`` held."""
        inside = np.clip(start, self.low + 1e-6, self.high - 1e-6)
        free = np.arange(inside.size) != fixed

        def residuals(some: FloatArray) -> FloatArray:
            values = inside.copy()
            values[free] = some
            return self.residuals(values)

        result = optimize.least_squares(
            residuals,
            inside[free],
            bounds=(self.low[free], self.high[free]),
            x_scale="jac",
            diff_step=[_STEP],
            max_nfev=60 if fixed is None else 15,
            xtol=1e-8,
            ftol=1e-8,
        )
        values = inside.copy()
        values[free] = result.x
        return values, 2.0 * float(result.cost)

    def parameters(self, values: FloatArray) -> dict[str, float]:
        """All parameters by name."""
        fitted = {
            name: float(value if name in EXPONENTS else np.exp(value))
            for name, value in zip(self.names, values[:-1].tolist(), strict=True)
        }
        return {name: self.known[name] if name in self.known else fitted[name] for name in PARAMETERS}

    def _lap(self, values: FloatArray) -> ModelLap | None:
        parameters = self.parameters(values)
        try:
            drag = Drag(*(parameters[name] for name in OF_THE_BELT[2:]), closure=self.closure)
        except ParameterError:
            return None
        train = Drivetrain(parameters["stiffness"], parameters["mass"])
        return model_lap(train, drag, parameters["drive_speed"])

    def curve(self, values: FloatArray) -> FloatArray:
        """The model at the points of the mean cycle; its mean where the model has no cycle."""
        lap = self._lap(values)
        if lap is None:
            return np.full(self.wave.offset.shape, np.nan)
        return lap.at(self.wave.offset + values[-1] * self.fall)

    def residuals(self, values: FloatArray) -> FloatArray:
        """Weighted differences of the mean cycle, of the period, and last of the drive speed."""
        lap = self._lap(values)
        if lap is None:
            return np.full(self.wave.offset.size + 2, _NO_CYCLE)
        curve = lap.at(self.wave.offset + values[-1] * self.fall)
        wave = (curve - self.wave.force) / self.wave.error
        speed = self.prior * (values[-2] - np.log(self.drive_speed))
        return np.append(wave, [(lap.period - self.period) / self.period_error, speed])

    def jacobian(self) -> FloatArray:
        """Central differences at the solution, shape (points + 2, values)."""
        columns = []
        for index in range(self.values.size):
            step = np.zeros(self.values.size)
            step[index] = 5 * _STEP
            ends = self.residuals(self.values + step), self.residuals(self.values - step)
            columns.append((ends[0] - ends[1]) / (10 * _STEP))
        return np.stack(columns, axis=1)

    @cached_property
    def _inverse(self) -> FloatArray:
        """What the values change by with each residual, shape (values, points + 2)."""
        left, singular, right = np.linalg.svd(self.jacobian(), full_matrices=False)
        return np.asarray((right.T / np.maximum(singular, 1e-9 * singular[0])) @ left.T)

    def by_drive_speed(self) -> FloatArray:
        """What one standard error of the stated drive speed changes the values by (without the shift)."""
        return np.asarray(self._inverse[:-1, -1] * self.prior * self.stated_error)

    def covariance(self, scale: float) -> FloatArray:
        """Covariance of the values (without the shift) from the scatter of the laps and the misfit.

        What the stated drive speed leaves open is common to all laps and not in it: see `by_drive_speed`.
        """
        inverse = self._inverse[:, :-1]
        laps = np.nan_to_num((self.wave.laps - self.wave.force) / self.wave.error)
        period = np.nan_to_num((self.wave.period - self.period) / self.period_error)
        changes = np.column_stack([laps, period]) @ inverse.T
        number = changes.shape[0]
        scatter = changes.T @ changes / (number * (number - 1))
        white = inverse @ inverse.T
        both = np.maximum(np.diag(scatter), np.diag(white) * scale)
        widened = np.sqrt(both / np.maximum(np.diag(scatter), 1e-300))
        level = np.append(self._level_error() / self.wave.error, 0.0) @ inverse.T
        return np.asarray((scatter * np.outer(widened, widened) + np.outer(level, level))[:-1, :-1])

    def _level_error(self) -> float:
        """What a drift leaves open about the level: the zero held at some unknown moment of the trace."""
        return abs(self.record.drift) * float(np.ptp(self.record.slip_time)) / 2.0

    def held_slope(self) -> HeldSlope | None:
        """Return the slope of the force of a held belt; None if too few points of the mean lap see it."""
        curve, offset = self.curve(self.values), self.wave.offset
        steep = np.gradient(curve, offset)
        runs = runs_of_true(steep > _HELD * float(np.max(steep)))
        held = slice(*max(runs, key=lambda run: run[1] - run[0]))
        laps = self.wave.laps[:, held]
        laps = laps[np.all(np.isfinite(laps), axis=1)]
        if laps.shape[1] < _FEWEST_POINTS or laps.shape[0] < FEWEST_LAPS:
            return None
        lever = offset[held] - np.mean(offset[held])
        slopes = laps @ lever / float(lever @ lever)
        parameters = self.parameters(self.values)
        loading = parameters["stiffness"] * parameters["drive_speed"]
        followed = float(lever @ curve[held]) / float(lever @ lever) / loading
        error = float(np.std(slopes, ddof=1)) / float(np.sqrt(slopes.size))
        return HeldSlope(float(np.mean(slopes)), error, followed)

    def errors(self, covariance: FloatArray) -> FloatArray:
        """Standard errors of the logarithms of the parameters; of exponents, their own."""
        return np.sqrt(np.maximum(np.diag(covariance), 0.0))

    def at_bound(self, index: int) -> bool:
        """Whether a value came to rest at the end of what is believed."""
        value = self.values[index]
        return bool(min(value - self.low[index], self.high[index] - value) < _AT_BOUND)

    def alternatives(self, covariance: FloatArray, scale: float) -> list[Alternative]:
        """Other values that fit about as well: each badly known one is moved, and the rest fitted anew.

        A parameter that the record hardly tells lies on a long ridge of nearly equal fits, and along it
        others change too, by more than a straight line would say.
        """
        alternatives = []
        errors = self.errors(covariance)
        for index, name in enumerate(self.names):
            if name == "drive_speed" or (errors[index] < ESTIMABLE and not self.at_bound(index)):
                continue
            moves = EXPONENT_MOVES if name in EXPONENTS else MOVES
            for side in (-1.0, 1.0):
                alternatives += self._ridge(index, [side * move for move in moves], covariance, scale)
        return alternatives

    def _ridge(
        self, index: int, moves: list[float], covariance: FloatArray, scale: float
    ) -> list[Alternative]:
        """Fits that are alike with one value moved farther and farther, and where between two that ends."""
        alike: list[Alternative] = []
        reached, beyond, ahead, halvings = 0.0, None, list(moves), _HALVINGS
        while ahead:
            start = self._moved(index, ahead[0], covariance)
            if start is None:
                break
            values, chi_square = self._solved(start, fixed=index)
            share = (chi_square - self.chi_square) / scale / ALIKE
            if share < 1.0:
                alike.append(Alternative(values, max(share, 0.0)))
                reached = ahead.pop(0)
            else:
                beyond, ahead = ahead[0], []
            if beyond is not None and halvings:
                ahead, halvings = [0.5 * (reached + beyond)], halvings - 1
        return alike

    def _moved(self, index: int, move: float, covariance: FloatArray) -> FloatArray | None:
        """A start with one value moved, the others along the ridge; None where a bound is in the way."""
        variance = covariance[index, index]
        target = float(np.clip(self.values[index] + move, self.low[index], self.high[index]))
        step = target - self.values[index]
        if abs(step) < 0.1 * abs(move):
            return None
        start = self.values.copy()
        if 0 < variance < _STRAIGHT:
            start[:-1] += covariance[:, index] / variance * step
        start[index] = target
        return start
