"""The table [rest] of the machine file: what the drive takes without the film."""

from __future__ import annotations

import re
import shlex
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, ValidationInfo
from pydantic.dataclasses import dataclass

from hersey.damping.no_load import no_load_torque
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.damping.recipe import Recipe
from hersey.errors import HerseyError, ParameterError
from hersey.files.reading import hash_of
from hersey.files.text import shown
from hersey.files.toml import Quantity, Share, Table, Text
from hersey.machine.finding import named_log

_SLOPE = re.compile(r"([-+]?[0-9]+(?:\.[0-9]*)?)\s*%\s*/\s*(?:K|kelvin|degC|°C)")
#: No drive changes so much in a kelvin.
_STEEPEST = 0.2


def _slope(given: Any, info: ValidationInfo[Any]) -> Any:
    """A share per kelvin, 1/K."""
    if info.context is None:
        return given
    match = _SLOPE.fullmatch(given.strip()) if isinstance(given, str) and len(given) < 60 else None
    if match is None:
        raise ParameterError(f"is {shown(given)}. Write a share per kelvin, e.g. '-0.2 %/K'")
    if abs(float(match[1])) / 100 > _STEEPEST:
        raise ParameterError(f"is {shown(given)}, but at most {100 * _STEEPEST:g} %/K is plausible")
    return float(match[1]) / 100


#: A share for each kelvin such as ``"-0.2 %/K"``, in 1/K.
PerKelvin = Annotated[float, BeforeValidator(_slope)]


@dataclass(frozen=True)
class RestTable(Table):
    """Either the numbers, or a ``log`` recorded without the film, beside the machine file."""

    #: No-load torque, at the roll: the part that does not depend on speed.
    torque: Annotated[float, Quantity("torque", 0.0, 1e6, "20 mN*m")] | None = None
    #: Increase of the no-load torque with speed.
    damping: Annotated[float, Quantity("rotational damping", 0.0, 1e6, "1 mN*m*s/rad")] | None = None
    #: Change of the whole no-load torque per kelvin, as a share of it.
    temperature_slope: PerKelvin | None = None
    #: Temperature at which torque and damping hold; needed with temperature_slope.
    at: Annotated[float, Quantity("temperature", 150.0, 1000.0, "180 degC")] | None = None
    #: Uncertainty of the no-load torque.
    uncertainty: Share | None = None
    #: Log recorded without the lubricated contact, beside the machine file, instead of numbers.
    log: Text | None = None
    #: "standing": subtract the torque that this log shows at standstill.
    tare: Text | None = None

    def rest(self, path: Path) -> NoLoadTorque:
        """Return the no-load torque; ``path`` is that of the machine file."""
        numbers = ("torque", "damping", "temperature_slope", "at", "uncertainty")
        stated = [name for name in numbers if getattr(self, name) is not None]
        if self.log is not None:
            if stated:
                raise ParameterError(f"has both log and {stated[0]}. State either the numbers or the log")
            return self._of_log(path)
        if self.tare is not None:
            raise ParameterError("has tare but no log. tare says how the zero of the log is subtracted")
        if not self.torque and not self.damping:
            raise ParameterError('has no torque, damping or log. Add e.g. torque = "20 mN*m"')
        if self.temperature_slope is not None and self.at is None:
            raise ParameterError(
                'has temperature_slope but no reference temperature. Add e.g. at = "180 degC"'
            )
        return NoLoadTorque.stated(
            constant=self.torque or 0.0,
            per_speed=self.damping or 0.0,
            temperature_slope=self.temperature_slope or 0.0,
            reference_temperature=self.at if self.temperature_slope else None,
            uncertainty=self.uncertainty or 0.0,
            source=f"[rest] of {path.name}",
        )

    def _of_log(self, path: Path) -> NoLoadTorque:
        named = named_log(path, "rest", "log", str(self.log))
        try:
            mapping = Recipe(logs=(named,)).chosen.source
            return _fitted(
                named, self.tare or "none", hash_of(named), "" if mapping is None else hash_of(mapping)
            )
        except HerseyError as error:
            refusal = error.within(f"{path.name}: [rest] log")
            refusal.setting = None
            refusal.remedy = (
                f"check it with: hersey inspect {shlex.quote(str(self.log))}. Describe its columns in "
                f'{named.stem}.hersey.toml beside it, or replace log by a number, torque = "20 mN*m"'
            )
            raise refusal from None


@lru_cache(maxsize=8)
def _fitted(log: Path, tare: str, _log: str, _mapping: str) -> NoLoadTorque:
    """The no-load torque of a log, kept by the hashes of its files: campaigns read it many times."""
    return no_load_torque(Recipe(logs=(log,), tare=tare).points())
