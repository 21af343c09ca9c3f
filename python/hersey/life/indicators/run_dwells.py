"""The runs of a campaign with their dwells, the torque of the belt alone and that of the whole drive."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray
from hersey.life.age import Age
from hersey.life.indicator import Runs
from hersey.life.indicators.torque_surface import FEWEST, RunDwells
from hersey.schema.warning import Warning

if TYPE_CHECKING:
    from hersey.damping.no_load_torque import NoLoadTorque
    from hersey.life.campaign import Campaign
    from hersey.log.sensors import Sensors

#: Runs that a warning names.
_NAMED = 10


@dataclass(frozen=True, repr=False)
class CampaignRuns:
    """The runs of a campaign by specimen and age; ``dwells``, ``rests`` and ``sensors`` are those of each.

    ``dwells`` are those that turn and are known; a rest is None where none is known. ``warnings``
    name what is not used.
    """

    runs: Runs
    dwells: tuple[RunDwells, ...]
    rests: tuple[NoLoadTorque | None, ...]
    sensors: tuple[Sensors, ...]
    warnings: tuple[Warning, ...]

    @cached_property
    def enough(self) -> BoolArray:
        """Which runs have dwells enough for a torque between them."""
        return np.array([dwells.speed.size >= FEWEST for dwells in self.dwells])

    def name(self, place: int) -> str:
        """Return specimen and age of a run."""
        return f"{self.runs.unit[place]} at {Age(float(self.runs.age[place]), self.runs.age_unit)}"

    def usable(self) -> Iterator[tuple[int, RunDwells, NoLoadTorque | None]]:
        """Place, dwells and rest of each run that has enough of them."""
        for place in np.flatnonzero(self.enough).tolist():
            yield place, self.dwells[place], self.rests[place]

    def shared(self, of: str, *, least: bool) -> float | None:
        """Return the least (or greatest) speed or temperature that every specimen recorded; None without any.

        Specimens are asked, not runs: an old one that stalls where it was measured when new keeps that
        corner.
        """
        ends: dict[str, float] = {}
        toward = min if least else max
        for unit, dwells in zip(self.runs.unit, self.dwells, strict=True):
            values = getattr(dwells, of)
            values = values[np.isfinite(values)]
            if values.size:
                end = float(toward(values))
                ends[unit] = toward(ends.get(unit, end), end)
        if not ends:
            return None
        return max(ends.values()) if least else min(ends.values())


def read_runs_of(campaign: Campaign, rest: NoLoadTorque | None = None) -> CampaignRuns:
    """Return the runs of a campaign; ``rest`` is subtracted where none was subtracted before."""
    runs, drives = Runs.of(campaign), campaign.drives()
    numbers = runs.run
    of_run, table = campaign.measured()
    no_load = _rest_of(of_run, table, {number: drives[number][0] or rest for number in numbers})
    rows = _stretches(of_run)
    each, unused = [], []
    for number in numbers:
        own = rows.get(number, slice(0))
        usable = np.isfinite(table[own][:, [0, 2]]).all(axis=1) & (table[own, 0] != 0.0)
        if not usable.all():
            unused.append((int(np.count_nonzero(~usable)), number))
        own_no_load = no_load[own][usable]
        each.append(_dwells(table[own][usable], own_no_load, was_off=drives[number][0] is not None))
    rests = [drives[number][0] or rest for number in numbers]
    few = [number for number, of in zip(numbers, each, strict=True) if of.speed.size < FEWEST]
    sensors = tuple(drives[number][1] for number in numbers)
    return CampaignRuns(runs, tuple(each), tuple(rests), sensors, _not_used(unused, few))


def _not_used(unused: list[tuple[int, int]], few: list[int]) -> tuple[Warning, ...]:
    """What of the runs is not used: so many dwells of each run, and runs of few dwells."""
    warnings = []
    if unused:
        which = ", ".join(f"{count} of run {number}" for count, number in unused)
        total = sum(count for count, _ in unused)
        warnings.append(
            Warning(
                "standing dwells excluded",
                "dwells at standstill are excluded: {which}",
                which=which,
                count=total,
            )
        )
    if few:
        named = ", ".join(map(str, few[:_NAMED])) + (" and more" if len(few) > _NAMED else "")
        warnings.append(
            Warning(
                "runs of few dwells",
                "{count} {count:run has|runs have} fewer than {fewest} dwells and {count:is|are} not "
                "used here: {which}",
                severity="watch",
                count=len(few),
                fewest=FEWEST,
                which=named,
            )
        )
    return tuple(warnings)


def _stretches(of_run: IntArray) -> dict[int, slice]:
    """The rows of each run by its number."""
    starts = np.flatnonzero(np.diff(of_run, prepend=-1)).tolist()
    ends = [*starts, of_run.size][1:]
    return {int(of_run[start]): slice(start, end) for start, end in zip(starts, ends, strict=True)}


def _rest_of(of_run: IntArray, table: FloatArray, rests: dict[int, NoLoadTorque | None]) -> FloatArray:
    """Torque of the no-load torque at each dwell, N m; where no temperature is, that of its reference."""
    no_load = np.zeros(of_run.size)
    runs_with: dict[int, list[int]] = {}
    for number, rest in rests.items():
        runs_with.setdefault(id(rest), []).append(number)
    thermal = np.isfinite(table[:, 1])
    for numbers in runs_with.values():
        if (rest := rests[numbers[0]]) is None:
            continue
        of_rest = np.isin(of_run, numbers)
        for some, kelvin in ((of_rest & thermal, table[:, 1]), (of_rest & ~thermal, None)):
            no_load[some] = rest.torque(table[some, 0], temperature=None if kelvin is None else kelvin[some])
    return no_load


def _dwells(rows: FloatArray, rest: FloatArray, *, was_off: bool) -> RunDwells:
    """Dwells in the sense of rotation, and the torque of the ``rest`` that is, or was, subtracted."""
    speed, temperature, torque, error = rows.T
    belt, drive = (torque, torque + rest) if was_off else (torque - rest, torque)
    sense = np.sign(speed)
    temperatures = temperature if np.isfinite(temperature).all() else np.full(speed.shape, np.nan)
    return RunDwells(np.abs(speed), temperatures, sense * belt, sense * drive, np.nan_to_num(error))
