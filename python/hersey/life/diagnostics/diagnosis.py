"""What was found of the runs of a life test: the slips as warnings, and the runs that growth does without."""

from __future__ import annotations

from dataclasses import dataclass

from hersey.life.age import Age
from hersey.life.diagnostics.finding import find_slips
from hersey.life.diagnostics.measured import MeasuredRuns
from hersey.life.diagnostics.said import warning_of
from hersey.life.diagnostics.slips import Slip
from hersey.schema.warning import Warning

#: Kind of the warning that says which runs growth does without.
EXCLUDED = "runs excluded"
#: Runs that it names.
_NAMED = 8


@dataclass(frozen=True)
class Diagnosis:
    """The slips of the runs of a life test, the likeliest first."""

    runs: MeasuredRuns
    slips: tuple[Slip, ...]

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
    return Diagnosis(measured, tuple(find_slips(measured)))
