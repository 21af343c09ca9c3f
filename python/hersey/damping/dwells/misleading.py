"""Errors that the order of a log hides or that its sensors leave, found in the dwells before a fit.

No scatter shows them, and no repetition averages them away. Each warning says what was found in numbers, what
it means and what to do.
"""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.damping.dwells.groups import SAME_SPEED, groups_of_temperature, levels_of_speed
from hersey.damping.dwells.points import SteadyPoints
from hersey.log.sensors import HYSTERESIS_OF_LARGEST, TEMPERATURE_LAG
from hersey.schema.warning import Warning

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


def misleading(points: SteadyPoints, *, exponents: bool = True) -> list[Warning]:
    """Return the error structures of a log, often none; ``exponents`` says whether the fit has exponents.

    Each holds the ``quantity`` it concerns, the largest error that it leaves in a dwell (``off``: relative
    for torque and speed, K for temperature), how many ``dwells`` it concerns, and what belongs to its kind:
    time constant (s) of a relaxation or a lag, step (SI) of a resolution, direction (1 from below, -1 from
    above), number of sets of runs without a temperature in common.
    """
    found = [_one_way(points, exponents=exponents), _relaxing(points), _late(points), _apart(points)]
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


def _one_way(points: SteadyPoints, *, exponents: bool) -> Warning | None:
    sign = one_direction(points)
    if not sign.size:
        return None
    torque = np.abs(points.column("torque"))
    size = HYSTERESIS_OF_LARGEST * float(torque.max() / torque.min())
    way = 1.0 if float(np.sum(sign)) >= 0.0 else -1.0
    return Warning(
        "one direction",
        (
            "speeds were approached only from {side}, so sensor hysteresis cannot be checked. The sensor "
            "part of c allows for {allowed:.2g %} of the largest {measured}"
            if exponents
            else "speeds were approached only from {side}, so sensor hysteresis cannot be checked. The "
            "intervals do not include it"
        )
        + ". Also record the speeds on the way {other}",
        severity="watch",
        side="below" if way > 0 else "above",
        other="down" if way > 0 else "up",
        allowed=HYSTERESIS_OF_LARGEST,
        quantity="torque",
        off=size,
        direction=way,
        dwells=int(np.count_nonzero(sign == way)),
    )


def _relaxing(points: SteadyPoints) -> Warning | None:
    found = points.relaxation
    if found is None:
        return None
    left = np.abs(found.left)
    low, high = found.possible
    unsure = high > UNSURE * low
    return Warning(
        "relaxation",
        (
            "{measured} is still relaxing after each change of speed, with a time constant of "
            "{shortest:.3g} to {longest:.3g} s"
            if unsure
            else "{measured} is still relaxing after each change of speed, with a time constant of about "
            "{time:.3g} s"
        )
        + ". Dwell means are off by up to {off:.2g %}, which the intervals include. Hold each speed "
        "for at least {hold:.3g} s",
        severity="watch",
        time=found.time,
        shortest=low,
        longest=high,
        hold=RELAXED * found.time,
        quantity="torque",
        off=float(left.max()),
        dwells=int(np.count_nonzero(left)),
    )


def _late(points: SteadyPoints) -> Warning | None:
    off = TEMPERATURE_LAG * np.abs(lagging(points))
    if not off.size:
        return None
    return Warning(
        "temperature lag",
        "temperature was still changing in {dwells} {dwells:dwell|dwells}: a sensor lag of "
        "{time:.0f} s means an error of up to {off:.1f} K, which biases b and c. Wait longer, or set "
        "time_constant under [temperature] in hersey.toml",
        severity="watch",
        time=TEMPERATURE_LAG,
        quantity="temperature",
        off=float(off.max()),
        dwells=int(np.count_nonzero(off >= NOTABLE_LAG)),
    )


def _apart(points: SteadyPoints) -> Warning | None:
    member = unlinked_runs(points)
    if not member.size:
        return None
    return Warning(
        "unlinked runs",
        "{sets} sets of runs share no temperature, so changes between sets (e.g. of {measured} gain) "
        "cannot be separated from temperature. The sensor part of b allows for {off:.2g %} gain "
        "error. Repeat one temperature in every run",
        severity="watch",
        sets=int(np.unique(member).size),
        quantity="torque",
        off=points.log.sensors.torque_gain,
        dwells=member.size,
    )


def _coarse(points: SteadyPoints) -> list[Warning]:
    out = []
    for resolution in points.resolutions:
        if resolution.errors.size != points.table.height:
            continue
        name = resolution.quantity
        beside = 1.0 if name == "temperature" else np.abs(points.column(name))
        share = resolution.errors / beside
        if dwells := int(np.count_nonzero(share > NOTABLE_ROUNDING[name])):
            out.append(_resolution(name, resolution.step, float(share.max()), dwells))
    return out


def _resolution(name: str, step: float, off: float, dwells: int) -> Warning:
    """A sensor whose steps are coarser than its noise."""
    torque, kelvin = name == "torque", name == "temperature"
    return Warning(
        "resolution",
        ("{measured}" if torque else "{quantity}" if kelvin else "{against}")
        + " is recorded with a resolution of "
        + ("{step:.3g mN m}" if torque else "{step:.3g} K" if kelvin else "{step:.3g rad/s}")
        + ", coarser than its noise in {dwells} {dwells:dwell|dwells}. Rounding adds a standard error "
        "of up to "
        + ("{off:.2g} K, " if kelvin else "{off:.2g %}, ")
        + (
            "which the intervals include"
            if kelvin or off <= TOO_COARSE
            else "too much for reliable exponents"
        ),
        severity="watch",
        remedy="record {measured} in a smaller measuring range"
        if torque
        else "record more decimals of temperature"
        if kelvin
        else "record speed with more decimals or more pulses",
        quantity=name,
        step=step,
        off=off,
        dwells=dwells,
    )
