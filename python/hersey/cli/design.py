"""What to record next: ``hersey design``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from hersey.cli.groups import grouped, option
from hersey.cli.options import AsJson, Logs, Reading, Traces
from hersey.cli.outputs import print_json
from hersey.cli.progress import working
from hersey.cli.quantities import range_of
from hersey.cli.terminal import say
from hersey.errors import ParameterError

_QUANTITY = "What to know best, as 'transition speed' or 'c'; all if not given."
_MACHINE = "Rank what would narrow V* of this machine."


@grouped
def design(
    logs: Logs,
    *,
    quantity: Annotated[str, option(_QUANTITY)] = "",
    count: Annotated[int, option("Dwells to propose.", min=1)] = 6,
    speeds: Annotated[str, option("Range of speed that can be run, as '2 to 200 rpm'.")] = "",
    temperatures: Annotated[str, option("Range of temperature, as '60 to 200 degC'.")] = "",
    seed: Annotated[int, option("Of the draws of the fit.", min=0)] = 1,
    machine_file: Annotated[Path | None, option(_MACHINE, "--machine", metavar="TOML")] = None,
    trace: Traces = None,
    reading: Reading,
    as_json: AsJson = False,
) -> None:
    """Propose the next dwells to record: those that make the fitted law, or one quantity, known best.

    With --machine it ranks what would narrow V*: starts from rest, break-away, stick-slip, a slower dwell.

    Example: [bold]hersey design examples/bench.csv --tare standing --quantity "transition speed"[/bold]
    """
    if machine_file is not None:
        if quantity or speeds or temperatures:
            raise ParameterError("--machine ranks measurements of V*: leave out --quantity and ranges")
        _for_the_machine(logs, reading, machine_file, trace, seed, as_json)
        return
    if trace:
        raise ParameterError("--trace is a recording of a machine: name its file with --machine")

    from hersey.damping.candidates import compare_models
    from hersey.damping.design import design as designed

    speed = range_of("speed", "--speeds", speeds)
    kelvin = range_of("temperature", "--temperatures", temperatures)
    points = reading.points(logs, reading.log(logs))
    with working("fitting the candidates"):
        fitted = compare_models(points, bootstrap=0, cross_validate=False)
    found = designed(fitted, count=count, quantity=quantity, speeds=speed, temperatures=kelvin, seed=seed)
    if as_json:
        print_json(found, fold=None, measurements=[])
    else:
        say(found.summary())


def _for_the_machine(
    logs: list[Path], reading: Reading, machine_file: Path, trace: list[Path] | None, seed: int, as_json: bool
) -> None:
    """Rank the measurements that would narrow V*."""
    from hersey.decision.measurement import measurements
    from hersey.machine.machine import read_machine
    from hersey.study.first_screen.advice import design_part, ranking

    machine = read_machine(machine_file)
    _, drawn = reading.surface_and_posterior(logs, None, machine, trace, seed=seed)
    assert drawn is not None
    ranked = measurements(drawn)
    if as_json:
        print_json(design_part(drawn, ranked))
        return
    say(*ranking(drawn, ranked))
