"""Output files: whole or not at all, whatever their name is and whenever the process dies."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from hersey.files.writing import write_atomically
from tests.cli.command import run
from tests.conftest import ROOT

#: Dies by a signal that nothing can catch, inside the write or right before the new file takes its place.
KILLED = """
import os, signal, sys
from pathlib import Path
from unittest import mock
from hersey.files.writing import write_atomically

def die(*_):
    os.kill(os.getpid(), signal.SIGKILL)

def torn(path, mode):  # in the place of a method
    class File:
        def __enter__(self): return self
        def __exit__(self, *_): pass
        def write(self, content):
            os.write(handle, content[: len(content) // 2])
            die()
    handle = os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY)
    return File()

where = {"write": ("pathlib.Path.open", torn), "replace": ("pathlib.Path.replace", die)}[sys.argv[2]]
with mock.patch(*where):
    write_atomically(Path(sys.argv[1]), b"new" * 1000, overwrite=True)
"""


@pytest.mark.parametrize("moment", ["write", "replace"])
def test_a_kill_within_the_write_leaves_the_old_file_whole(moment: str, tmp_path: Path) -> None:
    file = tmp_path / "report.html"
    file.write_text("old")
    dead = subprocess.run([sys.executable, "-c", KILLED, file, moment], check=False, cwd=ROOT)
    assert dead.returncode == -signal.SIGKILL
    assert file.read_text() == "old"
    (left,) = set(tmp_path.iterdir()) - {file}
    assert left.name.startswith(".report.html.")
    assert left.suffix == ".part"
    write_atomically(file, "new", overwrite=True)
    assert file.read_text() == "new"
    assert set(tmp_path.iterdir()) == {file, left}


def test_what_a_killed_command_left_does_not_fill_a_folder(tmp_path: Path) -> None:
    folder = tmp_path / "figures"
    folder.mkdir()
    (folder / ".fig9.svg.abc.part").write_text("half")
    shown = run("report", ROOT / "examples" / "none.csv", "--figures", folder, cwd=tmp_path)
    assert "no such file" in shown.stderr
    (folder / "mine.part").write_text("mine")
    shown = run("report", ROOT / "examples" / "none.csv", "--figures", folder, cwd=tmp_path)
    assert "is not empty" in shown.stderr


@pytest.mark.parametrize(
    "name", ["x" * 250 + ".html", "é" * 125 + ".html", "語" * 83 + ".htm", "𝜏" * 62 + ".html", ".html"]
)
def test_a_name_may_have_255_bytes(name: str, tmp_path: Path) -> None:
    assert len(name.encode()) <= 255
    write_atomically(tmp_path / name, "whole", overwrite=False)
    assert [(file.name, file.read_text()) for file in tmp_path.iterdir()] == [(name, "whole")]


def test_a_log_whose_name_has_255_bytes_is_read(tmp_path: Path) -> None:
    log = tmp_path / ("é" * 125 + "x.csv")
    log.write_bytes((ROOT / "examples" / "bench.csv").read_bytes())
    done = run("inspect", log.name, "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
