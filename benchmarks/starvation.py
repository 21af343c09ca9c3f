"""Whether the age at which a film starves is held where film, starvation and drag follow other laws.

The specimens are those of `benchmarks.starved_films`, a generator that shares no code with hersey. hersey
sees tables of means of eight specimens, followed to 50 to 110 % of the median age, and the machine file.

Usage: python -m benchmarks.starvation [--campaigns 80] [--seed 1] [--workers 2] [--scheduler ADDRESS]
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.life import Log, campaign_of
from benchmarks.starved_films import LAWS, SHARES, UNITS, ZERO, Drive, World, draw, torque
from benchmarks.working import takes_workers, worked

#: Ages beyond so many times the age last seen are not judged.
NEAR = 3.0
#: Ages are handed over in pages, so many to the median age of starvation.
SCALE = 1e5


@dataclass(frozen=True)
class Case:
    """A reported age: truth and interval over the age last seen; and the share that was reported."""

    seed: int
    law: str
    share: float
    true: float
    low: float
    middle: float
    high: float
    shares: tuple[float, float, float]
    seconds: float = 0.0


def logs_of(world: World, random: np.random.Generator) -> list[Log]:
    """Return 5 to 10 logs of each specimen: dwells with noise of 1 %, and errors of gain and zero."""
    drive = world.drive
    stop = float(np.median(world.thin)) * random.uniform(0.5, 1.1)
    kelvins = np.linspace(drive.cold, drive.hot, random.integers(5, 8))
    speeds = drive.fast * np.geomspace(random.uniform(0.03, 0.12), 1.05, random.integers(8, 13))
    speed, kelvin = (each.ravel() for each in np.meshgrid(speeds, kelvins))
    gain, many, found = 1.0 + random.normal(0.0, 0.004), random.integers(5, 11), []
    for unit in range(UNITS):
        at = np.sort(random.uniform(0.0, stop, many))
        at[0] = 0.0
        for age in at.tolist():
            true = torque(drive, world.at(unit, age), speed, kelvin)
            read = true * gain * (1.0 + random.normal(0.0, 0.002)) + random.normal(0.0, 0.001 * true.max())
            read = read * (1.0 + random.normal(0.0, 0.01, true.size))
            columns = {
                "speed [rpm]": speed / drive.radius * 30.0 / np.pi,
                "temperature [degC]": kelvin - ZERO + random.normal(0.0, 0.3),
                "torque [N*m]": read,
                "torque error [N*m]": 0.01 * np.abs(read),
            }
            found.append(Log(f"F{unit + 1}", age, columns))
    return found


def machine_file(drive: Drive, random: np.random.Generator) -> str:
    """Return what the engineer states: the oil within 10 %, the nip, and asperities of half of the drives."""
    factor = float(np.exp(random.normal(0.0, 0.06)))
    faces = f"""
[asperities]
modulus = "2 GPa"
sigma_beta_density = 0.04
sigma_over_beta = 0.001

[boundary]
friction = {drive.friction * random.uniform(0.8, 1.2):.4g}
"""
    thick, thin = factor * drive.thick, factor * drive.thin
    stated = drive.law == "mixed" and random.uniform() < 0.5
    return f"""
[drivetrain]
stiffness = "10 N/mm"
mass = "10 kg"
roll_radius = "{drive.radius:.9g} m"
stick_speed = "3 mm/s"

[limits]
motor_torque = "5 N*m"
roll_friction = 0.6
nip_load = "{drive.load:.9g} N"
speed = "{drive.fast:.9g} m/s"

[contact]
rubber_thickness = "{drive.rubber:.9g} m"
modulus = "{drive.modulus:.9g} Pa"
poisson_ratio = 0.48
length = "{drive.length:.9g} m"
roughness = "{drive.roughness * random.uniform(0.8, 1.25):.9g} m"

