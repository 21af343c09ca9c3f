"""`Campaign`: many specimens at many ages, in one file."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from hersey.errors import OutputError, ParameterError
from hersey.life.age import Age
from hersey.life.campaign.adding import Added, add_entry, age_unit, is_there
from hersey.life.campaign.checks import CampaignCheck, check
from hersey.life.campaign.content import damaged, refuse_unsound_dwells, refuse_unsound_runs, rows_of
from hersey.life.campaign.entry import COLUMNS, Entry
from hersey.life.campaign.events import add_event, events_of, remove_event
from hersey.life.campaign.guarded import GuardedConnection
from hersey.life.campaign.kept_reads import KeptReads
from hersey.life.campaign.listing import no_run, overview, runs_of
from hersey.life.campaign.store import PATIENCE, open_store, refuse_no_place, sqlite_errors, transaction
from hersey.life.maintenance import Event, kind_of
from hersey.units import takes_si

if TYPE_CHECKING:
    import polars as pl

    from hersey.arrays import FloatArray, IntArray
    from hersey.damping.dwells import SteadyPoints
    from hersey.damping.no_load_torque import NoLoadTorque
    from hersey.damping.surface import DampingSurface
    from hersey.life.diagnostics.diagnosis import Diagnosis
    from hersey.log.sensors import Sensors


class Campaign:
    """Runs of specimens at several ages, with their steady points, fits and origin, in one file.

    Each change is one transaction: it is complete or has no effect. Several programs can write in turn. Logs
    stay where they are. Get one with `create` or `open`; it is a context manager.
    """

    def __init__(self, path: Path, database: GuardedConnection) -> None:
        """Take an open file: see `open` and `create`."""
        self.path, self._database = path, database
        self._home = path.absolute().parent
        self._kept = KeptReads(path, database)

    @classmethod
    def create(cls, path: str | Path, *, wait: float = PATIENCE) -> Campaign:
        """Open a campaign for writing; create it if it does not exist.

        Parameters
        ----------
        path
            File of the campaign; the name of a new one must end in ``.hersey``.
        wait
            Time to wait for other writers, s.

        Raises
        ------
        HerseyError
            If it is not a campaign, has a newer version, or cannot be written.
        """
        return cls(Path(path), open_store(Path(path), create=True, wait=wait))

    @staticmethod
    def refuse_unless_writable(path: str | Path) -> None:
        """Raise the errors of `create` before long work, without creating a file."""
        refuse_no_place(Path(path), create=True)
        if Path(path).exists():
            Campaign.create(path).close()

    @classmethod
    @takes_si(wait="time")
    def open(cls, path: str | Path, *, write: bool = True, wait: float = PATIENCE) -> Campaign:
        """Open an existing campaign, for reading only if ``write`` is false.

        Raises
        ------
        HerseyError
            If it does not exist, or as `create`.
        """
        return cls(Path(path), open_store(Path(path), write=write, wait=wait))

    def close(self) -> None:
        """Close the file."""
        self._database.close()

    def __enter__(self) -> Self:
        """Return itself."""
        return self

    def __exit__(
        self, _kind: type[BaseException] | None, _error: BaseException | None, _trace: TracebackType | None
    ) -> None:
        """Close the file."""
        self.close()

    @property
    def age_unit(self) -> str:
        """The unit of all ages, empty before the first run."""
        with sqlite_errors(self.path):
            return age_unit(self._database)

    def __len__(self) -> int:
        """Return how many runs there are."""
        with sqlite_errors(self.path):
            return int(self._database.execute("SELECT count(*) FROM runs").fetchone()[0])

    def add(
        self,
        points: SteadyPoints,
        *,
        log: str | Path,
        unit: str,
        age: str | Age,
        fit: DampingSurface | None = None,
        settings: dict[str, Any] | None = None,
        force: bool = False,
    ) -> Added:
        """Add the steady points of a log as a run of a specimen at an age, in one transaction.

        Adding the same log at the same specimen and age again changes nothing.

        Parameters
        ----------
        points
            Steady points of one log; all their data are kept.
        log
            File of the log, which stays where it is.
        unit
            The specimen's name.
        age
            Age, e.g. ``"120000 pages"``; 0 if new. Times are converted; any other unit must be one word.
        fit
            Damping surface. Default: fitted here.
        settings
            How the log was read, JSON-serializable.
        force
            Whether to replace a run whose log has changed, or that has another specimen or age.

        Raises
        ------
        ParameterError
            If the log has changed, exists with another specimen or age, or was read with other settings.
        UnitError
            If the age has no unit, or a unit other than that of the campaign.
        OutputError
            If the file cannot be written.
        """
        parsed = Age.parse(age) if isinstance(age, str) else age
        from hersey.life.campaign.conversion import entry_of

        entry = entry_of(points, log, fit=fit, settings=settings)
        return self.add_entries([(entry, unit, parsed)], force=force)[0]

    def add_entries(self, entries: Iterable[tuple[Entry, str, Age]], *, force: bool = False) -> list[Added]:
        """Add several runs with specimen and age in one transaction (all or none); errors as `add`."""
        with transaction(self._database, self.path):
            added = [add_entry(self._database, self._home, *each, force=force) for each in entries]
            self._database.allow_what_the_size_needs()  # which has grown
            refuse_unsound_runs(self._database, self.path)  # what is added can be read again
            for each in added:
                refuse_unsound_dwells(self._database, self.path, [each.run])
            return added

    def add_event(self, unit: str, age: str | Age, event: str, *, run: int | None = None) -> Event:
        """Record maintenance of a specimen, from which on its friction grows anew.

        Parameters
        ----------
        unit
            The specimen's name.
        age
            Its age then, e.g. ``"80000 pages"``. Runs of that age were measured before it, but for ``run``.
        event
            ``re-greased``, ``cleaned`` or ``replaced`` (its parts, so that damage starts from nothing too).
        run
            Number of the run of that age that was measured after it, if there is one.

        Raises
        ------
        ParameterError
            If there is no such specimen or run, or no such event.
        UnitError
            If the age has no unit, or a unit other than that of the campaign.
        """
        parsed, kind = Age.parse(age) if isinstance(age, str) else age, kind_of(event)
        with transaction(self._database, self.path):
            added = add_event(self._database, self.path, unit, parsed, kind, run)
            refuse_unsound_runs(self._database, self.path)
            return added

    def remove_event(self, unit: str, age: str | Age, event: str) -> None:
        """Remove an event; `ParameterError` if there is none."""
        parsed = Age.parse(age) if isinstance(age, str) else age
        with transaction(self._database, self.path):
            remove_event(self._database, unit, parsed, kind_of(event))

    def events(self) -> list[Event]:
        """Return all maintenance, by specimen and age."""
        with sqlite_errors(self.path):
            return events_of(self._database)

    def there(self, sha256: str, unit: str, age: Age, settings: str) -> Added | None:
        """Return the existing run of a log with this hash if adding it would change nothing, else None."""
        with sqlite_errors(self.path):
            return is_there(self._database, sha256, unit, age, settings)

    def runs(self, unit: str = "") -> pl.DataFrame:
        """Return one row per run, of one specimen or all, sorted by specimen and age.

        Columns ``run`` (its number), ``unit``, ``age`` (in `age_unit`), ``log``, ``sha256``, ``dwells``,
        ``exponent`` (c of the damping surface), ``transition_speed`` (rad/s; null where none is seen),
        ``no_fit`` (why there is no fit, or empty), ``version`` (of hersey) and ``added`` (UTC).

        Raises
        ------
        ParameterError
            If there is no such specimen.
        """
        if unit:
            with sqlite_errors(self.path):
                return runs_of(self._database, self.path, unit)
        every: pl.DataFrame = self._kept.read("runs", lambda _: runs_of(self._database, self.path, ""))
        return every.clone()  # whoever asks may change it

    def points(self, run: int) -> SteadyPoints:
        """Return the steady points of a run as they were added; rows of the log are not kept.

        Raises
        ------
        ParameterError
            If there is no such run.
        """
        from hersey.life.campaign.conversion import points_of

        columns = ", ".join(f'"{name}"' for name in COLUMNS)
        reduction = self._of_run("reduction", run)
        with sqlite_errors(self.path):
            refuse_unsound_dwells(self._database, self.path, [run])
            dwells = self._database.execute(
                f"SELECT {columns} FROM dwells WHERE run_id = ? ORDER BY number", (run,)
            ).fetchall()
        with self._naming(run, "reduction"):
            return points_of(reduction, dwells)

    def drives(self, runs: Collection[int] | None = None) -> dict[int, tuple[NoLoadTorque | None, Sensors]]:
        """Return the no-load torque subtracted from each run, and its sensors, by run; of all or of ``runs``.

        Runs with the same no-load torque share one object.
        """
        return dict(self._kept.read("drives", self._drives, runs))

    def _drives(self, runs: Collection[int] | None) -> dict[int, tuple[NoLoadTorque | None, Sensors]]:
        from hersey.life.campaign.conversion import drive_of

        rows = rows_of(self._database, "SELECT id, reduction FROM runs", "id", runs)
        same: dict[str, tuple[NoLoadTorque | None, Sensors]] = {}
        found = {}
        for number, reduction in rows:
            with self._naming(number, "reduction"):
                found[number] = drive_of(reduction, same)
        return found

    @contextmanager
    def _naming(self, run: int, column: str) -> Iterator[None]:
        """Name file, run and column in what is wrong with the JSON that is kept of a run."""
        try:
            yield
        except ParameterError as error:
            raise damaged(self.path, f"'{column}' of run {run}: {error}") from None

    def fit(self, run: int) -> dict[str, Any] | None:
        """Return the fit of a run as `DampingSurface.to_dict` gave it; None if there is no fit.

        Raises
        ------
        ParameterError
            If there is no such run.
        """
        return self._json_of("fit", run)

    def settings(self, run: int) -> dict[str, Any]:
        """Return how the log of a run was read.

        Raises
        ------
        ParameterError
            If there is no such run.
        """
        return self._json_of("settings", run) or {}

    def _json_of(self, column: str, run: int) -> dict[str, Any] | None:
        from hersey.life.campaign.records import read_json

        kept = self._of_run(column, run)
        with self._naming(run, column):
            return None if kept is None else read_json(kept)

    def _of_run(self, column: str, run: int) -> Any:
        with sqlite_errors(self.path):
            row = self._database.execute(f"SELECT {column} FROM runs WHERE id = ?", (run,)).fetchone()
        if row is None:
            raise no_run(self.path, run)
        return row[0]

    def dwells(self) -> pl.DataFrame:
        """Return one row per dwell of every run: ``run_id``, ``unit``, ``age``, ``log`` and values in SI.

        The age is in `age_unit`; its column, and those of the dwells, carry their units. ``rest`` is the
        no-load torque that was subtracted, or 0.
        """
        every: pl.DataFrame = self._kept.read("dwells", self._dwells)
        return every.clone()  # whoever asks may change it

    def _dwells(self, _: None) -> pl.DataFrame:
        from hersey.life.campaign.dwells import dwells_of

        rests = {run: rest for run, (rest, _) in self.drives().items()}
        self._refuse_unsound_dwells()
        return dwells_of(self._database, self.runs(), rests, self.age_unit)

    def measured(self, runs: Collection[int] | None = None) -> tuple[IntArray, FloatArray]:
        """Return the numbers of every dwell, of all runs or of ``runs``, for computations on torque.

        Number of the run, shape (dwells,), those of one run one after the other; speed (rad/s), temperature
        (K), torque and its error (N m), shape (dwells, 4), NaN where nothing was recorded.
        """
        from hersey.life.campaign.dwells import measured_of

        self._refuse_unsound_dwells(runs)
        of_run, table = self._kept.read("measured", partial(measured_of, self._database), runs)
        return of_run.copy(), table.copy()

    def _refuse_unsound_dwells(self, runs: Collection[int] | None = None) -> None:
        self._kept.read("sound", partial(refuse_unsound_dwells, self._database, self.path), runs)

    def export(self, suffix: str) -> bytes:
        """Return `dwells` as the bytes of a ``.parquet`` or ``.csv`` file.

        Raises
        ------
        OutputError
            If it is another format.
        """
        from hersey.files.tables import TABLES, table

        if suffix not in TABLES:
            raise OutputError(f"a campaign cannot be exported as '{suffix}'. Use .parquet or .csv")
        return table(self.dwells(), suffix)

    def check(self, progress: Callable[[int, int], None] | None = None) -> CampaignCheck:
        """Check the file, that each log exists and is unchanged, the ages, the fits, and each run."""
        self._refuse_unsound_dwells()
        with sqlite_errors(self.path):
            found = check(self._database, self._home, progress)
        diagnosis = self.diagnose()
        return replace(found, warnings=(*found.warnings, *diagnosis.warnings), each=diagnosis.each)

    def diagnose(self, of: Collection[int] | None = None) -> Diagnosis:
        """Return which runs do not fit those of their specimen and of the others, and the likeliest slips.

        Parameters
        ----------
        of
            Numbers of runs that are compared with no more runs than it takes. Default: all, with all.
        """
        from hersey.life.campaign.diagnosed import diagnosis_of

        return diagnosis_of(self.runs(), self.age_unit, tuple(self.events()), of, self.drives, self.measured)

    def summary(self) -> str:
        """Return an overview and one line per specimen."""
        events, age_unit = self.events(), self.age_unit
        with sqlite_errors(self.path):
            return overview(self._database, self.path.name, events, age_unit)

    def to_dict(self, unit: str = "") -> dict[str, Any]:
        """Return file, unit of the ages, and the runs of one specimen or all as JSON."""
        runs = self.runs(unit).to_dicts()
        events = [
            {"unit": each.unit, "age": each.age.value, "kind": each.kind, "run": each.run}
            for each in self.events()
            if not unit or each.unit == runs[0]["unit"]
        ]
        return {"file": str(self.path), "age_unit": self.age_unit, "runs": runs, "events": events}

    def to_frame(self) -> pl.DataFrame:
        """Return `runs`."""
        return self.runs()

    def __repr__(self) -> str:
        """Return file and count on one line."""
        return f"<Campaign: {self.path.name}, {len(self)} runs>"
