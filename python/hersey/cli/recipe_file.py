"""A recipe file as options of a command, each setting as it would be typed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from hersey.cli.quantities import amounts_in
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.damping.recipe import Recipe

#: Roles that have an option for the column, for its unit and for the sign.
ROLES = ("time", "torque", "speed", "temperature", "load", "radius", "position", "run", "direction")
_WITH_UNIT, _WITH_SIGN = ROLES[:-2], ("torque", "speed")
#: Tables of a recipe by role: the ending of the option, and the roles that have it.
_TABLES = {"channels": ("", ROLES), "units": ("_unit", _WITH_UNIT), "signs": ("_sign", _WITH_SIGN)}
#: Options that are a plain number.
_PLAIN = ("gear_ratio", "speed_gear_ratio")


def read_recipe(path: Path) -> tuple[list[Path], dict[str, Any]]:
    """Return the logs that a recipe file names, and its settings by the names of the options.

    Raises
    ------
    HerseyError
        If the file is not a recipe, or has a setting that no option has.
    """
    from hersey.damping.recipe import Recipe

    recipe = Recipe.from_file(path)
    return list(recipe.logs), _options(recipe, path.name)


def _options(recipe: Recipe, file: str) -> dict[str, Any]:
    """The settings of a recipe, as values of options."""
    stated = recipe.stated()
    stated.pop("logs", None)
    _refuse_unclear(stated, file)
    error = stated.pop("inertia_error", None)
    out: dict[str, Any] = {}
    for table, (ending, roles) in _TABLES.items():
        for role, value in stated.pop(table, {}).items():
            if role not in roles:
                raise ParameterError(f"{file}: {table}.{role}: use one of {', '.join(roles)}")
            out[role + ending] = value
    out |= {name: _typed(name, value) for name, value in stated.items()}
    if error and "inertia" in out:
        out["inertia"] += f" ± {_typed('inertia', error)}"
    return out


def _refuse_unclear(stated: dict[str, Any], file: str) -> None:
    """Refuse a column together with an amount, and a column whose name looks like an amount."""
    for role in ("load", "radius"):
        column = stated.get("channels", {}).get(role, "")
        if column and role in stated:
            raise ParameterError(f"{file}: {role} and channels.{role} both state the {role}: delete one")
        if amounts_in(column):
            raise ParameterError(
                f"{file}: channels.{role} is '{column}', which --{role} reads as an amount: rename the column"
            )


def _typed(name: str, value: Any) -> Any:
    """A setting as the value of its option."""
    from hersey.damping.recipe import AMOUNTS
    from hersey.units import KINDS

    if name in AMOUNTS:
        values = value if isinstance(value, tuple) else (value,)
        return ", ".join(f"{each!r} {KINDS[AMOUNTS[name]][0]}" for each in values)
    return str(value) if isinstance(value, Path) or name in _PLAIN else value
