"""Writing a file whole or not at all."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from hersey.errors import OutputError

#: End of the name of a file that is not whole yet.
SUFFIX = ".part"
#: Bytes of the name that it shall get in its own, which has a few more.
_NAME_BYTES = 200


def write_atomically(path: Path, content: str | bytes, *, overwrite: bool) -> None:
    """Write a file whole or not at all; never over an existing one unless told to.

    Raises
    ------
    OutputError
        If the file exists and ``overwrite`` is false, or it cannot be written.
    """
    if path.is_dir():
        raise OutputError(f"{path} is a directory: name a file in it")
    if path.exists() and not overwrite:
        raise OutputError(f"{path} exists: say --force to replace it, or name another file with --out")
    try:
        handle, temporary = temporary_beside(path)
    except OSError as error:
        raise OutputError(f"{path} cannot be written: {error.strerror}") from None
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content.encode("utf-8") if isinstance(content, str) else content)
        Path(temporary).chmod(0o666 & ~_umask())
        Path(temporary).replace(path)
    except BaseException as error:
        Path(temporary).unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise OutputError(f"{path} cannot be written: {error.strerror}") from None
        raise


def temporary_beside(path: Path) -> tuple[int, str]:
    """Open a new file beside another, called after it, for what shall replace it once it is whole.

    What a process that was killed leaves is never opened again. A name has 255 bytes at the most, so the last
    characters of a long one are left out.
    """
    name = os.fsencode(path.name)[:_NAME_BYTES].decode(errors="ignore")
    return tempfile.mkstemp(dir=path.parent, prefix=f".{name}.", suffix=SUFFIX)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
