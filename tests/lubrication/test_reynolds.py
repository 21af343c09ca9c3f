"""The numerical line contact against limits, published laws and dry nips."""

from __future__ import annotations

import json
from dataclasses import astuple

import numpy as np
import pytest
from scipy.optimize import brentq

from hersey.errors import ParameterError
from hersey.lubrication.reynolds import (
    ElasticLayer,
    LineContactSolution,
    ThickeningFluid,
    exponent,
    solve_line_contact,
)
from tests.conftest import shared

RADIUS, VISCOSITY, MODULUS = 0.015, 0.1, 2e6


def groups(speed: float, load: float, modulus: float = MODULUS) -> tuple[float, float]:
    """U and W with the mean speed and E'."""
    return VISCOSITY * speed / (modulus * RADIUS), load / (modulus * RADIUS)


def solve(speed: float, load: float = 1000.0, **more: object) -> LineContactSolution:
    settings: dict[str, object] = {"effective_modulus": MODULUS, **more}
    return solve_line_contact(RADIUS, load, speed, VISCOSITY, **settings)  # type: ignore[arg-type]


def test_rigid_isoviscous_is_martin() -> None:
    """Film h = 4.89 eta u R/w, u the mean speed; Martin 1916: outlet at 0.475 root of 2 R h."""

    def pressure_at_inlet(outlet: float) -> float:
        x = np.linspace(-np.pi / 2, np.arctan(outlet), 20_001)  # the angle gamma, x = tan gamma
        rise = np.cos(x) ** 2 - np.cos(x) ** 4 * (1 + outlet**2)
        return float(np.trapezoid(rise, x))

    outlet = brentq(pressure_at_inlet, 0.3, 0.7)
    film = solve(1e-2, effective_modulus=1e14, nodes=401)
    assert film.outlet == pytest.approx(outlet * np.sqrt(2 * RADIUS * film.minimum_thickness), rel=2e-3)
    assert film.minimum_thickness * 1000 / (VISCOSITY * 1e-2 * RADIUS) == pytest.approx(4.892, rel=2e-3)
    assert film.by_speed.minimum_thickness == pytest.approx(1.0, abs=2e-3)
    assert film.by_load.minimum_thickness == pytest.approx(-1.0, abs=2e-3)


def test_isoviscous_elastic_constant_and_exponents() -> None:
    """H = 3.05 to 3.10 U^0.60 W^-0.2 with E' and mean speed; in Hertz units 0.447 and 0.360 lambda^0.6."""
    for speed in (0.1, 0.2, 0.4):
        film = solve(speed, nodes=401)
        u, w = groups(speed, 1000.0)
        assert film.minimum_thickness / RADIUS / (u**0.6 * w**-0.2) == pytest.approx(3.075, abs=0.035)
        assert film.by_speed.minimum_thickness == pytest.approx(0.61, abs=0.012)
    film, (u, w) = solve(1e-3, nodes=601), groups(1e-3, 1000.0)
    unit = 8 * w / np.pi * RADIUS * (7.402 * u / w**2) ** 0.6
    assert film.central_thickness / unit == pytest.approx(0.447, rel=7e-3)
    assert film.minimum_thickness / unit == pytest.approx(0.360, rel=2e-2)
    assert film.by_speed.minimum_thickness == pytest.approx(0.6, abs=2e-3)
    assert film.outlet == pytest.approx(np.sqrt(8 * 1000 * RADIUS / (np.pi * MODULUS)), rel=3e-3)


@pytest.mark.parametrize("compressible", [False, True])
@pytest.mark.parametrize(("w", "u"), [(1e-5, 1e-11), (3e-5, 1e-12), (1e-4, 1e-12)])
def test_piezoviscous_elastic_is_dowson_and_higginson(w: float, u: float, compressible: bool) -> None:
    """H_min = 2.65 U^0.70 G^0.54 W^-0.13 (Dowson 1968) was fitted to solutions that scatter by some 8 %."""
    modulus, radius, viscosity, alpha = 2.2e11, 0.02, 0.04, 2.2e-8
    film = solve_line_contact(
        radius,
        w * modulus * radius,
        u * modulus * radius / viscosity,
        ThickeningFluid(viscosity, alpha, compressible=compressible),
        effective_modulus=modulus,
        sliding_speed=0.0,
    )
    formula = 2.65 * u**0.70 * (alpha * modulus) ** 0.54 * w**-0.13
    assert film.minimum_thickness / radius == pytest.approx(formula, rel=0.08)
    assert film.by_speed.minimum_thickness == pytest.approx(0.70, abs=0.02)
    assert film.by_load.minimum_thickness == pytest.approx(-0.13, abs=0.04)


