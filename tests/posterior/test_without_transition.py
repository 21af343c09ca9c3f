"""Logs whose fit announces no transition: the posterior of the drive holds the truth all the same.

True V* are from the integrator of `benchmarks/decisions`, which shares no code with the package.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from benchmarks.decisions.belt import Belt
from benchmarks.decisions.fold import fold
from scipy import optimize

import hersey
from hersey.log.means import read_means
from hersey.posterior.sampling import posterior

RADIUS, STICK, STIFFNESS, MASS = 0.02, 1e-3, 9e3, 8.0


def bottom(v: float) -> float:
    """A shallow Stribeck curve (N): it falls by less than a tenth among the dwells."""
    return 20.0 + 3.0 * math.exp(-((v / 0.012) ** 1.2)) + 40.0 * v


def rising(v: float) -> float:
    """Full film at all dwells; the least drag lies below the slowest."""
    return 18.0 * (0.5 * ((v / 0.004) ** 0.35 + (v / 0.004) ** -0.35))


def _points(folder: Path, drag: Callable[[float], float], speeds: np.ndarray) -> hersey.SteadyPoints:
    rng = np.random.default_rng(5)
    torques = [drag(v) * RADIUS * math.exp(0.01 * rng.standard_normal()) for v in speeds.tolist()]
    rows = [f"{v / RADIUS:.9g},{t:.9g}" for v, t in zip(speeds.tolist(), torques, strict=True)]
    path = folder / "means.csv"
    path.write_text("\n".join(["Speed [rad/s],Torque [N*m]", *rows, ""]))
    return hersey.SteadyPoints.from_table(read_means([path], isothermal=True))


def _machine(folder: Path) -> hersey.Machine:
    text = f"""
[drivetrain]
stiffness = "{STIFFNESS} N/m"
mass = "{MASS} kg"
roll_radius = "{RADIUS} m"
stick_speed = "{STICK} m/s"
[uncertainty]
stick_speed = "0.5 mm/s to 2 mm/s"
stiffness = "5 %"
mass = "5 %"
"""
    (folder / "machine.toml").write_text(text)
    return hersey.read_machine(folder / "machine.toml")


def _true(drag: Callable[[float], float], closure: str) -> float:
    transition = float(optimize.minimize_scalar(drag, bounds=(1.5 * STICK, 0.3), method="bounded").x)
    return fold(Belt(drag, transition, STICK, STIFFNESS, MASS, closure))  # type: ignore[arg-type]


@pytest.mark.parametrize(("drag", "slowest"), [(bottom, 0.006), (rising, 0.008)])
def test_the_interval_of_each_closure_holds_its_truth(
    tmp_path: Path, drag: Callable[[float], float], slowest: float
) -> None:
    points = _points(tmp_path, drag, np.repeat(np.geomspace(slowest, 0.3, 12), 3))
    surface = hersey.fit(points)
    assert surface.transition is None
    found = posterior(points, _machine(tmp_path), surface=surface, draws=600)
    folds = found.edges(None).fold
    for index, closure in enumerate(("retained", "stiction")):
        low, high = np.quantile(folds[found.drives.closure == index], [0.025, 0.975])
        assert low < _true(drag, closure) < high
    # not by saying nothing, though friction that no dwell reaches may raise V* many times
    most = 4.0 if drag is bottom else 20.0
    assert found.safe_speed(None) < most * _true(drag, "stiction")
