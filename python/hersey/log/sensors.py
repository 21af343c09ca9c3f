"""What the sensors do not know: errors that no repetition averages away, at 95 %."""

from __future__ import annotations

from dataclasses import dataclass, replace

from hersey.schema.domain import TORQUE, Domain
from hersey.units import convert

#: Zero error of torque as a share of the largest torque measured, where none is stated.
SHARE_OF_LARGEST = 0.001
#: Hysteresis of the torque sensor as a share of the largest torque measured: half of what it reads more when
#: torque falls than when it rises. Counted where the speeds of a log were all approached from one direction.
HYSTERESIS_OF_LARGEST = 0.005
#: Time constant by which a temperature sensor may lag, s, unless the mapping corrects it.
TEMPERATURE_LAG = 20.0
#: What is an error of each sensor.
OF_ROLE = {
    "temperature": ("temperature_zero", "film_heating"),
    "torque": ("torque_gain", "torque_zero"),
    "speed": ("speed_gain",),
}


@dataclass(frozen=True)
class Sensors:
    """Errors of the sensors, half widths at 95 %.

    ``temperature_zero`` also bounds by how much the film is warmer or colder than the reading, whether at all
    speeds or more the faster it shears. ``film_heating`` bounds by how much friction heats the film above
    what is read: in proportion to the power it takes, between nothing and this bound where that is greatest
    in the log; it is then fitted, and no longer part of ``temperature_zero``. ``torque_zero`` None stands for
    `SHARE_OF_LARGEST` of the largest torque measured. What is not in ``stated`` is a default.
    """

    temperature_zero: float = 2.0  #: K
    torque_gain: float = 0.01
    torque_zero: float | None = None  #: N m
    speed_gain: float = 0.001
    film_heating: float = 0.0  #: K
    stated: tuple[str, ...] = ()

    def or_else(self, others: Sensors) -> Sensors:
        """Return these errors, and those of ``others`` for each sensor of which these state none."""
        taken = tuple(role for role in others.stated if role not in self.stated)
        errors = {name: getattr(others, name) for role in taken for name in OF_ROLE[role]}
        return replace(self, **errors, stated=(*self.stated, *taken))

    def __str__(self) -> str:
        """Return the errors in words, the defaults named as such."""
        return self.about(TORQUE)

    def about(self, of: Domain) -> str:
        """Return the same of what was measured."""
        zero = (
            f"0.1 % of the largest {of.quantity}"
            if self.torque_zero is None
            else _newton_metre(self.torque_zero)
        )
        said = {
            "temperature": f"temperature {self.temperature_zero:g} K"
            + (f", film heated by up to {self.film_heating:g} K" if self.film_heating else ""),
            "torque": f"{of.quantity} {100 * self.torque_gain:.3g} % and {zero}",
            "speed": f"speed {100 * self.speed_gain:.3g} %",
        }
        return ", ".join(text if role in self.stated else f"{text} (default)" for role, text in said.items())


def _newton_metre(torque: float) -> str:
    return f"{torque:.3g} N m" if torque >= 0.1 else f"{convert(torque, 'N*m', 'mN*m'):.3g} mN m"
