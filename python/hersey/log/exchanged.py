"""Columns under each other's names, seen in how their numbers move.

A temperature never jumps. A speed is held at levels, and jumps between them. A torque follows its jumps, and
scatters about its levels more than the speed does about its own.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.errors import ChannelError, Setting, way_in
from hersey.log.channels import ChannelChoice
from hersey.log.long_arrays import blocks, ends, means_of
from hersey.log.torque_log import Run, TorqueLog

#: Length of the blocks whose means are compared, s, and how many there are in a run at the least and most.
_BLOCK, _FEWEST, _MOST = 0.5, 60, 20_000
#: A change beyond the first share of the span is a jump from block to block, or over so many s; beyond the
#: second a large one.
_JUMP, _LARGE, _OVER = 0.05, 0.1, 2.0
#: Large jumps, up and down, of what is no temperature; jumps of what is held at levels.
_UP_AND_DOWN, _LEVELS = 6, 3
#: Median change from block to block, as share of the span, of what is held at levels.
_HELD = 0.005
#: A temperature that jumps by less, K, may be one that is recorded coarsely.
_COARSE = 10.0
#: A speed is held so many times as closely as the torque scatters.
_CLOSER = 10.0
#: Span, as share of the median, below which a channel is constant.
_CONSTANT = 0.1
#: A torque beyond this, N m, at no speed beyond that, rad/s, is of few drives; and nearly all of them hold
#: their speed more closely than this share of what the torque does from row to row.
_GREAT, _SLOW, _STEADIER = 10.0, 0.1, 1.0 / 3.0
#: Share of the rows that is looked at for that: a spike of the sensor is no reading.
_USUAL = 0.99
#: What torque and speed play where they are exchanged.
_TWO = {"torque": "speed", "speed": "torque"}
#: Below this share of its greatest value a channel stands.
_STANDS = 0.005


@dataclass(frozen=True)
class _Moves:
    """How a channel moves: jumps, large ones up and down, median change from block to block by span."""

    jumps: int
    sudden: bool  #: whether there is a jump from one block to the next
    up: int
    down: int
    unrest: float
    constant: bool
    span: float

    @classmethod
    def of(cls, means: FloatArray, over: int) -> _Moves:
        low, high = np.quantile(means, [0.02, 0.98])
        span = float(high - low)
        if span <= 0.0:
            return cls(0, False, 0, 0, 0.0, True, 0.0)
        ahead, changes = (means[over:] - means[:-over]) / span, np.abs(np.diff(means)) / span
        return cls(
            _times(np.abs(ahead) > _JUMP),
            bool(changes.max() > _JUMP),
            _times(ahead > _LARGE),
            _times(ahead < -_LARGE),
            float(np.median(changes)),
            span < _CONSTANT * abs(float(np.median(means))),
            span,
        )

    @property
    def smooth(self) -> bool:
        """Whether it changes, and never jumps."""
        return not self.sudden and not self.constant

    @property
    def stairs(self) -> bool:
        """Whether it is held at levels and jumps between them."""
        return self.jumps >= _LEVELS and self.unrest < _HELD


def refuse_exchanged(log: TorqueLog, choices: Mapping[str, ChannelChoice]) -> None:
    """Refuse a log whose columns seem to have each other's names, unless the user named them.

    Raises
    ------
    ChannelError
        It says which columns, and how to exchange them.
    """
    plays = exchanged(log.runs)
    if not plays or all(choices[role].name for role in plays):
        return
    used = {channel.role: channel for channel in log.files[0].channels}
    seem = [f"'{used[role].name}' ({role}) looks like a {other}" for role, other in plays.items()]
    right = {other: used[role].name for role, other in plays.items()}
    units = {role: used[role].unit for role in plays if used[role].unit}
    named = {role: used[role].name for role in plays}
    raise ChannelError(
        f"{log.files[0].name}: the headers of columns seem to be swapped, because {', '.join(seem[:-1])} and "
        f"{seem[-1]}",
        remedy=f"exchange them with {_named(right, units)}. If the headers are right, confirm them with "
        f"{_named(named, {})}",
        setting=Setting("torque" if "torque" in plays else "speed", "channel"),
    )


def _named(channels: dict[str, str], units: dict[str, str]) -> str:
    """How columns and their units are named."""
    if way_in() == "python":
        return f"channels={channels}" + (f", units={units}" if units else "")
    said = []
    for role, name in channels.items():
        said.append(Setting(role, "channel").to(name))
        if role in units:
            said.append(Setting(role, "unit").to(units[role]))
    return (" " if way_in() == "terminal" else ", ").join(said)


def exchanged(runs: tuple[Run, ...]) -> dict[str, str]:
    """Return for each role that plays another the one that it plays, e.g. torque that of speed; often none.

    Most runs must show the same.
    """
    found = Counter(tuple(sorted(_exchanged(run).items())) for run in runs)
    most, count = found.most_common(1)[0]
    return dict(most) if 2 * count > len(runs) else {}


def _exchanged(run: Run) -> dict[str, str]:
    rows = run.time.size
    size = max(1, round(_BLOCK / run.sampling_interval), -(-rows // _MOST))
    if -(-rows // size) < _FEWEST:
        return {}
    torque, speed = (np.abs(means_of(each, size)) for each in (run.torque, run.speed))
    over = max(1, round(_OVER / (size * run.sampling_interval)))
    moves = {"torque": _Moves.of(torque, over), "speed": _Moves.of(speed, over)}
    if run.temperature is not None:
        hot = _Moves.of(means_of(run.temperature, size), over)
        if found := _with_temperature(hot, **moves):
            return found
    closer = moves["torque"].stairs and moves["speed"].unrest > _CLOSER * moves["torque"].unrest
    wider = closer and _range(torque, speed) > _range(speed, torque)
    return dict(_TWO) if wider or _of_few_drives(run.torque, run.speed) else {}


def _of_few_drives(torque: FloatArray, speed: FloatArray) -> bool:
    """Whether a great torque at almost no speed is held more closely than the speed."""
    if torque.size < 3 or max(map(abs, ends(torque))) < _GREAT:  # before the quantiles, which take long
        return False
    if _surely_above(speed, _SLOW) or _surely_below(torque, _GREAT):
        return False
    torque, speed = np.abs(torque), np.abs(speed)
    if np.quantile(torque, _USUAL) < _GREAT or np.quantile(speed, _USUAL) > _SLOW:
        return False
    return _unrest(torque) < _STEADIER * _unrest(speed)


def _surely_above(values: FloatArray, limit: float) -> bool:
    """Whether the usual size of values is surely above a limit: too few are not."""
    return _not_above(values, limit) <= _USUAL * (values.size - 1) - 1.0


def _surely_below(values: FloatArray, limit: float) -> bool:
    return _not_above(values, np.nextafter(limit, 0.0)) >= _USUAL * (values.size - 1) + 2.0


def _not_above(values: FloatArray, limit: float) -> int:
    """How many values are of no greater size than the limit."""
    return sum(int(np.count_nonzero(np.abs(values[rows]) <= limit)) for rows in blocks(values.size, values))


def _unrest(values: FloatArray) -> float:
    """Median change from row to row over the median."""
    return float(np.median(np.abs(np.diff(values)))) / max(float(np.median(values)), 1e-300)


def _with_temperature(hot: _Moves, torque: _Moves, speed: _Moves) -> dict[str, str]:
    """What the column of a temperature that jumps up and down plays, and which is the temperature."""
    if hot.up + hot.down < _UP_AND_DOWN or not hot.up or not hot.down:
        return {}
    levels = hot.stairs and hot.span > _COARSE
    if levels and (speed.smooth or speed.constant) and torque.unrest > hot.unrest:
        return {"temperature": "speed", "speed": "temperature"}
    if levels and torque.smooth and speed.unrest > hot.unrest:
        return {"temperature": "speed", "speed": "torque", "torque": "temperature"}
    if speed.stairs and torque.smooth:
        return {"temperature": "torque", "torque": "temperature"}
    if torque.stairs and not torque.constant and speed.smooth and hot.unrest > torque.unrest:
        return {"temperature": "torque", "torque": "speed", "speed": "temperature"}
    return {}


def _times(true: BoolArray) -> int:
    """How many stretches of a condition there are."""
    return int(np.count_nonzero(np.diff(true, prepend=False) & true))


def _range(values: FloatArray, other: FloatArray) -> float:
    """Ratio of the great to the small values while neither stands: friction varies less than its speed."""
    turning = (values > _STANDS * values.max()) & (other > _STANDS * other.max())
    if not turning.any():
        return 1.0
    low, high = np.quantile(values[turning], [0.05, 0.95])
    return float(high / low)
