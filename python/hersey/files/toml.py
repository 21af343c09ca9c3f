"""Opening a TOML file, with errors that a person can act on."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from hersey.errors import ParameterError
from hersey.files.text import read_text


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
        return tomllib.loads(read_text(path))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise ParameterError(f"{path.name} is not valid TOML: {error}") from None
