"""What the process of `hersey.charts.vega` runs; it imports vl-convert and nothing of this package."""

from __future__ import annotations

from typing import Any

import vl_convert


def answer(request: dict[str, Any], content: bytes) -> tuple[dict[str, Any], bytes]:
    """Return a chart's pictures one after another, with their lengths, or a bundled script, as bytes."""
    text, version = content.decode(), request["version"]
    if request["what"] == "bundle":
        return {}, vl_convert.javascript_bundle(text, vl_version=version).encode()
    svg = vl_convert.vegalite_to_svg(text, vl_version=version)
    pictures = [_picture(svg, kind) for kind in request["kinds"]]
    return {"lengths": [len(each) for each in pictures]}, b"".join(pictures)


def _picture(svg: str, kind: str) -> bytes:
    match kind:
        case "svg":
            return svg.encode()
        case "png":
            return bytes(vl_convert.svg_to_png(svg, scale=2))
        case "pdf":
            return bytes(vl_convert.svg_to_pdf(svg))
    raise ValueError(f"no such picture: {kind}")
