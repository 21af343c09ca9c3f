"""What goes the road of workers beside sweeps gives the bits of one process: folds, maps, campaigns, logs."""

from __future__ import annotations

import dataclasses
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hersey
from hersey.cli import campaign_reading, fitting_each
from hersey.cli.options import Reading
from hersey.errors import HerseyError, InsufficientDataError, ParameterError
from hersey.life.campaign import Entry
from hersey.scale.tasks import done, in_order
from tests.life.test_campaign import means
from tests.machines import map_of

ISOTHERMAL = Reading(isothermal=True)
TRAIN = hersey.Drivetrain(1000.0, 1.0, grip=200.0)
DRAG = hersey.Drag(50.0, 1.0, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
WARM = dataclasses.replace(
    DRAG, reference_temperature=400.0, force_temperature_exponent=-1.0, rest_force=2.0, rest_damping=0.1
)


@pytest.fixture
def logs(tmp_path: Path) -> list[Path]:
    files = [means(tmp_path / f"{number}.csv", 5.0 + number) for number in range(2)]
    (tmp_path / "0b.csv").write_text("no log at all\n")
    return [files[0], tmp_path / "0b.csv", files[1]]


@pytest.mark.parametrize(
    ("drag", "varied"),
    [
        (DRAG, {"stiffness": np.geomspace(300.0, 3000.0, 9), "mass": [0.5, 2.0]}),
        (DRAG, {"mixed_exponent": [-1.2, -0.6, -1.3], "lower": False}),
        (WARM, {"temperature": np.linspace(390.0, 420.0, 5), "mass": [0.5, 2.0, 3.0]}),
    ],
    ids=["grid", "a set that fails", "temperatures"],
)
def test_folds_by_workers_are_those_of_one_process(
    client: Any, drag: hersey.Drag, varied: dict[str, Any]
) -> None:
    seen: list[tuple[int, int]] = []
    alone = hersey.hysteresis_sweep(TRAIN, drag, **varied)
    worked = hersey.hysteresis_sweep(
        TRAIN, drag, **varied, work=hersey.Work(client=client, progress=lambda *counted: seen.append(counted))
    )
    assert alone.identical(worked)
    assert np.unique(alone.upper).size > 1 + len(alone.attrs["failures"])  # bands that can be told apart
    assert len(alone.attrs["failures"]) == ("mixed_exponent" in varied)
    sets = int(np.prod(list(alone.sizes.values())))
    assert seen[-1] == (sets, sets)


def test_a_value_out_of_range_has_its_place_among_all(client: Any) -> None:
    with pytest.raises(ParameterError) as alone:
        hersey.hysteresis_sweep(TRAIN, DRAG, mass=[1.0] * 40 + [-1.0])
    with pytest.raises(ParameterError) as worked:
        hersey.hysteresis_sweep(TRAIN, DRAG, mass=[1.0] * 40 + [-1.0], work=hersey.Work(client=client))
    assert (str(worked.value), worked.value.index) == (str(alone.value), alone.value.index)


def test_the_intervals_of_a_map_are_those_of_one_process(client: Any, surface: hersey.DampingSurface) -> None:
    ask = partial(
        map_of,
        surface,
        hersey.Drivetrain(11e3, 11.0),
        roll_radius=0.015,
        stick_speed=1.3e-3,
        uncertainty={"stick_speed": hersey.Uncertainty(0.3)},
        temperatures=[400.0, 420.0, 440.0],
        speeds=[0.02, 0.1],
        draws=9,
    )
    alone, worked = ask(), ask(client=client)
    for name in ("transition_interval", "upper_interval", "holding_interval"):
        assert getattr(alone, name).tobytes() == getattr(worked, name).tobytes()
    assert alone.to_dict() == worked.to_dict()


def test_a_campaign_read_by_workers_is_that_of_one_process(client: Any, logs: list[Path]) -> None:
    runs = [(log, '{"a": 1}') for log in logs]
    alone = list(campaign_reading.entries(ISOTHERMAL, runs, None))
    worked = list(campaign_reading.entries(ISOTHERMAL, runs, None, client))
    assert [isinstance(each, Entry) for each in alone] == [True, False, True]
    assert list(map(repr_of, worked)) == list(map(repr_of, alone))


def repr_of(each: Entry | HerseyError) -> Any:
    return dataclasses.asdict(each) if isinstance(each, Entry) else (type(each), str(each))


def test_rows_of_fits_are_those_of_one_process(client: Any, logs: list[Path]) -> None:
    task = partial(fitting_each.row, ISOTHERMAL, None)
    alone, worked = (list(in_order(done(task, logs[:2], client=who))) for who in (None, client))
    assert worked[0] == alone[0]
    assert (type(worked[1]), str(worked[1])) == (type(alone[1]), str(alone[1]))


def rows_but_short(log: hersey.TorqueLog) -> int:
    if log.rows < 20:
        raise InsufficientDataError("too short")
    return log.rows


def test_logs_read_by_workers_are_those_of_one_process(client: Any, tmp_path: Path) -> None:
    for number in range(4):
        rows = [f"{row / 10},{1 + row % 7},10,150" for row in range(10 + 10 * number)]
        head = "t [s],torque [mN*m],speed [rpm],temperature [degC]"
        (tmp_path / f"{number}.csv").write_text("\n".join([head, *rows]) + "\n")
    many, files = partial(hersey.read_many, tmp_path / "*.csv"), partial(map, lambda path: path.name)
    found = many(then=rows_but_short, client=client, keep_going=True)
    assert dict(zip(files(found), found.values(), strict=True)) == {"1.csv": 20, "2.csv": 30, "3.csv": 40}
    assert [str(error) for error in found.failures.values()] == [f"{tmp_path / '0.csv'}: too short"]
    whole, alone = many(client=client), many()
    for log, other in zip(whole.values(), alone.values(), strict=True):
        assert log.files == other.files
        assert log.runs[0].torque.tobytes() == other.runs[0].torque.tobytes()
