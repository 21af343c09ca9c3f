"""A Zarr store (v3), one array per quantity, one file per chunk of each.

The library makes the store and reads it. A chunk of an array is a file that a task writes by itself, as the
specification has it (C order, little end first, Blosc, then the CRC-32C of it all). By way of the library, or
of region writes of xarray, the same bytes take twelve times as long (82 ms instead of 7 ms for 12 quantities
of 1,000 sets), and would have to be read again for their checksums. ``status`` has one element per chunk, 1
where it is finished: of a chunk that holds nothing but the fill value one could not tell whether it was ever
written.

The note of a chunk holds the checksum of its file in each array, and one of its own. A chunk is finished only
if all its files are those: none damaged, cut off, deleted or put in the place of another.
"""

from __future__ import annotations

import json
import os
import warnings
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Literal

import numpy as np

from hersey.errors import MissingFileError, OutputError
from hersey.scale.cutting import Cut
from hersey.scale.store import Columns, Layout, Note, Scenario, Variable, write_file
from hersey.schema.warning import Warning

#: Compression of values: bytes of one weight together, then LZ4 (a tenth of a millisecond per 1,000 sets).
_NAME: Literal["lz4"] = "lz4"
_LEVEL = 1
#: What is said of `status`, as the CF conventions have it.
_STATUS: dict[str, Any] = {
    "long_name": "which chunks are finished, in C order",
    "flag_values": [0, 1],
    "flag_meanings": "missing finished",
}
#: Where the record of each chunk lies, in the folder of `status`: no part of the store.
_NOTES = "notes"


class ZarrKind:
    """Makes and opens such stores."""

    manifest = "zarr.json"
    lock = "status/.lock"
    #: 1 had no checksums.
    format = 2

    def __init__(self) -> None:
        """Refuse where the library is not installed."""
        try:
            import zarr  # noqa: F401 - whether it is there
        except ImportError:
            raise MissingFileError(
                ".zarr needs Zarr, which is not installed. Run pip install 'hersey[scale]', or use .parquet"
            ) from None

    def create(self, path: Path, layout: Layout, manifest: Scenario) -> None:
        """Make a store without values."""
        import zarr
        from zarr.codecs import BloscCodec, Crc32cCodec, ZstdCodec

        named = " ".join(name for name, each in layout.coordinates.items() if each.axes != (name,))
        about = {**layout.attributes, "hersey": manifest, "coordinates": named}
        group = zarr.create_group(path, zarr_format=3, attributes=about)
        for name, each in layout.coordinates.items():
            group.create_array(
                name,
                data=each.values,
                dimension_names=each.axes,
                compressors=(ZstdCodec(), Crc32cCodec()),
                attributes=dict(each.attributes),
            )
        for variable in layout.variables:
            size = np.dtype(variable.dtype).itemsize
            codec = BloscCodec(typesize=size, cname=_NAME, clevel=_LEVEL, shuffle="shuffle")
            group.create_array(
                variable.name,
                shape=layout.cut.shape,
                chunks=layout.cut.chunk,
                dtype=variable.dtype,
                dimension_names=layout.axes,
                fill_value=variable.fill,
                compressors=(codec, Crc32cCodec()),
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
            attributes=_STATUS,
        )
        with warnings.catch_warnings(action="ignore"):  # of an extension that xarray asks for
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

    def mend(self, path: Path, layout: Layout, manifest: Scenario) -> tuple[Warning, ...]:
        """Write again each file of metadata and coordinates that is not as it would be made."""
        mended = []
        with TemporaryDirectory() as folder:
            made = Path(folder) / "made.zarr"
            self.create(made, layout, manifest)
            for file in sorted(each for each in made.rglob("*") if each.is_file()):
                name, content = file.relative_to(made), file.read_bytes()
                try:
                    same = (path / name).read_bytes() == content
                except OSError:
                    same = False
                if not same:
                    write_file(path / name, content)
                    mended.append(
                        Warning(
                            "file written again",
                            "{file} was damaged or missing and was written again",
                            where=path.name,
                            file=str(name),
                        )
                    )
        return tuple(mended)


@dataclass(frozen=True)
class ZarrFolder:
    """One such store."""

    path: Path
    cut: Cut
    arrays: tuple[tuple[str, str, float], ...]
    mended: tuple[Warning, ...] = ()

    def note(self, number: int) -> Note | None:
        """Return the note of a chunk that is finished and whole."""
        try:
            if self._status(number).read_bytes() != b"\x01":
                return None
            record = self._record(number)
            if any(
                _checksum_of_chunk(self._file(name, number).read_bytes()) != record["files"][name]
                for name, _, _ in self.arrays
            ):
                return None
            return dict(record["note"])
        except (OSError, ValueError, TypeError, KeyError, RecursionError):
            return None

    def refuse_damage(self, name: str, number: int, content: bytes | None) -> None:
        """Refuse what was read as the chunk of an array unless it is what was written; None if there is none.

        Raises
        ------
        OutputError
            Naming store, chunk and array.
        """
        try:
            if content is not None and _checksum_of_chunk(content) == self._record(number)["files"][name]:
                return
            if content is None and not self._status(number).exists():  # not finished: the fill value is right
                return
        except (OSError, ValueError, TypeError, KeyError, RecursionError):
            pass
        raise OutputError(
            f"{self.path}: chunk {number} of '{name}' is damaged or missing. Repeat the sweep into the "
            "same folder to compute it again"
        )

    def _record(self, number: int) -> dict[str, Any]:
        """What the note's file holds: the note and checksums of all files of the chunk."""
        checked = json.loads(self._note(number).read_bytes())
        record: dict[str, Any] = json.loads(checked["told"])
        if checksum(checked["told"].encode()) != checked["crc32c"]:
            raise ValueError
        return record

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
            raise OutputError(f"{self.path} is not visible here, or was deleted")
        shape, files = self.cut.shape_of(number), {}
        for name, dtype, fill in self.arrays:
            content = _encoded(np.asarray(values[name]).reshape(shape), self.cut.chunk, dtype, fill)
            write_file(self._file(name, number), content)
            files[name] = _checksum_of_chunk(content)
        record = json.dumps({"note": note, "files": files})
        content = json.dumps({"told": record, "crc32c": checksum(record.encode())}).encode()
        write_file(self._note(number), content)
        write_file(self._status(number), b"\x01")

    def _file(self, name: str, number: int) -> Path:
        return self.path.joinpath(name, "c", *map(str, self.cut.place(number)))

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
    packed = bytes(
        blosc.compress(np.ascontiguousarray(whole).reshape(-1), _NAME.encode(), _LEVEL, blosc.SHUFFLE)
    )
    return packed + checksum(packed).to_bytes(4, "little")


def checksum(content: bytes) -> int:
    """Return the CRC-32C of bytes."""
    import google_crc32c

    return int(google_crc32c.value(content))


def _checksum_of_chunk(content: bytes) -> int:
    """Return the checksum at the end of a chunk; that of both together is the same for every chunk.

    Raises
    ------
    ValueError
        If it is not that of the bytes before it.
    """
    packed, end = content[:-4], int.from_bytes(content[-4:], "little")
    if len(content) < 4 or checksum(packed) != end:
        raise ValueError
    return end
