"""Ensembles: the lanes against the single motion, labels, threads, progress and interruption."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hersey
from hersey.errors import ParameterError

DRAG = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
TRAIN = hersey.Drivetrain(1000, 1)
NUMBERS = ["frequency", "speed_min", "speed_max", "stretch_min", "stretch_max", "drag_work", "stuck_fraction"]


def draws(count: int, seed: int = 2015) -> dict[str, np.ndarray]:
    random = np.random.default_rng(seed)
    ranges = {"stiffness": (500, 2000), "transition_force": (25, 100), "drive_speed": (0.4, 1.6)}
    return {name: random.uniform(*limits, count) for name, limits in ranges.items()}


def test_axes_are_named_by_the_parameters() -> None:
    grid = hersey.sweep(TRAIN, DRAG, stiffness=[500, 1000, 2000], drive_speed=[0.4, 1.0])
    assert dict(grid.sizes) == {"stiffness": 3, "drive_speed": 2}
    assert float(grid.frequency.sel(stiffness=1000, drive_speed=1.0)) == pytest.approx(3.940313951, rel=1e-8)
    assert grid.attrs["failures"] == []
    single = hersey.sweep(TRAIN, DRAG, drive_speed=1.0)
    assert single.frequency.shape == ()


def test_zipped_arrays_broadcast_as_in_numpy() -> None:
    zipped = hersey.sweep(TRAIN, DRAG, **draws(7), zip=True)
    assert dict(zipped.sizes) == {"set": 7}
    assert zipped.stiffness.dims == ("set",)
    outer = hersey.sweep(
        TRAIN, DRAG, stiffness=np.array([[500.0], [2000.0]]), drive_speed=np.array([0.4, 1.0, 1.6]), zip=True
    )
    crossed = hersey.sweep(TRAIN, DRAG, stiffness=[500, 2000], drive_speed=[0.4, 1.0, 1.6])
    assert outer.frequency.shape == (2, 3)
    np.testing.assert_array_equal(outer.frequency, crossed.frequency)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    k=st.floats(50, 20000),
    force=st.floats(0.5, 500),
    ehl=st.floats(-0.9, -0.3),
    mixed=st.floats(-1.6, -1.05),
    stick=st.floats(1e-3, 0.2),
    drive=st.floats(0.3, 3.0),
)
def test_lanes_find_what_the_single_motion_finds(
    k: float, force: float, ehl: float, mixed: float, stick: float, drive: float
) -> None:
    drag = hersey.Drag(force, 1.0, ehl_exponent=ehl, mixed_exponent=mixed, stick_speed=stick)
    train = hersey.Drivetrain(k, 1.0)
    one = hersey.stick_slip(train, drag, drive_speed=drive, tolerance=1e-10)
    many = hersey.sweep(train, drag, drive_speed=drive, work=hersey.Work(tolerance=1e-10))
    assert str(many.kind.values) == one.kind
    for name in NUMBERS:
        scale = {"stretch": abs(one.stretch_max), "speed": stick}.get(name.split("_")[0], 0.0)
        assert float(many[name]) == pytest.approx(getattr(one, name), rel=1e-6, abs=1e-6 * scale), name


def test_every_lap_and_the_closed_orbit_agree() -> None:
    """Lap reuse is an algorithmic gain, not an approximation."""
    sets = draws(200)
    closed = hersey.sweep(TRAIN, DRAG, **sets, zip=True)
    whole = hersey.sweep(TRAIN, DRAG, **sets, zip=True, duration=10.0)
    assert int(whole.laps.sum()) > 10 * int(closed.laps.sum())
    for name in NUMBERS:
        np.testing.assert_allclose(whole[name], closed[name], rtol=1e-9, atol=1e-9)


def test_the_same_bits_for_any_number_of_threads_and_any_company() -> None:
    sets = draws(1500)
    one = hersey.sweep(TRAIN, DRAG, **sets, zip=True, work=hersey.Work(threads=1))
    three = hersey.sweep(TRAIN, DRAG, **sets, zip=True, work=hersey.Work(threads=3))
    alone = hersey.sweep(TRAIN, DRAG, **{n: v[700:701] for n, v in sets.items()}, zip=True)
    for name in NUMBERS:
        assert one[name].values.tobytes() == three[name].values.tobytes()
        assert one[name].values[700] == alone[name].values[0]


@pytest.mark.parametrize("closure", ["stiction", "stribeck"])
def test_other_closures_go_through_the_same_door(closure: str) -> None:
    drag = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01, closure=closure)
    grid = hersey.sweep(TRAIN, drag, drive_speed=[1.0, 1.9])
    for v in (1.0, 1.9):
        one = hersey.stick_slip(TRAIN, drag, drive_speed=v)
        assert float(grid.frequency.sel(drive_speed=v)) == one.frequency


def test_all_outcomes_are_told_apart() -> None:
    grid = hersey.sweep(TRAIN, DRAG, drive_speed=[0.5, 0.98, 0.99, 1.5, 2.5], start="steady")
    expected = ["stick_slip", "stick_slip", "oscillation", "steady_sliding", "steady_sliding"]
    assert grid.kind.values.tolist() == expected
    assert hersey.sweep(TRAIN, DRAG, drive_speed=[1.9, 2.2]).kind.values.tolist() == [
        "stick_slip",
        "steady_sliding",
    ]


def test_progress_is_told_and_can_stop_the_sweep() -> None:
    seen: list[tuple[int, int]] = []
    hersey.sweep(
        TRAIN,
        DRAG,
        **draws(3000),
        zip=True,
        work=hersey.Work(progress=lambda done, of: seen.append((done, of))),
    )
    assert seen[-1] == (3000, 3000)
    assert [done for done, _ in seen] == sorted(done for done, _ in seen)

    def stop(*_: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        hersey.sweep(TRAIN, DRAG, **draws(3000), zip=True, duration=100.0, work=hersey.Work(progress=stop))


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"stiffness": [100, -1]}, "set 1: stiffness is -1"),
        ({"stick_speed": [0.1, 2.0]}, "set 1: stick_speed is 2: it must be less than 1"),
        ({"drive_speed": [1.0, float("nan")]}, "drive_speed is NaN"),
        ({"stiffness": []}, "stiffness is empty"),
        ({"stiffness": {"soft": 1.0}}, "stiffness is a dictionary"),
        ({"stiffness": [[1.0]]}, "zip=True"),
        ({"stiffness": [1, 2], "mass": [1, 2, 3], "zip": True}, "do not match"),
        ({"work": hersey.Work(threads=0)}, "threads"),
        ({"start": "flying"}, "flying"),
        ({"stifness": [1.0]}, r"sweep has no argument 'stifness'. Did you mean stiffness\?"),
        ({"threads": 2}, r"Write work=Work\(threads=\.\.\.\)"),
        ({"overwrite": True}, r"Write out=SweepFolder\(\.\.\., overwrite=\.\.\.\)"),
        ({"zzz": 2}, "Its arguments are stiffness, mass, "),
        ({"duration": -1.0}, "duration is -1"),
    ],
)
def test_what_cannot_be_swept_is_refused_by_name(change: dict[str, object], says: str) -> None:
    arguments: dict[str, object] = {"drive_speed": 1.0}
    with pytest.raises(ParameterError, match=says):
        hersey.sweep(TRAIN, DRAG, **(arguments | change))  # type: ignore[arg-type]


def test_each_parameter_of_a_sweep_is_the_one_it_is_called() -> None:
    train = hersey.Drivetrain(1200, 1.5)
    drag = hersey.Drag(40, 0.8, ehl_exponent=-0.65, mixed_exponent=-1.3, stick_speed=0.02)
    changes = {
        "stiffness": 800.0,
        "mass": 2.5,
        "transition_force": 60.0,
        "transition_speed": 1.2,
        "ehl_exponent": -0.5,
        "mixed_exponent": -1.15,
        "stick_speed": 0.005,
    }
    for name, value in changes.items():
        swept = hersey.sweep(train, drag, drive_speed=0.5, **{name: [value]})
        changed = replace(train if hasattr(train, name) else drag, **{name: value})
        pair = (changed, drag) if hasattr(train, name) else (train, changed)
        one = hersey.stick_slip(*pair, drive_speed=0.5)
        assert str(swept.kind.values[0]) == one.kind == "stick_slip"
        for number in (*NUMBERS, "slip_duration", "stick_duration"):
            assert float(swept[number][0]) == pytest.approx(getattr(one, number), rel=1e-7), (name, number)
        assert swept[name].values.tolist() == [value]
        for other in changes:
            if other != name:
                own = getattr(train, other) if hasattr(train, other) else getattr(drag, other)
                assert float(swept[other]) == own
    assert dict(swept.sizes) == {"stick_speed": 1}


def test_coordinates_of_zipped_sets_are_those_given() -> None:
    sets = draws(5)
    grid = hersey.sweep(TRAIN, DRAG, **sets, zip=True)
    for name, values in sets.items():
        np.testing.assert_array_equal(grid[name], values)
    i = 3
    alone = hersey.stick_slip(
        hersey.Drivetrain(sets["stiffness"][i], 1),
        replace(DRAG, transition_force=sets["transition_force"][i]),
        drive_speed=sets["drive_speed"][i],
    )
    assert str(grid.kind.values[i]) == alone.kind
    assert float(grid.frequency[i]) == pytest.approx(alone.frequency, rel=1e-7)


def test_the_steady_start_is_that_of_the_single_motion() -> None:
    grid = hersey.sweep(TRAIN, DRAG, drive_speed=[0.985, 0.99], start="steady")
    for i, speed in enumerate((0.985, 0.99)):
        one = hersey.stick_slip(TRAIN, DRAG, drive_speed=speed, start="steady")
        assert one.kind == "oscillation"
        assert float(grid.speed_max[i]) == pytest.approx(one.speed_max, rel=1e-6)
    assert grid.attrs["start"] == "steady"


def test_tolerance_and_duration_reach_the_motion() -> None:
    rough, usual = (
        hersey.sweep(TRAIN, DRAG, drive_speed=1.0, work=hersey.Work(tolerance=t)) for t in (1e-3, 1e-9)
    )
    assert float(rough.frequency) != float(usual.frequency)
    assert float(rough.frequency) == pytest.approx(float(usual.frequency), rel=2e-2)
    assert (rough.attrs["tolerance"], usual.attrs["closure"]) == (1e-3, "retained")
    laps = [int(hersey.sweep(TRAIN, DRAG, drive_speed=1.0, duration=t).laps) for t in (5.0, 10.0)]
    assert laps[1] - laps[0] == pytest.approx(5 * 3.94, abs=1)


def test_bristles_reach_the_lanes() -> None:
    soft, stiff = (
        replace(DRAG, closure="lugre", bristle_stiffness=k, bristle_damping=30.0) for k in (1e4, 3e4)
    )
    found = [float(hersey.sweep(TRAIN, d, drive_speed=1.0, duration=1.0).frequency) for d in (soft, stiff)]
    assert found[0] != pytest.approx(found[1], rel=1e-5)
