"""Terms in plain words: ``hersey explain``."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import argument
from hersey.cli.terminal import say

if TYPE_CHECKING:
    from hersey.report.glossary import Entry

_TERM = "Term, e.g. V* or 'stick speed'; if omitted, all terms are listed."
_WIDTH = 100


def explain(term: Annotated[list[str] | None, argument("TERM", _TERM)] = None) -> None:
    """Explain a term of reports and docs in plain words; without a term, list all of them.

    Example: [bold]hersey explain stick speed[/bold]

    Case, spaces and hyphens do not matter.
    """
    from hersey.errors import ParameterError
    from hersey.report.glossary import entries, find, nearest

    name = " ".join(term or [])
    if not name:
        say(*_listed(entries()))
        return
    found = find(name)
    if found is None:
        close = nearest(name)
        advice = f"did you mean '{close}'?" if close else "type hersey explain to list all terms"
        raise ParameterError(f"'{name}' is not in the glossary; {advice}")
    say(*_lines(found))


def _listed(entries: tuple[Entry, ...]) -> list[str]:
    width = max(len(each.term) for each in entries)
    return [
        f"{each.term:{width}}  {textwrap.shorten(each.sentences[0], _WIDTH - width, placeholder=' ...')}"
        for each in entries
    ]


def _lines(entry: Entry) -> list[str]:
    also = [f"Also: {', '.join(entry.also)}"] if entry.also else []
    return [entry.term, *textwrap.wrap(entry.text, _WIDTH), *also, f"See: {', '.join(entry.see)}"]
