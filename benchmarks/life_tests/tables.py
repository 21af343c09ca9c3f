"""The files of a campaign: a table of means for each run, its list of runs, its machine file, its truth."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.random import Generator

from benchmarks.life_tests import modes
from benchmarks.life_tests.campaign import HORIZON, Campaign, first_failure
from benchmarks.life_tests.drive import (
    FAST,
    LENGTH,
    LOAD,
    MODULUS,
    POISSON,
    RADIUS,
    RUBBER,
    Drive,
)
from benchmarks.life_tests.states import State

HEADER = "speed [rpm],temperature [degC],torque [N*m],torque error [N*m],approach"


def table(campaign: Campaign, drive: Drive, state: State, rng: Generator) -> str:
    """Return a run as a table of means; dwells above the motor's torque are missing."""
    stand = campaign.stand
    ways = [(stand.speeds, "up"), (stand.speeds[-2::-1], "down")][: 1 + stand.down]
    gain = 1 + stand.gain + rng.normal(0, stand.mounting)
    rows = [HEADER]
    for celsius in stand.temperatures:
        for speeds, approach in ways:
            for rpm in speeds:
                torque = float(drive.whole(state, rpm * 2 * np.pi / 60 * RADIUS, celsius + 273.15)[0, 0])
                read = torque * gain * (1 + rng.normal(0, stand.repeatability))
                if torque < campaign.use.motor:
                    error = stand.repeatability * read
                    rows.append(f"{rpm:g},{celsius:g},{read:.5f},{error:.5f},{approach}")
    return "\n".join(rows) + "\n"


def tables(campaign: Campaign) -> dict[tuple[str, int], str]:
    """Return the table of each specimen and age, pages."""
    rng = np.random.default_rng([35, campaign.seed])
    made = {}
    for number, unit in enumerate(campaign.units):
        state = campaign.state(number)
        for column, age in enumerate(campaign.ages[number]):
            one = state.at(slice(None), [column])
            one = replace(one, viscosity=one.viscosity * np.exp(rng.normal(0, campaign.stand.spreading)))
            made[unit, int(age)] = table(campaign, campaign.drive, one, rng)
    return made


def machine_file(campaign: Campaign) -> str:
    """Return the machine file, whose lubricant is that of the data sheet."""
    drive, use, stand = campaign.drive, campaign.use, campaign.stand
    sheet = ", ".join(
        f'["{at} degC", "{drive.sheet * drive.viscosity(at + 273.15):.5g} Pa*s"]' for at in (40, 100, 200)
    )
    constant, per_speed = drive.rest
    life = [f'travel = "{modes.TRAVEL * 1000:g} mm"']
    life += [f'energy = "{use.energy:.6g} J"'] if use.energy else []
    life += [f'continuous_torque = "{use.continuous:.6g} N*m"'] if use.continuous else []
    points = [("full speed", FAST, use.share), ("thick paper", use.slow, 1 - use.share)]
    lines = [
        "# Of an invented machine.",
        "[drivetrain]",
        'part = "belt"',
        'stiffness = "11 N/mm"',
        'mass = "11 kg"',
        f'roll_radius = "{RADIUS * 1000:g} mm"',
        'stick_speed = "3 mm/s"',
        "[limits]",
        f'motor_torque = "{use.motor:.6g} N*m"',
        f'nip_load = "{LOAD:g} N"',
        "[contact]",
        f'rubber_thickness = "{RUBBER * 1000:g} mm"',
        f'modulus = "{MODULUS / 1e6:g} MPa"',
        f"poisson_ratio = {POISSON}",
        f'length = "{LENGTH * 1000:g} mm"',
        f'roughness = "{drive.roughness * 1e6:.3g} um"',
        'nip_uncertainty = "10 %"',
        "[lubricant]",
        'model = "vogel"',
        f"viscosities = [{sheet}]",
        'density = "1.9 g/cm^3"',
        'uncertainty = "20 %"',
        "[asperities]",
        'modulus = "2 GPa"',
        "[boundary]",
        f"friction = {drive.friction:.3g}",
        "[rest]",
        f'torque = "{constant * 1000:.5g} mN*m"',
        f'damping = "{per_speed * 1000:.5g} mN*m*s/rad"',
        "[sensors.torque]",
        f'gain_error = "{stand.stated_gain * 100:g} %"',
        "[life]",
        *life,
    ]
    for name, speed, share in points:
        lines += ["[[points]]", f'name = "{name}"', f'speed = "{speed * 1000:.6g} mm/s"']
        lines += ['temperature = "180 degC"', f'share = "{share * 100:.4g} %"']
    return "\n".join(lines) + "\n"


