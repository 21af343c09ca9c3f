"""The app in the browser: ``hersey app``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

from hersey.cli.groups import option
from hersey.cli.terminal import say
from hersey.errors import OutputError

_PORT = "Port on 127.0.0.1.  [default: any free port]"
_NO_BROWSER = "Print the address without opening a browser."
_REPORTS = "Folder for finished reports.  [default: hersey-reports]"


def app_(
    port: Annotated[int, option(_PORT)] = 0,
    reports: Annotated[Path | None, option(_REPORTS, metavar="DIR")] = None,
    no_browser: Annotated[bool, option(_NO_BROWSER, "--no-browser")] = False,
) -> None:
    """Open the app in the browser: choose logs, describe the machine, read the report.

    Example: [bold]hersey app[/bold]

    Only this computer can reach the app, and no data leaves the computer. Stop it with Ctrl-C.
    """
    kept = reports or Path("hersey-reports")
    if kept.exists() and not kept.is_dir():
        raise OutputError(f"{kept} is a file, but reports are saved in a folder: name one with --reports")

    from hersey.app.starting import serve

    def said(address: str) -> None:
        say(f"hersey app: {address}", f"Reports are saved in {kept}. Stop with Ctrl-C.")
        sys.stdout.flush()

    serve(port=port, reports=kept.absolute(), browser=not no_browser, said=said)
