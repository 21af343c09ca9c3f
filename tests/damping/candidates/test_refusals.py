"""Which laws there are, what each is called, and every reason for which dwells cannot carry one."""

from __future__ import annotations

import numpy as np
import pytest

from hersey.damping.candidates.branched import (
    CONSTANT_PLUS,
    COULOMB_VISCOUS,
    FREE,
    HELD,
    NO_SPEED,
    ONE,
    REST_PLUS,
    Law,
)
from hersey.damping.candidates.candidate import Candidate, all_candidates, viscosity_candidates
from hersey.damping.candidates.constant_plus import ConstantPlusLaw
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.stribeck import StribeckLaw
from hersey.damping.candidates.thermal import ARRHENIUS, CELSIUS, KELVIN, VFT, Thermal
from tests.damping.candidates.test_comparison import REFERENCE, SPEEDS, dwells

STRAIGHT = Law(Thermal(KELVIN, REFERENCE), ONE)

ALL = {
    "isothermal/one": ("no temperature x power of speed, one branch", 2),
    "power-degC/one": ("power law in degC x power of speed, one branch", 3),
    "power-K/one": ("power law in K x power of speed, one branch", 3),
    "arrhenius/one": ("Arrhenius x power of speed, one branch", 3),
    "vft/one": ("VFT x power of speed, one branch", 4),
    "isothermal/coulomb-viscous": ("Coulomb plus viscous, no temperature", 2),
    "isothermal/constant-plus-power": ("constant torque plus power of speed, no temperature", 3),
    "isothermal/rest-plus-power": ("constant and viscous torque plus power of speed, no temperature", 4),
    "isothermal/two-free": ("no temperature x power of speed, two branches, free", 4),
    "isothermal/stribeck": ("Stribeck curve, no temperature", 4),
    "power-degC/coulomb-viscous": ("Coulomb plus viscous, film by power law in degC", 3),
    "power-degC/constant-plus-power": ("constant torque plus power of speed, film by power law in degC", 4),
    "power-K/coulomb-viscous": ("Coulomb plus viscous, film by power law in K", 3),
    "power-K/constant-plus-power": ("constant torque plus power of speed, film by power law in K", 4),
    "arrhenius/coulomb-viscous": ("Coulomb plus viscous, film by Arrhenius", 3),
    "arrhenius/constant-plus-power": ("constant torque plus power of speed, film by Arrhenius", 4),
    "vft/coulomb-viscous": ("Coulomb plus viscous, film by VFT", 4),
    "vft/constant-plus-power": ("constant torque plus power of speed, film by VFT", 5),
    "arrhenius/rest-plus-power": (
        "constant and viscous torque plus power of speed, film by Arrhenius",
        5,
    ),
    "power-degC/two-hersey": ("power law in degC x power of speed, two branches, one Hersey number", 5),
    "power-K/two-hersey": ("power law in K x power of speed, two branches, one Hersey number", 5),
    "arrhenius/two-hersey": ("Arrhenius x power of speed, two branches, one Hersey number", 5),
    "vft/two-hersey": ("VFT x power of speed, two branches, one Hersey number", 6),
    "power-degC/two-free": ("power law in degC x power of speed, two branches, free", 6),
    "power-K/two-free": ("power law in K x power of speed, two branches, free", 6),
    "arrhenius/two-free": ("Arrhenius x power of speed, two branches, free", 6),
    "vft/two-free": ("VFT x power of speed, two branches, free", 7),
    "power-degC/one/each": ("power law in degC x power of speed, one branch, exponents per temperature", 6),
    "power-degC/two-free/each": (
        "power law in degC x power of speed, two branches, free, exponents per temperature",
        9,
    ),
    "power-K/one/each": ("power law in K x power of speed, one branch, exponents per temperature", 6),
    "power-K/two-free/each": (
        "power law in K x power of speed, two branches, free, exponents per temperature",
        9,
    ),
    "arrhenius/one/each": ("Arrhenius x power of speed, one branch, exponents per temperature", 6),
    "arrhenius/two-free/each": (
        "Arrhenius x power of speed, two branches, free, exponents per temperature",
        9,
    ),
    "vft/one/each": ("VFT x power of speed, one branch, exponents per temperature", 7),
    "vft/two-free/each": ("VFT x power of speed, two branches, free, exponents per temperature", 10),
    "stribeck": ("Stribeck curve, Arrhenius viscosity", 5),
}


def test_the_candidates_from_the_simplest_on() -> None:
    data = dwells(STRAIGHT, [0.1, -2.4, -0.7])
    found = {r.key: (r.name, len(r.law(data).names)) for r in all_candidates()}
    assert found == ALL
    assert list(found) == list(ALL)
    assert all(r.refused(data) == "" for r in all_candidates())


def test_laws_of_viscosity_have_no_speed() -> None:
    assert [(r.key, r.name) for r in viscosity_candidates()] == [
        ("power-degC/viscosity", "power law in degC"),
        ("power-K/viscosity", "power law in K"),
        ("arrhenius/viscosity", "Arrhenius"),
        ("vft/viscosity", "VFT"),
    ]


