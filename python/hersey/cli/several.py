"""Where options and mappings hold for several logs, and one needs others: what to write beside it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from hersey.errors import MAPPING, SIGN, HerseyError, followed_by

if TYPE_CHECKING:
    from hersey.damping.recipe import Recipe

#: What to write in a mapping for a setting of a kind.
_KEYS = {"channel": 'channel = "NAME"', "unit": 'unit = "UNIT"'}


def for_this_log_only(
    error: HerseyError, log: Path, recipe: Recipe, other: Path | None = None
) -> HerseyError:
    """Let the advice on a log begin with how its setting is stated for this log and not for the others.

    ``other`` is the only other log, if there is one.
    """
    from hersey.files.toml import quoted

    setting = error.setting
    if setting is None or other == log:
        return error
    role, key = ("torque", "sign = -1") if setting == SIGN else (setting.name, _KEYS.get(setting.kind, ""))
    if not key or (setting == SIGN and recipe.are_means):  # whose signs no mapping flips
        return error
    given = {"channel": recipe.channels, "unit": recipe.units}.get(setting.kind, recipe.signs)
    mapping = recipe.chosen
    stated = {"channel": mapping.channels, "unit": mapping.units}.get(setting.kind, {})
    another = other.name if other else "another log"
    there = f"{_own_mapping(other)}" if other else "NAME.hersey.toml beside that log, NAME.csv"
    if role in given:
        value = str(given[role])
        key = key if setting == SIGN else f"{setting.kind} = {quoted(value)}"
        omit = f"omit {setting.to('-1' if setting == SIGN else '')} and "
        how = f"if only {another} needs it, {omit}write {key} under [{role}] in {there}"
    elif role in stated and mapping.source != _own_mapping(log):
        do = f"omit {MAPPING.to()} and copy it to" if recipe.mapping else "rename it to"
        how = f"if {mapping.source} is for {another} only, {do} {there}"
    elif recipe.mapping is None:
        how = f"if only {log.name} needs it, write {key} under [{role}] in {_mapping_of(log)}"
    else:
        return error
    otherwise = f"otherwise, {error.remedy}" if error.remedy[:1].islower() else error.remedy
    error.remedy = followed_by(how, otherwise)
    return error


def _own_mapping(log: Path) -> Path:
    """The path of a mapping that holds for a log alone."""
    return log.with_name(f"{log.stem}.hersey.toml")


def _mapping_of(log: Path) -> str:
    """Where to write what holds for a log alone."""
    from hersey.log.mapping import find_mapping

    alone, found = _own_mapping(log), find_mapping(log)
    return f"{alone}" if found in (None, alone) else f"a copy of {found}, {alone}"
