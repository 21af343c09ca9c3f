"""The layer of oil of runs, its law over ages, and when specimens starve: held against known truth."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import polars as pl
import pytest
from scipy.special import logit

from hersey.arrays import FloatArray
from hersey.errors import InsufficientDataError, ParameterError
from hersey.life.film import layer as layer_module
from hersey.life.film import starved_drag, starving
from hersey.life.film.common_to_runs import Common
from hersey.life.film.filled_dwells import FilledDwells, filled_dwells
from hersey.life.film.layer import LayerFit, Layers, layers
from hersey.life.film.of_runs import starvation_indicator
from hersey.life.film.shares import StarvesAt, _some_runs, by_share, slower_by_share
from hersey.life.film.starved_drag import (
    CONSTANT,
    FREE,
    LAYER,
    ROLLING,
    ROLLING_BY_SHARE,
    VISCOSITY,
    SharedLoad,
    StarvedDrag,
    cubic,
    film_of,
    flooded,
)
from hersey.life.film.through_life import film_life
from hersey.life.indicator import Indicators, Runs
from hersey.life.oil_layer import (
    STARVED,
    starved_layer,
)
from hersey.lubrication.film import film_thickness
from hersey.testbench import population
from hersey.testbench.ageing import Ageing
from hersey.testbench.drive import example_drive
from hersey.testbench.stand import RPM
from hersey.units import ZERO_CELSIUS
from tests.life import shipped

#: Speed (rad/s) and temperature (K) of the cold corner.
COLD = (40.0 / 3.0, 60.0 + ZERO_CELSIUS)
AGES = np.array([0.0, 60e3, 120e3, 170e3])


def grid() -> tuple[FloatArray, FloatArray]:
    """Speeds and temperatures of a stand, fewer than the shipped ones."""
    speeds = np.array([7.0, 14.0, 30.0, 65.0, 140.0, 140.0, 65.0, 30.0, 14.0]) * RPM
    heats = np.array([60.0, 90.0, 120.0, 150.0, 180.0]) + ZERO_CELSIUS
    return np.tile(speeds, heats.size), np.repeat(heats, speeds.size)


def read(ageing: Ageing, seed: int) -> tuple[Layers, FloatArray]:
    """What runs of fresh specimens tell, and ln of their layer over the flooded film at the cold corner."""
    machine, rest = example_drive()
    speed, kelvin = grid()
    random = np.random.default_rng(seed)
    torque, error, truth = [], [], []
    for unit in population(machine, rest, ageing=ageing, units=6, seed=seed):
        for age in AGES:
            aged = unit.at(float(age))
            whole = aged.torque(speed, kelvin - ZERO_CELSIUS)
            error.append(0.01 * whole)
            torque.append(whole + error[-1] * random.standard_normal(whole.size) - rest.torque(speed))
            share = aged.starvation(np.array(COLD[0]), np.array(COLD[1] - ZERO_CELSIUS))
            truth.append(np.inf if aged.supply is None else -np.log(share**-3 - 1.0) / 3.0)
    rows = [np.tile(each, (len(torque), 1)) for each in (speed, kelvin)]
    given = np.array(error) < 0.01
    dwells = FilledDwells(rows[0], rows[1], np.array(torque), np.array(error), given)
    return layers(dwells, machine, speed=COLD[0], kelvin=COLD[1]), np.array(truth)


def test_the_law_is_that_of_the_film_with_this_supply() -> None:
    contact, lubricant = film_of(shipped.machine())
    speed, kelvin = (each[None] for each in grid())
    reference = flooded(contact, lubricant, np.array([[COLD[0]]]), np.array([[COLD[1]]]))
    film = flooded(contact, lubricant, speed, kelvin)
    drag = StarvedDrag(speed, 0.0 * kelvin, film, reference, 0.0, None, None)
    free = np.zeros((1, FREE))
    free[0, ROLLING_BY_SHARE] = 3.0
    supply = 6e-6
    free[0, LAYER] = np.log(supply) - cubic(reference.film, np.zeros(()))[0].item()
    expected = film_thickness(contact, lubricant, speed=speed, temperature=kelvin, supply=supply).torque
    assert drag.torque(free)[0] == pytest.approx(expected, rel=8e-3)  # heat in the inlet
    # Thicker oil: as much faster, the same layer.
    free[0, VISCOSITY], free[0, LAYER] = np.log(1.3), free[0, LAYER] - 0.6 * np.log(1.3)
    faster = film_thickness(contact, lubricant, speed=1.3 * speed, temperature=kelvin, supply=supply).torque
    assert drag.torque(free)[0] == pytest.approx(faster, rel=8e-3)


def test_slopes_are_those_of_the_torque() -> None:
    machine = shipped.machine()
    contact, lubricant = film_of(machine)
    mixed = machine.mixed
    assert mixed is not None
    speed, kelvin = (each[None] for each in grid())
    reference = flooded(contact, lubricant, np.array([[COLD[0]]]), np.array([[COLD[1]]]))
    film = flooded(contact, lubricant, speed, kelvin)
    thick = np.log(5e-6)
    faces = SharedLoad.of(mixed, 390.0)
    drag = StarvedDrag(speed, kelvin - 390.0, film, reference, thick, contact.roughness, faces)
    free = np.array([[0.3, 0.01, 1e-3, 1e-5, 0.2, 0.1, 0.1, 0.1, 0.2, -0.3, 2.2, 0.04, 0.4, -0.5]])
    slopes = drag.torque(free)[1]
    for k in range(FREE):
        step = 1e-6 * np.eye(FREE)[k]
        numeric = (drag.torque(free + step)[0] - drag.torque(free - step)[0]) / 2e-6
        assert slopes[:, k] == pytest.approx(numeric, rel=1e-5, abs=1e-8)


def test_intervals_of_the_layer_hold_the_truth() -> None:
    held = []
    for seed in (31, 32):
        told, truth = read(Ageing(), seed)
        _, low, high = told.interval()
        held += list((low <= truth) & (truth <= high))
        assert np.abs(np.median(told.best - truth)) < 0.05
    assert 0.83 <= np.mean(held) <= 1.0


def test_a_flooded_unit_is_not_called_starved() -> None:
    told, _ = read(Ageing(supply=None, side_flow=0.0, evaporation=0.0), 33)
    _, low, high = told.interval()
    assert np.mean(high < 0.0) <= 0.02
    assert np.mean(np.isinf(high)) > 0.85
    assert np.all(np.isfinite(low))  # of its layer a lower bound is told


def test_a_wrong_viscosity_of_the_file_is_not_starvation() -> None:
    """The ratio of layer to flooded film stays; only the level moves."""
    lubricant = shipped.machine().lubricant
    assert lubricant is not None
    campaign = shipped.campaign(1)
    runs = Runs.of(campaign)
    dwells, _ = filled_dwells(campaign, runs)
    off = replace(
        shipped.machine(),
        lubricant=replace(
            lubricant, points=tuple((kelvin, 1.2 * value) for kelvin, value in lubricant.points)
        ),
    )
    right = layers(dwells, shipped.machine(), speed=COLD[0], kelvin=COLD[1])
    wrong = layers(dwells, off, speed=COLD[0], kelvin=COLD[1])
    assert wrong.interval()[0] == pytest.approx(right.interval()[0], abs=0.04)
    level = [np.interp(each.best[0], each.place[0], each.viscosity[0]) for each in (wrong, right)]
    assert level[0] - level[1] == pytest.approx(-np.log(1.2), abs=0.06)


def test_the_shipped_units_starve_when_they_do() -> None:
    film = shipped.film()
    misses = 0
    for told, unit in zip(film.starves[0].units, shipped.truth(), strict=True):
        age = unit["ends"]["starvation"]
        misses += not told.age.low <= age <= told.age.high
        # The drag that does not follow the film is 5 % of it, and may be 40 %.
        assert told.age.value == pytest.approx(age, rel=0.2)
        assert told.age.high < 2.0 * told.age.low
    assert misses <= 1
    supply = [run["supply"] for unit in shipped.truth() for run in unit["runs"]]
    held = (film.layer.low <= supply) & (supply <= film.layer.high)
    assert 0.83 <= held.mean() <= 1.0
    over = [run["film over flooded, hot and fast"] for unit in shipped.truth() for run in unit["runs"]]
    held = (film.film[0].low - 2e-3 <= over) & (over <= film.film[0].high + 2e-3)
    assert held.mean() >= 0.85
    assert [film.runs.unit[i] for i in np.flatnonzero(film.starved())] == ["U4"]
    assert "1 of 8 specimens starve" in film.headline()


def test_what_a_result_says() -> None:
    film = shipped.film()
    text = film.summary()
    assert re.search(r"U4 at 170000 pages: 0\.[567]", text)
    assert "the cold corner (127.3 rpm, 60 degC)" in text
    assert f"starved below {STARVED:.2f}" in text
    oil = film.oil[3]
    assert oil.new.value > oil.last.value
    assert oil.last.value == pytest.approx(oil.needed.value, rel=0.3)  # it starves at about that age
    volume = 20e-6 * film.track * 0.22
    assert oil.new.low < volume < oil.new.high * film.systematic


def test_more_drag_beside_the_film_means_that_specimens_starve_sooner() -> None:
    """Of the shipped specimens 5 % does not follow the film; the dwells cannot exclude more."""
    film = shipped.film()
    drag = film.other_drag
    assert drag.computed == pytest.approx(0.0466, abs=1e-3)
    assert drag.low < 0.05 < drag.high <= 0.45
    assert [each.share for each in drag.starves] == [0.05, 0.2, 0.3, 0.4]
    ages = [each.median for each in drag.starves]
    assert ages == sorted(ages, reverse=True)
    assert drag.sooner
    told = film.warnings[-1]
    assert told.kind == "other drag"
    assert told.values["direction"] == "sooner"
    assert (told.values["least"], told.values["most"]) == (0.05, 0.4)
    assert "With more such drag specimens starve sooner" in told.sentence
    assert "log a specimen flooded with fresh lubricant" in told.sentence
    assert told in film.with_starvation(Indicators(film.runs, ())).each[0].warnings
    assert f"{drag.starves[0].shown} pages at 5%" in film.summary()
    assert film.to_dict()["other_drag"]["starves"][3]["median"] == ages[3]


def fitted(share: float, **common: float) -> tuple[LayerFit, FloatArray]:
    """Dwells of six runs of a drive a share of whose drag does not follow the film, and their layers."""
    machine, _ = example_drive()
    speed, kelvin = (np.tile(each, (6, 1)) for each in grid())
    given = np.ones(speed.shape, dtype=bool)
    bare = FilledDwells(speed, kelvin, np.ones(speed.shape), np.full(speed.shape, 1e-3), given)
    fit = LayerFit.of(bare, machine, speed=COLD[0], kelvin=COLD[1], other=(COLD[0], 453.15))
    search = fit._search(slice(None), Common.beforehand(0.1, 0.0))
    free = search.start(0.0)
    free[:, LAYER] = np.linspace(-2.0, 1.0, 6)
    free[:, ROLLING] = logit(share) - logit(fit.computed_share)
    free[:, CONSTANT] = 0.1
    for name, value in common.items():
        free[:, getattr(starved_drag, name)] = value
    torque = search.drag.torque(free)[0]
    return replace(fit, dwells=replace(bare, torque=torque, error=0.01 * torque)), free[:, LAYER]


def test_a_film_that_starves_all_at_once_is_told() -> None:
    """All the oil before a wide nip passes: g = 12, far from the usual 3."""
    fit, layer = fitted(0.2, SHARPNESS=np.log(4.0), FADING=0.0)
    precise = replace(fit, dwells=replace(fit.dwells, error=0.003 * fit.dwells.torque))
    found = precise.layers(precise.together(0.2).common)
    assert 7.0 < found.sharpness < 13.0
    assert found.starved_at == pytest.approx(starved_layer(12.0, 0.0), abs=0.03)
    assert found.best[:4] == pytest.approx(layer[:4], abs=0.15)


def test_the_share_is_learned_where_the_dwells_show_it() -> None:
    """Dwells of a drive 40 % of whose drag goes with seals, which no film takes away."""
    fit, layer = fitted(0.4, ROLLING_BY_SHARE=0.5)
    names, young = [f"U{k}" for k in range(6)], np.ones(6, dtype=bool)
    found = by_share(fit, names, young)
    assert int(np.argmax(found.weight)) == 3
    assert found.weight[0] < 0.02
    assert found.likeliest.best[:5] == pytest.approx(layer[:5], abs=0.05)
    # New lubricant as on its data sheet makes a share less likely that needs another.
    aged = by_share(fit, names, ~young)
    off = [np.median(each.likeliest_viscosity()[0]) for each in found.layers]
    error = [np.median(each.likeliest_viscosity()[1]) for each in found.layers]
    odds = aged.weight * np.exp(-0.5 * np.square(off) / (fit.level**2 + np.square(error)))
    assert found.weight == pytest.approx(odds / odds.sum(), rel=1e-6)
    assert abs(off[3]) < 0.05 < 0.2 < abs(off[0])


@pytest.mark.parametrize(("stated", "nip"), [(0.2, 0.1), (0.02, None)])
def test_how_well_torque_shows_new_lubricant(stated: float, nip: float | None) -> None:
    """Viscosity, and 15 % of the film and the nip over the power of torque; 10 % of a nip is not stated."""
    bare, _ = example_drive()
    assert bare.contact is not None
    assert bare.lubricant is not None
    contact = replace(bare.contact, nip_uncertainty=nip)
    machine = replace(bare, contact=contact, lubricant=replace(bare.lubricant, uncertainty=stated))
    speed, kelvin = (each[None] for each in grid())
    dwells = FilledDwells(speed, kelvin, speed, speed, np.ones(speed.shape, dtype=bool))
    fit = LayerFit.of(dwells, machine, speed=COLD[0], kelvin=COLD[1])
    up, down = (cubic(fit.other.shear, np.asarray(step))[0].item() for step in (1e-4, -1e-4))
    of_torque = np.hypot(0.15, np.log(1.1) / 1.96) / ((up - down) / 2e-4)
    assert fit.level == pytest.approx(np.hypot(np.log(1.0 + stated) / 1.96, of_torque), rel=1e-5)


def test_of_many_specimens_some_are_followed_at_each_share() -> None:
    """The ages of all are those of the likeliest share, times what other shares make of the few."""
    units = [f"U{k}" for k in range(100) for _ in range(6)]
    some = _some_runs(units)
    assert some.size == 34 * 6
    assert some.tolist()[:7] == [0, 1, 2, 3, 4, 5, 18]
    starves = [StarvesAt(0.05, 1.0, 4.0), StarvesAt(0.2, 1.0, 2.0), StarvesAt(0.3, 1.0, np.inf)]
    slower = slower_by_share(starves, np.array([0.3, 0.6, 0.1]), 1000, 0)
    assert sorted(set(slower)) == [1.0, 2.0]
    assert np.mean(slower == 2.0) == pytest.approx(0.3, abs=0.05)


def test_faces_that_may_touch_hide_that_a_film_starves() -> None:
    machine = shipped.machine()
    assert machine.contact is not None
    rough = replace(machine, asperities=None, boundary=None, contact=replace(machine.contact, roughness=1e-6))
    with pytest.raises(InsufficientDataError, match=r"3\.9 times the roughness.*Add \[asperities\]"):
        film_life(shipped.campaign(1), rough)


def test_starvation_is_an_indicator() -> None:
    film = shipped.film()
    none = Indicators(film.runs, ())
    (told,) = film.with_starvation(none).each
    assert told.kind == "starvation"
    assert told.limit == 1.0
    assert told.value[23] > 1.0  # U4 at 170,000 pages
    assert np.nanmax(told.value[:18]) < 1.0
    with pytest.raises(ParameterError, match="different runs"):
        film.with_starvation(Indicators(Runs((1,), ("A",), np.zeros(1), "h"), ()))


def test_a_flooded_run_tells_no_indicator() -> None:
    campaign = shipped.campaign(1)
    hot = campaign.dwells().filter(campaign.dwells()["temperature (K)"] > 420.0)
    campaign.dwells = lambda: hot  # type: ignore[method-assign]
    told = starvation_indicator(campaign, shipped.machine())
    assert np.isnan(told.value).any()


def test_bad_input_is_told() -> None:
    campaign, machine = shipped.campaign(1), shipped.machine()
    with pytest.raises(ParameterError, match=r"\[contact\] and \[lubricant\]"):
        film_life(campaign, replace(machine, contact=None))
    with pytest.raises(ParameterError, match="evaporation is -1"):
        film_life(campaign, machine, evaporation=-1.0)
    with pytest.raises(ParameterError, match="track is 0 m"):
        film_life(campaign, machine, track=0.0)
    cold = campaign.dwells().with_columns(campaign.dwells()["temperature (K)"] * float("nan"))
    campaign.dwells = lambda: cold  # type: ignore[method-assign]
    with pytest.raises(InsufficientDataError, match="temperature"):
        film_life(campaign, machine)


def test_given_numbers_of_the_law_are_kept() -> None:
    film = film_life(shipped.campaign(2), shipped.machine(), side_flow=2e4, evaporation=1e-6)
    assert film.law["K"].value == pytest.approx(2e4)
    assert film.law["e"].low == pytest.approx(1e-6)


@pytest.mark.parametrize(
    ("kept", "said"),
    [
        (pl.col("temperature (K)") < 335.0, "At one temperature, a thin oil layer looks like"),
        (pl.col("run_id") == 1, "no specimen was measured at two ages"),
    ],
)
def test_what_the_dwells_do_not_tell_is_said(kept: pl.Expr, said: str) -> None:
    whole = shipped.campaign(2)
    runs, dwells = whole.runs(), whole.dwells().filter(kept)
    some = shipped.Campaign(path=whole.path, age_unit="pages", runs=lambda: runs, dwells=lambda: dwells)
    with pytest.raises(InsufficientDataError, match=said):
        film_life(some, shipped.machine())  # type: ignore[arg-type]


def test_a_film_that_is_not_that_of_the_file_is_not_told() -> None:
    whole = shipped.campaign(1)
    runs, dwells = whole.runs(), whole.dwells()
    slow = dwells.with_columns(pl.col("torque (N m)") * (1.0 + 5.0 * (pl.col("speed (rad/s)") > 5.0)))
    some = shipped.Campaign(path=whole.path, age_unit="pages", runs=lambda: runs, dwells=lambda: slow)
    with pytest.raises(InsufficientDataError, match="differ from the machine file"):
        film_life(some, shipped.machine())  # type: ignore[arg-type]


def test_what_the_law_itself_may_be_off_moves_all_ages(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without it intervals are those of the dwells alone, and narrower."""
    told = shipped.film(1).starves[0].units[0].age
    monkeypatch.setattr(starving, "_LAW", 0.0)
    bare = film_life(shipped.campaign(1), shipped.machine()).starves[0].units[0].age
    assert told.high - told.low > 1.05 * (bare.high - bare.low)
    assert told.value == pytest.approx(bare.value, rel=0.02)


@pytest.mark.parametrize(("stated", "share"), [(0.02, 0.02), (0.3, 0.3), (None, 0.2)])
def test_how_well_the_viscosity_is_known_beforehand(
    stated: float | None, share: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Between two points each within a share (95 %): sqrt(2) ln(1 + share)/1.96, a fifth if not stated."""

    class ToldError(Exception):
        pass

    def told(_searches: object, beforehand: Any) -> None:
        raise ToldError(beforehand.covariance)

    monkeypatch.setattr(layer_module, "fitted_together", told)
    bare, _ = example_drive()
    assert bare.lubricant is not None
    machine = replace(bare, lubricant=replace(bare.lubricant, uncertainty=stated))
    speed, kelvin = (each[None] for each in grid())
    torque = 0.1 * np.ones_like(speed)
    dwells = FilledDwells(speed, kelvin, torque, 0.01 * torque, np.ones(speed.shape, dtype=bool))
    with pytest.raises(ToldError) as known:
        layers(dwells, machine, speed=COLD[0], kelvin=COLD[1])
    deviation = np.sqrt(known.value.args[0][0, 0])
    assert deviation == pytest.approx(np.sqrt(2.0) * np.log(1.0 + share) / 1.96, rel=1e-9)
