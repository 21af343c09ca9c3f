"""Samples of failures from a generator of its own, and whether what is said of each holds, for `weibull`.

Uniform numbers go through the inverse of each law, written out here.
"""

from __future__ import annotations

import math

import numpy as np

import hersey
from hersey.life.failures.distributions import WEIBULL
from hersey.life.failures.fit import age_held, fitted

#: Specimens of a sample, and the level of two-sided bounds.
SPECIMENS, LEVEL = 10, 0.90
#: Age of the scale of every law.
SCALE = 1000.0
Row = tuple[bool, bool] | None


def ages(random: np.random.Generator, shape: float, count: int) -> np.ndarray:
    """Return ages of a Weibull law."""
    return SCALE * (-np.log(random.uniform(size=count))) ** (1.0 / shape)


def life(share: float, shape: float) -> float:
    """Return the age by which a share has failed."""
    return SCALE * (-math.log(1.0 - share)) ** (1.0 / shape)


def stopped(kind: str, random: np.random.Generator, shape: float) -> tuple[np.ndarray, np.ndarray]:
    """Return ages, and whether they are failures, of a test that ends by a rule."""
    true = ages(random, shape, SPECIMENS)
    if kind == "complete":
        return true, np.ones(SPECIMENS, dtype=bool)
    end = {
        "type II": lambda: np.sort(true)[5],
        "type I": lambda: life(0.6, shape),
        "random": lambda: random.uniform(0.0, 2 * SCALE, SPECIMENS),
    }[kind]()
    return np.minimum(true, end), true <= end


def of_b10(case: tuple[str, float, bool, int]) -> Row:
    """Whether the lower bound of B10 lies above the truth, and the upper one below; None without a law."""
    kind, shape, calibrate, seed = case
    random = np.random.default_rng(seed)
    seen, failed = stopped(kind, random, shape)
    if failed.sum() < 2:
        return None
    # the bounds of `hersey.weibull`, without all else that it answers
    sample = hersey.Failures(seen, np.where(failed, seen, np.inf), np.ones(SPECIMENS, dtype=int))
    low, high = fitted(WEIBULL, sample, calibrated=calibrate, seed=seed).bounds([0.1], LEVEL, age_held)
    truth = math.log(life(0.1, shape))
    return bool(low[0] > truth), bool(high[0] < truth)


def _missed(law: hersey.FailureLaw, truth: float) -> Row:
    if not law.is_known:
        return None
    b10 = law.b_lives[0]
    return b10.low > truth, b10.high < truth


def of_inspections(case: tuple[float, bool, int]) -> Row:
    """The same where 20 specimens are looked at five times."""
    shape, calibrate, seed = case
    random = np.random.default_rng(seed)
    looks = np.array([life(share, shape) for share in (0.1, 0.25, 0.4, 0.55, 0.7)])
    place = np.searchsorted(looks, ages(random, shape, 20))
    low, high = np.append(0.0, looks)[place], np.append(looks, np.inf)[place]
    law = hersey.weibull(
        hersey.Failures(low, high, np.ones(20, dtype=int)), level=LEVEL, calibrate=calibrate, seed=seed
    )
    return _missed(law, life(0.1, shape))


def of_modes(case: tuple[float, float, int]) -> Row:
    """The same where two failure modes end 20 specimens, whichever comes first; up to an age."""
    first, second, seed = case
    random = np.random.default_rng(seed)
    both = np.array([ages(random, first, 20), 1.2 * ages(random, second, 20)])
    end = 1.2 * SCALE
    seen, which = np.minimum(both.min(axis=0), end), both.argmin(axis=0)
    failed = both.min(axis=0) <= end
    names = tuple(f"mode {w}" if f else "" for w, f in zip(which, failed, strict=True))
    sample = hersey.Failures(seen, np.where(failed, seen, np.inf), np.ones(20, dtype=int), "", names)
    law = hersey.weibull(sample, level=LEVEL, seed=seed)
    low, high = 0.0, 10 * SCALE
    for _ in range(80):  # the true B10 of both
        middle = 0.5 * (low + high)
        hazard = (middle / SCALE) ** first + (middle / (1.2 * SCALE)) ** second
        low, high = (middle, high) if hazard < -math.log(0.9) else (low, middle)
    return _missed(law, low)


def of_fleet(case: tuple[float, int]) -> Row:
    """Whether more fail of 400 specimens in service than predicted, and whether fewer."""
    shape, seed = case
    random = np.random.default_rng(seed)
    law = hersey.weibull(*stopped("type I", random, shape), level=LEVEL, seed=seed)
    if not law.is_known:
        return None
    now = random.uniform(0.0, 0.5 * SCALE, 400)
    hazard = (now / SCALE) ** shape - np.log(random.uniform(size=400))
    fails = int((SCALE * hazard ** (1 / shape) <= now + 0.2 * SCALE).sum())
    forecast = hersey.fleet_forecast(law, now, 0.2 * SCALE)
    return forecast.low[-1] > fails, forecast.high[-1] < fails


def of_life(case: tuple[float, int]) -> Row:
    """Whether a specimen of an age fails earlier than predicted, and whether later."""
    shape, seed = case
    random = np.random.default_rng(seed)
    law = hersey.weibull(*stopped("type I", random, shape), level=LEVEL, seed=seed)
    if not law.is_known:
        return None
    now = 0.3 * SCALE
    ahead = SCALE * ((now / SCALE) ** shape - math.log(random.uniform())) ** (1 / shape) - now
    remaining = hersey.remaining_life(law, now)
    return remaining.earliest > ahead, remaining.latest < ahead


def of_stress(case: tuple[float, bool, int]) -> Row:
    """B10 at a load of 1 from 18 specimens at loads of 2, 3 and 4, life as load^-3, up to an age."""
    shape, calibrate, seed = case
    random = np.random.default_rng(seed)
    load = np.repeat([2.0, 3.0, 4.0], 6)
    true = ages(random, shape, 18) * load**-3.0
    end = 0.1 * SCALE
    seen, failed = np.minimum(true, end), true <= end
    sample = hersey.Failures(
        seen, np.where(failed, seen, np.inf), np.ones(18, dtype=int), "", (), load, "N", "power", 1.0
    )
    law = hersey.weibull(sample, level=LEVEL, calibrate=calibrate, seed=seed)
    return _missed(law, life(0.1, shape))
