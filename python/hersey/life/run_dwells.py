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
from hersey.life.torque_surface import FEWEST, RunDwells

if TYPE_CHECKING:
    from hersey.damping.rest import RestOfDrive
    from hersey.life.campaign import Campaign
    from hersey.log.sensors import Sensors


@dataclass(frozen=True, repr=False)
class CampaignRuns:
    """The runs of a campaign, by unit and age: ``dwells``, ``rests`` and ``sensors`` have one entry for each.

    ``dwells`` are those that turn and are known; a rest is None where none is known. ``notes`` say what is
    not there.
    """

    runs: Runs
    dwells: tuple[RunDwells, ...]
    rests: tuple[RestOfDrive | None, ...]
    sensors: tuple[Sensors, ...]
    notes: tuple[str, ...]

    @cached_property
    def enough(self) -> BoolArray:
        """Which runs have dwells enough for a torque between them."""
        return np.array([dwells.speed.size >= FEWEST for dwells in self.dwells])

    def name(self, place: int) -> str:
        """Return unit and age of a run."""
        return f"{self.runs.unit[place]} at {Age(float(self.runs.age[place]), self.runs.age_unit)}"

    def told(self) -> Iterator[tuple[int, RunDwells, RestOfDrive | None]]:
        """Place, dwells and rest of each run that has enough of them."""
        for place in np.flatnonzero(self.enough).tolist():
            yield place, self.dwells[place], self.rests[place]

    def shared(self, of: str, *, least: bool) -> float | None:
        """Return the least (or greatest) speed or temperature that every unit has recorded; None without any.

        Units are asked, not runs: an old one that stalls where it was measured when new keeps that corner.
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


def read_runs_of(campaign: Campaign, rest: RestOfDrive | None = None) -> CampaignRuns:
    """Return the runs of a campaign; ``rest`` is taken off those of which none was taken off before."""
    listed, dwells, drives = campaign.runs(), campaign.dwells(), campaign.drives()
    numbers = tuple(listed["run"].to_list())
    runs = Runs(numbers, tuple(listed["unit"].to_list()), listed["age"].to_numpy(), campaign.age_unit)
    names = ("speed (rad/s)", "temperature (K)", "torque (N m)", "torque error (N m)")
    table = np.column_stack([dwells[name].cast(float).fill_null(np.nan).to_numpy() for name in names])
    rows = _stretches(dwells["run_id"].to_numpy())
    none = np.empty((0, len(names)))
    each, rests, unused = [], [], []
    for number in numbers:
        taken = drives[number][0]
        of = table[rows[number]] if number in rows else none
        usable = np.isfinite(of[:, [0, 2]]).all(axis=1) & (of[:, 0] != 0.0)
        if not usable.all():
            unused.append(f"{np.count_nonzero(~usable)} of run {number}")
        each.append(_dwells(of[usable], taken, rest))
        rests.append(taken or rest)
    notes = [f"dwells that do not turn are left out: {', '.join(unused)}"] if unused else []
    few = [str(number) for number, of in zip(numbers, each, strict=True) if of.speed.size < FEWEST]
    if few:
        notes.append(
            f"{len(few)} runs have fewer than {FEWEST} dwells, and tell nothing here: {', '.join(few[:10])}"
            + (" and more" if len(few) > 10 else "")
        )
    sensors = tuple(drives[number][1] for number in numbers)
    return CampaignRuns(runs, tuple(each), tuple(rests), sensors, tuple(notes))


def _stretches(of_run: IntArray) -> dict[int, slice]:
    """The rows of each run by its number."""
    starts = np.flatnonzero(np.diff(of_run, prepend=-1)).tolist()
    ends = [*starts, of_run.size][1:]
    return {int(of_run[start]): slice(start, end) for start, end in zip(starts, ends, strict=True)}


def _dwells(rows: FloatArray, taken: RestOfDrive | None, known: RestOfDrive | None) -> RunDwells:
    """Dwells in the sense of rotation; ``taken`` is put back on for the whole, ``known`` taken off."""
    speed, temperature, torque, error = rows.T
    heat = temperature if np.isfinite(temperature).all() else None
    whole = torque if taken is None else torque + taken.torque(speed, heat)
    belt = torque if taken is not None or known is None else torque - known.torque(speed, heat)
    sense = np.sign(speed)
    heats = temperature if heat is not None else np.full(speed.shape, np.nan)
    return RunDwells(np.abs(speed), heats, sense * belt, sense * whole, np.nan_to_num(error))
