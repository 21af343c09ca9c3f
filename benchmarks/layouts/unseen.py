"""Exports of instruments, written before anyone looked at how they are read."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.layouts.sections import _ALL, _lines, _write
from benchmarks.layouts.truth import Made, Truth, staircase, truth


def picoscope(path: Path) -> Made:
    """PicoScope: channels by letter with custom probes, units in brackets below, then an empty line."""
    steps = staircase(61)
    lines = ["Time,Channel A,Channel B,Channel C", "(s),(mN·m),(rpm),(°C)", ""]
    lines += [line for step in steps for line in _lines(step.cells(*_ALL), ",")]
    _write(path, lines)
    return Made(truth(steps))


def tektronix(path: Path) -> Made:
    """Tektronix MDO: keys and a value for each channel, units and labels in such lines, then TIME and CH1."""
    steps = staircase(62)
    lines = ["Model,MDO3024", "Firmware Version,1.26", "", "Waveform Type,ANALOG", "Point Format,Y"]
    lines += ["Horizontal Units,s", "Horizontal Scale,4", "Horizontal Delay,0", "Sample Interval,0.5"]
    lines += ["Record Length,160", "Gating,0.0% to 100.0%", "Probe Attenuation,1,1,1"]
    lines += ["Vertical Units,mNm,rpm,degC", "Vertical Offset,0,0,0", "Vertical Scale,10,20,10"]
    lines += ["Label,Torque,Speed,Temperature", "TIME,CH1,CH2,CH3"]
    lines += [line for step in steps for line in _lines(step.cells(*_ALL), ",")]
    _write(path, lines)
    return Made(truth(steps))


def hobo(path: Path) -> Made:
    """Onset HOBO: a title, a comma before the unit and serial numbers behind, AM and PM."""
    steps = staircase(63, every=1.0)
    lines = ['"Plot Title: seal bench"']
    serial = "(LGR S/N: 20412345, SEN S/N: 20412345)"
    lines += [f'"#","Date Time, GMT+01:00","Torque, mN·m {serial}","Speed, rpm {serial}","Temp, °C {serial}"']
    rows = [row for step in steps for row in step.cells(*_ALL)]
    for i, (t, *cells) in enumerate(rows, 1):
        minutes, seconds = divmod(int(float(t)), 60)
        lines.append(
            f"{i},03/12/24 11:{58 + minutes if minutes < 2 else minutes - 2:02d}:{seconds:02d} AM,"
            + ",".join(cells)
            if minutes < 2
            else f"{i},03/12/24 12:{minutes - 2:02d}:{seconds:02d} PM," + ",".join(cells)
        )
    _write(path, lines)
    return Made(truth(steps))


def mts(path: Path) -> Made:
    """MTS TestWare: a line of marks, then a line, names and units for each acquisition."""
    steps = staircase(64)
    lines = ["MTS793|MPT|ENU|1|2|.|/|:|1|0|0|A", ""]
    for step in steps:
        lines += [
            f"Data Acquisition:\tTimed Data\tTime:\t{float(step.time[-1]):.6f}\tSec\t12/03/2024 10:22:12 AM"
        ]
        lines += ["Time\tTorsional Torque\tRotary Speed\tOil Temperature", "Sec\tN-m\tRPM\tdeg_C"]
        lines += [f"{t}\t{float(m) / 1000:.6f}\t{n}\t{c}" for t, m, n, c in step.cells(*_ALL)] + [""]
    _write(path, lines)
    return Made(truth(steps))


def inca(path: Path) -> Made:
    """ETAS INCA, ASCII: a record line, a count, names, kinds, then units, tabs."""
    steps = staircase(65)
    lines = ["ETASAsciiItemFile\trecord\tDefault", "sampleCount\t160"]
    lines += ["time\tTrqAct\tnAct\ttOil", "f8\tf8\tf8\tf8", "s\tmNm\trpm\tdegC"]
    lines += [line for step in steps for line in _lines(step.cells(*_ALL))]
    _write(path, lines)
    return Made(truth(steps))


def rtde(path: Path) -> Made:
    """Universal Robots RTDE: blanks between cells, a column for each of six joints, no units."""
    steps = staircase(66)
    names = ["timestamp"]
    names += [
        f"{kind}_{i}" for kind in ("actual_qd", "target_moment", "joint_temperatures") for i in range(6)
    ]
    lines = [" ".join(names)]
    draw = np.random.default_rng(66)
    for step in steps:
        for t, m, n, c in step.cells(*_ALL):
            speeds, moments, warm = ([f"{x:.4f}" for x in draw.normal(0, 1, 6)] for _ in range(3))
            speeds[2], moments[2], warm[2] = f"{float(n):.2f}", f"{float(m):.3f}", c
            lines.append(" ".join([f"{1000 + float(t):.2f}", *speeds, *moments, *warm]))
    _write(path, lines, end="\n")
    made = truth(steps, torque_scale=1.0)
    # a robot writes rad/s and N m
    made = Truth(made.torque, made.speed * 30 / np.pi, made.time, made.temperature)
    options = {
        "--speed": "actual_qd_2",
        "--torque": "target_moment_2",
        "--temperature": "joint_temperatures_2",
        "--speed-unit": "rad/s",
        "--torque-unit": "N*m",
        "--temperature-unit": "degC",
        "--time-unit": "s",
    }
    return Made(made, options)


def dynamixel(path: Path) -> Made:
    """Dynamixel: registers in counts, a clock in ms, no units."""
    steps = staircase(67)
    lines = ["timestamp_ms,present_position,present_velocity,present_current,present_temperature"]
    speeds, torques, times, warm = [], [], [], []
    for step in steps:
        for t, m, n, c in step.cells(*_ALL):
            velocity, current = round(float(n) / 0.229), round(float(m) * 3)
            lines.append(
                f"{round(1000 * float(t))},{len(times) * 37 % 4096},{velocity},{current},{round(float(c))}"
            )
            times.append(float(t))
            speeds.append(velocity * 0.229 * np.pi / 30)
            torques.append(current * 3.228e-3)
            warm.append(round(float(c)) + 273.15)
    _write(path, lines)
    options = {
        "--speed-unit": "0.229 rpm",
        "--torque-unit": "3.228 mN*m",
        "--temperature-unit": "degC",
        "--time-unit": "ms",
        "--torque": "present_current",
    }
    made = Truth(np.array(torques), np.array(speeds), np.array(times), np.array(warm))
    return Made(made, options)


def rtec(path: Path) -> Made:
    """Rtec MFT: a recipe above, forces and COF beside torque, a step number in each row."""
    steps = staircase(68)
    lines = ["Rtec Instruments", "Recipe,seal 3.rcp", "Radius (mm),12.5", "Steps,4", ""]
    lines += ["Timestamp(s),Step,Fz(N),Tz(N-mm),COF,Rotary velocity(rpm),Chamber temperature(C)"]
    for i, step in enumerate(steps, 1):
        for t, m, n, c in step.cells(*_ALL):
            cof = float(m) / 12.5 / 50
            lines.append(f"{t},{i},{50 + 0.01 * (len(lines) % 7):.2f},{m},{cof:.5f},{n},{c}")
    _write(path, lines)
    return Made(truth(steps), {"--torque": "Tz"})


def bare(path: Path) -> Made:
    """LabVIEW, Write To Spreadsheet File: tabs, decimal comma, no names and no units."""
    steps = staircase(69)
    _write(path, [line for step in steps for line in _lines(step.cells(*_ALL), comma=True)])
    options = {"--time": "#1", "--torque": "#2", "--speed": "#3", "--temperature": "#4", "--time-unit": "s"}
    options |= {"--torque-unit": "mN*m", "--speed-unit": "rpm", "--temperature-unit": "degC"}
    return Made(truth(steps), options)


def hioki(path: Path) -> Made:
    """HIOKI Memory HiCorder: a value for each channel, comments as names, units with channels."""
    steps = staircase(70)
    lines = ['"File name","AUTO0001.CSV","V 1.01"', '"Title comment","seal"']
    lines += ['"Trigger Time","\'24-12-03 14:22:03.000"', '"CH","CH1","CH2","CH3"']
    lines += ['"Mode","Voltage","Voltage","Temp"', '"Range","10V","10V","200C"']
    lines += ['"Comment","Torque","Speed","Oil temperature"', '"Scaling","ON","ON","OFF"']
    lines += ['"Time","CH1[mNm]","CH2[rpm]","CH3[C]"']
    lines += [",".join(row) for step in steps for row in step.cells(*_ALL)]
    _write(path, lines, "cp932")
    return Made(truth(steps))


def kinexus(path: Path) -> Made:
    """Malvern Kinexus rSpace: an action name and a description in each row, units as 'rad s-1'."""
    steps = staircase(71)
    lines = ["Action Name,Time(action)(s),Torque(N m),Angular velocity(rad s-1),Temperature(°C)"]
    torques, speeds = [], []
    for i, step in enumerate(steps, 1):
        for t, m, n, c in step.cells(*_ALL):
            torques.append(float(f"{float(m) / 1000:.6f}"))
            speeds.append(float(f"{float(n) * np.pi / 30:.5f}"))
            lines.append(f"Shear rate table_{i},{t},{torques[-1]:.6f},{speeds[-1]:.5f},{c}")
    _write(path, lines)
    made = truth(steps)
    return Made(Truth(np.array(torques), np.array(speeds), made.time, made.temperature))


def magtrol(path: Path) -> Made:
    """Magtrol M-TEST: a title and a date, names, then units, torque in oz.in, amps and watts beside."""
    steps = staircase(72)
    lines = ["M-TEST 7.0,Motor: spindle 12", "12/03/2024,10:22:12 AM"]
    lines += ["Elapsed Time,Speed,Torque,Amps,Watts In,Watts Out,Temperature", "sec,rpm,oz.in,A,W,W,deg C"]
    for step in steps:
        for t, m, n, c in step.cells(*_ALL):
            lines.append(f"{t},{n},{m},0.{len(lines) % 90 + 10},12.1,8.3,{c}")
    _write(path, lines)
    return Made(truth(steps, torque_scale=28.349523125e-3 * 9.80665 * 0.0254))


CASES = {
    **{
        each.__name__: (each, ".csv")
        for each in (picoscope, tektronix, hobo, dynamixel, rtec, hioki, kinexus, magtrol)
    },
    **{each.__name__: (each, ".txt") for each in (mts, inca, rtde, bare)},
}
