"""More exports, written after those of `unseen` were mended and before anyone looked at how they are read."""

from __future__ import annotations

from pathlib import Path

from tests.untrusted_input.other_blocks import xlsx

from benchmarks.layouts.sections import _ALL, _lines, _write
from benchmarks.layouts.truth import Made, Truth, staircase, truth


def vesc(path: Path) -> Made:
    """VESC Tool realtime log: semicolons, motor current, electrical speed, several temperatures, no units."""
    steps = staircase(81)
    lines = ["ms_today;input_voltage;temp_mos_max;temp_motor;current_motor;current_in;duty_cycle;erpm;tacho"]
    for step in steps:
        for t, m, n, c in step.cells(*_ALL):
            lines.append(
                f"{36000000 + round(1000 * float(t))};24.1;{float(c) - 3:.1f};{c};{m};0.8;.2;{n};{len(lines)}"
            )
    _write(path, lines, end="\n")
    options = {
        "--time": "ms_today",
        "--time-unit": "ms",
        "--torque": "current_motor",
        "--torque-unit": "2 mN*m/A",
        "--speed": "erpm",
        "--speed-unit": "rpm/7",
        "--temperature": "temp_motor",
        "--temperature-unit": "degC",
    }
    made = truth(steps, torque_scale=2e-3)
    return Made(Truth(made.torque, made.speed / 7, made.time, made.temperature), options)


def copley(path: Path) -> Made:
    """Copley CME scope: current and motor speed, no torque and no temperature."""
    steps = staircase(82)
    lines = ["Time(ms),Actual Current(A),Actual Motor Velocity(rpm)"]
    lines += [f"{1000 * float(t):.1f},{m},{n}" for step in steps for t, m, n, _ in step.cells(*_ALL)]
    _write(path, lines)
    return Made(truth(steps, temperature=False, torque_scale=52e-3), {"--torque-unit": "52 mN*m/A"})


def canape(path: Path) -> Made:
    """CANape: one clock, a slow temperature with empty cells between its values."""
    steps = staircase(83)
    lines = ["Time[s];EM_Trq[mNm];EM_Spd[rpm];OilTemp[degC]"]
    for step in steps:
        for i, (t, m, n, _) in enumerate(step.cells(*_ALL)):
            lines.append(
                f"{t};{m};{n};{step.temperature[0] if i % 10 == 0 or t == steps[-1].time[-1] else ''}"
            )
    _write(path, lines)
    made = truth(steps)
    return Made(Truth(made.torque, made.speed, made.time))


def instron(path: Path) -> Made:
    """Instron WaveMatrix: quoted names with the source and the unit, a cycle count beside."""
    steps = staircase(84)
    lines = [
        '"Total Time (s)","Total Cycles","Rotary Torque(Rotary:Torque) (N·m)",'
        '"Rotary Speed(Rotary:Velocity) (rpm)","Temperature(Chamber:Temperature) (°C)"'
    ]
    for step in steps:
        lines += [f'"{t}","1","{float(m) / 1000:.6f}","{n}","{c}"' for t, m, n, c in step.cells(*_ALL)]
    _write(path, lines, "utf-8-sig")
    return Made(truth(steps))


def famos(path: Path) -> Made:
    """FAMOS of imc, ASCII: names, units in brackets below, tabs, decimal comma, a comment line above."""
    steps = staircase(85)
    lines = [
        "Exportiert mit imc FAMOS am 03.12.2024",
        "Zeit\tM_Welle\tn_Welle\tT_Oel",
        "[s]\t[mNm]\t[1/min]\t[°C]",
    ]
    lines += [line for step in steps for line in _lines(step.cells(*_ALL), comma=True)]
    _write(path, lines, "cp1252")
    return Made(truth(steps))


def influx(path: Path) -> Made:
    """InfluxDB, annotated CSV: comments, a row for each value, a field name, a table for each channel."""
    steps = staircase(86, every=1.0)
    head = [
        "#group,false,false,true,true,false,false,true,true",
        "#datatype,string,long,dateTime:RFC3339,dateTime:RFC3339,dateTime:RFC3339,double,string,string",
        "#default,_result,,,,,,,",
        ",result,table,_start,_stop,_time,_value,_field,_measurement",
    ]
    lines = list(head)
    for table, (field, name) in enumerate(
        [("torque_mNm", "torque"), ("speed_rpm", "turning"), ("temp_degC", "temperature")]
    ):
        for step in steps:
            for t, value in step.cells("time", name):
                minutes, seconds = divmod(int(float(t)), 60)
                at = f"2024-03-01T08:{minutes:02d}:{seconds:02d}Z"
                lines.append(f",,{table},2024-03-01T08:00:00Z,2024-03-01T09:00:00Z,{at},{value},{field},seal")
    _write(path, lines)
    return Made(truth(steps))


