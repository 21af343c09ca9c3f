"""Quantities where the part slides, and what to write where one of another kind, or a range, is given."""

from __future__ import annotations

import math
import re
from typing import Any

from pydantic import ValidationInfo

from hersey.errors import HerseyError, UnitError
from hersey.files.toml import Quantity
from hersey.machine.rotational import has_angle, turning_at_radius
from hersey.machine.uncertainty import range_ends, read_uncertainty
from hersey.motion.parameters import OF_THE_BELT
from hersey.units import KINDS, convert, parse
from hersey.units.spelling import NUMBER

#: Standard gravity, m/s^2.
_GRAVITY = 9.80665
#: For a kind: kinds given instead, what they are, the factor to SI, the power of the roll radius (m).
_INSTEAD: dict[str, tuple[tuple[str, str, float, int], ...]] = {
    "belt speed": (("speed", "a rotational speed, which needs the radius", 1.0, 1),),
    "stiffness": (("torsional stiffness", "a torsional stiffness, which needs the radius", 1.0, -2),),
    "mass": (
        ("force", "a weight, but a mass is needed", 1 / _GRAVITY, 0),
        ("moment of inertia", "a moment of inertia, which needs the radius", 1.0, -2),
    ),
    "force": (
        ("mass", "a mass, but a force is needed", _GRAVITY, 0),
        ("torque", "a torque, but the force at the surface is needed", 1.0, -1),
    ),
    "torque": (("force", "a force, but a torque is needed", 1.0, 1),),
}

#: What leads from the other kind, by the power of the radius.
_BY_RADIUS = {
    1: "Add roll_radius, or multiply by it",
    -1: "Divide it by roll_radius",
    -2: "Add roll_radius, or divide by its square",
}

#: A value with its uncertainty, as 11 ± 1 N/mm, 11 N/mm +/- 1 N/mm or 11 N/mm ± 10 %.
_PLUS_MINUS = re.compile(
    r"\s*(?P<value>\d+(?:\.\d+)?)\s*(?P<first>[^\d±+].*?)?\s*(?:±|\+/?-)\s*(?P<by>\d+(?:\.\d+)?)\s*(?P<unit>\D.*)?"
)


class AtBelt(Quantity):
    """A quantity at the surface that slides; the radius of [drivetrain] leads to it from a rotational one."""

    def _with_unit(self, given: object, info: ValidationInfo[Any]) -> float:
        try:
            return super()._with_unit(given, info)
        except UnitError:
            turning = turning_at_radius(str(self.kind), str(given), _radius(info.context.document))
            if turning is not None:
                return turning
            key = str(info.field_name)
            meant = (
                self._range(given, key, info.context.document)
                or self._known_to(given, key)
                or self._converted(given, info.context.document)
            )
            if isinstance(given, str) and meant:
                raise UnitError(f"is {given}, {meant}") from None
            raise

    def _range(self, given: object, key: str, document: Any) -> str:
        """What to say of a range; nothing if it is none."""
        if key not in OF_THE_BELT:
            return ""
        try:
            # the unit that was typed is proposed, so any radius will do
            limits = read_uncertainty(key, given, roll_radius=_radius(document) or 1.0).limits
        except HerseyError:
            return ""
        ends = range_ends(str(given))
        low = re.match(rf"({NUMBER})\s*(.*)", ends[0]) if ends else None
        if limits is None or low is None:
            return ""
        middle = f"{float(low[1]) * math.sqrt(limits[1] / limits[0]):.4g} {low[2]}"
        return f'a range. Write one value here, e.g. "{middle}", and below [uncertainty]: {key} = "{given}"'

    def _known_to(self, given: object, key: str) -> str:
        """What to say of a value with its uncertainty behind a sign such as ±; nothing if it is none."""
        match = _PLUS_MINUS.fullmatch(str(given)) if key in OF_THE_BELT else None
        if match is None:
            return ""
        unit = (match["first"] or match["unit"] or "").strip()
        value, by = float(match["value"]), float(match["by"])
        known = (
            f"± {match['by']} %"
            if unit != match["unit"] and match["unit"] == "%"
            else (f"{value - by:.6g} {unit} to {value + by:.6g} {unit}")
        )
        try:
            parse(str(self.kind), f"{value} {unit}")
            read_uncertainty(key, known)
        except HerseyError:
            return ""
        return (
            f'a value with its uncertainty. Write "{match["value"]} {unit}" here, and below [uncertainty]: '
            f'{key} = "{known}"'
        )

    def _converted(self, given: object, document: Any) -> str:
        """What to say of a quantity of another kind; nothing if none is known."""
        for kind, what, factor, power in _INSTEAD.get(str(self.kind), ()):
            try:
                value = parse(kind, str(given))
                if kind == "torsional stiffness" and not has_angle(str(given)):
                    continue  # N*m, which is a slip of N/m too
                radius = _radius(document) if power else 1.0
            except UnitError:
                continue
            if value > 0 and radius is None:
                return f"{what}. {_BY_RADIUS[power]}"
            if value > 0 and radius:
                return f'{what}. Write "{self._written(value * factor * radius**power)}"'
        return ""

    def _written(self, value: float) -> str:
        si, usual = KINDS[str(self.kind)]
        return f"{convert(value, si, usual):.4g} {usual}"


def _radius(document: Any) -> float | None:
    """The roll radius of a document, m; None if it states none that can be read."""
    try:
        return parse("length", str(document["drivetrain"]["roll_radius"]))
    except (UnitError, LookupError, TypeError):
        return None
