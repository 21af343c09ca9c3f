"""The law of ages at failure in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hersey.errors import capital
from hersey.life.failures.law import span, written

if TYPE_CHECKING:
    from hersey.errors import capital
from hersey.life.failures.law import FailureLaw, LawParameter

#: Laws as sentences call them.
NAMES = {"weibull": "Weibull", "lognormal": "lognormal", "gamma": "gamma"}
#: p-value of the goodness of fit below which a law is doubted.
_DOUBTED = 0.05


def lines_of(found: FailureLaw) -> list[str]:
    """Return headline, B-lives, parameters, failure modes and how well the law fits."""
    lines = [found.headline()]
    if not found.is_known:
        return lines
    unit = found.behind
    rows = [(each.name, f"{written(each.age)} {span(each.low, each.high)}{unit}") for each in found.b_lives]
    rows += [(each.name, _shown(each)) for each in found.parameters]
    for mode in found.modes:
        law = ", ".join(f"{each.name} {_shown(each)}" for each in mode.parameters)
        rows.append((mode.mode, f"{mode.failures} failed, {law}"))
    widest = max(len(name) for name, _ in rows)
    lines += [f"  {name:{widest}s}  {text}" for name, text in rows]
    if found.acceleration is not None:
        lines.append(f"{found.acceleration.words}.")
    return [*lines, _bounds(found), *_verdict(found), *_fit(found)]


def _shown(parameter: LawParameter) -> str:
    unit = f" {parameter.unit}" if parameter.unit else ""
    if parameter.low == parameter.high:
        return f"{written(parameter.value)}{unit} (given)"
    return f"{written(parameter.value)} {span(parameter.low, parameter.high)}{unit}"


def _bounds(found: FailureLaw) -> str:
    levels = f"{100 * found.level:.4g} % two-sided, {100 * found.one_sided:.4g} % each alone"
    if len(found.fits) > 1:
        return f"{capital(NAMES[found.law])} law of each failure mode; bounds by simulation, {levels}."
    how = "likelihood-ratio bounds, calibrated" if found.calibrated else "likelihood-ratio bounds"
    return f"{capital(NAMES[found.law])} law by maximum likelihood; {how}, {levels}."


def _verdict(found: FailureLaw) -> list[str]:
    """What the shape of a Weibull law means."""
    if found.law != "weibull" or len(found.fits) > 1:
        return []
    shape = found.parameters[0]
    if shape.low == shape.high:
        return []
    if shape.low > 1:
        return ["The failure rate grows with age: specimens wear out."]
    if shape.high < 1:
        return ["The failure rate falls with age: weak specimens fail early."]
    return ["Whether the failure rate grows or falls with age is unknown."]


def _fit(found: FailureLaw) -> list[str]:
    lines = []
    if found.goodness is not None:
        p = found.goodness.p_value
        judged = "does not fit" if p < _DOUBTED else "fits"
        named = f"Anderson-Darling {found.goodness.statistic:.2f}, p = {p:.2g}"
        lines.append(f"The {NAMES[found.law]} law {judged} ({named}).")
    if len(found.comparison) > 1:
        rows = ", ".join(f"{NAMES[each.law]} {each.aic:.2f}" for each in found.comparison)
        lines.append(f"AIC (least is best): {rows}.")
    return lines
