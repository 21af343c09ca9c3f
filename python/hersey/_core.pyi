"""Bindings of the Rust core (`crates/py`)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

__all__ = ["MODES", "VERSION", "breakaway_force", "drag_force", "simulate", "stick_slip"]

MODES: list[str]
VERSION: str

def drag_force(
    drag: tuple[float, float, float, float, float, str], speed: Sequence[float]
) -> NDArray[np.float64]: ...
def breakaway_force(drag: tuple[float, float, float, float, float, str]) -> float: ...
def simulate(
    train: tuple[float, float],
    drag: tuple[float, float, float, float, float, str],
    drive_speed: float,
    start: tuple[float, float],
    duration: float,
    samples: int,
    tolerance: float,
) -> tuple[
    NDArray[np.float64],
    NDArray[np.float64],
    NDArray[np.float64],
    NDArray[np.uint8],
    list[tuple[float, str, str, str, float, float]],
]: ...
def stick_slip(
    train: tuple[float, float],
    drag: tuple[float, float, float, float, float, str],
    drive_speed: float,
    start: tuple[float, float],
    tolerance: float,
) -> tuple[str, float, float, float, float, float, float, float, int]: ...
