"""What a log measures against which speed: a torque against rotation, or friction against sliding."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from hersey.errors import ParameterError, Setting
from hersey.schema.record import Record
from hersey.units import rpm

if TYPE_CHECKING:
    from hersey.arrays import FloatArray

#: Of each quantity: its unit and symbol, how it is shown (unit, factor), and its powers in normal load and
#: radius.
_QUANTITIES: Final = {
    "torque": ("N m", "T", ("mN·m", 1e3), {"load": 1, "radius": 1}),
    "friction force": ("N", "F", ("N", 1.0), {"load": 1, "radius": 0}),
    "friction coefficient": ("", "mu", ("", 1.0), {"load": 0, "radius": 0}),
}
#: Of each speed: its unit and symbol, how it is shown, its power in radius, and below what the drive stands
#: (a fiftieth of a revolution a minute).
_SPEEDS: Final = {
    "speed": ("rad/s", "w", ("rpm", float(rpm(1.0))), 0, 0.002),
    "sliding speed": ("m/s", "v", ("m/s", 1.0), 1, 2e-5),
    "entrainment speed": ("m/s", "U", ("m/s", 1.0), 1, 2e-5),
    "Hersey number": ("1/m", "H", ("1/m", 1.0), 0, 0.0),
}


@dataclass(frozen=True)
class Domain(Record):
    """A quantity against a speed: their names, symbols, units, and how they are shown.

    Everything that is fitted is ln quantity against ln speed, whatever they are; damping is quantity/speed.
    """

    also_stated = ("unit", "speed_unit")

    quantity: str = "torque"  #: ``torque``, ``friction force`` or ``friction coefficient``
    speed: str = "speed"  #: ``speed`` of rotation, ``sliding`` or ``entrainment speed``, or ``Hersey number``

    @classmethod
    def read(cls, part: Any) -> Domain:
        """Return the one that a document holds."""
        return cls(part.quantity, part.speed)

    @property
    def is_torque(self) -> bool:
        """Whether it is the torque of a rotation, which drives and machines are about."""
        return self == TORQUE

    @property
    def unit(self) -> str:
        """SI unit of the quantity; empty for a number."""
        return str(_QUANTITIES[self.quantity][0])

    @property
    def symbol(self) -> str:
        """Symbol of the quantity."""
        return str(_QUANTITIES[self.quantity][1])

    @property
    def speed_unit(self) -> str:
        """SI unit of the speed."""
        return str(_SPEEDS[self.speed][0])

    @property
    def speed_symbol(self) -> str:
        """Symbol of the speed."""
        return str(_SPEEDS[self.speed][1])

    @property
    def damping_unit(self) -> str:
        """SI unit of quantity over speed."""
        over = {"rad/s": "s/rad", "m/s": "s/m", "1/m": "m"}[self.speed_unit]
        return f"{self.unit} {over}".strip()

    @property
    def shown(self) -> tuple[str, float]:
        """Unit in which charts show the quantity, and how many of it are one in SI."""
        return _QUANTITIES[self.quantity][2]

    @property
    def shown_speed(self) -> tuple[str, float]:
        """Unit in which people read the speed, and how many of it are one in SI."""
        return _SPEEDS[self.speed][2]

    @property
    def standing(self) -> float:
        """Speed below which the drive stands, SI."""
        return float(_SPEEDS[self.speed][4])

    @property
    def axis(self) -> str:
        """Title of an axis of the quantity."""
        return _titled(self.quantity, self.shown[0])

    @property
    def speed_axis(self) -> str:
        """Title of an axis of the speed."""
        return _titled(self.speed, self.shown_speed[0])

    def at(self, speed: float, form: str = ".3g") -> str:
        """Return a speed (SI) in the unit in which people read it."""
        unit, factor = self.shown_speed
        return f"{speed * factor:{form}} {unit}"

    def between(self, low: float, high: float, form: str = ".3g") -> str:
        """Return a range of speeds (SI) in the unit in which people read it."""
        return f"{low * self.shown_speed[1]:{form}} to {self.at(high, form)}"

    def amount(self, value: float, form: str = ".3g") -> str:
        """Return a value of the quantity in SI, with its unit."""
        return f"{value:{form}} {self.unit}".strip()

    def small(self, value: float, form: str = ".3g") -> str:
        """Return a value of the quantity (SI) in the unit in which charts show it."""
        unit, factor = self.shown
        return f"{value * factor:{form}} {unit.replace('·', ' ')}".strip()

    def require_torque(self, what: str) -> None:
        """Raise `ParameterError` if this is friction, and ``what`` is about the torque of a rotation."""
        if not self.is_torque:
            remedy = f"give {self._to_torque('25 mm', '50 N')}, with your values"
            if self.speed == "sliding speed":  # N m stands for N or for the coefficient, rad/s for m/s
                one = self._to_torque("1 m", "1 N")
                unit = self.unit or "the coefficient"
                remedy += f". If nothing turns, give {one}, and read N·m as {unit} and rad/s as m/s"
            raise ParameterError(
                f"{what} needs a torque, but the log is of a {self.quantity} against {self.speed}",
                remedy=remedy,
            )

    def _to_torque(self, radius: str, load: str) -> str:
        """What to write so that this becomes a torque."""
        of, pressing = Setting("radius").to(radius), Setting("load").to(load)
        return f"{of} and {pressing}" if self.quantity == "friction coefficient" else of

    def require_rotation(self, what: str) -> None:
        """Raise `ParameterError` if this is about sliding, and ``what`` about a speed of rotation."""
        if self.speed != "speed":
            raise ParameterError(
                f"{what} needs a speed of rotation, but the log is of a {self.speed}",
                remedy=f"give {Setting('radius').to('25 mm')}, with your value",
            )

    def powers(self, to: Domain) -> dict[str, tuple[int, int]]:
        """Return the powers of load and radius by which quantity and speed become those of another domain."""
        of, other = _QUANTITIES[self.quantity][3], _QUANTITIES[to.quantity][3]
        turns = _SPEEDS[to.speed][3] - _SPEEDS[self.speed][3]
        return {
            "load": (other["load"] - of["load"], 0),
            "radius": (other["radius"] - of["radius"], turns),
        }

    def converted(
        self, to: Domain, torque: FloatArray, speed: FloatArray, **known: FloatArray | float
    ) -> tuple[FloatArray, FloatArray]:
        """Return quantity and speed in another domain; ``known`` holds load (N) and radius (m) as needed."""
        for role, (of_quantity, of_speed) in self.powers(to).items():
            if of_quantity:
                torque = torque * known[role] if of_quantity > 0 else torque / known[role]
            if of_speed:
                speed = speed * known[role] if of_speed > 0 else speed / known[role]
        return torque, speed


def _titled(name: str, unit: str) -> str:
    return f"{name[:1].upper()}{name[1:]}" + (f" ({unit})" if unit else "")


#: What viscosity, speed and load make together: see `hersey.damping.dwells.hersey_number`.
HERSEY_NUMBER: Final = "Hersey number"
#: The torque of a rotation.
TORQUE: Final = Domain()
#: Domains by kinds of units of a column of torque, and of one of speed.
QUANTITY_OF: Final = {
    "torque": "torque",
    "force": "friction force",
    "friction coefficient": "friction coefficient",
}
SPEED_OF: Final = {"speed": "speed", "belt speed": "sliding speed"}
