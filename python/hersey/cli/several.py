"""Where options hold for several logs, and one of them needs another: what to write beside it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from hersey.errors import SIGN, HerseyError, followed_by

if TYPE_CHECKING:
    from hersey.damping.recipe import Recipe

#: What stands in a mapping for a value that is not known, by the kind of setting, which is its key.
_VALUES = {"channel": "NAME", "unit": "UNIT"}


def for_this_log_only(
    error: HerseyError, log: Path, recipe: Recipe, others: Sequence[Path] = ()
) -> HerseyError:
    """Add to an error of a log how a setting is stated for this log and not for the ``others``.

    Where another log states its own unit, an option would replace that, so the option is not proposed.
    """
    setting = error.setting
    if setting is None or recipe.mapping is not None:
        return error
    role, key = ("torque", "sign = -1") if setting == SIGN else (setting.name, "")
    if setting.kind in _VALUES:
        key = f'{setting.kind} = "{error.likely or _VALUES[setting.kind]}"'
    if not key or (setting == SIGN and recipe.are_means):  # whose signs no mapping flips
        return error
    given = {"channel": recipe.channels, "unit": recipe.units}.get(setting.kind, recipe.signs)
    place = f"write {key} under [{role}] in"
    alone = setting.kind == "unit" and bool(error.likely) and role not in given
    if alone and any(_states_unit(each, role) for each in others):
        error.remedy = f"{place} {_mapping_of(log)}, or correct the header"
        return error
    if role not in given:
        how = f"If only {log.name} needs it, {place} {_mapping_of(log)} instead"
    else:
        omit = "" if setting == SIGN else f"omit {setting.to()} and "
        how = f"If only another log needs it, {omit}{place} NAME.hersey.toml beside that log, NAME.csv"
    error.remedy = followed_by(error.remedy, how)
    return error


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


def _mapping_of(log: Path) -> str:
    """The mapping that holds for a log alone."""
    from hersey.log.mapping import find_mapping

    alone = log.with_name(f"{log.stem}.hersey.toml")
    found = find_mapping(log)
    return f"{alone}" if found in (None, alone) else f"a copy of {found}, {alone},"
