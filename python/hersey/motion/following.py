"""Following the sets of a sweep, here or at a worker: numbers by name, and the record of a chunk."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hersey import _core
from hersey.errors import ParameterError
from hersey.motion.drag import Drag
from hersey.motion.parameters import PARAMETERS
from hersey.motion.sets import Later, Sets, within
from hersey.scale.store import Folder, Kind, Note, refuse_unseen
from hersey.schema.warning import Warning

#: Numbers of each cycle, in the order of the core.
NUMBERS = (
    "frequency",
    "slip_duration",
    "stick_duration",
    "speed_min",
    "speed_max",
    "stretch_min",
    "stretch_max",
    "grip_slip_duration",
    "drag_work",
)
#: What a summary has of those that stick and slip: least and greatest.
RANGES = ("frequency", "stuck_fraction", "speed_max", "stretch_max")
#: Failures of which the reason is kept.
REPORTED = 20
#: Time that a task shall take, and that a trial may, s.
_TASK, _TRIAL = 1.5, 0.05
#: Time below which a task is mostly trouble, s.
_SHORT = 0.25
#: Sets of the trial, one number after the other until it takes long enough.
_TRIED = (1, 4, 16, 64, 256, 1024)
#: Most sets of a chunk that nobody asked for, which fit in some hundred megabytes.
_MOST = 500_000
#: Most chunks of a sweep for which nobody asked.
_CHUNKS = 100_000
#: Tasks for each that works, so that all end at about one time.
_TASKS = 16


@dataclass(frozen=True)
class Rules:
    """What holds for every set."""

    drag: Drag
    grip: float | None
    start: str
    duration: float | None
    tolerance: float
    most_steps: int

    def follow(
        self, sets: Sets, threads: int = 1, progress: Callable[[int, int], object] | None = None
    ) -> _core.Sweep:
        """Return what each set settles to."""
        columns = sets.columns()
        return _core.sweep(
            [np.ascontiguousarray(columns[name].ravel()) for name in PARAMETERS],
            (self.drag.closure, self.drag.bristle_stiffness, self.drag.bristle_damping),
            self.drag.beside(sets.count),
            self.grip,
            self.start == "steady",
            self.duration,
            self.tolerance,
            threads,
            progress,
            self.most_steps,
        )

    def described(self) -> dict[str, Any]:
        """Return what decides the bits, beside the sets."""
        drag = self.drag
        near = ("closure", "bristle_stiffness", "bristle_damping", "static_force")
        own = {name: value for name, value in vars(self).items() if name != "drag"}
        return {
            "hersey_version": _core.VERSION,
            **{name: getattr(drag, name) for name in near},
            "rest_force": float(drag.rest_force),
            "rest_damping": float(drag.rest_damping),
            **own,
        }


def values_of(motions: _core.Sweep) -> dict[str, NDArray[Any]]:
    """Return the numbers of each set by name; ``kind`` is the index among the core's kinds."""
    return {
        "kind": motions.kind_index,
        **{name: getattr(motions, name) for name in NUMBERS},
        "stuck_fraction": motions.stick_duration * motions.frequency,
        "laps": motions.laps,
    }


@dataclass
class Tally:
    """How many sets have each outcome, the range of the cycles' numbers, and why the first failed."""

    kinds: dict[str, int] = field(default_factory=dict)
    ranges: dict[str, tuple[float, float]] = field(default_factory=dict)
    failures: list[tuple[int, str]] = field(default_factory=list)

    @property
    def sets(self) -> int:
        """How many sets are counted."""
        return sum(self.kinds.values())

    def add(self, note: Note) -> None:
        """Count the sets of a chunk."""
        for kind, count in note["kinds"].items():
            self.kinds[kind] = self.kinds.get(kind, 0) + count
        for name, (low, high) in note["ranges"].items():
            least, most = self.ranges.get(name, (low, high))
            self.ranges[name] = min(least, low), max(most, high)
        kept = sorted([*self.failures, *((int(index), str(text)) for index, text in note["failures"])])
        self.failures = kept[:REPORTED]

    def to_dict(self) -> dict[str, Any]:
        """Return it as the summary of a sweep; of failures the first, and how many more there are."""
        failed = self.kinds.get("failed", 0)
        more = [f"and {failed - len(self.failures)} more"] if failed > len(self.failures) else []
        return {
            "sets": self.sets,
            "kinds": dict(sorted(self.kinds.items())),
            "stick_slip": {name: list(self.ranges[name]) for name in RANGES if name in self.ranges},
            "failures": [*(f"set {index}: {text}" for index, text in self.failures), *more],
        }


