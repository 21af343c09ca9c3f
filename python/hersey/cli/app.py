"""Without a command line: ``hersey app``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from hersey.cli.terminal import say


def app_(
    port: Annotated[int, typer.Option("--port", help="Port on 127.0.0.1.  [default: one that is free]")] = 0,
    reports: Annotated[
        Path | None,
        typer.Option("--reports", metavar="DIR", help="Where reports are kept.  [default: hersey-reports]"),
    ] = None,
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Print the address and open nothing.")
    ] = False,
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
