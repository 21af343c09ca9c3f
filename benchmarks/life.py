"""Whether a life test of virtual units is read rightly: which end comes first, and when.

The units are those of `benchmarks.lives`, a generator that shares no code with hersey. hersey sees tables of
means of 8 units with some 10 logs each, followed to 60 % of the median life, and the file of the machine.

Usage: python -m benchmarks.life [--campaigns 200] [--seed 1001] [--workers 2] [--scheduler ADDRESS]
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.lives import AGES, AIMS, MEDIAN, STATES, UNITS, ZERO, State, World, draw, torque
from benchmarks.working import takes_workers, worked

if TYPE_CHECKING:
    from hersey.life.campaign import Campaign

# --- the stand -------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Log:
    """A table of means, as the stand hands it over."""

    unit: str
    age: float  # over the life aimed at
    columns: dict[str, np.ndarray]


def logs_of(world: World, random: np.random.Generator, count: int = 10) -> tuple[list[Log], float]:
    """Some ``count`` logs of each unit up to 60 % of the median of the true ages, and that age."""
    ends = np.min([world.ages[name] for name in AIMS], axis=0)[:UNITS]
    stop = 0.6 * float(np.median(ends))
    drive, duty = world.drive, world.duty
    kelvins = np.linspace(duty.cold, duty.hot, random.integers(5, 9))
    # A stand that is stiff enough goes below the speed of least drag; not every laboratory does.
    least = float(world.indicators["stick"][MEDIAN, 0])
    slowest = min(duty.slow * random.uniform(0.25, 0.9), (least or np.inf) * random.uniform(0.3, 1.2))
    speeds = np.geomspace(slowest, duty.fast * random.uniform(1.0, 1.1), random.integers(8, 15))
    grid = [each.ravel() for each in np.meshgrid(speeds, kelvins)]
    gain = 1 + random.normal(0.0, 0.004)
    found = []
    for unit in range(UNITS):
        own = max(3, count - int(random.integers(0, 3)))
        at = np.sort(random.uniform(0.0, 1.0, own))
        at[0] *= random.choice([0.0, 1.0])
        for age in at * stop:
            now = State(
                *(np.array(np.interp(age, AGES, getattr(world.states, name)[unit])) for name in STATES)
            )
            true = torque(drive, now, *grid)[0]
            keep = true < world.limits["cold"]
            if random.uniform() < 0.1:
                keep &= random.uniform(size=keep.size) < 0.6
            read = true * gain * (1 + random.normal(0.0, 0.002)) + random.normal(0.0, 0.002 * true.max())
            read = read * (1 + random.normal(0.0, 0.01, true.size))
            if keep.sum() < 8:
                continue
            found.append(
                Log(
                    f"F{unit + 1}",
                    age,
                    {
                        "speed [rpm]": (grid[0] / drive.radius * 30 / np.pi)[keep],
                        "temperature [degC]": (grid[1] - ZERO + random.normal(0.0, 0.3))[keep],
                        "torque [N*m]": read[keep],
                        "torque error [N*m]": 0.01 * np.abs(read[keep]),
                    },
                )
            )
    return found, stop


def machine_file(world: World, scale: float) -> str:
    """What the engineer states of the machine; ``scale`` pages are the life aimed at."""
    d, u, limits = world.drive, world.duty, world.limits
    cycles = 2e6
    amplitude = 0.5 * u.ratio * (u.starts * scale * limits["gear"] / cycles) ** (1 / u.slope)
    return f"""
[drivetrain]
stiffness = "{d.stiffness:.9g} N/m"
mass = "{d.mass:.9g} kg"
roll_radius = "{d.radius:.9g} m"
stick_speed = "{d.stick:.9g} m/s"
stick_speed_temperature = "{u.hot - ZERO:.9g} degC"
stick_speed_rule = "fixed"

[limits]
motor_torque = "{limits["cold"]:.9g} N*m"
roll_friction = {limits["grip"] / d.load:.9g}
nip_load = "{d.load:.9g} N"
speed = "{u.fast:.9g} m/s"

[life]
coldest = "{u.cold - ZERO:.9g} degC"
travel = "{u.travel:.9g} m"
energy = "{limits["energy"]:.9g} J"
continuous_torque = "{limits["continuous"]:.9g} N*m"

[gear]
torque = "{amplitude:.9g} N*m"
cycles = {cycles:.9g}
slope = {u.slope:.9g}
ratio = {u.ratio:.9g}
starts = "{1000 * u.starts:.9g} per 1000 pages"
cold_starts = "{100 * u.cold_starts:.9g} %"

[contact]
rubber_thickness = "{d.rubber:.9g} m"
modulus = "{d.modulus:.9g} Pa"
poisson_ratio = {d.poisson:.9g}
length = "{d.length:.9g} m"
roughness = "{d.roughness:.9g} m"

