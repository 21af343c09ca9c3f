"""The page: one self-contained HTML file that shows an analysis document and its charts.

Document and charts go in as JSON, the page's script puts them on screen as text; the Vega runtime is taken
from vl-convert and inlined, so the file works offline and nothing foreign is kept in the repository.
"""

from __future__ import annotations

import json
import os
import tempfile
from importlib import resources
from pathlib import Path
from typing import Any

import altair as alt
import vl_convert

from hersey.charts import charts, specification_of
from hersey.document import Analysis
from hersey.errors import OutputError

# Samples that only the charts need: the page carries them once.
_DRAWN: Any = {
    "timeline": True,
    "fit": {"curves", "cells", "transition_curve"},
    "simulation": {"time", "belt_speed", "spring_force"},
}


def render(document: Analysis) -> str:
    """Return the page as HTML text."""
    page = resources.files("hersey") / "page"
    specifications = {name: specification_of(chart) for name, chart in charts(document).items()}
    version = alt.SCHEMA_VERSION.removeprefix("v").rsplit(".", 1)[0]
    parts = {
        "css": (page / "page.css").read_text(encoding="utf-8"),
        "document": _embedded(document.model_dump(mode="json", exclude=_DRAWN)),
        "charts": _embedded(specifications),
        "runtime": vl_convert.javascript_bundle("window.vegaEmbed = vegaEmbed;", vl_version=version).replace(
            "</script", "<\\/script"
        ),
        "script": (page / "page.js").read_text(encoding="utf-8"),
    }
    pieces = (page / "page.html").read_text(encoding="utf-8").split("@@")
    return "".join(parts[piece] if i % 2 else piece for i, piece in enumerate(pieces))


def _embedded(content: object) -> str:
    """JSON that no browser can take for markup."""
    text = json.dumps(content, ensure_ascii=True, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def write_atomically(path: Path, content: str | bytes, *, overwrite: bool) -> None:
    """Write a file whole or not at all; never over an existing one unless told to.

    Raises
    ------
    OutputError
        If the file exists and ``overwrite`` is false, or it cannot be written.
    """
    if path.is_dir():
        raise OutputError(f"{path} is a directory: name a file in it")
    if path.exists() and not overwrite:
        raise OutputError(f"{path} exists: say --force to replace it, or name another file with --out")
    try:
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".part")
    except OSError as error:
        raise OutputError(f"{path} cannot be written: {error.strerror}") from None
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content.encode("utf-8") if isinstance(content, str) else content)
        Path(temporary).chmod(0o666 & ~_umask())
        Path(temporary).replace(path)
    except BaseException as error:
        Path(temporary).unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise OutputError(f"{path} cannot be written: {error.strerror}") from None
        raise


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
