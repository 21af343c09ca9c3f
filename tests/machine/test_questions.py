"""The table of questions: each asks for a key that there is, and what is written reads back."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hersey.errors import HerseyError
from hersey.log.mapping import read_mapping
from hersey.machine.machine import Machine, read_machine
from hersey.machine.questions import BY_KEY, MACHINE, MAPPING, POINT, Question, lacking
from hersey.machine.writing import answers_of, machine_text, mapping_text
from hersey.units import parse

#: Units in which a person may answer, by question; the first is that of the form.
UNITS = {
    "drivetrain.stiffness": ("stiffness", ["N/mm", "N/m", "kN/m", "lbf/in"], (2, 1000)),
    "drivetrain.mass": ("mass", ["kg", "g", "lb"], (0.1, 1000)),
    "drivetrain.roll_radius": ("length", ["mm", "m", "in"], (0.5, 50)),
    "drivetrain.stick_speed": ("belt speed", ["mm/s", "in/s", "m/s"], (0.001, 9)),
    "drivetrain.stick_speed_temperature": ("temperature", ["degC", "degF"], (50, 300)),
    "limits.nip_load": ("force", ["N", "kgf", "lbf"], (0.1, 1000)),
    "limits.motor_torque": ("torque", ["N*m", "mN*m", "ozf*in"], (0.1, 1000)),
    "limits.acceleration": ("acceleration", ["mm/s^2", "m/s^2"], (0.1, 1000)),
    "limits.speed": ("belt speed", ["mm/s", "m/s"], (0.1, 900)),
}
VALUES = st.floats(0.0, 1.0).map(lambda share: float(f"{share:.4g}"))


@st.composite
def answered(draw: Any) -> dict[str, str]:
    answers = {}
    for key, (_, units, (low, high)) in UNITS.items():
        question = BY_KEY[key]
        if question.needed or draw(st.booleans()):
            value = f"{low + (high - low) * draw(VALUES):.6g} {draw(st.sampled_from(units))}"
            answers[key] = value
    if draw(st.booleans()):
        answers["limits.roll_friction"] = f"{0.01 + 2 * draw(VALUES):.4g}"
    return answers


@settings(deadline=None, max_examples=40)
@given(answers=answered(), share=st.integers(1, 90), names=st.lists(st.text(max_size=30), max_size=3))
def test_a_machine_reads_back_to_the_answers(answers: dict[str, str], share: int, names: list[str]) -> None:
    points = [{"name": name, "speed": "45.5 mm/s", "temperature": "180 degC"} for name in names]
    told = {**answers, "drivetrain.stiffness": f"{answers['drivetrain.stiffness']} ± {share} %"}
    machine = written(machine_text(told, points))
    for key, (kind, _, _) in UNITS.items():
        section, field = key.split(".")
        stated = getattr(machine if section == "drivetrain" else machine.limits, field)
        assert stated == (parse(kind, answers[key]) if key in answers else None), key
    friction = answers.get("limits.roll_friction")
    assert machine.limits.roll_friction == (None if friction is None else float(friction))
    assert machine.uncertainty["stiffness"].share == share / 100
    assert [point.speed for point in machine.points] == [0.0455] * len(names)
    for name, point in zip(names, machine.points, strict=True):
        if name.strip().isprintable() and name.strip():
            assert point.name == name.strip()


def written(text: str) -> Machine:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "machine.toml"
        path.write_text(text, encoding="utf-8")
        return read_machine(path)


FORM = {
    "drivetrain.stiffness": "11",
    "drivetrain.mass": "11 ± 10 %",
    "drivetrain.roll_radius": "0.59 in",
    "drivetrain.stick_speed": "0.1 to 1",
}


def test_a_bare_number_of_the_form_is_meant_in_the_unit_beside_it() -> None:
    machine = written(machine_text({key: BY_KEY[key].with_unit(text) for key, text in FORM.items()}))
    assert (machine.stiffness, machine.mass) == (11000.0, 11.0)
    assert machine.roll_radius == parse("length", "0.59 in")
    assert machine.uncertainty["stick_speed"].limits == (0.0001, 0.001)
    assert machine.uncertainty["mass"].share == 0.1
    assert machine.stick_speed == pytest.approx(1e-3 * 0.1**0.5, rel=1e-3)


def test_the_file_of_all_examples_is_read_and_gives_the_answers_again() -> None:
    answers = {q.key: q.example for q in MACHINE}
    points = [{q.field: q.example for q in POINT}]
    text = machine_text(answers, points)
    machine = written(text)
    assert machine.contact is not None
    assert machine.lubricant is not None
    assert machine.lubricant.model == "walther"
    import tomllib

    again, states, others = answers_of(tomllib.loads(text))
    assert others == {}
    assert (again, states) == (answers, points)


def test_what_is_not_answered_teaches_as_a_comment() -> None:
    text = machine_text({"drivetrain.mass": "11 kg"})
    for question in MACHINE:
        assert question.words in text
        assert f"{question.field} = " in text
    bare = [line for line in text.splitlines() if line and not line.startswith("#")]
    assert [line.split()[0] for line in bare] == ["[drivetrain]", "mass"]


@pytest.mark.parametrize("question", [*MACHINE, *POINT, *MAPPING], ids=lambda q: q.key)
def test_each_question_asks_for_a_key_and_its_example_is_an_answer(question: Question) -> None:
    values = question.values(question.example)
    assert question.key in values
    if question.unit:
        assert question.with_unit("2").endswith(f"2 {question.unit}")
        assert question.values(question.with_unit(f"2 {question.unit}"))


@pytest.mark.parametrize(
    ("key", "answer", "said"),
    [
        ("drivetrain.stiffness", "11", "stiffness: '11' is not a number with a unit of stiffness"),
        ("drivetrain.mass", "-3 kg", "mass is -3 kg: it must be greater than 0"),
        ("drivetrain.roll_radius", "15 kg", "not a unit of length"),
        ("drivetrain.stick_speed", "1 mm/s to 0.1 mm/s", "Write '0.1 mm/s to 1 mm/s'"),
        ("limits.roll_friction", "much", "roll_friction is 'much', not a number"),
        ("torque.sign", "2", "sign is 2: it must be 1 or -1"),
        ("lubricant.viscosities", "40 degC 5 mPa*s", "Write temperature and viscosity"),
        ("lubricant.viscosities", "40 degC: 5 mPa*s", "a law needs two or three"),
    ],
)
def test_a_wrong_answer_is_refused_in_the_reader_s_words(key: str, answer: str, said: str) -> None:
    with pytest.raises(HerseyError) as refused:
        BY_KEY[key].values(answer)
    assert said in str(refused.value)


def test_what_the_others_make_needed() -> None:
    assert lacking({}) == []
    assert {q.field for q in lacking({"limits.nip_load": "300 N"})} == {
        "stiffness", "mass", "roll_radius", "stick_speed",
    }  # fmt: skip
    drivetrain = {q.key: q.example for q in MACHINE if q.section == "drivetrain"}
    assert lacking(drivetrain) == []
    assert "limits.nip_load" in {q.key for q in lacking({**drivetrain, "contact.length": "220 mm"})}


def test_a_mapping_reads_back_to_the_answers(tmp_path: Path) -> None:
    answers = {
        "torque.channel": 'Tq "set" \u00b5',
        "torque.unit": "9.84 mN*m / 100",
        "torque.sign": "-1",
        "speed.channel": "n",
        "speed.unit": "rpm",
        "temperature.channel": "T",
        "temperature.unit": "degC",
        "temperature.offset": "-1.5 K",
        "time.every": "2 ms",
    }
    path = tmp_path / "hersey.toml"
    path.write_text(mapping_text(answers), encoding="utf-8")
    mapping = read_mapping(path)
    assert mapping.channels == {"torque": answers["torque.channel"], "speed": "n", "temperature": "T"}
    assert mapping.units == {"torque": "9.84 mN*m / 100", "speed": "rpm", "temperature": "degC"}
    assert (mapping.torque.sign, mapping.temperature.offset, mapping.time.every) == (-1, -1.5, 0.002)
