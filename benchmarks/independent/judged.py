"""One log through hersey, by its public names."""

from __future__ import annotations

import tempfile
import warnings
import zlib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import hersey
from benchmarks.independent.logs import Log

#: Beside a log whose film is declared to be heated by up to so much.
SENSORS = '[temperature]\nfilm_heating = "{heating:g} K"\n'


@dataclass(frozen=True)
class Judged:
    """What hersey says of a log; ``refusal`` is its message where it says nothing else."""

    surface: hersey.DampingSurface | None = None
    points: hersey.SteadyPoints | None = None
    named: frozenset[str] = frozenset()  #: one regime; several where they are said to agree
    explanations: frozenset[str] = frozenset()
    refusal: str = ""


def generator(seed: int, name: str, index: int) -> np.random.Generator:
    """Return the random numbers of one log of one setting."""
    return np.random.default_rng([seed, zlib.crc32(name.encode()), index])


def judged(log: Log, *, tare: bool = False, heating: float = 0.0, verdict: bool = True) -> Judged:
    """Return what hersey says of a log written to a file; ``heating`` (K) is declared of the film.

    Without a ``verdict`` no regime is asked for, which takes as long as the rest.
    """
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        path = log.write(Path(folder) / "log.csv")
        try:
            points = _read(path, heating).steady(tare="standing" if tare else "none")
            surface = hersey.fit(points)
            regime = hersey.regime(points, surface) if verdict else None
        except hersey.HerseyError as error:
            return Judged(refusal=str(error).removeprefix(str(path)))
    if regime is None:
        return Judged(surface, points)
    return Judged(surface, points, _named(regime), _explanations(regime))


def _read(path: Path, heating: float) -> hersey.TorqueLog:
    """Read a log, with what is declared of its sensors where this version can be told so."""
    if not heating:
        return hersey.read(path)
    path.with_name("hersey.toml").write_text(SENSORS.format(heating=heating), encoding="utf-8")
    return hersey.read_with_mapping(path).log


def _named(regime: hersey.Regime) -> frozenset[str]:
    """The regime named; before there was one, those it was said to agree with."""
    if hasattr(regime, "named"):
        return frozenset({regime.named} if regime.named else ())
    return frozenset(_consistent(regime))


def _explanations(regime: hersey.Regime) -> frozenset[str]:
    if hasattr(regime, "explanations"):
        return frozenset(e.key for e in regime.explanations)
    return frozenset(_consistent(regime))


def _consistent(regime: hersey.Regime) -> Iterable[str]:
    return (h.name for h in regime.hypotheses if h.consistent)
