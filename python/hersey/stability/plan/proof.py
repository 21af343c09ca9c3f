"""What fresh draws of a machine say of a profile, and which draws the search has."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from hersey.machine.uncertainty import Uncertainty
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import AnyDrag
from hersey.stability.plan.draws import Trials, drawn, lower_bound, needed, neighbours
from hersey.stability.plan.trial import (
    ROUNDING,
    Follow,
    MachineSample,
    Outcome,
    Shape,
    TemperatureProfile,
    outcomes,
)

#: Probability with which a profile that passes keeps its confidence: high, for the search tries many.
LEVEL = 0.999
#: Draws of the search that may fail.
_ALLOWED = 2
#: Confidence above which none may, as it asks for thousands of draws.
_STRICT = 0.99
#: Level of the bound of the share that is stated.
_STATED = 0.95
#: Least number of fresh draws behind it.
_FRESH = 1500
#: Least number of machines that may be given.
LEAST_GIVEN = 40
#: Share of the failures asked for that the search allows of machines given.
_STRICTLY = 0.25
#: Machines at the most that the search tries of those given.
_MOST = 250
#: Tolerance of the verification.
_TIGHT = 1e-11
#: Draws followed to the end of the temperature profile.
_LONG = 10
#: Laps for which that is still quick.
_LONG_LAPS = 20_000


@dataclass(frozen=True)
class Proof:
    """What fresh draws say of a profile."""

    duration: float
    share: float
    share_low: float
    draws: int
    failures: Mapping[str, int]
    peak_force: float
    accepted: bool
    machines: list[MachineSample]
    impossible: float


@dataclass(frozen=True)
class Unknown:
    """The machine and what is not known of it."""

    train: Drivetrain
    drag: AnyDrag
    uncertainty: Mapping[str, Uncertainty]
    samples: Mapping[str, ArrayLike]
    seed: int
    machines: Sequence[MachineSample] = ()

    def draws(self, stream: int, count: int) -> list[MachineSample]:
        """Return machines of a stream of random draws; the nominal one alone if all is known."""
        return self.drawn(stream, count)[0]

    def drawn(self, stream: int, count: int) -> tuple[list[MachineSample], float]:
        """Return the same with the share of the draws that are no machine."""
        if self.machines:
            return list(self.machines[1::2] if stream else self.machines[::2]), 0.0
        if not self.uncertainty and not self.samples:
            return [MachineSample(self.train, self.drag)], 0.0
        rng = np.random.default_rng([self.seed, stream])
        return drawn(self.train, self.drag, self.uncertainty, self.samples, rng, count)

    def trials(self, confidence: float, thermal: TemperatureProfile, force_limit: float) -> Trials:
        """Return the machines of the search."""
        if self.machines:
            half = self.draws(0, 0)
            half = half[:: max(math.ceil(len(half) / _MOST), 1)]
            return Trials(half, math.floor(_STRICTLY * (1.0 - confidence) * len(half)), thermal, force_limit)
        if not self.uncertainty and not self.samples:
            return Trials(neighbours(self.train, self.drag), 0, thermal, force_limit)
        allowed = _ALLOWED if confidence <= _STRICT else 0
        machines = self.draws(0, needed(confidence, LEVEL, allowed))
        return Trials(machines, allowed, thermal, force_limit)

    def verify(
        self,
        shape: Shape,
        duration: float,
        thermal: TemperatureProfile,
        force_limit: float,
        confidence: float,
        number: int,
    ) -> Proof:
        """Try a profile on draws that the search has not seen; with heat each makes its temperature."""
        machines, impossible = self.drawn(number, max(_FRESH, math.ceil(10.0 / (1.0 - confidence))))
        laps = thermal.end / machines[0].lap
        long = 0 if thermal.heat is not None else _LONG if laps < _LONG_LAPS else 1

        def tried(machines: Sequence[MachineSample], until: float = 0.0) -> list[Outcome]:
            how = Follow(force=True, until=until, tolerance=_TIGHT)
            return outcomes(machines, [shape], thermal, force_limit, how)

        found = [*tried(machines[:long], thermal.end), *tried(machines[long:])]
        [nominal] = tried([MachineSample(self.train, self.drag)])
        failures = Counter(_failures(found, duration))
        good = len(found) - failures.total()
        share = good / len(found)
        enough = good == 1 if len(found) == 1 else lower_bound(good, len(found), LEVEL) >= confidence
        if self.machines:
            enough = share >= confidence
        return Proof(
            duration=duration,
            share=share,
            share_low=share if len(found) == 1 else lower_bound(good, len(found), _STATED),
            draws=len(found),
            failures=dict(sorted(failures.items())),
            peak_force=float(np.quantile([f.peak_force for f in found], confidence, method="higher")),
            accepted=nominal.ready < math.inf and enough,
            machines=machines,
            impossible=impossible,
        )


def _failures(outcomes: Iterable[Outcome], duration: float) -> Iterable[str]:
    for outcome in outcomes:
        if outcome.ready > duration * (1.0 + ROUNDING):
            yield outcome.why or "sticks longer"
