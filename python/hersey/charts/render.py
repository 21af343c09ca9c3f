"""From a chart to its files: styled, with the digits that can be seen."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from hersey.charts import FIGURES, PICTURES
from hersey.charts.page import page
from hersey.charts.style import Chart, Row
from hersey.charts.vega import drawn
from hersey.errors import OutputError
from hersey.files.writing import write_all

#: Longest text in a chart, pixels: names may have any length, and pictures would grow with them.
_LONGEST = 1500
#: Looks that all charts share.
_CONFIG: dict[str, Row] = {
    "view": {"stroke": "#999"},
    "axis": {"gridColor": "#e3e3e3", "labelFontSize": 12, "titleFontSize": 13, "titleLimit": _LONGEST},
    "legend": {"labelFontSize": 12, "titleFontSize": 12},
    "text": {"limit": _LONGEST},
    "title": {
        "anchor": "start",
        "fontSize": 15,
        "limit": _LONGEST,
        "subtitleColor": "#555",
        "subtitleFontSize": 12,
    },
}
#: Characters that no XML may hold, so no SVG: control signs, halves of a pair of surrogates.
_NOT_XML = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


def picture(chart: Chart, suffix: str) -> bytes:
    """Return the content of a file of one of `PICTURES`; a png has two pixels per point.

    Raises
    ------
    OutputError
        If the suffix is none of these, or the chart cannot be drawn, such as for lack of memory.
    """
    if suffix not in PICTURES:
        raise OutputError(f"'{suffix}' is no kind of picture: name a file that ends in {', '.join(PICTURES)}")
    specification = specification_of(chart)
    if suffix == ".html":
        return _page(specification).encode()
    return drawn(specification, [suffix.removeprefix(".")])[0]


def write_pictures(charts: Mapping[str, Chart], folder: Path, *, overwrite: bool = True) -> list[Path]:
    """Write every chart as SVG, PNG and PDF and return the paths; all are drawn before one is written.

    Raises
    ------
    OutputError
        If a file exists and ``overwrite`` is false, or one cannot be written.
    """
    kinds = [suffix.removeprefix(".") for suffix in FIGURES]
    pictures = {
        folder / f"{name}{suffix}": content
        for name, chart in charts.items()
        for suffix, content in zip(FIGURES, drawn(specification_of(chart), kinds), strict=True)
    }
    folder.mkdir(parents=True, exist_ok=True)
    write_all(pictures, overwrite=overwrite)
    return list(pictures)


def specification_of(chart: Chart) -> Row:
    """Return the Vega-Lite specification of a chart, styled.

    Altair's check against the schema is left to the tests: it takes longer than all else.
    """
    specification: Row = _rounded(chart.to_dict(validate=False))
    _number_views(specification)
    config = specification.setdefault("config", {})
    for part, look in _CONFIG.items():
        config[part] = config.get(part, {}) | look
    return specification


def _number_views(specification: Row) -> None:
    """Name views by their order: altair names them by where their rows lie in memory."""
    views = list(_views(specification))
    named = dict.fromkeys(view["name"] for view in views if "name" in view)
    names = {name: f"view_{number}" for number, name in enumerate(named, 1)}
    for view in views:
        if "name" in view:
            view["name"] = names[view["name"]]
        for selection in view.get("params", ()):
            if "views" in selection:
                selection["views"] = [names.get(name, name) for name in selection["views"]]


def _views(view: Row) -> Iterator[Row]:
    """A view and all within it, from the outside in."""
    yield view
    within = [*view.get("layer", ()), *view.get("vconcat", ()), *view.get("hconcat", ())]
    for each in [*within, *([view["spec"]] if "spec" in view else [])]:
        yield from _views(each)


def _page(specification: Row) -> str:
    title = specification.get("title", {})
    return page(
        title=title["text"] if isinstance(title, dict) and "text" in title else "Chart",
        style="body { margin: 2rem; font-family: sans-serif }",
        body='<div id="chart"></div>',
        data={"specification": specification},
        script=_SCRIPT,
    )


def _rounded(value: Any) -> Any:
    """The same with six significant digits: more cannot be seen, and files grow with them.

    A number that JSON does not know is None, as Vega takes it; what no picture can hold of a text is a sign
    for such.
    """
    if isinstance(value, str):
        return _NOT_XML.sub("\ufffd", value)
    if isinstance(value, float):
        return float(f"{value:.6g}") if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _rounded(item) for key, item in value.items()}
    return [_rounded(item) for item in value] if isinstance(value, list) else value


_SCRIPT = """
const specification = JSON.parse(document.getElementById("specification").textContent);
await window.vegaEmbed("#chart", specification, { renderer: "svg", actions: false, ast: true });
document.body.dataset.ready = "true";
"""
