"""Numbers of a belt on the command line: with units, or bare in one consistent set of units.

Every number that has a dimension goes through `amounts`. Either all given numbers have units or none has,
because a bare number next to "11 N/mm" could be in any unit. A number that is not given comes from the
machine file or, without one, from the paper's baseline, converted if the others have units.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from hersey.cli.figures import three
from hersey.errors import HerseyError, ParameterError, UnitError

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
#: Units in which results of a kind are printed, and how many make one in SI.
_SHOWN = {
    "belt speed": ("mm/s", 1e3),
    "length": ("mm", 1e3),
    "frequency": ("Hz", 1.0),
    "time": ("s", 1.0),
    "force": ("N", 1.0),
    "energy": ("mJ", 1e3),
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
_BARE = "Results are in the units of the numbers given."
_PAPER_UNITS = "Numbers are in inches, ounces of force (ozf) and seconds, as in the baseline"
#: Speeds of the drive, which may be given as those of the roll.
_OF_A_DRIVE = ("drive_speed", "from_speed", "to_speed")
#: Numbers of a belt that a machine file states.
_OF_A_MACHINE = ("stiffness", "mass", "stick_speed")
#: What a number that no machine file states means.
_FROM = {
    "transition_force": "the drag where its branches meet",
    "transition_speed": "where the branches of the drag meet",
}


@dataclass(frozen=True)
class Amounts:
    """Numbers by name, whether they are in SI, and in ``filled`` the source of those not given."""

    values: Mapping[str, float | None]
    in_si: bool
    filled: str = ""

    @property
    def words(self) -> list[str]:
        """The notes to print below a result."""
        return [f"- {text}" for text in (self.filled or ("" if self.in_si else _BARE),) if text]

    def shown(self, value: float, kind: str) -> str:
        """Return a number of a result of a kind: with its unit if numbers have units, else bare."""
        unit, factor = _SHOWN[kind] if self.in_si else ("", 1.0)
        return three(factor * value, unit)

    def shown_range(self, low: float, high: float, kind: str) -> str:
        """Return two numbers of a result in the same way, with their unit once."""
        factor = _SHOWN[kind][1] if self.in_si else 1.0
        return f"{three(factor * low)} to {self.shown(high, kind)}"


def amounts(
    given: Mapping[str, str | None], *, needed: tuple[str, ...], machine_file: Path | None = None
) -> Amounts:
    """Return the numbers that options give as text.

    Parameters
    ----------
    given
        Text of each option, None where it is not given.
    needed
        Names of the numbers that are required.
    machine_file
        Machine file, which states some of them.

    Raises
    ------
    ParameterError, UnitError
        If a number cannot be read, lacks a unit or is missing.
    """
    texts = {name: text for name, text in given.items() if text is not None}
    if machine_file is not None:
        texts = {name: _at_the_belt(name, text, machine_file) for name, text in texts.items()}
    bare = {name: _bare(text) for name, text in texts.items()}
    has_unit = [name for name in texts if bare[name] is None]
    of_any = [name for name in texts if bare[name] is not None and _KINDS[name][0] != "time"]
    if machine_file is None and not [name for name in has_unit if _KINDS[name][0] != "time"]:
        plain, filled = _plain(given, needed)
        return Amounts(plain | {n: _parsed(n, texts[n]) for n in has_unit}, in_si=False, filled=filled)
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
    """Return stiffness, mass, stick speed, grip and no-load torque of a machine file, in SI."""
    from hersey.machine.machine import read_machine

    machine = read_machine(file)
    stated = {name: float(getattr(machine, name)) for name in _OF_A_MACHINE}
    if machine.limits.grip is not None:
        stated["grip"] = machine.limits.grip
    if machine.rest is not None:
        rest = machine.rest.at_the_belt(machine.roll_radius)
        stated |= {name: rest[name] for name in ("rest_force", "rest_damping")}
    return stated


def _at_the_belt(name: str, text: str, machine_file: Path) -> str:
    """A speed of the roll, such as '40 rpm', as that of the belt by the roll radius; else the text."""
    from hersey.cli.quantities import target_of
    from hersey.machine.machine import read_machine

    if not _of_the_roll(name, text):
        return text
    return f"{target_of(text, read_machine(machine_file), _flag(name))!r} m/s"


def _of_the_roll(name: str, text: str) -> bool:
    """Whether a number is a speed of the drive, given as that of the roll."""
    from hersey.units import parse

    try:
        return name in _OF_A_DRIVE and parse("speed", text) is not None
    except HerseyError:
        return False


def _bare(text: str) -> float | None:
    """A number without a unit, or None; any other text is refused when it is parsed."""
    try:
        return float(text)
    except ValueError:
        return None


def _parsed(name: str, text: str) -> float:
    from hersey.units import parse

    kind, example = _KINDS[name]
    if _of_the_roll(name, text):  # without a machine file, for with one it is at the belt by now
        raise UnitError(
            f"{_flag(name)} '{text}' is a rotational speed, but a sliding speed is needed",
            remedy=f"name a machine file with --machine, for its radius, or write e.g. '{example}'",
        )
    if not any(c.isdigit() for c in text):
        raise ParameterError(f"{_flag(name)} is '{text}': write a number with its unit, e.g. '{example}'")
    try:
        return parse(kind, text)
    except UnitError as error:
        raise type(error)(f"{_flag(name)}: {error}") from None


def _flag(name: str) -> str:
    return "--" + name.replace("_", "-")


def _plain(given: Mapping[str, str | None], needed: tuple[str, ...]) -> tuple[dict[str, float | None], str]:
    """Numbers in any consistent set of units, the paper's baseline for the rest, and which those are."""
    lacking = {name: _BASELINE[name] for name in needed if name in _BASELINE and given[name] is None}
    values = {name: lacking.get(name) if text is None else _bare(text) for name, text in given.items()}
    assumed = [
        f"{name.replace('_', ' ')} {three(value, _OF_THE_PAPER[_KINDS[name][0]])}"
        for name, value in lacking.items()
        if name != "duration"
    ]
    return values, f"{_PAPER_UNITS}. Assumed, as not given: {', '.join(assumed)}." if assumed else ""


