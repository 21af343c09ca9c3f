"""Problems with the answers about the machine, in the words of the reader, each at its field."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path, PureWindowsPath
from tempfile import TemporaryDirectory
from typing import Any

from hersey.app.channels import Fault
from hersey.errors import HerseyError
from hersey.files.toml import read_toml
from hersey.files.writing import write_atomically
from hersey.log.mapping import read_mapping
from hersey.log.quantities import amount
from hersey.log.roles import OTHER_ROLES, ROLES
from hersey.machine.machine import read_machine
from hersey.machine.questions import BY_KEY, POINT, lacking
from hersey.machine.writing import answers_of, machine_text, mapping_text
from hersey.units import parse

#: Names of the files in the folder of an analysis, as commands call them.
MACHINE_FILE, MAPPING_FILE = "machine.toml", "hersey.toml"
#: Usual ranges (SI) of a drive; beyond them a unit is probably wrong.
_USUAL = {
    "drivetrain.stiffness": ("stiffness", 1.0, 1e8),
    "drivetrain.mass": ("mass", 1e-3, 1e4),
    "drivetrain.roll_radius": ("length", 5e-4, 1.0),
    "drivetrain.stick_speed": ("belt speed", 1e-7, 1.0),
}
#: What the form asks of an operating point.
POINT_FIELDS = tuple(q.field for q in POINT)


def answer_faults(answers: Mapping[str, str], points: Sequence[Mapping[str, str]]) -> list[Fault]:
    """Return problems with single answers, and answers that others make necessary."""
    faults = []
    for key, text in answers.items():
        if text.strip():
            faults += _of_answer(f"field:{key}", key, text)
    for number, point in enumerate(points):
        for field in POINT_FIELDS:
            text = point.get(field, "").strip()
            at = f"field:points.{number}.{field}"
            if text:
                faults += _of_answer(at, f"points.{field}", text)
            elif field != "name":
                faults.append(
                    Fault(
                        at, "This value is missing.", "Or remove the point.", f"{field} of point {number + 1}"
                    )
                )
    for question in lacking({**answers, **({"drivetrain.points": "1"} if points else {})}):
        text = f"For example {question.example}. Or leave the whole machine blank."
        if question.section not in ("drivetrain", "limits"):
            text = f"For example {question.example}. The other values of its group need it."
        faults.append(Fault(f"field:{question.key}", "This value is missing.", text, label(question.key)))
    return faults


def doubtful(answers: Mapping[str, str]) -> list[Fault]:
    """Return unusual answers, which can be kept; unreadable ones are not among them."""
    faults = []
    for key, (kind, low, high) in _USUAL.items():
        question, text = BY_KEY[key], answers.get(key, "").strip()
        try:
            value = str(question.values(question.with_unit(text))[key]) if text else ""
            doubt = bool(value) and not low <= parse(kind, value) <= high
        except HerseyError:
            continue
        if doubt:
            title = f"{value} is unusual for such a drive."
            faults.append(
                Fault(
                    f"field:{key}",
                    title,
                    f"For example {question.example}.",
                    label(key),
                    keep=f"Keep {value}",
                )
            )
    return faults


def _of_answer(at: str, key: str, text: str) -> list[Fault]:
    question = BY_KEY[key]
    try:
        question.values(question.with_unit(text))
    except HerseyError as error:
        return [Fault(at, "This cannot be read.", str(error), label(key))]
    return []


def label(key: str) -> str:
    """Return the name of a field on the page."""
    return key.split(".")[-1].replace("_", " ")


def form_text(
    answers: Mapping[str, str], points: Sequence[Mapping[str, Any]], others: Mapping[str, Any]
) -> str:
    """Return the machine file of the form, with the units beside the fields; empty if the form is blank.

    ``others`` and what a point holds beside its answers are what a TOML said that the form has no field for.

    Raises
    ------
    HerseyError
        If an answer cannot be read.
    """
    given = {key: BY_KEY[key].with_unit(text) for key, text in answers.items() if text.strip()}
    named = [
        {
            field: BY_KEY[f"points.{field}"].with_unit(value) if field in POINT_FIELDS else value
            for field, value in point.items()
            if field not in POINT_FIELDS or value.strip()
        }
        for point in points
    ]
    return machine_text(given, named, others) if given or named or others else ""


def kept_beside(points: Sequence[Mapping[str, Any]], others: Mapping[str, Any]) -> list[str]:
    """Return what the form keeps without a field for it, each table with the number of its values."""
    tables = [
        f"[{name}] {len(table)} value{'s' * (len(table) != 1)}" if isinstance(table, dict) else name
        for name, table in others.items()
    ]
    of_points = sorted({field for point in points for field in point if field not in POINT_FIELDS})
    return [*tables, *(f"{field} of points" for field in of_points)]


def file_faults(text: str, folder: Path, dropped: Mapping[str, Path]) -> list[Fault]:
    """Write the machine file and return the problems that `hersey.read_machine` reports.

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
        said = str(error)
        for beginning in (": ", " ", ", "):  # a line of it is one of the text that was typed
            said = said.removeprefix(f"{MACHINE_FILE}{beginning}")
        return [Fault("toml", "The machine cannot be read.", said, "the machine")]
    return []


