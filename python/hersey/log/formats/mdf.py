"""ASAM MDF files (MF4, MDF 3), through asammdf: every channel on the raster of its own group.

asammdf gives the formulas of a file to numexpr or sympy, and either can be made to run what stands in them.
Both are replaced before asammdf is imported: a formula is evaluated by `formula`, or its channel refused.
"""

from __future__ import annotations

import io
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache, partial
from types import ModuleType
from typing import Any, BinaryIO

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.errors import UnreadableLogError
from hersey.log.formats.formula import evaluate
from hersey.log.recording import (
    INVALID,
    INVALID_TIME,
    SOUND,
    Recording,
    Signal,
    floats,
    library,
    library_warning,
    listening,
)
from hersey.log.text.column import split_unit
from hersey.schema.warning import Warning

_MASTERS = (2, 3)  # channel types: master, virtual master
_TIME = (0, 1)  # kinds of master: none given (MDF 3), time
_ALL_INVALID, _SOME_INVALID = 1, 2  # flags of a channel of MDF 4: which of its samples are marked
_OF_OLD_CLOCKS = (0, 65535)  # conversions of a clock of MDF 3 that asammdf applies: linear, none
_BUS = ("CAN_", "LIN_", "FLX_", "ETH_", "MOST_", "K_LINE_")
#: Variables of a formula in asammdf: the raw value, and parameters and constants of its own formulas.
_VARIABLES = ("X", "X1", "P1", "P2", "P3", "P4", "P5", "P6", "INF", "NaN")
#: What was wrong with the formulas met: asammdf goes on with raw values where one fails.
_refusals: list[str] = []
#: Formulas met that hold a sign which some take for another operation.
_powers: list[str] = []


def prepare() -> None:
    """Import the library: what that takes is none of the file's doing."""
    _asammdf()


@contextmanager
def open_mdf(file: BinaryIO, _name: str) -> Iterator[Recording]:
    """Open an MDF file; a channel of text or arrays is listed, and refused when it is asked for."""
    asammdf = _asammdf()
    if file.read(8) == b"UnFinMF ":  # asammdf finishes it, which changes it
        file.seek(0)
        file = io.BytesIO(file.read())
    with listening("asammdf") as heard, asammdf.MDF(file, process_bus_logging=False) as mdf:
        channels, frames = _channels(mdf)
        warnings = [library_warning("asammdf", words) for words in dict.fromkeys(heard)]
        recording = Recording("MF4", (), warnings=warnings)
        several = len({group for group, *_ in channels}) > 1
        recording.signals = tuple(_signal(mdf, recording, heard, channel, several) for channel in channels)
        if frames:
            recording.nothing = (
                f"the file holds raw bus frames ({', '.join(sorted(frames))}), not physical signals. "
                "Decode it with the bus database (DBC, ARXML), e.g. with extract_bus_logging of "
                "asammdf, and read the result"
            )
        yield recording


@cache
def _asammdf() -> Any:
    """The library, with nothing in it that could run a formula, or write."""
    ours = ModuleType("numexpr")
    ours.__dict__.update(evaluate=_evaluated, __version__="0")
    sys.modules["numexpr"] = ours
    sys.modules["sympy"] = None  # type: ignore[assignment] # importing it fails
    tempfile.NamedTemporaryFile = lambda *_, **__: io.BytesIO()  # type: ignore[assignment] # kept empty
    asammdf = library("asammdf", "MF4 files")
    from asammdf.blocks import v2_v3_blocks, v4_blocks

    for blocks in (v2_v3_blocks, v4_blocks):
        if blocks.evaluate is not _evaluated or blocks.lambdify is not None:
            raise UnreadableLogError("cannot be read: this version of asammdf evaluates formulas differently")
    return asammdf


def _evaluated(formula: str) -> FloatArray:
    """What numexpr would return: the value of a formula of the variables of the function that asks."""
    local = sys._getframe(1).f_locals
    # asammdf has written each x large, and MDF 3's X as X1, also in the name of the function
    formula = formula.replace("eX1p", "exp").replace("eXp", "exp")
    if "^" in formula:
        _powers.append(formula)
    try:
        return evaluate(formula, {name: local[name] for name in _VARIABLES if name in local})
    except Exception as error:
        _refusals.append(str(error))
        raise


def _channels(mdf: Any) -> tuple[list[tuple[int, int, str, str, int]], set[str]]:
    """Group, index, name, unit and rows of each channel, and the kinds of bus frames."""
    channels, frames = [], set()
    for number, group in enumerate(mdf.groups):
        rows = int(group.channel_group.cycles_nr)
        for index, channel in enumerate(group.channels if rows else ()):
            master = index == mdf.masters_db.get(number)
            if channel.name.startswith(_BUS):
                frames.add(channel.name.split(".")[0])
            elif not master and getattr(channel, "channel_type", 0) not in _MASTERS:
                unit = getattr(channel, "unit", "") or getattr(channel.conversion, "unit", "") or ""
                channels.append((number, index, channel.name, str(unit).strip("\0 "), rows))
    return channels, frames