def _without_unit(name: str, text: str, others: list[str], texts: Mapping[str, str]) -> UnitError:
    beside = f"but {_flag(others[0])} '{texts[others[0]]}' has" if others else "which --machine requires"
    unit = _KINDS[name][1].split(" ", 1)[1]
    return UnitError(f"{_flag(name)} {text} has no unit, {beside}: write '{text} {unit}', for example")


def _with_baseline(values: Mapping[str, float | None], lacking: list[str]) -> Amounts:
    from hersey.units import KINDS, parse

    taken = {}
    for name in lacking:
        kind = _KINDS[name][0]
        taken[name] = parse(kind, f"{_BASELINE[name]!r} {_OF_THE_PAPER[kind]}")
    baseline = []
    for name in (name for name in lacking if name != "duration"):
        kind = _KINDS[name][0]
        unit, factor = _SHOWN.get(kind, (KINDS[kind][0], 1.0))
        baseline.append(f"{name.replace('_', ' ')} {three(factor * taken[name], unit)}")
    filled = f"Not given; using the baseline values: {', '.join(baseline)}." if baseline else ""
    return Amounts({**values, **taken}, in_si=True, filled=filled)


def _with_machine(
    values: Mapping[str, float | None], lacking: list[str], machine: Machine, file: str
) -> Amounts:
    stated = {name: float(getattr(machine, name)) for name in _OF_A_MACHINE if name in lacking}
    stated |= {"duration": _BASELINE["duration"]} if "duration" in lacking else {}
    unknown = [name for name in lacking if name not in stated]
    if unknown:
        *first, last = (f"the {_words(name)}" for name in unknown)
        words = f"{', '.join(first)} and {last}" if first else last
        flags = " ".join(f"{_flag(name)} '{_example(name, machine)}'" for name in unknown)
        raise ParameterError(f"{file} does not state {words}: add {flags}")
    filled = ""
    if "stick_speed" in stated:
        speed = three(1e3 * machine.stick_speed, "mm/s")
        filled = f"The stick speed is {speed} (from {file}), assumed to hold at the temperature of the drag."
    return Amounts({**values, **stated}, in_si=True, filled=filled)


def _example(name: str, machine: Machine) -> str:
    """An amount as an option takes it, the speed of the drive that of the machine's first point."""
    if name == "drive_speed" and machine.points:
        return f"{1e3 * machine.points[0].speed:.4g} mm/s"
    return _KINDS[name][1]


def _words(name: str) -> str:
    words = name.replace("_", " ")
    return f"{words} ({_FROM[name]})" if name in _FROM else words
