"""Output files: whole or not at all, whatever their name is and whenever the process dies."""

from __future__ import annotations

import errno
import os
import re
import shlex
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from hersey.errors import ExistingFileError
from hersey.files import writing
from hersey.files.writing import write_all, write_atomically, written
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
    assert "File not found" in shown.stderr
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


def overtaken(path: Path) -> None:
    """Write a file that somebody else makes in the meantime."""
    with written(path, overwrite=False) as file:
        file.write(b"mine")
        path.write_text("theirs")


def test_a_file_that_appears_meanwhile_is_not_replaced(tmp_path: Path) -> None:
    path = tmp_path / "report.html"
    with pytest.raises(ExistingFileError, match="exists"):
        overtaken(path)
    assert path.read_text() == "theirs"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("taken", [False, True])
def test_a_file_system_without_links(taken: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object) -> None:
        raise PermissionError(errno.EPERM, "Operation not permitted")

    monkeypatch.setattr(os, "link", refused)
    path = tmp_path / "report.html"
    if taken:
        with pytest.raises(ExistingFileError):
            overtaken(path)
    else:
        write_atomically(path, "mine", overwrite=False)
    assert path.read_text() == ("theirs" if taken else "mine")
    assert list(tmp_path.iterdir()) == [path]


def test_a_link_that_leads_nowhere_is_a_name_taken(tmp_path: Path) -> None:
    (tmp_path / "report.html").symlink_to("elsewhere")
    with pytest.raises(ExistingFileError):
        write_atomically(tmp_path / "report.html", "mine", overwrite=False)
    assert not (tmp_path / "elsewhere").exists()


def test_of_many_files_none_stays_where_one_name_is_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    a, b, old = (tmp_path / name for name in ("a.svg", "b.svg", "old.svg"))
    old.write_text("old")
    monkeypatch.setattr(writing, "_place", appearing(b, writing._place))
    with pytest.raises(ExistingFileError, match=re.escape(str(b))):
        write_all({old: b"new", a: b"mine", b: b"mine"}, overwrite={old: True, a: False, b: False})
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {
        "b.svg": "theirs",
        "old.svg": "old",
    }


def appearing(path: Path, place: Callable[..., None]) -> Callable[..., None]:
    """Let somebody else's file appear right before one takes its place."""

    def placed(part: Path, at: Path, overwrite: bool) -> None:
        if at == path:
            path.write_text("theirs")
        place(part, at, overwrite)

    return placed


#: Each verb that writes, on what costs little, and the file that appears while it works.
WRITES = {
    "--out": ("testbench --out log.csv", "log.csv"),
    "--truth": ("testbench --out log.csv --truth truth.json", "truth.json"),
    "--csv": ("simulate --csv motion.csv", "motion.csv"),
    "--figure": ("simulate --figure motion.svg", "motion.svg"),
    "--each": ("fit examples/bench.csv --tare standing --each fits.csv", "fits.csv"),
    "--save-mapping": ("inspect log.csv --save-mapping", "hersey.toml"),
    "--save-recipe": ("inspect log.csv --save-recipe recipe.toml", "recipe.toml"),
    "sweep": ("sweep examples/scenario.toml --out sweep.parquet", "sweep.parquet"),
    "new": ("new log.csv --machine m.toml --mapping h.toml", "h.toml"),
}
#: The same of verbs that take longer.
TAKES_LONGER = {
    "warmup": (
        "warmup examples/machine.toml examples/bench.csv --tare standing --target '120 mm/s' "
        "--from '20 degC' --out course.csv",
        "course.csv",
    ),
    "posterior": (
        "posterior examples/bench.csv --machine examples/machine.toml --tare standing --draws 100 "
        "--out draws.parquet",
        "draws.parquet",
    ),
    "report": ("report examples/bench.csv --tare standing --out page.html", "page.html"),
    "map": ("map examples/machine.toml examples/bench.csv --tare standing --out map.svg", "map.svg"),
}


@pytest.mark.usefixtures("roughly")
@pytest.mark.parametrize("what", WRITES)
def test_no_verb_replaces_what_appears_while_it_works(
    what: str, examples_here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if what not in ("--out", "--truth"):  # which write it
        (examples_here / "log.csv").write_bytes((ROOT / "examples" / "bench.csv").read_bytes())
    refused_at_the_end(*WRITES[what], examples_here, monkeypatch)


@pytest.mark.usefixtures("few_draws", "few_laws")
@pytest.mark.parametrize("what", TAKES_LONGER)
def test_no_long_verb_replaces_what_appears_while_it_works(
    what: str, examples_here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    refused_at_the_end(*TAKES_LONGER[what], examples_here, monkeypatch)


def refused_at_the_end(typed: str, name: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(writing, "_place", appearing(Path(name), writing._place))
    done = run(*shlex.split(typed), cwd=folder, answers="\n" * 8)
    assert (done.returncode, done.stderr.count("exists: use --force")) == (2, 1), done.stderr
    assert (folder / name).read_text() == "theirs"
    assert not list(folder.glob(".*.part"))


#: A command that says when it has its result, and writes it when it is told to.
WAITING = """
import sys
from hersey.files import writing
place = writing._place
def placed(*given):
    print("ready", flush=True)
    sys.stdin.readline()
    place(*given)
writing._place = placed
from hersey.cli import main
main()
"""


def test_of_two_commands_that_write_one_file_one_wins(tmp_path: Path) -> None:
    typed = [sys.executable, "-c", WAITING, "testbench", "--out", "log.csv", "--seed"]
    processes = [
        subprocess.Popen(
            [*typed, str(seed)],
            cwd=tmp_path,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        for seed in (1, 2)
    ]
    for process in processes:  # both have looked for the file, and neither has written it
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
    ends = []
    for process in processes:
        ends.append((process, *process.communicate("go\n")))
    codes = [process.returncode for process, _, _ in ends]
    assert codes == [0, 2]
    assert ends[1][2] == "hersey: log.csv exists: use --force to replace it, or name another file\n"
    assert "seed 1" in (tmp_path / "log.csv").read_text().splitlines()[0]
    assert [path.name for path in tmp_path.iterdir()] == ["log.csv"]
