"""The curve of film and asperities as a law of drag curves."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.damping.curves import fit_curves
from hersey.damping.curves.shared_load import least, shared_load_shape
from hersey.log.means import read_means

MACHINE = hersey.read_machine(Path(__file__).parents[3] / "examples" / "machine.toml")
HOT = 453.15


def _contact() -> hersey.MixedContact:
    contact = MACHINE.mixed
    assert contact is not None
    return contact


def test_the_curve_is_the_drag_of_the_contact() -> None:
    """Over boundary friction at rest, against viscosity times speed over the reference of the film."""
    contact, shape = _contact(), shared_load_shape(_contact(), HOT)
    speeds = np.geomspace(0.05, 60.0, 25)
    film = contact.at(speed=speeds, temperature=HOT)
    torque = film.boundary_torque + film.shear_torque + film.rolling_torque
    x = np.log(contact.product(speeds, np.full(speeds.size, HOT)) / contact.reference)
    at_rest = 300.0 * 0.05 * 0.015  # load, friction and radius of the file
    assert np.exp(shape.curve(x[None], np.zeros((1, 1)))[0]) == pytest.approx(torque / at_rest, rel=2e-4)


def test_places_of_the_table_are_those_that_a_search_finds() -> None:
    curve = shared_load_shape(_contact(), HOT).curve
    grid, asperities, film = (getattr(curve, name) for name in ("grid", "asperities", "film"))
    random = np.random.default_rng(4)
    beside = np.nextafter(grid, random.choice([-np.inf, np.inf], grid.size))
    x = np.concatenate([grid, beside, random.uniform(-40.0, 40.0, 10_000)])[None]
    own = np.array([[0.3]])
    searched = np.interp(x, grid, asperities), np.interp(x, grid, film)
    assert np.array_equal(curve(x, own), np.log(searched[0] + np.exp(searched[1] + own)))
    unknown = curve(np.array([[np.nan, 0.0]]), own)
    assert np.isnan(unknown).tolist() == [[True, False]]


def test_twice_the_film_is_twice_the_drag_where_the_film_carries_all() -> None:
    shape = shared_load_shape(_contact(), HOT)
    fast, slow = np.array([[6.0]]), np.array([[-9.0]])
    doubled = np.array([[np.log(2.0)]])
    one = np.zeros((1, 1))
    assert (shape.curve(fast, doubled) - shape.curve(fast, one)).item() == pytest.approx(
        np.log(2.0), abs=1e-6
    )
    assert shape.curve(slow, doubled).item() == pytest.approx(0.0, abs=3e-3)
    place, drag = least(shape)
    around = shape.curve(np.array([[place - 0.1, place + 0.1]]), one)
    assert np.all(around > drag)


def test_a_log_of_the_contact_is_explained_by_it(tmp_path: Path) -> None:
    """Dwells of the contact, with other roughness, viscosity and friction than stated: its law is likeliest.

    The likeliest place of least drag is that of the contact.
    """
    contact = _contact()
    random = np.random.default_rng(3)
    rows, scaled = [], np.geomspace(0.4, 50.0, 14)
    for speed in np.repeat(scaled, 3).tolist():
        film = contact.at(speed=1.4 * speed, temperature=HOT)
        torque = float(film.torque) + 0.2 * float(film.boundary_torque)
        rows.append(f"{speed:.9g},{torque * np.exp(0.003 * random.standard_normal()):.9g}")
    path = tmp_path / "means.csv"
    path.write_text("\n".join(["Speed [rad/s],Torque [N*m]", *rows]) + "\n")
    points = hersey.SteadyPoints.from_table(read_means([path], isothermal=True))
    surface = hersey.fit(points)
    mixture = fit_curves(points, surface, contact)
    named = {law.name: law for law in mixture.table}
    assert not named["mixed"].rejected
    assert named["mixed"].weight > 0.5
    assert "mixed" not in {law.name for law in fit_curves(points, surface).table}
    law = next(each for each in mixture.laws if each.shape.name == "mixed")
    fine = np.linspace(np.log(0.4), np.log(50.0), 2001) - np.log(mixture.dwells.reference_speed)
    lowest = np.exp(fine[np.argmin(law.log_torque(law.numbers[None], fine, 0.0)[0])])
    speeds = np.geomspace(0.4, 50.0, 2001)
    film = contact.at(speed=1.4 * speeds, temperature=HOT)
    true = speeds[np.argmin(film.torque + 0.2 * film.boundary_torque)]
    assert lowest * mixture.dwells.reference_speed == pytest.approx(true, rel=0.02)


def test_a_contact_without_friction_at_the_dwells_is_no_law(tmp_path: Path) -> None:
    """Friction of 180 degC that falls by 2.3 % per K is negative at 133 degC: the other laws stay."""
    contact = _contact()
    friction = hersey.BoundaryFriction(0.05, 0.05 * 0.023, HOT)
    sloped = replace(contact, friction=friction)
    path = tmp_path / "means.csv"
    rows = [
        f"{w:.6g},{0.3 * w**0.3 * (t / 120.0) ** -0.5:.6g},{t}"
        for t in (90.0, 120.0, 150.0)
        for w in np.geomspace(1.0, 30.0, 8).tolist()
    ]
    path.write_text("\n".join(["Speed [rad/s],Torque [N*m],Temperature [degC]", *rows]) + "\n")
    points = hersey.SteadyPoints.from_table(read_means([path]))
    names = {law.name for law in fit_curves(points, hersey.fit(points), sloped).table}
    assert "mixed" not in names
    assert "blend" in names
