"""The one way from a command to a terminal: names in a log may hold what would steer it."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TextIO

from hersey.spelling import printable


def say(*lines: str, file: TextIO | None = None) -> None:
    """Print lines for people, on stdout unless told; what is no visible character stands as its code."""
    stream = file or sys.stdout
    encoding = getattr(stream, "encoding", None) or "utf-8"
    text = printable("\n".join(lines), lines=True)
    print(text.encode(encoding, errors="replace").decode(encoding), file=stream)


@contextmanager
def warnings_said() -> Iterator[None]:
    """Let warnings come in the same way."""
    usual = warnings.formatwarning

    def formatted(*about: Any, **more: Any) -> str:
        return printable(usual(*about, **more), lines=True)

    warnings.formatwarning = formatted
    try:
        yield
    finally:
        warnings.formatwarning = usual
