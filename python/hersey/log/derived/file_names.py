"""Values in the names of files, by a pattern such as ``{speed} rpm {load} N.txt``.

Each placeholder takes a number; its unit stands behind it, or in it (``{load:N}``). ``*`` is any text.
Blanks, and upper and lower case, make no difference.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from hersey.errors import ParameterError, Setting, UnitError
from hersey.log.roles import role_conversion

#: Roles that a name may state, and an example of a unit of each.
ROLES = {"speed": "rpm", "load": "N", "radius": "mm", "temperature": "degC"}
#: Marks that a name may have in the place of a decimal point.
DECIMALS = (".", ",", "-", "_", "p", "d")
_PATTERN, _DECIMAL = Setting("name_pattern"), Setting("name_decimal")
_PLACEHOLDER = re.compile(r"\{([^{}:]*)(?::([^{}]*))?\}|(\*)")
_UNIT = re.compile(r"\s*([A-Za-zµμ°%]+)")
#: Characters of a pattern, and of a name, at the most.
_LONGEST = 300


@dataclass(frozen=True)
class NamePattern:
    """A pattern of file names, and the decimal mark of their numbers."""

    template: str
    decimal: str = "."

    def __post_init__(self) -> None:
        """Refuse a pattern that cannot be used.

        Raises
        ------
        ParameterError
            If it has no placeholder, an unknown one, one twice, or one without a unit.
        """
        if self.decimal not in DECIMALS:
            raise ParameterError(f"{_DECIMAL.to(self.decimal)}: write one of {' '.join(DECIMALS)}")
        if len(self.template) > _LONGEST:
            raise ParameterError(f"{_PATTERN.to()} is longer than {_LONGEST} characters")
        if not self.units:
            raise ParameterError(
                f"{_PATTERN.to(self.template)} has no placeholder. Write one, e.g. "
                f"{_PATTERN.to('{speed} rpm.csv')}; known: {_known()}"
            )

    @property
    def units(self) -> dict[str, str]:
        """The unit of each role that the pattern states."""
        return {role: unit for role, unit, _ in self._parts() if role}

    def values(self, name: str) -> dict[str, str]:
        """Return number and unit of each role in the name of a file.

        Raises
        ------
        ParameterError
            If the name does not match, with what it may be written as.
        """
        match = re.fullmatch(self._regex(), name[:_LONGEST].strip(), re.IGNORECASE)
        if match is None:
            way = "" if self.decimal != "." else f", or state its decimal mark, e.g. {_DECIMAL.to('-')}"
            raise ParameterError(
                f"{name}: the name does not match {_PATTERN.to(self.template)}. Rename the file, change the "
                f"pattern (* stands for any text){way}"
            )
        return {role: f"{self._number(match[role])} {unit}" for role, unit in self.units.items()}

    def _number(self, text: str) -> str:
        return text if self.decimal == "." else text.replace(self.decimal, ".")

    def _regex(self) -> str:
        """The pattern between texts of any kind; one that is found is not searched again for a later one."""
        pieces, words = [""], False
        for role, _, literal in self._parts():
            if literal == "*":
                pieces.append("")
            elif role:
                pieces[-1] += f"(?P<{role}>{self._digits(is_told_apart=words)})"
            else:
                pieces[-1] += r"\s*".join(["", *map(re.escape, literal.split()), ""]) or r"\s*"
            words = literal != "*" and bool(literal.strip())
        first, *between = pieces
        last = [f".*?{between.pop()}"] if between else []
        return "".join([first, *(f"(?>.*?{piece})" for piece in between), *last])

    def _digits(self, *, is_told_apart: bool) -> str:
        """A number; where no word before it tells where it begins, never the end of a longer one.

        There a hyphen behind a letter or a digit is no sign.
        """
        mark = re.escape(self.decimal)
        sign = "" if self.decimal == "-" else "[-+]" if is_told_apart else "(?<![0-9A-Za-z])[-+]"
        begins = "" if is_told_apart else rf"(?<![0-9.])(?<![0-9][,{mark}])"
        return rf"{begins}{f'(?:{sign})?' * bool(sign)}[0-9]{{1,15}}(?:{mark}[0-9]{{1,15}})?"

    def _parts(self) -> list[tuple[str, str, str]]:
        """Role and unit of each placeholder, or the text between two of them (``*`` for any)."""
        parts, last = list[tuple[str, str, str]](), 0
        for match in _PLACEHOLDER.finditer(self.template):
            if match.start() > last:
                parts.append(("", "", self.template[last : match.start()]))
            last = match.end()
            if match[3]:
                parts.append(("", "", "*"))
                continue
            role = match[1].strip()
            if role not in ROLES or role in (each for each, _, _ in parts):
                twice = "twice" if role in ROLES else "which is unknown"
                raise ParameterError(
                    f"{_PATTERN.to(self.template)} has {{{role}}} {twice}. Known: {_known()}"
                )
            parts.append((role, self._unit(role, match[2], self.template[last:]), ""))
        return [*parts, ("", "", self.template[last:])] if last < len(self.template) else parts

    def _unit(self, role: str, stated: str | None, behind: str) -> str:
        """The unit in a placeholder, or the longest one that the text behind it begins with."""
        word = _UNIT.match(behind)
        candidates = (
            [stated.strip()] if stated else [word[1][:n] for n in range(len(word[1]), 0, -1)] if word else []
        )
        for unit in candidates:
            try:
                role_conversion(role, unit)
            except UnitError:
                continue
            return unit
        raise ParameterError(
            f"{_PATTERN.to(self.template)} has {{{role}}} without a unit behind it. Write the unit, e.g. "
            f"{{{role}:{ROLES[role]}}}"
        )


def proposed_pattern(
    name: str,
    names: Sequence[str] = (),
    *,
    needed: Collection[str] = ("speed",),
    known: Collection[str] = (),
) -> tuple[str, str] | None:
    """Return a pattern and a decimal mark for a file name with numbers and units, or None.

    It states at least one of the ``needed`` roles, and none that are ``known``. All ``names`` match it, if
    there are several files. What may be something else (a size in mm, a C) counts only where they differ.
    """
    found = [match for match in _STATED.finditer(name[:_LONGEST]) if _role_of(match)]
    marks = {mark for match in found for mark in match[1] if mark in DECIMALS}
    roles = [_role_of(match) for match in found]
    if len(marks) > 1 or len(set(roles)) != len(roles):
        return None
    decimal, others = next(iter(marks), "."), tuple(names) or (name,)
    differ = _differing(_template(name, found, known), decimal, others) or ()
    kept = [match for match in found if _role_of(match) in differ or match[2].lower() in _CERTAIN]
    template = _template(name, kept, known)
    stated = {_role_of(match) for match in kept} & set(needed) - set(known)
    if not stated or _differing(template, decimal, others) is None:
        return None
    return template, decimal


def differing(pattern: tuple[str, str], names: Sequence[str]) -> dict[str, list[str]]:
    """Return number and unit in each name, by role, of what a pattern states and the names differ in."""
    values = [NamePattern(*pattern).values(name) for name in names]
    by_role = {role: [each[role] for each in values] for role in values[0]}
    return {role: found for role, found in by_role.items() if len(set(found)) > 1}


def _differing(template: str, decimal: str, names: Sequence[str]) -> Collection[str] | None:
    """The roles in which names differ, or None if one does not match."""
    try:
        return differing((template, decimal), names)
    except ParameterError:
        return None


def _template(name: str, found: Sequence[re.Match[str]], known: Collection[str]) -> str:
    """The name with a placeholder for each number; one of a known role may be any."""
    parts, last = [], 0
    for match in found:
        written = _WRITTEN.get(match[2].lower(), "")
        role = _role_of(match)
        parts += [name[last : match.start()], "*" if role in known else f"{{{role}{written}}}"]
        last = match.end(1)
    return "".join([*parts, name[last:]])


def _role_of(match: re.Match[str]) -> str:
    """The role that a unit shows; none for a small c."""
    return "" if match[2] == "c" else _ROLES_OF_UNITS[match[2].lower()]


#: Units in file names, and the role that each shows; those that are nothing else; units to be written out.
_ROLES_OF_UNITS = {
    **dict.fromkeys(("rpm", "rps", "mm_s", "mm s", "m_s", "m s"), "speed"),
    "n": "load",
    "mm": "radius",
    "degc": "temperature",
    "c": "temperature",
}
_CERTAIN = _ROLES_OF_UNITS.keys() - {"mm", "c"}
_WRITTEN = {"mm_s": ":mm/s", "mm s": ":mm/s", "m_s": ":m/s", "m s": ":m/s", "c": ":degC"}
_STATED = re.compile(
    r"(?<![0-9.])([0-9]+(?:[.,-][0-9]+)?)[ _]?(rpm|rps|mm[_ ]s|m[_ ]s|mm|N|degC|C)(?![A-Za-z])", re.IGNORECASE
)


def _known() -> str:
    return ", ".join(f"{{{role}}}" for role in ROLES)
