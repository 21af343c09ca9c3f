"""What to know of a coast-down before its numbers are used."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.coast_down.coasts import Coast, LeftOut, Why
from hersey.damping.coast_down.departures import Departure
from hersey.damping.coast_down.fitting import CoastFit
from hersey.damping.dwells.reasons import label_of
from hersey.damping.estimate import Estimate
from hersey.errors import InsufficientDataError
from hersey.log.reading import NOT_READ
from hersey.log.torque_log import TorqueLog
from hersey.schema.warning import Warning

MISFIT = "friction of another shape"
NEGATIVE = "negative friction term"
DIFFERENT = "coasts differ"
NOT_SEPARATED = "friction terms not separated"
CUT = "parts left out"
EXACT = "inertia taken as exact"
WARMED = "temperature changed"
UNKNOWN = "temperature not known"
TORQUE_UNUSED = "torque not used"
#: Share of the torque that a term may take without being reported.
_MATTERS = 0.1
#: A difference between coasts above this share is none of bearings: one of them is driven or braked.
_UNLIKE = 0.5
#: Change of temperature, K, that is worth a word.
_WARMER = 2.0
#: Stretches that are worth a word.
_TOLD: tuple[Why, ...] = ("stepped", "braking", "driven", "reversed")
_TERMS = ("Coulomb friction", "viscous friction", "windage")


def no_coast(log: TorqueLog, left_out: Sequence[LeftOut]) -> InsufficientDataError:
    """Return the error of a log in which no wheel coasts, with what it holds instead."""
    whole = max(1, sum(each.rows for each in left_out))
    rows = {
        why: sum(e.rows for e in left_out if e.why == why) for why in dict.fromkeys(e.why for e in left_out)
    }
    most = sorted(rows, key=lambda why: -rows[why])
    shares = [(label_of(why), 100 * rows[why] / whole) for why in most[:3]]
    held = ", ".join(f"{name} {share:.0f} %" for name, share in shares if share >= 0.5)
    return InsufficientDataError(
        f"{log.files[0].name}: speed falls freely nowhere in this log ({held})",
        remedy="a drive that holds the speed after a fall may have set the fall, too: let the wheel coast to "
        "rest, or end the log where the drive takes hold"
        if rows.get("stepped")
        else "record the speed while the wheel coasts down without drive and brake, at 20 rows or more",
    )


@dataclass(frozen=True)
class Doubts:
    """All that the warnings are made of."""

    log: TorqueLog
    coasts: Sequence[Coast]
    left_out: Sequence[LeftOut]
    fit: CoastFit
    terms: Sequence[Estimate]
    speeds: FloatArray
    torque: FloatArray
    shape: Departure
    bound: Departure
    differing: Departure
    inertia: Estimate

    def warnings(self) -> list[Warning]:
        """Return them, the gravest first."""
        found = [*self._of_the_law(), *self._of_coasts(), *self._of_terms(), *self._parts()]
        return [*found, *self._of_inertia(), *self._temperature(), *self._torque()]

    def _of_the_law(self) -> list[Warning]:
        if self.bound.shows:
            return [
                Warning(
                    NEGATIVE,
                    "Coulomb, viscous and windage friction do not describe these coasts: one of them "
                    "would have to be negative ({chance:p}), so the three terms must not be used",
                    severity="act",
                    remedy="fit another law to the points, the torque in windows of speed, which stay valid",
                    chance=self.bound.p_value,
                )
            ]
        if self.shape.shows:
            return [
                Warning(
                    MISFIT,
                    "friction has another shape than Coulomb, viscous and windage terms: torque departs from "
                    "them by up to {share:.2g %} ({chance:p}), so the intervals are too narrow",
                    severity="watch",
                    remedy="fit another law to the points, the torque in windows of speed, which stay valid",
                    share=self.shape.share,
                    chance=self.shape.p_value,
                )
            ]
        return []

    def _of_coasts(self) -> list[Warning]:
        if not self.differing.shows:
            return []
        return [
            Warning(
                DIFFERENT,
                "the torque of {count} coasts differs by up to {share:.2g %} from their mean ({chance:p}); "
                "the intervals include that",
                severity="watch" if self.differing.share < _UNLIKE else "act",
                remedy="warm-up of bearings and the direction are common reasons: fit the coasts separately",
                count=len(self.coasts),
                share=self.differing.share,
                chance=self.differing.p_value,
            )
        ]

    def _of_terms(self) -> list[Warning]:
        """Terms that may be there and may not."""
        slow, fast = float(self.speeds[0]), float(self.speeds[-1])
        at = (slow, fast, fast)
        whole = (self.torque[0], self.torque[-1], self.torque[-1])
        open_terms = [
            k
            for k, term in enumerate(self.terms)
            if term.low <= 0.0 and term.high * at[k] ** k > _MATTERS * whole[k]
        ]
        if not open_terms:
            return []
        names = [_TERMS[k] for k in open_terms]
        wide = fast > 10.0 * slow
        return [
            Warning(
                NOT_SEPARATED,
                "{terms} cannot be separated from the other terms between {slow:.3g rpm} and "
                "{fast:.3g rpm}; the torque itself is known there"
                if len(open_terms) == 1
                else "{terms} cannot be separated from each other between {slow:.3g rpm} and "
                "{fast:.3g rpm}; the torque itself is known there",
                severity="note" if wide else "watch",
                remedy="record more coasts" if wide else "let the wheel coast down to lower speeds",
                terms=_listed(names),
                slow=slow,
                fast=fast,
            )
        ]

    def _parts(self) -> list[Warning]:
        found = []
        for why in _TOLD:
            parts = [each for each in self.left_out if each.why == why]
            if parts:
                found.append(
                    Warning(
                        CUT,
                        "{count} {count:stretch was|stretches were} excluded ({what}), the first at "
                        "{start:.4g} to {end:.4g} s",
                        severity="watch",
                        where=self.log.runs[parts[0].run].name,
                        remedy="let the wheel coast to rest, or end the log where the drive takes hold"
                        if why == "stepped"
                        else "",
                        count=len(parts),
                        what=label_of(why),
                        start=parts[0].start,
                        end=parts[0].end,
                    )
                )
        return found

    def _of_inertia(self) -> list[Warning]:
        if self.inertia.error > 0.0:
            return []
        return [
            Warning(
                EXACT,
                "the moment of inertia has no error, so it is taken as exact; 1 % of it is 1 % of each "
                "torque",
                remedy="state it, e.g. as '{inertia:.4g} kg*m^2 ± 2 %'",
                inertia=self.inertia.value,
            )
        ]

    def _temperature(self) -> list[Warning]:
        if not self.log.has_temperature:
            unread = [each for file in self.log.files for each in file.warnings if each.kind == NOT_READ]
            return [
                *unread,
                Warning(
                    UNKNOWN,
                    "without a temperature, warm-up of bearings cannot be distinguished from a dependence "
                    "of friction on speed, and the points have no temperature",
                ),
            ]
        readings = [self._readings(coast) for coast in self.coasts]
        known = np.concatenate([each for each in readings if each is not None] or [np.empty(0)])
        if not known.size or np.ptp(known) < _WARMER:
            return []
        return [
            Warning(
                WARMED,
                "temperature went from {cold:.3g degC} to {hot:.3g degC}; viscous friction follows it, "
                "but one law is fitted to all",
                severity="watch",
                remedy="compare coasts of one temperature",
                cold=float(known.min()),
                hot=float(known.max()),
            )
        ]

    def _readings(self, coast: Coast) -> FloatArray | None:
        run = self.log.runs[coast.run]
        if run.temperature is None:
            return None
        return run.temperature[(run.time >= coast.start) & (run.time <= coast.end)]

    def _torque(self) -> list[Warning]:
        if not any(np.isfinite(run.torque).any() for run in self.log.runs):
            return []
        return [Warning(TORQUE_UNUSED, "the log has a torque, which a coast-down does not use")]


def _listed(names: Sequence[str]) -> str:
    """Names with commas, the last with "and"."""
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last
