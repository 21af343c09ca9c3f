"""Rules of the house: layers, errors, docs, and nothing about machines or registries in the repository."""

from __future__ import annotations

import ast
import functools
import inspect
import pickle
import re
import subprocess
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import hersey
from hersey import errors
from hersey.cli.application import VERBS, load
from tests.conftest import LISTED, ROOT
from tests.mutants import files_for, named, sample, table

PACKAGE = ROOT / "python" / "hersey"
#: Rooms in the order in which data passes through them: each may import only those before it.
ROOMS = (
    "_core",
    "errors",
    "arguments",
    "units",
    "arrays",
    "schema",
    "result",
    "files",
    "cache",
    "processes",
    "scale",
    "log",
    "motion",
    "damping",
    "inspection",
    "lubrication",
    "machine",
    "verdict",
    "identification",
    "stability",
    "posterior",
    "decision",
    "study",
    "life",
    "exchange",
    "document",
    "charts",
    "report",
    "testbench",
    "app",
    "cli",
)
#: The arrows that point backwards, taken only when a user asks: a log reduces itself to its dwells,
#: and a result finds its chart and draws it.
LAZY = {
    ("hersey.log.torque_log", "hersey.damping.dwells"),
    ("hersey.log.torque_log", "hersey.damping.moving.fit"),
    ("hersey.log.torque_log", "hersey.damping.moving.result"),
    ("hersey.result", "hersey.charts"),
    ("hersey.result", "hersey.charts.render"),
}


def modules() -> dict[str, Path]:
    """Every module of the package by its dotted name."""
    named = {}
    for path in PACKAGE.rglob("*.py"):
        parts = path.relative_to(PACKAGE).with_suffix("").parts
        named[".".join(("hersey", *(p for p in parts if p != "__init__")))] = path
    return named


