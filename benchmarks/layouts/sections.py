"""Texts in sections: a header, or a line with a set point, for each step."""

from __future__ import annotations

from pathlib import Path

from benchmarks.layouts.truth import Made, staircase, truth


def _lines(rows: list[list[str]], joint: str = "\t", *, comma: bool = False) -> list[str]:
    lines = [joint.join(row) for row in rows]
    return [line.replace(".", ",") for line in lines] if comma else lines


def _write(path: Path, lines: list[str], encoding: str = "utf-8", end: str = "\r\n") -> None:
    path.write_bytes((end.join(lines) + end).encode(encoding))


_ALL = ("time", "torque", "turning", "temperature")
_SET = ("time", "torque", "temperature")


def rheocompass(path: Path) -> Made:
    """Anton Paar RheoCompass: intervals with a header of three rows each, UTF-16; after readers of it."""
    steps = staircase(1)
    lines = ["Project:\tSeal 4", "Test:\tStribeck 2", "Result:\tRotation 1", ""]
    for number, step in enumerate(steps, 1):
        lines += [
            f"Interval and data points:\t{number}\t{len(step)}",
            "Interval data:\tPoint No.\tTime\tTorque\tRotational Speed\tTemperature",
            "\t\t\t\t\t",
            "\t\t[s]\t[mN·m]\t[1/min]\t[°C]",
        ]
        lines += [f"\t{i}\t{line}" for i, line in enumerate(_lines(step.cells(*_ALL)), 1)] + [""]
    _write(path, lines, "utf-16")
    return Made(truth(steps))


def rheoplus(path: Path) -> Made:
    """Anton Paar Rheoplus: the older software, cp1252, decimal comma, semicolons, summary lines."""
    steps = staircase(2)
    lines = ["Datenreihen-Informationen", "Name:;Dichtung 7", "Anzahl Intervalle:;4", ""]
    for number, step in enumerate(steps, 1):
        lines += [f"Intervall:;{number}", "Anzahl der Messpunkte:;40", ""]
        lines += ["Messpkt.;Zeit;Drehmoment;Drehzahl;Temperatur", ";[s];[mNm];[1/min];[°C]"]
        lines += [f"{i};{line}" for i, line in enumerate(_lines(step.cells(*_ALL), ";", comma=True), 1)]
        lines += [""]
    _write(path, lines, "cp1252")
    return Made(truth(steps))


def trios(path: Path) -> Made:
    """TA Instruments TRIOS: [step] blocks with a title, names and units."""
    steps = staircase(3)
    lines = ["Filename\tC:\\data\\seal.tri", "Instrument name\tDHR-2", "[Parameters]", "Gap\t1000 µm", ""]
    for number, step in enumerate(steps, 1):
        lines += ["[step]", f"Peak hold - {number}", "Step time\tTorque\tVelocity\tTemperature"]
        lines += ["s\tmN.m\trpm\t°C", *_lines(step.cells(*_ALL)), ""]
    _write(path, lines, "utf-8-sig")
    return Made(truth(steps))


def rheowin(path: Path) -> Made:
    """Thermo HAAKE RheoWin: one table, names with 'in' before the unit."""
    steps = staircase(4)
    lines = ["Filename: seal.rwd", "Element definitions;CR;20,00 1/s", ""]
    lines += ["t in s;M in mNm;n in 1/min;T in °C"]
    lines += [line for step in steps for line in _lines(step.cells(*_ALL), ";", comma=True)]
    _write(path, lines, "cp1252")
    return Made(truth(steps))


def umt(path: Path) -> Made:
    """Bruker UMT, CETR: a section for each step, its velocity in the title, no measured speed."""
    steps = staircase(5)
    lines = ["Test Name: shaft seal", "Date: 03-12-2024", ""]
    for number, step in enumerate(steps, 1):
        lines += [f"Step {number}: Velocity {step.speed:g} rpm", "T(s)  Tz(N*m)  Temp(C)"]
        lines += [f"  {t}  {float(m) / 1000:.6f}  {c}" for t, m, c in step.cells(*_SET)] + [""]
    _write(path, lines)
    return Made(truth(steps, set_point=True))


def mtm(path: Path) -> Made:
    """PCS MTM, ETM: steps with key and value lines, then a table with a clock of its own."""
    steps = staircase(6, restart=True)
    lines = ["PCS Instruments", "Profile: traction 4", ""]
    for number, step in enumerate(steps, 1):
        lines += [f"Step {number}", "Step type: Timed", f"Shaft speed (rpm): {step.speed:g}", "Load (N): 40"]
        lines += ["Time (s)\tTorque (mNm)\tLube temp (°C)", *_lines(step.cells(*_SET)), ""]
    _write(path, lines, "cp1252")
    return Made(truth(steps, set_point=True))


