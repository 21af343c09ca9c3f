"""Counts of a .jsonl of answers against the targets: intervals, B10 and B50, first failure modes.

An interval holds the truth if it encloses it. Never, as the truth, is held if the interval has no upper end,
if it ends beyond the ages that were looked at, or if 5 % of the draws or more never reach the limit. Ages
that have passed or never come are counted apart, and those of which truth and estimate are beyond three
times the last run.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.life_tests.modes import STARVATION, STICK_FULL, STICK_SLOW

#: Next mode later than the first by this is clear, by less than the other near.
CLEAR, NEAR = 1.25, 1.1
#: Share of draws from which hersey says never.
SAID_NEVER = 0.05
#: Beyond this many times the last run an age is far: hersey itself says that only the law speaks there.
FAR = 3.0
PLACES = ("held", "below", "above")
MODES = {STICK_SLOW: "stick-slip", STICK_FULL: "stick-slip", STARVATION: "starvation"}


@dataclass(frozen=True)
class Case:
    """One age that was asked: group, mechanism, and where the truth is against the interval."""

    group: str
    mechanism: str
    #: below, held or above.
    place: str


def place(asked: dict[str, Any], truth: float | None, horizon: float) -> str:
    """Return whether the truth is below, above or in the interval of an age."""
    low, high = asked["age"]["low"], asked["age"]["high"]
    open_end = high is None or asked["never"] >= SAID_NEVER or high >= horizon
    if truth is None:
        return "held" if open_end else "above"
    if low is None or truth < low:
        return "below"
    return "held" if open_end or truth <= high else "above"


def _when(asked: dict[str, Any], real: float | None, last: float) -> str:
    """Return what sets an age apart from those ahead, as a word."""
    if real is None:
        return " (never)"
    said = asked["age"]["value"]
    far = real > FAR * last and (said is None or said > FAR * last)
    return " (passed)" if real <= last else " (far)" if far else ""


def cases(row: dict[str, Any]) -> Iterator[Case]:
    """Return every age that a campaign was asked for."""
    truth, answer = row["truth"], row["answer"]
    horizon, people = truth["horizon"], truth["population"]
    ends = {unit["unit"]: unit for unit in truth["units"]}
    latest = max(unit["ages"][-1] for unit in truth["units"])

    def case(group: str, asked: dict[str, Any], real: float | None, last: float) -> Case:
        apart = _when(asked, real, last)
        if group[0] == "B" and apart == " (passed)":
            apart = ""
        return Case(group + apart, truth["mechanism"], place(asked, real, horizon))

    for mode in answer["modes"]:
        name = mode["name"]
        if name not in people:
            continue
        for asked in mode["units"]:
            end = ends[asked["unit"]]
            yield case(MODES.get(name, name), asked, end["ends"][name], end["ages"][-1])
        for key in ("B10", "B50"):
            yield case(f"{key} of a mode", mode[key.lower()], people[name][key], latest)
    for unit in answer["units"]:
        end = ends[unit["unit"]]
        yield case("first failure", unit["age"], end["age"], end["ages"][-1])
    for key in ("B10", "B50"):
        yield case(f"{key} of all", answer[key.lower()], people["first"][key], latest)


def firsts(row: dict[str, Any]) -> Iterator[tuple[str, bool]]:
    """Return for each specimen whether it is clear or near, and whether hersey is right."""
    named = {unit["unit"]: unit["named"] for unit in row["answer"]["units"]}
    for unit in row["truth"]["units"]:
        if unit["first"] is None:
            continue
        order = sorted((age, name) for name, age in unit["ends"].items() if age is not None)
        later = order[1][0] / max(order[0][0], 1e-9) if len(order) > 1 else float("inf")
        said = named[unit["unit"]]
        if later >= CLEAR:
            yield "clear", bool(said) and said[0] == order[0][1]
        elif later <= NEAR:
            yield "near", {order[0][1], order[1][1]} <= set(said)


def read(file: Path) -> list[dict[str, Any]]:
    """Return the rows of a .jsonl, by seed."""
    rows = [json.loads(line) for line in file.read_text().splitlines()]
    return sorted(rows, key=lambda row: row["seed"])


def _shares(places: Iterable[str]) -> str:
    """Return count, and shares held, below and above, as cells."""
    counted = Counter(places)
    count = sum(counted.values())
    return " | ".join([str(count), *(f"{100 * counted[key] / max(count, 1):.0f} %" for key in PLACES)])


def _table(head: str, places: Iterable[tuple[str, str]]) -> list[str]:
    groups: dict[str, list[str]] = {}
    for group, at in places:
        groups.setdefault(group, []).append(at)
    lines = [f"| {head} | ages | held | truth below | truth above |", "|---|---|---|---|---|"]
    return lines + [f"| {name} | {_shares(groups[name])} |" for name in sorted(groups)]


def _firsts(rows: list[dict[str, Any]]) -> list[str]:
    judged = [pair for row in rows for pair in firsts(row)]
    lines = ["| first failure mode | specimens | right |", "|---|---|---|"]
    for kind in ("clear", "near"):
        right = [ok for word, ok in judged if word == kind]
        lines.append(f"| {kind} | {len(right)} | {100 * sum(right) / max(len(right), 1):.0f} % |")
    return lines


def _apart(found: list[Case]) -> list[str]:
    """Return the tables of ages ahead, of ages that are counted apart, and of mechanisms."""
    lines: list[str] = []
    for title, apart in (("Ahead", ""), ("Passed", "(passed)"), ("Far", "(far)"), ("Never", "(never)")):
        chosen = [case for case in found if apart in case.group and bool(apart) is ("(" in case.group)]
        places = [(case.group.partition(" (")[0], case.place) for case in chosen]
        lines += [f"{title}:", "", *_table("what", places), ""]
    ahead = [case for case in found if "(" not in case.group]
    for title, people in (("Ages ahead", False), ("B10 and B50", True)):
        places = [(case.mechanism, case.place) for case in ahead if case.group.startswith("B") is people]
        lines += [f"{title} by mechanism:", "", *_table("mechanism", places), ""]
    return lines


def report(rows: list[dict[str, Any]]) -> str:
    """Return the tables of all rows as Markdown; campaigns that were re-greased are apart."""
    good = [row for row in rows if "answer" in row]
    lines = [f"{len(rows)} campaigns, {len(rows) - len(good)} without an answer.", ""]
    lines += [f"- {row['seed']}: {row['error']}" for row in rows if "answer" not in row]
    logs = sum(len(row.get("refused", {})) for row in good)
    lines += [f"{logs} logs refused.", ""]
    renewed = [row for row in good if row["truth"]["re-greased at"]]
    others = [row for row in good if row not in renewed]
    lines += _apart([case for row in others for case in cases(row)]) + _firsts(others)
    lines += ["", f"Re-greased once at a known age, {len(renewed)} campaigns:", ""]
    # New specimens are not known to be re-greased, so that B10 and B50 are of another population.
    places = [(case.group, case.place) for row in renewed for case in cases(row) if case.group[0] != "B"]
    lines += _table("what", places)
    seconds = [sum(row["seconds"].values()) for row in good]
    lines += ["", f"Processor time per campaign: {sum(seconds) / max(len(seconds), 1):.0f} s."]
    return "\n".join(lines)
