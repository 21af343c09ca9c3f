"""The one runner of the command line in tests: in this process, or apart where start or signals matter."""

from __future__ import annotations

import contextlib
import gc
import io
import signal
import subprocess
import sys
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from unittest import mock

from hersey.cli import main, progress
from hersey.errors import speak

#: The command in a process of its own.
HERSEY = [sys.executable, "-m", "hersey.cli"]


@dataclass(frozen=True)
class Done:
    """What a command left: its exit code and what it printed."""

    returncode: int
    stdout: str
    stderr: str

    @property
    def words(self) -> str:
        """What it printed on stdout on one line, wherever lines end."""
        return " ".join(self.stdout.split())


def run(*arguments: str | Path, cwd: Path, answers: str = "", patience: float = 3600.0) -> Done:
    """Type a command in a folder, and answers; it runs in this process, warnings printed as they would be.

    Work that takes longer than ``patience``, s, is named on stderr; by default no work does.
    """
    stdout, stderr = io.StringIO(), io.StringIO()
    with (
        contextlib.chdir(cwd),
        mock.patch.object(sys, "argv", ["hersey", *map(str, arguments)]),
        mock.patch.object(sys, "stdin", io.StringIO(answers)),
        mock.patch.object(progress, "PATIENCE", patience),
        contextlib.redirect_stdout(stdout),
        contextlib.redirect_stderr(stderr),
        _handlers_kept(),
        _warnings_printed(),
    ):
        try:
            main()
            code: object = 0
        except SystemExit as end:
            code = end.code or 0
        finally:
            speak("python")  # the command line gives its advice in flags
            gc.unfreeze()  # what a process of its own would keep to its end
    assert isinstance(code, int)
    return Done(code, stdout.getvalue(), stderr.getvalue())


def run_apart(*arguments: str | Path, cwd: Path, command: list[str] = HERSEY) -> Done:
    """Type a command in a folder; it runs in a process of its own."""
    done = subprocess.run(
        [*command, *map(str, arguments)],
        cwd=cwd,
        capture_output=True,
        text=True,
        check=False,
        stdin=subprocess.DEVNULL,
    )
    return Done(done.returncode, done.stdout, done.stderr)


def start(*arguments: str | Path, cwd: Path) -> subprocess.Popen[bytes]:
    """Start a command in a folder and do not wait for its end."""
    return subprocess.Popen([*HERSEY, *map(str, arguments)], cwd=cwd, stderr=subprocess.PIPE)


@contextlib.contextmanager
def _handlers_kept() -> Iterator[None]:
    """Give back the handler of the signal that the program takes."""
    before = signal.getsignal(signal.SIGTERM)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


@contextlib.contextmanager
def _warnings_printed() -> Iterator[None]:
    """Print warnings on stderr as a process of its own does, instead of handing them to pytest."""

    def shown(message: Warning | str, category: type[Warning], name: str, line: int, *_: object) -> None:
        sys.stderr.write(warnings.formatwarning(message, category, name, line))

    with warnings.catch_warnings():
        warnings.resetwarnings()
        for quiet in (DeprecationWarning, PendingDeprecationWarning, ImportWarning, ResourceWarning):
            warnings.simplefilter("ignore", quiet)
        warnings.showwarning = shown
        yield
