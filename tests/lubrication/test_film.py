"""Contact, lubricant and film as a user meets them: tables, command, verdict, linter."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.charts.film import film_chart
from hersey.damping.fit import fit
from hersey.damping.surface import DampingSurface
from hersey.errors import HerseyError, ParameterError, UnitError
from hersey.lubrication.lubricant import EXAMPLES, ShearThinning
from hersey.machine.machine import Machine, read_machine
from hersey.verdict.contact_verdict import solved_exponent, verdict
from hersey.verdict.evidence import measured_film
from tests.cli.command import run
from tests.conftest import ROOT
from tests.verdict.said import check_film

TOML = (ROOT / "tests" / "stand" / "machine.toml").read_text()


@pytest.fixture(scope="module")
def machine() -> Machine:
    return read_machine(ROOT / "tests" / "stand" / "machine.toml")


def test_the_tables_are_read(machine: Machine) -> None:
    assert machine.contact is not None
    assert machine.lubricant is not None
    assert machine.contact.load == machine.limits.nip_load
    assert machine.contact.roll_radius == machine.roll_radius
    assert machine.contact.rubber_thickness == pytest.approx(3.5e-3)
    assert machine.lubricant.viscosity(373.15) == pytest.approx(47e-6 * 1900)
    assert machine.lubricant.alpha([300.0, 450.0]) == pytest.approx(20e-9)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('modulus = "1 MPa"', 'modulus = "1 mm"', ["contact.modulus", "mm"]),
        ('modulus = "1 MPa"', 'modulus = "1 MPa"\nshore_a = 30', ["either", "shore_a"]),
        ('modulus = "1 MPa"', "shore_a = 3", ["shore_a", "20"]),
        ("poisson_ratio = 0.48", "poisson_ratio = 0.6", ["poisson_ratio", "0.5"]),
        ('rubber_thickness = "3.5 mm"', "", ["lacks 'rubber_thickness'"]),
        ('rubber_thickness = "3.5 mm"', 'rubber_thickness = "30 mm"', ["rubber_thickness", "roll_radius"]),
        ('density = "1.9 g/cm^3"', "", ["kinematic", "density"]),
        ('["40 degC", "500 mm^2/s"]', '["40 degC", "5 mm^2/s"]', ["Were the two exchanged?"]),
        ('["40 degC", "500 mm^2/s"]', '["40 degC"]', ["list of pairs"]),
        ('["40 degC", "500 mm^2/s"]', '["40 degC", "500 kg"]', ["lubricant.viscosities", "kg"]),
        ('model = "walther"', 'model = "andrade"', ["andrade", "walther"]),
        ('model = "walther"', 'model = "vogel"', ["needs 3 pairs", "has 2"]),
        ('model = "walther"', 'model = "walther"\nexample = "cylinder oil"', ["both"]),
        ('uncertainty = "20 %"', "uncertainty = 0.2", ["20 %"]),
        ('conductivity = "0.1 W/m/K"', 'relaxation_time = "1 us"', ["carreau_exponent"]),
        ("[contact]", "[nip]", ["unknown table 'nip'"]),
        ("[contact]", "[contact]\nwidth = 3", ["unknown key 'width'"]),
    ],
)
def test_mistakes_are_named(tmp_path: Path, old: str, new: str, words: list[str]) -> None:
    assert old in TOML
    path = tmp_path / "machine.toml"
    path.write_text(TOML.replace(old, new, 1))
    with pytest.raises((ParameterError, UnitError)) as caught:
        read_machine(path)
    assert "machine.toml" in str(caught.value)
    for word in words:
        assert word in str(caught.value)


def test_an_example_lubricant_and_a_hardness(tmp_path: Path) -> None:
    text = TOML[: TOML.index("# What is in the nip")].replace('modulus = "1 MPa"', "shore_a = 40", 1)
    path = tmp_path / "machine.toml"
    path.write_text(text + '[lubricant]\nexample = "cylinder oil"\n')
    machine = read_machine(path)
    assert machine.lubricant == EXAMPLES["cylinder oil"]
    assert machine.contact is not None
    assert machine.contact.modulus == pytest.approx(1.69e6, rel=0.01)


def test_the_measured_film_is_eta_a_over_b_with_rolling_as_predicted(
    points: hersey.SteadyPoints, surface: DampingSurface, machine: Machine
) -> None:
    assert machine.contact is not None
    assert machine.lubricant is not None
    measured = measured_film(points, surface, machine.contact, machine.lubricant, grip=0.6)
    i = 7
    belt = points.column("speed")[i] * machine.contact.roll_radius
    damping = points.column("torque")[i] / machine.contact.roll_radius / belt
    area = float(hersey.nip_width(machine.contact)) * machine.contact.length
    eta = machine.lubricant.viscosity(points.column("temperature")[i])
    film = measured.predicted
    share = film.shear[i] / film.shear_factor[i] / film.torque[i]  # of plain shear
    assert 0.5 < share < 0.98
    assert measured.thickness[i] == pytest.approx(eta * area / damping / share)
    assert (measured.low < measured.thickness).all()
    assert (measured.thickness < measured.high).all()
    assert measured.systematic == pytest.approx(np.exp(np.hypot(np.log(1.2), np.log(1.1))))
    assert measured.sommerfeld_number[i] * machine.contact.load == pytest.approx(
        eta * belt * machine.contact.length
    )
    pressure = machine.contact.nip.pressure_mean
    assert measured.hersey_number[i] == pytest.approx(eta * belt / pressure)


def test_what_the_film_made_is_found_again(points: hersey.SteadyPoints, machine: Machine) -> None:
    # Torque made by the predicted film itself: calibration 1, measured film the predicted one.
    assert machine.contact is not None
    assert machine.lubricant is not None
    made = hersey.drag_torque(
        machine.contact,
        machine.lubricant,
        speed=points.column("speed"),
        temperature=points.column("temperature"),
    )
    table = points.table.with_columns(torque=made, torque_error=1e-3 * made)
    synthetic = replace(points, table=table)
    refit = fit(synthetic, temperature_scale="K")
    measured = measured_film(synthetic, refit, machine.contact, machine.lubricant)
    assert measured.calibration.value == pytest.approx(1.0, rel=1e-9)
    film = measured.predicted
    assert measured.thickness == pytest.approx(film.central * film.factor, rel=1e-9)
    says = verdict(measured, refit, machine.contact, machine.lubricant, hersey.regime(synthetic, refit))
    (soft,) = (p for p in says.predictions if p.name == "soft EHL")
    assert soft.low < says.exponent.value < soft.high
    assert soft.low < says.expected < soft.high
    kept = [p.name for p in says.predictions if p.consistent]
    assert "soft EHL" in kept
    assert not {"constant film", "dry Coulomb friction or a rigid film", "falling branch"} & set(kept)
    assert "contradict" not in says.text
    assert says.solved is not None
    assert says.expected == pytest.approx(says.solved, abs=0.01)


def test_the_verdict_on_the_bench(
    points: hersey.SteadyPoints, surface: DampingSurface, machine: Machine
) -> None:
    assert machine.contact is not None
    assert machine.lubricant is not None
    measured = measured_film(points, surface, machine.contact, machine.lubricant, grip=0.6)
    says = verdict(measured, surface, machine.contact, machine.lubricant, hersey.regime(points, surface))
    assert "this contact is isoviscous-elastic" in says.text
    assert "does not apply" in says.text
    assert [p.name for p in says.predictions if p.holds_here] == ["soft EHL"]
    notes = " ".join(check_film(machine, measured.predicted, measured))
    for words in (
        "too high for a film",
        "pressure does not thicken",
        "extrapolated",
        "times the prediction",
    ):
        assert words in notes
    panels = film_chart(measured.predicted, ["a"] * len(points), measured).to_dict()["vconcat"]
    assert len(panels) == 2


def test_the_linter_sees_what_disagrees(machine: Machine) -> None:
    assert machine.contact is not None
    assert machine.lubricant is not None
    thick = replace(machine.contact, rubber_thickness=14e-3, load=30.0, roll_radius=16e-3, roughness=None)
    wrong = replace(machine, contact=thick)
    film = hersey.film_thickness(thick, machine.lubricant, speed=5.0, temperature=350.0)
    notes = " ".join(check_film(wrong, film))
    for words in ("nip/h", "[drivetrain] roll_radius", "[limits] nip_load"):
        assert words in notes
    soft = replace(machine.contact, load=3000.0)
    film = hersey.film_thickness(soft, machine.lubricant, speed=5.0, temperature=350.0)
    assert "strain of the layer" in " ".join(check_film(replace(machine, contact=soft), film))
    clean = replace(machine.contact, roughness=1e-8)
    film = hersey.film_thickness(clean, machine.lubricant, speed=5.0, temperature=360.0)
    notes = check_film(replace(machine, contact=clean), film)
    assert [note for note in notes if "alpha p" not in note] == []


def test_corrections_are_factors_with_flags(machine: Machine) -> None:
    assert machine.contact is not None
    assert machine.lubricant is not None
    thinning = ShearThinning(relaxation_time=1e-4, exponent=0.6)
    lubricant = replace(machine.lubricant, thinning=thinning)
    film = hersey.film_thickness(machine.contact, lubricant, speed=8.0, temperature=400.0, supply=1e-6)
    assert set(film.corrections) == {"shear thinning", "inlet heating", "starvation"}
    product = np.prod([c.factor for c in film.corrections.values()])
    assert film.factor == pytest.approx(float(product))
    assert all(0 < float(c.factor) < 1 for c in film.corrections.values())
    assert float(film.central * film.corrections["starvation"].factor) < 1e-6
    thin = hersey.drag_torque(machine.contact, lubricant, speed=8.0, temperature=400.0)
    full = hersey.drag_torque(machine.contact, machine.lubricant, speed=8.0, temperature=400.0)
    assert thin < full


def test_impossible_values_raise(machine: Machine) -> None:
    assert machine.contact is not None
    assert machine.lubricant is not None
    for wrong in (0.0, np.nan, np.inf):
        with pytest.raises(HerseyError, match="speed"):
            hersey.film_thickness(machine.contact, machine.lubricant, speed=[1.0, wrong], temperature=400.0)
    with pytest.raises(HerseyError, match="temperature"):
        hersey.film_thickness(machine.contact, machine.lubricant, speed=1.0, temperature=-5.0)
    with pytest.raises(HerseyError, match="governing"):
        hersey.drag_torque(machine.contact, machine.lubricant, speed=1.0, temperature=400.0, law="best")
    with pytest.raises(HerseyError, match="layer"):
        hersey.nip_width(machine.contact, rule="best")
    with pytest.raises(HerseyError, match="half-width"):
        hersey.nip_width(machine.contact, load=1e9)


def test_the_command(examples_here: Path) -> None:
    done = run("film", "examples/machine.toml", cwd=examples_here)
    assert done.returncode == 0, done.stderr
    for words in ("full speed", "180 °C", "3.22 µm", "isoviscous-elastic", "mN·m"):
        assert words in done.stdout
    assert "mean speed u" not in done.stdout
    done = run("film", "examples/machine.toml", "--verbose", cwd=examples_here)
    for words in ("nip ", "E' =", "full speed", "isoviscous-elastic", "mean speed u", "alpha p ="):
        assert words in done.words
    done = run(
        "film", "examples/machine.toml", "--log", "examples/bench.csv", "--tare", "standing", "--json",
        "--figure", "film.svg", cwd=examples_here,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    assert document["film"]["names"] == ["full speed", "thick paper"]
    assert len(document["measured"]["thickness"]) == len(document["measured"]["low"])
    assert document["verdict"] == document["exponents"]["text"]
    assert {law["law"] for law in document["laws"]} >= {"paper", "isoviscous-elastic"}
    assert all(law["convention"] for law in document["laws"])
    assert (examples_here / "film.svg").read_text().startswith("<svg")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["examples/machine.toml", "--belt-speed", "1 mm/s"], ["--at"]),
        (["examples/machine.toml", "--tare", "standing"], ["--log"]),
        (["examples/machine.toml", "--figure", "film.txt"], [".png"]),
    ],
)
def test_mistakes_of_the_command(examples_here: Path, arguments: list[str], words: list[str]) -> None:
    done = run("film", *arguments, cwd=examples_here)
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    for word in words:
        assert word in done.stderr


def test_the_solver_explains_the_exponent(machine: Machine) -> None:
    """Solved numerically, the soft nip has the exponent of the soft regime, less what its layer takes off."""
    assert machine.contact is not None
    solved = solved_exponent(machine.contact, EXAMPLES["cylinder oil"], speed=8.0, temperature=363.0)
    assert solved == pytest.approx(-0.58, abs=0.04)
    assert solved_exponent(machine.contact, EXAMPLES["spindle oil"], speed=1e-9, temperature=363.0) is None
