"""From measurement to film: how thick, and how loaded.

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

from hersey.arrays import FloatArray
from hersey.damping.candidates.shared_errors import shared_variance
from hersey.damping.dwells import SteadyPoints, groups_of_temperature
from hersey.damping.dwells.reduced import require_points
from hersey.damping.estimate import Estimate, quantile
from hersey.damping.surface import DampingSurface
from hersey.errors import InsufficientDataError, Setting, way_in
from hersey.lubrication.contact import Contact, nip_width
from hersey.lubrication.film import film_thickness
from hersey.lubrication.film_result import Film
from hersey.lubrication.film_temperature import film_temperature
from hersey.lubrication.lubricant import Lubricant
from hersey.result import Means, Result, json_record
from hersey.units import celsius, takes_si
from hersey.verdict.contact_regimes import on_rising_branch

if TYPE_CHECKING:
    import polars as pl


@dataclass(frozen=True, repr=False)
class MeasuredFilm(Result):
    """Film thickness measured by each dwell; arrays of shape (points,), SI.

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
        """Return the number of dwells and the range of film thickness."""
        film = 1e6 * self.thickness
        return f"{film.size} dwells, measured film {film.min():.3g} to {film.max():.3g} um"

    def to_dict(self) -> dict[str, Any]:
        """Return the measured and the predicted film of each dwell, in SI."""
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
    """Return the measured film thickness at each dwell, with the predicted one.

    Parameters
    ----------
    points, surface
        Steady points of a log, and the surface fitted to them.
    contact, lubricant
        The nip and its lubricant.
    temperature
        K, for an isothermal log.
    grip
        Friction coefficient at which the belt slips on the roll.

    Raises
    ------
    InsufficientDataError
        If the log holds no temperature and none is given.
    """
    require_points(points, "hersey.measured_film({points}, surface, contact, lubricant)")
    speed, torque = np.abs(points.column("speed")), np.abs(points.column("torque"))
    kelvin = _temperatures(points, surface, temperature)
    inside = film_temperature(contact, lubricant, speed=speed, temperature=kelvin)
    film = film_thickness(contact, lubricant, speed=speed, temperature=inside)
    expected, radius, nip = film.torque, contact.roll_radius, film.nip
    load, width = _loaded(points, contact, nip.width)
    thickness = film.central * film.factor * (expected / torque) * (width / nip.width)
    shares = [share for share in (lubricant.uncertainty, contact.nip_uncertainty) if share is not None]
    systematic = float(np.exp(np.sqrt(sum(np.log1p(share) ** 2 for share in shares))))
    factor = np.exp(np.hypot(_relative_error(points, surface, torque), np.log(systematic)))
    rises = on_rising_branch(surface, speed, kelvin)
    compared = rises if rises.any() else slice(None)
    viscous = film.viscosity * (speed * radius)
    return MeasuredFilm(
        speed=speed,
        temperature=kelvin,
        torque=torque,
        thickness=thickness,
        low=thickness / factor,
        high=thickness * factor,
        systematic=systematic,
        friction=torque / (radius * load),
        hersey_number=viscous * width * contact.length / load,
        sommerfeld_number=viscous * contact.length / load,
        lambda_ratio=None if contact.roughness is None else thickness / contact.roughness,
        predicted=film,
        predicted_torque=expected,
        calibration=_mean_ratio(torque[compared], expected[compared]),
        on_film=rises.astype(float),
        grip=grip,
    )


def _temperatures(points: SteadyPoints, surface: DampingSurface, temperature: float | None) -> FloatArray:
    """The temperature of each dwell as read, or the one given for an isothermal log, K."""
    kelvin = np.asarray(points.column("temperature"), dtype=float)
    if surface.b is None or not np.isfinite(kelvin).all():
        if temperature is None:
            raise InsufficientDataError(
                "the log has no temperatures. Give that of the film, "
                f"{Setting('temperature', flag='--at').to('180 degC', python='453.15')}"
            )
        kelvin = np.full(len(points), temperature)
    return kelvin


def _relative_error(points: SteadyPoints, surface: DampingSurface, torque: FloatArray) -> FloatArray:
    """Half of the 95 % interval of each film as a share of it, what is stated of viscosity and nip apart."""
    variance = (points.column("torque_error") / torque) ** 2 + surface.statistics.scatter**2
    variance += np.sum(points.zero_errors**2, axis=1) / torque**2
    variance += shared_variance(surface.statistics.shared)
    return np.asarray(quantile(surface.freedom) * np.sqrt(variance))


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
    lines.append(
        "  measured film: eta A/B with nip area A and rolling as predicted; U sliding speed, p mean pressure"
    )
    lines.append("  of the nip; all dwells: --json" if way_in() == "terminal" else "  of the nip")
    return lines


def _systematic_lines(measured: MeasuredFilm) -> list[str]:
    lines = []
    if measured.systematic > 1:
        lines.append(
            f"  intervals include a common factor {measured.systematic:.3g} for viscosity and nip, as stated"
        )
    else:
        lines.append(
            "  intervals do not include the uncertainty of viscosity and nip. State it in the machine file"
        )
    lines.append(f"  measured / predicted torque, where torque rises with speed: {measured.calibration}")
    return lines


def _telling(measured: MeasuredFilm) -> list[int]:
    """The slowest, the middle and the fastest dwell of each temperature."""
    chosen: list[int] = []
    for group in groups_of_temperature(measured.temperature):
        ordered = group[np.argsort(measured.speed[group], kind="stable")]
        chosen += [int(ordered[k]) for k in sorted({0, ordered.size // 2, ordered.size - 1})]
    return chosen
