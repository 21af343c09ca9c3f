"""How much work a life test takes, counted and not timed."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import hersey
from hersey.arrays import FloatArray
from hersey.life import other_uses as uses_module
from hersey.life.growth import importance, marginal
from hersey.life.growth.laws import LAWS
from hersey.life.growth.marginal import likelihood
from hersey.life.growth.points import points_of
from hersey.life.indicators import load_cases, shared_kernel, torque_surface
from hersey.life.indicators.of_campaign import asked_of
from hersey.life.other_uses import uses_beside
from hersey.life.time_to_failure import way
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

    def counted(*given: Any) -> Any:
        steps[0] += 1
        return step(*given)

    monkeypatch.setattr(marginal, "_step", counted)
    law = next(law for law in LAWS if law.name == "linear")
    middle = np.array([0.0, np.log(0.05), np.log(0.02), -0.7, np.log(0.3)])
    shared = middle + 0.1 * np.random.default_rng(2).standard_normal((1000, 5))
    together = likelihood(law, points, shared, np.zeros(8))
    assert steps[0] <= 3 * (marginal._POLISH + 1)  # of 32 stretches
    # where a stretch ends does not depend on the others
    alone = [likelihood(law, points, shared[i : i + 32], np.zeros(8)) for i in range(0, 1000, 32)]
    np.testing.assert_array_equal(np.concatenate(alone), together)
