"""What `hersey inspect` and `report` say of measurements by others: writes docs/validation/measurements.md.

Every file of a collection of public measurements that is a log, or could be taken for one, is given to both
commands with the options of its line. Where the report refuses, the advice of its message is read from the
message and followed, round after round. Nothing may end in a traceback or hang.

Usage: python -m benchmarks.validation [--folder ../shared/data] [--only NAME]
"""

from __future__ import annotations

import argparse
import contextlib
import fnmatch
import importlib
import itertools
import multiprocessing
import re
import sys
import tempfile
import traceback
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

from tests.cli import command

from benchmarks.advice import followed

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "validation" / "measurements.md"
#: Time that a command may take, s, and rounds of advice that are followed, at the most.
LIMIT, ROUNDS = 240, 12
#: Most characters of a sentence in the table.
WIDTH = 300


@dataclass(frozen=True)
class Line:
    """Files that are read together (one by one if ``each``), their source, and how they are read."""

    source: str
    files: str
    options: tuple[str, ...] = ()
    each: bool = False
    #: what no verdict on them may say, as a pattern
    never: str = ""


#: Text above the tables.
WORDS = """
`python -m benchmarks.validation` writes this page. It gives `hersey inspect` and `hersey report` every
file of a collection of public measurements that could be taken for a log. No command may end in a
traceback or hang, following the advice of a message must change the outcome, and no verdict may claim
a transition which the data cannot show. Long sentences are cut.
"""
LOGS = """
Options follow the description of the files.
"""
REFUSED = """
None of these files is a log of torque at three speeds or more. If a message proposes options, they are
followed, with its example values (25 mm, 35 mN m): this tests the advice, not the measurement.
"""
#: Heading of the part of the page that another benchmark measures.
_OTHERS = "## Tribometers with known laws"
#: Claims that need a transition in the log.
_TRANSITION = r"rises as the drive slows|can stick and slip"
_SCREW = ("--torque-unit", "-9.84 mN*m / 100", "--speed-unit", "-1 rpm", "--isothermal")
_TE67 = (
    "--torque", "Friction Force#1", "--torque-unit", "N", "--radius-unit", "mm", "--speed", "Speed",
    "--speed-unit", "rpm", "--temperature-unit", "degC", "--time", "Time",
)  # fmt: skip
_NEWPORT = ("--time", "#2", "--time-unit", "s", "--torque", "#4", "--torque-unit", "N*m", "--speed", "#6",
            "--speed-unit", "rev/s", "--isothermal")  # fmt: skip
LINES = (
    Line(
        "screw drive 1, RViMLab/TRO2021 (IEEE T-RO 37)",
        "friction/tro2021_screw_drives/driveNo1/steady_state/*.csv",
        (*_SCREW, "--rotation", "forward"),
    ),
    Line(
        "screw drive 2, RViMLab/TRO2021 (IEEE T-RO 37)",
        "friction/tro2021_screw_drives/driveNo2/steady_state/*.csv",
        (*_SCREW, "--rotation", "forward"),
        never=_TRANSITION,
    ),
    Line(
        "screw drive 1, starts and stops",
        "friction/tro2021_screw_drives/driveNo1/start_stop/*.csv",
        _SCREW,
        each=True,
        never=_TRANSITION,
    ),
    Line(
        "screw drive 2, starts and stops",
        "friction/tro2021_screw_drives/driveNo2/start_stop/*.csv",
        _SCREW,
        each=True,
        never=_TRANSITION,
    ),
    Line(
        "motor oil on glass, UEF-BBC-LUPE/NewportFrictionDataRead",
        "friction/newport_oil_stribeck/*/*.txt",
        _NEWPORT,
        never=_TRANSITION + r"|Stribeck curve\b.*(found|measured)",
    ),
    Line(
        "pin on disc TE67, kyembot/pin-on-disk-data-analysis",
        "friction/te67_pin_on_disc/*.tsv",
        _TE67,
        each=True,
        never=_TRANSITION + r"|exponent of damping is",
    ),
    Line(
        "Couette cell, cbosoft/pi_rheo_proj",
        "friction/couette_rheometer_pi/*.csv",
        each=True,
        never=_TRANSITION + r"|exponent of damping is",
    ),
    Line(
        "motor dynamometer, Capo01/odrive_based_electric_motor_dynamometer",
        "friction/odrive_motor_dyno/*.csv",
    ),
    Line("stick-slip slider, npusteln/stickslip (Colas et al. 2019)", "stick-slip/*.mat", each=True),
    Line("optical film thickness, moritzploss/tribology", "ehd-film/*.npz"),
    Line("rheometer, rheopy/rheofit", "rheology/rheofit_flow_curve/*.xls", each=True),
    Line("flow curves of the literature, rheopy", "rheology/literature_flow_curves/*.csv", each=True),
    Line("TDMS, adamreeve/npTDMS", "daq-formats/tdms/*.tdms", each=True),
    Line("MDF 4.10, danielhrisca/asammdf", "daq-formats/mf4/*.mf4", each=True),
    Line("MDF of a CAN bus, CSS-Electronics/api-examples", "daq-formats/mf4-bus/*.MF4", each=True),
    Line("MATLAB, scipy", "daq-formats/mat/*.mat", each=True),
    Line("HDF5, h5py", "daq-formats/hdf5/*.h5", each=True),
    Line("LabVIEW LVM", "daq-formats/lvm/*.txt", each=True),
    Line("reference tables", "tables/*.csv", each=True),
    Line("NIST StRD", "nist-strd/*.dat", each=True),
)


