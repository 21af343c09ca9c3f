"""What is to be known of a law of ages at failure: few failures, none, or another law that fits better."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hersey.life.failures.acceleration import Acceleration
from hersey.life.failures.distributions import DISTRIBUTIONS
from hersey.life.failures.records import LawComparison
from hersey.life.failures.sample import Failures
from hersey.schema.warning import Warning

#: Failures below which a law is given with a warning, and difference of AIC that names another law.
_FEW, _BETTER = 4, 4.0
#: p-value below which one shape and one relation for all stresses are doubted.
_DOUBTED = 0.05


def no_law(sample: Failures, *, flat: bool = False) -> Warning:
    """Return why the failures determine no law; ``flat``: the share failed does not grow with age."""
    count = sample.failures
    ends = sample.high[sample.failed]
    age = float(ends.min() if count else np.max(sample.low))
    return Warning(
        "no law of failures",
        "no specimen has failed up to {shown}, so the failure law is unknown"
        if count == 0
        else "only one specimen has failed, by {shown}, so the failure law is unknown"
        if count == 1
        else "the share failed hardly grows with age, so the failure law is unknown"
        if flat
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


def modes_under_stress(modes: tuple[str, ...]) -> Warning:
    """Return that failure modes at several stresses are fitted as one."""
    return Warning(
        "failure modes under stress",
        "one law is fitted to the failures of {modes}, although stress may act on each mode differently",
        remedy="fit a table of one mode, in which specimens that failed otherwise are suspensions",
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
            best=DISTRIBUTIONS[best.law].title,
            law=DISTRIBUTIONS[law].title,
            difference=own.aic - best.aic,
        ),
    )


def stress_warnings(found: Acceleration | None) -> tuple[Warning, ...]:
    """Return that the stress of use was not tested, and that the stresses do not share shape and relation."""
    warnings = []
    if found is not None and not found.lowest <= found.use <= found.highest:
        warnings.append(
            Warning(
                "stress of use not tested",
                "the stress of use lies outside those tested, so the ages assume the same relation there",
                severity="watch",
                use=found.use,
                lowest=found.lowest,
                highest=found.highest,
            )
        )
    if found is not None and found.same_shape is not None and found.same_shape < _DOUBTED:
        warnings.append(
            Warning(
                "stresses differ",
                "the stresses do not share one shape and this relation ({p:p}), so the bounds are too narrow",
                remedy="fit the stresses near that of use alone",
                severity="act",
                p=found.same_shape,
            )
        )
    return tuple(warnings)
