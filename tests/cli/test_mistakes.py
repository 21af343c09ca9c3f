"""Ordinary mistakes: each message says what, where and a way out, which is read from it, followed, and works.

No way out is typed here again: options, keys and file names are taken from the message (`benchmarks.advice`),
and what it says of a file (a key to write, a mark between columns) is done to the file.
"""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import pytest
from benchmarks.advice import followed

from tests.cli.command import Done, run
from tests.conftest import mostly_nightly
from tests.untrusted_input.other_blocks import xlsx

#: An advice works where the command ends well; what is fitted is the matter of other tests.
pytestmark = pytest.mark.usefixtures("roughly")

HEADER = ("Time [s]", "Torque [N*m]", "Speed [rpm]", "Temperature [degC]")
#: Rounds of advice at the most: a file may have two mistakes.
ROUNDS = 4
Row = tuple[float, ...]

MACHINE = """[drivetrain]
stiffness = "11 N/mm"
mass = "11 kg"
roll_radius = "15 mm"
stick_speed = "0.3 mm/s"
"""


class Refused(NamedTuple):
    """A command that was refused: its folder, what was typed, and the message."""

    folder: Path
    arguments: list[str]
    message: str


#: What is typed next, once what the message says is done to the files.
WayOut = Callable[[Refused], list[str]]


def drag(speed: float, temperature: float) -> float:
    """Torque of a film, N m, of a speed in rpm and a temperature in degC."""
    return 0.05 * speed**0.35 * (150.0 / temperature) ** 0.8 if speed > 0 else 0.0


def rows(
    speeds: tuple[float, ...] = (10, 20, 40, 80, 120),
    temperatures: tuple[float, ...] = (100, 130, 160),
    *,
    each: int = 60,
    step: float = 0.1,
) -> list[Row]:
    """A staircase with a ripple of 1 % in place of noise: time, torque, speed, temperature."""
    stairs = [(w, t) for t in temperatures for w in speeds for _ in range(each)]
    return [(i * step, drag(w, t) * (1 + 0.002 * ((i * 7) % 5)), w, t) for i, (w, t) in enumerate(stairs)]


def table(lines: Sequence[Row], *header: str, mark: str = ",", number: str = "{:.6g}") -> str:
    """A log as text."""
    body = [mark.join(number.format(x) for x in line) for line in lines]
    return "\n".join([mark.join(header or HEADER), *body]) + "\n"


def column(index: int, change: Callable[[float], float], lines: list[Row] | None = None) -> list[Row]:
    """The staircase with one column changed."""
    taken = rows() if lines is None else lines
    return [tuple(change(x) if i == index else x for i, x in enumerate(line)) for line in taken]


def named(index: int, title: str) -> str:
    """The staircase with another title of one column."""
    return table(rows(), *(title if i == index else each for i, each in enumerate(HEADER)))


def spoilt(every: int, cell: str, first: int = 1) -> str:
    """The staircase with a word in place of the torque in every so-manieth row."""
    lines = table(rows()).splitlines()
    for i in range(first, len(lines), every):
        cells = lines[i].split(",")
        lines[i] = ",".join([cells[0], cell, *cells[2:]])
    return "\n".join(lines) + "\n"


#: Torque alone has decimals, after a comma as between the columns.
DECIMALS_OF_TORQUE = "Time [ms],Torque [mN*m],Speed [rpm],Temperature [degC]\n" + "".join(
    f"{1000 * t:.0f},{1000 * torque:.1f},{w:.0f},{kelvin:.0f}\n".replace(".", ",")
    for t, torque, w, kelvin in rows()
)


def typed(it: Refused) -> list[str]:
    """Follow the first proposal of the message that can be typed."""
    proposals = followed(it.arguments, it.message)
    assert proposals, f"nothing to type in: {it.message}"
    return proposals[0]


def unwrapped(text: str) -> list[str]:
    """The lines of a text as they were before a terminal's width broke them."""
    return re.sub(r"\n {2,}", " ", text).splitlines()


