"""A drive fitted to a mean cycle by least squares, and the other drives that fit nearly as well."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from scipy import optimize

from hersey.arrays import FloatArray
from hersey.errors import ParameterError
from hersey.identification.cycle_record import CycleRecord
from hersey.identification.independence import TOLD
from hersey.identification.waveform import ModelLap, Waveform, model_lap
from hersey.motion.drag import Drag
from hersey.motion.parameters import OF_THE_BELT
from hersey.motion.simulation import Drivetrain

#: Range that is believed: of exponents, and of speeds over the drive speed.
EXPONENTS = {"ehl_exponent": (-0.995, 0.3), "mixed_exponent": (-2.5, -1.005)}
_SPEEDS = {"transition_speed": (1e-2, 30.0), "stick_speed": (1e-5, 0.5)}
#: Others may be this many times more or less than a first estimate.
_REACH = 30.0
#: Residual where the model has no cycle: many times the error of any point.
_NO_CYCLE = 1e3
#: Step of the numerical derivatives, in logarithms.
_STEP = 1e-4
#: Badly known values are moved by these (logarithms, and exponents); fits whose chi-square grows by less than
#: `ALIKE` (over the misfit of the best) are alike at 95 %.
MOVES = (-2.3, -0.7, 0.7, 2.3)
EXPONENT_MOVES = (-0.4, -0.15, 0.15, 0.4)
ALIKE = 3.84
#: A value this near its bound is at it; a variance beyond this gives no direction.
_AT_BOUND = 1e-3
_STRAIGHT = 100.0
#: First estimates: transition speed over drive speed, stick speed over transition speed; tried in turn
_STARTS = ((1.0, 0.01), (0.6, 0.1), (2.0, 0.003))
#: until chi-square per point is below this; the best is started again until it gains less than `_SETTLED`.
_GOOD = 2.0
_POLISH = 4
_SETTLED = 0.05


class DriveFit:
    """Least squares with one closure; values are logarithms, exponents themselves, and last a time shift."""

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
        self.names = tuple(name for name in OF_THE_BELT if name not in known)
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
        for _ in range(_POLISH):
            values, chi_square = self._solved(self.values)
            gained = self.chi_square - chi_square
            if gained > 0:
                self.values, self.chi_square = values, chi_square
            if gained < _SETTLED:
                break
        self.lap = self._lap(self.values)
        self.misfit = float(np.sqrt(np.mean((self.curve(self.values) - wave.force) ** 2))) / self.drop

    def _start(self, transition: float, stick: float) -> FloatArray:
        """First estimates from the figures of the cycles, and two ratios of speeds."""
        record, speed = self.record, self.drive_speed
        stiffness = self.known.get("stiffness", record.loading_slope / speed)
        top, bottom = float(np.median(record.force_max)), float(np.median(record.force_min))
        first = {
            "stiffness": stiffness,
            "mass": stiffness * (record.free_period / (2.0 * np.pi)) ** 2,
            "transition_force": max(0.5 * (top + bottom), 0.05 * top),
            "transition_speed": transition * speed,
            "ehl_exponent": -0.7,
            "mixed_exponent": -1.2,
            "stick_speed": stick * transition * speed,
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
            elif name in _SPEEDS:
                least, most = _SPEEDS[name]
                pair = (np.log(self.drive_speed * least), np.log(self.drive_speed * most))
            else:
                pair = (value - np.log(_REACH), value + np.log(_REACH))
            low.append(pair[0])
            high.append(pair[1])
        return np.array([*low, -0.5]), np.array([*high, 0.5])

    def _solved(self, start: FloatArray, fixed: int | None = None) -> tuple[FloatArray, float]:
        """Values and chi-square from ``start``, with one value held if so told."""
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
        return {name: self.known[name] if name in self.known else fitted[name] for name in OF_THE_BELT}

    def _lap(self, values: FloatArray) -> ModelLap | None:
        parameters = self.parameters(values)
        try:
            drag = Drag(**{name: parameters[name] for name in OF_THE_BELT[2:]}, closure=self.closure)
        except ParameterError:
            return None
        return model_lap(Drivetrain(parameters["stiffness"], parameters["mass"]), drag, self.drive_speed)

    def curve(self, values: FloatArray) -> FloatArray:
        """The model at the points of the mean cycle; its mean where the model has no cycle."""
        lap = self._lap(values)
        if lap is None:
            return np.full(self.wave.offset.shape, np.nan)
        return lap.at(self.wave.offset + values[-1] * self.fall)

    def residuals(self, values: FloatArray) -> FloatArray:
        """Weighted differences of the mean cycle, and of the period last."""
        lap = self._lap(values)
        if lap is None:
            return np.full(self.wave.offset.size + 1, _NO_CYCLE)
        curve = lap.at(self.wave.offset + values[-1] * self.fall)
        wave = (curve - self.wave.force) / self.wave.error
        return np.append(wave, (lap.period - self.period) / self.period_error)

    def jacobian(self) -> FloatArray:
        """Central differences at the solution, shape (points + 1, values)."""
        columns = []
        for index in range(self.values.size):
            step = np.zeros(self.values.size)
            step[index] = 5 * _STEP
            ends = self.residuals(self.values + step), self.residuals(self.values - step)
            columns.append((ends[0] - ends[1]) / (10 * _STEP))
        return np.stack(columns, axis=1)

    def covariance(self, scale: float) -> FloatArray:
        """Covariance of the values (without the shift) from the scatter of the laps and the misfit."""
        jacobian = self.jacobian()
        left, singular, right = np.linalg.svd(jacobian, full_matrices=False)
        inverse = (right.T / np.maximum(singular, 1e-9 * singular[0])) @ left.T
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

    def errors(self, covariance: FloatArray) -> FloatArray:
        """Standard errors of the logarithms of the parameters; of exponents, their own."""
        return np.sqrt(np.maximum(np.diag(covariance), 0.0))

    def at_bound(self, index: int) -> bool:
        """Whether a value came to rest at the end of what is believed."""
        value = self.values[index]
        return bool(min(value - self.low[index], self.high[index] - value) < _AT_BOUND)

    def alternatives(self, covariance: FloatArray, scale: float) -> list[FloatArray]:
        """Other values that fit about as well: each badly known one is moved, and the rest fitted anew.

        A parameter that the record hardly tells lies on a long ridge of nearly equal fits, and along it
        others change too, by more than a straight line would say.
        """
        alternatives = []
        errors = self.errors(covariance)
        for index, name in enumerate(self.names):
            if errors[index] < TOLD and not self.at_bound(index):
                continue
            for start in self._moved(index, EXPONENT_MOVES if name in EXPONENTS else MOVES, covariance):
                values, chi_square = self._solved(start, fixed=index)
                if (chi_square - self.chi_square) / scale < ALIKE:
                    alternatives.append(values)
        return alternatives

    def _moved(self, index: int, moves: tuple[float, ...], covariance: FloatArray) -> Iterator[FloatArray]:
        """Starts with one value moved, and the others along the ridge."""
        variance = covariance[index, index]
        for move in moves:
            target = float(np.clip(self.values[index] + move, self.low[index], self.high[index]))
            step = target - self.values[index]
            if abs(step) < 0.1 * abs(move):
                continue
            start = self.values.copy()
            if 0 < variance < _STRAIGHT:
                start[:-1] += covariance[:, index] / variance * step
            start[index] = target
            yield start
