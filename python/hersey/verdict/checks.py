"""What in the numbers of a nip does not fit, the farthest off first, and what else is to be known of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np

from hersey import _core
from hersey.damping.estimate import rounded
from hersey.errors import ParameterError
from hersey.lubrication.contact import Contact
from hersey.lubrication.film import shear_heating
from hersey.lubrication.film_result import REGIMES, Film
from hersey.lubrication.lubricant import Lubricant
from hersey.machine.machine import Machine
from hersey.schema.warning import Warning
from hersey.units import rpm
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


def nip_warnings(
    machine: Machine,
    film: Film,
    measured: MeasuredFilm | None = None,
    says: Verdict | None = None,
    turn: ContactTransition | None = None,
) -> tuple[Warning, ...]:
    """Return what does not fit, the farthest off first, then notes on numbers that fit.

    ``off`` among the values of the first is how many times its bound, or its interval, a number is off (1:
    just not). What cannot be is to be acted on; a formula outside its range, or a number beside its
    interval, is to be watched.

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
    notes = [*_on_thickening(lubricant, film), *_on_roughness(contact, film)]
    return (*sorted(found, key=lambda each: -each.number("off")), *notes)


def _on_thickening(lubricant: Lubricant, film: Film) -> Iterator[Warning]:
    if not lubricant.pressure_viscosity:
        return
    thickening = float(np.max(lubricant.alpha(film.temperature)) * film.nip.pressure_max)
    if thickening < MIN_THICKENING:
        yield Warning(
            "no thickening",
            "pressure does not thicken this lubricant here (alpha p = {thickening:.2g}), so Eqs. 5, "
            "9 and 10 do not apply",
            thickening=thickening,
        )


def _on_roughness(contact: Contact, film: Film) -> Iterator[Warning]:
    if contact.roughness is not None:
        least = float(film.lambda_ratio(contact.roughness).min())
        if LAMBDA_BANDS[0] <= least < LAMBDA_BANDS[1]:
            yield _thin(least, "mixed", LAMBDA_BANDS[1])


def _thin(least: float, kind: Literal["boundary", "mixed"], bound: float) -> Warning:
    """A film that by convention surfaces pierce; below the lower band it does not fit."""
    return Warning(
        f"{kind} lubrication",
        "predicted lambda ratio (minimum film over composite rms roughness) falls to {ratio:.2g}; "
        "below {bound:g} lubrication is {lubrication} by convention",
        severity="watch" if kind == "boundary" else "note",
        ratio=least,
        lubrication=kind,
        bound=bound,
        off=bound / least,
    )


def _both(machine: Machine) -> tuple[Contact, Lubricant]:
    if machine.contact is None or machine.lubricant is None:
        missing = "contact" if machine.contact is None else "lubricant"
        raise ParameterError(f"the machine has no [{missing}]. Add it to machine.toml")
    return machine.contact, machine.lubricant


def _apart(one: float, other: float) -> float:
    """How many times the smaller the larger is."""
    return max(one / other, other / one)


def _check_statements(machine: Machine, contact: Contact) -> Iterator[Warning]:
    if abs(contact.roll_radius / machine.roll_radius - 1.0) > _SAME:
        yield Warning(
            "two radii",
            "[contact] roll_radius is {contact:.4g mm}, but [drivetrain] roll_radius is "
            "{drivetrain:.4g mm}. Use the same value in both",
            severity="act",
            contact=contact.roll_radius,
            drivetrain=machine.roll_radius,
            off=_apart(contact.roll_radius, machine.roll_radius),
        )
    load = machine.limits.nip_load
    if load is not None and abs(contact.load / load - 1.0) > _SAME:
        yield Warning(
            "two loads",
            "[contact] load is {contact:.4g} N, but [limits] nip_load is {limits:.4g} N. Use the "
            "same value in both",
            severity="act",
            contact=contact.load,
            limits=load,
            off=_apart(contact.load, load),
        )


def _check_contact(contact: Contact, film: Film) -> Iterator[Warning]:
    nip = film.nip
    if not nip.paper_in_range:
        low, high = _core.NIP_RATIO_RANGE
        ratio = nip.paper_width / contact.rubber_thickness
        yield Warning(
            "beyond the regression of the nip",
            "nip/h = {ratio:.2g} is outside the range of Eq. 8, {low:g} to {high:g}, which is "
            "{error:+.0f %} off the solved nip",
            severity="watch",
            ratio=ratio,
            low=low,
            high=high,
            error=nip.paper_width / nip.width - 1.0,
            off=max(low / ratio, ratio / high),
        )
    if nip.strain > MAX_STRAIN:
        yield Warning(
            "large strain",
            "the strain of the layer (a^2/(2 R h)) is {strain:.0f %}; linear elasticity holds only up to "
            "about {limit:.0f %}",
            severity="watch",
            strain=nip.strain,
            limit=MAX_STRAIN,
            off=nip.strain / MAX_STRAIN,
        )
    if not np.all(film.inlet_short) and np.any(film.regime == REGIMES.index("isoviscous-elastic")):
        words = "the inlet is not short compared with layer and nip, so the soft-EHL law is only approximate"
        yield Warning("long inlet", words, severity="watch", off=1.0)
    if contact.roughness is not None:
        least = float(film.lambda_ratio(contact.roughness).min())
        if least < LAMBDA_BANDS[0]:
            yield _thin(least, "boundary", LAMBDA_BANDS[0])


