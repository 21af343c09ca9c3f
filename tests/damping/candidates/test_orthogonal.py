"""Orthogonal distance regression against Deming's closed form, and what is said of it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hersey.damping.candidates.branched import ONE, Law
from hersey.damping.candidates.errors_in_variables import OrthogonalFit, orthogonal_fit
from hersey.damping.candidates.fitting import LawFit
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.thermal import ARRHENIUS, KELVIN, Thermal
from tests.damping.candidates.cases import hand_fit
from tests.damping.candidates.test_comparison import REFERENCE, dwells


def deming(x: np.ndarray, y: np.ndarray, ratio: float) -> tuple[float, float]:
    """Level and slope of a line where the variance of y is ``ratio`` times that of x (Deming 1943)."""
    (sxx, sxy), (_, syy) = np.cov(x, y)
    half = syy - ratio * sxx
    slope = (half + np.sqrt(half**2 + 4 * ratio * sxy**2)) / (2 * sxy)
    return float(y.mean() - slope * x.mean()), float(slope)


def blurred() -> tuple[Observations, LawFit]:
    law = Law(None, ONE)
    data = dwells(law, [0.1, -0.4], temperatures=None, scatter=0.05)
    shift = 0.2 * np.random.default_rng(4).standard_normal(len(data))
    count = len(data)
    data = replace(
        data,
        inputs=replace(data.inputs, log_speed=data.inputs.log_speed + shift),
        torque_error=np.full(count, 0.03),
        speed_error=np.full(count, 0.2),
        tare=(0.1 * data.inputs.log_speed + 0.05)[:, None],
    )
    fit = hand_fit(law, [0.12, -0.41], points=count, scatter=0.04)
    errors = np.hypot(0.03, np.linspace(0.05, 0.2, count))
    return data, replace(fit, errors=errors, disturbances=data.tare)


def test_a_line_is_deming_s() -> None:
    data, fit = blurred()
    found = orthogonal_fit(fit, data)
    y = data.log_torque - 0.4 * data.tare[:, 0]
    level, slope = deming(data.inputs.log_speed, y, (0.03**2 + 0.04**2) / 0.2**2)
    assert found.converged
    assert found.values == pytest.approx([level, slope - 1.0], rel=1e-6)
    error = np.sqrt(np.diag(fit.covariance))
    moved = np.abs(np.array([level - 0.12, slope - 1.0 + 0.41])) / error
    assert found.largest_shift == pytest.approx(np.max(moved), rel=1e-5)
    share = np.mean((fit.errors**2 - 0.03**2) / (fit.errors**2 + 0.04**2))
    assert found.share == pytest.approx(share, rel=1e-9)


def test_temperature_is_an_unknown_of_its_own() -> None:
    law = Law(Thermal(KELVIN, REFERENCE), ONE)
    data = dwells(law, [0.1, -2.4, -0.7], scatter=0.0)
    count = len(data)
    random = np.random.default_rng(6)
    assert data.inputs.kelvin is not None
    # speed errors so small that it is exact; temperature in K, nearly straight in its logarithm
    hot = data.inputs.kelvin * np.exp(0.01 * random.standard_normal(count))
    y = data.log_torque + 0.03 * random.standard_normal(count)
    data = replace(
        data,
        inputs=replace(data.inputs, kelvin=hot),
        log_torque=y,
        torque_error=np.full(count, 0.03),
        speed_error=np.full(count, 1e-8),
        temperature_error=0.01 * hot,
    )
    fit = hand_fit(law, [0.1, -2.4, -0.7], points=count, scatter=0.0)
    found = orthogonal_fit(replace(fit, effects=np.zeros(1)), data)
    # the line y - (1 + c) z on ln T, by Deming; c by the least total distance
    x, z = np.log(hot / REFERENCE), data.inputs.log_speed

    def distance(c: float) -> tuple[float, float, float]:
        level, b = deming(x, y - (1 + c) * z, 9.0)
        r = y - level - b * x - (1 + c) * z
        return float(np.sum(r**2 / (0.03**2 + (0.01 * b) ** 2))), level, b

    grid = np.linspace(found.values[2] - 1e-3, found.values[2] + 1e-3, 2001)
    _, level, b, c = min((*distance(c), c) for c in grid)
    assert found.converged
    assert found.values == pytest.approx([level, b, c], abs=2e-3)
    assert c == pytest.approx(found.values[2], abs=2e-4)


def test_inputs_without_errors_are_exact() -> None:
    law = Law(Thermal(ARRHENIUS, REFERENCE), ONE)
    data = dwells(law, [0.1, 2.8, -0.7], scatter=0.02)
    zero = np.zeros(len(data))
    weights = np.linspace(0.5, 2.0, len(data))
    data = replace(data, speed_error=zero, temperature_error=zero, torque_error=0.02 * weights)
    fit = replace(hand_fit(law, [0.1, 2.8, -0.7], points=len(data), scatter=0.01), effects=np.zeros(1))
    fit = replace(fit, errors=0.9 * data.torque_error)
    found = orthogonal_fit(fit, data)
    assert data.inputs.kelvin is not None
    x = np.column_stack([zero + 1, REFERENCE / data.inputs.kelvin - 1, data.inputs.log_speed])
    w = 1 / np.hypot(0.02 * weights, 0.01)[:, None]
    linear, *_ = np.linalg.lstsq(x * w, data.log_torque * w[:, 0], rcond=None)
    assert found.values == pytest.approx(linear - [0, 0, 1], rel=1e-6)
    assert found.share == 0.0  # not less than nothing


@pytest.mark.parametrize(
    ("shift", "converged", "said"),
    [
        (
            0.1,
            False,
            ". The check by orthogonal distance regression (ODRPACK) did not converge.",
        ),
        (
            0.4999,
            True,
            ". Orthogonal distance regression (ODRPACK) moves no parameter by more than 0.5 of its standard "
            "error, so the effective variance is accurate enough.",
        ),
        (
            0.5,
            True,
            (
                ". Orthogonal distance regression (ODRPACK) moves a parameter by 0.5 of its standard "
                "error, so the law bends within an error bar. Hold speed and temperature more constant."
            ),
        ),
    ],
)
def test_what_is_said_of_it(shift: float, converged: bool, said: str) -> None:
    found = OrthogonalFit(np.zeros(2), shift, 0.1234, converged)
    start = "Errors of speed and temperature make up 12.3 % of the variance of a dwell"
    assert found.verdict == start + said
