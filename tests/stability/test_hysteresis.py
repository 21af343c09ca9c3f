"""The band where the past decides: reference folds, every closure, and agreement with the motion itself."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hersey
from hersey.charts.hysteresis import band_chart
from hersey.errors import ParameterError
from hersey.machine.uncertainty import Uncertainty
from hersey.stability.hysteresis import fold

TRAIN = hersey.Drivetrain(1000, 1)
DRAG = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)


@pytest.mark.parametrize(
    ("change", "known"),
    [
        ({}, 2.173493478),
        ({"stiffness": 500}, 2.228999261),
        ({"stiffness": 2000}, 2.109731216),
        ({"transition_force": 25}, 2.056026103),
        ({"transition_force": 100}, 2.241446601),
        ({"stick_speed": 0.001}, 4.096830996),
        ({"stick_speed": 0.05}, 1.558597692),
        ({"closure": "stiction"}, 9.958031686),
    ],
)
def test_folds_of_reference(change: dict[str, float], known: float) -> None:
    """The folds of physics.md, section 5."""
    train = replace(TRAIN, **{k: v for k, v in change.items() if hasattr(TRAIN, k)})
    drag = replace(DRAG, **{k: v for k, v in change.items() if hasattr(DRAG, k)})
    band = hersey.hysteresis(train, drag)
    assert band.upper == pytest.approx(known, rel=1e-8 if change.get("closure") else 1e-9)
    assert band.method == "half laps"
    assert not band.deeper
    assert band.bistable


def test_lower_edge_of_the_paper() -> None:
    """A swing without sticking survives at 0.99 v_t and not at 0.98 (physics.md, section 5)."""
    band = hersey.hysteresis(TRAIN, DRAG)
    assert 0.98 < band.lower < 0.99
    for factor, kind in ((0.9999, "stick_slip"), (1.0001, "oscillation")):
        cycle = hersey.stick_slip(TRAIN, DRAG, drive_speed=factor * band.lower, start="steady")
        assert cycle.kind == kind


parameters = st.fixed_dictionaries(
    {
        "damping": st.floats(-1.0, 0.6).map(lambda x: 10.0**x),
        "slowest": st.floats(-3.3, -0.8).map(lambda x: 10.0**x),
        "ehl": st.floats(-0.85, -0.5),
        "mixed": st.floats(-1.35, -1.1),
        "stiffness": st.floats(0.0, 5.0).map(lambda x: 10.0**x),
        "mass": st.floats(-2.0, 2.0).map(lambda x: 10.0**x),
        "speed": st.floats(-1.0, 1.0).map(lambda x: 10.0**x),
    }
)


def belt(p: dict[str, float], closure: str = "retained") -> tuple[hersey.Drivetrain, hersey.Drag]:
    impedance = np.sqrt(p["stiffness"] * p["mass"])
    drag = hersey.Drag(
        p["damping"] * p["speed"] * impedance,
        p["speed"],
        ehl_exponent=p["ehl"],
        mixed_exponent=p["mixed"],
        stick_speed=p["slowest"] * p["speed"],
        closure=closure,
    )
    return hersey.Drivetrain(p["stiffness"], p["mass"]), drag


@settings(max_examples=150, deadline=None)
@given(parameters, st.sampled_from(["retained", "stiction"]))
def test_just_below_the_fold_it_sticks_again_and_just_above_it_does_not(
    p: dict[str, float], closure: str
) -> None:
    train, drag = belt(p, closure)
    band = hersey.hysteresis(train, drag, sensitivity=False)
    if band.upper == np.inf or not band.bistable:
        return
    if band.deeper:
        start: str | tuple[float, float] = "rest"
    elif closure == "stiction":
        start = (0.0, drag.breakaway_force / train.stiffness)
    else:
        released = float(drag.force(drag.stick_speed)) / train.stiffness
        start = (drag.stick_speed, released)
    for factor, sticks in ((1 - 1e-4, True), (1 + 1e-4, False)):
        cycle = hersey.stick_slip(train, drag, drive_speed=factor * band.upper, start=start)
        assert (cycle.kind == "stick_slip") == sticks, (factor, cycle)


@settings(max_examples=60, deadline=None)
@given(parameters)
def test_only_the_numbers_of_similarity_count(p: dict[str, float]) -> None:
    """Time by sqrt(m/k), speed by v_t: the same damping number gives the same band."""
    train, drag = belt(p)
    plain_train, plain_drag = belt({**p, "stiffness": 1.0, "mass": 1.0, "speed": 1.0})
    band = hersey.hysteresis(train, drag, sensitivity=False)
    plain = hersey.hysteresis(plain_train, plain_drag, sensitivity=False)
    assert band.upper / p["speed"] == pytest.approx(plain.upper, rel=1e-8)
    assert band.lower / p["speed"] == pytest.approx(plain.lower, rel=1e-8)


def test_bands_agree_with_brute_force() -> None:
    """From below and from above, at drive speeds on either side of each edge."""
    rng = np.random.default_rng(5)
    for _ in range(40):
        p = {
            "damping": 10 ** rng.uniform(-2.5, 1.2),
            "slowest": 10 ** rng.uniform(-3.5, -0.5),
            "ehl": rng.uniform(-0.9, -0.4),
            "mixed": rng.uniform(-1.4, -1.05),
            "stiffness": 1.0,
            "mass": 1.0,
            "speed": 1.0,
        }
        train, drag = belt(p)
        band = hersey.hysteresis(train, drag, sensitivity=False)
        speeds = np.array([0.9 * band.lower, 1.002, 0.999 * band.upper, 1.001 * band.upper, 1.5 * band.upper])
        from_rest = hersey.sweep(train, drag, drive_speed=speeds[speeds < 500])
        # with weak damping the belt may swing back through zero without being held
        lasts = (from_rest.kind != "steady_sliding") & (from_rest.speed_min <= drag.stick_speed * (1 + 1e-9))
        for speed, rough in zip(speeds, lasts.values, strict=False):
            if speed > 1.001 * band.lower:
                assert rough == (speed < band.upper), (p, band, speed)
        nudged = hersey.sweep(train, drag, drive_speed=speeds[:2], start="steady")
        assert nudged.speed_min[0] <= drag.stick_speed * (1 + 1e-9), (p, band)
        assert nudged.kind[1] == "steady_sliding", (p, band)


@pytest.mark.parametrize("closure", ["stribeck", "lugre"])
def test_smooth_closures(closure: str) -> None:
    extra = {"bristle_stiffness": 5e3, "bristle_damping": 30.0} if closure == "lugre" else {}
    drag = replace(DRAG, closure=closure, **extra)
    band = hersey.hysteresis(TRAIN, drag)
    assert band.method == "simulation"
    assert band.sensitivity == {}
    for factor, sticks in ((0.999, True), (1.001, False)):
        cycle = hersey.stick_slip(TRAIN, drag, drive_speed=factor * band.upper)
        assert (cycle.kind == "stick_slip") == sticks
    if closure == "stribeck":  # above the stick speed its drag is that of the others
        sharp = hersey.hysteresis(TRAIN, DRAG).lower
        assert band.lower == pytest.approx(sharp, rel=1e-6)


LIGHT = hersey.Drag(
    30,
    0.4,
    ehl_exponent=-0.7,
    mixed_exponent=-1.2,
    stick_speed=0.008,
    closure="lugre",
    bristle_stiffness=8e4,
    bristle_damping=839,
)


def test_bristles_on_an_ordinary_belt() -> None:
    """Its stick-slip is chaotic and never repeats itself. Motions followed to their end took minutes."""
    train = hersey.Drivetrain(4000, 2.2)
    band = hersey.hysteresis(train, LIGHT)
    # LSODA (SciPy, rtol 1e-10) of the same equations, halved by whether the first laps grow or fall:
    # between 0.46484609 and 0.46484688
    assert band.upper == pytest.approx(0.4648465, rel=2e-6)
    assert band == hersey.hysteresis(train, LIGHT)
    kinds = [hersey.stick_slip(train, LIGHT, drive_speed=band.upper * f).kind for f in (0.9999, 1.0001)]
    assert kinds[0] in ("stick_slip", "unsettled")
    assert kinds[1] == "steady_sliding"
    above = hersey.stick_slip(train, LIGHT, drive_speed=band.lower * 1.0001, start="steady")
    speed = 0.9997 * band.lower  # just below, a swing takes 300 laps to pass by the one that has vanished
    nudged = (1.001 * speed, LIGHT.force(speed) / 4000)
    below = hersey.simulate(train, LIGHT, drive_speed=speed, start=nudged, duration=60, samples=60_001)
    assert above.kind == "oscillation"
    assert above.speed_min > 0.3
    assert float(below.belt_speed.min()) < LIGHT.stick_speed


@pytest.mark.parametrize(
    ("stiffness", "mass", "law", "bristles"),
    [
        (1500, 1.0, (20, 0.3, -0.6, -1.3, 0.006), None),
        (8000, 3.0, (60, 0.5, -0.75, -1.15, 0.01), None),
        pytest.param(6000, 2.0, (50, 0.3, -0.6, -1.3, 0.006), (1e5, 900), marks=pytest.mark.nightly),
        (3000, 1.0, (40, 0.6, -0.7, -1.2, 0.012), (2e5, 700)),
    ],
)
def test_smooth_edges_are_where_single_motions_part(
    stiffness: float, mass: float, law: tuple[float, ...], bristles: tuple[float, float] | None
) -> None:
    force, speed, ehl, mixed, stick = law
    extra = {"bristle_stiffness": bristles[0], "bristle_damping": bristles[1]} if bristles else {}
    drag = hersey.Drag(
        force,
        speed,
        ehl_exponent=ehl,
        mixed_exponent=mixed,
        stick_speed=stick,
        closure="lugre" if bristles else "stribeck",
        **extra,
    )
    train = hersey.Drivetrain(stiffness, mass)
    band = hersey.hysteresis(train, drag)
    apart = max(1e-4, band.upper_accuracy)
    for factor, lasts in ((1 - apart, True), (1 + apart, False)):
        cycle = hersey.stick_slip(train, drag, drive_speed=factor * band.upper)
        assert (cycle.kind in ("stick_slip", "unsettled")) == lasts, (factor, band, cycle)


def test_a_table_of_the_same_drag_has_the_same_band() -> None:
    speeds = (0.01, 0.1, 1.0, 10.0)
    table = hersey.DragTable(speeds, tuple(DRAG.force(speeds).tolist()), stick_speed=0.01)
    band, reference = hersey.hysteresis(TRAIN, table), hersey.hysteresis(TRAIN, DRAG)
    assert band.upper == pytest.approx(reference.upper, rel=1e-7)
    assert band.lower == pytest.approx(reference.lower, rel=2e-4)


def test_the_band_moves_with_temperature() -> None:
    drag = replace(
        DRAG, reference_temperature=400.0, force_temperature_exponent=-1.0, speed_temperature_exponent=2.0
    )
    hot = hersey.hysteresis(TRAIN, drag, temperature=440.0)
    ratio = 440.0 / 400.0
    same = replace(
        DRAG, transition_force=50 / ratio, transition_speed=ratio**2, stick_speed=DRAG.stick_speed * ratio**2
    )
    assert hot.upper == pytest.approx(hersey.hysteresis(TRAIN, same).upper, rel=1e-9)
    grid = hersey.hysteresis_sweep(TRAIN, drag, temperature=[400.0, 440.0], stiffness=[1000.0, 2000.0])
    assert grid.upper.dims == ("stiffness", "temperature")
    assert float(grid.upper.sel(stiffness=1000, temperature=440)) == pytest.approx(hot.upper, rel=1e-9)
    with pytest.raises(ParameterError, match="Give temperature"):
        hersey.hysteresis(TRAIN, drag)
    with pytest.raises(ParameterError, match="Give temperature"):
        hersey.hysteresis_sweep(TRAIN, drag)
    with pytest.raises(ParameterError, match="stick_speed follows from the temperature"):
        hersey.hysteresis_sweep(TRAIN, drag, temperature=400.0, stick_speed=[0.01])


def test_strong_damping_leaves_no_band() -> None:
    """The belt creeps towards the drive and never swings below it."""
    heavy = replace(DRAG, transition_force=5000)
    band = hersey.hysteresis(TRAIN, heavy)
    assert not band.bistable
    assert band.upper == pytest.approx(1.0, abs=1e-9)
    assert "No band" in band.verdict()
    assert hersey.stick_slip(TRAIN, heavy, drive_speed=1.01).kind == "steady_sliding"


def test_weak_damping_keeps_a_deeper_stick_slip_alive() -> None:
    """Released higher than at the stick speed, the belt comes back to be released as high again."""
    weak = replace(DRAG, transition_force=0.3, stick_speed=0.1)
    band = hersey.hysteresis(TRAIN, weak, sensitivity=False)
    assert band.deeper
    assert band.upper > 1.2 * hersey.hysteresis_sweep(TRAIN, weak, transition_force=5.0).upper
    below = hersey.stick_slip(TRAIN, weak, drive_speed=0.999 * band.upper)
    above = hersey.stick_slip(TRAIN, weak, drive_speed=1.001 * band.upper)
    assert (below.kind, above.kind) == ("stick_slip", "steady_sliding")


def test_sensitivities_are_derivatives() -> None:
    band = hersey.hysteresis(TRAIN, DRAG)
    for name in ("stick_speed", "transition_force", "mixed_exponent"):
        value = getattr(DRAG, name)
        more = hersey.hysteresis(TRAIN, replace(DRAG, **{name: 1.002 * value})).upper
        less = hersey.hysteresis(TRAIN, replace(DRAG, **{name: 0.998 * value})).upper
        assert band.derivative(name, value) == pytest.approx((more - less) / (0.004 * value), rel=1e-4)
    # scaling: doubling k and m leaves the stiffness-to-mass ratio, so each counts half as the drag
    assert band.sensitivity["stiffness"] == pytest.approx(
        -0.5 * band.sensitivity["transition_force"], rel=1e-4
    )


def test_intervals_come_from_the_draws() -> None:
    rng = np.random.default_rng(3)
    draws = {"stick_speed": 10 ** rng.uniform(-3, -1, 400)}
    band = hersey.hysteresis(TRAIN, DRAG, samples=draws)
    ends = [hersey.hysteresis(TRAIN, replace(DRAG, stick_speed=v)).upper for v in (10**-1.05, 10**-2.95)]
    assert band.interval is not None
    assert band.interval == pytest.approx(ends, rel=0.02)
    assert band.share_bistable == 1.0
    with pytest.raises(ParameterError, match="unknown parameter hardness"):
        hersey.hysteresis(TRAIN, DRAG, samples={"hardness": [1.0]})
    with pytest.raises(ParameterError, match="set 1: stick_speed"):
        hersey.hysteresis(TRAIN, DRAG, samples={"stick_speed": [0.01, 2.0]})
    with pytest.raises(ParameterError, match="do not match"):
        hersey.hysteresis(TRAIN, DRAG, samples={"stick_speed": [0.01, 0.02], "mass": [1, 2, 3]})


def test_same_bits_whatever_the_threads() -> None:
    axes = {"stiffness": np.linspace(300, 3000, 23), "transition_force": np.linspace(5, 400, 17)}
    one = hersey.hysteresis_sweep(TRAIN, DRAG, **axes)
    two = hersey.hysteresis_sweep(TRAIN, DRAG, **axes, work=hersey.Work(threads=2))
    np.testing.assert_array_equal(one.upper, two.upper)
    np.testing.assert_array_equal(one.lower, two.lower)


def test_a_fold_does_not_depend_on_its_neighbours() -> None:
    forces = np.geomspace(1, 500, 37)
    together = hersey.hysteresis_sweep(TRAIN, DRAG, transition_force=forces).upper.values
    alone = [
        hersey.hysteresis(TRAIN, replace(DRAG, transition_force=f), sensitivity=False).upper for f in forces
    ]
    np.testing.assert_array_equal(together, alone)


def test_what_is_out_of_range_is_refused_by_name() -> None:
    with pytest.raises(ParameterError, match="stiffness"):
        hersey.hysteresis(hersey.Drivetrain(0, 1), DRAG)
    with pytest.raises(ParameterError, match="set 1: stick_speed"):
        hersey.hysteresis_sweep(TRAIN, DRAG, stick_speed=[0.01, 2.0])
    with pytest.raises(ParameterError, match="threads is 0"):
        hersey.hysteresis_sweep(TRAIN, DRAG, work=hersey.Work(threads=0))
    with pytest.raises(ParameterError, match="tolerance"):
        hersey.hysteresis(TRAIN, DRAG, tolerance=0.0)
    with pytest.raises(ParameterError, match="tolerance"):
        hersey.hysteresis_sweep(TRAIN, DRAG, work=hersey.Work(tolerance=float("nan")))


def test_the_interval_of_a_fit_reaches_the_band(points: hersey.SteadyPoints) -> None:
    """Draws of the fit's covariance widen V*; those of the stick speed widen it further."""
    surface = hersey.fit(points)
    drag = surface.drag(roll_radius=0.015, stick_speed=3e-4).at(453.15)
    draws = surface.drag_samples(400, 1, roll_radius=0.015, stick_speed=3e-4, temperature=453.15)
    train = hersey.Drivetrain(11e3, 11.0)
    fitted = hersey.hysteresis(train, drag, samples=draws)
    assert fitted.interval is not None
    low, high = fitted.interval
    assert low < fitted.upper < high
    stick = Uncertainty(share=1.0).draw(np.random.default_rng(2), drag.stick_speed, 400)
    wider = hersey.hysteresis(train, drag, samples=draws | {"stick_speed": stick}).interval
    assert wider is not None
    assert wider[1] - wider[0] > high - low


