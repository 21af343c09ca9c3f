"""LabVIEW TDMS files, through nptdms: scalings, and start and rate of each channel."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, BinaryIO

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import UnreadableLogError
from hersey.log.recording import Recording, Signal, floats, library, library_warning, listening
from hersey.log.text.column import split_unit
from hersey.schema.warning import Warning

#: Scalings that nptdms applies; it reads a channel with any other one raw.
_SCALES = {
    *("Polynomial", "Linear", "RTD", "Strain", "Table", "Thermistor", "Thermocouple"),
    *("Add", "Subtract", "AdvancedAPI"),
}
_UNITS = ("unit_string", "NI_UnitDescription", "Unit", "unit", "units")


@contextmanager
def open_tdms(opened: BinaryIO, _name: str) -> Iterator[Recording]:
    """Open a TDMS file; channels with ``wf_increment`` carry their own clock."""
    nptdms = library("nptdms", "TDMS files")
    with listening("nptdms") as heard, nptdms.TdmsFile.open(opened) as file:
        channels = [channel for group in file.groups() for channel in group.channels()]
        several = len({channel.group_name for channel in channels}) > 1
        numeric = [channel for channel in channels if _is_numeric(channel) and len(channel)]
        starts = [_start(channel) for channel in numeric if _has_clock(channel)]
        known = [start for start in starts if start is not None]
        first = min(known) if known and len(known) == len(starts) else None
        recording = Recording(
            "TDMS",
            tuple(_signal(file, channel, first, several) for channel in numeric),
            tuple(
                f"'{channel.name}' ({'empty' if not len(channel) else 'no numbers'})"
                for channel in channels
                if not (_is_numeric(channel) and len(channel))
            ),
            tuple(f"{key}: {value}"[:200] for key, value in file.properties.items())[:5],
        )
        if starts and known and first is None:
            recording.warnings.append(
                Warning(
                    "start times missing",
                    "only some channels have a start time, so all of them start at 0 s",
                    severity="watch",
                )
            )
        if _is_cut_off(file, opened):
            recording.cut_off = True
            recording.warnings.append(
                Warning(
                    "last segment incomplete",
                    "the last segment of the file is incomplete; only the data present were read",
                )
            )
        recording.warnings += [library_warning("nptdms", words) for words in dict.fromkeys(heard)]
        yield recording


def _is_cut_off(file: Any, opened: BinaryIO) -> bool:
    """Whether the last segment lacks data, or has a head that is not whole, which nptdms passes over."""
    status = file.file_status
    if status.incomplete_final_segment or status.channel_statuses is not None:
        return True
    ends = [segment.next_segment_pos for segment in file._reader._segments]
    return max(ends, default=0) < opened.seek(0, io.SEEK_END)


def _signal(file: Any, channel: Any, first: Any, several: bool) -> Signal:
    unit = next((str(channel.properties[key]) for key in _UNITS if channel.properties.get(key)), "")
    name, ending = (channel.name, unit) if unit else split_unit(channel.name)
    group = channel.group_name if several else ""
    stamps = channel.dtype.kind == "M"

    def load() -> FloatArray:
        unknown = _scales(channel.properties) or _scales(file[channel.group_name].properties)
        if unknown := unknown or _scales(file.properties):
            raise UnreadableLogError(
                f"channel '{channel.name}' has a scaling of type {unknown}, which cannot be applied. "
                "Export scaled data"
            )
        values = channel[:]
        if len(values) != len(channel):
            raise UnreadableLogError(
                f"channel '{channel.name}' has {len(values)} values instead of {len(channel)}"
            )
        return floats(values)

    if not _has_clock(channel):
        return Signal(name, "s" if stamps else ending, len(channel), load, group=group)
    offset, step = _offset(channel, first), float(channel.properties["wf_increment"])

    def clock() -> FloatArray:
        if not (np.isfinite(offset) and 0 < step < np.inf):
            raise UnreadableLogError(
                f"channel '{channel.name}': wf_increment is {step:g} s: it must be greater than 0"
            )
        return np.asarray(offset + step * np.arange(len(channel)), dtype=float)

    return Signal(name, ending, len(channel), load, clock, f"{offset!r} {step!r} {len(channel)}", group)


def _is_numeric(channel: Any) -> bool:
    kind = channel.dtype.kind if channel.dtype is not None else "V"
    return kind in "iufbM"


def _has_clock(channel: Any) -> bool:
    """Whether the clock is in the properties; LabVIEW writes an increment of 0 or 1 where there is none."""
    step = channel.properties.get("wf_increment")
    return isinstance(step, int | float) and step != 0 and channel.dtype.kind != "M"


def _start(channel: Any) -> Any:
    start = channel.properties.get("wf_start_time")
    # 1904 is LabVIEW's zero: no start was written
    return start if isinstance(start, np.datetime64) and start > np.datetime64("1905-01-01") else None


def _offset(channel: Any, first: Any) -> float:
    offset = float(channel.properties.get("wf_start_offset", 0.0))
    start = _start(channel)
    return offset if first is None else offset + float((start - first) / np.timedelta64(1, "ns")) * 1e-9


def _scales(properties: dict[str, Any]) -> str:
    """Scalings among the properties that are not known."""
    if properties.get("NI_Scaling_Status") == "scaled":
        return ""
    kinds = {str(v) for k, v in properties.items() if re.fullmatch(r"NI_Scale\[\d+\]_Scale_Type", k)}
    return ", ".join(f"'{kind}'" for kind in sorted(kinds - _SCALES))
