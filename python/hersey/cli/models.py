"""Laws against each other: ``hersey models``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

from hersey.cli.groups import grouped, option
from hersey.cli.options import AsJson, Logs, Reading
from hersey.cli.outputs import print_json
from hersey.cli.progress import bar, working
from hersey.cli.terminal import say

_MACHINE = "What shares the load there makes candidates of its own."
_BOOTSTRAP = "Resampled fits for that interval; 0 leaves it out."


@grouped
def models(
    logs: Logs,
    *,
    machine_file: Annotated[Path | None, option(_MACHINE, "--machine")] = None,
    bootstrap: Annotated[int, option(_BOOTSTRAP, min=0)] = 300,
    seed: Annotated[int, option("Of the resampling.", min=0)] = 1,
    reading: Reading,
    as_json: AsJson = False,
) -> None:
    """Fit every candidate law to the same dwells, choose one, and say why; energies and Hersey collapse.

    Example: [bold]hersey models examples/bench.csv --tare standing[/bold]
    """
    from hersey.damping.candidates import compare_models
    from hersey.damping.curves import fit_curves
    from hersey.damping.curves.words import drag_curves
    from hersey.damping.fit import fit
    from hersey.errors import InsufficientDataError
    from hersey.machine.machine import read_machine
    from hersey.verdict.warnings import warnings_of

    machine = None if machine_file is None else read_machine(machine_file)
    contact = None if machine is None else machine.mixed
    if machine is not None and contact is None:
        stated = "[asperities] and [boundary]: see docs/theory/mixed.md"
        say(f"the machine's contact is no candidate: its file states no {stated}", file=sys.stderr)
    log = reading.log(logs, machine)
    with working("reducing to dwells"):
        points = reading.points(logs, log, machine)
    with bar("fitting", unit="candidates") as progress:
        compared = compare_models(points, contact=contact, bootstrap=bootstrap, seed=seed, progress=progress)
    try:
        surface = fit(points, temperature_scale=reading.temperature_scale)
    except InsufficientDataError:  # other laws may hold where the surface has no meaning
        surface = None
    doubts = warnings_of(points, surface)
    curves = () if surface is None else fit_curves(points, surface, contact).table
    if as_json:
        print_json(compared, warnings=doubts, drag_curves=curves)
        return
    words = [drag_curves(curves)] if curves else []
    say(compared.summary(), *words, *(f"- {doubt.sentence}" for doubt in doubts))
