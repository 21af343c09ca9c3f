"""A result that nobody can receive ends in an error, but for a pipe whose reader has seen enough."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.command import HERSEY

TYPED = [["simulate"], ["simulate", "--json"], ["--help"], ["--version"], ["simulate", "--mass", "x"]]
FULL = Path("/dev/full")


def shell(line: str, *arguments: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a command with its streams as a shell's line has them."""
    typed = ["sh", "-c", f'"$@" {line}', "sh", *HERSEY, *arguments]
    return subprocess.run(typed, cwd=folder, capture_output=True, text=True, check=False)


@pytest.mark.skipif(os.name != "posix", reason="the streams are closed by a shell of POSIX")
@pytest.mark.parametrize("typed", TYPED, ids=" ".join)
def test_a_closed_stdout_is_an_error(typed: list[str], tmp_path: Path) -> None:
    done = shell(">&-", *typed, folder=tmp_path)
    assert done.returncode == 2
    assert done.stderr == (
        "hersey: stdout is closed, so no result can be shown: send it to a file, or to /dev/null\n"
    )


@pytest.mark.skipif(not FULL.exists(), reason="needs a device that is always full")
@pytest.mark.parametrize("typed", TYPED[:4], ids=" ".join)
def test_a_full_device_is_an_error(typed: list[str], tmp_path: Path) -> None:
    done = shell("> /dev/full", *typed, folder=tmp_path)
    assert done.returncode == 2
    assert done.stderr == "hersey: cannot write the result: No space left on device\n"


@pytest.mark.skipif(not FULL.exists(), reason="needs a device that is always full")
@pytest.mark.parametrize("line", ["> /dev/full 2>&-", "> /dev/full 2> /dev/full", ">&- 2>&-"])
def test_the_code_tells_it_where_nothing_can_be_said(line: str, tmp_path: Path) -> None:
    done = shell(line, "simulate", folder=tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (2, "", "")


@pytest.mark.skipif(os.name != "posix", reason="the streams are closed by a shell of POSIX")
@pytest.mark.parametrize("line", ["<&-", "2>&-"])
def test_the_other_streams_may_be_closed(line: str, tmp_path: Path) -> None:
    done = shell(line, "simulate", "--csv", "motion.csv", folder=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("The drive sticks and slips.\n")
    assert (tmp_path / "motion.csv").read_text().startswith("time,")


@pytest.mark.parametrize(("typed", "code"), [*((each, 0) for each in TYPED[:4]), (TYPED[4], 2)])
def test_a_closed_pipe_is_quiet(typed: list[str], code: int, tmp_path: Path) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    try:
        done = subprocess.run(
            [*HERSEY, *typed], cwd=tmp_path, stdout=writer, stderr=subprocess.PIPE, text=True, check=False
        )
    finally:
        os.close(writer)
    assert done.returncode == code
    assert done.stderr.count("\n") == (1 if code else 0)


def test_a_pipe_that_closes_in_the_midst_is_quiet(tmp_path: Path) -> None:
    code = "import hersey.cli.streams as s\nwith s.standard_streams():\n while True: print('x' * 10000)"
    process = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=tmp_path
    )
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdout.read(1)
    process.stdout.close()
    assert process.stderr.read() == b""
    assert process.wait() == 0
