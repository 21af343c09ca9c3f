"""``hersey export fmu``: a fit and a machine file become a unit; what is wrong is said in a line."""

from __future__ import annotations

import json
import re
import shlex
import sys
from collections.abc import Callable
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu

import hersey
from hersey.document.saved_fit import read_fit
from hersey.exchange import trial as trying
from hersey.exchange.trial import Trial, try_unit
from tests.cli.command import Done, run, run_apart
from tests.conftest import ROOT
from tests.exchange.test_against_core import DRAG, TRAIN, far
from tests.life.test_campaign import means

MACHINE = ROOT / "tests" / "stand" / "machine.toml"
HOT = ["--temperature", "150 degC"]
Typed = Callable[..., Done]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, bench_csv: Path) -> Path:
    """A fit, one without temperature, one without a transition, and other documents."""
    folder = tmp_path_factory.mktemp("export")
    fit = run("fit", bench_csv, "--tare", "standing", "--json", cwd=folder).stdout
    (folder / "fit.json").write_text(fit)
    (folder / "short.json").write_text(fit[: len(fit) // 2])
    document = json.loads(run("fit", means(folder / "rising.csv"), "--json", cwd=folder).stdout)
    document["fit"]["no_transition"] = "too few slow dwells"
    (folder / "rising.json").write_text(json.dumps(document))
    isothermal = run("fit", bench_csv, "--tare", "standing", "--isothermal", "--json", cwd=folder)
    (folder / "isothermal.json").write_text(isothermal.stdout)
    (folder / "cycle.json").write_text(run("simulate", "--json", cwd=folder).stdout)
    text = MACHINE.read_text()
    (folder / "machine.toml").write_text(text)
    (folder / "slack.toml").write_text(re.sub(r"(?m)^stiffness.*\n", "", text, count=1))
    fixed = text.replace("[drivetrain]", '[drivetrain]\nstick_speed_rule = "fixed"', 1)
    (folder / "fixed.toml").write_text(fixed)
    return folder


@pytest.fixture
def typed(folder: Path, tmp_path: Path) -> Typed:
    """Type the command for that fit and machine, and other options."""

    def do(*options: str | Path, fit: str = "fit.json", machine: str = "machine.toml") -> Done:
        named = [] if "--out" in options else ["--out", tmp_path / "drive.fmu"]
        return run("export", "fmu", folder / fit, folder / machine, *named, *options, cwd=tmp_path)

    return do


def test_a_fit_and_a_machine_become_a_unit(typed: Typed, folder: Path, tmp_path: Path) -> None:
    done = typed(*HOT, "--drive-speed", "20 mm/s", "--check")
    assert (done.returncode, done.stderr) == (0, "")
    assert "FMI 3.0 unit for co-simulation on x86_64-linux." in done.stdout or "linux" not in sys.platform
    assert "FMPy reports a valid FMU; its results agree with hersey" in done.words
    assert done.stdout.endswith("drive.fmu\n")
    unit = tmp_path / "drive.fmu"
    assert validate_fmu(str(unit)) == []
    machine = hersey.read_machine(folder / "machine.toml")
    drag = read_fit(folder / "fit.json").drag(**machine.belt)
    core = hersey.simulate(
        machine.train, drag, drive_speed=0.02, temperature=423.15, duration=2.0, samples=51
    )
    got = fmpy.simulate_fmu(str(unit), stop_time=2.0, output_interval=0.04)
    assert core.events
    assert far(np.asarray(got["belt_speed"]), core.belt_speed) < 1e-9
    assert far(np.asarray(got["spring_force"]), core.spring_force) < 1e-9


def test_fit_and_machine_may_come_in_either_order(typed: Typed) -> None:
    done = typed(*HOT, fit="machine.toml", machine="fit.json")
    assert (done.returncode, done.stderr) == (0, "")


def test_a_fit_alone_gets_the_line_with_a_machine_file(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "machine.toml").write_text(MACHINE.read_text())
    out = ["--out", "drive.fmu", *HOT]
    done = run("export", "fmu", folder / "fit.json", *out, cwd=tmp_path)
    line = re.search(r"Type: (hersey .*)\n", done.stderr)
    assert line, done.stderr
    assert not (tmp_path / "drive.fmu").exists()
    assert run(*shlex.split(line[1])[1:], cwd=tmp_path).returncode == 0
    assert (tmp_path / "drive.fmu").exists()


@pytest.mark.parametrize(
    "options",
    [
        ["--fmi", "2.0"],
        ["--drive", "torque"],
        ["--start", "steady", "--drive-speed", "60 mm/s"],
        ["--closure", "lugre", "--bristle-stiffness", "1000 N/mm", "--bristle-damping", "1000 N*s/m"],
    ],
)
def test_options_are_heard(options: list[str], typed: Typed) -> None:
    done = typed(*HOT, *options, "--check", "--json")
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["fmi"] == ("2.0" if "2.0" in options else "3.0")
    assert told["drive"] == ("torque" if "torque" in options else "speed")
    assert told["start"] == ("steady" if "steady" in options else "rest")
    assert told["check"]["problems"] == []
    assert max(told["check"]["differences"].values()) < 1e-9
    starts = {row["name"]: row["start"] for row in told["variables"]}
    assert ("bristle_stiffness" in starts) == ("lugre" in options)
    assert starts["temperature"] == pytest.approx(423.15)


@pytest.mark.parametrize("options", [["--out", "drive.slx"], ["--out=x.mo", "--fmi", "2.0"], []])
@pytest.mark.parametrize("fit", [["fit.json"], []])
def test_the_line_proposed_for_another_format_writes_a_unit(
    fit: list[str], options: list[str], folder: Path, tmp_path: Path
) -> None:
    machine = folder / "machine.toml" if fit else ROOT / "examples" / "machine.toml"
    files = [*(folder / each for each in fit), machine]
    refused = run("export", "simulink", *files, *options, cwd=tmp_path)
    assert refused.returncode == 2
    line = shlex.split(refused.stderr.rpartition("Type: ")[2])
    done = run(*line[1:], cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert validate_fmu(str(next(tmp_path.glob("*.fmu")))) == []


def test_the_line_proposed_for_an_isothermal_fit_has_no_temperature(folder: Path, tmp_path: Path) -> None:
    files = (folder / "isothermal.json", folder / "machine.toml")
    assert "--temperature" not in run("export", "simulink", *files, cwd=tmp_path).stderr


@pytest.mark.parametrize("fmi", ["3.0", "2.0"])
def test_a_machine_file_alone_becomes_the_contact_that_it_describes(fmi: str, tmp_path: Path) -> None:
    """Film and asperities of examples/machine.toml, whose roll the drive turns as a shaft."""
    file = ROOT / "examples" / "machine.toml"
    options = ("--fmi", fmi, "--port", "rotational", "--drive-speed", "30 mm/s", "--check", "--json")
    done = run("export", "fmu", file, *HOT, "--out", "drive.fmu", *options, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    told = json.loads(done.stdout)
    assert (told["port"], told["check"]["problems"]) == ("rotational", [])
    assert max(told["check"]["differences"].values()) < 1e-9
    starts = {row["name"]: row["start"] for row in told["variables"]}
    assert starts["roll_speed"] == pytest.approx(0.03 / 0.015)
    machine = hersey.read_machine(file)
    core = hersey.simulate(
        machine.train,
        machine.mixed_drag(423.15),
        drive_speed=0.03,
        temperature=423.15,
        duration=2.0,
        samples=51,
    )
    got = fmpy.simulate_fmu(str(tmp_path / "drive.fmu"), stop_time=2.0, output_interval=0.04)
    assert core.events
    assert far(np.asarray(got["belt_speed"]), core.belt_speed) < 1e-9
    assert far(np.asarray(got["reaction_torque"]), 0.015 * core.spring_force) < 1e-9


@pytest.mark.parametrize(
    ("machine", "options", "said"),
    [
        ("machine.toml", HOT, "machine.toml has no [asperities] and [boundary], so its drag is not known"),
        (None, [], "a contact model depends on temperature: add that at the start, --temperature"),
        (None, [*HOT, "--port", "sideways"], "port is 'sideways': it must be translational or rotational"),
    ],
)
def test_what_a_machine_file_alone_lacks_is_said(
    machine: str | None, options: list[str], said: str, folder: Path, tmp_path: Path
) -> None:
    file = ROOT / "examples" / "machine.toml" if machine is None else folder / machine
    done = run("export", "fmu", file, *options, "--out", "drive.fmu", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert said in done.stderr
    assert done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_three_files_are_refused(typed: Typed, folder: Path) -> None:
    done = typed(*HOT, str(folder / "machine.toml"))
    assert done.returncode == 2
    assert "3 files are given: name a fit and a machine file, or only a machine file" in done.stderr


def test_a_stick_speed_that_is_fixed_holds_at_one_temperature(typed: Typed) -> None:
    done = typed(*HOT, "--json", machine="fixed.toml")
    assert done.returncode == 0
    assert "fixed.toml has a fixed stick speed, so the unit holds at this temperature only." in done.stderr
    assert "temperature" not in {row["name"] for row in json.loads(done.stdout)["variables"]}


@pytest.mark.parametrize(
    ("options", "files", "said"),
    [
        ([], {}, "the fit depends on temperature: add that at the start, --temperature '180 degC'"),
        (["--temperature", "-300 degC"], {}, "it must be above absolute zero"),
        ([*HOT, "--fmi", "1.0"], {}, "fmi is '1.0': it must be 3.0 or 2.0"),
        ([*HOT, "--drive", "wind"], {}, "drive is 'wind': it must be speed or torque"),
        ([*HOT, "--drive-speed", "20"], {}, "20"),
        (
            [*HOT, "--drive", "torque", "--drive-speed", "20 mm/s"],
            {},
            "--drive-speed needs --drive speed",
        ),
        ([*HOT, "--drive", "torque", "--start", "steady"], {}, "start 'steady' needs drive 'speed'"),
        (
            ["--temperature", "-20 degC"],
            {},
            "temperature is -20 degC: the law needs temperatures above 0 degC",
        ),
        ([*HOT, "--name", ""], {}, "name is '': it must be one line of visible characters"),
        ([*HOT, "--closure", "glue"], {}, "glue"),
        ([*HOT, "--closure", "lugre"], {}, "bristle"),
        ([*HOT, "--library", "hersey.dll"], {}, "write PLATFORM=FILE, e.g. x86_64-windows=win/hersey.dll"),
        ([*HOT, "--library", "amiga=a.so"], {}, "platform 'amiga' is not known"),
        ([*HOT, "--library", "x86_64-windows=none.dll"], {}, "none.dll cannot be read: No such file"),
        (
            [*HOT, *("--library", "x86_64-windows=a.dll") * 2],
            {},
            "--library names x86_64-windows twice: give one file for each platform",
        ),
        ([*HOT, "--out", "drive.zip"], {}, "--out drive.zip: name a file that ends in .fmu"),
        ([*HOT, "--out", "none/drive.fmu"], {}, "there is no directory none"),
        (HOT, {"fit": "short.json"}, "short.json: document: not valid JSON"),
        (
            HOT,
            {"fit": "cycle.json"},
            "cycle.json: fit: Field required. Save the fit again with: hersey fit LOG --machine ",
        ),
        (HOT, {"fit": "none.json"}, "none.json"),
        (HOT, {"fit": "rising.csv"}, "machine.toml --json > fit.json"),
        (
            HOT,
            {"fit": "isothermal.json"},
            "the fit is isothermal: omit --temperature",
        ),
        (HOT, {"fit": "rising.json"}, "the data show no falling branch: too few slow dwells"),
        (HOT, {"machine": "slack.toml"}, "[drivetrain] needs the key 'stiffness'"),
        (HOT, {"machine": "none.toml"}, "none.toml"),
    ],
)
def test_what_is_wrong_is_said_in_a_line(
    options: list[str], files: dict[str, str], said: str, typed: Typed, tmp_path: Path
) -> None:
    done = typed(*options, **files)
    assert (done.returncode, done.stdout) == (2, "")
    assert said in done.stderr
    assert done.stderr.startswith("hersey: ")
    assert done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_replaced_unasked(typed: Typed, tmp_path: Path) -> None:
    (tmp_path / "drive.fmu").write_text("kept")
    assert "exists: use --force to replace it" in typed(*HOT).stderr
    assert (tmp_path / "drive.fmu").read_text() == "kept"
    assert typed(*HOT, "--force").returncode == 0
    assert [file.name for file in tmp_path.iterdir()] == ["drive.fmu"]


def test_a_unit_in_which_something_is_found_is_not_kept(
    typed: Typed, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for found in (Trial(("a unit is odd",), {}, 0), Trial((), {"belt_speed": 1e-3}, 4)):
        monkeypatch.setattr(trying, "try_unit", lambda *_, found=found: found)
        done = typed(*HOT, "--check")
        assert done.returncode == 1
        assert "a unit is odd" in done.words or "its results DIFFER from hersey (1.0e-03" in done.words
        assert list(tmp_path.iterdir()) == []


def test_a_trial_sees_a_unit_that_is_another(tmp_path: Path) -> None:
    """Its drag is not that of the core it is compared with."""
    unit = hersey.export_fmu(tmp_path / "drive.fmu", TRAIN, DRAG)
    assert try_unit(unit, TRAIN, DRAG).ok
    other = hersey.Drag(14.0, 0.025, ehl_exponent=-0.7, mixed_exponent=-1.21, stick_speed=3e-4)
    assert not try_unit(unit, TRAIN, other).ok


def test_without_fmpy_the_way_out_is_named(typed: Typed, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "fmpy", None)
    done = typed(*HOT, "--check")
    assert done.returncode == 2
    assert done.stderr == "hersey: checking an FMU needs FMPy. Run pip install 'hersey[exchange]'\n"


def test_a_unit_is_written_without_fmpy(folder: Path, tmp_path: Path) -> None:
    """The extra is for the check alone; nothing of it is loaded otherwise."""
    typed = ["hersey", "export", "fmu", *map(str, (folder / "fit.json", folder / "machine.toml")), *HOT]
    command = "import sys; sys.modules['fmpy'] = None; from hersey.cli import main; "
    command += f"sys.argv = {[*typed, '--out', 'drive.fmu']!r}; main()"
    done = run_apart("-c", command, cwd=tmp_path, command=[sys.executable])
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "drive.fmu").exists()


def test_a_fit_takes_off_the_rest_that_the_machine_states(typed: Typed, folder: Path) -> None:
    """One of the whole torque is refused, and the way out that is named works."""
    text = MACHINE.read_text() + '[rest]\ntorque = "3 mN*m"\nuncertainty = "10 %"\n'
    (folder / "resting.toml").write_text(text)
    refused = typed(*HOT, machine="resting.toml")
    assert "was fitted to the whole torque" in refused.stderr
    resting = folder / "resting.toml"
    saved = f"hersey fit LOG --machine {resting} --json > fit.json"
    assert f"Save the fit again with: {saved}, or delete [rest] from {resting}\n" in refused.stderr
    told = json.loads((folder / "fit.json").read_text())["command"].split()
    fit = run("fit", told[2], "--tare", "standing", "--machine", "resting.toml", "--json", cwd=folder)
    (folder / "film.json").write_text(fit.stdout)
    done = typed(*HOT, "--json", fit="film.json", machine="resting.toml")
    assert done.returncode == 0, done.stderr
    starts = {row["name"]: row["start"] for row in json.loads(done.stdout)["variables"]}
    assert starts["rest_force"] == pytest.approx(0.2)
