"""Code never looks into a sentence: with every message of the package reworded no number changes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[1]

#: Words of every text that is put together with numbers, or that an error is raised with, are turned around
#: as the modules are read.
_REWORDING = """
import ast, importlib.abc, importlib.machinery, re, sys


def turned(text):
    return re.sub(r"[a-z]{3,}", lambda word: word[0][::-1], text)


def words_turned(node):
    for each in ast.walk(node):
        if isinstance(each, ast.Constant) and isinstance(each.value, str):
            parts = re.split(r"(\\{[^}]*\\})", each.value)
            each.value = "".join(part if part[:1] == "{" else turned(part) for part in parts)


class Reword(ast.NodeTransformer):
    def visit_JoinedStr(self, node):
        texts = [part.value for part in node.values if isinstance(part, ast.Constant)]
        query = bool(texts) and texts[0].split(" ")[0] in ("SELECT", "INSERT", "PRAGMA", "CREATE", "UPDATE")
        if any(" " in text for text in texts) and not query:
            for part in node.values:
                if isinstance(part, ast.Constant):
                    part.value = turned(part.value)
        return node

    def visit_Raise(self, node):
        if isinstance(node.exc, ast.Call):
            for each in node.exc.args:
                if isinstance(each, ast.Constant) and isinstance(each.value, str):
                    each.value = turned(each.value)
        return self.generic_visit(node)

    def visit_Call(self, node):
        if getattr(node.func, "id", "") == "Warning":
            shown = [each.value for each in node.keywords if each.arg in ("remedy", "title")]
            for words in [*node.args[1:], *shown]:
                words_turned(words)
        return self.generic_visit(node)

    def visit_Expr(self, node):  # docstrings stay: the JSON schema and the tests of the docs are made of them
        return node if isinstance(node.value, ast.Constant) else self.generic_visit(node)


class Loader(importlib.machinery.SourceFileLoader):
    def source_to_code(self, data, path, *, _optimize=-1):
        tree = ast.fix_missing_locations(Reword().visit(ast.parse(data)))
        return compile(tree, path, "exec", dont_inherit=True, optimize=_optimize)

    def get_code(self, name):  # never from or to the cache
        return self.source_to_code(self.get_data(self.path), self.path)


class Finder(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] != "hersey":
            return None
        found = importlib.machinery.PathFinder.find_spec(name, path, target)
        if found and isinstance(found.loader, importlib.machinery.SourceFileLoader):
            found.loader = Loader(found.loader.name, found.loader.path)
        return found


sys.meta_path.insert(0, Finder())
"""
#: Types each command, and prints what all of them print.
_TYPED = """
import contextlib, io, shlex, sys
from hersey.cli.application import main

printed = []
for line in sys.argv[1:]:
    sys.argv = ["hersey", *shlex.split(line), "--json"]
    with contextlib.redirect_stdout(io.StringIO()) as told:
        try:
            main()
        except SystemExit as end:
            assert not end.code, end.code
    printed.append(told.getvalue())
print("[" + ",".join(printed) + "]")
"""


def numbers(document: Any, at: str = "") -> dict[str, Any]:
    """Every number, truth and absence of a document by its place; of texts only that they are there."""
    if isinstance(document, dict):
        parts = document.items()
    elif isinstance(document, list):
        parts = enumerate(document)  # type: ignore[assignment]
    else:
        return {at: "text" if isinstance(document, str) else document}
    return {place: value for key, part in parts for place, value in numbers(part, f"{at}.{key}").items()}


def documents(commands: tuple[str, ...], *, reworded: bool) -> list[dict[str, Any]]:
    """What commands print with ``--json``, one after the other in a process of their own."""
    done = subprocess.run(
        [sys.executable, "-c", (_REWORDING if reworded else "") + _TYPED, *commands],
        cwd=ROOT,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=True,
        timeout=600,
    )
    found: list[dict[str, Any]] = json.loads(done.stdout)
    return found


@pytest.mark.parametrize(
    "commands",
    [
        # the report holds the fit and its verdict
        pytest.param(("fit examples/bench.csv --tare standing",), marks=pytest.mark.nightly),
        (
            "report examples/bench.csv --machine examples/machine.toml --tare standing",
            "inspect examples/bench.csv",
        ),
    ],
    ids=["fit", "report and inspect"],
)
def test_no_number_hangs_on_a_sentence(commands: tuple[str, ...]) -> None:
    written, turned = (documents(commands, reworded=each) for each in (False, True))
    assert len(written) == len(turned) == len(commands)
    for as_written, reworded in zip(written, turned, strict=True):
        assert as_written != reworded  # the words are others
        assert numbers(as_written) == numbers(reworded)
