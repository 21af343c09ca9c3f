"""Values of a machine file that are possible, but so unusual that a unit is probably wrong."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import Any

from hersey.errors import UnitError
from hersey.machine.limits import OperatingPoint
from hersey.schema.warning import Warning
from hersey.units import celsius, parse

#: Natural frequencies of a belt on its drive, Hz, and the coldest temperature, K, that need no question.
_SLOWEST, _FASTEST, _COLDEST = 0.5, 500.0, 250.0
#: Greatest modulus of a rubber that needs no question, Pa: Shore A 80 is 9 MPa.
_HARD_RUBBER = 3e7
#: Hardnesses, Shore A, that the formula of the modulus covers.
_SHORE_A = (20.0, 80.0)

#: A number whose point may stand between thousands, as in German: 1.300 for 1300; and what follows it.
_THOUSANDS = re.compile(r"\s*([1-9][0-9]{0,2})\.([0-9]{3})(?![0-9.eE])(.*)", re.DOTALL)
#: Kind and plausible range (SI) of values that are often thousands of their unit, by table and key.
_PLAUSIBLE = {
    ("drivetrain", "stiffness"): ("stiffness", 100.0, 1e8),
    ("limits", "nip_load"): ("force", 10.0, 1e5),
    ("limits", "speed"): ("belt speed", 0.01, 10.0),
    ("limits", "acceleration"): ("acceleration", 0.01, 100.0),
    ("contact", "load"): ("force", 10.0, 1e5),
}


def thousands(document: Mapping[str, Any]) -> Iterator[Warning]:
    """Yield values of a machine file, as written, that are plausible only if a point separates thousands.

    Three decimals are usual in a measured value, so neither they nor a small value alone are doubted.
    """
    for (table, key), (kind, low, high) in _PLAUSIBLE.items():
        values = document.get(table)
        text = values.get(key) if isinstance(values, Mapping) else None
        match = _THOUSANDS.fullmatch(text) if isinstance(text, str) else None
        if text is None or match is None:
            continue
        with suppress(UnitError):
            value = parse(kind, text)
            if value < low <= 1e3 * value <= high:
                yield Warning(
                    "thousands",
                    "[{table}] {key} is read as {decimal}, which is unusually small",
                    severity="watch",
                    remedy='If the point separates thousands, write {key} = "{whole}"',
                    table=table,
                    key=key,
                    decimal=f"{float(f'{match[1]}.{match[2]}'):g} {match[3].strip()}",
                    whole=f"{match[1]}{match[2]} {match[3].strip()}",
                )


def doubts(
    *,
    stiffness: float,
    mass: float,
    stick_speed: float,
    points: tuple[OperatingPoint, ...],
    modulus: float | None,
) -> Iterator[Warning]:
    """Yield what is unusual, and the value that was probably meant.

    Parameters
    ----------
    stiffness, mass, stick_speed
        N/m, kg and m/s, at the belt; infinite if not stated.
    points
        Operating points.
    modulus
        Young's modulus of the rubber, Pa, if it is stated.
    """
    stated = math.isfinite(stiffness) and math.isfinite(mass)
    frequency = math.sqrt(stiffness / mass) / (2 * math.pi) if stated else math.nan
    if stated and not _SLOWEST <= frequency <= _FASTEST:
        words = (
            "stiffness {stiffness:.4g} N/m and mass {mass:.4g} kg give a natural frequency of "
            "{frequency:.2g} Hz; usual are {slowest:g} to {fastest:g} Hz"
        )
        yield Warning(
            "natural frequency",
            words,
            severity="watch",
            remedy="Check both units. Was this meant: "
            + (
                'stiffness = "{stiffness:.4g} N/mm" or mass = "{mass:.4g} g"?'
                if frequency < _SLOWEST
                else 'mass = "{grams:.4g} kg" or stiffness = "{per_mm:.4g} N/m"?'
            ),
            stiffness=stiffness,
            mass=mass,
            frequency=frequency,
            slowest=_SLOWEST,
            fastest=_FASTEST,
            grams=1e3 * mass,
            per_mm=stiffness / 1e3,
        )
    slowest = min((point.speed for point in points), default=math.inf)
    if slowest <= stick_speed < math.inf:
        yield Warning(
            "stick speed above the operating points",
            "stick_speed {stick_speed:.4g mm/s} is not below the slowest operating point, {slowest:.4g mm/s}",
            severity="watch",
            remedy='Check its unit. Was this meant: stick_speed = "{stick_speed:.4g} mm/s"?',
            stick_speed=stick_speed,
            slowest=slowest,
        )
    for point in points:
        if point.temperature < _COLDEST:
            yield Warning(
                "cold operating point",
                "the temperature of operating point '{name}', {temperature:.4g} K, is {celsius:.4g} degC",
                severity="watch",
                remedy='Was this meant: temperature = "{temperature:.4g} degC"?',
                name=point.name,
                temperature=point.temperature,
                celsius=float(celsius(point.temperature)),
            )
    if modulus is not None and modulus > _HARD_RUBBER:
        shore = _SHORE_A[0] <= modulus / 1e6 <= _SHORE_A[1]
        yield Warning(
            "modulus of the layer",
            "[contact] modulus {megapascal:.4g} MPa is far above that of an elastomer, 0.5 to 10 MPa",
            severity="watch",
            remedy="If it is the hardness, write shore_a = {megapascal:.4g} instead of modulus"
            if shore
            else "Check its unit, or state the hardness instead, e.g. shore_a = 60",
            modulus=modulus,
            megapascal=modulus / 1e6,
        )
