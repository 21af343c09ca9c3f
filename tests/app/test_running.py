"""A run of the app, without its server."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import hersey
from hersey.app import running
from hersey.damping.dwells import SteadyPoints
from tests.app.test_mistakes import log


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
