"""Claims that a trend can bear out: each is measured, then judged by the criterion it carries."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from paper.figure import ABOUT, Claim, Verdict, shown
from paper.sweep import Sweep, Trend


@dataclass(frozen=True)
class Quantity:
    """Something measured along a sweep: its name in files and in a sentence, its unit, and how to get it."""

    name: str
    subject: str
    unit: str
    along: Callable[[Sweep], FloatArray]

    def trend(self, sweep: Sweep) -> Trend:
        """Return its trend along a sweep."""
        return sweep.trend(self.along(sweep))


FREQUENCY = Quantity("frequency", "frequency", "Hz", lambda sweep: sweep.frequency)
SLIP_SPEED = Quantity("slip_speed", "the greatest belt speed", "in/s", lambda sweep: sweep.slip_speed)


def course(sweep: Sweep, quantity: Quantity) -> str:
    """Tell a trend in one sentence."""
    trend, parameter = quantity.trend(sweep), sweep.parameter
    low, _, high = parameter.traced
    way = (
        "rises at every step" if trend.rises else "falls at every step" if trend.falls else "is not monotone"
    )
    text = (
        f"{quantity.subject} {way}, from {shown(trend.first)} to {shown(trend.last)} {quantity.unit} (times "
        f"{shown(trend.factor)}) for {parameter.symbol} from {low:g} to {high:g} {parameter.unit}: as "
        f"{power(parameter.symbol, trend)}."
    )
    return text[0].upper() + text[1:]


def power(symbol: str, trend: Trend) -> str:
    """Tell a power law and the range of its local exponents."""
    local = f"{trend.exponent_low:.2f} to {trend.exponent_high:.2f}"
    return f"{symbol}^{trend.exponent:.2f} (locally {local})"


def sticks_throughout(source: str, sweep: Sweep) -> Claim:
    """Judge whether every value of a sweep ends in stick-slip."""
    count, asked = len(sweep.cycles), sweep.asked
    stuck = sweep.stuck_fraction
    first, last = (float(stuck[0]), float(stuck[-1])) if count else (math.nan, math.nan)
    return Claim(
        source,
        "The belt sticks and slips over the whole range drawn.",
        "holds if every value of the sweep settles to stick-slip; in direction if more than half do.",
        Verdict.of(count == asked, 2 * count > asked),
        f"{count} of {asked} values settle to stick-slip; the belt is stuck {first:.1%} of the time at the "
        f"low end and {last:.1%} at the high end.",
        {"values": asked, "stick_slip": count, "stuck_first": first, "stuck_last": last},
    )


def rises(source: str, statement: str, sweep: Sweep, quantity: Quantity) -> Claim:
    """Judge whether a quantity rises along a sweep."""
    trend = quantity.trend(sweep)
    return Claim(
        source,
        statement,
        "holds if it rises at every step of the sweep; in direction if from end to end only.",
        Verdict.of(trend.rises, trend.factor > 1.0),
        course(sweep, quantity),
        trend.numbers(quantity.name),
    )


def falls(source: str, statement: str, sweep: Sweep, quantity: Quantity) -> Claim:
    """Judge whether a quantity falls along a sweep."""
    trend = quantity.trend(sweep)
    return Claim(
        source,
        statement,
        "holds if it falls at every step of the sweep; in direction if from end to end only.",
        Verdict.of(trend.falls, trend.factor < 1.0),
        course(sweep, quantity),
        trend.numbers(quantity.name),
    )


def changes(source: str, statement: str, sweep: Sweep, quantity: Quantity) -> Claim:
    """Judge whether a quantity moves along a sweep, where the paper does not say which way."""
    trend = quantity.trend(sweep)
    one_way = trend.rises or trend.falls
    return Claim(
        source,
        statement,
        f"holds if it moves one way by more than {ABOUT:.0%}; in direction if one way, but by less.",
        Verdict.of(one_way and abs(trend.factor - 1.0) > ABOUT, one_way),
        course(sweep, quantity),
        trend.numbers(quantity.name),
    )


def proportional(source: str, statement: str, sweep: Sweep, quantity: Quantity) -> Claim:
    """Judge whether a quantity is about proportional to the parameter."""
    trend, parameter = quantity.trend(sweep), sweep.parameter
    low, _, high = parameter.traced
    near = abs(trend.exponent - 1.0) <= ABOUT
    than = "about proportional" if near else "not proportional"
    return Claim(
        source,
        statement,
        f"holds if the fitted exponent is within {ABOUT:g} of 1; in direction if it is positive.",
        Verdict.of(near, trend.exponent > 0.0),
        f"It goes as {power(parameter.symbol, trend)}, {than}: {high / low:g} times {parameter.symbol} makes "
        f"{quantity.subject} {shown(trend.factor)} times as large.",
        trend.numbers(quantity.name),
    )


def straight(source: str, statement: str, sweep: Sweep, quantity: Quantity) -> Claim:
    """Judge whether a quantity lies near a straight line, which need not pass through the origin."""
    x, y = sweep.value, quantity.along(sweep)
    if x.size > 1:
        slope, intercept = (float(value) for value in np.polyfit(x, y, 1))
        miss = float(np.max(np.abs((slope * x + intercept) / y - 1.0)))
        share = intercept / float(y[0])
    else:
        slope = intercept = miss = share = math.nan
    return Claim(
        source,
        statement,
        f"holds if the least-squares line misses no value by over {ABOUT:.0%}; in direction if it rises.",
        Verdict.of(miss <= ABOUT, slope > 0.0),
        f"The nearest straight line misses it by {miss:.1%} at most; at zero {sweep.parameter.symbol} it has "
        f"{shown(intercept)} {quantity.unit} left, {share:.0%} of the value at the low end.",
        {"slope": slope, "intercept": intercept, "largest_miss": miss},
    )


def similar(source: str, statement: str, here: Sweep, there: Sweep, quantity: Quantity) -> Claim:
    """Judge whether two parameters act on a quantity with about the same power."""
    one, other = quantity.trend(here), quantity.trend(there)
    first, second = power(here.parameter.symbol, one), power(there.parameter.symbol, other)
    return Claim(
        source,
        statement,
        f"holds if the two fitted exponents differ by {ABOUT:g} at most; in direction if their signs agree.",
        Verdict.of(abs(one.exponent - other.exponent) <= ABOUT, one.exponent * other.exponent > 0.0),
        f"It goes as {first} against {second}.",
        one.numbers(f"{quantity.name}_by_{here.parameter.field}")
        | other.numbers(f"{quantity.name}_by_{there.parameter.field}"),
    )


def opposite(source: str, statement: str, here: Sweep, there: Sweep, quantity: Quantity) -> Claim:
    """Judge whether two parameters drive a quantity opposite ways."""
    one, other = quantity.trend(here), quantity.trend(there)
    apart = (one.rises and other.falls) or (one.falls and other.rises)
    first, second = power(here.parameter.symbol, one), power(there.parameter.symbol, other)
    return Claim(
        source,
        statement,
        "holds if one rises and the other falls at every step; in direction if from end to end only.",
        Verdict.of(apart, one.exponent * other.exponent < 0.0),
        f"It goes as {first} against {second}.",
        one.numbers(f"{quantity.name}_by_{here.parameter.field}")
        | other.numbers(f"{quantity.name}_by_{there.parameter.field}"),
    )
