"""Reading a kept sweep: each chunk is compared with what was written when it is asked for."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from zarr.storage import LocalStore, WrapperStore

from hersey.errors import OutputError
from hersey.scale.cutting import Cut
from hersey.scale.zarr_folder import ZarrFolder, ZarrKind


class CheckedStore(WrapperStore[LocalStore]):
    """The files of a store, of which a damaged or missing chunk is an error and not a number."""

    def __init__(self, store: LocalStore) -> None:
        """Take a store that a sweep was kept in."""
        super().__init__(store)
        manifest = ZarrKind().read_manifest(Path(store.root))
        if manifest is None:
            raise OutputError(f"{store.root} is not a hersey sweep. Name the folder of one")
        variables = tuple((str(name), str(dtype), 0.0) for name, dtype, _ in manifest["variables"])
        cut = Cut(tuple(manifest["shape"]), tuple(manifest["chunk"]))
        self._folder = ZarrFolder(Path(store.root), cut, variables)
        self._names = {name for name, _, _ in variables}

    async def get(self, key: str, prototype: Any, byte_range: Any = None) -> Any:
        """Return the bytes of a file, None if there is none.

        Raises
        ------
        OutputError
            If it is a chunk that was finished, and is not what was written.
        """
        found = await super().get(key, prototype, byte_range)
        name, _, place = key.partition("/c")
        if name in self._names and byte_range is None:
            number = self._folder.cut.number(tuple(int(index) for index in place.split("/") if index))
            self._folder.refuse_damage(name, number, None if found is None else found.to_bytes())
        return found


def checked(path: Path) -> CheckedStore:
    """Return the store at a path, for reading alone."""
    return CheckedStore(LocalStore(path, read_only=True))
