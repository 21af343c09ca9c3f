"""Questions about the machine and the log, in the terminal: ``hersey new``."""

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
from hersey.errors import HerseyError, ParameterError, UnitError, WrongKindError

if TYPE_CHECKING:
    from hersey.cli.asking import Asking
    from hersey.log.text.column import Column
    from hersey.machine.questions import Question

_ROLES = ("torque", "speed", "temperature", "time")


_LOG = "Log whose channels are proposed."
_MACHINE = "Write the machine file here.  [default: machine.toml]"
_MAPPING = "Write the mapping here.  [default: hersey.toml beside the log]"
_ALL = "Ask about limits, nip, lubricant and no-load torque too."


def new(
    log: Annotated[Path | None, argument("LOG", _LOG)] = None,
    machine: Annotated[Path | None, option(_MACHINE, metavar="TOML")] = None,
    mapping: Annotated[Path | None, option(_MAPPING, metavar="TOML")] = None,
    everything: Annotated[bool, option(_ALL, "--all")] = False,
    force: Force = False,
) -> None:
    """Ask about log and machine, and write hersey.toml and the machine file.

    Example: [bold]hersey new bench.csv[/bold]

    Press Enter to accept the proposal in brackets or to skip the question. Type - to reject the proposal, and
    ? for help. Every number needs its unit.
    """
    if mapping is not None and log is None:
        raise ParameterError("--mapping needs a LOG, whose channels it describes")
    from hersey.machine.finding import WRITTEN

    machine = machine or Path(WRITTEN)
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
        say(str(path))
    if log is not None and mapping is not None:
        options += [] if mapping == log.with_name("hersey.toml") else ["--mapping", str(mapping)]
        options += ["--machine", str(machine)] if text else []
        _say_next(mapping, texts[mapping], ["hersey", "report", str(log), *options])


def _asking(roles: Sequence[str], questions: list[Question]) -> Asking:
    """Questions about the channels of these roles, the machine, and its operating points."""
    from hersey.cli.asking import Asking
    from hersey.machine.questions import POINT

    channels = [f"{field} of {role}" for role in roles for field in ("channel", "unit")]
    point = f"{', '.join(q.field for q in POINT)} of each operating point"
    return Asking([*channels, *(q.name for q in questions), point])


def _say_next(mapping: Path, text: str, command: list[str]) -> None:
    """Print what must be completed in a mapping, and the command that reads it."""
    to_complete = _to_complete(text)
    if to_complete:
        say(f"First complete {mapping}: {', '.join(to_complete)}")
    say(f"{'Then' if to_complete else 'Next'}: {shlex.join(command)}")


def _to_complete(mapping: str) -> list[str]:
    """The lines of a mapping whose values are empty, each with its key and role."""
    found, role = [], ""
    for number, line in enumerate(mapping.splitlines(), 1):
        stated = line.partition("#")[0].strip()
        if stated.startswith("["):
            role = stated.strip("[]")
        elif stated.endswith('= ""'):
            found.append(f"line {number} ({stated.split()[0]} of the {role})")
    return found


