"""A TOML file into tables, with errors that a person can act on.

A table is a pydantic dataclass that says of each value what it is and what is believed::

    @dataclass(frozen=True)
    class Spring(Table):
        stiffness: Annotated[float, Quantity("stiffness", 1.0, 1e10)]

Read from a file the value is a string with its unit, ``"11 N/mm"``; made in Python it is in SI already.
"""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass as plain_dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, NamedTuple, TypeVar, get_args, get_origin

from pydantic import (
    AfterValidator,
    BeforeValidator,
    TypeAdapter,
    ValidationError,
    ValidationInfo,
    model_validator,
)
from pydantic.dataclasses import dataclass
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from hersey.errors import HerseyError, ParameterError, Setting, UnitError, meant
from hersey.files.text import NO_TEXT, read_text, shown
from hersey.files.toml_lines import explain, line_of
from hersey.units import KINDS, parse

Tables = TypeVar("Tables")

#: Messages that go on with the sentence which the name of a value or a table begins, or with the name.
_GOES_ON = re.compile(r"(is|has|holds|lacks|needs) |\.")
#: No value of a file comes near this.
_LARGEST = 1e300
#: Numbers without a unit that may be at most this are ratios, which people also write in percent; percentages
#: of less are not supposed.
_LARGEST_RATIO, _LEAST_PERCENT = 10.0, 2.0
_SHARE = re.compile(r"(?:±|\+/-)?\s*([0-9]+(?:\.[0-9]*)?)\s*%")
#: Bytes of a file, characters of a text, dots of a key, and tables within tables at the most.
_MOST_BYTES, _LONGEST_TEXT, _MOST_DOTS, _DEEPEST = 4_000_000, 1000, 20, 20
#: Whole numbers of TOML have 64 bits.
_WHOLE = 1 << 63
#: Parts of a document, so far as dots in a key are told from dots in a text; what is none ends the search.
_PART = re.compile(
    r"""
    \"{3}(?:[^\\]|\\.)*?\"{3,5} | '{3}.*?'{3,5}
    | "(?:[^"\\\n]|\\.)*" | '[^'\n]*'
    | \#[^\n]* | [A-Za-z0-9_+:-]+ | [\ \t]+ | [.,=\n\r{}\[\]]
    """,
    re.DOTALL | re.VERBOSE,
)
#: The way out where a value is none of the type that is needed.
_WAY_OUT = {
    "string_type": "Write it as text in quotes",
    "bool_type": "Write true or false",
    "literal_error": "Write {expected}",
}


class Reading(NamedTuple):
    """The file that is read, and whether its values are plain numbers in consistent units."""

    path: Path
    plain: bool = False
    document: Mapping[str, Any] = {}


@plain_dataclass(frozen=True)
class Quantity:
    """What a value is: kind of unit (none for a plain number), believed range in SI, an example."""

    kind: str | None
    low: float = -math.inf
    high: float = math.inf
    example: str = ""

    def __get_pydantic_core_schema__(self, *_: object) -> CoreSchema:
        """Let pydantic ask `checked`."""
        return core_schema.with_info_plain_validator_function(self.checked)

    def checked(self, given: Any, info: ValidationInfo[Any]) -> float:
        """Return the value in SI if it is believed; what is made in Python is in SI."""
        if info.context is None:
            return float(given) if isinstance(given, int) else given
        value = (
            self._number(given) if self.kind is None or info.context.plain else self._with_unit(given, info)
        )
        if self.low > 0 >= value:
            example = f'"{self.example}"' if self.kind else self.example
            such = f", e.g. {example}" if self.example else ""
            raise ParameterError(f"is {_written(given)}: it must be greater than 0{such}")
        if not self.low <= value <= self.high:
            believed = f"{self.low:g} to {self.high:g} {self.unit}".rstrip()
            percent = (
                self.kind is None and value >= _LEAST_PERCENT and value / 100 <= self.high <= _LARGEST_RATIO
            )
            such = f". If it is in percent, write {value / 100:.6g}" if percent else ""
            raise ParameterError(f"is {_written(given)}: it must be within {believed}{such}")
        return value

    @property
    def unit(self) -> str:
        """SI unit, empty for a plain number."""
        return KINDS[self.kind][0] if self.kind else ""

    def parsed(self, text: str) -> float:
        """Return the SI value of a string with its unit."""
        assert self.kind is not None
        return parse(self.kind, text)

    def _with_unit(self, given: object, _: ValidationInfo[Any]) -> float:
        if not isinstance(given, str):
            assert self.kind is not None
            unit = self.example.partition(" ")[2] or KINDS[self.kind][1]
            numeric = isinstance(given, int | float) and not isinstance(given, bool) and math.isfinite(given)
            number = f"{given:.15g}" if numeric else "1"
            one = given[0] if isinstance(given, list) and len(given) == 1 else None
            such = f': "{one}"' if isinstance(one, str) else f', e.g. "{number} {unit}"'
            raise UnitError(f"is {_written(given)}, without a unit. Write it in quotes with its unit{such}")
        return self.parsed(given)

    def _number(self, given: object) -> float:
        if isinstance(given, bool) or not isinstance(given, int | float) or not abs(given) < _LARGEST:
            number = _number_in(given) if isinstance(given, str) else None
            such = f". Write a number, e.g. {self.example}" if self.example else ""
            remedy = such if number is None else f". Write {number:.15g}, without quotes"
            raise ParameterError(f"is {shown(given)}, not a number{remedy}")
        return float(given)


