"""The Vega runtime as one script: from the wheel, or bundled by vl-convert and kept in the user's cache.

``python -m hersey.charts.runtime FILE`` writes it, with the licence that it asks for: `make wheel` does.
"""

from __future__ import annotations

import contextlib
import hashlib
import sys
from importlib.metadata import version
from pathlib import Path

from platformdirs import user_cache_path

from hersey.charts.vega import VEGA_LITE, bundled
from hersey.errors import OutputError
from hersey.files.writing import write_atomically

#: Its file in a wheel; a checkout has none.
_SHIPPED = Path(__file__).with_name("vega-embed.js")
#: What Vega, Vega-Lite and Vega-Embed ask of those who pass them on.
_LICENCE = """/*
Vega, Vega-Lite and Vega-Embed: Copyright University of Washington Interactive Data Lab. All rights
reserved.
Redistribution and use in source and binary forms, with or without modification, are permitted provided
that the following conditions are met:
1. Redistributions of source code must retain the above copyright notice, this list of conditions and
the following disclaimer.
2. Redistributions in binary form must reproduce the above copyright notice, this list of conditions and
the following disclaimer in the documentation and/or other materials provided with the distribution.
3. Neither the name of the copyright holder nor the names of its contributors may be used to endorse or
promote products derived from this software without specific prior written permission.
THIS SOFTWARE IS PROVIDED BY THE COPYRIGHT HOLDERS AND CONTRIBUTORS "AS IS" AND ANY EXPRESS OR IMPLIED
WARRANTIES, INCLUDING, BUT NOT LIMITED TO, THE IMPLIED WARRANTIES OF MERCHANTABILITY AND FITNESS FOR A
PARTICULAR PURPOSE ARE DISCLAIMED. IN NO EVENT SHALL THE COPYRIGHT HOLDER OR CONTRIBUTORS BE LIABLE FOR
ANY DIRECT, INDIRECT, INCIDENTAL, SPECIAL, EXEMPLARY, OR CONSEQUENTIAL DAMAGES (INCLUDING, BUT NOT
LIMITED TO, PROCUREMENT OF SUBSTITUTE GOODS OR SERVICES; LOSS OF USE, DATA, OR PROFITS; OR BUSINESS
INTERRUPTION) HOWEVER CAUSED AND ON ANY THEORY OF LIABILITY, WHETHER IN CONTRACT, STRICT LIABILITY, OR
TORT (INCLUDING NEGLIGENCE OR OTHERWISE) ARISING IN ANY WAY OUT OF THE USE OF THIS SOFTWARE, EVEN IF
ADVISED OF THE POSSIBILITY OF SUCH DAMAGE.
It contains D3, TopoJSON and semver (ISC licence), fast-json-patch and json-stringify-pretty-compact
(MIT licence).
*/
"""


def runtime() -> str:
    """Return the script that defines ``vegaEmbed``, to be put into a page as it is.

    Bundling takes longer than all else that a report needs, so its result is kept in the user's cache; a
    script there that was changed or cut off is bundled anew.

    Raises
    ------
    OutputError
        If it cannot be bundled, such as for lack of memory.
    """
    if _SHIPPED.is_file():
        return _SHIPPED.read_text(encoding="utf-8")
    path = user_cache_path("hersey") / f"vega-embed-{version('vl-convert-python')}-{VEGA_LITE}.js"
    kept = _kept(path)
    if kept is not None:
        return kept
    script = _bundled()
    _keep(path, script)
    return script


def _bundled() -> str:
    return bundled("window.vegaEmbed = vegaEmbed;").replace("</script", "<\\/script")


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


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(_LICENCE + _bundled(), encoding="utf-8")
