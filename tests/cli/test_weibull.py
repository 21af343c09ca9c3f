"""``hersey weibull``: what it prints, writes and refuses."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.command import run
from tests.conftest import ROOT

FAILURES = str(ROOT / "examples" / "failures.csv")


def test_the_law_and_what_follows_from_it(tmp_path: Path) -> None:
    (tmp_path / "fleet.csv").write_text("age [h],count\n0,100\n200,50\n")
    asked = ["--age", "200 h", "--fleet", "fleet.csv", "--ahead", "50 h", "--demonstrate", "300 h"]
    asked += ["--cost-of-failure", "10"]
    done = run("weibull", FAILURES, *asked, "--out", "law.csv", "--figure", "plot.svg", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    for words in (
        "20 specimens, 10 failed, B10 164 h, B50 490 h.",
        "likelihood-ratio bounds, calibrated, 90 % two-sided, 95 % each alone.",
        "A specimen of 200 h has a median remaining life of 348.6",
        "Of 150 specimens",
        "Whether a planned replacement pays is not yet decided. At 208 h it costs",
        "demonstrate a B10 of 300 h with 90 % confidence",
    ):
        assert words in done.words
    assert done.stdout.endswith("law.csv\nplot.svg\n")
    assert (tmp_path / "law.csv").read_text().startswith("name,value,unit\nspecimens,20.0,")
    assert "63.2" in (tmp_path / "plot.svg").read_text()


def test_a_test_is_planned_without_a_table(tmp_path: Path) -> None:
    done = run("weibull", "--demonstrate", "100000 pages", "--shape", "2", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    printed = json.loads(done.stdout)
    assert printed["law"] is None
    least = [d for d in printed["plan"]["demonstrations"] if d["age"] == 100000 and d["allowed"] == 0]
    assert [each["specimens"] for each in least] == [22]


@pytest.mark.parametrize(
    ("typed", "words"),
    [
        ([], "name a table of FAILURES, or plan a test with --demonstrate AGE --shape SHAPE"),
        (["--demonstrate", "3 h", "--shape", "2", "--age", "1 h"], "without a table of FAILURES only"),
        ([FAILURES, "--ahead", "50 h"], "--ahead needs the specimens that run: add --fleet fleet.csv"),
        ([FAILURES, "--fleet", FAILURES], "--fleet needs how much further it runs: add e.g. --ahead"),
        ([FAILURES, "--age", "3 pages"], "--age: an age is in pages, but the others are in h"),
        ([FAILURES, "--use", "40 degC"], "--use needs the column of the stress: add --arrhenius COLUMN"),
        (
            [FAILURES, "--cost-of-failure", "1"],
            "--cost-of-failure is 1: it must be above 1 and at most 10000",
        ),
        (
            ["--demonstrate", "3 h", "--shape", "2", "--cost-of-failure", "5"],
            "without a table of FAILURES only",
        ),
        ([FAILURES, "--law", "normal"], "law 'normal' is none of weibull, lognormal, gamma"),
        (
            [FAILURES, "--law", "gamma", "--demonstrate", "3 h"],
            "--demonstrate needs the shape",
        ),
        (["nothing.csv"], "nothing.csv"),
    ],
)
def test_what_is_refused(typed: list[str], words: str, tmp_path: Path) -> None:
    done = run("weibull", *typed, cwd=tmp_path)
    assert done.returncode == 2
    assert words in " ".join(done.stderr.split())
    assert not done.stdout
