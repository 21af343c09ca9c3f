"""The temperature of a film that heat flows through, against cases by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hersey.errors import ParameterError
from hersey.lubrication.contact import Contact
from hersey.lubrication.film import film_thickness
from hersey.lubrication.film_temperature import film_temperature
from hersey.lubrication.lubricant import Lubricant

OIL = Lubricant("arrhenius", ((313.15, 0.12), (453.15, 0.019)), conductivity=0.1)
BARE = Contact(
    roll_radius=15e-3, rubber_thickness=3.5e-3, modulus=1e6, poisson_ratio=0.48, length=0.22, load=250.0
)
#: The same contact on as much length as gives 15 cm^2 of nip.
LENGTH = 1.5e-3 / BARE.nip.width
WARM = replace(BARE, length=LENGTH, load=250.0 * LENGTH / 0.22, heat_flow=600.0, sensor_side="heater")


@pytest.mark.parametrize(("side", "sign"), [("heater", 1.0), ("roll", -1.0)])
def test_600_watts_through_2_5_micrometres_drop_10_kelvin(side: str, sign: float) -> None:
    kelvin = 440.0
    at_one = film_thickness(WARM, OIL, speed=1.0, temperature=kelvin)
    speed = (2.5e-6 / float(at_one.central)) ** (1 / 0.6)
    belt, eta = speed * 15e-3, float(OIL.viscosity(kelvin))
    # 600 W over 15 cm^2 and 2.5 um of 0.1 W/m/K: 10 K from wall to wall, 5 K to the middle
    shear = eta * belt**2 / (12 * 0.1)
    read = kelvin + sign * 5.0 - shear
    roll = replace(WARM, sensor_side=side)
    factor = float(film_thickness(roll, OIL, speed=speed, temperature=kelvin).factor)
    assert factor == pytest.approx(1.0, abs=0.01)  # inlet heating
    found = film_temperature(roll, OIL, speed=speed, temperature=read)
    assert float(found) == pytest.approx(kelvin, abs=5.0 * (1.0 - factor) + 1e-4)
    assert film_temperature(
        replace(roll, heat_flow=0.0), OIL, speed=speed, temperature=read
    ) == pytest.approx(read + shear, abs=0.1 * shear)


def test_without_heat_the_film_is_as_warm_as_the_reading() -> None:
    read = np.array([300.0, 440.0])
    assert film_temperature(BARE, OIL, speed=3.0, temperature=read).tolist() == read.tolist()


def test_what_cannot_be_is_said() -> None:
    with pytest.raises(ParameterError, match="conductivity"):
        film_temperature(WARM, replace(OIL, conductivity=None), speed=3.0, temperature=440.0)
    with pytest.raises(ParameterError, match="heat_flow is 3e\\+06 W"):
        film_temperature(replace(WARM, heat_flow=3e6), OIL, speed=3.0, temperature=440.0)
    with pytest.raises(ParameterError, match="sensor_side is missing"):
        replace(BARE, heat_flow=600.0)
    with pytest.raises(ParameterError, match="sensor_side is 'belt': it must be heater or roll"):
        replace(WARM, sensor_side="belt")
    with pytest.raises(ParameterError, match="must not be negative"):
        replace(WARM, heat_flow=-1.0)
