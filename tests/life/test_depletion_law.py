"""How a layer of oil thins, and the share of the film that it leaves, against their formulas."""

from __future__ import annotations

import inspect
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from hersey import _core
from hersey.arrays import FloatArray, pointwise
from hersey.life.film.depletion_draws import fit_depletion
from hersey.life.film.depletion_law import EVAPORATED, LAYER_NEW, LOSS, POWER, Depletion, Rates, scale
from hersey.life.film.layer import Layers
from hersey.life.film.starved_drag import film_of, flooded
from hersey.life.oil_layer import (
    STARVED,
    USUAL_SHARPNESS,
    age_of_layer,
    log_fading_share,
    log_film_share,
    log_layer,
    log_share_between,
    starved_layer,
)
from hersey.lubrication.film import film_thickness
from hersey.units import ZERO_CELSIUS
from tests.life import shipped

#: Speed (rad/s) and temperature (K) of the cold corner.
COLD = (40.0 / 3.0, 60.0 + ZERO_CELSIUS)


def test_the_layer_follows_its_law() -> None:
    new, side_flow, evaporation = np.array(0.25), np.array(0.3), np.array(0.7)
    ages = np.array([0.0, 0.5, 1.0, 2.0])
    layer = np.exp(log_layer(new, side_flow, evaporation, ages))
    assert layer[0] == pytest.approx(2.0)
    for age, here in zip(ages[1:], layer[1:], strict=True):
        near = np.exp(log_layer(new, side_flow, evaporation, np.array([age - 1e-5, age + 1e-5])))
        assert (near[1] - near[0]) / 2e-5 == pytest.approx(-0.15 * here**3 - 0.7 * here, rel=1e-6)
    assert age_of_layer(new, side_flow, evaporation, np.log(layer)) == pytest.approx(ages)
    for power in (0.5, 2.8):
        slowed = np.exp(log_layer(np.exp(-power * np.log(2.0)), side_flow, evaporation, ages, power))
        near = np.exp(
            log_layer(2.0**-power, side_flow, evaporation, np.array([1.0 - 1e-5, 1.0 + 1e-5]), power)
        )
        loss = 0.3 / power * slowed[2] ** (power + 1.0) + 0.7 * slowed[2]
        assert slowed[0] == pytest.approx(2.0)
        assert (near[0] - near[1]) / 2e-5 == pytest.approx(loss, rel=1e-6)
    nothing = np.zeros(())
    alone = np.exp(log_layer(new, side_flow, nothing, ages))
    assert alone == pytest.approx((0.25 + 0.3 * ages) ** -0.5)
    steady = np.exp(log_layer(new, nothing, evaporation, ages))
    assert steady == pytest.approx(2.0 * np.exp(-0.7 * ages))


def thinned(place: FloatArray, places: FloatArray, deviance: FloatArray) -> Layers:
    """Layers of runs whose oil stays as it is, as dwells at the cold corner show them."""
    contact, lubricant = film_of(shipped.machine())
    ones = np.ones_like(places)
    return Layers(
        place=places,
        deviance=deviance,
        viscosity=0.0 * ones,
        temperature_sensitivity=0.0 * ones,
        viscosity_error=0.01 * ones,
        temperature_sensitivity_error=0.01 * ones,
        best=place,
        scatter=ones[:, 0],
        freedom=30.0 * ones[:, 0],
        used=45.0 * ones[:, 0],
        reference=flooded(contact, lubricant, np.array([[COLD[0]]]), np.array([[COLD[1]]])),
        common=np.zeros(7),
    )


@pytest.mark.parametrize("power", [1.0, 2.0])
def test_the_power_of_side_flow_is_learned(power: float) -> None:
    """Six layers that thin as (1 + p k t)^(-1/p) with k = 4, and what is left at twice the greatest age."""
    random, age = np.random.default_rng(4), np.tile(np.linspace(0.0, 1.0, 7), 6)
    unit = np.repeat(np.arange(6), 7)
    place = 0.6 - np.log1p(power * 4.0 * age) / power + 0.02 * random.standard_normal(age.size)
    steps = np.linspace(-6.0, 6.0, 13)
    layers = thinned(place, place[:, None] + 0.02 * steps, np.tile(steps**2, (age.size, 1)))
    drawn = fit_depletion(layers, unit, age)
    assert np.median(drawn.rate(drawn.mean)["p"]) == pytest.approx(power, rel=0.35)
    new = scale(layers.reference) + 0.6
    layer = np.median(drawn.layer(drawn.specimens, np.array([2.0]))[..., 0] - new, axis=0)
    assert layer == pytest.approx(np.full(6, -np.log1p(power * 8.0) / power), abs=0.2)


