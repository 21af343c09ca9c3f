"""Errors that the order of a log hides or that its sensors leave, found in the dwells before a fit.

No scatter shows them, and no repetition averages them away. Each finding says what was found in numbers;
`in_words` says what that means and what to do.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.damping.dwells.groups import SAME_SPEED, groups_of_temperature, levels_of_speed
from hersey.damping.dwells.points import SteadyPoints
from hersey.damping.dwells.relaxation import Relaxation
from hersey.log.sensors import HYSTERESIS_OF_LARGEST, TEMPERATURE_LAG

#: Fewest dwells of which anything is said.
FEWEST = 5
#: Speeds approached from both directions at one temperature that check a sensor for hysteresis.
BOTH_WAYS = 3
#: Fewest dwells of a run, typically, that make it more than one dwell in a file of its own.
DWELLS_OF_A_RUN = 3
#: Temperature by which a sensor that lags must be off to matter, K: a third of its default zero error.
NOTABLE_LAG = 0.7
#: Rounding of a dwell that matters: of torque and speed as a share, of temperature in K.
NOTABLE_ROUNDING = {"torque": 0.01, "speed": 0.01, "temperature": 1.0}
#: Time constants after which a relaxation is over for practical purposes.
RELAXED = 3.0
#: Ratio of the time constants that fit beyond which their range is reported.
UNSURE = 2.0
#: Rounding of torque or speed, relative, beyond which logarithms of the readings are biased.
TOO_COARSE = 0.1
#: Name of the correction that undoes the lag of the temperature sensor.
LAG_CORRECTION = "thermal lag"

Kind = Literal["one direction", "relaxation", "temperature lag", "unlinked runs", "resolution"]


@dataclass(frozen=True)
class Misleading:
    """An error structure found in a log.

    ``size`` is the largest error that it leaves in a dwell: relative for torque and speed, K for temperature.
    ``scale`` belongs to the kind: time constant (s) of a relaxation or a lag, step (SI) of a resolution, the
    direction (1 from below, -1 from above), the number of sets of runs without a temperature in common.
    """

    kind: Kind
    quantity: str
    size: float
    scale: float
    dwells: int  #: how many it concerns


def misleading(points: SteadyPoints) -> list[Misleading]:
    """Return the error structures of a log, often none."""
    found = [_one_way(points), _relaxing(points), _late(points), _apart(points)]
    return [each for each in (*found, *_coarse(points)) if each is not None]


def one_direction(points: SteadyPoints) -> FloatArray:
    """Return from where each dwell was approached: 1 from below, -1 from above, 0 unknown, shape (points,).

    Empty where enough speeds were approached from both directions: the dwells then show hysteresis.
    """
    if "approach" not in points.table.columns or points.table.height < FEWEST:
        return np.empty(0)
    names = points.table["approach"].to_list()
    sign = np.array([{"from below": 1.0, "from above": -1.0}.get(name, 0.0) for name in names])
    if np.count_nonzero(sign) <= sign.size // 2 or _both_ways(points, sign) >= BOTH_WAYS:
        return np.empty(0)
    return sign


def _both_ways(points: SteadyPoints, sign: FloatArray) -> int:
    """How many speeds were approached from both directions at one temperature."""
    speed, kelvin = np.log(np.abs(points.column("speed"))), _kelvin(points)
    groups = [np.arange(sign.size)] if kelvin is None else list(groups_of_temperature(kelvin))
    count = 0
    for group in groups:
        levels = levels_of_speed(speed, group, SAME_SPEED)
        count += sum(bool(np.any(sign[level] > 0) and np.any(sign[level] < 0)) for level in levels)
    return count


def lagging(points: SteadyPoints) -> FloatArray:
    """Return how fast temperature changed over each dwell, K/s, shape (points,).

    Empty where no sensor that lags by `TEMPERATURE_LAG` would be off by much, or where its lag is corrected.
    """
    rates = points.temperature_rates
    if rates.size != points.table.height or _kelvin(points) is None:
        return np.empty(0)
    corrected = any(correction.name == LAG_CORRECTION for correction in points.log.corrections)
    if corrected or TEMPERATURE_LAG * float(np.max(np.abs(rates))) < NOTABLE_LAG:
        return np.empty(0)
    return rates


def unlinked_runs(points: SteadyPoints) -> IntArray:
    """Return which dwells belong to runs that share a temperature, directly or over others, shape (points,).

    Empty where all do: a gain that changes from run to run then shows at the temperatures they share.
    """
    nothing = np.empty(0, dtype=np.intp)
    kelvin, run = _kelvin(points), points.column("run").astype(np.intp)
    runs, counts = np.unique(run, return_counts=True)
    if kelvin is None or runs.size < 2 or float(np.median(counts)) < DWELLS_OF_A_RUN:
        return nothing
    label = {int(each): int(each) for each in runs}
    for group in groups_of_temperature(kelvin):
        together = {label[int(each)] for each in run[group]}
        label = {each: min(together) if of in together else of for each, of in label.items()}
    member = np.array([label[int(each)] for each in run], dtype=np.intp)
    return member if np.unique(member).size > 1 else nothing


def _kelvin(points: SteadyPoints) -> FloatArray | None:
    return points.column("temperature") if points.log.has_temperature else None


def _one_way(points: SteadyPoints) -> Misleading | None:
    sign = one_direction(points)
    if not sign.size:
        return None
    torque = np.abs(points.column("torque"))
    size = HYSTERESIS_OF_LARGEST * float(torque.max() / torque.min())
    way = 1.0 if float(np.sum(sign)) >= 0.0 else -1.0
    return Misleading("one direction", "torque", size, way, int(np.count_nonzero(sign == way)))


def _relaxing(points: SteadyPoints) -> Misleading | None:
    found = points.relaxation
    if found is None:
        return None
    left = np.abs(found.left)
    return Misleading("relaxation", "torque", float(left.max()), found.time, int(np.count_nonzero(left)))


def _late(points: SteadyPoints) -> Misleading | None:
    off = TEMPERATURE_LAG * np.abs(lagging(points))
    if not off.size:
        return None
    dwells = int(np.count_nonzero(off >= NOTABLE_LAG))
    return Misleading("temperature lag", "temperature", float(off.max()), TEMPERATURE_LAG, dwells)


def _apart(points: SteadyPoints) -> Misleading | None:
    member = unlinked_runs(points)
    if not member.size:
        return None
    sets = float(np.unique(member).size)
    return Misleading("unlinked runs", "torque", points.log.sensors.torque_gain, sets, member.size)


def _coarse(points: SteadyPoints) -> list[Misleading]:
    out = []
    for resolution in points.resolutions:
        if resolution.errors.size != points.table.height:
            continue
        name = resolution.quantity
        beside = 1.0 if name == "temperature" else np.abs(points.column(name))
        share = resolution.errors / beside
        if dwells := int(np.count_nonzero(share > NOTABLE_ROUNDING[name])):
            out.append(Misleading("resolution", name, float(share.max()), resolution.step, dwells))
    return out


def in_words(found: Misleading, points: SteadyPoints) -> str:
    """Return what an error structure means for the fit, and what to do about it."""
    if found.kind == "relaxation" and points.relaxation is not None:
        return _relaxation_words(found, points.relaxation)
    words = {"one direction": _direction_words, "temperature lag": _lag_words, "unlinked runs": _runs_words}
    return words.get(found.kind, _resolution_words)(found)


def _direction_words(found: Misleading) -> str:
    way, other = ("below", "down") if found.scale > 0 else ("above", "up")
    return (
        f"Speeds were approached from {way} only, so hysteresis of the torque sensor cannot be checked: it "
        "reads less while torque rises than while it falls. The sensor part of the interval of c allows for "
        f"{_percent(HYSTERESIS_OF_LARGEST)} of the largest torque. Record the same speeds on the way {other} "
        "too."
    )


def _relaxation_words(found: Misleading, relaxation: Relaxation) -> str:
    low, high = relaxation.possible
    time = f"{low:.3g} to {high:.3g} s" if high > UNSURE * low else f"about {found.scale:.3g} s"
    return (
        f"Torque is still relaxing after each change of speed, with a time constant of {time}. The mean of "
        f"a dwell is off by up to {_percent(found.size)}, and the intervals allow for that. Hold each speed "
        f"for at least {RELAXED * found.scale:.3g} s."
    )


def _lag_words(found: Misleading) -> str:
    return (
        f"Temperature still changed during {_dwells(found.dwells)}. There, a temperature sensor that lags by "
        f"{found.scale:.0f} s is off by up to {found.size:.1f} K, which biases exponents b and c. Wait until "
        "the temperature reading is steady, or set time_constant of the sensor under [temperature] in "
        "hersey.toml."
    )


def _runs_words(found: Misleading) -> str:
    return (
        f"The runs form {found.scale:.0f} sets without a common temperature. A torque gain that differs "
        "between them, or any other change from day to day, cannot be separated from temperature in exponent "
        f"b. The sensor part of its interval allows for a gain error of {_percent(found.size)} in each. "
        "Repeat one temperature in every run."
    )


def _resolution_words(found: Misleading) -> str:
    step, cure = {
        "torque": (f"{1e3 * found.scale:.3g} mN m", "Record torque in a smaller measuring range"),
        "speed": (f"{found.scale:.3g} rad/s", "Record speed with more decimals or more pulses"),
        "temperature": (f"{found.scale:.3g} K", "Record more decimals of temperature"),
    }[found.quantity]
    most = f"{found.size:.2g} K" if found.quantity == "temperature" else _percent(found.size)
    too_much = found.quantity != "temperature" and found.size > TOO_COARSE
    allowed = "too much for reliable exponents" if too_much else "and the intervals allow for that"
    return (
        f"{found.quantity.capitalize()} is recorded with a resolution of {step}, coarser than its noise in "
        f"{_dwells(found.dwells)}. The standard error by rounding is up to {most}, {allowed}. {cure}."
    )


def _percent(share: float) -> str:
    return f"{100.0 * share:.2g} %"


def _dwells(count: int) -> str:
    return "1 dwell" if count == 1 else f"{count} dwells"
