"""Options that several commands share, and the reading of a log by them."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence, Set
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from hersey.cli.groups import argument, option
from hersey.cli.loading import loading
from hersey.cli.no_load import refuse_no_load_log
from hersey.cli.progress import bar, working
from hersey.cli.quantities import amount_of, amounts_in, inertia_in, ratio_of
from hersey.cli.recipe_file import ROLES, read_recipe
from hersey.cli.several import for_this_log_only
from hersey.cli.terminal import note
from hersey.cli.traces import lacking_columns, of_a_force
from hersey.errors import ChannelError, HerseyError, ParameterError

if TYPE_CHECKING:
    from hersey.damping.dwells import SteadyPoints
    from hersey.damping.moving.result import MovingFit
    from hersey.damping.recipe import Recipe
    from hersey.damping.surface import DampingSurface
    from hersey.log import TorqueLog
    from hersey.log.means import MeansTable
    from hersey.machine.machine import Machine
    from hersey.posterior.result import Posterior

#: Headings in the help of the options that say how a log is read, and how it becomes dwells.
READ, REDUCED = "How to read the log", "Dwells and corrections"

_LOGS = "Log file, several logs of one machine, or a pattern, e.g. 'logs/*.csv'"
Logs = Annotated[list[Path], argument("LOG", f"{_LOGS}; or use --recipe.")]
SomeLogs = Annotated[list[Path] | None, argument("LOG", f"{_LOGS}.")]
_FIT = "Use a fit that 'hersey fit --json' printed, instead of a log."
FitFile = Annotated[Path | None, option(_FIT, "--fit", metavar="JSON")]
_TRACE = "Use a recording of a start from rest or of stick-slip; repeat for more files."
Traces = Annotated[list[Path] | None, option(_TRACE, metavar="FILE")]
_SENSORS = "Machine file, for its no-load torque and sensor errors."
SensorsFile = Annotated[Path | None, option(_SENSORS, "--machine", metavar="TOML")]
Figures = Annotated[Path | None, option("Write each chart as SVG, PNG and PDF into a folder.", metavar="DIR")]
Start = Annotated[str, option("Start from rest, or steady (sliding with the drive).")]
BRISTLES = "Force per deflection of the bristles (lugre), e.g. '1000 N/mm'."
BristleStiffness = Annotated[str | None, option(BRISTLES)]
BRISTLE_DAMPING = "Force per rate of deflection (lugre), e.g. '10 N*s/m'."
BristleDamping = Annotated[str | None, option(BRISTLE_DAMPING)]
_TIME_UNIT, _MEMORY = (
    "Unit of time, e.g. 's' or 'ms'.",
    "Limit the memory for reading a file that is not text.",
)
TimeUnit = Annotated[str, option(_TIME_UNIT)]
MaxMemory = Annotated[str, option(_MEMORY)]
Force = Annotated[bool, option("Replace files that exist.", "--force")]
_KEEP_GOING = "Skip logs that fail, list them at the end, and exit with code 1."
KeepGoing = Annotated[bool, option(_KEEP_GOING, "--keep-going")]
_SAVE_RECIPE = "Write how the logs were read and reduced, for --recipe."
SaveRecipe = Annotated[Path | None, option(_SAVE_RECIPE, "--save-recipe", metavar="TOML")]


def drawn(what: str) -> Any:
    """Return the option ``--figure`` of a command that draws something."""
    return option(f"Draw {what} (.html, .png, .svg or .pdf).", "--figure")


def read(words: str, *flags: str, **more: Any) -> Any:
    """Return an option that says how a log is read."""
    return option(words, *flags, panel=READ, **more)


def reduced(words: str, *flags: str, **more: Any) -> Any:
    """Return an option that says how a log becomes dwells."""
    return option(words, *flags, panel=REDUCED, **more)


_TORQUE_UNIT = "Unit of torque; of a signal e.g. '35 mN*m/A', or '9.84 mN*m / 100' for %."
_CURRENT = "Column of the motor current, instead of a torque; needs --torque-constant."
_TORQUE_CONSTANT = "Torque of the motor per ampere, e.g. '0.11 N*m/A'."
_GEAR_RATIO = "Turns of the motor, or torque sensor, per turn of the output shaft, e.g. 50."
_SPEED_GEAR_RATIO = "Turns of the speed sensor's shaft per turn of the output shaft, e.g. 50."
_RADIUS = "Radius of a friction force or track: '25 mm', one for each run, or its column."
_LOAD = "Normal load: '50 N', '10 N, 20 N' for two runs, or its column."
_POSITION = "Column of a position, instead of a speed; speed is its slope."
_POSITION_UNIT = "Unit of the position, e.g. 'deg', 'mm', or 'rev/4096' for counts."
_POSITION_WINDOW = "Time over which the slope of a position is taken.  [default: 0.2 s, less in fast motion]"
_DIRECTION = "Column of the direction of a speed without a sign: 1 and -1, 1 and 0, CW and CCW."
_NAME_PATTERN = "Pattern of file names that state values, e.g. '{speed} rpm {load} N.txt'."
_NAME_DECIMAL = "Decimal mark of the numbers in the file names, e.g. '-' for 0-1rps.txt."
_RUN_TABLE = "Table with a row for each file: its name, and e.g. load or radius, with units."
_SCHEDULE = "Table of set points by time or distance: columns from, to, e.g. speed, with units."
_MAPPING = "File with roles, units and corrections.  [default: hersey.toml beside the log]"
_DROP_MISSING = "Drop rows with a missing or impossible number, however many."
_MEANS = "Read a table of means: one row per dwell, no time column."
_NO_LOAD = "Log of the drive without the lubricated contact; its torque is subtracted."
_MOVING = "Fit every sample of a log whose speed changes all the time."
_INERTIA = "Moment of inertia at the output shaft, e.g. '2e-4 kg*m^2 ± 5 %'; used where speed changes."
_NO_CACHE = "Read and compute everything again, without the cache."
_RECIPE = "Use the logs and settings of a recipe; options typed here override it."


@dataclass(frozen=True)
class Reading:
    """The options that say how a log is read and reduced to dwells."""

    torque: Annotated[str, read("Torque column, e.g. 'Tq' or 'Tq (ozf.in)'.")] = ""
    torque_unit: Annotated[str, read(_TORQUE_UNIT)] = ""
    torque_sign: Annotated[int, read("Use -1 to flip the sign of torque.")] = 1
    current: Annotated[str, read(_CURRENT)] = ""
    torque_constant: Annotated[str, read(_TORQUE_CONSTANT)] = ""
    gear_ratio: Annotated[str, read(_GEAR_RATIO)] = ""
    inertia: Annotated[str, read(_INERTIA)] = ""
    speed: Annotated[str, read("Speed column.")] = ""
    speed_unit: Annotated[str, read("Unit of speed, e.g. 'rpm'.")] = ""
    speed_sign: Annotated[int, read("Use -1 to flip the sign of speed.")] = 1
    speed_gear_ratio: Annotated[str, read(_SPEED_GEAR_RATIO)] = ""
    temperature: Annotated[str, read("Temperature column.")] = ""
    temperature_unit: Annotated[str, read("Unit of temperature, e.g. 'degC'.")] = ""
    time: Annotated[str, read("Time column.")] = ""
    time_unit: Annotated[str, read(_TIME_UNIT)] = ""
    every: Annotated[str, read("Time between rows of a log without a time column, e.g. '2 ms'.")] = ""
    radius: Annotated[str, read(_RADIUS)] = ""
    radius_unit: Annotated[str, read("Unit of the radius column, e.g. 'mm'.")] = ""
    load: Annotated[str, read(_LOAD)] = ""
    load_unit: Annotated[str, read("Unit of the load column, e.g. 'N'.")] = ""
    position: Annotated[str, read(_POSITION)] = ""
    position_unit: Annotated[str, read(_POSITION_UNIT)] = ""
    position_window: Annotated[str, read(_POSITION_WINDOW)] = ""
    direction: Annotated[str, read(_DIRECTION)] = ""
    name_pattern: Annotated[str, read(_NAME_PATTERN)] = ""
    name_decimal: Annotated[str, read(_NAME_DECIMAL)] = ""
    run_table: Annotated[str, read(_RUN_TABLE, metavar="TABLE")] = ""
    schedule: Annotated[str, read(_SCHEDULE, metavar="TABLE")] = ""
    run: Annotated[str, read("Column that numbers the runs in a file.")] = ""
    mapping: Annotated[str, read(_MAPPING, metavar="TOML")] = ""
    isothermal: Annotated[bool, reduced("Ignore temperature: fit B = a w^c.", "--isothermal")] = False
    drop_missing: Annotated[bool, read(_DROP_MISSING, "--drop-missing")] = False
    means: Annotated[bool, read(_MEANS, "--means")] = False
    max_memory: Annotated[str, read(_MEMORY)] = "2 GB"
    min_dwell: Annotated[str, reduced("Shortest dwell, e.g. '2 s'.")] = "2 s"
    tare: Annotated[str, reduced("Torque zero to subtract: none, or standing (read at rest).")] = "none"
    rotation: Annotated[str, reduced("Use dwells in both, forward or reverse rotation.")] = "both"
    temperature_scale: Annotated[str, reduced("Scale of T in B = a T^b w^c: degC or K.")] = "degC"
    no_load: Annotated[str, reduced(_NO_LOAD, metavar="LOG")] = ""
    moving: Annotated[bool, reduced(_MOVING, "--moving")] = False
    recipe_file: Annotated[str, read(_RECIPE, "--recipe", metavar="TOML")] = ""
    no_cache: Annotated[bool, read(_NO_CACHE, "--no-cache")] = False

    def prepare(self) -> None:
        """Keep what is computed for the next command, and find what the last ones kept."""
        from hersey.cache.switch import use_cache

        use_cache(not self.no_cache)

    def completed(self, typed: Set[str]) -> tuple[Reading, list[Path]]:
        """Return the same with the settings of the recipe file, except options ``typed``, and its logs.

        Raises
        ------
        HerseyError
            If the file is no recipe.
        """
        if not self.recipe_file:
            return self, []
        logs, stated = read_recipe(Path(self.recipe_file))
        return replace(self, **{name: value for name, value in stated.items() if name not in typed}), logs

    def anywhere(self) -> Reading:
        """Return the same with absolute paths: workers may have been started in another folder."""
        given = {name: getattr(self, name) for name in _FILES}
        whole: dict[str, Any] = {name: str(Path(path).absolute()) for name, path in given.items() if path}
        return replace(self, **whole)

    def recipe(self, logs: Sequence[Path] = ()) -> Recipe:
        """Return how these logs become dwells."""
        with loading():
            from hersey.damping.recipe import Recipe

        if self.inertia and not self.moving:
            raise ParameterError("--inertia is for --moving: add it, or omit --inertia")
        amounts = {role: amounts_in(getattr(self, role)) for role in ("load", "radius")}
        names = {role: name for role in ROLES if (name := getattr(self, role)) and not amounts.get(role)}
        units = {role: unit for role in ROLES if (unit := getattr(self, f"{role}_unit", ""))}
        if self.current:
            names["torque"] = self._current()
        signs = {role: sign for role in ("torque", "speed") if (sign := getattr(self, f"{role}_sign")) != 1}
        given = {
            name: getattr(self, name) or None
            for name in ("mapping", "every", "run_table", "schedule", "position_window", "no_load")
        }
        same: dict[str, Any] = {name: getattr(self, name) for name in _AS_GIVEN}
        dwell = amount_of("time", self.min_dwell, "--min-dwell")
        own: dict[str, Any] = {"channels": names, "units": units, "signs": signs, "min_dwell": dwell}
        return Recipe(logs=tuple(logs), **(own | amounts | given | same | self._motor()))

    def _current(self) -> str:
        """The column of the motor current, which plays the part of the torque."""
        if self.torque:
            raise ParameterError("--torque and --current both name the torque: omit one of them")
        if not self.torque_constant:
            raise ParameterError(
                "--current needs the constant of the motor: add e.g. --torque-constant '0.11 N*m/A'"
            )
        return self.current

    def _motor(self) -> dict[str, float]:
        """What is said of the motor and its gears, SI."""
        said = {}
        if self.torque_constant:
            said["torque_constant"] = amount_of("motor constant", self.torque_constant, "--torque-constant")
        if self.inertia:
            said |= inertia_in(self.inertia)
        ratios = ("gear_ratio", "speed_gear_ratio")
        return said | {
            name: ratio_of(f"--{name.replace('_', '-')}", text)
            for name in ratios
            if (text := getattr(self, name))
        }

    def refuse_dwells(self, what: str, *needed: str) -> None:
        """Refuse options that make dwells of a log, but those ``needed``, for ``what`` uses its rows."""
        usual = Reading()
        names = (*_OF_DWELLS, "moving", "inertia")
        typed = [n for n in names if n not in needed and getattr(self, n) != getattr(usual, n)]
        if typed:
            flags = " and ".join(f"--{name.replace('_', '-')}" for name in typed)
            raise ParameterError(f"{what} is made of rows, not of dwells: omit {flags}")

    def inputs(self, *given: Path | list[Path] | None) -> list[Path]:
        """Return the files that a command reads, of which none may be an output."""
        beside = [self.recipe_file, *(getattr(self, name) for name in _FILES)]
        named = [Path(path) for path in beside if path]
        for paths in given:
            named += [paths] if isinstance(paths, Path) else paths or []
        return named

    def log(self, paths: list[Path], machine: Machine | None = None) -> TorqueLog | MeansTable:
        """Read the files as one log, or as tables of means; print dropped rows and doubtful units."""
        from hersey.log import memory_limit
        from hersey.log.doubtful import doubtful_units

        recipe = self.recipe(paths)
        try:
            with bar("reading") as progress, memory_limit(self.max_memory):
                log: TorqueLog | MeansTable = recipe.log(machine, progress=progress)
        except ChannelError as error:
            from hersey.cli.no_torque import as_other_use

            raise as_other_use(error, paths, self) from None
        for file in log.files:
            if file.missing_rows:
                note(*(str(each.within(file.name)) for each in file.warnings))
        note(*(f"hersey: warning: {each.sentence}" for each in doubtful_units(log)))
        stated = set() if machine is None else set(machine.sensors.stated)
        for role in sorted(stated and stated & set(recipe.chosen.sensors.stated)):
            note(f"The sensor errors of {role} come from the mapping, {_NOT_OF_FILE}.")
        return log

    def trace(self, path: Path, machine: Machine | None = None) -> TorqueLog:
        """Read a recording of the machine itself: starts from rest, or stick-slip."""
        from hersey.log.torque_log import TorqueLog

        if machine is None:
            raise ParameterError("--trace needs --machine, because a start depends on stiffness and mass")
        try:
            read = self.log([path], machine)
        except HerseyError as error:
            if self.mapping:
                raise
            of_force = of_a_force(error, path, machine)
            raise (
                lacking_columns(error, path, self.recipe([path])) if of_force is error else of_force
            ) from None
        if not isinstance(read, TorqueLog):
            raise ParameterError(
                f"{path} is a table of means; a trace needs columns of time, torque and speed"
            )
        return read

    def points(
        self,
        paths: list[Path],
        log: TorqueLog | MeansTable,
        machine: Machine | None = None,
        found: SteadyPoints | MovingFit | None = None,
    ) -> SteadyPoints:
        """Reduce the log of these files to dwells; print that it moves, and what the no-load log shows."""
        if machine is not None and machine.rest is not None:
            refuse_no_load_log(paths, machine.rest)
        reduced = self.found(paths, log) if found is None else found
        points = self.recipe(paths).dwells(log, machine, reduced)
        if self.no_load and points.rest is not None:
            note(f"No-load torque subtracted: {points.rest}.")
            note(*(f"- {warning.sentence}" for warning in points.rest.warnings))
        return points

    def found(self, paths: list[Path], log: TorqueLog | MeansTable) -> SteadyPoints | MovingFit:
        """Return the dwells of the log, or the fit to every sample of one that moves; print that it moves."""
        from hersey.damping.dwells import SteadyPoints

        found = self.recipe(paths).found(log)
        if not (self.moving or isinstance(found, SteadyPoints)):
            note("The speed hardly ever holds, so friction is fitted to every sample, as with --moving.")
        return found

    def points_of(
        self, paths: list[Path], machine: Machine | None = None, others: Sequence[Path] = ()
    ) -> SteadyPoints:
        """Read one of several logs and reduce it; options hold for the ``others`` too."""
        with self.one_of_several(paths, others):
            return self.points(paths, self.log(paths, machine), machine)

    @contextmanager
    def one_of_several(self, paths: list[Path], others: Sequence[Path] = ()) -> Iterator[None]:
        """Let errors begin with the name of the log, and end in how a setting is stated for it alone."""
        from hersey.damping.recipe import naming_logs

        try:
            with naming_logs(paths):
                yield
        except HerseyError as error:
            raise for_this_log_only(error, paths[0], self.recipe(paths), others) from None

    def surface_and_posterior(
        self,
        paths: list[Path] | None,
        fit_file: Path | None,
        machine: Machine,
        traces: list[Path] | None = None,
        *,
        machine_file: Path,
        seed: int = 1,
    ) -> tuple[DampingSurface, Posterior | None]:
        """Read a saved fit, or fit a log and draw from its posterior; there are no draws without a log."""
        if fit_file is not None or not paths:
            return self.surface(paths, fit_file, machine, machine_file), None
        from hersey.damping.curves import fit_curves
        from hersey.damping.fit import fit
        from hersey.posterior.sampling import posterior

        recorded = [self.trace(path, machine) for path in traces or []]
        points = self.points(paths, self.log(paths, machine), machine)
        surface = fit(points, temperature_scale=self.temperature_scale)
        curves = fit_curves(points, surface, machine.mixed)
        threads = os.cpu_count() or 1
        with working("drawing from the posterior"):
            return surface, posterior(
                points,
                machine,
                surface=surface,
                curves=curves,
                traces=recorded,
                seed=seed,
                threads=threads,
            )

    def surface(
        self, paths: list[Path] | None, fit_file: Path | None, machine: Machine, machine_file: Path
    ) -> DampingSurface:
        """Read a saved fit, or fit the log of a machine."""
        from hersey.damping.fit import fit

        if fit_file is not None and self != Reading():
            raise ParameterError("--fit names a saved fit: omit the options that say how to read a log")
        if (fit_file is None) == (not paths):
            raise ParameterError(
                "name a LOG, or give --fit with the file that 'hersey fit LOG --json' printed"
            )
        if fit_file is not None:
            return finished_fit(fit_file, machine, machine_file)
        logs = paths or []
        log = self.log(logs, machine)
        with working("fitting the surface"):
            return fit(self.points(logs, log, machine), temperature_scale=self.temperature_scale)


_AS_GIVEN = (
    *("isothermal", "drop_missing", "means", "tare", "rotation", "temperature_scale", "moving"),
    *("name_pattern", "name_decimal"),
)
#: Options that name a file.
_FILES = ("mapping", "run_table", "schedule", "no_load")
#: Options that make dwells of a log.
_OF_DWELLS = ("min_dwell", "tare", "rotation", "temperature_scale", "no_load")
_NOT_OF_FILE = "not from the machine file"


def finished_fit(file: Path, machine: Machine, machine_file: Path) -> DampingSurface:
    """Read a fit that ``hersey fit --json`` printed; print which parts of the machine file it replaces."""
    from hersey.document.saved_fit import read_fit, save_again
    from hersey.motion.whole_torque import refuse_whole_torque

    again = save_again(file, "--machine", str(machine_file))
    if machine.sensors.stated:
        note(f"The sensor errors come from the fit, {_NOT_OF_FILE}.")
    try:
        surface = read_fit(file)
    except ParameterError as error:
        error.remedy = error.remedy and again
        raise
    if machine.rest is None:
        return surface
    if surface.rest is None:
        otherwise = f"delete [rest] from {machine_file}"
        refuse_whole_torque(f"{file.name} was fitted to", machine.rest, again, otherwise)
    note(f"The no-load torque comes from the fit, {_NOT_OF_FILE}.")
    return surface