def note_of(motions: _core.Sweep, values: dict[str, NDArray[Any]], first: int) -> Note:
    """Return the record of a chunk whose first set has this index among all."""
    counts = np.bincount(values["kind"], minlength=len(_core.KINDS))
    sticking = values["kind"] == _core.KINDS.index("stick_slip")
    return {
        "kinds": {kind: int(count) for kind, count in zip(_core.KINDS, counts, strict=True) if count},
        "ranges": {
            name: [float(values[name][sticking].min()), float(values[name][sticking].max())]
            for name in RANGES
            if sticking.any()
        },
        "failures": [[first + each.index, str(each.error)] for each in motions.failures[:REPORTED]],
    }


def keep(rules: Rules, folder: Folder, later: Later) -> Note:
    """Follow the sets of a chunk and keep them, unless that was done; return its note."""
    piece = later.piece()
    if (note := folder.note(piece.number)) is not None:
        return note
    try:
        motions = rules.follow(piece.sets)
    except ParameterError as error:
        raise within(piece.numbers, error) from None
    values = values_of(motions)
    note = note_of(motions, values, piece.first)
    columns = piece.sets.columns()
    beside = {name: columns[name].ravel() for name in PARAMETERS}
    folder.write(piece.number, values, beside, note)
    return note


def bring(rules: Rules, later: Later) -> tuple[int, dict[str, NDArray[Any]], list[tuple[int, str]]]:
    """Follow the sets of a chunk; return the index of the first, their numbers, and which failed, why."""
    piece = later.piece()
    try:
        motions = rules.follow(piece.sets)
    except ParameterError as error:
        raise within(piece.numbers, error) from None
    failures = [(piece.first + each.index, str(each.error)) for each in motions.failures]
    return piece.first, values_of(motions), failures


def hash_of(motions: _core.Sweep) -> str:
    """Return the hash of what sets settle to, to the bit."""
    digest = hashlib.sha256()
    for values in values_of(motions).values():
        digest.update(values.tobytes())
    return digest.hexdigest()


def probe(rules: Rules, sample: Sets, seen: tuple[Any, Kind, str] | None) -> str:
    """Return the hash of a sample at a worker, which must see the folder."""
    if seen is not None:
        path, kind, sha256 = seen
        refuse_unseen(path, kind, sha256)
    return hash_of(rules.follow(sample))


def refuse_early(rules: Rules, sets: Sets) -> None:
    """Refuse a value that the core refuses before anything is followed, where sets are crossed.

    Each value is tried with the first of the others, the stick speeds with the transition speed least and
    greatest; what a sweep takes together is looked at chunk by chunk.

    Raises
    ------
    ParameterError
        In the words of the core.
    """
    if sets.zip:
        return
    low, high = ({name: pick(values) for name, values in sets.given.items()} for pick in (np.min, np.max))
    usual = {**low, "transition_speed": high["transition_speed"]}
    tried = [{**usual, name: np.unique(values)} for name, values in sets.given.items()]
    tried.append({**low, "stick_speed": high["stick_speed"]})
    once = Rules(rules.drag, rules.grip, rules.start, rules.duration, rules.tolerance, 1)
    for values in tried:
        given = {name: np.asarray(values[name], dtype=float) for name in PARAMETERS}
        try:
            once.follow(Sets(given, zip=False))
        except ParameterError as error:
            raise ParameterError(str(error).removeprefix(f"set {error.index}: ")) from None


@dataclass(frozen=True)
class Trial:
    """A sample of the sets, the hash of what they settle to here, and the time that one takes, s."""

    sample: Sets
    sha256: str
    each: float


def trial(rules: Rules, sets: Sets) -> Trial:
    """Follow a sample that takes long enough to tell how long all take."""
    for count in _TRIED:
        sample = sets.sample(count)
        begun = time.perf_counter()
        try:
            motions = rules.follow(sample)
        except ParameterError as error:
            raise within(sets.numbers(count), error) from None
        took = time.perf_counter() - begun
        if took > _TRIAL:
            break
    return Trial(sample, hash_of(motions), took / sample.count)


def usual_chunk(sets: int, each: float, workers: int) -> int:
    """Return how many sets a chunk takes where nobody says: a second or two, and all have enough to do."""
    long, short = (min(time / max(each, 1e-9), _MOST) for time in (_TASK, _SHORT))
    enough = max(sets / (_TASKS * workers), min(short, sets / (2 * workers)))
    return int(min(max(min(long, enough), sets / _CHUNKS, 1), sets))


def hashes_differ(hashes: Iterable[tuple[str, str]], own: str) -> list[Warning]:
    """Return the warning of machines whose numbers differ from those of this one."""
    others = sorted(worker for worker, found in hashes if found != own)
    if not others:
        return []
    return [
        Warning(
            "workers with other last bits",
            "worker {worker}"
            + (" and {more} more" if len(others) > 1 else "")
            + (
                " gives slightly different last bits than this machine (another processor or C library). "
                "The results are equally accurate, but not identical"
            ),
            worker=others[0],
            more=len(others) - 1,
        )
    ]
