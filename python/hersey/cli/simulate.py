"""What a belt settles to: ``hersey simulate``."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from hersey.cli.options import (
    AsJson,
    Belt,
    Force,
    takes,
)
from hersey.cli.outputs import may_write


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
    if csv is not None:
        may_write(csv, force)

    from hersey.motion import simulation as motion

    train, drag = belt.parts()
    cycle = motion.stick_slip(train, drag, drive_speed=drive_speed, start=start)
    run = None
    if csv is not None or check:
        run = motion.simulate(
            train, drag, drive_speed=drive_speed, duration=duration, start=start, check=check
        )
    if csv is not None and run is not None:
        import polars as pl

        from hersey.files.writing import write_atomically

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
