"""Columns of a current, a voltage or a percentage: what one of it stands for must be said."""

from __future__ import annotations

from pathlib import Path

import pytest

import hersey
from hersey.errors import ChannelError, UnitError
from hersey.log.mapping import read_with_mapping


def log(folder: Path, torque: str, speed: str = "speed [rpm]") -> Path:
    rows = [f"{0.1 * i:.1f},{2 + 0.001 * (i % 3)},30,50" for i in range(100)]
    file = folder / "log.csv"
    file.write_text("\n".join([f"time [s],{torque},{speed},temperature [degC]", *rows]))
    return file


def mean_torque(log: hersey.TorqueLog) -> float:
    return float(log.runs[0].torque.mean())


@pytest.mark.parametrize(
    ("torque", "unit", "newton_metres"),
    [
        ("torque [A]", "0.2 N*m/A", 0.4),
        ("torque [A]", "200 mNm / A", 0.4),
        ("torque [A]", "0.2 N*m", 0.4),
        ("torque [mA]", "0.2 N*m/A", 0.4e-3),
        ("torque [A]", "0.2 N*m/mA", 400.0),
        ("torque [V]", "5 N*m/V", 10.0),
        ("torque [Volts]", "5 N*m/V", 10.0),
        ("torque [V]", "5 N*m/volt", 10.0),
        ("torque [Amps]", "200 mN*m/mA", 400.0),
        ("torque [%]", "5 N*m/%", 10.0),
        ("torque [%]", "9 N*m / 100", 0.18),
        ("torque [‰]", "9 N*m / 1000", 0.018),
        ("torque [‰]", "1.27 mN*m/‰", 2.54e-3),
        ("torque [permille]", "1.27 mN*m/‰", 2.54e-3),
        ("torque [0.1 %]", "1.27 mN*m/permille", 2.54e-3),
        ("torque [‰]", "12.7 mN*m/%", 2.54e-3),
        ("torque [%]", "1.27 mN*m / 0.1 %", 25.4e-3),
        ("torque", "5 N*m/V", 10.0),
    ],
)
def test_the_torque_of_one_ampere_or_volt_is_a_unit(
    torque: str, unit: str, newton_metres: float, tmp_path: Path
) -> None:
    read = hersey.read(log(tmp_path, torque), units={"torque": unit})
    assert mean_torque(read) == pytest.approx(newton_metres, rel=1e-3)


def test_a_tachometer_has_a_unit_as_well(tmp_path: Path) -> None:
    file = log(tmp_path, "torque [N*m]", "speed [V]")
    read = hersey.read(file, units={"speed": "100 rpm/V"})
    assert float(read.runs[0].speed.mean()) == pytest.approx(3000 * 2 * 3.14159265 / 60)


@pytest.mark.parametrize(
    ("counted", "advice", "seconds"),
    [
        ("counts/s", "rev/s/2000", 1),
        ("counts", "rev/s/2000", 1),
        ("cts/min", "rev/min/2000", 60),
        ("pulses/s", "rev/s/2000", 1),
        ("ticks/min", "rev/min/2000", 60),
        ("inc/s", "rev/s/2000", 1),
        ("Imp/min", "rev/min/2000", 60),
        ("steps/s", "rev/s/2000", 1),
    ],
)
def test_counts_of_an_encoder_need_those_of_one_revolution(
    counted: str, advice: str, seconds: int, tmp_path: Path
) -> None:
    file = log(tmp_path, "torque [N*m]", f"speed [{counted}]")
    with pytest.raises(UnitError) as refused:
        hersey.read(file)
    assert str(refused.value) == (
        f"log.csv: column 'speed': unit '{counted}' of a speed needs the counts of one revolution. "
        f"Use units={{'speed': '{advice}'}}, with your value instead of 2000"
    )
    assert (refused.value.columns, refused.value.likely) == ((2,), "")
    read = hersey.read(file, units={"speed": advice})
    assert float(read.runs[0].speed.mean()) == pytest.approx(30 / 2000 * 2 * 3.14159265 / seconds)


def test_a_speed_in_counts_gives_way_to_one_in_rpm(tmp_path: Path) -> None:
    file = log(tmp_path, "torque [N*m]", "speed [rpm],speed raw [counts/s]")
    file.write_text(file.read_text().replace(",50", ",1000,50"))
    assert [each.name for each in hersey.read(file).files[0].channels if each.role == "speed"] == ["speed"]


@pytest.mark.parametrize(
    ("torque", "unit", "advice"),
    [
        ("torque [A]", "N*m", "35 mN*m/A"),
        ("torque [V]", "N*m", "2 N*m/V"),
        ("torque [V]", "0.2 N*m/A", "2 N*m/V"),
        ("torque [V]", "", "2 N*m/V"),
        ("torque [%]", "N*m", "9.84 mN*m / 100"),
        ("torque [‰]", "", "0.48 N*m / 1000"),
        ("torque [‰]", "mN*m", "0.48 N*m / 1000"),
        ("torque [0.1 %]", "", "0.48 N*m / 1000"),
        ("torque [A]", "0.2 nonsense/A", "35 mN*m/A"),
        ("torque [N*m]", "0.2 N*m/A", ""),
    ],
)
def test_a_signal_is_not_taken_for_a_torque(torque: str, unit: str, advice: str, tmp_path: Path) -> None:
    file = log(tmp_path, torque)
    with pytest.raises(UnitError) as refused:
        hersey.read(file, units={"torque": unit} if unit else {})
    assert refused.value.columns == (1,)
    assert advice in refused.value.remedy
    if advice:
        assert mean_torque(hersey.read(file, units={"torque": advice})) > 0


