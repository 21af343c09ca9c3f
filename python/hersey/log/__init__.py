"""Reading files into a `TorqueLog`.

=============  ==================================================================
torque_log     `TorqueLog`: channels in SI, with where they came from
layout         where the table starts in a text file, how its numbers are written
channels       which column plays which role
delimited      CSV and its relatives
=============  ==================================================================

A further format is one more module with a function like `read_delimited`, entered in `READERS`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from hersey.errors import ParameterError
from hersey.log.channels import ROLES, ChannelChoice
from hersey.log.delimited import Progress, read_delimited
from hersey.log.torque_log import Channel, LogFile, Run, TorqueLog

__all__ = ["Channel", "ChannelChoice", "LogFile", "Run", "TorqueLog", "read"]

#: Readers by file suffix; what is not listed is read as delimited text.
READERS: dict[str, Callable[..., tuple[Run, LogFile]]] = {}


def read(
    paths: str | Path | Iterable[str | Path],
    *,
    channels: dict[str, str] | None = None,
    units: dict[str, str] | None = None,
    isothermal: bool = False,
    drop_missing: bool = False,
    progress: Progress | None = None,
) -> TorqueLog:
    """Read one log file, or several of one machine, each a run of its own.

    Parameters
    ----------
    paths
        File or files.
    channels
        Column name by role (``time``, ``torque``, ``speed``, ``temperature``), where names and units
        in the file do not settle it.
    units
        Unit by role, where the file has none or a wrong one; may carry a factor or sign.
    isothermal
        Leave temperature out.
    drop_missing
        Leave out rows in which a number is missing, and count them, instead of refusing them.
    progress
        Called with bytes done and bytes in all.

    Raises
    ------
    HerseyError
        One of its kinds, naming file, line and column.

    Examples
    --------
    >>> import hersey
    >>> log = hersey.read("examples/bench.csv")
    >>> log.rows > 10_000
    True
    """
    files: Sequence[str | Path] = [paths] if isinstance(paths, str | Path) else list(paths)
    if not files:
        raise ParameterError("no log file was named")
    for role in [*(channels or {}), *(units or {})]:
        if role not in ROLES:
            raise ParameterError(f"'{role}' is no role of a channel: they are {', '.join(ROLES)}")
    choices = {r: ChannelChoice((channels or {}).get(r, ""), (units or {}).get(r, "")) for r in ROLES}
    runs: list[Run] = []
    logs: list[LogFile] = []
    for file in files:
        reader = READERS.get(Path(file).suffix.lower(), read_delimited)
        run, log = reader(
            Path(file), choices, isothermal=isothermal, drop_missing=drop_missing, progress=progress
        )
        if any(log.sha256 == other.sha256 for other in logs):
            raise ParameterError(f"{log.name} holds the same bytes as a file before it: name each file once")
        runs.append(run)
        logs.append(log)
    return TorqueLog(tuple(runs), tuple(logs))
