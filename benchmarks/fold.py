"""Fold maps beside brute force: workload W3, single thread, one run.

Run alone, it writes FOLD.md, with slower peers than those of the table of all ratios.

W3: the fold speed V*(k, B0) on 64 x 64 points (k 500 to 2000, B0 25 to 100). Peers halve the drive speed
between 1.01 and 4 with 15 runs of 5 s each, on some of the points, scaled to all.

The law of examples/bench.csv on the drive of examples/machine.toml beside it: a steep mixed branch, a rest of
the drive that rises with speed, and the grip of the roll; 200 draws at each of 13 temperatures, and one belt.

Usage: python -m benchmarks.fold
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import hersey
from benchmarks.lines import Line, in_turn, timed
from benchmarks.motion import DRAG, TRAIN, best_of, machine
from hersey import _core
from hersey.motion.parameters import MOST_STEPS

SIDE, RUNS, DURATION = 64, 15, 5.0
#: Points that numba runs, spread over all.
FEW = 100
#: Tolerance at which V* is within 8e-9, which is asked.
ASKED = 3e-9
#: Temperatures (K) and draws of the machine's law.
LEVELS, DRAWS = np.linspace(363.15, 455.15, 13), 200
#: Seconds for the same before half laps knew a no-load torque: all draws (from 5 at each level), one belt.
BEFORE = {1e-13: (15.3, 8.9e-3), 1e-11: (27.0, 6.7e-3), 1e-8: (69.0, 4.8e-3)}


def folds(side: int, tolerance: float, lower: bool = False) -> Any:
    """Return hersey's map of folds."""
    return hersey.hysteresis_sweep(
        TRAIN,
        DRAG,
        stiffness=np.linspace(500, 2000, side),
        transition_force=np.linspace(25, 100, side),
        lower=lower,
        work=hersey.Work(tolerance=tolerance),
    )


def exact_folds() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return stiffness, B0 and V* of every point."""
    exact = folds(SIDE, 1e-13)
    k, b0 = (
        np.broadcast_to(axis, exact.upper.shape).ravel()
        for axis in (exact.stiffness.values[:, None], exact.transition_force.values[None, :])
    )
    return k, b0, exact.upper.values.ravel()


def lines(runs: int) -> list[Line]:
    """Return W3 beside numba."""
    from benchmarks.peers import numba_dp45

    k, b0, reference = exact_folds()
    some = np.linspace(0, k.size - 1, FEW).astype(int)
    numba_dp45.folds(k[:1], b0[:1], 1, DURATION, 1e-6)  # compile
    found = in_turn(
        {
            "upper": lambda: timed(lambda: folds(SIDE, ASKED)),
            "both": lambda: timed(lambda: folds(SIDE, ASKED, lower=True)),
            "numba": lambda: timed(lambda: numba_dp45.folds(k[some], b0[some], RUNS, DURATION, 1e-6)),
        },
        runs,
    )
    error = np.max(np.abs(folds(SIDE, ASKED).upper.values.ravel() / reference - 1))
    work, peer = f"W3, V* of {SIDE} x {SIDE} points", f"numba, 1e-6, {FEW} points scaled"
    numba = found["numba"] * k.size / FEW
    return [
        Line(f"{work}, upper edge", found["upper"], peer, numba, faster=250, beside=f"{error:.0e}"),
        Line(f"{work}, lower edge too", found["both"], peer, numba, limit=0.15),
    ]


def measure() -> list[tuple[str, float, int, float]]:
    """Return (tool, seconds for all points, points run, greatest relative error)."""
    from benchmarks.peers import numba_dp45, scipy_events

    k, b0, reference = exact_folds()
    points = reference.size
    rows = []
    for tolerance in (3e-10, 1e-11):
        seconds, grid = best_of(5, lambda t=tolerance: folds(SIDE, t))
        laps = float(grid.laps.mean())
        error = float(np.max(np.abs(grid.upper.values.ravel() / reference - 1)))
        rows.append((f"hersey ({tolerance:g}), {laps:.1f} laps a fold", seconds, points, error))

    numba_dp45.folds(k[:1], b0[:1], 1, DURATION, 1e-6)  # compile
    for tolerance in (1e-6, 1e-8):
        some = np.linspace(0, points - 1, FEW).astype(int)
        seconds, found = best_of(
            1, lambda t=tolerance, i=some: numba_dp45.folds(k[i], b0[i], RUNS, DURATION, t)
        )
        error = float(np.max(np.abs(found / reference[some] - 1)))
        rows.append(
            (f"numba DP45, {RUNS} runs a fold ({tolerance:g})", seconds / some.size * points, FEW, error)
        )

    def scipy_fold(i: int) -> float:
        low, high = 1.01, 4.0
        for _ in range(RUNS):
            middle = 0.5 * (low + high)
            if scipy_events.lap(k[i], b0[i], middle, DURATION, "RK45", 1e-6)[3] > 0.5 * DURATION:
                low = middle
            else:
                high = middle
        return 0.5 * (low + high)

    some = np.linspace(0, points - 1, 3).astype(int)
    seconds, found = best_of(1, lambda: np.array([scipy_fold(i) for i in some]))
    error = float(np.max(np.abs(found / reference[some] - 1)))
    rows.append(
        (f"scipy RK45 with events, {RUNS} runs a fold (1e-06)", seconds / some.size * points, 3, error)
    )
    seconds, _ = best_of(1, lambda: folds(256, 1e-11))
    rows.append(("hersey, 256 x 256 points (1e-11)", seconds, 256 * 256, np.nan))
    return rows


def machine_law() -> tuple[hersey.Drivetrain, list[tuple[Any, dict[str, Any]]]]:
    """Return the train with the roll's grip, and the law with its draws at each temperature."""
    from hersey.machine import read_machine

    stated = read_machine("examples/machine.toml")
    assert stated.rest is not None
    log = hersey.read("examples/bench.csv").steady(tare="standing").without(stated.rest)
    surface, rng = hersey.fit(log), np.random.default_rng(1)
    train, laws = stated.limits.gripping(stated.train), []
    for level in LEVELS:
        law = surface.drag(**stated.belt, temperature=level)
        draws = surface.drag_samples(
            DRAWS, 1, roll_radius=stated.roll_radius, stick_speed=law.stick_speed, temperature=level
        )
        draws["stick_speed"] = np.minimum(
            law.stick_speed * rng.uniform(0.67, 1.33, DRAWS), 0.9 * draws["transition_speed"]
        )
        stiffness = train.stiffness * rng.uniform(0.9, 1.1, DRAWS)
        laws.append((law, {**draws, "stiffness": stiffness}))
    return train, laws


