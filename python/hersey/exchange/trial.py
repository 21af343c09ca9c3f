"""A unit tried before it is handed on: validated by FMPy, and run by it beside the core."""

from __future__ import annotations

from contextlib import redirect_stdout
from dataclasses import dataclass
from importlib import import_module
from io import StringIO
from typing import Any

import numpy as np

from hersey.errors import ParameterError
from hersey.exchange.unit import ROTATIONAL, ExportedUnit
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import AnyDrag
from hersey.motion.simulation import simulate
from hersey.motion.trajectory import Trajectory

#: How far unit and core may differ, as a share of the greatest value.
AGREEMENT = 1e-9
#: Quantities compared.
COMPARED = ("belt_speed", "spring_force")
#: Communication steps of the run.
_STEPS = 200
#: Its length over the time in which the belt swings by a radian.
_SWINGS = 40.0
#: Its length where no spring holds the belt, s.
_FREE = 0.2
#: Torque of the run over that which just starts a belt at rest.
_OVER = 1.2


@dataclass(frozen=True)
class Trial:
    """What a trial found: problems in FMPy's words, and the greatest differences from the core, by quantity.

    Differences are shares of the greatest value; ``events`` are the changes of mode in the run.
    """

    problems: tuple[str, ...]
    differences: dict[str, float]
    events: int

    @property
    def ok(self) -> bool:
        """Whether nothing was found."""
        return not self.problems and all(gap <= AGREEMENT for gap in self.differences.values())

    def summary(self) -> str:
        """Return it in words."""
        if self.problems:
            return "\n".join(["FMPy reports an invalid FMU:", *(f"- {each}" for each in self.problems)])
        said = ", ".join(f"{gap:.1e} in {name.replace('_', ' ')}" for name, gap in self.differences.items())
        verdict = "its results agree with hersey" if self.ok else "its results DIFFER from hersey"
        return f"FMPy reports a valid FMU; {verdict} ({said}, over {self.events} changes of mode)"


def try_unit(unit: ExportedUnit, train: Drivetrain, drag: AnyDrag) -> Trial:
    """Validate a unit and run it in FMPy beside the core, at a drive that makes it move.

    Parameters
    ----------
    unit
        As `export_fmu` returned it.
    train, drag
        What it was made of.

    Raises
    ------
    ParameterError
        If FMPy is not installed.
    """
    fmpy = _fmpy()
    found = import_module("fmpy.validation").validate_fmu(str(unit.path))
    problems = tuple(" ".join(str(each).split()) for each in found)
    if problems:
        return Trial(problems, {}, 0)
    temperature = unit.starts.get("temperature")
    radius = unit.starts.get("roll_radius", 1.0)
    law = drag.law_at(temperature)
    value = law.transition_speed if unit.drive == "speed" else _OVER * law.holding_force * radius
    duration = _SWINGS * float(np.sqrt(train.mass / train.stiffness)) if train.stiffness > 0 else _FREE
    run = simulate(
        train,
        drag,
        drive_speed=value if unit.drive == "speed" else None,
        drive_torque=value / radius if unit.drive == "torque" else None,
        temperature=temperature,
        duration=duration,
        samples=_STEPS + 1,
        tolerance=unit.starts["tolerance"],
        start=_start(unit),
    )
    try:
        # FMPy prints what a unit warns of, as that the run goes beyond the speeds measured; a logger of our
        # own it would keep beyond its life, and call it for the next unit
        with redirect_stdout(StringIO()):
            ran = fmpy.simulate_fmu(
                str(unit.path),
                stop_time=duration,
                output_interval=duration / _STEPS,
                start_values={unit.drive_input: value / radius if unit.port == ROTATIONAL else value},
                output=COMPARED,
                validate=False,
            )
    except Exception as error:  # FMPy raises that of Python's for all that a library refuses
        return Trial((f"it cannot be run: {error}",), {}, 0)
    return Trial((), _differences(run, ran), len(run.events))


def _start(unit: ExportedUnit) -> str | tuple[float, float]:
    if unit.start != "given":
        return unit.start
    return unit.starts["start_belt_speed"], unit.starts["start_stretch"]


def _differences(run: Trajectory, ran: Any) -> dict[str, float]:
    """Greatest differences at the same times, as shares of the greatest value."""
    gaps = {}
    for name in COMPARED:
        core = getattr(run, name)
        gap = np.abs(core - ran[name]) if ran.size == core.size else np.array([np.inf])
        gaps[name] = float(np.max(gap) / (np.max(np.abs(core)) or 1.0))
    return gaps


def _fmpy() -> Any:
    try:
        return import_module("fmpy")
    except ImportError:
        raise ParameterError("checking an FMU needs FMPy. Run pip install 'hersey[exchange]'") from None
