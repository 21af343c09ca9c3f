"""Two logs against each other."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.damping.candidates.branched import FREE, HELD, Law
from hersey.damping.candidates.thermal import ARRHENIUS, Thermal
from hersey.damping.compare import compare
from hersey.errors import InsufficientDataError
from tests.conftest import ROOT, shared
from tests.damping.candidates.test_comparison import REFERENCE, dwells
from tests.damping.candidates.test_shared_errors import visited

LAW = Law(Thermal(ARRHENIUS, REFERENCE), HELD)
VALUES = [0.1, 2.8, -0.7, -1.2, -0.9]


def test_the_same_lubricant_shows_no_difference() -> None:
    wrong = 0
    for seed in range(2):
        found = compare(dwells(LAW, VALUES, seed=seed), dwells(LAW, VALUES, seed=100 + seed))
        wrong += bool(np.any(found.low > 1.0) or np.any(found.high < 1.0))
        wrong += any(c.real for c in found.changes)
        assert found.mean_ratio.value == pytest.approx(1.0, abs=0.02)
    assert wrong <= 1


def test_more_drag_throughout() -> None:
    more = [VALUES[0] + np.log(1.25), *VALUES[1:]]
    found = compare(dwells(LAW, VALUES), dwells(LAW, more, seed=2), names=("new", "aged"))
    assert found.mean_ratio.low < 1.25 < found.mean_ratio.high
    assert np.all(found.low > 1.0)
    assert found.verdict.startswith(
        "Damping of aged is higher than that of new throughout the shared range, +2"
    )
    assert all(c.p_value > 0.01 for c in found.changes)


def test_a_transition_that_moved() -> None:
    moved = [*VALUES[:4], VALUES[4] + np.log(1.5)]
    found = compare(dwells(LAW, VALUES), dwells(LAW, moved, seed=2))
    change = next(c for c in found.changes if c.name == "transition speed")
    assert change.is_ratio
    assert change.real
    assert change.change.value == pytest.approx(1.5, abs=4 * change.change.error)
    assert change.change.error < 0.05
    # above both transitions nothing changed
    assert np.all((found.low[:, -1] < 1.02) & (found.high[:, -1] > 0.98))
    assert "transition speed" in found.verdict


def test_an_exponent_that_changed() -> None:
    other = [*VALUES[:2], -0.6, *VALUES[3:]]
    found = compare(dwells(LAW, VALUES), dwells(LAW, other, seed=2))
    change = next(c for c in found.changes if c.name == "c")
    assert change.real
    assert change.change.low < 0.1 < change.change.high


def test_logs_that_share_nothing_are_refused() -> None:
    data = dwells(LAW, VALUES)
    faster = replace(data, reference_speed=1000 * data.reference_speed)
    with pytest.raises(InsufficientDataError, match="have too few speeds in common"):
        compare(data, faster)
    cold = dwells(LAW, VALUES, temperatures=np.array([263.0, 283.0, 303.0]))
    with pytest.raises(InsufficientDataError, match="have no temperature in common"):
        compare(data, cold)
    isothermal = dwells(Law(None, FREE), [0.1, -0.7, -1.2, -0.9], temperatures=None)
    with pytest.raises(InsufficientDataError, match="but the other log has"):
        compare(data, isothermal)


def test_the_comparison_is_one_document() -> None:
    found = compare(dwells(LAW, VALUES), dwells(LAW, VALUES, seed=5))
    plain = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert (
        np.shape(plain["ratio"])
        == np.shape(plain["low"])
        == (len(plain["temperatures"]), len(plain["speeds"]))
    )
    assert found.verdict in found.summary()
    assert "rpm" in found.summary()


def test_two_screw_drives_differ() -> None:
    """Measured by others: drive 1 and drive 2 of one make, forward."""
    units = {"torque": "-9.84 mN*m / 100", "speed": "-1 rpm"}
    both = []
    for drive in (1, 2):
        folder = shared(f"data/friction/tro2021_screw_drives/driveNo{drive}/steady_state")
        log = hersey.read(sorted(folder.glob("*.csv")), units=units, isothermal=True)
        both.append(log.steady(rotation="forward"))
    found = compare(both[0], both[1], names=("drive 1", "drive 2"))
    assert found.temperatures.size == 0
    assert "Damping of drive 2 is higher than that of drive 1" in found.verdict
    assert found.mean_ratio.low > 1.0 or found.mean_ratio.high < 1.0


def test_a_measurement_compared_with_itself_is_named(tmp_path: Path) -> None:
    bench, copy = ROOT / "examples" / "bench.csv", tmp_path / "copy.csv"
    copy.write_bytes(bench.read_bytes())
    first, again = (hersey.read(path).steady(tare="standing") for path in (bench, copy))
    warning = compare(first, again).warnings[0]
    assert (warning.kind, warning.severity) == ("same log", "watch")
    assert warning.text.startswith("A and B are the same measurement, so no difference can show")
    other = hersey.read(copy).steady()
    assert "same log" not in [each.kind for each in compare(first, other).warnings]


def test_two_visits_of_one_lubricant_are_not_two_lubricants() -> None:
    """Two temperatures visited once: 3 % by visit pass for another energy, and no log tells that they may."""
    a, b = (visited([363.0, 423.0], between=0.03, within=0.003, seed=seed) for seed in (1, 2))
    found = compare(a, b, names=("new", "aged"))
    assert [change.name for change in found.changes] == ["c"]
    assert "in the visits recorded" in found.verdict
    assert any(str(each).startswith("new and aged do not show how much visits") for each in found.warnings)
    again = [363.0, 423.0, 363.0, 423.0, 393.0]
    a, b = (visited(again, between=0.03, within=0.003, seed=seed) for seed in (1, 2))
    found = compare(a, b)
    assert len(found.changes) == 2
    assert not any(change.real for change in found.changes)
    assert found.verdict.startswith("No difference")
    assert not any(each.kind == "visited once" for each in found.warnings)
