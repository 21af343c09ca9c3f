"""What the drive takes without the film: by ``--no-load``, or from the machine file; never by both."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from hersey import NoLoadTorque, SteadyPoints, TorqueLog
from hersey.errors import InsufficientDataError
from hersey.log.torque_log import LogFile, Run
from hersey.machine import read_machine
from tests.cli.command import run
from tests.conftest import ROOT

MACHINE = (ROOT / "tests" / "stand" / "machine.toml").read_text()
STATED = '\n[rest]\ntorque = "20 mN*m"\ndamping = "1 mN*m*s/rad"\n'
RPM = np.array([8.0, 12, 20, 30, 45, 70, 100, 140])


def table(torque: np.ndarray, celsius: np.ndarray) -> str:
    """A table of means at two temperatures; torque in N m, shape (temperatures, speeds)."""
    rows = [
        f"{n:g},{1e3 * t:.9g},{c:g}"
        for c, at in zip(celsius, torque, strict=True)
        for n, t in zip(RPM, at, strict=True)
    ]
    return "\n".join(["speed [rpm],torque [mN*m],temp [degC]", *rows]) + "\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A log of a film of exponent -0.6 beside 20 mN m + 1 mN m s/rad, one without it, a machine file."""
    w, t = RPM * 2 * np.pi / 60, np.array([[100.0], [130.0], [160.0]])
    rest = (0.02 + 0.001 * w) * np.ones_like(t)
    film = 0.1 * (t / 150.0) ** -0.9 * w**0.4
    (tmp_path / "log.csv").write_text(table(film + rest, t.ravel()))
    (tmp_path / "free.csv").write_text(table(rest, t.ravel()))
    (tmp_path / "slow.csv").write_text("\n".join((tmp_path / "free.csv").read_text().splitlines()[:6]))
    (tmp_path / "machine.toml").write_text(MACHINE + STATED)
    (tmp_path / "with-log.toml").write_text(MACHINE + '\n[rest]\nlog = "free.csv"\n')
    return tmp_path


def exponent(printed: str) -> float:
    return float(json.loads(printed)["fit"]["coefficients"]["c"]["value"])


@pytest.mark.usefixtures("roughly")
def test_a_no_load_log_is_taken_off(folder: Path) -> None:
    done = run("fit", "log.csv", "--no-load", "free.csv", "--json", cwd=folder)
    assert done.returncode == 0, done.stderr
    assert exponent(done.stdout) == pytest.approx(-0.6, abs=1e-6)
    assert "No-load torque subtracted: 20 mN m + 1 mN m s/rad times speed" in done.stderr
    (folder / "fit.json").write_text(done.stdout)
    assert json.loads(done.stdout)["fit"]["rest"]["source"] == "free.csv"
    assert exponent(run("fit", "log.csv", "--json", cwd=folder).stdout) < -0.61


@pytest.mark.parametrize("file", ["machine.toml", "with-log.toml"])
def test_the_rest_of_the_machine_is_taken_off(folder: Path, file: str) -> None:
    printed = run("report", "log.csv", "--machine", file, "--json", cwd=folder)
    assert printed.returncode == 0, printed.stderr
    assert exponent(printed.stdout) == pytest.approx(-0.6, abs=1e-6)
    document = json.loads(printed.stdout)
    assert "for the film alone: no-load torque is subtracted" in " ".join(document["verdict"])
    film = run("film", file, "--log", "log.csv", "--json", cwd=folder)
    torque = json.loads(film.stdout)["measured"]["torque"]
    assert torque[0] == pytest.approx(0.1 * (100 / 150.0) ** -0.9 * (8 * 2 * np.pi / 60) ** 0.4, rel=1e-5)


def test_a_log_of_the_machine_is_found_beside_it(folder: Path) -> None:
    rest = read_machine(folder / "with-log.toml").rest
    assert rest is not None
    assert rest.constant.value == pytest.approx(0.02, rel=1e-6)
    stated = read_machine(folder / "machine.toml").rest
    assert stated is not None
    assert stated.source == "[rest] of machine.toml"
    assert [each.kind for each in stated.warnings] == ["counts as exact"]


@pytest.mark.parametrize("name", [r"C:\data\idle.csv", "/data/idle.csv", "logs/idle.csv", "idle.csv"])
def test_a_log_that_does_not_exist_is_copied_beside_the_machine_file(folder: Path, name: str) -> None:
    file = folder / "with-log.toml"
    file.write_text(MACHINE + f"\n[rest]\nlog = '{name}'  # of the drive\n")
    line = file.read_text().splitlines().index("[rest]") + 2
    refused = run("report", "log.csv", "--machine", file.name, cwd=folder)
    assert f"with-log.toml, line {line}: [rest] log = '{name}' names a file" in refused.stderr
    copied = "Copy idle.csv into the folder of with-log.toml"
    assert refused.stderr.count(copied) == 1
    (folder / "free.csv").rename(folder / "idle.csv")
    if name != "idle.csv":
        written = re.search(rf'{copied} and write: (log = "idle.csv")\n', refused.stderr)
        assert written
        refused = run("report", "log.csv", "--machine", file.name, cwd=folder)  # copied, and not yet written
        assert refused.stderr.endswith(f" Write: {written[1]}\n")
        file.write_text(file.read_text().replace(f"log = '{name}'", written[1]))
    assert read_machine(file).rest is not None


