"""Traces from files, and ``hersey cycles``."""

from __future__ import annotations

import json
import re
import shlex
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from hersey.errors import (
    ChannelError,
    HerseyError,
    MissingFileError,
    UnitError,
    UnreadableLogError,
)
from hersey.identification.trace_file import read_trace
from tests.cli.command import run
from tests.conftest import ROOT, shared

CSV = ROOT / "examples" / "stick-slip.csv"


def printed(*arguments: str | Path) -> str:
    done = run("cycles", *arguments, cwd=ROOT)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_shipped_trace_comes_from_its_seed(tmp_path: Path) -> None:
    script = ROOT / "examples" / "stick_slip_trace.py"
    done = subprocess.run([sys.executable, script, tmp_path / "again.csv"], check=False, capture_output=True)
    assert done.returncode == 0, done.stderr
    again, shipped = (read_trace(path) for path in (tmp_path / "again.csv", CSV))
    np.testing.assert_allclose(again.value, shipped.value, atol=2e-4)
    assert CSV.read_text().startswith("# SYNTHETIC")
    assert CSV.stat().st_size < 200_000


def test_identified_drive_of_the_shipped_trace(tmp_path: Path) -> None:
    """Truth, which stands in the head of the file, within every interval given."""
    result = run("cycles", CSV, "--drive-speed", "20 mm/s", "--identify", "--json", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    document = json.loads(result.stdout)
    assert document["kind"] == "stick_slip"
    assert document["command"].endswith("--identify --json")
    truth = dict(part.split(" ") for part in CSV.read_text().split("SI: ")[1].split(";")[0].split(", "))
    drive = document["drive"]
    assert {"stiffness", "mass", "transition_force"} <= set(drive["estimates"])
    for name, estimate in drive["estimates"].items():
        assert estimate["low"] <= float(truth[name]) <= estimate["high"], name
    assert (drive["closure"], drive["closure_decided"]) == ("retained", True)


def test_summary_figure_and_known_values(tmp_path: Path) -> None:
    figure = tmp_path / "fit.png"
    options = ["--drive-speed", "20 mm/s", "--identify", "--closures", "retained"]
    text = printed(CSV, *options, "--known", "mass=500 g", "--figure", figure)
    assert text.startswith("Stick-slip with 110 slips.\n")
    assert "0.5 kg (given)" in text
    assert figure.read_bytes().startswith(b"\x89PNG")
    refused = run("cycles", CSV, "--figure", figure, cwd=tmp_path)
    assert (refused.returncode, "use --force" in refused.stderr) == (2, True)


def test_the_uncertainty_of_the_drive_speed_and_falls_that_are_not_counted(tmp_path: Path) -> None:
    speed = ["--drive-speed", "20 mm/s", "--drive-speed-uncertainty", "2 %"]
    known = ["--known", "stick_speed=0.2 mm/s", "--closures", "retained"]
    text = printed(CSV, *speed, "--identify", *known)
    assert "The intervals assume a drive speed of 20 mm/s within 2 %." in text
    document = json.loads(printed(CSV, *speed, "--identify", *known, "--json"))["drive"]
    stiffness = document["estimates"]["stiffness"]
    assert document["systematic"]["stiffness"] == pytest.approx(0.02 * stiffness["value"], rel=0.1)
    assert printed(CSV, "--least-drop", "1 kN").startswith(
        "Stick slip: 110 drops exceed the noise, none of at least 1e+03 N"
    )
    path = tmp_path / "share.csv"
    path.write_text("\n".join(["time [s],force [1]", *(f"{0.01 * i},{i % 50 / 500}" for i in range(600))]))
    for least in ("20 %", "0.2"):
        told = " ".join(printed(path, "--least-drop", least).split())
        assert "drops exceed the noise, none of at least 20 % of the load; the largest is 9" in told


def numbers_of(heading: str, tmp_path: Path) -> Path:
    """The shipped trace under another heading: the same numbers, so the same drive in the units of that."""
    path = tmp_path / "other.csv"
    path.write_text(CSV.read_text().replace("time [s],force [N]", heading))
    return path


@pytest.mark.parametrize(
    ("heading", "drive_speed", "known", "missing"),
    [
        (
            "time [s],torque [N*m]",
            "0.02 rad/s",
            {"mass": "5000 kg*cm^2", "stick_speed": "0.0019098593 rpm", "transition_force": "1000 mN*m"},
            "'1' is not a number with a unit of moment of inertia. Write e.g. '1 kg*m^2'",
        ),
        (
            "time [s],force [1]",
            "20 mm/s",
            {"mass": "500 s^2/km", "stick_speed": "0.2 mm/s", "transition_force": "100 %"},
            "'1' is not a number with a unit of mass per weight. Write e.g. '1 s^2/m'",
        ),
    ],
)
def test_known_numbers_of_a_torque_and_of_a_share_carry_units(
    heading: str, drive_speed: str, known: dict[str, str], missing: str, tmp_path: Path
) -> None:
    path, identified = numbers_of(heading, tmp_path), ["--identify", "--closures", "retained"]
    given = [part for name, amount in known.items() for part in ("--known", f"{name}={amount}")]
    document = json.loads(printed(path, "--drive-speed", drive_speed, *identified, *given, "--json"))
    truth = {"mass": 0.5, "stick_speed": 2e-4, "transition_force": 1.0}
    assert document["drive"]["known"] == pytest.approx(truth, rel=1e-7)
    bare = run("cycles", path, "--drive-speed", drive_speed, *identified, "--known", "mass=1", cwd=ROOT)
    assert (bare.returncode, missing in bare.stderr) == (2, True)


def test_a_torque_is_told_in_its_units(tmp_path: Path) -> None:
    path = numbers_of("time [s],torque [mN*m]", tmp_path)
    told = printed(path, "--drive-speed", "0.02 rad/s", "--least-drop", "0.1 mN*m")
    assert "N m/rad (loading slope / speed)" in told
    assert "drops exceed the noise, none of at least 1 N m" in " ".join(
        printed(path, "--least-drop", "1 N*m").split()
    )
    known = ["--known", "mass=5 kg*cm^2", "--closures", "retained"]
    told = printed(path, "--drive-speed", "0.02 rad/s", "--identify", *known)
    assert re.search(r"mass +0\.0005 kg·m\^2 \(given\)", told)


@pytest.mark.parametrize(
    ("heading", "typed", "meant"),
    [
        ("time [s],torque [mN*m]", "200 mm/s", 0.2 / 0.015),
        ("time [s],force [N]", "3 rpm", 3 * 2 * np.pi / 60 * 0.015),
        ("time [s],force [1]", "3 rpm", 3 * 2 * np.pi / 60 * 0.015),
    ],
)
def test_the_speed_of_a_belt_for_that_of_a_roll_comes_with_the_option_to_type(
    heading: str, typed: str, meant: float, tmp_path: Path
) -> None:
    path = numbers_of(heading, tmp_path)
    refused = run("cycles", path, "--drive-speed", typed, cwd=tmp_path)
    assert (refused.returncode, refused.stdout) == (2, "")
    assert refused.stderr.count("--drive-speed") == 2  # what was typed, and what to type
    option = shlex.split(refused.stderr.rpartition("type ")[2])
    document = json.loads(printed(path, *option, "--json"))
    assert document["drive_speed"] == pytest.approx(meant, rel=5e-3)


@pytest.mark.parametrize(
    ("header", "called", "unit"),
    [("force [N]", "force", "N"), ("torque [N*m]", "torque", "N m"), ("belt speed [m/s]", "stretch", "m")],
)
def test_what_drops_is_called_by_what_the_trace_holds(
    header: str, called: str, unit: str, tmp_path: Path
) -> None:
    white = np.random.default_rng(0).normal(size=5000)
    slow = white if called == "stretch" else np.cumsum(white)  # the stretch adds up the speed
    for name, values in (("noise", slow), ("slips", np.arange(5000) % 100 / 50.0)):
        rows = [f"{0.01 * i:.2f},{value:.6f}" for i, value in enumerate(values)]
        (tmp_path / f"{name}.csv").write_text("\n".join([f"time [s],{header}", *rows]))
    quantity = ["--quantity", "speed"] if called == "stretch" else []
    shown = printed(tmp_path / "noise.csv", *quantity)
    assert shown.startswith(f"Irregular {called}: ")
    for verbose in ([], ["--verbose"]):
        shown = printed(tmp_path / "slips.csv", *quantity, *verbose)
        assert re.search(rf"^ *{called} +\S+ to \S+ {unit}(,|$)", shown, re.MULTILINE)


def test_a_log_of_steady_sliding_is_not_identified_but_gets_the_command_for_its_drag() -> None:
    bench = CSV.with_name("bench.csv")
    refused = run("cycles", bench, "--drive-speed", "12.7 rpm", "--identify", cwd=ROOT)
    assert (refused.returncode, refused.stdout) == (2, "")
    assert "the trace is irregular: 363 drops exceed the noise" in refused.stderr
    assert "steady sliding, but" not in refused.stderr
    typed = shlex.split(refused.stderr.rpartition("type: ")[2])
    assert typed == ["hersey", "report", str(bench)]
    assert run("report", bench, "--json", cwd=ROOT).returncode == 0


def test_a_channel_of_the_drive_speed(tmp_path: Path) -> None:
    path = tmp_path / "pull.csv"
    rows = [f"{0.01 * i:.2f},{i % 50 / 5},{20 + (i % 2)}" for i in range(600)]
    path.write_text("\n".join(["time [s],force [N],vd [mm/s]", *rows]))
    document = json.loads(printed(path, "--drive-speed-channel", "vd", "--json"))
    assert document["drive_speed"] == pytest.approx(0.0205, rel=1e-6)
    assert document["drive_speed_uncertainty"] == pytest.approx(1e-3, rel=1e-3)
    both = run("cycles", path, "--drive-speed-channel", "vd", "--drive-speed", "20 mm/s", cwd=tmp_path)
    assert "--drive-speed and --drive-speed-channel exclude each other" in both.stderr
    none = run("cycles", path, "--drive-speed-channel", "force", cwd=tmp_path)
    assert (none.returncode, none.stderr.count("\n")) == (2, 1)


def test_a_mistake_ends_in_one_line(tmp_path: Path) -> None:
    result = run("cycles", CSV, "--drive-speed", "20", cwd=tmp_path)
    assert (result.returncode, result.stdout) == (2, "")
    assert "is not a number with a unit" in result.stderr
    assert result.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--drive-speed", "0 mm/s"], "must be greater than 0"),
        (
            ["--drive-speed", "3 rpm"],
            "is a rotational speed, but a trace of force in N needs a sliding speed",
        ),
        (["--known", "mass=1 kg"], "--known needs --identify"),
        (["--identify"], "--drive-speed '20 mm/s'"),
        (["--identify", "--known", "weight=1 kg"], "write NAME=VALUE with one of stiffness, mass"),
        (["--identify", "--known", "mass=1 s"], "--known mass: unit 's' is not a unit of mass"),
        (["--identify", "--known", "mass=1"], "--known mass: '1' is not a number with a unit of mass"),
        (["--identify", "--known", "ehl_exponent=-0.7 s"], "ehl_exponent is '-0.7 s': write a number"),
        (["--least-drop", "5 mm"], "--least-drop: unit 'mm' is not a unit of force"),
        (["--least-drop", "5"], "--least-drop: '5' is not a number with a unit of force"),
        (
            ["--drive-speed-uncertainty", "2"],
            "--drive-speed-uncertainty is '2': write a percentage, e.g. '2 %'",
        ),
        (["--drive-speed-uncertainty", "90 %"], "drive_speed_uncertainty is 0.9: it must be greater than 0"),
        (["--value", "pull"], "there is no column 'pull'. Columns: time [s], force [N]"),
        (["--quantity", "heat"], "unknown quantity 'heat'"),
        (["--figure", "fit.bmp"], "name a file that ends in .html"),
    ],
)
def test_mistakes_are_named(arguments: list[str], message: str) -> None:
    done = run("cycles", CSV, *arguments, cwd=ROOT)
    assert (done.returncode, done.stdout) == (2, "")
    assert message in done.stderr


