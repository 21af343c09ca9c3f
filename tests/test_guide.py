"""Commands of the tutorial and the how-to pages work as typed; their links and pictures are there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from hersey.cli.application import VERBS, load
from tests.cli.command import run
from tests.conftest import ROOT, mostly_nightly
from tests.guide import DOCS, HOW_TO, TUTORIAL, commands, words, write_examples, write_files_of_a_reader
from tests.life import shipped

PAGES = [DOCS / "index.md", *TUTORIAL, *HOW_TO]
REFERENCE = [DOCS / "reference" / f"{name}.md" for name in ("logs", "inspect", "report", "app", "exchange")]
LINK = re.compile(r"\]\(([^)\s]+)\)")
#: Pages whose commands are typed in every run: they take a moment.
KEPT = [DOCS / "how-to" / f"{name}.md" for name in ("means", "stiffness-and-mass", "untrusted-files")]
#: A picture weighs little, so that the repository stays small.
MOST_BYTES = 150_000


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_option_of_a_command_exists(page: Path) -> None:
    """Whatever the file: nothing is read, the command only takes its arguments apart."""
    for line in commands(page, all_of_them=True):
        (verb, *arguments), _ = words(line)
        assert verb in VERBS, line
        command = load(verb)
        while (subcommands := getattr(command, "commands", None)) and arguments:
            command = subcommands[arguments.pop(0)]
        command.make_context(verb, arguments, resilient_parsing=False)


@pytest.mark.parametrize("page", [*PAGES, *REFERENCE], ids=lambda page: page.stem)
def test_links_lead_to_files_and_headings(page: Path) -> None:
    for target in LINK.findall(page.read_text(encoding="utf-8")):
        if "://" in target:
            continue
        name, _, anchor = target.partition("#")
        path = (page.parent / name).resolve() if name else page
        assert path.is_file(), f"{page.name}: {target}"
        assert path.is_relative_to(ROOT), f"{page.name}: {target}"
        if anchor:
            assert anchor in anchors(path), f"{page.name}: {target}"


def anchors(path: Path) -> set[str]:
    """Anchors of a page: of its headings, as GitHub makes them, and those that are named."""
    text = path.read_text(encoding="utf-8")
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    made = {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}
    return made | set(re.findall(r'<a id="([^"]+)">', text))


def test_every_how_to_page_is_in_the_list() -> None:
    listed = set(LINK.findall((DOCS / "how-to" / "index.md").read_text(encoding="utf-8")))
    assert listed == {page.name for page in HOW_TO if page.stem != "index"}


def test_pictures_are_used_and_small() -> None:
    pictures = sorted((DOCS / "images").glob("*.png"))
    text = "".join(page.read_text(encoding="utf-8") for page in [ROOT / "README.md", *DOCS.rglob("*.md")])
    for picture in pictures:
        assert f"images/{picture.name})" in text, f"no page shows {picture.name}"
        assert picture.stat().st_size < MOST_BYTES, picture.name
    assert len(pictures) >= 5


@pytest.mark.usefixtures("roughly")
@pytest.mark.parametrize("page", mostly_nightly([*TUTORIAL, *HOW_TO], *KEPT), ids=lambda page: page.stem)
def test_commands_work_as_typed(page: Path, tmp_path: Path) -> None:
    """In a folder with the examples and with the files that a page speaks of."""
    write_examples(tmp_path)
    write_files_of_a_reader(tmp_path)
    with shipped.few():
        for line in commands(page):
            arguments, output = words(line)
            if arguments[0] == "report" and (tmp_path / "report.html").exists():
                arguments.append("--force")  # a page may show two ways to one report
            done = run(*arguments, cwd=tmp_path)
            assert done.returncode == 0, f"{line}: {done.stderr}"
            if output:
                (tmp_path / output).write_text(done.stdout)
