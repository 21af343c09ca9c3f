"""Without a command line: ``hersey app``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

from hersey.cli.groups import option
from hersey.cli.terminal import say

_REPORTS = "Where reports are kept.  [default: hersey-reports]"


def app_(
    port: Annotated[int, option("Port on 127.0.0.1.  [default: one that is free]")] = 0,
    reports: Annotated[Path | None, option(_REPORTS, metavar="DIR")] = None,
    no_browser: Annotated[bool, option("Print the address and open nothing.", "--no-browser")] = False,
) -> None:
    """Open a page on this computer: drop logs, choose channels, describe the machine, read the report.

    Example: [bold]hersey app[/bold]

    Only this computer can reach it, and nothing leaves it. Ctrl-C ends it.
    """
    from hersey.app.starting import serve

    kept = reports or Path("hersey-reports")

    def said(address: str) -> None:
        say(f"hersey app: {address}", f"reports are kept in {kept}; Ctrl-C ends it")
        sys.stdout.flush()

    serve(port=port, reports=kept.absolute(), browser=not no_browser, said=said)