def key_renamed(it: Refused) -> list[str]:
    """Write the key that was meant for the one that is none, in the file that is named."""
    match = re.search(
        r"hersey: (\S+?)(?:, line \d+)?: .*unknown (?:key|table) '(\w+)'. Did you mean \[?'?(\w+)", it.message
    )
    assert match
    path = it.folder / match[1]
    path.write_text(path.read_text().replace(match[2], match[3], 1))
    return it.arguments


def value_replaced(it: Refused) -> list[str]:
    """Write the example of the message for the value of the key that it names."""
    match = re.search(r"hersey: (\S+?)(?:, line \d+)?: \w+\.(\w+) is .*e\.g\. (\S+)$", it.message)
    assert match
    path = it.folder / match[1]
    path.write_text(re.sub(rf"{match[2]} = .*", f"{match[2]} = {match[3]}", path.read_text()))
    return it.arguments


def table_added(it: Refused) -> list[str]:
    """Add the table with the keys that the message gives as examples."""
    match = re.search(r"hersey: (\S+): .*add (\[\w+\]) with your values, e.g. (.*)$", it.message)
    assert match
    with (it.folder / match[1]).open("a") as file:
        file.write("\n".join(["", match[2], *match[3].split("; "), ""]))
    return it.arguments


def marked(it: Refused) -> list[str]:
    """Export the log with the mark between columns that the message names, numbers as they were."""
    match = re.search(r"hersey: (\S+), .*with '(.)' between the columns", it.message)
    assert match
    path = it.folder / match[1]
    header, *lines = path.read_text().splitlines()
    number = r"\d+,\d{3}(?=,)" if "decimal commas" in it.message else r"\d[\d,]*\.\d(?=,)"
    parts = [re.findall(number, line + ",") for line in lines]
    path.write_text("\n".join([header.replace(",", match[2]), *map(match[2].join, parts)]) + "\n")
    return it.arguments


def marked_in_one(it: Refused) -> list[str]:
    """Export the log with the mark between columns that the message names; torque has decimal commas."""
    match = re.search(r"hersey: (\S+), .*with '(.)' between the columns", it.message)
    assert match
    path = it.folder / match[1]
    header, *lines = path.read_text().splitlines()
    parts = [re.sub(r"^(\d+),(\d+,\d),(\d+),(\d+)$", r"\1;\2;\3;\4", line) for line in lines]
    path.write_text("\n".join([header.replace(",", match[2]), *parts]) + "\n")
    return it.arguments


def split_there(it: Refused) -> list[str]:
    """Split the file at the line that the message names."""
    match = re.search(r"hersey: (\S+), line (\d+): .*Split the file there", it.message)
    assert match
    lines = (it.folder / match[1]).read_text().splitlines()
    cut = int(match[2]) - 1
    (it.folder / "first.csv").write_text("\n".join(lines[:cut]) + "\n")
    (it.folder / "second.csv").write_text("\n".join([lines[0], *lines[cut:]]) + "\n")
    return ["fit", "first.csv", "second.csv"]


def lines_deleted(it: Refused) -> list[str]:
    """Delete the lines that the message names."""
    match = re.search(r"hersey: (\S+): .*Delete the rows from line (\d+) to line (\d+)", it.message)
    assert match
    lines = (it.folder / match[1]).read_text().splitlines()
    (it.folder / match[1]).write_text("\n".join(lines[: int(match[2]) - 1] + lines[int(match[3]) :]) + "\n")
    return it.arguments