def rostopic(path: Path) -> Made:
    """ROS, rostopic echo -p: a clock in ns of the epoch, fields by path, no units."""
    steps = staircase(87)
    lines = ["%time,field.header.seq,field.header.stamp,field.velocity0,field.effort0,field.temperature0"]
    start = 1709280000000000000
    for step in steps:
        for t, m, n, c in step.cells(*_ALL):
            at = start + round(float(t) * 1e9)
            lines.append(f"{at},{len(lines)},{at},{n},{m},{c}")
    _write(path, lines, end="\n")
    options = {
        "--time": "%time",
        "--time-unit": "ns",
        "--torque": "field.effort0",
        "--torque-unit": "mN*m",
        "--speed": "field.velocity0",
        "--speed-unit": "rpm",
        "--temperature": "field.temperature0",
        "--temperature-unit": "degC",
    }
    return Made(truth(steps), options)


def timetable(path: Path) -> Made:
    """MATLAB writetimetable: durations as '0.5 sec', names with their units at the end."""
    steps = staircase(88)
    lines = ["Time,Torque_mNm,Speed_rpm,Oil_degC"]
    lines += [f"{float(t):g} sec,{m},{n},{c}" for step in steps for t, m, n, c in step.cells(*_ALL)]
    _write(path, lines)
    return Made(truth(steps))


def split_date(path: Path) -> Made:
    """A data logger with date and time of day in columns apart, units in brackets, semicolons."""
    steps = staircase(89)
    lines = ["Datum;Uhrzeit;Drehmoment [mNm];Drehzahl [1/min];Temperatur [°C]"]
    for step in steps:
        for t, m, n, c in step.cells(*_ALL):
            minutes, seconds = divmod(float(t), 60)
            clock = f"08:{int(minutes):02d}:{seconds:06.3f}"
            lines.append(f"03.12.2024;{clock};" + f"{m};{n};{c}".replace(".", ","))
    _write(path, lines, "cp1252")
    return Made(truth(steps))


def info_sheet(path: Path) -> Made:
    """A workbook with a sheet of information before the data, whose names and units begin in row 3."""
    steps = staircase(90)
    info: list[list[object]] = [
        ["Operator", "M."],
        ["Specimen", "S4"],
        ["Load", "50 N"],
        ["Date", "2024-03-01"],
    ]
    rows = [list(map(float, row)) for step in steps for row in step.cells(*_ALL)]
    data = [
        ["Export of bench 3"],
        [],
        ["Time", "Torque", "Speed", "Oil"],
        ["s", "mN·m", "1/min", "°C"],
        *rows,
    ]
    path.write_bytes(xlsx({"Info": info, "Data": data}))
    return Made(truth(steps))


def grafana(path: Path) -> Made:
    """Grafana, series joined by time: dates with a blank, units behind the numbers."""
    steps = staircase(91, every=1.0)
    lines = ['"Time","Torque","Speed","Oil temperature"']
    for step in steps:
        for t, m, n, c in step.cells(*_ALL):
            minutes, seconds = divmod(int(float(t)), 60)
            lines.append(f"2024-03-01 08:{minutes:02d}:{seconds:02d},{m} mN·m,{n} rpm,{c} °C")
    _write(path, lines)
    return Made(truth(steps))


CASES = {
    "vesc": (vesc, ".csv"),
    "copley": (copley, ".csv"),
    "canape": (canape, ".csv"),
    "instron": (instron, ".csv"),
    "famos": (famos, ".txt"),
    "influx": (influx, ".csv"),
    "rostopic": (rostopic, ".csv"),
    "timetable": (timetable, ".csv"),
    "split_date": (split_date, ".csv"),
    "info_sheet": (info_sheet, ".xlsx"),
    "grafana": (grafana, ".csv"),
}
