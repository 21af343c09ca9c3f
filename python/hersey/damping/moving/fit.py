"""`fit_moving`: the friction of a log whose torque and speed vary all the time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hersey.damping.distributions import square_above, student_quantile
from hersey.damping.estimate import CONFIDENCE, Estimate, estimate
from hersey.damping.friction_curve.fitted import DirectionTest
from hersey.damping.friction_curve.law import COULOMB, STATIC, STRIBECK_SPEED, FrictionLaw
from hersey.damping.inertia import inertia_of
from hersey.damping.moving.correlated import Autoregression
from hersey.damping.moving.filtering import Filtered, LowPass
from hersey.damping.moving.fitting import LEAST_SEEN, Fitting, MovingLawFit
from hersey.damping.moving.friction import LawTried, Moments, MovingParameter
from hersey.damping.moving.gravity import (
    AMPLITUDE,
    COSINE,
    HANGING,
    LEAST_ARC,
    SINE,
    arc_of,
    gravity_of,
    with_angles,
)
from hersey.damping.moving.misfit import misfit_of
from hersey.damping.moving.model import INERTIA, OFFSET, Equations, MovingLaw
from hersey.damping.moving.moving_warnings import CLEAR_OFFSET, moving_warnings
from hersey.damping.moving.refusals import (
    LEAST_EQUATIONS,
    refuse_coarse,
    refuse_constant,
    refuse_no_friction,
    too_few,
)
from hersey.damping.moving.result import MovingFit
from hersey.damping.moving.speed_noise import SpeedNoise, low_pass_for, speed_noise
from hersey.damping.moving.stretches import Stretch, counting_step, stretches_of
from hersey.errors import InsufficientDataError, ParameterError, Setting
from hersey.log.torque_log import TorqueLog
from hersey.units import takes_si

#: A drive slower than so many standard deviations of the noise of its speed, or than this share of its
#: greatest speed, may stand or turn either way: such rows are not used.
_CLEAR, _SLOW = 5.0, 0.01
#: AICc by which a law with more numbers must be better than one with fewer. It is not the
#: `EVIDENCE` of dwells: with this the laws of virtual joints come out right (`benchmarks.moving`).
MOVING_EVIDENCE = 10.0
#: Greatest error of the logarithm of a Stribeck speed that counts as known.
_KNOWN = 0.5
#: Kelvin that temperature must span so that friction may depend on it.
_WARMER = 3.0
#: Times what noise took from the inertia by which gravity must explain more, as both go with the angle where
#: the drive swings; least share of the torque (standard deviations) that gravity must be.
_REMAINS, _LEAST_GRAVITY = 4.0, 0.005
#: Friction that builds up from less than this share near standstill is that of sliding from so many of its
#: speed scales on; they are at most that share of the greatest speed, for a curve that bends all along is no
#: such thing.
_FROM_LESS, _BUILT_UP, _NEAR_REST = 0.5, 2.5, 0.5
#: Rounds in which the noise is judged by what a law leaves.
_ROUNDS = 3
#: Share of the variance of the noise of the first round, which is not known yet.
_FIRST = 1e-4
#: Moments that are kept to be shown, at the most.
_SHOWN = 800


@takes_si()
def fit_moving(log: TorqueLog, *, inertia: Any = None) -> MovingFit:
    """Fit friction, inertia and offset to every sample of a log that moves all the time.

    Parameters
    ----------
    log
        With torque and speed; temperature may be beside them.
    inertia
        Moment of inertia of all that the torque accelerates, kg m^2, if it is known, or text with its 95 %
        error: ``"0.012 kg*m^2 ± 2 %"``. Without an error it is taken as exact; if None, it is fitted.

    Raises
    ------
    InsufficientDataError
        If the speed hardly changes, too few rows are clear of standstill, torque and speed have opposite
        signs, or torque follows neither speed nor acceleration.

    Examples
    --------
    >>> import hersey, numpy as np, polars
    >>> t = np.arange(0.0, 30.0, 0.01)
    >>> w = 8.0 * np.sin(2.0 * t)
    >>> torque = 0.01 * 16.0 * np.cos(2.0 * t) + 0.3 * np.sign(w) + 0.02 * w
    >>> noisy = torque + np.random.default_rng(1).normal(0.0, 0.01, t.size)
    >>> columns = {"time (s)": t, "torque (N m)": noisy, "speed (rad/s)": w}
    >>> fit_moving(hersey.read(polars.DataFrame(columns), isothermal=True))["T_C"]
    Estimate(0.300 [0.299, 0.301] at 95 %)
    """
    known = None if inertia is None else inertia_of(inertia, may_be_none=True)
    log.domain.require_torque("a fit to every sample")
    subtracted = any(each.name == "inertia" for each in log.corrections)
    if subtracted and known is not None:
        given = Setting("inertia").to("0.01 kg*m^2")
        raise ParameterError(f"the mapping already subtracts the torque of the inertia. Omit {given}")
    name = log.files[0].name
    stretches = stretches_of(log)
    refuse_constant(name, stretches)
    noise = speed_noise(stretches, counting_step(log))
    stretches = with_angles(stretches)
    low_pass = low_pass_for(stretches, noise)
    if low_pass is None:
        raise InsufficientDataError(f"{name}: too few rows without a gap to fit a moving log")
    equations, least = _equations(stretches, noise, low_pass)
    refuse_coarse(name, noise, equations)
    if len(equations) < LEAST_EQUATIONS:
        raise too_few(name, equations, least)
    known = Estimate(0.0, 0.0, 0.0, 0.0) if subtracted else known
    fitting, fits = _fitted(log, equations, noise, low_pass, known)
    if sliding := _sliding_from(fits, equations):
        equations, least = _equations(stretches, noise, low_pass, sliding)
        if len(equations) < LEAST_EQUATIONS:
            raise too_few(name, equations, least)
        fitting, fits = _fitted(log, equations, noise, low_pass, known)
    chosen = _chosen(fits, equations)
    result = _result(log, _Made(fitting, equations, least, low_pass, noise), chosen, fits)
    refuse_no_friction(name, result, equations)
    if subtracted:
        result = replace(result, inertia_given=None)
    return replace(result, warnings=moving_warnings(result, equations))


@dataclass(frozen=True)
class _Made:
    """What was made of a log for a fit."""

    fitting: Fitting
    equations: Equations
    least: float
    low_pass: LowPass
    noise: SpeedNoise


def _equations(
    stretches: Sequence[Stretch], noise: SpeedNoise, low_pass: LowPass, sliding: float = 0.0
) -> tuple[Equations, float]:
    """Equations clear of standstill, and the least speed of them; none is slower than ``sliding``."""
    filtered = tuple(each for s in stretches if (each := Filtered.of(s, low_pass)) is not None)
    fastest = max(float(np.max(np.abs(each.speed))) for each in filtered)
    unsure = _CLEAR * float(np.sqrt(noise.behind(low_pass.smoother)))
    least = max(unsure, _SLOW * fastest, noise.least_counted(low_pass), sliding)
    return Equations(filtered, tuple(each.turning(least) for each in filtered)), least


def _fitted(
    log: TorqueLog, equations: Equations, noise: SpeedNoise, low_pass: LowPass, inertia: Estimate | None
) -> tuple[Fitting, list[MovingLawFit]]:
    """Return all laws, fitted with the noise that the largest leaves; the simplest come first."""
    both = bool(np.any(equations.speed > 0) and np.any(equations.speed < 0))
    kelvin = equations.temperature if log.has_temperature else None
    reference = float(np.mean(kelvin)) if kelvin is not None and np.ptp(kelvin) > _WARMER else None
    references = (None,) if reference is None else (None, reference)
    largest = references[-1]

    def law(stribeck: bool, apart: bool, warm: float | None, gravity: bool) -> MovingLaw:
        friction, offset = FrictionLaw(stribeck, apart, warm), both and not apart
        if inertia is None:
            return MovingLaw(friction, offset, gravity=gravity)
        return MovingLaw(friction, offset, inertia.value, inertia.error, gravity)

    unknown = Autoregression(np.empty(0), _FIRST * float(np.mean(equations.torque**2)))
    prior = low_pass.interval
    fitting = Fitting.of(equations, unknown, prior, noise.covariances(low_pass))
    turns = arc_of([each.stretch for each in equations.filtered]) > LEAST_ARC
    near = fitting.fit(law(True, False, largest, turns))
    full = law(True, both, largest, turns)
    for _ in range(_ROUNDS):
        near = fitting.fit(full, near)
        fitting = fitting.again(near)
    near = fitting.fit(full, near)
    if turns:
        without = fitting.fit(law(True, both, largest, False), near)
        turns = _gravity_shows(near, without, equations)
        if not turns:
            fitting = fitting.again(without)
            near = fitting.fit(without.law, without)
    fits = []
    for stribeck in (False, True):
        for apart in (False, True) if both else (False,):
            fits += [
                fitting.fit(law(stribeck, apart, warm, turns), near if stribeck else None)
                for warm in references
            ]
    return fitting, sorted(fits, key=lambda each: each.values.size)


def _sliding_from(fits: Sequence[MovingLawFit], equations: Equations) -> float:
    """Speed from which friction is that of sliding, if it builds up from less near standstill; else 0."""
    both = [each for each in fits if not each.law.friction.apart]
    bent, plain = (
        min((e for e in both if e.law.friction.stribeck is stribeck), key=MovingLawFit.criterion)
        for stribeck in (True, False)
    )
    speed = _BUILT_UP * bent.value(STRIBECK_SPEED)
    builds_up = bent.value(STATIC) < _FROM_LESS * bent.value(COULOMB)
    is_sure = bent.criterion() < plain.criterion() - MOVING_EVIDENCE
    is_near = speed <= _NEAR_REST * float(np.max(np.abs(equations.speed)))
    return speed if builds_up and is_sure and is_near else 0.0


def _gravity_shows(fitted: MovingLawFit, without: MovingLawFit, equations: Equations) -> bool:
    """Whether gravity is beyond doubt, no remainder of the inertia, and enough to matter."""
    doubt = MOVING_EVIDENCE + _REMAINS * without.attenuated
    if not fitted.criterion() < without.criterion() - doubt:
        return False
    terms = [fitted.value(name) for name in (COSINE, SINE)]
    return float(np.std(equations.gravity @ terms)) > _LEAST_GRAVITY * float(np.std(equations.torque))


def _chosen(fits: Sequence[MovingLawFit], equations: Equations) -> MovingLawFit:
    """The simplest law, unless a larger one that is determined is beyond doubt."""
    best = fits[0]
    for each in fits[1:]:
        if _determined(each, equations) and each.criterion() < best.criterion() - MOVING_EVIDENCE:
            best = each
    return best


def _determined(fitted: MovingLawFit, equations: Equations) -> bool:
    """Whether Stribeck's rise is one: higher near standstill, at a speed that the equations reach."""
    slowest = float(np.min(np.abs(equations.speed)))
    law = fitted.law.friction
    for index in fitted.law.positive:
        number = law.numbers[index]
        own = law.of_way(fitted.values[: len(law.numbers)], number.way)
        if own[STRIBECK_SPEED] <= 1.01 * LEAST_SEEN * slowest:
            return False
        if fitted.error(number.name) > _KNOWN * own[STRIBECK_SPEED] or own[STATIC] <= own[COULOMB]:
            return False
    return True


