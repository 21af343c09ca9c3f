"""A recipe that was dropped: its options, if the page has a control for each.

No file that it names is looked for: the logs of an analysis are those that were dropped.
"""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Any

from hersey.damping.recipe import Recipe
from hersey.errors import HerseyError
from hersey.files.toml import read_toml
from hersey.log.roles import OTHER_ROLES, ROLES

#: Settings that are options of the page.
_OPTIONS = ("isothermal", "drop_missing", "tare")
#: What only a recipe says at its top; a mapping has tables of roles there.
_KEYS = {field.name for field in fields(Recipe)} - {*ROLES, *OTHER_ROLES}


def options_of_recipe(path: Path, *, mapped: bool) -> dict[str, Any] | None:
    """Return the options that a recipe states, all of them, or None if the file is no recipe.

    Parameters
    ----------
    mapped
        Whether a mapping was dropped before.

    Raises
    ------
    HerseyError
        If it has a mistake, states what the page cannot hold, or names a mapping that is not here.
    """
    if not _KEYS & read_toml(path).keys():
        return None
    stated = Recipe.from_file(path).stated()
    if others := sorted(stated.keys() - {"logs", "mapping", *_OPTIONS}):
        raise HerseyError(
            f"the app has no control for {', '.join(others)} of this recipe: run hersey report with it in a "
            "terminal"
        )
    if "mapping" in stated and not mapped:
        raise HerseyError(
            f"this recipe needs the mapping {stated['mapping'].name}: drop that file, then the recipe again"
        )
    usual = Recipe()
    if (tare := stated.get("tare", usual.tare)) not in ("none", "standing"):
        raise HerseyError(f"tare is '{tare}': write none or standing")
    return {name: stated.get(name, getattr(usual, name)) for name in _OPTIONS}
