"""What a report says, read from its JSON document, or from its sentences where the document is older."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

Corners = tuple[tuple[float, float], ...]

_KELVIN = 273.15
_NUMBER = r"([\d.]+)"


@dataclass(frozen=True)
class Plan:
    """A start-up plan: corners (s, m/s) of the drive speed, and when the belt is to slide for good."""

    corners: Corners
    ready: float


@dataclass(frozen=True)
class PointSaid:
    """What is said of an operating point."""

    words: str
    verdict: str
    plan: Plan | None


@dataclass(frozen=True)
class Said:
    """What a decision says: m/s and degC; None for what it does not say."""

    instruction: str
    temperature: float | None
    safe_speed: float | None
    fold: tuple[float, float] | None  #: 95 % interval of V*
    measurement: str | None  #: kind of the measurement that it asks for
    points: tuple[PointSaid, ...]


def read(document: dict[str, Any]) -> Said:
    """Return what the decision of a document says."""
    decision = document.get("decision") or {}
    instruction = decision.get("instruction") or ""
    measurement = decision.get("measurement")
    return Said(
        instruction,
        _temperature(decision, instruction),
        _safe_speed(decision, instruction),
        _fold(decision),
        measurement.get("kind", "unnamed") if measurement else None,
        tuple(_point(part) for part in decision.get("points") or []),
    )


def _temperature(decision: dict[str, Any], instruction: str) -> float | None:
    if "temperature" in decision:
        kelvin = decision["temperature"]
        return None if kelvin is None else kelvin - _KELVIN
    named = re.search(rf"[Aa]t {_NUMBER} °C", instruction)
    return float(named[1]) if named else None


def _safe_speed(decision: dict[str, Any], instruction: str) -> float | None:
    if "safe_speed" in decision:
        speed: float | None = decision["safe_speed"]
        return speed
    above = re.search(rf"run above {_NUMBER} mm/s", instruction, re.IGNORECASE)
    return 1e-3 * float(above[1]) if above else None


def _fold(decision: dict[str, Any]) -> tuple[float, float] | None:
    if "fold" in decision:
        fold = decision["fold"] or {}
        low, high = fold.get("low"), fold.get("high")
        return None if low is None or high is None else (low, high)
    text = decision.get("interval") or ""
    found = re.search(rf"V\* is {_NUMBER} \[{_NUMBER}, {_NUMBER}\]", text)
    ends = found.groups()[1:] if found else ()
    if not ends and (span := re.search(rf"V\* is {_NUMBER} to {_NUMBER} mm/s", text)):
        ends = span.groups()
    return (1e-3 * float(ends[0]), 1e-3 * float(ends[1])) if ends else None


def _point(part: dict[str, Any]) -> PointSaid:
    words = part.get("words") or ""
    return PointSaid(words, part.get("verdict") or _verdict(words), _plan(part.get("plan")))


def _verdict(words: str) -> str:
    """Return the verdict that the words of an older document amount to."""
    if "smooth from any start" in words:
        return "smooth"
    if words.startswith(("smooth", "slides on", "depends")):
        return "depends"
    return next((verdict for verdict in ("sticks", "not started") if words.startswith(verdict)), "unknown")


def _plan(plan: dict[str, Any] | None) -> Plan | None:
    """Return the plan of a point, if there is one and it was found."""
    if not plan or plan.get("found") is False:
        return None
    corners = _corners(plan.get("rows") or plan.get("schedule") or ())
    if not corners:
        return None
    ready = plan.get("duration")
    return Plan(corners, corners[-1][0] if ready is None else ready)


def _corners(schedule: Any) -> Corners:
    """Return corners of a schedule: rows of time and drive speed, or columns of them."""
    if isinstance(schedule, dict):
        if rows := schedule.get("rows"):
            return _corners(rows)
        speeds = next((schedule[key] for key in ("drive_speed", "speed", "speeds") if key in schedule), ())
        times = schedule.get("time") or schedule.get("times") or ()
        return tuple(zip(times, speeds, strict=True))
    if schedule and not isinstance(schedule[0], dict):
        return tuple((float(time), float(speed)) for time, speed in schedule)
    return tuple((row["time"], row.get("drive_speed", row.get("speed"))) for row in schedule)
