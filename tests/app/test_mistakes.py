"""Mistakes end in words at the control that mends them, and its button mends."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from benchmarks.layouts.sections import umt
from benchmarks.layouts.trying import wrong_with

from hersey.app.analysis import Analysis, Dropped
from hersey.app.channels import Fault, of_problem
from hersey.app.checking import check
from hersey.app.looking import look
from hersey.app.view import line_of, view_of
from hersey.errors import HerseyError, Setting, TimeOrderError, UnreadableLogError
from hersey.log.mapping import read_with_mapping
from tests.cli.test_bad_input import staircase
from tests.conftest import ROOT

ROWS = staircase()


def log(
    header: str = "Time [s],Torque [N*m],Speed [rpm],Temperature [degC]",
    change: Callable[..., Any] = lambda *c: c,
) -> bytes:
    """A log whose cells are changed row by row."""
    rows = [",".join(map(str, change(*row.split(",")))) for row in ROWS]
    return "\n".join([header, *rows, ""]).encode()


def dropped(folder: Path, *contents: bytes) -> Analysis:
    """An analysis with files as the app takes them."""
    one = Analysis(folder)
    for number, content in enumerate(contents):
        path = folder / f"log{number}.csv"
        path.write_bytes(content)
        file = Dropped(path.name, path, size=len(content))
        one.files[file.id] = file
        try:
            file.look, file.state = look(path), "ready"
            one.propose(file)
        except HerseyError as error:
            file.state, file.fault = "fault", f"not a log: {error}"
    check(one)
    return one


def only(one: Analysis) -> Fault:
    (fault,) = one.faults
    assert fault.link
    assert fault.title or fault.text
    assert "--" not in fault.text, "a flag of the command line helps nobody here"
    return fault


def test_a_sound_log_is_ready(tmp_path: Path) -> None:
    one = dropped(tmp_path, log())
    assert one.faults == []
    assert line_of(one)["ready"]
    assert {name: choice["role"] for name, choice in one.choices.items()} == {
        "Time": "time", "Torque": "torque", "Speed": "speed", "Temperature": "temperature",
    }  # fmt: skip


#: A log, where its fault stands, what is said, what the button says, and what it changes.
MISTAKES: dict[str, tuple[bytes, str, str, str]] = {
    "kelvin without a unit": (
        log("Time [s],Torque [N*m],Speed [rpm],Heater", lambda t, q, n, c: (t, q, n, float(c) + 273)),
        "unit:Heater",
        "no unit in the file",
        "Read as K",
    ),
    "kelvin called Celsius": (
        log(change=lambda t, q, n, c: (t, q, n, float(c) + 273)),
        "unit:Temperature",
        "423 °C is hotter than any such drive. Read as K it is 100 to 150 °C.",
        "Read as K",
    ),
    "Celsius called kelvin": (
        log("Time [s],Torque [N*m],Speed [rpm],Temperature [K]"),
        "unit:Temperature",
        "colder than any such drive",
        "Read as °C",
    ),
    "another unit for torque": (
        log("Time [s],Torque [rpm],Speed [rpm],Temperature [degC]"),
        "unit:Torque",
        "rpm is not a unit of torque",
        "Read as N·m",
    ),
    "no temperature": (
        log("Time [s],Torque [N*m],Speed [rpm]", lambda t, q, n, _: (t, q, n)),
        "lacking:temperature",
        "No temperature channel.",
        "Run without temperature",
    ),
    "two torques": (
        log(
            "Time [s],Torque A [N*m],Speed [rpm],Temperature [degC],Torque B [N*m]",
            lambda t, q, n, c: (t, q, n, c, 1.5 * float(q)),
        ),
        "role:Torque A",
        "Two channels could be the torque.",
        "Keep this one",
    ),
    "no speed": (
        log("Time [s],Torque [N*m],Foo,Temperature [degC]"),
        "lacking:speed",
        "No speed channel. Choose one",
        "",
    ),
    "a speed of another name": (
        log(
            "Time [s],Torque [N*m],Foo,Temperature [degC],n [Hz]",
            lambda t, q, n, c: (t, q, n, c, float(n) / 60),
        ),
        "unit:n",
        "Hz is not a unit of speed",
        "Read as rev/s",
    ),
    "a dead speed": (
        log(
            "Time [s],Torque [N*m],Speed [rpm],Temperature [degC],Shaft [rad/s]",
            lambda t, q, n, c: (t, q, 0, c, float(n) / 9),
        ),
        "role:Speed",
        "It is 0 rpm throughout. The channel is dead",
        "Use “Shaft”",
    ),
    "rows without a number": (
        log(change=lambda t, q, n, c: (t, "" if float(t) % 1 < 0.25 else q, n, c)),
        "role:Torque",
        "rows have no value",
        "Skip these rows",
    ),
    "a clock in milliseconds called seconds": (
        log(change=lambda t, q, n, c: (1000 * float(t), q, n, c)),
        "unit:Time",
        "Rows come every 100 s.",
        "Read as ms",
    ),
    "time backwards": (
        log(change=lambda t, q, n, c: (round(60 - float(t), 1) if 20 < float(t) < 30 else t, q, n, c)),
        "role:Time",
        "Time is out of order. Line 251: time runs ahead",
        "",
    ),
    "not a log": (b"%PDF-1.4\n1 0 obj\n<<>>\nendobj\n", "file:", "has no table of numbers", "Remove"),
    "an empty file": (b"", "file:", "is empty", "Remove"),
    "a damaged file": (b"\x89HDF\r\n\x1a\n" + bytes(200), "file:", "damaged", "Remove"),
}


def test_the_title_of_what_a_reader_refused_follows_from_its_kind_and_not_from_its_words() -> None:
    looked = {"name": "log.csv"}
    choices = {"Time": {"role": "time", "unit": "s"}}
    for kind, title, link in (
        (TimeOrderError, "Time is out of order.", "time: time is out of order"),
        (UnreadableLogError, "This cannot be read.", "time: this cannot be read"),
    ):
        problem = kind("log.csv: time runs backwards", setting=Setting("time", "channel")).to_dict()
        fault = of_problem(problem, looked, choices)
        assert (fault.at, fault.title, fault.link) == ("role:Time", title, link)


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_ends_in_words_at_its_control(mistake: str, tmp_path: Path) -> None:
    content, at, said, button = MISTAKES[mistake]
    one = dropped(tmp_path, content)
    fault = only(one)
    assert fault.at.startswith(at)
    assert said in f"{fault.title} {fault.text}"
    assert fault.button == button
    assert not line_of(one)["ready"]
    if button:
        one.choose(fault.mend)
        check(one)
        if button == "Use “Shaft”":
            assert one.choices["Shaft"] == {"role": "speed", "unit": "rad/s"}
        assert one.faults == []


def test_what_is_only_doubtful_can_be_kept(tmp_path: Path) -> None:
    one = dropped(tmp_path, MISTAKES["kelvin called Celsius"][0])
    assert only(one).keep == "Keep °C"
    one.kept.add(only(one).key)
    check(one)
    assert one.faults == []


def test_the_radius_of_a_friction_force_is_given_in_words_of_its_reader(tmp_path: Path) -> None:
    one = dropped(tmp_path, log("Time [s],Friction force [N],Speed [rpm],Temperature [degC]"))
    assert one.faults == []  # friction against speed needs no radius
    for text, faults in (("25 kg", 1), ("25", 0)):
        one.choose({"corrections": {"radius.value": text}})
        check(one)
        assert len(one.faults) == faults, one.faults
    assert 'value = "25 mm"' in one.mapping_file()


def test_a_motor_s_current_becomes_a_torque(tmp_path: Path) -> None:
    one = dropped(tmp_path, log("Time [s],Motor [A],Speed [rpm],Temperature [degC]"))
    one.choose({"roles": {"Motor": "torque"}})
    check(one)
    assert only(one).at == "field:torque.motor_constant"
    one.choose({"corrections": {"torque.motor_constant": "35"}})
    check(one)
    assert one.faults == []
    assert 'motor_constant = "35 mN*m/A"' in one.mapping_file()


def test_of_two_logs_one_can_be_compared_with_the_other(tmp_path: Path) -> None:
    one = dropped(tmp_path, log(), log(change=lambda t, q, n, c: (t, 1.1 * float(q), n, c)))
    first, second = one.logs
    assert [file["name"] for file in view_of(one)["pair"]] == ["log0.csv", "log1.csv"]
    assert "log0.csv log1.csv" in one.command()
    one.choose({"options": {"against": first.id}})
    assert (one.earlier, one.told_of) == (first, [second])
    assert one.command() == "hersey report log1.csv --mapping hersey.toml --against log0.csv"
    one.choose({"options": {"against": second.id}})
    assert (one.earlier, one.told_of) == (second, [first])
    with pytest.raises(ValueError, match="against"):
        one.choose({"options": {"against": "/etc/passwd"}})
    one.remove(second.id)
    assert (one.earlier, one.told_of, view_of(one)["pair"]) == (None, [first], [])


def test_a_log_that_is_unlike_the_first_says_so(tmp_path: Path) -> None:
    one = dropped(tmp_path, log(), log("Time [s],Moment [N*m],Speed [rpm],Temperature [degC]"))
    fault = only(one)
    assert "no channel “Torque”" in fault.text
    assert fault.at.startswith("file:")
    one.choose(fault.mend)
    check(one)
    assert (len(one.files), one.faults) == (1, [])


DRIVETRAIN = {
    "drivetrain.stiffness": "11",
    "drivetrain.mass": "11 kg",
    "drivetrain.roll_radius": "15",
    "drivetrain.stick_speed": "0.1 to 1",
}
MACHINES: dict[str, tuple[dict[str, Any], str, str]] = {
    "a value that is missing": (
        {"answers": {"drivetrain.mass": ""}},
        "field:drivetrain.mass",
        "This value is missing. For example 11 kg",
    ),
    "a value of another kind": (
        {"answers": {"drivetrain.mass": "11 N"}},
        "field:drivetrain.mass",
        'mass is 11 N, a weight, but a mass is needed. Write "1.122 kg"',
    ),
    "a word": ({"answers": {"limits.roll_friction": "low"}}, "field:limits.roll_friction", "not a number"),
    "a negative value": (
        {"answers": {"drivetrain.roll_radius": "-15"}},
        "field:drivetrain.roll_radius",
        "greater than 0",
    ),
    "a point without a speed": ({"add": True}, "field:points.0.speed", "This value is missing."),
    "half a nip": (
        {"answers": {"contact.length": "220"}},
        "field:contact.rubber_thickness",
        "other values of its group need it",
    ),
    "TOML that breaks off": ({"text": "[drivetrain]\nmass = \n"}, "toml", "line 2"),
    "TOML without a unit": (
        {"text": "[drivetrain]\nmass = 11\n"},
        "toml",
        "drivetrain.mass is 11, without a unit. Write it in quotes with its unit",
    ),
    "a log in its place": ({"text": "a,b\n1,2\n"}, "toml", "not valid TOML"),
}


@pytest.mark.parametrize("mistake", MACHINES)
def test_a_mistake_about_the_machine_stands_at_its_field(mistake: str, tmp_path: Path) -> None:
    given, at, said = MACHINES[mistake]
    one = dropped(tmp_path, log())
    one.take_machine({"answers": DRIVETRAIN})
    check(one)
    assert one.faults == []
    one.take_machine(given)
    check(one)
    at_fault = {fault.at: f"{fault.title} {fault.text}" for fault in one.faults}
    assert said in at_fault[at]
    assert not line_of(one)["ready"]


@pytest.mark.parametrize(
    ("field", "text"), [("roll_radius", "15000"), ("mass", "11 mg"), ("stick_speed", "2 m/s to 4 m/s")]
)
def test_a_value_that_no_machine_has_can_be_kept(field: str, text: str, tmp_path: Path) -> None:
    one = dropped(tmp_path, log())
    one.take_machine({"answers": {**DRIVETRAIN, f"drivetrain.{field}": text}})
    check(one)
    fault = only(one)
    assert fault.at == f"field:drivetrain.{field}"
    assert "unusual for such a drive" in fault.title
    assert fault.keep.startswith("Keep ")
    one.kept.add(fault.key)
    check(one)
    assert one.faults == []


def test_form_and_text_say_the_same(tmp_path: Path) -> None:
    one = Analysis(tmp_path)
    one.take_machine({"answers": {**DRIVETRAIN, "drivetrain.mass": "11 kg ± 10 %"}})
    one.take_machine({"add": True})
    one.take_machine({"point": 0, "answers": {"points.speed": "200", "points.temperature": "180"}})
    check(one)
    assert one.turn("toml") == ""
    text = one.text
    check(one)
    assert one.faults == []
    assert one.turn("form") == ""
    assert one.machine_file() == text


def test_a_machine_s_file_that_is_dropped_is_taken(tmp_path: Path) -> None:
    one = Analysis(tmp_path)
    assert toml(one, '[drivetrain]\nmass = "11 kg"\n').name == "mine.toml"
    assert (one.mode, one.text, one.files) == ("toml", '[drivetrain]\nmass = "11 kg"\n', {})


def toml(one: Analysis, text: str) -> Dropped:
    """Drop a TOML file, as the app takes one."""
    file = Dropped("mine.toml", one.folder / "mine.toml")
    file.path.write_text(text)
    one.files[file.id] = file
    if not one.take_file(file):
        file.state, file.fault = "fault", "none"
    check(one)
    return file


#: All tables that a machine file knows, most of them without a field in the form.
WHOLE = (ROOT / "examples" / "machine.toml").read_text()


def test_what_the_form_has_no_field_for_is_kept(tmp_path: Path) -> None:
    one = dropped(tmp_path, log(), (ROOT / "examples" / "no-load.csv").read_bytes())
    list(one.files.values())[1].name = "no-load.csv"
    before = tomllib.loads(WHOLE)
    assert {"heat", "life", "asperities", "boundary", "uncertainty"} <= set(before)
    toml(one, WHOLE)
    assert one.faults == []
    assert one.turn("form") == ""
    assert tomllib.loads(one.machine_file()) == before
    assert any(each.startswith("[heat] ") for each in view_of(one)["machine"]["kept"])
    one.take_machine({"answers": {"drivetrain.mass": "12 kg"}})
    check(one)
    assert one.faults == []
    after = tomllib.loads(one.machine_file())
    assert after["drivetrain"].pop("mass") == "12 kg"
    del before["drivetrain"]["mass"]
    assert after == before


@pytest.mark.parametrize(
    "odd",
    [
        'stick_speed = "1.5 mm/s"\n[uncertainty]\nstick_speed = "1 mm/s to 4 mm/s"',
        'stick_speed = "2 mm/s"\n[uncertainty]\nstick_speed = "1 mm/s to 4 mm/s"\nexponent_speed = "0.1"',
        'stick_speed = "2 mm/s"\n[[points]]\nspeed = "1 m/s"\ntemperature = "180 degC"\nshare = 0.25',
        'stick_speed = "2 mm/s"\n[heat]\non = true\n"of both" = [{a = 1}, {b = [1.5, "x"]}]',
    ],
)
def test_form_and_text_hold_the_same_values(odd: str, tmp_path: Path) -> None:
    text = f'[drivetrain]\nstiffness = "11 N/mm"\nmass = "11 kg"\nroll_radius = "15 mm"\n{odd}\n'
    one = Analysis(tmp_path)
    one.take_machine({"text": text})
    assert one.turn("form") == ""
    assert tomllib.loads(one.machine_file()) == tomllib.loads(text)
    one.take_machine({"answers": {"drivetrain.stick_speed": "2 mm/s to 8 mm/s"}})  # what is said later holds
    assert tomllib.loads(one.machine_file())["uncertainty"]["stick_speed"] == "2 mm/s to 8 mm/s"


MAPPING = """[torque]
channel = "Moment"
unit = "mN*m"
tare = "4 mN*m"
gain_error = "1 %"
[speed]
channel = "shaft"
unit = "rpm"
gear_ratio = 12.5
[load]
channel = "Press"
unit = "N"
"""
OF_MAPPING = log(
    "Time [s],Torque [N*m],Speed [rpm],Temperature [degC],Moment,Shaft,Press",
    lambda t, q, n, c: (t, q, n, c, q, float(n) * 12, 40 + float(t) % 2),
)


@pytest.mark.parametrize("first", ["log", "mapping"])
def test_a_mapping_that_is_dropped_fills_the_channels(first: str, tmp_path: Path) -> None:
    one = dropped(tmp_path, OF_MAPPING)
    if first == "mapping":
        (log_file,) = one.files.values()
        one.files, one.choices = {}, {}
        toml(one, MAPPING)
        one.files[log_file.id] = log_file
        one.propose(log_file)
        check(one)
    else:
        toml(one, MAPPING)
    roles = {choice["role"]: (name, choice["unit"]) for name, choice in one.choices.items() if choice["role"]}
    assert roles == {
        "time": ("Time", "s"), "torque": ("Moment", "mN*m"), "speed": ("Shaft", "rpm"),
        "temperature": ("Temperature", "degC"), "load": ("Press", "N"),
    }  # fmt: skip
    assert one.corrections == {"torque.tare": "4 mN*m", "speed.gear_ratio": "12.5"}
    assert one.faults == []
    again = tomllib.loads(one.mapping_file())
    assert again["torque"] == {**tomllib.loads(MAPPING)["torque"]}
    assert again["load"] == {"channel": "Press", "unit": "N"}
    assert again["speed"] == {"channel": "Shaft", "unit": "rpm", "gear_ratio": 12.5}
    assert [(f["state"], f["name"]) for f in view_of(one)["files"]].count(("mapping", "mine.toml")) == 1
    assert view_of(one)["mapping_kept"] == ["[torque] 1 value"]
    assert "mine.toml" not in one.command()


def test_a_mapping_of_another_log_says_so_at_the_channels(tmp_path: Path) -> None:
    one = dropped(tmp_path, log())
    toml(one, MAPPING)
    said = {fault.at: fault for fault in one.faults}
    assert set(said) == {"lacking:torque", "lacking:speed", "lacking:load"}
    assert "names the torque channel “Moment”, which this log does not have" in said["lacking:torque"].title
    assert not line_of(one)["ready"]
    one.choose(said["lacking:torque"].mend)
    one.choose(said["lacking:speed"].mend)
    check(one)
    assert [fault.at for fault in one.faults] == ["lacking:load"]
    (mapping,) = [file for file in one.files.values() if file.state == "mapping"]
    one.remove(mapping.id)
    check(one)
    assert (one.faults, one.corrections) == ([], {})


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[torque]\ntare = 4\n", "tare"),
        ('[torque]\nunit = "kg"\n', "'kg'"),
        ("[torque]\nsing = -1\n", "Did you mean 'sign'"),
        ("[torque\n", "not valid TOML"),
    ],
)
def test_a_mistake_in_a_mapping_is_told_at_the_file(text: str, said: str, tmp_path: Path) -> None:
    one = dropped(tmp_path, log())
    with pytest.raises(HerseyError, match=re.escape(said)):
        toml(one, text)
    assert one.corrections == {}


def test_a_mapping_names_only_what_was_dropped(tmp_path: Path) -> None:
    one = dropped(tmp_path, log(), log())
    beside = list(one.files.values())[1]
    for named in ("/etc/passwd", "free.csv"):
        toml(one, f'[torque]\nno_load = "{named}"\n')
        folder = "name it passwd without its folder, and " if "/" in named else ""
        assert f"the log {named}: {folder}drop that file here too" in only(one).text
    beside.name = "free.csv"
    check(one)
    assert one.faults == []
    assert len(one.logs) == 1
    assert 'no_load = "free.csv"' in one.mapping_file()


def test_a_recipe_that_is_dropped_sets_the_options(tmp_path: Path) -> None:
    """One of the app's own: its logs and mapping are here already, and no file that it names is opened."""
    one = dropped(tmp_path, log())
    text = 'logs = ["/etc/passwd"]\nmapping = "/etc/hersey.toml"\ntare = "standing"\nisothermal = true\n'
    with pytest.raises(HerseyError, match=r"needs the mapping hersey\.toml: drop that file"):
        toml(one, text)
    assert one.options["tare"] == "none"
    toml(one, "[torque]\ngear_ratio = 2\n")
    toml(one, text)
    assert (one.options["tare"], one.options["isothermal"]) == ("standing", True)
    assert [file.name for file in one.logs] == ["log0.csv"]
    assert "passwd" not in f"{one.command()}{one.mapping_file()}{view_of(one)}"
    toml(one, 'logs = ["log0.csv"]\n')  # a recipe says all of its settings: these are the defaults
    assert (one.options["tare"], one.options["isothermal"]) == ("none", False)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            'min_dwell = "3 s"\n[signs]\ntorque = -1\n',
            "no control for min_dwell, signs of this recipe",
        ),
        ('no_load = "/etc/passwd"\n', "no control for no_load of this recipe"),
        ('load = "50 N"\ntare = "none"\n', "no control for load of this recipe"),
        ('tare = "halting"\n', "tare is 'halting': write none or standing"),
        ("tare = 3\n", "tare is 3"),
        ('logs = ["a.csv"]\ntara = "none"\n', "Did you mean 'tare'?"),
    ],
)
def test_a_recipe_that_the_page_cannot_hold_is_refused(text: str, said: str, tmp_path: Path) -> None:
    one = dropped(tmp_path, log())
    before = dict(one.options)
    with pytest.raises(HerseyError, match=re.escape(said)):
        toml(one, text)
    assert one.options == before


def test_a_file_of_other_tables_is_neither(tmp_path: Path) -> None:
    assert toml(Analysis(tmp_path), "[project]\n").state == "fault"


def test_a_channel_called_a_radius_is_taken_only_where_somebody_says_so(tmp_path: Path) -> None:
    header = "Time [s],Friction force [N],Speed [rpm],Temperature [degC],Wear [um],Track radius [mm]"
    one = dropped(tmp_path, log(header, lambda *cells: (*cells, "3", "25")))
    assert {name for name, choice in one.choices.items() if choice["role"] in ("radius", "load")} == set()
    assert one.faults == []
    one.choices["Track radius"]["role"] = "radius"
    check(one)
    assert one.faults == []


def test_a_log_that_needs_a_layout_is_read_by_the_proposed_one(tmp_path: Path) -> None:
    made = umt(tmp_path / "export.txt")
    one = dropped(tmp_path, (tmp_path / "export.txt").read_bytes())
    assert one.faults == []
    assert '[layout]\nheader = "T(s) *"\nvalues = ["Step *: Velocity {speed} rpm"]' in one.mapping_file()
    (tmp_path / "hersey.toml").write_text(one.mapping_file())
    assert wrong_with(read_with_mapping(tmp_path / "export.txt").log, made) == ""
