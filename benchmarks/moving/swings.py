"""Virtual joints that swing, with gravity and without, read as a position or as a speed.

A generator that shares no code with hersey: three sines of the angle, friction, inertia, gravity, an offset,
coloured noise, and an encoder of 12 to 16 bits or a noisy speed.
"""

from __future__ import annotations

import numpy as np
import polars as pl

import hersey
from hersey.errors import HerseyError

#: Rows per second, and length of a log in s.
RATE, LENGTH = 200.0, 60.0


def log_of(seed: int, gravity: bool) -> tuple[dict[str, float], hersey.TorqueLog]:
    """Return the truth and the log of one joint; even ones have Stribeck's rise."""
    rng = np.random.default_rng([7, seed, int(gravity)])
    t = np.arange(0.0, LENGTH, 1.0 / RATE)
    size, hertz = rng.uniform(0.3, 1.6), rng.uniform(0.08, 0.5)
    sizes = size * np.array([1.0, rng.uniform(0.3, 0.8), rng.uniform(0.1, 0.4)]) / np.sqrt([1.0, 2.0, 3.0])
    omega = 2.0 * np.pi * hertz * np.array([1.0, rng.uniform(1.7, 2.6), rng.uniform(3.0, 6.0)])
    phases = np.outer(omega, t) + rng.uniform(0.0, 2.0 * np.pi, 3)[:, None]
    angle, speed = sizes @ np.sin(phases), (sizes * omega) @ np.cos(phases)
    rate = -(sizes * omega**2) @ np.sin(phases)
    fastest = float(np.abs(speed).max())
    truth = {"T_C": float(np.exp(rng.uniform(-1.0, 2.0)))}
    level = truth["T_C"]
    truth |= {
        "k_v": level * rng.uniform(0.3, 1.5) / fastest,
        "J": level * rng.uniform(0.1, 0.8) / float(np.abs(rate).max()),
        "offset": level * rng.normal(0.0, 0.03),
    }
    friction = np.full(t.size, level)
    if seed % 2 == 0:
        truth |= {"T_S": level * rng.uniform(1.3, 1.8), "w_S": fastest * rng.uniform(0.04, 0.1)}
        friction += (truth["T_S"] - level) * np.exp(-((speed / truth["w_S"]) ** 2))
    torque = truth["J"] * rate + np.sign(speed) * friction + truth["k_v"] * speed + truth["offset"]
    if gravity:
        truth["G"] = level * float(np.exp(rng.uniform(np.log(0.2), np.log(5.0))))
        torque += truth["G"] * np.sin(angle - rng.uniform(-3.0, 3.0))
    torque += _noise(rng, level * rng.uniform(0.01, 0.04), t.size)
    columns = {"time (s)": t, "torque (N m)": torque}
    if seed % 4 < 2:
        step = 2.0 * np.pi / 2 ** int(rng.integers(12, 17))
        read = pl.DataFrame(columns | {"position (rad)": np.floor(angle / step) * step})
        return truth, hersey.read(read, channels={"position": "position"}, isothermal=True)
    read = pl.DataFrame(columns | {"speed (rad/s)": speed + rng.normal(0.0, 0.003 * fastest, t.size)})
    return truth, hersey.read(read, isothermal=True)


def _noise(rng: np.random.Generator, size: float, count: int) -> np.ndarray:
    """Noise that forgets within 10 to 100 ms, and white noise of half its size."""
    keep = float(np.exp(-1.0 / (RATE * np.exp(rng.uniform(np.log(0.01), np.log(0.1))))))
    kicks, out = rng.normal(0.0, size * np.sqrt(1.0 - keep**2), count), np.zeros(count)
    for i in range(1, count):
        out[i] = keep * out[i - 1] + kicks[i]
    return out + rng.normal(0.0, 0.5 * size, count)


def lines(count: int) -> list[str]:
    """Return the table of joints with gravity and without."""
    names = ("T_C", "T_S", "w_S", "k_v", "J", "offset", "G")
    out = [
        "## Gravity",
        "",
        "Joints that swing over arcs of 20 to 200 degrees, half of them read as a position of 12 to 16 bits, "
        "half as a speed, whose sum is the angle. Gravity is 0.2 to 5 times the Coulomb friction. The share "
        "of the torque that gravity must make (0.5 %) was chosen while looking at the first 40.",
        "",
        f"| logs | fitted | gravity | no law fits | {' | '.join(f'`{name}`' for name in names)} | all |",
        "|---|---|---|---|" + "---|" * (len(names) + 1),
    ]
    for gravity in (True, False):
        found, misfit, fitted, inside = 0, 0, 0, dict[str, list[bool]]()
        for seed in range(count):
            truth, log = log_of(seed, gravity)
            try:
                fit = log.moving()
            except HerseyError:
                continue
            fitted, found, misfit = fitted + 1, found + ("G" in fit), misfit + (fit.misfit is not None)
            for name, true in truth.items():
                if name in fit:
                    inside.setdefault(name, []).append(fit[name].low <= true <= fit[name].high)
        shares = [f"{100 * np.mean(inside[name]):.0f} %" if name in inside else "" for name in names]
        every = 100 * np.mean([hit for hits in inside.values() for hit in hits])
        what = "with gravity" if gravity else "without"
        cells = [what, f"{fitted} of {count}", str(found), str(misfit), *shares, f"{every:.1f} %"]
        out.append(f"| {' | '.join(cells)} |")
    return [*out, "", "The columns of numbers are the 95 % intervals that hold the truth.", ""]
