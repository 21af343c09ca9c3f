"""Laws of torque by hand, point by point; their derivatives by differences on either side of a corner."""

from __future__ import annotations

from dataclasses import replace
from math import exp, log

import numpy as np
import pytest

from hersey.damping.candidates.branched import FREE, HELD, LEAST_POWER, NO_SPEED, ONE, Law
from hersey.damping.candidates.observations import Inputs
from hersey.damping.candidates.stribeck import StribeckLaw
from hersey.damping.candidates.thermal import ARRHENIUS, CELSIUS, GAS_CONSTANT, KELVIN, VFT, Thermal
from tests.damping.candidates.cases import inputs
from tests.damping.candidates.test_comparison import dwells

REFERENCE = 400.0
SPEED = [-1.9, -1.4, -0.8, -0.3, 0.2, 0.7, 1.1, 1.8]
HOT = [352.0, 371.0, 388.0, 400.0, 413.0, 430.0, 447.0, 395.0]
GROUP = [0, 0, 1, 1, 2, 2, 2, 1]
AT = inputs(SPEED, HOT, GROUP)
KINDS = (CELSIUS, KELVIN, ARRHENIUS, VFT)


def shape_by_hand(kind: str | None, kelvin: float, q: float) -> float:
    """The factor s(T) of a law about 400 K."""
    if kind is None:
        return 0.0
    if kind == CELSIUS:
        return log((kelvin - 273.15) / 126.85)
    if kind == KELVIN:
        return log(kelvin / 400.0)
    if kind == ARRHENIUS:
        return 400.0 / kelvin - 1.0
    t0 = 400.0 - 1.0 / q  # Vogel: D/(T - T0) - D/(T_ref - T0), over its slope at the reference
    return (1.0 / (kelvin - t0) - q) / (q**2 * 400.0)


def split(kind: str | None, groups: int, branches: str) -> dict[str, float]:
    """Values by name for a law with every parameter away from a round number."""
    values = {"level": 0.23}
    if kind is not None:
        values["e"] = -0.83 if kind == CELSIUS else (-2.6 if kind == KELVIN else 2.3)
    if kind == VFT:
        values["q"] = 1.0 / 190.0
    if branches != NO_SPEED:
        values |= {"c": -0.62} if groups == 1 else {f"c{i + 1}": -0.55 - 0.08 * i for i in range(groups)}
    if branches in (HELD, FREE):
        values |= {"c_mixed": -1.35, "at": -0.11}
    if branches == FREE and kind is not None:
        values["d"] = 1.9 if kind in (CELSIUS, KELVIN) else -3.7
    return values


def by_hand(
    kind: str | None, groups: int, branches: str, v: dict[str, float], z: float, kelvin: float, group: int
) -> float:
    s = shape_by_hand(kind, kelvin, v.get("q", 0.0))
    e = v.get("e", 0.0)
    total = v["level"] + e * s
    if branches == NO_SPEED:
        return total
    each = [v["c"]] if groups == 1 else [v[f"c{i + 1}"] for i in range(groups)]
    c = each[group if groups > 1 else 0]
    total += (1 + c) * z
    if branches in (HELD, FREE):
        power = sum(1 + x for x in each) / groups
        turn = v["at"] + v.get("d", 0.0) * s if branches == FREE else v["at"] - e * s / max(power, 0.05)
        if z < turn:
            total += (v["c_mixed"] - c) * (z - turn)
    return total


CASES = [
    (kind, groups, branches) for kind in (None, *KINDS) for groups in (1, 3) for branches in (ONE, HELD, FREE)
] + [(kind, 1, NO_SPEED) for kind in KINDS]


def law_of(kind: str | None, groups: int, branches: str) -> Law:
    return Law(None if kind is None else Thermal(kind, REFERENCE), branches, groups)


def differences(law: Law | StribeckLaw, values: np.ndarray, where: Inputs) -> np.ndarray:
    """Derivatives in the parameters by central differences of fourth order."""
    columns = []
    for index in range(values.size):
        h = 1e-4 * np.eye(values.size)[index] * (0.01 if abs(values[index]) < 0.02 else 1.0)
        f = {k: law.predict(values + k * h, where) for k in (-2, -1, 1, 2)}
        columns.append((f[-2] - 8 * f[-1] + 8 * f[1] - f[2]) / (12 * h[index]))
    return np.column_stack(columns)


