"""A mapping is proposed once, checked to the last key, and used for the next log without a question."""

from __future__ import annotations

import doctest
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.errors import ChannelError, MissingFileError, ParameterError, UnitError
from hersey.log import mapping as log_mapping
from hersey.log import proposal
from hersey.log.mapping import FILE_NAME, find_mapping, read_mapping, read_with_mapping
from hersey.log.proposal import propose_mapping
from tests.conftest import shared

TIME = np.arange(0.0, 20.0, 0.05)


def write(path: Path, header: str, *columns: np.ndarray | float) -> Path:
    full = [np.broadcast_to(c, TIME.shape) for c in (TIME, *columns)]
    rows = [",".join(repr(float(v)) for v in row) for row in zip(*full, strict=True)]
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


def test_a_proposal_reads_the_log_it_was_made_for(bench_csv: Path, tmp_path: Path) -> None:
    file = tmp_path / FILE_NAME
    file.write_text(propose_mapping(bench_csv))
    mapping = read_mapping(file)
    assert mapping.channels == {
        "time": "Time",
        "torque": "Drive torque",
        "speed": "Drive speed",
        "temperature": "Heater temperature",
    }
    done = read_with_mapping(bench_csv, mapping=file)
    plain = hersey.read(bench_csv)
    assert done.corrections == ()
    np.testing.assert_array_equal(done.log.runs[0].torque, plain.runs[0].torque)
    (warning,) = done.log.files[0].warnings
    assert (warning.kind, warning.values) == ("mapping used", {"mapping": FILE_NAME})
    assert str(warning) == f"channels, units and corrections come from {FILE_NAME}"


def test_every_comment_of_a_proposal_becomes_a_key_that_is_known(bench_csv: Path, tmp_path: Path) -> None:
    text = propose_mapping(bench_csv)
    said = text.replace('unit = "N*m"', 'unit = "mA"').splitlines()
    keys = [line[2:] if line.startswith("# ") and " = " in line else line for line in said]
    keys = [line for line in keys if not line.startswith("#")]
    (tmp_path / FILE_NAME).write_text("\n".join(keys))
    mapping = read_mapping(tmp_path / FILE_NAME)
    assert mapping.torque.motor_constant == pytest.approx(0.035)
    assert mapping.torque.inertia == pytest.approx(2e-4)
    assert mapping.temperature.offset == -1.5
    assert mapping.speed.sign == -1


def test_what_cannot_be_told_is_said_in_the_proposal(tmp_path: Path) -> None:
    path = write(tmp_path / "odd.csv", "t [s],Torque 1 [N*m],Torque 2 [N*m],Drehzahl", 1.0, 2.0, 3.0)
    text = propose_mapping(path)
    assert "# the torque column could be 'Torque 1 [N*m]' or 'Torque 2 [N*m]'" in text
    assert "# column 'Drehzahl' has no unit" in text
    text = propose_mapping(path, channels={"torque": "Torque 2"}, units={"speed": "-1 rpm"})
    assert 'channel = "Torque 2"' in text
    assert 'unit = "-1 rpm"' in text
    (tmp_path / FILE_NAME).write_text(text)
    done = read_with_mapping(path, isothermal=True)
    assert done.log.runs[0].torque[0] == 2.0
    assert done.log.runs[0].speed[0] == pytest.approx(-np.pi / 10)


def test_the_next_log_is_read_unattended(tmp_path: Path) -> None:
    header = "t [s],A [N*m],B [N*m],n [rpm]"
    first = write(tmp_path / "monday.csv", header, 0.5, 7.0, 60.0)
    second = write(tmp_path / "tuesday.csv", header, 0.75, 7.0, 90.0)
    with pytest.raises(ChannelError):
        read_with_mapping(second, isothermal=True)
    (tmp_path / FILE_NAME).write_text('[torque]\nchannel = "A"\ntare = "50 mN*m"\n')
    done = read_with_mapping([first, second], isothermal=True)
    assert [run.torque[0] for run in done.log.runs] == pytest.approx([0.45, 0.7])
    assert [record.name for record in done.corrections] == ["tare"]
    own = tmp_path / "tuesday.hersey.toml"
    own.write_text('[torque]\nchannel = "B"\n')
    assert find_mapping(second) == own
    assert find_mapping(first) == tmp_path / FILE_NAME
    assert read_with_mapping(second, isothermal=True).log.runs[0].torque[0] == 7.0
    with pytest.raises(ParameterError, match="different mappings"):
        read_with_mapping([first, second], isothermal=True)
    chosen = read_with_mapping([first, second], mapping=own, isothermal=True)
    assert [run.torque[0] for run in chosen.log.runs] == [7.0, 7.0]
    by_hand = read_with_mapping(first, channels={"torque": "B"}, isothermal=True)
    assert by_hand.log.runs[0].torque[0] == pytest.approx(6.95)


