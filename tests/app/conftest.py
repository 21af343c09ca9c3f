"""The app in a process of its own, and the browser."""

from __future__ import annotations

import signal
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.browser.conftest import browser
from tests.cli.command import HERSEY

__all__ = ["browser"]


@dataclass(frozen=True)
class Started:
    """A start of the app: where its page is, and its folder."""

    process: subprocess.Popen[str]
    address: str
    folder: Path


def start(folder: Path) -> Started:
    process = subprocess.Popen(
        [*HERSEY, "app", "--no-browser"],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    first = process.stdout.readline()
    assert first.startswith("hersey app: http://127.0.0.1:"), first
    return Started(process, first.split(": ", 1)[1].strip(), folder)


def end(started: Started, number: int = signal.SIGINT) -> str:
    started.process.send_signal(number)
    assert started.process.stderr is not None
    told = started.process.stderr.read()
    started.process.wait()
    return told


@pytest.fixture(scope="package")
def started(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Started]:
    one = start(tmp_path_factory.mktemp("app"))
    yield one
    end(one)
