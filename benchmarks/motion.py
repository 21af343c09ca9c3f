"""The motion core beside general tools: workloads W1 and W2, single thread, one run.

Run alone, it writes MOTION.md, with slower peers than those of the table of all ratios.

W1: one trajectory of the paper's baseline, 20 s. W2: 10,000 random parameter sets, 10 s each; wanted are
frequency, greatest speed and stuck fraction of the last lap. Slow peers run a part of W2, scaled to all.

Usage: python -m benchmarks.motion
"""

from __future__ import annotations

import platform
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import hersey
from benchmarks.lines import Line, in_turn, timed

SETS, DURATION = 10_000, 10.0
#: Sets of W2 that a peer runs for the table of all ratios, where it runs many times.
FEW = 2000
EXACT = 3.940313951318513  # independent solution at 1e-12
TRAIN = hersey.Drivetrain(1000, 1)
DRAG = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)


def best_of(repeats: int, run: Callable[[], Any]) -> tuple[float, Any]:
    """Return the shortest time of several and the last result."""
    best = np.inf
    for _ in range(repeats):
        begin = time.perf_counter()
        result = run()
        best = min(best, time.perf_counter() - begin)
    return best, result


def sets() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return stiffness, B0 and drive speed of W2."""
    random = np.random.default_rng(2015)
    limits = ((500, 2000), (25, 100), (0.4, 1.6))
    k, b0, v2 = (random.uniform(*pair, SETS) for pair in limits)
    return k, b0, v2


def swept(duration: float | None, tolerance: float) -> Any:
    """Return hersey's W2."""
    k, b0, v2 = sets()
    return hersey.sweep(
        TRAIN,
        DRAG,
        stiffness=k,
        transition_force=b0,
        drive_speed=v2,
        zip=True,
        duration=duration,
        work=hersey.Work(tolerance=tolerance),
    )


def single(tolerance: float, samples: int = 20_000) -> hersey.Trajectory:
    """Return hersey's W1."""
    return hersey.simulate(TRAIN, DRAG, drive_speed=1.0, duration=20.0, samples=samples, tolerance=tolerance)


def single_error(run: hersey.Trajectory) -> float:
    """Return the relative error of the frequency of W1."""
    return abs(frequency_of(run) / EXACT - 1)


def frequency_of(run: hersey.Trajectory) -> float:
    """Return the frequency between the last two releases."""
    releases = [e.time for e in run.events if e.from_mode == "stuck"]
    return 1 / (releases[-1] - releases[-2])


