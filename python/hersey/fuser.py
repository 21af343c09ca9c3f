"""`fuser.toml`: what the log cannot tell, each value with its unit."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

from hersey.errors import MissingFileError, ParameterError, UnitError
from hersey.motion import Drivetrain
from hersey.units import KINDS, parse

#: Kind of unit, least and greatest value that a sliding drive could have, in SI.
_DRIVETRAIN = {
    "stiffness": ("stiffness", 1.0, 1e10),
    "mass": ("mass", 1e-6, 1e6),
    "roll_radius": ("length", 1e-5, 100.0),
    "stick_speed": ("belt speed", 1e-9, 10.0),
}


@dataclass(frozen=True)
class Fuser:
    """Drivetrain of the machine, in SI.

    ``stiffness`` (N/m) and ``mass`` (kg) at the belt, ``roll_radius`` (m) at which torque acts on it, and
    ``stick_speed`` (m/s) below which the belt sticks.
    """

    stiffness: float
    mass: float
    roll_radius: float
    stick_speed: float

    @property
    def train(self) -> Drivetrain:
        """The drivetrain of the motion."""
        return Drivetrain(self.stiffness, self.mass)


def read_fuser(path: str | Path) -> Fuser:
    """Read ``[drivetrain]`` of a TOML file; every value is a string such as ``"11 N/mm"``.

    Raises
    ------
    MissingFileError, ParameterError, UnitError
        Each names the file and the key.
    """
    path = Path(path)
    try:
        if path.exists() and not path.is_file():
            raise MissingFileError(f"{path} is no ordinary file")
        document = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except MissingFileError:
        raise
    except FileNotFoundError:
        raise MissingFileError(f"{path}: there is no such file") from None
    except OSError as error:
        raise MissingFileError(f"{path} cannot be read: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise ParameterError(f"{path.name} is not valid TOML: {error}") from None
    table = document.get("drivetrain")
    if not isinstance(table, dict):
        raise ParameterError(f"{path.name}: there is no table [drivetrain]")
    unknown = set(table) - set(_DRIVETRAIN)
    if unknown:
        raise ParameterError(f"{path.name}: [drivetrain] has no key '{min(unknown)}'")
    return Fuser(**{key: _value(path.name, table, key, *kind) for key, kind in _DRIVETRAIN.items()})


def _value(file: str, table: dict[str, object], key: str, kind: str, low: float, high: float) -> float:
    text = table.get(key)
    if text is None:
        raise ParameterError(f"{file}: [drivetrain] lacks '{key}'")
    if not isinstance(text, str):
        raise UnitError(f"{file}: drivetrain.{key} is {text}: write a string with its unit")
    try:
        value = parse(kind, text)
    except UnitError as error:
        raise UnitError(f"{file}: drivetrain.{key}: {error}") from None
    if not value > 0:
        raise ParameterError(f"{file}: drivetrain.{key} is {text}: it must be greater than 0")
    if not low <= value <= high:
        si = KINDS[kind][0]
        raise ParameterError(f"{file}: drivetrain.{key} is {text}: {low:g} to {high:g} {si} is believed")
    return value
