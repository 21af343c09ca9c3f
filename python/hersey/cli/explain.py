"""The glossary: ``hersey explain``."""

from __future__ import annotations

import sys
import textwrap
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import argument, grouped
from hersey.cli.printing import Printing
from hersey.cli.terminal import width

if TYPE_CHECKING:
    from hersey.report.glossary import Entry

_TERM = "Term, e.g. V* or 'stick speed'; if omitted, all terms are listed."


@grouped
def explain(term: Annotated[list[str] | None, argument("TERM", _TERM)] = None, *, printing: Printing) -> None:
    """Explain a term of reports and docs, or list all terms.

    Example: [bold]hersey explain stick speed[/bold]

    Case, spaces and hyphens do not matter.
    """
    from hersey.errors import ParameterError
    from hersey.report.glossary import entries, find, nearest

    name = " ".join(term or [])
    found = find(name) if name else None
    if name and found is None:
        close = nearest(name)
        quoted = " or ".join(f"'{each}'" for each in close)
        advice = f"did you mean {quoted}?" if close else "type hersey explain to list all terms"
        raise ParameterError(f"'{name}' is not in the glossary; {advice}")
    if printing.json({"terms": [found] if found else entries()}):
        return
    if found:
        printing.text(*_lines(found))
    elif printing.verbose:
        printing.text("\n\n".join("\n".join(_lines(each)) for each in entries()))
    else:
        printing.text(*_listed(entries()))


def _listed(entries: tuple[Entry, ...]) -> list[str]:
    label = max(len(each.term) for each in entries)
    room = width(sys.stdout) - label - 2
    return [
        f"{each.term:{label}}  {textwrap.shorten(each.sentences[0], room, placeholder=' ...')}"
        for each in entries
    ]


def _lines(entry: Entry) -> list[str]:
    also = [f"Also: {', '.join(entry.also)}"] if entry.also else []
    return [entry.term, entry.text, *also, f"See: {', '.join(entry.see)}"]
