"""What dwells say of the film, number by number, and the linter sentence by sentence."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import polars as pl
import pytest
from scipy import stats

import hersey
from hersey.charts.film import film_chart
from hersey.damping.estimate import Estimate
from hersey.damping.surface import DampingSurface
from hersey.errors import InsufficientDataError, ParameterError
from hersey.lubrication.contact import Contact
from hersey.lubrication.film import drag_torque, film_thickness
from hersey.lubrication.film_result import Correction, Film
from hersey.lubrication.lubricant import Lubricant
from hersey.machine.machine import Machine, read_machine
from hersey.schema.warning import Warning
from hersey.verdict.checks import nip_warnings
from hersey.verdict.contact_verdict import Verdict, verdict
from hersey.verdict.evidence import MeasuredFilm, measured_film
from hersey.verdict.regime import Regime, regime
from hersey.verdict.transition import ContactTransition
from tests.conftest import ROOT
from tests.verdict.cases import RANGES, alone, holm, seen
from tests.verdict.said import check_film

GAS = 8.31446261815324


@pytest.fixture(scope="module")
def machine() -> Machine:
    return read_machine(ROOT / "tests" / "stand" / "machine.toml")


@pytest.fixture(scope="module")
def contact(machine: Machine) -> Contact:
    assert machine.contact is not None
    return machine.contact


@pytest.fixture(scope="module")
def oil(machine: Machine) -> Lubricant:
    assert machine.lubricant is not None
    return machine.lubricant


@pytest.fixture(scope="module")
def measured(
    points: hersey.SteadyPoints, surface: DampingSurface, contact: Contact, oil: Lubricant
) -> MeasuredFilm:
    return measured_film(points, surface, contact, oil, grip=0.6)


def test_the_interval_of_the_film_holds_torque_scatter_viscosity_and_nip(
    points: hersey.SteadyPoints, surface: DampingSurface, contact: Contact, measured: MeasuredFilm
) -> None:
    statistics = surface.statistics
    t = stats.t.ppf(0.975, statistics.points - statistics.variables)
    torque = np.abs(points.column("torque"))
    relative = np.hypot(points.column("torque_error"), points.tare_error) / torque
    visits = sum(shared.deviation**2 for shared in statistics.shared)
    random = t * np.sqrt(relative**2 + statistics.scatter**2 + visits)
    stated = np.log(1.2) ** 2 + np.log(1.1) ** 2
    reach = np.exp(np.sqrt(random**2 + stated))
    np.testing.assert_allclose(measured.high / measured.thickness, reach, rtol=1e-12)
    np.testing.assert_allclose(measured.thickness / measured.low, reach, rtol=1e-12)
    assert contact.roughness is not None
    np.testing.assert_allclose(measured.lambda_ratio, measured.thickness / contact.roughness, rtol=1e-12)


def test_what_is_not_stated_widens_nothing(
    points: hersey.SteadyPoints, surface: DampingSurface, contact: Contact, oil: Lubricant
) -> None:
    bare = measured_film(
        points,
        surface,
        replace(contact, nip_uncertainty=None, roughness=None),
        replace(oil, uncertainty=None),
    )
    assert bare.systematic == 1.0
    assert bare.lambda_ratio is None
    assert bare.grip is None


def test_numbers_of_a_dwell_by_hand(
    points: hersey.SteadyPoints,
    surface: DampingSurface,
    contact: Contact,
    oil: Lubricant,
    measured: MeasuredFilm,
) -> None:
    for i in (0, 11, -1):
        w, torque = abs(points.column("speed")[i]), abs(points.column("torque")[i])
        kelvin = float(points.column("temperature")[i])
        eta, belt = float(oil.viscosity(kelvin)), w * 15e-3
        assert measured.friction[i] == pytest.approx(torque / (15e-3 * 300.0), rel=1e-12)
        assert measured.hersey_number[i] == pytest.approx(
            eta * belt * contact.nip.width * 0.22 / 300.0, rel=1e-12
        )
        assert measured.sommerfeld_number[i] == pytest.approx(eta * belt * 0.22 / 300.0, rel=1e-12)
        area, film = contact.nip.width * 0.22, measured.predicted
        more = film.torque[i] / (film.shear[i] / film.shear_factor[i])  # inlet and pressure
        assert measured.thickness[i] == pytest.approx(eta * area * w * 15e-3**2 / torque * more, rel=1e-9)
        at = surface.transition_speed(kelvin)
        assert measured.on_film[i] == float(w >= at)
        alone = drag_torque(contact, oil, speed=w, temperature=kelvin)
        assert measured.predicted_torque[i] == pytest.approx(float(alone), rel=1e-12)
    assert set(measured.on_film) == {0.0, 1.0}
    assert measured.grip == 0.6


def test_the_calibration_is_the_mean_of_the_rising_branch(measured: MeasuredFilm) -> None:
    on = measured.on_film > 0.5
    logs = np.log(measured.torque[on] / measured.predicted_torque[on])
    error = logs.std(ddof=1) / np.sqrt(logs.size)
    t = stats.t.ppf(0.975, logs.size - 1)
    found = measured.calibration
    assert found.value == pytest.approx(np.exp(logs.mean()), rel=1e-12)
    assert found.error == pytest.approx(found.value * error, rel=1e-12)
    assert found.low == pytest.approx(np.exp(logs.mean() - t * error), rel=1e-12)
    assert found.high == pytest.approx(np.exp(logs.mean() + t * error), rel=1e-12)


def test_an_isothermal_log_needs_its_temperature(
    points: hersey.SteadyPoints, surface: DampingSurface, contact: Contact, oil: Lubricant
) -> None:
    cold = replace(points, table=points.table.with_columns(temperature=np.full(len(points), np.nan)))
    with pytest.raises(InsufficientDataError, match=r"Give that of the film, temperature=453.15"):
        measured_film(cold, surface, contact, oil)
    stated = measured_film(cold, surface, contact, oil, temperature=430.0)
    assert set(stated.temperature) == {430.0}


@pytest.fixture(scope="module")
def log_says(points: hersey.SteadyPoints, surface: DampingSurface) -> Regime:
    return regime(points, surface)


@pytest.fixture(scope="module")
def says(
    measured: MeasuredFilm, surface: DampingSurface, contact: Contact, oil: Lubricant, log_says: Regime
) -> Verdict:
    return verdict(measured, surface, contact, oil, log_says)


def test_each_prediction_has_its_probability(says: Verdict, surface: DampingSurface) -> None:
    found = {p.name: p for p in says.predictions}
    assert list(found) == [*RANGES, "falling branch"]
    for name, expected in holm(alone(surface.c)).items():
        assert found[name].p_value == pytest.approx(expected, rel=1e-9), name
        assert found[name].consistent == (expected > 0.05)
    assert [p.name for p in says.predictions if p.consistent] == ["Dowson-Higginson EHL"]


def test_probabilities_near_the_level(
    measured: MeasuredFilm, surface: DampingSurface, contact: Contact, oil: Lubricant, log_says: Regime
) -> None:
    """A damping exponent 1.9 and 2.1 errors from a prediction, and 1.5 above -1, where one side counts."""
    freedom = surface.statistics.points - surface.statistics.variables
    first = verdict(measured, surface, contact, oil, log_says)
    (soft,) = (p for p in first.predictions if p.name == "soft EHL")
    assert -0.6 < soft.low < soft.high < -0.5
    for value, name in (
        (soft.low - 0.02, "soft EHL"),
        (soft.high + 0.019, "soft EHL"),
        (-0.985, "falling branch"),
    ):
        c = Estimate(value, 0.01, value - 0.02, value + 0.02, freedom)
        found = verdict(measured, replace(surface, c=c), contact, oil, log_says)
        p = next(p.p_value for p in found.predictions if p.name == name)
        sides, away = (1, 1.5) if name == "falling branch" else (2, 2.0 if value < soft.low else 1.9)
        times = (
            2 if name == "falling branch" else 1
        )  # level torque is likelier, all others are refuted before
        assert p == pytest.approx(times * sides * stats.t.sf(away, freedom), rel=1e-6)


def test_exponents_expected_of_this_contact(
    says: Verdict, measured: MeasuredFilm, surface: DampingSurface, contact: Contact, oil: Lubricant
) -> None:
    speed = float(np.exp(np.log(measured.speed).mean()))
    kelvin = float(measured.temperature.mean())
    step = np.exp([-1e-3, 1e-3])
    by_speed = drag_torque(contact, oil, speed=speed * step, temperature=kelvin)
    by_heat = drag_torque(contact, oil, speed=speed, temperature=kelvin * step)
    assert says.expected == pytest.approx(np.log(by_speed[1] / by_speed[0]) / 2e-3 - 1.0, abs=1e-5)
    assert says.thermal_expected == pytest.approx(np.log(by_heat[1] / by_heat[0]) / 2e-3, abs=1e-4)
    assert surface.b is not None
    assert says.thermal is not None
    scale = kelvin / (kelvin - 273.15)
    assert says.thermal.freedom == surface.b.freedom
    for name in ("value", "error", "low", "high", "systematic"):
        assert getattr(says.thermal, name) == pytest.approx(scale * getattr(surface.b, name), rel=1e-12)
    assert says.activation_energy == pytest.approx(-GAS * kelvin * scale * surface.b.value, rel=1e-9)
    assert says.viscosity_activation_energy == pytest.approx(float(oil.activation_energy(kelvin)), rel=1e-12)


def test_a_fit_in_kelvin_is_taken_as_it_is(
    measured: MeasuredFilm, surface: DampingSurface, contact: Contact, oil: Lubricant, log_says: Regime
) -> None:
    found = verdict(measured, replace(surface, temperature_scale="K"), contact, oil, log_says)
    assert found.thermal is not None
    assert surface.b is not None
    assert found.thermal.value == surface.b.value


def test_the_verdict_in_whole_sentences(says: Verdict, log_says: Regime) -> None:
    assert log_says.named is None  # a rigid film beside a little friction measures that exponent too
    assert says.thermal is not None
    agrees = says.thermal.low <= says.thermal_expected <= says.thermal.high
    sentences = (
        "By the regime chart this contact is isoviscous-elastic, and damping should vary as "
        f"speed^{says.expected:.2f}; measured: {says.exponent}. "
        f"A numerical solution for this nip gives the exponent {says.solved:.2f}. ",
        "From the log alone no regime can be named",
        " Eq. 5 (Dowson-Higginson) does not apply to this contact. "
        f"The exponent of damping in temperature (K) is {says.thermal}; the film of this lubricant predicts "
        f"{says.thermal_expected:.2f}, which {'agrees' if agrees else 'disagrees'}.",
    )
    places = [says.text.find(sentence) for sentence in sentences]
    assert places[0] >= 0
    assert places == sorted(places)
    assert says.text.endswith(sentences[-1])


def test_where_the_log_names_no_regime_the_contact_names_none(
    measured: MeasuredFilm, surface: DampingSurface, contact: Contact, oil: Lubricant, log_says: Regime
) -> None:
    def text(value: float, says: Regime) -> str:
        c = Estimate(value, 1e-3, value - 2e-3, value + 2e-3)
        return verdict(measured, replace(surface, c=c), contact, oil, says).text

    same = text(-0.58, seen(log_says, "soft EHL"))
    assert "The measured exponent agrees with that regime." in same
    assert "Log and film theory disagree" not in same
    # the exponent is that of the regime chart, but the log does not let it be named
    for value, keys in ((-0.58, ("soft EHL", "THAT")), (-0.3, ("THIS", "THAT"))):
        unnamed = text(value, seen(log_says, None, *keys))
        assert "From the log alone no regime can be named" in unnamed
        assert "agrees with that regime" not in unnamed
    other = text(-0.7, seen(log_says, "Dowson-Higginson EHL"))
    assert "Log and film theory disagree" in other
    assert "agrees with that regime" not in other


def test_the_exponent_of_temperature_agrees_within_its_interval(
    measured: MeasuredFilm, surface: DampingSurface, contact: Contact, oil: Lubricant, log_says: Regime
) -> None:
    thermal = verdict(measured, surface, contact, oil, log_says).thermal_expected
    at = float(measured.temperature.mean())
    share = (at - 273.15) / at
    for off, words in ((0.0, "which agrees."), (0.2, "which disagrees.")):
        b = Estimate(thermal * share + off, 0.01, thermal * share + off - 0.02, thermal * share + off + 0.02)
        assert verdict(measured, replace(surface, b=b), contact, oil, log_says).text.endswith(words)


def film_at(
    contact: Contact, oil: Lubricant, *, speed: float = 5.0, kelvin: float | list[float] = 350.0
) -> Film:
    return film_thickness(contact, oil, speed=speed, temperature=kelvin)


EXTRAPOLATED = "viscosity is extrapolated: known from 40 degC to 100 degC, used from {} degC to {} degC"


@pytest.mark.parametrize(
    ("celsius", "shown"),
    [
        ([20.0, 90.0], ("20", "90")),
        ([39.0, 90.0], ("39", "90")),
        ([50.0, 120.0], ("50", "120")),
        ([50.0, 101.0], ("50", "101")),
        ([20.0, 120.0], ("20", "120")),
        ([39.6, 100.4], None),
    ],
)
def test_extrapolation_is_said_of_the_cold_and_the_hot(
    machine: Machine, contact: Contact, oil: Lubricant, celsius: list[float], shown: tuple[str, str] | None
) -> None:
    notes = check_film(machine, film_at(contact, oil, kelvin=[t + 273.15 for t in celsius]))
    found = [note for note in notes if note.startswith("viscosity is extrapolated")]
    assert found == ([] if shown is None else [EXTRAPOLATED.format(*shown)])


def test_statements_that_disagree(machine: Machine, contact: Contact, oil: Lubricant) -> None:
    other = replace(contact, roll_radius=16e-3, load=310.0)
    notes = check_film(replace(machine, contact=other), film_at(other, oil))
    assert (
        "[contact] roll_radius is 16 mm, but [drivetrain] roll_radius is 15 mm. Use the same value in both"
    ) in notes
    assert "[contact] load is 310 N, but [limits] nip_load is 300 N. Use the same value in both" in notes
    near = replace(contact, roll_radius=15.1e-3, load=302.0)
    assert not [
        n for n in check_film(replace(machine, contact=near), film_at(near, oil)) if n.startswith("[")
    ]


def test_the_lambda_ratio_is_named_by_its_band(machine: Machine, contact: Contact, oil: Lubricant) -> None:
    least = float(film_at(contact, oil).lambda_ratio(1.0))
    for ratio, kind, limit in ((0.5, "boundary", 1), (2.0, "mixed", 3)):
        rough = replace(contact, roughness=least / ratio)
        assert (
            "predicted lambda ratio (minimum film over composite rms roughness) falls to "
            f"{ratio:.2g}; below {limit} lubrication is {kind} by convention"
        ) in check_film(replace(machine, contact=rough), film_at(rough, oil))
    smooth = replace(contact, roughness=least / 3.1)
    assert not [
        n for n in check_film(replace(machine, contact=smooth), film_at(smooth, oil)) if "lambda" in n
    ]


def test_nip_strain_and_inlet(machine: Machine, contact: Contact, oil: Lubricant) -> None:
    thick = replace(contact, rubber_thickness=9e-3, load=60.0)
    nip = thick.nip
    off = 100 * (nip.paper_width / nip.width - 1)
    assert (
        f"nip/h = {nip.paper_width / 9e-3:.2g} is outside the range of Eq. 8, 1 to 4, "
        f"which is {off:+.0f} % off the solved nip"
    ) in check_film(replace(machine, contact=thick), film_at(thick, oil))
    pressed = replace(contact, load=900.0)
    share = 100 * (pressed.nip.width / 2) ** 2 / (2 * 15e-3 * 3.5e-3)
    assert share > 15
    assert (
        f"the strain of the layer (a^2/(2 R h)) is {share:.0f} %; linear elasticity holds only up to about "
        "15 %"
    ) in check_film(replace(machine, contact=pressed), film_at(pressed, oil))
    film = film_at(contact, oil)
    short = "the inlet is not short compared with layer and nip, so the soft-EHL law is only approximate"
    assert short not in check_film(machine, film)
    assert short in check_film(machine, replace(film, inlet_short=np.array(False)))
    rigid = replace(film, inlet_short=np.array(False), regime=np.array(0))
    assert short not in check_film(machine, rigid)


def test_what_is_said_of_the_lubricant(machine: Machine, contact: Contact, oil: Lubricant) -> None:
    film = film_at(contact, oil)
    thickening = 20e-9 * contact.nip.pressure_max
    assert (
        f"pressure does not thicken this lubricant here (alpha p = {thickening:.2g}), so Eqs. 5, 9 "
        "and 10 do not apply"
    ) in check_film(machine, film)
    hard = replace(oil, pressure_viscosity=((300.0, 0.11 / contact.nip.pressure_max),))
    notes = check_film(replace(machine, lubricant=hard), film_at(contact, hard))
    assert not [n for n in notes if n.startswith("alpha p")]
    flagged = replace(
        film, corrections={"starvation": Correction(np.array([0.5, 0.25]), np.array([True, False]))}
    )
    assert "starvation: the factor (as low as 0.25) is outside the valid range of its formula" in check_film(
        machine, flagged
    )
    fine = replace(
        film, corrections={"starvation": Correction(np.array([0.5, 0.25]), np.array([True, True]))}
    )
    assert not [n for n in check_film(machine, fine) if n.startswith("starvation")]


def test_shear_that_warms(machine: Machine, contact: Contact, oil: Lubricant) -> None:
    eta = float(oil.viscosity(350.0))
    for rise, said in ((2.5, True), (1.9, False)):
        speed = np.sqrt(rise * 8 * 0.1 / eta) / 15e-3
        text = f"shear heats the film by up to {rise:.2g} K above its walls, so it is thinner than stated"
        assert (text in check_film(machine, film_at(contact, oil, speed=float(speed)))) == said


def test_what_is_said_of_a_log(machine: Machine, measured: MeasuredFilm) -> None:
    film, on = measured.predicted, measured.on_film

    def notes(**changed: object) -> tuple[str, ...]:
        quiet = {
            "friction": np.full(on.size, 0.2),
            "grip": None,
            "calibration": Estimate(1.0, 0.1, 0.8, 1.2),
            "lambda_ratio": np.full(on.size, 2.0),
        }
        return check_film(machine, film, replace(measured, **(quiet | changed)))  # type: ignore[arg-type]

    alone = check_film(machine, film)

    def more(**changed: object) -> tuple[str, ...]:
        return tuple(note for note in notes(**changed) if note not in alone)

    assert notes() == alone
    assert more(friction=np.full(on.size, 0.35)) == (
        "friction coefficient 0.35 is too high for a film. Above 0.3, surfaces touch or torque "
        "contains more than the nip's drag",
    )
    assert more(grip=0.15) == (
        "friction coefficient 0.2 exceeds that of the grip, 0.15, so the drive would slip",
    )
    assert notes(grip=0.25) == alone
    for value, said in ((3.1, True), (2.9, False), (0.3, True), (0.35, False)):
        text = (
            f"measured torque is {value:.3g} times the prediction. Viscosity or nip is not as stated, or "
            "torque contains more than the film, which also changes the exponents"
        )
        assert (text in notes(calibration=Estimate(value, 0.1, value, value))) == said
    rough = np.where(on > 0.5, 0.8, 0.1)
    assert more(lambda_ratio=rough) == (
        "on the rising branch the measured film falls to 0.8 of the roughness (1.5 "
        "um), so film thickness alone does not explain the torque",
    )
    assert notes(lambda_ratio=np.where(on > 0.5, 1.1, 0.1)) == alone


def test_what_does_not_fit_is_ranked(machine: Machine, measured: MeasuredFilm) -> None:
    """By how many times it is off: torque of 58 times is farther off than friction of 0.5."""
    changed = replace(
        measured,
        friction=np.full(measured.friction.size, 0.5),
        calibration=Estimate(58.0, 1.0, 55.0, 61.0),
        grip=None,
        lambda_ratio=np.full(measured.friction.size, 0.75),
    )
    found = nip_warnings(machine, measured.predicted, changed)
    sizes = [each.number("off") for each in found if each.severity != "note"]
    assert len(sizes) >= 3
    assert sizes == sorted(sizes, reverse=True)
    assert found[0].text.startswith("Measured torque is 58 times")
    assert found[0].number("off") == pytest.approx(58 / 3)
    assert found[0].severity == "act"
    by_kind = {each.kind: each for each in found}
    assert by_kind["friction above a film"].number("off") == pytest.approx(0.5 / 0.3)
    assert by_kind["measured film below roughness"].number("off") == pytest.approx(1 / 0.75)
    assert by_kind["measured film below roughness"].severity == "watch"
    weak = replace(changed, calibration=Estimate(1 / 58, 0.1, 0.01, 0.02))
    assert nip_warnings(machine, measured.predicted, weak)[0].number("off") == pytest.approx(58 / 3)


def test_an_exponent_is_off_by_its_interval(machine: Machine, measured: MeasuredFilm) -> None:
    c, thermal = Estimate(-0.9, 0.02, -0.94, -0.86), Estimate(-5.0, 0.25, -5.5, -4.5, None, 0.1)

    def off(contradicted: bool, expected: float, solved: float | None, heat: float) -> list[Warning]:
        says = Verdict(c, expected, solved, (), thermal, heat, None, 1.0, contradicted, "any words")
        found = nip_warnings(machine, measured.predicted, None, says)
        return [each for each in found if each.kind.startswith("exponent")]

    [one] = off(True, -0.6, -0.58, -5.6)
    assert "the film of this nip predicts -0.58" in one.text
    assert one.number("off") == pytest.approx(0.32 / 0.04)
    assert off(False, -0.6, None, -4.4) == []
    [other] = off(False, -0.6, None, -3.5)
    assert other.number("off") == pytest.approx(1.5 / 0.5)
    assert "predicts -3.50" in other.text


def test_a_transition_is_off_by_the_interval_of_the_log(machine: Machine, measured: MeasuredFilm) -> None:
    def turn(speed: list[float], low: list[float], high: list[float]) -> list[Warning]:
        kelvin, ones = np.array([363.0, 453.0]), np.ones(2)
        of = ContactTransition(kelvin, np.array(speed), ones, np.array(low), np.array(high), ones, ones)
        found = nip_warnings(machine, measured.predicted, turn=of)
        return [each for each in found if each.kind == "transition"]

    assert turn([1.05, 0.95], [0.9, 0.9], [1.1, 1.1]) == []
    [one] = turn([1.05, 1.21], [0.9, 0.9], [1.1, 1.1])
    assert "At 180 degC" in one.text
    assert one.number("off") == pytest.approx(2.0)
    [slow] = turn([0.81, 1.0], [0.9, 0.9], [1.2, 1.2])
    assert slow.number("off") == pytest.approx(2.0)
    assert turn([9.0, 9.0], [0.0, 0.1], [np.inf, np.inf]) == []  # not told
    [none] = turn([np.nan, 1.0], [0.9, 0.9], [1.1, 1.1])
    assert "At 90 degC the contact model has no torque minimum" in none.text


def test_a_machine_without_its_tables(machine: Machine, contact: Contact, oil: Lubricant) -> None:
    film = film_at(contact, oil)
    for name in ("contact", "lubricant"):
        with pytest.raises(ParameterError, match=rf"the machine has no \[{name}\]. Add it to machine.toml"):
            check_film(replace(machine, **{name: None}), film)  # type: ignore[arg-type]


def test_the_stribeck_curve_in_numbers(measured: MeasuredFilm) -> None:
    panel = film_chart(measured.predicted, ["a"] * measured.speed.size, measured).to_dict(validate=False)[
        "vconcat"
    ][1]
    line, _, rule, _, dots = (layer["data"]["values"] for layer in panel["layer"])
    assert [row["hersey"] for row in dots] == pytest.approx((1e6 * measured.hersey_number).tolist())
    assert [row["friction"] for row in dots] == pytest.approx(measured.friction.tolist())
    order = np.argsort(measured.hersey_number)
    film = measured.predicted_torque * measured.calibration.value / (15e-3 * 300.0)
    assert [row["hersey"] for row in line] == pytest.approx((1e6 * measured.hersey_number[order]).tolist())
    assert [row["friction"] for row in line] == pytest.approx(film[order].tolist())
    rounded = [5.0 * round((t - 273.15) / 5) for t in measured.temperature]
    assert [row["level"] for row in dots] == rounded
    assert [(row["friction"], row["text"]) for row in rule] == [(0.6, "the drive slips (0.6)")]
    shown = panel["layer"][-1]["encoding"]["color"]["scale"]["domain"]
    assert shown == [90.0, 120.0, 150.0, 180.0]
    free = film_chart(measured.predicted, [], replace(measured, grip=None)).to_dict(validate=False)
    assert len(free["vconcat"][1]["layer"]) == 2


def test_the_regime_chart_in_numbers(contact: Contact, oil: Lubricant, measured: MeasuredFilm) -> None:
    film = film_thickness(contact, oil, speed=[1.0, 8.0], temperature=[320.0, 370.0])
    chart = film_chart(film, ["slow", "fast"]).to_dict(validate=False)
    cells, dots, marks, *texts = (layer["data"]["values"] for layer in chart["layer"])
    assert dots == []
    assert [row["name"] for row in marks] == ["slow", "fast"]
    for axis in ("g_v", "g_e"):
        assert [row[axis] for row in marks] == pytest.approx(getattr(film, axis).tolist())
    assert [row["h"] for row in marks] == pytest.approx((1e6 * film.minimum * film.factor).tolist(), rel=1e-3)
    assert [row["regime"] for row in marks] == film.regime_names()
    written = {value for rows in texts for row in rows for value in row.values()}
    assert {"slow", "fast", "isoviscous-elastic"} <= written
    # every point lies in a cell of its own regime
    for row in marks:
        held = [
            c["regime"]
            for c in cells
            if c["g_v"] <= row["g_v"] <= c["g_v2"] and c["g_e"] <= row["g_e"] <= c["g_e2"]
        ]
        assert row["regime"] in held
    domains = [chart["layer"][0]["encoding"][axis]["scale"]["domain"] for axis in ("x", "y")]
    for axis, (low, high), (least, most) in zip(("g_v", "g_e"), domains, ((-2, 4), (-1, 3)), strict=True):
        logs = np.log10(getattr(film, axis))
        assert np.log10(low) == pytest.approx(min(least, logs.min() - 1.5))
        assert np.log10(high) == pytest.approx(max(most, logs.max() + 1.5))
    with_log = film_chart(film, ["slow", "fast"], measured).to_dict(validate=False)["vconcat"][0]
    assert len(with_log["layer"][1]["data"]["values"]) == measured.speed.size
    bare = replace(oil, pressure_viscosity=())
    hidden = film_chart(film_thickness(contact, bare, speed=1.0, temperature=320.0), ["one"]).to_dict(
        validate=False
    )
    assert hidden["layer"][2]["data"]["values"] == []
    assert hidden["title"]["subtitle"][0].endswith(" No points: alpha is unknown, so g_V = 0.")


@pytest.mark.parametrize(("thickness", "load"), [(9e-3, 60.0), (0.9e-3, 300.0)])
def test_how_far_the_paper_s_nip_is_beyond_its_range(
    machine: Machine, contact: Contact, oil: Lubricant, thickness: float, load: float
) -> None:
    """So many times the bound, 1 below and 4 above."""
    other = replace(contact, rubber_thickness=thickness, load=load)
    ratio = other.nip.paper_width / thickness
    [found] = [
        m
        for m in nip_warnings(replace(machine, contact=other), film_at(other, oil))
        if "regression" in m.kind
    ]
    assert not 1.0 < ratio < 4.0
    assert found.number("off") == pytest.approx(1.0 / ratio if ratio < 1.0 else ratio / 4.0, rel=1e-12)


def test_the_thinnest_of_several_films_names_the_band(
    machine: Machine, contact: Contact, oil: Lubricant
) -> None:
    film = film_at(contact, oil, kelvin=[330.0, 420.0])
    cold, hot = film.lambda_ratio(1.0)
    rough = replace(contact, roughness=float(hot) / 0.25)
    assert cold / hot > 4.0  # more than 1 where it is cold
    thin = "predicted lambda ratio (minimum film over composite rms roughness) falls to 0.25"
    notes = check_film(replace(machine, contact=rough), film_at(rough, oil, kelvin=[330.0, 420.0]))
    assert f"{thin}; below 1 lubrication is boundary by convention" in notes


def test_a_recorded_load_is_that_of_the_dwells(
    points: hersey.SteadyPoints, surface: DampingSurface, contact: Contact, oil: Lubricant
) -> None:
    """At twice the load of the file, by hand from the wider nip."""
    pressed = replace(points, table=points.table.with_columns(pl.lit(600.0).alias("load")))
    found = measured_film(pressed, surface, contact, oil)
    w, torque = np.abs(points.column("speed")), np.abs(points.column("torque"))
    belt, eta = w * 15e-3, np.asarray(oil.viscosity(points.column("temperature")))
    width = replace(contact, load=600.0).nip.width
    assert width > 1.1 * contact.nip.width
    np.testing.assert_allclose(found.friction, torque / (15e-3 * 600.0), rtol=1e-12)
    np.testing.assert_allclose(found.hersey_number, eta * belt * width * 0.22 / 600.0, rtol=1e-12)
    np.testing.assert_allclose(found.sommerfeld_number, eta * belt * 0.22 / 600.0, rtol=1e-12)
