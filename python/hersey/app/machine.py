"""What is wrong with the answers about the machine, in the reader's words, at the field that is guilty."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from hersey.app.channels import Fault
from hersey.errors import HerseyError
from hersey.files.writing import write_atomically
from hersey.log.mapping import read_mapping
from hersey.machine.machine import read_machine
from hersey.machine.questions import BY_KEY, lacking
from hersey.machine.writing import machine_text, mapping_text

#: Names of the files in the folder of an analysis, as commands call them.
MACHINE_FILE, MAPPING_FILE = "machine.toml", "hersey.toml"


def answer_faults(answers: Mapping[str, str], points: Sequence[Mapping[str, str]]) -> list[Fault]:
    """Return what is wrong with single answers, and those that the others make needed."""
    faults = []
    for key, text in answers.items():
        if text.strip():
            faults += _of_answer(f"field:{key}", key, text)
    for number, point in enumerate(points):
        for field in ("name", "speed", "temperature"):
            text = point.get(field, "").strip()
            at = f"field:points.{number}.{field}"
            if text:
                faults += _of_answer(at, f"points.{field}", text)
            elif field != "name":
                faults.append(
                    Fault(at, "This is needed.", "Or remove the point.", f"{field} of point {number + 1}")
                )
    for question in lacking({**answers, **({"drivetrain.points": "1"} if points else {})}):
        text = f"Such as {question.example}; or leave all of the machine blank."
        if question.section not in ("drivetrain", "limits"):
            text = f"Such as {question.example}; the others of its group say nothing without it."
        faults.append(Fault(f"field:{question.key}", "This is needed.", text, label(question.key)))
    return faults


def _of_answer(at: str, key: str, text: str) -> list[Fault]:
    question = BY_KEY[key]
    try:
        question.values(question.with_unit(text))
    except HerseyError as error:
        return [Fault(at, "This cannot be read.", str(error), label(key))]
    return []


def label(key: str) -> str:
    """Return what a field is called on the page."""
    return key.split(".")[-1].replace("_", " ")


def form_text(answers: Mapping[str, str], points: Sequence[Mapping[str, str]]) -> str:
    """Return the machine's file that the form makes, units as they stand beside the fields; empty if blank.

    Raises
    ------
    HerseyError
        If an answer cannot be read.
    """
    given = {key: BY_KEY[key].with_unit(text) for key, text in answers.items() if text.strip()}
    named = [
        {field: BY_KEY[f"points.{field}"].with_unit(text) for field, text in point.items() if text.strip()}
        for point in points
    ]
    return machine_text(given, named) if given or named else ""


def file_faults(text: str, folder: Path, dropped: Mapping[str, Path]) -> list[Fault]:
    """Write the machine's file and return what `hersey.read_machine` says of it.

    ``dropped`` are the files that it may name, by name: it reaches no other.
    """
    path = folder / MACHINE_FILE
    path.unlink(missing_ok=True)
    if not text.strip():
        return []
    try:
        _place_named(text, folder, dropped)
        write_atomically(path, text, overwrite=True)
        read_machine(path)
    except HerseyError as error:
        path.unlink(missing_ok=True)
        said = str(error).removeprefix(f"{MACHINE_FILE}: ").removeprefix(f"{MACHINE_FILE} ")
        return [Fault("toml", "The machine cannot be read.", said, "the machine")]
    return []


def _place_named(text: str, folder: Path, dropped: Mapping[str, Path]) -> None:
    """Lay the logs that the file names beside it; refuse all that was not dropped."""
    try:
        document: dict[str, Any] = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError, ValueError):
        return  # whoever reads it says where
    for section, key in (("rest", "log"), ("gear", "duty")):
        table = document.get(section)
        named = table.get(key) if isinstance(table, dict) else None
        if isinstance(named, str):
            _lay(named, folder, dropped, f"[{section}] names the log")


def _lay(named: str, folder: Path, dropped: Mapping[str, Path], what: str) -> None:
    if named not in dropped:
        raise HerseyError(f"{what} {named}: drop that file here too")
    beside = folder / named
    if not beside.exists():
        beside.symlink_to(dropped[named])


def named_logs(text: str) -> set[str]:
    """Return the names of the logs that a machine's file names: they are no logs of the run."""
    try:
        document = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError, ValueError):
        return set()
    tables = ((document.get("rest"), "log"), (document.get("gear"), "duty"))
    return {
        table[key] for table, key in tables if isinstance(table, dict) and isinstance(table.get(key), str)
    }


def mapping_faults(answers: Mapping[str, str], folder: Path) -> list[Fault]:
    """Write the mapping and return what its reader says of it, at the field it speaks of."""
    path = folder / MAPPING_FILE
    for key, text in answers.items():
        if text.strip() and (faults := _of_answer(f"field:{key}", key, text)):
            return faults
    try:
        write_atomically(path, mapping_of_form(answers), overwrite=True)
        read_mapping(path)
    except HerseyError as error:
        said = str(error).removeprefix(f"{MAPPING_FILE}: ")
        match = re.match(r"(\w+\.\w+)", said)
        at = f"field:{match[1]}" if match and match[1] in BY_KEY else "corrections"
        return [Fault(at, "This cannot be read.", said, "corrections")]
    return []


def mapping_of_form(answers: Mapping[str, str]) -> str:
    """Return ``hersey.toml`` with units as they stand beside the fields.

    Raises
    ------
    HerseyError
        If an answer cannot be read.
    """
    given = {key: BY_KEY[key].with_unit(text) for key, text in answers.items() if text.strip()}
    return mapping_text(given, title="Channels of the log, as chosen in hersey app.")
