"""Independent logs, by a generator that shares no code with the virtual test stand: a sample.

`python -m benchmarks.coverage` judges thousands; here a few of each kind keep the claim from slipping.
"""

from __future__ import annotations

import pytest
from benchmarks.independent import intervals, transitions, verdicts

from tests.conftest import mostly_nightly

SEED = 12


def verdicts_of(*names: str, logs: int) -> list[verdicts.Verdict]:
    judged = [verdicts.one_log(SEED, name, index) for name in names for index in range(logs)]
    return [verdict for verdict in judged if isinstance(verdict, verdicts.Verdict)]


#: Logs of a kind, and every so-manieth of their truths; of poor logs less is named.
LOGS = mostly_nightly([("good", 1), ("poor", 1), ("good", 2)], ("good", 2))


@pytest.mark.parametrize(("test", "every"), LOGS)
def test_no_regime_is_named_that_is_not_the_truth_s(test: str, every: int) -> None:
    names = [f"coulomb-8-160/{ratio:g}/{test}" for ratio in verdicts.RATIOS[2:10:2]]
    names += [f"coulomb-25-100/{ratio:g}/{test}" for ratio in verdicts.RATIOS[3:10:3]]
    names += [f"soft/0.25/{test}", f"carreau/0.5/{test}", f"stribeck/3/{test}", f"heating/1/{test}"]
    names = names[::every]
    judged = verdicts_of(*names, logs=1)
    assert len(judged) == len(names)
    assert [name for name, v in zip(names, judged, strict=True) if v.wrong] == []
    assert sum(v.listed for v in judged) >= 0.8 * len(names)


def test_true_power_laws_are_named() -> None:
    judged = verdicts_of("power/0/good", "power/-0.58/good", "power/-0.7/good", "vogel/-0.667/good", logs=2)
    assert sum(v.right for v in judged) >= 7
    assert not any(v.wrong for v in judged)


@pytest.mark.parametrize("setting", mostly_nightly(["visit5", "slow1", "line"], "visit5"))
def test_intervals_hold_the_truth(setting: str) -> None:
    """Of 10 logs at least 8 for each exponent: 95 % do so with a probability of 0.99."""
    rows = [intervals.one_log(SEED, setting, index) for index in range(10)]
    for name in ("b", "c"):
        held = [row[name].holds for row in rows if not isinstance(row, str)]
        assert len(held) == 10
        assert sum(held) >= 8


def test_two_visits_do_not_tell_b() -> None:
    row = intervals.one_log(SEED, "visit2", 0)
    assert not isinstance(row, str)
    assert not row["b"].told
    assert row["c"].told


#: Of each sign that tells a transition: none, scattered, and the weakest and the strongest there is.
TOLD = (transitions.NAMES[0], "none/scattered", *(f"with/{each:g}" for each in transitions.STRENGTHS[::3]))


@pytest.mark.parametrize("name", mostly_nightly(transitions.NAMES, *TOLD))
def test_transitions_are_announced_where_they_are(name: str) -> None:
    for index in range(3):
        said = transitions.one_log(SEED, name, index)
        assert isinstance(said, transitions.Announced)
        assert said.transition == name.startswith("with"), said.why
