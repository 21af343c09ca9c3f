"""Two workers on this machine, shared by all tests that need some."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

from hersey.scale.cluster import local_cluster

if TYPE_CHECKING:
    from distributed import Client


@pytest.fixture(scope="session")
def client() -> Iterator[Client]:
    """The client of two workers, a process each."""
    with local_cluster(2) as client:
        yield client