@pytest.mark.parametrize(("torque", "newton_metres"), [("torque [A]", 0.4), ("torque [mA]", 0.4e-3)])
def test_a_motor_constant_heeds_the_unit_of_the_column(
    torque: str, newton_metres: float, tmp_path: Path
) -> None:
    file = log(tmp_path, torque)
    (tmp_path / "hersey.toml").write_text('[torque]\nmotor_constant = "0.2 N*m/A"\n')
    assert mean_torque(read_with_mapping(file).log) == pytest.approx(newton_metres, rel=1e-3)


def test_a_motor_constant_is_not_for_a_voltage(tmp_path: Path) -> None:
    file = log(tmp_path, "torque [V]")
    (tmp_path / "hersey.toml").write_text('[torque]\nmotor_constant = "0.2 N*m/A"\n')
    with pytest.raises(UnitError):
        read_with_mapping(file)


def test_a_mapping_may_give_the_torque_of_a_volt(tmp_path: Path) -> None:
    file = log(tmp_path, "torque [V]")
    (tmp_path / "hersey.toml").write_text('[torque]\nunit = "5 N*m/V"\n')
    assert mean_torque(read_with_mapping(file).log) == pytest.approx(10.0, rel=1e-3)


@pytest.mark.parametrize("name", ["CH1", "Dev1/ai0", "Voltage", "analog in 2", "Kanal 3"])
def test_an_input_without_unit_may_be_a_voltage(name: str, tmp_path: Path) -> None:
    with pytest.raises(UnitError, match=r"give the torque per V: units=\{'torque': '2 N\*m/V'\}"):
        hersey.read(log(tmp_path, name), channels={"torque": name})


def test_a_channel_with_a_name_is_no_input(tmp_path: Path) -> None:
    with pytest.raises(UnitError, match="has no unit") as error:
        hersey.read(log(tmp_path, "torque"))
    assert "per V" not in str(error.value)


def test_an_oscilloscope_states_its_units_in_rows_of_their_own(tmp_path: Path) -> None:
    rows = [f"{0.1 * i:.1f},{2 + 0.001 * (i % 3)},{3 + 0.001 * (i % 2)}" for i in range(100)]
    preamble = ["Model,MSO44", "Horizontal Units,S,", "Vertical Units,V,V", ""]
    (tmp_path / "scope.csv").write_text("\n".join([*preamble, "TIME,CH1,CH2", *rows]))
    log = hersey.read(
        tmp_path / "scope.csv",
        channels={"torque": "CH1", "speed": "CH2"},
        units={"torque": "5 N*m/V", "speed": "10 rpm/V"},
        isothermal=True,
    )
    assert mean_torque(log) == pytest.approx(10.0, rel=1e-3)
    assert [c.unit for c in log.files[0].channels] == ["s", "5 N*m/V", "10 rpm/V"]
    assert float(log.runs[0].time[-1]) == pytest.approx(9.9)


@pytest.mark.parametrize(("unit", "full"), [("‰", "3 N*m / 1000"), ("%", "3 N*m / 100")])
def test_an_amount_alone_may_be_that_of_one_or_of_the_full_value(
    unit: str, full: str, tmp_path: Path
) -> None:
    file = log(tmp_path, f"torque [{unit}]")
    with pytest.raises(UnitError, match=r"may be the torque at 1 . or at the full value") as refused:
        hersey.read(file, units={"torque": "3 N*m"})
    assert refused.value.remedy == (
        f"use units={{'torque': '{full}'}} for the full value, or units={{'torque': '3 N*m/{unit}'}}"
    )
    assert mean_torque(hersey.read(file, units={"torque": full})) == pytest.approx(
        6.0 / float(full.split("/")[1]), rel=1e-3
    )


def test_a_torque_in_per_mille_and_all_else_that_is_open_are_asked_for_at_once(tmp_path: Path) -> None:
    rows = [f"{20 * i},{3 * i},{300 + i % 2},{150 + i % 3}" for i in range(100)]
    header = [";Position actual value;Velocity actual value;Torque actual value", "ms;inc;rpm;‰"]
    file = tmp_path / "drive.csv"
    file.write_text("\n".join([*header, *rows]).replace(",", ";"))
    with pytest.raises(ChannelError) as refused:
        hersey.read(file)
    assert "'Torque actual value' is in ‰, which needs the torque at 1000 ‰; no temperature" in str(
        refused.value
    )
    stated = {setting.name: value for setting, value in refused.value.examples}
    assert stated == {"torque": "0.48 N*m / 1000", "isothermal": ""}
    read = hersey.read(file, units={"torque": stated["torque"]}, isothermal=True)
    assert mean_torque(read) == pytest.approx(0.0725, rel=1e-2)


def test_a_torque_of_a_drive_profile_without_unit_may_be_in_per_mille(tmp_path: Path) -> None:
    with pytest.raises(UnitError) as refused:
        hersey.read(log(tmp_path, "Torque actual value"))
    assert "in ‰ of the rated torque (CiA 402), use units={'torque': '0.48 N*m / 1000'}" in str(refused.value)
