"""Files that names and patterns stand for, where no shell has put them in their place."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterable
from pathlib import Path

from hersey.errors import MissingFileError, ParameterError
from hersey.files.reading import missing


def files_of(patterns: str | Path | Iterable[str | Path]) -> list[Path]:
    """Return the files that names and patterns (``logs/*.csv``, ``**/*.csv``) stand for, each once.

    They come in the order in which they are named, those of a pattern sorted; of links in a pattern that lead
    to one file the first is taken, and one that leads nowhere stands for itself, to be told where it is read.
    The name of a file that is there is no pattern, whatever its signs; a plain name stands for itself, be the
    file there or not.

    Raises
    ------
    MissingFileError
        If a pattern matches no file.
    ParameterError
        If a file is named twice.
    """
    named = patterns if isinstance(patterns, Iterable) and not isinstance(patterns, str) else [patterns]
    found = [path for each in named for path in _matched(each)]
    seen: set[str] = set()
    for path in found:
        real = os.path.realpath(path)
        if real in seen:
            raise ParameterError(f"{path} is given twice. Give each file once")
        seen.add(real)
    return found


def _matched(name: str | Path) -> list[Path]:
    if not isinstance(name, str | os.PathLike):
        raise ParameterError(f"a {type(name).__name__} is not a log file. Give the path of the file")
    text = os.fspath(name)
    if "\0" in text:
        raise MissingFileError(f"File not found: {text}")
    if not glob.has_magic(text) or os.path.lexists(text):
        return [Path(name)]
    once: dict[str, str] = {}
    for path in sorted(glob.glob(text, recursive=True)):  # noqa: PTH207 - a Path sorts by its parts
        if os.path.isfile(path) or not os.path.exists(path):  # noqa: PTH110,PTH113 - as above
            once.setdefault(os.path.realpath(path), path)
    files = list(once.values())
    if not files:
        slashed = text.replace("\\", "/")
        found = slashed != text and bool(glob.glob(slashed, recursive=True))  # noqa: PTH207 - as above
        remedy = (
            f"write / between folders: '{slashed}'" if found else "check the folder and the file extension"
        )
        raise missing(text, "no file matches {}", remedy)
    return [Path(path) for path in files]
