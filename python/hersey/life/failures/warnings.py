"""What is to be known of a law of ages at failure: few failures, none, or another law that fits better."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from hersey.life.failures.sample import Failures
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    from hersey.life.failures.law import LawComparison

_NAMES = {"weibull": "Weibull", "lognormal": "lognormal", "gamma": "gamma"}
#: Failures below which a law is given with a warning, and difference of AIC that names another law.
_FEW, _BETTER = 4, 4.0


def no_law(sample: Failures) -> Warning:
    """Return why the failures determine no law."""
    count = sample.failures
    ends = sample.high[sample.failed]
    age = float(ends.min() if count else np.max(sample.low))
    return Warning(
        "no law of failures",
        "no specimen has failed up to {shown}, so the failure law is unknown"
        if count == 0
        else "only one specimen has failed, by {shown}, so the failure law is unknown"
        if count == 1
        else "all failures lie at one age or in one interval, by {shown}, so their spread is unknown",
        remedy="follow specimens until more have failed, or state the shape if it is known",
        severity="act",
        failures=count,
        age=age,
        shown=f"{age:.6g} {sample.unit}".strip(),
    )


def few_failures(sample: Failures) -> tuple[Warning, ...]:
    """Return a warning where so few have failed that bounds are wide."""
    if sample.failures >= _FEW:
        return ()
    return (
        Warning(
            "few failures",
            "{failures} failures show little of the spread, so the bounds are wide",
            remedy="follow specimens until more have failed",
            severity="watch",
            failures=sample.failures,
        ),
    )


def unknown_modes(modes: tuple[str, ...]) -> Warning:
    """Return which failure modes have too few failures, so that all failures are taken together."""
    return Warning(
        "failure modes together",
        "{modes}: too few failures for a law of this mode, so one law is fitted to all failures",
        severity="watch",
        modes=", ".join(modes),
    )


def law_warnings(compared: Sequence[LawComparison], law: str) -> tuple[Warning, ...]:
    """Return which other law fits clearly better."""
    own = next((each for each in compared if each.law == law), None)
    if own is None or own.aic - compared[0].aic < _BETTER:
        return ()
    best = compared[0]
    return (
        Warning(
            "another law fits better",
            "the {best} law fits better than the {law} law (AIC lower by {difference:.1f})",
            severity="watch",
            best=_NAMES[best.law],
            law=_NAMES[law],
            difference=own.aic - best.aic,
        ),
    )
