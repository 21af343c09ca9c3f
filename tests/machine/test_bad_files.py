"""Files with one mistake each: the message names file and key, says what is wrong and the way out.

The messages stand in `messages.json`, to the letter. ``python -m tests.machine.test_bad_files`` writes them
anew; look at every line that changes.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from hersey.errors import HerseyError
from hersey.log.mapping import read_mapping
from hersey.machine import read_machine
from hersey.motion.scenario import read_scenario
from tests.conftest import ROOT

MESSAGES = Path(__file__).with_name("messages.json")

MACHINE = (ROOT / "tests" / "stand" / "machine.toml").read_text()
BOUNDARY = '[boundary]\nfriction = 0.1\ntemperature_slope = "-0.1 %/K"\nat = "180 degC"\n'
EXAMPLE = MACHINE[: MACHINE.index("# What is in the nip")] + '[lubricant]\nexample = "cylinder oil"\n'
MAPPING = """
[time]
channel = "t"
unit = "ms"
[torque]
channel = "I motor"
unit = "mA"
sign = -1
motor_constant = "35 mN*m/A"
tare = "1 mN*m"
no_load = "2 mN*m"
gear_ratio = 12.5
efficiency = 0.8
inertia = "2e-4 kg*m^2"
[speed]
channel = "n"
unit = "rpm"
[temperature]
offset = "-1.5 K"
time_constant = "4 s"
"""
PLAIN = """
[parameters]
stiffness = [500, 1000]
mass = 1
transition_force = 50
transition_speed = 1
ehl_exponent = -0.7
mixed_exponent = -1.2
stick_speed = 0.01
drive_speed = { from = 0.4, to = 1.6, count = 3 }
[options]
units = "consistent"
"""
UNITS = (ROOT / "examples" / "scenario.toml").read_text()

#: Reader, good file, and the replacements that make it bad, one at a time.
CORPUS: dict[str, tuple[Callable[[Path], Any], str, list[tuple[str, str]]]] = {
    "machine.toml": (
        read_machine,
        MACHINE,
        [
            ("[drivetrain]", "[drivetrain"),
            ("[drivetrain]", "[roll]"),
            ("[drivetrain]", "[[drivetrain]]"),
            ("[limits]", "[limit]"),
            ("[limits]", "[[limits]]"),
            ("[contact]", "[nip]"),
            ("[contact]", "[[contact]]"),
            ("[lubricant]", "[[lubricant]]"),
            ("[uncertainty]", "[[uncertainty]]"),
            ("# [sensors.torque]", "[sensors]\ntorque = 3"),
            ("# [sensors.torque]", "[sensors.load]"),
            ("# [sensors.torque]", '[sensors.torque]\ngain_eror = "1 %"'),
            ("# [sensors.torque]", "[sensors.torque]\ngain_error = 0.01"),
            ("# [sensors.torque]", '[sensors.torque]\nzero_error = "2 mm"'),
            ("# [sensors.torque]", '[sensors.speed]\nzero_error = "2 rpm"'),
            ("# [sensors.torque]", '[sensors.temperature]\nzero_error = "2 degC"'),
            ("# [sensors.torque]", '[torque]\ngain_error = "1 %"'),
            ("# [sensors.torque]", "[rest]"),
            ("# [sensors.torque]", '[rest]\ntorque = "20 N"'),
            ("# [sensors.torque]", "[rest]\ntorque = 20"),
            ("# [sensors.torque]", '[rest]\ntorque = "-20 mN*m"'),
            ("# [sensors.torque]", '[rest]\ntorque = "0 mN*m"'),
            ("# [sensors.torque]", '[rest]\ndamping = "1 N*s/m"'),
            ("# [sensors.torque]", '[rest]\ntorqe = "20 mN*m"'),
            ("# [sensors.torque]", '[rest]\ntorque = "20 mN*m"\ntemperature_slope = "-0.2 %/K"'),
            ("# [sensors.torque]", '[rest]\ntorque = "20 mN*m"\ntemperature_slope = -0.002\nat = "180 degC"'),
            (
                "# [sensors.torque]",
                '[rest]\ntorque = "20 mN*m"\ntemperature_slope = "-30 %/K"\nat = "180 degC"',
            ),
            ("# [sensors.torque]", '[rest]\ntorque = "20 mN*m"\nat = "180 rpm"'),
            ("# [sensors.torque]", '[rest]\ntorque = "20 mN*m"\nuncertainty = 0.1'),
            ("# [sensors.torque]", '[rest]\ntorque = "20 mN*m"\nlog = "free.csv"'),
            ("# [sensors.torque]", '[rest]\nlog = "free.csv"'),
            ("# [sensors.torque]", '[rest]\ntorque = "20 mN*m"\ntare = "standing"'),
            ("# [sensors.torque]", '[asperities]\nmodulus = "3 GPa"'),
            ("# [sensors.torque]", "[asperities]\nsigma_over_beta = 0.01"),
            ("# [sensors.torque]", '[asperities]\nmodulus = "3 N"\n[boundary]\nfriction = 0.1'),
            ("# [sensors.torque]", '[asperities]\nmodulus = "30 MPa"\n[boundary]\nfriction = 0.1'),
            ("# [sensors.torque]", '[asperities]\nmodulus = "3 GPa"\nsigma = 1\n[boundary]\nfriction = 0.1'),
            ("# [sensors.torque]", "[boundary]\nfriction = 0.1"),
            ("# [sensors.torque]", '[boundary]\nfriction = "0.1"'),
            ("# [sensors.torque]", '[boundary]\nfriction = 0.1\ntemperature_slope = "-0.1 %/K"'),
            ("# [sensors.torque]", "[boundary]\nfriction = 0.1\nstatic_friction = 0"),
            (
                MACHINE[MACHINE.index("roughness") : MACHINE.index("# What is in the nip")],
                f'[asperities]\nmodulus = "3 GPa"\n{BOUNDARY}',
            ),
            (
                MACHINE[MACHINE.index("[lubricant]") : MACHINE.index("# What the drive takes")],
                f'[asperities]\nmodulus = "3 GPa"\n{BOUNDARY}',
            ),
            ("# [sensors.torque]", f'[asperities]\nmodulus = "3 GPa"\n{BOUNDARY}'),
            ("[heat]", "[heating]"),
            ('film_capacity = "150 J/K"', ""),
            ('film_capacity = "150 J/K"', 'film_capacity = "0 J/K"'),
            ('film_capacity = "150 J/K"', 'film_capacity = "150 W/K"'),
            ('exchange = "12 W/K"', 'exchange = "-12 W/K"'),
            ('exchange = "12 W/K"', "exchange = 12"),
            ('heater_power = "900 W"', 'heater_power = "900 N"'),
            ('heater_power = "900 W"', 'heater_pwr = "900 W"'),
            ('setpoint = "180 degC"', 'heater_gain = "100 W/K"'),
            ('surroundings = "25 degC"', 'surroundings = "25 K"'),
            ('stick_speed = "0.3 mm/s"', 'stick_speed = "0.3 mm/s"\nstick_speed_rule = "still"'),
            ('stick_speed = "0.3 mm/s"', 'stick_speed = "0.3 mm/s"\nstick_speed_temperature = "150"'),
            ("[drivetrain]", "limits = 3\n[drivetrain]"),
            ("[drivetrain]", "[points]\n[drivetrain]"),
            ('stiffness = "11 N/mm"', ""),
            ('mass = "11 kg"', ""),
            ('roll_radius = "15 mm"', ""),
            ('stick_speed = "0.3 mm/s"', ""),
            ('stiffness = "11 N/mm"', "stiffness = 11"),
            ('stiffness = "11 N/mm"', "stiffness = true"),
            ('stiffness = "11 N/mm"', "stiffness = nan"),
            ('stiffness = "11 N/mm"', 'stiffness = ["11 N/mm"]'),
            ('stiffness = "11 N/mm"', "stiffness = { value = 1 }"),
            ('stiffness = "11 N/mm"', 'stiffness = ""'),
            ('stiffness = "11 N/mm"', 'stiffness = "11"'),
            ('stiffness = "11 N/mm"', 'stiffness = "N/mm"'),
            ('stiffness = "11 N/mm"', 'stiffness = "11 kg"'),
            ('stiffness = "11 N/mm"', 'stiffness = "11 furlong"'),
            ('stiffness = "11 N/mm"', 'stiffness = "0,3 N/m"'),
            ('stiffness = "11 N/mm"', 'stiffness = "-11 N/m"'),
            ('stiffness = "11 N/mm"', 'stiffness = "0 N/m"'),
            ('stiffness = "11 N/mm"', 'stiffness = "1e300 N/m"'),
            ('stiffness = "11 N/mm"', 'stiffness = "1e999 N/m"'),
            ('stiffness = "11 N/mm"', 'stiffness = "0.1 N/m"'),
            ('stiffness = "11 N/mm"', 'stiffness = "11 N/mm"\nspring = "1 N/m"'),
            ('stiffness = "11 N/mm"', 'stiffness = "11 N/mm"\nzeal = 1\nspring = "1 N/m"'),
            ('mass = "11 kg"', 'mass = "11 mm"'),
            ('mass = "11 kg"', 'mass = "1e9 kg"'),
            ('roll_radius = "15 mm"', 'roll_radius = "1 um"'),
            ('stick_speed = "0.3 mm/s"', 'stick_speed = "3 rpm"'),
            ('stick_speed = "0.3 mm/s"', 'stick_speed = "20 m/s"'),
            ('motor_torque = "8 N*m"', "motor_torque = 8"),
            ('motor_torque = "8 N*m"', 'motor_torque = "8 J"'),
            ('motor_torque = "8 N*m"', 'motor_torque = "8 %"'),
            ("roll_friction = 0.6", 'roll_friction = "0.6"'),
            ("roll_friction = 0.6", "roll_friction = true"),
            ("roll_friction = 0.6", "roll_friction = -0.6"),
            ("roll_friction = 0.6", "roll_friction = 60"),
            ("roll_friction = 0.6", "roll_friction = nan"),
            ("roll_friction = 0.6", "roll_friction = inf"),
            ("roll_friction = 0.6", "roll_friction = [0.6]"),
            ('nip_load = "300 N"', 'nip_load = "300 kg"'),
            ('nip_load = "300 N"', ""),
            ('acceleration = "500 mm/s^2"', 'acceleration = "500 mm/s"'),
            ('speed = "400 mm/s"', 'speed = "4e9 mm/s"'),
            ('speed = "400 mm/s"', 'speed = "400 mm/s"\ntorque = "1 N*m"'),
            ('modulus = "1 MPa"', 'modulus = "1 mm"'),
            ('modulus = "1 MPa"', 'modulus = "1 Pa"'),
            ('modulus = "1 MPa"', ""),
            ('modulus = "1 MPa"', 'modulus = "1 MPa"\nshore_a = 30'),
            ('modulus = "1 MPa"', "shore_a = 3"),
            ('modulus = "1 MPa"', 'shore_a = "30"'),
            ("poisson_ratio = 0.48", "poisson_ratio = 0.6"),
            ("poisson_ratio = 0.48", "poisson_ratio = 0"),
            ("poisson_ratio = 0.48", 'poisson_ratio = "0.48 mm"'),
            ("poisson_ratio = 0.48", ""),
            ('rubber_thickness = "3.5 mm"', ""),
            ('rubber_thickness = "3.5 mm"', 'rubber_thickness = "30 mm"'),
            ('length = "220 mm"', ""),
            ('length = "220 mm"', 'length = "220 s"'),
            ('length = "220 mm"', 'length = "220 mm"\nwidth = 3'),
            ('length = "220 mm"', 'length = "220 mm"\nheater_radius = "-1 m"'),
            ('roughness = "1.5 um"', "roughness = 1.5"),
            ('nip_uncertainty = "10 %"', "nip_uncertainty = 0.1"),
            ('nip_uncertainty = "10 %"', 'nip_uncertainty = "10"'),
            ('nip_uncertainty = "10 %"', 'nip_uncertainty = "0 %"'),
            ('nip_uncertainty = "10 %"', 'nip_uncertainty = "1000 %"'),
            ('name = "invented grease oil"', "name = 3"),
            ('name = "invented grease oil"', 'name = "x"\nmaker = "y"'),
            ('model = "walther"', 'model = "andrade"'),
            ('model = "walther"', "model = 2"),
            ('model = "walther"', ""),
            ('model = "walther"', 'model = "vogel"'),
            ('model = "walther"', 'model = "walther"\nsource = 4'),
            ('model = "walther"', 'model = "walther"\nexample = "cylinder oil"'),
            ('model = "walther"', 'example = "butter"'),
            ('viscosities = [["40 degC", "500 mm^2/s"], ["100 degC", "47 mm^2/s"]]', ""),
            ('viscosities = [["40 degC", "500 mm^2/s"], ["100 degC", "47 mm^2/s"]]', "viscosities = 3"),
            ('viscosities = [["40 degC", "500 mm^2/s"], ["100 degC", "47 mm^2/s"]]', "viscosities = []"),
            (
                'viscosities = [["40 degC", "500 mm^2/s"], ["100 degC", "47 mm^2/s"]]',
                'viscosities = "1 Pa*s"',
            ),
            ('["40 degC", "500 mm^2/s"]', '["40 degC"]'),
            ('["40 degC", "500 mm^2/s"]', '["40 degC", "500 kg"]'),
            ('["40 degC", "500 mm^2/s"]', '["40 degC", "500"]'),
            ('["40 degC", "500 mm^2/s"]', '["40 degC", 500]'),
            ('["40 degC", "500 mm^2/s"]', '["40", "500 mm^2/s"]'),
            ('["40 degC", "500 mm^2/s"]', '[40, "500 mm^2/s"]'),
            ('["40 degC", "500 mm^2/s"]', '["4000 degC", "500 mm^2/s"]'),
            ('["40 degC", "500 mm^2/s"]', '["40 degC", "-500 mm^2/s"]'),
            ('["40 degC", "500 mm^2/s"]', '["40 degC", "1e20 mPa*s"]'),
            ('["40 degC", "500 mm^2/s"]', '["40 degC", "5 mm^2/s"]'),
            ('["40 degC", "500 mm^2/s"]', '["100 degC", "500 mm^2/s"]'),
            ('density = "1.9 g/cm^3"', ""),
            ('density = "1.9 g/cm^3"', 'density = "1.9 g"'),
            ('density = "1.9 g/cm^3"', 'density = "1 kg/m^3"'),
            ('pressure_viscosity = "20 GPa^-1"', "pressure_viscosity = 20"),
            ('pressure_viscosity = "20 GPa^-1"', 'pressure_viscosity = "20 GPa"'),
            ('pressure_viscosity = "20 GPa^-1"', 'pressure_viscosity = "20 Pa^-1"'),
            ('pressure_viscosity = "20 GPa^-1"', 'pressure_viscosity = [["40 degC"]]'),
            ('pressure_viscosity = "20 GPa^-1"', 'pressure_viscosity = [["40 degC", 20]]'),
            (
                'pressure_viscosity = "20 GPa^-1"',
                'pressure_viscosity = [["90 degC", "20 GPa^-1"], ["40 degC", "9 GPa^-1"]]',
            ),
            ('conductivity = "0.1 W/m/K"', 'conductivity = "0.1 W"'),
            ('conductivity = "0.1 W/m/K"', 'relaxation_time = "1 us"'),
            ('conductivity = "0.1 W/m/K"', "carreau_exponent = 0.6"),
            ('conductivity = "0.1 W/m/K"', "viscosity_left = 0.1"),
            ('conductivity = "0.1 W/m/K"', 'relaxation_time = "1 us"\ncarreau_exponent = 1.4'),
            ('uncertainty = "20 %"', "uncertainty = 0.2"),
            ('uncertainty = "20 %"', 'uncertainty = "a lot"'),
            ('stiffness = "10 %"', 'weight = "10 %"'),
            ('stiffness = "10 %"', "stiffness = 0.1"),
            ('stiffness = "10 %"', 'stiffness = "0 %"'),
            ('stiffness = "10 %"', 'stiffness = "1.2.3 %"'),
            ('stiffness = "10 %"', 'stiffness = "10"'),
            ('stiffness = "10 %"', 'stiffness = "2 N/mm to 1 N/mm"'),
            ('stiffness = "10 %"', 'stiffness = "1 kg to 2 kg"'),
            ('stiffness = "10 %"', 'ehl_exponent = "low to high"'),
            ('name = "full speed"', "name = 3"),
            ('name = "full speed"', 'name = " "'),
            ('name = "full speed"', 'colour = "red"'),
            ('speed = "120 mm/s"', ""),
            ('speed = "120 mm/s"', "speed = 120"),
            ('temperature = "180 degC"', ""),
            ('temperature = "180 degC"', 'temperature = "180"'),
            ('temperature = "180 degC"', 'temperature = "180 delta_degC"'),
            ('temperature = "180 degC"', 'temperature = "-273.15 degC"'),
            ('temperature = "180 degC"', 'temperature = "1800 degC"'),
        ],
    ),
    "oil.toml": (
        read_machine,
        EXAMPLE,
        [
            ('"cylinder oil"', "3"),
            ('"cylinder oil"', '"butter"'),
            ('"cylinder oil"', '"cylinder oil"\nname = "mine"'),
            ('"cylinder oil"', '"cylinder oil"\nviscosities = []'),
            ('"cylinder oil"', '"cylinder oil"\nmodel = 3'),
            ('"cylinder oil"', '"cylinder oil"\nconductivity = 3'),
        ],
    ),
    "bench.hersey.toml": (
        read_mapping,
        MAPPING,
        [
            ("[torque]", "[torque"),
            ("[torque]", "[torqe]"),
            ("[torque]", "[[torque]]"),
            ("[time]", 'temperature = "x"\n[time]'),
            ("[speed]", '[speed]\ntare = "1 N*m"'),
            ("[torque]", "[torque]\nzeal = 1\ngear = 2"),
            ('channel = "t"', 'channel = ""'),
            ('channel = "t"', "channel = 3"),
            ('unit = "ms"', "unit = 3"),
            ('unit = "ms"', 'unit = "mm"'),
            ('unit = "ms"', 'unit = " "'),
            ('unit = "rpm"', 'unit = "furlong"'),
            ('unit = "rpm"', 'unit = "Hz"'),
            ('unit = "mA"', 'unit = "N*m"'),
            ('motor_constant = "35 mN*m/A"', ""),
            ('motor_constant = "35 mN*m/A"', "motor_constant = 0.035"),
            ('motor_constant = "35 mN*m/A"', 'motor_constant = "35 mN*m"'),
            ('motor_constant = "35 mN*m/A"', 'motor_constant = "35"'),
            ('motor_constant = "35 mN*m/A"', 'motor_constant = "1e9 N*m/A"'),
            ('motor_constant = "35 mN*m/A"', 'motor_constant = "0 N*m/A"'),
            ("sign = -1", "sign = 2"),
            ("sign = -1", "sign = true"),
            ("sign = -1", 'sign = "-1"'),
            ("sign = -1", "sign = [1]"),
            ('tare = "1 mN*m"', "tare = 0.001"),
            ('tare = "1 mN*m"', 'tare = "1 rpm"'),
            ('tare = "1 mN*m"', 'tare = "1e9 N*m"'),
            ('no_load = "2 mN*m"', "no_load = 2"),
            ('no_load = "2 mN*m"', 'no_load = "-2 mN*m"'),
            ('no_load = "2 mN*m"', 'no_load = "2 rpm"'),
            ('no_load = "2 mN*m"', 'no_load = "free.csv"'),
            ("gear_ratio = 12.5", 'gear_ratio = "12:1"'),
            ("gear_ratio = 12.5", "gear_ratio = 0"),
            ("gear_ratio = 12.5", "gear_ratio = true"),
            ("gear_ratio = 12.5", "gear_ratio = inf"),
            ("efficiency = 0.8", "efficiency = 1.1"),
            ("efficiency = 0.8", "efficiency = nan"),
            ("efficiency = 0.8", 'efficiency = "80 %"'),
            ('inertia = "2e-4 kg*m^2"', 'inertia = "2e-4 kg*m"'),
            ('inertia = "2e-4 kg*m^2"', "inertia = 2e-4"),
            ('inertia = "2e-4 kg*m^2"', 'inertia = "1 kg**9**9**9"'),
            ('inertia = "2e-4 kg*m^2"', 'inertia = "1e-20 kg*m^2"'),
            ('offset = "-1.5 K"', 'offset = "2 degC"'),
            ('offset = "-1.5 K"', "offset = 2"),
            ('offset = "-1.5 K"', 'offset = "200 K"'),
            ('time_constant = "4 s"', 'time_constant = "4 m"'),
            ('time_constant = "4 s"', 'time_constant = "-4 s"'),
            ('time_constant = "4 s"', 'time_constant = "4 s"\nlag = 2'),
        ],
    ),
    "sweep.toml": (
        read_scenario,
        PLAIN,
        [
            ("[parameters]", "[parameters"),
            ("[parameters]", "parameters = 1"),
            ("[parameters]", "[parameter]"),
            ("[options]", "[option]"),
            ("[options]", "[[options]]"),
            ("[options]", "[options]\nspeed = 1\ncolour = 2"),
            ("[options]", "[options]\nzip = 'no'"),
            ("[options]", "[options]\nclosure = 3"),
            ("[options]", "[options]\ntolerance = '1e-9'"),
            ("[options]", "[options]\nduration = '1 s'"),
            ("[options]", "[options]\nbristle_stiffness = true"),
            ('units = "consistent"', 'units = "imperial"'),
            ('units = "consistent"', "units = 3"),
            ('units = "consistent"', ""),
            ("mass = 1", ""),
            ("mass = 1", "mass = '1 kg'"),
            ("mass = 1", "mass = true"),
            ("mass = 1", "mass = []"),
            ("mass = 1", "mass = [1, '2']"),
            ("mass = 1", "mass = 1\nweight = 1"),
            ("count = 3", "count = 0"),
            ("count = 3", "count = 2.5"),
            ("count = 3", "count = true"),
            ("count = 3", "count = 1000000000000"),
            ("count = 3", "count = 20000000"),
            ("count = 3", "count = 3, spacing = 'cubic'"),
            ("count = 3", "count = 3, spacing = 2"),
            ("count = 3", "count = 3, step = 1"),
            ("from = 0.4", "from = 0, spacing = 'log'"),
            ("from = 0.4", "from = '0.4'"),
            ("from = 0.4, ", ""),
            (", count = 3", ""),
        ],
    ),
    "units.toml": (
        read_scenario,
        UNITS,
        [
            ("[options]", '[options]\nduration = "1 m"'),
            ("[options]", "[options]\nduration = 1"),
            ("[options]", '[options]\nbristle_stiffness = "1 N"'),
            ("mass = ", "mass = 3 # "),
            ("mass = ", 'mass = "3 m" # '),
            ("mass = ", 'mass = ["3 kg", "3"] # '),
            ("mass = ", 'mass = ["3 kg", 4] # '),
            ("ehl_exponent = ", 'ehl_exponent = "-0.7" # '),
        ],
    ),
}


def cases() -> dict[str, tuple[str, str]]:
    """Name of the file and its text, by what was replaced."""
    out = {}
    for file, (_, good, replacements) in CORPUS.items():
        for old, new in replacements:
            assert old in good, old
            out[f"{file}: {old} -> {new}"] = file, good.replace(old, new, 1)
    return out


def told(folder: Path, file: str, text: str) -> str:
    """Kind and message of the error, or that there is none."""
    path = folder / file
    path.write_text(text)
    try:
        CORPUS[file][0](path)
    except HerseyError as error:
        return f"{type(error).__name__}: {error}"
    return "read"


@pytest.mark.parametrize("file", CORPUS)
def test_the_good_files_are_read(file: str, tmp_path: Path) -> None:
    assert told(tmp_path, file, CORPUS[file][1]) == "read"


@pytest.mark.parametrize("case", cases())
def test_the_message_is_the_known_one(case: str, tmp_path: Path) -> None:
    assert told(tmp_path, *cases()[case]) == json.loads(MESSAGES.read_text())[case]


def test_every_message_names_its_file_and_none_is_left_over() -> None:
    messages = json.loads(MESSAGES.read_text())
    assert messages.keys() == cases().keys()
    assert len(messages) > 150
    for case, message in messages.items():
        assert message == "read" or case.split(":")[0] in message, case


#: Values of every type that TOML has.
ODD = (
    "true",
    "1",
    "-1.5",
    "nan",
    "1e400",
    "9" * 400,
    '""',
    '"x"',
    "[]",
    "[[]]",
    '[["a", "b"]]',
    "{}",
    "1979-05-27",
)


@pytest.mark.parametrize("file", CORPUS)
def test_a_value_of_any_type_is_read_or_refused_in_one_line(file: str, tmp_path: Path) -> None:
    good = CORPUS[file][1]
    lines = good.splitlines()
    for number, line in enumerate(lines):
        key, sign, _ = line.partition(" = ")
        for value in ODD if sign and not line.startswith("#") else ():
            text = "\n".join([*lines[:number], f"{key} = {value}", *lines[number + 1 :]])
            answer = told(tmp_path, file, text)
            assert answer == "read" or (file in answer and "\n" not in answer), f"{key} = {value}: {answer}"


def test_hersey_itself_does_not_wait_for_pydantic() -> None:
    asked = "import sys, hersey, hersey.cli; hersey.read; print('pydantic' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


def write_messages() -> None:
    """Write `messages.json` anew."""
    with tempfile.TemporaryDirectory() as folder:
        messages = {case: told(Path(folder), *given) for case, given in cases().items()}
    MESSAGES.write_text(json.dumps(messages, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    write_messages()


def test_what_is_stated_of_the_lubricant_is_kept(tmp_path: Path) -> None:
    text = (ROOT / "tests" / "stand" / "machine.toml").read_text()
    head, _, rest = text.partition("[lubricant]")
    tail = rest[rest.index("\n[") :] if "\n[" in rest else ""
    path = tmp_path / "machine.toml"
    path.write_text(
        head
        + '[lubricant]\nexample = "cylinder oil"\nuncertainty = "20 %"\nconductivity = "0.14 W/m/K"\n'
        + tail
    )
    lubricant = read_machine(path).lubricant
    assert lubricant is not None
    assert (lubricant.uncertainty, lubricant.conductivity) == (pytest.approx(0.2), pytest.approx(0.14))
