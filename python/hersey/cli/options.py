"""Options that several commands share, and the reading of a log by them."""

from __future__ import annotations

import functools
import inspect
import os
import re
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

import typer

from hersey.cli.progress import bar, working
from hersey.cli.terminal import say
from hersey.files.patterns import files_of

if TYPE_CHECKING:
    from hersey.damping.dwells import SteadyPoints
    from hersey.damping.recipe import Recipe
    from hersey.damping.surface import DampingSurface
    from hersey.log import TorqueLog
    from hersey.log.means import MeansTable
    from hersey.machine.machine import Machine
    from hersey.motion.drag import Drag
    from hersey.motion.heat import HeatBalance
    from hersey.posterior.result import Posterior

Logs = Annotated[
    list[Path],
    typer.Argument(metavar="LOG...", help="Log file, several of one machine, or a pattern as 'logs/*.csv'."),
]
SomeLogs = Annotated[
    list[Path] | None,
    typer.Argument(
        metavar="[LOG]...", help="Log file, several of one machine, or a pattern as 'logs/*.csv'."
    ),
]
FitFile = Annotated[
    Path | None,
    typer.Option("--fit", metavar="JSON", help="Instead of a log: what hersey fit --json printed."),
]
Traces = Annotated[
    list[Path] | None,
    typer.Option(
        "--trace",
        metavar="FILE",
        help="Recording of starts from rest or stick-slip of this machine; repeat for more files.",
    ),
]
MachineFile = Annotated[
    Path | None,
    typer.Option("--machine", metavar="TOML", help="Drivetrain of the machine, for the simulation."),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print the whole result as JSON.")]
MaxMemory = Annotated[
    str, typer.Option(help="Memory that a file of any format but text may take while it is read.")
]
Force = Annotated[bool, typer.Option("--force", help="Replace files that exist.")]
KeepGoing = Annotated[
    bool,
    typer.Option("--keep-going", help="Leave out logs that fail, say why at the end, with exit code 1."),
]


@dataclass(frozen=True)
class Reading:
    """The options that say how a log is read and reduced to dwells."""

    torque: Annotated[str, typer.Option(help="Name of the torque column, as 'Tq' or 'Tq (ozf.in)'.")] = ""
    torque_unit: Annotated[
        str, typer.Option(help="Unit of torque, may carry a factor: '9.84 mN*m / 100' for %.")
    ] = ""
    torque_sign: Annotated[int, typer.Option(help="-1 turns the sign of the torque.")] = 1
    speed: Annotated[str, typer.Option(help="Name of the speed column.")] = ""
    speed_unit: Annotated[str, typer.Option(help="Unit of speed, as 'rpm'.")] = ""
    speed_sign: Annotated[int, typer.Option(help="-1 turns the sign of the speed.")] = 1
    temperature: Annotated[str, typer.Option(help="Name of the temperature column.")] = ""
    temperature_unit: Annotated[str, typer.Option(help="Unit of temperature, as 'degC'.")] = ""
    time: Annotated[str, typer.Option(help="Name of the time column.")] = ""
    time_unit: Annotated[str, typer.Option(help="Unit of time, as 's' or 'ms'.")] = ""
    every: Annotated[str, typer.Option(help="Time between rows where the file has no clock, as '2 ms'.")] = ""
    radius: Annotated[
        str,
        typer.Option(
            help="Radius of a friction force and a sliding speed: '25 mm', or the name of its column."
        ),
    ] = ""
    radius_unit: Annotated[str, typer.Option(help="Unit of a column of the radius, as 'mm'.")] = ""
    load: Annotated[
        str,
        typer.Option(
            help="Normal load: '50 N', one for each run as '10 N, 20 N', or the name of its column."
        ),
    ] = ""
    load_unit: Annotated[str, typer.Option(help="Unit of a column of the load, as 'N'.")] = ""
    run: Annotated[str, typer.Option(help="Name of the column that numbers the runs in a file.")] = ""
    mapping: Annotated[
        str,
        typer.Option(
            metavar="TOML",
            help="Roles, units and corrections of the channels.  [default: hersey.toml beside the log]",
        ),
    ] = ""
    isothermal: Annotated[
        bool, typer.Option("--isothermal", help="Leave temperature out: fit B = a w^c.")
    ] = False
    drop_missing: Annotated[
        bool,
        typer.Option(
            "--drop-missing",
            help="Leave out rows in which a number is missing or impossible, also where they are many.",
        ),
    ] = False
    means: Annotated[
        bool, typer.Option("--means", help="The file is a table of means: one row per dwell, no clock.")
    ] = False
    max_memory: MaxMemory = "2 GB"
    min_dwell: Annotated[str, typer.Option(help="Shortest dwell, with its unit.")] = "2 s"
    tare: Annotated[str, typer.Option(help="none, or standing: subtract the torque read while standing.")] = (
        "none"
    )
    rotation: Annotated[str, typer.Option(help="both, forward or reverse: dwells to use.")] = "both"
    temperature_scale: Annotated[str, typer.Option(help="degC or K: scale of T in B = a T^b w^c.")] = "degC"
    no_load: Annotated[
        str,
        typer.Option(
            "--no-load",
            metavar="LOG",
            help="Log of the drive without the film, read alike: what it takes is taken off the torque.",
        ),
    ] = ""

    def anywhere(self) -> Reading:
        """Return the same, its files whole: workers may have been started in another folder."""
        given = {name: getattr(self, name) for name in ("mapping", "no_load")}
        whole: dict[str, Any] = {name: str(Path(path).absolute()) for name, path in given.items() if path}
        return replace(self, **whole)

    def recipe(self, logs: Sequence[Path] = ()) -> Recipe:
        """Return how these logs become dwells."""
        from hersey.damping.recipe import Recipe
        from hersey.units import parse

        amounts = {role: _amounts(getattr(self, role)) for role in ("load", "radius")}
        named = {role: name for role in _ROLES if (name := getattr(self, role)) and not amounts.get(role)}
        return Recipe(
            logs=tuple(logs),
            mapping=Path(self.mapping) if self.mapping else None,
            channels=named,
            units={role: unit for role in _ROLES if (unit := getattr(self, f"{role}_unit", ""))},
            signs={
                role: sign for role in ("torque", "speed") if (sign := getattr(self, f"{role}_sign")) != 1
            },
            every=self.every or None,  # type: ignore[arg-type]
            **amounts,  # type: ignore[arg-type]
            isothermal=self.isothermal,
            drop_missing=self.drop_missing,
            means=self.means,
            min_dwell=parse("time", self.min_dwell),
            tare=self.tare,
            rotation=self.rotation,
            temperature_scale=self.temperature_scale,
            no_load=Path(self.no_load) if self.no_load else None,
        )

    def inputs(self, *given: Path | list[Path] | None) -> list[Path]:
        """Return the files that a command reads: those given, and the mapping; none may be an output."""
        named = [Path(path) for path in (self.mapping, self.no_load) if path]
        for paths in given:
            named += [paths] if isinstance(paths, Path) else paths or []
        return named

    def log(self, paths: list[Path], machine: Machine | None = None) -> TorqueLog | MeansTable:
        """Read the files as one log, or as tables of means, with a progress bar; say what is left out."""
        from hersey.log import memory_limit

        recipe = self.recipe(paths)
        with bar("reading") as progress, memory_limit(self.max_memory):
            log: TorqueLog | MeansTable = recipe.log(machine, progress=progress)
        for file in log.files:
            if file.missing_rows:
                say(*(f"{file.name}: {note}" for note in file.notes if "left out" in note), file=sys.stderr)
        stated = set() if machine is None else set(machine.sensors.stated)
        for role in sorted(stated and stated & set(recipe.chosen.sensors.stated)):
            say(
                f"errors of the sensor of {role}: those of the mapping are used, not those of the "
                "machine's file",
                file=sys.stderr,
            )
        return log

    def trace(self, path: Path, machine: Machine | None = None) -> TorqueLog:
        """Read a recording of the machine itself: starts from rest, or stick-slip."""
        from hersey.errors import ParameterError
        from hersey.log.torque_log import TorqueLog

        if machine is None:
            raise ParameterError("--trace needs --machine: what a start shows depends on stiffness and mass")
        read = self.log([path], machine)
        if not isinstance(read, TorqueLog):
            raise ParameterError(f"{path} is a table of means: a trace needs time, torque and speed")
        return read

    def points(self, log: TorqueLog | MeansTable, machine: Machine | None = None) -> SteadyPoints:
        """Reduce the log to dwells; say what a log of the drive without the film shows."""
        points = self.recipe().dwells(log, machine)
        if self.no_load and points.rest is not None:
            say(f"{points.rest.headline()}", *(f"- {note}" for note in points.rest.notes), file=sys.stderr)
        return points

    def points_of(self, paths: list[Path], machine: Machine | None = None) -> SteadyPoints:
        """Read one of several logs and reduce it; what is wrong with it begins with its name."""
        from hersey.damping.recipe import naming_logs

        with naming_logs(paths):
            return self.points(self.log(paths, machine), machine)

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
        points = self.points(self.log(paths, machine), machine)
        surface = fit(points, temperature_scale=self.temperature_scale)
        with working("drawing the drives that the log allows"):
            return surface, posterior(
                points,
                machine,
                surface=surface,
                traces=recorded,
                seed=seed,
                threads=os.cpu_count() or 1,
            )

    def surface(
        self, paths: list[Path] | None, fit_file: Path | None, machine: Machine | None = None
    ) -> DampingSurface:
        """Read a finished fit, or fit the log of a machine."""
        from hersey.damping.fit import fit
        from hersey.document.saved_fit import read_fit
        from hersey.errors import ParameterError

        if (fit_file is None) == (not paths):
            raise ParameterError("give either a LOG or --fit with what 'hersey fit LOG --json' printed")
        if fit_file is not None:
            if self != Reading():
                raise ParameterError(
                    "--fit holds a finished fit: leave out the options that say how to read a log"
                )
            if machine is not None and machine.sensors.stated:
                say(
                    "errors of the sensors: those of the fit are used, not those of the machine's file",
                    file=sys.stderr,
                )
            surface = read_fit(fit_file)
            if machine is not None and machine.rest is not None and surface.rest is None:
                raise ParameterError(
                    f"{fit_file.name} is fitted to the whole torque, and {machine.rest.source} says what the "
                    "drive takes besides the film: write the fit anew with hersey fit LOG --machine, or "
                    "leave [rest] out"
                )
            if machine is not None and machine.rest is not None:
                say(
                    "rest of the drive: that of the fit is used, not that of the machine's file",
                    file=sys.stderr,
                )
            return surface
        log = self.log(paths or [], machine)
        with working("fitting the surface"):
            return fit(self.points(log, machine), temperature_scale=self.temperature_scale)


_ROLES = ("time", "torque", "speed", "temperature", "load", "radius", "run")


def _amounts(text: str) -> str | list[str] | None:
    """A text that begins like an amount, several between commas, or None for none or a column's name."""
    parts = text.split(",")
    if not all(re.match(r"\s*[-+]?\.?[0-9]", part) for part in parts):
        return None
    return parts if len(parts) > 1 else text


def temperature_of(text: str, flag: str = "--at") -> float | None:
    """Return the temperature that ``--at``, or another flag, names, K; None if it is not given."""
    from hersey.errors import ParameterError
    from hersey.units import parse

    if not text:
        return None
    value = parse("temperature", text)
    if not value > 0:
        raise ParameterError(f"{flag} is {text}: it must be above absolute zero")
    return value


def target_of(text: str, machine: Machine, flag: str = "--target") -> float:
    """Return the speed that ``--target``, or another flag, names, of belt or roll, m/s at the belt."""
    from hersey.errors import ParameterError, WrongKindError
    from hersey.units import parse

    if not text:
        raise ParameterError("give the target: --target '60 mm/s'")
    try:
        target = parse("belt speed", text)
    except WrongKindError:
        target = parse("speed", text) * machine.roll_radius
    if not target > 0:
        raise ParameterError(f"{flag} is {text}: it must be greater than 0")
    return target


def heat_of(machine: Machine, file: Path, start: str) -> HeatBalance:
    """Return what warms a machine, from the temperature that ``--from`` names, or as its file states."""
    from hersey.errors import ParameterError

    if machine.heat is None:
        raise ParameterError(
            f"{file.name} does not say what warms the nip: add [heat], with film_capacity, roll_capacity, "
            "exchange, surroundings and heater_power"
        )
    kelvin = temperature_of(start, "--from")
    if kelvin is None:
        return machine.heat
    return replace(machine.heat, film_temperature=kelvin, roll_temperature=kelvin)


def warming_drag(surface: DampingSurface, machine: Machine) -> Drag:
    """Return the fitted drag as it varies with temperature."""
    from hersey.errors import ParameterError

    if surface.b is None:
        raise ParameterError("the log is isothermal: drag against temperature is needed for a warm-up")
    return surface.drag(**machine.belt)


def beyond_the_log(surface: DampingSurface, lowest: float, highest: float) -> list[str]:
    """Return what to say of temperatures (K) that the log does not cover."""
    from hersey.units import celsius

    if surface.temperature_range is None:
        return []
    low, high = surface.temperature_range
    if low - 1.0 <= lowest and highest <= high + 1.0:
        return []
    return [
        f"the log covers {celsius(low):.4g} to {celsius(high):.4g} degC: drag at "
        f"{celsius(lowest):.4g} to {celsius(highest):.4g} degC is extrapolated"
    ]


def share(flag: str, text: str) -> float:
    """Return the share that an option such as ``'2 %'`` names."""
    import re

    from hersey.errors import ParameterError

    match = re.fullmatch(r"\s*([0-9]+(?:\.[0-9]*)?)\s*%\s*", text[:60])
    if match is None:
        raise ParameterError(f"{flag} is '{text}': write a share such as '2 %'")
    return float(match[1]) / 100


def takes(group: type, name: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command with a parameter of that name the options of a group, before ``--json``."""

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        parameters = inspect.signature(command, eval_str=True).parameters
        types = get_type_hints(group, include_extras=True)
        keyword = inspect.Parameter.KEYWORD_ONLY
        options = [
            inspect.Parameter(field.name, keyword, default=field.default, annotation=types[field.name])
            for field in fields(group)
        ]
        before = [p.replace(kind=keyword) for n, p in parameters.items() if n not in (name, *_LAST)]
        after = [p.replace(kind=keyword) for n, p in parameters.items() if n in _LAST]

        @functools.wraps(command)
        def run(**given: Any) -> None:
            for logs in _LOGS & given.keys():
                given[logs] = given[logs] and files_of(given[logs])
            taken = group(**{option.name: given.pop(option.name) for option in options})
            command(**given, **{name: taken})

        run.__signature__ = inspect.Signature([*before, *options, *after])  # type: ignore[attr-defined]
        return run

    return decorate


#: Arguments that name logs: patterns among them stand for files.
_LOGS = {"logs", "runs"}
#: Options at the end of every help.
_LAST = ("as_json", "force")
reads_logs = takes(Reading, "reading")
