"""The page of a life test: which specimens need attention, what to do, then the evidence by section."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from hersey import _core
from hersey.charts.life import life_charts
from hersey.errors import sentence
from hersey.life.age import Age
from hersey.life.indicator import NOT_JUDGED
from hersey.report.life_decision import decision
from hersey.report.page import drawn
from hersey.schema.part import SCHEMA_VERSION
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    import polars as pl

    from hersey.life.following import LifeTest
    from hersey.life.time_to_failure.estimate import TimeToFailure

#: Specimens in the table of all failure modes; all are in `--json`.
_SHOWN = 60
#: Warnings in sight; the others are in a fold.
_WARNED = 3


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
        "title": answer.name,
        "origin": f"{_counted(len(found.units), 'specimen')}, {_counted(runs.height, 'run')}, up to {last}",
        "decision": decision(found),
        "warnings": _stated((*_of_all(found), *answer.warnings)),
        "shown_warnings": _WARNED,
        "sections": [each for each in _sections(answer, list(charts)) if each["text"] or each["charts"]],
        "uses": None if answer.uses is None else answer.uses.to_dict(),
        "runs": runs.select("sha256", "log").to_dicts(),
        "command": command,
    }
    return drawn(("life.css", "uses.js", "life.js"), "hersey life", document, charts)


def _counted(count: int, word: str) -> str:
    return f"{count} {word}{'s' * (count != 1)}"


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
        "text": [sentence(each) for each in text],
        "lines": [sentence(each.strip()) for each in lines],
        "warnings": _stated(warnings),
        "tables": list(tables),
    }


def _sections(answer: LifeTest, drawn_charts: list[str]) -> list[dict[str, Any]]:
    found, drift, film, maps = answer.time_to_failure, answer.drift, answer.film, answer.maps

    def named(name: str) -> list[str]:
        return [each for each in drawn_charts if each.split("_")[0] == name]

    not_judged = [each.within("not judged") for each in found.warnings if each.kind == NOT_JUDGED]
    of_modes = [each.within(mode.name) for mode in found.modes for each in mode.warnings]
    advice = [*found.advice, *filter(None, [found.planning()])]
    parts = [
        _section("ends", "Time to failure", named("ends"), tables=[_each(found)]),
        _section("next", "What to measure next", (), advice, warnings=not_judged),
        _section("growth", "Growth of the indicators", named("growth"), warnings=of_modes),
    ]
    if maps is not None:
        parts.append(
            _section("maps", "Operating map over life", named("maps"), maps.states(), warnings=maps.warnings)
        )
    if film is not None:
        parts.append(
            _section("film", "Film over life", named("film"), lines=film.findings(), warnings=film.warnings)
        )
    if drift is not None:
        title = "Drift of the parameters"
        parts.append(
            _section("drift", title, named("drift"), lines=drift.findings(), warnings=drift.warnings)
        )
    return [*parts, _section("population", "Population", [*named("population"), *named("replacement")])]


def _each(found: TimeToFailure) -> dict[str, Any]:
    """The age at each limit separately, of each specimen."""
    unit = f" ({found.age_unit})" if found.age_unit else ""
    rows = [
        [mode.name + (" (a precursor)" if mode.sign else ""), each.unit, str(each.age), f"{each.never:.0%}"]
        for mode in found.modes
        for each in mode.ages.units[:_SHOWN]
    ]
    heads = ["Failure mode", "Specimen", f"Age at the limit{unit}", "Not reached"]
    return {"title": "All failure modes of each specimen", "heads": heads, "rows": rows, "numeric": [3]}
