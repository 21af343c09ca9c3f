"""The slips of a life test, the likeliest first: each is undone before the next is looked for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray, one_thread
from hersey.life.diagnostics import slips
from hersey.life.diagnostics.compared import Compared
from hersey.life.diagnostics.fingerprint import Fingerprints, fingerprints
from hersey.life.diagnostics.measured import MeasuredRuns
from hersey.life.diagnostics.same_logs import same_logs
from hersey.life.diagnostics.slips import Slip

#: Gain in log probability from which a slip of each kind is named, in a usual life test: the mean of that by
#: the trend of all runs as they are and of that by the trend with the slip undone, as a slip hides in the
#: first and shapes the second. Where more runs may be such slips, one reaches it by chance more often.
LEAST = {
    slips.EXCHANGED: 8.5,
    slips.REORDERED: 9.5,
    slips.AGES: 9.0,
    slips.AGE: 9.0,
    slips.TORQUE: 9.0,
    slips.TORQUES: 5.0,
    slips.MACHINE: 7.0,
    slips.LUBRICANT: 6.0,
}
#: Specimens of a usual life test, and runs of each.
_SPECIMENS, _EACH = 8, 6
#: Factor from which on a torque is that of another machine: closer ones are of how a specimen is mounted.
_OTHER_MACHINE = 1.1
#: Gain by the first trend from which a slip is judged by the second.
_WORTH = 2.0
#: Kinds of a run from elsewhere, and how many runs, the farthest off, may be such.
_FOREIGN, _FAR = (slips.MACHINE, slips.LUBRICANT), 2
#: How many times farther, squared, such a run lies than those of the other specimens, or than this in each
#: number: by its own neighbours on both sides, and at the end of a record, where a film may begin to starve.
_INSIDE, _AT_END, _USUAL = 6.0, 12.0, 3.0
#: How many times farther, squared, than those of other specimens the rest of its specimen may lie without it.
_AGREE = 1.5
#: Slips that are looked for, at most, those that are judged for each, and of these of one kind.
_MOST, _JUDGED, _OF_KIND_JUDGED = 10, 5, 2
#: Fewest runs of a life test and of a specimen that are compared.
_RUNS, _OF_SPECIMEN = 8, 3
#: How far apart ages of exchanged logs may be, in the usual last age: half as much if not of one place in
#: the order.
_NEAR = 0.12


@dataclass(frozen=True)
class State:
    """Runs with the slips found so far undone; ``used`` marks those that are compared."""

    specimen: IntArray
    age: FloatArray
    prints: Fingerprints
    used: BoolArray
    near: Compared | None = None  #: almost the same runs, compared

    @cached_property
    def places(self) -> IntArray:
        """Return the places of the runs that are compared, by specimen and age; none if there are too few."""
        count = np.bincount(self.specimen[self.used], minlength=int(self.specimen.max()) + 1)
        enough = self.used & (count[self.specimen] >= _OF_SPECIMEN)
        if np.count_nonzero(enough) < _RUNS:
            return np.empty(0, dtype=np.intp)
        places = np.flatnonzero(enough)
        return places[np.lexsort((self.age[places], self.specimen[places]))]

    @cached_property
    def usual(self) -> float:
        """Usual last age of the specimens."""
        places, last = self.places, np.zeros(int(self.specimen.max()) + 1)
        np.maximum.at(last, self.specimen[places], self.age[places])
        return float(np.median(last[last > 0.0])) if (last > 0.0).any() else 1.0

    @cached_property
    def compared(self) -> Compared:
        """The runs compared."""
        return Compared.of(*self._runs(self.usual), self.near)

    def by(self, other: State, trend: Compared) -> Compared:
        """Return the runs by the trend of another state."""
        return trend.with_runs(*self._runs(other.usual))

    def _runs(self, usual: float) -> tuple[IntArray, FloatArray, Fingerprints]:
        at = self.places
        prints = replace(self.prints, value=self.prints.value[at], variance=self.prints.variance[at])
        return self.specimen[at], self.age[at] / usual, prints

    def with_run(self, place: int, other: State) -> State:
        """Return it with one run as it is in another."""
        age, used = self.age.copy(), self.used.copy()
        value, variance = self.prints.value.copy(), self.prints.variance.copy()
        age[place], used[place] = other.age[place], other.used[place]
        value[place], variance[place] = other.prints.value[place], other.prints.variance[place]
        return replace(self, age=age, used=used, prints=replace(self.prints, value=value, variance=variance))

    def without(self, slip: Slip) -> State:
        """Return it with a slip undone, to be compared from where it is."""
        return replace(self.undone(slip), near=self.compared if self.places.size else None)

    def undone(self, slip: Slip) -> State:
        """Return it with a slip undone."""
        runs = list(slip.runs)
        if slip.kind in (slips.EXCHANGED, slips.REORDERED):
            value, variance = self.prints.value.copy(), self.prints.variance.copy()
            value[runs], variance[runs] = value[runs[::-1]], variance[runs[::-1]]
            return replace(self, prints=replace(self.prints, value=value, variance=variance))
        if slip.kind in (slips.AGES, slips.AGE):
            age = self.age.copy()
            age[runs] /= slip.factor
            return replace(self, age=age)
        if slip.kind in (slips.TORQUE, slips.TORQUES):
            value = self.prints.value.copy()
            value[runs, 0] -= np.log(slip.factor)
            return replace(self, prints=replace(self.prints, value=value))
        used = self.used.copy()
        used[runs] = False
        return replace(self, used=used)


def _exchanged(at: Compared) -> list[Slip]:
    return slips.exchanged(at, _NEAR)


#: What finds the slips of each kind.
_OF_KIND: dict[str, Callable[[Compared], list[Slip]]] = {
    slips.EXCHANGED: _exchanged,
    slips.REORDERED: slips.reordered,
    slips.AGES: slips.ages_scaled,
    slips.AGE: slips.age_scaled,
    slips.TORQUE: slips.alone,
    slips.TORQUES: slips.torques_scaled,
    slips.MACHINE: slips.alone,
    slips.LUBRICANT: slips.alone,
}


def candidates(at: Compared) -> list[Slip]:
    """Return every slip that is looked for, with its gain."""
    return [slip for find in dict.fromkeys(_OF_KIND.values()) for slip in find(at)]


class Found(NamedTuple):
    """The slips, the likeliest first; distance and influence of each run, NaN where it is not compared."""

    slips: list[Slip]
    distance: FloatArray
    influence: FloatArray


@one_thread()
def find_slips(runs: MeasuredRuns) -> Found:
    """Return the slips, and how every run as it is lies to the trend of those without slips."""
    prints = fingerprints(runs)
    state = as_it_is = State(runs.specimen, runs.since, prints, prints.known.copy())
    found = same_logs(runs)[:_MOST]
    for slip in found:
        state = state.undone(slip)
    while len(found) < _MOST and state.places.size:
        likeliest = _likeliest(state)
        if likeliest is None:
            break
        found.append(likeliest)
        state = state.without(likeliest)
    return Found(found, *_as_they_lie(as_it_is, state, found))


def _as_they_lie(as_it_is: State, mended: State, found: list[Slip]) -> tuple[FloatArray, FloatArray]:
    """Distance and influence of each run, one with a slip as it is among others that are mended."""
    distance, influence = np.full((2, as_it_is.age.size), np.nan)
    if not mended.places.size:
        return distance, influence
    trend = mended.compared
    distance[mended.places], influence[mended.places] = trend.distance, trend.influence
    for place in {place for slip in found for place in slip.runs}:
        state = mended.with_run(place, as_it_is)
        at, own = state.by(mended, trend), state.places == place
        if own.any():
            distance[place], influence[place] = at.distance[own][0], at.influence[own][0]
    return distance, influence


def least_gains(runs_of: IntArray) -> dict[str, float]:
    """Return the gain from which a slip is named, by kind: more among more runs, for the same false alarms.

    The chance that any of so many gains exceeds one by chance is at most their number times that of one.
    ``runs_of`` is the number of runs of each specimen.
    """
    specimens, runs = runs_of.size, int(runs_of.sum())
    within = float((runs_of * (runs_of - 1)).sum()) / (_SPECIMENS * _EACH * (_EACH - 1))
    of_specimens, of_runs = specimens / _SPECIMENS, runs / (_SPECIMENS * _EACH)
    between = of_runs * (specimens - 1) / (_SPECIMENS - 1)
    times = {slips.EXCHANGED: between, slips.REORDERED: within} | dict.fromkeys(
        (slips.AGES, slips.TORQUES), of_specimens
    )
    return {kind: gain + np.log(max(times.get(kind, of_runs), 1.0)) for kind, gain in LEAST.items()}


def _likeliest(state: State) -> Slip | None:
    """The likeliest slip; None if there is none."""
    at = state.compared
    least = least_gains(at.rows.given.sum(axis=1))
    every = sorted(candidates(at), key=lambda each: least[each.kind] - each.gain)
    worth = _of_each_kind([each for each in every if each.gain > _WORTH and each.kind not in _FOREIGN])
    judged = [_judged(state, slip) for slip in worth]
    for place in np.argsort(-at.squares, kind="stable")[:_FAR].tolist():
        judged.append(_foreign(state, at, [each for each in every if each.runs == (place,)], least))
    named = [each for each in judged if each.gain >= least[each.kind]]
    return max(named, key=lambda each: each.gain - least[each.kind], default=None)


def _of_each_kind(every: list[Slip]) -> list[Slip]:
    """Return the first slips, no more than some of a kind: what many runs suffer from is one slip of all."""
    chosen: list[Slip] = []
    for each in every:
        if [other.kind for other in chosen].count(each.kind) < _OF_KIND_JUDGED:
            chosen.append(each)
    return chosen[:_JUDGED]


def _judged(state: State, slip: Slip) -> Slip:
    """A slip with its runs as places of the whole life test, and its gain by the trend without it, too."""
    there = replace(slip, runs=tuple(int(state.places[i]) for i in slip.runs))
    undone = state.without(there)
    if not undone.places.size:
        return replace(there, gain=-np.inf)
    at = state.by(undone, undone.compared)
    again = [each for each in _OF_KIND[slip.kind](at) if each.kind == slip.kind and each.runs == slip.runs]
    if not again:
        return replace(there, gain=-np.inf)
    best = max(again, key=lambda each: each.gain)
    return replace(there, factor=best.factor, gain=0.5 * (slip.gain + best.gain))


def _foreign(state: State, before: Compared, of_run: list[Slip], least: dict[str, float]) -> Slip:
    """The likeliest of another machine, lubricant and unit of torque for a run, by the trend without it.

    A run whose shape nothing explains is foreign all the same if it lies many times farther off, squared,
    than every run of the other specimens; but the rest of its own must agree without it: a step that stays
    is none.
    """
    first = {each.kind: each for each in of_run}
    (place,) = of_run[0].runs
    there = int(state.places[place])
    undone = state.without(Slip(slips.LUBRICANT, (there,), 0.0))
    if not undone.places.size:
        return Slip(slips.LUBRICANT, (there,), -np.inf)
    clean = undone.compared
    at = state.by(undone, clean)
    again = {each.kind: each for each in slips.alone(at) if each.runs == (place,)}
    if abs(np.log(again[slips.MACHINE].factor)) < np.log(_OTHER_MACHINE):
        del again[slips.MACHINE]
    best = max(again.values(), key=lambda each: each.gain)
    others = at.squares[at.rows.row != at.rows.row[place]].max(initial=_USUAL * at.terms)
    same = undone.specimen[undone.places] == state.specimen[there]
    if same.any() and clean.squares[same].max() > _AGREE * others:
        return Slip(slips.LUBRICANT, (there,), -np.inf)
    row, column = before.rows.row[place], before.rows.column[place]
    inside = 0 < column < np.count_nonzero(before.rows.given[row]) - 1
    times = float(at.squares[place] / others) / (_INSIDE if inside else _AT_END)
    gain = 0.5 * (best.gain + first[best.kind].gain)
    return replace(
        best,
        runs=(there,),
        gain=max(gain, float(least[best.kind] + 2.0 * np.log(max(times, np.finfo(float).tiny)))),
    )
