"""What thousands of belts settle to: one axis per varied parameter, labelled."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from hersey import _core
from hersey.arrays import crossed, numbers_of, together
from hersey.errors import ParameterError
from hersey.motion.drag import Drag
from hersey.motion.parameters import KINDS, MOST_STEPS, PARAMETERS, refuse_too_many, whole
from hersey.motion.simulation import TOLERANCE, Drivetrain
from hersey.units import takes_si

if TYPE_CHECKING:
    import xarray as xr

#: Numbers of each cycle, in the order of the core.
NUMBERS = (
    "frequency",
    "slip_duration",
    "stick_duration",
    "speed_min",
    "speed_max",
    "stretch_min",
    "stretch_max",
    "grip_slip_duration",
    "drag_work",
)


@takes_si(duration="time", **{name: kind for name, kind in KINDS.items() if kind is not None})
def sweep(
    train: Drivetrain,
    drag: Drag,
    *,
    drive_speed: ArrayLike,
    stiffness: ArrayLike | None = None,
    mass: ArrayLike | None = None,
    transition_force: ArrayLike | None = None,
    transition_speed: ArrayLike | None = None,
    ehl_exponent: ArrayLike | None = None,
    mixed_exponent: ArrayLike | None = None,
    stick_speed: ArrayLike | None = None,
    zip: bool = False,  # noqa: A002 - NumPy users know what it means
    start: str = "rest",
    duration: float | None = None,
    threads: int = 1,
    tolerance: float = TOLERANCE,
    progress: Callable[[int, int], object] | None = None,
    most_steps: float = MOST_STEPS,
) -> xr.Dataset:
    """Return what each combination of parameters settles to, as `stick_slip` does for one.

    Each parameter is a number or an array; those not given are those of ``train`` and ``drag``. Arrays of one
    dimension span one axis each, named by the parameter. With ``zip`` arrays go together by NumPy's rules,
    along an axis ``set`` (or ``dim_0``, ``dim_1`` ... if they have several dimensions).

    Parameters
    ----------
    start
        ``rest``, or ``steady``: sliding with the drive but for a nudge of 0.1 % in speed.
    duration
        If given, each belt is followed for this time and its last whole lap is reported; otherwise until its
        orbit has closed, which is exact and much quicker.
    threads
        Threads to use. The result is the same, bit for bit, for any number.
    progress
        Called with (done, all) some twenty times a second; what it raises ends the sweep.
    most_steps
        Work that each belt may take, as for `simulate`; one that does not suffice is among the failures.

    Returns
    -------
    xarray.Dataset
        ``kind`` (text), ``frequency``, ``stuck_fraction``, ``speed_max`` and so on, ``laps``. A motion that
        cannot be continued has the kind ``failed`` and no numbers; the attribute ``failures`` says why.

    Raises
    ------
    ParameterError
        If a value is out of range, with the parameter's name.

    Examples
    --------
    >>> drag = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    >>> grid = sweep(Drivetrain(1000, 1), drag, stiffness=[500, 1000], drive_speed=[0.4, 1.0, 1.6])
    >>> dict(grid.sizes), round(float(grid.frequency.sel(stiffness=1000, drive_speed=1.0)), 5)
    ({'stiffness': 2, 'drive_speed': 3}, 3.94031)
    """
    import xarray as xr

    if not isinstance(drag, Drag) or drag.varies_with_temperature:
        raise ParameterError("a sweep needs a Drag at one temperature")
    if start not in ("rest", "steady"):
        raise ParameterError(f"start '{start}' is not known: rest or steady")
    workers, steps = whole("threads", threads), whole("most_steps", most_steps)
    parameters: dict[str, Any] = {**vars(train), **vars(drag)}
    varied = {
        "stiffness": stiffness,
        "mass": mass,
        "transition_force": transition_force,
        "transition_speed": transition_speed,
        "ehl_exponent": ehl_exponent,
        "mixed_exponent": mixed_exponent,
        "stick_speed": stick_speed,
        "drive_speed": drive_speed,
    }
    given = {
        name: numbers_of(name, parameters[name] if value is None else value) for name, value in varied.items()
    }
    refuse_too_many(given.values(), zip=zip)
    axes, columns = together(given) if zip else crossed(given)
    shape = next(iter(columns.values())).shape
    motions = _core.sweep(
        [np.ascontiguousarray(columns[name].ravel()) for name in PARAMETERS],
        (drag.closure, drag.bristle_stiffness, drag.bristle_damping),
        drag.beside(int(np.prod(shape))),
        train.grip,
        start == "steady",
        None if duration is None else float(duration),
        float(tolerance),
        workers,
        progress,
        steps,
    )
    data = {name: (axes, getattr(motions, name).reshape(shape)) for name in NUMBERS}
    stuck = motions.stick_duration * motions.frequency
    coordinates = {
        name: (axes, columns[name]) if zip and given[name].ndim else given[name] for name in PARAMETERS
    }
    return xr.Dataset(
        {
            "kind": (axes, np.array(_core.KINDS)[motions.kind_index].reshape(shape)),
            **data,
            "stuck_fraction": (axes, stuck.reshape(shape)),
            "laps": (axes, motions.laps.reshape(shape)),
        },
        coords=coordinates,
        attrs={
            "closure": drag.closure,
            "start": start,
            "tolerance": tolerance,
            "hersey_version": _core.VERSION,
            "failures": [f"set {failure.index}: {failure.error}" for failure in motions.failures],
        },
    )
