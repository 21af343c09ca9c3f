"""What in the numbers of a nip does not fit, the farthest off first, and what else is to be known of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hersey import _core
from hersey.errors import ParameterError
from hersey.lubrication.contact import Contact
from hersey.lubrication.film import shear_heating
from hersey.lubrication.film_result import REGIMES, Film
from hersey.lubrication.lubricant import Lubricant
from hersey.machine.machine import Machine
from hersey.units import celsius, rpm
from hersey.verdict.contact_verdict import Verdict, agrees
from hersey.verdict.evidence import MeasuredFilm
from hersey.verdict.transition import ContactTransition

#: Friction above this is no fluid film between smooth surfaces.
MAX_FILM_FRICTION = 0.3
#: Pressure thickens a lubricant by a tenth at alpha p = 0.1.
MIN_THICKENING = 0.1
#: Strain of rubber up to which linear elasticity is trusted.
MAX_STRAIN = 0.15
#: Lambda ratios below which surfaces touch, and above which they do not: conventions, not failure criteria.
LAMBDA_BANDS = (1.0, 3.0)
#: How far off a film that is to make a transition is, where the contact has none.
_NONE = 3.0
#: Measured drag over predicted beyond which magnitudes do not agree.
_FAR = 3.0
#: Two statements of one quantity may differ by this share.
_SAME = 0.01
#: A rise of temperature in the film that matters, K.
_WARM = 2.0


@dataclass(frozen=True)
class Misfit:
    """What does not fit; ``size`` is how many times its bound, or its interval, it is off (1: just not).

    ``grave`` is what cannot be, as against a formula outside its range or a number beside its interval.
    """

    text: str
    size: float
    grave: bool = False


def misfits(
    machine: Machine,
    film: Film,
    measured: MeasuredFilm | None = None,
    says: Verdict | None = None,
    turn: ContactTransition | None = None,
) -> tuple[Misfit, ...]:
    """Return what does not fit, the farthest off first.

    Parameters
    ----------
    machine
        With its contact and lubricant.
    film
        Predicted, at the points of interest.
    measured, says
        What a log says, and its exponents, if there is one.
    turn
        Where drag is least by the contact, if it says who shares the load.
    """
    contact, lubricant = _both(machine)
    found = [*_check_statements(machine, contact), *_check_contact(contact, film)]
    found += _check_lubricant(lubricant, film)
    if measured is not None:
        found += _check_measured(measured, contact)
    if says is not None:
        found += _check_exponents(says)
    if turn is not None:
        found += _check_transition(turn)
    return tuple(sorted(found, key=lambda each: -each.size))


def remarks(machine: Machine, film: Film) -> tuple[str, ...]:
    """Return what is to be known of a film whose numbers fit; the arguments are those of `misfits`."""
    contact, lubricant = _both(machine)
    notes = []
    if lubricant.pressure_viscosity:
        thickening = float(np.max(lubricant.alpha(film.temperature)) * film.nip.pressure_max)
        if thickening < MIN_THICKENING:
            notes.append(
                f"alpha p = {thickening:.2g}: pressure does not thicken this lubricant in this nip, so "
                "Eqs. 5, 9 and 10 of the paper do not apply"
            )
    if contact.roughness is not None:
        least = float(film.lambda_ratio(contact.roughness).min())
        if LAMBDA_BANDS[0] <= least < LAMBDA_BANDS[1]:
            notes.append(_thin(least, "mixed", LAMBDA_BANDS[1]))
    return tuple(notes)


def _thin(least: float, kind: str, bound: float) -> str:
    return (
        f"predicted lambda ratio down to {least:.2g} (minimum film over composite rms roughness): by "
        f"convention {kind} lubrication below {bound:g}"
    )


def _both(machine: Machine) -> tuple[Contact, Lubricant]:
    if machine.contact is None or machine.lubricant is None:
        missing = "contact" if machine.contact is None else "lubricant"
        raise ParameterError(f"the machine has no [{missing}]: state it in machine.toml")
    return machine.contact, machine.lubricant


def _apart(one: float, other: float) -> float:
    """How many times the smaller the larger is."""
    return max(one / other, other / one)


def _check_statements(machine: Machine, contact: Contact) -> Iterator[Misfit]:
    if abs(contact.roll_radius / machine.roll_radius - 1.0) > _SAME:
        text = (
            f"[contact] roll_radius is {1e3 * contact.roll_radius:.4g} mm, [drivetrain] roll_radius "
            f"{1e3 * machine.roll_radius:.4g} mm: one roll has one radius"
        )
        yield Misfit(text, _apart(contact.roll_radius, machine.roll_radius), grave=True)
    load = machine.limits.nip_load
    if load is not None and abs(contact.load / load - 1.0) > _SAME:
        text = f"[contact] load is {contact.load:.4g} N, [limits] nip_load {load:.4g} N: say which"
        yield Misfit(text, _apart(contact.load, load), grave=True)


def _check_contact(contact: Contact, film: Film) -> Iterator[Misfit]:
    nip = film.nip
    if not nip.paper_in_range:
        low, high = _core.NIP_RATIO_RANGE
        ratio = nip.paper_width / contact.rubber_thickness
        text = (
            f"nip/h = {ratio:.2g} is outside the range of the "
            f"regression of Eq. 8, {low:g} to {high:g}: "
            f"it is {100 * (nip.paper_width / nip.width - 1):+.0f} % off the solved nip"
        )
        yield Misfit(text, max(low / ratio, ratio / high))
    if nip.strain > MAX_STRAIN:
        text = (
            f"the rubber is strained by {100 * nip.strain:.0f} % (a^2/(2 R h)): linear elasticity ends near "
            f"{100 * MAX_STRAIN:.0f} %"
        )
        yield Misfit(text, nip.strain / MAX_STRAIN)
    if not np.all(film.inlet_short) and np.any(film.regime == REGIMES.index("isoviscous-elastic")):
        text = "the inlet of the film is not short against rubber and nip: the soft law is rough there"
        yield Misfit(text, 1.0)
    if contact.roughness is not None:
        least = float(film.lambda_ratio(contact.roughness).min())
        if least < LAMBDA_BANDS[0]:
            yield Misfit(_thin(least, "boundary", LAMBDA_BANDS[0]), LAMBDA_BANDS[0] / least)


def _check_lubricant(lubricant: Lubricant, film: Film) -> Iterator[Misfit]:
    low, high = lubricant.temperature_range
    hottest, coldest = float(film.temperature.max()), float(film.temperature.min())
    if hottest > high + 0.5 or coldest < low - 0.5:
        text = (
            f"viscosity is extrapolated: known from {celsius(low):.0f} to {celsius(high):.0f} degC, used "
            f"from {celsius(coldest):.0f} to {celsius(hottest):.0f} degC"
        )
        known = max(high - low, _WARM)
        yield Misfit(text, 1.0 + max(hottest - high, low - coldest) / known)
    for name, correction in film.corrections.items():
        if not np.all(correction.valid):
            factor = float(correction.factor.min())
            text = f"{name}: the factor (down to {factor:.3g}) is outside the validity of its rule"
            yield Misfit(text, _apart(factor, 1.0))
    if lubricant.conductivity is not None:
        sliding, kelvin = 2.0 * film.entrainment_speed, film.temperature
        rise = float(np.max(shear_heating(lubricant, sliding_speed=sliding, temperature=kelvin)))
        if rise > _WARM:
            text = f"shear warms the film by up to {rise:.2g} K over its walls: it is thinner than stated"
            yield Misfit(text, rise / _WARM)


def _check_measured(measured: MeasuredFilm, contact: Contact) -> Iterator[Misfit]:
    highest = float(measured.friction.max())
    if highest > MAX_FILM_FRICTION:
        text = (
            f"friction coefficient {highest:.2g} is not a fluid film: above {MAX_FILM_FRICTION:g} surfaces "
            "touch, or torque holds more than the nip's drag"
        )
        yield Misfit(text, highest / MAX_FILM_FRICTION, grave=True)
    if measured.grip is not None and highest > measured.grip:
        text = (
            f"friction coefficient {highest:.2g} exceeds that of belt on roll, {measured.grip:g}: "
            "it would slip"
        )
        yield Misfit(text, highest / measured.grip, grave=True)
    factor = measured.calibration.value
    if not 1 / _FAR < factor < _FAR:
        text = (
            f"measured torque is {factor:.3g} times the predicted one: viscosity, nip or what the "
            "torque holds besides the film is not as stated; the last of these moves exponents too"
        )
        yield Misfit(text, _apart(factor, 1.0) / _FAR, grave=True)
    if measured.lambda_ratio is not None:
        thin = measured.lambda_ratio[measured.on_film > 0.5]
        if thin.size and float(thin.min()) < LAMBDA_BANDS[0]:
            least = float(thin.min())
            text = (
                f"the measured film is down to {least:.2g} of the roughness "
                f"({1e6 * (contact.roughness or 0.0):.2g} um) where torque rises with speed: not thickness "
                "alone makes this drag"
            )
            yield Misfit(text, LAMBDA_BANDS[0] / least)


def _check_exponents(says: Verdict) -> Iterator[Misfit]:
    theory = says.expected if says.solved is None else says.solved
    c, thermal = says.exponent, says.thermal
    if says.contradicted:
        text = f"damping goes as speed to the power {c}; the film of this nip gives {theory:.2f}"
        yield Misfit(text, _reaches(c.value, theory, c.low, c.high), grave=True)
    if thermal is not None and thermal.estimable and not agrees(thermal, says.thermal_expected):
        text = (
            f"with temperature (K) damping goes to the power {thermal}; the film of this lubricant predicts "
            f"{says.thermal_expected:.2f}"
        )
        size = _reaches(thermal.value, says.thermal_expected, thermal.low, thermal.high)
        yield Misfit(text, size)


def _check_transition(turn: ContactTransition) -> list[Misfit]:
    """The temperature at which contact and log are farthest apart."""
    worst = Misfit("", 1.0)
    for i, kelvin in enumerate(turn.temperature.tolist()):
        value, low, high = (float(x[i]) for x in (turn.measured, turn.low, turn.high))
        if not (np.isfinite(low) and np.isfinite(high) and low > 0):
            continue
        log = f"by the log at {rpm(value):.3g} rpm [{rpm(low):.3g}, {rpm(high):.3g}]"
        at = f"at {celsius(kelvin):.0f} degC"
        speed = float(turn.speed[i])
        if np.isnan(speed):
            each = Misfit(f"by the contact as stated drag falls nowhere {at}, {log} it is least", _NONE)
        else:
            ends = (np.log(end) for end in (value, speed, low, high))
            size = _reaches(*(float(end) for end in ends))
            each = Misfit(f"by the contact as stated drag is least {at} at {rpm(speed):.3g} rpm, {log}", size)
        worst = max(worst, each, key=lambda one: one.size)
    return [worst] if worst.size > 1.0 else []


def _reaches(value: float, other: float, low: float, high: float) -> float:
    """How many times the interval, on that side, another value is off; one at the least."""
    reach = high - value if other > value else value - low
    return max(1.0, abs(other - value) / max(reach, 1e-9 * max(abs(value), abs(other), 1.0)))
