"""Figs. 1 to 8: drawn to scale, of the numbers of log and model, with verdicts that follow them."""

from __future__ import annotations

import itertools
import json
import math
import runpy
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

from hersey import SteadyPoints
from hersey.charts.friction import along, friction_chart
from hersey.charts.render import specification_of
from hersey.errors import ParameterError
from hersey.lubrication.asperities import Asperities, BoundaryFriction
from hersey.lubrication.lubricant import Lubricant
from hersey.machine.limits import OperatingPoint
from hersey.machine.machine import Machine, read_machine
from hersey.units import ZERO_CELSIUS
from hersey.verdict.evidence import measured_film
from paper import Measured, PaperFigure, Verdict, as_json, drive_figures, markdown, nip
from paper import friction as fig8
from paper.cross_section import _roll, contact_of, film_at, has_nip
from paper.damping import crosses, crosses_hotter, in_range, is_power_law, local_exponents
from paper.drawing import Drawing, arc, round_number
from paper.system import forces_of, holds_on, motor_left
from paper.temperature import is_energy, is_straight
from paper.torque import agrees, bends, rises_as
from tests.charts.test_charts import titles
from tests.conftest import ROOT

HOLDS, IN_DIRECTION, FAILS = Verdict.HOLDS, Verdict.IN_DIRECTION, Verdict.FAILS
MACHINE = ROOT / "tests" / "paper" / "machine.toml"
#: Activation energy of torque in the synthetic dwells, J/mol.
ENERGY, GAS = 9460.77 * 4.184, 8.314462618


@pytest.fixture(scope="module")
def machine() -> Machine:
    return read_machine(MACHINE)


@pytest.fixture(scope="module")
def measured(points: SteadyPoints, machine: Machine) -> Measured:
    """Dwells of the test stand's law: exponents -0.7 and -1.2, a transition that moves with temperature.

    What the drive takes was measured with them and is subtracted.
    """
    assert machine.rest is not None
    whole = points.column("torque") + machine.rest.torque(points.column("speed"))
    return Measured.of(replace(points, table=points.table.with_columns(torque=whole)).without(machine.rest))


@pytest.fixture(scope="module")
def drawn(measured: Measured, machine: Machine) -> tuple[PaperFigure, ...]:
    figures, left_out = drive_figures(measured, machine)
    assert left_out == ()
    return figures


@pytest.fixture(scope="module")
def arrhenius() -> Measured:
    """Dwells without noise whose torque goes as speed^0.3 and as exp(E/(R T))."""
    speed, kelvin = (each.ravel() for each in np.meshgrid([5, 9, 16, 30, 55, 100], [363, 393, 423, 453]))
    noise = 1.0 + 1e-3 * np.random.default_rng(8).standard_normal(speed.size)
    torque = 0.02 * speed**0.3 * np.exp(ENERGY / GAS * (1 / kelvin - 1 / 400)) * noise
    table = {"speed [rpm]": speed, "torque [N*m]": torque, "temperature [K]": kelvin}
    return Measured.of(SteadyPoints.from_table(table))


def bent(measured: Measured, power: float) -> Measured:
    """The same dwells, torque times speed to a power."""
    column = pl.col("torque") * (pl.col("speed").abs() / 5.0) ** power
    return Measured(
        replace(measured.points, table=measured.points.table.with_columns(torque=column)), measured.surface
    )


def marks(specification: Any) -> list[Any]:
    """Every layer with rows of its own."""
    if isinstance(specification, list):
        return [each for part in specification for each in marks(part)]
    found = [specification] if "values" in specification.get("data", {}) else []
    for inside in ("layer", "vconcat", "hconcat"):
        found += marks(specification.get(inside, []))
    return found


# All of them


def test_all_eight_are_drawn_with_units(drawn: tuple[PaperFigure, ...]) -> None:
    assert [figure.number for figure in drawn] == list(range(1, 9))
    assert [figure.name for figure in drawn][::7] == ["figure-01", "figure-08"]
    for figure in drawn:
        for title in titles(specification_of(figure.chart)):
            assert "(" in title, title
        assert figure.claims
    assert "**Holds.**" in markdown(drawn)
    assert json.loads(as_json(drawn))["figures"][7]["data"]["friction (1)"]


