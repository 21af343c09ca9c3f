"""A sweep that is kept chunk by chunk in a folder, and goes on where it stopped."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hersey import _core
from hersey.errors import HerseyError, OutputError, ParameterError
from hersey.motion.following import (
    NUMBERS,
    Rules,
    Tally,
    Trial,
    bring,
    hashes_differ,
    keep,
    probe,
    refuse_early,
    trial,
    usual_chunk,
)
from hersey.motion.parameters import KINDS, MOST_SETS
from hersey.motion.sets import Later, Sets
from hersey.motion.work import ALONE, Work
from hersey.scale.cluster import connected, refuse_others, threads_of
from hersey.scale.cutting import Cut
from hersey.scale.kinds import kind_of
from hersey.scale.local import LocalWorkers
from hersey.scale.store import (
    Coordinate,
    Folder,
    Layout,
    SweepFolder,
    Variable,
    opened,
    remove_unfinished_of,
    sha256_of,
)
from hersey.scale.tasks import done
from hersey.schema.warning import Warning
from hersey.units import KINDS as UNITS

if TYPE_CHECKING:
    import xarray as xr
    from distributed import Client

#: Unit and meaning of each number.
_ABOUT = {
    "frequency": ("Hz", "slips per time"),
    "slip_duration": ("s", "time of a cycle in which it slips"),
    "stick_duration": ("s", "time of a cycle in which it sticks"),
    "speed_min": ("m/s", "lowest sliding speed of a cycle"),
    "speed_max": ("m/s", "highest sliding speed of a cycle"),
    "stretch_min": ("m", "smallest stretch of the spring"),
    "stretch_max": ("m", "largest stretch of the spring"),
    "grip_slip_duration": ("s", "time of a cycle in which the drive slips"),
    "drag_work": ("J", "work done by the drag in a cycle"),
    "stuck_fraction": ("1", "fraction of a cycle in which it sticks"),
    "laps": ("1", "cycles simulated"),
}


@dataclass(frozen=True)
class Checkpoint:
    """What a sweep left in its folder: what was counted, in how many chunks, and warnings."""

    path: Path
    tally: Tally
    chunks: int
    #: Chunks that were there before.
    before: int
    warnings: tuple[Warning, ...] = ()

    def summary(self) -> dict[str, Any]:
        """Return what `hersey.motion.scenario.summary` returns of a sweep in memory."""
        return self.tally.to_dict()


class _Pieces(Sequence[Later]):
    """Chunks that are still to do, each made when it is asked for."""

    def __init__(self, sets: Sets, cut: Cut, numbers: Sequence[int]) -> None:
        self._sets, self._cut, self._numbers = sets, cut, numbers

    def __len__(self) -> int:
        return len(self._numbers)

    def __getitem__(self, index: Any) -> Any:
        return Later(self._sets, self._cut, self._numbers[index])


def checkpointed(
    sets: Sets, rules: Rules, out: str | Path | SweepFolder, work: Work = ALONE, *, units: str = "SI"
) -> Checkpoint:
    """Follow every set, keep each chunk in the folder ``out`` as it ends, and count the outcomes.

    ``rules`` have the tolerance and the steps. What is there of the same sweep is not done again. An error
    that ends it says how many chunks are kept; Ctrl-C says so in a note of `KeyboardInterrupt`.

    Raises
    ------
    ParameterError, OutputError, UnfinishedError, MissingFileError
        As `hersey.sweep`.
    """
    target = SweepFolder.of(out)
    path, kind = target.absolute, kind_of(Path(target.path))
    refuse_early(rules, sets)
    scenario = {**rules.described(), "zip": sets.zip, "units": units, "parameters": sets.described()}
    with _connected(work.client) as known:
        workers = work.threads if known is None else max(threads_of(known), 1)
        tried = trial(rules, sets)
        asked = None if work.chunk is None else _cut(sets, work.chunk)

        def planned() -> Cut:
            return asked or Cut.into(sets.shape, usual_chunk(sets.count, tried.each, workers))

        with opened(
            target,
            kind,
            scenario,
            partial(_layout, sets, rules, units),
            shape=sets.shape,
            planned=planned,
            asked=asked,
        ) as folder:
            warnings: list[Warning] = []
            if known is not None:
                warnings = _probed(known, rules, tried, (path, kind, sha256_of(scenario)))
            return _followed(sets, rules, folder, known, work.threads, work.progress, warnings)


def _followed(
    sets: Sets,
    rules: Rules,
    folder: Folder,
    client: Client | LocalWorkers | None,
    threads: int,
    progress: Callable[[int, int], object] | None,
    warnings: list[Warning],
) -> Checkpoint:
    """Do what is not done."""
    tally, lacking, damaged = _counted(folder)
    count = lacking.size
    warnings = [*warnings, *folder.mended, *_done_again(folder.path, damaged)]
    before = count - int(lacking.sum())
    ended, there = before, tally.sets
    pieces = _Pieces(sets, folder.cut, np.flatnonzero(lacking).tolist())
    if progress is not None:
        progress(there, sets.count)
    try:
        for _, note in done(
            partial(keep, rules, folder),
            pieces,
            client=client,
            threads=threads,
            size=lambda later: later.size,
            progress=None if progress is None else lambda now, _: progress(there + now, sets.count),
        ):
            tally.add(note)
            ended += 1
        remove_unfinished_of(folder.path)
    except HerseyError as error:
        again = type(error)(f"{error}; {_left(ended, count)}")
        again.__dict__.update(error.__dict__)
        raise again from None
    except KeyboardInterrupt as interrupt:
        interrupt.add_note(_left(ended, count))
        raise
    return Checkpoint(folder.path, tally, count, before, tuple(warnings))


def _counted(folder: Folder) -> tuple[Tally, NDArray[np.bool_], list[int]]:
    """The outcomes of the chunks that are there, which chunks are lacking, and which are damaged."""
    tally, lacking, damaged = Tally(), np.ones(folder.cut.count, dtype=bool), []
    for number in folder.finished():
        if (note := folder.note(number)) is None:
            damaged.append(number)
            continue
        try:
            tally.add(note)
        except (AttributeError, KeyError, TypeError, ValueError):
            raise OutputError(
                f"{folder.path}: the record of chunk {number} is damaged. Delete its files to compute "
                "it again"
            ) from None
        lacking[number] = False
    return tally, lacking, damaged


def _done_again(path: Path, damaged: list[int]) -> list[Warning]:
    """The warning of chunks that were finished and are damaged."""
    if not damaged:
        return []
    named = ", ".join(str(number) for number in damaged[:10]) + (", ..." if len(damaged) > 10 else "")
    return [
        Warning(
            "chunks computed again",
            "{count} {count:chunk was|chunks were} damaged and computed again: {chunks}",
            where=path.name,
            count=len(damaged),
            chunks=named,
        )
    ]


def _left(ended: int, count: int) -> str:
    return f"{ended} of {count} chunks are finished. Repeat the command to continue"


def gathered(
    sets: Sets, rules: Rules, work: Work
) -> tuple[dict[str, NDArray[Any]], list[str], list[Warning]]:
    """Return the numbers of every set as workers find them, flat, the failures, and warnings."""
    with _connected(work.client) as known:
        assert known is not None
        tried = trial(rules, sets)
        wished = work.chunk
        if wished is None:
            wished = usual_chunk(sets.count, tried.each, max(threads_of(known), 1))
        cut = Cut.into(sets.shape, wished)
        warnings = _probed(known, rules, tried, None)
        columns: dict[str, NDArray[Any]] = {}
        failures: list[tuple[int, str]] = []
        pieces = _Pieces(sets, cut, range(cut.count))
        task = partial(bring, rules)
        for _, (first, values, failed) in done(
            task, pieces, client=known, progress=work.progress, size=lambda later: later.size
        ):
            for name, column in values.items():
                if name not in columns:
                    columns[name] = np.empty(sets.count, column.dtype)
                columns[name][first : first + column.size] = column
            failures.extend(failed)
    return columns, [f"set {index}: {text}" for index, text in sorted(failures)], warnings


@contextmanager
def _connected(client: Client | LocalWorkers | str | None) -> Iterator[Client | LocalWorkers | None]:
    if client is None:
        yield None
        return
    with connected(client) as (known, _name):
        refuse_others(known)
        yield known


def _cut(sets: Sets, chunk: int) -> Cut:
    if not isinstance(chunk, (int, np.integer)) or isinstance(chunk, bool):
        raise ParameterError(f"chunk is {chunk!r}: it must be a whole number of sets")
    cut = Cut.into(sets.shape, int(chunk))
    if chunk > MOST_SETS:
        raise ParameterError(f"chunk is {chunk}: one call takes at most {MOST_SETS:.0e} sets")
    return cut


def _probed(client: Client | LocalWorkers, rules: Rules, tried: Trial, seen: Any) -> list[Warning]:
    """Refuse a worker that does not see the folder; return the warning of those with other bits."""
    if isinstance(client, LocalWorkers):  # this machine, with its folders
        return []
    found = client.run(probe, rules, tried.sample, seen, on_error="return")
    for error in found.values():
        if isinstance(error, BaseException):
            raise error
    return hashes_differ(found.items(), tried.sha256)


def _layout(sets: Sets, rules: Rules, units: str, cut: Cut) -> Layout:
    """What the folder holds, with units and words."""

    def unit(text: str) -> dict[str, str]:
        return (
            {"units": text} if units == "SI" or text == "1" else {}
        )  # "consistent" is none that a reader knows

    whole: dict[str, Any] = {
        "kind": Variable(
            "kind",
            "uint8",
            {
                "long_name": "kind of the final motion",
                "flag_values": list(range(len(_core.KINDS))),
                "flag_meanings": " ".join(_core.KINDS),
            },
            255,
            _core.KINDS,
        ),
        **{
            name: Variable(name, "float64", {"long_name": _ABOUT[name][1], **unit(_ABOUT[name][0])}, np.nan)
            for name in (*NUMBERS, "stuck_fraction")
        },
        "laps": Variable("laps", "uint32", {"long_name": _ABOUT["laps"][1], **unit("1")}, 0),
    }
    coordinates = {}
    for name, values in sets.given.items():
        kind = KINDS[name]
        about = {"long_name": name.replace("_", " "), **unit(UNITS[kind][0] if kind else "1")}
        axes = () if not values.ndim else sets.axes if sets.zip else (name,)
        laid = np.broadcast_to(values, sets.shape) if axes and sets.zip else values
        coordinates[name] = Coordinate(axes, laid, about)
    described = {key: value for key, value in rules.described().items() if value is not None}
    return Layout(
        sets.axes,
        cut,
        tuple(whole.values()),
        coordinates,
        {**described, "created_by": f"hersey {_core.VERSION}, sweep", "units": units, "sets": sets.count},
    )


def opened_dataset(path: Path) -> xr.Dataset:
    """Return a kept sweep as xarray opens it: numbers are read when they are asked for."""
    import xarray as xr

    from hersey.scale.zarr_reading import checked

    found: xr.Dataset = xr.open_zarr(checked(path), chunks=None, decode_times=False)
    return found
