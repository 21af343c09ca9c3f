"""What to record next: ``hersey design``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from hersey.cli.options import (
    AsJson,
    Logs,
    Reading,
    Traces,
    reads_logs,
)
from hersey.cli.outputs import print_json
from hersey.cli.progress import working
from hersey.cli.terminal import say
from hersey.errors import ParameterError


@reads_logs
def design(
    logs: Logs,
    reading: Reading,
    quantity: Annotated[
        str, typer.Option(help="What to know best, as 'transition speed' or 'c'; all if not given.")
    ] = "",
    count: Annotated[int, typer.Option("--count", help="Dwells to propose.", min=1)] = 6,
    speeds: Annotated[str, typer.Option(help="Range of speed that can be run, as '2 to 200 rpm'.")] = "",
    temperatures: Annotated[str, typer.Option(help="Range of temperature, as '60 to 200 degC'.")] = "",
    seed: Annotated[int, typer.Option("--seed", help="Of the draws of the fit.", min=0)] = 1,
    machine_file: Annotated[
        Path | None,
        typer.Option("--machine", metavar="TOML", help="Rank what would narrow V* of this machine."),
    ] = None,
    trace: Traces = None,
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

    within = _range("speed", "--speeds", speeds), _range("temperature", "--temperatures", temperatures)
    points = reading.points(reading.log(logs))
    with working("fitting the candidates"):
        fitted = compare_models(points, bootstrap=0, cross_validate=False)
    proposal = designed(
        fitted,
        count=count,
        quantity=quantity,
        speeds=within[0],
        temperatures=within[1],
        seed=seed,
    )
    if as_json:
        print_json("design", proposal.to_dict())
        return
    say(proposal.summary())


def _for_the_machine(
    logs: list[Path],
    reading: Reading,
    machine_file: Path,
    trace: list[Path] | None,
    seed: int,
    as_json: bool,
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
        print_json("design", design_part(drawn, ranked))
        return
    say("\n".join(ranking(drawn, ranked)))


def _range(kind: str, flag: str, text: str) -> tuple[float, float] | None:
    """Two values with one unit, 'low to high unit', in SI."""
    import re

    from hersey.units import parse

    if not text:
        return None
    match = re.fullmatch(r"\s*(\S+)\s+to\s+([-+.\deE]+)\s+(\S.*?)\s*", text)
    if match is None:
        raise ParameterError(f"{flag} '{text}' is no range: write it as '2 to 200 rpm' or '60 to 200 degC'")
    low, high, unit = match.groups()
    return parse(kind, f"{low} {unit}"), parse(kind, f"{high} {unit}")
