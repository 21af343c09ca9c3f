"""A life test followed: what moved, how thick the film is, what ends each specimen and when."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Unpack

from hersey.arrays import one_thread, refuse_unknown
from hersey.errors import HerseyError, ParameterError, Setting
from hersey.life.ageing_maps import AgeingMaps, ageing_maps
from hersey.life.drift.result import Drift, fit_drift
from hersey.life.film.through_life import FilmLife, film_life
from hersey.life.indicator import Indicators, Runs
from hersey.life.indicators.of_campaign import asked_of
from hersey.life.other_uses import OtherUses, uses_beside
from hersey.life.time_to_failure.estimate import TimeToFailure, time_to_failure
from hersey.life.time_to_failure.questions import Asked, questions_of
from hersey.result import Result
from hersey.schema.warning import Warning
from hersey.units import takes_si

if TYPE_CHECKING:
    import polars as pl

    from hersey.life.campaign import Campaign
    from hersey.machine.machine import Machine

#: Says which step is begun.
Step = Callable[[str], None]


@dataclass(frozen=True, repr=False)
class LifeTest(Result):
    """Results of a life test; what cannot be computed is None, and ``warnings`` says why."""

    also_stated = ("file",)
    not_stated = ("name", "indicators")

    name: str
    indicators: Indicators
    time_to_failure: TimeToFailure
    drift: Drift | None
    film: FilmLife | None
    maps: AgeingMaps | None
    uses: OtherUses | None
    warnings: tuple[Warning, ...]
    seed: int

    def headline(self) -> str:
        """Return how the specimens fail, and when."""
        return self.time_to_failure.headline()

    def summary(self) -> str:
        """Return failures, changes with age, the film and what is unknown as text."""
        parts = [self.time_to_failure.summary()]
        parts += [each.summary() for each in (self.drift, self.film, self.maps) if each is not None]
        parts += [f"- {each}" for each in self.warnings]
        return "\n".join(parts)

    @property
    def file(self) -> str:
        """The campaign's file."""
        return self.name

    def to_frame(self) -> pl.DataFrame:
        """Return the ages of `TimeToFailure`."""
        return self.time_to_failure.to_frame()


@one_thread()
@takes_si()
def follow(
    campaign: Campaign,
    machine: Machine,
    *,
    seed: int = 0,
    unit: str = "",
    uses: bool = False,
    step: Step | None = None,
    **asked: Unpack[Asked],
) -> LifeTest:
    """Predict which specimens of a campaign fail first, how, and when.

    Parameters
    ----------
    campaign
        Campaign of one run or more; more ages and specimens show more.
    machine
        Machine whose limits and operating points define failure; contact and lubricant define the film.
    seed
        Random seed.
    unit
        Specimen whose maps are drawn. Default: the one that fails next.
    uses
        Whether to compute the ages also for other limits, coldest starts and duties.
    step
        Called with the name of each step as it begins.
    **asked
        Any of ``until``, ``share`` and ``cost_of_failure``; see `Asked`.

    Raises
    ------
    InsufficientDataError
        If no run shows any indicator.
    ParameterError, UnitError
        If the campaign has no such specimen, ``until`` is no age in the unit of its runs, ``share`` is not
        between 0 and 1 or comes without ``until``, or ``cost_of_failure`` is not above 1 or beyond 100.
    """
    refuse_unknown("follow", asked, tuple(Asked.__annotations__))
    if unit:
        try:
            campaign.runs(unit)
        except ParameterError as error:
            raise error.within(Setting("unit").to()) from None
    questions_of(campaign.age_unit, **asked)
    said = step or (lambda _text: None)
    warnings: list[Warning] = []

    def tried(text: str, make: Callable[[], Any]) -> Any:
        said(text)
        try:
            return make()
        except HerseyError as error:
            warnings.append(
                Warning("not computed", "{reason}", severity="act", where=text, reason=str(error))
            )
            return None

    said("runs that do not fit")
    diagnosis = campaign.diagnose()
    warnings += [*diagnosis.warnings, *diagnosis.warning_of_excluded()]
    said("torque at the limits")
    asked_runs = asked_of(campaign, machine)
    indicators = asked_runs.indicators(machine)
    film = tried("film through life", lambda: film_life(campaign, machine, excluded=diagnosis.excluded))
    if film is not None:
        indicators = film.with_starvation(indicators)
    indicators = indicators.without_runs(diagnosis.excluded)
    said("growth and time to failure")
    found = time_to_failure(indicators, seed=seed, **asked)
    drift = tried("drift", lambda: fit_drift(_dwells(campaign, diagnosis.excluded)))
    maps = tried(
        "maps when new, now and at the end",
        lambda: ageing_maps(campaign, machine, found, unit=unit, excluded=diagnosis.excluded),
    )
    others = (
        tried(
            "ages in other operating conditions",
            lambda: uses_beside(
                found, asked_runs, machine, indicators, excluded=diagnosis.excluded, seed=seed
            ),
        )
        if uses
        else None
    )
    return LifeTest(campaign.path.name, indicators, found, drift, film, maps, others, tuple(warnings), seed)


def _dwells(campaign: Campaign, excluded: Sequence[int]) -> pl.DataFrame:
    """The dwells of a campaign without those of the runs at some places."""
    import polars as pl

    runs = Runs.of(campaign).run if excluded else ()
    numbers = [runs[place] for place in excluded]
    return campaign.dwells().filter(~pl.col("run_id").is_in(numbers))
