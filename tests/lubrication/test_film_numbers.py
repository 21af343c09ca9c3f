"""Film, nip and lubricant against the same numbers computed by hand, on a roll whose two radii differ."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hersey.errors import ParameterError
from hersey.lubrication.contact import Contact, nip_width, shore_a_modulus
from hersey.lubrication.film import REGIMES, drag_torque, film_thickness, shear_heating
from hersey.lubrication.lubricant import EXAMPLES, Lubricant, ShearThinning
from hersey.lubrication.reynolds import ElasticLayer, exponent, solve_line_contact

ROLL = Contact(
    roll_radius=15e-3,
    rubber_thickness=3.5e-3,
    modulus=1.2e6,
    poisson_ratio=0.48,
    length=0.22,
    load=250.0,
    heater_radius=45e-3,
)
RADIUS = 15e-3 * 45e-3 / (15e-3 + 45e-3)
MODULUS = 2 * 1.2e6 / (1 - 0.48**2)
PER_LENGTH = 250.0 / 0.22
OIL = EXAMPLES["cylinder oil"]
GAS = 8.31446261815324


def test_radius_and_moduli_of_a_curved_heater() -> None:
    assert ROLL.reduced_radius == pytest.approx(RADIUS, rel=1e-14)
    assert ROLL.effective_modulus == pytest.approx(MODULUS, rel=1e-14)
    assert ROLL.contact_modulus == pytest.approx(MODULUS / 2, rel=1e-14)
    assert ROLL.load_per_length == pytest.approx(PER_LENGTH, rel=1e-14)
    hollow = replace(ROLL, heater_radius=-45e-3)
    assert hollow.reduced_radius == pytest.approx(15e-3 * 45e-3 / 30e-3, rel=1e-14)
    assert replace(ROLL, heater_radius=np.inf).reduced_radius == 15e-3


def test_the_nip_by_each_rule() -> None:
    hertz = 2 * np.sqrt(8 * PER_LENGTH * RADIUS / (np.pi * MODULUS))
    assert float(nip_width(ROLL, rule="hertz")) == pytest.approx(hertz, rel=1e-9)
    paper = 2.115 * (250 * RADIUS / (0.22 * MODULUS)) ** 0.32 * 3.5e-3**0.37
    assert float(nip_width(ROLL, rule="paper")) == pytest.approx(paper, rel=1e-3)
    nip = ROLL.nip
    assert float(nip_width(ROLL)) == nip.width
    assert nip.half_width == nip.width / 2
    assert nip.paper_width == float(nip_width(ROLL, rule="paper"))
    assert nip.width_over_hertz == pytest.approx(nip.width / hertz, rel=1e-9)
    assert nip.pressure_mean == pytest.approx(250 / (nip.width * 0.22), rel=1e-12)
    assert 1.2 < nip.pressure_max / nip.pressure_mean < 1.5  # parabola 1.5, ellipse 4/pi
    assert nip.strain == pytest.approx((nip.width / 2) ** 2 / (2 * RADIUS * 3.5e-3), rel=1e-12)
    assert nip.layer_factor == pytest.approx((nip.edge * np.sqrt(nip.width_over_hertz)) ** -0.8, rel=1e-12)
    # on a thick layer the half-space is near, on a thin one far
    widths = [replace(ROLL, rubber_thickness=h).nip.width_over_hertz for h in (2e-3, 3.5e-3, 14e-3)]
    assert widths == sorted(widths)
    assert widths[-1] == pytest.approx(1.0, abs=0.08)


def test_the_range_of_the_regression_is_that_of_nip_over_thickness() -> None:
    inside = [replace(ROLL, load=load).nip for load in (60.0, 90.0, 250.0)]
    shares = [nip.paper_width / 3.5e-3 for nip in inside]
    assert [nip.paper_in_range for nip in inside] == [1.0 <= share <= 4.0 for share in shares]
    assert [nip.paper_in_range for nip in inside] == [False, True, True]


def test_the_nip_of_other_loads() -> None:
    for rule in ("layer", "hertz", "paper"):
        many = nip_width(ROLL, load=[100.0, 400.0], rule=rule)
        each = [float(nip_width(ROLL.loaded(load), rule=rule)) for load in (100.0, 400.0)]
        np.testing.assert_allclose(many, each, rtol=1e-12)
        assert many[1] > many[0]
    assert ROLL.loaded(400.0).load == 400.0


def test_shore_a_by_gent() -> None:
    for hardness in (30.0, 40.0, 60.0):
        gent = 0.0981 * (56 + 7.62336 * hardness) / (0.137505 * (254 - 2.54 * hardness))
        assert shore_a_modulus(hardness) == pytest.approx(1e6 * gent, rel=1e-3)
    with pytest.raises(ParameterError, match="hardness"):
        shore_a_modulus(90.0)


@pytest.mark.parametrize("name", ["roll_radius", "rubber_thickness", "modulus", "length", "load"])
def test_contacts_that_cannot_be(name: str) -> None:
    with pytest.raises(ParameterError, match=rf"^{name} is -1: it must be greater than 0$"):
        replace(ROLL, **{name: -1.0})  # type: ignore[arg-type]


def test_roughness_and_uncertainty_of_a_contact_are_checked() -> None:
    for name in ("roughness", "nip_uncertainty"):
        with pytest.raises(ParameterError, match=rf"^{name} is 0: it must be greater than 0$"):
            replace(ROLL, **{name: 0.0})  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match="it must be less than roll_radius"):
        replace(ROLL, rubber_thickness=15e-3)


def test_films_of_all_laws() -> None:
    speed, kelvin = 4.0, 373.15
    eta, alpha, u = 26.8e-3, 22e-9, 0.5 * 4.0 * 15e-3
    film = film_thickness(ROLL, OIL, speed=speed, temperature=kelvin)
    assert float(film.viscosity) == pytest.approx(eta, rel=1e-9)
    assert float(film.entrainment_speed) == pytest.approx(u, rel=1e-14)
    viscous, load, thick = eta * u / (MODULUS * RADIUS), PER_LENGTH / (MODULUS * RADIUS), alpha * MODULUS
    soft = ROLL.nip.layer_factor * RADIUS * viscous**0.6 * load**-0.2
    least = {
        "isoviscous-rigid": 4.9 * RADIUS * viscous / load,
        "piezoviscous-rigid": 1.66 * RADIUS * (thick * viscous) ** (2 / 3),
        "isoviscous-elastic": 3.1 * soft,
        "piezoviscous-elastic": 2.65 * RADIUS * viscous**0.7 * thick**0.54 * load**-0.13,
    }
    centre = least | {
        "isoviscous-elastic": 3.78 * soft,
        "piezoviscous-elastic": 3.06 * RADIUS * viscous**0.69 * thick**0.56 * load**-0.10,
    }
    eq_5 = 1.6 * alpha**0.6 * RADIUS**0.43 * MODULUS**0.03 * (eta * u) ** 0.7 * PER_LENGTH**-0.13
    for name, expected in least.items():
        assert float(film.minima[name]) == pytest.approx(expected, rel=1e-9), name
        assert float(film.centres[name]) == pytest.approx(centre[name], rel=1e-9), name
    assert float(film.minima["paper"]) == float(film.centres["paper"]) == pytest.approx(eq_5, rel=1e-9)
    assert film.regime_names() == ["isoviscous-elastic"]
    assert float(film.minimum) == float(film.minima["isoviscous-elastic"])
    assert float(film.central) == float(film.centres["isoviscous-elastic"])
    assert float(film.g_v) == pytest.approx(thick * load**1.5 / viscous**0.5, rel=1e-9)
    assert float(film.g_e) == pytest.approx(load / viscous**0.5, rel=1e-9)
    assert film.corrections == {}
    assert float(film.factor) == 1.0


def test_a_roll_turns_either_way_but_not_through_the_film() -> None:
    ways = film_thickness(ROLL, OIL, speed=[4.0, -4.0], temperature=373.15)
    assert ways.minimum[0] == ways.minimum[1]
    assert ways.speed.tolist() == [4.0, 4.0]


def test_without_a_coefficient_pressure_thickens_nothing() -> None:
    film = film_thickness(ROLL, replace(OIL, pressure_viscosity=()), speed=4.0, temperature=373.15)
    assert "paper" not in film.minima
    assert float(film.g_v) == 0.0
    with pytest.raises(ParameterError, match="'piezoviscous-rigid' needs the pressure-viscosity coefficient"):
        drag_torque(
            ROLL,
            replace(OIL, pressure_viscosity=()),
            speed=4.0,
            temperature=373.15,
            law="piezoviscous-rigid",
        )


def test_the_inlet_is_short_up_to_a_quarter() -> None:
    """(eta u E*^2/K^3)^0.4 with K = edge E*/(2R) sqrt(2a), against layer and half-width."""
    nip, star = ROLL.nip, MODULUS / 2
    k = nip.edge * star / (2 * RADIUS) * np.sqrt(nip.width)
    least = min(3.5e-3, nip.width / 2)
    speeds = np.geomspace(0.1, 4000.0, 60)
    film = film_thickness(ROLL, OIL, speed=speeds, temperature=320.0)
    length = (film.viscosity * 0.5 * speeds * 15e-3 * star**2 / k**3) ** 0.4
    assert film.inlet_short.tolist() == (length < 0.25 * least).tolist()
    assert 0 < film.inlet_short.sum() < speeds.size


def test_each_correction_by_hand() -> None:
    thinning = ShearThinning(relaxation_time=2e-6, exponent=0.6, limit=0.1)
    oil = replace(OIL, thinning=thinning, conductivity=0.13)
    film = film_thickness(ROLL, oil, speed=40.0, temperature=373.15, supply=3e-6, starvation_sharpness=4.0)
    u, eta, centre = 0.5 * 40.0 * 15e-3, 26.8e-3, float(film.central)
    assert float(film.viscosity) == pytest.approx(eta, rel=1e-9)  # unsheared
    fall = -float(OIL.temperature_exponent(373.15)) / 373.15
    rolling = 3.94 / (3.94 + (eta * fall * u**2 / 0.13) ** 0.62)
    heating = film.corrections["inlet heating"]
    assert float(heating.factor) == pytest.approx(rolling, rel=1e-9)
    assert bool(heating.valid) == (rolling > 0.99)
    share = 3e-6 / centre
    starved = share / (1 + share**4) ** 0.25
    assert float(film.corrections["starvation"].factor) == pytest.approx(starved, rel=1e-9)
    thin = float(film.corrections["shear thinning"].factor)
    left = 0.1 + 0.9 * (1 + (2e-6 * 2 * u / (thin * centre)) ** 2) ** (-0.2)
    assert thin == pytest.approx(left**0.6, rel=1e-9)  # the soft film goes as eta^0.6
    assert bool(film.corrections["shear thinning"].valid) == (left > 0.5)
    assert float(film.factor) == pytest.approx(rolling * starved * thin, rel=1e-12)
    expected = float(film.minimum) * rolling * starved * thin / 1.5e-6
    assert float(film.lambda_ratio(1.5e-6)) == pytest.approx(expected, rel=1e-12)


def test_a_blunter_corner_starves_more() -> None:
    at = {"speed": 8.0, "temperature": 373.15, "supply": 3e-6}
    usual = film_thickness(ROLL, OIL, **at)  # type: ignore[arg-type]
    share = 3e-6 / float(usual.central)
    assert float(usual.factor) == pytest.approx(share / (1 + share**3) ** (1 / 3), rel=1e-9)


def test_torque_is_stress_times_nip_times_arm_and_a_rolling_part() -> None:
    thinning = ShearThinning(relaxation_time=2e-6, exponent=0.6)
    oil = replace(OIL, thinning=thinning, conductivity=0.13)
    speed, belt, width = 40.0, 40.0 * 15e-3, ROLL.nip.width
    film = film_thickness(ROLL, oil, speed=speed, temperature=373.15, supply=3e-6)
    thickness = float(film.central * film.factor)
    rate = belt / thickness
    eta = 26.8e-3 * (1 + (2e-6 * rate) ** 2) ** -0.2
    torque = drag_torque(ROLL, oil, speed=speed, temperature=373.15, supply=3e-6)
    flooded = film_thickness(ROLL, OIL, speed=speed, temperature=373.15)
    starved, others = (
        np.prod([float(c.factor) for name, c in film.corrections.items() if (name == "starvation") == one])
        for one in (True, False)
    )
    shear = eta * rate * width * 0.22 * 15e-3 * float(flooded.shear_factor)
    rolling = float(flooded.rolling) * starved**3 * others ** (4 / 3)
    assert float(film.shear) == pytest.approx(shear, rel=1e-9)
    assert float(film.rolling) == pytest.approx(rolling, rel=1e-9)
    assert float(torque) == pytest.approx(shear + rolling, rel=1e-9)
    # one regime alone: its film, uncorrected and unsheared
    for law in ("isoviscous-elastic", "piezoviscous-elastic"):
        alone = drag_torque(ROLL, oil, speed=speed, temperature=373.15, supply=3e-6, law=law)
        by_hand = 26.8e-3 * belt / float(film.centres[law]) * width * 0.22 * 15e-3
        assert float(alone) == pytest.approx(by_hand, rel=1e-9)


#: eta (Pa s), belt speed (m/s), load (N), E (Pa), R (m), rubber (m), nu: corners and middle of fusers.
FUSERS = [
    (0.017, 0.05, 300.0, 1e6, 15e-3, 3.5e-3, 0.48),
    (0.017, 0.4, 150.0, 0.5e6, 10e-3, 2e-3, 0.45),
    (0.017, 0.4, 400.0, 2e6, 20e-3, 5e-3, 0.5),
    (0.05, 0.1, 200.0, 0.7e6, 12e-3, 4e-3, 0.49),
    (0.1, 0.02, 250.0, 1e6, 15e-3, 3.5e-3, 0.48),
    (0.1, 0.2, 400.0, 0.5e6, 15e-3, 2e-3, 0.49),
    (0.3, 0.3, 300.0, 1e6, 15e-3, 3.5e-3, 0.48),
    (0.3, 0.05, 150.0, 2e6, 20e-3, 5e-3, 0.45),
    (1.0, 0.1, 350.0, 1.5e6, 18e-3, 2.5e-3, 0.5),
    (1.0, 0.4, 200.0, 0.6e6, 10e-3, 3e-3, 0.47),
    (3.0, 0.02, 300.0, 1e6, 15e-3, 3.5e-3, 0.48),
    (3.0, 0.4, 400.0, 0.5e6, 20e-3, 5e-3, 0.5),
]


@pytest.mark.parametrize("case", FUSERS)
def test_torque_is_the_integral_of_the_numerical_solution(case: tuple[float, ...]) -> None:
    eta, belt, load, modulus, radius, rubber, nu = case
    roll = Contact(
        roll_radius=radius, rubber_thickness=rubber, modulus=modulus, poisson_ratio=nu, length=0.22, load=load
    )
    oil = Lubricant("arrhenius", ((399.0, 1.001 * eta), (400.0, eta)), name="oil")
    near = film_thickness(roll, oil, speed=belt / radius * np.array([1.0, 1.01]), temperature=400.0)
    solved = solve_line_contact(
        radius,
        load / 0.22,
        0.5 * belt,
        eta,
        effective_modulus=roll.effective_modulus,
        layer=ElasticLayer(rubber, nu),
    )
    arm = 0.22 * radius
    # 201 nodes leave the solver's own shear up to 1 % off where the film is thinnest
    off = 0.01 + 0.3 * solved.grid_error
    assert near.torque[0] == pytest.approx(-solved.roll_traction * arm, rel=off)
    assert near.rolling[0] == pytest.approx(solved.poiseuille * arm, rel=0.03)
    slope = np.log(near.torque[1] / near.torque[0]) / np.log(1.01)
    assert slope == pytest.approx(exponent("torque", solved), abs=0.01)
    assert near.inlet_short.all()


def test_other_regimes_are_sheared_only() -> None:
    hard = replace(ROLL, modulus=2e11, poisson_ratio=0.3)
    film = film_thickness(hard, OIL, speed=8.0, temperature=373.15)
    assert film.regime_names() != ["isoviscous-elastic"]
    assert float(film.rolling) == 0.0
    by_hand = 26.8e-3 * 8.0 * 15e-3 / float(film.central) * hard.nip.width * 0.22 * 15e-3
    assert float(film.torque) == pytest.approx(by_hand, rel=1e-9)


def test_torque_by_the_paper() -> None:
    eta, alpha, u = 26.8e-3, 22e-9, 0.5 * 4.0 * 15e-3
    torque = drag_torque(ROLL, OIL, speed=-4.0, temperature=373.15, law="paper")
    expected = (
        2.644
        * alpha**-0.6
        * (eta * u) ** 0.3
        * 250**0.45
        * 0.22**0.55
        * 3.5e-3**0.37
        * RADIUS**0.89
        * MODULUS**-0.35
    )
    assert float(torque) == pytest.approx(expected, rel=1e-3)


def test_shear_warms_by_eta_u2_over_8k() -> None:
    oil = replace(OIL, conductivity=0.13)
    rise = shear_heating(oil, sliding_speed=[1.0, 2.0], temperature=373.15)
    np.testing.assert_allclose(rise, [26.8e-3 / (8 * 0.13), 4 * 26.8e-3 / (8 * 0.13)], rtol=1e-9)
    with pytest.raises(ParameterError, match="thermal conductivity of cylinder oil is missing"):
        shear_heating(OIL, sliding_speed=1.0, temperature=373.15)


def test_arrhenius_through_two_points() -> None:
    oil = Lubricant("arrhenius", ((320.0, 0.1), (380.0, 0.02)))
    energy = GAS * np.log(0.1 / 0.02) / (1 / 320 - 1 / 380)
    at = np.array([300.0, 350.0, 420.0])
    np.testing.assert_allclose(oil.viscosity(at), 0.1 * np.exp(energy / GAS * (1 / at - 1 / 320)), rtol=1e-9)
    np.testing.assert_allclose(oil.activation_energy(at), energy, rtol=1e-9)
    np.testing.assert_allclose(oil.temperature_exponent(at), -energy / (GAS * at), rtol=1e-9)
    assert oil.temperature_range == (320.0, 380.0)


def test_walther_is_a_law_of_kinematic_viscosity() -> None:
    oil = Lubricant("walther", ((313.15, 0.5 * 0.9), (373.15, 0.047 * 0.9)), density=900.0)
    cst = np.array([500.0, 47.0])
    w = np.log10(np.log10(cst + 0.7))
    slope = (w[0] - w[1]) / np.log10(373.15 / 313.15)
    middle = 10**10 ** (w[0] - slope * np.log10(343.15 / 313.15)) - 0.7
    assert float(oil.viscosity(343.15)) == pytest.approx(1e-6 * middle * 900.0, rel=1e-6)
    step = 1.0 + np.array([-1e-5, 1e-5])
    numeric = np.diff(np.log(oil.viscosity(343.15 * step)))[0] / np.diff(np.log(step))[0]
    assert float(oil.temperature_exponent(343.15)) == pytest.approx(numeric, rel=1e-6)


def test_alpha_is_joined_by_straight_lines_and_held() -> None:
    oil = replace(OIL, pressure_viscosity=((300.0, 30e-9), (400.0, 20e-9)))
    np.testing.assert_allclose(
        oil.alpha([280.0, 300.0, 325.0, 400.0, 450.0]), [30e-9, 30e-9, 27.5e-9, 20e-9, 20e-9], rtol=1e-12
    )
    with pytest.raises(ParameterError, match=r"coefficient of cylinder oil is missing. Give it"):
        replace(OIL, pressure_viscosity=()).alpha(300.0)
    for wrong in (((400.0, 2e-8), (300.0, 3e-8)), ((300.0, 2e-8), (300.0, 3e-8)), ((300.0, -1e-9),)):
        with pytest.raises(ParameterError, match="must not be negative, and their temperatures must ascend"):
            replace(OIL, pressure_viscosity=wrong)


def test_carreau_by_hand() -> None:
    thinning = ShearThinning(relaxation_time=1e-5, exponent=0.4, limit=0.2)
    rate = np.array([0.0, 1e5, 1e7])
    expected = 0.2 + 0.8 * (1 + (1e-5 * rate) ** 2) ** (-0.3)
    np.testing.assert_allclose(thinning.share(rate), expected, rtol=1e-12)
    oil = replace(OIL, thinning=thinning)
    np.testing.assert_allclose(oil.viscosity(373.15, rate), 26.8e-3 * expected, rtol=1e-9)
    np.testing.assert_allclose(OIL.viscosity(373.15, rate), 26.8e-3, rtol=1e-9)
    assert float(oil.viscosity(373.15)) == pytest.approx(26.8e-3, rel=1e-9)


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"model": "andrade"}, "unknown viscosity model 'andrade'"),
        ({"points": ((300.0, 0.1), (320.0, 0.05))}, "'vogel' needs 3 points, but 2 are given"),
        ({"density": 0.0}, "must be greater than 0; one is 0"),
        ({"conductivity": -1.0}, "must be greater than 0; one is -1"),
        ({"uncertainty": -0.2}, "must be greater than 0; one is -0.2"),
    ],
)
def test_lubricants_that_cannot_be(changed: dict[str, object], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        replace(OIL, **changed)  # type: ignore[arg-type]


def test_a_film_over_a_grid_has_the_shape_of_the_grid() -> None:
    film = film_thickness(ROLL, OIL, speed=[[1.0], [4.0], [9.0]], temperature=[330.0, 373.15])
    assert film.minimum.shape == (3, 2)
    one = film_thickness(ROLL, OIL, speed=4.0, temperature=330.0)
    assert float(film.minimum[1, 0]) == pytest.approx(float(one.minimum), rel=1e-12)
    assert float(film.temperature[2, 1]) == 373.15
    assert float(film.speed[2, 0]) == 9.0


def test_the_oils_of_the_table() -> None:
    """Stachowiak and Batchelor, Engineering Tribology, Table 2.3: mPa s, 1e-9/Pa at 30, 60 and 100 degC."""
    table = {
        "spindle oil": ((18.6, 6.3, 2.4), (20.0, 16.0, 13.0)),
        "light machine oil": ((45.0, 12.0, 3.9), (28.0, 20.0, 16.0)),
        "heavy machine oil": ((153.0, 34.0, 9.1), (23.7, 20.5, 15.8)),
        "cylinder oil": ((810.0, 135.0, 26.8), (34.0, 28.0, 22.0)),
    }
    assert set(EXAMPLES) == set(table)
    for name, (viscosities, alphas) in table.items():
        oil = EXAMPLES[name]
        for celsius, eta, alpha in zip((30.0, 60.0, 100.0), viscosities, alphas, strict=True):
            assert float(oil.viscosity(celsius + 273.15)) == pytest.approx(1e-3 * eta, rel=1e-9)
            assert float(oil.alpha(celsius + 273.15)) == pytest.approx(1e-9 * alpha, rel=1e-9)


@pytest.mark.parametrize(("rubber", "eta", "thin"), [(3.5e-3, 0.05, False), (0.6e-3, 3.0, True)])
def test_the_inlet_s_share_of_the_shear_by_hand(rubber: float, eta: float, thin: bool) -> None:
    """By the fit of the solver's results, whose inlet is at most a quarter of nip or layer."""
    roll = replace(ROLL, rubber_thickness=rubber)
    oil = Lubricant("arrhenius", ((399.0, 1.001 * eta), (400.0, eta)), name="oil")
    film = film_thickness(roll, oil, speed=20.0, temperature=400.0)
    half, modulus = roll.nip.half_width, MODULUS / 2
    edge = roll.nip.edge * modulus / (2 * RADIUS) * np.sqrt(2 * half)
    inlet = (eta * 0.5 * 20.0 * 15e-3 * modulus**2 / edge**3) ** 0.4 / half
    short = min(inlet, 0.25 * min(rubber / half, 1.0))
    assert (inlet > short) == thin
    bend = roll.nip.curvature + 0.25
    assert bend > 0.05
    by_hand = 1.0 + short * (0.339 + 0.455 * short + bend * max(2.427 - 6.026 * short, 0.0))
    assert float(film.shear_factor) == pytest.approx(by_hand, rel=1e-9)


