"""A synthetic log, or a campaign of units that age, with a known truth: ``hersey testbench``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from hersey.cli.options import (
    Force,
)
from hersey.cli.outputs import may_write, may_write_folder
from hersey.cli.progress import bar, working
from hersey.cli.terminal import say
from hersey.errors import OutputError, ParameterError

#: Largest log that `testbench --size` writes, bytes.
LARGEST_LOG = 4e9


def testbench(
    out: Annotated[Path | None, typer.Option("--out", help="The log to write; log.csv if not given.")] = None,
    truth: Annotated[
        Path | None, typer.Option("--truth", metavar="JSON", help="Also write the truth.")
    ] = None,
    seed: Annotated[int, typer.Option("--seed", help="Of all random draws.", min=0)] = 0,
    size: Annotated[
        str, typer.Option("--size", help="Least size of the log, as '1 GB': sampled faster.")
    ] = "",
    units: Annotated[
        int | None,
        typer.Option("--units", help="Write a campaign of so many units that age.", min=1, max=1000),
    ] = None,
    ages: Annotated[str, typer.Option("--ages", help="Of a campaign, as '0, 50, 100 kpages'.")] = "",
    out_dir: Annotated[
        Path | None,
        typer.Option("--out-dir", metavar="FOLDER", help="Of a campaign: runs.csv, truth.json, logs."),
    ] = None,
    machine: Annotated[
        Path | None,
        typer.Option(
            "--machine", metavar="TOML", help="That ages in a campaign; without it that of the example."
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Write a log of the virtual test stand: synthetic, with a known truth, for tests and for learning.

    With --units, a campaign: tables of means of units that age, at the ages given.

    Example: [bold]hersey testbench --out log.csv --truth truth.json --seed 7[/bold]
    """
    campaign = {"--units": units, "--ages": ages, "--out-dir": out_dir}
    if any(campaign.values()) or machine is not None:
        own = {"--out": out, "--truth": truth, "--size": size}
        _write_campaign(campaign, [flag for flag, given in own.items() if given], machine, seed, force)
        return
    out = out or Path("log.csv")
    replace = {out: may_write(out, force, ends=[".csv"])}
    if truth is not None:
        replace[truth] = may_write(truth, force, flag="--truth", ends=[".json"])
    if truth is not None and truth.absolute() == out.absolute():
        raise OutputError(f"--out and --truth both name {out}: name two files")

    import io

    from hersey import testbench as stand
    from hersey.files.writing import write_atomically

    if size:
        _write_long(out, _bytes(size), seed, replace[out])
        document = {**stand.run(seed=seed).truth_document(), "size": size}
    else:
        with working("running the virtual test stand"):
            log = stand.run(seed=seed)
            text = io.StringIO()
            log.write(text)
            write_atomically(out, text.getvalue(), overwrite=replace[out])
            document = log.truth_document()
    if truth is not None:
        write_atomically(truth, json.dumps(document, indent=1) + "\n", overwrite=replace[truth])
    say(f"synthetic log (seed {seed}): {out}")


def _write_campaign(
    given: dict[str, Any], stray: list[str], machine: Path | None, seed: int, force: bool
) -> None:
    lacking = [flag for flag, value in given.items() if not value]
    if lacking:
        raise ParameterError(
            f"a campaign needs {lacking[0]} too: --units 8 --ages '0, 50, 100 kpages' --out-dir campaign"
        )
    if stray:
        raise ParameterError(f"{stray[0]} is of a single log: a campaign is written into --out-dir")
    folder: Path = given["--out-dir"]
    may_write_folder(folder, force, flag="--out-dir")

    from hersey import testbench as stand
    from hersey.files.writing import write_all
    from hersey.machine.machine import read_machine
    from hersey.testbench.drive import example_drive

    ages = stand.ages_of(given["--ages"])
    drive, rest = example_drive()
    if machine is not None:
        drive = read_machine(machine)
        if drive.rest is None:
            raise ParameterError(f"{machine}: the drive takes something beside the film: state [rest]")
        rest = drive.rest
    population = stand.population(drive, rest, units=given["--units"], seed=seed)
    with bar("ageing", "units") as progress:
        files = stand.VirtualCampaign(population, ages, seed).files(progress)
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder} cannot be written: {error.strerror}") from None
    write_all({folder / name: text.encode() for name, text in files.items()}, overwrite=force)
    say(f"synthetic campaign (seed {seed}), {len(files) - 2} runs of {given['--units']} units: {folder}")


def _write_long(path: Path, size: int, seed: int, overwrite: bool) -> None:
    from hersey import testbench as stand
    from hersey.files.writing import written

    with written(path, overwrite=overwrite) as file, bar("writing") as progress:
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
