"""From files and choices to a report: what `hersey report` does, with a word on each step."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from datetime import UTC, datetime
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
#: Share of the whole at which each step begins, as measured on the shipped log with a machine and two points.
_READING, _DWELLS, _EARLIER, _PLANS, _DRAWING = 0.39, 0.42, 0.46, 0.62, 0.93
_BEGINS = {"fitting the surface": 0.48, "judging the regime": 0.52, "finding the bands": 0.61}


def run(request: Mapping[str, Any], step: Step) -> dict[str, Any]:
    """Read, reduce, fit, judge and draw.

    Parameters
    ----------
    request
        ``logs`` (paths), ``mapping`` and ``machine`` (paths; the machine's may be None), ``isothermal``,
        ``drop_missing``, ``tare``, ``command``, ``report``, the path to write, and ``against``, an earlier
        log to compare with, or None.

    Raises
    ------
    HerseyError
        In the words of the reader, the fit or the machine.
    """
    machine = None if request["machine"] is None else read_machine(request["machine"])
    points = _points(request, machine, step)
    earlier = None
    if request["against"] is not None:
        step("reading the earlier log", _EARLIER)
        earlier = _points({**request, "logs": [request["against"]]}, machine, lambda _name, _share: None)
    document = analyse(
        points.log,
        points,
        command=request["command"],
        machine=machine,
        machine_file=None if machine is None else Path(request["machine"]),
        made=datetime.now(UTC).isoformat(timespec="seconds"),
        against=earlier,
        step=_shared(step, 0 if machine is None else len(machine.points)),
    )
    step("drawing the page", _DRAWING)
    write_atomically(Path(request["report"]), render(document), overwrite=True)
    decision = document.decision
    headline = document.verdict[0] if document.verdict else ""
    return {
        "signal": "" if decision is None else decision.signal,
        "words": headline if decision is None else decision.instruction,
        "warnings": len(document.warnings),
    }


def _shared(step: Step, points: int) -> Callable[[str], None]:
    """A word on each step of the analysis, with the share of the whole at which it begins."""
    planned = 0

    def said(words: str) -> None:
        nonlocal planned
        share = _BEGINS.get(words)
        if share is None:  # a plan for each of the operating points
            share = _PLANS + (_DRAWING - _PLANS) * min(planned, points) / max(points, 1)
            planned += 1
        step(words, share)

    return said


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
        step("reading", _READING + (_DWELLS - _READING) * done / max(total, 1))

    done = read_with_mapping(
        paths,
        mapping=mapping,
        isothermal=request["isothermal"],
        drop_missing=request["drop_missing"],
        progress=progress,
    )
    return replace(done.log, corrections=done.corrections)
