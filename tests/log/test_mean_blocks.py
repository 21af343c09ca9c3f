"""Tables of means in blocks below one header: loads, tests and blocks at one speed are kept apart."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.errors import ParameterError, UnreadableLogError
from hersey.log.mean_signs import is_means_table
from hersey.log.means import read_means
from tests.cli.command import run

SPEEDS = np.geomspace(6.0, 1500.0, 14).round()
RPM = np.pi / 30


def of_hersey(speed: np.ndarray, load: float) -> np.ndarray:
    """A Stribeck curve of speed over load, least at 0.25 rpm/N."""
    number = 4.0 * speed / load
    return 0.02 * np.where(number < 1.0, number**-0.5, number**0.6)


def of_speed(speed: np.ndarray, load: float) -> np.ndarray:  # noqa: ARG001
    """Friction that does not depend on the load."""
    return 0.2 * speed**-0.1


def bearing(path: Path, law: Callable[[np.ndarray, float], np.ndarray], loads: tuple[float, ...]) -> Path:
    lines = ["Bush test", "Oil: VG 32", ""]
    for load in loads:
        lines += [f"Normal load: {load:g} N (at {load / 100:g} MPa)", "n [1/min]\tmu [-]\tT oil [degC]"]
        lines += [f"{n:g}\t{mu:.5f}\t50.0" for n, mu in zip(SPEEDS, law(SPEEDS, load), strict=True)]
        lines.append("")
    path.write_text("\n".join(lines), newline="\r\n")
    return path


def test_the_line_above_a_block_states_its_load(tmp_path: Path) -> None:
    table = read_means(bearing(tmp_path / "bush.txt", of_hersey, (200.0, 900.0)), isothermal=True)
    assert [row.load for row in table.means] == [200.0] * 14 + [900.0] * 14
    assert [row.run for row in table.means] == [0] * 14 + [1] * 14
    assert [row.speed / RPM for row in table.means] == pytest.approx([*SPEEDS, *SPEEDS])
    assert [w.kind for w in table.files[0].warnings] == ["layout recognized", "table in blocks", "load known"]
    assert table.files[0].missing_rows == 0
    stated = read_means(tmp_path / "bush.txt", isothermal=True, load=50.0)
    assert {row.load for row in stated.means} == {50.0}


def test_curves_of_several_loads_are_not_pooled_and_one_is_read_alone(tmp_path: Path) -> None:
    bearing(tmp_path / "bush.txt", of_hersey, (200.0, 900.0))
    typed = ("fit", "bush.txt", "--isothermal")
    refused = run(*typed, cwd=tmp_path)
    assert "friction coefficients at 200 to 900 N lie " in refused.stderr
    advice = refused.stderr.partition("e.g. with ")[2]
    assert advice == "--blocks 'Normal load: 200 N*'\n"
    done = run(*typed, *shlex.split(advice), cwd=tmp_path)
    assert "lowest at 50" in done.words
    other = run(*typed, "--blocks", "*: 900 N*", cwd=tmp_path)
    assert "lowest at 22" in other.words
    wrong = run(*typed, "--blocks", "*: 90 N*", cwd=tmp_path)
    assert "no rows stand below a line that matches '*: 90 N*'" in wrong.stderr
    inspected = run("inspect", "bush.txt", "--means", *shlex.split(advice), "--isothermal", cwd=tmp_path)
    assert "14 dwells" in inspected.words


def test_one_curve_at_several_loads_is_fitted(tmp_path: Path) -> None:
    path = bearing(tmp_path / "dry.txt", of_speed, (200.0, 900.0))
    surface = hersey.fit(hersey.SteadyPoints.from_table(path, isothermal=True))
    assert 1.0 + surface.c.value == pytest.approx(-0.1, abs=0.01)


def test_blocks_are_asked_for_only_where_there_are_some(tmp_path: Path) -> None:
    (tmp_path / "plain.csv").write_text("speed [rpm],torque [N*m]\n10,1\n20,2\n30,3\n")
    with pytest.raises(ParameterError, match=r"no header is repeated.*Omit blocks='Load \*'"):
        read_means(tmp_path / "plain.csv", blocks="Load *")


def traction(path: Path) -> Path:
    """Two blocks in which the slide-roll ratio varies, two in which the speed does."""
    names = ("Point", "Rolling Speed (mm/s)", "SRR (%)", "Sliding Speed (mm/s)", "Traction Coeff (-)")
    lines = ["Test 5", ""]
    for number, celsius in enumerate((30, 60)):
        lines += [f"Step {2 * number + 1} : Traction {celsius} C", "\t".join(names)]
        lines += [f"{i}\t{1500 + i % 2}\t{i}\t{15 * i}\t{0.06 * np.tanh(i / 4):.4f}" for i in range(1, 9)]
        lines += ["", f"Step {2 * number + 2} : Stribeck {celsius} C", "\t".join(names)]
        lines += [
            f"{i}\t{v:.0f}\t40\t{0.4 * v:.0f}\t{0.05 + 0.04 * np.exp(-v / 300):.4f}"
            for i, v in enumerate(np.geomspace(1200, 20, 12), 1)
        ]
        lines.append("")
    path.write_text("\n".join(lines), "cp1252")
    return path


def test_blocks_at_one_speed_are_left_out_beside_others(tmp_path: Path) -> None:
    path = traction(tmp_path / "steps.txt")
    assert is_means_table(path, {}, {})
    typed = ("fit", path.name, "--isothermal")
    asked = run(*typed, cwd=tmp_path).stderr
    assert "the speed column could be 'Rolling Speed [mm/s]' or 'Sliding Speed [mm/s]'" in asked
    assert "no time column" not in asked
    done = run(*typed, *shlex.split(asked.partition("Choose one with ")[2]), cwd=tmp_path)
    assert "2 of 4 blocks (16 rows) were skipped because their speed does not vary: 1, 3" in done.words
    assert "dwells 24" in done.words
    assert "varies from" not in done.words  # the slide-roll ratio, which does so only in these blocks
    one = read_means(
        path, channels={"speed": "Rolling Speed"}, isothermal=True, blocks="Step * : Stribeck 60*"
    )
    assert one.rows == 12


def rheometer(path: Path, tests: tuple[str, ...]) -> Path:
    """UTF-16, a run-in and a sweep for each test, a point every 4 s."""
    lines = ["Project:\tpins", ""]
    for factor, test in enumerate(tests, 4):
        lines += [f"Test:\t{test}", "", f"Result:\t{test}"]
        sweep = np.geomspace(0.02, 800, 40)
        for number, speeds in enumerate((np.full(30, 5.0), sweep), 1):
            lines += [f"Interval and data points:\t{number}\t{speeds.size}"]
            lines += ["Interval data:\tPoint No.\tTime\tSliding Speed\tTorque\tStatus", "\t" * 5]
            lines += ["\t\t[s]\t[mm/s]\t[mN·m]\t"]
            lines += [f"\t{i}\t{4 * i}\t{v:.4g}\t{factor * v**-0.1:.4f}\tM-" for i, v in enumerate(speeds, 1)]
            lines.append("")
    path.write_text("\n".join(lines), "utf-16")
    return path


def test_tests_of_one_file_are_not_pooled(tmp_path: Path) -> None:
    rheometer(tmp_path / "two.csv", ("Oil A", "Oil B"))
    typed = ("fit", "two.csv", "--isothermal", "--radius", "4 mm")
    swept = run(*typed, cwd=tmp_path).stderr
    assert "80 rows, 4 s apart, have each a speed of their own" in swept
    assert swept.endswith("If each row is the mean of a point, use --means\n")
    refused = run(*typed, "--means", cwd=tmp_path).stderr
    assert "two.csv holds 2 tests ('Result: Oil A', 'Result: Oil B')" in refused
    advice = refused.partition("Read one of them with ")[2].partition(",")[0]
    done = run(*typed, *shlex.split(advice), cwd=tmp_path)
    assert "1 of 2 blocks (30 rows) was skipped because its speed does not vary: 1" in done.words
    assert "dwells 40" in done.words
    assert "dwells 80" in run(*typed, "--blocks", "*", cwd=tmp_path).words


def test_a_header_with_another_unit_is_no_block(tmp_path: Path) -> None:
    """Nor is a header that is not repeated exactly: it stays a fault of the file."""
    text = "speed [rpm],torque [N*m]\n10,1\n20,2\n30,3\nspeed [rpm],torque [mN*m]\n10,1\n20,2\n30,3\n"
    (tmp_path / "units.csv").write_text(text)
    with pytest.raises(UnreadableLogError, match="from here on the unit is"):
        read_means(tmp_path / "units.csv")
