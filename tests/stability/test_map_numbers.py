"""The operating map in numbers: edges, intervals, sentences, and what its picture is drawn from."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import hersey
from hersey.charts.operating_map import map_chart
from hersey.charts.style import BLUE
from hersey.damping.candidates.shared_errors import Freedom
from hersey.damping.surface import DampingSurface
from hersey.machine.limits import Limits, OperatingPoint
from hersey.machine.machine import Machine
from hersey.machine.uncertainty import Uncertainty
from hersey.motion.work import Work
from hersey.stability.hysteresis import hysteresis
from hersey.stability.hysteresis_sweep import hysteresis_sweep
from hersey.stability.operating_map import OperatingMap
from tests.machines import map_of

AT: dict[str, Any] = {"roll_radius": 0.015, "stick_speed": 3e-4}
KELVIN = np.array([400.0, 450.0, 468.0])
RPM = 2 * np.pi / 60


@pytest.fixture(scope="module")
def few(surface: DampingSurface, machine: Machine) -> OperatingMap:
    return map_of(
        surface,
        machine.train,
        **AT,
        limits=machine.limits,
        points=machine.points,
        uncertainty=machine.uncertainty,
        temperatures=KELVIN,
        draws=20,
        seed=5,
    )


@pytest.fixture(scope="module")
def isothermal(surface: DampingSurface) -> DampingSurface:
    keep = [0, 2, 3, 4]
    return replace(
        surface,
        b=None,
        reference_temperature=None,
        temperature_range=None,
        variables=tuple(surface.variables[i] for i in keep),
        values=surface.values[keep],
        covariance=surface.covariance[np.ix_(keep, keep)],
        freedoms=Freedom(surface.freedom, surface.covariance[np.ix_(keep, keep)]),
    )


def drag_of(surface: DampingSurface) -> hersey.Drag:
    return surface.drag(**AT)


def middle(values: np.ndarray) -> list[float]:
    """The 2.5 and 97.5 % points of a sorted sample, as the inverse of its distribution."""
    ordered = np.sort(values)
    return [ordered[math.ceil(share * values.size) - 1] for share in (0.025, 0.975)]


def test_the_interval_of_the_fold_is_that_of_the_draws_that_are_started(
    surface: DampingSurface, machine: Machine
) -> None:
    """A slow stick speed makes a belt with a high V*, which the roll does not start: it has none."""
    wide = {"stick_speed": hersey.Uncertainty(limits=(5e-5, 1e-3))}
    grip = 0.9 * drag_of(surface).at(450.0).holding_force
    given: dict[str, Any] = {
        **AT,
        "uncertainty": wide,
        "temperatures": [440.0, 450.0],
        "draws": 40,
        "seed": 5,
    }
    weak = map_of(surface, replace(machine.train, grip=grip), **given)
    strong = map_of(surface, machine.train, **given)
    low, high = weak.holding_interval[:, 1] / AT["roll_radius"]
    assert low < grip < high  # some of the draws are started, some are not
    drag = drag_of(surface).at(450.0)
    ends = np.array([0.2, 4.0]) * drag.stick_speed
    slowest = brentq(lambda v: replace(drag, stick_speed=v).holding_force - grip, *ends)
    gripping, law = replace(machine.train, grip=grip), replace(drag, stick_speed=slowest)
    bound = hysteresis(gripping, law, sensitivity=False)
    assert weak.upper_interval[1, 1] < 1.1 * bound.upper
    assert strong.upper_interval[1, 1] > 1.2 * bound.upper


def test_edges_are_the_bands_at_each_temperature(
    few: OperatingMap, machine: Machine, surface: DampingSurface
) -> None:
    drag = drag_of(surface)
    for i, t in enumerate(KELVIN):
        band = hysteresis(machine.train, drag.at(t), sensitivity=False)
        assert few.transition[i] == pytest.approx(band.transition, rel=1e-12)
        assert few.lower[i] == pytest.approx(min(band.lower, band.transition), rel=1e-9)
        assert few.upper[i] == pytest.approx(max(band.upper, band.transition), rel=1e-9)
        np.testing.assert_allclose(few.torque[i], 0.015 * drag.at(t).force(few.speed), rtol=1e-12)
    assert few.drag == drag
    assert (few.roll_radius, few.speed_limit, few.train) == (0.015, 0.4, machine.train)
    assert few.measured_speed == pytest.approx([0.015 * w for w in surface.speed_range], rel=1e-12)
    assert few.measured_temperature == surface.temperature_range


def test_intervals_are_those_of_the_draws(
    few: OperatingMap, machine: Machine, surface: DampingSurface
) -> None:
    drag = drag_of(surface)
    rng = np.random.default_rng(5)
    stiffness = Uncertainty(share=0.1).draw(rng, machine.train.stiffness, 20)
    stick = Uncertainty(limits=(1e-4, 1e-3)).draw(rng, 3e-4, 20)
    for i, t in enumerate(KELVIN):
        law = drag.at(t)
        many = surface.drag_samples(1000, 5, **AT, temperature=t)
        assert few.transition_interval[:, i].tolist() == pytest.approx(
            middle(many["transition_speed"]), rel=1e-12
        )
        some = surface.drag_samples(20, 5, **AT, temperature=t)
        moved = np.minimum(stick * law.stick_speed / drag.stick_speed, 0.999 * some["transition_speed"])
        folds = hysteresis_sweep(
            machine.train,
            law,
            **some,
            stiffness=stiffness,
            stick_speed=moved,
            zip=True,
            lower=False,
            work=Work(tolerance=1e-13),
        ).upper.values
        assert few.upper_interval[:, i].tolist() == pytest.approx(middle(folds), rel=1e-9)
    assert few.uncertain == ("stiffness", "stick_speed")


def test_the_seed_moves_both_intervals(few: OperatingMap, surface: DampingSurface, machine: Machine) -> None:
    given: dict[str, Any] = {**AT, "uncertainty": machine.uncertainty, "temperatures": KELVIN, "draws": 20}
    other = map_of(surface, machine.train, **given, seed=6)
    again = map_of(surface, machine.train, **given, seed=5)
    assert not np.any(other.transition_interval == few.transition_interval)
    assert not np.any(other.upper_interval == few.upper_interval)
    np.testing.assert_array_equal(again.upper_interval, few.upper_interval)
    more = map_of(surface, machine.train, **(given | {"draws": 40}), seed=5)
    assert not np.array_equal(more.upper_interval, few.upper_interval)


def test_between_few_temperatures_the_fold_is_interpolated_in_logarithms(
    surface: DampingSurface, machine: Machine
) -> None:
    kelvin = np.linspace(440.0, 468.0, 25)
    fine = map_of(surface, machine.train, **AT, temperatures=kelvin, draws=3)
    knots = map_of(surface, machine.train, **AT, temperatures=np.linspace(440.0, 468.0, 13), draws=3)
    np.testing.assert_allclose(fine.upper_interval[:, ::2], knots.upper_interval, rtol=1e-9)
    ratio = np.log(knots.upper_interval / knots.transition)
    between = np.exp(0.5 * (ratio[:, 1:] + ratio[:, :-1])) * fine.transition[1::2]
    np.testing.assert_allclose(fine.upper_interval[:, 1::2], between, rtol=1e-9)


def test_stall_and_contours_by_hand(few: OperatingMap) -> None:
    limit = 4.5
    assert few.torque_limit == pytest.approx(limit)
    for i, t in enumerate(KELVIN):
        law = few.drag.at(t)
        share = limit / 0.015 / law.transition_force
        rising = law.transition_speed * share ** (1 / (1 + law.ehl_exponent))
        falling = law.transition_speed * share ** (1 / (1 + law.mixed_exponent))
        assert few.stall_above[i] == pytest.approx(rising, rel=1e-9)
        assert few.stall_below[i] == (pytest.approx(falling, rel=1e-9) if falling > law.stick_speed else 0.0)
        slow, fast = few.contour(0.9 * 0.015 * law.transition_force)
        assert (slow[i], fast[i]) == pytest.approx((law.transition_speed, law.transition_speed), rel=1e-12)
        slow, fast = few.contour(1.2 * 0.015 * law.transition_force)
        assert slow[i] == pytest.approx(
            law.transition_speed * 1.2 ** (1 / (1 + law.mixed_exponent)), rel=1e-9
        )
        assert fast[i] == pytest.approx(law.transition_speed * 1.2 ** (1 / (1 + law.ehl_exponent)), rel=1e-9)


def test_default_axes(surface: DampingSurface, machine: Machine, isothermal: DampingSurface) -> None:
    assert surface.temperature_range is not None
    cold, hot = surface.temperature_range
    plain = map_of(surface, machine.train, **AT, draws=1)
    margin = 0.15 * (hot - cold)
    np.testing.assert_allclose(plain.temperature, np.linspace(cold - margin, hot + margin, 61), rtol=1e-12)
    slow, fast = (0.015 * w for w in surface.speed_range)
    low = min(slow, max(plain.lower.min(), slow / 10))
    high = max(fast, min(plain.upper.max(), 10 * fast))
    np.testing.assert_allclose(plain.speed, np.geomspace(0.7 * low, 1.25 * high, 81), rtol=1e-9)
    points = [OperatingPoint("far", 3.0, 500.0), OperatingPoint("near", 1e-4, 330.0)]
    wide = map_of(surface, machine.train, **AT, draws=1, points=points)
    assert wide.temperature is not None
    assert (wide.temperature[0], wide.temperature[-1]) == pytest.approx((330.0 - margin, 500.0 + margin))
    assert (wide.speed[0], wide.speed[-1]) == pytest.approx((0.7e-4, 3.75))
    for limit, top in ((2.5 * fast, 1.25 * max(high, 2.5 * fast)), (3.5 * fast, 1.25 * high)):
        shown = map_of(surface, machine.train, **AT, draws=1, limits=Limits(speed=limit))
        assert shown.speed[-1] == pytest.approx(top)
    freezing = map_of(surface, machine.train, **AT, draws=1, points=[OperatingPoint("ice", 0.01, 275.15)])
    assert freezing.temperature is not None
    assert freezing.temperature[0] == pytest.approx(cold - 0.5 * (cold - 273.15)) or freezing.temperature[
        0
    ] == pytest.approx(275.15 - 0.5 * 2.0)
    given = map_of(surface, machine.train, **AT, draws=1, temperatures=KELVIN, speeds=[0.01, 0.02])
    assert given.speed.tolist() == [0.01, 0.02]
    assert map_of(isothermal, machine.train, **AT, draws=1).temperature is None


def test_a_state_is_extrapolated_outside_the_dwells(few: OperatingMap) -> None:
    low, high = few.measured_speed
    assert few.measured_temperature is not None
    cold, hot = few.measured_temperature
    inside = 0.5 * (cold + hot)
    for t, v, outside in (
        (inside, 1.01 * low, False),
        (inside, 0.99 * low, True),
        (inside, 0.99 * high, False),
        (inside, 1.01 * high, True),
        (cold - 0.1, high / 2, True),
        (cold + 0.1, high / 2, False),
        (hot - 0.1, high / 2, False),
        (hot + 0.1, high / 2, True),
    ):
        assert few.state_at(temperature=t, speed=v).extrapolated == outside, (t, v)
    state = few.state_at(temperature=440.0, speed=0.1)
    assert state.torque == pytest.approx(0.015 * float(few.drag.at(440.0).force(0.1)))
    band = hysteresis(few.train, few.drag.at(440.0), sensitivity=False)
    assert (state.lower, state.transition, state.upper) == pytest.approx(
        (band.lower, band.transition, band.upper), rel=1e-9
    )


def test_states_and_torques_go_with_their_temperatures(few: OperatingMap) -> None:
    kelvin, speed = np.array([465.0, 400.0, 465.0]), np.array([0.04, 0.05, 0.2])
    many = few.look_up(temperature=kelvin, speed=speed)
    for state, t, v in zip(many, kelvin, speed, strict=True):
        assert state == few.state_at(temperature=float(t), speed=float(v))
    assert few.states(temperature=kelvin[:, None], speed=speed).shape == (3, 3)
    # of a motor of 4.5 N m and a belt that bears 4.18 N m by the estimate, of one of 9 N m for certain
    assert few.doubtful.tolist() == [few.state_at(temperature=float(t), speed=0.3).doubtful for t in KELVIN]
    assert few.doubtful[-1]
    strong = replace(few, torque_limit=9.0)
    assert not strong.doubtful.any()
    assert not any(state.doubtful for state in strong.look_up(temperature=467.0, speed=[0.01, 0.3]))
    assert strong.look_up(temperature=467.0, speed=0.3)[0].verdict() == "Smooth."
    weak = replace(few, torque_limit=3.0)
    assert weak.look_up(temperature=467.0, speed=0.3)[0].verdict().startswith("The motor cannot start")
    may = "The drive may be unable to start it from rest. If it starts:"
    words = {
        s: few.look_up(temperature=467.0, speed=v)[0].verdict()
        for s, v in (("slow", 0.01), ("band", 0.045), ("fast", 0.3))
    }
    assert words == {
        "slow": f"{may} Stick-slip is certain.",
        "band": f"{may} Smooth only if slowed from above; sticks if started from rest.",
        "fast": f"{may} Smooth.",
    }


def test_every_sentence_of_a_map(few: OperatingMap, surface: DampingSurface) -> None:
    rest = max(few.drag.at(t).holding_force for t in KELVIN) * 0.015
    hot = drag_of(surface).reference_temperature
    assert hot is not None
    low, high = (np.interp(453.15, KELVIN, edge) for edge in few.upper_interval)
    assert low < 0.045 < high
    cold_stick, hot_stick = (few.drag.at(t).stick_speed for t in (KELVIN[0], KELVIN[-1]))
    assert [str(each) for each in few.warnings] == [
        f"V* depends on the stick speed, 0.3 mm/s at {hot - 273.15:.0f} degC here (it moves with the "
        f"transition speed, from {1e3 * cold_stick:.3g} mm/s to {1e3 * hot_stick:.3g} mm/s), which the "
        "dwells do not show. "
        "The interval of V* includes the uncertainty of the fit, stiffness and stick speed",
        f"the drive gives at most 4.5 N m (motor torque); starting from rest takes {rest:.3g} N m",
        "the drive may be unable to start from rest",
        "thick paper: the verdict is uncertain, because the point lies within the 95 % interval of V* "
        f"({1e3 * low:.3g} mm/s to {1e3 * high:.3g} mm/s)",
    ]
    stick, limit, doubtful, point = few.warnings
    assert stick.values == {
        "stick_speed": 3e-4,
        "temperature": hot,
        "coldest": pytest.approx(cold_stick),
        "hottest": pytest.approx(hot_stick),
        "counted": "the fit, stiffness and stick speed",
    }
    assert limit.values == {
        "limit": 4.5,
        "limited_by": "motor torque",
        "least": float(few.holding.min()),
        "most": float(few.holding.max()),
    }
    assert doubtful.values == {"first": KELVIN[0], "last": KELVIN[-1]}
    assert point.values == {"edge": "V*", "low": pytest.approx(low), "high": pytest.approx(high)}
    assert [each.severity for each in few.warnings] == ["note", "note", "watch", "watch"]


def test_sentences_of_a_map_that_knows_little(
    surface: DampingSurface, isothermal: DampingSurface, machine: Machine
) -> None:
    points = [OperatingPoint("fast", 0.5, 440.0)]
    bare = map_of(
        surface, machine.train, **AT, draws=1, temperatures=KELVIN, points=points, limits=Limits(speed=0.4)
    )
    assert str(bare.warnings[0]).endswith(
        "which the dwells do not show. The interval of V* includes the uncertainty of the fit. "
        "State the uncertainty of stick_speed"
    )
    assert [str(each) for each in bare.warnings[1:]] == [
        "the map shows no stall, because no torque limit is stated. "
        "Add motor_torque, or roll_friction and nip_load, to [limits]",
        "fast: extrapolated, because the point lies outside the measured range",
        "fast: faster than the drive can run (400 mm/s)",
    ]
    assert bare.warnings[-1].values == {"limit": 0.4}
    one = map_of(isothermal, machine.train, **AT, draws=1)
    said = str(one.warnings[0])
    assert said.startswith("V* depends on the stick speed, 0.3 mm/s here, which the dwells do not show.")
    assert one.warnings[0].values["temperature"] is None
    assert one.warnings[1].kind == "isothermal fit"
    assert str(one.warnings[1]) == (
        "the fit is isothermal, so the map and its points hold at the temperature of the log"
    )
    at = float(one.transition[0])
    near = map_of(isothermal, machine.train, **AT, draws=1, points=[OperatingPoint("edge", at, 400.0)])
    low, high = (edge[0] for edge in near.transition_interval)
    assert near.warnings[-1].values == {"edge": "the transition speed", "low": low, "high": high}
    assert str(near.warnings[-1]) == (
        "edge: the verdict is uncertain, because the point lies within the 95 % interval of the transition "
        f"speed ({1e3 * low:.3g} mm/s to {1e3 * high:.3g} mm/s)"
    )


def test_what_the_fit_says_of_its_draws_is_said_by_the_map(surface: DampingSurface, machine: Machine) -> None:
    vague = surface.covariance.copy()
    vague[3, 3] = 0.3**2  # of c_mixed - c, which is -0.505: some draws do not fall
    wide = replace(surface, covariance=vague)
    with pytest.warns(UserWarning, match="had no falling branch") as caught:
        wide.drag_samples(
            1000, 0, roll_radius=0.015, stick_speed=drag_of(wide).at(450.0).stick_speed, temperature=450.0
        )
    drawn = map_of(wide, machine.train, **AT, draws=2, temperatures=[450.0, 451.0])
    said = str(caught[0].message)
    assert said.endswith(
        "draws of the fit had no falling branch and were replaced: intervals hold only if there is one"
    )
    words = [str(each) for each in drawn.warnings]
    assert said in words
    assert len(set(words)) == len(words)
    assert words.index(said) < len(words) - 2  # before what is said of the map itself
    assert drawn.warnings[words.index(said)].kind == "draws of the fit"


def test_the_summary_is_a_table_of_the_map(few: OperatingMap) -> None:
    lines = few.summary().splitlines()
    assert lines[0].split("  ")[0] == "temperature"
    assert lines[0].endswith("stall from                (speeds in mm/s)")

    def mm(speed: float) -> str:
        return f"{1e3 * speed:.3g}" if speed < 0.1 else f"{1e3 * speed:.0f}"

    i = 1
    cells = [
        "177 degC",
        mm(few.lower[i]),
        f"{mm(few.transition[i])} [{mm(few.transition_interval[0, i])}, {mm(few.transition_interval[1, i])}]",
        f"{mm(few.upper[i])} [{mm(few.upper_interval[0, i])}, {mm(few.upper_interval[1, i])}]",
        f"{mm(few.stall_above[i])}, may not start",
    ]
    assert "".join(f"{cell:<26s}" for cell in cells).rstrip() in lines
    torque = 0.015 * float(few.drag.at(453.15).force(0.12))
    may = "The drive may be unable to start it from rest. If it starts:"
    assert f"full speed (120 mm/s, 180 degC, {torque:.3g} N m): {may} Smooth." in lines
    free = replace(few, torque_limit=None, stall_above=np.full(3, np.inf))
    assert free.summary().splitlines()[2].endswith("unknown")
    never = replace(few, stall_above=np.full(3, np.inf))
    assert never.summary().splitlines()[2].endswith("never, may not start")


# --- the picture -------------------------------------------------------------------------------------------


_PICTURES: dict[tuple[int, bool], tuple[OperatingMap, dict[str, Any]]] = {}


def picture(drawn: OperatingMap, *, tooltips: bool = True) -> dict[str, Any]:
    """The specification of a map, made once: that takes a second."""
    key = id(drawn), tooltips
    if key not in _PICTURES:
        _PICTURES[key] = drawn, map_chart(drawn, tooltips=tooltips).to_dict(validate=False)
    return _PICTURES[key][1]


def layers(drawn: OperatingMap, *, tooltips: bool = True) -> list[dict[str, Any]]:
    """The layers of the main panel, in their order."""
    found: list[dict[str, Any]] = picture(drawn, tooltips=tooltips)["layer"][0]["layer"]
    return found


def rows(layer: dict[str, Any]) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = layer["data"]["values"]
    return found


def lines(drawn: OperatingMap, dash: list[float], width: float) -> list[list[tuple[float, float]]]:
    return [
        [(row["x"], row["y"]) for row in rows(layer)]
        for layer in layers(drawn)
        if layer.get("mark", {}).get("strokeDash") == dash and layer["mark"]["strokeWidth"] == width
    ]


def along(kelvin: np.ndarray, speed: np.ndarray, kept: Any = slice(None)) -> list[tuple[float, float]]:
    pairs = list(zip((kelvin - 273.15).tolist(), (1e3 * speed).tolist(), strict=True))
    return np.array(pairs)[kept].tolist()


def same(one: Any, other: Any) -> None:
    np.testing.assert_allclose(np.array(one), np.array(other), rtol=1e-9)


def test_lines_of_the_picture_are_those_of_the_map(few: OperatingMap) -> None:
    (transition,) = lines(few, [1.0, 0.0], 1.8)
    same(transition, along(KELVIN, few.transition))
    shown = few.upper > 1.01 * few.transition
    (fold,) = lines(few, [7.0, 4.0], 1.8)
    same(fold, along(KELVIN, few.upper, shown))
    dotted = lines(few, [1.5, 3.5], 1.3)
    expected = [along(KELVIN, edge, edge > 1.01 * few.transition_interval[1]) for edge in few.upper_interval]
    for one, other in zip(dotted, [e for e in expected if len(e) > 1], strict=True):
        same(one, other)
    (limit,) = lines(few, [10.0, 3.0, 2.0, 3.0], 1.3)
    same(limit, along(KELVIN, np.full(3, 0.4)))
    shade = next(rows(layer) for layer in layers(few) if layer.get("mark", {}).get("opacity") == 0.35)
    same([row["y"] for row in shade], 1e3 * few.transition_interval[0])
    same([row["top"] for row in shade], 1e3 * few.transition_interval[1])


def test_contours_of_the_picture_are_lines_of_their_torque(few: OperatingMap) -> None:
    blue = [layer for layer in layers(few) if layer.get("mark", {}).get("color") == BLUE]
    drawn = [layer for layer in blue if layer["mark"]["type"] == "line"]
    assert len(drawn) >= 3
    levels = []
    for layer in drawn:
        torques = [0.015 * float(few.drag.at(row["x"] + 273.15).force(row["y"] / 1e3)) for row in rows(layer)]
        assert max(torques) == pytest.approx(min(torques), rel=1e-6)
        levels.append(torques[0])
    steps = np.diff(sorted(levels))
    assert steps == pytest.approx(np.full(steps.size, steps[0]), rel=1e-6)
    assert max(levels) < few.torque_limit  # type: ignore[operator]
    named = {row["text"] for layer in layers(few) for sub in layer.get("layer", []) for row in rows(sub)}
    named = {text for text in named if text.endswith("N·m")}
    assert len(named) >= 2  # where there is no room a contour stays without its name
    assert named <= {f"{level:.4g} N·m" for level in levels}


def test_regions_lie_between_the_edges(few: OperatingMap) -> None:
    low, high = few.speed[0], few.speed[-1]
    found: dict[str, list[dict[str, Any]]] = {}
    for row in rows(layers(few)[0]):
        found.setdefault(row["part"], []).append(row)
    below, above = (np.clip(edge, low, high) for edge in (few.stall_below, few.stall_above))
    bounds = {
        "stick_slip 0": (np.full(3, low), few.lower),
        "swing 0": (few.lower, few.transition),
        "bistable 0": (few.transition, few.upper),
        "smooth 0": (few.upper, np.full(3, high)),
    }
    for part, (bottom, top) in bounds.items():
        if part in found:
            floor = np.clip(np.clip(bottom, low, high), below, above)
            same([row["y"] for row in found[part]], 1e3 * floor)
            same(
                [row["top"] for row in found[part]],
                1e3 * np.maximum(np.clip(np.clip(top, low, high), below, above), floor),
            )
            same([row["x"] for row in found[part]], KELVIN - 273.15)
    assert {"stick_slip 0", "bistable 0", "smooth 0"} <= set(found)
    assert {row["region"] for row in found["bistable 0"]} == {"depends on start"}
    stall = operating_map_of_stall(few)
    parts: dict[str, list[dict[str, Any]]] = {}
    for row in rows(layers(stall)[0]):
        parts.setdefault(row["part"], []).append(row)
    same([row["y"] for row in parts["stall 0"]], np.full(3, 1e3 * low))
    same([row["top"] for row in parts["stall 0"]], 1e3 * stall.stall_below)
    same([row["y"] for row in parts["stall 1"]], 1e3 * stall.stall_above)
    same([row["top"] for row in parts["stall 1"]], np.full(3, 1e3 * high))
    same([row["y"] for row in parts["stick_slip 0"]], 1e3 * stall.stall_below)


def operating_map_of_stall(few: OperatingMap) -> OperatingMap:
    """The map with a belt that stalls soon on both branches."""
    below, above = few.contour(1.3 * 0.015 * max(few.drag.at(t).transition_force for t in KELVIN))
    below, above = np.maximum(below, 2 * few.speed[0]), np.minimum(above, 0.3)
    return replace(few, stall_below=below, stall_above=above, limited_by="grip")


def test_the_frame_is_the_range_of_the_dwells(few: OperatingMap) -> None:
    frames = [rows(layer) for layer in layers(few) if layer.get("mark", {}).get("type") == "rect"]
    (inner,) = frames[0]
    assert few.measured_temperature is not None
    cold, hot = few.measured_temperature
    slow, fast = few.measured_speed
    left = max(cold, KELVIN[0]) - 273.15
    right = min(hot, KELVIN[-1]) - 273.15
    assert [inner[k] for k in ("x", "x2", "y", "y2")] == pytest.approx([left, right, 1e3 * slow, 1e3 * fast])
    assert frames[1] == frames[0]


def test_hatches_lie_outside_the_frame(few: OperatingMap) -> None:
    frame = next(rows(layer)[0] for layer in layers(few) if layer.get("mark", {}).get("type") == "rect")
    wide, tall = KELVIN[-1] - KELVIN[0], np.log(few.speed[-1] / few.speed[0])

    def pixels(x: float, y: float) -> tuple[float, float]:
        return (
            680 * (x + 273.15 - KELVIN[0]) / wide,
            450 * float(np.log(y / 1e3 / few.speed[0])) / tall,
        )

    left, bottom = pixels(frame["x"], frame["y"])
    right, top = pixels(frame["x2"], frame["y2"])
    hatches = [layer for layer in layers(few) if layer.get("mark", {}).get("type") == "rule"]
    assert [layer["mark"]["color"] for layer in hatches] == ["#555", "white"]
    length = 0.0
    for row in rows(hatches[0]):
        (x, y), (x2, y2) = pixels(row["x"], row["y"]), pixels(row["x2"], row["y2"])
        assert x2 - x == pytest.approx(y2 - y, abs=1e-6)  # at 45 degrees
        across, up = 0.5 * (x + x2), 0.5 * (y + y2)
        assert not (left + 1 < across < right - 1 and bottom + 1 < up < top - 1)
        assert -1e-6 <= x < x2 <= 680 + 1e-6
        assert (x - y + 450) % 9 == pytest.approx(0, abs=1e-6) or (x - y + 450) % 9 == pytest.approx(
            9, abs=1e-6
        )
        length += x2 - x
    outside = 680 * 450 - (right - left) * (top - bottom)
    assert length == pytest.approx(outside / 9, rel=0.03)


def test_points_and_the_cells_under_the_pointer(few: OperatingMap) -> None:
    marks = next(rows(layer) for layer in layers(few) if layer.get("mark", {}).get("shape") == "diamond")
    assert [row["name"] for row in marks] == ["full speed", "thick paper"]
    for row, point in zip(marks, few.points, strict=True):
        assert row["x"] == pytest.approx(point.temperature - 273.15)
        assert row["y"] == pytest.approx(1e3 * point.speed)
        assert row["rpm"] == pytest.approx(point.speed / 0.015 / RPM)
        assert row["torque"] == point.at.torque
        assert row["state"] == point.at.verdict()
    cells = rows(layers(few)[-1])
    assert len(cells) == 24 * 30
    for row in cells[:: len(cells) // 7]:
        state = few.state_at(temperature=row["x"] + 273.15, speed=row["y"] / 1e3)
        assert row["left"] < row["x"] < row["right"]
        assert row["bottom"] < row["y"] < row["top"]
        assert row["rpm"] == pytest.approx(row["y"] / 1e3 / 0.015 / RPM)
        assert row["torque"] == pytest.approx(state.torque)
        assert row["state"] == state.verdict() + (" (extrapolated)" if state.extrapolated else "")
    assert (cells[0]["left"], cells[-1]["right"]) == pytest.approx((KELVIN[0] - 273.15, KELVIN[-1] - 273.15))
    assert (cells[0]["bottom"], cells[-1]["top"]) == pytest.approx((1e3 * few.speed[0], 1e3 * few.speed[-1]))
    assert layers(few, tooltips=False)[-1].get("mark") is None


def test_points_outside_the_window_are_left_out(few: OperatingMap) -> None:
    away = replace(
        few,
        points=tuple(
            replace(p, temperature=p.temperature + d) for p, d in zip(few.points, (40.0, 0.0), strict=True)
        ),
    )
    marks = next(rows(layer) for layer in layers(away) if layer.get("mark", {}).get("shape") == "diamond")
    assert [row["name"] for row in marks] == ["thick paper"]


def test_both_axes_of_speed_say_the_same(few: OperatingMap) -> None:
    spec = picture(few)
    main, second = spec["layer"]
    left = main["layer"][0]["encoding"]["y"]["scale"]["domain"]
    right = second["encoding"]["y"]["scale"]["domain"]
    assert left == pytest.approx([1e3 * few.speed[0], 1e3 * few.speed[-1]])
    assert right == pytest.approx([v / 0.015 / RPM for v in (few.speed[0], few.speed[-1])])
    assert main["layer"][0]["encoding"]["x"]["scale"]["domain"] == pytest.approx(
        [KELVIN[0] - 273.15, KELVIN[-1] - 273.15]
    )
    for domain, axis in (
        (left, main["layer"][0]["encoding"]["y"]["axis"]),
        (right, second["encoding"]["y"]["axis"]),
    ):
        decades = [
            m * 10.0**p for p in range(-3, 6) for m in (1, 2, 5) if domain[0] <= m * 10.0**p <= domain[1]
        ]
        assert axis["values"] == pytest.approx(decades)
    assert spec["title"]["subtitle"] == [
        "solid: transition, shaded: its 95 % interval; dashed: V*, dotted: its 95 % interval (from fit, "
        "stiffness, stick speed)",
        "thin: drag torque; frame: measured range; hatched: extrapolated; stall beyond 4.5 N·m "
        "(motor torque)",
    ]


def test_labels_stand_at_what_they_name(few: OperatingMap) -> None:
    texts = {
        row["text"]: (row["x"] + 273.15, row["y"] / 1e3)
        for layer in layers(few)
        for sub in layer.get("layer", [])
        for row in rows(sub)
    }
    for text, state in (
        ("smooth", "smooth"),
        ("sticks", "stick_slip"),
        ("depends on start", "bistable"),
    ):
        if text in texts:
            assert few.state_at(temperature=texts[text][0], speed=texts[text][1]).state == state
    assert {"smooth", "sticks"} <= set(texts)
    assert texts["drive limit"][1] == pytest.approx(0.4, rel=0.2)
    for point in few.points:
        assert texts[point.name][1] == pytest.approx(point.speed, rel=0.5)


def test_an_edge_at_a_temperature_of_the_map_is_its_own(few: OperatingMap) -> None:
    """Whether or not the edge has an end at the temperatures beside it."""
    for row in ([0.1, np.inf, 0.3], [np.inf, 0.2, np.inf], [np.inf, np.inf, 0.3], [0.1, np.inf, np.inf]):
        assert [few.at(np.array(row), kelvin) for kelvin in KELVIN] == row
