"""The law of a soft mixed contact of docs/theory/mixed.md, with adaptive quadrature and a bracket."""

from __future__ import annotations

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

_PEAK = (1.5, 4 / np.pi)


def integral(lam: float, power: float = 2.5) -> float:
    """Return int_lam^inf (z - lam)^power phi(z) dz."""

    def integrand(z: float) -> float:
        return float((z - lam) ** power * np.exp(-0.5 * z * z) / np.sqrt(2 * np.pi))

    return float(quad(integrand, lam, lam + 12, epsabs=0, epsrel=1e-12, limit=200)[0])


def solved(free: float, length_ratio: float, stiffness: float, roundness: float) -> tuple[float, float]:
    """Return lambda and the share of the asperities.

    ``free`` is lambda of the film alone, ``length_ratio`` mean pressure over K sqrt(l) at this speed.
    """
    k = roundness
    peak = _PEAK[0] - (_PEAK[0] - _PEAK[1]) * k

    def left(lam: float) -> float:
        pressure = stiffness * integral(lam)
        if not pressure:
            return lam - free
        root = np.sqrt(k**2 + 4 * (1 - k) * (pressure / peak) ** 2)
        slope = np.sqrt(max(1 - (root - k) / (2 * (1 - k)), 1e-30)) * root / k
        steepness = 2.5 * lam * integral(lam, 1.5) / integral(lam)
        a = length_ratio * pressure
        raised = (1 + (3.89 * a / (slope * (steepness + 2.84))) ** 1.34) ** (0.5 / 1.34)
        return float(lam - free * raised)

    dry = brentq(lambda lam: stiffness * integral(lam) - peak, 0.0, 9.0, xtol=1e-15, rtol=1e-15)
    lam = brentq(left, dry * (1 + 1e-13), max(20.0, 2 * free), xtol=1e-15, rtol=1e-14)
    return lam, 1 - (1 - stiffness * integral(lam) / peak) ** peak