def recorded(it: Refused) -> list[str]:
    """Record what the message asks for: dwells as long as it says, at as many speeds, or slower ones."""
    lasts = re.search(r"[Hh]old (?:one|each) speed for at least ([\d.]+) s", it.message)
    three = "at three or more speeds" in it.message
    of_other = re.search(
        r"csv covers ([\d.]+) to ([\d.]+) rpm.*Record one at speeds of the other", it.message
    )
    assert lasts or three or of_other, it.message
    slow, fast = map(float, of_other.groups()) if of_other else (10.0, 120.0)
    each = round(3 * float(lasts[1]) / 0.1) if lasts else 60
    speeds = (
        (slow, (slow * fast) ** 0.5, fast)
        if three
        else tuple(slow * (fast / slow) ** (i / 4) for i in range(5))
    )
    (it.folder / "log.csv").write_text(table(rows(speeds, each=each)))
    return it.arguments


def line_typed(it: Refused) -> list[str]:
    """Type the whole line of the message."""
    return shlex.split(it.message.partition(" Type: hersey ")[2])


def with_unit(it: Refused) -> list[str]:
    """Write the number with the unit that the message shows."""
    match = re.search(r"(--[\w-]+) \S+ has no unit, .*: write '([^']*)'", it.message)
    assert match
    at = it.arguments.index(match[1]) + 1
    return [*it.arguments[:at], match[2], *it.arguments[at + 1 :]]


def example_taken(it: Refused) -> list[str]:
    """Write the example of the message for what it quotes."""
    match = re.search(r"'([^']*)' is not a number with a unit of \w+\. Write e\.g\. '([^']*)'", it.message)
    assert match
    return [match[2] if argument == match[1] else argument for argument in it.arguments]


def ending_taken(it: Refused) -> list[str]:
    """Take the first ending that the message lists."""
    match = re.search(r"--\w+ (\S+): name a file that ends in (\.\w+)", it.message)
    assert match
    return [Path(a).stem + match[2] if a == match[1] else a for a in it.arguments]


def named_once(it: Refused) -> list[str]:
    """Name each file once; the one that is named is too many."""
    assert it.message.endswith("Give each file once")
    many = it.message.split()[1]
    last = len(it.arguments) - 1 - it.arguments[::-1].index(many)
    return [*it.arguments[:last], *it.arguments[last + 1 :]]


def given_as(it: Refused) -> list[str]:
    """Give a file by the option that the message names, in place of the one it was given by."""
    match = re.search(r"hersey: (\S+) is .* Give it as (--\w+) '?([^']*)'?$", it.message)
    assert match
    at = it.arguments.index(match[1])
    return [*it.arguments[: at - 1], match[2], match[3], *it.arguments[at + 1 :]]


def shorter_log(*speeds: float) -> dict[str, str]:
    return {"log.csv": table(rows(speeds))}


@dataclass(frozen=True)
class Mistake:
    """Files, what is typed, what the message must say (what and where), and how its advice is followed."""

    files: dict[str, str]
    command: str
    says: tuple[str, ...]
    way_out: WayOut = typed
    after: tuple[str, ...] = field(default=())  #: what the command says once the advice is followed


GOOD = {"log.csv": table(rows())}
STANDING = [(i * 0.1, 0.0, 0.0, 100.0) for i in range(60)]
FALLING = '[torque]\nchanel = "Torque"\n'

