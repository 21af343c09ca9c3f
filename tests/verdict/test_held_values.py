"""A sensor at the end of its range, and one that is stuck, are named before a fit is trusted."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import hersey
from hersey.verdict.held_values import held_values

ROWS = 1200
RNG = np.random.default_rng(8)
SPEED = np.repeat([20.0, 60.0, 180.0], ROWS // 3)
TORQUE = 0.02 * SPEED**0.3 * (1.0 + 0.02 * RNG.standard_normal(ROWS))
HEAT = 90.0 + 0.2 * RNG.standard_normal(ROWS)


def log(folder: Path, torque: np.ndarray, heat: np.ndarray) -> hersey.TorqueLog:
    rows = zip(torque.tolist(), SPEED.tolist(), heat.tolist(), strict=True)
    body = "".join(f"{0.1 * i:.1f},{q:.5f},{w:g},{t:.3f}\n" for i, (q, w, t) in enumerate(rows))
    (folder / "log.csv").write_text("Time [s],Torque [N*m],Speed [rpm],Temperature [degC]\n" + body)
    return hersey.read(folder / "log.csv")


def test_a_live_log_has_none(tmp_path: Path) -> None:
    assert held_values(log(tmp_path, TORQUE, HEAT)) == []


def test_a_torque_at_the_end_of_its_range(tmp_path: Path) -> None:
    end = 0.095  # the fastest dwell lies about it
    clipped = np.minimum(TORQUE, end)
    [said] = held_values(log(tmp_path, clipped, HEAT))
    plateaus = np.diff(np.flatnonzero(np.diff(np.r_[0, clipped == end, 0])))[::2]
    rows = plateaus[plateaus >= 3].sum()
    assert said.values == {"channel": "torque", "fault": "clipped above", "value": end, "rows": rows}
    assert said.sentence == (
        f"log.csv: torque is clipped above at 0.095 N m for {rows} rows, because the range of "
        "sensor or logger ends there, so dwells at this value are wrong."
    )


def test_a_temperature_that_is_stuck(tmp_path: Path) -> None:
    frozen = HEAT.copy()
    frozen[800:] = frozen[800]
    [said] = held_values(log(tmp_path, TORQUE, frozen))
    assert (said.kind, said.where, said.number("rows")) == ("stuck", "log.csv", 400)
    assert said.sentence == (
        f"log.csv: temperature is stuck at {frozen[800]:.4g} degC for 400 rows, "
        "so its true value there is unknown."
    )