@pytest.mark.parametrize("seed", [1, 4])
def test_a_layer_that_was_too_thick_to_be_seen_thins_no_sooner(seed: int) -> None:
    """Six layers that begin 7 times as thick as the flooded film and thin as 1/(1 + 15 t).

    Runs show a layer only once it is below 1.6 of that film. What was lost before does not matter.
    """
    random, age = np.random.default_rng(seed), np.tile(np.linspace(0.0, 1.0, 8), 6)
    place = np.log(7.0 / (1.0 + 15.0 * age)) + 0.05 * random.standard_normal(age.size)
    seen, steps = (place < 0.5)[:, None], np.linspace(-6.0, 6.0, 13)
    places = np.where(seen, place[:, None] + 0.05 * steps, np.linspace(-0.5, 3.0, 13))
    away = np.where(seen, steps, np.minimum(places - 0.5, 0.0) / 0.1)
    layers = thinned(np.minimum(place, 3.0), places, away**2)
    drawn = fit_depletion(layers, np.repeat(np.arange(6), 8), age)
    layer = drawn.layer(drawn.mean, np.array([3.0]))[:, 0] - scale(layers.reference)
    low, middle, high = np.quantile(layer, [0.05, 0.5, 0.95])
    assert low < np.log(7.0 / 46.0) < high
    assert middle == pytest.approx(np.log(7.0 / 46.0), abs=0.2)


def test_the_loss_is_that_of_a_layer_as_thick_as_the_flooded_film() -> None:
    """Of 1 in all, all or half of it by side flow, whatever the layer was when new."""
    ages = np.array([0.0, 1.0, 2.0])
    for new in (0.5, 7.0):
        flows = np.array([np.log(new), 0.0, 0.0, 0.0, -50.0, 0.0])
        assert np.exp(-Rates().layer(flows, ages)) == pytest.approx(1.0 / new + ages)
        both = np.array([np.log(new), 0.0, 0.0, 0.0, 0.0, 0.0])
        left = np.exp(0.5 * ages) * (1.0 / new + 1.0) - 1.0
        assert np.exp(-Rates().layer(both, ages)) == pytest.approx(left)
        assert Rates(side_flow=0.6).of(both) == (pytest.approx(0.3), pytest.approx(1.0))
        assert Rates(evaporation=0.7).of(both) == (pytest.approx(1.0), pytest.approx(0.7))


@pytest.mark.parametrize(
    ("sharpness", "fading"), [(3.0, 0.0), (3.0, 1.0), (1.5, 0.5), (20.0, -0.2), (20.0, 1.2)]
)
def test_the_layer_at_which_a_film_starves(sharpness: float, fading: float) -> None:
    at = starved_layer(sharpness, fading)
    assert np.exp(log_share_between(at, sharpness, fading)[0]) == pytest.approx(STARVED)
    if sharpness == USUAL_SHARPNESS:
        assert at == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("sharpness", [2.0, USUAL_SHARPNESS, 5.0])
def test_the_share_of_the_film_is_that_of_the_core(sharpness: float) -> None:
    ratio = np.geomspace(1e-3, 1e3, 25)
    share, slope = log_film_share(np.log(ratio), sharpness)
    of_core = pointwise(_core.starvation, ratio, 1.0, sharpness).factor
    assert np.exp(share) == pytest.approx(np.asarray(of_core), rel=1e-12)
    up, down = (log_film_share(np.log(ratio) + step, sharpness)[0] for step in (1e-5, -1e-5))
    assert slope == pytest.approx((up - down) / 2e-5, abs=1e-9)


@pytest.mark.parametrize("sharpness", [2.0, 3.0, 5.0])
def test_both_laws_of_starvation_agree_where_the_layer_is_the_film(sharpness: float) -> None:
    place = np.linspace(-3.0, 3.0, 13)
    share, slope = log_fading_share(place, sharpness)
    above, below = (log_fading_share(place + step, sharpness)[0] for step in (1e-6, -1e-6))
    assert slope == pytest.approx((above - below) / 2e-6, abs=1e-8)
    assert share[6] == pytest.approx(log_film_share(place, sharpness)[0][6])
    assert share[0] == pytest.approx(place[0], abs=0.05)
    assert share[-1] == pytest.approx(0.0, abs=1e-6)


def test_the_usual_sharpness_is_that_of_the_film() -> None:
    usual = inspect.signature(film_thickness).parameters["starvation_sharpness"].default
    assert usual == USUAL_SHARPNESS


def test_rates_give_the_loss_of_a_layer_as_thick_as_the_flooded_film() -> None:
    """At that layer ln h falls by the loss of the specimen, and K h0^2 (h/h0)^p/2 + e is that loss."""
    own = np.zeros(10)
    own[[LAYER_NEW, LOSS, EVAPORATED, POWER]] = 0.7, np.log(1.3), -0.4, np.log(0.8)
    ages = np.linspace(0.0, 2.0, 200_001)
    layer = Rates().layer(own, ages)
    at = int(np.argmin(np.abs(layer)))
    assert 0 < at < ages.size - 1
    assert (layer[at + 1] - layer[at - 1]) / (ages[at + 1] - ages[at - 1]) == pytest.approx(-1.3, rel=1e-4)
    contact, lubricant = film_of(shipped.machine())
    point = flooded(contact, lubricant, np.array([COLD[0]]), np.array([COLD[1]]))
    specimens: Any = SimpleNamespace(rates=Rates(), reference=point, greatest_age=5.0)
    rate = Depletion.rate(specimens, own)
    film = float(np.exp(scale(point)).item())
    new = film * np.exp(0.7)
    by_flow = rate["K"].item() * new**2 * (film / new) ** rate["p"].item() / 2.0
    assert by_flow + rate["e"].item() == pytest.approx(1.3 / 5.0)
    assert rate["e"].item() == pytest.approx(1.3 / 5.0 / (1.0 + np.exp(0.4)))