def test_a_band_counts_only_beyond_its_accuracy() -> None:
    band = hersey.hysteresis(TRAIN, DRAG, sensitivity=False)
    for over, accuracy, bistable in ((1e-9, 1e-8, False), (1e-7, 1e-8, True), (-1e-3, 0.0, False)):
        near = replace(band, transition=2.0, lower=1.9, upper=2.0 * (1 + over), upper_accuracy=accuracy)
        assert near.bistable == bistable
        assert (
            near.verdict().startswith("No band: stick-slip ends at 2" if over > 0 else "No band") != bistable
        )
    none = replace(band, transition=2.0, upper=1.5)
    assert none.verdict() == (
        "No band: stick-slip ends at 1.5, which is not above the transition speed 2, "
        "so the start does not matter."
    )
    assert replace(band, lower=1.9, transition=2.0, upper=2.5).verdict() == (
        "Below 1.9, stick-slip is certain. From 2 to 2.5, it slides if slowed from above and sticks if "
        "started from below. Above, it slides."
    )


def test_intervals_are_draws_of_the_sorted_folds() -> None:
    """Of 80 draws the 2nd and the 78th, of both edges; the share is that of draws with a band."""
    draws = {"transition_force": np.geomspace(1.0, 3e3, 80), "mass": np.full(80, 2.0)}
    band = hersey.hysteresis(TRAIN, DRAG, samples=draws, sensitivity=False)
    each = [
        hersey.hysteresis(replace(TRAIN, mass=2.0), replace(DRAG, transition_force=f), sensitivity=False)
        for f in draws["transition_force"]
    ]
    upper, lower = np.sort([b.upper for b in each]), np.sort([b.lower for b in each])
    assert band.interval == (upper[1], upper[77])
    assert band.lower_interval == (lower[1], lower[77])
    share = np.mean([b.upper > b.transition for b in each])
    assert 0 < share < 1
    assert band.share_bistable == share