FULL = """
[time]
channel = "t"
unit = "ms"
[torque]
channel = "I motor"
unit = "mA"
sign = -1
motor_constant = "35 mN*m/A"
tare = "1 mN*m"
no_load = "2 mN*m"
gear_ratio = 12.5
efficiency = 0.8
[speed]
channel = "n"
unit = "rpm"
gear_ratio = 12.5
[temperature]
channel = "T film"
unit = "degF"
offset = "-1.5 K"
"""


def test_every_correction_of_a_mapping_is_made_in_its_order(tmp_path: Path) -> None:
    path = write(tmp_path / "motor.csv", "t,I motor,n,T film", -3000.0, 250.0, 302.0)
    (tmp_path / FILE_NAME).write_text(FULL)
    done = read_with_mapping(path)
    run = done.log.runs[0]
    assert run.torque[5] == pytest.approx((0.105 - 0.001 - 0.002) * 12.5 * 0.8)
    assert run.speed[5] == pytest.approx(20 * np.pi / 30)
    assert run.temperature is not None
    assert run.temperature[5] == pytest.approx(150 + 273.15 - 1.5)
    assert run.time[-1] == pytest.approx(TIME[-1] / 1000)
    names = [record.name for record in done.corrections]
    assert names == ["torque from current", "sign", "tare", "no-load torque", "gears", "temperature offset"]
    used = {channel.role: channel.unit for channel in done.log.files[0].channels}
    assert used["torque"] == "mA"


def test_a_no_load_log_beside_the_mapping_is_subtracted(tmp_path: Path) -> None:
    header = "t [s],Torque [N*m],n [rad/s],Temp [degC]"
    write(tmp_path / "free.csv", header, -0.1, 5.0, 25.0)
    path = write(tmp_path / "bench.csv", header, -0.5, 5.0, 150.0)
    text = '[torque]\nchannel = "Torque"\nsign = -1\nno_load = "free.csv"\n[temperature]\nchannel = "Temp"\n'
    (tmp_path / FILE_NAME).write_text(text)
    done = read_with_mapping(path)
    np.testing.assert_allclose(done.log.runs[0].torque, 0.4)
    np.testing.assert_allclose(read_with_mapping(path, isothermal=True).log.runs[0].torque, 0.4)
    assert "dwells of free.csv" in str(done.corrections[-1])


def test_a_no_load_log_is_read_by_the_schedule_of_its_mapping(tmp_path: Path) -> None:
    steps = '[[schedule]]\nfrom = "0 s"\nto = "20 s"\nspeed = "60 rpm"\n'
    write(tmp_path / "free.csv", "t [s],Torque [N*m]", 0.1)
    path = write(tmp_path / "5 N.csv", "t [s],Torque [N*m]", 0.5)
    text = '[torque]\nno_load = "free.csv"\n[names]\npattern = "{load} N.csv"\n'
    (tmp_path / FILE_NAME).write_text(text + steps)
    np.testing.assert_allclose(read_with_mapping(path, isothermal=True).log.runs[0].torque, 0.4)


def test_a_no_load_log_is_read_by_the_names_of_its_mapping(tmp_path: Path) -> None:
    write(tmp_path / "free_60 rpm.csv", "t [s],Torque [N*m]", 0.1)
    path = write(tmp_path / "film_60 rpm.csv", "t [s],Torque [N*m]", 0.5)
    text = '[torque]\nno_load = "free_60 rpm.csv"\n[names]\npattern = "*_{speed} rpm.csv"\n'
    (tmp_path / FILE_NAME).write_text(text)
    np.testing.assert_allclose(read_with_mapping(path, isothermal=True).log.runs[0].torque, 0.4)


