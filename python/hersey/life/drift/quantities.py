"""What moved: numbers that anyone can read off a Stribeck curve, when new and as they change with age.

They follow from the joint fit; their errors to first order from its covariance.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.distributions import normal_quantile, student_quantile
from hersey.life.drift.aged_torque import OWN, Scales, parts
from hersey.life.drift.fit import Fitted
from hersey.life.growth.limit_ages import CONFIDENCE, Interval
from hersey.result import OPEN, Means, Record
from hersey.units import celsius, rpm

#: Ages at which the curves of a chart are drawn.
_AGES = 13
#: Steps of numerical derivatives, and of ln speed in the search of the least torque.
_STEP, _FINE = 1e-4, 0.02
_GAS = 8.314462618


@dataclass(frozen=True, repr=False)
class Quantity(Record):
    """Something of the drag, when new and how it changed up to the oldest age.

    ``si`` is its unit. ``relative``: ``change`` is that of its ratio to the value when new, less 1; otherwise
    the difference. ``change`` is that of all specimens with its 90 % interval, ``units`` holds it for each;
    NaN where it has no value. ``curves`` has a row per specimen and ``band`` low, middle and high of all at
    `ages`.
    """

    name: str
    si: str
    relative: Annotated[
        bool,
        Means("whether the change is relative to the value when new, or a difference"),
    ]
    where: Annotated[str, Means("of what, and at which speed and temperature, in words")]
    new: Annotated[float, OPEN]
    change: Interval
    units: tuple[Interval, ...]
    curves: Annotated[FloatArray, Means("of each specimen, at each age", shape="(units, ages)", open=True)]
    band: Annotated[FloatArray, Means("low, middle and high for all specimens", shape="(3, ages)", open=True)]

    @property
    def moved(self) -> bool:
        """Whether the interval of its change leaves out nil."""
        return bool(self.change.low > 0.0 or self.change.high < 0.0)

    def shown(self, value: float, *, sign: bool = False) -> str:
        """Return a change as a reader sees it: per cent where it is relative."""
        if not np.isfinite(value):
            return "unknown"
        scale, unit = (100.0, " %") if self.relative else _SHOWN.get(self.si, (1.0, ""))
        return f"{value * scale:{'+' if sign else ''}.3g}{unit}"

    def __str__(self) -> str:
        """Return name, place and change with its interval."""
        if not np.isfinite(self.change.value):
            return f"{self.name} ({self.where}): not determined"
        ends = f"[{self.shown(self.change.low, sign=True)}, {self.shown(self.change.high, sign=True)}]"
        return f"{self.name} ({self.where}): {self.shown(self.change.value, sign=True)} {ends}"


#: How changes that are not relative are shown: scale and unit.
_SHOWN = {"N m": (1e3, " mN m"), "J/mol": (1e-3, " kJ/mol"), "1": (1.0, "")}


@dataclass(frozen=True)
class _Kind:
    """A quantity: how it is called and shown, and its value for runs' own values, (..., own)."""

    name: str
    si: str
    relative: bool
    where: str
    value: Callable[[FloatArray], FloatArray]  #: its logarithm if it is relative


def _kinds(scales: Scales, shared: FloatArray) -> list[_Kind]:
    middle = float(np.sqrt(scales.speed[0] * scales.speed[1]))
    slow, fast = scales.speed

    def drag(own: FloatArray, speed: float, place: float, step: float = 0.0) -> FloatArray:
        """Logarithm of the torque without the rest."""
        at = parts(scales, np.array([speed * np.exp(step)]), np.array([place]), own, shared, slopes=False)
        return np.asarray(np.log(np.maximum(at.film + at.contact, 1e-12) * scales.torque)[..., 0])

    def exponent(own: FloatArray, speed: float, place: float) -> FloatArray:
        rise = drag(own, speed, place, _STEP) - drag(own, speed, place, -_STEP)
        return np.asarray(rise / (2.0 * _STEP) - 1.0)

    def energy(own: FloatArray) -> FloatArray:
        rise = drag(own, middle, _STEP) - drag(own, middle, -_STEP)
        return np.asarray(_GAS * rise / (2.0 * _STEP * (scales.inverse[1] - scales.inverse[0])))

    def least(own: FloatArray) -> FloatArray:
        """Logarithm of the speed of least torque of film and contact; NaN unless it lies near the data."""
        speeds = np.exp(np.arange(np.log(slow / 3.0), np.log(fast * 3.0), _FINE))
        at = parts(scales, speeds, np.full(speeds.shape, -0.5 * scales.thermal), own, shared, slopes=False)
        curve = at.film + at.contact
        i = np.clip(curve.argmin(axis=-1), 1, speeds.size - 2)
        left, centre, right = (np.take_along_axis(curve, (i + k)[..., None], -1)[..., 0] for k in (-1, 0, 1))
        bend = left - 2.0 * centre + right
        off = np.divide(0.5 * (left - right), bend, out=np.full(bend.shape, np.nan), where=bend > 0.0)
        return np.asarray(np.where(np.abs(off) <= 1.0, np.log(speeds[i]) + off * _FINE, np.nan))

    def rest(own: FloatArray) -> FloatArray:
        at = parts(scales, np.array([middle]), np.zeros(1), own, shared, slopes=False)
        return np.asarray(at.rest[..., 0] * scales.torque)

    hot, cold = (f", {celsius(1.0 / each):.0f} degC" * scales.thermal for each in scales.inverse)
    half = scales.temperature(0.0)
    centre = f"{rpm(middle):.3g} rpm" + ("" if half is None else f", {celsius(half):.0f} degC")
    found = [
        _Kind(
            "level",
            "N m",
            True,
            f"torque minus no-load torque at {centre}",
            lambda own: drag(own, middle, 0.0),
        ),
        _Kind(
            "exponent, cold and fast" if scales.thermal else "exponent, fast",
            "1",
            False,
            f"of damping at {rpm(fast):.3g} rpm{cold}",
            lambda own: exponent(own, fast, 0.5 * scales.thermal),
        ),
        _Kind(
            "exponent, hot and slow" if scales.thermal else "exponent, slow",
            "1",
            False,
            f"of damping at {rpm(slow):.3g} rpm{hot}",
            lambda own: exponent(own, slow, -0.5 * scales.thermal),
        ),
        _Kind("speed of least torque", "rad/s", True, f"of film and contact{hot}", least),
    ]
    if scales.thermal:
        found.append(
            _Kind(
                "temperature law", "J/mol", False, f"apparent activation energy of torque at {centre}", energy
            )
        )
    found.append(_Kind("no-load torque", "N m", False, f"at {rpm(middle):.3g} rpm", rest))
    return found


