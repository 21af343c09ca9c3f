"""The examples of the package, copied into a new folder: ``hersey examples``."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Annotated

from hersey.cli.groups import argument
from hersey.cli.mistyped import retyped
from hersey.cli.terminal import say
from hersey.errors import OutputError

#: Endings of archives, which this command does not write.
_ARCHIVES = (".zip", ".tar", ".gz", ".tgz", ".7z")


def examples(folder: Annotated[Path, argument("FOLDER", "Folder to create; it must not exist yet.")]) -> None:
    """Copy the shipped examples into a new folder: logs, a machine file, a life test.

    Example: [bold]hersey examples try-hersey[/bold]
    """
    if folder.suffix.lower() in _ARCHIVES:
        line = retyped("examples", str(folder.with_suffix("")))
        raise OutputError(
            f"{folder} names an archive, but the examples are copied into a folder. Type: {line}"
        )

    from hersey.files.shipped import copy_examples

    written = copy_examples(folder)
    log, machine = str(folder / "bench.csv"), str(folder / "machine.toml")
    say(f"{len(written)} files are in {folder}.")
    say(f"Next: {shlex.join(['hersey', 'report', log, '--machine', machine, '--tare', 'standing'])}")
