"""Layouts of instruments that are known, and how their exports begin."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

from hersey.errors import ParameterError, meant
from hersey.log.layouts.table import LogLayout

#: Lines of a file among which the words of a preset are looked for.
BEGINNING = 60


@dataclass(frozen=True)
class Preset:
    """A layout, what it is for, and words of which all stand in the first lines of such an export."""

    layout: LogLayout
    of: str
    words: tuple[str, ...]


#: By name, as in ``preset = "twincat"``: after readers of the format by others, or after its usual form.
PRESETS: dict[str, Preset] = {
    # after readers of the format by others
    "rheocompass": Preset(
        LogLayout(section="Interval and data points:*", skip=("Result:*", "Test:*", "Project:*")),
        "Anton Paar RheoCompass, text export",
        ("Interval and data points:", "Interval data:"),
    ),
    "twincat": Preset(
        LogLayout(
            header="Name*Name*",
            paired_clocks="ms",
            skip=(
                *("SymbolComment*", "Data-Type*", "SampleTime*", "VariableSize*", "SymbolBased*"),
                *("IndexGroup*", "IndexOffset*", "SymbolName*", "NetID*", "Port*", "Offset*"),
                *("ScaleFactor*", "BitMask*", "Unit ScaleFactor*", "Unit Offset*", "EOF*"),
            ),
        ),
        "Beckhoff TwinCAT Scope, text export with a clock for each channel",
        ("SampleTime[ms]", "Starttime of export"),
    ),
    "trios": Preset(
        LogLayout(section="[step]*"),
        "TA Instruments TRIOS, text export",
        ("[step]", "Instrument name"),
    ),
    # after the usual form of the export
    "yokogawa": Preset(
        LogLayout(
            header="TraceName,*",
            values=("HResolution,{every:s}*",),
            skip=(
                *("BlockSize,*", "SampleRate,*", "HOffset,*", "HUnit,*", "DisplayBlockSize,*"),
                *("DisplayPointNo.,*", "PhaseShift,*", "Date,*", "Time,*", "BlockNumber,*"),
            ),
        ),
        "Yokogawa DL and ScopeCorder, CSV",
        ("TraceName,", "VUnit,", "HResolution,"),
    ),
    "graphtec": Preset(
        LogLayout(header="Number,*", milliseconds="ms"),
        "Graphtec GL, CSV",
        ("GRAPHTEC", "Number,Date&Time,ms"),
    ),
    "campbell": Preset(
        LogLayout(header_line=2, units_line=3, first_row=5),
        "Campbell Scientific TOA5",
        ('"TOA5"',),
    ),
    "influx": Preset(
        LogLayout(header=",result,table,*", comment="#", channel_column="_field", value_column="_value"),
        "InfluxDB, annotated CSV",
        ("#datatype,", ",result,table,", "_time,_value,_field"),
    ),
    "wincc": Preset(
        LogLayout(header_line=1, channel_column="VarName", value_column="VarValue"),
        "Siemens WinCC, archive as CSV",
        ("VarName", "TimeString", "VarValue"),
    ),
}


def presets_in(top: str) -> list[str]:
    """Return the names of the presets all of whose words stand in the first `BEGINNING` lines of a file."""
    return [name for name, of in PRESETS.items() if all(word in top for word in of.words)]


def with_preset(layout: LogLayout) -> LogLayout:
    """Return a layout with what its preset says, replaced by what it states itself.

    Raises
    ------
    ParameterError
        If there is no such preset.
    """
    if not layout.preset:
        return layout
    if layout.preset not in PRESETS:
        near = meant(layout.preset, list(PRESETS))
        said = f" Did you mean '{near}'?" if near else ""
        raise ParameterError(
            f"[layout] names the unknown preset '{layout.preset[:40]}'.{said} Presets: {', '.join(PRESETS)}"
        )
    stated = {each.name: getattr(layout, each.name) for each in fields(layout)}
    own = {
        name: value for name, value in stated.items() if value != LogLayout.__dataclass_fields__[name].default
    }
    return replace(PRESETS[layout.preset].layout, **{**own, "preset": ""})
