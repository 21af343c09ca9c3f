"""Opening a TOML file, with errors that a person can act on."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from hersey.errors import MissingFileError, ParameterError


def read_toml(path: str | Path) -> dict[str, Any]:
    """Return the document.

    Raises
    ------
    MissingFileError
        If there is no such file, or it cannot be read.
    ParameterError
        If it is not TOML.
    """
    path = Path(path)
    try:
        if path.exists() and not path.is_file():
            raise MissingFileError(f"{path} is no ordinary file")
        return tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except MissingFileError:
        raise
    except FileNotFoundError:
        raise MissingFileError(f"{path}: there is no such file") from None
    except OSError as error:
        raise MissingFileError(f"{path} cannot be read: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise ParameterError(f"{path.name} is not valid TOML: {error}") from None
