"""Commands hand on what they are told: seeds, temperatures, limits; and never write over what they read."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

import hersey
from hersey.cli.application import VERBS, load
from hersey.machine.machine import read_machine
from hersey.stability.plan.of_log import drag_and_draws
from tests.cli.command import run
from tests.conftest import ROOT

IS_AN_INPUT = "is an input: name another file for the output\n"


def test_a_report_never_replaces_what_it_reads(bench_csv: Path, tmp_path: Path) -> None:
    machine, log, mapping = (tmp_path / name for name in ("machine.toml", "bench.csv", "bench-rig.toml"))
    shutil.copy(ROOT / "tests" / "stand" / "machine.toml", machine)
    shutil.copy(bench_csv, log)
    mapping.write_text("")
    for path in (machine, log, mapping):
        before = path.read_bytes()
        read = [log, "--tare", "standing", "--machine", machine, "--mapping", mapping]
        done = run("report", *read, "--out", path, "--force", cwd=tmp_path)
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr.endswith(IS_AN_INPUT)
        assert path.read_bytes() == before


def test_a_map_and_a_plan_never_replace_what_they_read(bench_csv: Path, tmp_path: Path) -> None:
    fit = tmp_path / "fit.html"
    fit.write_text("{}")
    done = run(
        "map", ROOT / "tests" / "stand" / "machine.toml", "--fit", fit, "--out", fit, "--force", cwd=tmp_path
    )
    assert done.stderr.endswith(f"fit.html {IS_AN_INPUT}")
    machine, course = tmp_path / "machine.toml", tmp_path / "course.csv"
    shutil.copy(ROOT / "tests" / "stand" / "machine.toml", machine)
    course.write_text("time (s),temperature (degC)\n0,150\n")
    asked = ["plan", machine, bench_csv, "--target", "40 mm/s", "--temperature-profile", course]
    for path in (machine, course, bench_csv):
        done = run(*asked, "--out", path, "--force", cwd=tmp_path)
        assert (done.returncode, done.stderr.endswith(IS_AN_INPUT)) == (2, True)


@pytest.mark.parametrize(
    "typed",
    [
        "report none.csv --out kept.html",
        "report none.csv --figures kept",
        "inspect none.csv --figure kept.svg",
        "new none.csv --machine kept.toml",
        "new none.csv --mapping kept.toml",
        "film none.toml --log none.csv --figure kept.svg",
        "map none.toml none.csv --out kept.html",
        "posterior none.csv --machine none.toml --out kept.csv",
        "plan none.toml none.csv --target 1 --out kept.csv",
        "plan none.toml none.csv --target 1 --figure kept.svg",
        "cycles none.csv --figure kept.svg",
        "sweep none.toml --out kept.csv",
        "coastdown none.csv --inertia 1 --points kept.csv",
        "coastdown none.csv --inertia 1 --figure kept.svg",
        "trend none.csv --out kept.csv",
        "trend none.csv --figure kept.svg",
        "weibull none.csv --out kept.csv",
        "weibull none.csv --figure kept.svg",
        "campaign export none.hersey --out kept.csv",
        "export fmu none.json none.toml --out kept.fmu",
        "life none.hersey --machine none.toml --out kept.html",
        "life none.hersey --machine none.toml --figures kept",
        "simulate --mass -1 --csv kept.csv",
        "simulate --mass -1 --figure kept.svg",
        "warmup none.toml none.csv --target 1 --out kept.csv",
        "warmup none.toml none.csv --target 1 --figure kept.svg",
        "testbench --size none --out kept.csv",
        "testbench --size none --out new.csv --truth kept.json",
    ],
)
def test_outputs_are_refused_before_inputs_are_read(typed: str, tmp_path: Path) -> None:
    """What would be replaced is named, not the input that is missing or wrong."""
    for name in (
        "kept.html",
        "kept.svg",
        "kept.csv",
        "kept.fmu",
        "kept.toml",
        "kept.json",
        "kept/figure.svg",
    ):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("mine")
    done = run(*typed.split(), cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert "kept" in done.stderr
    assert "--force" in done.stderr
    assert {path.read_text() for path in tmp_path.rglob("*.*")} == {"mine"}


@pytest.mark.parametrize(
    ("typed", "ends"),
    [
        ("report none.csv --out r.pdf", ".html or .htm"),
        ("report none.csv --out r", ".html or .htm"),
        ("life none.hersey --machine none.toml --out l.pdf", ".html or .htm"),
        ("inspect none.csv --figure c.jpg", ".html, .png, .svg or .pdf"),
        ("film none.toml --figure f.jpg", ".html, .png, .svg or .pdf"),
        ("map none.toml none.csv --out m.csv", ".html, .png, .svg or .pdf"),
        ("cycles none.csv --figure c.jpg", ".html, .png, .svg or .pdf"),
        ("simulate --mass -1 --figure m.jpg", ".html, .png, .svg or .pdf"),
        ("simulate --mass -1 --csv m.parquet", ".csv"),
        ("plan none.toml none.csv --target 1 --out p.xlsx", ".csv"),
        ("plan none.toml none.csv --target 1 --figure p.jpg", ".html, .png, .svg or .pdf"),
        ("warmup none.toml none.csv --target 1 --out p.xlsx", ".csv"),
        ("warmup none.toml none.csv --target 1 --figure p.jpg", ".html, .png, .svg or .pdf"),
        ("posterior none.csv --machine none.toml --out d.xlsx", ".csv, .parquet or .nc"),
        ("sweep none.toml --out s.xlsx", ".csv, .parquet or .zarr"),
        ("fit none.csv --each f.xlsx", ".csv or .parquet"),
        ("coastdown none.csv --inertia 1 --points c.xlsx", ".csv"),
        ("coastdown none.csv --inertia 1 --figure c.jpg", ".html, .png, .svg or .pdf"),
        ("trend none.csv --out t.xlsx", ".csv"),
        ("trend none.csv --figure t.jpg", ".html, .png, .svg or .pdf"),
        ("campaign export none.hersey --out d.xlsx", ".csv or .parquet"),
        ("export fmu none.json none.toml --out d.zip", ".fmu"),
        ("new none.csv --machine m.json", ".toml"),
        ("new none.csv --mapping m.json", ".toml"),
        ("testbench --size none --out log.parquet", ".csv"),
        ("testbench --size none --truth truth.txt", ".json"),
    ],
)
def test_a_kind_of_file_that_cannot_be_written_is_refused_first(
    typed: str, ends: str, tmp_path: Path
) -> None:
    """The kinds that can be written are named, before any input is read."""
    *_, flag, name = typed.split()
    done = run(*typed.split(), cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"hersey: {flag} {name}: name a file that ends in {ends}\n"
    assert list(tmp_path.iterdir()) == []


def test_every_verb_that_writes_is_refused_above() -> None:
    """A new option that writes a file belongs on the list."""
    (marks,) = test_outputs_are_refused_before_inputs_are_read.pytestmark  # type: ignore[attr-defined]
    listed = {(line.split()[0], flag) for line in marks.args[1] for flag in line.split() if "--" in flag}
    outputs = {"--out", "--figure", "--figures", "--csv", "--truth", "--points"}
    writes = {
        (name, flag)
        for name in VERBS
        for parameter in load(name).params
        for flag in parameter.opts
        if flag in outputs
    }
    assert writes <= listed


def test_the_stick_speed_moves_with_the_temperature_asked_for(points: hersey.SteadyPoints) -> None:
    surface = hersey.fit(points)
    machine = read_machine(ROOT / "tests" / "stand" / "machine.toml")
    whole = surface.drag(roll_radius=0.015, stick_speed=machine.stick_speed)
    for kelvin in (373.15, 453.15):
        drag, samples = drag_and_draws(surface, machine, kelvin, 3, varies=False)
        at = whole.at(kelvin)
        for name in ("transition_force", "transition_speed", "stick_speed"):
            assert getattr(drag, name) == pytest.approx(getattr(at, name), rel=1e-12)
        assert drag.stick_speed != machine.stick_speed
        expected = surface.drag_samples(
            4000, 3, roll_radius=0.015, stick_speed=machine.stick_speed, temperature=kelvin
        )
        for name, values in expected.items():
            assert samples[name].tolist() == values.tolist()
        other = drag_and_draws(surface, machine, kelvin, 4, varies=False)[1]
        assert other["transition_speed"].tolist() != samples["transition_speed"].tolist()
    drag, samples = drag_and_draws(surface, machine, None, 3, varies=True)
    assert drag == whole
    at_reference = surface.drag_samples(
        4000, 3, roll_radius=0.015, stick_speed=machine.stick_speed, temperature=whole.reference_temperature
    )
    assert samples["transition_speed"].tolist() == at_reference["transition_speed"].tolist()


def test_draws_are_refused_at_the_stick_speed_of_their_temperature(points: hersey.SteadyPoints) -> None:
    """It decides which draws have no falling branch: one stated so high that some have none when hot."""
    surface = hersey.fit(points)
    at = surface.transition_speed(453.15) / surface.transition_speed()
    stick = 0.9 * 0.015 * surface.transition_speed()
    counts = []
    for rule, speed in (("with transition", stick), ("fixed", stick * at)):
        with pytest.warns(UserWarning, match="no falling branch") as caught:
            surface.drag_samples(
                4000, 3, roll_radius=0.015, stick_speed=speed, temperature=453.15, stick_speed_rule=rule
            )
        counts.append(str(caught[0].message))
    assert counts[0] == counts[1]


def test_a_plan_for_a_hot_machine_says_its_speeds(
    tmp_path: Path, bench_csv: Path, points: hersey.SteadyPoints
) -> None:
    """The printed transition speed is that of the drag at the temperature asked for, and V* lies above it."""
    machine = read_machine(ROOT / "tests" / "stand" / "machine.toml")
    done = run(
        "plan", ROOT / "tests" / "stand" / "machine.toml", bench_csv, "--tare", "standing",
        "--target", "20 mm/s", "--at", "180 degC", "--seed", "9", "--json", cwd=tmp_path,
    )  # fmt: skip
    assert done.returncode == 1, done.stderr
    document = json.loads(done.stdout)
    drag = hersey.fit(points).drag(roll_radius=0.015, stick_speed=machine.stick_speed).at(453.15)
    assert document["transition_speed"] == pytest.approx(drag.transition_speed, rel=0.03)
    assert document["fold_speed"] > 1.2 * drag.transition_speed
    assert [each["limit"] for each in document["obstacles"]] == ["target_speed"]
    assert (document["target_speed"], document["seed"], document["confidence"]) == (
        pytest.approx(0.02),
        9,
        0.95,
    )
