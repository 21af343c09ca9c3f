"""Problems with the choices of a log's channels: where, in words, and what fixes each."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from hersey.errors import TimeOrderError, UnitError, capital, sentence
from hersey.log.doubtful import RARE, TOO_HOT
from hersey.log.roles import ROLES, role_conversion
from hersey.log.slow_channels import is_slow
from hersey.units import KINDS, ZERO_CELSIUS, nearest_unit

#: Units to choose from, by role; any other can be written.
UNITS = {
    "time": ("s", "ms", "us", "min", "h"),
    "torque": ("N*m", "mN*m", "N*cm", "ozf*in", "lbf*in", "N"),
    "speed": ("rpm", "rad/s", "rev/s", "deg/s", "mm/s", "m/s"),
    "temperature": ("degC", "K", "degF"),
    "load": ("N", "kN", "kgf", "lbf"),
    "radius": ("mm", "m", "in"),
}
#: No belt is colder than this, K; up to this share of the rows may be skipped without asking.
_TOO_COLD, _FEW = 220.0, 0.02
#: What is wrong, by the kind of the error of a reader.
_PROBLEMS = {TimeOrderError.__name__: "time is out of order"}
_NUMBERS = {2: "Two", 3: "Three", 4: "Four"}
_SETPOINT = re.compile(r"\b(set|cmd|command|target|demand|reference|soll|nominal)", re.IGNORECASE)


@dataclass(frozen=True)
class Fault:
    """A problem that must be fixed before a run.

    Attributes
    ----------
    at
        The control with the problem: ``role:NAME`` and ``unit:NAME`` of a channel, ``lacking:ROLE``,
        ``file:NUMBER``, ``field:KEY``, ``toml``.
    title, text
        What is wrong, and what is known about it.
    link
        What the line beside Run calls it.
    button, mend
        What the one button says and changes: ``roles`` and ``units`` by channel, ``options``, ``remove``.
    keep
        What a second one says, which keeps what is only doubtful; empty where it cannot be kept.
    """

    at: str
    title: str
    text: str = ""
    link: str = ""
    button: str = ""
    mend: Mapping[str, Any] = field(default_factory=dict)
    keep: str = ""

    @property
    def key(self) -> str:
        """Return what distinguishes it from others."""
        return f"{self.at} {self.title}"


def channel_faults(
    look: Mapping[str, Any], choices: Mapping[str, Mapping[str, str]], options: Mapping[str, Any]
) -> list[Fault]:
    """Return the problems with the channels of a log, in the order of the roles.

    Parameters
    ----------
    look
        What `hersey.app.looking.look` found.
    choices
        ``role`` and ``unit`` of each channel by name.
    options
        ``isothermal``, ``drop_missing``, and texts, empty where nothing is said: ``every``, ``radius``,
        ``motor_constant``.
    """
    channels = {channel["name"]: channel for channel in look["channels"]}
    faults: list[Fault] = []
    for role in ROLES:
        names = [name for name, choice in choices.items() if choice["role"] == role and name in channels]
        if not names:
            faults += _lacking(role, look, choices, options)
        elif len(names) > 1:
            faults.append(_claimed(role, names, channels))
        elif not (role == "temperature" and options["isothermal"]):
            faults += _of_one(role, channels[names[0]], choices, look, options)
    if not faults and look["problem"] and _as_proposed(look, choices) and not options["drop_missing"]:
        faults.append(of_problem(look["problem"], look, choices))
    return faults


def _as_proposed(look: Mapping[str, Any], choices: Mapping[str, Mapping[str, str]]) -> bool:
    return all(
        choices.get(name, {}).get("role") == role for role, name in look["found"].items() if role in ROLES
    )


def of_problem(
    problem: Mapping[str, Any], look: Mapping[str, Any], choices: Mapping[str, Mapping[str, str]]
) -> Fault:
    """Return what a reader refused (`HerseyError.to_dict`) as a fault of the channel that it is about."""
    said = problem["reason"].removeprefix(f"{look['name']}: ").removeprefix(f"{look['name']}, ")
    role = problem["setting"] if problem["setting"] in ROLES else ""
    name = next((name for name, choice in choices.items() if role and choice["role"] == role), "")
    kind = "unit" if problem["of"] == "unit" else "role"
    at = f"{kind}:{name}" if name else "file:"
    what = _PROBLEMS.get(problem["error"], "this cannot be read")
    return Fault(at, sentence(what), capital(said), f"{role or 'the log'}: {what}")


def _claimed(role: str, names: list[str], channels: Mapping[str, Any]) -> Fault:
    def worth(name: str) -> tuple[bool, bool, bool]:
        channel = channels[name]
        return (bool(_SETPOINT.search(name)), channel["dead"], not _fits(role, channel["unit"]))

    best = min(names, key=worth)
    others = [name for name in names if name != best]
    set_value = next((name for name in others if _SETPOINT.search(name)), "")
    text = "The other is " if len(others) == 1 else "The others are "
    text += " and ".join(f"“{name}”" for name in others[:3]) + "."
    if set_value:
        text = f"“{set_value}” looks like a setpoint."
    title = f"{_NUMBERS.get(len(names), str(len(names)))} channels could be the {role}."
    mend = {"roles": dict.fromkeys(others, "")}
    return Fault(f"role:{best}", title, text, f"choose the {role} channel", "Keep this one", mend)


def _lacking(
    role: str, look: Mapping[str, Any], choices: Mapping[str, Mapping[str, str]], options: Mapping[str, Any]
) -> list[Fault]:
    if role == "time" and (look["means"] or look["own_clock"] or options["every"].strip()):
        return []
    if role == "temperature" and options["isothermal"]:
        return []
    link = f"choose the {role} channel"
    title = f"No {role} channel."
    at = f"lacking:{role}"
    free = [
        channel["name"]
        for channel in look["channels"]
        if not choices.get(channel["name"], {}).get("role") and not channel["dead"]
    ]
    units = {channel["name"]: channel["unit"] for channel in look["channels"]}
    if fitting := next((name for name in free if units[name] and _fits(role, units[name])), ""):
        text, button = f"“{fitting}” has a unit of {role}.", f"Use “{fitting}”"
        return [Fault(at, title, text, link, button, {"roles": {fitting: role}})]
    if role == "temperature":
        text = "Choose one below, or run without: the result then holds only at the temperature of the log."
        return [Fault(at, title, text, link, "Run without temperature", {"options": {"isothermal": True}})]
    text = "Choose one in the column Role."
    if role == "time":
        text = "Choose one in the column Role, or type the time between rows below the table."
    return [Fault(at, title, text, link)]


def _of_one(
    role: str,
    channel: Mapping[str, Any],
    choices: Mapping[str, Mapping[str, str]],
    look: Mapping[str, Any],
    options: Mapping[str, Any],
) -> list[Fault]:
    name, unit = channel["name"], choices[channel["name"]]["unit"].strip()
    if channel["dead"] and role in ("torque", "speed"):
        return [_dead(role, channel, unit, choices, look)]
    faults = _unit_faults(role, channel, unit, options)
    slow = role == "temperature" and is_slow(channel["rows"], channel["rows"] - channel["missing"])
    many = channel["missing"] > max(1, _FEW * channel["rows"]) and not slow
    if not faults and many and not options["drop_missing"]:
        title = f"{channel['missing']} rows have no value."
        text = f"That is {100 * channel['missing'] / channel['rows']:.2g} % of all."
        mend = {"options": {"drop_missing": True}}
        link, button = f"rows without {role}", "Skip these rows"
        faults.append(Fault(f"role:{name}", title, text, link, button, mend))
    if not faults and role == "time":
        faults += _rare(channel, unit, look)
    return faults


def _dead(
    role: str,
    channel: Mapping[str, Any],
    unit: str,
    choices: Mapping[str, Mapping[str, str]],
    look: Mapping[str, Any],
) -> Fault:
    """The fault of a channel that holds one value throughout, or none."""
    name = channel["name"]
    free = [
        c for c in look["channels"] if c["name"] != name and not c["dead"] and not choices[c["name"]]["role"]
    ]
    other = next((c["name"] for c in free if c["unit"] and _fits(role, c["unit"])), "")
    value = "" if channel["low"] is None else f" {channel['low']:.6g} {unit}".rstrip()
    title = f"It is{value} throughout." if value else "It has no values."
    text, link = "The channel is dead. Choose another.", f"choose another {role} channel"
    return Fault(f"role:{name}", title, text, link, *_use(other, {name: "", other: role}))


def _use(name: str, roles: Mapping[str, str]) -> tuple[str, Mapping[str, Any]]:
    """The button that gives a channel a role, and what it changes; neither without a channel."""
    return (f"Use “{name}”", {"roles": roles}) if name else ("", {})


def _read_as(channel: Mapping[str, Any], unit: str, title: str, text: str, keep: str = "") -> Fault:
    """A fault of the unit of a channel, fixed by reading it in another unit."""
    name = channel["name"]
    button, mend = f"Read as {sign(unit)}", {"units": {name: unit}}
    return Fault(f"unit:{name}", title, text, f"unit of {name}", button, mend, keep)


def _unit_faults(role: str, channel: Mapping[str, Any], unit: str, options: Mapping[str, Any]) -> list[Fault]:
    if not unit:
        usual = _usual(role, channel)
        text = "Choose its unit."
        if role == "temperature" and channel["most"] is not None:
            ends = _celsius(channel, usual)
            text = f"Read as {sign(usual)} it is {ends[0]:.0f} to {ends[1]:.0f} °C."
        return [_read_as(channel, usual, "It has no unit in the file.", text)]
    if role == "torque" and unit in ("A", "mA"):
        text = f"“{channel['name']}” is a current; torque is current times motor constant."
        at, said = "field:torque.motor_constant", "A motor current needs the motor constant."
        return [] if options["motor_constant"].strip() else [Fault(at, said, text, "motor constant")]
    try:
        _, line = role_conversion(role, unit)
    except UnitError as error:
        near = _nearest(role, unit, channel)
        return [_read_as(channel, near, f"{sign(unit)} is not a unit of {role}.", str(error))]
    if role != "temperature" or channel["most"] is None:
        return []
    return _doubtful_heat(channel, unit, line.scale, line.offset)


def _doubtful_heat(channel: Mapping[str, Any], unit: str, scale: float, offset: float) -> list[Fault]:
    most, median = scale * channel["most"] + offset, scale * channel["median"] + offset
    if median > _TOO_COLD and most < ZERO_CELSIUS + TOO_HOT:
        return []
    end, what = ("most", "hotter") if most >= ZERO_CELSIUS + TOO_HOT else ("median", "colder")
    title = f"{channel[end]:.4g} {sign(unit)} is {what} than any such drive."
    for other in ("K", "degC", "degF"):
        low, high = _celsius(channel, other)
        if other != unit and low > _TOO_COLD - ZERO_CELSIUS and high < TOO_HOT:
            text = f"Read as {sign(other)} it is {low:.0f} to {high:.0f} °C."
            return [_read_as(channel, other, title, text, f"Keep {sign(unit)}")]
    return []


def _celsius(channel: Mapping[str, Any], unit: str) -> tuple[float, float]:
    """The least and nearly the greatest temperature of a channel, degC, if it is read in a unit."""
    line = role_conversion("temperature", unit)[1]
    low, most = (line.scale * channel[end] + line.offset - ZERO_CELSIUS for end in ("low", "most"))
    return low, most


def _rare(channel: Mapping[str, Any], unit: str, look: Mapping[str, Any]) -> list[Fault]:
    clock = next((clock for clock in look["clocks"] if clock["name"] == channel["name"]), None)
    if clock is None or unit != channel["unit"] or unit != "s" or (clock["interval"] or 0.0) < RARE:
        return []
    title = f"Rows come every {clock['interval']:.4g} s."
    return [_read_as(channel, "ms", title, "Drive logs are sampled far more often.", "Keep s")]


def _fits(role: str, unit: str) -> bool:
    try:
        role_conversion(role, unit)
    except UnitError:
        return False
    return True


def _usual(role: str, channel: Mapping[str, Any]) -> str:
    if role == "temperature" and channel["median"] is not None and channel["median"] > _TOO_COLD:
        return "K"
    return UNITS[role][0] if role in UNITS else KINDS["force"][1]


def _nearest(role: str, unit: str, channel: Mapping[str, Any]) -> str:
    if role == "speed" and unit in ("Hz", "1/s"):
        return "rev/s"
    return nearest_unit(role, unit) or _usual(role, channel)


def sign(unit: str) -> str:
    """Return a unit as people write it.

    Examples
    --------
    >>> sign("degC"), sign("mN*m")
    ('°C', 'mN·m')
    """
    return re.sub(r"\bdeg([CF])\b", r"°\1", unit).replace("*", "·")
