"""What a channel of a drive can read at all, and the numbers that loggers write instead of a reading."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.units import Conversion, conversion


@dataclass(frozen=True)
class Believed:
    """Limits of a quantity, SI, and the unit in which they are shown."""

    low: float
    high: float
    unit: str

    def __str__(self) -> str:
        """Return the limits with their unit."""
        shown = conversion("temperature", self.unit) if self.unit == "degC" else Conversion("", 1.0, 0.0)
        low, high = ((end - shown.offset) / shown.scale for end in (self.low, self.high))
        return f"{low:g} to {high:g}{f' {self.unit}' if self.unit else ''}"


#: By kind of unit: a reading beyond these limits is none. They are wide: no drive comes near them.
BELIEVED = {
    # bearings of cryogenic pumps run in liquid helium, 4 K; thermocouples K and N end below 1400 degC
    "temperature": Believed(1.0, 1773.15, "degC"),
    # the main shaft of the largest wind turbines carries some 2e7 N m
    "torque": Believed(-1e8, 1e8, "N*m"),
    # the fastest electric motors turn at a million rpm, 1e5 rad/s
    "speed": Believed(-2e5, 2e5, "rad/s"),
    # above the fastest rocket sleds, 3e3 m/s
    "belt speed": Believed(-1e4, 1e4, "m/s"),
    # above the largest forging presses, 8e8 N
    "force": Believed(-1e9, 1e9, "N"),
    # clean metals in vacuum reach 100 before they weld
    "friction coefficient": Believed(-1e3, 1e3, ""),
    # of a radius
    "length": Believed(0.0, 1e3, "m"),
    # stamps that count from the year 1 reach 6.4e10 s
    "time": Believed(-1e11, 1e11, "s"),
}

#: Units of a temperature that a controller keeps as a whole number.
TENTHS = ("0.1 degC", "0.1 K")
#: Least and greatest count of converters and counters of 16 and 32 bits.
_COUNTS = (65535.0, 32767.0, -32768.0, 4294967295.0, 2147483647.0, -2147483648.0)
#: Scales of such counts: loggers store tenths, hundredths and thousandths.
_SCALES = (1.0, 0.1, 0.01, 0.001)
#: What programs write for a missing value.
_FILLERS = (-999.0, -9999.0, -99999.0, -999.9, -999.99, -9999.9, -9999.99, 9999.0, 99999.0, 999999.0)
#: Readings of a sensor that is open, short or not there, degC: the ends of Pt100 and of thermocouples J,
#: N, K, S and B, and that of a digital sensor off its bus.
_NO_SENSOR_DEGC = (850.0, 1200.0, 1300.0, 1372.0, 1768.0, 1820.0, -127.0, -200.0, -242.0, -270.0)
#: Numbers in single precision, or written with seven digits, agree with a code this well.
_SAME = 1e-6
#: A counter that fell below zero shows the uppermost part of its range: this share of it.
_WRAPPED = 0.005

_CODES = np.sort([*(c * s for c in _COUNTS for s in _SCALES), *_FILLERS])
_CODES_DEGC = np.sort(_NO_SENSOR_DEGC)


def in_si(values: FloatArray, unit: Conversion) -> FloatArray:
    """Return numbers as written in SI: NaN where none is finite, and no overflow of one that is."""
    unknown = ~np.isfinite(values)
    missing = bool(unknown.any())
    if unit.scale == 1.0 and unit.offset == 0.0 and not missing:
        return values
    largest = float(np.finfo(float).max)
    with np.errstate(over="ignore", invalid="ignore"):
        converted = values * unit.scale
        converted += unit.offset
    np.clip(converted, -largest, largest, out=converted)  # in place: a channel may fill much of the memory
    if missing:
        converted[unknown] = np.nan
    return converted


def as_written(values: FloatArray, unit: Conversion) -> FloatArray:
    """Return SI numbers in the unit of the file."""
    return np.asarray((values - unit.offset) / unit.scale)


def is_code(values: FloatArray, unit: Conversion, kind: str) -> BoolArray:
    """Return whether SI numbers are, as written, what a logger writes where it has no reading."""
    found = _among(as_written(values, unit), _CODES)
    if kind == "temperature":
        found |= _among(as_written(values, conversion(kind, "degC")), _CODES_DEGC)
    return found


def is_wrapped(values: FloatArray, unit: Conversion) -> BoolArray:
    """Return whether SI numbers are, as written, just below the end of a counter of 16 or 32 bits."""
    written = as_written(values, unit)
    found = np.zeros(written.shape, dtype=bool)
    for bits in (16, 32):
        for scale in _SCALES:
            end = 2.0**bits * scale
            found |= (written > (1.0 - _WRAPPED) * end) & (written < end)
    return found


def _among(values: FloatArray, codes: FloatArray) -> BoolArray:
    above = np.clip(np.searchsorted(codes, values), 0, codes.size - 1)
    near = np.stack([codes[above], codes[np.maximum(above - 1, 0)]])
    return np.asarray(np.any(np.abs(near - values) <= _SAME * np.abs(near), axis=0))