def catman(path: Path) -> Made:
    """HBM catman ASCII: a channel list above, names with units, tabs, decimal comma."""
    steps = staircase(7)
    lines = ["HBM_CATMAN_DATAFILE_VERSION\t5.4", "T0=01.03.2024 08:00:00", "Number of channels\t4", ""]
    lines += ["Zeit [s]\tDrehmoment [Nm]\tDrehzahl [1/min]\tTemperatur [°C]", "Raw\tT10F\tT10F\tPT100"]
    for step in steps:
        lines += [
            f"{t}\t{float(m) / 1000:.6f}\t{n}\t{c}".replace(".", ",") for t, m, n, c in step.cells(*_ALL)
        ]
    _write(path, lines, "cp1252")
    return Made(truth(steps))


def dewesoft(path: Path) -> Made:
    """Dewesoft text export: information, events, then the table."""
    steps = staircase(8)
    lines = [
        "File name: bench_0008.dxd",
        "Sample rate: 2 Hz",
        "",
        "Events",
        "Event Type\tEvent\tTime\tComment",
    ]
    lines += ["1\tstoring started at\t0,000\t", "2\tstoring stopped at\t80,0\t", "", "Data1"]
    lines += ["Time (s)\tTorque (mNm)\tSpeed (rpm)\tOil temp (°C)"]
    lines += [line for step in steps for line in _lines(step.cells(*_ALL))]
    _write(path, lines)
    return Made(truth(steps))


def epos(path: Path) -> Made:
    """Maxon EPOS Studio recorder: key and value lines, names, then units; after a real file."""
    steps = staircase(9)
    lines = ["Date:;2024-03-01 08:00:00", "EPOS Studio Version:;3.6.1.0", "Max. samples:;500"]
    lines += ["Sampling period:;500.000", "Scale:;0;True;20.000;-0.500;-79.500;80.500"]
    lines += ['"Trigger:;1;0.000000;""Parameter values"";""Channel 1"""']
    lines += [";Velocity actual value averaged;Torque actual value averaged;Temperature power stage"]
    lines += ["ms;rpm;mNm;°C"]
    for step in steps:
        lines += [f"{1000 * float(t):.3f};{n};{m};{c}" for t, m, n, c in step.cells(*_ALL)]
    _write(path, lines)
    return Made(truth(steps))


def pin_on_disc(path: Path) -> Made:
    """Phoenix tribometer TSV: 15 lines above, a column twice, a summary row; after a real file."""
    steps = staircase(10)
    lines = ["Data file\t\tSEAL_2.TSV", "Configuration file\t\tHARI.CFG", *["\t\t"] * 9]
    lines += ["Test started at 20:32:15 on 2024-04-12"]
    lines += ["\tTest Time (s)\tSpeed (rpm)\tSpecimen Temp (°C)\tTorque (mNm)\tDisplacement\tTorque (mNm)\t"]
    for step in steps:
        lines += [f"\t{t}\t{n}\t{c}\t{m}\t3949\t{m}\t".replace(".", ",") for t, m, n, c in step.cells(*_ALL)]
    lines += ["\tMean\t\t\t44,1\t3950\t44,1\t"]
    _write(path, lines, "cp1252")
    return Made(truth(steps))


def odrive(path: Path) -> Made:
    """ODrive dynamometer: date, names, then units; after a real file."""
    steps = staircase(11)
    lines = ["2024-05-11 15:22:21.215576", "Time, Output Torque, Output Speed, Motor Temperature"]
    lines += ["s, N.mm, rpm, Deg C"]
    lines += [line for step in steps for line in _lines(step.cells(*_ALL), ", ")]
    _write(path, lines, end="\n")
    return Made(truth(steps))


def in_band(path: Path) -> Made:
    """A step line among the rows and one header: a bench of one's own."""
    steps = staircase(12)
    lines = ["time [s];torque [mN*m];oil [degC]"]
    for number, step in enumerate(steps, 1):
        lines += [f"Step {number}: {step.speed:g} rpm", *_lines(step.cells(*_SET), ";")]
    _write(path, lines)
    return Made(truth(steps, set_point=True))


def with_statistics(path: Path) -> Made:
    """Blocks each with a set point above and statistics below: a seal tester."""
    steps = staircase(13, restart=True)
    lines = ["Seal tester v2", ""]
    for step in steps:
        mean = sum(map(float, step.torque)) / len(step)
        lines += [f"Set speed = {step.speed:g} 1/min", "Time [s],Torque [mNm],Temp [°C]"]
        lines += _lines(step.cells(*_SET), ",")
        lines += [f"Mean,{mean:.3f},", "StdDev,0.301,", ""]
    _write(path, lines)
    return Made(truth(steps, set_point=True))


