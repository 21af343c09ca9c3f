"""What every page is made of, and what it may do: run its own two scripts, and nothing else.

All that comes from a file of the user goes in as JSON, in blocks that no browser runs or takes for markup;
the scripts put it on screen as text.
"""

from __future__ import annotations

import base64
import hashlib
import html
import json
from collections.abc import Mapping

from hersey.charts.runtime import runtime


def page(
    *, title: str, style: str, body: str, data: Mapping[str, object], script: str, computes: bool = False
) -> str:
    """Return a page as HTML text that needs no network.

    Parameters
    ----------
    title
        What the browser calls the page; may come from a file of the user.
    style, body
        CSS and HTML of ours.
    data
        What the script reads, by the id of the element that holds it as JSON.
    script
        Our script, a module; ``vegaEmbed`` is there when it runs, and needs its option ``ast``, by which Vega
        interprets its expressions rather than compile them.
    computes
        Whether the script compiles WebAssembly that the page holds, and runs it in workers of its own.
    """
    scripts = [_normal(text) for text in (runtime(), script)]
    pieces = [
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f'<meta http-equiv="Content-Security-Policy" content="{policy(scripts, computes=computes)}">',
        f"<title>{html.escape(_encodable(title))}</title>",
        f"<style>\n{style}\n</style>\n</head>\n<body>\n{body}",
        *(
            f'<script type="application/json" id="{name}">{embedded(content)}</script>'
            for name, content in data.items()
        ),
        *(f'<script type="module">{text}</script>' for text in scripts),
        "</body>\n</html>\n",
    ]
    return "\n".join(pieces)


def policy(scripts: list[str], *, computes: bool = False) -> str:
    """Return the content security policy of a page: these scripts run, and nothing is loaded or sent.

    Styles are open: Vega sets its own where it draws, and a style can load nothing. A page that ``computes``
    compiles the WebAssembly inside it, which is no way to run text, and starts workers from itself.
    """
    allowed = " ".join(f"'sha256-{_digest(text)}'" for text in scripts)
    core = " 'wasm-unsafe-eval'; worker-src blob:" if computes else ""
    return (
        f"default-src 'none'; script-src {allowed}{core}; style-src 'unsafe-inline'; base-uri 'none'; "
        "form-action 'none'"
    )


def embedded(content: object) -> str:
    """Return JSON that no browser can take for markup."""
    text = json.dumps(content, ensure_ascii=True, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _encodable(text: str) -> str:
    """The text without halves of a pair of surrogates, which no file holds."""
    return text.encode(errors="replace").decode()


def _normal(script: str) -> str:
    """The script as a browser reads it, of which it takes the digest: with one kind of line end."""
    return script.replace("\r\n", "\n").replace("\r", "\n")


def _digest(script: str) -> str:
    return base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