def imported(path: Path, known: set[str]) -> set[str]:
    """Modules that a file imports anywhere, also inside functions and for type checkers alone."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "hersey":
            for alias in node.names:
                inside = f"{node.module}.{alias.name}"
                found.add(inside if inside in known else str(node.module))
        elif isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names if alias.name.split(".")[0] == "hersey"}
    return found


@functools.cache
def imports() -> dict[str, set[str]]:
    """Every module of the package with those that it imports."""
    named = modules()
    known = {*named, "hersey._core"}
    return {name: imported(path, known) for name, path in named.items() if name != "hersey"}


def room(module: str) -> int:
    return ROOMS.index(module.split(".")[1])


def test_each_room_imports_only_rooms_above_it() -> None:
    for module, others in imports().items():
        for other in others - {"hersey"}:
            if room(module) != room(other) and (module, other) not in LAZY:
                assert room(other) < room(module), f"{module} imports {other}"
        assert "hersey" not in others or module.startswith("hersey.cli"), f"{module} imports the root"


def test_the_lazy_arrows_exist() -> None:
    taken = imports()
    for module, other in LAZY:
        assert other in taken[module], f"{module} no longer imports {other}: take it off the list"


def test_no_circle() -> None:
    taken = {
        module: {other for other in others - {module} if (module, other) not in LAZY}
        for module, others in imports().items()
    }
    while ends := {module for module, others in taken.items() if not others & taken.keys()}:
        taken = {module: others for module, others in taken.items() if module not in ends}
    assert not taken, f"in or before a circle: {', '.join(sorted(taken))}"


def test_the_root_holds_only_what_every_room_needs() -> None:
    needed = {"arrays", "errors", "result"}
    assert {path.stem for path in PACKAGE.glob("*.py")} == {"__init__", *needed}


def test_each_room_says_what_it_holds() -> None:
    """The header of a room lists its modules: nothing missing, nothing that is gone."""
    for header in PACKAGE.rglob("__init__.py"):
        if header.parent == PACKAGE:
            named = set(re.findall(r"^(\w+)  ", header.read_text(), re.M))
            assert named == set(ROOMS) - {"_core"}
            continue
        text = ast.get_docstring(ast.parse(header.read_text())) or ""
        own = {path.stem for path in header.parent.glob("*.py")} | {
            path.name for path in header.parent.iterdir() if (path / "__init__.py").exists()
        }
        for name in own - {"__init__", "__main__"}:
            if header.parent.name != "cli":
                assert re.search(rf"^{name}\b|`{name}`", text, re.M), f"{header.parent.name}: {name}"
        for name in re.findall(r"^(\w+)  ", text, re.M):
            assert name in own or (header.parent / name).exists() or name == "module", f"{header}: {name}"


def test_core_layers() -> None:
    sources = ROOT / "crates" / "core" / "src"
    for path in (sources / "drag").rglob("*.rs"):
        assert "crate::motion" not in path.read_text()
    for path in (sources / "lubrication").rglob("*.rs"):
        for above in ("drag", "motion", "stability"):
            assert f"crate::{above}" not in path.read_text()
    for path in [*(sources / "drag").rglob("*.rs"), *(sources / "motion").rglob("*.rs")]:
        assert "crate::stability" not in path.read_text()
    for path in sources.rglob("*.rs"):
        text = path.read_text()
        for forbidden in ("println!", "std::fs", "std::thread", "static mut", "pyo3"):
            assert forbidden not in text, f"{path.name}: {forbidden}"


#: A path of Rust that begins in the crate, in the room above, or in a module of the file itself.
_PATH = r"\b(?:crate|super|self{children})(?=::)(?:::(?:\w+|\*))*(?:::(?=\{{))?"


def opened(braces: str) -> list[str]:
    """The paths of a ``{{a, b::{{c, d}}}}``, each in full; ``braces`` begins with the first brace."""
    found, prefixes, name = [], [""], ""
    for sign in re.sub(r"\s+as \w+|\s", "", braces):
        if sign == "{":
            prefixes.append(prefixes[-1] + name)
        elif sign in ",}":
            found += [prefixes[-1] + name] if name else []
            prefixes = prefixes[:-1] if sign == "}" else prefixes
        name = "" if sign in "{,}" else name + sign
        if len(prefixes) == 1:
            break
    return found


def rust_paths(text: str, children: set[str]) -> list[tuple[bool, str]]:
    """Every path that a Rust file takes, in full, and whether it only hands the thing on (``pub use``)."""
    found = []
    pattern = _PATH.format(children="".join(f"|{name}" for name in sorted(children)))
    for match in re.finditer(pattern, text):
        before = text[max(0, match.start() - 40) : match.start()]
        if before.endswith("::"):
            continue
        handed_on = re.search(r"\bpub(\([\w ]+\))? use $", before) is not None
        ends = opened(text[match.end() :]) if match.group().endswith("::") else [""]
        found += [(handed_on, match.group() + end) for end in ends]
    return found


def rust_arrows(sources: Path) -> dict[str, set[str]]:
    """Every file of a crate, as ``a::b``, with the files whose things it names; unit tests left out.

    A method that is called is no arrow: its type was named where it came from.
    """
    files = {}
    for path in sources.rglob("*.rs"):
        parts = path.relative_to(sources).with_suffix("").parts
        text = path.read_text().split("#[cfg(test)]\nmod tests")[0]
        files[tuple(part for part in parts if part not in {"mod", "lib"})] = re.sub(r"//.*", "", text)
    own = {
        module: {child[-1] for child in files if child[:-1] == module and child != module} for module in files
    }
    paths = {module: rust_paths(text, own[module]) for module, text in files.items()}

    def home(module: tuple[str, ...], path: str) -> tuple[str, ...]:
        """The file in which the thing at a path is defined, seen from a module."""
        names = path.split("::")
        at = () if names[0] == "crate" else module
        for i, name in enumerate(names):
            if name in {"crate", "self"}:
                continue
            if name == "super":
                at = at[:-1]
            elif (*at, name) in files:
                at = (*at, name)
            else:
                handed = [p for on, p in paths[at] if on and p.split("::")[-1] == name]
                return home(at, "::".join((handed[0], *names[i + 1 :]))) if handed else at
        return at

    return {
        "::".join(module): {"::".join(home(module, path)) for on, path in taken if not on}
        - {"::".join(module)}
        for module, taken in paths.items()
    }


def circles(arrows: dict[str, set[str]]) -> dict[str, set[str]]:
    """What is left once all are gone that lead nowhere else, or to which nothing leads."""
    left = {module: others & arrows.keys() for module, others in arrows.items()}
    while ends := {
        module for module in left if not left[module] or module not in set().union(*left.values())
    }:
        left = {module: others - ends for module, others in left.items() if module not in ends}
    return left


@pytest.mark.parametrize("crate", ["core", "py", "c", "wasm"])
def test_no_circle_of_rust(crate: str) -> None:
    arrows = rust_arrows(ROOT / "crates" / crate / "src")
    assert sum(map(len, arrows.values())) > len(arrows) - 1, "nothing was seen"
    left = circles(arrows)
    assert not left, "\n".join(f"{module} -> {', '.join(sorted(left[module]))}" for module in sorted(left))


def test_a_circle_of_rust_is_seen(tmp_path: Path) -> None:
    """By a ``use``, by a name that the room hands on, and by a path in the middle of a line."""
    (tmp_path / "room").mkdir()
    texts = {
        "lib": "pub mod room;\npub mod low;\n",
        "low": "pub struct Low;\n#[cfg(test)]\nmod tests {\n use crate::room::Thing;\n}\n",
        "room/mod": "mod one;\nmod two;\nmod three;\npub use one::{Other, Thing};\n",
        "room/one": "use super::two::{\n    self,\n    Two,\n};\npub struct Thing;\n",
        "room/two": "use crate::{low::Low, room::Thing}; // crate::room::three::Three\n",
        "room/three": "fn f() -> f64 { super::two::g() }\n",
    }
    for name, text in texts.items():
        (tmp_path / f"{name}.rs").write_text(text)
    arrows = rust_arrows(tmp_path)
    assert arrows["low"] == set()
    assert arrows["room::two"] == {"low", "room::one"}
    assert arrows["room::one"] == arrows["room::three"] == {"room::two"}
    assert circles(arrows) == {"room::one": {"room::two"}, "room::two": {"room::one"}}


def test_every_error_is_a_built_in_and_survives_pickling() -> None:
    kinds = [k for k in vars(errors).values() if isinstance(k, type) and issubclass(k, errors.HerseyError)]
    assert len(kinds) > 5
    for kind in kinds:
        error = kind("what", "way out")
        assert str(error) == "what way out"
        again = pickle.loads(pickle.dumps(error))
        assert (type(again), str(again)) == (kind, str(error))
        assert kind is errors.HerseyError or len(kind.__mro__) > len(errors.HerseyError.__mro__)


def test_public_functions_are_documented() -> None:
    for name in hersey.__all__:
        thing = getattr(hersey, name)
        if callable(thing):
            assert inspect.getdoc(thing), name


#: Parameters of a public function at the most; the keywords that it takes by ``**`` are one group of them.
MOST_PARAMETERS = 8
#: Functions that have more, and why.
MORE_PARAMETERS = {
    # how a log is read is one set of keywords of `inspect`; here each is a parameter still
    "hersey.log.reading.read",
    "hersey.log.mapping.read_with_mapping",
    # inputs of a unit and their start values, each of which the unit has as a variable
    "hersey.exchange.unit.export_fmu",
    # the parts of a document, put together in one place
}


_NAMED_BLOCKS = (ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def public_functions(tree: ast.AST, name: str) -> Iterator[tuple[str, int]]:
    """Each public function or method under a dotted name, with the number of its parameters."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, _NAMED_BLOCKS) and node.name.startswith("_"):
            continue
        if isinstance(node, ast.ClassDef):
            yield from public_functions(node, f"{name}.{node.name}")
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            given = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
            given += [each for each in (node.args.vararg, node.args.kwarg) if each is not None]
            own = isinstance(tree, ast.ClassDef) and given and given[0].arg in ("self", "cls")
            yield f"{name}.{node.name}", len(given) - bool(own)