[lubricant]
name = "oil"
{world.oil}
uncertainty = "15 %"

[[points]]
name = "full speed"
speed = "{u.fast:.9g} m/s"
temperature = "{u.hot - ZERO:.9g} degC"
share = "{100 * u.share:.9g} %"

[[points]]
name = "thick paper"
speed = "{u.slow:.9g} m/s"
temperature = "{u.hot - ZERO:.9g} degC"
share = "{100 * (1 - u.share):.9g} %"
"""


class _NoFit:
    """A run needs a fit to be added quickly; what is judged here does not ask for it."""

    def to_dict(self) -> dict[str, object]:
        return {"transition": None, "coefficients": {"c": {"value": -0.6}}}


def campaign_of(logs: list[Log], scale: float, folder: Path) -> Campaign:
    """The file of a campaign with all logs, ages in pages."""
    from hersey.damping.dwells import SteadyPoints
    from hersey.life.age import Age
    from hersey.life.campaign import Campaign
    from hersey.life.campaign.conversion import entry_of

    campaign = Campaign.create(folder / "life.hersey")
    rows = []
    for i, log in enumerate(logs):
        entry = entry_of(SteadyPoints.from_table(log.columns), folder / f"{i}.csv", fit=_NoFit())  # type: ignore[arg-type]
        rows.append((entry, log.unit, Age(log.age * scale, "pages")))
    campaign.add_entries(rows)
    return campaign


# --- the judgement ---------------------------------------------------------------------------------------

#: A second end so much later than the first leaves no doubt; one nearer is to be named with it.
CLEAR = 1.15
#: What a test of so many times its length may be asked: ends beyond are not judged by their age.
NEAR = 3.0


def way_of(name: str, point: str = "thick paper") -> str | None:
    """The way of this file that an indicator of hersey is; None where it is another (or another point)."""
    for word, corner in (("cold and fast", "cold"), ("hot and slow", "hot")):
        if "motor torque" in name and word in name:
            return corner
    if "stick-slip" in name:
        return None if point not in name else "fold" if "rest" in name or "fold" in name else "stick"
    if "grip" in name:
        return None if "rest" in name else "grip"
    words = {"starvation": "starve", "gear": "gear", "continuous": "continuous", "energy": "energy"}
    return next((way for word, way in words.items() if word in name), None)


@dataclass(frozen=True)
class Told:
    """An age told: truth, ends of the interval, median, over the age at which the unit was last seen."""

    way: str
    true: float
    low: float
    middle: float
    high: float


@dataclass(frozen=True)
class First:
    """What ends a unit first: in truth with the two first ages, and as named."""

    way: str
    second: str
    ratio: float
    named: tuple[str, ...]
    far: bool  #: beyond `NEAR` times the age last seen


@dataclass(frozen=True)
class Outcome:
    """What one campaign tells."""

    seed: int
    aim: str
    ages: tuple[Told, ...]
    firsts: tuple[First, ...]
    first_ages: tuple[Told, ...]
    shares: tuple[Told, ...]  #: B10 and B50 of the first of all ends
    not_judged: tuple[str, ...]  #: failure modes, with the reason
    seconds: float
    wrong: str = ""


def campaign(seed: int, folder: Path) -> Outcome:
    """Draw a campaign, ask hersey what ends its units, and set it beside the truth."""
    from hersey.life.film.through_life import film_life
    from hersey.life.indicator import NOT_JUDGED
    from hersey.life.indicators.of_campaign import indicators_of
    from hersey.life.time_to_failure.estimate import time_to_failure
    from hersey.machine.machine import read_machine

    world, random = draw(seed), np.random.default_rng([seed, 77])
    logs, stop = logs_of(world, random)
    scale = 10 ** random.uniform(3, 6)
    (folder / "machine.toml").write_text(machine_file(world, scale))
    machine, kept = read_machine(folder / "machine.toml"), campaign_of(logs, scale, folder)
    begin = time.process_time()
    found = indicators_of(kept, machine)
    found = film_life(kept, machine).with_starvation(found)
    told = time_to_failure(found)
    seconds = time.process_time() - begin
    last = {name: max(log.age for log in logs if log.unit == name) for name in {log.unit for log in logs}}

    def aged(way: str, true: float, unit: object, by: float) -> Told:
        age = unit.age  # type: ignore[attr-defined]
        return Told(way, true / by, *(each / scale / by for each in (age.low, age.value, age.high)))

    ages = [
        aged(way, world.ages[way][int(each.unit[1:]) - 1], each, last[each.unit])
        for mode in told.modes
        if (way := way_of(mode.name)) is not None
        for each in mode.ages.units
    ]
    all_ages = np.min([world.ages[name] for name in AIMS], axis=0)
    firsts, first_ages = [], []
    for end in told.units:
        own = int(end.unit[1:]) - 1
        order = sorted(AIMS, key=lambda name: world.ages[name][own])
        one, two = (float(world.ages[name][own]) for name in order[:2])
        named = tuple(way_of(name) or name for name in end.named)
        far = one > NEAR * last[end.unit]
        firsts.append(First(order[0], order[1], two / max(one, 1e-9), named, far))
        first_ages.append(aged("first", one, end.age, last[end.unit]))
    population = np.delete(all_ages, MEDIAN)
    b10, b50 = np.quantile(population, [0.1, 0.5], method="inverted_cdf")
    shares = [aged("B10", b10, told.b10, stop), aged("B50", b50, told.b50, stop)]
    lists = (tuple(each) for each in (ages, firsts, first_ages, shares))
    not_judged = tuple(str(each) for each in told.warnings if each.kind == NOT_JUDGED)
    return Outcome(seed, world.aim, *lists, not_judged, seconds)


def _held(ages: list[Told]) -> list[str]:
    """Cells: how many, held, truth below, above, median width."""
    if not ages:
        return ["0", "", "", "", ""]
    true, low, high = (np.array([getattr(each, name) for each in ages]) for name in ("true", "low", "high"))
    inside = (low <= true) & (true <= high)
    with np.errstate(invalid="ignore"):
        width = np.median(np.where(np.isfinite(high), (high - low) / np.maximum(true, 1e-9), np.inf))
    return [
        str(len(ages)),
        f"{inside.mean():.0%}",
        f"{(true < low).mean():.0%}",
        f"{(true > high).mean():.0%}",
        f"{width:.2f}",
    ]


def table(outcomes: list[Outcome]) -> list[str]:
    """Return the lines of the tables: ages held by way, and which end is named first."""
    good = [each for each in outcomes if not each.wrong]
    ages = [age for each in good for age in each.ages]
    lines = [
        "| age of | intervals | hold the truth | truth below | truth above | width over age, median |",
        "|" + "---|" * 6,
    ]
    near = [age for age in ages if age.true <= NEAR]
    groups = {"torque limit (cold or hot corner)": ("cold", "hot")} | {way: (way,) for way in (*AIMS, "fold")}
    for name, ways in groups.items():
        lines.append("| " + " | ".join([name, *_held([age for age in near if age.way in ways])]) + " |")
    lines.append(
        "| first of all | "
        + " | ".join(_held([age for each in good for age in each.first_ages if age.true <= NEAR]))
        + " |"
    )
    for name in ("B10", "B50"):
        lines.append(
            f"| {name} | "
            + " | ".join(_held([age for each in good for age in each.shares if age.way == name]))
            + " |"
        )
    lines += [
        "",
        "| truly first | units | clear | named first | named at all | near | both named | sure, but wrong |",
        "|" + "---|" * 8,
    ]
    firsts = [first for each in good for first in each.firsts if not first.far]
    for way in (*AIMS, "all"):
        own = [first for first in firsts if way in (first.way, "all")]
        if not own:
            continue
        clear, both = [f for f in own if f.ratio > CLEAR], [f for f in own if f.ratio <= CLEAR]
        right = [f.named[:1] == (f.way,) for f in clear]
        among = [f.way in f.named for f in clear]
        two = [f.way in f.named and f.second in f.named for f in both]
        sure = [len(f.named) == 1 and f.named != (f.way,) for f in own]
        cells = [
            way,
            len(own),
            len(clear),
            _share(right),
            _share(among),
            len(both),
            _share(two),
            _share(sure),
        ]
        lines.append("| " + " | ".join(map(str, cells)) + " |")
    return lines


def _share(values: list[bool]) -> str:
    return f"{np.mean(values):.0%}" if values else ""


def _tried_campaign(seed: int) -> Outcome:
    with tempfile.TemporaryDirectory() as folder:
        try:
            return campaign(seed, Path(folder))
        except Exception as error:  # a fault is told, and does not end the others
            return Outcome(
                seed, AIMS[seed % len(AIMS)], (), (), (), (), (), 0.0, f"{type(error).__name__}: {error}"
            )


def main() -> None:
    """Run the campaigns and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--campaigns", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1001, help="first seed")
    takes_workers(parser)
    given = parser.parse_args()
    seeds = range(given.seed, given.seed + given.campaigns)
    outcomes: list[Outcome] = []
    for each in worked(_tried_campaign, seeds, given):
        outcomes.append(each)
        print(
            f"{len(outcomes)} of {given.campaigns}: seed {each.seed}, {each.seconds:.0f} s {each.wrong}",
            file=sys.stderr,
            flush=True,
        )
    print("\n".join(table(outcomes)))
    seconds = np.array([each.seconds for each in outcomes])
    print(f"\nprocessor: {np.median(seconds):.1f} s in the median, {seconds.max():.1f} s at the most")
    for each in outcomes:
        if each.wrong:
            print(f"seed {each.seed}: {each.wrong}")


if __name__ == "__main__":
    main()
