"""What a reader of an operating map must know: what V* depends on, stall, points that are not certain."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from hersey.arrays import BoolArray
from hersey.damping.surface import FIXED
from hersey.schema.noun import BELT
from hersey.schema.warning import Warning
from hersey.stability.operating_map.edges import shown_laws
from hersey.stability.operating_map.result import OperatingMap
from hersey.stability.operating_map.state import PlacedPoint

#: Starting torques that differ by less are shown as one.
_SAME_TORQUE = 1.0005


def warnings_of(map_: OperatingMap, points: Sequence[PlacedPoint]) -> tuple[Warning, ...]:
    """Return the warnings of a map and its operating points."""
    return (
        _of_the_stick_speed(map_),
        *_of_the_temperature(map_),
        *_of_the_stall(map_),
        *_not_started(map_),
        *(warning for point in points for warning in _of_a_point(map_, point)),
        *_of_the_speed_limit(map_, points),
    )


def _of_the_stick_speed(map_: OperatingMap) -> Warning:
    laws = shown_laws(map_.drag, map_.temperature, map_.stick_speed_rule)
    hot, fixed = map_.drag.reference_temperature, map_.stick_speed_rule == FIXED
    names = ["the fit", *(name.replace("_", " ") for name in map_.uncertain)]
    return Warning(
        "V* depends on the stick speed",
        "V* depends on the stick speed, {stick_speed:.3g mm/s}"
        + (
            " here"
            if hot is None
            else " at all temperatures here"
            if fixed
            else (
                " at {temperature:.0f degC} here (it moves with the transition speed, from {coldest:.3g "
                "mm/s} to {hottest:.3g mm/s})"
            )
        )
        + ", which the dwells do not show. The interval of V* includes the uncertainty of {counted}"
        + ("" if "stick_speed" in map_.uncertain else ". State the uncertainty of stick_speed"),
        stick_speed=map_.drag.stick_speed,
        temperature=hot,
        coldest=laws[0].stick_speed,
        hottest=laws[-1].stick_speed,
        counted=" and ".join(filter(None, [", ".join(names[:-1]), names[-1]])),
    )


def _of_the_temperature(map_: OperatingMap) -> Iterator[Warning]:
    if map_.temperature is None:
        yield Warning(
            "isothermal fit",
            "the fit is isothermal, so the map and its points hold at the temperature of the log",
        )


def _of_the_stall(map_: OperatingMap) -> Iterator[Warning]:
    """Yield what the drive can give, and what the part needs."""
    if map_.torque_limit is None:
        yield Warning(
            "no torque limit",
            "the map shows no stall, because no torque limit is stated",
            remedy="add motor_torque, or roll_friction and nip_load, to [limits]"
            if map_.train.part == BELT
            else "add motor_torque to [limits]",
        )
        return
    least, most = float(map_.holding.min()), float(map_.holding.max())
    yield Warning(
        "torque limit",
        "the drive gives at most {limit:.3g} N m ({limited_by}); starting from rest takes "
        + ("{least:.3g} N m" if most <= _SAME_TORQUE * least else "{least:.3g} to {most:.3g} N m"),
        limit=map_.torque_limit,
        limited_by=map_.limited_by,
        least=least,
        most=most,
    )


def _not_started(map_: OperatingMap) -> Iterator[Warning]:
    """Yield the temperatures at which the drive does not start the part, and where it may not."""
    never = ~map_.starts & ~map_.doubtful
    if never.any():
        yield _unstarted("belt not started", map_, never, surely=True)
    if map_.doubtful.any():
        yield _unstarted("belt may not start", map_, map_.doubtful, surely=False)


def _unstarted(kind: str, map_: OperatingMap, columns: BoolArray, *, surely: bool) -> Warning:
    first, last = _ends(map_, columns)
    everywhere = columns.all()
    return Warning(
        kind,
        ("the drive cannot start from rest" if surely else "the drive may be unable to start from rest")
        + (
            " at any temperature"
            if everywhere and surely
            else ""
            if everywhere
            else " at {first:.0f degC}"
            if first == last
            else " from {first:.0f degC} to {last:.0f degC}"
        ),
        severity="watch",
        first=first,
        last=last,
    )


def _ends(map_: OperatingMap, columns: BoolArray) -> tuple[float | None, float | None]:
    """The first and last temperature (K) of columns; None of an isothermal map."""
    if map_.temperature is None:
        return None, None
    first, last = map_.temperature[columns][[0, -1]].tolist()
    return first, last


def _of_a_point(map_: OperatingMap, point: PlacedPoint) -> Iterator[Warning]:
    """Yield why the verdict on a point is uncertain."""
    edges = {"the transition speed": map_.transition_interval, "V*": map_.upper_interval}
    for name, interval in edges.items() if not map_.given else ():
        low, high = (
            float(
                edge[0] if map_.temperature is None else np.interp(point.temperature, map_.temperature, edge)
            )
            for edge in interval
        )
        if low <= point.speed <= high:
            yield Warning(
                "verdict not certain",
                "the verdict is uncertain, because the point lies within the 95 % interval of {edge} "
                "({low:.3g mm/s} to {high:.3g mm/s})",
                severity="watch",
                where=point.name,
                edge=name,
                low=low,
                high=high,
            )
            break
    if point.at.extrapolated:
        yield Warning(
            "point extrapolated",
            "extrapolated, because the point lies outside the measured range",
            severity="watch",
            where=point.name,
        )


def _of_the_speed_limit(map_: OperatingMap, points: Sequence[PlacedPoint]) -> Iterator[Warning]:
    for point in points:
        if map_.speed_limit is not None and point.speed > map_.speed_limit:
            yield Warning(
                "faster than the drive",
                "faster than the drive can run ({limit:.3g mm/s})",
                severity="watch",
                where=point.name,
                limit=map_.speed_limit,
            )
