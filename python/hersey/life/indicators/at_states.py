"""What the runs of a campaign say of some states: torque there, and its curve against speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.life.indicators.load_cases import State
from hersey.life.indicators.run_dwells import CampaignRuns
from hersey.life.indicators.torque_surface import TorqueSurface, shared_kernel
from hersey.schema.warning import Warning

#: Runs that a warning names.
_NAMED = 3
#: Factor beyond the slowest and the fastest dwell of a run up to which its curve is asked; what rounds off.
_NEAR, _SLIP = 1.25, 0.999
#: Steps of the curve in ln speed, its points at the least, and how many draws give an error.
_GRID, _FEWEST_SPEEDS, _DRAWS = 0.08, 24, 32


@dataclass(frozen=True)
class Curves:
    """Torque of the belt against speed at one temperature (K; None where no run recorded any), of all runs.

    ``speed`` in rad/s, shape (speeds,); ``torque`` in N m, (runs, speeds), NaN where a run does not show it:
    beyond its dwells and what lies near them. ``least`` is the speed of least torque, (runs,), NaN where it
    lies at no speed between, and ``error`` its relative standard error; ``drawn`` are joint draws of some
    runs, (draws, speeds) each. ``below`` and ``above`` mark runs whose torque is least at their slow or fast
    end.
    """

    temperature: float | None
    speed: FloatArray
    torque: FloatArray
    least: FloatArray
    error: FloatArray
    below: BoolArray
    above: BoolArray
    drawn: dict[int, FloatArray]


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
    some = set(places[np.linspace(0, places.size - 1, min(drawn, places.size)).round().astype(int)].tolist())
    curves = [_empty(runs, temperature) for temperature in temperatures]
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
        for curve in curves:
            _trace(curve, place, surface, keep=place in some)
    return AtStates(
        runs, tuple(states), belt, belt_error, drive, drive_error, outside, factor, kelvin, tuple(curves)
    )


def _empty(runs: CampaignRuns, temperature: float | None) -> Curves:
    speeds = np.concatenate([dwells.speed for _, dwells, _ in runs.usable()])
    low, high = float(speeds.min()) / _NEAR, float(speeds.max()) * _NEAR
    grid = np.geomspace(low, high, max(int(np.log(high / low) / _GRID), _FEWEST_SPEEDS))
    count = len(runs.dwells)
    nothing = np.full(count, np.nan)
    none = np.zeros(count, dtype=bool)
    torque = np.full((count, grid.size), np.nan)
    return Curves(temperature, grid, torque, nothing, nothing.copy(), none, none.copy(), {})


def _trace(curves: Curves, place: int, surface: TorqueSurface, *, keep: bool) -> None:
    """Fill in the curve of a run."""
    own = surface.dwells.speed
    near = (curves.speed >= own.min() / _NEAR * _SLIP) & (curves.speed <= own.max() * _NEAR / _SLIP)
    temperature = np.nan if curves.temperature is None else curves.temperature
    if np.count_nonzero(near) < 3 or not surface.covers(temperature):
        return
    median, drawn = surface.curve(curves.speed[near], temperature, _DRAWS, seed=0)
    curves.torque[place, near] = median
    if keep:
        of_all = np.full((_DRAWS, curves.speed.size), np.nan)
        of_all[:, near] = drawn
        curves.drawn[place] = of_all
    at = np.log(curves.speed[near])
    least, where = _least(at, np.vstack([median, drawn]))
    curves.below[place], curves.above[place] = where[0] == 0, where[0] == at.size - 1
    if not (curves.below[place] or curves.above[place]):
        curves.least[place] = np.exp(least[0])
        curves.error[place] = float(np.sqrt(np.mean((least[1:] - least[0]) ** 2)))


def _least(at: FloatArray, torque: FloatArray) -> tuple[FloatArray, IntArray]:
    """Where curves are least, by a parabola through three points of ln torque; and the nearest point."""
    logs = np.log(torque)
    where = np.argmin(logs, axis=1)
    middle = np.clip(where, 1, at.size - 2)[:, None]
    before, here, after = (np.take_along_axis(logs, middle + step, axis=1)[:, 0] for step in (-1, 0, 1))
    bend = before - 2.0 * here + after
    step = np.clip(0.5 * (before - after) / np.where(bend > 0, bend, np.inf), -0.5, 0.5)
    inside = where == middle[:, 0]
    return at[where] + np.where(inside, step, 0.0) * (at[1] - at[0]), where
