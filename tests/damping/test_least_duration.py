"""Speeds and temperatures that only the least duration asked for excludes: to follow its advice helps."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.errors import InsufficientDataError, speak
from hersey.inspection.support import support_of_points

SPEEDS, TEMPERATURES = (10.0, 20.0, 40.0, 80.0), (100.0, 130.0, 160.0)


def log(lasts: Callable[[float, float], float]) -> hersey.TorqueLog:
    """A staircase in speed at each temperature; ``lasts`` says how long, s, at rpm and degC."""
    random, rows = np.random.default_rng(4), []
    for hot in TEMPERATURES:
        for speed in SPEEDS:
            torque = 0.05 * speed**0.35 * (150.0 / hot) ** 0.8
            rows += [
                (torque * (1.0 + 0.002 * random.standard_normal()), speed, hot)
                for _ in range(int(10 * lasts(speed, hot)))
            ]
    torque, speed, hot = np.array(rows).T
    names = ("Torque [N*m]", "Speed [rpm]", "Temp [degC]")
    columns = {"Time [s]": 0.1 * np.arange(torque.size)} | dict(zip(names, (torque, speed, hot), strict=True))
    return hersey.read(pl.DataFrame(columns))


BY_SPEED = log(lambda speed, _: 40.0 if speed == 10.0 else 12.0)
BY_TEMPERATURE = log(lambda _, hot: 40.0 if hot == 100.0 else 12.0)


@pytest.mark.parametrize(
    ("recorded", "says", "last"),
    [
        (BY_SPEED, "all dwells are at 10 rpm: ", 3),
        (BY_TEMPERATURE, "all dwells are at one temperature (100.0 degC): ", 4),
    ],
)
def test_a_least_duration_that_leaves_too_little_is_named(
    recorded: hersey.TorqueLog, says: str, last: int
) -> None:
    points = recorded.steady(min_dwell=30.0)
    with pytest.raises(InsufficientDataError) as refused:
        hersey.fit(points)
    message = str(refused.value)
    advice = re.fullmatch(
        re.escape(f"{says}only {last} of 12 dwells last 30 s or more. Use a shorter least duration, e.g. ")
        + r"min_dwell=([\d.]+)",
        message,
    )
    assert advice, message
    assert any(message.partition(": ")[2] in cannot for cannot in support_of_points(points).cannot)
    again = recorded.steady(min_dwell=float(advice[1]))
    assert len(again) == 12
    assert hersey.fit(again).b is not None


def test_the_terminal_names_the_option() -> None:
    speak("terminal")
    try:
        with pytest.raises(InsufficientDataError, match=r"e\.g\. --min-dwell '[\d.]+ s'$"):
            hersey.fit(BY_SPEED.steady(min_dwell=30.0))
    finally:
        speak("python")


def test_a_log_at_one_speed_is_not_helped_by_a_shorter_duration() -> None:
    one = log(lambda speed, hot: 40.0 if (speed, hot) == (10.0, 100.0) else 0.0)
    says = r"at 10 rpm\. Record dwells at three or more speeds\. To follow friction over time"
    with pytest.raises(InsufficientDataError, match=says):
        hersey.fit(one.steady(min_dwell=30.0))


def test_a_temperature_that_never_changes_is_called_so() -> None:
    recorded = log(lambda *_: 12.0)
    [run] = recorded.runs
    dead = replace(recorded, runs=(replace(run, temperature=np.full(run.time.size, 298.15)),))
    said = (
        "all dwells are at one temperature (25.0 degC), so exponent b cannot be estimated: 'Temp' reads "
        "25 degC in every row, so the sensor may be dead. Check it and record again, or fit without b by "
        "isothermal=True"
    )
    with pytest.raises(InsufficientDataError, match=f"^{re.escape(said)}$"):
        hersey.fit(dead.steady())
    [cannot] = [each for each in support_of_points(dead.steady()).cannot if "exponent b" in each]
    assert "'Temp' reads 25 degC in every row, so the sensor may be dead" in cannot
    read = run.temperature
    assert read is not None
    held = 298.15 + 0.05 * np.sign(np.sin(np.arange(read.size)))
    alive = replace(recorded, runs=(replace(run, temperature=held),))
    with pytest.raises(InsufficientDataError, match=r"cannot be estimated\. Record other temperatures"):
        hersey.fit(alive.steady())
