"""The law of a soft mixed contact beside a full numerical solution, for random nips. Writes MIXED.md.

The nips are drawn anew from a seed: none of them served to fit the three constants of the law or those of
the least film. What neither law knows is left out: nips whose summits cannot carry the load, and points
that the product marks as beyond its checked range.

Usage: python -m benchmarks.mixed.nips [COUNT] [SEED] (about a minute for each nip)
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.special import gamma, pbdv

from benchmarks.mixed.full_contact import Floats, march
from benchmarks.mixed.table import PRODUCTS, nip_of
from hersey.errors import ParameterError
from hersey.lubrication.asperities import Asperities, BoundaryFriction
from hersey.lubrication.contact import Contact
from hersey.lubrication.lubricant import EXAMPLES
from hersey.lubrication.mixed import MixedContact, mixed_contact

SHARES = [(0.003, 0.03), (0.03, 0.1), (0.1, 0.3), (0.3, 0.5)]
#: Shares at which the full solution is looked at.
LOOKED_AT = np.geomspace(0.003, 0.5, 12)
WARM = "100 degC"
_ERRORS = (
    "lambda",
    "least film",
    "share, relative",
    "share, absolute",
    "lambda, b = 0.2",
    "lambda, b = 0.6",
)


@dataclass(frozen=True)
class Point:
    """The full solution at one product, and what the laws say of it, relative to it."""

    nip: int
    share: float
    thickened: float  #: lambda over lambda alone
    ratio: float
    least: float
    carried: float  #: share less that of the full solution
    powers: tuple[float, float]  #: lambda by (1-s)^-0.2 and (1-s)^-0.6


def drawn(random: np.random.Generator) -> MixedContact:
    """Return a soft contact within the range in which the product calls its law checked."""

    def decades(low: float, high: float) -> float:
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    while True:
        contact = Contact(
            roll_radius=random.uniform(10e-3, 25e-3),
            rubber_thickness=random.uniform(1.5e-3, 6e-3),
            modulus=decades(0.5e6, 2e6),
            poisson_ratio=random.uniform(0.45, 0.499),
            length=0.22,
            load=random.uniform(150, 400),
            roughness=decades(0.2e-6, 4e-6),
        )
        summits = Asperities(decades(0.5e9, 20e9), random.uniform(0.03, 0.07), decades(1e-4, 1e-2))
        try:
            mixed = mixed_contact(
                contact, EXAMPLES["cylinder oil"], summits, BoundaryFriction(0.1), speed=1.0, temperature=WARM
            )
        except ParameterError:
            continue
        if not mixed.beyond_checked_range(np.zeros(()), np.array(1e-12)):
            return mixed


def by_power(mixed: MixedContact, free: Floats, load_exponent: float) -> Floats:
    """Return lambda with a film made under its share of the load, by halving."""

    def share(ratio: Floats) -> Floats:
        whole = gamma(3.5) / np.sqrt(2 * np.pi) * np.exp(-(ratio**2) / 4) * pbdv(-3.5, ratio)[0]
        return np.asarray(mixed.stiffness * whole)

    low, high = np.full_like(free, np.log(1e-3)), np.log(np.maximum(60.0, 2 * free))
    for _ in range(80):
        middle = 0.5 * (low + high)
        ratio = np.exp(middle)
        film = (free / ratio) ** (1 / load_exponent)
        thin = share(ratio) + film > 1
        low, high = np.where(thin, middle, low), np.where(thin, high, middle)
    return np.exp(high)


def points_of(nip: int, mixed: MixedContact) -> Iterator[Point]:
    """Yield the points of a nip at about the shares looked at."""
    layer, summits = nip_of(mixed)
    both = march(layer, summits, PRODUCTS[PRODUCTS < 5e-2])
    shares = np.array([full.share for _, full in both])
    for i in sorted({int(np.argmin(abs(shares - share))) for share in LOOKED_AT}):
        alone, full = both[i]
        speed = full.product / float(mixed.lubricant.viscosity(373.15)) / mixed.lever
        law = mixed.at(speed=speed, temperature=WARM)
        if law.beyond_checked_range or not SHARES[0][0] <= full.share < SHARES[-1][1]:
            continue
        free = np.array([full.product / mixed.reference]) ** mixed.film_exponent
        ratio = full.central / summits.sigma
        powers = [float(by_power(mixed, free, b)[0]) / ratio - 1 for b in (0.2, 0.6)]
        yield Point(
            nip=nip,
            share=full.share,
            thickened=full.central / alone.central,
            ratio=float(law.lambda_ratio) / ratio - 1,
            least=float(law.minimum_ratio) * summits.sigma / full.minimum - 1,
            carried=float(law.share) - full.share,
            powers=(powers[0], powers[1]),
        )


def rows(points: list[Point]) -> Iterator[str]:
    """Yield the rows of the table, by share."""
    for low, high in SHARES:
        within = [point for point in points if low <= point.share < high]
        if not within:
            continue
        columns = np.abs([(p.ratio, p.least, p.carried / p.share, p.carried, *p.powers) for p in within])
        ratio, least, relative, carried, *powers = columns.max(axis=0)
        yield (
            f"| {low:g} to {high:g} | {len(within)} | {max(point.thickened for point in within):.2f} "
            f"| {100 * ratio:.1f} % | {100 * least:.1f} % | {100 * relative:.0f} % | {carried:.3f} "
            f"| {100 * powers[0]:.0f} % | {100 * powers[1]:.0f} % |"
        )


def main(count: int, seed: int) -> None:
    """Measure and write."""
    random = np.random.default_rng(seed)
    points: list[Point] = []
    for nip in range(count):
        mixed = drawn(random)
        found = list(points_of(nip, mixed))
        points += found
        worst = max((abs(point.ratio) for point in found), default=0.0)
        print(f"nip {nip}: S {mixed.stiffness:.3g}, {len(found)} points, {100 * worst:.1f} %", flush=True)
    nips = len({point.nip for point in points})
    inside = np.mean([abs(point.ratio) < 0.03 for point in points])
    lines = "\n".join(rows(points))
    content = f"""# The law of a soft mixed contact beside a full numerical solution

`python -m benchmarks.mixed.nips {count} {seed}`: {nips} random nips with {len(points)} points.
The constants of the law were fitted to none of them. Layers of 1.5 to 6 mm and 0.5 to 2 MPa, Poisson ratio
0.45 to 0.499, radius 10 to 25 mm, 680 to 1800 N/m, roughness 0.2 to 4 um, summits of 0.5 to 20 GPa, in the
range in which the product calls the law checked. Lambda is the central film over the roughness. The full
solution has Reynolds' equation, the elastic layer and Greenwood and Tripp's pressure at every node
(`benchmarks/mixed/full_contact.py`). It knows nothing of the law.

Greatest errors, by the share s of the load that asperities carry. The last two columns are laws with a
constant exponent, lambda = lambda alone (1-s)^-b.

| s | points | lambda over lambda alone, at most | {" | ".join(_ERRORS)} |
|{"---|" * 9}
{lines}

Lambda is within 3 % at {100 * inside:.0f} % of the points. The film alone is that of the product's own law,
and its error is part of these figures. The test stand uses the full solution itself: `python -m
benchmarks.mixed.table` makes its table.
"""
    print(content)
    (Path(__file__).parents[1] / "MIXED.md").write_text(content)


if __name__ == "__main__":
    given = [int(word) for word in sys.argv[1:]]
    main(*(given + [24, 20261124][len(given) :]))
