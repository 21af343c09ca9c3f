"""Two logs against each other: two lubricants, ages or units.

Both are given the candidate that describes them best together (least sum of AICc, the simplest unless a
larger law is beyond doubt). The ratio of damping, B over A, is taken where both were measured; its interval
is simultaneous over that range (Scheffe), so that a verdict of a difference anywhere in it is wrong in 5 %
of cases at most. Where a log does not tell how far visits scatter, it is a difference of the visits recorded,
and what depends on temperature is not compared.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.candidates.branched import Law
from hersey.damping.candidates.comparison import compare_models
from hersey.damping.candidates.intervals import quantities
from hersey.damping.candidates.likelihood import EVIDENCE
from hersey.damping.candidates.model_comparison import CandidateFit, ModelComparison
from hersey.damping.candidates.observations import Observations
from hersey.damping.distributions import holm, ratio_quantile, student_above, student_quantile
from hersey.damping.dwells import SteadyPoints
from hersey.damping.dwells.reduced import require_points
from hersey.damping.estimate import CONFIDENCE, Estimate
from hersey.errors import ISOTHERMAL, HerseyError, InsufficientDataError
from hersey.log.replaced import replaced_in
from hersey.result import Means, Record, Result
from hersey.schema.warning import Warning
from hersey.units import convert, rpm, takes_si

if TYPE_CHECKING:
    import polars as pl

#: Kind of the warning that a log is compared with itself.
SAME_LOG = "same log"
#: Speeds at which the ratio is taken.
SPEEDS = 9
#: Temperatures at which it is.
TEMPERATURES = 4
#: Least share of the ranges that two logs must have in common: a factor of speed.
LEAST_SPAN = 1.2
_QUOTED = ("b", "c", "c below the transition", "transition speed", "Stribeck speed", "T0")


@dataclass(frozen=True)
class Change(Record):
    """Difference of a quantity: B minus A, or B divided by A for a speed.

    ``p_value`` is that of no difference, corrected for all the quantities compared (Holm, Scand. J. Stat. 6
    (1979) 65); the interval of the change is its own.
    """

    also_stated = ("real",)

    name: str
    of_a: float
    of_b: float
    change: Estimate
    is_ratio: bool
    p_value: float

    @property
    def real(self) -> bool:
        """Whether the quantity differs at the 5 % level."""
        return self.p_value < 1.0 - CONFIDENCE


@dataclass(frozen=True, repr=False)
class LogComparison(Result):
    """Damping of B relative to A, and other differences; arrays of shape (temperatures, speeds)."""

    also_stated = ("a", "b")
    not_stated = ("names",)

    candidate: str
    speeds: Annotated[FloatArray, Means(unit="rad/s")]
    temperatures: Annotated[FloatArray, Means("empty if the law has no temperature", "K")]
    ratio: Annotated[FloatArray, Means("B divided by A", shape="(n, m)")]
    low: Annotated[FloatArray, Means("simultaneous 95 % limit", shape="(n, m)")]
    high: Annotated[FloatArray, Means("simultaneous 95 % limit", shape="(n, m)")]
    mean_ratio: Annotated[Estimate, Means("geometric mean over the shared range")]
    changes: tuple[Change, ...]
    verdict: str
    warnings: tuple[Warning, ...]
    names: tuple[str, str]

    @property
    def a(self) -> str:
        """The name of the first log."""
        return self.names[0]

    @property
    def b(self) -> str:
        """The name of the second log."""
        return self.names[1]

    def summary(self) -> str:
        """Return the comparison as text."""
        a, b = self.names
        lines = [f"A: {a}", f"B: {b}", f"model for both: {self.candidate}", self.verdict]
        lines.append(f"damping ratio B/A, mean over the shared range: {self.mean_ratio}")
        for row, kelvin in enumerate(self.temperatures if self.temperatures.size else [None]):
            hot = "" if kelvin is None else f"{convert(float(kelvin), 'K', 'degC'):.0f} degC: "
            ratios = []
            for i in (0, self.speeds.size // 2, self.speeds.size - 1):
                ends = f"[{self.low[row, i]:.3f}, {self.high[row, i]:.3f}]"
                ratios.append(f"{rpm(float(self.speeds[i])):.3g} rpm {self.ratio[row, i]:.3f} {ends}")
            lines.append(f"  {hot}{'; '.join(ratios)}")
        for change in self.changes:
            how = "B/A" if change.is_ratio else "B - A"
            lines.append(
                f"  {change.name}: {_value(change, change.of_a)} and {_value(change, change.of_b)}, "
                f"{how} = {change.change}, p = {change.p_value:.2g}"
            )
        return "\n".join([*lines, *(f"- {warning.sentence}" for warning in self.warnings)])

    def headline(self) -> str:
        """Return the mean ratio of damping."""
        return f"damping of {self.names[1]} relative to {self.names[0]}: {self.mean_ratio}"

    def to_frame(self) -> pl.DataFrame:
        """Return the ratio with its limits at each temperature (null if none) and speed."""
        import polars as pl

        levels = self.temperatures.tolist() or [None]
        kelvin = [level for level in levels for _ in self.speeds]
        return pl.DataFrame(
            {
                "temperature (K)": pl.Series(kelvin, dtype=pl.Float64),
                "speed (rad/s)": np.tile(self.speeds, len(levels)),
                "ratio (1)": self.ratio.ravel(),
                "ratio low (1)": self.low.ravel(),
                "ratio high (1)": self.high.ravel(),
            }
        )


@takes_si()
def compare(
    a: SteadyPoints | Observations, b: SteadyPoints | Observations, *, names: tuple[str, str] = ("A", "B")
) -> LogComparison:
    """Compare the dwells of two logs.

    Parameters
    ----------
    a, b
        From `TorqueLog.steady`.
    names
        Names of the two logs.

    Raises
    ------
    InsufficientDataError
        If the logs have no speed or temperature in common, or no model fits both; the message names the log.
    """
    for points, call in ((a, "hersey.compare({points}, b)"), (b, "hersey.compare(a, {points})")):
        if not isinstance(points, Observations):
            require_points(points, call)
    data = [_observed(points, name) for points, name in zip((a, b), names, strict=True)]
    speeds, temperatures = _shared(data[0], data[1], names)
    first, second = (_fitted(each, name) for each, name in zip(data, names, strict=True))
    of_a, of_b = _common_candidate(first, second, names)
    if of_a.fit.law.thermal is None:
        temperatures = np.empty(0)
    flat = _flat(speeds, temperatures)
    (y_a, g_a), (y_b, g_b) = (
        _law_at(r, comparison.data, *flat) for r, comparison in ((of_a, first), (of_b, second))
    )
    difference = y_b - y_a
    covariance = g_a @ of_a.fit.covariance @ g_a.T + g_b @ of_b.fit.covariance @ g_b.T
    freedom = _least_freedom(of_a, of_b, g_a, g_b)
    rank = of_a.fit.values.size
    reach = np.sqrt(rank * ratio_quantile(CONFIDENCE, rank, freedom)) * np.sqrt(np.diag(covariance))
    shape = (max(temperatures.size, 1), speeds.size)
    all_of = np.full((1, difference.size), 1.0 / difference.size)
    mean = _mean(difference, covariance, _least_freedom(of_a, of_b, all_of @ g_a, all_of @ g_b))
    changes = _changes(of_a, of_b, first.data, second.data)
    ratio, low, high = (
        np.exp(v).reshape(shape) for v in (difference, difference - reach, difference + reach)
    )
    once = [name for name, r, c in zip(names, (of_a, of_b), (first, second), strict=True) if _once(r, c.data)]
    return LogComparison(
        candidate=of_a.candidate.name,
        speeds=speeds,
        temperatures=temperatures,
        ratio=ratio,
        low=low,
        high=high,
        mean_ratio=mean,
        changes=changes,
        verdict=_verdict(mean, low, high, changes, names, of_visits=bool(once)),
        warnings=(
            *_of_logs([points for points in (a, b) if not isinstance(points, Observations)]),
            *_warnings(first, second, of_a),
            *([_of_visits(once)] if once else []),
        ),
        names=names,
    )


def _of_logs(logs: Sequence[SteadyPoints]) -> list[Warning]:
    """Warnings of the files of each log, first that the dwells of both are the same."""
    found = [each for points in logs for each in replaced_in(points.log.files)]
    if len(logs) == 2 and logs[0].table.equals(logs[1].table):  # noise makes two measurements differ
        words = (
            "A and B are the same measurement, so no difference can show; the limits say how small a "
            "difference could be detected"
        )
        remedy = "to compare two logs, give two different files"
        found.insert(0, Warning(SAME_LOG, words, severity="watch", remedy=remedy))
    return found


def _fitted(data: Observations, name: str) -> ModelComparison:
    try:
        return compare_models(data, bootstrap=0, cross_validate=False)
    except HerseyError as error:
        raise error.within(name) from None


def _observed(points: SteadyPoints | Observations, name: str) -> Observations:
    try:
        return points if isinstance(points, Observations) else Observations.of(points)
    except HerseyError as error:
        raise error.within(name) from None


def _once(candidate: CandidateFit, data: Observations) -> bool:
    """Whether a log does not tell how far visits scatter."""
    return np.unique(data.visit).size == 1 or any(not shared.estimable for shared in candidate.fit.shared)


def _of_visits(names: list[str]) -> Warning:
    words = (
        "{logs} {count:does|do} not show how much visits to one temperature differ, so limits hold "
        "only for these visits. Record one temperature again"
    )
    return Warning("visited once", words, severity="watch", logs=" and ".join(names), count=len(names))


def _shared(a: Observations, b: Observations, names: tuple[str, str]) -> tuple[FloatArray, FloatArray]:
    slow, fast = max(a.speed.min(), b.speed.min()), min(a.speed.max(), b.speed.max())
    if fast < LEAST_SPAN * slow:
        raise InsufficientDataError(
            f"the logs have too few speeds in common: {names[0]} covers {rpm(a.speed.min()):.3g} to "
            f"{rpm(a.speed.max()):.3g} rpm, {names[1]} covers {rpm(b.speed.min()):.3g} to "
            f"{rpm(b.speed.max()):.3g} rpm. Record one at speeds of the other"
        )
    speeds = np.geomspace(slow, fast, SPEEDS)
    if a.inputs.kelvin is None or b.inputs.kelvin is None:
        if (a.inputs.kelvin is None) != (b.inputs.kelvin is None):
            bare = names[0] if a.inputs.kelvin is None else names[1]
            raise InsufficientDataError(
                f"{bare} has no temperature, but the other log has. Compare both at one temperature "
                f"with {ISOTHERMAL.to()}"
            )
        return speeds, np.empty(0)
    cold = max(float(a.inputs.kelvin.min()), float(b.inputs.kelvin.min()))
    hot = min(float(a.inputs.kelvin.max()), float(b.inputs.kelvin.max()))
    if hot < cold - 3.0:
        below, above = names if a.inputs.kelvin.max() < b.inputs.kelvin.min() else names[::-1]
        raise InsufficientDataError(
            f"the logs have no temperature in common: {below} ends at {convert(hot, 'K', 'degC'):.0f} "
            f"degC, {above} starts at {convert(cold, 'K', 'degC'):.0f} degC. Record one at "
            "temperatures of the other"
        )
    return speeds, np.linspace(min(cold, hot), max(cold, hot), TEMPERATURES)


def _common_candidate(
    a: ModelComparison, b: ModelComparison, names: tuple[str, str]
) -> tuple[CandidateFit, CandidateFit]:
    """The candidate with the least sum of AICc, of those determined in both logs."""
    pairs = []
    for one in a.candidates:
        other = next((r for r in b.candidates if r.candidate == one.candidate), None)
        if other is not None and not one.not_identified and not other.not_identified:
            pairs.append((one.fit.aicc + other.fit.aicc, one, other))
    if not pairs:
        raise InsufficientDataError(
            f"no model can be determined from both {names[0]} and {names[1]}. Record more dwells of each"
        )
    least = min(total for total, _, _ in pairs)
    tied = [p for p in pairs if p[0] <= least + EVIDENCE]
    _, one, other = min(tied, key=lambda p: (p[1].fit.parameters, p[0]))
    return one, other


def _least_freedom(a: CandidateFit, b: CandidateFit, g_a: FloatArray, g_b: FloatArray) -> float:
    """Degrees of freedom of the less known log, least over linear combinations of the values (rows)."""
    return min(fit.freedoms.of(row) for fit, rows in ((a.fit, g_a), (b.fit, g_b)) for row in rows)


def _flat(speeds: FloatArray, temperatures: FloatArray) -> tuple[FloatArray, FloatArray | None]:
    if not temperatures.size:
        return speeds, None
    both = np.meshgrid(speeds, temperatures)
    return both[0].ravel(), both[1].ravel()


def _law_at(
    candidate: CandidateFit, data: Observations, speed: FloatArray, kelvin: FloatArray | None
) -> tuple[FloatArray, FloatArray]:
    if kelvin is None and data.inputs.kelvin is not None:
        kelvin = np.full(speed.size, float(np.mean(data.inputs.kelvin)))
    inputs, law, values = data.at(speed, kelvin), candidate.fit.law, candidate.fit.values
    return law.predict(values, inputs), law.jacobian(values, inputs)


def _mean(difference: FloatArray, covariance: FloatArray, freedom: float) -> Estimate:
    share = np.full(difference.size, 1.0 / difference.size)
    centre, error = float(share @ difference), float(np.sqrt(share @ covariance @ share))
    width = float(student_quantile(0.5 + CONFIDENCE / 2, freedom)) * error
    ratio, low, high = (float(np.exp(centre + by)) for by in (0.0, -width, width))
    return Estimate(ratio, ratio * error, low, high, freedom)


def _changes(a: CandidateFit, b: CandidateFit, of_a: Observations, of_b: Observations) -> tuple[Change, ...]:
    """Differences of what does not depend on the reference; speeds at the reference of A."""
    out = []
    in_a = {q.name: q for q in quantities(a.fit, of_a)}
    in_b = {q.name: q for q in quantities(b.fit, of_b)}
    for name in in_a.keys() & in_b.keys():
        energy = in_a[name].unit == "kJ/mol"
        if not energy and name not in _QUOTED and not name.startswith("c at"):
            continue
        p, q = in_a[name], in_b[name]
        if any(r.fit.not_estimable(r.fit.law.names[k.parameter]) for r, k in ((a, p), (b, q))):
            continue
        u, v = float(a.fit.values[p.parameter]), float(b.fit.values[q.parameter])
        is_ratio = p.unit == "rad/s"
        values = p.of(u), q.of(v)
        error = math.hypot(
            *(
                r.fit.error(r.fit.law.names[k.parameter]) * _slope(k.of, w, is_ratio)
                for r, k, w in ((a, p, u), (b, q, v))
            )
        )
        if is_ratio:
            values = values[0], values[1] * _moved(b, of_b, of_a.reference_kelvin)
        freedom = min(fit.freedom_of(fit.law.names[k.parameter]) for fit, k in ((a.fit, p), (b.fit, q)))
        size = float(np.log(values[1] / values[0])) if is_ratio else values[1] - values[0]
        p_value = float(2 * student_above(abs(size) / max(error, 1e-300), freedom))
        reach = float(student_quantile(0.5 + CONFIDENCE / 2, freedom)) * error
        ends = size - reach, size + reach
        change = Estimate(size, error, *ends)
        if is_ratio:
            ratio = float(np.exp(size))
            change = Estimate(ratio, ratio * error, *(float(np.exp(end)) for end in ends))
        out.append(Change(name, *values, change, is_ratio, p_value))
    corrected = [replace(c, p_value=p) for c, p in zip(out, holm([c.p_value for c in out]), strict=True)]
    return tuple(sorted(corrected, key=lambda change: change.name))


def _moved(candidate: CandidateFit, data: Observations, kelvin: float | None) -> float:
    """Transition at another temperature over that at the reference of the data."""
    law = candidate.fit.law
    if kelvin is None or data.reference_kelvin is None or law.thermal is None or not isinstance(law, Law):
        return 1.0
    if not law.broken:
        return 1.0
    inputs = data.at(np.full(2, data.reference_speed), np.array([kelvin, data.reference_kelvin]))
    there, here = law.transition(candidate.fit.values, inputs)
    return float(np.exp(there - here))


def _slope(of: Callable[[float], float], value: float, logarithmic: bool) -> float:
    step = 1e-6 * max(abs(value), 1e-3)
    ends = of(value + step), of(value - step)
    return abs(float(np.log(ends[0] / ends[1])) if logarithmic else ends[0] - ends[1]) / (2 * step)


def _verdict(
    mean: Estimate,
    low: FloatArray,
    high: FloatArray,
    changes: tuple[Change, ...],
    names: tuple[str, str],
    *,
    of_visits: bool,
) -> str:
    a, b = names
    higher, lower = bool(np.any(low > 1.0)), bool(np.any(high < 1.0))
    if higher and lower:
        said = (
            f"Damping of {b} is higher than that of {a} in one part of the shared range and lower in another"
        )
    elif higher or lower:
        sign = "higher" if higher else "lower"
        share = np.mean(low > 1.0) if higher else np.mean(high < 1.0)
        where = "throughout" if share == 1.0 else f"over {100 * share:.0f} % of"
        said = (
            f"Damping of {b} is {sign} than that of {a} {where} the shared range, "
            f"{100 * (mean.value - 1.0):+.1f} % on average"
        )
    else:
        widest = max(float(np.max(high)) - 1.0, 1.0 - float(np.min(low)))
        said = f"No difference in damping is proven; any difference is at most {100 * widest:.1f} %"
    if of_visits and (higher or lower):
        said += ", in the visits recorded"
    real = [c.name for c in changes if c.real]
    if real:
        said += f". Also different: {', '.join(real)}"
    return said + "."


def _warnings(a: ModelComparison, b: ModelComparison, common: CandidateFit) -> list[Warning]:
    found = []
    for name, comparison in (("A", a), ("B", b)):
        own = comparison.chosen.candidate
        if own != common.candidate:
            words = "fitted separately, {log} would get another model: {law}"
            found.append(Warning("another law alone", words, log=name, law=own.name))
    if a.chosen.fit.law.broken != b.chosen.fit.law.broken:
        words = "only one of the two logs shows a falling branch"
        found.append(Warning("one falling branch", words, severity="watch"))
    return found


def _value(change: Change, value: float) -> str:
    return f"{rpm(value):.4g} rpm" if change.is_ratio else f"{value:.4g}"
