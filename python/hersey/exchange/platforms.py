"""Where a unit keeps the library of each platform, and of which platform a library is."""

from __future__ import annotations

import platform
import struct
import sys
from dataclasses import dataclass
from pathlib import Path

from hersey.errors import MissingFileError, ParameterError, Setting

#: Name of the library in a unit, and of the file that this package brings.
LIBRARY = "hersey"


@dataclass(frozen=True)
class Platform:
    """A platform: its name in FMI 3.0, its folder in FMI 2.0 (empty where that has none), its ending."""

    name: str
    folder_2: str
    ending: str

    def path(self, fmi: str) -> str:
        """Return the path of the library in a unit.

        Raises
        ------
        ParameterError
            If FMI 2.0 has no folder for the platform.
        """
        folder = self.name if fmi == "3.0" else self.folder_2
        if not folder:
            raise ParameterError(
                f"FMI {fmi} has no folder for {self.name}. Omit it, or use {Setting('fmi').to('3.0')}"
            )
        return f"binaries/{folder}/{LIBRARY}{self.ending}"


_PLATFORMS = {
    p.name: p
    for p in (
        Platform("x86_64-linux", "linux64", ".so"),
        Platform("x86_64-windows", "win64", ".dll"),
        Platform("x86_64-darwin", "darwin64", ".dylib"),
        Platform("aarch64-darwin", "darwin64", ".dylib"),
        Platform("aarch64-linux", "", ".so"),
        Platform("aarch64-windows", "", ".dll"),
        Platform("x86-linux", "linux32", ".so"),
        Platform("x86-windows", "win32", ".dll"),
    )
}
_SYSTEMS = {"linux": "linux", "darwin": "darwin", "win32": "windows"}
_PROCESSORS = {"amd64": "x86_64", "arm64": "aarch64", "i386": "x86", "i686": "x86"}
#: Processors by their number in the head of a library: ELF, PE, Mach-O.
_ELF = {0x3E: "x86_64", 0xB7: "aarch64", 0x03: "x86"}
_PE = {0x8664: "x86_64", 0xAA64: "aarch64", 0x14C: "x86"}
_MACH = {0x01000007: "x86_64", 0x0100000C: "aarch64", 7: "x86"}
#: Architectures that one fat library holds at the most; a Java class, which begins alike, says more.
_MOST_IN_FAT = 16


def platform_named(name: str) -> Platform:
    """Return a platform by its name in FMI 3.0.

    Raises
    ------
    ParameterError
        If there is none of that name.
    """
    if name not in _PLATFORMS:
        raise ParameterError(f"platform '{name}' is not known: {', '.join(_PLATFORMS)}")
    return _PLATFORMS[name]


def this_platform() -> Platform:
    """Return the platform of this Python."""
    processor = platform.machine().lower()
    return platform_named(
        f"{_PROCESSORS.get(processor, processor)}-{_SYSTEMS.get(sys.platform, sys.platform)}"
    )


def own_library() -> Path:
    """Return where this package keeps the library of its own platform, which may not be there."""
    return Path(__file__).parent / "library" / f"{LIBRARY}{this_platform().ending}"


def read_library(path: Path, wanted: Platform, fmi: str) -> bytes:
    """Return the content of a library, after a look at what it is.

    Raises
    ------
    MissingFileError
        If it is not there or cannot be read.
    ParameterError
        If it is no library, one of another platform, or one without the functions of this FMI version.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise MissingFileError(f"{path} cannot be read: {error.strerror}") from None
    found = _platforms_of(content)
    if wanted.name not in found:
        what = f"is a library for {' and '.join(found)}" if found else "is not a shared library"
        raise ParameterError(
            f"{path} {what}, but {wanted.name} needs its own (see docs/reference/exchange.md)"
        )
    step = f"fmi{fmi[0]}DoStep"
    if step.encode() not in content:
        raise ParameterError(f"{path} has no function {step}, so it was not built from hersey's crates/c")
    return content


def _platforms_of(content: bytes) -> tuple[str, ...]:
    """The platforms that the head of a library names; none if it is no library."""
    try:
        return _platforms_in_head(content)
    except struct.error:  # it ends within its head
        return ()


def _platforms_in_head(content: bytes) -> tuple[str, ...]:
    kind, system = content[:4], ""
    numbers: tuple[int, ...] = ()
    known: dict[int, str] = {}
    if kind == b"\x7fELF":
        system, numbers, known = "linux", struct.unpack_from("<H", content, 18), _ELF
    elif kind[:2] == b"MZ":
        (head,) = struct.unpack_from("<I", content, 0x3C)
        if content[head : head + 4] == b"PE\0\0":
            system = "windows"
            numbers, known = struct.unpack_from("<H", content, head + 4), _PE
    elif kind in (b"\xcf\xfa\xed\xfe", b"\xce\xfa\xed\xfe"):
        system, numbers, known = "darwin", struct.unpack_from("<I", content, 4), _MACH
    elif kind == b"\xca\xfe\xba\xbe":
        (count,) = struct.unpack_from(">I", content, 4)
        if count <= _MOST_IN_FAT:
            system = "darwin"
            numbers = tuple(struct.unpack_from(">I", content, 8 + 20 * i)[0] for i in range(count))
            known = _MACH
    return tuple(f"{known.get(number, 'another processor')}-{system}" for number in numbers)