MISTAKES: dict[str, Mistake] = {
    "torque without a unit": Mistake(
        {"log.csv": named(1, "Torque")}, "fit log.csv", ("log.csv", "'Torque' has no unit", "Torque [N*m]")
    ),
    "speed without a unit": Mistake({"log.csv": named(2, "Speed")}, "fit log.csv", ("'Speed' has no unit",)),
    "clock without a unit": Mistake({"log.csv": named(0, "Time")}, "fit log.csv", ("'Time' has no unit",)),
    "temperature without a unit": Mistake(
        {"log.csv": named(3, "Temperature")}, "fit log.csv", ("'Temperature' has no unit",)
    ),
    "a unit of torque with a slip": Mistake(
        {"log.csv": named(1, "Torque [Nmz]")},
        "fit log.csv",
        ("'Torque'", "unknown unit 'Nmz'", "--torque-unit 'Nm',"),
    ),
    "a unit of speed with a slip": Mistake(
        {"log.csv": named(2, "Speed [rmp]")},
        "fit log.csv",
        ("'Speed'", "unknown unit 'rmp'", "--speed-unit 'rpm',"),
    ),
    "an option's unit with a slip": Mistake(GOOD, "fit log.csv --torque-unit Nmz", ("'Torque'", "'Nmz'")),
    "speed in Hz": Mistake({"log.csv": named(2, "Speed [Hz]")}, "fit log.csv", ("revolutions or radians",)),
    "percent of an unknown torque": Mistake(
        {"log.csv": named(1, "Torque [%]")}, "fit log.csv", ("'Torque'", "needs the torque at 100 %")
    ),
    "amperes as torque": Mistake(
        {"log.csv": named(1, "Torque [A]")},
        "fit log.csv",
        ("'Torque'", "'A' is not a unit of torque", "torque per A"),
    ),
    "a current and no torque": Mistake(
        {"log.csv": named(1, "Current [A]")}, "fit log.csv", ("no torque column", "motor current")
    ),
    "torque in newtons": Mistake(
        {"log.csv": named(1, "Torque [N]")},
        "fit log.csv",
        ("'Torque' is called a torque", "--torque-unit 'N'"),
    ),
    "negative torque in mN m": Mistake(
        {"log.csv": table(column(1, lambda x: -1000 * x), HEADER[0], "Torque [mN*m]", *HEADER[2:])},
        "fit log.csv",
        ("log.csv", "opposite signs"),
    ),
    "columns swapped": Mistake(
        GOOD, "fit log.csv --torque Speed --speed Torque", ("'Speed'", "but a unit of speed", "swapped")
    ),
    "a column with a slip": Mistake(
        GOOD, "fit log.csv --torque Torqe", ("--torque", "no column 'Torqe'", "Did you mean")
    ),
    "two columns of torque": Mistake(
        {
            "log.csv": table(
                [(t, q, q, w, k) for t, q, w, k in rows()],
                HEADER[0],
                "Torque A [N*m]",
                "Torque B [N*m]",
                *HEADER[2:],
            )
        },
        "fit log.csv",
        ("the torque column could be", "'Torque A [N*m]' or 'Torque B [N*m]'"),
    ),
    "two columns of one name": Mistake(
        {"log.csv": table([(t, q, q, w, k) for t, q, w, k in rows()], *HEADER[:2], *HEADER[1:])},
        "fit log.csv",
        ("2 columns are called 'Torque'",),
    ),
    "ramps without dwells": Mistake(
        {"log.csv": table([(i / 10, 1 + i / 1000, 0.2 * i, 100 + 50 * (i > 200)) for i in range(1, 400)])},
        "fit log.csv",
        ("The speed never holds: 1 ramp between 0.2 and 79.8 rpm",),
        recorded,
    ),
    "steps too short for dwells": Mistake(
        {"log.csv": table(rows(each=8))},
        "fit log.csv",
        ("The speed changes in ", "Hold each speed for at least "),
        recorded,
    ),
    "dwells shorter than is asked": Mistake(
        {"log.csv": table(rows(each=75, step=0.02))}, "fit log.csv", ("dwell too short", "at least 2 s")
    ),
    "longer dwells asked than recorded": Mistake(
        GOOD, "fit log.csv --min-dwell '20 s'", ("dwell too short", "at least 20 s")
    ),
    "a duration without a unit": Mistake(
        GOOD, "fit log.csv --min-dwell 1", ("'1' is not a number with a unit of time",), example_taken
    ),
    "one temperature": Mistake(
        {"log.csv": table(rows(temperatures=(100,)))},
        "fit log.csv",
        ("one temperature (100.0 degC)",),
    ),
    "no temperature": Mistake(
        {"log.csv": table([line[:3] for line in rows()], *HEADER[:3])},
        "fit log.csv",
        ("no temperature column",),
    ),
    "degC called K": Mistake(
        {"log.csv": named(3, "Temperature [K]")}, "fit log.csv", ("-173 degC", "If temperatures are in degC")
    ),
    "below 0 degC": Mistake(
        {"log.csv": table(column(3, lambda x: x - 130))}, "fit log.csv", ("at or below 0 degC", "-30 degC")
    ),
    "no clock": Mistake(
        {"log.csv": table([line[1:] for line in rows()], *HEADER[1:])}, "fit log.csv", ("no time column",)
    ),
    "seconds called milliseconds": Mistake(
        {"log.csv": named(0, "Time [ms]")}, "fit log.csv", ("the whole log lasts only 0.0899 s",)
    ),
    "a clock that runs backwards": Mistake(
        {"log.csv": table(rows()[:300] + column(1, lambda x: 1.001 * x)[270:])},
        "fit log.csv",
        ("line 302", "runs backwards"),
        split_there,
    ),
    "rows pasted twice": Mistake(
        {"log.csv": table(rows()[:300] + rows()[240:])},
        "fit log.csv",
        ("the rows from line 302 to line 361 repeat those from line 242 to line 301",),
        lines_deleted,
    ),
    "decimal commas between commas": Mistake(
        {"log.csv": table(rows(), number="{:.3f}").replace(".", ",").replace("N*m", "N*m")},
        "fit log.csv",
        ("line 1", "header has 4 cells, but the rows have 8", "decimal commas"),
        marked,
    ),
    "decimal commas in one column between commas": Mistake(
        {"log.csv": DECIMALS_OF_TORQUE},
        "fit log.csv",
        ("line 1", "header has 4 cells, but the rows have 5", "some seem to be decimal commas"),
        marked_in_one,
    ),
    "commas for thousands between commas": Mistake(
        {
            "log.csv": table(
                column(1, lambda x: 10_000 * x), HEADER[0], "Torque [mN*cm]", *HEADER[2:], number="{:,.1f}"
            )
        },
        "fit log.csv",
        ("line 1", "header has 4 cells, but the rows have 5", "separates thousands"),
        marked,
    ),
    "many bad cells": Mistake(
        {"log.csv": spoilt(5, "err")},
        "fit log.csv",
        ("line 2, column 'Torque'", "'err'", "180 such rows, of 900"),
    ),
    "a folder": Mistake({"logs/log.csv": GOOD["log.csv"]}, "fit logs", ("logs is a folder",)),
    "a file that is not there": Mistake(GOOD, "fit lug.csv", ("File not found: lug.csv",)),
    "an output that exists": Mistake(
        {**GOOD, "report.html": "mine"}, "report log.csv", ("report.html exists",)
    ),
    "two speeds": Mistake(shorter_log(20, 60), "fit log.csv", ("20 rpm and 60 rpm",), recorded),
    "a tare without standing": Mistake(GOOD, "fit log.csv --tare standing", ("never stands still",)),
    "reverse of a log that turns forward": Mistake(
        GOOD, "fit log.csv --rotation reverse", ("15 x rotation is not reverse", "turns in the forward")
    ),
    "a gear ratio of 0": Mistake(
        {**GOOD, "hersey.toml": "[torque]\ngear_ratio = 0\n"},
        "fit log.csv",
        ("hersey.toml, line 2: torque.gear_ratio is 0",),
        value_replaced,
    ),
    "an unknown key of a mapping": Mistake(
        {**GOOD, "hersey.toml": '[torque]\nchanel = "Torque"\n'},
        "fit log.csv",
        ("hersey.toml, line 2: [torque] has an unknown key 'chanel'",),
        key_renamed,
    ),
    "an unknown table of a mapping": Mistake(
        {**GOOD, "hersey.toml": "[torqe]\nsign = 1\n"},
        "fit log.csv",
        ("hersey.toml, line 1: unknown table 'torqe'",),
        key_renamed,
    ),
    "an unknown key of a machine": Mistake(
        {**GOOD, "machine.toml": MACHINE.replace("stiffness", "stifness")},
        "report log.csv --machine machine.toml",
        ("machine.toml, line 2: [drivetrain] has an unknown key 'stifness'",),
        key_renamed,
    ),
    "an unknown kind of figure": Mistake(
        GOOD, "inspect log.csv --figure channels.bmp", ("--figure channels.bmp",), ending_taken
    ),
    "numbers with and without units": Mistake(
        {},
        "simulate --stiffness '11 N/mm' --mass 1",
        ("--mass 1 has no unit, but --stiffness '11 N/mm' has",),
        with_unit,
    ),
    "a film without a contact": Mistake(
        {
            "machine.toml": MACHINE
            + '\n[[points]]\nname = "hot"\nspeed = "100 mm/s"\ntemperature = "150 degC"\n'
        },
        "film machine.toml",
        ("machine.toml: the film needs a table [contact]",),
        table_added,
    ),
    "a machine file with a slip": Mistake(
        {**GOOD, "machine.toml": MACHINE},
        "report log.csv --machine machine.tml",
        ("File not found: machine.tml",),
    ),
    "logs without common speeds": Mistake(
        {"a.csv": table(rows()), "log.csv": table(rows((200, 300, 400, 500)))},
        "compare a.csv log.csv",
        ("have too few speeds in common", "a.csv covers 10 to 120 rpm, log.csv covers 200 to 500 rpm"),
        recorded,
    ),
    "machine and log swapped": Mistake(
        {**GOOD, "machine.toml": MACHINE},
        "report machine.toml --machine log.csv",
        ("machine.toml is a machine file, not a log",),
        line_typed,
    ),
    "a machine given as mapping": Mistake(
        {**GOOD, "machine.toml": MACHINE},
        "report log.csv --mapping machine.toml",
        ("machine.toml is a machine file",),
        given_as,
    ),
    "a mapping given as machine": Mistake(
        {**GOOD, "rig.toml": "[torque]\nsign = 1\n"},
        "report log.csv --machine rig.toml",
        ("so it is the mapping of a log",),
        given_as,
    ),
    "one file twice": Mistake(GOOD, "fit log.csv log.csv", ("is given twice",), named_once),
    "a copy beside its file": Mistake(
        {**GOOD, "copy.csv": GOOD["log.csv"]}, "fit log.csv copy.csv", ("same content",), named_once
    ),
    "a word for a sign": Mistake(
        {"log.csv": table(column(1, lambda x: -x))}, "fit log.csv --torque-sign 2", ("sign of torque is 2",)
    ),
    "a trace of two quantities": Mistake(GOOD, "cycles log.csv", ("has torque and speed",)),
}


