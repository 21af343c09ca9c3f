"""Fatigue of a gear as a drive ages: the damage in one unit of age, by what the torque of each run says.

Three loads count: starts, each a cycle from nothing to the torque of its state and back; the torque of a duty
that was recorded once, and grows as the torque at the points does; and stick-slip at points where the belt
sticks of itself. Miner's sum of all reaches its limit by adding up over age.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import HerseyError, UnitError
from hersey.files.toml import naming
from hersey.life.age import Age, one_of
from hersey.life.fatigue import RainflowCycles, SNCurve, rainflow_cycles, stick_slip_damage_rate
from hersey.life.indicator import NOT_JUDGED, Indicator
from hersey.life.indicators.at_states import AtStates, Curves
from hersey.life.indicators.sticking import MOST_FOLDS, curve_at, drag_of
from hersey.log.mapping import read_with_mapping
from hersey.motion.simulation import stick_slip
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    from hersey.machine import Machine
    from hersey.machine.duty import GearTable

#: Relative step of torque that shows how steeply damage rises with it.
_STEP = 0.01
#: Work that a stick-slip motion may take.
_STEPS = 3e5


def shares_of(machine: Machine) -> FloatArray:
    """Return the share of the running time of each point; all alike where none is stated."""
    count = len(machine.points)
    return np.array([1.0 / count if point.share is None else point.share for point in machine.points])


def running_time(machine: Machine, age_unit: str) -> float | None:
    """Return how long the drive runs in one unit of age, s; None if the machine does not say it.

    An age in hours counts the running time itself; another is that in which the belt goes its travel.
    """
    try:
        return Age(1.0, age_unit).as_unit("s").value
    except UnitError:
        if machine.life.travel is None or not machine.points:
            return None
        speeds = np.array([point.speed for point in machine.points])
        return float(machine.life.travel / (shares_of(machine) @ speeds))


def gear_fatigue(
    estimates: AtStates, machine: Machine, cold: int, points: slice, limit_error: float
) -> tuple[list[Indicator], list[Warning]]:
    """Return the damage of the gear per age, and why there is none.

    Parameters
    ----------
    cold, points
        Places of the cold corner and of the operating points among the states.
    limit_error
        Relative standard error of all torques together.
    """
    gear = machine.gear
    if gear is None:
        return [], [
            Warning(
                NOT_JUDGED,
                "add [gear] with torque, cycles and slope of its S-N curve to the machine file",
                severity="act",
                where="gear fatigue",
                table="gear",
            )
        ]
    load = _GearLoad(estimates, machine, gear, cold, points)
    if not any([load.starts(), load.duty(), load.stick_slip()]):
        return [], [
            Warning(
                NOT_JUDGED,
                "[gear] states no load",
                remedy='add starts = "20 per 1000 pages", or duty and duty_age',
                severity="act",
                where="gear fatigue",
                table="gear",
            )
        ]
    return [load.indicator(limit_error)], []


class _GearLoad:
    """The damage of a gear per age, of each run, summed over its loads."""

    def __init__(
        self, estimates: AtStates, machine: Machine, gear: GearTable, cold: int, points: slice
    ) -> None:
        self.estimates, self.machine, self.gear = estimates, machine, gear
        self.cold, self.points, self.age_unit = cold, points, estimates.runs.runs.age_unit
        with naming("[gear]"):
            self.curve = SNCurve(
                gear.torque, gear.cycles, gear.slope, gear.second_slope, gear.endurance, gear.ultimate
            )
        self.rate, self.spread = np.zeros(estimates.drive.shape[0]), np.zeros(estimates.drive.shape[0])
        self.warnings: list[Warning] = []

    def _add(self, cycles: RainflowCycles, scale: FloatArray, error: FloatArray) -> None:
        """Add cycles whose torque is so many times as large, known to a relative error."""
        damage, steep = _damage(self.curve, cycles, self.gear.ratio * scale)
        self.rate += damage
        self.spread += damage * steep * error

    def starts(self) -> bool:
        """Add the starts; whether there are any."""
        if self.gear.starts is None:
            return False
        shares = _shares_of_starts(self.gear, self.machine, self.estimates, self.cold, self.points)
        with naming("[gear] starts"):
            per_age = self.gear.starts[0] / Age.parse(self.gear.starts[1]).as_unit(self.age_unit).value
        for state, share in shares.items():
            cycle = RainflowCycles(np.ones(1), np.full(1, 0.5), np.full(1, share * per_age))
            self._add(cycle, self.estimates.drive[:, state], self.estimates.drive_error[:, state])
        self.warnings.append(
            Warning(
                "starts counted",
                "{starts:.3g} starts per {age_unit}, without break-away and acceleration",
                starts=per_age,
                age_unit=one_of(self.age_unit),
            )
        )
        return True

    def duty(self) -> bool:
        """Add the duty that was recorded; whether there is one."""
        if self.gear.duty is None or self.gear.duty_age is None:
            return False
        with naming("[gear] duty_age"):
            age = Age.parse(self.gear.duty_age).as_unit(self.age_unit).value
        drive, ages = self.estimates.drive, self.estimates.runs.runs.age
        states = self.points if self.machine.points else [self.cold]
        mix = drive[:, states] @ shares_of(self.machine) if self.machine.points else drive[:, self.cold]
        known = np.isfinite(mix)
        young = known & (ages == ages[known].min(initial=np.inf))
        scale = mix / np.median(mix[young]) if young.any() else np.full_like(mix, np.nan)
        error = np.nan_to_num(self.estimates.drive_error[:, states]).mean(axis=1)
        self._add(_counted(self.gear.duty, age), scale, error)
        self.warnings.append(
            Warning(
                "duty scaled",
                "the recorded duty is scaled with the torque at the operating points, starting from "
                "the youngest runs",
            )
        )
        return True

    def stick_slip(self) -> bool:
        """Add stick-slip at points on the falling branch; whether there is any."""
        radius, lasting = self.machine.roll_radius, []
        for point, share in zip(self.machine.points, shares_of(self.machine), strict=True):
            curves = curve_at(self.estimates, point.temperature)
            places = np.flatnonzero((curves.least * radius > point.speed) | curves.above)
            if places.size:
                lasting.append((point, share, curves, places))
        if not lasting:
            return False
        time = running_time(self.machine, self.age_unit)
        if time is None:
            self.warnings.append(
                Warning(
                    "stick-slip not counted",
                    'stick-slip at the operating points is not included. Add travel = "300 mm" to '
                    "[life] to include it",
                    severity="act",
                )
            )
            return False
        for point, share, curves, places in lasting:
            self.rate[places[MOST_FOLDS:]] = np.nan
            for place in places[:MOST_FOLDS].tolist():
                damage = share * time * self._rate_of_sticking(curves, place, point.speed)
                slowest = float(np.nan_to_num(self.estimates.belt_error[place]).max())
                self.rate[place] += damage
                self.spread[place] += np.nan_to_num(damage) * self.gear.slope * slowest
            self.warnings.append(
                Warning(
                    "stick-slip counted",
                    "stick-slip occurs at {point} in {count} {count:run|runs}, where torque falls with speed",
                    point=point.name,
                    count=len(places),
                )
            )
        return True

    def _rate_of_sticking(self, curves: Curves, place: int, speed: float) -> float:
        """Damage per second of a run that sticks at a speed (m/s); NaN where its motion is not found."""
        try:
            train = self.machine.train
            drag = drag_of(self.estimates, curves, place, self.machine)
            if drag is None:
                return np.nan  # no transition above its stick speed
            cycle = stick_slip(train, drag, drive_speed=speed, most_steps=_STEPS)
            radius, ratio = self.machine.roll_radius, self.gear.ratio
            return stick_slip_damage_rate(cycle, train, self.curve, roll_radius=radius, ratio=ratio)
        except HerseyError:
            return np.nan

    def indicator(self, limit_error: float) -> Indicator:
        """Return what adds up to the limit."""
        value = np.where(self.rate > 0.0, self.rate, np.nan)
        known = np.isfinite(value)
        warnings = list(self.warnings)
        if silent := int(np.count_nonzero(self.estimates.runs.enough & ~known)):
            warnings.append(
                Warning(
                    "runs without a rate",
                    "unknown in {count} {count:run|runs}: no damage, a peak that breaks the part, or "
                    "no torque there",
                    severity="watch",
                    count=silent,
                )
            )
        return Indicator(
            "gear fatigue",
            "gear fatigue",
            f"1/{one_of(self.age_unit)}",
            self.gear.damage,
            value,
            np.where(known, self.spread / np.where(known, self.rate, 1.0), np.nan),
            limit_error * self.gear.slope,
            accumulates=True,
            warnings=tuple(warnings),
        )


def _shares_of_starts(
    gear: GearTable, machine: Machine, estimates: AtStates, cold: int, points: slice
) -> dict[int, float]:
    """Shares of the starts by state: without a share all are cold."""
    of_cold = 1.0 if gear.cold_starts is None or not machine.points else gear.cold_starts
    places = range(len(estimates.states))[points]
    warm = {
        place: (1.0 - of_cold) * float(share) for place, share in zip(places, shares_of(machine), strict=True)
    }
    return {place: share for place, share in {cold: of_cold, **warm}.items() if share > 0.0}


def _damage(curve: SNCurve, cycles: RainflowCycles, scale: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Damage of cycles whose torque is so many times as large, and how steeply it goes with that."""
    damage = np.full(scale.shape, np.nan)
    steep = np.zeros(scale.shape)
    peak = float(np.max(cycles.amplitudes + np.abs(cycles.means)))
    for place in np.flatnonzero(np.isfinite(scale)).tolist():
        if curve.ultimate is not None and scale[place] * peak * (1.0 + _STEP) >= curve.ultimate:
            continue
        here, beside = (
            float(np.sum(cycles.counts / curve.life(times * cycles.amplitudes, times * cycles.means)))
            for times in (scale[place], scale[place] * (1.0 + _STEP))
        )
        damage[place] = here
        steep[place] = np.log(beside / here) / np.log1p(_STEP) if here > 0.0 else 0.0
    return damage, steep


def _counted(path: str, age: float) -> RainflowCycles:
    """Cycles of the torque of a log in one unit of age; those alike to a thousandth of the largest as one."""
    log = read_with_mapping(path, isothermal=True).log
    parts = [rainflow_cycles(run.torque, repeating=True) for run in log.runs]
    ranges, means, counts = (
        np.concatenate([getattr(part, name) for part in parts]) for name in ("ranges", "means", "counts")
    )
    step = 1e-3 * float(ranges.max(initial=0.0)) or 1.0
    alike, place = np.unique(np.round(np.column_stack([ranges, means]) / step), axis=0, return_inverse=True)
    summed = np.bincount(place.ravel(), weights=counts, minlength=alike.shape[0])
    kept = alike[:, 0] > 0.0
    return RainflowCycles(alike[kept, 0] * step, alike[kept, 1] * step, summed[kept] / age)
