"""TDMS, MATLAB v4 and v5, LVM, Excel: written byte by byte from their pages, with lengths that may lie.

Sources: NI, TDMS File Format Internal Structure; MathWorks, MAT-File Format; NI, LabVIEW Measurement File.
"""

from __future__ import annotations

import io
import struct
import zipfile
import zlib
from collections.abc import Sequence
from xml.sax.saxutils import escape

import numpy as np


def tdms(
    channels: Sequence[tuple[str, str, np.ndarray]],
    *,
    step: float = 0.01,
    count: int | None = None,
    next_segment: int | None = None,
) -> bytes:
    """Return a TDMS file of one segment; ``count``: the values that it claims for each channel."""

    def words(text: str) -> bytes:
        return struct.pack("<I", len(text.encode())) + text.encode()

    parts = [words("/"), struct.pack("<II", 0xFFFFFFFF, 0)]
    for name, unit, values in channels:
        quoted = name.replace("'", "''")
        parts += [words(f"/'Rig'/'{quoted}'"), struct.pack("<III", 20, 10, 1)]
        parts += [struct.pack("<QI", len(values) if count is None else count, 3)]
        parts += [words("unit_string"), struct.pack("<I", 0x20), words(unit)]
        parts += [words("wf_increment"), struct.pack("<Id", 10, step)]
        parts += [words("wf_start_offset"), struct.pack("<Id", 10, 0.0)]
    meta = struct.pack("<I", len(channels) + 1) + b"".join(parts)
    raw = b"".join(np.asarray(values, "<f8").tobytes() for _, _, values in channels)
    length = len(meta) + len(raw) if next_segment is None else next_segment
    return struct.pack("<4sIIQQ", b"TDSm", 2 | 4 | 8, 4713, length, len(meta)) + meta + raw


def mat4(variables: dict[str, np.ndarray]) -> bytes:
    """Return a MATLAB v4 file of column vectors."""
    return b"".join(
        struct.pack("<5i", 0, len(values), 1, 0, len(name) + 1) + name.encode() + b"\0" + values.tobytes()
        for name, values in variables.items()
    )


MAT5_HEAD = b"MATLAB 5.0 MAT-file, by a stranger".ljust(116) + bytes(8) + b"\x00\x01IM"


def element(kind: int, data: bytes, size: int | None = None) -> bytes:
    """An element of MATLAB v5, with the size that its tag claims."""
    return struct.pack("<II", kind, len(data) if size is None else size) + data + bytes(-len(data) % 8)


def matrix(name: str, values: np.ndarray, rows: int | None = None) -> bytes:
    """A column vector of doubles as an element, with the rows that it claims."""
    return element(
        14,
        element(6, struct.pack("<II", 6, 0))
        + element(5, struct.pack("<ii", len(values) if rows is None else rows, 1))
        + element(1, name.encode())
        + element(9, np.asarray(values, "<f8").tobytes()),
    )


def mat5(elements: Sequence[bytes], *, packed: bool = False) -> bytes:
    """Return a MATLAB v5 file of elements, each compressed if so."""
    parts = list(elements)
    if packed:
        squeezed = [zlib.compress(part) for part in parts]
        parts = [struct.pack("<II", 15, len(part)) + part for part in squeezed]
    return MAT5_HEAD + b"".join(parts)


def lvm(channels: Sequence[tuple[str, str, np.ndarray]], *, step: float = 0.01) -> bytes:
    """Return a LabVIEW measurement file of one segment with an X column."""
    count, rows = len(channels), len(channels[0][2])

    def line(word: str, *cells: object) -> str:
        return "\t".join([word, *(str(cell) for cell in (cells or [""]) for _ in range(count))]) + "\t"

    lines = ["LabVIEW Measurement\t", "Writer_Version\t2", "Reader_Version\t2", "Separator\tTab"]
    lines += ["Decimal_Separator\t.", "Multi_Headings\tNo", "X_Columns\tOne", "Time_Pref\tRelative"]
    lines += ["Date\t2024/01/02", "Time\t10:00:00.5", "***End_of_Header***\t", "\t"]
    lines += [f"Channels\t{count}" + "\t" * count, line("Samples", rows), line("Date", "2024/01/02")]
    lines += [line("Time", "10:00:00.5"), "\t".join(["Y_Unit_Label", *(u for _, u, _ in channels)]) + "\t"]
    lines += [line("X_Dimension", "Time"), line("X0", 0), line("Delta_X", step)]
    lines += ["***End_of_Header***" + "\t" * (count + 1)]
    lines += ["\t".join(["X_Value", *(name for name, _, _ in channels), "Comment"])]
    for row in range(rows):
        cells = [f"{row * step:.6f}", *(f"{values[row]:.9f}" for _, _, values in channels)]
        lines.append("\t".join(cells) + "\t")
    return ("\r\n".join(lines) + "\r\n").encode()