def _place_named(text: str, folder: Path, dropped: Mapping[str, Path]) -> None:
    """Link the logs that the file names beside it; refuse any that was not dropped."""
    for section, named in _named(_document(text)).items():
        _lay(named, folder, dropped, f"[{section}] names the log")


def _document(text: str) -> dict[str, Any]:
    """The content of a file; empty if it is not TOML, which its reader reports."""
    try:
        return tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError, ValueError):
        return {}


def _named(document: Mapping[str, Any]) -> dict[str, str]:
    """The logs that a machine file or a mapping names, by table."""
    out = {}
    for section, key in (("rest", "log"), ("gear", "duty"), ("torque", "no_load")):
        table = document.get(section)
        named = table.get(key) if isinstance(table, dict) else None
        if isinstance(named, str) and not amount(named):
            out[section] = named
    return out


def _lay(named: str, folder: Path, dropped: Mapping[str, Path], what: str) -> None:
    if named not in dropped:
        alone = PureWindowsPath(named).name  # whose folders may be parted by either slash
        name_only = "" if alone == named else f"name it {alone} without its folder, and "
        raise HerseyError(f"{what} {named}: {name_only}drop that file here too")
    beside = folder / named
    if named in (MACHINE_FILE, MAPPING_FILE) or (beside.exists() and not beside.is_symlink()):
        raise HerseyError(f"{what} {named}, a name that is taken here: give the log another")
    if beside.is_symlink():
        if beside.readlink() == dropped[named]:
            return
        beside.unlink()  # of that name another file was dropped before
    beside.symlink_to(dropped[named])


def named_logs(text: str, others: Mapping[str, Any]) -> set[str]:
    """Return the logs that a machine file or a mapping names; they are not logs of the run."""
    return {*_named(_document(text)).values(), *_named(others).values()}


def mapping_faults(
    answers: Mapping[str, str], others: Mapping[str, Any], folder: Path, dropped: Mapping[str, Path]
) -> list[Fault]:
    """Write the mapping and return what its reader says of it, at the field it speaks of.

    ``others`` is what a mapping that was dropped said beside the answers, ``dropped`` the files that it may
    name, by name.
    """
    path = folder / MAPPING_FILE
    for key, text in answers.items():
        if text.strip() and (faults := _of_answer(f"field:{key}", key, text)):
            return faults
    try:
        for section, named in _named(others).items():
            _lay(named, folder, dropped, f"[{section}] names the log")
        write_atomically(path, mapping_of_form(answers, others), overwrite=True)
        read_mapping(path)
    except HerseyError as error:
        said = re.sub(rf"^{re.escape(MAPPING_FILE)}(, line \d+)?: ", "", str(error))
        key = error.setting.name if error.setting is not None else ""
        at = f"field:{key}" if key in BY_KEY else "corrections"
        return [Fault(at, "This cannot be read.", said, "corrections")]
    return []


def mapping_of_form(answers: Mapping[str, str], others: Mapping[str, Any]) -> str:
    """Return ``hersey.toml``: answers with units as they stand beside the fields, and what no question asks.

    Raises
    ------
    HerseyError
        If an answer cannot be read.
    """
    given = {key: BY_KEY[key].with_unit(text) for key, text in answers.items() if text.strip()}
    return mapping_text(given, title="Channels of the log, as chosen in hersey app.", others=others)


def mapping_said(path: Path) -> tuple[dict[str, str], dict[str, Any]] | None:
    """Return answers and all else of a mapping that was dropped, or None if it is none.

    Raises
    ------
    HerseyError
        In the words of its reader.
    """
    document = read_toml(path)
    if not set(document) & {*ROLES, *OTHER_ROLES}:
        return None
    plain = {
        section: {
            key: value for key, value in table.items() if (section, value) not in _named(document).items()
        }
        if isinstance(table, dict)
        else table
        for section, table in document.items()
    }
    answers, _, others = answers_of(plain)
    with TemporaryDirectory() as folder:
        anew = Path(folder) / "read.toml"
        try:  # as it is written anew, without the log that it names, which may be dropped later
            write_atomically(anew, mapping_text(answers, others=others), overwrite=True)
            read_mapping(anew)
        except HerseyError as error:
            raise type(error)(str(error).removeprefix("read.toml: ").removeprefix("read.toml ")) from None
    return answers_of(document)[::2]
