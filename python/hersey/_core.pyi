"""Bindings of the Rust core (`crates/py`)."""

from collections.abc import Callable, Sequence
from typing import TypeAlias, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "FILM_CONSTANTS",
    "FILM_SPEED_EXPONENTS",
    "GAS_CONSTANT",
    "KINDS",
    "MODES",
    "NIP_RATIO_RANGE",
    "REGIMES",
    "VERSION",
    "Law",
    "ViscosityLaw",
    "band",
    "bands",
    "carreau",
    "cycles",
    "effective_modulus",
    "elliptic_film",
    "ellipticity",
    "hertz",
    "inlet_heating",
    "inlet_length",
    "layer",
    "layer_factor",
    "line_contact",
    "line_film",
    "paper",
    "reduced_radius",
    "shear_heating",
    "shear_thinning",
    "shore_a_modulus",
    "simulate",
    "starvation",
    "stick_slip",
    "sweep",
]

FILM_CONSTANTS: list[tuple[float, float]]
FILM_SPEED_EXPONENTS: list[float]
GAS_CONSTANT: float
KINDS: list[str]
MODES: list[str]
NIP_RATIO_RANGE: tuple[float, float]
REGIMES: list[str]
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

@final
class ViscosityLaw:
    @staticmethod
    def arrhenius(points: Sequence[tuple[float, float]]) -> ViscosityLaw: ...
    @staticmethod
    def vogel(points: Sequence[tuple[float, float]]) -> ViscosityLaw: ...
    @staticmethod
    def walther(points: Sequence[tuple[float, float]], density: float) -> ViscosityLaw: ...
    def at(self, temperature: _Floats) -> _Floats: ...
    @property
    def coefficients(self) -> list[tuple[str, float]]: ...

def carreau(columns: Sequence[_Floats]) -> _Floats: ...
def effective_modulus(one: tuple[float, float], other: tuple[float, float]) -> float: ...
def elliptic_film(columns: Sequence[_Floats]) -> _Floats: ...
def ellipticity(along: float, across: float) -> float: ...
def hertz(columns: Sequence[_Floats], line: bool) -> _Floats: ...
def inlet_heating(columns: Sequence[_Floats]) -> _Floats: ...
def inlet_length(columns: Sequence[_Floats]) -> _Floats: ...
def layer(columns: Sequence[_Floats]) -> _Floats: ...
def layer_factor(edge: float, width: float) -> float: ...
def line_film(columns: Sequence[_Floats]) -> _Floats: ...
def paper(equation: int, columns: Sequence[_Floats]) -> _Floats: ...
def reduced_radius(one: float, other: float) -> float: ...
def shear_heating(columns: Sequence[_Floats]) -> _Floats: ...
def shear_thinning(columns: Sequence[_Floats]) -> _Floats: ...
def shore_a_modulus(hardness: float) -> float: ...
def starvation(columns: Sequence[_Floats]) -> _Floats: ...
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
def line_contact(
    roll: tuple[float, float, float],
    layer: tuple[float, float] | None,
    speeds: tuple[float, float],
    fluid: tuple[float, float, str, bool],
    nodes: int,
) -> tuple[list[_Floats], list[float], list[float], list[float], tuple[int, int]]: ...
