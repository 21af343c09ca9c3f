"""The layer of oil on the inlet side in each run of a campaign, and the viscosity that goes with it.

Where the flooded film would be thick (cold, fast) a thin layer starves it: torque then goes as viscosity and
speed themselves instead of as a small power of them. Where it is thin (hot, slow) the layer is not seen. A
factor on viscosity moves all dwells alike, a thin layer only those: so the layer over the flooded film is
known by the shape of torque over speed and temperature, whatever the level. In metres it is known as well as
that film is, viscosity to the power 0.6.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.damping.distributions import student_quantile
from hersey.life.film.filled_dwells import FilledDwells
from hersey.life.film.starved_drag import (
    BOUNDARY,
    CONSTANT,
    FREE,
    LAYER,
    PER_KELVIN,
    PER_SPEED,
    ROUGHNESS,
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
from hersey.life.oil_layer import USUAL_SHARPNESS, log_film_share
from hersey.machine.machine import Machine

#: ln of the layer over the flooded film at the reference from which on nothing starves, and the least.
FLOODED, DRY = 3.0, -4.0
#: Layers from which the search begins, and its steps.
_STARTS = (1.0, 0.2, -0.5, -1.1, -1.8, -2.6)
_STEPS = 12
#: Where the likelihood of a run is looked at, in its standard errors from the most likely layer; the last
#: place is that of a flooded contact.
_PLACES = np.array([-6.0, -4.0, -3.0, -2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0])
_MIDDLE = 7
_NARROWEST, _WIDEST, _SEEN = 1e-3, 0.4, 0.9
#: No torque is taken as known better than these shares of it, and of the greatest of its run.
_RESOLUTION = (0.003, 0.001)
#: Dwells that are computed at once.
_AT_ONCE = 20_000
#: Standard deviations beforehand: ln of the factors on viscosity, roughness and boundary friction; the rest
#: of the drive over the greatest torque, and its change in 100 K over the same.
_LEVEL, _ROUGH, _HARD, _REST, _REST_PER_100_KELVIN = 2.0, 0.7, 0.4, 1.0, 0.05
#: What belongs to the machine and its oil, common to all runs: viscosity against temperature, sharpness,
#: rolling.
_COMMON = slice(TEMPERATURE_SENSITIVITY, LAYER)
#: Standard deviations beforehand of the last two, and of all three from run to run; runs from which they are
#: estimated.
_SHARP, _ROLLED = 0.35, 0.3
_FROM_RUN_TO_RUN = np.array([0.03, 0.1, 0.1])
_RUNS_FOR_SHARED = 120
#: Ends of the three; films of rolling contacts had a sharpness of 2 to 5.
_COMMON_ENDS = np.array(
    [[-0.5, np.log(1.5 / USUAL_SHARPNESS), -0.6], [0.5, np.log(6.5 / USUAL_SHARPNESS), 0.6]]
)
#: Share by which viscosity may be off (95 %), where the lubricant does not state it.
_UNSTATED = 0.2
#: Standard errors in the 95 % that an uncertainty is stated at.
_TO_95 = 1.96
#: Film over roughness below which asperities that the machine does not describe may touch.
_LEAST_LAMBDA = 4.0


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
    common: FloatArray  #: of all runs: change of ln viscosity from hot to cold, ln sharpness, ln rolling

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
        sharpness = USUAL_SHARPNESS * float(np.exp(self.common[1]))
        film = full + log_film_share(layer, sharpness)[0]
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
        best, low, high = (np.empty_like(self.best) for _ in range(3))
        for i in range(len(best)):
            moved = self.place[i] + shift[i]
            best[i] = np.interp(self.best[i], self.place[i], moved)
            more = quantile[i] * np.interp(self.best[i], self.place[i], extra[i])
            below = np.interp(-quantile[i], root[i], moved, left=-np.inf)
            above = np.interp(quantile[i], root[i], moved, right=np.inf)
            low[i] = best[i] - np.hypot(best[i] - below, more)
            high[i] = best[i] + np.hypot(above - best[i], more)
        return best, low, high


def layers(dwells: FilledDwells, machine: Machine, *, speed: float, kelvin: float) -> Layers:
    """Return the layers of runs.

    Parameters
    ----------
    dwells
        Of all runs; at least one of each given.
    machine
        With contact and lubricant; where it states asperities and boundary friction, their part of the torque
        is in the law, otherwise dwells whose film is thin against the roughness are left out.
    speed, kelvin
        The point (rad/s, K) at which the layer is put in relation to the flooded film.

    Raises
    ------
    ParameterError
        If the machine lacks contact or lubricant, or a temperature is far outside the lubricant's law.
    """
    contact, lubricant = film_of(machine)
    middle = float(np.mean(dwells.kelvin[dwells.given]))
    mixed = machine.mixed
    shared = None if mixed is None else SharedLoad.of(mixed, middle)
    reference = flooded(contact, lubricant, np.array([[speed]]), np.array([[kelvin]]))
    uncertainty = _UNSTATED if lubricant.uncertainty is None else lubricant.uncertainty
    beforehand = _Common(np.zeros(3), np.diag([_sensitivity_deviation(uncertainty), _SHARP, _ROLLED]) ** 2)

    table = FloodedTable(contact, lubricant, dwells.speed[dwells.given], dwells.kelvin[dwells.given])

    def searches(rows: Iterable[slice], common: _Common) -> Iterator[_Search]:
        for chosen in rows:
            some = dwells.rows(chosen)
            film = table.at(some.speed, some.kelvin)
            if shared is None and contact.roughness is not None:
                some = replace(some, given=_on_film(some.given, film, contact.roughness))
            law = StarvedDrag(some.speed, some.kelvin - middle, film, reference, contact.roughness, shared)
            yield _Search(law, some, *_prior(some, common, shared is not None))

    runs, longest = dwells.speed.shape
    every = max(1, -(-runs // _RUNS_FOR_SHARED))
    many = max(1, _AT_ONCE // longest)
    some_runs = [slice(i, min(i + many * every, runs), every) for i in range(0, runs, many * every)]
    common = beforehand
    for _ in range(2):  # about its own last answer, with all that was open beforehand
        common = _shared_by_runs(
            searches(some_runs, replace(beforehand, mean=common.mean)), common.mean, beforehand
        )
    parts = [_profiled(each) for each in searches((slice(i, i + many) for i in range(0, runs, many)), common)]
    names = [each.name for each in fields(Layers) if each.name not in ("reference", "common")]
    return Layers(
        **{name: np.concatenate([getattr(part, name) for part in parts]) for name in names},
        reference=reference,
        common=common.mean,
    )


@dataclass(frozen=True)
class _Common:
    """What is common to all runs, as known so far."""

    mean: FloatArray
    covariance: FloatArray


def _sensitivity_deviation(uncertainty: float) -> float:
    """Standard deviation of the change of ln viscosity between two points each known so well."""
    return max(float(np.sqrt(2.0) * np.log1p(uncertainty)) / _TO_95, 1e-3)


def _shared_by_runs(searches: Iterable[_Search], about: FloatArray, beforehand: _Common) -> _Common:
    """What is common to all runs, estimated from them together, all else free in each."""
    known = np.linalg.inv(beforehand.covariance)
    total, moment = known.copy(), known @ beforehand.mean
    for search in searches:
        free, cost, curvature = search.searched(2 * _STEPS)
        stretch = np.maximum(cost / search.freedom, 1.0)
        marginal = np.linalg.inv(np.linalg.inv(curvature)[:, _COMMON, _COMMON])
        prior = search.prior[:, _COMMON, _COMMON]
        # What the dwells alone say: the answer less what was given to it.
        total += ((marginal - prior) / stretch[:, None, None]).sum(axis=0)
        answer = np.matmul(marginal, free[:, _COMMON, None]) - np.matmul(prior, about[:, None])
        moment += (answer[..., 0] / stretch[:, None]).sum(axis=0)
    covariance = np.linalg.inv(total)
    return _Common(np.clip(covariance @ moment, *_COMMON_ENDS), covariance)


def _on_film(given: BoolArray, film: Flooded, roughness: float) -> BoolArray:
    """Dwells whose film keeps the faces apart; all of a run that has too few of them."""
    on_film = given & (cubic(film.film, np.zeros(()))[0] > np.log(_LEAST_LAMBDA * roughness))
    return np.where((on_film.sum(axis=1) > 2 * LAYER)[:, None], on_film, given)


def _prior(dwells: FilledDwells, common: _Common, mixed: bool) -> tuple[FloatArray, FloatArray]:
    """Means and precisions beforehand of what is free, (runs, 10) and (runs, 10, 10)."""
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
    mean[:, _COMMON] = common.mean
    precision = np.eye(FREE) * (deviation**-2)[:, :, None]
    precision[:, _COMMON, _COMMON] = np.linalg.inv(common.covariance + np.diag(_FROM_RUN_TO_RUN**2))
    return mean, precision


def _profiled(search: _Search) -> Layers:
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
            trial, costs[:, k], precision = search.settled(trial, steps=2, layer=False)
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
        common=np.zeros(3),
    )


@dataclass(frozen=True)
class _Search:
    """Least squares over the dwells and what is known beforehand, by damped steps (Levenberg 1944)."""

    drag: StarvedDrag
    dwells: FilledDwells
    mean: FloatArray
    prior: FloatArray

    @property
    def freedom(self) -> FloatArray:
        """Degrees of freedom of each run."""
        # What is common to all runs costs none of one.
        return np.asarray(np.maximum(self.dwells.given.sum(axis=1) - FREE + 3.0, 1.0))

    def searched(self, steps: int = _STEPS) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return what is most likely from any start, its squares and their curvature."""
        free = self.start(0.0)
        cost = np.full(len(free), np.inf)
        for layer in _STARTS:
            trial, found, _ = self.settled(self.start(layer), steps=2, layer=False)
            free = np.where((found < cost)[:, None], trial, free)
            cost = np.minimum(found, cost)
        return self.settled(free, steps=steps, layer=True)

    @cached_property
    def _weight(self) -> FloatArray:
        dwells = self.dwells
        greatest = np.where(dwells.given, dwells.torque, 0.0).max(axis=1, keepdims=True)
        of_own, of_greatest = _RESOLUTION
        error = np.sqrt(dwells.error**2 + (of_own * dwells.torque) ** 2 + (of_greatest * greatest) ** 2)
        return np.where(dwells.given, 1.0 / error, 0.0)

    def start(self, layer: float) -> FloatArray:
        """Return what is known beforehand, with a layer."""
        free = self.mean.copy()
        free[:, LAYER] = layer
        return free

    def _moved(self, free: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        torque, slopes = self.drag.torque(free)
        weight = self._weight
        left = weight * (self.dwells.torque - torque)
        slopes *= weight[:, None]
        away = self.mean - free
        pulled = np.matmul(self.prior, away[..., None])[..., 0]
        square = (left**2).sum(axis=1) + (away * pulled).sum(axis=1)
        gradient = np.matmul(slopes, left[..., None])[..., 0] + pulled
        return square, gradient, np.matmul(slopes, slopes.transpose(0, 2, 1)) + self.prior

    def settled(
        self, free: FloatArray, *, steps: int, layer: bool
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return what is most likely from a start on, the layer free or held; squares and curvature."""
        many = FREE if layer else LAYER
        inner = np.arange(many)
        best = trial = free
        least, gradient, curvature = self._moved(free)
        damping = np.full(len(free), 1e-4)
        for _ in range(steps):
            damped = curvature[:, :many, :many].copy()
            damped[:, inner, inner] *= 1.0 + damping[:, None]
            step = np.linalg.solve(damped, gradient[:, :many, None])[..., 0]
            trial = best.copy()
            trial[:, :many] += step
            trial[:, VISCOSITY] = np.clip(trial[:, VISCOSITY], *_near(best[:, VISCOSITY], 0.7, -3.0, 5.0))
            trial[:, LAYER] = np.clip(trial[:, LAYER], *_near(best[:, LAYER], 0.5, DRY, FLOODED))
            trial[:, ROUGHNESS:TEMPERATURE_SENSITIVITY] = np.clip(
                trial[:, ROUGHNESS:TEMPERATURE_SENSITIVITY], -2.0, 2.0
            )
            trial[:, _COMMON] = np.clip(trial[:, _COMMON], *_COMMON_ENDS)
            square, *moved = self._moved(trial)
            better = square < least
            best = np.where(better[:, None], trial, best)
            least = np.minimum(square, least)
            gradient = np.where(better[:, None], moved[0], gradient)
            curvature = np.where(better[:, None, None], moved[1], curvature)
            damping = np.clip(np.where(better, 0.1 * damping, 100.0 * damping), 1e-9, 1e6)
        return best, least, curvature


def _near(at: FloatArray, stride: float, low: float, high: float) -> tuple[FloatArray, FloatArray]:
    """Ends of one step."""
    return np.maximum(at - stride, low), np.minimum(at + stride, high)
