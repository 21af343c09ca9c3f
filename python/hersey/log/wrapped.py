"""Negative counts that were logged without a sign: in two's complement of 16 or 32 bits."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.log.long_arrays import blocks, each_block
from hersey.schema.warning import Warning

#: Kind of the warning.
READ_AS_NEGATIVE = "counts read as negative"
#: Roles of columns that may hold such counts.
COUNTED = ("torque", "speed", "position")
#: No count lies between these shares of the range: numbers that run through it are none below zero.
_FROM, _TO = 0.25, 0.75
#: Signals that pass zero come this near to both ends, as a share of the range: 65,000 rpm are a speed.
_NEAR = 0.005
#: Fewest distinct counts above; one alone may be a code of the logger.
_FEWEST = 3
#: How near to a whole number a count is, after a unit has multiplied it.
_WHOLE = 1e-3


def with_signs(values: FloatArray, scale: float, channel: str) -> tuple[FloatArray, tuple[Warning, ...]]:
    """Return numbers, ``scale`` times those as written, with the signs that they have lost, and a warning.

    Numbers of which it is not beyond doubt that they are such counts stay as they are.
    """
    if not (bits := _bits(values, scale)):
        return values, ()
    full, count = scale * 2.0**bits, 0

    def signed(part: FloatArray) -> FloatArray:
        nonlocal count
        lost = part / scale >= 2.0 ** (bits - 1)
        count += int(lost.sum())
        return np.where(lost, part - full, part)

    values = each_block(signed, values)
    return values, (
        Warning(
            READ_AS_NEGATIVE,
            "{count} numbers of '{channel}' were logged without their sign, as counts of {bits} bits, and "
            "are read as negative ({before:.0f} is -1)",
            severity="watch",
            channel=channel,
            count=count,
            bits=bits,
            before=2.0**bits - 1.0,
        ),
    )


def _bits(values: FloatArray, scale: float) -> int:
    """How many bits counts have that lost their sign; 0 if not all numbers surely are such counts."""
    ends = [_ends(values[block], scale) for block in blocks(values.size, values)]
    least, most = min((low for low, _ in ends), default=0.0), max((high for _, high in ends), default=0.0)
    bits = next((bits for bits in (16, 32) if (1.0 - _NEAR) * 2.0**bits <= most < 2.0**bits), 0)
    if bits == 16 and least > _NEAR * 2.0**bits:
        return 0
    above: set[float] = set()
    for block in blocks(values.size, values) if bits else ():
        part = values[block]
        part = part[np.isfinite(part)] / scale
        share = part / 2.0**bits
        between = (share >= _FROM) & (share < _TO)
        if np.any(between | (share < 0.0)) or np.any(np.abs(part - np.rint(part)) > _WHOLE):
            return 0
        if len(above) < _FEWEST:
            above |= set(np.unique(np.rint(part[share >= _TO]))[:_FEWEST].tolist())
    return bits if len(above) >= _FEWEST else 0


def _ends(part: FloatArray, scale: float) -> tuple[float, float]:
    """The least and the greatest number of a part, as written, that are not missing."""
    with np.errstate(over="ignore"):
        known = part[np.isfinite(part)] / scale
    return float(np.min(known, initial=np.inf)), float(np.max(known, initial=-np.inf))
