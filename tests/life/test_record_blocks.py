"""Blocks of a record: as fine as they are independent, with honest errors."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter

from hersey.errors import InsufficientDataError, ParameterError
from hersey.life.growth.record_blocks import blocks_of_record

TIME = np.arange(3600.0)


def wander(memory: float, seed: int) -> np.ndarray:
    white = np.random.default_rng(seed).standard_normal(TIME.size) * np.sqrt(1.0 - memory**2)
    return np.asarray(lfilter([1.0], [1.0, -memory], white))


def test_a_smooth_course_does_not_hide_independent_blocks() -> None:
    course = 1.0 + 0.3 * (1.0 - np.exp(-TIME / 900.0))
    blocks = blocks_of_record(TIME, course + 0.05 * wander(0.5, 1))
    assert blocks.independent
    assert blocks.value.size >= 30
    true = 1.0 + 0.3 * (1.0 - np.exp(-blocks.age / 900.0))
    off = (blocks.value - true) / (blocks.value * blocks.error)
    assert 0.7 < np.std(off) < 1.4


def test_noise_that_wanders_long_makes_fewer_blocks() -> None:
    short, long = (
        np.mean([blocks_of_record(TIME, 1.0 + 0.02 * wander(m, seed)).value.size for seed in range(8)])
        for m in (0.5, np.exp(-1.0 / 150.0))
    )
    assert short > 50
    assert long < 35


def test_errors_are_shares_of_the_values() -> None:
    record = 1.0 + 0.02 * wander(0.5, 3)
    one, ten = blocks_of_record(TIME, record), blocks_of_record(TIME, 10.0 * record)
    assert ten.value == pytest.approx(10.0 * one.value)
    assert ten.error == pytest.approx(one.error)


def test_a_record_without_noise_has_no_error() -> None:
    blocks = blocks_of_record(TIME, np.full(TIME.size, 2.0))
    assert blocks.value == pytest.approx(2.0)
    assert blocks.error == pytest.approx(0.0)
    assert blocks.independent


def test_what_is_no_record_is_refused() -> None:
    with pytest.raises(InsufficientDataError, match="100 samples are too few"):
        blocks_of_record(TIME[:100], np.ones(100))
    with pytest.raises(ParameterError, match="sample 8 is below that of the sample before"):
        blocks_of_record(np.where(TIME == 7.0, 1.0, TIME), np.ones(TIME.size))
    with pytest.raises(ParameterError, match="value of sample 3 is not a number"):
        blocks_of_record(TIME, np.where(TIME == 2.0, np.nan, 1.0))
    with pytest.raises(InsufficientDataError, match="not positive"):
        blocks_of_record(TIME, np.where(TIME < 600.0, 0.0, 1.0))
    with pytest.raises(ParameterError, match="equal length"):
        blocks_of_record(TIME, np.ones(3))
