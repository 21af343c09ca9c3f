"""White noise, by medians that spikes and steps do not move."""

from __future__ import annotations

import numpy as np

#: Median of the magnitude of normal noise whose standard deviation is 1.
MEDIAN_MAGNITUDE = 0.6745
#: The same of its second differences, which have six times the variance.
BEND_OF_NOISE = MEDIAN_MAGNITUDE * np.sqrt(6.0)
