"""What speed says about lubrication: named hypotheses, everything that explains the dwells, and a verdict."""

from __future__ import annotations

from dataclasses import dataclass
from operator import attrgetter
from typing import TYPE_CHECKING, Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.cache.kept import kept
from hersey.damping.candidates.lack_of_fit import LackOfFit
from hersey.damping.candidates.observations import Observations
from hersey.damping.driving_torque import DrivingTorque, driving_torque, load_at_one_speed
from hersey.damping.dwells import SteadyPoints, distinct_speeds, groups_of_temperature
from hersey.damping.dwells.reduced import require_points
from hersey.damping.estimate import Estimate, estimate, rounded
from hersey.damping.surface import DampingSurface
from hersey.damping.trend import Trend, trend_of
from hersey.lubrication.contact import Contact
from hersey.lubrication.lubricant import Lubricant
from hersey.result import Means, Record, Result
from hersey.schema.domain import TORQUE, Domain
from hersey.units import celsius, rpm, takes_si
from hersey.verdict.contact_regimes import film_law, log_regimes
from hersey.verdict.explanations import Explained, Explanation, Tried, explained
from hersey.verdict.friction_verdict import friction_verdict, of_friction
from hersey.verdict.regimes import FALLING, REGIMES, Hypothesis, RegimeRow, judged, listed, named_in_words

if TYPE_CHECKING:
    import polars as pl

#: Exponent of damping below which torque falls faster than boundary lubrication is known to.
STEEP = -1.5


@dataclass(frozen=True)
class BranchExponent(Record):
    """Exponent of damping in speed at one temperature (K; None if not recorded) on one branch."""

    temperature: float | None
    branch: str  #: ``ehl`` or ``mixed``; ``all`` where the data show one branch only
    points: int
    speed_low: float  #: rad/s
    speed_high: float
    exponent: Estimate


@dataclass(frozen=True, repr=False)
class Regime(Result):
    """Verdict on the lubrication regime, with its evidence.

    ``named`` is the only regime that the data do not exclude, or None, with ``why_unnamed``;
    ``explanations`` are all that the data do not exclude.
    """

    exponents: tuple[BranchExponent, ...]
    hypotheses: tuple[Hypothesis, ...]
    explanations: tuple[Explanation, ...]
    named: str | None
    why_unnamed: str
    lack_of_fit: LackOfFit | None  #: of one exponent; None where too few dwells can say
    verdict: str
    tried: Annotated[tuple[Tried, ...], Means("the likeliest first")] = ()
    domain: Domain = TORQUE  #: what ``verdict`` is about; exponents are of damping: quantity over speed
    driving: Annotated[
        DrivingTorque | None,
        Means("why torque is that of a motor or a brake; null if it may be friction"),
    ] = None

    def summary(self) -> str:
        """Return the verdict, the hypotheses and the exponents as text."""
        lines = [self.verdict]
        if self.explanations:
            lines += ["not excluded:", *(f"  {e.name}" for e in self.explanations)]
        lines.append("hypothesis                  exponent           p")
        for h in self.hypotheses:
            values = f"{h.high:.3g}" if h.low == h.high else f"{h.low:.3g} to {h.high:.3g}"
            lines.append(
                f"  {h.name:24s}  {values:16s}  {h.p_value:.2g}{'' if h.consistent else '  excluded'}"
            )
        for e in self.exponents:
            where = "" if e.temperature is None else f" at {celsius(e.temperature):.0f} degC"
            span = self.domain.between(e.speed_low, e.speed_high)
            lines.append(f"exponent of branch {e.branch}{where}, {span}: {e.exponent}")
        return "\n".join(lines)

    def headline(self) -> str:
        """Return the named regime, or what is not excluded."""
        if self.named:
            return f"exponent as expected for {named_in_words(self.named)}"
        if not self.explanations:
            return "no regime named: the exponent fits none"
        return "no regime named; not excluded: " + listed([e.name for e in self.explanations])

    def to_frame(self) -> pl.DataFrame:
        """Return one row per exponent: temperature, branch and the exponent with its 95 % interval."""
        import polars as pl

        unit = self.domain.speed_unit
        numbers = (f"speed low ({unit})", f"speed high ({unit})", "exponent (1)", "low (1)", "high (1)")
        schema = {"temperature (K)": pl.Float64, "branch": pl.String, "points": pl.Int64}
        facts = attrgetter("temperature", "branch", "points", "speed_low", "speed_high")
        rows = [(*facts(e), e.exponent.value, e.exponent.low, e.exponent.high) for e in self.exponents]
        return pl.DataFrame(rows, schema={**schema, **dict.fromkeys(numbers, pl.Float64)}, orient="row")


