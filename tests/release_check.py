"""What the wheel gives somebody without Rust: ``python tests/release_check.py WHEEL FOLDER``.

The folder gets a fresh virtual environment, whose programs are all that the path has. Packages come as wheels
alone, in the versions that pip chooses. The log is the one that the wheel carries. Nothing is uploaded.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
import venv
import zipfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "python" / "hersey"
#: The main job, on the examples that the wheel carries.
REPORT = "report examples/bench.csv --machine examples/machine.toml --tare standing --out report.html"
#: Files that `make wheel` makes for the wheel alone.
MADE = frozenset({"hersey/charts/vega-embed.js", "hersey/files/examples/bench.csv"})
#: Where an environment keeps its programs.
PROGRAMS = "Scripts" if os.name == "nt" else "bin"
#: Packages named by their size.
HEAVIEST = 5
MB = 1e6


def missing(wheel: Path, package: Path = PACKAGE, made: frozenset[str] = MADE) -> list[str]:
    """Files of the package and those made for a wheel that it lacks, and the bindings if it lacks those."""
    with zipfile.ZipFile(wheel) as packed:
        inside = set(packed.namelist())
    wanted = {
        path.relative_to(package.parent).as_posix()
        for path in package.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts and not path.name.startswith("_core.abi3")
    }
    bindings = any(name.startswith("hersey/_core.") and not name.endswith(".pyi") for name in inside)
    return sorted((wanted | made) - inside) + ["hersey/_core"] * (not bindings)


def size(folder: Path) -> int:
    """Bytes of all files below a folder, each counted once."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file() and not path.is_symlink())


def heaviest(packages: Path, count: int = HEAVIEST) -> list[tuple[str, int]]:
    """The largest folders of site-packages, with the libraries that a package keeps beside it."""
    sizes: dict[str, int] = {}
    for folder in packages.iterdir():
        if folder.is_dir() and folder.suffix != ".dist-info":
            name = folder.name.removesuffix(".libs")
            sizes[name] = sizes.get(name, 0) + size(folder)
    return sorted(sizes.items(), key=lambda each: -each[1])[:count]


def timed(words: str, *command: str | Path, folder: Path) -> None:
    """Run a command of the environment, with its programs alone on the path; say how long it took."""
    programs = folder / "venv" / PROGRAMS
    variables = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    start = time.monotonic()
    typed = [programs / command[0], *command[1:]]
    alone = variables | {"PATH": str(programs)}
    done = subprocess.run(typed, cwd=folder, env=alone, stdout=subprocess.PIPE, text=True, check=True)
    last = "".join(f", {line}" for line in done.stdout.splitlines()[-1:])
    sys.stdout.write(f"{words}: {time.monotonic() - start:.1f} s{last}\n")
    sys.stdout.flush()


def main(wheel: Path, folder: Path) -> None:
    """Install, try, and print seconds and sizes."""
    if lacking := missing(wheel):
        sys.exit(f"{wheel.name} lacks {', '.join(lacking)}")
    shutil.rmtree(folder, ignore_errors=True)
    venv.create(folder / "venv", with_pip=True, symlinks=True)
    programs = str(folder / "venv" / PROGRAMS)
    for tool in ("cargo", "rustc"):
        assert shutil.which(tool, path=programs) is None, f"{tool} is on the path"
    pip = [
        "python",
        "-m",
        "pip",
        "install",
        "--quiet",
        "--disable-pip-version-check",
        "--only-binary",
        ":all:",
    ]
    timed("install", *pip, wheel, folder=folder)
    timed("hersey --version", "hersey", "--version", folder=folder)
    timed("hersey examples", "hersey", "examples", "examples", folder=folder)
    timed("hersey report", "hersey", *REPORT.split(), folder=folder)
    (packages,) = (folder / "venv").glob("[Ll]ib/**/site-packages")
    sys.stdout.write(f"environment: {size(folder / 'venv') / MB:.0f} MB\n")
    for name, taken in heaviest(packages):
        sys.stdout.write(f"  {name}: {taken / MB:.0f} MB\n")
    sys.stdout.write("Nothing was uploaded.\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve())
