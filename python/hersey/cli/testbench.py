"""A synthetic log with a known truth: ``hersey testbench``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from hersey.cli.options import (
    Force,
)
from hersey.cli.outputs import may_write
from hersey.cli.progress import bar, working
from hersey.cli.terminal import say
from hersey.errors import OutputError, ParameterError

#: Largest log that `testbench --size` writes, bytes.
LARGEST_LOG = 4e9


def testbench(
    out: Annotated[Path, typer.Option("--out", help="The log to write.")] = Path("log.csv"),
    truth: Annotated[
        Path | None, typer.Option("--truth", metavar="JSON", help="Also write the truth.")
    ] = None,
    seed: Annotated[int, typer.Option("--seed", help="Of all random draws.", min=0)] = 0,
    size: Annotated[
        str, typer.Option("--size", help="Least size of the log, as '1 GB': sampled faster.")
    ] = "",
    force: Force = False,
) -> None:
    """Write a log of the virtual test stand: synthetic, with a known truth, for tests and for learning.

    Example: [bold]hersey testbench --out log.csv --truth truth.json --seed 7[/bold]
    """
    for path in (out, truth):
        if path is not None:
            may_write(path, force)
    if truth is not None and truth.absolute() == out.absolute():
        raise OutputError(f"--out and --truth both name {out}: name two files")

    import io

    from hersey import testbench as stand
    from hersey.files.writing import write_atomically

    if size:
        _write_long(out, _bytes(size), seed)
        document = {**stand.run(seed=seed).truth_document(), "size": size}
    else:
        with working("running the virtual test stand"):
            log = stand.run(seed=seed)
            text = io.StringIO()
            log.write(text)
            write_atomically(out, text.getvalue(), overwrite=True)
            document = log.truth_document()
    if truth is not None:
        write_atomically(truth, json.dumps(document, indent=1) + "\n", overwrite=True)
    say(f"synthetic log (seed {seed}): {out}")


def _write_long(path: Path, size: int, seed: int) -> None:
    from hersey import testbench as stand
    from hersey.files.writing import written

    with written(path, overwrite=True) as file, bar("writing") as progress:
        done = 0
        for text in stand.long_log(bytes_wanted=size, seed=seed):
            done += file.write(text.encode())
            progress(min(done, size), size)


def _bytes(text: str) -> int:
    import re

    match = re.fullmatch(r"\s*(\d+(?:\.\d+)?)\s*([kMG]?)B\s*", text)
    if match is None:
        raise ParameterError(f"--size '{text}' is not a size: write it as '1 GB' or '20 MB'")
    size = float(match[1]) * {"": 1, "k": 1e3, "M": 1e6, "G": 1e9}[match[2]]
    if size > LARGEST_LOG:
        raise ParameterError(f"--size '{text}' is more than the {LARGEST_LOG / 1e9:g} GB that fit in memory")
    return int(size)
