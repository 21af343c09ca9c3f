"""Made-up measurements: what a file shows is what is true, so that it can be compared exactly."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

#: SI per unit as it is written.
SCALES = {"mN*m": 1e-3, "N*m": 1.0, "N*cm": 1e-2, "rpm": np.pi / 30, "rad/s": 1.0, "s": 1.0, "ms": 1e-3}


@dataclass
class Step:
    """Rows at one speed, in s, mN m, rpm and degC, each as a text with its decimals."""

    speed: float
    time: list[str]
    torque: list[str]
    turning: list[str]
    temperature: list[str]

    def __len__(self) -> int:
        """Return how many rows it has."""
        return len(self.time)

    def cells(self, *names: str) -> list[list[str]]:
        """Return rows of the named channels."""
        return [list(row) for row in zip(*(getattr(self, name) for name in names), strict=True)]


def staircase(
    seed: int,
    speeds: tuple[float, ...] = (10, 20, 40, 80),
    rows: int | tuple[int, ...] = 40,
    *,
    restart: bool = False,
    every: float = 0.5,
) -> list[Step]:
    """Return a staircase of speeds; ``restart``: each step has a clock of its own."""
    draw = np.random.default_rng(seed)
    counts = (rows,) * len(speeds) if isinstance(rows, int) else rows
    steps, start = [], 0
    for at, (speed, count) in enumerate(zip(speeds, counts, strict=True)):
        ticks = every * (np.arange(count) + (0 if restart else start))
        torque = 40 + 25 * speed**-0.5 + 0.05 * speed + draw.normal(0, 0.3, count)
        turning = speed + draw.normal(0, 0.02, count)
        temperature = 40 + 2 * at + draw.normal(0, 0.05, count)
        steps.append(
            Step(
                speed,
                [f"{each:.2f}" for each in ticks],
                [f"{each:.3f}" for each in torque],
                [f"{each:.2f}" for each in turning],
                [f"{each:.1f}" for each in temperature],
            )
        )
        start += count
    return steps


@dataclass(frozen=True)
class Truth:
    """What must be read, SI, all rows in the order of the file; ``temperature`` may be missing.

    ``time`` counts from the start of each run; ``runs`` are the rows at which one starts.
    """

    torque: np.ndarray
    speed: np.ndarray
    time: np.ndarray
    temperature: np.ndarray | None = None


@dataclass(frozen=True)
class Made:
    """A file that was written, and what it holds; ``options`` a user knows and the file does not say."""

    truth: Truth
    options: dict[str, str] = field(default_factory=dict)


def truth(
    steps: list[Step], *, set_point: bool = False, temperature: bool = True, torque_scale: float = 1e-3
) -> Truth:
    """Return what is to be read of steps; with ``set_point`` the speed is that of each step."""
    of = [np.full(len(s), s.speed) if set_point else np.array(s.turning, float) for s in steps]
    celsius = np.concatenate([np.array(s.temperature, float) for s in steps])
    return Truth(
        np.concatenate([np.array(s.torque, float) for s in steps]) * torque_scale,
        np.concatenate(of) * np.pi / 30,
        np.concatenate([np.array(s.time, float) for s in steps]),
        celsius + 273.15 if temperature else None,
    )