@pytest.mark.usefixtures("roughly")
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ("report", "log.csv", "--machine", "machine.toml", "--no-load", "free.csv"),
            "--no-load and [rest] of machine.toml both give the no-load torque. Omit",
        ),
        (
            ("fit", "log.csv", "--no-load", "slow.csv"),
            "Record these speeds without the lubricated contact too",
        ),
        (("fit", "free.csv", "--no-load", "log.csv"), "leaves nothing for the film"),
        (("fit", "log.csv", "--no-load", "none.csv"), "none.csv"),
        (
            ("map", "machine.toml", "--fit", "whole.json"),
            "whole.json was fitted to the whole torque, but the machine states a no-load torque",
        ),
    ],
)
def test_mistakes_end_in_one_line(folder: Path, arguments: tuple[str, ...], message: str) -> None:
    if "whole.json" in arguments:
        (folder / "whole.json").write_text(run("fit", "log.csv", "--json", cwd=folder).stdout)
    done = run(*arguments, cwd=folder)
    assert done.returncode == 2
    line = done.stderr.strip().splitlines()[-1]
    assert message in line
    assert "Traceback" not in done.stderr


@pytest.mark.usefixtures("roughly")
@pytest.mark.parametrize("details", [(), ("--verbose",)])
def test_the_printed_text_of_a_fit_is_met_with_the_line_that_saves_one(
    folder: Path, details: tuple[str, ...]
) -> None:
    (folder / "fit.txt").write_text(run("fit", "log.csv", *details, cwd=folder).stdout)
    map_of = ("map", "machine.toml", "--fit")
    line = "hersey fit LOG --machine machine.toml --json"
    said = "fit.txt is the text that hersey fit prints without --json"
    refused = run(*map_of, "fit.txt", cwd=folder)
    assert refused.stderr == f"hersey: {said}. Save the fit again with: {line} > fit.json\n"
    words = line.replace("LOG", "log.csv").split()[1:]
    (folder / "fit.json").write_text(run(*words, cwd=folder).stdout)
    assert run(*map_of, "fit.json", cwd=folder).stderr.startswith("The no-load torque comes from the fit")


@pytest.mark.usefixtures("roughly")
def test_the_no_load_log_of_the_machine_is_no_log_of_the_film(folder: Path) -> None:
    (folder / "copy.csv").write_bytes((folder / "free.csv").read_bytes())
    tail = ("--machine", "with-log.toml", "--json")
    refused = run("fit", "log.csv", "copy.csv", *tail, cwd=folder)
    assert refused.returncode == 2
    said = "hersey: copy.csv is the no-load log of the machine file ([rest] log), so its torque has no part"
    line = f"hersey fit log.csv {' '.join(tail)}"
    assert refused.stderr.splitlines()[-1] == f"{said} of the film. Leave it out: {line}"
    assert run(*line.split()[1:], cwd=folder).returncode == 0
    alone = run("fit", "copy.csv", *tail, cwd=folder)
    said += " of the film. Give the log that was recorded with the film"
    assert alone.stderr.splitlines()[-1] == said


def test_a_dwell_without_a_film_is_named_by_its_own_log() -> None:
    def recorded(name: str, scale: float) -> Run:
        speed = np.repeat([5.0, 10.0, 20.0, 40.0], 200)
        torque = scale * (0.05 + 0.001 * speed) * (1 + 1e-3 * np.sin(np.arange(speed.size)))
        return Run(name, 0.05 * np.arange(speed.size), torque, speed, None)

    runs = (recorded("film.csv", 2.0), recorded("free.csv", 0.9))
    log = TorqueLog(runs, tuple(LogFile(run.name, "0", 0, run.time.size, 0, (), ()) for run in runs))
    rest = NoLoadTorque.stated(constant=0.05, per_speed=0.001, uncertainty=0.01)
    with pytest.raises(InsufficientDataError, match=r"^free\.csv: at .* leaves nothing for the film"):
        log.steady().without(rest)


@pytest.mark.usefixtures("roughly")
def test_a_dwell_that_the_no_load_error_hides_is_excluded_and_the_log_is_used(folder: Path) -> None:
    lines = (folder / "log.csv").read_text().splitlines()
    # At 8 rpm the no-load torque is 20.8 mN m with an error of 2.08.
    lines[1] = lines[1].split(",")[0] + ",24.0," + lines[1].split(",")[2]
    (folder / "weak.csv").write_text("\n".join(lines) + "\n")
    mentions = '\n[rest]\ntorque = "20 mN*m"\ndamping = "1 mN*m*s/rad"\nuncertainty = "20 %"\n'
    (folder / "unsure.toml").write_text(MACHINE + mentions)
    done = run("fit", "weak.csv", "--machine", "unsure.toml", "--json", cwd=folder)
    assert done.returncode == 0, done.stderr
    assert len(json.loads(done.stdout)["points"]) == 23
    assert exponent(done.stdout) == pytest.approx(-0.6, abs=1e-6)
    said = "1 of 24 dwells (at 8 rpm) was excluded: torque is not above the no-load torque by more than twice"
    printed = run("fit", "weak.csv", "--machine", "unsure.toml", cwd=folder).stdout
    assert said in " ".join(printed.split())
    report = run("report", "weak.csv", "--machine", "unsure.toml", "--out", "weak.html", cwd=folder)
    assert report.returncode == 0, report.stderr
    added = ("campaign", "add", "life.hersey", "weak.csv", "--unit", "U1", "--age", "0 pages")
    life = run(*added, "--machine", "unsure.toml", cwd=folder)
    assert life.returncode == 0, life.stderr
    rest = NoLoadTorque.stated(constant=0.02, per_speed=0.001, uncertainty=0.2)
    points = SteadyPoints.from_table(folder / "weak.csv").without(rest)
    assert [(each.why.kind, each.rows) for each in points.rejected] == [("no film", 1)]