def test_sensitivities_of_the_lower_edge_are_derivatives_too() -> None:
    band = hersey.hysteresis(TRAIN, DRAG)
    assert (
        set(band.lower_sensitivity)
        == set(band.sensitivity)
        == {
            "stiffness",
            "mass",
            "transition_force",
            "transition_speed",
            "ehl_exponent",
            "mixed_exponent",
            "stick_speed",
        }
    )
    for name, own in (("mass", TRAIN), ("transition_speed", DRAG), ("ehl_exponent", DRAG)):
        value = getattr(own, name)
        ends = []
        for factor in (1.001, 0.999):
            changed = replace(own, **{name: factor * value})
            pair = (changed, DRAG) if own is TRAIN else (TRAIN, changed)
            ends.append(hersey.hysteresis(*pair, sensitivity=False))
        for edge, found in (("upper", band.sensitivity), ("lower", band.lower_sensitivity)):
            slope = np.log(getattr(ends[0], edge) / getattr(ends[1], edge)) / 0.002
            assert found[name] == pytest.approx(slope, rel=1e-3, abs=1e-6), (name, edge)
    assert hersey.hysteresis(TRAIN, DRAG, sensitivity=False).sensitivity == {}


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
        swept = hersey.hysteresis_sweep(train, drag, **{name: [value]})  # type: ignore[arg-type]
        if hasattr(train, name):
            one = hersey.hysteresis(replace(train, **{name: value}), drag, sensitivity=False)
        else:
            one = hersey.hysteresis(train, replace(drag, **{name: value}), sensitivity=False)
        for edge in ("lower", "transition", "upper", "speed_max", "lower_accuracy", "upper_accuracy"):
            assert swept[edge].values.tolist() == [getattr(one, edge)], (name, edge)
        assert swept[name].values.tolist() == [value]
        assert (bool(swept.half_laps[0]), bool(swept.deeper[0])) == (one.method == "half laps", one.deeper)
        assert int(swept.laps[0]) == one.laps
    assert np.isnan(hersey.hysteresis_sweep(train, drag, lower=False).lower)


