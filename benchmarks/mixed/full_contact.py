"""Full numerical solution of a soft line contact whose load film and asperities share.

It knows nothing of the product's laws of film and share. Unknown are the total pressure P at the nodes and
the approach h0. The film is h = h0 + x^2/2R + G P, with the displacement G of a bonded elastic layer under a
pressure that is linear between the nodes. The asperities press with p_a(h) of Greenwood and Tripp (1970) at
every node, and the film with p_f = P - p_a(h), which obeys Reynolds' equation d/dx[h^3/(12 eta) dp_f/dx] =
u dh/dx, u = U/2, with p_f >= 0 by complementarity (exit of Swift and Stieber). Reynolds' equation and the
balance of the load are solved together by Newton's method on one dense system, started by pseudo-time steps.

SI; load, shear and pressure force are per length. The moving face enters at x < 0.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

Floats = NDArray[np.float64]

_GREENWOOD_TRIPP = 16 * np.sqrt(2) * np.pi / 15
#: Coefficients of the dry pressure, nodes on each of its sides.
_TERMS = 24


@dataclass(frozen=True)
class Layer:
    """A rigid cylinder under a load per length (N/m) on a bonded layer; radius and thickness in m."""

    radius: float
    load: float
    modulus: float  #: E* = E/(1 - nu^2), Pa
    poisson_ratio: float
    thickness: float


@dataclass(frozen=True)
class Summits:
    """Greenwood and Tripp's rough faces: sigma (m), E* of the faces (Pa), sigma beta D and sigma/beta."""

    sigma: float
    modulus: float
    sigma_beta_density: float
    sigma_over_beta: float

    @property
    def pressure(self) -> float:
        """Pressure over F(h/sigma), Pa."""
        slope = self.sigma_beta_density**2 * np.sqrt(self.sigma_over_beta)
        return float(_GREENWOOD_TRIPP * slope * self.modulus)


def _log_integral() -> CubicSpline:
    """Spline of ln F(l) by Gauss's quadrature, F(l) = int_0^inf s^2.5 phi(s + l) ds."""
    ratio = np.linspace(-8, 14, 2201)
    node, weight = np.polynomial.legendre.leggauss(200)
    node, weight = 0.5 * (node + 1), 0.5 * weight
    end = np.where(ratio < 0, 9 - ratio, 40 / np.maximum(ratio + 4.0, 4))[:, None]
    height = end * node**2  # a smooth integrand
    integrand = 2 * end * node * height**2.5 * np.exp(-0.5 * height**2 - height * ratio[:, None])
    return CubicSpline(ratio, np.log(integrand @ weight / np.sqrt(2 * np.pi)) - 0.5 * ratio**2)


_LOG_F = _log_integral()
_LOG_SLOPE = _LOG_F.derivative()


def integral(ratio: Floats) -> tuple[Floats, Floats]:
    """Return F(l) and dF/dl at l."""
    inside = np.clip(ratio, -8, 14)
    value = np.exp(_LOG_F(inside))
    return value, value * _LOG_SLOPE(inside)


def _layer_correction(nu: float) -> tuple[CubicSpline, CubicSpline]:
    """Even function c(x/t) and its slope: displacement by a line load is (2/pi E*) (-ln(x/t) + c)."""
    node, weight = np.polynomial.legendre.leggauss(600)
    q, weight = 20 * (node + 1), 20 * weight
    decay, kappa = np.exp(-2 * q), 3 - 4 * nu
    bottom = kappa * (1 + decay**2) + 2 * decay * (2 * q * q + 5 - 12 * nu + 8 * nu * nu)
    compliance = (kappa * (1 - decay**2) - 4 * q * decay) / bottom
    x = np.linspace(0, 16, 3201)
    c = ((np.cos(np.outer(x, q)) * (compliance - 1) + np.exp(-q)) / q) @ weight
    spline = CubicSpline(x, c, bc_type=((1, 0.0), "not-a-knot"))
    return spline, spline.derivative()


@dataclass(frozen=True)
class Dry:
    """The smooth dry contact: half-width (m), mean and largest pressure (Pa), K of K sqrt(d) at its edge."""

    half_width: float
    mean: float
    largest: float
    edge: float
    pressure: Callable[[Floats], Floats]


