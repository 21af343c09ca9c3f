"""Where options and mappings hold for several logs, and one needs others: what to write beside it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from hersey.errors import MAPPING, SIGN, HerseyError, followed_by

if TYPE_CHECKING:
    from hersey.damping.recipe import Recipe

#: What stands in a mapping for a value that is not known, by the kind of setting, which is its key.
_VALUES = {"channel": "NAME", "unit": "UNIT"}


def for_this_log_only(
    error: HerseyError, log: Path, recipe: Recipe, others: Sequence[Path] = ()
) -> HerseyError:
    """Let the advice on a log begin with how its setting is stated for this log and not for the ``others``.

    Where another log states its own unit, an option would replace that, so the option is not proposed.
    """
    from hersey.files.toml import quoted

    other = others[0] if len(others) == 1 else None
    setting = error.setting
    if setting is None or other == log:
        return error
    role, key = ("torque", "sign = -1") if setting == SIGN else (setting.name, "")
    if setting.kind in _VALUES:
        key = f'{setting.kind} = "{error.likely or _VALUES[setting.kind]}"'
    if not key or (setting == SIGN and recipe.are_means):  # whose signs no mapping flips
        return error
    given = {"channel": recipe.channels, "unit": recipe.units}.get(setting.kind, recipe.signs)
    alone = setting.kind == "unit" and bool(error.likely) and role not in given
    if alone and any(_states_unit(each, role) for each in others):
        error.remedy = f"write {key} under [{role}] in {mapping_of_log(log)}, or correct the header"
        return error
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
        how = f"if only {log.name} needs it, write {key} under [{role}] in {mapping_of_log(log)}"
    else:
        return error
    error.remedy = followed_by(how, f"otherwise: {error.remedy}" if error.remedy else "")
    return error


def _own_mapping(log: Path) -> Path:
    """The path of a mapping that holds for a log alone."""
    return log.with_name(f"{log.stem}.hersey.toml")


def _states_unit(log: Path, role: str) -> bool:
    """Whether a log, or its mapping, states a unit of a role that can be read."""
    from hersey.log.channels import ChannelChoice, find_channel
    from hersey.log.mapping import mapping_of
    from hersey.log.reading import list_channels
    from hersey.log.text.column import Column

    try:
        stated = mapping_of([log])
        columns = tuple(Column(i, name, unit) for i, (name, unit) in enumerate(list_channels(log)))
        choice = ChannelChoice(stated.channels.get(role, ""), stated.units.get(role, ""))
        return find_channel(role, columns, choice, log.name) is not None
    except HerseyError:
        return False


def mapping_of_log(log: Path) -> str:
    """Return where to write what holds for a log alone."""
    from hersey.log.mapping import find_mapping

    alone, found = _own_mapping(log), find_mapping(log)
    return f"{alone}" if found in (None, alone) else f"a copy of {found}, {alone}"
