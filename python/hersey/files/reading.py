"""Reading a file that another program may be writing: it is opened once, and compared at the end.

Size, times and place tell a change. Where a file has grown, or is so young that its times could hide one, its
first bytes are hashed once more: that tells a logger which appends from a program that writes anew.
"""

from __future__ import annotations

import glob
import os
import time
import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

from hersey.errors import HerseyError, MissingFileError, UnreadableLogError, meant, printable, way_in
from hersey.files.endings import LOGS, could_stand_for

if TYPE_CHECKING:
    from hersey.schema.warning import Warning

#: Escapes of Python that a path with backslashes can hold by mistake.
_ESCAPES = {"\a": r"\a", "\b": r"\b", "\f": r"\f", "\n": r"\n", "\r": r"\r", "\t": r"\t", "\v": r"\v"}
_WAY_OUT = "Wait until the logger has closed it, or copy it first"
_CHUNK = 1 << 20
#: Coarsest step of the times that a file system keeps, ns.
_STEP = 2_000_000_000


class OpenFile:
    """A file open for reading, ``size`` bytes long when it was opened."""

    def __init__(self, path: Path, file: BinaryIO) -> None:
        """Note what the file is now."""
        self.path, self.file = path, file
        self._before, self._opened = os.fstat(file.fileno()), time.time_ns()
        self.size = self._before.st_size

    def change(self) -> str:
        """Return in words what became of the file since it was opened; empty if nothing did."""
        before, now = self._before, os.fstat(self.file.fileno())
        if now.st_size != before.st_size:
            what = "grew" if now.st_size > before.st_size else "shrank"
            return f"it {what} from {before.st_size} to {now.st_size} bytes"
        if (now.st_mtime_ns, now.st_ctime_ns) != (before.st_mtime_ns, before.st_ctime_ns):
            return "it was written to"
        return "" if self._is_there() else "it was moved, deleted or replaced"

    def refuse_change(self) -> None:
        """Raise if the file is no longer what it was when it was opened.

        Raises
        ------
        UnreadableLogError
            It names the file, the change and the way out.
        """
        if change := self.change():
            raise self._changed(change)

    def refuse_loss(self) -> None:
        """Raise if the file is no longer what it was, unless it has only grown.

        Raises
        ------
        UnreadableLogError
            It names the file, the change and the way out.
        """
        if not self._has_grown():
            self.refuse_change()

    def refuse_other_bytes(self, sha256: str) -> None:
        """Raise if its first ``size`` bytes no longer have this hash.

        Times do not tell it all: what is written through a map of memory may move none.

        Raises
        ------
        UnreadableLogError
            It names the file and the way out.
        """
        if self.sha256() != sha256:
            raise self._changed("its content was replaced")

    def growth(self, sha256: str) -> list[Warning]:
        """Return a warning if a logger still appends to the file; ``sha256`` is that of the bytes read.

        Raises
        ------
        UnreadableLogError
            If its first ``size`` bytes, or the file behind the path, are no longer the same.
        """
        from hersey.schema.warning import Warning  # which loads all units

        self.refuse_loss()
        grown, now = self._has_grown(), os.fstat(self.file.fileno()).st_size
        if grown or self._is_young():
            self.refuse_other_bytes(sha256)
        if not grown:
            return []
        return [
            Warning(
                "file grew while it was read",
                "the file grew from {before} to {after} bytes while it was read; only the first "
                "{before} bytes were used",
                before=self.size,
                after=now,
            )
        ]

    def _changed(self, change: str) -> UnreadableLogError:
        return UnreadableLogError(f"{self.path.name} changed while it was read ({change}). {_WAY_OUT}")

    def _is_young(self) -> bool:
        """Whether a change right after the opening could bear the same time as the one before it."""
        return self._opened - self._before.st_mtime_ns < _STEP

    def _has_grown(self) -> bool:
        return os.fstat(self.file.fileno()).st_size > self.size and self._is_there()

    def _is_there(self) -> bool:
        """Whether the path still leads to this file."""
        try:
            return os.path.samestat(self.path.stat(), self._before)
        except OSError:
            return False

    def sha256(self) -> str:
        """Hash of the first ``size`` bytes as they are now."""
        import hashlib  # which loads OpenSSL

        digest, left = hashlib.sha256(), self.size
        self.file.seek(0)
        while left and (chunk := self.file.read(min(_CHUNK, left))):
            digest.update(chunk)
            left -= len(chunk)
        return digest.hexdigest()


def hash_of(path: Path) -> str:
    """Return the SHA-256 of a file.

    Raises
    ------
    MissingFileError
        As `open_file`.
    """
    with open_file(path) as file:
        return OpenFile(path, file).sha256()


