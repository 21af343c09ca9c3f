"""Write the synthetic trace of stick-slip that ships as stick-slip.csv, from its seed.

It is of a rig of its own, light and soft: the drive of machine.toml swings nearly free between short
stops, and a record of that tells little but its period.

Usage: python examples/stick_slip_trace.py [FILE]
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import hersey

TRUTH = {
    "stiffness": 2000.0,
    "mass": 0.5,
    "transition_force": 1.0,
    "transition_speed": 0.02,
    "ehl_exponent": -0.7,
    "mixed_exponent": -1.2,
    "stick_speed": 2e-4,
}
CLOSURE, DRIVE_SPEED = "retained", 0.02
SEED, RATE, FIRST, DURATION = 5, 500, 1.0, 14.0
NOISE, DRIFT = 0.01, 5e-4


def trace() -> str:
    """Return the trace as CSV: the motion, white noise, a slow drift of the zero, and what it was made of."""
    drag = hersey.Drag(**{name: TRUTH[name] for name in list(TRUTH)[2:]}, closure=CLOSURE)
    train = hersey.Drivetrain(TRUTH["stiffness"], TRUTH["mass"])
    samples = int(RATE * (FIRST + DURATION)) + 1
    run = hersey.simulate(train, drag, drive_speed=DRIVE_SPEED, duration=FIRST + DURATION, samples=samples)
    kept = run.time >= FIRST
    time = run.time[kept] - FIRST
    noise = np.random.default_rng(SEED).normal(0.0, NOISE, time.size)
    force = run.spring_force[kept] + noise + DRIFT * time
    truth = ", ".join(f"{name} {value:g}" for name, value in TRUTH.items())
    head = [
        f"# SYNTHETIC: simulated (SI: {truth}; closure {CLOSURE}; drive {DRIVE_SPEED:g}),",
        f"# noise {NOISE:g} N, drift {DRIFT:g} N/s, seed {SEED}; written by examples/stick_slip_trace.py",
        "time [s],force [N]",
    ]
    rows = [f"{t:.3f},{f:.4f}" for t, f in zip(time.tolist(), force.tolist(), strict=True)]
    return "\n".join([*head, *rows, ""])


if __name__ == "__main__":
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_name("stick-slip.csv")
    path.write_text(trace())
    print(f"{path}: {path.stat().st_size / 1e3:.0f} kB")
