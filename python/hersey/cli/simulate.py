"""What a belt settles to: ``hersey simulate``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from hersey.cli.options import (
    AsJson,
    Belt,
    Force,
    takes,
)
from hersey.cli.outputs import may_write, print_json
from hersey.cli.terminal import say


@takes(Belt, "belt")
def simulate(
    belt: Belt,
    drive_speed: Annotated[
        str | None, typer.Option(help="Speed of the drive, as '30 mm/s'.  [default: 1]")
    ] = None,
    start: Annotated[str, typer.Option(help="rest, or steady (sliding with the drive).")] = "rest",
    duration: Annotated[
        str | None, typer.Option(help="Time simulated, for --csv and --check, as '2 s'.  [default: 2]")
    ] = None,
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

    Numbers carry units, as '11 N/mm', or are bare in any consistent set of units; those of the paper are
    inches, ounces of force and seconds. With units, results are in SI.

    Example: [bold]hersey simulate --stiffness 2000 --drive-speed 1.3[/bold]
    """
    if csv is not None:
        may_write(csv, force, inputs=[belt.machine] if belt.machine else [])

    from hersey.motion import simulation as motion
    from hersey.result import json_value

    train, drag, numbers = belt.parts(
        needed=("drive_speed", "duration"), drive_speed=drive_speed, duration=duration
    )
    speed, time = (numbers.values[name] or 0.0 for name in ("drive_speed", "duration"))
    cycle = motion.stick_slip(train, drag, drive_speed=speed, start=start)
    run = None
    motor = None
    if csv is not None or check or belt.machine is not None:
        run = motion.simulate(train, drag, drive_speed=speed, duration=time, start=start, check=check)
    if run is not None:
        motor = belt.motor_use(run)
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
                "roll_slips": run.slipping,
            }
        )
        write_atomically(csv, table.write_csv(), overwrite=True)
    if as_json:
        ran = {} if run is None else {"energy": json_value(run.energy), "check": json_value(run.check)}
        ran |= {} if motor is None else {"motor": json_value(motor)}
        print_json("simulate", cycle.to_dict() | ran)
        return
    lines = [cycle.summary()]
    if run is not None:
        lines.append(f"energy balance: {run.energy.residual:.1e} of the energy turned over is missing")
    if run is not None and run.check is not None:
        lines.append(str(run.check))
    if run is not None and run.roll_slips:
        lines.append(f"over {time:g} s {run.slipping_in_words()}")
    if motor is not None:
        lines.append(str(motor))
    say("\n".join([*lines, *numbers.words]))
