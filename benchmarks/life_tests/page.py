"""The page of the counts, `benchmarks/LIFE_TESTS.md`: how they are made, targets, all tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from benchmarks.life_tests import score, slips

HEAD = """# Life tests of an independent generator

`python -m benchmarks.life_tests` writes life tests as files, asks hersey, and counts. The generator
(`benchmarks/life_tests`) is written from physics alone and shares no code with hersey. Two laws of
hersey were added after it was read: growth as a sigmoid, and side flow of any power. Seeds 20 to 359
chose how far growth may depart from its law, the priors of films, and what is left of smoothing.
Each campaign draws a machine (oil, roughness, rolling share, sensor gain), one of ten mechanisms, 4
to 12 specimens with 4 to 9 runs at uneven ages, followed to 54 to 66 % of the median life, and
limits of which one is reached first. Specimens differ when new and in every rate; runs scatter by
mounting, by temperature and by 0.4 to 1.5 % per dwell.

| mechanism | what ages |
|---|---|
| run-in, then thickening | roughness falls as 1/(1 + s); oil oxidises as a sigmoid |
| bleed and evaporation | layer of oil exponential to a residue, less a constant rate; film as tanh |
| side flow | h' = -h^n, n 1.4 to 3.8; film by a table of a starved Reynolds inlet under a pulsed layer |
| roughening | roughness as a power of distance, boundary friction, oil shears down; mixed regime |
| debris | drag as a power of distance, and shocks at random |
| rubber hardening | after-cure, then oxidation; the nip narrows |
| boundary film | friction grows the more the hotter; oil shears down |
| filled oil | Krieger and Dougherty; layer thins; rolling is 20 to 40 % of drag, in the others 0 to 40 % |
| re-greased | bleed, renewed once at a known age |
| nothing ages | specimens differ, no more |

A truth is the age at which the noiseless law of a specimen first meets the limit of the machine
file; starvation is a film below 0.79 of the flooded one, whatever its law. B10 and B50 are those of
1500 new specimens. *Held* is a 90 % interval that encloses the truth; *far* are truth and estimate
beyond three times the last run, *passed* is a truth before it. A truth of never is held if the
interval has no upper end or 5 % of the draws never reach the limit.
"""


def _target(
    what: str, places: Sequence[str], place: str, least: int = 0, most: int = 100
) -> tuple[bool, str]:
    """Return whether the share of a place is as asked, and the line of the table."""
    share = 100 * places.count(place) / max(len(places), 1)
    met = least <= share <= most
    asked = f"at most {most} %" if least == 0 else f"{least} to {most} %"
    return met, f"| {what} | {asked} | {share:.1f} % of {len(places)} | {'yes' if met else 'no'} |"


def targets(rows: list[dict[str, Any]]) -> list[str]:
    """Return a table of what is asked and found, what is missed first; re-greased campaigns are apart."""
    rows = [row for row in rows if "answer" in row and not row["truth"]["re-greased at"]]
    ahead = [case for row in rows for case in score.cases(row) if "(" not in case.group]
    lines = []
    for group in sorted({case.group for case in ahead}):
        places = [case.place for case in ahead if case.group == group]
        lines.append(_target(f"{group}, held", places, "held", 85, 95))
        lines.append(_target(f"{group}, truth below", places, "below", most=8))
    never = [case.place for row in rows for case in score.cases(row) if "(never)" in case.group]
    lines.append(_target("an end is given where there is none", never, "above", most=10))
    judged = [pair for row in rows for pair in score.firsts(row)]
    for kind, what in (("clear", "right mode first, clear"), ("near", "both named, near")):
        lines.append(_target(what, [str(ok) for word, ok in judged if word == kind], "True", 95))
    ordered = [line for _, line in sorted(lines, key=lambda pair: pair[0])]
    return ["| what, ages ahead | asked | found | met |", "|---|---|---|---|", *ordered]


def page(rows: list[dict[str, Any]], mistakes: list[dict[str, Any]]) -> str:
    """Return the page."""
    seeds = [row["seed"] for row in rows]
    parts = [
        HEAD,
        f"{len(rows)} campaigns of seeds {min(seeds)} to {max(seeds)}, held out from all tuning:",
        "",
    ]
    parts += [*targets(rows), "", score.report(rows), ""]
    if mistakes:
        parts += ["## Mistakes", "", slips.report(mistakes), ""]
    return "\n".join(parts)
