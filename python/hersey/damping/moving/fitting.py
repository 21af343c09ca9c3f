"""Least squares with correlated noise: one law fitted to the equations of a moving log."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.friction_curve.law import COULOMB, STATIC, STRIBECK_SPEED
from hersey.damping.moving.correlated import Autoregression, Whitening, autoregression
from hersey.damping.moving.model import DELAY, INERTIA, Equations, MovingLaw

#: Rounds of linear least squares, and the fall of chi-square at which they end.
_ROUNDS, _SETTLED = 25, 1e-3
#: Shares of the greatest speed at which a search for the Stribeck speed starts.
_STARTS = (0.015, 0.03, 0.06, 0.12, 0.25)
#: Logarithm of the Stribeck speed may change by so much in a round.
_MOST = 0.7
#: Share of the least speed of the equations below which a Stribeck speed cannot show.
LEAST_SEEN = 0.5
#: Least variance of the noise, as a share of the mean square of the torque: exact data leave none.
_EXACT = 1e-18
#: Damping of the rounds: first, greatest.
_DAMPED, _MOST_DAMPED = 1e-3, 1e6


@dataclass(frozen=True)
class MovingLawFit:
    """A law fitted: values, their covariance, and what is left of the torque (N m) in each equation."""

    law: MovingLaw
    values: FloatArray
    covariance: FloatArray
    residuals: FloatArray
    chi_square: float  #: of the independent combinations, in units of the variance given
    columns: FloatArray  #: derivatives of the torque of each equation by the numbers as they are fitted
    own: FloatArray  #: covariance of these, if the noise is the one assumed
    attenuated: float  #: chi-square of what noise of the acceleration took from the inertia
    by_inertia: FloatArray  #: derivatives of the values by an inertia that is given, 1/(kg m^2)

    def error(self, name: str) -> float:
        """Return the standard error of a number."""
        index = self.law.names.index(name)
        return float(np.sqrt(self.covariance[index, index]))

    def value(self, name: str) -> float:
        """Return a number by its name."""
        return float(self.values[self.law.names.index(name)])

    def criterion(self) -> float:
        """Return AICc, up to what all laws on the same equations share."""
        rows, count = self.residuals.size, self.values.size
        return self.chi_square + 2.0 * count * rows / max(rows - count - 1.0, 1.0)


@dataclass(frozen=True)
class Fitting:
    """Equations, their noise, and what makes them independent."""

    equations: Equations
    noise: Autoregression
    whitened: Whitening
    prior: float  #: standard deviation of the delay that the sampling alone allows, s
    covariances: FloatArray  #: of the noise of the acceleration, by lag in equations, rad2/s4

    @classmethod
    def of(
        cls, equations: Equations, noise: Autoregression, prior: float, covariances: FloatArray
    ) -> Fitting:
        """Return what the noise makes of the equations."""
        return cls(equations, noise, Whitening(noise, equations.places), prior, covariances)

    @cached_property
    def noise_of_acceleration(self) -> float:
        """Sum of the squares of the noise of the acceleration, once equations are independent, rad2/s4."""
        return self.whitened.power(self.covariances)

    def again(self, fitted: MovingLawFit) -> Fitting:
        """Return the same with the noise that residuals of a law show, and what the law took of it.

        Noise has the covariance of residuals plus that of the fitted torque, exactly so with the right noise.
        """
        values, vectors = np.linalg.eigh(fitted.own)
        taken = fitted.columns @ (vectors * np.sqrt(np.maximum(values, 0.0)))
        columns = np.column_stack([fitted.residuals, taken])
        ends = np.cumsum([places.size for places in self.equations.places])[:-1]
        noise = autoregression(list(zip(self.equations.places, np.split(columns, ends), strict=True)))
        least = _EXACT * float(np.mean(self.equations.torque**2))
        noise = replace(noise, variance=max(noise.variance, least))
        return Fitting.of(self.equations, noise, self.prior, self.covariances)

    def fit(self, law: MovingLaw, near: MovingLawFit | None = None) -> MovingLawFit:
        """Return a law at its least squares, from the values of another that is near or from a search."""
        if near is not None:
            return self._from(law, _like(law, near))
        starts = [(self._once(law, start), start) for start in self._starts(law)]
        return self._from(law, min(starts, key=lambda each: each[0])[1])

    def _starts(self, law: MovingLaw) -> list[FloatArray]:
        """Values to start from: friction without speed, and of Stribeck several speeds."""
        fastest = float(np.max(np.abs(self.equations.speed)))
        level = float(np.mean(np.abs(self.equations.torque)))
        out = []
        for share in _STARTS if law.friction.stribeck else (1.0,):
            given = {COULOMB: level, STATIC: 1.3 * level, STRIBECK_SPEED: share * fastest}
            out.append(np.array([given.get(each.kind, 0.0) for each in law.numbers]))
        return out

    def _once(self, law: MovingLaw, start: FloatArray) -> float:
        """Chi-square once all that is linear is fitted."""
        white, design = self._at(law, start)
        design[:, list(law.positive)] = 0.0
        step = self._step(law, design, white, start, 0.0)
        left = white - design @ step
        return float(left @ left)

    def _at(self, law: MovingLaw, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What is left of each equation, and its derivatives, both independent and in standard errors."""
        columns = law.jacobian(values, self.equations)
        logs = list(law.positive)
        columns[:, logs] *= values[logs]
        return self._left(law, values), self.whitened(columns) / self._deviation

    def _left(self, law: MovingLaw, values: FloatArray) -> FloatArray:
        return self.whitened(self.equations.torque - law.predict(values, self.equations)) / self._deviation

    @property
    def _deviation(self) -> float:
        return float(np.sqrt(self.noise.variance))

    def _chi(self, law: MovingLaw, white: FloatArray, values: FloatArray) -> float:
        return float(white @ white + (values[law.names.index(DELAY)] / self.prior) ** 2)

    def _from(self, law: MovingLaw, values: FloatArray) -> MovingLawFit:
        """Rounds of Levenberg and Marquardt, then the covariance."""
        white, design = self._at(law, values)
        chi, damping = self._chi(law, white, values), 0.0
        for _ in range(_ROUNDS):
            trial = self._moved(law, values, self._step(law, design, white, values, damping))
            left = self._left(law, trial)
            after = self._chi(law, left, trial)
            if not after < chi:
                if damping > _MOST_DAMPED or chi - after == 0.0:
                    break
                damping = max(4.0 * damping, _DAMPED)
                continue
            fell, values, chi, damping = chi - after, trial, after, damping / 4.0
            white, design = self._at(law, values)
            if fell < _SETTLED:
                break
        return self._finished(law, values, white, design, chi)

    def _moved(self, law: MovingLaw, values: FloatArray, step: FloatArray) -> FloatArray:
        """Values after a step; of Stribeck speeds the logarithm moves, within what the speeds can show."""
        logs = list(law.positive)
        moved = values + step
        kept = values[logs] * np.exp(np.clip(step[logs], -_MOST, _MOST))
        speeds = np.abs(self.equations.speed)
        moved[logs] = np.clip(kept, LEAST_SEEN * float(speeds.min()), float(speeds.max()))
        return moved

    def _finished(
        self, law: MovingLaw, values: FloatArray, white: FloatArray, design: FloatArray, chi: float
    ) -> MovingLawFit:
        delay, logs = law.names.index(DELAY), list(law.positive)
        normal = design.T @ design
        normal[delay, delay] += 1.0 / self.prior**2
        size = np.sqrt(np.diag(normal))
        size[size == 0.0] = 1.0
        inverse = np.linalg.pinv(normal / np.outer(size, size), rcond=1e-14, hermitian=True)
        inverse /= np.outer(size, size)
        columns = law.jacobian(values, self.equations)  # where the covariance holds
        columns[:, logs] *= values[logs]
        attenuated = 0.0
        if law.inertia is None:
            step, index = self._unbiased(law, values, inverse), law.names.index(INERTIA)
            values = self._moved(law, values, step)
            attenuated = float(step[index] ** 2 / inverse[index, index])
        leverage = np.einsum("ij,jk,ik->i", design, inverse, design)
        pulled = design * (white / (1.0 - np.minimum(leverage, 0.99)))[:, None]
        held = np.zeros((1, values.size))
        held[0, delay] = 1.0 / self.prior
        spread = pulled.T @ pulled + held.T @ held
        scale = np.ones(values.size)
        scale[logs] = values[logs]
        residuals = self.equations.torque - law.predict(values, self.equations)
        robust = inverse @ spread @ inverse
        inflation = float(white @ white) / max(white.size - values.size, 1)
        own = np.diag(robust)
        wider = np.sqrt(np.maximum(inflation * np.diag(inverse) / np.where(own > 0.0, own, 1.0), 1.0))
        covariance = robust * np.outer(scale * wider, scale * wider)
        by_inertia = np.zeros(values.size)
        if law.inertia_error:
            column = self.whitened(law.by_inertia(values, self.equations)[:, None])[:, 0] / self._deviation
            by_inertia = -scale * (inverse @ (design.T @ column))
            covariance = covariance + law.inertia_error**2 * np.outer(by_inertia, by_inertia)
        own_covariance = inflation * inverse
        return MovingLawFit(
            law, values, covariance, residuals, chi, columns, own_covariance, attenuated, by_inertia
        )

    def _unbiased(self, law: MovingLaw, values: FloatArray, inverse: FloatArray) -> FloatArray:
        """The step that undoes what noise of the acceleration takes from the inertia."""
        index = law.names.index(INERTIA)
        share = self.noise_of_acceleration / self.noise.variance
        column = inverse[:, index]
        return np.asarray(column * share * values[index] / (1.0 - share * column[index]))

    def _step(
        self, law: MovingLaw, design: FloatArray, white: FloatArray, values: FloatArray, damping: float
    ) -> FloatArray:
        """The next step, with the delay held to its prior."""
        delay = law.names.index(DELAY)
        extra = np.zeros((1, values.size))
        extra[0, delay] = 1.0 / self.prior
        rows, right = np.vstack([design, extra]), np.append(white, -values[delay] / self.prior)
        size = np.sqrt(np.sum(rows**2, axis=0))
        size[size == 0.0] = 1.0
        rows = rows / size
        if damping:
            rows = np.vstack([rows, np.sqrt(damping) * np.eye(values.size)])
            right = np.append(right, np.zeros(values.size))
        return np.asarray(np.linalg.lstsq(rows, right, rcond=1e-10)[0] / size)


def _like(law: MovingLaw, near: MovingLawFit) -> FloatArray:
    """Values of a law from those of another: of the same name, or of both directions."""
    known = dict(zip(near.law.numbers, near.values, strict=True))
    by_kind = {each.kind: value for each, value in known.items()}
    by_kind.setdefault(STATIC, by_kind[COULOMB])
    return np.array([known.get(each, by_kind.get(each.kind, 0.0)) for each in law.numbers])
