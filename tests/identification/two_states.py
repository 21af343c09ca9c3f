"""Traces of the two-state equations, integrated with scipy: nothing here comes from hersey.

While the belt slips, s' = v2 - v1 and m v1' = k s - F(v1), F = F_t (v1/v_t)^(1 + n) with n on either side of
the transition. Where v1 falls to v_s it keeps that speed until k s reaches F(v_s): the closure (26)-(27).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

#: Laps after which the cycle is taken as settled, and how nearly it must then close.
_LAPS, _CLOSED = 40, 1e-7


@dataclass(frozen=True)
class Truth:
    """A drive and its speed; the baseline of the paper unless told otherwise."""

    stiffness: float = 1000.0
    mass: float = 1.0
    transition_force: float = 50.0
    transition_speed: float = 1.0
    ehl_exponent: float = -0.7
    mixed_exponent: float = -1.2
    stick_speed: float = 0.01
    drive_speed: float = 1.0

    @property
    def free_period(self) -> float:
        """2 pi sqrt(m/k), s."""
        return float(2.0 * np.pi * np.sqrt(self.mass / self.stiffness))

    def force(self, speed: float) -> float:
        """Drag at a speed of the belt, N."""
        exponent = self.ehl_exponent if speed >= self.transition_speed else self.mixed_exponent
        return float(self.transition_force * (speed / self.transition_speed) ** (1.0 + exponent))

    def lap(self) -> tuple[np.ndarray, np.ndarray]:
        """Time and spring force over one settled lap, from the release on; both without the last point."""
        held = self.force(self.stick_speed)
        begins = held / self.stiffness
        for _ in range(_LAPS):
            slip = self._slip(begins)
            again = (held / self.stiffness - slip.y[0, -1]) / (self.drive_speed - self.stick_speed)
            if again > 0:  # released at one and the same stretch, the next slip is this one
                times = np.concatenate([slip.t, [slip.t[-1] + again]])
                return times, self.stiffness * np.append(slip.y[0], held / self.stiffness)
            begins = slip.y[0, -1]
        raise AssertionError("the cycle does not settle")

    def _slip(self, stretch: float) -> Any:
        """From the release at a stretch until the belt has slowed down to the stick speed."""

        def rates(_: float, state: np.ndarray) -> list[float]:
            speed = max(state[1], 1e-3 * self.stick_speed)
            pull = self.stiffness * state[0]
            return [self.drive_speed - state[1], (pull - self.force(speed)) / self.mass]

        def slowed(_: float, state: np.ndarray) -> float:
            return float(state[1] - self.stick_speed)

        slowed.terminal, slowed.direction = True, -1  # type: ignore[attr-defined]
        start = [stretch, self.stick_speed * (1 + 1e-9)]
        done: Any = solve_ivp(
            rates,
            (0, 20 * self.free_period),
            start,
            events=slowed,
            rtol=1e-9,
            atol=1e-12,
            max_step=self.free_period / 200,
            first_step=1e-6 * self.free_period,
        )
        assert done.t_events[0].size, "it slides on"
        return done

    def trace(
        self, seed: int, *, laps: int = 90, noise: float = 1.0, samples: int = 254
    ) -> tuple[np.ndarray, np.ndarray]:
        """Time and force over so many laps, with white noise (N), at about so many samples per lap."""
        times, force = self.lap()
        at = np.arange(0.0, laps * times[-1], times[-1] / (samples + 0.37))
        white = np.random.default_rng(seed).normal(0.0, noise, at.size)
        return at, np.interp(at % times[-1], times, force) + white
