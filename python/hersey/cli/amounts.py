"""Numbers of a belt on the command line: with their units, or bare in one consistent set of units.

Every number that has a dimension goes through `amounts`. Either all that are given carry units, or none does:
a bare one beside "11 N/mm" could be meant in any. What is not given comes from the machine's file, or else is
that of the paper's baseline, which is converted where others carry units.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from hersey.errors import ParameterError, UnitError

if TYPE_CHECKING:
    from hersey.machine.machine import Machine

#: Kind of each number, and an example of it for a belt in a fuser.
_KINDS = {
    "stiffness": ("stiffness", "11 N/mm"),
    "mass": ("mass", "11 kg"),
    "transition_force": ("force", "14 N"),
    "transition_speed": ("belt speed", "25 mm/s"),
    "stick_speed": ("belt speed", "0.3 mm/s"),
    "static_force": ("force", "40 N"),
    "bristle_stiffness": ("stiffness", "1000 N/mm"),
    "bristle_damping": ("translational damping", "10 N*s/m"),
    "drive_speed": ("belt speed", "30 mm/s"),
    "from_speed": ("belt speed", "60 mm/s"),
    "to_speed": ("belt speed", "30 mm/s"),
    "duration": ("time", "2 s"),
}
#: The paper's baseline, in inches, ounces of force and seconds; and these units.
_BASELINE = {
    "stiffness": 1000.0,
    "mass": 1.0,
    "transition_force": 50.0,
    "transition_speed": 1.0,
    "stick_speed": 0.01,
    "drive_speed": 1.0,
    "duration": 2.0,
}
_OF_THE_PAPER = {
    "stiffness": "ozf/in",
    "mass": "ozf*s^2/in",
    "force": "ozf",
    "belt speed": "in/s",
    "time": "s",
}
_BARE = "in the units of the numbers given; the defaults are the paper's: inches, ounces of force, seconds"
#: What a machine's file states of a belt.
_OF_A_MACHINE = ("stiffness", "mass", "stick_speed")
#: Where numbers come from that are not stated by a machine.
_FROM = {
    "transition_force": "the drag where its branches meet",
    "transition_speed": "where the branches of the drag meet",
}


@dataclass(frozen=True)
class Amounts:
    """Numbers by name, and whether they are in SI; ``filled`` says where the others are from."""

    values: Mapping[str, float | None]
    in_si: bool
    filled: str = ""

    @property
    def words(self) -> list[str]:
        """What to say of them below a result."""
        units = "in SI: m, s, N, kg" if self.in_si else _BARE
        return [f"- {text}" for text in (units, self.filled) if text]


def amounts(
    given: Mapping[str, str | None], *, needed: tuple[str, ...], machine_file: Path | None = None
) -> Amounts:
    """Return the numbers that options give as text.

    Parameters
    ----------
    given
        Text of each option, None where it is not given.
    needed
        Those without which nothing goes; the others may be missing.
    machine_file
        File of a machine, which states some of them.

    Raises
    ------
    ParameterError, UnitError
        With the option, and what to write.
    """
    texts = {name: text for name, text in given.items() if text is not None}
    bare = {name: _bare(text) for name, text in texts.items()}
    has_unit = [name for name in texts if bare[name] is None]
    of_any = [name for name in texts if bare[name] is not None and _KINDS[name][0] != "time"]
    if machine_file is None and not [name for name in has_unit if _KINDS[name][0] != "time"]:
        return Amounts({**_plain(given, needed), **{n: _parsed(n, texts[n]) for n in has_unit}}, in_si=False)
    if of_any:
        raise _without_unit(of_any[0], texts[of_any[0]], has_unit, texts)
    values: dict[str, float | None] = dict.fromkeys(given)
    values |= {
        name: _parsed(name, text) if bare[name] is None else bare[name] for name, text in texts.items()
    }
    lacking = [name for name in needed if values[name] is None]
    if machine_file is None:
        return _with_baseline(values, lacking)
    from hersey.machine.machine import read_machine

    return _with_machine(values, lacking, read_machine(machine_file), machine_file.name)


def of_a_machine(file: Path) -> dict[str, float]:
    """Return what a machine's file states of a belt, in SI, its roll's grip and its no-load torque."""
    from hersey.machine.machine import read_machine

    machine = read_machine(file)
    stated = {name: float(getattr(machine, name)) for name in _OF_A_MACHINE}
    if machine.limits.grip is not None:
        stated["grip"] = machine.limits.grip
    if machine.rest is not None:
        rest = machine.rest.at_the_belt(machine.roll_radius)
        stated |= {name: rest[name] for name in ("rest_force", "rest_damping")}
    return stated


def _bare(text: str) -> float | None:
    """A number without a unit, or None; what is neither is refused when it is parsed."""
    try:
        return float(text)
    except ValueError:
        return None


def _parsed(name: str, text: str) -> float:
    from hersey.units import parse

    kind, example = _KINDS[name]
    if not any(c.isdigit() for c in text):
        raise ParameterError(f"{_flag(name)} is '{text}': write a number, or one with its unit: '{example}'")
    try:
        return parse(kind, text)
    except UnitError as error:
        raise type(error)(f"{_flag(name)}: {error}") from None


def _flag(name: str) -> str:
    return "--" + name.replace("_", "-")


def _plain(given: Mapping[str, str | None], needed: tuple[str, ...]) -> dict[str, float | None]:
    """Numbers in any consistent set of units, and the paper's baseline for the rest."""
    baseline = {name: _BASELINE[name] for name in needed if name in _BASELINE}
    return {name: baseline.get(name) if text is None else _bare(text) for name, text in given.items()}