def test_a_law_stands_about_the_reference_of_the_data() -> None:
    data = dwells(STRAIGHT, [0.1, -2.4, -0.7])
    assert Candidate(VFT, HELD).law(data) == Law(Thermal(VFT, 400.0), HELD, 1)
    assert Candidate(None, FREE).law(data) == Law(None, FREE, 1)
    assert Candidate(KELVIN, ONE, per_temperature=True).law(data) == Law(Thermal(KELVIN, 400.0), ONE, 4)
    assert Candidate(ARRHENIUS, ONE, stribeck=True).law(data) == StribeckLaw(Thermal(ARRHENIUS, 400.0))
    assert Candidate(None, ONE, stribeck=True).law(data) == StribeckLaw(None)
    assert Candidate(VFT, CONSTANT_PLUS).law(data) == ConstantPlusLaw(Thermal(VFT, 400.0), None)
    assert Candidate(None, COULOMB_VISCOUS).law(data) == ConstantPlusLaw(None, 0.0)
    cold = dwells(Law(None, ONE), [0.1, -0.7], temperatures=None)
    assert Candidate(KELVIN, NO_SPEED).law(cold) == Law(None, NO_SPEED, 1)


def with_(temperatures: list[float] | None, keep: list[int] | None = None, twice: int = 2) -> Observations:
    """Dwells at some temperatures and of the nine speeds only some."""
    hot = None if temperatures is None else np.array(temperatures)
    law, values = (Law(None, ONE), [0.1, -0.7]) if hot is None else (STRAIGHT, [0.1, -2.4, -0.7])
    data = dwells(law, values, temperatures=hot, twice=twice)
    if keep is None:
        return data
    step = np.argmin(np.abs(data.speed[:, None] - SPEEDS), axis=1)
    return data.take(np.flatnonzero(np.isin(step, keep)))


@pytest.mark.parametrize(
    ("candidate", "data", "why"),
    [
        (Candidate(KELVIN, ONE), with_(None), "the log has no temperature"),
        (Candidate(KELVIN, ONE), with_([400.0]), "needs 2 temperatures; the log has 1 (127 degC)"),
        (Candidate(KELVIN, ONE), with_([390.0, 410.0]), ""),
        (Candidate(VFT, ONE), with_([390.0, 410.0]), "needs 3 temperatures; the log has 2 (117, 137 degC)"),
        (Candidate(VFT, ONE), with_([380.0, 390.0, 410.0]), ""),
        (Candidate(ARRHENIUS, ONE), with_([390.0, 410.0]), ""),
        (Candidate(CELSIUS, ONE), with_([273.15, 310.0]), "T^b is not defined at or below 0 degC"),
        (Candidate(CELSIUS, ONE), with_([273.16, 310.0]), ""),
        (Candidate(KELVIN, ONE), with_([260.0, 310.0]), ""),
        (Candidate(None, ONE), with_(None), ""),
        (Candidate(None, FREE), with_(None, [0, 2, 4, 6]), "needs 5 speeds; the log has 4"),
        (Candidate(None, FREE), with_(None, [0, 2, 4, 6, 8]), ""),
        (Candidate(KELVIN, HELD), with_([390.0, 410.0], [0, 2, 4, 6]), "needs 5 speeds; the log has 4"),
        (Candidate(KELVIN, HELD), with_([390.0, 410.0], [0, 2, 4, 6, 8]), ""),
        (Candidate(None, ONE, stribeck=True), with_(None, [0, 2, 4, 6]), "needs 5 speeds; the log has 4"),
        (Candidate(None, ONE, stribeck=True), with_(None, [0, 2, 4, 6, 8]), ""),
        (Candidate(None, CONSTANT_PLUS), with_(None, [0, 4, 8]), "needs 4 speeds; the log has 3"),
        (Candidate(None, CONSTANT_PLUS), with_(None, [0, 2, 4, 6]), ""),
        (Candidate(None, REST_PLUS), with_(None, [0, 2, 4, 6]), "needs 5 speeds; the log has 4"),
        (Candidate(None, COULOMB_VISCOUS), with_(None, [0, 4, 8]), "needs 4 speeds; the log has 3"),
        (Candidate(None, COULOMB_VISCOUS), with_(None, [0, 2, 4, 6]), ""),
        (Candidate(None, ONE), with_(None, [0, 4], 3), ""),
        (Candidate(None, ONE), with_(None, [0, 2, 4, 6], 1), "its 2 parameters need 5 dwells; the log has 4"),
        (Candidate(None, ONE), with_(None, [0, 2, 4, 6, 8], 1), ""),
        (
            Candidate(KELVIN, ONE),
            with_([390.0, 410.0], [0, 4], 1),
            "its 3 parameters need 6 dwells; the log has 4",
        ),
        (Candidate(KELVIN, ONE), with_([390.0, 410.0], [0, 4, 8], 1), ""),
    ],
)
def test_what_dwells_cannot_carry_and_why(candidate: Candidate, data: Observations, why: str) -> None:
    assert candidate.refused(data) == why


def test_exponents_per_temperature_need_three_speeds_at_each() -> None:
    data = with_([390.0, 410.0])
    candidate = Candidate(KELVIN, ONE, per_temperature=True)
    hot = data.inputs.group == 1
    step = np.argmin(np.abs(data.speed[:, None] - SPEEDS), axis=1)
    two = data.take(np.flatnonzero(~hot | np.isin(step, [1, 5])))
    assert candidate.refused(two) == "needs 3 speeds at each temperature; 137 degC has 2"
    three = data.take(np.flatnonzero(~hot | np.isin(step, [1, 5, 6])))
    assert candidate.refused(three) == ""
    cold = data.take(np.flatnonzero(hot | np.isin(step, [1, 5])))
    assert candidate.refused(cold) == "needs 3 speeds at each temperature; 117 degC has 2"
    assert Candidate(KELVIN, ONE).refused(two) == ""
