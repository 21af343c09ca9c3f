"""The commands of the tutorial and the how-to pages, and the files of the reader that they name."""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path

from tests.conftest import ROOT
from tests.damping.moving_logs import sine

DOCS = ROOT / "docs"
TUTORIAL = sorted((DOCS / "tutorial").glob("*.md"))
HOW_TO = sorted((DOCS / "how-to").glob("*.md"))
#: A block for a shell, and the comment before it if only a reader can type it.
_SHELL = re.compile(r"(?:<!-- (needs [^>]*) -->\n)?^```sh\n(.*?)^```$", re.DOTALL | re.MULTILINE)
#: Logs that differ from the shipped one by a factor of the torque alone.
_FACTORS = {"old-oil": 1, "new-oil": 0.99, "monday": 1, "tuesday": 1.01, "logs/1": 1, "logs/2": 1.02}
_HEADER = "Time [s],Drive torque [N*m],Drive speed [rpm],Heater temperature [degC]"


def commands(page: Path, *, all_of_them: bool = False) -> list[str]:
    """Return the commands of a page that work in a folder with the examples, or all of them."""
    blocks = _SHELL.findall(page.read_text(encoding="utf-8"))
    lines = [line for needs, block in blocks if all_of_them or not needs for line in block.splitlines()]
    return [line for line in lines if line.startswith("hersey ")]


def words(line: str) -> tuple[list[str], str]:
    """Return the arguments of a command, and the file to which its output goes."""
    typed, _, output = line.partition(" > ")
    return shlex.split(typed)[1:], output.strip()


def write_examples(folder: Path) -> None:
    """Copy what ``hersey examples`` copies into a folder, which may exist."""
    for path in (ROOT / "examples").iterdir():
        if path.name == "life":
            shutil.copytree(path, folder / path.name)
        elif path.suffix in {".csv", ".toml", ".json"}:
            shutil.copy(path, folder)


def table_of(page: str) -> str:
    """Return the table that a how-to page shows."""
    text = (DOCS / f"how-to/{page}.md").read_text()
    table = re.search(r"^```text\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    assert table is not None
    return table[1]


def write_files_of_a_reader(folder: Path) -> None:
    """Write the logs that how-to pages call by what is special about them, made of the shipped log."""
    lines = (folder / "bench.csv").read_text().splitlines()
    rows = [line.split(",") for line in lines[lines.index(_HEADER) + 1 :]]

    def write(name: str, header: str, rows: list[list[str]]) -> None:
        path = folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text("\n".join([header, *map(",".join, rows)]) + "\n")

    def times(factor: float) -> list[list[str]]:
        return [[t, f"{factor * float(torque):.5g}", *others] for t, torque, *others in rows]

    write("negative.csv", _HEADER, times(-1.0))
    write("no-units.csv", "Time,Torque,Speed,Temperature", rows)
    write("no-temperature.csv", _HEADER.rsplit(",", 1)[0], [row[:3] for row in rows])
    for name, factor in _FACTORS.items():
        write(f"{name}.csv", _HEADER, times(factor))
    stuck = [row for row in rows if 2.0 < float(row[2]) < 3.0]  # held for 32 s, sticking and slipping
    write("squeal.csv", _HEADER, stuck)
    for page, name in (("means", "means.csv"), ("joint-friction", "staircase.csv")):
        (folder / name).write_text(table_of(page))
    sine().to_frame().drop("run").write_csv(folder / "joint.csv")