def in_speed_and_heat(
    law: Law | StribeckLaw, values: np.ndarray, where: Inputs
) -> tuple[np.ndarray, np.ndarray]:
    def moved(speed: float, heat: float) -> np.ndarray:
        kelvin = None if where.kelvin is None else where.kelvin + heat
        return law.predict(values, replace(where, log_speed=where.log_speed + speed, kelvin=kelvin))

    def slope(h: float, by_heat: bool) -> np.ndarray:
        f = {k: moved(0.0, k * h) if by_heat else moved(k * h, 0.0) for k in (-2, -1, 1, 2)}
        return (f[-2] - 8 * f[-1] + 8 * f[1] - f[2]) / (12 * h)

    return slope(1e-4, False), slope(1e-2, True)


@pytest.mark.parametrize(("kind", "groups", "branches"), CASES)
def test_a_law_is_its_formula_and_its_derivatives_are_those_of_the_formula(
    kind: str | None, groups: int, branches: str
) -> None:
    law, named = law_of(kind, groups, branches), split(kind, groups, branches)
    assert law.names == tuple(named)
    assert law.broken is (branches in (HELD, FREE))
    assert [law.index(name) for name in named] == list(range(len(named)))
    values = np.array(list(named.values()))
    expected = [
        by_hand(kind, groups, branches, named, *point) for point in zip(SPEED, HOT, GROUP, strict=True)
    ]
    assert law.predict(values, AT) == pytest.approx(expected, abs=1e-12)
    found = law.jacobian(values, AT)
    assert found.shape == (len(SPEED), len(named))
    assert found == pytest.approx(differences(law, values, AT), rel=1e-8, abs=1e-8)
    by_speed, by_heat = law.slopes(values, AT)
    speed, heat = in_speed_and_heat(law, values, AT)
    assert by_speed == pytest.approx(speed, abs=1e-9)
    assert by_heat == pytest.approx(heat, abs=1e-10)
    if law.broken:
        turn = law.transition(values, AT)
        assert np.any(AT.log_speed < turn)
        assert np.any(AT.log_speed > turn)


@pytest.mark.parametrize("groups", [1, 3])
def test_the_transition_stands_where_its_hersey_number_is(groups: int) -> None:
    named = split(ARRHENIUS, groups, HELD)
    values = np.array(list(named.values()))
    held = law_of(ARRHENIUS, groups, HELD).transition(values, AT)
    power = 0.38 if groups == 1 else (0.45 + 0.37 + 0.29) / 3
    assert held == pytest.approx([-0.11 - 2.3 * (400.0 / t - 1) / power for t in HOT], abs=1e-12)
    free = law_of(ARRHENIUS, groups, FREE).transition(np.append(values, -3.7), AT)
    assert free == pytest.approx([-0.11 - 3.7 * (400.0 / t - 1) for t in HOT], abs=1e-12)


@pytest.mark.parametrize("c", [-0.97, -1.2])
def test_a_power_near_zero_moves_the_transition_as_its_bound_does(c: float) -> None:
    law = Law(Thermal(ARRHENIUS, REFERENCE), HELD)
    values, where = np.array([0.1, 0.4, c, -1.6, -0.11]), AT
    turn = np.array([-0.11 - 0.4 * (400.0 / t - 1) / 0.05 for t in HOT])
    assert LEAST_POWER == 0.05
    assert law.transition(values, where) == pytest.approx(turn, abs=1e-12)
    z = np.array(SPEED)
    expected = (
        0.1
        + 0.4 * (400.0 / np.array(HOT) - 1)
        + np.where(z < turn, (1 + c) * turn - 0.6 * (z - turn), (1 + c) * z)
    )
    assert law.predict(values, where) == pytest.approx(expected, abs=1e-12)
    assert law.jacobian(values, where) == pytest.approx(differences(law, values, where), abs=1e-8)
    assert law.slopes(values, where)[1] == pytest.approx(in_speed_and_heat(law, values, where)[1], abs=1e-10)


