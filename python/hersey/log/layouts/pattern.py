"""Patterns with placeholders, as ``"Step {run}: {speed} rpm"``: no regular expression, and no time lost.

A number stands for ``{speed}`` and its like, any text for ``*`` (up to the first place where the rest may go
on), the name of a channel for ``{channel}``. Upper and lower case, and runs of blanks, make no difference.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

from hersey.errors import ParameterError, UnitError
from hersey.log.roles import role_conversion

#: Placeholders of numbers, and the role of each; a run has no unit, ``every`` is the time between rows.
NUMBERS = {
    "speed": "speed",
    "torque": "torque",
    "temperature": "temperature",
    "load": "load",
    "radius": "radius",
    "every": "time",
    "run": "",
}
CHANNEL = "channel"
#: Characters of a line that are looked at, and of a pattern at the most.
_LONGEST_LINE, _LONGEST = 1000, 300
_PLACEHOLDER = re.compile(r"\{([^{}:]*)(?::([^{}]*))?\}|(\*)")
_NUMBER = re.compile(r"[-+]?[0-9]{1,30}(?:[.,][0-9]{1,30})?(?:[eE][-+]?[0-9]{1,3})?")


@dataclass(frozen=True)
class Value:
    """A number that a line states, and its unit (empty for a run)."""

    number: float
    unit: str


@dataclass(frozen=True)
class Found:
    """What a text holds where a pattern has placeholders; ``channel`` is empty without one."""

    values: dict[str, Value]
    channel: str = ""


@dataclass(frozen=True)
class _Part:
    """A piece of a pattern: literal text, or a placeholder."""

    kind: str  # "text", "number", "any", "channel"
    text: str = ""  # literal text, or the name of a number
    unit: str = ""


@dataclass(frozen=True)
class Pattern:
    """A pattern, split into its parts."""

    parts: tuple[_Part, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Placeholders of numbers."""
        return tuple(part.text for part in self.parts if part.kind == "number")

    def match(self, text: str) -> Found | None:
        """Return what a text holds, or None if it does not match."""
        plain = _plain(text[: _LONGEST_LINE + 1])
        if len(text) > _LONGEST_LINE:
            return None
        return _matched(self.parts, plain, 0, Found({}))


@lru_cache(maxsize=256)
def pattern(template: str) -> Pattern:
    """Return a template as a pattern.

    Raises
    ------
    ParameterError
        If a placeholder is unknown, or the unit of a number is not stated.
    """
    if len(template) > _LONGEST:
        raise ParameterError(f"has {len(template)} characters; a pattern has at most {_LONGEST}")
    plain, parts, last = _plain(template), list[_Part](), 0
    for match in _PLACEHOLDER.finditer(plain):
        if match.start() > last:
            parts.append(_Part("text", plain[last : match.start()].lower()))
        last = match.end()
        parts.append(_placeholder(match, plain[last:]))
    if last < len(plain):
        parts.append(_Part("text", plain[last:].lower()))
    if not parts:
        raise ParameterError("is empty. Fill it in, or delete its line")
    if sum(part.kind == "channel" for part in parts) > 1:
        raise ParameterError("has {channel} more than once")
    return Pattern(tuple(parts))


def _placeholder(match: re.Match[str], behind: str) -> _Part:
    if match[3]:
        return _Part("any")
    name, unit = match[1].strip(), (match[2] or "").strip()
    if name == CHANNEL:
        return _Part("channel")
    if name not in NUMBERS:
        known = ", ".join(f"{{{each}}}" for each in (*NUMBERS, CHANNEL))
        raise ParameterError(f"has an unknown placeholder {{{name}}}. Known: {known}, and * for any text")
    if NUMBERS[name] and not unit:
        words = behind.replace("*", " ").replace("{", " ").split()
        unit = words[0].strip("[]();,:") if words else ""
    if NUMBERS[name] and not _is_unit(name, unit):
        raise ParameterError(
            f"has {{{name}}} without a unit behind it. Write the unit, e.g. {_example(name)}"
        )
    return _Part("number", name, unit if NUMBERS[name] else "")


def _example(name: str) -> str:
    units = {
        "speed": "rpm",
        "torque": "N*m",
        "temperature": "degC",
        "load": "N",
        "radius": "mm",
        "every": "s",
    }
    return f"{{{name}:{units[name]}}}"


def _is_unit(name: str, unit: str) -> bool:
    try:
        return bool(unit and role_conversion(NUMBERS[name], unit))
    except UnitError:
        return False


def _plain(text: str) -> str:
    return " ".join(text.split())


def _matched(parts: tuple[_Part, ...], text: str, start: int, found: Found) -> Found | None:
    """What is found from a place on; goes on with the rest only once, but behind the name of a channel."""
    at, anywhere, values = start, False, dict(found.values)
    for number, part in enumerate(parts):
        if part.kind == "any":
            anywhere = True
        elif part.kind == "text":
            here = text.lower().find(part.text, at) if anywhere else at
            if here < 0 or not text.lower().startswith(part.text, here):
                return None
            at, anywhere = here + len(part.text), False
        elif part.kind == "number":
            at += not anywhere and text[at : at + 1] == " "
            match = (_NUMBER.search if anywhere else _NUMBER.match)(text, at)
            if match is None:
                return None
            values[part.text] = Value(float(match[0].replace(",", ".")), part.unit)
            at, anywhere = match.end(), False
        else:
            return _behind_channel(parts[number + 1 :], text, at, Found(values))
    if anywhere or not text[at:].strip():
        return Found(values, found.channel)
    return None


def _behind_channel(parts: tuple[_Part, ...], text: str, at: int, found: Found) -> Found | None:
    """The shortest name of a channel with which the rest of the text matches."""
    for end in range(at + 1, len(text) + 1):
        name = text[at:end].strip(" ,;:_-@/")
        if name and (rest := _matched(parts, text, end, Found(found.values, name))):
            return rest
    return None
