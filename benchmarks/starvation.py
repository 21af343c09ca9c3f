"""Whether the film over flooded is told rightly where the truth is not the law that is fitted.

The generator stands in this file and shares no code with the fitter, nor with the test stand: Walther's
viscosity (ASTM D341), the soft line film of Herrebrugh, shear and a rolling part of another power, and a
contact that fades as an exponential of film over roughness. Roughness, boundary friction, the rest of the
drive and viscosity differ from run to run; dwells scatter by 1 % of the whole torque. Varied are the
sharpness of starvation, and viscosity against that of the machine file.

Usage: python -m benchmarks.starvation [--runs 96]
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.life.film.filled_dwells import FilledDwells
from hersey.life.film.layer import layers
from hersey.machine.machine import read_machine

MACHINE = Path(__file__).parents[1] / "examples" / "machine.toml"
#: Roll, nip and drive: radius, length, width (m), load (N), modulus (Pa), Poisson's ratio, roughness (m),
#: friction.
RADIUS, LENGTH, WIDTH, LOAD, MODULUS, POISSON, ROUGHNESS, FRICTION = (
    0.015,
    0.22,
    6.5e-3,
    300.0,
    0.65e6,
    0.48,
    5e-7,
    0.05,
)
#: The no-load torque: N m, N m s/rad.
REST = (0.18, 1e-3)
#: Speeds (rpm) up and down again, and temperatures (K).
SPEEDS, HEATS = (5, 7, 10, 14, 20, 30, 45, 65, 95, 140), (333.15, 363.15, 393.15, 423.15, 453.15)
#: Speed (rad/s) and temperature (K) at which the film is asked for.
COLD = (0.2 / RADIUS, 333.15)


def viscosity(kelvin: FloatArray) -> FloatArray:
    """Pa s, through 500 and 7.2 mm^2/s at 40 and 200 degC at 1900 kg/m^3."""
    first, second = (np.log10(np.log10(value + 0.7)) for value in (500.0, 7.2))
    cold, hot = np.log10([313.15, 473.15])
    line = first + (second - first) * (np.log10(kelvin) - cold) / (hot - cold)
    return np.asarray(1900e-6 * (10.0**10.0**line - 0.7))


def flooded_film(product: FloatArray) -> FloatArray:
    """Film (m) at viscosity times belt speed, Pa m."""
    modulus = 2.0 * MODULUS / (1.0 - POISSON**2)
    speed, load = product / 2.0 / (modulus * RADIUS), LOAD / LENGTH / (modulus * RADIUS)
    return np.asarray(2.6 * RADIUS * speed**0.6 * load**-0.2)


def contact_torque(
    product: FloatArray, layer: float, sharpness: float, rough: float, hard: float
) -> FloatArray:
    """Torque of film and contact, N m, with a layer in m and factors on roughness and friction."""
    full = flooded_film(product)
    film = layer / (1.0 + (layer / full) ** sharpness) ** (1.0 / sharpness)
    shear = 1.03 * product / film * WIDTH * LENGTH * RADIUS
    rolling = 0.24 * product / full * WIDTH * LENGTH * RADIUS * (full / 2e-5) ** 0.6 * (film / full) ** 3
    touch = 0.6 * np.exp(-((film / (1.1 * rough * ROUGHNESS)) ** 1.5))
    return np.asarray(shear * (1.0 - touch) + rolling + 0.5 * touch * hard * FRICTION * LOAD * RADIUS)


def campaign(
    runs: int, sharpness: float, thicker: float, seed: int, *, starves: bool = True
) -> tuple[FilledDwells, FloatArray]:
    """Return runs, and ln of their layer over the flooded film at the cold corner."""
    random = np.random.default_rng(seed)
    steps = np.array([*SPEEDS, *SPEEDS[-2::-1]]) * 2.0 * np.pi / 60.0
    speed, kelvin = np.tile(steps, len(HEATS)), np.repeat(HEATS, steps.size)
    truth, torque, error = np.empty(runs), [], []
    for k in range(runs):
        factor = thicker * np.exp(random.uniform(0.0, 0.9))
        layer = np.exp(random.uniform(np.log(4e-6), np.log(3e-5))) if starves else 1.0
        rough, hard = np.exp(random.uniform(0.0, 0.8)), random.uniform(1.0, 1.3)
        more = random.uniform(0.0, 0.25, 2) * REST
        product = factor * viscosity(kelvin) * speed * RADIUS
        own = contact_torque(product, layer, sharpness, rough, hard) + more[0] + more[1] * speed
        error.append(0.01 * (own + REST[0] + REST[1] * speed))
        torque.append(own + error[-1] * random.standard_normal(own.size))
        there = factor * viscosity(np.array(COLD[1])) * COLD[0] * RADIUS
        truth[k] = np.log(layer / flooded_film(there))
    shape = (runs, speed.size)
    given: BoolArray = np.array(error) < 0.01
    every = (np.broadcast_to(speed, shape), np.broadcast_to(kelvin, shape))
    return FilledDwells(*every, np.array(torque), np.array(error), given), truth


def main() -> None:
    """Print a row for each truth."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=96)
    runs = parser.parse_args().runs
    machine = read_machine(MACHINE)
    print("sharpness, viscosity over the file's: 90 % intervals that hold the truth, bias, wrongly starved")
    for sharpness in (3.0, 2.0, 5.0):
        for thicker in (1.0, 0.8, 1.2):
            seed = int(10 * sharpness + 100 * thicker)
            dwells, truth = campaign(runs, sharpness, thicker, seed)
            best, low, high = layers(dwells, machine, speed=COLD[0], kelvin=COLD[1]).interval()
            held, wrong = np.mean((low <= truth) & (truth <= high)), np.sum((high < 0.0) & (truth > 0.0))
            dwells, _ = campaign(runs, sharpness, thicker, seed + 1, starves=False)
            flooded = layers(dwells, machine, speed=COLD[0], kelvin=COLD[1]).interval()[2]
            print(
                f"{sharpness:g}, {thicker:g}: {held:.0%}, {np.median(best - truth):+.2f}, "
                f"{wrong + np.sum(flooded < 0.0)} of {np.sum(truth > 0.0) + runs}",
                flush=True,
            )


if __name__ == "__main__":
    main()
