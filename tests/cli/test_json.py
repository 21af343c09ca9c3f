"""What each command prints with --json: its part of the document, by its schema, and whole when read back."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Sequence
from dataclasses import is_dataclass
from pathlib import Path
from typing import Any, get_args

import jsonschema
import pytest

import hersey
import hersey.study
from hersey.cli.application import VERBS, load
from hersey.document.analysis import Analysis
from hersey.document.printed import PRINTED
from hersey.document.saved_fit import read_fit
from hersey.schema.part import SCHEMA_VERSION, Part
from hersey.schema.record import part_of
from tests.cli.command import run
from tests.conftest import ROOT
from tests.life import shipped

EXAMPLES = ROOT / "examples"
BENCH = str(EXAMPLES / "bench.csv")
MACHINE = str(ROOT / "tests" / "stand" / "machine.toml")  # without a no-load torque
TRACE = str(EXAMPLES / "stick-slip.csv")
TARE = ["--tare", "standing"]
#: Arguments that make each command print its part, all of it and quickly.
ARGUMENTS: dict[str, list[str]] = {
    "explain": [],
    "inspect": [BENCH],
    "report": [BENCH, *TARE, "--machine", MACHINE],
    "fit": [BENCH, *TARE],
    "models": [BENCH, *TARE, "--bootstrap", "0", "--isothermal"],
    "design": [BENCH, *TARE, "--count", "1"],
    "coastdown": [str(EXAMPLES / "coast-down.csv"), "--inertia", "0.012 kg*m^2"],
    "compare": [BENCH, BENCH, *TARE],
    "trend": [BENCH, "--at", "60 rpm"],
    "campaign": ["check", "CAMPAIGN"],
    "life": ["LIFE", "--machine", MACHINE],
    "weibull": [str(EXAMPLES / "failures.csv"), "--age", "200 h"],
    "cycles": [TRACE, "--drive-speed", "20 mm/s", "--identify", "--closures", "retained"],
    "film": [MACHINE, "--log", BENCH, *TARE],
    "simulate": ["--check"],
    "sweep": ["SCENARIO"],
    "hysteresis": ["--drive-speed", "1.2", "--from-speed", "2.5", "--to-speed", "1.2"],
    "map": [MACHINE, "--fit", "FIT"],
    "export": ["fmu", "FIT", MACHINE, "--temperature", "150 degC", "--out", "UNIT", "--check"],
    "posterior": [BENCH, *TARE, "--machine", MACHINE, "--draws", "200"],
    "plan": ["STRONG", "--fit", "FIT", "--target", "60 mm/s", "--at", "150 degC", "--confidence", "0.5"],
    "warmup": [MACHINE, "--fit", "FIT", "--target", "60 mm/s", "--from", "20 degC"],
}
#: Names of fields that the header of every print has.
HEADER = {"schema_version", "hersey_version", "command"}
SCENARIO = """
[parameters]
stiffness = [500, 1000]
mass = 1
transition_force = 50
transition_speed = 1
ehl_exponent = -0.7
mixed_exponent = -1.2
stick_speed = 0.01
drive_speed = {from = 0.5, to = 3.0, count = 3}
[options]
units = "consistent"
"""


def printed(arguments: Sequence[str]) -> Any:
    done = run(*arguments, "--json", cwd=ROOT)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """A finished fit and a scenario."""
    folder = tmp_path_factory.mktemp("json")
    (folder / "scenario.toml").write_text(SCENARIO)
    (folder / "fit.json").write_text(json.dumps(printed(["fit", BENCH, *TARE])))
    strong = re.sub('nip_load = "[0-9.]+', 'nip_load = "1000', (ROOT / MACHINE).read_text())
    (folder / "strong.toml").write_text(strong)
    with hersey.Campaign.create(folder / "life.hersey") as campaign:
        points = hersey.read(BENCH).steady(tare="standing")
        campaign.add(points, log=BENCH, unit="F12", age="120000 pages")
    own = {
        "CAMPAIGN": str(folder / "life.hersey"),
        "LIFE": str(shipped.write(folder / "units.hersey")),
        "UNIT": str(folder / "drive.fmu"),
        "STRONG": str(folder / "strong.toml"),
    }
    return own | {"FIT": str(folder / "fit.json"), "SCENARIO": str(folder / "scenario.toml")}


@pytest.mark.parametrize("name", PRINTED)
def test_a_command_prints_its_part(
    name: str,
    files: dict[str, str],
    document: Analysis,
    monkeypatch: pytest.MonkeyPatch,
    request: pytest.FixtureRequest,
) -> None:
    """The whole document is one that is made once for all tests; `test_cli` has the command make its own."""
    if name != "design":  # which asks for one law of all
        request.getfixturevalue("few_laws")
    monkeypatch.setattr(sys.modules["hersey.study"], "study", lambda *_, **__: None)
    monkeypatch.setattr("hersey.document.assembly.document_of", lambda *_, **__: document)
    with shipped.few():
        told = printed([name, *(files.get(argument, argument) for argument in ARGUMENTS[name])])
    assert told["schema_version"] == SCHEMA_VERSION
    assert told["hersey_version"] == hersey.__version__
    assert told["command"].startswith("hersey")
    part = part_of(PRINTED[name])
    if part is not Analysis:
        told = {key: value for key, value in told.items() if key not in HEADER}
    jsonschema.validate(told, part.model_json_schema())
    again = part.model_validate(told)
    assert json.loads(again.model_dump_json()) == told
    with pytest.raises(ValueError, match="unheard_of"):
        part.model_validate({**told, "unheard_of": 1})


def parameters(name: str) -> list[Any]:
    """Parameters of a verb, and of the verbs that it has."""
    verb = load(name)
    return [p for each in (verb, *getattr(verb, "commands", {}).values()) for p in each.params]


def test_every_command_with_json_has_a_part() -> None:
    with_json = {name for name in VERBS if any(p.name == "as_json" for p in parameters(name))}
    assert with_json == set(PRINTED) == set(ARGUMENTS)


def test_a_printed_fit_is_read_back(files: dict[str, str]) -> None:
    surface = hersey.fit(hersey.read(BENCH).steady(tare="standing"))
    again = read_fit(files["FIT"])
    assert again.to_dict() == surface.to_dict()


def test_what_a_fit_prints_stands_in_the_document() -> None:
    assert set(part_of(PRINTED["fit"]).model_fields) <= set(Analysis.model_fields)


def test_every_part_says_what_it_is() -> None:
    seen: set[type[Part]] = set()

    def look(part: type[Part]) -> None:
        if part in seen:
            return
        seen.add(part)
        assert (part.__doc__ or "").split("\n\n")[0].endswith("."), part
        for field in part.model_fields.values():
            for kind in parts_in(field.annotation):
                look(kind)

    look(Analysis)
    assert len(seen) > 50


def parts_in(annotation: Any) -> list[type[Part]]:
    if isinstance(annotation, type) and (is_dataclass(annotation) or issubclass(annotation, Part)):
        return [part_of(annotation)]
    return [part for inner in get_args(annotation) for part in parts_in(inner)]


def test_fit_builds_no_simulation(files: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    from hersey.study import simulation

    def refuse(*_: object, **__: object) -> None:
        raise AssertionError("a fit needs no simulation")

    monkeypatch.setattr(simulation, "stick_slip", refuse)
    monkeypatch.setattr(simulation, "simulate", refuse)
    assert Path(files["FIT"]).exists()
    told = printed(["fit", BENCH, *TARE])
    assert set(told) == HEADER | {"warnings", "files", "points", "fit", "regime", "friction", "moving"}
    assert told["moving"] is None


def test_a_simulation_with_heat_prints_its_temperatures(files: dict[str, str]) -> None:
    of_a_fit = ["--machine", MACHINE, "--fit", files["FIT"], "--heat", "--from", "20 degC"]
    document = printed(["simulate", *of_a_fit, "--drive-speed", "30 mm/s", "--duration", "5 s"])
    part = PRINTED["simulate"]
    document = {key: value for key, value in document.items() if key not in HEADER}
    assert json.loads(part.model_validate(document).model_dump_json()) == document
    film = document["warming"]["film_temperature"]
    assert film[0] == pytest.approx(293.15)
    assert film == sorted(film)
    assert abs(document["energy"]["residual"]) < 1e-8
