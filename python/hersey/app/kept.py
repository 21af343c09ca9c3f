"""Reports that earlier starts have kept: found again, each with its decision and a small map."""

from __future__ import annotations

import json
import re
import secrets
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

#: Number of reports listed, the newest first; largest size of one, bytes.
_LISTED, _LARGEST = 20, 20_000_000
#: The analysis document inside a report.
_DOCUMENT = re.compile(r'<script type="application/json" id="document">(.*?)</script>', re.DOTALL)
#: Most columns of a small map, and most characters of a sentence.
_COLUMNS, _LONGEST = 24, 400
_EDGES = ("lower", "transition", "upper")


@dataclass(frozen=True)
class Kept:
    """A report of an earlier start: where it is, its log, when it was made, and what it decided."""

    path: Path
    report: str  #: its number in the address
    name: str
    saved: str
    finished: str
    signal: str
    words: str
    map: dict[str, Any] | None

    def line(self) -> dict[str, Any]:
        """Return what the list shows."""
        fields = ("report", "name", "saved", "finished", "signal", "words", "map")
        return {field: getattr(self, field) for field in fields}


def kept_reports(folder: Path) -> list[Kept]:
    """Return the reports of hersey in a folder, the newest first; other files are skipped."""
    found: list[tuple[float, Path]] = []
    with suppress(OSError):
        for path in folder.glob("*.html"):
            with suppress(OSError):
                if path.is_file() and not path.is_symlink() and path.stat().st_size <= _LARGEST:
                    found.append((path.stat().st_mtime, path))
    reports = []
    for made, path in sorted(found, reverse=True)[:_LISTED]:
        with suppress(OSError, ValueError, TypeError, AttributeError, KeyError, RecursionError):
            reports.append(_read(path, made, folder.name))
    return reports


def _read(path: Path, made: float, folder: str) -> Kept:
    block = _DOCUMENT.search(path.read_text(encoding="utf-8"))
    if block is None:
        raise ValueError(path.name)
    document = json.loads(block[1])
    summary = summary_of(document.get("decision"), document.get("map"))
    return Kept(
        path=path,
        report=secrets.token_urlsafe(12),
        name=str(document["title"])[:_LONGEST],
        saved=f"{folder}/{path.name}",
        finished=time.strftime("%d %b %Y, %H:%M", time.localtime(made)),
        signal=summary["signal"],
        words=summary["words"],
        map=summary["map"],
    )


def summary_of(decision: Mapping[str, Any] | None, map_: Mapping[str, Any] | None) -> dict[str, Any]:
    """Return signal, words and small map of a report, from its document as JSON."""
    said = decision or {}
    signal = said.get("signal", "")
    return {
        "signal": signal if signal in ("good", "watch", "act") else "",
        "words": str(said.get("instruction") or said.get("lead", ""))[:_LONGEST],
        "map": None if map_ is None else small_map(map_, said.get("points", [])),
    }


def small_map(map_: Mapping[str, Any], points: list[Mapping[str, Any]]) -> dict[str, Any]:
    """Return edges (m/s) at a few temperatures (K), the range of speeds, and the operating points."""
    temperatures = map_["temperature"] or [0.0]
    step = max(1, -(-len(temperatures) // _COLUMNS))
    columns = sorted({*range(0, len(temperatures), step), len(temperatures) - 1})
    return {
        "temperature": [_number(temperatures[i]) for i in columns],
        "speed": [_number(map_["speed"][0]), _number(map_["speed"][-1])],
        **{name: [_number(map_[name][i]) for i in columns] for name in _EDGES},
        "points": [
            [_number(point["temperature"]), _number(point["speed"]), str(point["signal"])] for point in points
        ],
    }


def _number(value: Any) -> float | None:
    return None if value is None else float(f"{float(value):.4g}")
