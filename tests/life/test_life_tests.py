"""The independent life tests: their truth is that of their noiseless torque, and how answers are counted."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from benchmarks.life_tests import campaign, films, modes, product, score, slips, tables

import hersey


@pytest.mark.parametrize("seed", [3, 7])
def test_a_limit_is_reached_at_the_true_age(seed: int) -> None:
    one = campaign.draw(seed)
    limits = one.use.limits(one.drive.film != "flooded")
    for unit in range(len(one.units)):
        own = {name: values[unit : unit + 1] for name, values in one.specimens.items()}
        for name in (modes.COLD_FAST, modes.HOT_SLOW, modes.STICK_SLOW):
            age = one.failures[name][unit]
            if np.isfinite(age):
                state = one.mechanism.state(own, np.array([[age / one.life]]))
                value = modes.indicators(one.drive, one.use, state)[name][0, 0]
                assert value == pytest.approx(limits[name], rel=0.02)


def test_hersey_reads_the_states_that_the_truth_is_stated_at(tmp_path: Path) -> None:
    one = campaign.draw(3)
    quiet = replace(one.stand, repeatability=1e-4, gain=0.0, mounting=0.0, spreading=0.0)
    one = replace(one, stand=quiet, ages=one.ages[:2])
    tables.write(one, tmp_path)
    truth = json.loads((tmp_path / "truth.json").read_text())["units"]
    machine = hersey.read_machine(tmp_path / "machine.toml")
    with hersey.Campaign.open(product.campaign_file(tmp_path), write=False) as runs:
        found = {each.name: each for each in hersey.indicators_of(runs, machine, signs=False).each}
    for name, close in ((modes.COLD_FAST, 0.005), (modes.HOT_SLOW, 0.01), (modes.STICK_SLOW, 0.06)):
        assert found[name].value == pytest.approx(
            [value for unit in truth for value in unit["runs"][name]], rel=close
        )


def test_a_starved_film_is_its_layer_and_a_thick_layer_floods() -> None:
    for film in (films.tanh, films.reynolds):
        ratio = film(np.array([0.02, 0.5, 1.0, 5.0]))
        assert ratio[0] == pytest.approx(0.02, rel=0.12)
        assert ratio[3] == pytest.approx(1, abs=0.01)
        assert np.all(np.diff(ratio) > 0)


@pytest.mark.parametrize(
    ("low", "high", "never", "truth", "place"),
    [
        (10.0, 20.0, 0.0, 15.0, "held"),
        (10.0, 20.0, 0.0, 9.0, "below"),
        (10.0, 20.0, 0.0, 21.0, "above"),
        (10.0, None, 0.3, 21.0, "held"),
        (10.0, 20.0, 0.0, None, "above"),
        (10.0, None, 0.3, None, "held"),
        (None, None, 1.0, 15.0, "below"),
    ],
)
def test_where_the_truth_is(low: float, high: float, never: float, truth: float, place: str) -> None:
    assert score.place({"age": {"low": low, "high": high}, "never": never}, truth, 100.0) == place


def test_a_mistake_is_named_by_kind_specimen_and_age() -> None:
    slip = {"kind": "swapped logs", "units": ["U1", "U2"], "ages": [5000, 5200], "factor": 1.0}
    (kind,) = slips.KINDS["swapped logs"]

    def said(**values: object) -> bool:
        return slips.named({"slip": slip, "said": {"warnings": [{"kind": kind, "values": values}]}})

    assert said(specimens="U1, U2", ages="5000, 5200")
    assert said(first="U1", second="U2", ages=[5000.0, 5200.0])
    assert not said(specimens="U1, U3", ages="5000, 5200")
    assert not said(specimens="U1, U2", ages="5000, 5300")


def test_a_factor_is_named_if_it_is_about_right() -> None:
    slip = {"kind": "ages of a specimen too small", "units": ["U1"], "ages": [], "factor": 1000.0}

    def said(factor: float) -> bool:
        warning = {"kind": "ages scaled", "values": {"unit": "U1", "factor": factor}}
        return slips.named({"slip": slip, "said": {"warnings": [warning]}})

    assert said(0.0012)
    assert not said(0.0001)
    assert not said(1000.0)