def _number_in(text: str) -> float | None:
    """The number that a text was meant for, as ``"0.6"``, ``"0,6"`` or ``"60 %"``."""
    match = re.fullmatch(r"\s*([-+]?[0-9]+)[.,]?([0-9]*)\s*(%?)\s*", text) if len(text) < 60 else None
    if match is None:
        return None
    return float(f"{match[1]}.{match[2] or 0}") / (100 if match[3] else 1)


def _share(given: object, info: ValidationInfo[Any]) -> object:
    if info.context is None:
        return given
    match = _SHARE.fullmatch(given.strip()) if isinstance(given, str) and len(given) < 60 else None
    if match is None or not 0 < float(match[1]) < 1000:
        raise ParameterError(f"is {shown(given)}, not a percentage. Write {_percentage(given)}")
    return float(match[1]) / 100


def _percentage(given: object) -> str:
    """The percentage that a value was meant for, or an example."""
    number = _number_in(given.strip().lstrip("±")) if isinstance(given, str) else given
    if isinstance(number, bool) or not isinstance(number, int | float) or not 0 < number < 100:
        return 'e.g. "20 %"'
    return f'"{number if number >= 1 else 100 * number:.4g} %", in quotes'


def _not_blank(text: str, info: ValidationInfo[Any]) -> str:
    if info.context is not None and not text.strip():
        raise ParameterError("is empty. Fill it in, or delete its line")
    return text


#: A share such as ``"20 %"``, and a text that is not blank.
Share = Annotated[float, BeforeValidator(_share)]
Text = Annotated[str, AfterValidator(_not_blank)]


@dataclass(frozen=True)
class Table:
    """A table of a file, whose keys are all known; ``called`` holds other names that people give them."""

    called: ClassVar[Mapping[str, str]] = {}

    @classmethod
    def instead(cls, _table: Mapping[str, Any], _key: str, /) -> str:
        """Return what to write in place of an unknown key, if the values of the table tell; else nothing."""
        return ""

    @model_validator(mode="before")
    @classmethod
    def _known(cls, table: Any) -> Any:
        known = cls.__pydantic_fields__  # type: ignore[attr-defined]
        unknown = [key for key in table if key not in known] if isinstance(table, dict) else []
        if unknown:
            about = {
                "key": unknown[0],
                "known": list(known),
                "given": table[unknown[0]],
                "called": cls.called,
                "instead": cls.instead(table, unknown[0]),
            }
            raise PydanticCustomError("unknown", "{key}", about)
        return table


def read_toml(path: str | Path, kind: Any = None) -> dict[str, Any]:
    """Return the document; ``kind`` holds its tables, if they are known.

    Raises
    ------
    MissingFileError
        If there is no such file, or it cannot be read.
    ParameterError
        If it is not TOML.
    """
    return _read(Path(path), kind)[0]