@contextmanager
def open_file(path: Path) -> Iterator[BinaryIO]:
    """Open a file that a command was given, with errors that a person can act on.

    Raises
    ------
    MissingFileError
        If there is no such file, it is no ordinary one, or it cannot be read.
    """
    try:
        if path.exists() and not path.is_file():
            what = f"a folder. Name a file in it{_one_in(path)}" if path.is_dir() else "not a regular file"
            raise MissingFileError(f"{path} is {what}")
        try:
            file = path.open("rb")
        except ValueError:  # a name with a zero in it is no name
            raise FileNotFoundError from None
        with file:
            yield file
    except HerseyError:
        raise
    except FileNotFoundError:
        raise missing(str(path), "File not found: {}", _of_pattern(path) or _near(path)) from None
    except OSError as error:
        raise MissingFileError(f"{path} cannot be read: {error.strerror}") from None


def missing(path: str, words: str, remedy: str) -> MissingFileError:
    """Return the error about a path in words; its remedy differs if Python took signs of it as escapes."""
    written = "".join(_as_typed(char) for char in path)
    if written == path or way_in() != "python":
        return MissingFileError(words.format(path), remedy=remedy, path=path)
    found = " and ".join(dict.fromkeys(_as_typed(char) for char in path if _as_typed(char) != char))
    slashed = written.replace("\\", "/")
    why = f"Python reads {found} in a text as other characters"
    return MissingFileError(words.format(written), remedy=f'{why}. Write "{printable(slashed)}"')


def _as_typed(char: str) -> str:
    r"""A character of a path as it was typed; a control character was an escape, as ``\202`` of ``\2024``."""
    return _ESCAPES.get(char) or (f"\\{ord(char):o}" if unicodedata.category(char) == "Cc" else char)


def _of_pattern(path: Path) -> str:
    """How the files of a pattern are read in Python, where there are some."""
    pattern = str(path)
    if way_in() != "python" or not glob.has_magic(pattern) or not glob.glob(pattern):  # noqa: PTH207
        return ""
    return (
        f"read the files of a pattern as one log each by hersey.read_many({pattern!r}), or as one log by "
        f"hersey.read(sorted(glob.glob({pattern!r})))"
    )


def _near(path: Path) -> str:
    """The file beside a missing one that was probably meant, or nothing."""
    if found := slashed(path):
        return f"write / between folders: '{printable(found)}'"
    try:
        files = [each.name for each in path.parent.iterdir() if each.is_file()]
        near = meant(path.name, [name for name in files if could_stand_for(name, path.name)])
    except (OSError, ValueError):
        return ""
    return f"did you mean '{printable(str(path.with_name(near)))}'?" if near else ""


def slashed(path: Path) -> str:
    r"""Return the file meant by a name with ``\`` between folders, which a shell may have removed."""
    name = str(path)
    if "\\" in name:
        return written if os.path.isfile(written := name.replace("\\", "/")) else ""  # noqa: PTH113
    try:
        folders = [
            each for each in path.parent.iterdir() if path.name.startswith(each.name) and each.is_dir()
        ]
        inside = [each / path.name.removeprefix(each.name) for each in folders]
        return next((str(file) if file.is_file() else slashed(file) for file in inside), "")
    except (OSError, ValueError):
        return ""


def _one_in(folder: Path) -> str:
    """A file in a folder as an example: the first by name that could be a log, or nothing."""
    try:
        files = sorted(each for each in folder.iterdir() if each.is_file() and each.suffix.lower() in LOGS)
    except OSError:
        return ""
    return f", e.g. '{printable(str(files[0]))}'" if files else ""


@contextmanager
def open_once(path: str | Path) -> Iterator[OpenFile]:
    """Open a file; what became of it meanwhile is for the caller to ask.

    Raises
    ------
    MissingFileError
        If it is not there, or cannot be read.
    """
    path = Path(path)
    with open_file(path) as file:
        yield OpenFile(path, file)


@contextmanager
def appended(path: str | Path) -> Iterator[OpenFile]:
    """Open once a file to which a logger may append; ask its `growth` when it is read.

    What fails because it changed in any other way is reported as that change.

    Raises
    ------
    MissingFileError
        If it is not there, or cannot be read.
    UnreadableLogError
        If reading fails and the file shrank, was written to, moved or replaced.
    """
    with open_once(path) as opened:
        try:
            yield opened
        except Exception:
            opened.refuse_loss()
            raise


@contextmanager
def unchanged(path: str | Path) -> Iterator[OpenFile]:
    """Open a file once, and refuse it at the end if it changed.

    What fails because it changed meanwhile is reported as that change.

    Raises
    ------
    MissingFileError
        If it is not there, or cannot be read.
    UnreadableLogError
        If it grew, shrank, was written to, moved or replaced.
    """
    with open_once(path) as opened:
        try:
            yield opened
        except Exception:
            opened.refuse_change()
            raise
        opened.refuse_change()
