"""What ``--hersey`` states: a viscosity, or a file with a lubricant."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from hersey.cli.quantities import amount_of

if TYPE_CHECKING:
    from hersey.lubrication.lubricant import Lubricant

_AMOUNT = re.compile(r"\s*[-+.\d]")


def viscosity_of(text: str) -> Lubricant | float:
    """Return the lubricant of a file, or a viscosity, Pa s.

    Raises
    ------
    HerseyError
        If the file is not there or has no lubricant, or the amount no unit of viscosity.
    """
    path = Path(text)
    if not path.is_file() and _AMOUNT.match(text):
        return amount_of("viscosity", text, "--hersey")
    from hersey.machine.lubricant_file import read_lubricant

    return read_lubricant(path)