@pytest.mark.parametrize("kind", KINDS)
def test_a_law_of_temperature_is_its_formula(kind: str) -> None:
    law, q = Thermal(kind, REFERENCE), 1.0 / 190.0
    kelvin = np.array(HOT)
    s, by_heat, by_q = law.shape(kelvin, q)
    assert s == pytest.approx([shape_by_hand(kind, t, q) for t in HOT], abs=1e-13)
    slopes = {
        CELSIUS: 1.0 / (kelvin - 273.15),
        KELVIN: 1.0 / kelvin,
        ARRHENIUS: -400.0 / kelvin**2,
        VFT: -1.0 / (400.0 * (1.0 + (kelvin - 400.0) / 190.0) ** 2),
    }
    assert by_heat == pytest.approx(slopes[kind], rel=1e-12)
    ends = [law.shape(kelvin, q + side * 1e-7)[0] for side in (-1.0, 1.0)]
    assert by_q == pytest.approx((ends[1] - ends[0]) / 2e-7, abs=1e-5)
    if kind == VFT:
        assert np.max(by_q) > 1.0
    else:
        assert np.all(by_q == 0.0)


@pytest.mark.parametrize("kelvin", [363.0, 400.0, 440.0])
def test_apparent_energies_by_hand(kelvin: float) -> None:
    r = 8.31446261815324
    assert r == GAS_CONSTANT
    assert Thermal(KELVIN, REFERENCE).energy(kelvin) == pytest.approx(-r * kelvin, rel=1e-12)
    assert Thermal(ARRHENIUS, REFERENCE).energy(kelvin) == pytest.approx(r * 400.0, rel=1e-12)
    celsius = -r * kelvin**2 / (kelvin - 273.15)
    assert Thermal(CELSIUS, REFERENCE).energy(kelvin) == pytest.approx(celsius, rel=1e-12)
    q = 0.005
    vft = r * kelvin**2 / (400.0 * (1 + q * (kelvin - 400.0)) ** 2)
    assert Thermal(VFT, REFERENCE).energy(kelvin, q) == pytest.approx(vft, rel=1e-12)


def test_below_its_pole_vft_is_bounded() -> None:
    law = Thermal(VFT, REFERENCE)
    s, *_ = law.shape(np.array([200.0, 240.0, 204.5]), 1.0 / 199.0)  # pole at 201 K
    near = -(204.5 / 400 - 1) / (1 - 195.5 / 199.0)  # 1 + q t T_ref = 0.0176 and below are 0.02
    assert near == pytest.approx(27.8, abs=0.1)
    expected = [0.5 / 0.02, 0.4 / (1 - 160.0 / 199.0), (1 - 204.5 / 400) / 0.02]
    assert s == pytest.approx(expected, rel=1e-12)


def test_names_and_starts_of_laws_of_temperature() -> None:
    for kind in (CELSIUS, KELVIN, ARRHENIUS):
        assert Thermal(kind, REFERENCE).names == ("e",)
        assert Thermal(kind, REFERENCE).start() == [0.0]
    assert Thermal(VFT, REFERENCE).names == ("e", "q")
    assert Thermal(VFT, REFERENCE).start() == [0.0, pytest.approx(1.2 / 400.0)]


def test_without_a_temperature_at_a_point_the_law_is_that_at_the_reference() -> None:
    law = Law(Thermal(KELVIN, REFERENCE), HELD)
    cold, at = inputs(SPEED), inputs(SPEED, [400.0] * len(SPEED))
    values = np.array([0.23, -2.6, -0.62, -1.35, -0.11])
    assert law.predict(values, cold) == pytest.approx(law.predict(values, at), abs=1e-14)
    smooth = StribeckLaw(Thermal(ARRHENIUS, REFERENCE))
    values = np.array([-1.2, 9.0, 0.3, -1.7, 0.2])
    assert smooth.predict(values, cold) == pytest.approx(smooth.predict(values, at), abs=1e-14)


STRIBECK = np.array([-1.17, 6.3, 0.34, -1.6, 0.21])


