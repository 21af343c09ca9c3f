"""A Zarr store (v3), one array per quantity, one file per chunk of each.

The library makes the store and reads it. A chunk of an array is a file that a task writes by itself, as the
specification has it (C order, little end first, then Blosc): by way of the library it takes ten times as
long. ``status`` has one element per chunk, 1 where it is finished: of a chunk that holds nothing but the fill
value one could not tell whether it was ever written.
"""

from __future__ import annotations

import json
import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from hersey.errors import MissingFileError, OutputError
from hersey.scale.cutting import Cut
from hersey.scale.store import Columns, Layout, Note, Scenario, Variable, write_file

#: Compression of values: bytes of one weight together, then LZ4 (a tenth of a millisecond per 1,000 sets).
_NAME: Literal["lz4"] = "lz4"
_LEVEL = 1
#: Where what is told of each chunk lies, in the folder of `status`: no part of the store.
_NOTES = "notes"


class ZarrKind:
    """Makes and opens such stores."""

    manifest = "zarr.json"
    lock = "status/.lock"

    def __init__(self) -> None:
        """Refuse where the library is not installed."""
        try:
            import zarr  # noqa: F401 - whether it is there
        except ImportError:
            raise MissingFileError(
                "a .zarr needs Zarr, which is not installed: pip install 'hersey[scale]', or name a .parquet"
            ) from None

    def create(self, path: Path, layout: Layout, manifest: Scenario) -> None:
        """Make a store without values."""
        import warnings

        import zarr
        from zarr.codecs import BloscCodec

        named = " ".join(name for name, each in layout.coordinates.items() if each.axes != (name,))
        about = {**layout.attributes, "hersey": manifest, "coordinates": named}
        group = zarr.create_group(path, zarr_format=3, attributes=about)
        for name, each in layout.coordinates.items():
            array = group.create_array(
                name,
                shape=each.values.shape,
                dtype=each.values.dtype,
                dimension_names=each.axes,
                attributes=dict(each.attributes),
            )
            array[...] = each.values
        for variable in layout.variables:
            codec = BloscCodec(
                typesize=np.dtype(variable.dtype).itemsize, cname=_NAME, clevel=_LEVEL, shuffle="shuffle"
            )
            group.create_array(
                variable.name,
                shape=layout.cut.shape,
                chunks=layout.cut.chunk,
                dtype=variable.dtype,
                dimension_names=layout.axes,
                fill_value=variable.fill,
                compressors=codec,
                attributes=dict(variable.attributes),
            )
        group.create_array(
            "status",
            shape=(layout.cut.count,),
            chunks=(1,),
            dtype="uint8",
            dimension_names=("chunk",),
            fill_value=0,
            compressors=None,
            attributes={
                "long_name": "chunks in C order: which are finished",
                "flag_values": [0, 1],
                "flag_meanings": "missing finished",
            },
        )
        with warnings.catch_warnings():  # all metadata in one place are an extension that xarray asks for
            warnings.simplefilter("ignore")
            zarr.consolidate_metadata(path)

    def read_manifest(self, path: Path) -> Scenario | None:
        """Return the manifest, if there is one."""
        with suppress(OSError, ValueError, KeyError, TypeError, RecursionError):
            manifest = json.loads((path / self.manifest).read_bytes())["attributes"]["hersey"]
            if "scenario" in manifest:
                return dict(manifest)
        return None

    def open(self, path: Path, cut: Cut, variables: tuple[Variable, ...]) -> ZarrFolder:
        """Return a store that is there."""
        return ZarrFolder(path, cut, tuple((each.name, each.dtype, each.fill) for each in variables))


@dataclass(frozen=True)
class ZarrFolder:
    """One such store."""

    path: Path
    cut: Cut
    arrays: tuple[tuple[str, str, float], ...]

    def note(self, number: int) -> Note | None:
        """Return the note of a chunk that is finished."""
        try:
            if self._status(number).read_bytes() != b"\x01":
                return None
            return dict(json.loads(self._note(number).read_bytes()))
        except (OSError, ValueError, TypeError, RecursionError):
            return None

    def finished(self) -> list[int]:
        """Return the numbers of the chunks that are finished."""
        try:
            names = [entry.name for entry in os.scandir(self.path / "status" / "c")]
        except FileNotFoundError:
            return []
        return sorted(int(name) for name in names if name.isdigit() and int(name) < self.cut.count)

    def write(self, number: int, values: Columns, beside: Columns, note: Note) -> None:  # noqa: ARG002 - axes are there
        """Keep a chunk."""
        if not (self.path / ZarrKind.manifest).exists():
            raise OutputError(f"{self.path} is not seen here, or is gone")
        place = "/".join(str(index) for index in self.cut.place(number))
        shape = self.cut.shape_of(number)
        for name, dtype, fill in self.arrays:
            content = _encoded(np.asarray(values[name]).reshape(shape), self.cut.chunk, dtype, fill)
            write_file(self.path / name / "c" / place if place else self.path / name / "c", content)
        write_file(self._note(number), json.dumps(note).encode())
        write_file(self._status(number), b"\x01")

    def _status(self, number: int) -> Path:
        return self.path / "status" / "c" / str(number)

    def _note(self, number: int) -> Path:
        return self.path / "status" / _NOTES / f"{number}.json"


def _encoded(values: Any, chunk: tuple[int, ...], dtype: str, fill: float) -> bytes:
    """Return a chunk as the store holds it; at the end of an axis fill values follow."""
    from numcodecs import blosc  # type: ignore[import-untyped]

    whole = np.asarray(values, dtype=np.dtype(dtype).newbyteorder("<"))
    if whole.shape != chunk:
        padded = np.full(chunk, fill, whole.dtype)
        padded[tuple(slice(length) for length in whole.shape)] = whole
        whole = padded
    return bytes(
        blosc.compress(np.ascontiguousarray(whole).reshape(-1), _NAME.encode(), _LEVEL, blosc.SHUFFLE)
    )
