"""Laws of viscosity for a table: a line of ln viscosity on 1/T, done here."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from hersey.damping.candidates.viscosity import viscosity_laws
from hersey.errors import InsufficientDataError, ParameterError

R = 8.31446261815324
KELVIN = np.linspace(300.0, 420.0, 13)


def test_energy_of_an_arrhenius_table_is_that_of_a_line() -> None:
    off = 0.02 * np.array([1, -1, -1, 1, 1, -1, 1, -1, 1, 1, -1, -1, 1])
    found = viscosity_laws(KELVIN, 0.3 * np.exp(4200.0 * (1 / KELVIN - 1 / 350.0) + off))
    slope, level = np.polyfit(1 / KELVIN, 4200.0 / KELVIN + off, 1)
    energy = found.activation_energy
    assert energy.value == pytest.approx(R * slope, rel=1e-6)
    by_key = {r.candidate.key: r for r in found.candidates}
    fit = by_key["arrhenius/viscosity"].fit
    assert fit.residuals == pytest.approx(4200.0 / KELVIN + off - slope / KELVIN - level, abs=1e-7)
    # standard error of the slope at the scatter of the fit
    error = R * fit.scatter / np.sqrt(np.sum((1 / KELVIN - np.mean(1 / KELVIN)) ** 2))
    assert energy.error == pytest.approx(error, rel=1e-6)
    reach = stats.t.ppf(0.975, 11) * error
    assert (energy.low, energy.high) == pytest.approx((R * slope - reach, R * slope + reach), rel=1e-6)
    assert found.refused == ()
    # one law with a residual of a leave-one-out line
    missed = by_key["arrhenius/viscosity"].left_out
    assert missed is not None
    for i in (0, 6, 12):
        kept = np.arange(13) != i
        line = np.polyfit(1 / KELVIN[kept], (4200.0 / KELVIN + off)[kept], 1)
        assert missed[i] == pytest.approx(
            (4200.0 / KELVIN + off)[i] - np.polyval(line, 1 / KELVIN[i]), abs=1e-5
        )


def test_an_error_that_is_stated_leaves_no_scatter() -> None:
    off = 0.02 * np.array([1, -1, -1, 1, 1, -1, 1, -1, 1, 1, -1, -1, 1])
    value = 0.3 * np.exp(4200.0 / KELVIN + off)
    found = viscosity_laws(KELVIN, value, relative_error=0.05)
    fit = next(r.fit for r in found.candidates if r.candidate.key == "arrhenius/viscosity")
    assert fit.scatter == 0.0
    error = R * 0.05 / np.sqrt(np.sum((1 / KELVIN - np.mean(1 / KELVIN)) ** 2))
    assert found.activation_energy.error == pytest.approx(error, rel=1e-6)


def test_the_law_chosen_is_that_of_the_table() -> None:
    random = np.random.default_rng(3)
    noise = np.exp(0.003 * random.standard_normal(13))
    tables = {
        "arrhenius/viscosity": np.exp(4200.0 / KELVIN),
        "vft/viscosity": np.exp(900.0 / (KELVIN - 200.0)),
        "power-K/viscosity": (KELVIN / 350.0) ** -12,
        "power-degC/viscosity": (KELVIN - 273.15) ** -1.3,
    }
    for key, value in tables.items():
        found = viscosity_laws(KELVIN, value * noise)
        assert found.chosen.candidate.key == key
        assert found.chosen in found.candidates
        assert [r.delta_aicc for r in found.candidates] == sorted(r.delta_aicc for r in found.candidates)


def test_a_table_below_freezing_has_no_power_of_degrees_celsius() -> None:
    found = viscosity_laws(KELVIN - 40.0, np.exp(4200.0 / KELVIN))
    assert found.refused == (("power law in degC", "T^b is not defined at or below 0 degC"),)
    assert len(found.candidates) == 3


def test_repeats_of_a_temperature_are_left_out_together() -> None:
    kelvin = np.repeat([310.0, 340.0, 370.0, 400.0], 2)
    y = 4200.0 / kelvin + 0.02 * np.array([1, -1, 1, 1, -1, 1, -1, -1])
    found = viscosity_laws(kelvin[::-1], np.exp(y[::-1]))
    missed = next(r.left_out for r in found.candidates if r.candidate.key == "arrhenius/viscosity")
    assert missed is not None
    for hot in (310.0, 400.0):
        out = kelvin == hot
        line = np.polyfit(1 / kelvin[~out], y[~out], 1)
        assert missed[::-1][out] == pytest.approx(y[out] - np.polyval(line, 1 / kelvin[out]), abs=1e-5)


def test_what_is_no_table_is_refused() -> None:
    with pytest.raises(
        ParameterError, match=r"^kelvin and viscosity must be one-dimensional and of equal length$"
    ):
        viscosity_laws(KELVIN, np.ones(12))
    with pytest.raises(ParameterError, match="one-dimensional"):
        viscosity_laws(KELVIN.reshape(1, 13), np.ones((1, 13)))
    said = (
        "^viscosity and temperature must be positive$|^(kelvin|viscosity) is (NaN|infinite)|"
        "^kelvin is (0|-1) without a unit"
    )
    for bad in (0.0, -1.0, np.nan, np.inf):
        spoilt = np.where(KELVIN == 300.0, bad, KELVIN)
        for pair in ((spoilt, KELVIN), (KELVIN, spoilt)):
            with pytest.raises(ParameterError, match=said):
                viscosity_laws(*pair)
    with pytest.raises(
        InsufficientDataError,
        match=r"^no law of viscosity can be fitted: its 2 parameters need 5 dwells; the log has 4$",
    ):
        viscosity_laws(KELVIN[:4], np.ones(4))
    assert len(viscosity_laws(KELVIN[:5], np.exp(4200.0 / KELVIN[:5])).candidates) == 3
