"""Bindings of the Rust core (`crates/py`)."""

from collections.abc import Callable, Sequence
from typing import TypeAlias, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "KINDS",
    "MODES",
    "VERSION",
    "Law",
    "band",
    "bands",
    "cycles",
    "simulate",
    "stick_slip",
    "sweep",
]

KINDS: list[str]
MODES: list[str]
VERSION: str

_Floats: TypeAlias = NDArray[np.float64]
_Closure: TypeAlias = tuple[str, float | None, float | None]
_Schedule: TypeAlias = tuple[list[float], list[float], list[list[float]] | None]
_EventRow: TypeAlias = tuple[float, str, str, str, float, float]
_TrajectoryColumns: TypeAlias = tuple[
    _Floats,
    _Floats,
    _Floats,
    NDArray[np.uint8],
    list[_EventRow],
    tuple[float, float, float, float],
    int,
]

@final
class Law:
    def __new__(
        cls,
        transition: tuple[float, float],
        ehl_exponent: float,
        mixed_exponent: float,
        stick_speed: float,
        closure: _Closure,
    ) -> Law: ...
    @staticmethod
    def tabulated(
        speeds: Sequence[float], forces: Sequence[float], stick_speed: float, closure: _Closure
    ) -> Law: ...
    def warmed(self, reference: float, force_exponent: float, speed_exponent: float) -> Law: ...
    def at(self, temperature: float) -> Law: ...
    def force(self, speed: _Floats) -> _Floats: ...
    @property
    def breakaway_force(self) -> float: ...
    @property
    def stick_speed(self) -> float: ...
    @property
    def transition_speed(self) -> float: ...

def simulate(
    train: tuple[float, float],
    drag: Law,
    drive: tuple[str, _Schedule],
    temperature: _Schedule | None,
    start: tuple[float, float],
    duration: float,
    samples: int,
    tolerance: float,
    integrator: str,
) -> _TrajectoryColumns: ...
def stick_slip(
    train: tuple[float, float],
    drag: Law,
    drive_speed: float,
    start: tuple[float, float],
    duration: float | None,
    tolerance: float,
) -> tuple[str, float, float, float, float, float, float, float, float, int]: ...
def sweep(
    parameters: Sequence[_Floats],
    closure: _Closure,
    nudge: float | None,
    duration: float | None,
    tolerance: float,
    threads: int,
    progress: Callable[[int, int], object] | None,
) -> tuple[NDArray[np.uint8], _Floats, NDArray[np.uint32], list[tuple[int, str]]]: ...
def band(
    train: tuple[float, float], drag: Law, tolerance: float
) -> tuple[float, float, float, float, float, float, bool, bool, int]: ...
def bands(
    parameters: Sequence[_Floats],
    closure: _Closure,
    lower: bool,
    tolerance: float,
    threads: int,
    progress: Callable[[int, int], object] | None,
) -> tuple[_Floats, list[tuple[int, str]]]: ...
def cycles(
    parameters: Sequence[_Floats], tolerance: float
) -> tuple[_Floats, _Floats, NDArray[np.uint32]]: ...