def _read_as_power(channel: str, formula: str) -> Warning:
    words = "'{channel}': '^' in its formula {formula!r} was read as a power"
    return Warning("sign in a formula read as a power", words, channel=channel, formula=formula[:80])


def _values_missing(channel: str, count: int, rows: int) -> Warning:
    words = "'{channel}' has {count} values instead of {rows}; the rest are missing"
    return Warning("values missing", words, severity="watch", channel=channel, count=count, rows=rows)


def _signal(
    mdf: Any, recording: Recording, heard: list[str], channel: tuple[int, int, str, str, int], several: bool
) -> Signal:
    group, index, full_name, unit, rows = channel
    name, ending = (full_name, unit) if unit else split_unit(full_name)

    def get() -> tuple[FloatArray, FloatArray, FloatArray]:
        heard.clear()
        _refusals.clear()
        _powers.clear()
        try:
            values, times, marked = _values(mdf, group, index)
        except UnreadableLogError as error:
            raise UnreadableLogError(f"channel '{full_name}' {error}") from None
        powers = [_read_as_power(full_name, formula) for formula in _powers]
        recording.warnings += [power for power in powers if power not in recording.warnings]
        if problem := next(iter([*_refusals, *(f"cannot be read: {words[:160]}" for words in heard)]), ""):
            raise UnreadableLogError(f"channel '{full_name}' {problem}")
        count = times.size
        if values.size != count or count > rows:
            raise UnreadableLogError(
                f"channel '{full_name}' has {values.size} values and {count} times instead of {rows}"
            )
        if count < rows and not recording.cut_off:
            recording.cut_off = True
            recording.warnings.append(_values_missing(full_name, count, rows))
        return values, times, marked

    def part(which: int) -> FloatArray:
        return get()[which]

    return Signal(
        name,
        ending,
        rows,
        partial(part, 0),
        partial(part, 1),
        tick=f"group {group}",
        group=str(group) if several else "",
        marked=partial(part, 2) if _may_be_marked(mdf, group, index) else None,
    )


def _may_be_marked(mdf: Any, group: int, index: int) -> bool:
    """Whether the file may mark samples of a channel, or of its clock, as invalid."""
    channels, master = mdf.groups[group].channels, mdf.masters_db.get(group)
    of_either = [index] if master is None else [index, master]
    return any(getattr(channels[i], "flags", 0) & (_ALL_INVALID | _SOME_INVALID) for i in of_either)


def _values(mdf: Any, group: int, index: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Values and times of a channel, s, and what the file says of each sample; NaN where it is invalid."""
    master = mdf.masters_db.get(group)
    channels = mdf.groups[group].channels
    if master is None or getattr(channels[master], "sync_type", 1) not in _TIME:
        raise UnreadableLogError("has no clock")
    conversion = channels[master].conversion
    if mdf.version < "4" and conversion is not None and conversion.conversion_type not in _OF_OLD_CLOCKS:
        formula = f" (formula {conversion.formula[:80]!r})" if conversion.formula else ""
        raise UnreadableLogError(f"has a clock with a conversion that cannot be applied{formula}")
    # otherwise asammdf drops samples that are invalid from this channel alone
    signal = mdf.get(group=group, index=index, ignore_invalidation_bits=True)
    values = signal.samples
    if values.ndim != 1 or values.dtype.kind not in "iufb":
        what = "arrays" if values.ndim != 1 or values.dtype.names else "text"
        raise UnreadableLogError(f"holds {what} instead of numbers")
    values, times = values.astype(float), floats(signal.timestamps)
    marked = np.full(values.size, SOUND)
    marked[_invalid(channels[index], signal)] = INVALID
    if getattr(channels[master], "flags", 0) & (_ALL_INVALID | _SOME_INVALID) and mdf.version >= "4":
        clock = mdf.get(group=group, index=master, ignore_invalidation_bits=True)
        marked[_invalid(channels[master], clock)] = INVALID_TIME
        times = np.where(marked == INVALID_TIME, np.nan, times)
    values[marked != SOUND] = np.nan
    return values, times, marked


def _invalid(channel: Any, signal: Any) -> BoolArray:
    """Whether the file marks each sample of a channel as invalid."""
    if getattr(channel, "flags", 0) & _ALL_INVALID and hasattr(channel, "pos_invalidation_bit"):
        return np.ones(signal.samples.shape[0], dtype=bool)
    if signal.invalidation_bits is None:
        return np.zeros(signal.samples.shape[0], dtype=bool)
    return np.asarray(signal.invalidation_bits, dtype=bool)