def _result(log: TorqueLog, made: _Made, chosen: MovingLawFit, fits: Sequence[MovingLawFit]) -> MovingFit:
    equations = made.equations
    noise = made.fitting.noise
    freedom = max(chosen.residuals.size / noise.together - chosen.values.size, 1.0)
    least = min(each.criterion() for each in fits)
    slow = equations.torque - chosen.law.value(chosen.values, INERTIA) * equations.acceleration
    explained = 1.0 - float(np.mean(chosen.residuals**2) / np.mean(slow**2))
    speeds = np.abs(equations.speed)
    kelvin = equations.temperature
    used = sum(int(np.count_nonzero(each)) for each in equations.used)
    moving = [np.abs(each.speed) >= made.least for each in equations.filtered]
    rows = sum(each.size for each in moving)
    friction = chosen.law.friction
    return MovingFit(
        law=chosen.law.title,
        parameters=tuple(_parameters(chosen, freedom)),
        inertia_given=chosen.law.inertia,
        laws=tuple(
            LawTried(each.law.title, each.values.size, each.criterion() - least, _determined(each, equations))
            for each in fits
        ),
        directions=_directions(chosen, fits),
        bandwidth=made.low_pass.bandwidth,
        used=used / sum(each.size for each in equations.used),
        near_standstill=1.0 - sum(int(np.count_nonzero(each)) for each in moving) / rows,
        least_speed=made.least,
        speed_range=(float(speeds.min()), float(speeds.max())),
        temperature_range=None if kelvin is None else (float(kelvin.min()), float(kelvin.max())),
        scatter=float(np.sqrt(np.mean(chosen.residuals**2))),
        explained=explained,
        effective_rows=chosen.residuals.size / noise.together,
        misfit=misfit_of(made.fitting, chosen),
        angle_recorded=all(run.position is not None for run in log.runs),
        friction_law=friction,
        values=chosen.values[: len(friction.names)],
        covariance=chosen.covariance[: len(friction.names), : len(friction.names)],
        moments=_moments(chosen, equations),
        warnings=(),
        log=log,
        fitted=chosen,
        fitting=made.fitting,
    )


