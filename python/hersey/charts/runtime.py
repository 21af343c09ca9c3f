"""The Vega runtime as one script: bundled by vl-convert once, then kept in the user's cache."""

from __future__ import annotations

import contextlib
import hashlib
from importlib.metadata import version
from pathlib import Path

from platformdirs import user_cache_path

from hersey.charts.vega import VEGA_LITE, bundled
from hersey.errors import OutputError
from hersey.files.writing import write_atomically


def runtime() -> str:
    """Return the script that defines ``vegaEmbed``, to be put into a page as it is.

    Bundling takes longer than all else that a report needs, so its result is kept in the user's cache; a
    script there that was changed or cut off is bundled anew.

    Raises
    ------
    OutputError
        If it cannot be bundled, such as for lack of memory.
    """
    path = user_cache_path("hersey") / f"vega-embed-{version('vl-convert-python')}-{VEGA_LITE}.js"
    kept = _kept(path)
    if kept is not None:
        return kept
    script = bundled("window.vegaEmbed = vegaEmbed;")
    script = script.replace("</script", "<\\/script")
    _keep(path, script)
    return script


def _kept(path: Path) -> str | None:
    """The script of a file whose first line is the digest of the rest."""
    try:
        digest, _, script = path.read_bytes().partition(b"\n")
    except OSError:
        return None
    return script.decode() if digest == _digest(script) else None


def _keep(path: Path, script: str) -> None:
    """Write the script for the next time, if there is a place for it."""
    content = script.encode()
    with contextlib.suppress(OSError, OutputError):
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(path, _digest(content) + b"\n" + content, overwrite=True)


def _digest(content: bytes) -> bytes:
    return hashlib.sha256(content).hexdigest().encode()
