"""What is asked about a machine and the channels of its log: one table for the terminal and for the app.

Each question is a key of a table of the machine file or of ``hersey.toml``; what can be answered is what
the reader of that file takes, in its words.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from hersey.errors import ParameterError, UnitError
from hersey.files.toml import naming, refuse_value
from hersey.log import role_tables
from hersey.lubrication.lubricant import MODELS
from hersey.machine.limits import Limits, OperatingPoint
from hersey.machine.machine import DrivetrainTable
from hersey.machine.nip import ContactTable, LubricantTable
from hersey.machine.no_load import RestTable
from hersey.machine.rotational import turning_at_radius
from hersey.machine.uncertainty import range_ends, read_uncertainty
from hersey.motion.parameters import KINDS as PARAMETERS
from hersey.schema.noun import TURNING
from hersey.units import KINDS, convert, parse

#: The tables of both files that are asked about.
_TABLES: dict[str, type] = {
    "drivetrain": DrivetrainTable,
    "limits": Limits,
    "contact": ContactTable,
    "lubricant": LubricantTable,
    "rest": RestTable,
    "points": OperatingPoint,
    "torque": role_tables.TorqueMapping,
    "speed": role_tables.SpeedMapping,
    "temperature": role_tables.TemperatureMapping,
    "time": role_tables.TimeMapping,
    "radius": role_tables.RadiusMapping,
    "load": role_tables.LoadMapping,
}
#: What is known of an answer beside its value, written behind it.
_SHARE = re.compile(r"(.*?)\s*(?:±|\+/?-)\s*([0-9.]+\s*%)\s*")
#: What people call a key otherwise.
_CALLED = {"roll_radius": "radius", "roll_friction": "friction", "rubber_thickness": "layer_thickness"}
_BARE = re.compile(r"\s*[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?\s*")


@dataclass(frozen=True)
class Question:
    """One key of a file."""

    section: str  #: its table
    field: str  #: its key
    words: str  #: what it is, for a person who has the machine before them
    example: str  #: an answer
    unit: str = ""  #: in which a bare number of the app's form is meant; empty for a pure number or a text
    letter: str = ""  #: how the sketch calls it, or empty
    needed: bool = False  #: whether its table says nothing without it
    first: bool = False  #: whether it is asked of everyone; the others may be folded
    uncertain: bool = False  #: whether a range, or a share behind the value, is an answer too
    assumed: str = ""  #: what holds for a person who does not know it, or empty

    @property
    def key(self) -> str:
        """Return its name among all questions."""
        return f"{self.section}.{self.field}"

    @property
    def called(self) -> str:
        """Return what a person calls it."""
        return _CALLED.get(self.field, self.field).replace("_", " ")

    @property
    def name(self) -> str:
        """Return what a person calls it, with its letter in the sketch."""
        return f"{self.letter} {self.called}" if self.letter else self.called

    @property
    def bare_example(self) -> str:
        """Return an answer as it stands beside the unit of the app's form."""
        return self.example.replace(f" {self.unit}", "") if self.unit else self.example

    @property
    def is_number(self) -> bool:
        """Whether the file has a bare number there, and no text."""
        return self.example.lstrip("-").replace(".", "", 1).isdigit()

    def with_unit(self, text: str) -> str:
        """Return an answer with the unit that stands beside the field, where it has none of its own."""
        if not self.unit:
            return text
        value, share = _split(text)
        parts = range_ends(value) or (value,)
        listed = " to ".join(
            f"{part.strip()} {self.unit}" if _BARE.fullmatch(part) else part for part in parts
        )
        return f"{listed} ± {share}" if share else listed

    def values(self, text: str) -> dict[str, Any]:
        """Return what stands in the file for an answer, by key: a range is a value and its uncertainty.

        Raises
        ------
        ParameterError, UnitError
            In the words of the reader.
        """
        text = text.strip()
        if not text:
            raise ParameterError(f"{self.field} is empty")
        if self.uncertain:
            return self._uncertain(text)
        if self.field == "viscosities":
            return self._viscosities(text)
        value = _number(text) if self.is_number else text
        if self._turns(text):
            return {self.key: text}  # the radius leads to it when the whole file is read
        refuse_value(_TABLES[self.section], self.field, value)
        return {self.key: value}

    def _uncertain(self, text: str) -> dict[str, Any]:
        value, share = _split(text)
        out: dict[str, Any] = {}
        ends = None if share else range_ends(value)
        if share or ends:
            uncertainty = share or " to ".join(ends or ())
            with naming(self.field):
                known = read_uncertainty(self.field, uncertainty)
            out[f"uncertainty.{self.field}"] = uncertainty
            if known.limits is not None:
                value = _middle(self.field, *known.limits, self.unit)
        if not self._turns(value):
            refuse_value(_TABLES[self.section], self.field, value)
        return {self.key: value, **out}

    def _turns(self, text: str) -> bool:
        """Whether an answer is a rotational quantity."""
        kind = "belt speed" if self.field == "speed" else PARAMETERS.get(self.field)
        return kind is not None and turning_at_radius(kind, text, 1.0) is not None

    def _viscosities(self, text: str) -> dict[str, Any]:
        pairs = [[part.strip() for part in pair.split(":")] for pair in text.split(",")]
        if not all(len(pair) == 2 for pair in pairs):
            raise ParameterError(
                f"viscosities is '{text}'. Write temperature and viscosity, e.g. '{self.example}'"
            )
        kinematic = False
        for hot, thick in pairs:
            with naming("viscosities"):
                parse("temperature", hot)
                try:
                    parse("kinematic viscosity", thick)
                    kinematic = True
                except UnitError:
                    parse("viscosity", thick)
        models = [name for name, points in MODELS.items() if points == len(pairs)]
        if not models:
            raise ParameterError(f"{len(pairs)} points of viscosity are given, but a law needs two or three")
        model = "walther" if kinematic and "walther" in models else models[0]
        return {self.key: pairs, "lubricant.model": model}