@pytest.mark.parametrize("layer", [None, ElasticLayer(3.5e-3, 0.49)])
def test_load_forces_and_flow_balance(layer: ElasticLayer | None) -> None:
    film = solve(0.1, layer=layer)
    assert np.trapezoid(film.pressure, film.x) == pytest.approx(1000.0, rel=1e-6)
    assert abs(film.load_residual) < 1e-10
    # what shear does to both surfaces is what pressure does to the sloping film
    slope = np.gradient(film.film_thickness, film.x)
    push = np.trapezoid(film.pressure * slope, film.x)
    assert film.roll_traction + film.base_traction == pytest.approx(push, rel=1e-2)
    # where pressure is greatest it drives no flow: the film there is that of the outlet
    assert film.film_thickness[film.pressure.argmax()] == pytest.approx(film.film_thickness[-1], rel=5e-3)


@pytest.mark.parametrize("layer", [None, ElasticLayer(1e-3, 0.5)])
def test_second_order_on_refinement(layer: ElasticLayer | None) -> None:
    films = [solve(0.1, nodes=n, layer=layer).minimum_thickness for n in (101, 201, 401, 801)]
    steps = np.diff(films)
    orders = np.log2(steps[:-1] / steps[1:])
    print(f"order of the least film, {layer or 'half space'}: {orders.round(2)}")  # noqa: T201
    assert orders.min() > 1.7
    assert orders[-1] == pytest.approx(2.0, abs=0.3)
    error = abs(films[1] / (films[3] + steps[2] / 3) - 1)
    assert solve(0.1, nodes=201, layer=layer).grid_error == pytest.approx(error, rel=0.7)


def test_layer_carries_the_dry_load_at_low_speed() -> None:
    """Nips of field-notes 4.2: the film ends where the dry contact does when u goes to 0."""
    rows = json.loads(shared("reference/nip-width.json").read_text())["rows"]
    thickness = 3e-3
    for row in rows:
        for poisson in (0.45, 0.49, 0.50):
            number = row[f"W_nu_{poisson:.2f}" if poisson < 0.5 else "W_nu_0.5"]
            load = number * 0.5 * MODULUS * thickness**2 / RADIUS
            speed = (1e-7 if row["nip_over_h"] < 3 else 1e-6) * load
            film = solve(speed, load, layer=ElasticLayer(thickness, poisson), nodes=151)
            nip = 2 * film.outlet / thickness
            assert nip == pytest.approx(row["nip_over_h"], rel=0.01), (poisson, row)


def test_thick_layer_is_half_space() -> None:
    """A layer 500 half widths thick moves the film by less than the grid does."""
    layer = solve(0.1, layer=ElasticLayer(1.5, 0.3))
    space = solve(0.1)
    assert layer.minimum_thickness == pytest.approx(space.minimum_thickness, rel=1e-4)
    assert layer.greatest_pressure == pytest.approx(space.greatest_pressure, rel=1e-3)


@pytest.mark.parametrize("poisson", [0.49, 0.50])
def test_exponents_of_a_soft_layer(poisson: float) -> None:
    """Field-notes 4.3: film 0.58 to 0.63, Couette torque 0.40 to 0.44, B -0.56 to -0.60."""
    for thickness in (1.5e-3, 6e-3):
        layer = ElasticLayer(thickness, poisson)
        films = [solve(0.02 * f, layer=layer, nodes=401) for f in (0.95, 1.0, 1.05)]
        span = np.log(1.05 / 0.95)
        own = films[1].by_speed
        assert 0.58 < own.minimum_thickness < 0.63
        by_difference = np.log(films[2].minimum_thickness / films[0].minimum_thickness) / span
        assert own.minimum_thickness == pytest.approx(by_difference, abs=3e-3)
        couette = np.log(films[2].couette / films[0].couette) / span
        assert 0.39 < couette < 0.44
        traction = np.log(films[2].roll_traction / films[0].roll_traction) / span
        assert exponent("torque", films[1]) == pytest.approx(traction, abs=3e-3)
        assert exponent("damping", films[1]) == pytest.approx(traction - 1, abs=3e-3)
        assert -0.61 < exponent("damping", films[1]) < -0.54


def test_friction_of_both_surfaces() -> None:
    """Opposite sliding turns the shear round; pure rolling leaves the pressure-driven part."""
    ahead, behind, rolling = (solve(0.1, sliding_speed=s) for s in (0.2, -0.2, 0.0))
    assert ahead.couette == pytest.approx(-behind.couette, rel=1e-9)
    assert rolling.couette == 0.0
    assert rolling.roll_traction == rolling.base_traction == -rolling.poiseuille
    assert ahead.minimum_thickness == behind.minimum_thickness
    assert ahead.friction == pytest.approx(abs(ahead.roll_traction) / 1000.0)
    assert ahead.base_traction > 0 > ahead.roll_traction


