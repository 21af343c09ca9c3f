"""What a machine file with a mistake is refused with: the line, and advice that works when it is followed."""

from __future__ import annotations

import math
import re
import warnings
from pathlib import Path

import pytest

from hersey.errors import HerseyError, PlausibilityWarning
from hersey.files.toml import read_toml
from hersey.machine import read_machine

GOOD = """\
# A machine.
[drivetrain]
stiffness = "11 N/mm"   # at the belt
mass = "11 kg"
roll_radius = "15 mm"
stick_speed = "3 mm/s"

[limits]
roll_friction = 0.6
nip_load = "300 N"

[rest]
torque = "20 mN*m"
uncertainty = "10 %"

[lubricant]
model = "walther"
viscosities = [["40 degC", "500 mm^2/s"], ["200 degC", "7.2 mm^2/s"]]
density = "1.9 g/cm^3"

[[points]]
name = "full speed"
speed = "200 mm/s"
temperature = "180 degC"
"""
OIL = 'viscosities = [["40 degC", "500 mm^2/s"], ["200 degC", "7.2 mm^2/s"]]'
SPEED = 'speed = "200 mm/s"'
RUBBER = '[contact]\nmodulus = "65 MPa"\nrubber_thickness = "3 mm"\npoisson_ratio = 0.48\nlength = "220 mm"'
POINT = """\
[points]
name = "slow"
speed = "20 mm/s"
temperature = "180 degC"

"""


#: What an error says to write: a whole line, or the value of a key.
LINE = re.compile(r"line (\d+).* Write: (.*?)(?: \(correct lines? .* too\))?$")
VALUE = re.compile(r"line (\d+).* Write (?:e\.g\. )?(.*?)(?:, without quotes)?$")


def refusal(path: Path) -> str:
    """What is wrong with a machine file, or nothing."""
    try:
        read_machine(path)
    except HerseyError as error:
        return str(error)
    return ""


