"""The command explain."""

from __future__ import annotations

import json

from hersey.report.glossary import entries
from tests.cli.command import run
from tests.conftest import ROOT


def test_a_term_is_explained() -> None:
    done = run("explain", "V*", cwd=ROOT)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert lines[0] == "V*"
    assert "stick-slip cannot last" in done.stdout
    assert lines[-1] == "See: transition, stick speed, closure"
    assert max(map(len, lines)) <= 110


def test_words_of_a_term_need_no_quotes() -> None:
    quoted = run("explain", "stick speed", cwd=ROOT)
    assert quoted.stdout.startswith("stick speed\n")
    assert run("explain", "Stick", "Speed", cwd=ROOT) == quoted


def test_without_a_term_each_has_one_line() -> None:
    done = run("explain", cwd=ROOT)
    assert done.returncode == 0
    lines = done.stdout.splitlines()
    assert len(lines) == len(entries())
    for line, each in zip(lines, entries(), strict=True):
        assert line.startswith(f"{each.term}  ")
        assert len(line) <= 110


def test_a_near_miss_names_the_term() -> None:
    done = run("explain", "stik", "sped", cwd=ROOT)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr == "hersey: 'stik sped' is not in the glossary; did you mean 'stick speed'?\n"


def test_a_curve_is_proposed_before_a_closure_of_its_name() -> None:
    done = run("explain", "Stribek", cwd=ROOT)
    assert done.stderr.endswith("did you mean 'Stribeck curve' or 'stribeck'?\n")
    assert run("explain", "Stribeck curve", cwd=ROOT).stdout.startswith("lubrication regime\n")


def test_an_unknown_term_points_to_the_list() -> None:
    done = run("explain", "zzz", cwd=ROOT)
    assert done.returncode == 2
    assert done.stderr == "hersey: 'zzz' is not in the glossary; type hersey explain to list all terms\n"


def test_a_term_and_all_terms_as_json() -> None:
    (one,) = json.loads(run("explain", "stick", "speed", "--json", cwd=ROOT).stdout)["terms"]
    assert one["term"] == "stick speed"
    assert "v_s" in one["also"]
    assert one["see"] == ["closure", "V*"]
    every = json.loads(run("explain", "--json", cwd=ROOT).stdout)
    assert [each["term"] for each in every["terms"]] == [each.term for each in entries()]
    assert one in every["terms"]
    assert every["command"] == "hersey explain --json"
    assert run("explain", "zzz", "--json", cwd=ROOT).returncode == 2
