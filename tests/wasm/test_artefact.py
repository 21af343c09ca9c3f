"""The core in the page is made of the sources that stand here."""

from __future__ import annotations

import hashlib
from importlib import resources

from tests.conftest import ROOT

STATIC = resources.files("hersey.report") / "static"
#: What `make physics` compiles; the Makefile takes the sum of the same files in the same order.
PLACES = (("Cargo.toml", "crates/core/Cargo.toml", "crates/wasm/Cargo.toml"), ("core", "wasm"))


def sources() -> str:
    """Sum of the sources."""
    manifests, crates = PLACES
    paths = [*manifests]
    for crate in crates:
        found = (ROOT / "crates" / crate / "src").rglob("*.rs")
        paths += [path.relative_to(ROOT).as_posix() for path in found]
    together = b"".join((ROOT / path).read_bytes() for path in sorted(paths))
    return hashlib.sha256(together).hexdigest()


def test_it_is_made_of_these_sources() -> None:
    of_sources, of_artefact = (STATIC / "physics.sha256").read_text().split()
    assert of_sources == sources(), "the core has changed since the page's was compiled: make physics"
    assert of_artefact == hashlib.sha256((STATIC / "physics.wasm").read_bytes()).hexdigest()


def test_it_is_small_and_names_no_machine() -> None:
    """It stands in every report, as text a third as large again."""
    module = (STATIC / "physics.wasm").read_bytes()
    assert len(module) < 450_000
    assert module[:4] == b"\0asm"
    for place in (b"/home/", b"/usr/", b".cargo/", b"rustup"):
        assert place not in module
