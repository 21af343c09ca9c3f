"""Whether a drift is read rightly: single ageings, none, and several at once, over virtual campaigns.

Two sources. The test stand of hersey ages its own drive (`hersey.testbench`). The other is written here from
physics alone and shares no code with stand or fitter: oil after Vogel, a film as the product of viscosity and
speed to an exponent of its own, starved by a layer as 1/h = (1/h_f^2 + 1/h_s^2)^(1/2), summits in contact as
1/(1 + lambda^2)^2, a rest that falls with temperature, and runs whose torque sensor, zero and thermometer
scatter. Its units, plans and sizes are drawn. A reading is right if it names the ageing that there is, and
no other; what it says cannot be told apart counts as right if the truth is among it, and is told besides.

Usage: python -m benchmarks.drift [--campaigns 100] [--first 1] [--source stand|other] [--large 10000]
"""

from __future__ import annotations

import argparse
import os
import resource
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

#: What ages in each kind of campaign, by the names of `hersey.life.drift.readings`.
AGEINGS = {
    "nothing": (),
    "lubricant": ("lubricant",),
    "film": ("film",),
    "roughness": ("contact",),
    "boundary friction": ("contact",),
    "no-load torque": ("no-load torque",),
}
#: Of the other source alone.
BESIDE = {
    "load": ("load or grip",),
    "film and rest": ("film", "no-load torque"),
    "lubricant and wear": ("lubricant", "contact"),
}


@dataclass(frozen=True)
class Drive:
    """A drive of the other source at one age: torque over speed (rad/s) and temperature (degC)."""

    oil: float  #: factor on viscosity
    layer: float  #: of oil, in films of the middle
    rough: float  #: in films of the middle
    friction: float  #: of summits, N m where they carry all
    shear: float  #: of the film, N m in the middle
    rest: float  #: N m at 100 degC
    exponent: float
    vogel: float  #: K

    def torque(self, speed: np.ndarray, temperature: np.ndarray) -> np.ndarray:
        """Return the torque in N m."""
        kelvin = temperature + 273.15
        thick = np.exp(self.vogel / (kelvin - 190.0) - self.vogel / (373.15 - 190.0))
        product = self.oil * thick * speed / 5.0
        flooded = product**self.exponent
        film = (flooded**-2.0 + self.layer**-2.0) ** -0.5
        touching = (1.0 + (film / self.rough) ** 2) ** -2.0
        rest = self.rest * (1.0 - 2e-4 * (temperature - 100.0)) * (1.0 + 0.004 * speed)
        return np.asarray(rest + self.shear * product / film + self.friction * touching)


