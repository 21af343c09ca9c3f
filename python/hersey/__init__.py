"""From a torque log to the lubrication state of a sliding drive.

Rooms, in the order in which data passes through them; each says in its own header what it holds.

==============  ==============================================================================
errors          the closed table of what can go wrong, and what to do in the words of the way in
arguments       what a user passes to a function: names and types
units           the one door for units
arrays          numbers or arrays as arguments
schema          the schema of what the document and every ``--json`` hold, from the fields of the results
result          what every result can do
files           text, TOML with units, writing whole or not at all
cache           what commands read and fitted, kept on disk for the next one
processes       processes of our own for libraries that may break down
scale           work cut into tasks: for threads, or for the workers of a cluster
log             a `TorqueLog` from any file
motion          drag against speed, schedules, the motion of the belt, sweeps
damping         dwells, the damping surface, candidate laws, comparison, design of tests
inspection      what a log holds, before a fit
lubrication     lubricant, contact, film, the paper's equations, the numerical line contact
machine         the machine file: drivetrain, nip, limits, uncertainty, operating points
verdict         what exponents and film say together
identification  the cycles of a trace, and the drive behind them
stability       hysteresis, disturbances, the operating map, drive profiles, warm-ups
posterior       dwells, starts and stick-slip in one likelihood: draws of curve, closure and drive
decision        what to do: the verdict on a speed, the next measurement, the start-up
study           everything for one log and one machine, computed once; the decision in words
life            runs of many units at many ages, fatigue, populations: what ends a drive, and when
exchange        the drive as a unit that other tools of simulation run
document        the analysis document: the contract with the page
charts          one chart per result
report          the page
testbench       the virtual test stand
app             the local app: from dropped logs to the report
cli             one file per verb
==============  ==============================================================================

SI inside, always; units are read and written at the door. Intervals are at 95 %, those of lives at 90 %.
Nothing flows backwards: a log knows no fit, a fit knows no motion. Names are loaded when they are used.
"""

from __future__ import annotations

import os
from typing import Any

import lazy_loader

_load, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)  # importing loads nothing heavy
__all__ += ["__version__"]


#: What does in Python what a command of another name does.
_OF_COMMANDS = {
    "campaign": "Campaign.open",
    "coastdown": "coast_down",
    "export": "export_fmu",
    "film": "film_thickness",
    "life": "follow",
    "map": "operating_map",
    "models": "compare_models",
    "plan": "plan_profile",
    "warmup": "warm_up",
}
#: Commands that Python has no function for.
_ONLY_COMMANDS = ("app", "examples", "explain", "new", "testbench")


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used."""
    if name == "__version__":  # the core knows it, too, and loads NumPy
        from importlib.metadata import version

        return version("hersey")
    if name in __all__ or name.startswith("_"):
        return _load(name)
    try:
        return _load(name)
    except AttributeError:
        remedy = _instead_of(name)
    # Python adds the nearest name to a message whose object it knows, and would do so a second time.
    raise AttributeError(f"hersey has no '{name}'. {remedy}", name=name, obj=None)


def _instead_of(name: str) -> str:
    """Return what to write instead of a name that is not there."""
    if name in _OF_COMMANDS:
        return f"Use hersey.{_OF_COMMANDS[name]}(...)"
    if name in _ONLY_COMMANDS:
        return f"In a terminal, type: hersey {name}"
    path = f"{__path__[0]}{os.sep}{name}"
    if os.path.exists(path) or os.path.exists(f"{path}.py"):  # noqa: PTH110 - `pathlib` takes longer to load
        return f"Load it: import hersey.{name}"
    from hersey.errors import meant

    known = [*__all__, *_OF_COMMANDS]
    alike = [each for each in known if each[0].isupper() == name[0].isupper()]  # a class, or a function
    near = meant(name, alike) or meant(name, known)
    near = _OF_COMMANDS.get(near, near)
    return f"Did you mean hersey.{near}?" if near else "dir(hersey) lists the names it has"
