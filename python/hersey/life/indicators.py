"""From the runs of a campaign to the indicators of failure: what each run says of each way to fail.

A run is asked by its torque surface, without a law (`torque_surface`); what it says holds at the state that
the note names, and its error grows where the dwells do not enclose that state.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.errors import InsufficientDataError
from hersey.life.age import Age
from hersey.life.corners import State, corners
from hersey.life.indicator import Indicator, Indicators
from hersey.life.run_dwells import CampaignRuns, read_runs_of
from hersey.life.torque_surface import Kernel, TorqueSurface, shared_kernel

if TYPE_CHECKING:
    from hersey.life.campaign import Campaign
    from hersey.machine import Machine

#: Standard deviations that enclose 95 % of a normal distribution on either side.
_DEVIATIONS = 1.96
#: Runs that a note names.
_NAMED = 3


def indicators_of(campaign: Campaign, machine: Machine) -> Indicators:
    """Return what the runs of a campaign say of each way to fail whose limit the machine states.

    Raises
    ------
    InsufficientDataError
        If the campaign has no run, or none with dwells enough.
    """
    runs = read_runs_of(campaign, machine.rest)
    states = corners(machine, runs)
    if states is None:
        raise InsufficientDataError(
            f"{campaign.path.name} has no run with dwells: add logs, or look at 'check'"
        )
    kernel = shared_kernel([dwells for _, dwells, _ in runs.told()])
    told = _at_states(runs, kernel, states)
    each, unsaid = _motor_torque(told, machine, _torque_gain(machine, runs))
    return Indicators(runs.runs, tuple(each), (*unsaid, *runs.notes))


@dataclass(frozen=True)
class _AtStates:
    """Torque of the belt alone and of the whole drive (N m) at each state, with relative errors.

    Arrays of shape (runs, states), NaN where a run does not tell.
    """

    runs: CampaignRuns
    states: tuple[State, ...]
    belt: FloatArray
    belt_error: FloatArray
    whole: FloatArray
    whole_error: FloatArray
    outside: BoolArray
    factor: FloatArray
    kelvin: FloatArray

    def notes(self, state: int) -> tuple[str, ...]:
        """What the state is, and which runs do not tell it or only beyond their dwells."""
        known = np.isfinite(self.whole[:, state])
        notes = [str(self.states[state])]
        beyond = np.flatnonzero(known & self.outside[:, state]).tolist()
        if beyond:
            far = [f"{self._run(run)}, {self._away(run, state)}" for run in beyond[:_NAMED]]
            notes.append(
                f"extrapolated in {len(beyond)} of {known.size} runs, whose dwells do not enclose it "
                f"(not recorded there, or stalled): {'; '.join(far)}" + _more(beyond)
            )
        silent = np.flatnonzero(self.runs.enough & ~known).tolist()
        if silent:
            named = ", ".join(self._run(run) for run in silent[:_NAMED])
            notes.append(f"not told by {len(silent)} runs of other temperatures: {named}" + _more(silent))
        return tuple(notes)

    def _run(self, run: int) -> str:
        of = self.runs.runs
        return f"{of.unit[run]} at {Age(float(of.age[run]), of.age_unit)}"

    def _away(self, run: int, state: int) -> str:
        factor, kelvin = float(self.factor[run, state]), float(self.kelvin[run, state])
        parts = [f"{factor:.3g} times the speed"] if abs(factor - 1.0) > 0.02 else []
        if abs(kelvin) > 1.0:
            parts.append(f"{abs(kelvin):.3g} K {'warmer' if kelvin > 0 else 'colder'}")
        return f"{' and '.join(parts) or 'just beside'} than the nearest dwell".replace(
            "speed than", "speed of"
        )


def _more(places: list[int]) -> str:
    return "; and more" if len(places) > _NAMED else ""


def _at_states(runs: CampaignRuns, kernel: Kernel, states: tuple[State, ...]) -> _AtStates:
    shape = (len(runs.dwells), len(states))
    belt, belt_error, whole, whole_error, factor, kelvin = (np.full(shape, np.nan) for _ in range(6))
    outside = np.zeros(shape, dtype=bool)
    speed = np.array([state.speed for state in states])
    heat = np.array([np.nan if state.temperature is None else state.temperature for state in states])
    for place, dwells, rest in runs.told():
        at = TorqueSurface(dwells, kernel).at(speed, heat)
        beside = 0.0 if rest is None else rest.torque(speed, heat if np.isfinite(heat).all() else None)
        belt[place], belt_error[place] = at.torque, at.error
        whole[place] = at.torque + beside
        whole_error[place] = at.error * at.torque / whole[place]
        outside[place], factor[place], kelvin[place] = at.outside, at.factor, at.kelvin
    return _AtStates(runs, states, belt, belt_error, whole, whole_error, outside, factor, kelvin)


def _torque_gain(machine: Machine, runs: CampaignRuns) -> float:
    """Relative standard error of all torques together: that of the gain of their sensors."""
    gains = [sensors.torque_gain for sensors in runs.sensors]
    if "torque" in machine.sensors.stated:
        gains = [machine.sensors.torque_gain]
    return max(gains) / _DEVIATIONS


def _motor_torque(told: _AtStates, machine: Machine, limit_error: float) -> tuple[list[Indicator], list[str]]:
    limit = machine.limits.motor_torque
    if limit is None:
        return [], ['the torque of the motor: [limits] lacks motor_torque = "1 N*m"']
    return [
        Indicator(
            f"motor torque, {state.name}",
            "motor torque",
            "N m",
            limit,
            told.whole[:, place],
            told.whole_error[:, place],
            limit_error,
            notes=told.notes(place),
        )
        for place, state in enumerate(told.states)
    ], []
