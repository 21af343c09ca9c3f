"""Every number that a command prints has its unit, in the short and in the long form."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from hersey.cli import terminal
from tests.bare_numbers import bare
from tests.cli.command import run
from tests.conftest import ROOT

LOG = ("bench.csv", "--tare", "standing")
WITH = ("machine.toml", *LOG)
COMMANDS = {
    "report": (*LOG, "--machine", "machine.toml"),
    "inspect": ("bench.csv",),
    "fit": LOG,
    "plan": (*WITH, "--target", "45 mm/s", "--at", "180 degC"),
    "map": WITH,
    "warmup": (*WITH, "--target", "120 mm/s", "--from", "20 degC"),
    "cycles": ("stick-slip.csv", "--drive-speed", "20 mm/s", "--identify"),
    "life": ("life.hersey", "--machine", "machine.toml"),
    "coastdown": ("coast-down.csv", "--inertia", "0.012 kg*m^2 ± 2 %"),
    "compare": ("bench.csv", *LOG),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a copy of the examples, with a campaign of the life test."""
    copied = tmp_path_factory.mktemp("units") / "examples"
    shutil.copytree(ROOT / "examples", copied)
    runs = ("life.hersey", "--table", "life/runs.csv", "--means", "--machine", "machine.toml")
    assert run("campaign", "add", *runs, cwd=copied).returncode == 0
    return copied


@pytest.mark.parametrize("detail", [(), ("--verbose",)], ids=["short", "long"])
@pytest.mark.parametrize("command", COMMANDS)
def test_numbers_have_units(
    command: str, detail: tuple[str, ...], folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(terminal, "WIDTH", 10_000)
    for page in folder.glob("*.html"):
        page.unlink()
    done = run(command, *COMMANDS[command], *detail, cwd=folder)
    assert done.returncode == 0, done.stderr
    assert len(done.stdout) > 100
    assert bare(done.stdout) == []


def test_a_missing_unit_is_found() -> None:
    assert bare("The belt slides above 75.") == ["The belt slides above 75."]
    assert bare("V* is 67 [60, 75] (95 %).") == ["V* is 67 [60, 75] (95 %)."]
    assert bare("speed  0.0189  [0.0165, 0.0218]") == ["speed  0.0189  [0.0165, 0.0218]"]
    assert bare("V* is 67 mm/s [60, 75] (95 %), 3 of 74 dwells, exponent -0.58.") == []
    assert bare("time (s)  drive (mm/s)\n     0.1            20\n") == []
