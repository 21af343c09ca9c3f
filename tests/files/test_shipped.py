"""The examples that come with the package, copied into a new folder."""

from __future__ import annotations

from pathlib import Path

import pytest

from hersey.errors import ExistingFileError, OutputError
from hersey.files import shipped
from hersey.files.shipped import copy_examples
from tests.cli.command import run
from tests.conftest import ROOT

EXAMPLES = ROOT / "examples"


def names(folder: Path) -> set[str]:
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def test_the_copies_are_the_examples(tmp_path: Path) -> None:
    folder = tmp_path / "copied"
    written = copy_examples(folder)
    assert {path.relative_to(folder).as_posix() for path in written} == names(folder)
    assert {"bench.csv", "machine.toml", "no-load.csv", "stick-slip.csv", "scenario.toml"} <= names(folder)
    assert {"life/runs.csv", "life/U1-0.csv"} <= names(folder)
    for path in written:
        assert path.read_bytes() == (EXAMPLES / path.relative_to(folder)).read_bytes()


def test_those_of_the_package_come_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An installed package has its own, and a folder `examples` that happens to be near is not taken."""
    module = tmp_path / "python" / "hersey" / "files" / "shipped.py"
    for home, text in ((module.with_name("examples"), "own"), (tmp_path / "examples", "near")):
        home.mkdir(parents=True)
        (home / "bench.csv").write_text(text)
    monkeypatch.setattr(shipped, "__file__", str(module))
    (copied,) = copy_examples(tmp_path / "copied")
    assert copied.read_text() == "own"


def test_an_installation_without_examples_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shipped, "__file__", str(tmp_path / "lib" / "hersey" / "files" / "shipped.py"))
    with pytest.raises(OutputError, match="has no examples"):
        copy_examples(tmp_path / "copied")
    assert not (tmp_path / "copied").exists()


@pytest.mark.parametrize("kind", ["folder", "file", "link"])
def test_nothing_that_exists_is_touched(kind: str, tmp_path: Path) -> None:
    taken = tmp_path / "taken"
    if kind == "folder":
        taken.mkdir()
    elif kind == "file":
        taken.write_text("mine")
    else:
        taken.symlink_to(tmp_path / "nowhere")
    with pytest.raises(ExistingFileError, match=r"already exists. Name a new folder"):
        copy_examples(taken)
    assert list(tmp_path.iterdir()) == [taken]
    assert kind != "file" or taken.read_text() == "mine"


def test_a_copy_that_fails_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise OutputError("disk full")

    monkeypatch.setattr("hersey.files.writing.write_all", full)
    with pytest.raises(OutputError, match="disk full"):
        copy_examples(tmp_path / "copied")
    assert not (tmp_path / "copied").exists()


def test_the_command_says_what_to_type_next(tmp_path: Path) -> None:
    done = run("examples", "my examples", cwd=tmp_path)
    assert done.stdout.splitlines() == [
        f"{len(names(tmp_path / 'my examples'))} files are in my examples.",
        "Next: hersey report 'my examples/bench.csv' --machine 'my examples/machine.toml' --tare standing",
    ]
    done = run("examples", "my examples", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "hersey: my examples already exists. Name a new folder\n"
    done = run("examples", "no/where", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith("hersey: no/where: there is no directory no. Make it first: mkdir -p no")
