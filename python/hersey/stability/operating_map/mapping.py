"""From a fitted surface and a machine to the operating map."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from hersey.arrays import FloatArray
from hersey.damping.surface import DampingSurface, what_to_record
from hersey.errors import InsufficientDataError, ParameterError
from hersey.machine.limits import OperatingPoint
from hersey.machine.machine import Machine
from hersey.motion.drag import DragTable, PowerDrag
from hersey.stability.operating_map.edges import GivenEdges, contour, edges_at, laws_at, shown_laws
from hersey.stability.operating_map.intervals import FOLD_DRAWS, Drawing, Intervals, intervals
from hersey.stability.operating_map.map_warnings import warnings_of
from hersey.stability.operating_map.result import OperatingMap
from hersey.stability.operating_map.state import PlacedPoint
from hersey.stability.operating_map.window import shown_speeds, shown_temperatures
from hersey.units import takes_si

if TYPE_CHECKING:
    from distributed import Client


@takes_si(temperatures="temperature", speeds="belt speed")
def operating_map(
    surface: DampingSurface,
    machine: Machine,
    *,
    temperatures: ArrayLike | None = None,
    speeds: ArrayLike | None = None,
    seed: int = 0,
    draws: int = FOLD_DRAWS,
    threads: int = 1,
    client: Client | str | None = None,
) -> OperatingMap:
    """Return the map of smooth running and stick-slip over temperature and drive speed.

    Parameters
    ----------
    surface
        The fitted surface; it must have a transition.
    machine
        Machine from its file (`hersey.read_machine`), or made in Python. Its stick speed applies at the fit's
        reference temperature unless it states another, and moves with the transition speed. ``motor_torque``,
        or ``roll_friction`` with ``nip_load``, among its limits gives the stall. Its operating points are
        judged. The uncertainty of ``stiffness``, ``mass`` and ``stick_speed`` is included in the interval of
        V*; the fit determines other parameters better.
    temperatures
        Temperatures, K, ascending. Default: slightly more than the measured range and the points.
    speeds
        Speeds, m/s, ascending. Default: the range of the bands, the dwells and the points.
    seed
        Random seed of the intervals.
    draws, threads
        Number of draws and threads for the interval of V*, which takes most of the time.
    client
        A ``distributed.Client``, or the address of a scheduler, whose workers compute the interval of V*, one
        temperature each. On one machine threads are faster; several machines help from about 10,000 draws.

    Raises
    ------
    InsufficientDataError
        If the data show no falling branch, so there is no stick-slip to map.
    ParameterError
        If a value is out of range, with its name, or the surface was fitted to the whole torque although the
        machine states a no-load torque.

    Examples
    --------
    >>> from hersey import fit, read
    >>> surface = fit(read("examples/bench.csv").steady(tare="standing"))
    >>> machine = Machine(stiffness=11e3, mass=11.0, roll_radius=0.015, stick_speed=1.3e-3)
    >>> map_ = operating_map(surface, machine)
    >>> [map_.state_at(temperature="180 degC", speed=v).state for v in (0.02, 0.045, 0.2)]
    ['stick_slip', 'bistable', 'smooth']
    """
    _check(surface, draws)
    surface.refuse_whole_torque(machine.rest)
    sticking = {name: value for name, value in machine.belt.items() if name not in ("roll_radius", "rest")}
    first = surface.stick_speed_at(surface.reference_temperature, **sticking)
    train, radius, rule = machine.train, machine.roll_radius, machine.stick_speed_rule
    drag = replace(surface.drag(roll_radius=radius, stick_speed=first), measured=None)
    known = dict(machine.uncertainty)
    if "stick_speed" in known:  # stated with the stick speed, so at its temperature
        known["stick_speed"] = known["stick_speed"].times(first / machine.stick_speed)
    kelvin = shown_temperatures(surface, drag, machine.points, temperatures)
    edges = edges_at(train, drag, kelvin, rule)
    drawing = Drawing.of(surface, replace(machine, uncertainty=known), drag, draws, seed)
    found = intervals(drawing, kelvin, threads=threads, client=client)
    holding = np.array([law.holding_force for law in laws_at(drag, kelvin, rule)])
    edges = edges | {"holding": holding * radius}
    return _drawn(surface, machine, drag, kelvin, edges, found, speeds)


def _check(surface: DampingSurface, draws: int) -> None:
    """Refuse what no map can be made of."""
    if draws < 1:
        raise ParameterError(f"draws is {draws}: it must be at least 1")
    if surface.transition is None:
        raise InsufficientDataError(
            f"no operating map: the data show no transition ({surface.rejected_transition}). "
            f"{what_to_record(surface)}"
        )


def given_map(
    surface: DampingSurface,
    machine: Machine,
    drag: DragTable,
    edges_of: Callable[[FloatArray | None], GivenEdges],
) -> OperatingMap:
    """Return a map whose edges were found elsewhere, from a posterior of drives.

    Parameters
    ----------
    surface
        The fit, for the ranges of its dwells.
    machine
        As in `operating_map`.
    drag
        The typical drag, whose torque is shown.
    edges_of
        Edges at the temperatures (K; None if isothermal) of the map.
    """
    roll_radius = machine.roll_radius
    kelvin = shown_temperatures(surface, drag, machine.points, None)
    given = edges_of(kelvin)
    edges = {
        "lower": given.transition,
        "transition": given.transition,
        "upper": np.maximum(given.upper, given.transition),
        "holding": given.holding * roll_radius,
    }
    found = Intervals(
        given.transition_interval,
        given.upper_interval,
        given.holding_interval * roll_radius,
        given.uncertain,
        (),
    )
    return _drawn(surface, machine, drag, kelvin, edges, found, None)


def _drawn(
    surface: DampingSurface,
    machine: Machine,
    drag: PowerDrag,
    kelvin: FloatArray | None,
    edges: dict[str, FloatArray],
    found: Intervals,
    speeds: ArrayLike | None,
) -> OperatingMap:
    """The map of edges (m/s) and starting torques (N m, ``holding``), with torque, stall and points."""
    train, limits, roll_radius = machine.train, machine.limits, machine.roll_radius
    measured_speed = surface.speed_range[0] * roll_radius, surface.speed_range[1] * roll_radius
    speed_grid = shown_speeds(edges, measured_speed, machine.points, limits.speed, speeds)
    laws = shown_laws(drag, kelvin, machine.stick_speed_rule)
    limit, limited_by = torque_limit(train.grip, limits.motor_torque, roll_radius)
    below, above = contour(laws, np.inf if limit is None else limit / roll_radius)
    map_ = OperatingMap(
        temperature=kelvin,
        speed=speed_grid,
        **edges,
        transition_interval=found.transition,
        upper_interval=found.upper,
        stall_below=below,
        stall_above=above,
        torque=np.array([law.force(speed_grid) for law in laws]) * roll_radius,
        holding_interval=found.holding,
        torque_limit=limit,
        limited_by=limited_by,
        speed_limit=limits.speed,
        measured_temperature=surface.temperature_range if drag.varies_with_temperature else None,
        measured_speed=measured_speed,
        points=(),
        uncertain=found.uncertain,
        warnings=(),
        roll_radius=float(roll_radius),
        train=train,
        drag=drag,
        stick_speed_rule=machine.stick_speed_rule,
    )
    placed = tuple(_placed(map_, point) for point in machine.points)
    return replace(map_, points=placed, warnings=(*found.warnings, *warnings_of(map_, placed)))


def torque_limit(
    grip: float | None, motor_torque: float | None, roll_radius: float
) -> tuple[float | None, str]:
    """The torque on the roll (N m) at which it slips or the motor gives up, and which."""
    known = []
    if grip is not None:
        known.append((grip * roll_radius, "grip"))
    if motor_torque is not None:
        known.append((motor_torque, "motor torque"))
    return min(known) if known else (None, "")


def _placed(map_: OperatingMap, point: OperatingPoint) -> PlacedPoint:
    temperature = point.temperature if map_.drag.varies_with_temperature else None
    return PlacedPoint(
        point.name, point.speed, point.temperature, map_.state_at(temperature=temperature, speed=point.speed)
    )
