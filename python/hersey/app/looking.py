"""What the page shows of a file: clocks, channels with previews, proposed roles and units, faults."""

from __future__ import annotations

import itertools
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import HerseyError, UnreadableLogError
from hersey.inspection.file_report import ChannelReport, file_report
from hersey.inspection.raw import Lacking, RawLog, raw_channels
from hersey.log.channels import ChannelChoice, Stated, find_channel, is_dead
from hersey.log.layouts.current import reading_by
from hersey.log.layouts.proposing import Proposal, proposed_layout
from hersey.log.layouts.table import LogLayout
from hersey.log.mapping import LogMapping, read_with_mapping
from hersey.log.mean_signs import is_means_table
from hersey.log.roles import OTHER_ROLES, ROLES, is_called
from hersey.log.stating import proposed
from hersey.log.text.column import Column, distinct_names

#: Columns of a preview: each shows the least and the greatest of its rows.
_COLUMNS = 75


def look(path: Path) -> dict[str, Any]:
    """Return a file as the page shows it, JSON; see `hersey.inspection` for what is found.

    A file that is no log as it stands is shown by the layout that is proposed for it, if there is one.

    Raises
    ------
    HerseyError
        If it is no log.
    """
    try:
        seen = _seen(path, None)
    except HerseyError:
        if (proposal := proposed_layout(path)) is None:
            raise
        return _seen(path, proposal)
    if (seen["without"] or seen["problem"]) and (proposal := proposed_layout(path)):
        return _seen(path, proposal)
    return seen


def _seen(path: Path, proposal: Proposal | None) -> dict[str, Any]:
    """A file as it stands, or by a layout."""
    if proposal is None:
        return _look(path, None)
    with reading_by(proposal.layout):
        seen = _look(path, proposal.layout)
    return seen | {
        "layout": tomllib.loads(proposal.layout.toml())["layout"],
        "channels": [
            channel | {"role": "run"} if channel["name"] == proposal.channels.get("run") else channel
            for channel in seen["channels"]
        ],
    }


def _look(path: Path, layout: LogLayout | None) -> dict[str, Any]:
    log = raw_channels(path)
    if not log.channels:
        raise UnreadableLogError(f"{log.name} holds no channel of numbers")
    choices = {role: ChannelChoice() for role in (*ROLES, *OTHER_ROLES)}
    report = file_report(log, choices, Stated())
    names = distinct_names([channel.column for channel in log.channels])
    units = _units(log)
    means = layout is None and is_means_table(path, {}, {})
    without = {role: why for role, why in report.lacking.items() if not (means and role == "time")}
    found = {channel.role: name for channel, name in zip(report.channels, names, strict=True) if channel.role}
    return {
        "name": log.name,
        "format": log.format,
        "means": means,
        "rows": report.rows,
        "cut_off": log.cut_off,
        "warnings": [each.to_dict() for each in log.warnings],
        "clocks": [_clock(clock) for clock in report.clocks],
        "own_clock": any(channel.clock is not None for channel in log.channels),
        "channels": [
            _channel(shown, name, units.get(shown.role, ""), channel.values)
            for shown, name, channel in zip(report.channels, names, log.channels, strict=True)
        ],
        "without": {role: why.text for role, why in without.items()},
        "reasons": {role: why.reason or why.text for role, why in without.items()},
        "claims": {role: _claims(role, log, names, why) for role, why in without.items()},
        "problem": {} if without or means else _problem(path, layout),
        "found": found,
    }


def _units(log: RawLog) -> dict[str, str]:
    """The unit in which each role would be read; a channel name may contain it."""
    columns = tuple(channel.column for channel in log.channels)
    values = {channel.column: channel.values for channel in log.channels}
    units = {}
    for role in ROLES:
        try:
            found = find_channel(
                role, columns, ChannelChoice(), log.name, lambda column: is_dead(values[column])
            )
        except HerseyError:
            continue
        if found is not None:
            units[role] = found[1].unit
    return units


def _claims(role: str, log: RawLog, names: list[str], why: Lacking) -> list[str]:
    """The channels that come near a role; one that is called a radius or a load does not."""
    return [
        name
        for channel, name in zip(log.channels, names, strict=True)
        if channel.column.index in why.columns and not _is_other(role, channel.column)
    ]


def _is_other(role: str, column: Column) -> bool:
    """Whether a channel is called a radius or a load, and not like the role."""
    called = any(proposed(other, (column,)) for other in ("radius", "load"))
    return called and role in ROLES and not is_called(role, column)


def _clock(clock: Any) -> dict[str, Any]:
    return {
        "name": clock.name,
        "interval": _finite(clock.interval),
        "duration": _finite(clock.duration),
        "gaps": clock.gaps,
        "lost": _finite(clock.lost),
        "warnings": [each.to_dict() for each in clock.warnings],
    }


def _channel(report: ChannelReport, name: str, unit: str, values: FloatArray) -> dict[str, Any]:
    traits = report.traits
    known = values[np.isfinite(values)]
    return {
        "name": name,
        "unit": unit or report.unit,
        "written": report.unit,
        "role": report.role,
        "low": _finite(traits.low),
        "high": _finite(traits.high),
        "median": _finite(traits.median),
        "most": _finite(float(np.quantile(known, 0.99))) if known.size else None,
        "missing": traits.missing,
        "rows": traits.rows,
        "dead": is_dead(values),
        "warnings": [each.to_dict() for each in report.warnings],
        "preview": preview(values),
    }


def preview(values: FloatArray) -> list[list[float]]:
    """Return the least and the greatest of each part of a channel, as shares of its range.

    Each is ``[place, low, high]``, all between 0 and 1; parts without a number are left out.
    """
    known = np.isfinite(values)
    if not known.any():
        return []
    low, high = float(values[known].min()), float(values[known].max())
    span = (high - low) or 1.0
    out = []
    edges = np.linspace(0, values.size, min(_COLUMNS, values.size) + 1).astype(int)
    for start, end in itertools.pairwise(edges):
        part = values[start:end]
        part = part[np.isfinite(part)]
        if part.size:
            ends = (float(part.min()) - low) / span, (float(part.max()) - low) / span
            place = (start + end) / 2 / values.size
            out.append([round(place, 4), *(round(min(max(e, 0.0), 1.0), 3) for e in ends)])
    return out


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _problem(path: Path, layout: LogLayout | None) -> dict[str, Any]:
    """Why the file cannot be read as a log of torque, as data; empty if it can."""
    try:
        read_with_mapping([path], mapping=LogMapping(layout=layout))
    except HerseyError as error:
        return error.to_dict()
    return {}