def written(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)


def refusal(done: Done) -> str:
    """The one line of a refusal."""
    assert done.returncode == 2, done
    assert done.stdout == ""
    (line,) = [each for each in done.stderr.splitlines() if each.startswith("hersey: ")]
    assert "Traceback" not in done.stderr
    return line


def test_there_are_forty_of_them() -> None:
    assert len(MISTAKES) >= 40


#: The same mistake as another, in another column or another file.
ALIKE = (
    *("speed without a unit", "clock without a unit", "a unit of speed with a slip"),
    *("longer dwells asked than recorded", "commas for thousands between commas"),
    *("an unknown key of a machine", "a mapping given as machine"),
)


@pytest.mark.parametrize("case", mostly_nightly(MISTAKES, *(MISTAKES.keys() - {*ALIKE})))
def test_the_advice_of_a_message_works(case: str, tmp_path: Path) -> None:
    mistake = MISTAKES[case]
    written(tmp_path, mistake.files)
    arguments = shlex.split(mistake.command)
    done = run(*arguments, cwd=tmp_path)
    line = refusal(done)
    for words in mistake.says:
        assert words in line
    told = [line]
    arguments = mistake.way_out(Refused(tmp_path, arguments, line))
    done = run(*arguments, cwd=tmp_path)
    while done.returncode == 2 and len(told) < ROUNDS:
        line = refusal(done)
        assert line not in told, "the advice changes nothing"
        told.append(line)
        follow = typed if followed(arguments, line) else mistake.way_out
        arguments = follow(Refused(tmp_path, arguments, line))
        done = run(*arguments, cwd=tmp_path)
    assert done.returncode == 0, (told, arguments, done.stderr)


