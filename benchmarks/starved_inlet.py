"""A line contact of elastic faces by Reynolds' equation, its inlet flooded or short of oil.

It writes the table of `benchmarks.starved_films`. Where oil is short the gap fills late: the place where it
does is given, and the contact passes what flow it then can.

Usage: python -m benchmarks.starved_inlet
"""

from __future__ import annotations

import numpy as np

#: Speeds, 12 times viscosity and mean speed in Hertz's units, and flows over the flooded one.
SPEEDS = np.geomspace(1e-2, 2e-4, 5)
LEFT = np.array([1.0, 0.98, 0.95, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3])
#: Where the flooded gap is full, and where a starved one fills, before the edge of the dry contact.
FULL = -3.0
FILLS = -1.0 - np.geomspace(1.9, 2e-4, 110)


def _kernel(x: np.ndarray, of: np.ndarray) -> np.ndarray:
    """Twice the integral of ln of the distance: what a kink of pressure does to the gap."""
    d = np.abs(x[:, None] - of[None, :])
    return np.where(d > 0.0, d * d * (0.5 * np.log(np.maximum(d, 1e-300)) - 0.75), 0.0)


def _nodes(count: int = 181) -> np.ndarray:
    """Places from inlet (0) to outlet (1), close together at both edges of the dry contact."""
    t = np.linspace(0.0, 1.0, 4001)
    x = -3.0 + 4.0 * t
    density = 0.4 + 1.2 / np.hypot((x + 1.0) / 0.1, 1.0) + 0.8 / np.hypot((x - 1.0) / 0.05, 1.0)
    number = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
    return np.interp(np.linspace(0.0, number[-1], count), number, t)