def test_no_public_function_has_many_parameters() -> None:
    """The flags of a command are the parameters of its function, so commands do not count."""
    flags = {
        f"{each.callback.__module__}.{each.callback.__name__}"
        for command in commands().values()
        for each in (command, *getattr(command, "commands", {}).values())
        if each.callback is not None
    }
    found = {
        function: count
        for module, path in modules().items()
        for function, count in public_functions(ast.parse(path.read_text()), module)
    }
    assert len(found) > 1000
    assert flags <= found.keys() | {"hersey.cli.export._root"}
    many = {function for function, count in found.items() if count > MOST_PARAMETERS} - flags
    assert many == MORE_PARAMETERS, sorted(many ^ MORE_PARAMETERS)


@pytest.mark.parametrize("module", [m for m, path in modules().items() if ">>> " in path.read_text()])
def test_examples_in_docstrings(module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    import doctest
    import importlib

    monkeypatch.chdir(ROOT)
    result = doctest.testmod(importlib.import_module(module))
    assert result.attempted > 0
    assert result.failed == 0


def commands() -> dict[str, Any]:
    return {name: load(name) for name in VERBS}


def test_no_message_outside_the_command_line_names_a_flag() -> None:
    """What to do is said in the words of the way in (`hersey.errors.Setting`): a notebook has no flags."""
    found = []
    for path in sorted((ROOT / "python" / "hersey").rglob("*.py")):
        if "cli" in path.parts:
            continue
        tree = ast.parse(path.read_text())
        for node in ast.walk(tree):  # docstrings, and what is said in a terminal alone
            if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
                node.value.value = ""
            elif isinstance(node, ast.IfExp) and "way_in" in ast.unparse(node.test):
                node.body = ast.Constant("")
        for node in ast.walk(tree):
            text = node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else ""
            if re.search(r"(^|[\s'\"`(])--([a-z]|$)", text) and not re.fullmatch(r"--[a-z-]*", text):
                found.append(f"{path.relative_to(ROOT)}:{node.lineno}: {text}")  # type: ignore[attr-defined]
    assert found == []


#: A dotted name below the package, or a file of it, in prose or code.
_NAMED = re.compile(r"(?<![\w./-])hersey((?:\.[A-Za-z_]\w*)+)")
_FILE = re.compile(r"python/hersey/([\w/]+\.py)\b|`([\w/]+/\w+\.py)`")
#: What ends like a module and is none: files that carry the name.
_OF_FILES = {"toml"}


def test_the_docs_name_nothing_that_is_gone() -> None:
    """Every ``hersey.x.y`` in prose resolves, to a module or to what stands in one; every file is there."""
    texts = [*(ROOT / "docs").rglob("*.md"), *ROOT.glob("*.md"), *(ROOT / "benchmarks").glob("*.md")]
    seen = 0
    for path in [*texts, *modules().values()]:
        text = path.read_text()
        for dotted in _NAMED.findall(text):
            parts = dotted.strip(".").split(".")
            if parts[0] in _OF_FILES:
                continue
            seen += 1
            assert resolves(parts), f"{path.name} names hersey{dotted}"
        for inside, other in _FILE.findall(text) if path in texts else []:
            assert (PACKAGE / inside).is_file() if inside else (ROOT / other).is_file(), (
                f"{path.name}: {other}"
            )
    assert seen > 100


def resolves(parts: list[str]) -> bool:
    """Whether ``hersey`` followed by these names is there."""
    import importlib

    thing: Any = hersey
    for i, name in enumerate(parts):
        if not hasattr(thing, name):
            try:
                thing = importlib.import_module(".".join(("hersey", *parts[: i + 1])))
            except ImportError:
                return False
        else:
            thing = getattr(thing, name)
    return True


def tracked() -> list[Path]:
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [ROOT / line for line in listed.stdout.splitlines() if (ROOT / line).is_file()]


def test_the_repository_names_no_machine_and_no_registry() -> None:
    hosts = [
        "crates" + ".io",
        "pypi" + ".org",
        "npmjs" + ".org",
        "pythonhosted" + ".org",
        "/ro" + "ot/",
        "/wo" + "rk/",
    ]
    for path in tracked():
        if path.suffix in {".csv", ".png"}:
            continue
        text = path.read_bytes()
        for host in hosts:
            assert host.encode() not in text, f"{path.name} names {host}"


def test_the_lists_of_slow_and_lasting_tests_name_none_that_is_gone() -> None:
    for line in (line for starts in LISTED.values() for line in starts):
        path, _, test = line.partition("::")
        assert (ROOT / path).exists(), line
        assert not test or f"def {test}" in (ROOT / path).read_text(), line


def test_files_have_one_subject() -> None:
    for path in tracked():
        if path.suffix in {".py", ".rs", ".js"}:
            assert len(path.read_text().splitlines()) <= 720, f"{path.name} is long: split it"
            assert not re.fullmatch(r"(utils?|helpers?|misc|common)", path.stem)


def test_planted_faults_are_drawn_by_a_seed_and_counted() -> None:
    lines = [
        "    hersey.damping.design.x_design__mutmut_1: not checked",
        "    hersey.damping.design.xǁTestDesignǁsummary__mutmut_2: not checked",
        "    hersey.verdict.regimes.x_judged__mutmut_1: not checked",
        "something else",
    ]
    faults = named(lines)
    assert {module: len(each) for module, each in faults.items()} == {
        "hersey.damping.design": 2,
        "hersey.verdict.regimes": 1,
    }
    assert len(sample(faults, [], 1, 1)) == 2
    assert sample(faults, ["hersey.verdict.*"], 9, 1) == ["hersey.verdict.regimes.x_judged__mutmut_1"]
    assert files_for("hersey.damping.candidates.energy", ROOT)[0] == "tests/damping/candidates/test_energy.py"
    outcomes = {"hersey.damping.design": Counter({True: 3, False: 1})}
    assert table(outcomes).endswith("3 of     4 seen, 75%")
