"""A law that does not hold: the no-load torque, off by tens of its errors, must not make up for it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.damping.candidates import Observations
from hersey.damping.candidates.branched import ONE
from hersey.damping.candidates.candidate import Candidate
from hersey.damping.candidates.fitting import fit_law
from hersey.damping.candidates.thermal import ARRHENIUS
from hersey.damping.no_load import no_load_torque

EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.fixture(scope="module")
def data() -> Observations:
    """The film alone falls and rises, so that no one branch holds."""
    rest = no_load_torque(hersey.read(EXAMPLES / "no-load.csv").steady(tare="standing"))
    return Observations.of(hersey.read(EXAMPLES / "bench.csv").steady(tare="standing").without(rest))


def test_a_law_that_contains_another_is_no_less_likely(data: Observations) -> None:
    one = fit_law(Candidate(ARRHENIUS, ONE).law(data), data)
    each = fit_law(Candidate(ARRHENIUS, ONE, per_temperature=True).law(data), data)
    assert each.deviance < one.deviance
    assert each.scatter > 0.1
    assert np.max(np.abs(each.effects[: data.tare.shape[1]])) < 10.0
