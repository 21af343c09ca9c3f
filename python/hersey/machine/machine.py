"""`machine.toml`: what the log cannot tell, each value with its unit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from hersey.errors import ParameterError, UnitError
from hersey.files.toml import read_toml
from hersey.files.toml_values import values
from hersey.lubrication.contact import Contact
from hersey.lubrication.lubricant import Lubricant
from hersey.machine.nip import read_contact, read_lubricant
from hersey.machine.uncertainty import Uncertainty, read_uncertainty
from hersey.motion.simulation import Drivetrain

#: Kind of unit, least and greatest value that a sliding drive could have, in SI.
_DRIVETRAIN = {
    "stiffness": ("stiffness", 1.0, 1e10),
    "mass": ("mass", 1e-6, 1e6),
    "roll_radius": ("length", 1e-5, 100.0),
    "stick_speed": ("belt speed", 1e-9, 10.0),
}
_LIMITS = {
    "motor_torque": ("torque", 1e-6, 1e6),
    "roll_friction": (None, 1e-3, 10.0),
    "nip_load": ("force", 1e-3, 1e7),
    "acceleration": ("acceleration", 1e-6, 1e5),
    "speed": ("belt speed", 1e-6, 1e3),
    "spring_force": ("force", 1e-6, 1e7),
}
_POINT = {"speed": ("belt speed", 1e-6, 1e3), "temperature": ("temperature", 150.0, 1000.0)}
_TABLES = ("drivetrain", "limits", "contact", "lubricant", "points", "uncertainty")


@dataclass(frozen=True)
class Limits:
    """What the machine can bear, in SI; none where nothing is stated.

    ``motor_torque`` (N m) at the roll, ``roll_friction`` (coefficient) and ``nip_load`` (N), whose product is
    the drag at which the belt slips on the roll, ``acceleration`` (m/s^2) and ``speed`` (m/s) of the drive,
    ``spring_force`` (N) in the gear train.
    """

    motor_torque: float | None = None
    roll_friction: float | None = None
    nip_load: float | None = None
    acceleration: float | None = None
    speed: float | None = None
    spring_force: float | None = None

    @property
    def grip(self) -> float | None:
        """Drag at which the belt slips on the roll (N), if friction and load are stated."""
        if self.roll_friction is None or self.nip_load is None:
            return None
        return self.roll_friction * self.nip_load


@dataclass(frozen=True)
class OperatingPoint:
    """A named state of the machine: belt speed (m/s) and temperature (K)."""

    name: str
    speed: float
    temperature: float


@dataclass(frozen=True)
class Machine:
    """The machine, in SI.

    ``stiffness`` (N/m) and ``mass`` (kg) at the belt, ``roll_radius`` (m) at which torque acts on it, and
    ``stick_speed`` (m/s) below which the belt sticks. ``uncertainty`` says how far parameters are known.
    ``contact`` and ``lubricant`` make the film, if they are stated.
    """

    stiffness: float
    mass: float
    roll_radius: float
    stick_speed: float
    limits: Limits = Limits()
    points: tuple[OperatingPoint, ...] = ()
    uncertainty: Mapping[str, Uncertainty] = field(default_factory=dict)
    contact: Contact | None = None
    lubricant: Lubricant | None = None

    @property
    def train(self) -> Drivetrain:
        """The drivetrain of the motion."""
        return Drivetrain(self.stiffness, self.mass)


def read_machine(path: str | Path) -> Machine:
    """Read ``[drivetrain]``, and the other tables if they are there.

    These are ``[limits]``, ``[contact]``, ``[lubricant]``, ``[[points]]`` and ``[uncertainty]``.

    Every value is a string such as ``"11 N/mm"``; an uncertainty is ``"10 %"`` or ``"0.1 mm/s to 1 mm/s"``
    (see `Uncertainty`).

    Raises
    ------
    MissingFileError, ParameterError, UnitError
        Each names the file and the key.
    """
    path = Path(path)
    document = read_toml(path)
    if not isinstance(document.get("drivetrain"), dict):
        raise ParameterError(f"{path.name}: there is no table [drivetrain]")
    unknown = sorted(set(document) - set(_TABLES))
    if unknown:
        raise ParameterError(f"{path.name}: there is no table '{unknown[0]}': {', '.join(_TABLES)} are known")
    own = values(path.name, "drivetrain", document["drivetrain"], _DRIVETRAIN)
    for key in _DRIVETRAIN:
        if key not in own:
            raise ParameterError(f"{path.name}: [drivetrain] lacks '{key}'")
    limits = values(path.name, "limits", document.get("limits", {}), _LIMITS)
    return Machine(
        **own,
        limits=Limits(**limits),
        points=_points(path.name, document.get("points", [])),
        uncertainty=_uncertainty(path.name, document.get("uncertainty", {})),
        contact=_contact(path.name, document, own["roll_radius"], limits.get("nip_load")),
        lubricant=read_lubricant(path.name, document["lubricant"]) if "lubricant" in document else None,
    )


def _points(file: str, rows: object) -> tuple[OperatingPoint, ...]:
    if not isinstance(rows, list):
        raise ParameterError(f"{file}: write each point as a table of its own, [[points]]")
    points = []
    for number, row in enumerate(rows, 1):
        where = f"points {number}"
        if not isinstance(row, dict):
            raise ParameterError(f"{file}: {where} is not a table: write [[points]]")
        name = row.get("name", f"point {number}")
        if not isinstance(name, str) or not name.strip():
            raise ParameterError(f"{file}: {where}: name is not a text")
        stated = values(file, where, {key: v for key, v in row.items() if key != "name"}, _POINT)
        for key in _POINT:
            if key not in stated:
                raise ParameterError(f"{file}: {where} lacks '{key}'")
        points.append(OperatingPoint(name, **stated))
    return tuple(points)


def _uncertainty(file: str, table: object) -> dict[str, Uncertainty]:
    if not isinstance(table, dict):
        raise ParameterError(f"{file}: uncertainty is not a table: write [uncertainty]")
    uncertainties = {}
    for key, text in table.items():
        try:
            uncertainties[key] = read_uncertainty(key, text)
        except UnitError as error:
            raise UnitError(f"{file}: uncertainty.{key}: {error}") from None
        except ParameterError as error:
            raise error.within(f"{file}: uncertainty.{key}") from None
    return uncertainties


def _contact(file: str, document: Mapping[str, object], radius: float, load: float | None) -> Contact | None:
    """The contact, with radius and load from the other tables where its own does not state them."""
    if "contact" not in document:
        return None
    return read_contact(file, document["contact"], roll_radius=radius, load=load)
