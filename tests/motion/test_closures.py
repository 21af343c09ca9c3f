"""What the belt does near zero speed: published numbers, and a second integrator."""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import hersey
from hersey.errors import ParameterError
from tests.conftest import shared

TRAIN = hersey.Drivetrain(1000, 1)


def drag(closure: str, **changes: float) -> hersey.Drag:
    values = {"transition_force": 50.0, "transition_speed": 1.0, "stick_speed": 0.01} | changes
    return hersey.Drag(ehl_exponent=-0.7, mixed_exponent=-1.2, closure=closure, **values)  # type: ignore[arg-type]


def test_every_published_cycle_of_both_closures() -> None:
    """Exact solutions at 1e-12 (reference/stick-slip.json), at the default tolerance."""
    path: Path = shared("reference/stick-slip.json")
    rows = json.loads(path.read_text())
    assert {row["law"] for row in rows} == {"retained", "stiction"}
    for row in rows:
        law = drag(row["law"], transition_force=row["B0"], stick_speed=row["vs"])
        cycle = hersey.stick_slip(hersey.Drivetrain(row["k"], row["m"]), law, drive_speed=row["v2"])
        assert cycle.kind == "stick_slip"
        assert cycle.frequency == pytest.approx(row["frequency"], rel=1e-7)
        assert cycle.speed_max == pytest.approx(row["v_max"], rel=1e-7)
        assert cycle.stuck_fraction == pytest.approx(row["stuck_fraction"], rel=1e-7)


def test_stiction_stops_dead_and_is_released_at_the_breakaway_force() -> None:
    law = drag("stiction")
    run = hersey.simulate(TRAIN, law, drive_speed=1.0, duration=5.0, samples=5001)
    assert (run.belt_speed[run.mode == "stuck"] == 0.0).all()
    releases = [e for e in run.events if e.from_mode == "stuck"]
    assert len(releases) > 5
    for event in releases:
        assert 1000 * event.stretch == pytest.approx(law.breakaway_force, rel=1e-12)
    assert abs(run.energy.residual) < 1e-8


def test_smooth_closures_tend_to_stiction() -> None:
    """Stiff bristles stop a belt as stiction does; the smooth curve peaks below A and so slips sooner."""
    dead = hersey.stick_slip(TRAIN, drag("stiction"), drive_speed=1.0)
    smooth = hersey.stick_slip(TRAIN, drag("stribeck"), drive_speed=1.0)
    assert smooth.kind == "stick_slip"
    assert dead.frequency < smooth.frequency < 1.2 * dead.frequency
    assert smooth.stretch_max < dead.stretch_max
    # bristles give way sooner the faster they are loaded (Canudas de Wit et al. 1995, Fig. 4)
    stiff = drag("lugre", bristle_stiffness=1e7, bristle_damping=6e3)
    peaks = []
    for speed in (2.0, 0.5, 0.1):
        run = hersey.simulate(TRAIN, stiff, drive_speed=speed, duration=0.36 / speed, samples=2001)
        peaks.append(1000 * run.stretch.max() / stiff.breakaway_force)
    assert peaks == sorted(peaks)
    assert 0.5 < peaks[0] < peaks[-1] < 1.0


@pytest.mark.parametrize(
    ("closure", "extra"),
    [
        ("retained", {}),
        ("stiction", {}),
        ("stribeck", {}),
        ("lugre", {"bristle_stiffness": 1e5, "bristle_damping": 300.0}),
    ],
)
def test_two_integrators_agree(closure: str, extra: dict[str, float]) -> None:
    run = hersey.simulate(
        TRAIN, drag(closure, **extra), drive_speed=1.0, duration=0.8, samples=201, check=True
    )
    assert run.check is not None
    assert run.check.same_events
    assert run.check.speed_difference < 1e-6
    assert run.check.stretch_difference < 1e-6
    assert abs(run.energy.residual) < 1e-8


@pytest.mark.parametrize("drive_speed", [0.033, 0.045, 0.1])
def test_bristles_slide_steadily_where_torque_rises(drive_speed: float) -> None:
    """A nudge dies out slowly, lap by lap less: a swing of 1e-6 that hardly shrinks is none that stays."""
    law = hersey.Drag(
        0.77,
        0.029,
        ehl_exponent=-0.6,
        mixed_exponent=-1.98,
        stick_speed=0.003,
        closure="lugre",
        bristle_stiffness=1.1e6,
        bristle_damping=6957.0,
    )
    slides = hersey.stick_slip(hersey.Drivetrain(11e3, 11.0), law, drive_speed=drive_speed, start="steady")
    assert slides.kind == "steady_sliding"


@pytest.mark.parametrize("closure", ["stiction", "stribeck"])
def test_reversal_mirrors_every_closure(closure: str) -> None:
    runs = [
        hersey.simulate(TRAIN, drag(closure), drive_speed=v, duration=1.0, samples=101) for v in (0.7, -0.7)
    ]
    np.testing.assert_allclose(runs[0].belt_speed, -runs[1].belt_speed, atol=1e-9)