def _number(text: str) -> Any:
    try:
        value = float(text)
    except ValueError:
        return text
    whole = value.is_integer() and abs(value) < 1e15 and re.fullmatch(r"[-+]?\d+", text)
    return int(value) if whole else value


def _split(text: str) -> tuple[str, str]:
    """Value, and the share behind it or an empty text."""
    match = _SHARE.fullmatch(text.strip())
    return (match[1], match[2]) if match else (text.strip(), "")


def _middle(field: str, low: float, high: float, unit: str) -> str:
    """The middle of a range in which every order of magnitude is as likely."""
    si, _ = KINDS[str(PARAMETERS[field])]
    return f"{convert(math.sqrt(low * high), si, unit):.4g} {unit}"


#: Stick speed of a drive of which it is not known.
STICK_SPEED = "0.3 mm/s to 3 mm/s"
#: What is asked about the machine, in the order of the file.
MACHINE = (
    Question(
        "drivetrain", "part", "what slides, in one word", "joint", first=True,
    ),
    Question(
        "drivetrain", "stiffness", "stiffness of all that yields, where it slides; or torsional",
        "11 N/mm", "N/mm", "k", needed=True, first=True, uncertain=True,
    ),
    Question(
        "drivetrain", "mass", "all that moves, motor included, where it slides; or moment of inertia",
        "11 kg", "kg", "m", needed=True, first=True, uncertain=True,
    ),
    Question(
        "drivetrain", "roll_radius", "radius of the surface that slides, at which the torque acts",
        "15 mm", "mm", "R", needed=True, first=True,
    ),
    Question(
        "drivetrain", "stick_speed", "it sticks below this; rarely measured, so a range is fine",
        STICK_SPEED, "mm/s", "", needed=True, first=True, uncertain=True, assumed=STICK_SPEED,
    ),
    Question(
        "drivetrain", "stick_speed_temperature",
        "temperature of the stick speed; default: reference temperature of the fit", "180 degC", "degC",
    ),
    Question("limits", "nip_load", "load on the sliding contact", "300 N", "N", "N", first=True),
    Question("limits", "motor_torque", "maximum torque of the motor, after the gears", "1 N*m", "N*m"),
    Question("limits", "roll_friction", "friction coefficient of what moves it, if it slips", "0.6", "", "µ"),
    Question("limits", "acceleration", "maximum of the drive, where it slides", "500 mm/s^2", "mm/s^2"),
    Question("limits", "speed", "maximum of the drive, where it slides", "400 mm/s", "mm/s"),
    Question("contact", "rubber_thickness", "soft layer on the contact", "3.5 mm", "mm", "h", needed=True),
    Question(
        "contact", "modulus", "Young's modulus of the layer, warm", "0.65 MPa", "MPa", "E", needed=True
    ),
    Question("contact", "poisson_ratio", "Poisson's ratio of the layer, up to 0.5", "0.48", needed=True),
    Question("contact", "length", "of the contact, along the axis", "220 mm", "mm", "L", needed=True),
    Question("contact", "roughness", "of both surfaces together, rms", "0.5 um", "um"),
    Question(
        "lubricant", "density", "of the lubricant; a viscosity in mm^2/s needs it", "0.9 g/cm^3", "g/cm^3"
    ),
    Question(
        "lubricant", "viscosities", "two or three points of the data sheet",
        "40 degC: 400 mm^2/s, 100 degC: 40 mm^2/s", needed=True,
    ),
    Question("lubricant", "pressure_viscosity", "pressure-viscosity coefficient", "20 GPa^-1", "GPa^-1"),
    Question(
        "rest", "torque", "no-load torque (without film and contact)",
        "180 mN*m", "mN*m", needed=True,
    ),
)  # fmt: skip

