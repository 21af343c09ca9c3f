"""How hard a text is to read: the grade of Flesch and Kincaid, the years of school that it takes.

Grade = 0.39 words per sentence + 11.8 syllables per word - 15.59 (Kincaid et al., Naval Technical Training
Command, Research Branch Report 8-75, 1975). Measure files with ``python -m tests.readability FILE...``.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

#: A syllable for each group of vowels; a silent e at the end is none.
_SYLLABLE = re.compile(r"[aeiouy]+", re.IGNORECASE)
_SILENT = re.compile(r"(?<![aeiouyl])e$|(?<=[aeiouy])le$|(?<![td])ed$|(?<![cgsxz])es$", re.IGNORECASE)
#: What is not prose, and what stands for it.
_NOT_PROSE = (
    (re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE), "\n"),
    (re.compile(r"<!--.*?-->", re.DOTALL), " "),
    (re.compile(r"^\s*\|.*$", re.MULTILINE), "\n"),  # tables
    (re.compile(r"\$\$.*?\$\$", re.DOTALL), " "),
    (re.compile(r"!?\[([^\]]*)\]\([^)]*\)"), r"\1"),
    (re.compile(r"`[^`]*`"), "it"),
    (re.compile(r"\$[^$\n]+\$"), "it"),
    (re.compile(r"\{[^{}]*\}"), "3"),
    (re.compile(r"https?://\S+"), "it"),
)
#: A sentence ends with its mark before a blank, an empty line, or the start of a heading or item.
_END = re.compile(r"[.!?](?=\s)|\n\s*\n|\n(?=\s*(?:[-*#>]|\d+\.)\s)")
_WORD = re.compile(r"[A-Za-z][A-Za-z'-]*")


def sentences(text: str) -> list[list[str]]:
    """Return the words of each sentence of prose; code, tables, formulas and addresses are none."""
    for pattern, instead in _NOT_PROSE:
        text = pattern.sub(instead, text)
    found = [_WORD.findall(part) for part in _END.split(text)]
    return [words for words in found if words]


def grade(text: str) -> float:
    """Return the grade of a text; that of no text is 0."""
    parts = sentences(text)
    words = [word for part in parts for word in part]
    if not words:
        return 0.0
    syllables = sum(map(_syllables, words))
    return 0.39 * len(words) / len(parts) + 11.8 * syllables / len(words) - 15.59


def _syllables(word: str) -> int:
    return max(1, len(_SYLLABLE.findall(_SILENT.sub("", word))))


if __name__ == "__main__":
    for name in sys.argv[1:]:
        text = Path(name).read_text(encoding="utf-8")
        count = sum(map(len, sentences(text)))
        sys.stdout.write(f"{grade(text):5.1f}  {count:6d} words  {name}\n")