def test_what_cannot_be_drawn_is_said(measured: Measured, machine: Machine) -> None:
    alone, left_out = drive_figures(measured)
    assert [figure.number for figure in alone] == [2, 3, 4, 7]
    assert "--machine" in left_out[0]
    bare = replace(machine, contact=None, lubricant=None, asperities=None, boundary=None, points=())
    alone, left_out = drive_figures(None, bare)
    assert [figure.number for figure in alone] == [6]
    assert sum("states no [contact]" in why for why in left_out) == 3
    with pytest.raises(ParameterError, match=r"\[asperities\] and \[boundary\]"):
        fig8.figure_8(replace(machine, asperities=None, boundary=None))
    with pytest.raises(ParameterError, match=r"\[\[points\]\]"):
        nip.figure_5(replace(machine, points=()))


def test_a_log_without_temperatures_has_no_fig_4(machine: Machine) -> None:
    table = {"speed [rpm]": [5, 8, 13, 20, 33, 50], "torque [mN*m]": [20.0, 22.9, 26.5, 30.3, 35.2, 39.9]}
    figures, left_out = drive_figures(Measured.of(SteadyPoints.from_table(table)), machine)
    assert [figure.number for figure in figures] == [1, 2, 3, 5, 6, 7, 8]
    assert "no temperatures" in left_out[0]


