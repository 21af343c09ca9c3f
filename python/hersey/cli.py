"""The commands: each mirrors a verb of the package and computes nothing of its own.

A mistake of the user's ends in one line on stderr and exit code 2.
"""

from __future__ import annotations

import json
import os
import shlex
import signal
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.progress import (
    BarColumn,
    DownloadColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeRemainingColumn,
)

from hersey import __version__
from hersey.errors import HerseyError, OutputError, ParameterError

if TYPE_CHECKING:
    from hersey.log import TorqueLog

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
    help=(
        "From a torque log to the lubrication state of a sliding drive.\n\n"
        "Example: [bold]hersey report examples/bench.csv[/bold]"
    ),
)
stderr = Console(stderr=True)
#: Largest log that `testbench --size` writes, bytes.
LARGEST_LOG = 4e9
#: Exit code after Ctrl-C, as shells have it.
INTERRUPTED = 130

Logs = Annotated[list[Path], typer.Argument(metavar="LOG...", help="Log file, or several of one machine.")]
Torque = Annotated[str, typer.Option("--torque", help="Name of the torque column, as 'Tq' or 'Tq (ozf.in)'.")]
Speed = Annotated[str, typer.Option("--speed", help="Name of the speed column.")]
Temperature = Annotated[str, typer.Option("--temperature", help="Name of the temperature column.")]
Time = Annotated[str, typer.Option("--time", help="Name of the time column.")]
TorqueUnit = Annotated[
    str, typer.Option("--torque-unit", help="Unit of torque, may carry a factor: '9.84 mN*m / 100' for %.")
]
SpeedUnit = Annotated[
    str, typer.Option("--speed-unit", help="Unit of speed, as 'rpm'; '-1 rpm' turns the sign.")
]
TemperatureUnit = Annotated[str, typer.Option("--temperature-unit", help="Unit of temperature, as 'degC'.")]
TimeUnit = Annotated[str, typer.Option("--time-unit", help="Unit of time, as 's' or 'ms'.")]
Isothermal = Annotated[bool, typer.Option("--isothermal", help="Leave temperature out: fit B = a w^c.")]
DropMissing = Annotated[
    bool, typer.Option("--drop-missing", help="Leave out rows in which a number is missing.")
]
MinDwell = Annotated[str, typer.Option("--min-dwell", help="Shortest dwell, with its unit.")]
Tare = Annotated[
    str, typer.Option("--tare", help="none, or standing: subtract the torque read while standing.")
]
Rotation = Annotated[str, typer.Option("--rotation", help="both, forward or reverse: dwells to use.")]
Scale = Annotated[str, typer.Option("--temperature-scale", help="degC or K: scale of T in B = a T^b w^c.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print the whole result as JSON.")]
Force = Annotated[bool, typer.Option("--force", help="Replace files that exist.")]
FuserFile = Annotated[
    Path | None,
    typer.Option("--fuser", metavar="TOML", help="Drivetrain of the machine, for the simulation."),
]


