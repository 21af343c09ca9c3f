"""From files and choices to a report: what `hersey report` does, with a word on each step."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from hersey.damping.dwells import SteadyPoints
from hersey.document.assembly import analyse
from hersey.errors import ParameterError
from hersey.files.writing import write_atomically
from hersey.log import TorqueLog
from hersey.log.mapping import read_mapping, read_with_mapping
from hersey.log.means import MeansTable, is_means_table, read_means, refuse_corrections
from hersey.machine.machine import Machine, read_machine
from hersey.report.page import render

Step = Callable[[str, float | None], None]
#: Share of the whole at which each step begins, as it is for a log of some minutes.
_READING, _DWELLS, _FITTING, _DRAWING = 0.0, 0.15, 0.2, 0.95


def run(request: Mapping[str, Any], step: Step) -> dict[str, Any]:
    """Read, reduce, fit, judge and draw.

    Parameters
    ----------
    request
        ``logs`` (paths), ``mapping`` and ``machine`` (paths; the machine's may be None), ``isothermal``,
        ``drop_missing``, ``tare``, ``command``, and ``report``, the path to write.

    Raises
    ------
    HerseyError
        In the words of the reader, the fit or the machine.
    """
    machine = None if request["machine"] is None else read_machine(request["machine"])
    points = _points(request, machine, step)
    step("fitting and judging", _FITTING)
    given: dict[str, Any] = {"command": request["command"], "machine": machine}
    if "progress" in inspect.signature(analyse).parameters:
        span = _DRAWING - _FITTING
        given["progress"] = lambda words, share: step(words, _FITTING + span * share)
    document = analyse(points.log, points, **given)
    step("drawing the page", _DRAWING)
    write_atomically(Path(request["report"]), render(document), overwrite=True)
    decision = getattr(document, "decision", None)
    return {
        "signal": "" if decision is None else decision.signal,
        "words": document.verdict[0]
        if decision is None and document.verdict
        else decision.instruction
        if decision
        else "",
        "warnings": len(document.warnings),
    }


def _points(request: Mapping[str, Any], machine: Machine | None, step: Step) -> SteadyPoints:
    step("reading", _READING)
    paths = [Path(path) for path in request["logs"]]
    log = _log(request, paths, step)
    if machine is not None:
        log = replace(log, sensors=log.sensors.or_else(machine.sensors))
    step("finding dwells", _DWELLS)
    if isinstance(log, MeansTable):
        if request["tare"] != "none":
            raise ParameterError(
                "a table of means has no stretch in which the drive stands: take off no zero"
            )
        points = SteadyPoints.from_table(log)
    else:
        points = log.steady(tare=request["tare"])
    return points if machine is None or machine.rest is None else points.without(machine.rest)


def _log(request: Mapping[str, Any], paths: list[Path], step: Step) -> TorqueLog | MeansTable:
    mapping = read_mapping(request["mapping"])
    units = {role: unit for role, unit in mapping.units.items() if role != "time"}
    channels = {role: name for role, name in mapping.channels.items() if role != "time"}
    if mapping.time.every is None and all(is_means_table(path, channels, units) for path in paths):
        refuse_corrections(mapping.corrects, "hersey.toml")
        table = read_means(paths, channels=channels, units=units, isothermal=request["isothermal"])
        return replace(table, sensors=mapping.sensors)

    def progress(done: int, total: int) -> None:
        step("reading", _DWELLS * done / max(total, 1))

    done = read_with_mapping(
        paths,
        mapping=mapping,
        isothermal=request["isothermal"],
        drop_missing=request["drop_missing"],
        progress=progress,
    )
    return replace(done.log, corrections=done.corrections)
