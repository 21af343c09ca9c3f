"""From a chart to its files: styled, with the digits that can be seen."""

from __future__ import annotations

from typing import Any

import altair as alt
import vl_convert

from hersey.charts.style import Chart, Row


def rendered(chart: Chart) -> dict[str, bytes]:
    """Return the content of a chart's files by suffix: svg, png (two pixels per point), pdf."""
    specification = specification_of(chart)
    version = alt.SCHEMA_VERSION.removeprefix("v").rsplit(".", 1)[0]
    return {
        "svg": vl_convert.vegalite_to_svg(specification, vl_version=version).encode(),
        "png": vl_convert.vegalite_to_png(specification, vl_version=version, scale=2),
        "pdf": vl_convert.vegalite_to_pdf(specification, vl_version=version),
    }


def specification_of(chart: Chart) -> Row:
    """Return the Vega-Lite specification of a chart, styled."""
    styled = (
        chart.configure_view(stroke="#999")
        .configure_axis(labelFontSize=12, titleFontSize=13, gridColor="#e3e3e3")
        .configure_legend(labelFontSize=12, titleFontSize=12)
        .configure_title(anchor="start", fontSize=15, subtitleFontSize=12, subtitleColor="#555")
    )
    specification: Row = _rounded(styled.to_dict())
    return specification


def _rounded(value: Any) -> Any:
    """The same with six significant digits: more cannot be seen, and files grow with them."""
    if isinstance(value, float):
        return float(f"{value:.6g}")
    if isinstance(value, dict):
        return {key: _rounded(item) for key, item in value.items()}
    return [_rounded(item) for item in value] if isinstance(value, list) else value
