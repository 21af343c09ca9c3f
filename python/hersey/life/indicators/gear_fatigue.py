"""Fatigue of a gear as a drive ages: the damage in one unit of age, by what the torque of each run says.

Three loads count: starts, each a cycle from nothing to the torque of its state and back; the torque of a duty
that was recorded once, and grows as the torque at the points does; and stick-slip at points where the belt
sticks of itself. Miner's sum of all reaches its limit by adding up over age.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import HerseyError, UnfinishedError, UnitError
from hersey.files.toml import naming
from hersey.life.age import Age, one_of
from hersey.life.fatigue import RainflowCycles, SNCurve, rainflow_cycles, stick_slip_damage_rate
from hersey.life.indicator import Indicator
from hersey.life.indicators.at_states import AtStates
from hersey.life.indicators.sticking import MOST_FOLDS, curve_at, drag_of
from hersey.log.mapping import read_with_mapping
from hersey.motion.simulation import stick_slip

if TYPE_CHECKING:
    from hersey.machine import Machine
    from hersey.machine.duty import GearTable

#: Relative step of torque that tells how steeply damage goes with it.
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
    told: AtStates, machine: Machine, cold: int, points: slice, limit_error: float
) -> tuple[list[Indicator], list[str]]:
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
        return [], ["gear fatigue: add [gear] with torque, cycles and slope of its S-N curve"]
    with naming("[gear]"):
        curve = SNCurve(
            gear.torque, gear.cycles, gear.slope, gear.second_slope, gear.endurance, gear.ultimate
        )
    whole, error = told.whole, told.whole_error
    mix = whole[:, points] @ shares_of(machine) if machine.points else whole[:, cold]
    rate, spread = np.zeros(whole.shape[0]), np.zeros(whole.shape[0])
    notes: list[str] = []
    loads = 0
    if gear.starts is not None:
        shares = _shares_of_starts(gear, machine, told, cold, points)
        with naming("[gear] starts"):
            per_age = gear.starts[0] / Age.parse(gear.starts[1]).as_unit(told.runs.runs.age_unit).value
        for state, share in shares.items():
            cycle = RainflowCycles(np.ones(1), np.full(1, 0.5), np.full(1, share * per_age))
            _add(rate, spread, *_damage(curve, cycle, gear.ratio * whole[:, state]), error[:, state])
        notes.append(
            f"{per_age:.3g} starts per {one_of(told.runs.runs.age_unit)}, without breakaway and acceleration"
        )
        loads += 1
    if gear.duty is not None and gear.duty_age is not None:
        with naming("[gear] duty_age"):
            age = Age.parse(gear.duty_age).as_unit(told.runs.runs.age_unit).value
        counted = _counted(gear.duty, age)
        young = told.runs.runs.age == told.runs.runs.age[np.isfinite(mix)].min(initial=np.inf)
        scale = mix / np.nanmedian(mix[young]) if np.isfinite(mix[young]).any() else np.full_like(mix, np.nan)
        mean_error = np.nan_to_num(error[:, points] if machine.points else error[:, [cold]]).mean(axis=1)
        _add(rate, spread, *_damage(curve, counted, gear.ratio * scale), mean_error)
        notes.append("the duty recorded grows as the torque at the points, from that of the youngest runs")
        loads += 1
    loads += _stick_slip(told, machine, gear, curve, rate, spread, notes)
    if not loads:
        return [], [
            'gear fatigue: [gear] says no load: add starts = "20 per 1000 pages", or duty and duty_age'
        ]
    value = np.where(rate > 0.0, rate, np.nan)
    if silent := int(np.count_nonzero(told.runs.enough & ~np.isfinite(value))):
        notes.append(f"not told by {silent} runs: no damage, a peak that breaks the part, or no torque there")
    found = Indicator(
        "gear fatigue",
        "gear fatigue",
        f"1/{one_of(told.runs.runs.age_unit)}",
        gear.damage,
        value,
        np.where(np.isfinite(value), spread / np.where(rate > 0.0, rate, 1.0), np.nan),
        limit_error * gear.slope,
        accumulates=True,
        notes=tuple(notes),
    )
    return [found], []


def _shares_of_starts(
    gear: GearTable, machine: Machine, told: AtStates, cold: int, points: slice
) -> dict[int, float]:
    """Shares of the starts by state: without a share all are cold."""
    of_cold = 1.0 if gear.cold_starts is None or not machine.points else gear.cold_starts
    places = range(len(told.states))[points]
    warm = {
        place: (1.0 - of_cold) * float(share) for place, share in zip(places, shares_of(machine), strict=True)
    }
    return {place: share for place, share in {cold: of_cold, **warm}.items() if share > 0.0}


def _add(
    rate: FloatArray, spread: FloatArray, damage: FloatArray, steep: FloatArray, error: FloatArray
) -> None:
    rate += damage
    spread += damage * steep * error


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


def _stick_slip(
    told: AtStates,
    machine: Machine,
    gear: GearTable,
    curve: SNCurve,
    rate: FloatArray,
    spread: FloatArray,
    notes: list[str],
) -> int:
    """Add the damage of stick-slip at points on the falling branch; return whether there is any."""
    sticking = [
        (point, share, curve_at(told, point.temperature))
        for point, share in zip(machine.points, shares_of(machine), strict=True)
    ]
    lasting = [
        (
            point,
            share,
            curves,
            np.flatnonzero((curves.least * machine.roll_radius > point.speed) | curves.above),
        )
        for point, share, curves in sticking
    ]
    if not any(places.size for *_, places in lasting):
        return 0
    time = running_time(machine, told.runs.runs.age_unit)
    if time is None:
        notes.append('stick-slip at the points is not in it: [life] lacks travel = "300 mm"')
        return 0
    for point, share, curves, places in lasting:
        for place in places[MOST_FOLDS:].tolist():
            rate[place] = np.nan
        for place in places[:MOST_FOLDS].tolist():
            drag = drag_of(told, curves, place, machine)
            try:
                if drag is None:
                    raise UnfinishedError("the drag of the run has no transition above its stick speed")
                cycle = stick_slip(machine.train, drag, drive_speed=point.speed, most_steps=_STEPS)
                damage = stick_slip_damage_rate(
                    cycle, machine.train, curve, roll_radius=machine.roll_radius, ratio=gear.ratio
                )
            except HerseyError:
                rate[place] = np.nan
                continue
            rate[place] += damage * share * time
            slowest = float(np.nan_to_num(told.belt_error[place]).max())
            spread[place] += damage * share * time * gear.slope * slowest
        if places.size:
            notes.append(f"stick-slip at {point.name} in {places.size} runs, where torque falls with speed")
    return 1
