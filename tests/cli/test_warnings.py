"""What must be known before a fit is trusted: said alike by every command that fits a log."""

from __future__ import annotations

import json
import re
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hersey.units import rpm
from tests.cli.command import run
from tests.conftest import ROOT

SPEEDS = (2, 4, 8, 16, 32, 64, 128)
OFFSET = 0.004


def log(path: Path, torque: Any, directions: tuple[int, ...]) -> None:
    """Write a staircase at two temperatures that begins with a stand, sensor offset included."""
    random, lines, time = (
        np.random.default_rng(5),
        ["Time [s],Torque [N*m],Speed [rpm],Temperature [degC]"],
        0.0,
    )
    for degc in (100, 150):
        for speed in (0, *(way * w for way in directions for w in SPEEDS)):
            for _ in range(50):
                level = np.sign(speed) * torque(abs(speed), degc, speed > 0) if speed else 0.0
                noise = 0.0005 * random.standard_normal()
                lines.append(f"{time:.1f},{level + OFFSET + noise:.6g},{speed},{degc}")
                time += 0.1
    path.write_text("\n".join(lines) + "\n")


@pytest.fixture(autouse=True)
def _few(few_laws: None) -> None:
    """No warning comes of the laws that are left out."""


def two_ways(speed: float, degc: float, forward: bool) -> float:
    """A film that drags a tenth more in reverse."""
    return float(0.1 * (speed / 10) ** 0.35 * (100 / degc) ** 0.5 * (1.0 if forward else 1.1))


def falling(speed: float, degc: float, forward: bool) -> float:  # noqa: ARG001 - both turn alike
    """Torque that only falls with speed."""
    return float(0.3 * (speed / 10) ** -0.2 * (100 / degc) ** 0.5)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("logs")
    log(path / "two-ways.csv", two_ways, (1, -1))
    log(path / "falling.csv", falling, (1,))
    return path


@cache
def told(folder: Path, verb: str, *options: str) -> Any:
    """What a command prints as JSON; asked once, to be looked at and not changed."""
    done = run(verb, *options, "--json", cwd=folder)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def said(warning: dict[str, Any]) -> str:
    """A warning of a document as the terminal says it."""
    text = ": ".join(warning[part] for part in ("where", "title", "text") if warning[part])
    text = text if warning["where"] else f"{text[:1].upper()}{text[1:]}"
    return text if text[-1] in ".?" else f"{text}."


def unwrapped(text: str) -> list[str]:
    """The lines of a text as they were before the width of a terminal broke them."""
    return re.sub(r"\n  (?! )", " ", text).splitlines()


CASES = [
    ("two-ways.csv", "--tare", "standing"),
    ("two-ways.csv", "--tare", "standing", "--rotation", "forward"),
    ("two-ways.csv", "--rotation", "reverse", "--tare", "standing"),
    ("falling.csv",),
    ("falling.csv", "--tare", "standing"),
]


@pytest.mark.parametrize("asked", CASES, ids=" ".join)
def test_fit_says_what_the_report_warns_of(asked: tuple[str, ...], folder: Path) -> None:
    warned = told(folder, "report", *asked)["warnings"]
    assert told(folder, "fit", *asked)["warnings"] == warned
    for flags, severities in (([], {"act", "watch"}), (["-v"], {"act", "watch", "note", "good"})):
        printed = unwrapped(run("fit", *asked, *flags, cwd=folder).stdout)
        assert sorted(line.removeprefix("- ") for line in printed if line.startswith("- ")) == sorted(
            said(each) for each in warned if each["severity"] in severities
        )


def test_what_the_two_directions_differ_by_is_warned_of_until_one_is_taken(folder: Path) -> None:
    for verb in ("fit", "report"):
        both = told(folder, verb, "two-ways.csv", "--tare", "standing")["warnings"]
        assert any(each["kind"] == "directions differ" and "--rotation" in each["text"] for each in both)
        one = told(folder, verb, "two-ways.csv", "--tare", "standing", "--rotation", "forward")["warnings"]
        assert not any(each["kind"] == "directions differ" for each in one)


def test_an_offset_is_warned_of_until_it_is_subtracted(folder: Path) -> None:
    for verb in ("fit", "report"):
        assert any(
            "use --tare standing" in each["text"] for each in told(folder, verb, "falling.csv")["warnings"]
        )
        tared = told(folder, verb, "falling.csv", "--tare", "standing")["warnings"]
        assert not any("--tare standing" in each["text"] for each in tared)


@pytest.mark.parametrize("asked", CASES, ids=" ".join)
def test_inspect_and_report_do_not_contradict_each_other(asked: tuple[str, ...], folder: Path) -> None:
    support = told(folder, "inspect", *asked)["support"]
    document = told(folder, "report", *asked)
    assert support["dwells"] == len(document["points"])
    speeds = [abs(point["speed"]) for point in document["points"]]
    assert support["speeds"] == len(SPEEDS)
    (said,) = [each for each in support["can"] if each.startswith("exponent c (speed)")]
    assert f"{rpm(min(speeds)):.3g} to {rpm(max(speeds)):.3g} rpm" in said
    transitions = [each for each in support["can"] if each.startswith("a transition")]
    assert bool(transitions) == (document["fit"]["transition"] is not None)
    assert any("one exponent" in each for each in support["cannot"]) == bool(_drifts(document))


def test_inspect_says_before_a_fit_what_a_fit_says_of_tare_and_order(folder: Path) -> None:
    early = {"zero drifts", "one standing stretch", "two standing stretches", "large tare", "in order"}
    for asked in CASES[3:]:
        warned = told(folder, "report", *asked)["warnings"]
        found = told(folder, "inspect", *asked)["warnings"]
        named = [each for each in warned if each["kind"] in early]
        assert [each for each in found if each["kind"] in early] == named
        assert all(each in warned for each in found)
    assert {"zero drifts", "two standing stretches"} <= {each["kind"] for each in found}


def test_models_and_film_say_it_too(folder: Path) -> None:
    warned = told(folder, "fit", "falling.csv")["warnings"]
    cheap = ["falling.csv", "--bootstrap", "0"]
    assert told(folder, "models", *cheap)["warnings"] == warned
    machine = ROOT / "tests" / "stand" / "machine.toml"
    film = unwrapped(run("film", machine, "--log", "falling.csv", "-v", cwd=folder).stdout)
    assert {f"- {said(each)}" for each in warned} <= set(film)


def _drifts(document: Any) -> list[str]:
    """Where the verdict says that no one exponent holds."""
    return [
        each for each in document["verdict"] if re.search("no single exponent holds", each, re.IGNORECASE)
    ]


def test_a_doubtful_unit_comes_before_the_result(folder: Path) -> None:
    path = folder / "hot.csv"
    path.write_text(
        (folder / "falling.csv").read_text().replace(",100\n", ",212\n").replace(",150\n", ",600\n")
    )
    done = run("fit", path.name, cwd=folder)
    assert done.stderr.startswith("hersey: warning: ")
    assert "--temperature-unit 'degF'" in " ".join(done.stderr.split())
    assert run("fit", "falling.csv", cwd=folder).stderr == ""
