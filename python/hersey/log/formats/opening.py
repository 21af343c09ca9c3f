"""Which reader opens a file: told by its first bytes, or by its suffix where those say nothing."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

from polars.exceptions import PanicException

from hersey.errors import HerseyError, MissingFileError, UnreadableLogError
from hersey.log.formats.hdf5 import MAGIC as HDF5
from hersey.log.formats.hdf5 import open_hdf5
from hersey.log.formats.lvm import open_lvm
from hersey.log.formats.matlab import open_matlab
from hersey.log.formats.mdf import open_mdf
from hersey.log.formats.parquet import open_parquet
from hersey.log.formats.tdms import open_tdms
from hersey.log.recording import Recording

Opener = Callable[[Path], AbstractContextManager[Recording]]

#: Readers by suffix; what is not listed is read as delimited text.
READERS: dict[str, Opener] = {
    ".tdms": open_tdms,
    ".mf4": open_mdf,
    ".mdf": open_mdf,
    ".mat": open_matlab,
    ".h5": open_hdf5,
    ".hdf5": open_hdf5,
    ".hdf": open_hdf5,
    ".parquet": open_parquet,
    ".lvm": open_lvm,
}
#: First bytes of a format, which outrank the suffix.
_STARTS: tuple[tuple[bytes, Opener], ...] = (
    (b"TDSm", open_tdms),
    (b"MDF     ", open_mdf),
    (b"UnFinMF ", open_mdf),
    (b"MATLAB 5.0 MAT-file", open_matlab),
    (b"MATLAB 7.3 MAT-file", open_matlab),
    (HDF5, open_hdf5),
    (b"PAR1", open_parquet),
    (b"LabVIEW Measurement", open_lvm),
)
_UNREADABLE = {
    b"PK\x03\x04": "a workbook or an archive: save the sheet as CSV",
    b"\xd0\xcf\x11\xe0": "an old workbook of Excel: save the sheet as CSV",
}


def opener(path: Path) -> Opener | None:
    """Return the reader of a file, or None if it is to be read as delimited text.

    Raises
    ------
    MissingFileError
        If the file is not there, is no ordinary file, or cannot be read.
    UnreadableLogError
        If it is of a kind that is known and not read.
    """
    try:
        if path.exists() and not path.is_file():
            what = "a directory: name the log files in it" if path.is_dir() else "no ordinary file"
            raise MissingFileError(f"{path} is {what}")
        with path.open("rb") as file:
            start = file.read(64)
    except HerseyError:
        raise
    except FileNotFoundError:
        raise MissingFileError(f"{path}: there is no such file") from None
    except OSError as error:
        raise MissingFileError(f"{path} cannot be read: {error.strerror}") from None
    for magic, what in _UNREADABLE.items():
        if start.startswith(magic):
            raise UnreadableLogError(f"{path.name} is {what}")
    plain = start.removeprefix(b"\xef\xbb\xbf")
    return next((o for magic, o in _STARTS if plain.startswith(magic)), READERS.get(path.suffix.lower()))


@contextmanager
def opened(path: Path, reader: Opener) -> Iterator[Recording]:
    """Open a file and see to it that whatever a library stumbles over ends in one clear line.

    Raises
    ------
    UnreadableLogError
        If the file is damaged, cut off, or not of this format.
    """
    recording: Recording | None = None
    try:
        with reader(path) as recording:
            yield recording
    except HerseyError as error:
        if path.name not in str(error):
            raise type(error)(f"{path.name}: {error}") from None
        raise
    except (Exception, PanicException) as error:  # libraries raise of every kind on damaged bytes
        what = recording.format if recording else reader.__name__.removeprefix("open_").upper()
        told = str(error).splitlines()[0][:160] if str(error) else type(error).__name__
        raise UnreadableLogError(
            f"{path.name} cannot be read as {what}: the file is damaged, cut off or of another kind ({told})"
        ) from error
