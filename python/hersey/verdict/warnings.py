"""What must be known before a fit is trusted: said alike by every command that fits."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells import SteadyPoints
from hersey.damping.dwells.doubtful import constant_load, doubtful_order, doubtful_tare
from hersey.damping.dwells.misleading import misleading
from hersey.damping.friction_curve.result import FrictionCurve
from hersey.damping.moving.beside_dwells import motion_beside
from hersey.damping.surface import DampingSurface
from hersey.errors import ROTATION
from hersey.log.doubtful import doubtful_units
from hersey.log.layouts.recognized import LAYOUT_RECOGNIZED
from hersey.log.means import MeansTable
from hersey.log.torque_log import TorqueLog
from hersey.schema.warning import Warning
from hersey.verdict.held_values import held_values

#: A difference between directions counts as one beyond this share and this many standard errors.
NOTABLE_DIFFERENCE, SIGNIFICANT = 0.02, 3.0
#: Temperature beyond those of a no-load log, K, from which it is said to be extrapolated.
FAR = 10.0
#: p-value of chance below which a scatter of whole visits is spoken of.
SURE = 0.01
#: Temperatures that span less than this, K, are few.
LEAST_SPAN = 30.0
#: Scatter of dwells about the surface beyond which it is spoken of.
SCATTER = 0.05


def warnings_of(
    points: SteadyPoints, surface: DampingSurface | None, friction: FrictionCurve | None = None
) -> tuple[Warning, ...]:
    """Return what must be known before a fit is trusted: the same for every command.

    Without a surface, where dwells allow none, what is known of log and dwells alone. Where a ``friction``
    curve leads, it is the fit, and its directions may differ.
    """
    log = points.log
    found = [Warning("corrected", "corrected: {how}", how=str(correction)) for correction in log.corrections]
    found += [each for i in range(len(log.files)) for each in _of_file(log, i)]
    found += [*doubtful_units(log), *held_values(points), *constant_load(points)]
    found += [*doubtful_tare(points), *points.warnings]
    found += _of_rest(points)
    if (loads := points.varying_load) and points.domain.quantity != "friction coefficient":
        words = "one law is fitted to loads from {low:.3g} to {high:.3g} N. Fit each load separately"
        found.append(Warning("loads differ", words, severity="watch", low=loads[0], high=loads[1]))
    if swinging := sum(each.why.kind == "stick-slip" for each in points.rejected):
        words = (
            "the log contains {count} {count:stretch|stretches} of stick-slip at constant speed, "
            "which the fit excludes"
        )
        found.append(Warning("stick-slip", words, count=swinging))
    found += motion_beside(points)
    if surface is not None:
        found += _of_directions(points, surface, apart=friction is not None and friction.apart)
    found += [*doubtful_order(points), *misleading(points, exponents=friction is None)]
    if friction is not None:
        found += _of_scatter(friction.scatter)
    elif surface is not None:
        found += _of_fit(surface)
    return tuple(each.about(points.domain) for each in found)


def _of_file(log: TorqueLog | MeansTable, i: int) -> Iterator[Warning]:
    """What is to be known of a file of a log, which has one run, or none if it states means."""
    file, run = log.files[i], (log.runs[i] if log.runs else None)
    if file.synthetic:
        words = "the log says of itself that it is synthetic, not a measurement"
        yield Warning("synthetic", words, severity="watch", where=file.name)
    if file.cut_off:
        yield Warning("cut off", "the file ends too early", severity="watch", where=file.name)
    whole = file.name.partition(", run ")[0]
    yield from (
        warning.within(whole if warning.kind == LAYOUT_RECOGNIZED else file.name) for warning in file.warnings
    )
    lifted = any(warning.kind == "rows without contact" for warning in file.warnings)
    if run is not None and run.clock.gaps and not lifted:
        yield Warning(
            "gaps",
            "rows are missing at {places} {places:place|places} ({share:.1f %} of the time)",
            severity="watch",
            where=file.name,
            places=run.clock.gaps,
            share=run.clock.lost / run.clock.duration,
        )


def _of_rest(points: SteadyPoints) -> Iterator[Warning]:
    """What was subtracted for the no-load torque, and what is not known of it."""
    rest = points.rest
    if rest is None:
        return
    yield Warning("no-load torque", "no-load torque subtracted: {rest}", rest=str(rest))
    yield from (warning.within("no-load torque") for warning in rest.warnings)
    if not points.log.has_temperature:
        if rest.reference_temperature is not None:
            words = "the log has no temperatures, so the no-load torque at {temperature:.0f degC} is used"
            at = rest.reference_temperature
            yield Warning("no-load torque of one temperature", words, severity="watch", temperature=at)
    elif rest.temperature_range is not None:
        kelvin, (cold, hot) = points.column("temperature"), rest.temperature_range
        coldest, hottest = float(kelvin.min()), float(kelvin.max())
        if coldest < cold - FAR or hottest > hot + FAR:
            yield Warning(
                "no-load torque extrapolated",
                "{source} covers {cold:.0f degC} to {hot:.0f degC}, the dwells {coldest:.0f degC} to "
                "{hottest:.0f degC}: no-load torque is extrapolated",
                severity="watch",
                source=rest.source,
                cold=cold,
                hot=hot,
                coldest=coldest,
                hottest=hottest,
            )


def _of_directions(points: SteadyPoints, surface: DampingSurface, *, apart: bool) -> Iterator[Warning]:
    """Directions of rotation, unless they are fitted ``apart``, and of approach that differ."""
    forward = points.column("speed") > 0
    approach = np.asarray(points.table["approach"].to_list())
    below, above = approach == "from below", approach == "from above"
    pairs: Sequence[tuple[FloatArray, FloatArray, str, str]] = (
        (surface.residuals[forward], surface.residuals[~forward], "forward", "reverse rotation"),
        (
            surface.residuals[below],
            surface.residuals[above],
            "dwells approached from below",
            "those from above",
        ),
    )
    for first, second, name, other in pairs[apart:]:
        if first.size > 2 and second.size > 2:
            difference = float(first.mean() - second.mean())
            error = float(np.hypot(first.std() / first.size**0.5, second.std() / second.size**0.5))
            if abs(difference) > max(NOTABLE_DIFFERENCE, SIGNIFICANT * error):
                yield Warning(
                    "directions differ",
                    "{measured} differs by {share:+.1f %} between {first} and {second}, so one surface "
                    "does not describe both"
                    + (". Fit each separately with {how}" if name == "forward" else ""),
                    severity="watch",
                    share=float(np.expm1(difference)),
                    first=name,
                    second=other,
                    how=ROTATION,
                )


def _of_fit(surface: DampingSurface) -> Iterator[Warning]:
    for name, estimate in surface.torque_space.items():
        coefficient = {"a": surface.a, "b": surface.b, "c": surface.c}[name]
        if coefficient is None or name == "a":
            continue
        value, other = coefficient.value, estimate.value
        if abs(value - other) > max(0.005, 2.0 * np.hypot(coefficient.error, estimate.error)):
            yield Warning(
                "fitted in torque",
                "exponent {name} is {value:.3f} fitted in logarithms, but {other:.3f} fitted in "
                "{measured}, where high values weigh most. Look at the residuals",
                severity="watch",
                name=name,
                value=value,
                other=other,
            )
    if surface.temperature_range:
        low, high = surface.temperature_range
        if high - low < LEAST_SPAN:
            yield Warning(
                "few temperatures",
                "temperature ranges only from {low:.0f degC} to {high:.0f degC}, so a and b are "
                "strongly correlated. Do not extrapolate far",
                severity="watch",
                low=low,
                high=high,
            )
    yield from _of_visits(surface)
    yield from _of_scatter(surface.statistics.scatter)


def _of_scatter(scatter: float) -> Iterator[Warning]:
    """Dwells that scatter about the fit by more than their noise."""
    if scatter > SCATTER:
        words = (
            "points scatter {scatter:.0f %} about the fit, more than sensor noise explains. "
            "Something unrecorded varied, or the model is wrong"
        )
        yield Warning("scatter", words, severity="watch", scatter=scatter)


def _of_visits(surface: DampingSurface) -> Iterator[Warning]:
    """What the dwells of a visit to a temperature, or of a run, have in common."""
    for shared in surface.statistics.shared:
        if not shared.estimable and surface.b is not None and not surface.b.estimable:
            yield Warning(
                "temperatures visited once",
                "exponent b is {value:.3g} without an interval: each temperature was visited once, "
                "so errors of a whole visit cannot be excluded. Visit one temperature again, or a "
                "third one",
                severity="watch",
                value=surface.b.value,
            )
        if shared.deviation > 0 and shared.p_value < SURE:
            yield Warning(
                "dwells off together",
                "all dwells of one {visit} deviate together by {deviation:.1f %} ({p_value:p} for "
                "chance), so intervals count {visit}s, not dwells",
                severity="watch",
                visit=shared.name,
                deviation=shared.deviation,
                p_value=shared.p_value,
            )
