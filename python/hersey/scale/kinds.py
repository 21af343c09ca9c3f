"""The kinds of folder, by the end of the name."""

from __future__ import annotations

from pathlib import Path

from hersey.errors import OutputError
from hersey.scale.store import Kind


def kind_of(path: Path) -> Kind:
    """Return what writes a folder by the end of its name.

    Raises
    ------
    OutputError
        If it is neither .zarr nor .parquet.
    MissingFileError
        If what it needs is not installed.
    """
    if path.suffix == ".zarr":
        from hersey.scale.zarr_folder import ZarrKind

        return ZarrKind()
    if path.suffix == ".parquet":
        from hersey.scale.parquet_folder import ParquetKind

        return ParquetKind()
    raise OutputError(f"{path}: the name of the folder must end in .zarr or .parquet")
