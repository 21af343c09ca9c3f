"""What the laws are fitted to: dwells in logarithms, with the errors of torque, speed and temperature."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.damping.dwells import (
    SAME_SPEED,
    SteadyPoints,
    distinct_speeds,
    groups_of_temperature,
    held_for_few_rows,
)
from hersey.damping.dwells.constant import refuse_constant_torque
from hersey.damping.dwells.least_duration import speeds_lost
from hersey.damping.dwells.misleading import lagging, one_direction, unlinked_runs
from hersey.damping.dwells.one_speed import is_one_speed, of_one_speed
from hersey.damping.dwells.several_loads import (
    refuse_several_loads,
    refuse_traction_curve,
    refuse_unused_load,
)
from hersey.errors import InsufficientDataError
from hersey.log.means import MeansTable
from hersey.log.torque_log import TorqueLog
from hersey.schema.domain import TORQUE, Domain

#: Change of temperature from dwell to dwell, K, that ends a stay.
STEP = 6.0
#: Runs from which on they are resampled and excluded whole; fewer say too little of their spread.
MANY_RUNS = 8


@dataclass(frozen=True)
class Inputs:
    """Where a law is evaluated."""

    log_speed: FloatArray  #: ln(w/w_ref), shape (points,)
    kelvin: FloatArray | None  #: K, shape (points,); None if the log has no temperature
    group: IntArray  #: index of the temperature, coldest first, shape (points,)
    sign: FloatArray | None = None  #: of the rotation, 1 or -1, shape (points,); None: forward

    @cached_property
    def shapes(self) -> dict[object, tuple[FloatArray, FloatArray, FloatArray]]:
        """What laws of temperature are at these temperatures, as far as they were asked for."""
        return {}

    def take(self, index: IntArray) -> Inputs:
        """Return the inputs at an index."""
        kelvin = None if self.kelvin is None else self.kelvin[index]
        sign = None if self.sign is None else self.sign[index]
        return Inputs(self.log_speed[index], kelvin, self.group[index], sign)


@dataclass(frozen=True)
class Observations:
    """Dwells: logarithm of torque about nothing, in N m, at inputs, with relative standard errors."""

    inputs: Inputs
    log_torque: FloatArray  #: ln(torque / N m)
    torque_error: FloatArray  #: relative
    speed_error: FloatArray  #: relative
    temperature_error: FloatArray  #: K
    #: of ``log_torque`` by a standard error of each error of zero and rest, shape (points, errors)
    tare: FloatArray
    visit: IntArray  #: which stay at a temperature a dwell belongs to, shape (points,)
    run: IntArray
    cluster: IntArray  #: points that share it are excluded and resampled together
    clustered_by: str  #: ``run`` or ``level``
    reference_speed: float  #: rad/s
    reference_kelvin: float | None
    temperatures: FloatArray  #: K, mean of each group, shape (groups,)
    #: standard error of the heating of the film by friction, K, shape (points,); (0,) where none is declared
    heating: FloatArray = field(default_factory=lambda: np.empty(0))
    #: by how much hysteresis of the torque sensor may move each torque: 1 where all speeds of the log were
    #: approached from below, -1 where from above, shape (points,); (0,) where both directions check it
    direction: FloatArray = field(default_factory=lambda: np.empty(0))
    #: how fast the reading of temperature changed over each dwell, K/s, shape (points,); (0,) if steady
    temperature_rate: FloatArray = field(default_factory=lambda: np.empty(0))
    #: which runs share temperatures with one another, shape (points,); (0,) where all do
    unlinked: IntArray = field(default_factory=lambda: np.empty(0, dtype=np.intp))
    domain: Domain = TORQUE  #: what "torque" and "speed" are

    @classmethod
    def of(cls, points: SteadyPoints, *, fewest_speeds: int = 3) -> Observations:
        """Return the observations that steady points are, if they have so many speeds and torque varies.

        Raises
        ------
        InsufficientDataError
            If they have fewer, or if torque stands still (which it may where one speed is enough).
        """
        speed, torque = np.abs(points.column("speed")), np.abs(points.column("torque"))
        if distinct_speeds(speed) < fewest_speeds:
            unit, factor = points.domain.shown_speed
            levels = sorted({f"{factor * w:.3g}" for w in speed}, key=float)[:2]
            held = " and ".join(f"{level} {unit}" for level in levels)
            if points.of_every_sample:
                raise InsufficientDataError(
                    f"all windows of speed are at {held}", remedy="record a wider range of speeds"
                )
            refuse_traction_curve(points, held)
            if lost := speeds_lost(points):
                raise InsufficientDataError(f"all dwells are at {held}: {lost}")
            more = f"all dwells are at {held}. Record dwells at three or more speeds"
            if isinstance(points.log, TorqueLog):
                if is_one_speed(points.log):
                    raise of_one_speed(more, points.log)
                if few := held_for_few_rows(points.log):
                    raise InsufficientDataError(few)
            raise InsufficientDataError(more)
        if fewest_speeds > 1:
            refuse_constant_torque(points)
            refuse_several_loads(points)
            refuse_unused_load(points)
        kelvin = points.column("temperature") if points.log.has_temperature else None
        group, means = _groups(kelvin, speed.size)
        run = points.column("run").astype(np.intp)
        # a file for each dwell is ordered by its name, a table as it was typed
        unordered = isinstance(points.log, MeansTable) or np.unique(run).size > run.size // 2
        visit = _stays(run, group) if unordered else _visits(run, kelvin)
        heating = np.empty(0)
        if kelvin is not None and points.log.sensors.film_heating:  # visits are stays of what is read
            kelvin, heating = _heated(kelvin, torque * speed, points.log.sensors.film_heating)
        by_run = np.unique(run).size >= MANY_RUNS
        reference = float(np.exp(np.mean(np.log(speed))))
        return cls(
            inputs=Inputs(np.log(speed / reference), kelvin, group, np.sign(points.column("speed"))),
            log_torque=np.log(torque),
            torque_error=points.column("torque_error") / torque,
            speed_error=points.column("speed_error") / speed,
            temperature_error=np.zeros_like(speed) if kelvin is None else points.column("temperature_error"),
            tare=points.zero_errors / points.column("torque")[:, None],
            visit=visit,
            run=run,
            cluster=run if by_run else _levels(run, group, speed),
            clustered_by="run" if by_run else "level",
            reference_speed=reference,
            reference_kelvin=None if kelvin is None else float(1.0 / np.mean(1.0 / kelvin)),
            temperatures=means,
            heating=heating,
            direction=one_direction(points),
            temperature_rate=lagging(points),
            unlinked=unlinked_runs(points),
            domain=points.domain,
        )

    def __len__(self) -> int:
        """Return how many dwells there are."""
        return int(self.log_torque.size)

    @property
    def speed(self) -> FloatArray:
        """Speeds, rad/s."""
        return np.asarray(self.reference_speed * np.exp(self.inputs.log_speed))

    def take(self, index: IntArray) -> Observations:
        """Return the observations at an index, repeats allowed, about the same reference."""
        taken: dict[str, Any] = {
            name: values[index]
            for name, values in vars(self).items()
            if isinstance(values, np.ndarray) and len(values) and name != "temperatures"
        }
        return replace(self, inputs=self.inputs.take(index), **taken)

    def at(self, speed: FloatArray, kelvin: FloatArray | None) -> Inputs:
        """Return inputs at other speeds (rad/s) and temperatures (K), grouped with the nearest measured."""
        speeds = np.atleast_1d(np.asarray(speed, dtype=np.float64))
        z = np.log(speeds / self.reference_speed)
        if self.inputs.kelvin is None or kelvin is None:
            return Inputs(z, None, np.zeros(z.size, dtype=np.intp))
        hot = np.broadcast_to(np.asarray(kelvin, dtype=np.float64), z.shape).copy()
        nearest = np.argmin(np.abs(hot[:, None] - self.temperatures[None, :]), axis=1)
        return Inputs(z, hot, nearest.astype(np.intp))


def _groups(kelvin: FloatArray | None, count: int) -> tuple[IntArray, FloatArray]:
    group = np.zeros(count, dtype=np.intp)
    if kelvin is None:
        return group, np.empty(0)
    means = []
    for index, members in enumerate(groups_of_temperature(kelvin)):
        group[members] = index
        means.append(float(np.mean(kelvin[members])))
    return group, np.array(means)


def _heated(kelvin: FloatArray, power: FloatArray, bound: float) -> tuple[FloatArray, FloatArray]:
    """Temperature of a film that friction heats, K, by anything between 0 and a bound; its standard error."""
    share = power / power.max()
    return kelvin + 0.5 * bound * share, bound / 12.0**0.5 * share


def _visits(run: IntArray, kelvin: FloatArray | None) -> IntArray:
    """Stays at a temperature, of dwells in their order: one ends with a step of temperature, or the run.

    A step is more than `STEP`, or less where dwells of one stay differ by much less.
    """
    changes = np.diff(run) != 0
    if kelvin is not None:
        steps = np.abs(np.diff(kelvin))
        changes |= steps > min(STEP, max(2.0, 10.0 * float(np.median(steps))))
    return np.cumsum(np.append(0, changes))


def _stays(run: IntArray, group: IntArray) -> IntArray:
    """Visits of dwells that stand in no order of time: all dwells of a run at one temperature."""
    several = np.unique(run).size <= run.size // 2
    _, stay = np.unique(np.column_stack([run * several, group]), axis=0, return_inverse=True)
    return np.asarray(stay, dtype=np.intp)


def _levels(run: IntArray, group: IntArray, speed: FloatArray) -> IntArray:
    """Dwells of one run at one temperature and one speed, whatever the order in which they were held."""
    order = np.argsort(speed, kind="stable")
    step = np.empty(speed.size, dtype=np.intp)
    step[order] = np.cumsum(np.append(0, np.diff(np.log(speed[order])) > SAME_SPEED))
    _, level = np.unique(np.column_stack([run, group, step]), axis=0, return_inverse=True)
    return np.asarray(level, dtype=np.intp)