def _without_unit(name: str, text: str, others: list[str], texts: Mapping[str, str]) -> UnitError:
    beside = f"beside {_flag(others[0])} '{texts[others[0]]}'" if others else "beside --machine"
    unit = _KINDS[name][1].split(" ", 1)[1]
    return UnitError(f"{_flag(name)} {text} has no unit {beside}: write it with one, as '{text} {unit}'")


def _with_baseline(values: Mapping[str, float | None], lacking: list[str]) -> Amounts:
    from hersey.units import KINDS, parse

    taken = {}
    for name in lacking:
        kind = _KINDS[name][0]
        taken[name] = parse(kind, f"{_BASELINE[name]!r} {_OF_THE_PAPER[kind]}")
    baseline = [
        f"{n.replace('_', ' ')} {taken[n]:.4g} {KINDS[_KINDS[n][0]][0]}" for n in lacking if n != "duration"
    ]
    filled = f"not given, so that of the paper's baseline: {', '.join(baseline)}" if baseline else ""
    return Amounts({**values, **taken}, in_si=True, filled=filled)


def _with_machine(
    values: Mapping[str, float | None], lacking: list[str], machine: Machine, file: str
) -> Amounts:
    stated = {name: float(getattr(machine, name)) for name in _OF_A_MACHINE if name in lacking}
    stated |= {"duration": _BASELINE["duration"]} if "duration" in lacking else {}
    for name in lacking:
        if name in stated:
            continue
        example = _KINDS[name][1]
        if name == "drive_speed" and machine.points:
            example = f"{1e3 * machine.points[0].speed:.4g} mm/s"
        raise ParameterError(f"{file} does not state the {_words(name)}: add {_flag(name)} '{example}'")
    filled = ""
    if "stick_speed" in stated:
        speed = f"{1e3 * machine.stick_speed:.4g} mm/s"
        filled = f"stick speed {speed} as {file} has it: taken for that at the temperature of the drag given"
    return Amounts({**values, **stated}, in_si=True, filled=filled)


def _words(name: str) -> str:
    words = name.replace("_", " ")
    return f"{words} ({_FROM[name]})" if name in _FROM else words