def follow(path: Path, most: int = 6) -> None:
    """Replace lines as the errors say, until the file is read."""
    for _ in range(most):
        said = refusal(path)
        if not said:
            return
        line, value = LINE.search(said), VALUE.search(said)
        match = line or value
        assert match, said
        lines = path.read_text().split("\n")
        number = int(match[1]) - 1
        lines[number] = match[2] if line else f"{lines[number].partition('=')[0]}= {match[2]}"
        path.write_text("\n".join(lines))
    assert not refusal(path)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"11 N/mm"', '"11,0 N/mm"'),
        ('"11 N/mm"', "11 N/mm"),
        ('"11 N/mm"', "11,0 N/mm"),
        ('"11 N/mm"', "11"),
        ('"11 N/mm"', "\u201e11 N/mm\u201c"),
        ('"11 N/mm"', '"11 N/mm'),
        ('"11 N/mm"', '11 N/mm"'),
        ('"11 N/mm"', '"11" N/mm'),
        ('"11 N/mm"', '"11 N/mm";'),
        ('"11 N/mm"', '"~11 N/mm"'),
        ('"11 N/mm"', '"11 000 N/m"'),
        ('stiffness = "11 N/mm"', 'stiffness "11 N/mm"'),
        ('stiffness = "11 N/mm"', "stiffness: 11 N/mm"),
        ('stiffness = "11 N/mm"', 'stiffness == "11 N/mm"'),
        ('stiffness = "11 N/mm"', "stiffness (N/mm) = 11"),
        ('stiffness = "11 N/mm"', 'stiffness\u00a0= "11 N/mm"'),
        ("# A machine.", "// A machine."),
        ("[drivetrain]", "[drivetrain"),
        ("[drivetrain]", "drivetrain:"),
        ("[drivetrain]", "[drive train]"),
        ("[[points]]", "[[points]"),
        ("roll_friction = 0.6", "roll_friction = 0,6"),
        ("roll_friction = 0.6", "roll_friction = .6"),
        ("roll_friction = 0.6", "roll_friction = 60 %"),
        ("roll_friction = 0.6", 'roll_friction = "0,6"'),
        ('uncertainty = "10 %"', "uncertainty = 10 %"),
        ('"11 N/mm"', "11 [N/mm]"),
        ('"11 N/mm"', "11 (N/mm)"),
        (OIL, OIL[:-1]),
        (OIL, 'viscosities = [["500 mm^2/s", "40 degC"], ["7.2 mm^2/s", "200 degC"]]'),
        (OIL, 'viscosities = [["40 degC", "7.2 mm^2/s"], ["200 degC", "500 mm^2/s"]]'),
        (OIL, 'viscosities = [["200 degC", "7.2 mm^2/s"], ["40 degC", "500 mm^2/s"]]'),
        (OIL, f'{OIL}\npressure_viscosity = [["90 degC", "9 GPa^-1"], ["40 degC", "20 GPa^-1"]]'),
        (OIL, 'viscosities = [["200 degC", "0.5 Pa*s"], ["40 degC", "7.2 mPa*s"]]'),
        (OIL, "viscosities = [[40 degC, 500 mm^2/s], [200 degC, 7.2 mm^2/s]]"),
        ('"11 kg"', '"108 N"'),
        ('"300 N"', '"30 kg"'),
    ],
)
def test_the_advice_works(old: str, new: str, tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(GOOD.replace(old, new, 1))
    with pytest.raises(HerseyError):
        read_machine(path)
    follow(path)


@pytest.mark.parametrize(
    ("old", "new", "stiffness", "mass", "radius"),
    [
        ('"11 N/mm"', "11,5 N/mm", 11500, 11, 0.015),
        ('"11 kg"', '"108 N"', 11000, 11.01, 0.015),
    ],
)
def test_the_corrected_value_is_the_one_meant(
    old: str, new: str, stiffness: float, mass: float, radius: float, tmp_path: Path
) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(GOOD.replace(old, new, 1))
    follow(path)
    machine = read_machine(path)
    assert (machine.stiffness, machine.mass, machine.roll_radius) == pytest.approx((stiffness, mass, radius))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('roll_radius = "15 mm"', 'roll_diameter = "30 mm"', 'line 5: .* roll_radius = "15 mm"'),
        ('mass = "11 kg"', 'weight = "11 kg"', "line 4: .* 'mass'"),
        ('mass = "11 kg"', 'mass = "11 kg"\nnip_load = "300 N"', r"line 5: .* \[limits\]"),
        ("[drivetrain]\n", "", r"line 2: 'stiffness' is in no table. It belongs in \[drivetrain\]"),
        ('mass = "11 kg"', 'mass = "11 kg"\nmass = "12 kg"', "line 5: the key 'mass' is already in line 4"),
        ("[limits]", "[drivetrain]", r"line 8: the table \[drivetrain\] is already in line 2"),
        ('"3 mm/s"', '"1 mm/s to 4 mm/s"', r'line 6: .* "2 mm/s".*\[uncertainty\]: stick_speed = "1 mm/s to'),
        (
            '"3 mm/s"',
            '"0.01 rad/s to 0.04 rad/s"',
            r'line 6: .* "0.02 rad/s".*\[uncertainty\]: stick_speed = "0.01 rad/s to',
        ),
        ('stick_speed = "3 mm/s"\n', "", 'line 2: .* Add e.g. stick_speed = "'),
        (
            '"11 N/mm"',
            '"11 ± 1 N/mm"',
            r'line 3: .* "11 N/mm" .*\[uncertainty\]: stiffness = "10 N/mm to 12 N/mm"',
        ),
        ('"11 kg"', '"11 kg +/- 10 %"', r'line 4: .* "11 kg" .*\[uncertainty\]: mass = "± 10 %"'),
        ("roll_friction = 0.6", "roll_friction = 60", "line 9: .* write 0.6$"),
        (
            OIL,
            OIL.replace("200 degC", "313.15 K"),
            "line 18: .* two values at 313.15 K, 500 mm.* and 7.2 mm.* Correct the temperature of one$",
        ),
        (
            'stiffness = "11 N/mm"   # at the belt\nmass = "11 kg"\nroll_radius = "15 mm"',
            'stiffness = "2.5 Nm/rad"\nmass = "11 kg"',
            "line 3: .* a torsional stiffness, .* Add roll_radius, or divide by its square$",
        ),
        (
            OIL,
            'viscosity_40 = "500 cSt"\nviscosity_200 = "7.2 cSt"',
            r'these 2 lines: viscosities = \[\["40 degC", "500 cSt"\], \["200 degC", "7.2 cSt"\]\]$',
        ),
        (OIL, f"{OIL}\nviscosity_index = 98", "line 19: .* Delete this line: the two viscosities say it"),
        (OIL, 'VI = 98\nkv40 = "500 cSt"\nkv100 = "40 cSt"', "line 18: .* Delete this line: the two"),
        (OIL, 'VI = 98\nkv40 = "500 cSt"', "line 18: .* Write the viscosity at two temperatures instead"),
        (OIL, 'kv40 = "500 cSt"', r'that line: viscosities = \[\["40 degC", "500 cSt"\]\]$'),
        (OIL, OIL.replace(', ["200 degC", "7.2 mm^2/s"]', ""), r"line 16: .* needs 2 pairs .* has 1\. Add 1"),
        (
            "[[points]]",
            POINT * 2,
            r"line 26: the table \[points\] is already in line 21.* \[\[points\]\] in both",
        ),
        ("[lubricant]", '[contact]\nmodulus = "65 Shore A"\n[lubricant]', "line 17: .* shore_a = 65 "),
        (
            'torque = "20 mN*m"\nuncertainty = "10 %"',
            r'log = "C:\bench\new.csv"',
            r"line 13: .*'C:\\bench\\new",
        ),
    ],
)
def test_the_line_and_the_way_out_are_named(old: str, new: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(GOOD.replace(old, new, 1))
    with pytest.raises(HerseyError, match=said):
        read_machine(path)


@pytest.mark.parametrize("encoding", ["utf-16", "utf-8-sig"])
@pytest.mark.parametrize("ends", ["\n", "\r\n", "\r"])
def test_a_file_of_any_editor_is_read(encoding: str, ends: str, tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    path.write_bytes(GOOD.replace("\n", ends).replace("degC", "°C").encode(encoding))
    assert read_machine(path).points[0].temperature == pytest.approx(453.15)


def test_a_character_of_another_encoding_is_named_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    path.write_bytes(GOOD.replace("180 degC", "180 °C").encode("latin-1"))
    with pytest.raises(HerseyError, match="line 24: '°' is not in UTF-8"):
        read_machine(path)


def test_json_is_recognized(tmp_path: Path) -> None:
    path = tmp_path / "machine.json"
    path.write_text('{"drivetrain": {"stiffness": "11 N/mm"}}')
    with pytest.raises(HerseyError, match=r'JSON.*\[drivetrain\].*stiffness = "11 N/mm"'):
        read_toml(path)


@pytest.mark.parametrize(
    ("old", "new", "meant"),
    [
        ('"11 N/mm"', '"11 N/m"', 'stiffness = "11 N/mm"'),
        ('"3 mm/s"', '"3 m/s"', 'stick_speed = "3 mm/s"'),
        ('temperature = "180 degC"', 'temperature = "180 K"', 'temperature = "180 degC"'),
        ("[lubricant]", f"{RUBBER}\n[lubricant]", "shore_a = 65"),
    ],
)
def test_an_unusual_value_is_read_with_a_warning(old: str, new: str, meant: str, tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(GOOD.replace(old, new, 1))
    with pytest.warns(PlausibilityWarning, match=meant):
        read_machine(path)


@pytest.mark.parametrize(
    ("load", "meant"),
    [
        ("1.300 N", "1300 N"),
        ("0.950 N", ""),
        ("1.3 N", ""),
        ("1.3000 N", ""),
        ("300.125 N", ""),
        ("1.300 kN", ""),
        ("1.300e3 N", ""),
    ],
)
def test_a_point_between_thousands_is_asked_about_only_where_the_value_is_implausible(
    load: str, meant: str, tmp_path: Path
) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(GOOD.replace("300 N", load))
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        read_machine(path)
    said = [str(each.message) for each in seen if issubclass(each.category, PlausibilityWarning)]
    assert len(said) == bool(meant)
    if meant:
        (advised,) = re.findall(r'write (nip_load = "[^"]+")', said[0])
        path.write_text(GOOD.replace('nip_load = "300 N"', advised))
        assert read_machine(path).limits.nip_load == 1300.0


@pytest.mark.parametrize(
    ("stated", "wider", "within"),
    [
        ('stick_speed = "5 mm/s to 8 mm/s"', "3 mm/s to 8 mm/s", '6 stick_speed = "6.325 mm/s"'),
        ('stiffness = "5-8 N/mm"', "5 N/mm to 11 N/mm", '3 stiffness = "6.325 N/mm"'),
        ('mass = "8 kg to 9.5 kg"', "8 kg to 11 kg", '4 mass = "8.718 kg"'),
    ],
)
def test_a_range_without_the_value_of_the_drivetrain_is_refused(
    stated: str, wider: str, within: str, tmp_path: Path
) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(f"{GOOD}\n[uncertainty]\n{stated}\n")
    with pytest.raises(HerseyError, match=f"line 27: .* does not contain .* in line {within[0]}") as refused:
        read_machine(path)
    key = stated.partition(" = ")[0]
    advised = re.findall(rf'{key} = "([^"]+)"', str(refused.value))
    assert advised == [wider, within.split('"')[1]]
    path.write_text(f'{GOOD}\n[uncertainty]\n{key} = "{wider}"\n')
    assert set(read_machine(path).uncertainty) == {key}
    lines = path.read_text().replace(f'{key} = "{wider}"', stated).split("\n")
    lines[int(within[0]) - 1] = within[2:]
    path.write_text("\n".join(lines))
    assert set(read_machine(path).uncertainty) == {key}


def test_a_range_that_ends_at_the_value_in_another_unit_is_read(tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(f'{GOOD}\n[uncertainty]\nstick_speed = "0.3 cm/s to 8 mm/s"\nmass = "5 kg to 11000 g"\n')
    assert set(read_machine(path).uncertainty) == {"stick_speed", "mass"}


def test_rotational_quantities_are_taken_at_the_radius(tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    turning = {
        'stiffness = "11 N/mm"': 'part = "joint"\nstiffness = "2000 N*m/rad"',
        '"11 kg"': '"0.4 kg*m^2"',
        '"15 mm"': '"50 mm"',
        'stick_speed = "3 mm/s"': 'stick_speed = "0.02 rad/s"',
        SPEED: 'speed = "60 rpm"',
    }
    text = GOOD
    for old, new in turning.items():
        assert old in text
        text = text.replace(old, new, 1)
    path.write_text(f'{text}\n[uncertainty]\nstick_speed = "0.01 rad/s to 0.04 rad/s"\n')
    machine = read_machine(path)
    assert (machine.part, machine.train.part) == ("joint", "joint")
    assert machine.train.stiffness == pytest.approx(2000 / 0.05**2)
    assert machine.train.mass == pytest.approx(0.4 / 0.05**2)
    assert machine.stick_speed == pytest.approx(0.02 * 0.05)
    assert machine.points[0].speed == pytest.approx(2 * math.pi * 0.05)
    assert machine.uncertainty["stick_speed"].limits == pytest.approx((0.01 * 0.05, 0.04 * 0.05))
