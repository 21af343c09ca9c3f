"""Numbers of a belt with units, bare, or from the machine file: `simulate`, `hysteresis` and `sweep`."""

from __future__ import annotations

import inspect
import json
import math
import shlex
from pathlib import Path
from typing import Any

import pytest

from hersey.cli.amounts import amounts
from hersey.cli.hysteresis import hysteresis
from hersey.cli.simulate import simulate
from hersey.errors import HerseyError, ParameterError, UnitError
from tests.cli.command import run
from tests.conftest import ROOT

MACHINE = ROOT / "tests" / "stand" / "machine.toml"
BELT = ("stiffness", "mass", "transition_force", "transition_speed", "stick_speed")
OUNCE, INCH = 0.45359237 / 16 * 9.80665, 0.0254


def of(
    *, machine: Path | None = None, needed: tuple[str, ...] = BELT, **given: Any
) -> dict[str, float | None]:
    texts: dict[str, str | None] = dict.fromkeys(needed)
    return dict(amounts(texts | given, needed=needed, machine_file=machine).values)


def test_bare_numbers_are_in_any_consistent_set() -> None:
    assert of() == dict(zip(BELT, (1000.0, 1.0, 50.0, 1.0, 0.01), strict=True))
    assert of(stiffness="2e3") == of() | {"stiffness": 2000.0}
    assert of(duration="500 ms", needed=("stiffness", "duration")) == {"stiffness": 1000.0, "duration": 0.5}


def test_numbers_with_units_are_in_si_and_so_is_the_baseline_beside_them() -> None:
    values = of(stiffness="11 N/mm", mass="2 lb")
    assert values["stiffness"] == pytest.approx(11_000.0)
    assert values["mass"] == pytest.approx(0.90718474)
    assert values["transition_force"] == pytest.approx(50 * OUNCE, rel=1e-12)
    assert values["stick_speed"] == pytest.approx(0.01 * INCH, rel=1e-12)
    filled = amounts({"mass": None, "stiffness": "1 N/m"}, needed=("mass", "stiffness"))
    assert filled.in_si
    assert filled.values["mass"] == pytest.approx(OUNCE / INCH, rel=1e-12)
    assert filled.words == ["- Not given; using the baseline values: mass 10.9 kg."]


def test_the_machine_fills_what_is_not_given() -> None:
    force: dict[str, Any] = {"transition_force": "14 N", "transition_speed": "25 mm/s"}
    values = of(machine=MACHINE, **force)
    assert values == pytest.approx(dict(zip(BELT, (11_000.0, 11.0, 14.0, 0.025, 3e-4), strict=True)))
    assert of(machine=MACHINE, mass="1 kg", **force)["mass"] == 1.0


@pytest.mark.parametrize(
    ("given", "machine", "says"),
    [
        ({"stiffness": "11 N/mm", "mass": "1"}, None, "--mass 1 has no unit, but --stiffness '11 N/mm' has"),
        ({"mass": "1"}, MACHINE, "--mass 1 has no unit, which --machine requires: write '1 kg', for example"),
        ({"stiffness": "11 N/mmm"}, None, "--stiffness: unknown unit 'N/mmm'"),
        ({"stiffness": "11 kg"}, None, "--stiffness: unit 'kg' is not a unit of stiffness"),
        ({"mass": "heavy"}, None, "--mass is 'heavy': write a number"),
        (
            {},
            MACHINE,
            r"the transition force \(the drag where its branches meet\) and the transition speed .*: add "
            r"--transition-force '14 N' --transition-speed '25 mm/s'$",
        ),
    ],
)
def test_mistakes_are_named_with_the_way_out(given: dict[str, Any], machine: Path | None, says: str) -> None:
    with pytest.raises((ParameterError, UnitError), match=says):
        of(machine=machine, **given)


