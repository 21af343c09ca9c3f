"""Files typed in each other's place, or without the option that they need: the whole line to type instead."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from hersey.cli.mistyped import machine_here, options_of, path_of, retyped, writing_machine
from hersey.errors import HerseyError
from hersey.files.endings import LOGS

_TOML = ".toml"
#: Arguments that name a log, and arguments that name a TOML file.
_OF_LOGS = frozenset(["LOG", "A", "B", "TRACE"])
_OF_A_MACHINE = "MACHINE"
#: Tables of a mapping.
_ROLES = frozenset(["time", "torque", "speed", "temperature", "load", "radius"])
#: The option for a TOML file of a kind, and what it is.
_KINDS = {"machine": "a machine file", "recipe": "a recipe", "mapping": "a mapping"}


def refuse_disorder(context: Any, words: Sequence[str]) -> None:
    """Fail with the line to type if files are in the wrong place, or if there are too many.

    ``words`` are what was typed behind the command.
    """
    command, verb = context.command, path_of(context)
    slots = [each.metavar for each in command.params if not each.opts[0].startswith("-")]
    files, others = parted(words, command)
    tomls = [each for each in files if _ends(each, {_TOML})]
    logs = [each for each in files if _ends(each, LOGS)]
    fits = [each for each in files if _is_fit(each)]
    if fits and (_OF_LOGS & {*slots} or options_of(command).keys() & {"fit", "log"}):
        context.fail(
            _instead_of_fit(fits, [each for each in files if each not in fits], others, slots, context)
        )
    if slots and slots[0] == _OF_A_MACHINE and len(files) == len(tomls) + len(logs):
        wrong = files and (files[0] in logs or (context.args and "log" in options_of(command)))
        if wrong and len(tomls) <= 1:
            placed = logs if len(slots) > 1 else [word for log in logs for word in ("--log", log)]
            machine = tomls[0] if tomls else machine_here()
            which = "The machine file comes first" if files[0] in logs else "A log needs --log"
            if not machine:
                context.fail(
                    f"{which}, but this folder has none. To write one, type: {writing_machine(logs[0])}"
                )
            context.fail(f"{which}. Type: {retyped(*verb, machine, *placed, *others)}")
    elif slots and slots[0] in _OF_LOGS and tomls:
        context.fail(_without(tomls[0], [each for each in files if each != tomls[0]], others, command, verb))
    if context.args:
        context.fail(_superfluous(context.args, files, others, slots, command, verb))


def _without(toml: str, files: list[str], others: list[str], command: Any, verb: list[str]) -> str:
    """What to type instead of a TOML file among the logs."""
    kind = _kind(toml)
    if kind == "scenario":
        return f"{toml} is a scenario, not a log. To run it, type: {retyped('sweep', toml)}"
    needed = [each.metavar for each in command.params if each.required and each.metavar in _OF_LOGS]
    files = [*files, *needed[len(files) :]] if files else files
    if kind not in options_of(command):
        line = retyped(*verb, *(files or ["LOG"]), *others)
        return f"{toml} is {_KINDS[kind]}, not a log. Omit it: {line}"
    flag = f"--{kind}"
    named = next((i for i, word in enumerate(others) if word.split("=")[0] == flag), -1)
    if named >= 0:  # whose value is the log, or another file of that kind
        value = 1 if others[named] == flag else 0
        files = files or [others[named + value].removeprefix(f"{flag}=")]
        others = others[:named] + others[named + value + 1 :]
    files = files or ([] if kind == "recipe" else ["LOG"])
    return f"{toml} is {_KINDS[kind]}, not a log. Type: {retyped(*verb, *files, flag, toml, *others)}"


def _is_fit(file: str) -> bool:
    """Whether a file holds a saved fit."""
    if not _ends(file, {".json"}):
        return False
    from hersey.document.saved_fit import holds_fit

    return holds_fit(file)


def _instead_of_fit(
    fits: list[str], files: list[str], others: list[str], slots: list[str], context: Any
) -> str:
    """What to type instead of a saved fit among the logs; ``files`` are the others."""
    command, verb = context.command, path_of(context)
    said = f"{fits[0]} is a saved fit, not a log"
    tomls = [each for each in files if _ends(each, {_TOML})][:1]
    if _OF_A_MACHINE in slots:
        machine = [*(tomls or [machine_here() or _OF_A_MACHINE])]
    else:
        machine = ["--machine", *tomls] if tomls and "machine" in options_of(command) else []
    if "fit" in options_of(command):
        return f"{said}. Type: {retyped(*verb, *machine, '--fit', fits[0], *_not_of_a_log(others, command))}"
    logs = [each for each in files if each not in tomls]
    needed = [each for each in slots if each in _OF_LOGS] or ["LOG"]
    do = "Omit it" if len(logs) >= len(needed) else "Give the log itself"
    logs += needed[len(logs) :]
    placed = logs if _OF_LOGS & {*slots} else [word for log in logs for word in ("--log", log)]
    typed = [*machine, *placed] if _OF_A_MACHINE in slots else [*placed, *machine]
    return f"{said}. {do}: {retyped(*verb, *typed, *others)}"


def _not_of_a_log(others: list[str], command: Any) -> list[str]:
    """Options as typed, without those that say how a log is read, which no saved fit takes, and ``--fit``."""
    from hersey.cli.options import READ, REDUCED

    read = [each for each in command.params if getattr(each, "rich_help_panel", None) in (READ, REDUCED)]
    return without_options(others, ["--fit", *(name for each in read for name in each.opts)], command)


def without_options(others: Sequence[str], omitted: Sequence[str], command: Any) -> list[str]:
    """Return options with their values as typed, without those ``omitted``."""
    known = {name for each in command.params for name in each.opts}
    kept: list[str] = []
    dropping = False
    for word in others:
        flag = word.partition("=")[0]
        if flag in known:
            dropping = flag in omitted
        if not dropping:
            kept.append(word)
    return kept


def _kind(toml: str) -> str:
    """What a TOML file is, by its tables."""
    from hersey.files.toml import read_toml

    tables: set[str] = set()
    with suppress(HerseyError, OSError):
        tables = set(read_toml(Path(toml)))
    if "drivetrain" in tables:
        return "machine"
    if "parameters" in tables:
        return "scenario"
    return "recipe" if "logs" in tables else "mapping" if tables & _ROLES else "machine"


def _superfluous(
    extra: list[str], files: list[str], others: list[str], slots: list[str], command: Any, verb: list[str]
) -> str:
    """What to type instead of words beyond the arguments of a command."""
    kept = [each for each in files if each not in extra]
    options = options_of(command)
    takes = f"takes {' and '.join(slots)}, not '{extra[0]}' too" if slots else f"takes no '{extra[0]}'"
    said = f"hersey {' '.join(verb)} {takes}"
    if len(extra) == 1:
        flag = next(
            (
                name
                for name, endings in (("machine", {_TOML}), ("log", LOGS), ("out", {"", *LOGS, ".html"}))
                if name in options and _ends(extra[0], endings)
            ),
            "",
        )
        if flag:
            return f"{said}. Type: {retyped(*verb, *kept, f'--{flag}', extra[0], *others)}"
    if slots == ["A", "B"]:
        each = retyped("fit", *files, *others, "--each", "fits.csv")
        return f"{said}. Compare two logs at a time, or fit each: {each}"
    return f"{said}. Type: {retyped(*verb, *kept, *others)}"


def _ends(file: str, endings: set[str] | frozenset[str]) -> bool:
    return Path(file).suffix.lower() in endings


def parted(words: Sequence[str], command: Any) -> tuple[list[str], list[str]]:
    """Return the arguments of a command, and its options with their values, each as typed."""
    takes_value = {
        name: not getattr(each, "is_flag", False)
        for each in command.params
        for name in each.opts
        if name.startswith("-")
    }
    arguments: list[str] = []
    options: list[str] = []
    left = list(words)
    while left:
        word = left.pop(0)
        if word == "--":
            arguments += left
            break
        if not word.startswith("-") or word == "-":
            arguments.append(word)
            continue
        options.append(word)
        if "=" not in word and takes_value.get(word, False) and left:
            options.append(left.pop(0))
    return arguments, options
