"""A report beside an earlier log: the same comparison as `hersey compare`, named on the first screen."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.damping.compare import compare
from hersey.document.analysis import Analysis
from hersey.document.assembly import document_of, load
from hersey.errors import InsufficientDataError, ParameterError
from hersey.log.means import read_means
from hersey.result import json_value
from hersey.study import study
from hersey.study.findings import Findings
from hersey.study.first_screen.flags import MOST, flags
from hersey.verdict.regime import regime
from tests.cli.command import run

#: Torque of the earlier log over that of this one, and speed of its transition.
LOGS = {"new.csv": (1.0, 1.0, 1), "again.csv": (1.0, 1.0, 2), "more.csv": (1.25, 1.0, 3)}


def written(folder: Path, name: str, *, of: str = "", times: float = 1.0) -> Path:
    """A table of means of a law with a falling and a rising branch."""
    factor, turn, seed = LOGS[of or name]
    rng = np.random.default_rng(seed)
    speeds = np.repeat(np.geomspace(0.5, 30.0, 12), 2)
    torques = factor * np.maximum((speeds / turn / 3) ** -0.4, (speeds / turn / 3) ** 0.3)
    torques *= np.exp(0.004 * rng.standard_normal(speeds.size))
    rows = [f"{times * w:.9g},{t:.9g}" for w, t in zip(speeds, torques, strict=True)]
    path = folder / name
    path.parent.mkdir(exist_ok=True)
    path.write_text("\n".join(["Speed [rad/s],Torque [N*m]", *rows]) + "\n")
    return path


def dwells(path: Path) -> hersey.SteadyPoints:
    return hersey.SteadyPoints.from_table(read_means([path], isothermal=True))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("two")
    written(made, "new.csv")
    return made


@pytest.fixture(scope="module")
def less(folder: Path) -> Analysis:
    """A log that takes less than an earlier one."""
    now, earlier = dwells(written(folder, "new.csv")), dwells(written(folder, "more.csv"))
    return document_of(study(now, against=earlier))


def test_it_is_the_comparison_of_the_two_logs_the_earlier_one_first(less: Analysis, folder: Path) -> None:
    names = "more.csv", "new.csv"
    of = compare(*(dwells(folder / name) for name in names), names=names)
    assert json_value(less.compare) == of.to_dict()
    assert less.compare.mean_ratio.value == pytest.approx(1 / 1.25, rel=0.01)
    assert less.against is not None
    assert [file.name for file in less.against] == ["more.csv"]
    assert load(less.model_dump_json()).model_dump_json() == less.model_dump_json()


def test_what_changed_stands_on_the_first_screen(less: Analysis) -> None:
    assert less.decision is not None
    flag = less.decision.flags[0]
    assert (flag.severity, flag.where) == ("watch", "compare")
    assert flag.title == "Damping has changed since more.csv"
    assert re.match(
        r"Damping of new\.csv is lower than that of more\.csv throughout the shared range, -(19|20)",
        flag.text,
    )


def test_what_did_not_change_has_its_place_too(folder: Path) -> None:
    """Among three warnings that are graver, and without a signal of its own."""
    now, earlier = dwells(written(folder, "new.csv")), dwells(written(folder, "again.csv"))
    found = compare(earlier, now, names=("again.csv", "new.csv"))
    surface = hersey.fit(now)
    seen = regime(now, surface)
    unnamed = replace(seen, named=None)
    told = flags(Findings(points=now, surface=surface, regime=unnamed, why="no band", comparison=found))
    assert len(told) == MOST
    assert (told[-1].severity, told[-1].title) == ("good", "Nothing significant has changed since again.csv")
    # nothing of the drag, but an exponent
    moved = replace(found.changes[0], p_value=0.01)
    other = replace(found, changes=(moved,))
    told = flags(Findings(points=now, surface=surface, regime=seen, comparison=other))
    assert [flag.severity for flag in told if flag.where == "compare"] == ["watch"]
    assert any(flag.title == "Fitted parameters have changed since again.csv" for flag in told)
    # more drag by a twentieth somewhere, its limits above 1
    more = replace(found, low=np.full_like(found.low, 1.05), high=np.full_like(found.high, 1.15), changes=())
    told = flags(Findings(points=now, surface=surface, regime=seen, comparison=more))
    assert [flag.title for flag in told if flag.where == "compare"] == ["Damping has changed since again.csv"]


def test_logs_of_one_name_are_told_apart_and_one_file_is_refused(folder: Path) -> None:
    now, earlier = dwells(written(folder, "new.csv")), dwells(written(folder, "old/new.csv", of="again.csv"))
    document = document_of(study(now, against=earlier))
    assert document.compare is not None
    assert (document.compare.a, document.compare.b) == ("new.csv (earlier)", "new.csv")
    with pytest.raises(ParameterError, match=r"^new\.csv is in both logs\. Name another"):
        document_of(study(now, against=dwells(folder / "new.csv")))
    faster = dwells(written(folder, "fast.csv", of="again.csv", times=1e3))
    with pytest.raises(
        InsufficientDataError, match=r"too few speeds in common: fast\.csv covers .* rpm, new\.csv "
    ):
        document_of(study(now, against=faster))


def test_typed(folder: Path, less: Analysis) -> None:
    shown = run("report", "new.csv", "--against", "more.csv", "--isothermal", "--out", "p.html", cwd=folder)
    assert less.compare is not None
    assert f"Compared with more.csv: {less.compare.verdict}" in shown.words
    page = (folder / "p.html").read_text()
    assert json.dumps(less.compare.verdict) in page


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("Speed [rad/s],Current [A]\n" + "1,2\n" * 9, r"^hersey: odd\.csv: .*torque"),
        ("Speed [rad/s],Torque [N*m]\n" + "1,2\n2,3\n" * 9, r"^hersey: odd\.csv: .*three or more speeds"),
        ("", r"^hersey: odd\.csv is empty"),
        (None, r"^hersey: File not found: odd\.csv"),
    ],
)
def test_another_log_that_is_none_is_named_in_one_line(folder: Path, text: str | None, said: str) -> None:
    other = folder / "odd.csv"
    other.unlink(missing_ok=True)
    if text is not None:
        other.write_text(text)
    for typed in (("report", "new.csv", "--against", "odd.csv"), ("compare", "odd.csv", "new.csv")):
        done = run(*typed, "--isothermal", "--json", cwd=folder)
        assert done.returncode == 2
        assert done.stderr.count("\n") == 1, done.stderr
        assert re.search(said, done.stderr), done.stderr


def test_the_other_log_is_never_written_over(folder: Path) -> None:
    written(folder, "more.csv")
    typed = ("report", "new.csv", "--against", "more.csv", "--out", "more.csv", "--force")
    done = run(*typed, cwd=folder)
    assert done.returncode == 2
    assert "more.csv is an input" in done.stderr