def test_drag_is_odd_for_every_closure() -> None:
    speeds = np.geomspace(1e-5, 10, 30)
    for law in (
        drag("stribeck"),
        drag("stiction"),
        drag("lugre", bristle_stiffness=1e5, bristle_damping=1.0),
    ):
        np.testing.assert_array_equal(law.force(-speeds), -law.force(speeds))


def test_bristles_must_be_given() -> None:
    with pytest.raises(ParameterError, match="bristle_stiffness"):
        drag("lugre")
    with pytest.raises(ParameterError, match="bristle_damping is -1"):
        drag("lugre", bristle_stiffness=1e5, bristle_damping=-1.0)
    with pytest.raises(ParameterError, match="retained, stiction, stribeck or lugre"):
        drag("glue")


def test_an_integrator_that_cannot_finish_says_so() -> None:
    """A stiff drive costs an explicit method more steps than anybody would wait for."""
    stiff = hersey.Drag(1e5, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    ramp = hersey.Schedule([0, 1e4], [3.0, 6.0])
    run = hersey.simulate(
        hersey.Drivetrain(10.0, 1e-5), stiff, drive_speed=ramp, start="steady", duration=1e4, check=True
    )
    assert run.check is not None
    assert run.check.speed_difference is None
    (unfinished,) = run.check.warnings
    assert unfinished.kind == "check not finished"
    assert str(run.check) == f"Dormand-Prince 5(4): {unfinished.values['error']}"
    assert "steps" in str(run.check)


@pytest.mark.parametrize(("growth", "time", "drive_speed"), [(0.05, 1e-3, 0.5), (0.2, 0.1, 1.0)])
def test_a_belt_that_stood_longer_is_harder_to_start(growth: float, time: float, drive_speed: float) -> None:
    """Released when k w t = A (1 + g ln(1 + t/t_0)) - p_0, found here by a root of its own."""
    plain = drag("stiction")
    grown = replace(plain, static_growth=growth, static_growth_time=time)
    run = hersey.simulate(TRAIN, grown, drive_speed=drive_speed, duration=6.0, check=True)
    pairs = list(pairwise(run.events))
    stops = [(a, b) for a, b in pairs if a.to_mode == "stuck" and b.guard == "holding_force"]
    assert stops
    for stop, release in stops:
        held, pull = release.time - stop.time, 1000 * stop.stretch

        def missing(t: float, pull: float = pull) -> float:
            return pull + 1000 * drive_speed * t - grown.breakaway_force * (1 + growth * np.log1p(t / time))

        assert held == pytest.approx(brentq(missing, 1e-9, 10.0, xtol=1e-14), rel=1e-9)
        assert 1000 * release.stretch > grown.breakaway_force
    assert abs(run.energy.residual) < 1e-8
    assert run.check is not None
    assert run.check.same_events
    cycle = hersey.stick_slip(TRAIN, grown, drive_speed=drive_speed)
    assert cycle.frequency < hersey.stick_slip(TRAIN, plain, drive_speed=drive_speed).frequency


def test_a_static_force_must_exceed_the_drag_at_the_stick_speed() -> None:
    plain = drag("retained")
    sliding = float(plain.force(0.01))
    with pytest.raises(ParameterError, match="breakaway_force is 125"):
        replace(plain, static_force=sliding)
    # as little as it may be above it, the belt is released where it was caught
    for closure in ("retained", "stiction"):
        near = replace(plain, static_force=1.0001 * sliding, closure=closure)
        cycle = hersey.stick_slip(TRAIN, near, drive_speed=1.0)
        assert cycle.stretch_max * 1000 < 1.2 * sliding
    with pytest.raises(ParameterError, match="static_growth"):
        replace(plain, static_growth=0.1)


@pytest.mark.parametrize("closure", ["retained", "stiction", "stribeck"])
def test_every_speed_of_a_closure_moves_with_temperature(closure: str) -> None:
    """At 440 K, 1.1 times the reference: forces by 1/1.1, speeds by 1.1^2, by hand."""
    warm = drag(
        closure, reference_temperature=400.0, force_temperature_exponent=-1.0, speed_temperature_exponent=2.0
    )
    hand = replace(
        drag(closure),
        transition_force=warm.transition_force / 1.1,
        transition_speed=warm.transition_speed * 1.21,
        stick_speed=warm.stick_speed * 1.21,
    )
    at = hersey.simulate(TRAIN, warm, drive_speed=1.0, duration=1.0, samples=101, temperature=440.0)
    run = hersey.simulate(TRAIN, hand, drive_speed=1.0, duration=1.0, samples=101)
    assert at.belt_speed == pytest.approx(run.belt_speed, rel=1e-6, abs=1e-9)
    assert at.spring_force == pytest.approx(run.spring_force, rel=1e-6)
