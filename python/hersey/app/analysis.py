"""One analysis: its files, its choices and its progress."""

from __future__ import annotations

import asyncio
import re
import secrets
import shlex
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from hersey.app.channels import Fault
from hersey.app.course import Course
from hersey.app.machine import answer_faults, form_text, mapping_of_form, mapping_said, named_logs
from hersey.app.recipe import options_of_recipe
from hersey.errors import HerseyError
from hersey.files.text import read_text
from hersey.log.channels import called
from hersey.log.roles import OTHER_ROLES, ROLES
from hersey.log.text.column import Column
from hersey.machine.questions import BY_KEY, MAPPING
from hersey.machine.writing import answers_of

#: Most operating points of a machine.
_MOST_POINTS = 50
#: ``against`` is the file that the other of two logs is compared with; empty if both are runs of one machine.
_OPTIONS: dict[str, Any] = {"isothermal": False, "drop_missing": False, "tare": "none", "against": ""}
#: Corrections between sensor and roll, besides channels and units.
CORRECTIONS = tuple(q.key for q in MAPPING if not q.first)


def number() -> str:
    """Return a random name that cannot be guessed."""
    return secrets.token_urlsafe(12)


@dataclass
class Dropped:
    """A file as it came: ``state`` is arriving, looking, ready or fault, or mapping where it is one."""

    name: str
    path: Path
    size: int = 0
    total: int = 0  #: bytes that will come, 0 where the page does not say
    received: int = 0
    state: str = "arriving"
    fault: str = ""
    look: dict[str, Any] = field(default_factory=dict)
    id: str = field(default_factory=number)

    @property
    def names(self) -> set[str]:
        """Return the names of its channels."""
        return {channel["name"] for channel in self.look["channels"]}

    def channel(self, name: str) -> str:
        """Return the channel that a mapping means by a name, or nothing."""
        columns = tuple(Column(i, c["name"], c["written"]) for i, c in enumerate(self.look["channels"]))
        meant = called(name, columns)
        return str(meant[0].name) if meant else ""


