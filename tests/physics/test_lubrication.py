"""The film theory against published numbers, limits and the shape of its own algebra."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

from hersey import _core
from hersey.arrays import pointwise
from hersey.lubrication import paper
from hersey.lubrication.contact import Contact, nip_width
from hersey.lubrication.film import drag_torque, film_thickness
from hersey.lubrication.lubricant import EXAMPLES, Lubricant
from hersey.units import registry
from tests.conftest import shared

NIP: dict[str, float] = {
    "pressure_viscosity": 2e-8,
    "viscosity": 0.1,
    "entrainment_speed": 0.1,
    "load": 250.0,
    "length": 0.22,
    "rubber_thickness": 3.5e-3,
    "radius": 15e-3,
    "effective_modulus": 2e6 / (1 - 0.48**2),
}


def own(names: str) -> dict[str, float]:
    return {name: NIP[name] for name in names.split()}


FILM = own("pressure_viscosity viscosity entrainment_speed load length radius effective_modulus")
WIDTH = own("load length rubber_thickness radius effective_modulus")


def test_the_chain_composes_to_eq_9_and_10() -> None:
    torque = paper.torque_of_film(
        viscosity=NIP["viscosity"],
        sliding_speed=2 * NIP["entrainment_speed"],
        film_thickness=paper.film_thickness(**FILM),
        nip_width=paper.nip_width(**WIDTH),
        length=NIP["length"],
        radius=NIP["radius"],
    )
    assert torque == pytest.approx(paper.torque(**NIP), rel=1e-3)
    assert paper.damping(**NIP) * NIP["entrainment_speed"] == pytest.approx(paper.torque(**NIP), rel=1e-12)
    assert paper.nip_width(**WIDTH) == pytest.approx(5.7e-3, rel=0.01)


@pytest.mark.parametrize(
    ("equation", "given", "exponents"),
    [
        (
            paper.film_thickness,
            FILM,
            {"pressure_viscosity": 0.6, "viscosity": 0.7, "entrainment_speed": 0.7, "load": -0.13}
            | {"length": 0.13, "radius": 0.43, "effective_modulus": 0.03},
        ),
        (
            paper.nip_width,
            WIDTH,
            {"load": 0.32, "length": -0.32, "rubber_thickness": 0.37, "radius": 0.32}
            | {"effective_modulus": -0.32},
        ),
        (
            paper.torque,
            NIP,
            {"pressure_viscosity": -0.6, "viscosity": 0.3, "entrainment_speed": 0.3, "load": 0.45}
            | {"length": 0.55, "rubber_thickness": 0.37, "radius": 0.89, "effective_modulus": -0.35},
        ),
        (
            paper.damping,
            NIP,
            {"pressure_viscosity": -0.6, "viscosity": 0.3, "entrainment_speed": -0.7, "load": 0.45}
            | {"length": 0.55, "rubber_thickness": 0.37, "radius": 0.89, "effective_modulus": -0.35},
        ),
    ],
)
def test_exponents_by_differencing(
    equation: Callable[..., Any], given: dict[str, float], exponents: dict[str, float]
) -> None:
    assert set(exponents) == set(given)
    for name, exponent in exponents.items():
        up = equation(**given | {name: given[name] * 1.001})
        down = equation(**given | {name: given[name] / 1.001})
        assert np.log(up / down) / (2 * np.log(1.001)) == pytest.approx(exponent, abs=1e-9), name


#: Units of what an equation takes, and of what it gives; exponents of regressions are rounded.
UNITS = {
    "pressure_viscosity": "1/Pa",
    "viscosity": "Pa*s",
    "entrainment_speed": "m/s",
    "load": "N",
    "length": "m",
    "rubber_thickness": "m",
    "radius": "m",
    "effective_modulus": "Pa",
}


@pytest.mark.parametrize(
    ("equation", "given", "unit"),
    [
        (paper.film_thickness, FILM, "m"),
        (paper.nip_width, WIDTH, "m"),
        (paper.torque, NIP, "N*m"),
        (paper.damping, NIP, "N*s"),
    ],
)
def test_dimensions(equation: Callable[..., Any], given: dict[str, float], unit: str) -> None:
    total = registry.Quantity(1.0)
    for name in given:
        up, down = (equation(**given | {name: given[name] * f}) for f in (1.001, 1 / 1.001))
        total *= registry.Quantity(1.0, UNITS[name]) ** float(np.log(up / down) / (2 * np.log(1.001)))
    left = (total / registry.Quantity(1.0, unit)).to_base_units().dimensionality
    assert all(abs(float(power)) < 0.0101 for power in left.values()), left


def test_published_line_and_point_films() -> None:
    table = shared("data/tables/ehl_film_reference_values.csv")
    seen = 0
    for row in csv.DictReader(table.open()):
        number = {k: float(row[k]) for k in ("eta_Pas", "alpha", "u_entrain", "load", "Eprime", "R")}
        columns = (number["alpha"], number["eta_Pas"], number["u_entrain"], number["load"], number["R"])
        if row["formula"].startswith("Dowson-Higginson line"):
            found = pointwise(_core.line_film, *columns, number["Eprime"], 1.0).minimum[
                "piezoviscous-elastic"
            ]
        elif row["formula"].startswith("paper Eq5"):
            found = paper.film_thickness(
                pressure_viscosity=number["alpha"],
                viscosity=number["eta_Pas"],
                entrainment_speed=number["u_entrain"],
                load=number["load"],
                length=1.0,
                radius=number["R"],
                effective_modulus=number["Eprime"],
            )
        elif "book conventions" in row["case"]:
            # The book takes 1/R = 1/Rx + 1/Ry; its stated answer is in um.
            found = pointwise(_core.elliptic_film, *columns, number["Eprime"], 1.0339).hard_minimum
            assert 1e6 * found == pytest.approx(float(row["stated_answer_um"]), rel=0.01)
        else:
            found = pointwise(_core.elliptic_film, *columns, number["Eprime"], 1.0).hard_minimum
        assert found == pytest.approx(float(row["hmin_m"]), rel=2e-3), row["case"]
        seen += 1
    assert seen >= 10


def test_the_soft_point_film_is_the_one_known_for_joints() -> None:
    # For k = 1 the law is known as h = 2.80 R (eta u/(E'R))^0.65 (W/(E'R^2))^-0.21; its chart form is
    # 8.70 g_E^0.67 (1 - 0.85 exp(-0.31 k)).
    eta, u, load, radius, modulus = 0.005, 0.02, 1500.0, 0.5, 1e9
    soft = pointwise(_core.elliptic_film, 0.0, eta, u, load, radius, modulus, 1.0).soft_minimum
    speed, weight = eta * u / (modulus * radius), load / (modulus * radius**2)
    assert soft == pytest.approx(2.80 * radius * speed**0.65 * weight**-0.21, rel=2e-3)
    chart = 8.70 * (weight ** (8 / 3) / speed**2) ** 0.67 * (1 - 0.85 * np.exp(-0.31))
    assert soft == pytest.approx(chart * radius * (speed / weight) ** 2, rel=0.15)


def test_hertz_against_a_textbook_example() -> None:
    example = json.loads(shared("data/tables/hertz_worked_example.json").read_text())
    case = example["EngTribology_Hertz_example"]
    modulus = _core.effective_modulus((case["E"], case["nu"]), (case["E"], case["nu"]))
    radius = _core.reduced_radius(case["RA"], case["RB"])
    assert modulus == pytest.approx(case["stated"]["Eprime"], rel=1e-3)
    assert radius == pytest.approx(case["stated"]["Rx"], rel=1e-9)
    found = pointwise(partial(_core.hertz, line=False), case["W"], radius, modulus)
    assert found.half_width == pytest.approx(case["computed"]["a"], rel=1e-4)
    assert found.pressure_max == pytest.approx(case["computed"]["pmax"], rel=1e-3)


def test_nip_widths_of_the_table() -> None:
    for row in csv.DictReader(shared("data/tables/nip_width_formula_values.csv").open()):
        roll = Contact(
            roll_radius=float(row["R_m"]),
            rubber_thickness=float(row["h_rubber_m"]),
            modulus=float(row["E_Pa"]),
            poisson_ratio=float(row["nu"]),
            length=1.0,
            load=float(row["N_per_L_N_m"]),
        )
        assert roll.effective_modulus == pytest.approx(float(row["Eprime_2E_over_1mnu2"]), rel=1e-9)
        by_paper = float(row["nip_width_implied_paper_Eq8_m"])
        assert nip_width(roll, rule="paper") == pytest.approx(by_paper, rel=2e-3)
        by_hertz = float(row["nip_width_Hertz_line_2b_m"])
        assert nip_width(roll, rule="hertz") == pytest.approx(by_hertz, rel=1e-6)


@pytest.mark.parametrize("nu", [0.45, 0.49, 0.5])
def test_the_bonded_layer_against_an_independent_solution(nu: float) -> None:
    reference = json.loads(shared("reference/nip-width.json").read_text())
    for row in reference["rows"]:
        ratio, load = row["nip_over_h"], row[f"W_nu_{nu:g}" if nu != 0.5 else "W_nu_0.5"]
        thickness, radius, modulus = 2e-3, 20e-3, 3e6
        star = modulus / (1 - nu**2)
        roll = Contact(
            roll_radius=radius,
            rubber_thickness=thickness,
            modulus=modulus,
            poisson_ratio=nu,
            length=1.0,
            load=load * star * thickness**2 / radius,
        )
        assert nip_width(roll) / thickness == pytest.approx(ratio, rel=1e-3)
        in_metres = thickness**0.01
        eq8 = float(nip_width(roll, rule="paper") / nip_width(roll)) / in_metres
        assert eq8 == pytest.approx(row[f"eq8_ratio_nu_{nu:g}"], rel=2e-3)


def test_the_layer_thins_the_soft_film_as_full_solutions_do() -> None:
    # Full numerical solutions for a/t = 1, nu = 0.49 to 0.5 give about a quarter less than a half-space.
    roll = Contact(
        roll_radius=20e-3, rubber_thickness=2e-3, modulus=3e6, poisson_ratio=0.5, length=1.0, load=1196.0
    )
    assert roll.nip.half_width / roll.rubber_thickness == pytest.approx(1.0, abs=0.01)
    assert roll.nip.layer_factor == pytest.approx(0.75, abs=0.04)
    thick = Contact(
        roll_radius=2.0, rubber_thickness=1.9, modulus=3e6, poisson_ratio=0.5, length=1.0, load=1.0
    )
    assert thick.nip.layer_factor == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("number", range(14))
def test_walther_predicts_the_middle_viscosity_of_mineral_oils(number: int) -> None:
    table = shared("data/tables/oil_eta0_alpha_30_60_100C_StachowiakTab2.3_excerpt.csv")
    row = list(csv.DictReader(table.open()))[number]
    eta = [1e-3 * float(row[f"eta0_{t}C_mPas"]) for t in (30, 60, 100)]
    oil = Lubricant("walther", ((303.15, eta[0]), (373.15, eta[2])), density=880.0)
    tolerance = 0.05 if row["lubricant"] == "Water" else 0.25
    assert oil.viscosity(333.15) == pytest.approx(eta[1], rel=tolerance)


def test_shipped_oils_are_those_of_their_source() -> None:
    table = shared("data/tables/oil_eta0_alpha_30_60_100C_StachowiakTab2.3_excerpt.csv")
    printed = [tuple(row.values())[1:] for row in csv.DictReader(table.open())]
    known = [tuple(float(x) if x else -1.0 for x in row) for row in printed]
    for oil in EXAMPLES.values():
        numbers = tuple(1e3 * eta for _, eta in oil.points) + tuple(
            1e9 * a for _, a in oil.pressure_viscosity
        )
        assert any(numbers == pytest.approx(row) for row in known), oil.name
        assert "Stachowiak" in oil.source


def test_vogel_describes_glycerol_where_arrhenius_does_not() -> None:
    rows_of = list(csv.DictReader(shared("data/tables/glycerol_water_viscosity_Segur1951.csv").open()))
    pure = rows_of[-1]
    data = [
        (273.15 + float("".join(c for c in key if c.isdigit())), 1e-3 * float(value))
        for key, value in list(pure.items())[1:]
        if value
    ]
    kelvin, eta = np.array(sorted(data)).T
    at = [0, kelvin.size // 2, kelvin.size - 1]
    vogel = Lubricant("vogel", tuple((float(kelvin[i]), float(eta[i])) for i in at))
    straight = Lubricant("arrhenius", tuple((float(kelvin[i]), float(eta[i])) for i in (at[0], at[2])))
    assert np.abs(vogel.viscosity(kelvin) / eta - 1).max() < 0.1
    assert np.abs(straight.viscosity(kelvin) / eta - 1).max() > 0.3


def test_exponents_of_drag_in_each_law() -> None:
    roll = Contact(
        roll_radius=15e-3, rubber_thickness=3.5e-3, modulus=1e6, poisson_ratio=0.48, length=0.22, load=250.0
    )
    oil = EXAMPLES["heavy machine oil"]
    for law, exponent in [
        ("isoviscous-elastic", 0.4),
        ("paper", 0.3),
        ("isoviscous-rigid", 0.0),
        ("piezoviscous-rigid", 1 / 3),
        ("piezoviscous-elastic", 0.31),
    ]:
        torque = drag_torque(roll, oil, speed=[2.0, 4.0], temperature=350.0, law=law)
        assert np.log2(torque[1] / torque[0]) == pytest.approx(exponent, abs=1e-9), law


def test_a_hundred_thousand_points_are_one_call() -> None:
    roll = Contact(
        roll_radius=15e-3, rubber_thickness=3.5e-3, modulus=1e6, poisson_ratio=0.48, length=0.22, load=250.0
    )
    speed = np.geomspace(0.1, 100.0, 100_000)
    film = film_thickness(roll, EXAMPLES["cylinder oil"], speed=speed, temperature=373.15)
    assert film.central.shape == speed.shape
    one = film_thickness(roll, EXAMPLES["cylinder oil"], speed=speed[77], temperature=373.15)
    assert film.minimum[77] == pytest.approx(float(one.minimum), rel=1e-14)