def other(kind: str, seed: int, units: int = 8, logs: int = 6) -> list[tuple[str, float, np.ndarray]]:
    """Return runs of the other source: unit, age in hours, and rows of speed, degC, torque and its error."""
    random = np.random.default_rng([seed, sorted({**AGEINGS, **BESIDE}).index(kind)])
    speeds = np.geomspace(random.uniform(0.4, 0.8), random.uniform(12.0, 20.0), int(random.integers(6, 10)))
    levels = np.linspace(random.uniform(40.0, 70.0), random.uniform(150.0, 185.0), int(random.integers(4, 7)))
    speed, level = (each.ravel() for each in np.meshgrid(speeds, levels))
    repeat = random.uniform(0.004, 0.012)
    sizes = {"lubricant": 0.0, "film": 0.0, "roughness": 0.0, "boundary": 0.0, "rest": 0.0, "load": 0.0}
    for name in {
        "nothing": (),
        "lubricant": ("lubricant",),
        "film": ("film",),
        "roughness": ("roughness",),
        "boundary friction": ("boundary",),
        "no-load torque": ("rest",),
        "load": ("load",),
        "film and rest": ("film", "rest"),
        "lubricant and wear": ("lubricant", "roughness", "boundary"),
    }[kind]:
        sizes[name] = random.uniform(0.7, 1.4)
    new = Drive(
        oil=1.0,
        layer=random.uniform(3.0, 6.0),
        rough=random.uniform(0.1, 0.16),
        friction=random.uniform(0.15, 0.4),
        shear=random.uniform(0.025, 0.05),
        rest=random.uniform(0.05, 0.2),
        exponent=random.uniform(0.55, 0.65),
        vogel=random.uniform(700.0, 1000.0),
    )
    runs = []
    for u in range(units):
        own = {name: size * np.exp(0.3 * random.standard_normal()) for name, size in sizes.items()}
        first = replace(
            new,
            shear=new.shear * np.exp(0.03 * random.standard_normal()),
            rest=new.rest * np.exp(0.03 * random.standard_normal()),
            rough=new.rough * np.exp(0.03 * random.standard_normal()),
        )
        for age in np.linspace(0.0, 1000.0, logs):
            t = age / 1000.0
            load = 1.0 + 0.4 * own["load"] * t
            drive = replace(
                first,
                oil=np.exp(0.7 * own["lubricant"] * t),
                layer=first.layer / np.sqrt(1.0 + 3.0 * own["film"] * t),
                rough=first.rough * (1.0 + 0.4 * own["roughness"] * t),
                friction=first.friction * (1.0 + 0.5 * own["boundary"] * t) * load,
                shear=first.shear * load,
                rest=first.rest * (1.0 + 0.25 * own["rest"] * t),
            )
            gain, zero, warm = random.standard_normal(3) * (0.003, 0.0005, 0.3)
            true = drive.torque(speed, level + warm)
            shown = zero + true * (1.0 + gain) * (1.0 + repeat * random.standard_normal(true.size))
            runs.append((f"H{u + 1}", float(age), np.stack([speed, level, shown, repeat * true])))
    return runs


def stand(kind: str, seed: int, units: int = 8) -> list[tuple[str, float, np.ndarray]]:
    """Return runs of the test stand: unit, age in pages, and rows of speed, degC, torque and its error."""
    from hersey.testbench import Ageing, population
    from hersey.testbench.campaign import STAND
    from hersey.testbench.drive import example_drive
    from hersey.testbench.truth import RPM

    rates = {
        "side_flow": 0.0,
        "evaporation": 0.0,
        "thickening": 0.0,
        "roughening": 0.0,
        "boundary_growth": 0.0,
        "rest_growth": 0.0,
    }
    rates |= {
        "nothing": {},
        "lubricant": {"thickening": 4.5e-6},
        "film": {"side_flow": 3e4},
        "roughness": {"roughening": 2e-6},
        "boundary friction": {"boundary_growth": 2e-6},
        "no-load torque": {"rest_growth": 1e-6},
    }[kind]
    steps = [*STAND.speeds_rpm, *STAND.speeds_rpm[-2::-1]]
    speed = np.tile(steps, len(STAND.temperatures_degC)) * RPM
    level = np.repeat(STAND.temperatures_degC, len(steps))
    random = np.random.default_rng([seed, 7])
    runs = []
    for unit in population(*example_drive(), ageing=Ageing(**rates), units=units, seed=seed):
        for age in (0.0, 35e3, 70e3, 105e3, 140e3, 170e3):
            true = unit.at(age).torque(speed, level)
            shown = true * (1.0 + STAND.repeatability * random.standard_normal(true.size))
            rows = np.stack([speed, level, shown, STAND.repeatability * true])
            runs.append((unit.name, age, rows[:, true <= 1.0]))
    return runs


def table(runs: list[tuple[str, float, np.ndarray]]):
    """Return the runs as `Campaign.dwells` would."""
    import polars as pl

    counts = [rows.shape[1] for _, _, rows in runs]
    speed, level, torque, error = np.concatenate([rows for _, _, rows in runs], axis=1)
    return pl.DataFrame(
        {
            "run_id": np.repeat(np.arange(1, len(runs) + 1), counts),
            "unit": np.repeat([unit for unit, _, _ in runs], counts),
            "age (h)": np.repeat([age for _, age, _ in runs], counts),
            "speed (rad/s)": speed,
            "torque (N m)": torque,
            "torque error (N m)": error,
            "temperature (K)": level + 273.15,
        }
    )