def dry(nip: Layer) -> Dry:
    """Return the dry contact: p = sqrt(1-s^2) sum c_j U_2j(s), collocated on the slope of the surface."""
    order, many = 2 * np.arange(_TERMS), 4 * _TERMS + 40
    at = np.cos((2 * np.arange(1, _TERMS + 1) - 1) * np.pi / (4 * _TERMS + 2))
    angle = np.arange(1, many + 1) * np.pi / (many + 1)
    s, weight = np.cos(angle), np.pi / (many + 1) * np.sin(angle) ** 2
    shapes = np.sin(np.outer(angle, order + 1)) / np.sin(angle)[:, None]
    slope = _layer_correction(nip.poisson_ratio)[1]

    def coefficients(half: float) -> Floats:
        apart = half / nip.thickness * (at[:, None] - s[None, :])
        bent = (half / nip.thickness) * (np.sign(apart) * slope(abs(apart)) * weight) @ shapes
        matrix = 2 / nip.modulus * (bent / np.pi - np.cos(np.outer(np.arccos(at), order + 1)))
        return np.asarray(np.linalg.solve(matrix, -half * at / nip.radius))

    hertz = np.sqrt(4 * nip.load * nip.radius / (np.pi * nip.modulus))
    half = float(
        brentq(
            lambda a: a * np.pi / 2 * coefficients(a)[0] - nip.load,
            0.02 * hertz,
            1.001 * min(hertz, 7.9 * nip.thickness),
            xtol=1e-12 * hertz,
        )
    )
    c = coefficients(half)

    def pressure(x: Floats) -> Floats:
        theta = np.arccos(np.clip(x / half, -1, 1))
        return np.asarray(np.sin(np.outer(theta, order + 1)) @ c * (abs(x) < half))

    edge = float(np.sqrt(2 / half) * (c @ (order + 1)))
    return Dry(half, nip.load / (2 * half), float(pressure(np.zeros(1))[0]), edge, pressure)


def _influence(x: Floats, nip: Layer) -> Floats:
    """Matrix of displacements of nodes x under unit pressures at each, linear between the nodes."""
    step = np.diff(x)
    apart = x[:, None] - x[None, :]
    log = np.log(abs(np.where(apart == 0, 1, apart)))
    twice = 0.5 * apart**2 * log - 0.75 * apart**2  # of which the second derivative is ln
    once = apart * log - apart
    rises = np.diff(twice, axis=1) / step
    matrix = np.zeros_like(apart)
    matrix[:, 1:] += rises
    matrix[:, :-1] -= rises
    matrix[:, 0] -= once[:, 0]
    matrix[:, -1] += once[:, -1]
    correction = _layer_correction(nip.poisson_ratio)[0]
    for part in (0.5 - 0.5 / np.sqrt(3), 0.5 + 0.5 / np.sqrt(3)):  # two of Gauss's nodes an element
        far = abs(x[:, None] - (x[:-1] + part * step)[None, :]) / nip.thickness
        load = (correction(np.minimum(far, 16)) + np.log(nip.thickness)) * (0.5 * step)
        matrix[:, :-1] += load * (1 - part)
        matrix[:, 1:] += load * part
    return np.asarray(2 / (np.pi * nip.modulus) * matrix)


def _grid(half: float, inlet: float, fineness: float) -> Floats:
    """Nodes from -3a to 2a, finer by sqrt(inlet^2 + distance^2) towards the edges of the dry contact."""
    at = np.linspace(-3 * half, 2 * half, 400001)
    edge = abs(abs(at) - half)
    dense = fineness * (1 / np.sqrt((inlet / 5) ** 2 + (edge / 30) ** 2) + 1 / (0.04 * half))
    count = np.concatenate([[0], np.cumsum(0.5 * (dense[1:] + dense[:-1]) * np.diff(at))])
    return np.interp(np.linspace(0, count[-1], int(np.ceil(count[-1])) + 1), count, at)


@dataclass(frozen=True)
class Solution:
    """A contact at one eta U (Pa m): films in m, share of asperities, forces on the moving face in N/m."""

    product: float
    central: float
    minimum: float
    share: float
    shear: float
    pressure: float
    state: tuple[Floats, float]  #: P and h0, from which the next is sought


