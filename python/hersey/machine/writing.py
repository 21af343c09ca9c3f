"""A machine file and ``hersey.toml`` from answers, with comments that teach what was not answered."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

from hersey.errors import ParameterError
from hersey.files.toml import quoted
from hersey.machine.questions import BY_KEY, MACHINE, MAPPING, PART, POINT, TITLES, Question, asked_of

#: What no question asks of a file, as TOML holds it: values of its tables by key, or what stands in none.
Others = Mapping[str, Any]

#: Column at which comments begin.
_COMMENTS = 32


def machine_text(
    answers: Mapping[str, str], points: Sequence[Mapping[str, Any]] = (), others: Others | None = None
) -> str:
    """Return a machine file as text.

    Parameters
    ----------
    answers
        Answers by the key of their question; blank ones are skipped.
    points
        Answers of each operating point by field: ``name``, ``speed``, ``temperature``; what else it holds
        is written as it is.
    others
        What no question asks, written as it is.

    Raises
    ------
    ParameterError, UnitError
        If an answer cannot be read, in the reader's words.

    Examples
    --------
    >>> print(machine_text({"drivetrain.mass": "11 kg"}).splitlines()[4])
    mass = "11 kg"                  # all that moves, motor included, where it slides; or moment of inertia
    """
    values = _values(answers)
    known = {key: values.pop(key) for key in list(values) if key.startswith("uncertainty.")}
    others = dict(others or {})
    known = {f"uncertainty.{key}": value for key, value in others.pop("uncertainty", {}).items()} | known
    lines = _tables(MACHINE, values, others)
    if known:
        lines += ["", f"# {TITLES['uncertainty']}", "[uncertainty]"]
        lines += [_line(key.split(".")[1], value, "") for key, value in known.items()]
    lines += ["", f"# {TITLES['points']}"]
    if not points:
        lines += ["# [[points]]", *(f"# {_line(q.field, _example(q), '')}" for q in POINT)]
    for number, point in enumerate(points):
        asked = {key: text for field, text in point.items() if (key := f"points.{field}") in BY_KEY}
        stated = _values(asked)
        lines += [*([""] if number else []), "[[points]]"]
        lines += [_line(q.field, stated[q.key], "") for q in POINT if q.key in stated]
        lines += [_line(field, value, "") for field, value in point.items() if f"points.{field}" not in asked]
    return "\n".join(lines) + "\n"


def mapping_text(
    answers: Mapping[str, str],
    *,
    title: str = "",
    others: Others | None = None,
    lacking: Mapping[str, str] | None = None,
) -> str:
    """Return ``hersey.toml`` as text; ``title`` is a first line of its own, ``others`` what no question asks.

    ``lacking`` are questions that must be answered and are not, each with an example, empty for that of the
    question: their values are empty, which no reader takes, with a comment that says what to write there.

    Raises
    ------
    ParameterError, UnitError
        If an answer cannot be read, in the reader's words.
    """
    lines = _tables(MAPPING, _values(answers), others or {}, lacking or {})
    return "\n".join([*([f"# {title}"] if title else []), *lines]) + "\n"


def answers_of(document: Mapping[str, Any]) -> tuple[dict[str, str], list[dict[str, Any]], dict[str, Any]]:
    """Return answers and points of a file that was read, and what of it no question asks.

    The points hold what no question asks beside their answers.
    """
    answers: dict[str, str] = {}
    points: list[dict[str, Any]] = []
    others: dict[str, Any] = {}
    for section, table in document.items():
        if section == "points" and isinstance(table, list):
            for point in table:
                fields = point if isinstance(point, dict) else {}
                points.append({k: str(v) if f"points.{k}" in BY_KEY else v for k, v in fields.items()})
            continue
        if not isinstance(table, dict):
            others[section] = table
            continue
        for key, value in table.items():
            question = BY_KEY.get(f"{section}.{key}")
            if question is not None:
                answers[question.key] = _answer(question, value)
            else:
                others.setdefault(section, {})[key] = value
        if not table:
            others[section] = {}
    _know(answers, others)
    return answers, points, others


def _know(answers: dict[str, str], others: dict[str, Any]) -> None:
    """Take from the others what is known of an answer, where both make the same lines again."""
    stated = others.get("uncertainty")
    for key, uncertainty in list(stated.items()) if isinstance(stated, dict) else ():
        question = BY_KEY.get(f"drivetrain.{key}")
        if question is None or not question.uncertain or question.key not in answers:
            continue
        value = answers[question.key]
        both = f"{value} ± {uncertainty}" if "%" in str(uncertainty) else str(uncertainty)
        if question.values(both) == {question.key: value, f"uncertainty.{key}": uncertainty}:
            answers[question.key] = both
            others["uncertainty"].pop(key)
    if stated == {}:
        del others["uncertainty"]
    law = others.get("lubricant")
    points = answers.get("lubricant.viscosities")
    if points is not None and isinstance(law, dict) and "model" in law:
        made = BY_KEY["lubricant.viscosities"].values(points)
        if made["lubricant.model"] == law["model"]:
            del law["model"]
            if not law:
                del others["lubricant"]


def _answer(question: Question, value: Any) -> str:
    if question.field == "viscosities" and isinstance(value, list):
        return ", ".join(": ".join(map(str, pair)) for pair in value if isinstance(pair, list))
    return str(value)


def _values(answers: Mapping[str, str]) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for key, text in answers.items():
        if key not in BY_KEY:
            raise ParameterError(f"there is no question '{key}'")
        if text.strip():
            values |= BY_KEY[key].values(text)
    return values


def _tables(
    questions: Iterable[Question],
    values: Mapping[str, Any],
    others: Others,
    lacking: Mapping[str, str] = MappingProxyType({}),
) -> list[str]:
    lines = [_line(key, value, "") for key, value in others.items() if not isinstance(value, dict)]
    sections = list(dict.fromkeys(q.section for q in questions))
    for section in sections:
        own = [asked_of(q, str(values.get(PART, ""))) for q in questions if q.section == section]
        more = others.get(section, {})
        stated = any(q.key in values or q.key in lacking for q in own) or bool(more)
        mark = "" if stated else "# "
        lines += [""] if lines else []
        lines += [f"# {TITLES[section]}"] if TITLES[section] else []
        lines.append(f"{mark}[{section}]")
        if section == "lubricant" and f"{section}.model" in values and "model" not in more:
            lines.append(_line("model", values[f"{section}.model"], "law of viscosity against temperature"))
        for q in own:
            if q.key in values:
                lines.append(_line(q.field, values[q.key], q.words))
            elif q.key in lacking:
                example = lacking[q.key] or _example(q)
                lines.append(_line(q.field, "", f"write the {q.words.removeprefix('its ')}, e.g. {example}"))
            else:
                lines.append(f"# {_line(q.field, _example(q), q.words)}")
        lines += [_line(key, value, "") for key, value in more.items()]
    for section, table in others.items():
        if section not in sections and isinstance(table, dict):
            lines += ["", f"[{_key(section)}]", *(_line(key, value, "") for key, value in table.items())]
    return lines


def _example(question: Question) -> Any:
    return question.values(question.example)[question.key]


def _line(key: str, value: Any, words: str) -> str:
    text = f"{_key(key)} = {_written(value)}"
    return f"{text:<{_COMMENTS - 1}} # {words}" if words else text


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else quoted(name)


def _written(value: Any) -> str:
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return "[" + ", ".join(map(_written, value)) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(key)} = {_written(each)}" for key, each in value.items()) + "}"
    return repr(value)
