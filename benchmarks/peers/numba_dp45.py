"""Dormand and Prince's pair written by hand, compiled by numba, with located events."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

V_S, EHL, MIXED = 0.01, 0.3, -0.2
STUCK, MICRO, SLOW, FAST = 0, 1, 2, 3
#: Right-hand sides per step tried.
STAGES = 7


@njit(cache=False, fastmath=False)
def _force(mode: int, v: float, b0: float, a: float) -> float:
    if mode == FAST:
        return b0 * v**EHL
    if mode == SLOW:
        return b0 * v**MIXED
    return a * math.exp(-v / V_S)


@njit
def _step(mode, s, v, h, k, b0, a, v2):  # type: ignore[no-untyped-def]
    f = _force
    k1 = k * s - f(mode, v, b0, a)
    d1 = v2 - v
    v_ = v + h * 0.2 * k1
    k2 = k * (s + h * 0.2 * d1) - f(mode, v_, b0, a)
    d2 = v2 - v_
    v_ = v + h * (3 / 40 * k1 + 9 / 40 * k2)
    k3 = k * (s + h * (3 / 40 * d1 + 9 / 40 * d2)) - f(mode, v_, b0, a)
    d3 = v2 - v_
    v_ = v + h * (44 / 45 * k1 - 56 / 15 * k2 + 32 / 9 * k3)
    k4 = k * (s + h * (44 / 45 * d1 - 56 / 15 * d2 + 32 / 9 * d3)) - f(mode, v_, b0, a)
    d4 = v2 - v_
    c1, c2, c3, c4 = 19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729
    v_ = v + h * (c1 * k1 + c2 * k2 + c3 * k3 + c4 * k4)
    k5 = k * (s + h * (c1 * d1 + c2 * d2 + c3 * d3 + c4 * d4)) - f(mode, v_, b0, a)
    d5 = v2 - v_
    c1, c2, c3, c4, c5 = 9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656
    v_ = v + h * (c1 * k1 + c2 * k2 + c3 * k3 + c4 * k4 + c5 * k5)
    k6 = k * (s + h * (c1 * d1 + c2 * d2 + c3 * d3 + c4 * d4 + c5 * d5)) - f(mode, v_, b0, a)
    d6 = v2 - v_
    c1, c3, c4, c5, c6 = 35 / 384, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84
    vn = v + h * (c1 * k1 + c3 * k3 + c4 * k4 + c5 * k5 + c6 * k6)
    sn = s + h * (c1 * d1 + c3 * d3 + c4 * d4 + c5 * d5 + c6 * d6)
    k7 = k * sn - f(mode, vn, b0, a)
    d7 = v2 - vn
    e1, e3, e4, e5, e6, e7 = 71 / 57600, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40
    ev = h * (e1 * k1 + e3 * k3 + e4 * k4 + e5 * k5 + e6 * k6 + e7 * k7)
    es = h * (e1 * d1 + e3 * d3 + e4 * d4 + e5 * d5 + e6 * d6 + e7 * d7)
    return sn, vn, es, ev


@njit
def _guard(mode, s, v, k, a):  # type: ignore[no-untyped-def]
    """Positive while the mode lasts."""
    if mode == FAST:
        return v - 1.0
    if mode == SLOW:
        return min(1.0 - v, v - V_S)
    return min(V_S - v, abs(k * s) - a * math.exp(-v / V_S)) if v > 0 else v


@njit
def lap(
    k: float, b0: float, v2: float, duration: float, tolerance: float
) -> tuple[float, float, float, int, float]:
    """Return frequency, greatest speed and stuck share of the last whole lap, steps tried, last release."""
    a = math.e * b0 * V_S**MIXED
    t, s, v, mode = 0.0, 0.0, 0.0, STUCK
    begin, stuck, fastest, steps = -1.0, 0.0, 0.0, 0
    frequency, peak, fraction = 0.0, 0.0, 0.0
    h = 1e-4
    while t < duration:
        if mode == STUCK:
            hold = a * math.exp(-v / V_S)
            wait = (hold / k - s) / (v2 - v)
            t, s, stuck = t + wait, hold / k, stuck + wait
            if t >= duration:
                break
            if begin >= 0:
                frequency, peak, fraction = 1 / (t - begin), fastest, stuck / (t - begin)
            begin, stuck, fastest = t, 0.0, 0.0
            mode = SLOW if v >= V_S else MICRO
            h = 1e-5
            continue
        sn, vn, es, ev = _step(mode, s, v, h, k, b0, a, v2)
        steps += 1
        scale = max(V_S, abs(v))
        error = max(abs(ev) / scale, abs(es) * math.sqrt(k) / max(scale, abs(s) * math.sqrt(k))) / tolerance
        if not error <= 1.0:
            h *= max(0.2, 0.9 * error**-0.2) if error == error else 0.2
            continue
        grown = min(5.0, 0.9 * max(error, 1e-10) ** -0.2)
        end = _guard(mode, sn, vn, k, a)
        if end < 0:
            # regula falsi (Illinois) on the length of the step
            low, high = 0.0, h
            at_low, at_high = max(_guard(mode, s, v, k, a), 1e-300), end
            if at_low <= 1e-9:
                low = 1e-3 * h
                sn, vn, _, _ = _step(mode, s, v, low, k, b0, a, v2)
                at_low = _guard(mode, sn, vn, k, a)
            for _ in range(60):
                middle = (low * at_high - high * at_low) / (at_high - at_low)
                sn, vn, _, _ = _step(mode, s, v, middle, k, b0, a, v2)
                g = _guard(mode, sn, vn, k, a)
                if g > 0:
                    low, at_low, at_high = middle, g, 0.5 * at_high
                else:
                    high, at_high, at_low = middle, g, 0.5 * at_low
                if abs(g) < 1e-14 * max(1.0, abs(k * s)) or high - low < 1e-16:
                    break
            t += middle
            s = sn
            if mode == FAST:
                v, mode = 1.0, SLOW
            elif mode == SLOW and vn > 0.5:
                v, mode = 1.0, FAST
            elif mode == SLOW:
                v = V_S
                mode = STUCK if abs(k * s) <= a / math.e else MICRO
            elif vn > 0.999 * V_S and k * s > 0:
                v, mode = V_S, SLOW
            else:
                v, mode = vn, STUCK
            h = 1e-5 if mode == MICRO else h
            continue
        # the greatest speed lies where the belt turns
        before, after = k * s - _force(mode, v, b0, a), k * sn - _force(mode, vn, b0, a)
        if before > 0 >= after:
            middle = h * before / (before - after)
            for _ in range(3):
                sm, vm, _, _ = _step(mode, s, v, middle, k, b0, a, v2)
                middle += (k * sm - _force(mode, vm, b0, a)) * h / (before - after)
            fastest = max(fastest, vm)
        t, s, v = t + h, sn, vn
        h *= grown
    return frequency, peak, fraction, steps, begin


@njit
def laps(k, b0, v2, duration, tolerance):  # type: ignore[no-untyped-def]
    """Return the laps of many sets, shape (sets, 4)."""
    out = np.empty((k.size, 4))
    for i in range(k.size):
        frequency, peak, fraction, steps, _ = lap(k[i], b0[i], v2[i], duration, tolerance)
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = frequency, peak, fraction, steps
    return out


@njit
def folds(k, b0, runs, duration, tolerance):  # type: ignore[no-untyped-def]
    """Return the fold of each set: the drive speed between 1.01 and 4 is halved ``runs`` times."""
    out = np.empty(k.size)
    for i in range(k.size):
        low, high = 1.01, 4.0
        for _ in range(runs):
            middle = 0.5 * (low + high)
            if lap(k[i], b0[i], middle, duration, tolerance)[4] > 0.5 * duration:
                low = middle
            else:
                high = middle
        out[i] = 0.5 * (low + high)
    return out


@njit
def power_cost(n: int) -> float:
    """Return a sum that needs n powers."""
    total, x = 0.0, 0.5
    for _ in range(n):
        x = x**0.3 + 0.1
        total += x
    return total