class Contact:
    """A nip on a grid fit for an inlet of some length (m); it keeps the influence matrix."""

    def __init__(self, nip: Layer, bare: Dry, inlet: float, fineness: float = 1.0) -> None:
        self.nip, self.bare = nip, bare
        self.x = _grid(bare.half_width, inlet, fineness)
        self.influence = _influence(self.x, nip)
        step = np.diff(self.x)
        self.weight = 0.5 * (np.append(step, 0) + np.insert(step, 0, 0))
        self.gap = self.x**2 / (2 * nip.radius)
        self.middle = int(np.argmin(abs(self.x)))

    def film(self, pressure: Floats, approach: float) -> Floats:
        """Return the film at the nodes, m."""
        return np.asarray(approach + self.gap + self.influence @ pressure)

    def guess(self, central: float) -> tuple[Floats, float]:
        """Return the dry pressure, scaled to the load, and the approach at which the film is central at 0."""
        pressure = self.bare.pressure(self.x)
        pressure = pressure * self.nip.load / (self.weight @ pressure)
        return pressure, central - self.film(pressure, 0.0)[self.middle]

    def solve(
        self, product: float, summits: Summits | None, start: tuple[Floats, float], pace: float = 0.02
    ) -> Solution | None:
        """Return the contact at eta U (Pa m); None if Newton's method does not settle.

        ``pace`` is u times the first step of pseudo-time over the half-width.
        """
        x, n, step = self.x, len(self.x), np.diff(self.x)
        largest, half, load = self.bare.largest, self.bare.half_width, self.nip.load
        mean_speed = 0.5 * product  # eta u
        (total, approach), fluid_scale = start, pace * half
        film = self.film(total, approach)
        scale = max(film[self.middle], 1e-10)
        for _ in range(250):
            rough, give = np.zeros(n), np.zeros(n)
            if summits is not None:
                value, slope = integral(film / summits.sigma)
                rough, give = summits.pressure * value, summits.pressure / summits.sigma * slope
            fluid = total - rough
            between, fall = 0.5 * (film[1:] + film[:-1]), np.diff(fluid) / step
            flow = (between - between**3 * fall / (12 * mean_speed)) / scale
            by_film = 0.5 * (1 - 3 * between**2 * fall / (12 * mean_speed)) / scale
            by_fluid = between**3 / (12 * mean_speed) / step / scale
            outflow = np.diff(flow)
            # min(p_f, outflow c) = 0, c of the diagonal of the pressure's flow
            c = largest / (1e-3 + (by_fluid[1:] + by_fluid[:-1]) * largest)
            empty = np.ones(n, bool)
            empty[1:-1] = (outflow * c > fluid[1:-1]) & (x[1:-1] > -0.9 * half)
            full = np.flatnonzero(~empty)
            residual = np.append(fluid / largest, self.weight @ total / load - 1)
            residual[full] = outflow[full - 1]
            error = float(abs(residual).max())
            if error < 1e-9:
                return self._solution(product, summits, film, fluid, rough, ~empty, (total, approach))
            # The rows are A dh + B dp_f, with dp_f = dP - give dh and dh = G dP + dh0.
            lower, middle, upper = np.zeros(n), np.zeros(n), np.zeros(n)
            film_lower, film_middle, film_upper = np.zeros(n), np.zeros(n), np.zeros(n)
            lower[full], upper[full] = -by_fluid[full - 1], -by_fluid[full]
            middle[full] = by_fluid[full] + by_fluid[full - 1]
            film_lower[full], film_upper[full] = -by_film[full - 1], by_film[full]
            film_middle[full] = by_film[full] - by_film[full - 1]
            if error > 1e-3:
                film_middle[full] += self.weight[full] / (scale * fluid_scale)
            middle[empty] = 1 / largest
            film_lower -= lower * np.roll(give, 1)
            film_middle -= middle * give
            film_upper -= upper * np.roll(give, -1)
            matrix = np.zeros((n + 1, n + 1))
            matrix[:n, :n] = film_middle[:, None] * self.influence
            matrix[1:n, :n] += film_lower[1:, None] * self.influence[:-1]
            matrix[: n - 1, :n] += film_upper[:-1, None] * self.influence[1:]
            row = np.arange(n)
            matrix[row, row] += middle
            matrix[row[1:], row[:-1]] += lower[1:]
            matrix[row[:-1], row[1:]] += upper[:-1]
            matrix[:n, n] = film_lower + film_middle + film_upper
            matrix[n, :n] = self.weight / load
            matrix[:, :n] *= largest
            matrix[:, n] *= scale
            change = np.linalg.solve(matrix, -residual)
            more, nearer = change[:n] * largest, float(change[n] * scale)
            growth = nearer + self.influence @ more
            part = min(1.0, 0.7 / max(float((-growth / np.maximum(film, 1e-12)).max()), 1e-30))
            if summits is not None:
                near = np.minimum(film, film + growth) < 3.5 * summits.sigma
                most = float(abs(growth[near]).max(initial=0.0))
                part = min(part, 0.8 * summits.sigma / max(most, 1e-30))
            fluid_scale *= 1.7 if part == 1 else (1.0 if part > 0.3 else 0.3)
            total, approach = total + part * more, approach + part * nearer
            film = self.film(total, approach)
        return None

    def _solution(
        self,
        product: float,
        summits: Summits | None,
        film: Floats,
        fluid: Floats,
        rough: Floats,
        filled: NDArray[np.bool_],
        state: tuple[Floats, float],
    ) -> Solution:
        fluid = np.where(filled, fluid, 0.0)
        inside = np.flatnonzero(abs(self.x) < 1.6 * self.bare.half_width)
        least = int(inside[np.argmin(film[inside])])
        around = slice(least - 1, least + 2)
        bend, slope, low = np.polyfit(self.x[around] - self.x[least], film[around], 2)
        return Solution(
            product=product,
            central=float(np.interp(0, self.x, film)),
            minimum=float(min(film[least], low - slope**2 / (4 * bend) if bend > 0 else film[least])),
            share=float(self.weight @ rough / self.nip.load) if summits else 0.0,
            shear=float(np.sum(np.where(filled, self.weight * product / film, 0))),
            pressure=float(np.sum(0.25 * (film[1:] + film[:-1]) * np.diff(fluid))),
            state=state,
        )


