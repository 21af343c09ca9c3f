"""From measurement to film: how thick, how loaded, and which regime the exponents speak for.

The measured film is delta = eta A/B, with B = torque/(omega R^2) the translational damping and A the area of
the nip, times what inlet, pressure and thinning make of it: predicted torque over that of plain shear of the
predicted film. A dwell with the predicted torque therefore has the predicted film. The Hersey number is
eta U/p (m) with p = N/(nip L), the Sommerfeld number eta U L/N (no unit), both with the sliding speed
U = omega R; the friction coefficient is torque/(R N).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from hersey import _core
from hersey.arrays import FloatArray
from hersey.damping.candidates.shared_errors import shared_variance
from hersey.damping.dwells import SteadyPoints, groups_of_temperature
from hersey.damping.estimate import Estimate, quantile
from hersey.damping.surface import DampingSurface
from hersey.errors import InsufficientDataError, ParameterError, Setting, UnfinishedError, way_in
from hersey.lubrication.contact import Contact, nip_width
from hersey.lubrication.film import film_thickness
from hersey.lubrication.film_result import REGIMES, Film
from hersey.lubrication.film_temperature import film_temperature
from hersey.lubrication.lubricant import Lubricant
from hersey.lubrication.reynolds import ElasticLayer, ThickeningFluid, exponent, solve_line_contact
from hersey.result import Means, Result, json_record, table_of
from hersey.units import celsius, takes_si
from hersey.verdict.contact_regimes import (
    contact_regimes,
    damping_exponent,
    on_rising_branch,
    thermal_exponent,
)
from hersey.verdict.regime import Regime
from hersey.verdict.regimes import Hypothesis, judged, listed

if TYPE_CHECKING:
    import polars as pl


@dataclass(frozen=True, repr=False)
class MeasuredFilm(Result):
    """What each dwell says of the film; arrays of shape (points,), SI.

    ``temperature`` is the one read; that of the film, to which viscosity belongs, is
    ``predicted.temperature``. ``low`` and ``high`` enclose ``thickness`` at 95 %: errors of torque and
    scatter between dwells, and what is stated of viscosity and nip (``systematic``, a factor common to all
    dwells, 1 if nothing is stated).
    ``grip`` is the friction at which the belt slips on the roll, if known.
    """

    speed: Annotated[FloatArray, Means(unit="rad/s")]
    temperature: Annotated[FloatArray, Means(unit="K")]
    torque: Annotated[FloatArray, Means(unit="N m")]
    thickness: Annotated[FloatArray, Means(unit="m")]
    low: Annotated[FloatArray, Means("95 %", "m")]
    high: Annotated[FloatArray, Means("95 %", "m")]
    systematic: Annotated[float, Means("factor common to all dwells")]
    friction: FloatArray
    hersey_number: Annotated[FloatArray, Means("eta U/p", "m")]
    sommerfeld_number: FloatArray
    lambda_ratio: FloatArray | None
    predicted: Film
    predicted_torque: Annotated[FloatArray, Means(unit="N m")]
    calibration: Annotated[Estimate, Means("measured over predicted torque")]
    on_film: Annotated[FloatArray, Means("1 on the rising branch, 0 on the falling one", open=True)]
    grip: float | None

    def summary(self) -> str:
        """Return the slowest, the middle and the fastest dwell of each temperature as text."""
        return "\n".join([*_dwell_lines(self), *_systematic_lines(self)])

    def headline(self) -> str:
        """Return how many dwells, and the range of the film."""
        film = 1e6 * self.thickness
        return f"{film.size} dwells, measured film {film.min():.3g} to {film.max():.3g} um"

    def to_dict(self) -> dict[str, Any]:
        """Return what each dwell says, and the predicted states, in SI."""
        return json_record({**vars(self), "predicted": self.predicted.states()})

    def to_frame(self) -> pl.DataFrame:
        """Return one row per dwell."""
        import polars as pl

        return pl.DataFrame(
            {
                "speed (rad/s)": self.speed,
                "temperature (K)": self.temperature,
                "torque (N m)": self.torque,
                "film (m)": self.thickness,
                "film low (m)": self.low,
                "film high (m)": self.high,
                "predicted film (m)": self.predicted.central * self.predicted.factor,
                "predicted torque (N m)": self.predicted_torque,
                "friction (1)": self.friction,
                "Hersey number (m)": self.hersey_number,
                "Sommerfeld number (1)": self.sommerfeld_number,
            }
        )


@takes_si(temperature="temperature")
def measured_film(
    points: SteadyPoints,
    surface: DampingSurface,
    contact: Contact,
    lubricant: Lubricant,
    *,
    temperature: float | None = None,
    grip: float | None = None,
) -> MeasuredFilm:
    """Return the film that the dwells measure, beside the predicted one.

    Parameters
    ----------
    points, surface
        Of a log, and the surface fitted to it.
    contact, lubricant
        The nip and what is in it.
    temperature
        K, of an isothermal log.
    grip
        Friction coefficient at which the belt slips on the roll.

    Raises
    ------
    InsufficientDataError
        If the log holds no temperature and none is given.
    """
    speed, torque = np.abs(points.column("speed")), np.abs(points.column("torque"))
    kelvin = np.asarray(points.column("temperature"), dtype=float)
    if surface.b is None or not np.isfinite(kelvin).all():
        if temperature is None:
            raise InsufficientDataError(
                "the log holds no temperatures: give that of the film, "
                f"{Setting('temperature', flag='--at').to('180 degC', python='453.15')}"
            )
        kelvin = np.full(speed.size, temperature)
    inside = film_temperature(contact, lubricant, speed=speed, temperature=kelvin)
    film = film_thickness(contact, lubricant, speed=speed, temperature=inside)
    expected = film.torque
    radius, nip = contact.roll_radius, film.nip
    load, width = _loaded(points, contact, nip.width)
    thickness = film.central * film.factor * (expected / torque) * (width / nip.width)
    variance = (points.column("torque_error") / torque) ** 2 + surface.statistics.scatter**2
    variance += np.sum(points.zero_errors**2, axis=1) / torque**2
    variance += shared_variance(surface.statistics.shared)
    relative = quantile(surface.freedom) * np.sqrt(variance)
    shares = [share for share in (lubricant.uncertainty, contact.nip_uncertainty) if share is not None]
    systematic = float(np.exp(np.sqrt(sum(np.log1p(share) ** 2 for share in shares))))
    reach = np.exp(np.hypot(relative, np.log(systematic)))
    sliding = speed * radius
    rises = on_rising_branch(surface, speed, kelvin)
    roughness = contact.roughness
    return MeasuredFilm(
        speed=speed,
        temperature=kelvin,
        torque=torque,
        thickness=thickness,
        low=thickness / reach,
        high=thickness * reach,
        systematic=systematic,
        friction=torque / (radius * load),
        hersey_number=film.viscosity * sliding * width * contact.length / load,
        sommerfeld_number=film.viscosity * sliding * contact.length / load,
        lambda_ratio=None if roughness is None else thickness / roughness,
        predicted=film,
        predicted_torque=expected,
        calibration=_mean_ratio(torque[rises], expected[rises])
        if rises.any()
        else _mean_ratio(torque, expected),
        on_film=rises.astype(float),
        grip=grip,
    )


def _loaded(points: SteadyPoints, contact: Contact, width: float) -> tuple[FloatArray, FloatArray]:
    """Load of each dwell, N, as the log has it or else the contact, and the nip's width under it, m."""
    loads = points.table["load"] if "load" in points.table.columns else None
    if loads is None or loads.null_count():
        return np.full(len(points), contact.load), np.full(len(points), width)
    recorded = loads.to_numpy()
    return recorded, np.asarray(nip_width(contact, load=recorded))


