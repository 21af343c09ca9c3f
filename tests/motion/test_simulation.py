"""The Python face of the motion core."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hersey
from hersey.errors import ParameterError

TRAIN = hersey.Drivetrain(1000, 1)
DRAG = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)


def test_trajectory_names_modes_and_events() -> None:
    run = hersey.simulate(TRAIN, DRAG, drive_speed=1.0, duration=2.0, samples=501)
    assert run.time.shape == run.belt_speed.shape == run.mode.shape == (501,)
    assert {"ehl", "mixed", "stuck"} <= set(run.mode) <= {"ehl", "mixed", "microslip", "stuck"}
    assert (run.spring_force == 1000 * run.stretch).all()
    first = run.events[0]
    assert (first.from_mode, first.guard) == ("stuck", "holding_force")
    assert [e.time for e in run.events] == sorted(e.time for e in run.events)


def test_drag_is_continuous_and_odd() -> None:
    for speed in (0.01, 1.0):
        below, above = DRAG.force([speed * (1 - 1e-12), speed * (1 + 1e-12)])
        assert below == pytest.approx(above, rel=1e-9)
    speeds = np.geomspace(1e-4, 10, 20)
    np.testing.assert_array_equal(DRAG.force(-speeds), -DRAG.force(speeds))
    assert DRAG.force(0.0) == 0.0
    assert DRAG.force([[1.0, 2.0]]).shape == (1, 2)


def test_start_decides_between_transition_and_fold() -> None:
    below = hersey.stick_slip(TRAIN, DRAG, drive_speed=1.9)
    above = hersey.stick_slip(TRAIN, DRAG, drive_speed=1.9, start="steady")
    assert (below.kind, above.kind) == ("stick_slip", "steady_sliding")


def test_a_steady_start_below_the_transition_is_told_apart() -> None:
    kinds = [
        hersey.stick_slip(TRAIN, DRAG, drive_speed=v, start="steady").kind
        for v in (0.3, 0.5, 0.98, 0.99, 1.0)
    ]
    assert kinds == ["stick_slip", "stick_slip", "stick_slip", "oscillation", "steady_sliding"]


@settings(max_examples=30, deadline=None)
@given(
    k=st.floats(200, 5000),
    force=st.floats(10, 200),
    stick=st.floats(0.002, 0.1),
    drive=st.floats(0.3, 3.0),
    factor=st.floats(0.1, 10),
)
def test_similarity(k: float, force: float, stick: float, drive: float, factor: float) -> None:
    """Scaling time by sqrt(m/k) and speed by v_t leaves the cycle (physics.md, section 5)."""
    one = hersey.stick_slip(
        hersey.Drivetrain(k, 1.0),
        hersey.Drag(force, 1.0, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=stick),
        drive_speed=drive,
    )
    # k and m both times `factor`, force likewise: the same motion
    two = hersey.stick_slip(
        hersey.Drivetrain(k * factor, factor),
        hersey.Drag(force * factor, 1.0, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=stick),
        drive_speed=drive,
    )
    assert one.kind == two.kind
    assert one.frequency == pytest.approx(two.frequency, rel=1e-6)
    assert one.speed_max == pytest.approx(two.speed_max, rel=1e-6)


def test_same_input_same_bits() -> None:
    one, two = (hersey.simulate(TRAIN, DRAG, drive_speed=1.0, duration=5.0) for _ in range(2))
    assert one.belt_speed.tobytes() == two.belt_speed.tobytes()


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"transition_force": 0}, "transition_force"),
        ({"stick_speed": 2.0}, "stick_speed is 2: it must be less than 1"),
        ({"ehl_exponent": float("nan")}, "ehl_exponent is NaN"),
        ({"closure": "glue"}, "glue"),
    ],
)
def test_impossible_drag_is_refused(change: dict[str, float], says: str) -> None:
    arguments: dict[str, object] = {
        "transition_force": 50,
        "transition_speed": 1,
        "ehl_exponent": -0.7,
        "mixed_exponent": -1.2,
        "stick_speed": 0.01,
    }
    with pytest.raises(ParameterError, match=says):
        hersey.Drag(**(arguments | change))  # type: ignore[arg-type]


def test_impossible_runs_are_refused() -> None:
    with pytest.raises(ParameterError, match="duration"):
        hersey.simulate(TRAIN, DRAG, drive_speed=1.0, duration=-1.0)
    with pytest.raises(ParameterError, match="stiffness"):
        hersey.stick_slip(hersey.Drivetrain(0, 1), DRAG, drive_speed=1.0)
    with pytest.raises(ParameterError, match="samples"):
        hersey.simulate(TRAIN, DRAG, drive_speed=1.0, duration=1.0, samples=0)
