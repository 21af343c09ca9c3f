"""The law of failures and suspensions that are typed in: ``hersey weibull``."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from hersey.cli.groups import argument, grouped, option
from hersey.cli.options import Force, drawn
from hersey.cli.outputs import may_write_table_and_figure
from hersey.cli.printing import Printing
from hersey.cli.progress import working
from hersey.errors import HerseyError, ParameterError, sentence

if TYPE_CHECKING:
    from hersey.life.failures.forecast import FleetForecast, RemainingLife
    from hersey.life.failures.law import FailureLaw
    from hersey.life.failures.test_plan import LifeTestPlan
    from hersey.life.replacement import Replacement

_FAILURES = "Table of specimens: age and status (failed or running), or low and high."
_LAW = "Law to fit: weibull, lognormal or gamma."
_SHAPE = "Shape of the law, if it is known; only its scale is then estimated."
_LEVEL = "Level of the two-sided bounds."
_ARRHENIUS = "Column of temperature, e.g. 'temperature'; life depends on it by Arrhenius."
_POWER = "Column of load, e.g. 'load'; life depends on it by an inverse power."
_USE = "Temperature or load for which ages are wanted, e.g. '40 degC'."
_AGE = "Give the remaining life of a specimen of this age, e.g. '120000 pages'."
_FLEET = "Table of specimens that run (age, count): forecast their failures; needs --ahead."
_AHEAD = "How much further the fleet runs, e.g. '50000 pages'."
_DEMONSTRATE = "Plan a test that demonstrates this B10, e.g. '100000 pages'."
_COST = "Cost of a failure over that of a planned replacement (a pure number): find when to replace."
_OUT = "Write B-lives and parameters with their bounds (.csv)."


@dataclass(frozen=True)
class _Stress:
    """How life depends on temperature or load, and the stress of use."""

    arrhenius: Annotated[str, option(_ARRHENIUS, metavar="COLUMN")] = ""
    power: Annotated[str, option(_POWER, metavar="COLUMN")] = ""
    use: Annotated[str, option(_USE)] = ""

    @property
    def given(self) -> dict[str, str]:
        """What was typed, for reading the table."""
        return {"arrhenius": self.arrhenius, "power": self.power, "use": self.use}


@dataclass(frozen=True)
class _Asked:
    """What is asked of the law."""

    age: Annotated[str, option(_AGE)] = ""
    fleet: Annotated[Path | None, option(_FLEET, metavar="CSV")] = None
    ahead: Annotated[str, option(_AHEAD)] = ""
    demonstrate: Annotated[str, option(_DEMONSTRATE)] = ""
    cost_of_failure: Annotated[float | None, option(_COST)] = None

    def prepare(self) -> None:
        """Refuse half of a forecast."""
        if self.fleet is None and self.ahead:
            raise ParameterError("--ahead needs the specimens that run: add --fleet fleet.csv")
        if self.fleet is not None and not self.ahead:
            raise ParameterError("--fleet needs how much further it runs: add e.g. --ahead '50000 pages'")

    def remaining(self, law: FailureLaw) -> RemainingLife | None:
        """Return the remaining life of a specimen."""
        from hersey.life.failures.forecast import remaining_life

        return remaining_life(law, _age("--age", self.age, law.unit)) if self.age else None

    def forecast(self, law: FailureLaw) -> FleetForecast | None:
        """Return the failures of the fleet."""
        from hersey.life.failures.forecast import fleet_forecast
        from hersey.life.failures.table import read_fleet

        if self.fleet is None:
            return None
        ahead = _age("--ahead", self.ahead, law.unit)
        ages, count = read_fleet(self.fleet, law.unit)
        return fleet_forecast(law, ages, ahead, count=count)

    def replacement(self, law: FailureLaw) -> Replacement | None:
        """Return when a planned replacement costs least."""
        if self.cost_of_failure is None:
            return None
        from hersey.life.replacement import replacement_age

        return replacement_age(law, self.cost_of_failure)

    def plan(
        self, law: FailureLaw | None, shape: float | None, level: float, seed: int
    ) -> LifeTestPlan | None:
        """Return a test that demonstrates a B10, by the shape given or estimated."""
        if not self.demonstrate:
            return None
        from hersey.life.age import Age
        from hersey.life.failures.test_plan import life_test_plan

        with _of("--demonstrate"):
            target = Age.parse(self.demonstrate, "" if law is None else law.unit)
        if shape is None:
            if law is None or len(law.fits) != 1 or law.law != "weibull":
                raise ParameterError(
                    "--demonstrate needs the shape of one Weibull law: add --shape, e.g. --shape 2"
                )
            shape = law.parameters[0].value
        return life_test_plan(target.value, shape=shape, confidence=level, unit=target.unit, seed=seed)


@grouped
def weibull(
    file: Annotated[Path | None, argument("FAILURES", _FAILURES)] = None,
    *,
    law: Annotated[str, option(_LAW)] = "weibull",
    shape: Annotated[float | None, option(_SHAPE)] = None,
    level: Annotated[float, option(_LEVEL)] = 0.90,
    stress: _Stress,
    asked: _Asked,
    seed: Annotated[int, option("Random seed.", min=0)] = 0,
    out: Annotated[Path | None, option(_OUT, metavar="CSV")] = None,
    figure: Annotated[Path | None, drawn("the probability plot with its confidence band")] = None,
    printing: Printing,
    force: Force = False,
) -> None:
    """Fit the law of ages at failure: B-lives with bounds, remaining life, fleet, next test.

    Example: [bold]hersey weibull examples/failures.csv --age '200 h'[/bold]

    Ages are exact, at least (running), at most or between two inspections. Several failure modes are fitted
    separately. Without a table, --demonstrate with --shape plans a test.
    """
    inputs = [each for each in (file, asked.fleet) if each is not None]
    table, drawing = may_write_table_and_figure(out, figure, force, inputs)
    if file is None and not (asked.demonstrate and shape is not None):
        raise ParameterError("name a table of FAILURES, or plan a test with --demonstrate AGE --shape SHAPE")
    of_law = (asked.age, asked.fleet, asked.cost_of_failure, out, *stress.given.values())
    if file is None and any(of_law):
        raise ParameterError("without a table of FAILURES only --demonstrate and --shape can be given")

    from hersey.life.failures.answers import FailureAnswers

    with working("fitting the law"):
        found = None if file is None else _fitted(file, law, shape, level, stress, seed)
        answers = FailureAnswers(
            found,
            None if found is None else asked.remaining(found),
            None if found is None else asked.forecast(found),
            None if found is None else asked.replacement(found),
            asked.plan(found, shape, level, seed),
        )
    if found is not None and out is not None:
        from hersey.files.tables import table as content

        table.write(content(found.to_frame(), ".csv"))
    drawn_of = found if found is not None else answers.plan
    assert drawn_of is not None
    drawing.draw(drawn_of)
    if printing.json(answers):
        return
    if found is not None:
        printing.conclusion(lambda: _lines(found), found.summary(), *found.warnings)
    for each in (answers.remaining, answers.forecast, answers.replacement, answers.plan):
        if each is not None:
            printing.text("", each.summary())
    printing.files(out, figure)


def _fitted(
    file: Path, law: str, shape: float | None, level: float, stress: _Stress, seed: int
) -> FailureLaw:
    from hersey.life.failures.estimate import weibull as law_of
    from hersey.life.failures.table import read_failures

    sample = read_failures(file, **stress.given)
    return law_of(
        sample,
        law=law,
        shape=shape,
        level=level,
        seed=seed,
    )


def _lines(found: FailureLaw) -> list[str]:
    first, *others = found.lines()
    return [sentence(first), *others]


def _age(flag: str, text: str, unit: str) -> float:
    """An age that an option names, in the unit of the law."""
    from hersey.life.age import Age

    with _of(flag):
        age = Age.parse(text, unit)
        return (age.as_unit(unit) if unit else age).value


@contextmanager
def _of(flag: str) -> Iterator[None]:
    """Begin an error with the flag."""
    try:
        yield
    except HerseyError as error:
        raise error.within(flag) from None