def measure_machine() -> list[tuple[float, float, float, float]]:
    """Return (tolerance, seconds for all draws, seconds for one belt, greatest relative error)."""
    train, laws = machine_law()

    def all_draws(tolerance: float) -> Any:
        found = [
            hersey.hysteresis_sweep(
                train, law, **draws, zip=True, lower=False, work=hersey.Work(tolerance=tolerance)
            )
            for law, draws in laws
        ]
        return np.concatenate([grid.upper.values for grid in found])

    arguments = train._arguments, laws[6][0].law()
    rows, exact = [], all_draws(1e-14)
    for tolerance in BEFORE:
        seconds, upper = best_of(5, lambda t=tolerance: all_draws(t))
        one, _ = best_of(100, lambda t=tolerance: _core.band(*arguments, True, t, MOST_STEPS))
        rows.append((tolerance, seconds, one, float(np.max(np.abs(upper / exact - 1)))))
    return rows


def machine_table(rows: list[tuple[float, float, float, float]]) -> str:
    """Return the rows of the machine's law as Markdown."""
    lines = [
        "| tolerance | all draws | before | one belt, lower edge too | before | error of V* |",
        "|---|---|---|---|---|---|",
    ]
    for tolerance, seconds, one, error in rows:
        before, one_before = BEFORE[tolerance]
        lines.append(
            f"| {tolerance:g} | {seconds:.3g} s | {before:.3g} s | {1e3 * one:.2g} ms "
            f"| {1e3 * one_before:.2g} ms | {error:.0e} |"
        )
    return "\n".join(lines)


def table(rows: list[tuple[str, float, int, float]]) -> str:
    """Return the rows as Markdown, with ratios to the first."""
    lines = ["| tool (tolerance) | W3 | to hersey | points run | error of V* |", "|---|---|---|---|---|"]
    for tool, seconds, points, error in rows:
        ratio = "-" if points > SIDE * SIDE else f"{seconds / rows[0][1]:.3g}"
        shown = "-" if np.isnan(error) else f"{error:.0e}"
        lines.append(f"| {tool} | {seconds:.3g} s | {ratio} | {points} | {shown} |")
    return "\n".join(lines)


if __name__ == "__main__":
    content = f"""# Fold maps beside brute force

{machine()}; single thread; compilation and imports excluded. `python -m benchmarks.fold`.

W3: the fold V* over stiffness (500 to 2000) and drag at the transition (25 to 100), {SIDE} x {SIDE} points.
hersey's time includes the check whether a deeper stick-slip lasts above each fold.

{table(measure())}

The machine's law: that of examples/bench.csv on the drive of examples/machine.toml, with the rest of the
drive that rises with speed and the grip of the roll. {len(LEVELS)} temperatures, {DRAWS} draws at each: fit,
stiffness and stick speed. Before, a rest that rises with speed sent every belt to simulation.

{machine_table(measure_machine())}
"""
    print(content)
    Path(__file__).with_name("FOLD.md").write_text(content)
