"""Every block of Python in README and docs runs alone: pasted into an interpreter at the root."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.conftest import ROOT, mostly_nightly
from tests.life import shipped

FILES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
#: A block, and the comment before it if it cannot run here.
BLOCK = re.compile(r"(?:<!-- (needs [^>]*) -->\n)?^```python\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def blocks() -> dict[str, tuple[str, str]]:
    """Each block with what it needs, by file and line."""
    found = {}
    for file in FILES:
        text = file.read_text()
        for match in BLOCK.finditer(text):
            line = text.count("\n", 0, match.start(2))
            found[f"{file.relative_to(ROOT)}:{line}"] = (match[1] or "", match[2])
    return found


BLOCKS = blocks()
#: What takes more than about two seconds, by the call that does.
LONG = (
    "compare_models(",
    "follow(",
)
RUN = {name: code for name, (needs, code) in BLOCKS.items() if not needs}
QUICK = {name: code for name, code in RUN.items() if not any(call in code for call in LONG)}


@pytest.fixture
def pasted(examples_here: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    """Run a block in names of its own, in a folder that has the examples as the repository has them."""
    monkeypatch.chdir(examples_here)
    return lambda name: exec(compile(RUN[name], name, "exec"), {"__name__": "__main__"})


@pytest.mark.usefixtures("few_draws", "few_laws")
@pytest.mark.parametrize("name", QUICK)
def test_a_block_runs_alone(name: str, pasted: Callable[[str], None]) -> None:
    pasted(name)


#: The call of `follow` is what the README types as `hersey life`, of the same eight units.
LASTING = sorted(RUN.keys() - QUICK.keys())
KEPT = [name for name in LASTING if "follow(" not in RUN[name]]


@pytest.mark.usefixtures("few_draws", "few_laws")
@pytest.mark.parametrize("name", mostly_nightly(LASTING, *KEPT))
def test_a_long_block_runs_alone(name: str, pasted: Callable[[str], None]) -> None:
    with shipped.few():
        pasted(name)


def test_only_a_cluster_is_not_here() -> None:
    """A block that cannot run is marked, its names are defined, and there is one."""
    (needs, code), *others = [block for block in BLOCKS.values() if block[0]]
    assert (needs, others) == ("needs a cluster", [])
    compile(code, "scale.md", "exec")
    assert "Client(" in code


def test_every_block_is_found() -> None:
    """None escapes by the way it is marked."""
    fences = sum(len(re.findall(r"^\s*(?:```|~~~)\s*py", file.read_text(), re.MULTILINE)) for file in FILES)
    assert len(BLOCKS) == fences > 15
