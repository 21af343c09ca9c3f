"""The process in which asammdf runs: its compiled part ends the process on some damaged files.

Run as a script by `hersey.log.formats.mdf`. Requests and replies are pickled: ``("open", path)`` is answered
by a `dict` of channels, frames and warnings, ``("get", group, index)`` by one of values and times in s;
whatever goes wrong by a `str`.
"""

from __future__ import annotations

import logging
import os
import pickle
import sys
from typing import Any, BinaryIO

_MASTERS = (2, 3)  # channel types: master, virtual master
_TIME = (0, 1)  # kinds of master: none given (MDF 3), time
_BUS = ("CAN_", "LIN_", "FLX_", "ETH_", "MOST_", "K_LINE_")


class _Heard(logging.Handler):
    """What asammdf logs."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.words: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.words.append(record.getMessage()[:160])


class _File:
    """The file that is open."""

    def __init__(self) -> None:
        import asammdf

        self.asammdf: Any = asammdf
        self.mdf: Any = None
        self.heard = _Heard()
        logging.getLogger("asammdf").addHandler(self.heard)

    def open(self, path: str) -> dict[str, Any]:
        if self.mdf is not None:
            self.mdf.close()
            self.mdf = None
        self.heard.words.clear()
        self.mdf = self.asammdf.MDF(path)
        channels, frames = [], set()
        for number, group in enumerate(self.mdf.groups):
            rows = int(group.channel_group.cycles_nr)
            for index, channel in enumerate(group.channels if rows else ()):
                master = index == self.mdf.masters_db.get(number)
                if channel.name.startswith(_BUS):
                    frames.add(channel.name.split(".")[0])
                elif not master and getattr(channel, "channel_type", 0) not in _MASTERS:
                    unit = getattr(channel, "unit", "") or getattr(channel.conversion, "unit", "") or ""
                    channels.append((number, index, channel.name, str(unit).strip("\0 "), rows))
        return {
            "channels": channels,
            "frames": sorted(frames),
            "heard": list(dict.fromkeys(self.heard.words)),
        }

    def get(self, group: int, index: int) -> dict[str, Any] | str:
        master = self.mdf.masters_db.get(group)
        channels = self.mdf.groups[group].channels
        if master is None or getattr(channels[master], "sync_type", 1) not in _TIME:
            return "was recorded against no clock"
        self.heard.words.clear()
        signal = self.mdf.get(group=group, index=index)
        if self.heard.words:
            return f"cannot be read: {self.heard.words[-1]}"
        values = signal.samples
        if values.ndim != 1 or values.dtype.kind not in "iufb":
            return f"holds {'arrays' if values.ndim != 1 or values.dtype.names else 'text'}, not numbers"
        values = values.astype(float)
        if signal.invalidation_bits is not None:
            values[signal.invalidation_bits.astype(bool)] = float("nan")
        return {"values": values, "times": signal.timestamps.astype(float)}


def serve(requests: BinaryIO, replies: BinaryIO) -> None:
    """Answer requests until there are no more."""
    file = _File()
    while True:
        try:
            what, *arguments = pickle.load(requests)
        except EOFError:
            return
        try:
            reply = file.open(*arguments) if what == "open" else file.get(*arguments)
        except Exception as error:  # of every kind on damaged bytes
            told = str(error).partition("\n")[0][:160] or type(error).__name__
            reply = f"cannot be read: it is damaged, cut off or of another kind ({told})"
        pickle.dump(reply, replies)
        replies.flush()


if __name__ == "__main__":
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # asammdf prints
    serve(sys.stdin.buffer, answers)
