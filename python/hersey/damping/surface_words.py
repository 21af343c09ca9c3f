"""What a fitted surface says of itself: its headline, its summary, its record and its table."""

from __future__ import annotations

import itertools
import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np

from hersey.damping.candidates.shared_errors import SharedScatter
from hersey.damping.estimate import Estimate
from hersey.damping.fitted_law import FittedLaw
from hersey.result import json_record
from hersey.units import celsius

if TYPE_CHECKING:
    import polars as pl


#: An error beyond this many times its value is not shown as a share.
_MOST_SHARE = 10.0


def headline_of(s: FittedLaw) -> str:
    """Return the law and its exponents."""
    exponents = f"b = {s.b.value:.4g}, c = {s.c.value:.4g}" if s.b else f"c = {s.c.value:.4g}"
    where = "no transition"
    if s.transition is not None:
        where = f"transition at {s.transition.speed.value:.4g} {s.domain.speed_unit}"
    return f"{s.law}, {exponents}, {where}"


def summary_of(s: FittedLaw) -> str:
    """Return the fit as text, in the layout that users of lmfit know."""
    st, quantity = s.statistics, s.domain.quantity
    lines = [
        "[[Model]]",
        f"    {s.law}    ({s.law_units})",
        "[[Fit Statistics]]",
        f"    # fitting method   = robust likelihood of ln {quantity}, errors of {quantity}, "
        f"{s.domain.speed} and temperature",
        f"    # scatter added    = {100 * st.scatter:.3f} % between dwells, beyond the errors of their means",
        *(f"    # scatter shared   = {_shared_text(shared)}" for shared in st.shared),
        *(_wrapped(f"    # sensors +/-      = {s.sensors}") if s.sensors else []),
        *(_wrapped(f"    # torque of film   = measured minus no-load torque: {s.rest}") if s.rest else []),
        f"    # data points      = {st.points}",
        f"    # variables        = {st.variables}",
        f"    chi-square         = {st.chi_square:.6g}  (from the errors of the dwells alone)",
        f"    reduced chi-square = {st.reduced_chi_square:.6g}  (1 if these errors explained all scatter)",
        f"    Akaike (AICc)      = {st.aicc:.6g}",
        f"    R-squared, {'torque ' if s.domain.is_torque else quantity} = {st.r_squared_torque:.6f}",
        f"    R-squared, damping = {st.r_squared_damping:.6f}  (nearer 1 only because division by speed",
        "                         spreads the values)",
        "[[Variables]]                                        95 % interval",
    ]
    lines += [_variable("a", s.a), *([_variable("b", s.b)] if s.b else []), _variable("c", s.c)]
    lines += _transition_text(s)
    lines += [f"[[Fitted in {quantity} space, errors absolute]]"]
    lines += [_variable(name, estimate) for name, estimate in s.torque_space.items()]
    lines += ["[[Correlations]] (unreported are below 0.1)", *_correlations(s)]
    return "\n".join(lines)


def _transition_text(s: FittedLaw) -> list[str]:
    """The lines of the transition, none where there is none."""
    if not s.transition:
        return []
    kelvin = s.reference_temperature
    at = "" if kelvin is None else f" at {_temperature_text(kelvin, s.temperature_scale)}"
    lines = [
        _variable("c_mixed", s.transition.mixed_exponent),
        _variable("w_t", s.transition.speed) + f"  {s.domain.speed_unit}{at}",
    ]
    if s.b:
        freed = s.transition.freed
        why = "fixed Hersey number"
        if freed is not None:
            why = f"fitted separately: a fixed Hersey number is worse by {freed:.1f} in AICc"
        lines.append(f"    w_t varies as T^{s.transition.temperature_exponent:.3g} ({why})")
    lines.append("    below w_t the exponent is c_mixed")
    if s.transition.gradual:
        lines.append("    the bend is gradual: w_t is the minimum of a smooth curve through the dwells;")
        lines.append(
            f"    the trend lines on either side meet at {s.transition.meeting_speed:.4g} "
            f"{s.domain.speed_unit}"
        )
    return lines


