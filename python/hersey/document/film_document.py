"""The film of a machine as text and as JSON, each law with its convention."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from hersey.damping.dwells import groups_of_temperature
from hersey.lubrication.contact import RULES, nip_width
from hersey.lubrication.film import CONSTANTS, REGIMES, Film, drag_torque
from hersey.machine.machine import Machine
from hersey.result import json_value
from hersey.units import celsius
from hersey.verdict.evidence import MeasuredFilm, Verdict


def film_summary(machine: Machine, film: Film, names: list[str], measured: MeasuredFilm | None) -> str:
    """Return nip, film and laws as text, the measured film beside them if there is one."""
    contact, lubricant, nip = machine.contact, machine.lubricant, film.nip
    assert contact is not None
    assert lubricant is not None
    rules = ", ".join(f"{rule} {1e3 * float(nip_width(contact, rule=rule)):.3g}" for rule in RULES)
    lines = [
        f"nip       {1e3 * nip.width:.3g} mm wide (by rule, mm: {rules}); "
        f"pressure {1e-6 * nip.pressure_mean:.3g} MPa mean, {1e-6 * nip.pressure_max:.3g} MPa at the centre",
        f"moduli    E' = {1e-6 * contact.effective_modulus:.4g} MPa = 2 E/(1 - nu^2), E* = E'/2; "
        f"the layer's soft film is {nip.layer_factor:.3g} of a half-space's",
        f"lubricant {lubricant.name}, {lubricant.model}",
        "",
        f"  {'point':16s} {'degC':>6s} {'eta mPa s':>10s} {'g_V':>9s} {'g_E':>9s} {'h_min um':>9s} "
        f"{'h_c um':>9s} {'torque N m':>11s}  regime",
    ]
    torque = drag_torque(contact, lubricant, speed=film.speed, temperature=film.temperature)
    for i, name in enumerate(names):
        lines.append(
            f"  {name[:16]:16s} {celsius(film.temperature[i]):6.1f} {1e3 * film.viscosity[i]:10.4g} "
            f"{film.g_v[i]:9.3g} {film.g_e[i]:9.3g} {1e6 * film.minimum[i] * film.factor[i]:9.3g} "
            f"{1e6 * film.central[i] * film.factor[i]:9.3g} {torque[i]:11.3g}  {REGIMES[film.regime[i]]}"
        )
    lines += ["", "minimum film by every law, um"]
    for law in CONSTANTS:
        if law.law in film.minima:
            values = " ".join(f"{1e6 * h:9.3g}" for h in film.minima[law.law])
            lines.append(f"  {law.law:22s} {values}  {law.formula}")
    lines.append(f"  all with {CONSTANTS[0].convention}")
    for name, correction in film.corrections.items():
        values = " ".join(f"{value:9.4g}" for value in correction.factor)
        where = "" if np.all(correction.valid) else "  (outside the validity of its rule)"
        lines.append(f"  factor, {name:14s} {values}{where}")
    if measured is not None:
        lines += ["", *_measured_lines(measured)]
    return "\n".join(lines)


def _measured_lines(measured: MeasuredFilm) -> list[str]:
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
        "  measured film eta A/B, A the nip; U sliding speed, p mean pressure of the nip; all dwells: --json"
    )
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


def film_document(
    machine: Machine,
    film: Film,
    names: list[str],
    measured: MeasuredFilm | None,
    verdict: Verdict | None,
    notes: tuple[str, ...],
) -> dict[str, Any]:
    """Return everything as JSON can hold it, in SI."""
    contact, lubricant = machine.contact, machine.lubricant
    assert contact is not None
    assert lubricant is not None
    document: dict[str, Any] = {
        "contact": asdict(contact)
        | {"effective_modulus": contact.effective_modulus, "reduced_radius": contact.reduced_radius},
        "lubricant": {
            "name": lubricant.name,
            "model": lubricant.model,
            "source": lubricant.source,
            "points": lubricant.points,
            "pressure_viscosity": lubricant.pressure_viscosity,
            "coefficients": lubricant.coefficients(),
        },
        "nip": asdict(film.nip) | {rule: float(nip_width(contact, rule=rule)) for rule in RULES},
        "laws": [asdict(law) for law in CONSTANTS],
        "film": _film(film)
        | {
            "names": names,
            "torque": drag_torque(contact, lubricant, speed=film.speed, temperature=film.temperature),
        },
        "notes": notes,
    }
    if measured is not None:
        hidden = ("predicted", "calibration")
        document["measured"] = {k: v for k, v in vars(measured).items() if k not in hidden} | {
            "predicted": _film(measured.predicted),
            "calibration": asdict(measured.calibration),
        }
    if verdict is not None:
        document["verdict"] = asdict(verdict)
    found: dict[str, Any] = json_value(document)
    return found


def _film(film: Film) -> dict[str, Any]:
    hidden = ("nip", "corrections", "regime", "speed")
    return {k: v for k, v in vars(film).items() if k not in hidden} | {
        "speed": film.speed,
        "regime": film.regime_names(),
        "corrections": {name: vars(c) for name, c in film.corrections.items()},
    }
