"""The table of regimes: what each state of lubrication predicts for the exponent of damping in speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np

from hersey.damping.distributions import holm, student_above
from hersey.damping.estimate import CONFIDENCE, Estimate
from hersey.result import OPEN, Means, Record


class RegimeRow(NamedTuple):
    """A named regime: least and greatest exponent, the regime of film theory that predicts it, and why."""

    name: str
    low: float
    high: float
    film: str  #: as the regime chart of the film names it; empty where that knows no such state
    meaning: str


COULOMB, FALLING = "dry Coulomb friction or a rigid film", "falling branch"
SOFT, STARVED = "soft EHL", "partly starved soft film"
#: Names that need an article in a sentence.
_COUNTED = frozenset({"constant film", "rigid piezoviscous film", FALLING, STARVED})

#: In the order of the exponents.
REGIMES: tuple[RegimeRow, ...] = (
    RegimeRow(
        "constant film",
        0.0,
        0.0,
        "",
        "film of fixed thickness, e.g. if starved: torque proportional to speed",
    ),
    RegimeRow(
        SOFT,
        -0.60,
        -0.56,
        "isoviscous-elastic",
        "isoviscous film in a soft nip; down to -0.56 on a bonded layer, by numerical solutions",
    ),
    RegimeRow(
        "rigid piezoviscous film", -2 / 3, -2 / 3, "piezoviscous-rigid", "film thickness as speed^(2/3)"
    ),
    RegimeRow(
        "Dowson-Higginson EHL",
        -0.70,
        -0.70,
        "piezoviscous-elastic",
        "piezoviscous line contact, Eq. 10",
    ),
    RegimeRow(COULOMB, -1.0, -1.0, "isoviscous-rigid", "torque independent of speed"),
    RegimeRow(FALLING, -np.inf, -1.0, "", "torque falls with speed: mixed lubrication, stick-slip possible"),
)


@dataclass(frozen=True)
class Hypothesis(Record):
    """A named value (or range) of the exponent, and how probable a deviation like the measured one is."""

    also_stated = ("consistent",)

    name: str
    low: Annotated[float, OPEN]
    high: float
    film: Annotated[str, Means("regime of film theory that predicts it; may be empty")]
    meaning: str
    p_value: float
    holds_here: Annotated[
        bool | None, Means("whether film theory puts this contact there; null without a contact")
    ] = None

    @property
    def consistent(self) -> bool:
        """Whether it survives at the 5 % level."""
        return self.p_value > 1.0 - CONFIDENCE


def judged(
    exponent: Estimate, *, film: str | None = None, table: tuple[RegimeRow, ...] = REGIMES
) -> tuple[Hypothesis, ...]:
    """Return every regime of a table against a measured exponent of damping in speed.

    A deviation counts beyond what the sensors do not know (`Estimate.systematic`), and p-values are adjusted
    for all the regimes tested (Holm, Scand. J. Stat. 6 (1979) 65): a regime is excluded only if the measured
    exponent would refute it among so many.

    Parameters
    ----------
    film
        The regime that film theory gives the contact, if one is known.
    table
        The general one, or that of a contact (`contact_regimes`).
    """
    alone = [_p_value(exponent, row) for row in table]
    return tuple(
        Hypothesis(*row, p, None if film is None else row.film == film)
        for row, p in zip(table, holm(alone), strict=True)
    )


def _p_value(exponent: Estimate, row: RegimeRow) -> float:
    away = max(row.low - exponent.value, exponent.value - row.high, 0.0) - exponent.systematic
    sides = 1.0 if np.isinf(row.low) else 2.0
    deviation = max(away, 0.0) / max(exponent.error, 1e-12)
    return min(1.0, sides * float(student_above(deviation, max(exponent.freedom, 1))))


def named_in_words(name: str) -> str:
    """Return the name of a regime with its article, for a sentence."""
    return f"a {name}" if name in _COUNTED else name


def neighbours(exponent: float) -> str:
    """Return between which regimes an exponent of damping lies, e.g. ``between soft EHL (-0.60) and ...``."""
    above = [row for row in REGIMES if row.low > exponent]
    below = [row for row in REGIMES if row.high < exponent]
    if not (above and below):
        return ""
    ends = ((above[-1].name, above[-1].low), (below[0].name, below[0].high))
    return "between " + " and ".join(f"{named_in_words(name)} ({value:.2f})" for name, value in ends)


def listed(names: list[str]) -> str:
    """Return names as a sentence lists them."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
