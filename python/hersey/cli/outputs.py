"""Files that a command writes: refused early, never replaced unasked."""

from __future__ import annotations

import json
import os
import shlex
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from hersey.charts import PICTURES
from hersey.cli.progress import working
from hersey.cli.terminal import say
from hersey.errors import ExistingFileError, OutputError, printable

if TYPE_CHECKING:
    from pydantic import BaseModel

    from hersey.stability.plan import Plan
    from hersey.stability.warm_up_result import WarmUp

#: Kinds of file that a page is.
PAGES = (".html", ".htm")
#: Exit code where what was sought does not exist.
NOT_FOUND = 1


def command() -> str:
    """Return the command as the user could type it again."""
    return " ".join(["hersey", *(shlex.quote(part) for part in sys.argv[1:])])


def print_json(name: str, result: object) -> None:
    """Print what a command of that name found: its part of the document, with versions and command."""
    from hersey import _core
    from hersey.document.printed import PRINTED
    from hersey.schema.part import SCHEMA_VERSION
    from hersey.schema.record import part_of

    part = part_of(PRINTED[name]).model_validate(result)
    header = {"schema_version": SCHEMA_VERSION, "hersey_version": _core.VERSION, "command": command()}
    print(json.dumps(header | part.model_dump(mode="json"), indent=1, allow_nan=False))


def print_document(document: BaseModel) -> None:
    """Print a whole document, every sign beyond ASCII as its code."""
    print(json.dumps(document.model_dump(mode="json"), indent=1, allow_nan=False))


def may_write(
    path: Path, force: bool, inputs: Sequence[Path] = (), *, flag: str = "--out", ends: Sequence[str] = ()
) -> bool:
    """Refuse early what cannot be written, and ask before replacing anything.

    ``ends`` are the kinds of file that can be written, any if there are none. Return whether a file of that
    name may be replaced at the end: one that appears meanwhile may not, unless --force says so.
    """
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
    if ends and path.suffix not in ends:
        raise OutputError(f"{flag} {path}: name a file that ends in {_either(ends)}")
    if exists and not force:
        asked = sys.stdin.isatty() and typer.confirm(printable(f"{path} exists. Replace it?"), err=True)
        if not asked:
            raise ExistingFileError(f"{path} exists: use --force to replace it, or name another file")
    return force or exists


def _either(ends: Sequence[str]) -> str:
    *first, last = ends
    return f"{', '.join(first)} or {last}" if first else last


def may_write_folder(folder: Path, force: bool, flag: str = "--figures") -> None:
    """Refuse early a folder that cannot take the figures, or that holds something."""
    try:
        if folder.exists() and not folder.is_dir():
            raise OutputError(f"{folder} is a file: {flag} needs a directory")
        if folder.is_dir() and any(map(_counts, folder.iterdir())) and not force:
            raise OutputError(f"{folder} is not empty: use --force to write into it")
        if not folder.parent.is_dir():
            raise OutputError(f"{folder}: there is no directory {folder.parent}")
    except OSError as error:
        if isinstance(error, OutputError):
            raise
        raise OutputError(f"{folder} cannot be written: {error.strerror}") from None


def _counts(file: Path) -> bool:
    """Whether a file is more than what a command that was killed left of its own."""
    from hersey.files.writing import SUFFIX

    return not (file.name.startswith(".") and file.suffix == SUFFIX)


def may_draw(
    path: Path,
    force: bool,
    inputs: Sequence[Path] = (),
    *,
    flag: str = "--figure",
) -> bool:
    """Refuse early a figure of an unknown kind, or one that cannot be written; return as `may_write`."""
    return may_write(path, force, inputs, flag=flag, ends=PICTURES)


def may_write_table_and_figure(
    table: Path | None, figure: Path | None, force: bool, inputs: Sequence[Path]
) -> dict[Path, bool]:
    """Refuse early what ``--out`` and ``--figure`` name, if it cannot be written; return as `may_write`."""
    if table is not None and figure is not None and table.absolute() == figure.absolute():
        raise OutputError(f"--out and --figure both name {table}: name two files")
    replace = {}
    if figure is not None:
        replace[figure] = may_draw(figure, force, inputs)
    if table is not None:
        replace[table] = may_write(table, force, inputs, ends=[".csv"])
    return replace


def give(
    name: str,
    result: Plan | WarmUp,
    *,
    called: str,
    table: Path | None,
    figure: Path | None,
    replace: Mapping[Path, bool],
    as_json: bool,
    **chart: Any,
) -> None:
    """Write table and figure of a course that a command has found, and print the result.

    ``called`` is what the command calls its table, ``replace`` what `may_write_table_and_figure` returned,
    ``chart`` what else the chart takes. Where nothing was
    found nothing is written, and the command ends with `NOT_FOUND`.
    """
    from hersey.files.writing import write_atomically

    if result.found and figure is not None:
        from hersey.charts import chart_of
        from hersey.charts.render import picture

        with working("drawing"):
            content = picture(chart_of(result, **chart), figure.suffix)
        write_atomically(figure, content, overwrite=replace[figure])
    if result.found and table is not None:
        write_atomically(table, result.table(), overwrite=replace[table])
    if as_json:
        print_json(name, result.to_dict())
    else:
        say(result.summary())
        for what, written in ((called, table), ("figure", figure)):
            if result.found and written is not None:
                say(f"{what}: {written}")
    if not result.found:
        raise typer.Exit(NOT_FOUND)
