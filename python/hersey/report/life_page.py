"""The page of a life test: which specimens need attention, what to do, then the evidence by section."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from hersey import _core
from hersey.charts.life import life_charts
from hersey.errors import sentence
from hersey.life.age import Age
from hersey.life.indicator import NOT_JUDGED
from hersey.life.time_to_failure.unsure import FEW
from hersey.report.page import drawn
from hersey.schema.part import SCHEMA_VERSION
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    import polars as pl

    from hersey.life.following import LifeTest
    from hersey.life.time_to_failure.estimate import TimeToFailure
    from hersey.life.time_to_failure.first import SpecimenEnd
    from hersey.result import Result

#: Specimens in the tables, and in the one of the first screen; all are in `--json`.
_SHOWN, _FIRST = 60, 8
#: Specimens that a sentence names.
_NAMED = 4
#: Probability of having failed from which a specimen has failed, and up to which it still runs.
_FAILED, _RUNS = 0.95, 0.05
#: Warnings in sight; the others are in a fold.
_WARNED = 3
_NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


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
        "decision": _decision(found),
        "warnings": _stated((*_of_all(found), *answer.warnings)),
        "shown_warnings": _WARNED,
        "sections": [each for each in _sections(answer, list(charts)) if each["text"] or each["charts"]],
        "uses": None if answer.uses is None else answer.uses.to_dict(),
        "runs": runs.select("sha256", "log").to_dicts(),
        "command": command,
    }
    return drawn(("life.css", "uses.js", "life.js"), "hersey life", document, charts)


def _decision(found: TimeToFailure) -> dict[str, Any]:
    """Which specimens need attention, the population, what to measure next, and a table of specimens."""
    order = sorted(found.units, key=lambda each: each.age.age.value)
    states = {each.unit: _state(each) for each in order}
    failed = [each.unit for each in order if states[each.unit][0] == "act"]
    unclear = [each.unit for each in order if states[each.unit][0] == "watch"]
    running = [each for each in order if states[each.unit][0] == "good"]
    unit = f" {found.age_unit}" if found.age_unit else ""
    said = [
        f"{_named(failed)} {'has' if len(failed) == 1 else 'have'} probably failed" if failed else "",
        f"{_named(unclear)} may have failed" if unclear else "",
    ]
    lead = "No specimen needs attention."
    if attention := len(failed) + len(unclear):
        need = "specimen needs" if attention == 1 else "specimens need"
        lead = (
            f"{_number(attention).capitalize()} {need} attention: {', '.join(each for each in said if each)}."
        )
    more = []
    if running:
        least = min(each.age.age.low for each in running)
        others = "Of the others, the" if attention else "The"
        by = " or ".join(running[0].named) or "no known failure mode"
        if math.isfinite(running[0].age.age.value):
            age = f"{running[0].age.age}{unit}"
            more.append(f"{others} first to fail is probably {running[0].unit}, at {age}, by {by}.")
        elif math.isfinite(least):
            more.append(f"{others} running specimens should reach at least {least:.6g}{unit}.")
    if len(found.units) >= FEW:
        more.append(sentence(found.headline()))
    rows = [
        [*states[each.unit], each.unit, each.ways, f"{each.age.last:.6g}", str(each.age.age)]
        for each in order[:_SHOWN]
    ]
    in_unit = unit and f" ({unit.strip()})"
    return {
        "signal": "act" if failed else "watch" if unclear else "good",
        "lead": lead,
        "more": more,
        "next": [sentence(each) for each in found.advice],
        "heads": ["State", "Specimen", "Failure mode", f"Last seen{in_unit}", f"Failure at{in_unit}"],
        "rows": rows,
        "first": _FIRST,
    }


def _state(each: SpecimenEnd) -> tuple[str, str]:
    """Signal and words of a specimen: failed, unclear or running."""
    passed = each.age.passed
    if passed >= _FAILED:
        return "act", f"Failed, {passed:.0%}"
    if passed > _RUNS:
        return "watch", f"Unclear, {passed:.0%}"
    return "good", "Running"


def _number(count: int) -> str:
    return _NUMBERS[count] if count < len(_NUMBERS) else str(count)


def _counted(count: int, word: str) -> str:
    return f"{count} {word}{'s' * (count != 1)}"


def _named(names: Sequence[str]) -> str:
    """The first of the names, and how many more there are."""
    shown = list(names[:_NAMED])
    if len(names) > _NAMED:
        return f"{', '.join(shown)} and {len(names) - _NAMED} more"
    return shown[0] if len(shown) == 1 else f"{', '.join(shown[:-1])} and {shown[-1]}"


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
        "lines": [sentence(each.removeprefix("- ")) for each in lines],
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
    over_life = [each for each in lines(maps)[1:] if not each.startswith("- ")]
    return [
        _section("ends", "Time to failure", named("ends"), tables=[_each(found)]),
        _section("next", "What to measure next", (), found.advice, warnings=not_judged),
        _section("growth", "Growth of the indicators", named("growth"), warnings=of_modes),
        _section("maps", "Operating map over life", named("maps"), over_life),
        _section("film", "Film over life", named("film"), lines=lines(film)[1:]),
        _section("drift", "Drift of the parameters", named("drift"), lines=lines(drift)[1:]),
        _section("population", "Failed specimens", named("population")),
    ]


def _each(found: TimeToFailure) -> dict[str, Any]:
    """The age at each limit separately, of each specimen and of the population."""
    unit = f" ({found.age_unit})" if found.age_unit else ""
    rows = [
        [mode.name + (" (a precursor)" if mode.sign else ""), each.unit, str(each.age), f"{each.never:.0%}"]
        for mode in found.modes
        for each in (*mode.ages.units[:_SHOWN], mode.ages.b10, mode.ages.b50)
    ]
    heads = ["Failure mode", "Specimen", f"Age at the limit{unit}", "Never reached"]
    return {"title": "All failure modes of each specimen", "heads": heads, "rows": rows, "numeric": [3]}
