"""Drift: what moved with age in the torque of a drive, in each specimen and over all, and what it points to.

All runs of all specimens are fitted together (`fit`): one law of the torque (`aged_torque`), the values of
each specimen when new and their change with age, and how specimens and runs scatter about that. Quantities
that anyone can read off a Stribeck curve follow with their intervals; a reading of the change is evidence.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from hersey.arrays import FloatArray, one_thread
from hersey.life.campaign import Campaign
from hersey.life.drift.aged_torque import OWN
from hersey.life.drift.dwells import Dwells, dwells_of
from hersey.life.drift.fit import Fitted, fit
from hersey.life.drift.quantities import Quantity, quantities_of
from hersey.life.drift.readings import Change, Reading, read
from hersey.result import Means, Result
from hersey.schema.warning import Warning
from hersey.units import celsius, rpm, takes_si

if TYPE_CHECKING:
    import polars as pl

#: Up to so many specimens show little of how specimens differ.
_FEW = 3


@dataclass(frozen=True, repr=False)
class Drift(Result):
    """What changed with age, and the possible causes.

    ``reading`` is the interpretation for all specimens together, ``readings`` that for each. `Reading.sets`
    holds several if the data cannot distinguish them.
    """

    also_stated = ("headline",)
    not_stated = ("fitted",)

    units: tuple[str, ...]
    age_unit: str
    oldest: float
    last_age: Annotated[tuple[float, ...], Means("of each specimen")]  #: of each specimen
    runs: int
    dwells: int
    quantities: tuple[Quantity, ...]
    reading: Reading
    readings: tuple[Reading, ...]
    ages: FloatArray
    scatter: Annotated[
        float, Means("scatter of the dwells beyond their stated errors, relative")
    ]  #: of dwells beyond their stated errors, relative
    warnings: tuple[Warning, ...]
    fitted: Fitted = field(repr=False)

    def __getitem__(self, name: str) -> Quantity:
        """Return a quantity by its name."""
        return next(each for each in self.quantities if each.name == name)

    def headline(self) -> str:
        """Return what the drift points to."""
        return f"{len(self.units)} specimens up to {self._age(self.oldest)}: {_pointed(self.reading)}"

    def summary(self) -> str:
        """Return what changed and the possible causes as text."""
        return "\n".join(
            [self.headline(), *self.findings(), *(f"- {each.sentence}" for each in self.warnings)]
        )

    def findings(self) -> list[str]:
        """Return what changed and the possible causes; an indented line goes with that before."""
        lines = [
            f"{self.runs} runs, {self.dwells} dwells. Changes up to that age, with 90 % intervals:",
            *(f"  {each}" for each in self.quantities),
            *(_evidence(each) for each in self.reading.sure),
        ]
        if len(self.reading.sets) > 1:
            lines.append("These causes cannot be distinguished:")
            lines += [f"  {_listed(each) or 'nothing moved'}" for each in self.reading.sets]
        lines += self._of_specimens()
        if any(self.reading.sets):
            lines.append("These are possible causes, not proof. Something else may have the same effect.")
        return lines

    def _of_specimens(self) -> list[str]:
        """A line for each thing that is said of specimens."""
        if len(self.units) == 1:
            return []
        units_by_words: dict[str, list[str]] = {}
        for unit, reading in zip(self.units, self.readings, strict=True):
            units_by_words.setdefault(_of_one(reading), []).append(unit)
        lines = []
        for words, units in sorted(units_by_words.items(), key=lambda each: -len(each[1])):
            named = ", ".join(units[:_NAMED]) + f" and {len(units) - _NAMED} more" * (len(units) > _NAMED)
            lines.append(f"  {named}: {words}")
        return ["By specimen:", *lines]

    def _age(self, age: float) -> str:
        return f"{age:.6g} {self.age_unit}".strip()

    def to_dict(self) -> dict[str, Any]:
        """Return what changed and the possible causes, in SI."""
        readings = zip(self.units, self.readings, strict=True)
        return super().to_dict() | {"readings": [{"unit": unit} | each.to_dict() for unit, each in readings]}

    def to_frame(self) -> pl.DataFrame:
        """Return the change of each quantity, of all specimens (empty name) and of each."""
        import polars as pl

        rows = [
            (unit, each.name, each.where, each.si, each.relative, change.value, change.low, change.high)
            for each in self.quantities
            for unit, change in zip(("", *self.units), (each.change, *each.units), strict=True)
        ]
        names = ("unit", "quantity", "where", "si", "relative", "change (si)", "low (si)", "high (si)")
        return pl.DataFrame(rows, schema=names, orient="row")


#: How many specimens are named in a line.
_NAMED = 12
#: What each ageing would do, shown beside its reading.
_WOULD = {
    "lubricant": "rising viscosity shifts the torque curve and its minimum to lower speeds",
    "film": (
        "a shrinking oil layer brings the damping exponent toward 0 when cold and fast, and changes "
        "nothing when slow and hot"
    ),
    "contact": "wear changes the torque when hot and slow, and the speed of least torque",
    "load or grip": "load changes the torque in the same way at all speeds and temperatures",
    "no-load torque": "bearings and gears change the torque by the same amount at all temperatures",
    "temperature law": "another lubricant, or drift of the temperature sensor, has this effect",
}


def _listed(changes: tuple[Change, ...]) -> str:
    words = [each.words for each in changes]
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + f" and {words[-1]}" if words else ""


def _pointed(reading: Reading) -> str:
    """What a reading points to, in a clause."""
    if not any(reading.sets):
        return "nothing changed with age by more than the errors"
    if len(reading.sets) == 1:
        return f"the drift points to {_listed(reading.sure)}"
    if () in reading.sets:
        return "whether anything changed with age cannot be determined"
    if reading.sure:
        return f"the drift points to {_listed(reading.sure)}; other changes cannot be determined"
    return "something changed with age, but what it is cannot be determined"


def _of_one(reading: Reading) -> str:
    """What is said of a specimen."""
    perhaps = {each.words: None for every in reading.sets for each in every}
    for each in reading.sure:
        perhaps.pop(each.words, None)
    words = _listed(reading.sure) or "nothing certain" * bool(perhaps) or "nothing"
    return words + f"; possibly {', '.join(perhaps)}" * bool(perhaps)


def _evidence(change: Change) -> str:
    where = f"at {rpm(change.speed):.3g} rpm" + (
        "" if change.temperature is None else f", {celsius(change.temperature):.0f} degC"
    )
    mean, low, high = (f"{1e3 * each:+.3g}" for each in (change.torque, change.low, change.high))
    return f"This points to {change.words}: {mean} mN m [{low}, {high}] {where}; {_WOULD[change.name]}."


@one_thread()
@takes_si()
def fit_drift(runs: Campaign | pl.DataFrame) -> Drift:
    """Fit all runs of all specimens together and return what changed with age.

    Parameters
    ----------
    runs
        A campaign, or a table as from `Campaign.dwells`: one row per dwell with ``run_id``, ``unit``, ``age
        (...)``, ``speed (rad/s)``, ``torque (N m)``, ``torque error (N m)`` and ``temperature (K)``.

    Raises
    ------
    ParameterError
        If a column is missing, or a value is not a number.
    InsufficientDataError
        If no specimen was measured at two ages.
    """
    table = runs.dwells() if isinstance(runs, Campaign) else runs
    age_name = next((name for name in table.columns if name.startswith("age (")), "")
    dwells, units, oldest = dwells_of(table, age_name)
    found = fit(dwells)
    quantities, ages = quantities_of(found, oldest)
    solved = found.solved
    together = _readings(found, solved.mean[None], solved.mean_covariance[None])[0]
    each = _readings(found, solved.specimen, solved.specimen_covariance)
    return Drift(
        units=units,
        age_unit=age_name.removeprefix("age (").removesuffix(")"),
        oldest=oldest,
        last_age=tuple(float(oldest * dwells.age[dwells.specimen == u].max()) for u in range(len(units))),
        runs=int(dwells.age.size),
        dwells=int(dwells.given.sum()),
        quantities=quantities,
        reading=together,
        readings=tuple(each),
        ages=ages,
        scatter=found.scatter,
        warnings=_warnings(found, dwells, units),
        fitted=found,
    )


def _readings(found: Fitted, line: FloatArray, covariance: FloatArray) -> list[Reading]:
    """What starts and changes (specimens, 2 own) point to."""
    own = len(OWN)
    shared = found.solved.common[2 * own :]
    return read(found.scales, shared, line[:, :own], line[:, own:], covariance[:, own:, own:])


def _warnings(found: Fitted, dwells: Dwells, units: tuple[str, ...]) -> tuple[Warning, ...]:
    warnings = []
    if not found.scales.thermal:
        warnings.append(
            Warning(
                "no temperatures",
                "temperature varies too little. Level, viscosity and no-load torque are distinguished "
                "only by the shape over speed, and less asperity contact may really be a thicker "
                "lubricant",
                remedy="record dwells at several temperatures",
                severity="act",
            )
        )
    if len(units) <= _FEW:
        warnings.append(_few_specimens(len(units)))
    ages = np.unique(np.stack([dwells.specimen, dwells.age]), axis=1)[0]
    alone = [units[int(u)] for u in np.flatnonzero(np.bincount(ages.astype(int)) < 2)]
    if alone:
        warnings.append(
            Warning(
                "seen at one age",
                "seen at one age only, so their results depend on the other specimens: {specimens}",
                severity="watch",
                specimens=", ".join(alone[:_NAMED]) + " and more" * (len(alone) > _NAMED),
            )
        )
    if not found.settled:
        warnings.append(
            Warning(
                "fit not converged", "the fit did not converge, so its numbers are uncertain", severity="act"
            )
        )
    return tuple(warnings)


def _few_specimens(count: int) -> Warning:
    return Warning(
        "few specimens",
        "one specimen does not show how specimens differ. The intervals are those of this specimen"
        if count == 1
        else "{specimens} specimens show little of how specimens differ. The intervals over all are wide",
        severity="watch",
        specimens=count,
    )
