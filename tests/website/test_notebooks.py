"""The notebooks of the tutorial run from top to bottom, and show their results."""

from __future__ import annotations

import ast
import json
from pathlib import Path
from typing import Any

import pytest

import hersey
from tests.life import shipped
from website.navigation import DOCS
from website.notebooks import notebook

NOTEBOOKS = sorted((DOCS / "tutorial").glob("*.ipynb"))


def run(path: Path) -> list[str]:
    """Run the cells in names of their own, and return what is shown below those that end with a result."""
    names: dict[str, Any] = {"__name__": "__main__"}
    shown = []
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] != "code":
            continue
        tree = ast.parse("".join(cell["source"]))
        last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
        exec(compile(tree, path.name, "exec"), names)
        if isinstance(last, ast.Expr):
            value = eval(compile(ast.Expression(last.value), path.name, "eval"), names)
            shown += [] if value is None else [value._repr_html_()]
    return shown


_STUDY, _STUDIES = hersey.study, dict[tuple[str, ...], hersey.Study]()


def _studied(points: hersey.SteadyPoints, *machine: str) -> hersey.Study:
    """The study of the shipped log with a machine file or none, made once."""
    if machine not in _STUDIES:
        _STUDIES[machine] = _STUDY(points, *machine)
    return _STUDIES[machine]


def test_every_page_of_the_tutorial_has_a_notebook_and_names_it() -> None:
    pages = sorted((DOCS / "tutorial").glob("*.md"))
    assert [page.with_suffix(".ipynb") for page in pages] == NOTEBOOKS
    for page in pages:
        assert f"]({page.stem}.ipynb)" in page.read_text(encoding="utf-8")


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_valid_and_holds_no_result(path: Path) -> None:
    nbformat = pytest.importorskip("nbformat")
    read = nbformat.read(path, as_version=4)
    nbformat.validate(read)
    assert [cell.outputs for cell in read.cells if cell.cell_type == "code" and cell.outputs] == []


@pytest.mark.usefixtures("roughly")
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, nightly: bool) -> None:
    monkeypatch.chdir(tmp_path)
    if not nightly:  # three notebooks have one study in common, and the life test is followed elsewhere
        monkeypatch.setattr(hersey, "study", _studied)
        if path.stem == "5-life":
            answer = shipped.followed()
            monkeypatch.setattr(hersey, "follow", lambda *_: answer)
    with shipped.few():
        shown = run(path)
    assert path.stem == "2-machine" or any("<svg" in each for each in shown)


def test_a_paragraph_is_a_cell_below_its_comments() -> None:
    made = json.loads(notebook("T", "```python\n# One,\n# two.\na = 1  # b\n\na\n```\n"))
    assert ["".join(cell["source"]) for cell in made["cells"][3:]] == ["One, two.", "a = 1  # b", "a"]
