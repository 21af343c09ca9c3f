"""From files and choices to a report, as `hersey report` does it, with progress."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from hersey.app.kept import summary_of
from hersey.damping.dwells import SteadyPoints
from hersey.damping.recipe import Recipe
from hersey.document.assembly import document_of
from hersey.files.writing import write_atomically
from hersey.machine.machine import Machine, read_machine
from hersey.report.page import render
from hersey.study import study

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
        log to compare with, or None. The recipe is written beside the report, with the ending .toml.

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
    found = study(
        points,
        machine,
        against=earlier,
        machine_file=None if machine is None else Path(request["machine"]),
        step=_shared(step, 0 if machine is None else len(machine.points)),
    )
    document = document_of(
        found, command=request["command"], made=datetime.now(UTC).isoformat(timespec="seconds")
    )
    step("drawing the page", _DRAWING)
    report = Path(request["report"])
    if document.recipe is not None:
        write_atomically(report.with_suffix(".toml"), document.recipe.toml, overwrite=True)
    write_atomically(report, render(document), overwrite=True)
    decision = found.decision
    part = None if document.map is None else document.map.to_dict()
    summary = summary_of(decision.model_dump(mode="json", include={"signal", "instruction", "points"}), part)
    return {**summary, "warnings": len(found.warnings)}


def _shared(step: Step, points: int) -> Callable[[str], None]:
    """Report each step of the analysis, with the share of the whole at which it begins."""
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
    recipe = Recipe(
        logs=tuple(request["logs"]),
        mapping=request["mapping"],
        isothermal=request["isothermal"],
        drop_missing=request["drop_missing"],
        tare=request["tare"],
    )

    def progress(done: int, total: int) -> None:
        step("reading", _READING + (_DWELLS - _READING) * done / max(total, 1))

    step("reading", _READING)
    log = recipe.log(machine, progress=progress)
    step("finding dwells", _DWELLS)
    points = recipe.dwells(log, machine)
    return replace(
        points, recipe=replace(recipe.by_name(), logs=tuple(Path(path.name) for path in recipe.logs))
    )