@takes_si(temperature="temperature")
@kept()
def regime(
    points: SteadyPoints,
    surface: DampingSurface,
    *,
    contact: Contact | None = None,
    lubricant: Lubricant | None = None,
    temperature: float | None = None,
) -> Regime:
    """Return the verdict on the lubrication regime, from steady points and the surface fitted to them.

    Parameters
    ----------
    contact, lubricant
        The nip and its lubricant; if both are given, the exponent of the soft film is that of this contact.
    temperature
        K, for a log without temperatures.
    """
    require_points(points, "hersey.regime({points}, surface)")
    table, law = REGIMES, None
    if contact is not None and lubricant is not None:
        table = log_regimes(points, surface, contact, lubricant, temperature)
        law = film_law(contact, lubricant, table, temperature)
    hypotheses = judged(surface.c, table=table)
    by = explained(points, surface, hypotheses, law)
    trend = trend_of(Observations.of(points))
    driving = _driving(points, surface) if surface.domain.is_torque else None
    if driving is not None:
        return _of_no_friction(driving, points, surface, hypotheses, by)
    if surface.domain.is_torque:
        verdict = _verdict(surface, by, table, trend)
    else:
        verdict = friction_verdict(points, surface, trend, _of_films(by))
        hypotheses = tuple(map(of_friction, hypotheses))
    return Regime(
        branch_exponents(points, surface),
        hypotheses,
        by.explanations,
        by.named,
        by.why_unnamed or _left(by),
        by.lack_of_fit,
        " ".join(filter(None, (verdict, _of_film_alone(points), points.dropped()))),
        by.tried,
        surface.domain,
    )


def _driving(points: SteadyPoints, surface: DampingSurface) -> DrivingTorque | None:
    """Whether torque in the dwells is that of a motor or a brake, or set by a load that is not known."""
    speed, torque = (np.abs(points.column(name)) for name in ("speed", "torque"))
    found = driving_torque(speed, torque, points.column("torque_error"))
    if found is not None or points.varying_load:
        return found
    return load_at_one_speed(speed, torque, surface.statistics.scatter, warm=surface.b is not None)


def _of_no_friction(
    driving: DrivingTorque,
    points: SteadyPoints,
    surface: DampingSurface,
    hypotheses: tuple[Hypothesis, ...],
    by: Explained,
) -> Regime:
    """The verdict where torque is none of friction: no regime, and nothing explains the dwells."""
    verdict = f"{driving}, so no lubrication regime is judged. To see friction, record the drive without it."
    return Regime(
        branch_exponents(points, surface),
        hypotheses,
        (),
        None,
        "the torque is that of a motor or a brake" if driving.ratio is None else "a load sets the torque",
        by.lack_of_fit,
        " ".join(filter(None, (verdict, points.dropped()))),
        by.tried,
        surface.domain,
        driving,
    )


def _of_film_alone(points: SteadyPoints) -> str:
    """That no-load torque was subtracted before any of this was judged; empty if none was."""
    return "" if points.rest is None else "All this is for the film alone: no-load torque is subtracted."


def branch_exponents(points: SteadyPoints, surface: DampingSurface) -> tuple[BranchExponent, ...]:
    """Return the exponent of each branch at each temperature that has three speeds on it."""
    speed = np.abs(points.column("speed"))
    torque = np.abs(points.column("torque"))
    error = np.hypot(points.column("torque_error") / torque, surface.statistics.scatter)
    hot = surface.b is not None
    level = torque * np.exp(-_temperature_shift(points, surface))
    groups = list(groups_of_temperature(points.column("temperature"))) if hot else [np.arange(speed.size)]
    exponents = []
    for group in groups:
        kelvin = float(np.mean(points.column("temperature")[group])) if hot else None
        at = surface.transition_speed(kelvin)
        sides = [("all", group)]
        if surface.transition:
            slow = speed[group] < at
            sides = [("mixed", group[slow]), ("ehl", group[~slow])]
        for branch, members in sides:
            if members.size > 2 and distinct_speeds(speed[members]) >= 3:
                exponent = _slope(speed[members], level[members], error[members], surface)
                low, high = float(speed[members].min()), float(speed[members].max())
                exponents.append(BranchExponent(kelvin, branch, int(members.size), low, high, exponent))
    return tuple(exponents)


def _temperature_shift(points: SteadyPoints, surface: DampingSurface) -> FloatArray:
    """Logarithm of T^b of each dwell about the reference: dwells of a group differ by some kelvin."""
    if surface.b is None:
        return np.zeros(len(points))
    return np.asarray(surface.b.value * surface.log_temperature(points.column("temperature")))


def _slope(speed: FloatArray, torque: FloatArray, error: FloatArray, surface: DampingSurface) -> Estimate:
    """Weighted straight line of ln B on ln w; the scatter is that of the whole surface."""
    z, y = np.log(speed), np.log(torque / speed)
    weight = 1.0 / np.maximum(error, 1e-9) ** 2
    centred = z - np.average(z, weights=weight)
    spread = float(np.sum(weight * centred**2))
    slope, deviation = float(np.sum(weight * centred * y)) / spread, spread**-0.5
    return estimate(slope, deviation, surface.c.freedom)