def test_a_no_load_log_is_read_by_the_layout_of_its_mapping(tmp_path: Path) -> None:
    header = "a,b,c\nt [s],Torque [N*m],n [rpm]\nx,y,z"
    write(tmp_path / "free.csv", header, 0.1, 5.0)
    path = write(tmp_path / "film.csv", header, 0.5, 5.0)
    text = '[torque]\nno_load = "free.csv"\n[layout]\nheader_line = 2\nfirst_row = 4\n'
    (tmp_path / FILE_NAME).write_text(text)
    np.testing.assert_allclose(read_with_mapping(path, isothermal=True).log.runs[0].torque, 0.4)


def test_a_zero_error_in_newton_metres_is_none_of_a_friction_force(tmp_path: Path) -> None:
    path = write(tmp_path / "wear.csv", "t [s],Friction force [N],v [mm/s]", 5.0, 20.0)
    (tmp_path / FILE_NAME).write_text('[torque]\nzero_error = "0.1 N*m"\n')
    with pytest.raises(ParameterError, match=r"^\[torque\] zero_error needs a torque, .* a friction force"):
        read_with_mapping(path, isothermal=True)
    done = read_with_mapping(path, isothermal=True, radius=0.025)
    assert done.log.sensors.torque_zero == 0.1


BAD = {
    "a table that is not known": ('[torqe]\nchannel = "x"\n', "unknown table 'torqe'"),
    "a key that is not known": ('[torque]\ngear = 2\n', r"\[torque\] has an unknown key 'gear'"),
    "a key of another role": ('[speed]\ntare = "1 N*m"\n', r"\[speed\] has an unknown key 'tare'"),
    "a role that is no table": ('torque = "x"\n', r"Write \[torque\]"),
    "an empty channel": ('[torque]\nchannel = ""\n', "torque.channel is empty"),
    "a number as channel": ("[torque]\nchannel = 3\n", "torque.channel is 3"),
    "a sign of two": ("[torque]\nsign = 2\n", "torque.sign is 2: it must be 1 or -1"),
    "a sign that is true": ("[torque]\nsign = true\n", "torque.sign is True"),
    "a gear ratio in words": ('[speed]\ngear_ratio = "12:1"\n', "speed.gear_ratio is '12:1', not a number"),
    "a gear ratio of nothing": ("[speed]\ngear_ratio = 0\n", "speed.gear_ratio is 0"),
    "an efficiency over one": ("[torque]\nefficiency = 1.1\n", "it must be within 0.05 to 1"),
    "a not-a-number": ("[torque]\nefficiency = nan\n", "torque.efficiency is nan"),
}  # fmt: skip
BAD_UNITS = {
    "a tare without unit": ("[torque]\ntare = 0.004\n", "torque.tare is 0.004, without a unit"),
    "a tare in rpm": ('[torque]\ntare = "4 rpm"\n', "torque.tare: unit 'rpm' is not a unit of torque"),
    "an unknown unit": ('[speed]\nunit = "furlong"\n', "speed.unit"),
    "a current without constant": ('[torque]\nunit = "A"\n', "If it is a motor current, set motor_constant"),
    "a constant of a torque": ('[torque]\nunit = "N*m"\nmotor_constant = "1 N*m/A"\n', "unit of current"),
    "a constant in N m": ('[torque]\nunit = "A"\nmotor_constant = "1 N*m"\n', "motor_constant is '1 N"),
    "an offset in degC": ('[temperature]\noffset = "2 degC"\n', "e.g. \"-1.5 K\""),
    "an offset without unit": ("[temperature]\noffset = 2\n", "temperature.offset is 2"),
    "code for a unit": ('[torque]\ninertia = "1 __import__(os)"\n', "torque.inertia"),
    "a tower of powers": ('[torque]\ninertia = "1 kg**9**9**9"\n', "torque.inertia"),
}  # fmt: skip


@pytest.mark.parametrize("case", [*BAD, *BAD_UNITS])
def test_what_is_wrong_is_named_with_file_and_key(case: str, tmp_path: Path) -> None:
    text, says = {**BAD, **BAD_UNITS}[case]
    path = tmp_path / "bench.hersey.toml"
    path.write_text(text)
    with pytest.raises(UnitError if case in BAD_UNITS else ParameterError, match=says) as caught:
        read_mapping(path)
    assert "bench.hersey.toml" in str(caught.value)


