"""A friction force, or a coefficient, against sliding speed, as the torque and the speed of a rotation.

The torque is the force times the radius at which it acts, the force the coefficient times the normal load,
the speed of rotation that of sliding over the radius. Radius and load are channels, or the user says them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import HerseyError, ParameterError, UnitError
from hersey.log.channels import ChannelChoice, Stated, find_channel, role_conversion
from hersey.log.text.layout import Column
from hersey.log.torque_log import LogFile, Run
from hersey.units import Conversion

Chosen = dict[str, tuple[Column, Conversion]]
#: Examples of what the user may say, by role.
_EXAMPLES = {"radius": "25 mm", "load": "50 N"}


def beside(
    columns: tuple[Column, ...],
    choices: Mapping[str, ChannelChoice],
    stated: Stated,
    chosen: Chosen,
    file: str,
    dead: Callable[[Column], bool] = lambda _: False,
) -> Chosen:
    """Return the columns of load, radius and number of the run that are named, needed or leave no doubt.

    Raises
    ------
    ChannelError, UnitError
        If torque or speed cannot be had without a radius or a load; the message says how to give it.
    """
    others: Chosen = {}
    left = tuple(c for c in columns if all(c != column for column, _ in chosen.values()))
    for role in ("load", "radius", "run"):
        needs = _needing(role, chosen)
        choice = choices.get(role, ChannelChoice())
        if choice.name:
            channel = find_channel(role, left, choice, file)
        elif role == "run" or getattr(stated, role) is not None or (role == "radius" and not needs):
            continue
        else:
            channel = _found(role, left, choice, file, dead, sure=bool(needs))
        if channel is not None:
            others[role] = channel
        elif needs:
            raise UnitError(f"{file}: {needs}: say it with --{role} '{_EXAMPLES[role]}', or name its column")
    return others


def spare(chosen: Chosen, choices: Mapping[str, ChannelChoice]) -> frozenset[str]:
    """Return the roles whose columns are read if they can be, and cost no row otherwise: an unasked load."""
    asked = choices.get("load", ChannelChoice()).name or _needing("load", chosen)
    return frozenset() if asked else frozenset({"load"})


def in_rotation(arrays: dict[str, FloatArray], chosen: Chosen, stated: Stated) -> dict[str, FloatArray]:
    """Return torque, N m, and speed, rad/s, from what the columns hold, in SI; the load, N, where known.

    A row without a number that is needed gets none.
    """
    kinds = {role: role_conversion(role, chosen[role][1].unit)[0] for role in ("torque", "speed")}
    rows = arrays["torque"].shape
    known = {role: arrays[role] for role in ("load", "radius") if role in arrays}
    for role in ("load", "radius"):
        if (value := getattr(stated, role)) is not None:
            known[role] = np.full(rows, 1.0 if isinstance(value, tuple) else value)  # see `of_each_run`
    if "radius" in known:
        known["radius"] = np.where(known["radius"] > 0, known["radius"], np.nan)
    if "load" in known:
        arrays["load"] = known["load"]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        if kinds["torque"] == "friction coefficient":
            arrays["torque"] = arrays["torque"] * known["load"]
        if kinds["torque"] != "torque":
            arrays["torque"] = arrays["torque"] * known["radius"]
        if kinds["speed"] != "speed":
            arrays["speed"] = arrays["speed"] / known["radius"]
    arrays.pop("radius", None)
    return arrays


def notes_on(chosen: Chosen, stated: Stated) -> list[str]:
    """Return what was computed to have a torque and a speed of rotation, in words."""
    places = {
        role: f"'{chosen[role][0].path}'" if role in chosen else _said(value, unit)
        for role, unit in (("radius", "m"), ("load", "N"))
        if role in chosen or (value := getattr(stated, role)) is not None
    }
    told = []
    kind = role_conversion("torque", chosen["torque"][1].unit)[0]
    if kind != "torque":
        load = f"load ({places['load']}) x " if kind == "friction coefficient" else ""
        told.append(f"torque is '{chosen['torque'][0].path}' x {load}radius ({places['radius']})")
    if role_conversion("speed", chosen["speed"][1].unit)[0] != "speed":
        told.append(f"speed is '{chosen['speed'][0].path}' / radius ({places['radius']})")
    if "load" in places:
        told.append(f"the load is {places['load']}")
    return told


def of_each_run(runs: list[tuple[Run, LogFile]], stated: Stated) -> list[tuple[Run, LogFile]]:
    """Return runs, read with a load or a radius of 1, with those that are stated for each of them.

    Raises
    ------
    ParameterError
        If there are not as many of them as runs.
    """
    for role in ("load", "radius"):
        values = getattr(stated, role)
        if not isinstance(values, tuple):
            continue
        if len(values) != len(runs):
            raise ParameterError(f"{role} has {len(values)} values for {len(runs)} runs: give one for each")
        runs = [(_scaled(run, log, role, value), log) for (run, log), value in zip(runs, values, strict=True)]
    return runs


def _scaled(run: Run, log: LogFile, role: str, value: float) -> Run:
    units = {channel.role: channel.unit for channel in log.channels}
    kinds = {of: role_conversion(of, units[of])[0] for of in ("torque", "speed")}
    if role == "load":
        torque = run.torque * value if kinds["torque"] == "friction coefficient" else run.torque
        return replace(run, torque=torque, load=np.full(run.torque.shape, value))
    torque = run.torque * value if kinds["torque"] != "torque" else run.torque
    return replace(run, torque=torque, speed=run.speed / value if kinds["speed"] != "speed" else run.speed)


def _said(value: float | tuple[float, ...], unit: str) -> str:
    return f"one of {len(value)} for each run" if isinstance(value, tuple) else f"{value:g} {unit}"


def _needing(role: str, chosen: Chosen) -> str:
    """Why a load or a radius is needed, or nothing."""
    for of, example in (("torque", "a torque"), ("speed", "a speed of rotation")):
        if of not in chosen:
            continue
        column, unit = chosen[of]
        kind = role_conversion(of, unit.unit)[0]
        if role == "radius" and kind != of:
            what = "sliding speed" if kind == "belt speed" else kind
            return f"'{column}' is a {what}, which is {example} only with the radius"
        if role == "load" and kind == "friction coefficient":
            return f"'{column}' is a {kind}, which is a force only with the normal load"
    return ""


def _found(
    role: str,
    columns: tuple[Column, ...],
    choice: ChannelChoice,
    file: str,
    dead: Callable[[Column], bool],
    *,
    sure: bool,
) -> tuple[Column, Conversion] | None:
    """The column of a role; a doubtful one is left alone unless it is needed."""
    try:
        return find_channel(role, columns, choice, file, dead)
    except HerseyError:
        if sure:
            raise
        return None
