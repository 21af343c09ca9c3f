"""The tables ``[contact]`` and ``[lubricant]`` of `machine.toml`."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

from hersey.errors import ParameterError, UnitError, WrongKindError
from hersey.files.toml_values import value_of, values
from hersey.lubrication.contact import Contact, shore_a_modulus
from hersey.lubrication.lubricant import EXAMPLES, MODELS, Lubricant, ShearThinning
from hersey.units import parse

#: Kind of unit, least and greatest value that is believed, in SI.
_CONTACT = {
    "roll_radius": ("length", 1e-4, 10.0),
    "rubber_thickness": ("length", 1e-5, 1.0),
    "modulus": ("pressure", 1e4, 1e12),
    "shore_a": (None, 20.0, 80.0),
    "poisson_ratio": (None, 1e-9, 0.5),
    "length": ("length", 1e-4, 100.0),
    "load": ("force", 1e-3, 1e7),
    "heater_radius": ("length", 1e-4, 1e6),
    "roughness": ("length", 1e-10, 1e-3),
}
_LUBRICANT = {
    "density": ("density", 100.0, 2e4),
    "conductivity": ("thermal conductivity", 1e-3, 1e3),
    "relaxation_time": ("time", 1e-15, 1e3),
    "carreau_exponent": (None, 1e-3, 1.0),
    "viscosity_left": (None, 1e-9, 1.0),
}
_TEXTS = ("name", "source", "model", "example")
_LISTS = ("viscosities", "pressure_viscosity")
#: Where a coefficient that holds for all temperatures is noted, K.
_ANY = 298.15
#: A temperature and a coefficient that no lubricant exceeds.
_TEMPERATURE, _ALPHA = ("temperature", 150.0, 1000.0), ("pressure-viscosity coefficient", 1e-12, 1e-6)


def read_contact(file: str, table: object, *, roll_radius: float, load: float | None) -> Contact:
    """Return the contact of a table; radius and load come from the machine where the table lacks them.

    Raises
    ------
    ParameterError, UnitError
        Each names the file and the key.
    """
    stated, share = _share(file, "contact", table, "nip_uncertainty")
    own = {"roll_radius": roll_radius, **values(file, "contact", stated, _CONTACT)}
    if load is not None:
        own.setdefault("load", load)
    hardness = own.pop("shore_a", None)
    if (hardness is None) == ("modulus" not in own):
        raise ParameterError(f"{file}: [contact] needs either 'modulus' or 'shore_a'")
    if hardness is not None:
        own["modulus"] = shore_a_modulus(hardness)
    for key in ("rubber_thickness", "poisson_ratio", "length", "load"):
        if key not in own:
            raise ParameterError(f"{file}: [contact] lacks '{key}'")
    try:
        return Contact(**own, nip_uncertainty=share)
    except ParameterError as error:
        raise error.within(f"{file}: [contact]") from None


def read_lubricant(file: str, table: object) -> Lubricant:
    """Return the lubricant of a table: one of the examples, or one through the points of a data sheet.

    Raises
    ------
    ParameterError, UnitError
        Each names the file and the key.
    """
    stated, share = _share(file, "lubricant", table, "uncertainty")
    texts = {key: stated.pop(key) for key in _TEXTS if key in stated}
    for key, text in texts.items():
        if not isinstance(text, str):
            raise ParameterError(f"{file}: lubricant.{key} is {text!r}: write a text")
    lists = {key: stated.pop(key) for key in _LISTS if key in stated}
    own = values(file, "lubricant", stated, _LUBRICANT)
    thinning = _thinning(file, own)
    if "example" in texts:
        lubricant = _example(file, str(texts["example"]), lists, texts)
    else:
        lubricant = _through_points(file, texts, lists, own.get("density"))
    return replace(lubricant, thinning=thinning, conductivity=own.get("conductivity"), uncertainty=share)


def _example(file: str, name: str, lists: Mapping[str, object], texts: Mapping[str, object]) -> Lubricant:
    if name not in EXAMPLES:
        raise ParameterError(f"{file}: lubricant.example '{name}' is not known: {', '.join(EXAMPLES)}")
    if lists or len(texts) > 1:
        other = [*lists, *(key for key in texts if key != "example")][0]
        raise ParameterError(f"{file}: [lubricant] has both 'example' and '{other}': leave one out")
    return EXAMPLES[name]


def _through_points(
    file: str, texts: Mapping[str, object], lists: Mapping[str, object], density: float | None
) -> Lubricant:
    model = str(texts.get("model", ""))
    if model not in MODELS:
        raise ParameterError(f"{file}: lubricant.model is '{model}': {', '.join(MODELS)} are known")
    if "viscosities" not in lists:
        raise ParameterError(f"{file}: [lubricant] lacks 'viscosities'")
    rows = _pairs(file, "viscosities", lists["viscosities"])
    points = tuple((_kelvin(file, "viscosities", at), _viscosity(file, text, density)) for at, text in rows)
    try:
        return Lubricant(
            model,
            points,
            density=density,
            pressure_viscosity=_alphas(file, lists.get("pressure_viscosity", [])),
            name=str(texts.get("name", "lubricant")),
            source=str(texts.get("source", "")),
        )
    except ParameterError as error:
        raise error.within(f"{file}: [lubricant]") from None


def _alphas(file: str, given: object) -> tuple[tuple[float, float], ...]:
    if isinstance(given, str):  # one coefficient for all temperatures
        return ((_ANY, value_of(file, "lubricant.pressure_viscosity", given, *_ALPHA)),)
    rows = _pairs(file, "pressure_viscosity", given)
    key = "pressure_viscosity"
    return tuple((_kelvin(file, key, at), value_of(file, f"lubricant.{key}", a, *_ALPHA)) for at, a in rows)


def _pairs(file: str, key: str, given: object) -> list[tuple[object, object]]:
    rows = given if isinstance(given, list) else [given]
    pairs = [row for row in rows if isinstance(row, list) and len(row) == 2]
    if len(pairs) != len(rows):
        example = '[["40 degC", "400 mm^2/s"], ["100 degC", "40 mm^2/s"]]'
        raise ParameterError(f"{file}: lubricant.{key} is no list of pairs: write it as {example}")
    return [(pair[0], pair[1]) for pair in pairs]


def _kelvin(file: str, key: str, text: object) -> float:
    return value_of(file, f"lubricant.{key}", text, *_TEMPERATURE)


def _viscosity(file: str, text: object, density: float | None) -> float:
    """Dynamic viscosity, Pa s, of one that is written as dynamic or kinematic."""
    where = "lubricant.viscosities"
    if isinstance(text, str):
        try:
            parse("kinematic viscosity", text)
        except WrongKindError:
            return value_of(file, where, text, "viscosity", 1e-6, 1e9)
        except UnitError as error:
            raise UnitError(f"{file}: {where}: {error}") from None
    kinematic = value_of(file, where, text, "kinematic viscosity", 1e-9, 1e6)
    if density is None:
        raise ParameterError(f"{file}: {where} holds {text}: a kinematic viscosity needs 'density'")
    return kinematic * density


def _thinning(file: str, own: Mapping[str, float]) -> ShearThinning | None:
    given = [key for key in ("relaxation_time", "carreau_exponent") if key in own]
    if not given and "viscosity_left" not in own:
        return None
    if len(given) < 2:
        raise ParameterError(
            f"{file}: [lubricant]: shear thinning needs both 'relaxation_time' and 'carreau_exponent'"
        )
    return ShearThinning(own["relaxation_time"], own["carreau_exponent"], own.get("viscosity_left", 0.0))


def _share(file: str, name: str, table: object, key: str) -> tuple[dict[str, object], float | None]:
    """The table without a share such as ``"20 %"``, and that share."""
    if not isinstance(table, dict):
        raise ParameterError(f"{file}: {name} is not a table: write [{name}]")
    rest = dict(table)
    text = rest.pop(key, None)
    if text is None:
        return rest, None
    match = re.fullmatch(r"\s*(\d+\.?\d*)\s*%\s*", text) if isinstance(text, str) else None
    if match is None or not 0 < float(match[1]) < 1000:
        raise ParameterError(f"{file}: {name}.{key} is {text!r}: write a share such as '20 %'")
    return rest, float(match[1]) / 100
