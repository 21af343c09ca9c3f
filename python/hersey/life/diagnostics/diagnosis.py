"""What was found of the runs of a life test: the slips as warnings, and the runs that growth does without."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np

from hersey.life.age import Age
from hersey.life.diagnostics.finding import find_slips
from hersey.life.diagnostics.measured import MeasuredRuns
from hersey.life.diagnostics.run_compared import RunCompared
from hersey.life.diagnostics.said import warning_of
from hersey.life.diagnostics.slips import Slip
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    import polars as pl

#: Kind of the warning that says which runs growth does without.
EXCLUDED = "runs excluded"
#: Runs that it names.
_NAMED = 8


@dataclass(frozen=True)
class Diagnosis:
    """The slips of the runs of a life test, the likeliest first, and how each run lies to its specimen."""

    runs: MeasuredRuns
    slips: tuple[Slip, ...]
    each: tuple[RunCompared, ...] = ()

    @property
    def excluded(self) -> list[int]:
        """Places of the runs that growth does without."""
        return sorted({place for slip in self.slips for place in slip.runs})

    @property
    def warnings(self) -> tuple[Warning, ...]:
        """Return each slip as a warning."""
        return tuple(warning_of(self.runs, slip) for slip in self.slips)

    def concerning(self, numbers: set[int]) -> tuple[Warning, ...]:
        """Return the warnings of slips in which runs with these numbers have a part."""
        return tuple(
            warning_of(self.runs, slip)
            for slip in self.slips
            if numbers & {self.runs.number[place] for place in slip.runs}
        )

    def to_frame(self) -> pl.DataFrame:
        """Return one row per run: distance from the other runs of its specimen, influence, likeliest slip."""
        import polars as pl

        kinds = {"run": pl.Int64, "unit": pl.String, f"age ({self.runs.age_unit or '1'})": pl.Float64}
        kinds |= {"distance (1)": pl.Float64, "influence (1)": pl.Float64, "slip": pl.String}
        rows = [tuple(getattr(each, field.name) for field in fields(each)) for each in self.each]
        return pl.DataFrame(rows, schema=kinds, orient="row")

    def warning_of_excluded(self) -> tuple[Warning, ...]:
        """Return which runs growth does without; nothing if it uses all."""
        places = self.excluded
        if not places:
            return ()
        named = [f"{self.runs.unit[i]} at {Age(float(self.runs.age[i]), self.runs.age_unit)}" for i in places]
        more = f" and {len(places) - _NAMED} more" if len(places) > _NAMED else ""
        return (
            Warning(
                EXCLUDED,
                "growth is fitted without {count} {count:run|runs} that {count:does|do} not fit: {which}",
                severity="watch",
                count=len(places),
                which=", ".join(named[:_NAMED]) + more,
            ),
        )


def diagnosed(measured: MeasuredRuns) -> Diagnosis:
    """Return the slips of runs."""
    if not measured.number:
        return Diagnosis(measured, (), ())
    found = find_slips(measured)
    kinds = {place: slip.kind for slip in reversed(found.slips) for place in slip.runs}
    each = tuple(
        RunCompared(
            measured.number[place],
            measured.unit[place],
            float(measured.age[place]),
            _if_known(found.distance[place]),
            _if_known(found.influence[place]),
            kinds.get(place, ""),
        )
        for place in range(len(measured.number))
    )
    return Diagnosis(measured, tuple(found.slips), each)


def _if_known(number: float) -> float | None:
    return None if np.isnan(number) else float(number)
