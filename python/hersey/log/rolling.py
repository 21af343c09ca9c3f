"""Contacts that roll and slide: their speed is that of entrainment, the mean of both surfaces.

The slide-roll ratio (SRR) is the difference of the speeds over their mean, so that the sliding speed is SRR
times the entrainment speed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace

from hersey.arrays import FloatArray
from hersey.log.roles import is_named
from hersey.log.stating import CHANGED, levels
from hersey.log.text.column import Column
from hersey.schema.domain import Domain
from hersey.schema.warning import Warning

#: Kind of the warning which says that a log is about the entrainment speed.
ENTRAINMENT = "entrainment speed"
_RATIO = r".*\bsrr\b.*|.*(slide|slip)[- ]?(to[- ]?)?roll.*|.*\bslip ratio.*"
_ROLLING = r".*(entrain|\brolling).*"
_SLIDING = r".*(slid|slip|gleit).*"


def entrainment(
    columns: Iterable[Column], speed: Column, numbers: Callable[[Column], FloatArray]
) -> list[Warning]:
    """Return that a speed in m/s is one of entrainment, by its name or by a slide-roll ratio beside it."""
    ratio = next((c for c in columns if is_named(_RATIO, c) and c.unit in ("", "%", "1", "-")), None)
    if is_named(_SLIDING, speed) or (ratio is None and not is_named(_ROLLING, speed)):
        return []
    words = "'{column}' is the entrainment speed, the mean of both surfaces"
    if ratio is None:
        return [Warning(ENTRAINMENT, words, column=speed.path)]
    low, high = levels(numbers(ratio))
    varies = high > CHANGED * low
    return [
        Warning(
            ENTRAINMENT,
            "'{column}' is the entrainment speed, the mean of both surfaces. The slide-roll ratio '{ratio}'"
            + (" varies from {low:.3g} to {high:.3g}{unit}" if varies else " is {high:.3g}{unit}"),
            severity="watch" if varies else "note",
            remedy="fit each ratio separately" if varies else "",
            column=speed.path,
            ratio=str(ratio.path),
            low=low,
            high=high,
            unit=" %" if ratio.unit == "%" else "",
        )
    ]


def of_rolling(domain: Domain, warnings: Iterable[Warning]) -> Domain:
    """Return the domain of a log whose file said by `entrainment` which speed it has."""
    rolls = domain.speed == "sliding speed" and any(each.kind == ENTRAINMENT for each in warnings)
    return replace(domain, speed="entrainment speed") if rolls else domain
