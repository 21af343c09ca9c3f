"""From a study to the analysis document."""

from __future__ import annotations

import itertools
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from hersey import _core
from hersey.arrays import FloatArray
from hersey.damping.candidates.observations import Observations
from hersey.damping.curves import CurveMixture, fit_curves
from hersey.damping.dwells import SteadyPoints, groups_of_temperature
from hersey.damping.moving.friction import MovingPoints
from hersey.damping.moving.result import MovingFit
from hersey.damping.surface import DampingSurface
from hersey.damping.trend import trend_of
from hersey.decision.behaviour import Behaviour, ranges
from hersey.document.analysis import Analysis
from hersey.document.parts.fit import Cell, Curve, FitDocument, FitPart, TransitionAt
from hersey.document.parts.log import (
    InputFile,
    MachineFilePart,
    Point,
    Quality,
    RecipePart,
    RejectedStretch,
    Series,
    Timeline,
)
from hersey.document.parts.posterior import PosteriorPart
from hersey.errors import ExtrapolationWarning, ParameterError
from hersey.files.reading import hash_of
from hersey.log import TorqueLog
from hersey.log.means import MeansTable
from hersey.log.torque_log import Channel
from hersey.schema.noun import DRIVE
from hersey.study import Study
from hersey.study.thinning import kept
from hersey.verdict.friction import leading_friction
from hersey.verdict.regime import regime
from hersey.verdict.warnings import warnings_of

#: Samples kept of each channel for display; extremes survive the thinning.
DISPLAYED_SAMPLES = 2000


def document_of(study: Study, *, command: str = "", made: str | None = None) -> Analysis:
    """Return a study as the document.

    Parameters
    ----------
    command
        That was typed, as the document shall say.
    made
        When, as the document shall say.
    """
    points, machine, found, against = study.points, study.machine, study.behaviour, study.against
    log = points.log
    compared = study.comparison
    return Analysis(
        hersey_version=_core.VERSION,
        title=log.title,
        part=DRIVE if machine is None else machine.part,
        command=command,
        made=made,
        recipe=_recipe(points),
        machine=None if study.machine_file is None else _machine_file(study.machine_file),
        synthetic=any(file.synthetic for file in log.files),
        units=study.units,
        decision=study.decision,
        verdict=study.verdict,
        warnings=list(study.warnings),
        files=_files(log),
        quality=_quality(log, points),
        points=_points(points, study.surface),
        fit=_fit_part(points, study.surface, study.curves),
        regime=study.regime,
        friction=study.friction,
        moving=points.friction if isinstance(points, MovingPoints) else None,
        moments=points.friction.moments if isinstance(points, MovingPoints) else None,
        film=study.nip,
        torque_budget=study.torque_budget,
        simulation=study.simulation,
        timeline=_timeline(log),
        uncertainty={} if machine is None else ranges(machine),
        compare=compared,
        against=None if against is None else _files(against.log),
        **_of_the_machine(found),
    )


def _of_the_machine(found: Behaviour | None) -> dict[str, Any]:
    """Map, band, posterior and V* against the stick speed, by the names of their fields."""
    if found is None:
        return {}
    return {
        "map": found.map,
        "band": found.band,
        "posterior": PosteriorPart.model_validate(found.posterior.to_dict()),
        "stick_speed_sweep": found.stick_speeds,
    }


def _recipe(points: SteadyPoints) -> RecipePart | None:
    """The recipe of the dwells; no path of this machine is kept."""
    if points.recipe is None:
        return None
    recipe = points.recipe.by_name()
    return RecipePart(settings=recipe.to_dict(), toml=recipe.toml())


def _machine_file(path: Path) -> MachineFilePart:
    return MachineFilePart(name=path.name, sha256=hash_of(path))


def fit_document(
    log: TorqueLog | MeansTable,
    points: SteadyPoints,
    surface: DampingSurface,
    curves: CurveMixture | None = None,
    moving: MovingFit | None = None,
) -> FitDocument:
    """Return what a fit needs to be read back: fit and drag curves, dwells and files, and the regime."""
    seen = regime(points, surface)
    friction = leading_friction(points, surface, seen)
    return FitDocument(
        warnings=list(warnings_of(points, surface, friction)),
        files=_files(log),
        points=_points(points, surface),
        fit=_fit_part(points, surface, curves or fit_curves(points, surface)),
        regime=seen,
        friction=friction,
        moving=moving,
    )


def _files(log: TorqueLog | MeansTable) -> list[InputFile]:
    return [_file(log, i) for i in range(len(log.files))]


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
        gaps=0 if run is None else run.clock.gaps,
        channels=[Channel(role=c.role, name=c.name, unit=c.unit) for c in file.channels],
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
        return [float(f"{b:.6g}") for b in s.damping(speed=speed, temperature=kelvin)]


def _fit_part(points: SteadyPoints, s: DampingSurface, curves: CurveMixture) -> FitPart:
    chart_parts = {
        "trend": vars(trend_of(Observations.of(points))),
        "laws": [vars(law) for law in curves.table],
        "curves": _curves(points, s, curves),
        "cells": _cells(s),
        "transition_curve": _transition_curve(s),
    }
    return FitPart.model_validate(s.to_dict() | chart_parts)


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
        raise ParameterError(f"this is not an analysis document. {place}: {first['msg']}") from None
