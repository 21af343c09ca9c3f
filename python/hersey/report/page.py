"""The page: one self-contained HTML file that shows an analysis document and its charts.

Document and charts go in as JSON, the page's script puts them on screen as text; the Vega runtime is taken
from vl-convert and inlined, so the file works offline and nothing foreign is kept in the repository.
"""

from __future__ import annotations

import base64
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib import resources
from pathlib import Path
from typing import Any

from hersey.charts.analysis import charts
from hersey.charts.page import page
from hersey.charts.render import specification_of
from hersey.charts.style import Chart
from hersey.damping.dwells.reduced import refuse_unfitted
from hersey.document.analysis import Analysis
from hersey.document.assembly import document_of
from hersey.errors import sentence
from hersey.files.writing import write_atomically
from hersey.report.glossary import meanings
from hersey.study.log_and_machine import Study
from hersey.units import takes_si

#: Styles of all pages, and the pieces of their scripts, in the order in which they are one module.
_STYLES = ("tokens.css", "page.css")
_SHARED = ("drawing.js", "chart.js")
_LIVE = (
    "terms.js",
    "physics.js",
    "answers.js",
    "labour.js",
    "shape.js",
    "mapnames.js",
    "ring.js",
    "map.js",
    "settings.js",
    "traces.js",
    "numbers.js",
    "profile.js",
    "controls.js",
    "verdict.js",
    "panel.js",
)
_SECTIONS = ("section.js", "joint.js", "torque.js", "regime.js", "quality.js", "band.js", "plans.js")
_REPORT = ("panel.css", "timeline.js", *_LIVE, "first.js", *_SECTIONS, "page.js")
#: Charts that the page draws itself: the log on one axis, and motion.
_OTHERWISE = ("timeline_", "simulation_")
#: Terms whose meaning a label shows where the pointer rests on it.
_TERMS = ("V*", "transition", "stick speed", "closure", "dwell")
#: Samples that only charts need.
_DRAWN: Any = {"fit": {"cells"}, "simulation": True, "moments": True}


@takes_si()
def report(
    study: Study, path: str | Path = "report.html", *, command: str = "", overwrite: bool = False
) -> None:
    """Write the page of a study, one HTML file.

    Parameters
    ----------
    study
        From `hersey.study`.
    path
        The file to write, as `hersey report` names it by default.
    command
        What was typed, as the page shall say.
    overwrite
        Whether a file that is there may be replaced.

    Raises
    ------
    OutputError
        If the file is there and may not be replaced, or cannot be written.
    ParameterError
        If ``study`` is a log, its file or its steady points: the message has the line to write.
    """
    if not isinstance(study, Study):
        refuse_unfitted(study, 'hersey.report(hersey.study({points}), "report.html")', "a study")
    made = datetime.now(UTC).isoformat(timespec="seconds")
    document = document_of(study, command=command, made=made)
    write_atomically(Path(path), render(document), overwrite=overwrite)


def render(document: Analysis) -> str:
    """Return the page of a log as HTML text."""
    shown = charts(document, but=_OTHERWISE)
    core = resources.files("hersey.report") / "static" / "physics.wasm"
    physics = base64.b64encode(core.read_bytes()).decode() if document.map else None
    return drawn(
        _REPORT,
        "hersey report",
        document.model_dump(mode="json", exclude=_DRAWN),
        shown,
        physics=physics,
        glossary=meanings(_TERMS),
    )


def drawn(
    pieces: tuple[str, ...],
    title: str,
    document: Mapping[str, Any],
    charts: Mapping[str, Chart],
    *,
    physics: str | None = None,
    glossary: Mapping[str, str] | None = None,
) -> str:
    """Return a page as HTML text: what ``pieces`` of ``static`` (scripts, styles) show of a document.

    ``physics`` is the core as WebAssembly, in base64; ``glossary`` is what terms of the page mean.
    """
    data: dict[str, object] = {
        "document": document,
        "charts": {key: _with_sentences(specification_of(chart)) for key, chart in charts.items()},
    }
    more = {"physics": physics, "glossary": glossary}
    data |= {name: content for name, content in more.items() if content is not None}
    return page(
        title=title,
        style=_static((*_STYLES, *(name for name in pieces if name.endswith(".css")))),
        body=_static(("page.html",)),
        data=data,
        script=_static((*_SHARED, *(name for name in pieces if name.endswith(".js")))),
        computes=physics is not None,
    )


def _with_sentences(chart: dict[str, Any]) -> dict[str, Any]:
    """The specification of a chart, the lines below its title as sentences."""
    title = chart.get("title")
    if not isinstance(title, dict) or "subtitle" not in title:
        return chart
    lines = title["subtitle"]
    finished = [sentence(each) for each in ([lines] if isinstance(lines, str) else lines)]
    return chart | {"title": title | {"subtitle": finished}}


def _static(names: tuple[str, ...]) -> str:
    """The pieces one after another."""
    folder = resources.files("hersey.report") / "static"
    return "\n".join((folder / name).read_text(encoding="utf-8") for name in names)