def _directions(chosen: MovingLawFit, fits: Sequence[MovingLawFit]) -> DirectionTest | None:
    """Whether one law holds for both directions beside an offset, by the fall of chi-square."""
    of = chosen.law.friction
    same = {
        each.law.friction.apart: each for each in fits if replace(each.law.friction, apart=of.apart) == of
    }
    if len(same) < 2:
        return None
    gain = max(same[False].chi_square - same[True].chi_square, 0.0)
    more = same[True].values.size - same[False].values.size
    offset = None
    if of.apart:
        own = chosen.values[: len(of.numbers)]
        forward, reverse = (of.of_way(own, way)[COULOMB] for way in of.ways)
        offset = abs(forward - reverse) / 2.0
    elif abs(chosen.value(OFFSET)) > CLEAR_OFFSET * chosen.error(OFFSET):
        offset = abs(chosen.value(OFFSET))
    return DirectionTest(float(square_above(gain, more)), of.apart, offset)


def _moments(fitted: MovingLawFit, equations: Equations) -> Moments:
    """Friction of single moments, evenly over the log."""
    some = slice(None, None, -(-len(equations) // _SHOWN))
    law = fitted.law.friction
    own, kelvin = fitted.values[: len(law.names)], None
    if law.reference_kelvin is not None and equations.temperature is not None:
        kelvin = equations.temperature[some]
    speed = equations.speed[some]
    return Moments(speed, law.torque(own, speed, kelvin) + fitted.residuals[some])


def _parameters(fitted: MovingLawFit, freedom: float) -> list[MovingParameter]:
    units = fitted.law.units
    out = []
    for index, name in enumerate(fitted.law.names):
        if name == COSINE:
            out += _gravity(fitted, freedom)
        if name in (COSINE, SINE):
            continue
        value, error = float(fitted.values[index]), fitted.error(name)
        known = estimate(value, error, freedom)
        if index in fitted.law.positive:
            factor = float(np.exp(student_quantile(0.5 + CONFIDENCE / 2, freedom) * error / value))
            known = Estimate(value, error, value / factor, value * factor, freedom)
        out.append(MovingParameter(name, units[name], known))
    return out


def _gravity(fitted: MovingLawFit, freedom: float) -> list[MovingParameter]:
    """Amplitude and angle at rest of gravity."""
    at = [fitted.law.names.index(name) for name in (COSINE, SINE)]
    values, covariance = gravity_of(fitted.values[at], fitted.covariance[np.ix_(at, at)])
    errors = np.sqrt(np.diag(covariance))
    return [
        MovingParameter(name, unit, estimate(float(value), float(error), freedom))
        for name, unit, value, error in zip((AMPLITUDE, HANGING), ("N m", "rad"), values, errors, strict=True)
    ]
