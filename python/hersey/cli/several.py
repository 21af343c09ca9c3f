"""Where options hold for several logs, and one of them needs another: what to write beside it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from hersey.errors import SIGN, HerseyError, followed_by

if TYPE_CHECKING:
    from hersey.damping.recipe import Recipe

#: What to write in a mapping for a setting of a kind.
_KEYS = {"channel": 'channel = "NAME"', "unit": 'unit = "UNIT"'}


def for_this_log_only(error: HerseyError, log: Path, recipe: Recipe) -> HerseyError:
    """Add to an error of a log how a setting is stated for this log and not for the others."""
    setting = error.setting
    if setting is None or recipe.mapping is not None:
        return error
    role, key = ("torque", "sign = -1") if setting == SIGN else (setting.name, _KEYS.get(setting.kind, ""))
    if not key or (setting == SIGN and recipe.are_means):  # whose signs no mapping flips
        return error
    given = {"channel": recipe.channels, "unit": recipe.units}.get(setting.kind, recipe.signs)
    place = f"write {key} under [{role}] in"
    if role not in given:
        how = f"If only {log.name} needs it, {place} {_mapping_of(log)} instead"
    else:
        omit = "" if setting == SIGN else f"omit {setting.to()} and "
        how = f"If only another log needs it, {omit}{place} NAME.hersey.toml beside that log, NAME.csv"
    error.remedy = followed_by(error.remedy, how)
    return error


def _mapping_of(log: Path) -> str:
    """The mapping that holds for a log alone."""
    from hersey.log.mapping import find_mapping

    alone = log.with_name(f"{log.stem}.hersey.toml")
    found = find_mapping(log)
    return f"{alone}" if found in (None, alone) else f"a copy of {found}, {alone},"
