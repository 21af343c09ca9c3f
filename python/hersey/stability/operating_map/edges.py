"""The speeds that divide the behaviour at each temperature, and those at which the drag reaches a force."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import ParameterError
from hersey.motion.drag import Drag
from hersey.motion.simulation import Drivetrain
from hersey.stability.hysteresis import hysteresis_sweep

if TYPE_CHECKING:
    import xarray as xr


def check_temperatures(kelvin: FloatArray, drag: Drag) -> None:
    """Refuse temperatures (K) at which the powers of the law have no meaning."""
    scale = "degC" if drag.temperature_zero else "K"
    wrong = kelvin[~(np.isfinite(kelvin) & (kelvin > drag.temperature_zero))]
    if wrong.size:
        raise ParameterError(
            f"temperature is {float(wrong[0]):g} K: a law in {scale} holds above 0 {scale} only"
        )


def edges_at(train: Drivetrain, drag: Drag, kelvin: FloatArray | None) -> dict[str, FloatArray]:
    """The bands at each temperature; an isothermal drag has one."""
    band = hysteresis_sweep(train, drag, temperature=kelvin)
    require_all(band)
    edges = {name: np.atleast_1d(band[name].values) for name in ("lower", "transition", "upper")}
    # Without a band the three speeds are one, up to the last digit.
    edges["lower"] = np.minimum(edges["lower"], edges["transition"])
    edges["upper"] = np.maximum(edges["upper"], edges["transition"])
    return edges


def require_all(band: xr.Dataset) -> None:
    """Refuse a sweep of bands that lacks one."""
    if band.attrs["failures"]:
        raise ParameterError(f"the bands cannot be computed: {band.attrs['failures'][0]}")


def laws_at(drag: Drag, kelvin: FloatArray | None) -> list[Drag]:
    """Return the drag at each temperature (K), or the one that does not vary."""
    return [drag] if kelvin is None else [drag.at(t) for t in kelvin.tolist()]


def contour(laws: Sequence[Drag], force: float) -> tuple[FloatArray, FloatArray]:
    """Speeds of a force on the falling and the rising branch of each law."""
    below, above = np.array([law.speeds_of(force) for law in laws]).T
    return below, above
