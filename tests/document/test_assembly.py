"""The analysis document: whole, valid, the same each time, and readable back."""

from __future__ import annotations

import json
import math
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.document.analysis import Analysis
from hersey.document.assembly import _timeline, document_of, load
from hersey.errors import ParameterError
from hersey.log.torque_log import LogFile, Run
from hersey.study import study
from hersey.testbench.truth import Truth


def test_it_survives_json(document: Analysis) -> None:
    assert load(document.model_dump_json()).model_dump_json() == document.model_dump_json()


def test_no_number_is_nan(document: Analysis) -> None:
    def walk(value: object) -> None:
        if isinstance(value, float):
            assert math.isfinite(value)
        for item in value.values() if isinstance(value, dict) else value if isinstance(value, list) else []:
            walk(item)

    walk(document.model_dump())


def test_it_holds_the_recipe_of_its_dwells_and_no_path(bench_csv: Path) -> None:
    recipe = hersey.Recipe(logs=(bench_csv,), tare="standing", no_load=bench_csv.parent / "free.csv")
    points = replace(hersey.Recipe(logs=(bench_csv,), tare="standing").points(), recipe=recipe)
    document = document_of(study(points))
    assert document.recipe is not None
    assert document.recipe.settings == {"logs": ["bench.csv"], "tare": "standing", "no_load": "free.csv"}
    assert tomllib.loads(document.recipe.toml) == document.recipe.settings
    assert load(document.model_dump_json()).recipe == document.recipe
    assert str(bench_csv.parent) not in document.model_dump_json()


def test_dwells_without_a_recipe_have_none(document: Analysis) -> None:
    assert document.recipe is None


def test_rows_add_up(document: Analysis) -> None:
    q = document.quality
    assert q.rows_used + q.rows_settling + q.rows_rejected == q.rows == document.files[0].rows


def test_same_input_same_bits(log: hersey.TorqueLog, document: Analysis) -> None:
    again = document_of(study(log.steady(tare="standing")), command=document.command)
    assert again.fit == document.fit
    assert (
        again.model_dump_json()
        == document_of(study(log.steady(tare="standing")), command=document.command).model_dump_json()
    )


def test_the_fit_is_in_the_document(document: Analysis, points: hersey.SteadyPoints) -> None:
    surface = hersey.fit(points)
    assert document.fit.coefficients["c"].value == surface.c.value


def test_the_drag_curves_are_those_of_the_stand(document: Analysis) -> None:
    """Two power laws that meet at the transition, by hand from the truth of the stand."""
    truth = Truth()
    assert sum(law.weight for law in document.fit.laws) == pytest.approx(1.0)
    assert max(document.fit.laws, key=lambda law: law.weight).name == "sharp"
    for curve in document.fit.curves:
        assert curve.temperature is not None
        drag = truth.drag(curve.temperature - 273.15, 0.015, 1e-4)
        speed = np.array(curve.speed)
        exponent = np.where(0.015 * speed < drag.transition_speed, drag.mixed_exponent, drag.ehl_exponent)
        force = drag.transition_force * (0.015 * speed / drag.transition_speed) ** (1.0 + exponent)
        np.testing.assert_allclose(speed * curve.damping, 0.015 * force, rtol=0.03)
    trend = document.fit.trend
    assert trend is not None
    assert (trend.rises, trend.falls) == (True, True)


def test_warnings_name_what_matters(document: Analysis, log: hersey.TorqueLog) -> None:
    kinds = {warning.kind: warning for warning in document.warnings}
    assert kinds["synthetic"].severity == "watch"
    rejected = [each for each in document.quality.rejected if each.kind == "stick-slip"]
    assert kinds["stick-slip"].values == {"count": len(rejected)}
    untared = document_of(study(log.steady()))
    assert any("tare='standing'" in str(w) for w in untared.warnings)
    assert not any("paper's baseline" in str(w) for w in untared.warnings)


def test_the_simulation_is_of_this_machine(document: Analysis) -> None:
    s = document.simulation
    assert s is not None
    stalls = s.title.endswith("the drive slips and does not move it")
    assert s.kind == ("stalled" if stalls else "stick_slip")
    assert s.transition_speed == pytest.approx(0.015 * document.fit.transition_curve[-1].speed, rel=0.03)


def test_without_a_machine_nothing_is_simulated(log: hersey.TorqueLog) -> None:
    """No machine of the paper's stands in the place of the user's."""
    assert document_of(study(log.steady())).simulation is None


def test_foreign_documents_are_refused(document: Analysis) -> None:
    with pytest.raises(ParameterError, match="not an analysis document"):
        load("{}")
    content = json.loads(document.model_dump_json())
    content["schema_version"] = "99"
    with pytest.raises(ParameterError, match="schema_version"):
        load(json.dumps(content))


def test_the_film_of_the_nip_is_part_of_it(document: Analysis) -> None:
    """The verdict names regime and solver; the chart's points are those of the machine and the dwells."""
    part = document.film
    assert part is not None
    assert "isoviscous-elastic" in part.verdict
    assert "A numerical solution" in part.verdict
    assert [point.name for point in part.points] == ["full speed", "thick paper"]
    assert len(part.dwells) == len(document.points)
    assert any(each.kind == "no thickening" for each in part.warnings)


def test_what_does_not_fit_is_told_once_and_the_farthest_off_first(document: Analysis) -> None:
    assert document.film is not None
    found = document.film.warnings
    off = [each for each in found if each.severity != "note"]
    assert off
    assert found[: len(off)] == off
    sizes = [each.values["off"] for each in off]
    assert sizes == sorted(sizes, reverse=True)
    assert len({(each.where, each.text) for each in found}) == len(found)


def test_runs_of_the_timeline_follow_a_sample_apart() -> None:
    """Runs of 0.1 s steps: from 5 to 65 s, 0 to 60 s and 2 to 62 s, each one step after the one before."""
    time = 0.1 * np.arange(601)
    rows = {"torque": np.ones(601), "speed": np.full(601, 5.0), "temperature": None}
    runs = tuple(Run(f"{i}.csv", time + begin, **rows) for i, begin in enumerate((5.0, 0.0, 2.0)))
    files = tuple(LogFile(run.name, "0" * 64, 1, 601, 0, (), ()) for run in runs)
    timeline = _timeline(hersey.TorqueLog(runs, files))
    assert timeline.starts == pytest.approx([-5.0, 60.1, 118.2], abs=1e-9)
    first = [t for t in timeline.torque.time if t <= 60.05]
    assert (first[0], first[-1]) == pytest.approx((0.0, 60.0), abs=1e-9)
    assert timeline.torque.time[len(first)] == pytest.approx(60.1, abs=1e-9)
