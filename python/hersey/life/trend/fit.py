"""Friction over time, distance or revolutions at one speed: the law, the steady value and its age."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hersey.arguments.door import Words
from hersey.arrays import FloatArray, one_thread
from hersey.damping.candidates.likelihood import EVIDENCE
from hersey.errors import ParameterError
from hersey.life.trend.comparing import PARTS, WARM, Data, Draws, Fitted, effective_rows
from hersey.life.trend.doubts import doubts_of
from hersey.life.trend.jumps import with_jumps
from hersey.life.trend.record import AGES, Record, record_of
from hersey.life.trend.result import FrictionTrend, Jump, TrendLaw
from hersey.life.trend.said import (
    Weighed,
    interval,
    jump_heights,
    last_rate,
    steady_ages,
    time_constants,
    weighed,
)
from hersey.life.trend.shapes import shapes
from hersey.log.torque_log import TorqueLog
from hersey.units import argument, takes_si

#: Blocks that the fastest change that shows must last.
_FASTEST = 1.5
#: Weight that laws with a steady value must have, and greatest half width of its interval, as a share.
_SETTLED, _KNOWN = 0.5, 0.25
_BY = Words(tuple(AGES))


@one_thread()
@takes_si(by=_BY, radius="length")
def trend(
    log: TorqueLog,
    *,
    by: str = "time",
    at: Any = None,
    radius: float | None = None,
    share: float = 0.05,
    seed: int = 1,
) -> FrictionTrend:
    """Follow friction over time, distance or revolutions at one speed: run-in, growth, steady value.

    The laws of growth, up or down, are compared by AICc. Their noise may wander: its correlation time is
    estimated with them, and the intervals count it. What is said is averaged over the laws that fit. No
    trend is claimed unless a law beats a constant, and a constant with temperature, by 6 in AICc.

    Parameters
    ----------
    log
        From `hersey.read`.
    by
        What age is counted in while the drive turns: ``time``, ``distance`` or ``revolutions``.
    at
        Speed whose rows are used, rad/s, or m/s if the log has a sliding speed. Default: the only one.
    radius
        Radius of the track, m: for a distance at a speed of rotation, or revolutions at a sliding speed.
    share
        Friction is steady once it stays within this share of its steady value.
    seed
        Random seed; the same data and seed give the same result.

    Raises
    ------
    InsufficientDataError
        If the log has several speeds, too few rows at one, or a torque that never changes.
    ParameterError
        If a parameter is out of range, or a radius that is needed is missing.
    """
    if not 0.0 < share < 1.0:
        raise ParameterError(f"share is {share}: it must be between 0 and 1", value=share)
    at = argument("at", "speed" if log.domain.speed == "speed" else "belt speed", at, one=True)
    if at is not None and not (np.isfinite(at) and at != 0.0):
        raise ParameterError(f"the speed to follow is {at}: it must not be 0", value=at)
    if radius is not None and not (np.isfinite(radius) and radius > 0.0):
        raise ParameterError(f"the radius is {radius}: it must be greater than 0", value=radius)
    return trend_of(record_of(log, by, at, radius), by=by, share=share, seed=seed)


@dataclass(frozen=True)
class _Laws:
    """Every law that was fitted, the likeliest first, with what it ranks by."""

    fits: tuple[Fitted, ...]

    @property
    def ranks(self) -> FloatArray:
        return np.array([each.rank for each in self.fits])

    @property
    def weights(self) -> FloatArray:
        return np.asarray(np.exp(-0.5 * (self.ranks - self.ranks.min())))

    def some(self, kept: list[bool]) -> _Laws:
        return _Laws(tuple(f for f, k in zip(self.fits, kept, strict=True) if k))


def trend_of(record: Record, *, by: str = "time", share: float = 0.05, seed: int = 1) -> FrictionTrend:
    """Return the trend of a record: see `trend`."""
    whole = Data.of(record)
    every = with_jumps(shapes(_fastest(whole)), whole, _causes(record.temperature))
    data = every[0].data
    laws = _Laws(tuple(sorted(every, key=lambda each: each.rank)))
    growing = [each.shape.law.grows for each in laws.fits]
    constants = laws.some([not each for each in growing])
    changing = bool(constants.ranks[0] - laws.ranks[0] > EVIDENCE)
    fitting = laws.some(growing) if changing else constants
    random = np.random.default_rng(seed)
    found = weighed(fitting.fits, fitting.weights, random)
    numbers = _numbers(found, fitting, share, random)
    if not changing:  # what a drift could still be
        drifts = laws.some([each.shape.name == "linear" for each in laws.fits])
        numbers["rate"] = interval(last_rate(weighed(drifts.fits, drifts.weights, random)) / data.scale)
    best = fitting.fits[0]
    kind = _kind(best, found, changing)
    jumps = _jumps(found, record)
    doubts = doubts_of(record, data, fitting.fits, fitting.weights, numbers, jumps, changing, by)
    scaled = data.age
    low, middle, high = np.quantile(found.curves(scaled), [0.025, 0.5, 0.975], axis=0)
    return FrictionTrend(
        domain=record.domain,
        by=by,
        age_unit=AGES[by],
        speed=record.speed,
        last_age=float(record.age[-1]),
        rows=record.value.size,
        effective_rows=effective_rows(best),
        correlation_time=float(data.noise.time[best.best[0]]) if data.noise.ratio[best.best[0]] else 0.0,
        kind=kind,
        laws=_compared(laws),
        share=share,
        **numbers,
        jumps=jumps,
        warnings=doubts,
        age=data.blocks.age,
        value=data.blocks.value,
        fitted=middle,
        low=low,
        high=high,
    )


def _causes(kelvin: FloatArray | None) -> tuple[bool, ...]:
    """Whether temperature is left out, or tried, too, as a cause: it is if it changed."""
    if kelvin is None:
        return (False,)
    means = [float(part.mean()) for part in np.array_split(kelvin, PARTS)]
    return (False, True) if max(means) - min(means) >= WARM else (False,)


def _fastest(data: Data) -> float:
    return _FASTEST * float(data.age[1] - data.age[0])


def _numbers(found: Weighed, laws: _Laws, share: float, random: np.random.Generator) -> dict[str, Any]:
    """Value at begin and end, rate, temperature; steady value, its age and the time constant where known."""
    scale = found.data.scale
    first, last = found.curves(np.array([found.data.start, 1.0])).T
    numbers: dict[str, Any] = {
        "first": interval(first),
        "last": interval(last),
        "rate": interval(last_rate(found) / scale),
        "per_kelvin": _per_kelvin(found),
        "steady": None,
        "steady_age": None,
        "time_constant": None,
    }
    settles = [each.shape.settles for each in laws.fits]
    weight = float(laws.weights[np.array(settles)].sum() / laws.weights.sum())
    if weight < _SETTLED:
        return numbers
    settling = laws.some(settles)
    drawn = weighed(settling.fits, settling.weights, random)
    steady = interval(drawn.of_each(Draws.steady))
    if 0.5 * (steady.high - steady.low) > _KNOWN * abs(steady.value):
        return numbers
    numbers |= {"steady": steady, "steady_age": interval(scale * steady_ages(drawn, share, random))}
    if settling.fits[0].shape.varied:
        numbers["time_constant"] = interval(scale * time_constants(drawn))
    return numbers


def _per_kelvin(found: Weighed) -> Any:
    """How much friction changes per K, if the likeliest law has temperature as a cause."""
    if not found.draws[0].fitted.warm:
        return None
    return interval(np.concatenate([each.per_kelvin() for each in found.draws if each.fitted.warm]))


def _kind(best: Fitted, found: Weighed, changing: bool) -> str:
    """What friction does, by the likeliest law."""
    if not changing:
        return "constant"
    middle = np.median(found.draws[0].linear, axis=0)
    last, shape = float(middle[-1]), best.shape
    first = -float(middle[1]) if shape.meets else last
    if shape.drifts:
        last = float(middle[1])
    moves = ["rises" if each > 0.0 else "falls" for each in (first, last)]
    return " then ".join(dict.fromkeys(moves)) + (" and settles" if shape.settles else "")


def _jumps(found: Weighed, record: Record) -> tuple[Jump, ...]:
    if not found.jumps.size:
        return ()
    heights = jump_heights(found)
    scale = found.data.scale
    ages, gaps = scale * found.jumps, scale * found.gaps
    return tuple(
        Jump(
            float(age),
            interval(heights[:, i]),
            bool(np.any(np.abs(record.restarts - age) <= 2.0 * gap)),
            bool(np.any(np.abs(record.turns - age) <= 2.0 * gap)),
        )
        for i, (age, gap) in enumerate(zip(ages, gaps, strict=True))
    )


def _compared(laws: _Laws) -> tuple[TrendLaw, ...]:
    """Every law with its weight, the likeliest first: without and with temperature, taken together."""
    weights = laws.weights / laws.weights.sum()
    found: dict[str, TrendLaw] = {}
    for fit, rank, weight in zip(laws.fits, laws.ranks.tolist(), weights.tolist(), strict=True):
        name = fit.shape.name
        new = TrendLaw(name, fit.shape.formula, rank - float(laws.ranks[0]), 0.0)
        best = found.get(name, new)
        found[name] = replace(best, weight=best.weight + weight)
    return tuple(found.values())
