"""A warning is data: a kind with numbers in SI; its words are made where it is shown."""

from __future__ import annotations

import ast
import string
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from hersey.errors import ROTATION, speak
from hersey.result import Record
from hersey.schema.record import part_of
from hersey.schema.warning import Warning

ROOM = Path(__file__).parents[2] / "python" / "hersey"


@dataclass(frozen=True)
class Warned(Record):
    """A result that is warned of."""

    warnings: tuple[Warning, ...] = ()


def test_words_show_numbers_in_the_units_of_people() -> None:
    words = "{speed:.3g rpm}, {cold:.0f degC}, {film:.2g um}, {share:.1%}, {one:row|rows}, {two:row|rows}"
    warning = Warning("all", words, speed=3.141592653589793, cold=273.15, film=2e-7, share=0.5, one=1, two=2)
    assert warning.text == "30 rpm, 0 degC, 0.2 um, 50.0%, row, rows."
    assert warning.values["speed"] == 3.141592653589793


def test_a_way_out_is_in_the_words_of_the_way_in() -> None:
    warning = Warning("apart", "they differ", remedy="fit one alone with {how}", how=ROTATION)
    assert str(warning) == "they differ. Fit one alone with rotation"
    speak("terminal")
    try:
        assert str(warning) == "they differ. Fit one alone with --rotation"
    finally:
        speak("python")
    assert warning.to_dict()["values"] == {}


def test_a_sentence_names_what_it_concerns() -> None:
    warning = Warning("cut off", "the last line was cut off", where="bench.csv")
    assert warning.sentence == "bench.csv: the last line was cut off."
    assert warning.within("unit 3").sentence == "unit 3: bench.csv: the last line was cut off."
    assert Warning("a", "is it so?").sentence == "Is it so?"
    assert Warning("a", "nip_load is far off").sentence == "nip_load is far off."


def test_what_a_file_says_is_no_template_and_shows_its_signs() -> None:
    warning = Warning("name", "'{column}' says nothing", column="{0.__class__}\x1b[2J")
    assert warning.text == r"'{0.__class__}\x1b[2J' says nothing."


def test_json_holds_kind_numbers_and_words() -> None:
    warning = Warning(
        "thin",
        "{film:.1g} m",
        severity="act",
        title="The {part} is thin",
        where="nip",
        part="nip",
        film=1e-7,
        far=float("inf"),
    )
    said = Warned((warning,)).to_dict()
    assert said == {
        "warnings": [
            {
                "kind": "thin",
                "severity": "act",
                "where": "nip",
                "values": {"part": "nip", "film": 1e-7, "far": None},
                "title": "The nip is thin",
                "text": "1e-07 m.",
            }
        ]
    }
    part = part_of(Warned).model_validate(said)
    assert part.model_dump(mode="json") == said


def made() -> Iterator[tuple[str, ast.Call, dict[str, ast.expr]]]:
    """Every warning that the package makes, with its place and the names assigned in its function."""
    for path in sorted(ROOM.rglob("*.py")):
        if path.name == "warning.py":
            continue
        for function in ast.walk(ast.parse(path.read_text())):
            if not isinstance(function, ast.FunctionDef):
                continue
            assigned: dict[str, ast.expr] = {}
            for node in sorted(
                (each for each in ast.walk(function) if isinstance(each, ast.Assign | ast.Call)),
                key=lambda each: (each.lineno, each.col_offset),
            ):
                if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
                    assigned[node.targets[0].id] = node.value
                elif isinstance(node, ast.Call) and getattr(node.func, "id", "") == "Warning":
                    yield f"{path.relative_to(ROOM)}:{node.lineno}", node, dict(assigned)


def constants(node: ast.expr, assigned: dict[str, ast.expr]) -> Iterator[str]:
    """The texts that a literal, or a choice between literals, may be."""
    match node:
        case ast.Constant(value=str(text)):
            yield text
        case ast.Name(id=name) if name in assigned:
            yield from constants(assigned[name], {})
        case ast.IfExp(body=body, orelse=orelse):
            yield from constants(body, assigned)
            yield from constants(orelse, assigned)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            yield from (
                one + other for one in constants(left, assigned) for other in constants(right, assigned)
            )
        case _:
            raise AssertionError(f"{ast.unparse(node)} is not a literal")


@pytest.mark.parametrize("name", ["words", "remedy", "title"])
def test_words_of_warnings_are_literals_and_name_their_values(name: str) -> None:
    seen = 0
    for place, call, assigned in made():
        given = {keyword.arg: keyword.value for keyword in call.keywords}
        words = call.args[1] if name == "words" else given.get(name)
        if words is None:
            continue
        seen += 1
        for text in constants(words, assigned):
            named = {field for _, field, _, _ in string.Formatter().parse(text) if field is not None}
            named -= {"measured", "against"}  # quantity and speed, known to every warning
            assert None in given or named <= given.keys(), f"{place}: {named - given.keys()}"
    assert seen


def test_one_that_was_kept_is_shown_as_it_was() -> None:
    warning = Warning("cut", "'{line}' was cut at {speed:.3g rpm}", title="{line}", line="{x}", speed=1.0)
    part = part_of(Warned).model_validate(Warned((warning,)).to_dict()).warnings[0]
    again = Warning.read(part)
    assert again.to_dict() == warning.to_dict()
    assert again.sentence == warning.sentence


def test_under_a_title_it_still_names_what_it_concerns() -> None:
    unused = Warning("not used", "it contradicts {count} dwells", where="start.csv", count=3)
    flag = unused.titled("A recording was not used", section="band")
    assert (flag.where, flag.text) == ("band", "start.csv: it contradicts 3 dwells.")
    assert unused.titled("", section="band").values["count"] == 3


def test_what_was_kept_brings_numbers_and_texts_alone() -> None:
    values = {"count": 3, "inside": [1], "severity": "act", "name": "x", "nothing": None}
    kept = Warning.said("cut", "a {b}", title="", severity="note", where="a\x1b[2J", values=values)
    assert kept.values == {"count": 3, "name": "x", "nothing": None}
    assert (kept.severity, kept.where, kept.text) == ("note", r"a\x1b[2J", "A {b}.")


def test_one_kind_has_one_set_of_values() -> None:
    """Code that asks for a kind finds the same numbers wherever it was made."""
    given: dict[str, dict[str, frozenset[str | None]]] = {}
    for place, call, _ in made():
        if isinstance(call.args[0], ast.Constant):
            own = {keyword.arg for keyword in call.keywords} - {"severity", "title", "where", "remedy"}
            given.setdefault(str(call.args[0].value), {})[place] = frozenset(own)
    assert {kind: each for kind, each in given.items() if len(set(each.values())) > 1} == {}
