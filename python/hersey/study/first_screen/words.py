"""Numbers as the first screen writes them: two or three figures, °C, a true minus, intervals outward."""

from __future__ import annotations

import math

from hersey.schema.noun import puller_of
from hersey.stability.operating_map import OperatingMap
from hersey.units import celsius
from hersey.units import rpm as in_rpm

#: Units of a torque, and how many of them a N m is.
PER = {"N·m": 1.0, "mN·m": 1e3}
MINUS = "\N{MINUS SIGN}"


def mm(speed: float) -> str:
    """Return a speed (m/s) in mm/s, without the unit."""
    return figures(1e3 * speed)


def roll(speed: float) -> str:
    """Return a rotational speed (rad/s) in rpm, without the unit."""
    return figures(float(in_rpm(speed)))


def degrees(kelvin: float) -> str:
    """Return a temperature."""
    return f"{celsius(kelvin):.0f} °C".replace("-", MINUS)


def at(kelvin: float | None, *, first: bool = True) -> str:
    """Return ``At 180 °C `` to begin a sentence (or ``at``), nothing where there are no temperatures."""
    if kelvin is None:
        return ""
    return f"{'At' if first else 'at'} {degrees(kelvin)} "


def signed(value: float) -> str:
    """Return an exponent to two places."""
    return f"{value:.2f}".replace("-", MINUS)


def figures(value: float, *, up: bool | None = None) -> str:
    """Return a positive number to two figures, from 100 on to the whole; ``up`` says which way."""
    if not math.isfinite(value) or value <= 0:
        return "0" if value == 0 else "∞"
    place = 0 if value >= 100 else 1 - math.floor(math.log10(value))
    scaled = value * 10.0**place
    nearest = round(scaled)
    if up is None or math.isclose(scaled, nearest, rel_tol=1e-9):
        whole = nearest
    else:
        whole = math.ceil(scaled) if up else math.floor(scaled)
    return f"{whole / 10.0**place:.{max(place, 0)}f}"


def within(low: float, high: float, factor: float) -> str:
    """Return an interval in brackets, rounded outward; ``factor`` leads to its unit."""
    return f"[{figures(low * factor, up=False)}, {figures(high * factor, up=True)}]"


def between(what: str, value: float, low: float, high: float) -> str:
    """Return a speed (m/s) with its interval in mm/s; the interval alone where there is no estimate."""
    if math.isnan(value):
        ends = figures(1e3 * low, up=False), figures(1e3 * high, up=True)
        return f"{what} {ends[0]} to {ends[1]} mm/s"
    return f"{what} {mm(value)} mm/s {within(low, high, 1e3)}"


def torque(value: float, unit: str, *, up: bool | None = None) -> str:
    """Return a torque (N m) in the unit of the document."""
    return f"{figures(value * PER[unit], up=up)} {unit}"


def giving(map_: OperatingMap) -> str:
    """Return what limits the torque, as the subject of what it gives."""
    motor = map_.limited_by == "motor torque"
    return "the motor gives" if motor else f"the {puller_of(map_.train.part)} grips"


def starting(low: float, value: float, high: float, limit: float, map_: OperatingMap, unit: str) -> str:
    """Return what starts a part at rest beside what the drive gives (N m, in a unit)."""
    ends = within(low, high, PER[unit]) if low < high else ""
    said = " ".join(filter(None, ("starting from rest takes", figures(value * PER[unit]), unit, ends)))
    return f"{said}, {giving(map_)} {torque(limit, unit)}"


def per_cent(share: float) -> str:
    """Return a probability as a reader wants it: never 0 or 100 %."""
    if share > 0.994:
        return "over 99 %"
    return "under 1 %" if share < 0.006 else f"{100.0 * share:.0f} %"


def per_cent_of(share: float) -> str:
    """Return a relative amount, rounded up to a figure that a reader keeps."""
    return f"{figures(100.0 * share, up=True)} %"


def listed(parts: list[str]) -> str:
    """Return parts as a sentence lists them."""
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} and {parts[-1]}"
