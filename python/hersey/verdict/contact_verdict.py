"""What the measured exponents say of a contact, beside those that film theory predicts for it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from hersey import _core
from hersey.cache.kept import kept
from hersey.damping.estimate import Estimate
from hersey.damping.surface import DampingSurface
from hersey.errors import ParameterError, UnfinishedError
from hersey.lubrication.contact import Contact
from hersey.lubrication.film_result import REGIMES
from hersey.lubrication.film_temperature import film_temperature
from hersey.lubrication.lubricant import Lubricant
from hersey.lubrication.reynolds import ElasticLayer, ThickeningFluid, exponent, solve_line_contact
from hersey.result import Result, table_of
from hersey.units import celsius
from hersey.verdict.contact_regimes import contact_regimes, damping_exponent, thermal_exponent
from hersey.verdict.evidence import MeasuredFilm
from hersey.verdict.regime import Regime
from hersey.verdict.regimes import Hypothesis, judged, listed

if TYPE_CHECKING:
    import polars as pl


@dataclass(frozen=True, repr=False)
class Verdict(Result):
    """Measured exponents against those predicted for this contact."""

    not_stated = ("contradicted",)

    exponent: Estimate  #: of damping in speed, above the transition
    expected: float  #: of damping in speed by the governing law for this contact, with corrections
    solved: float | None  #: the same with pressure and film solved numerically; None if no solution is found
    predictions: tuple[Hypothesis, ...]
    thermal: Estimate | None  #: d ln B/d ln T at the middle of the log, T in K
    thermal_expected: float  #: the same by the governing law and the lubricant
    activation_energy: float | None  #: apparent, of torque, J/mol
    viscosity_activation_energy: float  #: of the lubricant there, J/mol
    contradicted: bool  #: whether the log excludes every film that theory allows this contact
    text: str

    def summary(self) -> str:
        """Return what the exponents say of this contact."""
        return self.text

    def to_frame(self) -> pl.DataFrame:
        """Return measured and expected exponents and energies."""
        return table_of(
            [
                ("exponent of speed", self.exponent.value, ""),
                ("expected exponent of speed", self.expected, ""),
                ("solved exponent of speed", self.solved, ""),
                ("exponent of temperature", None if self.thermal is None else self.thermal.value, ""),
                ("expected exponent of temperature", self.thermal_expected, ""),
                ("activation energy of torque", self.activation_energy, "J/mol"),
                ("activation energy of viscosity", self.viscosity_activation_energy, "J/mol"),
            ]
        )


def verdict(
    measured: MeasuredFilm, surface: DampingSurface, contact: Contact, lubricant: Lubricant, seen: Regime
) -> Verdict:
    """Return what the exponents say of this contact.

    Parameters
    ----------
    seen
        What the log alone says: where it names no regime, neither does this.
    """
    film = measured.predicted
    held = REGIMES[int(np.bincount(film.regime.ravel(), minlength=4).argmax())]
    branch = measured.on_film > 0.5 if (measured.on_film > 0.5).any() else slice(None)
    table = contact_regimes(
        contact, lubricant, speed=measured.speed[branch], temperature=measured.temperature[branch]
    )
    predictions = judged(surface.c, film=held, table=table)
    speed = float(np.exp(np.log(measured.speed).mean()))
    kelvin = float(measured.temperature.mean())
    at = np.array(speed), np.array(kelvin)
    expected = float(damping_exponent(contact, lubricant, *at))
    inside = film_temperature(contact, lubricant, speed=speed, temperature=kelvin)
    solved = solved_exponent(contact, lubricant, speed, float(inside))
    thermal_expected = float(thermal_exponent(contact, lubricant, *at))
    thermal = _thermal(surface, kelvin)
    energy = None if thermal is None else -_core.GAS_CONSTANT * kelvin * thermal.value
    lubricant_energy = float(lubricant.activation_energy(kelvin))
    ours = [p.name for p in predictions if p.holds_here]
    live = any(e.key.startswith(name) for e in seen.explanations for name in ours)
    excluded = ours if seen.lack_of_fit is not None and not live else None
    text = _text(seen, surface.c, expected, solved, excluded, held, thermal, thermal_expected)
    return Verdict(
        exponent=surface.c,
        expected=expected,
        solved=solved,
        predictions=predictions,
        thermal=thermal,
        thermal_expected=thermal_expected,
        activation_energy=energy,
        viscosity_activation_energy=lubricant_energy,
        contradicted=excluded is not None,
        text=text,
    )


@kept()
def solved_exponent(contact: Contact, lubricant: Lubricant, speed: float, temperature: float) -> float | None:
    """Return the exponent of damping in speed of this contact, by its numerical solution.

    The layer is bonded to the roll, the film isothermal, Newtonian and fully flooded.
    None where the solver finds no solution.

    Parameters
    ----------
    speed
        Of the roll, rad/s.
    temperature
        Of the film, K.
    """
    try:
        solution = solve_line_contact(
            contact.reduced_radius,
            contact.load_per_length,
            0.5 * speed * contact.roll_radius,
            ThickeningFluid(float(lubricant.viscosity(temperature)), float(lubricant.alpha(temperature))),
            effective_modulus=contact.effective_modulus,
            layer=ElasticLayer(contact.rubber_thickness, contact.poisson_ratio),
        )
    except (ParameterError, UnfinishedError):
        return None
    return exponent("damping", solution)


def _thermal(surface: DampingSurface, kelvin: float) -> Estimate | None:
    """The exponent of damping in absolute temperature, whatever the scale of the fit."""
    if surface.b is None:
        return None
    scale = 1.0 if surface.temperature_scale == "K" else kelvin / celsius(kelvin)
    b = surface.b
    low, high = sorted((b.low * scale, b.high * scale))
    return Estimate(b.value * scale, b.error * abs(scale), low, high, b.freedom, b.systematic * abs(scale))


def _text(
    seen: Regime,
    c: Estimate,
    expected: float,
    solved: float | None,
    excluded: list[str] | None,
    held: str,
    thermal: Estimate | None,
    thermal_expected: float,
) -> str:
    """The verdict in words; ``excluded`` are films of theory that the log excludes, None if none."""
    lines = []
    if excluded is not None:
        ours = f"{listed(excluded)}, alone or with a constant torque"
        films = ours if excluded else "every film of the theory"
        lines.append(f"Log and film theory disagree: the log excludes {films}.")
    lines += [
        f"By the regime chart this contact is {held}, and damping should vary as "
        f"speed^{expected:.2f}; measured: {c}."
    ]
    if solved is not None:
        lines.append(f"A numerical solution for this nip gives the exponent {solved:.2f}.")
    if seen.named is None:
        lines.append("From the log alone no regime can be named.")
    elif excluded is None:
        lines.append("The measured exponent agrees with that regime.")
    if held != "piezoviscous-elastic":
        lines.append("Eq. 5 (Dowson-Higginson) does not apply to this contact.")
    if thermal is not None:
        lines.append(
            f"The exponent of damping in temperature (K) is {thermal}; the film of this lubricant predicts "
            f"{thermal_expected:.2f}, {_agreement(thermal, thermal_expected)}."
        )
    return " ".join(lines)


def _agreement(measured: Estimate, expected: float) -> str:
    """Whether an exponent agrees with the one expected, errors of the sensors allowed for."""
    if not measured.estimable:
        return "which these data cannot test"
    return "which agrees" if agrees(measured, expected) else "which disagrees"


def agrees(measured: Estimate, expected: float) -> bool:
    """Return whether a value lies in an interval, errors of the sensors allowed for."""
    return measured.low - measured.systematic <= expected <= measured.high + measured.systematic