def _read(path: Path, kind: Any) -> tuple[dict[str, Any], str]:
    """The document of a file, and its text."""
    text = ""
    try:
        text = read_text(path, most=_MOST_BYTES)
        if "\0" in text:
            raise ParameterError(f"{path.name} {NO_TEXT}")
        with naming(path.name):
            _refuse_long_keys(text)
        document = tomllib.loads(text)
    except HerseyError:
        raise
    except (ValueError, RecursionError) as error:  # a number of thousands of digits is no TOMLDecodeError
        raise ParameterError(f"{path.name} is not valid TOML: {_no_toml(path, text, error, kind)}") from None
    with naming(path.name):
        _refuse_large(document)
    return document, text


def _no_toml(path: Path, text: str, error: Exception, kind: Any) -> str:
    """Where and why a text is no TOML, with the corrected line if one is known."""
    first = text.lstrip().partition("\n")[0]
    if path.suffix != ".toml" and first[:1] != "{" and any(mark in first for mark in ",;\t"):
        return (
            f"{error}. It looks like a log, but a machine file or a mapping (TOML) is needed here. Did you "
            "swap the two files?"
        )
    lists = {
        name
        for name, field in getattr(kind, "__pydantic_fields__", {}).items()
        if any(listed for _, listed in _tables_in(field.annotation))
    }
    return (explain(text, error, lists) if isinstance(error, ValueError) else "") or str(error)


def _refuse_long_keys(text: str) -> None:
    """Refuse keys such as ``a.a.a.a`` of hundreds of parts, which take the parser longer than linear."""
    dots = end = 0
    while part := _PART.match(text, end):  # the parser stops where this does
        end = part.end()
        if part[0] == ".":
            dots += 1
        elif part[0][0] in ",=\n\r{}[]#":
            dots = 0
        if dots > _MOST_DOTS:
            raise ParameterError(f"is not valid TOML: a key has more than {_MOST_DOTS} dots")


def _refuse_large(document: dict[str, Any]) -> None:
    """Refuse values that no file of ours holds, so that what follows may look at each as it likes."""
    level: list[Any] = [document]
    for _ in range(_DEEPEST):
        within: list[Any] = []
        for value in level:
            if isinstance(value, dict):
                within += [*value, *value.values()]
            elif isinstance(value, list):
                within += value
            elif isinstance(value, int) and not -_WHOLE <= value < _WHOLE:
                raise ParameterError("is not valid TOML: an integer has more than 64 bits")
            elif isinstance(value, str) and len(value) > _LONGEST_TEXT:
                raise ParameterError(
                    f"has a text of {len(value)} characters; at most {_LONGEST_TEXT} are allowed"
                )
        level = within
    if level:
        raise ParameterError(f"has more than {_DEEPEST} levels of nested tables or lists")


def _written(given: object) -> str:
    """A value as the file has it, cut where it is long."""
    return shown(given).strip("'") if isinstance(given, str) else shown(given)


def read_tables(path: str | Path, kind: type[Tables], *, plain: bool = False) -> Tables:
    """Return a file as the tables of ``kind``; ``plain``: its values are numbers in consistent units.

    Raises
    ------
    MissingFileError, ParameterError, UnitError
        Each names the file and the key, and says the way out.
    """
    path = Path(path)
    document, text = _read(path, kind)
    _refuse_escapes(path.name, document, text)
    try:
        return TypeAdapter(kind).validate_python(document, context=Reading(path, plain, document))
    except ValidationError as error:
        raise _mistake(path.name, error, kind, text) from None


def _refuse_escapes(file: str, document: Mapping[str, Any], text: str) -> None:
    r"""Refuse a path such as ``"C:\bench\new.csv"``, in which ``\b`` and ``\n`` are control characters."""
    if "\\" not in text:
        return
    for place, value in _texts(document):
        if set(value) & set("\b\t\n\f\r"):
            line = line_of(text, place)
            written = re.search(r'"(.*?)"\s*(?:#|,|]|$)', text.split("\n")[line - 1]) if line else None
            if written and re.search(r"\\[btnfr]", written[1]) and "'" not in written[1]:
                raise ParameterError(
                    f"{file}, line {line}: in double quotes a backslash is special, so a path needs single "
                    f"ones. Write: {place[-1]} = '{written[1]}'"
                )


