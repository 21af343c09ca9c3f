"""What the process of `hersey.charts.vega` runs; it imports vl-convert and nothing of this package."""

from __future__ import annotations

from typing import Any

import vl_convert


def answer(request: dict[str, Any], content: bytes) -> tuple[dict[str, Any], bytes]:
    """Return a chart's picture, or a bundled script, as bytes."""
    text, version = content.decode(), request["version"]
    match request["what"]:
        case "svg":
            return {}, vl_convert.vegalite_to_svg(text, vl_version=version).encode()
        case "png":
            return {}, vl_convert.vegalite_to_png(text, vl_version=version, scale=2)
        case "pdf":
            return {}, vl_convert.vegalite_to_pdf(text, vl_version=version)
        case "bundle":
            return {}, vl_convert.javascript_bundle(text, vl_version=version).encode()
    raise ValueError(f"no such request: {request['what']}")
