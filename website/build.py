"""Build the site of the docs: ``python -m website.build [FOLDER]``, without a network.

The pages are copied first. In the copy a link to a file of the repository that is no page of the docs, such
as SECURITY.md, becomes its name, because the site does not hold it.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from website.navigation import DOCS, ROOT, Entry, missing, navigation

#: A link or picture of Markdown: its words and its target.
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^()\s]+(?:\([^()]*\))?)\)")
#: What the generator prints around its words, and what it says of a page: the warning, and page and line.
_COLOUR = re.compile(r"\x1b\[[0-9;]*m")
_WARNING = re.compile(r"^Warning: (.+)\n.*?\[ (\S+:\d+):\d+ \]", re.MULTILINE)
_CONFIGURATION = """\
[project]
site_name = "hersey"
site_description = "From a torque log to a safe operating speed"
docs_dir = "pages"
site_dir = "{site}"
use_directory_urls = false
extra_css = ["assets/site.css"]
nav = {nav}

[project.theme]
font = false
favicon = "assets/icon.svg"
logo = "assets/icon.svg"
features = [
  "content.code.copy",
  "navigation.footer",
  "navigation.indexes",
  "navigation.sections",
  "navigation.tabs",
  "navigation.top",
  "search.highlight",
  "toc.follow",
]

[[project.theme.palette]]
media = "(prefers-color-scheme: light)"
scheme = "default"
toggle = {{ icon = "lucide/sun", name = "Switch to dark mode" }}

[[project.theme.palette]]
media = "(prefers-color-scheme: dark)"
scheme = "slate"
toggle = {{ icon = "lucide/moon", name = "Switch to light mode" }}

[project.extra]
generator = false

[[project.extra.polyfills]]
path = "assets/iframe-worker.js"
type = "text/javascript"
async = false
defer = false

[project.plugins.offline]

[project.plugins.search]

[project.plugins.mkdocstrings.handlers.python]
paths = ["{python}"]

[project.plugins.mkdocstrings.handlers.python.options]
docstring_style = "numpy"
docstring_section_style = "table"
extensions = [{{ "{root}/website/described.py" = {{}} }}]
filters = ["!^_"]
heading_level = 2
members_order = "source"
merge_init_into_class = true
separate_signature = true
show_attribute_values = false
show_bases = false
show_labels = false
show_category_heading = false
show_root_full_path = false
show_root_heading = true
show_signature_annotations = false
show_source = false
show_symbol_type_heading = true
show_symbol_type_toc = false
"""


def build(folder: Path) -> Path:
    """Build the site into ``folder / "site"`` and return that folder.

    Raises
    ------
    SystemExit
        If a link leads nowhere, or the generator fails.
    """
    pages, site = folder / "pages", folder / "site"
    for old in (pages, site):
        shutil.rmtree(old, ignore_errors=True)
    shutil.copytree(DOCS, pages)
    for page in sorted(pages.rglob("*.md")):
        at = DOCS / page.relative_to(pages)
        page.write_text(_within(page.read_text(encoding="utf-8"), at), encoding="utf-8")
    assets = pages / "assets"
    shutil.copytree(Path(__file__).parent / "static", assets)
    shutil.copy(ROOT / "python" / "hersey" / "app" / "static" / "icon.svg", assets)
    text = _CONFIGURATION.format(nav=_toml(navigation()), site=site.name, python=ROOT / "python", root=ROOT)
    (folder / "zensical.toml").write_text(text, encoding="utf-8")
    made = subprocess.run(
        [sys.executable, "-m", "zensical", "build", "--clean"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    said = _COLOUR.sub("", made.stdout + made.stderr)
    if made.returncode or not (site / "search.json").is_file():
        sys.exit(said)
    if wrong := [f"docs/{where}: {what}" for what, where in _WARNING.findall(said)]:
        sys.exit("\n".join(wrong))
    return site


def _within(text: str, page: Path) -> str:
    """The text of a page; links that leave the docs are words."""

    def target(match: re.Match[str]) -> str:
        to = match[3].partition("#")[0]
        outside = to and ":" not in to and not (page.parent / to).resolve().is_relative_to(DOCS)
        return match[2] if outside else match[0]

    return LINK.sub(target, text)


def _toml(value: str | list[Entry] | Entry) -> str:
    """An entry of the navigation as TOML."""
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return f'"{escaped}"'
    if isinstance(value, list):
        return f"[{', '.join(map(_toml, value))}]"
    return "{ " + ", ".join(f"{_toml(key)} = {_toml(each)}" for key, each in value.items()) + " }"


if __name__ == "__main__":
    for lacking in missing():
        sys.stderr.write(f"the docs lack {lacking}\n")
    made = build(Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build" / "docs").resolve())
    sys.stdout.write(
        f"site: {made / 'index.html'}\n"
        "Open this file in a browser. It needs no network. Or serve it on this computer:\n"
        f"  python3 -m http.server --bind 127.0.0.1 --directory {os.path.relpath(made)}\n"
    )
