"""From failures and suspensions to their law: `weibull`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import chi2

from hersey.arrays import FloatArray, numbers_of, one_thread
from hersey.errors import ParameterError
from hersey.life.failures.acceleration import Acceleration, covariate_of
from hersey.life.failures.distributions import DISTRIBUTIONS, Distribution, distribution_named
from hersey.life.failures.draws import draws_of
from hersey.life.failures.fit import Fit, age_held, effect_held, fitted, shape_held
from hersey.life.failures.goodness import goodness_of_fit
from hersey.life.failures.law import SHOWN, FailureLaw
from hersey.life.failures.records import BLife, LawComparison, LawParameter, ModeLaw
from hersey.life.failures.sample import Failures
from hersey.life.failures.table import read_failures
from hersey.life.failures.warnings import (
    few_failures,
    law_warnings,
    modes_under_stress,
    no_law,
    stress_warnings,
    unknown_modes,
)
from hersey.schema.warning import Warning
from hersey.units import takes_si

#: Fewest failures that determine a law.
_LEAST = 2
#: A share, where none matters.
_HALF = np.array([0.5])


@one_thread()
@takes_si()
def weibull(
    failures: Failures | str | Path | ArrayLike,
    failed: ArrayLike | None = None,
    *,
    unit: str = "",
    law: str = "weibull",
    shape: float | None = None,
    level: float = 0.90,
    calibrate: bool = True,
    seed: int = 0,
) -> FailureLaw:
    """Return the law of ages at failure of specimens, some of which may not have failed.

    Parameters
    ----------
    failures
        A table (its path, see `read_failures`), what was read of one, or the age of each specimen at
        failure or when last seen, shape (specimens,).
    failed
        Whether each specimen has failed, shape (specimens,), if ages are given.
    unit
        Unit of the ages, e.g. "pages" or "h", if ages are given.
    law
        "weibull", "lognormal" or "gamma".
    shape
        Shape of the law, if it is known; only the scale is then estimated.
    level
        Level of the two-sided bounds, e.g. 0.9.
    calibrate
        Whether bounds are calibrated where failures are few; False gives the usual ones, of chi-square.
    seed
        Random seed.

    Raises
    ------
    ParameterError
        If an age is not greater than 0 (with its index), or arguments do not match.

    Examples
    --------
    >>> law = weibull([54, 187, 216, 240, 244, 335, 361, 373, 375, 386, 500], [True] * 10 + [False])
    >>> [(each.name, round(each.value, 3)) for each in law.parameters]
    [('shape', 2.457), ('scale', 340.455)]
    """
    if not 0 < level < 1:
        raise ParameterError(f"level is {level}: it must be between 0 and 1", quantity="level")
    if shape is not None and not (np.isfinite(shape) and shape > 0):
        raise ParameterError(f"shape is {shape}: it must be greater than 0", quantity="shape")
    sample = _sample(failures, failed, unit)
    chosen = distribution_named(law)
    covariate, stress = _stress(sample)
    fits, warnings = _fits(chosen, sample, covariate, shape, seed, calibrate)
    single = fits[0] if len(fits) == 1 else None
    others = () if single is None or shape is not None else _others(single)
    compared = _compared(single, others)
    acceleration = None if single is None else _acceleration(single, sample, level)
    found = FailureLaw(
        law=law,
        unit=sample.unit,
        specimens=sample.specimens,
        failures=sample.failures,
        parameters=() if single is None else _parameters(single, level, stress, sample.unit),
        b_lives=(),
        level=level,
        calibrated=bool(fits) and all(each.replicates is not None for each in fits),
        log_likelihood=None if single is None else log_likelihood(single),
        comparison=compared,
        goodness=None if single is None else goodness_of_fit(single),
        modes=_modes(fits, sample, level, stress) if len(fits) > 1 else (),
        acceleration=acceleration,
        warnings=(*warnings, *law_warnings(compared, law), *stress_warnings(acceleration)),
        sample=sample,
        fits=fits,
        stress=stress,
        seed=seed,
    )
    if not fits:
        return found
    ages, low, high = found.lives(SHOWN)
    lives = zip(SHOWN, ages.tolist(), low.tolist(), high.tolist(), strict=True)
    return replace(found, b_lives=tuple(BLife(*each, level) for each in lives))


def log_likelihood(fit: Fit) -> float:
    """Return the logarithm of the likelihood of the ages, not of their logarithms."""
    exact = fit.sample.exact
    return fit.log_likelihood - float((fit.sample.count[exact] * np.log(fit.sample.low[exact])).sum())


def _sample(failures: Failures | str | Path | ArrayLike, failed: ArrayLike | None, unit: str) -> Failures:
    if isinstance(failures, Failures):
        return failures
    if isinstance(failures, str | Path):
        return read_failures(failures)
    values = numbers_of("ages", failures)
    if failed is None:
        raise ParameterError(
            "failed is missing: say of each specimen whether it has failed", quantity="failed"
        )
    ends = np.asarray(failed)
    if values.ndim != 1 or ends.shape != values.shape:
        raise ParameterError(f"ages {values.shape} and failed {ends.shape} must be lists of equal length")
    if ends.dtype != bool:
        raise ParameterError("failed must be true or false for each specimen", quantity="failed")
    wrong = np.flatnonzero(~(np.isfinite(values) & (values > 0)))
    if wrong.size:
        place = int(wrong[0])
        raise ParameterError(
            f"age {place} is {values[place]:g}: it must be greater than 0", quantity="ages", index=place
        )
    return Failures(values, np.where(ends, values, np.inf), np.ones(values.size, dtype=int), unit)


def _stress(sample: Failures) -> tuple[FloatArray | None, float]:
    """What acts on ln age of each row, about its mean, and the same of the stress of use."""
    relation = sample.relation
    if relation is None or sample.stress is None or sample.use is None:
        return None, 0.0
    acts = covariate_of(relation, sample.stress)
    if np.unique(acts[sample.failed]).size < _LEAST:
        raise ParameterError(
            "specimens failed at one stress only, so how life depends on it is unknown",
            remedy="add failures at a second stress",
            quantity="stress",
        )
    middle = float(np.average(acts, weights=sample.count))
    return acts - middle, float(covariate_of(relation, sample.use)) - middle


def _fits(
    law: Distribution,
    sample: Failures,
    covariate: FloatArray | None,
    shape: float | None,
    seed: int,
    calibrate: bool,
) -> tuple[tuple[Fit, ...], tuple[Warning, ...]]:
    """The law of each failure mode, or that of all failures, with warnings; none where it is unknown."""
    least = _LEAST if shape is None else 1
    if sample.failures < least:
        return (), (no_law(sample),)
    whole = fitted(law, sample, covariate, known=shape, seed=seed, calibrated=calibrate)
    if shape is None and not (whole.is_estimable and _spreads(sample)):
        return (), (no_law(sample, flat=whole.is_flat),)
    few = few_failures(sample) if shape is None else ()
    modes = sample.modes
    if len(modes) < _LEAST:
        return (whole,), few
    if covariate is not None:
        return (whole,), (*few, modes_under_stress(modes))
    samples = [sample.of_mode(mode) for mode in modes]
    lacking = [mode for mode, own in zip(modes, samples, strict=True) if own.failures < least]
    if lacking:
        return (whole,), (*few, unknown_modes(tuple(lacking)))
    fits = tuple(
        fitted(law, own, known=shape, seed=seed + number, calibrated=calibrate)
        for number, own in enumerate(samples)
    )
    narrow = [mode for mode, fit in zip(modes, fits, strict=True) if not fit.is_estimable]
    return ((whole,), (*few, unknown_modes(tuple(narrow)))) if narrow else (fits, few)


def _spreads(sample: Failures) -> bool:
    """Whether some specimen outlived the first failure, so that ages have a spread."""
    return bool(sample.high[sample.failed].min() < max(sample.high[sample.failed].max(), sample.low.max()))


def _parameters(fit: Fit, level: float, stress: float, unit: str) -> tuple[LawParameter, ...]:
    """Shape and scale with their bounds, under a stress; sigma of the lognormal law is the inverse of k."""
    shape_name, scale_name = fit.law.parameters
    inverse = fit.law.name == "lognormal"
    value = 1 / fit.k if inverse else fit.k
    if fit.known is not None:
        own = LawParameter(shape_name, value, value, value, "")
    else:
        low, high = (float(np.exp(each[0])) for each in fit.bounds(_HALF, level, shape_held))
        ends = (1 / high, 1 / low) if inverse else (low, high)
        own = LawParameter(shape_name, value, ends[0], ends[1], "")
    scale = float(np.exp(fit.m + fit.c * stress))
    if fit.law.name == "gamma":  # which is no age of one share
        drawn = draws_of(fit)
        low, high = np.quantile(np.exp(drawn.m + drawn.c * stress), [0.5 - level / 2, 0.5 + level / 2])
        return own, LawParameter(scale_name, scale, float(low), float(high), unit)
    share = np.array([1 - np.exp(-1.0) if fit.law.name == "weibull" else 0.5])
    with np.errstate(over="ignore"):
        low, high = (float(np.exp(each[0])) for each in fit.bounds(share, level, age_held, stress))
    return own, LawParameter(scale_name, scale, low, high, unit)


def _others(fit: Fit) -> tuple[Fit, ...]:
    covariate = fit.covariate if fit.accelerated else None
    others = (each for name, each in DISTRIBUTIONS.items() if name != fit.law.name)
    return tuple(fitted(each, fit.sample, covariate, seed=fit.seed) for each in others)


def _compared(fit: Fit | None, others: Sequence[Fit]) -> tuple[LawComparison, ...]:
    """The laws, the best first."""
    fits = [] if fit is None else [fit, *others]
    rows = [(each.law.name, log_likelihood(each), each.parameters) for each in fits]
    compared = [LawComparison(name, value, 2.0 * count - 2.0 * value) for name, value, count in rows]
    return tuple(sorted(compared, key=lambda each: each.aic))


def _modes(fits: tuple[Fit, ...], sample: Failures, level: float, stress: float) -> tuple[ModeLaw, ...]:
    found = []
    for mode, fit in zip(sample.modes, fits, strict=True):
        low, high = fit.bounds(np.array([SHOWN[0]]), level, age_held, stress)
        with np.errstate(over="ignore"):
            life = BLife(
                SHOWN[0], float(fit.age(SHOWN[0])), float(np.exp(low[0])), float(np.exp(high[0])), level
            )
        found.append(ModeLaw(mode, fit.sample.failures, _parameters(fit, level, stress, sample.unit), life))
    return tuple(found)


def _acceleration(fit: Fit, sample: Failures, level: float) -> Acceleration | None:
    if sample.relation is None or sample.use is None or sample.stress is None:
        return None
    low, high = (float(each[0]) for each in fit.bounds(_HALF, level, effect_held))
    tested = sample.stress
    return Acceleration(
        relation=sample.relation,
        effect=fit.c,
        low=low,
        high=high,
        use=sample.use,
        lowest=float(tested.min()),
        highest=float(tested.max()),
        unit="K" if sample.relation == "arrhenius" else sample.stress_unit,
        same_shape=_same_shape(fit, sample),
    )


def _same_shape(fit: Fit, sample: Failures) -> float | None:
    """Likelihood-ratio test of one shape and one relation against a law of its own at each stress."""
    total, free = 0.0, 0
    for stress in np.unique(fit.covariate):
        own = sample.at(fit.covariate == stress)
        if own.failures == 0:
            continue
        if own.failures < _LEAST:
            return None
        alone = fitted(fit.law, own, known=fit.known)
        if not alone.is_estimable:
            return None
        total, free = total + alone.log_likelihood, free + alone.parameters
    more = free - fit.parameters
    return float(chi2.sf(2 * max(total - fit.log_likelihood, 0.0), more)) if more > 0 else None
