"""Mistakes end in words at the control that mends them, and its button mends."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from hersey.app.analysis import Analysis, Dropped
from hersey.app.channels import Fault
from hersey.app.looking import look
from hersey.errors import HerseyError
from tests.cli.test_bad_input import staircase

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
    one.check()
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
    assert one.line()["ready"]
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
        "423 °C is hotter than any belt here. Read as K it is 100 to 150 °C.",
        "Read as K",
    ),
    "Celsius called kelvin": (
        log("Time [s],Torque [N*m],Speed [rpm],Temperature [K]"),
        "unit:Temperature",
        "colder than any belt here",
        "Read as °C",
    ),
    "another unit for torque": (
        log("Time [s],Torque [rpm],Speed [rpm],Temperature [degC]"),
        "unit:Torque",
        "rpm is no unit of torque",
        "Read as N·m",
    ),
    "no temperature": (
        log("Time [s],Torque [N*m],Speed [rpm]", lambda t, q, n, _: (t, q, n)),
        "lacking:temperature",
        "No channel is the temperature.",
        "Run without temperature",
    ),
    "two torques": (
        log(
            "Time [s],Torque A [N*m],Speed [rpm],Temperature [degC],Torque B [N*m]",
            lambda t, q, n, c: (t, q, n, c, 1.5 * float(q)),
        ),
        "role:Torque A",
        "Two channels claim torque.",
        "Keep this one",
    ),
    "no speed": (
        log("Time [s],Torque [N*m],Foo,Temperature [degC]"),
        "lacking:speed",
        "No channel is the speed. Choose one",
        "",
    ),
    "a speed of another name": (
        log(
            "Time [s],Torque [N*m],Foo,Temperature [degC],n [Hz]",
            lambda t, q, n, c: (t, q, n, c, float(n) / 60),
        ),
        "unit:n",
        "Hz is no unit of speed",
        "Read as rev/s",
    ),
    "a dead speed": (
        log(
            "Time [s],Torque [N*m],Speed [rpm],Temperature [degC],Shaft [rad/s]",
            lambda t, q, n, c: (t, q, 0, c, float(n) / 9),
        ),
        "role:Speed",
        "It holds 0 rpm throughout. A dead channel",
        "Use “Shaft”",
    ),
    "rows without a number": (
        log(change=lambda t, q, n, c: (t, "" if float(t) % 1 < 0.25 else q, n, c)),
        "role:Torque",
        "rows lack a number",
        "Leave these rows out",
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
        "Time is out of order. Line 203: time runs ahead",
        "",
    ),
    "a friction force": (
        log("Time [s],Friction force [N],Speed [rpm],Temperature [degC]"),
        "field:radius.value",
        "A friction force needs its radius.",
        "",
    ),
    "not a log": (b"%PDF-1.4\n1 0 obj\n<<>>\nendobj\n", "file:", "holds no table of numbers", "Remove"),
    "an empty file": (b"", "file:", "is empty", "Remove"),
    "a damaged file": (b"\x89HDF\r\n\x1a\n" + bytes(200), "file:", "damaged", "Remove"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_ends_in_words_at_its_control(mistake: str, tmp_path: Path) -> None:
    content, at, said, button = MISTAKES[mistake]
    one = dropped(tmp_path, content)
    fault = only(one)
    assert fault.at.startswith(at)
    assert said in f"{fault.title} {fault.text}"
    assert fault.button == button
    assert not one.line()["ready"]
    if button:
        one.choose(fault.mend)
        one.check()
        if button == "Use “Shaft”":
            assert one.choices["Shaft"] == {"role": "speed", "unit": "rad/s"}
        assert one.faults == []


def test_what_is_only_doubtful_can_be_kept(tmp_path: Path) -> None:
    one = dropped(tmp_path, MISTAKES["kelvin called Celsius"][0])
    assert only(one).keep == "Keep °C"
    one.kept.add(only(one).key)
    one.check()
    assert one.faults == []


def test_the_radius_of_a_friction_force_is_given_in_words_of_its_reader(tmp_path: Path) -> None:
    one = dropped(tmp_path, MISTAKES["a friction force"][0])
    for text, faults in (("25 kg", 1), ("25", 0)):
        one.choose({"corrections": {"radius.value": text}})
        one.check()
        assert len(one.faults) == faults, one.faults
    assert 'value = "25 mm"' in one.mapping_file()


def test_a_motor_s_current_becomes_a_torque(tmp_path: Path) -> None:
    one = dropped(tmp_path, log("Time [s],Motor [A],Speed [rpm],Temperature [degC]"))
    one.choose({"roles": {"Motor": "torque"}})
    one.check()
    assert only(one).at == "field:torque.motor_constant"
    one.choose({"corrections": {"torque.motor_constant": "35"}})
    one.check()
    assert one.faults == []
    assert 'motor_constant = "35 mN*m/A"' in one.mapping_file()


def test_a_log_that_is_unlike_the_first_says_so(tmp_path: Path) -> None:
    one = dropped(tmp_path, log(), log("Time [s],Moment [N*m],Speed [rpm],Temperature [degC]"))
    fault = only(one)
    assert "no channel “Torque”" in fault.text
    assert fault.at.startswith("file:")
    one.choose(fault.mend)
    one.check()
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
        "This is needed. Such as 11 kg",
    ),
    "a value of another kind": (
        {"answers": {"drivetrain.mass": "11 N"}},
        "field:drivetrain.mass",
        "'N' is not a unit of mass",
    ),
    "a word": ({"answers": {"limits.roll_friction": "low"}}, "field:limits.roll_friction", "write a number"),
    "a negative value": (
        {"answers": {"drivetrain.roll_radius": "-15"}},
        "field:drivetrain.roll_radius",
        "greater than 0",
    ),
    "a point without a speed": ({"add": True}, "field:points.0.speed", "This is needed."),
    "half a nip": (
        {"answers": {"contact.length": "220"}},
        "field:contact.rubber_thickness",
        "say nothing without it",
    ),
    "TOML that breaks off": ({"text": "[drivetrain]\nmass = \n"}, "toml", "line 2"),
    "TOML without a unit": (
        {"text": "[drivetrain]\nmass = 11\n"},
        "toml",
        "drivetrain.mass is 11: write a string with its unit",
    ),
    "a log in its place": ({"text": "a,b\n1,2\n"}, "toml", "not valid TOML"),
}


@pytest.mark.parametrize("mistake", MACHINES)
def test_a_mistake_about_the_machine_stands_at_its_field(mistake: str, tmp_path: Path) -> None:
    given, at, said = MACHINES[mistake]
    one = dropped(tmp_path, log())
    one.take_machine({"answers": DRIVETRAIN})
    one.check()
    assert one.faults == []
    one.take_machine(given)
    one.check()
    at_fault = {fault.at: f"{fault.title} {fault.text}" for fault in one.faults}
    assert said in at_fault[at]
    assert not one.line()["ready"]


def test_form_and_text_say_the_same(tmp_path: Path) -> None:
    one = Analysis(tmp_path)
    one.take_machine({"answers": {**DRIVETRAIN, "drivetrain.mass": "11 kg ± 10 %"}})
    one.take_machine({"add": True})
    one.take_machine({"point": 0, "answers": {"points.speed": "200", "points.temperature": "180"}})
    one.check()
    assert one.turn("toml") == ""
    text = one.text
    one.check()
    assert one.faults == []
    assert one.turn("form") == ""
    assert one.machine_file() == text
    one.take_machine({"text": f'{text}\n[heat]\nfilm_capacity = "1 J/K"\n'})
    one.faults = []
    assert "the form does not ask for heat.film_capacity" in one.turn("form")
    assert one.mode == "toml"


def test_a_machine_s_file_that_is_dropped_is_taken(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text('[drivetrain]\nmass = "11 kg"\n')
    one = Analysis(tmp_path)
    assert one.take_file(Dropped("mine.toml", path))
    assert (one.mode, one.text) == ("toml", path.read_text())
    path.write_text("[torque]\n")
    assert not one.take_file(Dropped("mine.toml", path))
