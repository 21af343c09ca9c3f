"""What `make wheel` and `make release-check` do; neither is run here."""

from __future__ import annotations

import re
import subprocess
import zipfile
from pathlib import Path

import pytest

from tests.conftest import ROOT
from tests.release_check import heaviest, missing


@pytest.mark.parametrize("target", ["library", "wheel", "release-check"])
def test_the_targets_are_there_and_upload_nothing(target: str) -> None:
    assert re.search(rf"^{target}:.* ## ", (ROOT / "Makefile").read_text(), re.M)
    done = subprocess.run(["make", "-n", target], cwd=ROOT, capture_output=True, text=True, check=True)
    assert not re.search(r"\b(publish|upload|twine)\b", done.stdout)


def test_a_wheel_that_lacks_a_file_is_seen(tmp_path: Path) -> None:
    package = tmp_path / "hersey"
    (package / "__pycache__").mkdir(parents=True)
    for name in ("page.css", "_core.pyi", "_core.abi3.so", "__pycache__/page.pyc"):
        (package / name).write_text("")
    wheel = tmp_path / "hersey.whl"
    with zipfile.ZipFile(wheel, "w") as packed:
        packed.writestr("hersey/_core.pyi", "")
    assert missing(wheel, package, frozenset({"hersey/made"})) == [
        "hersey/made",
        "hersey/page.css",
        "hersey/_core",
    ]
    with zipfile.ZipFile(wheel, "a") as packed:
        packed.writestr("hersey/page.css", "")
        packed.writestr("hersey/made", "")
        packed.writestr("hersey/_core.abi3.so", "")
    assert missing(wheel, package, frozenset({"hersey/made"})) == []


def test_packages_are_weighed_with_their_libraries(tmp_path: Path) -> None:
    for name, length in (("small", 1), ("large", 2), ("large.libs", 5), ("large-1.dist-info", 9)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "file").write_bytes(b"x" * length)
    assert heaviest(tmp_path) == [("large", 7), ("small", 1)]
