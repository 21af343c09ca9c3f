"""A drag curve from a CSV: speeds of the belt and forces, with units in their heads."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from hersey.cli.columns import read_columns
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.motion.drag import DragTable

_COLUMNS = {"speed": ("belt speed", "speed (mm/s)"), "force": ("force", "force (N)")}


def read_drag_table(file: Path, **beside: Any) -> DragTable:
    """Return the drag through the points of a CSV; ``beside`` is what `DragTable` takes beside them.

    Raises
    ------
    ParameterError
        If a column is missing or has no unit, a row no two numbers, or the points are no drag curve.
    """
    from hersey.motion.drag import DragTable

    speeds, forces = read_columns(file, _COLUMNS)
    try:
        return DragTable(speeds, forces, **beside)
    except ParameterError as error:
        raise ParameterError(f"{file.name}: {error}") from None
