"""A drag curve from a file: two power laws in a table move as the two power laws do."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from tests.cli.command import run

BELT = ("--stiffness", "11 N/mm", "--mass", "11 kg", "--stick-speed", "1 mm/s")
DRIVE = ("--drive-speed", "15 mm/s")


@pytest.fixture
def here(tmp_path: Path) -> Path:
    """A table of 14 N at 25 mm/s, exponents of force 0.3 above and -0.2 below."""
    speeds = np.array([0.5, 25.0, 400.0])
    forces = 14.0 * (speeds / 25.0) ** np.where(speeds < 25.0, -0.2, 0.3)
    rows = [f"{v:.9g},{f:.9g}" for v, f in zip(speeds, forces, strict=True)]
    (tmp_path / "drag.csv").write_text("\n".join(["speed (mm/s),force (N)", *rows, ""]))
    return tmp_path


def figures(text: str) -> dict[str, float]:
    return {name: float(value) for name, value in re.findall(r"(frequency|stuck) +([\d.]+)", text)}


def test_a_table_of_two_branches_moves_as_they_do(here: Path) -> None:
    branches = ("--transition-force", "14 N", "--transition-speed", "25 mm/s")
    law = run("simulate", *BELT, *DRIVE, *branches, "--mixed-exponent=-1.2", "--ehl-exponent=-0.7", cwd=here)
    table = run("simulate", *BELT, *DRIVE, "--drag-table", "drag.csv", cwd=here)
    assert (law.returncode, table.returncode) == (0, 0), table
    assert figures(table.stdout) == pytest.approx(figures(law.stdout), rel=1e-5)
    # e times 14 (1/25)^-0.2 N starts the belt, stated or not
    static = f"{np.e * 14.0 * 25.0**0.2:.9g} N"
    stated = run("simulate", *BELT, *DRIVE, "--drag-table", "drag.csv", "--static-force", static, cwd=here)
    assert figures(stated.stdout) == pytest.approx(figures(law.stdout), rel=1e-5)
    # a belt that stops abruptly is let go at 90 N / 11 N/mm; the spring stretches on until it is as fast
    held = ("--static-force", "90 N", "--closure", "stiction")
    done = run("simulate", *BELT, *DRIVE, "--drag-table", "drag.csv", *held, cwd=here)
    stretched = re.search(r"stretch +\S+ to ([\d.]+)", done.stdout)
    assert stretched is not None
    assert 1e-3 * float(stretched[1]) == pytest.approx(90.0 / 11e3, rel=0.02)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--stick-speed", "1 mm/s", "--transition-force", "4 N"), "exclude each other"),
        (("--stick-speed", "1 mm/s", "--ehl-exponent", "-0.5"), "exclude each other"),
        ((), "--stick-speed '0.3 mm/s'"),
        (("--stick-speed", "2"), "give the other numbers with units too"),
        (("--stick-speed", "30 mm/s"), "drag.csv: stick_speed is 0.03: it must be less than 0.025"),
    ],
)
def test_what_does_not_go_with_a_table_is_refused(here: Path, words: tuple[str, ...], said: str) -> None:
    done = run("simulate", "--drag-table", "drag.csv", *words, cwd=here)
    assert done.returncode == 2
    assert said in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("speed (mm/s)\n1\n", "'speed (mm/s),force (N)' in line 1"),
        ("speed (mm/s),force (N)\n", "no rows"),
        ("speed (mm/s),force (N)\n1,2\n3,x\n", "line 3, column 'force': 'x' is not a number"),
        ("speed (mm/s),force (K)\n1,2\n", "column 'force [K]'"),
        ("speed (mm/s),force (N)\n3,2\n1,4\n", "bad.csv: "),
    ],
)
def test_a_table_that_is_none_is_named_with_its_place(here: Path, text: str, said: str) -> None:
    (here / "bad.csv").write_text(text)
    done = run("simulate", "--drag-table", "bad.csv", *BELT, cwd=here)
    assert done.returncode == 2
    assert said in done.stderr
