"""Wear tests by others: friction that saturates is said to end, and what the data leave open is not named.

Polyphenylene sulphide, plain and with 15 to 45 % of PTFE, on a disc at constant speed (pin-on-disc rig of
`shared/data`, licence MIT). Speed and temperature do not change, so drift in the sense of `fit_drift` has
nothing to go by; the record itself is followed.
"""

from __future__ import annotations

import numpy as np
import polars as pl
import pytest

import hersey
from hersey.errors import InsufficientDataError
from hersey.life.drift.result import fit_drift
from hersey.life.growth import fit as growth_module
from hersey.life.growth import posterior as growth_posterior
from hersey.life.growth.fit import fit_growth
from hersey.life.growth.record_blocks import Blocks, blocks_of_record
from tests.conftest import shared


def blocks(name: str) -> Blocks:
    """Friction at full speed, without the first minute, in which the faces meet: that is no ageing."""
    log = hersey.read(
        shared(f"data/friction/te67_pin_on_disc/{name}.tsv"),
        channels={
            "time": "Time",
            "torque": "Friction Force#1",
            "speed": "Speed",
            "temperature": "Specimen Temp",
        },
        units={"torque": "0.022 N*m", "speed": "rpm", "temperature": "degC"},
    )
    (run,) = log.runs
    time = run.time - run.time[0]
    full = (run.speed > 0.95 * np.median(run.speed)) & (time > 60.0)
    return blocks_of_record(time[full], run.torque[full])


@pytest.fixture(autouse=True)
def fewer_draws(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(growth_posterior, "_ROUNDS", (100, 100, 100, 200))
    monkeypatch.setattr(growth_posterior, "_MOST", 2.0)
    monkeypatch.setattr(growth_module, "_DRAWS", 500)


#: Laws of a growth that ends.
ENDING = ("saturating", "sigmoid")


def law_of(found: Blocks) -> str | None:
    return fit_growth(["pin"] * found.age.size, found.age, found.value, found.error, age_unit="s").law


def test_friction_that_saturates_is_said_to_end() -> None:
    found = blocks("PPS+30PTFE_100N_200RPM_30MINS_1")
    assert found.independent
    assert found.age.size == 60
    growth = fit_growth(["pin"] * found.age.size, found.age, found.value, found.error, age_unit="s")
    assert growth.law in ENDING
    assert sum(growth.weights[law] for law in ENDING) > 0.9


def test_friction_that_saturates_or_grows_ever_slower_is_called_neither() -> None:
    """With 45 % of PTFE a power of age below 1 fits as well as saturation."""
    found = blocks("PPS+45PTFE_60N_200RPM_30MINS_2")
    growth = fit_growth(["pin"] * found.age.size, found.age, found.value, found.error, age_unit="s")
    assert growth.law is None
    assert sum(growth.weights[law] for law in (*ENDING, "power", "run-in")) > 0.97


def test_friction_that_barely_grows_most_likely_ends() -> None:
    """With 15 % of PTFE; weights are by the root of the evidence."""
    found = blocks("PPS+15PTFE_60N_200RPM_30MINS_1")
    weights = fit_growth(["pin"] * found.age.size, found.age, found.value, found.error, age_unit="s").weights
    assert sum(weights[law] for law in ENDING) > 0.6
    assert max(weight for law, weight in weights.items() if law not in ENDING) < 0.15


@pytest.mark.parametrize("name", ["PPS_100N_1", "PPS_60N_2"])
def test_friction_that_rises_and_falls_again_is_called_no_growth(name: str) -> None:
    assert law_of(blocks(name)) in (None, "constant")


def test_one_speed_tells_no_drift() -> None:
    found = blocks("PPS_100N_1")
    columns = {
        "run_id": np.arange(found.age.size),
        "unit": ["pin"] * found.age.size,
        "age (s)": found.age,
        "speed (rad/s)": np.full(found.age.size, 6.8),
        "torque (N m)": found.value,
        "torque error (N m)": found.value * found.error,
        "temperature (K)": np.full(found.age.size, 299.0),
    }
    with pytest.raises(InsufficientDataError, match="all dwells have the same speed"):
        fit_drift(pl.DataFrame(columns))
