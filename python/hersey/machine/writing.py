"""A machine's file and ``hersey.toml`` from answers, with comments that teach what was not answered."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from hersey.errors import ParameterError
from hersey.files.toml import quoted
from hersey.machine.questions import BY_KEY, MACHINE, MAPPING, POINT, TITLES, Question

#: Column at which comments begin.
_COMMENTS = 32


def machine_text(answers: Mapping[str, str], points: Sequence[Mapping[str, str]] = ()) -> str:
    """Return a machine's file as text.

    Parameters
    ----------
    answers
        Answers by the key of their question; blank ones are left out.
    points
        Answers of each operating point by field: ``name``, ``speed``, ``temperature``.

    Raises
    ------
    ParameterError, UnitError
        If an answer cannot be read, in the reader's words.

    Examples
    --------
    >>> print(machine_text({"drivetrain.mass": "11 kg"}).splitlines()[3])
    mass = "11 kg"                  # all that moves with the belt, at the belt: the motor too
    """
    values = _values(answers)
    known = {key: values.pop(key) for key in list(values) if key.startswith("uncertainty.")}
    lines = _tables(MACHINE, values)
    if known:
        lines += ["", f"# {TITLES['uncertainty']}", "[uncertainty]"]
        lines += [_line(key.split(".")[1], value, "") for key, value in known.items()]
    lines += ["", f"# {TITLES['points']}"]
    if not points:
        lines += ["# [[points]]", *(f"# {_line(q.field, _example(q), '')}" for q in POINT)]
    for number, point in enumerate(points):
        stated = _values({f"points.{field}": text for field, text in point.items()})
        lines += [*([""] if number else []), "[[points]]"]
        lines += [_line(q.field, stated[q.key], "") for q in POINT if q.key in stated]
    return "\n".join(lines) + "\n"


def mapping_text(answers: Mapping[str, str], *, title: str = "") -> str:
    """Return ``hersey.toml`` as text; ``title`` is a first line of its own.

    Raises
    ------
    ParameterError, UnitError
        If an answer cannot be read, in the reader's words.
    """
    lines = _tables(MAPPING, _values(answers))
    return "\n".join([*([f"# {title}"] if title else []), *lines]) + "\n"


def answers_of(document: Mapping[str, Any]) -> tuple[dict[str, str], list[dict[str, str]], list[str]]:
    """Return answers and points of a machine's file that was read, and what of it no question asks."""
    answers: dict[str, str] = {}
    points: list[dict[str, str]] = []
    others: list[str] = []
    for section, table in document.items():
        if section == "points" and isinstance(table, list):
            for point in table:
                fields = point if isinstance(point, dict) else {}
                points.append({key: str(value) for key, value in fields.items() if f"points.{key}" in BY_KEY})
                others += [f"points.{key}" for key in fields if f"points.{key}" not in BY_KEY]
            continue
        for key, value in table.items() if isinstance(table, dict) else ():
            question = BY_KEY.get(f"{section}.{key}")
            if question is not None:
                answers[question.key] = _answer(question, value)
            elif section != "uncertainty" and (section, key) != ("lubricant", "model"):
                others.append(f"{section}.{key}")
        if not isinstance(table, dict):
            others.append(section)
    stated = document.get("uncertainty")
    for key, value in stated.items() if isinstance(stated, dict) else ():
        question = BY_KEY.get(f"drivetrain.{key}")
        if question is None or not question.uncertain or question.key not in answers:
            others.append(f"uncertainty.{key}")
        else:
            told = str(value)
            answers[question.key] = f"{answers[question.key]} ± {told}" if "%" in told else told
    return answers, points, others


def _answer(question: Question, value: Any) -> str:
    if question.field == "viscosities" and isinstance(value, list):
        return ", ".join(": ".join(map(str, pair)) for pair in value if isinstance(pair, list))
    return str(value)


def _values(answers: Mapping[str, str]) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for key, text in answers.items():
        if key not in BY_KEY:
            raise ParameterError(f"'{key}' is not asked")
        if text.strip():
            values |= BY_KEY[key].values(text)
    return values


def _tables(questions: Iterable[Question], values: Mapping[str, Any]) -> list[str]:
    lines: list[str] = []
    for section in dict.fromkeys(q.section for q in questions):
        own = [q for q in questions if q.section == section]
        stated = any(q.key in values for q in own)
        mark = "" if stated else "# "
        lines += [""] if lines else []
        lines += [f"# {TITLES[section]}"] if TITLES[section] else []
        lines.append(f"{mark}[{section}]")
        if section == "lubricant" and f"{section}.model" in values:
            lines.append(_line("model", values[f"{section}.model"], "law of viscosity against temperature"))
        for q in own:
            if q.key in values:
                lines.append(_line(q.field, values[q.key], q.words))
            else:
                lines.append(f"# {_line(q.field, _example(q), q.words)}")
    return lines


def _example(question: Question) -> Any:
    return question.values(question.example)[question.key]


def _line(key: str, value: Any, words: str) -> str:
    text = f"{key} = {_written(value)}"
    return f"{text:<{_COMMENTS - 1}} # {words}" if words else text


def _written(value: Any) -> str:
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, list):
        return "[" + ", ".join(map(_written, value)) + "]"
    return repr(value)
