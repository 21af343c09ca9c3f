"""Drag laws: force against belt speed and temperature, as names over the core's physics."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field, replace
from typing import Annotated, Any, Self

import numpy as np
from numpy.typing import ArrayLike

from hersey import _core
from hersey.arguments.door import Words
from hersey.arrays import FloatArray
from hersey.errors import ExtrapolationWarning, ParameterError
from hersey.result import Means, Record
from hersey.units import celsius, takes_si

#: What the belt does near zero speed; see docs/theory/closures.md.
CLOSURES = Words(_core.CLOSURES)
#: A value of the wire form.
Wire = str | float | Sequence[float]
#: What every law takes besides its shape.
BESIDE = ("static_force", "rest_force", "rest_damping")
#: Kinds of what every drag law takes.
KINDS = {
    "stick_speed": "belt speed",
    "static_force": "force",
    "rest_force": "force",
    "rest_damping": "translational damping",
    "bristle_stiffness": "stiffness",
    "bristle_damping": "translational damping",
}


class AnyDrag:
    """What every drag law has."""

    #: Zero of the temperature scale of the law, K.
    temperature_zero: float = 0.0
    #: Belt speed below which the closure holds, m/s.
    stick_speed: float

    def law(self) -> _core.Law:
        """Return the law as the core holds it."""
        raise NotImplementedError

    @property
    def varies_with_temperature(self) -> bool:
        """Whether the law varies with temperature."""
        return False

    @takes_si(temperature="temperature")
    def law_at(self, temperature: float | None) -> _core.Law:
        """Return the law at one temperature, K; none for a law that does not vary."""
        if self.varies_with_temperature != (temperature is not None):
            reason = "the drag depends on temperature. Give temperature"
            other = "temperature is given, but the drag does not depend on it"
            raise ParameterError(reason if self.varies_with_temperature else other)
        return self.law() if temperature is None else self.law().at(temperature - self.temperature_zero)

    @property
    def breakaway_force(self) -> float:
        """The drag A of the contact that a belt at rest can bear: ``static_force``, or that of Eq. 29."""
        return self.law().breakaway_force

    @property
    def holding_force(self) -> float:
        """The force that a belt at rest withstands: ``breakaway_force`` and that of the no-load torque."""
        return self.law().holding_force

    @takes_si(force="force", temperature="temperature")
    def speeds_of(self, force: float, *, temperature: float | None = None) -> tuple[float, float]:
        """Return the speeds below and above the transition at which drag has risen to ``force``.

        Zero below if the belt is held before, infinite above if drag never rises so far.
        """
        speeds = (self.law_at(temperature) if self.varies_with_temperature else self.law()).speeds_of(
            float(force)
        )
        return speeds.slower, speeds.faster

    @takes_si(speed="belt speed", temperature="temperature")
    def force(self, speed: ArrayLike, *, temperature: float | None = None) -> FloatArray:
        """Return the drag force in steady sliding at each speed, with its sign."""
        speeds = np.asarray(speed, dtype=float)
        law = self.law_at(temperature) if self.varies_with_temperature else self.law()
        return law.force(np.ascontiguousarray(speeds.ravel())).reshape(speeds.shape)


@dataclass(frozen=True, kw_only=True)
class BesideShape(AnyDrag, Record):
    """What drag laws take besides their shape: near rest, and the no-load torque; all as of `Drag`."""

    closure: str = "retained"
    bristle_stiffness: Annotated[float | None, Means(unit="N/m")] = None
    bristle_damping: Annotated[float | None, Means(unit="N s/m")] = None
    static_force: Annotated[float | None, Means("drag of the contact at rest", "N")] = None
    rest_force: Annotated[float, Means("of the no-load torque", "N")] = 0.0
    rest_damping: Annotated[float, Means("of the no-load torque", "N s/m")] = 0.0

    def _shape(self) -> dict[str, Wire]:
        """The law and how it varies with temperature, in the wire form."""
        raise NotImplementedError

    def wire(self) -> dict[str, Wire]:
        """Return the drag as plain values by name, as the core and the drive file of a unit take it.

        What is not given is left out; see ``crates/core/src/drag/form.rs``.
        """
        near = {
            name: getattr(self, name) for name in ("bristle_stiffness", "bristle_damping", "static_force")
        }
        return {
            **self._shape(),
            **{name: float(value) for name, value in near.items() if value is not None},
            "stick_speed": float(self.stick_speed),
            "closure": self.closure,
            "rest_force": float(self.rest_force),
            "rest_damping": float(self.rest_damping),
        }

    def law(self) -> _core.Law:
        """Return the law as the core holds it."""
        return _core.Law(self.wire())


#: What `PowersOfTemperature` adds to a law.
_POWERS = (
    *("reference_temperature", "temperature_zero"),
    *("force_temperature_exponent", "speed_temperature_exponent", "rest_temperature_slope"),
)


@dataclass(frozen=True)
class MeasuredRange:
    """The log that a drag was fitted to: its speeds (m/s) and temperatures (K), and of what its torque is."""

    speed: tuple[float, float]
    temperature: tuple[float, float] | None = None
    whole_torque: bool = False  #: whether no no-load torque was subtracted from the log

    def outside(self, temperature: Any, speeds: Mapping[str, Any]) -> dict[str, str]:
        """Return words by name about each speed and temperature outside; of a schedule its highest speed."""
        found = {}
        for name, value in speeds.items():
            given = np.asarray(getattr(value, "values", value), dtype=float)
            high = float(np.max(given, initial=0.0))
            moving = given[given > 0.0]
            slow = float(moving.min()) if moving.size and not hasattr(value, "values") else self.speed[0]
            if high > self.speed[1] * (1.0 + _GRAZED) or slow < self.speed[0] * (1.0 - _GRAZED):
                beyond = high if high > self.speed[1] * (1.0 + _GRAZED) else slow
                low, top = (f"{1e3 * each:.4g}" for each in self.speed)
                found[name] = _extrapolated(name, f"{1e3 * beyond:.4g} mm/s", f"{low} to {top} mm/s")
        film = getattr(temperature, "film_temperature", temperature)
        if self.temperature is None or film is None:
            return found
        kelvin = np.asarray(getattr(film, "values", film), dtype=float)
        cold, hot = self.temperature[0] * (1.0 - _GRAZED), self.temperature[1] * (1.0 + _GRAZED)
        if kelvin.size and (kelvin.min() < cold or kelvin.max() > hot):
            beyond = float(kelvin.min() if kelvin.min() < cold else kelvin.max())
            low, top = (f"{celsius(each):.4g}" for each in self.temperature)
            found["temperature"] = _extrapolated(
                "temperature", f"{celsius(beyond):.4g} degC", f"{low} to {top} degC"
            )
        return found

    def warn(self, temperature: Any, speeds: Mapping[str, Any], stacklevel: int) -> None:
        """Warn of speeds and temperatures outside."""
        for text in self.outside(temperature, speeds).values():
            warnings.warn(text, ExtrapolationWarning, stacklevel=stacklevel + 1)


#: Share by which values may be outside the range of the log without a warning.
_GRAZED = 1e-3


def _extrapolated(name: str, value: str, measured: str) -> str:
    return f"{name} is {value}, outside the measured range, {measured}, so the result is extrapolated"


@dataclass(frozen=True, kw_only=True)
class PowersOfTemperature(BesideShape):
    """How a drag law varies with temperature, if a ``reference_temperature`` is given.

    All forces vary as (T/T_ref)^force_temperature_exponent and all speeds as
    (T/T_ref)^speed_temperature_exponent, T counted from ``temperature_zero`` (273.15 for degC). What the
    drive takes without the contact changes by ``rest_temperature_slope`` (relative, per K). ``measured`` is
    the range of the log, outside which a motion is extrapolated.
    """

    reference_temperature: Annotated[float | None, Means(unit="K")] = None
    force_temperature_exponent: float = 0.0
    speed_temperature_exponent: float = 0.0
    temperature_zero: Annotated[float, Means(unit="K")] = 0.0
    rest_temperature_slope: Annotated[float, Means("relative", "1/K")] = 0.0
    measured: MeasuredRange | None = field(default=None, compare=False, repr=False)

    not_stated = ("measured",)

    @property
    def varies_with_temperature(self) -> bool:
        """Whether the law varies with temperature."""
        return self.reference_temperature is not None

    def _temperature_law(self) -> dict[str, Wire]:
        """How the law varies with temperature, in the wire form."""
        if self.reference_temperature is None:
            return {"temperature_law": "none"}
        return {"temperature_law": "power", **{name: float(getattr(self, name)) for name in _POWERS}}

    @takes_si(temperature="temperature")
    def at(self, temperature: float | None) -> Self:
        """Return the law at one temperature, K, as one that does not vary; itself if it does not vary.

        Warns with `ExtrapolationWarning` outside the temperatures of the log.
        """
        law = self.law_at(temperature)
        if temperature is None or self.reference_temperature is None:
            return self
        if self.measured is not None:
            self.measured.warn(temperature, {}, stacklevel=3)
        ratio = (temperature - self.temperature_zero) / (self.reference_temperature - self.temperature_zero)
        force, speed = (
            ratio**power for power in (self.force_temperature_exponent, self.speed_temperature_exponent)
        )
        return replace(
            self,
            **self._scaled(force, speed),
            static_force=None if self.static_force is None else law.breakaway_force,
            rest_force=law.rest[0],
            rest_damping=law.rest[1],
            rest_temperature_slope=0.0,
            reference_temperature=None,
            force_temperature_exponent=0.0,
            speed_temperature_exponent=0.0,
            temperature_zero=0.0,
        )

    def warned(self, temperature: Any, stacklevel: int, **speeds: Any) -> Self:
        """Warn of what is outside the log, and return the law without its range, which warns no more.

        ``speeds`` (m/s) have the names of arguments; what is None is not given.
        """
        if self.measured is None:
            return self
        given = {name: value for name, value in speeds.items() if value is not None}
        self.measured.warn(temperature, given, stacklevel + 1)
        return self.unwarned()

    def unwarned(self) -> Self:
        """Return the law without the range of its log, so that nothing warns."""
        return self if self.measured is None else replace(self, measured=None)

    def _scaled(self, force: float, speed: float) -> dict[str, Any]:
        """What of the shape is a force or a speed, times a factor each."""
        raise NotImplementedError


_TEMPERATURES = dict.fromkeys(("reference_temperature", "temperature_zero"), "temperature")


@takes_si(
    transition_force="force",
    transition_speed="belt speed",
    static_growth_time="time",
    closure=CLOSURES,
    **KINDS,
    **_TEMPERATURES,
)
@dataclass(frozen=True)
class Drag(PowersOfTemperature):
    """Drag force against belt speed (Eqs. 17-30), and temperature if a ``reference_temperature`` is given.

    ``F = F_t (v/v_t)^(1+n)`` with n the damping exponent of the branch: ``ehl_exponent`` above the transition
    speed v_t, ``mixed_exponent`` below; below ``stick_speed`` the ``closure`` holds: ``retained`` (the
    paper's rule, Eqs. 24-27: a belt that sticks keeps its small speed), ``stiction`` (stops abruptly),
    ``stribeck`` (smooth) or ``lugre`` (bristles, with ``bristle_stiffness`` and ``bristle_damping``).

    With temperature it varies as `PowersOfTemperature`.

    ``static_force`` is the break-away force. By default drag falls continuously by a factor e up to the stick
    speed (Eqs. 28-30). The no-load torque adds ``rest_force + rest_damping v``, which changes by
    ``rest_temperature_slope`` (relative, per K) with temperature; with ``lugre``, ``rest_damping`` is the
    viscous part in addition to the bristles.

    While a belt stands its static force may grow, by ``static_growth`` (relative) per e-fold of the time
    beyond ``static_growth_time`` (s): A (1 + growth ln(1 + t/time)), after Rabinowicz (1951) and Dieterich
    (1972). A belt stands only with ``stiction``.

    Raises
    ------
    ParameterError
        If a force or speed is not positive, or the stick speed is not below the transition speed.
    """

    transition_force: Annotated[float, Means(unit="N")]
    transition_speed: Annotated[float, Means(unit="m/s")]
    ehl_exponent: float
    mixed_exponent: float
    stick_speed: Annotated[float, Means(unit="m/s")]
    _: KW_ONLY
    static_growth: Annotated[float, Means("of the static force per e-fold of time")] = 0.0
    static_growth_time: Annotated[float | None, Means(unit="s")] = None

    def __post_init__(self) -> None:
        """Let the core check the values."""
        if self.static_growth and (self.closure != "stiction" or self.static_growth_time is None):
            needed = "static_growth_time" if self.closure == "stiction" else "closure 'stiction'"
            raise ParameterError(f"static_growth is {self.static_growth:g}: it needs {needed}")
        self.law()

    @classmethod
    @takes_si(transition_torque="torque", transition_speed="speed", roll_radius="length")
    def rotational(
        cls, *, transition_torque: float, transition_speed: float, roll_radius: float, **rest: float | str
    ) -> Drag:
        """Return the drag at the surface of a roll, from a torque (N m) and an angular speed (rad/s).

        ``stick_speed`` and what else the law takes are at the surface.
        """
        if not roll_radius > 0:
            raise ParameterError(f"roll_radius is {roll_radius}: it must be greater than 0")
        return cls(transition_torque / roll_radius, transition_speed * roll_radius, **rest)  # type: ignore[arg-type]

    def _scaled(self, force: float, speed: float) -> dict[str, Any]:
        return {
            "transition_force": self.transition_force * force,
            "transition_speed": self.transition_speed * speed,
            "stick_speed": self.stick_speed * speed,
        }

    def _shape(self) -> dict[str, Wire]:
        names = ["transition_force", "transition_speed", "ehl_exponent", "mixed_exponent"]
        if self.static_growth:
            names += ["static_growth", "static_growth_time"]
        numbers = {name: float(getattr(self, name)) for name in names}
        return {"law": "power", **self._temperature_law(), **numbers}

    def beside(self, sets: int) -> list[FloatArray] | None:
        """Return `BESIDE`, each for so many sets; not a number where there is no static force.

        Raises
        ------
        ParameterError
            If the static force grows at rest, which sets of many have not.
        """
        if self.static_growth:
            raise ParameterError("static_growth applies to one drag and cannot be swept")
        if self.static_force is None and not self.rest_force and not self.rest_damping:
            return None
        values = [getattr(self, name) for name in BESIDE]
        return [np.full(sets, np.nan if value is None else float(value)) for value in values]


@takes_si(speeds="belt speed", forces="force", closure=CLOSURES, **KINDS, **_TEMPERATURES)
@dataclass(frozen=True)
class DragTable(PowersOfTemperature):
    """Drag through measured points, joined by straight lines in logarithmic scales.

    The outer lines continue beyond the points; the transition is the point of least force. With temperature,
    all points vary as `PowersOfTemperature`.

    Raises
    ------
    ParameterError
        If there are fewer than two points, speeds do not ascend, or a value is not positive.

    Examples
    --------
    >>> table = DragTable((0.01, 0.1, 1.0, 3.0), (120.0, 80.0, 50.0, 70.0), stick_speed=0.01)
    >>> float(table.force(1.0))
    50.0
    """

    speeds: Annotated[tuple[float, ...], Means("ascending", "m/s")]
    forces: Annotated[tuple[float, ...], Means(unit="N")]
    stick_speed: Annotated[float, Means(unit="m/s")]

    def __post_init__(self) -> None:
        """Let the core check the values."""
        object.__setattr__(self, "speeds", tuple(float(v) for v in self.speeds))
        object.__setattr__(self, "forces", tuple(float(f) for f in self.forces))
        self.law()

    def _shape(self) -> dict[str, Wire]:
        return {"law": "table", "speeds": self.speeds, "forces": self.forces, **self._temperature_law()}

    def _scaled(self, force: float, speed: float) -> dict[str, Any]:
        return {
            "speeds": tuple(v * speed for v in self.speeds),
            "forces": tuple(f * force for f in self.forces),
            "stick_speed": self.stick_speed * speed,
        }


#: A law whose forces and speeds vary as powers of temperature.
PowerDrag = Drag | DragTable
