"""A friction force, or a coefficient, against sliding speed, as the torque and the speed of a rotation.

The torque is the force times the radius at which it acts, the force the coefficient times the normal load,
the speed of rotation that of sliding over the radius. Radius and load are channels, or the user says them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import ParameterError
from hersey.log.channels import ChannelChoice, Stated, find_channel
from hersey.log.long_arrays import HELD, Filling, blocks
from hersey.log.roles import role_conversion
from hersey.log.stating import proposals, unstated
from hersey.log.text.column import Column
from hersey.log.torque_log import LogFile, Run
from hersey.schema.warning import Warning
from hersey.units import Conversion, named

Chosen = dict[str, tuple[Column, Conversion]]
#: Kinds of torque and speed that are those of a rotation already.
_OF_ROTATION = {"torque": "torque", "speed": "speed"}


def beside(
    columns: tuple[Column, ...],
    choices: Mapping[str, ChannelChoice],
    stated: Stated,
    chosen: Chosen,
    file: str,
) -> Chosen:
    """Return the columns of load, radius and number of the run that are named.

    A column that nobody named plays none of these roles, whatever its name and unit.

    Raises
    ------
    ChannelError, UnitError
        If a named column is not there or has no unit that its role can have.
    UnstatedRoleError
        If torque or speed cannot be had without a radius or a load that nobody stated.
    """
    others: Chosen = {}
    left = _without(columns, chosen)
    for role in ("load", "radius", "run"):
        choice = choices.get(role, ChannelChoice())
        if choice.name and (channel := find_channel(role, left, choice, file)):
            others[role] = channel
        elif role != "run" and getattr(stated, role) is None:
            why = _needing(role, chosen) or (
                choice.unit and f"a unit is given for the {role}, but no value or column"
            )
            if why:
                of = _in_need(role, chosen)
                raise unstated(file, role, why, left, chosen[of][0] if of else None)
    return others


def unused(columns: tuple[Column, ...], chosen: Chosen, stated: Stated) -> list[Warning]:
    """Return which columns may be the normal load that nobody stated, and how to state it."""
    if "load" in chosen or stated.load is not None:
        return []
    return proposals("load", _without(columns, chosen))


def _without(columns: tuple[Column, ...], chosen: Chosen) -> tuple[Column, ...]:
    return tuple(c for c in columns if all(c != column for column, _ in chosen.values()))


def slow_roles(chosen: Chosen) -> frozenset[str]:
    """Return the roles that may be slow: interpolated between values, so no load that makes the torque."""
    of_coefficient = _kinds(chosen).get("torque") == "friction coefficient"
    return frozenset({"temperature"} if of_coefficient else {"temperature", "load"})


def in_rotation(arrays: dict[str, FloatArray], chosen: Chosen, stated: Stated) -> dict[str, FloatArray]:
    """Return torque, N m, and speed, rad/s, from what the columns hold, in SI; the load, N, where known.

    A row without a number that is needed gets none.
    """
    kinds, rows = _kinds(chosen), arrays["speed"].size
    if is_rotation(chosen) and stated.load is None:
        arrays.pop("radius", None)
        return arrays
    if rows <= HELD:
        return _in_rotation(arrays, kinds, stated)
    made: dict[str, Filling] = {}
    for block in blocks(rows, *arrays.values()):
        part = {role: values[block] for role, values in arrays.items()}
        for role, values in _in_rotation(part, kinds, stated).items():
            made.setdefault(role, Filling()).add(values, block.stop / rows)
    return {role: each.whole() for role, each in made.items()}


def is_rotation(chosen: Chosen) -> bool:
    """Return whether torque and speed are those of a rotation as they were recorded."""
    return all(kind == _OF_ROTATION[role] for role, kind in _kinds(chosen).items())


def rotating(chosen: Mapping[str, Any]) -> tuple[str, ...]:
    """Return which of torque and speed a log has: a coast-down has no torque."""
    return tuple(role for role in _OF_ROTATION if role in chosen)


def _kinds(chosen: Chosen) -> dict[str, str]:
    return {role: role_conversion(role, chosen[role][1].unit)[0] for role in rotating(chosen)}


def _in_rotation(
    arrays: dict[str, FloatArray], kinds: dict[str, str], stated: Stated
) -> dict[str, FloatArray]:
    rows = arrays["speed"].shape
    known = {role: arrays[role] for role in ("load", "radius") if role in arrays}
    for role in ("load", "radius"):
        if (value := getattr(stated, role)) is not None:
            known[role] = np.full(rows, 1.0 if isinstance(value, tuple) else value)  # see `of_each_run`
    if "radius" in known:
        known["radius"] = np.where(known["radius"] > 0, known["radius"], np.nan)
    if "load" in known:
        arrays["load"] = known["load"]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        if kinds.get("torque") == "friction coefficient":
            arrays["torque"] = arrays["torque"] * known["load"]
        if kinds.get("torque", "torque") != "torque":
            arrays["torque"] = arrays["torque"] * known["radius"]
        if kinds["speed"] != "speed":
            arrays["speed"] = arrays["speed"] / known["radius"]
    arrays.pop("radius", None)
    return arrays


def computed(chosen: Chosen, stated: Stated) -> list[Warning]:
    """Return what torque and speed were computed from, and where the load is from."""
    known = _source("radius", "m", chosen, stated) | _source("load", "N", chosen, stated)
    kinds = _kinds(chosen)
    paths = {role: chosen[role][0].path for role in kinds}
    out = []
    if kinds.get("torque", "torque") != "torque":
        out.append(
            Warning(
                "torque computed",
                "torque is '{channel}' x load ({load_from}) x radius ({radius_from})"
                if kinds["torque"] == "friction coefficient"
                else "torque is '{channel}' x radius ({radius_from})",
                channel=paths["torque"],
                **known,
            )
        )
    if kinds["speed"] != "speed":
        out.append(
            Warning(
                "speed computed",
                "speed is '{channel}' / radius ({radius_from})",
                channel=paths["speed"],
                **known,
            )
        )
    if known["load_from"]:
        out.append(Warning("load known", "load is {load_from}", **known))
    return out


def _source(role: str, unit: str, chosen: Chosen, stated: Stated) -> dict[str, Any]:
    """A radius or a load in SI where it is one number, and in words where it is from; empty if nowhere."""
    value = getattr(stated, role)
    if role in chosen:
        source = f"'{chosen[role][0].path}'"
    elif isinstance(value, tuple):
        source = f"{len(value)} values, one for each run"
    else:
        source = "" if value is None else f"{value:g} {unit}"
    one = value if role not in chosen and isinstance(value, int | float) else None
    return {role: one, f"{role}_from": source}


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
            raise ParameterError(
                f"{role} has {len(values)} values for {len(runs)} runs. Give one value for each run"
            )
        runs = [(_scaled(run, log, role, value), log) for (run, log), value in zip(runs, values, strict=True)]
    return runs


def _scaled(run: Run, log: LogFile, role: str, value: float) -> Run:
    units = {channel.role: channel.unit for channel in log.channels}
    kinds = {of: role_conversion(of, units[of])[0] for of in rotating(units)}
    if role == "load":
        torque = run.torque * value if kinds.get("torque") == "friction coefficient" else run.torque
        return replace(run, torque=torque, load=np.full(run.torque.shape, value))
    torque = run.torque * value if kinds.get("torque", "torque") != "torque" else run.torque
    return replace(run, torque=torque, speed=run.speed / value if kinds["speed"] != "speed" else run.speed)


def _in_need(role: str, chosen: Chosen) -> str:
    """Which of torque and speed is known only with a load or a radius, or nothing."""
    for of in ("torque", "speed"):
        if of in chosen:
            kind = role_conversion(of, chosen[of][1].unit)[0]
            if (role == "radius" and kind != of) or (role == "load" and kind == "friction coefficient"):
                return of
    return ""


def _needing(role: str, chosen: Chosen) -> str:
    """Why a load or a radius is needed, or nothing."""
    of = _in_need(role, chosen)
    if not of:
        return ""
    column, unit = chosen[of]
    kind = role_conversion(of, unit.unit)[0]
    if role == "load":
        return f"'{column}' is a {kind}, which needs the normal load"
    what = named(kind)
    example = {"torque": "a torque", "speed": "a speed of rotation"}[of]
    return f"'{column}' is a {what}, which needs the radius to become {example}"
