"""What moves: a drivetrain with its drag, or a machine file with the fitted law of its log."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any, Protocol, TypeAlias, TypeVar, cast

import numpy as np

from hersey.errors import ParameterError
from hersey.motion.drag import AnyDrag, PowersOfTemperature
from hersey.motion.whole_torque import refuse_whole_torque
from hersey.result import Means, Record
from hersey.schema.noun import DRIVE, Noun
from hersey.units import takes_si

T = TypeVar("T")


@takes_si(stiffness="stiffness", mass="mass", grip="force")
@dataclass(frozen=True)
class Drivetrain(Record):
    """Spring of ``stiffness`` (gear train, and what else yields) and moving ``mass``.

    ``grip`` is the largest force before the drive slips on the part that it moves, such as a roll on a belt:
    friction times load. Default: it never slips, as Eq. 11 assumes. ``part`` names what slides.
    """

    stiffness: Annotated[float, Means(unit="N/m")]
    mass: Annotated[float, Means(unit="kg")]
    grip: Annotated[float | None, Means("largest force before the drive slips on what it moves", "N")] = None
    part: Annotated[Noun, Means("what slides, in a word")] = DRIVE

    @classmethod
    @takes_si(stiffness="torsional stiffness", inertia="moment of inertia", roll_radius="length")
    def rotational(cls, *, stiffness: float, inertia: float, roll_radius: float) -> Drivetrain:
        """Return the drivetrain at the surface of a roll: k = K/r^2, m = J/r^2.

        Parameters
        ----------
        stiffness
            Torsional stiffness K, N m/rad.
        inertia
            Moment of inertia J, kg m^2.
        roll_radius
            m.

        Examples
        --------
        >>> Drivetrain.rotational(stiffness=2.0, inertia=4e-4, roll_radius=0.02).mass
        1.0
        """
        for name, value in (("stiffness", stiffness), ("inertia", inertia), ("roll_radius", roll_radius)):
            if not value > 0 or not np.isfinite(value):
                raise ParameterError(f"{name} is {value}: it must be greater than 0")
        return cls(stiffness / roll_radius**2, inertia / roll_radius**2)

    @property
    def free_period(self) -> float:
        """Period of spring and mass without drag, s: 2 pi sqrt(m/k)."""
        return 2.0 * math.pi * math.sqrt(self.mass / self.stiffness)

    @property
    def _arguments(self) -> tuple[float, float, float | None]:
        return float(self.stiffness), float(self.mass), None if self.grip is None else float(self.grip)


class StatedMachine(Protocol):
    """A machine file, `hersey.machine.Machine`."""

    @property
    def train(self) -> Drivetrain:
        """Stiffness, mass and grip at the belt."""

    @property
    def belt(self) -> dict[str, Any]:
        """Roll radius, the stick speed with its temperature and rule, and the no-load torque."""


class FittedLaw(Protocol):
    """A law of the torque at the roll, `hersey.DampingSurface`."""

    def drag(self, *, temperature: float | None = None, **belt: Any) -> AnyDrag:
        """Return the drag at the belt."""


Train: TypeAlias = "Drivetrain | StatedMachine"
BeltDrag: TypeAlias = "AnyDrag | FittedLaw"


def belt_of(
    train: Train, drag: BeltDrag, temperature: T, **speeds: Any
) -> tuple[Drivetrain, AnyDrag, T | None]:
    """Return drivetrain, drag and temperature; of a machine with all that its file says of the belt.

    A stick speed that is ``fixed`` holds at one temperature (K): the drag is that there, and varies no more.
    Warns with `ExtrapolationWarning` if the temperature, or one of the ``speeds`` (m/s) by the name of its
    argument, is outside the log of the drag; the drag returned warns no more.

    Raises
    ------
    ParameterError
        If a fitted law comes with a drivetrain, which knows neither radius nor stick speed, or was fitted to
        the whole torque although the machine states a no-load torque.
    """
    machine = cast("StatedMachine", train) if hasattr(train, "belt") else None
    plain = cast("Drivetrain", train) if machine is None else machine.train
    if isinstance(drag, AnyDrag):
        if machine is not None:
            _refuse_whole_torque(drag, machine.belt["rest"])
        return plain, _warned(drag, temperature, speeds), temperature
    if machine is None:
        raise ParameterError(
            "a fitted surface needs radius and stick speed of the machine. Give read_machine(...) "
            "instead of its train, or surface.drag(...) instead of the surface"
        )
    if machine.belt["stick_speed_rule"] == "fixed" and isinstance(temperature, int | float):
        at_one = drag.drag(**machine.belt, temperature=temperature)
        return plain, _warned(at_one, None, speeds), None
    return plain, _warned(drag.drag(**machine.belt), temperature, speeds), temperature


def _refuse_whole_torque(drag: AnyDrag, stated: object) -> None:
    """Refuse the drag of a log whose whole torque it holds, with a machine that states a no-load torque."""
    log = getattr(drag, "measured", None)
    if stated is not None and log is not None and log.whole_torque:
        refuse_whole_torque(
            "drag is of a fit to",
            stated,
            "write drag = hersey.fit(points.without(machine.rest)).drag(**machine.belt)",
        )


def _warned(drag: AnyDrag, temperature: Any, speeds: dict[str, Any]) -> AnyDrag:
    """Warn of what is outside the log of a drag, and return it without its range."""
    if not isinstance(drag, PowersOfTemperature):
        return drag
    return cast("AnyDrag", drag.warned(temperature, stacklevel=5, **speeds))
