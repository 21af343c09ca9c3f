"""What the runs of a campaign say of some states: torque there, and its curve against speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.life.indicators.least_torque import DRAWS, RUNS, LeastTorque, alike_in_all, least_torque
from hersey.life.indicators.load_cases import State
from hersey.life.indicators.run_dwells import CampaignRuns
from hersey.life.indicators.shared_kernel import evenly, shared_kernel
from hersey.life.indicators.torque_surface import TorqueSurface
from hersey.schema.warning import Warning

#: Runs that a warning names.
_NAMED = 3
#: Factor beyond the slowest and the fastest dwell of a run up to which its curve is asked; what rounds off.
_NEAR, _SLIP = 1.25, 0.999
#: Steps of the curve in ln speed, and its points at the least.
_GRID, _FEWEST_SPEEDS = 0.08, 24


@dataclass(frozen=True)
class Curves:
    """Torque of the belt against speed at one temperature (K; None where no run recorded any), of all runs.

    ``speed`` in rad/s, shape (speeds,); ``torque`` in N m, (runs, speeds), NaN where a run does not show it:
    beyond its dwells and what lies near them. ``least`` is the speed of least torque, (runs,), NaN where it
    lies at no speed between, ``error`` its relative standard error and ``common`` what is the same in all
    runs; ``drawn`` are joint draws of some runs, (draws, speeds) each. ``below`` and ``above`` mark runs
    whose torque is least at their slow or fast end.
    """

    temperature: float | None
    speed: FloatArray
    torque: FloatArray
    least: FloatArray
    error: FloatArray
    below: BoolArray
    above: BoolArray
    drawn: dict[int, FloatArray]
    common: float = 0.0


@dataclass(frozen=True)
class AtStates:
    """Torque of the belt alone and of the whole drive (N m) at each state, with relative errors.

    Arrays of shape (runs, states), NaN where a run does not show it. Where the no-load torque is not known
    both torques are that of the drive. ``curves`` are those at the temperatures asked for.
    """

    runs: CampaignRuns
    states: tuple[State, ...]
    belt: FloatArray
    belt_error: FloatArray
    drive: FloatArray
    drive_error: FloatArray
    outside: BoolArray
    factor: FloatArray
    kelvin: FloatArray
    curves: tuple[Curves, ...] = ()

    def of_states(self, places: Sequence[int]) -> AtStates:
        """Return the same of some of the states."""
        names = ("belt", "belt_error", "drive", "drive_error", "outside", "factor", "kelvin")
        arrays = {name: getattr(self, name)[:, places] for name in names}
        return replace(self, states=tuple(self.states[place] for place in places), **arrays)

    def warnings(self, state: int) -> tuple[Warning, ...]:
        """Return what the state is, and which runs do not show it or only beyond their dwells."""
        known = np.isfinite(self.drive[:, state])
        warnings = [self.states[state].warning()]
        beyond = np.flatnonzero(known & self.outside[:, state]).tolist()
        if beyond:
            far = [f"{self.runs.name(run)}, {self._away(run, state)}" for run in beyond[:_NAMED]]
            warnings.append(
                Warning(
                    "extrapolated",
                    "extrapolated in {count} of {runs} runs, whose dwells do not enclose this state "
                    "(not recorded there, or stalled): {which}",
                    severity="watch",
                    count=len(beyond),
                    runs=known.size,
                    which="; ".join(far) + _more(beyond),
                )
            )
        silent = np.flatnonzero(self.runs.enough & ~known).tolist()
        if silent:
            named = ", ".join(self.runs.name(run) for run in silent[:_NAMED])
            warnings.append(
                Warning(
                    "runs without a value",
                    "unknown in {count} of {runs} runs, which have other temperatures or too much "
                    "noise: {which}",
                    severity="watch",
                    count=len(silent),
                    runs=known.size,
                    which=named + _more(silent),
                )
            )
        return tuple(warnings)

    def _away(self, run: int, state: int) -> str:
        factor, kelvin = float(self.factor[run, state]), float(self.kelvin[run, state])
        parts = [f"{factor:.3g} times the speed"] if abs(factor - 1.0) > 0.02 else []
        if abs(kelvin) > 1.0:
            parts.append(f"{abs(kelvin):.3g} K {'warmer' if kelvin > 0 else 'colder'}")
        if not parts:
            return "just outside the dwells"
        return f"{' and '.join(parts)} than the nearest dwell".replace("speed than", "speed of")


def _more(places: list[int]) -> str:
    return "; and more" if len(places) > _NAMED else ""


def at_states(
    runs: CampaignRuns, states: Sequence[State], temperatures: Sequence[float | None] = (), *, drawn: int = 0
) -> AtStates:
    """Return what the runs say of states, and of the curve at temperatures (K) with the draws of some runs.

    Raises
    ------
    InsufficientDataError
        If no run has dwells enough.
    """
    kernel = shared_kernel([dwells for _, dwells, _ in runs.usable()])
    shape = (len(runs.dwells), len(states))
    belt, belt_error, drive, drive_error, factor, kelvin = (np.full(shape, np.nan) for _ in range(6))
    outside = np.zeros(shape, dtype=bool)
    speed = np.array([state.speed for state in states])
    temperature = np.array([np.nan if state.temperature is None else state.temperature for state in states])
    places = np.flatnonzero(runs.enough)
    some, alike = (set(places[evenly(places.size, most)].tolist()) for most in (drawn, RUNS))
    curves = [_empty(runs, temperature) for temperature in temperatures]
    leasts: list[list[LeastTorque]] = [[] for _ in curves]
    rests: dict[tuple[int, bool], FloatArray] = {}  # by object: runs of the same rest share it
    for place, dwells, rest in runs.usable():
        surface = TorqueSurface(dwells, kernel)
        at = surface.at(speed, temperature)
        thermal = bool(np.isfinite(dwells.temperature).all() and np.isfinite(temperature).all())
        if (which := (id(rest), thermal)) not in rests:
            at_rest = (
                0.0 if rest is None else rest.torque(speed, temperature=temperature if thermal else None)
            )
            rests[which] = np.zeros(speed.shape) + at_rest
        no_load = rests[which]
        belt[place], belt_error[place] = at.torque, at.error
        together = at.torque + no_load
        drive[place] = np.where(together > 0.0, together, np.nan)  # a no-load torque fitted below nothing
        drive_error[place] = at.error * at.torque / drive[place]
        outside[place], factor[place], kelvin[place] = at.outside, at.factor, at.kelvin
        for curve, least in zip(curves, leasts, strict=True):
            found = _trace(curve, place, surface, keep=place in some, together=place in alike)
            least += [found] if found else []
    put_back = tuple(map(_put_back, curves, leasts))
    return AtStates(
        runs, tuple(states), belt, belt_error, drive, drive_error, outside, factor, kelvin, put_back
    )


def _put_back(curves: Curves, leasts: list[LeastTorque]) -> Curves:
    """Return curves whose least torque lies where it would without smoothing."""
    moved, common = alike_in_all(leasts)
    return replace(curves, least=curves.least * np.exp(-moved), common=common)


def _empty(runs: CampaignRuns, temperature: float | None) -> Curves:
    speeds = np.concatenate([dwells.speed for _, dwells, _ in runs.usable()])
    low, high = float(speeds.min()) / _NEAR, float(speeds.max()) * _NEAR
    grid = np.geomspace(low, high, max(int(np.log(high / low) / _GRID), _FEWEST_SPEEDS))
    count = len(runs.dwells)
    nothing = np.full(count, np.nan)
    none = np.zeros(count, dtype=bool)
    torque = np.full((count, grid.size), np.nan)
    return Curves(temperature, grid, torque, nothing, nothing.copy(), none, none.copy(), {})


def _trace(
    curves: Curves, place: int, surface: TorqueSurface, *, keep: bool, together: bool
) -> LeastTorque | None:
    """Fill in the curve of a run; return its least torque, with what is alike in all runs if ``together``."""
    own = surface.dwells.speed
    near = (curves.speed >= own.min() / _NEAR * _SLIP) & (curves.speed <= own.max() * _NEAR / _SLIP)
    temperature = np.nan if curves.temperature is None else curves.temperature
    if np.count_nonzero(near) < 3 or not surface.covers(temperature):
        return None
    speed = curves.speed[near]
    median = surface.curve(speed, temperature)
    curves.torque[place, near] = median
    drawn = surface.drawn(speed, temperature, DRAWS, seed=0) if keep or together else None
    if keep:
        of_all = np.full((DRAWS, curves.speed.size), np.nan)
        of_all[:, near] = drawn
        curves.drawn[place] = of_all
    least = least_torque(surface, speed, temperature, median, drawn)
    curves.below[place], curves.above[place] = least.below, least.above
    curves.least[place], curves.error[place] = np.exp(least.log_speed), least.error
    return least
