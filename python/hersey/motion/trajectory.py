"""A motion as it was found: its samples, its changes of mode, where the work went, and a check of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hersey import _core
from hersey.arrays import FloatArray
from hersey.result import Means, Record, Result
from hersey.schema.warning import Warning
from hersey.units import celsius

if TYPE_CHECKING:
    import polars as pl


class Event(NamedTuple):
    """A change of mode: when, from and to which, the condition crossed, and the state there."""

    time: Annotated[float, Means(unit="s")]
    from_mode: str
    to_mode: str
    guard: str
    stretch: Annotated[float, Means(unit="m")]
    belt_speed: Annotated[float, Means(unit="m/s")]


@dataclass(frozen=True)
class Energy(Record):
    """Where the work of the drive went over a run: each figure is its own integral.

    ``slipped`` was lost where the roll slipped on the belt; ``residual`` is what is missing (work less
    dissipated less slipped less stored) as a share of all energy turned over.

    The closure ``retained`` keeps the speed of a belt that it holds, even against a pull that points back:
    there the contact gives energy. With ``heat`` the film does not cool for that: what friction takes
    afterwards pays the debt before it heats. ``owed`` is what is left of the debt at the end, so the
    contact has heated the film by dissipated plus owed, less what the no-load torque took.
    """

    work: Annotated[float, Means("done by the drive", "J")]
    dissipated: Annotated[float, Means("work against drag", "J")]
    slipped: Annotated[float, Means("lost where the drive slips", "J")]
    stored: Annotated[float, Means("growth of kinetic and spring energy", "J")]
    owed: Annotated[float, Means("released by a contact that holds, and not recovered")]
    residual: Annotated[float, Means("work less the other three, as a share of all energy turned over")]


@dataclass(frozen=True)
class SelfCheck(Record):
    """The same run by another integrator: the greatest differences at the samples, as shares of the greatest.

    ``same_events`` is whether both saw the same changes of mode in the same order. ``warnings``
    says why there are no figures, if the other integrator could not finish.
    """

    integrator: str
    speed_difference: float | None
    stretch_difference: float | None
    same_events: bool
    warnings: tuple[Warning, ...] = ()

    def __str__(self) -> str:
        """Return it in words."""
        if self.speed_difference is None:
            return "\n".join(str(each) for each in self.warnings)
        return (
            f"{self.integrator} differs by {self.speed_difference:.1e} in speed and "
            f"{self.stretch_difference:.1e} in stretch, with "
            f"{'the same' if self.same_events else 'DIFFERENT'} events"
        )


@dataclass(frozen=True, repr=False)
class Trajectory(Result):
    """Motion at equally spaced times: arrays of shape (samples,), all changes of mode, and energies.

    ``stretch`` is drive position minus belt position; with a torque drive, the position of the mass (zero
    without a spring). ``spring_force`` is stiffness times stretch; ``slipping`` is true where the roll slips
    on the belt. ``film_temperature`` and ``roll_temperature`` (K) are given if they are states.
    """

    also_stated = ("mode",)
    not_stated = ("mode_index",)

    time: Annotated[FloatArray, Means(unit="s")]
    belt_speed: Annotated[FloatArray, Means(unit="m/s")]
    stretch: Annotated[FloatArray, Means(unit="m")]
    spring_force: Annotated[FloatArray, Means(unit="N")]
    mode_index: NDArray[np.uint8]
    slipping: Annotated[NDArray[np.bool_], Means("whether the drive slips")]
    events: tuple[Event, ...]
    energy: Energy
    steps: int
    check: SelfCheck | None = None
    film_temperature: Annotated[FloatArray | None, Means("if it is computed", "K")] = None
    roll_temperature: Annotated[FloatArray | None, Means("if it is computed", "K")] = None

    @cached_property
    def mode(self) -> NDArray[np.str_]:
        """Mode at each sample: ``ehl``, ``mixed``, ``microslip`` or ``stuck``."""
        return np.array(_core.MODES)[self.mode_index]

    @property
    def roll_slips(self) -> list[tuple[float, float]]:
        """Start and end times of roll slip on the belt; the last may end with the motion."""
        begins = [float(self.time[0])] if self.slipping[0] else []
        begins += [event.time for event in self.events if event.guard == "grip_lost"]
        ends = [event.time for event in self.events if event.guard == "grip_regained"]
        spans = zip(begins, [*ends, float(self.time[-1])], strict=False)
        return [(begin, end) for begin, end in spans if end > begin]

    def slipping_in_words(self, shown: Callable[[float], str] = "{:.6g}".format) -> str:
        """Return when and how long the roll slips as text; empty if it never does.

        ``shown`` writes a time, with its unit.
        """
        if not (spans := self.roll_slips):
            return ""
        total, begin = sum(end - begin for begin, end in spans), spans[0][0]
        if len(spans) == 1:
            return f"the drive slips for {shown(total)}, starting at {shown(begin)}"
        times = f"{len(spans)} times for {shown(total)} in total"
        return f"the drive slips {times}, first at {shown(begin)}"

    def summary(self) -> str:
        """Return ranges, energies and check as text, in the units of the arguments."""
        owed = [f"  {self.energy.owed:.3g} J released by the contact were not recovered"]
        lines = [
            (
                f"{self.time.size} samples from {self.time[0]:.6g} to {self.time[-1]:.6g}, "
                f"{len(self.events)} changes of mode; in SI or the units given"
            ),
            f"  sliding speed   {self.belt_speed.min():.6f} to {self.belt_speed.max():.6f}",
            f"  stretch         {self.stretch.min():.6f} to {self.stretch.max():.6f}",
            f"  spring force    {self.spring_force.min():.6f} to {self.spring_force.max():.6f}",
            *self._heating(),
            *(owed if self.energy.owed else []),
            *([f"  {self.slipping_in_words()}"] if self.roll_slips else []),
            f"energy balance: {self.energy.residual:.1e} of the converted energy is missing",
        ]
        return "\n".join([*lines, *([] if self.check is None else [str(self.check)])])

    def _temperatures(self) -> dict[str, FloatArray]:
        """The temperatures that are states, K, by body."""
        bodies = {"film": self.film_temperature, "roll": self.roll_temperature}
        return {name: kelvin for name, kelvin in bodies.items() if kelvin is not None}

    def _heating(self) -> list[str]:
        return [
            f"  {name:15s} {celsius(kelvin[0]):.2f} to {celsius(kelvin[-1]):.2f} degC"
            for name, kelvin in self._temperatures().items()
        ]

    def to_frame(self) -> pl.DataFrame:
        """Return one row per sample; the SI units in the names stand for the units given."""
        import polars as pl

        return pl.DataFrame(
            {
                "time (s)": self.time,
                "belt speed (m/s)": self.belt_speed,
                "stretch (m)": self.stretch,
                "spring force (N)": self.spring_force,
                "mode": self.mode,
                "roll slips": self.slipping,
                **{f"{name} (K)": kelvin for name, kelvin in self._temperatures().items()},
            }
        )
