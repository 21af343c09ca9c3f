"""Damages sound files and reads them: ``make fuzz-read``.

An input is told by the seed of the run and its number alone; a failing one is kept, with how it was made.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import random
import struct
import sys
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import hersey
from hersey.document.saved_fit import read_fit
from hersey.errors import HerseyError
from hersey.log import list_channels
from hersey.log.mapping import read_mapping
from hersey.machine import read_machine, read_temperature_profile
from hersey.motion.scenario import read_scenario
from tests.untrusted_input.seeds import SEEDS
from tests.untrusted_input.watching import (
    children,
    listening_to_output,
    peak_memory,
    processor_time,
    temporary_files_in,
)

#: Readers of files that are no logs, by the seed.
OTHERS: dict[str, Callable[[Path], object]] = {
    "machine.toml": read_machine,
    "log.mapping.toml": read_mapping,
    "scenario.toml": read_scenario,
    "profile.csv": read_temperature_profile,
    "fit.json": read_fit,
}
TEXTS = {*OTHERS, "run.lvm", *(name for name in SEEDS if name.endswith((".csv", ".txt")))}
#: What an input may take: processor time in s, here and there; memory in bytes.
MOST_TIME, MOST_MEMORY = 5.0, 2.3e9
#: Share of the inputs that are inspected too, which costs more.
_INSPECTED = 0.2
_NUMBERS = (0, 1, 2, 255, 2**16 - 1, 2**31 - 1, 2**31, 2**32 - 1, 2**62, 2**63 - 1, 2**64 - 1)
_WORDS = (
    *(
        '"',
        '""',
        "'",
        ";",
        ",",
        "\t",
        "|",
        "\n",
        "\r",
        "\r\n",
        "\0",
        "#",
        "[",
        "]",
        "{",
        "}",
        "(",
        ")",
        "=",
        "\\",
    ),
    *(
        "nan",
        "inf",
        "-inf",
        "1e999",
        "1e-999",
        "9" * 400,
        "-",
        "--1",
        "1,5",
        "1.234,5",
        "0x10",
        "1_0",
        "٣",
        "\N{FULLWIDTH DIGIT TWO}",
    ),
    *("\ufeff", "\ud800", "\u2028", "\x1b[2J", "e\u0301", "N*m", "[rpm]", " " * 3000, "a.a.a", "12:00:00"),
    *("2024-03-01", "31.02.2024", "-0", "1e5", "true", "null", "[[", "\N{RIGHT-TO-LEFT OVERRIDE}"),
)
_ENCODINGS = ("utf-16", "utf-16-le", "utf-16-be", "utf-8-sig", "utf-32", "utf-7", "cp1252", "cp037")


def cut(data: bytes, draw: random.Random) -> bytes:
    return data[: draw.randrange(len(data) + 1)]


def flip(data: bytes, draw: random.Random) -> bytes:
    out = bytearray(data)
    for _ in range(draw.choice((1, 1, 2, 8))):
        out[draw.randrange(len(out))] ^= 1 << draw.randrange(8)
    return bytes(out)


def overwrite(data: bytes, draw: random.Random) -> bytes:
    out, place = bytearray(data), draw.randrange(len(data))
    rest = out[place : place + draw.choice((1, 4, 64))]
    out[place : place + len(rest)] = draw.choice(
        (bytes(len(rest)), b"\xff" * len(rest), draw.randbytes(len(rest)))
    )
    return bytes(out)


def splice(data: bytes, draw: random.Random, others: dict[str, bytes]) -> bytes:
    other = others[draw.choice(sorted(others))]
    return data[: draw.randrange(len(data))] + other[draw.randrange(len(other)) :]


def repeat(data: bytes, draw: random.Random) -> bytes:
    start = draw.randrange(len(data))
    block = data[start : start + draw.choice((1, 8, 100, 1000))]
    return data[:start] + block * draw.choice((2, 3, 50)) + data[start + len(block) :]


def delete(data: bytes, draw: random.Random) -> bytes:
    start = draw.randrange(len(data))
    return data[:start] + data[start + draw.choice((1, 2, 4, 8, 100, 1000)) :]


def lie(data: bytes, draw: random.Random) -> bytes:
    """Put another number in the place of one that looks like a length, a count or a place."""
    size = draw.choice((2, 4, 4, 8, 8))
    spots = [
        place
        for place in range(0, len(data) - size + 1, 2)
        if 0 < int.from_bytes(data[place : place + size], "little") <= max(len(data), 1000)
    ]
    if not spots:
        return flip(data, draw)
    place = draw.choice(spots)
    lied = draw.choice(_NUMBERS) & (256**size - 1)
    return data[:place] + lied.to_bytes(size, "little") + data[place + size :]


def lie_as_float(data: bytes, draw: random.Random) -> bytes:
    place = draw.randrange(max(1, len(data) // 8)) * 8
    number = draw.choice((np.nan, np.inf, -np.inf, 1e308, 5e-324, -1.0, 0.0))
    return data[:place] + struct.pack("<d", number) + data[place + 8 :]


def word(data: bytes, draw: random.Random) -> bytes:
    place = draw.randrange(len(data) + 1)
    word = draw.choice(_WORDS).encode(draw.choice(("utf-8", "utf-16-le")), errors="surrogatepass")
    return data[:place] + word + data[place + draw.choice((0, 0, 1, len(word))) :]


def cell(data: bytes, draw: random.Random) -> bytes:
    """Put a word in the place of a cell, of a number or of a key."""
    lines = data.split(b"\n")
    line = draw.randrange(min(len(lines), draw.choice((3, 30, len(lines)))))
    cells = lines[line].replace(b";", b",").replace(b"\t", b",").split(b",")
    old = draw.choice(cells)
    new = draw.choice(_WORDS).encode(errors="surrogatepass")
    lines[line] = lines[line].replace(old, new, 1) if old else lines[line] + new
    return b"\n".join(lines)


def separators(data: bytes, draw: random.Random) -> bytes:
    return data.replace(
        draw.choice((b",", b";", b"\t", b".", b"\n", b'"', b" ")), draw.choice((b",", b";", b"\t", b"|"))
    )


def encoding(data: bytes, draw: random.Random) -> bytes:
    text = data.decode("utf-8", errors="replace")
    return text.encode(draw.choice(_ENCODINGS), errors="replace")


_ALL = (cut, flip, flip, overwrite, repeat, delete)
_OF_BINARY = (*_ALL, lie, lie, lie, lie, lie_as_float)
_OF_TEXT = (*_ALL, word, word, cell, cell, separators, encoding)


class Input:
    """The damaged file of a number; ``recipe`` says how it was made."""

    def __init__(self, seed: int, number: int, sound: dict[str, bytes]) -> None:
        self.draw = draw = random.Random(f"{seed}:{number}")
        self.name = draw.choice(sorted(sound))
        self.data, done = sound[self.name], []
        for _ in range(draw.choice((1, 1, 1, 2, 3))):
            ways: tuple[Callable[..., bytes], ...] = _OF_TEXT if self.name in TEXTS else _OF_BINARY
            way = draw.choice((*ways, partial(splice, others=sound)))
            done.append(getattr(way, "__name__", "splice"))
            self.data = way(self.data or b"\0", draw)
        self.inspected = draw.random() < _INSPECTED
        self.recipe = f"--seed {seed} --only {number}: {self.name}, {', '.join(done)}"


class Fuzz:
    """Reads inputs one by one, and says of each what was wrong."""

    def __init__(self, folder: Path) -> None:
        """Take an empty folder: what is left in it by a reader is a failure."""
        self.folder, self.temporary = folder / "files", folder / "temporary"
        self.output = folder / "output"
        self.folder.mkdir(parents=True)
        self.temporary.mkdir()
        self.before = children()
        self.ends: Counter[str] = Counter()
        self.slowest = (0.0, "")

    def faults(self, one: Input) -> list[str]:
        """Return what was wrong with reading an input."""
        path = self.folder / one.name
        path.write_bytes(one.data)
        faults = []
        with listening_to_output(self.output), warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            for call in self.calls(one):
                before = processor_time()
                if fault := self.fault_of(call, path):
                    faults.append(f"{_name(call)}: {fault}")
                taken = processor_time() - before
                self.slowest = max(self.slowest, (taken, one.recipe))
                if taken > MOST_TIME:
                    faults.append(f"{_name(call)}: took {taken:.1f} s of processor time")
        faults += [f"warns: {warning.message}" for warning in warned]
        if printed := self.output.read_bytes():
            faults.append(f"printed {printed[:200]!r}")
        path.unlink()
        return faults + self.left()

    def calls(self, one: Input) -> list[Callable[[Path], object]]:
        if one.name in OTHERS:
            return [OTHERS[one.name]]
        return [list_channels, hersey.read, *([hersey.inspect] if one.inspected else [])]

    def fault_of(self, call: Callable[[Path], object], path: Path) -> str:
        """What was wrong with one call, in words; empty if nothing was."""
        try:
            result = call(path)
        except HerseyError as error:
            self.ends[type(error).__name__] += 1
            return _fault_of_message(str(error), path.name)
        except Exception as error:
            return f"{type(error).__name__}: {error!s:.300}"
        self.ends["read"] += 1
        if isinstance(result, hersey.Inspection):
            return "" if str(result).isprintable() or "\x1b" not in str(result) else "an escape in the text"
        return _fault_of_log(result) if isinstance(result, hersey.TorqueLog) else ""

    def left(self) -> list[str]:
        """What reading has left behind or held."""
        faults = []
        if files := [*self.folder.iterdir(), *self.temporary.iterdir()]:
            faults.append(f"left {files[:3]}")
        readers = set(children()) - set(self.before)
        if len(readers) > 1:
            faults.append(f"left {len(readers)} processes")
        if any(peak_memory(pid) > MOST_MEMORY for pid in ("self", *readers)):
            faults.append("took more memory than the limit")
        return faults


def _name(call: Callable[..., object]) -> str:
    return str(getattr(call, "__name__", call))


def _fault_of_message(message: str, name: str) -> str:
    if name not in message:
        return f"a message without the name of the file: {message[:200]!r}"
    if len(message.splitlines()) > 1:
        return f"a message of several lines: {message[:200]!r}"
    return "" if len(message) < 3000 else f"a message of {len(message)} characters: {message[:200]!r}"


def _fault_of_log(log: Any) -> str:
    for run in log.runs:
        arrays = [run.time, run.torque, run.speed, *([] if run.temperature is None else [run.temperature])]
        if not all(np.isfinite(values).all() for values in arrays):
            return "a log with what is no number"
        if np.any(np.diff(run.time) < 0):
            return "a log in which time falls"
        if len({values.shape for values in arrays}) > 1:
            return "a log with columns of different length"
    return ""


def sound_files(names: list[str] | None = None) -> dict[str, bytes]:
    """The seeds, made."""
    return {name: SEEDS[name]() for name in names or SEEDS}


def fuzz(
    seed: int,
    numbers: range,
    sound: dict[str, bytes],
    folder: Path,
    *,
    keep: Path | None = None,
    seconds: float = np.inf,
    told: Callable[[str], None] = lambda _: None,
) -> tuple[list[str], int, Fuzz]:
    """Read inputs; return what failed, how many were read, and the reader with its figures.

    ``keep`` is where failing inputs go; the run ends after so many ``seconds``.
    """
    end, failed = time.monotonic() + seconds, []
    reader = Fuzz(folder)
    count = 0
    with temporary_files_in(reader.temporary):
        for number in numbers:
            if time.monotonic() > end:
                break
            one = Input(seed, number, sound)
            count += 1
            if faults := reader.faults(one):
                failed.append(f"{one.recipe}: {'; '.join(faults)}")
                told(failed[-1])
                if keep is not None:
                    keep.mkdir(parents=True, exist_ok=True)
                    (keep / f"{seed}-{number}-{one.name}").write_bytes(one.data)
    return failed, count, reader


def main() -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=20_000)
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--only", type=int, help="one input of the run, by its number")
    parser.add_argument("--keep", type=Path, default=Path("build/fuzz"))
    given = parser.parse_args()
    numbers = range(given.count) if given.only is None else range(given.only, given.only + 1)
    keep = given.keep.resolve()
    say = partial(print, flush=True)
    say(f"seed {given.seed}, {len(numbers)} inputs, at most {given.minutes:g} min")
    started, cost = time.monotonic(), processor_time()
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        failed, count, reader = fuzz(
            given.seed, numbers, sound_files(), Path(folder) / "fuzz", keep=keep,
            seconds=60 * given.minutes, told=say,
        )  # fmt: skip
    ends = ", ".join(f"{count} {end}" for end, count in reader.ends.most_common())
    taken = time.monotonic() - started
    say(f"{count} inputs in {taken:.0f} s, {processor_time() - cost:.0f} s of processor time")
    say(f"ends: {ends}")
    say(f"the slowest took {reader.slowest[0]:.1f} s: {reader.slowest[1]}")
    say(f"failed: {len(failed)}" + (f", kept in {os.path.relpath(keep)}" if failed else ""))
    return bool(failed)


if __name__ == "__main__":
    sys.exit(main())
