"""Workbooks of Excel with a sheet for each run, or a column for each condition."""

from __future__ import annotations

from pathlib import Path

from tests.untrusted_input.other_blocks import xlsx

from benchmarks.layouts.truth import Made, Step, staircase, truth

_ALL = ("time", "torque", "turning", "temperature")
_HEAD = ["Time [s]", "Torque [mN*m]", "Speed [rpm]", "Temp [degC]"]


def _numbers(step: Step, *names: str) -> list[list[object]]:
    return [list(map(float, row)) for row in step.cells(*names)]


def sheets(path: Path) -> Made:
    """A sheet for each run, all channels measured."""
    steps = staircase(41, restart=True)
    path.write_bytes(xlsx({f"Run {i}": [_HEAD, *_numbers(step, *_ALL)] for i, step in enumerate(steps, 1)}))
    return Made(truth(steps))


def named_sheets(path: Path) -> Made:
    """A sheet for each run, its name the speed."""
    steps = staircase(42, restart=True)
    head = [_HEAD[0], _HEAD[1], _HEAD[3]]
    path.write_bytes(
        xlsx({f"{s.speed:g} rpm": [head, *_numbers(s, "time", "torque", "temperature")] for s in steps})
    )
    return Made(truth(steps, set_point=True))


def titled_sheets(path: Path) -> Made:
    """A sheet for each run, the speed in a cell above the table, units in a row below the names."""
    steps = staircase(43, rows=(30, 45, 38, 50), restart=True)
    tables = {
        f"Sheet{i}": [
            ["Shaft seal", "S4"],
            ["Speed:", f"{s.speed:g} rpm"],
            [],
            ["Time", "Torque", "Oil temp"],
            ["s", "mN*m", "°C"],
            *_numbers(s, "time", "torque", "temperature"),
        ]
        for i, s in enumerate(steps, 1)
    }
    path.write_bytes(xlsx(tables))
    return Made(truth(steps, set_point=True))


def wide_sheet(path: Path) -> Made:
    """A torque column for each speed."""
    steps = staircase(44, restart=True)
    head = ["Time [s]", *(f"M @ {s.speed:g} 1/min [mN*m]" for s in steps)]
    clock = map(float, steps[0].time)
    rows = [list(row) for row in zip(clock, *(map(float, s.torque) for s in steps), strict=True)]
    path.write_bytes(xlsx({"Sheet1": [head, *rows]}))
    return Made(truth(steps, set_point=True, temperature=False))


def transposed_sheet(path: Path) -> Made:
    """A channel in each row."""
    steps = staircase(45, speeds=(10, 40), rows=12)
    rows = [
        [title, *(float(cell) for s in steps for cell in getattr(s, name))]
        for title, name in zip(_HEAD, _ALL, strict=True)
    ]
    path.write_bytes(xlsx({"Sheet1": rows}))
    return Made(truth(steps))


def side_by_side(path: Path) -> Made:
    """Runs side by side under titles, an empty column between them, of unequal length."""
    steps = staircase(46, speeds=(10, 20, 40), rows=(30, 22, 41), restart=True)
    titles = [cell for i in range(1, 4) for cell in (f"Run {i}", None, None, None, None)]
    head = [cell for _ in steps for cell in (*_HEAD, None)]
    tables = [_numbers(s, *_ALL) for s in steps]
    rows = [
        [cell for table in tables for cell in (*(table[i] if i < len(table) else [None] * 4), None)]
        for i in range(max(map(len, tables)))
    ]
    path.write_bytes(xlsx({"Sheet1": [titles, head, *rows]}))
    return Made(truth(steps))


def timed_speeds(path: Path) -> Made:
    """A clock and a column called like its speed for each run, of unequal length, in two sheets."""
    steps = staircase(47, speeds=(10, 20, 40, 80), rows=(30, 45, 26, 38), restart=True)
    tables = {}
    for title, parts in (("up", steps[:2]), ("down", steps[2:])):
        head = [cell for s in parts for cell in ("t [s]", f"{s.speed:g} 1/min")]
        runs = [_numbers(s, "time", "torque") for s in parts]
        rows = [
            [cell for run in runs for cell in (run[i] if i < len(run) else [None] * 2)]
            for i in range(max(map(len, runs)))
        ]
        tables[title] = [["Screw 16x5, torque in Nmm"], [], head, *rows]
    path.write_bytes(xlsx(tables))
    return Made(truth(steps, set_point=True, temperature=False), {"--torque-unit": "N*mm"})
