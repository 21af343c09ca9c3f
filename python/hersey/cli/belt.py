"""The options that describe a belt, its spring and its drag."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from hersey.cli.groups import option
from hersey.cli.options import BRISTLE_DAMPING, BRISTLES
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.cli.amounts import Amounts
    from hersey.machine.machine import Machine
    from hersey.machine.motor import MotorUse
    from hersey.motion.belt import Drivetrain
    from hersey.motion.drag import PowerDrag
    from hersey.motion.trajectory import Trajectory

#: Damping exponents of the paper's baseline.
_EXPONENTS = {"ehl_exponent": -0.7, "mixed_exponent": -1.2}
#: Numbers of a belt that are optional.
_OPTIONAL = ("bristle_stiffness", "bristle_damping", "static_force")


#: Heading of these options in the help.
_PANEL = "The drive: mass, spring and drag"
_STIFFNESS = "Spring stiffness k, e.g. '11 N/mm'.  [default: 1000]"
_MASS = "Moving mass m, e.g. '11 kg'.  [default: 1]"
_TRANSITION_FORCE = "Drag at the transition speed (B0), e.g. '14 N'.  [default: 50]"
_TRANSITION_SPEED = "Speed of least drag, where the branches meet, e.g. '25 mm/s'.  [default: 1]"
_EHL = "Damping exponent above the transition speed.  [default: -0.7]"
_MIXED = "Damping exponent below the transition speed.  [default: -1.2]"
_STICK_SPEED = "Speed below which it sticks, e.g. '0.3 mm/s'.  [default: 0.01]"
_STATIC_FORCE = "Break-away drag, e.g. '40 N'.  [default: e times the drag at the stick speed]"
_TABLE = "CSV of the drag curve, columns 'speed (mm/s)' and 'force (N)', instead of branches."
_CLOSURE = "Motion below the stick speed: retained, stiction, stribeck or lugre."
_MACHINE = "Machine file, for stiffness, mass and stick speed that are not given."


def _of_belt(words: str, **more: Any) -> Any:
    return option(words, panel=_PANEL, **more)


@dataclass(frozen=True)
class Belt:
    """The options that describe a belt, its spring and its drag; the defaults are the paper's baseline.

    Numbers are texts, with a unit or bare in any consistent set of units: see `hersey.cli.amounts`.
    """

    stiffness: Annotated[str | None, _of_belt(_STIFFNESS)] = None
    mass: Annotated[str | None, _of_belt(_MASS)] = None
    transition_force: Annotated[str | None, _of_belt(_TRANSITION_FORCE)] = None
    transition_speed: Annotated[str | None, _of_belt(_TRANSITION_SPEED)] = None
    ehl_exponent: Annotated[float | None, _of_belt(_EHL)] = None
    mixed_exponent: Annotated[float | None, _of_belt(_MIXED)] = None
    stick_speed: Annotated[str | None, _of_belt(_STICK_SPEED)] = None
    static_force: Annotated[str | None, _of_belt(_STATIC_FORCE)] = None
    drag_table: Annotated[Path | None, _of_belt(_TABLE, metavar="FILE")] = None
    closure: Annotated[str, _of_belt(_CLOSURE)] = "retained"
    bristle_stiffness: Annotated[str | None, _of_belt(BRISTLES)] = None
    bristle_damping: Annotated[str | None, _of_belt(BRISTLE_DAMPING)] = None
    machine: Annotated[Path | None, _of_belt(_MACHINE, metavar="TOML")] = None

    def parts(
        self, *, needed: tuple[str, ...] = (), **further: str | None
    ) -> tuple[Drivetrain, PowerDrag, Amounts]:
        """Return drivetrain, drag and all numbers; ``further`` are those of the command.

        Those of ``further`` that are in ``needed`` default to the paper's baseline.
        """
        from hersey.cli.amounts import amounts
        from hersey.cli.columns import read_drag_table
        from hersey.motion.belt import Drivetrain
        from hersey.motion.drag import Drag

        no_number = (*_EXPONENTS, "closure", "machine", "drag_table")
        texts = {f.name: getattr(self, f.name) for f in fields(self) if f.name not in no_number}
        if self.drag_table is not None:
            self._check_table(texts)
        numbers = amounts(
            {**texts, **further},
            needed=(*(name for name in texts if name not in _OPTIONAL), *needed),
            machine_file=self.machine,
        )
        of_belt: dict[str, Any] = {name: numbers.values[name] for name in texts}
        train = Drivetrain(of_belt.pop("stiffness"), of_belt.pop("mass"))
        drag: PowerDrag
        if self.drag_table is None:
            stated = {name: getattr(self, name) for name in _EXPONENTS}
            exponents = _EXPONENTS | {name: value for name, value in stated.items() if value is not None}
            drag = Drag(**of_belt, **exponents, closure=self.closure)
        else:
            if not numbers.in_si:
                raise ParameterError("--drag-table has units: give the other numbers with units too")
            drag = read_drag_table(self.drag_table, **of_belt, closure=self.closure)
        if self.machine is None:
            return train, drag, numbers
        from hersey.machine.machine import read_machine

        return _of_the_machine(train, drag, numbers, read_machine(self.machine))

    def _check_table(self, texts: dict[str, str | None]) -> None:
        """Refuse numbers of the branches together with a drag table, and a table without a stick speed."""
        of_branches = {name: texts.pop(name) for name in ("transition_force", "transition_speed")}
        for name, value in {**of_branches, **{n: getattr(self, n) for n in _EXPONENTS}}.items():
            if value is not None:
                raise ParameterError(
                    f"--drag-table and --{name.replace('_', '-')} exclude each other: give one of them"
                )
        if texts["stick_speed"] is None and self.machine is None:
            raise ParameterError("--drag-table needs the stick speed: add --stick-speed '0.3 mm/s'")

    def motor_use(self, run: Trajectory) -> MotorUse | None:
        """Return the motor torque that a motion needs, None if the machine file states no motor torque."""
        if self.machine is None:
            return None
        from hersey.machine.machine import read_machine
        from hersey.machine.motor import motor_use

        machine = read_machine(self.machine)
        if machine.limits.motor_torque is None:
            return None
        return motor_use(run, motor_torque=machine.limits.motor_torque, roll_radius=machine.roll_radius)


def _of_the_machine(
    train: Drivetrain, film: PowerDrag, numbers: Amounts, machine: Machine
) -> tuple[Drivetrain, PowerDrag, Amounts]:
    """The belt as given, with the grip of the roll and the no-load torque of the machine file."""
    from hersey.cli.figures import three
    from hersey.damping.no_load_torque import with_rest
    from hersey.motion.drag import DragTable
    from hersey.schema.noun import puller_of
    from hersey.units import celsius

    train = machine.limits.gripping(replace(train, part=machine.part))
    drag, notes = film, [numbers.filled]
    kelvin = None
    if machine.rest is not None:
        # a curve without a temperature has the no-load torque of that log's own temperature
        kelvin = machine.rest.reference_temperature if isinstance(film, DragTable) else None
        drag = with_rest(film, machine.rest, machine.roll_radius, kelvin)
    if drag != film:
        at = "" if kelvin is None else f" (at {celsius(kelvin):.0f} °C)"
        notes.append(f"The no-load torque is added to the drag: {machine.rest}{at}.")
    if train.grip is not None:
        notes.append(f"The {puller_of(train.part)} can pull with up to {three(train.grip, 'N')}.")
    if train.grip is not None and drag.holding_force > train.grip:
        notes.append(f"It cannot start from rest, which takes {three(drag.holding_force, 'N')}.")
    return train, drag, replace(numbers, filled=" ".join(filter(None, notes)))