def test_units_and_names_of_a_csv_file(tmp_path: Path) -> None:
    path = tmp_path / "pull.csv"
    path.write_text("# bench 2\nTime (ms),pull,Torque [mN m]\n0,1,5\n1,,6\n2,nan,7\n")
    torque = read_trace(path)
    assert torque.quantity == "torque"
    np.testing.assert_allclose(torque.time, [0, 1e-3, 2e-3])
    np.testing.assert_allclose(torque.value, [5e-3, 6e-3, 7e-3])
    pull = read_trace(path, value="pull", unit="lbf")
    assert pull.value[0] == pytest.approx(4.4482216)
    assert np.isnan(pull.value[1:]).all()
    with pytest.raises(UnitError, match=r"pull has no unit. Give unit='N'"):
        read_trace(path, value="pull")
    path.write_text("time [s],force [N]\n0,1\n1,l0\n")
    with pytest.raises(UnreadableLogError, match=r"line 3, column 'force': 'l0' is not a number"):
        read_trace(path)
    path.write_text("time [s],a,b\n0,1,2\n")
    with pytest.raises(ChannelError, match="has no force, torque or speed"):
        read_trace(path)
    with pytest.raises(MissingFileError):
        read_trace(tmp_path / "none.csv")


def test_mat_files(tmp_path: Path) -> None:
    path = tmp_path / "pull.mat"
    savemat(path, {"t": np.arange(5.0), "force": np.arange(5.0), "long": np.arange(9.0), "note": "x"})
    found = read_trace(path, time_unit="ms", unit="N")
    np.testing.assert_allclose(found.time, np.arange(5) * 1e-3)
    with pytest.raises(UnitError, match=r"t has no unit. Give time_unit='s'"):
        read_trace(path, unit="N")
    with pytest.raises(UnreadableLogError, match="t has 5 numbers, but long has 9"):
        read_trace(path, value="long", time_unit="s", unit="N")


