"""The core for C: the example compiles and says what Python says, the standard's functions are all there."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import hersey
from tests.conftest import ROOT

LIBRARY = ROOT / "python" / "hersey" / "exchange" / "library" / "hersey.so"
CRATE = ROOT / "crates" / "c"
DRIVE = """format = 1
token = {token}
drive = speed
law = power
closure = retained
temperature_law = none
stiffness = 1000.0
mass = 1.0
transition_force = 50.0
transition_speed = 1.0
ehl_exponent = -0.7
mixed_exponent = -1.2
stick_speed = 0.01
drive_speed = 1.0
"""

pytestmark = pytest.mark.skipif(not LIBRARY.exists(), reason="the library is not made: make build")


def compiled(source: Path, folder: Path, *options: str) -> Path:
    """A program of a source in C and the library."""
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("there is no compiler of C (cc)")
    program = folder / "program"
    strict = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic")
    command = [compiler, *strict, *options, str(source), str(LIBRARY), "-o", str(program)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return program


def said(program: Path) -> list[list[str]]:
    """The words of each line that a program prints."""
    done = subprocess.run([program], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    return [line.split() for line in done.stdout.splitlines()]


def test_the_example_in_c_says_what_python_says(tmp_path: Path) -> None:
    lines = said(compiled(CRATE / "examples" / "belt.c", tmp_path, "-I", str(CRATE / "include")))
    drag = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    run = hersey.simulate(hersey.Drivetrain(1000, 1), drag, drive_speed=1.0, duration=1.0, samples=3)
    modes = ("ehl", "mixed", "microslip", "stuck")
    changes = [(float(line[1]), modes[int(line[2])]) for line in lines if line[0] == "change"]
    expected = [(event.time, event.to_mode) for event in run.events]
    second = [change for change in expected if change[0] > 0.5]
    assert [mode for _, mode in changes] == [mode for _, mode in expected + second]
    assert [time for time, _ in changes] == pytest.approx([t for t, _ in expected + second], rel=1e-13)
    belts = [[float(number) for number in line[1:]] for line in lines if line[0] == "belt"]
    for belt, i in zip(belts, (1, 2, 2), strict=True):
        assert belt == pytest.approx([run.time[i], run.belt_speed[i], run.spring_force[i]], rel=1e-11)
    assert belts[1] == belts[2]  # from the saved state, to the last bit


def test_the_thermal_loop_in_c_follows_drag_times_speed(tmp_path: Path) -> None:
    """The belt slides at 2 m/s, but for the spring that unloads as drag falls: heat in closed form."""
    lines = said(compiled(CRATE / "examples" / "heat.c", tmp_path, "-I", str(CRATE / "include")))
    found = {name: float(value) for name, value in lines}
    temperature, energy = 400.0, 0.0
    for _ in range(200):
        warmer = temperature / 400.0
        power = 50.0 * warmer**-2 * (2.0 / warmer**3) ** 0.3 * 2.0
        energy += 0.01 * power
        temperature += 0.01 * (power - 0.5 * (temperature - 300.0)) / 50.0
    assert temperature > 402
    assert found["temperature"] - 400 == pytest.approx(temperature - 400, rel=2e-3)
    assert found["energy"] == pytest.approx(energy, rel=1e-3)
    assert found["warnings"] == 1


def headers() -> Path:
    """The headers of the standard, which FMPy brings."""
    fmpy = pytest.importorskip("fmpy")
    return Path(fmpy.__file__).parent / "c-code"


def functions(version: int) -> list[str]:
    """The functions that a header of the standard declares."""
    text = (headers() / f"fmi{version}Functions.h").read_text()
    return re.findall(rf"^\s*FMI{version}_Export fmi{version}\w+TYPE\s+(fmi{version}\w+);", text, re.M)


def test_every_function_of_the_standard_is_exported(tmp_path: Path) -> None:
    names = {version: functions(version) for version in (2, 3)}
    assert (len(names[2]), len(names[3])) == (44, 75)
    for version, of_this in names.items():
        # the addresses are of the types that the standard's own header declares
        types = ", ".join(f"(void (*)(void)){name}" for name in of_this)
        source = tmp_path / f"all{version}.c"
        source.write_text(
            f'#include <stdio.h>\n#include "fmi{version}Functions.h"\n'
            f"static void (*const all[])(void) = {{{types}}};\n"
            "int main(void) {\n"
            "    size_t i, there = 0;\n"
            "    for (i = 0; i < sizeof all / sizeof *all; i++) there += all[i] != NULL;\n"
            f'    printf("%zu %s\\n", there, fmi{version}GetVersion());\n'
            "    return 0;\n}\n"
        )
        # the header of the standard begins a comment twice
        program = compiled(source, tmp_path, "-I", str(headers()), "-Wno-comment")
        assert said(program) == [[str(len(of_this)), f"{version}.0"]]


def rust_types() -> dict[str, list[str]]:
    """The arguments of every exported function, as the sources in Rust have them, macros written out."""
    found: dict[str, list[str]] = {}
    for version in (2, 3):
        text = re.sub(r"\s+", " ", (CRATE / "src" / f"fmi{version}.rs").read_text())
        first = ["Instance" if version == 3 else "Component"]
        for name, arguments in re.findall(r'extern "C" fn (fmi\w+)\(([^)]*)\)', text):
            found[name] = [a.split(":")[1].strip() for a in arguments.split(",") if ":" in a]
        for name, arguments in re.findall(r"(fmi\w+)\(([^)]*)\): (?:[A-Z_]+|\")", text):
            found[name] = first + [a.strip() for a in arguments.split(",") if a.strip()]
        for name, arguments in re.findall(r'(fmi3\w+), "\w+" \(([^)]*)\)', text):
            found[name] = [*first, "References", "usize", *(a.strip() for a in arguments.split(","))]
        for get, put, kind in re.findall(r"(fmi\w+), (fmi\w+): (\w+) = ", text):
            counted = ["usize"] if version == 3 else []
            found[get] = [*first, "References", "usize", f"*mut {kind}", *counted]
            found[put] = [*first, "References", "usize", f"*const {kind}", *counted]
    return found


#: How C and Rust pass a value that is no pointer.
PASSED = {
    "size_t": "usize",
    "fmi3Float64": "f64",
    "fmi3Boolean": "u8",
    "fmi3ValueReference": "u32",
    "fmi2Real": "f64",
    "fmi2Boolean": "c_int",
    "fmi2Type": "c_int",
    "fmi2StatusKind": "c_int",
}


def passed(argument: str) -> str:
    """How an argument in C is passed, in the words of Rust."""
    kind = re.sub(r"\bconst\b|\w+$", "", argument.split("[")[0].strip()).strip()
    return "pointer" if "[" in argument or "*" in argument else PASSED.get(kind, "pointer")


@pytest.mark.parametrize("version", [2, 3])
def test_signatures_are_those_of_the_standard(version: int) -> None:
    text = (headers() / f"fmi{version}FunctionTypes.h").read_text()
    declared = re.findall(rf"typedef [\w* ]+?\b(fmi{version}\w+)TYPE\s*\(([^;]*)\);", text)
    ours, wrong = rust_types(), []
    assert len(declared) == len(functions(version))
    for name, arguments in declared:
        cleaned = [" ".join(a.split()) for a in arguments.split(",")]
        wanted = [passed(a if re.search(r"\w \w|\]|\* ?\w", a) else f"{a} x") for a in cleaned if a != "void"]
        have = [kind if kind in set(PASSED.values()) else "pointer" for kind in ours[name]]
        if wanted != have:
            wrong.append(f"{name}: {wanted}, but {have}")
    assert not wrong, "\n".join(wrong)


def test_calls_that_no_tool_should_make_never_end_the_process(tmp_path: Path) -> None:
    (tmp_path / "drive.txt").write_text(DRIVE)
    names = " ".join(functions(2) + functions(3))
    script = Path(__file__).with_name("hostile.py")
    command = [sys.executable, "-X", "faulthandler", script, LIBRARY, tmp_path, names]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr[-3000:]
    assert int(done.stdout) > 1000
    assert "panicked" not in done.stderr


def test_the_header_names_every_plain_function(tmp_path: Path) -> None:
    declared = set(re.findall(r"\b(hersey_\w+)\(", (CRATE / "include" / "hersey.h").read_text()))
    exported = set(re.findall(r'extern "C" fn (hersey_\w+)\(', (CRATE / "src" / "plain.rs").read_text()))
    assert declared == exported
    addresses = ", ".join(f"(void (*)(void)){name}" for name in sorted(declared))
    source = tmp_path / "all.c"
    source.write_text(
        f'#include "hersey.h"\nstatic void (*const all[])(void) = {{{addresses}}};\n'
        "int main(void) { return all[0] == NULL; }\n"
    )
    assert said(compiled(source, tmp_path, "-I", str(CRATE / "include"))) == []
