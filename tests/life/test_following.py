"""A life test followed to one answer and one page: the shipped campaign."""

from __future__ import annotations

import warnings
from functools import cache
from pathlib import Path

import pytest

import hersey
from hersey.errors import InsufficientDataError, ParameterError
from hersey.life import following
from hersey.life.ageing_maps import ageing_maps
from hersey.life.following import follow
from hersey.report.life_page import render_life
from tests.life import shipped


def answer() -> hersey.LifeTest:
    return shipped.followed(2)


def test_the_answer_holds_all_parts() -> None:
    found = answer()
    kinds = {mode.kind for mode in found.time_to_failure.modes}
    assert {"motor torque", "stick-slip", "starvation"} <= kinds
    assert found.drift is not None
    assert found.film is not None
    assert found.maps is not None
    assert found.maps.unit == "U1"  # the first to end
    text = found.summary()
    assert text.startswith(found.headline())
    assert "continuous_torque" in text  # what is not judged, and which key would


def test_both_units_end_by_the_torque_of_the_motor() -> None:
    """Truth: 239,000 and 305,000 pages, cold and fast; starvation follows 14 % later."""
    for end, truth in zip(answer().time_to_failure.units, (239e3, 305e3), strict=True):
        assert "motor torque, cold and fast" in end.named
        assert end.age.age.value == pytest.approx(truth, rel=0.15)


def bare() -> hersey.Machine:
    """A machine of which little is known."""
    limits = hersey.Limits(motor_torque=1.0)
    return hersey.Machine(stiffness=11e3, mass=11.0, roll_radius=15e-3, stick_speed=3e-3, limits=limits)


def followed() -> hersey.LifeTest:
    with shipped.few():
        return follow(shipped.opened(1), bare())


@cache
def little() -> hersey.LifeTest:
    return followed()


def test_the_same_seed_gives_the_same_bits() -> None:
    assert followed().to_dict() == little().to_dict()


def test_what_is_not_known_is_said() -> None:
    found = little()
    assert found.film is None
    assert ("not computed", "film through life") in [(each.kind, each.where) for each in found.warnings]
    assert "one specimen does not show how specimens differ" in found.summary()
    assert found.headline().startswith("No specimen needs attention. U1 should reach at least ")
    assert found.time_to_failure.of_new() == ""  # one specimen is no population
    with pytest.raises(InsufficientDataError, match="no failure mode can be judged"):
        follow(shipped.opened(1), hersey.Machine(11e3, 11.0, 15e-3, 3e-3))


@pytest.mark.parametrize("radius", ["", "[contact]"])
def test_without_a_drivetrain_it_does_what_it_can(radius: str, tmp_path: Path) -> None:
    """Torque limits need nothing else; a radius in [contact] leads to the operating points, too."""
    file = tmp_path / "machine.toml"
    text = '[limits]\nmotor_torque = "1 N*m"\n[[points]]\nspeed = "200 mm/s"\ntemperature = "180 degC"\n'
    if radius:
        text += '[contact]\nroll_radius = "15 mm"\nrubber_thickness = "3.5 mm"\nmodulus = "0.65 MPa"\n'
        text += 'poisson_ratio = 0.48\nlength = "220 mm"\nload = "300 N"\n'
    file.write_text(text)
    with pytest.raises(ParameterError, match=r"table \[drivetrain\] is missing"):
        hersey.read_machine(file)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        machine = hersey.read_machine(file, drivetrain=False)
    assert not machine.has_drivetrain
    with shipped.few():
        found = follow(shipped.opened(1), machine)
    kinds = {mode.kind for mode in found.time_to_failure.modes}
    assert kinds == {"motor torque", "stick-slip"} if radius else {"motor torque"}
    lacking = {each.where for each in found.time_to_failure.warnings if "drivetrain" in each.text}
    assert lacking == {"stick-slip from rest" if radius else "stick-slip at a used operating point"}
    assert "the machine file has no [drivetrain]" in found.summary()
    assert found.maps is None


def test_runs_that_do_not_fit_enter_neither_drift_nor_maps() -> None:
    campaign = shipped.opened(2)
    runs, dwells = campaign.runs(), campaign.dwells()
    assert following._dwells(campaign, []).equals(dwells)
    campaign.dwells().drop_in_place("run_id")  # what is done to it is not done to the next
    assert campaign.dwells().equals(dwells)
    kept = following._dwells(campaign, [0, 2])
    assert set(kept["run_id"]) == set(runs["run"]) - {runs["run"][0], runs["run"][2]}
    found, machine = answer().time_to_failure, shipped.machine()
    with shipped.few():
        maps = ageing_maps(campaign, machine, found, unit="U1", excluded=[0])
    assert maps.ages[0] == runs["age"][1] > runs["age"][0]


def test_the_page_holds_the_answer() -> None:
    runs = shipped.opened(2).runs()
    page = render_life(answer(), runs, "hersey life <life.hersey>")
    assert page.startswith("<!doctype html>")
    assert "\\u003clife.hersey\\u003e" in page
    assert '"Time to failure"' in page
    for name in ("ends", "growth_1", "maps", "film", "drift"):
        assert f'"{name}"' in page


def test_a_specimen_that_is_not_there_is_refused_before_the_work(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(following, "asked_of", lambda *_: pytest.fail("the work began"))
    with pytest.raises(ParameterError, match=r"^unit: .* has no specimen 'X9'\. Specimens: U1, U2$"):
        follow(shipped.opened(2), bare(), unit="X9")
