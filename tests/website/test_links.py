"""Every link of the repository's pages leads to a file that is there, and to a heading of it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.conftest import ROOT
from tests.website.links import broken, links, pages


@pytest.mark.parametrize("page", pages(ROOT), ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_link_leads_somewhere(page: Path) -> None:
    assert broken(page) == []


def test_a_broken_link_is_seen(tmp_path: Path) -> None:
    page = tmp_path / "a.md"
    page.write_text(
        "# A `b` c*\n\n[x](#a-b-c) [y](#a) [z](b.md) ![p](p.png) [w](a.md#a-b-c) [q](https://x.y)\n"
        "```\n[n](gone.md)\n```\n`[m](gone.md)` [long\ntext](gone.md)\n"
    )
    assert len(links(page)) == 6
    assert broken(page) == ["#a", "b.md", "p.png", "gone.md"]
