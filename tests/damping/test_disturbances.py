"""Dwells that are lost for spikes or a ripple of the torque: the reason names the cause, with its numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from hersey.damping.dwells import SteadyPoints
from hersey.damping.dwells.disturbances import without_spikes, without_wave
from hersey.damping.dwells.reasons import Reason
from hersey.errors import InsufficientDataError
from hersey.log.torque_log import TorqueLog
from tests.damping.test_dwells import RPM, log_of

RATE, LASTS = 100, 30
SPEEDS = (5.0, 10.0, 20.0, 40.0, 80.0)
ROWS = RATE * LASTS
TIME = np.arange(ROWS * len(SPEEDS)) / RATE
SPEED = np.repeat(SPEEDS, ROWS) * RPM
ANGLE = np.cumsum(SPEED) / RATE


def log(change: Callable[[np.ndarray], np.ndarray]) -> TorqueLog:
    """Five dwells of 30 s with noise of 1 %, their torque changed."""
    noise = np.random.default_rng(0).normal(0.0, 0.01, TIME.size)
    return log_of(SPEED, change(0.5 * SPEED**0.35 * (1.0 + noise)), dt=1.0 / RATE)


def spiky(torque: np.ndarray) -> np.ndarray:
    """Ten spikes of +15 times the torque in the first dwell, and in the fourth."""
    out = torque.copy()
    for dwell in (0, 3):
        out[dwell * ROWS + 150 + 270 * np.arange(10)] *= 16.0
    return out


def test_spikes_are_named_with_their_number_and_size() -> None:
    points = log(spiky).steady()
    assert len(points) == 3
    lost = [r for r in points.rejected if r.is_dwell]
    assert [(r.why.kind, r.why.count) for r in lost] == [("spikes", 10), ("spikes", 10)]
    assert [r.why.share for r in lost] == pytest.approx([15.0, 15.0], rel=0.02)
    assert "10 samples differ from their neighbours by 14.9 times the mean" in lost[0].reason
    assert "check the cable" in points.dropped()


@pytest.mark.parametrize(("per_turn", "said"), [(1.0, "once per rev"), (2.0, "2 times per rev")])
def test_a_ripple_of_the_roll_is_named(per_turn: float, said: str) -> None:
    with pytest.raises(InsufficientDataError, match=said) as caught:
        log(lambda torque: torque * (1.0 + 0.6 * np.sin(per_turn * ANGLE))).steady()
    assert "5 x torque ripple at" in str(caught.value)
    assert "amplitude 60 % of the mean" in str(caught.value)


def test_frequency_and_amplitude_of_a_ripple_are_data() -> None:
    def rippling(torque: np.ndarray) -> np.ndarray:
        """The last dwell ripples 0.3 times in a turn of 0.75 s."""
        wave = np.where(SPEED[-1] == SPEED, 0.6 * np.sin(0.3 * ANGLE), 0.0)
        return np.asarray(torque * (1.0 + wave))

    points = log(rippling).steady()
    (lost,) = [r for r in points.rejected if r.is_dwell]
    assert lost.why.kind == "ripple"
    assert lost.why.frequency == pytest.approx(0.3 * 80.0 / 60.0, rel=0.01)
    assert lost.why.per_turn == pytest.approx(0.3, rel=0.01)
    assert lost.why.share == pytest.approx(0.6, rel=0.02)
    assert "once in 3.3" in lost.reason


def test_one_frequency_at_every_speed_is_none_of_the_roll() -> None:
    with pytest.raises(
        InsufficientDataError, match=r"3 Hz, .* the same at every speed, so not from what turns"
    ):
        log(lambda torque: torque * (1.0 + 0.6 * np.sin(2.0 * np.pi * 3.0 * TIME))).steady()


def test_what_to_do_about_a_ripple_depends_on_what_it_does() -> None:
    ripple: dict[str, Any] = {"share": 0.3, "frequency": 0.1, "per_turn": 0.25, "lasts": 30.0}
    drifts = Reason("ripple", **ripple, seen_as="torque drift")
    assert str(drifts).endswith("Hold each speed for at least 100 s to average it out")
    assert str(Reason("ripple", **ripple, seen_as="swing")).endswith(
        "Find the part that turns at this frequency, and true it"
    )


def stick_slip(torque: np.ndarray) -> np.ndarray:
    """The third dwell rises slowly and drops within a sample, twice a second."""
    saw = 0.4 * ((2.0 * TIME) % 1.0 - 0.5)
    return np.asarray(torque * (1.0 + np.where(SPEED[2 * ROWS] == SPEED, saw, 0.0)))


def test_stick_slip_stays_stick_slip() -> None:
    points: SteadyPoints = log(stick_slip).steady()
    assert [r.why.kind for r in points.rejected if r.is_dwell] == ["stick-slip"]


def test_what_is_no_spike_and_no_wave() -> None:
    noise = 1.0 + 0.01 * np.random.default_rng(1).normal(size=1000)
    assert without_spikes(noise) is None
    assert without_wave(np.arange(1000.0), noise) is None
    level = np.ones(1000)
    level[::20] = 5.0  # 5 % of the samples
    assert without_spikes(level) is None
    assert without_spikes(np.ones(3)) is None
    assert without_wave(np.zeros(9), np.ones(9)) is None
