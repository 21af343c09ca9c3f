"""The no-load torque: found again in logs without the film, taken off with its errors, or refused."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hersey
from hersey import NoLoadTorque, testbench
from hersey.damping.candidates.branched import ONE
from hersey.damping.candidates.candidate import Candidate
from hersey.damping.candidates.fitting import fit_law
from hersey.damping.candidates.observations import Observations
from hersey.damping.dwells import SteadyPoints
from hersey.damping.estimate import quantile
from hersey.damping.no_load_torque import with_rest
from hersey.document.assembly import fit_document
from hersey.document.saved_fit import read_fit
from hersey.errors import InsufficientDataError, ParameterError, WrongKindError
from hersey.log.torque_log import Correction
from hersey.stability.plan.draws import drawn as machines_drawn
from hersey.testbench.truth import Truth
from hersey.verdict.warnings import warnings_of
from tests.damping.test_surface import grid, points_of
from tests.machines import map_of

CONSTANT, PER_SPEED, SLOPE, AT = 0.020, 0.001, -0.002, 150.0 + 273.15
SPEEDS, TEMPERATURES = np.geomspace(0.5, 15, 8), np.array([100.0, 125.0, 150.0, 175.0])


def rest_torque(speed: np.ndarray, celsius: np.ndarray) -> np.ndarray:
    """What the drive takes, N m, with the sign of the speed."""
    warm = 1.0 + SLOPE * (celsius + 273.15 - AT)
    return np.asarray(np.sign(speed) * (CONSTANT + PER_SPEED * np.abs(speed)) * warm)


def no_load(seed: int | None = None, *, noise: float = 3e-4, tare: float = 0.0) -> SteadyPoints:
    """Dwells without the film, each temperature visited twice; noise in N m, exact without a seed."""
    w, t = grid(SPEEDS, np.tile(TEMPERATURES, 2))
    torque = rest_torque(w, t)
    random = np.random.default_rng(seed)
    if seed is not None:
        torque = torque + noise * random.standard_normal(w.size) + tare * random.standard_normal()
    error = (noise if seed is not None else 0.0) / torque
    return points_of(w, torque, t, error=error, tare_error=tare)


def film(w: np.ndarray, t: np.ndarray) -> np.ndarray:
    return np.asarray(62.0 * t**-0.9 * w**0.4 / 10.0)


def stated(uncertainty: float = 0.0) -> NoLoadTorque:
    return NoLoadTorque.stated(
        constant=CONSTANT,
        per_speed=PER_SPEED,
        temperature_slope=SLOPE,
        reference_temperature=AT,
        uncertainty=uncertainty,
    )


def test_an_exact_rest_is_found_exactly() -> None:
    rest = hersey.no_load_torque(no_load())
    w, t = np.array([0.7, 3.0, -9.0]), np.array([110.0, 150.0, 170.0])
    assert rest.torque(w, temperature=t + 273.15) == pytest.approx(rest_torque(w, t), rel=1e-9)
    assert rest.sha256 == ("0",)
    assert rest.speed_range == pytest.approx((0.5, 15.0))
    assert not rest.warnings


def test_intervals_hold_the_truth() -> None:
    """Of 40 logs with a zero that all dwells share some 95 % hold each number."""
    held = np.zeros(3)
    logs = 40
    for seed in range(logs):
        rest = hersey.no_load_torque(no_load(seed, tare=1e-3))
        assert rest.reference_temperature is not None
        warm = 1.0 + SLOPE * (rest.reference_temperature - AT)
        truth = CONSTANT * warm, PER_SPEED * warm, SLOPE / warm
        numbers = rest.constant, rest.per_speed, rest.temperature_slope
        held += [e.low <= x <= e.high for e, x in zip(numbers, truth, strict=True)]
    assert np.all(held >= 0.85 * logs), held
    assert rest.constant.error > 0.9e-3  # the zero is in it


@dataclass(frozen=True)
class Lifted(Truth):
    """A drive whose roll is lifted."""

    def torque(self, speed: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        return rest_torque(speed, temperature)


def test_a_log_without_the_film_tells_the_rest() -> None:
    stand = testbench.Stand(
        speeds_rpm=(5.0, 20.0, 60.0, 120.0),
        temperatures_degC=(120.0, 150.0, 180.0),
        stick_slip=False,
        torque_noise=0.3,
    )
    table = testbench.run(seed=4, truth=Lifted(), stand=stand).table
    rest = hersey.no_load_torque(hersey.read(table).steady(tare="standing"))
    w = np.array([1.0, 6.0, 12.0])
    found, true = rest.torque(w, temperature=AT), rest_torque(w, np.full(3, 150.0))
    assert np.all(
        np.abs(found - true) < 3.0 * np.linalg.norm(rest.errors(w, temperature=np.full(3, AT)), axis=1)
    )
    assert found == pytest.approx(true, rel=0.05)
    assert 0.0 < rest.constant.error < 0.1 * CONSTANT
    assert rest.source == "frame"


def test_what_one_speed_or_one_temperature_does_not_tell_is_said() -> None:
    noise = np.array([1.0, -1.0, 0.5, -0.5, 0.0]) * 1e-4
    slow = hersey.no_load_torque(points_of(np.full(5, 2.0), 0.02 + noise))
    assert (slow.constant.estimable, slow.per_speed.estimable, slow.per_speed.value) == (True, False, 0.0)
    assert "has only one speed, 19.1 rpm, so its increase with speed is assumed zero" in slow.summary()
    one = hersey.no_load_torque(points_of(SPEEDS[:5], 0.02 + 0.001 * SPEEDS[:5] + noise, np.full(5, 150.0)))
    assert (one.per_speed.estimable, one.temperature_slope.estimable, one.reference_temperature) == (
        True,
        False,
        None,
    )
    assert "has only one temperature, 150 degC" in str(one.warnings[0])
    w, t = grid(SPEEDS, TEMPERATURES[:2])
    each_once = hersey.no_load_torque(points_of(w, rest_torque(w, t), t, error=0.01))
    assert not each_once.temperature_slope.estimable
    assert [each.kind for each in each_once.warnings] == ["each temperature once"]


def test_no_load_logs_that_tell_nothing_are_refused() -> None:
    with pytest.raises(InsufficientDataError, match="run: 3 dwells are too few for the no-load torque"):
        hersey.no_load_torque(points_of(SPEEDS[:3], 0.02 + 0.001 * SPEEDS[:3]))
    with pytest.raises(InsufficientDataError, match=r"falls to -35 mN m.*signs={'torque': -1}"):
        hersey.no_load_torque(points_of(SPEEDS, -0.02 - 0.001 * SPEEDS))
    points = no_load()
    twice = replace(points.log, corrections=(Correction("no-load torque", (), ()),))
    with pytest.raises(ParameterError, match="Remove no_load from the mapping"):
        hersey.no_load_torque(replace(points, log=twice))


def test_a_torque_that_bends_is_said_to() -> None:
    bent = hersey.no_load_torque(points_of(SPEEDS, 0.02 * SPEEDS**0.3, error=0.002))
    assert [each.kind for each in bent.warnings] == ["no line"]
    assert bent.warnings[0].number("p_value") < 0.01


def test_the_film_is_what_is_left() -> None:
    """A film beside the rest is fitted as if there were none, and the whole is the torque of the log."""
    w, t = grid(SPEEDS, TEMPERATURES)
    whole = film(w, t) + rest_torque(w, t)
    points = points_of(w, whole, t, error=1e-4)
    surface = hersey.fit(points.without(stated()))
    assert surface.b is not None
    assert surface.c.value == pytest.approx(-0.6, abs=1e-9)
    assert surface.b.value == pytest.approx(-0.9, abs=1e-9)
    assert surface.torque(speed=w, temperature=t + 273.15) == pytest.approx(film(w, t), rel=1e-9)
    assert surface.total_torque(speed=w, temperature=t + 273.15) == pytest.approx(whole, rel=1e-9)
    assert abs(hersey.fit(points).c.value + 0.6) > 0.003  # the whole torque passes for another film
    backwards = points_of(-w, -whole, t).without(stated())
    assert backwards.column("torque") == pytest.approx(-film(w, t), rel=1e-9)


def test_what_was_taken_off_is_said() -> None:
    w, t = grid(SPEEDS, TEMPERATURES)
    points = points_of(w, film(w, t) + rest_torque(w, t), t, error=1e-3)
    with_approach = points.table.with_columns(approach=np.full(w.size, "start"), rows=np.ones(w.size))
    points = replace(points, table=with_approach).without(stated())
    surface = hersey.fit(points)
    assert "20 mN m + 1 mN m s/rad times speed, -0.2 %/K from 150 degC (stated)" in points.summary()
    assert "measured minus no-load torque: 20 mN m" in surface.summary()
    assert "for the film alone: no-load torque is subtracted" in hersey.regime(points, surface).verdict


def test_a_rest_of_other_temperatures_is_said_to_be_extrapolated() -> None:
    cold = hersey.no_load_torque(
        points_of(SPEEDS, rest_torque(SPEEDS, np.full(8, 25.0)), np.full(8, 25.0), error=0.01)
    )
    w, t = grid(SPEEDS, TEMPERATURES)
    whole = film(w, t) + rest_torque(w, t)
    points = points_of(w, whole, t, error=1e-3).without(cold)
    said = " ".join(str(each) for each in warnings_of(points, None))
    assert "has only one temperature, 25 degC" in said
    assert ("25 degC to 25 degC, the dwells 100 degC to 175 degC: no-load torque is extrapolated") in said
    blind = points_of(w, whole, error=1e-3).without(stated())
    [found] = [each for each in warnings_of(blind, None) if each.kind == "no-load torque of one temperature"]
    assert found.sentence == "The log has no temperatures, so the no-load torque at 150 degC is used."
    assert found.number("temperature") == AT


def test_errors_of_the_rest_widen_the_intervals() -> None:
    """Of 60 logs whose rest is off as often as its stated 10 % allow, some 95 % hold the exponent."""
    w = np.geomspace(0.5, 15, 10)
    held, narrow = 0, 0
    for seed in range(60):
        random = np.random.default_rng(seed)
        off = float(np.exp(np.log(1.1) / 1.96 * random.standard_normal()))
        whole = film(w, np.full(10, 150.0)) / 3 + off * (CONSTANT + PER_SPEED * w)
        points = points_of(w, whole * (1.0 + 5e-4 * random.standard_normal(w.size)), error=5e-4)
        held += holds_exponent(points.without(stated(0.1)))
        narrow += holds_exponent(points.without(stated()))
    assert held >= 0.88 * 60
    assert narrow < 0.5 * 60


def holds_exponent(points: SteadyPoints) -> bool:
    """Whether the interval of the one exponent holds that of the film."""
    data = Observations.of(points)
    fit = fit_law(Candidate(None, ONE).law(data), data)
    c = fit.law.index("c")
    return bool(abs(fit.values[c] + 0.6) <= quantile(fit.freedom_of("c")) * fit.error("c"))


def test_what_cannot_be_taken_off_is_refused() -> None:
    w, t = grid(SPEEDS, TEMPERATURES)
    points = points_of(w, film(w, t) + rest_torque(w, t), t)
    heavy = NoLoadTorque.stated(constant="0.3 N*m")
    with pytest.raises(
        InsufficientDataError, match=r"at 4.77 rpm torque is .* no-load torque 300 mN m \(stated\)"
    ):
        points.without(heavy)
    slow = hersey.no_load_torque(points_of(SPEEDS[:4], 0.02 + 0.001 * SPEEDS[:4], error=0.01))
    with pytest.raises(
        InsufficientDataError, match=r"run covers the no-load torque at 4.77 to 20.5 rpm.*143 rpm"
    ):
        points.without(slow)
    with pytest.raises(ParameterError, match="already subtracted"):
        points.without(stated()).without(stated())
    with pytest.raises(WrongKindError, match="unit 'N' is not a unit of torque"):
        NoLoadTorque.stated(constant="20 N")
    with pytest.raises(ParameterError, match="no-load torque is zero"):
        NoLoadTorque.stated()
    with pytest.raises(ParameterError, match="constant is -1: it must not be negative"):
        NoLoadTorque.stated(constant=-1.0)
    with pytest.raises(ParameterError, match="needs reference_temperature"):
        NoLoadTorque.stated(constant=0.02, temperature_slope=-0.002)


def test_a_saved_fit_carries_the_rest(tmp_path: Path) -> None:
    points = hersey.read("examples/bench.csv").steady(tare="standing").without(stated(0.1))
    surface = hersey.fit(points)
    path = tmp_path / "fit.json"
    printed = {"hersey_version": "0", **fit_document(points.log, points, surface).model_dump(mode="json")}
    path.write_text(json.dumps(printed))
    again = read_fit(path)
    assert again.rest is not None
    assert surface.rest is not None
    assert again.rest.to_dict() == surface.rest.to_dict()
    assert again.total_torque(speed=5.0, temperature=420.0) == surface.total_torque(
        speed=5.0, temperature=420.0
    )
    assert (
        again.total_torque(speed=5.0, temperature=420.0) > surface.torque(speed=5.0, temperature=420.0) + 0.02
    )
    broken: dict[str, Any] = json.loads(path.read_text())
    broken["fit"]["rest"]["covariance"] = [[1.0]]
    path.write_text(json.dumps(broken))
    with pytest.raises(
        ParameterError, match=r"fit.rest.covariance: it must be a covariance of three numbers"
    ):
        read_fit(path)


def test_at_the_belt_it_acts_at_the_radius_of_the_roll() -> None:
    at = stated().at_the_belt(0.015, AT + 50.0)
    assert at["rest_force"] == pytest.approx(0.9 * CONSTANT / 0.015)
    assert at["rest_damping"] == pytest.approx(0.9 * PER_SPEED / 0.015**2)
    assert at["rest_temperature_slope"] == pytest.approx(SLOPE / 0.9)


def test_beside_a_drag_table_it_is_that_of_one_temperature() -> None:
    table = hersey.DragTable((0.01, 0.1, 1.0), (80.0, 50.0, 70.0), stick_speed=0.01)
    drag = with_rest(table, stated(), 0.015, AT + 50.0)
    added = 0.9 * (CONSTANT / 0.015 + PER_SPEED / 0.015**2 * 0.1)
    assert drag.force(0.1) == pytest.approx(50.0 + added)
    with pytest.raises(ParameterError, match=r"a drag table holds at one temperature. Give temperature"):
        with_rest(table, stated(), 0.015, None)
    even = NoLoadTorque.stated(constant=CONSTANT, per_speed=PER_SPEED, uncertainty=0.1)
    assert with_rest(table, even, 0.015, None).rest_force == pytest.approx(CONSTANT / 0.015)


def test_motion_map_and_limits_count_film_and_rest() -> None:
    w, t = grid(np.geomspace(0.1, 15, 10), TEMPERATURES)
    corner = (t / 150.0) ** 3.0
    torque = 0.68 * (w / corner) ** np.where(w >= corner, 0.3, -0.2) + rest_torque(w, t)
    surface = hersey.fit(points_of(w, torque, t, error=1e-3).without(stated()))
    belt = {"roll_radius": 0.015, "stick_speed": 3e-4}
    for kelvin in (400.0, AT):
        for drag in (surface.drag(**belt, temperature=kelvin), surface.drag(**belt).at(kelvin)):
            for v in (0.005, 0.1):
                total = surface.total_torque(speed=v / 0.015, temperature=kelvin)
                assert drag.force(v) * 0.015 == pytest.approx(total, rel=1e-9)
    hot, limits = [400.0, AT], hersey.Limits(motor_torque=1.2)
    map_ = map_of(surface, hersey.Drivetrain(11e3, 11.0), **belt, limits=limits, temperatures=hot, draws=2)
    assert map_.state_at(temperature=AT, speed=0.1).torque == pytest.approx(
        surface.total_torque(speed=0.1 / 0.015, temperature=AT), rel=1e-9
    )
    for kelvin, speed in zip(hot, map_.stall_above, strict=True):
        assert surface.total_torque(speed=speed / 0.015, temperature=kelvin) == pytest.approx(1.2, rel=1e-9)


def test_draws_of_the_rest_have_its_errors() -> None:
    """As stated, 10 % at 95 %: both numbers go together, at the belt and at a temperature."""
    rest = hersey.NoLoadTorque.stated(
        constant=0.02, per_speed=1e-3, uncertainty=0.1, temperature_slope=-0.01, reference_temperature=400.0
    )
    drawn = rest.samples(20_000, 1, roll_radius=0.015, temperature=420.0)
    at = rest.at_the_belt(0.015, 420.0)
    for name, values in drawn.items():
        assert np.mean(values) == pytest.approx(at[name], rel=2e-3)
        assert np.std(values) == pytest.approx(np.log1p(0.1) / 1.96 * at[name], rel=0.03)
    assert np.corrcoef(*drawn.values())[0, 1] == pytest.approx(1.0)
    machine = machines_drawn(
        hersey.Drivetrain(1e4, 1.0),
        hersey.Drag(50, 0.03, -0.7, -1.2, stick_speed=3e-4, rest_force=1.0),
        {},
        drawn,
        np.random.default_rng(1),
        1,
    )[0][0]
    assert vars(machine.drag)["rest_force"] in drawn["rest_force"]


def test_errors_have_the_sense_of_rotation() -> None:
    """A rest known to 10 % (95 %): 0.02 + 0.001 w is off by ln 1.1 over 1.96, backwards the other way."""
    rest = NoLoadTorque.stated(constant=0.02, per_speed=0.001, uncertainty=0.1)
    forward, backward = rest.errors(np.array([5.0, -5.0]))
    np.testing.assert_allclose(backward, -forward, rtol=1e-12)
    assert np.linalg.norm(forward) == pytest.approx(np.log(1.1) * 0.025 / 1.96, rel=1e-4)
