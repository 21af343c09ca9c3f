"""Dwells in logarithms: relative errors, references and clusters by hand from a table of steady points."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import polars as pl
import pytest

from hersey.damping.candidates.observations import Inputs, Observations
from hersey.damping.dwells import SteadyPoints
from hersey.errors import InsufficientDataError
from hersey.log.sensors import Sensors
from hersey.schema.domain import Domain

SPEED = [-10.0, 30.0, 20.0, 10.2, 30.2, 20.0, 10.0, 30.0, 30.1]
TORQUE = [-0.5, 0.4, 0.45, 0.52, 0.38, 0.41, 0.6, 0.35, 0.36]
HOT = [350.0, 352.0, 351.0, 400.0, 401.0, 402.0, 351.0, 350.5, 350.0]
RUN = [0, 0, 0, 0, 0, 0, 1, 1, 0]


def points(
    *,
    run: list[int] = RUN,
    temperature: bool = True,
    speed: list[float] = SPEED,
    hot: list[float] = HOT,
    heating: float = 0.0,
) -> SteadyPoints:
    """Steady points of a table by hand; what else a log holds is of no concern here."""
    table = pl.DataFrame(
        {
            "run": run,
            "speed": speed,
            "torque": TORQUE,
            "speed_error": np.linspace(0.01, 0.05, 9),
            "torque_error": np.linspace(0.001, 0.003, 9),
            "temperature": hot,
            "temperature_error": np.linspace(0.1, 0.5, 9),
        }
    )
    return SimpleNamespace(  # type: ignore[return-value]
        table=table,
        domain=Domain(),
        zero_errors=0.002 * np.column_stack([np.ones(9), np.linspace(-1.0, 1.0, 9)]),
        log=SimpleNamespace(
            has_temperature=temperature,
            sensors=Sensors(film_heating=heating),
            corrections=(),
            runs=(),
            files=(),
        ),
        temperature_rates=np.empty(0),
        rejected=(),
        of_every_sample=False,
        varying_load=None,
        column=lambda name: table[name].to_numpy(),
    )


def test_dwells_in_logarithms_by_hand() -> None:
    found = Observations.of(points())
    speed, torque, hot = np.abs(SPEED), np.abs(TORQUE), np.array(HOT)
    reference = np.prod(speed) ** (1 / 9)
    assert found.reference_speed == pytest.approx(reference, rel=1e-12)
    assert found.reference_kelvin == pytest.approx(9 / np.sum(1 / hot), rel=1e-12)
    assert found.inputs.log_speed == pytest.approx(np.log(speed / reference), abs=1e-14)
    assert found.inputs.kelvin == pytest.approx(hot, abs=0)
    assert found.speed == pytest.approx(speed, rel=1e-12)
    assert found.log_torque == pytest.approx(np.log(torque), abs=1e-14)
    assert found.torque_error == pytest.approx(np.linspace(0.001, 0.003, 9) / torque, rel=1e-12)
    assert found.speed_error == pytest.approx(np.linspace(0.01, 0.05, 9) / speed, rel=1e-12)
    assert found.temperature_error == pytest.approx(np.linspace(0.1, 0.5, 9), rel=1e-12)
    assert found.tare.shape == (9, 2)
    assert found.tare[:, 0] == pytest.approx(0.002 / np.array(TORQUE), rel=1e-12)
    assert found.tare[:, 1] == pytest.approx(0.002 * np.linspace(-1.0, 1.0, 9) / np.array(TORQUE), rel=1e-12)
    assert found.run.tolist() == RUN
    assert len(found) == 9
    # two groups of temperature, coldest first
    assert found.inputs.group.tolist() == [0, 0, 0, 1, 1, 1, 0, 0, 0]
    assert found.temperatures == pytest.approx([2104.5 / 6, 401.0], rel=1e-12)


def test_dwells_of_one_run_temperature_and_speed_are_a_level() -> None:
    found = Observations.of(points())
    assert found.clustered_by == "level"
    # 30.0, 30.1 at 351 K in run 0 are one; 10.0 there and in run 1 are not
    same = [[0], [1, 8], [2], [3], [4], [5], [6], [7]]
    assert sorted(np.flatnonzero(found.cluster == c).tolist() for c in np.unique(found.cluster)) == same


def test_speeds_three_per_cent_apart_are_two_levels() -> None:
    for step, clusters in ((1.0295, 2), (1.0315, 3)):
        speed = [10.0, 10.0 * step, 20.0, 20.0, 40.0, 40.0, 10.0, 20.0, 40.0]
        found = Observations.of(points(run=[0, 0, 0, 0, 0, 0, 0, 0, 0], speed=speed))
        cold = found.inputs.group == 0
        assert np.unique(found.cluster[cold & (found.speed < 25)]).size == clusters


def test_eight_runs_are_clusters_and_seven_are_not() -> None:
    eight = Observations.of(points(run=[0, 1, 2, 3, 4, 5, 6, 7, 7]))
    assert eight.clustered_by == "run"
    assert eight.cluster.tolist() == [0, 1, 2, 3, 4, 5, 6, 7, 7]
    seven = Observations.of(points(run=[0, 1, 2, 3, 4, 5, 6, 6, 1]))
    assert seven.clustered_by == "level"
    # of run 1 the dwells at 30 and 30.1 rad/s
    assert np.unique(seven.cluster).size == 8


def test_without_temperature_there_is_one_group() -> None:
    found = Observations.of(points(temperature=False))
    assert found.inputs.kelvin is None
    assert found.reference_kelvin is None
    assert found.temperatures.shape == (0,)
    assert found.inputs.group.tolist() == [0] * 9
    assert found.temperature_error.tolist() == [0.0] * 9
    at = found.at(np.array([10.0]), np.array([400.0]))
    assert at.kelvin is None


def test_two_speeds_are_refused_by_their_revolutions() -> None:
    speed = [10.0, 20.0, 10.1, 20.1, 10.0, 20.0, 10.0, 20.0, 20.0]
    said = r"^all dwells are at 95\.5 rpm and 96\.4 rpm\. Record dwells at three or more speeds$"
    with pytest.raises(InsufficientDataError, match=said):
        Observations.of(points(speed=speed))
    speed[0] = 40.0
    assert len(Observations.of(points(speed=speed))) == 9


def test_observations_are_taken_with_repeats() -> None:
    whole = Observations.of(points())
    index = np.array([4, 0, 4])
    some = whole.take(index)
    names = (
        "log_torque",
        "torque_error",
        "speed_error",
        "temperature_error",
        "tare",
        "visit",
        "run",
        "cluster",
    )
    for name in names:
        assert getattr(some, name).tolist() == getattr(whole, name)[index].tolist()
    assert some.inputs.log_speed.tolist() == whole.inputs.log_speed[index].tolist()
    assert whole.inputs.kelvin is not None
    assert some.inputs.kelvin is not None
    assert some.inputs.kelvin.tolist() == whole.inputs.kelvin[index].tolist()
    assert some.inputs.group.tolist() == [1, 0, 1]
    assert some.reference_speed == whole.reference_speed
    assert some.temperatures.tolist() == whole.temperatures.tolist()
    cold = Inputs(np.array([1.0, 2.0]), None, np.array([0, 1])).take(np.array([1]))
    assert cold.kelvin is None
    assert cold.log_speed.tolist() == [2.0]
    assert cold.group.tolist() == [1]


def test_other_speeds_and_temperatures_are_grouped_with_the_nearest_measured() -> None:
    data = replace(Observations.of(points()), temperatures=np.array([350.0, 370.0, 401.0]))
    found = data.at(np.array([5.0, 50.0, 500.0]), np.array([359.0, 361.0, 390.0]))
    expected = np.log(np.array([5.0, 50.0, 500.0]) / data.reference_speed)
    assert found.log_speed == pytest.approx(expected, abs=1e-14)
    assert found.group.tolist() == [0, 1, 2]
    assert found.kelvin is not None
    assert found.kelvin.tolist() == [359.0, 361.0, 390.0]
    one_heat = data.at(np.array([5.0, 50.0]), np.array(405.0))
    assert one_heat.kelvin is not None
    assert one_heat.kelvin.tolist() == [405.0, 405.0]
    assert one_heat.group.tolist() == [2, 2]
    none = data.at(np.array([5.0, 50.0]), None)
    assert none.kelvin is None
    assert none.group.tolist() == [0, 0]
    assert data.at(np.float64(5.0), None).log_speed.shape == (1,)  # type: ignore[arg-type]


def test_visits_are_stays_of_what_is_read_however_friction_heats_the_film() -> None:
    speed = [1.0, 90.0, 2.0, 80.0, 1.0, 90.0, 2.0, 80.0, 5.0]
    hot = [373.0, 373.1, 373.0, 373.1, 403.0, 403.1, 403.0, 403.1, 403.0]
    plain, warmed = (
        Observations.of(points(run=[0] * 9, speed=speed, hot=hot, heating=bound)) for bound in (0.0, 30.0)
    )
    assert plain.visit.tolist() == [0] * 4 + [1] * 5
    assert warmed.visit.tolist() == plain.visit.tolist()
    assert np.ptp(warmed.heating) > 5.0