def test_a_sweep_over_temperature_takes_force_and_all_speeds() -> None:
    warm = replace(
        DRAG,
        reference_temperature=400.0,
        force_temperature_exponent=-2.0,
        speed_temperature_exponent=0.5,
        temperature_zero=273.15,
    )
    kelvin = [420.0, 380.0]
    swept = hersey.hysteresis_sweep(TRAIN, warm, temperature=kelvin)
    for i, t in enumerate(kelvin):
        one = hersey.hysteresis(TRAIN, warm.at(t), sensitivity=False)
        assert (swept.lower[i], swept.upper[i]) == (one.lower, one.upper)
        assert hersey.hysteresis(TRAIN, warm, temperature=t, sensitivity=False).upper == one.upper
    assert "stick_speed" not in swept.coords
    zipped = hersey.hysteresis_sweep(TRAIN, warm, temperature=kelvin, stiffness=[900.0, 1100.0], zip=True)
    assert zipped.upper.dims == ("set",)
    stiff = hersey.hysteresis(hersey.Drivetrain(1100.0, 1), warm.at(380.0), sensitivity=False)
    assert zipped.upper.values[1] == stiff.upper
    for name in ("transition_force", "transition_speed", "stick_speed"):
        with pytest.raises(
            ParameterError, match=rf"^{name} follows from the temperature. Give only one of them$"
        ):
            hersey.hysteresis_sweep(TRAIN, warm, temperature=kelvin, **{name: [1.0]})  # type: ignore[arg-type]
    for law, asked in ((warm, None), (DRAG, kelvin)):
        with pytest.raises(ParameterError, match="temperature"):
            hersey.hysteresis_sweep(TRAIN, law, temperature=asked)