_OFFICE = "http://schemas.openxmlformats.org"
_XLSX = {
    "[Content_Types].xml": f'<Types xmlns="{_OFFICE}/package/2006/content-types">'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="xml" ContentType="application/xml"/>'
    '<Override PartName="/xl/workbook.xml" ContentType='
    '"application/vnd.openxmlformats-officedocument.spreadsheetml.sheet.main+xml"/></Types>',
    "_rels/.rels": f'<Relationships xmlns="{_OFFICE}/package/2006/relationships"><Relationship Id="r0" '
    f'Type="{_OFFICE}/officeDocument/2006/relationships/officeDocument" Target="xl/workbook.xml"/>'
    "</Relationships>",
    "xl/styles.xml": f'<styleSheet xmlns="{_OFFICE}/spreadsheetml/2006/main"><cellXfs count="2">'
    '<xf numFmtId="0"/><xf numFmtId="22" applyNumberFormat="1"/></cellXfs></styleSheet>',
}


def xlsx(sheets: dict[str, Sequence[Sequence[object]]]) -> bytes:
    """Return a workbook: a number, a word, an error such as ``#N/A``, or nothing (None) in each cell.

    A tuple of one number is a date in days of Excel. Source: ECMA-376, part 1, 18.3.
    """
    parts, links, listed = dict(_XLSX), [], []
    for number, (title, rows) in enumerate(sheets.items(), start=1):
        path = f"worksheets/sheet{number}.xml"
        parts[f"xl/{path}"] = _sheet(rows)
        kind = f"{_OFFICE}/officeDocument/2006/relationships/worksheet"
        links.append(f'<Relationship Id="s{number}" Type="{kind}" Target="{path}"/>')
        listed.append(f'<sheet name="{escape(title)}" sheetId="{number}" r:id="s{number}"/>')
    styles = f"{_OFFICE}/officeDocument/2006/relationships/styles"
    links.append(f'<Relationship Id="st" Type="{styles}" Target="styles.xml"/>')
    space = f'xmlns="{_OFFICE}/package/2006/relationships"'
    parts["xl/_rels/workbook.xml.rels"] = f"<Relationships {space}>{''.join(links)}</Relationships>"
    main = f'xmlns="{_OFFICE}/spreadsheetml/2006/main"'
    related = f'xmlns:r="{_OFFICE}/officeDocument/2006/relationships"'
    parts["xl/workbook.xml"] = f"<workbook {main} {related}><sheets>{''.join(listed)}</sheets></workbook>"
    memory = io.BytesIO()
    with zipfile.ZipFile(memory, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in parts.items():
            archive.writestr(zipfile.ZipInfo(name), text, zipfile.ZIP_DEFLATED)
    return memory.getvalue()


def _sheet(rows: Sequence[Sequence[object]]) -> str:
    lines = []
    for number, row in enumerate(rows, start=1):
        cells = "".join(_cell(f"{chr(65 + i)}{number}", value) for i, value in enumerate(row))
        lines.append(f'<row r="{number}">{cells}</row>')
    data = f"<sheetData>{''.join(lines)}</sheetData>"
    return f'<worksheet xmlns="{_OFFICE}/spreadsheetml/2006/main">{data}</worksheet>'


def _cell(place: str, value: object) -> str:
    match value:
        case None:
            return ""
        case str() if value.startswith("#"):
            return f'<c r="{place}" t="e"><v>{value}</v></c>'
        case str():
            return f'<c r="{place}" t="inlineStr"><is><t>{escape(value)}</t></is></c>'
        case (days,):
            return f'<c r="{place}" s="1"><v>{days!r}</v></c>'
    return f'<c r="{place}"><v>{float(value)!r}</v></c>'  # type: ignore[arg-type]
