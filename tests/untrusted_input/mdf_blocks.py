"""MDF files written block by block.

Source: ASAM MDF 4.1 and MDF 3.3, the layout of the blocks. Nothing of asammdf is used.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

ALGEBRAIC, VALUE_TO_TEXT, RANGE_TO_TEXT = 3, 7, 8


@dataclass
class Conversion:
    """A conversion block of MF4: ``references`` are formulas, texts or further conversions."""

    kind: int
    references: Sequence[str | bytes | Conversion | None] = ()
    values: Sequence[float] = ()
    unit: str = ""
    comment: str = ""


def formula(text: str | bytes) -> Conversion:
    """An algebraic conversion."""
    return Conversion(ALGEBRAIC, [text])


@dataclass
class Channel:
    """A channel of MF4; ``values`` in the type in which they are stored; ``kind`` 2 is the master."""

    name: str
    values: np.ndarray
    unit: str = ""
    conversion: Conversion | None = None
    kind: int = 0
    comment: str = ""


class _File:
    def __init__(self) -> None:
        self.content = bytearray()

    def block(self, name: bytes, links: Sequence[int], data: bytes) -> int:
        """Append a block and return its place."""
        self.content += bytes(-len(self.content) % 8)
        place = len(self.content)
        length = 24 + 8 * len(links) + len(data)
        self.content += struct.pack(f"<4sIQQ{len(links)}Q", b"##" + name, 0, length, len(links), *links)
        self.content += data
        return place

    def text(self, text: str | bytes, name: bytes = b"TX") -> int:
        if not text:
            return 0
        words = text if isinstance(text, bytes) else text.encode("utf-8", errors="surrogatepass")
        return self.block(name, (), words + bytes(8 - len(words) % 8))

    def conversion(self, conversion: Conversion | None) -> int:
        if conversion is None:
            return 0
        references = [
            self.conversion(one) if one is None or isinstance(one, Conversion) else self.text(one)
            for one in conversion.references
        ]
        comment = conversion.comment
        links = [0, self.text(conversion.unit), self.text(comment, _kind_of(comment)), 0, *references]
        head = struct.pack(
            "<BBHHHdd", conversion.kind, 0, 0, len(references), len(conversion.values), 0.0, 0.0
        )
        return self.block(b"CC", links, head + np.asarray(conversion.values, "<f8").tobytes())


def _kind_of(text: str) -> bytes:
    return b"MD" if text.startswith("<") else b"TX"


def mf4(
    channels: Sequence[Channel],
    *,
    comment: str = "",
    cycles: int | None = None,
    packed_length: int | None = None,
    packed: bytes = b"",
) -> bytes:
    """Return an MF4 file of one group.

    ``cycles`` is what the group says of its length, where that is not so; ``packed_length`` is what a zipped
    block says of its own, and ``packed`` what stands in it instead.
    """
    file = _File()
    file.content += struct.pack("<8s8s8s4sH34x", b"MDF     ", b"4.10    ", b"stranger", b"", 410)
    file.content += bytes(104)  # the header, once it is known where the rest stands
    history = file.block(b"FH", (0, file.text("<FHcomment><TX>x</TX></FHcomment>", b"MD")), bytes(16))
    following, offset = 0, sum(channel.values.dtype.itemsize for channel in channels)
    record = offset
    for channel in reversed(channels):
        offset -= channel.values.dtype.itemsize
        following = file.block(b"CN", _links(file, channel, following), _description(channel, offset))
    rows = len(channels[0].values)
    table = np.rec.fromarrays([c.values for c in channels], names=[f"f{i}" for i in range(len(channels))])
    plain = table.tobytes()
    if packed_length is None:
        data = file.block(b"DT", (), plain)
    else:
        content = packed or zlib.compress(plain)
        data = file.block(
            b"DZ", (), struct.pack("<2sBBIQQ", b"DT", 0, 0, 0, packed_length, len(content)) + content
        )
    group = file.block(
        b"CG",
        (0, following, 0, 0, 0, 0),
        struct.pack("<QQHH4xII", 0, rows if cycles is None else cycles, 0, 0, record, 0),
    )
    first = file.block(b"DG", (0, group, data, 0), bytes(8))
    links = (first, history, 0, 0, 0, file.text(comment, _kind_of(comment)))
    head = struct.pack("<4sIQQ6QQhhBBBBdd", b"##HD", 0, 104, 6, *links, 1_700_000_000 * 10**9, *[0] * 8)
    file.content[64:168] = head
    return bytes(file.content)


def _links(file: _File, channel: Channel, following: int) -> tuple[int, ...]:
    name, unit = file.text(channel.name), file.text(channel.unit)
    comment = file.text(channel.comment, _kind_of(channel.comment))
    return (following, 0, name, 0, file.conversion(channel.conversion), 0, unit, comment)


def _description(channel: Channel, offset: int) -> bytes:
    kind = {"u": 0, "i": 2, "f": 4}[channel.values.dtype.kind]
    bits = channel.values.dtype.itemsize * 8
    timed = int(channel.kind == 2)
    return struct.pack("<BBBBIIIIBBH6d", channel.kind, timed, kind, 0, offset, bits, *[0] * 11)


def mdf3(
    channels: Sequence[tuple[str, str, np.ndarray, bytes | None]],
    *,
    long_name: bytes = b"",
    comment: bytes = b"",
) -> bytes:
    """Return an MDF 3 file: name, unit, values and formula (or None) of each channel, the clock first."""
    content = bytearray(struct.pack("<8s8s8sHHHH32x", b"MDF     ", b"3.30    ", b"stranger", 0, 0, 330, 0))
    content = content[:64] + bytes(208)

    def add(block: bytes) -> int:
        content.extend(block)
        return len(content) - len(block)

    def text(words: bytes) -> int:
        return add(struct.pack("<2sH", b"TX", 5 + len(words)) + words + b"\0") if words else 0

    following, offset = 0, sum(values.dtype.itemsize for _, _, values, _ in channels)
    record = offset
    for place, (name, unit, values, told) in reversed(list(enumerate(channels))):
        offset -= values.dtype.itemsize
        kind, extra = (65535, b"") if told is None else (10, told)
        conversion = add(
            struct.pack("<2sHHdd20sHH", b"CC", 46 + len(extra), 0, 0.0, 0.0, unit.encode(), kind, len(extra))
            + extra
        )
        following = add(
            struct.pack("<2sH5IH32s128s", b"CN", 228, following, conversion, 0, 0, text(comment), place == 0,
                        name.encode()[:31], b"")
            + struct.pack("<HHHH3dIIH", offset * 8, values.dtype.itemsize * 8,
                          {"u": 0, "i": 1, "f": 3}[values.dtype.kind], 0, *[0.0] * 3, text(long_name), 0, 0)
        )  # fmt: skip
    rows = len(channels[0][2])
    group = add(struct.pack("<2sH3IHHHI", b"CG", 26, 0, following, 0, 0, len(channels), record, rows))
    table = np.rec.fromarrays([c[2] for c in channels], names=[f"f{i}" for i in range(len(channels))])
    data = add(table.tobytes())
    first = add(struct.pack("<2sH4IHHI", b"DG", 28, 0, group, 0, data, 1, 0, 0))
    content[64:272] = struct.pack(
        "<2sH3IH10s8s32s32s32s32sQhH32s", b"HD", 208, first, 0, 0, 1, b"01:03:2024", b"08:00:00",
        b"", b"", b"", b"", 1_700_000_000 * 10**9, 0, 0, b"",
    )  # fmt: skip
    return bytes(content)