def _mean_ratio(measured: FloatArray, expected: FloatArray) -> Estimate:
    logs = np.log(measured / expected)
    mean = float(logs.mean())
    error = float(logs.std(ddof=1) / np.sqrt(logs.size)) if logs.size > 1 else 0.0
    reach = quantile(logs.size - 1) * error
    value = float(np.exp(mean))
    ends = float(np.exp(mean - reach)), float(np.exp(mean + reach))
    return Estimate(value, value * error, *ends, max(logs.size - 1, 1))


@dataclass(frozen=True, repr=False)
class Verdict(Result):
    """Measured exponents against those predicted for this contact."""

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

    def to_dict(self) -> dict[str, Any]:
        """Return exponents, predictions and text; energies in J/mol."""
        known = {name: value for name, value in vars(self).items() if name != "contradicted"}
        return json_record({**known, "predictions": [h.to_dict() for h in self.predictions]})

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
        ours = f"{listed(excluded)}, alone or beside a constant torque"
        films = ours if excluded else "every film of theory"
        lines.append(f"Log and film theory contradict each other: the log excludes {films}.")
    lines += [
        f"The regime chart puts this contact in the {held} regime, where damping goes as speed to the power "
        f"{expected:.2f}; measured {c}."
    ]
    if solved is not None:
        lines.append(f"Solved numerically for this roll, the film gives the power {solved:.2f}.")
    if seen.named is None:
        lines.append("The log alone names no regime.")
    elif excluded is None:
        lines.append("The measured exponent is the one of that regime.")
    if held != "piezoviscous-elastic":
        lines.append(
            "Eq. 5 of the paper (Dowson-Higginson) does not apply to this contact, whatever the exponent."
        )
    if thermal is not None:
        lines.append(
            f"With temperature (K) damping goes to the power {thermal}; the film of this lubricant predicts "
            f"{thermal_expected:.2f}, {_agreement(thermal, thermal_expected)}."
        )
    return " ".join(lines)


