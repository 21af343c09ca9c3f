"""Transition speed of the contact beside that of a log, and what the film part says of both."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import hersey
from hersey.charts import chart_of
from hersey.charts.transition import transition_chart
from hersey.errors import InsufficientDataError
from hersey.lubrication.film_temperature import film_temperature
from hersey.study.nip import film_document, shared_load
from hersey.units import rpm
from hersey.verdict.transition import contact_transition
from tests.conftest import ROOT

WARM = np.array([363.15, 453.15])


@cache
def machine() -> hersey.Machine:
    plain = hersey.read_machine(ROOT / "examples" / "machine.toml")
    asperities, boundary = hersey.Asperities(modulus="3 GPa"), hersey.BoundaryFriction(0.1)
    return replace(plain, asperities=asperities, boundary=boundary)


def mixed() -> hersey.MixedContact:
    contact = machine().mixed
    assert contact is not None
    return contact


@cache
def surface() -> hersey.DampingSurface:
    return hersey.fit(hersey.read(ROOT / "examples" / "bench.csv").steady(tare="standing"))


def test_the_contact_stands_beside_the_log() -> None:
    turn = contact_transition(mixed(), WARM, surface())
    assert turn.speed == pytest.approx(mixed().transition(WARM).speed)
    assert turn.measured == pytest.approx([surface().transition_speed(t) for t in WARM])
    assert np.all((turn.low < turn.measured) & (turn.measured < turn.high))
    assert turn.ratio == pytest.approx(turn.speed / turn.measured)
    assert len(turn.summary().splitlines()) == 4
    note = turn.warnings()[0]
    assert (note.number("speed"), note.number("ratio")) == (turn.speed[0], turn.ratio[0])
    assert f"at {rpm(turn.speed[0]):.3g} rpm in the contact model" in str(note)
    assert f"{turn.ratio[0]:.2f} times the measured {rpm(turn.measured[0]):.1f} rpm [" in str(note)


def test_the_interval_of_the_log_is_that_of_its_draws() -> None:
    found = surface()
    assert found.transition_estimate() == found.transition.speed  # type: ignore[union-attr]
    for kelvin in WARM.tolist():
        at = found.transition_estimate(kelvin)
        draws = found.drag_samples(4000, 1, roll_radius=1.0, stick_speed=1e-3, temperature=kelvin)
        low, high = np.quantile(draws["transition_speed"], [0.025, 0.975])
        assert np.log(at.high / at.low) == pytest.approx(np.log(high / low), rel=0.2)
        assert at.value == pytest.approx(found.transition_speed(kelvin))
        assert at.low < at.value < at.high


def test_without_a_log_or_a_minimum_it_is_said() -> None:
    turn = contact_transition(mixed(), WARM)
    assert "none shown" in turn.summary()
    assert "measured" not in str(turn.warnings()[0])
    flat = replace(machine(), boundary=hersey.BoundaryFriction(1e-6)).mixed
    assert flat is not None
    nowhere = contact_transition(flat, WARM, surface())
    assert "nowhere" in nowhere.summary()
    assert "no minimum" in str(nowhere.warnings()[0])
    assert json.dumps(nowhere.to_dict(), allow_nan=False)
    with pytest.raises(InsufficientDataError, match="no falling branch"):
        replace(surface(), transition=None).transition_estimate(400.0)


def test_heat_through_the_film_moves_it() -> None:
    contact = replace(mixed().contact, heat_flow=600.0, sensor_side="heater")
    heated = replace(machine(), contact=contact).mixed
    assert heated is not None
    turn = contact_transition(heated, WARM)
    plain = heated.transition(WARM).speed
    inside = film_temperature(contact, heated.lubricant, speed=plain, temperature=WARM)
    assert turn.speed == pytest.approx(heated.transition(inside).speed)
    assert np.all(turn.speed < 0.99 * plain)


def test_the_film_part_holds_both() -> None:
    contact, lubricant = machine().contact, machine().lubricant
    assert contact is not None
    assert lubricant is not None
    film = hersey.film_thickness(contact, lubricant, speed=[3.0, 8.0], temperature=453.15)
    shared = shared_load(machine(), film, None, surface())
    assert shared is not None
    assert "Transition speed" in str(chart_of(film, transition=shared.transition).to_dict(validate=False))
    fast = shared.warnings(["slow", "fast"])[1]
    assert (fast.kind, fast.where) == ("load shared", "fast")
    assert fast.number("torque") == np.ravel(shared.film.torque)[1]
    assert "slow" in shared.summary(["slow", "fast"])
    part = film_document(film, ["slow", "fast"], shared=shared)
    assert part.mixed is not None
    assert part.mixed.points.torque == pytest.approx(mixed().at(speed=[3.0, 8.0], temperature=453.15).torque)
    assert part.transition is not None
    turn = part.transition
    chart = transition_chart(turn).to_dict()
    dots = chart["layer"][2]["data"]["values"]
    assert [row["speed"] for row in dots] == pytest.approx([hersey.units.rpm(v) for v in turn.measured])
    assert shared_load(replace(machine(), asperities=None, boundary=None), film, None) is None


def test_the_error_of_the_transition_speed_is_that_of_numerical_derivatives() -> None:
    """At one Hersey number ln v = at - b/(1 + c) ln(T/T_ref), T in the scale of the law."""
    found = surface()
    assert found.transition is not None
    assert found.transition.freed is None
    values, covariance = found._closure
    zero, reference = found.temperature_zero, found.reference_temperature
    assert reference is not None
    b, c, at = 1, 2, found._law.index("at")
    for kelvin in WARM.tolist():
        x = np.log((kelvin - zero) / (reference - zero))

        def log_speed(v: np.ndarray, x: float = x) -> float:
            return float(v[at] - v[b] / (1.0 + v[c]) * x)

        steps = 1e-6 * np.eye(values.size)
        slopes = np.array([(log_speed(values + s) - log_speed(values - s)) / 2e-6 for s in steps])
        error = found.transition_estimate(kelvin).error / found.transition_speed(kelvin)
        assert error == pytest.approx(np.sqrt(slopes @ covariance @ slopes), rel=1e-6)
