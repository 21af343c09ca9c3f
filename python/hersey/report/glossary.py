"""The glossary: terms of commands, reports and docs, each in a few sentences.

The entries are in ``glossary.toml``, which is read when one is asked for.
"""

from __future__ import annotations

import re
import textwrap
import tomllib
import unicodedata
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from importlib import resources

from hersey.errors import meant

#: Ends of sentences: a full stop before a capital.
_SENTENCES = re.compile(r"(?<=\.) (?=[A-Z])")
_WIDTH = 110
_HEAD = """# Glossary

Terms of commands, reports and docs. `hersey explain TERM` prints an entry, `hersey explain` lists them all.
This page is made from `python/hersey/report/glossary.toml`.
"""


@dataclass(frozen=True)
class Entry:
    """A term, its other spellings, its meaning with symbol and unit, and the terms to read next."""

    term: str
    also: tuple[str, ...]
    text: str
    see: tuple[str, ...]

    @property
    def spellings(self) -> tuple[str, ...]:
        """The term and its other spellings."""
        return (self.term, *self.also)

    @property
    def sentences(self) -> list[str]:
        """Its meaning, sentence by sentence."""
        return _SENTENCES.split(self.text)


@cache
def entries() -> tuple[Entry, ...]:
    """Return all entries, terms in alphabetical order."""
    text = (resources.files("hersey.report") / "glossary.toml").read_text(encoding="utf-8")
    found = [
        Entry(each["term"], tuple(each["also"]), each["text"], tuple(each["see"]))
        for each in tomllib.loads(text)["terms"]
    ]
    return tuple(sorted(found, key=lambda entry: entry.term.casefold()))


def key(name: str) -> str:
    """Return a name without case, spaces and hyphens, Greek letters spelled out.

    Examples
    --------
    >>> key("Stick-Slip"), key("\N{GREEK SMALL LETTER LAMDA} ratio"), key("V*")
    ('stickslip', 'lambdaratio', 'vstar')
    """
    spelled = "".join(_letter(sign) for sign in name.replace("*", "star"))
    return "".join(sign for sign in spelled.casefold() if sign.isalnum())


def find(name: str) -> Entry | None:
    """Return the entry of a term or of another spelling of it, None if there is none."""
    wanted = key(name)
    return next((each for each in entries() if wanted in map(key, each.spellings)), None)


def nearest(name: str) -> tuple[str, ...]:
    """Return the terms or spellings that a name with a slip may mean; empty if there is none.

    A term of another entry that begins with the nearest one, as the Stribeck curve, comes first.
    """
    known = {key(spelling): spelling for each in entries() for spelling in each.spellings}
    near = known.get(meant(key(name), known), "")
    if not near:
        return ()
    others = [each for each in entries() if near not in each.spellings]
    longer = [
        spelling
        for each in others
        for spelling in each.spellings
        if spelling.casefold().startswith(f"{near} ".casefold())
    ]
    return (*longer, near)


def meanings(terms: Iterable[str]) -> dict[str, str]:
    """Return the meaning of each of these terms, by term."""
    by_term = {each.term: each.text for each in entries()}
    return {term: by_term[term] for term in terms}


def markdown() -> str:
    """Return the glossary as a page of the docs."""
    return "\n".join([_HEAD, *map(_section, entries())])


def _section(entry: Entry) -> str:
    parts = [f"## {_escaped(entry.term)}", textwrap.fill(_escaped(entry.text), _WIDTH)]
    if entry.also:
        parts.append(textwrap.fill(_escaped(f"Also: {', '.join(entry.also)}."), _WIDTH))
    parts.append(f"See {', '.join(_link(term) for term in entry.see)}.\n")
    return "\n\n".join(parts)


def _letter(sign: str) -> str:
    name = unicodedata.name(sign, "")
    return name.split()[-1].replace("LAMDA", "LAMBDA") if name.startswith("GREEK ") else sign


def _escaped(text: str) -> str:
    return text.replace("*", r"\*").replace("[[", "`[[").replace("]]", "]]`")


def _link(term: str) -> str:
    anchor = re.sub(r"[^\w -]", "", term.lower()).replace(" ", "-")
    return f"[{_escaped(term)}](#{anchor})"
