"""`machine.toml`: what the log cannot tell, each value with its unit."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from dataclasses import dataclass as plain_dataclass
from dataclasses import field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import BeforeValidator
from pydantic.dataclasses import dataclass

from hersey.damping.no_load_torque import NoLoadTorque, with_rest
from hersey.damping.surface import WITH_TRANSITION
from hersey.errors import MAPPING, ParameterError, PlausibilityWarning, printable
from hersey.files.text import read_text
from hersey.files.toml import Quantity, Table, at_line, naming, read_tables, read_toml
from hersey.files.toml_lines import line_of
from hersey.log.sensor_tables import SensorTables, sensors_of
from hersey.log.sensors import Sensors
from hersey.lubrication.asperities import Asperities, BoundaryFriction
from hersey.lubrication.contact import Contact
from hersey.lubrication.lubricant import Lubricant
from hersey.lubrication.mixed import MixedContact, mixed_contact
from hersey.lubrication.mixed_drag import MixedDrag
from hersey.machine.at_belt import AtBelt
from hersey.machine.doubts import doubts, thousands
from hersey.machine.duty import GearTable, LifeTable, refuse_other_than_all
from hersey.machine.finding import refuse_missing
from hersey.machine.heat import HeatTable
from hersey.machine.limits import Limits, OperatingPoint
from hersey.machine.nip import ContactTable, LubricantTable
from hersey.machine.no_load import RestTable
from hersey.machine.sharing import NEEDED, AsperitiesTable, BoundaryTable
from hersey.machine.uncertainty import Uncertainty, read_uncertainty, refuse_value_outside
from hersey.motion.belt import Drivetrain
from hersey.motion.heat import HeatBalance
from hersey.schema.noun import DRIVE, Noun
from hersey.schema.warning import Warning
from hersey.units import takes_si

#: Belt speed (m/s) whose film says which law holds, where the machine states no points.
_USUAL_SPEED = 0.1


#: What a file is that has such a key, and where it belongs.
_OTHER_FILES = {"parameters": ("scenario", "hersey sweep"), "logs": ("recipe", "hersey fit")}
#: Kinds of the units in which the numbers of a machine may be given.
_KINDS = {
    "stiffness": "stiffness",
    "mass": "mass",
    "roll_radius": "length",
    "stick_speed": "belt speed",
    "stick_speed_temperature": "temperature",
}


@takes_si(**_KINDS)
@plain_dataclass(frozen=True)
class Machine:
    """The machine, in SI.

    ``part`` names what slides. ``stiffness`` (N/m) and ``mass`` (kg) where it slides, ``roll_radius`` (m) at
    which torque acts on it, and ``stick_speed`` (m/s) below which it sticks: at
    ``stick_speed_temperature`` (K; None: the reference of the fit), at others by ``stick_speed_rule`` (see
    `DampingSurface.stick_speed_at`). ``uncertainty``
    says how far parameters are known. ``contact`` and ``lubricant`` make the film, if they are stated.
    ``sensors`` are those of its logs, so far as a log's own mapping states no errors of them. ``rest`` is
    what the drive takes besides the film, ``heat`` what makes its temperature, from a cold start.
    ``asperities`` and ``boundary`` share the load with the film; ``static_friction`` is that at
    rest (None: e times the drag at the stick speed). ``life`` and ``gear`` say how it is used, and what a
    life test asks of it.
    """

    stiffness: float
    mass: float
    roll_radius: float
    stick_speed: float
    stick_speed_temperature: float | None = None
    stick_speed_rule: str = WITH_TRANSITION
    limits: Limits = field(default_factory=Limits)
    points: tuple[OperatingPoint, ...] = ()
    uncertainty: Mapping[str, Uncertainty] = field(default_factory=dict)
    contact: Contact | None = None
    lubricant: Lubricant | None = None
    sensors: Sensors = field(default_factory=Sensors)
    rest: NoLoadTorque | None = None
    asperities: Asperities | None = None
    boundary: BoundaryFriction | None = None
    static_friction: float | None = None
    life: LifeTable = field(default_factory=LifeTable)
    gear: GearTable | None = None
    heat: HeatBalance | None = None
    part: Noun = DRIVE

    def __repr__(self) -> str:
        """Return what moves the belt, with units, and how many operating points there are, on one line."""
        soft = self.stiffness < 1e3
        stiffness = f"{self.stiffness:.4g} N/m" if soft else f"{self.stiffness / 1e3:.4g} kN/m"
        count = len(self.points)
        return (
            f"Machine({self.part}, radius {1e3 * self.roll_radius:.4g} mm, stiffness {stiffness}, "
            f"mass {self.mass:.4g} kg, {count or 'no'} operating point{'' if count == 1 else 's'})"
        )

    if not TYPE_CHECKING:  # which knows the attributes

        def __getattr__(self, name: str) -> Any:
            """Say where a machine holds what its file has in a table."""
            if name == "drivetrain":
                raise AttributeError(
                    "The keys of [drivetrain] are fields of the machine, e.g. machine.stiffness"
                )
            raise AttributeError(f"'Machine' object has no attribute '{name}'", name=name, obj=self)

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """What is possible, but so unusual that a unit is probably wrong."""
        return tuple(
            doubts(
                stiffness=self.stiffness,
                mass=self.mass,
                stick_speed=self.stick_speed,
                points=self.points,
                modulus=None if self.contact is None else self.contact.modulus,
            )
        )

    @property
    def mixed(self) -> MixedContact | None:
        """Load sharing of film and asperities; None if neither asperities nor boundary friction is stated.

        The film is by the law that holds at the points of the machine, in their mean.

        Raises
        ------
        ParameterError
            If contact, its roughness, lubricant, asperities or boundary friction is missing.
        """
        if self.asperities is None and self.boundary is None:
            return None
        for table, needed in NEEDED.items():
            if getattr(self, table) is None:
                raise ParameterError(
                    f"load sharing needs contact, lubricant, asperities and boundary, but [{table}] "
                    f"is missing. Add it with {needed}"
                )
        assert self.contact and self.lubricant and self.asperities and self.boundary  # noqa: PT018
        if self.contact.roughness is None:
            raise ParameterError(
                '[contact] has no roughness (both surfaces together, rms). Add e.g. roughness = "0.4 um"'
            )
        speed = float(np.mean([point.speed for point in self.points])) if self.points else _USUAL_SPEED
        kelvin = [point.temperature for point in self.points] or self.lubricant.temperature_range
        return mixed_contact(
            self.contact,
            self.lubricant,
            self.asperities,
            self.boundary,
            speed=speed / self.contact.roll_radius,
            temperature=float(np.mean(kelvin)),
        )

    @takes_si(temperature="temperature")
    def mixed_drag(self, temperature: float) -> MixedDrag:
        """Return the drag of the belt by `mixed` at a temperature (K), with the no-load torque.

        The stick speed is that of the machine, moved to this temperature as the transition speed is; a belt
        at rest breaks away at ``static_friction`` times load.

        Raises
        ------
        ParameterError
            If the machine does not state what shares the load, or the drag falls nowhere.
        """
        mixed = self.mixed
        if mixed is None:
            raise ParameterError(
                "the machine has no load sharing between film and asperities. Add [asperities] "
                f"{NEEDED['asperities']} and [boundary] {NEEDED['boundary']}"
            )
        stick = self.stick_speed
        if self.stick_speed_temperature is not None and self.stick_speed_rule == WITH_TRANSITION:
            stated, here = mixed.lubricant.viscosity([self.stick_speed_temperature, temperature])
            stick *= float(stated / here)
        static = None if self.static_friction is None else self.static_friction * mixed.contact.load
        drag = MixedDrag(mixed, temperature, stick, static_force=static)
        return drag if self.rest is None else with_rest(drag, self.rest, self.roll_radius, temperature)

    @property
    def train(self) -> Drivetrain:
        """The drivetrain of the motion, whose roll grips the belt so far as `limits` say."""
        return self.limits.gripping(Drivetrain(self.stiffness, self.mass, part=self.part))

    @property
    def has_drivetrain(self) -> bool:
        """Whether stiffness, mass and stick speed are known."""
        return math.isfinite(self.stiffness)

    @property
    def belt(self) -> dict[str, Any]:
        """What a fitted surface needs to be the drag of a belt, as `DampingSurface.drag` takes it."""
        names = ("roll_radius", "stick_speed", "stick_speed_temperature", "stick_speed_rule", "rest")
        return {name: getattr(self, name) for name in names}


@dataclass(frozen=True)
class DrivetrainTable(Table):
    """What moves the part that slides, and below which speed it sticks, in SI."""

    called: ClassVar[Mapping[str, str]] = {
        "k": "stiffness",
        "spring": "stiffness",
        "m": "mass",
        "weight": "mass",
        "r": "roll_radius",
        "inertia": "mass",
        "radius": "roll_radius",
    }

    stiffness: Annotated[float, AtBelt("stiffness", 1.0, 1e10, "11 N/mm")]
    mass: Annotated[float, AtBelt("mass", 1e-6, 1e6, "11 kg")]
    roll_radius: Annotated[float, Quantity("length", 1e-5, 100.0, "15 mm")]
    #: Stick speed: results depend on it and logs rarely show it, so state its range in [uncertainty].
    stick_speed: Annotated[float, AtBelt("belt speed", 1e-9, 10.0, "1 mm/s")]
    #: Temperature at which stick_speed holds; without it the reference temperature of the fit.
    stick_speed_temperature: Annotated[float, Quantity("temperature", 150.0, 1000.0, "150 degC")] | None = (
        None
    )
    #: "fixed": the same stick speed at all temperatures; by default it moves with the transition speed.
    stick_speed_rule: Literal["with transition", "fixed"] = "with transition"
    #: What slides, in the word that results use.
    part: Noun = DRIVE


def _named(rows: object) -> object:
    """Points, those without a name called after their number."""
    if not isinstance(rows, list):
        raise ParameterError("is not a list. Write each point as a separate table, [[points]]")
    return [{"name": f"point {i}", **row} if isinstance(row, dict) else row for i, row in enumerate(rows, 1)]


@dataclass(frozen=True)
class _WithoutDrivetrain(Table):
    drivetrain: DrivetrainTable | None = None
    limits: Limits = field(default_factory=Limits)
    contact: ContactTable | None = None
    lubricant: LubricantTable | None = None
    points: Annotated[tuple[OperatingPoint, ...], BeforeValidator(_named)] = ()
    uncertainty: dict[str, Any] = field(default_factory=dict)
    sensors: SensorTables = field(default_factory=SensorTables)
    rest: RestTable | None = None
    asperities: AsperitiesTable | None = None
    boundary: BoundaryTable | None = None
    heat: HeatTable | None = None
    life: LifeTable = field(default_factory=LifeTable)
    gear: GearTable | None = None


@dataclass(frozen=True)
class _MachineFile(_WithoutDrivetrain):
    drivetrain: DrivetrainTable = field()


def _refuse_another(path: Path, document: Mapping[str, Any]) -> None:
    """Refuse a mapping, a recipe or a scenario in the place of a machine file."""
    if found := {"torque", "speed"} & set(document):
        raise ParameterError(
            f"{path.name} contains [{min(found)}], so it is the mapping of a log, not a machine file. "
            f"Give it as {MAPPING.to(printable(str(path)))}"
        )
    for key, (kind, command) in _OTHER_FILES.items():
        if key in document:
            raise ParameterError(
                f"{path.name} contains '{key}', so it is a {kind} ({command}), not a machine file, which has "
                "a table [drivetrain]"
            )


def _moving(tables: _WithoutDrivetrain) -> dict[str, Any]:
    """What [drivetrain] states; infinite without it, but for a radius that [contact] states."""
    if tables.drivetrain is not None:
        return vars(tables.drivetrain)
    radius = None if tables.contact is None else tables.contact.roll_radius
    known = {"roll_radius": math.inf if radius is None else radius}
    return dict.fromkeys(("stiffness", "mass", "stick_speed"), math.inf) | known


def _uncertainty(
    path: Path, document: Mapping[str, Any], tables: _WithoutDrivetrain, radius: float
) -> dict[str, Uncertainty]:
    """How far parameters are known, by their names; a range contains the value of [drivetrain]."""
    found = {}
    for parameter, text in tables.uncertainty.items():
        with at_line(path, f"uncertainty.{parameter}", "uncertainty", parameter):
            found[parameter] = read_uncertainty(parameter, text, roll_radius=radius)
            if (value := getattr(tables.drivetrain, parameter, None)) is not None:
                line = line_of(read_text(path), ("drivetrain", parameter))
                refuse_value_outside(
                    found[parameter], parameter, text, value, document["drivetrain"][parameter], line
                )
    return found


@takes_si()
def read_machine(path: str | Path, *, drivetrain: bool = True) -> Machine:
    """Read ``[drivetrain]``, and the other tables if they are there.

    These are ``[limits]``, ``[contact]``, ``[lubricant]``, ``[[points]]``, ``[uncertainty]``, and
    ``[sensors.torque]``, ``[sensors.speed]`` and ``[sensors.temperature]`` with the errors of a mapping, and
    ``[rest]``, numbers or a log beside the file, and ``[heat]``. ``[asperities]`` and ``[boundary]`` say what
    shares the load with the film; they need each other, ``[contact]`` with a roughness, and ``[lubricant]``.
    ``[life]`` and ``[gear]`` say how it is used, and what a life test asks of it.

    ``drivetrain`` says whether the file must have that table: a life test does without it what it can.

    Every value is a string such as ``"11 N/mm"``; an uncertainty is ``"10 %"`` or ``"0.3 mm/s to 3 mm/s"``
    (see `Uncertainty`).

    Raises
    ------
    MissingFileError, ParameterError, UnitError
        Each names the file and the key.
    """
    path = Path(path)
    refuse_missing(path)
    document = read_toml(path, _MachineFile)
    if "drivetrain" not in document:
        _refuse_another(path, document)
    tables = read_tables(path, _MachineFile if drivetrain else _WithoutDrivetrain)
    moving = _moving(tables)
    radius = moving["roll_radius"]
    parts: dict[str, Any] = {
        "contact": lambda of: of.contact(radius, tables.limits.nip_load),
        "lubricant": lambda of: of.lubricant(),
        "rest": lambda of: of.rest(path),
        "boundary": lambda of: of.boundary(),
        "gear": lambda of: of.gear(path),
        "heat": lambda of: of.heat(),
        "asperities": lambda of: of.asperities(),
    }
    for table, made in parts.items():
        with at_line(path, f"[{table}]", table):
            parts[table] = None if getattr(tables, table) is None else made(getattr(tables, table))
    with naming(f"{path.name}: points"):
        refuse_other_than_all(tables.points)
    machine = Machine(
        **moving,
        **parts,
        limits=tables.limits,
        points=() if math.isinf(radius) else tables.points,
        uncertainty=_uncertainty(path, document, tables, radius),
        sensors=sensors_of(**vars(tables.sensors)),
        static_friction=None if tables.boundary is None else tables.boundary.static_friction,
        life=tables.life,
    )
    for doubt in (*thousands(document), *machine.warnings):
        warnings.warn(PlausibilityWarning(f"{printable(path.name)}: {doubt.text}"), stacklevel=2)
    with naming(path.name):
        _ = machine.mixed  # what it lacks is said here, with the file
    return machine
