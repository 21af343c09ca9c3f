"""Write the synthetic log of coast-downs that ships as coast-down.csv, from its seed.

A fan wheel on two bearings is run up twice, held, and let go: the first time it comes to rest, the second
time it is braked on the way.

Usage: python examples/coast_down_log.py [FILE]
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

#: kg m^2, N m, N m s/rad, N m s^2/rad^2.
INERTIA, COULOMB, VISCOUS, WINDAGE = 0.012, 0.008, 2e-4, 4e-6
#: rad/s, s.
TOP, INTERVAL = 150.0, 0.1
#: Noise, rpm; its seed.
NOISE, SEED = 1.5, 7
_RPM = 30.0 / np.pi


def coasted(until: float) -> list[float]:
    """Return the speeds of a coast down to a speed, rad/s, a row each."""
    speeds, speed = [], TOP
    while speed > until:
        speeds.append(speed)
        for _ in range(100):
            torque = COULOMB + VISCOUS * speed + WINDAGE * speed**2
            speed = max(0.0, speed - torque / INERTIA * INTERVAL / 100)
    return speeds


def log() -> str:
    """Return the log as CSV."""
    up, hold, rest = np.linspace(0.0, TOP, 40).tolist(), [TOP] * 50, [0.0] * 40
    second = coasted(60.0)
    brake = np.linspace(second[-1], 0.0, 8).tolist()
    speed = np.array([*rest, *up, *hold, *coasted(0.0), *rest, *up, *hold, *second, *brake, *rest]) * _RPM
    seen = speed + NOISE * np.random.default_rng(SEED).standard_normal(speed.size)
    head = [
        f"# SYNTHETIC: J = {INERTIA:g} kg m^2; T = {COULOMB:g} N m + {VISCOUS:g} N m s w",
        f"# + {WINDAGE:g} N m s^2 w^2, noise {NOISE:g} rpm, seed {SEED};",
        "# written by examples/coast_down_log.py",
        "time [s],speed [rpm]",
    ]
    rows = [f"{INTERVAL * row:.1f},{each:.1f}" for row, each in enumerate(seen.tolist())]
    return "\n".join([*head, *rows, ""])


if __name__ == "__main__":
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_name("coast-down.csv")
    path.write_text(log())
    print(f"{path}: {path.stat().st_size / 1e3:.0f} kB")
