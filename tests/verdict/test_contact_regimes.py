"""The band of a contact's own soft film, and logs that its film made."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import hersey
from hersey.lubrication.contact import Contact
from hersey.lubrication.lubricant import Lubricant
from hersey.lubrication.reynolds import ElasticLayer, exponent, solve_line_contact
from hersey.verdict.contact_regimes import contact_regimes, damping_exponent, thermal_exponent
from hersey.verdict.regimes import REGIMES

ROLL = Contact(
    roll_radius=15e-3, rubber_thickness=3.5e-3, modulus=0.6e6, poisson_ratio=0.48, length=0.22, load=300.0
)
STARVED = replace(ROLL, supply=1.5e-5)
OIL = Lubricant("arrhenius", ((313.15, 0.5), (453.15, 0.019)), conductivity=0.1)
SPEED, KELVIN = (
    grid.ravel() for grid in np.meshgrid(np.geomspace(1.4, 27.0, 8), [333.15, 373.15, 413.15, 453.15])
)


def test_the_band_is_the_range_of_the_solver_over_the_dwells() -> None:
    (soft,) = (
        row for row in contact_regimes(ROLL, OIL, speed=SPEED, temperature=KELVIN) if row.name == "soft EHL"
    )
    solved = [
        exponent(
            "damping",
            solve_line_contact(
                15e-3,
                ROLL.load_per_length,
                0.5 * speed * 15e-3,
                float(OIL.viscosity(kelvin)),
                effective_modulus=ROLL.effective_modulus,
                layer=ElasticLayer(3.5e-3, 0.48),
                nodes=401,
            ),
        )
        for speed, kelvin in ((SPEED.min(), 453.15), (SPEED.max(), 333.15))
    ]
    assert soft.low == pytest.approx(solved[0], abs=0.01)
    assert soft.high == pytest.approx(solved[1], abs=0.01)


def test_a_starved_film_has_a_band_of_its_own() -> None:
    rows = {row.name: row for row in contact_regimes(STARVED, OIL, speed=SPEED, temperature=KELVIN)}
    flooded = {row.name: row for row in contact_regimes(ROLL, OIL, speed=SPEED, temperature=KELVIN)}
    assert "partly starved soft film" not in flooded
    starved = rows["partly starved soft film"]
    assert rows["soft EHL"].low == flooded["soft EHL"].low
    # thick films starve first: they lose their growth with speed, thin ones are as they were
    assert starved.low == pytest.approx(flooded["soft EHL"].low, abs=0.01)
    assert starved.high > flooded["soft EHL"].high + 0.2
    assert starved.film == "isoviscous-elastic"
    assert rows["soft EHL"].film == ""


def test_a_hard_contact_keeps_the_table() -> None:
    steel = replace(ROLL, modulus=2e11, poisson_ratio=0.3)
    assert contact_regimes(steel, OIL, speed=SPEED, temperature=KELVIN) == REGIMES


def test_heat_through_the_film_moves_its_exponents() -> None:
    at = np.array([8.0]), np.array([413.15])
    warm = replace(ROLL, heat_flow=1500.0, sensor_side="heater")
    # a thicker film is colder under the heater, so torque grows more steeply with speed
    assert damping_exponent(warm, OIL, *at)[0] > damping_exponent(ROLL, OIL, *at)[0] + 0.01
    assert thermal_exponent(ROLL, OIL, *at)[0] == pytest.approx(
        float(OIL.temperature_exponent(413.15)) * (1 + damping_exponent(ROLL, OIL, *at)[0]), rel=1e-3
    )


def seen(made_by: Contact, seed: int, constant: float = 0.0) -> hersey.Regime:
    """What is said of a log of the film's own torque, read with 1 %, of a contact that is known."""
    torque = hersey.drag_torque(made_by, OIL, speed=SPEED, temperature=KELVIN)
    torque = torque + constant * np.median(torque)
    noise = 0.01 * np.random.default_rng(seed).standard_normal(SPEED.size)
    points = hersey.SteadyPoints.from_table(
        {
            "speed [rad/s]": SPEED,
            "temperature [degC]": KELVIN - 273.15,
            "torque [N*m]": torque * np.exp(noise),
        }
    )
    surface = hersey.fit(points, temperature_scale="K")
    return hersey.regime(points, surface, contact=made_by, lubricant=OIL)


@pytest.mark.parametrize("made_by", [ROLL, STARVED])
def test_a_log_of_the_own_film_does_not_exclude_it(made_by: Contact) -> None:
    name = "soft EHL" if made_by.supply is None else "partly starved soft film"
    found = seen(made_by, seed=3)
    assert name in [e.key for e in found.explanations]
    assert "Dowson-Higginson EHL" not in [e.key for e in found.explanations]
    assert "as predicted for this contact" in found.verdict


def test_a_constant_torque_beside_the_own_film_is_seen() -> None:
    keys = [e.key for e in seen(ROLL, seed=3, constant=0.33).explanations]
    assert "soft EHL" not in keys
    assert "soft EHL + constant torque" in keys
