"""Each detector finds what was put in and is silent on clean logs; what a log cannot tell is said."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

import hersey
from hersey import testbench
from hersey.errors import ChannelError, HerseyError, ParameterError, UnitError
from hersey.inspection import inspect
from hersey.inspection.faults import noise_of, traits
from hersey.log.clock import clock_of
from hersey.log.counters import quantisation_step
from hersey.log.mapping import FILE_NAME, read_mapping
from tests.cli.command import run
from tests.conftest import shared

SEEDS = range(20)
TIME, TORQUE, SPEED, TEMPERATURE = testbench.COLUMNS


@pytest.fixture(scope="module")
def benches() -> list[pl.DataFrame]:
    return [testbench.run(seed=seed).table for seed in SEEDS]


def kinds(values: np.ndarray, *, stands: bool = False) -> list[str]:
    return [fault.kind for fault in traits(values, stands=stands).faults]


def test_clean_logs_raise_no_alarm(benches: list[pl.DataFrame]) -> None:
    for table in benches:
        for name in (TORQUE, SPEED, TEMPERATURE):
            assert kinds(table[name].to_numpy(), stands=name == SPEED) == [], name


def test_lost_rows_are_counted_to_the_last(benches: list[pl.DataFrame]) -> None:
    for table in benches:
        clock = clock_of(TIME, table[TIME].to_numpy())
        rows = round((table[TIME][-1] - table[TIME][0]) / 0.05) + 1
        assert round(clock.lost / 0.05) == rows - table.height
        assert not clock.is_uneven
        assert (clock.back, clock.repeated) == (0, 0)


def test_what_the_stand_rounds_to_is_found(benches: list[pl.DataFrame]) -> None:
    for table in benches[:5]:
        assert traits(table[TORQUE].to_numpy()).step == pytest.approx(0.0005)
        assert traits(table[TEMPERATURE].to_numpy()).step == pytest.approx(0.01)
        assert traits(table[TEMPERATURE].to_numpy()).noise == pytest.approx(0.1, rel=0.05)


def test_injected_faults_are_found_in_every_log(benches: list[pl.DataFrame]) -> None:
    random = np.random.default_rng(4)
    for table in benches:
        torque, temperature = table[TORQUE].to_numpy(), table[TEMPERATURE].to_numpy()
        limit = float(np.quantile(torque, 0.97))
        (clipped,) = traits(np.minimum(torque, limit)).faults
        assert (clipped.kind, clipped.value) == ("clipped above", limit)
        assert clipped.rows > 0.8 * np.count_nonzero(torque >= limit)
        first = int(random.integers(2000, torque.size - 2000))
        frozen = torque.copy()
        frozen[first : first + 60] = frozen[first]
        (stuck,) = traits(frozen).faults
        assert stuck.kind == "stuck"
        assert abs(stuck.first - first) <= 1
        assert 60 <= stuck.rows <= 62
        lost = temperature.copy()
        places = 1000 * np.arange(1, 13)
        lost[places] = 0.0
        (gone,) = traits(lost).faults
        assert (gone.kind, gone.rows, gone.places, gone.first) == ("drop-outs", 12, 12, 1000)
        spiked = torque.copy()
        spiked[places] = 2.4e5
        (spikes,) = traits(spiked).faults
        assert (spikes.kind, spikes.rows, spikes.value) == ("spikes", 12, 2.4e5)


@pytest.mark.parametrize("step", [0.0005, 0.0032226, 0.1, 7.0])
@pytest.mark.parametrize("offset", [0.0, 0.4])
def test_quantisation_step(step: float, offset: float) -> None:
    random = np.random.default_rng(7)
    values = offset * step + step * np.round(30 * random.standard_normal(5000))
    found = quantisation_step(values)
    assert found is not None
    assert found == pytest.approx(step, rel=1e-3)
    assert quantisation_step(random.standard_normal(5000)) is None


def test_quantisation_step_behind_rounded_decimals() -> None:
    """A converter of 10 bits over 3.3 V, logged with three decimals."""
    random = np.random.default_rng(8)
    values = np.round(np.round(random.normal(700, 12, 4000)) * 3.3 / 1024, 3)
    found = quantisation_step(values)
    assert found is not None
    assert found == pytest.approx(3.3 / 1024, rel=0.02)


def test_noise_is_told_from_trend_and_waves() -> None:
    random = np.random.default_rng(9)
    t = np.arange(0.0, 100.0, 0.01)
    wave = 5 * np.sin(2 * np.pi * 0.2 * t) + 0.3 * t
    assert noise_of(wave + 0.02 * random.standard_normal(t.size)) == pytest.approx(0.02, rel=0.05)
    assert noise_of(np.arange(5.0)) is None


def held_levels(each: int, *levels: float) -> np.ndarray:
    return np.repeat(levels, each).astype(float)


HONEST = {
    "a set point": held_levels(300, 0, 5, 10, 20, 40, 20, 10, 5),
    "a trapezoid": np.concatenate([np.zeros(200), np.linspace(0, 100, 80), np.full(500, 100.0)]),
    "a speed in whole rpm": np.round(
        held_levels(400, 0, 30, 60) + np.random.default_rng(1).normal(0, 0.4, 1200)
    ),
    "a drive that stands": np.concatenate(
        [np.zeros(600), 50 + np.random.default_rng(2).standard_normal(2000)]
    ),
    "a coarse thermometer": np.round(np.linspace(20, 24, 3000)),
    "a sawtooth": np.tile(np.linspace(0.0, 1.0, 97), 30) + 1e-3 * np.random.default_rng(3).random(2910),
    "a ramp": np.linspace(0.0, 1.0, 500),
    "noise": np.random.default_rng(4).standard_normal(20_000),
    "heavy noise": np.random.default_rng(5).standard_t(4, 20_000),
    "a torque held at the limit of a motor": np.minimum(
        1.0, 0.5 + 0.3 * np.random.default_rng(7).standard_normal(400).repeat(50)
    )
    + 0.01 * np.random.default_rng(8).standard_normal(20_000).round(1),
    "a highest set point held again and again": held_levels(200, *[0, 20, 40, 60] * 5)
    + np.random.default_rng(9).integers(-2, 3, 4000),
    "a step": np.concatenate([np.zeros(500), np.ones(500)]) + 0.01 * np.random.default_rng(6).random(1000),
}


@pytest.mark.parametrize("case", HONEST)
def test_honest_channels_are_not_accused(case: str) -> None:
    assert kinds(HONEST[case], stands=True) == []


def test_clipping_on_both_rails_and_below() -> None:
    random = np.random.default_rng(11)
    wave = 3 * np.sin(np.arange(20_000) / 300) + 0.05 * random.standard_normal(20_000)
    assert kinds(np.clip(wave, -2.5, 2.5)) == ["clipped above", "clipped below"]
    assert kinds(np.round(np.clip(wave, -2.0, 99), 2)) == ["clipped below"]


def test_a_sensor_slower_than_the_log() -> None:
    random = np.random.default_rng(12)
    slow = np.repeat(150 + 0.1 * random.standard_normal(200), 20)
    found = traits(slow)
    assert found.refresh == 20
    assert found.faults == ()
    assert found.noise == pytest.approx(0.1, rel=0.2)
    assert traits(150 + random.standard_normal(4000)).refresh == 1


def test_missing_values_shift_no_row() -> None:
    random = np.random.default_rng(13)
    values = 1 + 0.1 * random.standard_normal(3000)
    values[[5, 6, 7, 100]] = np.nan
    values[200] = 50.0
    found = traits(values)
    assert found.missing == 4
    assert [(f.kind, f.first) for f in found.faults] == [("spikes", 200)]
    empty = traits(np.full(10, np.nan))
    assert (empty.missing, empty.faults) == (10, ())


def test_clock_faults() -> None:
    random = np.random.default_rng(14)
    even = np.arange(0.0, 200.0, 0.01)
    assert clock_of("t", even).warnings == ()
    assert clock_of("t", 1.5e9 + even).warnings == ()
    holes = np.delete(even, [*range(500, 520), 3000, *range(9000, 9003)])
    holed = clock_of("t", holes)
    assert (holed.gaps, round(holed.lost, 6), round(holed.longest_gap, 6)) == (3, 0.24, 0.21)
    back = even.copy()
    back[7000:] -= 3.0
    stepped = clock_of("t", back)
    assert (stepped.back, stepped.first_back) == (1, 7000)
    back = stepped.warnings[0]
    assert (back.kind, back.values) == ("time steps back", {"times": 1, "row": 7001})
    assert str(back) == "time steps back once, first at row 7001. Split or sort the file there"
    assert clock_of("t", even + 0.002 * random.uniform(-1, 1, even.size)).is_uneven
    coarse = clock_of("t", np.floor(np.arange(0.0, 60.0, 0.0117) / 0.01) * 0.01)
    assert not coarse.is_uneven
    assert coarse.gaps == 0
    stamped = clock_of("t", np.floor(even))
    assert stamped.repeated == even.size - 200


def test_the_example_log(root: Path) -> None:
    found = inspect(root / "examples" / "bench.csv")
    assert found.problem == ""
    assert found.support is not None
    assert found.support.dwells == 73
    assert [round(k - 273.15) for k in found.support.temperatures] == [90, 120, 150, 180]
    can = "; ".join(found.support.can)
    assert "exponent c (speed): 10 speeds, 5 to 140 rpm" in can
    assert "a transition: torque falls, then rises; it is lowest at 8.3 rpm [" in can
    (cannot,) = found.support.cannot
    assert "one exponent of speed: the local exponent of damping changes" in cannot  # with the rest
    assert found.support.rejected["stick-slip"] > 500
    assert {each.kind for each in found.channel_warnings} <= {"rows missing"}
    assert json.loads(json.dumps(found.to_dict()))["files"][0]["channels"][1]["traits"]["step"] == 0.0005


def thinned(tmp_path: Path, keep: pl.Expr, seed: int = 3) -> Path:
    path = tmp_path / "part.csv"
    testbench.run(seed=seed).table.filter(keep).write_csv(path)
    return path


def test_what_a_poor_log_cannot_tell(tmp_path: Path) -> None:
    one_speed = thinned(tmp_path, pl.col(SPEED).is_between(29, 31))
    support = inspect(one_speed).support
    assert support is not None
    assert any(said.startswith("exponent c (speed): one speed") for said in support.cannot)
    cold = thinned(tmp_path, pl.col(TEMPERATURE).is_between(89, 91) & (pl.col(SPEED) > 11))
    support = inspect(cold).support
    assert support is not None
    assert any("exponent b (temperature): all dwells are at 90 degC" in said for said in support.cannot)
    assert any("torque rises from 14 rpm on" in said for said in support.cannot)
    assert any("a tare: the drive never stands" in said for said in support.cannot)


def test_missing_numbers_and_temperature_say_which_flag_helps(tmp_path: Path) -> None:
    table = testbench.run(seed=2).table.head(4000)
    holes = table.with_columns(pl.when(pl.int_range(pl.len()) % 25 != 17).then(pl.col(TORQUE)))
    path = tmp_path / "holes.csv"
    holes.drop(TEMPERATURE).write_csv(path)
    found = inspect(path)
    assert found.needed == ("isothermal", "drop_missing")
    assert found.dropped == {"holes.csv": 160}
    assert f"{path.name}: Drive torque: a number is missing in 160 rows" in map(str, found.channel_warnings)
    assert "this log can be read with isothermal=True and drop_missing=True" in found.summary()


def test_a_log_whose_time_steps_back_is_shown_all_the_same(tmp_path: Path) -> None:
    table = testbench.run(seed=2).table.head(3000)
    path = tmp_path / "twice.csv"
    pl.concat([table, table.tail(2000)]).write_csv(path)
    found = inspect(path)
    assert "the rows from line 3002 to line 5001 repeat those from line 1002 to line 3001" in found.problem
    assert found.support is None
    back = {each.kind: each for each in found.channel_warnings}["time steps back"]
    assert back.values == {"times": 1, "row": 3001}


def test_a_clock_that_starts_anew_is_shown_with_its_runs(tmp_path: Path) -> None:
    first, second = (testbench.run(seed=seed).table.head(3000) for seed in (2, 3))
    pl.concat([first, second]).write_csv(tmp_path / "anew.csv")
    found = inspect(tmp_path / "anew.csv")
    assert found.support is not None
    assert "run 2 of 2 in anew.csv begins at line 3002" in found.summary()


def test_a_log_pasted_twice_into_one_file_supports_no_fit(tmp_path: Path) -> None:
    table = testbench.run(seed=2).table.head(3000)
    pl.concat([table, table]).write_csv(tmp_path / "twice.csv")
    found = inspect(tmp_path / "twice.csv")
    assert found.support is None
    assert "the rows from line 3002 to line 6001 repeat those from line 2 to line 3001" in found.summary()


def test_a_time_without_a_unit_is_not_called_missing(tmp_path: Path) -> None:
    table = testbench.run(seed=2).table.head(3000)
    table.rename({"Time [s]": "Time"}).write_csv(tmp_path / "log.csv")
    summary = inspect(tmp_path / "log.csv").summary()
    assert "column 'Time' has no unit" in summary
    assert "no time column" not in summary


def test_torque_in_volts_is_named_with_what_one_volt_is(tmp_path: Path) -> None:
    table = testbench.run(seed=2).table.head(3000).rename({"Drive torque [N*m]": "CH1 [V]"})
    table.write_csv(tmp_path / "log.csv")
    typed = "channels={'torque': 'CH1'} and give the torque per V, e.g. units={'torque': '2 N*m/V'}"
    assert typed in inspect(tmp_path / "log.csv").summary()
    with pytest.raises(ChannelError, match=re.escape(typed)):
        hersey.read(tmp_path / "log.csv")
    log = hersey.read(tmp_path / "log.csv", channels={"torque": "CH1"}, units={"torque": "2 N*m/V"})
    assert log.runs[0].torque == pytest.approx(2.0 * table["CH1 [V]"].to_numpy())


def test_a_row_left_out_is_shown_with_line_and_column(tmp_path: Path) -> None:
    lines = testbench.run(seed=2).table.head(3000).write_csv().splitlines()
    lines[100] = lines[100].replace(lines[100].split(",")[1], "OVERFLOW")
    (tmp_path / "log.csv").write_text("\n".join([*lines, ""]))
    found = inspect(tmp_path / "log.csv")
    assert found.dropped == {"log.csv": 1}
    assert "excluded: line 101, column 'Drive torque': 'OVERFLOW' is not a number" in found.summary()


def test_couette_cell_without_torque() -> None:
    folder = shared("data/friction/couette_rheometer_pi")
    for name in ("rheometry_test_glyc_0_081117_1416.csv", "rheometry_test_solA2_281117_1358.csv"):
        found = inspect(folder / name)
        (file,) = found.files
        own = {channel.name: channel for channel in file.channels}
        assert f"{name} has no torque channel" in found.summary()
        assert file.lacking["torque"].absent
        assert file.without["torque"] == "there is no torque channel"
        dead = [c.name for c in file.channels if any(f.kind == "constant" for f in c.traits.faults)]
        assert dead == ["spd2", "spd3", "spd4", "spd5"]
        (spikes,) = own["spd0"].traits.faults
        assert spikes.kind == "spikes"
        assert spikes.value > 2e5
        assert file.clocks[0].is_uneven
        assert own["Vcr"].traits.step == pytest.approx(3.3 / 1024, rel=0.01)
    for name, rows in (("empty_vsweep.csv", 83), ("water_vsweep.csv", 76)):
        (file,) = inspect(folder / name).files
        (fault,) = next(c for c in file.channels if c.name == "T").traits.faults
        assert (fault.kind, fault.rows) == ("drop-outs", rows)
        assert not file.clocks[0].is_uneven


def test_other_formats_are_shown_channel_by_channel() -> None:
    (file,) = inspect(shared("data/daq-formats/tdms") / "Digital_Input.tdms").files
    assert [round(clock.interval, 6) for clock in file.clocks] == [0.0005, 0.025, 1.25]
    assert file.rows == 20_000
    assert "time" not in file.lacking
    for path in sorted(shared("data/daq-formats/mf4-bus").glob("*.MF4")):
        found = inspect(path)
        assert found.files[0].channels == ()
        assert "bus frames" in found.summary()
    slider = inspect(shared("data/stick-slip") / "k1002Nm_v1100.mat")
    assert "has no torque channel" in slider.summary()
    assert [c.warnings for c in slider.files[0].channels if c.name == "Fnorm"] == [()]


def test_wear_tests_and_a_dynamometer() -> None:
    for path in sorted(shared("data/friction/te67_pin_on_disc").glob("*.tsv")):
        found = inspect(path)
        assert "the time column could be 'Time [s]' or 'Test Time'" in found.summary()
        (made,) = [c.role for c in found.files[0].channels if c.name == "Friction Coefficient"]
        assert made == "torque"  # of two columns 'Friction Force' it is not said which
        assert found.files[0].clocks[0].interval == 1.0
        flagged = {c.name for c in found.files[0].channels for f in c.traits.faults if f.kind == "stuck"}
        assert flagged == set()
    (dyno,) = inspect(shared("data/friction/odrive_motor_dyno/odrive_data.csv")).files
    assert dyno.clocks == ()
    assert "is not a unit of speed" in dyno.without["speed"]


def test_screw_drives_together_can_tell_what_each_alone_cannot() -> None:
    paths = sorted(shared("data/friction/tro2021_screw_drives/driveNo1/steady_state").glob("*.csv"))
    found = inspect(paths, units={"torque": "9.84 mN*m / 100"}, rotation="reverse")  # signs are opposite
    assert found.needed == ("isothermal",)
    assert found.support is not None
    assert found.support.speeds == 15
    assert any("torque falls, then rises" in said for said in found.support.can)
    assert {each.kind for each in found.channel_warnings} <= {"coarse"}
    alone = inspect(paths[5], units={"torque": "9.84 mN*m / 100"}).support
    assert alone is not None
    assert any("exponent c (speed): one speed" in said for said in alone.cannot)


def test_the_command(examples_here: Path) -> None:
    result = run("inspect", "examples/bench.csv", "--figure", "channels.svg", cwd=examples_here)
    assert result.returncode == 0, result.stderr
    assert "73 dwells" in result.stdout
    assert (examples_here / "channels.svg").read_text().startswith("<svg")
    again = run("inspect", "examples/bench.csv", "--figure", "channels.svg", cwd=examples_here)
    assert again.returncode == 2
    assert "exists: use --force" in again.stderr
    document = json.loads(run("inspect", "examples/bench.csv", "--json", cwd=examples_here).stdout)
    assert document["support"]["dwells"] == 73
    assert document["files"][0]["clocks"][0]["warnings"]


def test_the_mapping_is_proposed_once_and_never_replaced(bench_csv: Path, tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    log.write_bytes(bench_csv.read_bytes())
    first = run("inspect", "log.csv", "--save-mapping", cwd=tmp_path)
    assert first.returncode == 0, first.stderr
    assert first.stdout.splitlines()[-1] == FILE_NAME
    kept = tmp_path / FILE_NAME
    assert read_mapping(kept).channels["torque"] == "Drive torque"
    kept.write_text('[torque]\ntare = "3 mN*m"\n')
    second = run("inspect", "log.csv", "--save-mapping", cwd=tmp_path)
    assert second.returncode == 2
    assert "exists: use --force" in second.stderr
    assert kept.read_text() == '[torque]\ntare = "3 mN*m"\n'
    assert "Corrected: tare (torque 0.003 N m)" in run("inspect", "log.csv", cwd=tmp_path).stdout
    kept.write_text("[torque]\ntar = 1\n")
    wrong = run("inspect", "log.csv", cwd=tmp_path)
    assert wrong.returncode == 2
    assert f"{FILE_NAME}, line 2: [torque] has an unknown key 'tar'" in wrong.stderr


def test_what_is_no_log_is_refused(tmp_path: Path) -> None:
    (tmp_path / "words.csv").write_text("nothing but words\nand more of them\n")
    with pytest.raises(HerseyError, match=r"words\.csv"):
        inspect(tmp_path / "words.csv")
    result = run("inspect", "none.csv", cwd=tmp_path)
    assert result.returncode == 2
    assert "File not found" in result.stderr


def test_a_word_that_inspect_does_not_know_is_named(root: Path) -> None:
    with pytest.raises(
        ParameterError, match=r"inspect has no argument 'isotermal'. Did you mean isothermal\?"
    ):
        inspect(root / "examples" / "bench.csv", isotermal=True)  # type: ignore[call-arg]
    given = {"radius": "15 mm"}
    with pytest.raises(UnitError, match="every: "):
        inspect(root / "examples" / "bench.csv", every="20 mm")  # type: ignore[arg-type]
    assert inspect(root / "examples" / "bench.csv", **given).support is not None  # type: ignore[arg-type]


def test_a_doubtful_unit_is_told_of_logs_and_of_tables_of_means(tmp_path: Path) -> None:
    """Also where no dwell is left to fit; a spike is no unit."""
    rows = [f"{0.05 * i:.2f},{1 + i / 1e4},{60 + 10 * (i // 400)},{150 + i / 1e3}" for i in range(2000)]
    log, heading = tmp_path / "log.csv", "time [s],torque [N*m],speed [rpm],temp"
    log.write_text("\n".join([f"{heading} [degC]", *rows[:900], "45,1,80,900", *rows[901:]]))
    ordered, one_way = inspect(log).warnings[:2]
    assert one_way.sentence.startswith("Speeds were approached only from below")
    assert ordered.sentence.startswith("Speed and time changed together")
    kelvin = [f"{row.rsplit(',', 1)[0]},{float(row.rsplit(',', 1)[1]) + 273.15:.3f}" for row in rows]
    log.write_text("\n".join([f"{heading} [degC]", *kelvin]))
    unit, *others = inspect(log).warnings
    without_a_spike = [each.sentence for each in (ordered, one_way)]
    assert [each.sentence for each in others] == without_a_spike
    assert unit.kind == "unit of temperature doubtful"
    assert unit.values["temperature"] == pytest.approx(425.13 + 273.15, abs=0.02)
    assert unit.sentence.startswith("Temperature reaches 425 degC")
    assert f"\n! {unit.sentence}\n" in inspect(log).summary()
    assert [each.sentence for each in inspect(log, units={"temperature": "K"}).warnings] == without_a_spike
    log.write_text("\n".join(["time [s],torque [N*m],speed [rpm]", *(f"{50 * i},1,{i}" for i in range(200))]))
    seen = inspect(log, isothermal=True)
    assert seen.support is not None
    assert seen.support.dwells == 0
    assert (seen.warnings[0].kind, seen.warnings[0].values["interval"]) == ("unit of time doubtful", 50)
    assert seen.warnings[0].sentence == (
        "The clock gives one row every 50 s, which is unusually slow. "
        "If it counts milliseconds, use units={'time': 'ms'}."
    )
    stated = inspect(log, isothermal=True, every=50.0).warnings[0]
    assert stated.sentence == (
        "Rows are 50 s apart (every), which is unusually slow. If that is milliseconds, use every='50 ms'."
    )
    assert "unit of time doubtful" not in {
        each.kind for each in inspect(log, isothermal=True, every="50 ms").warnings
    }
    log.write_text("speed [rpm],torque [N*m],temp [degC]\n10,1,420\n20,1.1,421\n30,1.3,422\n")
    assert inspect(log, means=True).warnings[0].sentence.startswith("Temperature reaches 422 degC")


@pytest.mark.parametrize(
    ("given", "named"),
    [({"gear_ratio": 10.0}, "gear_ratio"), ({"name_pattern": "{speed} rpm.csv"}, "name_pattern")],
)
def test_what_a_table_of_means_cannot_take_is_a_problem_as_in_a_fit(
    given: dict[str, Any], named: str, tmp_path: Path
) -> None:
    table = tmp_path / "means.csv"
    table.write_text("speed [rpm],torque [N*m]\n10,1\n20,1.1\n30,1.3\n")
    assert inspect(table, means=True).problem == ""
    refused = inspect(table, means=True, **given)
    assert refused.support is None
    assert refused.problem.endswith(f"omit {named}")


@pytest.mark.parametrize(("rows", "found"), [(2, ["drop-outs"]), (5, ["drop-outs"]), (6, []), (12, [])])
def test_a_speed_lost_for_a_few_rows_is_a_drop_out_and_a_longer_one_a_stand(
    rows: int, found: list[str]
) -> None:
    speed = 50.0 + 0.1 * np.random.default_rng(1).standard_normal(1000)
    speed[400 : 400 + rows] = 0.0
    assert kinds(speed, stands=True) == found


def test_the_row_of_a_fault_is_counted_from_one(tmp_path: Path) -> None:
    table = testbench.run(seed=2).table.head(3000)
    name = next(each for each in table.columns if "torque" in each.lower())
    torque = table[name].to_numpy().copy()
    torque[1000] = 50.0 * np.max(np.abs(torque))
    table.with_columns(pl.Series(name, torque)).write_csv(tmp_path / "log.csv")
    (file,) = inspect(tmp_path / "log.csv").files
    (spike,) = (w for c in file.channels for w in c.warnings if w.kind == "spikes")
    assert (spike.severity, spike.values["row"], spike.values["rows"]) == ("watch", 1001, 1)
    assert "from row 1001" in str(spike)


SPEEDS = [10, 10, 20, 20, 40, 40, 80, 80]
HELD = [(50.0 * step, rpm, 30.0 + 20.0 * (step % 2)) for step, rpm in enumerate(SPEEDS)]
ROWS = [(t + i, 0.1 * rpm**0.3, float(rpm), hot) for t, rpm, hot in HELD for i in range(50)]


def log_of(path: Path, temperature: str, cells: str, *more: str) -> Path:
    """A log whose temperature is written as ``cells`` say, and further columns with it."""
    head = ",".join(["Time [s]", "Torque [N*m]", "Speed [rpm]", temperature, *more])
    rows = [
        ",".join([f"{t:g},{torque:.4f},{rpm:g}", *[cells.format(hot + 0.1 * (t % 3))] * (1 + len(more))])
        for t, torque, rpm, hot in ROWS
    ]
    path.write_text("\n".join([head, *rows]) + "\n")
    return path


@pytest.mark.parametrize(
    ("header", "remedy", "mended"),
    [
        ("Temp [degC]", "Write only numbers in the cells", "Temp [degC]"),
        (
            "Temp",
            "Write the unit in the header, 'Temp [°C]', and only numbers in the cells",
            "Temp [°C]",
        ),
    ],
)
def test_a_temperature_with_its_unit_in_the_cells_is_named(
    tmp_path: Path, header: str, remedy: str, mended: str
) -> None:
    file = log_of(tmp_path / "log.csv", header, "{:.2f} °C")
    found = inspect(file)
    assert found.files[0].without == {
        "temperature": f"column 'Temp': the cells hold units, e.g. '30.00 °C'. {remedy}"
    }
    assert found.support is not None
    assert "any dependence on temperature: the temperature column of log.csv cannot be used" in (
        found.support.cannot
    )
    assert "isothermal" not in found.summary()
    with pytest.raises(HerseyError) as refused:
        hersey.read(file, units={"temperature": "degC"})
    assert str(refused.value) == (
        "log.csv, line 2, column 'Temp': the cell holds its unit, '30.00 °C' (the first of 400 such rows, "
        f"of 400). {remedy}"
    )
    seen = inspect(log_of(file, mended, "{:.2f}"))
    assert seen.files[0].without == {}
    assert hersey.read(file).has_temperature


def test_of_two_temperatures_one_is_to_be_chosen(tmp_path: Path) -> None:
    file = log_of(tmp_path / "log.csv", "Heater temperature [degC]", "{:.2f}", "Roll temperature [degC]")
    found = inspect(file)
    assert found.support is not None
    why = "any dependence on temperature: the temperature column of log.csv cannot be used"
    assert why in found.support.cannot
    assert "isothermal" not in found.summary()
    assert "choose one with" in found.files[0].without["temperature"].lower()
    excluded = inspect(file, isothermal=True).support
    assert excluded is not None
    assert "any dependence on temperature: isothermal=True excludes it" in excluded.cannot
    assert inspect(file, channels={"temperature": "Roll temperature"}).files[0].without == {}
    shown = run("inspect", file.name, cwd=tmp_path).stdout
    assert "--isothermal" not in shown