def _mapping(log: Path, asking: Asking) -> tuple[str, list[str]]:
    """The mapping of a log, whose channels are proposed as found, and options that the log needs.

    A channel or unit that is neither found nor answered is left empty in the file, to be completed.
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
    lacking: dict[str, str] = {}
    options: list[str] = []
    for role in _ROLES:
        claims = seen["claims"].get(role, [])
        proposed = seen["found"].get(role, "") or (claims[0] if len(claims) == 1 else "")
        if why := seen["reasons"].get(role, ""):
            say(f"  {why}", file=sys.stderr)
        given = _channel(role, proposed, columns, units, log.name, asking)
        answers |= given
        known = proposed or (role == "time" and (seen["own_clock"] or seen["means"]))
        if not given and role == "temperature" and not (claims or proposed):
            options.append("--isothermal")
        elif given or not known:
            example = _example(role, units.get(given.get(f"{role}.channel", ""), ""))
            examples = {f"{role}.channel": "", f"{role}.unit": example}
            lacking |= {key: text for key, text in examples.items() if key not in given}
    title = f"Channels of {log.name}, from the answers to hersey new."
    return mapping_text(answers, title=title, lacking=lacking), options


def _channel(
    role: str, proposed: str, columns: tuple[Column, ...], units: Mapping[str, str], file: str, asking: Asking
) -> dict[str, str]:
    """Channel of a role and its unit, as answered; nothing without a channel."""
    from hersey.errors import ChannelError, meant
    from hersey.log.channels import named_channel

    def named(text: str) -> str:
        try:
            found = named_channel(role, columns, text, file)
        except ChannelError as error:
            near = meant(text, [column.path for column in columns])
            raise ChannelError(error.reason, remedy=f"did you mean {near}?" if near else "") from None
        return text if text in units else found.path

    name = asking.ask(f"channel of the {role}", named, proposed=proposed)
    if asking.by_hand and not name:
        return {}
    of = _unit(role, units.get(name or "", ""), asking)
    given = {f"{role}.channel": name, f"{role}.unit": of if name else None}
    return {key: text for key, text in given.items() if text}


def _unit(role: str, written: str, asking: Asking) -> str | None:
    """Unit of a role as answered; of a signal, what it stands for is asked."""
    from hersey.log.roles import role_conversion
    from hersey.log.signals import answered, is_signal, question, says_how_much

    def unit(text: str) -> str:
        role_conversion(role, text)
        return text

    if role == "time" or not is_signal(written):
        likely = _likely(role, written)
        words = f"the log has '{written}'" if likely != written else ""
        return asking.ask(f"unit of the {role}", unit, words=words, proposed=likely)
    what, example = question(role, written)

    def amount(text: str) -> str:
        try:
            if says_how_much(text):
                return unit(answered(text, written))
        except UnitError:
            pass
        raise UnitError(f"'{text}' is not a {role} with its unit: write '{example}', for example")

    return asking.ask(what, amount, words=f"e.g. {example}")


def _example(role: str, written: str) -> str:
    """A unit of a signal as an example, else nothing."""
    from hersey.log.signals import answered, is_signal, question

    if role == "time" or not is_signal(written):
        return ""
    return answered(question(role, written)[1], written)


def _likely(role: str, written: str) -> str:
    """The unit of a role that a log has, or that one it cannot have was probably meant for."""
    from hersey.log.roles import role_conversion
    from hersey.units import nearest_unit

    try:
        role_conversion(role, written)
    except WrongKindError:
        return ""
    except HerseyError:
        return nearest_unit(role, written) if written else ""
    return written


def _machine(asked: list[Question], asking: Asking, path: Path) -> str:
    """The machine file, empty if the first question is skipped."""
    from hersey.machine.questions import PART, asked_of, lacking
    from hersey.machine.writing import machine_text

    answers: dict[str, str] = {}
    for general in asked:
        question = asked_of(general, answers.get(PART, ""))

        def fits(text: str, question: Question = question) -> None:
            with_it = {**answers, question.key: text}
            if not lacking(with_it):  # answers that contradict each other are refused here
                _refuse_wrong(machine_text(with_it))

        read = _reader(question, fits)
        begun = any(key != PART for key in answers)
        needed = begun and general in lacking(answers)
        assumed = question.assumed if needed else ""
        text = asking.ask(question.name, read, words=_words(question), proposed=assumed, needed=needed)
        if text and text == assumed:
            say(f"  {question.name}: {text} is assumed. Results depend on it.", file=sys.stderr)
        if text:
            answers[question.key] = text
            if question.field == "stick_speed" and asking.by_hand and len(question.values(text)) == 1:
                words = "e.g. 1 mm/s to 4 mm/s, or ± 50 %; if skipped, the value counts as exact"
                uncertainty = asking.ask("its uncertainty", _known(text, read), words=words)
                answers[question.key] = uncertainty or text
        elif question.needed and not begun:
            say(f"No machine file is written, because {path} needs this answer.", file=sys.stderr)
            return ""
    return machine_text(answers, _points(asking, answers.get(PART, "")))


def _points(asking: Asking, part: str) -> list[dict[str, str]]:
    """The operating points, until one is skipped."""
    points: list[dict[str, str]] = []
    while point := _point(len(points) + 1, asking, part):
        points.append(point)
    return points


def _point(number: int, asking: Asking, part: str) -> dict[str, str]:
    """An operating point, empty if its first question is skipped."""
    from hersey.machine.questions import POINT, asked_of

    point: dict[str, str] = {}
    for question in (asked_of(q, part) for q in sorted(POINT, key=lambda q: not q.needed)):
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
    """A reader that refuses an answer without its unit, or one that is wrong or contradicts another."""
    from hersey.machine.uncertainty import range_ends

    def read(text: str) -> str:
        ends = range_ends(text) if question.uncertain else None
        plain = " to ".join(ends) if ends else text
        if question.with_unit(plain) != plain:
            raise ParameterError(f"'{text}' has no unit: write '{question.with_unit(text)}', for example")
        question.values(text)
        if fits is not None:
            fits(text)
        return text

    return read


def _known(value: str, read: Callable[[str], str]) -> Callable[[str], str]:
    """Read a range, or a share after the value."""
    return lambda typed: read(f"{value} {typed}" if typed.startswith(("±", "+")) else typed)


def _refuse_wrong(text: str) -> None:
    """Raise the reader's error for this machine file."""
    from tempfile import TemporaryDirectory

    from hersey.machine.machine import read_machine

    with TemporaryDirectory() as folder:
        path = Path(folder) / "machine.toml"
        path.write_text(text, encoding="utf-8")
        read_machine(path)


def _words(question: Question) -> str:
    example = "press Enter if you do not know it" if question.assumed else f"e.g. {question.example}"
    return f"{question.words}; {example}"
