"""Maintenance of a specimen: what was done at which age, and the stretches of its life between."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, NamedTuple

from hersey.errors import ParameterError
from hersey.life.age import Age
from hersey.result import Means, Record

if TYPE_CHECKING:
    import polars as pl

    from hersey.arrays import FloatArray

#: What may be done to a specimen. From each on friction grows anew; damage does so in new parts alone.
RE_GREASED, CLEANED, REPLACED = "re-greased", "cleaned", "replaced"
KINDS = (RE_GREASED, CLEANED, REPLACED)
#: Other words for them, without hyphens and spaces.
_OTHER_WORDS = {
    "greased": RE_GREASED,
    "lubricated": RE_GREASED,
    "relubricated": RE_GREASED,
    "oilchanged": RE_GREASED,
    "greasechanged": RE_GREASED,
    "partreplaced": REPLACED,
    "partsreplaced": REPLACED,
}


@dataclass(frozen=True)
class Event(Record):
    """What was done to a specimen at an age: ``kind`` is ``re-greased``, ``cleaned`` or ``replaced``.

    It lies after the runs of that age, except ``run``, which was measured after it; None if no run was.
    """

    unit: str
    age: Age
    kind: Annotated[str, Means("re-greased, cleaned or replaced")]
    run: Annotated[int | None, Means("run of this age measured after it; null if none was")] = None

    def summary(self) -> str:
        """Return it in a line."""
        return f"{self.unit}: {self.kind} at {self.age}"

    def to_frame(self) -> pl.DataFrame:
        """Return it as a table of one row."""
        import polars as pl

        age = {f"age ({self.age.unit})": self.age.value}
        return pl.DataFrame({"unit": self.unit, **age, "event": self.kind, "run": self.run})


def kind_of(text: str) -> str:
    """Return the kind of an event that a text names.

    Raises
    ------
    ParameterError
        If it names none.
    """
    word = re.sub(r"[\W_]", "", text).casefold()
    for kind in KINDS:
        if word == kind.replace("-", ""):
            return kind
    if word in _OTHER_WORDS:
        return _OTHER_WORDS[word]
    raise ParameterError(f"event '{text[:40]}' is unknown. Write {', '.join(KINDS[:-1])} or {KINDS[-1]}")


#: What begins friction anew, and what begins damage anew, which only new parts do.
OF_FRICTION, OF_DAMAGE = KINDS, (REPLACED,)


@dataclass(frozen=True)
class Stretch(Record):
    """A stretch of the life of a specimen between maintenance, in which it ages from new."""

    name: Annotated[str, Means("of the stretch; the last has the name of the specimen")]
    unit: Annotated[str, Means("the specimen")]
    begun: Annotated[float, Means("age of the specimen at which it began")]


class Followed(NamedTuple):
    """How far runs follow specimens since they were new, or since maintenance from which on they age anew."""

    last: dict[str, float]  #: age of each specimen when last seen
    begun: dict[str, float]  #: age from which it ages
    greatest: float  #: age of any run since then

    @classmethod
    def from_new(cls, last: dict[str, float]) -> Followed:
        """Return that of specimens without maintenance."""
        return cls(last, dict.fromkeys(last, 0.0), max(last.values()))


class Segments(NamedTuple):
    """Runs by segment: a stretch of life between maintenance, in which a specimen ages from new.

    The last segment of a specimen has its name.
    """

    name: tuple[str, ...]  #: of the segment of each run
    age: FloatArray  #: of each run since its segment began
    begun: dict[str, float]  #: age at which the last segment of each specimen began

    def stretches(self, unit: Sequence[str], age: FloatArray) -> tuple[Stretch, ...]:
        """Return the segments of runs of specimens at ages; none where no maintenance began one."""
        if not (age - self.age).any():
            return ()
        found = {
            name: Stretch(name, of, at - since)
            for name, of, at, since in zip(self.name, unit, age.tolist(), self.age.tolist(), strict=True)
        }
        return tuple(found.values())


def segments(
    run: Sequence[int],
    unit: Sequence[str],
    age: FloatArray,
    events: Sequence[Event],
    kinds: Collection[str],
) -> Segments:
    """Return the segments of runs, which begin with each event of some kinds.

    Parameters
    ----------
    run, unit, age
        Number, specimen and age of each run.
    events
        Maintenance, by specimen and age.
    kinds
        What begins a segment.
    """
    names, since = list(unit), 0.0 * age
    begun = dict.fromkeys(unit, 0.0)
    of_unit: dict[str, list[Event]] = {}
    for event in events:
        if event.kind in kinds and event.unit in begun:
            of_unit.setdefault(event.unit, []).append(event)
            begun[event.unit] = max(begun[event.unit], event.age.value)
    for i in [place for place, of in enumerate(unit) if of in of_unit]:
        of, at, own = unit[i], float(age[i]), of_unit[unit[i]]
        before = [each.age.value for each in own if at > each.age.value or each.run == run[i]]
        since[i] = max(before, default=0.0)
        later = [each.age.value for each in own if each.age.value not in before]
        if later:
            names[i] = f"{of} before {min(later):.10g}"
    return Segments(tuple(names), age - since, begun)