#: What is read, with a caution: file, words of the caution, and a number that the advice must change.
DOUBTFUL: dict[str, tuple[str, str, str]] = {
    "kelvin called degC": (
        table(column(3, lambda x: x + 273.15)),
        "Temperature reaches 433 degC",
        "temperature",
    ),
    "milliseconds called seconds": (table(column(0, lambda x: 1000 * x)), "one row every 100 s", "end"),
}


@pytest.mark.parametrize("command", ["fit", "inspect"])
@pytest.mark.parametrize("case", DOUBTFUL)
def test_what_is_doubtful_is_cautioned_of_and_its_advice_ends_the_caution(
    case: str, command: str, tmp_path: Path
) -> None:
    content, words, _ = DOUBTFUL[case]
    (tmp_path / "log.csv").write_text(content)
    done = run(command, "log.csv", cwd=tmp_path)
    (caution,) = [line for line in unwrapped(done.stdout) if words in line]
    done = run(*typed(Refused(tmp_path, [command, "log.csv"], f"hersey: {caution}")), cwd=tmp_path)
    assert done.returncode == 0
    assert words not in done.words


def test_one_bad_cell_costs_its_row_and_is_named(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text(spoilt(10_000, "err", first=100))
    done = run("fit", "log.csv", cwd=tmp_path)
    assert done.returncode == 0
    assert "line 101, column 'Torque': 'err'" in done.stderr


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("", "log.csv is empty. A log needs a header and rows of numbers"),
        (table([]), "log.csv has a header but no rows of numbers"),
        (spoilt(1, "err"), "Name another column, or correct the file"),
    ],
)
def test_a_log_that_holds_nothing_says_what_it_should(content: str, says: str, tmp_path: Path) -> None:
    """The way out is a log with what is missing, or another column."""
    (tmp_path / "log.csv").write_text(content)
    assert says in refusal(run("fit", "log.csv", cwd=tmp_path))
    (tmp_path / "log.csv").write_text(GOOD["log.csv"])
    assert run("fit", "log.csv", cwd=tmp_path).returncode == 0