def _verdict(surface: DampingSurface, by: Explained, table: tuple[RegimeRow, ...], trend: Trend) -> str:
    exponent = _exponent(surface, by, table)
    if surface.transition is None:
        return f"{exponent} {_no_transition(surface, by, trend)}"
    t = surface.transition
    value, low, high = (rpm(each) for each in (t.speed.value, t.speed.low, t.speed.high))
    where = rounded(value, low, high, "rpm") if t.speed.estimable else f"{value:.3g} rpm (interval not known)"
    where += f" (sensors ± {rpm(t.speed.systematic):.2g})" if t.speed.systematic else ""
    if surface.reference_temperature is not None:
        where += f" at {_degrees(surface.reference_temperature, surface.temperature_scale)}"
        where += ", and at higher speed when hotter" if t.temperature_exponent > 0 else ""
    return (
        f"Torque is lowest at {where}. Above this speed torque rises, as with a film that carries the load. "
        f"{exponent} Below it torque rises as the drive slows: lubrication is mixed, and stick-slip is "
        f"possible. The exponent of damping there is {_in_words(t.mixed_exponent)}."
    )


def _exponent(surface: DampingSurface, by: Explained, table: tuple[RegimeRow, ...]) -> str:
    """What the exponent of the (rising) branch says, and what else explains it."""
    c = _in_words(surface.c)
    others = [e.name for e in by.explanations]
    kept = f" Not excluded: {_or(others)}." if others else ""
    if by.lack_of_fit is not None and by.why_unnamed and not _films(by, table):
        return f"No single exponent holds: {by.why_unnamed}. No regime can be named.{kept}"
    said = f"Damping varies as speed^{c}"
    if by.named:
        return f"{said}, as expected for {named_in_words(by.named)}."
    if by.lack_of_fit is None:
        ends = "." if others else f", {_between(surface.c.value, table)}."
        return f"{said}{ends} No regime can be named, because {by.why_unnamed}.{kept}"
    if not _films(by, table):
        return f"{said}, {_between(surface.c.value, table)}.{kept}"
    return f"{said}.{kept}"


def _of_films(by: Explained) -> str:
    """What the exponent of friction says of regimes."""
    if by.named == FALLING:
        return "Mixed or boundary lubrication can cause this, and so can heating."
    if by.named:
        return f"This is expected for {named_in_words(by.named)}."
    if not by.explanations:
        return ""
    return f"No regime can be named. Not excluded: {_or([each.name for each in by.explanations])}."


def _left(by: Explained) -> str:
    """Why no regime is named where the data speak against none of several, or against all; else nothing."""
    if by.named:
        return ""
    if not by.explanations:
        return "no known regime explains the dwells"
    return f"the dwells do not exclude {_or([each.name for each in by.explanations])}"


def _films(by: Explained, table: tuple[RegimeRow, ...]) -> list[Explanation]:
    """Films of one regime, alone, that are not excluded."""
    return [e for e in by.explanations if e.key in {row.name for row in table}]


def _no_transition(surface: DampingSurface, by: Explained, trend: Trend) -> str:
    if not trend.falls and surface.c.high < -1.0:
        return "By this exponent torque falls as speed rises, but the dwells alone do not show it."
    if not trend.falls:
        return "The data show no transition to a falling branch."
    if surface.c.high >= -1.0 and not trend.rises:
        return "In the dwells torque falls with speed, but the exponent does not exclude a constant torque."
    low, high = surface.speed_range
    if surface.c.high >= -1.0 and not 1.01 * low < trend.least < 0.99 * high:
        return "Torque rises first and then falls with speed, so it has no minimum between two branches."
    if surface.c.high >= -1.0:
        return (
            f"Below about {rpm(trend.least):.3g} rpm torque falls with speed, but too few dwells lie there "
            "to fit a falling branch."
        )
    lack = by.lack_of_fit
    ends = (surface.c.high,) if lack is None else (*lack.local_exponents, *lack.by_temperature)
    bent = " where its exponent is below -1" if lack is not None and lack.in_speed else ""
    where = " over the whole range" if max(ends) < -1.0 else bent
    steep = ""
    if surface.c.value < STEEP:
        steep = " Magnetic braking, a controller or heating can also cause so steep a fall."
    return (
        f"Torque falls as speed rises{where}. Mixed or boundary lubrication can cause this, and stick-slip "
        f"is then possible.{steep}"
    )


def _or(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{'; '.join(names[:-1])}; or {names[-1]}"


def _in_words(e: Estimate) -> str:
    sensors = f" (sensors ± {e.systematic:.2g})" if e.systematic else ""
    return f"{e}{sensors}"


def _degrees(kelvin: float, scale: str) -> str:
    return f"{kelvin:.0f} K" if scale == "K" else f"{celsius(kelvin):.0f} degC"


def _between(c: float, table: tuple[RegimeRow, ...]) -> str:
    above = [row for row in table if row.low > c]
    below = [row for row in table if row.high < c]
    if above and below:
        return f"which lies between {above[-1].name} and {below[0].name} and fits no regime"
    return "which fits no regime"
