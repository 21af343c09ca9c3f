"""What is said of a log and cannot be applied to a table of means: refused."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from hersey.errors import ParameterError, Setting


def refuse_corrections(stated: bool, name: str, by_hand: Sequence[str]) -> None:
    """Refuse corrections of a mapping, or of options given by hand: they are made on a trace."""
    if stated and by_hand:
        given = " and ".join(by_hand)
        raise ParameterError(
            f"{given} cannot be applied to a table of means. Correct the values in it, and omit {given}"
        )
    if stated:
        raise ParameterError(
            f"{name} contains corrections (signs, tare, gears, lag), which cannot be applied to a table "
            "of means. Correct the values in the table, and name only its columns in the mapping"
        )


def refuse_sources(mapping: Any, given: Mapping[str, Any], channels: Mapping[str, str]) -> None:
    """Refuse what stands in the place of a column of a log: in a mapping, or given by hand."""
    options = ("name_pattern", "run_table", "schedule", "position_window")
    stated = {
        "[names] pattern": mapping.names.pattern,
        "[names] table": mapping.names.table,
        "[[schedule]]": mapping.schedule,
        "[direction] channel": mapping.direction.channel,
        "[position] channel": mapping.position.channel,
    }
    named = [
        *(Setting(name).to() for name in options if given.get(name)),
        *(Setting(role, "channel").to() for role in ("direction", "position") if role in channels),
        *(f"{key} in {mapping.source and mapping.source.name}" for key, value in stated.items() if value),
    ]
    if named:
        raise ParameterError(
            "a table of means holds its speed, sign and load as columns. Write them there, and omit "
            f"{' and '.join(named)}"
        )