def said(reading: object) -> str:
    """Return a reading as names, those that run backwards with a minus."""
    sets = [
        "+".join(sorted(each.name + "-" * (not each.grows) for each in one)) or "nothing"
        for one in reading.sets  # type: ignore[attr-defined]
    ]
    return " | ".join(sorted(sets))


def judged(source: str, kind: str, seed: int) -> tuple[str, str, tuple[str, ...], float]:
    """Return kind, reading of all, readings of the units, and seconds of one campaign."""
    from hersey import fit_drift

    runs = table((stand if source == "stand" else other)(kind, seed))
    start = time.perf_counter()
    drift = fit_drift(runs)
    return kind, said(drift.reading), tuple(map(said, drift.readings)), time.perf_counter() - start


def verdict(kind: str, words: str) -> str:
    """Return whether a reading is right, right among others, or wrong."""
    truth = "+".join(sorted({**AGEINGS, **BESIDE}[kind])) or "nothing"
    sets = words.split(" | ")
    if sets == [truth]:
        return "right"
    return "among others" if truth in sets else "wrong"


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--campaigns", type=int, default=100)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--source", choices=("stand", "other"), default="stand")
    parser.add_argument("--kinds", default="")
    parser.add_argument("--large", type=int, default=0, help="runs of 24 dwells of one campaign, timed")
    chosen = parser.parse_args()
    if chosen.large:
        large(chosen.large)
        return
    kinds = list(AGEINGS) + list(BESIDE) * (chosen.source == "other")
    kinds = [kind for kind in kinds if not chosen.kinds or kind in chosen.kinds.split(",")]
    seeds = range(chosen.first, chosen.first + chosen.campaigns)
    print("| what ages | right | among others | wrong | units right | among others | nothing told | wrong |")
    print("|---|---|---|---|---|---|---|---|")
    seconds = []
    with ProcessPoolExecutor(max_workers=min(2, os.cpu_count() or 1)) as pool:
        for kind in kinds:
            found = list(pool.map(partial(judged, chosen.source, kind), seeds, chunksize=5))
            all_ = Counter(verdict(kind, words) for _, words, _, _ in found)
            units = Counter(
                "nothing" if each == "nothing" != kind else verdict(kind, each)
                for _, _, every, _ in found
                for each in every
            )
            seconds += [each for *_, each in found]
            shares = [100 * all_[name] / len(found) for name in ("right", "among others", "wrong")]
            total = sum(units.values())
            shares += [100 * units[name] / total for name in ("right", "among others", "nothing", "wrong")]
            print(f"| {kind} | " + " | ".join(f"{share:.0f} %" for share in shares) + " |", flush=True)
            wrong = Counter(words for _, words, _, _ in found if verdict(kind, words) == "wrong")
            for words, count in wrong.most_common(4):
                print(f"    {count} x {words}")
    print(f"\n{np.median(seconds):.2f} s in the median")


def large(runs: int) -> None:
    """Time the fit of a campaign of so many runs of 24 dwells, and the memory it takes."""
    from hersey import fit_drift

    every = other("film and rest", 1, units=-(-runs // 10), logs=10)[:runs]
    chosen = np.random.default_rng(1).permutation(every[0][2].shape[1])[:24]
    dwells = table([(unit, age, rows[:, chosen]) for unit, age, rows in every])
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    start = time.perf_counter()
    drift = fit_drift(dwells)
    seconds = time.perf_counter() - start
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    print(f"{drift.runs} runs, {drift.dwells} dwells, {len(drift.units)} units: {seconds:.1f} s, ", end="")
    print(f"{after - before:.0f} MB more; {drift.headline()}")


if __name__ == "__main__":
    main()
