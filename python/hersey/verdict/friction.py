"""Whether friction as of a joint describes the dwells, so that it comes first: no film may be overridden."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hersey.damping.candidates.likelihood import EVIDENCE
from hersey.damping.friction_curve.fit import fit_friction
from hersey.damping.friction_curve.result import FrictionCurve
from hersey.damping.moving.curve import moving_curve
from hersey.damping.moving.friction import MovingPoints
from hersey.errors import InsufficientDataError
from hersey.verdict.regimes import COULOMB, FALLING

if TYPE_CHECKING:
    from hersey.damping.dwells import SteadyPoints
    from hersey.damping.surface import DampingSurface
    from hersey.verdict.regime import Regime


def leading_friction(points: SteadyPoints, surface: DampingSurface, seen: Regime) -> FrictionCurve | None:
    """Return the friction curve if it describes the dwells at least as well as the power law; else None.

    Of a moving log it is that of every sample, judged by the windows, unless friction departs from it. A
    coast-down, and a friction force or coefficient, have a verdict of their own. It never leads where the
    torque is that of a motor or a brake, or where film theory is at stake: a film is named, no-load torque
    was subtracted, or loads differ. Where temperature varies the power law must be excluded, since a film
    moves with temperature too. Coulomb plus viscous friction cannot lead where the dwells alone show that
    torque falls with speed, where the drive stuck and slipped, or where no viscous part is proven.
    """
    if seen.named not in (None, COULOMB, FALLING) or points.rest is not None or points.varying_load:
        return None
    if seen.driving is not None:
        return None
    loaded = any(each.why.kind == "opposite signs" for each in points.rejected)
    if not points.domain.is_torque or loaded:
        return None
    try:
        curve = _curve(points)
    except InsufficientDataError:
        return None
    if curve is None:
        return None
    sticks = any(each.why.kind == "stick-slip" for each in points.rejected)
    rises = not curve.falls and not sticks and any(each.low > 0.0 for each in curve.slopes)
    if not (curve.law.stribeck or rises):
        return None
    needed = 0.0 if surface.b is None else EVIDENCE
    return curve if curve.aicc + needed <= surface.statistics.aicc else None


def _curve(points: SteadyPoints) -> FrictionCurve | None:
    if isinstance(points, MovingPoints):
        return None if points.friction.misfit is not None else moving_curve(points)
    return None if points.of_every_sample else fit_friction(points)


def excludes_power_law(curve: FrictionCurve, surface: DampingSurface) -> bool:
    """Return whether the friction curve is so much likelier that the power law need not be spoken of."""
    return curve.aicc + EVIDENCE <= surface.statistics.aicc
