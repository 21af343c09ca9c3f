"""From a log to the friction of its coast-downs: ``hersey coastdown``."""

from __future__ import annotations

from itertools import compress
from typing import Any

import numpy as np

from hersey.damping.coast_down.coasts import Coast, LeftOut, coasts_in
from hersey.damping.coast_down.departures import of_bound, of_coasts, of_shape
from hersey.damping.coast_down.doubts import Doubts, no_coast
from hersey.damping.coast_down.ends import is_free, without_ends
from hersey.damping.coast_down.fitting import CoastFit, Trace, fit_coasts, within_physics
from hersey.damping.coast_down.result import CoastDown, Friction, estimates_of, speeds_of
from hersey.damping.coast_down.windows import windows_of
from hersey.damping.distributions import student_quantile
from hersey.damping.inertia import NORMAL, inertia_of
from hersey.log.reading import read
from hersey.log.torque_log import TorqueLog
from hersey.units import takes_si


@takes_si()
def coast_down(log: Any, *, inertia: Any) -> CoastDown:
    """Return the friction torque of a wheel from its coast-downs: speed against time, no torque.

    Parameters
    ----------
    log
        A `TorqueLog` (``hersey.read(..., without_torque=True)``, or any other, whose torque is not used), or
        what `hersey.read` takes: files or frames.
    inertia
        Moment of inertia of all that turns, kg m^2, or text with its 95 % error: ``"0.012 kg*m^2 ± 2 %"``.
        Without an error it is taken as exact.

    Raises
    ------
    InsufficientDataError
        If speed falls freely nowhere in the log.
    ParameterError, UnitError
        If the inertia is no positive moment of inertia.

    Examples
    --------
    >>> import numpy as np, polars as pl, hersey
    >>> time = np.arange(0.0, 30.0, 0.05)
    >>> speed = 100.0 * np.exp(-0.1 * time) + 0.01 * np.sin(70.0 * time)
    >>> log = pl.DataFrame({"time [s]": time, "speed [rad/s]": speed})
    >>> hersey.coast_down(log, inertia="0.012 kg*m^2 ± 2 %").terms_shown
    ('viscous',)
    """
    known = inertia_of(inertia)
    read_log = log if isinstance(log, TorqueLog) else read(log, without_torque=True)
    read_log.domain.require_rotation("a coast-down")
    coasts, left_out = _found(read_log)
    if not coasts:
        raise no_coast(read_log, left_out)
    coasts = without_ends(coasts)
    fit = fit_coasts([Trace(each.time, each.speed) for each in coasts])
    law, distance = within_physics(fit)
    shape, bound, (differing, between) = of_shape(fit), of_bound(fit, law, distance), of_coasts(fit)
    scale = known.value
    shared = float(np.hypot(known.error / scale, _of_the_mean(between, len(coasts))))
    friction = Friction(scale * law, scale * fit.law, scale**2 * fit.covariance, fit.freedom, shared)
    speeds = speeds_of(fit)
    torque, _, low, high = friction.estimate(speeds[:, None] ** np.arange(law.size))
    coulomb, viscous, windage = estimates_of(friction, speeds, high)
    return CoastDown(
        inertia=known,
        coulomb=coulomb,
        viscous=viscous,
        windage=windage,
        speeds=speeds,
        torque=torque,
        low=low,
        high=high,
        coasts=tuple(coasts),
        left_out=tuple(left_out),
        noise=_noise(fit),
        effective_rows=fit.noise.effective_rows,
        difference=between,
        warnings=tuple(
            Doubts(
                log=read_log,
                coasts=coasts,
                left_out=left_out,
                fit=fit,
                terms=(coulomb, viscous, windage),
                speeds=speeds,
                torque=torque,
                shape=shape,
                bound=bound,
                differing=differing,
                inertia=known,
            ).warnings()
        ),
        friction=friction,
        fit=fit,
        windows=tuple(windows_of(fit)),
        log=read_log,
    )


def falls_freely(log: TorqueLog) -> bool:
    """Return whether a wheel may coast in a log of its speed: its longest fall is looked at."""
    if log.domain.speed != "speed":
        return False
    falls = [coast for index, run in enumerate(log.runs) for coast in coasts_in(run, index)[0]]
    return bool(falls) and is_free(max(falls, key=lambda each: each.rows))


def _found(log: TorqueLog) -> tuple[list[Coast], list[LeftOut]]:
    """The coasts of a log, and what else it holds.

    If a drive sets most falls of speed, only those count that end at rest.
    """
    falls: list[Coast] = []
    left_out: list[LeftOut] = []
    for index, run in enumerate(log.runs):
        here, others = coasts_in(run, index)
        falls += here
        left_out += others
    free = [is_free(each) for each in falls]
    if 2 * sum(compress((each.rows for each in falls), free)) < sum(each.rows for each in falls):
        free = [kept and each.stops for each, kept in zip(falls, free, strict=True)]
    coasts = list(compress(falls, free))
    driven = [each for each, kept in zip(falls, free, strict=True) if not kept]
    return coasts, [*left_out, *(LeftOut(c.run, c.start, c.end, c.rows, "driven") for c in driven)]


def _of_the_mean(between: float, count: int) -> float:
    """Standard error of the mean of coasts that differ, so that 1.96 times it holds in 95 %."""
    if between == 0.0:
        return 0.0
    return float(between / np.sqrt(count) * student_quantile(0.975, count - 1) / NORMAL)


def _noise(fit: CoastFit) -> float:
    """Standard deviation of the speeds about the fit."""
    rest = [trace.speed - fit.predicted(i, trace.time) for i, trace in enumerate(fit.traces)]
    return float(np.sqrt(np.mean(np.concatenate(rest) ** 2)))