def test_what_a_message_says_to_add_works(tmp_path: Path) -> None:
    """From the machine alone to a result, by what one message says."""
    typed: list[str] = ["--machine", str(MACHINE)]
    refused = run("simulate", *typed, "--json", cwd=tmp_path)
    assert refused.returncode == 2
    typed += shlex.split(refused.stderr.split(": add ")[1])
    done = run("simulate", *typed, "--json", cwd=tmp_path)
    assert json.loads(done.stdout)["kind"] in ("stick_slip", "steady_sliding")
    assert typed[2:] == [
        "--transition-force", "14 N", "--transition-speed", "25 mm/s", "--drive-speed", "120 mm/s",
    ]  # fmt: skip


def test_the_same_belt_in_both_units(tmp_path: Path) -> None:
    """The paper's baseline, with one of its numbers in its unit: the same frequency, speeds in m/s."""
    bare, si = (
        json.loads(run(*command, "--json", cwd=tmp_path).stdout)
        for command in (["simulate"], ["simulate", "--stiffness", "1000 ozf/in"])
    )
    assert si["frequency"] == pytest.approx(bare["frequency"], rel=1e-6)
    assert si["speed_max"] == pytest.approx(INCH * bare["speed_max"], rel=1e-6)
    step = ["--from-speed", "2.5 in/s", "--to-speed", "1.2 in/s"]
    band = json.loads(run("hysteresis", *step, "--json", cwd=tmp_path).stdout)
    assert band["upper"] == pytest.approx(INCH * 2.173493478, rel=1e-6)
    assert band["step"]["sticks"]


@pytest.mark.parametrize(
    ("step", "says"),
    [
        (
            ["--from-speed", "20 mm/s", "--to-speed=60 mm/s"],
            "--from-speed '20 mm/s' lies below the transition speed, 25.4 mm/s.",
        ),
        (
            ["--from-speed", "0.5 in/s", "--to-speed", "2.5 in/s"],
            "--from-speed '0.5 in/s' (12.7 mm/s) lies below the transition speed, 25.4 mm/s.",
        ),
        (
            ["--from-speed", "0.5", "--to-speed", "2.5"],
            "--from-speed '0.5' lies below the transition speed, 1.",
        ),
    ],
)
def test_a_step_from_a_speed_without_steady_sliding_is_refused_as_typed(
    step: list[str], says: str, tmp_path: Path
) -> None:
    done = run("hysteresis", *step, cwd=tmp_path)
    assert (done.returncode, done.stderr.startswith(f"hersey: {says} ")) == (2, True), done.stderr
    line = done.stderr.partition("swap the two speeds: ")[2]
    done = run(*shlex.split(line)[1:], cwd=tmp_path)
    assert (done.returncode, "A sudden step from" in done.stdout) == (0, True), done.stderr


def test_no_swap_is_proposed_to_a_speed_without_steady_sliding(tmp_path: Path) -> None:
    done = run("hysteresis", "--from-speed", "0.5", "--to-speed", "0.2", cwd=tmp_path)
    assert done.stderr.endswith(". Start from a higher speed\n")
    done = run("hysteresis", "--from-speed", "2 mm/s", "--to-speed", "0 mm/s", cwd=tmp_path)
    assert done.stderr == "hersey: --to-speed '0 mm/s' must be greater than 0\n"


def test_a_sweep_takes_from_the_machine_what_its_file_lacks(tmp_path: Path) -> None:
    lines = [
        '[parameters]', 'transition_force = "14 N"', 'ehl_exponent = -0.7', 'mixed_exponent = -1.2',
        'drive_speed = ["20 mm/s", "90 mm/s"]',
    ]  # fmt: skip
    path = tmp_path / "sweep.toml"
    path.write_text("\n".join(lines))
    refused = run("sweep", path, "--machine", MACHINE, cwd=tmp_path)
    assert "[parameters] has no 'transition_speed', and machine.toml does not have it. Add " in refused.stderr
    lines.append(refused.stderr.strip().split(". Add ")[1])
    path.write_text("\n".join(lines))
    assert run("sweep", path, cwd=tmp_path).stderr.endswith("[parameters] has no 'stiffness'\n")
    done = json.loads(run("sweep", path, "--machine", MACHINE, "--json", cwd=tmp_path).stdout)
    assert done["kinds"] == {"stick_slip": 1, "steady_sliding": 1}
    path.write_text("\n".join([*lines, "[options]", 'units = "consistent"']))
    assert "is in SI" in run("sweep", path, "--machine", MACHINE, cwd=tmp_path).stderr