def _check_lubricant(lubricant: Lubricant, film: Film) -> Iterator[Warning]:
    low, high = lubricant.temperature_range
    hottest, coldest = float(film.temperature.max()), float(film.temperature.min())
    if hottest > high + 0.5 or coldest < low - 0.5:
        yield Warning(
            "viscosity extrapolated",
            "viscosity is extrapolated: known from {low:.0f degC} to {high:.0f degC}, used from "
            "{coldest:.0f degC} to {hottest:.0f degC}",
            severity="watch",
            low=low,
            high=high,
            coldest=coldest,
            hottest=hottest,
            off=1.0 + max(hottest - high, low - coldest) / max(high - low, _WARM),
        )
    for name, correction in film.corrections.items():
        if not np.all(correction.valid):
            factor = float(correction.factor.min())
            yield Warning(
                "correction beyond its range",
                "{correction}: the factor (as low as {factor:.3g}) is outside the valid range of its formula",
                severity="watch",
                correction=name,
                factor=factor,
                off=_apart(factor, 1.0),
            )
    if lubricant.conductivity is not None:
        sliding, kelvin = 2.0 * film.entrainment_speed, film.temperature
        rise = float(np.max(shear_heating(lubricant, sliding_speed=sliding, temperature=kelvin)))
        if rise > _WARM:
            words = "shear heats the film by up to {rise:.2g} K above its walls, so it is thinner than stated"
            yield Warning("shear heating", words, severity="watch", rise=rise, off=rise / _WARM)


def _check_measured(measured: MeasuredFilm, contact: Contact) -> Iterator[Warning]:
    yield from _check_friction(float(measured.friction.max()), measured.grip)
    factor = measured.calibration.value
    if not 1 / _FAR < factor < _FAR:
        yield Warning(
            "torque off",
            "measured torque is {factor:.3g} times the prediction. Viscosity or nip is not as "
            "stated, or torque contains more than the film, which also changes the exponents",
            severity="act",
            factor=factor,
            off=_apart(factor, 1.0) / _FAR,
        )
    if measured.lambda_ratio is not None:
        thin = measured.lambda_ratio[measured.on_film > 0.5]
        if thin.size and float(thin.min()) < LAMBDA_BANDS[0]:
            least = float(thin.min())
            yield Warning(
                "measured film below roughness",
                "on the rising branch the measured film falls to {ratio:.2g} of the roughness "
                "({roughness:.2g um}), so film thickness alone does not explain the torque",
                severity="watch",
                ratio=least,
                roughness=contact.roughness or 0.0,
                off=LAMBDA_BANDS[0] / least,
            )


def _check_friction(highest: float, grip: float | None) -> Iterator[Warning]:
    if highest > MAX_FILM_FRICTION:
        yield Warning(
            "friction above a film",
            "friction coefficient {friction:.2g} is too high for a film. Above {limit:g}, surfaces "
            "touch or torque contains more than the nip's drag",
            severity="act",
            friction=highest,
            limit=MAX_FILM_FRICTION,
            off=highest / MAX_FILM_FRICTION,
        )
    if grip is not None and highest > grip:
        yield Warning(
            "friction above the grip",
            "friction coefficient {friction:.2g} exceeds that of the grip, {grip:g}, so the drive would slip",
            severity="act",
            friction=highest,
            grip=grip,
            off=highest / grip,
        )


def _check_exponents(says: Verdict) -> Iterator[Warning]:
    theory = says.expected if says.solved is None else says.solved
    c, thermal = says.exponent, says.thermal
    if says.contradicted:
        yield Warning(
            "exponent of speed",
            "the measured exponent of damping in speed is {shown}; the film of this nip predicts "
            "{predicted:.2f}",
            severity="act",
            shown=str(c),
            exponent=c.value,
            predicted=theory,
            off=_reaches(c.value, theory, c.low, c.high),
        )
    if thermal is not None and thermal.estimable and not agrees(thermal, says.thermal_expected):
        yield Warning(
            "exponent of temperature",
            "the measured exponent of damping in temperature (K) is {shown}; the film of this "
            "lubricant predicts {predicted:.2f}",
            severity="watch",
            shown=str(thermal),
            exponent=thermal.value,
            predicted=says.thermal_expected,
            off=_reaches(thermal.value, says.thermal_expected, thermal.low, thermal.high),
        )


def _check_transition(turn: ContactTransition) -> list[Warning]:
    """The temperature at which contact and log are farthest apart."""
    found = []
    for i, kelvin in enumerate(turn.temperature.tolist()):
        measured, low, high = (float(x[i]) for x in (turn.measured, turn.low, turn.high))
        if not (np.isfinite(low) and np.isfinite(high) and low > 0):
            continue
        speed = float(turn.speed[i])
        nowhere = np.isnan(speed)
        ends = (float(np.log(end)) for end in (measured, speed, low, high))
        found.append(
            Warning(
                "transition",
                "at {temperature:.0f degC} the contact model has no torque minimum, but the log has "
                "one at {shown}"
                if nowhere
                else "at {temperature:.0f degC} torque is lowest at {speed:.3g rpm} in the contact model, "
                "at {shown} in the log",
                severity="watch",
                temperature=kelvin,
                speed=speed,
                measured=measured,
                low=low,
                high=high,
                shown=rounded(rpm(measured), rpm(low), rpm(high), "rpm"),
                off=_NONE if nowhere else _reaches(*ends),
            )
        )
    worst = max(found, key=lambda one: one.number("off"), default=None)
    return [] if worst is None or worst.number("off") <= 1.0 else [worst]


def _reaches(value: float, other: float, low: float, high: float) -> float:
    """How many times the interval, on that side, another value is off; one at the least."""
    reach = high - value if other > value else value - low
    return max(1.0, abs(other - value) / max(reach, 1e-9 * max(abs(value), abs(other), 1.0)))
