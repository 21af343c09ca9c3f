"""Find numbers without a unit in what a person reads, in the terminal and on the page.

A number has a unit if one follows it, its interval or the list that it is part of, or if its table names one.
`COUNTED`, `NAMES` and `TOPICS` list what has none.
"""

from __future__ import annotations

import re

_NUMBER = r"[+\-\u2212]?\d[\d\u202f]*(?:\.\d+)?(?:e[+\-\u2212]?\d+|·10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?"
_BASE = r"[kMmµun]?(?:N|m|s|h|K|W|J|g|Hz|Pa|V|A|mol)(?:\^?[23²³])?"
_UNIT = (
    rf"(?:%(?:/K)?|°C|degC|(?:min|days?|rpm|rad/s|times|pages?)\b|{_BASE}(?:(?:[·*/]|\s(?=[ms]\b)){_BASE})*(?:/rad|/page)?)"
    r"(?![\w/])"
)
#: A number with its unit, those before it in a range, list or interval, and its interval behind it.
_BETWEEN = r"\s*(?:,|\bto(?: about)?\b|\band\b|\bor\b|\bof\b|\u2013|±|\+/-|\[|\])\s*"
_MEASURED = re.compile(
    rf"{_NUMBER} \+/- .*sensors \+/- {_NUMBER}\s+{_UNIT}|"
    rf"{_NUMBER}(?:{_BETWEEN}{_NUMBER})*\]?\s?{_UNIT}(?:\s*\[[^\]]*\])?(?:\s*\(sensors [^)]*\))?"
)
#: What is counted, behind its number.
COUNTED = re.compile(
    rf"{_NUMBER}(?: (?:of|and|to) {_NUMBER})* (?:\w+[ -]){{0,2}}(?:draws?|dwells?|rows?|places?|runs?"
    r"|specimens?|others|failed|logs?|slips?|files?|spikes?|stretch(?:es)?|points?|temperatures?|speeds?|samples?|profiles?|warnings?|coasts?|coast-downs?|more)\b"
)
#: Names that hold a number: equations, specimens, quantiles, files, dates, versions, columns, references.
NAMES = re.compile(
    r"\(\d+\)$|Eq\. \d+|\b[A-Z]\w{0,3}\d+\b|\w*[-_.]\w*\d[\w.-]*\.\w+|\d{4}-\d\d-\d\d\S*"
    r"|\d{1,2} [A-Z][a-z]{2} \d{4}|\d\d:\d\d|hersey \d[\w.]*|\w+_\d+\b|seed \d+|\(\d{4}\)"
)
#: Words of a line whose other numbers have no unit.
TOPICS = re.compile(
    r"exponent|\w\^|slope|^\W*(?:[abc]|c_mixed|c below .*)\b"  # powers
    r"|\bp [=<]|\bC\(|squared|chi-square|AICc|[Cc]orrelat|variables +=|data points +="  # statistics
    r"|friction = |ratio|factor|B/A|B over A|Hersey number|Uncertainty|\u00d7|weight"  # ratios
    r"|treated as correlated|of a flooded film"
    r"|^\s*dwells\s"  # a count, its label in front
)
_CELL = re.compile(rf"[\[(]?{_NUMBER}(?:,? [\[(]?{_NUMBER}[\])]?)*[\])]?|-|none|x {_NUMBER}.*")


#: Headings of columns whose numbers have no unit, or that of the column before.
PURE = re.compile(
    r"exponent|ratio|rows|gaps|stretches|p of|p-value|AICc|sha256|film over flooded film|^run$|^(from|to)$"
    r"|^± \(1 s\.e\.\)$|^95 % (?:from|interval)$|^(?:Value|Meaning)$",
    re.IGNORECASE,
)


def bare_columns(rows: list[list[str]]) -> list[str]:
    """Return the headings of a table, its first row, of columns of numbers whose unit is missing."""
    heads, *body = rows
    of_a_unit = re.compile(rf"(?:^|[(, ])\s?{_UNIT}\)?$|\((?:1|as given)\)$")
    return [
        head
        for head, cells in zip(heads, zip(*body, strict=True), strict=True)
        if any(bare(cell) for cell in cells) and not of_a_unit.search(head) and not PURE.search(head)
    ]


def bare(text: str) -> list[str]:
    """Return the lines of a text, which is not wrapped, that hold a number whose unit is missing."""
    found = []
    for block in re.split(r"\n\s*\n", text):
        heading = ""
        of_table = re.search(rf"[(\s]{_UNIT}[)\s]", block) is not None
        for line in block.splitlines():
            if not line.startswith(" "):
                heading = line
            elif re.search(rf"[(,] ?{_UNIT}[),]", heading) or TOPICS.search(heading):
                continue
            cells = re.split(r"\s{2,}|\t", line.strip())
            if of_table and sum(_CELL.fullmatch(cell) is not None for cell in cells) >= 2:
                continue
            for sentence in re.split(r"(?<=[.;:])\s", line):
                rest = NAMES.sub("", COUNTED.sub("", _MEASURED.sub("", sentence)))
                if re.search(r"(?<![\w^])\d", rest) and not TOPICS.search(line):
                    found.append(sentence.strip())
    return found
