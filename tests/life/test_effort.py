"""How much work a life test takes, counted and not timed."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import hersey
from hersey.arrays import FloatArray
from hersey.life import other_uses as uses_module
from hersey.life.diagnostics import same_logs
from hersey.life.growth import importance, limit_ages, marginal
from hersey.life.growth.draws import Draws
from hersey.life.growth.laws import LAWS
from hersey.life.growth.limit_ages import Earliest
from hersey.life.growth.marginal import likelihood
from hersey.life.growth.points import points_of
from hersey.life.indicators import load_cases, shared_kernel, torque_surface
from hersey.life.indicators.of_campaign import asked_of
from hersey.life.maintenance import Followed
from hersey.life.other_uses import uses_beside
from hersey.life.time_to_failure import way
from hersey.life.time_to_failure.first import ends_of_specimens
from tests.life import shipped


def test_no_growth_is_fitted_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    """The conditions of the machine file among others: their growths are those of the times to failure."""
    shipped.fewer(monkeypatch)
    monkeypatch.setattr(uses_module, "_LIMITS", (1.0, 1.25))
    monkeypatch.setattr(load_cases, "OTHER_STARTS", (-10.0,))
    machine = replace(shipped.machine(), limits=hersey.Limits(motor_torque=1.0))
    campaign, fits, fit = shipped.opened(2), Counter[bytes](), way.fit_growth
    surfaces, surface = [0], torque_surface.TorqueSurface.__init__

    def counted(unit: Any, age: Any, value: FloatArray, *more: Any, **named: Any) -> Any:
        fits[named["quantity"].encode() + value.tobytes()] += 1
        return fit(unit, age, value, *more, **named)

    def interpolated(self: Any, *given: Any) -> None:
        surfaces[0] += 1
        surface(self, *given)

    monkeypatch.setattr(way, "fit_growth", counted)
    monkeypatch.setattr(torque_surface.TorqueSurface, "__init__", interpolated)
    shared_kernel._kernel_of.cache_clear()
    asked = asked_of(campaign, machine)
    indicators = asked.indicators(machine, signs=False)
    found = hersey.time_to_failure(indicators)
    once, asked_once = fits.total(), surfaces[0]
    uses = uses_beside(found, asked, machine, indicators)
    assert set(fits.values()) == {1}
    assert fits.total() - once == 1  # the motor torque of the colder start
    assert surfaces == [asked_once]  # of the colder start too
    assert shared_kernel._kernel_of.cache_info().misses == 1
    (stated,) = (use for use in uses.uses if use.stated)
    assert [each.age for each in stated.ends] == [each.age.age for each in found.units]


def test_a_place_is_weighed_once_by_each_round(monkeypatch: pytest.MonkeyPatch) -> None:
    places, log_density = [0], importance._Kernels.log_density

    def counted(self: Any, at: FloatArray) -> FloatArray:
        places[0] += len(at)
        return log_density(self, at)

    monkeypatch.setattr(importance._Kernels, "log_density", counted)
    found = importance.importance_sampled(
        lambda spots: -0.5 * (spots**2).sum(axis=1) - np.log(2.0 * np.pi),
        np.zeros(2),
        np.eye(2),
        (200, 200, 300, 300),
        np.random.default_rng(1),
    )
    assert len(found.draws) == 1000
    assert places == [4 * 1000]
    assert found.log_integral == pytest.approx(0.0, abs=0.05)


def test_modes_are_sought_for_many_draws_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of 48 runs 32 draws are held over their nodes, and 13 times as many where a mode takes one number."""
    names = [f"U{i // 6}" for i in range(48)]
    age = np.tile(np.arange(6.0), 8)
    points, _ = points_of(names, tuple(dict.fromkeys(names)), age, 1.0 + 0.1 * age, np.full(48, 0.01))
    steps, step = [0], marginal._step
    stretches, constants = [0], marginal._constants

    def counted(*given: Any) -> Any:
        steps[0] += 1
        return step(*given)

    def of_stretch(*given: Any) -> Any:
        stretches[0] += 1
        return constants(*given)

    monkeypatch.setattr(marginal, "_step", counted)
    monkeypatch.setattr(marginal, "_constants", of_stretch)
    law = next(law for law in LAWS if law.name == "linear")
    middle = np.array([0.0, np.log(0.05), np.log(0.02), -0.7, np.log(0.3)])
    shared = middle + 0.1 * np.random.default_rng(2).standard_normal((1000, 5))
    together = likelihood(law, points, shared, np.zeros(8))
    assert steps[0] <= 3 * (marginal._POLISH + 1)  # of 32 stretches
    assert stretches == [3]  # what is small is computed for all nodes at once
    # where a stretch ends does not depend on the others
    alone = [likelihood(law, points, shared[i : i + 32], np.zeros(8)) for i in range(0, 1000, 32)]
    np.testing.assert_array_equal(np.concatenate(alone), together)


