"""Mixed lubrication of a nip: limits, an independent solution, the shift with temperature, and bad input."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

import hersey
from hersey import _core
from hersey.errors import ParameterError
from hersey.lubrication.asperities import Asperities, BoundaryFriction
from hersey.lubrication.mixed import MixedContact, mixed_contact, mixed_torque
from hersey.machine.machine import read_machine
from tests.lubrication.roll import OIL, ROLL, WARM
from tests.lubrication.soft_law import solved


def mixed(friction: Any = 0.1, **changed: Any) -> MixedContact:
    return mixed_contact(
        ROLL, OIL, Asperities(modulus="50 GPa"), friction, **{"speed": 4.0, "temperature": WARM, **changed}
    )


def test_a_thick_film_carries_all() -> None:
    """With the film's own inlet and pressure, lambda 5 to 40; also from a film 30 times as viscous."""
    speed = np.geomspace(5.0, 150.0, 9)
    alone = hersey.drag_torque(ROLL, OIL, speed=speed, temperature=WARM)
    for law in (mixed(), mixed(temperature=303.15)):
        film = law.at(speed=speed, temperature=WARM)
        assert np.all(film.lambda_ratio > 5)
        assert film.torque == pytest.approx(alone, rel=3e-3)
        assert film.share == pytest.approx(0.0, abs=1e-5)
    assert film.rolling_torque[0] / alone[0] == pytest.approx(0.05, abs=0.01)


def test_near_rest_asperities_carry_all() -> None:
    film = mixed().at(speed=[0.0, 1e-3], temperature=WARM)
    assert film.torque == pytest.approx(0.1 * 300.0 * 15e-3, rel=5e-3)
    assert film.share == pytest.approx(1.0, abs=5e-3)


def test_two_rough_faces_press_as_their_summits_do() -> None:
    """Summits of radius beta meet, aside by r, as spheres of beta/2: Hertz's force over all r."""

    def by_radius(r: float) -> float:
        return 2 * np.pi * r * 4 / 3 * 0.5**0.5 * (1.0 - r * r / 4) ** 1.5

    force, _ = quad(by_radius, 0.0, 2.0)
    assert pytest.approx(force, rel=1e-9) == _core.GREENWOOD_TRIPP


@pytest.mark.parametrize("speed", [0.3, 0.6, 1.2, 2.5])
def test_torque_by_an_independent_solution(speed: float) -> None:
    """From the law as it is written in ``docs/theory/mixed.md``, with adaptive quadrature and a bracket."""
    film = hersey.film_thickness(ROLL, OIL, speed=speed, temperature=WARM)
    nip, radius = film.nip, ROLL.reduced_radius
    modulus = 0.6e6 / (1 - 0.48**2)
    pressure = 16 * np.sqrt(2) * np.pi / 15 * 0.05**2 * 0.1 * 50e9
    # Of a layer: the film falls with K as K^-0.8, and that of a half-space has K = E*/(2R) sqrt(2a)
    half_space = np.sqrt(4 * (300 / 0.22) * radius / (np.pi * modulus))
    slope = modulus / (2 * radius) * np.sqrt(2 * half_space) * nip.layer_factor**-1.25
    inlet = (float(film.viscosity) * speed * 15e-3 / 2 * modulus**2 / slope**3) ** 0.4
    ratio, share = solved(
        float(film.central) / 0.4e-6,
        nip.pressure_mean / (slope * np.sqrt(inlet)),
        pressure / nip.pressure_mean,
        slope**2 * nip.half_width / (2 * nip.pressure_max**2),
    )
    sheared = float(film.viscosity) * speed * 15e-3 / (ratio * 0.4e-6) * film.nip.width * 0.22
    law = mixed()
    beyond = law.rolling * (float(film.viscosity) * speed * 15e-3 / law.reference) ** law.rolling_exponent
    expected = 15e-3 * (30.0 * share + sheared + beyond * (1 - share))
    assert mixed_torque(law, speed=speed, temperature=WARM) == pytest.approx(expected, rel=1e-8)


def test_the_law_is_the_same_from_every_point() -> None:
    one, other = mixed(), mixed(speed=0.2, temperature=400.0)
    assert one.regime == "isoviscous-elastic"
    assert one.reference == pytest.approx(other.reference, rel=1e-12)
    assert one.shear == pytest.approx(other.shear, rel=1e-12)


