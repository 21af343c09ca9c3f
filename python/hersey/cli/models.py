"""Laws against each other: ``hersey models``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import grouped, option
from hersey.cli.options import Logs, Reading
from hersey.cli.printing import Printing
from hersey.cli.progress import bar, working
from hersey.cli.terminal import note

if TYPE_CHECKING:
    from hersey.damping.candidates.intervals import ParameterEstimate
    from hersey.damping.candidates.model_comparison import ModelComparison
    from hersey.damping.curves import LawWeight

_MACHINE = "Also compare the contact model of this machine file."
_BOOTSTRAP = "Number of resampled fits for the bootstrap interval; 0 skips it."
#: Differences of AICc up to which a model is listed, and models listed at most.
_NEAR, _MOST = 6.0, 6


@grouped
def models(
    logs: Logs,
    *,
    machine_file: Annotated[Path | None, option(_MACHINE, "--machine", metavar="TOML")] = None,
    bootstrap: Annotated[int, option(_BOOTSTRAP, min=0)] = 300,
    seed: Annotated[int, option("Random seed.", min=0)] = 1,
    reading: Reading,
    printing: Printing,
) -> None:
    """Compare damping models on the same dwells and choose one.

    Example: [bold]hersey models examples/bench.csv --tare standing[/bold]
    """
    from hersey.damping.candidates import compare_models
    from hersey.damping.fit import fit
    from hersey.errors import InsufficientDataError
    from hersey.machine.machine import read_machine
    from hersey.verdict.warnings import warnings_of

    machine = None if machine_file is None else read_machine(machine_file)
    contact = None if machine is None else machine.mixed
    if machine_file is not None and contact is None:
        stated = "[asperities] and [boundary] (docs/theory/mixed.md)"
        note(f"The contact model is not compared: {machine_file.name} lacks {stated}.")
    log = reading.log(logs, machine)
    with working("reducing to dwells"):
        points = reading.points(logs, log, machine)
    resampled = bootstrap if printing.in_full else 0  # nothing else prints that interval
    with bar("fitting", unit="models") as progress:
        compared = compare_models(points, contact=contact, bootstrap=resampled, seed=seed, progress=progress)
    try:
        surface = fit(points, temperature_scale=reading.temperature_scale)
    except InsufficientDataError:  # another model may hold where the surface cannot be fitted
        surface = None
    doubts = warnings_of(points, surface)
    curves: tuple[LawWeight, ...] = ()
    if printing.in_full and surface is not None:
        from hersey.damping.curves import fit_curves

        curves = fit_curves(points, surface, contact).table
    if printing.json(compared, warnings=doubts, drag_curves=curves):
        return
    printing.text(
        *compared.reasons, *(_statistics(compared, curves) if printing.verbose else _table(compared))
    )
    printing.warnings(*doubts)


def _statistics(compared: ModelComparison, curves: Sequence[LawWeight]) -> list[str]:
    """Every model and parameter with all statistics, and the drag curves."""
    from hersey.damping.curves.words import drag_curves

    return ["", compared.summary(), *([drag_curves(curves)] if curves else [])]


def _table(compared: ModelComparison) -> list[str]:
    """The models that come close to the best, and the parameters of the chosen one."""
    from hersey.cli.figures import labelled, three

    near = [each for each in compared.candidates if each.delta_aicc <= _NEAR]
    lines = ["", f"{len(near)} of {len(compared.candidates)} models are within {_NEAR:g} of the best AICc"]
    lines.append("  dAICc  scatter  model (* chosen)")
    listed = near[:_MOST]
    for each in listed if compared.chosen in listed else [compared.chosen, *listed]:
        scatter = f"{three(100 * each.fit.scatter)} %"
        mark = "*" if each is compared.chosen else " "
        lines.append(f"{mark} {each.delta_aicc:5.1f}  {scatter:>7}  {each.candidate.name}")
    rows = [(each.name, _shown(each)) for each in compared.parameters]
    return [*lines, "", "Parameters of the chosen model (value, 95 % interval)", *labelled(rows)]


def _shown(parameter: ParameterEstimate) -> str:
    """A parameter with the interval that counts dwells of one level together."""
    from hersey.cli.figures import three, within
    from hersey.units import convert

    if parameter.not_identified:
        return f"not determined: {parameter.not_identified}"
    unit = {"rad/s": "rpm", "m": "um"}.get(parameter.unit, parameter.unit)

    def shown(value: float) -> float:
        return convert(value, parameter.unit, unit) if unit != parameter.unit else value

    unit_text = unit.replace("um", "µm").replace("N m s", "N·m·s")
    for method in ("clustered", "covariance"):
        if method in parameter.intervals:
            low, high = parameter.intervals[method]
            return within(map(shown, (parameter.value, low, high)), unit_text)
    return three(shown(parameter.value), unit_text)
