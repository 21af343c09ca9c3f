"""What must be known before a fit is trusted: said alike by every command that fits."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells import SteadyPoints
from hersey.damping.dwells.doubtful import doubtful_order, doubtful_tare
from hersey.damping.dwells.misleading import in_words, misleading
from hersey.damping.surface import DampingSurface
from hersey.errors import ROTATION
from hersey.log.doubtful import doubtful_units
from hersey.units import celsius
from hersey.verdict.held_values import held_values

#: A difference between directions counts as one beyond this share and this many standard errors.
NOTABLE_DIFFERENCE, SIGNIFICANT = 0.02, 3.0
#: Temperature beyond those of a no-load log, K, from which it is said to be extrapolated.
FAR = 10.0
#: p-value of chance below which a scatter of whole visits is spoken of.
SURE = 0.01


def cautions(points: SteadyPoints, surface: DampingSurface | None) -> list[str]:
    """Return what must be known before a fit is trusted, in sentences: the same for every command.

    Without a surface, where dwells bear none, what is known of log and dwells alone.
    """
    log = points.log
    out = [f"Corrected: {correction}." for correction in log.corrections]
    for file, run in zip(log.files, log.runs or (None,) * len(log.files), strict=True):
        if file.synthetic:
            out.append(f"{file.name} is synthetic, by its own words: no measurement.")
        if file.cut_off:
            out.append(f"{file.name}: the file ends before its time.")
        out += [each.within(file.name).sentence for each in file.warnings]
        if run is not None and run.gaps():
            share = 1.0 - run.time.size * run.sampling_interval / max(float(run.time[-1] - run.time[0]), 1e-9)
            out.append(
                f"{file.name}: rows are missing at {run.gaps()} places ({max(share, 0):.1%} of the time)."
            )
    out += [each.sentence for each in doubtful_units(log)]
    out += held_values(log)
    out += doubtful_tare(points)
    out += points.notes
    out += _rest_warnings(points)
    if loads := points.varying_load:
        low, high = loads
        out.append(
            f"The load differs from {low:.3g} to {high:.3g} N, and one law is fitted to all dwells: fit "
            "each load alone."
        )
    swinging = [r for r in points.rejected if r.why.kind == "stick-slip"]
    if swinging:
        out.append(
            f"Stick-slip was recorded: {len(swinging)} "
            f"{'stretch' if len(swinging) == 1 else 'stretches'} of held speed, left out of the fit."
        )
    if surface is not None:
        out += _direction_warnings(points, surface)
    out += [str(each) for each in doubtful_order(points)]
    out += [in_words(found, points) for found in misleading(points)]
    if surface is not None:
        out += _fit_warnings(surface)
    return out


def _rest_warnings(points: SteadyPoints) -> list[str]:
    """What was taken off for the no-load torque, and what is not known of it."""
    rest = points.rest
    if rest is None:
        return []
    out = [f"Taken off, so that torque is that of the film: {rest}."]
    out += [f"Of the no-load torque: {note}." for note in rest.notes]
    if not points.log.has_temperature:
        if rest.reference_temperature is not None:
            at = f"{celsius(rest.reference_temperature):.0f} degC"
            out.append(f"The log holds no temperatures: the no-load torque is that at {at}.")
    elif rest.temperature_range is not None:
        kelvin, (cold, hot) = points.column("temperature"), rest.temperature_range
        if float(kelvin.min()) < cold - FAR or float(kelvin.max()) > hot + FAR:
            out.append(
                f"{rest.source} holds the no-load torque at {celsius(cold):.0f} to {celsius(hot):.0f} "
                f"degC, and the dwells lie at {celsius(float(kelvin.min())):.0f} to "
                f"{celsius(float(kelvin.max())):.0f} degC: it is extrapolated."
            )
    return out


def _direction_warnings(points: SteadyPoints, surface: DampingSurface) -> list[str]:
    out = []
    forward = points.column("speed") > 0
    approach = np.asarray(points.table["approach"].to_list())
    pairs: Sequence[tuple[FloatArray, FloatArray, str, str]] = (
        (surface.residuals[forward], surface.residuals[~forward], "forward", "reverse rotation"),
        (
            surface.residuals[approach == "from below"],
            surface.residuals[approach == "from above"],
            "dwells approached from below",
            "from above",
        ),
    )
    for first, second, name, other in pairs:
        if first.size > 2 and second.size > 2:
            difference = float(first.mean() - second.mean())
            error = float(np.hypot(first.std() / first.size**0.5, second.std() / second.size**0.5))
            if abs(difference) > max(NOTABLE_DIFFERENCE, SIGNIFICANT * error):
                advice = f"; fit one alone with {ROTATION.to()}" if name == "forward" else ""
                out.append(
                    f"Torque differs by {np.expm1(difference):+.1%} between {name} and {other}: "
                    f"one surface does not describe both{advice}."
                )
    return out


def _fit_warnings(surface: DampingSurface) -> list[str]:
    out = []
    for name, estimate in surface.torque_space.items():
        coefficient = {"a": surface.a, "b": surface.b, "c": surface.c}[name]
        if (
            coefficient
            and name != "a"
            and abs(coefficient.value - estimate.value)
            > max(0.005, 2.0 * np.hypot(coefficient.error, estimate.error))
        ):
            out.append(
                f"Exponent {name} is {coefficient.value:.3f} fitted in logarithms but {estimate.value:.3f} "
                "fitted in torque, which weighs dwells of great torque most: see what the residuals leave."
            )
    if surface.temperature_range:
        low, high = (celsius(t) for t in surface.temperature_range)
        if high - low < 30.0:
            out.append(
                f"Temperature spans only {low:.0f} to {high:.0f} degC: a and b are strongly correlated, and "
                "the law must not be used far outside."
            )
    out += _shared_warnings(surface)
    if surface.statistics.scatter > 0.05:
        out.append(
            f"Dwells stand {surface.statistics.scatter:.0%} off the surface, more than their noise explains: "
            "scatter between dwells, or a law that does not hold."
        )
    return out


def _shared_warnings(surface: DampingSurface) -> list[str]:
    """What the dwells of a visit to a temperature, or of a run, have in common."""
    out = []
    for shared in surface.statistics.shared:
        if not shared.told and surface.b is not None and not surface.b.estimable:
            out.append(
                f"Exponent b is {surface.b.value:.3g}, its interval not told: each temperature was visited "
                "once, so that an error of a whole visit would pass for temperature. Visit one again, "
                "or a third."
            )
        if shared.deviation > 0 and shared.p_value < SURE:
            chance = f"p = {shared.p_value:.1g} for chance"
            out.append(
                f"All dwells of one {shared.name} stand off the law together, by {shared.deviation:.1%} "
                f"({chance}): the intervals count {shared.name}s, not dwells."
            )
    return out