def test_damaged_files_end_in_a_clear_error_or_a_partial_read(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    savemat(tmp_path / "whole.mat", {"t": np.arange(500.0), "force": rng.normal(size=500)})
    wholes = [(tmp_path / "whole.mat").read_bytes(), CSV.read_bytes()[:20_000]]
    for whole, suffix in zip(wholes, (".mat", ".csv"), strict=True):
        path = tmp_path / f"damaged{suffix}"
        for share in range(1, 100, 3):
            path.write_bytes(whole[: len(whole) * share // 100])
            _reads_or_says_why(path)
        for _ in range(60):
            flipped = bytearray(whole)
            flipped[rng.integers(len(whole))] ^= 1 << int(rng.integers(8))
            path.write_bytes(bytes(flipped))
            _reads_or_says_why(path)


def _reads_or_says_why(path: Path) -> None:
    found, reason = None, ""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            found = read_trace(path, time_unit="s", unit="N")
        except HerseyError as error:
            reason = str(error)
    assert path.name in reason if found is None else found.time.shape == found.value.shape


@pytest.mark.parametrize(
    ("speed", "kind", "slips"), [(42, "stick_slip", 477), (1100, "stick_slip", 206), (4300, "inertial", 130)]
)
def test_the_slider_through_the_command(speed: int, kind: str, slips: int) -> None:
    path = shared(f"data/stick-slip/k1002Nm_v{speed}.mat")
    units = ["--time-unit", "s", "--unit", "1", "--least-drop", "0.05"]
    document = json.loads(printed(path, "--drive-speed", f"{speed} um/s", *units, "--json"))
    assert document["kind"] == kind
    assert document["slips"] == pytest.approx(slips, rel=0.05)
    assert document["unit"] == "1"


def test_a_clock_that_starts_anew_parts_the_trace_as_it_parts_a_log(tmp_path: Path) -> None:
    lines = [line for line in CSV.read_text().splitlines() if not line.startswith("#")]
    half = len(lines) // 2
    start = float(lines[half].split(",")[0])
    again = [f"{float(line.split(',')[0]) - start:.6f},{line.split(',')[1]}" for line in lines[half:]]
    twice = tmp_path / "twice.csv"
    twice.write_text("\n".join([*lines[:half], *again, ""]))
    halves = []
    for name, part in (("one.csv", lines[:half]), ("two.csv", [lines[0], *again])):
        (tmp_path / name).write_text("\n".join([*part, ""]))
        halves.append(json.loads(printed(tmp_path / name, "--json"))["slips"])
    text = printed(twice)
    assert [f"Stick-slip with {slips} slips." in text for slips in halves] == [True, True]
    assert "\nRun 2 of 2\n" in text
    for number, slips in enumerate(halves, start=1):
        assert json.loads(printed(twice, "--run-number", str(number), "--json"))["slips"] == slips
    refused = run("cycles", twice, "--json", cwd=tmp_path)
    assert (refused.returncode, "--run-number 1 to 2" in refused.stderr) == (2, True)
    refused = run("cycles", twice, "--run-number", "3", cwd=tmp_path)
    assert (refused.returncode, "holds 2 runs" in refused.stderr) == (2, True)
    with pytest.raises(UnreadableLogError, match=r"twice\.csv has 2 runs, because its time restarts"):
        read_trace(twice)


def of_two_sizes(heading: str, folder: Path) -> Path:
    """A trace of 20 large teeth and 8 small ones; of a speed, that of a belt whose spring stretches so."""

    def teeth(count: int, rise: int, height: float) -> np.ndarray:
        up = np.linspace(0.0, height, rise, endpoint=False)
        return np.tile(np.concatenate([up, np.linspace(height, 0.0, 20, endpoint=False)]), count)

    values = np.concatenate([teeth(20, 180, 10.0), teeth(8, 30, 2.0)])
    if "Speed" in heading:
        values = 20.0 - 0.2 * np.gradient(values, 0.01)
    rows = "".join(f"{3.0 + 0.01 * i:.2f},{value:.6g}\n" for i, value in enumerate(values))
    path = folder / "trace.csv"
    path.write_text(f"Time [s],{heading}\n{rows}")
    return path


@pytest.mark.parametrize(
    ("heading", "more", "unit"),
    [("Force [N]", [], " N"), ("Torque [mN*m]", [], " N*m"), ("Force", ["--unit", "1"], "")],
)
def test_the_smallest_drop_to_count_is_typed_as_shown(
    heading: str, more: list[str], unit: str, tmp_path: Path
) -> None:
    path = of_two_sizes(heading, tmp_path)
    advice = re.search(r"half the median with --least-drop (.+?)\.\n", f"{unwrapped(printed(path, *more))}\n")
    assert advice
    (typed,) = shlex.split(advice[1])
    assert typed.lstrip("0123456789.e-") == unit
    assert "half the median" not in printed(path, *more, "--least-drop", typed)


def test_a_trace_of_speed_is_offered_no_smallest_drop(tmp_path: Path) -> None:
    said = unwrapped(printed(of_two_sizes("Speed [mm/s]", tmp_path)))
    assert re.search(r"smallest drop counted \([\d.e-]+ m here; samples scatter by [\d.e-]+ m\)\.$", said)


def unwrapped(text: str) -> str:
    return " ".join(text.split())
