"""The page of a life test: what ends the units and when, then what it rests on, section by section."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from hersey import _core
from hersey.charts.life import life_charts
from hersey.life.age import Age
from hersey.life.indicator import NOT_JUDGED
from hersey.report.page import drawn
from hersey.schema.part import SCHEMA_VERSION
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    import polars as pl

    from hersey.life.following import LifeTest
    from hersey.life.time_to_failure.estimate import TimeToFailure
    from hersey.result import Result

#: Units whose ages are in the table; more are in the chart and in `--json`.
_SHOWN = 60
#: Units at a limit already that the first lines name.
_NAMED = 4


def render_life(answer: LifeTest, runs: pl.DataFrame, command: str) -> str:
    """Return the page as HTML text.

    Parameters
    ----------
    answer
        What was found.
    runs
        Of the campaign, as `Campaign.runs` lists them.
    command
        As it could be typed again.
    """
    charts = life_charts(answer)
    found = answer.time_to_failure
    last = Age(float(max(answer.indicators.runs.age)), found.age_unit)
    document = {
        "schema_version": SCHEMA_VERSION,
        "hersey_version": _core.VERSION,
        "title": f"{answer.name}: {len(found.units)} units, {runs.height} runs, up to {last}",
        "verdict": _verdict(found),
        "warnings": _stated((*_of_all(found), *answer.warnings)),
        "sections": [each for each in _sections(answer, list(charts)) if each["text"] or each["charts"]],
        "uses": None if answer.uses is None else answer.uses.to_dict(),
        "runs": runs.select("sha256", "log").to_dicts(),
        "command": command,
    }
    return drawn(("life.css", "uses.js", "life.js"), "hersey life", document, charts)


def _verdict(found: TimeToFailure) -> list[str]:
    """The answer: the population, the units that have ended, the next to end, what to measure."""
    heading = found.headline()
    lines = [f"{heading[0].upper()}{heading[1:]}."]
    order = sorted(found.units, key=lambda each: each.age.age.value)
    ended = [each for each in order if each.age.passed > 0.5]
    coming = [each for each in order if each.age.passed <= 0.5]
    unit = f" {found.age_unit}" if found.age_unit else ""
    if ended:
        named = "; ".join(f"{each.unit} at {each.age.age}{unit} by {each.ways}" for each in ended[:_NAMED])
        more = f"; and {len(ended) - _NAMED} more" if len(ended) > _NAMED else ""
        lines.append(f"At a limit already: {named}{more}.")
    if coming:
        first = coming[0]
        lines.append(f"Next: {first.unit} at {first.age.age}{unit} by {first.ways}.")
    return [*lines, *(f"To know more, {advice}." for advice in found.advice[:1])]


def _of_all(found: TimeToFailure) -> list[Warning]:
    """The warnings that concern no single failure mode."""
    return [each for each in found.warnings if not each.where]


def _stated(warnings: Iterable[Warning]) -> list[dict[str, Any]]:
    return [each.to_dict() for each in warnings]


def _section(
    name: str,
    title: str,
    charts: Sequence[str],
    text: Sequence[str] = (),
    *,
    lines: Sequence[str] = (),
    warnings: Iterable[Warning] = (),
    tables: Sequence[dict[str, Any]] = (),
) -> dict[str, Any]:
    return {
        "name": name,
        "title": title,
        "charts": list(charts),
        "text": list(text),
        "lines": list(lines),
        "warnings": _stated(warnings),
        "tables": list(tables),
    }


def _sections(answer: LifeTest, drawn_charts: list[str]) -> list[dict[str, Any]]:
    found, drift, film, maps = answer.time_to_failure, answer.drift, answer.film, answer.maps

    def named(name: str) -> list[str]:
        return [each for each in drawn_charts if each.split("_")[0] == name]

    def lines(result: Result | None) -> list[str]:
        return [] if result is None else [each.strip() for each in result.summary().split("\n")]

    not_judged = [each.within("not judged") for each in found.warnings if each.kind == NOT_JUDGED]
    of_modes = [each.within(mode.name) for mode in found.modes for each in mode.warnings]
    return [
        _section(
            "ends", "What ends each unit, and when", named("ends"), tables=[_first(found), _each(found)]
        ),
        _section("next", "What to measure next", (), found.advice, warnings=not_judged),
        _section("growth", "How the indicators grow", named("growth"), warnings=of_modes),
        _section("maps", "The operating map, from new to the end", named("maps"), lines(maps)[1:]),
        _section("film", "Film through life", named("film"), lines(film)[:1], lines=lines(film)[1:]),
        _section("drift", "What moved", named("drift"), lines(drift)[:1], lines=lines(drift)[1:]),
        _section("population", "The units that have ended", named("population")),
    ]


def _first(found: TimeToFailure) -> dict[str, Any]:
    """The first end of each unit."""
    unit = f" ({found.age_unit})" if found.age_unit else ""
    rows = [
        [each.unit, f"{each.age.last:.6g}", str(each.age.age), each.ways] for each in found.units[:_SHOWN]
    ]
    heads = ["unit", f"last seen{unit}", f"first end{unit}", "by"]
    return {"title": "", "heads": heads, "rows": rows, "numeric": [1]}


def _each(found: TimeToFailure) -> dict[str, Any]:
    """The age of each way by itself, of each unit and of the population."""
    unit = f" ({found.age_unit})" if found.age_unit else ""
    rows = [
        [mode.name + (" (a precursor)" if mode.sign else ""), each.unit, str(each.age), f"{each.never:.0%}"]
        for mode in found.modes
        for each in (*mode.ages.units[:_SHOWN], mode.ages.b10, mode.ages.b50)
    ]
    heads = ["way", "unit", f"age at the limit{unit}", "never"]
    return {"title": "every way by itself", "heads": heads, "rows": rows, "numeric": [3]}