def test_first_ends_are_sought_for_all_specimens_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Random numbers, ranks and quantiles: once for all, not once for each specimen."""
    sorts, quantiles = [0], limit_ages.quantiles

    def counted(values: FloatArray) -> FloatArray:
        sorts[0] += 1
        return quantiles(values)

    monkeypatch.setattr(limit_ages, "quantiles", counted)
    random = np.random.default_rng(4)
    names = [f"F{i}" for i in range(30)]
    last = dict.fromkeys(names, 0.5)
    ways: Any = [_way(name, np.exp(random.standard_normal((50, 30))), last) for name in ("torque", "grip")]
    ends, picks = ends_of_specimens(ways, np.eye(2), names, last, random)
    assert sorts == [1]
    assert [each.unit for each in ends] == names
    for i in (0, 29):  # each draw is used once, and the first end is the least of both
        both = [way.ages[picks.order[m, :, i], i] for m, way in enumerate(ways)]
        assert [sorted(own) for own in both] == [sorted(way.ages[:, i]) for way in ways]
        np.testing.assert_array_equal(np.minimum(*both), picks.first[:, i])
        assert ends[i].first["torque"] == pytest.approx(np.mean(both[0] < both[1]))


def _way(name: str, ages: FloatArray, last: dict[str, float]) -> SimpleNamespace:
    """A failure mode of which ages are drawn."""
    return SimpleNamespace(
        mode=SimpleNamespace(name=name),
        ages=ages,
        order=np.argsort(ages, axis=0),
        earliest=Earliest.unknown(ages.shape[1]),
        followed=Followed.from_new(last),
    )


def test_a_chart_of_growth_computes_the_curves_that_it_draws(monkeypatch: pytest.MonkeyPatch) -> None:
    asked, curves = [], Draws.curves

    def counted(self: Draws, ages: FloatArray, places: Any) -> FloatArray:
        asked.append(len(places))
        return curves(self, ages, places)

    monkeypatch.setattr(Draws, "curves", counted)
    age = np.tile([0.0, 10.0, 20.0], 30)
    growth = hersey.fit_growth(
        [f"F{i // 3}" for i in range(90)], age, 1.0 + 0.02 * age, 0.01, laws=["linear"]
    )
    growth.chart()
    assert asked == [12]  # of 30


def test_logs_that_begin_otherwise_are_not_compared_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    written, text = [0], same_logs._text

    def counted(dwells: FloatArray) -> bytes:
        written[0] += dwells.size
        return text(dwells)

    monkeypatch.setattr(same_logs, "_text", counted)
    torque = np.random.default_rng(1).random(300)
    torque[100:150] = torque[:50]  # the third run is a copy of the first
    of_run = np.repeat(np.arange(6), 50)
    runs: Any = SimpleNamespace(of_run=of_run, number=range(6), speed=np.ones(300), torque=torque)
    assert [slip.runs for slip in same_logs.same_logs(runs)] == [(0, 2)]
    assert written == [6 * 4 + 2 * 100]
