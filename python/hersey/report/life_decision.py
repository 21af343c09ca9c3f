"""The first screen of the page of a life test: which specimens need attention, and what to do."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from hersey.errors import sentence
from hersey.life.growth.limit_ages import FAR, percent, rounded

if TYPE_CHECKING:
    from hersey.life.time_to_failure.estimate import TimeToFailure
    from hersey.life.time_to_failure.first import SpecimenEnd

#: Specimens in the table, and in the one of the first screen; all are in `--json`.
_SHOWN, _FIRST = 60, 8
#: Signal of each state.
SIGNALS = {"failed": "act", "unclear": "watch", "running": "good"}
#: Part of the axis of the bars beyond the last interval.
_BEYOND = 1.03


def decision(found: TimeToFailure) -> dict[str, Any]:
    """Which specimens need attention, the population, what to do next, and a table of specimens."""
    attention = found.attention
    ordered = [name for state in SIGNALS for name in getattr(attention, state)]
    specimens = {each.unit: each for each in found.units}
    worst = "failed" if attention.failed else "unclear" if attention.unclear else "running"
    of_unit = f" ({found.age_unit})" if found.age_unit else ""
    last = max(each.age.last for each in found.units)
    return {
        "signal": SIGNALS[worst],
        "lead": found.lead(),
        "more": [*filter(None, [found.of_new()]), *found.answers()],
        "next": [sentence(each) for each in (*found.advice, found.planning()) if each],
        "heads": ["Specimen", "State", "Failure mode", f"Expected{of_unit}", f"90 % interval{of_unit}"],
        "rows": [_row(specimens[name]) for name in ordered[:_SHOWN]],
        "first": _FIRST,
        "age_unit": found.age_unit,
        "end": _end([specimens[name] for name in ordered[:_SHOWN]], last),
        "b10": None if found.b10 is None else found.b10.age.to_dict(),
        "failing": None if found.followed_failing is None else found.followed_failing.to_dict(),
    }


def _row(each: SpecimenEnd) -> dict[str, Any]:
    """What the table shows of a specimen."""
    return {
        "signal": SIGNALS[each.state],
        "state": each.state.capitalize()
        + ("" if each.state == "running" else f", {percent(each.age.passed)}"),
        "specimen": each.unit,
        "modes": " or ".join(each.likely) or "none shows growth",
        "expected": _expected(each),
        "age": each.age.age.to_dict(),
        "last": each.age.last,
    }


def _expected(each: SpecimenEnd) -> str:
    """The age at failure; before or after which age, where no more is known."""
    age = each.age.age
    if each.state == "unclear":
        return f"before {rounded(age.high)}" if math.isfinite(age.high) else "unknown"
    beyond = math.isinf(age.value) or each.age.far
    if beyond and math.isfinite(age.low):
        return f"after {rounded(age.low)}"
    return rounded(age.value) if math.isfinite(age.value) else "unknown"


def _end(specimens: list[SpecimenEnd], last: float) -> float:
    """Where the axis of the bars ends: beyond all intervals that are not far off."""
    far = FAR * last if last > 0.0 else math.inf
    highs = [min(each.age.age.high, far) for each in specimens]
    return _BEYOND * max([last, *(high for high in highs if math.isfinite(high))])
