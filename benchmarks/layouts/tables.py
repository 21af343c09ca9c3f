"""One table whose cells, columns or lines stand in an unusual way."""

from __future__ import annotations

from itertools import zip_longest
from pathlib import Path

from benchmarks.layouts.truth import Made, Step, staircase, truth

_ALL = ("time", "torque", "turning", "temperature")


def _write(path: Path, lines: list[str], encoding: str = "utf-8", end: str = "\r\n") -> None:
    path.write_bytes((end.join(lines) + end).encode(encoding))


def _rows(steps: list[Step], joint: str) -> list[str]:
    return [joint.join(row) for step in steps for row in step.cells(*_ALL)]


def keyence(path: Path) -> Made:
    """Keyence logger: cp932, Japanese names."""
    steps = staircase(21)
    lines = ["機種名,NR-X100", "測定周期,500ms", "時間[s],トルク[mN・m],回転速度[rpm],温度[℃]"]
    _write(path, lines + _rows(steps, ","), "cp932")
    return Made(truth(steps))


def gbk(path: Path) -> Made:
    """A Chinese torque meter: GBK, tabs."""
    steps = staircase(22)
    lines = ["扭矩测试仪\t", "时间(s)\t扭矩(mN.m)\t转速(rpm)\t温度(℃)"]
    _write(path, lines + _rows(steps, "\t"), "gbk")
    return Made(truth(steps))


def utf16(path: Path) -> Made:
    """Agilent BenchLink: UTF-16 with a mark, tabs."""
    steps = staircase(23)
    lines = ["Name:\tbench", "Owner:\tA", "", "Time (s)\tTorque (mN.m)\tSpeed (rpm)\tTemp (°C)"]
    _write(path, lines + _rows(steps, "\t"), "utf-16")
    return Made(truth(steps))


def blanks(path: Path) -> Made:
    """Tabs and blanks mixed between cells."""
    steps = staircase(24)
    lines = ["t [s]\t  M [mN*m]   n [rpm] \tT [degC]"]
    lines += [f"{t}\t {m}   {n} \t{c}" for s in steps for t, m, n, c in s.cells(*_ALL)]
    _write(path, lines)
    return Made(truth(steps))


def fixed(path: Path) -> Made:
    """Fixed width, Fortran style, with units in a row below."""
    steps = staircase(25)
    lines = [f"{'Time':>10}{'Torque':>12}{'Speed':>10}{'Temp':>9}"]
    lines += [f"{'(s)':>10}{'(mN*m)':>12}{'(rpm)':>10}{'(degC)':>9}"]
    lines += [f"{t:>10}{m:>12}{n:>10}{c:>9}" for s in steps for t, m, n, c in s.cells(*_ALL)]
    _write(path, lines)
    return Made(truth(steps))


def quoted(path: Path) -> Made:
    """Every cell in quotes, decimal comma, comma between cells."""
    steps = staircase(26)
    lines = ['"Time [s]","Torque [mN*m]","Speed [rpm]","Temp [degC]"']
    for step in steps:
        lines += [",".join(f'"{cell.replace(".", ",")}"' for cell in row) for row in step.cells(*_ALL)]
    _write(path, lines)
    return Made(truth(steps))


def thousands(path: Path) -> Made:
    """Thousands marks and decimal comma: torque in uN m."""
    steps = staircase(27)
    lines = ["Zeit [s];Drehmoment [µN*m];Drehzahl [1/min];Temperatur [°C]"]
    for step in steps:
        for t, m, n, c in step.cells(*_ALL):
            torque = f"{1000 * float(m):,.1f}".replace(",", " ").replace(".", ",").replace(" ", ".")
            lines += [f"{t};".replace(".", ",") + torque + f";{n};{c}".replace(".", ",")]
    _write(path, lines, "cp1252")
    return Made(truth(steps))


def swiss(path: Path) -> Made:
    """Apostrophes as thousands marks, decimal point: torque in uN m."""
    steps = staircase(28)
    lines = ["Zeit [s];Drehmoment [µN*m];Drehzahl [1/min];Temperatur [°C]"]
    for step in steps:
        for t, m, n, c in step.cells(*_ALL):
            lines += [f"{t};{1000 * float(m):,.1f};{n};{c}".replace(",", "'")]
    _write(path, lines, "latin-1")
    return Made(truth(steps))


