"""From the runs of a campaign to the indicators of failure: what each run says of each failure mode.

A run is asked by its torque surface, without a law (`torque_surface`); what it says holds at the state that
its first warning names, and its error grows where the dwells do not enclose that state.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from hersey.arrays import FloatArray, one_thread
from hersey.errors import InsufficientDataError
from hersey.life.age import one_of
from hersey.life.indicator import NOT_JUDGED, Indicator, Indicators
from hersey.life.indicators.at_states import AtStates, at_states
from hersey.life.indicators.gear_fatigue import gear_fatigue, running_time, shares_of
from hersey.life.indicators.load_cases import State, cold_starts, load_cases, point_states
from hersey.life.indicators.run_dwells import CampaignRuns, read_runs_of
from hersey.life.indicators.sticking import DRAWN_RUNS, folds, static_force, stick_speed_at, transitions
from hersey.schema.warning import Warning
from hersey.units import takes_si

if TYPE_CHECKING:
    from hersey.life.campaign import Campaign
    from hersey.machine import Machine

#: Standard deviations that enclose 95 % of a normal distribution on either side.
_DEVIATIONS = 1.96
#: Places of the states: the load cases, rest, and from there on the points.
_COLD, _SLOW, _STILL, _POINTS = 0, 1, 2, slice(3, None)

#: Keys of [drivetrain].
_MOVING = "stiffness, mass, roll_radius and stick_speed"
#: Indicators, and why there are none.
_Found = tuple[list[Indicator], list[Warning]]


@one_thread()
@takes_si()
def indicators_of(campaign: Campaign, machine: Machine, *, signs: bool = True) -> Indicators:
    """Return the indicators of all failure modes whose limits the machine states.

    If ``signs`` is false, V* (a precursor, and the slowest to compute) is omitted.

    Raises
    ------
    InsufficientDataError
        If the campaign has no run with enough dwells.
    ParameterError, UnitError
        If [gear] has no S-N curve, or an age in a unit other than the campaign's.
    """
    return asked_of(campaign, machine).indicators(machine, signs=signs)


def asked_of(campaign: Campaign, machine: Machine) -> AskedRuns:
    """Return what the runs say of the states of a machine, from which its indicators follow.

    Raises
    ------
    InsufficientDataError
        If the campaign has no run with enough dwells.
    """
    runs = read_runs_of(campaign, machine.rest)
    ends = load_cases(machine, runs)
    if ends is None:
        raise InsufficientDataError(
            f"{campaign.path.name} has no run with dwells. Add logs with 'hersey campaign add'"
        )
    hottest = ends[_SLOW].temperature
    stick_speed = ends[_SLOW].speed
    if machine.has_drivetrain:
        stick_speed = stick_speed_at(machine, hottest) / machine.roll_radius
    still = State("at rest, hot", stick_speed, hottest, "stick speed")
    states = (*ends, still, *point_states(machine))
    temperatures = tuple(dict.fromkeys(point.temperature for point in machine.points))
    asked = (*states, *cold_starts(ends[_COLD]))
    return AskedRuns(at_states(runs, asked, temperatures, drawn=DRAWN_RUNS), len(states))


@dataclass(frozen=True, repr=False)
class AskedRuns:
    """What the runs of a campaign say of so many states of a machine, and of other coldest starts."""

    estimates: AtStates
    number: int

    @property
    def coldest(self) -> float | None:
        """Temperature of the coldest start, K; None where no run recorded any."""
        return self.estimates.states[_COLD].temperature

    @property
    def starts(self) -> dict[float, int]:
        """Places of the cold and fast corner by the temperature of the coldest start, K, ascending."""
        states = self.estimates.states
        colds = {states[k].temperature: k for k in (_COLD, *range(self.number, len(states)))}
        return {kelvin: colds[kelvin] for kelvin in sorted(each for each in colds if each is not None)}

    def indicators(self, machine: Machine, *, coldest: float | None = None, signs: bool = True) -> Indicators:
        """Return the indicators of a machine of the same states, at one of `starts` (default: as stated)."""
        cold = _COLD if coldest is None else self.starts[coldest]
        estimates = self.estimates.of_states([cold, *range(_SLOW, self.number)])
        asked = _Asked(estimates, machine, _torque_gain(machine, estimates.runs))
        found: list[_Found] = [
            asked.motor_torque(),
            asked.grip(),
            asked.stick_slip(signs=signs),
            gear_fatigue(estimates, machine, _COLD, _POINTS, asked.gain),
            asked.continuous_torque(),
            asked.energy(),
        ]
        each = tuple(indicator for indicators, _ in found for indicator in indicators)
        warnings = (warning for _, of_mode in found for warning in of_mode)
        return Indicators(estimates.runs.runs, each, (*warnings, *estimates.runs.warnings))


def _torque_gain(machine: Machine, runs: CampaignRuns) -> float:
    """Relative standard error of all torques together: that of the gain of their sensors."""
    gains = [sensors.torque_gain for sensors in runs.sensors]
    if "torque" in machine.sensors.stated:
        gains = [machine.sensors.torque_gain]
    return max(gains) / _DEVIATIONS


@dataclass(frozen=True)
class _Asked:
    """What the runs say of all states, against the limits; ``gain`` is an error common to all torques."""

    estimates: AtStates
    machine: Machine
    gain: float

    def motor_torque(self) -> _Found:
        limit = self.machine.limits.motor_torque
        if limit is None:
            return [], [_lacks("motor torque", "limits", 'motor_torque = "1 N*m"')]
        return [self._motor_indicator("motor torque", limit, place) for place in (_COLD, _SLOW)], []

    def _motor_indicator(self, kind: str, limit: float, place: int) -> Indicator:
        estimates = self.estimates
        return self._torque(
            f"{kind}, {estimates.states[place].name}",
            kind,
            limit,
            estimates.drive[:, place],
            estimates.drive_error[:, place],
            place,
        )

    def _torque(
        self,
        name: str,
        kind: str,
        limit: float,
        value: FloatArray,
        error: FloatArray,
        place: int,
        *warnings: Warning,
    ) -> Indicator:
        return Indicator(
            name,
            kind,
            "N m",
            limit,
            value,
            error,
            self.gain,
            warnings=(*self.estimates.warnings(place), *warnings),
        )

    def grip(self) -> _Found:
        """The belt alone against what the roll carries before it slips: cold and fast, and from rest."""
        grip = self.machine.limits.grip
        if grip is None:
            stated = self.machine.limits
            lacks = [
                f"{name} = {such}"
                for name, such, value in (
                    ("roll_friction", "0.6", stated.roll_friction),
                    ("nip_load", '"300 N"', stated.nip_load),
                )
                if value is None
            ]
            return [], [_lacks("grip", "limits", " and ".join(lacks))]
        if math.isinf(self.machine.roll_radius):
            return [], [_lacks("grip", "drivetrain", _MOVING)]
        estimates, limit = self.estimates, grip * self.machine.roll_radius
        warnings = []
        if any(rest is None for rest in estimates.runs.rests):
            warnings.append(
                Warning(
                    "no-load torque unknown",
                    "all torque is counted as that of the contact, although bearings and gears take a part",
                    remedy="add [rest] to the machine file",
                    severity="watch",
                )
            )
        cold = estimates.belt[:, _COLD], estimates.belt_error[:, _COLD]
        sliding = self._torque("grip, cold and fast", "grip", limit, *cold, _COLD, *warnings)
        if not self.machine.has_drivetrain:
            return [sliding], [_lacks("grip, from rest", "drivetrain", _MOVING)]
        breakaway, how = self._breakaway()
        error = estimates.belt_error[:, _STILL]
        from_rest = self._torque("grip, from rest", "grip", limit, breakaway, error, _STILL, how, *warnings)
        # Nobody measured the factor of Eq. 29: it warns, and ends no specimen.
        by_rule = static_force(self.machine) is None
        return [sliding, replace(from_rest, sign=by_rule)], []

    def _breakaway(self) -> tuple[FloatArray, Warning]:
        """Torque at which a belt at rest breaks away, and how it is estimated."""
        estimates = self.estimates
        drag = estimates.belt[:, _STILL]
        static = static_force(self.machine)
        if static is None:
            return np.e * drag, Warning(
                "break-away by rule",
                "break-away force is assumed to be e times the drag at the stick speed (Eq. 29)",
                severity="watch",
            )
        age = estimates.runs.runs.age
        known = np.isfinite(drag)
        young = known & (age == age[known].min(initial=np.inf))
        new = float(np.median(drag[young])) if young.any() else np.nan
        return (
            static * self.machine.roll_radius * drag / new,
            Warning(
                "break-away as stated",
                "static friction is as stated for the youngest runs and grows with the drag at the "
                "stick speed",
            ),
        )

    def stick_slip(self, *, signs: bool) -> _Found:
        if not self.machine.points:
            return [], [self._lacks_points("stick-slip at a used operating point")]
        if not self.machine.has_drivetrain:
            lacks = [_lacks("stick-slip from rest", "drivetrain", _MOVING)] if signs else []
            return transitions(self.estimates, self.machine), lacks
        early, warnings = folds(self.estimates, self.machine) if signs else ([], [])
        return [*transitions(self.estimates, self.machine), *early], warnings

    def _lacks_points(self, mode: str, *, share: bool = False) -> Warning:
        """A failure mode that is not judged without operating points, or without the radius they need."""
        if math.isinf(self.machine.roll_radius):
            return _lacks(mode, "drivetrain", _MOVING)
        return _without_points(mode, share=share)

    def continuous_torque(self) -> _Found:
        limit = self.machine.life.continuous_torque
        if limit is None:
            return [], [_lacks("heating of the motor", "life", 'continuous_torque = "0.5 N*m"')]
        if not self.machine.points:
            return [], [self._lacks_points("heating of the motor", share=True)]
        squares = self.estimates.drive[:, _POINTS] ** 2 * shares_of(self.machine)
        return [self._over_points("continuous torque", "motor heat", "N m", limit, squares, 0.5)], []

    def energy(self) -> _Found:
        limit, unit = self.machine.life.energy, one_of(self.estimates.runs.runs.age_unit)
        if limit is None:
            return [], [_lacks(f"energy per {unit}", "life", 'energy = "10 J"')]
        time = running_time(self.machine, self.estimates.runs.runs.age_unit)
        if not self.machine.points:
            return [], [self._lacks_points(f"energy per {unit}", share=time is not None)]
        if time is None:
            return [], [_lacks(f"energy per {unit}", "life", 'travel = "300 mm"')]
        speeds = np.array([state.speed for state in self.estimates.states[_POINTS]])
        work = self.estimates.drive[:, _POINTS] * speeds * time * shares_of(self.machine)
        return [self._over_points(f"energy per {unit}", "energy", "J", limit, work, 1.0)], []

    def _over_points(
        self, name: str, kind: str, si: str, limit: float, parts: FloatArray, power: float
    ) -> Indicator:
        """A sum over the points to a power; their errors are taken to go together."""
        total = parts.sum(axis=1)
        error = (parts / total[:, None] * self.estimates.drive_error[:, _POINTS]).sum(axis=1)
        alike = all(point.share is None for point in self.machine.points)
        warnings = []
        if alike:
            warnings.append(
                Warning(
                    "equal shares", "all operating points have equal weight", remedy="set share in [[points]]"
                )
            )
        return Indicator(name, kind, si, limit, total**power, error, self.gain, warnings=tuple(warnings))


def _lacks(mode: str, table: str, keys: str) -> Warning:
    """A failure mode that is not judged, and which keys of a table of the machine file would do it."""
    return Warning(
        NOT_JUDGED,
        "add {keys} to [{table}] of the machine file",
        severity="act",
        where=mode,
        table=table,
        keys=keys,
    )


def _without_points(mode: str, *, share: bool = False) -> Warning:
    """A failure mode that is not judged without operating points."""
    return Warning(
        NOT_JUDGED,
        "add [[points]] with speed, temperature and share to the machine file"
        if share
        else "add [[points]] with speed and temperature to the machine file",
        severity="act",
        where=mode,
        table="points",
    )