#: Precedes the outcome of the options that a message proposed.
FOLLOWED = "after its advice: "


@dataclass(frozen=True)
class Row:
    """One line of the table."""

    source: str
    name: str
    options: str
    inspected: str
    reported: str
    wrong: str


def main() -> int:
    """Walk the collection and write the page; 1 if a command failed or a verdict claims too much."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--folder", type=Path, default=ROOT.parent / "shared" / "data")
    parser.add_argument(
        "--only", default="*", help="lines whose files match this pattern; nothing is written"
    )
    given = parser.parse_args()
    if not given.folder.is_dir():
        print("the collection of public measurements is not here: nothing to do")
        return 0
    for room in ("inspection", "document.assembly", "report.page"):  # once, not in every process
        importlib.import_module(f"hersey.{room}")
    rows = []
    for line in LINES:
        if not fnmatch.fnmatch(line.files, given.only):
            continue
        for files in groups(line, given.folder):
            rows.append(row_of(line, files))
            print(*(f"{k}: {v}" for k, v in vars(rows[-1]).items()), "", sep="\n", flush=True)
    if given.only == "*":
        before = PAGE.read_text()
        PAGE.write_text(page(rows).rstrip("\n") + "\n\n" + before[before.index(_OTHERS) :])
    for row in rows:
        if row.wrong:
            print(f"{row.name}: {row.wrong}", file=sys.stderr)
    return int(any(row.wrong for row in rows))


def groups(line: Line, folder: Path) -> list[list[Path]]:
    """Files of a line: together, or one by one."""
    files = sorted(folder.glob(line.files))
    return [[file] for file in files] if line.each else [files] if files else []


def row_of(line: Line, files: list[Path]) -> Row:
    """What both commands say of some files."""
    told: list[str] = []
    arguments = ["report", *map(str, files), *line.options]
    code, said = run(arguments)
    wrong = fault(code, said)
    followed_so_far: list[str] = []
    while code == 2 and not wrong and len(followed_so_far) < ROUNDS:
        if not told or told[-1] != one_line(said):
            told.append(one_line(said))
        proposals = [p for p in followed(arguments, said) if p != arguments]
        if not proposals:
            break
        before = said
        arguments = proposals[0]
        followed_so_far.append(" ".join(added(["report", *map(str, files), *line.options], arguments)))
        code, said = run(arguments)
        wrong = fault(code, said)
        if said == before:
            wrong = f"advice changes nothing: {one_line(said)}"
    if code == 0:
        verdict = first_sentences(said)
        told = [
            *(f"refused: {reason(t)}" for t in told[:1]),
            *([f"{FOLLOWED}{verdict}"] if told else [verdict]),
        ]
    else:
        told = [f"refused: {reason(told[0] if told else said)}"] + (
            [f"{FOLLOWED}{reason(told[-1])}"] if followed_so_far and len(told) > 1 else []
        )
    if line.never and code == 0 and re.search(line.never, said):
        wrong = "the verdict claims what cannot be claimed"
    code, looked = run(["inspect", *arguments[1:]])
    wrong = wrong or fault(code, looked)
    name = files[0].name if len(files) == 1 else f"{len(files)} files"
    return Row(
        line.source,
        name,
        quoted(" ".join(added([], [*line.options]))),
        inspected(looked),
        "<br>".join(told),
        wrong,
    )


def added(before: list[str], after: list[str]) -> list[str]:
    """What was put to a command."""
    return [f"'{word}'" if re.search("[ #]", word) else word for word in after if word not in before]


def run(arguments: list[str]) -> tuple[int, str]:
    """Exit code of a command, and what it says; 124 if it takes too long."""
    ours, theirs = multiprocessing.Pipe(duplex=False)
    child = multiprocessing.get_context("fork").Process(target=typed, args=(arguments, theirs))
    child.start()
    theirs.close()
    told = None
    if ours.poll(LIMIT):
        with contextlib.suppress(EOFError):
            told = ours.recv()
    child.kill()
    child.join()
    if told is None:
        return 124, f"no answer within {LIMIT} s, or the process died"
    code, out, error = told
    return code, out if code == 0 else error.strip()


def typed(arguments: list[str], answer: Connection) -> None:
    """Type a command in a folder of its own, in a process of its own, and hand on what it left."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            done = command.run(*arguments, cwd=Path(folder))
            answer.send((done.returncode, done.stdout, done.stderr))
        except Exception:  # what no command should end in
            answer.send((1, "", traceback.format_exc()))