def truth(campaign: Campaign) -> dict[str, object]:
    """Return what will really happen; null is never, until ``horizon``. Ages in pages."""
    first = first_failure(campaign.failures)
    return {
        "seed": campaign.seed,
        "mechanism": campaign.mechanism.name,
        "lead": campaign.lead,
        "film": campaign.drive.film,
        "rolling share, cold and fast": campaign.drive.rolling,
        "rolling is loss in the rubber": campaign.drive.hysteresis,
        "gain of the torque sensor": campaign.stand.gain,
        "re-greased at": campaign.regreased,
        "horizon": HORIZON * campaign.life,
        "limits": campaign.use.limits(campaign.drive.film != "flooded"),
        "population": {
            "first": _shares(first_failure(campaign.population)),
            **{name: _shares(ages) for name, ages in campaign.population.items()},
        },
        "units": [_unit(campaign, number, first[number]) for number in range(len(campaign.units))],
    }


def _unit(campaign: Campaign, number: int, first: float) -> dict[str, object]:
    ends = {name: _age(ages[number]) for name, ages in campaign.failures.items()}
    order = sorted((age, name) for name, age in ends.items() if age is not None)
    values = modes.indicators(campaign.drive, campaign.use, campaign.state(number))
    return {
        "unit": campaign.units[number],
        "ages": campaign.ages[number].tolist(),
        "ends": ends,
        "first": order[0][1] if order else None,
        "age": _age(first),
        "next mode is later by": order[1][0] / order[0][0] if len(order) > 1 and order[0][0] else None,
        "film over flooded film": modes.film_ratio(campaign.drive, campaign.state(number))[0].tolist(),
        "runs": {name: values[name][0].tolist() for name in campaign.use.limits(True)},
    }


def _shares(ages: np.ndarray) -> dict[str, float | None]:
    return {
        name: _age(np.quantile(ages, share, method="higher")) for name, share in (("B10", 0.1), ("B50", 0.5))
    }


def _age(age: float) -> float | None:
    return round(float(age), 1) if np.isfinite(age) else None


def write(campaign: Campaign, folder: Path) -> None:
    """Write the files of a campaign into a folder."""
    write_runs(tables(campaign), folder)
    (folder / "machine.toml").write_text(machine_file(campaign))
    if campaign.regreased is not None:
        renewed = [f"{unit},{campaign.regreased:.0f} pages" for unit in campaign.units]
        (folder / "maintenance.csv").write_text("\n".join(["unit,age", *renewed]) + "\n")
    (folder / "truth.json").write_text(json.dumps(truth(campaign), indent=1) + "\n")


def write_runs(runs: dict[tuple[str, int], str], folder: Path, *, word: str = "pages") -> None:
    """Write tables of runs and their list."""
    folder.mkdir(parents=True, exist_ok=True)
    listed = ["log,unit,age"]
    for (unit, age), text in runs.items():
        name = f"{unit}-{age}.csv"
        (folder / name).write_text(text)
        listed.append(f"{name},{unit},{age} {word}")
    (folder / "runs.csv").write_text("\n".join(listed) + "\n")