def _agreement(measured: Estimate, expected: float) -> str:
    """Whether an exponent agrees with the one expected, errors of the sensors allowed for."""
    if not measured.told:
        return "which these data do not test"
    return "which agrees" if agrees(measured, expected) else "which disagrees"


def agrees(measured: Estimate, expected: float) -> bool:
    """Return whether a value lies in an interval, errors of the sensors allowed for."""
    return measured.low - measured.systematic <= expected <= measured.high + measured.systematic


def _dwell_lines(measured: MeasuredFilm) -> list[str]:
    lines = [
        f"  {'degC':>6s} {'rad/s':>7s} {'measured film um':>28s} {'predicted':>10s} {'friction':>9s} "
        f"{'eta U/p um':>11s} {'eta U L/N':>10s}"
    ]
    film = measured.predicted
    for i in _telling(measured):
        film_text = (
            f"{1e6 * measured.thickness[i]:.3g} [{1e6 * measured.low[i]:.3g}, {1e6 * measured.high[i]:.3g}]"
        )
        lines.append(
            f"  {celsius(measured.temperature[i]):6.1f} {measured.speed[i]:7.3g} {film_text:>28s} "
            f"{1e6 * film.central[i] * film.factor[i]:10.3g} {measured.friction[i]:9.3g} "
            f"{1e6 * measured.hersey_number[i]:11.3g} {measured.sommerfeld_number[i]:10.3g}"
        )
    lines.append("  measured film eta A/B, A the nip, rolling as predicted; U sliding speed, p mean pressure")
    lines.append("  of the nip; all dwells: --json" if way_in() == "terminal" else "  of the nip")
    return lines


def _systematic_lines(measured: MeasuredFilm) -> list[str]:
    lines = []
    if measured.systematic > 1:
        lines.append(
            f"  intervals hold a common factor {measured.systematic:.3g} for viscosity and nip as stated"
        )
    else:
        lines.append("  intervals leave out what is unknown of viscosity and nip: state their uncertainty")
    lines.append(f"  measured torque over predicted, where torque rises with speed: {measured.calibration}")
    return lines


def _telling(measured: MeasuredFilm) -> list[int]:
    """The slowest, the middle and the fastest dwell of each temperature."""
    chosen: list[int] = []
    for group in groups_of_temperature(measured.temperature):
        ordered = group[np.argsort(measured.speed[group], kind="stable")]
        chosen += [int(ordered[k]) for k in sorted({0, ordered.size // 2, ordered.size - 1})]
    return chosen
