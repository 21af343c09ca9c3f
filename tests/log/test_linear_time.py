"""What a stranger may make long costs time in proportion, or is refused by a limit that the message names.

Processor time of n and 8n is compared, with room for a busy machine: a square would be 64.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from hersey.errors import HerseyError, UnitError
from hersey.files.toml import read_toml
from hersey.inspection import inspect
from hersey.log.reading import read
from hersey.log.text.column import LONGEST_NAME, MOST_COLUMNS, NAME_WITH_UNIT
from hersey.units import conversion, parse

HEADER = "Time [s],Torque [N*m],Speed [rpm],Temperature [degC]\n"
#: Below this a ratio says nothing, s of processor time.
SHORT = 0.2
MOST = 30


def rows(count: int, first: int = 0) -> str:
    return "".join(f"{first + i},1.5,30,150\n" for i in range(count))


def table(names: list[str]) -> str:
    lines = [",".join(map(str, range(i, i + len(names)))) for i in range(8)]
    return "\n".join([",".join(names), *lines]) + "\n"


LVM = "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t.\n***End_of_Header***\t\n"


def lvm(channels: int, count: int) -> str:
    head = ["Channels", "Y_Unit_Label" + "\tN*m" * channels, "X0" + "\t0" * channels]
    head += ["Delta_X" + "\t0.1" * channels, "***End_of_Header***"]
    names = "X_Value" + "".join(f"\tTorque {i}" for i in range(channels))
    body = [str(i) + "\t1.5" * channels for i in range(count)]
    return LVM + "\n" + "\n".join([*head, names, *body]) + "\n"


#: Text of a log by its suffix and n, and n.
GROWING: dict[str, tuple[str, Callable[[int], str], int]] = {
    "columns with units that nobody knows": (
        ".csv",
        lambda n: table(["Time [s]", *(f"c{i} [q{chr(97 + i % 26)}{'x' * (i // 26)}]" for i in range(n))]),
        100,
    ),
    "columns without a unit": (".csv", lambda n: table(["Time [s]", *(f"speed{i}" for i in range(n))]), 200),
    "rows of other widths": (
        ".csv",
        lambda n: HEADER + rows(50) + "1\n" * (9 * n) + "".join("1," * k + "1\n" for k in range(1, n // 20)),
        300,
    ),
    "lines of numbers above the table": (".csv", lambda n: "1,2\nx\n" * n + HEADER + rows(50), 2000),
    "comments above a long table": (".csv", lambda n: "#\n" * n + HEADER + rows(30_000), 4000),
    "comments": (".csv", lambda n: HEADER + rows(9) + "# x\n" * n + rows(9, 9), 20_000),
    "blank lines": (".csv", lambda n: HEADER + rows(9) + "\n" * n + rows(9, 9), 50_000),
    "digits": (".csv", lambda n: HEADER + rows(50) + f"50,{'1' * n},1,1\n" + rows(9, 51), 200_000),
    "separators": (".csv", lambda n: HEADER + rows(9) + "," * n + "\n" + rows(9, 9), 50_000),
    "words": (".csv", lambda n: HEADER + "".join(f"{i},w{i},30,150\n" for i in range(n)), 3000),
    "quotes": (".csv", lambda n: HEADER + rows(9) + '"a,' * n + "\n" + rows(9, 9), 10_000),
    "brackets in a name": (".csv", lambda n: table(["Time [s]", "[" * n, "Speed [rpm]"]), 10_000),
    "channels of LVM": (".lvm", lambda n: lvm(n, 9), 100),
    "rows of LVM": (".lvm", lambda n: lvm(3, n), 2000),
    "short rows of LVM": (".lvm", lambda n: lvm(n, 2) + "1\n" * (5 * n), 400),
}


def cost(work: Callable[[int], object], n: int) -> float:
    """Processor time, s."""
    start = time.process_time()
    with contextlib.suppress(HerseyError):
        work(n)
    return time.process_time() - start


def assert_linear(work: Callable[[int], object], n: int) -> None:
    """Three tries, each of which may take the machine's side."""
    for _ in range(3):
        few, many = cost(work, n), cost(work, 8 * n)
        if many < max(SHORT, MOST * few):
            return
    raise AssertionError(f"{few:.3f} s of n, {many:.3f} s of 8 n")


@pytest.mark.parametrize("case", GROWING)
def test_a_log_costs_time_in_proportion(case: str, tmp_path: Path) -> None:
    suffix, text, n = GROWING[case]
    files = {count: tmp_path / f"{count}{suffix}" for count in (n, 8 * n)}
    for count, file in files.items():
        file.write_text(text(count))
    assert_linear(lambda count: read(files[count]), n)
    assert_linear(lambda count: inspect(files[count]), n)


@pytest.mark.parametrize("text", ["[", "(", " ", "[a]", "a ", "[ ", "]"])
def test_a_name_is_looked_at_in_linear_time(text: str) -> None:
    assert_linear(lambda n: NAME_WITH_UNIT.fullmatch(text * n + "x"), 20_000)


DOCUMENTS: dict[str, Callable[[int], str]] = {
    "a key with dots": lambda n: ".".join(["a"] * n) + " = 1",
    "a key of quotes with dots": lambda n: ".".join(['"a\\"."'] * n) + " = 1",
    "a key behind a text of lines": lambda n: f"""x = ["\"""\n'"\"", {{{".".join("a" * n)} = 1}}, 'b']""",
    "a key behind four quotes": lambda n: f'x = """a""""\n{".".join("a" * n)} = 1',
    "quotes that do not end": lambda n: 'a = "' + '\\"' * n,
    "quotes in no text": lambda n: '\\"' * n,
    "keys": lambda n: "\n".join(f"k{i} = 1" for i in range(n)),
    "spaces": lambda n: "a = " + " " * n + "1",
}


@pytest.mark.parametrize("case", DOCUMENTS)
def test_toml_costs_time_in_proportion(case: str, tmp_path: Path) -> None:
    for n in (2000, 16_000):
        (tmp_path / f"{n}.toml").write_text(DOCUMENTS[case](n))
    assert_linear(lambda n: read_toml(tmp_path / f"{n}.toml"), 2000)


@pytest.mark.parametrize(
    ("names", "told"),
    [
        ([f"c{i}" for i in range(MOST_COLUMNS + 1)], rf" has \d+ columns; at most {MOST_COLUMNS}"),
        (["t", "x" * (LONGEST_NAME + 1)], rf"line \d+: the name of column \d .*; at most {LONGEST_NAME}"),
    ],
)
def test_a_limit_is_named(names: list[str], told: str, tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text(table(names))
    (tmp_path / "log.lvm").write_text(lvm(len(names), 2).replace("Torque 1\n", f"{names[-1]}\n"))
    for log in tmp_path.iterdir():
        with pytest.raises(HerseyError, match=told):
            read(log)


def test_short_rows_cannot_become_a_huge_table(tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    log.write_text(table([f"c{i}" for i in range(1000)]) + "1\n" * 100_000)
    with pytest.raises(HerseyError, match=r"most of the 1000.. rows have fewer cells than the 1000 columns"):
        inspect(log)


def test_units_and_quantities_have_a_length() -> None:
    with pytest.raises(UnitError, match="2002 characters, at most 100"):
        conversion("torque", f"N{' ' * 2000}m")
    with pytest.raises(UnitError, match="2002 characters; at most 160"):
        parse("torque", f"4{' ' * 2000}N")
