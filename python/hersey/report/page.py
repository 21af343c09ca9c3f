"""The page: one self-contained HTML file that shows an analysis document and its charts.

Document and charts go in as JSON, the page's script puts them on screen as text; the Vega runtime is taken
from vl-convert and inlined, so the file works offline and nothing foreign is kept in the repository.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import resources
from typing import Any

from hersey.charts.analysis import charts
from hersey.charts.page import page
from hersey.charts.render import specification_of
from hersey.charts.style import Chart
from hersey.document.parts import Analysis

# Samples that only the charts need: the page carries them once.
_DRAWN: Any = {
    "timeline": True,
    "fit": {"curves", "cells", "transition_curve"},
    "simulation": {"time", "belt_speed", "spring_force"},
}


def render(document: Analysis) -> str:
    """Return the page of a log as HTML text."""
    shown = document.model_dump(mode="json", exclude=_DRAWN)
    return drawn("page", "hersey report", shown, charts(document))


def drawn(name: str, title: str, document: Mapping[str, Any], charts: Mapping[str, Chart]) -> str:
    """Return a page as HTML text: what the script ``static/NAME.js`` shows of a document, with its charts."""
    static = resources.files("hersey.report") / "static"
    files = ("page.html", "page.css", "drawing.js", f"{name}.js")
    body, style, drawing, script = ((static / file).read_text(encoding="utf-8") for file in files)
    specifications = {key: specification_of(chart) for key, chart in charts.items()}
    data = {"document": document, "charts": specifications}
    return page(title=title, style=style, body=body, data=data, script=f"{drawing}\n{script}")
