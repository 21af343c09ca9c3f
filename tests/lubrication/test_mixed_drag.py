"""Motion with the drag of mixed lubrication, against quadrature, root finding and scipy's integrator."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

import hersey
from tests.lubrication.roll import DRAG, MIXED, OIL
from tests.lubrication.soft_law import solved

_TRAIN = hersey.Drivetrain(11e3, 11.0)


def _force(x: float) -> float:
    """Force at a product of viscosity and speed, from the equations of the law one by one."""
    law, free = MIXED, (x / MIXED.reference) ** MIXED.film_exponent
    lam, share = solved(free, law.edge * free ** (-1 / 3), law.stiffness, law.roundness)
    ratio = x / law.reference
    return float(
        0.1 * 300 * share + law.shear * ratio / lam + law.rolling * ratio**law.rolling_exponent * (1 - share)
    )


@pytest.fixture(scope="module")
def force() -> CubicSpline:
    """Drag against the logarithm of belt speed at 100 degC, through the equations of the law."""
    eta = float(OIL.viscosity(373.15))
    speeds = np.geomspace(2e-4, 0.6, 400)
    return CubicSpline(np.log(speeds), [_force(eta * v) for v in speeds])


def test_the_force_is_that_of_the_equations(force: CubicSpline) -> None:
    speeds = np.geomspace(4e-4, 0.5, 23)
    assert DRAG.force(speeds, temperature=373.15) == pytest.approx(force(np.log(speeds)), rel=1e-6)


def test_the_transition_is_the_least_force(force: CubicSpline) -> None:
    transition = DRAG.transition_speed(373.15)
    assert float(force(np.log(transition), 1)) == pytest.approx(
        0.0, abs=1e-4 * float(force(np.log(transition)))
    )
    assert transition == pytest.approx(float(MIXED.transition(373.15).belt_speed), rel=1e-9)


@pytest.mark.parametrize(
    ("drive", "static", "rest"), [(0.01, None, 0.0), (0.02, 60.0, 0.0), (0.015, 45.0, 3.0)]
)
def test_motion(force: CubicSpline, drive: float, static: float | None, rest: float) -> None:
    """Stiction by hand: held up to A, slipping on A exp(-k u/v_s) and the law, dead at the stick speed."""
    drag = replace(DRAG, static_force=static, rest_force=rest)
    sliding = float(force(np.log(3e-4)))
    most = np.e * sliding if static is None else static
    decay = 3e-4 / np.log(most / sliding)

    def rates(_: float, y: np.ndarray) -> list[float]:
        below = y[0] < 3e-4
        f = most * np.exp(-max(y[0], 0.0) / decay) if below else float(force(np.log(y[0])))
        return [(y[1] - f - rest) / 11.0, 11e3 * (drive - y[0])]

    begin = (most + rest) / (11e3 * drive)

    def up(_: float, y: np.ndarray) -> float:
        return float(y[0] - 3e-4)

    up.terminal, up.direction = True, 1  # type: ignore[attr-defined]
    out = solve_ivp(
        rates, (0, 1), [0.0, most + rest], "DOP853", events=up, rtol=1e-11, atol=1e-13, first_step=1e-7
    )
    first = out.t[-1]

    def down(_: float, y: np.ndarray) -> float:
        return float(y[0] - 3e-4)

    down.terminal, down.direction = True, -1  # type: ignore[attr-defined]
    at_knot = [3e-4 * (1 + 1e-12), out.y[1, -1]]
    slip = solve_ivp(rates, (0, 2), at_knot, "DOP853", events=down, rtol=1e-11, atol=1e-13, dense_output=True)
    period = first + slip.t[-1] + (most + rest - slip.y[1, -1]) / (11e3 * drive)
    cycle = hersey.stick_slip(_TRAIN, drag, drive_speed=drive, temperature=373.15)
    assert cycle.frequency == pytest.approx(1 / period, rel=1e-6)
    assert cycle.speed_max == pytest.approx(slip.sol(np.linspace(0, slip.t[-1], 20001))[0].max(), rel=1e-6)
    run = hersey.simulate(
        _TRAIN, drag, drive_speed=drive, temperature=373.15, duration=begin + 2 * period, samples=3
    )
    assert abs(run.energy.residual) < 1e-8


@pytest.mark.parametrize("closure", ["retained", "stiction"])
def test_a_course_of_temperature_keeps_the_energy_and_agrees_with_another_integrator(closure: str) -> None:
    friction = hersey.BoundaryFriction(0.1, slope=-2e-4, temperature=373.15)
    drag = replace(DRAG, contact=replace(MIXED, friction=friction), closure=closure, rest_force=2.0)
    course = hersey.Schedule([0.0, 2.0], [373.15, 393.15])
    run = hersey.simulate(_TRAIN, drag, drive_speed=0.02, temperature=course, duration=2.0, check=True)
    assert abs(run.energy.residual) < 1e-8
    assert run.check is not None
    assert run.check.same_events
    assert run.check.speed_difference is not None
    assert run.check.speed_difference < 1e-6


def test_a_drag_that_never_falls_is_refused() -> None:
    smooth = replace(MIXED, friction=hersey.BoundaryFriction(1e-6))
    with pytest.raises(hersey.HerseyError, match="rises at all speeds"):
        replace(DRAG, contact=smooth)
