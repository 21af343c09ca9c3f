"""Moving logs that cannot be fitted, and what to do about each."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hersey.damping.driving_torque import driving_torque
from hersey.damping.dwells.reasons import opposite_signs
from hersey.damping.friction_curve.law import COULOMB
from hersey.damping.moving.gravity import arc_of
from hersey.damping.moving.model import INERTIA, Equations
from hersey.damping.moving.result import MovingFit
from hersey.damping.moving.speed_noise import SpeedNoise
from hersey.damping.moving.stretches import Stretch
from hersey.errors import MOVING, InsufficientDataError, Setting
from hersey.log.channels import is_dead
from hersey.schema.domain import TORQUE
from hersey.units import rpm

#: Least equations, and least share of the speed (standard deviation over the greatest) that is a motion.
LEAST_EQUATIONS, _MOVES = 30, 0.05
#: Least share of the mean square of the torque, without inertia, that friction and offset must explain.
LEAST_EXPLAINED = 0.8
#: Share of the typical speed below which enough counts must pass within a window, and of the variance of the
#: acceleration that counts may make.
_COUNTED, _COUNTS = 0.3, 0.04


def refuse_constant(name: str, stretches: Sequence[Stretch]) -> None:
    """Refuse a log whose speed hardly changes, or whose torque is the same in every row."""
    speed = np.concatenate([each.speed for each in stretches]) if stretches else np.zeros(1)
    if np.std(speed) <= _MOVES * np.max(np.abs(speed)):
        raise InsufficientDataError(
            f"{name}: the speed hardly changes, so inertia and friction cannot be separated",
            remedy=f"omit {MOVING.to()}",
            setting=MOVING,
        )
    torque = np.abs(np.concatenate([each.torque for each in stretches]))
    if is_dead(torque):
        raise InsufficientDataError(
            f"{name}: torque reads {TORQUE.small(float(torque[0]), '.4g')} in every row, so it does not "
            "measure friction",
            remedy=f"check the sensor, or name another column with {Setting('torque', 'channel').to()}",
        )


def coarse_counts(noise: SpeedNoise, equations: Equations) -> tuple[float, float]:
    """Return the speed at which enough counts pass over the typical one, and the share of acceleration.

    The share is what counts make of its variance.
    """
    low_pass = equations.filtered[0].low_pass
    speed = np.concatenate([each.speed for each in equations.filtered])
    power = float(np.mean(np.concatenate([each.acceleration for each in equations.filtered]) ** 2))
    slow = noise.least_counted(low_pass) / max(float(np.std(speed)), 1e-300)
    return slow, float(noise.covariances(low_pass)[0]) / max(power, 1e-300)


def refuse_coarse(name: str, noise: SpeedNoise, equations: Equations) -> None:
    """Refuse a position that counts too coarsely for its motion."""
    if not noise.step:
        return
    slow, share = coarse_counts(noise, equations)
    if slow > _COUNTED or share > _COUNTS:
        raise InsufficientDataError(
            f"{name}: the position counts in steps of {np.degrees(noise.step):.2g}°, too coarse for the "
            "speed and acceleration of so small or slow a motion",
            remedy="record a larger or faster motion, or a finer encoder",
        )


def too_few(name: str, equations: Equations, least: float) -> InsufficientDataError:
    """Return the error of a log that hardly moves clear of standstill."""
    return InsufficientDataError(
        f"{name}: only {len(equations)} moments lie clear of standstill (faster than {rpm(least):.3g} rpm), "
        f"but a moving log needs {LEAST_EQUATIONS}",
        remedy="record a longer motion, or one that reverses less often",
    )


def _refuse_driving(name: str, result: MovingFit) -> None:
    """Refuse the torque of a motor or a brake."""
    try:
        points = result.points()
    except InsufficientDataError:
        return
    speed, torque = (np.abs(points.column(each)) for each in ("speed", "torque"))
    if found := driving_torque(speed, torque, points.column("torque_error")):
        said = str(found)[:1].lower() + str(found)[1:]
        raise InsufficientDataError(f"{name}: {said}", remedy="record the drive without it")


def refuse_no_friction(name: str, result: MovingFit, equations: Equations) -> None:
    """Refuse what is not friction: torque that drives, or a load that the log does not hold."""
    if INERTIA in result and result[INERTIA].high < 0.0:
        raise InsufficientDataError(
            f"{name}: the moment of inertia would be negative, {result[INERTIA]} kg m^2. Something other "
            "than friction and inertia loads the drive, such as gravity or a spring",
            remedy=_without_load(equations),
        )
    ways = [each.name for each in result.friction_law.numbers if each.kind == COULOMB and each.way]
    apart = [name for name in ways if result[name].low <= 0.0]
    if apart:
        raise InsufficientDataError(
            f"{name}: Coulomb friction would vanish in one direction alone, {apart[0]} = "
            f"{result[apart[0]]} N m. Something other than friction loads the drive, such as gravity",
            remedy=_without_load(equations),
        )
    _refuse_driving(name, result)
    fast = np.array([result.speed_range[1], -result.speed_range[1]])
    fast = fast[[np.any(equations.speed > 0), np.any(equations.speed < 0)]]
    friction = np.sign(fast) * result.friction(fast)
    if np.all(friction < 0.0) and result.explained >= LEAST_EXPLAINED:
        raise opposite_signs(name)
    if np.any(friction <= 0.0) or result.explained < LEAST_EXPLAINED:
        raise InsufficientDataError(
            f"{name}: torque does not follow speed: friction and a constant explain "
            f"{max(100 * result.explained, 0.0):.0f} % of its square. Something other than friction "
            "loads the drive, such as a brake, gravity or the torque of a motor under test",
            remedy=_without_load(equations),
        )


def _without_load(equations: Equations) -> str:
    """What to do: gravity is fitted where the angle is known."""
    if arc_of([each.stretch for each in equations.filtered]) > 0.0:
        return "record the drive without that load"
    angle = Setting("position", "channel").to("Angle")
    return f"record the drive without that load. Gravity is fitted if the angle is known: add {angle}"