def test_the_example_draws_what_it_is_given(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("paper.all_figures", list)
    monkeypatch.setattr("paper.files.picture", lambda _, suffix: suffix.encode())
    script = ROOT / "examples" / "08_paper_figures.py"
    monkeypatch.setattr(sys, "argv", [str(script), str(tmp_path), "--machine", str(MACHINE)])
    runpy.run_path(str(script), run_name="__main__")
    assert "Figs. 2, 3, 4 and 7 are left out: they need a log, --log" in capsys.readouterr().out
    assert sorted(path.name for path in tmp_path.glob("*.svg")) == [f"figure-0{n}.svg" for n in (1, 5, 6, 8)]


# Figs. 2, 3, 4 and 7: the log


def test_the_exponents_are_those_of_the_stand(measured: Measured) -> None:
    assert rises_as(measured).verdict is HOLDS
    assert list(rises_as(measured).numbers.values()) == pytest.approx([0.3] * 4, abs=0.02)
    assert bends(measured).verdict is HOLDS
    assert in_range(measured).verdict is HOLDS
    assert is_power_law(measured).verdict is HOLDS
    assert crosses(measured).verdict is HOLDS
    assert crosses_hotter(measured).verdict is HOLDS
    assert list(crosses(measured).numbers.values())[:2] == pytest.approx([-1.2, -1.2], abs=0.03)


def test_other_exponents_other_verdicts(measured: Measured, arrhenius: Measured) -> None:
    steep = bent(arrhenius, 0.2)
    assert (rises_as(steep).verdict, in_range(steep).verdict) == (IN_DIRECTION, IN_DIRECTION)
    line = bent(arrhenius, 0.7)
    assert (rises_as(line).verdict, in_range(line).verdict, bends(line).verdict) == (FAILS, FAILS, FAILS)
    falls = bent(arrhenius, -0.5)
    assert falls.rising == []
    assert [each.falls for each in falls.branches] == [True] * 4
    assert (rises_as(falls).verdict, crosses(falls).verdict) == (FAILS, FAILS)
    assert crosses_hotter(falls).verdict is FAILS
    assert is_straight(falls).verdict is HOLDS
    local = {kelvin: exponents for kelvin, _, exponents in local_exponents(measured)}
    coldest, hottest = min(local), max(local)  # type: ignore[type-var]
    assert local[coldest] == pytest.approx(np.full(9, -0.7), abs=0.12)
    assert local[hottest][:3] == pytest.approx(np.full(3, -1.2), abs=0.08)


def test_the_activation_energy_is_found(arrhenius: Measured, machine: Machine) -> None:
    found = is_straight(arrhenius)
    assert found.verdict is HOLDS
    assert found.numbers["energy_of_torque"] == pytest.approx(ENERGY, rel=1e-3)
    assert "9461" in found.evidence or "946" in found.evidence
    points = ((363.0, math.exp(ENERGY / 0.3 / GAS / 363)), (453.0, math.exp(ENERGY / 0.3 / GAS / 453)))
    scaled = tuple((kelvin, value / points[1][1] * 1e-3) for kelvin, value in points)
    right = replace(machine, lubricant=Lubricant("arrhenius", scaled))
    assert is_energy(arrhenius, right).verdict is HOLDS
    assert is_energy(arrhenius, machine).verdict is not HOLDS


def test_eq_9_is_judged_by_exponent_and_level(arrhenius: Measured, machine: Machine) -> None:
    found = agrees(arrhenius, machine)
    assert found is not None
    ratio = found.numbers["measured_over_equation_9"]
    column = pl.col("torque") / ratio
    table = arrhenius.points.table.with_columns(torque=column)
    scaled = Measured(replace(arrhenius.points, table=table), arrhenius.surface)
    again = agrees(scaled, machine)
    assert again is not None
    assert again.numbers["measured_over_equation_9"] == pytest.approx(1.0, rel=1e-9)
    assert (found.verdict, again.verdict) == (IN_DIRECTION, HOLDS)
    assert agrees(arrhenius, None) is None


# Figs. 1, 5 and 6: drawings


def test_the_roll_is_to_scale(machine: Machine) -> None:
    contact = contact_of(machine)
    for heater in (math.inf, 0.05, -0.05):
        sheet = Drawing((-20.0, 20.0), (-40.0, 10.0), 5.0)
        curved = replace(contact, heater_radius=heater)
        centre = _roll(sheet, curved)
        rim, core = (layer.to_dict(validate=False)["data"]["values"] for layer in sheet._layers[:2])
        away = [math.dist((row["x"], row["y"]), centre) for row in rim]
        assert max(away) == pytest.approx(1e3 * contact.roll_radius)
        flat = [row for row, far in zip(rim, away, strict=True) if far < max(away) - 1e-9]
        pressed = 1e3 * curved.nip.half_width
        assert max(row["x"] for row in flat) == pytest.approx(pressed, rel=0.06)
        assert all(row["y"] == pytest.approx(row["x"] ** 2 / (2e3 * heater), abs=1e-9) for row in flat)
        assert max(math.dist((row["x"], row["y"]), centre) for row in core) == pytest.approx(
            1e3 * (contact.roll_radius - contact.rubber_thickness)
        )


def test_eq_8_is_judged_by_the_layer(machine: Machine) -> None:
    contact = contact_of(machine)
    assert has_nip(contact).numbers["nip_width_layer"] == pytest.approx(contact.nip.width)
    assert has_nip(replace(contact, rubber_thickness=14e-3)).verdict is not HOLDS


def test_the_film_is_drawn_as_exaggerated_as_said(drawn: tuple[PaperFigure, ...]) -> None:
    specification = specification_of(drawn[4].chart)
    lower = specification["vconcat"][1]
    scales = [
        mark["encoding"] for mark in marks(lower) if "film" in json.dumps(mark["encoding"].get("y", {}))
    ]
    (low, high), (left, right) = (scales[0][axis]["scale"]["domain"] for axis in ("y", "x"))
    factor = lower["height"] / (1e-3 * (high - low)) / (lower["width"] / (right - left))
    said = float(specification["title"]["subtitle"].split("drawn ")[1].split()[0])
    assert factor == pytest.approx(said, rel=0.15)


def test_what_the_film_hangs_on(machine: Machine) -> None:
    film = film_at(machine, machine.points[0])
    found = nip.exponents(film)
    assert found["speed"] == pytest.approx(0.6, abs=1e-9)
    again = replace(machine, contact=replace(contact_of(machine), load=330.0))
    moved = float(film_at(again, machine.points[0]).central / film.central)
    assert math.log(moved) / math.log(1.1) == pytest.approx(found["load"], abs=0.02)
    assert nip.hangs_on(film).verdict is IN_DIRECTION
    assert nip.is_sheared(film).numbers["rolling_share"] == pytest.approx(
        float(film.rolling / film.torque), rel=1e-12
    )


def test_forces_are_those_of_log_and_file(measured: Measured, machine: Machine) -> None:
    forces = dict(forces_of(machine, measured))
    assert forces["greatest drag of the log"] == pytest.approx(measured.torque.max() / machine.roll_radius)
    assert forces["grip of the roll, µ N"] == machine.limits.grip
    drag = measured.surface.drag(temperature=measured.groups[-1][0], **machine.belt)
    assert forces["to break a stuck belt away"] == pytest.approx(drag.breakaway_force)

    def judged(grip: float) -> Verdict:
        limits = replace(machine.limits, roll_friction=grip / contact_of(machine).load)
        return holds_on(replace(machine, limits=limits), measured).verdict

    most = forces["greatest drag of the log"]
    assert most < drag.breakaway_force
    assert judged(1.1 * drag.breakaway_force) is HOLDS
    assert judged(1.1 * most) is IN_DIRECTION
    assert judged(0.9 * most) is FAILS


def test_pieces_of_a_drawing() -> None:
    assert [round_number(value) for value in (0.99, 1.0, 4.9, 72.0, 2e3)] == [0.5, 1.0, 2.0, 50.0, 2000.0]
    assert arc((1.0, 2.0), 3.0, 0.0, math.pi / 2, 3)[-1] == pytest.approx((1.0, 5.0))
    sheet = Drawing((0.0, 4.0), (0.0, 2.0), 50.0)
    sheet.arrow((0.0, 0.0), (3.0, 0.0))
    head = sheet._layers[1].to_dict(validate=False)["data"]["values"]
    assert (max(row["x"] for row in head), min(row["x"] for row in head)) == (3.0, pytest.approx(3.0 - 0.18))
    assert sheet.size == (200.0, 100.0)


# Fig. 8


def test_the_model_goes_from_dry_friction_to_the_film(machine: Machine) -> None:
    mixed = machine.mixed
    assert mixed is not None
    contact = mixed.contact
    model = along(mixed, 453.15, np.array([1e-16, 1e-6]))
    assert model.friction[0] == pytest.approx(mixed.friction.coefficient, rel=0.01)
    assert model.shear[-1] == pytest.approx(model.friction[-1], rel=1e-6)
    at = 150
    viscosity = float(mixed.lubricant.viscosity(453.15))
    speed = model.hersey[at] * contact.nip.pressure_mean / (viscosity * contact.roll_radius)
    torque = float(mixed.at(speed=speed, temperature=453.15).torque)
    assert model.friction[at] == pytest.approx(torque / (contact.roll_radius * contact.load), rel=1e-9)


def test_fig_8_shows_regimes_softly_and_where_the_drive_stalls(machine: Machine) -> None:
    limits = {"grip": machine.limits.roll_friction, "motor": 40.0}
    chart = friction_chart(None, machine.mixed, temperature=453.15, **limits)
    layers = marks(specification_of(chart))
    dark = [row["dark"] for row in layers[0]["data"]["values"]]
    assert all(b <= a + 1e-9 for a, b in itertools.pairwise(dark))
    assert max(abs(a - b) for a, b in itertools.pairwise(dark)) < 0.05
    names = [row["name"] for row in layers[1]["data"]["values"]]
    assert names[-2:] == ["mixed", "film"]
    rules = [layer for layer in layers if layer["mark"]["type"] == "rule"]
    assert [row["friction"] for row in rules[0]["data"]["values"]] == [machine.limits.roll_friction]
    assert "motor stalls at 40, beyond the chart" in json.dumps(chart.to_dict(validate=False)["title"])


def test_fig_8_is_judged_by_the_dwells(measured: Measured, machine: Machine) -> None:
    assert machine.lubricant is not None
    film = measured_film(measured.points, measured.surface, contact_of(machine), machine.lubricant)
    assert fig8.turns(film).verdict is HOLDS
    assert fig8.turns(replace(film, friction=film.hersey_number**-0.5)).verdict is FAILS
    one = replace(film, friction=film.hersey_number**0.3)
    assert fig8.collapses(one).verdict is HOLDS
    assert fig8.collapses(one).numbers["scatter"] == pytest.approx(0.0, abs=1e-9)
    apart = np.exp(0.02 * (film.temperature - 400.0))
    assert fig8.collapses(replace(one, friction=one.friction * apart)).verdict is not HOLDS
    most = float(film.friction.max())
    assert fig8.drives(film, {"grip": 1.01 * most, "motor": None}).verdict is HOLDS
    assert fig8.drives(film, {"grip": 2.0 * most, "motor": 0.99 * most}).verdict is IN_DIRECTION
    assert fig8.drives(film, {"grip": None, "motor": None}).verdict is FAILS


def test_the_motor_gives_less_what_the_rest_takes(machine: Machine) -> None:
    assert machine.rest is not None
    assert motor_left(machine) == pytest.approx(1.0 - 0.18 - 1e-3 * 0.2 / machine.roll_radius)
    assert fig8.motor_friction(machine) == pytest.approx(motor_left(machine) / (0.015 * 300.0))
    assert motor_left(replace(machine, rest=None)) == 1.0
    with pytest.raises(ParameterError, match=r"no \[lubricant\]"):
        film_at(replace(machine, lubricant=None), OperatingPoint("p", 0.1, ZERO_CELSIUS + 180.0))


def test_boundary_friction_with_a_slope_has_a_curve_of_its_own(machine: Machine) -> None:
    sloped = replace(
        machine, boundary=BoundaryFriction(0.05, -2e-4, 453.15), asperities=Asperities(modulus=2e9)
    )
    assert sloped.mixed is not None
    cold, hot = (
        float(along(sloped.mixed, kelvin, np.array([1e-16])).friction[0]) for kelvin in (363.0, 453.15)
    )
    assert cold > hot
