"""How torque deviates from its trend, learned from all runs of a campaign: no run of few dwells shows it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from scipy import optimize

from hersey.arrays import FloatArray
from hersey.errors import InsufficientDataError
from hersey.life.indicators.torque_surface import FEWEST, TEMPERATURE_SCALE, Kernel, Layout, RunDwells

#: Runs from which the kernel is estimated, and dwells of each, at most.
_RUNS, _DWELLS = 24, 60
#: Where the search of the kernel starts, how far that is known, and where it stays: logarithms of deviation,
#: lengths (of temperature in `TEMPERATURE_SCALE`) and scatter, and the tilt in 1/`TEMPERATURE_SCALE`.
_START = np.array([*np.log([0.5, 2.0, 2.0, 0.005]), 0.5])
_KNOWN = np.array([2.0, 1.5, 1.5, 2.0, 1.0])
_LOW = np.array([*np.log([1e-3, 0.2, 0.2, 1e-4]), -3.0])
_HIGH = np.array([*np.log([20.0, 30.0, 30.0, 1.0]), 3.0])


def shared_kernel(runs: Sequence[RunDwells]) -> Kernel:
    """Return the kernel of a campaign by the restricted likelihood of its runs together.

    Of many runs some are used, spread evenly over those given: give them by specimen and age.

    Raises
    ------
    InsufficientDataError
        If no run has enough dwells.
    """
    enough = [run for run in runs if run.speed.size >= FEWEST]
    if not enough:
        raise InsufficientDataError(f"no run has {FEWEST} dwells, so torque between them cannot be estimated")
    used = (vars(_thinned(enough[i])).values() for i in evenly(len(enough), _RUNS))
    return _kernel_of(tuple(tuple(values.tobytes() for values in run) for run in used))


@lru_cache(maxsize=8)
def _kernel_of(used: tuple[tuple[bytes, ...], ...]) -> Kernel:
    """The kernel of the arrays of `RunDwells` of some runs: a campaign is asked for it again and again."""
    layouts = [Layout(RunDwells(*map(np.frombuffer, run))) for run in used]
    numbers = _START
    for tolerance in (1e-4, 1e-7):  # that about which logarithms are taken depends on the kernel, a little
        abouts = [layout.settled(_kernel(numbers)).settled for layout in layouts]
        numbers = _likeliest(layouts, abouts, numbers, tolerance)
    return _kernel(numbers)


def _likeliest(
    layouts: list[Layout], abouts: list[FloatArray], start: FloatArray, tolerance: float
) -> FloatArray:
    def misfit(numbers: FloatArray) -> float:
        # Weak knowledge keeps what no run shows where it was, as the length in temperature of runs of one.
        prior = float(np.sum(((numbers - _START) / _KNOWN) ** 2))
        kernel = _kernel(numbers)
        return prior + sum(map(lambda layout, about: layout.misfit(kernel, about), layouts, abouts))

    found = optimize.minimize(
        misfit,
        start,
        method="L-BFGS-B",
        bounds=list(zip(_LOW, _HIGH, strict=True)),
        options={"ftol": tolerance},
    )
    return np.asarray(found.x)


def _kernel(numbers: FloatArray) -> Kernel:
    deviation, speed, kelvin, scatter = np.exp(numbers[:4]).tolist()
    return Kernel(
        deviation, speed, kelvin * TEMPERATURE_SCALE, float(numbers[4]) / TEMPERATURE_SCALE, scatter
    )


def _thinned(run: RunDwells) -> RunDwells:
    keep = evenly(run.speed.size, _DWELLS)
    return RunDwells(*(values[keep] for values in vars(run).values()))


def evenly(count: int, most: int) -> list[int]:
    """Return places of so many at the most, evenly spread."""
    return sorted({round(place) for place in np.linspace(0, count - 1, min(count, most)).tolist()})