class Contact:
    """A line contact of elastic half-spaces in Hertz's units: x over half width, h R/a^2, p over Hertz's."""

    def __init__(self) -> None:
        self.share = _nodes()

    def grid(self, inlet: float, outlet: float) -> np.ndarray:
        """Return places between inlet and outlet, mapped so that the middle stays where it is."""
        whole = -3.0 + 4.0 * self.share
        left = -0.5 + (whole + 0.5) * (-0.5 - inlet) / 2.5
        right = -0.5 + (whole + 0.5) * (outlet + 0.5) / 1.5
        return np.where(whole < -0.5, left, right)

    def state(self, free: np.ndarray, inlet: float) -> tuple[np.ndarray, ...]:
        """Return places, pressure, gap, and its slopes by pressure."""
        x = self.grid(inlet, float(free[-2]))
        p = np.concatenate([[0.0], free[:-3], [0.0]])
        step = 1.0 / np.diff(x)
        n = x.size
        kinks = np.zeros((n, n))  # of pressure at nodes
        i = np.arange(n - 1)
        kinks[i, i] -= step
        kinks[i, i + 1] += step
        kinks[i + 1, i] += step
        kinks[i + 1, i + 1] -= step
        bent = -_kernel(x, x) @ kinks / np.pi
        h = free[-3] + 0.5 * x * x + bent @ p
        return x, p, h, bent

    def residual(self, free: np.ndarray, speed: float, inlet: float) -> tuple[np.ndarray, np.ndarray]:
        """Return what is left of flow, load and outlet, and its slopes by pressures and the constant."""
        x, p, h, bent = self.state(free, inlet)
        through = float(np.exp(free[-1]))
        dx, middle = np.diff(x), 0.5 * (h[1:] + h[:-1])
        left = np.diff(p) / dx * middle**3 / speed - (middle - through)
        load = np.sum(0.5 * (p[1:] + p[:-1]) * dx) * 2.0 / np.pi - 1.0
        out = (h[-1] - through) * 10.0
        n = x.size
        half = 0.5 * (bent[1:] + bent[:-1])
        by_gap = 3.0 * middle**2 * np.diff(p) / dx / speed - 1.0
        slopes = np.zeros((n + 1, n - 1))
        slopes[: n - 1, : n - 2] = by_gap[:, None] * half[:, 1:-1]
        of_p = middle**3 / speed / dx
        i = np.arange(n - 1)
        slopes[i[:-1], i[:-1]] += of_p[:-1]
        slopes[i[1:], i[:-1]] -= of_p[1:]
        slopes[: n - 1, n - 2] = by_gap
        weight = np.zeros(n)
        weight[:-1] += 0.5 * dx
        weight[1:] += 0.5 * dx
        slopes[n - 1, : n - 2] = weight[1:-1] * 2.0 / np.pi
        slopes[n, : n - 2] = 10.0 * bent[-1, 1:-1]
        slopes[n, n - 2] = 10.0
        return np.concatenate([left, [load, out]]), slopes

    def solved(self, free: np.ndarray, speed: float, inlet: float) -> np.ndarray:
        """Newton's steps from a start, damped; the last two columns by differences."""
        for _ in range(60):
            left, slopes = self.residual(free, speed, inlet)
            size = np.abs(left).max()
            if size < 1e-9:
                return free
            whole = np.zeros((left.size, left.size))
            whole[:, :-2] = slopes
            for k in (-2, -1):
                moved = free.copy()
                moved[k] += 1e-6
                whole[:, k] = (self.residual(moved, speed, inlet)[0] - left) / 1e-6
            step = np.linalg.solve(whole, -left)
            damp = min(1.0, 0.2 / max(abs(step[-2]) * 5.0, abs(step[-1]), 1e-12))
            for _ in range(12):
                trial = free + damp * step
                if np.abs(self.residual(trial, speed, inlet)[0]).max() < size * (1.0 + 1e-3):
                    break
                damp *= 0.5
            free = trial
        raise RuntimeError(f"no film at speed {speed:g}, left {size:g}")

    def drag(self, free: np.ndarray, speed: float, inlet: float) -> np.ndarray:
        """Return central film, shear and rolling."""
        x, p, h, _ = self.state(free, inlet)
        dx, middle = np.diff(x), 0.5 * (h[1:] + h[:-1])
        shear = speed / 6.0 * float(np.sum(dx / middle))
        return np.array([np.interp(0.0, x, h), shear, 0.5 * float(np.sum(middle * np.diff(p)))])

    def moved(self, free: np.ndarray, old: float, new: float) -> np.ndarray:
        """Return a start for another inlet: the pressure where it was."""
        at, to = self.grid(old, float(free[-2])), self.grid(new, float(free[-2]))
        pressure = np.interp(to, at, np.concatenate([[0.0], free[:-3], [0.0]]))
        return np.concatenate([pressure[1:-1], free[-3:]])

    def flooded(self, speed: float) -> np.ndarray:
        """Return the flooded film at a speed, from a thick one on."""
        x = self.grid(FULL, 1.05)
        dry = np.sqrt(np.maximum(1.0 - (x / 1.06) ** 2, 0.0))
        free = np.concatenate([dry[1:-1], [0.0, 1.05, np.log(0.1)]])
        free[-3] = 0.1 - np.interp(0.0, x, self.state(free, FULL)[2])
        for each in np.geomspace(2e-2, speed, 8):
            free = self.solved(free, each, FULL)
        return free

    def starved(self, speed: float) -> np.ndarray:
        """Return central film, shear and rolling at the flows `LEFT`, over those of the flooded film."""
        free = self.flooded(speed)
        whole, full = np.exp(free[-1]), self.drag(free, speed, FULL)
        flows, found, before = [1.0], [np.ones(3)], FULL
        for fills in FILLS:
            free, before = self.solved(self.moved(free, before, fills), speed, fills), fills
            flows.append(float(np.exp(free[-1]) / whole))
            found.append(self.drag(free, speed, fills) / full)
            if flows[-1] < LEFT[-1]:
                break
        return np.array([np.interp(-LEFT, -np.array(flows), each) for each in np.array(found).T])


def main() -> None:
    """Print the table."""
    contact = Contact()
    for speed in SPEEDS:
        film, shear, rolling = contact.drag(contact.flooded(speed), speed, FULL)
        print(f"{speed:.3e}: film {film:.4e}, rolling over shear {rolling / shear:.4f}")
        for name, row in zip(("film", "shear", "rolling"), contact.starved(speed), strict=True):
            print(f"    {name} {', '.join(f'{each:.3f}' for each in row)}", flush=True)


if __name__ == "__main__":
    main()
