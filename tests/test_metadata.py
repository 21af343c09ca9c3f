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
