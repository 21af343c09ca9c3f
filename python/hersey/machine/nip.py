"""The tables ``[contact]`` and ``[lubricant]`` of `machine.toml`."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Annotated, Any, ClassVar

from pydantic import BeforeValidator, ValidationInfo
from pydantic.dataclasses import dataclass

from hersey import _core
from hersey.errors import ParameterError, UnitError, WrongKindError
from hersey.files.toml import Quantity, Share, Table
from hersey.lubrication.contact import Contact, shore_a_modulus
from hersey.lubrication.lubricant import EXAMPLES, MODELS, Lubricant, ShearThinning
from hersey.machine.at_belt import AtBelt
from hersey.units import parse

#: Where a coefficient that holds for all temperatures is noted, K.
_ANY = "298.15 K"
#: Temperatures of a lubricant, K.
_COLDEST, _HOTTEST = 150.0, 1000.0
#: Kinds of what stands behind a temperature in the pairs of a lubricant.
_VISCOSITIES = ("viscosity", "kinematic viscosity", "pressure-viscosity coefficient")


#: A hardness, in either order of number and scale: 65 Shore A, ShA 65.
_HARDNESS = re.compile(
    r"(?:sh(?:ore)?[- ]?([ad])\D*)?(\d+(?:\.\d+)?)\s*(?:°\s*)?(?:sh(?:ore)?[- ]?([ad]))?", re.I
)
#: Keys of a viscosity that hold its temperature, degC: viscosity_40, kv100, nu_40C.
_AT = re.compile(r"(?:(?:kinematic_|dynamic_)?viscosity|kv|nu|eta|mu|v)_?(?:at_)?(\d{2,3})_?(?:deg)?c?", re.I)
#: A viscosity index says how viscosity falls, but at one temperature it must be known.
_INDEX = re.compile(r"vi|viscosity_?index", re.I)
_EXAMPLES = [["40 degC", "400 mm^2/s"], ["100 degC", "40 mm^2/s"], ["150 degC", "14 mm^2/s"]]


class _Modulus(Quantity):
    """A modulus, which people also state by its hardness."""

    def _with_unit(self, given: object, info: ValidationInfo[Any]) -> float:
        match = _HARDNESS.fullmatch(given.strip()) if isinstance(given, str) and len(given) < 40 else None
        scale = (match[1] or match[3] or "").lower() if match else ""
        if match and scale == "a":
            raise UnitError(f"is {given}, a hardness. Write shore_a = {match[2]} instead of this line")
        if match and scale == "d":
            raise UnitError(
                f'is {given}, a hardness of another scale. Write the modulus, e.g. "{self.example}"'
            )
        return super()._with_unit(given, info)


@dataclass(frozen=True)
class ContactTable(Table):
    """The nip as a machine file states it; radius and load may stand in other tables."""

    called: ClassVar[Mapping[str, str]] = {
        "thickness": "rubber_thickness",
        "hardness": "shore_a",
        "force": "load",
    }

    #: Outer radius of the roll; without it that of [drivetrain].
    roll_radius: Annotated[float, Quantity("length", 1e-4, 10.0)] | None = None
    #: Thickness of the rubber on the roll.
    rubber_thickness: Annotated[float, Quantity("length", 1e-5, 1.0)] | None = None
    modulus: Annotated[float, _Modulus("pressure", 1e4, 1e12, "0.65 MPa")] | None = None
    #: Hardness of the rubber, Shore A, instead of modulus.
    shore_a: Annotated[float, Quantity(None, 20.0, 80.0, "60")] | None = None
    poisson_ratio: Annotated[float, Quantity(None, 1e-9, 0.5)] | None = None
    #: Length of the nip, along the roll.
    length: Annotated[float, Quantity("length", 1e-4, 100.0)] | None = None
    #: Load that presses the roll on the heater; without it nip_load of [limits].
    load: Annotated[float, AtBelt("force", 1e-3, 1e7)] | None = None
    #: Radius of the heater; flat if not stated.
    heater_radius: Annotated[float, Quantity("length", 1e-4, 1e6)] | None = None
    #: Roughness of belt and heater together, rms; needed with [asperities].
    roughness: Annotated[float, Quantity("length", 1e-10, 1e-3)] | None = None
    #: Uncertainty of the nip width.
    nip_uncertainty: Share | None = None
    #: Thickness of the lubricant layer on the inlet side; a flooded inlet if not stated.
    supply: Annotated[float, Quantity("length", 1e-9, 1e-2)] | None = None
    #: Heat flow from the heater through the film to the roll, over the whole nip; with sensor_side.
    heat_flow: Annotated[float, Quantity("power", 0.0, 1e6, "600 W")] | None = None
    #: Wall of the film that the temperature sensor reads: "heater" or "roll"; with heat_flow.
    sensor_side: str | None = None

    def contact(self, roll_radius: float, load: float | None) -> Contact:
        """Return the contact; radius (m) and load (N) are those of the machine where the table has none.

        Raises
        ------
        ParameterError
            If something is missing or does not fit the rest.
        """
        stated: dict[str, Any] = {"roll_radius": roll_radius, "load": load}
        stated |= {key: value for key, value in vars(self).items() if value is not None}
        hardness = stated.pop("shore_a", None)
        if (hardness is None) == ("modulus" not in stated):
            raise ParameterError("needs either 'modulus' or 'shore_a'")
        if hardness is not None:
            stated["modulus"] = shore_a_modulus(hardness)
        for key in ("rubber_thickness", "poisson_ratio", "length", "load"):
            if stated.get(key) is None:
                raise ParameterError(f"lacks '{key}'")
        return Contact(**stated)


class _Viscosity(Quantity):
    """A dynamic viscosity, Pa s, or a kinematic one times the density that stands in the table."""

    def checked(self, given: Any, info: ValidationInfo[Any]) -> float:
        try:
            kinematic = Quantity("kinematic viscosity", 1e-9, 1e6).checked(given, info)
        except WrongKindError:
            return super().checked(given, info)
        if info.context is None:
            return kinematic
        if info.data.get("density") is None:
            raise ParameterError(f'is {given}, a kinematic viscosity. Add e.g. density = "0.9 g/cm^3"')
        return kinematic * float(info.data["density"])


def _pairs(given: object) -> list[list[Any]]:
    """Pairs of a list, the temperature first."""
    if not isinstance(given, list) or not all(isinstance(row, list) and len(row) == 2 for row in given):
        raise ParameterError(f"is not a list of pairs. Write e.g. {_written(_EXAMPLES[:2])}")
    if given and all(_is(first, *_VISCOSITIES) and _is(second, "temperature") for first, second in given):
        turned = [[second, first] for first, second in given]
        raise ParameterError(f"has the temperature behind. Write {_written(turned)}")
    return given


def _is(text: object, *kinds: str) -> bool:
    """Whether a text is a quantity of one of several kinds."""
    return any(_value(text, kind) is not None for kind in kinds)


def _value(text: object, kind: str) -> float | None:
    try:
        return parse(kind, text) if isinstance(text, str) else None
    except UnitError:
        return None


def _falling(given: object) -> object:
    """Pairs of which the viscosity falls with temperature, as far as their units compare."""
    pairs = _pairs(given)
    for kind in ("viscosity", "kinematic viscosity"):
        known = [
            (kelvin, value, pair)
            for pair in pairs
            if _COLDEST <= (kelvin := _value(pair[0], "temperature") or 0.0) <= _HOTTEST
            and (value := _value(pair[1], kind) or 0.0) > 0
        ]
        for (cold, thick, first), (hot, thin, second) in pairwise(sorted(known, key=lambda each: each[0])):
            if hot > cold and thin >= thick:
                fixed = [[first[0], second[1]], [second[0], first[1]]]
                fixed += [pair for pair in pairs if pair not in (first, second)]
                raise ParameterError(
                    f"{second[1]} at {second[0]} is not less than {first[1]} at {first[0]}, but viscosity "
                    "falls with temperature. Were the two exchanged? Write "
                    f"{_written(sorted(fixed, key=_kelvin))}"
                )
    return _ascending(pairs)


def _ascending(pairs: list[list[Any]]) -> list[list[Any]]:
    """Pairs of which each temperature is above the one before, as far as they can be read."""
    if not all(_COLDEST <= _kelvin(pair) <= _HOTTEST for pair in pairs):
        return pairs
    ordered = sorted(pairs, key=_kelvin)
    for first, second in pairwise(ordered):
        if _kelvin(first) == _kelvin(second):
            raise ParameterError(
                f"has two values at {second[0]}, {first[1]} and {second[1]}. Correct the temperature of one"
            )
    if ordered != pairs:
        raise ParameterError(f"has a hotter point first. Write {_written(ordered)}")
    return pairs


def _written(pairs: Sequence[Sequence[Any]]) -> str:
    """Pairs as TOML writes them."""
    return json.dumps(pairs, ensure_ascii=False)


def _kelvin(pair: Sequence[Any]) -> float:
    return _value(pair[0], "temperature") or 0.0


def _or_one(given: object) -> object:
    return _ascending(_pairs([[_ANY, given]] if isinstance(given, str) else given))


_Temperature = Annotated[float, Quantity("temperature", _COLDEST, _HOTTEST)]
_Alpha = Annotated[float, Quantity("pressure-viscosity coefficient", 1e-12, 1e-6)]


@dataclass(frozen=True)
class LubricantTable(Table):
    """The lubricant as a machine file states it: one of the examples, or points of a data sheet."""

    @classmethod
    def instead(cls, table: Mapping[str, Any], key: str, /) -> str:
        """Return the pairs that keys with a temperature in their names stand for."""
        stated = sorted((int(m[1]), value) for name, value in table.items() if (m := _AT.fullmatch(name)))
        if _INDEX.fullmatch(key):
            listed = table.get("viscosities")
            known = max(len(stated), len(listed) if isinstance(listed, list) else 0)
            if known > 1:
                return f"Delete this line: the {'two' if known == 2 else known} viscosities say it"
            pairs = _written(_EXAMPLES[:2])
            return f"Write the viscosity at two temperatures instead, e.g. viscosities = {pairs}"
        if not _AT.fullmatch(key):
            return ""
        found = [
            [f"{at} degC", value if isinstance(value, str) else f"{value} mm^2/s"] for at, value in stated
        ]
        lines = "that line" if len(found) == 1 else f"these {len(found)} lines"
        return f"Write instead of {lines}: viscosities = {_written(found)}"

    #: Name of an oil with published values, instead of model and viscosities.
    example: str = ""
    #: Name of the lubricant, as results show it.
    name: str = "lubricant"
    #: Where the values come from.
    source: str = ""
    #: Law of viscosity against temperature: "walther" (ASTM D341, two points, needs density), "arrhenius"
    #: (two points) or "vogel" (three points).
    model: str = ""
    #: Density of the lubricant; a kinematic viscosity, such as one in mm^2/s, needs it.
    density: Annotated[float, Quantity("density", 100.0, 2e4)] | None = None
    #: Points of the data sheet: temperature and dynamic or kinematic viscosity.
    viscosities: (
        Annotated[
            tuple[tuple[_Temperature, Annotated[float, _Viscosity("viscosity", 1e-6, 1e9)]], ...],
            BeforeValidator(_falling),
        ]
        | None
    ) = None
    #: Pressure-viscosity coefficient: one for all temperatures, or pairs of temperature and coefficient.
    pressure_viscosity: Annotated[tuple[tuple[_Temperature, _Alpha], ...], BeforeValidator(_or_one)] = ()
    #: Thermal conductivity, for heating by shear.
    conductivity: Annotated[float, Quantity("thermal conductivity", 1e-3, 1e3)] | None = None
    #: Relaxation time of Carreau's law of shear thinning; with carreau_exponent.
    relaxation_time: Annotated[float, Quantity("time", 1e-15, 1e3)] | None = None
    #: Exponent of Carreau's law; 1 is a Newtonian lubricant.
    carreau_exponent: Annotated[float, Quantity(None, 1e-3, 1.0)] | None = None
    #: Share of viscosity left at the highest shear rates.
    viscosity_left: Annotated[float, Quantity(None, 1e-9, 1.0)] = 0.0
    #: Uncertainty of viscosity: "20 %" means that it lies within a factor of 1.2, at 95 %.
    uncertainty: Share | None = None

    def lubricant(self) -> Lubricant:
        """Return the lubricant.

        Raises
        ------
        ParameterError
            If something is missing or does not fit the rest.
        """
        count = MODELS.get(self.model, 0)
        if self.viscosities is not None and count and len(self.viscosities) != count:
            known = len(self.viscosities)
            raise ParameterError(
                f"model '{self.model}' needs {count} pairs of temperature and viscosity, but viscosities has "
                f"{known}. {'Add' if known < count else 'Delete'} {abs(count - known)}, in one list, e.g. "
                f"{_written(_EXAMPLES[:count])}"
            )
        lubricant = self._of_example() if self.example else self._through_points()
        return replace(
            lubricant, thinning=self._thinning(), conductivity=self.conductivity, uncertainty=self.uncertainty
        )

    def _of_example(self) -> Lubricant:
        if self.example not in EXAMPLES:
            raise ParameterError(f"has no example '{self.example}'. Use one of {', '.join(EXAMPLES)}")
        plain = LubricantTable()
        for key in ("viscosities", "pressure_viscosity", "name", "source", "model"):
            if getattr(self, key) != getattr(plain, key):
                raise ParameterError(f"has both 'example' and '{key}'. Remove one")
        return EXAMPLES[self.example]

    def _through_points(self) -> Lubricant:
        if self.viscosities is None:
            raise ParameterError(f"lacks 'viscosities'. Add e.g. viscosities = {_written(_EXAMPLES[:2])}")
        if not self.model:
            raise ParameterError(f"lacks 'model'. {self._add_model(len(self.viscosities))}")
        return Lubricant(
            self.model,
            self.viscosities,
            density=self.density,
            pressure_viscosity=self.pressure_viscosity,
            name=self.name,
            source=self.source,
        )

    def _add_model(self, count: int) -> str:
        """What to write of the model: one that takes as many points, of the standard where it can."""
        takes = [
            name
            for name, law in _core.VISCOSITY_LAWS.items()
            if law.points == count and (self.density is not None or not law.kinematic)
        ]
        takes.sort(key=lambda name: not _core.VISCOSITY_LAWS[name].kinematic)
        if takes:
            return f'Add model = "{takes[0]}"'
        points = " or ".join(map(str, sorted(set(MODELS.values()))))
        return f"A model takes {points} pairs of temperature and viscosity, but viscosities has {count}"

    def _thinning(self) -> ShearThinning | None:
        time, exponent = self.relaxation_time, self.carreau_exponent
        if time is None and exponent is None and not self.viscosity_left:
            return None
        if time is None or exponent is None:
            raise ParameterError(
                "has shear thinning with only one of 'relaxation_time' and 'carreau_exponent'. State both"
            )
        return ShearThinning(time, exponent, self.viscosity_left)
