"""A run of the app, without its server."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import hersey
from hersey.app import running
from hersey.damping.dwells import SteadyPoints
from tests.app.test_mistakes import log
from tests.cli.command import run as command
from tests.damping.moving_logs import sine


def test_an_earlier_log_is_read_as_the_other_and_handed_on(tmp_path: Path, monkeypatch: Any) -> None:
    for name, turn in (("new.csv", 1.2), ("old.csv", 1.0)):
        content = log(change=lambda t, q, n, c, turn=turn: (t, turn * float(q), n, c))
        (tmp_path / name).write_bytes(content)
    (tmp_path / "hersey.toml").write_text("[torque]\ngear_ratio = 2\n")
    taken: dict[str, SteadyPoints] = {}

    class SeenError(Exception):
        pass

    def study(points: SteadyPoints, *_: object, against: SteadyPoints, **_others: object) -> None:
        taken.update(new=points, old=against)
        raise SeenError

    monkeypatch.setattr(running, "study", study)
    request = {
        "logs": [str(tmp_path / "new.csv")], "against": str(tmp_path / "old.csv"), "machine": None,
        "mapping": str(tmp_path / "hersey.toml"), "isothermal": False, "drop_missing": False,
        "tare": "none", "command": "", "report": "",
    }  # fmt: skip
    steps: list[str] = []
    with pytest.raises(SeenError):
        running.run(request, lambda name, _share: steps.append(name))
    ratio = taken["new"].column("torque") / taken["old"].column("torque")
    assert ratio == pytest.approx(1.2, rel=1e-6)
    plain = hersey.read(tmp_path / "old.csv").steady().column("torque")
    assert taken["old"].column("torque") == pytest.approx(2.0 * plain, rel=1e-9)
    assert "reading the earlier log" in steps


def test_a_run_leaves_its_recipe_beside_the_report(tmp_path: Path) -> None:
    """With logs and mapping in one folder, the command line finds the same dwells by it."""
    private, own = tmp_path / "private", tmp_path / "own"
    for folder in (private / "1", private / "2", own):
        folder.mkdir(parents=True)
    names = {"new.csv": private / "1", "more.csv": private / "2"}
    for turn, (name, folder) in enumerate(names.items(), 1):
        content = log(change=lambda t, q, n, c, turn=turn: (t, turn * float(q), n, c))
        (folder / name).write_bytes(content)
        (own / name).write_bytes(content)
    for folder in (private, own):
        (folder / "hersey.toml").write_text("[torque]\ngear_ratio = 2\n")
    request = {
        "logs": [str(folder / name) for name, folder in names.items()], "against": None, "machine": None,
        "mapping": str(private / "hersey.toml"), "isothermal": True, "drop_missing": False, "tare": "none",
        "command": "", "report": str(private / "r4nd0m.html"),
    }  # fmt: skip
    running.run(request, lambda _name, _share: None)
    (own / "recipe.toml").write_bytes((private / "r4nd0m.toml").read_bytes())
    recipe = hersey.Recipe.from_file(own / "recipe.toml")
    assert recipe.logs == (own / "new.csv", own / "more.csv")
    assert (recipe.mapping, recipe.isothermal) == (own / "hersey.toml", True)
    done = command("fit", "--recipe", "recipe.toml", "--json", cwd=own)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)["points"]
    of_app = running._points(request, None, lambda _name, _share: None)
    assert [point["torque"] for point in found] == of_app.column("torque").tolist()
    assert str(private) not in (private / "r4nd0m.html").read_text()


def test_a_log_that_moves_is_found_without_a_control_for_it(tmp_path: Path) -> None:
    """The app has none: its report is of every sample by itself."""
    sine().to_frame().drop("run").write_csv(tmp_path / "joint.csv")
    request = {
        "logs": [str(tmp_path / "joint.csv")], "mapping": None, "isothermal": True, "drop_missing": False,
        "tare": "none",
    }  # fmt: skip
    points = running._points(request, None, lambda _name, _share: None)
    assert points.of_every_sample
    assert points.recipe is not None
    assert points.recipe.to_dict() == {"logs": ["joint.csv"], "isothermal": True}
