"""Retired phrases become fewer, never more."""

from __future__ import annotations

from pathlib import Path

from tests.vocabulary import count, counts, strings

#: Place and phrase, with how often it is left there. Reword a text that uses one, and lower its number.
LEFT: dict[tuple[str, str], int] = {}


def test_retired_phrases_only_become_fewer() -> None:
    now = counts()
    for place, phrase in sorted({*now, *LEFT}):
        found, left = now.get((place, phrase), 0), LEFT.get((place, phrase), 0)
        where = f'"{phrase}" in {place} ({found} times, {left} in the table)'
        assert found <= left, f"{where}: use another word"
        assert found == left, f"{where}: lower the number in the table, so that it stays low"


def test_a_phrase_is_counted_across_a_line_break_and_in_any_case() -> None:
    assert count("taken off", "Taken\n  off, and taken off; mistaken off") == 2
    assert count("cautions", "cautions, precautions, Cautions") == 2


def test_strings_of_a_module_are_counted_and_its_names_are_not(tmp_path: Path) -> None:
    module = tmp_path / "some.py"
    module.write_text('"""One."""\n\n# two\ncautions = f"three {1} four"\n')
    assert strings(module).split() == ["One.", "three", "four"]