def test_the_transition_is_where_torque_is_least() -> None:
    law = mixed()
    turn = law.transition(WARM)
    speeds = float(turn.speed) * np.array([0.97, 0.99, 1.0, 1.01, 1.03])
    torque = law.at(speed=speeds, temperature=WARM).torque
    assert np.argmin(torque) == 2
    assert torque[2] == pytest.approx(float(turn.torque), rel=1e-12)


def test_the_transition_moves_as_viscosity_does() -> None:
    turn = mixed().transition([350.0, 373.15, 400.0])
    viscosity = OIL.viscosity([350.0, 373.15, 400.0])
    assert turn.product == pytest.approx(float(turn.product[0]), rel=1e-12)
    assert turn.belt_speed * viscosity == pytest.approx(turn.product, rel=1e-14)
    assert turn.speed * 15e-3 == pytest.approx(turn.belt_speed, rel=1e-14)


def test_boundary_friction_may_change_with_temperature() -> None:
    falling = BoundaryFriction(0.1, slope=-5e-6, temperature="100 degC")
    turn = mixed(falling).transition([WARM, WARM + 20.0])
    shift = np.log(turn.product[1] / turn.product[0]) / np.log(0.0999 / 0.1)
    assert shift == pytest.approx(float(turn.sensitivity["boundary"][0]), rel=1e-3)
    rest = mixed(falling).at(speed=0.0, temperature=WARM + 20.0)
    assert rest.torque == pytest.approx(0.0999 * 300 * 15e-3, rel=1e-9)


def test_a_drag_that_never_falls_says_so() -> None:
    law = mixed(1e-4)
    assert np.isnan(law.transition(WARM).speed)
    assert "nowhere" in law.at(speed=1.0, temperature=WARM).summary()


def test_the_result_answers() -> None:
    film = mixed().at(speed=["1 rad/s", "4 rad/s"], temperature="100 degC")
    assert "asperities" in film.headline()
    assert "isoviscous-elastic" in film.summary()
    plain = film.to_dict()
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    assert plain["points"]["torque"] == pytest.approx(film.torque)
    frame = film.to_frame()
    parts = [f"{name} torque (N m)" for name in ("boundary", "shear", "rolling")]
    assert sum(frame[name].to_numpy() for name in parts) == pytest.approx(film.torque)
    assert frame["transition speed (rad/s)"].to_list() == pytest.approx(film.transition.speed.tolist())


#: The full solution of the contact of examples/machine.toml: eta U (Pa m), lambda, the least film over
#: roughness and the share of the asperities, on 3292 nodes (benchmarks/MIXED.md).
FULL = [
    (8.200e-4, 3.225606, 2.576436, 0.000211),
    (2.595e-4, 1.691735, 1.458735, 0.036900),
    (8.209e-5, 1.144329, 1.034702, 0.154642),
    (2.597e-5, 0.848632, 0.768245, 0.302707),
]


@pytest.mark.parametrize(("product", "ratio", "least", "share"), FULL)
def test_the_full_solution_of_the_contact_agrees(
    product: float, ratio: float, least: float, share: float
) -> None:
    """Lambda within 1 %, the least film within 3 %, the share within 0.005 of the load."""
    machine = read_machine(Path(__file__).parents[2] / "examples/machine.toml")
    assert machine.mixed is not None
    kelvin = 453.15
    viscosity = float(machine.mixed.lubricant.viscosity(kelvin))
    film = machine.mixed.at(speed=product / viscosity / 15e-3, temperature=kelvin)
    assert float(film.lambda_ratio) == pytest.approx(ratio, rel=0.01)
    assert float(film.minimum_ratio) == pytest.approx(least, rel=0.03)
    assert float(film.share) == pytest.approx(share, abs=0.005)
    assert not film.beyond_checked_range


