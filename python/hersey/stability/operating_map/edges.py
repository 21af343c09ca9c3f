"""The speeds that divide the behaviour at each temperature, and those at which the drag reaches a force."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import overload

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.surface import FIXED, WITH_TRANSITION
from hersey.errors import ParameterError
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import Drag, DragTable, PowerDrag
from hersey.stability.hysteresis import hysteresis
from hersey.stability.hysteresis_sweep import SweptBands, sweep_bands


@dataclass(frozen=True)
class GivenEdges:
    """Edges of a map that were found elsewhere, at each of its temperatures: speeds in m/s, forces in N.

    Arrays have the shape (n,), intervals (2, n). ``uncertain`` names what the intervals count beside the fit.
    """

    transition: FloatArray
    upper: FloatArray
    holding: FloatArray
    transition_interval: FloatArray
    upper_interval: FloatArray
    holding_interval: FloatArray
    uncertain: tuple[str, ...]


def check_temperatures(kelvin: FloatArray, drag: PowerDrag) -> None:
    """Refuse temperatures (K) at which the powers of the law have no meaning."""
    scale = "degC" if drag.temperature_zero else "K"
    wrong = kelvin[~(np.isfinite(kelvin) & (kelvin > drag.temperature_zero))]
    if wrong.size:
        raise ParameterError(
            f"temperature is {float(wrong[0]):g} K: a law in {scale} holds above 0 {scale} only"
        )


def edges_at(
    train: Drivetrain, drag: Drag, kelvin: FloatArray | None, rule: str = WITH_TRANSITION
) -> dict[str, FloatArray]:
    """The bands at each temperature; an isothermal drag has one."""
    names = ("lower", "transition", "upper")
    if kelvin is not None and rule == FIXED:
        bands = [hysteresis(train, law, sensitivity=False) for law in laws_at(drag, kelvin, rule)]
        edges = {name: np.array([getattr(band, name) for band in bands]) for name in names}
    else:
        band = sweep_bands(train, drag, {}, temperature=kelvin)
        require_all(band)
        edges = {name: np.atleast_1d(band.columns[name]) for name in names}
    # Without a band the three speeds are one, up to the last digit.
    edges["lower"] = np.minimum(edges["lower"], edges["transition"])
    edges["upper"] = np.maximum(edges["upper"], edges["transition"])
    return edges


def require_all(band: SweptBands) -> None:
    """Refuse a sweep of bands that lacks one."""
    if band.failures:
        raise ParameterError(f"the bands cannot be computed: {band.failures[0]}")


@overload
def law_at(drag: Drag, kelvin: float | None, rule: str) -> Drag: ...
@overload
def law_at(drag: PowerDrag, kelvin: float | None, rule: str) -> PowerDrag: ...
def law_at(drag: PowerDrag, kelvin: float | None, rule: str) -> PowerDrag:
    """Return the drag at a temperature (K; None if it does not vary), its stick speed by the rule."""
    law = drag.unwarned().at(kelvin)
    return replace(law, stick_speed=drag.stick_speed) if rule == FIXED else law


@overload
def laws_at(drag: Drag, kelvin: FloatArray | None, rule: str = ...) -> list[Drag]: ...
@overload
def laws_at(drag: PowerDrag, kelvin: FloatArray | None, rule: str = ...) -> list[PowerDrag]: ...
def laws_at(
    drag: PowerDrag, kelvin: FloatArray | None, rule: str = WITH_TRANSITION
) -> list[Drag] | list[PowerDrag]:
    """Return the drag at each temperature (K), or the one that does not vary."""
    return [drag] if kelvin is None else [law_at(drag, t, rule) for t in kelvin.tolist()]


def shown_laws(drag: PowerDrag, kelvin: FloatArray | None, rule: str) -> Sequence[PowerDrag]:
    """Return the drag at each temperature for its torque; that beside given edges moves its stick speed."""
    if isinstance(drag, DragTable):
        return laws_at(drag, kelvin)
    return laws_at(drag, kelvin, rule)


def contour(laws: Sequence[PowerDrag], force: float) -> tuple[FloatArray, FloatArray]:
    """Speeds of a force on the falling and the rising branch of each law."""
    below, above = np.array([law.speeds_of(force) for law in laws]).T
    return below, above
