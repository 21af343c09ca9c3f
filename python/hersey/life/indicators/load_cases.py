"""States of a machine at which an ageing drive fails first: its points, and two load cases of its use."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from hersey.schema.warning import Warning

if TYPE_CHECKING:
    from hersey.life.indicators.run_dwells import CampaignRuns
    from hersey.machine import Machine

#: Coldest starts that are tried beside the one as it is, K.
OTHER_STARTS = (-10.0, 10.0)


@dataclass(frozen=True)
class State:
    """Speed of the roll (rad/s) and temperature (K; None: not recorded) at which a drive is asked.

    ``origin`` says where both are from.
    """

    name: str
    speed: float
    temperature: float | None
    origin: str

    def warning(self) -> Warning:
        """Return where a value of it holds."""
        return Warning(
            "state of the value",
            "{speed:.4g rpm} ({origin})"
            if self.temperature is None
            else "{speed:.4g rpm} and {temperature:.4g degC} ({origin})",
            where=self.name,
            speed=self.speed,
            temperature=self.temperature,
            origin=self.origin,
        )


def point_states(machine: Machine) -> tuple[State, ...]:
    """Return the operating points of a machine."""
    return tuple(
        State(point.name, point.speed / machine.roll_radius, point.temperature, "[[points]]")
        for point in machine.points
    )


def load_cases(machine: Machine, runs: CampaignRuns) -> tuple[State, State] | None:
    """Return the cold fast and the hot slow corner of the machine's use; None if no run has a dwell.

    Fastest and slowest are those of ``[[points]]``; without these the speed of ``[limits]``, else what all
    specimens recorded. Coldest is that of ``[life]``, else the coldest that all specimens recorded; hottest
    that of the points, else the hottest that all specimens recorded.
    """
    slowest, fastest = runs.shared("speed", least=True), runs.shared("speed", least=False)
    if slowest is None or fastest is None:
        return None
    coldest, hottest = runs.shared("temperature", least=True), runs.shared("temperature", least=False)
    cold_from = hot_from = "recorded by all specimens" if coldest is not None else ""
    slow_from = fast_from = "slowest and fastest recorded by all specimens"
    if machine.life.coldest is not None and coldest is not None:
        coldest, cold_from = machine.life.coldest, "[life] coldest"
    if machine.limits.speed is not None and not math.isinf(machine.roll_radius):
        fastest, fast_from = machine.limits.speed / machine.roll_radius, "[limits] speed"
    if machine.points:
        speeds = [point.speed / machine.roll_radius for point in machine.points]
        slowest, fastest, slow_from, fast_from = min(speeds), max(speeds), "[[points]]", "[[points]]"
        hottest, hot_from = max(point.temperature for point in machine.points), ""
    return (
        State("cold and fast", fastest, coldest, ", ".join(filter(None, (fast_from, cold_from)))),
        State("hot and slow", slowest, hottest, ", ".join(filter(None, (slow_from, hot_from)))),
    )


def cold_starts(cold: State) -> tuple[State, ...]:
    """Return the cold and fast corner at other coldest starts; empty where no run recorded a temperature."""
    kelvin = cold.temperature
    if kelvin is None:
        return ()
    return tuple(replace(cold, temperature=kelvin + beside) for beside in OTHER_STARTS)
