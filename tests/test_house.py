"""Rules of the house: layers, errors, docs, and nothing about machines or registries in the repository."""

from __future__ import annotations

import ast
import inspect
import pickle
import re
import subprocess
from pathlib import Path

import pytest
import typer

import hersey
from hersey import errors
from hersey.cli import app
from tests.conftest import ROOT

PACKAGE = ROOT / "python" / "hersey"
#: Modules in the order of the computation: each may import only from those before it (and its own folder).
LAYERS = [
    ("_core", "errors", "json_value"),
    ("text_file", "units"),
    ("toml_file",),
    ("log", "toml_value"),
    ("axes", "columns", "drag", "reynolds", "schedule", "spread", "steady"),
    ("corrections", "course_file", "lubricant", "motion", "paper"),
    ("contact",),
    ("film", "film_tables"),
    ("ensemble", "estimation", "fuser", "log_mapping", "testbench"),
    ("hysteresis", "law", "scenario"),
    ("approach", "branches", "plan"),
    ("ladder", "surface"),
    ("compare", "design", "film_evidence", "operating_map", "regime"),
    ("document", "film_lint"),
    ("film_part",),
    ("analysis",),
    ("charts", "film_document", "fit_file"),
    ("film_chart", "map_chart", "plan_chart", "report", "trace"),
    ("figures", "inspection"),
    ("cli",),
]


def layer(module: str) -> int:
    return next(i for i, names in enumerate(LAYERS) if module in names)


def imported(path: Path) -> set[str]:
    """Modules of the package that a file imports when it is loaded (not for type checkers alone)."""
    tree = ast.parse(path.read_text())
    found: set[str] = set()
    for node in tree.body:
        if isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] == "hersey":
            parts = node.module.split(".")
            found |= {parts[1]} if len(parts) > 1 else {alias.name for alias in node.names}
    return found - {"__version__"}


def test_nothing_flows_backwards() -> None:
    for path in PACKAGE.rglob("*.py"):
        module = path.relative_to(PACKAGE).parts[0].removesuffix(".py")
        if module == "__init__":
            continue
        for other in imported(path) - {module}:
            assert layer(other) < layer(module), f"{path.name} imports {other}"


def test_core_layers() -> None:
    sources = ROOT / "crates" / "core" / "src"
    for path in (sources / "drag").glob("*.rs"):
        assert "crate::motion" not in path.read_text()
    for path in (sources / "lubrication").glob("*.rs"):
        for above in ("drag", "motion", "stability"):
            assert f"crate::{above}" not in path.read_text()
    for path in [*(sources / "drag").glob("*.rs"), *(sources / "motion").glob("*.rs")]:
        assert "crate::stability" not in path.read_text()
    for path in sources.rglob("*.rs"):
        text = path.read_text()
        for forbidden in ("println!", "std::fs", "std::thread", "static mut", "pyo3"):
            assert forbidden not in text, f"{path.name}: {forbidden}"


def test_every_error_is_a_built_in_and_survives_pickling() -> None:
    kinds = [k for k in vars(errors).values() if isinstance(k, type) and issubclass(k, errors.HerseyError)]
    assert len(kinds) > 5
    for kind in kinds:
        error = kind("what", "way out")
        assert str(error) == "what way out"
        again = pickle.loads(pickle.dumps(error))
        assert (type(again), str(again)) == (kind, str(error))
        assert kind is errors.HerseyError or len(kind.__mro__) > len(errors.HerseyError.__mro__)


def test_public_functions_are_documented() -> None:
    for name in hersey.__all__:
        thing = getattr(hersey, name)
        if callable(thing):
            assert inspect.getdoc(thing), name


@pytest.mark.parametrize(
    "module",
    [
        "hersey.approach",
        "hersey.contact",
        "hersey.drag",
        "hersey.ensemble",
        "hersey.film",
        "hersey.hysteresis",
        "hersey.inspection.inspecting",
        "hersey.ladder.collapse",
        "hersey.ladder.comparison",
        "hersey.log",
        "hersey.log_mapping",
        "hersey.motion",
        "hersey.operating_map",
        "hersey.paper",
        "hersey.plan.planner",
        "hersey.schedule",
        "hersey.spread",
        "hersey.testbench",
        "hersey.trace.record",
    ],
)
def test_examples_in_docstrings(module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    import doctest
    import importlib

    monkeypatch.chdir(ROOT)
    result = doctest.testmod(importlib.import_module(module))
    assert result.attempted > 0
    assert result.failed == 0


def test_every_flag_is_in_the_docs() -> None:
    text = (ROOT / "docs" / "commands.md").read_text()
    for name, command in typer.main.get_command(app).commands.items():  # type: ignore[attr-defined]
        assert f"## hersey {name}" in text
        for parameter in command.params:
            for flag in parameter.opts:
                if flag.startswith("--"):
                    assert f"`{flag}`" in text, f"{name} {flag}"


def tracked() -> list[Path]:
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [ROOT / line for line in listed.stdout.splitlines() if (ROOT / line).is_file()]


def test_the_repository_names_no_machine_and_no_registry() -> None:
    hosts = [
        "crates" + ".io",
        "pypi" + ".org",
        "npmjs" + ".org",
        "pythonhosted" + ".org",
        "/ro" + "ot/",
        "/wo" + "rk/",
    ]
    for path in tracked():
        if path.suffix in {".csv", ".png"}:
            continue
        text = path.read_text(encoding="utf-8")
        for host in hosts:
            assert host not in text, f"{path.name} names {host}"


def test_files_have_one_subject() -> None:
    for path in tracked():
        if path.suffix in {".py", ".rs", ".js"}:
            assert len(path.read_text().splitlines()) <= 720, f"{path.name} is long: split it"
            assert not re.fullmatch(r"(utils?|helpers?|misc|common)", path.stem)
