"""What a log measures: a torque, a friction force or a coefficient, and which of them it becomes.

A torque is a force times the radius at which it acts, a force the coefficient times the normal load, a speed
of sliding that of rotation times the radius. Radius and load are channels, or the user says them. What was
measured stays as it is, unless somebody asks for a torque with one radius (and one load for a coefficient).
Several radii or loads give a force or a coefficient against sliding speed, which runs have in common.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.log.channels import ChannelChoice, Stated, find_channel
from hersey.log.long_arrays import HELD, Filling, blocks
from hersey.log.roles import role_conversion
from hersey.log.rolling import entrainment
from hersey.log.stating import proposals, unstated
from hersey.log.text.column import Column
from hersey.schema.domain import QUANTITY_OF, SPEED_OF, Domain
from hersey.schema.warning import Warning
from hersey.units import Conversion

Chosen = dict[str, tuple[Column, Conversion]]
#: Whether one load or radius is known of a whole file, or several; absent where none is.
ONE, SEVERAL = "one", "several"


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
        elif role != "run" and getattr(stated, role) is None and choice.unit:
            why = f"a unit is given for the {role}, but no value or column"
            raise unstated(file, role, why, left)
    kinds = {"torque": "torque"} | _kinds(chosen)
    if kinds == {"torque": "torque", "speed": "belt speed"} and not _known("radius", others, stated):
        column = chosen["speed"][0]
        why = f"'{column}' is a sliding speed, which needs the radius to become a speed of rotation"
        raise unstated(file, "radius", why, _without(columns, chosen | others), column)
    return others


def unused(
    columns: tuple[Column, ...], chosen: Chosen, stated: Stated, numbers: Callable[[Column], FloatArray]
) -> list[Warning]:
    """Return which columns may be a load or radius that nobody stated, and what a slide-roll ratio says.

    ``numbers`` returns those of a column as written.
    """
    kind = _kinds(chosen).get("torque", "torque") if "torque" in chosen else ""
    left, found = _without(columns, chosen), list[Warning]()
    for role in ("load", "radius"):
        counts = kind == "torque" or (kind == "force" and role == "load")
        if not _known(role, chosen, stated):
            found += proposals(role, left, numbers, counts=counts)
    # a torque needs no radius, unless it was recorded at several
    idle = "" if kind in ("force", "friction coefficient") else "radius"
    found = [each for each in found if each.values["role"] != idle or each.severity == "watch"]
    if kind in ("force", "friction coefficient") and measured(chosen).speed == "sliding speed":
        found += entrainment(left, chosen["speed"][0], numbers)
    return found


def _without(columns: tuple[Column, ...], chosen: Chosen) -> tuple[Column, ...]:
    return tuple(c for c in columns if all(c != column for column, _ in chosen.values()))


def slow_roles(chosen: Chosen, stated: Stated) -> frozenset[str]:
    """Return the roles that may be slow: interpolated between values, so no load that makes the quantity."""
    counts = measured(chosen).powers(domain_of(chosen, stated))["load"] != (0, 0)
    return frozenset({"temperature"} if counts else {"temperature", "load"})


def measured(chosen: Chosen) -> Domain:
    """Return what the columns of torque and speed hold as they were recorded."""
    kinds = _kinds(chosen)
    return Domain(QUANTITY_OF[kinds.get("torque", "torque")], SPEED_OF[kinds.get("speed", "speed")])


def domain_of(chosen: Chosen, stated: Stated) -> Domain:
    """Return what the log is about: the torque of a rotation, or friction."""
    return target(measured(chosen), _known("load", chosen, stated), _known("radius", chosen, stated))


def target(of: Domain, load: str, radius: str) -> Domain:
    """Return what a measured domain becomes with `ONE` load and radius, with `SEVERAL`, or none (empty)."""
    several, torque = SEVERAL in (load, radius), of.quantity == "torque"
    if torque and not (radius and (load or radius == SEVERAL) and several):
        return Domain()
    asked = radius == ONE and (load == ONE or of.quantity == "friction force") and load != SEVERAL
    if not torque and asked:
        return Domain()
    turned = "sliding speed" if radius else of.speed
    known = bool(load) or of.quantity == "friction coefficient"
    return Domain("friction coefficient" if known else "friction force", turned)


def _known(role: str, chosen: Chosen, stated: Stated) -> str:
    value = getattr(stated, role)
    if role in chosen or (isinstance(value, tuple) and len(set(value)) > 1):
        return SEVERAL
    return "" if value is None else ONE


def in_domain(
    arrays: dict[str, FloatArray], chosen: Chosen, stated: Stated, domain: Domain | None = None
) -> dict[str, FloatArray]:
    """Return quantity and speed in the domain of the log (SI), from what the columns hold; the load, N.

    A row without a number that is needed gets none.
    """
    of, to = measured(chosen), domain or domain_of(chosen, stated)
    if of == to and stated.load is None:
        arrays.pop("radius", None)
        return arrays
    rows = arrays["speed"].size
    if rows <= HELD:
        return _in_domain(arrays, of, to, stated)
    made: dict[str, Filling] = {}
    for block in blocks(rows, *arrays.values()):
        part = {role: values[block] for role, values in arrays.items()}
        for role, values in _in_domain(part, of, to, stated).items():
            made.setdefault(role, Filling()).add(values, block.stop / rows)
    return {role: each.whole() for role, each in made.items()}


def is_converted(chosen: Chosen, stated: Stated) -> bool:
    """Return whether quantity or speed are computed from what was recorded."""
    return measured(chosen) != domain_of(chosen, stated)


def rotating(chosen: Mapping[str, Any]) -> tuple[str, ...]:
    """Return which of torque and speed a log has: a coast-down has no torque."""
    return tuple(role for role in ("torque", "speed") if role in chosen)


def _kinds(chosen: Chosen) -> dict[str, str]:
    return {role: role_conversion(role, chosen[role][1].unit)[0] for role in rotating(chosen)}


def _in_domain(
    arrays: dict[str, FloatArray], of: Domain, to: Domain, stated: Stated
) -> dict[str, FloatArray]:
    rows = arrays["speed"].shape
    known = {role: arrays[role] for role in ("load", "radius") if role in arrays}
    for role in ("load", "radius"):
        if (value := getattr(stated, role)) is not None:
            known[role] = np.full(rows, 1.0 if isinstance(value, tuple) else value)  # see `of_each_run`
    if "load" in known:
        arrays["load"] = known["load"]
    for role, nothing in (("radius", np.nan), ("load", np.inf)):  # no load: no contact, see `of_each_run`
        if role in known:
            known[role] = np.where(known[role] > 0, known[role], nothing)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        torque = arrays.get("torque", arrays["speed"])  # a coast-down has none
        torque, arrays["speed"] = of.converted(to, torque, arrays["speed"], **known)
    if "torque" in arrays:
        arrays["torque"] = torque
    arrays.pop("radius", None)
    return arrays


def computed(chosen: Chosen, stated: Stated, domain: Domain | None = None) -> list[Warning]:
    """Return what quantity and speed were computed from, and where the load is from."""
    known = _source("radius", "m", chosen, stated) | _source("load", "N", chosen, stated)
    of, to = measured(chosen), domain or domain_of(chosen, stated)
    powers = of.powers(to)
    paths = {role: chosen[role][0].path for role in rotating(chosen)}
    out = []
    if "torque" in paths and of.quantity != to.quantity:
        signs = {role: "x" if power > 0 else "/" for role, (power, _) in powers.items()}
        words = "{quantity} is '{channel}'"
        words += " {load_sign} load ({load_from})" if powers["load"][0] else ""
        words += " {radius_sign} radius ({radius_from})" if powers["radius"][0] else ""
        values = known | {f"{role}_sign": sign for role, sign in signs.items()}
        out.append(Warning("torque computed", words, channel=paths["torque"], quantity=to.quantity, **values))
    if powers["radius"][1]:
        out.append(
            Warning(
                "speed computed",
                "{speed} is '{channel}' {sign} radius ({radius_from})",
                channel=paths["speed"],
                speed=to.speed,
                sign="x" if to.speed == "sliding speed" else "/",
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
