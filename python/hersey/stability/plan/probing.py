"""The profile that asks least of the drive: the number that would do where none keeps within a limit."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import replace

from hersey.stability.plan.grid import STRETCHES
from hersey.stability.plan.search import Search
from hersey.stability.plan.trial import COARSE, Follow, Outcome, Shape, outcomes

#: Shares of the grids in the profiles tried: the longest take the longest.
_SHARES = (0.6, 0.3, 0.1)
#: Profiles tried.
PROBES = 1500
#: Those of them tried on all machines.
_PROBED = 200
#: Waits among them.
_FEW_WAITS = 5
#: Profiles followed at once, spread over the cores.
_PROBED_TOGETHER = 64


def least(
    search: Search, demand: Callable[[Shape], float] | None = None, probes: int = PROBES
) -> tuple[float, Shape] | None:
    """Return the profile that works with the least demand on the drive, and that demand.

    Without one it is the spring force at the nominal. Of so many profiles of the grid only: the number
    that would do, not the least possible.
    """
    waits = search.waits()
    waits = waits[:: max(1, len(waits) // _FEW_WAITS)]
    tried = []
    for stretch, share in zip(STRETCHES, _SHARES, strict=True):
        rows = list(itertools.product(waits, search.grid(stretch)))
        few = max(1, math.ceil(len(rows) / (probes * share)))
        tried += [replace(shape, wait=wait) for wait, shape in rows[::few]]
    if demand is not None:
        tried.sort(key=demand)
    working: list[tuple[float, Shape]] = []
    for i in range(0, len(tried), _PROBED_TOGETHER):
        search.report(i, len(tried))
        for shape, outcome in _probed(search, tried[i : i + _PROBED_TOGETHER], force=demand is None):
            if outcome.ready == math.inf:
                continue
            if demand is None:
                working.append((outcome.peak_force, shape))
            elif search.trials.time(shape) < math.inf:
                return demand(shape), shape
    working.sort(key=lambda row: row[0])
    even = working[:: max(1, len(working) // _PROBED)]
    return next((row for row in even if search.trials.time(row[1]) < math.inf), None)


def _probed(search: Search, shapes: Sequence[Shape], *, force: bool) -> list[tuple[Shape, Outcome]]:
    """What profiles do to the nominal machine; those of one wait go together."""
    limit, found = search.trials.force_limit, []
    for wait in dict.fromkeys(shape.wait for shape in shapes):
        same = [shape for shape in shapes if shape.wait == wait]
        how = Follow(force=force, tolerance=COARSE)
        done = outcomes([search.nominal], same, search.thermal, limit, how)
        found += list(zip(same, done, strict=True))
    return found


def slower(search: Search, shape: Shape) -> Shape:
    """Return the profile with the least peak speed, to a per cent, that works with the same ramps."""
    low, high = shape.target, shape.peak
    while high - low > 0.01 * high:
        middle = 0.5 * (low + high)
        moved = replace(shape, peak=middle)
        if search.trials.time(moved) < math.inf:
            shape, high = moved, middle
        else:
            low = middle
    return shape