def _texts(value: Any, place: tuple[str | int, ...] = ()) -> Iterator[tuple[tuple[str | int, ...], str]]:
    """Every text of a document, with its place."""
    if isinstance(value, str):
        yield place, value
    elif isinstance(value, dict | list):
        for key, each in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _texts(each, (*place, key))


def refuse_value(kind: type, key: str, given: object) -> None:
    """Raise what `read_tables` says of one value of a table of ``kind``; the message begins with the key.

    Raises
    ------
    ParameterError, UnitError
        If the value cannot stand there.
    """
    try:
        TypeAdapter(kind).validate_python({key: given}, context=Reading(Path()))
    except ValidationError as error:
        wrong = [
            each for each in error.errors() if each["type"] != "missing" and each["loc"][:1] in ((), (key,))
        ]
        for mistake in wrong[:1]:
            if mistake["type"] == "value_error":
                raise _named(key, mistake.get("ctx", {})["error"]) from None
            refusal = _words(mistake["type"], (key,), mistake["input"], mistake.get("ctx", {}))
            raise ParameterError(refusal) from None


def quoted(text: str) -> str:
    """A text as TOML writes it: what is no visible character stands as its code."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c.isprintable() else _code(c) for c in escaped) + '"'


def _code(char: str) -> str:
    return "?" if "\ud800" <= char <= "\udfff" else f"\\U{ord(char):08X}"  # half a pair is no character


@contextmanager
def naming(file: str, key: str = "") -> Iterator[None]:
    """Put file and key before the message of what is raised inside; the key is what is to be set."""
    try:
        yield
    except (ParameterError, UnitError) as error:
        raise _named(f"{file}: {key}" if key else file, error, key) from None


@contextmanager
def at_line(path: Path, name: str, *place: str) -> Iterator[None]:
    """Put the file, the line of a place in it, and the name of it before what is raised inside."""
    try:
        yield
    except (ParameterError, UnitError) as error:
        line = line_of(read_text(path, most=_MOST_BYTES), place)
        where = f"{path.name}, line {line}" if line else path.name
        raise _named(f"{where}: {name}", error) from None


def _mistake(file: str, error: ValidationError, kind: Any, text: str) -> ParameterError | UnitError:
    """The first mistake in our own words; what is missing comes after what is wrong."""
    first = min(error.errors(), key=lambda mistake: mistake["type"] == "missing")
    about, loc = first.get("ctx", {}), first["loc"]
    place = _place(loc, first["input"]) if loc else ""
    line = line_of(text, (*loc, about["key"]) if first["type"] == "unknown" else loc)
    where = f"{file}, line {line}" if line else file
    if first["type"] == "value_error":
        return _named(f"{where}: {place}", about["error"], place)
    said = _words(first["type"], loc, first["input"], about, kind)
    refusal = ParameterError(f"{where}: {said}")
    refusal.setting = Setting(place)
    return refusal


def _words(
    kind: str, loc: tuple[str | int, ...], given: object, about: Mapping[str, Any], file: Any = None
) -> str:
    """What is wrong, and the way out, of a mistake that pydantic knows; ``file`` holds the tables."""
    match kind:
        case "missing" if len(loc) == 1:
            return f"table [{loc[0]}] is missing"
        case "missing":
            return f"{_place(loc[:-1], {})} needs the key '{loc[-1]}'{_add(file, loc)}"
        case "unknown":
            return _unknown(loc, about, file)
        case "dataclass_type" | "dict_type":
            table = ".".join(name for name in loc if isinstance(name, str))
            return f"{_place(loc, given)} is not a table. Write [{table}]"
    way_out = _WAY_OUT.get(kind, "Write a value of the right type")
    return f"{_place(loc, given)} is {shown(given)}. {way_out.format(**about)}"


def _unknown(loc: tuple[str | int, ...], about: Mapping[str, Any], file: Any) -> str:
    """What to say of a key or a table that is not known: where it belongs, or what was probably meant."""
    key, known, is_table = about["key"], about["known"], isinstance(about["given"], dict)
    homes = [] if is_table else list(_homes(file, key))
    if loc:
        all_known = f" Known keys: {', '.join(known)}"
        begins = f"{_place(loc, {})} has an unknown key '{key}'."
        if about["instead"]:
            return f"{begins} {about['instead']}"
        if key in about["called"]:
            return f"{begins} Did you mean '{about['called'][key]}'?{all_known}"
        radius = next((name for name in known if "radius" in name), "") if "diameter" in key else ""
        if radius:
            return f"{begins} Write the radius, {radius} = {_half(about['given'])}"
        if homes:
            return f"{begins} It belongs in {' or '.join(homes)}. Move the line there"
        return f"{begins}{_near(key, known)}{all_known}"
    if homes:
        return f"'{key}' is in no table. It belongs in {' or '.join(homes)}. Write that line above it"
    tables = ", ".join(f"[{name}]" for name in known)
    if not is_table:
        near = _near(key, known) or " Delete the line."
        return f"unknown key '{key}', in no table.{near} Known names: {', '.join(known)}"
    return f"unknown table '{key}'.{_near(key, known, '[{}]')} Known tables: {tables}"


def _half(given: object) -> str:
    """Half of a value with its unit."""
    match = re.fullmatch(r"\s*([0-9]+(?:[.,][0-9]+)?)\s*(\D.*)?", str(given)[:60])
    half = f"{float(match[1].replace(',', '.')) / 2:.10g}" if match else ""
    return f'"{half} {match[2].strip()}"' if match and match[2] else "half of it"


def _homes(file: Any, key: str, within: str = "") -> Iterator[str]:
    """The tables of a file that know a key, as it names them."""
    for name, field in getattr(file, "__pydantic_fields__", {}).items():
        path = f"{within}{name}"
        for table, listed in _tables_in(field.annotation):
            if key in table.__pydantic_fields__:
                yield f"[[{path}]]" if listed else f"[{path}]"
            yield from _homes(table, key, f"{path}.")


def _tables_in(annotation: Any, listed: bool = False) -> Iterator[tuple[Any, bool]]:
    """The tables of an annotation, and whether there may be many."""
    if isinstance(annotation, type) and issubclass(annotation, Table):
        yield annotation, listed
    for part in get_args(annotation):
        yield from _tables_in(part, listed or get_origin(annotation) is tuple)


def _add(file: Any, loc: tuple[str | int, ...]) -> str:
    """The line to add for a key that is missing, if its table gives an example of it."""
    table = file
    for name in (each for each in loc[:-1] if isinstance(each, str)):
        field = getattr(table, "__pydantic_fields__", {}).get(name)
        table = next((each for each, _ in _tables_in(field.annotation)), None) if field else None
    field = getattr(table, "__pydantic_fields__", {}).get(loc[-1])
    example = (
        next((each.example for each in field.metadata if isinstance(each, Quantity)), "") if field else ""
    )
    return f'. Add e.g. {loc[-1]} = "{example}"' if example else ""


def _near(key: str, known: Sequence[str], written: str = "'{}'") -> str:
    """Which of the known names was probably meant, or nothing."""
    near = meant(key, known)
    return f" Did you mean {written.format(near)}?" if near else ""


def _place(loc: tuple[str | int, ...], given: object) -> str:
    """``[table]``, ``points 1`` or ``table.key``; the number of a value in a list is left out."""
    if len(loc) == 1 and isinstance(given, dict):
        return f"[{loc[0]}]"
    rows = f" {loc[1] + 1}" if len(loc) > 1 and isinstance(loc[1], int) else ""
    return ".".join([f"{loc[0]}{rows}", *(name for name in loc[1:] if isinstance(name, str))])


def _named(place: str, error: Exception, key: str = "") -> ParameterError | UnitError:
    """The error with the place before its message; the key of the value that is at fault is what to set."""
    text = str(error)
    goes_on = _GOES_ON.match(text)
    said = f"{place}{'' if text.startswith('.') else ' ' if goes_on else ': '}{text}"
    named = UnitError(said) if isinstance(error, UnitError) else ParameterError(said)
    named.setting = Setting(key) if key else None
    return named
