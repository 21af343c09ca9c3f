"""Opening a text file that a command was given, with errors that a person can act on."""

from __future__ import annotations

from pathlib import Path

from hersey.errors import MissingFileError


def read_text(path: Path) -> str:
    """Return the text, UTF-8, with or without its mark.

    Raises
    ------
    MissingFileError
        If there is no such file, it is no ordinary one, or it cannot be read.
    UnicodeDecodeError
        If it is not UTF-8: what that means is for the caller to say.
    """
    try:
        if path.exists() and not path.is_file():
            raise MissingFileError(f"{path} is no ordinary file")
        return path.read_text(encoding="utf-8-sig")
    except MissingFileError:
        raise
    except FileNotFoundError:
        raise MissingFileError(f"{path}: there is no such file") from None
    except OSError as error:
        raise MissingFileError(f"{path} cannot be read: {error.strerror}") from None
