"""Text that a command was given, with errors that a person can act on, and values as messages show them."""

from __future__ import annotations

import codecs
from pathlib import Path

from hersey.errors import ParameterError, UnreadableLogError
from hersey.files.reading import open_file

#: Bytes of a text file at the most: what is read from it takes many times as much memory.
MOST_BYTES = 64_000_000
#: What is wrong with a file that is no text.
NO_TEXT = "is not plain text in UTF-8. Save it with a text editor as plain text, encoding UTF-8"
#: Characters of a value that a message shows.
_SHOWN = 60
#: Words of headers, by the encoding of East Asia in which they are looked for.
_WORDS = {
    "cp932": ("時間", "トルク", "回転", "温度", "速度"),
    "gb18030": ("时间", "扭矩", "转矩", "转速", "温度", "速度"),
    "big5": ("時間", "扭矩", "轉速", "溫度", "速度"),
    "cp949": ("시간", "토크", "회전", "온도", "속도"),
}
#: Bytes that mean nothing in Windows-1252.
_NOT_CP1252 = (b"\x81", b"\x8d", b"\x8f", b"\x90", b"\x9d")


def read_text(path: Path, *, most: int = MOST_BYTES) -> str:
    """Return the text, UTF-8 with or without its mark, or UTF-16 with it.

    Raises
    ------
    MissingFileError
        If there is no such file, it is no ordinary one, or it cannot be read.
    ParameterError
        If it has more than ``most`` bytes, or is neither.
    """
    text = _bytes(path, most)
    marked = text.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    try:
        return _plain_lines(text.decode("utf-16" if marked else "utf-8-sig"))
    except UnicodeDecodeError as error:
        raise ParameterError(f"{path.name}{_not_utf8(error)}") from None


def _not_utf8(error: UnicodeDecodeError) -> str:
    """What follows the name of a file: where it is not UTF-8, and the character that was probably meant."""
    whole: bytes = error.object
    if b"\0" in whole[:1000]:
        return f" {NO_TEXT}"
    line, char = (
        whole.count(b"\n", 0, error.start) + 1,
        whole[error.start : error.start + 1].decode("cp1252", "replace"),
    )
    return f", line {line}: '{char}' is not in UTF-8. Save the file as plain text, encoding UTF-8"


def read_table_text(path: Path) -> str:
    """Return the text of a small table in any encoding that a log may have.

    Raises
    ------
    MissingFileError
        If there is no such file, it is no ordinary one, or it cannot be read.
    ParameterError, UnreadableLogError
        If it is larger than `MOST_BYTES`; if it is no text.
    """
    text = _bytes(path, MOST_BYTES)
    encoding = encoding_of(text)
    if not encoding:
        raise UnreadableLogError(f"{path.name} is not a text file. Save the table as CSV")
    return _plain_lines(text.decode(encoding, errors="replace"))


def encoding_of(start: bytes) -> str:
    """Return the encoding of a text file from its first bytes; an empty text if they are no text."""
    if start.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "utf-16"
    if b"\0" in start:
        odd, even = start[1::2].count(0), start[::2].count(0)
        if max(odd, even) > 0.4 * len(start) and not min(odd, even):  # every other byte of plain text
            return "utf-16-le" if odd else "utf-16-be"
        return ""
    try:
        codecs.getincrementaldecoder("utf-8")().decode(start)
    except UnicodeDecodeError:
        if east_asian := next((each for each in _WORDS if _holds_words(start, each)), ""):
            return east_asian
        return "cp1252" if not any(code in start for code in _NOT_CP1252) else "latin-1"
    return "utf-8-sig"


def _holds_words(start: bytes, encoding: str) -> bool:
    """Whether bytes are a text in an encoding of East Asia, with a word of a header."""
    try:
        text = codecs.getincrementaldecoder(encoding)().decode(start)
    except UnicodeDecodeError:
        return False
    return any(word in text for word in _WORDS[encoding])


def _bytes(path: Path, most: int) -> bytes:
    with open_file(path) as file:
        text = file.read(most + 1)
    if len(text) > most:
        raise ParameterError(f"{path.name} is larger than {most} bytes, the limit for such a file")
    return text


def _plain_lines(text: str) -> str:
    return text.replace("\r\n", "\n").replace("\r", "\n")


def shown(value: object) -> str:
    """Return a value of a file as a message shows it, cut where it is long."""
    try:
        text = repr(value)
    except ValueError:  # an integer with more digits than Python writes
        return "a number with thousands of digits"
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."