def record_of(s: FittedLaw) -> dict[str, Any]:
    """Return the fit in SI; T of the law in its scale."""
    statistics = {name: value for name, value in vars(s.statistics).items() if name != "variables"}
    return json_record(
        {
            "law": s.law,
            "temperature_scale": s.temperature_scale,
            "reference_speed": s.reference_speed,
            "reference_temperature": s.reference_temperature,
            "coefficients": s.coefficients(),
            "torque_space": s.torque_space,
            "transition": s.transition,
            "no_transition": s.rejected_transition,
            "variables": s.variables,
            "values": s.values,
            "covariance": s.covariance,
            "variance_parts": s.freedoms.parts,
            "variance_uncertainty": s.freedoms.uncertainty,
            **statistics,
            "speed_range": s.speed_range,
            "temperature_range": s.temperature_range,
            "sensors": s.sensors,
            "rest": s.rest,
            "domain": s.domain,
            "summary": summary_of(s),
        }
    )


def table_of(s: FittedLaw) -> pl.DataFrame:
    """Return the coefficients with error and 95 % interval; T of the law in its scale, w in rad/s."""
    import polars as pl

    named = [(name, estimate, "") for name, estimate in s.coefficients().items()]
    if s.transition is not None:
        named.append(("c_mixed", s.transition.mixed_exponent, ""))
        named.append(("w_t", s.transition.speed, s.domain.speed_unit))
    unit = s.domain.damping_unit if s.domain.is_torque else s.domain.unit
    named[0] = ("a", s.a, f"{unit} at T = 1, {s.domain.speed_symbol} = 1".strip())
    rows = [(name, e.value, e.error, e.low, e.high, unit) for name, e, unit in named]
    numbers = dict.fromkeys(("value", "error", "low", "high"), pl.Float64)
    return pl.DataFrame(rows, schema={"name": pl.String, **numbers, "unit": pl.String}, orient="row")


def _variable(name: str, e: Estimate) -> str:
    if not e.estimable:
        return f"    {name:8s} {e.value: .7g}, interval not known"
    share = f" ({100 * abs(e.error / e.value):.2f} %)" if e.error < _MOST_SHARE * abs(e.value) else ""
    ends = f"[{e.low:.6g}, {e.high:.6g}]"
    sensors = f"  sensors +/- {e.systematic:.2g}" if e.systematic else ""
    return f"    {name:8s} {e.value: .7g} +/- {f'{e.error:.3g}{share}':18s} {ends}{sensors}"


def _wrapped(text: str) -> list[str]:
    """A statistic in lines that a page holds."""
    return textwrap.wrap(text, 96, subsequent_indent=25 * " ")


def _shared_text(shared: SharedScatter) -> str:
    if not shared.estimable:
        few = "too few of them, or the law absorbs their differences"
        return f"cannot be determined for a {shared.name}: {few}"
    return (
        f"{100 * shared.deviation:.3f} % common to all dwells of a {shared.name} (p = "
        f"{shared.p_value:.2g} if there is none)"
    )


def _correlations(s: FittedLaw) -> list[str]:
    deviation = np.sqrt(np.diag(s.covariance))
    pairs = []
    for (i, first), (j, second) in itertools.combinations(enumerate(s.variables), 2):
        spread = deviation[i] * deviation[j]
        r = float(s.covariance[i, j] / spread) if spread else 0.0
        if abs(r) >= 0.1:
            pairs.append((-abs(r), f"    C({first}, {second}) = {r:+.4f}"))
    return [text for _, text in sorted(pairs)]


def _temperature_text(kelvin: float, scale: str) -> str:
    """Return a temperature (K) in the scale of a law, for people."""
    return f"{kelvin:.4g} K" if scale == "K" else f"{celsius(kelvin):.4g} degC"
