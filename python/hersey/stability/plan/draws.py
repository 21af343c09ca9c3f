"""Machines drawn from what is not known of one, and the rule by which a profile works on them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hersey.arrays import FloatArray
from hersey.damping.distributions import beta_quantile
from hersey.errors import ParameterError
from hersey.machine.uncertainty import Uncertainty
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import BESIDE, AnyDrag
from hersey.motion.parameters import OF_THE_BELT
from hersey.stability.plan.trial import COARSE, Follow, MachineSample, Shape, TemperatureProfile, outcomes

#: Relative distance that a profile for known parameters keeps from failure, in each of them.
_EDGE = 1e-3
#: Machines that say soon whether a profile may work on all: so many, and one in so many.
_FEW, _ONE_IN = 6, 16
#: Least share of the draws that must be machines.
_POSSIBLE = 0.1


def needed(confidence: float, level: float, failures: int) -> int:
    """Return the least number of draws whose bound exceeds the confidence with so many failures."""
    low, high = failures + 1, 2
    while lower_bound(high - failures, high, level) < confidence:
        high *= 2
    while low < high:
        middle = (low + high) // 2
        if lower_bound(middle - failures, middle, level) >= confidence:
            high = middle
        else:
            low = middle + 1
    return low


def most_failures(confidence: float, level: float, count: int) -> int:
    """Return the greatest number of failures among so many draws whose bound still exceeds the confidence."""
    failures = 0
    while lower_bound(count - failures - 1, count, level) >= confidence:
        failures += 1
    return failures


def lower_bound(good: int, count: int, level: float) -> float:
    """Return the bound (Clopper and Pearson) that the true share exceeds with probability ``level``."""
    return float(beta_quantile(1.0 - level, good, count - good + 1)) if good > 0 else 0.0


def drawn(
    train: Drivetrain,
    drag: AnyDrag,
    uncertainty: Mapping[str, Uncertainty],
    samples: Mapping[str, ArrayLike],
    rng: np.random.Generator,
    count: int,
) -> tuple[list[MachineSample], float]:
    """Return machines drawn from what is not known of one, and the share of the draws that are none.

    ``samples`` holds draws that go together (of equal length): rows of it are taken at random. Where it and
    ``uncertainty`` name the same parameter, the samples hold. A stick speed that is not below the transition
    speed is that of no belt: others are drawn in its place.

    Raises
    ------
    ParameterError
        If no parameter has such a name, or fewer than a tenth of the draws are possible.
    """
    machines, made = list[MachineSample](), 0
    nominal = {**vars(train), **vars(drag)}
    while len(machines) < count:
        for values in _rows(nominal, uncertainty, samples, rng, count):
            try:
                machines.append(_machine(train, drag, values))
            except ParameterError as error:
                if error.quantity != "stick_speed":
                    raise error.within("uncertainty: a draw is impossible") from None
        made += count
        if len(machines) < _POSSIBLE * made:
            raise ParameterError(
                "the range of stick_speed extends so far above the transition speed that almost no "
                "draw is possible. Give a smaller range"
            )
    return machines[:count], 1.0 - len(machines) / made


def _rows(
    nominal: Mapping[str, Any],
    uncertainty: Mapping[str, Uncertainty],
    samples: Mapping[str, ArrayLike],
    rng: np.random.Generator,
    count: int,
) -> list[dict[str, float]]:
    """The values of so many draws, by name."""
    columns: dict[str, FloatArray] = {}
    for name in [*uncertainty, *samples]:
        if name not in (*OF_THE_BELT, *BESIDE) or name not in nominal:
            known = ", ".join(key for key in (*OF_THE_BELT, *BESIDE) if key in nominal)
            raise ParameterError(f"uncertainty: unknown parameter '{name}'. Known: {known}")
    for name in sorted(set(uncertainty) - set(samples)):
        columns[name] = uncertainty[name].draw(rng, float(nominal[name]), count)
    if samples:
        rows = {name: np.asarray(values, dtype=float).ravel() for name, values in samples.items()}
        sizes = {values.size for values in rows.values()}
        if len(sizes) != 1 or 0 in sizes:
            raise ParameterError("samples: the arrays must have equal lengths and must not be empty")
        picked = rng.integers(0, sizes.pop(), count)
        columns |= {name: values[picked] for name, values in rows.items()}
    return [{name: float(values[i]) for name, values in columns.items()} for i in range(count)]


def neighbours(train: Drivetrain, drag: AnyDrag) -> list[MachineSample]:
    """Return the machine, and those with one parameter a little off: no profile may stand on the edge."""
    known = {**vars(train), **vars(drag)}
    nominal = {name: float(known[name]) for name in (*OF_THE_BELT, *BESIDE) if known.get(name)}
    moved = [{name: value * (1.0 + by)} for name, value in nominal.items() for by in (-_EDGE, _EDGE)]
    return [MachineSample(train, drag), *(_machine(train, drag, values) for values in moved)]


def _machine(train: Drivetrain, drag: AnyDrag, values: Mapping[str, float]) -> MachineSample:
    of_train: dict[str, Any] = {name: value for name, value in values.items() if hasattr(train, name)}
    of_drag = {name: value for name, value in values.items() if name not in of_train}
    for name, value in of_train.items():
        if value <= 0:
            raise ParameterError(f"{name} is {value:g}: it must be greater than 0")
    changed: AnyDrag = replace(drag, **of_drag) if of_drag else drag  # type: ignore[type-var]
    return MachineSample(replace(train, **of_train), changed)


class Trials:
    """Machines on which a profile must work, all but ``allowed`` of them."""

    def __init__(
        self, machines: Sequence[MachineSample], allowed: int, thermal: TemperatureProfile, force_limit: float
    ) -> None:
        """Keep the machines; those that fail come to the front, so that bad profiles fail soon."""
        self.machines = list(machines)
        self.allowed, self.thermal, self.force_limit = allowed, thermal, force_limit
        self.count = 0

    @property
    def few(self) -> int:
        """How many machines, those that refused others before, say soon whether a profile may work on all."""
        count = len(self.machines)
        return min(_FEW + 2 * self.allowed + count // _ONE_IN, count)

    def time(self, shape: Shape, best: float = math.inf, *, tolerance: float = COARSE) -> float:
        """Return the time at which all but the allowed machines are ready, infinite if not below ``best``."""
        return self._time(self._tried(self.machines, shape, best, tolerance), best)

    def may(self, shape: Shape, best: float, nominal: MachineSample) -> float:
        """Return no more than that, of the nominal machine and those that refused others before."""
        alone, *ready = self._tried([nominal, *self.machines[: self.few]], shape, best, COARSE)
        return self._time(ready, best) if alone < best else math.inf

    def _tried(
        self, machines: Sequence[MachineSample], shape: Shape, best: float, tolerance: float
    ) -> list[float]:
        """When each machine is ready, until more than the allowed fail."""
        found = outcomes(
            machines,
            [shape],
            self.thermal,
            self.force_limit,
            Follow(latest=best, tolerance=tolerance),
            allowed=self.allowed,
        )
        return [outcome.ready for outcome in found]

    def _time(self, ready: list[float], best: float) -> float:
        """When all but the allowed are ready; those that are not come to the front."""
        late = []
        for i, time in enumerate(ready):
            self.count += 1
            if time >= best:
                late.append(i)
                if len(late) > self.allowed:
                    self._to_front(late)
                    return math.inf
        return self.kept(ready)

    def peak(self, shape: Shape) -> float:
        """Return the spring force that all but the allowed machines keep below; infinite if it fails."""
        found = outcomes(self.machines, [shape], self.thermal, how=Follow(force=True))
        return self.kept([f.peak_force if f.ready < math.inf else math.inf for f in found])

    def kept(self, values: Sequence[float]) -> float:
        """Return the value that all but the allowed machines keep below."""
        return sorted(values)[len(values) - 1 - self.allowed]

    def _to_front(self, late: list[int]) -> None:
        hard = [self.machines[i] for i in late]
        for i in reversed(late):
            del self.machines[i]
        self.machines[:0] = hard
