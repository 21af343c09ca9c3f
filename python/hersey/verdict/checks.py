"""What in the numbers of a nip cannot be, or lies outside the range of a formula."""

from __future__ import annotations

import numpy as np

from hersey import _core
from hersey.errors import ParameterError
from hersey.lubrication.contact import Contact
from hersey.lubrication.film import REGIMES, Film, shear_heating
from hersey.lubrication.lubricant import Lubricant
from hersey.machine.machine import Machine
from hersey.units import celsius
from hersey.verdict.evidence import MeasuredFilm

#: Friction above this is no fluid film between smooth surfaces.
MAX_FILM_FRICTION = 0.3
#: Pressure thickens a lubricant by a tenth at alpha p = 0.1.
MIN_THICKENING = 0.1
#: Strain of rubber up to which linear elasticity is trusted.
MAX_STRAIN = 0.15
#: Lambda ratios below which surfaces touch, and above which they do not: conventions, not failure criteria.
LAMBDA_BANDS = (1.0, 3.0)
#: Measured drag over predicted beyond which magnitudes do not agree.
_FAR = 3.0
#: Two statements of one quantity may differ by this share.
_SAME = 0.01
#: A rise of temperature in the film that matters, K.
_WARM = 2.0


def check_film(machine: Machine, film: Film, measured: MeasuredFilm | None = None) -> tuple[str, ...]:
    """Return what in the numbers cannot be, or is outside the range of a formula.

    Parameters
    ----------
    machine
        With its contact and lubricant.
    film
        Predicted, at the points of interest.
    measured
        What a log says, if there is one.
    """
    contact, lubricant = _both(machine)
    notes = [*_check_statements(machine, contact), *_check_contact(contact, film)]
    notes += _check_lubricant(lubricant, film)
    if contact.roughness is not None:
        least = float(film.lambda_ratio(contact.roughness).min())
        if least < LAMBDA_BANDS[1]:
            kind = "boundary" if least < LAMBDA_BANDS[0] else "mixed"
            notes.append(
                f"predicted lambda ratio down to {least:.2g} (minimum film over composite rms roughness): by "
                f"convention {kind} lubrication below {LAMBDA_BANDS[0 if kind == 'boundary' else 1]:g}"
            )
    if measured is not None:
        notes += _check_measured(measured, contact)
    return tuple(notes)


def _both(machine: Machine) -> tuple[Contact, Lubricant]:
    if machine.contact is None or machine.lubricant is None:
        missing = "contact" if machine.contact is None else "lubricant"
        raise ParameterError(f"the machine has no [{missing}]: state it in machine.toml")
    return machine.contact, machine.lubricant


def _check_statements(machine: Machine, contact: Contact) -> list[str]:
    notes = []
    if abs(contact.roll_radius / machine.roll_radius - 1.0) > _SAME:
        notes.append(
            f"[contact] roll_radius is {1e3 * contact.roll_radius:.4g} mm, [drivetrain] roll_radius "
            f"{1e3 * machine.roll_radius:.4g} mm: one roll has one radius"
        )
    load = machine.limits.nip_load
    if load is not None and abs(contact.load / load - 1.0) > _SAME:
        notes.append(f"[contact] load is {contact.load:.4g} N, [limits] nip_load {load:.4g} N: say which")
    return notes


def _check_contact(contact: Contact, film: Film) -> list[str]:
    nip, notes = film.nip, []
    if not nip.paper_in_range:
        low, high = _core.NIP_RATIO_RANGE
        notes.append(
            f"nip/h = {nip.paper_width / contact.rubber_thickness:.2g} is outside the range of the "
            f"regression of Eq. 8, {low:g} to {high:g}: "
            f"it is {100 * (nip.paper_width / nip.width - 1):+.0f} % off the solved nip"
        )
    if nip.strain > MAX_STRAIN:
        notes.append(
            f"the rubber is strained by {100 * nip.strain:.0f} % (a^2/(2 R h)): linear elasticity ends near "
            f"{100 * MAX_STRAIN:.0f} %"
        )
    if not np.all(film.inlet_short) and np.any(film.regime == REGIMES.index("isoviscous-elastic")):
        notes.append("the inlet of the film is not short against rubber and nip: the soft law is rough there")
    return notes


def _check_lubricant(lubricant: Lubricant, film: Film) -> list[str]:
    notes = []
    if lubricant.pressure_viscosity:
        thickening = float(np.max(lubricant.alpha(film.temperature)) * film.nip.pressure_max)
        if thickening < MIN_THICKENING:
            notes.append(
                f"alpha p = {thickening:.2g}: pressure does not thicken this lubricant in this nip, so "
                "Eqs. 5, 9 and 10 of the paper do not apply"
            )
    low, high = lubricant.temperature_range
    hottest, coldest = float(film.temperature.max()), float(film.temperature.min())
    if hottest > high + 0.5 or coldest < low - 0.5:
        notes.append(
            f"viscosity is extrapolated: known from {celsius(low):.0f} to {celsius(high):.0f} degC, used "
            f"from {celsius(coldest):.0f} to {celsius(hottest):.0f} degC"
        )
    for name, correction in film.corrections.items():
        if not np.all(correction.valid):
            notes.append(
                f"{name}: the factor (down to {float(correction.factor.min()):.3g}) is outside the "
                "validity of its rule"
            )
    if lubricant.conductivity is not None:
        rise = float(
            np.max(
                shear_heating(
                    lubricant, sliding_speed=2.0 * film.entrainment_speed, temperature=film.temperature
                )
            )
        )
        if rise > _WARM:
            notes.append(
                f"shear warms the film by up to {rise:.2g} K over its walls: it is thinner than stated"
            )
    return notes


def _check_measured(measured: MeasuredFilm, contact: Contact) -> list[str]:
    notes = []
    highest = float(measured.friction.max())
    if highest > MAX_FILM_FRICTION:
        notes.append(
            f"friction coefficient {highest:.2g} is not a fluid film: above {MAX_FILM_FRICTION:g} surfaces "
            "touch, or torque holds more than the nip's drag"
        )
    if measured.grip is not None and highest > measured.grip:
        notes.append(
            f"friction coefficient {highest:.2g} exceeds that of belt on roll, {measured.grip:g}: "
            "it would slip"
        )
    factor = measured.calibration
    if not 1 / _FAR < factor.value < _FAR:
        notes.append(
            f"measured torque is {factor.value:.3g} times the predicted one: viscosity, nip or what the "
            "torque holds besides the film is not as stated; the last of these moves exponents too"
        )
    if measured.lambda_ratio is not None:
        thin = measured.lambda_ratio[measured.on_film > 0.5]
        if thin.size and float(thin.min()) < LAMBDA_BANDS[0]:
            notes.append(
                f"the measured film is down to {float(thin.min()):.2g} of the roughness "
                f"({1e6 * (contact.roughness or 0.0):.2g} um) where torque rises with speed: not thickness "
                "alone makes this drag"
            )
    return notes