@app.command()
def report(
    logs: Logs,
    out: Annotated[
        Path | None, typer.Option("--out", help="The page to write.  [default: report.html]")
    ] = None,
    figures: Annotated[
        Path | None,
        typer.Option("--figures", metavar="DIR", help="Also write each chart as SVG, PNG and PDF."),
    ] = None,
    fuser: FuserFile = None,
    torque: Torque = "",
    torque_unit: TorqueUnit = "",
    speed: Speed = "",
    speed_unit: SpeedUnit = "",
    temperature: Temperature = "",
    temperature_unit: TemperatureUnit = "",
    time: Time = "",
    time_unit: TimeUnit = "",
    isothermal: Isothermal = False,
    drop_missing: DropMissing = False,
    min_dwell: MinDwell = "2 s",
    tare: Tare = "none",
    rotation: Rotation = "both",
    temperature_scale: Scale = "degC",
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Write a report: regime, damping surface, data quality and a stick-slip simulation, in one HTML page.

    Example: [bold]hersey report examples/bench.csv --fuser examples/fuser.toml --tare standing[/bold]

    With --json the analysis document goes to stdout, and a page is written only if --out is given.
    """
    from hersey.analysis import analyse
    from hersey.fuser import read_fuser
    from hersey.report import render, write_atomically

    page = out or (None if as_json else Path("report.html"))
    if page is not None:
        _may_write(page, force, inputs=[*logs, *([fuser] if fuser else [])])
    if figures is not None:
        _may_write_folder(figures, force)
    machine = None if fuser is None else read_fuser(fuser)
    log = _read(
        logs,
        _choices(time, torque, speed, temperature),
        _choices(time_unit, torque_unit, speed_unit, temperature_unit),
        isothermal,
        drop_missing,
    )
    with _working("fitting the surface"):
        points = log.steady(min_dwell=_duration(min_dwell), tare=tare, rotation=rotation)
        document = analyse(
            log, points, command=_command(), temperature_scale=temperature_scale, fuser=machine
        )
    if page is not None:
        with _working("drawing the page"):
            write_atomically(page, render(document), overwrite=True)
    if figures is not None:
        from hersey.charts import write_figures

        with _working("writing the figures"):
            write_figures(document, figures)
    if as_json:
        print(document.model_dump_json(indent=1))
        return
    print(document.regime.verdict)
    for warning in document.warnings:
        print(f"- {warning}")
    print(document.fit.summary)
    print(f"report: {page}")


@app.command()
def fit(
    logs: Logs,
    torque: Torque = "",
    torque_unit: TorqueUnit = "",
    speed: Speed = "",
    speed_unit: SpeedUnit = "",
    temperature: Temperature = "",
    temperature_unit: TemperatureUnit = "",
    time: Time = "",
    time_unit: TimeUnit = "",
    isothermal: Isothermal = False,
    drop_missing: DropMissing = False,
    min_dwell: MinDwell = "2 s",
    tare: Tare = "none",
    rotation: Rotation = "both",
    temperature_scale: Scale = "degC",
    as_json: AsJson = False,
) -> None:
    """Fit the damping surface B = a T^b w^c and print it, with the verdict on the regime.

    Example: [bold]hersey fit examples/bench.csv --tare standing[/bold]
    """
    from hersey.analysis import analyse

    log = _read(
        logs,
        _choices(time, torque, speed, temperature),
        _choices(time_unit, torque_unit, speed_unit, temperature_unit),
        isothermal,
        drop_missing,
    )
    with _working("fitting the surface"):
        points = log.steady(min_dwell=_duration(min_dwell), tare=tare, rotation=rotation)
        document = analyse(log, points, command=_command(), temperature_scale=temperature_scale)
    if as_json:
        chosen = document.model_dump(mode="json", include={"fit", "regime", "hersey_version", "command"})
        print(json.dumps(chosen, indent=1))
        return
    print(document.fit.summary)
    print(document.regime.verdict)


@app.command()
def simulate(
    stiffness: Annotated[float, typer.Option(help="Spring stiffness k.")] = 1000.0,
    mass: Annotated[float, typer.Option(help="Belt mass m.")] = 1.0,
    transition_force: Annotated[
        float, typer.Option(help="Drag at the transition speed (B0 of the paper).")
    ] = 50.0,
    transition_speed: Annotated[float, typer.Option(help="Speed where the branches meet.")] = 1.0,
    ehl_exponent: Annotated[float, typer.Option(help="Damping exponent above it.")] = -0.7,
    mixed_exponent: Annotated[float, typer.Option(help="Damping exponent below it.")] = -1.2,
    stick_speed: Annotated[float, typer.Option(help="Speed below which the belt sticks.")] = 0.01,
    closure: Annotated[
        str, typer.Option(help="What happens below it: retained, stiction, stribeck or lugre.")
    ] = "retained",
    bristle_stiffness: Annotated[
        float | None, typer.Option(help="Of lugre: force per deflection of the bristles.")
    ] = None,
    bristle_damping: Annotated[
        float | None, typer.Option(help="Of lugre: force per rate of deflection.")
    ] = None,
    drive_speed: Annotated[float, typer.Option(help="Speed of the drive.")] = 1.0,
    start: Annotated[str, typer.Option(help="rest, or steady (sliding with the drive).")] = "rest",
    duration: Annotated[float, typer.Option(help="Time simulated, for --csv and --check.")] = 2.0,
    check: Annotated[
        bool, typer.Option("--check", help="Simulate with a second integrator too, and compare.")
    ] = False,
    csv: Annotated[
        Path | None, typer.Option("--csv", metavar="FILE", help="Write the motion as CSV.")
    ] = None,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Simulate the belt at constant drive speed and say what it settles to (defaults: the paper's baseline).

    Values are in any consistent set of units; the paper's are inches, ounces of force and seconds.

    Example: [bold]hersey simulate --stiffness 2000 --drive-speed 1.3[/bold]
    """
    from hersey import drag as laws
    from hersey import motion

    if csv is not None:
        _may_write(csv, force)
    train = motion.Drivetrain(stiffness, mass)
    drag = laws.Drag(
        transition_force,
        transition_speed,
        ehl_exponent=ehl_exponent,
        mixed_exponent=mixed_exponent,
        stick_speed=stick_speed,
        closure=closure,
        bristle_stiffness=bristle_stiffness,
        bristle_damping=bristle_damping,
    )
    cycle = motion.stick_slip(train, drag, drive_speed=drive_speed, start=start)
    run = None
    if csv is not None or check:
        run = motion.simulate(
            train, drag, drive_speed=drive_speed, duration=duration, start=start, check=check
        )
    if csv is not None and run is not None:
        import polars as pl

        from hersey.report import write_atomically

        table = pl.DataFrame(
            {
                "time": run.time,
                "belt_speed": run.belt_speed,
                "stretch": run.stretch,
                "spring_force": run.spring_force,
                "mode": run.mode,
            }
        )
        write_atomically(csv, table.write_csv(), overwrite=True)
    if as_json:
        document: dict[str, object] = {**asdict(cycle), "stuck_fraction": cycle.stuck_fraction}
        if run is not None:
            document["energy"] = asdict(run.energy)
            document["check"] = None if run.check is None else asdict(run.check)
        print(json.dumps(document, indent=1))
        return
    lines = [
        f"{cycle.kind.replace('_', ' ')}",
        f"  frequency       {cycle.frequency:.6f}",
        f"  stuck fraction  {cycle.stuck_fraction:.6f}",
        f"  belt speed      {cycle.speed_min:.6f} to {cycle.speed_max:.6f}",
        f"  stretch         {cycle.stretch_min:.6f} to {cycle.stretch_max:.6f}",
        f"  drag work       {cycle.drag_work:.6f} a lap",
    ]
    if run is not None:
        lines.append(f"energy balance: {run.energy.residual:.1e} of the energy turned over is missing")
    if run is not None and run.check is not None:
        seen = run.check
        lines.append(
            f"{seen.integrator}: " + seen.note
            if seen.speed_difference is None
            else f"{seen.integrator} differs by {seen.speed_difference:.1e} in speed and "
            f"{seen.stretch_difference:.1e} in stretch; "
            f"{'the same' if seen.same_events else 'OTHER'} events"
        )
    print("\n".join(lines))


@app.command()
def sweep(
    scenario: Annotated[Path, typer.Argument(metavar="SCENARIO", help="TOML file that describes the sweep.")],
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE", help="Write every set as a row: .parquet or .csv.")
    ] = None,
    threads: Annotated[
        int, typer.Option("--threads", help="Threads to use; the result is the same for any number.", min=1)
    ] = 1,
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Find what every combination of parameters settles to, and count the outcomes.

    Example: [bold]hersey sweep examples/scenario.toml --out sweep.parquet --threads 2[/bold]
    """
    from hersey.report import write_atomically
    from hersey.scenario import read_scenario, rows, summary

    if out is not None:
        if out.suffix not in (".parquet", ".csv"):
            raise OutputError(f"--out {out}: name a file that ends in .parquet or .csv")
        _may_write(out, force, inputs=[scenario])
    described = read_scenario(scenario)
    with _bar("simulating", unit="sets") as progress:
        result = described.run(threads=threads, progress=progress)
    if out is not None:
        with _working("writing the rows"):
            write_atomically(out, rows(result, out.suffix), overwrite=True)
    counted = summary(result)
    if as_json:
        print(json.dumps(counted, indent=1))
        return
    for kind, share in counted["kinds"].items():
        print(f"{kind.replace('_', ' '):16s}{share}")
    for name, (low, high) in counted["stick_slip"].items():
        print(f"  {name.replace('_', ' '):16s}{low:.6g} to {high:.6g}")
    for failure in counted["failures"]:
        print(f"- {failure}")
    if out is not None:
        print(f"sweep: {out}")


@app.command()
def figures(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder for the figures.")] = Path(
        "figures"
    ),
    as_json: AsJson = False,
    force: Force = False,
) -> None:
    """Draw the paper's Figs. 9-12 anew, and say of each claim whether it holds and how well.

    Example: [bold]hersey figures --out figures[/bold]
    """
    from hersey import figures as paper

    _may_write_folder(out, force, flag="--out")
    with _working("simulating"):
        drawn = paper.paper_figures()
    with _working("drawing"):
        paper.write(drawn, out, overwrite=force)
    if as_json:
        print(paper.as_json(drawn))
        return
    for figure in drawn:
        print(f"Fig. {figure.number}: {figure.title}")
        for claim in figure.claims:
            print(f"  {claim.verdict.value}: {claim.statement} ({claim.evidence})")
    print(f"figures: {out}")


@app.command()
def testbench(
    out: Annotated[Path, typer.Option("--out", help="The log to write.")] = Path("log.csv"),
    truth: Annotated[
        Path | None, typer.Option("--truth", metavar="JSON", help="Also write the truth.")
    ] = None,
    seed: Annotated[int, typer.Option("--seed", help="Of all random draws.", min=0)] = 0,
    size: Annotated[
        str, typer.Option("--size", help="Least size of the log, as '1 GB': sampled faster.")
    ] = "",
    force: Force = False,
) -> None:
    """Write a log of the virtual test stand: synthetic, with a known truth, for tests and for learning.

    Example: [bold]hersey testbench --out log.csv --truth truth.json --seed 7[/bold]
    """
    import io

    from hersey import testbench as stand
    from hersey.report import write_atomically

    for path in (out, truth):
        if path is not None:
            _may_write(path, force)
    if truth is not None and truth.absolute() == out.absolute():
        raise OutputError(f"--out and --truth both name {out}: name two files")
    if size:
        _write_long(out, _bytes(size), seed)
        document = {**stand.run(seed=seed).truth_document(), "size": size}
    else:
        with _working("running the virtual test stand"):
            log = stand.run(seed=seed)
            text = io.StringIO()
            log.write(text)
            write_atomically(out, text.getvalue(), overwrite=True)
            document = log.truth_document()
    if truth is not None:
        write_atomically(truth, json.dumps(document, indent=1) + "\n", overwrite=True)
    print(f"synthetic log (seed {seed}): {out}")


def main() -> None:
    """Run the command line."""
    signal.signal(signal.SIGTERM, _interrupt)
    code: int | None = None
    try:
        code = app(standalone_mode=False)
    except HerseyError as error:
        _fail(str(error))
    except (KeyboardInterrupt, typer.Abort):
        code = INTERRUPTED
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # nothing is left to flush into it
        sys.exit(0)
    except OSError as error:
        _fail(f"cannot write the result: {error.strerror}")
    except Exception as error:
        usage = getattr(error, "format_message", None)  # click's own errors know how to say it
        if usage is None:
            raise
        _fail(usage())
    if code == INTERRUPTED:
        _fail("interrupted", code=INTERRUPTED)
    sys.exit(code or 0)


def _fail(message: str, code: int = 2) -> None:
    shown = "".join(c if c.isprintable() else "?" for c in " ".join(message.split()))
    if shown:
        print(f"hersey: {shown}", file=sys.stderr)
    sys.exit(code)


def _interrupt(_signal: int, _frame: object) -> None:
    raise KeyboardInterrupt


@app.callback(invoke_without_command=True)
def _root(version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False) -> None:
    if version:
        print(f"hersey {__version__}")
        raise typer.Exit


def _choices(time: str, torque: str, speed: str, temperature: str) -> dict[str, str]:
    given = {"time": time, "torque": torque, "speed": speed, "temperature": temperature}
    return {role: text for role, text in given.items() if text}


def _read(
    logs: list[Path], channels: dict[str, str], units: dict[str, str], isothermal: bool, drop_missing: bool
) -> TorqueLog:
    from hersey.log import read

    with _bar("reading") as progress:
        return read(
            logs,
            channels=channels,
            units=units,
            isothermal=isothermal,
            drop_missing=drop_missing,
            progress=progress,
        )


def _duration(text: str) -> float:
    from hersey.units import parse

    return parse("time", text)


def _bytes(text: str) -> int:
    import re

    match = re.fullmatch(r"\s*(\d+(?:\.\d+)?)\s*([kMG]?)B\s*", text)
    if match is None:
        raise ParameterError(f"--size '{text}' is not a size: write it as '1 GB' or '20 MB'")
    size = float(match[1]) * {"": 1, "k": 1e3, "M": 1e6, "G": 1e9}[match[2]]
    if size > LARGEST_LOG:
        raise ParameterError(f"--size '{text}' is more than the {LARGEST_LOG / 1e9:g} GB that fit in memory")
    return int(size)


def _command() -> str:
    return " ".join(["hersey", *(shlex.quote(part) for part in sys.argv[1:])])


def _may_write(path: Path, force: bool, inputs: Sequence[Path] = ()) -> None:
    """Refuse early what cannot be written, and ask before replacing anything."""
    try:
        exists = os.path.lexists(path)
        if path.is_dir():
            raise OutputError(f"{path} is a directory: name a file in it")
        if not path.parent.is_dir():
            raise OutputError(f"{path}: there is no directory {path.parent}")
        if exists and (path.is_symlink() or not path.is_file()):
            raise OutputError(f"{path} is no ordinary file: name another")
        if any(exists and other.exists() and path.samefile(other) for other in inputs):
            raise OutputError(f"{path} is an input: name another file for the output")
    except OSError as error:
        if isinstance(error, OutputError):
            raise
        raise OutputError(f"{path} cannot be written: {error.strerror}") from None
    if exists and not force:
        asked = sys.stdin.isatty() and typer.confirm(f"{path} exists. Replace it?", err=True)
        if not asked:
            raise OutputError(f"{path} exists: say --force to replace it, or name another file")


def _may_write_folder(folder: Path, force: bool, flag: str = "--figures") -> None:
    try:
        if folder.exists() and not folder.is_dir():
            raise OutputError(f"{folder} is a file: {flag} needs a directory")
        if folder.is_dir() and any(folder.iterdir()) and not force:
            raise OutputError(f"{folder} is not empty: say --force to write the figures into it")
        if not folder.parent.is_dir():
            raise OutputError(f"{folder}: there is no directory {folder.parent}")
    except OSError as error:
        if isinstance(error, OutputError):
            raise
        raise OutputError(f"{folder} cannot be written: {error.strerror}") from None


def _write_long(path: Path, size: int, seed: int) -> None:
    from hersey import testbench as stand

    part: Path | None = None
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=".hersey-", suffix=".part")
        part = Path(name)
        with os.fdopen(handle, "w", encoding="utf-8") as file, _bar("writing") as progress:
            done = 0
            for text in stand.long_log(bytes_wanted=size, seed=seed):
                file.write(text)
                done += len(text)
                progress(min(done, size), size)
        part.replace(path)
    except OSError as error:
        raise OutputError(f"{path} cannot be written: {error.strerror}") from None
    finally:
        if part is not None:
            part.unlink(missing_ok=True)


@contextmanager
def _working(what: str) -> Iterator[None]:
    """A spinner on a terminal, nothing elsewhere."""
    if stderr.is_terminal:
        with stderr.status(what):
            yield
    else:
        yield


@contextmanager
def _bar(what: str, unit: str = "") -> Iterator[Callable[[int, int], None]]:
    """A progress bar on a terminal, nothing elsewhere; counts bytes unless there is a unit."""
    amount = MofNCompleteColumn() if unit else DownloadColumn()
    columns = (TextColumn(what), BarColumn(), amount, TextColumn(unit), TimeRemainingColumn())
    with Progress(*columns, console=stderr, transient=True, disable=not stderr.is_terminal) as progress:
        task = progress.add_task(what, total=None)
        yield lambda done, total: progress.update(task, completed=done, total=total)


if __name__ == "__main__":
    main()