def test_a_log_without_the_channels_of_its_mapping_names_the_mapping(tmp_path: Path) -> None:
    path = write(tmp_path / "log.csv", "t [s],Torque [N*m],n [rpm]", 1.0, 2.0)
    (tmp_path / FILE_NAME).write_text('[torque]\nchannel = "Tq"\n')
    with pytest.raises(ChannelError, match=r"no column 'Tq'.*come from hersey.toml"):
        read_with_mapping(path, isothermal=True)
    (tmp_path / FILE_NAME).write_text('[torque]\nno_load = "gone.csv"\n')
    with pytest.raises(ParameterError, match=r"torque\.no_load is 'gone\.csv'"):
        read_with_mapping(path, isothermal=True)
    with pytest.raises(MissingFileError):
        read_mapping(tmp_path / "none.toml")


FRICTION = "row,Friction force [N],v [mm/s],Fn [N]"


def test_radius_load_and_interval_in_a_mapping(tmp_path: Path) -> None:
    path = write(tmp_path / "wear.csv", FRICTION, 5.0, 20.0, 60.0)
    text = '[time]\nevery = "2 ms"\n[radius]\nvalue = "25 mm"\n[load]\nvalue = "50 N"\n'
    (tmp_path / FILE_NAME).write_text(text)
    (run,) = read_with_mapping(path, isothermal=True).log.runs
    np.testing.assert_allclose(run.torque, 0.125)
    np.testing.assert_allclose(run.speed, 0.8)
    np.testing.assert_allclose(run.time, 2e-3 * np.arange(TIME.size))
    assert run.load is not None
    np.testing.assert_allclose(run.load, 50.0)
    for given in ({"load": 70.0}, {"load": "70 N"}):  # what is given by hand outranks it
        (run,) = read_with_mapping(path, isothermal=True, **given).log.runs  # type: ignore[arg-type]
        assert run.load is not None
        np.testing.assert_allclose(run.load, 70.0)
    (tmp_path / FILE_NAME).write_text(text.replace('value = "50 N"', 'values = ["55 N"]'))
    (run,) = read_with_mapping(path, isothermal=True).log.runs
    assert run.load is not None
    np.testing.assert_allclose(run.load, 55.0)
    (run,) = read_with_mapping(path, isothermal=True, channels={"load": "Fn"}).log.runs
    assert run.load is not None
    np.testing.assert_allclose(run.load, 60.0)
    (run,) = read_with_mapping(path, isothermal=True, channels={"time": "row"}, units={"time": "s"}).log.runs
    np.testing.assert_allclose(run.time, TIME)


def test_channels_of_radius_and_run_in_a_mapping(tmp_path: Path) -> None:
    header = "t [s],Friction force [N],v [mm/s],R,Lauf"
    path = write(tmp_path / "wear.csv", header, 5.0, 20.0, 25.0, np.floor(TIME / 10.0))
    text = '[radius]\nchannel = "R"\nunit = "mm"\n[run]\nchannel = "Lauf"\n'
    (tmp_path / FILE_NAME).write_text(text)
    log = read_with_mapping(path, isothermal=True).log
    assert [run.time.size for run in log.runs] == [200, 200]
    np.testing.assert_allclose(log.runs[1].torque, 5.0)  # radii of a column ask for no torque
    assert log.domain.quantity == "friction force"


def test_a_proposal_for_a_friction_force_asks_for_the_radius(tmp_path: Path) -> None:
    path = write(tmp_path / "wear.csv", "t [s],Friction force [N],v [mm/s]", 5.0 + TIME, 20.0 + TIME)
    text = propose_mapping(path)
    assert '# value = "25 mm"' in text
    (tmp_path / FILE_NAME).write_text(
        text.replace("# [radius]", "[radius]").replace('# value = "25 mm"', 'value = "25 mm"')
    )
    (run,) = read_with_mapping(path, isothermal=True).log.runs
    np.testing.assert_allclose(run.torque, (5.0 + TIME) * 0.025)


