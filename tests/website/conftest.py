"""The site, built once for all processes of a run."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

from tests.conftest import made_once
from website.build import build


@pytest.fixture(scope="session")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of the built site; the test skips where its generator is not installed."""
    for package in ("zensical", "mkdocstrings", "mkdocstrings_handlers"):
        if importlib.util.find_spec(package) is None:
            pytest.skip(f"{package} is not installed: pip install --group docs")
    return made_once("site", lambda: build(tmp_path_factory.mktemp("docs")))
