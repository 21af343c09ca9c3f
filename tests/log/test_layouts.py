"""Exports of instruments: read as they stand or by the layout that is proposed, every number as written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from benchmarks.layouts.cases import CASES, UNSEEN
from benchmarks.layouts.truth import Made, Step, staircase, truth
from benchmarks.layouts.trying import tried, wrong_with

import hersey
from hersey.errors import HerseyError, ParameterError, UnreadableLogError, speak
from hersey.log import mapping as log_mapping
from hersey.log.layouts import pattern as patterns
from hersey.log.layouts.pattern import Value, pattern
from hersey.log.layouts.presets import PRESETS
from hersey.log.layouts.proposing import proposed_layout
from hersey.log.layouts.recognized import LAYOUT_RECOGNIZED
from hersey.log.layouts.table import LogLayout
from hersey.log.mapping import FILE_NAME, LogMapping, read_mapping, read_with_mapping
from hersey.log.proposal import propose_mapping
from hersey.log.torque_log import TorqueLog

#: Cases whose files belong to a preset.
OF_PRESETS = {
    "rheocompass": "rheocompass",
    "trios": "trios",
    "twincat": "twincat",
    "yokogawa": "yokogawa",
    "names_apart": "graphtec",
    "three_rows": "campbell",
    "wincc": "wincc",
    "influx": "influx",
}
#: Cases that need no layout, and others that go the way of one of them.
AS_THEY_STAND = frozenset(
    [
        "rheocompass",
        "rheoplus",
        "testxpert",
        "dewesoft",
        "epos",
        "pin_on_disc",
        "odrive",
        "restarts",
        "optimol",
        "lvm",
        "utf16",
        "blanks",
        "fixed",
        "quoted",
        "thousands",
        "swiss",
        "percent",
        "trios",
        "wincc",
        "twincat",
        "yokogawa",
    ]
)
HEAD = "Time [s];Torque [mN*m];Temp [degC]"


def written(folder: Path, name: str) -> tuple[Path, Made]:
    write, ending = (CASES | UNSEEN)[name]
    path = folder / f"log{ending}"
    return path, write(path)


def units_of(made: Made) -> dict[str, str]:
    return {
        flag[2:].removesuffix("-unit"): unit for flag, unit in made.options.items() if flag.endswith("-unit")
    }


def rows(step: Step) -> list[str]:
    return [";".join(row) for row in step.cells("time", "torque", "temperature")]


def blocks(path: Path, above: Callable[[float], list[str]]) -> Made:
    """Blocks with lines above each, a header, and no measured speed."""
    steps = staircase(7, rows=30, restart=True)
    lines = [line for step in steps for line in (*above(step.speed), HEAD, *rows(step))]
    path.write_text("\n".join(lines) + "\n")
    return Made(truth(steps, set_point=True))


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[pytest.mark.nightly] if name in AS_THEY_STAND else [])
        for name, (_, ending) in CASES.items()
        if ending != ".xlsx"
    ],
)
def test_an_export_is_read_right_as_it_stands_or_as_proposed(name: str, tmp_path: Path) -> None:
    path, made = written(tmp_path, name)
    (tmp_path / FILE_NAME).write_text(propose_mapping(path))
    given = {"isothermal": made.truth.temperature is None, "drop_missing": True}
    channels = {"torque": "Torque#1"} if name == "pin_on_disc" else {}
    log = read_with_mapping(path, units=units_of(made), channels=channels, **given).log
    assert wrong_with(log, made) == ""


@pytest.mark.parametrize("name", ["named_sheets", "titled_sheets", "side_by_side"])
def test_a_workbook_is_read_right_as_proposed(name: str, tmp_path: Path) -> None:
    pytest.importorskip("fastexcel")
    path, made = written(tmp_path, name)
    (tmp_path / FILE_NAME).write_text(propose_mapping(path))
    assert wrong_with(read_with_mapping(path).log, made) == ""


@pytest.mark.parametrize("name", OF_PRESETS)
def test_a_preset_reads_the_export_of_its_instrument(name: str, tmp_path: Path) -> None:
    path, made = written(tmp_path, name)
    mapping = LogMapping(layout=LogLayout(preset=OF_PRESETS[name]))
    assert wrong_with(read_with_mapping(path, mapping=mapping, units=units_of(made)).log, made) == ""


def test_every_preset_is_tried() -> None:
    assert set(OF_PRESETS.values()) == set(PRESETS)


def test_a_layout_that_the_file_shows_is_used_at_once_and_said(tmp_path: Path) -> None:
    path, made = written(tmp_path, "umt")
    outcome = tried(path, made)
    assert outcome.right
    assert len(outcome.commands) == 1
    assert used(read_with_mapping(path).log) == [
        'Read by the layout that the file shows: header = "T(s) *"; '
        'values = ["Step *: Velocity {speed} rpm"].'
    ]
    inspected = hersey.inspect(path)
    assert not inspected.problem
    assert {channel.role for channel in inspected.files[0].channels} >= {"speed", "torque", "temperature"}
    proposal = propose_mapping(path)
    assert '[layout]\nheader = "T(s) *"\nvalues = ["Step *: Velocity {speed} rpm"]\n' in proposal
    assert '[speed]\nchannel = "set speed"\nunit = "rpm"' in proposal
    (tmp_path / FILE_NAME).write_text(proposal)
    assert used(read_with_mapping(path).log) == []


def used(log: TorqueLog) -> list[str]:
    return [w.text for run in log.files for w in run.warnings if w.kind == LAYOUT_RECOGNIZED]


@pytest.mark.parametrize("name", ["rheocompass", "wide_with_row", "unequal"])
def test_it_is_said_once_for_all_runs_of_a_file(name: str, tmp_path: Path) -> None:
    path, made = written(tmp_path, name)
    log = read_with_mapping(path).log
    assert wrong_with(log, made) == ""
    assert len(used(log)) == 1


def test_units_that_a_layout_lacks_are_asked_for_at_once(tmp_path: Path) -> None:
    path, made = written(tmp_path, "wincc")
    with pytest.raises(HerseyError, match=r"have no units \(layout found: preset = \"wincc\"\)"):
        read_with_mapping(path)
    assert wrong_with(read_with_mapping(path, units=units_of(made)).log, made) == ""


def with_doubt(path: Path) -> Made:
    """Two torques and speeds beside one clock: two runs, or two sensors."""
    steps = staircase(5, rows=30)
    lines = ["Time [s];Torque1 [mN*m];Speed1 [rpm];Torque2 [mN*m];Speed2 [rpm];Temp [degC]"]
    for step in steps:
        cells = step.cells("time", "torque", "turning", "temperature")
        lines += [f"{t};{m};{n};{m}1;{n}1;{c}" for t, m, n, c in cells]
    path.write_text("\n".join(lines) + "\n")
    return Made(truth(steps))


def test_a_layout_that_is_a_guess_is_advised_not_used(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    made = with_doubt(path)
    with pytest.raises(HerseyError, match=r"Torque1.*propose_mapping"):
        read_with_mapping(path)
    outcome = tried(path, made)
    assert outcome.commands[1] == f"hersey inspect {path} --save-mapping"
    assert outcome.read
    assert 'wide = "{channel}{run}"' in (tmp_path / FILE_NAME).read_text()


def test_a_log_that_only_lacks_a_channel_gets_no_advice_on_its_layout(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("\n".join([HEAD, *rows(staircase(1)[0])]) + "\n")
    with pytest.raises(HerseyError, match="no speed column found") as refused:
        read_with_mapping(path)
    assert "layout" not in str(refused.value)
    path.write_text("Time [s];Torque [N*m];Speed [rpm]\n" + "\n".join(rows(staircase(1)[0])) + "\n")
    with pytest.raises(HerseyError, match="no temperature column found"):
        read_with_mapping(path)
    assert proposed_layout(path) is None


@pytest.mark.parametrize(
    "above",
    [
        lambda speed: [f"Speed: {speed:g} rpm"] * (speed != 20),  # one block does not state it
        lambda speed: [f"From {speed:g} rpm to {2 * speed:g} rpm"],  # a ramp
        lambda speed: [f"Set: {speed:g} rpm", f"Read: {speed + 0.3:g} rpm"],  # which of them
        lambda speed: [f"Max. speed: {speed:g} rpm"],
    ],
)
def test_a_speed_that_is_not_surely_that_of_the_rows_is_not_proposed(
    above: Callable[[float], list[str]], tmp_path: Path
) -> None:
    path = tmp_path / "log.txt"
    blocks(path, above)
    assert proposed_layout(path) is None


def test_of_several_speeds_above_a_block_the_set_point_is_taken(tmp_path: Path) -> None:
    path = tmp_path / "log.txt"
    made = blocks(path, lambda speed: ["Limit: 200 rpm", "Oil: 80 °C", f"Speed;{speed:g};rpm"])
    (tmp_path / FILE_NAME).write_text(propose_mapping(path))
    assert wrong_with(read_with_mapping(path).log, made) == ""


def test_two_sensors_are_not_two_runs(tmp_path: Path) -> None:
    path, lines = tmp_path / "log.csv", ["Time [s];Torque [mN*m];Speed [rpm];T1 [degC];T2 [degC]"]
    for step in staircase(3):
        lines += [
            f"{t};{m};{n};{c};{c}1" for t, m, n, c in step.cells("time", "torque", "turning", "temperature")
        ]
    path.write_text("\n".join(lines) + "\n")
    assert proposed_layout(path) is None


def test_a_section_without_what_others_state_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "log.txt"
    blocks(path, lambda speed: [f"Speed: {speed:g} rpm" if speed > 10 else "Speed: slow"])
    layout = LogLayout(header="Time *", values=("Speed: {speed} rpm",))
    with pytest.raises(UnreadableLogError, match=r"line 3: no line above these rows states the speed"):
        read_with_mapping(path, mapping=LogMapping(layout=layout))


def test_a_line_among_rows_that_no_pattern_matches_is_refused(tmp_path: Path) -> None:
    steps = staircase(5)
    lines = [HEAD, "Step 1: 10 rpm", *rows(steps[0]), "Stp 2 - 20 rpm", *rows(steps[1])]
    (tmp_path / "log.txt").write_text("\n".join(lines) + "\n")
    layout = LogLayout(section="Step *: {speed} rpm")
    with pytest.raises(UnreadableLogError, match=r"line 43: 'Stp 2 - 20 rpm' stands among") as refused:
        read_with_mapping(tmp_path / "log.txt", mapping=LogMapping(layout=layout))
    assert refused.value.remedy == "mend section, header or values, or name such lines in skip"


def test_a_plain_log_is_read_without_a_look_at_its_layout(
    bench_csv: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def never(*_: object) -> None:
        raise AssertionError

    monkeypatch.setattr(log_mapping, "recognized", never)
    assert read_with_mapping(bench_csv).log.rows == hersey.read(bench_csv).rows


@pytest.mark.parametrize(
    ("template", "text", "values", "channel"),
    [
        ("Step {run}: {speed} rpm", "step  3:\t50,5 RPM", {"run": (3, ""), "speed": (50.5, "rpm")}, ""),
        ("Shaft speed (rpm): {speed:rpm}*", "Shaft speed (rpm): 1e2 set", {"speed": (100, "rpm")}, ""),
        ("*{temperature} °C", "Oil at -40.5 °C", {"temperature": (-40.5, "°C")}, ""),
        ("{channel} @ {speed} mm/s", "Torque 2 @ 10 mm/s", {"speed": (10, "mm/s")}, "Torque 2"),
        ("{channel}{run}", "T1", {"run": (1, "")}, "T"),
    ],
)
def test_a_pattern_finds_numbers_with_their_units(
    template: str, text: str, values: dict[str, tuple[float, str]], channel: str
) -> None:
    found = pattern(template).match(text)
    assert found is not None
    assert found.values == {name: Value(*value) for name, value in values.items()}
    assert found.channel == channel


@pytest.mark.parametrize("text", ["Step 3: 50 rpm up", "Step: 50 rpm", "A step 3: 50 rpm", "Step 3: 50 Hz"])
def test_a_pattern_matches_a_whole_text(text: str) -> None:
    assert pattern("Step {run}: {speed} rpm").match(text) is None


@pytest.mark.parametrize(
    ("template", "said"),
    [
        ("{omega} rpm", "unknown placeholder {omega}"),
        ("Speed {speed}", "without a unit behind it. Write the unit, e.g. {speed:rpm}"),
        ("{speed} N*m", "without a unit behind it"),
        ("{channel} {channel}", "more than once"),
        ("x" * 301, "301 characters"),
    ],
)
def test_a_wrong_pattern_is_refused(template: str, said: str) -> None:
    with pytest.raises(ParameterError) as refused:
        pattern(template)
    assert said in str(refused.value)


def test_the_work_of_a_pattern_grows_no_faster_than_the_square_of_a_line(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """No choice of literals and stars makes it try again and again: the parts after a star are tried once."""
    calls, matched = [0], patterns._matched

    def counted(*given: object) -> object:
        calls[0] += 1
        return matched(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(patterns, "_matched", counted)
    assert pattern("{channel}" + "*a" * 100 + "b").match("a" * 1000) is None
    assert calls[0] <= 1001


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('preset = "twinkat"', "names the unknown preset 'twinkat'. Did you mean 'twincat'?"),
        ('encoding = "punycode"', "is 'punycode', an unknown encoding"),
        ('delimiter = "-"', "Write one of"),
        ("header_line = 0", "lines are counted from 1"),
        ('wide = "Torque"', "has no number of a condition in it"),
        ('section = "{speed}"', "without a unit behind it"),
        ('paired_clocks = "N"', "is 'N'"),
        ('sections = "Step"', "unknown key 'sections'"),
    ],
)
def test_a_mistake_in_a_layout_is_named(line: str, said: str, tmp_path: Path) -> None:
    (tmp_path / FILE_NAME).write_text(f"[layout]\n{line}\n")
    with pytest.raises(HerseyError) as refused:
        read_mapping(tmp_path / FILE_NAME)
    assert FILE_NAME in str(refused.value)
    assert said in str(refused.value)


def test_a_layout_is_written_as_it_is_read(tmp_path: Path) -> None:
    layout = LogLayout(
        encoding="cp932", decimal="comma", header_line=3, values=('Speed "set" {speed} rpm',), transposed=True
    )
    (tmp_path / FILE_NAME).write_text(layout.toml())
    assert read_mapping(tmp_path / FILE_NAME).layout == layout


def test_units_of_another_part_are_converted(tmp_path: Path) -> None:
    path, made = written(tmp_path, "other_units")
    mapping = LogMapping(layout=LogLayout(header="Time *"))
    log = read_with_mapping(path, mapping=mapping).log
    np.testing.assert_allclose(log.runs[0].torque, made.truth.torque, rtol=1e-12)


def test_speeds_in_names_beside_a_speed_are_a_guess(tmp_path: Path) -> None:
    """Two sensors, each named with the speed that it bears."""
    path = tmp_path / "log.csv"
    lines = ["Time [s];Torque 3000 rpm [mN*m];Torque 9000 rpm [mN*m];Speed [rpm];Temp [degC]"]
    for step in staircase(5, rows=30):
        lines += [
            f"{t};{m};{m}1;{n};{c}" for t, m, n, c in step.cells("time", "torque", "turning", "temperature")
        ]
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(HerseyError, match="the torque column could be"):
        read_with_mapping(path)


def test_advice_suits_who_asks(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    with_doubt(path)
    with pytest.raises(HerseyError, match="propose_mapping"):
        read_with_mapping(path)
    try:
        speak("terminal")
        with pytest.raises(HerseyError, match=r"run 'hersey inspect .*log\.csv --save-mapping'"):
            read_with_mapping(path)
    finally:
        speak("python")
