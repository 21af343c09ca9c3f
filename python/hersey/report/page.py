"""The page: one self-contained HTML file that shows an analysis document and its charts.

Document and charts go in as JSON, the page's script puts them on screen as text; the Vega runtime is taken
from vl-convert and inlined, so the file works offline and nothing foreign is kept in the repository.
"""

from __future__ import annotations

from importlib import resources
from typing import Any

from hersey.charts.analysis import charts
from hersey.charts.page import page
from hersey.charts.render import specification_of
from hersey.document.parts import Analysis

_STATIC = ("html", "css", "js")
# Samples that only the charts need: the page carries them once.
_DRAWN: Any = {
    "timeline": True,
    "fit": {"curves", "cells", "transition_curve"},
    "simulation": {"time", "belt_speed", "spring_force"},
}


def render(document: Analysis) -> str:
    """Return the page as HTML text."""
    static = resources.files("hersey.report") / "static"
    body, style, script = ((static / f"page.{kind}").read_text(encoding="utf-8") for kind in _STATIC)
    specifications = {name: specification_of(chart) for name, chart in charts(document).items()}
    return page(
        title="hersey report",
        style=style,
        body=body,
        data={"document": document.model_dump(mode="json", exclude=_DRAWN), "charts": specifications},
        script=script,
    )
