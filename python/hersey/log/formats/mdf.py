"""ASAM MDF files (MF4, MDF 3), through asammdf: every channel on the raster of its own group."""

from __future__ import annotations

import atexit
import importlib.util
import pickle
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from hersey.arrays import FloatArray
from hersey.errors import UnreadableLogError
from hersey.log.recording import Recording, Signal, missing_library, split_unit


@contextmanager
def open_mdf(path: Path) -> Iterator[Recording]:
    """Open an MDF file; a channel of text or arrays is listed, and refused when it is asked for."""
    reply = _worker.ask(path.name, "open", str(path.resolve()))
    if isinstance(reply, str):
        raise UnreadableLogError(f"{path.name} {reply}")
    recording = Recording("MF4", (), notes=[f"asammdf warns: {words}" for words in reply["heard"]])
    several = len({group for group, *_ in reply["channels"]}) > 1
    recording.signals = tuple(
        _signal(path.name, recording, channel, several) for channel in reply["channels"]
    )
    if reply["frames"]:
        recording.nothing = (
            f"it holds bus frames ({', '.join(reply['frames'])}) and no physical signals: decode it with the "
            "database of the bus (DBC, ARXML), such as by asammdf's extract_bus_logging, and read the file "
            "that this writes"
        )
    yield recording


def _signal(
    file: str, recording: Recording, channel: tuple[int, int, str, str, int], several: bool
) -> Signal:
    group, index, full_name, unit, rows = channel
    name, ending = (full_name, unit) if unit else split_unit(full_name)

    def get() -> dict[str, FloatArray]:
        reply: dict[str, FloatArray] | str = _worker.ask(file, "get", group, index)
        if isinstance(reply, str):
            raise UnreadableLogError(f"channel '{full_name}' {reply}")
        count = reply["times"].size
        if reply["values"].size != count or count > rows:
            raise UnreadableLogError(
                f"channel '{full_name}' has {reply['values'].size} values at {count} times, not {rows}"
            )
        if count < rows and not recording.cut_off:
            recording.cut_off = True
            recording.notes.append(f"'{full_name}' has {count} of {rows} values: the rest is missing")
        return reply

    return Signal(
        name,
        ending,
        rows,
        lambda: get()["values"],
        lambda: get()["times"],
        f"group {group}",
        str(group) if several else "",
    )


class _Worker:
    """The process that runs asammdf, started for the first file and again after it was lost."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None

    def ask(self, file: str, *request: object) -> Any:
        """Return the reply to a request.

        Raises
        ------
        UnreadableLogError
            If asammdf is not installed, or the file brought its process down.
        """
        process = self._process or self._start()
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            pickle.dump(request, process.stdin)
            process.stdin.flush()
            return pickle.load(process.stdout)
        except (EOFError, OSError, pickle.UnpicklingError):
            self.stop()
            raise UnreadableLogError(f"{file} is damaged: asammdf broke down over it") from None
        except BaseException:  # interrupted half-way: what comes next would be the wrong reply
            self.stop()
            raise

    def stop(self) -> None:
        """End the process."""
        process, self._process = self._process, None
        if process is not None:
            with suppress(OSError):
                process.kill()
            process.communicate()

    def _start(self) -> subprocess.Popen[bytes]:
        if importlib.util.find_spec("asammdf") is None:
            raise missing_library("asammdf", "MF4 files")
        script = str(Path(__file__).with_name("mdf_worker.py"))
        # -P: without the folder of the script, whose modules would hide those of Python
        self._process = subprocess.Popen(
            [sys.executable, "-P", script],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        return self._process


_worker = _Worker()
atexit.register(_worker.stop)
