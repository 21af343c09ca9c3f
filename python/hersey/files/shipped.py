"""The examples that come with the package: logs and a machine file to try the commands on."""

from __future__ import annotations

import shutil
from pathlib import Path

from hersey.errors import ExistingFileError, OutputError

#: Kinds of file that are examples of input; the repository keeps scripts beside them.
_KINDS = {".csv", ".json", ".toml"}
#: The file by which a folder of examples is recognised.
_LOG = "bench.csv"


def copy_examples(folder: Path) -> list[Path]:
    """Copy the examples into a new folder and return the files written.

    Raises
    ------
    ExistingFileError
        If the folder exists.
    OutputError
        If it cannot be written, or if this installation has no examples.
    """
    from hersey.files.writing import refuse_without_folder, write_all

    home = _home()
    files = sorted(path.relative_to(home) for path in home.rglob("*") if path.suffix in _KINDS)
    refuse_without_folder(folder)
    try:
        folder.mkdir()
    except FileExistsError:
        raise ExistingFileError(f"{folder} already exists. Name a new folder") from None
    except OSError as error:
        raise OutputError(f"{folder} cannot be written: {error.strerror}") from None
    try:
        for inner in sorted({file.parent for file in files} - {Path()}):
            (folder / inner).mkdir()
        write_all({folder / file: (home / file).read_bytes() for file in files}, overwrite=False)
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)  # it is new, and holds nothing else
        raise
    return [folder / file for file in files]


def _home() -> Path:
    """Return where the examples are: in the package, or in the repository that it is run from."""
    here = Path(__file__).resolve()
    for home in (here.with_name("examples"), here.parents[3] / "examples"):
        if (home / _LOG).is_file():
            return home
    raise OutputError("This installation has no examples. Build a wheel with `make wheel` and install that")
