"""Files that a command writes: refused early, never replaced without being asked."""

from __future__ import annotations

import json
import os
import shlex
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from hersey.charts import PICTURES
from hersey.cli.progress import working
from hersey.errors import ExistingFileError, OutputError, printable
from hersey.files.writing import refuse_without_folder

if TYPE_CHECKING:
    from pydantic import BaseModel

    from hersey.result import Result

#: Kinds of file that a page is.
PAGES = (".html", ".htm")
#: Exit code where what was asked for does not exist, or could not be done for every log.
NOT_FOUND = 1


def command() -> str:
    """Return the command as the user can type it again."""
    return " ".join(["hersey", *(shlex.quote(part) for part in sys.argv[1:])])


def print_json(result: Any, **beside: Any) -> None:
    """Print a result as JSON, with versions and command.

    ``beside`` are further fields.
    """
    from hersey import _core
    from hersey.result import json_record, json_value
    from hersey.schema.part import SCHEMA_VERSION

    header = {"schema_version": SCHEMA_VERSION, "hersey_version": _core.VERSION, "command": command()}
    print(json.dumps(header | json_value(result) | json_record(beside), indent=1, allow_nan=False))


def print_document(document: BaseModel) -> None:
    """Print a whole document in ASCII."""
    print(json.dumps(document.model_dump(mode="json"), indent=1, allow_nan=False))


@dataclass(frozen=True)
class Output:
    """A file that a command may write; without a path nothing is written."""

    path: Path | None
    replace: bool = False

    def write(self, content: str | bytes) -> None:
        """Write the whole file or nothing."""
        if self.path is not None:
            from hersey.files.writing import write_atomically

            write_atomically(self.path, content, overwrite=self.replace)

    def draw(self, result: Result, doing: str = "drawing", **chart: Any) -> None:
        """Write the chart of a result; ``chart`` are further arguments of the chart."""
        if self.path is not None:
            from hersey.charts import chart_of
            from hersey.charts.render import picture

            with working(doing):
                content = picture(chart_of(result, **chart), self.path.suffix)
            self.write(content)


def may_write(
    path: Path | None,
    force: bool,
    inputs: Sequence[Path] = (),
    *,
    flag: str = "--out",
    ends: Sequence[str] = (),
) -> Output:
    """Refuse a file that cannot be written, and ask before replacing one.

    ``ends`` are the endings of files that can be written; empty for any. A file that appears while the
    command works is not replaced without --force.
    """
    if path is None:
        return Output(None)
    with _said_why(path):
        exists = os.path.lexists(path)
        if path.is_dir():
            raise OutputError(f"{path} is a directory: name a file in it")
        refuse_without_folder(path)
        if exists and (path.is_symlink() or not path.is_file()):
            raise OutputError(f"{path} is not an ordinary file: name another")
        if any(exists and other.exists() and path.samefile(other) for other in inputs):
            raise OutputError(f"{path} is an input: name another file for the output")
    if ends and path.suffix not in ends:
        raise OutputError(f"{flag} {path}: name a file that ends in {_either(ends)}")
    if exists and not force:
        asked = sys.stdin.isatty() and typer.confirm(printable(f"{path} exists. Replace it?"), err=True)
        if not asked:
            raise ExistingFileError(f"{path} exists: use --force to replace it, or name another file")
    return Output(path, force or exists)


def _either(ends: Sequence[str]) -> str:
    *first, last = ends
    return f"{', '.join(first)} or {last}" if first else last


@contextmanager
def _said_why(path: Path) -> Iterator[None]:
    """Begin an error of the system with the path."""
    try:
        yield
    except OSError as error:
        if isinstance(error, OutputError):
            raise
        raise OutputError(f"{path} cannot be written: {error.strerror}") from None


def may_write_folder(folder: Path | None, force: bool, flag: str = "--figures") -> None:
    """Refuse a folder that cannot be written, or that is not empty."""
    if folder is None:
        return
    with _said_why(folder):
        if folder.exists() and not folder.is_dir():
            raise OutputError(f"{folder} is a file: {flag} needs a directory")
        if folder.is_dir() and any(map(_counts, folder.iterdir())) and not force:
            raise OutputError(f"{folder} is not empty: use --force to write into it")
        refuse_without_folder(folder)


def _counts(file: Path) -> bool:
    """Whether a file is not just the unfinished file of a command that was killed."""
    from hersey.files.writing import SUFFIX

    return not (file.name.startswith(".") and file.suffix == SUFFIX)


def may_draw(
    path: Path | None, force: bool, inputs: Sequence[Path] = (), *, flag: str = "--figure"
) -> Output:
    """Refuse a figure of an unknown kind, or one that cannot be written."""
    return may_write(path, force, inputs, flag=flag, ends=PICTURES)


def may_save_recipe(path: Path | None, force: bool, inputs: Sequence[Path]) -> Output:
    """Refuse a recipe that cannot be written."""
    return may_write(path, force, inputs, flag="--save-recipe", ends=[".toml"])


def may_write_table_and_figure(
    table: Path | None, figure: Path | None, force: bool, inputs: Sequence[Path]
) -> tuple[Output, Output]:
    """Refuse the files of ``--out`` and ``--figure`` if they cannot be written."""
    if table is not None and figure is not None and table.absolute() == figure.absolute():
        raise OutputError(f"--out and --figure both name {table}: name two different files")
    drawing = may_draw(figure, force, inputs)
    return may_write(table, force, inputs, ends=[".csv"]), drawing
