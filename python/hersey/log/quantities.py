"""Quantities of a file that no log holds, so that `hersey.units` has no kind for them."""

from __future__ import annotations

import re

from hersey.errors import UnitError
from hersey.files.toml import Quantity
from hersey.units import registry

_FACTOR = r"[A-Za-zµμ]{1,20}(?:(?:\^|\*\*)[1-4])?"  # nothing that pint would compute for ever
_AMOUNT = re.compile(
    rf"([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*({_FACTOR}(?:\s*[*/.·]\s*{_FACTOR}){{0,4}})"
)
#: Characters of an amount at the most: the pattern takes longer than linear.
_LONGEST_AMOUNT = 160
#: SI units of what no log holds.
_UNITS = {"motor constant": "N*m/A", "moment of inertia": "kg*m^2", "temperature difference": "K"}


def amount(text: str) -> re.Match[str] | None:
    """Return number and unit of a text that is an amount, or None."""
    return _AMOUNT.fullmatch(text.strip()) if len(text) <= _LONGEST_AMOUNT else None


class Amount(Quantity):
    """A quantity of a kind that no log holds."""

    @property
    def unit(self) -> str:
        """SI unit."""
        return _UNITS[str(self.kind)]

    def parsed(self, text: str) -> float:
        """Return the SI value of a text such as ``"35 mN*m/A"``."""
        match = amount(text)
        try:
            if match is None:
                raise ValueError(text)
            unit = registry.parse_units(re.sub("[.·]", "*", match[2]))
            if self.kind == "temperature difference" and str(unit).startswith("degree"):
                raise ValueError(text)
            return float(registry.Quantity(float(match[1]), unit).to(self.unit).magnitude)
        except Exception:  # pint raises many kinds, from its tokenizer too
            raise UnitError(
                f"is '{text}', not a {self.kind}. Write a number and a unit, e.g. \"{self.example}\""
            ) from None
