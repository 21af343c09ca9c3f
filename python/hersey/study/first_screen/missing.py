"""What would let the report say more: lines ready to copy, and the file they belong to."""

from __future__ import annotations

import math

from hersey.damping.surface import DampingSurface
from hersey.files.toml import quoted
from hersey.log.constant_temperature import EXCLUDED
from hersey.machine.machine import Machine
from hersey.schema.noun import BELT, DRIVE, Noun
from hersey.study.findings import Findings
from hersey.study.first_screen.result import MissingPart
from hersey.units import celsius, rpm

_MACHINE = "machine.toml"
_MAPPING = "hersey.toml"


def missing(known: Findings) -> list[MissingPart]:
    """Return what is not stated, what most is missing first."""
    points, surface, machine = known.points, known.surface, known.machine
    part = DRIVE if machine is None else machine.part
    if not points.domain.is_torque:  # friction alone is about no machine
        return [] if points.log.has_temperature else _of_lubricant(known)
    file = _MACHINE if known.machine_file is None else known.machine_file.name
    out = []
    if machine is None:
        out.append(_drivetrain(file))
    if not points.log.has_temperature:
        out.append(_temperature(known))
    if machine is None or not machine.points:
        out.append(_points(file, surface, machine))
    if machine is None or (machine.limits.motor_torque is None and machine.limits.grip is None):
        out.append(_limits(file, machine))
    elif machine.limits.grip is None and part == BELT:
        out.append(_grip(file, machine))
    if machine is not None and "stick_speed" not in machine.uncertainty:
        out.append(_stick_speed(file, machine))
    if machine is not None and part == BELT and (machine.contact is None or machine.lubricant is None):
        out.append(_nip(file, machine))
    if machine is not None and points.rest is None:
        out.append(_rest(file, part))
    return out


def _table(name: str, stated: bool) -> str:
    """The head of a table; one that the file has already takes the lines as they are."""
    return f"# add to the existing table [{name}]:\n" if stated else f"[{name}]\n"


def _drivetrain(file: str) -> MissingPart:
    return MissingPart(
        purpose=(
            "the drive speed above which it slides from any start (V*), the map, and the start-up profile"
        ),
        file=file,
        lines=(
            "[drivetrain]\n"
            'part = "drive"               # enter yours: what slides, e.g. joint, shaft, seal, pad\n'
            'stiffness = "200 N*m/rad"    # enter yours: gears and shafts together; or e.g. "11 N/mm"\n'
            'mass = "0.01 kg*m^2"         # enter yours: all that moves, motor included; or e.g. "11 kg"\n'
            'roll_radius = "15 mm"        # enter yours: radius of the surface that slides\n'
            'stick_speed = "1 mm/s"       # enter yours: it sticks below; results depend on it\n'
            "\n"
            "[uncertainty]\n"
            'stick_speed = "0.3 mm/s to 3 mm/s"   # enter yours, until it is measured\n'
        ),
    )


def _temperature(
    known: Findings,
    channel: str = '"Heater"   # enter yours: the temperature column of the log',
    unit: str = "degC",
) -> MissingPart:
    changes = "the transition moves" if known.friction is None else "friction changes"
    return MissingPart(
        purpose=f"how {changes} with temperature",
        file=_MAPPING,
        lines=f"[temperature]\nchannel = {channel}\nunit = {quoted(unit)}\n",
    )


def _of_lubricant(known: Findings) -> list[MissingPart]:
    """The temperature of a log of friction that was read without one: none is proposed if it has none."""
    found = [w.values for file in known.points.log.files for w in file.warnings if w.kind == EXCLUDED]
    if not found:
        return []
    return [_temperature(known, quoted(str(found[0]["column"])), str(found[0]["unit"]))]


