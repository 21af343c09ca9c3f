"""Lines of a TOML file: which one holds a key, and what one that is not TOML should be."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Collection, Iterator
from typing import NamedTuple

#: Characters of a text and of a line in which corrections are tried; lines that a message names, and mistakes
#: of one text that are looked for.
_MOST, _LONGEST, _NAMED, _REPEATED = 20_000, 500, 5, 10
#: A key of a table, the value after it, and a comment at the end of a line.
_KEY = r"[A-Za-z0-9_-]+(?:\.[A-Za-z0-9_-]+)*"
_STATED = re.compile(r"\s*(?P<key>[^=:\"']+?)\s*(?P<sign>:=|==|=>|=|:)\s*(?P<value>.*)")
_UNSIGNED = re.compile(rf"\s*(?P<key>{_KEY})(?P<sign>)\s+(?P<value>[\"'\d].*)")
_COMMENT = re.compile(r"(?P<body>.*?)(?P<comment>\s+#.*)?")
_HEADER = re.compile(r"\s*(\[\[?)\s*([A-Za-z0-9_.\"' -]+?)\s*\]\]?\s*(?:#.*)?")
_BEGUN = re.compile(rf"\s*({_KEY}|\"[^\"]*\")\s*=")
_TABLE = re.compile(r"(\[{0,2})\s*([A-Za-z_][\w. -]*?)\s*(\]{0,2})\s*:?")
_TWO = re.compile(rf"(\"[^\"]*\"|'[^']*'|[^\"'\s,;]+)[\s,;]+({_KEY}\s*=.*)")
#: A number and its unit in brackets.
_BRACKETED = re.compile(r"\"?([-+]?\d[\d.,]*)\"?\s*[\[(]\s*([^\])\"]+?)\s*[\])]\"?")
#: Where the parser of Python 3.11 to 3.13 names the place; later ones have it as a number.
_PLACE = re.compile(r"\(at line (\d+), column (\d+)\)")
#: Quotes and spaces of word processors and web pages, with those of TOML.
_DOUBLE, _SINGLE = "\u201c\u201d\u201e\u201f\u00ab\u00bb\u2033", "\u2018\u2019\u201a"
_SPACES = "\u00a0\u202f\u2007\u2009\u3000"
_ODD = str.maketrans(
    _DOUBLE + _SINGLE + _SPACES, '"' * len(_DOUBLE) + "'" * len(_SINGLE) + " " * len(_SPACES)
)
#: Values that say that there is none.
_NOTHING = ("", "?", "-", "--", "none", "null", "nil", "unknown", "n/a", "na", "tbd", "todo")


class Correction(NamedTuple):
    """What is wrong with a line, and the line as it should be."""

    wrong: str
    line: str


def line_of(text: str, place: tuple[str | int, ...]) -> int:
    """Return the line (from 1) that states a place, as ``("points", 1, "speed")``, or its table; else 0."""
    best, found = 0, 0
    table: tuple[str | int, ...] = ()
    counts: dict[str, int] = {}
    for number, line in enumerate(text.split("\n"), 1):
        if header := _HEADER.fullmatch(line):
            names = tuple(part.strip(" \"'") for part in header[2].split("."))
            if header[1] == "[[":
                counts[header[2]] = counts.get(header[2], -1) + 1
                table = (*names, counts[header[2]])
            else:
                table = names
            stated = table
        elif key := _BEGUN.match(line):
            stated = (*table, *(part.strip(' "') for part in key[1].split(".")))
        else:
            continue
        if len(stated) > best and place[: len(stated)] == stated:
            best, found = len(stated), number
    return found


def as_written(text: str, place: tuple[str | int, ...]) -> tuple[int, str]:
    """Return the line (from 1) that states a place, and its text without a comment; else 0 and none."""
    line = line_of(text, place)
    return line, _without_comment(text.split("\n")[line - 1]).strip() if line else ""


def place_of(text: str, error: ValueError) -> int:
    """Return the line (from 1) of an error of the parser; the last one where the document ends too early."""
    line = getattr(error, "lineno", None)
    if line is None:
        match = _PLACE.search(str(error))
        line = int(match[1]) if match else text.rstrip().count("\n") + 1
    return int(line)


def explain(text: str, error: ValueError, lists: Collection[str] = ()) -> str:
    """Return where a text is not TOML, what is wrong and the corrected line; empty if none is known.

    ``lists`` names the tables of which there may be many. A correction is proposed only if the parser gets
    beyond that line with it.
    """
    if len(text) > _MOST:
        return ""
    if hint := _other_language(text):
        return hint
    if hint := _twice(text, place_of(text, error), lists):
        return hint
    found: list[tuple[int, Correction]] = []
    mistake: ValueError | None = error
    while mistake is not None and len(found) < _REPEATED and (first := _corrected(text, mistake)):
        number, correction, text, mistake = first
        found.append((number, correction))
    if not found:
        return ""
    number, correction = found[0]
    write = [_without_comment(line) for line in correction.line.split("\n")]
    then = f" Write: {write[0]}" if len(write) == 1 else f" Write two lines: {write[0]} and {write[1]}"
    more = [str(line) for line, _ in found[1:]]
    shown = ", ".join(more[:_NAMED]) + (", ..." if len(more) > _NAMED else "")
    also = f" (correct line{'s' if len(more) > 1 else ''} {shown} too)" if more else ""
    return f"line {number}: {correction.wrong}.{then}{also}"


def _without_comment(line: str) -> str:
    match = _COMMENT.fullmatch(line)
    return (match["body"].strip() if match else "") or line.strip()


def _corrected(text: str, error: ValueError) -> tuple[int, Correction, str, ValueError | None] | None:
    """Line and correction of the first mistake, the text with it, and the mistake that is next."""
    lines, at = text.split("\n"), place_of(text, error)
    above = (number for number in range(min(at, len(lines)) - 1, 0, -1) if "= [" in lines[number - 1])
    for number in (min(at, len(lines)), next(above, 0)):  # what ends a line too late is a list that goes on
        line = lines[number - 1] if number else ""
        if not line or len(line) > _LONGEST:
            continue
        for correction in _corrections(line):
            changed = "\n".join([*lines[: number - 1], correction.line, *lines[number:]])
            beyond = _mistake(changed)
            if beyond is None or place_of(changed, beyond) > at + correction.line.count("\n"):
                return number, correction, changed, beyond
    return None


def _mistake(text: str) -> ValueError | None:
    try:
        tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        return error if isinstance(error, ValueError) else ValueError(str(error))
    return None


def _twice(text: str, at: int, lists: Collection[str]) -> str:
    """What to say of a table or a key that was stated above already."""
    lines = text.split("\n")
    line = lines[at - 1] if at <= len(lines) else ""
    if header := _HEADER.fullmatch(line):
        for number, above in enumerate(lines[: at - 1], 1):
            same = _HEADER.fullmatch(above)
            if same and same[2] == header[2] and (same[1], header[1]) != ("[[", "[["):
                name = header[2]
                if same[1] != header[1]:
                    wrong = number if header[1] == "[[" else at
                    return f"line {wrong}: the table '{name}' is repeated. Write: [[{name}]]"
                if name in lists:
                    return (
                        f"line {at}: the table [{name}] is already in line {number}. There may be many, so "
                        f"write [[{name}]] in both lines"
                    )
                return (
                    f"line {at}: the table [{name}] is already in line {number}. "
                    f"Move its keys there and delete line {at}"
                )
    elif key := _BEGUN.match(line):
        for number in range(at - 1, 0, -1):
            above = lines[number - 1]
            if _HEADER.fullmatch(above):
                break
            if (same := _BEGUN.match(above)) and same[1] == key[1]:
                return f"line {at}: the key '{key[1]}' is already in line {number}. Delete one of the two"
    return ""


def _other_language(text: str) -> str:
    """What to say of a file in JSON."""
    if not text.lstrip().startswith("{"):
        return ""
    try:
        document = json.loads(text)
    except (ValueError, RecursionError):
        return ""
    for table, keys in document.items() if isinstance(document, dict) else ():
        for key, value in keys.items() if isinstance(keys, dict) else ():
            if isinstance(value, str | int | float) and len(str(value)) < 100:
                written = json.dumps(value, ensure_ascii=False)
                return (
                    f"it is JSON. Write each table as a line, [{table}], and below it each value as a line, "
                    f"{key} = {written}"
                )
    return "it is JSON"


def _corrections(line: str) -> Iterator[Correction]:
    """Corrections that could make a line TOML, those that change least first."""
    plain = line.translate(_ODD)
    if plain != line:
        only_spaces = not set(line) & set(_DOUBLE + _SINGLE)
        wrong = "a space is not an ordinary one" if only_spaces else 'quotes must be straight, "'
        yield Correction(wrong, plain)
    match = _COMMENT.fullmatch(plain)
    assert match is not None
    body, comment = match["body"].rstrip(), match["comment"] or ""
    if marked := re.match(r"\s*(//|;|--|!|%)\s*", body):
        yield Correction("a comment begins with #", f"# {body[marked.end() :]}{comment}")
    if body.endswith((";", ",")):
        yield Correction(f"'{body[-1]}' at the end is one too many", body.rstrip(";, ") + comment)
    table = _TABLE.fullmatch(body.strip())
    stated = _STATED.fullmatch(body) or _UNSIGNED.fullmatch(body)
    if table and not (stated and stated["value"]):
        name = table[2].replace(" ", "")
        double = "[[" in table[1] or "]]" in table[3]
        yield Correction(
            "a table is a name in brackets", f"[[{name}]]{comment}" if double else f"[{name}]{comment}"
        )
    if stated:
        key, unit = _key(stated["key"])
        for wrong, value in _values(stated["value"], unit):
            said = wrong or ("a key has no blanks" if key != stated["key"] else "after a key comes =")
            yield Correction(said, f"{key} = {value}{comment}")
        if stated["value"].strip(" \"';,.").lower() in _NOTHING:
            yield Correction(
                f"'{key}' has no value. Write one, or skip the line", f"# {body.strip()}{comment}"
            )
    elif ("[" in body or "]" in body) and not _HEADER.fullmatch(line):
        yield from (
            Correction(wrong, value + comment)
            for wrong, value in _values(body, "")
            if value.endswith(("]", "],"))
        )


def _key(written: str) -> tuple[str, str]:
    """The key, and a unit that stands behind it in brackets."""
    unit = re.search(r"[(\[]\s*(.*?)\s*[)\]]", written)
    plain = re.sub(r"[(\[].*?[)\]]", "", written).strip()
    return re.sub(r"[^A-Za-z0-9_.-]+", "_", plain).strip("_"), unit[1] if unit else ""


def _values(written: str, unit: str) -> Iterator[tuple[str, str]]:
    """What is wrong with a value (empty if not with it), and the value as it should be."""
    value = written.strip().rstrip(";,").strip()
    if unit and re.fullmatch(r"[-+]?[\d.,]+", value):
        yield "the unit belongs to the value", f'"{_point(value)} {unit}"'
        return
    yield "", value
    two = _TWO.fullmatch(value)
    if two:
        yield "each key has a line of its own", f"{two[1]}\n{two[2]}"
    mark = value[:1]
    if "\\" in value and mark == '"' and "'" not in value:
        inner = value[1:-1] if value.endswith('"') else value[1:]
        yield "in double quotes a backslash is special, so a path needs single ones", f"'{inner}'"
    if mark in ("'", '"') and value.count(mark) == 1:
        yield "a closing quote is missing", value + mark
    if value[-1:] in ("'", '"') and value.count(value[-1]) == 1:
        yield "an opening quote is missing", value[-1] + value
    if re.fullmatch(r"[-+]?\d+,\d+", value):
        yield "a number has a decimal point, no comma", _point(value)
    if re.fullmatch(r"[-+]?(\.\d+|\d+\.)", value):
        yield "a number has digits before and after its point", str(float(value))
    if value.lower() in ("true", "false", "yes", "no", "on", "off"):
        yield "write true or false", "true" if value.lower() in ("true", "yes", "on") else "false"
    if measured := _BRACKETED.fullmatch(value):
        yield "value and unit are one text in quotes", f'"{_point(measured[1])} {measured[2]}"'
        return
    if "[" in value or "]" in value:
        closed = value + "]" * (value.count("[") - value.count("]"))
        opened = "[" * (value.count("]") - value.count("[")) + closed
        if opened != value:
            yield "a bracket is missing", opened
        yield "text must be in quotes", _quoted_items(opened)
        return
    if value.lower() not in _NOTHING and not re.fullmatch(r"\"[^\"]*\"|'[^']*'", value):
        text = _point(value.replace('"', "").replace("'", ""))
        yield "text must be in quotes", f"'{text}'" if "\\" in text else f'"{text}"'


def _point(value: str) -> str:
    """A number at the start with a decimal point; three digits behind a comma could be thousands."""
    return re.sub(r"^([-+]?\d+),(\d{1,2}|\d{4,})(?!\d)", r"\1.\2", value)


def _quoted_items(listed: str) -> str:
    """A list whose texts are in quotes."""

    def quoted(match: re.Match[str]) -> str:
        item = match[0].strip()
        plain = not item or item[0] in "\"'" or re.fullmatch(r"[-+]?\d+(\.\d+)?|true|false", item)
        return match[0] if plain else match[0].replace(item, f'"{item}"')

    return re.sub(r"\"[^\"]*\"|'[^']*'|[^\[\],\"']+", quoted, listed)
