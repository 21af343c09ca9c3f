"""What a package index shows, and how to cite."""

from __future__ import annotations

import tomllib
from typing import Any

import pytest

from tests.conftest import ROOT

PROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
WORKSPACE = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]


def test_the_metadata_are_those_of_the_repository() -> None:
    assert PROJECT["license"] == WORKSPACE["license"] == "MIT"
    for name in (PROJECT["readme"], *PROJECT["license-files"]):
        assert (ROOT / name).is_file()
    licence = (ROOT / "LICENSE").read_text()
    (author,) = PROJECT["authors"]
    assert licence.startswith("MIT License")
    assert author["name"] in licence
    assert PROJECT["dynamic"] == ["version"]
    assert PROJECT["keywords"] == sorted(PROJECT["keywords"], key=str.lower)
    assert PROJECT["classifiers"] == sorted(PROJECT["classifiers"])
    assert not any(each.startswith("License ::") for each in PROJECT["classifiers"])  # `license` says it


def test_one_wheel_serves_every_python() -> None:
    features = tomllib.loads((ROOT / "crates/py/Cargo.toml").read_text())["dependencies"]["pyo3"]["features"]
    lowest = PROJECT["requires-python"].removeprefix(">=").replace(".", "")
    assert f"abi3-py{lowest}" in features


def test_the_citation_says_what_the_metadata_say() -> None:
    yaml = pytest.importorskip("yaml")
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert {"cff-version", "message", "title", "authors"} <= citation.keys()  # which the format asks for
    assert citation["title"] == PROJECT["name"]
    assert citation["version"] == WORKSPACE["version"]  # which pyproject.toml takes, too
    assert citation["license"] == PROJECT["license"]
    assert citation["keywords"] == PROJECT["keywords"]
    assert citation["authors"] == PROJECT["authors"]


def test_the_conda_recipe_asks_for_what_the_metadata_ask_for() -> None:
    yaml = pytest.importorskip("yaml")
    recipe = yaml.safe_load((ROOT / "packaging" / "conda" / "recipe.yaml").read_text())
    assert recipe["context"]["version"] == WORKSPACE["version"]
    python, *needed = recipe["requirements"]["run"]
    assert python == f"python {PROJECT['requires-python']}"
    assert [each.replace(" ", "") for each in needed] == PROJECT["dependencies"]


def test_the_release_workflow_builds_with_the_makefile_and_uploads_to_no_index() -> None:
    yaml = pytest.importorskip("yaml")
    text = (ROOT / ".github" / "workflows" / "release.yml").read_text()
    jobs = yaml.safe_load(text)["jobs"]
    steps = [step.get("run", "") for job in jobs.values() for step in job["steps"]]
    assert any(step.startswith("make wheel ") for step in steps)
    assert jobs["draft"]["needs"] == ["test", "wheel"]
    assert not any("publish" in step or "twine" in step for step in steps)
