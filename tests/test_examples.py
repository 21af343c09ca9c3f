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
from tests.conftest import ROOT, SHARED, mostly_nightly
from tests.life import shipped

EXAMPLES = sorted((ROOT / "examples").glob("[0-9]*.py"))


@pytest.mark.parametrize(
    "script",
    # what `08_paper_figures` does is called and looked at in tests/paper
    mostly_nightly(EXAMPLES, *(each for each in EXAMPLES if each.stem != "08_paper_figures")),
    ids=lambda p: p.stem,
)
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


def typed(line: str, folder: Path) -> None:
    """Type a line of a README in a folder; what goes behind ``>`` is the file for its output."""
    words, _, output = line.partition(" > ")
    done = run(*shlex.split(words, comments=True)[1:], cwd=folder)
    assert done.returncode == 0, f"{line}: {done.stderr}"
    if output:
        (folder / output).write_text(done.stdout)


@pytest.mark.usefixtures("few_draws", "few_laws")
def test_readme_commands(tmp_path: Path, nightly: bool) -> None:
    """As they are typed, one after the other, in an empty folder; at night with all runs of the life test."""
    first, *lines = [line for line in commands() if line not in OWN]
    assert first.startswith("hersey examples examples ")
    typed(first, tmp_path)
    runs = tmp_path / "examples" / "life" / "runs.csv"
    if not nightly:
        runs.write_text("".join(runs.read_text().splitlines(keepends=True)[:4]))
    assert len(lines) >= 15
    helped = {example(verb) for verb in VERBS}  # which tests/cli/test_cli.py types
    with shipped.few():
        for line in lines:
            if line not in helped:
                typed(line + " --draws 100" * line.startswith("hersey posterior"), tmp_path)


#: Commands of the README for the reader's own files: those of the line, made here of the example's.
OWN = {
    'hersey report bench.csv --torque "Tq (ozf.in)" --speed-unit rpm': ["bench.csv"],
}


@pytest.mark.usefixtures("few_draws", "few_laws")
@pytest.mark.parametrize("line", OWN)
def test_readme_commands_of_the_reader(line: str, tmp_path: Path) -> None:
    text = (ROOT / "examples" / "bench.csv").read_text()
    if "Tq" in line:
        text = text.replace("Drive torque [N*m]", "Tq (ozf.in)").replace("Drive speed [rpm]", "Drive speed")
    for name in OWN[line]:
        (tmp_path / name).write_text(text)
    typed(line, tmp_path)
    assert (tmp_path / "report.html").is_file()


def test_readme_has_no_other_command() -> None:
    """A command in a sentence names a verb, and stands for the reader's files in capitals."""
    inline = re.findall(r"`(hersey [^`]*)`", (ROOT / "README.md").read_text())
    assert OWN.keys() <= {*inline, *commands()}
    words = r"(LOG|TRACE|COMMAND|FOLDER|TERM|fmu|--help|--identify|--machine machine.toml)"
    assert all(line in OWN or re.fullmatch(rf"hersey [a-zA-Z]+( {words})*", line) for line in inline)


def commands() -> list[str]:
    return [line for block in blocks("sh") for line in block.splitlines() if line.startswith("hersey")]


def test_readme_names_only_targets_that_exist() -> None:
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    text = "".join((ROOT / name).read_text() for name in ("README.md", "CONTRIBUTING.md"))
    assert set(re.findall(r"make ([a-z-]+)", text)) <= targets
