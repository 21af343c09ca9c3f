"""Units in the importers of others, so far as they are installed: benchmarks/importers.py runs them all."""

from __future__ import annotations

from pathlib import Path

import pytest
from benchmarks.importers import IMPORTERS, AbsentError, difference, unit


@pytest.mark.parametrize(
    ("name", "fmi"), [(name, fmi) for name, (_, each) in IMPORTERS.items() for fmi in each]
)
def test_an_importer_runs_a_unit_as_the_core_does(name: str, fmi: str, tmp_path: Path) -> None:
    try:
        assert difference(name, unit(tmp_path, fmi)) < 1e-9
    except AbsentError as absent:
        pytest.skip(str(absent))
