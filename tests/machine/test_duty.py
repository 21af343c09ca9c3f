"""The tables [life] and [gear], and shares of the points: values, and files with one mistake each."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from hersey.errors import HerseyError
from hersey.machine import Machine, read_machine

TEXT = """
[drivetrain]
stiffness = "11 N/mm"
mass = "11 kg"
roll_radius = "15 mm"
stick_speed = "3 mm/s"

[life]
coldest = "15 degC"
travel = "300 mm"
energy = "10 J"
continuous_torque = "0.5 N*m"

[gear]
torque = "3 N*m"
cycles = 1e6
slope = 7
second_slope = "haibach"
endurance = "1 N*m"
ultimate = "20 N*m"
ratio = 3.5
starts = "20 per 1000 pages"
cold_starts = "10 %"
damage = 0.5
duty = "duty.csv"
duty_age = "1200 pages"

[[points]]
name = "full"
speed = "200 mm/s"
temperature = "180 degC"
share = "60 %"

[[points]]
name = "thick"
speed = "45 mm/s"
temperature = "180 degC"
share = "40 %"
"""


def read(folder: Path, old: str = "", new: str = "") -> Machine:
    assert old in TEXT
    (folder / "duty.csv").write_text("")
    path = folder / "machine.toml"
    path.write_text(TEXT.replace(old, new) if old else TEXT)
    return read_machine(path)


def test_values_in_si(tmp_path: Path) -> None:
    machine = read(tmp_path)
    assert vars(machine.life) == pytest.approx(
        {"coldest": 288.15, "travel": 0.3, "energy": 10.0, "continuous_torque": 0.5}
    )
    gear = machine.gear
    assert gear is not None
    assert (gear.torque, gear.cycles, gear.slope, gear.second_slope) == (3.0, 1e6, 7.0, "haibach")
    assert (gear.endurance, gear.ultimate, gear.ratio, gear.damage) == (1.0, 20.0, 3.5, 0.5)
    assert (gear.starts, gear.cold_starts, gear.duty_age) == ((20.0, "1000 pages"), 0.1, "1200 pages")
    assert gear.duty == str(tmp_path / "duty.csv")
    assert [point.share for point in machine.points] == [0.6, 0.4]


def test_nothing_is_needed(tmp_path: Path) -> None:
    path = tmp_path / "machine.toml"
    path.write_text(TEXT.partition("[life]")[0])
    machine = read_machine(path)
    assert set(vars(machine.life).values()) == {None}
    assert machine.gear is None


def test_starts_of_one_page(tmp_path: Path) -> None:
    gear = read(tmp_path, '"20 per 1000 pages"', '"0.02 per page"').gear
    assert gear is not None
    assert gear.starts == (0.02, "1 page")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('"15 degC"', '"15 mm"', "life.coldest: unit 'mm' is not a unit of temperature"),
        (
            '"300 mm"',
            "300",
            'life.travel is 300, without a unit. Write it in quotes with its unit, e.g. "300 mm"',
        ),
        ('"10 J"', '"-10 J"', "life.energy is -10 J: it must be greater than 0"),
        ('"10 J"', '"10 N"', "life.energy: unit 'N' is not a unit of energy"),
        ("coldest", "cold", "[life] has an unknown key 'cold'. Did you mean 'coldest'? Known keys: coldest"),
        ("slope = 7\n", "", "[gear] needs the key 'slope'"),
        ("slope = 7", "slope = -7", "gear.slope is -7: it must be greater than 0"),
        ('"haibach"', '"miner"', "gear.second_slope is 'miner'. Write a number such as 9, or 'haibach'"),
        ("20 per 1000", "20 x 1000", "gear.starts is '20 x 1000 pages'. Write a number per age"),
        ("20 per", "0 per", "gear.starts is '0 per 1000 pages'. Write a number per age"),
        ('"10 %"', '"110 %"', "[gear]: cold_starts are 110 %, but must not exceed 100 %"),
        ('starts = "20 per 1000 pages"\ncold', "cold", "[gear] has cold_starts but no starts"),
        ('duty = "duty.csv"\n', "", '[gear] has duty_age but no duty. Add the log, e.g. duty = "duty.csv"'),
        (
            'duty_age = "1200 pages"',
            "",
            (
                "[gear] has duty but no duty_age. Add the age over which duty was recorded, e.g. "
                'duty_age = "1200 pages"'
            ),
        ),
        ('"1200 pages"', '"1200"', "gear.duty_age is '1200'. Write a number and its unit of age"),
        (
            "duty.csv",
            "other.csv",
            '[gear] duty = "other.csv" names a file that does not exist. Copy other.csv into the folder of m',
        ),
        ('"40 %"', '"30 %"', "points: the shares add up to 90 %, but must add up to 100 %"),
        (
            'share = "40 %"',
            "",
            "points: 'thick' has no share, but other points have one. State all shares, or none",
        ),
        ('"40 %"', "0.4", 'points 2.share is 0.4, not a percentage. Write "40 %"'),
    ],
)
def test_a_mistake_is_told_with_its_key(tmp_path: Path, old: str, new: str, told: str) -> None:
    with pytest.raises(HerseyError) as raised:
        read(tmp_path, old, new)
    said = re.fullmatch(r"machine\.toml(?:, line \d+)?: (.*)", str(raised.value))
    assert said
    assert said[1].startswith(told)