[lubricant]
name = "oil"
model = "walther"
viscosities = [["40 degC", "{thick:.9g} mm^2/s"], ["200 degC", "{thin:.9g} mm^2/s"]]
density = "{drive.density:.9g} kg/m^3"
uncertainty = "15 %"
{faces if stated else ""}
[[points]]
name = "full speed"
speed = "{drive.fast:.9g} m/s"
temperature = "{drive.hot - ZERO:.9g} degC"
"""


def campaign(seed: int, folder: Path) -> list[Case]:
    """Draw a campaign, ask hersey when its specimens starve, and set that beside the truth."""
    from hersey.life.film.through_life import film_life
    from hersey.machine.machine import read_machine

    world, random = draw(seed), np.random.default_rng([seed, 3141])
    logs = logs_of(world, random)
    (folder / "machine.toml").write_text(machine_file(world.drive, random))
    machine, kept = read_machine(folder / "machine.toml"), campaign_of(logs, SCALE, folder)
    begin = time.process_time()
    film = film_life(kept, machine)
    seconds = time.process_time() - begin
    found = []
    for each in film.starves[0].units:
        last = max(log.age for log in logs if log.unit == each.unit)
        true = float(world.starved[int(each.unit[1:]) - 1])
        ends = (getattr(each.age, name) / SCALE / last for name in ("low", "value", "high"))
        shares = (film.other_drag.low, film.other_drag.share, film.other_drag.high)
        found.append(Case(seed, world.drive.law, world.drive.share, true / last, *ends, shares, seconds))
    return found


def tried(seed: int) -> tuple[list[Case], str]:
    """Return what a campaign shows, and its fault."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            return campaign(seed, Path(folder)), ""
        except Exception as error:  # a fault is reported, and does not end the others
            return [], f"seed {seed}: {type(error).__name__}: {error}"


def line(name: str, found: list[Case]) -> str:
    """Return a row of the table."""
    if not found:
        return f"| {name} | 0 |" + " |" * 6
    true, low, middle, high = np.array([(each.true, each.low, each.middle, each.high) for each in found]).T
    with np.errstate(invalid="ignore"):
        width, off = np.median((high - low) / true), np.median(middle / true - 1.0)
    inside = np.mean((low <= true) & (true <= high))
    cells = (
        name,
        len(found),
        f"{inside:.0%}",
        f"{np.mean(true < low):.0%}",
        f"{np.mean(true > high):.0%}",
        f"{width:.2f}",
        f"{off:+.0%}",
        f"{np.mean([each.shares[0] - 0.03 <= each.share <= each.shares[2] + 0.03 for each in found]):.0%}",
    )
    return "| " + " | ".join(map(str, cells)) + " |"


def table(found: list[Case]) -> list[str]:
    """Return the lines of the table: by law, by share, and all."""
    near = [each for each in found if each.true <= NEAR]
    lines = [
        "| | ages | hold the truth | truth below | truth above | width over age | off | share held |",
        "|" + "---|" * 8,
    ]
    lines += [line(law, [each for each in near if each.law == law]) for law in LAWS]
    lines += [line(f"share {share:.0%}", [each for each in near if each.share == share]) for share in SHARES]
    return [*lines, line("all", near)]


def main() -> None:
    """Run the campaigns and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--campaigns", type=int, default=80)
    parser.add_argument("--seed", type=int, default=1, help="first seed")
    takes_workers(parser)
    given = parser.parse_args()
    from benchmarks.starvation import tried as task  # worker processes know no `__main__` of this one

    every: list[Case] = []
    wrong: list[str] = []
    seeds = range(given.seed, given.seed + given.campaigns)
    for found, fault in worked(task, seeds, given):
        every += found
        wrong += [fault] if fault else []
        if found:
            print(
                line(f"seed {found[0].seed} {found[0].law} {found[0].share:.0%}", found),
                "share",
                *(f"{each:.2f}" for each in found[0].shares),
                f"{found[0].seconds:.1f} s",
                file=sys.stderr,
                flush=True,
            )
    print("\n".join([*table(every), "", *wrong]))


if __name__ == "__main__":
    main()
