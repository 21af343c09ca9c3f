"""The tables [life] and [gear] of the machine file: how the machine is used, and what it may take."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, ValidationInfo
from pydantic.dataclasses import dataclass

from hersey.errors import ParameterError
from hersey.files.text import shown
from hersey.files.toml import Quantity, Share, Table, Text
from hersey.machine.finding import named_log
from hersey.machine.limits import OperatingPoint

_Torque = Annotated[float, Quantity("torque", 1e-6, 1e6, "20 N*m")]
_NUMBER = r"[0-9]+(?:\.[0-9]*)?(?:[eE][-+]?[0-9]+)?"
_COUNTED = re.compile(rf"\s*{_NUMBER}\s*[^\W\d_][\w-]*\s*")
_STARTS = re.compile(rf"\s*({_NUMBER})\s+(?:per|in)\s+({_NUMBER}\s*)?([^\W\d_][\w-]*)\s*")
#: Rounding that the shares of the points may sum up to.
_SLIP = 0.001


def _age(given: Any, info: ValidationInfo[Any]) -> Any:
    """A number of what the age of a unit counts; the campaign knows what that is."""
    if info.context is not None and not (isinstance(given, str) and _COUNTED.fullmatch(given[:100])):
        raise ParameterError(f"is {shown(given)}. Write a number and its unit of age, e.g. '1200 pages'")
    return given


def _starts(given: Any, info: ValidationInfo[Any]) -> Any:
    """A number, and the age in which so many are counted."""
    if info.context is None:
        return given
    match = _STARTS.fullmatch(given[:100]) if isinstance(given, str) else None
    if match is None or not float(match[1]) > 0.0:
        raise ParameterError(f"is {shown(given)}. Write a number per age, e.g. '20 per 1000 pages'")
    return float(match[1]), f"{(match[2] or '1').strip()} {match[3]}"


def _slope(given: Any, info: ValidationInfo[Any]) -> Any:
    if info.context is None or given == "haibach":
        return given
    if isinstance(given, bool) or not isinstance(given, int | float) or not 0 < given < 1e3:
        raise ParameterError(f"is {shown(given)}. Write a number such as 9, or 'haibach'")
    return float(given)


@dataclass(frozen=True)
class LifeTable(Table):
    """How the machine is used, and what it may take: SI, None where nothing is stated.

    ``coldest`` (K) is the temperature of the coldest start, ``travel`` (m) that of the belt in one unit of
    age (a page), ``energy`` (J) what the roll may take in one unit of age, ``continuous_torque`` (N m) what
    the motor bears without end, as root of the mean square.
    """

    #: Temperature of the coldest start; without it the coldest that all specimens recorded.
    coldest: Annotated[float, Quantity("temperature", 150.0, 1000.0, "15 degC")] | None = None
    #: Travel of the belt in one unit of age, such as a page.
    travel: Annotated[float, Quantity("length", 1e-6, 1e6, "300 mm")] | None = None
    #: Greatest energy that the roll may take in one unit of age.
    energy: Annotated[float, Quantity("energy", 1e-9, 1e12, "10 J")] | None = None
    #: Torque that the motor withstands continuously, at the roll, rms.
    continuous_torque: Annotated[float, Quantity("torque", 1e-6, 1e6, "0.5 N*m")] | None = None


@dataclass(frozen=True)
class GearTable(Table):
    """A part of the gear train that fatigues: its S-N curve, as of `hersey.SNCurve`, and what loads it.

    ``torque`` (N m, amplitude at the part), ``cycles``, ``slope``, ``second_slope``, ``endurance`` (N m) and
    ``ultimate`` (N m) are the curve; ``ratio`` is the torque at the part over that at the roll. ``starts``
    says how many in what age, of which ``cold_starts`` are at the coldest temperature. ``duty`` is a log of
    the torque in use, a path beside the machine file, recorded over ``duty_age``. The part is taken to
    fail at Miner's sum ``damage``.
    """

    #: Torque amplitude at the knee of the S-N curve, at the part.
    torque: _Torque
    #: Cycles to failure at the knee.
    cycles: Annotated[float, Quantity(None, 1.0, 1e15, "2e6")]
    #: Slope of the S-N curve above the knee, positive.
    slope: Annotated[float, Quantity(None, 0.1, 1e3, "7")]
    #: Slope below the knee: a number, or "haibach" for 2 slope - 1; without it slope holds everywhere.
    second_slope: Annotated[float | str, BeforeValidator(_slope)] | None = None
    #: Torque amplitude below which cycles do no damage.
    endurance: _Torque | None = None
    #: Torque at which the part breaks at once; with it the mean torque counts (Goodman's line).
    ultimate: _Torque | None = None
    #: Torque at the part over torque at the roll.
    ratio: Annotated[float, Quantity(None, 1e-6, 1e6, "3.5")] = 1.0
    #: Number of starts per age.
    starts: Annotated[tuple[float, str], BeforeValidator(_starts)] | None = None
    #: Share of the starts at the coldest temperature; without it all of them.
    cold_starts: Share | None = None
    #: Log of the torque in use, beside the machine file.
    duty: Text | None = None
    #: Age over which duty was recorded.
    duty_age: Annotated[str, BeforeValidator(_age)] | None = None
    #: Miner's sum at which the part is taken to fail.
    damage: Annotated[float, Quantity(None, 1e-6, 1e3, "0.5")] = 1.0

    def gear(self, path: Path) -> GearTable:
        """Return it with the full path of its log; ``path`` is that of the machine file.

        Raises
        ------
        ParameterError
            If the log or the age over which it was recorded is missing, or more starts are cold than all.
        MissingFileError
            If there is no such log.
        """
        if self.duty is not None and self.duty_age is None:
            raise ParameterError(
                "has duty but no duty_age. Add the age over which duty was recorded, e.g. duty_age = "
                '"1200 pages"'
            )
        if self.duty is None and self.duty_age is not None:
            raise ParameterError('has duty_age but no duty. Add the log, e.g. duty = "duty.csv"')
        if self.cold_starts is not None and self.starts is None:
            raise ParameterError(
                'has cold_starts but no starts. Add the number of starts, e.g. starts = "20 per 1000 pages"'
            )
        if self.cold_starts is not None and self.cold_starts > 1.0:
            raise ParameterError(f"cold_starts are {100 * self.cold_starts:g} %, but must not exceed 100 %")
        if self.duty is None:
            return self
        log = named_log(path, "gear", "duty", self.duty)
        return replace(self, duty=str(log.absolute()))


def refuse_other_than_all(points: Sequence[OperatingPoint]) -> None:
    """Refuse points of which some state a share of the running time and others none, or not all of it.

    Raises
    ------
    ParameterError
        With the way out.
    """
    shares = [point.share for point in points if point.share is not None]
    if not shares:
        return
    if len(shares) < len(points):
        bare = next(point.name for point in points if point.share is None)
        raise ParameterError(f"'{bare}' has no share, but other points have one. State all shares, or none")
    if abs(sum(shares) - 1.0) > _SLIP:
        raise ParameterError(f"the shares add up to {100 * sum(shares):.4g} %, but must add up to 100 %")
