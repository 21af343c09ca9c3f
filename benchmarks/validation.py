"""What `hersey inspect` and `hersey report` say of measurements by others: writes docs/validation.md.

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
PAGE = ROOT / "docs" / "validation.md"
#: Time that a command may take, s, and rounds of advice that are followed, at the most.
LIMIT, ROUNDS = 240, 12
#: Characters of what a command says that stand in the table.
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


#: What stands above the table.
WORDS = """
Written by `python -m benchmarks.validation`: what `hersey inspect` and `hersey report` say of each file
of the collection of public measurements that is a log or could be taken for one. The options are those
that the files need by their description. Where a report is refused, the options that its message proposes
are read from the message and followed, and the outcome stands below the first refusal; where none is
proposed, the refusal is the end. The example values of a proposal (25 mm, 35 mN m) are taken as they
stand: such a line shows that the advice works, not what was measured.
"""
#: What nothing but a log of a transition may be told.
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
        PAGE.write_text(page(rows))
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
        verdict = first_sentence(said)
        told = [
            *(f"refused: {t}" for t in told[:1]),
            *([f"with {quoted(followed_so_far[-1])}: {verdict}"] if told else [verdict]),
        ]
    else:
        told = [f"refused: {told[0] if told else said}"] + (
            [f"with {quoted(followed_so_far[-1])}: {told[-1]}"] if followed_so_far and len(told) > 1 else []
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
    """A refusal without the name of the program and of folders, cut."""
    line = next(
        (x for x in reversed(text.splitlines()) if x.startswith("hersey: ")),
        text.strip().splitlines()[-1] if text.strip() else "",
    )
    line = re.sub(r"(?<![\w])/(?:[\w.+-]+/)+", "", line.removeprefix("hersey: "))
    line = re.sub(r"(among|it has) '?[^:]*?, [^:]*?(?=: |$)", r"\1 its channels", line)
    return line if len(line) <= WIDTH else line[: WIDTH - 3] + "..."


def first_sentence(said: str) -> str:
    """The first sentence of a verdict."""
    first = said.splitlines()[0]
    match = re.match(r".*?[a-z)%\]][.](?= [A-Z]|$)", first)
    return match[0] if match else first[:WIDTH]


def inspected(text: str) -> str:
    """What an inspection says in one line: dwells, what can be told, or why no fit is possible."""
    lines = text.splitlines()
    problem = next((x for x in lines if x.startswith("No fit is possible")), "")
    if problem:
        return one_line(problem)
    if not any(re.match(r"\d+ dwells", x) for x in lines):
        return one_line(text)
    dwells = next(x for x in lines if re.match(r"\d+ dwells", x))
    can = [x.removeprefix("  can determine").strip() for x in lines if x.startswith("  can determine")]
    lost = "  cannot determine"
    cannot = [x.removeprefix(lost).strip() for x in lines if x.startswith(lost)]
    told = f"{dwells}. Can determine {'; '.join(can) or 'nothing'}"
    told = told if len(told) <= WIDTH else told[: WIDTH - 3] + "..."
    return f"{told}. Cannot determine {len(cannot)} things" if cannot else told


def merged(rows: list[Row]) -> list[Row]:
    """Rows of one source of which the same is said, as one."""
    alike: dict[tuple[str, ...], list[Row]] = {}
    for row in rows:
        said = tuple(cell.replace(row.name, "the file") for cell in (row.inspected, row.reported))
        alike.setdefault((row.source, row.options, *said), []).append(row)
    return [
        rows[0]
        if len(rows) == 1
        else Row(key[0], f"{len(rows)} files, each: {listed(rows)}", key[1], key[2], key[3], "")
        for key, rows in alike.items()
    ]


def listed(rows: list[Row]) -> str:
    """The names of some files, the first and the last where they are many."""
    names = [row.name for row in rows]
    return ", ".join(names) if len(names) < 4 else f"{names[0]} to {names[-1]}"


def quoted(text: str) -> str:
    """Options as code, or nothing."""
    return f"`{text}`" if text else ""


def page(rows: list[Row]) -> str:
    """The page as Markdown."""
    head = [
        "# Measurements by others",
        "",
        *WORDS.strip().splitlines(),
        "",
        "| source | file | options | inspect | report |",
        "|---|---|---|---|---|",
    ]
    body = [
        "| "
        + " | ".join(
            cell.replace("|", "\\|").replace("\n", " ")
            for cell in (r.source, r.name, r.options, r.inspected, r.reported)
        )
        + " |"
        for r in merged(rows)
    ]
    return "\n".join([*head, *body, ""])


if __name__ == "__main__":
    sys.exit(main())
