"""Whether results are kept, and in which folder. Loads nothing: every command imports it."""

from __future__ import annotations

import os
from pathlib import Path

#: Folder of the cache in the place of that of the system, or a word for none.
VARIABLE = "HERSEY_CACHE"
_NONE = frozenset({"", "0", "no", "none", "off"})

#: The folder, if results are kept.
_folder: list[Path] = []
#: How many warnings were printed.
_spoilt = [0]


def use_cache(wanted: bool) -> None:
    """Keep results from here on, and find those that were kept; or do neither."""
    found = _found() if wanted else None
    _folder[:] = [] if found is None else [found]


def cache_folder() -> Path | None:
    """Return the folder in which results are kept; None if none are."""
    return _folder[0] if _folder else None


def spoil() -> None:
    """Keep nothing that is being computed: it printed a warning, which a kept result would not print."""
    _spoilt[0] += 1


def spoilt() -> int:
    """Return how often `spoil` was called."""
    return _spoilt[0]


def _found() -> Path | None:
    """The folder that the environment states, or that of the system; None if there is none."""
    stated = os.environ.get(VARIABLE)
    if stated is not None:
        return None if stated.strip().lower() in _NONE else Path(stated).absolute()
    from platformdirs import user_cache_path

    try:
        folder = user_cache_path("hersey")
    except RuntimeError:  # nobody knows the home; older versions return a relative path
        return None
    return folder / "results" if folder.is_absolute() else None
