"""Every command that the docs type exists, and so does each of its options."""

from __future__ import annotations

import contextlib
import re
import shlex
from pathlib import Path
from typing import Any

import pytest

from hersey.cli.application import VERBS, load
from tests.conftest import ROOT
from website.gallery import blocks
from website.navigation import DOCS

FILES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(DOCS.rglob("*.md"))]
_BLOCK = re.compile(r"^```(?:sh|bash|console)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
_FLAG = re.compile(r"(?<![\w`-])(--[a-z][a-z-]*)")


def lines(file: Path) -> list[str]:
    """Return the lines of the blocks of a page that type a command of hersey."""
    text = file.read_text(encoding="utf-8")
    typed = [line for block in _BLOCK.findall(text) for line in block.replace("\\\n", " ").splitlines()]
    return [line.strip().removeprefix("$ ") for line in typed if re.match(r"\s*(\$ )?hersey\b", line)]


TYPED = {line: file.name for file in FILES for line in lines(file)}


def parsed(line: str) -> dict[str, Any]:
    """Return the parameters that a line gives a command; none that it does not know."""
    words = shlex.split(line, comments=True)[1:]
    words = words[: next((i for i, word in enumerate(words) if word in {">", "|", "&&", "2>", ">>"}), None)]
    if not words or words == ["--version"]:
        return {}
    command = load(words[0])
    name, *given = words
    if inner := getattr(command, "commands", None):
        name, *given = given
        command = inner[name]
    if given in (["--help"], ["-h"]):
        return {}
    with command.make_context(name, given) as context:
        return dict(context.params)


@pytest.mark.parametrize("line", TYPED, ids=lambda line: f"{TYPED[line]}: {line[:60]}")
def test_a_line_can_be_typed(line: str, examples_here: Path) -> None:
    with contextlib.chdir(examples_here):
        parsed(line)


def test_lines_are_found() -> None:
    assert len(TYPED) > 60
    assert parsed("hersey campaign add a.hersey b.csv --unit F1 --age '1 h' > c.txt")["unit"] == "F1"


@pytest.mark.parametrize(
    "line", ["hersey nothing", "hersey map a.toml --tire standing", "hersey campaign sing"]
)
def test_a_line_that_cannot_be_typed_is_seen(line: str) -> None:
    with pytest.raises(Exception, match=r"nothing|tire|sing"):
        parsed(line)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_commands_in_a_sentence_exist(file: Path) -> None:
    for typed in re.findall(r"`hersey ([a-z][^`\n]*)`", file.read_text(encoding="utf-8")):
        verb = typed.split()[0]
        assert verb in VERBS, typed
        command = load(verb)
        known = {"--help"}
        for each in (command, *getattr(command, "commands", {}).values()):
            known |= {flag for option in each.params for flag in (*option.opts, *option.secondary_opts)}
        assert set(_FLAG.findall(typed)) <= known, typed


def test_every_picture_of_the_gallery_stands_below_the_code_that_makes_it() -> None:
    shown = {name for _, _, pictures in blocks() for name in pictures}
    folder = DOCS / "images" / "gallery"
    assert shown == {each.relative_to(folder).as_posix() for each in folder.rglob("*.png")}
    for _, code, pictures in blocks():
        for name in pictures:
            made_in = name.split("/")[0] if "/" in name else name
            assert made_in in code, f"{name} is not made by: {code}"
