"""Activation energies: values by hand, errors by a numerical delta method, p-values from Student's t."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from hersey.damping.candidates import Candidate, compare_models
from hersey.damping.candidates.branched import FREE, HELD, ONE, Law
from hersey.damping.candidates.energy import CALORIE, activation_energies, scaled, usable_for_transition
from hersey.damping.candidates.fitting import LawFit, fit_law
from hersey.damping.candidates.stribeck import StribeckLaw
from hersey.damping.candidates.thermal import ARRHENIUS, CELSIUS, VFT, Thermal
from hersey.damping.estimate import rounded
from tests.damping.candidates.cases import hand_fit, some_covariance
from tests.damping.candidates.test_comparison import REFERENCE, TEMPERATURES, dwells

R = 8.31446261815324
UNIT = R * REFERENCE
HELD_LAW = Law(Thermal(ARRHENIUS, REFERENCE), HELD)
FREE_LAW = Law(Thermal(ARRHENIUS, REFERENCE), FREE)
HELD_VALUES, FREE_VALUES = [0.1, 2.8, -0.6, -1.2, -0.9], [0.1, 2.7, -0.62, -1.2, -0.9, -6.5]
DATA = dwells(HELD_LAW, HELD_VALUES)


def delta(fit: LawFit, of: Callable[[dict[str, float]], float]) -> float:
    """Standard error of a function of the values, its slopes by central differences."""
    slopes = []
    for index in range(fit.values.size):
        ends = []
        for side in (-1, 1):
            moved = fit.values.copy()
            moved[index] += side * 1e-5
            ends.append(of(dict(zip(fit.law.names, moved.tolist(), strict=True))))
        slopes.append((ends[1] - ends[0]) / 2e-5)
    return float(np.sqrt(np.array(slopes) @ fit.covariance @ np.array(slopes)))


def test_energies_of_torque_and_its_power() -> None:
    best = hand_fit(HELD_LAW, HELD_VALUES)
    found = activation_energies(best, None, best, DATA)
    reach = stats.t.ppf(0.975, 15)
    error = np.sqrt(best.covariance[1, 1]) * UNIT
    assert found.torque is not None
    assert found.power is not None
    expected = (2.8 * UNIT, error, 2.8 * UNIT - reach * error, 2.8 * UNIT + reach * error)
    torque = found.torque
    assert (torque.value, torque.error, torque.low, torque.high) == pytest.approx(expected, rel=1e-10)
    error = np.sqrt(best.covariance[2, 2])
    expected = (0.4, error, 0.4 - reach * error, 0.4 + reach * error)
    power = found.power
    assert (power.value, power.error, power.low, power.high) == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("scale", [0.02, 0.1])
def test_energy_of_viscosity_by_the_delta_method(scale: float) -> None:
    best = hand_fit(HELD_LAW, HELD_VALUES, covariance=some_covariance(5, scale))
    found = activation_energies(best, None, best, DATA).viscosity
    assert found is not None
    error = delta(best, lambda v: UNIT * v["e"] / (1 + v["c"]))
    value, reach = UNIT * 2.8 / 0.4, stats.t.ppf(0.975, 15) * error
    assert found.value == pytest.approx(value, rel=1e-12)
    assert found.error == pytest.approx(error, rel=1e-6)
    # symmetric in the logarithm
    assert found.low == pytest.approx(value * np.exp(-reach / value), rel=1e-6)
    assert found.high == pytest.approx(value * np.exp(reach / value), rel=1e-6)


@pytest.mark.parametrize("errors", [1.99, 2.01])
def test_an_energy_within_two_errors_of_zero_has_a_plain_interval(errors: float) -> None:
    covariance = np.diag([1e-4, 1e-2, 0.0, 1e-4, 1e-4])
    values = [0.1, 0.1 * errors, -0.6, -1.2, -0.9]
    best = hand_fit(HELD_LAW, values, covariance=covariance)
    found = activation_energies(best, None, best, DATA).viscosity
    assert found is not None
    value, reach = errors * 0.1 * UNIT / 0.4, stats.t.ppf(0.975, 15) * 0.1 * UNIT / 0.4
    plain = errors < 2.0
    assert found.low == pytest.approx(value - reach if plain else value * np.exp(-reach / value), rel=1e-9)
    assert found.high == pytest.approx(value + reach if plain else value * np.exp(reach / value), rel=1e-9)


@pytest.mark.parametrize("d", [-6.5, -7.3, -9.0])
def test_the_transition_s_energy_against_that_of_viscosity(d: float) -> None:
    best, free = hand_fit(HELD_LAW, HELD_VALUES), hand_fit(FREE_LAW, [*FREE_VALUES[:-1], d])
    found = activation_energies(best, free, best, DATA)
    assert found.transition is not None
    error = UNIT * np.sqrt(free.covariance[5, 5])
    reach = stats.t.ppf(0.975, 14) * error
    expected = (-d * UNIT, error, -d * UNIT - reach, -d * UNIT + reach)
    moved = found.transition
    assert (moved.value, moved.error, moved.low, moved.high) == pytest.approx(expected, rel=1e-10)
    apart = d + 2.7 / 0.38
    wrong = delta(free, lambda v: v["d"] + v["e"] / (1 + v["c"]))
    p = float(2 * stats.t.sf(abs(apart) / wrong, 14))
    assert found.p_value == pytest.approx(p, rel=1e-5)
    both = f"{-d * UNIT / 1e3:.3g} and {2.8 / 0.4 * UNIT / 1e3:.3g} kJ/mol, p = {p:.2g}"
    if p < 0.05:
        assert found.verdict == (
            f"Viscosity's energies from the transition speed and from torque disagree ({both}): the "
            "transition is not at one Hersey number, or the exponent is not that of viscosity."
        )
    else:
        assert found.verdict == (
            f"Viscosity's energies from the transition speed and from torque agree ({both}), as "
            "expected for a fixed Hersey number."
        )
    assert (p < 0.05) is (d == -9.0)


@pytest.mark.parametrize(("p", "word"), [(0.049, "disagree"), (0.051, "agree")])
def test_energies_disagree_below_five_per_cent(p: float, word: str) -> None:
    covariance = np.zeros((6, 6))
    covariance[5, 5] = 0.25
    d = -2.7 / 0.38 + 0.5 * stats.t.isf(p / 2, 14)
    free = hand_fit(FREE_LAW, [*FREE_VALUES[:-1], d], covariance=covariance)
    best = hand_fit(HELD_LAW, HELD_VALUES)
    found = activation_energies(best, free, best, DATA)
    assert found.p_value == pytest.approx(p, rel=1e-9)
    assert f"torque {word} (" in found.verdict


@pytest.mark.parametrize("low", [0.049, 0.051])
def test_torque_that_hardly_depends_on_viscosity_gives_no_energy_of_it(low: float) -> None:
    reach = stats.t.ppf(0.975, 15) * 0.1
    covariance = np.diag([1e-4, 1e-4, 1e-2, 1e-4, 1e-4])
    best = hand_fit(HELD_LAW, [0.1, 2.8, low + reach - 1.0, -1.2, -0.9], covariance=covariance)
    found = activation_energies(best, None, best, DATA)
    assert (found.viscosity is None) is (low < 0.05)
    if found.viscosity is None:
        assert found.verdict == (
            f"The exponent of torque in viscosity, {found.power}, does not exclude 0, so torque gives "
            "no activation energy. Record faster speeds, where torque rises with speed."
        )
    else:
        assert found.verdict == (
            "The log does not show how the transition moves with temperature, so this energy cannot "
            "be checked. Record speeds around the transition at more temperatures."
        )
    assert found.transition is None
    assert found.p_value is None


def test_local_energies_are_those_of_the_law_chosen() -> None:
    best = hand_fit(HELD_LAW, HELD_VALUES)
    heats = (TEMPERATURES[0], REFERENCE, TEMPERATURES[-1])
    power = hand_fit(Law(Thermal(CELSIUS, REFERENCE), ONE), [0.1, -0.9, -0.7])
    local = activation_energies(best, None, power, DATA).local
    assert [t for t, _ in local] == pytest.approx(heats)
    assert [e for _, e in local] == pytest.approx([0.9 * R * t**2 / (t - 273.15) for t in heats], rel=1e-12)
    pole = hand_fit(Law(Thermal(VFT, REFERENCE), ONE), [0.1, 2.8, 0.005, -0.7])
    local = activation_energies(best, None, pole, DATA).local
    by_hand = [2.8 * R * t**2 / (400.0 * (1 + 0.005 * (t - 400.0)) ** 2) for t in heats]
    assert [e for _, e in local] == pytest.approx(by_hand, rel=1e-12)
    for other in (
        hand_fit(Law(None, ONE), [0.1, -0.7]),
        hand_fit(StribeckLaw(Thermal(ARRHENIUS, REFERENCE)), [-1.2, 9.0, -0.2, -2.0, 0.2]),
    ):
        assert activation_energies(best, None, other, DATA).local == ()


def test_there_is_no_energy_without_temperatures() -> None:
    cold = hand_fit(Law(None, ONE), [0.1, -0.7])
    data = dwells(Law(None, ONE), [0.1, -0.7], temperatures=None)
    best = hand_fit(HELD_LAW, HELD_VALUES)
    for found in (
        activation_energies(None, None, cold, DATA),
        activation_energies(best, None, best, data),
        activation_energies(cold, None, cold, DATA),
    ):
        assert found.torque is found.power is found.viscosity is found.transition is found.p_value is None
        assert found.verdict == "No activation energy: the log has fewer than two temperatures."
        assert found.local == ()
        assert found.lines() == [found.verdict]


def test_energies_are_printed_in_kilojoules_and_calories() -> None:
    best, free = hand_fit(HELD_LAW, HELD_VALUES), hand_fit(FREE_LAW, FREE_VALUES)
    found = activation_energies(best, free, best, DATA)
    lines = found.lines()
    assert CALORIE == 4.184
    names = (
        "torque, apparent",
        "viscosity, from torque and its exponent",
        "viscosity, from the transition speed",
    )
    energies = (found.torque, found.viscosity, found.transition)
    for line, name, energy in zip(lines[:3], names, energies, strict=True):
        assert energy is not None
        v, low, high = energy.value, energy.low, energy.high
        assert line == (
            f"{name}: {rounded(v / 1e3, low / 1e3, high / 1e3, 'kJ/mol')} = {v / 4.184:.0f} cal/mol "
            f"[{low / 4.184:.0f}, {high / 4.184:.0f}]"
        )
    assert lines[3:] == [found.verdict]
    half = scaled(found.torque, 0.5)  # type: ignore[arg-type]
    assert found.torque is not None
    assert (half.value, half.error) == (0.5 * found.torque.value, 0.5 * found.torque.error)
    assert (half.low, half.high) == (0.5 * found.torque.low, 0.5 * found.torque.high)


def test_which_laws_carry_a_transition_of_their_own() -> None:
    assert usable_for_transition(hand_fit(FREE_LAW, FREE_VALUES))
    assert not usable_for_transition(hand_fit(HELD_LAW, HELD_VALUES))
    each = Law(Thermal(ARRHENIUS, REFERENCE), FREE, groups=2)
    assert not usable_for_transition(hand_fit(each, [0.1, 2.7, -0.6, -0.7, -1.2, -0.9, -6.5]))
    assert not usable_for_transition(hand_fit(StribeckLaw(None), [-1.2, -0.2, -2.0, 0.2]))


def test_a_law_without_a_transition_has_no_energy_of_one() -> None:
    """Where T in degC is the law, Arrhenius with two branches bends to follow it: that is no transition."""
    straight = dwells(Law(Thermal(CELSIUS, REFERENCE), ONE), [0.1, -0.9, -0.7], scatter=5e-4)
    laws = tuple(Candidate(*law) for law in ((CELSIUS, ONE), (ARRHENIUS, ONE), (ARRHENIUS, FREE)))
    found = compare_models(straight, candidates=laws, bootstrap=0, cross_validate=False)
    assert found.chosen.candidate.key == "power-degC/one"
    assert found.energies.transition is None
    assert found.energies.verdict.startswith("The log does not show how the transition moves")


def test_energies_of_temperatures_visited_once_are_not_held_against_each_other() -> None:
    two = dwells(HELD_LAW, HELD_VALUES, temperatures=TEMPERATURES[::3], scatter=2e-3)
    stood_off = two.log_torque + np.where(two.inputs.group == 1, 0.2, 0.0)
    data = replace(two, log_torque=stood_off, visit=two.inputs.group)
    free = fit_law(FREE_LAW, data)
    found = activation_energies(free, free, free, data)
    assert found.p_value is None
    assert found.viscosity is not None
    assert not found.viscosity.estimable
    assert "cannot be compared" in found.verdict