def test_the_tolerance_of_a_band_is_that_asked_for() -> None:
    rough, usual = (
        hersey.hysteresis(TRAIN, DRAG, tolerance=tolerance, sensitivity=False) for tolerance in (1e-5, 1e-11)
    )
    assert rough.upper != usual.upper
    assert rough.upper == pytest.approx(usual.upper, rel=1e-3)
    swept = hersey.hysteresis_sweep(TRAIN, DRAG, work=hersey.Work(tolerance=1e-5))
    assert float(swept.upper) == rough.upper
    assert swept.attrs["tolerance"] == 1e-5


def test_cycles_without_sticking_come_back_to_themselves() -> None:
    """One lap of the motion from the slowest point ends there, and its greatest speed is the fastest."""
    train = hersey.Drivetrain(1300.0, 1.4)
    drag = hersey.Drag(55, 0.9, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    found = hersey.cycles_without_sticking(train, drag, slowest=[0.02, 0.3, 0.7])
    for slow, fast, drive in zip(found.slowest, found.fastest, found.drive_speed, strict=True):
        pull = float(drag.force(slow)) / train.stiffness
        run = hersey.simulate(
            train, drag, drive_speed=float(drive), duration=0.5, samples=50_001, start=(float(slow), pull)
        )
        assert run.belt_speed.max() == pytest.approx(fast, rel=1e-5)
        again = int(np.argmax(run.belt_speed))
        assert run.belt_speed[again:].min() == pytest.approx(slow, abs=1e-4)
    edge = hersey.cycles_without_sticking(train, drag, slowest=[drag.stick_speed])
    band = hersey.hysteresis(train, drag, sensitivity=False)
    assert edge.drive_speed[0] == pytest.approx(band.upper, rel=1e-7)
    default = hersey.cycles_without_sticking(train, drag)
    np.testing.assert_allclose(default.slowest, np.geomspace(0.01, 0.999 * 0.9, 201), rtol=1e-12)
    assert default.drive_speed.min() == pytest.approx(band.lower, rel=1e-4)
    lowest = int(np.argmin(default.drive_speed))
    assert not default.stable[: lowest - 1].any()
    assert default.stable[lowest + 1 :].all()
    for wrong in (0.009, 0.9):
        with pytest.raises(ParameterError, match=r"slowest must be from the stick speed 0\.01 to below 0\.9"):
            hersey.cycles_without_sticking(train, drag, slowest=[wrong])


def test_a_roll_that_does_not_start_the_belt_stalls_and_is_told_from_stick_slip() -> None:
    """The paper's rule holds a moving belt with less than one at rest: stick-slip may go on all the same."""
    weak, weaker = (replace(TRAIN, grip=share * DRAG.holding_force) for share in (0.99, 0.35))
    band, never = hersey.hysteresis(weak, DRAG), hersey.hysteresis(weaker, DRAG)
    assert band.stalls
    assert never.stalls
    assert hersey.stick_slip(weak, DRAG, drive_speed=1.5).kind == "stalled"
    released = (DRAG.stick_speed, float(DRAG.force(DRAG.stick_speed)) / TRAIN.stiffness)
    kinds = [hersey.stick_slip(train, DRAG, drive_speed=1.5, start=released).kind for train in (weak, weaker)]
    assert kinds == ["stick_slip", "stalled"]
    assert band.verdict().startswith("The grip does not suffice to start from rest")
    assert (never.lower, never.upper, never.sensitivity, never.bistable) == (0.0, 0.0, {}, False)
    assert "No stick-slip: what sticks also stalls" in never.verdict()
    for stalling in (band, never):
        drawn = band_chart(stalling).to_dict()
        states = drawn["layer"][0]["data"]["values"]
        assert [row["state"] for row in states] == ["stall: the drive slips"]
    assert not hersey.hysteresis(replace(TRAIN, grip=1.01 * DRAG.holding_force), DRAG).stalls
    stiction = hersey.hysteresis(weak, replace(DRAG, closure="stiction"))
    assert (stiction.stalls, stiction.upper) == (True, 0.0)


def test_a_smooth_closure_that_stalls_has_no_stick_slip() -> None:
    drag = replace(DRAG, closure="stribeck", stick_speed=0.1)
    band = hersey.hysteresis(replace(TRAIN, grip=60.0), drag)
    assert (band.stalls, band.lower, band.upper) == (True, 0.0, 0.0)


@pytest.mark.parametrize("share", [0.45, 0.7, 1.05])
@pytest.mark.parametrize("closure", ["retained", "stiction"])
@pytest.mark.parametrize("damping", [0.6, 1.6])
def test_the_fold_is_that_of_the_roll_that_slips(share: float, closure: str, damping: float) -> None:
    """Just below it the belt goes on sticking, or swinging while the roll slips; just above it does not."""
    drag = replace(DRAG, transition_force=damping * 1000**0.5, closure=closure)
    train = replace(TRAIN, grip=share * drag.holding_force)
    band, free = (hersey.hysteresis(t, drag, sensitivity=False) for t in (train, TRAIN))
    if closure == "stiction" and band.stalls:
        assert band.upper == 0
        return
    assert band.upper <= free.upper
    if (damping, share) == (0.6, 0.45) or closure == "stiction":
        assert band.upper < 0.95 * free.upper
    release = float(drag.force(drag.stick_speed)) / train.stiffness
    start: Any = (drag.stick_speed, release) if band.stalls else "rest"
    for factor, rough in ((1 - 1e-5, True), (1 + 1e-5, False)):
        cycle = hersey.stick_slip(train, drag, drive_speed=factor * band.upper, start=start)
        goes_on = cycle.kind in ("stick_slip", "oscillation") and (
            cycle.grip_slip_duration > 0 or cycle.stick_duration > 0
        )
        assert goes_on == rough, (factor, cycle)


def test_many_bands_know_the_grip_and_one_that_always_holds_changes_no_bit() -> None:
    forces = np.geomspace(5.0, 100.0, 9)
    train = replace(TRAIN, grip=150.0)
    swept = hersey.hysteresis_sweep(train, DRAG, transition_force=forces)
    alone = [hersey.hysteresis(train, replace(DRAG, transition_force=f), sensitivity=False) for f in forces]
    assert swept.upper.values.tolist() == [band.upper for band in alone]
    assert swept.lower.values.tolist() == [band.lower for band in alone]
    assert swept.stalls.values.tolist() == [band.stalls for band in alone]
    assert 0 < swept.stalls.values.sum() < forces.size
    free, gripped = (
        hersey.hysteresis_sweep(t, DRAG, transition_force=forces) for t in (TRAIN, replace(TRAIN, grip=1e3))
    )
    for name in free:
        np.testing.assert_array_equal(free[name], gripped[name])
    draws = hersey.hysteresis(train, DRAG, samples={"transition_force": forces})
    assert draws.interval is not None
    assert draws.interval[0] == 0.0


def test_a_sweep_over_temperature_takes_the_rest_of_the_drive() -> None:
    """A rest of 10 N + 4 N s/m that falls by 1 % per kelvin: 6 N + 2.4 N s/m when 40 K warmer."""
    cold = replace(DRAG, rest_force=10.0, rest_damping=4.0)
    warm = replace(cold, reference_temperature=400.0, rest_temperature_slope=-0.01)
    swept = hersey.hysteresis_sweep(TRAIN, warm, temperature=[400.0, 440.0])
    for i, rest in enumerate((cold, replace(DRAG, rest_force=6.0, rest_damping=2.4))):
        band = hersey.hysteresis(TRAIN, rest, sensitivity=False)
        assert float(swept.upper[i]) == pytest.approx(band.upper, rel=1e-9)
    assert float(swept.upper[1]) != pytest.approx(float(swept.upper[0]), rel=0.01)


def measured(stick_speed: float) -> hersey.DragTable:
    """A belt's drag as a log gives it: points, a rest that rises with speed, and a rounded minimum."""
    speed = np.geomspace(0.006, 0.4, 47)
    force = 0.55 * (speed / 0.03) ** -0.9 + 0.38 * (speed / 0.03) ** 0.6
    return hersey.DragTable(
        tuple(speed.tolist()), tuple(force.tolist()), stick_speed, rest_force=12.0, rest_damping=4.6
    )


@pytest.mark.parametrize("stick_speed", np.geomspace(0.0025, 0.0035, 20).tolist())
def test_the_fold_of_a_measured_drag_is_found_in_few_steps(stick_speed: float) -> None:
    """Nearer to V* than steps are accurate a motion may stick now and then for ever: halving ends before."""
    train, drag = hersey.Drivetrain(11_000, 11, grip=400.0), measured(stick_speed)
    transition, upper = fold(train, drag, tolerance=1e-8, most_steps=20_000)
    assert transition == drag.speeds[int(np.argmin(drag.forces))]
    for factor, kind in ((1.0 - 1e-5, "stick_slip"), (1.0 + 1e-5, "steady_sliding")):
        assert hersey.stick_slip(train, drag, drive_speed=factor * upper).kind == kind
