"""Machine files in a folder, files that they name, and what to do where one is missing."""

from __future__ import annotations

import shlex
from contextlib import suppress
from itertools import islice
from pathlib import Path, PureWindowsPath

from hersey.errors import HerseyError, MissingFileError, meant, printable, way_in
from hersey.files.endings import could_stand_for
from hersey.files.reading import missing, slashed
from hersey.files.text import read_text
from hersey.files.toml import read_toml
from hersey.files.toml_lines import as_written

#: Name that ``hersey new`` gives a machine file.
WRITTEN = "machine.toml"
#: Files of a folder that are looked into at most.
_MOST = 50
#: Table that every machine file has, and no other file.
_OWN = "drivetrain"


def machine_files(folder: Path) -> list[str]:
    """Return the names of the machine files in a folder, sorted."""
    found = []
    with suppress(OSError, ValueError):  # a name that no folder can have
        for path in islice(sorted(folder.glob("*.toml")), _MOST):
            with suppress(HerseyError):
                if _OWN in read_toml(path):
                    found.append(path.name)
    return found


def refuse_missing(path: Path) -> None:
    """Refuse a machine file that does not exist, with the machine file that was meant or how to write one.

    Raises
    ------
    MissingFileError
        If there is nothing at the path.
    """
    if path.exists() or slashed(path):  # which is refused where it is opened
        return
    there = machine_files(path.parent)
    near = meant(path.name, there) or (there[0] if len(there) == 1 else "")
    remedy = f"did you mean '{printable(str(path.with_name(near)))}'?" if near else _write(path)
    raise missing(str(path), "File not found: {}", remedy)


def _write(path: Path) -> str:
    """How to write a machine file at this path."""
    if way_in() == "page":
        return "describe the machine in the app"
    own = [] if path == Path(WRITTEN) or path.suffix != ".toml" else ["--machine", printable(str(path))]
    where = "" if way_in() == "terminal" else " in a terminal"
    return f"to write one, type{where}: {shlex.join(['hersey', 'new', 'LOG', *own])}"


def named_log(path: Path, table: str, key: str, name: str) -> Path:
    """Return the log that a key of a machine file names, by its path from the folder of that file.

    Raises
    ------
    MissingFileError
        If there is no such file; it quotes the line, and shows it corrected.
    """
    log = path.parent / name
    if log.is_file():
        return log
    line, written = as_written(read_text(path), (table, key))
    alone = PureWindowsPath(name).name  # whose folders may be parted by either slash
    there = sorted(each.name for each in path.parent.glob("*") if each.is_file())
    stems = {Path(each).stem: each for each in there if could_stand_for(each, alone)}
    near = alone if alone in there else stems.get(meant(Path(alone).stem, stems), "")
    copied = f"copy {alone} into the folder of {path.name}"
    if near:
        remedy = f'write: {key} = "{near}"' if near == alone else f'did you mean {key} = "{near}"?'
    else:
        remedy = copied if alone == name else f'{copied} and write: {key} = "{alone}"'
    raise MissingFileError(
        f"{path.name}, line {line}: [{table}] {written or key} names a file that does not exist",
        remedy=remedy,
    )
