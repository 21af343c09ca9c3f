"""What to type for a log of speed against time without a torque: its wheel may coast down."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from hersey.cli.mistyped import retyped
from hersey.cli.traces import of_a_trace
from hersey.errors import ChannelError, HerseyError, Setting, UnitError, followed_by

if TYPE_CHECKING:
    from hersey.damping.recipe import Recipe

#: Settings of a torque, of dwells and of a recipe, whose values are among the others.
_NOT_OF_SPEED = (
    *("torque", "torque_unit", "torque_sign", "current", "torque_constant", "gear_ratio", "inertia"),
    *("moving", "min_dwell", "tare", "rotation", "temperature_scale", "no_load", "means"),
    *("recipe_file", "no_cache"),
)
#: A moment of inertia as it may be typed.
_INERTIA = "0.012 kg*m^2 ± 2 %"
#: Columns of a log without units that holds time, speed and perhaps a temperature.
_FEW = 3


class _Reading(Protocol):
    """The settings of a command that reads logs."""

    __dataclass_fields__: ClassVar[dict[str, Any]]

    @property
    def inertia(self) -> str | None: ...

    @property
    def position(self) -> str | None: ...

    @property
    def max_memory(self) -> str: ...

    def recipe(self, paths: list[Path], /) -> Recipe: ...


def as_other_use(error: ChannelError, paths: list[Path], reading: _Reading) -> ChannelError:
    """Return an error of a channel that no column holds, with what to type if the file is no log of torque.

    The line of a coast-down takes the place of the one that names all that a fit lacks.
    """
    torque = Setting("torque", "channel")
    if not (error.absent or torque in dict(error.examples)):
        return error
    if use := other_use(paths, reading):
        error.remedy = followed_by(error.remedy, use)
        error.examples = ()
    return error


def other_use(paths: list[Path], reading: _Reading) -> str:
    """Return what to type for files without the channels of a log: a coast-down, or a stick-slip trace."""
    recipe = reading.recipe(paths)
    named = recipe.channels or recipe.chosen.channels
    coasts = of_a_coast_down(paths, reading, recipe) or _of_pulses(paths, reading)
    return coasts or ("" if named else of_a_trace(paths))


def _of_pulses(paths: Sequence[Path], reading: _Reading) -> str:
    """What to type where files hold the times of pulses; else nothing."""
    from hersey.log.pulses import pulses_in

    if reading.position or len(pulses := {pulses_in(path) for path in paths}) != 1 or "" in pulses:
        return ""
    position = ("--position", pulses.pop(), "--position-unit", "rev/6")
    typed = [*_typed(reading), *position, "--inertia", reading.inertia or _INERTIA]
    return (
        "The rows are the times of pulses. If the wheel coasts down without a drive, type, with your pulses "
        f"per turn instead of 6 and its moment of inertia: {retyped('coastdown', *map(str, paths), *typed)}"
    )


def of_a_coast_down(paths: Sequence[Path], reading: _Reading, recipe: Recipe) -> str:
    """Return what to type where speed falls freely in logs that have no torque; else nothing.

    Where units are missing, so that no speed can be looked at, logs of few columns count.
    """
    if "torque" in recipe.channels.keys() | recipe.chosen.channels.keys():
        return ""
    from hersey.damping.coast_down.coasting import falls_freely
    from hersey.log import memory_limit
    from hersey.log.reading import list_channels

    try:
        with memory_limit(reading.max_memory):
            if not falls_freely(recipe.speeds()):
                return ""
    except (ChannelError, UnitError) as error:
        lacks_units = isinstance(error, UnitError) or any(of.kind == "unit" for of, _ in error.examples)
        if not lacks_units or any(_may_hold_more(list_channels(path)) for path in paths):
            return ""
    except HerseyError:
        return ""
    line = retyped("coastdown", *map(str, paths), *_typed(reading), "--inertia", reading.inertia or _INERTIA)
    return f"If the wheel coasts down without a drive, type, with its moment of inertia: {line}"


def _may_hold_more(columns: Sequence[tuple[str, str]]) -> bool:
    """Whether columns, each with its unit, may hold more than time, speed and temperature."""
    from hersey.log.signals import signal_kind

    return len(columns) > _FEW or any(signal_kind(unit) for _, unit in columns)


def _typed(reading: _Reading) -> list[str]:
    """The options that say how a speed is read, with their values."""
    words = []
    for each in fields(reading):
        value = getattr(reading, each.name)
        if value == each.default or each.name in _NOT_OF_SPEED:
            continue
        words.append(f"--{each.name.replace('_', '-')}")
        words += [] if isinstance(value, bool) else [str(value)]
    return words
