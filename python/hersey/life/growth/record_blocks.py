"""A continuous record as a few values with their errors: what a growth law can be fitted to.

Neighbouring samples of a record wander together, so that a fit to all of them would be far too sure. The
record is cut into as many blocks of equal length as are independent of each other; each gives a mean, and its
error from the autocorrelation within.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from hersey.arrays import FloatArray, numbers_of
from hersey.damping.dwells.noise import mean_and_error
from hersey.errors import InsufficientDataError, ParameterError

#: Numbers of blocks that are tried, and samples that a block must have.
_COUNTS = (60, 50, 40, 30, 24, 20, 16, 12)
_LEAST = 10
#: Second differences of white noise have this correlation of neighbours; times the square root of the number
#: of blocks, how far chance takes it above in one of twenty.
_WHITE, _CHANCE = -2.0 / 3.0, 1.3


@dataclass(frozen=True)
class Blocks:
    """Means of blocks of a record: ages, values, relative standard errors; whether they are independent."""

    age: FloatArray
    value: FloatArray
    error: FloatArray
    independent: bool


def blocks_of_record(age: ArrayLike, value: ArrayLike) -> Blocks:
    """Return a record as the finest blocks that chance alone sets apart from a smooth course.

    Second differences of the means take any smooth course off; where the means are independent, neighbouring
    ones of these correlate by -2/3. If not even a dozen blocks are, a dozen are given, and
    ``independent`` is false: then a law that is named of them may be named too soon.

    Parameters
    ----------
    age
        Ascending, in any unit (also a distance, or a number of turns); shape (samples,).
    value
        Positive on the whole; shape (samples,).

    Raises
    ------
    ParameterError
        If the two do not fit together, an age does not ascend, or a number is none.
    InsufficientDataError
        If there are too few samples for a dozen blocks, or a mean is not positive.

    Examples
    --------
    >>> import numpy as np
    >>> noise = np.random.default_rng(1).normal(0.0, 0.02, 3000)
    >>> blocks_of_record(np.arange(3000.0), 1.0 + noise).value.size
    60
    """
    ages, values = numbers_of("age", age), numbers_of("value", value)
    if ages.ndim != 1 or ages.shape != values.shape:
        raise ParameterError(f"age {ages.shape} and value {values.shape} must be lists of equal length")
    for name, column in (("age", ages), ("value", values)):
        for i in np.flatnonzero(~np.isfinite(column)):
            raise ParameterError(f"{name} of sample {i + 1} is not a number. Remove it", index=int(i))
    for i in np.flatnonzero(np.diff(ages) < 0.0):
        raise ParameterError(
            f"age of sample {i + 2} is below that of the sample before. Sort the record", index=int(i) + 1
        )
    if ages.size < _LEAST * _COUNTS[-1]:
        raise InsufficientDataError(
            f"{ages.size} samples are too few for {_COUNTS[-1]} blocks of {_LEAST}. Record more, or "
            "give them as runs with their own errors"
        )
    fine = [count for count in _COUNTS if ages.size >= _LEAST * count]
    for count in fine:
        found = _cut(ages, values, count)
        if found.independent:
            break
    return found


def _cut(age: FloatArray, value: FloatArray, count: int) -> Blocks:
    parts = np.array_split(np.arange(age.size), count)
    means = np.array([mean_and_error(value[part])[:2] for part in parts])
    if means[:, 0].min() <= 0.0:
        raise InsufficientDataError(
            "the mean of a block is not positive. Remove stretches where the drive stood or the zero "
            "was recorded"
        )
    bends = np.diff(means[:, 0], 2)
    power = float(bends @ bends)
    together = float(bends[1:] @ bends[:-1]) / power if power > 0.0 else _WHITE
    return Blocks(
        np.array([age[part].mean() for part in parts]),
        means[:, 0],
        means[:, 1] / means[:, 0],
        together <= _WHITE + _CHANCE / np.sqrt(count),
    )
