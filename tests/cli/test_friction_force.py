"""A friction force on the command line: the way out of the message is one that works."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from tests.cli.command import run
from tests.conftest import ROOT

pytestmark = pytest.mark.usefixtures("roughly")
SPEEDS = (10.0, 20.0, 40.0, 80.0, 160.0)


@pytest.fixture
def wear(tmp_path: Path) -> Path:
    """Five dwells of a friction force in N against a sliding speed in mm/s, without a clock: 100 Hz."""
    noise = np.random.default_rng(4)
    lines = ["Friction force [N],Sliding speed [mm/s],Fn"]
    for speed in SPEEDS:
        lines += [f"{5 * speed**0.3 + noise.normal(0, 0.01):.4f},{speed},50" for _ in range(600)]
    (tmp_path / "wear.csv").write_text("\n".join([*lines, ""]))
    return tmp_path


def test_each_message_names_the_next_option_that_is_needed(wear: Path) -> None:
    given: list[str] = ["--isothermal"]
    refused = run("fit", "wear.csv", *given, cwd=wear)
    assert refused.returncode == 2
    option = re.search(r"(--every) '([^']+)'", refused.stderr)
    assert option is not None, refused.stderr
    given += [option[1], "10 ms"]
    fitted = run("fit", "wear.csv", *given, cwd=wear)
    assert fitted.returncode == 0, fitted
    assert "Friction force rises with sliding speed, as v^0.30" in fitted.words
    assert "F = a v^(1 + c), v in m/s" in fitted.words
    assert not re.search(r"torque|rpm|N·m|stick-slip", fitted.words)


def test_the_exponent_is_that_of_the_force(wear: Path) -> None:
    options = ["--isothermal", "--every", "10 ms", "--radius", "30 mm", "--load", "Fn", "--load-unit", "N"]
    fitted = run("fit", "wear.csv", *options, "--json", cwd=wear)
    assert fitted.returncode == 0, fitted
    points = json.loads(fitted.stdout)["points"]
    speed, damping = (np.log([point[name] for point in points]) for name in ("speed", "damping"))
    assert np.polyfit(speed, damping, 1)[0] == pytest.approx(-0.7, abs=0.01)
    assert points[0]["torque"] == pytest.approx(5 * 10**0.3 * 0.03, rel=0.01)
    shown = run("inspect", "wear.csv", *options, cwd=wear)
    assert re.search(r"Fn +load ", shown.stdout)
    assert "Torque is 'Friction force' x radius (0.03 m)" in shown.words
    assert "5 dwells" in shown.stdout
    assert "dead channel" not in shown.stdout  # a load may stay what it is


def test_a_column_of_a_length_is_proposed_as_the_radius_and_not_taken(tmp_path: Path) -> None:
    lines = ["Time [s],Friction force [N],Sliding speed [mm/s],Wear [um],Track radius [mm],Fn [N]"]
    lines += [f"{i / 10},5,20,{i},25,50" for i in range(400)]
    (tmp_path / "wear.csv").write_text("\n".join([*lines, ""]))
    plain = run("inspect", "wear.csv", "--isothermal", cwd=tmp_path)
    assert (
        "'Track radius [mm]' may be the radius, but is not used. If it is, use --radius 'Track radius'"
        in (plain.words)
    )
    assert "'Wear [um]' may be" not in plain.words
    looked = run("inspect", "wear.csv", "--isothermal", "--radius", "Track radius", cwd=tmp_path)
    assert "'Fn [N]' may be the normal load, but is not used. If it is, use --load 'Fn'" in looked.words
    assert run("inspect", "wear.csv", "--save-mapping", cwd=tmp_path).returncode == 0
    proposal = (tmp_path / "hersey.toml").read_text()
    assert '# channel = "Track radius"' in proposal
    assert '# channel = "Fn"' in proposal
    lines = [line.removeprefix("# ") for line in proposal.splitlines() if "value" not in line]
    told = tomllib.loads("\n".join(lines[lines.index(next(li for li in lines if "[radius]" in li)) :][:8]))
    assert told == {
        "radius": {"channel": "Track radius", "unit": "mm"},
        "load": {"channel": "Fn", "unit": "N"},
    }


def test_a_load_for_each_run(wear: Path) -> None:
    content = (wear / "wear.csv").read_text()
    lines = content.splitlines()  # a measurement of its own: one reading differs
    (wear / "again.csv").write_text("\n".join([*lines[:-2], *lines[-1:]]))
    options = ["--isothermal", "--every", "10 ms", "--radius", "30 mm", "--load", "10 N, 20 N"]
    assert run("fit", "wear.csv", "again.csv", *options, cwd=wear).returncode == 0
    refused = run("fit", "wear.csv", *options, cwd=wear)
    assert "load has 2 values for 1 runs" in refused.stderr


def test_an_amount_without_a_unit_is_no_name(wear: Path) -> None:
    refused = run("fit", "wear.csv", "--isothermal", "--every", "10 ms", "--radius", "30", cwd=wear)
    assert refused.returncode == 2
    assert "radius: '30' is not a number with a unit of length" in refused.stderr


def test_a_trace_of_a_force_becomes_one_of_torque_by_a_mapping_of_its_own(tmp_path: Path) -> None:
    examples, name = ROOT / "examples", "Spring force"
    text = (examples / "bench.csv").read_text().replace("Drive torque [N*m]", f"{name} [N]")
    (tmp_path / "pull.csv").write_text(text)
    bench, machine = examples / "bench.csv", examples / "machine.toml"
    typed = ["posterior", str(bench), "--machine", str(machine), "--trace", "pull.csv", "--draws", "100"]
    done = run(*typed, cwd=tmp_path)
    assert done.returncode == 2
    advised = re.search(r"write two lines into (\S+): (.*) and (.*)\n", done.stderr)
    assert advised, done.stderr
    mapping = tmp_path / advised[1]
    mapping.write_text(f"{advised[2]}\n{advised[3]}\n")
    assert advised.groups() == (
        "pull.hersey.toml",
        f'torque.channel = "{name}"',
        'radius.value = "15 mm"',
    )
    assert run(*typed, cwd=tmp_path).returncode == 0


def test_a_trace_without_its_columns_is_met_with_all_that_it_needs(tmp_path: Path) -> None:
    examples = ROOT / "examples"
    bench, machine = examples / "bench.csv", examples / "machine.toml"
    typed = ["posterior", str(bench), "--machine", str(machine), "--draws", "100", "--trace"]
    (tmp_path / "slip.csv").write_text((examples / "stick-slip.csv").read_text())
    done = run(*typed, "slip.csv", cwd=tmp_path)
    assert done.stderr.endswith(
        "hersey: slip.csv: no torque or speed or temperature column found. A trace is a recording of this "
        "machine with time, torque, speed and temperature. Columns: 'time [s]', 'force [N]'. If a column is "
        'one of these, name it in slip.hersey.toml, e.g. torque.channel = "NAME". If it is a stick-slip '
        "trace, type: hersey cycles slip.csv\n"
    )
    assert run("cycles", "slip.csv", cwd=tmp_path).returncode == 0
    text = (examples / "bench.csv").read_text().replace("Drive speed [rpm]", "Turning [rpm#]")
    (tmp_path / "turning.csv").write_text(text)
    done = run(*typed, "turning.csv", "--isothermal", cwd=tmp_path)
    assert "turning.csv: no speed column found. " in done.stderr
    assert "with time, torque and speed. Columns" in done.stderr
    advised = re.search(r'name it in (\S+), e.g. (speed.channel = )"NAME"', done.stderr)
    assert advised
    (tmp_path / advised[1]).write_text(f'{advised[2]}"Turning"\nspeed.unit = "rpm"\n')
    assert run(*typed, "turning.csv", cwd=tmp_path).returncode == 0
