"""Libraries of other platforms: known by their heads, packed in the folders of each version."""

from __future__ import annotations

import struct
import zipfile
from pathlib import Path

import pytest

import hersey
from hersey.errors import MissingFileError, ParameterError
from hersey.exchange.platforms import own_library, platform_named, read_library, this_platform
from tests.exchange.test_against_core import DRAG, TRAIN

FUNCTIONS = b"\0fmi2DoStep\0fmi3DoStep\0"


def elf(machine: int, *, big: bool = False) -> bytes:
    head = b"\x7fELF\x02" + (b"\x02" if big else b"\x01") + bytes(10)
    return head + struct.pack(">HH" if big else "<HH", 3, machine) + FUNCTIONS


def pe(machine: int) -> bytes:
    return b"MZ" + bytes(58) + struct.pack("<I", 64) + b"PE\0\0" + struct.pack("<H", machine) + FUNCTIONS


def mach(processor: int) -> bytes:
    return b"\xcf\xfa\xed\xfe" + struct.pack("<I", processor) + FUNCTIONS


def fat(*processors: int) -> bytes:
    head = b"\xca\xfe\xba\xbe" + struct.pack(">I", len(processors))
    return head + b"".join(struct.pack(">5I", p, 0, 0, 0, 0) for p in processors) + FUNCTIONS


INTEL, ARM = 0x01000007, 0x0100000C
#: Platform, a library of it, and where each version keeps it.
PLATFORMS = {
    "x86_64-linux": (elf(0x3E), "linux64/hersey.so"),
    "aarch64-linux": (elf(0xB7), ""),
    "x86-linux": (elf(3), "linux32/hersey.so"),
    "x86_64-windows": (pe(0x8664), "win64/hersey.dll"),
    "aarch64-windows": (pe(0xAA64), ""),
    "x86-windows": (pe(0x14C), "win32/hersey.dll"),
    "x86_64-darwin": (mach(INTEL), "darwin64/hersey.dylib"),
    "aarch64-darwin": (mach(ARM), "darwin64/hersey.dylib"),
}


@pytest.mark.parametrize("name", PLATFORMS)
def test_a_library_is_known_by_its_head(name: str, tmp_path: Path) -> None:
    content, folder = PLATFORMS[name]
    file = tmp_path / "library"
    file.write_bytes(content)
    wanted = platform_named(name)
    assert read_library(file, wanted, "3.0") == content
    assert wanted.path("3.0") == f"binaries/{name}/hersey{wanted.ending}"
    if folder:
        assert wanted.path("2.0") == f"binaries/{folder}"
    else:
        with pytest.raises(ParameterError, match="no folder"):
            wanted.path("2.0")
    for other in PLATFORMS.keys() - {name}:
        with pytest.raises(ParameterError, match=f"is a library for {name}, but {other} needs its own"):
            read_library(file, platform_named(other), "3.0")


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "is not a shared library"),
        (b"\x7fELF", "is not a shared library"),
        (b"MZ" + bytes(100), "is not a shared library"),
        (b"\xca\xfe\xba\xbe\0\0\0\x3d" + bytes(100), "is not a shared library"),  # a class of Java
        (b"#!/bin/sh", "is not a shared library"),
        (elf(0x3E)[:18], "is not a shared library"),
        (elf(0x15, big=True), "is a library for another processor-linux"),
        (elf(0x3E).replace(b"fmi3DoStep", b"fmi9DoStep"), "has no function fmi3DoStep"),
    ],
)
def test_what_is_no_library_is_refused(content: bytes, said: str, tmp_path: Path) -> None:
    file = tmp_path / "library"
    file.write_bytes(content)
    with pytest.raises(ParameterError, match=said):
        read_library(file, platform_named("x86_64-linux"), "3.0")


def test_a_library_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(MissingFileError, match="cannot be read: No such file"):
        read_library(tmp_path / "none.dll", platform_named("x86_64-windows"), "3.0")
    with pytest.raises(MissingFileError, match="cannot be read: Is a directory"):
        read_library(tmp_path, platform_named("x86_64-windows"), "3.0")


def test_this_platform_has_its_own() -> None:
    assert read_library(own_library(), this_platform(), "3.0")


@pytest.mark.parametrize("fmi", ["3.0", "2.0"])
def test_libraries_are_packed_for_each_platform(fmi: str, tmp_path: Path) -> None:
    (tmp_path / "hersey.dll").write_bytes(pe(0x8664))
    (tmp_path / "both.dylib").write_bytes(fat(INTEL, ARM))
    given = {"x86_64-windows": tmp_path / "hersey.dll", "aarch64-darwin": tmp_path / "both.dylib"}
    unit = hersey.export_fmu(tmp_path / "drive.fmu", TRAIN, DRAG, fmi=fmi, libraries=given)
    with zipfile.ZipFile(unit.path) as archive:
        files = {name for name in archive.namelist() if name.startswith("binaries/")}
        for name, file in given.items():
            assert archive.read(platform_named(name).path(fmi)) == file.read_bytes()
        own = archive.getinfo(this_platform().path(fmi))
        assert own.external_attr >> 16 == 0o755
    assert files == {platform_named(name).path(fmi) for name in (this_platform().name, *given)}
    assert unit.platforms == (this_platform().name, *given)


def test_two_for_one_folder_of_2_are_refused(tmp_path: Path) -> None:
    (tmp_path / "one.dylib").write_bytes(mach(INTEL))
    (tmp_path / "other.dylib").write_bytes(mach(ARM))
    given = {"x86_64-darwin": tmp_path / "one.dylib", "aarch64-darwin": tmp_path / "other.dylib"}
    with pytest.raises(ParameterError, match=r"binaries/darwin64/hersey.dylib. Give one file with both"):
        hersey.export_fmu(tmp_path / "drive.fmu", TRAIN, DRAG, fmi="2.0", libraries=given)
    assert len(hersey.export_fmu(tmp_path / "drive.fmu", TRAIN, DRAG, libraries=given).platforms) == 3
