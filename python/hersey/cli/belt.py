"""From parameters: ``hersey simulate``, ``hersey sweep`` and ``hersey hysteresis``."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hersey.cli.options import AsJson, Force, takes
from hersey.cli.shell import app, bar, may_write, working
from hersey.errors import OutputError, ParameterError
from hersey.json_value import json_value

if TYPE_CHECKING:
    from hersey.drag import Drag
    from hersey.motion import Drivetrain


@dataclass(frozen=True)
class Belt:
    """The options that describe a belt, its spring and its drag; the defaults are the paper's baseline."""

    stiffness: Annotated[float, typer.Option(help="Spring stiffness k.")] = 1000.0
    mass: Annotated[float, typer.Option(help="Belt mass m.")] = 1.0
    transition_force: Annotated[
        float, typer.Option(help="Drag at the transition speed (B0 of the paper).")
    ] = 50.0
    transition_speed: Annotated[float, typer.Option(help="Speed where the branches meet.")] = 1.0
    ehl_exponent: Annotated[float, typer.Option(help="Damping exponent above it.")] = -0.7
    mixed_exponent: Annotated[float, typer.Option(help="Damping exponent below it.")] = -1.2
    stick_speed: Annotated[float, typer.Option(help="Speed below which the belt sticks.")] = 0.01
    closure: Annotated[
        str, typer.Option(help="What happens below it: retained, stiction, stribeck or lugre.")
    ] = "retained"
    bristle_stiffness: Annotated[
        float | None, typer.Option(help="Of lugre: force per deflection of the bristles.")
    ] = None
    bristle_damping: Annotated[float | None, typer.Option(help="Of lugre: force per rate of deflection.")] = (
        None
    )

    def parts(self) -> tuple[Drivetrain, Drag]:
        """Return drivetrain and drag."""
        from hersey.drag import Drag
        from hersey.motion import Drivetrain

        given = asdict(self)
        return Drivetrain(given.pop("stiffness"), given.pop("mass")), Drag(**given)


@app.command()
@takes(Belt, "belt")
def simulate(
    belt: Belt,
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
    from hersey import motion

    if csv is not None:
        may_write(csv, force)
    train, drag = belt.parts()
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
        may_write(out, force, inputs=[scenario])
    described = read_scenario(scenario)
    with bar("simulating", unit="sets") as progress:
        result = described.run(threads=threads, progress=progress)
    if out is not None:
        with working("writing the rows"):
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
@takes(Belt, "belt")
def hysteresis(
    belt: Belt,
    drive_speed: Annotated[
        float | None, typer.Option(help="Also say how large a kick or step the belt bears that slides at it.")
    ] = None,
    from_speed: Annotated[
        float | None, typer.Option(help="With --to-speed: say whether a step between them makes it stick.")
    ] = None,
    to_speed: Annotated[float | None, typer.Option(help="Speed at the end of the step.")] = None,
    as_json: AsJson = False,
) -> None:
    """Find the drive speeds between which the past decides whether the belt sticks.

    Values are in any consistent set of units; the defaults are the paper's baseline in inches, ounces of
    force and seconds.

    Example: [bold]hersey hysteresis --from-speed 2.5 --to-speed 1.2[/bold]
    """
    from hersey import approach
    from hersey.hysteresis import hysteresis as band_of

    if (from_speed is None) != (to_speed is None):
        raise ParameterError("a step needs both --from-speed and --to-speed")
    train, law = belt.parts()
    with working("looking for the band"):
        band = band_of(train, law)
        bears = None if drive_speed is None else approach.disturbance(train, law, drive_speed=drive_speed)
        step = None
        if from_speed is not None and to_speed is not None:
            step = approach.safe_step(train, law, from_speed=from_speed, to_speed=to_speed)
    if as_json:
        document = {
            **json_value(asdict(band)),
            "bistable": band.bistable,
            "verdict": band.verdict(),
            "disturbance": None if bears is None else json_value(asdict(bears)),
            "step": None if step is None else json_value(asdict(step)),
        }
        print(json.dumps(document, indent=1, allow_nan=False))
        return
    lines = [
        f"lower edge        {band.lower:.9g}  (to {band.lower_accuracy:.0e})",
        f"transition speed  {band.transition:.9g}",
        f"upper fold V*     {band.upper:.9g}  (to {band.upper_accuracy:.0e}, by {band.method})",
    ]
    if band.deeper:
        lines.append("at the upper fold a deeper stick-slip ends, released higher than at the stick speed")
    if band.sensitivity:
        own = {**vars(train), **vars(law)}
        lines.append(
            f"{'parameter':18s} {'value':>12s} {'dV*/dparameter':>15s}"
            f" {'V* for +1 %':>13s} {'lower, +1 %':>13s}"
        )
        lines += [
            f"{name:18s} {own[name]:12.6g} {band.derivative(name, own[name]):15.6g} {share:+10.3f} % "
            f"{band.lower_sensitivity[name]:+10.3f} %"
            for name, share in band.sensitivity.items()
        ]
    lines.append(band.verdict())
    if bears is not None:
        lines.append(
            f"Sliding at {bears.drive_speed:g} it bears a sudden loss of belt speed of {bears.kick:.6g}, "
            f"and a sudden fall of the drive from {bears.drive_speed + bears.step:.6g}."
        )
    if step is not None:
        does = "sticks" if step.sticks else "goes on sliding"
        ramp = (
            "no ramp is slow enough"
            if step.ramp_time == float("inf")
            else f"ramps of {step.ramp_time:.6g} and longer are safe"
            if step.ramp_time > 0
            else "any ramp is safe"
        )
        lines.append(f"From {step.from_speed:g} to {step.to_speed:g} at once it {does}; {ramp}.")
    print("\n".join(lines))