def test_points_beyond_the_checked_range_are_marked() -> None:
    film = mixed().at(speed=1.0, temperature=WARM)
    assert film.beyond_checked_range  # summits of 50 GPa press with 400 times the pressure of the nip
    soft = mixed_contact(ROLL, OIL, Asperities(modulus=2e9), 0.1, speed=4.0, temperature=WARM)
    film = soft.at(speed=[0.001, 0.5, 5e3], temperature=WARM)
    assert film.share[0] > 0.5
    assert film.beyond_checked_range.tolist() == [True, False, True]  # most of the load; -; a long inlet
    assert film.to_dict()["points"]["beyond_checked_range"] == [True, False, True]
    assert "2 of 3 points" in film.summary()


def test_roughness_moves_the_transition_as_said() -> None:
    """By the whole law at other roughness, its summits of one shape."""
    ends = [
        mixed_contact(
            replace(ROLL, roughness=0.4e-6 * factor),
            OIL,
            Asperities(modulus=5e9),
            0.1,
            speed=4,
            temperature=WARM,
        ).transition(WARM)
        for factor in (0.999, 1.0, 1.001)
    ]
    power = np.log(ends[2].product / ends[0].product) / np.log(1.001 / 0.999)
    assert float(power) == pytest.approx(float(ends[1].by_roughness), rel=1e-4)


def test_hard_nips_take_the_law_of_the_hard_film() -> None:
    law = mixed(regime="piezoviscous-elastic")
    assert (law.film_exponent, law.load_exponent, law.edge) == (0.7, 0.13, 0.0)
    film = law.at(speed=[0.01, 1e3], temperature=WARM)
    assert film.beyond_checked_range.tolist() == [True, False]
    assert film.to_dict()["points"]["minimum_ratio"] == [None, None]


def test_the_law_of_hard_nips_is_checked_up_to_a_tenth_of_the_load() -> None:
    law = mixed(regime="piezoviscous-elastic")
    shares = np.array([0.099, 0.101, 0.4])
    assert law.beyond_checked_range(shares, np.full(3, 1.0)).tolist() == [False, True, True]


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (
            lambda: mixed_contact(replace(ROLL, roughness=None), OIL, STEEL, 0.1, speed=1, temperature=WARM),
            "roughness",
        ),
        (lambda: mixed(regime="soft"), "isoviscous-elastic"),
        (
            lambda: mixed_contact(
                ROLL,
                replace(OIL, pressure_viscosity=()),
                STEEL,
                0.1,
                speed=1,
                temperature=WARM,
                regime="piezoviscous-elastic",
            ),
            "pressure-viscosity",
        ),
        (
            lambda: mixed_contact(ROLL, OIL, Asperities(modulus=1e6), 0.1, speed=1, temperature=WARM),
            "softer nip",
        ),
        (lambda: mixed(0.0), "boundary friction"),
        (lambda: mixed(float("nan")), "friction is NaN"),
        (lambda: mixed(speed=0.0), "entrainment speed"),
        (lambda: BoundaryFriction(0.1, slope=-1e-3), "temperature"),
        (lambda: BoundaryFriction(0.1, slope=-1e-3, temperature=WARM).at(500.0), "226.9 degC"),
        (lambda: Asperities(modulus=0.0), "modulus"),
        (lambda: Asperities(modulus=5e10, sigma_over_beta=float("inf")), "sigma_over_beta"),
        (lambda: mixed().at(speed=float("inf"), temperature=WARM), "speed"),
        (lambda: mixed().at(speed=1.0, temperature=-1.0), "temperature"),
    ],
)
def test_what_cannot_be_is_refused(make: Any, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        make()


STEEL = Asperities(modulus=1e11)


def test_what_warming_does_to_viscosity_and_boundary_friction() -> None:
    """Slopes of logarithms: of the oil by differences, of 0.1 + 2e-4/K (T - 373.15 K) by hand."""
    law = mixed(BoundaryFriction(0.1, 2e-4, WARM))
    of_viscosity, of_friction = law.warming(np.array([WARM, WARM + 20.0]))
    for kelvin, found in zip((WARM, WARM + 20.0), of_viscosity, strict=True):
        warm, cold = (float(OIL.viscosity(kelvin + step)) for step in (0.01, -0.01))
        assert found == pytest.approx(np.log(warm / cold) / 0.02, rel=1e-6)
    assert of_friction == pytest.approx([2e-4 / 0.1, 2e-4 / 0.104], rel=1e-12)
