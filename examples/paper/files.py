"""Writing the figures: images, a page of claims, and the numbers."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from hersey.charts import FIGURES
from hersey.charts.render import picture
from hersey.errors import OutputError
from hersey.files.writing import write_all
from hersey.result import json_value
from paper.figure import ABOUT, Figure

_HEAD = f"""# Figures of the paper, drawn anew, and figures beyond it

Figs. 1 to 8 are drawn of a machine and a log, in the units of their axes; the others of the paper's model, in
inches, ounces of force and seconds. Every number of these is computed, but for A of Eq. 29 and the speeds and
ranges that the paper names. *About* means within {ABOUT:g} of an exponent, or {ABOUT:.0%} of a value.
"""


def write(figures: Sequence[Figure], folder: Path, *, overwrite: bool = False) -> list[Path]:
    """Write each figure as SVG, PNG and PDF, with ``figures.md`` and ``figures.json``; return the paths.

    Everything is drawn before anything is written, and all is written before anything takes its place.

    Raises
    ------
    OutputError
        If a file exists and ``overwrite`` is false, or the folder cannot be written.
    """
    names = [f"{figure.name}{suffix}" for figure in figures for suffix in FIGURES]
    paths = [folder / name for name in [*names, "figures.md", "figures.json"]]
    there = [path for path in paths if path.exists()]
    if there and not overwrite:
        raise OutputError(f"{there[0]} exists: set overwrite=True to replace it, or name another folder")
    contents = {
        f"{figure.name}{suffix}": picture(figure.chart, suffix) for figure in figures for suffix in FIGURES
    }
    contents |= {"figures.md": markdown(figures).encode(), "figures.json": as_json(figures).encode()}
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder} cannot be written: {error.strerror}") from None
    write_all({folder / name: content for name, content in contents.items()}, overwrite=overwrite)
    return paths


def markdown(figures: Sequence[Figure]) -> str:
    """Return the figures with their claims as Markdown."""
    lines = [_HEAD]
    for figure in figures:
        lines += [f"## {figure.heading}", "", f"![{figure.title}]({figure.name}.svg)", ""]
        for claim in figure.claims:
            lines.append(f"- {claim.source}: {claim.statement} **{claim.verdict.capitalize()}.**")
            lines.append(f"  {claim.evidence}")
            lines.append(f"  *Judged by:* {claim.criterion}")
        lines.append("")
    return "\n".join(lines)


def as_json(figures: Sequence[Figure]) -> str:
    """Return claims and data as JSON text; what is no finite number is null."""
    content = {
        "units": {"length": "in", "force": "ozf", "time": "s"},
        "figures": [
            {
                "name": figure.name,
                "number": figure.number,
                "title": figure.title,
                "claims": [
                    {
                        "source": claim.source,
                        "statement": claim.statement,
                        "criterion": claim.criterion,
                        "verdict": claim.verdict.value,
                        "evidence": claim.evidence,
                        "numbers": claim.numbers,
                    }
                    for claim in figure.claims
                ],
                "data": figure.data,
            }
            for figure in figures
        ],
    }
    return json.dumps(json_value(content), indent=1, allow_nan=False) + "\n"
