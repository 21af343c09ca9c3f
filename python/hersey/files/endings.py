"""What a file probably is, by the ending of its name."""

from __future__ import annotations

from pathlib import Path

#: Endings of names that are probably those of logs.
LOGS = frozenset(
    [
        ".csv",
        ".txt",
        ".tsv",
        ".dat",
        ".log",
        ".lvm",
        ".tdms",
        ".mf4",
        ".mdf",
        ".mat",
        ".h5",
        ".hdf5",
        ".parquet",
        ".xlsx",
        ".xlsm",
        ".xls",
        ".npz",
        ".npy",
    ]
)
#: Endings of files of other kinds that a command reads: a TOML file, a campaign, a fit.
_OTHERS = frozenset([".toml", ".hersey", ".json"])


def could_stand_for(name: str, missing: str) -> bool:
    """Whether a file could be meant by the name of a missing one: it is of the same kind, as far as known.

    Examples
    --------
    >>> could_stand_for("joined.html", "machine.toml"), could_stand_for("bench.mf4", "benh.csv")
    (False, True)
    """
    ending, wanted = Path(name).suffix.lower(), Path(missing).suffix.lower()
    if wanted in LOGS:
        return ending in LOGS
    return ending == wanted if wanted in _OTHERS else True
