"""Help shows all of its words: brackets that name a table of a file are no markup."""

from __future__ import annotations

import re

import click
import pytest

from hersey.cli.application import VERBS, load

#: Names in brackets that are markup of the terminal, or made by the command line itself.
_MARKUP = {"bold", "/bold", "default", "required", "default:"}
_BRACKETS = re.compile(r"(?<!\\)\[([\w/:]+)[^\]]*\]")


def _commands(verb: str) -> list[click.Command]:
    loaded = load(verb)
    return [*loaded.commands.values()] if hasattr(loaded, "commands") else [loaded]


@pytest.mark.parametrize("verb", VERBS)
def test_no_table_of_a_file_is_taken_for_markup(verb: str) -> None:
    for command in _commands(verb):
        texts = [command.help or "", *(getattr(each, "help", None) or "" for each in command.params)]
        for text in texts:
            lost = set(_BRACKETS.findall(text)) - _MARKUP
            assert not lost, f"{command.name}: {text}"
