"""Temperature as a state of the motion: what a heater and friction warm, and what the rest takes away."""

from __future__ import annotations

from dataclasses import dataclass

from hersey.errors import ParameterError
from hersey.motion.schedule import Schedule, ScheduleArguments
from hersey.units import takes_si

#: Kinds of what a balance takes.
_KINDS: dict[str, str | tuple[str, ...]] = {
    **dict.fromkeys(("film_capacity", "roll_capacity"), "heat capacity"),
    **dict.fromkeys(("exchange", "film_loss", "roll_loss"), "thermal conductance"),
    "heater_gain": "thermal conductance",
    **dict.fromkeys(("surroundings", "setpoint", "film_temperature", "roll_temperature"), "temperature"),
    **dict.fromkeys(("heater_power", "film_load", "roll_load"), "power"),
}
#: The balance as the core takes it: capacities, exchange, losses, surroundings, heater, loads, start, and
#: zero of the temperature scale of the drag law.
_Arguments = tuple[
    tuple[float, float],
    float,
    tuple[float, float],
    float,
    tuple[ScheduleArguments | None, tuple[float, float, float] | None],
    tuple[ScheduleArguments, ScheduleArguments],
    tuple[float, float],
    float,
]


@takes_si(**_KINDS)
@dataclass(frozen=True)
class HeatBalance:
    """Two bodies that exchange heat: one with the film (heater, belt and film), and the roll.

    With temperatures T_f and T_r::

        film_capacity T_f' = P + q - film_load - exchange (T_f - T_r) - film_loss (T_f - surroundings)
        roll_capacity T_r' = exchange (T_f - T_r) - roll_load - roll_loss (T_r - surroundings)

    q is the power of friction in the contact (drag without the no-load torque, times belt speed); the drag
    law follows T_f. The heater gives ``heater_power``, or, with a ``setpoint``, ``heater_gain`` times the
    deviation from it, between 0 and ``heater_power``.

    Parameters
    ----------
    film_capacity, roll_capacity
        J/K.
    exchange
        Between the bodies, W/K.
    film_temperature, roll_temperature
        At the start, K.
    surroundings
        K.
    film_loss, roll_loss
        To the surroundings, W/K.
    heater_power
        Heater power, W, constant or against time; with a setpoint, the maximum power.
    setpoint
        Temperature to which the heater controls the body of the film, K.
    heater_gain
        Controller gain, W/K. Default: full power until 0.1 K below the setpoint.
    film_load, roll_load
        Heat taken by the paper from each body, W, constant or against time.

    Raises
    ------
    ParameterError
        If a value is out of range.
    """

    film_capacity: float
    roll_capacity: float
    exchange: float
    film_temperature: float
    roll_temperature: float
    surroundings: float
    film_loss: float = 0.0
    roll_loss: float = 0.0
    heater_power: float | Schedule = 0.0
    setpoint: float | None = None
    heater_gain: float | None = None
    film_load: float | Schedule = 0.0
    roll_load: float | Schedule = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        if self.setpoint is not None and isinstance(self.heater_power, Schedule):
            raise ParameterError("heater_power must be constant with a setpoint: it is the maximum power")
        if self.heater_gain is not None and self.setpoint is None:
            raise ParameterError("heater_gain needs a setpoint. Give one")

    def arguments(self, temperature_zero: float) -> _Arguments:
        """Return the balance as the core takes it, for a law whose scale begins at some K."""
        return (
            (float(self.film_capacity), float(self.roll_capacity)),
            float(self.exchange),
            (float(self.film_loss), float(self.roll_loss)),
            float(self.surroundings),
            self._heater(),
            (Schedule.of(self.film_load).arguments, Schedule.of(self.roll_load).arguments),
            (float(self.film_temperature), float(self.roll_temperature)),
            float(temperature_zero),
        )

    def _heater(self) -> tuple[ScheduleArguments | None, tuple[float, float, float] | None]:
        if self.setpoint is None:
            return Schedule.of(self.heater_power).arguments, None
        most = float(self.heater_power)  # type: ignore[arg-type]  # __post_init__ refuses a schedule
        gain = 10.0 * most if self.heater_gain is None else float(self.heater_gain)
        return None, (float(self.setpoint), most, gain)
