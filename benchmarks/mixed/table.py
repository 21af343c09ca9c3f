"""Write the full solution of the contact of examples/machine.toml: the truth of the shipped logs.

Usage: python -m benchmarks.mixed.table [FILE] (about ten minutes)
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from benchmarks.mixed.full_contact import Floats, Layer, Solution, Summits, march
from hersey.lubrication.mixed import MixedContact
from hersey.machine.machine import read_machine
from hersey.testbench.full_contact import COLUMNS, TABLE

MACHINE = Path(__file__).parents[2] / "examples" / "machine.toml"
#: eta U, Pa m: from a film of 40 times the roughness down to asperities that carry most.
PRODUCTS: Floats = np.geomspace(5e-2, 3e-6, 55)


def nip_of(mixed: MixedContact) -> tuple[Layer, Summits]:
    """Return a contact as the full solution takes it."""
    contact, asperities = mixed.contact, mixed.asperities
    assert contact.roughness is not None
    star = contact.modulus / (1.0 - contact.poisson_ratio**2)
    load = contact.load / contact.length
    layer = Layer(contact.reduced_radius, load, star, contact.poisson_ratio, contact.rubber_thickness)
    shape = asperities.sigma_beta_density, asperities.sigma_over_beta
    return layer, Summits(contact.roughness, asperities.modulus, *shape)


def row(summits: Summits, solution: Solution) -> list[float]:
    """Return a row of the table."""
    films = solution.central / summits.sigma, solution.minimum / summits.sigma
    return [solution.product, *films, solution.share, solution.shear, solution.pressure]


def write(path: Path) -> None:
    """Write the table of the machine file's contact."""
    mixed = read_machine(MACHINE).mixed
    assert mixed is not None
    layer, summits = nip_of(mixed)
    rows = [row(summits, both[1]) for both in march(layer, summits, PRODUCTS, fineness=1.4)]
    lines = [",".join(f"{value:.8g}" for value in each) for each in reversed(rows)]
    path.write_text("\n".join([",".join(COLUMNS), *lines]) + "\n")


if __name__ == "__main__":
    write(Path(sys.argv[1]) if len(sys.argv) > 1 else TABLE)
