"""The few things that a log cannot tell, asked in the terminal: ``hersey new``."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hersey.cli.options import Force
from hersey.cli.outputs import may_write
from hersey.cli.terminal import say
from hersey.errors import HerseyError, ParameterError

if TYPE_CHECKING:
    from hersey.cli.asking import Asking
    from hersey.machine.questions import Question

_ROLES = ("torque", "speed", "temperature", "time")


def new(
    log: Annotated[
        Path | None, typer.Argument(metavar="[LOG]", help="Log whose channels are proposed.")
    ] = None,
    machine: Annotated[
        Path | None,
        typer.Option("--machine", metavar="TOML", help="Machine's file to write.  [default: machine.toml]"),
    ] = None,
    mapping: Annotated[
        Path | None,
        typer.Option(
            "--mapping", metavar="TOML", help="Mapping to write.  [default: hersey.toml beside the log]"
        ),
    ] = None,
    everything: Annotated[
        bool, typer.Option("--all", help="Ask also for limits, nip, lubricant and the rest of the drive.")
    ] = False,
    force: Force = False,
) -> None:
    """Ask the few things that a log cannot tell, and write hersey.toml and the machine's file.

    Example: [bold]hersey new bench.csv[/bold]

    Enter takes what is proposed, or leaves out; - leaves out what is proposed. Every number needs its unit.
    """
    if mapping is not None and log is None:
        raise ParameterError("--mapping is about the channels of a log: name the LOG too")
    machine = machine or Path("machine.toml")
    inputs = [] if log is None else [log]
    replace = {machine: may_write(machine, force, inputs, flag="--machine", ends=[".toml"])}
    if log is not None:
        from hersey.log.mapping import FILE_NAME

        mapping = mapping or log.with_name(FILE_NAME)
        replace[mapping] = may_write(mapping, force, inputs, flag="--mapping", ends=[".toml"])

    from hersey.cli.asking import Asking
    from hersey.files.writing import write_all
    from hersey.machine.questions import MACHINE, POINT

    asked = [q for q in MACHINE if q.first or everything]
    order = [f"{field} of {role}" for role in _ROLES if log for field in ("channel", "unit")]
    order += [q.name for q in asked]
    asking = Asking([*order, f"{', '.join(q.field for q in POINT)} of each operating point"])
    contents: dict[Path, bytes] = {}
    if log is not None and mapping is not None:
        told, given = _mapping(log, asking)
        contents[mapping] = told.encode()
    text = _machine(asked, asking, machine)
    if text:
        contents[machine] = text.encode()
    write_all(contents, overwrite=replace)
    for path in contents:
        say(f"{'mapping' if path == mapping else 'machine'}: {path}")
    if log is not None and mapping is not None:
        to_complete = _to_complete(contents[mapping].decode())
        if to_complete:
            say(f"complete first: {mapping}, {', '.join(to_complete)}")
        parts = ["hersey", "report", str(log), *given]
        parts += [] if mapping == log.with_name("hersey.toml") else ["--mapping", str(mapping)]
        parts += ["--machine", str(machine)] if text else []
        say(f"{'then' if to_complete else 'now'}: {shlex.join(parts)}")


def _to_complete(mapping: str) -> list[str]:
    """The lines of a mapping whose values are empty, each with what belongs there."""
    found, role = [], ""
    for number, line in enumerate(mapping.splitlines(), 1):
        stated = line.partition("#")[0].strip()
        if stated.startswith("["):
            role = stated.strip("[]")
        elif stated.endswith('= ""'):
            found.append(f"line {number} ({stated.split()[0]} of the {role})")
    return found


def _mapping(log: Path, asking: Asking) -> tuple[str, list[str]]:
    """The mapping of a log, whose channels are proposed as they are found, and options that the log needs.

    What the log does not tell and nobody answered is left to be completed in the file.
    """
    from hersey.app.looking import look
    from hersey.log.channels import ChannelChoice, find_channel, role_conversion
    from hersey.log.reading import list_channels
    from hersey.log.text.column import Column
    from hersey.machine.writing import mapping_text

    seen = look(log)
    columns = tuple(Column(i, name, unit) for i, (name, unit) in enumerate(list_channels(log)))
    known = {channel["name"]: channel for channel in seen["channels"]}
    say(f"{log.name}: {', '.join(map(str, columns[:40]))}", file=sys.stderr)
    answers: dict[str, str] = {}
    lacking: list[str] = []
    options: list[str] = []
    for role in _ROLES:

        def named(text: str, role: str = role) -> str:
            unit = known.get(text, {}).get("unit", "")
            choice = ChannelChoice(text, unit or _any_unit(role))
            found = find_channel(role, columns, choice, log.name)
            return text if found is None or text in known else found[0].path

        def unit(text: str, role: str = role) -> str:
            role_conversion(role, text)
            return text

        claims = seen["claims"].get(role, [])
        proposed = seen["found"].get(role, "") or (claims[0] if len(claims) == 1 else "")
        why = seen["without"].get(role, "")
        if why:
            say(f"  {why}", file=sys.stderr)
        name = asking.ask(f"channel of the {role}", named, proposed=proposed)
        told = known.get(name or "", {}).get("unit", "")
        of = asking.ask(f"unit of the {role}", unit, proposed=told if _is_of(role, told) else "")
        if name:
            answers[f"{role}.channel"] = name
        if name and of:
            answers[f"{role}.unit"] = of
        if name is None and not claims and not proposed and role == "temperature":
            options.append("--isothermal")
        elif name is None and (proposed or (role == "time" and (seen["own_clock"] or seen["means"]))):
            continue
        else:
            lacking += [key for field in ("channel", "unit") if (key := f"{role}.{field}") not in answers]
    return mapping_text(
        answers, title=f"Channels of {log.name}, as told to hersey new.", lacking=lacking
    ), options


def _is_of(role: str, unit: str) -> bool:
    """Whether a unit measures what a role is."""
    from hersey.log.channels import role_conversion

    try:
        role_conversion(role, unit)
    except HerseyError:
        return False
    return True


def _machine(asked: list[Question], asking: Asking, path: Path) -> str:
    """The machine's file, empty where the first answer is left out."""
    from hersey.machine.questions import POINT, lacking
    from hersey.machine.writing import machine_text

    answers: dict[str, str] = {}
    for question in asked:
        needed = bool(answers) and question in lacking(answers)

        def read(text: str, question: Question = question) -> str:
            _with_unit(question, text)
            question.values(text)
            with_it = {**answers, question.key: text}
            if not lacking(with_it):  # what fits no other answer is said here
                _refuse_wrong(machine_text(with_it))
            return text

        text = asking.ask(question.name, read, words=_words(question), needed=needed)
        if text:
            answers[question.key] = text
            if question.field == "stick_speed" and asking.by_hand and len(question.values(text)) == 1:
                words = "left out, V* takes it as exact; as 1 mm/s to 4 mm/s, or ± 50 %"
                told = asking.ask("how far it is known", _known(text, read), words=words)
                answers[question.key] = told or text
        elif not answers:
            say(f"no machine's file is written: {path} would begin with it", file=sys.stderr)
            return ""
    points: list[dict[str, str]] = []
    while True:
        point: dict[str, str] = {}
        for question in sorted(POINT, key=lambda q: not q.needed):

            def read(text: str, question: Question = question) -> str:
                _with_unit(question, text)
                question.values(text)
                return text

            what = f"operating point {len(points) + 1}, {question.name}"
            needed = bool(point) and question.needed
            name = "" if question.needed else f"{point['speed']} at {point['temperature']}"
            text = asking.ask(what, read, words=_words(question), proposed=name, needed=needed)
            if text:
                point[question.field] = text
            elif not point:
                return machine_text(answers, points)
        points.append(point)


def _known(value: str, read: Callable[[str], str]) -> Callable[[str], str]:
    """Read a range in the place of a value, or a share behind it."""
    return lambda told: read(f"{value} {told}" if told.startswith(("±", "+")) else told)


def _with_unit(question: Question, text: str) -> None:
    """Refuse a bare number where a unit is needed, with the one that is usual there."""
    if question.with_unit(text) != text:
        raise ParameterError(f"'{text}' has no unit: write one, as in '{question.with_unit(text)}'")


def _refuse_wrong(text: str) -> None:
    """Raise what the reader says of a machine's file."""
    from tempfile import TemporaryDirectory

    from hersey.machine.machine import read_machine

    with TemporaryDirectory() as folder:
        path = Path(folder) / "machine.toml"
        path.write_text(text, encoding="utf-8")
        read_machine(path)


def _words(question: Question) -> str:
    return f"{question.words}; as {question.example}"


def _any_unit(role: str) -> str:
    from hersey.units import KINDS

    return KINDS[role][1]