def test_units_scale_out() -> None:
    """Only U, W and thickness over radius count: a model ten times as large has the same shape."""
    small = solve(0.1, layer=ElasticLayer(3e-3, 0.49))
    large = solve_line_contact(
        10 * RADIUS, 1e4, 1.0, VISCOSITY, effective_modulus=MODULUS, layer=ElasticLayer(3e-2, 0.49)
    )
    assert large.minimum_thickness == pytest.approx(10 * small.minimum_thickness, rel=1e-7)
    assert astuple(large.by_speed) == pytest.approx(astuple(small.by_speed), abs=1e-5)


def test_work_is_pinned() -> None:
    film = solve(0.1, layer=ElasticLayer(3.5e-3, 0.49))
    assert film.iterations <= 70
    assert film.stations <= 12


def test_warnings() -> None:
    assert solve(0.1, 100.0, layer=ElasticLayer(3.5e-3, 0.49)).warnings == ()
    soft = solve(0.1, 5000.0, layer=ElasticLayer(3e-3, 0.45))
    (indented,) = (each for each in soft.warnings if each.kind == "layer indented deeply")
    assert indented.values == {"share": -soft.offset / 3e-3, "most": 0.15}


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"viscosity": 0.0}, "viscosity"),
        ({"load": -1.0}, "load"),
        ({"radius": float("nan")}, "radius"),
        ({"entrainment_speed": 0.0}, "entrainment_speed"),
        ({"effective_modulus": 0.0}, "effective_modulus"),
        ({"layer": ElasticLayer(1e-3, 0.51)}, "poisson"),
        ({"layer": ElasticLayer(0.0, 0.5)}, "thickness"),
        ({"nodes": 10}, "nodes"),
        ({"nodes": 100_000}, "nodes"),
        ({"nodes": -1}, "nodes"),
        ({"viscosity": ThickeningFluid(VISCOSITY, -1e-9)}, "pressure_viscosity"),
        ({"viscosity": ThickeningFluid(1e-5, 1e-8)}, "viscosity"),
        ({"viscosity": ThickeningFluid(VISCOSITY, 1e-9, "cement")}, "cement"),  # type: ignore[arg-type]
        ({"sliding_speed": float("inf")}, "sliding_speed"),
    ],
)
def test_bad_input_is_named(change: dict[str, object], word: str) -> None:
    good: dict[str, object] = {
        "radius": RADIUS,
        "load": 1000.0,
        "entrainment_speed": 0.1,
        "viscosity": VISCOSITY,
        "effective_modulus": MODULUS,
    }
    with pytest.raises(ParameterError, match=word):
        solve_line_contact(**{**good, **change})  # type: ignore[arg-type]


def test_unknown_exponent_is_named() -> None:
    with pytest.raises(ParameterError, match="wear"):
        exponent("wear", solve(0.1))  # type: ignore[arg-type]


@pytest.mark.parametrize("load", [5.0, 20.0, 100.0])
@pytest.mark.parametrize("material", [5.0, 10.0])
def test_central_film_of_moes(load: float, material: float) -> None:
    """Moes' fit to full numerical line contacts (Wear 159 (1992) 57): M, L with the sum velocity."""
    speed, modulus, radius, viscosity = 1e-11, 2.2e11, 0.01, 0.04
    solution = solve_line_contact(
        radius,
        load * np.sqrt(speed) * modulus * radius,
        0.5 * speed * modulus * radius / viscosity,
        ThickeningFluid(viscosity, material / speed**0.25 / modulus),
        effective_modulus=modulus,
        nodes=401,
    )
    rigid, elastic = 3.0 / load, 2.621 * load**-0.2
    hard, both = 1.287 * material ** (2 / 3), 1.311 * load**-0.125 * material**0.75
    s = (7.0 + 8.0 * np.exp(-2.0 * elastic / rigid)) / 5.0
    fit = (
        (rigid ** (7 / 3) + elastic ** (7 / 3)) ** (3 * s / 7) + (hard**-3.5 + both**-3.5) ** (-2 * s / 7)
    ) ** (1 / s)
    assert solution.central_thickness / radius / np.sqrt(speed) == pytest.approx(fit, rel=0.09)


def test_profiles_cannot_be_overwritten() -> None:
    solution = solve_line_contact(0.01, 1e4, 0.5, 0.05, effective_modulus=1e7, nodes=65)
    for profile in (solution.x, solution.pressure, solution.film_thickness):
        with pytest.raises(ValueError, match="read-only"):
            profile[0] = 1.0


def test_the_shear_of_a_rigid_roll_reaches_far_upstream() -> None:
    """Between h + x^2/2R and a wall the integral of dx/h is an arctangent, of which the grid holds a part."""
    film = solve(1e-2, sliding_speed=0.02, effective_modulus=1e14, nodes=401)
    reach = np.sqrt(2 * RADIUS * film.minimum_thickness)
    by_hand = reach / film.minimum_thickness * (np.arctan(film.outlet / reach) + np.pi / 2)
    assert film.couette / (VISCOSITY * 0.02) == pytest.approx(by_hand, rel=3e-4)
