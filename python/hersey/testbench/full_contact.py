"""The torque of the contact of examples/machine.toml from a full numerical solution.

No law of film or share has part in it. ``benchmarks/mixed`` solved Reynolds' equation, the elastic layer and
the asperities together at every node (see benchmarks/MIXED.md). Its table is beside this file: films over
roughness, share of the asperities and both parts of the film's force, N per m of length, against viscosity
times belt speed. So a log made with it tests the laws that are fitted to it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from hersey.arrays import FloatArray

#: The table, and its columns.
TABLE = Path(__file__).with_suffix(".csv")
COLUMNS = ("eta U (Pa m)", "lambda", "minimum", "share", "shear (N/m)", "pressure (N/m)")


@dataclass(frozen=True)
class FullContact:
    """Share of the asperities and force of the film against ln of viscosity times belt speed (Pa m).

    ``share`` is a cubic spline of ln(s/(1-s)), ``film`` one of ln(N/m). Beyond the table both go on
    straight: asperities carry all at rest and nothing in a thick film.
    """

    share: CubicSpline
    film: CubicSpline

    def force(self, product: FloatArray, friction: FloatArray, load: float, length: float) -> FloatArray:
        """Return the force on the belt, N, at viscosity times belt speed (Pa m, above 0).

        ``friction`` is that of the asperities, ``load`` in N, ``length`` of the nip in m.
        """
        at = np.log(product)
        share = 1.0 / (1.0 + np.exp(-_straight(self.share, at)))
        film = np.exp(_straight(self.film, at))
        return np.asarray(friction * load * share + length * film)


def _straight(spline: CubicSpline, at: FloatArray) -> FloatArray:
    """Return a spline, beyond its ends on its tangents."""
    inside = np.clip(at, spline.x[0], spline.x[-1])
    return np.asarray(spline(inside) + (at - inside) * spline(inside, 1))


@cache
def full_contact() -> FullContact:
    """Return the contact of the table."""
    product, _, _, share, shear, pressure = np.loadtxt(TABLE, delimiter=",", skiprows=1).T
    at = np.log(product)
    touching = share > 1e-9
    return FullContact(
        share=CubicSpline(at[touching], np.log(share[touching] / (1.0 - share[touching]))),
        film=CubicSpline(at, np.log(shear + pressure)),
    )
