"""Logs of a bench made by formula, with one stated error structure each: what `hersey` must not be misled by.

Independent of the package: torque = LEVEL (T/100 degC)^B (w/1 rad/s)^(1 + C), as the sensors read it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import polars as pl

import hersey

#: The law behind every log: torque at 1 rad/s and 100 degC, N m, and the exponents of damping.
LEVEL, B, C = 0.5, -1.2, -0.595
#: Speeds of a sweep, rpm, and temperatures, degC.
RPM = tuple(np.geomspace(4.0, 160.0, 8))
CELSIUS = (90.0, 120.0, 150.0, 180.0)


@dataclass(frozen=True)
class Bench:
    """How a log is recorded, and what is wrong with it."""

    rpm: tuple[float, ...] = RPM
    celsius: tuple[float, ...] = (*CELSIUS, CELSIUS[0])  #: in this order, a visit each
    sweep: str = "up and down"  #: or ``up``, ``down``
    dwell: float = 20.0  #: s
    standing: float = 10.0  #: s, at the start and the end
    rate: float = 10.0  #: Hz
    noise: float = 0.004  #: of torque, relative, white
    noise_torque: float = 0.0  #: of torque, N m, white
    spread: float = 0.4  #: of ln torque from seed to seed, so that other readings fall on the steps
    zero: float = 0.012  #: offset of the torque sensor, N m
    visit_scatter: float = 0.004  #: of torque, relative, common to a visit
    gain: float = 1.0  #: of the torque sensor
    hysteresis: float = 0.0  #: of the torque sensor, as share of its span: up against down
    span: float = 1.0  #: of the torque sensor over the largest torque
    relaxing: float = 0.0  #: share of a change of torque that is late
    relaxation: float = 60.0  #: s
    heat: float = 5.0  #: time constant of the bath after a step of temperature, s
    soak: float = 60.0  #: at half the least speed after a step of temperature, s
    lag: float = 0.0  #: of the temperature sensor, s
    step: float = 0.0  #: of the torque as recorded, N m
    bits: int = 0  #: of the torque as recorded, over the range of the log

    def frame(self, seed: int) -> pl.DataFrame:
        """Return the log as read: time (s), speed (rpm), torque (N m), temperature (degC)."""
        rng = np.random.default_rng(seed)
        held, hot, lasting = self._course()
        count = [round(each * self.rate) for each in lasting]
        rpm = np.repeat(held, count)
        time = np.arange(rpm.size) / self.rate
        bath = self._bath(np.repeat(hot, count))
        since = np.concatenate([np.arange(each) / self.rate for each in count])
        torque = self._torque(rpm, bath, since, np.repeat(np.arange(len(count)), count))
        torque *= np.exp(self._scatter(hot, count, rng)) * self.gain
        torque *= 1.0 + self.noise * rng.standard_normal(torque.size)
        torque *= np.exp(self.spread * (rng.random() - 0.5))
        torque += self.noise_torque * rng.standard_normal(torque.size) + self.zero
        torque = self._played(torque)
        read = _lagged(bath, self.lag, self.rate) + 0.05 * rng.standard_normal(bath.size)
        return pl.DataFrame(
            {
                "time [s]": time,
                "speed [rpm]": rpm * (1.0 + 1e-4 * rng.standard_normal(rpm.size)),
                "torque [N*m]": self._coarse(torque),
                "temperature [degC]": read,
            }
        )

    def log(self, seed: int) -> hersey.TorqueLog:
        return hersey.read(self.frame(seed))

    def points(self, seed: int) -> hersey.SteadyPoints:
        return self.log(seed).steady(tare="standing")

    def _course(self) -> tuple[list[float], list[float], list[float]]:
        """Speed, set temperature and duration of each stretch."""
        up = list(self.rpm)
        sweeps = {"up": up, "down": up[::-1], "up and down": [*up, *up[-2::-1]]}
        held, hot, lasting = [0.0], [self.celsius[0]], [self.standing]
        for celsius in self.celsius:
            if self.soak:
                held, hot, lasting = [*held, 0.5 * up[0]], [*hot, celsius], [*lasting, self.soak]
            for rpm in sweeps[self.sweep]:
                held, hot, lasting = [*held, rpm], [*hot, celsius], [*lasting, self.dwell]
        return [*held, 0.0], [*hot, hot[-1]], [*lasting, self.standing]

    def _bath(self, target: np.ndarray) -> np.ndarray:
        return _lagged(target, self.heat, self.rate)

    def _torque(
        self, rpm: np.ndarray, celsius: np.ndarray, since: np.ndarray, stretch: np.ndarray
    ) -> np.ndarray:
        omega = rpm * np.pi / 30.0
        steady = LEVEL * (celsius / 100.0) ** B * omega ** (1.0 + C)
        if not self.relaxing:
            return np.asarray(steady)
        start = np.searchsorted(stretch, stretch)
        before = steady[np.maximum(start - 1, 0)]
        late = self.relaxing * (before - steady[start]) * np.exp(-since / self.relaxation)
        return np.asarray(steady + np.where((rpm > 0) & (before > 0), late, 0.0))

    def _scatter(self, hot: list[float], count: list[int], rng: np.random.Generator) -> np.ndarray:
        visit = np.cumsum(np.append(0, np.diff(hot) != 0))
        return np.repeat((self.visit_scatter * rng.standard_normal(visit.max() + 1))[visit], count)

    def _played(self, torque: np.ndarray) -> np.ndarray:
        """What a sensor with play reads: late by half its hysteresis in either direction."""
        half = 0.5 * self.hysteresis * self.span * float(np.max(torque))
        if not half:
            return torque
        out, last = np.empty_like(torque), float(torque[0])
        for row, each in enumerate(torque):
            last = min(max(last, each - half), each + half)
            out[row] = last
        return out

    def _coarse(self, torque: np.ndarray) -> np.ndarray:
        step = self.step
        if self.bits:
            step = float(np.ptp(torque)) / (2**self.bits - 1)
        return np.round(torque / step) * step if step else torque


def _lagged(values: np.ndarray, lag: float, rate: float) -> np.ndarray:
    """What follows with a first-order lag, s."""
    if not lag:
        return values
    share, out, last = 1.0 - np.exp(-1.0 / (lag * rate)), np.empty_like(values), float(values[0])
    for row, each in enumerate(values):
        last += share * (each - last)
        out[row] = last
    return out
