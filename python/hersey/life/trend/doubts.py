"""What to know of a trend before trusting it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.life.trend.comparing import WARM, Data, Fitted, effective_rows
from hersey.life.trend.record import Record
from hersey.life.trend.result import Jump
from hersey.life.trend.shown import shown_age
from hersey.schema.warning import Warning

#: A jump up by this share of friction may be a failure.
_FAILURE = 0.2
#: Share of a trend's squares that temperature follows, from which on the two cannot be separated.
_TOGETHER = 0.8
#: Fewest independent values for a trend.
_FEW = 8.0


def doubts_of(
    record: Record,
    data: Data,
    fitting: Sequence[Fitted],
    weights: FloatArray,
    numbers: Mapping[str, Any],
    jumps: Sequence[Jump],
    changing: bool,
    by: str,
) -> tuple[Warning, ...]:
    """Return the warnings of a trend, the gravest causes first."""
    found = [_of_jump(each, by) for each in jumps]
    found += record.not_used
    found += _of_temperature(data, fitting, weights, changing)
    found += _of_noise(fitting[0], data)
    found += _of_length(record, numbers, changing, by)
    found += _of_rows(record)
    return tuple(found)


def _of_jump(jump: Jump, by: str) -> Warning:
    values: dict[str, Any] = {"age": jump.age, "change": jump.change.value, "at": shown_age(by, jump.age)}
    if jump.turned:
        words = "friction differs by {change:+.0f %} from {at} on, in the other direction of motion"
        return Warning("jump with direction", words, severity="watch", **values)
    if jump.after_stop:
        words = "friction jumped by {change:+.0f %} at {at}, as the drive started again"
        return Warning("jump after a stop", words, severity="watch", **values)
    if jump.change.value > _FAILURE:
        return Warning(
            "jump",
            "friction rose suddenly by {change:+.0f %} at {at}, faster than wear or heating does",
            severity="act",
            remedy="look at the faces: the film may have broken down, or the parts seized",
            **values,
        )
    words = "friction jumped by {change:+.0f %} at {at}: contact, load or sensor changed suddenly"
    return Warning("jump", words, severity="watch", remedy="look at what happened then", **values)


def _of_temperature(
    data: Data, fitting: Sequence[Fitted], weights: FloatArray, changing: bool
) -> list[Warning]:
    kelvin = data.blocks.temperature
    if kelvin is None:
        if not changing:
            return []
        words = "no temperature is recorded, so heating cannot be separated from run-in or wear"
        return [Warning("no temperature", words, severity="watch", remedy="record the temperature")]
    low, high = (float(each) for each in np.quantile(kelvin, [0.05, 0.95]))
    if high - low < WARM:
        return []
    values: dict[str, Any] = {"low": low, "high": high, "span": high - low}
    warm = float(weights[np.array([each.warm for each in fitting])].sum() / weights.sum())
    if changing and _followed(fitting[0], data) > _TOGETHER:
        words = "temperature changed by {span:.2g} K together with friction, so it may be the cause"
        how = "repeat the test at constant temperature"
        return [Warning("temperature together", words, severity="watch", remedy=how, **values)]
    if warm > 0.5:
        words = "temperature varied by {span:.2g} K and friction with it; values hold at the last temperature"
        return [Warning("temperature effect", words, **values)]
    words = "temperature varied by {span:.2g} K; no effect on friction is proven"
    return [Warning("temperature varied", words, **values)]


def _followed(best: Fitted, data: Data) -> float:
    """The share of a course that a line in temperature explains."""
    assert data.blocks.temperature is not None
    course = best.design(best.best[1])[:, -1]
    weights = np.sqrt(data.blocks.rows)
    columns = np.column_stack([np.ones(course.size), data.blocks.temperature]) * weights[:, None]
    wanted = course * weights
    left = wanted - columns @ np.linalg.lstsq(columns, wanted, rcond=None)[0]
    off = (course - np.average(course, weights=data.blocks.rows)) * weights
    return 1.0 - float(left @ left) / max(float(off @ off), 1e-300)


def _of_noise(best: Fitted, data: Data) -> list[Warning]:
    independent, lasts = effective_rows(best), float(data.noise.time[best.best[0]])
    if independent >= _FEW:
        return []
    words = "friction wanders for {shown} at a time, so only {independent:.0f} values are independent"
    values: dict[str, Any] = {"shown": shown_age("time", lasts), "lasts": lasts, "independent": independent}
    return [
        Warning("wandering", words, severity="watch", remedy="record longer, or repeat the test", **values)
    ]


def _of_length(record: Record, numbers: Mapping[str, Any], changing: bool, by: str) -> list[Warning]:
    if not changing:
        return []
    last = float(record.age[-1])
    if numbers["steady"] is None:
        words = "friction still changes at the end of the log, so its steady value cannot be determined"
        return [Warning("not steady", words, severity="watch", remedy="record longer", last_age=last)]
    if numbers["steady_age"].high > last:
        words = (
            "friction may become steady only after the log ends at {end}: its steady value is extrapolated"
        )
        end = shown_age(by, last)
        how = "record longer"
        return [
            Warning("steady value extrapolated", words, severity="watch", remedy=how, last_age=last, end=end)
        ]
    return []


def _of_rows(record: Record) -> list[Warning]:
    found = []
    if record.apart:
        words = (
            "{rows} {rows:row|rows} with hardly any friction at the start or end of the log "
            "{rows:was|were} excluded"
        )
        found.append(Warning("faces apart", words, rows=record.apart))
    if record.other_speed:
        words = "{rows} {rows:row|rows} at another speed, e.g. during a start-up, {rows:was|were} excluded"
        found.append(Warning("another speed", words, rows=record.other_speed))
    if record.restarts.size:
        words = "the drive stopped {stops} {stops:time|times} within the log; age counts only while it turns"
        found.append(Warning("stops", words, stops=int(record.restarts.size)))
    return found
