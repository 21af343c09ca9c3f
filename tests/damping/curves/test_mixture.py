"""Laws weighed against dwells of a known truth, and how curves go on beyond the dwells."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import optimize

import hersey
from hersey.damping.curves import CurveMixture, fit_curves, fitting
from hersey.damping.curves import mixture as mixing
from hersey.damping.curves.beyond import BEYOND, _hidden
from hersey.damping.curves.dwells import Dwells
from hersey.damping.curves.fitting import FittedLaw, fit_shape, log_posterior
from hersey.damping.curves.shapes import Shape
from hersey.log.means import read_means
from tests.conftest import ROOT

Curve = Callable[[np.ndarray], np.ndarray]


def _points(folder: Path, curve: Curve, *, scatter: float = 0.005, seed: int = 1) -> hersey.SteadyPoints:
    """Dwells at one temperature of a torque over speed, rad/s."""
    rng = np.random.default_rng(seed)
    speeds = np.repeat(np.geomspace(0.4, 40.0, 12), 2)
    torques = curve(speeds) * np.exp(scatter * rng.standard_normal(speeds.size))
    rows = [f"{w:.9g},{t:.9g}" for w, t in zip(speeds, torques, strict=True)]
    path = folder / "means.csv"
    path.write_text("\n".join(["Speed [rad/s],Torque [N*m]", *rows]) + "\n")
    return hersey.SteadyPoints.from_table(read_means([path], isothermal=True))


def corner(w: np.ndarray) -> np.ndarray:
    return 0.5 * np.maximum((w / 3.0) ** 0.4, (w / 3.0) ** -0.5)


def rounded(w: np.ndarray) -> np.ndarray:
    return 0.25 * ((w / 3.0) ** 0.4 + (w / 3.0) ** -0.5)


def rising(w: np.ndarray) -> np.ndarray:
    return 0.2 * w**0.4


def stribeck(w: np.ndarray) -> np.ndarray:
    return 0.3 + 0.5 * np.exp(-((w / 2.0) ** 1.5)) + 0.02 * w


def _fitted(points: hersey.SteadyPoints) -> CurveMixture:
    return fit_curves(points, hersey.fit(points))


def _weights(mixture: CurveMixture) -> dict[str, float]:
    out: dict[str, float] = {}
    for law in mixture.table:
        out[law.name] = out.get(law.name, 0.0) + law.weight
    return out


@pytest.mark.parametrize(
    ("curve", "wrong"),
    [(corner, {"plus", "stribeck"}), (rounded, {"plus", "sharp"}), (stribeck, {"plus", "sharp", "blend"})],
)
def test_a_wrong_law_is_rejected_and_the_true_curve_is_drawn(
    tmp_path: Path, curve: Curve, wrong: set[str]
) -> None:
    mixture = _fitted(_points(tmp_path, curve))
    rejected = {law.name for law in mixture.table if law.rejected}
    assert wrong <= rejected
    assert sum(_weights(mixture).values()) == pytest.approx(1.0, abs=0.01)
    rng = np.random.default_rng(0)
    law = mixture.shares(400)
    latent = rng.standard_normal((400, mixture.size))
    weight = np.exp(np.minimum(mixture.log_weight(law, latent), 0.0))
    speeds = np.geomspace(0.5, 35.0, 9)
    drawn = mixture.log_torque(law, latent, speeds, None)
    mean = np.average(drawn, axis=0, weights=weight)
    assert np.exp(mean) == pytest.approx(curve(speeds), rel=0.02)


def test_weights_share_the_draws() -> None:
    class Weighed(CurveMixture):
        pass

    mixture = object.__new__(Weighed)
    object.__setattr__(mixture, "laws", (None, None, None))
    object.__setattr__(mixture, "weights", np.array([0.5, 0.3, 0.2]))
    assert np.bincount(mixture.shares(10)).tolist() == [5, 3, 2]


def test_curves_spread_beyond_the_dwells_and_never_fall_towards_rest(tmp_path: Path) -> None:
    mixture = _fitted(_points(tmp_path, rounded))
    rng = np.random.default_rng(0)
    law = mixture.shares(300)
    latent = rng.standard_normal((300, mixture.size))
    latent[:, BEYOND:] *= 0.1  # the laws nearly as fitted: what spreads is what lies beyond
    speeds = 0.04 * np.exp(0.05 * np.arange(140))
    drawn = mixture.log_torque(law, latent, speeds, None)
    inside, below = speeds > 0.45, speeds < 0.4
    assert np.std(drawn[:, inside], axis=0).max() < 0.02
    spread = np.std(drawn[:, below], axis=0)
    assert spread[0] > 0.1
    assert np.all(np.diff(spread) < 1e-3)
    assert np.all(np.diff(drawn[:, below], axis=1) < 1e-9)
    # among the draws are a power law that goes on, and friction that saturates
    gain = drawn[:, 0] - drawn[:, int(np.argmax(speeds > 0.4))]
    assert gain.min() < 0.35
    assert gain.max() > 0.9 * 0.5 * np.log(10.0)


def test_above_the_dwells_the_slope_grows_or_fades(tmp_path: Path) -> None:
    """By exp(0.5 (1 - 1/r)) for a latent of one, r times above the dwells; drag that rises never falls."""
    mixture = _fitted(_points(tmp_path, rising))
    latent = np.zeros((4, mixture.size))
    latent[:, 3] = (0.0, 1.0, -1.0, -6.0)
    law = np.zeros(4, dtype=np.intp)
    fastest = 40.0
    speeds = fastest * np.exp(np.array([0.0, 0.5, 1.0, 1.4]))
    drawn = mixture.log_torque(law, latent, speeds, None)
    gain = drawn - drawn[:, :1]
    grown = np.exp(0.5 * (1.0 - fastest / speeds[1:]))
    assert gain[1, 1:] / gain[0, 1:] == pytest.approx(grown, rel=1e-6)
    assert gain[2, 1:] / gain[0, 1:] == pytest.approx(1.0 / grown, rel=1e-6)
    assert np.all(np.diff(gain, axis=1) > 0.0)


def test_torque_that_only_rises_has_curves_too(tmp_path: Path) -> None:
    """Among the dwells they follow it; whether it falls below them is left open."""
    points = _points(tmp_path, rising)
    assert hersey.fit(points).transition is None
    mixture = _fitted(points)
    assert mixture.falls_among_dwells(0.8) < 0.05
    law = mixture.shares(300)
    latent = np.random.default_rng(0).standard_normal((300, mixture.size))
    speeds = 0.04 * np.exp(0.05 * np.arange(140))
    drawn = np.exp(mixture.log_torque(law, latent, speeds, None))
    among = speeds > 0.45
    assert np.median(drawn[:, among], axis=0) == pytest.approx(0.2 * speeds[among] ** 0.4, rel=0.03)
    falls = drawn[:, 0] > drawn.min(axis=1) * 1.02
    assert 0.02 < np.mean(falls) < 0.9


@pytest.mark.parametrize(("curve", "sure"), [(corner, True), (rounded, True), (rising, False)])
def test_whether_dwells_lie_below_the_least_torque(tmp_path: Path, curve: Curve, sure: bool) -> None:
    chance = _fitted(_points(tmp_path, curve)).falls_among_dwells(0.8)
    assert chance == pytest.approx(1.0 if sure else 0.0, abs=0.05)


def test_boundary_friction_hides_below_the_dwells() -> None:
    """By hand: half of the drag, e-folded where the speed is 3.5 times below the slowest dwell."""
    latent = np.zeros((2, BEYOND))
    latent[1, 4] = 1.0  # a standard deviation more: exp(1.2) times as much
    below = np.array([[0.0, np.log(3.5), 20.0]] * 2)
    at_the_dwell = np.exp(-(3.5**1.2))
    left = np.array([0.0, np.exp(-1.0) - at_the_dwell, 1.0 - at_the_dwell])
    expected = np.log1p(np.array([[0.5], [0.5 * np.exp(1.2)]]) * left)
    assert _hidden(below, latent) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("shared", [1, 4])
def test_the_numbers_of_every_law_are_the_likeliest(shared: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A search without derivatives of ours finds nothing better beside them, and little work was needed."""
    points = hersey.read(ROOT / "examples" / "bench.csv").steady(tare="standing")
    if shared > 1:  # the errors of the no-load torque, which move dwells by two per cent
        rest = hersey.read_machine(ROOT / "examples" / "machine.toml").rest
        assert rest is not None
        points = points.without(rest)
    looks: list[int] = []

    def counted(shape: Shape, dwells: Dwells, numbers: np.ndarray) -> np.ndarray:
        looks.append(len(numbers))
        return log_posterior(shape, dwells, numbers)

    fits: list[FittedLaw] = []

    def kept(*given: Any) -> FittedLaw:
        fits.append(fit_shape(*given))
        return fits[-1]

    monkeypatch.setattr(fitting, "log_posterior", counted)
    monkeypatch.setattr(mixing, "fit_shape", kept)
    _fitted(points)
    assert len(fits) == 7
    assert len(looks) < 7 * 250  # one fit takes some 20 steps from each of two starts
    for fit in fits:
        assert fit.dwells.shared.shape[1] == shared
        _, deviation = fitting.priors(fit.shape, fit.dwells)

        def cost(moved: np.ndarray, fit: FittedLaw = fit, deviation: np.ndarray = deviation) -> float:
            return -float(log_posterior(fit.shape, fit.dwells, (fit.numbers + deviation * moved)[None])[0])

        better = optimize.minimize(
            cost, np.zeros(deviation.size), method="L-BFGS-B", options={"maxfun": 4000}
        )
        assert better.fun == pytest.approx(cost(np.zeros(deviation.size)), abs=2e-5), fit.shape.name
