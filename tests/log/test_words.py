"""Columns that are called by words of other languages than English."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

import hersey
from hersey.errors import ChannelError, HerseyError
from hersey.log.channels import ChannelChoice, find_column, taken_columns
from hersey.log.text.column import Column, split_unit


def roles(*header: str) -> dict[str, str]:
    """The name of the column that plays each role, or "?" where several could."""
    columns = tuple(Column(index, *split_unit(name)) for index, name in enumerate(header))
    chosen: dict[str, tuple[Column, None]] = {}
    played = {}
    for role in ("torque", "speed", "temperature", "time"):
        taken = taken_columns(role, columns, {}, chosen)
        try:
            column = find_column(role, columns, ChannelChoice(), "log", lambda _: False, taken)
        except ChannelError:
            played[role] = "?"
            continue
        if column is not None:
            chosen[role], played[role] = (column, None), column.name
    return played


#: Columns of time, torque or friction, speed and temperature, in this order.
LOGS = [
    ("Zeit [s]", "Drehmoment [Nm]", "Geschwindigkeit [mm/s]", "Öltemperatur [°C]"),
    ("Zeit [s]", "Reibkraft [N]", "Gleitgeschw. [mm/s]", "Temperatur [°C]"),
    ("Zeit", "Reibwert", "Drehzahl", "Temperatur"),
    ("Temps [s]", "Couple [N·m]", "Vitesse [tr/min]", "Température [°C]"),
    ("temps", "couple", "vitesse", "température"),
    ("temps", "couple", "vitesse"),
    ("t [s]", "Force de frottement [N]", "Vitesse de glissement [mm/s]", "Temp. [°C]"),
    ("t [s]", "Coefficient de frottement", "Vitesse [mm/s]", "Temp. [°C]"),
    ("Tiempo [s]", "Par [Nm]", "Velocidad [rpm]", "Temperatura [°C]"),
    ("Tiempo", "Par motor", "Velocidad", "Temperatura"),
    ("Tiempo [s]", "Fuerza de fricción [N]", "Velocidad [mm/s]", "Temperatura [°C]"),
    ("Tempo [s]", "Coppia [Nm]", "Velocità [giri/min]", "Temperatura [°C]"),
    ("Tempo", "Coppia", "Velocità", "Temperatura"),
    ("Tempo [s]", "Forza di attrito [N]", "Velocità [mm/s]", "Temperatura [°C]"),
    ("経過時間 [s]", "トルク [mN・m]", "搬送速度 [mm/s]", "温度 [℃]"),
    ("時間", "摩擦トルク", "回転数", "温度"),
    ("時間 [s]", "摩擦係数", "すべり速度 [mm/s]", "油温 [℃]"),
    ("时间 [s]", "扭矩 [Nm]", "转速 [r/min]", "温度 [℃]"),
    ("时间", "摩擦力矩", "转速", "温度"),
    ("时间 [s]", "摩擦力 [N]", "线速度 [mm/s]", "温度 [℃]"),
]


@pytest.mark.parametrize("header", LOGS, ids=" ".join)
def test_each_column_plays_its_role(header: Sequence[str]) -> None:
    names = [split_unit(name)[0] for name in header]
    assert roles(*header) == dict(zip(("time", "torque", "speed", "temperature"), names, strict=False))


#: Other columns beside those of a log, and the role of which they are none.
OTHERS = [
    ("time", "Uhrzeit [s]", ("Zeit [s]", "Drehmoment [Nm]", "Drehzahl [rpm]")),
    ("time", "時刻 [s]", ("時間 [s]", "トルク [Nm]", "速度 [rpm]")),
    ("time", "時刻 [s]", ("経過時間 [s]", "トルク [Nm]", "速度 [rpm]")),
    ("time", "Heure [s]", ("Temps [s]", "Couple [Nm]", "Vitesse [rpm]")),
    ("time", "Time [s]", ("Elapsed time [s]", "Torque [Nm]", "Speed [rpm]")),
    ("time", "temps", ("time", "torque", "speed")),
    ("speed", "加速度", ("時間", "トルク", "速度")),
    ("speed", "速度指令 [rpm]", ("時間 [s]", "トルク [Nm]", "速度 [rpm]")),
    ("speed", "Vitesse cible [tr/min]", ("Temps [s]", "Couple [Nm]", "Vitesse [tr/min]")),
    ("speed", "goal_speed [rpm]", ("time [s]", "torque [Nm]", "speed [rpm]")),
    ("torque", "Thermocouple", ("time", "torque", "speed")),
    ("torque", "par", ("time", "torque", "speed")),
    ("speed", "geschwindigkeit", ("time", "torque", "speed")),
]


@pytest.mark.parametrize(("role", "other", "header"), OTHERS)
def test_what_stands_beside_is_no_question(role: str, other: str, header: Sequence[str]) -> None:
    index = ("time", "torque", "speed").index(role)
    assert roles(other, *header)[role] == split_unit(header[index])[0]
    assert roles(*header, other)[role] == split_unit(header[index])[0]


@pytest.mark.parametrize("other", ["Elapsed revs", "Laufzeit [h]"])
def test_an_elapsed_time_is_one_by_its_unit(other: str) -> None:
    assert roles("Time [s]", other, "Torque [Nm]", "Speed [rpm]")["time"] == "?"


def test_a_stamp_beside_a_time_stays_a_question() -> None:
    assert roles("Timestamp [s]", "Time [s]", "Torque [Nm]", "Speed [rpm]")["time"] == "?"


def test_temps_are_temperatures_in_english() -> None:
    assert roles("time", "torque", "speed", "temps")["temperature"] == "temps"
    assert "temperature" not in roles("temps", "couple", "vitesse")


def test_a_japanese_log_asks_only_which_of_two_temperatures_counts(tmp_path: Path) -> None:
    rows = [
        f"13:20:{i // 10:02},{i / 10},{30 + i % 2},{2 + i % 3},{60 + i % 2},{50 + i % 2}" for i in range(300)
    ]
    file = tmp_path / "log.csv"
    header = "時刻,経過時間[s],回転数[rpm],トルク[mN・m],中央温度[℃],端部温度[℃]"
    file.write_text("\n".join([header, *rows]), encoding="cp932")
    with pytest.raises(HerseyError, match="the temperature column could be '中央温度") as refused:
        hersey.read(file)
    assert refused.value.remedy == "choose one with channels={'temperature': '中央温度'}"
    read = hersey.read(file, channels={"temperature": "端部温度"})
    names = [each.name for each in read.files[0].channels]
    assert names == ["経過時間", "トルク", "回転数", "端部温度"]
