"""The friction curve of a moving log: the law fitted to every sample, judged by its windows of speed."""

from __future__ import annotations

from dataclasses import replace

from hersey.arrays import FloatArray
from hersey.damping.friction_curve import law as laws
from hersey.damping.friction_curve.fit import fit_friction
from hersey.damping.friction_curve.fitted import (
    BOTH,
    COULOMB_VISCOUS,
    FORWARD,
    REVERSE,
    STRIBECK,
    FrictionParameter,
    LeastTorque,
)
from hersey.damping.friction_curve.least import Searched, least_torques
from hersey.damping.friction_curve.result import FrictionCurve
from hersey.damping.moving.friction import MovingFriction, MovingPoints


def moving_curve(points: MovingPoints) -> FrictionCurve | None:
    """Return the law that was fitted to every sample as a friction curve; None if no window can judge it.

    Its ``aicc`` and ``scatter`` are those of the same law fitted to the windows, so that it can be compared
    with other laws of the windows.
    """
    of_windows, own = fit_friction(points), points.friction
    law = own.friction_law
    kind = STRIBECK if law.stribeck else COULOMB_VISCOUS
    alike = [each for each in of_windows.tried if (each.kind, each.apart) == (kind, law.apart)]
    if not alike:
        return None
    speed = own.moments.speed
    of_windows = replace(
        of_windows,
        forward_speeds=_ends(speed[speed > 0.0], of_windows.forward_speeds),
        reverse_speeds=_ends(-speed[speed < 0.0], of_windows.reverse_speeds),
    )
    return replace(
        of_windows,
        parameters=_parameters(own, of_windows),
        least=_least(own, of_windows),
        directions=own.directions,
        aicc=alike[0].aicc,
        scatter=alike[0].scatter,
        reference_temperature=law.reference_kelvin,
        law=law,
        values=own.values,
        covariance=own.covariance,
        freedom=own.freedom,
        of_every_sample=True,
    )


def _ends(moments: FloatArray, windows: tuple[float, float] | None) -> tuple[float, float] | None:
    """Slowest and fastest moment of a direction, if it has windows."""
    return None if windows is None else (float(moments.min()), float(moments.max()))


def _ways(curve: FrictionCurve) -> dict[str, tuple[float, float]]:
    """Slowest and fastest speed of each direction."""
    ends = {FORWARD: curve.forward_speeds, REVERSE: curve.reverse_speeds}
    return {name: each for name, each in ends.items() if each is not None}


def _together(curve: FrictionCurve) -> str:
    ways = list(_ways(curve))
    return ways[0] if len(ways) == 1 else BOTH


def _parameters(own: MovingFriction, curve: FrictionCurve) -> tuple[FrictionParameter, ...]:
    named = {each.name: each for each in own.parameters}
    ways = {laws.FORWARD: FORWARD, laws.REVERSE: REVERSE}
    return tuple(
        FrictionParameter(
            number.kind,
            ways.get(number.way, _together(curve)),
            named[number.name].estimate,
            named[number.name].unit,
        )
        for number in own.friction_law.numbers
    )


def _least(own: MovingFriction, curve: FrictionCurve) -> tuple[LeastTorque, ...]:
    searched = Searched(own.values, own.covariance, lambda values: values, lambda _: own.freedom)
    ends = _ways(curve) if own.friction_law.apart else {_together(curve): curve.speed_range}
    return least_torques(own.friction_law, searched, ends)