def test_a_turned_sign_leaves_the_unit_alone(tmp_path: Path) -> None:
    """Once the advice made newton metres of millinewton metres."""
    content = MISTAKES["negative torque in mN m"].files["log.csv"]
    (tmp_path / "log.csv").write_text(content)
    line = refusal(run("fit", "log.csv", cwd=tmp_path))
    turned = json.loads(
        run(*typed(Refused(tmp_path, ["fit", "log.csv"], line)), "--json", cwd=tmp_path).stdout
    )
    (tmp_path / "log.csv").write_text(GOOD["log.csv"])
    as_it_is = json.loads(run("fit", "log.csv", "--json", cwd=tmp_path).stdout)
    assert turned["fit"]["coefficients"]["a"]["value"] == pytest.approx(
        as_it_is["fit"]["coefficients"]["a"]["value"], rel=1e-4
    )


def test_signs_of_an_option_multiply_those_of_a_mapping(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text(GOOD["log.csv"])
    (tmp_path / "hersey.toml").write_text("[torque]\nsign = -1\n")
    assert "opposite signs" in refusal(run("fit", "log.csv", cwd=tmp_path))
    assert run("fit", "log.csv", "--torque-sign", "-1", cwd=tmp_path).returncode == 0
    assert run("fit", "log.csv", "--speed-sign", "-1", cwd=tmp_path).returncode == 0


def test_of_two_logs_the_one_that_needs_another_mapping_is_told_first_how_it_gets_it(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(GOOD["log.csv"])
    (tmp_path / "b.csv").write_text(GOOD["log.csv"].replace("Torque [N*m]", "Tq", 1))
    (tmp_path / "hersey.toml").write_text('[torque]\nchannel = "Tq"\nunit = "N*m"\n')
    compared = ("compare", "a.csv", "b.csv")

    def advice(*words: str, reason: str) -> str:
        return refusal(run(*words, cwd=tmp_path)).split(reason)[1].removeprefix(". ")

    shared = "(channels and units come from hersey.toml)"
    advised = advice(*compared, reason=shared)
    assert advised == "If hersey.toml is for b.csv only, rename it to b.hersey.toml"
    advised = advice(*compared, "--mapping", "hersey.toml", reason=shared)
    assert advised.startswith("If hersey.toml is for b.csv only, omit --mapping and copy it to b.hersey.toml")
    advised = advice("compare", "a.csv", "a.csv", reason=shared)
    assert "hersey.toml is for" not in advised  # there is no other log
    (tmp_path / "hersey.toml").rename(tmp_path / "b.hersey.toml")
    assert run(*compared, cwd=tmp_path).returncode == 0

    (tmp_path / "b.hersey.toml").unlink()
    advised = advice(*compared, reason="column 'Tq' has no unit")
    assert advised.startswith('If only b.csv needs it, write unit = "UNIT" under [torque] in b.hersey.toml. ')
    assert "Otherwise: write 'Tq [N*m]' in the header" in advised
    (tmp_path / "b.hersey.toml").write_text('[torque]\nunit = "N*m"\n')
    assert run(*compared, cwd=tmp_path).returncode == 0

    (tmp_path / "b.hersey.toml").unlink()
    advised = advice(*compared, "--torque", "Tq", "--torque-unit", "N*m", reason="'Temperature [degC]'")
    key = 'write channel = "Tq" under [torque] in b.hersey.toml'
    assert advised == f"If only b.csv needs it, omit --torque and {key}"


def test_a_mapping_in_the_place_of_a_log_leaves_the_place_of_the_other_log(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(GOOD["log.csv"])
    (tmp_path / "map.toml").write_text('[torque]\nchannel = "Torque"\n')
    for files in (("a.csv", "map.toml"), ("map.toml", "a.csv")):
        said = refusal(run("compare", *files, cwd=tmp_path))
        assert said.endswith("Type: hersey compare a.csv B --mapping map.toml")


def test_a_table_of_means_takes_the_signs_too(tmp_path: Path) -> None:
    means = [(float(w), -drag(w, 100)) for w in (10, 20, 40, 80, 120)]
    (tmp_path / "log.csv").write_text(table(means, "Speed [rpm]", "Torque [N*m]"))
    for verb in ("fit", "inspect"):
        arguments = [verb, "log.csv", "--means", "--isothermal"]
        done = run(*arguments, cwd=tmp_path)
        said = done.stderr if done.returncode else done.stdout
        (line,) = [each for each in unwrapped(said) if "opposite signs" in each][:1]
        done = run(*typed(Refused(tmp_path, arguments, f"hersey: {line}")), cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        assert "opposite signs" not in done.words


def test_a_workbook_of_two_tables_asks_which(tmp_path: Path) -> None:
    pytest.importorskip("fastexcel")
    sheet: list[list[object]] = [[*HEADER]]
    sheet += [[*line] for line in rows()]
    (tmp_path / "log.xlsx").write_bytes(xlsx({"First": sheet[:400], "Second": sheet}))
    line = refusal(run("fit", "log.xlsx", cwd=tmp_path))
    assert "'First/Torque [N*m]' or 'Second/Torque [N*m]'" in line
    arguments = ["fit", "log.xlsx"]
    for _ in range(ROUNDS):
        arguments = typed(Refused(tmp_path, arguments, line))
        done = run(*arguments, cwd=tmp_path)
        if done.returncode == 0:
            return
        line = refusal(done)
    pytest.fail(line)