def test_a_proposal_writes_a_position_and_what_is_said_beside_columns(tmp_path: Path) -> None:
    header = "t [s],Current [A],phi [deg],dir"
    path = write(tmp_path / "joint.csv", header, 0.5 + 1e-3 * TIME, 6.0 * TIME, np.sign(TIME - 10.0))
    said = {"torque_constant": 0.1, "gear_ratio": 30.0, "position_window": 0.5, "load": (5.0, 7.0)}
    text = propose_mapping(path, said=said)
    assert '[position]\nchannel = "phi"\nunit = "deg"\nwindow = "0.5 s"\n' in text
    current = 'channel = "Current"\nunit = "A"\nmotor_constant = "0.1 N*m/A"\ngear_ratio = 30\n'
    assert f"[torque]\n{current}" in text
    assert '[load]\nvalues = ["5 N", "7 N"]\n' in text
    assert '# channel = "dir"' in text
    assert text.count("motor_constant") == 1
    (tmp_path / FILE_NAME).write_text(text.partition("[load]")[0])
    (run,) = read_with_mapping(path, isothermal=True).log.runs
    np.testing.assert_allclose(run.torque, 30 * 0.1 * (0.5 + 1e-3 * TIME))
    np.testing.assert_allclose(run.speed[5:-5], np.pi / 30)
    bare = propose_mapping(path)
    assert '# [torque]\n# channel = "Current"\n# unit = "A"\n# motor_constant = "35 mN*m/A"\n' in bare
    named = {"position": "phi", "direction": "dir", "torque": "Current"}
    assert '[direction]\nchannel = "dir"\n' in propose_mapping(path, channels=named)


@pytest.mark.parametrize("unit", ["", "counts", "ticks"])
def test_a_position_in_counts_is_not_taken_for_an_angle(unit: str, tmp_path: Path) -> None:
    header = f"t [s],Torque [N*m],Encoder{f' [{unit}]' * bool(unit)}"
    path = write(tmp_path / "joint.csv", header, 0.5 + 1e-3 * TIME, np.round(400 * TIME))
    with pytest.raises(ChannelError, match=r"channels=\{'position': 'Encoder'\}.*'position': 'rev/4096'"):
        hersey.read(path, isothermal=True)
    assert '# channel = "Encoder"\n# unit = "rev/4096"' in propose_mapping(path)
    position = {"channels": {"position": "Encoder"}, "isothermal": True}
    with pytest.raises(UnitError, match="rev/4096"):
        hersey.read(path, **position)
    (run,) = hersey.read(path, units={"position": "rev/400"}, **position).runs
    np.testing.assert_allclose(run.speed[5:-5], 2 * np.pi, rtol=0.02)


def test_a_proposal_writes_the_pattern_of_the_file_names(tmp_path: Path) -> None:
    names = ["b_20rpm_60C.csv", "b_20rpm_80C.csv", "b_40rpm_80C.csv"]
    files = [write(tmp_path / name, "t [s],Torque [N*m]", 0.5 + 0.1 * i) for i, name in enumerate(names)]
    text = propose_mapping(files[0], names=names)
    assert '[names]\npattern = "b_{speed}rpm_{temperature:degC}C.csv"\n' in text
    (tmp_path / FILE_NAME).write_text(text)
    runs = read_with_mapping(files).log.runs
    assert [run.temperature[0] - 273.15 for run in runs] == pytest.approx([60, 80, 80])
    text = propose_mapping(files[0], said={"name_pattern": "b_{speed}rpm*"})
    assert 'pattern = "b_{speed}rpm*"' in text


def test_a_dead_channel_is_not_proposed(tmp_path: Path) -> None:
    header = "t [s],Torque 1 [N*m],Torque 2 [N*m],Speed [rpm],Temp [degC]"
    text = propose_mapping(write(tmp_path / "a.csv", header, 1.5, 1.0 + TIME, 60.0 + TIME, 0.0))
    assert 'channel = "Torque 2"' in text
    assert "'Temp [degC]' is zero throughout or empty" in text
    assert 'channel = "Temp"' not in text


def test_a_screw_drive_by_its_mapping(tmp_path: Path) -> None:
    folder = shared("data/friction/tro2021_screw_drives/driveNo1/steady_state")
    text = '[torque]\nchannel = "Torque actual value averaged"\nunit = "9.84 mN*m / 100"\nsign = -1\n'
    (tmp_path / FILE_NAME).write_text(text)
    done = read_with_mapping(folder / "50.csv", mapping=tmp_path / FILE_NAME, isothermal=True)
    plain = hersey.read(folder / "50.csv", units={"torque": "-9.84 mN*m / 100"}, isothermal=True)
    np.testing.assert_allclose(done.log.runs[0].torque, plain.runs[0].torque)


def test_examples(monkeypatch: pytest.MonkeyPatch, root: Path) -> None:
    monkeypatch.chdir(root)
    results = [doctest.testmod(module) for module in (log_mapping, proposal)]
    assert sum(result.attempted for result in results) > 1
    assert all(result.failed == 0 for result in results)