def soft_film(nip: Layer, product: float) -> float:
    """Return about the central film of a half-space, m, from which to start."""
    scaled = 2 * nip.modulus * nip.radius
    return float(3.78 * nip.radius * (0.5 * product / scaled) ** 0.6 * (nip.load / scaled) ** -0.2)


def march(
    nip: Layer, summits: Summits, products: Floats, fineness: float = 1.0
) -> list[tuple[Solution, Solution]]:
    """Return the contact without and with asperities at falling eta U (Pa m), each from the one before.

    The first must be thick enough for the asperities to carry next to nothing. The march ends early where a
    solution does not settle.
    """
    bare = dry(nip)
    found: list[tuple[Solution, Solution]] = []
    contact, fitted = None, 0.0
    for product in products.tolist():
        height = soft_film(nip, product)
        inlet = 0.7 * (0.75 * nip.modulus * height / bare.edge) ** (2 / 3)
        if contact is None or inlet < 0.6 * fitted:
            before, fitted = contact, inlet
            contact = Contact(nip, bare, inlet, fineness)
            if before is not None and found:
                found[-1] = tuple(_moved(each, before, contact) for each in found[-1])  # type: ignore[assignment]
        start = found[-1][0].state if found else contact.guess(0.75 * height)
        alone = contact.solve(product, None, start) or contact.solve(
            product, None, contact.guess(0.75 * height)
        )
        if alone is None:
            break
        begin = found[-1][1].state if found else alone.state
        mixed = contact.solve(product, summits, begin) or contact.solve(product, summits, begin, 0.002)
        if mixed is None:
            break
        found.append((alone, mixed))
    return found


def _moved(solution: Solution, old: Contact, new: Contact) -> Solution:
    pressure = np.interp(new.x, old.x, solution.state[0])
    middle = float(np.interp(0, old.x, old.film(*solution.state)))
    approach = middle - new.film(pressure, 0.0)[new.middle]
    return Solution(**{**vars(solution), "state": (pressure, float(approach))})
