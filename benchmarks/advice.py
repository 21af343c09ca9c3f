"""What a message of the command proposes to type, read from its words and put into the command it refused."""

from __future__ import annotations

import re

from hersey.cli.application import load

#: An option, and what may follow it as its value: quoted, a number, or a word that ends the proposal.
_OPTION = re.compile(
    r"(?<![\w-])(--[a-z][a-z-]*)(?: (?:'([^']*)'|(-?[0-9.]+)(?=[ ,.;:)]|$)|([A-Za-z]+)(?=[.,;:)]|$)))?"
)
_OTHERWISE = re.compile(r",? or (?=say |name |leave |omit |set |write |add )")
_MEANT = re.compile(r"^hersey: File not found: (\S+)\. Did you mean '([^']*)'\?")
_IN_IT = re.compile(r"^hersey: (\S+) is a folder\. Name a file in it, e\.g\. '([^']*)'")


def followed(arguments: list[str], message: str) -> list[list[str]]:
    """Return the commands that a refusal proposes in the place of one, the first proposal first."""
    flags = _flags(arguments[0])
    if match := _MEANT.match(message) or _IN_IT.match(message):
        return [[match[2] if argument == match[1] else argument for argument in arguments]]
    commands = []
    for part in _OTHERWISE.split(message.partition(": ")[2]):
        command, left_out = list(arguments), re.findall(r"(?:leave out|[Oo]mit) (--[a-z-]+)", part)
        for flag in left_out:
            command = _without(command, flag, flags)
        for flag, *values in _OPTION.findall(part):
            value = next((v for v in values if v), None)
            if flag not in flags or flag in left_out or (flags[flag] and value is None):
                continue
            command = [*_without(command, flag, flags), flag, *([str(value)] if flags[flag] else [])]
        if command != arguments:
            commands.append(command)
    return commands


def _flags(verb: str) -> dict[str, bool]:
    """Options of a verb, and whether each takes a value."""
    return {
        option: not getattr(parameter, "is_flag", False)
        for parameter in load(verb).params
        for option in parameter.opts
        if option.startswith("--")
    }


def _without(arguments: list[str], flag: str, flags: dict[str, bool]) -> list[str]:
    """The command without an option and its value."""
    if flag not in arguments:
        return arguments
    at = arguments.index(flag)
    return arguments[:at] + arguments[at + 1 + flags.get(flag, False) :]
