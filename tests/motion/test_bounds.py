"""Inputs that look sound and would take for ever: a bound on the work, or a refusal by name."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hersey import Drag, Drivetrain, simulate, stick_slip
from hersey.errors import ParameterError, UnfinishedError
from hersey.lubrication.reynolds import ElasticLayer, ThickeningFluid, solve_line_contact
from hersey.motion.sweep import sweep
from hersey.motion.work import Work
from hersey.stability.hysteresis import hysteresis
from hersey.stability.hysteresis_sweep import hysteresis_sweep

TRAIN = Drivetrain(1000, 1)
DRAG = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
BRISTLES = replace(DRAG, closure="lugre", bristle_stiffness=1e5, bristle_damping=100.0)
EXTREME = (1e-300, 1e-100, 1e-12, 1e12, 1e100, 1e300)
#: Steps that take a moment, and processor time that they never take, s.
FEW, LONG = 20_000, 30.0


def belt(name: str, value: float, closure: str) -> tuple[Drivetrain, Drag]:
    """The baseline with one value out of all measure."""
    drag = {"lugre": BRISTLES}.get(closure, replace(DRAG, closure=closure))
    if name in ("stiffness", "mass"):
        return replace(TRAIN, **{name: value}), drag
    return TRAIN, replace(drag, **{name: value})


def run(train: Drivetrain, drag: Drag) -> object:
    return simulate(train, drag, drive_speed=1.0, duration=1e300, samples=11, most_steps=FEW)


def settled(train: Drivetrain, drag: Drag) -> object:
    return stick_slip(train, drag, drive_speed=1.0, most_steps=FEW)


def swept(train: Drivetrain, drag: Drag) -> object:
    return sweep(train, drag, drive_speed=[0.5, 1.0], duration=1e300, work=Work(most_steps=FEW))


def band(train: Drivetrain, drag: Drag) -> object:
    return hysteresis(train, drag, sensitivity=False, most_steps=FEW)


@pytest.mark.parametrize("closure", ["retained", "stiction", "stribeck", "lugre"])
@pytest.mark.parametrize("call", [run, settled, swept, band])
@pytest.mark.parametrize(
    "name", ["stiffness", "mass", "transition_force", "transition_speed", "ehl_exponent", "mixed_exponent"]
)
def test_values_out_of_all_measure_end(
    name: str, call: Callable[[Drivetrain, Drag], object], closure: str
) -> None:
    begun = time.process_time()
    for value in EXTREME if name[-8:] != "exponent" else (-100.0, -2.0, -1.0, 0.0, 30.0, *EXTREME):
        with contextlib.suppress(ParameterError, UnfinishedError):
            call(*belt(name, value, closure))
    assert time.process_time() - begun < LONG


@pytest.mark.parametrize(
    "name",
    ["radius", "load", "entrainment_speed", "viscosity", "effective_modulus", "pressure_viscosity"],
)
@pytest.mark.parametrize("thickness", [None, 3.5e-3])
def test_films_out_of_all_measure_end(name: str, thickness: float | None) -> None:
    nip: dict[str, Any] = {"radius": 0.015, "load": 1136.0, "entrainment_speed": 0.1, "viscosity": 0.1}
    begun = time.process_time()
    for value in EXTREME:
        given = {**nip, "effective_modulus": 2.63e6, "nodes": 101, name: value}
        if (alpha := given.pop("pressure_viscosity", None)) is not None:
            given["viscosity"] = ThickeningFluid(given["viscosity"], alpha)
        with contextlib.suppress(ParameterError, UnfinishedError):
            solve_line_contact(**given, layer=thickness and ElasticLayer(thickness, 0.49))
    assert time.process_time() - begun < 10 * LONG


def test_a_soft_spring_for_ever_says_how_much_was_done_and_how_to_allow_more() -> None:
    drag = replace(DRAG, closure="stribeck")
    times = []
    for steps in (10_000, 40_000):
        with pytest.raises(UnfinishedError, match="most_steps") as caught:
            simulate(TRAIN, drag, drive_speed=1.0, duration=1e300, samples=2, most_steps=steps)
        assert caught.value.steps == steps
        assert str(steps) in str(caught.value)
        times.append(caught.value.time)
    assert times[0] is not None
    assert times[1] is not None
    assert times[1] > 1.5 * times[0] > 0


def test_a_belt_of_a_sweep_that_takes_too_long_is_among_the_failures() -> None:
    few = sweep(TRAIN, DRAG, drive_speed=[0.5, 1.0], duration=1e300, work=Work(most_steps=FEW))
    assert few.kind.values.tolist() == ["failed", "failed"]
    assert all(f"after {FEW} steps" in failure for failure in few.attrs["failures"])
    alike = sweep(TRAIN, DRAG, drive_speed=[1.0, 0.5], duration=1e300, work=Work(most_steps=FEW, threads=2))
    assert few.attrs["failures"][0][7:] == alike.attrs["failures"][1][7:]


def test_a_band_allows_its_motions_only_so_much_together() -> None:
    with pytest.raises(UnfinishedError) as caught:
        hysteresis(TRAIN, BRISTLES, most_steps=FEW)
    assert caught.value.steps in (FEW, 6 * FEW)


@pytest.mark.parametrize(("ehl", "mixed"), [(-0.7, -0.7), (-1.2, -1.2), (-1.2, -0.7)])
def test_exponents_that_divide_nothing_are_refused_at_once(ehl: float, mixed: float) -> None:
    drag = replace(DRAG, ehl_exponent=ehl, mixed_exponent=mixed)
    with pytest.raises(ParameterError) as caught:
        hysteresis(TRAIN, drag, most_steps=1)
    assert caught.value.quantity == "mixed_exponent"
    assert (caught.value.value, caught.value.limit) == (mixed, ehl)
    bands = hysteresis_sweep(TRAIN, drag, ehl_exponent=[-0.7, ehl], mixed_exponent=[-1.2, mixed], zip=True)
    assert np.isfinite(bands.upper.values).tolist() == [True, False]
    assert "mixed_exponent" in bands.attrs["failures"][0]


@pytest.mark.parametrize("count", [20_000_001, 10**12, 10**30])
def test_more_samples_than_memory_are_refused(count: int) -> None:
    with pytest.raises(ParameterError) as caught:
        simulate(TRAIN, DRAG, drive_speed=1.0, duration=1.0, samples=count)
    assert caught.value.quantity == "samples"
    assert caught.value.limit == 20_000_000


@pytest.mark.parametrize("together", [False, True])
def test_more_sets_than_memory_are_refused(together: bool) -> None:
    many = np.linspace(1.0, 2.0, 100_000)
    across = many[:, None] if together else many
    with pytest.raises(ParameterError, match=r"1e\+10 parameter sets"):
        sweep(TRAIN, DRAG, drive_speed=many, stiffness=across, zip=together)
    with pytest.raises(ParameterError, match=r"1e\+10 parameter sets"):
        hysteresis_sweep(TRAIN, DRAG, mass=many, stiffness=across, zip=together)


@pytest.mark.parametrize("name", ["most_steps", "threads"])
@pytest.mark.parametrize("value", [0, -1, float("nan")])
def test_a_number_of_steps_or_threads_is_at_least_one(name: str, value: float) -> None:
    with pytest.raises(ParameterError, match=f"{name} is"):
        sweep(TRAIN, DRAG, drive_speed=1.0, work=Work(**{name: value}))  # type: ignore[arg-type]


def test_more_threads_than_anybody_has_give_the_same() -> None:
    speeds = np.linspace(0.5, 2.0, 600)
    many = sweep(TRAIN, DRAG, drive_speed=speeds, work=Work(threads=10**30))
    assert many.identical(sweep(TRAIN, DRAG, drive_speed=speeds))


@pytest.mark.parametrize("tolerance", [1e-300, 0.0, -1.0, 1.0, float("nan")])
def test_tolerances_that_no_step_keeps_are_refused(tolerance: float) -> None:
    for call in (
        lambda: simulate(TRAIN, DRAG, drive_speed=1.0, duration=1.0, tolerance=tolerance),
        lambda: stick_slip(TRAIN, DRAG, drive_speed=1.0, tolerance=tolerance),
        lambda: hysteresis(TRAIN, DRAG, tolerance=tolerance),
    ):
        with pytest.raises(ParameterError) as caught:
            call()
        assert caught.value.quantity == "tolerance"
