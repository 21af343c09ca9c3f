"""Numbers that would be ordinary under another name or in another unit."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.errors import ChannelError, HerseyError
from hersey.log.doubtful import doubtful_units

STEPS = np.repeat([20.0, 60.0, 180.0, 400.0], 100)
NOISE = np.random.default_rng(3).standard_normal(STEPS.size)
#: rpm held within 0.01 %, and N m with 1 % of noise.
SPEED, TORQUE = STEPS * (1.0 + 1e-4 * NOISE), 0.02 * STEPS**0.3 * (1.0 + 0.01 * NOISE)


@pytest.mark.parametrize(("torque", "speed", "said"), [(TORQUE, SPEED, 0), (SPEED, TORQUE, 1)])
def test_columns_under_each_others_names(
    torque: np.ndarray, speed: np.ndarray, said: int, tmp_path: Path
) -> None:
    rows = zip(torque.tolist(), speed.tolist(), strict=True)
    body = "".join(f"{0.1 * i:.1f},{q:.6g},{w:.6g},90\n" for i, (q, w) in enumerate(rows))
    path = tmp_path / "log.csv"
    path.write_text("Time [s],Torque [N*m],Speed [rpm],Temperature [degC]\n" + body)
    if not said:
        assert doubtful_units(hersey.read(path)) == []
        return
    with pytest.raises(ChannelError, match="swapped") as refused:
        hersey.read(path)
    assert refused.value.setting is not None
    assert refused.value.setting.name == "torque"
    hersey.read(path, channels={"torque": "Torque", "speed": "Speed"})  # confirmed


def test_a_slow_drive_of_great_torque_is_not_doubted(tmp_path: Path) -> None:
    """A valve at 0.3 rpm: its speed is held more closely than its torque."""
    body = "".join(f"{0.1 * i:.1f},{50 + n:.4f},{0.3 + 1e-5 * n:.6f},90\n" for i, n in enumerate(NOISE))
    path = tmp_path / "log.csv"
    path.write_text("Time [s],Torque [N*m],Speed [rpm],Temperature [degC]\n" + body)
    assert doubtful_units(hersey.read(path)) == []


@pytest.mark.parametrize(
    ("low", "high", "units"),
    [
        (77.0, 356.0, ["degF"]),  # from a start at 25 degC
        (298.0, 454.0, ["K"]),
        (330.0, 350.0, ["K", "degF"]),
        (600.0, 900.0, ["0.1 degC"]),
        (235.0, 1200.0, ["0.1 degC"]),  # from a start at 23.5 degC
        (235.0, 600.0, ["degF", "0.1 degC"]),
    ],
)
def test_which_unit_of_temperature_would_be_likely(low: float, high: float, units: list[str]) -> None:
    time = np.arange(STEPS.size) * 0.1
    degrees = np.linspace(low, high, STEPS.size)
    table = {"Time [s]": time, "Torque [N*m]": TORQUE, "Speed [rpm]": SPEED, "Temp [degC]": degrees}
    (warning,) = doubtful_units(hersey.read(pl.DataFrame(table)))
    assert warning.kind == "unit of temperature doubtful"
    assert [
        unit for unit in ("K", "degF", "degC", "0.1 degC", "0.1 K") if f"'{unit}'" in warning.text
    ] == units


def in_hertz(name: str, unit: str) -> pl.DataFrame:
    """A log of a motor of two pole pairs, whose inverter recorded its frequency."""
    time = np.arange(STEPS.size) * 0.1
    heat = np.full(STEPS.size, 90.0)
    return pl.DataFrame(
        {"Time [s]": time, "Torque [N*m]": TORQUE, f"{name} [{unit}]": SPEED / 30, "T [degC]": heat}
    )


@pytest.mark.parametrize(
    ("name", "unit", "given"),
    [("Output frequency", "Hz", "channels"), ("Frequency", "rev/s", "channels"), ("Drive speed", "Hz", "")],
)
def test_the_frequency_of_an_inverter_is_met_with_the_pole_pairs(name: str, unit: str, given: str) -> None:
    table = in_hertz(name, unit)
    with pytest.raises(HerseyError) as refused:
        hersey.read(table)
    typed = {
        key: ast.literal_eval(each)
        for key, each in re.findall(
            r"(channels|units)=(\{.*?\})", str(refused.value).partition("inverter")[2]
        )
    }
    assert ("channels" in typed) == bool(given)
    log = hersey.read(table, **typed)
    assert log.runs[0].speed == pytest.approx(SPEED * 2 * np.pi / 60, rel=1e-9)
    assert doubtful_units(log) == []


@pytest.mark.parametrize(("unit", "said"), [("rev/s", 1), ("rev/s/2", 0), ("rev/s/1", 0), ("rpm", 0)])
def test_a_frequency_read_as_revolutions_is_doubted(unit: str, said: int) -> None:
    log = hersey.read(in_hertz("frequency", "Hz"), channels={"speed": "frequency"}, units={"speed": unit})
    assert [each.kind for each in doubtful_units(log)] == ["pole pairs doubtful"] * said
    named = hersey.read(in_hertz("Drive speed", "Hz"), units={"speed": unit})
    assert doubtful_units(named) == []
