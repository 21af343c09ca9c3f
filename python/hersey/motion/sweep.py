"""What thousands of belts settle to: one axis per varied parameter, labelled."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from hersey import _core
from hersey.arrays import numbers_of, refuse_unknown, refuse_without_xarray
from hersey.errors import ParameterError
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import Drag
from hersey.motion.following import NUMBERS, Rules, values_of
from hersey.motion.parameters import KINDS, MOST_STEPS, PARAMETERS, refuse_too_many, whole
from hersey.motion.sets import Sets
from hersey.motion.simulation import TOLERANCE
from hersey.motion.work import ALONE, HELD, Work
from hersey.schema.warning import Warning
from hersey.units import takes_si

if TYPE_CHECKING:
    import xarray as xr

    from hersey.motion.checkpoint import Checkpoint
    from hersey.scale.store import SweepFolder


#: Parameters of a drag that a log shows: with others it is no longer that of the log.
_OF_THE_LAW = frozenset(["transition_force", "transition_speed", "ehl_exponent", "mixed_exponent"])


@takes_si(duration="time", **{name: kind for name, kind in KINDS.items() if kind is not None})
def sweep(
    train: Drivetrain,
    drag: Drag,
    *,
    zip: bool = False,  # noqa: A002 - NumPy users know what it means
    start: str = "rest",
    duration: float | None = None,
    work: Work = ALONE,
    out: str | Path | SweepFolder | None = None,
    **varied: ArrayLike,
) -> xr.Dataset:
    """Return the final motion of each combination of parameters, as `stick_slip` does for one.

    Each parameter is a number or an array; the others are those of ``train`` and ``drag``. Each
    one-dimensional array spans an axis named after the parameter. With ``zip``, arrays are broadcast together
    by NumPy's rules, along an axis ``set`` (or ``dim_0``, ``dim_1`` ... if they have several dimensions).

    Parameters
    ----------
    start
        ``rest``, or ``steady``: sliding at the drive speed minus a disturbance of 0.1 %.
    duration
        If given, each motion is simulated for this time and its last whole cycle is reported. Default: until
        its orbit has closed, which is exact and much faster.
    work
        Tolerance (default 1e-9), threads and workers.
    out
        Folder that ends in .zarr or .parquet, in which each finished chunk of sets is stored; the number of
        sets is then unlimited. Finished parts of the same sweep are not computed again, unless a
        `SweepFolder` says so. Units in it are SI.
    **varied
        ``drive_speed`` (m/s), which is needed, and any of ``stiffness`` (N/m), ``mass`` (kg),
        ``transition_force`` (N), ``transition_speed`` (m/s), ``ehl_exponent``, ``mixed_exponent`` and
        ``stick_speed`` (m/s).

    Returns
    -------
    xarray.Dataset
        ``kind`` (text), ``frequency``, ``stuck_fraction``, ``speed_max`` and so on, ``laps``. A motion that
        cannot be continued has the kind ``failed`` and no numbers; the attribute ``failures`` says why. With
        ``out``, a .zarr is opened and numbers are read on demand; there ``kind`` is a number, and the
        attribute ``flag_meanings`` lists the words. For a .parquet there are only coordinates and attributes.
        The attributes ``kinds``, ``stick_slip`` and ``failures`` count the outcomes; ``warnings`` is text.

    Raises
    ------
    ParameterError
        If a value is out of range, with the parameter's name, or there is no parameter of a name; if no
        scheduler answers, or a worker has another hersey.
    OutputError
        If ``out`` belongs to another sweep, is in use, or cannot be written.
    UnfinishedError
        If scheduler or workers are lost.
    MissingFileError
        If xarray, Dask or Zarr is needed and not installed.

    Examples
    --------
    >>> drag = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    >>> grid = sweep(Drivetrain(1000, 1), drag, stiffness=[500, 1000], drive_speed=[0.4, 1.0, 1.6])
    >>> dict(grid.sizes), round(float(grid.frequency.sel(stiffness=1000, drive_speed=1.0)), 5)
    ({'stiffness': 2, 'drive_speed': 3}, 3.94031)
    """
    refuse_unknown("sweep", varied, PARAMETERS, HELD)
    refuse_without_xarray("A sweep")  # before hours of work
    work = replace(work, threads=whole("threads", work.threads))
    sets, rules = planned(
        train,
        drag,
        varied,
        zip=zip,
        start=start,
        duration=duration,
        tolerance=work.within(TOLERANCE),
        most_steps=work.most_steps,
    )
    if not _OF_THE_LAW & {name for name, values in varied.items() if values is not None}:
        drag.warned(None, stacklevel=3, drive_speed=sets.given["drive_speed"])
    if out is not None:
        from hersey.motion.checkpoint import checkpointed

        return _opened(sets, rules, checkpointed(sets, rules, out, work))
    refuse_too_many(sets.given.values(), zip=zip)
    if work.client is not None:
        from hersey.motion.checkpoint import gathered

        columns, failures, warnings = gathered(sets, rules, work)
        return _labelled(sets, rules, columns, failures, warnings)
    if work.chunk is not None:
        raise ParameterError("chunk is given without out or client, so there is nothing to cut into chunks")
    motions = rules.follow(sets, work.threads, work.progress)
    failures = [f"set {failure.index}: {failure.error}" for failure in motions.failures]
    return _labelled(sets, rules, values_of(motions), failures, [])


def planned(
    train: Drivetrain,
    drag: Drag,
    varied: Mapping[str, ArrayLike | None],
    *,
    zip: bool,  # noqa: A002 - NumPy users know what it means
    start: str,
    duration: float | None,
    tolerance: float = TOLERANCE,
    most_steps: float = MOST_STEPS,
) -> tuple[Sets, Rules]:
    """Return the sets of a sweep, and what holds for all; arguments as `sweep`.

    A parameter that is None or not there is that of train or drag.

    Raises
    ------
    ParameterError
        If one is none that a sweep takes.
    """
    if not isinstance(drag, Drag) or drag.varies_with_temperature:
        raise ParameterError("a sweep needs a Drag at one temperature")
    if start not in ("rest", "steady"):
        raise ParameterError(f"start is '{start}': it must be rest or steady")
    drag.beside(1)  # refuses what a sweep has no parameter for
    parameters: dict[str, Any] = {**vars(train), **vars(drag)}
    asked = {name: values for name, values in varied.items() if values is not None}
    if "drive_speed" not in asked:
        raise ParameterError("a sweep needs a drive_speed", quantity="drive_speed")
    parameters |= asked
    given = {name: numbers_of(name, parameters[name]) for name in PARAMETERS}
    lasting = None if duration is None else float(duration)
    rules = Rules(drag, train.grip, start, lasting, float(tolerance), whole("most_steps", most_steps))
    return Sets(given, zip), rules


def _labelled(
    sets: Sets, rules: Rules, values: dict[str, Any], failures: list[str], warnings: Sequence[Warning]
) -> xr.Dataset:
    """The sweep in memory: values, flat, over the axes that the sets span."""
    import xarray as xr

    def over(column: Any) -> tuple[tuple[str, ...], Any]:
        return sets.axes, column.reshape(sets.shape)

    return xr.Dataset(
        {
            "kind": over(np.array(_core.KINDS)[values["kind"]]),
            **{name: over(values[name]) for name in (*NUMBERS, "stuck_fraction", "laps")},
        },
        coords=_coordinates(sets),
        attrs={**_about(rules), "failures": failures, **({"warnings": _said(warnings)} if warnings else {})},
    )


def _opened(sets: Sets, rules: Rules, found: Checkpoint) -> xr.Dataset:
    """The sweep as it is kept."""
    import xarray as xr

    if found.path.suffix == ".zarr":
        from hersey.motion.checkpoint import opened_dataset

        result = opened_dataset(found.path)
    else:
        result = xr.Dataset(coords=_coordinates(sets), attrs=_about(rules))
    return result.assign_attrs({**found.summary(), "warnings": _said(found.warnings)})


def _said(warnings: Sequence[Warning]) -> list[str]:
    """The words of warnings: what files hold as an attribute is text."""
    return [str(each) for each in warnings]


def _coordinates(sets: Sets) -> dict[str, Any]:
    if not sets.zip:
        return dict(sets.given)
    return {
        name: (sets.axes, np.broadcast_to(values, sets.shape)) if values.ndim else values
        for name, values in sets.given.items()
    }


def _about(rules: Rules) -> dict[str, Any]:
    return {
        "closure": rules.drag.closure,
        "start": rules.start,
        "tolerance": rules.tolerance,
        "hersey_version": _core.VERSION,
    }