def percent(path: Path) -> Made:
    """Comment lines with '%', the last of them the header, as MATLAB scripts write."""
    steps = staircase(29)
    lines = ["% bench 4", "% time [s]   torque [mN*m]   speed [rpm]   temp [degC]"]
    _write(path, lines + _rows(steps, "   "))
    return Made(truth(steps))


def commented(path: Path) -> Made:
    """The header in a comment with '#', as numpy.savetxt writes it."""
    steps = staircase(30)
    lines = ["# bench 4", "# time [s];torque [mN*m];speed [rpm];temp [degC]"]
    _write(path, lines + _rows(steps, ";"))
    return Made(truth(steps))


def three_rows(path: Path) -> Made:
    """Names, units, then sources: three rows of header (Campbell TOA5)."""
    steps = staircase(31)
    lines = ['"TOA5","bench","CR1000"', '"TIMESTAMP","Torque_Avg","Speed_Avg","Temp_Avg"']
    lines += ['"TS","mN*m","rpm","Deg C"', '"","Avg","Avg","Avg"']
    lines += [
        f'"2024-03-01 08:{int(float(t)) // 60:02d}:{float(t) % 60:05.2f}",{m},{n},{c}'
        for s in steps
        for t, m, n, c in s.cells(*_ALL)
    ]
    _write(path, lines)
    return Made(truth(steps))


def names_apart(path: Path) -> Made:
    """Graphtec: columns CH1, CH2, their names in a list above, units in a row below."""
    steps = staircase(32)
    lines = ["Vendor,GRAPHTEC Corporation", "Sampling interval,500ms", "AMP settings"]
    lines += ["CH,Signal name,Input", 'CH1,"Torque",DC', 'CH2,"Speed",DC', 'CH3,"Temp",TEMP', "Data"]
    lines += ["Number,Date&Time,ms,CH1,CH2,CH3", "NO.,Time,ms,mNm,rpm,degC"]
    for at, (t, m, n, c) in enumerate((row for s in steps for row in s.cells(*_ALL)), 1):
        whole, part = divmod(round(1000 * float(t)), 1000)
        lines += [f"{at},2024/03/01 08:{whole // 60:02d}:{whole % 60:02d},{part},+{m},+{n},+{c}"]
    _write(path, lines)
    return Made(truth(steps))


def transposed(path: Path) -> Made:
    """A channel in each row."""
    steps = staircase(33)
    titles = ("Time [s]", "Torque [mN*m]", "Speed [rpm]", "Temp [degC]")
    lines = [
        ";".join([title, *(cell for s in steps for cell in getattr(s, name))])
        for title, name in zip(titles, _ALL, strict=True)
    ]
    _write(path, lines)
    return Made(truth(steps))


def wide(path: Path) -> Made:
    """A torque column for each speed beside one clock."""
    steps = staircase(34, restart=True)
    lines = ["Time [s];" + ";".join(f"Torque {s.speed:g} rpm [mN*m]" for s in steps)]
    lines += [";".join(row) for row in zip(steps[0].time, *(s.torque for s in steps), strict=True)]
    _write(path, lines)
    return Made(truth(steps, set_point=True, temperature=False))


def wide_with_row(path: Path) -> Made:
    """A row of speeds above pairs of torque and temperature."""
    steps = staircase(35, restart=True)
    lines = ["Speed;" + ";".join(f"{s.speed:g} rpm;" for s in steps)]
    lines += ["Time [s];" + ";".join("Torque [mN*m];Temp [°C]" for _ in steps)]
    pairs = [column for s in steps for column in (s.torque, s.temperature)]
    lines += [";".join(row) for row in zip(steps[0].time, *pairs, strict=True)]
    _write(path, lines)
    return Made(truth(steps, set_point=True))


def unequal(path: Path) -> Made:
    """Runs side by side, each with a clock of its own, of unequal length."""
    steps = staircase(36, rows=(40, 55, 30, 47), restart=True)
    lines = [";".join(f"Time{i} [s];Torque{i} [mN*m];Speed{i} [rpm];Temp{i} [degC]" for i in range(1, 5))]
    columns = [getattr(s, name) for s in steps for name in _ALL]
    lines += [";".join(row) for row in zip_longest(*columns, fillvalue="")]
    _write(path, lines)
    return Made(truth(steps))


