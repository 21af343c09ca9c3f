"""From a chart to its files: styled, with the digits that can be seen."""

from __future__ import annotations

import html
from collections.abc import Callable
from typing import Any

import vl_convert

from hersey.charts import PICTURES
from hersey.charts.runtime import VEGA_LITE, embedded, runtime
from hersey.charts.style import Chart, Row
from hersey.errors import OutputError

#: Looks that all charts share.
_CONFIG: dict[str, Row] = {
    "view": {"stroke": "#999"},
    "axis": {"gridColor": "#e3e3e3", "labelFontSize": 12, "titleFontSize": 13},
    "legend": {"labelFontSize": 12, "titleFontSize": 12},
    "title": {"anchor": "start", "fontSize": 15, "subtitleColor": "#555", "subtitleFontSize": 12},
}


def picture(chart: Chart, suffix: str) -> bytes:
    """Return the content of a file of one of `PICTURES`; a png has two pixels per point.

    Raises
    ------
    OutputError
        If the suffix is none of these.
    """
    if suffix not in PICTURES:
        raise OutputError(f"'{suffix}' is no kind of picture: name a file that ends in {', '.join(PICTURES)}")
    content = _WRITERS[suffix](specification_of(chart))
    return content.encode() if isinstance(content, str) else content


def specification_of(chart: Chart) -> Row:
    """Return the Vega-Lite specification of a chart, styled.

    Altair's check against the schema is left to the tests: it takes longer than all else.
    """
    specification: Row = _rounded(chart.to_dict(validate=False))
    config = specification.setdefault("config", {})
    for part, look in _CONFIG.items():
        config[part] = config.get(part, {}) | look
    return specification


def _page(specification: Row) -> str:
    title = specification.get("title", {})
    return _PAGE.format(
        title=html.escape(title["text"] if isinstance(title, dict) and "text" in title else "Chart"),
        runtime=runtime(),
        chart=embedded(specification),
    )


def _svg(specification: Row) -> str:
    return vl_convert.vegalite_to_svg(specification, vl_version=VEGA_LITE)


def _png(specification: Row) -> bytes:
    return vl_convert.vegalite_to_png(specification, vl_version=VEGA_LITE, scale=2)


def _pdf(specification: Row) -> bytes:
    return vl_convert.vegalite_to_pdf(specification, vl_version=VEGA_LITE)


_WRITERS: dict[str, Callable[[Row], str | bytes]] = {
    ".html": _page,
    ".svg": _svg,
    ".png": _png,
    ".pdf": _pdf,
}


def _rounded(value: Any) -> Any:
    """The same with six significant digits: more cannot be seen, and files grow with them."""
    if isinstance(value, float):
        return float(f"{value:.6g}")
    if isinstance(value, dict):
        return {key: _rounded(item) for key, item in value.items()}
    return [_rounded(item) for item in value] if isinstance(value, list) else value


_PAGE = """<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>{title}</title>
<style>body {{ margin: 2rem; font-family: sans-serif }}</style>
<div id="chart"></div>
<script>{runtime}</script>
<script>vegaEmbed("#chart", {chart}, {{renderer: "svg", actions: false}});</script>
</html>
"""
