"""Whether torque rises or falls is tested on the dwells: exact laws, constant torque, and chance."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.damping.candidates.observations import Observations
from hersey.damping.trend import Trend, _about_one_turn, _freedom, trend_of
from hersey.log.means import read_means

Law = Callable[[np.ndarray], np.ndarray]
LAWS: dict[str, tuple[Law, bool, bool]] = {
    "film": (lambda w: 0.2 * w**0.4, True, False),
    "slow film": (lambda w: 0.2 * w**0.1, True, False),
    "Coulomb and viscous": (lambda w: 0.2 + 0.02 * w, True, False),
    "constant": (lambda w: 0.2 + 0.0 * w, False, False),
    "boundary": (lambda w: 0.2 * w**-0.3, False, True),
    "Stribeck": (lambda w: 0.1 + 0.1 * np.exp(-w / 3.0) + 0.004 * w, True, True),
    "two branches": (lambda w: 0.1 * np.maximum((w / 5.0) ** 0.3, (w / 5.0) ** -0.3), True, True),
}


def _trend(folder: Path, law: Law, seed: int, scatter: float = 0.01) -> Trend:
    rng = np.random.default_rng(seed)
    speeds = np.repeat(np.geomspace(0.5, 50.0, 12), 2)
    torques = law(speeds) * np.exp(scatter * rng.standard_normal(speeds.size))
    rows = [f"{w:.9g},{t:.9g}" for w, t in zip(speeds, torques, strict=True)]
    path = folder / "means.csv"
    path.write_text("\n".join(["Speed [rad/s],Torque [N*m]", *rows]) + "\n")
    return trend_of(Observations.of(hersey.SteadyPoints.from_table(read_means([path], isothermal=True))))


@pytest.mark.parametrize("name", LAWS)
def test_exact_laws_are_called_what_they_are(tmp_path: Path, name: str) -> None:
    law, rises, falls = LAWS[name]
    found = [_trend(tmp_path, law, seed) for seed in range(25)]
    assert sum((each.rises, each.falls) == (rises, falls) for each in found) == 25


def test_a_constant_torque_is_said_with_what_it_leaves_open(tmp_path: Path) -> None:
    found = _trend(tmp_path, LAWS["constant"][0], 1, scatter=0.02)
    assert found.constant
    assert 0.01 < found.spread < 0.06


def test_chance_alone_makes_no_trend(tmp_path: Path) -> None:
    """Of 200 constant torques at most two seem to rise or fall: one in 250 is asked for."""
    found = [_trend(tmp_path, LAWS["constant"][0], 1000 + seed) for seed in range(200)]
    assert sum(not each.constant for each in found) <= 2


def test_the_least_torque_is_where_the_dwells_have_it(tmp_path: Path) -> None:
    found = _trend(tmp_path, LAWS["two branches"][0], 3, scatter=0.003)
    assert found.least == pytest.approx(5.0, rel=0.35)


def test_the_scatter_of_noise_alone_is_told_as_it_is() -> None:
    """Squares about the best curve over the degrees of freedom of `trend`: one, for noise of one."""
    rng = np.random.default_rng(6)
    for size in (8, 11, 15):
        squares = [_about_one_turn(rng.standard_normal(size), first_rises=False) for _ in range(300)]
        assert np.mean(squares) == pytest.approx(_freedom(size), rel=0.15)


def test_a_hump_rises_and_falls(tmp_path: Path) -> None:
    found = _trend(tmp_path, lambda w: 0.2 * np.exp(-(np.log(w / 5.0) ** 2) / 8.0), 1)
    assert (found.rises, found.falls) == (True, True)


def test_a_few_noisy_dwells_tell_nothing(tmp_path: Path) -> None:
    """Constant torque at 4 to 6 speeds with 10 % scatter: at most one log in 120 seems to rise or to fall."""
    wrong = 0
    for seed in range(120):
        rng = np.random.default_rng(seed)
        speeds = np.geomspace(0.5, 50.0, 4 + seed % 3)
        torques = 0.2 * np.exp(0.1 * rng.standard_normal(speeds.size))
        path = tmp_path / "few.csv"
        rows = [f"{w:.9g},{t:.9g}" for w, t in zip(speeds, torques, strict=True)]
        path.write_text("\n".join(["Speed [rad/s],Torque [N*m]", *rows]) + "\n")
        points = hersey.SteadyPoints.from_table(read_means([path], isothermal=True))
        wrong += not trend_of(Observations.of(points)).constant
    assert wrong <= 1
