"""A recipe on the command line: written, read back, and replaced in part by what is typed."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from hersey import Recipe
from tests.cli.command import run
from tests.conftest import ROOT

BENCH = ROOT / "examples" / "bench.csv"
TARE = ("--tare", "standing", "--min-dwell", "16 s")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A log in a folder of its own, and a recipe for it in another."""
    (tmp_path / "logs").mkdir()
    (tmp_path / "kept").mkdir()
    shutil.copy(BENCH, tmp_path / "logs" / "bench.csv")
    done = run("inspect", "logs/bench.csv", *TARE, "--save-recipe", "kept/recipe.toml", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.rstrip().endswith("\nkept/recipe.toml")
    return tmp_path


def fitted(*arguments: str, cwd: Path) -> Any:
    done = run("fit", *arguments, "--json", cwd=cwd)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_files_are_named_as_they_lie_from_the_recipe(folder: Path) -> None:
    text = (folder / "kept" / "recipe.toml").read_text()
    assert text == 'logs = ["../logs/bench.csv"]\nmin_dwell = "16.0 s"\ntare = "standing"\n'


def test_a_saved_recipe_gives_the_same_dwells(folder: Path) -> None:
    typed = fitted("logs/bench.csv", *TARE, cwd=folder)
    plain = fitted("logs/bench.csv", cwd=folder)
    assert len(typed["points"]) < len(plain["points"])
    assert fitted("--recipe", "recipe.toml", cwd=folder / "kept")["points"] == typed["points"]


def test_what_is_typed_replaces_what_the_recipe_says(folder: Path) -> None:
    """Also where it is the default of the option, as ``--tare none`` is."""
    kept = fitted("--recipe", "kept/recipe.toml", cwd=folder)
    none = fitted("--recipe", "kept/recipe.toml", "--tare", "none", cwd=folder)
    assert kept["points"][0]["tare"] > 0.0
    assert {point["tare"] for point in none["points"]} == {0.0}
    assert len(none["points"]) == len(kept["points"])  # of the recipe's shortest dwell
    (folder / "other.csv").write_bytes(BENCH.read_bytes())
    other = fitted("other.csv", "--recipe", "kept/recipe.toml", cwd=folder)
    assert [file["name"] for file in other["files"]] == ["other.csv"]
    assert other["points"] == kept["points"]


def test_every_setting_survives_the_command_line(tmp_path: Path) -> None:
    """A recipe that is saved by a command that read another is the same."""
    shutil.copy(BENCH, tmp_path / "bench.csv")
    (tmp_path / "map.toml").write_text("[speed]\nsign = 1\n")
    recipe = Recipe(
        logs=tmp_path / "bench.csv",  # type: ignore[arg-type]
        mapping=tmp_path / "map.toml",
        channels={"torque": "Drive torque", "time": "Time"},
        units={"torque": "N*m"},
        signs={"torque": -1, "speed": -1},
        radius=0.1 + 0.2,
        load=(1e-3, 70.0),
        isothermal=True,
        drop_missing=True,
        min_dwell=1 / 3,
        tare="standing",
        rotation="reverse",
        temperature_scale="K",
        no_load=tmp_path / "bench.csv",
        moving=True,
        inertia=1 / 7,
    )
    recipe.save(tmp_path / "one.toml")
    done = run("inspect", "--recipe", "one.toml", "--save-recipe", "two.toml", cwd=tmp_path)
    assert (tmp_path / "two.toml").is_file(), done.stderr
    assert Recipe.from_file(tmp_path / "two.toml") == recipe


def test_no_file_is_overwritten_unasked(folder: Path) -> None:
    before = (folder / "kept" / "recipe.toml").read_text()
    typed = ("inspect", "logs/bench.csv", "--save-recipe", "kept/recipe.toml")
    done = run(*typed, cwd=folder)
    assert (done.returncode, done.stdout) == (2, "")
    assert "use --force to replace it" in done.stderr
    assert (folder / "kept" / "recipe.toml").read_text() == before
    assert run(*typed, "--force", cwd=folder).returncode == 0
    assert (folder / "kept" / "recipe.toml").read_text() == 'logs = ["../logs/bench.csv"]\n'
    used = ("inspect", "--recipe", "kept/recipe.toml", "--save-recipe", "kept/recipe.toml", "--force")
    assert "is an input" in run(*used, cwd=folder).stderr
    assert "ends in .toml" in run("inspect", "logs/bench.csv", "--save-recipe", "r.txt", cwd=folder).stderr


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("logs = []\n", "name a LOG, or a recipe that names one"),
        ("[torque]\nsign = -1\n", "recipe.toml, line 1: "),
        ('logs = ["gone.csv"]\n', "gone.csv"),
        ('[channels]\nfilm = "x"\n', "recipe.toml: channels.film: use one of time, torque"),
        ('[units]\nrun = "1"\n', "recipe.toml: units.run: use one of"),
        ("[signs]\ntemperature = -1\n", "recipe.toml: signs.temperature: use one of torque, speed"),
        (
            'load = "3 N"\n[channels]\nload = "Fn"\n',
            "recipe.toml: load and channels.load both state the load",
        ),
        ('[channels]\nload = "50 N"\n', "recipe.toml: channels.load is '50 N', which --load reads as"),
    ],
)
def test_what_is_wrong_with_a_recipe_is_named(tmp_path: Path, text: str, says: str) -> None:
    (tmp_path / "recipe.toml").write_text(text)
    done = run("fit", "--recipe", "recipe.toml", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert says in done.stderr


def test_a_finished_fit_takes_no_recipe(folder: Path) -> None:
    (folder / "fit.json").write_text("{}")
    machine = ROOT / "tests" / "stand" / "machine.toml"
    done = run("map", machine, "--fit", "fit.json", "--recipe", "kept/recipe.toml", cwd=folder)
    assert "--fit names a saved fit" in done.stderr


def test_a_film_is_compared_with_the_log_of_a_recipe(folder: Path) -> None:
    machine = ROOT / "examples" / "machine.toml"
    typed = run("film", machine, "--log", "logs/bench.csv", *TARE, cwd=folder)
    assert typed.returncode == 0, typed.stderr
    assert run("film", machine, "--recipe", "kept/recipe.toml", cwd=folder).stdout == typed.stdout


def test_a_report_holds_the_recipe_that_repeats_it(folder: Path) -> None:
    done = run("report", "--recipe", "kept/recipe.toml", "--json", cwd=folder)
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    assert document["recipe"]["settings"] == {
        "logs": ["bench.csv"],
        "min_dwell": 16.0,
        "tare": "standing",
    }
    (folder / "logs" / "again.toml").write_text(document["recipe"]["toml"])
    again = fitted("--recipe", "logs/again.toml", cwd=folder)
    shown = {name: [point[name] for point in document["points"]] for name in ("torque", "speed", "tare")}
    assert shown == {name: [point[name] for point in again["points"]] for name in shown}
    assert str(folder) not in json.dumps(document)
