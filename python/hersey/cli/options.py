"""Options that several commands share, and the reading of a log by them."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence, Set
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from hersey.cli.groups import argument, option
from hersey.cli.progress import bar, working
from hersey.cli.quantities import amounts_in
from hersey.cli.recipe_file import ROLES, read_recipe
from hersey.cli.terminal import say
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.damping.dwells import SteadyPoints
    from hersey.damping.recipe import Recipe
    from hersey.damping.surface import DampingSurface
    from hersey.log import TorqueLog
    from hersey.log.means import MeansTable
    from hersey.machine.machine import Machine
    from hersey.posterior.result import Posterior

_LOGS = "Log file, several of one machine, or a pattern as 'logs/*.csv'."
Logs = Annotated[list[Path], argument("LOG", f"{_LOGS} Can be left out if --recipe names them.")]
SomeLogs = Annotated[list[Path] | None, argument("[LOG]...", _LOGS)]
_FIT = "Instead of a log: what hersey fit --json printed."
FitFile = Annotated[Path | None, option(_FIT, "--fit", metavar="JSON")]
_TRACE = "Recording of starts from rest or stick-slip of this machine; repeat for more files."
Traces = Annotated[list[Path] | None, option(_TRACE, metavar="FILE")]
_SENSORS = "Machine's file: no-load torque, sensors."
SensorsFile = Annotated[Path | None, option(_SENSORS, "--machine", metavar="TOML")]
Figures = Annotated[Path | None, option("Also write each chart as SVG, PNG and PDF.", metavar="DIR")]
Start = Annotated[str, option("rest, or steady (sliding with the drive).")]
_BRISTLES = "Of lugre: force per deflection of the bristles, as '1000 N/mm'."
BristleStiffness = Annotated[str | None, option(_BRISTLES)]
BristleDamping = Annotated[str | None, option("Of lugre: force per rate of deflection, as '10 N*s/m'.")]
AsJson = Annotated[bool, option("Print the whole result as JSON.", "--json")]
TimeUnit = Annotated[str, option("Unit of time, as 's' or 'ms'.")]
MaxMemory = Annotated[str, option("Memory that a file of any format but text may take while it is read.")]
Force = Annotated[bool, option("Replace files that exist.", "--force")]
_KEEP_GOING = "Leave out logs that fail, say why at the end, with exit code 1."
KeepGoing = Annotated[bool, option(_KEEP_GOING, "--keep-going")]


_SAVE_RECIPE = "Write how the logs were read and reduced as a recipe, for --recipe."
SaveRecipe = Annotated[Path | None, option(_SAVE_RECIPE, "--save-recipe", metavar="TOML")]


def drawn(what: str) -> Any:
    """Return the option ``--figure`` of a command that draws something."""
    return option(f"Draw {what}: .html, .png, .svg or .pdf.", "--figure")


_RADIUS = "Radius of a friction force and a sliding speed: '25 mm', or the name of its column."
_LOAD = "Normal load: '50 N', one for each run as '10 N, 20 N', or the name of its column."
_MAPPING = "Roles, units and corrections of the channels.  [default: hersey.toml beside the log]"
_DROP_MISSING = "Leave out rows in which a number is missing or impossible, also where they are many."
_MEANS = "The file is a table of means: one row per dwell, no clock."
_NO_LOAD = "Log of the drive without the film, read alike: what it takes is taken off the torque."


_RECIPE = "Take logs and settings from a recipe; logs and options that are typed replace its own."


@dataclass(frozen=True)
class Reading:
    """The options that say how a log is read and reduced to dwells."""

    torque: Annotated[str, option("Name of the torque column, as 'Tq' or 'Tq (ozf.in)'.")] = ""
    torque_unit: Annotated[str, option("Unit of torque, may carry a factor: '9.84 mN*m / 100' for %.")] = ""
    torque_sign: Annotated[int, option("-1 turns the sign of the torque.")] = 1
    speed: Annotated[str, option("Name of the speed column.")] = ""
    speed_unit: Annotated[str, option("Unit of speed, as 'rpm'.")] = ""
    speed_sign: Annotated[int, option("-1 turns the sign of the speed.")] = 1
    temperature: Annotated[str, option("Name of the temperature column.")] = ""
    temperature_unit: Annotated[str, option("Unit of temperature, as 'degC'.")] = ""
    time: Annotated[str, option("Name of the time column.")] = ""
    time_unit: TimeUnit = ""
    every: Annotated[str, option("Time between rows where the file has no clock, as '2 ms'.")] = ""
    radius: Annotated[str, option(_RADIUS)] = ""
    radius_unit: Annotated[str, option("Unit of a column of the radius, as 'mm'.")] = ""
    load: Annotated[str, option(_LOAD)] = ""
    load_unit: Annotated[str, option("Unit of a column of the load, as 'N'.")] = ""
    run: Annotated[str, option("Name of the column that numbers the runs in a file.")] = ""
    mapping: Annotated[str, option(_MAPPING, metavar="TOML")] = ""
    isothermal: Annotated[bool, option("Leave temperature out: fit B = a w^c.", "--isothermal")] = False
    drop_missing: Annotated[bool, option(_DROP_MISSING, "--drop-missing")] = False
    means: Annotated[bool, option(_MEANS, "--means")] = False
    max_memory: MaxMemory = "2 GB"
    min_dwell: Annotated[str, option("Shortest dwell, with its unit.")] = "2 s"
    tare: Annotated[str, option("none, or standing: subtract the torque read while standing.")] = "none"
    rotation: Annotated[str, option("both, forward or reverse: dwells to use.")] = "both"
    temperature_scale: Annotated[str, option("degC or K: scale of T in B = a T^b w^c.")] = "degC"
    no_load: Annotated[str, option(_NO_LOAD, metavar="LOG")] = ""
    recipe_file: Annotated[str, option(_RECIPE, "--recipe", metavar="TOML")] = ""

    def completed(self, typed: Set[str]) -> tuple[Reading, list[Path]]:
        """Return the same with what the recipe file states beside the options ``typed``, and its logs.

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
        """Return the same, its files whole: workers may have been started in another folder."""
        given = {name: getattr(self, name) for name in ("mapping", "no_load")}
        whole: dict[str, Any] = {name: str(Path(path).absolute()) for name, path in given.items() if path}
        return replace(self, **whole)

    def recipe(self, logs: Sequence[Path] = ()) -> Recipe:
        """Return how these logs become dwells."""
        from hersey.damping.recipe import Recipe
        from hersey.units import parse

        amounts = {role: amounts_in(getattr(self, role)) for role in ("load", "radius")}
        names = {role: name for role in ROLES if (name := getattr(self, role)) and not amounts.get(role)}
        units = {role: unit for role in ROLES if (unit := getattr(self, f"{role}_unit", ""))}
        signs = {role: sign for role in ("torque", "speed") if (sign := getattr(self, f"{role}_sign")) != 1}
        given = {name: getattr(self, name) or None for name in ("mapping", "every", "no_load")}
        same: dict[str, Any] = {name: getattr(self, name) for name in _AS_GIVEN}
        dwell = parse("time", self.min_dwell)
        own: dict[str, Any] = {"channels": names, "units": units, "signs": signs, "min_dwell": dwell}
        return Recipe(logs=tuple(logs), **(own | amounts | given | same))

    def inputs(self, *given: Path | list[Path] | None) -> list[Path]:
        """Return the files that a command reads: those given and those of options; none may be an output."""
        named = [Path(path) for path in (self.recipe_file, self.mapping, self.no_load) if path]
        for paths in given:
            named += [paths] if isinstance(paths, Path) else paths or []
        return named

    def log(self, paths: list[Path], machine: Machine | None = None) -> TorqueLog | MeansTable:
        """Read the files as one log, or as tables of means, with a progress bar; say what was left out."""
        from hersey.log import memory_limit

        recipe = self.recipe(paths)
        with bar("reading") as progress, memory_limit(self.max_memory):
            log: TorqueLog | MeansTable = recipe.log(machine, progress=progress)
        for file in log.files:
            if file.missing_rows:
                _warn(*(str(each.within(file.name)) for each in file.warnings))
        stated = set() if machine is None else set(machine.sensors.stated)
        for role in sorted(stated and stated & set(recipe.chosen.sensors.stated)):
            _warn(f"errors of the sensor of {role}: those of the mapping are used, {_NOT_OF_FILE}")
        return log

    def trace(self, path: Path, machine: Machine | None = None) -> TorqueLog:
        """Read a recording of the machine itself: starts from rest, or stick-slip."""
        from hersey.log.torque_log import TorqueLog

        if machine is None:
            raise ParameterError("--trace needs --machine: what a start shows depends on stiffness and mass")
        read = self.log([path], machine)
        if not isinstance(read, TorqueLog):
            raise ParameterError(f"{path} is a table of means: a trace needs time, torque and speed")
        return read

    def points(
        self, paths: list[Path], log: TorqueLog | MeansTable, machine: Machine | None = None
    ) -> SteadyPoints:
        """Reduce the log of these files to dwells; say what a log of the drive without the film shows."""
        points = self.recipe(paths).dwells(log, machine)
        if self.no_load and points.rest is not None:
            _warn(points.rest.headline(), *(f"- {warning}" for warning in points.rest.warnings))
        return points

    def points_of(self, paths: list[Path], machine: Machine | None = None) -> SteadyPoints:
        """Read one of several logs and reduce it; what is wrong with it begins with its name."""
        from hersey.damping.recipe import naming_logs

        with naming_logs(paths):
            return self.points(paths, self.log(paths, machine), machine)

    def surface_and_posterior(
        self,
        paths: list[Path] | None,
        fit_file: Path | None,
        machine: Machine,
        traces: list[Path] | None = None,
        *,
        seed: int = 1,
    ) -> tuple[DampingSurface, Posterior | None]:
        """Read a finished fit, or fit a log and draw the drives that it allows; no draws without a log."""
        if fit_file is not None or not paths:
            return self.surface(paths, fit_file, machine), None
        from hersey.damping.fit import fit
        from hersey.posterior.sampling import posterior

        recorded = [self.trace(path, machine) for path in traces or []]
        points = self.points(paths, self.log(paths, machine), machine)
        surface = fit(points, temperature_scale=self.temperature_scale)
        threads = os.cpu_count() or 1
        with working("drawing the drives that the log allows"):
            return surface, posterior(
                points, machine, surface=surface, traces=recorded, seed=seed, threads=threads
            )

    def surface(
        self, paths: list[Path] | None, fit_file: Path | None, machine: Machine | None = None
    ) -> DampingSurface:
        """Read a finished fit, or fit the log of a machine."""
        from hersey.damping.fit import fit

        if fit_file is not None and self != Reading():
            raise ParameterError(
                "--fit holds a finished fit: leave out the options that say how to read a log"
            )
        if (fit_file is None) == (not paths):
            raise ParameterError("give either a LOG or --fit with what 'hersey fit LOG --json' printed")
        if fit_file is not None:
            return finished_fit(fit_file, machine)
        logs = paths or []
        log = self.log(logs, machine)
        with working("fitting the surface"):
            return fit(self.points(logs, log, machine), temperature_scale=self.temperature_scale)


_AS_GIVEN = ("isothermal", "drop_missing", "means", "tare", "rotation", "temperature_scale")
_NOT_OF_FILE = "not those of the machine's file"


def finished_fit(file: Path, machine: Machine | None = None) -> DampingSurface:
    """Read a fit that ``hersey fit --json`` printed; say what of the machine's file it outranks."""
    from hersey.document.saved_fit import read_fit

    if machine is not None and machine.sensors.stated:
        _warn(f"errors of the sensors: those of the fit are used, {_NOT_OF_FILE}")
    surface = read_fit(file)
    if machine is None or machine.rest is None:
        return surface
    if surface.rest is None:
        raise ParameterError(
            f"{file.name} is fitted to the whole torque, and {machine.rest.source} says what the drive takes "
            "besides the film: write the fit anew with hersey fit LOG --machine, or leave [rest] out"
        )
    _warn("no-load torque: that of the fit is used, not that of the machine's file")
    return surface


def _warn(*lines: str) -> None:
    say(*lines, file=sys.stderr)
