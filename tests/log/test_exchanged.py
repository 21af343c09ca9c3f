"""Columns under each other's names: refused before anything is decided, and never where names are right."""

from __future__ import annotations

from itertools import permutations
from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.errors import ChannelError
from hersey.log import exchanged as module

ROOT = Path(__file__).parents[2]
NAMES = {"torque": "Torque", "speed": "Speed", "temperature": "Temperature"}
UNITS = {"torque": "N*m", "speed": "rpm", "temperature": "degC"}
ORDERS = [dict(zip(NAMES, order, strict=True)) for order in permutations(NAMES)]


def bench() -> dict[str, np.ndarray]:
    table = pl.read_csv(ROOT / "examples" / "bench.csv", comment_prefix="#")
    columns = ["time", *NAMES]
    return {name: table.to_series(i).to_numpy()[::4] for i, name in enumerate(columns)}


def frame(order: dict[str, str]) -> pl.DataFrame:
    """The shipped log, the column of each role with the numbers of another."""
    numbers = bench()
    named = {f"{NAMES[role]} [{UNITS[role]}]": numbers[other] for role, other in order.items()}
    return pl.DataFrame({"Time [s]": numbers["time"]} | named)


@pytest.mark.parametrize("order", ORDERS, ids=lambda order: "-".join(order.values()))
def test_every_order_of_the_columns_is_found_and_mended(order: dict[str, str]) -> None:
    right = {role: role for role in NAMES}
    if order == right:
        hersey.read(frame(order))
        return
    with pytest.raises(ChannelError) as refused:
        hersey.read(frame(order))
    moved = {other: NAMES[role] for role, other in order.items() if role != other}
    advice = refused.value.remedy
    typed = advice[advice.index("channels=") : advice.index(". If")]
    said = eval(f"dict({typed})")
    assert said == {"channels": moved, "units": {role: UNITS[role] for role in moved}}
    mended, true = hersey.read(frame(order), **said).runs[0], hersey.read(frame(right)).runs[0]
    for role in NAMES:
        np.testing.assert_array_equal(getattr(mended, role), getattr(true, role))
    confirmed = {role: name for role, name in NAMES.items() if role != order[role]}
    hersey.read(frame(order), channels=confirmed)


@pytest.mark.parametrize("rising", [True, False])
@pytest.mark.parametrize("isothermal", [True, False])
def test_a_few_steps_without_or_at_one_temperature(rising: bool, isothermal: bool) -> None:
    """Three speeds after the first are enough; a torque that falls with speed changes nothing."""
    noise = np.random.default_rng(5).standard_normal((3, 1600))
    speed = np.repeat([20.0, 60.0, 180.0, 400.0], 400) * (1.0 + 1e-4 * noise[0])
    torque = 0.3 * speed ** (0.3 if rising else -0.3) * (1.0 + 0.01 * noise[1])
    held = {} if isothermal else {"Temperature [degC]": 90.0 + 0.1 * noise[2]}
    time = {"Time [s]": 0.05 * np.arange(speed.size)}
    hersey.read(
        pl.DataFrame(time | {"Torque [N*m]": torque, "Speed [rpm]": speed} | held), isothermal=isothermal
    )
    swapped = pl.DataFrame(time | {"Torque [N*m]": speed, "Speed [rpm]": torque} | held)
    with pytest.raises(ChannelError, match="swapped"):
        hersey.read(swapped, isothermal=isothermal)


def test_the_shipped_logs_are_not_doubted() -> None:
    for name in ("bench.csv", "no-load.csv"):
        log = hersey.read(ROOT / "examples" / name)
        assert module.exchanged(log.runs) == {}
