"""The examples run, and so do the README's commands and code."""

from __future__ import annotations

import re
import runpy
import shlex
import sys
from pathlib import Path

import pytest

from hersey.cli.application import VERBS
from tests.cli.command import run
from tests.cli.test_cli import example
from tests.conftest import ROOT, SHARED

EXAMPLES = sorted((ROOT / "examples").glob("[0-9]*.py"))


@pytest.mark.parametrize("script", EXAMPLES, ids=lambda p: p.stem)
def test_example(
    script: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    if '"shared"' in script.read_text() and not SHARED.exists():
        pytest.skip("the shared folder with its logs is not beside the repository")
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(sys, "argv", [str(script), str(tmp_path)])
    runpy.run_path(str(script), run_name="__main__")
    assert capsys.readouterr().out
    assert list(tmp_path.glob("*.png"))


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)


def without_output(line: str) -> str:
    return re.sub(r" --out \S+", "", line)


def test_readme_commands(tmp_path: Path) -> None:
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    lines = [line for block in blocks("sh") for line in block.splitlines() if line.startswith("hersey")]
    lines = [line for line in lines if "bench.csv --torque" not in line]  # the reader's own file
    assert len(lines) >= 4
    # those that stand in the help too, but for the name of an output, are typed by tests/cli/test_cli.py
    helped = {without_output(example(verb)) for verb in VERBS}
    for line in (line for line in lines if without_output(line) not in helped):
        done = run(*shlex.split(line)[1:], cwd=tmp_path)
        assert done.returncode == 0, f"{line}: {done.stderr}"


def test_readme_code(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    (code,) = blocks("python")
    exec(compile(code, "README.md", "exec"), {})


def test_readme_names_only_targets_that_exist() -> None:
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    text = "".join((ROOT / name).read_text() for name in ("README.md", "CONTRIBUTING.md"))
    assert set(re.findall(r"make ([a-z-]+)", text)) <= targets