#: What is asked of each operating point.
POINT = (
    Question("points", "name", "name of this operating point", "full speed"),
    Question(
        "points", "speed", "where it slides, or rotational", "200 mm/s", "mm/s", needed=True, first=True
    ),
    Question("points", "temperature", "of the film", "180 degC", "degC", needed=True, first=True),
)

#: What is asked about a log, for ``hersey.toml``.
MAPPING = (
    Question("torque", "channel", "torque channel", "Drive torque", needed=True, first=True),
    Question("torque", "unit", "its unit", "N*m", needed=True, first=True),
    Question("torque", "sign", "-1 flips it", "-1"),
    Question("torque", "gear_ratio", "turns of the sensor shaft per turn of the output shaft", "12.5"),
    Question("torque", "efficiency", "of those gears", "0.9"),
    Question("torque", "tare", "what the sensor shows without load", "4 mN*m", "mN*m"),
    Question("torque", "motor_constant", "if the channel is the motor current", "35 mN*m/A", "mN*m/A"),
    Question("speed", "channel", "speed channel", "Drive speed", needed=True, first=True),
    Question("speed", "unit", "its unit", "rpm", needed=True, first=True),
    Question("speed", "sign", "-1 flips it", "-1"),
    Question("speed", "gear_ratio", "turns of its shaft per turn of the output shaft", "12.5"),
    Question("temperature", "channel", "temperature channel", "Temperature", first=True),
    Question("temperature", "unit", "its unit", "degC", first=True),
    Question("temperature", "offset", "film minus reading", "-1.5 K", "K"),
    Question("temperature", "time_constant", "lag of the sensor", "4 s", "s"),
    Question("time", "channel", "time channel", "Time", first=True),
    Question("time", "unit", "its unit", "s", first=True),
    Question("time", "every", "time between rows, if there is no time channel", "2 ms", "ms"),
    Question("radius", "value", "at which a friction force acts", "25 mm", "mm"),
    Question("load", "value", "normal load; needed for a friction coefficient", "50 N", "N"),
)

#: Titles of the tables, as the files have them above.
TITLES = {
    "drivetrain": "What the log cannot show: the drivetrain. Give every value with its unit.",
    "limits": "Limits of the machine, for the map and for start-up profiles.",
    "contact": "The contact, for the film: a shaft with a soft layer, pressed on.",
    "lubricant": "The lubricant: points of the data sheet.",
    "rest": "No-load torque without film and contact (bearings, gears).",
    "uncertainty": "Uncertainties: a share (95 % of the values lie within it) or a range.",
    "points": "Operating points to judge.",
    "torque": "Channels: name and unit as in the log. The rest describes the path from sensor to output.",
    "speed": "",
    "temperature": "",
    "time": "",
    "radius": "For a friction force in the log: the radius at which it acts.",
    "load": "For a friction coefficient in the log: the normal load.",
}
BY_KEY: Mapping[str, Question] = {q.key: q for q in (*MACHINE, *POINT, *MAPPING)}


#: Key of what slides.
PART = "drivetrain.part"
#: What is asked instead of what turns as a whole: words, example, unit.
_OF_TURNING = {
    "drivetrain.stiffness": ("torsional stiffness of gears and shafts together", "200 N*m/rad", "N*m/rad"),
    "drivetrain.mass": (
        "moment of inertia of all that turns with it; that of the motor times its gear ratio squared",
        "0.01 kg*m^2", "kg*m^2",
    ),
    "drivetrain.roll_radius": (
        "radius at which speeds in mm/s are stated; results in rpm do not depend on it", "50 mm", "mm",
    ),
    "points.speed": ("rotational", "10 rpm", "rpm"),
    "limits.speed": ("maximum of the drive", "60 rpm", "rpm"),
}  # fmt: skip


def asked_of(question: Question, part: str) -> Question:
    """Return the question as it is asked of what slides, in the terms of its machine."""
    if part not in TURNING or question.key not in _OF_TURNING:
        return question
    words, example, unit = _OF_TURNING[question.key]
    return replace(question, words=words, example=example, unit=unit)


def lacking(answered: Mapping[str, str]) -> list[Question]:
    """Return the questions of the machine that the others answered make needed."""
    sections = {key.split(".")[0] for key, text in answered.items() if text.strip()}
    sections |= {"drivetrain"} if sections else set()
    out = [q for q in MACHINE if q.needed and q.section in sections and not answered.get(q.key, "").strip()]
    load = BY_KEY["limits.nip_load"]
    if "contact" in sections and not answered.get(load.key, "").strip():
        out.append(load)
    return out
