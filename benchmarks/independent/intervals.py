"""Part A: whether 95 % intervals hold the truth, and how wide they are against what the errors allow.

The truth is B = a T^b w^c, or that with a falling branch below a transition. An interval counts as told
where it is finite; only those told can hold the truth or not. The systematic part that hersey shows beside it
is left out. Widths are half widths over 1.96 least errors (`known`), of a and
w_t in logarithms; a log whose transition is missed has no interval for it. Where the noise within dwells is
all there is, the mean torque of each dwell is judged too, by 1.96 of its stated errors.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import hersey
from benchmarks.independent.judged import generator, judged
from benchmarks.independent.known import least_errors, variance_of_means
from benchmarks.independent.laws import MIDDLE, PowerLaw, TwoBranches
from benchmarks.independent.logs import Errors, Log, Plan, record

SPEEDS = tuple(float(s) for s in np.geomspace(8.0, 160.0, 10).round(2))
FIVE, TWO = (80.0, 105.0, 130.0, 155.0, 180.0), (80.0, 180.0)
_LONG = Plan(SPEEDS, FIVE)
PARAMETERS = ("a", "b", "c", "w_t")
#: Half widths of a normal 95 % interval in standard errors.
REACH = 1.959964
#: s of a standstill that is long enough to tare with.
REST = 8.0


@dataclass(frozen=True)
class Setting:
    """What is wrong with a bench, and how its test is run."""

    errors: Errors
    plan: Plan = _LONG
    tare: bool = False

    @property
    def noise_alone(self) -> bool:
        """Whether nothing but the noise of the samples is wrong."""
        e = self.errors
        return not (e.scatter or e.visit or e.drift or e.heating)


_TARED = Plan(SPEEDS, FIVE, standing=REST)
SETTINGS: dict[str, Setting] = {
    "plain": Setting(Errors()),
    "slow05": Setting(Errors(slow_noise=0.02, tau=0.5)),
    "slow1": Setting(Errors(slow_noise=0.02, tau=1.0)),
    "scatter": Setting(Errors(scatter=0.01)),
    "visit5": Setting(Errors(visit=0.03)),
    "visit2": Setting(Errors(visit=0.03), Plan(SPEEDS, TWO)),
    "both5": Setting(Errors(visit=0.03, scatter=0.01)),
    "both2": Setting(Errors(visit=0.03, scatter=0.01), Plan(SPEEDS, TWO)),
    "line": Setting(Errors(scatter=0.003, zero=0.05, drift=0.03), _TARED, tare=True),
    "walk": Setting(Errors(scatter=0.003, zero=0.05, drift=0.03, walk=True), _TARED, tare=True),
    "heating": Setting(Errors(scatter=0.003, heating=3.0)),
    "up": Setting(Errors(scatter=0.01), Plan(SPEEDS, FIVE, up_down=False)),
    "up-both5": Setting(Errors(visit=0.03, scatter=0.01), Plan(SPEEDS, FIVE, up_down=False)),
}
#: With a transition the speed of which sweeps the range: 6 rpm when cold, 66 rpm when hot.
WITH = "+t"
NAMES = tuple(name + ending for name in SETTINGS for ending in ("", WITH))


@dataclass(frozen=True)
class Interval:
    """Of one parameter on one log: whether it is told, holds the truth, and its width over the least."""

    told: bool
    holds: float = 0.0  #: 1 or 0, or the share of the dwells
    ratio: float = np.nan


Row = dict[str, Interval]


def one_log(seed: int, name: str, index: int) -> Row | str:
    """Return the intervals of one log, or the message with which it was refused."""
    setting, transition = SETTINGS[name.removesuffix(WITH)], name.endswith(WITH)
    law = TwoBranches() if transition else PowerLaw()
    log = record(law, setting.plan, setting.errors, generator(seed, name, index))
    found = judged(log, tare=setting.tare, heating=setting.errors.heating, verdict=False)
    if found.surface is None:
        return found.refusal
    reference = found.surface.reference_temperature
    celsius = MIDDLE if reference is None else reference - 273.15
    least = least_errors(law, log, setting.plan, setting.errors, celsius, tare=setting.tare)
    estimates, truths = _estimates(found.surface), _truths(law, celsius)
    intervals = {
        p: _interval(estimates.get(p), truths[p], least[p], logarithm=p in ("a", "w_t"))
        for p in PARAMETERS
        if p in truths
    }
    if found.points is not None and setting.noise_alone:
        intervals["dwell"] = _of_dwells(found.points, log, setting)
    return intervals


def _of_dwells(points: hersey.SteadyPoints, log: Log, setting: Setting) -> Interval:
    """The share of the dwells whose torque is the law's within its error, and how wide that is."""
    at = 0.5 * (points.column("start") + points.column("end"))
    nearest = np.abs(at[:, None] - log.middle[None, :]).argmin(axis=1)
    off = np.log(points.column("torque") / log.dwell_torque[nearest])
    error = points.column("torque_error") / points.column("torque")
    least = np.sqrt(variance_of_means(log, setting.plan, setting.errors))[nearest]
    held = float(np.mean(np.abs(off) <= REACH * error))
    return Interval(True, held, float(np.median(error / least)))


def _truths(law: PowerLaw, celsius: float) -> dict[str, float]:
    truths = {"a": law.a, "b": law.b, "c": law.c}
    if isinstance(law, TwoBranches):
        truths["w_t"] = float(law.transition_speed(np.array(celsius)))
    return truths


def _estimates(surface: hersey.DampingSurface) -> dict[str, hersey.Estimate | None]:
    speed = surface.transition.speed if surface.transition else None
    return {"a": surface.a, "b": surface.b, "c": surface.c, "w_t": speed}


def _interval(found: hersey.Estimate | None, truth: float, least: float, *, logarithm: bool) -> Interval:
    if found is None or not np.all(np.isfinite([found.value, found.low, found.high])):
        return Interval(told=False)
    value, low, high = found.value, found.low, found.high
    if logarithm:
        if low <= 0.0:
            return Interval(told=True, holds=float(truth <= high))
        value, low, high, truth = (float(np.log(x)) for x in (value, low, high, truth))
    return Interval(True, float(low <= truth <= high), float((high - low) / (2.0 * REACH * least)))


def table(results: dict[str, list[Row | str]]) -> list[str]:
    """Return the lines of the table: per setting and parameter, told, holding, and the ratio of widths."""
    lines = [
        "| setting | logs | parameter | told | hold the truth | width over the least: median | 90 % |",
        "|---|---|---|---|---|---|---|",
    ]
    for name, rows in results.items():
        kept: list[Row] = [row for row in rows if isinstance(row, dict)]
        for parameter in kept[0] if kept else ():
            lines.append(_line(name, parameter, [row[parameter] for row in kept]))
        refused = len(rows) - len(kept)
        if refused:
            why = next(row for row in rows if isinstance(row, str))
            lines.append(f"| {name} | {refused} | refused: {why[:80]} | | | | |")
    return lines


def _line(name: str, parameter: str, each: list[Interval]) -> str:
    known = [i for i in each if i.told]
    share = f"{len(known) / len(each):.0%}"
    if not known:
        return f"| {name} | {len(each)} | {parameter} | {share} | | | |"
    holds = float(np.mean([i.holds for i in known]))
    middle, most = np.nanquantile([i.ratio for i in known], [0.5, 0.9])
    return f"| {name} | {len(each)} | {parameter} | {share} | {holds:.1%} | {middle:.2f} | {most:.2f} |"
