"""Stick-slip at the points of a machine: two speeds that its runs show, against that of the point.

Torque of the belt is least at the transition; slower than that it falls with speed, and a belt that slides
steadily begins to stick of itself. So a point whose speed the transition reaches is at its end. Between the
transition and V*, the fold above it, a belt that slides goes on sliding, and one that starts from rest
sticks: that comes earlier, some machines are new within it, and it depends on stiffness, mass and stick
speed. It is followed as a sign.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.no_load_torque import with_rest
from hersey.damping.surface import WITH_TRANSITION
from hersey.errors import ParameterError, UnfinishedError
from hersey.life.indicator import NOT_JUDGED, Indicator
from hersey.life.indicators.at_states import AtStates, Curves
from hersey.life.indicators.shared_kernel import evenly
from hersey.motion.drag import DragTable
from hersey.schema.warning import Warning
from hersey.stability.hysteresis import fold

if TYPE_CHECKING:
    from hersey.damping.no_load_torque import NoLoadTorque
    from hersey.machine import Machine
    from hersey.motion.belt import Drivetrain

#: Runs whose fold is sought at the most, those whose draws give its error, and draws of each.
MOST_FOLDS, DRAWN_RUNS, _DRAWS = 24, 3, 3
#: Work and tolerance of a fold: of thousands, one that takes long is left out.
_STEPS, _TOLERANCE = 2_000_000, 1e-8
#: Folds of draws that give an error.
_FEWEST = 5
#: Standard deviations that enclose 95 % of a normal distribution on either side.
_DEVIATIONS = 1.96


def curve_at(estimates: AtStates, temperature: float | None) -> Curves:
    """Return the curves at a temperature that was asked for."""
    return next(curves for curves in estimates.curves if curves.temperature == temperature)


def transitions(estimates: AtStates, machine: Machine) -> list[Indicator]:
    """Return the speed of least torque at each point of the machine (m/s), against that of the point."""
    found = []
    for point in machine.points:
        curves = curve_at(estimates, point.temperature)
        speed = curves.least * machine.roll_radius
        found.append(
            Indicator(
                f"stick-slip, {point.name}",
                "stick-slip",
                "m/s",
                point.speed,
                speed,
                np.where(np.isfinite(speed), curves.error, np.nan),
                float(np.hypot(_speed_gain(estimates, machine), curves.common)),
                warnings=(
                    Warning(
                        "speed of least torque",
                        "speed of least torque at {temperature:.4g degC}",
                        temperature=point.temperature,
                    ),
                    *_warnings(estimates, curves),
                ),
            )
        )
    return found


def folds(estimates: AtStates, machine: Machine) -> tuple[list[Indicator], list[Warning]]:
    """Return V* at each point of the machine (m/s), against its speed; and why there is none."""
    found, warnings = [], []
    by_temperature = {point.temperature: point.name for point in machine.points}
    for temperature, name in by_temperature.items():
        curves = curve_at(estimates, temperature)
        falling = np.flatnonzero(np.isfinite(curves.least))
        chosen = falling[evenly(falling.size, MOST_FOLDS)].tolist()
        speed = np.full(curves.least.shape, np.nan)
        for place in chosen:
            speed[place] = _fold(machine.train, drag_of(estimates, curves, place, machine))
        error = _error(estimates, curves, machine) if np.isfinite(speed).any() else None
        if error is None:
            warnings.append(_no_fold(name))
            continue
        of_runs = _folds_of_runs(speed, len(curves.drawn))
        errors = np.where(np.isfinite(speed), error, np.nan)
        common = np.hypot(
            _speed_gain(estimates, machine), _of_machine(estimates, curves, machine, chosen[len(chosen) // 2])
        )
        found += [
            Indicator(
                f"stick-slip from rest, {point.name}",
                "stick-slip from rest",
                "m/s",
                point.speed,
                speed,
                errors,
                float(common),
                sign=True,
                warnings=(of_runs, *_warnings(estimates, curves)),
            )
            for point in machine.points
            if point.temperature == temperature
        ]
    return found, warnings


def _no_fold(point: str) -> Warning:
    return Warning(
        NOT_JUDGED,
        "V* cannot be determined from these dwells",
        severity="act",
        where=f"stick-slip from rest at {point}",
        point=point,
    )


def _folds_of_runs(speed: FloatArray, drawn: int) -> Warning:
    """Of how many runs V* is known; its error is that of ``drawn`` runs."""
    return Warning(
        "V* of some runs",
        "V* is known for {count} of {runs} runs, computed for at most {most}; its error is the median "
        "of {drawn} runs",
        count=int(np.isfinite(speed).sum()),
        runs=speed.size,
        most=MOST_FOLDS,
        drawn=drawn,
    )


def drag_of(
    estimates: AtStates, curves: Curves, place: int, machine: Machine, torque: FloatArray | None = None
) -> DragTable | None:
    """Return the drag of the belt of a run, or by another curve of it; None where it falls nowhere.

    Below the slowest dwell it goes on as between the slowest two points.
    """
    own = curves.torque[place] if torque is None else torque
    known = np.isfinite(own)
    speed = curves.speed[known] * machine.roll_radius
    return belt_drag(machine, estimates.runs.rests[place], speed, own[known], curves.temperature)


def belt_drag(
    machine: Machine,
    rest: NoLoadTorque | None,
    speed: FloatArray,
    torque: FloatArray,
    temperature: float | None,
) -> DragTable | None:
    """Return the drag of a belt from its torque (N m) at speeds (m/s at the belt) and a temperature (K).

    None where it falls nowhere above the stick speed.
    """
    if int(np.argmin(torque)) == 0:
        return None
    try:
        drag = DragTable(
            tuple(speed.tolist()),
            tuple((torque / machine.roll_radius).tolist()),
            stick_speed_at(machine, temperature),
            static_force=static_force(machine),
        )
        return drag if rest is None else with_rest(drag, rest, machine.roll_radius, temperature)
    except ParameterError:  # no transition above the stick speed, or it slides harder than it rests
        return None


def edges(train: Drivetrain, drag: DragTable | None) -> tuple[float, float]:
    """Return transition and V* (m/s) of a drag, NaN where there is none or its search takes long."""
    if drag is None:
        return np.nan, np.nan
    try:
        transition, upper = fold(train, drag, tolerance=_TOLERANCE, most_steps=_STEPS)
    except (UnfinishedError, ParameterError):
        return float(drag.speeds[int(np.argmin(drag.forces))]), np.nan
    return transition, upper if 0.0 < upper < np.inf else np.nan


def static_force(machine: Machine) -> float | None:
    """Return the drag of a belt at rest as the machine states it, N; None if it does not."""
    if machine.static_friction is None or machine.limits.nip_load is None:
        return None
    return machine.static_friction * machine.limits.nip_load


def stick_speed_at(machine: Machine, temperature: float | None) -> float:
    """Return the stick speed (m/s) at a temperature (K): it moves as 1/viscosity, where that is known."""
    stated = machine.stick_speed_temperature
    if stated is None or temperature is None or machine.lubricant is None:
        return machine.stick_speed
    if machine.stick_speed_rule != WITH_TRANSITION:
        return machine.stick_speed
    there, here = machine.lubricant.viscosity([stated, temperature])
    return float(machine.stick_speed * there / here)


def _fold(train: Drivetrain, drag: DragTable | None) -> float:
    return edges(train, drag)[1]


def _error(estimates: AtStates, curves: Curves, machine: Machine) -> float | None:
    """Relative standard error of a fold: the middle one of some runs; None if it is not known."""
    errors, count = [], 0
    for place, drawn in curves.drawn.items():
        values = [
            _fold(machine.train, drag_of(estimates, curves, place, machine, each)) for each in drawn[:_DRAWS]
        ]
        logs = np.log(np.array(values)[np.isfinite(values)])
        count += logs.size
        if logs.size > 1:
            errors.append(float(logs.std(ddof=1)))
    return float(np.median(errors)) if count >= _FEWEST and errors else None


def _of_machine(estimates: AtStates, curves: Curves, machine: Machine, place: int) -> float:
    """Relative standard error of all folds together, by what the machine states of its own numbers."""
    at = _fold(machine.train, drag_of(estimates, curves, place, machine))
    squares = 0.0
    for name in ("stiffness", "mass", "stick_speed"):
        if name not in machine.uncertainty:
            continue
        drawn = machine.uncertainty[name].draw(np.random.default_rng(0), getattr(machine, name), 200)
        by: dict[str, Any] = {name: float(getattr(machine, name) * np.exp(np.log(drawn).std()))}
        wider = replace(machine, **by)
        moved = _fold(wider.train, drag_of(estimates, curves, place, wider))
        squares += np.nan_to_num(np.log(moved / at)) ** 2
    return float(np.sqrt(squares))


def _speed_gain(estimates: AtStates, machine: Machine) -> float:
    gains = [sensors.speed_gain for sensors in estimates.runs.sensors]
    return (machine.sensors.speed_gain if "speed" in machine.sensors.stated else max(gains)) / _DEVIATIONS


def _warnings(estimates: AtStates, curves: Curves) -> tuple[Warning, ...]:
    """Which runs do not show the transition, and what is taken for the belt's torque."""
    enough = estimates.runs.enough
    silent = enough & ~np.isfinite(curves.torque).any(axis=1)
    counts = (
        ("slower than recorded", curves.below),
        ("faster than recorded", curves.above),
        ("other temperatures", silent),
    )
    warnings = [_unknown_in(kind, int(np.count_nonzero(of)), enough.size) for kind, of in counts if of.any()]
    if any(rest is None for rest in estimates.runs.rests):
        warnings.append(
            Warning(
                "no-load torque unknown",
                "this is the minimum of the total torque, because the no-load torque is unknown. Add "
                "[rest] to the machine file",
                severity="watch",
            )
        )
    return tuple(warnings)


def _unknown_in(kind: str, count: int, runs: int) -> Warning:
    """Why so many runs do not show the transition."""
    return Warning(
        kind,
        "unknown in {count} of {runs} runs: the minimum of torque is below the recorded speeds"
        if kind == "slower than recorded"
        else "unknown in {count} of {runs} runs: torque still falls at the fastest recorded speed"
        if kind == "faster than recorded"
        else "unknown in {count} of {runs} runs, which have other temperatures",
        severity="watch",
        count=count,
        runs=runs,
    )