def test_every_number_of_a_belt_has_a_kind() -> None:
    """No option of a dimension is a plain number: each is read by `amounts`."""
    plain = [
        f"{command.__name__} {name}"
        for command in (simulate, hysteresis)
        for name, parameter in inspect.signature(command).parameters.items()
        if "float" in str(parameter.annotation)
    ]
    assert plain == [
        f"{verb} {of}_exponent" for verb in ("simulate", "hysteresis") for of in ("ehl", "mixed")
    ]
    for name in ("bristle_stiffness", "bristle_damping", "from_speed"):
        with pytest.raises(HerseyError, match="--" + name.replace("_", "-")):
            amounts({name: "1 K"}, needed=())


def test_a_machine_brings_grip_motor_and_rest(tmp_path: Path) -> None:
    """A roll of 18 N that starts no belt of 97 N; a motor of 0.2 N m; a rest of 20 mN m at 15 mm."""
    lines = [
        '[drivetrain]', 'stiffness = "11 N/mm"', 'mass = "11 kg"', 'roll_radius = "15 mm"',
        'stick_speed = "0.3 mm/s"', '[rest]', 'torque = "20 mN*m"', '[limits]', 'motor_torque = "0.2 N*m"',
    ]  # fmt: skip
    grip = ["roll_friction = 0.06", 'nip_load = "300 N"']
    (tmp_path / "free.toml").write_text("\n".join(lines))
    (tmp_path / "weak.toml").write_text("\n".join([*lines, *grip]))
    drag = ["--transition-force", "14 N", "--transition-speed", "25 mm/s"]
    typed = ["simulate", *drag, "--drive-speed", "20 mm/s", "--machine"]
    weak = run(*typed, "weak.toml", cwd=tmp_path).words
    assert weak.startswith("The drive stalls: the grip does not suffice")
    assert ", starting at 0.0818 s" in weak
    assert "The motor is too weak: the motion needs up to 0.27 of the 0.2 N·m of the motor" in weak
    assert "The drive can pull with up to 18 N. It cannot start from rest" in weak
    free = json.loads(run(*typed, "free.toml", "--json", cwd=tmp_path).stdout)
    assert (free["kind"], free["motor"]["limit"]) == ("stick_slip", pytest.approx(0.2))
    assert free["motor"]["torque"] > 1.0
    scenario = tmp_path / "sweep.toml"
    exponents = ["ehl_exponent = -0.7", "mixed_exponent = -1.2", 'drive_speed = "20 mm/s"']
    shape = ['transition_force = "14 N"', 'transition_speed = "25 mm/s"', *exponents]
    scenario.write_text("\n".join(["[parameters]", *shape]))
    for file, kind in (("weak.toml", "stalled"), ("free.toml", "stick-slip")):
        done = run("sweep", scenario, "--machine", file, cwd=tmp_path).words
        assert done.startswith(f"1 set of parameters {kind} 1 (100 %)")
        assert "The no-load torque is added to the drag: 1.33 N + 0 N·s/m times speed" in done
        assert ("The drive can pull with up to 18 N" in done) == (file == "weak.toml")


def test_a_drive_speed_may_be_that_of_the_roll_where_the_machine_states_its_radius(tmp_path: Path) -> None:
    (tmp_path / "machine.toml").write_text(
        '[drivetrain]\nstiffness = "11 N/mm"\nmass = "11 kg"\nroll_radius = "15 mm"\nstick_speed = "1 mm/s"\n'
    )
    belt = ["--transition-force", "14 N", "--transition-speed", "25 mm/s"]
    step = ["--from-speed", "120 rpm", "--to-speed", "40 rpm"]
    done = run("hysteresis", *belt, *step, "--machine", "machine.toml", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)["step"]
    assert found["from_speed"] == pytest.approx(120 * math.tau / 60 * 0.015)
    assert found["to_speed"] == pytest.approx(40 * math.tau / 60 * 0.015)
    done = run("hysteresis", *belt, *step, cwd=tmp_path)
    assert (done.returncode, "--machine" in done.stderr) == (2, True)