def _points(file: str, surface: DampingSurface, machine: Machine | None) -> MissingPart:
    hot = surface.temperature_range
    level = f"{celsius(hot[1]):.0f} degC" if hot else "25 degC"
    middle = math.sqrt(surface.speed_range[0] * surface.speed_range[1])
    speed = f"{1e3 * middle * machine.roll_radius:.3g} mm/s" if machine else f"{rpm(middle):.3g} rpm"
    note = "enter yours" if machine else f"enter yours, where it slides; the middle of the log is {speed}"
    stated = speed if machine else "100 mm/s"
    return MissingPart(
        purpose="what happens at your speeds, and the start-up profile for them",
        file=file,
        lines=(
            "[[points]]\n"
            'name = "today"\n'
            f'speed = "{stated}"   # {note}\n'
            f'temperature = "{level}"   # enter yours\n'
        ),
    )


def _limits(file: str, machine: Machine | None) -> MissingPart:
    stated = {} if machine is None else {k: v for k, v in vars(machine.limits).items() if v is not None}
    rows = {
        "motor_torque": 'motor_torque = "1 N*m"         # enter yours: maximum, after the gears\n',
        "roll_friction": "roll_friction = 0.6            # enter yours: friction of the belt on the roll\n",
        "nip_load": 'nip_load = "300 N"             # enter yours\n',
        "acceleration": 'acceleration = "500 mm/s^2"    # enter yours: maximum, where it slides\n',
        "speed": 'speed = "400 mm/s"             # enter yours: maximum, where it slides\n',
    }
    of_grip = () if machine is not None and machine.part == BELT else ("roll_friction", "nip_load")
    lines = "".join(row for name, row in rows.items() if name not in stated and name not in of_grip)
    return MissingPart(
        purpose="whether the drive starts from rest, and a start-up profile that it can follow",
        file=file,
        lines=f"{_table('limits', bool(stated))}{lines}",
    )


def _grip(file: str, machine: Machine) -> MissingPart:
    return MissingPart(
        purpose="whether the roll slips on the belt at the start",
        file=file,
        lines=(
            f"{_table('limits', True)}roll_friction = 0.6   # enter yours: friction of the belt on the roll\n"
            + ("" if machine.limits.nip_load is not None else 'nip_load = "300 N"    # enter yours\n')
        ),
    )


def _stick_speed(file: str, machine: Machine) -> MissingPart:
    low, high = (f"{1e3 * machine.stick_speed * by:.2g} mm/s" for by in (1 / 3, 3))
    return MissingPart(
        purpose="the full interval of V*, which does not yet include the uncertain stick speed",
        file=file,
        lines=(
            f"{_table('uncertainty', bool(machine.uncertainty))}"
            f'stick_speed = "{low} to {high}"   # enter yours\n'
        ),
    )


def _nip(file: str, machine: Machine) -> MissingPart:
    contact = (
        "[contact]\n"
        'rubber_thickness = "3.5 mm"   # enter yours, all of them\n'
        'modulus = "0.65 MPa"\n'
        "poisson_ratio = 0.48\n"
        'length = "220 mm"\n'
        'roughness = "0.5 um"\n'
    )
    contact += "" if machine.limits.nip_load is not None else 'load = "300 N"\n'
    lubricant = (
        "[lubricant]\n"
        'model = "walther"             # enter yours: two points of the data sheet\n'
        'viscosities = [["40 degC", "500 mm^2/s"], ["200 degC", "7.2 mm^2/s"]]\n'
        'density = "1.9 g/cm^3"\n'
    )
    parts = [contact] if machine.contact is None else []
    parts += [lubricant] if machine.lubricant is None else []
    return MissingPart(
        purpose="whether a film in this nip explains the exponent, and how thick it is",
        file=file,
        lines="\n".join(parts),
    )


def _rest(file: str, part: Noun) -> MissingPart:
    without = "belt and heater" if part == BELT else "the contact that slides"
    return MissingPart(
        purpose="the torque of the film alone, without bearings and gears",
        file=file,
        lines=f'[rest]\nlog = "no-load.csv"   # enter yours: a log of the drive without {without}\n',
    )
