"""A synthetic log, or a campaign of ageing specimens, with a known truth: ``hersey testbench``."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from hersey.cli.groups import grouped, option
from hersey.cli.options import Force
from hersey.cli.outputs import may_write, may_write_folder
from hersey.cli.printing import Quiet
from hersey.cli.progress import bar, working
from hersey.errors import OutputError, ParameterError

#: Largest log that `testbench --size` writes, bytes.
LARGEST_LOG = 4e9
_OUT = "Write the log here.  [default: log.csv]"
_SIZE = "Write a log of at least this size, e.g. '1 GB', by faster sampling."
_UNITS = "Write a campaign with this number of ageing specimens instead of a log."
_AGES = "Ages of the campaign, e.g. '0, 50, 100 kpages'."
_OUT_DIR = "Folder of the campaign: runs.csv, truth.json and the logs."
_MACHINE = "Machine file of the campaign.  [default: the example]"


@dataclass(frozen=True)
class _Log:
    """A single log."""

    out: Annotated[Path | None, option(_OUT, metavar="CSV")] = None
    truth: Annotated[Path | None, option("Write the true values.", metavar="JSON")] = None
    seed: Annotated[int, option("Random seed.", min=0)] = 0
    size: Annotated[str, option(_SIZE)] = ""

    def write(self, force: bool, printing: Quiet) -> None:
        """Write the log, and the truth if it is asked for."""
        import io

        out, truth = self.out or Path("log.csv"), self.truth
        written = may_write(out, force, ends=[".csv"])
        also = may_write(truth, force, flag="--truth", ends=[".json"])
        if truth is not None and truth.absolute() == out.absolute():
            raise OutputError(f"--out and --truth both name {out}: name two different files")

        from hersey import testbench as stand

        if self.size:
            _write_long(out, _bytes(self.size), self.seed, written.replace)
            document = {**stand.run(seed=self.seed).truth_document(), "size": self.size}
        else:
            with working("running the virtual test stand"):
                log = stand.run(seed=self.seed)
                text = io.StringIO()
                log.write(text)
                written.write(text.getvalue())
                document = log.truth_document()
        if truth is not None:
            also.write(json.dumps(document, indent=1) + "\n")
        printing.text(f"Synthetic log, seed {self.seed}")
        printing.files(out, truth)


@dataclass(frozen=True)
class _Campaign:
    """A campaign of ageing specimens."""

    units: Annotated[int | None, option(_UNITS, min=1, max=1000)] = None
    ages: Annotated[str, option(_AGES)] = ""
    out_dir: Annotated[Path | None, option(_OUT_DIR, metavar="FOLDER")] = None
    machine: Annotated[Path | None, option(_MACHINE, metavar="TOML")] = None

    def refuse_part(self, single: _Log) -> None:
        """Refuse a campaign that lacks an option, or that has one of a single log."""
        needed = {"--units": self.units, "--ages": self.ages, "--out-dir": self.out_dir}
        lacking = [flag for flag, value in needed.items() if not value]
        if lacking:
            raise ParameterError(
                f"a campaign also needs {lacking[0]}: "
                "e.g. --units 8 --ages '0, 50, 100 kpages' --out-dir campaign"
            )
        stray = {"--out": single.out, "--truth": single.truth, "--size": single.size}
        for flag in (flag for flag, given in stray.items() if given):
            raise ParameterError(f"{flag} is for a single log: omit it, a campaign is written into --out-dir")

    def write(self, seed: int, force: bool, printing: Quiet) -> None:
        """Write all files of the campaign."""
        assert self.out_dir is not None
        assert self.units is not None
        folder = self.out_dir
        may_write_folder(folder, force, flag="--out-dir")

        from hersey import testbench as stand
        from hersey.files.writing import write_all
        from hersey.machine.machine import read_machine
        from hersey.testbench.drive import example_drive

        ages = stand.ages_of(self.ages)
        drive, rest = example_drive()
        if self.machine is not None:
            drive = read_machine(self.machine)
            if drive.rest is None:
                raise ParameterError(f"{self.machine} has no no-load torque: add [rest]")
            rest = drive.rest
        population = stand.population(drive, rest, units=self.units, seed=seed)
        with bar("ageing", "specimens") as progress:
            files = stand.VirtualCampaign(population, ages, seed).files(progress)
        try:
            folder.mkdir(exist_ok=True)
        except OSError as error:
            raise OutputError(f"{folder} cannot be written: {error.strerror}") from None
        write_all({folder / name: text.encode() for name, text in files.items()}, overwrite=force)
        of = f"{self.units} specimen{'s' * (self.units > 1)}"
        printing.text(f"Synthetic campaign, seed {seed}: {len(files) - 2} runs of {of}")
        printing.files(folder)


@grouped
def testbench(*, log: _Log, campaign: _Campaign, printing: Quiet, force: Force = False) -> None:
    """Write a synthetic log with known true values, for tests and for learning.

    With --units, write a campaign: tables of means of ageing specimens, at the given ages.

    Example: [bold]hersey testbench --out log.csv --truth truth.json --seed 7[/bold]
    """
    if campaign == _Campaign():
        log.write(force, printing)
    else:
        campaign.refuse_part(log)
        campaign.write(log.seed, force, printing)


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
        raise ParameterError(f"--size '{text}' is not a size: write e.g. '1 GB' or '20 MB'")
    size = float(match[1]) * {"": 1, "k": 1e3, "M": 1e6, "G": 1e9}[match[2]]
    if size > LARGEST_LOG:
        raise ParameterError(f"--size '{text}' is too large: at most {LARGEST_LOG / 1e9:g} GB fit in memory")
    return int(size)
