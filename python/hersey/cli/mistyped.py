"""What to type instead of a command line that cannot be understood."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from hersey.errors import meant
from hersey.files.endings import LOGS

#: Ending of a machine file, and of a campaign.
_MACHINE, _CAMPAIGN = ".toml", ".hersey"
#: What to type for a file that is not a log, by its ending.
_OTHER_FILES = {
    _MACHINE: ("report", "LOG", "--machine", "{}"),
    _CAMPAIGN: ("life", "{}", "--machine", "TOML"),
}
#: Options that mean the same in different commands, and words for them; the first that a command has is
#: proposed.
_SAME = (
    ("out", "each", "csv", "o", "output", "outfile", "save", "write", "file", "table", "html", "export"),
    ("figure", "figures", "plot", "chart", "picture", "image", "png", "svg", "pdf", "draw"),
    ("figures", "out-dir", "outdir", "output-dir", "dir", "folder"),
    ("drive-speed", "target", "belt-speed"),
    ("drive-speed", "speed", "velocity", "rpm", "v"),
    ("at", "temperature", "temp", "t"),
    ("value", "torque", "force", "column", "channel", "y"),
    ("duration", "time", "t-end", "tend", "end", "seconds", "length"),
    ("every", "dt", "fs", "rate", "sample-rate", "sampling-rate", "sample-time", "interval", "period"),
    ("least-drop", "threshold", "min-drop"),
    ("unit", "specimen", "sample", "id"),
    ("units", "specimens", "samples", "n"),
    ("workers", "threads", "jobs", "cores", "processes", "j"),
    ("against", "baseline", "compare", "reference", "with"),
    ("tare", "offset", "zero"),
    ("from", "begin", "start-temperature", "t0"),
    ("stiffness", "k", "spring"),
    ("mass", "m", "inertia"),
    ("force", "overwrite", "replace", "yes", "y"),
    ("quiet", "silent", "q"),
    ("verbose", "debug", "details", "full"),
    ("draws", "count", "samples", "n"),
)
#: Option that prints a result.
_PRINTS = "--json"
#: What takes the files of a subcommand.
_FMU = "fmu"
_TAKERS = {_FMU: "Simulink, Amesim, Modelica tools and others import an FMU."}
#: Options of which the first names a file to write.
_WRITING = _SAME[0]
#: Parts of a name that do not say which option is meant.
_IDLE = frozenset(["col", "column", "channel", "name", "file", "path"])
#: Files that a command may take as an argument, by a word for them: names of such arguments.
_ARGUMENTS: Mapping[str, tuple[str, ...]] = {
    "machine": ("MACHINE", "[JSON] TOML"),
    "fit": ("[JSON] TOML",),
    "log": ("LOG", "TRACE", "RUN"),
    "logs": ("LOG", "RUN"),
    "trace": ("TRACE",),
    "input": ("LOG", "TRACE", "SCENARIO"),
    "scenario": ("SCENARIO",),
    "campaign": ("CAMPAIGN",),
}
#: Arguments, and words for one, that come first.
_FIRST = ("MACHINE", "SCENARIO", "CAMPAIGN", "fit")
#: Most options or commands that are proposed.
_MOST = 4


class Commands(NamedTuple):
    """The names of all commands, and what loads one with its options."""

    names: Sequence[str]
    load: Callable[[str], Any]


def retyped(*words: str) -> str:
    """Return a command line as it can be typed."""
    return shlex.join(["hersey", *words])


def machine_here() -> str:
    """Return the machine file in this folder, of several ``machine.toml`` or the first; empty if none."""
    from hersey.machine.finding import WRITTEN, machine_files

    there = machine_files(Path())
    return WRITTEN if WRITTEN in there else next(iter(there), "")


def writing_machine(log: str = "LOG") -> str:
    """Return the line that writes a machine file, and the mapping of the log unless there is one."""
    from hersey.log.mapping import FILE_NAME

    return retyped("new", *([] if Path(log).with_name(FILE_NAME).exists() else [log]))


def typed_without(flags: Sequence[str]) -> list[str]:
    """Return the words that were typed behind ``hersey``, without some options and their values."""
    kept: list[str] = []
    skipped = False
    for word in sys.argv[1:]:
        if skipped or word.partition("=")[0] in flags:
            skipped = word in flags and not skipped
            continue
        kept.append(word)
    return kept


# ---- commands


def unknown_command(name: str, others: Sequence[str], commands: Commands) -> str:
    """Say what to type instead of a command that does not exist."""
    path = Path(name)
    with suppress(OSError, ValueError):  # a name that no file can have
        if path.is_file() or path.suffix.lower() in {*LOGS, *_OTHER_FILES}:
            if others and others[0] in commands.names:
                typed = _behind(others[0], name, others[1:], commands)
                return f"The command comes first. Type: {retyped(*typed)}"
            what = "a file, not a command" if path.is_file() else "not a command"
            words = _OTHER_FILES.get(path.suffix.lower(), ("report", "{}"))
            typed = [name if word == "{}" else word for word in words]
            typed = [(machine_here() or word) if word == "TOML" else word for word in typed]
            return f"'{name}' is {what}. For a report type: {retyped(*typed, *others)}"
    near = meant(name, commands.names)
    if near:
        return f"There is no command '{name}'. Did you mean: {retyped(near, *others)}"
    return f"There is no command '{name}'. For a list of all commands type: hersey --help"


def _behind(verb: str, file: str, others: Sequence[str], commands: Commands) -> list[str]:
    """The command with the file that was typed before it: a machine file is an option of most commands."""
    if Path(file).suffix.lower() == _MACHINE and "machine" in options_of(commands.load(verb)):
        return [verb, *others, "--machine", file]
    return [verb, file, *others]


def unknown_subcommand(verb: str, name: str, others: Sequence[str], known: Sequence[str]) -> str:
    """Say what to type instead of a subcommand that does not exist."""
    said = f"hersey {verb} has no subcommand '{name}'"
    near = meant(name, known)
    if near:
        return f"{said}. Did you mean: {retyped(verb, near, *others)}"
    if len(known) == 1:
        is_file = bool(Path(name).suffix)
        takers = "" if is_file else f" {_TAKERS[known[0]]}" if known[0] in _TAKERS else ""
        return f"{said}.{takers} Type: {retyped(verb, *_of_a_unit([name] * is_file + [*others]))}"
    names = [each for each in (name, *others) if not each.startswith("-")]
    campaigns = [each for each in names if Path(each).suffix.lower() == _CAMPAIGN]
    if any(Path(each).suffix.lower() in LOGS for each in names):
        first = [] if campaigns else [f"life{_CAMPAIGN}"]
        return f"{said}. To add a log type: {retyped(verb, 'add', *first, name, *others)}"
    if campaigns:
        return f"{said}. To list the runs type: {retyped(verb, 'list', campaigns[0])}"
    return f"{said}. It has: {', '.join(known)}"


def _of_a_unit(words: list[str]) -> list[str]:
    """The subcommand that exports a unit with these words, so that it runs; else with its help."""
    from hersey.cli.completed import completed

    typed = completed(words) if any(Path(word).suffix.lower() == _MACHINE for word in words) else ["--help"]
    return [_FMU, *typed]


# ---- options


def unknown_option(name: str, context: Any, commands: Commands) -> str:
    """Say what to type instead of an option that a command does not have."""
    verb = path_of(context)
    rest = sys.argv[1 + len(verb) :]
    at = next((i for i, each in enumerate(rest) if each.partition("=")[0].startswith(name)), len(rest))
    token, _, value = (rest[at] if at < len(rest) else name).partition("=")
    if not verb:
        return _before_the_command(token, rest, commands.names)
    after = at + 1
    if not value and after < len(rest) and not rest[after].startswith("-"):
        value, after = rest[after], after + 1
    word, options = _word(token), list(options_of(context.command))
    said = f"hersey {' '.join(verb)} has no option {token}"
    argument = _argument(word, context.command)
    if argument:
        others, file = [*rest[:at], *rest[after:]], value or argument.lower()
        typed = [file, *others] if argument in _FIRST or word in _FIRST else [*others, file]
        return f"{said}: the file is an argument. Type: {retyped(*verb, *typed)}"
    near = _near(word, options, value)
    having = [each for each in commands.names if word in options_of(commands.load(each))]
    if having and not near:
        takes_value = options_of(commands.load(having[0]))[word]
        omitted = shlex.join([token, value] if takes_value and value else [token])
        listed = ", ".join(f"hersey {each}" for each in having[:_MOST])
        return f"{said}. Omit {omitted}. It is an option of {listed}"
    near = near or _alike(word, options)
    if near:
        return f"{said}. Did you mean {_either(near)}?"
    return f"{said}. For all options type: {retyped(*verb, '--help')}"


def _before_the_command(token: str, rest: Sequence[str], verbs: Sequence[str]) -> str:
    """What to type instead of an option in front of the command, or without a command."""
    verb = next((each for each in rest if each in verbs), "")
    if verb:
        at = rest.index(verb)
        return f"Options follow the command. Type: {retyped(verb, *rest[:at], *rest[at + 1 :])}"
    if any(Path(each).suffix.lower() in LOGS for each in rest):
        return f"Options follow a command. For a report type: {retyped('report', *rest)}"
    near = _near(_word(token), ["version", "help"], "")
    to_type = f"Did you mean {_either(near)}?" if near else "For a list of all commands type: hersey --help"
    return f"hersey has no option {token}. {to_type}"


def path_of(context: Any) -> list[str]:
    """Return the names of the command and its subcommand."""
    names: list[str] = []
    while context.parent is not None:
        names.insert(0, context.info_name)
        context = context.parent
    return names


def _word(token: str) -> str:
    """The name of an option as it is written here, without parts that say nothing."""
    word = token.lstrip("-").lower().replace("_", "-")
    parts = word.split("-")
    while len(parts) > 1 and parts[-1] in _IDLE:
        parts.pop()
    return "-".join(parts)


def options_of(command: Any) -> dict[str, bool]:
    """Return the long names of the options of a command, without dashes, and whether a value follows each."""
    return {
        name.removeprefix("--"): not getattr(each, "is_flag", False)
        for each in command.params
        for name in each.opts
        if name.startswith("--")
    }


def _argument(word: str, command: Any) -> str:
    """The name of the argument that a word means, if the command takes such a file as an argument."""
    metavars = [each.metavar for each in command.params if not each.opts[0].startswith("-")]
    return next((each for each in _ARGUMENTS.get(word, ()) if each in metavars), "")


def _near(word: str, options: Sequence[str], value: str) -> list[str]:
    """The options of a command that a word means, as they are typed."""
    if word in options:
        return [f"--{word}"]
    if word in _WRITING and (written := _written(options, value)):
        return written
    longer = [each for each in options if each.startswith(word)]
    shortest = [
        each for each in longer if not any(each != one and each.startswith(f"{one}-") for one in longer)
    ]
    if shortest and (len(word) > 1 or len(shortest) <= _MOST):
        return [f"--{each}" for each in shortest[:_MOST]]
    for row in _SAME:
        has = [each for each in row if each in options]
        if word in row and has:
            return [f"--{has[0]}"]
    parts = set(word.split("-"))
    holding = [each for each in options if parts <= set(each.split("-"))]
    if holding:
        return [f"--{each}" for each in holding[:_MOST]]
    held = [each for each in options if set(each.split("-")) < parts]
    return [f"--{each}" for each in held[:1]]


def _alike(word: str, options: Sequence[str]) -> list[str]:
    """The option that a word with a slip is nearest to."""
    close = meant(word, options) if len(word) > 1 else ""
    return [f"--{close}"] if close else []


def _written(options: Sequence[str], value: str) -> list[str]:
    """The options by which a command writes a file of this name."""
    from hersey.charts import PICTURES

    suffix = Path(value).suffix.lower()
    found = [each for each in ("figure",) if each in options and suffix in PICTURES and "out" not in options]
    found = found or [each for each in _WRITING[:3] if each in options][:1]
    typed = [f"--{each}" for each in found]
    if "json" in options and "out" not in options and (suffix == ".json" or found in ([], ["each"])):
        typed.append(f"--json > {shlex.quote(value) if suffix == '.json' else 'result.json'}")
    return typed


def _either(names: Sequence[str]) -> str:
    *first, last = names
    return f"{', '.join(first)} or {last}" if first else last


# ---- what is missing


def missing(parameter: Any, context: Any) -> str:
    """Say what a command needs that was not typed."""
    name = (
        f"{parameter.opts[0]} {parameter.metavar or ''}".rstrip()
        if parameter.opts[0].startswith("-")
        else parameter.metavar
    )
    said = f"{retyped(*path_of(context))} needs {name}: {_help(parameter)}"
    words = sys.argv[1:]
    tomls = [each for each in words if Path(each).suffix.lower() == _MACHINE]
    if "--machine" in parameter.opts and len(tomls) == 1:
        rest = [each for each in words if each not in tomls]
        takes_log = any(each.metavar == "LOG" for each in context.command.params)
        if takes_log and not any(Path(each).suffix.lower() in LOGS for each in rest):
            rest.append("LOG")
        return f"{said}. Type: {retyped(*rest, '--machine', *tomls)}"
    if parameter.metavar == "MACHINE" and not machine_here():
        return f"{said}. To write one, type: {writing_machine()}"
    return said


def misused(name: str, commands: Commands) -> str:
    """Say what an option needs that was typed without its value, or with one that it does not take."""
    parameter = parameters_of(sys.argv[1:], commands).get(name)
    if parameter is None:
        return ""
    if getattr(parameter, "is_flag", False):
        return f"{name} takes no value: type {name}{' > result.json' * (name == _PRINTS)}"
    return f"{name} needs a value: {_help(parameter)}"


def misread(error: Any) -> str:
    """Say which numbers an option takes if its value is another one or no number; else nothing."""
    faults = error.__cause__.errors() if hasattr(error.__cause__, "errors") else []
    if not faults or error.param is None:
        return ""
    kind, limits = str(faults[0]["type"]), faults[0].get("ctx", {})
    asked = {
        "greater_than_equal": f"at least {limits.get('ge')}",
        "less_than_equal": f"at most {limits.get('le')}",
    } | {
        f"{number}_{fault}": words
        for number, words in (("int", "a whole number"), ("float", "a number"))
        for fault in ("parsing", "type", "from_float", "parsing_size")
    }
    return f"{error.param.opts[0]} must be {asked[kind]}, not {faults[0]['input']}" if kind in asked else ""


def without_value(words: Sequence[str], commands: Commands) -> str:
    """Return the first option that was typed without its value, so that the next option became the value."""
    known = parameters_of(words, commands)
    for flag, value in pairwise(words):
        if value.partition("=")[0] in known and not getattr(known.get(flag), "is_flag", flag not in known):
            return flag
    return ""


def parameters_of(words: Sequence[str], commands: Commands) -> dict[str, Any]:
    """Return the options of the command that was typed, by their names."""
    if not words or words[0] not in commands.names:
        return {}
    command = commands.load(words[0])
    subcommands = getattr(command, "commands", {})
    if subcommands:
        command = subcommands.get(next(iter(words[1:]), ""), command)
    return {name: each for each in command.params for name in each.opts if name.startswith("-")}


def _help(parameter: Any) -> str:
    words = (parameter.help or "").partition("  \\[")[0].rstrip(".")
    return words.replace("\\[", "[")  # as the markup of help texts has a bracket


def unquoted(words: Sequence[str]) -> str:
    """Return an option whose number and unit were typed as two words, as it should be typed, or nothing."""
    for flag, number, unit in zip(words, words[1:], words[2:], strict=False):
        if flag.startswith("--") and _is_number(number) and _is_unit(unit):
            return f"{flag} '{number} {unit}'"
    return ""


def printed(words: Sequence[str]) -> str:
    """Return the file that was typed behind --json, as if it were written there, or nothing."""
    for flag, file in pairwise(words):
        if flag == _PRINTS and Path(file).suffix == ".json" and not Path(file).exists():
            return shlex.quote(file)
    return ""


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _is_unit(text: str) -> bool:
    """Whether a text is the unit of something, and not a file."""
    from hersey.errors import UnitError
    from hersey.units import KINDS, conversion

    if text.startswith("-") or Path(text).exists():
        return False
    for kind in KINDS:
        with suppress(UnitError):
            conversion(kind, text)
            return True
    return False
