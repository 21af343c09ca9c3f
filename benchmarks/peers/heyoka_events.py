"""heyoka's adaptive Taylor integrator with terminal events, one compiled integrator per mode."""

from __future__ import annotations

import math

import heyoka as hy
import numpy as np

V_S = 0.01


class Belt:
    """Integrators of the three slipping modes, compiled once: k, B0 and v2 are parameters."""

    def __init__(self, tolerance: float) -> None:
        s, v = hy.make_vars("s", "v")
        k, b0, v2, a = (hy.par[i] for i in range(4))
        laws = {"fast": b0 * v**0.3, "slow": b0 * v**-0.2, "micro": a * hy.exp(-v / V_S)}
        up, down = hy.event_direction.positive, hy.event_direction.negative
        ends = {
            "fast": [hy.t_event(v - 1.0, direction=down)],
            "slow": [hy.t_event(v - 1.0, direction=up), hy.t_event(v - V_S, direction=down)],
            "micro": [hy.t_event(v - V_S, direction=up), hy.t_event(-k * s - laws["micro"], direction=down)],
        }
        self.fastest = 0.0

        def note(ta: hy.taylor_adaptive, time: float, _: int) -> None:
            ta.update_d_output(time)
            self.fastest = max(self.fastest, float(ta.d_output[1]))

        self.integrators = {
            mode: hy.taylor_adaptive(
                [(s, v2 - v), (v, k * s - law)],
                [0.1, 1.0],
                pars=[1000.0, 50.0, 1.0, 341.4][: 4 if mode == "micro" else 3],
                tol=tolerance,
                t_events=ends[mode],
                nt_events=[hy.nt_event(k * s - law, callback=note, direction=down)],
            )
            for mode, law in laws.items()
        }

    def lap(self, k: float, b0: float, v2: float, duration: float) -> tuple[float, float, float]:
        """Return frequency, greatest speed and stuck fraction of the last whole lap."""
        a = math.e * b0 * V_S**-0.2
        for integrator in self.integrators.values():
            integrator.pars[:] = [k, b0, v2, a][: len(integrator.pars)]
        t, s, v, mode = 0.0, 0.0, 0.0, "stuck"
        begin, stuck, last = None, 0.0, (0.0, 0.0, 0.0)
        while t < duration:
            if mode == "stuck":
                wait = (a * math.exp(-v / V_S) / k - s) / (v2 - v)
                t, s, stuck = t + wait, s + (v2 - v) * wait, stuck + wait
                if wait <= 0:
                    return math.nan, math.nan, math.nan
                if begin is not None and t < duration:
                    last = 1 / (t - begin), self.fastest, stuck / (t - begin)
                begin, stuck, self.fastest = t, 0.0, 0.0
                mode = "slow" if v >= V_S else "micro"
                v *= 1 + 1e-12  # on its guard exactly an integrator may see the event again
                continue
            ta = self.integrators[mode]
            ta.time = t
            ta.state[:] = [s, v]
            ta.reset_cooldowns()
            outcome = ta.propagate_until(duration)[0]
            t, s, v = float(ta.time), float(ta.state[0]), float(ta.state[1])
            if outcome == hy.taylor_outcome.time_limit:
                break
            hit = -int(outcome) - 1
            if mode == "fast":
                mode, v = "slow", 1.0 - 1e-12
            elif mode == "slow" and hit == 0:
                mode, v = "fast", 1.0 + 1e-12
            elif mode == "slow":
                v = V_S
                mode = "stuck" if abs(k * s) <= a / math.e else "micro"
            elif hit == 0:
                mode, v = "slow", V_S * (1 + 1e-12)
            else:
                mode = "stuck"
        return last

    def laps(self, k: np.ndarray, b0: np.ndarray, v2: np.ndarray, duration: float) -> np.ndarray:
        """Return the laps of many sets, shape (sets, 3)."""
        return np.array([self.lap(*row, duration) for row in zip(k, b0, v2, strict=True)])
