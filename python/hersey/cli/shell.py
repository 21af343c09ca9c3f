"""What every command stands in: the application, errors in one line, progress, and files kept safe."""

from __future__ import annotations

import os
import shlex
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import (
    BarColumn,
    DownloadColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeRemainingColumn,
)

from hersey import __version__
from hersey.errors import HerseyError, OutputError

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
    help=(
        "From a torque log to the lubrication state of a sliding drive.\n\n"
        "Example: [bold]hersey report examples/bench.csv[/bold]"
    ),
)


stderr = Console(stderr=True)


#: Exit code after Ctrl-C, as shells have it.
INTERRUPTED = 130


def main() -> None:
    """Run the command line."""
    signal.signal(signal.SIGTERM, _interrupt)
    code: int | None = None
    try:
        code = app(standalone_mode=False)
    except HerseyError as error:
        _fail(str(error))
    except (KeyboardInterrupt, typer.Abort):
        code = INTERRUPTED
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # nothing is left to flush into it
        sys.exit(0)
    except OSError as error:
        _fail(f"cannot write the result: {error.strerror}")
    except Exception as error:
        usage = getattr(error, "format_message", None)  # click's own errors know how to say it
        if usage is None:
            raise
        _fail(usage())
    if code == INTERRUPTED:
        _fail("interrupted", code=INTERRUPTED)
    sys.exit(code or 0)


def _fail(message: str, code: int = 2) -> None:
    shown = "".join(c if c.isprintable() else "?" for c in " ".join(message.split()))
    if shown:
        print(f"hersey: {shown}", file=sys.stderr)
    sys.exit(code)


def _interrupt(_signal: int, _frame: object) -> None:
    raise KeyboardInterrupt


@app.callback(invoke_without_command=True)
def _root(version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False) -> None:
    if version:
        print(f"hersey {__version__}")
        raise typer.Exit


def command() -> str:
    """Return the command as the user could type it again."""
    return " ".join(["hersey", *(shlex.quote(part) for part in sys.argv[1:])])


def may_write(path: Path, force: bool, inputs: Sequence[Path] = ()) -> None:
    """Refuse early what cannot be written, and ask before replacing anything."""
    try:
        exists = os.path.lexists(path)
        if path.is_dir():
            raise OutputError(f"{path} is a directory: name a file in it")
        if not path.parent.is_dir():
            raise OutputError(f"{path}: there is no directory {path.parent}")
        if exists and (path.is_symlink() or not path.is_file()):
            raise OutputError(f"{path} is no ordinary file: name another")
        if any(exists and other.exists() and path.samefile(other) for other in inputs):
            raise OutputError(f"{path} is an input: name another file for the output")
    except OSError as error:
        if isinstance(error, OutputError):
            raise
        raise OutputError(f"{path} cannot be written: {error.strerror}") from None
    if exists and not force:
        asked = sys.stdin.isatty() and typer.confirm(f"{path} exists. Replace it?", err=True)
        if not asked:
            raise OutputError(f"{path} exists: say --force to replace it, or name another file")


def may_write_folder(folder: Path, force: bool, flag: str = "--figures") -> None:
    """Refuse early a folder that cannot take the figures, or that holds something."""
    try:
        if folder.exists() and not folder.is_dir():
            raise OutputError(f"{folder} is a file: {flag} needs a directory")
        if folder.is_dir() and any(folder.iterdir()) and not force:
            raise OutputError(f"{folder} is not empty: say --force to write the figures into it")
        if not folder.parent.is_dir():
            raise OutputError(f"{folder}: there is no directory {folder.parent}")
    except OSError as error:
        if isinstance(error, OutputError):
            raise
        raise OutputError(f"{folder} cannot be written: {error.strerror}") from None


@contextmanager
def working(what: str) -> Iterator[None]:
    """A spinner on a terminal, nothing elsewhere."""
    if stderr.is_terminal:
        with stderr.status(what):
            yield
    else:
        yield


@contextmanager
def bar(what: str, unit: str = "") -> Iterator[Callable[[int, int], None]]:
    """A progress bar on a terminal, nothing elsewhere; counts bytes unless there is a unit."""
    amount = MofNCompleteColumn() if unit else DownloadColumn()
    columns = (TextColumn(what), BarColumn(), amount, TextColumn(unit), TimeRemainingColumn())
    with Progress(*columns, console=stderr, transient=True, disable=not stderr.is_terminal) as progress:
        task = progress.add_task(what, total=None)
        yield lambda done, total: progress.update(task, completed=done, total=total)
