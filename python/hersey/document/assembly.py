"""From a log and its steady points to the analysis document: fit, judge, simulate."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import numpy as np

from hersey import _core
from hersey.arrays import FloatArray
from hersey.damping.candidates.observations import Observations
from hersey.damping.compare import compare
from hersey.damping.curves import CurveMixture, fit_curves
from hersey.damping.dwells import SteadyPoints, groups_of_temperature
from hersey.damping.fit import fit
from hersey.damping.surface import DampingSurface
from hersey.damping.trend import trend_of
from hersey.decision.behaviour import Behaviour, Step, Working, ranges, typical
from hersey.document.carried_part import carried_part
from hersey.document.decision import decision
from hersey.document.decision.parts import behaviour_parts
from hersey.document.decision.reasons import in_words
from hersey.document.display_units import display_units
from hersey.document.film_part import film_part
from hersey.document.parts import (
    Analysis,
    Cell,
    ChannelUse,
    ComparisonPart,
    Curve,
    FitDocument,
    FitPart,
    InputFile,
    MachineFilePart,
    Point,
    Quality,
    RegimePart,
    RejectedStretch,
    Series,
    SimulationPart,
    Timeline,
    TransitionAt,
)
from hersey.document.thinning import kept
from hersey.errors import ExtrapolationWarning, HerseyError, ParameterError
from hersey.files.reading import hash_of
from hersey.log import TorqueLog
from hersey.log.means import MeansTable
from hersey.machine.machine import Machine
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import DragTable
from hersey.motion.simulation import simulate, stick_slip
from hersey.units import celsius, rpm
from hersey.verdict.cautions import cautions
from hersey.verdict.regime import regime

#: Samples kept of each channel for display; extremes survive the thinning.
DISPLAYED_SAMPLES = 2000
#: Drive speed of the simulation of the user's machine, as a share of its transition speed.
SIMULATED_SPEED = 0.8


def analyse(
    log: TorqueLog | MeansTable,
    points: SteadyPoints,
    *,
    command: str = "",
    temperature_scale: str = "degC",
    machine: Machine | None = None,
    machine_file: Path | None = None,
    against: SteadyPoints | None = None,
    traces: Sequence[TorqueLog] = (),
    made: str | None = None,
    step: Step = lambda _what: None,
) -> Analysis:
    """Fit, judge, decide and simulate, and return the document.

    Parameters
    ----------
    machine_file
        Where the machine was read, for its name and hash.
    against
        Steady points of another log, which this one is compared with as `hersey.compare` does (this is B).
    traces
        Recordings of the machine that show starts from rest or stick-slip: evidence of V*.
    made
        When, as the document shall say.
    step
        Called with the name of each step that takes long.

    Raises
    ------
    InsufficientDataError
        If the points cannot determine the surface, or share nothing with those of the other log.
    ParameterError
        If a file is in both logs.
    """
    beside: dict[str, Any] = {}
    if against is not None:
        step("comparing the two logs")
        beside = _compared(log, points, against)
    step("fitting the surface")
    surface = fit(points, temperature_scale=temperature_scale)
    curves = fit_curves(points, surface, None if machine is None else machine.mixed)
    beside["fit"] = _fit_part(points, surface, curves)
    working = None if machine is None else Working(points, surface, machine, traces, curves)
    with nullcontext() if working is None else working:
        return _analysed(log, points, surface, command, machine, machine_file, made, step, working, beside)


def _analysed(
    log: TorqueLog | MeansTable,
    points: SteadyPoints,
    surface: DampingSurface,
    command: str,
    machine: Machine | None,
    machine_file: Path | None,
    made: str | None,
    step: Step,
    working: Working | None,
    beside: dict[str, Any],
) -> Analysis:
    """The document of a fit, and what is there ``beside`` it, while its machine is worked out."""
    nip = (machine.contact, machine.lubricant) if machine is not None else (None, None)
    step("judging the regime")
    seen = regime(points, surface, contact=nip[0], lubricant=nip[1])
    film = film_part(points, surface, machine, seen)
    regime_part, carried = RegimePart.model_validate(seen.to_dict()), carried_part(points, surface, machine)
    document: dict[str, Any] = {
        "hersey_version": _core.VERSION,
        "title": _title(log),
        "command": command,
        "made": made,
        "machine": None if machine_file is None else _machine_file(machine_file),
        "synthetic": any("synthetic" in text.lower() for file in log.files for text in file.comments),
        "verdict": [*([film.verdict] if film is not None and film.verdict else []), seen.verdict],
        "warnings": cautions(points, surface),
        "files": [_file(log, i) for i in range(len(log.files))],
        "quality": _quality(log, points),
        "points": _points(points, surface),
        "regime": regime_part,
        "film": film,
        "carried": carried,
        "timeline": _timeline(log),
        "uncertainty": {} if machine is None else ranges(machine),
        **beside,
    }
    found, why = None, ""
    try:
        found = None if working is None else working.result(step)
        document["simulation"] = None if found is None else _simulation(found)
    except HerseyError as error:  # a stick speed above the transition, say: the log can be told all the same
        why = in_words(error)
    shown = display_units(points, None if found is None else found.map)
    decided = decision(
        points,
        surface,
        machine,
        seen=regime_part,
        film=film,
        carried=carried,
        compared=beside.get("compare"),
        found=found,
        why=why,
        machine_file="" if machine_file is None else machine_file.name,
        unit=shown["torque"],
    )
    return Analysis(**document, units=shown, decision=decided, **behaviour_parts(found))


def _compared(log: TorqueLog | MeansTable, points: SteadyPoints, against: SteadyPoints) -> dict[str, Any]:
    """What this log has against another, and the files of that one."""
    earlier = against.log.files
    here = {file.sha256 for file in log.files}
    for file in earlier:
        if file.sha256 in here:
            raise ParameterError(f"{file.name} is in both logs: name another to compare this one with")
    names = _title(against.log), _title(log)
    if names[0] == names[1]:
        names = f"{names[0]} (earlier)", names[1]
    found = compare(against, points, names=names)
    return {
        "compare": ComparisonPart.model_validate(found.to_dict()),
        "against": [_file(against.log, i) for i in range(len(earlier))],
    }


def _machine_file(path: Path) -> MachineFilePart:
    return MachineFilePart(name=path.name, sha256=hash_of(path))


def fit_document(
    log: TorqueLog | MeansTable,
    points: SteadyPoints,
    surface: DampingSurface,
    curves: CurveMixture | None = None,
) -> FitDocument:
    """Return what a fit needs to be read back: fit and drag curves, dwells and files, and the regime."""
    return FitDocument(
        warnings=cautions(points, surface),
        files=[_file(log, i) for i in range(len(log.files))],
        points=_points(points, surface),
        fit=_fit_part(points, surface, curves or fit_curves(points, surface)),
        regime=RegimePart.model_validate(regime(points, surface).to_dict()),
    )


def _title(log: TorqueLog | MeansTable) -> str:
    first = log.files[0].name
    return first if len(log.files) == 1 else f"{first} and {len(log.files) - 1} more"


def _file(log: TorqueLog | MeansTable, index: int) -> InputFile:
    file = log.files[index]
    run = log.runs[index] if log.runs else None
    return InputFile(
        name=file.name,
        sha256=file.sha256,
        bytes=file.bytes,
        rows=file.rows,
        missing_rows=file.missing_rows,
        duration=0.0 if run is None else float(run.time[-1] - run.time[0]),
        sampling_interval=0.0 if run is None else run.sampling_interval,
        gaps=0 if run is None else run.gaps(),
        channels=[ChannelUse(role=c.role, name=c.name, unit=c.unit) for c in file.channels],
        comments=list(file.comments),
    )


def _quality(log: TorqueLog | MeansTable, points: SteadyPoints) -> Quality:
    return Quality(
        rows=log.rows,
        rows_used=int(points.table["rows"].sum()),
        rows_settling=int(points.table["settling_rows"].sum()),
        rows_rejected=sum(r.rows for r in points.rejected),
        standing_torque=points.standing_torque,
        tare=points.tare,
        rejected=[
            RejectedStretch(
                run=r.run,
                start=r.start,
                end=r.end,
                rows=r.rows,
                kind=r.why.kind,
                label=r.why.label,
                reason=r.reason,
            )
            for r in points.rejected
        ],
    )


def _points(points: SteadyPoints, surface: DampingSurface) -> list[Point]:
    out = []
    levels = _group_temperatures(points)
    rows = zip(points.table.iter_rows(named=True), surface.residuals, levels, strict=True)
    for row, residual, level in rows:
        damping = row["torque"] / row["speed"]
        fitted = damping * float(np.exp(-residual))
        out.append(
            Point(
                **row,
                group_temperature=level,
                damping=damping,
                damping_fitted=fitted,
                residual=float(residual),
            )
        )
    return out


def _group_temperatures(points: SteadyPoints) -> list[float | None]:
    if not points.log.has_temperature:
        return [None] * len(points)
    kelvin = points.column("temperature")
    levels = np.empty_like(kelvin)
    for group in groups_of_temperature(kelvin):
        levels[group] = np.mean(kelvin[group])
    return [float(level) for level in levels]


def _curves(points: SteadyPoints, surface: DampingSurface, curves: CurveMixture) -> list[Curve]:
    """The drag curves of all laws by weight at each temperature of the dwells, over its speeds."""
    out = []
    speed, levels = np.abs(points.column("speed")), _group_temperatures(points)
    for level in dict.fromkeys(levels):
        speeds = speed[[other == level for other in levels]]
        kelvin = None if surface.b is None else level
        grid = np.geomspace(speeds.min(), speeds.max(), 41)
        damping = curves.torque(grid, kelvin) / grid
        out.append(
            Curve(temperature=kelvin, speed=grid.tolist(), damping=[float(f"{b:.6g}") for b in damping])
        )
    return out


def _cells(s: DampingSurface) -> list[Cell]:
    edges = np.geomspace(*s.speed_range, 41)
    middles = np.sqrt(edges[:-1] * edges[1:])
    hot = s.temperature_range if s.b else None
    levels = np.linspace(*hot, 21) if hot else np.zeros(2)
    out = []
    for cold, warm in itertools.pairwise(levels.tolist()):
        kelvin = (cold + warm) / 2 if hot else None
        values = zip(itertools.pairwise(edges.tolist()), _damping(s, middles, kelvin), strict=True)
        for (low, high), damping in values:
            out.append(
                Cell(
                    speed_low=low,
                    speed_high=high,
                    temperature_low=cold if hot else None,
                    temperature_high=warm if hot else None,
                    damping=damping,
                )
            )
    return out


def _transition_curve(s: DampingSurface) -> list[TransitionAt]:
    if s.transition is None or s.temperature_range is None:
        return []
    levels = np.linspace(*s.temperature_range, 41).tolist()
    curve = [TransitionAt(temperature=t, speed=s.transition_speed(t)) for t in levels]
    return [at for at in curve if s.speed_range[0] <= at.speed <= s.speed_range[1]]


def _damping(s: DampingSurface, speed: FloatArray, kelvin: float | None) -> list[float]:
    with warnings.catch_warnings():  # the mean of a group of temperatures may graze the edge of the range
        warnings.simplefilter("ignore", ExtrapolationWarning)
        return [float(f"{b:.6g}") for b in s.damping(speed, kelvin)]


def _fit_part(points: SteadyPoints, s: DampingSurface, curves: CurveMixture) -> FitPart:
    chart_parts = {
        "trend": vars(trend_of(Observations.of(points))),
        "laws": [vars(law) for law in curves.table],
        "curves": _curves(points, s, curves),
        "cells": _cells(s),
        "transition_curve": _transition_curve(s),
    }
    return FitPart.model_validate(s.to_dict() | chart_parts)


def _simulation(found: Behaviour) -> SimulationPart:
    """The typical belt of this machine below its transition speed."""
    kelvin = found.temperature
    train, drag = typical(found)
    at = "" if kelvin is None else f" at {celsius(kelvin):.0f} °C"
    turn = drag.law_at(None).transition_speed
    slow = max(SIMULATED_SPEED * turn, 1.05 * drag.stick_speed)
    roll = slow / found.posterior.model.machine.roll_radius
    title = (
        f"This machine{at}, driven at {rpm(roll):.3g} rpm, {100 * slow / turn:.0f} % of its transition speed"
    )
    return _simulated(train, drag, slow, title)


def _simulated(
    train: Drivetrain,
    drag: DragTable,
    speed: float,
    title: str,
) -> SimulationPart:
    cycle = stick_slip(train, drag, drive_speed=speed)
    period = 1.0 / cycle.frequency if cycle.frequency else 10.0 * (train.mass / train.stiffness) ** 0.5
    first = drag.holding_force / train.stiffness / speed
    run = simulate(train, drag, drive_speed=speed, duration=first + 6.0 * period, samples=4001)
    samples = kept(run.belt_speed, 1500)
    if cycle.kind in ("stalled", "grip_slip"):
        title += "; the roll slips on the belt" + (" and does not move it" if cycle.kind == "stalled" else "")
    beside, law = {"rest_force": drag.rest_force, "rest_damping": drag.rest_damping}, drag.law_at(None)
    return SimulationPart(
        title=title,
        units="SI: N/m, kg, N, m/s",
        speed_unit="m/s",
        force_unit="N",
        parameters={
            "stiffness": train.stiffness,
            "mass": train.mass,
            "transition_force": law.transition_force,
            "transition_speed": law.transition_speed,
            "stick_speed": drag.stick_speed,
            "closure": drag.closure,
            **(beside if any(beside.values()) else {}),
        },
        kind=cycle.kind,
        frequency=cycle.frequency,
        stuck_fraction=cycle.stuck_fraction,
        speed_max=cycle.speed_max,
        time=run.time[samples].tolist(),
        belt_speed=run.belt_speed[samples].tolist(),
        spring_force=run.spring_force[samples].tolist(),
        transition_speed=law.transition_speed,
        drive_speed=speed,
    )


def _timeline(log: TorqueLog | MeansTable) -> Timeline:
    starts, begin = [], 0.0
    for run in log.runs:
        starts.append(begin - float(run.time[0]))
        begin += float(run.time[-1] - run.time[0]) + run.sampling_interval
    each = max(DISPLAYED_SAMPLES // max(len(log.runs), 1), 60)

    def series(name: str) -> Series:
        times: list[float] = []
        values: list[float] = []
        for run, start in zip(log.runs, starts, strict=True):
            channel = getattr(run, name)
            thinned = kept(channel, each)
            times += np.round(run.time[thinned] + start, 4).tolist()
            values += [float(f"{v:.6g}") for v in channel[thinned]]
        return Series(time=times, value=values)

    return Timeline(
        speed=series("speed"),
        torque=series("torque"),
        temperature=series("temperature") if log.has_temperature and log.runs else None,
        starts=starts,
    )


def load(text: str) -> Analysis:
    """Read a document back from its JSON text.

    Raises
    ------
    ParameterError
        If it is not a document of this schema.
    """
    from pydantic import ValidationError

    try:
        return Analysis.model_validate_json(text)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(part) for part in first["loc"]) or "document"
        raise ParameterError(f"not an analysis document: {place}: {first['msg']}") from None
