"""No belt, roll, rubber or paper in the words of other machines: results use the word of the machine file."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from tests.conftest import ROOT

PACKAGE = ROOT / "python" / "hersey"
#: Words of one machine only; names in code, such as ``roll_radius``, hold them as parts.
FOREIGN = re.compile(r"(?<![\w*.-])(?:belts?|rolls?|rubber|papers?)(?![\w-])", re.IGNORECASE)
#: Strings that hold one and are no words of a result: identifiers, and columns of tables.
NAMES = {
    "belt",
    "roll",
    "rubber",
    "paper",
    "belt speed",
    "belt speed (m/s)",
    "roll (K)",
    "roll slips",
    "roll drives the motor",
    "belt not started",
    "belt may not start",
    "time [s],drive speed [m/s],temperature [degC],roll [degC]",
}
#: Modules with words for belts alone: what is asked of a machine file that names a belt, and the shipped
#: one; and the names of the slide-roll ratio.
OF_BELTS = {
    "study/first_screen/flags.py": {
        "the grip of the roll is not stated and therefore not in the model",
        "The roll may slip at the start",
    },
    "study/first_screen/missing.py": {
        "roll_friction = 0.6            # enter yours: friction of the belt on the roll\n",
        "whether the roll slips on the belt at the start",
        "roll_friction = 0.6   # enter yours: friction of the belt on the roll\n",
        "belt and heater",
    },
    "testbench/drive.py": {"thick paper"},
    "log/rolling.py": {r".*\bsrr\b.*|.*(slide|slip)[- ]?(to[- ]?)?roll.*|.*\bslip ratio.*"},
}


def strings(path: Path) -> Iterator[str]:
    """The strings of a module that are no docstrings."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    statements = [node.value for node in ast.walk(tree) if isinstance(node, ast.Expr)]
    docstrings = {id(each) for each in statements if isinstance(each, ast.Constant)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docstrings:
            yield node.value


def test_no_word_of_the_package_is_that_of_one_machine() -> None:
    found = {
        (place, text)
        for path in PACKAGE.rglob("*.py")
        for text in strings(path)
        if FOREIGN.search(text) and text not in NAMES
        for place in [path.relative_to(PACKAGE).as_posix()]
        if text not in OF_BELTS.get(place, ())
    }
    assert found == set()


def test_no_word_of_a_page_is_that_of_one_machine() -> None:
    scripts = [*PACKAGE.glob("report/static/*.js"), *PACKAGE.glob("app/static/*.js")]
    texts = [
        literal
        for script in scripts
        for line in script.read_text(encoding="utf-8").splitlines()
        if not line.lstrip().startswith(("//", "/*", "*"))
        for literal in re.findall(r'"[^"]*"|`[^`]*`', line)
    ]
    texts += [path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.html")]
    texts.append((PACKAGE / "report" / "glossary.toml").read_text(encoding="utf-8"))
    assert [text for text in texts if FOREIGN.search(text) and text.strip('"`') not in NAMES] == []
