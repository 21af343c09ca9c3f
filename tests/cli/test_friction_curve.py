"""Friction of a joint through the commands: named where it describes the dwells, with its parameters."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.command import run
from tests.guide import table_of


@pytest.fixture
def joint(tmp_path: Path) -> Path:
    """The table of the how-to page: T_C 0.42 and 0.35, T_S 0.6 and 0.52 N m."""
    path = tmp_path / "staircase.csv"
    path.write_text(table_of("joint-friction"))
    return path


def test_fit_names_the_law_and_its_parameters(joint: Path) -> None:
    result = run("fit", joint, "--isothermal", cwd=joint.parent)
    assert result.returncode == 0, result.stderr
    assert "Stribeck friction, each direction with its own parameters. Torque is lowest at" in result.words
    assert "T_C forward 418 mN·m [413, 423]" in result.words
    assert "power law" not in result.words


def test_json_holds_the_curve(joint: Path) -> None:
    friction = json.loads(run("fit", joint, "--isothermal", "--json", cwd=joint.parent).stdout)["friction"]
    assert (friction["kind"], friction["apart"]) == ("stribeck", True)
    assert [(each["name"], each["unit"]) for each in friction["parameters"][:4]] == [
        ("T_C", "N m"),
        ("T_S", "N m"),
        ("w_S", "rad/s"),
        ("k_v", "N m s/rad"),
    ]
    assert len(friction["lines"]) == 2
