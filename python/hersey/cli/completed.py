"""The options that ``hersey export fmu`` cannot do without, for a line that is proposed."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from hersey.errors import HerseyError

#: Temperature of the examples.
_EXAMPLE = "180 degC"


def completed(words: Sequence[str]) -> list[str]:
    """Return the words behind ``hersey export fmu``, the fit first, with the options that are required."""
    typed = list(words)
    at = next((i for i, word in enumerate(typed) if word == "--out" or word.startswith("--out=")), -1)
    if at < 0:
        typed += ["--out", "drive.fmu"]
    elif typed[at] != "--out":
        typed[at] = f"--out={Path(typed[at].removeprefix('--out=')).with_suffix('.fmu')}"
    elif at + 1 < len(typed):
        typed[at + 1] = str(Path(typed[at + 1]).with_suffix(".fmu"))
    files = [word for word in typed if Path(word).suffix.lower() in (".json", ".toml")]
    if [Path(word).suffix.lower() for word in files] == [".toml", ".json"]:
        first, second = map(typed.index, files)
        typed[first], typed[second] = files[::-1]
    if not any(word.partition("=")[0] == "--temperature" for word in typed) and (warm := _warm(files)):
        typed += ["--temperature", warm]
    return typed


def _warm(files: Sequence[str]) -> str:
    """A temperature of the fit among these files, none if it is isothermal; else that of the examples."""
    from hersey.document.saved_fit import read_fit
    from hersey.units import celsius

    for file in files:
        if Path(file).suffix.lower() == ".json":
            with suppress(HerseyError):
                known = read_fit(Path(file)).temperature_range
                return "" if known is None else f"{celsius(known[1]):.0f} degC"
    return _EXAMPLE
