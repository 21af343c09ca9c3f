"""A trace with its slips, and the mean cycle with the fitted motion, as a chart."""

from __future__ import annotations

import altair as alt
import numpy as np

from hersey.charts.style import BLUE, ORANGE, WIDTH, Chart, categories, plot, rows_of, stacked
from hersey.identification.cycle_record import CycleRecord, Scatter
from hersey.identification.identified_drive import IdentifiedDrive

#: The trace is shown over this many typical periods in the middle of it, and at least this many samples.
_PERIODS, _SAMPLES = 8.0, 400
#: Points drawn of the trace, at most.
_DRAWN = 4000


def trace_chart(record: CycleRecord, drive: IdentifiedDrive | None = None, *, unit: str = "") -> Chart:
    """Return the chart of a record: part of the trace, the fall of each slip, and the fitted cycle.

    Parameters
    ----------
    unit
        Of the trace, for the axes.
    """
    label = _label(record.quantity, unit)
    panels: list[alt.Chart | Chart] = [_trace(record, label)]
    if record.slips:
        panels.append(_slips(record, label))
    if drive is not None:
        panels.append(_cycle(drive, label))
    title = alt.Title("Cycles of the trace", subtitle=_heading(record, drive))
    return stacked(*panels, title=title, spacing=16)


def drive_chart(drive: IdentifiedDrive, *, unit: str = "") -> Chart:
    """Return the mean cycle with the motion of the drive that was identified from it."""
    title = alt.Title("Identified drive", subtitle=_identified(drive))
    return _cycle(drive, _label("force", unit)).properties(title=title, height=300)


def _identified(drive: IdentifiedDrive) -> str:
    decided = "" if drive.decided else " (not decided)"
    return f"closure {drive.closure}{decided}, within {100 * drive.misfit:.2g} % of the drop"


def _label(quantity: str, unit: str) -> str:
    return {"force": "Force", "speed": "Stretch"}[quantity] + f" ({unit or 'as recorded'})"


def _heading(record: CycleRecord, drive: IdentifiedDrive | None) -> list[str]:
    words = record.kind.replace("_", " ")
    if not record.slips:
        return [words]
    period = Scatter.of(record.period)
    slips = f"{words}: {record.slips} slips, period {period.median:.4g} s; dots: middle of each slip"
    return [slips] if drive is None else [slips, f"fitted motion: {_identified(drive)}"]


def _window(record: CycleRecord) -> tuple[int, int]:
    samples = record.samples
    size = samples.value.size
    lap = float(np.median(record.period)) if record.period.size else size * samples.interval
    reach = int(max(_PERIODS * lap / samples.interval, _SAMPLES)) // 2
    return max(0, size // 2 - reach), min(size, size // 2 + reach)


def _trace(record: CycleRecord, label: str) -> Chart:
    first, last = _window(record)
    step = max(1, (last - first) // _DRAWN)
    samples = record.samples
    time = samples.time[first:last:step]
    rows = rows_of(time=time, force=samples.value[first:last:step], index=range(time.size))
    inside = (record.slip_time >= samples.time[first]) & (record.slip_time <= samples.time[last - 1])
    middle = 0.5 * (record.force_max + record.force_min)
    marks = rows_of(time=record.slip_time[inside], force=middle[inside])
    x = alt.X("time:Q", title="Time (s), part of the trace", scale=alt.Scale(nice=False, zero=False))
    y = alt.Y("force:Q", title=label, scale=alt.Scale(zero=False))
    line = plot(rows).mark_line(color=BLUE, strokeWidth=1, clip=True).encode(x=x, y=y, order="index:Q")
    dots = plot(marks).mark_point(color=ORANGE, filled=True, size=40).encode(x=x, y=y)
    return alt.layer(line, dots).properties(width=WIDTH, height=220)


def _slips(record: CycleRecord, label: str) -> alt.Chart:
    step = max(1, record.slips // _DRAWN)
    rows = rows_of(time=record.slip_time[::step], drop=record.drop[::step])
    x = alt.X("time:Q", title="Time (s), whole trace", scale=alt.Scale(nice=False, zero=False))
    y = alt.Y("drop:Q", title=label.replace("Force", "Fall", 1))
    dots: alt.Chart = plot(rows).mark_point(color=BLUE, filled=True, size=14, opacity=0.7)
    return dots.encode(x=x, y=y).properties(width=WIDTH, height=120)


def _cycle(drive: IdentifiedDrive, label: str) -> Chart:
    wave = drive.waveform
    time, size = 1e3 * wave.offset, wave.offset.size
    rows = rows_of(time=time, force=wave.force, line=["mean cycle"] * size)
    fitted = rows_of(time=time, force=drive.fitted, line=["fitted motion"] * size, index=range(size))
    legend = alt.Legend(title=None, orient="bottom-right", fillColor="white", padding=4)
    x = alt.X("time:Q", title="Time from the middle of the slip (ms)", scale=alt.Scale(nice=False))
    y = alt.Y("force:Q", title=label, scale=alt.Scale(zero=False))
    color = categories(alt.Color, "line", {"mean cycle": ORANGE, "fitted motion": BLUE}, legend)
    dots = plot(rows).mark_point(filled=True, size=24).encode(x=x, y=y, color=color)
    line = plot(fitted).mark_line(strokeWidth=1.5).encode(x=x, y=y, color=color, order="index:Q")
    return alt.layer(line, dots).properties(width=WIDTH, height=220)
