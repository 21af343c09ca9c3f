"""Fits and dwells made by hand for the tests of the candidates: nothing in them is zero without a reason."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hersey.damping.candidates.fitting import AnyLaw, LawFit
from hersey.damping.candidates.observations import Inputs, Observations
from hersey.damping.candidates.shared_errors import Freedom
from tests.damping.candidates.test_comparison import dwells


def some_covariance(size: int, scale: float = 0.02, seed: int = 3) -> np.ndarray:
    """Return a full covariance whose standard errors are near ``scale``."""
    root = np.random.default_rng(seed).standard_normal((size, size + 3))
    return np.asarray(scale**2 * (root @ root.T) / size)


def hand_fit(
    law: AnyLaw,
    values: list[float],
    *,
    covariance: np.ndarray | None = None,
    points: int = 20,
    scatter: float = 0.03,
    deviance: float = -50.0,
) -> LawFit:
    """Return a fit that nobody fitted, with numbers of its own everywhere."""
    size = len(values)
    covariance = some_covariance(size) if covariance is None else covariance
    random = np.random.default_rng(11)
    return LawFit(
        law=law,
        values=np.array(values),
        effects=np.array([0.4]),
        disturbances=np.linspace(0.01, 0.02, points)[:, None],
        covariance=covariance,
        clustered=some_covariance(size, 0.03, seed=4),
        scatter=scatter,
        shared=(),
        errors=random.uniform(0.01, 0.06, points),
        residuals=0.03 * random.standard_normal(points),
        cost=17.0,
        deviance=deviance,
        freedoms=Freedom(points - size, covariance),
    )


def even(law: AnyLaw, values: list[float], size: float = 0.02, seed: int = 5) -> Observations:
    """Return dwells with errors of every kind whose residuals are all of one size: none is an outlier."""
    data = dwells(law, values, scatter=0.0)
    random = np.random.default_rng(seed)
    count = len(data)
    return replace(
        data,
        log_torque=data.log_torque + size * random.choice([-1.0, 1.0], count),
        torque_error=random.uniform(0.004, 0.012, count),
        speed_error=random.uniform(0.002, 0.01, count),
        temperature_error=random.uniform(0.2, 1.0, count),
    )


def inputs(
    log_speed: list[float], kelvin: list[float] | None = None, group: list[int] | None = None
) -> Inputs:
    """Return inputs from plain lists."""
    return Inputs(
        np.array(log_speed),
        None if kelvin is None else np.array(kelvin),
        np.array(group or [0] * len(log_speed), dtype=np.intp),
    )
