"""The film solver beside SciPy on the same discrete equations, in one run. By itself it writes REYNOLDS.md.

The SciPy version is written the straightforward way: NumPy arrays, influence coefficients built anew for each
outlet, `scipy.optimize.root` with differences for the Jacobian. It starts from the film of a speed 5 %
higher, on the nodes that hersey chose; hersey starts from nothing.

Usage: python -m benchmarks.reynolds
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import root

from benchmarks.lines import Line, in_turn, timed
from benchmarks.motion import best_of, machine
from hersey.lubrication.reynolds import LineContactSolution, solve_line_contact

RADIUS, LOAD, VISCOSITY, MODULUS = 0.015, 1000.0, 0.1, 2e6


def solve(speed: float, nodes: int) -> LineContactSolution:
    """Return hersey's film of an isoviscous half space."""
    return solve_line_contact(RADIUS, LOAD, speed, VISCOSITY, effective_modulus=MODULUS, nodes=nodes)


def by_scipy(speed: float, shares: np.ndarray, inlet: float, guess: LineContactSolution) -> tuple[float, Any]:
    """Return the least film at a node and SciPy's result, nodes at `shares` of the way from `inlet`."""
    a = np.sqrt(8 * LOAD * RADIUS / (np.pi * MODULUS))
    pressure_unit, film_unit = LOAD / a, a * a / RADIUS
    number = 12 * VISCOSITY * speed * RADIUS**2 / (a * a * LOAD)
    compliance = 4 * LOAD * RADIUS / (np.pi * MODULUS * a * a)

    def film(unknowns: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        p = np.concatenate([[0.0], unknowns[:-2], [0.0]])
        x = inlet / a + shares * (unknowns[-2] - inlet / a)
        distance = np.abs(x[:, None] - x[None, :])
        twice = np.where(distance > 0, distance**2 * (0.75 - 0.5 * np.log(np.maximum(distance, 1e-300))), 0)
        slope = np.diff(p) / np.diff(x)
        kinks = np.diff(np.concatenate([[0.0], slope, [0.0]]))
        return x, p, unknowns[-1] + 0.5 * x * x + compliance * twice @ kinks

    def residual(unknowns: np.ndarray) -> np.ndarray:
        x, p, h = film(unknowns)
        middle, step = 0.5 * (x[1:] + x[:-1]), np.diff(x)
        wedge = np.empty_like(middle)
        wedge[0] = 0.5 * (h[0] + h[1])
        b, l, r, m = x[:-2], x[1:-1], x[2:], middle[1:]  # noqa: E741
        parabola = (
            h[:-2] * (m - l) * (m - r) / ((b - l) * (b - r))
            + h[1:-1] * (m - b) * (m - r) / ((l - b) * (l - r))
            + h[2:] * (m - b) * (m - l) / ((r - b) * (r - l))
        )
        line = h[1:-1] + (h[1:-1] - h[:-2]) * (m - l) / (l - b)
        wedge[1:] = 0.5 * (parabola + line)
        flow = wedge - (0.5 * (h[1:] + h[:-1])) ** 3 / number * np.diff(p) / step
        return np.append(flow - h[-1], np.trapezoid(p, x) - 1.0)

    start = np.interp(inlet + shares * (guess.outlet - inlet), guess.x, guess.pressure) / pressure_unit
    unknowns = np.concatenate([start[1:-1], [guess.outlet / a, 0.0]])
    unknowns[-1] = guess.minimum_thickness / film_unit - film(unknowns)[2].min()
    result = root(residual, unknowns, method="hybr", tol=1e-11)
    return float(film(result.x)[2].min() * film_unit), result


def lines(runs: int, nodes: int = 201) -> list[Line]:
    """Return one film beside SciPy."""
    own, guess = solve(0.1, nodes), solve(0.105, nodes)
    shares = (own.x - own.x[0]) / (own.x[-1] - own.x[0])

    def peer() -> tuple[float, Any]:
        return by_scipy(0.1, shares, own.x[0], guess)

    found = in_turn({"own": lambda: timed(lambda: solve(0.1, nodes)), "scipy": lambda: timed(peer)}, runs)
    difference = f"{abs(peer()[0] / own.film_thickness.min() - 1):.0e}"
    work = f"film of a line contact, {nodes} nodes"
    return [Line(work, found["own"], "scipy.optimize.root", found["scipy"], beside=difference)]


def measure() -> list[tuple[int, float, float, float, bool]]:
    """Return (nodes, seconds of hersey, seconds of SciPy, relative difference, converged) of each grid."""
    rows = []
    for nodes in (101, 201):
        seconds, own = best_of(5, lambda n=nodes: solve(0.1, n))
        guess = solve(0.105, nodes)
        shares = (own.x - own.x[0]) / (own.x[-1] - own.x[0])
        theirs, (least, result) = best_of(1, lambda s=shares, x=own.x[0], g=guess: by_scipy(0.1, s, x, g))
        difference = abs(least / own.film_thickness.min() - 1)
        rows.append((nodes, seconds, theirs, difference, bool(result.success)))
    return rows


def table(rows: list[tuple[int, float, float, float, bool]]) -> str:
    """Return the rows as Markdown."""
    lines = ["| nodes | hersey | SciPy root | ratio | difference of the least film | SciPy converged |"]
    lines.append("|---|---|---|---|---|---|")
    for nodes, own, theirs, difference, converged in rows:
        lines.append(
            f"| {nodes} | {1e3 * own:.0f} ms | {1e3 * theirs:.0f} ms | {theirs / own:.0f} "
            f"| {difference:.0e} | {'yes' if converged else 'no'} |"
        )
    return "\n".join(lines)


if __name__ == "__main__":
    content = f"""# The film of a line contact beside SciPy

{machine()}; single thread; imports excluded. `python -m benchmarks.reynolds`.

An isoviscous half space at g_E = 58, the same discrete equations on the same nodes. hersey starts from
nothing; SciPy (`root`, hybr, Jacobian by differences) from the film at a speed 5 % higher.

{table(measure())}
"""
    print(content)
    Path(__file__).with_name("REYNOLDS.md").write_text(content)
