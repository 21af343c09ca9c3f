"""Names that the package does not have: each is refused with the name to write."""

from __future__ import annotations

import importlib
import re
import subprocess
import sys

import pytest

import hersey
from hersey.cli.application import PANELS

COMMANDS = [name for panel in PANELS.values() for name in panel]


def refused(name: str) -> str:
    """What Python prints of the error, at its end."""
    done = subprocess.run(
        [sys.executable, "-c", f"import hersey; hersey.{name}"], capture_output=True, text=True, check=False
    )
    return done.stderr.strip().rpartition("\n")[2]


def advised(name: str) -> str:
    """The advice for a name, which is public."""
    with pytest.raises(AttributeError) as error:
        getattr(hersey, name)
    said = re.fullmatch(rf"hersey has no '{name}'\. (.*)", str(error.value))
    assert said is not None
    return said[1]


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_is_a_function_or_says_which_one_to_use(command: str) -> None:
    """In a process of its own: a room that is loaded is an attribute of its name."""
    if command in hersey.__all__:
        return
    said = refused(command)
    if used := re.fullmatch(
        rf"AttributeError: hersey has no '{command}'\. Use (hersey\.\S+)\(\.\.\.\)", said
    ):
        assert callable(eval(used[1]))
    else:
        assert said == f"AttributeError: hersey has no '{command}'. In a terminal, type: hersey {command}"


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("reed", "read"),
        ("inspct", "inspect"),
        ("operatingmap", "operating_map"),
        ("identify_drive", "identify"),
        ("Machin", "Machine"),
        ("warm_upp", "warm_up"),
    ],
)
def test_a_misspelt_name_gets_the_nearest(name: str, meant: str) -> None:
    assert advised(name) == f"Did you mean hersey.{meant}?"
    assert callable(getattr(hersey, meant))


def test_a_room_that_is_not_loaded_says_how_to_load_it() -> None:
    said = refused("exchange")
    assert said == "AttributeError: hersey has no 'exchange'. Load it: import hersey.exchange"
    assert importlib.import_module("hersey.exchange")


def test_a_name_like_no_other_points_to_the_list() -> None:
    assert advised("qqq") == "dir(hersey) lists the names it has"
    assert not hasattr(hersey, "__wrapped__")


def test_a_room_is_imported_without_a_search_for_names() -> None:
    code = "from hersey import lubrication; import sys; print('difflib' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"
