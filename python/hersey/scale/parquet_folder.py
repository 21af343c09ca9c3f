"""A folder of Parquet files, one per chunk, one row per point; the record of a chunk stands in its file.

The manifest is such a file too, without rows, so that a reader can be given the folder as it is.
"""

from __future__ import annotations

import io
import json
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hersey.errors import OutputError
from hersey.scale.cutting import Cut
from hersey.scale.store import Columns, Layout, Note, Scenario, Variable, write_file
from hersey.schema.warning import Warning

#: Key of the note among what a file says of itself.
_NOTE = "hersey"


class ParquetKind:
    """Makes and opens such folders."""

    manifest = "manifest.parquet"
    lock = ".lock"
    format = 1

    def create(self, path: Path, layout: Layout, manifest: Scenario) -> None:
        """Make an empty folder."""
        import polars as pl

        units = {name: each.attributes.get("units") for name, each in layout.coordinates.items()}
        units |= {each.name: each.attributes.get("units") for each in layout.variables}
        about = {**layout.attributes, "units_of_columns": units}
        columns: dict[str, Any] = {name: np.empty(0) for name in layout.coordinates}
        columns |= {
            each.name: np.empty(0, np.array(each.words).dtype if each.words else each.dtype)
            for each in layout.variables
        }
        record = json.dumps({**manifest, "about": about}, allow_nan=False)
        content = io.BytesIO()
        pl.DataFrame(columns).write_parquet(content, metadata={_NOTE: record})
        write_file(path / self.manifest, content.getvalue())

    def read_manifest(self, path: Path) -> Scenario | None:
        """Return the manifest, if there is one."""
        import polars as pl

        with suppress(OSError, ValueError, KeyError, TypeError, RecursionError, pl.exceptions.PolarsError):
            manifest = json.loads(pl.read_parquet_metadata(path / self.manifest)[_NOTE])
            if isinstance(manifest, dict) and "scenario" in manifest:
                return manifest
        return None

    def open(self, path: Path, cut: Cut, variables: tuple[Variable, ...]) -> ParquetFolder:
        """Return a folder that is there."""
        return ParquetFolder(path, cut, tuple((each.name, tuple(each.words)) for each in variables))

    def mend(self, path: Path, layout: Layout, manifest: Scenario) -> tuple[Warning, ...]:  # noqa: ARG002 - of `Kind`
        """Return nothing: beside the chunks there is the manifest alone."""
        return ()


@dataclass(frozen=True)
class ParquetFolder:
    """One such folder."""

    path: Path
    cut: Cut
    columns: tuple[tuple[str, tuple[str, ...]], ...]
    mended: tuple[Warning, ...] = ()

    def note(self, number: int) -> Note | None:
        """Return the note of a chunk that is finished."""
        import polars as pl

        try:
            return dict(json.loads(pl.read_parquet_metadata(self._file(number))[_NOTE]))
        except FileNotFoundError:
            return None
        except (OSError, ValueError, KeyError, TypeError, RecursionError, pl.exceptions.PolarsError):
            return None  # not whole, as after a loss of power: it is made anew

    def finished(self) -> list[int]:
        """Return the numbers of the chunks that are finished."""
        names = [file.stem for file in self.path.glob("*.parquet")]
        return sorted(int(name) for name in names if name.isdigit() and int(name) < self.cut.count)

    def write(self, number: int, values: Columns, beside: Columns, note: Note) -> None:
        """Keep a chunk."""
        import polars as pl

        if not (self.path / ParquetKind.manifest).exists():
            raise OutputError(f"{self.path} is not visible here, or was deleted")
        own: dict[str, Any] = {
            name: np.array(words)[values[name]] if words else values[name] for name, words in self.columns
        }
        content = io.BytesIO()
        table = pl.DataFrame({**beside, **own})
        table.write_parquet(content, compression="lz4", metadata={_NOTE: json.dumps(note)})
        write_file(self._file(number), content.getvalue())

    def _file(self, number: int) -> Path:
        return self.path / f"{number:07d}.parquet"
