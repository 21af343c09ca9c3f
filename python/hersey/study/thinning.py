"""Fewer samples to draw, the extremes among them."""

from __future__ import annotations

import numpy as np
from tsdownsample import MinMaxDownsampler

from hersey.arrays import FloatArray, IntArray


def kept(values: FloatArray, points: int, known: FloatArray | None = None) -> IntArray:
    """Return the indices of about so many samples: the least and the greatest of each stretch, and the ends.

    Samples that are not finite are excluded, and those where ``known`` is not.
    """
    finite = np.isfinite(values) if known is None else np.isfinite(values) & np.isfinite(known)
    good = np.flatnonzero(finite)
    if good.size <= points:
        return good
    chosen = MinMaxDownsampler().downsample(np.ascontiguousarray(values[good]), n_out=points - points % 2)
    return np.asarray(good[np.union1d(chosen.astype(np.intp), [0, good.size - 1])])
