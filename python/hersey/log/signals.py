"""Columns that hold a signal, in A, V, % or ‰, and units that say how much one of it stands for."""

from __future__ import annotations

import re
from collections.abc import Sequence

from hersey.errors import Setting
from hersey.log.words import CURRENT, CURRENT_WITHIN

_SIGNAL = (
    r"([mµμu]?)(A|V|[Aa]mp(?:ere)?s?|[Vv]olts?)"
    r"|()(%|‰|0?[.,]1\s?%|[Pp]er\s?cent|[Pp]er\s?mill?e?|[Pp]romille)"
)
_ALONE = re.compile(_SIGNAL)
_PER = re.compile(rf"(.*\S)\s*/\s*(?:{_SIGNAL})")
#: Names of inputs of oscilloscopes and of data loggers.
_INPUT = re.compile(
    r"(.*/)?(ch|channel|kanal|ai|analog(ue)?( ?in(put)?)?|voltage|volts?|input)[ _-]?\d*", re.IGNORECASE
)
#: An amount that a number divides, as that at 100 %.
_DIVIDED = re.compile(r"/\s*[0-9.]+\s*$")
_PREFIXES = {"": 1.0, "m": 1e-3, "µ": 1e-6, "μ": 1e-6, "u": 1e-6}
#: What one of a signal, or 100 % or 1000 ‰, may stand for, as an example.
_EXAMPLES = {
    "torque": {"A": "35 mN*m/A", "V": "2 N*m/V", "%": "9.84 mN*m / 100", "‰": "0.48 N*m / 1000"},
    "speed": {"A": "100 rpm/A", "V": "100 rpm/V", "%": "3000 rpm / 100", "‰": "3000 rpm / 1000"},
    "temperature": {"A": "10 degC/A", "V": "20 degC/V", "%": "200 degC / 100", "‰": "200 degC / 1000"},
    "load": {"A": "50 N/A", "V": "50 N/V", "%": "100 N / 100", "‰": "100 N / 1000"},
    "radius": {"A": "10 mm/A", "V": "10 mm/V", "%": "25 mm / 100", "‰": "25 mm / 1000"},
}
#: What the numbers of a signal without dimension come to at the full value, and how many they are there.
_FULL = {"%": ("100 %", 100), "‰": ("1000 ‰", 1000)}
#: Names of a torque in per mille of the rated torque: object 6077h of CiA 402, which has no unit in exports.
_PER_MILLE = re.compile(r"torque[ _]actual[ _]value|(0x)?6077h?([^0-9].*)?", re.IGNORECASE)

#: Names of a current of a motor, and what one ampere of it may stand for.
_CURRENT = re.compile(
    rf"(?!.*current[ _](step|cycle|time|segment|run|speed|position|state|mode))"
    rf"((.*[^a-z])?(current|amps?|strom|i_?q|{CURRENT})([^a-z].*)?|.*({CURRENT_WITHIN}).*)",
    re.IGNORECASE,
)
CURRENT_EXAMPLE = _EXAMPLES["torque"]["A"]


def may_be_current(name: str, unit: str) -> bool:
    """Return whether a column is in amperes, or is called a current and has no unit."""
    return signal_kind(unit) == "A" or (not unit and _CURRENT.fullmatch(name) is not None)


def apart(unit: str) -> tuple[str, str]:
    """Return a unit such as ``0.2 N*m/A`` as the unit of one ampere, and A; any other as it is, and nothing.

    Examples
    --------
    >>> apart("0.2 N*m/A"), apart("N*m")
    (('0.2 N*m', 'A'), ('N*m', ''))
    """
    match = _PER.fullmatch(unit.strip())
    return (match[1], unit.strip()[match.end(1) :].lstrip(" /")) if match else (unit, "")


def is_signal(unit: str) -> bool:
    """Return whether a unit is that of a signal."""
    return _ALONE.fullmatch(unit.strip()) is not None


def per(given: str, header: str) -> float:
    """Return how many of the signal that a unit names one in the column is; 1 if either names none.

    Raises
    ------
    ValueError
        If the column holds something else.
    """
    wanted = apart(given)[1]
    if not wanted or not header:
        return 1.0
    one, other = (_ALONE.fullmatch(each.strip()) for each in (wanted, header))
    if one is None or other is None or bool(one[4]) != bool(other[4]):
        raise ValueError(header)
    kinds = [signal_kind(each.group()) for each in (one, other)]
    if one[4]:
        return _FULL[kinds[0]][1] / _FULL[kinds[1]][1]
    if kinds[0] != kinds[1]:
        raise ValueError(header)
    return _PREFIXES[other[1] or ""] / _PREFIXES[one[1] or ""]


