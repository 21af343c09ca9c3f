"""Ages, rates and friction of a trend in the units that people read."""

from __future__ import annotations

from hersey.damping.estimate import Estimate, rounded

#: By what age is counted in: units from the coarsest on, with their size in its own.
_AGES = {
    "time": (("h", 3600.0), ("min", 60.0), ("s", 1.0)),
    "distance": (("km", 1000.0), ("m", 1.0)),
    "revolutions": (("rev", 1.0),),
}
#: Ages of two of a unit are shown in it.
_FROM = 2.0
#: An end of an interval this near to 0, as a share of the other, is 0.
_NOTHING = 1e-3
#: By what age is counted in: what a rate may be per, its size, and from what last age on.
_RATES = {
    "time": (("h", 3600.0, 600.0), ("min", 60.0, 10.0), ("s", 1.0, 0.0)),
    "distance": (("km", 1000.0, 100.0), ("m", 1.0, 0.0)),
    "revolutions": (("1000 rev", 1000.0, 100.0), ("rev", 1.0, 0.0)),
}


def rate_unit(by: str, last: float) -> tuple[str, float]:
    """Return what a rate reads best per, in a record up to the last age, and its size."""
    return next((unit, size) for unit, size, least in _RATES[by] if last >= least)


def age_unit(by: str, largest: float) -> tuple[str, float]:
    """Return the unit in which ages up to the largest read best, and its size."""
    return next((each for each in _AGES[by] if largest >= _FROM * each[1]), _AGES[by][-1])


def shown_age(by: str, age: float) -> str:
    """Return an age with its unit.

    Examples
    --------
    >>> shown_age("time", 754.0), shown_age("distance", 3200.0)
    ('12.6 min', '3.2 km')
    """
    unit, size = age_unit(by, age)
    return f"{age / size:.3g} {unit}"


def age_within(by: str, age: Estimate) -> str:
    """Return an age with its interval, whose end may be open."""
    unit, size = age_unit(by, age.value if age.value < float("inf") else age.low)
    if age.high == float("inf"):
        return f"more than {age.low / size:.3g} {unit}"
    return rounded(age.value / size, age.low / size, age.high / size, unit)


def rate_within(by: str, rate: Estimate, level: float, last: float) -> str:
    """Return a rate as a share of a level, with its interval."""
    unit, size = rate_unit(by, last)
    shares = [100.0 * size * each / abs(level) for each in (rate.value, rate.low, rate.high)]
    least = _NOTHING * max(map(abs, shares))
    value, low, high = (each if abs(each) > least else 0.0 for each in shares)
    return rounded(value, low, high, f"%/{unit}")


def greatest_rate(by: str, rate: Estimate, level: float, last: float) -> str:
    """Return the greatest rate, up or down, that an interval leaves open, as a share of a level."""
    unit, size = rate_unit(by, last)
    most = max(abs(rate.low), abs(rate.high)) * size / abs(level)
    return f"{float(f'{100.0 * most:.2g}'):g} %/{unit}"


def friction_unit(unit: str, largest: float) -> tuple[str, float]:
    """Return the unit in which friction reads best, and how many of it are one of its SI unit."""
    if unit == "N m":
        return ("N·m", 1.0) if largest >= 1.0 else ("mN·m", 1e3)
    return ("" if unit == "1" else unit, 1.0)


def friction_within(unit: str, value: Estimate) -> str:
    """Return friction with its interval."""
    named, factor = friction_unit(unit, abs(value.value))
    return rounded(factor * value.value, factor * value.low, factor * value.high, named)
