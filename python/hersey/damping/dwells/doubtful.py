"""What is doubtful in dwells before anything is fitted: their tare, and what goes together with time."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.dwells.groups import groups_of_temperature
from hersey.damping.dwells.points import SteadyPoints
from hersey.errors import MOVING, TARE
from hersey.schema.warning import Warning

#: A tare beyond this share of the least torque is asked about.
LARGE_TARE = 0.1
#: Torque of the standing drive below this share of the least torque is not spoken of.
MATTERS = 0.001
#: Rank correlation with time beyond which a quantity goes together with it, for so many dwells at least.
IN_ORDER, FEWEST_IN_ORDER = 0.9, 5


def doubtful_tare(points: SteadyPoints) -> list[Warning]:
    """Return what is doubtful of the zero of torque, with the option that mends it; or nothing."""
    standing = points.standing_torque
    if standing is None:
        return []
    least = float(np.min(np.abs(points.column("torque"))))
    if points.tare:
        share = abs(points.tare) / least
        words = (
            "the tare, {tare:.3g mN m}, is {share:.0f %} of the lowest {measured}. Check that it is the "
            "sensor's offset and the drive stood free"
        )
        found = Warning("large tare", words, severity="watch", tare=points.tare, share=share)
        return [found] if share >= LARGE_TARE else []
    share = abs(standing) / least
    words = (
        "{measured} at standstill, {standing:.3g mN m} ({share:.1f %} of the lowest dwell), is not "
        "subtracted. If it is the sensor's offset, use {how:standing}"
    )
    found = Warning("zero not subtracted", words, severity="watch", standing=standing, share=share, how=TARE)
    return [found] if share >= MATTERS else []


def constant_load(points: SteadyPoints) -> list[Warning]:
    """Return that torque keeps its sign when the drive turns the other way, as a hoist's does; or nothing."""
    against = [np.sign(each.speed) for each in points.rejected if each.why.kind == "opposite signs"]
    ways = {float(way) for way in against}
    kept = {float(way) for way in np.sign(points.column("speed"))}
    if len(ways) != 1 or len(kept) != 1 or ways == kept:
        return []
    words = (
        "torque has one sign in both directions: a constant load acts, as in a hoist, or the zero of torque "
        "is off. The fit takes {count} {count:dwell|dwells} of one direction and counts it as friction"
    )
    remedy = "to fit it as an offset, use {how}"
    found = Warning("constant load", words, severity="act", remedy=remedy, count=len(points), how=MOVING)
    return [found]


def doubtful_order(points: SteadyPoints) -> list[Warning]:
    """Return what rose or fell with time, so that its effect cannot be separated from a drift."""
    if len(points) < FEWEST_IN_ORDER or len(points.log.runs) != 1:
        return []
    named = {"speed": ("c", np.log(np.abs(points.column("speed"))))}
    if points.log.has_temperature and len(list(groups_of_temperature(points.column("temperature")))) > 1:
        named["temperature"] = ("b", points.column("temperature"))
    named = {what: each for what, each in named.items() if np.ptp(each[1]) > 0}
    order = np.arange(len(points), dtype=np.float64)
    if points.of_every_sample:  # windows may last as long as the log, and come by speed
        order = _ranks(points.column("start") + points.column("end"))
    return [
        Warning(
            "in order",
            "wear-in or other drift would look like an effect of {quantity}. Repeat the first {quantity} "
            "at the end",
            severity="watch",
            title="{quantity:capital} and time changed together",
            quantity=what,
            exponent=exponent,
        )
        for what, (exponent, values) in named.items()
        if abs(float(np.corrcoef(order, _ranks(values))[0, 1])) > IN_ORDER
    ]


def _ranks(values: FloatArray) -> FloatArray:
    """Ranks, the mean of them where values are the same."""
    _, place, alike = np.unique(values, return_inverse=True, return_counts=True)
    return np.asarray((np.cumsum(alike) - 0.5 * (alike - 1))[place])
