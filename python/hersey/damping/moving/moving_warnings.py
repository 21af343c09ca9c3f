"""What is to be known of the fit of a moving log."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hersey.damping.friction_curve.law import COULOMB, VISCOUS
from hersey.damping.moving.gravity import AMPLITUDE, HANGING, arc_of
from hersey.damping.moving.model import DELAY, INERTIA, OFFSET, Equations
from hersey.damping.moving.stretches import counting_step
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    from hersey.damping.moving.result import MovingFit

#: Share of the rows near standstill that is worth a word, and of the torque left unexplained.
_MUCH, _LEFT = 0.5, 0.1
#: Relative error of the inertia, or of gravity across its arc, beyond which it is not known.
_UNKNOWN = 0.5
#: Share of the variance of the acceleration that counts of a position may make, and of a derivative that rows
#: may lose.
_COARSE, _LOST = 5e-3, 0.01
#: Standard errors from which an offset is one.
CLEAR_OFFSET = 3.0


def moving_warnings(fit: MovingFit, equations: Equations) -> tuple[Warning, ...]:
    """Return the warnings of a fit."""
    found = (
        _misfit(fit),
        _one_way(equations),
        *_alike(fit),
        _zero(fit),
        _standing(fit),
        _left(fit),
        _inertia(fit),
        _gravity(fit, equations),
        _counts(fit, equations),
        _far_apart(equations),
        _delay(fit),
    )
    return tuple(each for each in found if each is not None)


def _one_way(equations: Equations) -> Warning | None:
    if np.any(equations.speed > 0) and np.any(equations.speed < 0):
        return None
    return Warning(
        "torque zero unknown",
        "the drive moves in one direction only, so a torque zero cannot be separated from Coulomb friction; "
        "it is taken as 0",
        severity="watch",
        remedy='record both directions, or set tare = "4 mN*m" under [torque] in hersey.toml',
    )


def _alike(fit: MovingFit) -> list[Warning]:
    """That friction at the speeds of this log is known better than its parts."""
    slow, fast = fit.speed_range
    of_friction = [fit.parameters[i] for i in fit.fitted.law.friction.places(COULOMB, VISCOUS)]
    unsure = [each.name for each in of_friction if each.estimate.error > _UNKNOWN * abs(each.estimate.value)]
    if not unsure:
        return []
    return [
        Warning(
            "speeds alike",
            "{names} cannot be determined from speeds of {slow:.3g rpm} to {fast:.3g rpm} with this noise; "
            "the torque at these speeds is known better",
            severity="watch",
            remedy="record a wider range of speeds",
            names=", ".join(unsure),
            slow=slow,
            fast=fast,
        )
    ]


def _zero(fit: MovingFit) -> Warning | None:
    if OFFSET not in fit or abs(fit[OFFSET].value) < CLEAR_OFFSET * fit[OFFSET].error:
        return None
    return Warning(
        "offset or direction",
        "the offset is half the difference of both directions: a torque zero, or friction that differs by "
        "direction",
        severity="note",
    )


def _standing(fit: MovingFit) -> Warning | None:
    if fit.near_standstill < _MUCH:
        return None
    return Warning(
        "near standstill",
        "{share:.0f %} of the log is slower than {speed:.2g rpm} and is not used",
        severity="watch",
        share=fit.near_standstill,
        speed=fit.least_speed,
    )


def _left(fit: MovingFit) -> Warning | None:
    if 1.0 - fit.explained < _LEFT:
        return None
    return Warning(
        "torque unexplained",
        "the law explains only {share:.0f %} of the square of the torque; something else acts, such as "
        "gravity, a ripple or a varying load",
        severity="watch",
        share=fit.explained,
    )


def _inertia(fit: MovingFit) -> Warning | None:
    if INERTIA not in fit:
        return None
    known = fit[INERTIA]
    if known.value > 0.0 and known.error < _UNKNOWN * known.value:
        return None
    return Warning(
        "inertia unknown",
        "this motion hardly shows the moment of inertia",
        severity="note",
        remedy="accelerate faster, or give it",
    )


def _misfit(fit: MovingFit) -> Warning | None:
    if fit.misfit is None:
        return None
    return Warning(
        "law does not fit",
        "friction is {share:.2g %} {sign:less|more} than this law near {speed:.2g rpm}, beyond noise "
        "({p_value:p}); do not use its numbers at other speeds",
        severity="watch",
        share=abs(fit.misfit.share),
        sign=1 if fit.misfit.share < 0.0 else 2,
        speed=abs(fit.misfit.speed),
        p_value=fit.misfit.p_value,
    )


def _gravity(fit: MovingFit, equations: Equations) -> Warning | None:
    if AMPLITUDE not in fit or fit[HANGING].error < _UNKNOWN:  # rad
        return None
    return Warning(
        "gravity or offset",
        "a load varies with the angle, but over an arc of {arc:.2g}° gravity cannot be separated from the "
        "offset; friction is not affected",
        severity="note",
        remedy="record a larger arc",
        arc=float(np.degrees(arc_of([each.stretch for each in equations.filtered]))),
    )


def _counts(fit: MovingFit, equations: Equations) -> Warning | None:
    """That a position counts in coarse steps."""
    step = counting_step(fit.log)
    if not step:
        return None
    acceleration = np.concatenate([each.acceleration for each in equations.filtered])
    share = float(fit.fitting.covariances[0] / max(float(np.mean(acceleration**2)), 1e-300))
    if share < _COARSE:
        return None
    return Warning(
        "position counts coarsely",
        "the position counts in steps of {step:.2g}°, which makes {share:.1g %} of the variance of the "
        "acceleration; J may be off by more than its interval",
        severity="watch",
        remedy="record a larger motion, or give the inertia",
        step=float(np.degrees(step)),
        share=share,
    )


def _far_apart(equations: Equations) -> Warning | None:
    """That the motion is too fast for the rows."""
    interval = equations.filtered[0].low_pass.interval
    turned = interval * float(np.std(equations.acceleration)) / float(np.std(equations.speed))
    lost = turned**4 / 30.0  # of a derivative over five rows
    if lost < _LOST:
        return None
    return Warning(
        "rows too far apart",
        "the speed changes so fast that rows {interval:.2g} s apart lose about {share:.1g %} of its "
        "derivative, and J is wrong by as much",
        severity="watch",
        remedy="record more rows per second",
        interval=interval,
        share=lost,
    )


def _delay(fit: MovingFit) -> Warning | None:
    delay = fit[DELAY]
    if abs(delay.value) < 3.0 * delay.error or abs(delay.value) < 2.0 * fit.fitting.prior:
        return None
    return Warning(
        "channels out of step",
        "torque and speed are out of step by {time:.2g} s; the fit allows for it",
        severity="note",
        time=delay.value,
    )