def repeated_names(path: Path) -> Made:
    """Runs side by side under the same names, of unequal length (Origin, Excel)."""
    steps = staircase(37, rows=(30, 44, 38, 51), restart=True)
    lines = [";".join(["Time [s];Torque [mN*m];Speed [rpm];Temp [degC]"] * 4)]
    columns = [getattr(s, name) for s in steps for name in _ALL]
    lines += [";".join(row) for row in zip_longest(*columns, fillvalue="")]
    _write(path, lines)
    return Made(truth(steps))


def twincat(path: Path) -> Made:
    """TwinCAT Scope: a clock beside each channel, names and units in rows above; after readers of it."""
    steps = staircase(38)
    lines = ["Name\tbench", "File\tC:\\bench.svdx", "Starttime of export\t133538976000000000", ""]
    for key, values in (
        ("Name", ("Torque", "Speed", "Temperature")),
        ("Data-Type", ("REAL64",) * 3),
        ("SampleTime[ms]", ("500",) * 3),
        ("Unit", ("mNm", "rpm", "°C")),
    ):
        lines += ["\t".join(f"{key}\t{value}" for value in values)]
    lines += [""]
    for t, m, n, c in (row for s in steps for row in s.cells(*_ALL)):
        tick = f"{1000 * float(t):.0f}"
        lines += [f"{tick}\t{m}\t{tick}\t{n}\t{tick}\t{c}"]
    _write(path, lines)
    return Made(truth(steps))


def twincat_semicolons(path: Path) -> Made:
    """TwinCAT Scope: semicolons and decimal commas, more keys, units only in words."""
    steps = staircase(41)
    lines = ["Name;Bench", "File;C:\\b.svdx", "Starttime of export;1335;Freitag;10:04:42.138", ""]
    for key, values in (
        ("Name", ("Main.Torque", "Main.Speed", "Main.Temperature")),
        ("SymbolComment", ("", "", "Lager vorn 1")),
        ("Data-Type", ("INT16", "REAL64", "REAL64")),
        ("SampleTime[ms]", ("500",) * 3),
        ("Port", ("851",) * 3),
        ("ScaleFactor", ("1",) * 3),
    ):
        lines += [";".join(f"{key};{value}" for value in values)]
    lines += [""]
    for t, m, n, c in (row for s in steps for row in s.cells(*_ALL)):
        tick = f"{1000 * float(t):.0f}"
        lines += [f"{tick};{m};{tick};{n};{tick};{c}".replace(".", ",")]
    _write(path, lines)
    return Made(truth(steps), {"--torque-unit": "mN*m", "--speed-unit": "rpm", "--temperature-unit": "degC"})


def yokogawa(path: Path) -> Made:
    """Yokogawa: keys and a value for each trace, no clock, an empty first cell."""
    steps = staircase(39)
    lines = ["Model,DL850", "BlockNumber,1", "TraceName,Torque,Speed,Temp", "BlockSize,160,160,160"]
    lines += ["VUnit,mNm,rpm,degC", "HResolution,5.0E-01,5.0E-01,5.0E-01", "HUnit,s,s,s", ""]
    lines += [f",{m},{n},{c}" for s in steps for _, m, n, c in s.cells(*_ALL)]
    _write(path, lines)
    return Made(truth(steps), {"--every": "500 ms"})


def wincc(path: Path) -> Made:
    """Siemens WinCC archive: a long table, a row for each value."""
    steps = staircase(40)
    lines = ['"VarName";"TimeString";"VarValue";"Validity";"Time_ms"']
    for t, m, n, c in (row for s in steps for row in s.cells(*_ALL)):
        whole, part = divmod(float(t), 1)
        stamp = f"01.03.2024 08:{int(whole) // 60:02d}:{int(whole) % 60:02d}"
        day = f"{(45352 + (8 * 3600 + whole + part) / 86400) * 1e6:.6f}".replace(".", ",")
        for name, value in (("Torque", m), ("Speed", n), ("Temp", c)):
            lines += [f'"{name}";"{stamp}";{value.replace(".", ",")};1;{day}']
    _write(path, lines)
    return Made(truth(steps), {"--torque-unit": "mN*m", "--speed-unit": "rpm", "--temperature-unit": "degC"})
