"""The few things that a log cannot tell, asked in the terminal: ``hersey new``."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import argument, option
from hersey.cli.options import Force
from hersey.cli.outputs import may_write
from hersey.cli.terminal import say
from hersey.errors import HerseyError, ParameterError

if TYPE_CHECKING:
    from hersey.cli.asking import Asking
    from hersey.log.text.column import Column
    from hersey.machine.questions import Question

_ROLES = ("torque", "speed", "temperature", "time")


_MACHINE = "Machine's file to write.  [default: machine.toml]"
_MAPPING = "Mapping to write.  [default: hersey.toml beside the log]"
_ALL = "Ask also for limits, nip, lubricant and the no-load torque."


def new(
    log: Annotated[Path | None, argument("[LOG]", "Log whose channels are proposed.")] = None,
    machine: Annotated[Path | None, option(_MACHINE, metavar="TOML")] = None,
    mapping: Annotated[Path | None, option(_MAPPING, metavar="TOML")] = None,
    everything: Annotated[bool, option(_ALL, "--all")] = False,
    force: Force = False,
) -> None:
    """Ask the few things that a log cannot tell, and write hersey.toml and the machine's file.

    Example: [bold]hersey new bench.csv[/bold]

    Enter takes what is proposed, or leaves out; - leaves out what is proposed. Every number needs its unit.
    """
    if mapping is not None and log is None:
        raise ParameterError("--mapping is about the channels of a log: name the LOG too")
    machine = machine or Path("machine.toml")
    inputs = [log] if log else []
    outputs = [may_write(machine, force, inputs, flag="--machine", ends=[".toml"])]
    if log is not None:
        from hersey.log.mapping import FILE_NAME

        mapping = mapping or log.with_name(FILE_NAME)
        outputs.append(may_write(mapping, force, inputs, flag="--mapping", ends=[".toml"]))

    from hersey.files.writing import write_all
    from hersey.machine.questions import MACHINE

    questions = [q for q in MACHINE if q.first or everything]
    asking = _asking(_ROLES if log else (), questions)
    texts, options = {}, list[str]()
    if log is not None and mapping is not None:
        texts[mapping], options = _mapping(log, asking)
    if text := _machine(questions, asking, machine):
        texts[machine] = text
    write_all(
        {path: text.encode() for path, text in texts.items()},
        overwrite={each.path: each.replace for each in outputs if each.path},
    )
    for path in texts:
        say(f"{'mapping' if path == mapping else 'machine'}: {path}")
    if log is not None and mapping is not None:
        options += [] if mapping == log.with_name("hersey.toml") else ["--mapping", str(mapping)]
        options += ["--machine", str(machine)] if text else []
        _say_next(mapping, texts[mapping], ["hersey", "report", str(log), *options])


def _asking(roles: Sequence[str], questions: list[Question]) -> Asking:
    """What asks for the channels of these roles, what the questions ask, and operating points."""
    from hersey.cli.asking import Asking
    from hersey.machine.questions import POINT

    channels = [f"{field} of {role}" for role in roles for field in ("channel", "unit")]
    point = f"{', '.join(q.field for q in POINT)} of each operating point"
    return Asking([*channels, *(q.name for q in questions), point])


def _say_next(mapping: Path, text: str, command: list[str]) -> None:
    """Say what is to be completed in a mapping, and the command that reads it."""
    to_complete = _to_complete(text)
    if to_complete:
        say(f"complete first: {mapping}, {', '.join(to_complete)}")
    say(f"{'then' if to_complete else 'now'}: {shlex.join(command)}")


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
    from hersey.log.reading import list_channels
    from hersey.log.text.column import Column
    from hersey.machine.writing import mapping_text

    seen = look(log)
    columns = tuple(Column(i, name, unit) for i, (name, unit) in enumerate(list_channels(log)))
    units = {channel["name"]: channel.get("unit", "") for channel in seen["channels"]}
    say(f"{log.name}: {', '.join(map(str, columns[:40]))}", file=sys.stderr)
    answers: dict[str, str] = {}
    lacking: list[str] = []
    options: list[str] = []
    for role in _ROLES:
        claims = seen["claims"].get(role, [])
        proposed = seen["found"].get(role, "") or (claims[0] if len(claims) == 1 else "")
        why = seen["without"].get(role, "")
        if why:
            say(f"  {why}", file=sys.stderr)
        given = _channel(role, proposed, columns, units, log.name, asking)
        answers |= given
        known = proposed or (role == "time" and (seen["own_clock"] or seen["means"]))
        if not given and role == "temperature" and not (claims or proposed):
            options.append("--isothermal")
        elif given or not known:
            lacking += [key for field in ("channel", "unit") if (key := f"{role}.{field}") not in given]
    title = f"Channels of {log.name}, as told to hersey new."
    return mapping_text(answers, title=title, lacking=lacking), options


def _channel(
    role: str, proposed: str, columns: tuple[Column, ...], units: Mapping[str, str], file: str, asking: Asking
) -> dict[str, str]:
    """Channel of a role and its unit, as answered; nothing without a channel."""
    from hersey.log.channels import ChannelChoice, find_channel, role_conversion
    from hersey.units import KINDS

    def named(text: str) -> str:
        choice = ChannelChoice(text, units.get(text) or KINDS[role][1])
        found = find_channel(role, columns, choice, file)
        return text if found is None or text in units else found[0].path

    def unit(text: str) -> str:
        role_conversion(role, text)
        return text

    name = asking.ask(f"channel of the {role}", named, proposed=proposed)
    written = units.get(name or "", "")
    of = asking.ask(f"unit of the {role}", unit, proposed=written if _is_of(role, written) else "")
    given = {f"{role}.channel": name, f"{role}.unit": of if name else None}
    return {key: text for key, text in given.items() if text}


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
    from hersey.machine.questions import lacking
    from hersey.machine.writing import machine_text

    answers: dict[str, str] = {}
    for question in asked:

        def fits(text: str, question: Question = question) -> None:
            with_it = {**answers, question.key: text}
            if not lacking(with_it):  # what fits no other answer is said here
                _refuse_wrong(machine_text(with_it))

        read = _reader(question, fits)
        needed = bool(answers) and question in lacking(answers)
        text = asking.ask(question.name, read, words=_words(question), needed=needed)
        if text:
            answers[question.key] = text
            if question.field == "stick_speed" and asking.by_hand and len(question.values(text)) == 1:
                words = "left out, V* takes it as exact; as 1 mm/s to 4 mm/s, or ± 50 %"
                uncertainty = asking.ask("how far it is known", _known(text, read), words=words)
                answers[question.key] = uncertainty or text
        elif not answers:
            say(f"no machine's file is written: {path} would begin with it", file=sys.stderr)
            return ""
    return machine_text(answers, _points(asking))


def _points(asking: Asking) -> list[dict[str, str]]:
    """The operating points, until one is left out."""
    points: list[dict[str, str]] = []
    while point := _point(len(points) + 1, asking):
        points.append(point)
    return points


def _point(number: int, asking: Asking) -> dict[str, str]:
    """An operating point, empty where the first answer is left out."""
    from hersey.machine.questions import POINT

    point: dict[str, str] = {}
    for question in sorted(POINT, key=lambda q: not q.needed):
        what = f"operating point {number}, {question.name}"
        needed = bool(point) and question.needed
        name = "" if question.needed else f"{point['speed']} at {point['temperature']}"
        text = asking.ask(what, _reader(question), words=_words(question), proposed=name, needed=needed)
        if text:
            point[question.field] = text
        elif not point:
            return {}
    return point


def _reader(question: Question, fits: Callable[[str], None] | None = None) -> Callable[[str], str]:
    """What refuses an answer that has no unit where one is needed, cannot be read, or does not fit."""

    def read(text: str) -> str:
        if question.with_unit(text) != text:
            raise ParameterError(f"'{text}' has no unit: write one, as in '{question.with_unit(text)}'")
        question.values(text)
        if fits is not None:
            fits(text)
        return text

    return read


def _known(value: str, read: Callable[[str], str]) -> Callable[[str], str]:
    """Read a range in the place of a value, or a share behind it."""
    return lambda typed: read(f"{value} {typed}" if typed.startswith(("±", "+")) else typed)


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
