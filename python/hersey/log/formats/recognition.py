"""Which format a file has: by its first bytes, or by its suffix."""

from __future__ import annotations

import re
from pathlib import Path

from hersey.errors import UnreadableLogError
from hersey.files.reading import open_file
from hersey.log.formats.hdf5 import MAGIC as HDF5
from hersey.processes.forks import refuse_after_fork

#: Formats by suffix, each the module here that reads it; what is not listed is read as delimited text.
READERS = {
    ".tdms": "tdms",
    ".mf4": "mdf",
    ".mdf": "mdf",
    ".mat": "matlab",
    ".h5": "hdf5",
    ".hdf5": "hdf5",
    ".hdf": "hdf5",
    ".parquet": "parquet",
    ".lvm": "lvm",
    ".xlsx": "excel",
    ".xlsm": "excel",
    ".xlsb": "excel",
    ".xls": "excel",
    ".npz": "numpy_arrays",
    ".npy": "numpy_arrays",
}
#: What a person calls a file of each of these modules.
FILES = {
    "tdms": "a LabVIEW TDMS file",
    "mdf": "an ASAM MDF file",
    "matlab": "a MATLAB file",
    "hdf5": "an HDF5 file",
    "parquet": "a Parquet file",
    "lvm": "a LabVIEW measurement file",
    "excel": "an Excel workbook",
    "numpy_arrays": "a NumPy file",
}
#: Bytes of the start that are looked at.
_LOOKED_AT = 512
_LOOKED_AT_IN_A_PAGE = 1 << 20
#: First bytes of a format, which outrank the suffix.
_STARTS = (
    (b"TDSm", "tdms"),
    (b"MDF     ", "mdf"),
    (b"UnFinMF ", "mdf"),
    (b"MATLAB 5.0 MAT-file", "matlab"),
    (b"MATLAB 7.3 MAT-file", "matlab"),
    (HDF5, "hdf5"),
    (b"PAR1", "parquet"),
    (b"LabVIEW Measurement", "lvm"),
    (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "excel"),
    (b"\x93NUMPY", "numpy_arrays"),
)
#: How an archive starts, and what its first member tells of it.
_ARCHIVE = b"PK\x03\x04"
_NAME_LENGTH, _NAME = slice(26, 28), 30
_MEMBERS = re.compile(rb"(?P<numpy_arrays>.*\.npy)|(?P<excel>\[Content_Types\]\.xml|(_rels|docProps|xl)/.*)")
#: How a page of a browser starts, and a spreadsheet written as XML: both pass for workbooks with Excel.
_MARKUP = re.compile(
    r"(?P<page>\s*(<!--.{0,300}?-->)?\s*<(!doctype html|html|head|body|meta|table)\b)|(?P<xml>\s*<\?xml\b)",
    re.IGNORECASE | re.DOTALL,
)
#: Text that lines of cells have and no workbook has.
_TEXT = re.compile(r"[^\x00-\x08\x0e-\x1f]*[\t;,][^\x00-\x08\x0e-\x1f]*")
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")


def format_of(path: Path) -> str | None:
    """Return the format of a file, one of those in `READERS`, or None if it is to be read as delimited text.

    Raises
    ------
    MissingFileError
        If the file is not there, is no ordinary file, or cannot be read.
    UnreadableLogError
        If it is of a kind that is known and not read.
    ForkedError
        If it is text, and this process was forked from one that has read some.
    """
    with open_file(path) as file:
        start = file.read(_LOOKED_AT)
    start = start.removeprefix(b"\xef\xbb\xbf")
    kind = READERS.get(path.suffix.lower())
    if start.startswith(_ARCHIVE):
        kind = _of_archive(path, start, kind)
    kind = next((kind for magic, kind in _STARTS if start.startswith(magic)), kind)
    if kind in (None, "excel"):
        text = start.decode("utf-16" if start.startswith(_UTF_16) else "latin-1", errors="ignore")
        _refuse_markup(path, text)
        kind = None if _TEXT.fullmatch(text) else kind
    if kind is None:
        refuse_after_fork()  # text goes through polars, here
    return kind


def _refuse_markup(path: Path, text: str) -> None:
    """Raise if a text is a page of a browser or XML."""
    if not (match := _MARKUP.match(text)):
        return
    what, ending = ("a web page (HTML)", ".html") if match["page"] else ("an XML file", ".xml")
    with open_file(path) as file:
        if match["page"] and b"<table" not in file.read(_LOOKED_AT_IN_A_PAGE).replace(b"\0", b"").lower():
            raise UnreadableLogError(
                f"{path.name} is a web page (HTML) without a table, e.g. of a login or an error",
                remedy="open it in a browser to see which, and download the log again",
            )
    suffix = path.suffix.lower()
    renamed = "" if suffix in (".xls", ending) else f"rename it to end in {ending}, "
    raise UnreadableLogError(
        f"{path.name} is {what}, not a {'workbook' if suffix in READERS else 'table of numbers'}",
        remedy=f"{renamed}open it in Excel and save it as .xlsx or .csv",
    )


def _of_archive(path: Path, start: bytes, kind: str | None) -> str:
    """The format of an archive by the name of its first member, or else by the suffix of the file.

    Raises
    ------
    UnreadableLogError
        If neither is known.
    """
    length = int.from_bytes(start[_NAME_LENGTH], "little")
    member = _MEMBERS.fullmatch(start[_NAME : _NAME + length])
    kind = (member and member.lastgroup) or kind
    if kind not in ("excel", "numpy_arrays"):
        raise UnreadableLogError(f"{path.name} is an archive. Unpack it, and give the log inside")
    return kind


def called(kind: str) -> str:
    """Return a file of a format in words, with the suffixes that it usually has."""
    kind = "excel" if kind == "sheets" else kind  # another reader of the same files
    suffixes = [suffix for suffix, reader in READERS.items() if reader == kind]
    return f"{FILES[kind]} ({', '.join(suffixes)})"