def test_a_rigid_film_that_pressure_thickens_has_a_regime_by_hand() -> None:
    """Greenwood's chart: rigid while g_E^2 is less than pi/4 of the thicker of the two rigid films."""
    steel = replace(ROLL, modulus=2e11, poisson_ratio=0.3, load=5000.0)
    oil = Lubricant(
        "arrhenius", ((399.0, 0.1001), (400.0, 0.1)), name="oil", pressure_viscosity=((400.0, 3e-8),)
    )
    speeds = np.geomspace(1.0, 1e5, 60)
    film = film_thickness(steel, oil, speed=speeds, temperature=400.0)
    modulus = 2 * 2e11 / (1 - 0.3**2)
    u, w = 0.1 * 0.5 * speeds * 15e-3 / (modulus * RADIUS), 5000.0 / 0.22 / (modulus * RADIUS)
    g_v, g_e = 3e-8 * modulus * w**1.5 / np.sqrt(u), w / np.sqrt(u)
    blok = 1.66 * g_v ** (2 / 3)
    rigid = g_e**2 < np.pi / 4 * np.maximum(4.9, blok)
    thick = np.where(rigid, blok, 2.65 * g_v**0.54 * g_e**0.06)
    names = np.where(rigid, "piezoviscous-rigid", "piezoviscous-elastic")
    piezo = thick > np.maximum(4.9, 3.10 * steel.nip.layer_factor * g_e**0.8)
    assert np.count_nonzero(piezo & rigid & (g_e**2 > np.pi / 4 * 4.9)) > 3
    regimes = [REGIMES[k] for k in film.regime]
    assert [regimes[i] for i in np.flatnonzero(piezo)] == names[piezo].tolist()