def fault(code: int, said: str) -> str:
    """What is wrong with how a command ended, or nothing."""
    if code not in (0, 2):
        return f"ended with {code}: {one_line(said)[-200:]}"
    return (
        "more than one line"
        if code == 2 and len([x for x in said.splitlines() if x.startswith("hersey: ")]) != 1
        else ""
    )


def one_line(text: str) -> str:
    """Return a refusal without the name of the program, folders and long lists."""
    line = next(
        (x for x in reversed(text.splitlines()) if x.startswith("hersey: ")),
        text.strip().splitlines()[-1] if text.strip() else "",
    )
    line = re.sub(r"(?<![\w])/(?:[\w.+-]+/)+", "", line.removeprefix("hersey: "))
    return re.sub(r"(among|it has) '?[^:]*?, [^:]*?(?=: |$)", r"\1 its channels", line)


def reason(line: str) -> str:
    """Return the first clause of a refusal, without the place that it is about."""
    line = re.sub(r"^\S+\.\w+[:,]? |^hersey: ", "", line)
    line = re.sub(r"^line \d+(, column '[^']*')?: ", "", line)
    line = re.sub(r"'[^']*'", "'...'", line)
    return re.split(r": |; | \(| among |, only |, such |[.] (?=[A-Z])", line)[0]


def first_sentences(said: str) -> str:
    """Return the first two sentences of a report."""
    lines = itertools.takewhile(lambda line: line and line[0] not in "-[", said.splitlines())
    found = re.match(r"(?:.*?[a-z0-9)%\]][.](?= [A-Z]|$)){1,2}", " ".join(lines))
    return cut(found[0]) if found else ""


def cut(text: str) -> str:
    """Return a text of at most `WIDTH` characters."""
    return text if len(text) <= WIDTH else text[: WIDTH - 3] + "..."


def inspected(text: str) -> str:
    """What an inspection says in one line: dwells, what can be told, or why no fit is possible."""
    lines = text.splitlines()
    problem = next((x for x in lines if x.startswith("No fit is possible")), "")
    if problem:
        return one_line(problem)
    if not any(re.match(r"\d+ dwells", x) for x in lines):
        return one_line(text)
    dwells = next(x for x in lines if re.match(r"\d+ dwells", x))
    can = [x.removeprefix("  can show").strip() for x in lines if x.startswith("  can show")]
    lost = "  cannot show"
    cannot = [x.removeprefix(lost).strip() for x in lines if x.startswith(lost)]
    told = f"{dwells}. Can show {'; '.join(can) or 'nothing'}"
    told = cut(told)
    return f"{told}. Cannot show {len(cannot)} things" if cannot else told


def by_reason(rows: list[Row]) -> dict[tuple[str, ...], dict[str, int]]:
    """Return how many files of each source are refused for a reason."""
    found: dict[tuple[str, ...], dict[str, int]] = {}
    named: dict[tuple[str, ...], tuple[str, ...]] = {}
    for row in rows:
        if not row.reported.startswith("refused: "):
            continue
        clauses = tuple(row.reported.removeprefix("refused: ").split(f"<br>{FOLLOWED}"))
        key = named.setdefault(tuple(re.sub(r"\d[\d.]*", "", each) for each in clauses), clauses)
        sources = found.setdefault(key, {})
        sources[row.source] = sources.get(row.source, 0) + 1
    return found


def quoted(text: str) -> str:
    """Options as code, or nothing."""
    return f"`{text}`" if text else ""


def page(rows: list[Row]) -> str:
    """Return the page as Markdown."""
    logs = [
        [row.source, row.name, row.options, row.reported]
        for row in rows
        if not row.reported.startswith("refused: ")
    ]
    refused = [
        [first, rest[0] if rest else "", "; ".join(f"{source} ({n})" for source, n in sources.items())]
        for (first, *rest), sources in by_reason(rows).items()
    ]
    return "\n".join(
        [
            "# Measurements by others",
            WORDS,
            "## Logs with a report",
            LOGS,
            table("source", "files", "options", "report", rows=logs),
            "",
            "## Refused files",
            REFUSED,
            table("reason", "after its advice", "files", rows=refused),
            "",
        ]
    )


def table(*heads: str, rows: list[list[str]]) -> str:
    """Return rows of cells as a table with these headings."""
    cells = [[cell.replace("|", "\\|").replace("\n", " ") for cell in row] for row in rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in [list(heads), ["---"] * len(heads), *cells])


if __name__ == "__main__":
    sys.exit(main())
