"""scipy's solve_ivp with terminal events."""

from __future__ import annotations

import math

from scipy.integrate import solve_ivp

V_S = 0.01


def lap(
    k: float, b0: float, v2: float, duration: float, method: str, tolerance: float
) -> tuple[float, float, float, float]:
    """Return frequency, greatest speed and stuck fraction of the last whole lap, and the last release."""
    a = math.e * b0 * V_S**-0.2
    laws = {
        "fast": lambda v: b0 * max(v, 1e-6) ** 0.3,
        "slow": lambda v: b0 * max(v, 1e-6) ** -0.2,
        "micro": lambda v: a * math.exp(-v / V_S),
    }
    down = lambda limit: _event(lambda t, y: y[1] - limit, -1)  # noqa: E731
    up = lambda limit: _event(lambda t, y: y[1] - limit, 1)  # noqa: E731
    held = _event(lambda t, y: abs(k * y[0]) - a * math.exp(-y[1] / V_S), -1)
    ends = {"fast": [down(1.0)], "slow": [up(1.0), down(V_S)], "micro": [up(V_S), held]}
    t, s, v, mode = 0.0, 0.0, 0.0, "stuck"
    begin, stuck, fastest, last = None, 0.0, 0.0, (0.0, 0.0, 0.0, 0.0)
    while t < duration:
        if mode == "stuck":
            wait = (a * math.exp(-v / V_S) / k - s) / (v2 - v)
            t, s, stuck = t + wait, s + (v2 - v) * wait, stuck + wait
            if begin is not None and t < duration:
                last = 1 / (t - begin), fastest, stuck / (t - begin), t
            begin, stuck, fastest = t, 0.0, 0.0
            mode = "slow" if v >= V_S else "micro"
            continue
        law = laws[mode]
        turning = _event(lambda t, y, law=law: k * y[0] - law(y[1]), -1, terminal=False)
        run = solve_ivp(
            lambda t, y, law=law: (v2 - y[1], k * y[0] - law(y[1])),
            (t, duration),
            (s, v),
            method=method,
            rtol=tolerance,
            atol=tolerance * 1e-3,
            events=[*ends[mode], turning],
            first_step=1e-6 if mode != "fast" else None,
        )
        for y in run.y_events[-1]:
            fastest = max(fastest, float(y[1]))
        t, (s, v) = float(run.t[-1]), (float(x) for x in run.y[:, -1])
        if run.status != 1:
            break
        hit = [len(times) > 0 for times in run.t_events]
        if mode == "fast":
            mode, v = "slow", 1.0
        elif mode == "slow" and hit[0]:
            mode, v = "fast", 1.0
        elif mode == "slow":
            v = V_S
            mode = "stuck" if abs(k * s) <= a / math.e else "micro"
        elif hit[0]:
            mode, v = "slow", V_S
        else:
            mode = "stuck"
    return last


def _event(function, direction, terminal=True):  # type: ignore[no-untyped-def]
    function.direction, function.terminal = direction, terminal
    return function