def test_stribeck_s_curve_is_its_formula() -> None:
    level, e, stick, viscous, at = STRIBECK
    expected = []
    for z, kelvin in zip(SPEED, HOT, strict=True):
        h = exp(z - at + e * (400.0 / kelvin - 1))
        expected.append(level + log(1 + exp(stick - h * h) + exp(viscous) * h))
    law = StribeckLaw(Thermal(ARRHENIUS, REFERENCE))
    assert law.names == ("level", "e", "stick", "viscous", "at")
    assert law.predict(STRIBECK, AT) == pytest.approx(expected, abs=1e-12)
    cold = StribeckLaw(None)
    assert cold.names == ("level", "stick", "viscous", "at")
    assert cold.index("viscous") == 2
    assert not cold.broken
    expected = [level + log(1 + exp(stick - exp(2 * (z - at))) + exp(viscous) * exp(z - at)) for z in SPEED]
    assert cold.predict(np.delete(STRIBECK, 1), AT) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("thermal", [None, Thermal(ARRHENIUS, REFERENCE), Thermal(KELVIN, REFERENCE)])
def test_derivatives_of_stribeck_s_curve(thermal: Thermal | None) -> None:
    law, values = StribeckLaw(thermal), STRIBECK if thermal else np.delete(STRIBECK, 1)
    assert law.jacobian(values, AT) == pytest.approx(differences(law, values, AT), rel=1e-8, abs=1e-8)
    speed, heat = in_speed_and_heat(law, values, AT)
    assert law.slopes(values, AT)[0] == pytest.approx(speed, abs=1e-9)
    assert law.slopes(values, AT)[1] == pytest.approx(heat, abs=1e-10)


def test_stribeck_s_curve_is_finite_however_far_the_search_strays() -> None:
    law, where = StribeckLaw(None), inputs([-1.0, 0.5])
    # bounded at 40: exp(40) h with h = exp(z - 40), not below exp(-40); a peak of exp(40) or of exp(-40)
    far = law.predict(np.array([0.3, -55.0, 50.0, 50.0]), where)
    assert far == pytest.approx([0.3 + log(2.0), 0.3 + log(1 + exp(0.5))], abs=1e-12)
    far = law.predict(np.array([0.3, 55.0, -55.0, 45.0]), where)
    assert far == pytest.approx([40.3, 40.3], abs=1e-12)
    far = law.predict(np.array([0.3, 1.0, 2.0, -45.0]), where)
    assert far == pytest.approx([41.3, 42.3], abs=1e-9)
    assert np.all(np.isfinite(law.jacobian(np.array([0.3, 55.0, 45.0, -55.0]), where)))


def weighted_fit(columns: np.ndarray, y: np.ndarray, weights: np.ndarray) -> np.ndarray:
    return np.asarray(np.linalg.pinv(columns.T @ (weights[:, None] * columns)) @ (columns.T @ (weights * y)))


@pytest.mark.parametrize("kind", [None, *KINDS])
@pytest.mark.parametrize("branches", [ONE, NO_SPEED])
def test_a_straight_law_starts_from_its_linear_fit(kind: str | None, branches: str) -> None:
    law = law_of(kind, 3 if branches == ONE else 1, branches)
    random = np.random.default_rng(2)
    y, weights = random.standard_normal(8), random.uniform(0.5, 3.0, 8)
    (start,) = law.starts(AT, y, weights)
    heat = [np.array([shape_by_hand(kind, t, 1.2 / 400.0) for t in HOT])] if kind else []
    speeds = [np.array(SPEED) * (np.array(GROUP) == i) for i in range(3)] if branches == ONE else []
    linear = weighted_fit(np.column_stack([np.ones(8), *heat, *speeds]), y, weights)
    expected = list(linear[: 1 + len(heat)]) + ([1.2 / 400.0] if kind == VFT else [])
    expected += [v - 1.0 for v in linear[1 + len(heat) :]]
    assert start == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize("kind", [None, *KINDS])