def other_units(path: Path) -> Made:
    """A logger restarted with another unit: the second part is in N m."""
    steps = staircase(14)
    lines = ["Time [s];Torque [mN*m];Speed [rpm];Temp [degC]"]
    lines += [line for step in steps[:2] for line in _lines(step.cells(*_ALL), ";")]
    lines += ["Time [s];Torque [N*m];Speed [rpm];Temp [degC]"]
    for step in steps[2:]:
        lines += [f"{t};{float(m) / 1000:.6f};{n};{c}" for t, m, n, c in step.cells(*_ALL)]
    _write(path, lines)
    return Made(truth(steps))


def restarts(path: Path) -> Made:
    """A logger that writes its header anew at each start, and its clock from 0."""
    steps = staircase(15, restart=True)
    lines = []
    for step in steps:
        lines += ["time_s,torque_mNm,speed_rpm,temp_C", *_lines(step.cells(*_ALL), ",")]
    _write(path, lines, end="\n")
    return Made(truth(steps))


def other_order(path: Path) -> Made:
    """Blocks whose columns come in another order in the second half."""
    steps = staircase(16)
    lines = ["Time [s];Torque [mN*m];Speed [rpm];Temp [degC]"]
    lines += [line for step in steps[:2] for line in _lines(step.cells(*_ALL), ";")]
    lines += ["", "Time [s];Speed [rpm];Torque [mN*m];Temp [degC]"]
    order = ("time", "turning", "torque", "temperature")
    lines += [line for step in steps[2:] for line in _lines(step.cells(*order), ";")]
    _write(path, lines)
    return Made(truth(steps))


def ini(path: Path) -> Made:
    """INI-like runs: [Run 1], keys with '=', then rows."""
    steps = staircase(17, restart=True)
    lines = ["[General]", "Operator=A", ""]
    for number, step in enumerate(steps, 1):
        lines += [f"[Run {number}]", f"Drehzahl={step.speed:g} 1/min", "Probe=S4"]
        lines += ["Zeit[s];Moment[Nmm];Temperatur[°C]", *_lines(step.cells(*_SET), ";", comma=True), ""]
    _write(path, lines, "cp1252")
    return Made(truth(steps, set_point=True))


def testxpert(path: Path) -> Made:
    """Zwick testXpert: quoted names and units, a block for each run, decimal comma."""
    steps = staircase(18, restart=True)
    lines = ['"Prüfbericht";"Lager 3"', ""]
    for number, step in enumerate(steps, 1):
        lines += [f'"Lauf {number}"', '"Prüfzeit";"Drehmoment";"Drehzahl";"Temperatur"']
        lines += ['"s";"Nmm";"1/min";"°C"', *_lines(step.cells(*_ALL), ";", comma=True), ""]
    _write(path, lines, "cp1252")
    return Made(truth(steps))


def optimol(path: Path) -> Made:
    """Optimol SRV, rotating: channels above, rows below, one step and a summary."""
    steps = staircase(19)
    lines = ["OPTIMOL SRV", "Test no.: 118", "Load: 50 N", "", "Time\tTorque\tSpeed\tTemperature"]
    lines += ["s\tNmm\trpm\t°C", *[line for step in steps for line in _lines(step.cells(*_ALL))]]
    lines += ["", "Torque min.:\t42.1", "Torque max.:\t52.0"]
    _write(path, lines, "cp1252")
    return Made(truth(steps))


def lvm(path: Path) -> Made:
    """LabVIEW measurement file: two header blocks."""
    steps = staircase(20)
    lines = ["LabVIEW Measurement", "Writer_Version\t2", "Reader_Version\t2", "Separator\tTab"]
    lines += ["Decimal_Separator\t.", "Multi_Headings\tNo", "X_Columns\tOne", "Time_Pref\tRelative"]
    lines += ["***End_of_Header***", "", "Channels\t3", f"Samples\t{160}\t{160}\t{160}"]
    lines += ["Date\t2024/03/01\t2024/03/01\t2024/03/01", "Time\t08:00:00\t08:00:00\t08:00:00"]
    lines += ["Y_Unit_Label\tmN*m\trpm\tdegC", "X_Dimension\tTime\tTime\tTime"]
    lines += ["X0\t0.0\t0.0\t0.0", "Delta_X\t0.5\t0.5\t0.5", "***End_of_Header***"]
    lines += ["X_Value\tTorque\tSpeed\tTemperature\tComment"]
    lines += [line for step in steps for line in _lines(step.cells(*_ALL))]
    _write(path, lines)
    return Made(truth(steps))