def measure(quick: bool = False) -> list[dict[str, Any]]:
    """Return one row per tool and tolerance: times in s, relative errors, sets run."""
    few = 10 if quick else 1
    k, b0, v2 = sets()
    exact = swept(None, 1e-13).frequency.values

    def error(found: np.ndarray) -> float:
        return float(np.max(np.abs(found / exact[: found.size] - 1)))

    rows = []

    def row(tool: str, w1: tuple[float, float], w2: tuple[float, float, int]) -> None:
        rows.append(
            {"tool": tool, "w1": w1[0], "w1_error": w1[1], "w2": w2[0], "w2_error": w2[1], "sets": w2[2]}
        )

    def w1(tolerance: float) -> tuple[float, float]:
        seconds, trajectory = best_of(100, lambda: single(tolerance))
        return seconds, single_error(trajectory)

    def w2(duration: float | None, tolerance: float) -> tuple[float, float, int]:
        seconds, grid = best_of(5, lambda: swept(duration, tolerance))
        return seconds, error(grid.frequency.values), SETS

    row("hersey, every lap (W1 at 1e-6 with 20,000 samples; W2 at 7e-8)", w1(1e-6), w2(DURATION, 7e-8))
    row("hersey, every lap (1e-9)", w1(1e-9), w2(DURATION, 1e-9))
    row("hersey, lap reuse (7e-8)", (np.nan, np.nan), w2(None, 7e-8))

    from benchmarks.peers import numba_dp45

    numba_dp45.laps(k[:1], b0[:1], v2[:1], DURATION, 1e-6)  # compile
    for tolerance, count in ((1e-6, SETS // few), (1e-8, 3000 // few)):
        one = best_of(20, lambda t=tolerance: numba_dp45.lap(1000.0, 50.0, 1.0, 20.0, t))
        part = [x[:count] for x in (k, b0, v2)]
        many = best_of(1, lambda t=tolerance, p=part: numba_dp45.laps(*p, DURATION, t))
        row(
            f"numba, hand-written DP45 with located events ({tolerance:.0e})",
            (one[0], abs(one[1][0] / EXACT - 1)),
            (many[0] * SETS / count, error(many[1][:, 0]), count),
        )
        if tolerance == 1e-6:
            steps = float(many[1][:, 3].sum()) * SETS / count
    from benchmarks.peers.heyoka_events import Belt

    belt = Belt(1e-9)
    one = best_of(10, lambda: belt.lap(1000.0, 50.0, 1.0, 20.0))
    count = 300 // few
    many = best_of(1, lambda: belt.laps(k[:count], b0[:count], v2[:count], DURATION))
    row(
        "heyoka scalar, one integrator per mode (1e-9)",
        (one[0], abs(one[1][0] / EXACT - 1)),
        (many[0] * SETS / count, error(many[1][:, 0]), count),
    )
    from benchmarks.peers import scipy_events

    for method, tolerance in (("RK45", 1e-6), ("DOP853", 1e-8)):
        one = best_of(2, lambda m=method, t=tolerance: scipy_events.lap(1000.0, 50.0, 1.0, 20.0, m, t))
        count = 20 // few
        many = best_of(
            1,
            lambda m=method, t=tolerance, n=count: [
                scipy_events.lap(k[i], b0[i], v2[i], DURATION, m, t)[0] for i in range(n)
            ],
        )
        row(
            f"scipy {method} with events ({tolerance:.0e})",
            (one[0], abs(one[1][0] / EXACT - 1)),
            (many[0] * SETS / count, error(np.array(many[1])), count),
        )
    numba_dp45.power_cost(10)
    power = best_of(3, lambda: numba_dp45.power_cost(1_000_000))[0] / 1e6
    floor = steps * numba_dp45.STAGES * power
    rows.append(
        {
            "tool": f"floor of DP45 (1e-6): {steps * numba_dp45.STAGES:.2e} powers of {power * 1e9:.0f} ns",
            "w1": np.nan,
            "w1_error": np.nan,
            "w2": floor,
            "w2_error": np.nan,
            "sets": SETS,
        }
    )
    check = [
        abs(scipy_events.lap(k[i], b0[i], v2[i], 5.0, "DOP853", 1e-12)[0] / exact[i] - 1) for i in (0, 1)
    ]
    print(f"reference (hersey at 1e-13) against scipy DOP853 at 1e-12 on two sets: {max(check):.1e}")
    return rows


def lines(runs: int) -> list[Line]:
    """Return W1 and W2 beside numba."""
    from benchmarks.peers import numba_dp45

    few = [each[:FEW] for each in sets()]
    numba_dp45.laps(*(each[:1] for each in few), DURATION, 1e-6)  # compile
    one = in_turn(
        {
            "sampled": lambda: timed(lambda: single(1e-6), 20),
            "bare": lambda: timed(lambda: single(1e-8, 2), 20),
            "numba": lambda: timed(lambda: numba_dp45.lap(1000.0, 50.0, 1.0, 20.0, 1e-6), 20),
        },
        runs,
    )
    many = in_turn(
        {
            "every": lambda: timed(lambda: swept(DURATION, 7e-8)),
            "reuse": lambda: timed(lambda: swept(None, 7e-8)),
            "numba": lambda: timed(lambda: numba_dp45.laps(*few, DURATION, 1e-6)) * SETS / FEW,
        },
        runs,
    )
    exact = swept(None, 1e-13).frequency.values
    every, reuse = (np.max(np.abs(swept(t, 7e-8).frequency.values / exact - 1)) for t in (DURATION, None))
    numba = "numba, 1e-6"
    errors = [f"{single_error(single(1e-6)):.0e}", f"{single_error(single(1e-8, 2)):.0e}"]
    scaled = f"{numba}, {FEW:,} sets scaled"
    return [
        Line("W1, 20 s, 20,000 samples, 1e-6", one["sampled"], numba, one["numba"], 4, beside=errors[0]),
        Line("W1 without samples, 1e-8", one["bare"], numba, one["numba"], 5, beside=errors[1]),
        Line("W2, every lap", many["every"], scaled, many["numba"], 20, beside=f"{every:.0e}"),
        Line("W2, lap reuse", many["reuse"], scaled, many["numba"], 150, beside=f"{reuse:.0e}"),
    ]


def table(rows: list[dict[str, Any]]) -> str:
    """Return the rows as Markdown, with ratios to hersey's row that simulates every lap."""
    ours = rows[0]
    lines = [
        "| tool (tolerance) | W1 | to hersey | W1 error | W2 [sets run] | to hersey | W2 error |",
        "|---|---|---|---|---|---|---|",
    ]

    def cell(value: float, form: str) -> str:
        return "-" if np.isnan(value) else form.format(value)

    for r in rows:
        lines.append(
            f"| {r['tool']} | {cell(r['w1'] * 1e3, '{:.2f} ms')} | {cell(r['w1'] / ours['w1'], '{:.2f}')} "
            f"| {cell(r['w1_error'], '{:.0e}')} | {cell(r['w2'], '{:.3g} s')} [{r['sets']}] "
            f"| {cell(r['w2'] / ours['w2'], '{:.3g}')} | {cell(r['w2_error'], '{:.0e}')} |"
        )
    return "\n".join(lines)


def machine() -> str:
    """Return the processor and its vector registers."""
    text = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
    model = next((line.split(":")[1].strip() for line in text.splitlines() if "model name" in line), "")
    simd = "AVX-512" if "avx512f" in text else "AVX2" if "avx2" in text else "no AVX2"
    return f"{model or platform.processor()}, {simd}"


if __name__ == "__main__":
    measured = table(measure())
    content = f"""# The motion core beside general tools

{machine()}; single thread; compilation and imports excluded; best of several.
`python -m benchmarks.motion`.

W1: one trajectory of the paper's baseline, 20 s. W2: {SETS:,} parameter sets (k 500 to 2000,
B0 25 to 100, drive speed 0.4 to 1.6), {DURATION:g} s each. Errors are the largest relative ones of the
steady frequency. "Lap reuse" stops once the orbit has closed: an algorithmic gain, with the same results.
The floor is what the powers alone would cost a Dormand-Prince run.

{measured}
"""
    print(content)
    Path(__file__).with_name("MOTION.md").write_text(content)