@pytest.mark.parametrize(("branches", "groups"), [(HELD, 1), (FREE, 1), (FREE, 4)])
def test_a_broken_law_starts_from_linear_fits_at_transitions_it_could_have(
    kind: str | None, branches: str, groups: int
) -> None:
    law = law_of(kind, groups, branches)
    named = split(kind, groups, branches)
    data = dwells(law, list(named.values()), scatter=0.05)
    y, random = data.log_torque, np.random.default_rng(2)
    weights = random.uniform(0.5, 3.0, y.size)
    starts = law.starts(data.inputs, y, weights)
    assert len(starts) == 3
    assert data.inputs.kelvin is not None
    s = np.array([shape_by_hand(kind, t, 1.2 / 400.0) for t in data.inputs.kelvin])
    z, group = data.inputs.log_speed, data.inputs.group
    speeds = [z * (group == i) for i in range(groups)] if groups > 1 else [z]
    plain = np.column_stack([np.ones_like(z), *([s] if kind else []), *speeds])
    one = weighted_fit(plain, y, weights)
    first = 1 + bool(kind)
    moves = {0.0}
    if kind:
        moves = {-one[1] / max(np.mean(one[2:]), 0.05), -3.3 * one[1]}

    def solved(d: float, at: float) -> tuple[float, np.ndarray]:
        below = np.minimum(z - d * s - at, 0.0)
        design = np.column_stack([plain, below])
        linear = weighted_fit(design, y, weights)
        return float(np.sum(weights * (y - design @ linear) ** 2)), linear

    tried: list[tuple[float, np.ndarray, float, float]] = []
    for _ in range(2):
        for d in moves:
            reach = np.sort(z - d * s)
            for at in np.linspace(reach[2], reach[-3], 14):
                tried.append((*solved(d, at), d, at))
        linear = min(tried, key=lambda t: t[0])[1]
        if kind:
            moves = {-linear[1] / max(np.mean(linear[first : first + groups]), 0.05)}
    expected = sorted(tried, key=lambda t: t[0])[:3]
    for start, (_, linear, d, at) in zip(starts, expected, strict=True):
        exponents = linear[first : first + groups] - 1.0
        by_name = dict(zip(law.names, start, strict=True))
        assert by_name["level"] == pytest.approx(linear[0], rel=1e-6)
        assert [v for n, v in by_name.items() if n[0] == "c" and n != "c_mixed"] == pytest.approx(exponents)
        # below the transition the slope is that above it and what the fit adds
        assert by_name["c_mixed"] == pytest.approx(np.mean(exponents) + linear[-1], rel=1e-6)
        assert by_name["at"] == pytest.approx(at, rel=1e-6)
        if kind and branches == FREE:
            assert by_name["d"] == pytest.approx(d, rel=1e-6)


def test_stribeck_s_curve_starts_near_itself() -> None:
    for law, values in (
        (StribeckLaw(Thermal(ARRHENIUS, REFERENCE)), [-1.2, 5.0, 0.6, -1.0, 0.0]),
        (StribeckLaw(None), [-1.2, 0.6, -1.0, 0.0]),
    ):
        data = dwells(law, values, scatter=0.0)
        # a Stribeck speed that the search tries: the middle of those measured
        z = data.inputs.log_speed
        if law.thermal:
            assert data.inputs.kelvin is not None
            z = z + 5.0 * (400.0 / data.inputs.kelvin - 1)
        middle = 0.5 * (z.min() + z.max())
        data = dwells(law, [*values[:-1], middle], scatter=0.0)
        starts = law.starts(data.inputs, data.log_torque, np.linspace(1.0, 2.0, len(data)))
        assert len(starts) == 3
        assert starts[0] == pytest.approx([*values[:-1], middle], abs=1e-9)
        cost = [float(np.sum((data.log_torque - law.predict(v, data.inputs)) ** 2)) for v in starts]
        assert cost == sorted(cost)
        assert cost[1] > 1e-6


def test_parts_of_stribeck_s_curve_that_do_not_show_start_at_three_per_cent() -> None:
    law, data = StribeckLaw(None), dwells(StribeckLaw(None), [0.0, -40.0, -40.0, 0.0], temperatures=None)
    for start in law.starts(data.inputs, np.full(len(data), 0.7), np.ones(len(data))):
        assert start[:3] == pytest.approx([0.7, log(0.03), log(0.03)], abs=1e-9)


def test_vft_without_a_pole_is_straight() -> None:
    law, kelvin = Thermal(VFT, REFERENCE), np.array(HOT)
    assert law.shape(kelvin)[0] == pytest.approx(1.0 - kelvin / 400.0, abs=1e-14)
    assert law.energy(380.0) == pytest.approx(8.31446261815324 * 380.0**2 / 400.0, rel=1e-12)
