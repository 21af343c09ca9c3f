"""The layer of oil on the inlet side in each run of a campaign, and the viscosity that goes with it.

Where the flooded film would be thick (cold, fast) a thin layer starves it: torque then goes as viscosity and
speed themselves instead of as a small power of them. Where it is thin (hot, slow) the layer is not seen. A
factor on viscosity moves all dwells alike, a thin layer only those: so the layer over the flooded film is
known by the shape of torque over speed and temperature, whatever the level. In metres it is known as well as
that film is, viscosity to the power 0.6.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace

import numpy as np
from scipy.special import logit

from hersey.arrays import BoolArray, FloatArray
from hersey.damping.distributions import student_quantile
from hersey.life.film.common_to_runs import FROM_RUN_TO_RUN, Common, Together, fitted_together
from hersey.life.film.filled_dwells import FilledDwells
from hersey.life.film.run_search import ALL_BUT_LAYER, COMMON, DRY, FLOODED, Search
from hersey.life.film.starved_drag import (
    BOUNDARY,
    CONSTANT,
    FADING,
    FREE,
    LAYER,
    PER_KELVIN,
    PER_SPEED,
    ROUGHNESS,
    SHARPNESS,
    TEMPERATURE_SENSITIVITY,
    VISCOSITY,
    Flooded,
    FloodedTable,
    SharedLoad,
    StarvedDrag,
    cubic,
    film_of,
    flooded,
)
from hersey.life.growth.limit_ages import DEVIATIONS
from hersey.life.oil_layer import USUAL_SHARPNESS, log_share_between, starved_layer
from hersey.machine.machine import Machine

#: Where the likelihood of a run is looked at, in its standard errors from the most likely layer; the last
#: place is that of a flooded contact.
_PLACES = np.array([-6.0, -4.0, -3.0, -2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0])
_MIDDLE = 7
_NARROWEST, _WIDEST, _SEEN = 1e-3, 0.4, 0.9
#: Dwells that are computed at once.
_AT_ONCE = 20_000
#: Standard deviations beforehand: ln of the factors on viscosity, roughness and boundary friction; the rest
#: of the drive over the greatest torque, and its change in 100 K over the same.
_LEVEL, _ROUGH, _HARD, _REST, _REST_PER_100_KELVIN = 2.0, 0.7, 0.4, 1.0, 0.05
#: Runs from which what is common to all is estimated.
_RUNS_FOR_SHARED = 120
#: Share by which viscosity may be off (95 %), where the lubricant does not state it.
_UNSTATED = 0.2
#: The same of the width of the nip.
_UNSTATED_NIP = 0.1
#: By how much laws of the film differ, ln of the thickness (standard deviation).
_FILM_LAW = 0.15
#: Standard errors in the 95 % that an uncertainty is stated at.
_TO_95 = 1.96
#: Film over roughness below which asperities that the machine does not describe may touch, and dwells that a
#: run needs without those.
LEAST_LAMBDA = 6.0
_FEWEST = 18


@dataclass(frozen=True)
class Layers:
    """The layer of each run, as its dwells show it; arrays of shape (runs, places), or (runs,).

    ``place`` is ln of the layer over the flooded film at the reference, ``deviance`` twice what ln likelihood
    falls short of its greatest there, all else free. ``viscosity`` and ``temperature_sensitivity`` are then
    the most likely ln of the factor on viscosity at the middle temperature and its change from hot to cold,
    with standard errors.
    """

    place: FloatArray
    deviance: FloatArray
    viscosity: FloatArray
    temperature_sensitivity: FloatArray
    viscosity_error: FloatArray
    temperature_sensitivity_error: FloatArray
    best: FloatArray  #: the most likely place
    scatter: FloatArray  #: of the dwells about the law, over their errors
    freedom: FloatArray
    used: FloatArray  #: dwells
    reference: Flooded
    common: FloatArray  #: of all runs, in the order of `starved_drag`

    @property
    def sharpness(self) -> float:
        """Of starvation."""
        return USUAL_SHARPNESS * float(np.exp(self.common[SHARPNESS - TEMPERATURE_SENSITIVITY]))

    @property
    def fading(self) -> float:
        """How far starvation is by the law that fades."""
        return float(self.common[FADING - TEMPERATURE_SENSITIVITY])

    @property
    def starved_at(self) -> float:
        """The layer over the flooded film, ln, at which the film is starved."""
        return float(starved_layer(self.sharpness, self.fading))

    def log_share(self, layer: FloatArray) -> FloatArray:
        """Return ln of the film over the flooded one, from ln of the layer over that."""
        return log_share_between(layer, self.sharpness, self.fading)[0]

    def likeliest_viscosity(self) -> tuple[FloatArray, FloatArray]:
        """Return ln of the factor on viscosity at the most likely layer, and its standard error."""
        rows = np.arange(len(self.best))
        at = np.abs(self.place - self.best[:, None]).argmin(axis=1)
        return self.viscosity[rows, at], self.viscosity_error[rows, at]

    def film_at(self, point: Flooded) -> tuple[FloatArray, FloatArray]:
        """Return ln of the flooded film (m) at a point as each place has it, and its standard error.

        The error is that of the run, viscosity and its change with temperature as independent.
        """
        at = self.viscosity + self.temperature_sensitivity * point.steep
        film, slope = cubic(point.film, at)
        return film, np.abs(slope) * np.hypot(
            self.viscosity_error, self.temperature_sensitivity_error * point.steep
        )

    def interval(self, point: Flooded | None = None, level: float = 0.9) -> tuple[FloatArray, ...]:
        """Return the most likely ln of the layer over the flooded film at a point, and its interval.

        An end is infinite where the run does not show it. Without a point: at the reference.
        """
        shift, extra = np.zeros_like(self.place), np.zeros_like(self.place)
        if point is not None:
            own, there = self.film_at(self.reference)[0], self.film_at(point)[0]
            shift = own - there
            slope = cubic(point.film, self.viscosity)[1]
            extra = (
                np.abs(slope * (self.reference.steep - point.steep)[0]) * self.temperature_sensitivity_error
            )
        return self._ends(shift, extra, level)

    def film(self, point: Flooded, level: float = 0.9) -> tuple[FloatArray, ...]:
        """Return the most likely ln of the film (m) at a point, and its interval."""
        full, error = self.film_at(point)
        layer = self.place + self.film_at(self.reference)[0] - full
        film = full + self.log_share(layer)
        best, low, high = self._ends(film - self.place, error, level)
        # However thick the layer, the film is the flooded one.
        most = film[:, -1] + DEVIATIONS * error[:, -1]
        return best, low, np.where(np.isfinite(high), high, most)

    def thickness(self, level: float = 0.9) -> tuple[FloatArray, ...]:
        """Return the most likely ln of the layer (m), and its interval; infinite as `interval`."""
        film, error = self.film_at(self.reference)
        return self._ends(film, error, level)

    def _ends(self, shift: FloatArray, extra: FloatArray, level: float) -> tuple[FloatArray, ...]:
        """Ends of place + shift, from the root of the deviance, widened by an error of the shift."""
        quantile: FloatArray = np.asarray(student_quantile(0.5 + level / 2.0, self.freedom))
        away = self.place - self.best[:, None]
        root = np.maximum.accumulate(np.sqrt(np.maximum(self.deviance, 0.0)) * np.sign(away), axis=1)
        moved = self.place + shift
        best = interpolated(self.best, self.place, moved)
        more = quantile * interpolated(self.best, self.place, extra)
        below = np.where(-quantile < root[:, 0], -np.inf, interpolated(-quantile, root, moved))
        above = np.where(quantile > root[:, -1], np.inf, interpolated(quantile, root, moved))
        return best, best - np.hypot(best - below, more), best + np.hypot(above - best, more)


def interpolated(at: FloatArray, places: FloatArray, values: FloatArray) -> FloatArray:
    """Return `np.interp` of each row: at (rows,), places, ascending, and values (rows, places)."""
    rows, last = np.arange(len(at)), places.shape[1] - 1
    first = np.clip((places <= at[:, None]).sum(axis=1) - 1, 0, last)
    then = np.minimum(first + 1, last)
    low, low_value = places[rows, first], values[rows, first]
    width = places[rows, then] - low
    slope = (values[rows, then] - low_value) / np.where(width > 0.0, width, 1.0)
    return np.asarray(low_value + slope * np.maximum(at - low, 0.0))


@dataclass(frozen=True)
class LayerFit:
    """The torque of the dwells of all runs, to be fitted under any assumption on the other drag."""

    dwells: FilledDwells
    table: FloodedTable
    reference: Flooded
    other: Flooded  #: where the share of the other drag is stated
    middle: float  #: temperature, K
    sensitivity: float  #: standard deviation of the change of ln viscosity from hot to cold
    level: float  #: that of ln viscosity of new lubricant as torque shows it
    roughness: float | None
    asperities: SharedLoad | None

    @classmethod
    def of(
        cls,
        dwells: FilledDwells,
        machine: Machine,
        *,
        speed: float,
        kelvin: float,
        other: tuple[float, float] | None = None,
    ) -> LayerFit:
        """Compute the flooded film at the dwells.

        Parameters
        ----------
        dwells
            Of all runs; at least one of each given.
        machine
            With contact and lubricant; where it states asperities and boundary friction, their part of the
            torque is in the law, otherwise dwells whose film is thin against the roughness are left out.
        speed, kelvin
            The point (rad/s, K) at which the layer is put in relation to the flooded film.
        other
            The point (rad/s, K) at which the share of other drag is stated. Default: the same.

        Raises
        ------
        ParameterError
            If the machine lacks contact or lubricant, or a temperature is far outside the lubricant's law.
        """
        contact, lubricant = film_of(machine)
        middle = float(np.mean(dwells.kelvin[dwells.given]))
        mixed = machine.mixed
        reference, at = (
            flooded(contact, lubricant, np.array([[each[0]]]), np.array([[each[1]]]))
            for each in ((speed, kelvin), other or (speed, kelvin))
        )
        uncertainty = _UNSTATED if lubricant.uncertainty is None else lubricant.uncertainty
        return cls(
            dwells,
            FloodedTable(contact, lubricant, dwells.speed[dwells.given], dwells.kelvin[dwells.given]),
            reference,
            at,
            middle,
            _sensitivity_deviation(uncertainty),
            _level_deviation(uncertainty, contact.nip_uncertainty, at),
            contact.roughness,
            None if mixed is None else SharedLoad.of(mixed, middle),
        )

    @property
    def computed_share(self) -> float:
        """The share of other drag at its point, of a flooded film, as the rolling part is computed."""
        over = cubic(self.other.rolled, np.zeros(()))[0].item()
        return float(over / (1.0 + over))

    def together(self, share: float | None = None) -> Together:
        """Return what is common to all runs, with a share of other drag (None: as computed)."""
        least = self.computed_share
        factor = 0.0 if share is None else float(logit(share) - logit(least))
        beforehand = Common.beforehand(self.sensitivity, factor)
        every = max(1, -(-len(self.dwells.given) // _RUNS_FOR_SHARED))
        searches = list(self._searches(every, beforehand))
        return fitted_together(searches, beforehand)

    def layers(self, common: Common) -> Layers:
        """Return the layers of all runs, given what is common to them."""
        parts = [_profiled(each) for each in self._searches(1, common)]
        names = [each.name for each in fields(Layers) if each.name not in ("reference", "common")]
        return Layers(
            **{name: np.concatenate([getattr(part, name) for part in parts]) for name in names},
            reference=self.reference,
            common=common.mean,
        )

    def _searches(self, every: int, common: Common) -> Iterator[Search]:
        """Every so many of the runs, in blocks."""
        runs, longest = self.dwells.speed.shape
        many = every * max(1, _AT_ONCE // longest)
        thick = _nominal(self.other)
        for first in range(0, runs, many):
            some = self.dwells.rows(slice(first, min(first + many, runs), every))
            film = self.table.at(some.speed, some.kelvin)
            if self.asperities is None and self.roughness is not None:
                some = replace(some, given=_on_film(some.given, film, self.roughness))
            warm = some.kelvin - self.middle
            law = StarvedDrag(some.speed, warm, film, self.reference, thick, self.roughness, self.asperities)
            yield Search(law, some, *_prior(some, common, self.asperities is not None))


def layers(dwells: FilledDwells, machine: Machine, *, speed: float, kelvin: float) -> Layers:
    """Return the layers of runs, the other drag as computed; arguments as `LayerFit.of`."""
    fit = LayerFit.of(dwells, machine, speed=speed, kelvin=kelvin)
    return fit.layers(fit.together().common)


def _nominal(point: Flooded) -> float:
    """Logarithm of the flooded film at a point by the machine file, m."""
    return float(cubic(point.film, np.zeros(()))[0].item())


def _sensitivity_deviation(uncertainty: float) -> float:
    """Standard deviation of the change of ln viscosity between two points each known so well."""
    return max(float(np.sqrt(2.0) * np.log1p(uncertainty)) / _TO_95, 1e-3)


def _level_deviation(uncertainty: float, nip: float | None, point: Flooded) -> float:
    """Standard deviation of ln viscosity of new lubricant, as the torque at a point shows it.

    Film and nip are not known either, and torque is a small power of viscosity.
    """
    of_torque = np.hypot(_FILM_LAW, np.log1p(_UNSTATED_NIP if nip is None else nip) / _TO_95)
    power = max(float(cubic(point.shear, np.zeros(()))[1].item()), 0.1)
    return float(np.hypot(np.log1p(uncertainty) / _TO_95, of_torque / power))


def _on_film(given: BoolArray, film: Flooded, roughness: float) -> BoolArray:
    """Dwells whose film keeps the faces apart; all of a run that has too few of them."""
    on_film = given & (cubic(film.film, np.zeros(()))[0] > np.log(LEAST_LAMBDA * roughness))
    return np.where((on_film.sum(axis=1) > _FEWEST)[:, None], on_film, given)


def _prior(dwells: FilledDwells, common: Common, mixed: bool) -> tuple[FloatArray, FloatArray]:
    """Means and precisions beforehand of what is free, (runs, 14) and (runs, 14, 14)."""
    greatest = np.where(dwells.given, dwells.torque, 0.0).max(axis=1)
    fastest = np.where(dwells.given, dwells.speed, 0.0).max(axis=1)
    deviation = np.ones((len(greatest), FREE))
    deviation[:, VISCOSITY] = _LEVEL
    deviation[:, CONSTANT] = _REST * greatest
    deviation[:, PER_SPEED] = _REST * greatest / fastest
    deviation[:, PER_KELVIN] = _REST_PER_100_KELVIN * greatest / 100.0
    deviation[:, ROUGHNESS], deviation[:, BOUNDARY] = (_ROUGH, _HARD) if mixed else (1e-3, 1e-3)
    deviation[:, LAYER] = 1e6
    mean = np.zeros_like(deviation)
    mean[:, COMMON] = common.mean
    precision = np.eye(FREE) * (deviation**-2)[:, :, None]
    precision[:, COMMON, COMMON] = np.linalg.inv(common.covariance + np.diag(FROM_RUN_TO_RUN**2))
    return mean, precision


def _profiled(search: Search) -> Layers:
    """Follow what else is free from the most likely layer to thinner and to thicker ones."""
    free, _, precision = search.searched()
    width = np.clip(np.sqrt(np.linalg.inv(precision)[:, LAYER, LAYER]), _NARROWEST, _WIDEST)
    # Where nothing starves the likelihood is level: its edge is what is looked for.
    centre = np.minimum(free[:, LAYER], _SEEN)
    places = np.clip(centre[:, None] + width[:, None] * _PLACES, DRY, FLOODED)
    places = np.column_stack([places, np.full(len(places), FLOODED)])
    costs, kept = np.empty_like(places), np.empty((*places.shape, 4))
    for order in (range(_MIDDLE, -1, -1), range(_MIDDLE + 1, places.shape[1])):
        trial = free.copy()
        for k in order:
            trial[:, LAYER] = places[:, k]
            trial, costs[:, k], precision = search.settled(trial, steps=2, of=ALL_BUT_LAYER)
            covariance = np.linalg.inv(precision[:, :LAYER, :LAYER])
            kept[:, k, :2] = trial[:, [VISCOSITY, TEMPERATURE_SENSITIVITY]]
            kept[:, k, 2:] = np.sqrt(
                covariance[:, [VISCOSITY, TEMPERATURE_SENSITIVITY], [VISCOSITY, TEMPERATURE_SENSITIVITY]]
            )
    least, lowest = costs.min(axis=1), costs.argmin(axis=1)
    scatter = np.sqrt(least / search.freedom)
    stretch = np.maximum(scatter, 1.0)[:, None]
    return Layers(
        place=places,
        deviance=(costs - least[:, None]) / stretch**2,
        viscosity=kept[..., 0],
        temperature_sensitivity=kept[..., 1],
        viscosity_error=kept[..., 2] * stretch,
        temperature_sensitivity_error=kept[..., 3] * stretch,
        best=places[np.arange(len(places)), lowest],
        scatter=scatter,
        freedom=search.freedom,
        used=search.dwells.given.sum(axis=1),
        reference=search.drag.reference,
        common=np.zeros(0),
    )