@dataclass
class Analysis:
    """Files, choices and machine; ``state`` is editing, preparing, running, done or stopped."""

    folder: Path
    id: str = field(default_factory=number)
    files: dict[str, Dropped] = field(default_factory=dict)
    choices: dict[str, dict[str, str]] = field(default_factory=dict)
    corrections: dict[str, str] = field(default_factory=dict)
    options: dict[str, Any] = field(default_factory=lambda: dict(_OPTIONS))
    kept: set[str] = field(default_factory=set)
    mode: str = "form"
    answers: dict[str, str] = field(default_factory=dict)
    points: list[dict[str, Any]] = field(default_factory=list)
    machine_others: dict[str, Any] = field(default_factory=dict)  #: of a TOML, what the form has no field for
    mapped: dict[str, str] = field(
        default_factory=dict
    )  #: channel of each role by a mapping that was dropped
    mapped_units: dict[str, str] = field(default_factory=dict)
    mapping_others: dict[str, Any] = field(default_factory=dict)  #: what else it says
    text: str = ""
    state: str = "editing"
    step: str = ""
    share: float | None = None
    course: Course | None = None
    result: dict[str, Any] = field(default_factory=dict)
    reason: str = ""
    report: str = ""
    saved: str = ""
    finished: str = ""
    revision: int = 0
    faults: list[Fault] = field(default_factory=list)
    lock: asyncio.Lock = field(default_factory=asyncio.Lock)

    @property
    def name(self) -> str:
        """Return its name in the list."""
        return ", ".join(f.name for f in self.files.values() if f.state != "mapping") or "new analysis"

    @property
    def logs(self) -> list[Dropped]:
        """Return the files that can be read, without those that the machine file names."""
        beside = self.beside
        return [f for f in self.files.values() if f.state == "ready" and f.name not in beside]

    @property
    def earlier(self) -> Dropped | None:
        """Return the log that the other of two is compared with, if one was chosen."""
        logs = self.logs
        return next((f for f in logs if len(logs) == 2 and f.id == self.options["against"]), None)

    @property
    def told_of(self) -> list[Dropped]:
        """Return the logs that the report is about."""
        return [file for file in self.logs if file is not self.earlier]

    @property
    def beside(self) -> set[str]:
        """Return the names of logs in the machine file or the mapping."""
        return named_logs(self.machine_file(), self.mapping_others)

    @property
    def busy(self) -> bool:
        """Whether it is preparing or running."""
        return self.state in ("preparing", "running")

    def machine_file(self) -> str:
        """Return the current machine file; empty where the form cannot be written."""
        if self.mode == "toml":
            return self.text
        try:
            return form_text(self.answers, self.points, self.machine_others)
        except HerseyError:
            return ""

    def mapping_answers(self) -> dict[str, str]:
        """Return the answers that make the mapping."""
        out: dict[str, str] = {}
        for name, choice in self.choices.items():
            role = choice["role"]
            if role in ROLES and not (role == "temperature" and self.options["isothermal"]):
                out |= {f"{role}.channel": name, f"{role}.unit": choice["unit"]}
        every = self.corrections.get("time.every", "").strip()
        if every:
            out = {key: text for key, text in out.items() if not key.startswith("time.")}
        return out | {key: text for key, text in self.corrections.items() if text.strip()}

    def mapping_file(self) -> str:
        """Return the current ``hersey.toml``."""
        return mapping_of_form(self.mapping_answers(), self.mapping_tables())

    def mapping_tables(self) -> dict[str, Any]:
        """Return what has no question: channels of other roles, and the rest of a dropped mapping."""
        out = {section: dict(table) for section, table in self.mapping_others.items()}
        for name, choice in self.choices.items():
            if choice["role"] in OTHER_ROLES:
                unit = {"unit": choice["unit"]} if choice["unit"] and choice["role"] != "run" else {}
                out[choice["role"]] = {**out.get(choice["role"], {}), "channel": name, **unit}
        return out

    def command(self) -> str:
        """Return the command that gives the same report from the files and what can be saved here."""
        earlier = self.earlier
        parts = ["hersey", "report", *(file.name for file in self.told_of), "--mapping", "hersey.toml"]
        parts += ["--against", earlier.name] if earlier is not None else []
        parts += ["--machine", "machine.toml"] if self.machine_file() else []
        parts += ["--isothermal"] if self.options["isothermal"] else []
        parts += ["--drop-missing"] if self.options["drop_missing"] else []
        parts += ["--tare", self.options["tare"]] if self.options["tare"] != "none" else []
        return shlex.join(parts)

    def propose(self, file: Dropped) -> None:
        """Take layout, roles and units of a file's channels as proposed, where nothing was chosen yet."""
        if layout := file.look.get("layout"):
            self.mapping_others.setdefault("layout", layout)
        claimed = {name: role for role, names in file.look["claims"].items() for name in names}
        for channel in file.look["channels"]:
            role = channel["role"] or claimed.get(channel["name"], "")
            self.choices.setdefault(channel["name"], {"role": role, "unit": channel["unit"]})
        self._as_mapped(file)

    def _as_mapped(self, file: Dropped) -> None:
        """Give the channels of a file the roles and units that the mapping states."""
        for role in (*ROLES, *OTHER_ROLES):
            stated = self.mapped.get(role, "")
            name = file.channel(stated) if stated else ""
            if name:
                for choice in self.choices.values():
                    choice["role"] = "" if choice["role"] == role else choice["role"]
                self.choices[name]["role"] = role
            unit = self.mapped_units.get(role, "")
            if unit and (name or not stated):
                for choice in self.choices.values():
                    choice["unit"] = unit if choice["role"] == role else choice["unit"]

    def choose(self, given: Mapping[str, Any]) -> None:
        """Take what the page changes: ``roles``, ``units`` by channel, ``options``, ``corrections``.

        Raises
        ------
        ValueError
            If it is nothing that can be chosen.
        """
        for name, role in _texts(given.get("roles", {})).items():
            if name not in self.choices or role not in ("", *ROLES, *OTHER_ROLES):
                raise ValueError(role)
            self.choices[name]["role"] = role
            if role in ROLES:
                self.options |= {"isothermal": False} if role == "temperature" else {}
            self.mapped.pop(role, None)
        for name, unit in _texts(given.get("units", {})).items():
            if name not in self.choices:
                raise ValueError(name)
            self.choices[name]["unit"] = unit[:100]
        for key, value in dict(given.get("options", {})).items():
            if (
                (key == "tare" and value in ("none", "standing"))
                or (key in ("isothermal", "drop_missing") and isinstance(value, bool))
                or (key == "against" and (value == "" or value in self.files))
            ):
                self.options[key] = value
            else:
                raise ValueError(key)
        for key, text in _texts(given.get("corrections", {})).items():
            if key not in CORRECTIONS:
                raise ValueError(key)
            self.corrections[key] = text[:200]
        if "remove" in given:
            self.remove(str(given["remove"]))

    def take_machine(self, given: Mapping[str, Any]) -> None:
        """Take what the page changes of the machine: its ``text``, or ``answers`` of the form by key.

        Answers are those of the operating point of that number where ``point`` is given; ``add`` adds one,
        ``remove`` takes one away.

        Raises
        ------
        ValueError
            If it is none of these.
        """
        if "text" in given:
            self.mode, self.text = "toml", str(given["text"])[:1_000_000]
            return
        if given.get("add") and len(self.points) < _MOST_POINTS:
            self.points.append({})
        if "remove" in given:
            del self.points[_whole(given["remove"], len(self.points))]
        answers = {key: text[:1000] for key, text in _texts(given.get("answers", {})).items()}
        if any(key not in BY_KEY for key in answers):
            raise ValueError("answers")
        if "point" in given:
            point = self.points[_whole(given["point"], len(self.points))]
            point |= {BY_KEY[key].field: text for key, text in answers.items()}
        else:
            self.answers |= answers
        self.mode = "form"

    def turn(self, mode: str) -> str:
        """Show the machine as a form or as TOML; return why that is not possible, or nothing."""
        if mode == "toml" and self.mode == "form":
            if faults := answer_faults(self.answers, self.points):
                return f"fix first: {', '.join(fault.link for fault in faults)}"
            self.text = form_text(self.answers, self.points, self.machine_others)
        if mode == "form" and self.mode == "toml" and self.text.strip():
            if any(fault.at == "toml" for fault in self.faults):
                return "fix the TOML first"
            import tomllib

            document = tomllib.loads(self.text)
            answers, points, others = answers_of(document)
            if (
                answer_faults(answers, points)
                or tomllib.loads(form_text(answers, points, others)) != document
            ):
                return "the form has no fields for part of this TOML: edit it as TOML"
            self.answers, self.points, self.machine_others = answers, points, others
        elif mode == "form" and self.mode == "toml":
            self.answers, self.points, self.machine_others = {}, [], {}
        self.mode = mode
        return ""

    def take_file(self, file: Dropped) -> bool:
        """Take a dropped TOML file as the machine, a recipe or the mapping; return whether it is one.

        Raises
        ------
        HerseyError
            If it is a mapping or a recipe with a mistake, in the words of its reader.
        """
        text = read_text(file.path, most=1_000_000)
        if re.search(r"^\s*\[\s*drivetrain\s*\]", text, re.M):
            self.mode, self.text = "toml", text
            del self.files[file.id]
            file.path.unlink()
            return True
        mappings = [other for other in self.files.values() if other.state == "mapping"]
        options = options_of_recipe(file.path, mapped=bool(mappings))
        if options is not None:
            self.options |= options
            del self.files[file.id]
            file.path.unlink()
            return True
        said = mapping_said(file.path)
        if said is None:
            return False
        for older in mappings:
            self.remove(older.id)
        file.state = "mapping"
        answers, self.mapping_others = said
        self._take_mapping(answers)
        return True

    def _take_mapping(self, answers: Mapping[str, str]) -> None:
        stated: dict[str, dict[str, str]] = {"channel": {}, "unit": {}}
        for role in (*ROLES, *OTHER_ROLES):
            of_other = self.mapping_others.get(role, {})
            for key, taken in stated.items():
                text = answers.get(f"{role}.{key}", "") or of_other.get(key, "")
                if text:
                    taken[role] = text
                of_other.pop(key, None)
            if not of_other:
                self.mapping_others.pop(role, None)
        self.mapped, self.mapped_units = stated["channel"], stated["unit"]
        self.corrections = {key: answers[key] for key in CORRECTIONS if key in answers}
        for log in self.logs:
            self._as_mapped(log)

    def remove(self, file: str) -> None:
        """Remove a file."""
        gone = self.files.pop(file)
        gone.path.unlink(missing_ok=True)
        if gone.state == "mapping":
            self.mapped, self.mapped_units, self.mapping_others, self.corrections = {}, {}, {}, {}
        if not self.files:
            self.choices, self.corrections, self.options = {}, {}, dict(_OPTIONS)
            self.mapping_others.pop("layout", None)
        elif gone.look:
            still = {name for f in self.files.values() if f.look for name in f.names}
            self.choices = {name: choice for name, choice in self.choices.items() if name in still}

    @property
    def waiting(self) -> bool:
        """Whether a file is still being copied or read."""
        return any(file.state in ("arriving", "looking") for file in self.files.values())


def _whole(given: Any, below: int) -> int:
    if not isinstance(given, int) or not 0 <= given < below:
        raise ValueError(given)
    return given


def _texts(given: Any) -> dict[str, str]:
    if not isinstance(given, dict) or not all(isinstance(value, str) for value in given.values()):
        raise ValueError("texts by name are needed")
    return {str(key): value for key, value in given.items()}
