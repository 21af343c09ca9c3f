"""The no-load torque from a log recorded without the film: roll lifted, or belt removed.

Fitted in the likelihood of the candidate laws, to torque itself: dwells with their errors, a scatter between
them, and what they share (the zero of torque, visits to a temperature, runs).
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from hersey.cache.kept import kept
from hersey.damping.candidates.fitting import LawFit, fit_law
from hersey.damping.candidates.lack_of_fit import DOES_NOT_HOLD, lack_of_fit
from hersey.damping.candidates.no_load_law import KELVIN, RestLaw
from hersey.damping.candidates.observations import Observations
from hersey.damping.dwells import SteadyPoints, distinct_speeds
from hersey.damping.dwells.reduced import require_points
from hersey.damping.no_load_torque import NoLoadTorque, estimates_of
from hersey.errors import TARE, InsufficientDataError, ParameterError, turned
from hersey.log.sensors import SHARE_OF_LARGEST, Sensors
from hersey.schema.warning import Warning
from hersey.units import takes_si

#: Dwells beyond the numbers fitted.
_SPARE = 2
#: Variance of the slope by a scatter of visits that is unknown, over that by as much of dwells: a little.
_LITTLE = 0.1
#: Deviation from the line, as a share of the torque, from which a bend is spoken of.
_SEEN = 1e-3


@takes_si()
@kept()
def no_load_torque(points: SteadyPoints) -> NoLoadTorque:
    """Fit the no-load torque: a constant part, a part proportional to speed, and its temperature slope.

    Parameters
    ----------
    points
        Steady points of a log recorded without the film, e.g. with the roll lifted or the belt removed.

    Returns
    -------
    NoLoadTorque
        A part that the log cannot show is set to zero, with an unbounded interval and a warning: with one
        speed the part proportional to speed, with one temperature the temperature slope.

    Raises
    ------
    InsufficientDataError
        If there are too few dwells, or the fitted torque is not positive.

    Examples
    --------
    >>> table = {"speed [rpm]": [10, 20, 40, 80, 160], "torque [mN*m]": [21.1, 21.9, 24.3, 28.3, 36.8]}
    >>> print(no_load_torque(SteadyPoints.from_table(table)))
    20 mN m + 1 mN m s/rad times speed (table)
    """
    require_points(points, "hersey.no_load_torque({points})")
    points.domain.require_torque("a no-load torque")
    name = points.log.files[0].name
    _refuse_corrected(points, name)
    speed = np.abs(points.column("speed"))
    data, scale = _observations(points)
    law = _law(name, data)
    fit = fit_law(law, data)
    least = float(np.min(law.predict(fit.values, data.inputs))) * scale
    if not least > 0:
        raise InsufficientDataError(
            f"{name}: the fitted no-load torque falls to {1e3 * least:.3g} mN m but must be positive. "
            f"Subtract the sensor's zero ({TARE.to('standing')}), or flip the sign with "
            f"{turned('torque')}"
        )
    units = {"constant": scale, "per_speed": scale / data.reference_speed, "temperature_slope": 1.0 / KELVIN}
    by = np.array([[units[n] if n == fitted else 0.0 for fitted in law.names] for n in units])
    covariance = by @ fit.covariance @ by.T
    freedoms = np.array([fit.freedom_of(n) if n in law.names else np.inf for n in units])
    estimable = tuple(n for n in law.names if n != "temperature_slope" or not _of_visits(fit))
    constant, per_speed, slope = estimates_of(by @ fit.values, covariance, freedoms, estimable)
    kelvin, sensors = data.inputs.kelvin, points.log.sensors
    zero = sensors.torque_zero
    if zero is None:
        zero = SHARE_OF_LARGEST * scale * float(np.max(np.abs(data.log_torque)))
    by_speed = abs(per_speed.value) * float(np.hypot(sensors.torque_gain, sensors.speed_gain))
    return NoLoadTorque(
        constant=constant.with_systematic(float(np.hypot(sensors.torque_gain * constant.value, zero))),
        per_speed=per_speed.with_systematic(by_speed),
        temperature_slope=slope,
        reference_temperature=law.reference,
        covariance=covariance,
        freedom=float(np.min(freedoms)),
        source=name,
        sha256=tuple(file.sha256 for file in points.log.files),
        speed_range=(float(speed.min()), float(speed.max())),
        temperature_range=None if kelvin is None else (float(kelvin.min()), float(kelvin.max())),
        warnings=_warnings(law, fit, data),
    )


def _refuse_corrected(points: SteadyPoints, name: str) -> None:
    if any(c.name.startswith("no-load") for c in points.log.corrections):
        raise ParameterError(
            f"{name}: the mapping subtracts a no-load torque from this log too. Remove no_load from "
            "the mapping"
        )


def _law(name: str, data: Observations) -> RestLaw:
    """The parts that speeds and temperatures can tell, if there are dwells enough for them."""
    kelvin, several = data.inputs.kelvin, data.temperatures.size > 1
    law = RestLaw(
        distinct_speeds(data.speed) > 1, float(np.mean(kelvin)) if kelvin is not None and several else None
    )
    if len(data) < len(law.names) + _SPARE:
        raise InsufficientDataError(
            f"{name}: {len(data)} dwells are too few for the no-load torque and its error; at least "
            f"{len(law.names) + _SPARE} are needed"
        )
    return law


def _observations(points: SteadyPoints) -> tuple[Observations, float]:
    """Torque over its median size in place of ln torque, and that size; no film is there to be heated."""
    plain = replace(points, log=replace(points.log, sensors=Sensors()))
    # a torque of nothing has no logarithm and needs none
    with np.errstate(divide="ignore", invalid="ignore"):
        data = Observations.of(plain, fewest_speeds=1)
    sign = np.sign(points.column("speed"))
    signed = points.column("torque") * sign
    scale = float(np.median(np.abs(signed))) or 1.0
    torque: dict[str, Any] = {
        "log_torque": signed / scale,
        "torque_error": points.column("torque_error") / scale,
        "tare": points.tare_errors * sign[:, None] / scale,
    }
    return replace(data, **torque), scale


def _of_visits(fit: LawFit) -> bool:
    """Whether the slope in temperature depends on a scatter of visits that is unknown."""
    moved = fit.freedoms.moved_by_untold
    return bool(moved.size and moved[fit.law.index("temperature_slope")] >= _LITTLE)


def _warnings(law: RestLaw, fit: LawFit, data: Observations) -> tuple[Warning, ...]:
    """What the log leaves open."""
    kelvin = data.inputs.kelvin
    found = []
    if not law.with_speed:
        words = (
            "the no-load log has only one speed, {speed:.3g rpm}, so its increase with speed is "
            "assumed zero. Record other speeds"
        )
        found.append(Warning("one speed", words, severity="watch", speed=float(np.mean(data.speed))))
    if kelvin is not None and law.reference is None:
        words = (
            "the no-load log has only one temperature, {temperature:.0f degC}, so its temperature "
            "dependence is assumed zero. Record another"
        )
        temperature = float(np.mean(kelvin))
        found.append(Warning("one temperature", words, severity="watch", temperature=temperature))
    if law.reference is not None and _of_visits(fit):
        words = (
            "the no-load log visits each temperature once, so its temperature slope has no interval. "
            "Visit one again"
        )
        found.append(Warning("each temperature once", words, severity="watch"))
    lack = lack_of_fit(fit, data)
    if lack.curvature is not None and lack.curvature < DOES_NOT_HOLD and np.std(fit.residuals) > _SEEN:
        words = "the no-load torque is not a straight line against speed ({p_value:p})"
        found.append(Warning("no line", words, severity="watch", p_value=lack.curvature))
    return tuple(found)
