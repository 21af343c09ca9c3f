"""Logs that are read and reduced once for all commands: found by the hashes of their bytes, not by names.

A log is found again if its bytes, its name, the content of its mapping and all options of reading are the
same. What changed while it was read is not kept.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Protocol

from hersey.cache.kept import kept
from hersey.cache.switch import cache_folder
from hersey.damping.dwells import SteadyPoints
from hersey.errors import HerseyError
from hersey.files.reading import open_once
from hersey.log import TorqueLog
from hersey.log.mapping import LogMapping
from hersey.log.means import MeansTable
from hersey.log.text.delimited import Progress

#: Settings of a recipe on which what is read does not depend.
_OF_DWELLS = (
    "min_dwell",
    "tare",
    "rotation",
    "temperature_scale",
    "no_load",
    "moving",
    "inertia",
    "inertia_error",
)
#: Bytes of logs from which reading takes longer than finding what was read.
_WORTH_KEEPING = 1 << 16


class HowRead(Protocol):
    """How logs are read: a recipe is one."""

    @property
    def logs(self) -> tuple[Path, ...]:
        """Their files."""

    @property
    def run_table(self) -> Path | None:
        """File of what each of them is of."""

    @property
    def schedule(self) -> Path | None:
        """File of what was asked for by time."""

    @property
    def chosen(self) -> LogMapping:
        """Their mapping."""

    def read_files(self, progress: Progress | None = None) -> TorqueLog | MeansTable:
        """Read them."""


def read_once(how: HowRead, progress: Progress | None) -> TorqueLog | MeansTable:
    """Return the log as its files hold it now, without reading it where it was read before."""
    if cache_folder() is None:
        return how.read_files(progress)
    try:
        mapping = how.chosen
        stated = (how.schedule, how.run_table, mapping.names.table)
        hashed = [_hash(path) for path in (*filter(None, stated), *_files(how.logs, mapping))]
    except (HerseyError, OSError):  # which reading says, too
        return how.read_files(progress)
    hashes = tuple(digest for digest, _ in hashed)
    if not all(hashes) or sum(size for _, size in hashed) < _WORTH_KEEPING:
        return how.read_files(progress)
    return _read(_alike(how), mapping, hashes, progress)


def _alike(how: Any) -> HowRead:
    """The same without what is asked of dwells alone: logs whose recipes differ in it are read alike."""
    usual = type(how)()
    alike: HowRead = replace(how, **{name: getattr(usual, name) for name in _OF_DWELLS})
    return alike


def _files(logs: tuple[Path, ...], mapping: LogMapping) -> tuple[Path, ...]:
    """All files whose numbers become those of the log."""
    beside = mapping.torque.no_load
    return (*logs, beside) if isinstance(beside, Path) else logs


def _hash(path: Path) -> tuple[str, int]:
    """Hash and size of a file; no hash if it changed meanwhile."""
    with open_once(path) as file:
        digest = file.sha256()
        return "" if file.change() else digest, file.size


def _is_of_these(log: TorqueLog | MeansTable, given: Mapping[str, Any]) -> bool:
    """Whether the bytes that were read are those that were hashed before, and after."""
    hashes = given["hashes"]
    try:
        beside = [_hash(path)[0] for path in _files((), given["mapping"])]
    except (HerseyError, OSError):
        return False
    return {file.sha256 for file in log.files} <= set(hashes) and beside in ([], [hashes[-1]])


@kept(apart=("progress",), sound=_is_of_these)
def _read(
    how: HowRead,
    mapping: LogMapping,  # noqa: ARG001 - content of the file that is named, or found beside the logs
    hashes: tuple[str, ...],  # noqa: ARG001 - of all files
    progress: Progress | None,
) -> TorqueLog | MeansTable:
    """What files of these hashes hold."""
    return how.read_files(progress)


@kept()
def reduced_once(log: TorqueLog, *, min_dwell: float, tare: str, rotation: str) -> SteadyPoints:
    """Return the dwells of a log, as `TorqueLog.steady`."""
    return log.steady(min_dwell=min_dwell, tare=tare, rotation=rotation)
