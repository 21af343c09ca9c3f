"""The band of each of many combinations of parameters: in threads, or by the workers of a cluster."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hersey import _core
from hersey.arrays import FloatArray, crossed, numbers_of, refuse_unknown, refuse_without_xarray, together
from hersey.errors import ParameterError
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import BESIDE, Drag
from hersey.motion.following import usual_chunk
from hersey.motion.parameters import KINDS, OF_THE_BELT, refuse_too_many, whole
from hersey.motion.work import ALONE, HELD, Work
from hersey.scale.cluster import connected, threads_of
from hersey.scale.tasks import done
from hersey.units import takes_si

if TYPE_CHECKING:
    import xarray as xr
    from distributed import Client

    from hersey.scale.local import LocalWorkers

#: Relative tolerance of the steps: the fold asks for more digits than a trajectory.
TOLERANCE = 1e-11
#: Columns of the core.
_COLUMNS = (
    "lower",
    "transition",
    "upper",
    "stalls",
    "speed_max",
    "lower_accuracy",
    "upper_accuracy",
    "half_laps",
    "deeper",
    "laps",
)
#: Kinds of the units of what a sweep of bands varies.
PARAMETER_KINDS = {name: kind for name in OF_THE_BELT if (kind := KINDS[name]) is not None}
#: Bands that are timed before work is cut into tasks.
_TRIED = 4
#: Parameters that follow from a temperature.
_MOVED = ("transition_force", "transition_speed", "stick_speed")
#: Columns that are no decimal numbers.
_WHOLE = {"stalls": bool, "half_laps": bool, "deeper": bool, "laps": int}


@takes_si(temperature="temperature", **PARAMETER_KINDS)
def hysteresis_sweep(
    train: Drivetrain,
    drag: Drag,
    *,
    temperature: ArrayLike | None = None,
    zip: bool = False,  # noqa: A002 - NumPy users know what it means
    lower: bool = True,
    work: Work = ALONE,
    **varied: ArrayLike,
) -> xr.Dataset:
    """Return the band of each combination of parameters, as `hysteresis` does for one.

    Parameters
    ----------
    temperature
        Temperature, K; needed if the drag depends on it, instead of the transition force and all speeds.
    zip
        As in `sweep`.
    lower
        Whether to compute the lower edge too. Without it (NaN) the sweep takes four fifths of the time.
    work
        As in `sweep`, with a default tolerance of 1e-11; ``most_steps`` is that of `hysteresis`. On one
        machine, threads are as fast as workers.
    **varied
        Any of ``stiffness`` (N/m), ``mass`` (kg), ``transition_force`` (N), ``transition_speed`` (m/s),
        ``ehl_exponent``, ``mixed_exponent`` and ``stick_speed`` (m/s): numbers or arrays; those not given
        are those of ``train`` and ``drag``.

    Returns
    -------
    xarray.Dataset
        ``lower``, ``transition``, ``upper``, ``speed_max``, accuracies, ``half_laps``, ``deeper``, ``laps``.

    Examples
    --------
    >>> drag = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    >>> hysteresis_sweep(Drivetrain(1000, 1), drag, stiffness=[500, 2000]).upper.round(6).values.tolist()
    [2.228999, 2.109731]
    """
    refuse_without_xarray("hysteresis_sweep")
    import xarray as xr

    refuse_unknown("hysteresis_sweep", varied, OF_THE_BELT, HELD)
    _check(drag, varied, temperature)
    drag = drag.warned(temperature, stacklevel=3)
    swept = sweep_bands(train, drag, varied, temperature=temperature, zip=zip, lower=lower, work=work)
    return xr.Dataset(
        {name: (swept.axes, values) for name, values in swept.columns.items()},
        coords=swept.coordinates,
        attrs={
            "closure": drag.closure,
            "tolerance": work.within(TOLERANCE),
            "hersey_version": _core.VERSION,
            "failures": list(swept.failures),
        },
    )


@dataclass(frozen=True)
class SweptBands:
    """The bands of a sweep as arrays: ``columns`` by the names of `hysteresis_sweep`, over ``axes``."""

    axes: tuple[str, ...]
    columns: Mapping[str, NDArray[Any]]
    coordinates: Mapping[str, Any]
    failures: tuple[str, ...]


def sweep_bands(
    train: Drivetrain,
    drag: Drag,
    varied: Mapping[str, ArrayLike | None],
    *,
    temperature: ArrayLike | None = None,
    zip: bool = False,  # noqa: A002 - NumPy users know what it means
    lower: bool = True,
    work: Work = ALONE,
) -> SweptBands:
    """Return what `hysteresis_sweep` does, as arrays: xarray takes long to import.

    ``varied`` holds parameters by the names of that; one that is None or not there is that of train or drag.
    """
    _check(drag, varied, temperature)
    parameters = {**vars(train), **vars(drag)}
    asked = {name: values for name, values in varied.items() if values is not None}
    given = {name: numbers_of(name, asked.get(name, parameters[name])) for name in OF_THE_BELT}
    if temperature is not None:
        given["temperature"] = numbers_of("temperature", temperature)
    refuse_too_many(given.values(), zip=zip)
    axes, columns = together(given) if zip else crossed(given)
    shape = next(iter(columns.values())).shape
    if temperature is not None:
        columns = {**columns, **_at_temperatures(drag, columns["temperature"])}
    rules = BandRules(train, drag, work.within(TOLERANCE), whole("most_steps", work.most_steps), lower)
    flat = {name: np.ascontiguousarray(column.ravel()) for name, column in columns.items()}
    workers = whole("threads", work.threads)
    if work.client is None:
        values, failures = _bands_of(0, rules.follow(flat, workers, work.progress))
    else:
        values, failures = _by_workers(rules, flat, work.client, work.progress)
    coordinates = {
        name: (axes, columns[name]) if zip and values.ndim else values
        for name, values in given.items()
        if temperature is None or name not in _MOVED
    }
    return SweptBands(
        tuple(axes),
        {name: values[name].reshape(shape).astype(_WHOLE.get(name, float)) for name in _COLUMNS},
        coordinates,
        tuple(f"set {index}: {text}" for index, text in failures),
    )


def _check(drag: Drag, varied: Mapping[str, ArrayLike | None], temperature: ArrayLike | None) -> None:
    """Refuse a drag and parameters that do not go with the temperature."""
    if not isinstance(drag, Drag):
        raise ParameterError("a sweep needs a Drag")
    if drag.varies_with_temperature != (temperature is not None):
        drag.law_at(None if temperature is None else 300.0)
    clash = [name for name in _MOVED if temperature is not None and varied.get(name) is not None]
    if clash:
        raise ParameterError(f"{clash[0]} follows from the temperature. Give only one of them")


def _at_temperatures(drag: Drag, temperatures: FloatArray) -> dict[str, FloatArray]:
    """The parameters that vary with temperature, at each."""
    values, place = np.unique(temperatures, return_inverse=True)
    laws = [drag.unwarned().at(float(t)) for t in values]
    beside = tuple(name for name in BESIDE if getattr(drag, name))
    names = ("transition_force", "transition_speed", "stick_speed", *beside)
    place = place.reshape(temperatures.shape)
    return {name: np.array([getattr(law, name) for law in laws])[place] for name in names}


@dataclass(frozen=True)
class BandRules:
    """What holds for the band of every set."""

    train: Drivetrain
    drag: Drag
    tolerance: float
    most_steps: int
    lower: bool = True

    def follow(
        self,
        columns: Mapping[str, FloatArray],
        threads: int = 1,
        progress: Callable[[int, int], object] | None = None,
    ) -> _core.Bands:
        """Return the band of each set; ``columns`` holds each parameter of every one, shape (sets,)."""
        arrays = [np.ascontiguousarray(columns[name]) for name in OF_THE_BELT]
        closure = (self.drag.closure, self.drag.bristle_stiffness, self.drag.bristle_damping)
        beside = self.drag.beside(arrays[0].size)
        if beside is not None:
            # those that vary with temperature have a column of their own
            beside = [
                np.ascontiguousarray(columns[name]) if name in columns else column
                for name, column in zip(BESIDE, beside, strict=True)
            ]
        grip = None if self.train.grip is None else float(self.train.grip)
        return _core.bands(
            arrays, closure, beside, grip, self.lower, self.tolerance, threads, progress, self.most_steps
        )


@dataclass(frozen=True)
class _Part:
    """Sets that one task takes: the index of the first among all, and their columns."""

    first: int
    columns: Mapping[str, FloatArray]

    @property
    def size(self) -> int:
        return int(self.columns["mass"].size)


#: Numbers of bands by name, and the index and reason of each that failed.
_Bands = tuple[dict[str, NDArray[Any]], list[tuple[int, str]]]


def _bands_of(first: int, bands: _core.Bands) -> _Bands:
    failures = [(first + failure.index, str(failure.error)) for failure in bands.failures]
    return {name: getattr(bands, name) for name in _COLUMNS}, failures


def _of_part(rules: BandRules, part: _Part) -> _Bands:
    """Return the bands of a part where this runs."""
    return _bands_of(part.first, rules.follow(part.columns))


def _by_workers(
    rules: BandRules,
    columns: Mapping[str, FloatArray],
    client: Client | LocalWorkers | str,
    progress: Callable[[int, int], object] | None,
) -> _Bands:
    """Return the bands as workers find them, each task some seconds of them."""
    sets = columns["mass"].size
    _refuse_early(rules, columns)
    with connected(client) as (known, _):
        each = usual_chunk(sets, _time_of_one(rules, columns), max(threads_of(known), 1))
        parts = [
            _Part(first, {name: column[first : first + each] for name, column in columns.items()})
            for first in range(0, sets, each)
        ]
        found: list[_Bands | None] = [None] * len(parts)
        task = partial(_of_part, rules)
        for index, bands in done(task, parts, client=known, progress=progress, size=lambda part: part.size):
            found[index] = bands
    ended = [bands for bands in found if bands is not None]
    values = {name: np.concatenate([columns[name] for columns, _ in ended]) for name in _COLUMNS}
    return values, [failure for _, failures in ended for failure in failures]


def _refuse_early(rules: BandRules, columns: Mapping[str, FloatArray]) -> None:
    """Have the core look at every set, which it does before it begins with the first."""

    class Begun(Exception):  # noqa: N818 - no error
        pass

    def begun(_done: int, _all: int) -> None:
        raise Begun

    with suppress(Begun):
        rules.follow(columns, progress=begun)


def _time_of_one(rules: BandRules, columns: Mapping[str, FloatArray]) -> float:
    """Time that a band takes here, s: the mean of some, spread over all."""
    some = np.unique(np.linspace(0, columns["mass"].size - 1, _TRIED).astype(int))
    sample = {name: column[some] for name, column in columns.items()}
    begun = time.perf_counter()
    rules.follow(sample)
    return (time.perf_counter() - begun) / some.size
