"""What to record next: ``hersey design``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from hersey.cli.groups import grouped, option
from hersey.cli.mistyped import machine_here, retyped, typed_without
from hersey.cli.options import Logs, Reading, Traces
from hersey.cli.printing import Printing
from hersey.cli.progress import working
from hersey.cli.quantities import range_of
from hersey.errors import ParameterError

_QUANTITY = "Narrow this quantity, e.g. 'transition speed' or 'c'.  [default: all]"
_MACHINE = "Machine file: rank the measurements that would narrow its V*."
_SPEEDS = "Speeds that can be run, e.g. '2 to 200 rpm'.  [default: those measured]"
_TEMPERATURES = "Temperatures that can be run, e.g. '60 to 200 degC'.  [default: those measured]"
#: Name that hersey new gives a machine file.
_MACHINE_FILE = "machine.toml"
#: Names of the safe speed, which is no parameter of a fit.
_SAFE_SPEED = ("v*", "v", "vstar", "v_star", "safe speed")


@grouped
def design(
    logs: Logs,
    *,
    quantity: Annotated[str, option(_QUANTITY)] = "",
    count: Annotated[int, option("Number of dwells to propose.", min=1)] = 6,
    speeds: Annotated[str, option(_SPEEDS)] = "",
    temperatures: Annotated[str, option(_TEMPERATURES)] = "",
    seed: Annotated[int, option("Random seed.", min=0)] = 1,
    machine_file: Annotated[Path | None, option(_MACHINE, "--machine", metavar="TOML")] = None,
    trace: Traces = None,
    reading: Reading,
    printing: Printing,
) -> None:
    """Propose the dwells or measurements to record next.

    Example: [bold]hersey design examples/bench.csv --tare standing --quantity "transition speed"[/bold]

    With --machine, rank what would narrow V*: starts from rest, break-away torque, stick-slip, a slow dwell.
    """
    limiting = {"--quantity": quantity, "--speeds": speeds, "--temperatures": temperatures}
    stray = [flag for flag, value in limiting.items() if value]
    if machine_file is not None:
        if stray:
            listed = " and ".join(filter(None, [", ".join(stray[:-1]), stray[-1]]))
            raise ParameterError(f"--machine ranks measurements of V*: omit {listed}")
        _for_the_machine(logs, reading, machine_file, trace, seed, printing)
        return
    if trace:
        raise ParameterError("--trace needs the machine file: add --machine TOML")

    if quantity.strip().lower() in _SAFE_SPEED:
        there = machine_here()
        typed = [*typed_without([*stray, "--count"]), "--machine", there or _MACHINE_FILE]
        how = "Type" if there else f"Write {_MACHINE_FILE} with hersey new, then type"
        raise ParameterError(f"{quantity} depends on the machine too. {how}: {retyped(*typed)}")

    from hersey.damping.candidates import compare_models
    from hersey.damping.design import design as designed

    speed = range_of("speed", "--speeds", speeds)
    kelvin = range_of("temperature", "--temperatures", temperatures)
    points = reading.points(logs, reading.log(logs))
    with working("fitting the models"):
        fitted = compare_models(points, bootstrap=0, cross_validate=False)
    found = designed(fitted, count=count, quantity=quantity, speeds=speed, temperatures=kelvin, seed=seed)
    if not printing.json(found, fold=None, measurements=[]):
        printing.text(found.summary())


def _for_the_machine(
    logs: list[Path],
    reading: Reading,
    machine_file: Path,
    trace: list[Path] | None,
    seed: int,
    printing: Printing,
) -> None:
    """Rank the measurements that would narrow V*."""
    from hersey.decision.measurement import measurements
    from hersey.machine.machine import read_machine
    from hersey.study.first_screen.advice import design_part, ranking

    machine = read_machine(machine_file)
    _, drawn = reading.surface_and_posterior(logs, None, machine, trace, machine_file=machine_file, seed=seed)
    assert drawn is not None
    ranked = measurements(drawn)
    if printing.json(design_part(drawn, ranked)):
        return
    printing.text(*ranking(drawn, ranked))