def says_how_much(given: str) -> bool:
    """Return whether a unit holds a number, or names the signal of which it is one."""
    return bool(re.search(r"\d", given) or apart(given)[1])


def at_which(given: str, header: str) -> tuple[str, str]:
    """Return the two units that an amount without a divisor may mean for a column in % or ‰, or nothing.

    Examples
    --------
    >>> at_which("0.48 N*m", "‰"), at_which("0.48 N*m / 1000", "‰")
    (('0.48 N*m / 1000', '0.48 N*m/‰'), ('', ''))
    """
    kind = signal_kind(header)
    if kind not in _FULL or apart(given)[1] or _DIVIDED.search(given):
        return "", ""
    return f"{given.strip()} / {_FULL[kind][1]}", f"{given.strip()}/{kind}"


def way_out(role: str, header: str) -> str:
    """Return what to type for a column of a signal."""
    kind = signal_kind(header)
    typed = Setting(role, "unit").to(_EXAMPLES[role][kind])
    if kind in _FULL:
        rated = " (the rated torque of most drives)" if role == "torque" and kind == "‰" else ""
        return f"use {typed}, with your value of the {role} at {_FULL[kind][0]}{rated}"
    condition = "if it is the motor current, " if kind == "A" and role == "torque" else ""
    return f"{condition}give the {role} per {kind}, e.g. {typed}"


def question(role: str, header: str) -> tuple[str, str]:
    """Return what to ask about a column of a signal, and an answer as an example.

    Examples
    --------
    >>> question("torque", "%"), question("speed", "mV")
    (('torque at 100 %', '9.84 mN*m'), ('speed per V', '100 rpm'))
    """
    kind = signal_kind(header)
    example = _EXAMPLES[role][kind]
    asked = f"at {_FULL[kind][0]}" if kind in _FULL else f"per {kind}"
    return f"{role} {asked}", example.rpartition("/")[0].rstrip()


def answered(answer: str, header: str) -> str:
    """Return the unit that an answer to `question` states; one that is a unit of the signal already stays.

    Examples
    --------
    >>> answered("9.84 mN*m", "%"), answered("2 N*m", "V"), answered("2 N*m/V", "V")
    ('9.84 mN*m / 100', '2 N*m/V', '2 N*m/V')
    """
    kind = signal_kind(header)
    if apart(answer)[1] or _DIVIDED.search(answer):
        return answer
    return f"{answer.strip()} / {_FULL[kind][1]}" if kind in _FULL else f"{answer.strip()}/{kind}"


def way_out_unnamed(role: str, names: Sequence[str], header: str) -> str:
    """Return what to type if one of some columns of amperes or volts, which nobody named, holds a role."""
    kind, channel = signal_kind(header), Setting(role, "channel")
    held = "the motor current" if kind == "A" else f"the {role} in volts"
    named, typed = f"'{names[0]}'", channel.to(names[0])
    if len(names) > 1:
        named, typed = f"one of {', '.join(map(repr, names))}", f"{channel.to()} with its name"
    unit = Setting(role, "unit").to(_EXAMPLES[role][kind])
    return f"if {named} is {held}, use {typed} and give the {role} per {kind}, e.g. {unit}"


def of_an_input(role: str, name: str) -> str:
    """Return what more to say of a column without unit if it is called like an input of an instrument."""
    if role == "torque" and _PER_MILLE.fullmatch(name):
        typed = Setting(role, "unit").to(_EXAMPLES[role]["‰"])
        return f". If it is in ‰ of the rated torque (CiA 402), use {typed}, with your rated torque"
    if role not in _EXAMPLES or not _INPUT.fullmatch(name):
        return ""
    return f". If it is a voltage, give the {role} per V: {Setting(role, 'unit').to(_EXAMPLES[role]['V'])}"


def signal_kind(unit: str) -> str:
    """Return A, V, % or ‰, or nothing for a unit that is not that of a signal."""
    match = _ALONE.fullmatch(unit.strip())
    if match is None or match[2]:
        return match[2][0].upper() if match else ""
    return "%" if re.fullmatch(r"%|per\s?cent", match[4], re.IGNORECASE) else "‰"
