"""From a long log to the chosen law with its bootstrap, beside the way one would do it by hand.

By hand: read with polars, take ln(torque/speed) of every sample that turns, fit one power law with lmfit, and
again for each of the resampled logs. One such fit is timed, and multiplied.

Usage: python -m benchmarks.candidates [--size MB]
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import lmfit
import numpy as np
import polars as pl

import hersey
from benchmarks.lines import Line, in_turn
from hersey import testbench

BOOTSTRAP = 300


def by_hand(path: Path) -> tuple[float, float, int]:
    """Return seconds to read, seconds of one fit of one law to all samples, and how many samples."""
    begin = time.perf_counter()
    table = pl.read_csv(path, comment_prefix="#")
    names = table.columns
    found = {key: next(n for n in names if key in n.lower()) for key in ("torque", "speed", "temperature")}
    torque, speed, kelvin = (table[found[key]].to_numpy().astype(float) for key in found)
    read = time.perf_counter() - begin
    turns = (speed > 1.0) & (torque > 0)
    y, z, x = np.log(torque[turns] / speed[turns]), np.log(speed[turns]), np.log(kelvin[turns])
    parameters = lmfit.create_params(level=0.0, b=-1.0, c=-0.7)
    begin = time.perf_counter()
    lmfit.minimize(lambda p: y - p["level"] - p["b"] * x - p["c"] * z, parameters)
    return read, time.perf_counter() - begin, int(turns.sum())


@contextmanager
def long_log(size: int) -> Iterator[Path]:
    """Write a log of so many bytes, for a while."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log.csv"
        with path.open("w") as file:
            file.writelines(testbench.long_log(bytes_wanted=size, seed=1))
        yield path


def chosen(path: Path) -> tuple[float, float, hersey.ModelComparison, int]:
    """Return seconds to read, seconds to the chosen law, the comparison and the rows."""
    begin = time.perf_counter()
    log = hersey.read(path)
    read = time.perf_counter() - begin
    found = hersey.compare_models(log.steady(tare="standing"), bootstrap=BOOTSTRAP)
    return read, time.perf_counter() - begin, found, log.rows


def lines(runs: int, size: int = 27_000_000) -> list[Line]:
    """Return the way to the chosen law beside that by hand."""
    with long_log(size) as path:
        *_, compared, rows = chosen(path)
        fits = len(compared.candidates) + BOOTSTRAP

        def peer() -> float:
            read, one, _ = by_hand(path)
            return read + one * fits

        found = in_turn({"own": lambda: chosen(path)[1], "by hand": peer}, runs)
    work = f"models of {rows / 1e6:.1f} million rows, {BOOTSTRAP} resampled logs"
    peer_name = f"polars and lmfit, one fit times {fits}"
    return [Line(work, found["own"], peer_name, found["by hand"])]


def main() -> None:
    """Print a table in Markdown."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--size", type=float, default=270.0, help="MB; 270 are some 10 million samples")
    with long_log(int(1e6 * parser.parse_args().size)) as path:
        read, ours, found, rows = chosen(path)
        table, one, samples = by_hand(path)
    fits = len(found.candidates) + BOOTSTRAP
    print(f"{rows / 1e6:.1f} million samples, {samples / 1e6:.1f} million of them turning.\n")
    print("| way | read | to the chosen law with its bootstrap | ratio |\n|---|---|---|---|")
    print(
        f"| hersey, {len(found.candidates)} laws, {BOOTSTRAP} resampled logs "
        f"| {read:.1f} s | {ours:.1f} s | 1 |"
    )
    total = table + one * fits
    print(
        f"| polars and lmfit on every sample, one law: {one:.2f} s a fit, times {fits} | {table:.1f} s "
        f"| {total:.0f} s | {total / ours:.0f} |"
    )


if __name__ == "__main__":
    main()