def quantities_of(found: Fitted, oldest: float) -> tuple[tuple[Quantity, ...], FloatArray]:
    """Return the quantities that a fit determines, and the ages of their curves."""
    solved, own = found.solved, len(OWN)
    line_size = 2 * own
    grid = np.linspace(0.0, 1.0, _AGES)
    units = len(solved.specimen)
    # Of all: the line of the population, whose spread counts; of one specimen: its own.
    line, covariance = solved.common[:line_size], solved.common_covariance[:line_size, :line_size]
    specimen_quantile = float(normal_quantile(0.5 + CONFIDENCE / 2))
    population_quantile = (
        float(student_quantile(0.5 + CONFIDENCE / 2, units - 1)) if units > 1 else specimen_quantile
    )
    if units == 1:
        line, covariance = solved.mean, solved.mean_covariance
    to_age = np.stack([np.hstack([np.eye(own), t * np.eye(own)]) for t in grid])
    along, spread = to_age @ line, to_age @ covariance @ to_age.swapaxes(1, 2)
    quantities = []
    for kind in _kinds(found.scales, solved.common[line_size:]):
        new, change, error = _changed(kind.value, line[None], covariance[None])
        _, own_change, own_error = _changed(kind.value, solved.specimen, solved.specimen_covariance)
        curves = np.stack(
            [kind.value(solved.specimen[:, :own] + t * solved.specimen[:, own:]) for t in grid], axis=1
        )
        middle, half = kind.value(along), population_quantile * _error(_slope(kind.value, along), spread)
        band = np.stack([middle - half, middle, middle + half])
        if kind.relative:
            new, curves, band = np.exp(new), np.exp(curves), np.exp(band)
        quantities.append(
            Quantity(
                kind.name,
                kind.si,
                kind.relative,
                kind.where,
                float(new[0]),
                _interval(kind, change[0], population_quantile * error[0]),
                tuple(
                    _interval(kind, c, specimen_quantile * e)
                    for c, e in zip(own_change, own_error, strict=True)
                ),
                curves,
                band,
            )
        )
    return tuple(quantities), grid * oldest


def _interval(kind: _Kind, change: float, half: float) -> Interval:
    ends = (change, change - half, change + half)
    return Interval(*(float(np.expm1(each)) if kind.relative else float(each) for each in ends))


def _changed(
    value: Callable[[FloatArray], FloatArray], line: FloatArray, covariance: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """A quantity when new, its change up to the oldest age, and its error; lines (specimens, 2 own)."""
    own = len(OWN)
    new, old = line[:, :own], line[:, :own] + line[:, own:]
    at_end = _slope(value, old)
    slope = np.concatenate([at_end - _slope(value, new), at_end], axis=1)
    start = value(new)
    return start, value(old) - start, _error(slope, covariance)


def _slope(value: Callable[[FloatArray], FloatArray], own: FloatArray) -> FloatArray:
    """Derivatives of a quantity by a run's own values, (specimens, own)."""
    steps = _STEP * np.eye(len(OWN))
    rises = [value(own + step) - value(own - step) for step in steps]
    return np.stack(rises, axis=1) / (2.0 * _STEP)


def _error(slope: FloatArray, covariance: FloatArray) -> FloatArray:
    return np.asarray(np.sqrt(np.maximum(np.einsum("ui,uij,uj->u", slope, covariance, slope), 0.0)))
