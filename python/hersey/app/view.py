"""What the page shows of an analysis, JSON."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from hersey.app.analysis import Analysis, Dropped
from hersey.app.channels import UNITS
from hersey.app.machine import POINT_FIELDS, kept_beside

#: Channels that the page shows of a log at the most, those with a role first.
_SHOWN = 200


def line_of(one: Analysis) -> dict[str, Any]:
    """Return what the list shows."""
    course = one.course if one.state == "running" else None
    left = None if course is None or course.ends is None else course.ends - time.monotonic()
    plain = ("id", "name", "state", "step", "share", "report", "saved", "finished", "reason", "revision")
    return {name: getattr(one, name) for name in plain} | {
        "spent": None if course is None else time.monotonic() - course.began,
        "left": left if left is not None and left > 1.0 else None,
        "signal": one.result.get("signal", ""),
        "words": one.result.get("words", ""),
        "map": one.result.get("map"),
        "faults": len(one.faults),
        "ready": bool(one.logs) and not one.faults and not one.waiting,
    }


def view_of(one: Analysis) -> dict[str, Any]:
    """Return all that the page shows of it."""
    logs = one.logs
    look = logs[0].look if logs else None
    return line_of(one) | {
        "files": [_file_view(file) for file in one.files.values()],
        "beside": sorted(one.beside),
        "pair": [{"id": f.id, "name": f.name} for f in logs] if len(logs) == 2 else [],
        "mapping_kept": kept_beside([], one.mapping_others),
        "log": None if look is None else {key: look[key] for key in ("name", "means", "own_clock")},
        "channels": [] if look is None else _channels(one, look),
        "hidden": 0 if look is None else max(0, len(look["channels"]) - _SHOWN),
        "units": UNITS,
        "corrections": one.corrections,
        "options": one.options,
        "machine": {
            "mode": one.mode,
            "answers": one.answers,
            "points": [{key: point.get(key, "") for key in POINT_FIELDS} for point in one.points],
            "kept": kept_beside(one.points, one.machine_others),
            "text": one.text,
            "blank": not one.machine_file().strip(),
        },
        "all_faults": [asdict(fault) | {"key": fault.key} for fault in one.faults],
    }


def _channels(one: Analysis, look: Mapping[str, Any]) -> list[dict[str, Any]]:
    rates = {clock["name"]: clock["interval"] for clock in look["clocks"]}
    rows = [
        {
            **{key: channel[key] for key in ("name", "written", "low", "high", "preview", "warnings")},
            "column": column,
            "proposed": channel["unit"],
            "interval": rates.get(channel["name"]),
            **one.choices[channel["name"]],
        }
        for column, channel in enumerate(look["channels"], 1)
    ]
    if len(rows) > _SHOWN:
        rows.sort(key=lambda row: not row["role"])
        rows = rows[:_SHOWN]
    return rows


def _file_view(file: Dropped) -> dict[str, Any]:
    look = file.look
    clock: dict[str, Any] = next(iter(look.get("clocks", [])), {})
    plain = ("id", "name", "size", "total", "received", "state", "fault")
    return {name: getattr(file, name) for name in plain} | {
        "rows": look.get("rows"),
        **{name: clock.get(name) for name in ("duration", "gaps", "lost")},
        "cut_off": look.get("cut_off", False),
        "means": look.get("means", False),
    }
