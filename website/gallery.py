"""Make the pictures of the gallery anew: ``python -m website.gallery [NAME ...]`` (minutes).

Every block of code of ``docs/gallery.md`` is run as it is typed, one after the other, in a folder that holds
the examples. The pictures below a block are those that it writes. With names, only the blocks of these
pictures are run.
"""

from __future__ import annotations

import io
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from website.navigation import DOCS, ROOT

PAGE = DOCS / "gallery.md"
PICTURES = DOCS / "images" / "gallery"
#: A block of code, and a picture.
_BLOCK = re.compile(r"^```(sh|python)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
_PICTURE = re.compile(r"!\[[^\]]*\]\(images/gallery/([\w./-]+)\)")
#: Width of a picture at the most, and its number of colours.
_WIDTH, _COLOURS = 900, 96


def blocks() -> list[tuple[str, str, list[str]]]:
    """Return each block of the page: its language, its code, and the pictures below it."""
    text = PAGE.read_text(encoding="utf-8")
    found = list(_BLOCK.finditer(text))
    ends = [each.start() for each in found[1:]] + [len(text)]
    return [
        (each[1], each[2], _PICTURE.findall(text[each.end() : end]))
        for each, end in zip(found, ends, strict=True)
    ]


def make(wanted: set[str]) -> None:
    """Run the blocks and keep their pictures."""
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        shutil.copytree(ROOT / "examples", here / "examples")
        for language, code, pictures in blocks():
            if wanted and not wanted & set(pictures):
                continue
            lines = [code] if language == "python" else code.splitlines()
            for line in lines:
                typed = [sys.executable, "-c", line] if language == "python" else _typed(line)
                subprocess.run(typed, cwd=here, shell=language == "sh", check=True)
            for name in pictures:
                _keep(here / name, PICTURES / name)


def _typed(line: str) -> str:
    """A line of a shell; `hersey` and `python` are those of this process."""
    return re.sub(r"^hersey ", f"{sys.executable} -m hersey.cli ", line).replace(
        "python examples", f"{sys.executable} examples"
    )


def _keep(made: Path, kept: Path) -> None:
    """Keep a picture: no wider than needed, with few colours."""
    from PIL import Image

    with Image.open(made) as picture:
        small = picture.convert("RGB")
        if small.width > _WIDTH:
            small = small.resize(
                (_WIDTH, round(small.height * _WIDTH / small.width)), Image.Resampling.LANCZOS
            )
        content = io.BytesIO()
        small.quantize(_COLOURS, dither=Image.Dither.NONE).save(content, "PNG", optimize=True)
    kept.parent.mkdir(parents=True, exist_ok=True)
    kept.write_bytes(content.getvalue())
    sys.stdout.write(f"{kept.relative_to(ROOT)}: {len(content.getvalue()) / 1000:.0f} kB\n")


if __name__ == "__main__":
    make(set(sys.argv[1:]))
